//! Panels: a pair of axes and what is drawn between them.
//! Ranges, ticks and the place of the legend follow from the data by default.

use super::axis::Axis;
use super::legend::Legend;
use super::series::{Cloud, Series};

/// One pair of axes and what is drawn in it.
///
/// ```
/// use meshfree::output::svg::{Axis, Panel, Series};
/// let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("density", "kg/m^{3}"))
///     .title("Shock tube")
///     .series(Series::line("SPH", [(0.0, 1.0), (0.5, 0.4), (1.0, 0.125)]))
///     .series(Series::line("exact", [(0.0, 1.0), (0.5, 0.43), (1.0, 0.125)]).reference());
/// # let _ = panel;
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    pub(super) title: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) series: Vec<Series>,
    pub(super) cloud: Option<Cloud>,
    pub(super) legend: Legend,
    pub(super) equal: bool,
    pub(super) slopes: Vec<f64>,
    pub(super) marks_x: Vec<f64>,
    pub(super) marks_y: Vec<f64>,
}

impl Panel {
    /// An empty panel.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel};
    /// let panel = Panel::new(Axis::log("spacing", "mm"), Axis::log("error", ""));
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: String::new(),
            x,
            y,
            series: Vec::new(),
            cloud: None,
            legend: Legend::Auto,
            equal: false,
            slopes: Vec::new(),
            marks_x: Vec::new(),
            marks_y: Vec::new(),
        }
    }

    /// The title above the panel.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel};
    /// let panel = Panel::new(Axis::linear("t", "s"), Axis::linear("E", "J")).title("Energy");
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.to_string();
        self
    }

    /// Adds a series.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel, Series};
    /// let panel = Panel::new(Axis::linear("t", "s"), Axis::linear("E", "J"))
    ///     .series(Series::line("kinetic", [(0.0, 1.0), (1.0, 0.5)]));
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Shows particles, beneath the series, with a colour bar beside the panel.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Cloud, Panel};
    /// let cloud = Cloud::new(Axis::linear("speed", "m/s"), [(0.0, 0.0, 1.0)]);
    /// let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m")).cloud(cloud);
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn cloud(mut self, cloud: Cloud) -> Self {
        self.cloud = Some(cloud);
        self
    }

    /// Places the legend.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Legend, Panel};
    /// let panel = Panel::new(Axis::linear("t", ""), Axis::linear("E", "")).legend(Legend::Hidden);
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// Gives both axes the same length per unit, for maps. Both axes must be linear.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel};
    /// let map = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m")).equal_aspect();
    /// # let _ = map;
    /// ```
    #[must_use]
    pub fn equal_aspect(mut self) -> Self {
        self.equal = true;
        self
    }

    /// Draws a triangle of this slope near the data. Both axes must be logarithmic.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel, Series};
    /// let panel = Panel::new(Axis::log("spacing", "mm"), Axis::log("error", ""))
    ///     .series(Series::markers("density", [(0.1, 1e-2), (0.2, 4e-2)]).fitted())
    ///     .slope(2.0);
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn slope(mut self, exponent: f64) -> Self {
        self.slopes.push(exponent);
        self
    }

    /// Marks a place on the x axis with a thin line.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel};
    /// let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("p", "Pa")).mark_x(0.5);
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn mark_x(mut self, x: f64) -> Self {
        self.marks_x.push(x);
        self
    }

    /// Marks a place on the y axis with a thin line.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Panel};
    /// let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("p", "Pa")).mark_y(0.0);
    /// # let _ = panel;
    /// ```
    #[must_use]
    pub fn mark_y(mut self, y: f64) -> Self {
        self.marks_y.push(y);
        self
    }
}
