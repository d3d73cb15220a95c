//! The catalogue: named materials with their sources, all in SI units.
//! Each is a function; [`by_name`] finds one for a command line.

use super::eos::{Hugoniot, IdealGas, Linear, MieGruneisen};
use super::strength::{
    JohnsonCook, LinearHardening, PlasticHeating, SteinbergGuinan, TensionCompression,
};
use super::{Liquid, Material, SoundSpeed};
use crate::error::{Error, Problem};
use crate::scalar::Real;

const LAM: &str = "Lam, Shen & Gong, axial impact of rods, table 2";
const HOWELL: &str = "Howell & Ball 2002, hypervelocity impact of steel on aluminium";
const TAYLOR: &str = "strength: Johnson & Cook 1983, melting point and specific heat as customary with it; elastic \
                      constants: customary";

/// A row of Lam's table 2 on the cubic of their eqs. 4–6.
fn lam<T: Real>(
    name: &str,
    rho: f64,
    c: f64,
    s: f64,
    gamma: f64,
    yield_stress: f64,
) -> Material<T> {
    let law = MieGruneisen::new(rho, c, s, gamma).with_form(Hugoniot::LamCubic);
    Material::new(name, law)
        .with_source(LAM)
        .with_yield_stress(yield_stress)
}

/// Copper of the rod impacts: ρ₀ 8930 kg/m³, C₀ 3940 m/s, S 1.49, Γ 2.02, Y₀ 0.76 GPa
/// (Lam, Shen & Gong, table 2), on the cubic of eqs. 4–6.
#[must_use]
pub fn copper<T: Real>() -> Material<T> {
    lam("copper", 8930.0, 3940.0, 1.49, 2.02, 0.76e9)
}

/// Steel of the rod impacts: ρ₀ 7850 kg/m³, C₀ 3570 m/s, S 1.92, Γ 1.8, Y₀ 0.68 GPa (Lam, Shen &
/// Gong, table 2). The large S puts the pole of the full Hugoniot at η = 1.09.
#[must_use]
pub fn steel<T: Real>() -> Material<T> {
    lam("steel", 7850.0, 3570.0, 1.92, 1.8, 0.68e9)
}

/// Aluminium of the rod impacts: ρ₀ 2700 kg/m³, C₀ 5350 m/s, S 1.34, Γ 2.0, Y₀ 0.23 GPa (Lam, Shen &
/// Gong, table 2).
#[must_use]
pub fn aluminium<T: Real>() -> Material<T> {
    lam("aluminium", 2700.0, 5350.0, 1.34, 2.0, 0.23e9)
}

/// PMMA of the rod impacts: ρ₀ 1190 kg/m³, C₀ 2600 m/s, S 1.52, Γ 1.0, Y₀ 0.07 GPa (Lam, Shen & Gong,
/// table 2).
#[must_use]
pub fn pmma<T: Real>() -> Material<T> {
    lam("pmma", 1190.0, 2600.0, 1.52, 1.0, 0.07e9)
}

/// PMMA of the sloshing tank: ρ₀ 1180 kg/m³, E 3 GPa, ν 0.35 (Vesenjak & Ren 2007), linear.
#[must_use]
pub fn tank_pmma<T: Real>() -> Material<T> {
    Material::new(
        "tank-pmma",
        Linear::from_elastic_constants(1180.0, 3e9, 0.35),
    )
    .with_source("Vesenjak & Ren 2007, sloshing under 30 g")
    .with_shear_modulus(shear_modulus(3e9, 0.35))
}

/// Water at its physical sound speed: ρ₀ 1000 kg/m³, C₀ 1480 m/s, S 1.92, Γ 0.1 on the full
/// Hugoniot, μ 10⁻³ Pa s (as used for SPH water by Vesenjak & Ren 2007).
#[must_use]
pub fn water<T: Real>() -> Material<T> {
    Material::new("water", MieGruneisen::new(1000.0, 1480.0, 1.92, 0.1))
        .with_source("shock line of Vesenjak & Ren 2007; viscosity at 20 °C")
        .with_dynamic_viscosity(1.0e-3)
}

/// Water at a chosen sound speed: Tait's law with γ = 7, ρ₀ 1000 kg/m³, physical c₀ 1480 m/s, μ 10⁻³
/// Pa s. [`Liquid`] makes it on the linear law, other liquids likewise, and prints what each costs.
///
/// ```
/// use meshfree::material::{Material, SoundSpeed, catalogue};
/// // For flow up to 2 m/s, at a tenth of the speed of sound.
/// let water: Material<f64> = catalogue::water_at(SoundSpeed::artificial(2.0));
/// assert!((water.state(1000.0, 0.0).1 - 20.0).abs() < 1e-12);
/// assert!(water.problems().is_empty());
/// ```
#[must_use]
pub fn water_at<T: Real>(sound_speed: SoundSpeed) -> Material<T> {
    Liquid::water()
        .material("water", sound_speed)
        .with_source("Cole 1948; viscosity at 20 °C")
}

