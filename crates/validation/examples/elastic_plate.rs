//! A clamped elastic plate in plane strain, that swings freely (Gray, Monaghan & Swift 2001) or falls (Turek & Hron 2006).
//! `cargo validate elastic_plate -- --help` lists the options.

mod common;

use common::{Example, Failure, Options, Own, Shade, picture};
use meshfree::effect::{HourglassFree, NeoHookean, StVenantKirchhoff};
use meshfree::material::eos::Linear;
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::scene::Start;
use meshfree::term::viscosity::LimitedMonaghanGingold;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "elastic_plate",
    about: "An elastic plate, clamped at its left end, in plane strain.",
    schemes: &["st-venant-kirchhoff", "neo-hookean"],
    own: &[
        Own {
            name: "--case",
            value: "NAME",
            help: "oscillation (default), csm3",
        },
        Own {
            name: "--formulation",
            value: "NAME",
            help: "total (default), updated",
        },
        Own {
            name: "--through",
            value: "N",
            help: "particles through the thickness, in place of --spacing; 10",
        },
        Own {
            name: "--speed",
            value: "SHARE",
            help: "first speed of the tip over the sound speed; 0.01",
        },
        Own {
            name: "--viscosity",
            value: "ALPHA",
            help: "artificial viscosity of the updated formulation, linear and quadratic; 2",
        },
    ],
};

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, None)
}

/// A plate, and what is known of its motion.
struct Case {
    length: f64,
    height: f64,
    youngs: f64,
    poisson: f64,
    gravity: f64,
    /// Period and amplitude of the tip about its mean \[s, m\], and where they are from.
    known: [f64; 2],
    source: &'static str,
}

const DENSITY: f64 = 1000.0;
/// Columns of particles that are held, that at the root among them.
const ROOT_COLUMNS: f64 = 3.0;

impl Case {
    fn of(options: &Options) -> Result<Self, Failure> {
        match options.text("--case").unwrap_or("oscillation") {
            "oscillation" => Ok(Self {
                length: 0.2,
                height: 0.02,
                youngs: 2e6,
                poisson: 0.3975,
                gravity: 0.0,
                known: [0.2552, 0.02306 * options.number("--speed", 0.01)? / 0.01],
                source: "finite elements; amplitude of the thin plate",
            }),
            "csm3" => Ok(Self {
                length: 0.35,
                height: 0.02,
                youngs: 1.4e6,
                poisson: 0.4,
                gravity: 2.0,
                known: [1.0 / 1.0995, 0.06516],
                source: "Turek & Hron 2006",
            }),
            other => {
                Err(format!("--case: `{other}` is not accepted; it takes oscillation, csm3").into())
            }
        }
    }
    fn bulk_modulus(&self) -> f64 {
        self.youngs / (3.0 * (1.0 - 2.0 * self.poisson))
    }
    fn material<T: Real>(&self) -> Material<T> {
        let shear = self.youngs / (2.0 * (1.0 + self.poisson));
        let law = Linear::from_elastic_constants(DENSITY, self.youngs, self.poisson);
        Material::new("elastic", law).with_shear_modulus(shear)
    }
    /// The plate, whose column at x = 0 and those behind it are the clamp: what is held is places of particles, so the length
    /// is half a column more than a whole number of them, and columns are as wide as that asks for.
    fn body<T: Real>(&self, through: f64) -> Body<T, 2> {
        let row = self.height / through;
        let free = (self.length / row - 0.5).round();
        let column = self.length / (free + 0.5);
        let spacing = (row * column).sqrt();
        let size = [(free + ROOT_COLUMNS) * spacing, self.height / row * spacing];
        let body = Body::block("plate", self.material(), [0.0; 2], size, spacing);
        body.displace(|[x, y]| {
            [
                (x / spacing + 0.5 - ROOT_COLUMNS) * column,
                y / spacing * row,
            ]
        })
    }
    /// The first mode of a clamped thin plate, one at the tip.
    fn mode(&self, x: f64) -> f64 {
        const ROOT: f64 = 1.875_104_068_711_961;
        let form = |s: f64| {
            let k = ROOT * s;
            let share = (ROOT.cos() + ROOT.cosh()) / (ROOT.sin() + ROOT.sinh());
            k.cosh() - k.cos() - share * (k.sinh() - k.sin())
        };
        form((x / self.length).max(0.0)) / form(1.0)
    }
}

