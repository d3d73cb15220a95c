//! How a particle's own coefficient of viscosity follows the flow around it: what a switch sees, and what it gives.
//! Each law's equation is in the law's file.

use crate::particles::Fields;
use crate::scalar::{Function, Lane, OfLanes, call};
use core::fmt::Debug;

/// What a switch sees of the flow around a particle, or around each of a row.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<L> {
    /// ∇·v \[1/s\].
    pub divergence: L,
    /// ∇·v of the step before \[1/s\].
    pub divergence_before: L,
    /// Mean sign of ∇·v, from −1 to 1.
    pub divergence_sign: L,
    /// tr S Sᵀ of the traceless shear \[1/s²\].
    pub shear2: L,
    /// Sound speed \[m/s\].
    pub sound_speed: L,
    /// Largest signal speed towards a neighbour \[m/s\].
    pub signal_speed: L,
    /// Smoothing length \[m\].
    pub h: L,
    /// Radius of the support \[m\].
    pub support: L,
}

/// How a particle's own viscosity coefficient α follows the flow, once a step; see [`MorrisMonaghan`](super::MorrisMonaghan) and
/// [`CullenDehnen`](super::CullenDehnen).
///
/// ```
/// use meshfree::particles::Fields;
/// use meshfree::prelude::*;
/// use meshfree::term::viscosity::{MorrisMonaghan, Surroundings, Switch, SwitchObject, Viscous};
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
///     fn switch(&self) -> Option<Box<dyn SwitchObject>> {
///         Some(Box::new(*self))
///     }
/// }
///
/// impl Switch for AtOnce {
///     fn start(&self) -> f64 {
///         0.0
///     }
///     #[inline(always)]
///     fn next<L: Lane>(&self, alpha: L, around: &Surroundings<L>, dt: L) -> L {
///         let decayed = alpha * (-around.sound_speed / around.h * dt).exp();
///         L::select(around.divergence.lt(L::zero()), L::one(), decayed)
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
pub trait Switch: Debug + Send + Sync + 'static {
    /// The coefficient that a particle starts with: that of a fluid long at rest.
    fn start(&self) -> f64;
    /// The coefficient after `dt` \[s\], in the arithmetic of [lanes](Lane) and the scalar of the simulation.
    fn next<L: Lane>(&self, alpha: L, around: &Surroundings<L>, dt: L) -> L;
    /// Fields that particles keep for it beside the coefficient: ∇·v for that of the step before.
    fn keeps(&self) -> Fields {
        Fields::NONE
    }
}

/// A switch whose type is erased.
///
/// Sealed: it is made of any [`Switch`].
pub trait SwitchObject: Function<10> + Debug + Send + Sync {
    /// See [`Switch::start`].
    fn start(&self) -> f64;
    /// See [`Switch::keeps`].
    fn keeps(&self) -> Fields;
}

impl<S: Switch> SwitchObject for S {
    fn start(&self) -> f64 {
        Switch::start(self)
    }
    fn keeps(&self) -> Fields {
        Switch::keeps(self)
    }
}

impl dyn SwitchObject + '_ {
    /// The coefficient after `dt` \[s\].
    #[inline(always)]
    #[must_use]
    pub fn next<L: Lane>(&self, alpha: L, around: &Surroundings<L>, dt: L) -> L {
        let own = [
            alpha,
            dt,
            around.divergence,
            around.divergence_before,
            around.divergence_sign,
            around.shear2,
            around.sound_speed,
            around.signal_speed,
            around.h,
            around.support,
        ];
        call(self, &own)
    }
}

impl<S: Switch> OfLanes<10> for S {
    #[inline(always)]
    fn of<L: Lane>(&self, [alpha, dt, own @ ..]: [L; 10]) -> L {
        let around = Surroundings {
            divergence: own[0],
            divergence_before: own[1],
            divergence_sign: own[2],
            shear2: own[3],
            sound_speed: own[4],
            signal_speed: own[5],
            h: own[6],
            support: own[7],
        };
        self.next(alpha, &around, dt)
    }
}
