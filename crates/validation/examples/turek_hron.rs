//! Flow past a cylinder that carries an elastic beam: the benchmarks FSI1, FSI2 and FSI3 of Turek & Hron (2006).
//! `cargo validate turek_hron -- --help` lists the options; CSM3 is a case of `elastic_plate`.

mod common;

use common::{Example, Failure, Options, Own};
use meshfree::boundary::Wall;
use meshfree::effect::StVenantKirchhoff;
use meshfree::material::eos::Linear;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::output::csv::CsvWriter;
use meshfree::output::svg::{Axis, Cloud, Figure, Panel, Series};
use meshfree::output::vtu::Pvd;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::run::{Run, Schedule};
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::PI;
use std::process::ExitCode;

const EXAMPLE: Example = Example {
    name: "turek_hron",
    about: "Laminar flow in a channel, past a cylinder with an elastic beam behind it, in plane strain. The channel is\n\
            periodic, and a zone before it gives the liquid the parabolic profile of the inflow.",
    schemes: &["default"],
    own: &[
        Own {
            name: "--case",
            value: "NAME",
            help: "fsi1 (steady), fsi2 (default), fsi3",
        },
        Own {
            name: "--diameter-over-dx",
            value: "N",
            help: "particles of the liquid across the cylinder, in place of --spacing; 10",
        },
        Own {
            name: "--through",
            value: "N",
            help: "particles through the beam; 8, with --quick 4",
        },
        Own {
            name: "--sound-speed",
            value: "RATIO",
            help: "artificial sound speed of the liquid over the mean inflow; 15",
        },
        Own {
            name: "--background",
            value: "RATIO",
            help: "pressure of the channel at rest over that of the inflow's largest speed, rho U^2; 1",
        },
        Own {
            name: "--length",
            value: "M",
            help: "of the channel; 2.5, with --quick 1.2",
        },
        Own {
            name: "--push",
            value: "ON|OFF",
            help: "two waves of force on the beam, so that it need not begin by itself; on (fsi2, fsi3)",
        },
    ],
};

/// Width of the channel \[m\].
const WIDTH: f64 = 0.41;
/// Centre and radius of the cylinder \[m\].
const CENTRE: [f64; 2] = [0.2, 0.2];
const RADIUS: f64 = 0.05;
/// Root, length and thickness of the beam \[m\], and its Poisson ratio.
const ROOT: f64 = 0.25;
const LENGTH: f64 = 0.35;
const THICKNESS: f64 = 0.02;
const POISSON: f64 = 0.4;
/// Density \[kg/m³\] and viscosity \[Pa s\] of the liquid.
const DENSITY: f64 = 1000.0;
const VISCOSITY: f64 = 1.0;
/// Length of the zone before the channel \[m\], and how often its liquid is brought to the profile on its way. The zone
/// drives the flow, so the inflow lacks what it takes to overcome the resistance of the channel, Δp/(ρ U TURNS): 3 % with 20.
const ZONE: f64 = 0.4;
const TURNS: f64 = 500.0;
/// Columns of the beam that are held, and layers of walls.
const HELD: i64 = 5;
const LAYERS: i64 = 3;

pub(crate) fn main() -> ExitCode {
    common::main(&EXAMPLE, perform::<f64>, Some(perform::<f32>))
}

/// A benchmark, and what is known of it: mean and amplitude of the tip's height \[m\], its frequency \[Hz\], and the mean
/// drag \[N/m\].
struct Case {
    name: &'static str,
    inflow: f64,
    density: f64,
    youngs: f64,
    tip: [f64; 2],
    frequency: f64,
    drag: f64,
    until: f64,
    dx: f64,
    through: f64,
    sound_speed: f64,
    background: f64,
    length: f64,
    push: bool,
}

