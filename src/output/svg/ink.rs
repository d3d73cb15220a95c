//! Strokes, labels and markers as SVG elements.
//! Places are in pixels.

use super::color::Color;
use super::path::px;
use super::series::Marker;
use super::text::markup;
use std::fmt::Write as _;

pub(super) type Point = (f64, f64);

pub(super) fn stroke(body: &mut String, data: &str, color: Color, width: f64, dash: Option<&str>) {
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

pub(super) fn label(body: &mut String, at: Point, size: f64, anchor: &str, more: &str, text: &str) {
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
pub(super) fn upright(body: &mut String, at: Point, size: f64, text: &str) {
    let turn = format!(" transform=\"rotate(-90 {} {})\"", px(at.0), px(at.1));
    label(body, at, size, "middle", &turn, text);
}

pub(super) fn markers(body: &mut String, shape: Marker, color: Color, points: &[Point]) {
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
