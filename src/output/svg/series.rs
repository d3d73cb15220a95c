//! What is drawn in a panel: lines, steps, markers, and clouds of coloured particles.
//! Places that are not finite leave a gap.

use super::axis::Axis;
use super::color::Color;

/// The shape of a marker.
///
/// ```
/// use meshfree::output::svg::{Marker, Series};
/// let probe = Series::markers("probe", [(0.0, 1.0)]).marker(Marker::Square);
/// # let _ = probe;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A filled circle.
    Circle,
    /// A circle with a white middle.
    Ring,
    /// A filled square.
    Square,
    /// A filled triangle.
    Triangle,
    /// A filled square on its corner.
    Diamond,
    /// A cross.
    Cross,
}

/// Values to draw, and how.
///
/// ```
/// use meshfree::output::svg::Series;
/// let times = [0.0, 0.5, 1.0];
/// let energies = [2.0, 1.5, 1.2];
/// let series = Series::line("energy", times.into_iter().zip(energies));
/// # let _ = series;
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub(super) label: String,
    pub(super) points: Vec<(f64, f64)>,
    pub(super) color: Option<Color>,
    pub(super) line: bool,
    pub(super) dashed: bool,
    pub(super) reference: bool,
    pub(super) width: f64,
    pub(super) marker: Option<Marker>,
    pub(super) fitted: bool,
}

impl Series {
    fn new(label: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            label: label.to_string(),
            points: points.into_iter().collect(),
            color: None,
            line: true,
            dashed: false,
            reference: false,
            width: 1.6,
            marker: None,
            fitted: false,
        }
    }

    /// A line through the points. A series with an empty label is not in the legend.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let square = Series::line("x^{2}", (0..100).map(f64::from).map(|x| (x, x * x)));
    /// # let _ = square;
    /// ```
    #[must_use]
    pub fn line(label: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::new(label, points)
    }

    /// Steps: each value holds until the next point.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let step = Series::steps("time step", [(0.0, 1e-6), (1.0, 5e-7), (2.0, 5e-7)]);
    /// # let _ = step;
    /// ```
    #[must_use]
    pub fn steps(label: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut series = Self::new(label, []);
        for (x, y) in points {
            if let Some(&(_, before)) = series.points.last() {
                series.points.push((x, before));
            }
            series.points.push((x, y));
        }
        series
    }

    /// Markers without a line.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let measured = Series::markers("measured", [(0.1, 2.0), (0.2, 2.1)]);
    /// # let _ = measured;
    /// ```
    #[must_use]
    pub fn markers(label: &str, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut series = Self::new(label, points);
        series.line = false;
        series.marker = Some(Marker::Circle);
        series
    }

    /// Takes this colour instead of the next in the palette.
    ///
    /// ```
    /// # use meshfree::output::svg::{PALETTE, Series};
    /// let series = Series::line("coarse", [(0.0, 1.0)]).color(PALETTE[3]);
    /// # let _ = series;
    /// ```
    #[must_use]
    pub fn color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }

    /// Dashes the line.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let series = Series::line("coarse", [(0.0, 1.0)]).dashed();
    /// # let _ = series;
    /// ```
    #[must_use]
    pub fn dashed(mut self) -> Self {
        self.dashed = true;
        self
    }

    /// Draws it as an exact or reference curve: thin, black, dashed, above the others, and
    /// without taking a colour from the palette.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let exact = Series::line("exact", [(0.0, 1.0), (1.0, 1.0)]).reference();
    /// # let _ = exact;
    /// ```
    #[must_use]
    pub fn reference(mut self) -> Self {
        self.reference = true;
        self.dashed = true;
        self.width = 1.1;
        self.color.get_or_insert(Color(20, 20, 20));
        self
    }

    /// The width of the line in pixels; 1.6 by default.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let series = Series::line("coarse", [(0.0, 1.0)]).width(1.0);
    /// # let _ = series;
    /// ```
    #[must_use]
    pub fn width(mut self, pixels: f64) -> Self {
        self.width = pixels;
        self
    }

    /// Marks the points.
    ///
    /// ```
    /// # use meshfree::output::svg::{Marker, Series};
    /// let series = Series::line("error", [(0.1, 1e-2), (0.2, 4e-2)]).marker(Marker::Circle);
    /// # let _ = series;
    /// ```
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.marker = Some(marker);
        self
    }

    /// Draws a fitted power law through the points, and says its exponent in the legend.
    ///
    /// ```
    /// # use meshfree::output::svg::Series;
    /// let error = Series::markers("density", [(0.1, 1e-2), (0.2, 4e-2)]).fitted();
    /// # let _ = error;
    /// ```
    #[must_use]
    pub fn fitted(mut self) -> Self {
        self.fitted = true;
        self
    }
}

/// Particles in the plane, coloured by a value.
///
/// ```
/// use meshfree::output::svg::{Axis, Cloud};
/// let cloud = Cloud::new(Axis::linear("pressure", "GPa"), [(0.0, 0.0, 1.0), (1.0, 0.0, 2.0)]);
/// # let _ = cloud;
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    pub(super) value: Axis,
    pub(super) points: Vec<(f64, f64, f64)>,
    pub(super) diameter: Option<f64>,
}

impl Cloud {
    /// Particles as x, y and value. The axis is that of the colour bar: its range, if it has
    /// one, is where the colours end.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Cloud};
    /// let axis = Axis::linear("speed", "m/s").range(0.0, 10.0);
    /// let cloud = Cloud::new(axis, (0..100).map(f64::from).map(|i| (i, i * i, 0.1 * i)));
    /// # let _ = cloud;
    /// ```
    #[must_use]
    pub fn new(value: Axis, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        Self {
            value,
            points: points.into_iter().collect(),
            diameter: None,
        }
    }

    /// The diameter of a particle on the x axis, usually the spacing; otherwise 3 pixels.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Cloud};
    /// let cloud = Cloud::new(Axis::linear("speed", "m/s"), [(0.0, 0.0, 1.0)]).diameter(0.01);
    /// # let _ = cloud;
    /// ```
    #[must_use]
    pub fn diameter(mut self, diameter: f64) -> Self {
        self.diameter = Some(diameter);
        self
    }
}
