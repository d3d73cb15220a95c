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
        all.finish()
    }
}

impl<const D: usize> Inlet<D> {
    /// Lets particles of `body` enter at `velocity` \[m/s\] through an `opening`, given as the points
    /// \[m\] of its plane that have a particle each, `spacing` \[m\] apart, which is that of the body.
    /// `reserve` particles can enter, less those that left: memory for them is kept from the start.
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
        buffer.motion(Uniform::new(self.velocity, self.spacing, 0))
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
        Some(Inflow::new(state, &self.opening, size, fed, origin))
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
            let must_be = "memory for it is kept from the start: it must stay below 4e9 particles";
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

/// Moves a buffer with the inflow, and back by one spacing for every layer handed over.
pub(crate) struct Uniform<const D: usize> {
    velocity: [f64; D],
    back: [f64; D],
}

impl<const D: usize> Uniform<D> {
    fn new(velocity: [f64; D], spacing: f64, layers: u64) -> Self {
        let size = length(&Vector::from(velocity));
        let step = velocity.map(|v| v / size * spacing);
        Self {
            velocity,
            back: step.map(|step| layers as f64 * step),
        }
    }
}

impl<const D: usize> Motion<D> for Uniform<D> {
    fn name(&self) -> String {
        "inflow".into()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        let shift = Vector::from_fn(|d, _| self.velocity[d] * time - self.back[d]);
        Pose {
            shift: [shift, Vector::from(self.velocity), Vector::zeros()],
            ..Pose::rest()
        }
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
}

impl<const D: usize> Emitter<D> {
    /// How its buffer moves until the next layer is due.
    pub fn inflow(&self) -> Uniform<D> {
        Uniform::new(self.velocity, self.spacing, self.layers)
    }

    /// The layer that becomes liquid at `time` \[s\], with its velocity; `None` before it is due.
    pub fn due(&mut self, time: f64) -> Option<(Vec<[f64; D]>, [f64; D])> {
        let speed = length(&Vector::from(self.velocity));
        let gone = speed * time - self.layers as f64 * self.spacing;
        if gone < self.spacing {
            return None;
        }
        let by = gone / speed;
        let moved = |x: &[f64; D]| core::array::from_fn(|d| x[d] + by * self.velocity[d]);
        self.layers += 1;
        Some((self.front.iter().map(moved).collect(), self.velocity))
    }
}
