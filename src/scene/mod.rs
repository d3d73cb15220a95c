//! Scenes: what there is, what it is made of, and what acts on it, named by the user.
//! Building a scene checks everything at once and yields a simulation.
//!
//! A [`Scene`] starts from a scheme and takes [bodies](Body), [boundaries](crate::boundary), an
//! [integrator](crate::integrator) and loads. [`Scene::build`] then
//!
//! 1. runs every check and reports all problems together, each with what to do,
//! 2. lays out one column for each field that the scheme or a contact names,
//! 3. finds neighbours and takes the sums at rest: a body at rest is free of stress from here on,
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

mod body;
mod check;

pub use body::{Body, Start};

use crate::boundary::{Boundary, Emitter, Inlet, Outlet, Wall};
use crate::error::{BuildError, Error, Problem, Result};
use crate::integrator::{Integrator, KickDriftKick};
use crate::particles::{Columns, Field, Fields};
use crate::scalar::Real;
use crate::scheme::{Scheme, Smoothing};
use crate::simulation::{BodyState, Group, Load, Simulation, StepControl, WallState, width};
use crate::sweep::{InstructionSet, Interaction};

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
/// let middle = simulation.body(0).nth(25).map(|particle| particle.pressure());
/// assert!((middle.unwrap_or(0.0) / 353e6 - 1.0).abs() < 0.01);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
pub struct Scene<T: Real, const D: usize> {
    bodies: Vec<Body<T, D>>,
    walls: Vec<Wall<D>>,
    outlets: Vec<Outlet<D>>,
    inlets: Vec<Inlet<D>>,
    boundaries: Vec<Box<dyn Boundary<T, D>>>,
    scheme: Scheme<T, D>,
    integrator: Box<dyn Integrator>,
    contacts: Vec<(String, String, Interaction)>,
    loads: Vec<Load<D>>,
    control: StepControl,
    skin: f64,
    instructions: InstructionSet,
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
            bodies: Vec::new(),
            walls: Vec::new(),
            outlets: Vec::new(),
            inlets: Vec::new(),
            boundaries: Vec::new(),
            scheme,
            integrator: Box::new(KickDriftKick),
            contacts: Vec::new(),
            loads: Vec::new(),
            control,
            skin: DEFAULT_SKIN,
            instructions: InstructionSet::detect(),
        }
    }

    /// Adds a body.
    #[must_use]
    pub fn body(mut self, body: Body<T, D>) -> Self {
        self.bodies.push(body);
        self
    }

    /// Adds a wall of particles, which a scheme of liquids asks for.
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
    pub fn boundary(mut self, boundary: impl Boundary<T, D> + 'static) -> Self {
        self.boundaries.push(Box::new(boundary));
        self
    }

    /// Says what two bodies do to each other. Where nothing is said, they carry compression and open
    /// without tension ([`Interaction::Unilateral`]).
    #[must_use]
    pub fn between(mut self, first: &str, second: &str, interaction: Interaction) -> Self {
        self.contacts
            .push((first.into(), second.into(), interaction));
        self
    }

    /// Chooses the integrator; [`KickDriftKick`] if not given.
    #[must_use]
    pub fn integrator(mut self, integrator: impl Integrator + 'static) -> Self {
        self.integrator = Box::new(integrator);
        self
    }

    /// Chooses an integrator that is already boxed.
    #[must_use]
    pub fn boxed_integrator(mut self, integrator: Box<dyn Integrator>) -> Self {
        self.integrator = integrator;
        self
    }

    /// Adds an acceleration \[m/s²\] that acts on all particles, as a function of time \[s\].
    #[must_use]
    pub fn acceleration(mut self, load: impl Fn(f64) -> [f64; D] + Send + Sync + 'static) -> Self {
        self.loads.push(Box::new(load));
        self
    }

    /// Changes how the time step is chosen.
    #[must_use]
    pub fn steps(mut self, change: impl FnOnce(StepControl) -> StepControl) -> Self {
        self.control = change(self.control);
        self
    }

    /// The skin of the neighbour lists in units of the kernel's support; 0.1 if not given. A thicker
    /// skin makes lists longer and their builds rarer; results differ in rounding only, but for what a scheme of
    /// [two criteria](crate::scheme::LiquidBuilder::dual_criteria) renews with the lists.
    #[must_use]
    pub fn skin(mut self, skin: f64) -> Self {
        self.skin = skin;
        self
    }

    /// The instruction set of the pair loop; the best that the machine has if not given.
    /// [`InstructionSet::Baseline`] gives the same bits on every machine.
    #[must_use]
    pub fn instructions(mut self, set: InstructionSet) -> Self {
        self.instructions = set;
        self
    }

    /// Checks the scene and makes a simulation of it.
    ///
    /// # Errors
    /// [`Error::Build`] with every problem that was found.
    pub fn build(mut self) -> Result<Simulation<T, D>> {
        let problems = self.problems();
        if !problems.is_empty() {
            return Err(Error::Build(BuildError { problems }));
        }
        let domain = self.domain();
        let emitters = self.place_inlets();
        let interactions = self.interactions();
        let unilateral = interactions.contains(&Interaction::Unilateral);
        let mut fields = self.scheme.fields();
        if unilateral {
            fields = fields.union(Fields::of(&[Field::Touching, Field::TouchingSum]));
        }
        let width = width::<T>();
        let counts = self.bodies.iter().map(|body| self.room(body));
        let slots = counts
            .chain(self.walls.iter().map(|wall| wall.points.len()))
            .map(|count| count.next_multiple_of(width))
            .sum();
        let mut columns = Columns::<T, D>::new(fields, slots);
        let mut bodies = Vec::new();
        let mut start = 0;
        for body in &self.bodies {
            let own = start..start + body.points.len();
            let end = (start + self.room(body)).next_multiple_of(width);
            for slot in start..end {
                self.place(
                    &mut columns,
                    body,
                    slot,
                    (slot - start).min(body.points.len() - 1),
                );
            }
            let ids = start..start + self.room(body);
            start = end;
            bodies.push(BodyState {
                name: body.name.clone(),
                material: body.material.clone(),
                ids,
                slots: own,
                end: start,
                spacing: body.spacing,
            });
        }
        let mut walls = Vec::new();
        for wall in &self.walls {
            let own = start..start + wall.points.len();
            start = own.end.next_multiple_of(width);
            for slot in own.start..start {
                self.place_wall(&mut columns, wall, slot);
            }
            walls.push(WallState {
                name: wall.name.clone(),
                slots: own,
                end: start,
                rest: wall.points.clone(),
                motion: wall.motion.clone(),
                slip: wall.slip,
                sliding: wall.sliding,
                carries: wall.carries,
                mass: self.wall_mass(wall),
            });
        }
        let widest = bodies
            .iter()
            .fold(0.0_f64, |most, body| most.max(body.spacing));
        let h = self.scheme.h_over_dx * widest;
        let skin = self.skin * self.scheme.kernel.support * h;
        let fixed = self.control.fixed;
        let mut group = Group::new(
            columns,
            bodies,
            walls,
            self.boundaries,
            self.scheme,
            interactions,
            h,
            skin,
        );
        group.instructions = self.instructions;
        group.outlets = self.outlets;
        group.emitters = emitters;
        group.domain = domain;
        for body in &group.bodies {
            for id in body.slots.end..body.ids.end {
                group.slot_of[id] = u32::MAX;
            }
        }
        group.take_reference();
        let mut simulation = Simulation::new(group, self.integrator, self.control, self.loads);
        simulation.evaluate()?;
        let vote = simulation.vote()?;
        match fixed {
            Some(step) if step > vote.step => Err(Error::Build(BuildError {
                problems: vec![Problem::StepAboveLimit {
                    step,
                    limit: vote.step,
                    criterion: vote.criterion.name(),
                }],
            })),
            _ => Ok(simulation),
        }
    }

    /// Writes particle `k` of a body into a slot.
    fn place(&self, columns: &mut Columns<T, D>, body: &Body<T, D>, slot: usize, k: usize) {
        let (x, start) = (body.points[k], body.starts[k]);
        let rounded = x.map(T::from_f64);
        columns.vectors_mut(Field::Position)[slot] = rounded;
        if columns.fields().contains(Field::PositionResidual) {
            columns.vectors_mut(Field::PositionResidual)[slot] =
                core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
        }
        columns.vectors_mut(Field::Velocity)[slot] = start.velocity.map(T::from_f64);
        let mut set = |field: Field, value: f64| {
            if let Some(place) = columns.raw_mut(field).get_mut(slot) {
                *place = T::from_f64(value);
            }
        };
        set(Field::Density, start.density);
        set(Field::ReferenceDensity, start.density);
        set(Field::Mass, start.density * body.spacing.powi(D as i32));
        set(Field::Energy, start.energy);
        let viscosity = body
            .material
            .rheology()
            .map_or(0.0, |law| law.viscosity(0.0));
        set(Field::DynamicViscosity, viscosity);
        set(Field::SmoothingLength, self.scheme.h_over_dx * body.spacing);
        set(
            Field::ViscosityCoefficient,
            self.scheme.starting_coefficient(),
        );
    }

    /// Particles that a body can have: those that it starts with, and what inlets may add.
    fn room(&self, body: &Body<T, D>) -> usize {
        let inlets = self.inlets.iter().filter(|inlet| inlet.body == body.name);
        body.points.len() + inlets.map(|inlet| inlet.reserve).sum::<usize>()
    }

    /// Puts a buffer behind every inlet, and returns what hands its layers over.
    fn place_inlets(&mut self) -> Vec<(usize, Emitter<D>)> {
        let reach = self.scheme.kernel.support * self.scheme.h_over_dx;
        let mut emitters = Vec::new();
        for inlet in &self.inlets {
            let (wall, emitter) = inlet.buffer(reach.ceil() as usize + 1);
            self.walls.push(wall);
            let fed = self.bodies.iter().position(|body| body.name == inlet.body);
            emitters.extend(fed.map(|body| (body, emitter)));
        }
        emitters
    }

    /// The box around bodies and walls \[m\], where walls alone bound the scene.
    fn domain(&self) -> Option<[[f64; D]; 2]> {
        if self.walls.is_empty() || !self.inlets.is_empty() || !self.boundaries.is_empty() {
            return None;
        }
        let bodies = self.bodies.iter().flat_map(|body| &body.points);
        let all = bodies.chain(self.walls.iter().flat_map(|wall| &wall.points));
        let start = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        Some(all.fold(start, |[low, high], x| {
            let corner =
                |of: fn(f64, f64) -> f64, far: [f64; D]| core::array::from_fn(|d| of(far[d], x[d]));
            [corner(f64::min, low), corner(f64::max, high)]
        }))
    }

    /// Mass \[kg\] of a wall particle: its volume, filled with the first liquid at rest.
    fn wall_mass(&self, wall: &Wall<D>) -> f64 {
        let body = self.bodies.first();
        let density = body.map_or(0.0, |body| body.material.reference_density());
        density * wall.spacing.powi(D as i32)
    }

    /// Gives a wall particle what does not change. It has the density of the first liquid at rest: its
    /// volume is what the liquid's pressure acts on.
    fn place_wall(&self, columns: &mut Columns<T, D>, wall: &Wall<D>, slot: usize) {
        let Some(body) = self.bodies.first() else {
            return;
        };
        let density = body.material.reference_density();
        let (_, sound_speed) = body.material.state(density, 0.0);
        let mut set = |field: Field, value: f64| {
            if let Some(place) = columns.raw_mut(field).get_mut(slot) {
                *place = T::from_f64(value);
            }
        };
        set(Field::Density, density);
        set(Field::SoundSpeed, sound_speed);
        set(Field::Mass, self.wall_mass(wall));
        set(Field::SmoothingLength, self.scheme.h_over_dx * wall.spacing);
        // The liquid corrects the gradients; a wall takes them as they are.
        if let Some(rows) = columns
            .raw_mut(Field::Correction)
            .get_mut(slot * D * D..(slot + 1) * D * D)
        {
            for d in 0..D {
                rows[d * (D + 1)] = T::one();
            }
        }
    }

    /// What every block does to every other: bodies, walls, images of bodies by boundary, and images of
    /// each wall by boundary.
    fn interactions(&self) -> Vec<Interaction> {
        if self.scheme.liquid.is_some() {
            return self.liquid_interactions();
        }
        let (bodies, boundaries) = (self.bodies.len(), self.boundaries.len());
        let blocks = bodies + boundaries;
        // Boundaries feel nothing, so their rows name no contact that a scene would pay for.
        let mut all = vec![Interaction::None; blocks * blocks];
        for body in 0..bodies {
            all[body * blocks..body * blocks + bodies].fill(Interaction::Unilateral);
        }
        let index = |name: &str| self.bodies.iter().position(|body| body.name == name);
        for k in 0..blocks {
            all[k * blocks + k] = Interaction::Bonded;
        }
        for (first, second, interaction) in &self.contacts {
            if let (Some(a), Some(b)) = (index(first), index(second)) {
                all[a * blocks + b] = *interaction;
                all[b * blocks + a] = *interaction;
            }
        }
        for (k, boundary) in self.boundaries.iter().enumerate() {
            for body in 0..bodies {
                all[body * blocks + bodies + k] = boundary.interaction();
            }
        }
        all
    }

    /// Liquids act on liquids and walls, and walls ask only for liquids. Nothing opens as a contact
    /// does: the floor of wall pressures and the cut-off of the material let liquids part.
    fn liquid_interactions(&self) -> Vec<Interaction> {
        let (bodies, walls) = (self.bodies.len(), self.walls.len());
        let boundaries = self.boundaries.len();
        let blocks = bodies + walls + boundaries * (1 + walls);
        let is_wall = |block: usize| {
            (bodies..bodies + walls).contains(&block) || block >= bodies + walls + boundaries
        };
        let mut all = vec![Interaction::None; blocks * blocks];
        for on in 0..bodies + walls {
            for from in 0..blocks {
                if !(is_wall(on) && is_wall(from)) {
                    all[on * blocks + from] = Interaction::Bonded;
                }
            }
        }
        let index = |name: &str| self.bodies.iter().position(|body| body.name == name);
        for (first, second, interaction) in &self.contacts {
            if let (Some(a), Some(b), Interaction::None) =
                (index(first), index(second), interaction)
            {
                all[a * blocks + b] = Interaction::None;
                all[b * blocks + a] = Interaction::None;
            }
        }
        all
    }

    fn is_mixed(&self) -> bool {
        let first = self.bodies.first().map_or(0.0, |body| body.spacing);
        // A spacing that is no number has its own problem, and differs from nothing.
        let differs = |spacing: f64| (spacing - first).abs() > 1e-9 * first.abs();
        self.bodies.iter().any(|body| differs(body.spacing))
    }

    fn is_uniform(&self) -> bool {
        self.scheme.smoothing == Smoothing::Fixed
            && !self.scheme.fields().contains(Field::SmoothingLength)
    }
}

/// Default skin in units of the kernel's support.
const DEFAULT_SKIN: f64 = 0.1;
