//! Running a case: what is sampled on the way, and what is kept at 38 ms and at the end.
//! All coordinates are the tank's own: metres, origin at the inner corner, x towards the struck wall.

use super::common::Failure;
use super::elastic::{self, Stand, Watch};
use super::surface::{Occupancy, Space};
use super::tank::{Case, GRAVITY, WATER};
use meshfree::observe::PressureProbe;
use meshfree::output::csv::CsvWriter;
use meshfree::output::picture::Picture;
use meshfree::output::progress::Progress;
use meshfree::output::svg::Axis;
use meshfree::output::table::significant;
use meshfree::output::vtu::{Pvd, Vtu};
use meshfree::prelude::*;
use meshfree::simulation::ParticleView;
use std::path::Path;
use std::time::Instant;

/// When the paper shows the surface \[s\].
pub const SNAPSHOT: f64 = 0.038;
/// Time between samples \[s\].
const SAMPLING: f64 = 5e-5;
/// Time between readings of the ends \[s\].
const ENDS: f64 = 0.001;
/// Time between frames for ParaView \[s\].
const FRAMES: f64 = 0.002;
/// Width of the band before the far wall whose water is its film \[m\], whatever the spacing.
const FILM: f64 = 0.03;

/// What was measured at one time.
#[derive(Clone, Debug)]
pub struct Sample {
    pub time: f64,
    /// Pressure at each probe \[Pa\].
    pub pressures: Vec<f64>,
    /// Force on the wall behind the first probe over its area \[Pa\]; none where walls are finer than water, whose
    /// columns a sensor cannot count.
    pub contact: Option<f64>,
    /// Force of the water on the tank \[N\].
    pub force: [f64; 3],
}

/// The wall that the water leaves, at 38 ms.
#[derive(Clone, Copy, Debug, Default)]
pub struct FarWall {
    /// Highest water within a smoothing length of the wall \[m\].
    pub wetted: f64,
    /// Mass of water within 30 mm of the wall \[kg\].
    pub film: f64,
    /// Lowest pressure of the wall and of the water within a smoothing length of it \[Pa\].
    pub lowest: f64,
    /// Times that a particle's pressure was cut, or the density of cavitated water held, since the start.
    pub cuts: u64,
}

/// The water's push along the tank, in three measures.
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    /// When \[s\].
    pub time: f64,
    /// Pressures of sensors all over both ends, summed with their areas \[N\].
    pub sensed: f64,
    /// Force on the particles of both ends \[N\].
    pub felt: f64,
    /// Force on the whole tank \[N\]: bottom, lid and sides are rough by their particles.
    pub tank: f64,
}

/// A run.
#[derive(Clone, Debug, Default)]
pub struct Record {
    pub samples: Vec<Sample>,
    /// Points of the free surface in the plane of mid width at 38 ms.
    pub surface: Vec<[f64; 2]>,
    pub far_wall: FarWall,
    /// Impulse of the water on the tank \[N s\].
    pub impulse: [f64; 3],
    /// Momentum of the water and of elastic walls, the tank's frame being at rest or not \[N s\].
    pub momentum: [f64; 3],
    /// Difference of the momentum of water and what walls and gravity gave, over the impulse on the tank; with elastic
    /// walls that of both and what loads and clamps gave, over the loads'.
    pub imbalance: f64,
    /// What sensors all over the ends of the tank read, every millisecond, where requested.
    pub ends: Vec<Ends>,
    /// Space that the water takes against its volume, at 38 ms and at the end.
    pub space: [Space; 2],
    /// Particles more than a spacing behind the surface of the walls at the end.
    pub leaked: usize,
    /// Deepest that a particle was behind the surface of the walls \[m\]: drops that strike them alone
    /// dive before they bounce.
    pub deepest: f64,
    /// Particles of the water.
    pub particles: usize,
    /// Of elastic walls: how they stood, their particles and steps.
    pub walls: Vec<Stand>,
    pub wall_particles: usize,
    pub wall_steps: u64,
    pub steps: u64,
    pub seconds: f64,
}

impl Record {
    /// ∫ p dt \[Pa s\] of a quantity until `end` \[s\], by trapezoids.
    pub fn integral(&self, end: f64, of: impl Fn(&Sample) -> f64) -> f64 {
        let pairs = self
            .samples
            .windows(2)
            .filter(|pair| pair[1].time <= end * 1.000_001);
        pairs
            .map(|pair| 0.5 * (pair[1].time - pair[0].time) * (of(&pair[0]) + of(&pair[1])))
            .sum()
    }

    /// Impulse of the force behind the first probe over its area until `end` \[s\], where that was measured.
    pub fn contact_impulse(&self, end: f64) -> String {
        if self.samples.iter().any(|sample| sample.contact.is_none()) {
            return "not measured".into();
        }
        significant(self.integral(end, |s| s.contact.unwrap_or(0.0)), 4)
    }

