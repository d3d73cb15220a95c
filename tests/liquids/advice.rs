//! Advice on liquids: a tank under 30 g and water in crushed cells give the numbers that are worked out by hand.
//! A dam, a drop and a slow flow lie on the other sides of the bands.

use meshfree::boundary::Wall;
use meshfree::effect::NeoHookean;
use meshfree::material::SoundSpeed;
use meshfree::material::strength::{CowperSymonds, TensionCompression};
use meshfree::prelude::*;
use meshfree::scene::advice::{Advice, Known, Line, Need};

fn line<'a>(advice: &'a Advice, number: &str) -> &'a Line {
    let mut lines = advice.lines.iter();
    lines
        .find(|line| line.number == number)
        .unwrap_or_else(|| panic!("{number} in\n{advice}"))
}

#[track_caller]
fn near(line: &Line, expected: f64, tolerance: f64, need: Need) {
    assert!(
        (line.value / expected - 1.0).abs() < tolerance,
        "{line} is not {expected}"
    );
    assert_eq!(line.need, need, "{line}");
}

/// Water of that size in an open tank that is shaken, with physical sound.
fn water(size: [f64; 2], dx: f64, acceleration: [f64; 2]) -> Scene<f64, 2> {
    let material = catalogue::water_at(SoundSpeed::Physical).with_pressure_cut_off(0.0);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", material, [0.0; 2], size, dx))
        .acceleration(move |_| acceleration)
}

#[test]
fn the_tank_at_30_g_has_its_worked_numbers() {
    // Half a metre of water behind a plate of PMMA 30 mm thick.
    let plate = Body::block(
        "plate",
        catalogue::tank_pmma(),
        [-0.03, 0.0],
        [0.0, 0.2],
        0.005,
    );
    let scene = water([0.5, 0.1], 0.005, [294.2, 0.0])
        .group(schemes::total_lagrangian().with(NeoHookean), [plate]);
    let known = Known {
        surface_tension: Some(0.072),
        gas_density: Some(1.2),
        artificial_viscosity: Some(0.02),
        ..Known::default()
    };
    let advice = scene.advise(0.08, &known);
    println!("{advice}");
    let speed = (294.2_f64 * 0.5).sqrt();
    near(line(&advice, "U/c"), speed / 1480.0, 1e-6, Need::Skip);
    near(
        line(&advice, "U L/nu"),
        speed * 0.5 / 1e-6,
        1e-6,
        Need::Skip,
    );
    near(
        line(&advice, "rho U2 L/sigma"),
        1000.0 * speed * speed * 0.5 / 0.072,
        1e-6,
        Need::Skip,
    );
    let bends = 0.014 * 1000.0 * speed * speed / 3e9 * (0.5_f64 / 0.03).powi(3);
    let two_way = line(&advice, "0.014 (rho U2/E)(L/t)3");
    near(two_way, bends, 1e-3, Need::Optional);
    assert_eq!(two_way.present, Some(true));
    // As printed: U 12 m/s, Re 6e6, We about 1e6, Mach 0.008, bend 3e-3.
    for (number, printed, share) in [
        ("U/c", 0.008, 0.05),
        ("U L/nu", 6e6, 0.05),
        ("rho U2 L/sigma", 1e6, 0.05),
        ("0.014 (rho U2/E)(L/t)3", 3e-3, 0.08),
        ("max(U/sqrt(g L), a/g)", 30.0, 0.01),
    ] {
        let found = line(&advice, number).value;
        assert!((found / printed - 1.0).abs() < share, "{number} {found}");
    }
    assert_eq!(line(&advice, "max(U/sqrt(g L), a/g)").need, Need::Skip);
    // The liquid is heavy beside the plate, which bends too little for that to be required.
    assert_eq!(line(&advice, "rho L/(rho_s t)").need, Need::Optional);
    // Air: optional, leave it out first. Viscosity of the scheme hides that of water, which does not matter.
    assert_eq!(line(&advice, "rho_2/rho_1").need, Need::Optional);
    assert_eq!(line(&advice, "(alpha h c/10)/nu").need, Need::Skip);
    assert_eq!(line(&advice, "(p - p_v)/(rho U2/2)").need, Need::Skip);
    assert_eq!(advice.missing().count(), 0, "{advice}");
}

