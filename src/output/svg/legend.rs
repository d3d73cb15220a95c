//! Legends: in a panel, where they hide least of the data, or one below all panels.
//! Their width rests on an estimate, as no fonts are at hand.

use super::color::Color;
use super::draw::{Frame, Prepared};
use super::ink::{Point, label, markers, stroke};
use super::path::px;
use super::series::Marker;
use super::text::width;
use std::fmt::Write as _;

const SIZE: f64 = 11.5;
const LINE: f64 = 16.0;
const SAMPLE: f64 = 26.0;

/// Where the legend of a panel stands.
///
/// ```
/// use meshfree::output::svg::{Axis, Legend, Panel};
/// let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m")).legend(Legend::TopLeft);
/// # let _ = panel;
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// Where it hides least of the data.
    #[default]
    Auto,
    /// In the upper left corner.
    TopLeft,
    /// In the upper right corner.
    TopRight,
    /// In the lower left corner.
    BottomLeft,
    /// In the lower right corner.
    BottomRight,
    /// Nowhere.
    Hidden,
}

/// A line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) label: String,
    pub(super) color: Color,
    pub(super) dash: Option<&'static str>,
    pub(super) line: Option<f64>,
    pub(super) marker: Option<Marker>,
}

fn entry_width(entry: &Entry) -> f64 {
    SAMPLE + 6.0 + width(&entry.label, SIZE)
}

/// Draws an entry with its upper left corner at a place.
fn legend_entry(body: &mut String, entry: &Entry, x: f64, y: f64) {
    let middle = y + 0.5 * LINE;
    if let Some(line) = entry.line {
        let data = format!("M{} {}h{SAMPLE}", px(x), px(middle));
        stroke(body, &data, entry.color, line, entry.dash);
    }
    if let Some(shape) = entry.marker {
        markers(body, shape, entry.color, &[(x + 0.5 * SAMPLE, middle)]);
    }
    let place = (x + SAMPLE + 6.0, middle + 4.0);
    label(body, place, SIZE, "start", "", &entry.label);
}

impl Prepared<'_> {
    /// Draws the legend and gives the rectangle it takes.
    pub(super) fn legend(
        &self,
        body: &mut String,
        samples: &[Point],
        w: f64,
        h: f64,
    ) -> Option<Frame> {
        const GAP: f64 = 7.0;
        let entries: Vec<Entry> = self.entries().collect();
        if entries.is_empty() || self.panel.legend == Legend::Hidden {
            return None;
        }
        let wide = entries.iter().map(entry_width).fold(0.0, f64::max) + 12.0;
        let high = entries.len() as f64 * LINE + 6.0;
        let (right, lower) = (w - wide - GAP, h - high - GAP);
        let (center, middle) = (0.5 * (w - wide), 0.5 * (h - high));
        let all = [
            (right, GAP),
            (GAP, GAP),
            (right, lower),
            (GAP, lower),
            (right, middle),
            (GAP, middle),
            (center, GAP),
            (center, lower),
        ];
        let hidden = |&(x, y): &Point| {
            let area = Frame {
                x,
                y,
                w: wide,
                h: high,
            };
            samples.iter().filter(|p| area.holds(**p)).count()
        };
        let (x, y) = match self.panel.legend {
            Legend::TopRight => all[0],
            Legend::TopLeft => all[1],
            Legend::BottomRight => all[2],
            Legend::BottomLeft => all[3],
            _ => all.into_iter().min_by_key(hidden).unwrap_or(all[0]),
        };
        let _ = writeln!(
            body,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"2\" fill=\"#ffffff\" \
             fill-opacity=\"0.85\"/>",
            px(x),
            px(y),
            px(wide),
            px(high)
        );
        for (index, entry) in entries.iter().enumerate() {
            let top = y + 3.0 + LINE * index as f64;
            legend_entry(body, entry, x + 6.0, top);
        }
        Some(Frame {
            x,
            y,
            w: wide,
            h: high,
        })
    }
}

/// Draws the entries in centred rows and gives their height.
pub(super) fn shared_legend(body: &mut String, entries: &[Entry], width: f64, top: f64) -> f64 {
    const GAP: f64 = 18.0;
    const ROW: f64 = 19.0;
    let mut rows: Vec<(f64, Vec<&Entry>)> = Vec::new();
    for entry in entries {
        let needed = entry_width(entry) + GAP;
        match rows.last_mut() {
            Some((used, row)) if *used + needed <= width - 20.0 => {
                *used += needed;
                row.push(entry);
            }
            _ => rows.push((needed, vec![entry])),
        }
    }
    for (index, (used, row)) in rows.iter().enumerate() {
        let mut x = 0.5 * (width - used + GAP);
        for entry in row {
            legend_entry(body, entry, x, top + ROW * index as f64);
            x += entry_width(entry) + GAP;
        }
    }
    rows.len() as f64 * ROW + 8.0
}