    /// Impulse that the ends' sensors read until `end` \[s\] over another measure of it, less one.
    pub fn sensed_over(&self, end: f64, of: impl Fn(&Ends) -> f64) -> f64 {
        let until = || self.ends.iter().filter(|ends| ends.time <= end);
        until().map(|ends| ends.sensed).sum::<f64>() / until().map(of).sum::<f64>() - 1.0
    }
    /// Mean of a quantity over a span of time.
    pub fn mean(&self, [from, to]: [f64; 2], of: impl Fn(&Sample) -> f64) -> f64 {
        let inside = self
            .samples
            .windows(2)
            .filter(|p| p[0].time >= from && p[1].time <= to);
        let (mut sum, mut span) = (0.0, 0.0);
        for pair in inside {
            let dt = pair[1].time - pair[0].time;
            sum += 0.5 * dt * (of(&pair[0]) + of(&pair[1]));
            span += dt;
        }
        sum / span
    }
}

/// Runs a case; files are written if there is a folder, and sensors cover the ends of the tank if asked for.
pub fn run<T: Real>(case: &Case, folder: Option<&Path>, ends: bool) -> Result<Record, Failure> {
    let mut simulation = case.build::<T>()?;
    let sensors = case.sensors(&simulation)?;
    let cover = ends.then(|| cover(case, &simulation)).transpose()?;
    let elastic = case.youngs.map(|_| Watch::new(case, &simulation));
    let elastic = elastic.transpose()?;
    let mut files = folder
        .map(|folder| Files::create(case, folder))
        .transpose()?;
    let started = Instant::now();
    let mut record = Record {
        particles: simulation.body("water")?.count(),
        ..Record::default()
    };
    let water = case.mass() / WATER;
    let mut progress = Progress::new(case.scheme.as_str());
    let mut stops = vec![SNAPSHOT.min(case.until), case.until];
    stops.dedup();
    let (mut next, mut next_frame, mut next_ends) = (0.0, 0.0, ENDS);
    for stop in stops {
        let mut failed: Result<(), Error> = Ok(());
        let mut watch = |now: &Simulation<T, 3>| {
            let time = now.time();
            if let Some(cover) = cover.as_ref().filter(|_| time >= next_ends) {
                next_ends += ENDS;
                record.ends.push(ends_of(case, cover, now)?);
            }
            if time >= next || time >= case.until {
                next = time + SAMPLING;
                let sample = sample(case, now, &sensors)?;
                let stand = elastic.as_ref().map(|watch| watch.stand(case, now));
                let stand = stand.transpose()?;
                if let Some(files) = &mut files {
                    files.sample(&sample, stand.as_ref())?;
                    if time >= next_frame {
                        next_frame += FRAMES;
                        files.frame(case, elastic.as_ref(), now)?;
                    }
                }
                record.samples.push(sample);
                record.walls.extend(stand);
                let places = in_tank(case, now)?.map(|(x, _)| outside(case, &x));
                record.deepest = places.fold(record.deepest, f64::max);
                progress.update(
                    time / case.until,
                    format_args!("t = {:.2} ms, {} steps", 1e3 * time, now.steps()),
                );
            }
            Ok(())
        };
        simulation.run_with(stop, |now| {
            if failed.is_ok() {
                failed = watch(now);
            }
        })?;
        failed?;
        if stop == SNAPSHOT.min(case.until) {
            let occupied = Occupancy::of(case, &simulation)?;
            record.surface = occupied.mid_plane();
            record.space[0] = occupied.space(water);
            record.far_wall = far_wall(case, &simulation)?;
            if let Some(folder) = folder {
                snapshot(case, &simulation, &record.surface, folder)?;
                if let Some(watch) = &elastic {
                    watch.snapshot(case, &simulation, folder)?;
                }
            }
        }
    }
    progress.finish();
    record.space[1] = Occupancy::of(case, &simulation)?.space(water);
    record.seconds = started.elapsed().as_secs_f64();
    record.steps = simulation.steps();
    if elastic.is_some() {
        record.impulse = elastic::impulse(case, &simulation)?;
        record.imbalance = elastic::imbalance(case, &simulation)?;
        record.wall_particles = simulation.body("tank")?.count();
        record.wall_steps = simulation.sub_steps();
    } else {
        record.impulse = simulation.wall_impulse("tank")?;
    }
    let whole = simulation.ledger().whole;
    record.momentum = core::array::from_fn(|d| whole.momentum[d]);
    let gravity = [0.0, 0.0, -whole.mass * GRAVITY * simulation.time()];
    if !case.in_frame && elastic.is_none() {
        let size = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let lack = core::array::from_fn(|d| record.momentum[d] + record.impulse[d] - gravity[d]);
        record.imbalance = size(lack) / size(record.impulse);
    }
    record.leaked = in_tank(case, &simulation)?
        .filter(|(x, _)| outside(case, x) > case.spacing)
        .count();
    Ok(record)
}

