//! Composite rods in one dimension, after Lam, Shen & Gong (2002): a copper rod strikes a wall and other rods at 20 m/s, with
//! and without a pad of PMMA bonded to its head. Exact waves are drawn next to the particles' stress.
//! `cargo run --release --example rod_impact` leaves a picture and tables in `out/rod_impact`.

use meshfree::prelude::*;
use meshfree::run::{Failure, Run, Schedule};
use meshfree::study::acoustic_rods::{AcousticRods, RodSegment};
use meshfree::study::{Contact, End};

/// A rod of a chain: name, material, length \[m\] and velocity \[m/s\].
type Rod = (&'static str, Material<f64>, f64, f64);

const SPACING: f64 = 5e-5;
const SPEED: f64 = 20.0;
const STRIKER: f64 = 0.010;

pub(crate) fn main() -> Result<(), Failure> {
    let striker = || ("striker", catalogue::copper(), STRIKER, SPEED);
    let pad = |length| ("pad", catalogue::pmma(), length, SPEED);
    let target = |material| ("target", material, 0.040, 0.0);

    // A chain without a target ends at a wall.
    let mut targets = vec![("wall".to_owned(), vec![striker()])];
    for name in ["copper", "steel", "aluminium", "pmma"] {
        let target = target(catalogue::by_name(name)?);
        targets.push((format!("on {name}"), vec![striker(), target]));
    }
    let pads = [5.0, 10.0, 20.0].map(|mm| {
        let chain = vec![striker(), pad(1e-3 * mm), target(catalogue::copper())];
        (format!("pad of {mm} mm"), chain)
    });
    Figure::new()
        .title("Stress in the middle of a copper striker, with exact waves (dashed)")
        .panel(panel("without a pad", &targets, 12e-6)?)
        .panel(panel("with a pad, on copper", &pads, 26e-6)?)
        .columns(2)
        .panel_size(520.0, 340.0)
        .save("out/rod_impact/stress.svg")?;
    println!("written to out/rod_impact");
    Ok(())
}

/// Runs chains until a time \[s\] and draws them.
fn panel(title: &str, chains: &[(String, Vec<Rod>)], until: f64) -> Result<Panel, Failure> {
    let axis = |name, unit| Axis::linear(name, unit);
    let mut panel = Panel::new(axis("time", "µs"), axis("stress", "MPa")).title(title);
    for (label, chain) in chains {
        let stress = particles(chain, until)?;
        let table = format!("out/rod_impact/{}.csv", label.replace(' ', "_"));
        CsvWriter::create(table, &["time_s", "stress_pa"])?.rows(&stress)?;
        let shown = |[t, stress]: [f64; 2]| (1e6 * t, 1e-6 * stress);
        panel = panel
            .series(Series::line(label, stress.into_iter().map(shown)))
            .series(Series::steps("", waves(chain, until)?.into_iter().map(shown)).reference());
    }
    Ok(panel)
}

/// Stress \[Pa\] in time \[s\] in the middle of the striker.
fn particles(chain: &[Rod], until: f64) -> Result<Vec<[f64; 2]>, Failure> {
    let mut scene = Scene::<f64, 1>::new(schemes::impact());
    let mut end = 0.0;
    for (name, material, length, speed) in chain {
        let rod = Body::block(name, material.clone(), [end], [end + length], SPACING);
        scene = scene.body(rod.velocity([*speed]));
        end += length;
    }
    // Bodies push each other and part again, unless the scene says that they are bonded.
    if chain.len() == 3 {
        scene = scene.between("striker", "pad", Interaction::Bonded);
    }
    if chain.len() == 1 {
        scene = scene.boundary(MirrorPlane::wall([end], [1.0]));
    }
    let mut rods = scene.build()?;
    let middle = rods.body("striker")?.count() / 2;
    let mut stress = Vec::new();
    Run::new(&mut rods, until)
        .observe(Schedule::evenly(401), |now| {
            let own = now.body("striker")?.nth(middle);
            stress.push([now.time(), own.map_or(0.0, |p| -p.pressure())]);
            Ok(())
        })
        .go()?;
    Ok(stress)
}

/// The same by the exact solution for linear waves.
fn waves(chain: &[Rod], until: f64) -> Result<Vec<[f64; 2]>, Failure> {
    let mut rods = AcousticRods::new();
    for (name, material, length, velocity) in chain {
        if *name == "target" {
            rods = rods.contact(Contact::Unilateral);
        }
        let density = material.reference_density();
        rods = rods.segment(RodSegment {
            length: *length,
            density,
            sound_speed: material.impedance() / density,
            velocity: *velocity,
        });
    }
    if chain.len() == 1 {
        rods = rods.right_end(End::Wall);
    }
    let history = rods.solve(until)?.history(0.5 * STRIKER)?;
    let mut steps: Vec<_> = history.iter().map(|own| [own.time, own.stress]).collect();
    steps.extend(steps.last().map(|&[_, stress]| [until, stress]));
    Ok(steps)
}
