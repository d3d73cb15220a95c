//! What the programs of violent flow share: their options, and runs watched by probes and gauges.
//! Used by `dam_break` and `sloshing_roll`.

// Each program uses a part of this.
#![allow(dead_code)]

use super::common::{Failure, Options, Own, Records};
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::output::csv::CsvWriter;
use meshfree::output::progress::Progress;
use meshfree::prelude::*;
use meshfree::simulation::Phases;
use meshfree::term::viscosity::{MonaghanGingold, Riemann};
use meshfree::term::{Fourtakas, LaminarViscosity};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// One option of a program alone, and what the programs of violent flow share beside what all take.
pub const fn options_and(one: Own) -> [Own; SHARED.len() + 1] {
    let mut all = [one; SHARED.len() + 1];
    let mut k = 0;
    while k < SHARED.len() {
        all[k + 1] = SHARED[k];
        k += 1;
    }
    all
}

const SHARED: [Own; 14] = [
    own("--alpha", "A", "artificial viscosity (0.02; riemann: 1)"),
    own("--delta", "D", "density diffusion (0.1)"),
    own(
        "--damping",
        "L",
        "bulk viscosity against sound, over rho c h (0.3; 0 for none)",
    ),
    own("--h-over-dx", "R", "smoothing length over spacing (1.5)"),
    own(
        "--sound-speed",
        "M/S",
        "20 √(gh), ten times the speed expected",
    ),
    own(
        "--cut-off-pa",
        "P",
        "least pressure of the liquid (0: it cavitates)",
    ),
    own(
        "--expansion-memory",
        "",
        "remembers how far cavitated liquid has expanded (off)",
    ),
    own("--riemann-walls", "", "walls by one-sided Riemann problems"),
    own(
        "--jitter",
        "S",
        "random displacement of particles from the lattice at the start, over dx (0; spheric2: 0.2, with lattice \
         rows offset)",
    ),
    own("--seed", "N", "seed of the random displacement (1)"),
    own(
        "--frames",
        "N",
        "particle files and pictures (20; 0 for none)",
    ),
    Records::OPTION,
    own("--case", "NAME", "see above"),
    own("--bars", "", "compares with the measured numbers"),
];

/// An option: its name, what it takes, and what it means.
pub const fn own(name: &'static str, value: &'static str, help: &'static str) -> Own {
    Own { name, value, help }
}

/// The schemes that can be asked for by name; "viscous" has the water's own viscosity, and walls without slip.
pub const SCHEMES: [&str; 4] = ["weakly-compressible", "riemann", "shifting", "viscous"];

/// What the options mean.
#[derive(Clone, Debug)]
pub struct Choices {
    pub scheme: String,
    pub alpha: Option<f64>,
    pub delta: f64,
    pub damping: f64,
    pub h_over_dx: f64,
    pub sound_speed: Option<f64>,
    pub gate: Option<f64>,
    pub cut_off: f64,
    pub expansion_memory: bool,
    pub riemann_walls: bool,
    pub jitter: Option<f64>,
    pub seed: u64,
    pub frames: usize,
    pub records: Records,
    pub bars: bool,
}

impl Choices {
    /// From the command line.
    pub fn of(options: &Options) -> Result<Self, Failure> {
        let number = |name: &str, low: f64, takes: &str| {
            let Some(text) = options.text(name) else {
                return Ok(None);
            };
            let value = text.trim().parse::<f64>().ok();
            let value = value.filter(|value| value.is_finite() && *value >= low);
            value.map(Some).ok_or_else(|| {
                format!("{name}: `{text}` is not accepted; it takes {takes}, in SI units")
            })
        };
        let not_negative = |name: &str| number(name, 0.0, "a number, 0 or more");
        let whole = |name: &str, usual: u32| {
            let Some(text) = options.text(name) else {
                return Ok(usual);
            };
            let refused =
                |_| format!("{name}: `{text}` is not accepted; it takes a whole number, 0 or more");
            text.trim().parse::<u32>().map_err(refused)
        };
        Ok(Self {
            scheme: options.scheme.clone(),
            alpha: not_negative("--alpha")?,
            delta: not_negative("--delta")?.unwrap_or(0.1),
            damping: not_negative("--damping")?.unwrap_or(0.3),
            h_over_dx: not_negative("--h-over-dx")?.unwrap_or(1.5),
            sound_speed: not_negative("--sound-speed")?,
            gate: not_negative("--gate")?.filter(|speed| *speed > 0.0),
            cut_off: number("--cut-off-pa", f64::MIN, "a number")?.unwrap_or(0.0),
            expansion_memory: options.has("--expansion-memory"),
            riemann_walls: options.has("--riemann-walls"),
            jitter: not_negative("--jitter")?,
            seed: whole("--seed", 1)?.into(),
            frames: whole("--frames", if options.quick { 4 } else { 20 })? as usize,
            records: Records::of(options)?,
            bars: options.has("--bars"),
        })
    }

