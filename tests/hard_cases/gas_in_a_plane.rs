//! Gases in two dimensions: Noh's implosion, Sedov's blast, and a contact at which two gases shear (Kelvin–Helmholtz).
//! Others lose energy, heat the middle, or part the gases by a jump of pressure that density and energy make between them.

use super::harness::{Row, Varied, seed};
use meshfree::effect::ArtificialConduction;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::EnergyForm;
use meshfree::study::noh::Noh;
use meshfree::study::sedov::Sedov;
use meshfree::term::viscosity::SignalVelocity;
use std::f64::consts::PI;

/// A gas with so much viscosity and conduction. Without viscosity smoothing lengths in voids make a run that does not end: there
/// they are fixed.
fn gas([viscosity, conduction]: [f64; 2], form: EnergyForm) -> Scheme<f64, 2> {
    let smoothing = if viscosity > 0.0 {
        Smoothing::Consistent {
            smallest: 0.02,
            largest: 50.0,
        }
    } else {
        Smoothing::Fixed
    };
    let viscosity = SignalVelocity {
        alpha: viscosity,
        ..SignalVelocity::STANDARD
    };
    schemes::gas()
        .with_viscosity(viscosity)
        .smoothing(smoothing)
        .with(ArtificialConduction {
            strength: conduction,
            ..ArtificialConduction::default()
        })
        .energy(form)
        .compose()
}

const CONDUCTING: [f64; 2] = [1.0, 0.5];
/// The control of plateaus and fronts: neither viscosity nor conduction, and a fixed smoothing length.
const BARE: [f64; 2] = [0.0, 0.0];

fn energy(own: &Simulation<f64, 2>) -> f64 {
    own.ledger().whole.total_energy()
}

