//! Laws, rates and limits of every effect of the crate.
//! They are recorded as a scheme with that effect has them.

use super::common::{self, Random};
use super::{COUNT, Outcome};
use meshfree::effect::{
    DensityForm, Effect,
    parts::{PointRecord, point_records},
};
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::material::failure::JohnsonCookFailure;
use meshfree::material::rheology::CarreauYasuda;
use meshfree::material::strength::{JohnsonCook, PlasticHeating};
use meshfree::particles::{Fields, Shape};
use meshfree_gpu::Device;

/// One whose strength and failure take every branch where stresses, or the shear modulus times strains, are near `stress`.
pub(crate) fn material(stress: f64) -> Material<f64> {
    let strength = JohnsonCook::new(0.2 * stress, 0.5 * stress, 0.31).with_rate_sensitivity(0.025);
    let failure = JohnsonCookFailure::new(0.05, 3.44, -2.12).with_rate_sensitivity(0.002);
    Material::new("test", Linear::new(1000.0, 100.0))
        .with_shear_modulus(1e6)
        .with_plastic_heating(PlasticHeating::new(400.0))
        .with_pressure_cut_off(-1e3)
        .with_strength(strength.with_softening(1.09, 1356.0))
        .with_failure(failure.with_heat_sensitivity(0.61, 1793.0))
        .with_rheology(CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568))
}

/// What the record of a part is given: most numbers positive, matrices near unity.
fn columns<const D: usize>(own: &PointRecord, random: &mut Random) -> Vec<Vec<f64>> {
    let mut columns = Vec::new();
    for field in own.fields.iter() {
        for k in 0..field.components(D) {
            let mut value = || match field.shape() {
                Shape::Matrix if k % (D + 1) == 0 => 1.0 + 0.2 * random.sign(),
                Shape::Matrix => 0.2 * random.sign(),
                _ => 2.0 * random.next() - 0.3,
            };
            columns.push((0..COUNT).map(|_| value()).collect());
        }
    }
    let mut noise = |count: usize| {
        let own = (0..count).map(|_| (0..COUNT).map(|_| 2.0 * random.next() - 0.3).collect());
        own.collect::<Vec<Vec<f64>>>()
    };
    columns.extend(noise(own.sums.width(D)));
    columns.extend(own.constants.iter().map(|value| vec![*value; COUNT]));
    columns.push(vec![1e-3; COUNT]);
    columns.extend(noise(1 + 2 * D + D * D));
    columns
}

/// What an effect registers.
pub(crate) fn effect<const D: usize>(
    (outcome, device): (&mut Outcome, &Device),
    effect: &impl Effect<D>,
    density: DensityForm,
) where
    meshfree::kernel::WendlandC2: meshfree::kernel::Kernel<D>,
{
    // Under finite strain stresses follow from the strains that are given.
    let material = material(if density == DensityForm::Deformation {
        1e5
    } else {
        1.0
    });
    for own in point_records::<f64, D>(effect, density, &material, Fields::NONE) {
        if !own.acts {
            continue;
        }
        let record = own.record.as_ref();
        let record = record.unwrap_or_else(|error| panic!("{}: {error}", own.name));
        let name = format!("{} of {effect:?}", own.name);
        let columns = columns::<D>(&own, &mut Random(outcome.records as u64));
        outcome.check(device, &name, record, &columns, !own.double);
    }
}

#[test]
fn laws_rates_and_limits() {
    let Some(device) = common::device("laws, rates and limits") else {
        return;
    };
    let mut outcome = Outcome::new();
    macro_rules! each {
        (liquid [$($a:expr),*] solid [$($b:expr),*] total_lagrangian [$($c:expr),*] sheet [$($d:expr),*] rod [$($e:expr),*]) => {
            $(effect::<2>((&mut outcome, &device), &$a, DensityForm::Continuity);)*
            $(effect::<3>((&mut outcome, &device), &$b, DensityForm::Continuity);)*
            $(effect::<3>((&mut outcome, &device), &$c, DensityForm::Deformation);)*
            $(effect::<2>((&mut outcome, &device), &$d, DensityForm::Deformation);)*
            $(effect::<1>((&mut outcome, &device), &$e, DensityForm::Continuity);)*
        };
    }
    meshfree::for_each_effect!(each);
    assert!(outcome.end() > 30);
}