    /// Layers of wall particles that the kernel does not look through.
    pub fn layers(&self) -> usize {
        (2.0 * self.h_over_dx).ceil() as usize
    }

    /// The scheme, composed.
    pub fn compose<T: Real, const D: usize>(&self) -> Scheme<T, D>
    where
        WendlandC2: Kernel<D>,
    {
        if self.riemann_walls {
            self.compose_with(RiemannWalls::default())
        } else {
            self.compose_with(ExtrapolatedPressure::default())
        }
    }

    fn compose_with<T: Real, const D: usize>(&self, walls: impl Effect<D>) -> Scheme<T, D>
    where
        WendlandC2: Kernel<D>,
    {
        let damping = AcousticDamping {
            strength: self.damping,
        };
        let base = schemes::weakly_compressible()
            .density_diffusion(Fourtakas { delta: self.delta })
            .h_over_dx(self.h_over_dx)
            .walls(walls)
            .with((self.damping > 0.0).then_some(damping))
            .with(self.expansion_memory.then_some(ExpansionMemory));
        let alpha = |standard: f64| self.alpha.unwrap_or(standard);
        match self.scheme.as_str() {
            "riemann" => base
                .with_viscosity(Riemann {
                    alpha: alpha(1.0),
                    ..Riemann::STANDARD
                })
                .named("weakly compressible, Riemann viscosity")
                .compose(),
            "shifting" => base
                .with_viscosity(plain(alpha(0.02)))
                .with(Shifting::STANDARD)
                .named("weakly compressible, shifting")
                .compose(),
            "viscous" => base
                .with_viscosity(plain(alpha(0.02)))
                .with(Laminar(LaminarViscosity))
                .named("weakly compressible, viscous")
                .compose(),
            _ => base.with_viscosity(plain(alpha(0.02))).compose(),
        }
    }

    /// A body off its lattice, as far as asked or as is usual.
    pub fn jittered<T: Real, const D: usize>(&self, body: Body<T, D>, usual: f64) -> Body<T, D> {
        body.jitter(self.jitter.unwrap_or(usual), self.seed)
    }

    /// Whether water sticks to walls.
    pub fn sticks(&self) -> bool {
        self.scheme == "viscous"
    }

    /// A wall with the slip that the scheme has.
    pub fn slip<const D: usize>(&self, wall: Wall<D>) -> Wall<D> {
        if self.sticks() { wall.no_slip() } else { wall }
    }
}

fn plain(alpha: f64) -> MonaghanGingold {
    MonaghanGingold { alpha, beta: 0.0 }
}

/// What watches a run.
#[derive(Default)]
pub struct Watch<const D: usize> {
    pub probes: Vec<PressureProbe<D>>,
    pub gauges: Vec<WaveGauge<D>>,
    /// Whether probes are also read as force over area.
    pub contact: bool,
}

/// A history: a time and a value for each step, by name.
#[derive(Clone, Debug, Default)]
pub struct History {
    pub time: Vec<f64>,
    pub names: Vec<String>,
    pub columns: Vec<Vec<f64>>,
    pub steps: u64,
    pub builds: u64,
    pub wall_clock: f64,
    pub particles: usize,
    pub lost: usize,
    pub left: u64,
    pub phases: Phases,
}

impl History {
    /// The values under a name.
    pub fn column(&self, name: &str) -> &[f64] {
        let index = self.names.iter().position(|own| own == name);
        index.map_or(&[], |index| &self.columns[index])
    }

    /// Points of a curve, scaled.
    pub fn points(&self, name: &str, time: f64, value: f64) -> Vec<(f64, f64)> {
        let pairs = self.time.iter().zip(self.column(name));
        pairs.map(|(t, v)| (t / time, v / value)).collect()
    }

    /// The mean between two times.
    pub fn mean(&self, name: &str, from: f64, to: f64) -> f64 {
        let values = self.column(name);
        // Steps differ in length: trapezoids.
        let (mut area, mut width) = (0.0, 0.0);
        for k in 1..values.len() {
            if self.time[k - 1] >= from && self.time[k] <= to {
                let dt = self.time[k] - self.time[k - 1];
                area += 0.5 * dt * (values[k] + values[k - 1]);
                width += dt;
            }
        }
        if width > 0.0 { area / width } else { f64::NAN }
    }

