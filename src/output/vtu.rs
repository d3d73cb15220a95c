//! Particles as VTK unstructured grids (`.vtu`), one vertex each, and time series of them (`.pvd`).
//! Binary, little-endian, appended to the XML, as visualisation programs read it fastest.

use super::csv::number;
use super::vtk::{Array, FieldTuple, VtkFile, check_lengths, padded};
use super::{file_error, write_whole, xml_escape};
use crate::error::Result;
use crate::particles::Shape;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

pub use super::vtk::VtkNumber;

/// Particles at one instant: positions and what is known at each.
///
/// ```no_run
/// use meshfree::output::vtu::Vtu;
/// let positions = vec![[0.0, 0.0], [1.0, 0.5]];
/// let velocities = vec![[1.0_f32, 0.0], [0.0, 2.0]];
/// Vtu::new(positions)
///     .scalar("density", [1000.0, 1001.0])
///     .vector("velocity", velocities)
///     .write("particles.vtu")?;
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Vtu {
    positions: Array,
    arrays: Vec<Array>,
    time: Option<f64>,
}

impl Vtu {
    /// Particles at these positions \[m\], in 1, 2 or 3 dimensions.
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// let line = Vtu::new((0..10).map(|i| [f64::from(i) * 0.1]));
    /// # let _ = line;
    /// ```
    #[must_use]
    pub fn new<T: VtkNumber, const D: usize>(positions: impl IntoIterator<Item = [T; D]>) -> Self {
        const { assert!(D >= 1 && D <= 3, "VTK has three dimensions") };
        Self {
            positions: Array::new("Points", positions.into_iter().map(padded)),
            arrays: Vec::new(),
            time: None,
        }
    }

    /// Adds one number per particle.
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// let vtu = Vtu::new([[0.0], [1.0]]).scalar("density", [1.0_f32, 2.0]).scalar("body", [0, 1]);
    /// # let _ = vtu;
    /// ```
    #[must_use]
    pub fn scalar<T: VtkNumber>(self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        self.array(name, values.into_iter().map(|value| [value]))
    }

    /// Adds one vector per particle, padded with zeros to three components.
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// let vtu = Vtu::new([[0.0, 0.0]]).vector("velocity", [[3.0, 4.0]]);
    /// # let _ = vtu;
    /// ```
    #[must_use]
    pub fn vector<T: VtkNumber, const D: usize>(
        self,
        name: &str,
        vectors: impl IntoIterator<Item = [T; D]>,
    ) -> Self {
        const { assert!(D >= 1 && D <= 3, "VTK has three dimensions") };
        self.array(name, vectors.into_iter().map(padded))
    }

    /// Adds any number of components per particle, as they are.
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// // A symmetric tensor as xx, yy, zz, xy, yz, xz.
    /// let vtu = Vtu::new([[0.0, 0.0]]).array("stress", [[1.0, 2.0, 0.0, 0.5, 0.0, 0.0]]);
    /// # let _ = vtu;
    /// ```
    #[must_use]
    pub fn array<T: VtkNumber, const C: usize>(
        mut self,
        name: &str,
        tuples: impl IntoIterator<Item = [T; C]>,
    ) -> Self {
        self.arrays.push(Array::new(name, tuples));
        self
    }

    /// Adds a field in `D` dimensions.
    #[must_use]
    pub(crate) fn field<const D: usize>(
        mut self,
        name: &str,
        shape: Shape,
        tuples: impl Iterator<Item = FieldTuple>,
    ) -> Self {
        self.arrays.push(Array::of_field::<D>(name, shape, tuples));
        self
    }

    /// Says when, in the file itself \[s\].
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// let vtu = Vtu::new([[0.0]]).time(0.25);
    /// # let _ = vtu;
    /// ```
    #[must_use]
    pub fn time(mut self, time: f64) -> Self {
        self.time = Some(time);
        self
    }

    /// The number of particles.
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// assert_eq!(Vtu::new([[0.0], [1.0]]).len(), 2);
    /// ```
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.tuples
    }

    /// Whether there are no particles.
    ///
    /// ```
    /// # use meshfree::output::vtu::Vtu;
    /// assert!(!Vtu::new([[0.0], [1.0]]).is_empty());
    /// ```
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Writes the file, with its folder. A file of that name is replaced in one stroke.
    ///
    /// ```no_run
    /// # use meshfree::output::vtu::Vtu;
    /// Vtu::new([[0.0], [1.0]]).write("out/particles.vtu")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written, or an array has another length than the positions.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        check_lengths(&self.arrays, self.len(), "particles", path)?;
        write_whole(path, &self.bytes())
    }

    /// Positions, and what is known at each.
    pub(super) fn columns(&self) -> (&Array, &[Array]) {
        (&self.positions, &self.arrays)
    }

    /// The whole file.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let n = self.len();
        let connectivity = Array::new("connectivity", (0..n as i64).map(|i| [i]));
        let offsets = Array::new("offsets", (1..=n as i64).map(|i| [i]));
        let types = Array::new("types", (0..n).map(|_| [1_u8]));

        let mut file = VtkFile::new("UnstructuredGrid", "", self.time);
        file.line(&format!(
            "<Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\">"
        ));
        file.arrays("PointData", &self.arrays);
        file.arrays("Points", [&self.positions]);
        file.arrays("Cells", [&connectivity, &offsets, &types]);
        file.line("</Piece>");
        file.bytes()
    }
}

