//! Inlets: openings through which liquid enters at a prescribed velocity.
//! A buffer of moving wall particles stands behind the opening and hands over its front layer.

use super::{Motion, Pose, Wall};
use crate::geometry::{MOST_PARTICLES, POSITIVE};
use crate::origin::local;
use crate::tensor::{Vector, length};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

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

    /// The buffer behind the opening, `layers` thick, and what hands its layers over in places that are counted from an
    /// origin \[m\].
    pub(crate) fn buffer(&self, layers: usize, origin: &[f64; D]) -> (Wall<D>, Emitter<D>) {
        let direction = self.direction();
        let behind = |x: &[f64; D], k: usize| {
            let back = (k as f64 + 0.5) * self.spacing;
            core::array::from_fn(|d| x[d] - back * direction[d])
        };
        let points = (0..layers)
            .flat_map(|k| self.opening.iter().map(move |x| behind(x, k)))
            .collect();
        let handed_over = Arc::new(AtomicU64::new(0));
        let emitter = Emitter {
            front: (self.opening.iter())
                .map(|x| local(&behind(x, 0), origin))
                .collect(),
            velocity: self.velocity,
            spacing: self.spacing,
            handed_over: Arc::clone(&handed_over),
        };
        let conveyor = Conveyor {
            velocity: self.velocity,
            step: direction.map(|n| n * self.spacing),
            handed_over,
        };
        let name = format!("inlet of {}", self.body);
        let wall = Wall::of(&name, points, self.spacing).motion(conveyor);
        (wall, emitter)
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
struct Conveyor<const D: usize> {
    velocity: [f64; D],
    step: [f64; D],
    handed_over: Arc<AtomicU64>,
}

impl<const D: usize> Motion<D> for Conveyor<D> {
    fn name(&self) -> String {
        "inflow".into()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        let back = self.handed_over.load(Ordering::Relaxed) as f64;
        let (v, step) = (self.velocity, self.step);
        let shift = Vector::from_fn(|d, _| v[d] * time - back * step[d]);
        Pose {
            shift: [shift, Vector::from(v), Vector::zeros()],
            ..Pose::rest()
        }
    }
}

/// What hands over layers of a buffer.
#[derive(Clone, Debug)]
pub(crate) struct Emitter<const D: usize> {
    front: Vec<[f64; D]>,
    velocity: [f64; D],
    spacing: f64,
    handed_over: Arc<AtomicU64>,
}

impl<const D: usize> Emitter<D> {
    /// How many layers it has handed over.
    pub fn handed_over(&self) -> u64 {
        self.handed_over.load(Ordering::Relaxed)
    }

    /// Says how many layers it has handed over, which moves its buffer too.
    pub fn set_handed_over(&self, layers: u64) {
        self.handed_over.store(layers, Ordering::Relaxed);
    }

    /// The layer that becomes liquid at `time` \[s\], with its velocity; `None` before it is due.
    pub fn due(&self, time: f64) -> Option<(Vec<[f64; D]>, [f64; D])> {
        let speed = length(&Vector::from(self.velocity));
        let gone = speed * time - self.handed_over.load(Ordering::Relaxed) as f64 * self.spacing;
        if gone < self.spacing {
            return None;
        }
        let by = gone / speed;
        let moved = |x: &[f64; D]| core::array::from_fn(|d| x[d] + by * self.velocity[d]);
        self.handed_over.fetch_add(1, Ordering::Relaxed);
        Some((self.front.iter().map(moved).collect(), self.velocity))
    }
}
