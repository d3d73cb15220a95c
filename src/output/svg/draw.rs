//! The drawing of one panel: grid, ticks, labels, data, legend.
//! Data is clipped by a nested picture, so that no names are needed that could clash on a page.

use super::axis::{Scale, Ticks};
use super::color::{Color, PALETTE, viridis};
use super::figure::{Legend, Panel};
use super::fit::power_law;
use super::path::{curve, distinct, px, thin};
use super::series::{Marker, Series};
use super::text::{markup, width};
use std::fmt::Write as _;

type Point = (f64, f64);

const TICK: f64 = 11.0;
const LABEL: f64 = 12.5;
const TITLE: f64 = 13.0;
const LEGEND: f64 = 11.5;
const LEGEND_LINE: f64 = 16.0;
const SAMPLE: f64 = 26.0;
const BAR: f64 = 12.0;
const COLORS: usize = 64;

/// The frame of a panel in the figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) w: f64,
    pub(super) h: f64,
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

/// A line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    label: String,
    color: Color,
    dash: Option<&'static str>,
    line: Option<f64>,
    marker: Option<Marker>,
}

pub(super) fn entry_width(entry: &Entry) -> f64 {
    SAMPLE + 6.0 + width(&entry.label, LEGEND)
}

/// Draws an entry with its upper left corner at a place.
pub(super) fn legend_entry(body: &mut String, entry: &Entry, x: f64, y: f64) {
    let middle = y + 0.5 * LEGEND_LINE;
    if let Some(line) = entry.line {
        let data = format!("M{} {}h{SAMPLE}", px(x), px(middle));
        stroke(body, &data, entry.color, line, entry.dash);
    }
    if let Some(shape) = entry.marker {
        markers(body, shape, entry.color, &[(x + 0.5 * SAMPLE, middle)]);
    }
    let place = (x + SAMPLE + 6.0, middle + 4.0);
    label(body, place, LEGEND, "start", "", &entry.label);
}

fn stroke(body: &mut String, data: &str, color: Color, width: f64, dash: Option<&str>) {
    if data.is_empty() {
        return;
    }
    let dash = dash.map_or_else(String::new, |dash| format!(" stroke-dasharray=\"{dash}\""));
    let _ = writeln!(
        body,
        "<path d=\"{data}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
         stroke-linejoin=\"round\"{dash}/>"
    );
}

fn label(body: &mut String, at: Point, size: f64, anchor: &str, more: &str, text: &str) {
    if text.is_empty() {
        return;
    }
    let _ = writeln!(
        body,
        "<text x=\"{}\" y=\"{}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{more}>{}</text>",
        px(at.0),
        px(at.1),
        markup(text, size)
    );
}

/// A label that reads upwards, centred at a place.
fn upright(body: &mut String, at: Point, size: f64, text: &str) {
    let turn = format!(" transform=\"rotate(-90 {} {})\"", px(at.0), px(at.1));
    label(body, at, size, "middle", &turn, text);
}

fn markers(body: &mut String, shape: Marker, color: Color, points: &[Point]) {
    let mut data = String::new();
    for &(x, y) in points {
        let (x, y) = (px(x), px(y));
        let _ = match shape {
            Marker::Circle | Marker::Ring => {
                write!(data, "M{} {y}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0z", px(x - 3.0))
            }
            Marker::Square => write!(data, "M{} {}h5.4v5.4h-5.4z", px(x - 2.7), px(y - 2.7)),
            Marker::Triangle => write!(data, "M{x} {}l3.6 6.2h-7.2z", px(y - 4.0)),
            Marker::Diamond => write!(data, "M{x} {}l3.8 3.8l-3.8 3.8l-3.8 -3.8z", px(y - 3.8)),
            Marker::Cross => write!(data, "M{} {}l6 6m0 -6l-6 6", px(x - 3.0), px(y - 3.0)),
        };
    }
    if data.is_empty() {
        return;
    }
    let style = match shape {
        Marker::Ring => format!("fill=\"#ffffff\" stroke=\"{color}\" stroke-width=\"1.4\""),
        Marker::Cross => format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"1.4\""),
        _ => format!("fill=\"{color}\" stroke=\"#ffffff\" stroke-width=\"0.5\""),
    };
    let _ = writeln!(body, "<path d=\"{data}\" {style}/>");
}

/// A panel whose scales, ticks and margins are known.
#[derive(Debug)]
pub(super) struct Prepared<'a> {
    panel: &'a Panel,
    x: Scale,
    y: Scale,
    x_ticks: Ticks,
    y_ticks: Ticks,
    /// The scale and ticks of the colour bar.
    bar: Option<(Scale, Ticks)>,
    pub(super) margins: Margins,
}

fn widest(ticks: &Ticks) -> f64 {
    let widths = ticks.major.iter().map(|(_, label)| width(label, TICK));
    widths.fold(0.0, f64::max)
}