impl Case {
    fn of(options: &Options) -> Result<Self, Failure> {
        let own = match options.text("--case").unwrap_or("fsi2") {
            "fsi1" => ("fsi1", 0.2, 1e3, 1.4e6, [0.8209e-3, 0.0], 0.0, 14.295, 15.0),
            "fsi2" => (
                "fsi2",
                1.0,
                1e4,
                1.4e6,
                [1.23e-3, 80.6e-3],
                2.0,
                208.83,
                12.0,
            ),
            "fsi3" => (
                "fsi3",
                2.0,
                1e3,
                5.6e6,
                [1.48e-3, 34.38e-3],
                5.3,
                457.3,
                5.0,
            ),
            other => {
                return Err(format!(
                    "--case: `{other}` is not accepted; it takes fsi1, fsi2, fsi3"
                )
                .into());
            }
        };
        let (name, inflow, density, youngs, tip, frequency, drag, until) = own;
        let count = options.number("--diameter-over-dx", 10.0)?;
        let dx = options.spacing.unwrap_or(2.0 * RADIUS / count);
        Ok(Self {
            name,
            inflow,
            density,
            youngs,
            tip,
            frequency,
            drag,
            until,
            dx: WIDTH / (WIDTH / dx).round(),
            through: options.number("--through", options.pick(8.0, 4.0))?.round(),
            sound_speed: inflow * options.number("--sound-speed", 15.0)?,
            background: options.number("--background", 1.0)?,
            length: options.number("--length", options.pick(2.5, 1.2))?,
            push: match options.text("--push") {
                None | Some("on") => frequency > 0.0,
                Some("off") => false,
                Some(other) => {
                    return Err(
                        format!("--push: `{other}` is not accepted; it takes on, off").into(),
                    );
                }
            },
        })
    }

    /// Ends of the period along x \[m\]: the zone comes first.
    fn ends(&self) -> [f64; 2] {
        let whole = |length: f64| (length / self.dx).round() * self.dx;
        [-whole(ZONE), whole(self.length)]
    }

    /// The time \[s\] in which the inflow rises.
    fn rise(&self) -> f64 {
        (0.8 / self.inflow).min(2.0)
    }

    /// Free columns of the beam, and how far they are apart \[m\]. Held are places: the last held column stands at the root, and
    /// the tip half a column behind the last.
    fn columns(&self) -> (f64, f64) {
        let free = (LENGTH * self.through / THICKNESS - 0.5).round();
        (free, LENGTH / (free + 0.5))
    }

    fn beam<T: Real>(&self) -> Body<T, 2> {
        let law = Linear::from_elastic_constants(self.density, self.youngs, POISSON);
        let shear = self.youngs / (2.0 * (1.0 + POISSON));
        let material = Material::new("beam", law).with_shear_modulus(shear);
        let row = THICKNESS / self.through;
        let (free, column) = self.columns();
        let points = (0..self.through as i64).flat_map(|k| {
            let y = CENTRE[1] + (k as f64 + 0.5) * row - 0.5 * THICKNESS;
            (1 - HELD..=free as i64).map(move |k| [ROOT + k as f64 * column, y])
        });
        Body::points_of("beam", material, points.collect(), (row * column).sqrt()).no_slip()
    }

    /// Rings of particles behind the cylinder's surface, less where the beam is held.
    fn cylinder(&self) -> Wall<2> {
        let mut points = Vec::new();
        let row = THICKNESS / self.through;
        let back = ROOT - (HELD as f64 - 0.5) * row;
        for layer in 0..LAYERS {
            let radius = RADIUS - (layer as f64 + 0.5) * self.dx;
            if radius <= 0.0 {
                break;
            }
            let count = (2.0 * PI * radius / self.dx).round().max(1.0);
            for k in 0..count as i64 {
                let turn = 2.0 * PI * (k as f64 + 0.5) / count;
                let at = [
                    CENTRE[0] + radius * turn.cos(),
                    CENTRE[1] + radius * turn.sin(),
                ];
                let clear = 0.25 * self.dx;
                let beam =
                    at[0] > back - clear && (at[1] - CENTRE[1]).abs() < 0.5 * THICKNESS + clear;
                if !beam {
                    points.push(at);
                }
            }
        }
        Wall::of("cylinder", points, self.dx).no_slip()
    }

