//! Copper rods at 20 m/s on copper and on PMMA: the pressure along both, the front, and the ripple of the tension behind it.
//! Exact to what Godunov's method leaves on cells a fifth of the finest spacing.

use super::problem::{Problem, Text, method, with};
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
use meshfree::term::MidpointReconstruction;
use meshfree::term::viscosity::{LimitedMonaghanGingold, MonaghanGingold};
use std::sync::Arc;

/// Impact speed \[m/s\], lengths \[m\], the end of a run \[s\], and one in whose middle the target is in tension.
const SPEED: f64 = 20.0;
const STRIKER: f64 = 0.01;
const TARGET: f64 = 0.02;
pub const END: f64 = 3.2e-6;
const TENSE: f64 = 9e-6;

const COPPER: Text = Text {
    key: "rods_copper",
    title: "Copper rod on copper rod",
    setting: "A rod of 10 mm at 20 m/s strikes one of 20 mm at rest; the pressure along both after 3.2 µs, when waves run \
              through both and the first has come back from the free end: mean error over mean pressure. One dimension.",
    words: include_str!("words/rods_copper.md"),
};
const PMMA: Text = Text {
    key: "rods_pmma",
    title: "Copper rod on PMMA rod",
    setting: "As above with a target of PMMA, whose impedance is a tenth.",
    words: include_str!("words/rods_pmma.md"),
};
const TENSION: Text = Text {
    key: "rods_tension",
    title: "Copper rods until the target is in tension",
    setting: "The rods of copper until 9 µs: both have parted, and the waves from the free ends have met in the middle of the \
              target and left it in tension over half of its length. Mean error of pressure over mean pressure, by h/dx; with \
              the rise of the first front, and the ripple: the root mean square by which neighbours in tension differ from a \
              smooth curve, over the tension.",
    words: include_str!("words/rods_tension.md"),
};
const PRESSURE: &str = "pressure along the rods";
const RISE: &str = "rise of the front in µs";
const OVERSHOOT: &str = "overshoot of the front";
const RIPPLE: &str = "ripple in tension";

fn segment(material: &str, length: f64, speed: f64) -> RodSegment {
    let (density, sound, slope, gruneisen) = match material {
        "copper" => (8930.0, 3940.0, 1.49, 2.02),
        _ => (1190.0, 2600.0, 1.52, 1.0),
    };
    let law = MieGruneisen::new(density, sound, slope, gruneisen).with_form(Hugoniot::LamCubic);
    RodSegment::at_rest(Arc::new(law), length, density).moving(speed)
}

/// Exact rods until `end`, to what so many cells leave.
fn exact(target: &str, end: f64, cells: usize) -> Result<GodunovSolution, Failure> {
    Ok(GodunovRods::new(cells)
        .segment(segment("copper", STRIKER, SPEED))
        .contact(Contact::Unilateral)
        .segment(segment(target, TARGET, 0.0))
        .snapshot(end)
        .solve(end)?)
}

const SPACINGS: [f64; 6] = [4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5];

/// Methods on these spacings, against an exact solution of five cells in two of the finest spacing.
fn study(
    text: Text,
    target: &'static str,
    end: f64,
    spacings: &[f64],
    methods: Vec<Method>,
) -> Result<Problem, Failure> {
    let finest = spacings.iter().copied().fold(f64::INFINITY, f64::min);
    let cells = (2.5 * (STRIKER + TARGET) / finest).max(1500.0);
    let reference = exact(target, end, cells as usize)?;
    let study = WorkPrecision::new(text.title, move |case| run(case, target, end, &reference))
        .quantity(Quantity::measured(PRESSURE))
        .quantity(Quantity::measured(RISE))
        .quantity(Quantity::measured(if end > END {
            RIPPLE
        } else {
            OVERSHOOT
        }))
        .spacings(spacings.iter().copied());
    let study = with(study, methods);
    Ok(Problem { text, study })
}

pub fn problem(target: &'static str, quick: bool) -> Result<Problem, Failure> {
    let (text, most) = if target == "copper" {
        (COPPER, usize::MAX)
    } else {
        (PMMA, 7)
    };
    let methods = methods().into_iter().take(most).collect();
    let spacings = &SPACINGS[..if quick { 3 } else { 6 }];
    study(text, target, END, spacings, methods)
}

/// One run of one method of the rods of copper, on any spacing.
pub fn again(name: &str, spacing: f64) -> Result<Problem, Failure> {
    let methods = methods().into_iter().filter(|own| own.name == name);
    study(COPPER, "copper", END, &[spacing], methods.collect())
}

