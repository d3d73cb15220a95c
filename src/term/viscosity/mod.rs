//! Artificial viscosities: the trait, and one file for each law.
//! All return the Π of the pair force −mᵢ mⱼ Π ∇W, and the signal that the time step must resolve.
//!
//! | law | command line | what it adds | reads | use it for |
//! |---|---|---|---|---|
//! | [`Inviscid`] | `none` | nothing | – | smooth flow, to see what a scheme does by itself |
//! | [`MonaghanGingold`] | `mg` | α c μ + β μ² on approach | – | strong shocks, older work |
//! | [`LimitedMonaghanGingold`] | `limited` | the same on the jump that is left by reconstruction | ∇v | **solids, gases** |
//! | [`SignalVelocity`] | `signal` | the speed at which the pair's waves meet | – | mixed sound speeds, without gradients |
//! | [`Balsara`] | `balsara` | Monaghan–Gingold less where the flow turns | ∇v (2D, 3D) | shear, rotation |
//! | [`MorrisMonaghan`] | `morris-monaghan` | α of its own, fed by compression | α | strong shocks in quiet surroundings |
//! | [`CullenDehnen`] | `cullen-dehnen` | α of its own, fed by steepening | α, ∇·v, ∇v (2D, 3D) | gas that turns, subsonic turbulence, shocks; leaves more heat where cold gas starts in collision |
//! | [`Riemann`] | `riemann` | what a Riemann solver dissipates, limited | – | violent liquids, impact of unlike materials |
//!
//! The last three see little in a weak shock: at an impact of 20 m/s on copper the velocity jump is
//! 0.3 % of the sound speed, and a law that grows with that ratio leaves the front ringing. A law with
//! a fixed α does not. The page on [artificial viscosities](crate#pages) measures all of them on one front.
//!
//! In gases the signal velocity damps vortices and heats gas that converges ahead of a shock, and Cullen and Dehnen's law leaves more
//! heat where cold gas starts in collision; on gradients from [inverted matrices](crate::term::MatrixPressureForce) the limited law does
//! neither ([hard cases](crate#pages)).
//!
//! Every law is zero for receding pairs, and symmetric in the two particles, so it conserves linear
//! and angular momentum and turns kinetic energy into heat, never back.

mod balsara;
mod cullen_dehnen;
mod inviscid;
mod kind;
mod lam_printed;
mod limited;
mod monaghan_gingold;
mod morris_monaghan;
mod riemann;
mod signal_velocity;
mod switch;
#[cfg(test)]
mod tests;

pub use balsara::Balsara;
pub use cullen_dehnen::CullenDehnen;
pub use inviscid::Inviscid;
pub use kind::{UnknownViscosity, ViscosityKind};
pub use lam_printed::LamPrinted;
pub use limited::LimitedMonaghanGingold;
pub use monaghan_gingold::MonaghanGingold;
pub use morris_monaghan::MorrisMonaghan;
pub use riemann::Riemann;
pub use signal_velocity::SignalVelocity;
#[doc(hidden)]
pub use switch::{Surroundings, Switch, SwitchObject};

use super::{Layout, Pair, Sums, Term, TermDoc, not_negative};
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
///
/// Mark [`pair`](ArtificialViscosity::pair) and [`sums`](ArtificialViscosity::sums), and every function that they
/// call, `#[inline(always)]`. The pair loop is compiled for wider instructions than the rest of a program, and
/// what is not inlined into it runs without them, several times slower.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an artificial viscosity in {D} dimensions",
    note = "implement `ArtificialViscosity<{D}>`: the fields it reads and `pair`, which returns Π and a signal speed"
)]
pub trait ArtificialViscosity<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Fields it reads in addition to position, velocity, mass, density and sound speed.
    const READS: Fields;
    /// Fields that it or its switch reads. The scheme makes those of them that are gradients, as
    /// [`Field::VELOCITY_GRADIENT`], before the forces.
    const NEEDS: Fields = Self::READS;
    /// Sums that it adds to in addition to the force and the signal, for its switch.
    const WRITES: Outputs = Outputs::NONE;
    /// Π and the signal speed of a pair.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L>;
    /// Adds what its switch needs to the sums.
    #[inline(always)]
    fn sums<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>, _sums: &mut Sums<L, D, P>) {}
    /// Name, equation and source.
    fn document(&self) -> TermDoc;
    /// Whether the law needs the velocity gradient, and so the prepass that makes it.
    fn needs_velocity_gradient(&self) -> bool {
        Self::NEEDS.contains(Field::VELOCITY_GRADIENT)
    }
    /// How the particle's own coefficient α changes, if the law has one.
    fn switch(&self) -> Option<Box<dyn SwitchObject>> {
        None
    }
    /// What is wrong with the parameters, as `(field, value, what it must be)`.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

