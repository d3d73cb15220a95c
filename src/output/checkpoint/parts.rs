//! A checkpoint in parts: a file of rows of each rank, and a manifest with their checksums and all else.
//! Parts take one of two names in turn, so those of the checkpoint before stand until the manifest is another.

use super::{CHECKSUM, Checkpoint, Piece, Read, damaged, whole, write_columns};
use crate::error::{CheckpointProblem, Error, Result};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Columns of so many rows are divided among ranks; the first rank has those of fewer.
pub(super) const LONG: usize = 64;

/// Columns of a manifest: checksums of the parts, and which of two names these have.
const PARTS: &str = "parts";
const TURN: &str = "turn";

const FORMAT: &str = "part of a meshfree checkpoint";

/// The part of a rank of the checkpoint at `path`: `run.a2` or `run.b2` of rank 2 for `run`.
fn part_of(path: &Path, turn: u32, rank: usize) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(if turn == 0 { ".a" } else { ".b" });
    name.push(rank.to_string());
    path.with_file_name(name)
}

/// The checkpoint at a path, before another takes its place.
#[derive(Debug, Default)]
pub(crate) struct Before {
    /// Which names the parts of the other may have.
    pub turn: u32,
    parts: Vec<PathBuf>,
}

impl Before {
    /// What stands there; what is no whole file is nothing to go on from.
    ///
    /// # Errors
    /// If there is something that cannot be read.
    pub fn at(path: &Path) -> Result<Self> {
        let file = match Checkpoint::read_alone(path) {
            Ok(file) => file,
            Err(Error::Checkpoint { .. }) => return Ok(Self::default()),
            Err(Error::File { cause, .. }) if cause.kind() == io::ErrorKind::NotFound => {
                return Ok(Self::default());
            }
            Err(error) => return Err(error),
        };
        let (Ok(parts), Ok(turn)) = (file.get::<u64>(PARTS), file.get_one::<u32>(TURN)) else {
            return Ok(Self::default());
        };
        Ok(Self {
            turn: 1 - turn.min(1),
            parts: (0..parts.len())
                .map(|rank| part_of(path, turn, rank))
                .collect(),
        })
    }

    /// Removes its parts, which no manifest names any more. What stays harms nothing.
    pub fn remove(self) {
        for part in self.parts {
            let _ = fs::remove_file(part);
        }
    }
}

impl Checkpoint {
    /// What one of several ranks puts: its rows of long columns, and the first one all else.
    pub fn of_rank(rank: usize, count: usize) -> Self {
        Self {
            ranks: Some([rank, count]),
            ..Self::default()
        }
    }

    /// Writes the rows of this rank next to `path`, and returns their checksum.
    pub fn write_rows(&mut self, path: &Path, turn: u32) -> Result<u64> {
        let rank = self.ranks.map_or(0, |[rank, _]| rank);
        let texts = BTreeMap::from([("format".to_owned(), FORMAT.to_owned())]);
        let rows = core::mem::take(&mut self.rows);
        write_columns(rows, texts, &part_of(path, turn, rank))
    }

    /// Writes all else, when all parts are there, with their checksums.
    pub fn write_manifest(mut self, path: &Path, turn: u32, parts: &[u64]) -> Result<()> {
        self.ranks = None;
        self.put(PARTS.into(), 1, parts);
        self.put_one(TURN.into(), turn);
        self.write(path)
    }

    /// Finds the rows of the ranks that wrote it, if ranks did. They stay where they are until a column is asked for.
    pub(super) fn join(&mut self, path: &Path) -> Read<()> {
        if !self.has(PARTS) {
            return Ok(());
        }
        let (sums, turn) = (self.get::<u64>(PARTS)?, self.get_one(TURN)?);
        let count = sums.len();
        for (rank, sum) in sums.into_iter().enumerate() {
            let part = part_of(path, turn, rank);
            let fault = |fault: String| CheckpointProblem::Part {
                part: part.clone(),
                rank,
                count,
                fault,
            };
            let bytes = fs::read(&part);
            let bytes = bytes.map_err(|cause| fault(format!("cannot be read: {cause}")))?;
            let own = whole(&bytes).map_err(|problem| match problem {
                CheckpointProblem::Damaged { detail } => {
                    fault(format!("is truncated or altered ({detail})"))
                }
                other => other,
            })?;
            if !bytes.ends_with(&sum.to_le_bytes()) {
                return Err(fault("is of another checkpoint".into()));
            }
            let file: Arc<Path> = part.as_path().into();
            for (name, view) in own.iter().filter(|own| own.0 != CHECKSUM) {
                let rows = super::Column {
                    kind: view.dtype(),
                    shape: view.shape().to_vec(),
                    bytes: Vec::new(),
                    pieces: vec![Piece {
                        part: file.clone(),
                        at: (view.data().as_ptr().addr() - bytes.as_ptr().addr()) as u64,
                        length: view.data().len(),
                    }],
                };
                match self.columns.entry(name.to_owned()) {
                    Entry::Vacant(none) => {
                        none.insert(rows);
                    }
                    Entry::Occupied(mut before) => before.get_mut().extend(rows)?,
                }
            }
        }
        Ok(())
    }
}

