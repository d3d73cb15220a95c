//! Scenes: what there is, what it is made of, and what acts on it, named by the user.
//! Building a scene checks everything at once and yields a simulation.
//!
//! A [`Scene`] starts from a scheme and takes [bodies](Body), [boundaries](crate::boundary), an
//! [integrator](crate::integrator) and loads. [`Scene::build`] then
//!
//! 1. runs every check and reports all problems together, each with what to do,
//! 2. lays out one column for each field that the scheme or a contact names,
//! 3. finds neighbours and takes the reference configuration: a body at rest is free of stress from here on,
//! 4. evaluates once and refuses a fixed step above the stability limit.
//!
//! What two bodies do to each other is [`Interaction::Unilateral`] unless [`Scene::between`] says
//! otherwise: they carry compression and open without tension. Bodies of one material that should act
//! as one are bonded:
//!
//! ```
//! use meshfree::prelude::*;
//! let scene = Scene::<f64, 1>::new(schemes::impact())
//!     .body(Body::block("pad", catalogue::pmma(), [0.000], [0.005], 2e-4))
//!     .body(Body::block("rod", catalogue::copper(), [0.005], [0.015], 2e-4))
//!     .between("pad", "rod", Interaction::Bonded)
//!     .boundary(MirrorPlane::wall([0.015], [1.0]));
//! assert!(scene.problems().is_empty());
//!
//! // Three slips, three messages.
//! let wrong = Scene::<f64, 1>::new(schemes::impact().h_over_dx(0.5))
//!     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], -1e-4))
//!     .between("rod", "pad", Interaction::Bonded);
//! assert_eq!(wrong.problems().len(), 3);
//! ```
//!
//! # Loads
//!
//! | what acts | call | known to walls and density diffusion |
//! |---|---|---|
//! | the same acceleration on all particles, by time: gravity, a frame that is shaken | [`Scene::acceleration`] | yes |
//! | an acceleration by place, velocity, density, body and time: a well, drag, a frame that turns | [`Scene::load`] with [`Load::acceleration`] | no |
//! | a heat source by the same | [`Scene::load`] with [`Load::heating`] | |
//! | either, by the place in the material: where a particle was as built | the same, with [`LoadPoint::as_built`](crate::simulation::LoadPoint::as_built) | no |
//! | either, from an [event](Scene::event) on | the same, with [`LoadPoint::since`](crate::simulation::LoadPoint::since) | no |
//!
//! # Several schemes
//!
//! A scheme is what a group of bodies obeys, and [`Scene::group`] adds bodies with one of their own. A
//! liquid meets solids of other groups as walls that move, and gives back what it feels:
//!
//! | bodies | in one group | in two groups |
//! |---|---|---|
//! | solid and solid | contact, or bonded | do not meet, which the scene has to say |
//! | liquid and liquid | one liquid | do not meet, which the scene has to say |
//! | liquid and solid | no: a liquid needs a scheme of liquids | pressure, and friction with [`Body::no_slip`] |
//!
//! Any two bodies act on each other as a [coupling](crate::coupling) says: contact, ties, or your own
//! ([`Scene::couple`]), and a stiff group takes steps of its own ([`Scene::sub_cycle`]).
//!
//! Parts of a body are clamped by [`Scene::fix`] and [`Scene::clamp`], and a body moves as a rigid one by
//! [`Scene::rigid`], which [`Scene::joint`] joins to others and to the ground. Particles leave by [`Scene::outlet`].
//!
//! A [`MirrorPlane`](crate::boundary::MirrorPlane) holds solids and liquids. Walls of particles ([`Scene::wall`]) hold liquids by
//! the wall law of their scheme, and solids by contact, which has to be named.
//!
//! # Place
//!
//! Where a scene is changes nothing. Places are given and read in `f64`, and a simulation counts them from an origin of its
//! own, [`Simulation::origin`](crate::simulation::Simulation::origin): the middle of the box around all particles of bodies and walls
//! and the openings of inlets, for all groups together. Positions in `f32` are then as exact at map coordinates as anywhere, and
//! a scene that is moved by a whole number of a power of two, of which its places are whole numbers too, has the same bits.
//! Moved by anything else it differs by the rounding of its places in `f64`.
//!
//! | sees places of the scene, in `f64` | sees places counted from the origin |
//! |---|---|
//! | bodies, walls, boundaries, openings, motions, regions of clamps | columns: [`Field::POSITION`](crate::particles::Field::POSITION) and `REFERENCE_POSITION` in [laws](crate::effect::Around::origin) |
//! | [loads](crate::simulation::LoadPoint), [`set_field`](crate::simulation::Simulation::set_field), events | particles of [couplings](crate::coupling::CoupledParticle) |
//! | [particles](crate::simulation::ParticleView) that are read, observers, files, pictures, reports, errors | columns in checkpoints, which hold the origin |
//!
//! Loads by place and [boundaries](crate::boundary::Boundary::seen_from) and [motions](crate::boundary::Motion::pose_from) of your own are
//! asked with the origin added, so that their values have its rounding. How far a scene in `f32` may reach is checked as it is built.

