//! Where the time of steps goes: two looks at the clock for each phase of a step.
//! What no phase of its own counts is integration.

use super::Simulation;
use crate::clock::Instant;
use crate::scalar::Real;
use std::time::Duration;

/// Time spent in steps since the scene was built, by phase.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Phases {
    /// Sorting, neighbour lists and images, and the question whether they are still good.
    pub lists: Duration,
    /// Packing of records for pair sweeps.
    pub packing: Duration,
    /// Sweeps over pairs, those of walls excepted.
    pub pairs: Duration,
    /// The work of pair forces in kicks, which the compatible energy form sums in a sweep of its own, but in total-Lagrangian
    /// schemes ([`EnergyForm::Compatible`](crate::scheme::EnergyForm::Compatible)).
    pub work: Duration,
    /// What wall particles take from the liquid, with the sweep over their neighbours.
    pub walls: Duration,
    /// Equations of state and the coefficients of the pressure force.
    pub materials: Duration,
    /// Kicks, drifts, votes on the step, and all else.
    pub integration: Duration,
}

impl Phases {
    /// Everything but lists, work and integration: what an evaluation of the rates takes.
    #[must_use]
    pub fn evaluation(&self) -> Duration {
        self.packing + self.pairs + self.walls + self.materials
    }

    /// All phases together.
    #[must_use]
    pub fn total(&self) -> Duration {
        self.lists + self.evaluation() + self.work + self.integration
    }

    /// With what another group has spent.
    fn and(self, other: &Self) -> Self {
        Self {
            lists: self.lists + other.lists,
            packing: self.packing + other.packing,
            pairs: self.pairs + other.pairs,
            work: self.work + other.work,
            walls: self.walls + other.walls,
            materials: self.materials + other.materials,
            integration: self.integration + other.integration,
        }
    }

    /// What has been spent since an earlier reading.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            lists: self.lists.saturating_sub(earlier.lists),
            packing: self.packing.saturating_sub(earlier.packing),
            pairs: self.pairs.saturating_sub(earlier.pairs),
            work: self.work.saturating_sub(earlier.work),
            walls: self.walls.saturating_sub(earlier.walls),
            materials: self.materials.saturating_sub(earlier.materials),
            integration: self.integration.saturating_sub(earlier.integration),
        }
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Time spent in steps so far, by phase.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// let before = simulation.phases();
    /// simulation.step()?;
    /// assert!(simulation.phases().since(&before).total() > std::time::Duration::ZERO);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn phases(&self) -> Phases {
        self.state
            .own()
            .groups
            .iter()
            .fold(Phases::default(), |sum, group| sum.and(&group.work.phases))
    }

    /// Books what a step took that no other phase has counted.
    pub(super) fn book_step(&mut self, start: Instant, before: Phases) {
        let counted = self.phases().since(&before).total();
        self.state.groups[0].work.phases.integration += start.elapsed().saturating_sub(counted);
    }
}
