//! Copper rods at 20 m/s on copper and on PMMA: the pressure along both, and the front in the middle of the striker.
//! Exact to what Godunov's method leaves on cells a fifth of the finest spacing.

use crate::problem::{Problem, Text, method, with};
use meshfree::integrator::DriftKickDrift;
use meshfree::kernel::{CubicSpline, WendlandC2};
use meshfree::material::catalogue;
use meshfree::material::eos::{Hugoniot, MieGruneisen};
use meshfree::prelude::*;
use meshfree::study::Contact;
use meshfree::study::godunov_rods::{GodunovRods, GodunovSolution, RodSegment};
use meshfree::study::work_precision::{
    Case, Failure, History, Method, Outcome, Quantity, WorkPrecision, relative_l1,
};
use meshfree::term::viscosity::{LimitedMonaghanGingold, MonaghanGingold};
use std::sync::Arc;

/// Impact speed \[m/s\], lengths \[m\], and the end of a run \[s\].
const SPEED: f64 = 20.0;
const STRIKER: f64 = 0.01;
const TARGET: f64 = 0.02;
pub const END: f64 = 3.2e-6;

const COPPER: Text = Text {
    key: "rods_copper",
    title: "Copper rod on copper rod",
    setting: "A rod of 10 mm at 20 m/s strikes one of 20 mm at rest; the pressure along both after 3.2 µs, when waves run \
              through both and the first has come back from the free end: mean error over mean pressure. One dimension.",
    words: include_str!("words/rods_copper.md"),
    errors: &[0.1, 0.03, 0.01],
    seconds: &[0.1, 10.0],
};
const PMMA: Text = Text {
    key: "rods_pmma",
    title: "Copper rod on PMMA rod",
    setting: "As above with a target of PMMA, whose impedance is a tenth.",
    words: include_str!("words/rods_pmma.md"),
    errors: &[0.1, 0.03, 0.01],
    seconds: &[0.1, 10.0],
};

fn segment(material: &str, length: f64, speed: f64) -> RodSegment {
    let (density, sound, slope, gruneisen) = match material {
        "copper" => (8930.0, 3940.0, 1.49, 2.02),
        _ => (1190.0, 2600.0, 1.52, 1.0),
    };
    let law = MieGruneisen::new(density, sound, slope, gruneisen).with_form(Hugoniot::LamCubic);
    RodSegment::at_rest(Arc::new(law), length, density).moving(speed)
}

pub fn problem(target: &'static str, quick: bool) -> Result<Problem, Failure> {
    let reference = GodunovRods::new(if quick { 1500 } else { 6000 })
        .segment(segment("copper", STRIKER, SPEED))
        .contact(Contact::Unilateral)
        .segment(segment(target, TARGET, 0.0))
        .snapshot(END)
        .solve(END)?;
    let spacings = [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5];
    let spacings = &spacings[..if quick { 3 } else { 6 }];
    let study = WorkPrecision::new(
        if target == "copper" {
            COPPER.title
        } else {
            PMMA.title
        },
        move |case| run(case, target, &reference),
    )
    .quantity(Quantity::measured("pressure along the rods"))
    .quantity(Quantity::measured("rise of the front in µs"))
    .quantity(Quantity::measured("overshoot of the front"))
    .spacings(spacings.iter().copied());
    let methods = methods()
        .into_iter()
        .take(if target == "copper" { 12 } else { 7 });
    let study = with(study, methods.collect());
    let text = if target == "copper" { COPPER } else { PMMA };
    Ok(Problem { text, study })
}

