//! Outlets: planes beyond which particles leave the simulation.
//! What leaves is counted, with its mass and momentum.

/// A plane beyond which particles are removed.
///
/// They leave when neighbour lists are next made, so put the plane a support behind the place where the
/// flow is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlet<const D: usize> {
    pub(crate) point: [f64; D],
    pub(crate) normal: [f64; D],
}

impl<const D: usize> Outlet<D> {
    /// Through `point` \[m\]; `normal` points to where particles leave.
    #[must_use]
    pub fn plane(point: [f64; D], normal: [f64; D]) -> Self {
        Self { point, normal }
    }

    /// Whether a particle at `x` \[m\] has left.
    #[must_use]
    pub fn takes(&self, x: &[f64; D]) -> bool {
        (0..D)
            .map(|d| (x[d] - self.point[d]) * self.normal[d])
            .sum::<f64>()
            > 0.0
    }
}