/// Water as a weakly compressible liquid for speeds up to `greatest_speed` \[m/s\]:
/// [`water_at`] the artificial sound speed of ten times that (Monaghan 1994).
#[must_use]
pub fn weakly_compressible_water<T: Real>(greatest_speed: f64) -> Material<T> {
    let mut water = water_at(SoundSpeed::artificial(greatest_speed));
    water.name = "weakly compressible water".into();
    water.with_source("Monaghan 1994; viscosity at 20 °C")
}

/// Air at 20 °C and 101 325 Pa: γ 1.4, ρ₀ 1.204 kg/m³, μ 1.81·10⁻⁵ Pa s. An ideal gas at rest has
/// e = p/((γ−1)ρ) = 2.104·10⁵ J/kg, not zero: give it that energy at the start.
#[must_use]
pub fn air<T: Real>() -> Material<T> {
    Material::new("air", IdealGas::new(1.4, 1.204))
        .with_source("ideal gas at 20 °C and 101325 Pa")
        .with_dynamic_viscosity(1.81e-5)
}

/// OFHC copper of the Taylor cylinders: shock line C₀ 3940 m/s, S 1.489, Γ 2.02, ρ₀ 8930 kg/m³
/// (Steinberg 1996), G 46 GPa and the strength of Johnson & Cook (1983): A 90 MPa, B 292 MPa, n 0.31, C 0.025, m 1.09,
/// melting at 1356 K, c 383 J/(kg K). Their paper was not at hand; a public table agrees on A to m and 1356 K.
#[must_use]
pub fn ofhc_copper<T: Real>() -> Material<T> {
    Material::new(
        "ofhc-copper",
        MieGruneisen::new(8930.0, 3940.0, 1.489, 2.02),
    )
    .with_source("shock line: Steinberg 1996; strength: Johnson & Cook 1983")
    .with_yield_stress(90e6)
    .with_strength(johnson_cook([90e6, 292e6, 0.31], 0.025, (1.09, 1356.0)))
    .with_plastic_heating(PlasticHeating::new(383.0))
    .with_shear_modulus(46e9)
}

/// 4340 steel of the Taylor cylinders: ρ₀ 7830 kg/m³, bulk modulus 159 GPa, linear, and G 77 GPa, the
/// values customary in hydrocodes; A 792 MPa, B 510 MPa, n 0.26, C 0.014, m 1.03 (Johnson & Cook 1983), melting at
/// 1793 K, c 477 J/(kg K). Their paper was not at hand: A to m agree with a public table, the last two are from memory.
#[must_use]
pub fn steel_4340<T: Real>() -> Material<T> {
    Material::new("steel-4340", Linear::from_bulk_modulus(7830.0, 159e9))
        .with_source(TAYLOR)
        .with_yield_stress(792e6)
        .with_strength(johnson_cook([792e6, 510e6, 0.26], 0.014, (1.03, 1793.0)))
        .with_plastic_heating(PlasticHeating::new(477.0))
        .with_shear_modulus(77e9)
}

/// Armco iron of the Taylor cylinders: ρ₀ 7890 kg/m³, bulk modulus 164 GPa, linear, and G 80 GPa, the
/// values customary in hydrocodes; A 175 MPa, B 380 MPa, n 0.32, C 0.060, m 0.55, melting at 1811 K, c 452 J/(kg K)
/// (Johnson & Cook 1983). Their paper was not at hand: the constants are from memory.
#[must_use]
pub fn armco_iron<T: Real>() -> Material<T> {
    Material::new("armco-iron", Linear::from_bulk_modulus(7890.0, 164e9))
        .with_source(TAYLOR)
        .with_yield_stress(175e6)
        .with_strength(johnson_cook([175e6, 380e6, 0.32], 0.060, (0.55, 1811.0)))
        .with_plastic_heating(PlasticHeating::new(452.0))
        .with_shear_modulus(80e9)
}