#[test]
fn water_in_crushed_cells_has_its_worked_numbers() {
    // A hole of 3 mm, walls of 0.5 mm, four and a half spacings, of which a lattice has four; a spacing of 0.112 mm, and a strain
    // rate of 1000 1/s.
    let dx = 0.112e-3;
    let slow = TensionCompression::new(49e6, 91e6);
    let polymer = catalogue::fullcure_m730().with_strength(CowperSymonds::new(slow, 4e3, 5.0));
    let wall = Body::block("strut", polymer, [-0.448e-3, 0.0], [0.0, 3e-3], dx);
    let scene = water([3e-3, 3e-3], dx, [0.0; 2])
        .group(schemes::total_lagrangian().with(NeoHookean), [wall]);
    let known = Known {
        speed: Some(4.0),
        strain_rate: Some(1000.0),
        gap: Some(3e-3),
        ..Known::default()
    };
    let advice = scene.advise(0.5e-3, &known);
    println!("{advice}");
    near(line(&advice, "U L/nu"), 1.2e4, 1e-2, Need::Skip);
    near(line(&advice, "t c/L"), 240.0, 0.04, Need::Optional);
    near(line(&advice, "U/c"), 4.0 / 1480.0, 1e-3, Need::Skip);
    let rate = line(&advice, "Y(rate)/Y(0) - 1");
    near(rate, 0.25_f64.powf(0.2), 1e-6, Need::Require);
    near(
        line(&advice, "Y(p)/Y(-p) - 1"),
        91.0 / 49.0 - 1.0,
        1e-6,
        Need::Require,
    );
    let spacing = |of: &str| {
        let mut lines = advice.of("spacing across a thin part");
        lines.find(|line| line.of.starts_with(of)).expect("a line")
    };
    near(spacing("strut"), 4.5, 0.12, Need::Optional);
    near(spacing("water in"), 27.0, 0.01, Need::Skip);
    // The scheme of the struts has no plasticity, which both require.
    let missing: Vec<_> = advice.missing().map(|line| line.number).collect();
    assert_eq!(missing, ["Y(rate)/Y(0) - 1", "Y(p)/Y(-p) - 1"]);
}

#[test]
fn a_dam_needs_gravity_and_no_more() {
    let tank = Wall::around(
        "tank",
        [0.0; 2],
        [3.0, 1.0],
        0.05,
        3,
        [[true, true], [true, false]],
    );
    let known = Known {
        surface_tension: Some(0.072),
        ..Known::default()
    };
    let advice = water([1.0, 0.5], 0.05, [0.0, -9.81])
        .wall(tank)
        .advise(1.0, &known);
    let gravity = line(&advice, "max(U/sqrt(g L), a/g)");
    near(gravity, 1.0, 1e-9, Need::Require);
    assert_eq!(gravity.present, Some(true));
    assert_eq!(line(&advice, "rho a L2/sigma").need, Need::Skip);
    assert_eq!(line(&advice, "U dx/nu").need, Need::Skip);
    assert!(
        advice
            .unknown
            .iter()
            .any(|what| what.contains("Known::gas_density"))
    );
    // Without its load it is missing where something moves.
    let known = Known {
        speed: Some(1.0),
        ..known
    };
    let floating = water([1.0, 0.5], 0.05, [0.0; 2]).advise(1.0, &known);
    assert!(line(&floating, "max(U/sqrt(g L), a/g)").is_missing());
    let space = Known {
        gravity: 0.0,
        ..known
    };
    let floating = water([1.0, 0.5], 0.05, [0.0; 2]).advise(1.0, &space);
    assert_eq!(floating.of("gravity").count(), 0);
}

#[test]
fn a_drop_needs_surface_tension_and_slow_oil_viscosity() {
    // A millimetre of oil at a centimetre a second.
    let oil = meshfree::material::Liquid::new(920.0, 1450.0, 0.05);
    let oil = oil.material("oil", SoundSpeed::artificial(0.01));
    let scene = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("drop", oil, [0.0; 2], [1e-3; 2], 5e-5));
    let known = Known {
        speed: Some(0.01),
        surface_tension: Some(0.03),
        artificial_viscosity: Some(0.02),
        sound_speed: Some(1450.0),
        ..Known::default()
    };
    let advice = scene.advise(1.0, &known);
    near(
        line(&advice, "rho U2 L/sigma"),
        920.0 * 1e-4 * 1e-3 / 0.03,
        1e-6,
        Need::Require,
    );
    near(
        line(&advice, "U L/nu"),
        0.01 * 1e-3 / (0.05 / 920.0),
        1e-6,
        Need::Require,
    );
    let lacks: Vec<_> = advice.missing().map(|line| line.effect).collect();
    assert!(lacks.contains(&"viscosity"), "{advice}");
    // Of the real liquid; the artificial sound speed is ten times the flow, just not enough.
    near(line(&advice, "U/c"), 0.01 / 1450.0, 1e-6, Need::Skip);
}

