//! The drawing of one panel: grid, ticks, labels, data, legend.
//! Data is clipped by a nested picture, so that no names are needed that could clash on a page.

use super::axis::{Scale, Ticks, signed};
use super::bar::Bar;
use super::color::{Color, PALETTE};
use super::fit::power_law;
use super::ink::{Point, label, markers, stroke, upright};
use super::legend::Entry;
use super::panel::Panel;
use super::path::{curve, distinct, px};
use super::series::Series;
use super::slope::{Curve, spread};
use super::text::width;
use std::fmt::Write as _;

pub(super) const TICK: f64 = 11.0;
const LABEL: f64 = 12.5;
const TITLE: f64 = 13.0;

/// The frame of a panel in the figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) w: f64,
    pub(super) h: f64,
}

impl Frame {
    pub(super) fn holds(&self, (x, y): Point) -> bool {
        (self.x..=self.x + self.w).contains(&x) && (self.y..=self.y + self.h).contains(&y)
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.x < other.x + other.w
            && other.x < self.x + self.w
            && self.y < other.y + other.h
            && other.y < self.y + self.h
    }
}

/// The room around the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margins {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

impl Margins {
    pub(super) fn grow(&mut self, other: &Self, same_column: bool, same_row: bool) {
        if same_column {
            self.left = self.left.max(other.left);
            self.right = self.right.max(other.right);
        }
        if same_row {
            self.top = self.top.max(other.top);
            self.bottom = self.bottom.max(other.bottom);
        }
    }
}

/// A panel whose scales, ticks and margins are known.
#[derive(Debug)]
pub(super) struct Prepared<'a> {
    pub(super) panel: &'a Panel,
    pub(super) x: Scale,
    pub(super) y: Scale,
    x_ticks: Ticks,
    y_ticks: Ticks,
    /// The colour bar.
    pub(super) bar: Option<Bar>,
    pub(super) margins: Margins,
}

pub(super) fn widest(ticks: &Ticks) -> f64 {
    let widths = ticks.major.iter().map(|(_, label)| width(label, TICK));
    widths.fold(0.0, f64::max)
}

pub(in crate::output) fn power_label(ticks: &Ticks) -> String {
    match ticks.power {
        0 => String::new(),
        power => signed(&format!("×10^{{{power}}}")),
    }
}

impl<'a> Prepared<'a> {
    pub(super) fn new(panel: &'a Panel, size: (f64, f64)) -> Self {
        let cloud = || panel.cloud.iter().flat_map(|cloud| &cloud.points);
        let points = || panel.series.iter().flat_map(|series| &series.points);
        let marked = panel.series.iter().any(|series| series.marker.is_some());
        let side = if marked || panel.cloud.is_some() {
            0.04
        } else {
            0.0
        };
        let room = if panel.slopes.is_empty() { 0.05 } else { 0.1 };
        let xs = points().map(|p| p.0).chain(cloud().map(|p| p.0));
        let ys = points().map(|p| p.1).chain(cloud().map(|p| p.1));
        let x = panel.x.scale(xs, side);
        let y = panel.y.scale(ys, room);
        let bar = panel.cloud.as_ref().map(|cloud| {
            let values = cloud.points.iter().map(|p| p.2);
            Bar::new(&cloud.value, values, size.1 - 70.0)
        });
        let x_ticks = x.ticks(((size.0 - 80.0) / 62.0).max(2.0));
        let y_ticks = y.ticks(((size.1 - 70.0) / 38.0).max(2.0));
        let named = |text: &str, room: f64| if text.is_empty() { 0.0 } else { room };
        let power = bar.iter().any(|bar| bar.ticks.power != 0) || y_ticks.power != 0;
        let beside = bar.as_ref().map_or(0.0, Bar::room);
        let margins = Margins {
            left: 20.0 + widest(&y_ticks) + named(&panel.y.label, 20.0),
            right: 16.0 + beside,
            top: 10.0 + named(&panel.title, 16.0) + if power { 8.0 } else { 0.0 },
            bottom: 24.0 + named(&panel.x.label, 22.0),
        };
        Self {
            panel,
            x,
            y,
            x_ticks,
            y_ticks,
            bar,
            margins,
        }
    }

