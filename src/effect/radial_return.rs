//! The radial return: how far plastic flow goes until the stress has come down to the yield stress.
//! One equation in one unknown, solved to rounding for any hardening, softening and rate.

use crate::material::strength::{PlasticState, Strength};

/// The yield stress \[Pa\] after `more` plastic strain within `dt` \[s\].
pub(super) fn after(law: &dyn Strength, before: &PlasticState, more: f64, dt: f64) -> f64 {
    law.yield_stress(&PlasticState {
        strain: before.strain + more,
        rate: if dt > 0.0 { more / dt } else { 0.0 },
        ..*before
    })
}

/// The plastic strain Δ at which σ − k Δ has come down to the yield stress Y(Δ), and that yield stress \[Pa\]; none
/// where σ is not above it. `trial` is σ \[Pa\], `stiffness` k \[Pa\].
pub(super) fn radial_return(
    trial: f64,
    stiffness: f64,
    yields: impl Fn(f64) -> f64,
) -> Option<[f64; 2]> {
    let first = yields(0.0);
    if trial <= first {
        return None;
    }
    let excess = |strain: f64| trial - stiffness * strain - yields(strain);
    // Beyond it a law that hardens is above the stress; one that softens may go on until no stress is left.
    let mut high = (trial - first) / stiffness;
    let mut above = excess(high);
    let rounding = 4.0 * f64::EPSILON * trial;
    if above > rounding {
        high = trial / stiffness;
        above = excess(high);
    }
    let strain = root(excess, [0.0, trial - first], [high, above], rounding);
    Some([strain, yields(strain)])
}

/// Where a function passes from positive to negative between two places that are not negative: a first secant, then
/// inverse quadratic interpolation where it is safe (Chandrupatla 1997), or bisection. `low` and `high` are places with
/// their values.
fn root(function: impl Fn(f64) -> f64, low: [f64; 2], high: [f64; 2], rounding: f64) -> f64 {
    let ([mut a, mut f_a], [mut b, mut f_b]) = (high, low);
    let mut next = a + f_a / (f_a - f_b) * (b - a);
    for _ in 0..MOST_TRIALS {
        let [best, residual] = smaller([a, f_a], [b, f_b]);
        let least = 2.0 * f64::EPSILON * best;
        if residual.abs() <= rounding || 2.0 * least > (b - a).abs() {
            return best;
        }
        next = next.max(a.min(b) + least).min(a.max(b) - least);
        let f_next = function(next);
        // The end that is given up is the third place of the interpolation.
        let [c, f_c] = if (f_next > 0.0) == (f_a > 0.0) {
            [a, f_a]
        } else {
            let given_up = [b, f_b];
            [b, f_b] = [a, f_a];
            given_up
        };
        [a, f_a] = [next, f_next];
        let along = (a - b) / (c - b);
        let up = (f_a - f_b) / (f_c - f_b);
        next = if up * up < along && (1.0 - up) * (1.0 - up) < 1.0 - along {
            let share = f_a / (f_b - f_a) * f_c / (f_b - f_c)
                + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b);
            a + share * (b - a)
        } else {
            middle(a.min(b), a.max(b))
        };
    }
    smaller([a, f_a], [b, f_b])[0]
}

/// Of two places with their values, that with the smaller one.
fn smaller(first: [f64; 2], second: [f64; 2]) -> [f64; 2] {
    if first[1].abs() < second[1].abs() {
        first
    } else {
        second
    }
}

/// The middle of an interval; of its logarithm where it spans decades, because powers of plastic strain and rate put
/// roots there.
fn middle(low: f64, high: f64) -> f64 {
    if high <= WIDE * low {
        0.5 * (low + high)
    } else if low > 0.0 {
        (low * high).sqrt()
    } else {
        high / WIDE
    }
}

/// Ratio of the ends of an interval above which it is halved in the logarithm.
const WIDE: f64 = 1e3;

