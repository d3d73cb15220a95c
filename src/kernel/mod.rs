//! Smoothing kernels: the trait, and one file for each family.
//! W(r, h) = σ_D h⁻ᴰ f(q) with q = r/h; the gradient is F r_ij with F = σ_D h⁻ᴰ⁻² f′(q)/q.

use crate::scalar::Lane;
use core::fmt::Debug;

/// A smoothing kernel in `D` dimensions.
///
/// ```math
/// W(r, h) = (σ_D / h^D) f(q),   q = r / h
/// ```
///
/// The two methods are generic over a [`Lane`], so one text serves a single pair and a whole row of
/// pairs. Both must be finite at q = 0 and exactly zero from [`SUPPORT`](Kernel::SUPPORT) on.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a smoothing kernel in {D} dimensions",
    note = "implement `Kernel<{D}>`: `shape`, `slope_over_q` and the constants; see the `kernel` module for an example"
)]
pub trait Kernel<const D: usize>: Copy + Debug + Send + Sync + 'static {
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

    /// The shape f(q), q ≥ 0.
    fn shape<L: Lane>(&self, q: L) -> L;
    /// The slope divided by q, f′(q)/q, q ≥ 0; finite at q = 0.
    fn slope_over_q<L: Lane>(&self, q: L) -> L;
}
