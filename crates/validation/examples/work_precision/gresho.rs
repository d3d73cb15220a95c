//! Gresho's vortex in two dimensions: gas that turns, without a shock, and so without need of a viscosity.
//! The exact flow is steady; what a run loses of it is what its viscosity takes.

use super::gas::{plain, signal, switched};
use super::problem::{Problem, Text, method, sweep};
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::work_precision::{Case, Failure, Method, Outcome, Quantity, relative_l1};
use meshfree::term::viscosity::LimitedMonaghanGingold;

const TEXT: Text = Text {
    key: "gresho",
    title: "Gresho's vortex",
    setting: "Gas of γ 5/3 and 1 kg/m³ that turns by up to 1 m/s at 0.2 m from its middle, at a third of the speed of sound, in a \
              periodic square of 1 m, after 1 s. Mean error of velocity over mean velocity (Gresho & Chan 1990). Two dimensions.",
    words: include_str!("words/gresho.md"),
};
const VELOCITY: &str = "velocity of the vortex";

fn methods() -> Vec<Method> {
    let own = |name: &str, law: &str, ratio: f64, alpha: f64| {
        let numbers = [("h/dx", ratio), ("alpha", alpha)];
        method(name, &[("viscosity", law)], &numbers)
    };
    vec![
        own("gas, C4, h/dx 1.8 (default)", "gas", 1.8, 1.0),
        own("gas, h/dx 2.2", "gas", 2.2, 1.0),
        own("plain force, signal velocity", "signal", 1.8, 1.0),
        own("plain force, limited, h/dx 2.2", "limited", 2.2, 2.0),
        own("Cullen–Dehnen", "switched", 1.8, 2.0),
        own("Cullen–Dehnen, h/dx 2.2", "switched", 2.2, 2.0),
    ]
}

/// Speed \[m/s\] and pressure \[Pa\] at a radius \[m\].
fn exact(r: f64) -> (f64, f64) {
    if r < 0.2 {
        (5.0 * r, 5.0 + 12.5 * r * r)
    } else if r < 0.4 {
        let pressure = 9.0 + 12.5 * r * r - 20.0 * r + 4.0 * (5.0 * r).ln();
        (2.0 - 5.0 * r, pressure)
    } else {
        (0.0, 3.0 + 4.0 * 2.0_f64.ln())
    }
}

/// Velocity of the vortex.
fn turning([x, y]: [f64; 2]) -> [f64; 2] {
    let r = x.hypot(y).max(1e-12);
    let (speed, _) = exact(r);
    [-speed * y / r, speed * x / r]
}

fn run(case: &Case<'_>) -> Result<Outcome, Failure> {
    let (ratio, alpha) = (case.number("h/dx")?, case.number("alpha")?);
    let scheme: Scheme<f64, 2> = match case.text("viscosity")? {
        "gas" => schemes::gas().h_over_dx(ratio).compose(),
        "signal" => plain(signal(alpha)).h_over_dx(ratio).compose(),
        "limited" => plain(LimitedMonaghanGingold { alpha, beta: 2.0 })
            .h_over_dx(ratio)
            .compose(),
        _ => plain(switched(alpha)).h_over_dx(ratio).compose(),
    };
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let gas = Material::new("gas", law);
    let gas = Body::block("gas", gas, [-0.5; 2], [0.5; 2], case.spacing());
    let gas = gas.start(|x, own| Start {
        velocity: turning(x),
        energy: law.energy(exact(x[0].hypot(x[1])).1, 1.0),
        ..own
    });
    let mut gas = Scene::new(scheme)
        .body(gas)
        .boundary(Periodic::along(0, -0.5, 0.5))
        .boundary(Periodic::along(1, -0.5, 0.5))
        .build()?;
    gas.run_until(1.0)?;
    let error = relative_l1(gas.all().flat_map(|particle| {
        let (found, exact) = (particle.velocity(), turning(particle.position()));
        [0, 1].map(|d| (found[d], exact[d], particle.mass() / particle.density()))
    }));
    Ok(Outcome::of(&gas).value(VELOCITY, error))
}

pub fn problem(quick: bool) -> Problem {
    let counts: &[u32] = if quick {
        &[16, 20, 24]
    } else {
        &[24, 32, 48, 64, 96]
    };
    let study = sweep(TEXT, counts, quick, methods(), run);
    Problem {
        text: TEXT,
        study: study.quantity(Quantity::measured(VELOCITY)),
    }
}