/// The choice of h/dx, with the default and with plain viscosity.
pub fn tension(quick: bool) -> Result<Problem, Failure> {
    let impact = [1.0, 1.1, 1.2, 1.3, 1.5, 1.75, 2.0];
    let impact = impact.map(|ratio| {
        let default = if ratio == 1.2 { " (default)" } else { "" };
        own(
            &format!("impact, h/dx {ratio}{default}"),
            "impact",
            ratio,
            2.0,
            0.55,
        )
    });
    let plain = [1.0, 1.2, 1.5, 2.0];
    let plain = plain.map(|ratio| {
        own(
            &format!("plain α 1, h/dx {ratio}"),
            "plain",
            ratio,
            1.0,
            0.55,
        )
    });
    let methods = impact.into_iter().chain(plain).collect();
    let spacings = &SPACINGS[..if quick { 3 } else { 5 }];
    study(TENSION, "copper", TENSE, spacings, methods)
}

fn own(name: &str, scheme: &str, ratio: f64, alpha: f64, step: f64) -> Method {
    let choices = [("h/dx", ratio), ("alpha", alpha), ("step", step)];
    method(name, &[("scheme", scheme)], &choices)
}

fn methods() -> Vec<Method> {
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

fn run(
    case: &Case<'_>,
    target: &str,
    end: f64,
    exact: &GodunovSolution,
) -> Result<Outcome, Failure> {
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
            strike::<f64>(scene(scheme.compose(), dx, target)?, end, exact)
        }
        "C2" => {
            let scheme = SchemeBuilder::new(WendlandC2, limited)
                .density(DensityForm::NumberDensity)
                .with(MidpointReconstruction::STANDARD)
                .h_over_dx(ratio);
            strike::<f64>(scene(scheme.compose(), dx, target)?, end, exact)
        }
        "f32" => strike::<f32>(scene(impact().compose(), dx, target)?, end, exact),
        "dkd" => {
            let scene = scene(impact().compose(), dx, target)?;
            strike::<f64>(scene.integrator(DriftKickDrift), end, exact)
        }
        _ => strike::<f64>(scene(impact().compose(), dx, target)?, end, exact),
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

/// One run: the pressure at the end against the exact one, and the front as it passes the middle of the striker.
fn strike<T: Real>(
    scene: Scene<T, 1>,
    end: f64,
    exact: &GodunovSolution,
) -> Result<Outcome, Failure> {
    let mut rods = scene.build()?;
    let dx = rods.spacing();
    let middle = rods.body("striker")?.count() / 2;
    let mut front = History::new();
    front.push(0.0, 0.0);
    rods.run_with(end, |now| {
        if now.time() < 2.4e-6 {
            // The particles of the striker are the first, and two have the middle between them.
            let two = now.all().skip(middle - 1).take(2);
            let pressure = two.map(|particle| particle.pressure()).sum::<f64>();
            front.push(now.time(), 0.5 * pressure);
        }
    })?;
    let cells = &exact.snapshots()[0].cells;
    let of_cells = |x0: f64| {
        let cell = cells.partition_point(|cell| cell.x0 < x0);
        cells[cell.min(cells.len() - 1)].pressure
    };
    let found: Vec<f64> = rods.all().map(|particle| particle.pressure()).collect();
    let place = |k: usize| (k as f64 + 0.5) * dx;
    let each = found.iter().enumerate();
    let error = relative_l1(each.map(|(k, p)| (*p, of_cells(place(k)), 1.0)));
    let plateau = front.plateau(1.9e-6, 2.3e-6)?;
    let outcome = Outcome::of(&rods)
        .value(PRESSURE, error)
        .value(RISE, front.rise(0.0, plateau)? / 1e-6);
    Ok(if end > END {
        outcome.value(RIPPLE, ripple(&found, |k| of_cells(place(k))))
    } else {
        outcome.value(OVERSHOOT, front.overshoot(0.0, plateau)?)
    })
}

/// Root mean square of a fourth difference, which sees what changes from particle to particle and no front that is resolved, over the
/// tension, where the exact rods have nearly the largest. The fourth difference of a wave of two spacings is 16 times its amplitude.
fn ripple(found: &[f64], exact: impl Fn(usize) -> f64) -> f64 {
    let all: Vec<f64> = (0..found.len()).map(exact).collect();
    let most = all.iter().copied().fold(0.0, f64::min);
    let tense = |k: usize| all[k - 2..=k + 2].iter().all(|p| *p < 0.98 * most);
    let (mut squares, mut count) = (0.0, 0.0);
    for k in 2..found.len() - 2 {
        if tense(k) {
            let p = &found[k - 2..=k + 2];
            let fourth = (p[0] - 4.0 * p[1] + 6.0 * p[2] - 4.0 * p[3] + p[4]) / 16.0;
            squares += fourth * fourth;
            count += 1.0;
        }
    }
    (squares / f64::max(count, 1.0)).sqrt() / most.abs()
}