pub mod advice;
mod body;
mod build;
mod check;
mod conversion;
mod coupled;
mod event;
mod exchange;
mod fill;
#[cfg(feature = "checkpoint")]
mod fingerprint;
mod held;
mod joints;
mod numerics;
mod plan;
mod random;
mod resample;
mod sources;
mod state;
mod true_area;

pub use body::{Body, Start};
pub use conversion::{Conversion, Distortion};
#[cfg(feature = "checkpoint")]
pub(crate) use fingerprint::Described;
pub use state::ParticleState;

use crate::boundary::{Boundary, Drain, Inlet, Outlet, Source, Wall};
use crate::coupling::Coupling;
#[cfg(doc)]
use crate::coupling::LiquidStructure;
use crate::integrator::{Integrator, KickDriftKick};
use crate::particles::Fields;
use crate::ranks::Ranks;
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::simulation::{Event, Load, StepControl, UniformLoad};
use crate::sweep::{InstructionSet, Interaction, Root};
use exchange::ExchangeOf;
use held::ClampOf;
use joints::JointOf;
use plan::Plan;
use std::sync::Arc;

/// A scene: bodies, boundaries, a scheme, an integrator, and how parts act on each other.
///
/// ```
/// use meshfree::material::catalogue;
/// use meshfree::scene::{Body, Scene};
/// use meshfree::schemes;
///
/// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
///     .body(Body::block("target", catalogue::copper(), [0.01], [0.05], 2e-4))
///     .build()?;
/// simulation.run_until(2.5e-6)?;
/// let middle = simulation.body("striker")?.nth(25).map(|particle| particle.pressure());
/// assert!((middle.unwrap_or(0.0) / 353e6 - 1.0).abs() < 0.01);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
pub struct Scene<T: Real, const D: usize> {
    /// Bodies by the schemes that they obey, the scene's own first.
    parts: Vec<Part<T, D>>,
    walls: Vec<Wall<D>>,
    outlets: Vec<Outlet<D>>,
    inlets: Vec<Inlet<D>>,
    sources: Vec<Source<D>>,
    drains: Vec<Drain<D>>,
    boundaries: Vec<Arc<dyn Boundary<D>>>,
    integrator: Arc<dyn Integrator>,
    contacts: Vec<(String, String, Interaction)>,
    couplings: Vec<Coupled<T, D>>,
    sub_cycled: Vec<(String, u32)>,
    clamps: Vec<ClampOf<D>>,
    rigid: Vec<String>,
    joints: Vec<JointOf<D>>,
    accelerations: Vec<UniformLoad<D>>,
    loads: Vec<Load<D>>,
    step_ends: Vec<f64>,
    events: Vec<Event<T, D>>,
    exchanges: Vec<ExchangeOf<T, D>>,
    control: StepControl,
    skin: Option<f64>,
    instructions: InstructionSet,
    root: Root,
    memory: Option<u64>,
    /// Ranks that share the memory of this machine.
    ranks_here: u64,
    ranks: Option<Arc<dyn Ranks>>,
}

