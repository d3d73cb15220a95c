//! What boundaries make of particles at the start: images that are somewhere and of the same size, each of them once.
//! Two planes that make one image twice double what acts on a particle, and nothing else would tell.

use super::limits::MOST_IMAGES;
use super::parameter;
use crate::boundary::Boundary;
use crate::error::Problem;
use crate::scalar::Real;
use crate::scene::Scene;
use crate::sweep::Transform;
use crate::tensor::Matrix;

/// What R Rᵀ of a rotation R may be off one, in `f32` too.
const ROTATION: f64 = 1e-5;

/// Share of the spacing within which two images are at one place.
const SAME_PLACE: f64 = 1e-2;

/// Boundaries of a scene: where one looks for what a point is behind of, each is a bit.
const MOST_BOUNDARIES: usize = 64;

/// Images of images that a scene with couplings can have: with the number of a particle they number a pair in 64 bits.
const MOST_NUMBERED: f64 = u32::MAX as f64;

impl<T: Real, const D: usize> Scene<T, D> {
    /// More boundaries than can be told apart.
    pub(super) fn check_boundary_count(&self, problems: &mut Vec<Problem>) {
        let count = self.boundaries.len();
        if count > MOST_BOUNDARIES {
            let must_be =
                "it must be at most 64: a wall of many faces is made of particles (Scene::wall)";
            problems.push(parameter("number of boundaries", count as f64, must_be));
        }
        let each = self.boundaries.iter().map(|own| own.images() as f64 + 1.0);
        let all: f64 = each.product();
        if !self.couplings.is_empty() && all > MOST_NUMBERED {
            let must_be = "it must be below 2³² where bodies are coupled, as of 31 planes: make walls of many faces of \
                           particles (Scene::wall)";
            problems.push(parameter(
                "number of images of images of a particle",
                all,
                must_be,
            ));
        }
    }

    /// Transforms that are none.
    pub(super) fn check_transforms(&self, problems: &mut Vec<Problem>) {
        for boundary in &self.boundaries {
            if boundary.images() > MOST_IMAGES {
                continue;
            }
            for image in 0..boundary.images() {
                let by = boundary.transform(image, 0.0);
                let what =
                    |of: &str| format!("{of} of image {image} of the {} at t = 0", boundary.name());
                if let Some(value) = by.to_scalar::<T>().not_finite() {
                    let must_be =
                        "rotation, shift and velocity must be finite numbers of the scalar";
                    problems.push(parameter(&what("transform"), value, must_be));
                    break;
                }
                let off = by.rotation * by.rotation.transpose() - Matrix::<f64, D>::identity();
                let most = off.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                if most > ROTATION {
                    let must_be = "R Rᵀ must be the identity to rounding: images of another size exert forces \
                    without reaction";
                    problems.push(parameter(
                        &what("R Rᵀ − 1 of the rotation R"),
                        most,
                        must_be,
                    ));
                    break;
                }
                if by.rotation == Matrix::<f64, D>::identity() && by.shift.iter().all(|s| *s == 0.0)
                {
                    let must_be = "it must not be zero: the image would coincide with its particle";
                    problems.push(parameter(&what("shift"), 0.0, must_be));
                    break;
                }
            }
        }
    }

    /// Boundaries that make the images of others again: the same plane twice, or one close behind another.
    pub(super) fn check_images(&self, problems: &mut Vec<Problem>) {
        for (k, second) in self.boundaries.iter().enumerate() {
            for first in &self.boundaries[..k] {
                if let Some(x) = self.imaged_twice(first.as_ref(), second.as_ref()) {
                    problems.push(Problem::Incompatible {
                        what: format!(
                            "the {} and the {} lie on the same side of the particle at {x:?} m, and both make \
                             images of it there",
                            first.name(),
                            second.name()
                        ),
                        remedy: "give each plane or period once, and remove what lies behind another: its image \
                        would act twice",
                    });
                }
            }
        }
    }

    /// A particle of which two boundaries make the same image, or images behind each other.
    fn imaged_twice(&self, first: &dyn Boundary<D>, second: &dyn Boundary<D>) -> Option<[f64; D]> {
        let [from, other] = [first, second].map(|own| own.images());
        let pairs = (0..from).flat_map(|i| (0..other).map(move |j| (i, j)));
        let [of_first, of_second] = [first, second].map(|own| {
            let all = (0..own.images()).map(|image| own.transform(image, 0.0));
            all.collect::<Vec<Transform<f64, D>>>()
        });
        for (i, j) in pairs {
            let [a, b] = [&of_first[i], &of_second[j]];
            // Periods are looked at by themselves.
            if a.rotation == Matrix::<f64, D>::identity() || !is_near(&a.rotation, &b.rotation) {
                continue;
            }
            for (reach, spacing, x) in self.particles_and_reaches() {
                let [y, z] = [a, b].map(|by| by.point(&x));
                let apart = (0..D).map(|d| (y[d] - z[d]).powi(2)).sum::<f64>();
                let same = apart.sqrt() < SAME_PLACE * spacing;
                let behind = second.crossed(&y, 0.0) && first.crossed(&z, 0.0);
                let near = first.reaches(i, &x, reach, 0.0) && second.reaches(j, &x, reach, 0.0);
                if near && (same || behind) {
                    return Some(x);
                }
            }
        }
        None
    }

    /// The particles of bodies, with how far their kernels reach and their spacing \[m\].
    fn particles_and_reaches(&self) -> impl Iterator<Item = (f64, f64, [f64; D])> {
        self.parts.iter().flat_map(|part| {
            let in_spacings = part.scheme.kernel.support * part.scheme.h_over_dx;
            part.bodies.iter().flat_map(move |body| {
                let own = body.spacing;
                body.points
                    .iter()
                    .map(move |x| (in_spacings * own, own, *x))
            })
        })
    }
}

/// Whether two matrices are the same to rounding.
fn is_near<const D: usize>(a: &Matrix<f64, D>, b: &Matrix<f64, D>) -> bool {
    let off = *a - *b;
    off.iter().all(|x| x.abs() < ROTATION)
}
