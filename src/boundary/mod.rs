//! Boundaries: the trait, and one file for each kind.
//! A boundary shows particles near it their images; the pair loop meets images like particles.
//!
//! | boundary | what an image is | use it for |
//! |---|---|---|
//! | none | – | free ends and free surfaces |
//! | [`MirrorPlane::wall`] | the reflection, in contact that opens | rigid walls, at rest or moving |
//! | [`MirrorPlane::symmetry`] | the reflection, bonded | half of a symmetric problem |
//! | [`Periodic`] | the copy one period on | waves, homogeneous flow |
//! | [`LeesEdwards`] | the copy one period on, which slides past | homogeneous shear without walls, rheology |
//! | [`Wall`] | – (particles of its own) | tanks, obstacles, pistons of any shape, for liquids |
//! | [`Inlet`] | – (particles enter) | channels, jets |
//! | [`Outlet`] | – (particles leave) | liquid that is driven out, or leaves at a given pressure |
//!
//! Boundaries combine: a later one also shows images of the images of earlier ones, which fills edges
//! and corners. Images are found when neighbour lists are made, and follow their particles until the
//! next time. The momentum that a boundary gives is in the
//! [ledger](crate::simulation::Ledger::boundary_impulse).
//!
//! A wall by reflection is exact in that nothing can cross it: a rod on a wall is half of two rods that
//! meet. What has no pressure, as a cavitated drop, flies through a plane as its image does: the two change
//! places, and the drop is on its side again. Such a wall slips along the plane. Walls of other shapes are
//! [`Wall`]s of particles of their own: they hold liquids, move as [prescribed](Motion), and may deny slip.
//!
//! # Open boundaries
//!
//! An [`OpenBoundary`] gives the liquid in the buffer of an inlet or an outlet its velocity or its pressure.
//!
//! | boundary | gives | to |
//! |---|---|---|
//! | [`VelocityProfile`] | velocity as a function of place and time | [`Inlet::through`] |
//! | [`FlowRate`] | velocity, by the volume that enters in a time | [`Inlet::through`] |
//! | [`GivenPressure`] | pressure; velocity comes from inside | [`Outlet::buffer`] |
//!
//! Flow rates and pressures are numbers, or [`TimeSeries`].
//!
//! # Motions
//!
//! A [`Motion`] moves walls ([`Wall::motion`]) and clamped particles of solids, rigid ones among them
//! ([`Scene::clamp`](crate::scene::Scene::clamp)).
//!
//! | motion | given by |
//! |---|---|
//! | [`Translation`] | functions of time, or a record of acceleration |
//! | [`Rotation`] | an angle as a function of time, about a point or any axis |
//! | [`Crush`] | a strain as a function of time |
//! | [`Recorded`] | rows of time and displacement, or of time and angle |
//! | [`Composed`] | several of them, one after the other |

mod composed;
mod flow_rate;
mod given_pressure;
mod inflow;
mod inlet;
mod lees_edwards;
mod mirror;
mod motion;
mod open;
mod outlet;
mod periodic;
mod recorded;
mod rotation;
mod seen;
mod source;
mod spline;
mod surface;
mod time_series;
mod velocity_profile;
mod wall;

use crate::sweep::{Interaction, Transform};
use core::fmt::Debug;
use std::sync::Arc;

pub use composed::Composed;
pub use flow_rate::FlowRate;
pub use given_pressure::GivenPressure;
pub(crate) use inflow::Inflow;
pub(crate) use inlet::Emitter;
pub use inlet::Inlet;
pub use lees_edwards::LeesEdwards;
pub use mirror::MirrorPlane;
pub use motion::{Crush, Motion, Pose, Translation};
pub(crate) use open::BEYOND;
pub use open::{OpenBoundary, OpenPlace};
pub use outlet::Outlet;
pub use periodic::Periodic;
pub use recorded::Recorded;
pub use rotation::Rotation;
pub(crate) use seen::{boundary_from, motion_from};
pub use source::{Drain, Source};
pub use surface::WallSurface;
pub use time_series::TimeSeries;
pub use velocity_profile::VelocityProfile;
pub use wall::{Slip, Wall};