fn sample<T: Real>(
    case: &Case,
    now: &Simulation<T, 3>,
    sensors: &[PressureProbe<3>],
) -> Result<Sample, Error> {
    Ok(Sample {
        time: now.time(),
        pressures: PressureProbe::pressures(sensors, now),
        contact: sensors
            .first()
            .filter(|_| elastic::shares_spacing(case))
            .map(|sensor| sensor.contact_pressure(now)),
        force: force(case, now)?,
    })
}

/// How far a place is outside of the tank \[m\], negative inside.
fn outside(case: &Case, x: &[f64; 3]) -> f64 {
    let beyond = (0..3).map(|d| (-x[d]).max(x[d] - case.size[d]));
    beyond.fold(f64::NEG_INFINITY, f64::max)
}

/// Force of the water on the tank \[N\].
fn force<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<[f64; 3], Error> {
    match case.youngs {
        Some(_) => now.force_between("tank", "water"),
        None => now.wall_force("tank"),
    }
}

/// Where the tank is, its velocity and its acceleration; at rest in its frame with elastic walls.
pub fn shift<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<[[f64; 3]; 3], Error> {
    match case.youngs {
        Some(_) => Ok([[0.0; 3]; 3]),
        None => Ok(now.wall_pose("tank")?.shift.map(Into::into)),
    }
}

/// Particles of the tank.
pub fn walls<'a, T: Real>(
    case: &Case,
    now: &'a Simulation<T, 3>,
) -> Result<impl Iterator<Item = ParticleView<'a, T, 3>> + 'a, Error> {
    match case.youngs {
        Some(_) => now.body("tank"),
        None => now.wall("tank"),
    }
}

/// Places in the tank \[m\] and pressures \[Pa\] of the water.
pub fn in_tank<'a, T: Real>(
    case: &Case,
    now: &'a Simulation<T, 3>,
) -> Result<impl Iterator<Item = ([f64; 3], f64)> + 'a, Error> {
    let shift = shift(case, now)?[0];
    Ok(now.body("water")?.map(move |particle| {
        let x = particle.position();
        (
            core::array::from_fn(|d| x[d] - shift[d]),
            particle.pressure(),
        )
    }))
}

/// Sensors all over both ends of the tank, with their areas, those of the far end negative.
fn cover<T: Real>(
    case: &Case,
    now: &Simulation<T, 3>,
) -> Result<(Vec<PressureProbe<3>>, Vec<f64>), Error> {
    let [length, width, height] = case.size;
    let counts = [width, height].map(|size| (size / case.spacing).round().max(1.0) as usize);
    let area = width * height / (counts[0] * counts[1]) as f64;
    let (mut sensors, mut outwards) = (Vec::new(), Vec::new());
    for k in 0..counts[0] * counts[1] {
        let place = [k % counts[0], k / counts[0]].map(|index| index as f64 + 0.5);
        let y = width * place[0] / counts[0] as f64;
        let z = height * place[1] / counts[1] as f64;
        for (x, sign) in [(0.0, -1.0), (length, 1.0)] {
            let normal = [-sign, 0.0, 0.0];
            let sensor = PressureProbe::disc(now, "end", [x, y, z], normal, case.spacing)?;
            sensors.push(match case.youngs {
                Some(_) => sensor,
                None => sensor.on_wall("tank")?,
            });
            outwards.push(sign * area);
        }
    }
    Ok((sensors, outwards))
}

/// The water's push along the tank now, with what [`cover`] gave.
fn ends_of<T: Real>(
    case: &Case,
    (sensors, outwards): &(Vec<PressureProbe<3>>, Vec<f64>),
    now: &Simulation<T, 3>,
) -> Result<Ends, Error> {
    let pressures = PressureProbe::pressures(sensors, now);
    let shift = shift(case, now)?[0][0];
    let forces = now.wall_particle_forces();
    let at_ends = forces
        .iter()
        .filter(|(x, _)| !(0.0..=case.size[0]).contains(&(x[0] - shift)));
    Ok(Ends {
        time: now.time(),
        sensed: pressures.iter().zip(outwards).map(|(p, a)| p * a).sum(),
        felt: at_ends.map(|(_, force)| force[0]).sum(),
        tank: force(case, now)?[0],
    })
}

