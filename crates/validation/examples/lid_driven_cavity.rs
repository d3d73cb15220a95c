//! A square of liquid under a sliding lid, against the velocities of Ghia, Ghia & Shin (1982).
//! `cargo validate lid_driven_cavity -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, Shade, evenly, picture};
use meshfree::boundary::Wall;
use meshfree::kernel::WendlandC6;
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::scheme::Shifting;
use meshfree::study::ghia::{ALONG_X, ALONG_Y, CentreLinePoint};
use meshfree::term::viscosity::Inviscid;
use meshfree::term::{Fourtakas, LaminarViscosity};
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "lid_driven_cavity",
    about: "Liquid in a square of 1 m under a lid that slides at 1 m/s: velocities on the centre lines.\n\
            smooth: Wendland C6 at h/dx 2.5 for C2 at 1.5; transport: another shifting.",
    schemes: &["shifting", "transport", "smooth"],
    own: &[Own {
        name: "--reynolds",
        value: "RE",
        help: "100 or 1000, for which there is a reference; 100",
    }],
};

/// Sound speed in units of the lid's.
const SOUND: f64 = 10.0;
/// Samples of the profiles that their means are taken over.
const SAMPLES: usize = 20;
/// Places on a centre line.
const PLACES: usize = 257;
/// Layers of wall particles.
const LAYERS: usize = 5;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn scene<T: Real>(options: &Options, reynolds: f64, spacing: f64) -> Scene<T, 2> {
    let liquid = Liquid::new(1.0, 1480.0, 1.0 / reynolds).linear();
    let material: Material<T> = liquid.material("liquid", SoundSpeed::Chosen(SOUND));
    let body = Body::block("liquid", material, [0.0; 2], [1.0; 2], spacing);
    let sides = [[true; 2], [true, false]];
    let walls = Wall::around("walls", [0.0; 2], [1.0; 2], spacing, LAYERS, sides).no_slip();
    let thick = LAYERS as f64 * spacing;
    let above = Wall::around(
        "lid",
        [-thick, 0.0],
        [1.0 + thick, 1.0],
        spacing,
        LAYERS,
        [[false; 2], [false, true]],
    );
    let pressure = ExtrapolatedPressure {
        floor: f64::NEG_INFINITY,
    };
    let consistency = VolumeConsistency { strength: 0.05 };
    let scheme = schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
        .walls(pressure)
        .with(consistency);
    let scheme: Scheme<T, 2> = match options.scheme.as_str() {
        "transport" => scheme.with(Shifting::TRANSPORT).compose(),
        "smooth" => SchemeBuilder::liquid(WendlandC6, Inviscid)
            .with(DensityDiffusion(Fourtakas::default()))
            .with(Laminar(LaminarViscosity))
            .walls(pressure)
            .with(consistency)
            .with(Shifting::CLOSED)
            .h_over_dx(2.5)
            .compose(),
        _ => scheme.with(Shifting::CLOSED).compose(),
    };
    Scene::new(scheme)
        .body(body)
        .wall(walls)
        .wall(above.no_slip().sliding([1.0, 0.0]))
}

