//! Inlets: openings through which liquid enters at a prescribed velocity.
//! A buffer of moving wall particles stands behind the opening and hands over its front layer.

use super::{Inflow, Motion, OpenBoundary, OpenPlace, Pose, Wall};
use crate::geometry::{MOST_PARTICLES, POSITIVE};
use crate::origin::local;
use crate::tensor::{Vector, length};
use core::fmt;
use std::sync::Arc;

/// An opening through which a body receives particles.
///
/// Behind it stands a buffer as thick as the kernel reaches, which moves with the inflow and has the
/// pressure of the liquid before it. Whenever it has gone one spacing, its front layer becomes liquid
/// and the rest steps back.
///
/// With a velocity that depends on place or time ([`through`](Self::through)) every point of the opening has a column of
/// particles of its own behind it, which hands one over by every spacing that the inflow before it has gone.
///
/// ```
/// use meshfree::boundary::Inlet;
/// use meshfree::prelude::*;
/// let water = catalogue::weakly_compressible_water(1.0);
/// let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.2, 0.1], 0.01))
///     .boundary(Periodic::along(1, 0.0, 0.1))
///     .inlet(Inlet::new("water", (0..10).map(|k| [0.0, 0.01 * (f64::from(k) + 0.5)]).collect(), [1.0, 0.0], 0.01, 200))
///     .build()?;
/// simulation.run_until(0.1)?;
/// assert_eq!(simulation.particles(), 200 + 9 * 10);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone)]
pub struct Inlet<const D: usize> {
    pub(crate) body: String,
    pub(crate) opening: Vec<[f64; D]>,
    /// Its direction alone counts where there is a state.
    pub(crate) velocity: [f64; D],
    pub(crate) spacing: f64,
    pub(crate) reserve: usize,
    /// Velocities that differ by place or time; none if all of it has one.
    pub(crate) state: Option<Arc<dyn OpenBoundary<D>>>,
    /// What carries the opening, if it moves.
    motion: Option<Arc<dyn Motion<D>>>,
}

impl<const D: usize> fmt::Debug for Inlet<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("Inlet");
        all.field("body", &self.body)
            .field("opening", &self.opening)
            .field("velocity", &self.velocity)
            .field("spacing", &self.spacing)
            .field("reserve", &self.reserve);
        // Checkpoints of inlets without one are as they were.
        if let Some(state) = &self.state {
            all.field("state", state);
        }
        if let Some(motion) = &self.motion {
            all.field("motion", motion);
        }
        all.finish()
    }
}

impl<const D: usize> Inlet<D> {
    /// Lets particles of `body` enter at `velocity` \[m/s\] through an `opening`, given as the points
    /// \[m\] of its plane that have a particle each, `spacing` \[m\] apart, which is that of the body.
    /// `reserve` particles can enter, less those that left: memory for them is reserved when the scene is built.
    #[must_use]
    pub fn new(
        body: &str,
        opening: Vec<[f64; D]>,
        velocity: [f64; D],
        spacing: f64,
        reserve: usize,
    ) -> Self {
        Self {
            body: body.into(),
            opening,
            velocity,
            spacing,
            reserve,
            state: None,
            motion: None,
        }
    }

    /// The same with a velocity that a [boundary](OpenBoundary) gives by place and time, as [`FlowRate`](super::FlowRate) and
    /// [`VelocityProfile`](super::VelocityProfile) do; `inwards` points into the liquid, across the opening, and may have any length.
    ///
    /// Particles enter with the pressure of the buffer. The velocity may be zero, and its part along `inwards` must not be negative:
    /// a run in which it is ends with an error.
    ///
    /// ```
    /// use meshfree::boundary::{Inlet, VelocityProfile};
    /// let opening = (0..20).map(|k| [0.0, 0.05 * (f64::from(k) + 0.5)]).collect();
    /// let parabola = VelocityProfile::new(|[_, y]: [f64; 2], _| [6.0 * y * (1.0 - y), 0.0]);
    /// let inlet = Inlet::through("water", opening, [1.0, 0.0], 0.05, 400, parabola);
    /// ```
    #[must_use]
    pub fn through(
        body: &str,
        opening: Vec<[f64; D]>,
        inwards: [f64; D],
        spacing: f64,
        reserve: usize,
        state: impl OpenBoundary<D> + 'static,
    ) -> Self {
        Self {
            state: Some(Arc::new(state)),
            ..Self::new(body, opening, inwards, spacing, reserve)
        }
    }

