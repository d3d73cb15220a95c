//! The ledger: mass, momentum and energy of every body, and the impulse that each block gave another.
//! Sums run in the order of the particles, in `f64` whatever the scalar.

use super::Simulation;
use super::group::Group;
use super::population::BodyState;
use super::which::{Which, find};
use crate::error::{Error, Problem, Result};
use crate::once::once;
use crate::particles::Field;
use crate::scalar::Real;
use std::borrow::Cow;

/// Mass, momentum and energy of a body, or of all.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Budget {
    /// Mass \[kg\].
    pub mass: f64,
    /// Momentum \[kg m/s\], one component a dimension.
    pub momentum: Vec<f64>,
    /// Kinetic energy \[J\].
    pub kinetic: f64,
    /// Internal energy \[J\].
    pub internal: f64,
    /// What effects keep in the ledger ([`StepProgram::ledger`]), each once.
    ///
    /// [`StepProgram::ledger`]: crate::effect::StepProgram::ledger
    pub totals: Vec<Total>,
}

/// The sum over a body of what an effect keeps in the ledger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Total {
    /// Its name, as `heat`.
    pub name: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// The sum.
    pub value: f64,
}

impl Budget {
    /// What an effect keeps under a name; `None` if no effect of the body's scheme does.
    #[must_use]
    pub fn total(&self, name: &str) -> Option<f64> {
        let own = self.totals.iter().find(|total| total.name == name);
        own.map(|total| total.value)
    }
    /// Adds to the total with a name.
    fn add_total(&mut self, other: &Total) {
        match self.totals.iter_mut().find(|own| own.name == other.name) {
            Some(own) => own.value += other.value,
            None => self.totals.push(*other),
        }
    }
    /// Kinetic and internal energy \[J\].
    #[must_use]
    pub fn total_energy(&self) -> f64 {
        self.kinetic + self.internal
    }
}

/// The ledger at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Ledger {
    /// Time \[s\].
    pub time: f64,
    /// Every body, by name.
    pub bodies: Vec<(String, Budget)>,
    /// All bodies together.
    pub whole: Budget,
    /// Momentum that boundaries have given since the start \[kg m/s\].
    pub boundary_impulse: Vec<f64>,
    /// Momentum that forces of laws ([`Field::FORCE`]) have given since the start \[kg m/s\]; their work is in the totals of each
    /// body, as `work of laws`.
    pub law_impulse: Vec<f64>,
}

/// Momentum that blocks have given each other \[kg m/s\]: bodies first, then boundaries. Behind them, body by body, what forces of
/// laws have given, and their work \[J\].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Impulses {
    pub values: Vec<f64>,
    /// The time \[s\] of the state that they belong to; of rates it is one.
    pub time: f64,
}

