//! What advice on a scene asks of the user, because no scene holds it.
//! Each is an `Option` or has a customary value; numbers that need what is not given are left out, and named.

use crate::error::Problem;

/// What a scene does not say of itself.
///
/// ```
/// use meshfree::scene::advice::Known;
/// // A tank of water with air above it.
/// let known = Known { surface_tension: Some(0.072), gas_density: Some(1.2), ..Known::default() };
/// assert_eq!(known.gravity, 9.81);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Known {
    /// Gravity g \[m/s²\] where the scene is; 9.81 unless set, 0 in space.
    pub gravity: f64,
    /// Pressure p \[Pa\] around the scene; that of the atmosphere, 101 325, unless set.
    pub ambient_pressure: f64,
    /// Vapour pressure p_v \[Pa\] of liquids; 2339 unless set, that of water at 20 °C.
    pub vapour_pressure: f64,
    /// Speed U \[m/s\] of the flow, where bodies, walls and loads do not tell it.
    pub speed: Option<f64>,
    /// Physical sound speed c \[m/s\] of liquids that are computed with an artificial one.
    pub sound_speed: Option<f64>,
    /// Surface tension σ \[N/m\].
    pub surface_tension: Option<f64>,
    /// Density \[kg/m³\] of a gas next to the liquid that the scene leaves out.
    pub gas_density: Option<f64>,
    /// Whether liquid can close in pockets of that gas.
    pub trapped_gas: Option<bool>,
    /// Coefficient α of the artificial viscosity.
    pub artificial_viscosity: Option<f64>,
    /// Young's modulus E \[Pa\], density \[kg/m³\] and thickness \[m\] of walls that the scene takes as rigid.
    pub wall: Option<[f64; 3]>,
    /// Smallest width \[m\] of a gap, channel or film of liquid.
    pub gap: Option<f64>,
    /// Slope S of the shock line u_s = c + S u, of solids whose law is linear; metals have about 1.5.
    pub shock_slope: Option<f64>,
    /// Grüneisen parameter Γ of solids whose law has no energy; metals have about 2.
    pub gruneisen: Option<f64>,
    /// Thermal diffusivity κ \[m²/s\].
    pub diffusivity: Option<f64>,
    /// Rate of strain ε̇ \[1/s\], where impacts and clamps do not tell it.
    pub strain_rate: Option<f64>,
}

impl Default for Known {
    /// On the ground, in air, with water; nothing else is known.
    fn default() -> Self {
        Self {
            gravity: 9.81,
            ambient_pressure: 101_325.0,
            vapour_pressure: 2339.0,
            speed: None,
            sound_speed: None,
            surface_tension: None,
            gas_density: None,
            trapped_gas: None,
            artificial_viscosity: None,
            wall: None,
            gap: None,
            shock_slope: None,
            gruneisen: None,
            diffusivity: None,
            strain_rate: None,
        }
    }
}

impl Known {
    /// What is wrong with the numbers.
    pub(super) fn problems(&self) -> Vec<Problem> {
        let [modulus, density, thickness] = self.wall.map_or([None; 3], |wall| wall.map(Some));
        let all = [
            ("gravity", Some(self.gravity)),
            ("ambient_pressure", Some(self.ambient_pressure)),
            ("vapour_pressure", Some(self.vapour_pressure)),
            ("speed", self.speed),
            ("sound_speed", self.sound_speed),
            ("surface_tension", self.surface_tension),
            ("gas_density", self.gas_density),
            ("artificial_viscosity", self.artificial_viscosity),
            ("modulus of the wall", modulus),
            ("density of the wall", density),
            ("thickness of the wall", thickness),
            ("gap", self.gap),
            ("shock_slope", self.shock_slope),
            ("gruneisen", self.gruneisen),
            ("diffusivity", self.diffusivity),
            ("strain_rate", self.strain_rate),
        ];
        let wrong = |value: &f64| !(value.is_finite() && *value >= 0.0);
        let known = all
            .into_iter()
            .filter_map(|(name, value)| Some((name, value.filter(wrong)?)));
        known
            .map(|(name, value)| Problem::Parameter {
                what: format!("{name} of what is known of the scene"),
                value,
                must_be: "it must be finite and not negative, in SI units",
            })
            .collect()
    }
}
