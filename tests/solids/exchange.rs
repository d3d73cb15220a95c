//! Schemes in exchange for others at an event: an effect with pair terms in a window of time. A step outside of the window
//! is to the bit, the pair and the byte one without the effect, and a run that resumes has the same bits.

use approx::assert_relative_eq;
use meshfree::prelude::*;
use meshfree::simulation::Simulation;

const DX: f64 = 1e-3;

/// A column of liquid that rings, between its free ends.
fn column(scheme: impl Into<Scheme<f64, 1>>) -> Scene<f64, 1> {
    let water = catalogue::weakly_compressible_water(10.0);
    let body = Body::block("water", water, [0.0], [0.1], DX);
    Scene::new(scheme).body(body.start(|x, own| meshfree::scene::Start {
        velocity: [1.0 + (20.0 * std::f64::consts::PI * x[0]).cos()],
        ..own
    }))
}

fn plain() -> Scheme<f64, 1> {
    schemes::weakly_compressible().compose()
}

/// With an effect that has pair terms, and one that has a field and a law.
fn with() -> Scheme<f64, 1> {
    schemes::weakly_compressible()
        .with(VolumeConsistency { strength: 0.3 })
        .with(AcousticDamping { strength: 0.3 })
        .compose()
}

/// With the effect between two times \[s\].
fn window(from: f64, until: f64) -> Scene<f64, 1> {
    column(plain())
        .event("begins", move |now| now.time() >= from)
        .event("ends", move |now| now.time() >= until)
        .exchange_scheme("water", "begins", with())
        .exchange_scheme("water", "ends", plain())
}

fn bits(simulation: &Simulation<f64, 1>) -> Vec<u64> {
    let of = |p: meshfree::simulation::ParticleView<'_, f64, 1>| {
        [p.position()[0], p.velocity()[0], p.density()].map(f64::to_bits)
    };
    simulation.all().flat_map(of).collect()
}

#[test]
fn an_effect_with_pairs_acts_in_its_window_alone() -> Result<(), Error> {
    let (begin, end, last) = (3e-4, 6e-4, 1e-3);
    let mut run = window(begin, end).build()?;
    let mut bare = column(plain()).build()?;
    let before = run.ledger().whole.momentum[0];
    assert_eq!(run.bytes(), bare.bytes());
    let bytes = |run: &Simulation<f64, 1>| run.scheme().fields().iter().count();
    let few = bytes(&run);
    let terms = run.scheme().terms().len();
    // To the bit, the pair and the byte as without it.
    for own in [&mut run, &mut bare] {
        own.run_until(0.95 * begin)?;
    }
    assert_eq!(bits(&run), bits(&bare));
    assert_eq!(run.work().pairs, bare.work().pairs);
    assert_eq!(
        (run.bytes(), run.evaluations()),
        (bare.bytes(), bare.evaluations())
    );
    // With its field while it acts, and without again.
    run.run_until(0.5 * (begin + end))?;
    let mut without = column(plain()).build()?;
    without.run_until(0.5 * (begin + end))?;
    assert_ne!(bits(&run), bits(&without));
    assert!(bytes(&run) > few && run.scheme().terms().len() > terms);
    run.run_until(last)?;
    assert_eq!(bytes(&run), few);
    let momentum = run.ledger().whole.momentum[0];
    assert_relative_eq!(momentum, before, epsilon = 0.0, max_relative = 1e-12);
    // Longer than the run it is the effect throughout, but for a first step without.
    let mut long = window(0.0, f64::INFINITY).build()?;
    let mut always = column(with()).build()?;
    let mut never = column(plain()).build()?;
    for own in [&mut long, &mut always, &mut never] {
        own.run_until(last)?;
    }
    let apart = |a: &Simulation<f64, 1>, b: &Simulation<f64, 1>| {
        let both = a.all().zip(b.all());
        let squares = both.map(|(a, b)| (a.velocity()[0] - b.velocity()[0]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let [late, whole] = [apart(&long, &always), apart(&never, &always)];
    println!("a step late {late}, never {whole}");
    assert!(late < 0.05 * whole, "{late} {whole}");
    Ok(())
}

#[cfg(feature = "checkpoint")]
#[test]
fn a_run_that_resumes_in_a_window_has_the_same_bits() -> Result<(), Error> {
    let path = std::env::temp_dir().join(format!(
        "meshfree-exchange-{}.safetensors",
        std::process::id()
    ));
    let scene = || window(2e-4, 4e-4);
    let mut whole = scene().build()?;
    whole.run_until(6e-4)?;
    let steps = whole.steps();
    for stop in [
        steps / 6,
        steps / 3,
        steps / 3 + 1,
        steps / 2,
        5 * steps / 6,
    ] {
        let mut run = scene().build()?;
        while run.steps() < stop {
            run.step()?;
        }
        run.save(&path)?;
        let mut resumed = scene().resume(&path)?;
        resumed.run_until(6e-4)?;
        assert_eq!(
            bits(&resumed),
            bits(&whole),
            "stopped after {stop} of {steps}"
        );
    }
    let other = column(plain())
        .event("begins", |_| false)
        .event("ends", |_| false)
        .resume(&path);
    assert!(other.is_err_and(|error| error.to_string().contains("later")));
    let _ = std::fs::remove_file(&path);
    Ok(())
}

#[test]
fn schemes_that_differ_in_more_than_effects_are_refused() {
    let refused = |scene: Scene<f64, 1>, word: &str| {
        let problems = scene.problems();
        let found = problems.iter().any(|one| one.to_string().contains(word));
        assert!(found, "{word}: {problems:?}");
    };
    let late = |scheme: Scheme<f64, 1>| {
        column(plain())
            .event("late", |now| now.time() > 1.0)
            .exchange_scheme("water", "late", scheme)
    };
    assert!(late(with()).problems().is_empty());
    refused(
        late(schemes::weakly_compressible().h_over_dx(1.4).compose()),
        "h/dx",
    );
    refused(
        late(schemes::impact_by_continuity().compose()),
        "energy form",
    );
    refused(
        column(plain()).exchange_scheme("water", "late", with()),
        "late",
    );
    let unknown = column(plain()).event("late", |_| false);
    refused(unknown.exchange_scheme("air", "late", with()), "air");
}
