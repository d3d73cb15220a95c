//! Flow between plates from rest: Couette, Poiseuille, and Poiseuille of a power-law liquid.
//! `cargo validate channel -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, Shade, evenly, picture};
use meshfree::boundary::Wall;
use meshfree::material::rheology::PowerLaw;
use meshfree::material::{Liquid, Material, SoundSpeed};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::study::channel::{Couette, Poiseuille, PowerLawPoiseuille};
use meshfree::term::viscosity::Inviscid;
use meshfree::term::{CentralViscosity, LaminarViscosity};
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "channel",
    about: "Flow from rest between plates 1 mm apart (Morris, Fox & Zhu 1997): water that a plate or a\n\
            force drives, and a liquid that thins under shear.",
    schemes: &["laminar", "central"],
    own: &[Own {
        name: "--flow",
        value: "NAME",
        help: "couette, poiseuille, power-law; all of them if not given",
    }],
};

/// Distance of the plates \[m\].
const WIDTH: f64 = 1e-3;
/// Kinematic viscosity \[m²/s\].
const VISCOSITY: f64 = 1e-6;
/// Speed of the plate, and greatest of the liquid \[m/s\].
const SPEED: f64 = 1.25e-5;
/// Force per mass that brings water to that speed \[m/s²\].
const FORCE: f64 = 1e-4;
/// Index of the liquid that is not Newtonian.
const INDEX: f64 = 0.5;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

#[derive(Clone, Copy, PartialEq)]
enum Flow {
    Couette,
    Poiseuille,
    PowerLaw,
}

impl Flow {
    const ALL: [(&str, Self); 3] = [
        ("couette", Self::Couette),
        ("poiseuille", Self::Poiseuille),
        ("power-law", Self::PowerLaw),
    ];

    /// Velocity \[m/s\] at `y` \[m\] and `t` \[s\]; of the power law after a long time.
    fn exact(self, y: f64, t: f64) -> Result<f64, Failure> {
        Ok(match self {
            Self::Couette => Couette::new(WIDTH, SPEED, VISCOSITY)?.velocity(y, t)?,
            Self::Poiseuille => Poiseuille::new(WIDTH, FORCE, VISCOSITY)?.velocity(y, t)?,
            Self::PowerLaw => {
                PowerLawPoiseuille::new(WIDTH, 1000.0 * FORCE, consistency(), INDEX)?.velocity(y)?
            }
        })
    }
    /// Times \[s\] at which profiles are taken.
    fn times(self, until: f64) -> Vec<f64> {
        match self {
            Self::PowerLaw => vec![until],
            _ => [0.02, 0.05, 0.1, 0.25, 1.0]
                .map(|share| share * until)
                .to_vec(),
        }
    }
}

/// Consistency \[Pa sⁿ\] with which the thinning liquid reaches the same speed under the same force.
fn consistency() -> f64 {
    let half = 0.5 * WIDTH;
    let shape = INDEX / (INDEX + 1.0) * half.powf(1.0 + 1.0 / INDEX);
    1000.0 * FORCE * (shape / SPEED).powf(INDEX)
}

