//! Pictures of particles in space: shaded spheres, coloured by a value, with the bar of colours.
//! The camera looks along parallel rays, so that lengths do not shrink with distance.
//!
//! A frame of a dam break: water coloured by pressure, its tank as edges, the wall seen through.
//!
//! ```
//! use meshfree::output::picture::Picture;
//! use meshfree::output::svg::{Axis, Color};
//!
//! let (spacing, surface) = (0.02, 0.2);
//! let lattice = |nx: i32, ny: i32, nz: i32| {
//!     let places = (0..nx * ny * nz).map(move |i| [i % nx, i / nx % ny, i / nx / ny]);
//!     places.map(move |place| place.map(|k| spacing * (f64::from(k) + 0.5)))
//! };
//! let water = lattice(20, 10, 10).map(|at| (at, 9.81 * (surface - at[2])));
//! let wall = lattice(1, 10, 25).map(|[x, y, z]| [x + 1.0, y, z]);
//!
//! let picture = Picture::new(1200, 700)
//!     .title("t = 0.00 s")
//!     .particles(Axis::linear("pressure", "kPa").range(0.0, 2.0), spacing, water)
//!     .plain(Color(130, 130, 130), 0.3, spacing, wall)
//!     .edges([0.0, 0.0, 0.0], [1.02, 0.2, 0.5]);
//! # #[cfg(feature = "pictures")]
//! # let _ = || -> meshfree::error::Result<()> {
//! picture.save("out/frame_00000.svg")?;
//! picture.save_png("out/frame_00000.png")?;
//! # Ok(())
//! # };
//! # assert!(picture.pixels()?.len() == 3 * 1200 * 700);
//! # Ok::<(), meshfree::error::Error>(())
//! ```
//!
//! [`Picture::save`] writes title and bar as text around the picture, in one SVG file that browsers
//! show; [`Picture::save_png`] writes the picture alone, as programs that make films need it. Both
//! are the same to the bit for the same particles, and need the feature `pictures`; [`Picture::pixels`] does not. For the frames of a film fix what they have in
//! common: [`Picture::bounds`] and the range of the axis.
//!
//! Particles in a plane may be drawn here too. As a panel among others, with axes, they are a
//! [`Cloud`](super::svg::Cloud).

mod camera;
mod canvas;
mod font;
mod page;

use super::svg::{Axis, Bar, Color, level_color};
#[cfg(feature = "pictures")]
use super::svg::{page, px};
#[cfg(feature = "pictures")]
use super::{file_error, png, write_whole};
use crate::error::{Problem, Result};
use camera::{Camera, Point};
use canvas::Canvas;
#[cfg(feature = "pictures")]
use std::path::Path;

/// The most pixels along a side, which keeps a typing error from filling the memory.
pub const LARGEST: usize = 16_384;

/// The width at which a picture stands on its page, unless it has fewer pixels.
#[cfg(feature = "pictures")]
const SHOWN: f64 = 720.0;
#[cfg(feature = "pictures")]
const MARGIN: f64 = 10.0;

/// Spheres of one size.
#[derive(Clone, Debug, PartialEq)]
struct Group {
    diameter: f64,
    /// Colour and opacity, of particles that are not coloured by a value.
    plain: Option<(Color, f64)>,
    /// Place and value of each.
    particles: Vec<(Point, f64)>,
}

/// A picture of particles: see the [module](self) for an example.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: usize,
    height: usize,
    title: String,
    view: Option<(f64, f64)>,
    bounds: Option<[Point; 2]>,
    edges: Vec<[Point; 2]>,
    value: Option<Axis>,
    groups: Vec<Group>,
    /// Whether anything has three dimensions.
    solid: bool,
}

/// A point in fewer dimensions is one of the plane z = 0.
fn padded<const D: usize>(point: [f64; D]) -> Point {
    core::array::from_fn(|d| point.get(d).copied().unwrap_or_default())
}