impl Impulses {
    pub fn add(&mut self, index: usize, value: f64) {
        if self.values.len() <= index {
            self.values.resize(index + 1, 0.0);
        }
        self.values[index] += value;
    }
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.values.iter().copied()
    }
    pub fn get(&self, index: usize) -> f64 {
        self.values.get(index).copied().unwrap_or(0.0)
    }
    /// a · self + b · other + dt · rate.
    pub fn combine(&self, a: f64, other: &Self, b: f64, rate: &Self, dt: f64) -> Self {
        let length = self
            .values
            .len()
            .max(other.values.len())
            .max(rate.values.len());
        let sum = |k: usize| a * self.get(k) + b * other.get(k) + dt * rate.get(k);
        Self {
            values: (0..length).map(sum).collect(),
            time: a * self.time + b * other.time + dt * rate.time,
        }
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Bodies, walls and boundaries.
    fn blocks(&self) -> usize {
        self.body_count() + self.wall_count() + self.state.groups[0].boundaries.len()
    }

    pub(super) fn impulse_index(&self, on: usize, from: usize, d: usize) -> usize {
        (on * self.blocks() + from) * D + d
    }

    /// Where what laws have given a body stands: component `k` of the momentum, and the work behind them.
    fn law_index(&self, on: usize, k: usize) -> usize {
        self.body_count() * self.blocks() * D + on * (D + 1) + k
    }

    /// What laws give bodies with the forces of the last evaluation, by scene indices: the force \[N\], and the power \[W\] with
    /// velocities `half` a kick \[s\] ahead.
    pub(super) fn given_by_laws(
        &self,
        alone: Option<usize>,
        half: f64,
    ) -> impl Iterator<Item = (usize, [f64; D], f64)> {
        let groups = self
            .stepping(alone)
            .filter(|group| group.has_forces_of_laws());
        groups.flat_map(move |group| {
            let columns = &group.particles.columns;
            let [forces, v] = [Field::FORCE, Field::VELOCITY].map(|field| columns.vectors(field));
            let mass = columns.raw(Field::MASS);
            let bodies = group.particles.bodies.iter().zip(&group.indices);
            bodies.map(move |(body, &on)| {
                let (mut force, mut power) = ([0.0; D], 0.0);
                for slot in body.slots.clone() {
                    for d in 0..D {
                        let own = forces[slot][d].to_f64();
                        let a = group.work.acceleration(mass, slot * D + d).to_f64();
                        force[d] += own;
                        power += own * (v[slot][d].to_f64() + half * a);
                    }
                }
                (on, force, power)
            })
        })
    }

    /// Adds what laws give in `dt` \[s\] to impulses.
    fn add_laws(&self, impulses: &mut Impulses, alone: Option<usize>, half: f64, dt: f64) {
        for (on, force, power) in self.given_by_laws(alone, half) {
            for (k, own) in force.into_iter().chain([power]).enumerate() {
                impulses.add(self.law_index(on, k), dt * own);
            }
        }
    }

    /// What laws have worked since the start on the bodies of a group, or on all \[J\].
    pub(super) fn work_of_laws(&self, group: Option<usize>) -> f64 {
        let groups = self.state.groups.iter().enumerate();
        let groups = groups.filter(|(k, _)| group.is_none_or(|group| group == *k));
        let bodies = groups.flat_map(|(_, own)| &own.indices[..own.particles.bodies.len()]);
        let works = bodies.map(|&on| self.state.impulses.get(self.law_index(on, D)));
        works.sum()
    }

    /// Books a kick over `dt` \[s\]: of a group that sub-cycles alone, or of all others together.
    pub(super) fn record_kick(&mut self, alone: Option<usize>, dt: f64) {
        self.record_impulses(alone, dt);
        self.record_work(alone, dt);
        self.record_clamps(alone, dt);
        if alone.is_none() {
            self.record_couples(dt);
        }
    }

    fn record_impulses(&mut self, alone: Option<usize>, dt: f64) {
        let blocks = self.blocks();
        let mut impulses = core::mem::take(&mut self.state.impulses);
        for (on, from, force) in self.reactions(alone) {
            for (d, force) in force.iter().enumerate() {
                impulses.add((on * blocks + from) * D + d, dt * force);
            }
        }
        self.add_laws(&mut impulses, alone, 0.5 * dt, dt);
        self.state.impulses = impulses;
    }

    /// Tells the kept states of a group what list builds did to its particles, and the ledger what boundaries gave.
    pub(super) fn follow_moves(&mut self, number: usize) {
        let kept = &self.state.kept_impulses;
        let time_of = |slot: usize| kept.get(slot).map_or(0.0, |kept| kept.time);
        let group = &mut self.state.groups[number];
        let given = group.work.follow(&mut group.particles.moved, time_of);
        let first_boundary = group.particles.bodies.len() + group.walls.len();
        for (kept, [body, boundary], impulse) in given {
            let group = &self.state.groups[number];
            let on = group.indices[body];
            let from = group.indices[first_boundary + boundary];
            for (d, value) in impulse.into_iter().enumerate() {
                let index = self.impulse_index(on, from, d);
                match kept {
                    None => self.state.impulses.add(index, value),
                    Some(slot) => self.state.kept_impulses[slot].add(index, value),
                }
            }
        }
    }

    pub(super) fn impulse_rates(&self) -> Impulses {
        let mut rates = Impulses {
            time: 1.0,
            ..Impulses::default()
        };
        for (on, from, force) in self.reactions(None) {
            for (d, force) in force.iter().enumerate() {
                rates.add(self.impulse_index(on, from, d), *force);
            }
        }
        self.add_laws(&mut rates, None, 0.0, 1.0);
        rates
    }

    /// The present budget of a body.
    fn budget(group: &Group<T, D>, body: &BodyState<T>) -> Budget {
        let columns = &group.particles.columns;
        let mut budget = Budget {
            momentum: vec![0.0; D],
            ..Budget::default()
        };
        for slot in body.slots.clone() {
            let mass = columns.raw(Field::MASS)[slot].to_f64();
            budget.mass += mass;
            let mut speed2 = 0.0;
            for (d, v) in columns.vectors(Field::VELOCITY)[slot].iter().enumerate() {
                budget.momentum[d] += mass * v.to_f64();
                speed2 += v.to_f64() * v.to_f64();
            }
            budget.kinetic += 0.5 * mass * speed2;
            let energy = columns
                .raw(Field::ENERGY)
                .get(slot)
                .map_or(0.0, |e| e.to_f64());
            budget.internal += mass * energy;
        }
        for own in &group.scheme.program.ledger {
            let (values, mass) = (columns.raw(own.field), columns.raw(Field::MASS));
            let sum = body.slots.clone().fold(0.0, |sum, slot| {
                let share = if own.times_mass {
                    mass[slot].to_f64()
                } else {
                    1.0
                };
                sum + share * values[slot].to_f64()
            });
            budget.add_total(&Total {
                name: own.name,
                unit: own.unit,
                value: own.factor * sum,
            });
        }
        if let Some(apart) = &group.sub_cycle {
            let mut bodies = group.particles.bodies.iter().zip(&apart.work);
            let own = bodies.find(|(other, _)| core::ptr::eq(*other, body));
            budget.add_total(&Total {
                name: "work of couplings",
                unit: "J",
                value: own.map_or(0.0, |(_, work)| *work),
            });
        }
        budget
    }

    /// Mass, momentum and energy now, body by body and together.
    #[must_use]
    pub fn ledger(&self) -> Ledger {
        once!(self => &Simulation, |own| -> Ledger { own.sum_up() })
    }

    fn sum_up(&self) -> Ledger {
        let mut bodies: Vec<_> = self
            .all_bodies()
            .map(|(group, body)| (body.name.clone(), Self::budget(group, body)))
            .collect();
        for (on, (group, _)) in self.all_bodies().enumerate() {
            if group.has_forces_of_laws() {
                let value = self.state.impulses.get(self.law_index(on, D));
                let name = "work of laws";
                bodies[on].1.add_total(&Total {
                    name,
                    unit: "J",
                    value,
                });
            }
        }
        let of_couplings = |name, value| Total {
            name,
            unit: "J",
            value,
        };
        for couple in &self.state.couples {
            for (side, (index, work)) in
                (couple.sides.iter()).zip(couple.indices.into_iter().zip(couple.work))
            {
                let Some((group, _)) = side.body() else {
                    continue;
                };
                // A group that sub-cycles has the work of all of its couplings.
                if self.state.groups[group].sub_cycle.is_none() {
                    let total = of_couplings("work of couplings", work);
                    bodies[index].1.add_total(&total);
                }
            }
        }
        let mut whole = Budget {
            momentum: vec![0.0; D],
            ..Budget::default()
        };
        for (_, budget) in &bodies {
            whole.mass += budget.mass;
            whole.kinetic += budget.kinetic;
            whole.internal += budget.internal;
            for total in &budget.totals {
                whole.add_total(total);
            }
            for d in 0..D {
                whole.momentum[d] += budget.momentum[d];
            }
        }
        for couple in &self.state.couples {
            whole.add_total(&of_couplings("energy of couplings", couple.acting.stored));
            whole.add_total(&of_couplings("heat of couplings", couple.acting.heat));
        }
        let count = bodies.len();
        let boundaries = count + self.wall_count()..self.blocks();
        let boundary_impulse = (0..D)
            .map(|d| {
                (0..count)
                    .flat_map(|on| boundaries.clone().map(move |from| (on, from)))
                    .map(|(on, from)| self.state.impulses.get(self.impulse_index(on, from, d)))
                    .sum()
            })
            .collect();
        let of_law = |on: usize, d: usize| self.state.impulses.get(self.law_index(on, d));
        let law_impulse = (0..D).map(|d| (0..count).map(|on| of_law(on, d)).sum());
        Ledger {
            time: self.state.time,
            bodies,
            whole,
            boundary_impulse,
            law_impulse: law_impulse.collect(),
        }
    }

    /// The momentum \[kg m/s\] that bodies have given a wall since the start.
    ///
    /// # Errors
    /// If there is no such wall; the error lists those that there are.
    pub fn wall_impulse(&self, wall: impl Which) -> Result<[f64; D]> {
        let (wall, _) = self.wall_of(&wall)?;
        let bodies = self.body_count();
        Ok(core::array::from_fn(|d| {
            (0..bodies)
                .map(|on| {
                    -self
                        .state
                        .impulses
                        .get(self.impulse_index(on, bodies + wall, d))
                })
                .sum()
        }))
    }

    /// The force \[N\] that bodies exert on a wall at the last evaluation.
    ///
    /// # Errors
    /// If there is no such wall; the error lists those that there are.
    pub fn wall_force(&self, wall: impl Which) -> Result<[f64; D]> {
        let (wall, _) = self.wall_of(&wall)?;
        Ok(self.force_on_wall(wall))
    }

    /// The same of the wall with an index that there is.
    pub(super) fn force_on_wall(&self, wall: usize) -> [f64; D] {
        let bodies = self.body_count();
        (0..bodies).fold([0.0; D], |mut sum, on| {
            let force = self.force_of_block(on, bodies + wall);
            for d in 0..D {
                sum[d] -= force[d];
            }
            sum
        })
    }

    /// The force \[N\] that body, wall or boundary `from` exerts on body `on` at the last evaluation. Indices count
    /// bodies in the order of the scene, then walls, then boundaries. A structure, which is a wall to the liquids of a
    /// scene, is the body that it is. What a wall or a boundary feels is what the body exerts: the opposite of what that
    /// feels.
    ///
    /// By images across a [period](crate::boundary::Periodic), or behind a plane of symmetry, bodies feel each other. A force f by
    /// the image of another body counts with (f + R f)/2 as that body's and with the rest as the boundary's, R being the
    /// rotation of the image: all is the body's across a period, and what lies along the plane behind a plane. A body
    /// feels its own images as the boundary, and those of a wall as the wall.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .body(Body::block("target", catalogue::copper(), [0.01], [0.05], 2e-4))
    ///     .build()?;
    /// simulation.run_until(1e-6)?;
    /// let (on, back) = (
    ///     simulation.force_between("target", "striker")?,
    ///     simulation.force_between("striker", "target")?,
    /// );
    /// assert!(on[0] > 0.0 && (on[0] + back[0]).abs() < 1e-12 * on[0]);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// If there is no such body, wall or boundary; the error lists those that there are. If neither is a body: walls and boundaries do
    /// not feel each other.
    pub fn force_between(&self, on: impl Which, from: impl Which) -> Result<[f64; D]> {
        let named = self.bodies().chain(self.walls()).map(Cow::Borrowed);
        let boundaries = self.state.groups[0].boundaries.iter();
        let boundaries = boundaries.map(|boundary| Cow::Owned(boundary.name()));
        let blocks = || {
            named
                .clone()
                .chain(boundaries.clone())
                .map(|name| (name, ()))
        };
        let kind = "body, wall or boundary";
        let (on, ()) = find(&on, kind, blocks())?;
        let (from, ()) = find(&from, kind, blocks())?;
        match [on, from].map(|block| block < self.body_count()) {
            [true, _] => Ok(self.force_of_block(on, from)),
            [false, true] => Ok(self.force_of_block(from, on).map(|force| -force)),
            [false, false] => Err(Error::Argument(Problem::Incompatible {
                what: "a force between two walls or boundaries is asked for, which do not feel each other".into(),
                remedy: "name a body on one side, as in force_between(\"water\", \"tank\")",
            })),
        }
    }

    /// Whether a body feels another body, a wall or a boundary at the last evaluation.
    pub(super) fn feels_another(&self, on: usize) -> bool {
        let apart =
            (0..self.state.groups.len()).filter(|&k| self.state.groups[k].sub_cycle.is_some());
        let alone = apart.flat_map(|group| self.reactions(Some(group)));
        let mut all = self.reactions(None).chain(alone);
        all.any(|(felt, exerted, by)| felt == on && exerted != on && by.iter().any(|f| *f != 0.0))
    }

    /// The force \[N\] of a block on another, by scene indices.
    fn force_of_block(&self, on: usize, from: usize) -> [f64; D] {
        let mut force = [0.0; D];
        let apart =
            (0..self.state.groups.len()).filter(|&k| self.state.groups[k].sub_cycle.is_some());
        let alone = apart.flat_map(|group| self.reactions(Some(group)));
        for (felt, exerted, by) in self.reactions(None).chain(alone) {
            if (felt, exerted) == (on, from) {
                for d in 0..D {
                    force[d] += by[d];
                }
            }
        }
        force
    }
}
