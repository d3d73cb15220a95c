//! What a scheme says of itself is what it runs, and what the architecture page shows.
//! The page holds the step programs of one liquid and one solid as the crate prints them.

use meshfree::prelude::*;
use meshfree::term::LaminarViscosity;

fn programs() -> String {
    let liquid: Scheme<f64, 2> = schemes::weakly_compressible().compose();
    let solid: Scheme<f64, 2> = schemes::impact().compose();
    format!("{}\n\n{}", liquid.step_program(), solid.step_program())
}

#[test]
fn the_architecture_page_shows_the_step_as_it_is_printed() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/architecture.md"));
    let (page, programs) = (page.expect("the page"), programs());
    assert!(
        page.contains(&programs),
        "put into docs/architecture.md:\n{programs}"
    );
}

/// What a particle and a step pay for an effect that is not named: nothing.
#[test]
fn an_effect_that_is_not_named_is_not_in_the_program() {
    let plain: Scheme<f64, 3> = schemes::weakly_compressible().compose();
    let text = plain.to_string() + &plain.step_program();
    for (name, scheme) in [
        (
            "divergence",
            schemes::weakly_compressible()
                .with(AcousticDamping { strength: 0.3 })
                .compose(),
        ),
        (
            "dynamic_viscosity",
            schemes::weakly_compressible()
                .with(Laminar(LaminarViscosity))
                .compose(),
        ),
        (
            "expansion",
            schemes::weakly_compressible()
                .with(ExpansionMemory)
                .compose(),
        ),
        (
            "concentration_gradient",
            schemes::weakly_compressible()
                .with(Shifting::STANDARD)
                .compose(),
        ),
        (
            "unity",
            schemes::weakly_compressible()
                .with(VolumeConsistency { strength: 0.05 })
                .compose(),
        ),
        (
            "correction",
            schemes::weakly_compressible().renormalised().compose(),
        ),
    ] as [(&str, Scheme<f64, 3>); 6]
    {
        let own = scheme.to_string() + &scheme.step_program();
        let lines = |text: &str| text.matches(name).count();
        assert!(
            lines(&own) > lines(&text),
            "{name} is in the program that names it:\n{own}"
        );
        assert!(
            name == "unity" || lines(&text) == 0,
            "{name} is not in the one that does not:\n{text}"
        );
    }
    // 3 + 3 + 6 numbers: places, velocities, and what pressure and continuity need.
    assert_eq!(plain.fields().width(3), 12);
}
