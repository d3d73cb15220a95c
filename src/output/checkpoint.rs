//! The file of a checkpoint: named columns and texts in the safetensors format, under a checksum.
//! It knows nothing of what they mean.
//!
//! The last column, `checksum`, is the hash of every byte before it.

mod parts;

pub(crate) use super::hash::Hash;
pub(crate) use parts::Before;

use super::{file_error, make_folder};
use crate::error::{CheckpointProblem, Error, Result};
use crate::ranks::even;
use crate::scalar::Real;
use safetensors::{Dtype, SafeTensors, View};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read as _, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Arc;

/// What reading a checkpoint gives.
pub(crate) type Read<V> = core::result::Result<V, CheckpointProblem>;

/// Hashes of parts, by name.
pub(crate) type Hashes = Vec<(&'static str, u64)>;

/// A number as it stands in a file.
pub(crate) trait Number: Copy {
    const KIND: Dtype;
    /// Appends its bytes, the lowest first.
    fn append(self, bytes: &mut Vec<u8>);
    /// The number of some bytes, of which there must be as many as its size.
    fn of(bytes: &[u8]) -> Option<Self>;
}

macro_rules! numbers {
    ($($Type:ty: $Kind:ident),*) => {
        $(impl Number for $Type {
            const KIND: Dtype = Dtype::$Kind;
            fn append(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
            fn of(bytes: &[u8]) -> Option<Self> {
                Some(Self::from_le_bytes(bytes.try_into().ok()?))
            }
        })*
    };
}

numbers!(u8: U8, u32: U32, u64: U64, f32: F32, f64: F64);

#[derive(Clone, Debug, PartialEq)]
struct Column {
    kind: Dtype,
    shape: Vec<usize>,
    bytes: Vec<u8>,
    /// Where they are instead, one piece after another, if they are in parts of ranks.
    pieces: Vec<Piece>,
}

/// Bytes of a column in the part of a rank.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    part: Arc<Path>,
    at: u64,
    length: usize,
}

impl Piece {
    fn read(&self, to: &mut Vec<u8>) -> io::Result<()> {
        let mut file = File::open(&self.part)?;
        file.seek(SeekFrom::Start(self.at))?;
        let found = file.take(self.length as u64).read_to_end(to)?;
        if found < self.length {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(())
    }
}

impl Column {
    /// Its bytes, which are read where they are in parts.
    fn bytes(&self) -> Read<Cow<'_, [u8]>> {
        if self.pieces.is_empty() {
            return Ok(Cow::Borrowed(&self.bytes));
        }
        let lengths = self.pieces.iter().map(|own| own.length);
        let mut all = Vec::with_capacity(lengths.sum());
        for piece in &self.pieces {
            let fault = |cause| damaged(format!("`{}`: {cause}", piece.part.display()));
            piece.read(&mut all).map_err(fault)?;
        }
        Ok(Cow::Owned(all))
    }

    fn of<N: Number>(shape: Vec<usize>, numbers: impl Iterator<Item = N>) -> Self {
        let mut bytes = Vec::with_capacity(size_of::<N>() * shape.iter().product::<usize>());
        numbers.for_each(|number| number.append(&mut bytes));
        Self {
            kind: N::KIND,
            shape,
            bytes,
            pieces: Vec::new(),
        }
    }
}

impl View for &Column {
    fn dtype(&self) -> Dtype {
        self.kind
    }
    fn shape(&self) -> &[usize] {
        &self.shape
    }
    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&self.bytes)
    }
    fn data_len(&self) -> usize {
        self.bytes.len()
    }
}

/// Named columns and named texts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Checkpoint {
    columns: BTreeMap<String, Column>,
    texts: BTreeMap<String, String>,
    /// This rank and how many there are, if each writes its rows of long columns as a file of its own.
    ranks: Option<[usize; 2]>,
    /// These rows.
    rows: BTreeMap<String, Column>,
}

/// The column that is the hash of all before it: the only one of bytes, which the format puts behind wider numbers.
const CHECKSUM: &str = "checksum";

/// Bytes of a checksum.
const SUM: usize = size_of::<u64>();

