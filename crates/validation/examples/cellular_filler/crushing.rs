//! A run of the crush: the force of the plates, where their work goes, and what water leaves.
//! Forces of plates are summed step by step, as kicks have used them; their work is that of the clamps.

use super::common::Failure;
use super::crush::Crushed;
use meshfree::effect::Plasticity;
use meshfree::output::csv::CsvWriter;
use meshfree::output::progress::Progress;
use meshfree::output::vtu::Pvd;
use meshfree::prelude::*;
use std::collections::HashMap;
use std::path::Path;
use std::time::Instant;

/// Samples of a run to a strain of 30 %.
const SAMPLES: f64 = 150.0;
/// Frames for ParaView.
const FRAMES: usize = 12;
/// Strains at which sections are kept, in shares of the last.
pub const SECTIONS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
/// Strains of the secant moduli.
pub const SECANTS: [f64; 2] = [0.01, 0.02];
/// Density \[kg/m³\] of water at rest.
const WATER: f64 = 1000.0;

/// What was measured at one time. Stresses are means since the sample before, energies \[J\] are of half of the depth.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    pub time: f64,
    pub strain: f64,
    /// On the upper and the lower plate \[Pa\], and that part of the upper one which the water supports.
    pub stress: [f64; 3],
    /// Work of the upper plate.
    pub work: f64,
    pub plastic: f64,
    /// Elastic: of distortion and of compression of the polymer.
    pub elastic: f64,
    /// Kinetic, of structure and water.
    pub kinetic: [f64; 2],
    /// Of artificial viscosity in the polymer, and what its parts do not explain; hourglass control.
    pub viscous: f64,
    pub hourglass: f64,
    /// Stored in contacts, and lost there.
    pub contact: f64,
    /// Given to the water by plates and structure, stored in its compression, and dissipated in it.
    pub water: [f64; 3],
    /// Water beyond the end of the structure as built, and loss of void before it \[m³\].
    pub expelled: f64,
    pub crushed: f64,
    /// Of the water before it: what it is thinner and denser than at rest by its densities \[m³\].
    pub thinner: f64,
    pub denser: f64,
    /// Kinetic and internal energy of the solids, less the work of contacts on them.
    pub solids: f64,
}

/// A particle of a section: place in the plane, and a value; of one that is only shown the value is no number.
pub type Section = Vec<(f64, f64, f64)>;

