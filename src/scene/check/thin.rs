//! Total-Lagrangian bodies that are one particle thick: there is no gradient across them, and they bend like a cloth.
//! What images continue is not looked at.

use crate::error::Problem;
use crate::neighbors::Cells;
use crate::scalar::Real;
use crate::scene::{Body, Scene};
use crate::scheme::DensityForm;
use crate::tensor::{Matrix, determinant};

/// How far \[spacings\] a particle looks for others: across the diagonal of a square.
const AROUND: f64 = 1.6;
/// det/(tr/D)^D of the sum of r ⊗ r/r² over neighbours, one where they are all round and zero where they are in a line or
/// plane. A lattice of two layers has 0.9, one layer with particles a tenth of the spacing out of it below 0.1.
const FLAT: f64 = 0.1;
/// Share of particles that may be flat: what stands out of a rough surface.
const ROUGH: f64 = 0.1;

impl<T: Real, const D: usize> Scene<T, D> {
    /// Finds total-Lagrangian bodies that are thinner than two spacings.
    pub(super) fn check_thickness(&self, problems: &mut Vec<Problem>) {
        if D == 1 {
            return;
        }
        for part in &self.parts {
            if part.scheme.density != DensityForm::Deformation {
                continue;
            }
            for body in &part.bodies {
                let flat = self.flat(body);
                if flat as f64 > ROUGH * body.points.len() as f64 {
                    problems.push(Problem::Incompatible {
                        what: format!(
                            "body `{}` is thinner than two spacings ({} m each): {flat} of its {} particles have neighbours \
                             in a line or plane alone, and no gradient across it",
                            body.name,
                            body.spacing,
                            body.points.len()
                        ),
                        remedy: "take a spacing of at most half of its thickness; a body that bends needs five \
                        particles across",
                    });
                }
            }
        }
    }

    /// How many particles have their neighbours in a line or plane.
    fn flat(&self, body: &Body<T, D>) -> usize {
        let reach = AROUND * body.spacing;
        let all: Vec<u32> = (0..body.points.len() as u32).collect();
        let cells = Cells::build(&body.points, &all, reach);
        let continued = |x: &[f64; D]| {
            self.boundaries.iter().any(|boundary| {
                (0..boundary.images()).any(|image| boundary.reaches(image, x, reach, 0.0))
            })
        };
        let is_flat = |x: &&[f64; D]| {
            let mut sum = Matrix::<f64, D>::from_element(0.0);
            cells.for_each_run(x.map(|x| x - reach), x.map(|x| x + reach), |run| {
                for &j in run {
                    let y = &body.points[j as usize];
                    let apart: [f64; D] = core::array::from_fn(|d| y[d] - x[d]);
                    let square: f64 = apart.iter().map(|r| r * r).sum();
                    if square > 0.0 && square < reach * reach {
                        sum += Matrix::from_fn(|a, b| apart[a] * apart[b] / square);
                    }
                }
            });
            let round = determinant(&sum) / (sum.trace() / D as f64).powi(D as i32);
            // One without neighbours has no number here.
            (round.is_nan() || round <= FLAT) && !continued(x)
        };
        body.points.iter().filter(is_flat).count()
    }
}
