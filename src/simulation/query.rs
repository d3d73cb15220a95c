//! Questions about particles: by body, in the order in which the scene placed them.
//! Values come out as `f64`, whatever the scalar of the simulation.

use super::Simulation;
use crate::particles::Field;
use crate::scalar::Real;

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

    /// The particles of a body, by its index, in the order in which the scene placed them.
    pub fn body(&self, body: usize) -> impl Iterator<Item = ParticleView<'_, T, D>> {
        let ids = self
            .group
            .bodies
            .get(body)
            .map_or(0..0, |body| body.slots.clone());
        ids.map(|id| self.particle(id))
    }

    /// Sets every velocity \[m/s\] as a function of position \[m\] and present velocity, between steps.
    pub fn set_velocities(&mut self, velocity: impl Fn([f64; D], [f64; D]) -> [f64; D]) {
        for slot in 0..self.group.columns.slots() {
            let now = ParticleView {
                simulation: self,
                slot,
                id: slot,
            };
            let next = velocity(now.position(), now.velocity());
            self.group.columns.vectors_mut(Field::Velocity)[slot] = next.map(T::from_f64);
        }
        self.rates_at_hand = false;
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
