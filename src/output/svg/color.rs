//! Colours that people with colour-blindness tell apart, and a colour map of even lightness.
//! On a white ground, and still distinct in grey.

use core::fmt;

/// A colour as red, green and blue.
///
/// ```
/// use meshfree::output::svg::Color;
/// assert_eq!(Color(255, 0, 16).to_string(), "#ff0010");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color(pub u8, pub u8, pub u8);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// The colours that series take in turn.
///
/// ```
/// use meshfree::output::svg::{PALETTE, Series};
/// let exact = Series::line("", [(0.0, 1.0), (1.0, 2.0)]).color(PALETTE[0]).dashed();
/// # let _ = exact;
/// ```
pub const PALETTE: [Color; 8] = [
    Color(0, 105, 180),
    Color(213, 84, 0),
    Color(0, 150, 110),
    Color(190, 80, 150),
    Color(214, 150, 0),
    Color(74, 170, 222),
    Color(104, 70, 160),
    Color(120, 120, 120),
];

const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// The viridis colour map, from 0 to 1.
///
/// ```
/// use meshfree::output::svg::{Color, viridis};
/// assert_eq!(viridis(0.0), Color(68, 1, 84));
/// ```
#[must_use]
pub fn viridis(fraction: f64) -> Color {
    let place = fraction.clamp(0.0, 1.0) * 8.0;
    let below = (place as usize).min(7);
    let part = place - below as f64;
    let [r, g, b]: [u8; 3] = core::array::from_fn(|c| {
        let (low, high) = (VIRIDIS[below][c], VIRIDIS[below + 1][c]);
        (low + part * (high - low)).round() as u8
    });
    Color(r, g, b)
}