fn far_wall<T: Real>(case: &Case, now: &Simulation<T, 3>) -> Result<FarWall, Error> {
    let h = now.smoothing_length();
    let mass = case.mass() / now.body("water")?.count() as f64;
    let mut found = FarWall {
        cuts: now.guard_counts().cut_off + now.limited("cavitation"),
        lowest: f64::INFINITY,
        ..FarWall::default()
    };
    for (x, pressure) in in_tank(case, now)? {
        if x[0] < h {
            found.wetted = found.wetted.max(x[2]);
            found.lowest = found.lowest.min(pressure);
        }
        if x[0] < FILM {
            found.film += mass;
        }
    }
    if case.youngs.is_some() {
        // A body shows its own pressure, not the water's.
        return Ok(found);
    }
    let shift = shift(case, now)?[0][0];
    let walls = now
        .wall("tank")?
        .filter(|particle| particle.position()[0] - shift < 0.0);
    found.lowest = walls.fold(found.lowest, |least, wall| least.min(wall.pressure()));
    Ok(found)
}

/// Surface, picture and particles at 38 ms.
fn snapshot<T: Real>(
    case: &Case,
    now: &Simulation<T, 3>,
    surface: &[[f64; 2]],
    folder: &Path,
) -> Result<(), Error> {
    let comment = format!("free surface at mid width, t = {:.3} ms", 1e3 * now.time());
    let path = folder.join("surface.csv");
    let mut file = CsvWriter::create_with_comment(path, &comment, &["x_m", "z_m"])?;
    file.rows(surface)?;
    let top = 1e-3 * 1000.0 * case.peak() * case.size[0] * case.fill;
    let picture = Picture::new(1200, 800)
        .title(&format!(
            "t = {:.1} ms, {} particles",
            1e3 * now.time(),
            now.body("water")?.count()
        ))
        .view(-70.0, 15.0)
        .particles(
            Axis::linear("pressure", "kPa").range(0.0, top.max(1.0)),
            case.spacing,
            in_tank(case, now)?.map(|(x, p)| (x, 1e-3 * p)),
        )
        .edges([0.0; 3], case.size);
    super::common::save_picture(&picture, folder.join("particles_38ms"))
}

/// The files that grow while a case runs.
struct Files {
    probes: CsvWriter,
    contact: Option<CsvWriter>,
    movie: Pvd,
    walls: Option<elastic::Files>,
}

impl Files {
    fn create(case: &Case, folder: &Path) -> Result<Self, Error> {
        let mut columns = vec!["time_s".to_string()];
        for [x, y, z] in &case.probes {
            columns.push(format!("pressure_pa@{x},{y},{z}"));
        }
        columns.extend(["x", "y", "z"].map(|axis| format!("force_{axis}_n")));
        let first = case.probes.first().copied().unwrap_or_default();
        let [x, y, z] = first;
        let contact = [
            "time_s".to_string(),
            format!("contact_pressure_pa@{x},{y},{z}"),
        ];
        Ok(Self {
            probes: CsvWriter::create(folder.join("probes.csv"), &columns)?,
            contact: elastic::shares_spacing(case)
                .then(|| CsvWriter::create(folder.join("contact.csv"), &contact))
                .transpose()?,
            movie: Pvd::create(folder.join("water.pvd"))?,
            walls: case
                .youngs
                .map(|_| elastic::Files::create(folder))
                .transpose()?,
        })
    }

    fn sample(&mut self, sample: &Sample, stand: Option<&Stand>) -> Result<(), Error> {
        if let (Some(walls), Some(stand)) = (&mut self.walls, stand) {
            walls.sample(stand)?;
        }
        let row: Vec<f64> = core::iter::once(sample.time)
            .chain(sample.pressures.iter().copied())
            .chain(sample.force)
            .collect();
        self.probes.row(&row)?;
        match (&mut self.contact, sample.contact) {
            (Some(file), Some(contact)) => file.row(&[sample.time, contact]),
            _ => Ok(()),
        }
    }

    fn frame<T: Real>(
        &mut self,
        case: &Case,
        watch: Option<&Watch>,
        now: &Simulation<T, 3>,
    ) -> Result<(), Error> {
        if let (Some(walls), Some(watch)) = (&mut self.walls, watch) {
            walls.frame(watch, now)?;
        }
        let velocity = shift(case, now)?[1];
        let relative = now.body("water")?.map(|particle| {
            let v = particle.velocity();
            core::array::from_fn::<f32, 3, _>(|d| (v[d] - velocity[d]) as f32)
        });
        let vtu = Vtu::new(in_tank(case, now)?.map(|(x, _)| x.map(|x| x as f32)))
            .scalar("pressure_pa", in_tank(case, now)?.map(|(_, p)| p as f32))
            .vector("velocity_in_tank_m_s", relative)
            .time(now.time());
        self.movie.frame(now.time(), &vtu).map(|_| ())
    }
}
