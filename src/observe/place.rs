//! Where an observer stands: a checked place in the scene as built, at rest or on a wall.
//! A place that no particle can come near is an error and not a reading of zero.

use crate::boundary::Pose;
use crate::error::{Error, Problem, Result};
use crate::scalar::Real;
use crate::simulation::{Simulation, Which, find};

/// A place in the scene as built.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place<const D: usize> {
    pub name: String,
    pub point: [f64; D],
    /// The index of the wall that it moves with.
    pub wall: Option<usize>,
    /// Names of the walls of the scene.
    pub walls: Vec<String>,
}

impl<const D: usize> Place<D> {
    /// At `point` \[m\], or anywhere on the line through it along an axis.
    pub fn new<T: Real>(
        simulation: &Simulation<T, D>,
        name: &str,
        point: [f64; D],
        line: Option<usize>,
    ) -> Result<Self> {
        let reach = 2.0 * simulation.sampling_length();
        // Without walls liquid can come anywhere, but not out of all proportion.
        let mut extent = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        for x in simulation.all().map(|particle| particle.position()) {
            for d in 0..D {
                extent[0][d] = extent[0][d].min(x[d]);
                extent[1][d] = extent[1][d].max(x[d]);
            }
        }
        let size = (0..D).fold(reach, |size, d| size.max(extent[1][d] - extent[0][d]));
        let nearby = |d: usize, x: f64| {
            let far = FARTHEST * size;
            simulation.domain.is_some()
                || size.is_nan()
                || (extent[0][d] - far <= x && x <= extent[1][d] + far)
        };
        for (d, &x) in point.iter().enumerate() {
            if !x.is_finite() {
                return Err(refused(name, "position", x, "it must be finite, in metres"));
            }
            let inside = |[low, high]: [[f64; D]; 2]| low[d] - reach <= x && x <= high[d] + reach;
            if line != Some(d) && !nearby(d, x) {
                let must_be = "it must be within a thousand times the size of the scene, in metres";
                return Err(refused(name, &format!("coordinate {d}"), x, must_be));
            }
            if line != Some(d) && !simulation.domain.is_none_or(inside) {
                let must_be =
                    "it must be near the bodies and walls of the scene as built, in metres";
                return Err(refused(name, &format!("coordinate {d}"), x, must_be));
            }
        }
        Ok(Self {
            name: name.into(),
            point,
            wall: None,
            walls: simulation.walls().map(Into::into).collect(),
        })
    }

    /// The same place on a wall.
    pub fn on_wall(self, wall: &impl Which) -> Result<Self> {
        let (index, ()) = find(wall, "wall", self.walls.iter().map(|name| (name, ())))?;
        Ok(Self {
            wall: Some(index),
            ..self
        })
    }

    /// Where its wall is now; as built in a simulation that does not have it.
    pub fn pose<T: Real>(&self, simulation: &Simulation<T, D>) -> Pose<D> {
        let pose = self.wall.map(|wall| simulation.wall_pose(wall));
        pose.and_then(Result::ok).unwrap_or_else(Pose::rest)
    }
}

/// How far from the particles of an open scene a place may be, over their extent.
const FARTHEST: f64 = 1e3;

/// What a normal must be.
pub(super) const DIRECTION: &str = "it must be finite and not zero";

/// What is wrong with an observer.
pub(super) fn refused(name: &str, what: &str, value: f64, must_be: &'static str) -> Error {
    Error::Argument(Problem::Parameter {
        what: format!("{what} of observer `{name}`"),
        value,
        must_be,
    })
}
