//! Figures: panels in a grid, each with its axes, series and legend.
//! Panels in one column or row share their margins, so that their frames line up.

use super::super::{write_whole, xml_escape};
use super::axis::Axis;
use super::draw::{Entry, Frame, Margins, Prepared, entry_width, legend_entry};
use super::path::px;
use super::series::{Cloud, Series};
use super::text;
use crate::error::Result;
use core::fmt;
use std::fmt::Write as _;
use std::path::Path;

/// Where the legend of a panel stands.
///
/// ```
/// use meshfree::output::svg::{Axis, Legend, Panel};
/// let panel = Panel::new(Axis::linear("x", "m"), Axis::linear("y", "m")).legend(Legend::TopLeft);
/// # let _ = panel;
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// Where it hides least of the data.
    #[default]
    Auto,
    /// In the upper left corner.
    TopLeft,
    /// In the upper right corner.
    TopRight,
    /// In the lower left corner.
    BottomLeft,
    /// In the lower right corner.
    BottomRight,
    /// Nowhere.
    Hidden,
}

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

/// One or several panels on a page.
///
/// ```
/// use meshfree::output::svg::{Axis, Figure, Panel, Series};
/// let panel = Panel::new(Axis::linear("t", "s"), Axis::linear("x", "m"))
///     .series(Series::line("fall", (0..50).map(|i| 0.1 * f64::from(i)).map(|t| (t, -4.9 * t * t))));
/// let svg = Figure::new().panel(panel).to_string();
/// assert!(svg.starts_with("<svg "));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    title: String,
    panels: Vec<Panel>,
    columns: Option<usize>,
    size: (f64, f64),
    shared_legend: bool,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            title: String::new(),
            panels: Vec::new(),
            columns: None,
            size: (400.0, 290.0),
            shared_legend: false,
        }
    }
}

