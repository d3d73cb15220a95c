//! A shape: an ellipse.
//! Its distance is a bound, as that of the crate's booleans is.

use meshfree::geometry::Shape;

/// All within (x/a)² + (y/b)² = 1.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse {
    /// a and b \[m\].
    pub half_axes: [f64; 2],
}

impl Shape<2> for Ellipse {
    fn signed_distance(&self, x: &[f64; 2]) -> f64 {
        let [a, b] = self.half_axes;
        // No gradient of the root is greater than one over the shorter axis.
        ((x[0] / a).hypot(x[1] / b) - 1.0) * a.min(b)
    }
    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        (self.half_axes.map(|a| -a), self.half_axes)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let fine = |a: &f64| *a > 0.0;
        let bad = self.half_axes.into_iter().find(|a| !fine(a));
        let must_be = "it must be positive, in metres";
        bad.map(|a| ("half axis of the ellipse", a, must_be))
            .into_iter()
            .collect()
    }
}
