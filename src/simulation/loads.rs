//! Loads, uniform and of each particle: what they add to the rates of an evaluation, to heat, and to the ledger.
//! Their values stay in columns, which list builds, checkpoints and evaluations between steps treat as all others.

use super::Simulation;
use super::event::Happened;
use super::load::{Load, LoadPoint, Named};
use super::population::Particles;
use crate::collective::{Collective, over_pieces};
use crate::error::{Error, Result};
use crate::parallel::{GRAIN, cut};
use crate::particles::{Columns, Field, Output};
use crate::scalar::Real;
use crate::sweep::Results;

/// When loads are evaluated \[s\], what has happened by then, and where particles were as built \[m\] by identity.
type Now<'a, const D: usize> = (f64, &'a Happened, &'a [Option<[f64; D]>]);

/// A value of a load that is no number to go on with.
struct Wrong<'a, const D: usize> {
    load: &'a Load<D>,
    value: f64,
    slot: usize,
}

/// What an acceleration of all particles must be.
pub(crate) const ACCELERATION: &str =
    "it must be finite, and its square finite in the scalar type, in m/s²";

/// Whether the square of a number is finite in the scalar.
pub(crate) fn is_square_finite<T: Real>(value: f64) -> bool {
    T::from_f64(value * value).to_f64().is_finite()
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// What the uniform loads give at `time` \[s\].
    pub(super) fn body_acceleration(&self, time: f64) -> [f64; D] {
        let mut sum = [0.0; D];
        for acceleration in &self.accelerations {
            let a = acceleration(time);
            for d in 0..D {
                sum[d] += a[d];
            }
        }
        sum
    }

    /// The same, refused where it is no number.
    pub(super) fn uniform_loads(&self, time: f64) -> Result<[f64; D]> {
        let gravity = self.body_acceleration(time);
        match gravity.into_iter().find(|a| !is_square_finite::<T>(*a)) {
            None => Ok(gravity),
            Some(value) => Err(Error::Function {
                what: "acceleration of the scene (Scene::acceleration)".into(),
                value,
                time,
                must_be: ACCELERATION,
            }),
        }
    }

    /// Adds what loads give a group at `time` \[s\] to the rates of an evaluation.
    pub(super) fn apply_loads(&mut self, group: usize, time: f64) -> Result<()> {
        let built = self.built.get(group).map_or(&[][..], Vec::as_slice);
        let state = &mut *self.state;
        let group = &mut state.groups[group];
        let particles = &mut group.particles;
        let Some(Wrong { load, value, slot }) = apply_loads(
            particles,
            &mut group.work.rates,
            &self.loads,
            (time, &state.happened, built),
        ) else {
            return Ok(());
        };
        let body = &particles.bodies[particles.body_of(slot)];
        Err(Error::Load {
            load: load.to_string(),
            value,
            body: body.name.clone(),
            particle: particles.ids[slot] as usize - body.ids.start,
            position: particles.position(slot).to_vec(),
            time,
        })
    }

    /// What loads give in a kick over `dt` \[s\]: momentum \[kg m/s\] and work \[J\], each particle with its velocity in the
    /// middle of the kick; of a group that sub-cycles alone, or of all others together.
    pub(super) fn kick_of_loads(&self, alone: Option<usize>, dt: f64) -> ([f64; D], f64) {
        let mut all = Collective::new();
        for (group, body) in self.bodies_that_step(alone) {
            let columns = &group.particles.columns;
            let masses = columns.raw(Field::MASS);
            let loads = columns.vectors(Field::LOAD_ACCELERATION);
            if loads.is_empty() {
                continue;
            }
            all.add_range(body.slots.clone(), |slot| {
                let give = dt * masses[slot].to_f64();
                let given = loads[slot].map(|a| give * a.to_f64());
                (given, group.work.power(columns, &given, slot, 0.5 * dt))
            });
        }
        all.value()
    }
}

/// Evaluates loads at `time` \[s\], and adds them to forces and powers; the first value that is wrong, if there is one.
fn apply_loads<'a, T: Real, const D: usize>(
    particles: &mut Particles<T, D>,
    rates: &mut Results<T, D>,
    loads: &'a [Load<D>],
    now: Now<'_, D>,
) -> Option<Wrong<'a, D>> {
    for (field, sum) in [
        (Field::LOAD_ACCELERATION, Output::FORCE),
        (Field::LOAD_HEATING, Output::POWER),
    ] {
        if particles.columns.raw(field).is_empty() {
            continue;
        }
        let mut values = core::mem::take(particles.columns.column_mut(field));
        values.fill(T::zero());
        let mut own = loads.iter().filter(|load| load.field() == field);
        let wrong = own.find_map(|load| evaluate_load(particles, load, now, &mut values));
        *particles.columns.column_mut(field) = values;
        if wrong.is_some() {
            return wrong;
        }
        let columns = &particles.columns;
        let (mass, values) = (columns.raw(Field::MASS), columns.raw(field));
        rates.add_all(sum, Some(mass), values);
    }
    None
}

/// Adds what a load gives the particles of its bodies to the values of its field.
fn evaluate_load<'a, T: Real, const D: usize>(
    particles: &Particles<T, D>,
    load: &'a Load<D>,
    (time, happened, built): Now<'_, D>,
    values: &mut [T],
) -> Option<Wrong<'a, D>> {
    let width = load.field().components(D);
    let columns = &particles.columns;
    let (velocities, densities) = (
        columns.vectors(Field::VELOCITY),
        columns.raw(Field::DENSITY),
    );
    let fields = Named(columns, load.reads());
    let bodies = particles.bodies.iter();
    for body in bodies.filter(|body| load.acts_on(&body.name) && !body.slots.is_empty()) {
        let run = body.run();
        let live = body.slots.len() * width;
        let (own, repeats) = values[run.start * width..run.end * width].split_at_mut(live);
        let add = |(slot, sum): (usize, &mut [T])| {
            let identity = particles.ids[slot] as usize;
            let at = LoadPoint {
                particle: identity - body.ids.start,
                position: particles.position(slot),
                as_built: built.get(identity).copied().flatten(),
                velocity: velocities[slot].map(Real::to_f64),
                density: densities[slot].to_f64(),
                time,
                body: &body.name,
                happened,
                fields: &fields,
                slot,
            };
            load.add(&at, sum).map(|value| (slot, value))
        };
        let first_wrong = |piece: usize, sums: &mut [T]| {
            let mut sums = (run.start + piece * GRAIN..).zip(sums.chunks_exact_mut(width));
            sums.find_map(add)
        };
        if let Some((slot, value)) = over_pieces(cut(own, GRAIN * width), first_wrong) {
            return Some(Wrong { load, value, slot });
        }
        // What repeats the last particle goes where that goes.
        for repeat in repeats.chunks_mut(width) {
            repeat.copy_from_slice(&own[live - width..]);
        }
    }
    None
}

/// e ← e + dt q with the heat that laws and loads gave in the last evaluation, where energy changes by the work of pairs.
pub(super) fn heat_by_sources<T: Real, const D: usize>(
    columns: &mut Columns<T, D>,
    of_laws: &[Field],
    dt: f64,
) {
    let dt = T::from_f64(dt);
    for field in of_laws.iter().chain([&Field::LOAD_HEATING]) {
        let [energy, heating] = columns.many_mut([Field::ENERGY, *field]);
        for (energy, heating) in energy.iter_mut().zip(heating) {
            *energy += dt * *heating;
        }
    }
}
