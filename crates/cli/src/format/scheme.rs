//! Schemes of the library that are compiled in, with their options.
//! Options that are not given have the values of the library, or those of its example.

use schemars::JsonSchema;
use serde::Deserialize;

/// One of the ready schemes. An empty table takes the defaults of the library.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Liquids with a free surface, in 2D and 3D.
    WeaklyCompressible(LiquidScheme),
    /// Impact of rods without shear, in 1D.
    Impact(ImpactScheme),
    /// Solids with shear and strength that flow, in 2D and 3D.
    UpdatedLagrangian(SolidScheme),
    /// Gases, in 1D and 2D.
    Gas(GasScheme),
}

/// Options of weakly compressible liquids.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LiquidScheme {
    /// Coefficient of the artificial viscosity; 0.02 if not given.
    pub alpha: Option<f64>,
    /// Strength of the density diffusion; 0.1 if not given.
    pub delta: Option<f64>,
    /// Smoothing length over spacing; 1.5 if not given.
    pub h_over_dx: Option<f64>,
    /// Strength of the damping of sound; 0 if not given.
    pub acoustic_damping: Option<f64>,
    /// Whether density remembers what it was stretched by, for violent flows; no if not given.
    #[serde(default)]
    pub expansion_memory: bool,
    /// Lowest pressure that walls show the liquid, in Pa; 0 if not given, `-inf` where it fills what encloses it.
    pub wall_floor: Option<f64>,
    /// A layer that takes up what runs into it.
    pub sponge: Option<SpongeLayer>,
}

/// A layer that takes up what runs into it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpongeLayer {
    /// A point of the plane at which it begins, in m.
    pub place: Vec<f64>,
    /// Into the layer.
    pub normal: Vec<f64>,
    /// Its thickness, in m.
    pub thickness: f64,
    /// The rate at its end, in 1/s: that of the waves for a layer of one wave length.
    pub rate: f64,
}

/// Options of impact.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImpactScheme {
    /// Linear coefficient of the artificial viscosity; 2 if not given.
    pub alpha: Option<f64>,
    /// Quadratic coefficient of it; 2 if not given.
    pub beta: Option<f64>,
    /// Smoothing length over spacing; 1.2 if not given.
    pub h_over_dx: Option<f64>,
}

/// Options of solids, which take Wendland's C2 kernel, plasticity, and the remedy `HourglassFree`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidScheme {
    /// Linear coefficient of the artificial viscosity; 0.5 if not given.
    pub alpha: Option<f64>,
    /// Quadratic coefficient of it; 2 if not given.
    pub beta: Option<f64>,
    /// Smoothing length over spacing; 2 if not given, for spacings grow where a solid flows.
    pub h_over_dx: Option<f64>,
}

/// Options of gases.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasScheme {
    /// Linear coefficient of the artificial viscosity; 1 if not given.
    pub alpha: Option<f64>,
    /// Quadratic coefficient of it; 1 if not given.
    pub beta: Option<f64>,
    /// Smoothing length over spacing; that of the scheme if not given.
    pub h_over_dx: Option<f64>,
}

/// The time step.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    /// Factor on h/c; that of the scheme if not given.
    pub courant: Option<f64>,
    /// A fixed step, in s.
    pub fixed: Option<f64>,
    /// Times at which a step ends, in s: where a load has a kink.
    #[serde(default)]
    pub end_at: Vec<f64>,
}