/// A boundary that acts through images of particles.
///
/// Where nothing is said a body ends freely; a free surface needs no boundary. Places are those of the scene, in `f64`
/// whatever the scalar of the simulation.
///
/// ```
/// use meshfree::boundary::Boundary;
/// use meshfree::sweep::Transform;
/// use meshfree::tensor::{Matrix, Vector};
///
/// /// A glide: periodic along x, and turned over in y by every period.
/// #[derive(Clone, Debug)]
/// struct Glide { period: f64 }
///
/// impl Boundary<2> for Glide {
///     fn name(&self) -> String { format!("glide of period {} m", self.period) }
///     fn images(&self) -> usize { 2 }
///     fn transform(&self, image: usize, _time: f64) -> Transform<f64, 2> {
///         let shift = if image == 0 { self.period } else { -self.period };
///         Transform {
///             rotation: Matrix::<f64, 2>::new(1.0, 0.0, 0.0, -1.0),
///             shift: Vector::<f64, 2>::new(shift, 0.0),
///             velocity: Vector::<f64, 2>::zeros(),
///         }
///     }
///     fn reaches(&self, image: usize, x: &[f64; 2], reach: f64, _time: f64) -> bool {
///         if image == 0 { x[0] < reach } else { x[0] > self.period - reach }
///     }
/// }
/// assert_eq!(Glide { period: 2.0 }.transform(0, 0.0).point(&[0.5, 0.1]), [2.5, -0.1]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a boundary in {D} dimensions",
    note = "implement `Boundary<{D}>`: how many images a particle has, the transform of each, and which particles are near enough to need it"
)]
pub trait Boundary<const D: usize>: Debug + Send + Sync {
    /// Its name in reports.
    fn name(&self) -> String;
    /// How many images a particle can have.
    fn images(&self) -> usize;
    /// The transform that makes image `image` at `time` \[s\]. Its velocity is the rate of its shift.
    fn transform(&self, image: usize, time: f64) -> Transform<f64, D>;
    /// Whether image `image` of a particle at `x` \[m\] lies within `reach` \[m\] of the domain.
    fn reaches(&self, image: usize, x: &[f64; D], reach: f64, time: f64) -> bool;
    /// Whether the boundary moves, so that transforms must be renewed in every step.
    fn moves(&self) -> bool {
        false
    }
    /// Whether a particle at `x` \[m\] is behind the boundary at `time` \[s\]; by default nothing can be.
    ///
    /// When lists are made such a particle becomes its own image 0, which has come out in front as it went in
    /// behind. The momentum that this gives is in the [ledger](crate::simulation::Ledger::boundary_impulse). A body
    /// that starts behind is refused.
    fn crossed(&self, _x: &[f64; D], _time: f64) -> bool {
        false
    }
    /// How a particle at `x` \[m\] that has left at `time` \[s\] re-enters; `None` if it has not left.
    fn wrap(&self, _x: &[f64; D], _time: f64) -> Option<Transform<f64, D>> {
        None
    }
    /// What particles and images do to each other.
    fn interaction(&self) -> Interaction {
        Interaction::Bonded
    }
    /// The same boundary for places that are counted from `origin` \[m\].
    ///
    /// A simulation counts places from an [origin of its own](crate::scene#place), and asks the boundary that this gives.
    /// Without it, it adds the origin to every place that it asks for: right to the rounding of `f64` there. A
    /// boundary that knows where it is gives itself, moved by −`origin`, and so the same bits wherever the scene is.
    fn seen_from(&self, _origin: &[f64; D]) -> Option<Arc<dyn Boundary<D>>> {
        None
    }
    /// What is wrong with the boundary for a kernel that reaches `reach` \[m\].
    fn problems(&self, _reach: f64) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }
}
