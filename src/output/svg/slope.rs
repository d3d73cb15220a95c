//! Triangles that show a slope beside the data of a log-log panel.
//! Each stands by the curve whose own slope is nearest.

use super::axis::signed;
use super::color::Color;
use super::draw::{Frame, Prepared, TICK};
use super::ink::{Point, label, stroke};
use super::path::{distinct, px, thin};

/// A curve in pixels.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) points: Vec<Point>,
    /// Whether a line joins the points.
    pub(super) line: bool,
    /// The exponent of the power law nearest to it.
    pub(super) exponent: Option<f64>,
}

impl Prepared<'_> {
    /// Draws the slope triangles where they are near the data and touch nothing.
    pub(super) fn triangles(
        &self,
        body: &mut String,
        curves: &[Curve],
        mut taken: Vec<Frame>,
        w: f64,
        h: f64,
    ) {
        if !self.x.log || !self.y.log {
            return;
        }
        let samples = spread(curves, w, h);
        for &slope in &self.panel.slopes {
            let steepness =
                slope * (h / (self.y.high - self.y.low)) * (self.x.high - self.x.low) / w;
            let run = (0.16 * w).min(0.3 * h / steepness.abs().max(1e-9));
            let rise = run * steepness;
            let tall = rise.abs();
            let far = |curve: &&Curve| (curve.exponent.unwrap_or(f64::INFINITY) - slope).abs();
            let mut nearest: Vec<&Curve> = curves.iter().collect();
            nearest.sort_by(|a, b| far(a).total_cmp(&far(b)));
            let found = nearest.into_iter().find_map(|curve| {
                let own = spread(core::slice::from_ref(curve), w, h);
                let mut places = (0..20).flat_map(|i| [(i, true), (i, false)]);
                places.find_map(|(index, below)| {
                    let left = 0.72 * w * (1.0 - f64::from(index) / 20.0) + 20.0;
                    let line = |x: f64| -(x - left) * steepness;
                    let near = own
                        .iter()
                        .filter(|p| (left - 14.0..=left + run + 14.0).contains(&p.0));
                    let gaps = near.map(|p| p.1 - line(p.0));
                    let shift = if below {
                        gaps.fold(f64::NEG_INFINITY, f64::max) + 12.0
                    } else {
                        gaps.fold(f64::INFINITY, f64::min) - 12.0
                    };
                    let top = shift - rise.max(0.0);
                    let area = Frame {
                        x: left - 14.0,
                        y: top - if below { 0.0 } else { 16.0 },
                        w: run + 28.0,
                        h: tall + 16.0,
                    };
                    let inside =
                        area.y >= 3.0 && area.y + area.h <= h - 3.0 && area.x + area.w <= w;
                    // On the triangle's side of its longest edge, or just beyond.
                    let beside = |p: &Point| match below {
                        true => p.1 > line(p.0) + shift - 6.0,
                        false => p.1 < line(p.0) + shift + 6.0,
                    };
                    let covers = |p: &Point| area.holds(*p) && beside(p);
                    let free = taken.iter().all(|other| !area.overlaps(other));
                    let good = shift.is_finite() && inside && free && !samples.iter().any(covers);
                    good.then_some((left, top, below, area))
                })
            });
            let Some((left, top, below, area)) = found else {
                continue;
            };
            taken.push(area);
            let (right, bottom) = (left + run, top + tall);
            let upwards = slope >= 0.0;
            let leg = if below { bottom } else { top };
            let side = if upwards == below { right } else { left };
            let (from, to) = if upwards {
                (bottom, top)
            } else {
                (top, bottom)
            };
            let data = format!(
                "M{} {}L{} {}L{} {}z",
                px(left),
                px(from),
                px(right),
                px(to),
                px(side),
                px(leg)
            );
            stroke(body, &data, Color(90, 90, 90), 1.0, None);
            let across = (
                0.5 * (left + right),
                if below { leg + 12.0 } else { leg - 4.0 },
            );
            label(body, across, TICK, "middle", "", "1");
            let (at, anchor) = if side == right {
                (right + 4.0, "start")
            } else {
                (left - 4.0, "end")
            };
            let text = signed(&slope.abs().to_string());
            label(body, (at, top + 0.5 * tall + 4.0), TICK, anchor, "", &text);
        }
    }
}

/// Places along the curves a few pixels apart, for what should not hide them.
pub(super) fn spread(curves: &[Curve], w: f64, h: f64) -> Vec<Point> {
    let mut samples = Vec::new();
    for curve in curves {
        let thinned = thin(&curve.points);
        samples.extend(distinct(&thinned, w, h));
        for pair in thinned.windows(2).filter(|_| curve.line) {
            let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            let steps = (dx.hypot(dy) / 4.0).min(400.0) as u32;
            for step in 1..steps {
                let t = f64::from(step) / f64::from(steps);
                samples.push((pair[0].0 + t * dx, pair[0].1 + t * dy));
            }
        }
    }
    samples
}