/// More than any law of the crate takes, which is two for perfect plasticity and linear hardening, and 27 for what has
/// an infinite slope at zero strain or rate. What is no number stays so and ends the run.
const MOST_TRIALS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::strength::{
        CowperSymonds, DruckerPrager, JohnsonCook, LinearHardening, PerfectPlasticity,
        PowerHardening, SteinbergGuinan, TensionCompression,
    };

    #[test]
    fn linear_hardening_returns_exactly() {
        for modulus in [0.0, 1e9, 1e11] {
            let law = LinearHardening::new(300e6, modulus);
            let before = PlasticState {
                strain: 0.1,
                ..PlasticState::default()
            };
            let trial = 1.3 * law.yield_stress(&before);
            let back = radial_return(trial, 3.0 * 77e9, |more| after(&law, &before, more, 1e-9));
            let [strain, stress] = back.unwrap();
            let exact = (trial - law.yield_stress(&before)) / (3.0 * 77e9 + modulus);
            assert!((strain / exact - 1.0).abs() < 1e-13, "{strain} {exact}");
            assert!((stress / (trial - 3.0 * 77e9 * exact) - 1.0).abs() < 1e-14);
        }
    }

    /// Far and near, slow and fast, for strain that begins and that goes on; calls of the law are counted.
    #[test]
    fn every_law_is_consistent_with_its_stress() {
        let laws: Vec<Box<dyn Strength>> = vec![
            Box::new(PerfectPlasticity::new(0.3e9)),
            Box::new(LinearHardening::new(0.4e9, 0.1e9)),
            Box::new(PowerHardening::new(90e6, 292e6, 0.31)),
            Box::new(
                JohnsonCook::new(90e6, 292e6, 0.31)
                    .with_rate_sensitivity(0.025)
                    .with_softening(1.09, 1356.0),
            ),
            Box::new(CowperSymonds::new(PerfectPlasticity::new(0.3e9), 40.0, 5.0)),
            Box::new(CowperSymonds::new(
                PowerHardening::new(90e6, 292e6, 0.31),
                40.0,
                5.0,
            )),
            Box::new(SteinbergGuinan::new(0.29e9, 0.68e9, 125.0, 0.10)),
            Box::new(DruckerPrager::from_yield_stresses(49e6, 91e6)),
            Box::new(TensionCompression::new(49e6, 91e6)),
        ];
        let (stiffness, mut most) = (3.0 * 46e9, 0);
        for law in &laws {
            for strain in [0.0, 1e-6, 0.3] {
                for (factor, dt) in [(1.0 + 1e-9, 1e-9), (1.001, 1e-9), (1.3, 1e-6), (8.0, 1.0)] {
                    let before = PlasticState {
                        strain,
                        temperature: 500.0,
                        ..PlasticState::default()
                    };
                    let trial = factor * law.yield_stress(&before);
                    let calls = core::cell::Cell::new(0);
                    let yields = |more| {
                        calls.set(calls.get() + 1);
                        after(&**law, &before, more, dt)
                    };
                    let [more, stress] = radial_return(trial, stiffness, yields).unwrap();
                    let left = (trial - stiffness * more) / stress - 1.0;
                    assert!(left.abs() < 1e-12, "{} {left}", law.name());
                    assert!(more >= 0.0 && stress <= trial * (1.0 + 1e-15));
                    most = most.max(calls.get());
                    let below = law.yield_stress(&before) * (1.0 - 1e-9);
                    assert!(radial_return(below, stiffness, yields).is_none());
                }
            }
        }
        println!("most calls of a law {most}");
        assert!(most <= 30, "{most}");
    }

    /// One that loses its strength at once has its root where no stress is left.
    #[test]
    fn a_law_that_softens_has_a_root_too() {
        let brittle = |strain: f64| 1e8 * (-strain / 1e-6).exp();
        let [strain, stress] = radial_return(1.5e8, 3e9, brittle).unwrap();
        assert!(((1.5e8 - 3e9 * strain) - stress).abs() < 1e-6);
        assert!((strain / 0.05 - 1.0).abs() < 1e-6 && stress < 1.0);
        // What is no number stays so.
        let [_, stress] = radial_return(1e8, 3e9, |_| f64::NAN).unwrap();
        assert!(stress.is_nan());
    }
}
