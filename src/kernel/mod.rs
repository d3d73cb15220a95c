//! Smoothing kernels: the trait, and one file for each family.
//! W(r, h) = σ_D h⁻ᴰ f(q) with q = r/h; the gradient is F r_ij with F = σ_D h⁻ᴰ⁻² f′(q)/q.
//!
//! A kernel spreads each particle over a small ball. Three choices matter: how many neighbours it
//! takes, whether it lets particles pair, and how long a time step it allows.
//!
//! | kernel | support | h/dx (range in 2D, 3D) | neighbours in 3D | use it for |
//! |---|---|---|---|---|
//! | [`CubicSpline`] | 2h | 1.2 (1.0–1.25) | 58 | 1D, strong shocks, reproducing older work |
//! | [`QuarticSpline`] | 5/2 h | 1.2 (1.0–1.5) | 113 | less noise than the cubic |
//! | [`QuinticSpline`] | 3h | 1.2 (1.0–1.5) | 195 | waves, viscous flow |
//! | [`WendlandC2`] | 2h | 1.5 (1.2–2.0) | 113 | liquids, fluid with structure; 2.0 for waves |
//! | [`WendlandC4`] | 2h | 1.8 (1.3–2.3) | 196 | gases, convergence; 2.2 for viscous flow without a surface |
//! | [`WendlandC6`] | 2h | 2.0 (1.5–2.5) | 268 | reference solutions |
//! | [`Gaussian`] | 3h | 1.1 (1.0–1.5) | 150 | comparison with theory |
//!
//! Pairing: two particles that come close attract no penalty when f′(q) flattens towards q = 0, and
//! with many neighbours it pays the lattice to clump. A kernel whose D-dimensional Fourier transform
//! is nowhere negative cannot pair (Dehnen & Aly 2012); the Wendland kernels have that property, the
//! splines have not. The cubic spline pays for it at once above h/dx ≈ 1.25 (its growth rate rises
//! fiftyfold), the smoother splines only a little. In 1D every kernel accepts h/dx from 1 to 2.
//!
//! Time step: [`stable_step`](Kernel::stable_step) is 2h/(c ω) for the highest frequency ω of an
//! undamped uniform lattice, the smaller of a medium at rest (p = 0) and a gas (p = 0.6 ρc²), and the
//! smallest over Cartesian and close-packed lattices at the recommended h/dx. A test repeats that
//! analysis. The step factor of a scheme
//! ([`StepControl::courant`](crate::simulation::StepControl), 0.55 by default) stays below half of the
//! smallest of them, which covers the whole accepted range of h/dx and the damping that a viscosity adds.
//!
//! # A kernel of your own
//!
//! ```
//! use meshfree::{kernel::Kernel, scalar::Lane};
//!
//! /// f(q) = (1 − q²/4)₊³: flat at the centre, so it pairs soon.
//! #[derive(Clone, Copy, Debug)]
//! struct Mueller;
//!
//! impl Kernel<3> for Mueller {
//!     fn name(&self) -> &'static str { "Müller poly6" }
//!     fn support(&self) -> f64 { 2.0 }
//!     fn normalisation(&self) -> f64 { 315.0 / (512.0 * std::f64::consts::PI) }
//!     fn h_over_dx(&self) -> f64 { 1.2 }
//!     fn h_over_dx_range(&self) -> (f64, f64) { (1.0, 1.3) }
//!     fn stable_step(&self) -> f64 { 1.0 }
//!     #[inline(always)]
//!     fn shape<L: Lane>(&self, q: L) -> L {
//!         let t = (q * q).mul_add(L::of(-0.25), L::one()).positive_part();
//!         t * t * t
//!     }
//!     #[inline(always)]
//!     fn slope_over_q<L: Lane>(&self, q: L) -> L {
//!         let t = (q * q).mul_add(L::of(-0.25), L::one()).positive_part();
//!         t * t * L::of(-1.5)
//!     }
//! }
//! // It integrates to one.
//! let integral: f64 = (0..1000)
//!     .map(|k| (k as f64 + 0.5) * 0.002)
//!     .map(|q| Mueller.shape(q) * 4.0 * std::f64::consts::PI * q * q * 0.002)
//!     .sum();
//! assert!((Mueller.normalisation() * integral - 1.0).abs() < 1e-5);
//! ```

mod check;
mod cubic;
mod gaussian;
pub(crate) mod lattice;
mod profile;
mod quartic;
mod quintic;
#[cfg(test)]
mod tests;
mod wendland_c2;
mod wendland_c4;
mod wendland_c6;

pub(crate) use check::problems_of;
pub use cubic::CubicSpline;
pub use gaussian::Gaussian;
pub(crate) use profile::Profile;
pub use quartic::QuarticSpline;
pub use quintic::QuinticSpline;
pub use wendland_c2::WendlandC2;
pub use wendland_c4::WendlandC4;
pub use wendland_c6::WendlandC6;

use crate::scalar::Lane;
use core::fmt::{self, Debug};
use core::str::FromStr;