pub(crate) fn damaged(detail: impl Into<String>) -> CheckpointProblem {
    CheckpointProblem::Damaged {
        detail: detail.into(),
    }
}

impl Checkpoint {
    /// Adds rows of `width` numbers.
    pub fn put<N: Number>(&mut self, name: String, width: usize, numbers: impl AsRef<[N]>) {
        let numbers = numbers.as_ref();
        let rows = numbers.len() / width.max(1);
        let shape = if width == 1 {
            vec![rows]
        } else {
            vec![rows, width]
        };
        self.put_shaped(name, shape, numbers.iter().copied());
    }

    /// Adds one number.
    pub fn put_one<N: Number>(&mut self, name: String, number: N) {
        self.put_shaped(name, Vec::new(), core::iter::once(number));
    }

    /// Adds rows of `width` scalars of a simulation.
    pub fn put_reals<T: Real>(&mut self, name: String, width: usize, numbers: &[T]) {
        let shape = match width {
            1 => vec![numbers.len()],
            _ => vec![numbers.len() / width.max(1), width],
        };
        if T::NAME == f32::NAME {
            let numbers = numbers.iter().map(|number| number.to_f64() as f32);
            self.put_shaped(name, shape, numbers);
        } else {
            self.put_shaped(name, shape, numbers.iter().map(|number| number.to_f64()));
        }
    }

    fn put_shaped<N: Number>(
        &mut self,
        name: String,
        mut shape: Vec<usize>,
        numbers: impl Iterator<Item = N>,
    ) {
        let rows = shape.first().copied().unwrap_or(0);
        match self.ranks {
            Some([rank, count]) if rows >= parts::LONG => {
                let own = even(rows, rank, count);
                shape[0] = own.len();
                let width: usize = shape[1..].iter().product();
                let numbers = numbers.skip(width * own.start).take(width * own.len());
                self.rows.insert(name, Column::of(shape, numbers));
            }
            Some([rank, _]) if rank > 0 => {}
            _ => {
                self.columns.insert(name, Column::of(shape, numbers));
            }
        }
    }

    /// Adds a text.
    pub fn put_text(&mut self, name: impl Into<String>, text: impl Into<String>) {
        self.texts.insert(name.into(), text.into());
    }

