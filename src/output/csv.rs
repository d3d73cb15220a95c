//! Tables of numbers as comma-separated values, written row by row and read back exactly.
//! Numbers take the shortest form that gives the same number again.

use super::{file_error, make_folder};
use crate::error::Result;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// The shortest text that reads back as the same number.
///
/// ```
/// use meshfree::output::csv::number;
/// assert_eq!(number(0.1), "0.1");
/// assert_eq!(number(3.0), "3");
/// assert_eq!(number(-2.5e-9), "-2.5e-9");
/// ```
#[must_use]
pub fn number(value: f64) -> String {
    let mut text = String::new();
    push_number(&mut text, value);
    text
}

fn push_number(line: &mut String, value: f64) {
    // Writing to a string cannot fail.
    let _ = write!(line, "{value:?}");
    if line.ends_with(".0") {
        line.truncate(line.len() - 2);
    }
}

/// One cell of a row that mixes numbers and text.
///
/// ```
/// use meshfree::output::csv::Cell;
/// let row: [Cell; 2] = ["wave speed".into(), 1483.0.into()];
/// assert_eq!(row[1], Cell::Number(1483.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A number.
    Number(f64),
    /// A text, quoted where it must be.
    Text(&'a str),
}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl<'a> From<&'a str> for Cell<'a> {
    fn from(text: &'a str) -> Self {
        Self::Text(text)
    }
}

impl Cell<'_> {
    fn push(self, line: &mut String) {
        match self {
            Self::Number(value) => push_number(line, value),
            Self::Text(text) => {
                let special = |c: char| matches!(c, ',' | '"' | '\n' | '\r' | '#');
                if text.is_empty() || text.contains(special) || text.trim() != text {
                    line.push('"');
                    line.push_str(&text.replace('"', "\"\""));
                    line.push('"');
                } else {
                    line.push_str(text);
                }
            }
        }
    }
}

/// Writes a table row by row. Each row reaches the file whole, before the call returns.
///
/// ```no_run
/// use meshfree::output::csv::CsvWriter;
/// # fn main() -> meshfree::error::Result<()> {
/// let mut energy = CsvWriter::create("energy.csv", &["t [s]", "kinetic [J]"])?;
/// energy.row(&[0.0, 12.5])?;
/// energy.row(&[1e-3, 12.4])?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct CsvWriter {
    path: PathBuf,
    file: File,
    columns: usize,
    line: String,
}

impl CsvWriter {
    /// Creates the file, with its folder, and writes the header row.
    ///
    /// ```no_run
    /// # use meshfree::output::csv::CsvWriter;
    /// let table = CsvWriter::create("out/probe.csv", &["t [s]", "p [Pa]"])?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: impl AsRef<Path>, columns: &[impl AsRef<str>]) -> Result<Self> {
        Self::create_with_comment(path, "", columns)
    }

    /// Creates the file with a comment, one or several lines, above the header row.
    ///
    /// ```no_run
    /// # use meshfree::output::csv::CsvWriter;
    /// let table = CsvWriter::create_with_comment("p.csv", "probe at x = 0.5 m", &["t", "p"])?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create_with_comment(
        path: impl AsRef<Path>,
        comment: &str,
        columns: &[impl AsRef<str>],
    ) -> Result<Self> {
        let path = path.as_ref().to_path_buf();
        make_folder(&path)?;
        let file = File::create(&path).map_err(file_error("create", &path))?;
        let mut table = Self {
            path,
            file,
            columns: columns.len(),
            line: String::new(),
        };
        for text in comment.lines() {
            let _ = writeln!(table.line, "# {text}");
        }
        table.push_row(columns.iter().map(|name| Cell::Text(name.as_ref())))?;
        table.send()?;
        Ok(table)
    }

    /// Writes one row of numbers, as many as there are columns.
    ///
    /// ```no_run
    /// # use meshfree::output::csv::CsvWriter;
    /// # let mut table = CsvWriter::create("p.csv", &["t", "p"])?;
    /// table.row(&[0.25, 101_325.0])?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written, or the row has another length than the header.
    pub fn row(&mut self, values: &[f64]) -> Result<()> {
        self.push_row(values.iter().map(|&value| Cell::Number(value)))?;
        self.send()
    }

    /// Writes one row of numbers and texts.
    ///
    /// ```no_run
    /// # use meshfree::output::csv::CsvWriter;
    /// # let mut table = CsvWriter::create("errors.csv", &["quantity", "error"])?;
    /// table.mixed_row(&["density".into(), 1e-4.into()])?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written, or the row has another length than the header.
    pub fn mixed_row(&mut self, cells: &[Cell<'_>]) -> Result<()> {
        self.push_row(cells.iter().copied())?;
        self.send()
    }

    /// Writes many rows of numbers, faster than one by one.
    ///
    /// ```no_run
    /// # use meshfree::output::csv::CsvWriter;
    /// # let mut table = CsvWriter::create("profile.csv", &["x", "x^2"])?;
    /// table.rows((0..1000).map(|i| f64::from(i) * 1e-3).map(|x| [x, x * x]))?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written, or a row has another length than the header.
    pub fn rows<R: AsRef<[f64]>>(&mut self, rows: impl IntoIterator<Item = R>) -> Result<()> {
        const FULL: usize = 1 << 16;
        for row in rows {
            self.push_row(row.as_ref().iter().map(|&value| Cell::Number(value)))?;
            if self.line.len() >= FULL {
                self.send()?;
            }
        }
        self.send()
    }

    fn push_row<'a>(&mut self, cells: impl ExactSizeIterator<Item = Cell<'a>>) -> Result<()> {
        if cells.len() != self.columns {
            let what = format!("{} cells for {} columns", cells.len(), self.columns);
            let source = io::Error::new(io::ErrorKind::InvalidInput, what);
            return Err(file_error("write a row to", &self.path)(source));
        }
        for (column, cell) in cells.enumerate() {
            if column > 0 {
                self.line.push(',');
            }
            cell.push(&mut self.line);
        }
        self.line.push('\n');
        Ok(())
    }

    /// Hands the pending lines to the operating system in one piece.
    fn send(&mut self) -> Result<()> {
        let sent = self.file.write_all(self.line.as_bytes());
        self.line.clear();
        sent.map_err(file_error("write a row to", &self.path))
    }
}