    /// The series with the colours that they take.
    fn colored(&self) -> impl Iterator<Item = (&'a Series, Color)> {
        let mut next = 0;
        self.panel.series.iter().map(move |series| {
            let color = series.color.unwrap_or_else(|| {
                next += 1;
                PALETTE[(next - 1) % PALETTE.len()]
            });
            (series, color)
        })
    }

    pub(super) fn entries(&self) -> impl Iterator<Item = Entry> {
        let named = self
            .colored()
            .filter(|(series, _)| !series.label.is_empty());
        named.map(|(series, color)| {
            let law = series.fitted.then(|| power_law(&series.points)).flatten();
            let slope = law.map_or_else(String::new, |law| {
                signed(&format!(" (slope {:.2})", law.exponent))
            });
            Entry {
                label: format!("{}{slope}", series.label),
                color,
                dash: dash(series),
                line: series.line.then_some(series.width),
                marker: series.marker,
            }
        })
    }

    /// Draws everything into a frame.
    pub(super) fn draw(&self, body: &mut String, frame: Frame, with_legend: bool) {
        let frame = self.shaped(frame);
        let Frame { x, y, w, h } = frame;
        let _ = writeln!(body, "<g transform=\"translate({} {})\">", px(x), px(y));
        self.grid(body, w, h);
        let _ = writeln!(
            body,
            "<svg width=\"{}\" height=\"{}\" overflow=\"hidden\">",
            px(w),
            px(h)
        );
        let curves = self.data(body, w, h);
        body.push_str("</svg>\n");
        self.axes(body, w, h);
        if let Some(bar) = &self.bar {
            bar.draw(body, w, h);
        }
        let samples = spread(&curves, w, h);
        let mut taken = Vec::new();
        if with_legend {
            taken.extend(self.legend(body, &samples, w, h));
        }
        self.triangles(body, &curves, taken, w, h);
        body.push_str("</g>\n");
    }

    /// The frame, narrowed so that both axes have the same length per unit if they must.
    fn shaped(&self, frame: Frame) -> Frame {
        if !self.panel.equal || self.x.log || self.y.log {
            return frame;
        }
        let spans = (self.x.high - self.x.low, self.y.high - self.y.low);
        let unit = (frame.w / spans.0).min(frame.h / spans.1);
        let (w, h) = ((unit * spans.0).max(4.0), (unit * spans.1).max(4.0));
        Frame {
            x: frame.x + 0.5 * (frame.w - w),
            y: frame.y + 0.5 * (frame.h - h),
            w,
            h,
        }
    }

    pub(super) fn place(&self, (x, y): Point, w: f64, h: f64) -> Point {
        (w * self.x.place(x), h * (1.0 - self.y.place(y)))
    }

    fn grid(&self, body: &mut String, w: f64, h: f64) {
        let mut lines = String::new();
        for (value, _) in &self.x_ticks.major {
            let _ = write!(lines, "M{} 0v{}", px(w * self.x.place(*value)), px(h));
        }
        for (value, _) in &self.y_ticks.major {
            let at = px(h * (1.0 - self.y.place(*value)));
            let _ = write!(lines, "M0 {at}h{}", px(w));
        }
        stroke(body, &lines, Color(232, 232, 232), 0.8, None);
    }