fn methods() -> Vec<Method> {
    let own = |name: &str, scheme: &str, ratio: f64, alpha: f64, step: f64| {
        let choices = [("h/dx", ratio), ("alpha", alpha), ("step", step)];
        method(name, &[("scheme", scheme)], &choices)
    };
    vec![
        own("impact, h/dx 1.2 (default)", "impact", 1.2, 2.0, 0.55),
        own("impact, h/dx 1.0", "impact", 1.0, 2.0, 0.55),
        own("impact, h/dx 1.5", "impact", 1.5, 2.0, 0.55),
        own("impact, h/dx 2.0", "impact", 2.0, 2.0, 0.55),
        own("impact, α 1", "impact", 1.2, 1.0, 0.55),
        own("no midpoint, plain α 1", "plain", 1.2, 1.0, 0.55),
        own("no midpoint, plain α 0.25", "plain", 1.2, 0.25, 0.55),
        own("impact, Wendland C2, h/dx 1.2", "C2", 1.2, 2.0, 0.55),
        own("impact, Wendland C2, h/dx 1.5", "C2", 1.5, 2.0, 0.55),
        own("impact, half the step", "impact", 1.2, 2.0, 0.275),
        own("impact, drift–kick–drift", "dkd", 1.2, 2.0, 0.55),
        own("impact, f32", "f32", 1.2, 2.0, 0.55),
    ]
}

fn run(case: &Case<'_>, target: &str, exact: &GodunovSolution) -> Result<Outcome, Failure> {
    let (alpha, step) = (case.number("alpha")?, case.number("step")?);
    let (ratio, dx) = (case.number("h/dx")?, case.spacing());
    let limited = LimitedMonaghanGingold { alpha, beta: 2.0 };
    let impact = || {
        schemes::impact()
            .with_viscosity(limited)
            .h_over_dx(ratio)
            .step_factor(step)
    };
    match case.text("scheme")? {
        "plain" => {
            let plain = MonaghanGingold { alpha, beta: 2.0 };
            let scheme = SchemeBuilder::new(CubicSpline, plain)
                .density(DensityForm::NumberDensity)
                .h_over_dx(ratio)
                .step_factor(step);
            strike::<f64>(scene(scheme.compose(), dx, target)?, exact)
        }
        "C2" => {
            let scheme = SchemeBuilder::new(WendlandC2, limited)
                .density(DensityForm::NumberDensity)
                .midpoint_reconstruction(1.0 / 3.0)
                .h_over_dx(ratio);
            strike::<f64>(scene(scheme.compose(), dx, target)?, exact)
        }
        "f32" => strike::<f32>(scene(impact().compose(), dx, target)?, exact),
        "dkd" => {
            let scene = scene(impact().compose(), dx, target)?;
            strike::<f64>(scene.integrator(DriftKickDrift), exact)
        }
        _ => strike::<f64>(scene(impact().compose(), dx, target)?, exact),
    }
}

pub fn scene<T: Real>(scheme: Scheme<T, 1>, dx: f64, target: &str) -> Result<Scene<T, 1>, Failure> {
    let striker = Body::block("striker", catalogue::copper(), [0.0], [STRIKER], dx);
    let target = Body::block(
        "target",
        catalogue::by_name(target)?,
        [STRIKER],
        [STRIKER + TARGET],
        dx,
    );
    Ok(Scene::new(scheme)
        .body(striker.velocity([SPEED]))
        .body(target))
}

fn strike<T: Real>(scene: Scene<T, 1>, exact: &GodunovSolution) -> Result<Outcome, Failure> {
    let mut rods = scene.build()?;
    let dx = rods.spacing();
    let middle = rods.body("striker")?.count() / 2;
    let mut front = History::new();
    front.push(0.0, 0.0);
    rods.run_with(END, |now| {
        if now.time() < 2.4e-6 {
            // The particles of the striker are the first, and two have the middle between them.
            let two = now.all().skip(middle - 1).take(2);
            let pressure = two.map(|particle| particle.pressure()).sum::<f64>();
            front.push(now.time(), 0.5 * pressure);
        }
    })?;
    let cells = &exact.snapshots()[0].cells;
    let error = relative_l1(rods.all().enumerate().map(|(k, particle)| {
        let x0 = (k as f64 + 0.5) * dx;
        let cell = cells.partition_point(|cell| cell.x0 < x0);
        let cell = &cells[cell.min(cells.len() - 1)];
        (particle.pressure(), cell.pressure, 1.0)
    }));
    let outcome = Outcome::of(&rods).value("pressure along the rods", error);
    let plateau = front.plateau(1.9e-6, 2.3e-6)?;
    Ok(outcome
        .value("rise of the front in µs", front.rise(0.0, plateau)? / 1e-6)
        .value("overshoot of the front", front.overshoot(0.0, plateau)?))
}
