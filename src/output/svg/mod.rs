//! Plots as SVG: lines, steps, markers and coloured particles, in one panel or a grid of them.
//! Thinned to what can be seen, so that long histories make small files.

mod axis;
mod color;
mod draw;
mod figure;
mod fit;
mod path;
mod series;
mod text;

pub use axis::Axis;
pub use color::{Color, PALETTE, viridis};
pub use figure::{Figure, Legend, Panel};
pub use fit::{PowerLaw, power_law};
pub use series::{Cloud, Marker, Series};
