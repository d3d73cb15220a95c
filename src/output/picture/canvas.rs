//! The canvas: spheres and lines into pixels, each of which keeps what is nearest to the viewer.
//! The order of spheres does not matter, except among those at the very same depth.

use super::camera::Point;
use crate::output::svg::Color;

/// Where light comes from: the left, above, and mostly the viewer.
const LIGHT: [f32; 3] = [-0.36, -0.48, 0.8];
/// The brightness where light does not reach.
const SHADOW: f32 = 0.45;
/// Steps of brightness for each pixel of the radius, at least 3 and at most 12. More would be lost
/// on small spheres, and make files larger.
const STEPS: f32 = 0.5;
/// Spheres are drawn at least this large \[pixels\], so that none gets lost.
const SMALLEST: f64 = 0.75;
const INK: [f32; 3] = [60.0; 3];
const LINE: f64 = 1.5;

/// What is nearest in a pixel.
#[derive(Clone, Copy, Debug)]
struct Dot {
    depth: f32,
    rgb: [u8; 3],
    opacity: f32,
}

const NOTHING: Dot = Dot {
    depth: f32::NEG_INFINITY,
    rgb: [255; 3],
    opacity: 0.0,
};

#[derive(Debug)]
pub(super) struct Canvas {
    width: usize,
    height: usize,
    opaque: Vec<Dot>,
    /// What can be seen through; empty until there is any.
    clear: Vec<Dot>,
    /// How much of a pixel lines cover.
    lines: Vec<f32>,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            opaque: vec![NOTHING; width * height],
            clear: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// Draws a sphere around a place, both in pixels.
    pub(super) fn sphere(&mut self, [x, y, z]: Point, radius: f64, color: Color, opacity: f64) {
        let radius = radius.max(SMALLEST);
        // Pixels whose middle is inside. The cast makes what is left of the picture 0.
        let range = |at: f64, size: usize| {
            let from = (at - radius - 0.5).ceil() as usize;
            from..((at + radius + 0.5).ceil() as usize).min(size)
        };
        let layer = if opacity < 1.0 {
            self.clear.resize(self.opaque.len(), NOTHING);
            &mut self.clear
        } else {
            &mut self.opaque
        };
        let inverse = 1.0 / radius as f32;
        let (depth, radius) = (z as f32, radius as f32);
        let steps = (STEPS * radius).clamp(3.0, 12.0).round();
        let offset = |pixel: usize, at: f64| (pixel as f64 + 0.5 - at) as f32 * inverse;
        for row in range(y, self.height) {
            let ny = offset(row, y);
            for column in range(x, self.width) {
                let nx = offset(column, x);
                let rest = 1.0 - nx * nx - ny * ny;
                if rest < 0.0 {
                    continue;
                }
                let nz = rest.sqrt();
                let dot = &mut layer[row * self.width + column];
                let depth = depth + radius * nz;
                if depth <= dot.depth {
                    continue;
                }
                let light = (nx * LIGHT[0] + ny * LIGHT[1] + nz * LIGHT[2]).max(0.0);
                let light = (steps * light).round() / steps;
                let bright = SHADOW + (1.0 - SHADOW) * light;
                *dot = Dot {
                    depth,
                    rgb: [color.0, color.1, color.2].map(|c| (f32::from(c) * bright) as u8),
                    opacity: opacity as f32,
                };
            }
        }
    }

    /// Draws a line between places in pixels, where nothing opaque drawn so far is before it.
    pub(super) fn line(&mut self, from: Point, to: Point) {
        self.lines.resize(self.opaque.len(), 0.0);
        let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
        let (along, across) = if steep { (1, 0) } else { (0, 1) };
        let (from, to) = if from[along] <= to[along] {
            (from, to)
        } else {
            (to, from)
        };
        let size = [self.width, self.height];
        let span = to[along] - from[along];
        if span < 1e-9 {
            return;
        }
        let slope = (to[across] - from[across]) / span;
        // The line is as wide at any slope.
        let half = 0.5 * LINE * slope.hypot(1.0);
        let first = from[along].floor() as usize;
        let last = (to[along].ceil() as usize).min(size[along]);
        for major in first..last {
            let part = ((major as f64 + 0.5 - from[along]) / span).clamp(0.0, 1.0);
            let at = from[across] + part * (to[across] - from[across]);
            let depth = (from[2] + part * (to[2] - from[2])) as f32;
            let reach = (at - half).floor() as usize..((at + half).ceil() as usize);
            for minor in reach.start..reach.end.min(size[across]) {
                let middle = minor as f64 + 0.5;
                let cover = (half + 0.5 - (middle - at).abs()).clamp(0.0, 1.0) as f32;
                let (column, row) = if steep {
                    (minor, major)
                } else {
                    (major, minor)
                };
                let index = row * self.width + column;
                if depth > self.opaque[index].depth {
                    self.lines[index] = self.lines[index].max(cover);
                }
            }
        }
    }

    /// Red, green and blue of all pixels: what is clear over what is opaque, and lines over both.
    pub(super) fn blended(self) -> Vec<u8> {
        let mut rgb = Vec::with_capacity(3 * self.opaque.len());
        for (index, dot) in self.opaque.iter().enumerate() {
            let mut color = dot.rgb.map(f32::from);
            let mut over = |above: [f32; 3], part: f32| {
                color = core::array::from_fn(|c| color[c] + part * (above[c] - color[c]));
            };
            if let Some(clear) = self.clear.get(index).filter(|c| c.depth > dot.depth) {
                over(clear.rgb.map(f32::from), clear.opacity);
            }
            if let Some(&cover) = self.lines.get(index) {
                over(INK, cover);
            }
            rgb.extend(color.map(|c| c.round() as u8));
        }
        rgb
    }
}
