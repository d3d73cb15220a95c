//! Particles as VTK unstructured grids (`.vtu`), one vertex each, and time series of them (`.pvd`).
//! Binary, little-endian, appended to the XML, as visualisation programs read it fastest.

use super::csv::number;
use super::{file_error, write_whole, xml_escape};
use crate::error::Result;
use crate::particles::Shape;
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

mod sealed {
    pub trait Sealed {}
}

/// A number type that VTK knows.
///
/// ```
/// use meshfree::output::vtu::VtkNumber;
/// assert_eq!(f32::NAME, "Float32");
/// ```
pub trait VtkNumber: sealed::Sealed + Copy + Default {
    /// Its name in VTK.
    const NAME: &'static str;
    /// Appends the little-endian bytes.
    ///
    /// ```
    /// use meshfree::output::vtu::VtkNumber;
    /// let mut bytes = Vec::new();
    /// 258_i32.push_bytes(&mut bytes);
    /// assert_eq!(bytes, [2, 1, 0, 0]);
    /// ```
    fn push_bytes(self, bytes: &mut Vec<u8>);
}

macro_rules! vtk_numbers {
    ($($number:ty => $name:literal),*) => {$(
        impl sealed::Sealed for $number {}
        impl VtkNumber for $number {
            const NAME: &'static str = $name;
            fn push_bytes(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    )*};
}
vtk_numbers!(f32 => "Float32", f64 => "Float64", u8 => "UInt8", i32 => "Int32", u32 => "UInt32", i64 => "Int64");

/// The numbers of a field, as many as it has, and then nothing of meaning.
pub(crate) type FieldTuple = [f64; 9];

/// A quantity of every particle, or of every point of a grid, in the bytes of a file.
#[derive(Clone, Debug)]
pub(super) struct Array {
    pub name: String,
    kind: &'static str,
    components: usize,
    pub tuples: usize,
    bytes: Vec<u8>,
}

impl Array {
    pub fn new<T: VtkNumber, const C: usize>(
        name: &str,
        tuples: impl IntoIterator<Item = [T; C]>,
    ) -> Self {
        let mut array = Self {
            name: name.to_string(),
            kind: T::NAME,
            components: C,
            tuples: 0,
            bytes: Vec::new(),
        };
        for tuple in tuples {
            array.tuples += 1;
            for value in tuple {
                value.push_bytes(&mut array.bytes);
            }
        }
        array
    }
}

impl Array {
    /// A field in `D` dimensions as VTK reads it: vectors and matrices padded with zeros to three dimensions, a
    /// symmetric tensor as xx, yy, zz, xy, yz, xz.
    pub fn of_field<const D: usize>(
        name: &str,
        shape: Shape,
        tuples: impl Iterator<Item = FieldTuple>,
    ) -> Self {
        match shape {
            Shape::Scalar => Self::new(name, tuples.map(|[value, ..]| [value])),
            Shape::Tensor => Self::new(
                name,
                tuples.map(|[xx, yy, zz, yz, xz, xy, ..]| [xx, yy, zz, xy, yz, xz]),
            ),
            Shape::Matrix => {
                let at = |tuple: &FieldTuple, a: usize, b: usize| {
                    let inside = a < D && b < D;
                    if inside { tuple[a * D + b] } else { 0.0 }
                };
                let whole = |tuple| core::array::from_fn::<f64, 9, _>(|k| at(&tuple, k / 3, k % 3));
                Self::new(name, tuples.map(whole))
            }
            Shape::Point | Shape::Velocity | Shape::Vector => {
                let own = |tuple: FieldTuple| padded::<_, D>(core::array::from_fn(|d| tuple[d]));
                Self::new(name, tuples.map(own))
            }
        }
    }
}

/// Pads a vector in fewer dimensions with zeros.
fn padded<T: VtkNumber, const D: usize>(vector: [T; D]) -> [T; 3] {
    core::array::from_fn(|d| vector.get(d).copied().unwrap_or_default())
}

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

    /// The whole file.
    fn bytes(&self) -> Vec<u8> {
        let n = self.len();
        let time = self.time.map(|time| Array::new("TimeValue", [[time]]));
        let connectivity = Array::new("connectivity", (0..n as i64).map(|i| [i]));
        let offsets = Array::new("offsets", (1..=n as i64).map(|i| [i]));
        let types = Array::new("types", (0..n).map(|_| [1_u8]));

        let mut xml = String::from(concat!(
            "<?xml version=\"1.0\"?>\n",
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
            "<UnstructuredGrid>\n",
        ));
        let mut data: Vec<u8> = Vec::new();
        if let Some(time) = &time {
            xml += "<FieldData>\n";
            append(&mut xml, &mut data, time, " NumberOfTuples=\"1\"");
            xml += "</FieldData>\n";
        }
        let _ = writeln!(xml, "<Piece NumberOfPoints=\"{n}\" NumberOfCells=\"{n}\">");
        xml += "<PointData>\n";
        for array in &self.arrays {
            append(&mut xml, &mut data, array, "");
        }
        xml += "</PointData>\n<Points>\n";
        append(&mut xml, &mut data, &self.positions, "");
        xml += "</Points>\n<Cells>\n";
        for array in [&connectivity, &offsets, &types] {
            append(&mut xml, &mut data, array, "");
        }
        xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
        let mut bytes = xml.into_bytes();
        bytes.append(&mut data);
        bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}

/// Refuses arrays of another length than that of what they belong to.
pub(super) fn check_lengths(
    arrays: &[Array],
    count: usize,
    of: &'static str,
    path: &Path,
) -> Result<()> {
    let Some(array) = arrays.iter().find(|array| array.tuples != count) else {
        return Ok(());
    };
    let (name, own) = (&array.name, array.tuples);
    let what = format!("the array `{name}` has {own} values for {count} {of}");
    let source = io::Error::new(io::ErrorKind::InvalidInput, what);
    Err(file_error("write", path)(source))
}

/// Declares an array in the XML and appends its length and content to the data.
pub(super) fn append(xml: &mut String, data: &mut Vec<u8>, array: &Array, more: &str) {
    let _ = writeln!(
        xml,
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{more} format=\"appended\" offset=\"{}\"/>",
        array.kind,
        xml_escape(&array.name),
        array.components,
        data.len()
    );
    data.extend_from_slice(&(array.bytes.len() as u64).to_le_bytes());
    data.extend_from_slice(&array.bytes);
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
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let name = format!("{stem}_{:05}.vtu", self.frames);
        let path = self.path.with_file_name(&name);
        particles.write(&path)?;
        self.list(time, &name)?;
        Ok(path)
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
    use std::fs;

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
    }
}
