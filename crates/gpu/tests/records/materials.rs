//! Laws that a material holds: equations of state, strengths, failures and viscosities.
//! Their numbers are those with which the crate records them itself.

use super::common::{self, Random};
use super::{COUNT, Outcome};
use meshfree::material::eos::EquationOfState;
use meshfree::material::failure::{
    Failure, FailureState, JohnsonCookFailure, PlasticStrainLimit, PrincipalStressLimit,
    SpallStrength,
};
use meshfree::material::rheology::{
    CarreauYasuda, Cross, HerschelBulkley, Newtonian, PowerLaw, ViscosityLaw,
};
use meshfree::material::strength::{
    CowperSymonds, DruckerPrager, JohnsonCook, LinearHardening, PerfectPlasticity, PlasticState,
    PowerHardening, SteinbergGuinan, Strength, TensionCompression,
};
use meshfree::scalar::{Record, Traced};

/// Columns between −0.2 and 1.2 of some scales.
fn columns(scales: &[f64]) -> Vec<Vec<f64>> {
    let mut random = Random(7);
    let mut column = |scale: &f64| {
        (0..COUNT)
            .map(|_| scale * (1.4 * random.next() - 0.2))
            .collect()
    };
    scales.iter().map(&mut column).collect()
}

#[test]
fn equations_of_state() {
    let Some(device) = common::device("equations of state") else {
        return;
    };
    let mut outcome = Outcome::new();
    macro_rules! each {
        ($($name:ident: $law:expr);*) => { $(
            let law = $law;
            let rest = law.reference_density();
            let record = Record::of(2, |given| {
                let state = law.state(given[0], given[1]);
                vec![state.pressure, state.sound_speed]
            });
            let given = columns(&[1.4 * rest, 2e6]);
            outcome.check(&device, stringify!($name), &record.expect("lanes"), &given, true);
        )* };
    }
    meshfree::for_each_eos!(each);
    assert!(outcome.end() > 10);
}

fn strength(law: &impl Strength) -> (&'static str, Record) {
    let record = Record::of(5, |given| {
        vec![law.yield_stress(&PlasticState::<Traced> {
            strain: given[0],
            rate: given[1],
            temperature: given[2],
            pressure: given[3],
            density_ratio: given[4],
        })]
    });
    (law.name(), record.expect("lanes"))
}

fn failure(law: &impl Failure) -> (&'static str, Record) {
    let record = Record::of(7, |given| {
        vec![law.damage(&FailureState::<Traced> {
            strain: given[0],
            increment: given[1],
            rate: given[2],
            temperature: given[3],
            pressure: given[4],
            von_mises: given[5],
            principal_stress: given[6],
        })]
    });
    (law.name(), record.expect("lanes"))
}

fn viscosity(law: &impl ViscosityLaw) -> (&'static str, Record) {
    let record = Record::of(1, |given| vec![law.viscosity(given[0])]);
    (law.name(), record.expect("lanes"))
}

#[test]
fn strengths_failures_and_viscosities() {
    let Some(device) = common::device("strengths, failures and viscosities") else {
        return;
    };
    let mut outcome = Outcome::new();
    let hardens = PowerHardening::new(90e6, 292e6, 0.31);
    let cook = JohnsonCook::new(90e6, 292e6, 0.31).with_rate_sensitivity(0.025);
    let guinan = SteinbergGuinan::new(0.29e9, 0.68e9, 125.0, 0.10);
    let given = columns(&[0.5, 1e4, 1500.0, 1e8, 1.2]);
    for (name, record) in [
        strength(&0.3e9),
        strength(&PerfectPlasticity::new(0.3e9)),
        strength(&LinearHardening::new(0.4e9, 0.1e9)),
        strength(&hardens),
        strength(&cook.with_softening(1.09, 1356.0)),
        strength(&cook),
        strength(&CowperSymonds::new(hardens, 40.0, 5.0)),
        strength(&guinan.with_pressure(6.52e-11).with_softening(6.16e-4)),
        strength(&DruckerPrager::from_yield_stresses(49e6, 91e6)),
        strength(&TensionCompression::new(49e6, 91e6)),
    ] {
        outcome.check(&device, name, &record, &given, true);
    }
    let cook = JohnsonCookFailure::new(0.05, 3.44, -2.12)
        .with_rate_sensitivity(0.002)
        .with_heat_sensitivity(0.61, 1793.0);
    let given = columns(&[0.5, 0.1, 1e4, 1500.0, 1e8, 2e8, 1e8]);
    for (name, record) in [
        failure(&cook),
        failure(&PlasticStrainLimit::new(0.3)),
        failure(&PrincipalStressLimit::new(5e7)),
        failure(&SpallStrength::new(1e7)),
    ] {
        outcome.check(&device, name, &record, &given, true);
    }
    for (name, record) in [
        viscosity(&1e-3),
        viscosity(&Newtonian::new(1e-3)),
        viscosity(&PowerLaw::new(2.0, 0.4, 1e-3, 50.0)),
        viscosity(&Cross::new(5.0, 0.01, 2.0, 0.7)),
        viscosity(&CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568)),
        viscosity(&HerschelBulkley::new(20.0, 3.0, 0.5, 100.0)),
    ] {
        outcome.check(&device, name, &record, &columns(&[100.0]), true);
    }
    assert_eq!(outcome.end(), 20);
}

/// One law that looks at elements cannot be recorded, and says so with its operation.
#[test]
fn a_law_with_a_branch_is_refused_by_name() {
    use meshfree::scalar::{Lane, Mask};
    let record = Record::of(1, |given| {
        vec![if given[0].lt(Traced::splat(0.0)).test(0) {
            -given[0]
        } else {
            given[0]
        }]
    });
    let said = record.expect_err("a branch").to_string();
    assert!(said.contains("a branch on a comparison"), "{said}");
    assert!(said.contains("Lane::select"), "{said}");
}
