//! Shapes, which fill bodies and walls.
//! Shapes are combined by union, intersection and difference.

use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// A region of space. Lengths in metres.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A box by two corners.
    Cuboid {
        /// Lowest corner.
        low: Vec<f64>,
        /// Highest corner.
        high: Vec<f64>,
    },
    /// A ball, or a disc in a plane.
    Ball {
        /// Centre.
        centre: Vec<f64>,
        /// Radius.
        radius: f64,
    },
    /// A cylinder with flat ends, in three dimensions.
    Cylinder {
        /// Middle of one end.
        start: Vec<f64>,
        /// Middle of the other.
        end: Vec<f64>,
        /// Radius.
        radius: f64,
    },
    /// All behind a plane.
    HalfSpace {
        /// A point of the plane.
        point: Vec<f64>,
        /// Out of the half space.
        normal: Vec<f64>,
    },
    /// A closed surface of triangles in an STL file, in three dimensions.
    Mesh {
        /// The file, found from the folder of the scene file.
        file: PathBuf,
        /// Metres of a unit of the file: 0.001 for millimetres.
        unit: f64,
    },
    /// What is in any of several shapes.
    Union(Vec<Shape>),
    /// What is in all of several shapes.
    Intersection(Vec<Shape>),
    /// What is in the first shape and in none of the others.
    Minus(Vec<Shape>),
}