/// The force term of an artificial viscosity.
///
/// It acts between particles that move by forces. With walls it would be a friction that no liquid has:
/// its ν = α h c/(4 (D + 2)) in shear is a thousand times that of water, and held the front of a dam
/// break back by a tenth of its way (Adami, Hu & Adams 2012 leave it out at walls too).
#[derive(Clone, Debug)]
pub struct Viscosity<V>(pub V);

impl<const D: usize, V: ArtificialViscosity<D>> Term<D> for Viscosity<V> {
    const NAME: &'static str = "meshfree::artificial_viscosity";
    const READS: Fields = Fields::of(&[
        Field::VELOCITY,
        Field::MASS,
        Field::DENSITY,
        Field::SOUND_SPEED,
    ])
    .union(V::READS);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE, Output::SIGNAL]).union(V::WRITES);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let viscous = self.0.pair(pair);
        let masses = pair.i(Field::MASS) * (pair.mobile * pair.mobile_i) * pair.j(Field::MASS);
        sums.gradient.add_product(-masses, viscous.pi);
        let inside = pair.f.lt(L::zero());
        sums.raise(Output::SIGNAL, L::select(inside, viscous.signal, L::zero()));
        self.0.sums(pair, sums);
    }
    fn document(&self) -> TermDoc {
        self.0.document()
    }
}

/// v·r of an approaching pair, zero otherwise.
#[inline(always)]
fn approach<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    pair.v_dot_r.min(L::zero())
}

/// Of α c̄ what slows the step: a pair whose viscosity is linear needs h/(c + 0.6 α c) (Monaghan 1992, eq. 10.5).
const LINEAR_SIGNAL: f64 = 0.6;

/// Π and signal with the means of sound speed and density, from the v·r that dissipates, which is not positive: μ = h v·r/(r² +
/// 0.01 h²).
///
/// The signal is 0.6 α c̄ + 2 β |μ|. The second part is the slope of the β μ² that dissipates: with the 0.6 β |μ| of Monaghan, neighbours
/// in a strong shock of cold gas are stopped and turned back within a step, and Noh's plateau errs ([hard cases](crate#pages)).
#[inline(always)]
fn between<L: Lane, const D: usize, P: Layout>(
    pair: &Pair<'_, L, D, P>,
    approach: L,
    alpha: L,
    beta: L,
) -> Viscous<L> {
    // One division serves μ and Π: it takes longer than all else here.
    from_quotient(pair, approach / below(pair), alpha, beta)
}

/// What μ and Π are divided by together: (r² + 0.01 h²)/h times twice the mean density.
#[inline(always)]
fn below<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    let densities = pair.i(Field::DENSITY) + pair.j(Field::DENSITY);
    let r2_over_h = pair.r2.mul_add(pair.h.recip(), pair.h * L::of(0.01));
    r2_over_h * densities
}

/// Π and signal from μ over twice the mean density.
#[inline(always)]
fn from_quotient<L: Lane, const D: usize, P: Layout>(
    pair: &Pair<'_, L, D, P>,
    mu_over_densities: L,
    alpha: L,
    beta: L,
) -> Viscous<L> {
    // Twice the means: their halves cancel in Π.
    let sound_speeds = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
    let densities = pair.i(Field::DENSITY) + pair.j(Field::DENSITY);
    // 2 (α c̄ − β μ)
    let mu = mu_over_densities * densities;
    let linear = alpha * sound_speeds;
    let speed = mu.mul_add(-(beta + beta), linear);
    Viscous {
        pi: -(mu_over_densities * speed),
        signal: linear.mul_add(L::of(0.5 * LINEAR_SIGNAL - 1.0), speed),
    }
}

/// |rᵢⱼ| \[m\], not zero for the particle itself.
#[inline(always)]
fn distance<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    // A millionth of h² keeps the particle itself finite, and is lost in rounding elsewhere.
    let r2 = pair.h.mul_add(pair.h * L::of(1e-6), pair.r2);
    r2.sqrt()
}

/// −vᵢⱼ·rᵢⱼ/|rᵢⱼ| of an approaching pair, zero otherwise \[m/s\].
#[inline(always)]
fn closing_speed<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    (-pair.v_dot_r).positive_part() / distance(pair)
}

/// Monaghan–Gingold with the mean of the particles' own coefficients, and β in proportion to α.
#[inline(always)]
fn between_own<L: Lane, const D: usize, P: Layout>(
    pair: &Pair<'_, L, D, P>,
    beta_over_alpha: f64,
) -> Viscous<L> {
    let field = Field::VISCOSITY_COEFFICIENT;
    let alpha = (pair.i(field) + pair.j(field)) * L::of(0.5);
    between(pair, approach(pair), alpha, alpha * L::of(beta_over_alpha))
}

/// What is wrong with a fixed pair of coefficients.
fn coefficients(alpha: f64, beta: f64) -> Vec<(&'static str, f64, &'static str)> {
    not_negative(&[("alpha", alpha), ("beta", beta)])
}
