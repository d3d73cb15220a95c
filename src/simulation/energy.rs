//! The energy ledger of liquids: what loads and walls did, where it is, and what was dissipated.
//! Kept on request, because summing momentum in every kick is not free.

use super::Simulation;
use super::contact::Couple;
use super::side::Side;
use crate::collective::{Collective, over};
use crate::particles::{Columns, Field};
use crate::scalar::Real;
use crate::tensor::length;

/// Energies \[J\] of a liquid, and the work done on it since the start.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct EnergyLedger {
    /// Kinetic energy now.
    pub kinetic: f64,
    /// Energy stored in compression now, Σ m ∫ p/ρ² dρ from the density at rest.
    pub compression: f64,
    /// Work of the loads (gravity, the frame, those that depend on the particle) since the start.
    pub load_work: f64,
    /// Work of the walls since the start.
    pub wall_work: f64,
    /// Work of the forces that [laws](crate::effect::Law) give particles ([`Field::FORCE`]) since the start. Of a force that stores
    /// energy, as surface tension does, it is what that has released.
    pub law_work: f64,
    /// Work of [joints](crate::coupling::Joint) of rigid bodies on these since the start: of motors, less what dampers took and springs store.
    pub joint_work: f64,
    /// Kinetic energy that [entered](Simulation::entered) through inlets and sources since the scene was built.
    pub entered: f64,
    /// Kinetic energy that [left](Simulation::removed) through outlets and drains since then.
    pub left: f64,
    /// What viscosities, diffusion, shifting and the steps have taken: the work done less the gain in
    /// energy. Physical and numerical dissipation are not distinguished.
    pub dissipated: f64,
}

