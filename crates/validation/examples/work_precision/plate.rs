//! A free elastic plate that bends, in two dimensions: its period.
//! Against Timoshenko's beam, and against the limit of its own refinement, which tells one from the other.

use super::problem::{Problem, Text, method, sweep};
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::StudyError;
use meshfree::study::free_beam::FreeBeam;
use meshfree::study::work_precision::{Case, Failure, History, Method, Outcome, Quantity};

const TEXT: Text = Text {
    key: "plate",
    title: "A free elastic plate",
    setting: "A plate of 200 mm by 20 mm (E 2 MPa, ν 0.3975) with the velocity of its first bending; error of its period \
              against Timoshenko's beam. Total Lagrangian, neo-Hookean, two dimensions.",
    words: include_str!("words/plate.md"),
};
const LENGTH: f64 = 0.2;
const HEIGHT: f64 = 0.02;
const DENSITY: f64 = 1000.0;
const YOUNGS: f64 = 2e6;
const POISSON: f64 = 0.3975;
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

fn beam() -> Result<FreeBeam, StudyError> {
    FreeBeam::new(LENGTH, HEIGHT, DENSITY, YOUNGS, POISSON)
}

fn run(case: &Case<'_>) -> Result<Outcome, Failure> {
    let shear = YOUNGS / (2.0 * (1.0 + POISSON));
    let law = Linear::from_elastic_constants(DENSITY, YOUNGS, POISSON);
    let elastic = Material::new("elastic", law).with_shear_modulus(shear);
    let beam = beam()?;
    let scheme: Scheme<f64, 2> = schemes::total_lagrangian()
        .with(NeoHookean)
        .h_over_dx(case.number("h/dx")?)
        .step_factor(case.number("step")?)
        .compose();
    let plate = Body::block("plate", elastic, [0.0; 2], [LENGTH, HEIGHT], case.spacing());
    let plate = plate.start(|[x, _], own| Start {
        velocity: [0.0, 0.01 * beam.shape(x)],
        ..own
    });
    let mut plate = Scene::new(scheme).body(plate).build()?;
    let mut swing = History::new();
    plate.run_with(1.1 * beam.period(), |now| {
        let part = |p: meshfree::simulation::ParticleView<'_, f64, 2>| {
            let [x, _] = p.vector(Field::REFERENCE_POSITION).unwrap_or_default();
            p.velocity()[1] * beam.shape(x)
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

pub fn problem(quick: bool) -> Result<Problem, Failure> {
    let through: &[u32] = if quick {
        &[3, 4, 6]
    } else {
        &[4, 6, 8, 10, 14]
    };
    // Particles through the thickness, as particles a metre.
    let counts: Vec<u32> = through.iter().map(|n| n * 50).collect();
    let study = sweep(TEXT, &counts, quick, methods(), run)
        .quantity(Quantity::exact(PERIOD, beam()?.period()))
        .quantity(Quantity::richardson(LIMIT));
    Ok(Problem { text: TEXT, study })
}