/// 6061-T6 aluminium of the Taylor cylinders: ρ₀ 2703 kg/m³, C₀ 5240 m/s, S 1.40, Γ 1.97, Y₀ 0.29 GPa,
/// G 27.6 GPa (Steinberg 1996), with the strength of Steinberg, Cochran & Guinan (1980): Y_max 0.68 GPa, β 125, n 0.10,
/// A 6.52·10⁻¹¹ 1/Pa, B 6.16·10⁻⁴ 1/K, as public code quotes them; c 885 J/(kg K), customary.
#[must_use]
pub fn aluminium_6061_t6<T: Real>() -> Material<T> {
    Material::new(
        "aluminium-6061-t6",
        MieGruneisen::new(2703.0, 5240.0, 1.40, 1.97),
    )
    .with_source("Steinberg 1996; strength: Steinberg, Cochran & Guinan 1980")
    .with_yield_stress(0.29e9)
    .with_strength(
        SteinbergGuinan::new(0.29e9, 0.68e9, 125.0, 0.10)
            .with_pressure(6.52e-11)
            .with_softening(6.16e-4),
    )
    .with_plastic_heating(PlasticHeating::new(885.0))
    .with_shear_modulus(27.6e9)
}

/// Aluminium of the hypervelocity plate: ρ₀ 2785 kg/m³, C₀ 5328 m/s, S 1.338, Γ 2.0, G 27.6 GPa,
/// Y₀ 0.3 GPa (Howell & Ball 2002, material table C).
#[must_use]
pub fn hypervelocity_aluminium<T: Real>() -> Material<T> {
    Material::new(
        "hypervelocity-aluminium",
        MieGruneisen::new(2785.0, 5328.0, 1.338, 2.0),
    )
    .with_source(HOWELL)
    .with_yield_stress(0.3e9)
    .with_shear_modulus(27.6e9)
}

/// Steel of the hypervelocity projectile: ρ₀ 7900 kg/m³, C₀ 4600 m/s, S 1.49, Γ 2.17, G 85.3 GPa,
/// Y₀ 0.979 GPa (Howell & Ball 2002, material table C).
#[must_use]
pub fn hypervelocity_steel<T: Real>() -> Material<T> {
    Material::new(
        "hypervelocity-steel",
        MieGruneisen::new(7900.0, 4600.0, 1.49, 2.17),
    )
    .with_source(HOWELL)
    .with_yield_stress(0.979e9)
    .with_shear_modulus(85.3e9)
}

/// Copper of the code-to-code Taylor bar at 227 m/s: ρ₀ 8930 kg/m³, E 117 GPa, ν 0.35, linear,
/// Y₀ 0.4 GPa with linear hardening of 0.1 GPa (Simo 1992 and later finite-element work).
#[must_use]
pub fn benchmark_copper<T: Real>() -> Material<T> {
    Material::new(
        "benchmark-copper",
        Linear::from_elastic_constants(8930.0, 117e9, 0.35),
    )
    .with_source("Taylor bar benchmark, Simo 1992")
    .with_yield_stress(0.4e9)
    .with_strength(LinearHardening::new(0.4e9, 0.1e9))
    .with_shear_modulus(shear_modulus(117e9, 0.35))
}

/// FullCure M730, the photopolymer of the open cells: E 2323 MPa, ν 0.3, yield 49 MPa in tension and 91 MPa
/// in compression (Vesenjak & Ren 2007), linear. The constants of its rate effect are not given there, and are left
/// out. Its density is not given there: 1180 kg/m³, usual
/// for acrylic photopolymers, is an assumption.
#[must_use]
pub fn fullcure_m730<T: Real>() -> Material<T> {
    Material::new(
        "fullcure-m730",
        Linear::from_elastic_constants(1180.0, 2323e6, 0.3),
    )
    .with_source("Vesenjak & Ren 2007; density assumed")
    .with_yield_stress(49e6)
    .with_strength(TensionCompression::new(49e6, 91e6))
    .with_shear_modulus(shear_modulus(2323e6, 0.3))
}

/// The law of Johnson & Cook with A and B \[Pa\] and n, C, and m with the melting point \[K\].
fn johnson_cook(
    [yield_stress, hardening, exponent]: [f64; 3],
    rate_sensitivity: f64,
    (softening, melting): (f64, f64),
) -> JohnsonCook {
    JohnsonCook::new(yield_stress, hardening, exponent)
        .with_rate_sensitivity(rate_sensitivity)
        .with_softening(softening, melting)
}

/// G = E / (2 (1 + ν)).
fn shear_modulus(youngs_modulus: f64, poisson: f64) -> f64 {
    youngs_modulus / (2.0 * (1.0 + poisson))
}

/// A material name that the catalogue does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown material `{given}`; known are {}", NAMES.join(", "))]
pub struct UnknownMaterial {
    /// The name that was given.
    pub given: String,
}

impl From<UnknownMaterial> for Problem {
    fn from(unknown: UnknownMaterial) -> Self {
        Problem::UnknownMaterial {
            name: unknown.given,
            known: NAMES.join(", "),
        }
    }
}

impl From<UnknownMaterial> for Error {
    fn from(unknown: UnknownMaterial) -> Self {
        Error::Argument(unknown.into())
    }
}

