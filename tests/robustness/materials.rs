//! Random materials: one whose constants are accepted gives finite pressures and positive sound speeds at any finite state.
//! The same for laws of strength and viscosity.

use super::guard;
use super::numbers::Numbers;
use meshfree::material::eos::{
    IdealGas, Linear, MieGruneisen, Murnaghan, Polynomial, StiffenedGas, Tait, TensionCutOff,
};
use meshfree::material::failure::{PlasticStrainLimit, SpallStrength};
use meshfree::material::rheology::{Cross, HerschelBulkley};
use meshfree::material::strength::{
    CowperSymonds, JohnsonCook, LinearHardening, PlasticHeating, PlasticState, PowerHardening,
    TensionCompression,
};
use meshfree::material::{Liquid, Material, SoundSpeed, catalogue};

/// A material of random kind and constants.
pub fn material(n: &mut Numbers) -> Material<f64> {
    let density = n.scale(1.0, 2e4);
    let speed = n.scale(1.0, 1e4);
    let mut material = match n.below(12) {
        0 => Material::new("gas", IdealGas::new(n.between(1.1, 3.0), density)),
        1 => Material::new("linear", Linear::new(density, speed)),
        2 => Material::new(
            "tait",
            Tait::new(density, speed).with_gamma(n.between(1.0, 9.0)),
        ),
        3 => Material::new(
            "shocked",
            MieGruneisen::new(density, speed, n.between(0.0, 3.0), n.between(0.0, 3.0)),
        ),
        4 => Material::new(
            "pressed",
            Murnaghan::new(density, n.scale(1e3, 1e12), n.between(1.0, 10.0)),
        ),
        5 => Material::new(
            "fitted",
            Polynomial::new(
                density,
                [
                    0.0,
                    n.scale(1e5, 1e12),
                    n.between(-1e10, 1e12),
                    0.0,
                    n.between(0.0, 3.0),
                    0.0,
                    0.0,
                ],
            ),
        ),
        6 => Material::new("stiff", StiffenedGas::water()),
        7 => Material::new(
            "cut",
            TensionCutOff::new(Linear::new(density, speed), -n.scale(1.0, 1e9)),
        ),
        8 => Liquid::new(density, speed, n.scale(1e-5, 10.0)).material(
            "liquid",
            match n.below(3) {
                0 => SoundSpeed::Physical,
                1 => SoundSpeed::artificial(n.scale(0.1, 100.0)),
                _ => SoundSpeed::Chosen(n.scale(1.0, 1e3)),
            },
        ),
        9 => catalogue::weakly_compressible_water(n.scale(0.5, 20.0)),
        10 => catalogue::ofhc_copper(),
        _ => catalogue::tank_pmma(),
    };
    if n.once_in(3) {
        material = material.with_shear_modulus(n.scale(1e4, 1e11));
    }
    if n.once_in(3) {
        material = material.with_yield_stress(n.scale(1e3, 1e10));
    }
    if n.once_in(5) {
        material = material.with_dynamic_viscosity(n.scale(1e-5, 1e3));
    }
    if n.once_in(6) {
        material = material.with_pressure_cut_off(-n.scale(1.0, 1e9));
    }
    if n.once_in(6) {
        material = material.with_rheology(HerschelBulkley::new(
            n.scale(1e-3, 1e3),
            n.scale(1e-3, 1e2),
            n.between(0.2, 2.0),
            n.scale(1e-3, 1e4),
        ));
    } else if n.once_in(8) {
        material = material.with_rheology(Cross::new(
            n.scale(1e-3, 1e3),
            n.scale(1e-5, 1.0),
            n.scale(1e-3, 1e3),
            n.between(0.1, 2.0),
        ));
    }
    match n.below(8) {
        0 => {
            material = material.with_strength(LinearHardening::new(
                n.scale(1e4, 1e10),
                n.between(0.0, 1e10),
            ));
        }
        1 => {
            let hard =
                PowerHardening::new(n.scale(1e4, 1e10), n.scale(1e4, 1e10), n.between(0.0, 1.0));
            material = material.with_strength(hard);
        }
        2 => {
            let slow = TensionCompression::new(n.scale(1e4, 1e9), n.scale(1e4, 1e9));
            let law = CowperSymonds::new(slow, n.scale(1.0, 1e6), n.between(1.0, 8.0));
            material = material.with_strength(law);
        }
        3 => {
            let law = JohnsonCook::new(n.scale(1e4, 1e9), n.scale(1e4, 1e9), n.between(0.0, 1.0));
            let law = law
                .with_rate_sensitivity(n.between(0.0, 0.1))
                .with_softening(n.between(0.1, 3.0), n.between(300.0, 3000.0));
            material = material
                .with_strength(law)
                .with_plastic_heating(PlasticHeating::new(n.scale(10.0, 5e3)));
        }
        _ => {}
    }
    match n.below(10) {
        0 => material = material.with_failure(PlasticStrainLimit::new(n.scale(0.01, 3.0))),
        1 => material = material.with_failure(SpallStrength::new(n.scale(1e6, 1e10))),
        _ => {}
    }
    material
}

pub fn case(seed: u64) -> &'static str {
    let mut n = Numbers::of(seed);
    let material = material(&mut n);
    if !material.problems().is_empty() {
        let text = format!("{:?}", material.problems());
        assert!(!text.is_empty());
        return "refused";
    }
    let rest = material.reference_density();
    for _ in 0..20 {
        let density = rest * (n.random.sign() * [0.01, 1.0, 8.0][n.below(3)]).exp();
        let c = material.impedance() / rest;
        let energy = c * c * n.random.sign() * [1e-6, 1e-2, 10.0][n.below(3)];
        let (p, c) = material.state(density, energy);
        let finite = p.is_finite() && c.is_finite() && c >= 0.0;
        assert!(finite, "{material:?} at {density}, {energy}: {p}, {c}");
        if let Some(law) = material.strength() {
            let state = PlasticState {
                strain: n.random.unit() * 10.0,
                rate: (n.random.unit() * 20.0).exp() - 1.0,
                temperature: 200.0 + 4000.0 * n.random.unit(),
                pressure: p,
                density_ratio: density / rest,
            };
            let yields = law.yield_stress(&state);
            assert!(
                yields.is_finite() && yields >= 0.0,
                "{law:?} at {state:?}: {yields}"
            );
        }
        if let Some(law) = material.rheology() {
            let rate = (n.random.sign() * 20.0).exp();
            for rate in [0.0, rate] {
                let mu = law.viscosity(rate);
                assert!(mu.is_finite() && mu >= 0.0, "{law:?} at {rate}: {mu}");
                let most = law.greatest_viscosity();
                assert!(
                    mu <= most * (1.0 + 1e-9),
                    "{law:?} at {rate}: {mu} above {most}"
                );
            }
        }
        if let Some(density) = material.eos().density_at(1e5 * n.random.sign(), 0.0) {
            assert!(
                density.is_finite() && density > 0.0,
                "{material:?}: {density}"
            );
        }
    }
    "sound"
}

#[test]
fn materials_are_sound_or_refused() {
    let words = guard::all("materials", 0, 20_000, case);
    assert!(guard::share(&words, "sound") > 5000 && guard::share(&words, "refused") > 1000);
}

/// A million, about half a minute.
#[test]
#[ignore = "a million materials, half a minute"]
fn a_million_materials() {
    guard::all("materials", 1_000_000, guard::asked(), case);
}