fn power_label(ticks: &Ticks) -> String {
    match ticks.power {
        0 => String::new(),
        power => super::axis::signed(&format!("×10^{{{power}}}")),
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
            let scale = cloud.value.scale(cloud.points.iter().map(|p| p.2), 0.0);
            (scale, scale.ticks((size.1 - 70.0) / 38.0))
        });
        let x_ticks = x.ticks(((size.0 - 80.0) / 62.0).max(2.0));
        let y_ticks = y.ticks(((size.1 - 70.0) / 38.0).max(2.0));
        let named = |text: &str, room: f64| if text.is_empty() { 0.0 } else { room };
        let power = bar.iter().any(|(_, ticks)| ticks.power != 0) || y_ticks.power != 0;
        let beside = match (&panel.cloud, &bar) {
            (Some(cloud), Some((_, ticks))) => {
                10.0 + BAR + 8.0 + widest(ticks) + named(&cloud.value.label, 20.0)
            }
            _ => 0.0,
        };
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
                super::axis::signed(&format!(" (slope {:.2})", law.exponent))
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
        self.color_bar(body, w, h);
        let samples = spread(&curves, w, h);
        let mut taken = Vec::new();
        if with_legend {
            taken.extend(self.legend(body, &samples, w, h));
        }
        self.triangles(body, &samples, taken, w, h);
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

    fn place(&self, (x, y): Point, w: f64, h: f64) -> Point {
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
    fn data(&self, body: &mut String, w: f64, h: f64) -> Vec<(bool, Vec<Point>)> {
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
            if let Some(law) = series.fitted.then(|| power_law(&series.points)).flatten() {
                let usable = |(x, y): &&Point| *x > 0.0 && *y > 0.0;
                let xs = series.points.iter().filter(usable).map(|p| p.0);
                let low = xs.clone().fold(f64::INFINITY, f64::min);
                let high = xs.fold(0.0, f64::max);
                let ends = (0..=40).map(|i| low * (high / low).powf(f64::from(i) / 40.0));
                let line: Vec<Point> = ends.map(|x| self.place((x, law.at(x)), w, h)).collect();
                stroke(body, &curve(&line, w, h), color, 1.0, Some("2 3"));
                curves.push((true, line));
            }
            if series.line {
                let data = curve(&points, w, h);
                stroke(body, &data, color, series.width, dash(series));
            }
            if let Some(shape) = series.marker {
                markers(body, shape, color, &distinct(&points, w, h));
            }
            curves.push((series.line, points));
        }
        curves
    }

    fn cloud(&self, body: &mut String, w: f64, h: f64) {
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

    fn color_bar(&self, body: &mut String, w: f64, h: f64) {
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
        for (value, text) in &ticks.major {
            let at = h * (1.0 - scale.place(*value));
            let _ = write!(lines, "M{} {}h4", px(left + BAR), px(at));
            let place = (left + BAR + 7.0, at + 4.0);
            label(body, place, TICK, "start", "", text);
        }
        stroke(body, &lines, Color(60, 60, 60), 0.9, None);
        let power = power_label(ticks);
        label(body, (left, -5.0), TICK, "start", "", &power);
        let beside = (left + BAR + 22.0 + widest(ticks), 0.5 * h);
        upright(body, beside, LABEL, &cloud.value.label);
    }

    /// Draws the legend and gives the rectangle it takes.
    fn legend(&self, body: &mut String, samples: &[Point], w: f64, h: f64) -> Option<Frame> {
        const GAP: f64 = 7.0;
        let entries: Vec<Entry> = self.entries().collect();
        if entries.is_empty() || self.panel.legend == Legend::Hidden {
            return None;
        }
        let wide = entries.iter().map(entry_width).fold(0.0, f64::max) + 12.0;
        let high = entries.len() as f64 * LEGEND_LINE + 6.0;
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
            let inside =
                |p: &&Point| (x..=x + wide).contains(&p.0) && (y..=y + high).contains(&p.1);
            samples.iter().filter(inside).count()
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
            let top = y + 3.0 + LEGEND_LINE * index as f64;
            legend_entry(body, entry, x + 6.0, top);
        }
        Some(Frame {
            x,
            y,
            w: wide,
            h: high,
        })
    }

    /// Draws the slope triangles where they are near the data and touch nothing.
    fn triangles(
        &self,
        body: &mut String,
        samples: &[Point],
        mut taken: Vec<Frame>,
        w: f64,
        h: f64,
    ) {
        if !self.x.log || !self.y.log {
            return;
        }
        for &slope in &self.panel.slopes {
            let steepness =
                slope * (h / (self.y.high - self.y.low)) * (self.x.high - self.x.low) / w;
            let run = (0.16 * w).min(0.3 * h / steepness.abs().max(1e-9));
            let rise = run * steepness;
            let tall = rise.abs();
            let mut places = (0..20).flat_map(|i| [(i, true), (i, false)]);
            let found = places.find_map(|(index, below)| {
                let left = 0.72 * w * (1.0 - f64::from(index) / 20.0) + 20.0;
                let line = |x: f64| -(x - left) * steepness;
                let near = samples
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
                    y: top - if below { 0.0 } else { 14.0 },
                    w: run + 28.0,
                    h: tall + 14.0,
                };
                let inside = area.y >= 3.0 && area.y + area.h <= h - 3.0 && area.x + area.w <= w;
                let free = taken.iter().all(|other| !overlap(&area, other));
                (shift.is_finite() && inside && free).then_some((left, top, below, area))
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
            let text = super::axis::signed(&slope.abs().to_string());
            label(body, (at, top + 0.5 * tall + 4.0), TICK, anchor, "", &text);
        }
    }
}

fn overlap(a: &Frame, b: &Frame) -> bool {
    a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h
}

fn level_color(level: usize) -> Color {
    viridis((level as f64 + 0.5) / COLORS as f64)
}

fn dash(series: &Series) -> Option<&'static str> {
    match (series.dashed, series.reference) {
        (true, true) => Some("4 3"),
        (true, false) => Some("7 4"),
        _ => None,
    }
}

/// Places along the curves a few pixels apart, for what should not hide them.
fn spread(curves: &[(bool, Vec<Point>)], w: f64, h: f64) -> Vec<Point> {
    let mut samples = Vec::new();
    for (line, points) in curves {
        let thinned = thin(points);
        samples.extend(distinct(&thinned, w, h));
        for pair in thinned.windows(2).filter(|_| *line) {
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
