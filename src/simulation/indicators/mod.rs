//! How far a run's sums are from those of a continuum, how well it resolves what is in it, and what limits it most.
//! Read when asked for, from a sample of the particles; a run that never asks pays nothing.

mod limit;
mod look;
mod measure;
mod print;
mod report;
mod thickness;

pub use report::{Indicators, Limit, LimitedBy, Spread};

use super::Simulation;
use crate::once::once;
use crate::scalar::Real;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Error indicators of the present state: see [`Indicators`] for what each is, and [`Indicators::limit`] for what limits
    /// accuracy most and what one step better would cost.
    ///
    /// Sums are over the neighbour lists and pressures that the last step or evaluation has left
    /// ([`evaluate`](Simulation::evaluate) makes them of a state that is new). Of large scenes every n-th
    /// 256 particles are looked at, 32 768 in all, beside a sort of all of them: call it in the closure of
    /// [`run_with`](Simulation::run_with) every 500 steps or so. It changes no bit of a run.
    ///
    /// **Free surfaces** are no defects. A particle is at one if a cone of 45° to the side where it lacks neighbours is empty up
    /// to two spacings; walls and images count as neighbours. What has such a particle, or is one, within its support has sums
    /// that lack what is not there, and is left out: [`Indicators::inside`] of [`Indicators::particles`] remain.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let water = catalogue::weakly_compressible_water(1.0);
    /// let mut patch = Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(Body::block("patch", water, [-0.5; 2], [0.5; 2], 0.05))
    ///     .build()?;
    /// patch.evaluate()?;
    /// let indicators = patch.indicators();
    /// println!("{indicators}");
    /// // A lattice: Σ V W is that of its kernel, gradients are even, and the layers at the surface are left out.
    /// let unity = indicators.unity.as_ref().map(|own| own.median);
    /// assert!(unity.is_some_and(|unity| unity < 0.01), "{indicators}");
    /// assert!(indicators.disorder.as_ref().is_some_and(|own| own.worst.value < 1e-12));
    /// assert!(indicators.inside < indicators.particles);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn indicators(&self) -> Indicators {
        once!(self => &Simulation, |own| -> Indicators { measure::of(own) })
    }
}
