//! What the misprints of Lam, Shen & Gong (2002) do when they are taken at their word.
//! Each runs beside the corrected form, and the difference is a number.

use meshfree::material::catalogue;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
use meshfree::sweep::Interaction;
use meshfree::term::viscosity::{ArtificialViscosity, LamPrinted, MonaghanGingold};

const PLATEAU: f64 = 353.17e6;

/// Highest pressure \[Pa\] in the middle of a copper rod within 2 µs of striking another at 20 m/s;
/// infinite if the run broke.
fn strike<V: ArtificialViscosity<1>>(viscosity: V) -> f64 {
    let spacing = 1e-4;
    let copper = catalogue::copper::<f64>;
    let striker = Body::block("striker", copper(), [0.0], [0.01], spacing).velocity([20.0]);
    let target = Body::block("target", copper(), [0.01], [0.02], spacing);
    let scene = Scene::<f64, 1>::new(schemes::lam2002().with_viscosity(viscosity))
        .body(striker)
        .body(target)
        .between("striker", "target", Interaction::Bonded);
    let mut simulation = scene.build().expect("a scene without problems");
    let mut peak = 0.0_f64;
    let run = simulation.run_with(2e-6, |simulation| {
        let middle = simulation
            .body(0)
            .unwrap()
            .nth(50)
            .map(|particle| particle.pressure());
        peak = peak.max(middle.unwrap_or(f64::NAN));
    });
    run.map_or(f64::INFINITY, |()| peak)
}

#[test]
fn printed_sign_of_the_viscosity_pulls_particles_together() {
    let corrected = strike(MonaghanGingold::STANDARD);
    let printed = strike(LamPrinted {
        alpha: 1.0,
        beta: 2.0,
    });
    println!(
        "peak over plateau: corrected {:.4}, as printed {:.4}",
        corrected / PLATEAU,
        printed / PLATEAU
    );
    assert!(corrected < 1.02 * PLATEAU, "{corrected}");
    assert!(printed > 1.5 * PLATEAU, "{printed}");
}
