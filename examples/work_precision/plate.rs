//! A free elastic plate that bends, in two dimensions: its period.
//! Against Timoshenko's beam, and against the limit of its own refinement, which tells one from the other.

use crate::problem::{Problem, Text, method, sweep};
use core::f64::consts::TAU;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::work_precision::{Case, Failure, History, Method, Outcome, Quantity};

const TEXT: Text = Text {
    key: "plate",
    title: "A free elastic plate",
    setting: "A plate of 200 mm by 20 mm (E 2 MPa, ν 0.3975) with the velocity of its first bending; error of its period \
              against Timoshenko's beam. Total Lagrangian, neo-Hookean, two dimensions.",
    words: include_str!("words/plate.md"),
    errors: &[0.03, 0.01, 0.003],
    seconds: &[1.0, 60.0],
};
const LENGTH: f64 = 0.2;
const HEIGHT: f64 = 0.02;
const DENSITY: f64 = 1000.0;
const YOUNGS: f64 = 2e6;
const POISSON: f64 = 0.3975;
/// Of Euler's free beam: cosh(k) cos(k) = 1.
const ROOT: f64 = 4.730_040_744_862_704;
const PERIOD: &str = "period of bending";
const LIMIT: &str = "period of bending against its own limit";

fn methods() -> Vec<Method> {
    let own =
        |name: &str, ratio: f64, step: f64| method(name, &[], &[("h/dx", ratio), ("step", step)]);
    vec![
        own("h/dx 0.8 (default)", 0.8, 0.55),
        own("h/dx 0.9", 0.9, 0.55),
        own("h/dx 1.2", 1.2, 0.55),
        own("h/dx 0.8, half the step", 0.8, 0.275),
    ]
}

/// Period \[s\] of the first bending of a free beam by Timoshenko (Huang 1961, J. Appl. Mech. 28, 579, case of free ends),
/// with a shear coefficient of 5/6, in plane strain.
fn timoshenko() -> f64 {
    let stiffness = YOUNGS / (1.0 - POISSON * POISSON) * HEIGHT.powi(3) / 12.0;
    let shear = 5.0 / 6.0 * HEIGHT * YOUNGS / (2.0 * (1.0 + POISSON));
    let square = LENGTH * LENGTH;
    let [rotary, sheared] = [
        HEIGHT * HEIGHT / 12.0 / square,
        stiffness / (shear * square),
    ];
    let unbalance = |omega: f64| {
        let b = omega * square * (DENSITY * HEIGHT / stiffness).sqrt();
        let root = ((rotary - sheared).powi(2) + 4.0 / (b * b)).sqrt();
        let [low, high] =
            [-1.0, 1.0].map(|sign| b * (0.5 * (sign * (rotary + sheared) + root)).sqrt());
        let third = b * b * rotary * (rotary - sheared).powi(2) + 3.0 * rotary - sheared;
        2.0 - 2.0 * low.cosh() * high.cos()
            + b / (1.0 - b * b * rotary * sheared).sqrt() * third * low.sinh() * high.sin()
    };
    let euler = (ROOT / LENGTH).powi(2) * (stiffness / (DENSITY * HEIGHT)).sqrt();
    let [mut low, mut high] = [0.8 * euler, 1.05 * euler];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if unbalance(low) * unbalance(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    TAU / low
}

fn run(case: &Case<'_>) -> Result<Outcome, Failure> {
    let shear = YOUNGS / (2.0 * (1.0 + POISSON));
    let law = Linear::from_elastic_constants(DENSITY, YOUNGS, POISSON);
    let elastic = Material::new("elastic", law).with_shear_modulus(shear);
    let shape = |x: f64| {
        let (share, k) = (0.982_502_214_576_238, ROOT / LENGTH);
        (k * x).cosh() + (k * x).cos() - share * ((k * x).sinh() + (k * x).sin())
    };
    let scheme: Scheme<f64, 2> = schemes::total_lagrangian()
        .with(NeoHookean)
        .h_over_dx(case.number("h/dx")?)
        .step_factor(case.number("step")?)
        .compose();
    let plate = Body::block("plate", elastic, [0.0; 2], [LENGTH, HEIGHT], case.spacing());
    let plate = plate.start(|[x, _], own| Start {
        velocity: [0.0, 0.01 * shape(x)],
        ..own
    });
    let mut plate = Scene::new(scheme).body(plate).build()?;
    let mut swing = History::new();
    let theory = timoshenko();
    plate.run_with(1.1 * theory, |now| {
        let part = |p: meshfree::simulation::ParticleView<'_, f64, 2>| {
            let [x, _] = p.vector(Field::REFERENCE_POSITION).unwrap_or_default();
            p.velocity()[1] * shape(x)
        };
        swing.push(now.time(), now.all().map(part).sum());
    })?;
    // A quarter and three quarters of a period after the start.
    let zeros: Vec<f64> = swing
        .times()
        .windows(2)
        .zip(swing.values().windows(2))
        .filter(|(_, v)| v[0] * v[1] < 0.0)
        .map(|(t, v)| t[0] + (t[1] - t[0]) * v[0] / (v[0] - v[1]))
        .collect();
    let [quarter, three, ..] = zeros[..] else {
        return Err("the plate does not swing".into());
    };
    let period = 2.0 * (three - quarter);
    Ok(Outcome::of(&plate)
        .value(PERIOD, period)
        .value(LIMIT, period))
}

pub fn problem(quick: bool) -> Problem {
    let through: &[u32] = &[4, 6, 8, 10, 14];
    // Particles through the thickness, as particles a metre.
    let counts: Vec<u32> = through.iter().map(|n| n * 50).collect();
    let study = sweep(TEXT, &counts, quick, methods(), run)
        .quantity(Quantity::exact(PERIOD, timoshenko()))
        .quantity(Quantity::richardson(LIMIT));
    Problem { text: TEXT, study }
}
