//! Flow through a plane: the mass beyond it, what has left through outlets included.
//! The rate is the change of that mass between two readings.

use crate::scalar::Real;
use crate::simulation::Simulation;

/// A plane that liquid flows through.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowPlane<const D: usize> {
    point: [f64; D],
    normal: [f64; D],
    last: Option<(f64, f64)>,
}

impl<const D: usize> FlowPlane<D> {
    /// Through `point` \[m\]; `normal` points to the side whose mass counts.
    #[must_use]
    pub fn new(point: [f64; D], normal: [f64; D]) -> Self {
        Self {
            point,
            normal,
            last: None,
        }
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
        let inside: f64 = simulation
            .all()
            .filter(|particle| beyond(particle.position()))
            .map(|particle| particle.mass())
            .sum();
        inside + simulation.removed().mass
    }

    /// Mass flow \[kg/s\] since the last reading; zero at the first.
    pub fn mass_flow<T: Real>(&mut self, simulation: &Simulation<T, D>) -> f64 {
        let now = (simulation.time(), self.mass_beyond(simulation));
        let before = self.last.replace(now);
        match before {
            Some((time, mass)) if now.0 > time => (now.1 - mass) / (now.0 - time),
            _ => 0.0,
        }
    }
}