    /// Whether there is a column of that name.
    pub fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name)
    }

    /// Whether a column with both parts in its name has any number.
    pub fn has_numbers(&self, first: &str, second: &str) -> bool {
        let mut all = self.columns.iter();
        all.any(|(name, own)| {
            let count: usize = own.shape.iter().product();
            name.contains(first) && name.contains(second) && count > 0
        })
    }

    /// What follows in the names of columns that begin alike.
    pub fn names<'a>(&'a self, begin: &'a str) -> impl Iterator<Item = &'a str> {
        self.columns
            .keys()
            .filter_map(move |own| own.strip_prefix(begin))
    }

    /// How many scalars of a simulation are in a row, and these, whether `f32` or `f64`.
    pub fn get_rows(&self, name: &str) -> Read<(usize, Vec<f64>)> {
        let width = self.columns.get(name).and_then(|own| own.shape.get(1));
        let numbers = match self.get_reals::<f64>(name) {
            Ok(numbers) => numbers,
            Err(_) => self.get::<f32>(name)?.into_iter().map(f64::from).collect(),
        };
        Ok((width.copied().unwrap_or(1), numbers))
    }

    /// The numbers of a column.
    pub fn get<N: Number>(&self, name: &str) -> Read<Vec<N>> {
        let column = self.columns.get(name);
        let column = column.ok_or_else(|| damaged(format!("there is no column `{name}`")))?;
        let bytes = column.bytes()?;
        let numbers = bytes.chunks_exact(size_of::<N>()).map(N::of);
        match numbers.collect() {
            Some(numbers) if column.kind == N::KIND => Ok(numbers),
            _ => Err(damaged(format!("column `{name}` is of {}", column.kind))),
        }
    }

    /// The numbers of a column that must have `count` of them.
    pub fn get_all<N: Number>(&self, name: &str, count: usize) -> Read<Vec<N>> {
        let numbers = self.get(name)?;
        let found = numbers.len();
        if found == count {
            return Ok(numbers);
        }
        let detail = format!("column `{name}` has {found} numbers where {count} belong");
        Err(damaged(detail))
    }

    /// So many numbers.
    pub fn get_array<N: Number, const COUNT: usize>(&self, name: &str) -> Read<[N; COUNT]> {
        let numbers = self.get_all(name, COUNT)?;
        numbers
            .try_into()
            .map_err(|_| damaged(format!("column `{name}` is too short")))
    }

    /// One number.
    pub fn get_one<N: Number>(&self, name: &str) -> Read<N> {
        self.get_array::<N, 1>(name).map(|[number]| number)
    }

    /// Scalars of a simulation.
    pub fn get_reals<T: Real>(&self, name: &str) -> Read<Vec<T>> {
        let of = |number: f64| T::from_f64(number);
        if T::NAME == f32::NAME {
            let numbers = self.get::<f32>(name)?;
            return Ok(numbers.into_iter().map(f64::from).map(of).collect());
        }
        Ok(self.get::<f64>(name)?.into_iter().map(of).collect())
    }

    /// Scalars of a simulation, of which there must be `count`.
    pub fn get_all_reals<T: Real>(&self, name: &str, count: usize) -> Read<Vec<T>> {
        let numbers = self.get_reals(name)?;
        let found = numbers.len();
        if found == count {
            return Ok(numbers);
        }
        let detail = format!("column `{name}` has {found} numbers where {count} belong");
        Err(damaged(detail))
    }

    /// A text.
    pub fn text(&self, name: &str) -> Read<&str> {
        let text = self.texts.get(name).map(String::as_str);
        text.ok_or_else(|| damaged(format!("there is no text `{name}`")))
    }

    /// Writes the file at once: a reader, or a run that starts after a crash, sees the old one or the new one.
    pub fn write(self, path: &Path) -> Result<()> {
        write_columns(self.columns, self.texts, path).map(|_| ())
    }

    /// Reads a file, whole and unaltered, with the parts that ranks have written beside it.
    pub fn read(path: &Path) -> Result<Self> {
        let mut file = Self::read_alone(path)?;
        file.join(path).map_err(of_file(path))?;
        Ok(file)
    }

    /// Reads a file without parts beside it: its texts are all that there are.
    pub fn read_alone(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).map_err(file_error("read", path))?;
        Self::of_bytes(&bytes).map_err(of_file(path))
    }

    fn of_bytes(bytes: &[u8]) -> Read<Self> {
        let file = whole(bytes)?;
        let columns = file.iter().map(|(name, view)| {
            let column = Column {
                kind: view.dtype(),
                shape: view.shape().to_vec(),
                bytes: view.data().to_vec(),
                pieces: Vec::new(),
            };
            (name.to_string(), column)
        });
        let columns = columns.collect();
        let broken = |error: safetensors::SafeTensorError| damaged(error.to_string());
        let (_, header) = SafeTensors::read_metadata(bytes).map_err(broken)?;
        let texts = header.metadata().iter().flatten();
        let texts = texts.map(|(name, text)| (name.clone(), text.clone()));
        Ok(Self {
            columns,
            texts: texts.collect(),
            ..Self::default()
        })
    }
}

/// A file under its checksum.
fn whole(bytes: &[u8]) -> Read<SafeTensors<'_>> {
    let broken = |error: safetensors::SafeTensorError| damaged(error.to_string());
    let file = SafeTensors::deserialize(bytes).map_err(broken)?;
    let sum = file.tensor(CHECKSUM).map_err(broken)?;
    let end = bytes.len().saturating_sub(SUM);
    let mut hash = Hash::new();
    hash.bytes(&bytes[..end]);
    if sum.data() != hash.value().to_le_bytes() || sum.data() != &bytes[end..] {
        return Err(damaged("the checksum does not fit the rest"));
    }
    Ok(file)
}

/// The error of a problem of the file at `path`.
fn of_file(path: &Path) -> impl Fn(CheckpointProblem) -> Error {
    move |problem| Error::Checkpoint {
        path: path.to_path_buf(),
        problem,
    }
}

