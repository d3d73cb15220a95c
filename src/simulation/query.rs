//! Questions about particles: by body, in the order in which the scene placed them.
//! Values come out as `f64`, whatever the scalar of the simulation.

use super::Simulation;
use super::population::Removed;
use crate::boundary::Pose;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::sweep::{Pass, Records, Rows, SweepInput};

/// A particle as it is now.
#[derive(Clone, Copy, Debug)]
pub struct ParticleView<'a, T: Real, const D: usize> {
    simulation: &'a Simulation<T, D>,
    slot: usize,
    id: usize,
}

impl<T: Real, const D: usize> ParticleView<'_, T, D> {
    /// Its number in the whole simulation, which never changes.
    #[must_use]
    pub fn id(&self) -> usize {
        self.id
    }
    /// Position \[m\].
    #[must_use]
    pub fn position(&self) -> [f64; D] {
        let columns = &self.simulation.group.columns;
        let residual = columns.raw(Field::PositionResidual);
        let x = columns.vectors(Field::Position)[self.slot];
        core::array::from_fn(|d| {
            let lost = residual.get(self.slot * D + d).map_or(0.0, |r| r.to_f64());
            x[d].to_f64() + lost
        })
    }
    /// Velocity \[m/s\].
    #[must_use]
    pub fn velocity(&self) -> [f64; D] {
        self.simulation.group.columns.vectors(Field::Velocity)[self.slot].map(Real::to_f64)
    }
    /// A scalar field, or `None` if the scene does not carry it.
    #[must_use]
    pub fn scalar(&self, field: Field) -> Option<f64> {
        self.simulation
            .group
            .columns
            .raw(field)
            .get(self.slot)
            .map(|value| value.to_f64())
    }
    /// Density \[kg/m³\].
    #[must_use]
    pub fn density(&self) -> f64 {
        self.scalar(Field::Density).unwrap_or(0.0)
    }
    /// Pressure \[Pa\], positive in compression.
    #[must_use]
    pub fn pressure(&self) -> f64 {
        self.scalar(Field::Pressure).unwrap_or(0.0)
    }
    /// Specific internal energy \[J/kg\], zero if it is not carried.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.scalar(Field::Energy).unwrap_or(0.0)
    }
    /// Mass \[kg\] (kg/m² in 1D, kg/m in 2D).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.scalar(Field::Mass).unwrap_or(0.0)
    }
    /// Smoothing length \[m\].
    #[must_use]
    pub fn smoothing_length(&self) -> f64 {
        self.scalar(Field::SmoothingLength)
            .unwrap_or(self.simulation.group.smoothing_length)
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Number of particles.
    #[must_use]
    pub fn particles(&self) -> usize {
        self.group.particles()
    }

    /// Names of the bodies, in the order of the scene.
    pub fn bodies(&self) -> impl Iterator<Item = &str> {
        self.group.bodies.iter().map(|body| body.name.as_str())
    }

    /// The particles of a body, by its index, in the order in which the scene placed them; those that
    /// have left through an outlet are missing.
    pub fn body(&self, body: usize) -> impl Iterator<Item = ParticleView<'_, T, D>> {
        let ids = self
            .group
            .bodies
            .get(body)
            .map_or(0..0, |body| body.ids.clone());
        let there = |&id: &usize| self.group.slot_of[id] != u32::MAX;
        ids.filter(there).map(|id| self.particle(id))
    }

    /// Sets every velocity \[m/s\] as a function of position \[m\] and present velocity, between steps.
    pub fn set_velocities(&mut self, velocity: impl Fn([f64; D], [f64; D]) -> [f64; D]) {
        for slot in 0..self.group.mobile {
            let now = ParticleView {
                simulation: self,
                slot,
                id: slot,
            };
            let next = velocity(now.position(), now.velocity());
            self.group.columns.vectors_mut(Field::Velocity)[slot] = next.map(T::from_f64);
        }
        self.rates_at_hand = false;
        self.group.renewed_until = f64::NEG_INFINITY;
    }

    /// A particle by its number.
    pub(crate) fn particle(&self, id: usize) -> ParticleView<'_, T, D> {
        ParticleView {
            simulation: self,
            slot: self.group.slot_of[id] as usize,
            id,
        }
    }

    /// All particles, body after body.
    pub fn all(&self) -> impl Iterator<Item = ParticleView<'_, T, D>> {
        (0..self.group.bodies.len()).flat_map(|body| self.body(body))
    }

    /// Names of the walls, in the order of the scene.
    pub fn walls(&self) -> impl Iterator<Item = &str> {
        self.group.walls.iter().map(|wall| wall.name.as_str())
    }

    /// The particles of a wall, by its index, in the order of memory.
    pub fn wall(&self, wall: usize) -> impl Iterator<Item = ParticleView<'_, T, D>> {
        let slots = self
            .group
            .walls
            .get(wall)
            .map_or(0..0, |wall| wall.slots.clone());
        slots.map(|slot| ParticleView {
            simulation: self,
            slot,
            id: self.group.ids[slot] as usize,
        })
    }

    /// Where a wall is now: the pose of its motion; at rest without one.
    #[must_use]
    pub fn wall_pose(&self, wall: Option<usize>) -> Pose<D> {
        wall.and_then(|wall| self.group.walls.get(wall))
            .and_then(|wall| wall.motion.as_ref())
            .map_or_else(Pose::rest, |motion| motion.pose(self.time))
    }

    /// Shows every particle, of bodies and walls, within `reach` \[m\] of a point.
    pub(crate) fn near(
        &self,
        point: &[f64; D],
        reach: f64,
        mut visit: impl FnMut(ParticleView<'_, T, D>),
    ) {
        let walls = self.group.walls.iter().map(|wall| wall.slots.clone());
        let bodies = self.group.bodies.iter().map(|body| body.slots.clone());
        let positions = self.group.columns.vectors(Field::Position);
        for slot in bodies.chain(walls).flatten() {
            let r2: f64 = (0..D)
                .map(|d| (positions[slot][d].to_f64() - point[d]).powi(2))
                .sum();
            if r2 < reach * reach {
                visit(ParticleView {
                    simulation: self,
                    slot,
                    id: self.group.ids[slot] as usize,
                });
            }
        }
    }

    /// The force \[N\] of the bodies on every wall particle at the last evaluation, with its position
    /// \[m\]: the forces on the bodies with the opposite sign. A sweep over the walls, when asked for.
    #[must_use]
    pub fn wall_particle_forces(&self) -> Vec<([f64; D], [f64; D])> {
        let group = &self.group;
        let mut rows = Rows::default();
        let input = SweepInput {
            targets: group.mobile..group.columns.slots(),
            ..group.input()
        };
        let rates = group.scheme.rates.as_ref();
        if group.records_of_rates {
            rates.run(Pass::Rates, &input, &group.records, &mut rows);
        } else {
            // Another sweep has used the records since.
            let mut records = Records::default();
            rates.pack(Pass::Rates, &input, &mut records);
            rates.run(Pass::Rates, &input, &records, &mut rows);
        }
        let walls = group.walls.iter().flat_map(|wall| wall.slots.clone());
        walls
            .map(|slot| {
                let x = group.columns.vectors(Field::Position)[slot];
                let force = rows.vector(Output::Force, slot);
                (x.map(Real::to_f64), force.map(Real::to_f64))
            })
            .collect()
    }

    /// Whether a particle belongs to a body and not to a wall.
    pub(crate) fn is_mobile(&self, particle: &ParticleView<'_, T, D>) -> bool {
        particle.slot < self.group.mobile
    }

    /// What has left through outlets.
    #[must_use]
    pub fn removed(&self) -> Removed<D> {
        self.group.removed
    }

    /// Smoothing length \[m\] of the bodies as built.
    #[must_use]
    pub fn smoothing_length(&self) -> f64 {
        self.group.smoothing_length
    }

    /// Spacing \[m\] of the first body.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.group.bodies.first().map_or(0.0, |body| body.spacing)
    }

    /// Counts of what guards did, by kind, since the start.
    #[must_use]
    pub fn guard_counts(&self) -> crate::material::eos::GuardCounts {
        self.group.guards
    }

    /// Smoothing lengths that were held at a limit, in particle evaluations since the start.
    #[must_use]
    pub fn limited_smoothing_lengths(&self) -> u64 {
        self.group.limited_h
    }

    /// Densities of liquid torn at its cut-off that were held from thinning out further, in particle steps
    /// since the start.
    #[must_use]
    pub fn held_densities(&self) -> u64 {
        self.group.held_densities
    }

    /// Builds of the neighbour lists since the start.
    #[must_use]
    pub fn list_builds(&self) -> u64 {
        self.group.rebuilds
    }

    /// Bytes held for particles, lists and records.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.group.bytes()
    }

    /// The scheme of the bodies.
    #[must_use]
    pub fn scheme(&self) -> &crate::scheme::Scheme<T, D> {
        &self.group.scheme
    }

    /// The integrator's name.
    #[must_use]
    pub fn integrator_name(&self) -> String {
        self.integrator.name()
    }
}
