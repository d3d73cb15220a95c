//! Building and resuming, which this crate compiles once for `f64`.
//! What checks a scene and lays it out is a good part of the crate.

use super::Scene;
use crate::error::Result;
use crate::once::compiled_once;
use crate::scalar::Real;
use crate::simulation::Simulation;
#[cfg(feature = "checkpoint")]
use std::path::Path;

/// How a scene becomes a simulation.
pub(super) struct Building<T: Real, const D: usize> {
    pub build: fn(Scene<T, D>) -> Result<Simulation<T, D>>,
    #[cfg(feature = "checkpoint")]
    pub resume: fn(Scene<T, D>, &Path) -> Result<Simulation<T, D>>,
}

impl<T: Real, const D: usize> Building<T, D> {
    const OWN: Self = Self {
        build: Scene::start,
        #[cfg(feature = "checkpoint")]
        resume: Scene::go_on,
    };
}

compiled_once!(Building);
