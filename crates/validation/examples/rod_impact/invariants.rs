//! Runs that must agree: a wall with two rods that meet, and one thread with two.
//! The first to rounding, the second bit for bit.

use super::Failure;
use super::cases::Case;
use super::choices::SchemeChoice;
use super::options::Options;
use super::record::{self, Watch};
use meshfree::material::catalogue;
use meshfree::scene::{Body, Scene};

const SCHEMES: [SchemeChoice; 3] = [
    SchemeChoice::Impact,
    SchemeChoice::Continuity,
    SchemeChoice::Lam2002,
];

/// Measures both, and gives each as (name, bar, value for each scheme).
pub fn rows(options: &Options, add: &mut dyn FnMut(String, f64, Vec<f64>)) -> Result<(), Failure> {
    let mut mirrored = Vec::new();
    let mut threaded = Vec::new();
    for scheme in SCHEMES {
        let wall = Case {
            target: None,
            scheme,
            spacing: options.case.spacing,
            until: 8e-6,
            probes: vec![5e-3],
            ..Case::default()
        };
        mirrored.push(against_mirror(&wall)?);
        let rods = Case {
            target: Some("pmma".into()),
            until: 5e-6,
            snapshots: vec![5e-6],
            ..wall
        };
        threaded.push(against_threads(&rods)?);
    }
    add(
        "wall against two rods that meet, largest difference / plateau".into(),
        1e-9,
        mirrored,
    );
    add(
        "1 against 2 threads, particles that differ in any bit".into(),
        0.0,
        threaded,
    );
    Ok(())
}

/// Largest difference of pressure and velocity between a rod on a wall and one of two equal rods,
/// relative to those of the impact, at 2, 4, 6 and 8 µs.
fn against_mirror(case: &Case) -> Result<f64, Failure> {
    let mut wall = case.build()?;
    let length = case.striker_length;
    let rod = |name, from: f64, speed| {
        Body::block(
            name,
            catalogue::copper(),
            [from],
            [from + length],
            case.spacing,
        )
        .velocity([speed])
    };
    let mut pair = Scene::new(case.scheme())
        .boxed_integrator(case.integrator().make())
        .between("striker", "image", case.contact().interaction())
        .body(rod("striker", 0.0, case.speed))
        .body(rod("image", length, -case.speed))
        .build()?;
    let mut most: f64 = 0.0;
    for end in [2e-6, 4e-6, 6e-6, 8e-6] {
        wall.run_until(end)?;
        pair.run_until(end)?;
        for (a, b) in wall.body("striker")?.zip(pair.body("striker")?) {
            most = most.max((a.pressure() - b.pressure()).abs() / 709e6);
            most = most.max((a.velocity()[0] - b.velocity()[0]).abs() / case.speed);
        }
    }
    Ok(most)
}

/// Particles whose stress or velocity is not the same number on one thread and on two.
fn against_threads(case: &Case) -> Result<f64, Failure> {
    let run = |threads| -> Result<Vec<[u64; 2]>, Failure> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        let record = pool.install(|| record::run(case, Watch::Every(1), &mut |_| {}))?;
        let points = record.snapshots.iter().flat_map(|shot| &shot.points);
        Ok(points
            .map(|p| [p.stress.to_bits(), p.velocity.to_bits()])
            .collect())
    };
    let (one, two) = (run(1)?, run(2)?);
    Ok(one.iter().zip(&two).filter(|(a, b)| a != b).count() as f64)
}
