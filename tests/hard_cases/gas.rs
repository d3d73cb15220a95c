//! Gases in one dimension: expansion into near vacuum, Sod, a pressure ratio of 10⁶, two blasts, Noh's implosion.
//! Others invert the order of particles or lose energy; the cures are limited viscosity and artificial conduction.

use super::harness::{Row, Varied, same_bits, seed};
use meshfree::effect::ArtificialConduction;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::simulation::{StabilityReport, Thresholds};
use meshfree::study::noh::Noh;
use meshfree::study::riemann::{Gas, GasState, RiemannProblem};
use meshfree::term::viscosity::LimitedMonaghanGingold;

const GAMMA: f64 = 1.4;

/// How strong viscosity and artificial conduction are.
#[derive(Clone, Copy, Debug)]
struct Cure {
    viscosity: f64,
    conduction: f64,
}

/// The ready gas.
const READY: Cure = Cure {
    viscosity: 1.0,
    conduction: 0.0,
};
/// With nothing that holds particles apart in a shock.
const NONE: Cure = Cure {
    viscosity: 0.0,
    ..READY
};
/// The ready gas with the default of the conduction.
const CONDUCTING: Cure = Cure {
    conduction: 0.5,
    ..READY
};

/// A gas whose smoothing lengths grow to at most so many times the first.
fn scheme(cure: Cure, largest: f64) -> Scheme<f64, 1> {
    let viscosity = LimitedMonaghanGingold {
        alpha: cure.viscosity,
        beta: cure.viscosity,
    };
    let conduction = ArtificialConduction {
        strength: cure.conduction,
        ..ArtificialConduction::default()
    };
    schemes::gas()
        .with_viscosity(viscosity)
        .with(ConsistentSmoothing {
            smallest: 0.02,
            largest,
        })
        .with(conduction)
        .compose()
}

/// Gas between planes of symmetry, of equal masses: on both sides of x = 0 so many particles a unit of mass, density ρ and
/// pressure p, and a velocity.
pub fn tube(
    scheme: Scheme<f64, 1>,
    gamma: f64,
    range: [f64; 2],
    spacing: f64,
    start: impl Fn(f64) -> (f64, f64),
) -> Simulation<f64, 1> {
    let law = IdealGas::new(gamma, 1.0);
    let body = Body::block(
        "gas",
        Material::new("gas", law),
        [range[0]],
        [range[1]],
        spacing,
    )
    .jitter(0.01, seed(11))
    .start(|[x]: [f64; 1], own| {
        let (pressure, velocity) = start(x);
        Start {
            velocity: [velocity],
            energy: law.energy(pressure, 1.0),
            ..own
        }
    });
    let mut tube = Scene::new(scheme)
        .body(body)
        .boundary(MirrorPlane::symmetry([range[0]], [-1.0]))
        .boundary(MirrorPlane::symmetry([range[1]], [1.0]))
        .varied()
        .build()
        .expect("a tube");
    tube.keep_stability(Thresholds {
        energy_closure: 1e-10,
        // What a plane of symmetry gives is booked; rounding of what blasts give is larger than that of what moves.
        momentum: 1e-9,
        voids: f64::INFINITY,
        ..Thresholds::default()
    });
    tube
}

/// Pairs of neighbours in the scene that have changed sides, over all.
fn inverted(tube: &Simulation<f64, 1>) -> f64 {
    let x: Vec<f64> = tube.all().map(|p| p.position()[0]).collect();
    let wrong = x.windows(2).filter(|pair| pair[1] <= pair[0]).count();
    wrong as f64 / x.len() as f64
}

/// L1 error of the density against a Riemann problem, over the mean density, and the report.
fn riemann(cure: Cure, sides: [f64; 2], end: f64, count: usize) -> (f64, f64, StabilityReport) {
    let mut own = tube(
        scheme(cure, 50.0),
        GAMMA,
        [-0.5, 0.5],
        1.0 / count as f64,
        |x| (if x < 0.0 { sides[0] } else { sides[1] }, 0.0),
    );
    let ended = own.run_until(end);
    // A control may break; the case may not.
    assert!(cure.viscosity == 0.0 || ended.is_ok(), "{ended:?}");
    let error = density_error(&own, sides);
    let report = own.stability();
    println!(
        "{cure:?}: {ended:?} L1 {error} inverted {}\n{report}",
        inverted(&own)
    );
    (error, inverted(&own), report)
}

