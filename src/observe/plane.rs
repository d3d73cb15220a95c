//! Flow through a plane: the mass beyond it, what has left through outlets included.
//! The rate is the change of that mass between two readings.

use super::place::{DIRECTION, refused};
use crate::collective::Collective;
use crate::error::Result;
use crate::scalar::Real;
use crate::simulation::Simulation;
use crate::tensor::{Vector, length};

/// A plane that liquid flows through.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowPlane<const D: usize> {
    point: [f64; D],
    normal: [f64; D],
    last: Option<(f64, f64)>,
}

impl<const D: usize> FlowPlane<D> {
    /// Through `point` \[m\]; `normal` points to the side whose mass counts.
    ///
    /// # Errors
    /// If the point is not finite, or the normal zero or not finite.
    pub fn new(point: [f64; D], normal: [f64; D]) -> Result<Self> {
        if let Some(&bad) = point.iter().find(|x| !x.is_finite()) {
            let must_be = "it must be finite, in metres";
            return Err(refused("flow plane", "position", bad, must_be));
        }
        let size = length(&Vector::from(normal));
        if !(size.is_finite() && size > 0.0) {
            return Err(refused(
                "flow plane",
                "length of the normal",
                size,
                DIRECTION,
            ));
        }
        Ok(Self {
            point,
            normal,
            last: None,
        })
    }

    /// Mass \[kg\] beyond the plane, with what has left through [outlets](crate::boundary::Outlet).
    #[must_use]
    pub fn mass_beyond<T: Real>(&self, simulation: &Simulation<T, D>) -> f64 {
        let beyond = |x: [f64; D]| {
            let height: f64 = (0..D)
                .map(|d| (x[d] - self.point[d]) * self.normal[d])
                .sum();
            height > 0.0
        };
        let mut inside = Collective::new();
        for particle in simulation.all().filter(|own| beyond(own.position())) {
            inside.add(particle.mass());
        }
        inside.value() + simulation.removed().mass
    }

    /// Mass flow \[kg/s\] since the last reading; zero at the first.
    ///
    /// Across a [period](crate::boundary::Periodic) particles come back on the other side of the plane, and mass beyond it
    /// does not grow: along a period a flow is Σ m v·n over the liquid, over the length of the period.
    pub fn mass_flow<T: Real>(&mut self, simulation: &Simulation<T, D>) -> f64 {
        let now = (simulation.time(), self.mass_beyond(simulation));
        let before = self.last.replace(now);
        match before {
            Some((time, mass)) if now.0 > time => (now.1 - mass) / (now.0 - time),
            _ => 0.0,
        }
    }
}
