//! Sources and drains: liquid that enters at points and leaves a region at a rate, without a plane that it flows through.
//! Hoses, rain and filling; pumps and leaks.

use crate::geometry::{MOST_PARTICLES, Shape};
use crate::origin::local;
use std::sync::Arc;

/// A rate in a window of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Supply {
    /// Rate \[kg/s\].
    pub rate: f64,
    /// Begin and end \[s\].
    pub window: [f64; 2],
}

impl Supply {
    const fn new(rate: f64) -> Self {
        let window = [0.0, f64::INFINITY];
        Self { rate, window }
    }
    /// Mass \[kg\] between two times \[s\].
    pub fn between(&self, [from, to]: [f64; 2]) -> f64 {
        let [first, last] = self.window;
        self.rate * (to.min(last) - from.max(first)).max(0.0)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let [from, until] = self.window;
        let mut problems = Vec::new();
        if !(self.rate.is_finite() && self.rate >= 0.0) {
            let must_be = "it must be finite and not negative, in kg/s";
            problems.push(("rate", self.rate, must_be));
        }
        if !from.is_finite() {
            problems.push(("begin", from, "it must be finite, in seconds"));
        }
        if until.is_nan() || until <= from {
            let must_be = "it must be after the begin, in seconds, or infinity";
            problems.push(("end", until, must_be));
        }
        problems
    }
}

/// Points at which particles of a body appear, at a mass flow rate: a hose, rain, a basin that is filled.
///
/// The points take turns. A particle appears, at the density of rest, as soon as half of its mass is due, where nothing
/// is nearer than 0.9 spacings; so what has entered is within half a particle of ∫ rate dt. A source whose points are all
/// covered waits, and ends the run with an error when as many particles wait as it has points: give it more points, a
/// [velocity](Self::velocity), or less. A point that is v fast passes at most one particle in 0.9 dx/v.
///
/// What entered is counted by [`Simulation::entered`](crate::simulation::Simulation::entered). For schemes of liquids; liquid that enters
/// under pressure takes an [`Inlet`](super::Inlet).
///
/// ```
/// use meshfree::boundary::Source;
/// use meshfree::prelude::*;
/// // A hose of 4 cm over a basin, 20 kg/s per metre across.
/// let hose = (0..4).map(|k| [0.18 + 0.01 * (f64::from(k) + 0.5), 0.25]).collect();
/// let water = catalogue::weakly_compressible_water(2.0);
/// let mut basin = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.4, 0.05], 0.01))
///     .wall(Wall::around("basin", [0.0; 2], [0.4, 0.2], 0.01, 3, [[true, true], [true, false]]))
///     .source(Source::new("water", hose, 20.0, 100).velocity([0.0, -1.0]))
///     .acceleration(|_| [0.0, -9.81])
///     .build()?;
/// basin.run_until(0.1)?;
/// assert!((basin.entered().mass - 2.0).abs() < 0.1, "{:?}", basin.entered());
/// assert_eq!(basin.particles(), 200 + basin.entered().particles as usize);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Source<const D: usize> {
    pub(crate) body: String,
    pub(crate) points: Vec<[f64; D]>,
    pub(crate) velocity: [f64; D],
    pub(crate) supply: Supply,
    pub(crate) reserve: usize,
}

impl<const D: usize> Source<D> {
    /// Lets particles of `body` appear at `points` \[m\] at `rate` \[kg/s\], per metre in two dimensions and per square metre in one.
    /// `reserve` particles can enter, less those that left: memory for them is reserved when the scene is built.
    #[must_use]
    pub fn new(body: &str, points: Vec<[f64; D]>, rate: f64, reserve: usize) -> Self {
        Self {
            body: body.into(),
            points,
            velocity: [0.0; D],
            supply: Supply::new(rate),
            reserve,
        }
    }

