//! The radial return: how far plastic flow goes until the stress has come down to the yield stress.
//! One equation in one unknown, solved to rounding for any hardening, softening and rate.

use super::{Plasticity, Point, Reach};
use crate::material::StrengthObject;
use crate::material::strength::{PlasticState, ROOM_TEMPERATURE};
use crate::particles::Field;
use crate::scalar::{Lane, OnOwnRows, iterate, on_wide_registers};

/// The state of a point at rest, with its plastic strain, work, pressure and density.
#[inline(always)]
pub(super) fn before<L: Lane, const D: usize, P: Reach>(
    at: &Point<'_, L, D, P>,
) -> PlasticState<L> {
    let material = at.around.material;
    let temperature = material.plastic_heating().map_or_else(
        || L::of(ROOM_TEMPERATURE),
        |own| own.temperature(at.get(Plasticity::WORK)),
    );
    PlasticState {
        strain: at.get(Plasticity::STRAIN),
        rate: L::zero(),
        temperature,
        pressure: at.get(Field::PRESSURE),
        density_ratio: at.get(Field::DENSITY) / L::of(material.reference_density()),
    }
}

/// The yield stress \[Pa\] after `more` plastic strain within `dt` \[s\].
#[inline(always)]
fn after<L: Lane>(law: &dyn StrengthObject, before: &PlasticState<L>, more: L, dt: L) -> L {
    law.yield_stress(&PlasticState {
        strain: before.strain + more,
        rate: L::select(dt.gt(L::zero()), more / dt, L::zero()),
        ..*before
    })
}

/// The yield stress \[Pa\] at no more strain, which all returns of a particle in a step have in common.
#[inline(always)]
pub(super) fn yields_first<L: Lane>(
    law: &dyn StrengthObject,
    before: &PlasticState<L>,
    dt: L,
) -> L {
    after(law, before, L::zero(), dt)
}

/// What a return comes to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Return<L: Lane> {
    /// Where the stress was above the yield stress.
    pub flows: L::Mask,
    /// The plastic strain Δ; zero elsewhere.
    pub increment: L,
    /// The yield stress \[Pa\] after it; elsewhere that at no strain.
    pub yields: L,
}

/// The return of a stress of von Mises σ \[Pa\] by a law of strength within `dt` \[s\], with the [first](yields_first) yield
/// stress. A function of its own, so that loops with several returns hold one text of it.
#[inline(never)]
pub(super) fn returned<L: Lane>(
    law: &dyn StrengthObject,
    before: &PlasticState<L>,
    dt: L,
    [first, trial, stiffness]: [L; 3],
) -> Return<L> {
    on_wide_registers(ByLaw {
        law,
        before,
        dt,
        first,
        trial,
        stiffness,
    })
}

/// A return that is asked for.
struct ByLaw<'a, L> {
    law: &'a dyn StrengthObject,
    before: &'a PlasticState<L>,
    dt: L,
    first: L,
    trial: L,
    stiffness: L,
}

impl<L: Lane> OnOwnRows for ByLaw<'_, L> {
    type Output = Return<L>;
    #[inline(always)]
    fn run(self) -> Return<L> {
        radial_return(self.first, self.trial, self.stiffness, |more| {
            after(self.law, self.before, more, self.dt)
        })
    }
}

/// The plastic strain Δ at which σ − k Δ has come down to the yield stress Y(Δ), and that yield stress, where σ is above Y(0).
/// `first` is Y(0), `trial` σ \[Pa\], `stiffness` k \[Pa\].
#[inline(always)]
fn radial_return<L: Lane>(first: L, trial: L, stiffness: L, yields: impl Fn(L) -> L) -> Return<L> {
    let mut own = Return {
        flows: !trial.le(first),
        increment: L::zero(),
        yields: first,
    };
    if !L::somewhere(own.flows) {
        return own;
    }
    // What the stress is above the yield stress, and that.
    let excess = |strain: L| {
        let own = yields(strain);
        [trial - stiffness * strain - own, own]
    };
    // Beyond it a law that hardens is above the stress; one that softens may go on until no stress is left.
    let mut high = (trial - first) / stiffness;
    let [mut above, mut last] = excess(high);
    let rounding = L::of(4.0 * f64::EPSILON) * trial;
    let softens = own.flows & above.gt(rounding);
    if L::somewhere(softens) {
        high = L::select(softens, trial / stiffness, high);
        let [other, yields] = excess(high);
        above = L::select(softens, other, above);
        last = L::select(softens, yields, last);
    }
    let [strain, last] = root(
        excess,
        [L::zero(), trial - first, first],
        [high, above, last],
        (rounding, own.flows),
    );
    own.increment = L::select(own.flows, strain, own.increment);
    own.yields = L::select(own.flows, last, first);
    own
}

