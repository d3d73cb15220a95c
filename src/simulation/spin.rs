//! How a structure turns at each of its particles, for liquid that sticks to it.
//! A wall of the scene has its motion for that.

use crate::neighbors::Cells;
use crate::tensor::Matrix;
use nalgebra::{Matrix3, Vector3};

/// Distance in spacings up to which particles as built are neighbours.
const NEAR: f64 = 1.8;

/// Stretch beyond which two particles are no longer neighbours: after fracture, or on both sides of a period.
const FRACTURED: f64 = 2.0;

/// Share of the largest moment of the neighbours below which they do not tell how they turn about an axis.
const FLAT: f64 = 1e-6;

/// The spin of each particle of a structure; nothing where liquid slips.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spins<const D: usize> {
    /// Numbers of the neighbours of each particle as built, one after the other, and where those of each begin.
    neighbors: Vec<u32>,
    starts: Vec<usize>,
    /// Distance \[m\] beyond which neighbours do not count.
    reach: f64,
    /// Velocity gradients \[1/s\] of rotations, ∂vₐ/∂x_b in row a.
    pub gradients: Vec<Matrix<f64, D>>,
}

/// A vector in three dimensions; rotation in a plane is about the third.
pub(super) fn raised<const D: usize>(vector: &[f64; D]) -> Vector3<f64> {
    Vector3::from_fn(|d, _| vector.get(d).copied().unwrap_or(0.0))
}

impl<const D: usize> Spins<D> {
    /// Of particles at `points` \[m\] as built.
    pub fn new(points: &[[f64; D]], spacing: f64) -> Self {
        let near = NEAR * spacing;
        let all: Vec<u32> = (0..points.len() as u32).collect();
        let cells = Cells::build(points, &all, near);
        let mut own = Self {
            reach: FRACTURED * near,
            gradients: vec![Matrix::<f64, D>::zeros(); points.len()],
            ..Self::default()
        };
        for (i, x) in points.iter().enumerate() {
            own.starts.push(own.neighbors.len());
            let first = own.neighbors.len();
            let [low, high] = [-near, near].map(|by| x.map(|x| x + by));
            cells.for_each_run(low, high, |run| {
                let is_near = |&j: &u32| {
                    let other = &points[j as usize];
                    let r2: f64 = (0..D).map(|d| (other[d] - x[d]).powi(2)).sum();
                    j as usize != i && r2 < near * near
                };
                own.neighbors.extend(run.iter().copied().filter(is_near));
            });
            own.neighbors[first..].sort_unstable();
        }
        own.starts.push(own.neighbors.len());
        own
    }

    /// Finds them from place \[m\] and velocity \[m/s\] of each particle by its number, if it is there: the rotation that is nearest
    /// to how its neighbours move relative to it, Σ (r² − r ⊗ r) ω = Σ r × v by least squares.
    ///
    /// Of a rigid body it is the spin. Where all neighbours stand in one line in space there is none.
    pub fn find(&mut self, particle: impl Fn(usize) -> Option<([f64; D], [f64; D])>) {
        for (i, gradient) in self.gradients.iter_mut().enumerate() {
            *gradient = Matrix::<f64, D>::zeros();
            let Some((x, v)) = particle(i) else {
                continue;
            };
            let (mut moments, mut turning) = (Matrix3::zeros(), Vector3::zeros());
            let own = self.starts[i]..self.starts[i + 1];
            for (there, speed) in self.neighbors[own]
                .iter()
                .filter_map(|&j| particle(j as usize))
            {
                let r = raised::<D>(&core::array::from_fn(|d| there[d] - x[d]));
                let apart = r.norm_squared();
                if apart > self.reach * self.reach {
                    continue;
                }
                let moving = raised::<D>(&core::array::from_fn(|d| speed[d] - v[d]));
                moments += Matrix3::identity() * apart - r * r.transpose();
                turning += r.cross(&moving);
            }
            // In a plane the third axis is the only one.
            let spin = if D == 3 {
                let least = FLAT * (moments.trace() / 3.0).powi(3);
                let known = moments.determinant() > least;
                moments
                    .try_inverse()
                    .filter(|_| known)
                    .map(|back| back * turning)
            } else {
                (moments[(2, 2)] > 0.0).then(|| turning / moments[(2, 2)])
            };
            if let Some(spin) = spin {
                let cross = spin.cross_matrix();
                *gradient = Matrix::<f64, D>::from_fn(|a, b| cross[(a, b)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plate one particle thick and a block, which turn and drift.
    #[test]
    fn what_is_rigid_has_its_spin_everywhere() {
        let spin = Vector3::new(0.3, -1.2, 2.0);
        for thick in [1, 3] {
            let points: Vec<[f64; 3]> = (0..5 * 4 * thick)
                .map(|k| [k % 5, k / 5 % 4, k / 20].map(|n| 0.1 * f64::from(n)))
                .collect();
            let mut spins = Spins::new(&points, 0.1);
            spins.find(|i| {
                let v = spin.cross(&Vector3::from(points[i])) + Vector3::new(5.0, 1.0, 0.0);
                Some((points[i], v.into()))
            });
            for gradient in &spins.gradients {
                assert!((gradient - spin.cross_matrix()).norm() < 1e-12);
            }
        }
    }

    #[test]
    fn neighbours_across_a_period_do_not_count() {
        let points = [[0.0, 0.0], [0.1, 0.0], [0.2, 0.0]];
        let mut spins = Spins::new(&points, 0.1);
        let velocity = |x: f64| [0.0, 3.0 * x];
        spins.find(|i| {
            let x = points[i];
            let wrapped = if i == 2 { [x[0] - 9.0, x[1]] } else { x };
            Some((wrapped, velocity(x[0])))
        });
        let expected = Matrix::<f64, 2>::new(0.0, -3.0, 3.0, 0.0);
        assert!((spins.gradients[0] - expected).norm() < 1e-12);
        assert!((spins.gradients[1] - expected).norm() < 1e-12);
        assert_eq!(spins.gradients[2], Matrix::<f64, 2>::zeros());
    }
}
