//! What a run writes: particles for ParaView, a history, sensors, the last state, a receipt.
//! Schedules, criteria and observers are those of the library.

use crate::build::{Part, vector};
use crate::fault::{Fault, Faults, Source};
use crate::format::{Quantity, SceneFile, Schedule as Described, Window};
use meshfree::error::Error;
use meshfree::observe::{PressureProbe, WaveGauge};
use meshfree::output::csv::CsvWriter;
use meshfree::particles::Field;
use meshfree::run::{Failure, Run, Schedule, Stop, Summary};
use meshfree::scene::ParticleState;
use meshfree::simulation::Simulation;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Histories that no schedule is given for are written at so many times, and sensors are read at so many.
const USUAL: [usize; 2] = [101, 501];
/// The file from which a run goes on.
pub const CHECKPOINT: &str = "checkpoint.safetensors";
/// The letters of axes, in names of columns.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Sensors, gauges and places of a file, on a simulation.
pub struct Sensors<const D: usize> {
    probes: Vec<PressureProbe<D>>,
    gauges: Vec<WaveGauge<D>>,
    points: Vec<(Field, [f64; D])>,
    columns: Vec<String>,
}

impl<const D: usize> Sensors<D> {
    /// Those of a file, whose schedules and criteria are looked at too.
    ///
    /// # Errors
    /// What is wrong with them, with lines.
    pub fn of(
        source: &Source,
        file: &SceneFile,
        now: &mut Simulation<f64, D>,
    ) -> Result<Self, Faults> {
        let mut faults = check_run(file, now);
        let mut own = Self {
            probes: Vec::new(),
            gauges: Vec::new(),
            points: Vec::new(),
            columns: vec!["time_s".into()],
        };
        for k in 0..file.probe.len() {
            match own.probe(file, k, now) {
                Ok(()) => own.columns.push(format!("{}_pa", file.probe[k].name)),
                Err(fault) => faults.push(fault),
            }
        }
        for k in 0..file.gauge.len() {
            match own.gauge(file, k, now) {
                Ok(()) => own.columns.push(format!("{}_m", file.gauge[k].name)),
                Err(fault) => faults.push(fault),
            }
        }
        for k in 0..file.point.len() {
            if let Err(fault) = own.point(file, k, now) {
                faults.push(fault);
            }
        }
        let twice = |k: &usize| own.columns[..*k].contains(&own.columns[*k]);
        if let Some(k) = (0..own.columns.len()).find(twice) {
            let text = format!(
                "two columns are called `{}`: give each a name of its own",
                own.columns[k]
            );
            faults.push(Fault::new("", text));
        }
        if faults.is_empty() {
            Ok(own)
        } else {
            Err(source.faults(faults))
        }
    }

    fn probe(&mut self, file: &SceneFile, k: usize, now: &Simulation<f64, D>) -> Part<()> {
        let (own, field) = (&file.probe[k], format!("probe[{k}]"));
        let centre = vector(&own.centre, &format!("{field}.centre"))?;
        let normal = vector(&own.normal, &format!("{field}.normal"))?;
        let probe = PressureProbe::disc(now, &own.name, centre, normal, own.diameter);
        let mut probe = probe.map_err(Fault::of(&field))?;
        if let Some(wall) = &own.on_wall {
            let at = format!("{field}.on_wall");
            probe = probe.on_wall(wall.as_str()).map_err(Fault::of(&at))?;
        }
        self.probes.push(probe);
        Ok(())
    }

    fn gauge(&mut self, file: &SceneFile, k: usize, now: &Simulation<f64, D>) -> Part<()> {
        let (own, field) = (&file.gauge[k], format!("gauge[{k}]"));
        let foot = vector(&own.foot, &format!("{field}.foot"))?;
        let gauge = WaveGauge::upwards(now, &own.name, foot, own.axis.number());
        let mut gauge = gauge.map_err(Fault::of(&field))?;
        if let Some(wall) = &own.on_wall {
            let at = format!("{field}.on_wall");
            gauge = gauge.on_wall(wall.as_str()).map_err(Fault::of(&at))?;
        }
        self.gauges.push(gauge);
        Ok(())
    }

    fn point(&mut self, file: &SceneFile, k: usize, now: &Simulation<f64, D>) -> Part<()> {
        let (own, field) = (&file.point[k], format!("point[{k}]"));
        let at = vector(&own.at, &format!("{field}.at"))?;
        let (of, unit) = match own.field {
            Quantity::Pressure => (Field::PRESSURE, "pa"),
            Quantity::Density => (Field::DENSITY, "kg_m3"),
            Quantity::Energy => (Field::ENERGY, "j_kg"),
            Quantity::Velocity => (Field::VELOCITY, "m_s"),
        };
        now.sample(of, &[at]).map_err(Fault::of(&field))?;
        if own.field == Quantity::Velocity {
            let each = AXES[..D]
                .iter()
                .map(|axis| format!("{}_{axis}_{unit}", own.name));
            self.columns.extend(each);
        } else {
            self.columns.push(format!("{}_{unit}", own.name));
        }
        self.points.push((of, at));
        Ok(())
    }

    fn is_empty(&self) -> bool {
        self.columns.len() == 1
    }

    /// What they read now, behind the time.
    fn row(&self, now: &Simulation<f64, D>) -> Result<Vec<f64>, Error> {
        let mut row = vec![now.time()];
        row.extend(PressureProbe::pressures(&self.probes, now));
        row.extend(self.gauges.iter().map(|gauge| gauge.height(now)));
        for (field, at) in &self.points {
            row.extend(now.sample(*field, &[*at])?.values());
        }
        Ok(row)
    }
}

