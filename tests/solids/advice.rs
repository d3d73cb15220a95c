//! Advice on solids: the rods of Lam, Shen & Gong give the numbers that are worked out by hand from their constants.
//! Each number is compared with its formula, and each missing requirement is refused by name.

use meshfree::prelude::*;
use meshfree::scene::advice::{Advice, Known, Line, Need};

/// Copper of Lam et al.: density, sound speed, slope, Γ and yield stress.
const COPPER: [f64; 5] = [8930.0, 3940.0, 1.49, 2.02, 0.76e9];
const END: f64 = 26e-6;

/// Rods of 10 and 40 mm at a closing speed, the longer at a wall.
fn rods(speed: f64) -> Scene<f64, 1> {
    Scene::new(schemes::impact())
        .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([speed]))
        .body(Body::block(
            "target",
            catalogue::copper(),
            [0.01],
            [0.05],
            2e-4,
        ))
        .boundary(MirrorPlane::wall([0.05], [1.0]))
}

fn line<'a>(advice: &'a Advice, number: &str, of: &str) -> &'a Line {
    let mut lines = advice.lines.iter();
    lines
        .find(|line| line.number == number && line.of.starts_with(of))
        .unwrap_or_else(|| panic!("{number} of {of} in\n{advice}"))
}

#[track_caller]
fn near(line: &Line, expected: f64, need: Need) {
    assert!(
        (line.value / expected - 1.0).abs() < 2e-3,
        "{line} is not {expected}"
    );
    assert_eq!(line.need, need, "{line}");
}

#[test]
fn the_rods_have_the_numbers_of_their_paper() {
    let [density, c, s, gamma, yields] = COPPER;
    let u = 10.0;
    let advice = rods(20.0).advise(END, &Known::default());
    println!("{advice}");
    let of = |number| line(&advice, number, "striker");
    near(of("u/c"), u / c, Need::Skip);
    near(of("S u/c"), s * u / c, Need::Skip);
    near(
        of("stress of the impact/Y"),
        density * c * u / yields,
        Need::Skip,
    );
    near(of("Gamma rho e/p"), 0.5 * gamma * u / c, Need::Skip);
    near(of("t c/L"), END * c / 0.01, Need::Require);
    near(of("rho U2/Y"), density * 400.0 / yields, Need::Optional);
    near(of("t c/(2 L)"), END * c / 0.02, Need::Require);
    // As printed in the worked example: 2.5e-3, 3.8e-3, 0.46, 0.26 % and 10 crossings.
    assert!((of("u/c").value - 2.5e-3).abs() < 5e-5);
    assert!((of("Gamma rho e/p").value - 0.26e-2).abs() < 5e-5);
    // At the wall the stress doubles.
    let doubled = advice
        .lines
        .iter()
        .filter(|line| line.of.starts_with("target"));
    let doubled = doubled.filter(|line| line.number == "stress of the impact/Y");
    let values: Vec<_> = doubled.map(|line| (line.value, line.need)).collect();
    assert_eq!(values.len(), 2);
    assert!((values[1].0 / values[0].0 - 2.0).abs() < 1e-12 && values[1].1 == Need::Recommend);
    // Nothing that is required is missing.
    assert_eq!(advice.missing().count(), 0, "{advice}");
    assert!(rods(20.0).strict(END, &Known::default()).is_ok());
}

#[test]
fn a_faster_impact_requires_strength_and_strict_scenes_are_refused() {
    let advice = rods(100.0).advise(END, &Known::default());
    let yields = line(&advice, "stress of the impact/Y", "striker");
    assert!(yields.value > 2.3 && yields.is_missing(), "{yields}");
    let error = rods(100.0)
        .strict(END, &Known::default())
        .err()
        .map(|error| error.to_string());
    let error = error.expect("what is missing");
    for part in [
        "plasticity of striker struck by target",
        "required and missing",
        "Scene::strict",
    ] {
        assert!(error.contains(part), "{error}");
    }
    // A contact that cannot open is the other thing that rods need.
    let bonded = rods(20.0).between("striker", "target", meshfree::sweep::Interaction::Bonded);
    let error = bonded
        .strict(END, &Known::default())
        .err()
        .map(|error| error.to_string());
    assert!(error.is_some_and(|error| error.contains("contact that opens")));
}

#[test]
fn an_impact_on_a_wall_is_one_on_its_image() {
    let scene = |place: f64, normal: f64| {
        Scene::<f64, 1>::new(schemes::impact())
            .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
            .boundary(MirrorPlane::wall([place], [normal]))
    };
    let advice = scene(0.01, 1.0).advise(1e-6, &Known::default());
    let [density, c, _, _, yields] = COPPER;
    near(
        line(&advice, "stress of the impact/Y", "rod"),
        density * c * 20.0 / yields,
        Need::Recommend,
    );
    // What flies from a wall is not struck.
    let away = scene(0.0, -1.0).advise(1e-6, &Known::default());
    assert!(
        away.lines
            .iter()
            .all(|line| line.number != "stress of the impact/Y"),
        "{away}"
    );
}

#[test]
fn wrong_numbers_are_refused_by_name() {
    let known = Known {
        surface_tension: Some(-1.0),
        gap: Some(f64::NAN),
        ..Known::default()
    };
    let error = rods(20.0)
        .strict(f64::NAN, &known)
        .err()
        .map(|error| error.to_string());
    let error = error.expect("three problems");
    for part in ["end time", "surface_tension", "gap"] {
        assert!(error.contains(part), "{error}");
    }
    // Advice itself never fails.
    assert!(
        !rods(f64::NAN)
            .advise(f64::NAN, &known)
            .to_string()
            .is_empty()
    );
}
