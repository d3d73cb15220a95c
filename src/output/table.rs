//! Tables for people: aligned plain text for terminals and reports, and Markdown.
//! Columns of numbers are set flush right, the others flush left.

use core::fmt;

/// A number with so many significant digits, scientific when it is very large or small.
///
/// ```
/// use meshfree::output::table::significant;
/// assert_eq!(significant(1234.567, 3), "1235");
/// assert_eq!(significant(0.0123456, 3), "0.0123");
/// assert_eq!(significant(1.5e-7, 3), "1.50e-7");
/// ```
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let digits = digits.clamp(1, 17);
    if value == 0.0 {
        return "0".into();
    }
    let scientific = format!("{value:.*e}", digits - 1);
    // Rounding may carry into the next decade, so the exponent is read after it.
    match scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok())
    {
        Some(exponent @ -4..6) => {
            let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

/// How a column is set.
///
/// ```
/// use meshfree::output::table::{Align, Table};
/// let table = Table::new(["run", "cost"]).align(0, Align::Right);
/// # let _ = table;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Flush left.
    Left,
    /// Flush right.
    Right,
}

/// A table of texts under headings.
///
/// ```
/// use meshfree::output::table::Table;
/// let mut table = Table::new(["quantity", "error"]);
/// table.row(["density", "0.012"]);
/// table.row(["velocity", "1.5"]);
/// assert_eq!(
///     table.to_string(),
///     "quantity  error\n--------  -----\ndensity   0.012\nvelocity    1.5\n"
/// );
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    title: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    align: Vec<Option<Align>>,
}

impl Table {
    /// A table with these headings and no rows.
    ///
    /// ```
    /// # use meshfree::output::table::Table;
    /// let table = Table::new(["spacing [mm]", "error"]);
    /// # let _ = table;
    /// ```
    #[must_use]
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        let header: Vec<String> = header.into_iter().map(Into::into).collect();
        Self {
            align: vec![None; header.len()],
            header,
            ..Self::default()
        }
    }

    /// A title above the table.
    ///
    /// ```
    /// # use meshfree::output::table::Table;
    /// let table = Table::new(["a"]).title("Errors");
    /// assert!(table.to_string().starts_with("Errors\n\n"));
    /// ```
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Sets a column, counted from 0, in another way than its content suggests.
    ///
    /// ```
    /// # use meshfree::output::table::{Align, Table};
    /// let mut table = Table::new(["id"]).align(0, Align::Left);
    /// table.row(["7"]).row(["12"]);
    /// assert_eq!(table.to_string(), "id\n--\n7\n12\n");
    /// ```
    #[must_use]
    pub fn align(mut self, column: usize, align: Align) -> Self {
        if let Some(place) = self.align.get_mut(column) {
            *place = Some(align);
        }
        self
    }

    /// Adds a row. Missing cells stay empty; cells beyond the last heading get an empty heading.
    ///
    /// ```
    /// # use meshfree::output::table::{significant, Table};
    /// let mut table = Table::new(["scheme", "order"]);
    /// table.row(["leapfrog".to_string(), significant(1.98, 3)]);
    /// ```
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) -> &mut Self {
        let row: Vec<String> = cells.into_iter().map(Into::into).collect();
        if row.len() > self.header.len() {
            self.header.resize(row.len(), String::new());
            self.align.resize(row.len(), None);
        }
        self.rows.push(row);
        self
    }

    /// The table in Markdown, the title as a bold line above it.
    ///
    /// ```
    /// # use meshfree::output::table::Table;
    /// let mut table = Table::new(["n", "error"]);
    /// table.row(["100", "0.1"]);
    /// assert_eq!(
    ///     table.markdown(),
    ///     "|   n | error |\n| --: | ----: |\n| 100 |   0.1 |\n"
    /// );
    /// ```
    #[must_use]
    pub fn markdown(&self) -> String {
        let escape = |cell: &str| cell.replace('|', "\\|").replace(['\n', '\r'], " ");
        let widths = self.widths(3, escape);
        let line = |cells: &[String]| {
            let cells = self.aligned(cells, &widths, escape);
            format!("| {} |\n", cells.join(" | "))
        };
        let rule = widths.iter().enumerate().map(|(column, &width)| {
            let dashes = "-".repeat(width - 1);
            match self.alignment(column) {
                Align::Left => format!("{dashes}-"),
                Align::Right => format!("{dashes}:"),
            }
        });
        let rule = rule.collect::<Vec<_>>().join(" | ");
        let mut text = String::new();
        if !self.title.is_empty() {
            text = format!("**{}**\n\n", self.title);
        }
        text += &line(&self.header);
        text += &format!("| {rule} |\n");
        text.extend(self.rows.iter().map(|row| line(row)));
        text
    }

    /// The requested alignment, or else the one that suits the column's cells.
    fn alignment(&self, column: usize) -> Align {
        let mut cells = self
            .rows
            .iter()
            .filter_map(|row| row.get(column))
            .filter(|cell| !cell.trim().is_empty())
            .peekable();
        let numbers = cells.peek().is_some() && cells.all(|cell| is_number(cell));
        let suitable = if numbers { Align::Right } else { Align::Left };
        self.align
            .get(column)
            .copied()
            .flatten()
            .unwrap_or(suitable)
    }

    fn widths(&self, least: usize, escape: impl Fn(&str) -> String) -> Vec<usize> {
        let width = |column: usize| {
            core::iter::once(&self.header)
                .chain(&self.rows)
                .filter_map(|row| row.get(column))
                .map(|cell| escape(cell).chars().count())
                .fold(least, usize::max)
        };
        (0..self.header.len()).map(width).collect()
    }

    fn aligned(
        &self,
        cells: &[String],
        widths: &[usize],
        escape: impl Fn(&str) -> String,
    ) -> Vec<String> {
        let set = |(column, &width): (usize, &usize)| {
            let cell = escape(cells.get(column).map_or("", String::as_str));
            match self.alignment(column) {
                Align::Left => format!("{cell:<width$}"),
                Align::Right => format!("{cell:>width$}"),
            }
        };
        widths.iter().enumerate().map(set).collect()
    }
}

