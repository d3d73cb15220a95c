//! Artificial viscosities: the trait, and one file for each law.
//! All return the Π of the pair force −mᵢ mⱼ Π ∇W, and the signal that the time step must resolve.

mod monaghan_gingold;

pub use monaghan_gingold::{LimitedMonaghanGingold, MonaghanGingold};

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use core::fmt::Debug;

/// What a viscosity makes of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Viscous<L> {
    /// Viscous pressure over density squared, Π \[m⁵/(kg s²)\]; not negative for approaching pairs,
    /// symmetric in i and j.
    pub pi: L,
    /// Speed that the viscosity adds to the sound speed in the step criterion \[m/s\].
    pub signal: L,
}

/// An artificial viscosity.
///
/// The force on i is −mᵢ mⱼ Πᵢⱼ ∇W; its work heats i and j in equal parts.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an artificial viscosity in {D} dimensions",
    note = "implement `ArtificialViscosity<{D}>`: the fields it reads and `pair`, which returns Π and a signal speed"
)]
pub trait ArtificialViscosity<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Fields it reads beside position, velocity, mass, density and sound speed.
    const READS: Fields;
    /// Π and the signal speed of a pair.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L>;
    /// Name, equation and source.
    fn document(&self) -> TermDoc;
    /// Whether the law needs the velocity gradient, and so the prepass that makes it.
    fn needs_velocity_gradient(&self) -> bool {
        Self::READS.contains(Field::VelocityGradient)
    }
    /// How the particle's own coefficient α changes, if the law has one.
    fn switch(&self) -> Option<Switch> {
        None
    }
    /// What is wrong with the parameters, as `(field, value, what it must be)`.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// The force term of an artificial viscosity.
#[derive(Clone, Debug)]
pub struct Viscosity<V>(pub V);

impl<const D: usize, V: ArtificialViscosity<D>> Term<D> for Viscosity<V> {
    const READS: Fields = Fields::of(&[
        Field::Velocity,
        Field::Mass,
        Field::Density,
        Field::SoundSpeed,
    ])
    .union(V::READS);
    const WRITES: Outputs = Outputs::of(&[Output::Force, Output::Signal]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let viscous = self.0.pair(pair);
        sums.radial -= pair.i(Field::Mass) * pair.j(Field::Mass) * viscous.pi * pair.f;
        let inside = pair.f.lt(L::zero());
        sums.raise(Output::Signal, L::select(inside, viscous.signal, L::zero()));
    }
    fn document(&self) -> TermDoc {
        self.0.document()
    }
}

/// How a particle's own viscosity coefficient α follows the flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Switch {
    /// dα/dt = −(α − α_min) ℓ c/h + max(−∇·v, 0) (α_max − α) (Morris & Monaghan 1997, eq. 27).
    MorrisMonaghan {
        /// Coefficient far from shocks.
        minimum: f64,
        /// Coefficient in a shock.
        maximum: f64,
        /// Decay length: the inverse of the number of smoothing lengths a coefficient lives.
        decay: f64,
    },
    /// α jumps up where the divergence falls, and decays behind (Cullen & Dehnen 2010, eqs. 13–17).
    CullenDehnen {
        /// Largest coefficient.
        maximum: f64,
        /// Decay length ℓ.
        decay: f64,
    },
}

/// No artificial viscosity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inviscid;

impl<const D: usize> ArtificialViscosity<D> for Inviscid {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        Viscous {
            pi: L::zero(),
            signal: L::zero(),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "no artificial viscosity".into(),
            equation: "Π = 0",
            source: "",
        }
    }
}

/// Π and signal of an approach μ ≤ 0 with the means of sound speed and density.
#[inline(always)]
fn between<L: Lane, const D: usize, P: Layout>(
    pair: &Pair<'_, L, D, P>,
    mu: L,
    alpha: L,
    beta: L,
) -> Viscous<L> {
    let half = L::of(0.5);
    let sound_speed = (pair.i(Field::SoundSpeed) + pair.j(Field::SoundSpeed)) * half;
    let density = (pair.i(Field::Density) + pair.j(Field::Density)) * half;
    let linear = alpha * sound_speed;
    let pi = mu * (beta * mu - linear) / density;
    // Monaghan 1992, eq. 10.5: a viscous pair needs h/(c + 0.6 (α c + β |μ|)).
    Viscous {
        pi,
        signal: (linear - beta * mu) * L::of(0.6),
    }
}
