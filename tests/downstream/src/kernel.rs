//! A kernel: the bell of L. B. Lucy, Astronomical Journal 82 (1977) 1013–1024, the first of SPH.
//! W = 5/(4 R) (1 + 3 r/R)(1 − r/R)³ in one dimension, with the support R = 2h.

use meshfree::kernel::Kernel;
use meshfree::scalar::Lane;

/// Lucy's kernel in one dimension.
#[derive(Clone, Copy, Debug)]
pub struct Lucy;

/// 1 − q/2 within the support, and q/2.
#[inline(always)]
fn inside<L: Lane>(q: L) -> (L, L) {
    let part = q * L::of(0.5);
    ((L::one() - part).positive_part(), part)
}

impl Kernel<1> for Lucy {
    fn name(&self) -> &'static str {
        "Lucy"
    }
    fn support(&self) -> f64 {
        2.0
    }
    fn normalisation(&self) -> f64 {
        0.625
    }
    fn h_over_dx(&self) -> f64 {
        1.4
    }
    fn h_over_dx_range(&self) -> (f64, f64) {
        (1.2, 2.0)
    }
    fn stable_step(&self) -> f64 {
        1.0
    }
    #[inline(always)]
    fn shape<L: Lane>(&self, q: L) -> L {
        let (t, part) = inside(q);
        part.mul_add(L::of(3.0), L::one()) * t * t * t
    }
    #[inline(always)]
    fn slope_over_q<L: Lane>(&self, q: L) -> L {
        // d/dq of the shape is −12 (q/2) (1 − q/2)² / 2.
        let (t, _) = inside(q);
        t * t * L::of(-3.0)
    }
}