/// Writes a file at once, under a checksum, and returns that.
fn write_columns(
    mut columns: BTreeMap<String, Column>,
    texts: BTreeMap<String, String>,
    path: &Path,
) -> Result<u64> {
    let none = [0_u8; SUM].into_iter();
    columns.insert(CHECKSUM.into(), Column::of(vec![SUM], none));
    let texts = texts.into_iter().collect();
    let mut bytes = safetensors::serialize(&columns, Some(texts))
        .map_err(|error| file_error("write", path)(io::Error::other(error.to_string())))?;
    drop(columns);
    let mut hash = Hash::new();
    let end = bytes.len() - SUM;
    hash.bytes(&bytes[..end]);
    let sum = hash.value();
    bytes[end..].copy_from_slice(&sum.to_le_bytes());
    make_folder(path)?;
    let mut part: OsString = path.as_os_str().to_owned();
    part.push(".part");
    let part = Path::new(&part);
    let mut file = File::create(part).map_err(file_error("write", part))?;
    file.write_all(&bytes)
        .and_then(|()| file.sync_all())
        .map_err(file_error("write", part))?;
    drop(file);
    fs::rename(part, path).map_err(file_error("write", path))?;
    sync_folder(path)?;
    Ok(sum)
}

/// Makes a new name in a folder last.
#[cfg(unix)]
fn sync_folder(path: &Path) -> Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    File::open(folder)
        .and_then(|folder| folder.sync_all())
        .map_err(file_error("write", folder))
}

/// Elsewhere the system sees to it.
#[cfg(not(unix))]
#[allow(clippy::unnecessary_wraps)]
fn sync_folder(_path: &Path) -> Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::tests::Folder;

    fn example() -> Checkpoint {
        let mut file = Checkpoint::default();
        file.put("places".into(), 2, [1.0, -0.0, f64::NAN, 5e-324]);
        file.put_reals("small".into(), 1, &[1.0e-40_f32, f32::INFINITY]);
        file.put("numbers".into(), 1, [u64::MAX, 0]);
        file.put_one("one".into(), 7_u32);
        file.put_text("text", "ρ \"quoted\"\n");
        file
    }

    #[test]
    fn what_was_put_comes_back_to_the_bit() {
        let folder = Folder::new("checkpoint");
        let path = folder.file("deep/er/one.safetensors");
        example().write(&path).unwrap();
        example().write(&path).unwrap();
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        let file = Checkpoint::read(&path).unwrap();
        let bits = |numbers: Vec<f64>| numbers.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        let places = [1.0, -0.0, f64::NAN, 5e-324].map(f64::to_bits);
        assert_eq!(bits(file.get("places").unwrap()), places);
        let small: Vec<f32> = file.get_reals("small").unwrap();
        assert_eq!(small, [1.0e-40_f32, f32::INFINITY]);
        assert_eq!(file.get::<u64>("numbers").unwrap(), [u64::MAX, 0]);
        assert_eq!(file.get_one::<u32>("one").unwrap(), 7);
        assert_eq!(file.text("text").unwrap(), "ρ \"quoted\"\n");
        for wrong in [
            file.get::<f64>("small").map(|_| ()),
            file.get::<f64>("absent").map(|_| ()),
            file.get_all::<u64>("numbers", 3).map(|_| ()),
            file.text("absent").map(|_| ()),
        ] {
            assert!(matches!(wrong, Err(CheckpointProblem::Damaged { .. })));
        }
    }

    #[test]
    fn no_altered_byte_and_no_missing_end_goes_unseen() {
        let folder = Folder::new("altered");
        let path = folder.file("one.safetensors");
        example().write(&path).unwrap();
        let whole = fs::read(&path).unwrap();
        assert!(Checkpoint::of_bytes(&whole).is_ok());
        for length in 0..whole.len() {
            assert!(Checkpoint::of_bytes(&whole[..length]).is_err(), "{length}");
        }
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut altered = whole.clone();
                altered[at] ^= 1 << bit;
                assert!(Checkpoint::of_bytes(&altered).is_err(), "{at} {bit}");
            }
        }
        let longer = [&whole[..], &[0]].concat();
        assert!(Checkpoint::of_bytes(&longer).is_err());
    }
}
