//! Points of a regular grid as VTK image data (`.vti`): slices, contours and streamlines of sampled fields.
//! Binary, little-endian, appended to the XML, as visualisation programs read it fastest.

use super::vtk::{Array, FieldTuple, VtkFile, VtkNumber, check_lengths};
use super::write_whole;
use crate::error::Result;
use crate::particles::Shape;
use std::path::Path;

/// A regular grid and what is known at each of its points, x varying first.
///
/// ```no_run
/// use meshfree::output::vti::Vti;
/// // Three points along x, two along y, 0.1 m apart.
/// Vti::new([0.0, 0.0], [0.1, 0.1], [3, 2])
///     .scalar("pressure", [0.0, 1.0, 2.0, 10.0, 11.0, 12.0])
///     .write("pressure.vti")?;
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Vti {
    origin: [f64; 3],
    spacing: [f64; 3],
    counts: [usize; 3],
    arrays: Vec<Array>,
    time: Option<f64>,
}

impl Vti {
    /// A grid from its lowest point \[m\], the spacing of its points \[m\] and their number along each axis, in 1, 2 or
    /// 3 dimensions.
    #[must_use]
    pub fn new<const D: usize>(origin: [f64; D], spacing: [f64; D], counts: [usize; D]) -> Self {
        const { assert!(D >= 1 && D <= 3, "VTK has three dimensions") };
        let of =
            |own: [f64; D], rest| core::array::from_fn(|d| own.get(d).copied().unwrap_or(rest));
        Self {
            origin: of(origin, 0.0),
            spacing: of(spacing, 1.0),
            counts: core::array::from_fn(|d| counts.get(d).copied().unwrap_or(1)),
            arrays: Vec::new(),
            time: None,
        }
    }

    /// Adds one number per point.
    ///
    /// ```
    /// # use meshfree::output::vti::Vti;
    /// let vti = Vti::new([0.0], [0.5], [2]).scalar("filling", [1.0_f32, 0.0]);
    /// assert_eq!(vti.points(), 2);
    /// ```
    #[must_use]
    pub fn scalar<T: VtkNumber>(mut self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        let tuples = values.into_iter().map(|value| [value]);
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
    #[must_use]
    pub fn time(mut self, time: f64) -> Self {
        self.time = Some(time);
        self
    }

    /// The number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.counts.iter().product()
    }

    /// Writes the file, with its folder. A file of that name is replaced in one stroke.
    ///
    /// # Errors
    /// When the file cannot be written, or an array has another length than the grid has points.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        check_lengths(&self.arrays, self.points(), "points", path)?;
        write_whole(path, &self.bytes())
    }

    /// The whole file.
    fn bytes(&self) -> Vec<u8> {
        let [x, y, z] = self.counts.map(|count| count.saturating_sub(1));
        let extent = format!("0 {x} 0 {y} 0 {z}");
        let words = |numbers: [f64; 3]| numbers.map(super::csv::number).join(" ");
        let attributes = format!(
            " WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\"",
            words(self.origin),
            words(self.spacing)
        );
        let mut file = VtkFile::new("ImageData", &attributes, self.time);
        file.line(&format!("<Piece Extent=\"{extent}\">"));
        file.arrays("PointData", &self.arrays);
        file.line("</Piece>");
        file.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_says_where_its_points_are() {
        let rows = [1.0, 2.0, 3.0, 4.0].map(|x| {
            let mut tuple = FieldTuple::default();
            tuple[..2].copy_from_slice(&[x, -x]);
            tuple
        });
        let file = Vti::new([0.5, -1.0], [0.1, 0.25], [2, 2])
            .field::<2>("velocity", Shape::Velocity, rows.into_iter())
            .bytes();
        let text = String::from_utf8_lossy(&file);
        let head =
            "<ImageData WholeExtent=\"0 1 0 1 0 0\" Origin=\"0.5 -1 0\" Spacing=\"0.1 0.25 1\">";
        assert!(text.contains(head), "{text}");
        assert!(
            text.contains("Name=\"velocity\" NumberOfComponents=\"3\""),
            "{text}"
        );
        let end = b"\n</AppendedData>\n</VTKFile>\n";
        // Four vectors of three numbers, the last of which is (4, -4, 0).
        let last = &file[file.len() - end.len() - 24..file.len() - end.len()];
        let numbers: Vec<_> = last
            .as_chunks::<8>()
            .0
            .iter()
            .map(|b| f64::from_le_bytes(*b))
            .collect();
        assert_eq!(numbers, [4.0, -4.0, 0.0]);
    }

    #[test]
    fn arrays_of_another_length_are_refused() {
        let wrong = Vti::new([0.0], [1.0], [3]).scalar("filling", [1.0]);
        let error = wrong.write("never.vti").unwrap_err().to_string();
        assert!(
            error.contains("`filling` has 1 values for 3 points"),
            "{error}"
        );
    }
}
