//! Runs a case and records it: probes, contact force, snapshots and the ledger, step by step.
//! Given a folder, everything is in its files as soon as it is known.

use super::cases::{Case, short};
use super::choices::IntegratorChoice;
use meshfree::effect::{Hypoelastic, Plasticity};
use meshfree::error::Result;
use meshfree::output::csv::{Cell, CsvWriter};
use meshfree::simulation::{Ledger, ParticleView, Simulation};
use std::path::Path;
use std::time::{Duration, Instant};

/// A particle at the time of a snapshot, in SI units; stress is positive in tension.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub body: usize,
    pub reference: f64,
    pub x: f64,
    pub stress: f64,
    pub velocity: f64,
    pub density: f64,
    pub energy: f64,
}

/// All particles at one time.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub time: f64,
    pub points: Vec<Point>,
}

/// History of a material point.
#[derive(Clone, Debug)]
pub struct Probe {
    pub x0: f64,
    pub stress: Vec<f64>,
    pub velocity: Vec<f64>,
}

/// What a run recorded. All histories share the times.
#[derive(Clone, Debug)]
pub struct Record {
    pub case: Case,
    pub time: Vec<f64>,
    pub probes: Vec<Probe>,
    /// Pressure in the contact of striker or pad and target, or wall \[Pa\].
    pub contact: Vec<f64>,
    pub snapshots: Vec<Snapshot>,
    /// Largest pressure of any particle at time zero \[Pa\].
    pub at_rest: f64,
    /// Largest change of momentum less the wall's impulse, relative to that of the impact.
    pub momentum_drift: f64,
    /// Largest change of total energy, relative to that of the impact.
    pub energy_drift: f64,
    pub particles: usize,
    pub steps: u64,
    pub guards: u64,
    /// Where rods yield: plastic work \[J\], and the largest plastic strain, of each at the end.
    pub plastic: Vec<(f64, f64)>,
    pub scheme: String,
    pub integrator: String,
    pub wall_time: Duration,
}

impl Record {
    /// The snapshot nearest to `time` \[s\].
    pub fn snapshot(&self, time: f64) -> Option<&Snapshot> {
        let apart = |shot: &&Snapshot| (shot.time - time).abs();
        self.snapshots
            .iter()
            .min_by(|a, b| apart(a).total_cmp(&apart(b)))
    }
}

/// Where a probe is among the particles: linear between two of one body, the last one beyond its end.
#[derive(Clone, Copy, Debug)]
struct Place {
    body: usize,
    left: usize,
    right: usize,
    weight: f64,
}

impl Place {
    fn find(case: &Case, references: &[Vec<f64>], x0: f64) -> Self {
        let ends = case.rods();
        let inside = ends.iter().position(|rod| x0 < rod.to - 1e-12);
        let body = inside.unwrap_or(ends.len() - 1);
        let x = &references[body];
        let right = x.partition_point(|&x| x <= x0).min(x.len() - 1);
        let left = right.saturating_sub(1);
        let span = (x[right] - x[left]).max(f64::MIN_POSITIVE);
        let weight = ((x0 - x[left]) / span).clamp(0.0, 1.0);
        Self {
            body,
            left,
            right,
            weight,
        }
    }

    /// Stress and velocity.
    fn read(&self, simulation: &Simulation<f64, 1>) -> Result<(f64, f64)> {
        let mut particles = simulation.body(self.body)?.skip(self.left);
        let state = |p: ParticleView<'_, f64, 1>| (stress(&p), p.velocity()[0]);
        let left = particles.next().map_or((0.0, 0.0), state);
        let right = match particles.next() {
            Some(particle) if self.right > self.left => state(particle),
            _ => left,
        };
        let mix = |a: f64, b: f64| if a == b { a } else { a + self.weight * (b - a) };
        Ok((mix(left.0, right.0), mix(left.1, right.1)))
    }
}

/// Stress along the rod \[Pa\], positive in tension.
fn stress(p: &ParticleView<'_, f64, 1>) -> f64 {
    let deviator = p.tensor(Hypoelastic::STRESS);
    let along = deviator.map_or(0.0, |stress| stress.components()[0]);
    along - p.pressure()
}

/// The open files of a run.
struct Files {
    history: CsvWriter,
    ledger: CsvWriter,
    row: Vec<f64>,
}

