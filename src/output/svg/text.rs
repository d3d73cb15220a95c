//! Text in plots: labels with raised and lowered parts, and an estimate of their width.
//! Without fonts at hand the width is that of a common sans-serif face.

use super::super::xml_escape;

/// Splits `10^{-3} m_{0}` into parts and their shift: 1 raised, -1 lowered, 0 neither.
pub(in crate::output) fn parts(text: &str) -> Vec<(i8, &str)> {
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(['^', '_']) {
        let shift = if rest[at..].starts_with('^') { 1 } else { -1 };
        let after = &rest[at + 1..];
        if let Some((inner, behind)) = after.strip_prefix('{').and_then(|s| s.split_once('}')) {
            parts.push((0, &rest[..at]));
            parts.push((shift, inner));
            rest = behind;
        } else {
            parts.push((0, &rest[..=at]));
            rest = after;
        }
    }
    parts.push((0, rest));
    parts.retain(|(_, part)| !part.is_empty());
    parts
}

/// The label as SVG content, at a font size.
pub(super) fn markup(text: &str, size: f64) -> String {
    let mut markup = String::new();
    let mut height = 0.0;
    for (shift, part) in parts(text) {
        let escaped = xml_escape(part);
        let wanted = match shift {
            1 => -0.36 * size,
            -1 => 0.2 * size,
            _ => 0.0,
        };
        let dy = wanted - height;
        if shift == 0 && dy == 0.0 {
            markup += &escaped;
        } else if shift == 0 {
            markup += &format!("<tspan dy=\"{dy:.1}\">{escaped}</tspan>");
        } else {
            let small = 0.74 * size;
            markup += &format!("<tspan dy=\"{dy:.1}\" font-size=\"{small:.1}\">{escaped}</tspan>");
        }
        height = wanted;
    }
    markup
}

/// The width of the label, at a font size.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '|' | '\'' | '!' | ' ' => 0.3,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '/' => 0.37,
        'm' | 'w' | 'M' | 'W' | '%' | '=' | '+' | '−' | '×' => 0.86,
        'A'..='Z' => 0.7,
        _ => 0.58,
    };
    parts(text)
        .into_iter()
        .map(|(shift, part)| {
            let scale = if shift == 0 { size } else { 0.74 * size };
            scale * part.chars().map(em).sum::<f64>()
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raised_parts_come_back_down() {
        assert_eq!(
            markup("10^{-3} m", 10.0),
            "10<tspan dy=\"-3.6\" font-size=\"7.4\">-3</tspan><tspan dy=\"3.6\"> m</tspan>"
        );
        assert_eq!(markup("a_b<c^", 10.0), "a_b&lt;c^");
        assert!(width("wide", 10.0) > width("will", 10.0));
    }
}
