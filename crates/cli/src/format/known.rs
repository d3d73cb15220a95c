//! What advice asks for, because no scene holds it.
//! Each key is that of `Known` in the library.

use meshfree::scene::advice;
use schemars::JsonSchema;
use serde::Deserialize;

/// What a scene does not say of itself, for the advice of `check`. Nothing of it changes a run.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Known {
    /// Gravity where the scene is, in m/s²; 9.81 if not given.
    pub gravity: Option<f64>,
    /// Pressure around the scene, in Pa; 101325 if not given.
    pub ambient_pressure: Option<f64>,
    /// Vapour pressure of liquids, in Pa; 2339 if not given.
    pub vapour_pressure: Option<f64>,
    /// Speed of the flow, in m/s, where bodies, walls and loads do not tell it.
    pub speed: Option<f64>,
    /// Physical sound speed of liquids with an artificial one, in m/s.
    pub sound_speed: Option<f64>,
    /// Surface tension, in N/m.
    pub surface_tension: Option<f64>,
    /// Density of a gas next to the liquid that the scene leaves out, in kg/m³.
    pub gas_density: Option<f64>,
    /// Whether liquid can close in pockets of that gas.
    pub trapped_gas: Option<bool>,
    /// Coefficient of the artificial viscosity.
    pub artificial_viscosity: Option<f64>,
    /// Young's modulus in Pa, density in kg/m³ and thickness in m of walls that the scene takes as rigid.
    pub wall: Option<[f64; 3]>,
    /// Smallest width of a gap, channel or film of liquid, in m.
    pub gap: Option<f64>,
    /// Slope of the shock line of solids whose law is linear.
    pub shock_slope: Option<f64>,
    /// Grüneisen parameter of solids whose law has no energy.
    pub gruneisen: Option<f64>,
    /// Thermal diffusivity, in m²/s.
    pub diffusivity: Option<f64>,
    /// Rate of strain, in 1/s, where impacts and clamps do not tell it.
    pub strain_rate: Option<f64>,
}

impl From<&Known> for advice::Known {
    fn from(own: &Known) -> Self {
        let usual = Self::default();
        Self {
            gravity: own.gravity.unwrap_or(usual.gravity),
            ambient_pressure: own.ambient_pressure.unwrap_or(usual.ambient_pressure),
            vapour_pressure: own.vapour_pressure.unwrap_or(usual.vapour_pressure),
            speed: own.speed,
            sound_speed: own.sound_speed,
            surface_tension: own.surface_tension,
            gas_density: own.gas_density,
            trapped_gas: own.trapped_gas,
            artificial_viscosity: own.artificial_viscosity,
            wall: own.wall,
            gap: own.gap,
            shock_slope: own.shock_slope,
            gruneisen: own.gruneisen,
            diffusivity: own.diffusivity,
            strain_rate: own.strain_rate,
        }
    }
}
