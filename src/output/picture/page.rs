//! A picture as one page of pixels: title above, axes or the directions of them, the bar of colours to the right.
//! All frames of a film have the same size and the picture at the same place in it, whatever is in them.

use super::camera::Camera;
use super::font::{ADVANCE, HEIGHT, pixels};
use super::{Picture, check_size};
use crate::error::Result;
use crate::output::svg::{Axis, Color, LEVELS, level_color, parts, power_label};

const INK: Color = Color(40, 40, 40);
const NAMES: [&str; 3] = ["x", "y", "z"];
/// Letters that ticks of the bar and of the upright axis have room for.
const WIDE: usize = 9;

/// Pixels, and the size of a letter's.
struct Page {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
    size: usize,
}

/// What of a text stands at a place.
#[derive(Clone, Copy, PartialEq)]
enum Anchor {
    Begin,
    Middle,
    End,
}

impl Page {
    fn dot(&mut self, x: usize, y: usize, color: Color) {
        if x < self.width && y < self.height {
            let at = 3 * (y * self.width + x);
            self.rgb[at..at + 3].copy_from_slice(&[color.0, color.1, color.2]);
        }
    }

    fn fill(&mut self, [x, y]: [usize; 2], [w, h]: [usize; 2], color: Color) {
        for row in y..y + h {
            (x..x + w).for_each(|column| self.dot(column, row, color));
        }
    }

    /// The width of a text in pixels.
    fn wide(&self, text: &str) -> usize {
        let letters: usize = parts(text)
            .iter()
            .map(|(_, part)| part.chars().count())
            .sum();
        letters * ADVANCE * self.size
    }

    /// Writes a text whose line is at `y`.
    fn text(&mut self, [x, y]: [usize; 2], anchor: Anchor, text: &str) {
        let back = match anchor {
            Anchor::Begin => 0,
            Anchor::Middle => self.wide(text) / 2,
            Anchor::End => self.wide(text),
        };
        let mut x = x.saturating_sub(back);
        let size = self.size;
        for (shift, part) in parts(text) {
            // Raised and lowered parts by half a letter.
            let top = (y + 3 * size * usize::from(shift < 0))
                .saturating_sub(HEIGHT * size + 3 * size * usize::from(shift > 0));
            for letter in part.chars() {
                for (column, row) in pixels(letter) {
                    let at = [x + column * size, top + row * size];
                    self.fill(at, [size, size], INK);
                }
                x += ADVANCE * size;
            }
        }
    }
}

