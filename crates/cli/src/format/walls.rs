//! Walls, planes, periods, outlets, motions, and what bodies do to each other.
//! Motions are given by tables, for a file holds no functions.

use super::outputs::Axis;
use super::{Shape, Table};
use schemars::JsonSchema;
use serde::Deserialize;

/// A wall of particles: one of `around`, `layers_of` and `fill` says where it is.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Its name.
    pub name: String,
    /// Particle spacing, in m.
    pub spacing: f64,
    /// Layers around a box that holds the liquid.
    pub around: Option<Around>,
    /// Layers around a shape that holds the liquid.
    pub layers_of: Option<Shape>,
    /// A shape that is the wall itself.
    pub fill: Option<Shape>,
    /// How many layers; as many as the kernel reaches if not given.
    pub layers: Option<usize>,
    /// Motions, one after the other; at rest without.
    #[serde(default)]
    pub motion: Vec<Motion>,
    /// Whether liquid sticks to it.
    #[serde(default)]
    pub no_slip: bool,
    /// Velocity of its surface beside its motion, in m/s: a lid or a belt.
    pub sliding: Option<Vec<f64>>,
    /// Whether it takes the liquid with it, as a tank does and a piston does not.
    #[serde(default)]
    pub container_frame: bool,
}

/// A box that holds liquid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Around {
    /// Lowest corner, in m.
    pub low: Vec<f64>,
    /// Highest corner, in m.
    pub high: Vec<f64>,
    /// For each axis, whether its lower and its upper end are closed; all are if not given.
    pub closed: Option<Vec<[bool; 2]>>,
}

/// A motion of a wall.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// A constant velocity, in m/s.
    Velocity(Vec<f64>),
    /// Rows of time and displacement, in m, with a smooth curve through them.
    Displacement(Recorded),
    /// Rows of time and acceleration, in m/s²: straight lines between rows, zero beyond them.
    Acceleration(Table),
    /// Rows of time and angle, with a smooth curve through them.
    Rotation(Turn),
}

/// A recorded displacement.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Recorded {
    /// Times and displacements.
    pub table: Table,
    /// Whether it rests before the first and after the last row; else a run may not go beyond them.
    #[serde(default)]
    pub at_rest_beyond: bool,
}

/// A recorded rotation.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// A point that stays, in m.
    pub centre: Vec<f64>,
    /// Direction of the axis, in three dimensions; the third if not given.
    pub axis: Option<Vec<f64>>,
    /// Times and angles, in rad.
    pub table: Table,
    /// Whether it rests before the first and after the last row; else a run may not go beyond them.
    #[serde(default)]
    pub at_rest_beyond: bool,
}

/// A mirror plane.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mirror {
    /// A point of the plane, in m.
    pub point: Vec<f64>,
    /// Out of the material.
    pub normal: Vec<f64>,
    /// Whether it is a plane of symmetry, from which nothing parts; else a wall, which opens.
    #[serde(default)]
    pub symmetry: bool,
    /// Velocity along the normal, in m/s.
    pub velocity: Option<f64>,
}

/// A direction that repeats.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periodic {
    /// The direction.
    pub axis: Axis,
    /// Lower end of a period, in m.
    pub low: f64,
    /// Upper end of it, in m.
    pub high: f64,
}

/// Beyond a plane, or outside of a box, particles leave.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Outlet {
    /// Beyond a plane.
    Plane {
        /// A point of the plane, in m.
        point: Vec<f64>,
        /// Towards where particles leave.
        normal: Vec<f64>,
    },
    /// Outside of a box.
    OutsideBox {
        /// Lowest corner, in m.
        low: Vec<f64>,
        /// Highest corner, in m.
        high: Vec<f64>,
    },
}

/// What two bodies do to each other, or a body and a wall of particles.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Between {
    /// A body.
    pub first: String,
    /// Another body, or a wall of particles.
    pub second: String,
    /// How they act on each other.
    pub interaction: Interaction,
    /// Coefficient of friction of a contact; 0 if not given.
    pub friction: Option<f64>,
}

/// How two bodies act on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interaction {
    /// As one body.
    Bonded,
    /// Compression alone.
    Unilateral,
    /// Not at all.
    None,
    /// By the coupling `ContactDensity`, as a solid and a wall of particles do.
    Contact,
}