/// Where a function passes from positive to negative between two places that are not negative: a first secant, then
/// inverse quadratic interpolation where it is safe (Chandrupatla 1997), or bisection. `low` and `high` are places with
/// their values and what else the function gives there, which is also returned; `asked` says where a root is asked for.
#[inline(always)]
fn root<L: Lane>(
    function: impl Fn(L) -> [L; 2],
    low: [L; 3],
    high: [L; 3],
    (rounding, asked): (L, L::Mask),
) -> [L; 2] {
    let ([a, f_a, y_a], [b, f_b, y_b]) = (high, low);
    let next = a + f_a / (f_a - f_b) * (b - a);
    let [a, f_a, y_a, b, f_b, y_b, _] = iterate!(
        L,
        MOST_TRIALS,
        [a, f_a, y_a, b, f_b, y_b, next],
        |[a, f_a, y_a, b, f_b, y_b, next]| 'trial: {
            let [best, residual, _] = smaller([a, f_a, y_a], [b, f_b, y_b]);
            let least = L::of(2.0 * f64::EPSILON) * best;
            let narrow = (least + least).gt((b - a).abs());
            let done = !asked | residual.abs().le(rounding) | narrow;
            if !L::somewhere(!done) {
                break 'trial ([a, f_a, y_a, b, f_b, y_b, next], done);
            }
            let next = next.max(a.min(b) + least).min(a.max(b) - least);
            let [f_next, y_next] = function(next);
            // The end that is given up is the third place of the interpolation.
            let (above, other) = (f_next.gt(L::zero()), f_a.gt(L::zero()));
            let same = done | (above & other) | (!above & !other);
            let pick = |yes: L, no: L| L::select(same, yes, no);
            let [c, f_c] = [pick(a, b), pick(f_a, f_b)];
            let [b, f_b, y_b] = [pick(b, a), pick(f_b, f_a), pick(y_b, y_a)];
            let go_on = |own: L, next: L| L::select(done, own, next);
            let [a, f_a, y_a] = [go_on(a, next), go_on(f_a, f_next), go_on(y_a, y_next)];
            let along = (a - b) / (c - b);
            let up = (f_a - f_b) / (f_c - f_b);
            let safe =
                (up * up).lt(along) & ((L::one() - up) * (L::one() - up)).lt(L::one() - along);
            let share = f_a / (f_b - f_a) * f_c / (f_b - f_c)
                + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b);
            let inside = middle(a.min(b), a.max(b));
            let next = L::select(safe, a + share * (b - a), inside);
            ([a, f_a, y_a, b, f_b, y_b, next], done)
        }
    );
    let [strain, _, last] = smaller([a, f_a, y_a], [b, f_b, y_b]);
    [strain, last]
}

/// Of two places with their values, that with the smaller one.
#[inline(always)]
fn smaller<L: Lane>(first: [L; 3], second: [L; 3]) -> [L; 3] {
    let less = first[1].abs().lt(second[1].abs());
    let pick = |k: usize| L::select(less, first[k], second[k]);
    [pick(0), pick(1), pick(2)]
}

/// The middle of an interval; of its logarithm where it spans decades, because powers of plastic strain and rate put
/// roots there.
#[inline(always)]
fn middle<L: Lane>(low: L, high: L) -> L {
    let wide = L::of(WIDE);
    let apart = L::select(low.gt(L::zero()), (low * high).sqrt(), high / wide);
    L::select(high.le(wide * low), L::of(0.5) * (low + high), apart)
}

/// Ratio of the ends of an interval above which it is halved in the logarithm.
const WIDE: f64 = 1e3;

/// More than any law of the crate takes, which is two for perfect plasticity and linear hardening, and 27 for what has
/// an infinite slope at zero strain or rate. What is no number stays so and ends the run.
const MOST_TRIALS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::strength::{
        CowperSymonds, DruckerPrager, JohnsonCook, LinearHardening, PerfectPlasticity,
        PowerHardening, SteinbergGuinan, Strength, TensionCompression,
    };

    fn returns(trial: f64, stiffness: f64, yields: impl Fn(f64) -> f64) -> Return<f64> {
        radial_return(yields(0.0), trial, stiffness, yields)
    }

    #[test]
    fn linear_hardening_returns_exactly() {
        for modulus in [0.0, 1e9, 1e11] {
            let law = LinearHardening::new(300e6, modulus);
            let before = PlasticState {
                strain: 0.1,
                ..PlasticState::default()
            };
            let trial = 1.3 * law.yield_stress(&before);
            let back = returns(trial, 3.0 * 77e9, |more| after(&law, &before, more, 1e-9));
            assert!(back.flows);
            let (strain, stress) = (back.increment, back.yields);
            let exact = (trial - law.yield_stress(&before)) / (3.0 * 77e9 + modulus);
            assert!((strain / exact - 1.0).abs() < 1e-13, "{strain} {exact}");
            assert!((stress / (trial - 3.0 * 77e9 * exact) - 1.0).abs() < 1e-14);
        }
    }

    /// Far and near, slow and fast, for strain that begins and that goes on; calls of the law are counted.
    #[test]
    fn every_law_is_consistent_with_its_stress() {
        let laws: Vec<Box<dyn StrengthObject>> = vec![
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
                    let back = returns(trial, stiffness, yields);
                    let (more, stress) = (back.increment, back.yields);
                    assert!(back.flows);
                    let left = (trial - stiffness * more) / stress - 1.0;
                    assert!(left.abs() < 1e-12, "{} {left}", law.name());
                    assert!(more >= 0.0 && stress <= trial * (1.0 + 1e-15));
                    most = most.max(calls.get());
                    let below = law.yield_stress(&before) * (1.0 - 1e-9);
                    assert!(!returns(below, stiffness, yields).flows);
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
        let back = returns(1.5e8, 3e9, brittle);
        let (strain, stress) = (back.increment, back.yields);
        assert!(((1.5e8 - 3e9 * strain) - stress).abs() < 1e-6);
        assert!((strain / 0.05 - 1.0).abs() < 1e-6 && stress < 1.0);
        // What is no number stays so.
        let back = returns(1e8, 3e9, |_| f64::NAN);
        assert!(back.flows && back.yields.is_nan());
    }
}