macro_rules! names {
    ($($name:literal $function:ident),* $(,)?) => {
        /// The names that [`by_name`] knows.
        pub const NAMES: &[&str] = &[$($name),*];

        /// The material of that name; case does not matter, and `_` and blanks count as `-`.
        ///
        /// # Errors
        /// [`UnknownMaterial`], whose message lists the names.
        pub fn by_name<T: Real>(name: &str) -> Result<Material<T>, UnknownMaterial> {
            match name.trim().to_ascii_lowercase().replace(['_', ' '], "-").as_str() {
                $($name => Ok($function()),)*
                _ => Err(UnknownMaterial { given: name.to_owned() }),
            }
        }
    };
}
names! {
    "copper" copper,
    "steel" steel,
    "aluminium" aluminium,
    "pmma" pmma,
    "tank-pmma" tank_pmma,
    "water" water,
    "air" air,
    "ofhc-copper" ofhc_copper,
    "steel-4340" steel_4340,
    "armco-iron" armco_iron,
    "aluminium-6061-t6" aluminium_6061_t6,
    "hypervelocity-aluminium" hypervelocity_aluminium,
    "hypervelocity-steel" hypervelocity_steel,
    "benchmark-copper" benchmark_copper,
    "fullcure-m730" fullcure_m730,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_to_its_material() {
        for name in NAMES {
            let material: Material<f64> = by_name(name).expect("a known name");
            assert_eq!(material.name, *name);
            assert!(material.problems().is_empty() && !material.source.is_empty());
            let rest = material.reference_density();
            assert!(material.state(rest, 0.0).0.abs() < 1e-9);
        }
        assert_eq!(
            by_name::<f32>("OFHC copper").map(|m| m.name),
            Ok("ofhc-copper".into())
        );
        let message = by_name::<f32>("unobtainium")
            .map_err(|e| e.to_string())
            .err();
        assert!(message.is_some_and(|m| m.contains("`unobtainium`") && m.contains("pmma")));
    }

    /// The law of every solid yields at first at the stress that its reports name, but for polymers with a pair.
    #[test]
    fn strengths_begin_at_the_yield_stress() {
        let room = crate::material::strength::PlasticState {
            temperature: 298.15,
            ..Default::default()
        };
        for name in NAMES {
            let material: Material<f64> = by_name(name).expect("a known name");
            let Some(law) = material.strength() else {
                assert!(material.yield_stress.is_none(), "{name}");
                continue;
            };
            if law.uses_temperature() {
                assert!(material.plastic_heating().is_some(), "{name}");
            }
            let pulled = crate::material::strength::PlasticState {
                pressure: -10e6 * f64::from(u8::from(*name == "fullcure-m730")),
                ..room
            };
            let ratio = law.yield_stress(&pulled) / material.yield_stress.unwrap_or(f64::NAN);
            // Steinberg's constants are those of 300 K.
            assert!((ratio - 1.0).abs() < 2e-3, "{name} {ratio}");
        }
        assert!(copper::<f64>().strength().is_some() && water::<f64>().strength().is_none());
    }

    /// Z = ρ₀C₀ of table 2 \[10⁶ kg/(m² s)\], and the Hugoniot state of a 20 m/s copper impact.
    #[test]
    fn lam_impedances() {
        let rows = [
            (copper::<f64>(), 35.184),
            (steel(), 28.025),
            (aluminium(), 14.445),
            (pmma(), 3.094),
        ];
        for (material, stated) in rows {
            assert!(
                (material.impedance() * 1e-6 - stated).abs() < 6e-4,
                "{}",
                material.name
            );
        }
    }

    /// The state behind the shock of a symmetric copper impact at 20 m/s: u_p = 10 m/s.
    #[test]
    fn copper_shock_of_the_rod_impact() {
        let (rho0, c, s, u) = (8930.0, 3940.0, 1.49, 10.0);
        let shock = c + s * u;
        let pressure = rho0 * shock * u;
        let (p, _) = copper::<f64>().state(rho0 * shock / (shock - u), 0.5 * u * u);
        assert!((p / pressure - 1.0).abs() < 1e-7, "{p} against {pressure}");
        assert!((p / 353.17e6 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn elastic_constants() {
        assert_eq!(
            air::<f64>()
                .state(1.204, 101_325.0 / (0.4 * 1.204))
                .0
                .round(),
            101_325.0
        );
        let bulk = |m: Material<f64>| m.impedance().powi(2) / m.reference_density();
        assert!((bulk(fullcure_m730()) / 1.9358e9 - 1.0).abs() < 1e-4);
        assert!((bulk(benchmark_copper()) / 130e9 - 1.0).abs() < 1e-12);
        let speed = weakly_compressible_water::<f64>(2.0).impedance() / 1000.0;
        assert!((speed - 20.0).abs() < 1e-9);
    }
}
