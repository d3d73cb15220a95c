//! A column of water at rest: what its pressure, its surface and its particles do when nothing should.
//! `cargo validate hydrostatic -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Shade, picture};
use meshfree::boundary::Wall;
use meshfree::material::{Material, SoundSpeed, catalogue};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::term::Antuono;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "hydrostatic",
    about: "Water of 1 m depth and 0.5 m width at rest in a tank, for 20 sqrt(H/g).",
    schemes: &["fourtakas", "antuono"],
    own: &[],
};

const DEPTH: f64 = 1.0;
const GRAVITY: f64 = 9.81;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

fn sound_speed() -> f64 {
    10.0 * (GRAVITY * DEPTH).sqrt()
}

/// The pressure \[Pa\] at rest of water that its own weight compresses, p = ρ₀c² (exp(g d/c²) − 1) at the depth d \[m\].
fn at_rest(depth: f64) -> f64 {
    let square = sound_speed() * sound_speed();
    1000.0 * square * (GRAVITY * depth / square).exp_m1()
}

fn scene<T: Real>(options: &Options, spacing: f64) -> Scene<T, 2> {
    let water: Material<T> = catalogue::water_at(SoundSpeed::Chosen(sound_speed()));
    let body = Body::block("water", water, [0.0; 2], [0.5, DEPTH], spacing);
    let body = body.hydrostatic([0.0, -GRAVITY], [0.0, DEPTH]);
    // Of h/dx 1.5 and 2, the wider leaves the particles a tenth of the residual motion.
    let scheme = schemes::weakly_compressible().h_over_dx(2.0);
    let scheme: Scheme<T, 2> = match options.scheme.as_str() {
        "antuono" => scheme.density_diffusion(Antuono::default()).compose(),
        _ => scheme.compose(),
    };
    let sides = [[true; 2], [true, false]];
    let mut tank = Wall::around("tank", [0.0; 2], [0.5, DEPTH], spacing, 5, sides);
    // The sides go on above the surface, which may swing.
    let above = (0..10).map(|k| DEPTH + (f64::from(k) + 0.5) * spacing);
    let columns = (0..5).flat_map(|k| {
        let off = (f64::from(k) + 0.5) * spacing;
        [-off, 0.5 + off]
    });
    let more = columns.flat_map(|x| above.clone().map(move |z| [x, z]));
    let points: Vec<_> = tank.points().iter().copied().chain(more).collect();
    tank = Wall::of("tank", points, spacing);
    Scene::new(scheme)
        .body(body)
        .wall(tank)
        .acceleration(|_| [0.0, -GRAVITY])
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let spacing = options.spacing_or(0.01, 0.05);
    let until = options.until_or(20.0 * (DEPTH / GRAVITY).sqrt(), 2.0);
    let mut simulation = scene::<T>(options, spacing).build()?;
    let surface = |now: &Simulation<T, 2>| {
        let heights = now.all().map(|particle| particle.position()[1]);
        heights.fold(0.0, f64::max) + 0.5 * spacing
    };

    let columns = ["time_s", "rms_of_rho_g_h", "surface_m", "speed_of_c0"];
    let mut csv = CsvWriter::create(options.file("rest.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("column.pvd"))?;
    let mut last = [0.0; 3];
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(Schedule::evenly(21), |now| {
            let errors = now.all().map(|particle| {
                (particle.pressure() - at_rest(DEPTH - particle.position()[1])).powi(2)
            });
            let mean = errors.sum::<f64>() / now.particles() as f64;
            let fastest = now
                .all()
                .map(|particle| particle.velocity()[0].hypot(particle.velocity()[1]))
                .fold(0.0, f64::max);
            last = [
                mean.sqrt() / (1000.0 * GRAVITY * DEPTH),
                surface(now),
                fastest / sound_speed(),
            ];
            csv.row(&[now.time(), last[0], last[1], last[2]])?;
            movie.frame(now.time(), &now.vtu_with_walls())?;
            Ok(())
        })
        .go()?;

    let profile = simulation.all();
    let profile = profile.map(|particle| (particle.pressure(), particle.position()[1]));
    let exact = (0..=20).map(|k| 0.05 * DEPTH * f64::from(k));
    let exact = exact.map(|depth| (at_rest(depth), DEPTH - depth));
    Figure::new()
        .panel(
            Panel::new(Axis::linear("pressure", "Pa"), Axis::linear("height", "m"))
                .series(Series::markers(&options.scheme, profile))
                .series(Series::line("hydrostatic", exact).reference()),
        )
        .panel(picture(&simulation, Shade::Pressure, [0, 1], spacing))
        .save(options.file("column.svg"))?;
    println!(
        "{summary}\npressure, RMS of rho g H: {:.3} % (bar 1 %)\n\
         surface, drift in spacings: {:+.3} (bar 0.5)\n\
         greatest speed over c0: {:.1e} (bar 1e-4)\nwritten to {}",
        100.0 * last[0],
        (last[1] - DEPTH) / spacing,
        last[2],
        options.folder().display()
    );
    Ok(())
}