/// L1 error of the density against the Riemann problem of a gas at rest with these pressures, over the mean density.
pub fn density_error(own: &Simulation<f64, 1>, sides: [f64; 2]) -> f64 {
    let state = |pressure| GasState {
        density: 1.0,
        velocity: 0.0,
        pressure,
    };
    let gas = Gas::ideal(GAMMA);
    let exact = RiemannProblem::new(gas, state(sides[0]), gas, state(sides[1])).expect("a problem");
    let error = own.all().map(|p| {
        let rho = exact.sample(p.position()[0] / own.time()).density;
        p.mass() / p.density() * (p.density() - rho).abs()
    });
    error.sum()
}

fn shocks(case: &'static str, sides: [f64; 2], end: f64, [bound, inverted]: [f64; 2]) {
    let (error, order, report) = riemann(READY, sides, end, 400);
    let (noisy, lost, broken) = riemann(NONE, sides, end, 400);
    assert!(report.verdict.is_stable(), "{report}");
    assert!(broken.verdict.breaks("nearest"), "{broken}");
    let row = |criterion, value, control| Row {
        case,
        criterion,
        value,
        control,
    };
    row("L1 error of density", error, noisy).at_most(bound);
    row("share of inverted neighbours", order, lost).at_most(inverted);
}

#[test]
fn a_shock_tube_keeps_its_waves() {
    shocks("shock tube 10:1, 400", [1.0, 0.1], 0.15, [0.02, 0.0]);
}

#[test]
fn a_strong_blast_keeps_its_waves() {
    let (case, sides) = ("blast 10⁶:1, 400", [1e3, 1e-3]);
    shocks(case, sides, 0.01, [0.015, 0.0]);
    let (error, order, report) = riemann(CONDUCTING, sides, 0.01, 400);
    assert!(error <= 0.03 && report.verdict.is_stable(), "{report}");
    assert_eq!(order, 0.0);
}

/// Gas into near vacuum: the front of the exact rarefaction runs at 2c/(γ − 1).
#[test]
fn gas_expands_into_near_vacuum() {
    let run = |largest: f64| {
        let law = IdealGas::new(GAMMA, 1.0);
        let body = Body::block("gas", Material::<f64>::new("gas", law), [0.0], [1.0], 0.005).start(
            |_, own| Start {
                energy: law.energy(1.0, 1.0),
                ..own
            },
        );
        let mut own = Scene::new(scheme(READY, largest))
            .body(body)
            .boundary(MirrorPlane::symmetry([0.0], [-1.0]))
            .varied()
            .build()
            .expect("gas");
        own.keep_stability(Thresholds {
            limited: 1.0,
            nearest: 0.0,
            quantile: 0.0,
            voids: f64::INFINITY,
            clumping: f64::INFINITY,
            ..Thresholds::default()
        });
        own.run_until(0.3).expect("a run");
        println!("{}", own.stability());
        // The density at a tenth of the way from the head to the front says how the rarefaction is resolved.
        let sound = GAMMA.sqrt();
        let exact = |x: f64| {
            let xi = ((x - 1.0) / 0.3).clamp(-sound, 5.0 * sound);
            (5.0 / 6.0 * (1.0 - xi / (5.0 * sound)))
                .clamp(0.0, 1.0)
                .powi(5)
        };
        let error = own
            .all()
            .map(|p| p.mass() / p.density() * (p.density() - exact(p.position()[0])).abs());
        let error: f64 = error.sum();
        let negative = own
            .all()
            .filter(|p| p.energy() < 0.0 || p.density() <= 1e-12)
            .count();
        // The last particle holds the last two-hundredth of the mass: its place is where half of that is beyond in the exact
        // rarefaction, of which ρ = (5/6 (1 − ξ/5c))⁵ leaves t 5c (5/6)⁵ s⁶/6 beyond s = 1 − ξ/5c.
        let beyond = 6.0 * 0.0025 / (0.3 * 5.0 * sound * (5.0_f64 / 6.0).powi(5));
        let exact = 1.0 + (1.0 - beyond.powf(1.0 / 6.0)) * 5.0 * sound * 0.3;
        let last = own.all().map(|p| p.position()[0]).fold(0.0, f64::max);
        let front = ((last - 1.0) / (exact - 1.0) - 1.0).abs();
        println!("largest h {largest}: L1 {error}, negative {negative}, front {front}");
        (error, negative, front)
    };
    let (error, negative, front) = run(50.0);
    let (held, _, slow) = run(1.0);
    assert_eq!(negative, 0);
    let row = |criterion, value, control| Row {
        case: "expansion into near vacuum, 200",
        criterion,
        value,
        control,
    };
    row("L1 error of density; control: h fixed", error, held).at_most(0.02);
    row("error of the last particle's path", front, slow).at_most(0.05);
}

