//! Motion, shape and coupling, each against a closed form: Newton's second law, the pendulum and the harmonic orbit.

use crate::coupling::Bands;
use crate::motion::Lift;
use crate::shape::Ellipse;
use meshfree::coupling::Joint;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use std::f64::consts::{PI, TAU};

const G: f64 = 9.81;

/// A tank on a lift gives its water the impulse m (v + g t).
#[test]
fn water_on_a_lift_takes_the_impulse_of_newton() {
    let (spacing, [width, depth]) = (0.01, [0.2, 0.1]);
    let lift = Lift {
        height: 0.1,
        duration: 0.4,
    };
    let water = catalogue::weakly_compressible_water(2.0);
    let body = Body::block("water", water, [0.0; 2], [width, depth], spacing);
    let high = [width, 2.0 * depth];
    let tank = Wall::around("tank", [0.0; 2], high, spacing, 5, [[true; 2]; 2]);
    let mut run = Scene::<f64, 2>::new(schemes::weakly_compressible())
        .body(body.hydrostatic([0.0, -G], [0.0, depth]))
        .wall(tank.motion(lift))
        .acceleration(|_| [0.0, -G])
        .build()
        .unwrap();
    let start: Vec<_> = run.wall(0).unwrap().map(|p| p.position()[1]).collect();
    let mass = 1000.0 * width * depth;
    // At full speed 2 H/T, which half of the way takes; at rest at the top.
    for (time, speed, height) in [(0.2, 0.5, 0.05), (0.4, 0.0, 0.1)] {
        run.run_until(time).unwrap();
        for (p, before) in run.wall(0).unwrap().zip(&start) {
            assert!((p.position()[1] - before - height).abs() < 1e-12);
        }
        let given = -run.wall_impulse(0).unwrap()[1] / mass - G * time;
        println!("{given} m/s of {speed} after {time} s");
        assert!((given - speed).abs() < 0.01 * 0.5, "{given} of {speed}");
    }
}

/// An elliptic plate that hangs on its focus swings with T = 2π √(((a² + b²)/4 + d²)/(g d)).
#[test]
fn a_plate_of_ones_own_shape_is_a_pendulum() {
    let (a, b) = (0.5_f64, 0.3_f64);
    let focus = (a * a - b * b).sqrt();
    // No sound runs through a rigid body; a slow one lets steps be long.
    let steel = Material::new("steel", Linear::new(7800.0, 2.0));
    let shape = Ellipse { half_axes: [a, b] };
    let plate = Body::fill("plate", steel, &shape, 0.02);
    // Gravity along −x, a little to the side: the plate swings by as much about where it would rest.
    let lean = 0.05_f64;
    let mut run = Scene::<f64, 2>::new(schemes::impact_by_continuity())
        .body(plate)
        .rigid("plate")
        .joint_to_ground("plate", Joint::hinge([focus, 0.0], [0.0, 0.0, 1.0]))
        .acceleration(move |_| [-G * lean.cos(), -G * lean.sin()])
        .build()
        .unwrap();
    let mass = run.rigid_body("plate").unwrap().mass;
    assert!((mass / (7800.0 * PI * a * b) - 1.0).abs() < 0.01, "{mass}");
    let period = TAU * ((0.25 * (a * a + b * b) + focus * focus) / (G * focus)).sqrt();
    let (mut last, mut times) = ((0.0, lean), Vec::new());
    run.run_with(1.6 * period, |now| {
        let next = (now.time(), lean - now.joints()[0].value);
        if (last.1 < 0.0) != (next.1 < 0.0) {
            times.push(last.0 - last.1 * (next.0 - last.0) / (next.1 - last.1));
        }
        last = next;
    })
    .unwrap();
    let found = times[2] - times[0];
    println!("{found} s of {period} s");
    assert!((found / period - 1.0).abs() < 0.01, "{found} of {period}");
}

/// Two bodies on bands of together K go round their centre in an ellipse, with ω² = K/μ.
#[test]
fn bodies_on_bands_go_round_in_an_ellipse() {
    let steel = || Material::new("steel", Linear::new(1000.0, 20.0));
    let square = |name, x: f64, v: f64| {
        let (low, high) = ([x - 0.05, -0.05], [x + 0.05, 0.05]);
        Body::block(name, steel(), low, high, 0.05).velocity([0.0, v])
    };
    // Masses of 10 kg, four particles each: μ = 5 kg, and sixteen bands.
    let omega = TAU;
    let stiffness = 5.0 * omega * omega / 16.0;
    let bands = Bands {
        stiffness,
        length: 3.0,
    };
    let (far, near) = (1.0, 0.6);
    let side = 0.5 * near * omega;
    let mut run = Scene::<f64, 2>::new(schemes::impact_by_continuity())
        .body(square("left", -0.5 * far, -side))
        .body(square("right", 0.5 * far, side))
        .rigid("left")
        .rigid("right")
        .couple("right", "left", bands)
        .build()
        .unwrap();
    let total = |run: &Simulation<f64, 2>| {
        let whole = run.ledger().whole;
        whole.kinetic + whole.total("energy of couplings").unwrap()
    };
    run.evaluate().unwrap();
    let (before, mut worst, mut unpaid) = (total(&run), 0.0_f64, 0.0_f64);
    run.run_with(1.0, |now| {
        let [right, left] = ["right", "left"].map(|name| now.rigid_body(name).unwrap().centre);
        let (sin, cos) = (omega * now.time()).sin_cos();
        let off = [far * cos, near * sin];
        let off = (right[0] - left[0] - off[0]).hypot(right[1] - left[1] - off[1]);
        worst = worst.max(off);
        unpaid = unpaid.max((total(now) / before - 1.0).abs());
    })
    .unwrap();
    let momentum = run.ledger().whole.momentum;
    println!("off by {worst:e} m, energy by {unpaid:e}, momentum {momentum:?}");
    assert!(worst < 0.01 * near, "{worst}");
    assert!(unpaid < 1e-3, "{unpaid}");
    assert!(momentum.iter().all(|p| p.abs() < 1e-9), "{momentum:?}");
}

#[test]
fn their_own_problems_are_those_of_the_scene() {
    let flat = Ellipse {
        half_axes: [0.5, 0.0],
    };
    let steel = || Material::new("steel", Linear::new(1000.0, 20.0));
    let scene = Scene::<f64, 2>::new(schemes::impact_by_continuity());
    let scene = scene.body(Body::fill("plate", steel(), &flat, 0.02));
    let error = scene.build().map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("half axis of the ellipse"), "{error}");
    let block = |name, x: f64| Body::block(name, steel(), [x], [x + 0.1], 0.05);
    let slack = Bands {
        stiffness: -1.0,
        length: 1.0,
    };
    let scene = Scene::<f64, 1>::new(schemes::impact_by_continuity())
        .body(block("left", 0.0))
        .body(block("right", 0.5))
        .couple("left", "right", slack);
    let error = scene.build().map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("stiffness of the bands"), "{error}");
}