    /// Sets the velocity \[m/s\] with which particles appear; zero by default.
    #[must_use]
    pub fn velocity(self, velocity: [f64; D]) -> Self {
        Self { velocity, ..self }
    }

    /// Sets begin and end \[s\]; from 0 on by default.
    #[must_use]
    pub fn between(mut self, from: f64, until: f64) -> Self {
        self.supply.window = [from, until];
        self
    }

    /// The same for places that are counted from an origin \[m\].
    pub(crate) fn seen_from(&self, origin: &[f64; D]) -> Self {
        let mut own = self.clone();
        for point in &mut own.points {
            *point = local(point, origin);
        }
        own
    }

    /// What is wrong with it, as `(what, value, what it must be)`.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.supply.problems();
        if self.points.is_empty() {
            problems.push(("number of points", 0.0, "it must have at least one point"));
        }
        if let Some(&bad) = self.points.iter().flatten().find(|x| !x.is_finite()) {
            problems.push(("point", bad, "it must be finite, in metres"));
        }
        if let Some(&bad) = self.velocity.iter().find(|v| !v.is_finite()) {
            problems.push(("velocity", bad, "it must be finite, in m/s"));
        }
        if self.reserve as f64 > MOST_PARTICLES {
            let must_be = "memory is reserved for all of them: it must be below 4e9 particles";
            problems.push(("reserve", self.reserve as f64, must_be));
        }
        problems
    }
}

/// A region that liquid leaves at a mass flow rate: a pump, a leak.
///
/// Whole particles leave, those deepest within the shape first, as soon as half of the mass of one is due: what has left is within half a
/// particle of ∫ rate dt. What is due while the shape holds no particle is not made up for later. Rigid bodies stay. What has left is
/// counted with what outlets took, [`Simulation::removed`](crate::simulation::Simulation::removed).
///
/// A shape should hold some dozens of particles, and the liquid must be able to follow: a particle that leaves is a void of its
/// size, which closes with the speed that pressure gives. With a [cut-off](crate::material::Material::with_pressure_cut_off) liquid under
/// no pressure does not close it.
///
/// ```
/// use meshfree::boundary::Drain;
/// use meshfree::prelude::*;
/// let water = catalogue::weakly_compressible_water(2.0);
/// let mut tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water, [0.0; 2], [0.4, 0.2], 0.01))
///     .wall(Wall::around("tank", [0.0; 2], [0.4, 0.3], 0.01, 3, [[true, true], [true, false]]))
///     .drain(Drain::within(Cuboid::new([0.15, 0.0], [0.25, 0.05]), 20.0))
///     .acceleration(|_| [0.0, -9.81])
///     .build()?;
/// tank.run_until(0.1)?;
/// assert!((tank.removed().mass - 2.0).abs() < 0.06, "{:?}", tank.removed());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Drain<const D: usize> {
    pub(crate) shape: Arc<dyn Shape<D>>,
    pub(crate) supply: Supply,
    pub(crate) body: Option<String>,
}

impl<const D: usize> Drain<D> {
    /// Takes `rate` \[kg/s\] out of a shape, per metre in two dimensions and per square metre in one.
    #[must_use]
    pub fn within(shape: impl Shape<D> + 'static, rate: f64) -> Self {
        Self {
            shape: Arc::new(shape),
            supply: Supply::new(rate),
            body: None,
        }
    }

    /// Limits it to one body, by its name; it takes of all bodies if not given.
    #[must_use]
    pub fn on(self, body: &str) -> Self {
        Self {
            body: Some(body.into()),
            ..self
        }
    }

    /// Sets begin and end \[s\]; from 0 on by default.
    #[must_use]
    pub fn between(mut self, from: f64, until: f64) -> Self {
        self.supply.window = [from, until];
        self
    }

    /// What is wrong with it, as `(what, value, what it must be)`.
    pub(crate) fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.supply.problems();
        problems.extend(self.shape.problems());
        problems
    }
}