impl Figure {
    /// A figure without panels.
    ///
    /// ```
    /// # use meshfree::output::svg::Figure;
    /// let figure = Figure::new();
    /// # let _ = figure;
    /// ```
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The title above all panels.
    ///
    /// ```
    /// # use meshfree::output::svg::Figure;
    /// let figure = Figure::new().title("Sod's shock tube at t = 0.2 s");
    /// # let _ = figure;
    /// ```
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.to_string();
        self
    }

    /// Adds a panel: rows are filled from the left.
    ///
    /// ```
    /// # use meshfree::output::svg::{Axis, Figure, Panel};
    /// let panel = Panel::new(Axis::linear("t", "s"), Axis::linear("x", "m"));
    /// let figure = Figure::new().panel(panel);
    /// # let _ = figure;
    /// ```
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The number of panels in a row, which otherwise follows from the number of panels.
    ///
    /// ```
    /// # use meshfree::output::svg::Figure;
    /// let figure = Figure::new().columns(3);
    /// # let _ = figure;
    /// ```
    #[must_use]
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = Some(columns);
        self
    }

    /// Width and height of a panel with its labels, in pixels; 400 by 290 unless told.
    ///
    /// ```
    /// # use meshfree::output::svg::Figure;
    /// let figure = Figure::new().panel_size(640.0, 420.0);
    /// # let _ = figure;
    /// ```
    #[must_use]
    pub fn panel_size(mut self, width: f64, height: f64) -> Self {
        self.size = (width.clamp(160.0, 1e4), height.clamp(120.0, 1e4));
        self
    }

    /// One legend below all panels instead of one in each.
    ///
    /// ```
    /// # use meshfree::output::svg::Figure;
    /// let figure = Figure::new().shared_legend();
    /// # let _ = figure;
    /// ```
    #[must_use]
    pub fn shared_legend(mut self) -> Self {
        self.shared_legend = true;
        self
    }

    /// Writes the file, with its folder. A file of that name is replaced in one stroke.
    ///
    /// ```no_run
    /// # use meshfree::output::svg::Figure;
    /// Figure::new().save("out/figure.svg")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        write_whole(path.as_ref(), self.to_string().as_bytes())
    }

    /// The number of columns and rows.
    fn grid(&self) -> (usize, usize) {
        let n = self.panels.len().max(1);
        let suitable = match n {
            1 => 1,
            2 | 4 => 2,
            _ => 3,
        };
        let columns = self.columns.unwrap_or(suitable).clamp(1, n);
        (columns, n.div_ceil(columns))
    }

    /// Where each panel's frame stands, when those of a row or column have equal margins.
    fn frames(&self, prepared: &[Prepared<'_>], top: f64) -> Vec<Frame> {
        let (columns, _) = self.grid();
        let (width, height) = self.size;
        let shared = |index: usize| {
            let neighbours = |other: &usize| {
                let same_row = other / columns == index / columns;
                (other % columns == index % columns, same_row)
            };
            let mut margins = prepared[index].margins;
            for other in 0..prepared.len() {
                let (same_column, same_row) = neighbours(&other);
                margins.grow(&prepared[other].margins, same_column, same_row);
            }
            margins
        };
        let frame = |index: usize| {
            let Margins {
                left,
                right,
                top: above,
                bottom,
            } = shared(index);
            Frame {
                x: (index % columns) as f64 * width + left,
                y: top + (index / columns) as f64 * height + above,
                w: (width - left - right).max(20.0),
                h: (height - above - bottom).max(20.0),
            }
        };
        (0..prepared.len()).map(frame).collect()
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let prepared: Vec<Prepared<'_>> = self
            .panels
            .iter()
            .map(|panel| Prepared::new(panel, self.size))
            .collect();
        let (columns, rows) = self.grid();
        let width = columns as f64 * self.size.0;
        let top = if self.title.is_empty() { 4.0 } else { 34.0 };
        let mut body = String::new();
        for (panel, frame) in prepared.iter().zip(self.frames(&prepared, top)) {
            panel.draw(&mut body, frame, !self.shared_legend);
        }
        let mut height = top + rows as f64 * self.size.1 + 4.0;
        if self.shared_legend {
            let mut entries: Vec<Entry> = Vec::new();
            for entry in prepared.iter().flat_map(Prepared::entries) {
                if !entries.contains(&entry) {
                    entries.push(entry);
                }
            }
            height += shared_legend(&mut body, &entries, width, height + 8.0);
        }
        writeln!(
            f,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, sans-serif\" \
             font-size=\"11\" fill=\"#222222\">"
        )?;
        if !self.title.is_empty() {
            writeln!(f, "<title>{}</title>", xml_escape(&self.title))?;
        }
        writeln!(
            f,
            "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>"
        )?;
        if !self.title.is_empty() {
            writeln!(
                f,
                "<text x=\"{}\" y=\"24\" text-anchor=\"middle\" font-size=\"15\" \
                 font-weight=\"bold\">{}</text>",
                px(0.5 * width),
                text::markup(&self.title, 15.0)
            )?;
        }
        write!(f, "{body}</svg>")?;
        f.write_char('\n')
    }
}

/// Draws the entries in centred rows and gives their height.
fn shared_legend(body: &mut String, entries: &[Entry], width: f64, top: f64) -> f64 {
    const GAP: f64 = 18.0;
    const LINE: f64 = 19.0;
    let mut rows: Vec<(f64, Vec<&Entry>)> = Vec::new();
    for entry in entries {
        let needed = entry_width(entry) + GAP;
        match rows.last_mut() {
            Some((used, row)) if *used + needed <= width - 20.0 => {
                *used += needed;
                row.push(entry);
            }
            _ => rows.push((needed, vec![entry])),
        }
    }
    for (index, (used, row)) in rows.iter().enumerate() {
        let mut x = 0.5 * (width - used + GAP);
        for entry in row {
            legend_entry(body, entry, x, top + LINE * index as f64);
            x += entry_width(entry) + GAP;
        }
    }
    rows.len() as f64 * LINE + 8.0
}