fn scheme<T: Real>(options: &Options) -> Result<Scheme<T, 2>, Failure> {
    let total = schemes::total_lagrangian();
    match options.text("--formulation").unwrap_or("total") {
        "total" if options.scheme == "neo-hookean" => Ok(total.with(NeoHookean).compose()),
        "total" => Ok(total.with(StVenantKirchhoff).compose()),
        // Rows at a free surface see the strain of those behind them, the less of it the narrower the kernel is.
        "updated" => {
            let alpha = options.number("--viscosity", LimitedMonaghanGingold::STANDARD.alpha)?;
            let viscosity = LimitedMonaghanGingold { alpha, beta: alpha };
            Ok(schemes::updated_lagrangian()
                .h_over_dx(1.0)
                .with_viscosity(viscosity)
                .with(HourglassFree::default())
                .compose())
        }
        other => {
            Err(format!("--formulation: `{other}` is not accepted; it takes total, updated").into())
        }
    }
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let case = Case::of(options)?;
    let through = options.number("--through", options.pick(10.0, 5.0))?;
    let through = options
        .spacing
        .map_or(through, |spacing| case.height / spacing)
        .round();
    let spacing = case.height / through;
    let first = options.number("--speed", 0.01)? * (case.bulk_modulus() / DENSITY).sqrt();
    let mode = |x: f64| {
        if case.gravity > 0.0 {
            0.0
        } else {
            case.mode(x)
        }
    };
    let plate = case.body(through).start(|[x, _], own| Start {
        velocity: [0.0, first * mode(x)],
        ..own
    });
    let gravity = case.gravity;
    let mut simulation = Scene::new(scheme::<T>(options)?)
        .body(plate)
        .fix("plate", move |[x, _]| *x < 0.25 * spacing)
        .acceleration(move |_| [0.0, -gravity])
        .build()?;
    let tip = tip_of(&simulation);
    let rest = middle(&simulation, &tip);

    let until = options.until_or(2.2 * case.known[0], 0.3 * case.known[0]);
    let names: Vec<_> = simulation
        .ledger()
        .whole
        .totals
        .iter()
        .map(|own| own.name)
        .collect();
    let mut columns = vec![
        "time_s".to_string(),
        "tip_y_m".into(),
        "kinetic_j_m".into(),
        "internal_j_m".into(),
        "mechanical_j_m".into(),
    ];
    columns.extend(names.iter().map(|name| name.replace(' ', "_") + "_j_m"));
    let columns: Vec<_> = columns.iter().map(String::as_str).collect();
    let mut csv = CsvWriter::create(options.file("history.csv"), &columns)?;
    let mut movie = Pvd::create(options.file("plate.pvd"))?;
    let mut samples = Vec::new();
    let mut energies: [Vec<(f64, f64)>; 4] = Default::default();
    let mut deepest = None;
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(
            Schedule::evenly(1 + (until / case.known[0] * 200.0).ceil() as usize),
            |now| {
                let height = middle(now, &tip) - rest;
                let whole = now.ledger().whole;
                let totals = names.iter().map(|name| whole.total(name).unwrap_or(0.0));
                let mechanical = whole.kinetic + stored(&case, now);
                let own = [
                    now.time(),
                    height,
                    whole.kinetic,
                    whole.internal,
                    mechanical,
                ];
                csv.row(&own.into_iter().chain(totals).collect::<Vec<_>>())?;
                if samples.len() % 10 == 0 {
                    movie.frame(now.time(), &now.vtu_with_walls())?;
                }
                samples.push((now.time(), height));
                let hourglass = whole.total("hourglass energy").unwrap_or(0.0);
                for (line, value) in
                    energies
                        .iter_mut()
                        .zip([whole.kinetic, whole.internal, hourglass, mechanical])
                {
                    line.push((now.time(), value));
                }
                if deepest
                    .as_ref()
                    .is_none_or(|(most, _): &(f64, _)| height.abs() > *most)
                {
                    deepest = Some((height.abs(), picture(now, Shade::Pressure, [0, 1], spacing)));
                }
                Ok(())
            },
        )
        .go()?;

    let name = options.text("--formulation").unwrap_or("total").to_string();
    let mut figure = Figure::new().panel(
        Panel::new(Axis::linear("time", "s"), Axis::linear("tip", "m"))
            .series(Series::line(&format!("{name} Lagrangian"), samples.clone())),
    );
    let mut energy = Panel::new(Axis::linear("time", "s"), Axis::linear("energy", "J/m"));
    let drift = drift(&case, &energies[3]);
    for (name, line) in ["kinetic", "internal", "hourglass", "mechanical"]
        .into_iter()
        .zip(energies)
    {
        energy = energy.series(Series::line(name, line));
    }
    figure = figure.panel(energy);
    if let Some((_, panel)) = deepest {
        figure = figure.panel(panel);
    }
    figure.save(options.file("plate.svg"))?;
    println!("{summary}");
    report(&case, &samples);
    if case.gravity == 0.0 {
        println!("{drift}");
    }
    println!("written to {}", options.folder().display());
    Ok(())
}

