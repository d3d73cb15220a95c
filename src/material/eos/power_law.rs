//! The power law that Tait's and Murnaghan's equations share.
//! p = (K₀/n) [(ρ/ρ₀)ⁿ − 1].

use super::guard::{Problems, compression, speed};
use super::{EosState, Guards};
use crate::scalar::Lane;

/// Beyond this ρ/ρ₀ the law goes on along its tangent.
pub(super) const GREATEST_RATIO: f64 = 2.0;
/// Whole exponents up to this one are summed, others go through the exponential.
const GREATEST_SUM: f64 = 16.0;

/// Pressure and sound speed of (K₀/n) [(ρ/ρ₀)ⁿ − 1].
#[inline(always)]
pub(super) fn state<L: Lane>(
    density: L,
    reference_density: f64,
    bulk_modulus: f64,
    exponent: f64,
) -> EosState<L> {
    let limit = L::of(GREATEST_RATIO - 1.0);
    let eta = compression(density, reference_density).max(-L::one());
    let held = eta.min(limit);
    let (excess, slope) = power(held, exponent);
    let stiffness = L::of(bulk_modulus / exponent);
    let pressure = (eta - held).mul_add(slope * L::of(bulk_modulus), excess * stiffness);
    let at_rest = (bulk_modulus / reference_density).sqrt();
    let (sound_speed, slow) = speed(slope * L::of(bulk_modulus / reference_density), at_rest);
    let mut guards = Guards::none();
    guards.compression = eta.gt(limit);
    guards.expansion = slow;
    EosState {
        pressure,
        sound_speed,
        guards,
    }
}

/// (1+η)ⁿ − 1 without cancellation, and (1+η)ⁿ⁻¹.
#[inline(always)]
fn power<L: Lane>(eta: L, exponent: f64) -> (L, L) {
    let ratio = eta + L::one();
    if exponent.fract() == 0.0 && (1.0..=GREATEST_SUM).contains(&exponent) {
        // wⁿ − 1 = (w − 1)(1 + w + … + wⁿ⁻¹)
        let (mut sum, mut last) = (L::one(), L::one());
        for _ in 1..exponent as u32 {
            last *= ratio;
            sum += last;
        }
        (eta * sum, last)
    } else {
        // Both with the same rounded ratio: what its rounding changes, the quotient takes back (Kahan, by Higham 2002, sect. 1.14.1).
        let strain = ratio - L::one();
        let rest = strain.le(L::zero()) & strain.ge(L::zero());
        let logarithm = L::select(rest, eta, ratio.ln() * eta / strain);
        let growth = logarithm * L::of(exponent);
        let grown = growth.exp();
        let share = (grown - L::one()) / grown.ln();
        let even = grown.le(L::one()) & grown.ge(L::one());
        let excess = growth * L::select(even, L::one(), share);
        // A void: the logarithm has no limit, and the power is zero.
        let excess = L::select(grown.le(L::zero()), -L::one(), excess);
        (excess, ratio.powf(exponent - 1.0))
    }
}

/// ∫ p/ρ² dρ \[J/kg\] from rest to `ratio` = ρ/ρ₀, with c² = K₀/ρ₀ \[m²/s²\]: for w = ρ/ρ₀ the integral of
/// (wⁿ − 1)/w² over w is (wⁿ⁻¹ − 1)/(n − 1) + 1/w − 1. Beyond the range of the law there is none.
pub(super) fn stored_energy(ratio: f64, c2: f64, exponent: f64) -> Option<f64> {
    if !(ratio > 0.0 && ratio <= GREATEST_RATIO) {
        return None;
    }
    let (strain, power) = (ratio - 1.0, exponent - 1.0);
    // Both parts are ±η to the first order, so each is taken without rounding of its own.
    let growth = if power == 0.0 {
        strain.ln_1p()
    } else {
        (power * strain.ln_1p()).exp_m1() / power
    };
    Some(c2 / exponent * (growth - strain / ratio))
}

/// What both laws ask of their parameters.
pub(super) fn problems(reference_density: f64) -> Problems {
    Problems::default().positive("reference_density", reference_density)
}
