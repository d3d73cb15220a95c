//! How a particle's own coefficient of viscosity follows the flow around it: what a switch sees, and what it gives.
//! Each law's equation is in the law's file.

use crate::particles::Fields;
use core::fmt::Debug;

/// What a switch sees of the flow around a particle.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<T> {
    /// ∇·v \[1/s\].
    pub divergence: T,
    /// ∇·v of the step before \[1/s\].
    pub divergence_before: T,
    /// Mean sign of ∇·v, from −1 to 1.
    pub divergence_sign: T,
    /// tr S Sᵀ of the traceless shear \[1/s²\].
    pub shear2: T,
    /// Sound speed \[m/s\].
    pub sound_speed: T,
    /// Largest signal speed towards a neighbour \[m/s\].
    pub signal_speed: T,
    /// Smoothing length \[m\].
    pub h: T,
    /// Radius of the support \[m\].
    pub support: T,
}

/// How a particle's own viscosity coefficient α follows the flow, once a step; see [`MorrisMonaghan`](super::MorrisMonaghan) and
/// [`CullenDehnen`](super::CullenDehnen).
///
/// ```
/// use meshfree::particles::Fields;
/// use meshfree::prelude::*;
/// use meshfree::term::viscosity::{MorrisMonaghan, Surroundings, Switch, Viscous};
/// use meshfree::term::{ArtificialViscosity, Layout, Pair, TermDoc};
///
/// /// α = 1 where the flow converges; elsewhere α decays in the time h/c.
/// #[derive(Clone, Copy, Debug)]
/// struct AtOnce;
///
/// const FORCE: MorrisMonaghan = MorrisMonaghan::STANDARD;
///
/// impl<const D: usize> ArtificialViscosity<D> for AtOnce {
///     const READS: Fields = <MorrisMonaghan as ArtificialViscosity<D>>::READS;
///     #[inline(always)]
///     fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
///         FORCE.pair(pair)
///     }
///     fn document(&self) -> TermDoc {
///         TermDoc { name: "viscosity at once".into(), equation: "α = 1 where ∇·v < 0, else dα/dt = −α c/h", source: "an example" }
///     }
///     fn switch<T: Real>(&self) -> Option<Box<dyn Switch<T>>> {
///         Some(Box::new(*self))
///     }
/// }
///
/// impl<T: Real> Switch<T> for AtOnce {
///     fn start(&self) -> f64 {
///         0.0
///     }
///     fn next(&self, alpha: T, around: &Surroundings<T>, dt: T) -> T {
///         if around.divergence < T::zero() {
///             return T::one();
///         }
///         alpha * (-around.sound_speed / around.h * dt).exp()
///     }
/// }
///
/// let rod = |name, low: f64, v| Body::block(name, catalogue::copper(), [low], [low + 0.01], 1e-4).velocity([v]);
/// let mut rods = Scene::<f64, 1>::new(schemes::impact().with_viscosity(AtOnce))
///     .body(rod("left", -0.01, 20.0))
///     .body(rod("right", 0.0, -20.0))
///     .build()?;
/// rods.run_until(2e-7)?;
/// let alpha: Vec<_> = rods.all().filter_map(|particle| particle.scalar(Field::VISCOSITY_COEFFICIENT)).collect();
/// assert!(alpha[99] > 0.9 && alpha[0] == 0.0);
/// # Ok::<(), Error>(())
/// ```
pub trait Switch<T>: Debug + Send + Sync {
    /// The coefficient that a particle starts with: that of a fluid long at rest.
    fn start(&self) -> f64;
    /// The coefficient after `dt` \[s\].
    fn next(&self, alpha: T, around: &Surroundings<T>, dt: T) -> T;
    /// Fields that particles keep for it beside the coefficient: ∇·v for that of the step before.
    fn keeps(&self) -> Fields {
        Fields::NONE
    }
}