    /// Lets a rigid motion carry it, as that of the wall that it is in. Opening, velocity, and places and values of a
    /// [boundary](OpenBoundary), are those of the wall as built: liquid enters with this velocity relative to the opening.
    ///
    /// ```
    /// use meshfree::boundary::{Inlet, Translation};
    /// // A nozzle that points down and travels along x at 0.5 m/s.
    /// let nozzle = (0..5).map(|k| [0.01 * (f64::from(k) + 0.5), 0.3]).collect();
    /// let inlet = Inlet::new("water", nozzle, [0.0, -1.0], 0.01, 500)
    ///     .motion(Translation::steady([0.5, 0.0]));
    /// ```
    #[must_use]
    pub fn motion(mut self, motion: impl Motion<D> + 'static) -> Self {
        self.motion = Some(Arc::new(motion));
        self
    }

    /// What carries it, if it moves.
    pub(crate) fn carried(&self) -> Option<&dyn Motion<D>> {
        self.motion.as_deref()
    }

    fn direction(&self) -> [f64; D] {
        let size = length(&Vector::from(self.velocity));
        self.velocity.map(|v| v / size)
    }

    /// The buffer behind the opening, `layers` thick.
    pub(crate) fn buffer(&self, layers: usize) -> Wall<D> {
        let points = (0..layers).flat_map(|k| self.layer(k)).collect();
        let buffer = Wall::of(&format!("inlet of {}", self.body), points, self.spacing);
        if self.state.is_some() {
            return buffer;
        }
        buffer.motion(Uniform::new(self.velocity, self.spacing, 0).carried(self.motion.as_ref()))
    }

    /// What moves a buffer of so many layers, where velocities differ by place or time, for a body of a group.
    pub(crate) fn inflow(
        &self,
        layers: usize,
        fed: (usize, f64),
        origin: &[f64; D],
    ) -> Option<Inflow<D>> {
        let state = (self.state.clone()?, self.direction());
        let size = (self.spacing, layers);
        let inflow = Inflow::new(state, &self.opening, size, fed, origin);
        Some(inflow.carried(self.motion.as_ref(), origin))
    }

    /// A layer of the buffer as built.
    fn layer(&self, k: usize) -> impl Iterator<Item = [f64; D]> {
        let (direction, back) = (self.direction(), (k as f64 + 0.5) * self.spacing);
        let behind = move |x: &[f64; D]| core::array::from_fn(|d| x[d] - back * direction[d]);
        self.opening.iter().map(behind)
    }

    /// What hands layers of its buffer, a wall of a group, to a body there, in places that are counted from an origin \[m\].
    pub(crate) fn emitter(&self, body: usize, wall: usize, origin: &[f64; D]) -> Emitter<D> {
        Emitter {
            body,
            wall,
            front: self.layer(0).map(|x| local(&x, origin)).collect(),
            velocity: self.velocity,
            spacing: self.spacing,
            layers: 0,
            motion: self.motion.clone(),
            origin: *origin,
        }
    }

    /// What is wrong with the velocities at the start.
    fn velocities_at_start(
        &self,
        state: &dyn OpenBoundary<D>,
    ) -> Option<(&'static str, f64, &'static str)> {
        let inwards = self.direction();
        self.opening.iter().find_map(|&position| {
            let at = OpenPlace {
                position,
                time: 0.0,
                inwards,
            };
            let Some(v) = state.velocity(&at) else {
                let must_be =
                    "an inlet needs one: a boundary that gives a pressure alone is for an outlet";
                return Some(("velocity at t = 0", f64::NAN, must_be));
            };
            let along: f64 = (0..D).map(|d| v[d] * inwards[d]).sum();
            let must_be = "it must be finite, in m/s, and point into the liquid or be zero";
            (!along.is_finite() || along < 0.0).then_some(("velocity at t = 0", along, must_be))
        })
    }

