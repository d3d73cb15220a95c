//! What the XML files of VTK share: head and foot, the time, and arrays whose bytes are appended to the XML.
//! Binary and little-endian; what an array belongs to is said by the file that has it.

use super::{file_error, xml_escape};
use crate::error::Result;
use crate::particles::Shape;
use std::fmt::Write as _;
use std::io;
use std::path::Path;

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
pub(super) type FieldTuple = [f64; 9];

/// A quantity of every particle, or of every point of a grid, in the bytes of a file.
#[derive(Clone, Debug)]
pub(super) struct Array {
    name: String,
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

    /// What a list of pieces says of it.
    pub fn declared(&self) -> String {
        format!(
            "<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>",
            self.kind,
            xml_escape(&self.name),
            self.components
        )
    }

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
pub(super) fn padded<T: VtkNumber, const D: usize>(vector: [T; D]) -> [T; 3] {
    core::array::from_fn(|d| vector.get(d).copied().unwrap_or_default())
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

/// A file of one piece as it is written, and the bytes that are appended to it.
#[derive(Clone, Debug)]
pub(super) struct VtkFile {
    kind: &'static str,
    xml: String,
    data: Vec<u8>,
}

impl VtkFile {
    /// A file of this kind of data set with the attributes of that, and of a time \[s\].
    pub fn new(kind: &'static str, attributes: &str, time: Option<f64>) -> Self {
        let xml = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <{kind}{attributes}>\n"
        );
        let mut file = Self {
            kind,
            xml,
            data: Vec::new(),
        };
        if let Some(time) = time {
            file.line("<FieldData>");
            let time = Array::new("TimeValue", [[time]]);
            file.append(&time, " NumberOfTuples=\"1\"");
            file.line("</FieldData>");
        }
        file
    }

    /// Writes a line of XML.
    pub fn line(&mut self, text: &str) {
        self.xml += text;
        self.xml.push('\n');
    }

    /// Writes arrays within an element of this name.
    pub fn arrays<'a>(&mut self, element: &str, arrays: impl IntoIterator<Item = &'a Array>) {
        self.line(&format!("<{element}>"));
        for array in arrays {
            self.append(array, "");
        }
        self.line(&format!("</{element}>"));
    }

    /// Declares an array in the XML and appends its length and content to the data.
    fn append(&mut self, array: &Array, more: &str) {
        let _ = writeln!(
            self.xml,
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{more} format=\"appended\" offset=\"{}\"/>",
            array.kind,
            xml_escape(&array.name),
            array.components,
            self.data.len()
        );
        let length = array.bytes.len() as u64;
        self.data.extend_from_slice(&length.to_le_bytes());
        self.data.extend_from_slice(&array.bytes);
    }

    /// The whole file.
    pub fn bytes(mut self) -> Vec<u8> {
        let end = format!("</{}>\n<AppendedData encoding=\"raw\">\n_", self.kind);
        self.xml += &end;
        let mut bytes = self.xml.into_bytes();
        bytes.append(&mut self.data);
        bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}