/// A number, perhaps followed by a unit or `%`, or a dash for none.
fn is_number(cell: &str) -> bool {
    let word = cell.split_whitespace().next().unwrap_or_default();
    let word = word.trim_start_matches(['<', '>', '~', '±', '≤', '≥']);
    let word = word.trim_end_matches(['%', '×']).replace('−', "-");
    matches!(word.as_str(), "-" | "–" | "—") || word.parse::<f64>().is_ok()
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let escape = |cell: &str| cell.replace(['\n', '\r'], " ");
        let widths = self.widths(1, escape);
        if !self.title.is_empty() {
            writeln!(f, "{}\n", self.title)?;
        }
        let mut line = |cells: &[String]| {
            let line = self.aligned(cells, &widths, escape).join("  ");
            writeln!(f, "{}", line.trim_end())
        };
        line(&self.header)?;
        line(
            &widths
                .iter()
                .map(|&width| "-".repeat(width))
                .collect::<Vec<_>>(),
        )?;
        self.rows.iter().try_for_each(|row| line(row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_survive_a_carry_and_extremes() {
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(999_999.9, 3), "1.00e6");
        assert_eq!(significant(-0.000_999_96, 3), "-0.00100");
        assert_eq!(significant(f64::NAN, 3), "NaN");
        assert_eq!(significant(f64::INFINITY, 3), "inf");
        assert_eq!(significant(0.0, 3), "0");
    }

    #[test]
    fn numbers_stand_right_and_texts_left() {
        let mut table = Table::new(["name", "value", "unit"]).title("All");
        table.row(["density", "1000", "kg/m³"]);
        table.row(["−", "-1.5e-3"]);
        table.row(["speed", "3 %", "m/s"]);
        assert_eq!(
            table.to_string(),
            "All\n\n\
             name       value  unit\n\
             -------  -------  -----\n\
             density     1000  kg/m³\n\
             −        -1.5e-3\n\
             speed        3 %  m/s\n"
        );
    }

    #[test]
    fn markdown_escapes_bars_and_widens_for_longer_rows() {
        let mut table = Table::new(["a"]).title("T");
        table.row(["x|y", "2"]);
        assert_eq!(
            table.markdown(),
            "**T**\n\n| a    |     |\n| ---- | --: |\n| x\\|y |   2 |\n"
        );
    }
}