fn radius([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// Mean density from 0.3 to 0.8 of the shock's radius over the exact one less one; change of energy.
fn implosion(cure: [f64; 2], form: EnergyForm, count: usize) -> [f64; 2] {
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let spacing = 1.0 / count as f64;
    let n = count as i64;
    let places = (-n..n).flat_map(|i| (-n..n).map(move |j| [i, j]));
    let places = places.map(|ij| ij.map(|k| (k as f64 + 0.5) * spacing));
    let disc: Vec<_> = places.filter(|x| radius(*x) < 1.0).collect();
    let body = Body::points_of("gas", Material::new("gas", law), disc, spacing)
        .jitter(0.01, seed(11))
        .start(|x, own| Start {
            velocity: x.map(|c| -c / radius(x)),
            energy: law.energy(1e-6, 1.0),
            ..own
        });
    let mut own = Scene::new(gas(cure, form))
        .body(body)
        .varied()
        .build()
        .expect("a disc");
    let before = energy(&own);
    if let Err(error) = own.run_until(0.6) {
        println!("{cure:?}: {error}");
        return [f64::INFINITY; 2];
    }
    let exact = Noh::new(2).expect("a case");
    let shock = exact.shock_radius(own.time());
    let plateau = own.all().filter(|p| {
        let r = radius(p.position());
        r > 0.3 * shock && r < 0.8 * shock
    });
    let all: Vec<f64> = plateau.map(|p| p.density()).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let coldest = own.all().map(|p| p.energy()).fold(f64::INFINITY, f64::min);
    println!(
        "{form:?} t {} steps {} plateau {mean} coldest {coldest}",
        own.time(),
        own.steps()
    );
    [
        (mean / exact.density_behind() - 1.0).abs(),
        (energy(&own) / before - 1.0).abs(),
    ]
}

/// The control of the energy has its symmetric form.
fn closed(case: &'static str, [value, control]: [f64; 2]) {
    Row {
        case,
        criterion: "change of energy; control: symmetric energy",
        value,
        control,
    }
    .at_most(1e-10);
}

#[test]
fn noh_implodes_to_a_plateau_in_a_plane() {
    let case = "Noh's implosion 2D, 50 a radius";
    let forms = [EnergyForm::Compatible, EnergyForm::Symmetric];
    let runs = forms.map(|form| implosion(CONDUCTING, form, 50));
    let bare = implosion(BARE, EnergyForm::Compatible, 50);
    Row {
        case,
        criterion: "error of the mean of the plateau; control: no viscosity, fixed h",
        value: runs[0][0],
        control: bare[0],
    }
    .at_most(0.15);
    closed(case, runs.map(|run| run[1]));
}

/// Mean radius of the densest hundred particles over that of the shock, less one; change of energy.
fn blast(cure: [f64; 2], form: EnergyForm, count: usize) -> [f64; 2] {
    let law = IdealGas::new(1.4, 1.0);
    let spacing = 1.0 / count as f64;
    let exact = Sedov::new(2, 1.4, 1.0, 1.0).expect("a blast");
    // The energy of 1 J/m is laid over four spacings.
    let bump = |x: [f64; 2]| {
        (1.0 - (radius(x) / (4.0 * spacing)).powi(2))
            .max(0.0)
            .powi(2)
    };
    let base = Body::block(
        "gas",
        Material::new("gas", law),
        [-1.0; 2],
        [1.0; 2],
        spacing,
    );
    let base = base.jitter(0.01, seed(11));
    let whole: f64 = base.points().iter().map(|x| bump(*x)).sum::<f64>() * spacing * spacing;
    let body = base.start(|x, own| Start {
        energy: law.energy(1e-6, 1.0) + bump(x) / whole,
        ..own
    });
    let mut own = Scene::new(gas(cure, form))
        .body(body)
        .varied()
        .build()
        .expect("gas");
    let before = energy(&own);
    if let Err(error) = own.run_until(0.5) {
        println!("{cure:?}: {error}");
        return [f64::INFINITY; 2];
    }
    let mut dense: Vec<_> = own
        .all()
        .map(|p| (p.density(), radius(p.position())))
        .collect();
    dense.retain(|(_, r)| *r < 1.0);
    dense.sort_by(|a, b| b.0.total_cmp(&a.0));
    let front = dense[..100].iter().map(|(_, r)| r).sum::<f64>() / 100.0;
    println!(
        "{form:?} t {} front {front} peak {}",
        own.time(),
        dense[0].0
    );
    [
        (front / exact.shock_radius(own.time()) - 1.0).abs(),
        (energy(&own) / before - 1.0).abs(),
    ]
}

#[test]
fn a_point_blast_runs_as_sedov_says() {
    let case = "Sedov's blast 2D, 50 a metre";
    let forms = [EnergyForm::Compatible, EnergyForm::Symmetric];
    let runs = forms.map(|form| blast(CONDUCTING, form, 50));
    let bare = blast(BARE, EnergyForm::Compatible, 50);
    Row {
        case,
        criterion: "error of the radius of the front; control: no viscosity, fixed h",
        value: runs[0][0],
        control: bare[0],
    }
    .at_most(0.02);
    closed(case, runs.map(|run| run[1]));
}

/// A band of gas of twice the density that slides through another at a speed of one, both of one pressure, and a wave on
/// their contacts: its growth over a span, as an exponent, and the largest error of a pressure at the start of it.
fn shear(cure: [f64; 2], count: usize, [from, to]: [f64; 2]) -> [f64; 2] {
    const PRESSURE: f64 = 2.5;
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let body = Body::block(
        "gas",
        Material::new("gas", law),
        [0.0; 2],
        [1.0; 2],
        1.0 / count as f64,
    )
    .start(|[x, y]: [f64; 2], _| {
        let band = (y - 0.5).abs() < 0.25;
        let density = if band { 2.0 } else { 1.0 };
        let near = |contact: f64| (-4.0 * PI * (y - contact).abs()).exp();
        Start {
            velocity: [
                if band { 0.5 } else { -0.5 },
                0.025 * (4.0 * PI * x).sin() * (near(0.25) + near(0.75)),
            ],
            density,
            energy: law.energy(PRESSURE, density),
        }
    });
    let mut own = Scene::new(gas(cure, EnergyForm::Compatible))
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .varied()
        .build()
        .expect("gas");
    // The size of the mode that linear theory grows: sin and cos of its wavenumber, e^(−k |y|) from each contact.
    let size = |own: &Simulation<f64, 2>| {
        let mut sums = [0.0; 3];
        for p in own.all() {
            let [x, y] = p.position();
            let from = (y - 0.25).abs().min((y - 0.75).abs());
            let weight = p.mass() / p.density() * (-4.0 * PI * from).exp();
            let v = weight * p.velocity()[1];
            let [s, c] = [(4.0 * PI * x).sin(), (4.0 * PI * x).cos()];
            sums = [sums[0] + v * s, sums[1] + v * c, sums[2] + weight];
        }
        2.0 * sums[0].hypot(sums[1]) / sums[2]
    };
    own.run_until(from).expect("gas");
    let first = size(&own);
    let jump = own
        .all()
        .map(|p| (p.pressure() / PRESSURE - 1.0).abs())
        .fold(0.0, f64::max);
    own.run_until(to).expect("gas");
    println!(
        "{cure:?}: {} from {first} to {}, pressure {jump}",
        (size(&own) / first).ln(),
        size(&own)
    );
    [(size(&own) / first).ln(), jump]
}

#[test]
fn a_shear_between_gases_rolls_up() {
    let span = [0.1, 0.4];
    let [mixed, parted] = [[0.1, 0.5], [0.1, 0.0]].map(|cure| shear(cure, 64, span));
    // Of a sharp contact without compression: k Δu √(ρ₁ρ₂)/(ρ₁ + ρ₂).
    let linear = 4.0 * PI * 2.0_f64.sqrt() / 3.0 * (span[1] - span[0]);
    println!(
        "growth over that of linear theory {} {}",
        mixed[0] / linear,
        parted[0] / linear
    );
    let row = |criterion, value, control| Row {
        case: "Kelvin–Helmholtz 2:1, 64²",
        criterion,
        value,
        control,
    };
    row(
        "largest error of pressure at the contacts, 0.1 s",
        mixed[1],
        parted[1],
    )
    .at_most(0.1);
}