    /// The value at a time, between steps.
    pub fn at(&self, name: &str, time: f64) -> f64 {
        let values = self.column(name);
        let right = self.time.partition_point(|t| *t < time);
        if right == 0 || right >= values.len() {
            return f64::NAN;
        }
        let (t0, t1) = (self.time[right - 1], self.time[right]);
        values[right - 1] + (values[right] - values[right - 1]) * (time - t0) / (t1 - t0)
    }

    /// First time from `from` on at which the value exceeds a threshold.
    pub fn first_above(&self, name: &str, threshold: f64, from: f64) -> f64 {
        let mut pairs = self.time.iter().zip(self.column(name));
        pairs
            .find(|(t, v)| **t >= from && **v > threshold)
            .map_or(f64::NAN, |(t, _)| *t)
    }

    /// The same history averaged over a time window around each step, shorter at the ends.
    pub fn smoothed(&self, window: f64) -> Self {
        let time = &self.time;
        let mean = |values: &Vec<f64>| {
            // The integral up to each step, by trapezoids: steps are shorter where pressures are high.
            let mut sums = vec![0.0; time.len()];
            for k in 1..time.len() {
                let area = 0.5 * (time[k] - time[k - 1]) * (values[k] + values[k - 1]);
                sums[k] = sums[k - 1] + area;
            }
            let up_to = |t: f64| {
                let right = time
                    .partition_point(|own| *own < t)
                    .clamp(1, time.len() - 1);
                let share = (t - time[right - 1]) / (time[right] - time[right - 1]);
                sums[right - 1] + share * (sums[right] - sums[right - 1])
            };
            let ends = [time[0], time[time.len() - 1]];
            let around = |t: &f64| {
                let from = (t - 0.5 * window).max(ends[0]);
                let to = (t + 0.5 * window).min(ends[1]);
                (up_to(to) - up_to(from)) / (to - from)
            };
            time.iter().map(around).collect()
        };
        if time.len() < 2 {
            return self.clone();
        }
        Self {
            columns: self.columns.iter().map(mean).collect(),
            ..self.clone()
        }
    }

    /// Largest value between two times, and when.
    pub fn peak(&self, name: &str, from: f64, to: f64) -> (f64, f64) {
        let pairs = self.time.iter().zip(self.column(name));
        pairs.filter(|(t, _)| (from..=to).contains(*t)).fold(
            (f64::NAN, f64::NEG_INFINITY),
            |best, (&t, &v)| {
                if v > best.1 { (t, v) } else { best }
            },
        )
    }

    /// Three lines about the run itself.
    pub fn summary(&self) -> String {
        let mut text = format!(
            "{} particles of liquid, {} steps in {:.1} s",
            self.particles, self.steps, self.wall_clock
        );
        if self.steps > 0 {
            let each = 1e6 * self.wall_clock / self.steps as f64 / self.particles as f64;
            let served = self.steps as f64 / self.builds as f64;
            let _ = write!(
                text,
                " ({each:.2} µs a particle and step, {served:.1} steps a list build)"
            );
        }
        let _ = write!(text, "; {} in the walls, {} left", self.lost, self.left);
        let share = |of: Duration| 100.0 * of.as_secs_f64() / self.wall_clock;
        let Phases {
            lists,
            packing,
            pairs,
            work,
            walls,
            materials,
            integration,
        } = self.phases;
        let watching = 100.0 - share(self.phases.total());
        let _ = write!(
            text,
            "\nof the time lists {:.0} %, packing {:.0} %, pairs {:.0} %, work {:.0} %, walls {:.0} %, materials {:.0} %, \
             integration {:.0} %, probes and files {watching:.0} %",
            share(lists),
            share(packing),
            share(pairs),
            share(work),
            share(walls),
            share(materials),
            share(integration),
        );
        text
    }
}

/// What a run leaves while it goes.
pub struct Keep<'a> {
    /// Table of its history, and the comment above it.
    pub table: PathBuf,
    pub comment: &'a str,
    /// No row of it is closer to the last than this \[s\].
    pub apart: f64,
    /// How many frames.
    pub frames: usize,
}