    fn scene<T: Real>(&self) -> Scene<T, 2> {
        let (dx, [low, high]) = (self.dx, self.ends());
        let columns = ((high - low) / dx).round() as i64;
        let rows = (WIDTH / dx).round() as i64;
        let lattice = |rows: std::ops::Range<i64>| {
            rows.flat_map(move |row| {
                (0..columns).map(move |k| [low + (k as f64 + 0.5) * dx, (row as f64 + 0.5) * dx])
            })
        };
        let clear = 0.25 * dx;
        // Half a spacing from the beam, less rounding: where the lattice does not fit, water is missing and not too close.
        let apart = 0.49 * dx;
        let wet = |[x, y]: &[f64; 2]| {
            let [dx, dy] = [x - CENTRE[0], y - CENTRE[1]];
            let beam =
                *x > CENTRE[0] && *x < ROOT + LENGTH + apart && dy.abs() < 0.5 * THICKNESS + apart;
            dx.hypot(dy) > RADIUS + clear && !beam
        };
        let liquid = Liquid::new(DENSITY, 1480.0, VISCOSITY);
        let material: Material<T> = liquid.material("water", SoundSpeed::Chosen(self.sound_speed));
        // The channel is full and closed, and under a pressure that the wake does not use up.
        let pressure = self.background * (1.5 * self.inflow / self.sound_speed).powi(2);
        let water = Body::points_of(
            "water",
            material,
            lattice(0..rows).filter(wet).collect(),
            dx,
        )
        .density(DENSITY * (1.0 + pressure));
        let walls = lattice(-LAYERS..0).chain(lattice(rows..rows + LAYERS));
        let (inflow, rise) = (self.inflow, self.rise());
        let profile = move |y: f64, time: f64| {
            let share = 0.5 - 0.5 * (PI * (time / rise).min(1.0)).cos();
            share * inflow * 6.0 * y * (WIDTH - y) / (WIDTH * WIDTH)
        };
        let rate = TURNS * inflow / ZONE;
        let relax = Load::acceleration(move |at: &meshfree::simulation::LoadPoint<'_, 2>| {
            let [x, y] = at.position;
            if x >= 0.0 {
                return [0.0; 2];
            }
            let rate = rate * (PI * x / ZONE).sin().powi(2) * 2.0;
            let target = profile(y, at.time);
            [rate * (target - at.velocity[0]), -rate * at.velocity[1]]
        });
        // Two waves at the frequency that is expected, in the second mode of a clamped beam, to three quarters of the amplitude.
        let (rate, bend) = (2.0 * PI * self.frequency, 0.75 * self.tip[1]);
        let (from, span) = (1.2 * self.rise(), 2.0 / self.frequency);
        let push = Load::acceleration(move |at: &meshfree::simulation::LoadPoint<'_, 2>| {
            let since = at.time - from;
            if !(0.0..span).contains(&since) {
                return [0.0; 2];
            }
            let share = 2.0 * rate * bend / span * second_mode((at.position[0] - ROOT) / LENGTH);
            [0.0, share * (rate * since).sin()]
        });
        let scheme = schemes::weakly_compressible()
            .h_over_dx(1.3)
            .with_viscosity(Inviscid)
            .with(Laminar(LaminarViscosity))
            .with(VolumeConsistency { strength: 0.05 })
            .with(Shifting::CLOSED)
            .walls(ExtrapolatedPressure {
                floor: f64::NEG_INFINITY,
            });
        let scene = Scene::new(scheme)
            .body(water)
            .group(
                schemes::total_lagrangian().with(StVenantKirchhoff),
                [self.beam()],
            )
            .wall(Wall::of("channel", walls.collect(), dx).no_slip())
            .wall(self.cylinder())
            // It stands on the cylinder and does not reach the channel.
            .between("beam", "channel", Interaction::None)
            .between("beam", "cylinder", Interaction::None)
            .boundary(Periodic::along(0, low, high))
            .load(relax.on("water"))
            .fix("beam", |[x, _]| *x < ROOT + 1e-6)
            .sub_cycle(
                "beam",
                common::stable_steps([self.youngs, POISSON, self.density], self.sound_speed),
            );
        if self.push {
            scene.load(push.on("beam"))
        } else {
            scene
        }
    }
}

/// The second mode of a clamped thin beam at a share of its length, one at the tip.
fn second_mode(x: f64) -> f64 {
    const ROOT: f64 = 4.694_091_132_974_175;
    let form = |s: f64| {
        let k = ROOT * s;
        let share = (ROOT.cos() + ROOT.cosh()) / (ROOT.sin() + ROOT.sinh());
        k.cosh() - k.cos() - share * (k.sinh() - k.sin())
    };
    form(x.clamp(0.0, 1.0)) / form(1.0)
}