/// Particle files over time, listed in a `.pvd` file that is complete after each frame.
///
/// ```no_run
/// use meshfree::output::vtu::{Pvd, Vtu};
/// let mut movie = Pvd::create("out/jet.pvd")?;
/// for frame in 0..10 {
///     let time = f64::from(frame) * 1e-3;
///     movie.frame(time, &Vtu::new([[time], [1.0 + time]]).time(time))?;
/// }
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pvd {
    path: PathBuf,
    frames: usize,
    entries: String,
}

impl Pvd {
    /// Starts a time series without frames.
    ///
    /// ```no_run
    /// # use meshfree::output::vtu::Pvd;
    /// let movie = Pvd::create("out/jet.pvd")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: impl AsRef<Path>) -> Result<Self> {
        let series = Self {
            path: path.as_ref().to_path_buf(),
            frames: 0,
            entries: String::new(),
        };
        series.write()?;
        Ok(series)
    }

    /// Goes on with the series in a file, for a run that is resumed at `time` \[s\]: frames after that are listed no longer, and
    /// are written again. A series that is not there is started.
    ///
    /// ```no_run
    /// # use meshfree::output::vtu::Pvd;
    /// let movie = Pvd::resume("out/jet.pvd", 0.25)?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the file cannot be read or written.
    pub fn resume(path: impl AsRef<Path>, time: f64) -> Result<Self> {
        let path = path.as_ref();
        let mut series = Self {
            path: path.to_path_buf(),
            frames: 0,
            entries: String::new(),
        };
        if path.exists() {
            let text = fs::read_to_string(path).map_err(file_error("read", path))?;
            for line in text.lines() {
                let entry = line.split_once(" timestep=\"");
                let at = entry.and_then(|(_, rest)| rest.split('"').next()?.parse::<f64>().ok());
                if at.is_some_and(|at| at <= time) {
                    series.entries += line;
                    series.entries.push('\n');
                    series.frames += 1;
                }
            }
        }
        series.write()?;
        Ok(series)
    }

    /// Writes a frame next to the list, as `jet_00000.vtu` for `jet.pvd`, and lists it.
    ///
    /// ```no_run
    /// # use meshfree::output::vtu::{Pvd, Vtu};
    /// # let mut movie = Pvd::create("out/jet.pvd")?;
    /// let path = movie.frame(0.5, &Vtu::new([[0.0], [1.0]]))?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When a file cannot be written, or an array has another length than the positions.
    pub fn frame(&mut self, time: f64, particles: &Vtu) -> Result<PathBuf> {
        let name = self.next("vtu");
        let path = self.path.with_file_name(&name);
        particles.write(&path)?;
        self.list(time, &name)?;
        Ok(path)
    }

    /// The name of the next frame, with an ending.
    pub(crate) fn next(&self, ending: &str) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        format!("{stem}_{:05}.{ending}", self.frames)
    }

    /// Lists a file that is already there, by its path seen from the list's folder.
    ///
    /// ```no_run
    /// # use meshfree::output::vtu::Pvd;
    /// # let mut movie = Pvd::create("out/jet.pvd")?;
    /// movie.list(0.5, "frames/jet_00001.vtu")?;
    /// # Ok::<(), meshfree::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// When the list cannot be written.
    pub fn list(&mut self, time: f64, file: &str) -> Result<()> {
        let _ = writeln!(
            self.entries,
            "<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>",
            number(time),
            xml_escape(file)
        );
        self.frames += 1;
        self.write()
    }

    fn write(&self) -> Result<()> {
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
             byte_order=\"LittleEndian\">\n<Collection>\n{}</Collection>\n</VTKFile>\n",
            self.entries
        );
        write_whole(&self.path, text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::Folder;
    use super::*;
    /// The text of an attribute in the tag that starts at the front of `tag`.
    fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
        let tag = tag.split('>').next().unwrap();
        let start = tag.find(&format!("{name}=\"")).unwrap() + name.len() + 2;
        tag[start..].split('"').next().unwrap()
    }

    /// The bytes of an array, found as a reader finds them.
    fn array(file: &[u8], name: &str) -> (String, usize, Vec<u8>) {
        let start = file.windows(6).position(|w| w == b"raw\">\n").unwrap() + 7;
        let xml = std::str::from_utf8(&file[..start]).unwrap();
        let tag = xml
            .split("<DataArray ")
            .find(|tag| tag.contains(&format!("Name=\"{name}\"")))
            .unwrap();
        let at = start + attribute(tag, "offset").parse::<usize>().unwrap();
        let length = u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
        (
            attribute(tag, "type").to_string(),
            attribute(tag, "NumberOfComponents").parse().unwrap(),
            file[at + 8..at + 8 + length].to_vec(),
        )
    }

    fn floats(bytes: &[u8]) -> Vec<f64> {
        let chunks = bytes.chunks_exact(8);
        chunks
            .map(|c| f64::from_le_bytes(c.try_into().unwrap()))
            .collect()
    }

    #[test]
    fn arrays_are_where_the_file_says() {
        let file = Vtu::new([[1.0, 2.0], [3.0, 4.0]])
            .scalar("a<b", [7.0_f32, 8.0])
            .vector("v", [[5.0], [6.0]])
            .time(0.5)
            .bytes();
        let (kind, components, bytes) = array(&file, "Points");
        assert_eq!((kind.as_str(), components), ("Float64", 3));
        assert_eq!(floats(&bytes), [1.0, 2.0, 0.0, 3.0, 4.0, 0.0]);
        let (kind, components, bytes) = array(&file, "a&lt;b");
        assert_eq!((kind.as_str(), components), ("Float32", 1));
        assert_eq!(
            bytes,
            [7.0_f32.to_le_bytes(), 8.0_f32.to_le_bytes()].concat()
        );
        assert_eq!(floats(&array(&file, "v").2), [5.0, 0.0, 0.0, 6.0, 0.0, 0.0]);
        assert_eq!(floats(&array(&file, "TimeValue").2), [0.5]);
        assert_eq!(array(&file, "types").2, [1, 1]);
        assert_eq!(array(&file, "offsets").2[8], 2);
        assert!(file.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
    }

    #[test]
    fn tags_are_balanced() {
        let file = Vtu::new(Vec::<[f32; 3]>::new()).bytes();
        let text = String::from_utf8_lossy(&file);
        let mut open = Vec::new();
        for tag in text.split('<').skip(1) {
            let name = tag.split([' ', '>', '/']).next().unwrap();
            if let Some(closing) = tag.strip_prefix('/') {
                assert_eq!(open.pop(), closing.split('>').next());
            } else if !tag.contains("/>") && !tag.starts_with('?') {
                open.push(name);
            }
        }
        assert!(open.is_empty(), "{open:?}");
    }

    #[test]
    fn arrays_of_another_length_are_refused() {
        let folder = Folder::new("vtu-length");
        let path = folder.file("a.vtu");
        let error = Vtu::new([[0.0]]).scalar("rho", [1.0, 2.0]).write(&path);
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains("`rho` has 2 values for 1 particles"),
            "{error}"
        );
        assert!(!path.exists());
    }

    #[test]
    fn a_series_lists_its_frames() {
        let folder = Folder::new("pvd");
        let mut series = Pvd::create(folder.file("jet.pvd")).unwrap();
        for time in [0.0, 1e-7] {
            let path = series.frame(time, &Vtu::new([[time]])).unwrap();
            assert!(path.exists());
        }
        let text = fs::read_to_string(folder.file("jet.pvd")).unwrap();
        let tags: Vec<_> = text.split("<DataSet ").skip(1).collect();
        assert_eq!(tags.len(), 2);
        assert_eq!(attribute(tags[1], "timestep"), "1e-7");
        assert_eq!(attribute(tags[1], "file"), "jet_00001.vtu");
        // Resumed between the two, the second is written again.
        let mut resumed = Pvd::resume(folder.file("jet.pvd"), 5e-8).unwrap();
        resumed.frame(2e-7, &Vtu::new([[0.0]])).unwrap();
        let text = fs::read_to_string(folder.file("jet.pvd")).unwrap();
        let tags: Vec<_> = text.split("<DataSet ").skip(1).collect();
        let times = tags.iter().map(|tag| attribute(tag, "timestep"));
        assert_eq!(times.collect::<Vec<_>>(), ["0", "2e-7"]);
        assert_eq!(attribute(tags[1], "file"), "jet_00001.vtu");
    }
}