/// A smoothing kernel in `D` dimensions.
///
#[doc = include_str!("../../docs/equations/kernel.html")]
///
/// The two methods are generic over a [`Lane`], so one text serves a single pair and a whole row of
/// pairs. Both must be finite at q = 0 and exactly zero from [`support`](Kernel::support) on.
///
/// Mark them, and every function that they call, `#[inline(always)]`. The pair loop is compiled for wider
/// instructions than the rest of a program, and what is not inlined into it runs without them, several times
/// slower.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a smoothing kernel in {D} dimensions",
    note = "implement `Kernel<{D}>`: `shape`, `slope_over_q` and the numbers; see the `kernel` module for an example"
)]
pub trait Kernel<const D: usize>: Copy + Debug + Send + Sync + 'static {
    /// Whether the shape is chosen at run time, by a branch in the pair loop; such a loop is not
    /// compiled for wider instruction sets.
    const CHOSEN_AT_RUN_TIME: bool = false;

    /// The kernel's name in reports.
    fn name(&self) -> &'static str;
    /// Radius of the support in units of h.
    fn support(&self) -> f64;
    /// Normalisation σ_D such that W integrates to one.
    fn normalisation(&self) -> f64;
    /// Recommended ratio of smoothing length to spacing, h/dx.
    fn h_over_dx(&self) -> f64;
    /// The ratios h/dx that the builder accepts; above the upper bound particles pair.
    fn h_over_dx_range(&self) -> (f64, f64);
    /// Stable step of an undamped leapfrog in units of h/c on a lattice at the recommended h/dx.
    fn stable_step(&self) -> f64;

    /// What is wrong with its parameters, as `(field, value, what it must be)`; empty if nothing.
    ///
    /// Beside it every scene checks that support and h/dx are numbers that a lattice can have, that the shape ends
    /// at the support, that shape and slope integrate to one within a hundredth, and that the stable step is none with which
    /// waves along an axis of a lattice grow.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }

    /// The shape f(q), q ≥ 0.
    fn shape<L: Lane>(&self, q: L) -> L;
    /// The slope divided by q, f′(q)/q, q ≥ 0; finite at q = 0.
    fn slope_over_q<L: Lane>(&self, q: L) -> L;
    /// `scale` f′(q)/q at q = `r` `inverse_h`, where the pair loop needs it: a kernel that can fold the two
    /// constants into its own saves products.
    #[inline(always)]
    fn gradient<L: Lane>(&self, r: L, inverse_h: L, scale: L) -> L {
        scale * self.slope_over_q(r * inverse_h)
    }
}

/// Calls a macro with the list of all kernels, as `Type "name on the command line"` separated by
/// commas. Every test, benchmark and menu that runs over all kernels takes them from here.
///
/// ```
/// macro_rules! names {
///     ($($Kernel:ident $name:literal),*) => { [$($name),*] };
/// }
/// let names = meshfree::for_each_kernel!(names);
/// assert!(names.contains(&"wendland-c2"));
/// ```
#[macro_export]
macro_rules! for_each_kernel {
    ($callback:ident) => {
        $callback! {
            CubicSpline "cubic",
            QuarticSpline "quartic",
            QuinticSpline "quintic",
            WendlandC2 "wendland-c2",
            WendlandC4 "wendland-c4",
            WendlandC6 "wendland-c6",
            Gaussian "gaussian"
        }
    };
}

macro_rules! kernel_kind {
    ($($Kernel:ident $name:literal),*) => {
        /// The kernels by name, for command lines and files.
        ///
        /// A kind is itself a kernel: a program that takes the kernel from its user is compiled
        /// once, with a branch in the pair loop where a program for one kernel has none.
        ///
        /// ```
        /// use meshfree::kernel::{Kernel, KernelKind};
        /// let kind: KernelKind = "quintic".parse().unwrap();
        /// assert_eq!(Kernel::<2>::support(&kind), 3.0);
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub enum KernelKind {
            $(
                #[doc = concat!("[`", stringify!($Kernel), "`](struct@", stringify!($Kernel), "), `", $name, "` on a command line.")]
                $Kernel,
            )*
        }

        impl KernelKind {
            /// All kernels.
            pub const ALL: &'static [Self] = &[$(Self::$Kernel),*];

            /// The name on a command line, such as `wendland-c2`.
            #[must_use]
            pub const fn key(self) -> &'static str {
                match self {
                    $(Self::$Kernel => $name,)*
                }
            }
        }

        kind_is_kernel! { 1: $($Kernel),* }
        kind_is_kernel! { 2: $($Kernel),* }
        kind_is_kernel! { 3: $($Kernel),* }
    };
}

