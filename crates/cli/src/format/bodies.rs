//! Bodies: a material in a place, with the state it starts from.
//! Of the keys that say where a body is, a file gives one.

use super::Shape;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// A body: one of `block`, `fill`, `packed` and `points` says where it is.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// A name of `material`, or of the catalogue.
    pub material: String,
    /// Particle spacing, in m.
    pub spacing: f64,
    /// A box, filled by a lattice that fits it.
    pub block: Option<Corners>,
    /// A shape, filled by a lattice from its lowest corner.
    pub fill: Option<Shape>,
    /// A shape, filled by particles that follow its surface.
    pub packed: Option<Shape>,
    /// A CSV file with columns x, y and z of places, in m.
    pub points: Option<PathBuf>,
    /// Velocity, in m/s; at rest if not given.
    pub velocity: Option<Vec<f64>>,
    /// Density at the start, in kg/m³; that of the material if not given.
    pub density: Option<f64>,
    /// Internal energy at the start, in J/kg.
    pub energy: Option<f64>,
    /// A point of the free surface, in m: pressure grows from there along `gravity`.
    pub hydrostatic: Option<Vec<f64>>,
    /// Particles off their lattice, at random.
    pub jitter: Option<Jitter>,
    /// Whether liquid sticks to it.
    #[serde(default)]
    pub no_slip: bool,
    /// Parts that do not move.
    #[serde(default)]
    pub fix: Vec<Shape>,
    /// Whether it moves as a rigid body.
    #[serde(default)]
    pub rigid: bool,
}

/// A box by two corners.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Corners {
    /// Lowest corner, in m.
    pub low: Vec<f64>,
    /// Highest corner, in m.
    pub high: Vec<f64>,
}

/// Random displacements from the lattice.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Jitter {
    /// Largest displacement along each axis over the spacing, from 0 to 0.3.
    pub share: f64,
    /// Another number is another draw; 1 if not given.
    pub seed: Option<u64>,
}