fn scene<T: Real>(options: &Options, flow: Flow, spacing: f64) -> Scene<T, 2> {
    // A hundred times the speed: pressure has nothing to do here.
    let liquid = Liquid::new(1000.0, 1480.0, 1000.0 * VISCOSITY);
    let mut material: Material<T> = liquid.material("liquid", SoundSpeed::Chosen(100.0 * SPEED));
    if flow == Flow::PowerLaw {
        // The shear rate vanishes in the middle, and the plain law has no viscosity there.
        let greatest = 10.0 * 1000.0 * VISCOSITY;
        let law = PowerLaw::new(consistency(), INDEX, 1e-2 * greatest, greatest);
        material = material.with_rheology(law);
    }
    let length = 10.0 * spacing;
    let body = Body::block("liquid", material, [0.0; 2], [length, WIDTH], spacing);
    let plate = |name, low: f64| {
        let high = low + 4.0 * spacing;
        let points = Body::<f64, 2>::block(
            name,
            catalogue::water(),
            [0.0, low],
            [length, high],
            spacing,
        );
        Wall::of(name, points.points().to_vec(), spacing).no_slip()
    };
    let (slide, force) = match flow {
        Flow::Couette => (SPEED, 0.0),
        _ => (0.0, FORCE),
    };
    let scheme = schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(GeneralisedNewtonian)
        .walls(ExtrapolatedPressure {
            floor: f64::NEG_INFINITY,
        });
    let scheme: Scheme<T, 2> = match options.scheme.as_str() {
        "central" => scheme.with(Laminar(CentralViscosity)).compose(),
        _ => scheme.with(Laminar(LaminarViscosity)).compose(),
    };
    Scene::new(scheme)
        .body(body)
        .wall(plate("lower plate", -4.0 * spacing))
        .wall(plate("upper plate", WIDTH).sliding([slide, 0.0]))
        .boundary(Periodic::along(0, 0.0, length))
        .acceleration(move |_| [force, 0.0])
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let chosen = options.text("--flow");
    let known = |name: &str| Flow::ALL.iter().any(|(own, _)| *own == name);
    if let Some(name) = chosen.filter(|name| !known(name)) {
        return Err(format!("--flow: `{name}` is not couette, poiseuille or power-law").into());
    }
    for (name, flow) in Flow::ALL {
        if chosen.is_none_or(|chosen| chosen == name) {
            run::<T>(options, name, flow)?;
        }
    }
    println!("written to {}", options.folder().display());
    Ok(())
}

fn run<T: Real>(options: &Options, name: &str, flow: Flow) -> Result<(), Failure> {
    let spacing = options.spacing_or(WIDTH / 50.0, WIDTH / 20.0);
    // Diffusion across the channel takes L²/ν = 1 s.
    let until = options.until_or(1.0, 1.0);
    let mut simulation = scene::<T>(options, flow, spacing).build()?;

    let columns = ["time_s", "y_m", "velocity_m_s", "exact_m_s"];
    let mut csv = CsvWriter::create(options.file(&format!("{name}.csv")), &columns)?;
    let mut movie = Pvd::create(options.file(&format!("{name}.pvd")))?;
    let mut curves = Vec::new();
    let mut worst = 0.0_f64;
    let summary = Run::new(&mut simulation, until)
        .label(name)
        .observe(Schedule::at(flow.times(until)), |now| {
            let mut profile = Vec::new();
            for particle in now.all() {
                let (y, u) = (particle.position()[1], particle.velocity()[0]);
                let exact = flow.exact(y.clamp(0.0, WIDTH), now.time())?;
                csv.row(&[now.time(), y, u, exact])?;
                worst = worst.max((u - exact).abs() / SPEED);
                profile.push((1e3 * y, u));
            }
            let mut exact = Vec::new();
            for y in evenly(WIDTH, 101) {
                exact.push((1e3 * y, flow.exact(y, now.time())?));
            }
            let label = format!("t = {:.2} s", now.time());
            curves.push(Series::line("exact", exact).reference());
            curves.push(Series::markers(&label, profile));
            movie.frame(now.time(), &now.vtu_with_walls())?;
            Ok(())
        })
        .go()?;
    let panel = Panel::new(
        Axis::linear("distance y", "mm"),
        Axis::linear("velocity", "m/s"),
    );
    let panel = curves.into_iter().fold(panel, Panel::series);
    Figure::new()
        .panel(panel.title(name))
        .panel(picture(&simulation, Shade::Speed, [0, 1], spacing))
        .shared_legend()
        .save(options.file(&format!("{name}.svg")))?;
    let bar = if flow == Flow::PowerLaw { 2 } else { 1 };
    println!(
        "{name}: {summary}\n  largest error of the velocity: {:.2} % of {SPEED} m/s (bar {bar} %)",
        100.0 * worst
    );
    Ok(())
}