impl Files {
    fn create(folder: &Path, case: &Case) -> Result<Self> {
        let mut columns = vec!["time_s".to_string()];
        for x in &case.probes {
            let place = short(1e3 * x);
            columns.push(format!("stress_pa@{place}mm"));
            columns.push(format!("velocity_m_s@{place}mm"));
        }
        let rods = case.rods();
        let mut ledger = vec!["time_s".to_string()];
        for owner in rods.iter().map(|rod| rod.name).chain(["whole"]) {
            let quantities = [
                "mass_kg",
                "momentum_kg_m_s",
                "kinetic_j",
                "internal_j",
                "total_j",
            ];
            ledger.extend(quantities.map(|quantity| format!("{quantity}@{owner}")));
        }
        ledger.push("wall_impulse_n_s".into());
        Ok(Self {
            history: CsvWriter::create(folder.join("history.csv"), &columns)?,
            ledger: CsvWriter::create(folder.join("ledger.csv"), &ledger)?,
            row: Vec::new(),
        })
    }

    fn step(&mut self, record: &Record, ledger: &Ledger) -> Result<()> {
        self.row.clear();
        self.row.push(ledger.time);
        let last = |values: &Vec<f64>| values.last().copied().unwrap_or(0.0);
        for probe in &record.probes {
            self.row
                .extend([last(&probe.stress), last(&probe.velocity)]);
        }
        self.history.row(&self.row)?;
        self.row.clear();
        self.row.push(ledger.time);
        let budgets = ledger.bodies.iter().map(|(_, budget)| budget);
        for budget in budgets.chain([&ledger.whole]) {
            let momentum = budget.momentum.first().copied().unwrap_or(0.0);
            let energies = [budget.kinetic, budget.internal, budget.total_energy()];
            self.row.extend([budget.mass, momentum]);
            self.row.extend(energies);
        }
        self.row
            .push(ledger.boundary_impulse.first().copied().unwrap_or(0.0));
        self.ledger.row(&self.row)
    }
}

/// How closely a run is watched.
#[derive(Clone, Copy, Debug)]
pub enum Watch<'a> {
    /// Every step, into the files of this folder.
    Files(&'a Path),
    /// Every so many steps, in memory.
    Every(u64),
}

/// Runs a case. `progress` is told the time \[s\] now and then.
pub fn run(case: &Case, watch: Watch<'_>, progress: &mut dyn FnMut(f64)) -> Result<Record> {
    let started = Instant::now();
    let (folder, every) = match watch {
        Watch::Files(folder) => (Some(folder), 1),
        Watch::Every(steps) => (None, steps.max(1)),
    };
    let mut simulation = case.build()?;
    let mut files = folder
        .map(|folder| Files::create(folder, case))
        .transpose()?;
    let bodies = 0..simulation.bodies().count();
    let references: Vec<Vec<f64>> = bodies
        .map(|body| Ok(simulation.body(body)?.map(|p| p.position()[0]).collect()))
        .collect::<Result<_>>()?;
    let places: Vec<_> = case
        .probes
        .iter()
        .map(|&x0| Place::find(case, &references, x0))
        .collect();
    let probe = |&x0: &f64| Probe {
        x0,
        stress: Vec::new(),
        velocity: Vec::new(),
    };
    let mut record = Record {
        case: case.clone(),
        time: Vec::new(),
        probes: case.probes.iter().map(probe).collect(),
        contact: Vec::new(),
        snapshots: Vec::new(),
        at_rest: simulation
            .all()
            .map(|p| p.pressure().abs())
            .fold(0.0, f64::max),
        momentum_drift: 0.0,
        energy_drift: 0.0,
        particles: simulation.particles(),
        steps: 0,
        guards: 0,
        plastic: Vec::new(),
        scheme: simulation.scheme().to_string(),
        integrator: simulation.integrator_name(),
        wall_time: Duration::ZERO,
    };
    let first = simulation.ledger();
    // Only kick-drift-kick ends its step with the pressures of that time.
    let lags = case.integrator() != IntegratorChoice::KickDriftKick;
    let mut stops = case.snapshots.clone();
    stops.push(case.until);
    stops.sort_by(f64::total_cmp);
    let mut observe = |simulation: &Simulation<f64, 1>, record: &mut Record| -> Result<()> {
        let ledger = (files.is_some() || simulation.steps().is_multiple_of(100))
            .then(|| simulation.ledger());
        note(simulation, &places, record)?;
        if let Some(ledger) = &ledger {
            note_drift(&first, ledger, record);
            if let Some(files) = &mut files {
                files.step(record, ledger)?;
            }
            progress(simulation.time());
        }
        Ok(())
    };
    observe(&simulation, &mut record)?;
    let mut shots = Vec::new();
    for stop in stops {
        while stop - simulation.time() > 1e-12 * stop {
            simulation.step_until(stop)?;
            let stopped = stop - simulation.time() <= 1e-12 * stop;
            if stopped || simulation.steps().is_multiple_of(every) {
                if lags {
                    simulation.evaluate()?;
                }
                observe(&simulation, &mut record)?;
            }
        }
        if case.snapshots.contains(&stop) {
            let shot = take_snapshot(&simulation, &references, stop)?;
            if let Some(folder) = folder {
                write_snapshot(folder, case, &shot)?;
            }
            shots.push(shot);
        }
    }
    let last = simulation.ledger();
    note_drift(&first, &last, &mut record);
    for (body, (_, budget)) in last.bodies.iter().enumerate() {
        if let Some(work) = budget.total("plastic work") {
            let strains = simulation
                .body(body)?
                .filter_map(|p| p.scalar(Plasticity::STRAIN));
            record.plastic.push((work, strains.fold(0.0, f64::max)));
        }
    }
    record.snapshots = shots;
    record.steps = simulation.steps();
    record.guards = simulation.guard_counts().total();
    record.wall_time = started.elapsed();
    Ok(record)
}

