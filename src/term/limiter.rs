//! What linear reconstruction from both sides leaves of a jump between two particles.
//! Christensen 1990; Frontiere, Raskin & Owen 2017, sect. 3.4; limiter after van Leer 1979.

use crate::scalar::Lane;

/// The jump qᵢ − qⱼ less φ ½ (∇qᵢ + ∇qⱼ)·rᵢⱼ, of which the products with rᵢⱼ are given: φ = min(1, 2 min(x, 1/x)) with x the
/// ratio of the two, and zero if they differ in sign. What is left never has the opposite sign.
///
/// Lane text and no generic function: what is not inlined into a pair loop runs without its instructions.
#[inline(always)]
pub(crate) fn left_of_jump<L: Lane>(jump: L, at_i: L, at_j: L) -> L {
    let product = at_i * at_j;
    let (small, large) = (at_i.abs().min(at_j.abs()), at_i.abs().max(at_j.abs()));
    let same_sign = product.gt(L::zero());
    let ratio = small / L::select(same_sign, large, L::one());
    let limiter = L::select(same_sign, (ratio + ratio).min(L::one()), L::zero());
    let left = jump - limiter * L::of(0.5) * (at_i + at_j);
    let same_side = (left * jump).gt(L::zero());
    L::select(same_side, left, L::zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_leaves_nothing_and_a_step_leaves_all() {
        // A difference of 3 with slopes that say 3, with slopes of a factor of two, and with one slope of none.
        assert_eq!(left_of_jump(3.0, 3.0, 3.0), 0.0);
        assert_eq!(left_of_jump(3.0, 2.0, 4.0), 0.0);
        assert_eq!(left_of_jump(3.0, 0.0, 3.0), 3.0);
        assert_eq!(left_of_jump(3.0, -1.0, 3.0), 3.0);
        // A ratio of 1/4 takes half of the mean slope.
        assert_eq!(left_of_jump(3.0, 1.0, 4.0), 3.0 - 0.25 * 5.0);
        // Slopes that are too steep turn no jump around.
        assert_eq!(left_of_jump(3.0, 8.0, 8.0), 0.0);
        assert_eq!(left_of_jump(-3.0, -1.0, -1.0), -2.0);
    }
}
