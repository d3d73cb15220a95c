//! Rows of tables, from the scene file or from CSV files beside it.
//! A row that has another width than its use is refused by its number.

use super::{Builder, Part};
use crate::fault::Fault;
use crate::format::Table;
use meshfree::output::csv::Csv;
use std::path::Path;

/// Rows of a time and so many values.
pub(crate) type Rows<const W: usize> = Vec<(f64, [f64; W])>;

impl<const D: usize> Builder<'_, D> {
    /// The rows of a table of `W` values.
    pub(crate) fn rows<const W: usize>(&self, table: &Table, field: &str) -> Part<Rows<W>> {
        let scale = table.scale.unwrap_or(1.0);
        if !scale.is_finite() {
            let text = format!("is {scale}: it must be finite");
            return Err(Fault::new(format!("{field}.scale"), text));
        }
        let rows = match (&table.rows, &table.file, &table.columns) {
            (Some(rows), None, None) => rows.clone(),
            (None, Some(file), Some(columns)) => self.columns(file, columns, field)?,
            _ => {
                let text =
                    "must have either `rows`, or both `file` and `columns`: give one of them";
                return Err(Fault::new(field, text));
            }
        };
        let wide = |(k, row): (usize, Vec<f64>)| {
            let [time, values @ ..] = &row[..] else {
                let text = "is empty: it must be a time and its values";
                return Err(Fault::new(format!("{field}.rows[{k}]"), text));
            };
            let values: [f64; W] = values.try_into().map_err(|_| {
                let text = format!(
                    "has {} numbers: it must have {}, a time and {W} behind it",
                    row.len(),
                    W + 1
                );
                Fault::new(format!("{field}.rows[{k}]"), text)
            })?;
            Ok((*time, values.map(|x| scale * x)))
        };
        rows.into_iter().enumerate().map(wide).collect()
    }

    /// Columns of a file, row by row.
    fn columns(&self, file: &Path, columns: &[String], field: &str) -> Part<Vec<Vec<f64>>> {
        let at_file = format!("{field}.file");
        let csv = Csv::read(self.folder.join(file)).map_err(Fault::of(&at_file))?;
        let column = |(k, name): (usize, &String)| {
            csv.column(name).ok_or_else(|| {
                let known = csv.header.join(", ");
                let text = format!(
                    "is `{name}`, which {} does not have as a column of numbers: it has {known}",
                    file.display()
                );
                Fault::new(format!("{field}.columns[{k}]"), text)
            })
        };
        let columns: Vec<_> = columns
            .iter()
            .enumerate()
            .map(column)
            .collect::<Part<_>>()?;
        let count = columns.first().map_or(0, Vec::len);
        let row = |k: usize| columns.iter().map(|own| own[k]).collect();
        Ok((0..count).map(row).collect())
    }

    /// Places by columns x, y and z of a file.
    pub(crate) fn places(&self, file: &Path, field: &str) -> Part<Vec<[f64; D]>> {
        let names: Vec<_> = ["x", "y", "z"][..D]
            .iter()
            .map(ToString::to_string)
            .collect();
        let csv = Csv::read(self.folder.join(file)).map_err(Fault::of(field))?;
        let columns: Vec<Vec<f64>> = names.iter().map_while(|name| csv.column(name)).collect();
        if columns.len() < D {
            let text = format!(
                "{} has no column `{}` of numbers: it must have {}",
                file.display(),
                names[columns.len()],
                names.join(", ")
            );
            return Err(Fault::new(field, text));
        }
        let place = |k: usize| core::array::from_fn(|d| columns[d][k]);
        Ok((0..columns[0].len()).map(place).collect())
    }
}
