//! Noh's implosion and Sedov's blast in three dimensions, of which an eighth is run between planes of symmetry.
//! Density against the exact one, on spacings as coarse as three dimensions allow.

use super::gas::{plain, signal};
use super::problem::{Problem, Text, method, sweep};
use meshfree::kernel::CubicSpline;
use meshfree::material::eos::IdealGas;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::study::noh::Noh;
use meshfree::study::sedov::Sedov;
use meshfree::study::work_precision::{Case, Failure, Method, Outcome, Quantity, relative_l1};
use meshfree::term::viscosity::MonaghanGingold;

const NOH: Text = Text {
    key: "noh_3d",
    title: "Noh's problem in three dimensions",
    setting: "Cold gas of γ 5/3 runs at 1 m/s to a point; density after 0.6 s within 0.4 m of it, of which 0.2 m are behind the shock, \
              where it is 64 times the first. Mean error of density over mean density, by volume.",
    words: include_str!("words/noh_3d.md"),
};
const SEDOV: Text = Text {
    key: "sedov_3d",
    title: "Sedov's blast in three dimensions",
    setting: "A joule at a point of cold gas of γ 1.4 and 1 kg/m³, until its shock is 0.4 m out; density within 0.48 m. Mean error \
              of density over mean density, by volume.",
    words: include_str!("words/sedov_3d.md"),
};
const DENSITY: &str = "density";
pub const PLATEAU: &str = "density of the plateau";
pub const PEAK: &str = "peak of density";
const RADIUS: f64 = 0.4;

pub fn methods() -> Vec<Method> {
    let own = |name: &str, scheme: &str, ratio: f64| {
        method(name, &[("scheme", scheme)], &[("h/dx", ratio)])
    };
    vec![
        own("gas, C4, h/dx 1.8 (default)", "gas", 1.8),
        own("gas, C4, h/dx 1.3", "gas", 1.3),
        own("plain force, C4, h/dx 1.8", "plain", 1.8),
        own("cubic, Monaghan–Gingold, h/dx 1.2", "cubic", 1.2),
    ]
}

pub fn scheme(case: &Case<'_>) -> Result<Scheme<f64, 3>, Failure> {
    let ratio = case.number("h/dx")?;
    let gas = schemes::gas().h_over_dx(ratio);
    Ok(match case.text("scheme")? {
        "gas" => gas.compose(),
        "plain" => plain(signal(1.0)).h_over_dx(ratio).compose(),
        _ => plain(MonaghanGingold::STANDARD)
            .h_over_dx(ratio)
            .with_kernel(CubicSpline)
            .compose(),
    })
}

fn length(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Cells of a lattice in the first octant, within so many metres of the origin along every axis.
fn octant(dx: f64, size: f64) -> Vec<[f64; 3]> {
    let n = (size / dx).round() as usize;
    let cell = |k: usize| (k as f64 + 0.5) * dx;
    (0..n * n * n)
        .map(|k| [k % n, k / n % n, k / (n * n)].map(cell))
        .collect()
}

/// The gas between planes of symmetry through the origin.
fn between_planes(scheme: Scheme<f64, 3>, gas: Body<f64, 3>) -> Scene<f64, 3> {
    (0..3).fold(Scene::new(scheme).body(gas), |scene, d| {
        let mut out = [0.0; 3];
        out[d] = -1.0;
        scene.boundary(MirrorPlane::symmetry([0.0; 3], out))
    })
}

/// Density against the exact one within a radius.
fn error_of_density(
    gas: &Simulation<f64, 3>,
    within: f64,
    exact: impl Fn(f64) -> Result<f64, Failure>,
) -> Result<f64, Failure> {
    let mut samples = Vec::new();
    for particle in gas.all() {
        let r = length(particle.position());
        if r < within {
            let volume = particle.mass() / particle.density();
            samples.push((particle.density(), exact(r)?, volume));
        }
    }
    Ok(relative_l1(samples))
}

fn implode(case: &Case<'_>) -> Result<Outcome, Failure> {
    let (dx, end) = (case.spacing(), 0.6);
    let mut points = octant(dx, 1.0);
    points.retain(|x| length(*x) < 1.0);
    let law = Material::new("gas", IdealGas::new(5.0 / 3.0, 1.0));
    let gas = Body::points_of("gas", law, points, dx)
        .energy(1e-8)
        .start(|x, own| Start {
            velocity: x.map(|own| -own / length(x)),
            ..own
        });
    let mut gas = between_planes(scheme(case)?, gas).build()?;
    gas.run_until(end)?;
    let exact = Noh::new(3)?;
    let error = error_of_density(&gas, 0.4, |r| Ok(exact.state(r, end)?.density))?;
    let shock = exact.shock_radius(end);
    let plateau: Vec<f64> = gas
        .all()
        .filter(|p| (0.3 * shock..0.8 * shock).contains(&length(p.position())))
        .map(|p| p.density())
        .collect();
    let mean = plateau.iter().sum::<f64>() / plateau.len() as f64;
    Ok(Outcome::of(&gas).value(DENSITY, error).value(PLATEAU, mean))
}

/// The blast of a joule, and the time at which its shock is where it is compared with the exact one.
fn blast() -> Result<(Sedov, f64), Failure> {
    let exact = Sedov::new(3, 1.4, 1.0, 1.0)?;
    let end = (RADIUS / exact.shock_radius(1.0)).powf(2.5);
    Ok((exact, end))
}

fn explode(case: &Case<'_>) -> Result<Outcome, Failure> {
    let dx = case.spacing();
    let (exact, end) = blast()?;
    let points = octant(dx, 0.5);
    // An eighth of the joule, in the particles that are within two and a half spacings.
    let near = |x: [f64; 3]| length(x) < 2.5 * dx;
    let mass = dx.powi(3) * points.iter().filter(|x| near(**x)).count() as f64;
    let law = Material::new("gas", IdealGas::new(1.4, 1.0));
    let gas = Body::points_of("gas", law, points, dx).start(|x, own| Start {
        energy: if near(x) { 0.125 / mass } else { 1e-6 },
        ..own
    });
    let scene = (0..3).fold(between_planes(scheme(case)?, gas), |scene, d| {
        let (mut at, mut out) = ([0.0; 3], [0.0; 3]);
        (at[d], out[d]) = (0.5, 1.0);
        scene.boundary(MirrorPlane::symmetry(at, out))
    });
    let mut gas = scene.build()?;
    gas.run_until(end)?;
    let error = error_of_density(&gas, 1.2 * RADIUS, |r| Ok(exact.state(r, end)?.density))?;
    let peak = gas.all().map(|p| p.density()).fold(0.0, f64::max);
    Ok(Outcome::of(&gas).value(DENSITY, error).value(PEAK, peak))
}

pub fn noh(quick: bool) -> Problem {
    let counts: &[u32] = if quick { &[6, 8, 12] } else { &[8, 12, 16, 24] };
    let study = sweep(NOH, counts, quick, methods(), implode)
        .quantity(Quantity::measured(DENSITY))
        .quantity(Quantity::exact(PLATEAU, 64.0));
    Problem { text: NOH, study }
}

pub fn sedov(quick: bool) -> Problem {
    let counts: &[u32] = if quick {
        &[12, 16, 20]
    } else {
        &[16, 24, 32, 40]
    };
    let study = sweep(SEDOV, counts, quick, methods(), explode)
        .quantity(Quantity::measured(DENSITY))
        .quantity(Quantity::exact(PEAK, 6.0));
    Problem { text: SEDOV, study }
}