/// Component `component` of the velocity at a place, by a kernel-weighted linear fit of its neighbours.
fn velocity<T: Real>(now: &Simulation<T, 2>, at: [f64; 2], component: usize, reach: f64) -> f64 {
    // Normal equations of u = a + b x + c y with weights that vanish at the reach.
    let (mut m, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
    for particle in now.all() {
        let x = particle.position();
        let (dx, dy) = ((x[0] - at[0]) / reach, (x[1] - at[1]) / reach);
        let weight = (1.0 - dx * dx - dy * dy).max(0.0).powi(2);
        let basis = [1.0, dx, dy];
        for i in 0..3 {
            right[i] += weight * basis[i] * particle.velocity()[component];
            for j in 0..3 {
                m[i][j] += weight * basis[i] * basis[j];
            }
        }
    }
    let determinant = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let mut first = m;
    for i in 0..3 {
        first[i][0] = right[i];
    }
    determinant(first) / determinant(m)
}

/// A centre line: its name, the component across it, the reference, and a place on it as a point.
type Line = (
    &'static str,
    usize,
    &'static [CentreLinePoint],
    fn(f64) -> [f64; 2],
);
const LINES: [Line; 2] = [
    ("u over y", 0, &ALONG_Y, |y| [0.5, y]),
    ("v over x", 1, &ALONG_X, |x| [x, 0.5]),
];

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let reynolds = options.number("--reynolds", 100.0)?;
    let spacing = options.spacing_or(0.01, 0.05);
    let until = options.until_or(if reynolds > 500.0 { 40.0 } else { 15.0 }, 4.0);
    let mut simulation = scene::<T>(options, reynolds, spacing).build()?;

    let name = format!("cavity_{reynolds:.0}");
    let mut movie = Pvd::create(options.file(&format!("{name}.pvd")))?;
    let columns = ["time_s", "kinetic_energy_j_m"];
    let mut history = CsvWriter::create(options.file(&format!("{name}_energy.csv")), &columns)?;
    // Eddies of the size of a few particles come and go: the profiles are means over the last quarter.
    let places = evenly(1.0, PLACES);
    let mut profiles = [[0.0; PLACES]; 2];
    let mut taken = 0;
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(4 * SAMPLES + 1), |now| {
            history.row(&[now.time(), now.ledger().whole.kinetic])?;
            if taken % 4 == 0 {
                movie.frame(now.time(), &now.vtu_with_walls())?;
            }
            taken += 1;
            if taken <= 3 * SAMPLES + 1 {
                return Ok(());
            }
            for (profile, (_, component, _, point)) in profiles.iter_mut().zip(LINES) {
                for (mean, place) in profile.iter_mut().zip(&places) {
                    let own = velocity(now, point(*place), component, 2.5 * spacing);
                    *mean += own / SAMPLES as f64;
                }
            }
            Ok(())
        })
        .go()?;

    let columns = ["line", "place", "velocity", "reference"];
    let mut csv = CsvWriter::create(options.file(&format!("{name}.csv")), &columns)?;
    let mut figure = Figure::new().columns(3);
    let (mut worst, mut squares, mut count) = (0.0_f64, 0.0, 0.0);
    for (profile, (title, component, reference, _)) in profiles.iter().zip(LINES) {
        let value = |p: &CentreLinePoint| match reynolds {
            1000.0 => p.reynolds_1000,
            _ => p.reynolds_100,
        };
        // Between the places of the profile, which the reference falls between.
        let computed = |place: f64| {
            let at = place * (PLACES - 1) as f64;
            let left = (at as usize).min(PLACES - 2);
            let share = at - left as f64;
            profile[left] + share * (profile[left + 1] - profile[left])
        };
        for p in reference {
            let own = computed(p.place);
            csv.row(&[component as f64, p.place, own, value(p)])?;
            // At the ends the reference is the wall's own velocity.
            if p.place > 0.0 && p.place < 1.0 {
                worst = worst.max((own - value(p)).abs());
                squares += (own - value(p)).powi(2);
                count += 1.0;
            }
        }
        let table = reference.iter().map(|p| (p.place, value(p)));
        let curve = places.iter().copied().zip(profile.iter().copied());
        let panel = Panel::new(Axis::linear("place", "L"), Axis::linear("velocity", "U"));
        figure = figure.panel(
            panel
                .title(title)
                .series(Series::line(&options.scheme, curve))
                .series(Series::markers("Ghia et al. 1982", table)),
        );
    }
    figure
        .panel(picture(&simulation, Shade::Speed, [0, 1], spacing))
        .save(options.file(&format!("{name}.svg")))?;
    let bar = if reynolds > 500.0 { 4 } else { 2 };
    println!(
        "{summary}\ncentre lines against Ghia et al. at Re {reynolds}: largest difference {:.2} %, \
         RMS {:.2} % of the lid's speed (bar {bar} %)\nwritten to {}",
        100.0 * worst,
        100.0 * f64::sqrt(squares / count),
        options.folder().display()
    );
    Ok(())
}
