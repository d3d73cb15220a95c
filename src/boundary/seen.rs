//! Boundaries and motions as a simulation sees them, which counts places from an origin of its own.
//! Those that know where they are move by it; for all others places are converted.

use super::{Boundary, Motion, Pose};
use crate::origin::global;
use crate::sweep::{Interaction, Transform};
use crate::tensor::Vector;
use std::sync::Arc;

/// A boundary for places that are counted from an origin \[m\].
pub(crate) fn boundary_from<const D: usize>(
    boundary: &Arc<dyn Boundary<D>>,
    origin: &[f64; D],
) -> Arc<dyn Boundary<D>> {
    if *origin == [0.0; D] {
        return boundary.clone();
    }
    let own = boundary.seen_from(origin);
    own.unwrap_or_else(|| {
        Arc::new(BoundaryFrom {
            boundary: boundary.clone(),
            origin: *origin,
        })
    })
}

/// A motion for places that are counted from an origin \[m\].
pub(crate) fn motion_from<const D: usize>(
    motion: &Arc<dyn Motion<D>>,
    origin: &[f64; D],
) -> Arc<dyn Motion<D>> {
    if *origin == [0.0; D] {
        return motion.clone();
    }
    Arc::new(MotionFrom {
        motion: motion.clone(),
        origin: *origin,
    })
}

/// A boundary that is asked for places of the scene.
#[derive(Debug)]
struct BoundaryFrom<const D: usize> {
    boundary: Arc<dyn Boundary<D>>,
    origin: [f64; D],
}

impl<const D: usize> BoundaryFrom<D> {
    /// x − o = R (x₀ − o) + s + R o − o.
    fn seen(&self, by: Transform<f64, D>) -> Transform<f64, D> {
        let origin = Vector::from(self.origin);
        Transform {
            shift: by.shift + (by.rotation * origin - origin),
            ..by
        }
    }
}

impl<const D: usize> Boundary<D> for BoundaryFrom<D> {
    fn name(&self) -> String {
        self.boundary.name()
    }
    fn images(&self) -> usize {
        self.boundary.images()
    }
    fn transform(&self, image: usize, time: f64) -> Transform<f64, D> {
        self.seen(self.boundary.transform(image, time))
    }
    fn reaches(&self, image: usize, x: &[f64; D], reach: f64, time: f64) -> bool {
        let x = global(x, &self.origin);
        self.boundary.reaches(image, &x, reach, time)
    }
    fn moves(&self) -> bool {
        self.boundary.moves()
    }
    fn crossed(&self, x: &[f64; D], time: f64) -> bool {
        self.boundary.crossed(&global(x, &self.origin), time)
    }
    fn wrap(&self, x: &[f64; D], time: f64) -> Option<Transform<f64, D>> {
        let by = self.boundary.wrap(&global(x, &self.origin), time);
        by.map(|by| self.seen(by))
    }
    fn interaction(&self) -> Interaction {
        self.boundary.interaction()
    }
    fn problems(&self, reach: f64) -> Vec<(&'static str, f64, &'static str)> {
        self.boundary.problems(reach)
    }
}

/// A motion in places that are counted from an origin.
struct MotionFrom<const D: usize> {
    motion: Arc<dyn Motion<D>>,
    origin: [f64; D],
}

impl<const D: usize> Motion<D> for MotionFrom<D> {
    fn name(&self) -> String {
        self.motion.name()
    }
    fn pose(&self, time: f64) -> Pose<D> {
        self.motion.pose_from(&self.origin, time)
    }
    fn span(&self) -> [f64; 2] {
        self.motion.span()
    }
    fn resolution(&self) -> Option<f64> {
        self.motion.resolution()
    }
}
