//! The format of scene files: what a file may say, as serde reads it and the schema prints it.
//! Names are those of the library; lengths are in metres, times in seconds, all else in SI units.

mod bodies;
mod known;
mod material;
mod outputs;
mod scheme;
mod shape;
mod table;
mod walls;

pub use bodies::{Body, Corners, Jitter};
pub use known::Known;
pub use material::{Elastic, Gas, LiquidLaw, Material, MieGruneisenLaw, Shock, Strength};
pub use outputs::{Axis, Gauge, Output, Point, Probe, Quantity, Run, Schedule, Window};
pub use scheme::{GasScheme, ImpactScheme, LiquidScheme, Scheme, SolidScheme, SpongeLayer, Steps};
pub use shape::Shape;
pub use table::Table;
pub use walls::{
    Around, Between, Interaction, Mirror, Motion, Outlet, Periodic, Recorded, Turn, Wall,
};

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A scene of meshfree: what there is, what acts on it, how long it runs and what is written.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Name of the run; that of the file if not given.
    pub title: Option<String>,
    /// Dimensions of space: 1, 2 or 3.
    pub dimension: u8,
    /// The scheme, which is the physics of all bodies.
    pub scheme: Scheme,
    /// How the time step is chosen.
    pub steps: Option<Steps>,
    /// Materials by name. Those of the catalogue need no entry.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// Bodies.
    #[serde(default)]
    pub body: Vec<Body>,
    /// Walls of particles, at rest or moved.
    #[serde(default)]
    pub wall: Vec<Wall>,
    /// Mirror planes: rigid walls without friction, and planes of symmetry.
    #[serde(default)]
    pub mirror_plane: Vec<Mirror>,
    /// Periodic directions.
    #[serde(default)]
    pub periodic: Vec<Periodic>,
    /// Places beyond which particles leave.
    #[serde(default)]
    pub outlet: Vec<Outlet>,
    /// What two bodies do to each other.
    #[serde(default)]
    pub between: Vec<Between>,
    /// Constant acceleration of all particles, in m/s².
    pub gravity: Option<Vec<f64>>,
    /// Accelerations of all particles by time, in m/s²: straight lines between rows, zero beyond them.
    #[serde(default)]
    pub acceleration: Vec<Table>,
    /// What advice asks for beside the scene.
    #[serde(default)]
    pub known: Known,
    /// When the run ends.
    pub run: Run,
    /// What is written.
    #[serde(default)]
    pub output: Output,
    /// Pressure sensors on walls.
    #[serde(default)]
    pub probe: Vec<Probe>,
    /// Gauges of the height of a liquid.
    #[serde(default)]
    pub gauge: Vec<Gauge>,
    /// Places at which a field is written.
    #[serde(default)]
    pub point: Vec<Point>,
}
