//! Particles in pieces: the list (`.pvtu`) of the VTK files that hold the particles of one instant.
//! ParaView reads the list as one file, and each piece by itself.

use super::vtu::Vtu;
use super::{file_error, write_whole, xml_escape};
use crate::error::Result;
use std::fmt::Write as _;
use std::io;
use std::path::Path;

/// The ending by which readers know a list of pieces.
pub(crate) const ENDING: &str = "pvtu";

/// Files of one instant that hold parts of its particles, all with the same columns.
///
/// [`Simulation::write_pieces`](crate::simulation::Simulation::write_pieces) writes pieces and list of a simulation on ranks.
///
/// ```
/// use meshfree::output::pvtu::Pvtu;
/// use meshfree::output::vtu::Vtu;
/// let piece = |x: f64| Vtu::new([[x], [x + 1.0]]).scalar("density", [1000.0, 1001.0]);
/// # let folder = std::env::temp_dir().join(format!("meshfree-pvtu-{}", std::process::id()));
/// # /*
/// let folder = Path::new("out");
/// # */
/// let mut list = Pvtu::of(&piece(0.0));
/// for k in 0..3 {
///     let name = format!("now_{k}.vtu");
///     piece(f64::from(2 * k)).write(folder.join(&name))?;
///     list = list.piece(&name);
/// }
/// list.write(folder.join("now.pvtu"))?;
/// # let text = std::fs::read_to_string(folder.join("now.pvtu")).unwrap_or_default();
/// # assert_eq!(text.matches("<Piece ").count(), 3);
/// # let _ = std::fs::remove_dir_all(folder);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pvtu {
    columns: String,
    pieces: String,
}

impl Pvtu {
    /// A list without pieces, of files with the columns of this one.
    ///
    /// ```
    /// # use meshfree::output::{pvtu::Pvtu, vtu::Vtu};
    /// let list = Pvtu::of(&Vtu::new([[0.0], [1.0]]).scalar("body", [0, 0]));
    /// # let _ = list;
    /// ```
    #[must_use]
    pub fn of(piece: &Vtu) -> Self {
        let (positions, arrays) = piece.columns();
        let mut columns = String::from("<PPointData>\n");
        for array in arrays {
            let _ = writeln!(columns, "{}", array.declared());
        }
        let _ = write!(
            columns,
            "</PPointData>\n<PPoints>\n{}\n</PPoints>\n",
            positions.declared()
        );
        Self {
            columns,
            pieces: String::new(),
        }
    }

    /// Adds a file, by its path seen from the list's folder.
    ///
    /// ```
    /// # use meshfree::output::{pvtu::Pvtu, vtu::Vtu};
    /// let list = Pvtu::of(&Vtu::new([[0.0]])).piece("now_0.vtu").piece("now_1.vtu");
    /// # let _ = list;
    /// ```
    #[must_use]
    pub fn piece(mut self, file: &str) -> Self {
        let _ = writeln!(self.pieces, "<Piece Source=\"{}\"/>", xml_escape(file));
        self
    }

    /// Writes the list, with its folder. A file of that name is replaced in one stroke.
    ///
    /// ```no_run
    /// # use meshfree::output::{pvtu::Pvtu, vtu::Vtu};
    /// Pvtu::of(&Vtu::new([[0.0]])).piece("now_0.vtu").write("out/now.pvtu")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written, or has another ending than `.pvtu`.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        check_ending(path)?;
        let Self { columns, pieces } = self;
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n{columns}{pieces}</PUnstructuredGrid>\n</VTKFile>\n"
        );
        write_whole(path, text.as_bytes())
    }
}

/// The name of the piece of a rank, next to the list at `path`: `now_2.vtu` of rank 2 for `now.pvtu`.
pub(crate) fn piece_name(path: &Path, rank: usize) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    format!("{stem}_{rank}.vtu")
}

/// Refuses an ending by which readers do not know the list.
pub(crate) fn check_ending(path: &Path) -> Result<()> {
    if path.extension().is_some_and(|own| own == ENDING) {
        return Ok(());
    }
    let what = "a list of pieces must have the ending .pvtu, by which readers know it";
    let cause = io::Error::new(io::ErrorKind::InvalidInput, what);
    Err(file_error("write", path)(cause))
}

#[cfg(test)]
mod tests {
    use super::super::tests::Folder;
    use super::*;
    use std::fs;

    #[test]
    fn a_list_declares_the_columns_of_its_pieces() {
        let folder = Folder::new("pvtu");
        let piece = Vtu::new([[1.0_f32, 2.0]])
            .scalar("a<b", [7_i32])
            .vector("velocity", [[0.0, 1.0]]);
        let path = folder.file("deep/er.pvtu");
        let list = Pvtu::of(&piece).piece("er_0.vtu").piece("a&b.vtu");
        list.write(&path).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        for line in [
            "<PDataArray type=\"Int32\" Name=\"a&lt;b\" NumberOfComponents=\"1\"/>",
            "<PDataArray type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\"/>",
            "<PDataArray type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"/>",
            "<Piece Source=\"er_0.vtu\"/>",
            "<Piece Source=\"a&amp;b.vtu\"/>",
        ] {
            assert_eq!(text.lines().filter(|own| *own == line).count(), 1, "{text}");
        }
        let open = |tag: &str| text.matches(&format!("<{tag}")).count();
        for tag in ["PPointData", "PPoints", "PUnstructuredGrid", "VTKFile"] {
            assert_eq!((open(tag), open(&format!("/{tag}>"))), (1, 1), "{tag}");
        }
    }

    #[test]
    fn other_endings_are_refused() {
        let folder = Folder::new("pvtu-ending");
        let path = folder.file("now.vtu");
        let error = Pvtu::of(&Vtu::new([[0.0]])).write(&path).unwrap_err();
        assert!(error.to_string().contains(".pvtu"), "{error}");
        assert!(!path.exists());
        assert_eq!(piece_name(Path::new("out/now.pvtu"), 2), "now_2.vtu");
    }
}