fn note(simulation: &Simulation<f64, 1>, places: &[Place], record: &mut Record) -> Result<()> {
    record.time.push(simulation.time());
    for (probe, place) in record.probes.iter_mut().zip(places) {
        let (stress, velocity) = place.read(simulation)?;
        probe.stress.push(stress);
        probe.velocity.push(velocity);
    }
    let head = record.case.head();
    // The target is the body after the head; a wall comes after all bodies, which is the same index.
    let force = simulation.force_between(head, head + 1)?[0];
    record.contact.push(0.0 - force);
    Ok(())
}

fn note_drift(first: &Ledger, now: &Ledger, record: &mut Record) {
    let momentum = |ledger: &Ledger| {
        let wall = ledger.boundary_impulse.first().copied().unwrap_or(0.0);
        ledger.whole.momentum.first().copied().unwrap_or(0.0) - wall
    };
    let energy = |ledger: &Ledger| ledger.whole.total_energy();
    let drift = |of: &dyn Fn(&Ledger) -> f64| ((of(now) - of(first)) / of(first)).abs();
    record.momentum_drift = record.momentum_drift.max(drift(&momentum));
    record.energy_drift = record.energy_drift.max(drift(&energy));
}

fn take_snapshot(
    simulation: &Simulation<f64, 1>,
    references: &[Vec<f64>],
    time: f64,
) -> Result<Snapshot> {
    let mut points = Vec::with_capacity(simulation.particles());
    for (body, references) in references.iter().enumerate() {
        for (p, &reference) in simulation.body(body)?.zip(references) {
            points.push(Point {
                body,
                reference,
                x: p.position()[0],
                stress: stress(&p),
                velocity: p.velocity()[0],
                density: p.density(),
                energy: p.energy(),
            });
        }
    }
    Ok(Snapshot { time, points })
}

fn write_snapshot(folder: &Path, case: &Case, shot: &Snapshot) -> Result<()> {
    let name = format!("snapshot_{}us.csv", short(1e6 * shot.time));
    let columns = [
        "x_m",
        "reference_x_m",
        "stress_pa",
        "velocity_m_s",
        "density_kg_m3",
        "energy_j_kg",
        "body",
    ];
    let mut file = CsvWriter::create(folder.join(name), &columns)?;
    let rods = case.rods();
    for p in &shot.points {
        let numbers = [p.x, p.reference, p.stress, p.velocity, p.density, p.energy];
        let mut cells: Vec<Cell<'_>> = numbers.map(Cell::from).into();
        cells.push(rods[p.body].name.into());
        file.mixed_row(&cells)?;
    }
    Ok(())
}