    /// What is wrong with it, as `(what, value, what it must be)`.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        let speed = length(&Vector::from(self.velocity));
        if !speed.is_finite() || speed == 0.0 {
            problems.push(match self.state {
                None => ("velocity", speed, "it must be finite and not zero, in m/s"),
                Some(_) => (
                    "direction",
                    speed,
                    "it must be finite and not zero, and point into the liquid",
                ),
            });
        }
        if self.opening.is_empty() {
            problems.push(("opening", 0.0, "it must have at least one point"));
        }
        if let Some(&bad) = self.opening.iter().flatten().find(|x| !x.is_finite()) {
            problems.push(("opening", bad, "its points must be finite, in metres"));
        }
        if !(self.spacing.is_finite() && self.spacing > 0.0) {
            problems.push(("spacing", self.spacing, POSITIVE));
        }
        if self.reserve as f64 > MOST_PARTICLES {
            let must_be = "memory is reserved for all of them: it must be below 4e9 particles";
            problems.push(("reserve", self.reserve as f64, must_be));
        }
        let Some(state) = &self.state else {
            return problems;
        };
        problems.extend(state.problems());
        if problems.is_empty() && state.span()[0] <= 0.0 {
            problems.extend(self.velocities_at_start(&**state));
        }
        problems
    }
}

/// Moves a buffer with the inflow, back by one spacing for every layer handed over, and then as the opening moves.
pub(crate) struct Uniform<const D: usize> {
    velocity: [f64; D],
    back: [f64; D],
    carried: Option<Arc<dyn Motion<D>>>,
}

impl<const D: usize> Uniform<D> {
    fn new(velocity: [f64; D], spacing: f64, layers: u64) -> Self {
        let size = length(&Vector::from(velocity));
        let step = velocity.map(|v| v / size * spacing);
        Self {
            velocity,
            back: step.map(|step| layers as f64 * step),
            carried: None,
        }
    }

    fn carried(self, motion: Option<&Arc<dyn Motion<D>>>) -> Self {
        let carried = motion.cloned();
        Self { carried, ..self }
    }
}

impl<const D: usize> Motion<D> for Uniform<D> {
    fn name(&self) -> String {
        "inflow".into()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        self.pose_from(&[0.0; D], time)
    }
    fn pose_from(&self, origin: &[f64; D], time: f64) -> Pose<D> {
        let shift = Vector::from_fn(|d, _| self.velocity[d] * time - self.back[d]);
        let pose = Pose {
            shift: [shift, Vector::from(self.velocity), Vector::zeros()],
            ..Pose::rest()
        };
        match &self.carried {
            Some(carried) => pose.then(&carried.pose_from(origin, time)),
            None => pose,
        }
    }
    fn span(&self) -> [f64; 2] {
        let always = [f64::NEG_INFINITY, f64::INFINITY];
        self.carried.as_ref().map_or(always, |own| own.span())
    }
    fn resolution(&self) -> Option<f64> {
        self.carried.as_ref()?.resolution()
    }
}

/// What hands over layers of a buffer.
#[derive(Clone, Debug)]
pub(crate) struct Emitter<const D: usize> {
    /// The body that it feeds and the wall that the buffer is, of a group.
    pub body: usize,
    pub wall: usize,
    /// How many layers it has handed over.
    pub layers: u64,
    front: Vec<[f64; D]>,
    velocity: [f64; D],
    spacing: f64,
    motion: Option<Arc<dyn Motion<D>>>,
    /// The place \[m\] in the scene from which those of `front` count.
    origin: [f64; D],
}

impl<const D: usize> Emitter<D> {
    /// How its buffer moves until the next layer is due.
    pub fn inflow(&self) -> Uniform<D> {
        Uniform::new(self.velocity, self.spacing, self.layers).carried(self.motion.as_ref())
    }

    /// Places and velocities of the layer that becomes liquid at `time` \[s\]; `None` before it is due.
    pub fn due(&mut self, time: f64) -> Option<Vec<[[f64; D]; 2]>> {
        let speed = length(&Vector::from(self.velocity));
        let gone = speed * time - self.layers as f64 * self.spacing;
        if gone < self.spacing {
            return None;
        }
        let by = gone / speed;
        self.layers += 1;
        let pose = self.motion.as_ref();
        let pose = pose.map(|motion| motion.pose_from(&self.origin, time));
        let state = |x: &[f64; D]| {
            let x = core::array::from_fn(|d| x[d] + by * self.velocity[d]);
            pose.as_ref()
                .map_or([x, self.velocity], |pose| pose.carries(&x, &self.velocity))
        };
        Some(self.front.iter().map(state).collect())
    }
}
