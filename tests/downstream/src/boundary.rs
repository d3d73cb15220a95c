//! A boundary: a glide plane, the symmetry of a staggered row of vortices.
//! One period along x, turned over in y: half of what an ordinary period needs.

use meshfree::boundary::Boundary;
use meshfree::sweep::Transform;
use meshfree::tensor::{Matrix, Vector};

/// Periodic along x from zero to `period` \[m\], and turned over in y by every period.
#[derive(Clone, Copy, Debug)]
pub struct Glide {
    /// The period \[m\].
    pub period: f64,
}

impl Glide {
    /// The image some periods on.
    fn by(&self, periods: f64) -> Transform<f64, 2> {
        let over = if periods as i64 % 2 == 0 { 1.0 } else { -1.0 };
        Transform {
            rotation: Matrix::<f64, 2>::new(1.0, 0.0, 0.0, over),
            shift: Vector::<f64, 2>::new(periods * self.period, 0.0),
            velocity: Vector::<f64, 2>::zeros(),
        }
    }
}

impl Boundary<2> for Glide {
    fn name(&self) -> String {
        format!("glide of period {} m", self.period)
    }
    fn images(&self) -> usize {
        2
    }
    fn transform(&self, image: usize, _time: f64) -> Transform<f64, 2> {
        self.by(if image == 0 { 1.0 } else { -1.0 })
    }
    fn reaches(&self, image: usize, x: &[f64; 2], reach: f64, _time: f64) -> bool {
        let x = x[0];
        if image == 0 {
            x < reach
        } else {
            x > self.period - reach
        }
    }
    fn wrap(&self, x: &[f64; 2], _time: f64) -> Option<Transform<f64, 2>> {
        let periods = (x[0] / self.period).floor();
        (periods != 0.0 && periods.is_finite()).then(|| self.by(-periods))
    }
    fn problems(&self, reach: f64) -> Vec<(&'static str, f64, &'static str)> {
        if self.period.is_finite() && self.period >= 2.0 * reach {
            return Vec::new();
        }
        vec![(
            "period",
            self.period,
            "it must be at least twice the kernel's reach",
        )]
    }
}
