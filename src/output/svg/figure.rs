//! Figures: panels in a grid on a page, with a title and perhaps one legend for all.
//! Panels in one column or row share their margins, so that their frames line up.

use super::super::{write_whole, xml_escape};
use super::draw::{Frame, Margins, Prepared};
use super::legend::{Entry, shared_legend};
use super::panel::Panel;
use super::path::px;
use super::text;
use crate::error::Result;
use core::fmt;
use std::path::Path;

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

    /// Width and height of a panel with its labels, in pixels; 400 by 290 by default.
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
            let mut margins = prepared[index].margins;
            for (other, panel) in prepared.iter().enumerate() {
                let same_column = other % columns == index % columns;
                let same_row = other / columns == index / columns;
                margins.grow(&panel.margins, same_column, same_row);
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
        f.write_str(&page(width, height, &self.title, &body))
    }
}

/// A page of this size in pixels, with a title in its uppermost 34, around what is drawn.
pub(in crate::output) fn page(width: f64, height: f64, title: &str, body: &str) -> String {
    let mut page = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"Helvetica, Arial, sans-serif\" \
         font-size=\"11\" fill=\"#222222\" xml:space=\"preserve\">\n"
    );
    if !title.is_empty() {
        page += &format!("<title>{}</title>\n", xml_escape(title));
    }
    page += &format!("<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n");
    if !title.is_empty() {
        page += &format!(
            "<text x=\"{}\" y=\"24\" text-anchor=\"middle\" font-size=\"15\" \
             font-weight=\"bold\">{}</text>\n",
            px(0.5 * width),
            text::markup(title, 15.0)
        );
    }
    page + body + "</svg>\n"
}