/// Period and amplitude, as far as the run was long enough to see them.
fn report(case: &Case, samples: &[(f64, f64)]) {
    let [period, amplitude] = case.known;
    let [low, high] = samples.iter().fold([0.0_f64; 2], |[low, high], (_, y)| {
        [low.min(*y), high.max(*y)]
    });
    let mean = 0.5 * (low + high);
    println!(
        "amplitude {:.5} m about {mean:.5} m; {amplitude:.5} m by {}: {:+.1} %",
        0.5 * (high - low),
        case.source,
        100.0 * (0.5 * (high - low) / amplitude - 1.0)
    );
    let level = if case.gravity > 0.0 { mean } else { 0.0 };
    let crossing = |pair: &[(f64, f64)]| {
        let [(a, from), (b, to)] = [pair[0], pair[1]];
        let [from, to] = [from - level, to - level];
        (from * to < 0.0).then(|| a - from * (b - a) / (to - from))
    };
    let zeros: Vec<_> = samples.windows(2).filter_map(crossing).collect();
    if let [first, .., last] = zeros[..] {
        let measured = 2.0 * (last - first) / (zeros.len() - 1) as f64;
        println!(
            "period {measured:.5} s, {period:.5} s by {}: {:+.2} %",
            case.source,
            100.0 * (measured / period - 1.0)
        );
    }
}

/// Energy \[J/m\] of distortion and compression.
fn stored<T: Real>(case: &Case, now: &Simulation<T, 2>) -> f64 {
    let whole = now.ledger().whole;
    // A total-Lagrangian plate knows its stored energy as one.
    if let Some(elastic) = whole.total("elastic energy") {
        return elastic;
    }
    let compression = |p: f64| p * p / (2.0 * case.bulk_modulus());
    let own = now
        .all()
        .map(|p| p.mass() / p.density() * compression(p.pressure()));
    own.sum::<f64>() + whole.total("distortion").unwrap_or(0.0)
}

/// What the kinetic energy of the start has become in motion, distortion and compression: means over a period, of the first and
/// of the last.
fn drift(case: &Case, mechanical: &[(f64, f64)]) -> String {
    let (Some((begin, first)), Some((end, _))) = (mechanical.first(), mechanical.last()) else {
        return String::new();
    };
    let period = case.known[0];
    let mean = |from: f64, to: f64| {
        let within: Vec<f64> = mechanical
            .iter()
            .filter(|(t, _)| (from..=to).contains(t))
            .map(|(_, energy)| energy / first)
            .collect();
        within.iter().sum::<f64>() / within.len() as f64
    };
    format!(
        "energy of motion, distortion and compression over that of the start: {:.5} in the first period, {:.5} in the last, after {:.1} periods",
        mean(*begin, begin + period),
        mean(end - period, *end),
        (end - begin) / period
    )
}

/// The particles at the tip, at half the height.
fn tip_of<T: Real>(simulation: &Simulation<T, 2>) -> Vec<usize> {
    let right = simulation
        .all()
        .fold(0.0_f64, |most, p| most.max(p.position()[0]));
    let last = |p: &meshfree::simulation::ParticleView<'_, T, 2>| p.position()[0] > right - 1e-9;
    simulation.all().filter(last).map(|p| p.id()).collect()
}

/// Their mean height \[m\].
fn middle<T: Real>(simulation: &Simulation<T, 2>, ids: &[usize]) -> f64 {
    let own = simulation.all().filter(|p| ids.contains(&p.id()));
    own.map(|p| p.position()[1]).sum::<f64>() / ids.len() as f64
}
