//! Tests of the viscosity laws: their limits, slopes, stresses, and their evaluation in rows.
//! What a law should be is taken from its plateaus and asymptotes, not from its formula.

use super::*;
use crate::material::{Material, catalogue};
use crate::scalar::Real;

/// Shear rates from 10⁻⁸ to 10⁸ per second.
fn rates() -> impl Iterator<Item = f64> {
    (-80..=80).map(|k| 10f64.powf(0.1 * f64::from(k)))
}

/// d ln μ / d ln γ̇ by central differences.
fn slope(law: &impl ViscosityLaw, rate: f64) -> f64 {
    let step = 1e-4_f64;
    let ln = |x: f64| law.viscosity(x).ln();
    (ln(rate * step.exp()) - ln(rate * (-step).exp())) / (2.0 * step)
}

/// What holds for every law: bounded, finite at rest, a stress that grows with the shear rate, and
/// rows that equal single values.
fn is_sound(law: impl ViscosityLaw) {
    assert_eq!(law.problems(), []);
    let greatest = law.greatest_viscosity();
    let (mut stress, mut largest) = (0.0, law.viscosity(0.0));
    for rate in rates() {
        let viscosity = law.viscosity(rate);
        assert!(viscosity.is_finite() && viscosity > 0.0 && viscosity <= greatest);
        assert!(viscosity * rate > stress, "{law:?} at {rate}");
        stress = viscosity * rate;
        largest = f64::max(largest, viscosity);
    }
    assert!((largest / greatest - 1.0).abs() < 1e-6, "{law:?}");
    assert!(law.viscosity(f64::NAN).is_nan() || law.name() == "Newtonian");
    assert!(law.viscosity(0.0f32).is_finite() && law.viscosity(1e30f32).is_finite());
    rows_equal_single_values::<f32>(law.clone());
    rows_equal_single_values::<f64>(law);
}

fn rows_equal_single_values<T: Real>(law: impl ViscosityLaw) {
    let material = liquid::<T>(law.clone());
    let rheology = material.rheology().expect("it has just been given one");
    let row = T::Wide::<false>::from_fn(|k| T::from_f64(0.37 * k as f64));
    let viscosity = rheology.viscosity(row);
    for k in 0..<T::Wide<false> as Lane>::WIDTH {
        assert_eq!(viscosity.extract(k), law.viscosity(row.extract(k)));
    }
}

fn liquid<T: Real>(law: impl ViscosityLaw) -> Material<T> {
    catalogue::water().with_rheology(law)
}

#[test]
fn every_law_is_sound() {
    is_sound(Newtonian::new(1e-3));
    is_sound(PowerLaw::new(2.0, 0.4, 1e-3, 50.0));
    is_sound(PowerLaw::new(2.0, 1.5, 1e-3, 50.0));
    is_sound(Cross::new(5.0, 0.01, 2.0, 0.7));
    is_sound(CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568));
    is_sound(CarreauYasuda::new(5.0, 0.0, 0.3, 0.5).with_transition(1.2));
    is_sound(HerschelBulkley::bingham(20.0, 0.1, 100.0));
    is_sound(HerschelBulkley::new(20.0, 3.0, 0.5, 100.0));
}

#[test]
fn plateaus_at_low_and_high_shear_rate() {
    let cross = Cross::new(5.0, 0.01, 2.0, 1.0);
    assert_eq!(
        (cross.viscosity(0.0), cross.greatest_viscosity()),
        (5.0, 5.0)
    );
    assert!((cross.viscosity(1e12) / 0.01 - 1.0).abs() < 1e-8);
    // Halfway at γ̇ = 1/λ.
    assert!((cross.viscosity(0.5) - 2.505).abs() < 1e-15 * 4.0);

    let carreau = CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568);
    assert_eq!(carreau.viscosity(0.0), 0.056);
    assert!((carreau.viscosity(1e16) / 3.45e-3 - 1.0).abs() < 1e-8);

    let power = PowerLaw::new(2.0, 0.4, 1e-3, 50.0);
    assert_eq!((power.viscosity(0.0), power.viscosity(1e9)), (50.0, 1e-3));
    let thickening = PowerLaw::new(2.0, 1.5, 1e-3, 50.0);
    assert_eq!(thickening.viscosity(0.0), 1e-3);
    assert_eq!(thickening.viscosity(1e9), 50.0);
}

/// Between its plateaus a law that thins has the slope n − 1, for Cross −m.
#[test]
fn slopes_of_thinning() {
    let power = PowerLaw::new(2.0, 0.4, 1e-9, 1e9);
    assert!((slope(&power, 3.0) + 0.6).abs() < 1e-9);
    let carreau = CarreauYasuda::new(5.0, 0.0, 10.0, 0.3);
    assert!((slope(&carreau, 1e4) + 0.7).abs() < 1e-6);
    let cross = Cross::new(5.0, 0.0, 10.0, 0.8);
    assert!((slope(&cross, 1e8) + 0.8).abs() < 1e-6);
}

