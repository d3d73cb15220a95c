//! Sod's shock tube and Noh's problem in one dimension: two strong shocks with exact solutions.
//! Density of all particles against the exact one, as a mean over the gas.

use super::problem::{Problem, Text, method, sweep};
use meshfree::effect::NoWalls;
use meshfree::kernel::{CubicSpline, WendlandC4};
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::noh::Noh;
use meshfree::study::sod::Sod;
use meshfree::study::work_precision::{Case, Failure, Method, Outcome, Quantity, relative_l1};
use meshfree::sweep::Interaction;
use meshfree::term::viscosity::{CullenDehnen, MonaghanGingold, SignalVelocity};
use meshfree::term::{InternalEnergy, KernelSum, PressureForce};

const SOD: Text = Text {
    key: "sod",
    title: "Sod's shock tube",
    setting: "Gas of γ 1.4, density 1 and pressure 1 against 0.125 and 0.1, in a tube of 1 m with equal masses, after 0.2 s; \
              the spacing is that on the left. Mean error of density over mean density. One dimension.",
    words: include_str!("words/sod.md"),
};
const NOH: Text = Text {
    key: "noh",
    title: "Noh's problem",
    setting: "Cold gas of γ 5/3 runs into a wall at 1 m/s; density after 0.6 s within 0.4 m of the wall, half of it behind the \
              shock. Mean error of density over mean density. One dimension.",
    words: include_str!("words/noh.md"),
};
const QUANTITY: &str = "density";

fn methods() -> Vec<Method> {
    let own = |name: &str, scheme: &str, ratio: f64, alpha: f64| {
        method(
            name,
            &[("scheme", scheme)],
            &[("h/dx", ratio), ("alpha", alpha)],
        )
    };
    vec![
        own("gas, C4, h/dx 1.8 (default)", "gas itself", 0.0, 1.0),
        own("gas, C4, h/dx 1.3", "gas", 1.3, 1.0),
        own("gas, C4, h/dx 1.5", "gas", 1.5, 1.0),
        own("plain force, C4, h/dx 1.8", "plain", 1.8, 1.0),
        own("plain force, C4, h/dx 1.3", "plain", 1.3, 1.0),
        own("plain force, Cullen–Dehnen", "switched", 1.8, 2.0),
        own("plain force, Cullen–Dehnen, h/dx 2.2", "switched", 2.2, 2.0),
        own("cubic, signal velocity, h/dx 1.2", "cubic signal", 1.2, 1.0),
        own("cubic, Monaghan–Gingold, h/dx 1.2", "cubic", 1.2, 1.0),
        own("cubic, Monaghan–Gingold, h/dx 1.5", "cubic", 1.5, 1.0),
    ]
}

/// The effects of a gas with the plain pressure force.
type Plain = (
    ((((), PressureForce), KernelSum), InternalEnergy),
    ConsistentSmoothing,
);

/// A gas with the plain pressure force and a viscosity.
pub fn plain<V>(viscosity: V) -> SchemeBuilder<WendlandC4, V, NoWalls, Plain> {
    SchemeBuilder::new(WendlandC4, viscosity)
        .density(DensityForm::Summation)
        .between_bodies(Interaction::Bonded)
        .with(ConsistentSmoothing {
            smallest: 0.2,
            largest: 5.0,
        })
}

/// The viscosity by signal velocity with some α.
pub fn signal(alpha: f64) -> SignalVelocity {
    SignalVelocity {
        alpha,
        ..SignalVelocity::STANDARD
    }
}

/// The one that rises where gas is compressed, up to a largest α.
pub fn switched(maximum: f64) -> CullenDehnen {
    CullenDehnen {
        maximum,
        ..CullenDehnen::STANDARD
    }
}

