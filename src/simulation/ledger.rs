//! The ledger: mass, momentum and energy of every body, and the impulse that each block gave another.
//! Sums are in `f64` whatever the scalar.

use super::Simulation;
use super::group::Group;
use super::impulses::{Impulses, PairForces};
use super::joints::Jointing;
use super::population::BodyState;
use super::which::{Which, find};
use crate::collective::{Collective, over};
use crate::error::{Error, Problem, Result};
use crate::once::once;
use crate::particles::Field;
use crate::scalar::Real;
use std::borrow::Cow;

/// Mass, momentum and energy of a body, or of all.
#[derive(Clone, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Total {
    /// Its name, as `heat`.
    pub name: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// The sum.
    pub value: f64,
}

/// Momentum; and mass, kinetic and internal energy.
type Sums<const D: usize> = ([f64; D], [f64; 3]);

impl Budget {
    fn of<const D: usize>((momentum, [mass, kinetic, internal]): Sums<D>) -> Self {
        Self {
            mass,
            momentum: momentum.to_vec(),
            kinetic,
            internal,
            totals: Vec::new(),
        }
    }
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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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
    /// Momentum that the ground has given by [joints](crate::coupling::Joint) since the start \[kg m/s\]. What joints have worked is in the
    /// totals of the whole, with what their springs store, what dampers have taken and motors worked.
    pub joint_impulse: Vec<f64>,
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
    pub(super) fn law_index(&self, on: usize, k: usize) -> usize {
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
            let forces = columns.vectors(Field::FORCE);
            let bodies = group.particles.bodies.iter().zip(&group.indices);
            bodies.map(move |(body, &on)| {
                let (force, power) = over(body.slots.clone(), |slot| {
                    let force = forces[slot].map(Real::to_f64);
                    (force, group.work.power(columns, &force, slot, half))
                });
                (on, force, power)
            })
        })
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
            self.state.record_joints(dt);
        }
    }

    fn record_impulses(&mut self, alone: Option<usize>, dt: f64) {
        let mut impulses = core::mem::take(&mut self.state.impulses);
        let mut forces = core::mem::take(&mut self.pair_forces);
        self.add_forces(&mut impulses, &mut forces, alone, [0.5 * dt, dt]);
        (self.state.impulses, self.pair_forces) = (impulses, forces);
    }

    /// Adds what blocks and laws give in `dt` \[s\], laws with velocities `half` a kick \[s\] ahead.
    fn add_forces(
        &self,
        impulses: &mut Impulses,
        forces: &mut PairForces<D>,
        alone: Option<usize>,
        [half, dt]: [f64; 2],
    ) {
        let blocks = self.blocks();
        for (on, from, force) in self.reactions(alone) {
            forces.add(on * blocks + from, force);
        }
        if let Some(team) = self.team.as_ref().filter(|_| self.is_parted()) {
            forces.join(team);
        }
        impulses.add_sums(forces, dt);
        for (on, force, power) in self.given_by_laws(alone, half) {
            for (k, own) in force.into_iter().chain([power]).enumerate() {
                impulses.add(self.law_index(on, k), dt * own);
            }
        }
    }

    /// Tells the kept states of a group what list builds did to its particles, and the ledger what boundaries gave.
    pub(super) fn follow_moves(&mut self, number: usize) {
        let blocks = self.blocks();
        let state = &mut *self.state;
        let kept = &state.kept_impulses;
        let time_of = |slot: usize| kept.get(slot).map_or(0.0, |kept| kept.time);
        let group = &mut state.groups[number];
        let mut given = core::mem::take(&mut group.given);
        given.extend(group.work.follow(&mut group.particles.moved, time_of));
        let first_boundary = group.particles.bodies.len() + group.walls.len();
        let joins = core::mem::take(&mut group.joins_given);
        let team = self.team.as_ref().filter(|_| joins);
        if given.is_empty() && team.is_none() {
            return;
        }
        let kept = (0..state.kept_impulses.len()).map(Some);
        for of_state in core::iter::once(None).chain(kept) {
            let indices = &state.groups[number].indices;
            for (_, [body, boundary], impulse) in given.iter().filter(|own| own.0 == of_state) {
                let pair = indices[*body] * blocks + indices[first_boundary + boundary];
                self.pair_forces.add(pair, *impulse);
            }
            if let Some(team) = team {
                self.pair_forces.join(team);
            }
            let impulses = match of_state {
                None => &mut state.impulses,
                Some(slot) => &mut state.kept_impulses[slot],
            };
            impulses.add_sums(&mut self.pair_forces, 1.0);
        }
    }

    /// Tells a group of which a rank has its own particles the times of kept states, for a list build.
    pub(super) fn tell_times(&mut self, number: usize) {
        let state = &mut *self.state;
        let group = &mut state.groups[number];
        if group.all.is_some() {
            let times = state.kept_impulses.iter().map(|kept| kept.time);
            group.kept_times.clear();
            group.kept_times.extend(times);
        }
    }

    pub(super) fn impulse_rates(&self) -> Impulses {
        let mut rates = Impulses {
            time: 1.0,
            ..Impulses::default()
        };
        let mut forces = PairForces::default();
        self.add_forces(&mut rates, &mut forces, None, [0.0, 1.0]);
        rates
    }

    /// The present budget of a body; what it has in common with others is added to those of all.
    fn budget(group: &Group<T, D>, body: &BodyState<T>, whole: &mut Collective<Sums<D>>) -> Budget {
        let columns = &group.particles.columns;
        let [mass, energy] = [Field::MASS, Field::ENERGY].map(|field| columns.raw(field));
        let velocity = columns.vectors(Field::VELOCITY);
        let mut sums = Collective::new();
        sums.add_range(body.slots.clone(), |slot| {
            let (mass, v) = (mass[slot].to_f64(), velocity[slot].map(Real::to_f64));
            let speed2: f64 = v.iter().map(|v| v * v).sum();
            let energy = energy.get(slot).map_or(0.0, |energy| energy.to_f64());
            let momentum = v.map(|v| mass * v);
            (momentum, [mass, 0.5 * mass * speed2, mass * energy])
        });
        whole.join(&sums);
        let mut budget = Budget::of(sums.value());
        for own in &group.scheme.program.ledger {
            let values = columns.raw(own.field);
            let sum = over(body.slots.clone(), |slot| {
                let share = if own.times_mass {
                    mass[slot].to_f64()
                } else {
                    1.0
                };
                share * values[slot].to_f64()
            });
            budget.add_total(&Total {
                name: own.name,
                unit: own.unit,
                value: own.factor * sum,
            });
        }
        let mut bodies = group.particles.bodies.iter();
        let number = bodies.position(|other| core::ptr::eq(other, body));
        if let Some(value) = number.and_then(|number| group.work_apart(number)) {
            budget.add_total(&Total {
                name: "work of couplings",
                unit: "J",
                value,
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
        let mut sums = Collective::new();
        let mut bodies: Vec<_> = self
            .all_bodies()
            .map(|(group, body)| (body.name.clone(), Self::budget(group, body, &mut sums)))
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
                if !self.state.groups[group].sub_cycles() {
                    let total = of_couplings("work of couplings", work);
                    bodies[index].1.add_total(&total);
                }
            }
        }
        let mut whole = Budget::of(sums.value());
        for total in bodies.iter().flat_map(|(_, budget)| &budget.totals) {
            whole.add_total(total);
        }
        for couple in &self.state.couples {
            whole.add_total(&of_couplings("energy of couplings", couple.acting.stored));
            whole.add_total(&of_couplings("heat of couplings", couple.acting.heat));
        }
        if !self.state.joints.is_empty() {
            let sum = |of: fn(&Jointing<D>) -> f64| self.state.joints.all.iter().map(of).sum();
            whole.add_total(&of_couplings("work of joints", sum(|own| own.work)));
            whole.add_total(&of_couplings("energy of joints", sum(Jointing::stored)));
            whole.add_total(&of_couplings("heat of joints", sum(|own| own.heat)));
            whole.add_total(&of_couplings("work of motors", sum(|own| own.motor_work)));
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
            joint_impulse: self.state.joints.given_by_ground().to_vec(),
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
        let wall = self.body_count() + wall;
        self.force_of_blocks(|_, from| from == wall)
            .map(|force| 0.0 - force)
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
            [true, _] => Ok(self.force_of_blocks(|felt, by| (felt, by) == (on, from))),
            [false, true] => self.force_between(from, on).map(|force| force.map(|f| -f)),
            [false, false] => Err(Error::Argument(Problem::Incompatible {
                what: "walls and boundaries exert no forces on each other".into(),
                remedy: "name a body on one side, as in force_between(\"water\", \"tank\")",
            })),
        }
    }

    /// Whether a body feels another body, a wall or a boundary at the last evaluation.
    pub(super) fn feels_another(&self, on: usize) -> bool {
        let mut all = self.all_reactions();
        all.any(|(felt, exerted, by)| felt == on && exerted != on && by.iter().any(|f| *f != 0.0))
    }

    /// The sum of forces \[N\] between blocks, by scene indices: those that are felt, and those that exert them.
    fn force_of_blocks(&self, between: impl Fn(usize, usize) -> bool) -> [f64; D] {
        let mut sum = Collective::new();
        for (on, from, force) in self.all_reactions() {
            if between(on, from) {
                sum.add(force);
            }
        }
        sum.value()
    }

    /// Forces between blocks at the last evaluation, as [`reactions`](Self::reactions), of all groups.
    fn all_reactions(&self) -> impl Iterator<Item = (usize, usize, [f64; D])> {
        let groups = self.state.groups.iter().enumerate();
        let apart = groups.filter(|(_, group)| group.sub_cycles());
        let alone = apart.flat_map(|(group, _)| self.reactions(Some(group)));
        self.reactions(None).chain(alone)
    }
}