impl Picture {
    /// Picture, title, axes and bar as one page of pixels, row by row from the upper left one, as red, green and blue; with its
    /// width and height. Its size follows from that of the picture alone.
    ///
    /// Axes with ticks stand where the view is along one of x, y and z; elsewhere the directions of the three are drawn in the
    /// lower left corner.
    ///
    /// ```
    /// use meshfree::output::picture::Picture;
    /// use meshfree::output::svg::Axis;
    /// let drop = [([0.0, 0.1], 0.5), ([0.1, 0.2], 0.7)];
    /// let speed = Axis::linear("speed", "m/s").range(0.0, 1.0);
    /// let picture = Picture::new(400, 300).title("t = 0.1 s").particles(speed, 0.1, drop);
    /// let (width, height, rgb) = picture.page()?;
    /// assert!(width > 400 && height > 300 && rgb.len() == 3 * width * height);
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Picture::pixels`].
    pub fn page(&self) -> Result<(usize, usize, Vec<u8>)> {
        let picture = self.pixels()?;
        let camera = self.camera()?;
        let size = (self.width.max(self.height) / 400).max(1);
        let line = (HEIGHT + 4) * size;
        let ticks = WIDE * ADVANCE * size;
        let (left, top) = (ticks + 2 * line / 3, 3 * line);
        let (width, height) = (
            left + self.width + 3 * line + ticks,
            top + self.height + 3 * line,
        );
        check_size(width, height)?;
        let rgb = vec![255; 3 * width * height];
        let mut page = Page {
            width,
            height,
            rgb,
            size,
        };
        for (row, pixels) in picture.chunks_exact(3 * self.width).enumerate() {
            let at = 3 * ((top + row) * width + left);
            page.rgb[at..at + pixels.len()].copy_from_slice(pixels);
        }
        let middle = left + self.width / 2;
        page.text([middle, top - 3 * line / 2], Anchor::Middle, &self.title);
        self.axes(&mut page, &camera, [left, top]);
        self.colors(&mut page, [left + self.width + line, top]);
        Ok((width, height, page.rgb))
    }

    fn axes(&self, page: &mut Page, camera: &Camera, [left, top]: [usize; 2]) {
        let (size, [w, h]) = (page.size, [self.width, self.height]);
        let line = (HEIGHT + 4) * size;
        let along = [0, 1].map(|side| camera.along(side));
        let [Some(across), Some(up)] = along else {
            self.directions(page, camera, [left, top + h]);
            return;
        };
        let frame = size.max(1);
        page.fill([left, top + h], [w, frame], INK);
        page.fill([left - frame, top], [frame, h + frame], INK);
        let ends = |side: usize, length: usize| {
            let [from, to] = [0.0, length as f64].map(|pixel| camera.coordinate(side, pixel));
            [from.min(to), from.max(to)]
        };
        let [low, high] = ends(0, w);
        let scale = Axis::linear("", "")
            .range(low, high)
            .scale([].into_iter(), 0.0);
        let ticks = scale.ticks(w as f64 / (WIDE * ADVANCE * size) as f64);
        let under = top + h + line / 2;
        for (value, label) in &ticks.major {
            let at = left + camera.pixel(0, *value).round().max(0.0) as usize;
            page.fill([at, top + h], [frame, line / 3], INK);
            page.text([at, under + HEIGHT * size], Anchor::Middle, label);
        }
        let name = |axis: usize, power: &str| format!("{} [m] {power}", NAMES[axis]);
        let below = top + h + line / 2 + 2 * line;
        page.text(
            [left + w / 2, below],
            Anchor::Middle,
            &name(across, &power_label(&ticks)),
        );
        let [low, high] = ends(1, h);
        let scale = Axis::linear("", "")
            .range(low, high)
            .scale([].into_iter(), 0.0);
        let ticks = scale.ticks(h as f64 / (3 * line) as f64);
        for (value, label) in &ticks.major {
            let at = top + camera.pixel(1, *value).round().max(0.0) as usize;
            page.fill([left - line / 3, at], [line / 3, frame], INK);
            let beside = [left - line / 2, at + HEIGHT * size / 2];
            page.text(beside, Anchor::End, label);
        }
        page.text(
            [left, top - line / 2],
            Anchor::Middle,
            &name(up, &power_label(&ticks)),
        );
    }

    /// Where x, y and z are, from a point to the left of the picture.
    fn directions(&self, page: &mut Page, camera: &Camera, [left, bottom]: [usize; 2]) {
        let long = 3.0 * ((HEIGHT + 4) * page.size) as f64;
        let from = [0.5 * left as f64, bottom as f64 - 0.5 * long];
        for (axis, name) in NAMES.iter().enumerate() {
            let [right, down] = camera.direction(axis);
            let steps = long as usize;
            for k in 0..steps {
                let part = 0.7 * long * k as f64 / steps as f64;
                let at = [from[0] + part * right, from[1] + part * down];
                page.fill(at.map(|at| at.max(0.0) as usize), [page.size; 2], INK);
            }
            let at = [from[0] + 0.95 * long * right, from[1] + 0.95 * long * down];
            let half = (HEIGHT * page.size) as f64 / 2.0;
            let at = [at[0], at[1] + half].map(|at| at.max(0.0) as usize);
            page.text(at, Anchor::Middle, name);
        }
    }

    fn colors(&self, page: &mut Page, [x, y]: [usize; 2]) {
        let (size, h) = (page.size, self.height);
        let line = (HEIGHT + 4) * size;
        let Some(bar) = self.bar(h as f64 / size as f64) else {
            return;
        };
        for row in 0..h {
            let level = ((h - 1 - row) * LEVELS / h).min(LEVELS - 1);
            page.fill([x, y + row], [line, 1], level_color(level));
        }
        for (value, label) in &bar.ticks.major {
            let place = bar.scale.place(*value);
            if (0.0..=1.0).contains(&place) {
                let at = y + ((1.0 - place) * (h - 1) as f64).round() as usize;
                page.fill([x + line, at], [line / 3, size], INK);
                let beside = [x + line + line / 2, at + HEIGHT * size / 2];
                page.text(beside, Anchor::Begin, label);
            }
        }
        let name = format!("{} {}", bar.label, power_label(&bar.ticks));
        let end = page.width - size;
        page.text([end, y - line / 2], Anchor::End, &name);
    }
}
