//! When a run ends, and what it writes.
//! Schedules and criteria are those of `meshfree::run`.

use schemars::JsonSchema;
use serde::Deserialize;

/// The end of the run: its time, or what comes before.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The time at which it ends, in s.
    pub until: f64,
    /// Ends when the kinetic energy is steady.
    pub steady: Option<Window>,
    /// Ends when all has come to rest.
    pub at_rest: Option<Window>,
    /// Ends when the sum of kinetic and internal energy is off by this share of that at the start.
    pub energy_drift: Option<f64>,
    /// Ends after this time on the wall, in s.
    pub wall_clock: Option<f64>,
}

/// A share of the largest kinetic energy, over some time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Share of the largest kinetic energy of the run.
    pub share: f64,
    /// For how long, in s.
    pub over: f64,
}

/// What is written, beside `particles.csv` with the last state and `receipt.json`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The folder, from where the program is run; `out/` and the name of the file if not given. `--out` goes before it.
    pub folder: Option<String>,
    /// When particles are written for ParaView, to `particles.pvd`; not at all if not given.
    pub paraview: Option<Schedule>,
    /// When mass, momentum, energies and forces on walls are written to `history.csv`; at 101 times if not given.
    pub history: Option<Schedule>,
    /// When `probe`, `gauge` and `point` are written to `probes.csv`; at 501 times if not given.
    pub probes: Option<Schedule>,
    /// When `checkpoint.safetensors` is written, from which `run --resume` goes on; not at all if not given.
    pub checkpoint: Option<Schedule>,
}

/// Times: those of each key together.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Schedule {
    /// Every so many seconds.
    pub every: Option<f64>,
    /// So many times, from the start to the end.
    pub evenly: Option<usize>,
    /// At these times, in s.
    #[serde(default)]
    pub at: Vec<f64>,
    /// After every so many steps.
    pub steps: Option<u64>,
}

/// A pressure sensor on a wall.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Its name, which is that of its column.
    pub name: String,
    /// Its centre in the scene as built, in m.
    pub centre: Vec<f64>,
    /// Normal of the surface.
    pub normal: Vec<f64>,
    /// Its diameter, in m.
    pub diameter: f64,
    /// The wall that it moves with.
    pub on_wall: Option<String>,
}

/// A gauge of the height of a liquid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gauge {
    /// Its name, which is that of its column.
    pub name: String,
    /// Where it begins, in m.
    pub foot: Vec<f64>,
    /// The direction in which it measures.
    pub axis: Axis,
    /// The wall that it moves with.
    pub on_wall: Option<String>,
}

/// A place at which a field is written.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Its name, which is that of its columns.
    pub name: String,
    /// The place, in m.
    pub at: Vec<f64>,
    /// What is written.
    pub field: Quantity,
}

/// A field of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// In Pa.
    Pressure,
    /// In kg/m³.
    Density,
    /// In m/s, a column for each axis.
    Velocity,
    /// In J/kg.
    Energy,
}

/// An axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}