/// Two bodies, or a body twice, and how they act on each other.
struct Coupled<T: Real, const D: usize> {
    first: String,
    second: String,
    coupling: Arc<dyn Coupling<T, D>>,
    /// Pairs of a body with itself that are nearer than this as built \[m\] do not act.
    exclusion: f64,
}

/// Bodies that share a scheme.
struct Part<T: Real, const D: usize> {
    scheme: Arc<Scheme<T, D>>,
    bodies: Vec<Body<T, D>>,
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// An empty scene whose bodies obey `scheme`.
    #[must_use]
    pub fn new(scheme: impl Into<Scheme<T, D>>) -> Self {
        let scheme = scheme.into();
        let control = StepControl {
            courant: scheme.step_factor,
            ..StepControl::default()
        };
        Self {
            parts: vec![Part {
                scheme: Arc::new(scheme),
                bodies: Vec::new(),
            }],
            walls: Vec::new(),
            outlets: Vec::new(),
            inlets: Vec::new(),
            sources: Vec::new(),
            drains: Vec::new(),
            boundaries: Vec::new(),
            integrator: Arc::new(KickDriftKick),
            contacts: Vec::new(),
            couplings: Vec::new(),
            sub_cycled: Vec::new(),
            clamps: Vec::new(),
            rigid: Vec::new(),
            joints: Vec::new(),
            accelerations: Vec::new(),
            loads: Vec::new(),
            step_ends: Vec::new(),
            events: Vec::new(),
            exchanges: Vec::new(),
            control,
            skin: None,
            instructions: InstructionSet::detect(),
            root: Root::detect(),
            memory: None,
            ranks_here: 1,
            ranks: None,
        }
    }

    /// Adds a body that obeys the scene's scheme.
    #[must_use]
    pub fn body(mut self, body: Body<T, D>) -> Self {
        self.parts[0].bodies.push(body);
        self
    }

