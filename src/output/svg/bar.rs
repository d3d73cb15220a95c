//! The bar beside coloured particles that says which colour is which value.
//! Values share a few dozen colours, so that all dots of one can share a path.

use super::axis::{Axis, Scale, Ticks};
use super::color::{Color, viridis};
use super::draw::{TICK, power_label, widest};
use super::ink::{label, stroke, upright};
use super::path::px;
use std::fmt::Write as _;

const WIDTH: f64 = 12.0;
const LABEL: f64 = 12.5;
/// The number of colours.
pub(in crate::output) const LEVELS: usize = 64;
/// The colour of values that have no place on the scale.
const UNKNOWN: Color = Color(170, 170, 170);

/// A colour bar whose scale and ticks are known.
#[derive(Debug)]
pub(in crate::output) struct Bar {
    pub(in crate::output) label: String,
    pub(in crate::output) scale: Scale,
    pub(in crate::output) ticks: Ticks,
}

impl Bar {
    /// The bar for these values, with as many ticks as a height has room for.
    pub(in crate::output) fn new(
        axis: &Axis,
        values: impl Iterator<Item = f64>,
        height: f64,
    ) -> Self {
        let scale = axis.scale(values, 0.0);
        Self {
            label: axis.label.clone(),
            scale,
            ticks: scale.ticks(height / 38.0),
        }
    }

    /// The number of a value's colour, or [`LEVELS`] where it has none.
    pub(in crate::output) fn level(&self, value: f64) -> usize {
        let fraction = self.scale.place(value);
        if fraction.is_nan() {
            LEVELS
        } else {
            ((fraction * LEVELS as f64).max(0.0) as usize).min(LEVELS - 1)
        }
    }

    /// The room that it takes beside a picture.
    pub(in crate::output) fn room(&self) -> f64 {
        let named = if self.label.is_empty() { 0.0 } else { 20.0 };
        10.0 + WIDTH + 8.0 + widest(&self.ticks) + named
    }

    /// Draws it beside a picture of width `w`.
    pub(in crate::output) fn draw(&self, body: &mut String, w: f64, h: f64) {
        let left = w + 10.0;
        let step = h / LEVELS as f64;
        for level in 0..LEVELS {
            let y = h - step * (level + 1) as f64;
            // Each reaches beneath the one above, so that no seam shows.
            let height = if level == 0 { step } else { 1.5 * step };
            let _ = writeln!(
                body,
                "<rect x=\"{}\" y=\"{}\" width=\"{WIDTH}\" height=\"{}\" fill=\"{}\"/>",
                px(left),
                px(y),
                px(height),
                level_color(level)
            );
        }
        let mut lines = format!("M{} 0h{WIDTH}v{}h-{WIDTH}z", px(left), px(h));
        let mut free = f64::INFINITY;
        for (value, text) in &self.ticks.major {
            let at = h * (1.0 - self.scale.place(*value));
            let _ = write!(lines, "M{} {}h4", px(left + WIDTH), px(at));
            // A flat map has a short bar: labels that would touch the one below are left out.
            if at + 6.0 <= free {
                let place = (left + WIDTH + 7.0, at + 4.0);
                label(body, place, TICK, "start", "", text);
                free = at - 7.0;
            }
        }
        stroke(body, &lines, Color(60, 60, 60), 0.9, None);
        let power = power_label(&self.ticks);
        label(body, (left, -5.0), TICK, "start", "", &power);
        let beside = (left + WIDTH + 22.0 + widest(&self.ticks), 0.5 * h);
        upright(body, beside, LABEL, &self.label);
    }
}

/// The colour of a level.
pub(in crate::output) fn level_color(level: usize) -> Color {
    if level >= LEVELS {
        return UNKNOWN;
    }
    viridis((level as f64 + 0.5) / LEVELS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::svg::{Cloud, Figure, Panel};

    /// Colours of the rectangles of the bar in a written figure, from the bottom to the top.
    fn bar(figure: &str) -> Vec<String> {
        let width = format!(" width=\"{WIDTH}\" ");
        let rectangles = figure.lines().filter(|line| line.starts_with("<rect "));
        let of_bar = rectangles.filter(|line| line.contains(&width));
        let fill = |line: &str| Some(line.split_once("fill=\"")?.1.split_once('"')?.0.to_owned());
        of_bar.filter_map(fill).collect()
    }

    #[test]
    fn the_ends_of_a_bar_have_the_colours_of_the_map_and_of_the_particles_there() {
        let points = [(0.0, 0.0, 0.0), (1.0, 0.0, 1.0), (2.0, 0.0, 0.5)];
        let values = Axis::linear("pressure", "Pa").range(0.0, 1.0);
        let cloud = Cloud::new(values, points).diameter(0.5);
        let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m")).cloud(cloud);
        let path = std::env::temp_dir().join(format!("meshfree_bar_{}.svg", std::process::id()));
        Figure::new().panel(panel).save(&path).expect("a figure");
        let figure = std::fs::read_to_string(&path).expect("the figure");
        std::fs::remove_file(&path).expect("the figure");
        let bar = bar(&figure);
        assert_eq!(bar.len(), LEVELS);
        // viridis by van der Walt and Smith: #440154 to #fde725.
        let ends = [
            (&bar[0], [0x44, 0x01, 0x54]),
            (&bar[LEVELS - 1], [0xfd, 0xe7, 0x25]),
        ];
        for (own, exact) in ends {
            let channel = |c: usize| i32::from_str_radix(&own[1 + 2 * c..3 + 2 * c], 16);
            for (c, exact) in exact.into_iter().enumerate() {
                let written = channel(c).expect("a colour");
                // Half a level of 64 is up to four of 256.
                assert!((written - exact).abs() <= 5, "{own}, the map has {exact}");
            }
            let uses = figure.matches(own.as_str()).count();
            assert!(uses >= 2, "no particle has the colour {own} of the bar");
        }
    }
}