/// Runs a simulation to `until` \[s\] and keeps what probes (`NAME_pa`, and where asked for `NAME_contact_pa`), gauges
/// (`NAME_m`) and the front along the first axis (`front_m`) read in every step; `frame` sees frames.
///
/// Particles outside of `inside` at the end count as lost.
pub fn run<T: Real, const D: usize>(
    keep: &Keep<'_>,
    simulation: &mut Simulation<T, D>,
    until: f64,
    watch: &Watch<D>,
    inside: impl Fn(&Simulation<T, D>, [f64; D]) -> bool,
    mut frame: impl FnMut(&Simulation<T, D>, usize) -> Result<(), Failure>,
) -> Result<History, Failure> {
    let felt = if watch.contact {
        &watch.probes[..]
    } else {
        &[]
    };
    let mut history = History {
        names: watch
            .probes
            .iter()
            .map(|probe| format!("{}_pa", probe.name()))
            .chain(watch.gauges.iter().flat_map(|gauge| {
                let name = gauge.name();
                [format!("{name}_m"), format!("{name}_wetted_m")]
            }))
            .chain(["front_m".into()])
            .chain(
                felt.iter()
                    .map(|probe| format!("{}_contact_pa", probe.name())),
            )
            .collect(),
        particles: simulation.particles(),
        ..History::default()
    };
    history.columns = vec![Vec::new(); history.names.len()];
    let columns: Vec<&str> = ["time_s"]
        .into_iter()
        .chain(history.names.iter().map(String::as_str))
        .collect();
    let mut table = CsvWriter::create_with_comment(&keep.table, keep.comment, &columns)?;
    let (frames, mut next) = (keep.frames, f64::NEG_INFINITY);
    let spacing = simulation.spacing();
    let started = Instant::now();
    let mut progress = Progress::new("flow");
    let (mut shown, mut failed) = (0, None::<Failure>);
    // Gauges and fronts move by less than a hundredth of the spacing in a step: every eighth will do.
    let mut slow = vec![0.0; 2 * watch.gauges.len() + 1];
    // A spike lasts for eight steps or so, and forces on walls cost a sweep.
    let mut contact = vec![0.0; felt.len()];
    simulation.run_with(until, |now| {
        history.time.push(now.time());
        if now.steps() % 8 == 1 {
            for (values, gauge) in slow.chunks_mut(2).zip(&watch.gauges) {
                values.copy_from_slice(&[gauge.height(now), gauge.wetted_length(now)]);
            }
            let front = now.all().fold(0.0_f64, |most, p| most.max(p.position()[0]));
            slow[2 * watch.gauges.len()] = front + 0.5 * spacing;
        }
        let probes = PressureProbe::pressures(&watch.probes, now);
        if !felt.is_empty() && now.steps() % 4 == 1 {
            contact = PressureProbe::contact_pressures(felt, now);
        }
        let slow = slow.iter().chain(&contact).copied();
        let row: Vec<f64> = [now.time()].into_iter().chain(probes).chain(slow).collect();
        for (column, value) in history.columns.iter_mut().zip(&row[1..]) {
            column.push(*value);
        }
        if now.time() >= next && failed.is_none() {
            failed = table.row(&row).err().map(Into::into);
            next = now.time() + keep.apart;
        }
        let due = until * shown as f64 / frames.max(1) as f64 * (1.0 - 1e-9);
        if frames > 0 && now.time() >= due && failed.is_none() {
            failed = frame(now, shown).err();
            shown += 1;
        }
        progress.update(now.time() / until, format_args!("t = {:.3} s", now.time()));
    })?;
    progress.finish();
    if let Some(failure) = failed {
        return Err(failure);
    }
    history.steps = simulation.steps();
    history.builds = simulation.list_builds();
    history.phases = simulation.phases();
    history.wall_clock = started.elapsed().as_secs_f64();
    history.left = simulation.removed().particles;
    history.lost = simulation
        .all()
        .filter(|particle| !inside(simulation, particle.position()))
        .count();
    Ok(history)
}

/// One line of a comparison with something measured.
pub struct Bar {
    pub what: String,
    pub computed: f64,
    pub wanted: String,
    pub holds: bool,
}

impl Bar {
    /// Within a distance of a value.
    pub fn near(what: &str, computed: f64, value: f64, distance: f64) -> Self {
        Self::between(what, computed, value - distance, value + distance)
    }

    /// Between two values.
    pub fn between(what: &str, computed: f64, low: f64, high: f64) -> Self {
        let digits = |v: f64| meshfree::output::table::significant(v, 4);
        Self {
            what: what.into(),
            computed,
            wanted: format!("{} to {}", digits(low), digits(high)),
            holds: (low..=high).contains(&computed),
        }
    }
}

/// Prints a comparison.
pub fn print_bars(title: &str, bars: &[Bar]) {
    let head = ["quantity", "computed", "wanted", "holds"];
    let mut table = meshfree::output::table::Table::new(head).title(title);
    for bar in bars {
        let computed = meshfree::output::table::significant(bar.computed, 4);
        let holds = if bar.holds { "yes" } else { "no" };
        table.row([bar.what.clone(), computed, bar.wanted.clone(), holds.into()]);
    }
    println!("{}", table.markdown());
}