impl super::Column {
    /// Adds rows behind its own.
    fn extend(&mut self, rows: Self) -> Read<()> {
        let is_alike = self.kind == rows.kind && self.shape.get(1..) == rows.shape.get(1..);
        let is_alike = is_alike && self.bytes.is_empty();
        let (true, [own, ..], [more, ..]) = (is_alike, &mut *self.shape, &*rows.shape) else {
            return Err(damaged("its parts have other columns"));
        };
        *own += more;
        self.pieces.extend(rows.pieces);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::tests::Folder;

    fn fill(mut file: Checkpoint, first: f64) -> Checkpoint {
        let places: Vec<f64> = (0..600).map(|k| f64::from(k).mul_add(0.1, first)).collect();
        file.put("places".into(), 3, places);
        file.put("numbers".into(), 1, (0..70).collect::<Vec<u32>>());
        file.put("few".into(), 2, [first, 2.0]);
        file.put_one("time".into(), first);
        file.put_text("text", "of all");
        file
    }

    /// Writes what so many ranks write, and how far: that many parts, and then the manifest.
    fn write(path: &Path, count: usize, first: f64, acts: usize) {
        let before = Before::at(path).unwrap();
        let turn = before.turn;
        let mut files: Vec<_> = (0..count)
            .map(|rank| fill(Checkpoint::of_rank(rank, count), first))
            .collect();
        let parts = files.iter_mut().take(acts);
        let sums: Vec<u64> = parts
            .map(|own| own.write_rows(path, turn).unwrap())
            .collect();
        if acts > count {
            files.remove(0).write_manifest(path, turn, &sums).unwrap();
        }
        if acts > count + 1 {
            before.remove();
        }
    }

    fn time(path: &Path) -> f64 {
        let file = Checkpoint::read(path).unwrap();
        let places: [f64; 600] = file.get_array("places").unwrap();
        assert_eq!(places[0], file.get_one::<f64>("time").unwrap());
        places[0]
    }

    #[test]
    fn parts_are_the_whole() {
        let folder = Folder::new("parts");
        let path = folder.file("whole");
        fill(Checkpoint::default(), 0.5).write(&path).unwrap();
        let whole = Checkpoint::read(&path).unwrap();
        for count in [1, 2, 3, 7] {
            let path = folder.file(&format!("deep/er/on{count}"));
            write(&path, count, 0.5, usize::MAX);
            let files = fs::read_dir(path.parent().unwrap()).unwrap().count();
            assert_eq!(files, count + 1);
            let mut joined = Checkpoint::read(&path).unwrap();
            for name in [PARTS, TURN, CHECKSUM] {
                joined.columns.remove(name).unwrap();
            }
            assert_eq!(joined.columns.len() + 1, whole.columns.len());
            for (name, column) in joined.columns {
                let other = &whole.columns[&name];
                let kinds = [&column, other].map(|own| (own.kind, own.shape.clone()));
                assert_eq!(kinds[0], kinds[1], "{name}");
                assert_eq!(column.bytes(), other.bytes(), "{name}");
            }
            assert_eq!(joined.texts, whole.texts);
            fs::remove_dir_all(path.parent().unwrap()).unwrap();
        }
    }

    /// However far a checkpoint comes after another: what is read is one of both, whole.
    #[test]
    fn the_one_before_stands_until_the_manifest() {
        let folder = Folder::new("before");
        for [first, second] in [[3, 3], [3, 2], [2, 4]] {
            for acts in 0..=second + 2 {
                let path = folder.file(&format!("{first}_{second}_{acts}"));
                write(&path, first, 0.25, usize::MAX);
                write(&path, second, 0.5, acts);
                let expected = if acts > second { 0.5 } else { 0.25 };
                assert_eq!(time(&path), expected, "{acts}");
                // And the next one goes on from there.
                write(&path, second, 0.75, usize::MAX);
                assert_eq!(time(&path), 0.75, "{acts}");
            }
        }
        // An ordinary file, or what is none, gives way too.
        let path = folder.file("plain");
        fill(Checkpoint::default(), 0.125).write(&path).unwrap();
        write(&path, 2, 0.5, 2);
        assert_eq!(time(&path), 0.125);
        fs::write(&path, b"none").unwrap();
        write(&path, 2, 0.5, usize::MAX);
        assert_eq!(time(&path), 0.5);
    }

    #[test]
    fn a_part_that_is_not_there_or_another_is_named() {
        let folder = Folder::new("named");
        let (path, other) = (folder.file("run"), folder.file("other"));
        write(&path, 3, 0.5, usize::MAX);
        write(&other, 3, 0.25, usize::MAX);
        let part = folder.file("run.a1");
        let whole = fs::read(&part).unwrap();
        let said = || Checkpoint::read(&path).unwrap_err().to_string();
        for at in (0..whole.len()).step_by(7) {
            let mut altered = whole.clone();
            altered[at] ^= 4;
            fs::write(&part, altered).unwrap();
            let said = said();
            assert!(
                said.contains("run.a1") && said.contains("rank 1 of 3"),
                "{said}"
            );
        }
        fs::write(&part, &whole[..whole.len() - 1]).unwrap();
        assert!(said().contains("is truncated or altered"), "{}", said());
        fs::copy(folder.file("other.a1"), &part).unwrap();
        assert!(said().contains("is of another checkpoint"), "{}", said());
        fs::remove_file(&part).unwrap();
        assert!(said().contains("cannot be read") && said().contains("run.a1"));
        fs::write(&part, whole).unwrap();
        assert_eq!(time(&path), 0.5);
    }
}