    fn axes(&self, body: &mut String, w: f64, h: f64) {
        let mut lines = format!("M0 0h{0}v{1}h-{0}z", px(w), px(h));
        let across = |value: f64| px(w * self.x.place(value));
        let up = |value: f64| px(h * (1.0 - self.y.place(value)));
        for &(value, _) in &self.x_ticks.major {
            let _ = write!(lines, "M{} {}v4.5", across(value), px(h));
        }
        for &value in &self.x_ticks.minor {
            let _ = write!(lines, "M{} {}v2.5", across(value), px(h));
        }
        for &(value, _) in &self.y_ticks.major {
            let _ = write!(lines, "M0 {}h-4.5", up(value));
        }
        for &value in &self.y_ticks.minor {
            let _ = write!(lines, "M0 {}h-2.5", up(value));
        }
        stroke(body, &lines, Color(60, 60, 60), 0.9, None);
        // Labels that would touch the one before are left out.
        let mut free = f64::NEG_INFINITY;
        for (value, text) in &self.x_ticks.major {
            let (at, half) = (across(*value), 0.5 * width(text, TICK));
            if at - half >= free {
                label(body, (at, h + 17.0), TICK, "middle", "", text);
                free = at + half + 5.0;
            }
        }
        let mut free = f64::INFINITY;
        for (value, text) in &self.y_ticks.major {
            let at = up(*value);
            if at + 6.0 <= free {
                label(body, (-8.0, at + 4.0), TICK, "end", "", text);
                free = at - 7.0;
            }
        }
        let power = power_label(&self.x_ticks);
        label(body, (w, h + 33.0), TICK, "end", "", &power);
        let power = power_label(&self.y_ticks);
        label(body, (0.0, -5.0), TICK, "start", "", &power);
        let below = (0.5 * w, h + 36.0);
        label(body, below, LABEL, "middle", "", &self.panel.x.label);
        let beside = (-18.0 - widest(&self.y_ticks), 0.5 * h);
        upright(body, beside, LABEL, &self.panel.y.label);
        let bold = " font-weight=\"bold\"";
        let above = (0.5 * w, -8.0);
        label(body, above, TITLE, "middle", bold, &self.panel.title);
    }

    /// Draws the data and gives the curves and places in pixels.
    fn data(&self, body: &mut String, w: f64, h: f64) -> Vec<Curve> {
        self.cloud(body, w, h);
        let mut marks = String::new();
        for &x in &self.panel.marks_x {
            let at = w * self.x.place(x);
            marks += &curve(&[(at, 0.0), (at, h)], w, h);
        }
        for &y in &self.panel.marks_y {
            let at = h * (1.0 - self.y.place(y));
            marks += &curve(&[(0.0, at), (w, at)], w, h);
        }
        stroke(body, &marks, Color(130, 130, 130), 0.9, Some("1.5 2.5"));
        let mut curves = Vec::new();
        let mut last: Vec<(&Series, Color)> = self.colored().collect();
        last.sort_by_key(|(series, _)| series.reference);
        for (series, color) in last {
            let place = |&point: &Point| self.place(point, w, h);
            let points: Vec<Point> = series.points.iter().map(place).collect();
            let law = power_law(&series.points);
            if let Some(law) = law.filter(|_| series.fitted) {
                let usable = |(x, y): &&Point| *x > 0.0 && *y > 0.0;
                let xs = series.points.iter().filter(usable).map(|p| p.0);
                let low = xs.clone().fold(f64::INFINITY, f64::min);
                let high = xs.fold(0.0, f64::max);
                let ends = (0..=40).map(|i| low * (high / low).powf(f64::from(i) / 40.0));
                let line: Vec<Point> = ends.map(|x| self.place((x, law.at(x)), w, h)).collect();
                stroke(body, &curve(&line, w, h), color, 1.0, Some("2 3"));
                curves.push(Curve {
                    points: line,
                    line: true,
                    exponent: Some(law.exponent),
                });
            }
            if series.line {
                let data = curve(&points, w, h);
                stroke(body, &data, color, series.width, dash(series));
            }
            if let Some(shape) = series.marker {
                markers(body, shape, color, &distinct(&points, w, h));
            }
            curves.push(Curve {
                points,
                line: series.line,
                exponent: law.map(|law| law.exponent),
            });
        }
        curves
    }
}

fn dash(series: &Series) -> Option<&'static str> {
    match (series.dashed, series.reference) {
        (true, true) => Some("4 3"),
        (true, false) => Some("7 4"),
        _ => None,
    }
}