/// The running sums behind an [`EnergyLedger`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    /// Energies at the start, with the kinetic energy that had left by then, less what had entered \[J\].
    pub start: f64,
    pub load: f64,
    pub wall: f64,
    /// What laws and joints had worked \[J\].
    pub laws: f64,
    pub joints: f64,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Starts to keep the energy ledger, from the present state on. It costs a sum over particles in
    /// every kick, and with walls that turn or deform a sweep over them.
    pub fn keep_energy(&mut self) {
        self.on_both(&|own| {
            let groups = own.state.groups.len();
            own.state.stores.forget(groups);
            let (kinetic, compression) = own.stored();
            let passed = own.removed().kinetic - own.entered().kinetic;
            own.state.work = Some(Work {
                start: kinetic + compression + passed,
                laws: own.work_of_laws(None),
                joints: own.state.joints.work(),
                ..Work::default()
            });
        });
    }

    /// The energy ledger, or `None` if it was not [kept](Simulation::keep_energy).
    #[must_use]
    pub fn energy(&self) -> Option<EnergyLedger> {
        let work = self.state.work?;
        let (kinetic, compression) = self.stored();
        let (entered, left) = (self.entered().kinetic, self.removed().kinetic);
        let laws = self.work_of_laws(None) - work.laws;
        let joints = self.state.joints.work() - work.joints;
        let supplied = work.start + work.load + work.wall + laws + joints + entered;
        Some(EnergyLedger {
            kinetic,
            compression,
            load_work: work.load,
            wall_work: work.wall,
            law_work: laws,
            joint_work: joints,
            entered,
            left,
            dissipated: supplied - kinetic - compression - left,
        })
    }

    /// Kinetic energy \[J\] of all bodies: that of the [ledger](Self::ledger), for less.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let rod = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// assert_eq!(rod.kinetic_energy(), rod.ledger().whole.kinetic);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        let mut all = Collective::new();
        for (group, body) in self.all_bodies() {
            let columns = &group.particles.columns;
            all.add_range(body.slots.clone(), |slot| kinetic(columns, slot));
        }
        all.value()
    }

    /// Kinetic energy, and energy stored in compression.
    pub(super) fn stored(&self) -> (f64, f64) {
        let mut all = Collective::new();
        for (group, body) in self.all_bodies() {
            let columns = &group.particles.columns;
            let (mass, density) = (columns.raw(Field::MASS), columns.raw(Field::DENSITY));
            all.add_range(body.slots.clone(), |slot| {
                let eos = body.material.eos();
                let compression = eos.compression_energy(density[slot].to_f64());
                (kinetic(columns, slot), mass[slot].to_f64() * compression)
            });
        }
        all.value()
    }

    /// Adds the work of a kick over `dt` \[s\], with the velocities at its middle: of a group that sub-cycles alone, or of
    /// all others together.
    pub(super) fn record_work(&mut self, alone: Option<usize>, dt: f64) {
        if self.state.work.is_none() {
            return;
        }
        let mut all = Collective::new();
        for (group, body) in self.bodies_that_step(alone) {
            let columns = &group.particles.columns;
            let (mass, v) = (columns.raw(Field::MASS), columns.vectors(Field::VELOCITY));
            all.add_range(body.slots.clone(), |slot| {
                let mass = mass[slot].to_f64();
                (v[slot].map(|v| mass * v.to_f64()), mass)
            });
        }
        // Half of what the kick will add: pair forces between bodies cancel, walls and loads remain.
        let mut add_half = |given: [f64; D], dt: f64| all.add((given.map(|p| 0.5 * dt * p), 0.0));
        let bodies = self.body_count();
        let reactions = self.reactions(alone);
        for (_, _, force) in reactions.filter(|(_, from, _)| *from >= bodies) {
            add_half(force, dt);
        }
        for (_, force, _) in self.given_by_laws(alone, 0.0) {
            add_half(force, dt);
        }
        if alone.is_none() {
            add_half(self.state.forces_of_ground(), dt);
        }
        let mut load = 0.0;
        if !self.loads.is_empty() {
            let (given, work) = self.kick_of_loads(alone, dt);
            load += work;
            add_half(given, 1.0);
        }
        let (mut momentum, mass) = all.value();
        let first = self
            .state
            .groups
            .iter()
            .position(|group| !group.sub_cycles());
        let gravity = self.state.groups[alone.or(first).unwrap_or(0)].gravity;
        for d in 0..D {
            momentum[d] += 0.5 * dt * mass * gravity[d];
            load += dt * gravity[d] * momentum[d];
        }
        // Walls move liquids, which do not sub-cycle.
        let wall = alone.map_or_else(|| dt * self.wall_power(), |_| 0.0);
        if let Some(work) = &mut self.state.work {
            work.load += load;
            work.wall += wall;
        }
    }

    /// Power \[W\] of walls on solids by contact: of all that they move by, or of sliding alone.
    fn contact_power(&self, whole: bool) -> f64 {
        let of = |couple: &Couple<T, D>| {
            let Side::Wall(wall) = &couple.sides[1] else {
                return 0.0;
            };
            if whole {
                return couple.power_of_wall(wall);
            }
            let forces = &couple.acting.forces[1];
            -over(0..forces.len(), |k| power(&forces[k].1, &wall.sliding))
        };
        self.state.couples.iter().map(of).sum()
    }

    /// Power \[W\] of the walls on the bodies with the forces at hand.
    fn wall_power(&self) -> f64 {
        let moving = || {
            let walls = (0..self.wall_count()).filter_map(|k| Some((k, self.find_wall(k)?.1)));
            walls.filter_map(|(k, wall)| wall.motion.as_ref().map(|motion| (k, motion)))
        };
        let mut walls = self.state.groups.iter().flat_map(|group| &group.walls);
        let flows = walls.any(|wall| wall.inflow.is_some());
        if moving().next().is_none() && !flows {
            return self.contact_power(false);
        }
        // Kicks begin and end a step; the pose of the last evaluation is that of the forces.
        let time = self.state.evaluated;
        let rigid = moving().all(|(_, motion)| {
            let turning = motion.pose(time).linear[1];
            (0..D).all(|d| length(&turning.column(d).into_owned()) == 0.0)
        });
        if rigid && !flows {
            let carried = moving().map(|(k, motion)| {
                let v = motion.pose(time).shift[1];
                -power(&self.force_on_wall(k), &v.into())
            });
            return carried.sum::<f64>() + self.contact_power(false);
        }
        let mut taken = Collective::new();
        for group in &self.state.groups {
            for (wall, forces) in group.walls.iter().zip(group.forces_on_walls()) {
                let pose = wall.motion.as_ref().map(|motion| motion.pose(time));
                for (slot, force) in forces {
                    let number = wall.rest_of(&group.particles.ids, slot);
                    let v = match (&pose, &wall.inflow) {
                        (Some(pose), _) => pose.of(1, &wall.rest[number]),
                        (None, Some(inflow)) => inflow.place(number, &wall.rest[number])[1],
                        (None, None) => continue,
                    };
                    taken.add(power(&force, &v));
                }
            }
        }
        self.contact_power(true) - taken.value()
    }
}

/// Power \[W\] of a force \[N\] on what moves with `v` \[m/s\].
pub(super) fn power<T: Real, const D: usize>(force: &[T; D], v: &[f64; D]) -> f64 {
    (0..D).map(|d| force[d].to_f64() * v[d]).sum()
}

/// Kinetic energy of the particle in a slot \[J\].
pub(super) fn kinetic<T: Real, const D: usize>(columns: &Columns<T, D>, slot: usize) -> f64 {
    let v = &columns.vectors(Field::VELOCITY)[slot];
    let v2: f64 = v.iter().map(|v| v.to_f64().powi(2)).sum();
    0.5 * columns.raw(Field::MASS)[slot].to_f64() * v2
}