    /// Adds bodies that obey a scheme of their own: a group, with columns, neighbour lists and sweeps of
    /// its own, of which no other group carries anything.
    ///
    /// A liquid meets the bodies of a group without liquids, its structures, as walls that move, with
    /// [`Body::no_slip`] as walls that it sticks to. What a structure feels is what the liquid feels with
    /// the opposite sign, pair by pair, so momentum is kept to rounding. Its particles must not be farther
    /// apart than those of the liquid. [`Interaction::None`] between two bodies takes the coupling away;
    /// two liquids, or two structures, can only be in different groups with it.
    ///
    /// All groups take the smallest step that any of them asks for; the factor of
    /// [`StepControl::courant`] is that of the scene's own scheme, and for another group at most what its
    /// scheme allows.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// // Two millimetres of water are struck by a copper plate at 10 m/s, in one dimension.
    /// let water = catalogue::weakly_compressible_water(200.0);
    /// let mut simulation = Scene::<f64, 1>::new(schemes::weakly_compressible())
    ///     .body(Body::block("water", water, [0.0], [0.002], 2e-5))
    ///     .group(schemes::impact(), [
    ///         Body::block("plate", catalogue::copper(), [-0.001], [0.0], 2e-5).velocity([10.0]),
    ///     ])
    ///     .build()?;
    /// let before = simulation.ledger().whole.momentum[0];
    /// simulation.run_until(1e-6)?;
    /// let after = simulation.ledger();
    /// assert!((after.whole.momentum[0] / before - 1.0).abs() < 1e-12);
    /// assert!(after.bodies[0].1.momentum[0] > 0.0, "the water has begun to move");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn group(
        mut self,
        scheme: impl Into<Scheme<T, D>>,
        bodies: impl IntoIterator<Item = Body<T, D>>,
    ) -> Self {
        self.parts.push(Part {
            scheme: Arc::new(scheme.into()),
            bodies: bodies.into_iter().collect(),
        });
        self
    }

    /// Adds a wall of particles. Liquids meet it by the wall law of their scheme, and solids by a contact that
    /// [`couple`](Self::couple) names, the body first and the wall second. A scene in which a solid could move and nothing is
    /// said of it and a wall is not built; [`between`](Self::between) with [`Interaction::None`] says that they never meet.
    ///
    /// A wall does not yield, so contact with it is twice as stiff as with a body like the solid. Its mass is infinite to
    /// the [coupling](crate::coupling), and what it takes up is in [`wall_force`], [`wall_impulse`] and [`force_between`].
    /// Where it moves, what it works on the solid is the opposite of the second number of
    /// [`Contact::work`](crate::simulation::Contact). Friction sticks to its particles where it moves or turns, and is dragged
    /// along where its surface [slides](Wall::sliding).
    ///
    /// [`wall_force`]: crate::simulation::Simulation::wall_force
    /// [`wall_impulse`]: crate::simulation::Simulation::wall_impulse
    /// [`force_between`]: crate::simulation::Simulation::force_between
    ///
    /// ```
    /// use meshfree::coupling::ContactDensity;
    /// use meshfree::error::Problem;
    /// use meshfree::material::eos::Linear;
    /// use meshfree::prelude::*;
    /// // A rigid brick lies on a floor of particles.
    /// let scene = || {
    ///     let stone = Material::new("stone", Linear::new(2000.0, 20.0));
    ///     let floor = Wall::around("floor", [-0.1, 0.0], [0.3, 0.2], 0.02, 3, [[false; 2], [true, false]]);
    ///     Scene::<f64, 2>::new(schemes::impact_by_continuity())
    ///         .body(Body::block("brick", stone, [0.0; 2], [0.2, 0.1], 0.02))
    ///         .rigid("brick")
    ///         .wall(floor)
    ///         .acceleration(|t| [0.0, -9.81 * (t / 0.05).min(1.0)])
    /// };
    /// assert!(matches!(scene().problems()[..], [Problem::ContactNotNamed { .. }]));
    /// let mut simulation = scene().couple("brick", "floor", ContactDensity::new().friction(0.3)).build()?;
    /// simulation.run_until(0.2)?;
    /// let weight = 2000.0 * 0.2 * 0.1 * 9.81;
    /// assert!((simulation.wall_force("floor")?[1] / -weight - 1.0).abs() < 0.1);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn wall(mut self, wall: Wall<D>) -> Self {
        self.walls.push(wall);
        self
    }

    /// Adds an inlet, through which particles enter.
    #[must_use]
    pub fn inlet(mut self, inlet: Inlet<D>) -> Self {
        self.inlets.push(inlet);
        self
    }

    /// Adds an outlet, beyond which particles leave.
    #[must_use]
    pub fn outlet(mut self, outlet: Outlet<D>) -> Self {
        self.outlets.push(outlet);
        self
    }

    /// Adds a boundary.
    #[must_use]
    pub fn boundary(mut self, boundary: impl Boundary<D> + 'static) -> Self {
        self.boundaries.push(Arc::new(boundary));
        self
    }

    /// Says what two bodies do to each other. Where nothing is said, they carry compression and open
    /// without tension ([`Interaction::Unilateral`]). Of bodies in different [groups](Scene::group), and of a solid and a
    /// [wall](Scene::wall) of particles, one can only say that they do nothing, [`Interaction::None`].
    #[must_use]
    pub fn between(mut self, first: &str, second: &str, interaction: Interaction) -> Self {
        self.contacts
            .push((first.into(), second.into(), interaction));
        self
    }

    /// Says how two bodies act on each other. Where nothing is said a liquid meets a solid of another
    /// [group](Scene::group) by [`LiquidStructure`], bodies of one group meet by their kernels
    /// ([`between`](Self::between)), and all others do not meet, which the scene has to say. The kernels of two bodies of one
    /// group do not meet where a coupling acts, unless `between` says that they do. The second may be a
    /// [wall of particles](Self::wall), of which the first, a solid, is not seen otherwise.
    ///
    /// Two bodies may have several couplings. They start apart: no nearer than 0.6 mean spacings.
    #[must_use]
    pub fn couple(
        mut self,
        first: &str,
        second: &str,
        coupling: impl Coupling<T, D> + 'static,
    ) -> Self {
        self.couplings.push(Coupled {
            first: first.into(),
            second: second.into(),
            coupling: Arc::new(coupling),
            exclusion: 0.0,
        });
        self
    }

    /// Says how a body acts on itself where it folds: by a coupling between pairs of its particles that were at least
    /// `exclusion` \[m\] apart as built. That must be no less than the [reach](Coupling::reach) of the coupling, which is
    /// 2.6 spacings with [`ContactDensity`](crate::coupling::ContactDensity) and one with
    /// [`Penalty`](crate::coupling::Penalty), or the body would press on itself from the start. With
    /// [`Tied`](crate::coupling::Tied), which holds together what is near as built, it is zero.
    ///
    /// It is for solids. A scheme whose kernels follow the present neighbours feels what folds by them as well.
    #[must_use]
    pub fn couple_self(
        mut self,
        body: &str,
        exclusion: f64,
        coupling: impl Coupling<T, D> + 'static,
    ) -> Self {
        self.couplings.push(Coupled {
            first: body.into(),
            second: body.into(),
            coupling: Arc::new(coupling),
            exclusion,
        });
        self
    }

    /// Lets the group of a body take `count` equal steps in each step of the others. What couplings do to it comes in
    /// [impulses](crate::coupling#sub-cycling) at the kicks of the others, also with one step. It gains where a solid's sound
    /// is much faster than that of the liquid around it, and needs an integrator that kicks and drifts.
    ///
    /// The steps of the others are at most `count` times the stable step of the group: where that sets them,
    /// [`Simulation::last_vote`](crate::simulation::Simulation::last_vote) names a particle of the group. An integrator whose step
    /// has several drifts, as [`DriftKickDrift`](crate::integrator::DriftKickDrift), divides the steps among them; an odd count
    /// then becomes the next even one.
    ///
    /// A liquid that meets walls or structures steps with the others.
    #[must_use]
    pub fn sub_cycle(mut self, body: &str, count: u32) -> Self {
        self.sub_cycled.push((body.into(), count));
        self
    }

    /// Adds an acceleration \[m/s²\] that acts on all particles, as a function of time \[s\]: gravity, or that of the
    /// frame. Walls and density diffusion know it.
    #[must_use]
    pub fn acceleration(
        mut self,
        acceleration: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        self.accelerations.push(Arc::new(acceleration));
        self
    }

    /// Adds a load: an acceleration or a heat source that depends on place, velocity, density, body and time.
    #[must_use]
    pub fn load(mut self, load: Load<D>) -> Self {
        self.loads.push(load);
        self
    }

    /// Fields of a group: those of its scheme, and those of the loads on its bodies.
    fn fields_of(&self, scheme: &Scheme<T, D>, bodies: &[Body<T, D>]) -> Fields {
        let acts = |load: &&Load<D>| bodies.iter().any(|body| load.acts_on(&body.name));
        let own = self.loads.iter().filter(acts).map(Load::field);
        own.fold(scheme.fields(), |all, field| {
            all.union(Fields::of(&[field]))
        })
    }

    /// All bodies, those of the scene's own scheme first.
    fn bodies(&self) -> impl Iterator<Item = &Body<T, D>> {
        self.parts.iter().flat_map(|part| &part.bodies)
    }

    /// What was said of two bodies.
    fn said_between(&self, first: &str, second: &str) -> Option<Interaction> {
        let meant = |(a, b, _): &&(String, String, Interaction)| {
            (a == first && b == second) || (a == second && b == first)
        };
        self.contacts.iter().rfind(meant).map(|contact| contact.2)
    }
}
