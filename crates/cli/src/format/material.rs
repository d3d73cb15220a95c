//! Materials by numbers.
//! What is wrong with numbers the library says, at the field of the material.

use schemars::JsonSchema;
use serde::Deserialize;

/// A material: one of `catalogue`, `liquid`, `linear`, `mie_gruneisen` and `ideal_gas`, and what else is known of it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// A name of the catalogue, whose constants those below replace.
    pub catalogue: Option<String>,
    /// A liquid, on Tait's law or on the linear one.
    pub liquid: Option<LiquidLaw>,
    /// Pressure in proportion to compression, p = c² (ρ − ρ₀).
    pub linear: Option<Elastic>,
    /// A solid on its shock line.
    pub mie_gruneisen: Option<MieGruneisenLaw>,
    /// An ideal gas.
    pub ideal_gas: Option<Gas>,
    /// Least pressure, zero or negative, in Pa.
    pub pressure_cut_off: Option<f64>,
    /// Shear modulus G, in Pa.
    pub shear_modulus: Option<f64>,
    /// Yield stress and what changes it.
    pub strength: Option<Strength>,
}

/// A liquid. Without `sound_speed` and `greatest_speed` it has its physical sound speed.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiquidLaw {
    /// Density ρ₀, in kg/m³.
    pub density: f64,
    /// Physical sound speed, in m/s; 1480 if not given.
    pub physical_sound_speed: Option<f64>,
    /// Dynamic viscosity, in Pa s; 0.001 if not given.
    pub dynamic_viscosity: Option<f64>,
    /// The sound speed to compute with, in m/s.
    pub sound_speed: Option<f64>,
    /// The greatest speed that is expected, in m/s: it is computed with ten times that as sound speed.
    pub greatest_speed: Option<f64>,
    /// Whether to take the linear law in place of Tait's.
    #[serde(default)]
    pub linear: bool,
}

/// Density, and either a sound speed or elastic constants.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    /// Density ρ₀, in kg/m³.
    pub density: f64,
    /// Sound speed √(K/ρ₀), in m/s.
    pub sound_speed: Option<f64>,
    /// Young's modulus, in Pa, with `poissons_ratio`; they give the shear modulus too.
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio.
    pub poissons_ratio: Option<f64>,
}

/// Constants of a shock line.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MieGruneisenLaw {
    /// Density ρ₀, in kg/m³.
    pub density: f64,
    /// C₀, in m/s.
    pub sound_speed: f64,
    /// S of the shock line u_s = C₀ + S u.
    pub slope: f64,
    /// Grüneisen's Γ.
    pub gruneisen: f64,
    /// The curve through the shock line; `full` if not given.
    pub form: Option<Shock>,
}

/// How pressure follows from the shock line.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shock {
    /// The whole Hugoniot curve.
    Full,
    /// The cubic of Lam, Shen & Gong, equations 4 to 6.
    LamCubic,
}

/// An ideal gas, p = (γ − 1) ρ e.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gas {
    /// Ratio of specific heats.
    pub gamma: f64,
    /// Density ρ₀, in kg/m³.
    pub density: f64,
}

/// A yield stress, and its linear hardening.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Strength {
    /// Yield stress, in Pa.
    pub yield_stress: f64,
    /// Rise of the yield stress with plastic strain, in Pa; none if not given.
    pub hardening: Option<f64>,
}
