//! Records of experiments and of other codes, read from files to be laid over a computed curve.
//! A table of numbers with named columns; lines that start with `#` tell of its source.
//!
//! The file is comma-separated, as [`Csv`] reads it: comment lines, one line of column names, then one
//! line of numbers for each sample.
//!
//! ```
//! use meshfree::study::records::Record;
//! let front = Record::parse("# Martin & Moyce 1952, table 2\nT,Z\n1.19,1.44\n1.43,1.67\n1.63,1.89\n")?;
//! assert_eq!(front.column("Z")?, [1.44, 1.67, 1.89]);
//! assert!((front.interpolate("Z", "T", 1.31)? - 1.555).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::error::{Error, Problem, Result};
use crate::output::csv::Csv;
use std::fs;
use std::io;
use std::path::Path;

/// A table of numbers.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Record {
    /// The names of the columns, usually with their units.
    pub columns: Vec<String>,
    /// The rows, each as long as the list of columns.
    pub rows: Vec<Vec<f64>>,
}

impl Record {
    /// Reads a file.
    ///
    /// ```no_run
    /// # use meshfree::study::records::Record;
    /// let pulse = Record::read("acceleration.csv")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be read, is not a table, or holds a cell that is not a number; the error
    /// names the file, and the line and column of the cell.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        fs::read_to_string(path)
            .and_then(|text| Self::parse(&text))
            .map_err(|cause| Error::File {
                action: "read",
                path: path.to_path_buf(),
                cause,
            })
    }

    /// Reads a text.
    ///
    /// # Errors
    /// When it is not a table, or holds a cell that is not a number; the error names line and column.
    pub fn parse(text: &str) -> io::Result<Self> {
        let table = Csv::parse(text)?;
        let number = |row: usize, column: usize, cell: &str| {
            cell.trim().parse().map_err(|_| {
                let what = format!(
                    "line {}, column `{}`: `{cell}` is not a number; correct the cell, or take its row \
                     or column out",
                    line_of_row(text, row),
                    table.header[column],
                );
                io::Error::new(io::ErrorKind::InvalidData, what)
            })
        };
        let mut rows = Vec::with_capacity(table.rows.len());
        for (row, cells) in table.rows.iter().enumerate() {
            let cells = cells.iter().enumerate();
            rows.push(
                cells
                    .map(|(column, cell)| number(row, column, cell))
                    .collect::<io::Result<Vec<f64>>>()?,
            );
        }
        Ok(Self {
            columns: table.header,
            rows,
        })
    }

    /// The numbers of a column.
    ///
    /// # Errors
    /// When there is no such column.
    pub fn column(&self, name: &str) -> Result<Vec<f64>> {
        let index = self.index(name)?;
        Ok(self.rows.iter().map(|row| row[index]).collect())
    }

    /// The value of the column `name` where the column `along` is `at`, by linear interpolation.
    ///
    /// Rows are taken in the order of `along`, whatever their order in the file. So the record must
    /// be a function of `along`: a curve that turns back gives nonsense.
    ///
    /// # Errors
    /// When a column is missing or the record does not cover `at`.
    pub fn interpolate(&self, name: &str, along: &str, at: f64) -> Result<f64> {
        let (value, place) = (self.index(name)?, self.index(along)?);
        let mut points: Vec<(f64, f64)> = self
            .rows
            .iter()
            .map(|row| (row[place], row[value]))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let above = points.partition_point(|point| point.0 < at);
        match (
            above.checked_sub(1).map(|below| points[below]),
            points.get(above),
        ) {
            (_, Some(&(x, y))) if x == at => Ok(y),
            (Some((x0, y0)), Some(&(x1, y1))) => Ok(y0 + (y1 - y0) * (at - x0) / (x1 - x0)),
            _ => Err(Problem::Incompatible {
                what: match (points.first(), points.last()) {
                    (Some((from, _)), Some((to, _))) => {
                        format!("the record covers `{along}` from {from} to {to}, not {at}")
                    }
                    _ => "the record has no rows".into(),
                },
                remedy: "ask within what it covers, or take a longer record",
            }
            .into()),
        }
    }

    fn index(&self, name: &str) -> Result<usize> {
        let found = self.columns.iter().position(|column| column == name);
        found.ok_or_else(|| {
            Problem::Incompatible {
                what: format!(
                    "the record has no column `{name}` but `{}`",
                    self.columns.join("`, `")
                ),
                remedy: "name one of these",
            }
            .into()
        })
    }
}

/// The number of the line that holds a row: comments, empty lines and the names of columns are not
/// rows.
fn line_of_row(text: &str, row: usize) -> usize {
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.starts_with('#') && !line.trim().is_empty());
    lines.nth(row + 1).map_or(0, |(index, _)| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRONT: &str = "# source\n# units\nT,Z\n2,4\n\n0,1\n1, 3\n";

    #[test]
    fn columns_and_values_between_rows() {
        let record = Record::parse(FRONT).unwrap();
        assert_eq!(record.columns, ["T", "Z"]);
        assert_eq!(record.rows, [[2.0, 4.0], [0.0, 1.0], [1.0, 3.0]]);
        assert_eq!(record.column("T").unwrap(), [2.0, 0.0, 1.0]);
        for (at, expected) in [(0.0, 1.0), (0.25, 1.5), (1.0, 3.0), (1.5, 3.5), (2.0, 4.0)] {
            assert_eq!(record.interpolate("Z", "T", at).unwrap(), expected);
        }
        assert_eq!(record.interpolate("T", "Z", 2.0).unwrap(), 0.5);
        // Equal places, as rounded readings have them, are a step.
        let step = Record::parse("t,p\n0,0\n1,2\n1,6\n2,8\n").unwrap();
        assert_eq!(step.interpolate("p", "t", 0.5).unwrap(), 1.0);
        assert_eq!(step.interpolate("p", "t", 1.5).unwrap(), 7.0);
    }

    #[test]
    fn errors_say_where_and_what() {
        let record = Record::parse(FRONT).unwrap();
        let says = |error: &dyn std::fmt::Display, parts: &[&str]| {
            let text = error.to_string();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        };
        says(
            &record.interpolate("Z", "T", 2.5).unwrap_err(),
            &["`T` from 0 to 2", "2.5"],
        );
        says(
            &record.interpolate("Z", "T", f64::NAN).unwrap_err(),
            &["`T`", "NaN"],
        );
        says(&record.column("time").unwrap_err(), &["`time`", "`T`, `Z`"]);
        let empty = Record::parse("a,b\n").unwrap();
        says(&empty.interpolate("a", "b", 1.0).unwrap_err(), &["no rows"]);
        says(
            &Record::parse("# source\n\na,b\n1,2\n# break\n3,dry\n").unwrap_err(),
            &["line 6", "`b`", "`dry` is not a number"],
        );
        says(
            &Record::read("there/is/no.csv").unwrap_err(),
            &["cannot read there/is/no.csv"],
        );
    }
}
