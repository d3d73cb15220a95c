//! Mirror planes: rigid walls and planes of symmetry, exact by construction.
//! Every particle near the plane sees its reflection, and what would cross becomes it (Lam, Shen & Gong 2002, 4.1).

use super::Boundary;
use crate::origin::local;
use crate::sweep::{Interaction, Transform};
use crate::tensor::{Matrix, Vector, length};
use std::sync::Arc;

/// A plane that reflects positions and velocities.
///
#[doc = include_str!("../../docs/equations/mirror.html")]
///
/// p is a point of the plane, n its unit normal, out of the material, and w its velocity.
/// As a [wall](MirrorPlane::wall) it lets bodies separate; as a plane of
/// [symmetry](MirrorPlane::symmetry) it carries tension too. Slip along the plane is free.
#[derive(Clone, Debug, PartialEq)]
pub struct MirrorPlane<const D: usize> {
    point: [f64; D],
    normal: [f64; D],
    velocity: f64,
    interaction: Interaction,
}

impl<const D: usize> MirrorPlane<D> {
    /// A rigid wall through `point` \[m\]; `normal` points out of the material and need not have
    /// unit length. Bodies press against it and leave it freely.
    #[must_use]
    pub fn wall(point: [f64; D], normal: [f64; D]) -> Self {
        let size = length(&Vector::from(normal));
        let normal = normal.map(|n| n / size);
        Self {
            point,
            normal,
            velocity: 0.0,
            interaction: Interaction::Unilateral,
        }
    }

    /// A plane of symmetry through `point` \[m\]; `normal` points out of the material.
    #[must_use]
    pub fn symmetry(point: [f64; D], normal: [f64; D]) -> Self {
        Self {
            interaction: Interaction::Bonded,
            ..Self::wall(point, normal)
        }
    }

    /// The same plane, moving along its normal at `velocity` \[m/s\], negative into the material.
    #[must_use]
    pub fn moving(self, velocity: f64) -> Self {
        Self { velocity, ..self }
    }

    /// How far a point is along the normal \[m\].
    fn height(&self, x: &[f64; D]) -> f64 {
        (0..D).map(|d| x[d] * self.normal[d]).sum()
    }

    /// How far the plane is along its normal \[m\].
    fn offset(&self, time: f64) -> f64 {
        (0..D).map(|d| self.point[d] * self.normal[d]).sum::<f64>() + self.velocity * time
    }
}

impl<const D: usize> Boundary<D> for MirrorPlane<D> {
    fn name(&self) -> String {
        match self.interaction {
            Interaction::Unilateral => "wall".into(),
            _ => "symmetry plane".into(),
        }
    }
    fn images(&self) -> usize {
        1
    }
    fn transform(&self, _image: usize, time: f64) -> Transform<f64, D> {
        let unit = |a: usize, b: usize| f64::from(u8::from(a == b));
        let n = &self.normal;
        let along = |size: f64| Vector::from_fn(|a, _| 2.0 * size * n[a]);
        Transform {
            rotation: Matrix::from_fn(|a, b| unit(a, b) - 2.0 * n[a] * n[b]),
            shift: along(self.offset(time)),
            velocity: along(self.velocity),
        }
    }
    fn reaches(&self, _image: usize, x: &[f64; D], reach: f64, time: f64) -> bool {
        self.offset(time) - self.height(x) < reach
    }
    fn moves(&self) -> bool {
        self.velocity != 0.0
    }
    fn crossed(&self, x: &[f64; D], time: f64) -> bool {
        self.height(x) > self.offset(time)
    }
    fn interaction(&self) -> Interaction {
        self.interaction
    }
    fn seen_from(&self, origin: &[f64; D]) -> Option<Arc<dyn Boundary<D>>> {
        Some(Arc::new(Self {
            point: local(&self.point, origin),
            ..self.clone()
        }))
    }
    fn problems(&self, _reach: f64) -> Vec<(&'static str, f64, &'static str)> {
        let finite = self.normal.iter().chain(&self.point).all(|x| x.is_finite());
        if finite && self.velocity.is_finite() {
            return Vec::new();
        }
        vec![(
            "point, normal or velocity",
            f64::NAN,
            "all must be finite and the normal not zero",
        )]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflection_is_its_own_inverse_and_keeps_the_plane() {
        let plane = MirrorPlane::wall([0.5, 0.0, 1.0], [1.0, 2.0, -2.0]);
        let mirror: Transform<f64, 3> = plane.transform(0, 0.0);
        let x = [0.2, -0.4, 0.9];
        let back = mirror.point(&mirror.point(&x));
        for d in 0..3 {
            assert!((back[d] - x[d]).abs() < 1e-15);
        }
        let on_plane = mirror.point(&[0.5, 0.0, 1.0]);
        assert!((on_plane[0] - 0.5).abs() < 1e-15 && (on_plane[2] - 1.0).abs() < 1e-15);
    }
}
