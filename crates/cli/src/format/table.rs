//! Tables of time and values, in the scene file or in a CSV file beside it.
//! A table has as many values a row as its use needs.

use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// Rows of a time and one or more values: either `rows`, or `file` and `columns`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// The rows themselves, each a time and its values.
    pub rows: Option<Vec<Vec<f64>>>,
    /// A CSV file with a header, found from the folder of the scene file.
    pub file: Option<PathBuf>,
    /// Columns of the file, that of times first.
    pub columns: Option<Vec<String>>,
    /// Factor on all values and not on times: 9.80665 for g, 0.001 for mm, 0.0174533 for degrees. One if not given.
    pub scale: Option<f64>,
}