/// A run.
#[derive(Clone, Debug, Default)]
pub struct Crushing {
    pub samples: Vec<Sample>,
    /// Structure, water and plates, by the pressure \[MPa\] of the water; structure and plates, by plastic strain; by
    /// [`SECTIONS`].
    pub sections: Vec<[Section; 2]>,
    pub relative_density: f64,
    pub particles: [usize; 2],
    pub steps: u64,
    pub seconds: f64,
    pub spacing: f64,
    /// Largest penetrations in spacings, by coupling and bodies.
    pub contacts: Vec<(String, f64, usize)>,
    pub limits: Vec<(&'static str, u64)>,
    /// Water particles at the end that are nearer than half a spacing to one of the structure, and beyond the plates.
    pub leaked: [usize; 2],
}

impl Crushing {
    /// Work of the upper plate \[J\], one cell's depth, at the end.
    pub fn energy(&self) -> f64 {
        self.samples.last().map_or(0.0, |last| 2.0 * last.work)
    }
    /// Stress \[Pa\] at a strain over that strain, mean of both plates, between the samples around it.
    pub fn secant(&self, strain: f64) -> f64 {
        let stress = |s: &Sample| 0.5 * (s.stress[0] + s.stress[1]);
        let pairs = self.samples.windows(2).map(|pair| (&pair[0], &pair[1]));
        let around = |(_, after): &(&Sample, &Sample)| after.strain >= strain;
        pairs
            .filter(|(before, _)| before.strain < strain)
            .find(around)
            .map_or(f64::NAN, |(before, after)| {
                let share = (strain - before.strain) / (after.strain - before.strain);
                (stress(before) + share * (stress(after) - stress(before))) / strain
            })
    }
    /// The most that what the water has dissipated has fallen since any time before, over the work on the water at the end:
    /// energy that it has gained from nothing.
    pub fn gained(&self) -> f64 {
        let (mut most, mut fallen) = (0.0_f64, 0.0_f64);
        for sample in &self.samples {
            most = most.max(sample.water[2]);
            fallen = fallen.max(most - sample.water[2]);
        }
        fallen / self.samples.last().map_or(f64::NAN, |last| last.water[0])
    }
    /// Mean stress \[Pa\] of the upper plate between strains of 10 and 20 %.
    pub fn plateau(&self) -> f64 {
        let on: Vec<f64> = (self.samples.iter())
            .filter(|s| (0.1..=0.2).contains(&s.strain))
            .map(|s| s.stress[0])
            .collect();
        on.iter().sum::<f64>() / on.len() as f64
    }
}

/// Kinetic energy of a body, energy of compression of its material, volume \[m³\] on this side of x, and by how much
/// that is more and less than it has at rest.
fn stored(
    simulation: &Simulation<f64, 3>,
    body: &str,
    material: &Material<f64>,
    end: f64,
    dx: f64,
) -> Result<[f64; 5], Error> {
    let eos = material.eos();
    let mut sums = [0.0; 5];
    for particle in simulation.body(body)? {
        let (mass, density) = (particle.mass(), particle.density());
        let v2: f64 = particle.velocity().iter().map(|v| v * v).sum();
        let within = ((end - particle.position()[0]) / dx + 0.5).clamp(0.0, 1.0);
        sums[0] += 0.5 * mass * v2;
        sums[1] += mass * eos.compression_energy(density);
        sums[2] += within * mass / density;
        let change = within * mass * (1.0 / density - 1.0 / material.reference_density());
        sums[3] += change.max(0.0);
        sums[4] += (-change).max(0.0);
    }
    Ok(sums)
}

/// Runs a case into a folder.
pub fn run(case: &Crushed, folder: &Path) -> Result<Crushing, Failure> {
    let mut simulation = case.build()?;
    simulation.evaluate()?;
    let started = Instant::now();
    let (dx, size) = (case.fitted(), case.size());
    let (polymer, liquid) = (Crushed::polymer(), case.water());
    let wet = liquid.is_some();
    let mut file = CsvWriter::create(
        folder.join("history.csv"),
        &[
            "time_s",
            "strain",
            "stress_pa",
            "stress_below_pa",
            "stress_of_water_pa",
            "work_j",
            "plastic_j",
            "elastic_j",
            "kinetic_structure_j",
            "kinetic_water_j",
            "viscous_structure_j",
            "hourglass_j",
            "contact_j",
            "work_on_water_j",
            "compression_water_j",
            "dissipated_water_j",
            "expelled_volume_m3",
            "crushed_void_m3",
            "thinner_m3",
            "denser_m3",
        ],
    )?;
    let mut movie = Pvd::create(folder.join("cells.pvd"))?;
    let mut record = Crushing {
        relative_density: case.cell().relative_density(),
        particles: [
            simulation.body("structure")?.count(),
            if wet {
                simulation.body("water")?.count()
            } else {
                0
            },
        ],
        spacing: dx,
        ..Crushing::default()
    };
    let solids = ["structure", "bottom", "top"];
    let take = |simulation: &Simulation<f64, 3>| -> Result<(Sample, f64), Failure> {
        let ledger = simulation.ledger();
        let mut sample = Sample::default();
        let (mut internal, mut coupled) = (0.0, [0.0; 2]);
        for (name, budget) in &ledger.bodies {
            if solids.contains(&name.as_str()) {
                let total = |name| budget.total(name).unwrap_or(0.0);
                // That of plates is prescribed.
                if name == solids[0] {
                    sample.kinetic[0] = budget.kinetic;
                }
                internal += budget.internal;
                sample.plastic += total("plastic work");
                sample.elastic += total("distortion");
                sample.hourglass += total("hourglass energy");
                coupled[0] += total("work of couplings");
            }
        }
        for contact in simulation.contacts() {
            coupled[1] += contact.stored + contact.heat;
        }
        let [_, compression, volume, ..] = stored(simulation, "structure", &polymer, size[0], dx)?;
        sample.elastic += compression;
        sample.viscous = internal - sample.plastic - sample.elastic - sample.hourglass;
        if let Some(liquid) = &liquid {
            let [kinetic, compression, volume, thinner, denser] =
                stored(simulation, "water", liquid, size[0], dx)?;
            sample.kinetic[1] = kinetic;
            sample.water[1] = compression;
            let mass: f64 = simulation.body("water")?.map(|p| p.mass()).sum();
            sample.expelled = mass / WATER - (volume - thinner + denser);
            [sample.thinner, sample.denser] = [thinner, denser];
        }
        // The plates give it by clamps, and the water.
        sample.solids = sample.kinetic[0] + internal - coupled[0];
        sample.contact = coupled[1];
        sample.time = simulation.time();
        [sample.strain, ..] = case.strain_at(simulation.time());
        // Of the clamps, less what the plate's own motion has.
        for clamp in simulation.clamps() {
            sample.work += clamp.work;
        }
        for (_, plate) in ledger.bodies.iter().filter(|(name, _)| name == "top") {
            sample.work -= plate.kinetic;
        }
        Ok((sample, volume))
    };
    let (first, solid) = take(&simulation)?;
    let zero = [
        first.solids,
        first.kinetic[1] + first.water[1],
        first.expelled,
    ];
    let force = |simulation: &Simulation<f64, 3>| -> [f64; 3] {
        let of = |on: &str, from: &str| simulation.force_between(on, from).map_or(0.0, |f| f[2]);
        let [above, below] = [of("top", "water"), of("bottom", "water")];
        [
            of("top", "structure") + above,
            -of("bottom", "structure") - below,
            above,
        ]
    };
    let mut before = (simulation.time(), force(&simulation));
    let end = case.end();
    let count = (SAMPLES * case.strain / 0.3).round().max(20.0) as usize;
    let mut progress = Progress::new(case.name());
    record
        .sections
        .push(section(&simulation, wet, (dx, size[1]))?);
    movie.frame(0.0, &simulation.vtu())?;
    for k in 1..=count {
        let time = end * k as f64 / count as f64;
        let mut impulse = [0.0; 3];
        let from = before.0;
        simulation.run_with(time, |now| {
            let (t, f) = (now.time(), force(now));
            for (d, own) in impulse.iter_mut().enumerate() {
                *own += 0.5 * (t - before.0) * (before.1[d] + f[d]);
            }
            before = (t, f);
            progress.update(t / end, format_args!("{:.1} µs", 1e6 * t));
        })?;
        let (mut sample, volume) = take(&simulation)?;
        sample.stress = impulse.map(|own| own / (before.0 - from) / case.area());
        sample.expelled -= zero[2];
        // What the solids have not kept of the work of the plates is the water's; without water that is rounding.
        sample.water[0] = sample.work - (sample.solids - zero[0]);
        sample.water[2] = sample.water[0] + zero[1] - sample.kinetic[1] - sample.water[1];
        sample.crushed = case.area() * size[2] * sample.strain - (solid - volume);
        file.row(&[
            sample.time,
            sample.strain,
            sample.stress[0],
            sample.stress[1],
            sample.stress[2],
            sample.work,
            sample.plastic,
            sample.elastic,
            sample.kinetic[0],
            sample.kinetic[1],
            sample.viscous,
            sample.hourglass,
            sample.contact,
            sample.water[0],
            sample.water[1],
            sample.water[2],
            sample.expelled,
            sample.crushed,
            sample.thinner,
            sample.denser,
        ])?;
        if k % count.div_ceil(FRAMES) == 0 || k == count {
            movie.frame(simulation.time(), &simulation.vtu())?;
        }
        if SECTIONS[1..]
            .iter()
            .any(|share| (share * count as f64).round() as usize == k)
        {
            record
                .sections
                .push(section(&simulation, wet, (dx, size[1]))?);
        }
        record.samples.push(sample);
    }
    progress.finish();
    record.contacts = (simulation.contacts().into_iter())
        .map(|own| (own.bodies.join(" and "), own.largest_penetration, own.pairs))
        .collect();
    record.limits = simulation.limits();
    if wet {
        record.leaked = leaked(
            &simulation,
            dx,
            [
                size[0],
                size[2] * (1.0 - case.strain_at(simulation.time())[0]),
            ],
        )?;
    }
    record.steps = simulation.steps();
    record.seconds = started.elapsed().as_secs_f64();
    Ok(record)
}

/// What is within a spacing of the middle of the cell, with the pressure of the water; and of the plane y = 0, which is the
/// middle of a wall, with the plastic strain of the structure.
fn section(
    simulation: &Simulation<f64, 3>,
    wet: bool,
    (dx, middle): (f64, f64),
) -> Result<[Section; 2], Error> {
    let at = |x: [f64; 3], value: f64| (1e3 * x[0], 1e3 * x[2], value);
    let mut sections = [Vec::new(), Vec::new()];
    let inner = |x: [f64; 3]| x[1] > middle - dx;
    if wet {
        let water = simulation.body("water")?;
        let water = water.filter(|p| inner(p.position()));
        sections[0].extend(water.map(|p| at(p.position(), 1e-6 * p.pressure())));
    }
    for body in ["structure", "bottom", "top"] {
        for particle in simulation.body(body)? {
            let x = particle.position();
            if inner(x) {
                sections[0].push(at(x, f64::NAN));
            }
            if x[1] < dx {
                let strain = match body {
                    "structure" => particle.scalar(Plasticity::STRAIN).unwrap_or(0.0),
                    _ => f64::NAN,
                };
                sections[1].push(at(x, strain));
            }
        }
    }
    Ok(sections)
}

/// Water particles that are in the structure, nearer than half a spacing to one of it, and beyond the plates.
fn leaked(
    simulation: &Simulation<f64, 3>,
    dx: f64,
    [length, height]: [f64; 2],
) -> Result<[usize; 2], Error> {
    let cell = |x: [f64; 3]| x.map(|x| (x / dx).floor() as i64);
    let mut there: HashMap<[i64; 3], Vec<[f64; 3]>> = HashMap::new();
    for particle in simulation.body("structure")? {
        let x = particle.position();
        there.entry(cell(x)).or_default().push(x);
    }
    let mut counts = [0; 2];
    for particle in simulation.body("water")? {
        let x = particle.position();
        let own = cell(x);
        let near = (0..27).any(|k| {
            let at = [k % 3, k / 3 % 3, k / 9].map(|by| by - 1);
            let at: [i64; 3] = core::array::from_fn(|d| own[d] + at[d]);
            let others = there.get(&at).into_iter().flatten();
            let square = |y: &[f64; 3]| (0..3).map(|d| (x[d] - y[d]).powi(2)).sum::<f64>();
            others.into_iter().any(|y| square(y) < 0.25 * dx * dx)
        });
        counts[0] += usize::from(near);
        counts[1] += usize::from(!(0.0..=height).contains(&x[2]) && x[0] < length);
    }
    Ok(counts)
}
