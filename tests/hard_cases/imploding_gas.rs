//! What the cases of gas in a plane and in space share: the ready gas with conduction, Noh's implosion and Sedov's blast.
//! The control of plateaus, of gas at rest behind a shock and of fronts has neither viscosity nor conduction, that of energy its symmetric form.

use super::harness::{Row, Varied, seed};
use meshfree::effect::ArtificialConduction;
use meshfree::kernel::{Kernel, WendlandC4};
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scheme::EnergyForm;
use meshfree::study::noh::Noh;
use meshfree::study::sedov::Sedov;
use meshfree::term::viscosity::LimitedMonaghanGingold;
use std::time::Instant;

/// How strong viscosity and conduction are.
pub type Cure = [f64; 2];

pub const CONDUCTING: Cure = [1.0, 0.5];
pub const BARE: Cure = [0.0, 0.0];
/// The case, and the control of its energy.
pub const FORMS: [EnergyForm; 2] = [EnergyForm::Compatible, EnergyForm::Symmetric];

/// A gas with so much viscosity and conduction. Without viscosity smoothing lengths in voids make a run that does not end: there
/// they are fixed.
pub fn gas<const D: usize>([viscosity, conduction]: Cure, form: EnergyForm) -> Scheme<f64, D>
where
    WendlandC4: Kernel<D>,
{
    let smoothing = if viscosity > 0.0 {
        Smoothing::Consistent(ConsistentSmoothing {
            smallest: 0.02,
            largest: 50.0,
        })
    } else {
        Smoothing::Fixed
    };
    let viscosity = LimitedMonaghanGingold {
        alpha: viscosity,
        beta: viscosity,
    };
    schemes::gas()
        .with_viscosity(viscosity)
        .with(smoothing)
        .with(ArtificialConduction {
            strength: conduction,
            ..ArtificialConduction::default()
        })
        .energy(form)
        .compose()
}

fn energy<const D: usize>(own: &Simulation<f64, D>) -> f64 {
    own.ledger().whole.total_energy()
}

