//! Every law of a material is recorded here, and the record followed to the bits of its rows.
//! Equations of state, strengths, failures and viscosities.

use super::eos::EquationOfState;
use super::failure::{
    FailureState, JohnsonCookFailure, PlasticStrainLimit, PrincipalStressLimit, SpallStrength,
};
use super::rheology::{CarreauYasuda, Cross, HerschelBulkley, Newtonian, PowerLaw};
use super::strength::{
    CowperSymonds, DruckerPrager, JohnsonCook, LinearHardening, PerfectPlasticity, PlasticState,
    PowerHardening, SteinbergGuinan, TensionCompression,
};
use super::{FailureObject, RheologyObject, StrengthObject};
use crate::for_each_eos;
use crate::scalar::{Lane, Real, Record};

/// What a law makes of `N` numbers.
trait Text<const N: usize> {
    fn of<L: Lane>(&self, given: [L; N]) -> Vec<L>;
}

fn on_rows<T: Real, const N: usize>(
    name: &str,
    (text, record): (&impl Text<N>, &Record),
    scales: [f64; N],
) {
    for turn in 0..40 {
        let noise = |k: usize| 1.4 * (1e4 * (k as f64 + 0.7).sin()).fract().abs() - 0.2;
        let mut given = [T::Wide::<false>::of(0.0); N];
        for (n, given) in given.iter_mut().enumerate() {
            let own = |k: usize| scales[n] * noise(1000 * turn + 50 * n + k);
            *given = Lane::from_fn(|k| T::from_f64(own(k)));
        }
        let (found, expected) = (record.follow(&given), text.of(given));
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            for k in 0..<T::Wide<false> as Lane>::WIDTH {
                let [found, expected] = [found, expected].map(|row| row.extract(k).to_f64());
                let same = found.to_bits() == expected.to_bits();
                assert!(
                    same || (found.is_nan() && expected.is_nan()),
                    "{name}: {found} {expected}"
                );
            }
        }
    }
}

fn check<const N: usize>(name: &str, text: &impl Text<N>, scales: [f64; N]) {
    let given = |all: &[_]| core::array::from_fn(|k| all[k]);
    let record = Record::of(N, |all| text.of(given(all)));
    let record = record.unwrap_or_else(|error| panic!("{name}: {error}"));
    on_rows::<f64, N>(name, (text, &record), scales);
    on_rows::<f32, N>(name, (text, &record), scales);
}

struct State<E>(E);
impl<E: EquationOfState> Text<2> for State<E> {
    fn of<L: Lane>(&self, [density, energy]: [L; 2]) -> Vec<L> {
        let state = self.0.state(density, energy);
        vec![state.pressure, state.sound_speed]
    }
}

impl Text<5> for &dyn StrengthObject {
    fn of<L: Lane>(&self, given: [L; 5]) -> Vec<L> {
        vec![self.yield_stress(&PlasticState::of(given))]
    }
}

impl Text<7> for &dyn FailureObject {
    fn of<L: Lane>(&self, given: [L; 7]) -> Vec<L> {
        vec![self.damage(&FailureState::of(given))]
    }
}

impl Text<1> for &dyn RheologyObject {
    fn of<L: Lane>(&self, [shear_rate]: [L; 1]) -> Vec<L> {
        vec![self.viscosity(shear_rate)]
    }
}

#[test]
fn equations_of_state_are_recorded() {
    macro_rules! each {
        ($($name:ident: $law:expr);*) => { $(
            let law = $law;
            let rest = law.reference_density();
            check(stringify!($name), &State(law), [1.4 * rest, 2e6]);
        )* };
    }
    for_each_eos!(each);
}

#[test]
fn strengths_failures_and_viscosities_are_recorded() {
    let hardens = PowerHardening::new(90e6, 292e6, 0.31);
    let cook = JohnsonCook::new(90e6, 292e6, 0.31).with_rate_sensitivity(0.025);
    let guinan = SteinbergGuinan::new(0.29e9, 0.68e9, 125.0, 0.10);
    let laws: [&dyn StrengthObject; 10] = [
        &0.3e9,
        &PerfectPlasticity::new(0.3e9),
        &LinearHardening::new(0.4e9, 0.1e9),
        &hardens,
        &cook.with_softening(1.09, 1356.0),
        &cook,
        &CowperSymonds::new(hardens, 40.0, 5.0),
        &guinan.with_pressure(6.52e-11).with_softening(6.16e-4),
        &DruckerPrager::from_yield_stresses(49e6, 91e6),
        &TensionCompression::new(49e6, 91e6),
    ];
    for law in laws {
        check(law.name(), &law, [0.5, 1e4, 1500.0, 1e8, 1.2]);
    }
    let cook = JohnsonCookFailure::new(0.05, 3.44, -2.12)
        .with_rate_sensitivity(0.002)
        .with_heat_sensitivity(0.61, 1793.0);
    let laws: [&dyn FailureObject; 4] = [
        &cook,
        &PlasticStrainLimit::new(0.3),
        &PrincipalStressLimit::new(5e7),
        &SpallStrength::new(1e7),
    ];
    for law in laws {
        check(law.name(), &law, [0.5, 0.1, 1e4, 1500.0, 1e8, 2e8, 1e8]);
    }
    let laws: [&dyn RheologyObject; 6] = [
        &1e-3,
        &Newtonian::new(1e-3),
        &PowerLaw::new(2.0, 0.4, 1e-3, 50.0),
        &Cross::new(5.0, 0.01, 2.0, 0.7),
        &CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568),
        &HerschelBulkley::new(20.0, 3.0, 0.5, 100.0),
    ];
    for law in laws {
        check(law.name(), &law, [100.0]);
    }
}