/// The liquid, coloured by its speed \[m/s\] or its pressure \[kPa\], and the beam with the value zero.
fn field<T: Real>(
    now: &Simulation<T, 2>,
    dx: f64,
    name: &str,
    unit: &str,
    value: impl Fn(&meshfree::simulation::ParticleView<'_, T, 2>) -> f64,
) -> Result<Panel, Failure> {
    let water = now.body("water")?.map(|p| {
        let [x, y] = p.position();
        (x, y, value(&p))
    });
    let beam = now.body("beam")?.map(|p| {
        let [x, y] = p.position();
        (x, y, 0.0)
    });
    let points: Vec<_> = water.chain(beam).filter(|own| own.0 < 1.6).collect();
    Ok(Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m"))
        .cloud(Cloud::new(Axis::linear(name, unit), points).diameter(0.8 * dx))
        .equal_aspect()
        .title(&format!("t = {:.3} s", now.time())))
}

fn speed<T: Real>(p: &meshfree::simulation::ParticleView<'_, T, 2>) -> f64 {
    let [u, v] = p.velocity();
    u.hypot(v)
}

fn perform<T: Real>(options: &Options) -> Result<(), Failure> {
    let case = Case::of(options)?;
    let mut simulation = case.scene::<T>().build()?;
    // The last two columns of the beam, from which the tip's displacement follows by a straight line.
    let column = |at: f64| -> Result<Vec<(usize, [f64; 2])>, Failure> {
        let own = simulation.body("beam")?.filter(|p| {
            p.vector(Field::REFERENCE_POSITION)
                .is_some_and(|x| (x[0] - at).abs() < 1e-6)
        });
        Ok(own.map(|p| (p.id(), p.position())).collect())
    };
    let (free, step) = case.columns();
    let last = ROOT + free * step;
    let columns = [column(last)?, column(last - step)?];
    let tip = |now: &Simulation<T, 2>| -> Result<[f64; 2], Failure> {
        let mut moved = [[0.0; 2]; 2];
        for p in now.body("beam")? {
            for (own, sum) in columns.iter().zip(&mut moved) {
                if let Some((_, first)) = own.iter().find(|(id, _)| *id == p.id()) {
                    for d in 0..2 {
                        sum[d] += (p.position()[d] - first[d]) / own.len() as f64;
                    }
                }
            }
        }
        Ok(core::array::from_fn(|d| {
            1.5 * moved[0][d] - 0.5 * moved[1][d]
        }))
    };

    let until = options.until_or(case.until, 0.3 / case.inflow);
    let names = [
        "time_s",
        "tip_dx_m",
        "tip_dy_m",
        "drag_n_m",
        "lift_n_m",
        "inflow_m_s",
    ];
    let mut csv = CsvWriter::create(options.file("history.csv"), &names)?;
    let mut movie = Pvd::create(options.file("flow.pvd"))?;
    let mut samples: [Vec<(f64, f64)>; 4] = Default::default();
    let mut before = (0.0, [0.0; 2]);
    let mut highest: Option<(f64, Panel)> = None;
    let period = if case.frequency > 0.0 {
        1.0 / case.frequency
    } else {
        1.0
    };
    let summary = Run::new(&mut simulation, until)
        .label(EXAMPLE.name)
        .observe(
            Schedule::evenly(1 + (40.0 * until / period).ceil().max(20.0) as usize),
            |now| {
                let moved = tip(now)?;
                // On the beam now, on the cylinder as mean since the last time.
                let impulse = now.wall_impulse("cylinder")?;
                let beam = now.force_between("beam", "water")?;
                let span = (now.time() - before.0).max(f64::MIN_POSITIVE);
                let force: [f64; 2] =
                    core::array::from_fn(|d| beam[d] + (impulse[d] - before.1[d]) / span);
                before = (now.time(), impulse);
                let entering = now
                    .body("water")?
                    .filter(|p| (0.0..2.0 * RADIUS).contains(&p.position()[0]));
                let [speeds, count] =
                    entering.fold([0.0; 2], |[sum, n], p| [sum + p.velocity()[0], n + 1.0]);
                let inflow = speeds / count;
                csv.row(&[now.time(), moved[0], moved[1], force[0], force[1], inflow])?;
                if samples[0].len().is_multiple_of(20) {
                    movie.frame(now.time(), &now.vtu_with_walls())?;
                }
                let values = [moved[0], moved[1], force[0], inflow];
                for (line, value) in samples.iter_mut().zip(values) {
                    line.push((now.time(), value));
                }
                let late = now.time() > 0.6 * until;
                if late && highest.as_ref().is_none_or(|(most, _)| moved[1] > *most) {
                    highest = Some((moved[1], field(now, case.dx, "speed", "m/s", speed)?));
                }
                Ok(())
            },
        )
        .go()?;

    let [along, across, drag, inflow] = samples;
    let [mean, amplitude] = case.tip;
    let milli = |line: &[(f64, f64)]| -> Vec<(f64, f64)> {
        line.iter().map(|(t, x)| (*t, 1e3 * x)).collect()
    };
    let level = |at: f64| [(0.0, at), (until, at)];
    let mut heights = Panel::new(
        Axis::linear("time", "s"),
        Axis::linear("displacement of the tip", "mm"),
    )
    .series(Series::line("across", milli(&across)))
    .series(Series::line("along", milli(&along)));
    let bounds = [mean - amplitude, mean + amplitude].map(|bound| 1e3 * bound);
    let band = if amplitude > 0.0 {
        vec![
            (0.0, bounds[0]),
            (until, bounds[0]),
            (until, bounds[1]),
            (0.0, bounds[1]),
        ]
    } else {
        level(bounds[0]).to_vec()
    };
    heights = heights.series(Series::line("across, Turek & Hron 2006", band).reference());
    let forces = Panel::new(Axis::linear("time", "s"), Axis::linear("drag", "N/m"))
        .series(Series::line("meshfree", drag[1..].to_vec()))
        .series(Series::line("mean of Turek & Hron 2006", level(case.drag)).reference());
    let mut figure = Figure::new()
        .columns(2)
        .shared_legend()
        .panel(heights)
        .panel(forces);
    if let Some((_, panel)) = highest {
        figure = figure.panel(panel);
    }
    let pressure = field(&simulation, case.dx, "pressure", "kPa", |p| {
        1e-3 * p.pressure()
    })?;
    figure = figure.panel(pressure);
    figure.save(options.file("flow.svg"))?;

    println!("{summary}, {} steps of the beam", simulation.sub_steps());
    report(&case, &across, [&drag, &inflow]);
    println!("written to {}", options.folder().display());
    Ok(())
}

/// Means of the greatest and of the least heights \[m\], swing by swing: extremes of a run differ by 2 % from their own means.
/// Samples miss a peak by up to 0.3 %, so each is that of a parabola.
fn peaks(line: &[(f64, f64)]) -> [f64; 2] {
    let middle = line.iter().map(|(_, y)| y).sum::<f64>() / line.len() as f64;
    let mut sums = [[0.0; 2]; 2];
    // The first and the last swing are not whole.
    let swings: Vec<_> = line
        .chunk_by(|a, b| (a.1 > middle) == (b.1 > middle))
        .collect();
    let whole = 1..(swings.len() - 1).max(1);
    for swing in &swings[whole] {
        let above = swing[0].1 > middle;
        let sign = if above { 1.0 } else { -1.0 };
        let height = |k: usize| sign * swing[k].1;
        let top = (0..swing.len()).fold(0, |a, b| if height(b) > height(a) { b } else { a });
        let mut peak = height(top);
        if (1..swing.len() - 1).contains(&top) {
            let [before, after] = [top - 1, top + 1].map(height);
            let bend = 2.0 * peak - before - after;
            peak += (after - before).powi(2) / (8.0 * bend.max(f64::MIN_POSITIVE));
        }
        let [sum, count] = &mut sums[usize::from(above)];
        *sum += sign * peak;
        *count += 1.0;
    }
    sums.map(|[sum, count]| if count > 0.0 { sum / count } else { middle })
}

/// What the second half of the run says.
fn report(case: &Case, across: &[(f64, f64)], [drag, inflow]: [&[(f64, f64)]; 2]) {
    let from = across.len() / 2;
    let late = &across[from..];
    let [low, high] = peaks(late);
    let (middle, amplitude) = (0.5 * (low + high), 0.5 * (high - low));
    let rising: Vec<f64> = late
        .windows(2)
        .filter(|pair| pair[0].1 < middle && pair[1].1 >= middle)
        .map(|pair| {
            let share = (middle - pair[0].1) / (pair[1].1 - pair[0].1);
            pair[0].0 + share * (pair[1].0 - pair[0].0)
        })
        .collect();
    let frequency = match rising[..] {
        [first, .., last] => (rising.len() - 1) as f64 / (last - first),
        _ => 0.0,
    };
    let late_mean = |line: &[(f64, f64)]| {
        line[from..].iter().map(|(_, own)| own).sum::<f64>() / late.len() as f64
    };
    let (force, speed) = (late_mean(drag), late_mean(inflow));
    println!(
        "{}, second half: tip {:.2} ± {:.2} mm at {frequency:.3} Hz, drag {force:.2} N/m, inflow {speed:.4} m/s",
        case.name,
        1e3 * middle,
        1e3 * amplitude
    );
    println!(
        "Turek & Hron 2006: tip {:.2} ± {:.2} mm at {:.3} Hz, drag {:.2} N/m",
        1e3 * case.tip[0],
        1e3 * case.tip[1],
        case.frequency,
        case.drag
    );
}