/// A table that was read.
///
/// ```
/// use meshfree::output::csv::Csv;
/// let table = Csv::parse("# tube\nx,rho\n0,1\n0.5,0.125\n")?;
/// assert_eq!(table.column("rho"), Some(vec![1.0, 0.125]));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Csv {
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

impl Csv {
    /// Reads a file.
    ///
    /// ```no_run
    /// # use meshfree::output::csv::Csv;
    /// let table = Csv::read("energy.csv")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be read or is not a table.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        fs::read_to_string(path)
            .and_then(|text| Self::parse(&text))
            .map_err(file_error("read", path))
    }

    /// Reads a text. Lines that start with `#` and empty lines are skipped, and so is a last
    /// row that was cut off.
    ///
    /// ```
    /// # use meshfree::output::csv::Csv;
    /// let table = Csv::parse("t,p\n0,1\n1,")?;
    /// assert_eq!(table.rows.len(), 2);
    /// assert!(Csv::parse("t,p\n0\n1,2\n").is_err());
    /// # Ok::<(), std::io::Error>(())
    /// ```
    ///
    /// # Errors
    /// When a row has another length than the header, or a quote is not closed.
    pub fn parse(text: &str) -> io::Result<Self> {
        let mut rest = text;
        let mut records = Vec::new();
        while !rest.is_empty() {
            let line = rest.lines().next().unwrap_or_default();
            if line.starts_with('#') || line.trim().is_empty() {
                rest = rest.split_once('\n').map_or("", |(_, after)| after);
                continue;
            }
            let (record, after) = parse_record(rest);
            let whole = rest[..rest.len() - after.len()].ends_with('\n');
            records.push((record, whole));
            rest = after;
        }
        let mut records = records.into_iter();
        let header = records
            .next()
            .and_then(|(record, _)| record)
            .unwrap_or_default();
        let mut rows = Vec::with_capacity(records.len());
        for (index, (record, whole)) in records.enumerate() {
            match record {
                Some(row) if row.len() == header.len() => rows.push(row),
                _ if !whole => {}
                found => {
                    let what = format!(
                        "row {} has {} cells for {} columns",
                        index + 1,
                        found.map_or(0, |row| row.len()),
                        header.len()
                    );
                    return Err(io::Error::new(io::ErrorKind::InvalidData, what));
                }
            }
        }
        Ok(Self { header, rows })
    }

    /// A column as numbers; nothing when there is no such column or a cell is not a number.
    ///
    /// ```
    /// # use meshfree::output::csv::Csv;
    /// let table = Csv::parse("name,value\ng,9.81\n")?;
    /// assert_eq!(table.column("value"), Some(vec![9.81]));
    /// assert_eq!(table.column("name"), None);
    /// # Ok::<(), std::io::Error>(())
    /// ```
    #[must_use]
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let texts = self.text_column(name)?;
        texts.iter().map(|text| text.trim().parse().ok()).collect()
    }

    /// A column as texts; nothing when there is no such column.
    ///
    /// ```
    /// # use meshfree::output::csv::Csv;
    /// let table = Csv::parse("name,value\ng,9.81\n")?;
    /// assert_eq!(table.text_column("name"), Some(vec!["g"]));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    #[must_use]
    pub fn text_column(&self, name: &str) -> Option<Vec<&str>> {
        let column = self.header.iter().position(|known| known == name)?;
        let cells = self.rows.iter();
        cells
            .map(|row| row.get(column).map(String::as_str))
            .collect()
    }
}