fn length<const D: usize>(x: [f64; D]) -> f64 {
    x.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Points of a lattice with so many a metre within a metre of the origin along every axis, none on it.
fn lattice<const D: usize>(count: usize) -> impl Iterator<Item = [f64; D]> {
    let across = 2 * count;
    (0..across.pow(D as u32)).map(move |mut k| {
        let mut x = [0.0; D];
        for x in x.iter_mut().rev() {
            *x = ((k % across) as f64 + 0.5 - count as f64) / count as f64;
            k /= across;
        }
        x
    })
}

/// What an implosion leaves, against the exact one.
#[derive(Clone, Copy, Debug)]
pub struct Implosion {
    /// Error of the mean density from 0.3 to 0.8 of the shock's radius.
    pub plateau: f64,
    /// Root mean square of the speed within 0.8 of the shock's radius, where there is none, over that of the gas that streams in.
    pub speed: f64,
    /// Change of energy.
    pub energy: f64,
}

/// A ball of cold gas that streams to its middle until 0.6 s; infinite errors if the run breaks.
pub fn implosion<const D: usize>(cure: Cure, form: EnergyForm, count: usize) -> Implosion
where
    WendlandC4: Kernel<D>,
{
    let begun = Instant::now();
    let law = IdealGas::new(5.0 / 3.0, 1.0);
    let ball: Vec<_> = lattice::<D>(count).filter(|x| length(*x) < 1.0).collect();
    let body = Body::points_of("gas", Material::new("gas", law), ball, 1.0 / count as f64)
        .jitter(0.01, seed(11))
        .start(|x, own| Start {
            velocity: x.map(|c| -c / length(x)),
            energy: law.energy(1e-6, 1.0),
            ..own
        });
    let scene = Scene::new(gas(cure, form)).body(body).varied();
    let mut own = scene.build().expect("a ball");
    let before = energy(&own);
    if let Err(error) = own.run_until(0.6) {
        println!("{cure:?}: {error}");
        let broken = f64::INFINITY;
        return Implosion {
            plateau: broken,
            speed: broken,
            energy: broken,
        };
    }
    let exact = Noh::new(D as u8).expect("a case");
    let shock = exact.shock_radius(own.time());
    let within = |low: f64| {
        let inside = own.all().filter(move |p| {
            let r = length(p.position());
            r > low * shock && r < 0.8 * shock
        });
        inside.collect::<Vec<_>>()
    };
    let (plateau, inside) = (within(0.3), within(0.0));
    let mean = plateau.iter().map(|p| p.density()).sum::<f64>() / plateau.len() as f64;
    let squares = inside.iter().map(|p| length(p.velocity()).powi(2));
    let speed = (squares.sum::<f64>() / inside.len() as f64).sqrt();
    let heat: f64 = own.all().map(|p| p.mass() * p.energy()).sum();
    let mass: f64 = own.all().map(|p| p.mass()).sum();
    // What is behind the shock started within (t + its radius), and has ½ J/kg.
    let stopped = 0.5 * mass * (own.time() + shock).powi(D as i32);
    println!(
        "{cure:?} {form:?}: t {} steps {} plateau {mean} of {} particles, heat {heat} of {stopped}, speed {speed}, {:?}",
        own.time(),
        own.steps(),
        plateau.len(),
        begun.elapsed()
    );
    Implosion {
        plateau: (mean / exact.density_behind() - 1.0).abs(),
        speed,
        energy: (energy(&own) / before - 1.0).abs(),
    }
}

/// The control of the energy has its symmetric form.
pub fn closed(case: &'static str, [value, control]: [f64; 2]) {
    Row {
        case,
        criterion: "change of energy; control: symmetric energy",
        value,
        control,
    }
    .at_most(1e-10);
}

/// Where in space the exact density of a blast is largest once a kernel sum has smoothed it, whose h is that of a gas of density
/// 1 over ρ^(1/D), in radii of the shock: where a sum over particles has its front.
fn smoothed_front<const D: usize>(exact: &Sedov, time: f64, h_at_rest: f64) -> f64
where
    WendlandC4: Kernel<D>,
{
    /// Points of the sum in a support, along the radius and away from it, about which all is alike.
    const FINE: i32 = 160;
    let shock = exact.shock_radius(time);
    let density = |r: f64| {
        if r < shock {
            exact.state(r, time).expect("a radius").density
        } else {
            1.0
        }
    };
    let support = Kernel::<D>::support(&WendlandC4);
    let offsets = (-FINE..FINE).flat_map(|i| (0..FINE).map(move |j| [i, j]));
    let offsets = offsets.map(|at| at.map(|k| (f64::from(k) + 0.5) / f64::from(FINE) * support));
    let weights: Vec<_> = offsets
        .filter(|[x, y]| x.hypot(*y) < support)
        .map(|[x, y]| {
            let shape = Kernel::<D>::shape(&WendlandC4, x.hypot(y));
            (x, y, shape * y.powi(D as i32 - 2))
        })
        .collect();
    let whole: f64 = weights.iter().map(|(.., w)| w).sum();
    let smoothed = |r: f64, h: f64| {
        let parts = weights
            .iter()
            .map(|(x, y, w)| w * density((r + x * h).hypot(y * h)));
        parts.sum::<f64>() / whole
    };
    let mut rho = 2.0;
    let peaks = (0..40).map(|k| {
        let radius = 0.9 + 0.0025 * f64::from(k);
        for _ in 0..8 {
            let h = h_at_rest / f64::powf(rho, 1.0 / D as f64);
            rho = 0.5 * (rho + smoothed(radius * shock, h));
        }
        (radius, rho)
    });
    peaks.max_by(|a, b| a.1.total_cmp(&b.1)).expect("radii").0
}

/// The energy of 1 J, or 1 J/m, laid over so many spacings, until 0.5 s: mean radius of the densest hundred particles over that of the
/// shock, and change of energy; infinite if the run breaks.
fn blast<const D: usize>(cure: Cure, form: EnergyForm, count: usize, wide: f64) -> [f64; 2]
where
    WendlandC4: Kernel<D>,
{
    let begun = Instant::now();
    let law = IdealGas::new(1.4, 1.0);
    let spacing = 1.0 / count as f64;
    let exact = Sedov::new(D as u8, 1.4, 1.0, 1.0).expect("a blast");
    let bump = |x: [f64; D]| {
        let r = length(x) / (wide * spacing);
        (1.0 - r * r).max(0.0).powi(2)
    };
    let material = Material::new("gas", law);
    let base = Body::block("gas", material, [-1.0; D], [1.0; D], spacing).jitter(0.01, seed(11));
    let whole: f64 = base.points().iter().map(|x| bump(*x)).sum::<f64>() * spacing.powi(D as i32);
    let body = base.start(|x, own| Start {
        energy: law.energy(1e-6, 1.0) + bump(x) / whole,
        ..own
    });
    let scene = Scene::new(gas(cure, form)).body(body).varied();
    let mut own = scene.build().expect("gas");
    let before = energy(&own);
    if let Err(error) = own.run_until(0.5) {
        println!("{cure:?}: {error}");
        return [f64::INFINITY; 2];
    }
    let dense = own.all().map(|p| (p.density(), length(p.position())));
    let mut dense: Vec<_> = dense.filter(|(_, r)| *r < 1.0).collect();
    dense.sort_by(|a, b| b.0.total_cmp(&a.0));
    let front = dense[..100].iter().map(|(_, r)| r).sum::<f64>() / 100.0;
    let shock = exact.shock_radius(own.time());
    println!(
        "{cure:?} {form:?}: t {} steps {} front {front} of {shock}, peak {}, {:?}",
        own.time(),
        own.steps(),
        dense[0].0,
        begun.elapsed()
    );
    [front / shock, (energy(&own) / before - 1.0).abs()]
}

/// A blast, its energy laid over so many spacings, with both controls.
pub fn sedov<const D: usize>(case: &'static str, count: usize, wide: f64)
where
    WendlandC4: Kernel<D>,
{
    let runs = FORMS.map(|form| blast::<D>(CONDUCTING, form, count, wide));
    let bare = blast::<D>(BARE, EnergyForm::Compatible, count, wide);
    let exact = Sedov::new(D as u8, 1.4, 1.0, 1.0).expect("a blast");
    let h = Kernel::<D>::h_over_dx(&WendlandC4) / count as f64;
    let front = smoothed_front::<D>(&exact, 0.5, h);
    println!(
        "{case}: the smoothed front is at {front} of the shock, that of the gas at {}",
        runs[0][0]
    );
    Row {
        case,
        criterion: "error of the radius of the front as a kernel smooths it; control: no viscosity, fixed h",
        value: (runs[0][0] / front - 1.0).abs(),
        control: (bare[0] / front - 1.0).abs(),
    }
    .at_most(0.01);
    closed(case, runs.map(|run| run[1]));
}
