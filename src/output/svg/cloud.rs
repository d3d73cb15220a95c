//! Particles as dots, coloured by a value, and the bar that says which colour is which.
//! All dots of one colour share a path, as one element each would make large files.

use super::color::{Color, viridis};
use super::draw::{Prepared, TICK, power_label, widest};
use super::ink::{label, stroke, upright};
use super::path::px;
use std::fmt::Write as _;

pub(super) const BAR: f64 = 12.0;
const LABEL: f64 = 12.5;
const COLORS: usize = 64;

impl Prepared<'_> {
    pub(super) fn cloud(&self, body: &mut String, w: f64, h: f64) {
        let (Some(cloud), Some((scale, _))) = (&self.panel.cloud, &self.bar) else {
            return;
        };
        let per_unit = if self.x.log {
            0.0
        } else {
            w / (self.x.high - self.x.low)
        };
        let diameter = cloud.diameter.map_or(3.0, |d| (d * per_unit).max(0.6));
        // One path for each colour; values that are not finite come last, in grey.
        let mut paths = vec![String::new(); COLORS + 1];
        let reach = diameter;
        for &(x, y, value) in &cloud.points {
            let at = self.place((x, y), w, h);
            let inside =
                (-reach..=w + reach).contains(&at.0) && (-reach..=h + reach).contains(&at.1);
            if inside {
                let fraction = scale.place(value);
                let level = if fraction.is_nan() {
                    COLORS
                } else {
                    ((fraction * COLORS as f64).max(0.0) as usize).min(COLORS - 1)
                };
                let tenth = |v: f64| (v * 10.0).round() / 10.0 + 0.0;
                let _ = write!(paths[level], "M{} {}h0", tenth(at.0), tenth(at.1));
            }
        }
        for (level, data) in paths
            .iter()
            .enumerate()
            .filter(|(_, data)| !data.is_empty())
        {
            let color = if level == COLORS {
                Color(170, 170, 170)
            } else {
                level_color(level)
            };
            let _ = writeln!(
                body,
                "<path d=\"{data}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\" \
                 stroke-linecap=\"round\"/>",
                px(diameter)
            );
        }
    }

    pub(super) fn color_bar(&self, body: &mut String, w: f64, h: f64) {
        let (Some(cloud), Some((scale, ticks))) = (&self.panel.cloud, &self.bar) else {
            return;
        };
        let left = w + 10.0;
        let step = h / COLORS as f64;
        for level in 0..COLORS {
            let y = h - step * (level + 1) as f64;
            // Each reaches beneath the one above, so that no seam shows.
            let height = if level == 0 { step } else { 1.5 * step };
            let _ = writeln!(
                body,
                "<rect x=\"{}\" y=\"{}\" width=\"{BAR}\" height=\"{}\" fill=\"{}\"/>",
                px(left),
                px(y),
                px(height),
                level_color(level)
            );
        }
        let mut lines = format!("M{} 0h{BAR}v{}h-{BAR}z", px(left), px(h));
        let mut free = f64::INFINITY;
        for (value, text) in &ticks.major {
            let at = h * (1.0 - scale.place(*value));
            let _ = write!(lines, "M{} {}h4", px(left + BAR), px(at));
            // A flat map has a short bar: labels that would touch the one below are left out.
            if at + 6.0 <= free {
                let place = (left + BAR + 7.0, at + 4.0);
                label(body, place, TICK, "start", "", text);
                free = at - 7.0;
            }
        }
        stroke(body, &lines, Color(60, 60, 60), 0.9, None);
        let power = power_label(ticks);
        label(body, (left, -5.0), TICK, "start", "", &power);
        let beside = (left + BAR + 22.0 + widest(ticks), 0.5 * h);
        upright(body, beside, LABEL, &cloud.value.label);
    }
}

fn level_color(level: usize) -> Color {
    viridis((level as f64 + 0.5) / COLORS as f64)
}