/// The schedule of a file, or evenly so often.
fn schedule(own: Option<&Described>, usual: usize) -> Schedule {
    let Some(own) = own else {
        return Schedule::evenly(usual);
    };
    let given = [
        own.every.map(Schedule::every),
        own.evenly.map(Schedule::evenly),
        own.steps.map(Schedule::steps),
        (!own.at.is_empty()).then(|| Schedule::at(own.at.iter().copied())),
    ];
    let all = given.into_iter().flatten().reduce(Schedule::and);
    // What names no time is written at the end.
    all.unwrap_or_else(Schedule::end)
}

/// The criteria of a file, by field.
fn stops<const D: usize>(
    file: &SceneFile,
) -> impl Iterator<Item = (&'static str, Stop<'static, f64, D>)> {
    let own = &file.run;
    let seconds = |seconds: f64| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    let window = |own: &Option<Window>, of: fn(f64, f64) -> Stop<'static, f64, D>| {
        own.as_ref().map(|own| of(own.share, own.over))
    };
    let given = [
        ("run.steady", window(&own.steady, Stop::steady)),
        ("run.at_rest", window(&own.at_rest, Stop::at_rest)),
        ("run.energy_drift", own.energy_drift.map(Stop::energy_drift)),
        (
            "run.wall_clock",
            own.wall_clock.map(|own| Stop::wall_clock(seconds(own))),
        ),
    ];
    let given = given.into_iter();
    given.filter_map(|(field, stop)| Some((field, stop?)))
}

/// Schedules and criteria that make no sense, before the run.
fn check_run<const D: usize>(file: &SceneFile, now: &mut Simulation<f64, D>) -> Vec<Fault> {
    let end = now.time();
    let mut faults = Vec::new();
    let output = &file.output;
    let schedules = [
        ("output.paraview", &output.paraview),
        ("output.history", &output.history),
        ("output.probes", &output.probes),
        ("output.checkpoint", &output.checkpoint),
    ];
    // A run that is over as it begins checks what it is given.
    for (field, own) in schedules {
        if let Some(own) = own {
            let run = Run::new(now, end).observe(schedule(Some(own), 2), |_| Ok(()));
            faults.extend(run.go().err().map(Fault::of(field)));
        }
    }
    for (field, stop) in stops(file) {
        let over = Run::new(now, end).stop(stop).go();
        faults.extend(over.err().map(Fault::of(field)));
    }
    if let Some(own) = file
        .run
        .wall_clock
        .filter(|own| !(own.is_finite() && *own > 0.0))
    {
        let text = format!("is {own}: it must be finite and positive, in seconds");
        faults.push(Fault::new("run.wall_clock", text));
    }
    faults
}

/// The place of a table: a run that goes on leaves those of the run before, and takes the next number.
fn free(folder: &Path, name: &str, is_resumed: bool) -> PathBuf {
    let numbers = (2..).map(|k| format!("{name}_{k}.csv"));
    let names = core::iter::once(format!("{name}.csv")).chain(numbers);
    let mut paths = names.map(|own| folder.join(own));
    let first = paths.find(|path| !(is_resumed && path.exists()));
    first.unwrap_or_else(|| folder.join(name))
}

/// Runs to the end, and writes into `folder`.
///
/// # Errors
/// As [`Run::go`], and if a file cannot be written.
pub fn run<const D: usize>(
    title: &str,
    file: &SceneFile,
    simulation: &mut Simulation<f64, D>,
    sensors: &Sensors<D>,
    folder: &Path,
) -> Result<Summary, Failure> {
    let walls: Vec<String> = simulation.walls().map(ToOwned::to_owned).collect();
    let mut columns: Vec<String> = ["time_s", "mass", "kinetic", "internal"]
        .map(Into::into)
        .into();
    columns.extend(AXES[..D].iter().map(|axis| format!("momentum_{axis}")));
    for wall in &walls {
        columns.extend(
            AXES[..D]
                .iter()
                .map(|axis| format!("force_on_{wall}_{axis}")),
        );
    }
    let unit = ["/m2", "/m", ""][D - 1];
    let comment = format!(
        "kg{unit}, J{unit}, kg m/s{unit}, N{unit}; mass, momentum and energies of all bodies"
    );
    let is_resumed = simulation.steps() > 0;
    let path = |name| free(folder, name, is_resumed);
    let mut history = CsvWriter::create_with_comment(path("history"), &comment, &columns)?;
    let mut readings = if sensors.is_empty() {
        None
    } else {
        Some(CsvWriter::create(path("probes"), &sensors.columns)?)
    };
    let output = &file.output;
    let mut run = Run::new(simulation, file.run.until)
        .label(title)
        .receipt(folder.join("receipt.json"))
        .observe(schedule(output.history.as_ref(), USUAL[0]), move |now| {
            let whole = now.ledger().whole;
            let mut row = vec![now.time(), whole.mass, whole.kinetic, whole.internal];
            row.extend(whole.momentum);
            for wall in &walls {
                row.extend(now.wall_force(wall.as_str())?);
            }
            Ok(history.row(&row)?)
        });
    if let Some(readings) = &mut readings {
        run = run.observe(schedule(output.probes.as_ref(), USUAL[1]), |now| {
            Ok(readings.row(&sensors.row(now)?)?)
        });
    }
    if let Some(own) = &output.paraview {
        run = run.paraview(schedule(Some(own), 1), folder.join("particles.pvd"));
    }
    // Last of all, so that what belongs to that time is written.
    if let Some(own) = &output.checkpoint {
        run = run.observe(schedule(Some(own), 2), |now| {
            Ok(now.save(folder.join(CHECKPOINT))?)
        });
    }
    for (_, stop) in stops(file) {
        run = run.stop(stop);
    }
    let summary = run.go()?;
    ParticleState::of(simulation).write_csv(folder.join("particles.csv"))?;
    Ok(summary)
}