/// Oil between two plates that stick to it, 10 × 1 mm; the upper comes down at 10 mm/s for 10 ms. The other moves too if told so.
fn film(sound_speed: f64, sticks: bool, both: bool) -> Advice {
    use meshfree::boundary::Translation;
    let oil = meshfree::material::Liquid::new(1000.0, 1450.0, 1.0).linear();
    let oil = oil.material("oil", SoundSpeed::Chosen(sound_speed));
    let dx = 1e-4;
    let plate = |name, low: f64| {
        let water = catalogue::water();
        let points = Body::<f64, 2>::block(name, water, [0.0, low], [1e-2, low + 4.0 * dx], dx);
        let wall = Wall::of(name, points.points().to_vec(), dx);
        if sticks { wall.no_slip() } else { wall }
    };
    let down = || Translation::steady([0.0, -0.01]);
    let lower = plate("lower", -4.0 * dx);
    Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("oil", oil, [0.0; 2], [1e-2, 1e-3], dx))
        .wall(if both { lower.motion(down()) } else { lower })
        .wall(plate("upper", 1e-3).motion(down()))
        .advise(0.01, &Known::default())
}

#[test]
fn viscous_pressure_of_a_film_asks_for_a_sound_speed() {
    // 1.5 μ V L²/h³ with h = 0.9 mm in the end.
    let pressure = 1.5 * 0.01 * 1e-4 / 0.9e-3_f64.powi(3);
    let number = |c: f64| pressure / (1000.0 * c * c);
    let slow = film(4.0, true, false);
    let found = line(&slow, "p_v/(rho c2)");
    near(found, number(4.0), 1e-6, Need::Impossible);
    assert!(found.is_missing());
    let least = (pressure / 30.0).sqrt();
    assert!(found.reason.contains(&format!("{least:.3} m/s")), "{found}");
    let allowed = film(1.01 * least, true, false);
    near(
        line(&allowed, "p_v/(rho c2)"),
        0.03 / 1.0201,
        1e-6,
        Need::Optional,
    );
    let fast = film(20.0, true, false);
    near(line(&fast, "p_v/(rho c2)"), number(20.0), 1e-6, Need::Skip);
    // Plates that do not close, or along which the oil slides, make none.
    for advice in [film(4.0, true, true), film(4.0, false, false)] {
        assert!(
            advice
                .lines
                .iter()
                .all(|line| line.number != "p_v/(rho c2)"),
            "{advice}"
        );
    }
}

#[test]
fn slow_viscous_flow_under_pressure_is_named() {
    // Glowinski's disc: 5 cm/s in 6 cm of a liquid of 0.01 Pa s, 588 Pa at the bottom. And without its weight.
    let advice = |gravity: f64, viscosity: f64| {
        let liquid = meshfree::material::Liquid::new(1000.0, 1450.0, viscosity);
        let liquid = liquid.material("liquid", SoundSpeed::artificial(1.5));
        let known = Known {
            speed: Some(0.05),
            ..Known::default()
        };
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block("liquid", liquid, [0.0; 2], [0.02, 0.06], 0.002))
            .acceleration(move |_| [0.0, -gravity])
            .advise(1.0, &known)
    };
    let number = "p/(mu U/L + rho U2)";
    let heavy = advice(9.81, 0.01);
    let expected = 1000.0 * 0.06 * 9.81 / (0.01 * 0.05 / 0.06 + 2.5);
    near(line(&heavy, number), expected, 1e-6, Need::Recommend);
    assert_eq!(line(&heavy, number).present, Some(false));
    near(
        line(&advice(0.5, 0.01), number),
        expected * 0.5 / 9.81,
        1e-6,
        Need::Optional,
    );
    let weightless = advice(0.0, 0.01);
    assert_eq!(line(&weightless, number).need, Need::Skip);
    // Water, at Re 3000, is not slow.
    let water = advice(9.81, 1e-3);
    assert!(
        water.lines.iter().all(|line| line.number != number),
        "{water}"
    );
}

#[test]
fn tanks_that_move_accelerate_their_liquid() {
    use meshfree::boundary::Translation;
    // 300 m/s² of a tank, and a tenth of a metre of water in it: a/g, and no weight.
    let pushed = Translation::new(
        |t| [150.0 * t * t, 0.0],
        |t| [300.0 * t, 0.0],
        |_| [300.0, 0.0],
    );
    let tank = Wall::around("tank", [0.0; 2], [0.1; 2], 0.005, 3, [[true; 2]; 2]);
    let material = catalogue::water_at(SoundSpeed::Physical);
    let advice = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(Body::block("water", material, [0.0; 2], [0.1, 0.05], 0.005))
        .wall(tank.motion(pushed))
        .advise(0.01, &Known::default());
    let number = "max(U/sqrt(g L), a/g)";
    near(line(&advice, number), 300.0 / 9.81, 0.01, Need::Skip);
}
