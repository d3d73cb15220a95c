//! Inlets: openings through which liquid enters at a prescribed velocity.
//! A buffer of moving wall particles stands behind the opening and hands over its front layer.

use super::{Motion, Pose, Wall};
use crate::geometry::{MOST_PARTICLES, POSITIVE};
use crate::origin::local;
use crate::tensor::{Vector, length};

/// An opening through which a body receives particles.
///
/// Behind it stands a buffer as thick as the kernel reaches, which moves with the inflow and has the
/// pressure of the liquid before it. Whenever it has gone one spacing, its front layer becomes liquid
/// and the rest steps back.
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
#[derive(Clone, Debug)]
pub struct Inlet<const D: usize> {
    pub(crate) body: String,
    pub(crate) opening: Vec<[f64; D]>,
    pub(crate) velocity: [f64; D],
    pub(crate) spacing: f64,
    pub(crate) reserve: usize,
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
        }
    }

    fn direction(&self) -> [f64; D] {
        let size = length(&Vector::from(self.velocity));
        self.velocity.map(|v| v / size)
    }

    /// The buffer behind the opening, `layers` thick.
    pub(crate) fn buffer(&self, layers: usize) -> Wall<D> {
        let points = (0..layers).flat_map(|k| self.layer(k)).collect();
        let inflow = Inflow::new(self.velocity, self.spacing, 0);
        Wall::of(&format!("inlet of {}", self.body), points, self.spacing).motion(inflow)
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

    /// What is wrong with it, as `(what, value, what it must be)`.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = Vec::new();
        let speed = length(&Vector::from(self.velocity));
        if !speed.is_finite() || speed == 0.0 {
            problems.push(("velocity", speed, "it must be finite and not zero, in m/s"));
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
        problems
    }
}

/// Moves a buffer with the inflow, and back by one spacing for every layer handed over.
pub(crate) struct Inflow<const D: usize> {
    velocity: [f64; D],
    back: [f64; D],
}

impl<const D: usize> Inflow<D> {
    fn new(velocity: [f64; D], spacing: f64, layers: u64) -> Self {
        let size = length(&Vector::from(velocity));
        let step = velocity.map(|v| v / size * spacing);
        Self {
            velocity,
            back: step.map(|step| layers as f64 * step),
        }
    }
}

impl<const D: usize> Motion<D> for Inflow<D> {
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
    pub fn inflow(&self) -> Inflow<D> {
        Inflow::new(self.velocity, self.spacing, self.layers)
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