macro_rules! kind_is_kernel {
    ($D:literal: $($Kernel:ident),*) => {
        impl Kernel<$D> for KernelKind {
            const CHOSEN_AT_RUN_TIME: bool = true;
            fn name(&self) -> &'static str {
                match self { $(Self::$Kernel => Kernel::<$D>::name(&$Kernel),)* }
            }
            #[inline(always)]
            fn support(&self) -> f64 {
                match self { $(Self::$Kernel => Kernel::<$D>::support(&$Kernel),)* }
            }
            #[inline(always)]
            fn normalisation(&self) -> f64 {
                match self { $(Self::$Kernel => Kernel::<$D>::normalisation(&$Kernel),)* }
            }
            fn h_over_dx(&self) -> f64 {
                match self { $(Self::$Kernel => Kernel::<$D>::h_over_dx(&$Kernel),)* }
            }
            fn h_over_dx_range(&self) -> (f64, f64) {
                match self { $(Self::$Kernel => Kernel::<$D>::h_over_dx_range(&$Kernel),)* }
            }
            fn stable_step(&self) -> f64 {
                match self { $(Self::$Kernel => Kernel::<$D>::stable_step(&$Kernel),)* }
            }
            // Called, not copied into every loop: a choice at run time is paid at run time.
            #[inline(never)]
            fn shape<L: Lane>(&self, q: L) -> L {
                match self { $(Self::$Kernel => Kernel::<$D>::shape(&$Kernel, q),)* }
            }
            #[inline(never)]
            fn slope_over_q<L: Lane>(&self, q: L) -> L {
                match self { $(Self::$Kernel => Kernel::<$D>::slope_over_q(&$Kernel, q),)* }
            }
        }
    };
}
for_each_kernel!(kernel_kind);

impl fmt::Display for KernelKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.key())
    }
}

/// A kernel name that is not in [`KernelKind::ALL`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown kernel `{given}`; known are {}", known_kernels())]
pub struct UnknownKernel {
    /// The name that was given.
    pub given: String,
}

fn known_kernels() -> String {
    let names: Vec<_> = KernelKind::ALL.iter().map(|kind| kind.key()).collect();
    names.join(", ")
}

impl FromStr for KernelKind {
    type Err = UnknownKernel;
    fn from_str(text: &str) -> Result<Self, UnknownKernel> {
        let wanted = text.trim().to_ascii_lowercase().replace(['_', ' '], "-");
        let found = Self::ALL.iter().find(|kind| kind.key() == wanted);
        found.copied().ok_or_else(|| UnknownKernel {
            given: text.to_owned(),
        })
    }
}

/// Implements [`Kernel`] in the listed dimensions from the file's `shape` and `slope_over_q`, or
/// from the functions named for that dimension.
macro_rules! family {
    ($Kernel:ident, $name:literal, support $support:literal; $(
        $D:literal => { normalisation: $normalisation:expr, h_over_dx: $h_over_dx:literal,
            range: $range:expr, stable_step: $stable_step:literal
            $(, shape: $shape:ident, slope_over_q: $slope:ident)?
            $(, gradient: $gradient:ident)? };
    )*) => {
        $(impl $crate::kernel::Kernel<$D> for $Kernel {
            fn name(&self) -> &'static str {
                $name
            }
            #[inline(always)]
            fn support(&self) -> f64 {
                $support
            }
            #[inline(always)]
            fn normalisation(&self) -> f64 {
                #[allow(unused_imports)]
                use core::f64::consts::PI;
                $normalisation
            }
            fn h_over_dx(&self) -> f64 {
                $h_over_dx
            }
            fn h_over_dx_range(&self) -> (f64, f64) {
                $range
            }
            fn stable_step(&self) -> f64 {
                $stable_step
            }
            #[inline(always)]
            fn shape<L: $crate::scalar::Lane>(&self, q: L) -> L {
                $crate::kernel::first_function!($($shape,)? shape)(q)
            }
            #[inline(always)]
            fn slope_over_q<L: $crate::scalar::Lane>(&self, q: L) -> L {
                $crate::kernel::first_function!($($slope,)? slope_over_q)(q)
            }
            $(
                #[inline(always)]
                fn gradient<L: $crate::scalar::Lane>(&self, r: L, inverse_h: L, scale: L) -> L {
                    $gradient(r, inverse_h, scale)
                }
            )?
        })*
    };
}
macro_rules! first_function {
    ($first:ident $(, $rest:ident)*) => {
        $first
    };
}
use {family, first_function};

/// q held at the edge q = 2, and t = 1 − q/2: the variables of the Wendland polynomials. Holding q
/// makes t exactly zero outside and every product finite, however far the particles are apart.
#[inline(always)]
fn inside<L: Lane>(q: L) -> (L, L) {
    let q = q.min(L::of(2.0));
    (q, q.mul_add(L::of(-0.5), L::one()))
}

/// What a kernel says about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct KernelFacts {
    /// Its name.
    pub name: &'static str,
    /// Support in units of h.
    pub support: f64,
    /// Recommended h/dx.
    pub h_over_dx: f64,
    /// Accepted h/dx.
    pub range: (f64, f64),
    /// Stable step of an undamped leapfrog in h/c.
    pub stable_step: f64,
}

impl KernelFacts {
    pub(crate) fn of<const D: usize>(kernel: &impl Kernel<D>) -> Self {
        Self {
            name: kernel.name(),
            support: kernel.support(),
            h_over_dx: kernel.h_over_dx(),
            range: kernel.h_over_dx_range(),
            stable_step: kernel.stable_step(),
        }
    }
}