/// Laws that coincide where their parameters say so.
#[test]
fn laws_meet() {
    let power = PowerLaw::new(3.0, 0.5, 0.0, 1e3);
    let without_yield = HerschelBulkley::new(0.0, 3.0, 0.5, 100.0).with_greatest(1e3);
    let cross = Cross::new(5.0, 0.01, 2.0, 1.0);
    // 1/(1 + λγ̇) is Yasuda's with a = 1 and n = 0; n must be above it, so the limit is taken.
    let yasuda = CarreauYasuda::new(5.0, 0.01, 2.0, 1e-12).with_transition(1.0);
    for rate in rates() {
        let share = without_yield.viscosity(rate) / power.viscosity(rate);
        assert!((share - 1.0).abs() < 1e-14);
        let share = yasuda.viscosity(rate) / cross.viscosity(rate);
        assert!((share - 1.0).abs() < 1e-10);
    }
}

#[test]
fn yield_stress() {
    let (limit, plastic, time) = (20.0, 0.1, 100.0);
    let mud = HerschelBulkley::bingham(limit, plastic, time);
    assert_eq!(mud.name(), "Bingham");
    assert_eq!(mud.viscosity(0.0), plastic + time * limit);
    let stress = |law: &HerschelBulkley, rate: f64| law.viscosity(rate) * rate;
    // Above yield the plain law, τ_y + K γ̇.
    for rate in [1.0, 10.0, 1e3] {
        let plain = limit + plastic * rate;
        assert!((stress(&mud, rate) / plain - 1.0).abs() < 1e-12);
    }
    // Half the yield stress is held at m γ̇ = ln 2 in the limit of small K.
    let stiff = HerschelBulkley::bingham(limit, 1e-12, time);
    assert!((stress(&stiff, 2f64.ln() / time) / 10.0 - 1.0).abs() < 1e-12);
    let paste = HerschelBulkley::new(limit, 3.0, 0.5, time);
    assert_eq!(paste.name(), "Herschel-Bulkley");
    assert!((stress(&paste, 4.0) - 26.0).abs() < 1e-12);
    assert_eq!(paste.viscosity(0.0), 3.0 * 10.0 + 2000.0);
    // Close to rest `f32` keeps the digits of 1 − e⁻ˣ.
    let single = f64::from(mud.viscosity(1e-9f32));
    assert!((single / 2000.1 - 1.0).abs() < 2e-7);
}

#[test]
fn problems_name_their_fields() {
    let fields = |material: Material<f64>| -> Vec<_> {
        material
            .problems()
            .iter()
            .map(|problem| problem.0)
            .collect()
    };
    assert_eq!(fields(liquid(Newtonian::new(-1.0))), ["dynamic_viscosity"]);
    assert_eq!(
        fields(liquid(PowerLaw::new(0.0, 0.0, -2.0, -3.0))),
        ["consistency", "index", "least", "greatest"]
    );
    assert_eq!(
        fields(liquid(Cross::new(1.0, 2.0, 0.0, 1.5))),
        ["at_high_rate", "time", "exponent"]
    );
    let carreau = CarreauYasuda::new(f64::NAN, 0.0, 1.0, 0.0).with_transition(0.0);
    assert_eq!(
        fields(liquid(carreau)),
        ["at_rest", "at_high_rate", "index", "transition"]
    );
    let paste = HerschelBulkley::new(-1.0, 0.0, -1.0, 1.0).with_greatest(f64::INFINITY);
    assert_eq!(
        fields(liquid(paste)),
        ["yield_stress", "consistency", "index", "greatest"]
    );
}

/// A constant viscosity and a law replace each other, and a constant is lent as a law.
#[test]
fn one_viscosity_a_material() {
    let water = catalogue::water::<f64>();
    let constant = water.rheology().expect("water has a viscosity");
    assert_eq!(
        (constant.name(), constant.viscosity(7.0)),
        ("Newtonian", 1e-3)
    );
    assert_eq!(constant.greatest_viscosity(), 1e-3);
    let mud = water.with_rheology(HerschelBulkley::bingham(20.0, 0.1, 100.0));
    assert_eq!(mud.dynamic_viscosity, None);
    assert_eq!(mud.rheology().map(|law| law.name()), Some("Bingham"));
    let oil = mud.with_dynamic_viscosity(0.05);
    assert_eq!(
        oil.rheology().map(|law| law.greatest_viscosity()),
        Some(0.05)
    );
    assert!(catalogue::copper::<f64>().rheology().is_none());
}