fn scheme(case: &Case<'_>) -> Result<Scheme<f64, 1>, Failure> {
    let (ratio, alpha) = (case.number("h/dx")?, case.number("alpha")?);
    let follow = ConsistentSmoothing {
        smallest: 0.02,
        largest: 50.0,
    };
    Ok(match case.text("scheme")? {
        "gas itself" => schemes::gas().compose(),
        "gas" => schemes::gas().with(follow).h_over_dx(ratio).compose(),
        "plain" => plain(signal(alpha)).with(follow).h_over_dx(ratio).compose(),
        "switched" => plain(switched(alpha))
            .with(follow)
            .h_over_dx(ratio)
            .compose(),
        "cubic signal" => SchemeBuilder::new(CubicSpline, signal(alpha))
            .density(DensityForm::Summation)
            .with(follow)
            .h_over_dx(ratio)
            .compose(),
        _ => SchemeBuilder::new(CubicSpline, MonaghanGingold { alpha, beta: 2.0 })
            .density(DensityForm::Summation)
            .with(follow)
            .h_over_dx(ratio)
            .compose(),
    })
}

fn problem(
    text: Text,
    counts: &[u32],
    quick: bool,
    run: impl Fn(&Case<'_>) -> Result<Outcome, Failure> + Send + Sync + 'static,
) -> Problem {
    let study = sweep(text, counts, quick, methods(), run);
    Problem {
        text,
        study: study.quantity(Quantity::measured(QUANTITY)),
    }
}

pub fn sod(quick: bool) -> Problem {
    problem(SOD, &[80, 160, 320, 640, 1280], quick, |case| {
        let gas = IdealGas::new(1.4, 1.0);
        let dx = case.spacing();
        let n = (0.5 / dx).round();
        let left = (0..n as usize).map(|k| -0.5 + (k as f64 + 0.5) * dx);
        // Eight times the spacing at an eighth of the density: the same mass.
        let right = (0..n as usize / 8).map(|k| (k as f64 + 0.5) * 8.0 * dx);
        let points: Vec<_> = left.chain(right).map(|x| [x]).collect();
        let tube = Body::points_of("tube", Material::new("gas", gas), points, dx);
        let tube = tube.start(|x, start| Start {
            energy: if x[0] < 0.0 {
                gas.energy(1.0, 1.0)
            } else {
                gas.energy(0.1, 0.125)
            },
            ..start
        });
        let mut tube = Scene::new(scheme(case)?)
            .body(tube)
            .boundary(MirrorPlane::symmetry([-0.5], [-1.0]))
            .boundary(MirrorPlane::symmetry([0.5], [1.0]))
            .build()?;
        tube.run_until(0.2)?;
        let x: Vec<f64> = tube.all().map(|p| p.position()[0]).collect();
        let exact = Sod::new()?.profile(&x, 0.2)?;
        let pairs = tube.all().zip(exact);
        let error = relative_l1(
            pairs.map(|(p, exact)| (p.density(), exact.density, p.mass() / p.density())),
        );
        Ok(Outcome::of(&tube).value(QUANTITY, error))
    })
}

pub fn noh(quick: bool) -> Problem {
    let counts: &[u32] = if quick {
        &[25, 50, 100]
    } else {
        &[50, 100, 200, 400, 800]
    };
    problem(NOH, counts, quick, |case| {
        let gas = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
        let row = Body::block("gas", gas, [-1.0], [0.0], case.spacing());
        let mut row = Scene::new(scheme(case)?)
            .body(row.velocity([1.0]).energy(1e-8))
            .boundary(MirrorPlane::symmetry([0.0], [1.0]))
            .build()?;
        row.run_until(0.6)?;
        let exact = Noh::new(1)?;
        let mut samples = Vec::new();
        for particle in row.all() {
            let r = -particle.position()[0];
            if (0.0..0.4).contains(&r) {
                let exact = exact.state(r, 0.6)?.density;
                samples.push((
                    particle.density(),
                    exact,
                    particle.mass() / particle.density(),
                ));
            }
        }
        Ok(Outcome::of(&row).value(QUANTITY, relative_l1(samples)))
    })
}
