//! What a wall law sees of a wall: its motion, its normals, and whether liquid sticks to it.
//! Particles are told apart by their slot, which a sort of the wall changes.

use super::{Pose, Slip};
use crate::scalar::Real;
use crate::tensor::{Matrix, Vector, inverse, length};
use core::marker::PhantomData;

/// A wall of particles, as the wall law of a liquid sees it.
#[derive(Clone, Debug)]
pub struct WallSurface<'a, T, const D: usize> {
    ids: &'a [u32],
    /// The slot of its first particle, and the identity of the first.
    first: usize,
    rest: &'a [[f64; D]],
    normals: &'a [[f64; D]],
    /// By what normals turn: the inverse transpose, which a crush has other than a rotation.
    turn: Option<Matrix<f64, D>>,
    pose: Option<Pose<D>>,
    accelerations: Option<&'a [[f64; D]]>,
    /// The velocity gradient of the whole wall, and those of its particles where they differ.
    gradient: Option<Matrix<f64, D>>,
    gradients: &'a [Matrix<f64, D>],
    slip: Slip,
    flows: bool,
    scalar: PhantomData<T>,
}

impl<'a, T: Real, const D: usize> WallSurface<'a, T, D> {
    pub(crate) fn new(
        (ids, first): (&'a [u32], usize),
        (rest, normals): (&'a [[f64; D]], &'a [[f64; D]]),
        (pose, slip): (Option<Pose<D>>, Slip),
        accelerations: Option<&'a [[f64; D]]>,
        gradients: &'a [Matrix<f64, D>],
    ) -> Self {
        let gradient = pose.as_ref().and_then(Pose::velocity_gradient);
        let turn = pose
            .as_ref()
            .filter(|_| !normals.is_empty())
            .and_then(|pose| inverse(&pose.linear[0], 0.0))
            .map(|back| back.transpose());
        Self {
            ids,
            first,
            rest,
            normals,
            turn,
            pose,
            accelerations,
            gradient,
            gradients,
            slip,
            flows: false,
            scalar: PhantomData,
        }
    }

    /// Whether it is the buffer of an inlet.
    pub(crate) fn that_flows(mut self, flows: bool) -> Self {
        self.flows = flows;
        self
    }

    /// Whether it is liquid: the buffer of an inlet, which has its own velocity and the viscosity of the liquid before it.
    #[must_use]
    pub fn flows(&self) -> bool {
        self.flows
    }

    /// Whether liquid sticks to it.
    #[must_use]
    pub fn sticks(&self) -> bool {
        self.slip == Slip::None
    }

    /// The number of a particle among those of the wall as built.
    fn number(&self, slot: usize) -> usize {
        (self.ids[slot] as usize - self.first).min(self.rest.len() - 1)
    }

    /// The acceleration of the particle in a slot \[m/s²\].
    #[must_use]
    pub fn acceleration(&self, slot: usize) -> [f64; D] {
        let at = self.number(slot);
        match (self.accelerations, &self.pose) {
            (Some(accelerations), _) => accelerations[at],
            (None, Some(pose)) => pose.of(2, &self.rest[at]),
            (None, None) => [0.0; D],
        }
    }

    /// The velocity gradient ∂vₐ/∂x_b \[1/s\], row a, of the wall around the particle in a slot: its spin, if it is rigid.
    /// None where its velocity is the same everywhere.
    #[must_use]
    pub fn velocity_gradient(&self, slot: usize) -> Option<Matrix<f64, D>> {
        let own = self.gradients.get(self.number(slot)).copied();
        own.or(self.gradient)
    }

    /// The unit vector from the liquid into the wall at the particle in a slot, where the wall law asked for
    /// normals.
    #[must_use]
    pub fn normal(&self, slot: usize) -> Option<Vector<T, D>> {
        let normal = Vector::from(*self.normals.get(self.number(slot))?);
        let normal = self.turn.map_or(normal, |turn| {
            let turned = turn * normal;
            turned / length(&turned).max(f64::MIN_POSITIVE)
        });
        Some(normal.map(T::from_f64))
    }
}