impl Picture {
    /// An empty picture of so many pixels, without the room that title and bar take beside it.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// let picture = Picture::new(1200, 700);
    /// # let _ = picture;
    /// ```
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            title: String::new(),
            view: None,
            bounds: None,
            edges: Vec::new(),
            value: None,
            groups: Vec::new(),
            solid: false,
        }
    }

    /// The line above the picture, such as the time.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// let picture = Picture::new(1200, 700).title(&format!("t = {:.2} s", 0.25));
    /// # let _ = picture;
    /// ```
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.to_string();
        self
    }

    /// Where the camera stands, seen from the middle of the picture, in degrees: azimuth from the x
    /// axis towards the y axis, elevation from there towards the z axis, which points up.
    ///
    /// By default it is (−60, 20), from the front, the right and above, and (−90, 90), with x to the
    /// right and y up, where all is in the plane.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// let from_the_front = Picture::new(1200, 700).view(-90.0, 0.0);
    /// # let _ = from_the_front;
    /// ```
    #[must_use]
    pub fn view(mut self, azimuth: f64, elevation: f64) -> Self {
        self.view = Some((azimuth, elevation));
        self
    }

    /// The box \[m\] that fills the picture, which is otherwise the one of all particles and edges.
    /// What lies outside shows where there is room.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// let picture = Picture::new(1200, 700).bounds([0.0, 0.0, 0.0], [1.0, 0.2, 0.5]);
    /// # let _ = picture;
    /// ```
    #[must_use]
    pub fn bounds<const D: usize>(mut self, low: [f64; D], high: [f64; D]) -> Self {
        const { assert!(D == 2 || D == 3, "a picture shows a plane or space") };
        self.bounds = Some([padded(low), padded(high)]);
        self
    }

    /// Draws the edges of a box \[m\], such as a tank. Opaque particles before them hide them.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// let picture = Picture::new(1200, 700).edges([0.0, 0.0, 0.0], [1.0, 0.2, 0.5]);
    /// # let _ = picture;
    /// ```
    #[must_use]
    pub fn edges<const D: usize>(mut self, low: [f64; D], high: [f64; D]) -> Self {
        const { assert!(D == 2 || D == 3, "a picture shows a plane or space") };
        self.solid |= D == 3;
        self.edges.push([padded(low), padded(high)]);
        self
    }

    /// Adds particles of a diameter \[m\], usually the spacing, as positions \[m\] and values.
    ///
    /// The axis is that of the colour bar: its range, if it has one, is where the colours end. A
    /// value without a place on it is grey; a particle without a finite position is left out. There
    /// is one bar, so the axis of the last call holds for all.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// # use meshfree::output::svg::Axis;
    /// let drop = [([0.0, 0.0, 0.1], 0.5), ([0.0, 0.0, 0.2], 0.7)];
    /// let picture = Picture::new(600, 600).particles(Axis::linear("speed", "m/s"), 0.1, drop);
    /// # let _ = picture;
    /// ```
    #[must_use]
    pub fn particles<const D: usize>(
        mut self,
        value: Axis,
        diameter: f64,
        particles: impl IntoIterator<Item = ([f64; D], f64)>,
    ) -> Self {
        self.value = Some(value);
        self.group(diameter, None, particles)
    }

    /// Adds particles \[m\] of one colour, such as walls. With an opacity below 1 they are drawn
    /// over the others, which show through; among each other only the foremost are seen.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// # use meshfree::output::svg::Color;
    /// let wall = (0..100).map(|i| [0.0, 0.1 * f64::from(i % 10), 0.1 * f64::from(i / 10)]);
    /// let picture = Picture::new(600, 600).plain(Color(120, 120, 120), 0.3, 0.1, wall);
    /// # let _ = picture;
    /// ```
    #[must_use]
    pub fn plain<const D: usize>(
        self,
        color: Color,
        opacity: f64,
        diameter: f64,
        positions: impl IntoIterator<Item = [f64; D]>,
    ) -> Self {
        let particles = positions.into_iter().map(|at| (at, f64::NAN));
        self.group(diameter, Some((color, opacity)), particles)
    }

    fn group<const D: usize>(
        mut self,
        diameter: f64,
        plain: Option<(Color, f64)>,
        particles: impl IntoIterator<Item = ([f64; D], f64)>,
    ) -> Self {
        const { assert!(D == 2 || D == 3, "a picture shows a plane or space") };
        self.solid |= D == 3;
        let finite = |point: &Point| point.iter().all(|x| x.is_finite());
        let particles = particles.into_iter().map(|(at, v)| (padded(at), v));
        self.groups.push(Group {
            diameter,
            plain,
            particles: particles.filter(|(at, _)| finite(at)).collect(),
        });
        self
    }

    /// Writes picture, title and bar as one SVG file, with its folder. A file of that name is
    /// replaced in one stroke.
    ///
    /// ```no_run
    /// # use meshfree::output::picture::Picture;
    /// Picture::new(600, 600).edges([0.0; 3], [1.0; 3]).save("out/cube.svg")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Picture::pixels`], and when the file cannot be written.
    #[cfg(feature = "pictures")]
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let pixels = self.pixels()?;
        let file = png::encode(self.width, self.height, &pixels).map_err(std::io::Error::from);
        let file = file.map_err(file_error("write", path))?;
        write_whole(path, self.svg(&file).as_bytes())
    }

    /// Writes the picture alone, without title and bar, as a PNG file, with its folder. A file of
    /// that name is replaced in one stroke.
    ///
    /// ```no_run
    /// # use meshfree::output::picture::Picture;
    /// Picture::new(600, 600).edges([0.0; 3], [1.0; 3]).save_png("out/cube.png")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Picture::pixels`], and when the file cannot be written.
    #[cfg(feature = "pictures")]
    pub fn save_png(&self, path: impl AsRef<Path>) -> Result<()> {
        png::write(path, self.width, self.height, &self.pixels()?)
    }

    /// The picture alone, row by row from the upper left pixel, as red, green and blue.
    ///
    /// ```
    /// # use meshfree::output::picture::Picture;
    /// # use meshfree::output::svg::Color;
    /// let ball = Picture::new(9, 9).plain(Color(200, 0, 0), 1.0, 0.1, [[0.0, 0.0, 0.0]]);
    /// let pixels = ball.pixels()?;
    /// assert_eq!(pixels[..3], [255, 255, 255]);
    /// assert!(pixels[3 * 40] > 100 && pixels[3 * 40 + 1] == 0);
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When a side is not between 1 and [`LARGEST`] pixels; a diameter or opacity is
    /// not positive, or an opacity above 1; view, bounds or edges are not finite; or there is nothing
    /// to fit the picture to.
    pub fn pixels(&self) -> Result<Vec<u8>> {
        check_size(self.width, self.height)?;
        self.check()?;
        let bar = self.bar(1.0);
        let camera = self.camera()?;
        let mut canvas = Canvas::new(self.width, self.height);
        for group in &self.groups {
            let radius = 0.5 * group.diameter * camera.scale;
            let (plain, opacity) = match group.plain {
                Some((color, opacity)) => (Some(color), opacity),
                None => (None, 1.0),
            };
            for &(at, value) in &group.particles {
                let color = plain.or_else(|| Some(level_color(bar.as_ref()?.level(value))));
                if let Some(color) = color {
                    canvas.sphere(camera.place(at), radius, color, opacity);
                }
            }
        }
        for &ends in &self.edges {
            for [a, b] in camera::edges(ends) {
                canvas.line(camera.place(a), camera.place(b));
            }
        }
        Ok(canvas.blended())
    }

    /// Names the first argument that makes no sense.
    fn check(&self) -> Result<()> {
        let refuse = |what: &str, value: f64, must_be: &'static str| Problem::Parameter {
            what: format!("{what} of the picture"),
            value,
            must_be,
        };
        for group in &self.groups {
            if !(group.diameter.is_finite() && group.diameter > 0.0) {
                let must_be = "it must be positive and finite, in metres; take the spacing";
                return Err(refuse("a diameter of particles", group.diameter, must_be).into());
            }
            if let Some((_, opacity)) = group.plain
                && !(opacity > 0.0 && opacity <= 1.0)
            {
                let must_be = "it must be above 0, for glass, and at most 1, for what hides all";
                return Err(refuse("an opacity of particles", opacity, must_be).into());
            }
        }
        let (azimuth, elevation) = self.view.unwrap_or_default();
        for (what, angle) in [("the azimuth", azimuth), ("the elevation", elevation)] {
            if !angle.is_finite() {
                return Err(refuse(what, angle, "it must be finite, in degrees").into());
            }
        }
        for (what, boxes) in [
            ("a corner of the bounds", self.bounds.as_slice()),
            ("a corner of the edges", self.edges.as_slice()),
        ] {
            if let Some(&x) = boxes.iter().flatten().flatten().find(|x| !x.is_finite()) {
                return Err(refuse(what, x, "it must be finite, in metres").into());
            }
        }
        Ok(())
    }

    fn camera(&self) -> Result<Camera> {
        let usual = if self.solid {
            (-60.0, 20.0)
        } else {
            (-90.0, 90.0)
        };
        let mut camera = Camera::new(self.view.unwrap_or(usual));
        if let Some(bounds) = self.bounds {
            camera::corners(bounds).for_each(|corner| camera.include(corner, 0.0));
        } else {
            for group in &self.groups {
                for &(at, _) in &group.particles {
                    camera.include(at, 0.5 * group.diameter);
                }
            }
            let corners = self.edges.iter().flat_map(|&ends| camera::corners(ends));
            corners.for_each(|corner| camera.include(corner, 0.0));
        }
        if camera.fit(self.width as f64, self.height as f64) {
            Ok(camera)
        } else {
            let problem = Problem::Incompatible {
                what: "the picture has nothing with an extent to be fitted to".into(),
                remedy: "give it particles, or bounds of which high is above low",
            };
            Err(problem.into())
        }
    }

    /// With this title, unless it has one.
    #[cfg(feature = "pictures")]
    pub(super) fn or_title(self, title: &str) -> Self {
        if self.title.is_empty() {
            self.title(title)
        } else {
            self
        }
    }

    fn bar(&self, height: f64) -> Option<Bar> {
        let valued = self.groups.iter().filter(|group| group.plain.is_none());
        let values = valued.flat_map(|group| group.particles.iter().map(|p| p.1));
        Some(Bar::new(self.value.as_ref()?, values, height))
    }

    /// The page: the picture as a PNG inside, text and bar around it.
    #[cfg(feature = "pictures")]
    fn svg(&self, file: &[u8]) -> String {
        let width = SHOWN.min(self.width as f64);
        let height = px(width * self.height as f64 / self.width as f64);
        let top = if self.title.is_empty() { MARGIN } else { 34.0 };
        let mut body = format!(
            "<image x=\"{MARGIN}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" \
             href=\"data:image/png;base64,{}\"/>\n",
            base64(file)
        );
        let tall = (0.8 * height).max(20.0);
        let mut room = 2.0 * MARGIN;
        if let Some(bar) = self.bar(tall) {
            let above = px(top + 0.5 * (height - tall));
            body += &format!("<g transform=\"translate({MARGIN} {above})\">\n");
            bar.draw(&mut body, width, tall);
            body += "</g>\n";
            room += bar.room();
        }
        let bottom = top + height + MARGIN;
        page((width + room).ceil(), bottom.ceil(), &self.title, &body)
    }
}

/// Refuses a picture without pixels, or with too many.
pub(super) fn check_size(width: usize, height: usize) -> Result<()> {
    for (what, value) in [("width", width), ("height", height)] {
        if !(1..=LARGEST).contains(&value) {
            let problem = Problem::Parameter {
                what: format!("the {what} of the picture"),
                value: value as f64,
                must_be: "it must be from 1 to 16384 pixels",
            };
            return Err(problem.into());
        }
    }
    Ok(())
}

/// Bytes as text (RFC 4648): three bytes are four digits of base 64.
#[cfg(feature = "pictures")]
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or_default());
        let number = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            text.push(if digit <= three.len() {
                char::from(DIGITS[(number >> (18 - 6 * digit) & 63) as usize])
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests;