/// Mean error of Noh's plateau at 0.6 s, from 0.3 to 0.8 of the shock's radius.
pub fn plateau_error(own: &Simulation<f64, 1>) -> f64 {
    let exact = Noh::new(1).expect("a case");
    let radius = exact.shock_radius(0.6);
    let plateau = own.all().filter(|p| {
        let r = p.position()[0].abs();
        r > 0.3 * radius && r < 0.8 * radius
    });
    let off: Vec<f64> = plateau
        .map(|p| (p.density() / exact.density_behind() - 1.0).abs())
        .collect();
    off.iter().sum::<f64>() / off.len() as f64
}

/// Noh's implosion; the plateau, and the heat that stays in the particles that are stopped first.
#[test]
fn noh_implodes_to_a_plateau() {
    let exact = Noh::new(1).expect("a case");
    let run = |cure: Cure| {
        let gamma = 5.0 / 3.0;
        let scheme = scheme(cure, 50.0);
        let mut own = tube(scheme, gamma, [-1.0, 1.0], 0.005, |x| (1e-6, -x.signum()));
        let ended = own.run_until(0.6);
        assert!(cure.viscosity == 0.0 || ended.is_ok(), "{ended:?}");
        let radius = exact.shock_radius(0.6);
        let error = plateau_error(&own);
        // All kinetic energy, ½ J/kg, becomes heat where it is stopped.
        let middle = own.all().filter(|p| p.position()[0].abs() < 0.3 * radius);
        let hottest = middle.map(|p| p.energy() / 0.5).fold(0.0, f64::max);
        println!(
            "{cure:?} {ended:?} plateau error {error}, hottest {hottest}, inverted {}\n{}",
            inverted(&own),
            own.stability()
        );
        (error, hottest)
    };
    let ((error, hot), (broken, _)) = (run(READY), run(NONE));
    let row = |criterion, value, control| Row {
        case: "Noh's implosion 1D, 400",
        criterion,
        value,
        control,
    };
    row("mean error of the plateau", error, broken).at_most(0.05);
    let (error, even) = run(CONDUCTING);
    assert!(error < 0.01, "the plateau suffers: {error}");
    row(
        "energy of the hottest over exact; artificial conduction",
        even,
        hot,
    )
    .at_most(1.3);
}

/// Two blasts in a closed tube (Woodward & Colella 1984), to 0.038: there is no closed form, so order and energy are held. The
/// control is stopped after twice the steps of the case, since pairs that pass each other shorten
/// them.
#[test]
fn two_blasts_meet() {
    let run = |cure: Cure, most: u64| {
        let pressure = |x: f64| {
            if x < 0.1 {
                1000.0
            } else if x < 0.9 {
                0.01
            } else {
                100.0
            }
        };
        let start = |x| (pressure(x), 0.0);
        let scheme = scheme(cure, 50.0);
        let mut own = tube(scheme, GAMMA, [0.0, 1.0], 1.0 / 400.0, start);
        while own.time() < 0.038 && own.steps() < most {
            let left = 0.038 - own.time();
            own.step_at_most(left).expect("a step");
        }
        let peak = own.all().map(|p| p.density()).fold(0.0, f64::max);
        let report = own.stability();
        println!(
            "t {} peak {peak} inverted {}\n{report}",
            own.time(),
            inverted(&own)
        );
        (inverted(&own), report)
    };
    let (order, report) = run(READY, u64::MAX);
    let (lost, broken) = run(NONE, 2 * report.steps);
    let closure = report.energy_closure.unwrap_or(f64::NAN);
    assert!(
        closure < 1e-10 && broken.verdict.breaks("nearest"),
        "{report}\n{broken}"
    );
    let row = |criterion, value, control| Row {
        case: "two blasts, 400",
        criterion,
        value,
        control,
    };
    row("share of inverted neighbours", order, lost).at_most(0.0);
    let (held, _) = run(CONDUCTING, u64::MAX);
    row("the same; artificial conduction", held, lost).at_most(0.0);
}

#[test]
fn threads_do_not_change_a_bit() {
    same_bits(|| {
        let scheme = scheme(CONDUCTING, 50.0);
        let mut own = tube(scheme, GAMMA, [-0.5, 0.5], 0.005, |x| {
            (if x < 0.0 { 1e3 } else { 1e-3 }, 0.0)
        });
        own.run_until(0.003).expect("a run");
        own
    });
}
