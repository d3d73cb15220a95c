//! Open boundaries: the trait of what liquid has that stands in the buffer of an inlet or an outlet.
//! What a boundary does not say is taken from the liquid inside.

use core::fmt;

/// A particle, or a column of particles, in the buffer of an open boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenPlace<const D: usize> {
    /// Where in the scene \[m\]: the point of the opening before a column of an inlet, the particle itself in an outlet.
    pub position: [f64; D],
    /// When \[s\].
    pub time: f64,
    /// The unit vector into the liquid.
    pub inwards: [f64; D],
}

/// The state of the liquid in the buffer of an open boundary, as a function of place and time.
///
/// | given | to an [`Inlet`](super::Inlet) | to the buffer of an [`Outlet`](super::Outlet) |
/// |---|---|---|
/// | velocity u \[m/s\] | needed: particles enter with it | particles leave with it |
/// | pressure p \[Pa\] | not used | the density of p by the equation of state |
/// | no velocity | the run ends with an error | extrapolated from inside |
/// | no pressure | extrapolated from inside by the law of the walls | the density is extrapolated from inside |
///
/// A subsonic flow has one of the two at each end: where both are given, sound is reflected, and where neither is, nothing
/// fixes the pressure of the liquid (Poinsot & Lele 1992, J. Comput. Phys. 101, 104). [`FlowRate`](super::FlowRate),
/// [`VelocityProfile`](super::VelocityProfile) and [`GivenPressure`](super::GivenPressure) are in the crate.
///
/// ```
/// use meshfree::boundary::{OpenBoundary, OpenPlace};
///
/// /// Water at rest far away, with its surface at a height \[m\].
/// struct Reservoir { surface: f64 }
///
/// impl OpenBoundary<2> for Reservoir {
///     fn name(&self) -> String { format!("reservoir up to {} m", self.surface) }
///     fn pressure(&self, at: &OpenPlace<2>) -> Option<f64> {
///         Some(1000.0 * 9.81 * (self.surface - at.position[1]))
///     }
/// }
/// let at = OpenPlace { position: [3.0, 0.5], time: 0.0, inwards: [-1.0, 0.0] };
/// assert_eq!(Reservoir { surface: 1.5 }.pressure(&at), Some(9810.0));
/// assert_eq!(Reservoir { surface: 1.5 }.velocity(&at), None);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an open boundary in {D} dimensions",
    note = "implement `OpenBoundary<{D}>`: the velocity or the pressure of the liquid in its buffer"
)]
pub trait OpenBoundary<const D: usize>: Send + Sync {
    /// Its name in reports, with its numbers: a checkpoint knows the boundary by it.
    fn name(&self) -> String;
    /// Velocity \[m/s\] of the liquid in the buffer; none if it is that of the liquid inside.
    fn velocity(&self, _at: &OpenPlace<D>) -> Option<[f64; D]> {
        None
    }
    /// Pressure \[Pa\] of the liquid in the buffer; none if it is that of the liquid inside.
    fn pressure(&self, _at: &OpenPlace<D>) -> Option<f64> {
        None
    }
    /// The times \[s\] between which it has a state; always by default. A run that goes beyond ends with an error.
    fn span(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }
    /// An estimate of how far it is from what its rows were taken from, if it is made of rows; none by default.
    /// [`TimeSeries::resolution`](super::TimeSeries::resolution) has it, and [`Scene::advise`](crate::scene::Scene::advise) judges it.
    fn resolution(&self) -> Option<f64> {
        None
    }
    /// What is wrong with it, as `(what, value, what it must be)`.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}

impl<const D: usize> fmt::Debug for dyn OpenBoundary<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

/// What is no number of a boundary within its times.
pub(crate) const BEYOND: &str =
    "the run goes beyond its rows: record it for longer, or end the run before";