/// The cells of the first record and what follows it; no cells when a quote stays open.
fn parse_record(text: &str) -> (Option<Vec<String>>, &str) {
    let mut cells = Vec::new();
    let mut cell = String::new();
    let mut quoted = false;
    let mut chars = text.char_indices().peekable();
    while let Some((at, c)) = chars.next() {
        match c {
            '"' if quoted && chars.next_if(|&(_, next)| next == '"').is_some() => cell.push('"'),
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(core::mem::take(&mut cell)),
            '\r' if !quoted => {}
            '\n' if !quoted => {
                cells.push(cell);
                return (Some(cells), &text[at + 1..]);
            }
            _ => cell.push(c),
        }
    }
    cells.push(cell);
    ((!quoted).then_some(cells), "")
}

#[cfg(test)]
mod tests {
    use super::super::tests::Folder;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_was_written_is_readable_before_the_writer_ends() {
        let folder = Folder::new("csv");
        let path = folder.file("below/table.csv");
        let mut table =
            CsvWriter::create_with_comment(&path, "a note\nin two lines", &["t [s]", "v"]).unwrap();
        table.row(&[0.0, 0.1]).unwrap();
        table.row(&[1e-300, f64::NEG_INFINITY]).unwrap();
        let read = Csv::read(&path).unwrap();
        assert_eq!(read.header, ["t [s]", "v"]);
        assert_eq!(read.column("t [s]"), Some(vec![0.0, 1e-300]));
        assert_eq!(read.column("v"), Some(vec![0.1, f64::NEG_INFINITY]));
        table
            .rows((0..10_000).map(|i| [f64::from(i), 0.5]))
            .unwrap();
        assert_eq!(Csv::read(&path).unwrap().rows.len(), 10_002);
    }

    #[test]
    fn rows_of_another_length_are_refused_and_leave_no_trace() {
        let folder = Folder::new("csv-length");
        let path = folder.file("table.csv");
        let mut table = CsvWriter::create(&path, &["a", "b"]).unwrap();
        let error = table.row(&[1.0]).unwrap_err().to_string();
        assert!(error.contains("1 cells for 2 columns"), "{error}");
        table.row(&[1.0, 2.0]).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "a,b\n1,2\n");
    }

    #[test]
    fn a_row_that_was_cut_off_is_left_out() {
        assert_eq!(Csv::parse("a,b\n1,2\n3").unwrap().rows.len(), 1);
        assert_eq!(Csv::parse("a,b\n1,2\n3,\"4").unwrap().rows.len(), 1);
        assert!(Csv::parse("a,b\n1,2\n3,\"4\n").is_err());
        assert_eq!(Csv::parse("a,b\r\n1,2\r\n3,4").unwrap().rows.len(), 2);
        assert_eq!(Csv::parse("").unwrap(), Csv::default());
        assert!(Csv::parse("a,b\n1,2,3\n4,5\n").is_err());
    }

    proptest! {
        #[test]
        fn numbers_read_back_as_they_were(bits: u64) {
            let value = f64::from_bits(bits);
            let read: f64 = number(value).parse().unwrap();
            prop_assert!(read.to_bits() == bits || (read.is_nan() && value.is_nan()));
        }

        #[test]
        fn texts_read_back_as_they_were(texts in proptest::collection::vec(".{0,8}|[,\"\r\n# ]{1,4}", 2)) {
            let folder = Folder::new("csv-texts");
            let path = folder.file("table.csv");
            let mut table = CsvWriter::create(&path, &["#a", "b,"]).unwrap();
            table.mixed_row(&[texts[0].as_str().into(), texts[1].as_str().into()]).unwrap();
            let read = Csv::read(&path).unwrap();
            prop_assert_eq!(&read.header, &["#a", "b,"]);
            prop_assert_eq!(&read.rows, &[texts]);
        }
    }
}
