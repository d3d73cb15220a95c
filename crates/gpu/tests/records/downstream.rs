//! Parts that a user has written: those of the package `tests/downstream`, which sees what the crate publishes.
//! Terms, a kernel, a viscosity, an equation of state, laws, rates and limits, as they stand there.

#[path = "../../../../tests/downstream/src/eos.rs"]
mod eos;
#[path = "../../../../tests/downstream/src/heat.rs"]
mod heat;
#[path = "../../../../tests/downstream/src/hypoelastic.rs"]
mod hypoelastic;
#[path = "../../../../tests/downstream/src/kernel.rs"]
mod kernel;
#[path = "../../../../tests/downstream/src/viscosity.rs"]
mod viscosity;
#[path = "../../../../tests/downstream/src/wall.rs"]
mod wall;

use super::common::{self, Random};
use super::laws::effect;
use super::terms::check;
use super::{COUNT, Outcome};
use meshfree::effect::DensityForm;
use meshfree::kernel::WendlandC2;
use meshfree::material::eos::EquationOfState;
use meshfree::scalar::Record;
use meshfree::term::{PressureForce, Viscosity};

const HEAT: heat::HeatConduction = heat::HeatConduction {
    conductivity: 2.0,
    specific_heat: 10.0,
    start: 300.0,
};
const SOLID: hypoelastic::Hypoelastic = hypoelastic::Hypoelastic { shear_modulus: 3.0 };

#[test]
fn parts_of_a_user() {
    let Some(device) = common::device("parts of a user") else {
        return;
    };
    let mut outcome = Outcome::new();
    let viscosity = Viscosity(viscosity::Richtmyer {
        alpha: 0.5,
        beta: 2.0,
    });
    let on = (&mut outcome, &device);
    macro_rules! terms {
        ($($d:literal)*) => { $(
            check::<$d>((on.0, on.1), ("heat", &HEAT), &WendlandC2, 1);
            check::<$d>((on.0, on.1), ("hypoelastic", &SOLID), &WendlandC2, 2);
            check::<$d>((on.0, on.1), ("level wall", &wall::LevelWall), &WendlandC2, 3);
            check::<$d>((on.0, on.1), ("viscosity", &viscosity), &WendlandC2, 4);
        )* };
    }
    terms!(1 2 3);
    check::<1>(
        (on.0, on.1),
        ("pressure by Lucy", &PressureForce),
        &kernel::Lucy,
        5,
    );
    check::<1>((on.0, on.1), ("heat by Lucy", &HEAT), &kernel::Lucy, 6);
    effect::<2>((on.0, on.1), &HEAT, DensityForm::Continuity);
    effect::<3>((on.0, on.1), &SOLID, DensityForm::Continuity);
    effect::<2>((on.0, on.1), &wall::LevelWall, DensityForm::Continuity);
    let law = eos::Isothermal {
        density: 1.0,
        sound_speed: 3.0,
    };
    let record = Record::of(2, |given| {
        let state = law.state(given[0], given[1]);
        vec![state.pressure, state.sound_speed]
    });
    let mut random = Random(8);
    let given = [1.0, 2.0].map(|scale| (0..COUNT).map(|_| scale * random.next()).collect());
    on.0.check(on.1, "isothermal", &record.expect("lanes"), &given, true);
    assert_eq!(outcome.end(), 20);
}
