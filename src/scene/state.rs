//! A state as a table: places of particles and numbers at each, read from files and from simulations.
//! VTK files of the crate and tables of comma-separated values, back to the bits that were written.

#[cfg(feature = "checkpoint")]
mod saved;

use crate::error::{Error, Result};
use crate::output::csv::{Csv, CsvWriter};
use crate::particles::{Field, Shape};
use crate::scalar::Real;
use crate::simulation::Simulation;
use std::fs;
use std::io;
use std::path::Path;

/// Numbers of every particle under a name.
#[derive(Clone, Debug, PartialEq)]
struct Quantity {
    name: String,
    components: usize,
    values: Vec<f64>,
}

/// Particles of another run: their places \[m\], and what is known at each by the names that
/// [`Simulation::vtu`](crate::simulation::Simulation::vtu) gives: `velocity`, `density`, `energy`, `mass`, `body` and fields of effects.
///
/// It comes from a VTK file of the crate, from a table, from a checkpoint of another scene (with the feature `checkpoint`), or from a simulation:
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::scene::ParticleState;
/// let water = || catalogue::weakly_compressible_water(2.0);
/// let coarse = Scene::<f64, 2>::new(schemes::weakly_compressible())
///     .body(Body::block("water", water(), [0.0; 2], [0.4, 0.2], 0.02).start(|[x, _], own| {
///         meshfree::scene::Start { velocity: [1.0 + x, 0.0], ..own }
///     }))
///     .build()?;
/// let state = ParticleState::of(&coarse);
/// // The same particles, and a body of half the spacing that starts from them.
/// let same: Body<f64, 2> = Body::of_state("water", water(), &state, 0.02)?;
/// let fine = Body::block("water", water(), [0.0; 2], [0.4, 0.2], 0.01).started_from(&state)?;
/// assert_eq!(same.points(), state.points());
/// let run = Scene::<f64, 2>::new(schemes::weakly_compressible()).body(fine).build()?;
/// assert!(run.all().all(|own| (own.velocity()[0] - 1.0 - own.position()[0]).abs() < 1e-12));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParticleState<const D: usize> {
    points: Vec<[f64; D]>,
    quantities: Vec<Quantity>,
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl<const D: usize> ParticleState<D> {
    /// All particles of bodies of a simulation as they are now.
    #[must_use]
    pub fn of<T: Real>(simulation: &Simulation<T, D>) -> Self {
        // What the crate writes it reads.
        Self::of_vtu(&simulation.vtu().bytes()).unwrap_or_default()
    }

    /// Reads a file that [`Vtu::write`](crate::output::vtu::Vtu::write) has written.
    ///
    /// # Errors
    /// When the file cannot be read, or is of another kind: with compressed, encoded or other arrays.
    pub fn read_vtu(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let state = fs::read(path).and_then(|bytes| Self::of_vtu(&bytes));
        state.map_err(|cause| file_error("read", path, cause))
    }

    /// Reads a table with the columns `x`, `y` and `z`, as many as there are dimensions, and others of numbers. Columns `name_1`, `name_2`
    /// and so on are components of `name`.
    ///
    /// # Errors
    /// When the file cannot be read, lacks a coordinate, or has a cell in one of these columns that is no number.
    pub fn read_csv(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let table = Csv::read(path)?;
        Self::of_table(&table).map_err(|cause| file_error("read", path, cause))
    }

    /// Writes such a table.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        let mut header: Vec<String> = AXES[..D].iter().map(ToString::to_string).collect();
        for own in &self.quantities {
            if own.components == 1 {
                header.push(own.name.clone());
            } else {
                header.extend((1..=own.components).map(|k| format!("{}_{k}", own.name)));
            }
        }
        let mut table = CsvWriter::create(path, &header)?;
        table.rows(self.points.iter().enumerate().map(|(n, x)| {
            let mut row = x.to_vec();
            for own in &self.quantities {
                row.extend(&own.values[n * own.components..(n + 1) * own.components]);
            }
            row
        }))
    }

    /// The particles for which a quantity of one component has a value, as `body` of a file with several bodies.
    #[must_use]
    pub fn only(&self, name: &str, value: f64) -> Self {
        let kept: Vec<usize> = match self.quantity(name) {
            Some(own) if own.components == 1 => (0..self.len())
                .filter(|&n| own.values[n] == value)
                .collect(),
            _ => Vec::new(),
        };
        let of = |own: &Quantity| {
            let width = own.components;
            let rows = kept.iter().map(|n| &own.values[n * width..(n + 1) * width]);
            Quantity {
                values: rows.flatten().copied().collect(),
                ..own.clone()
            }
        };
        Self {
            points: kept.iter().map(|&n| self.points[n]).collect(),
            quantities: self.quantities.iter().map(of).collect(),
        }
    }

    /// Where particles are \[m\].
    #[must_use]
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// How many particles there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The names of what is known at each particle.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.quantities.iter().map(|own| &*own.name)
    }

    /// The numbers of a quantity, particle by particle; none if there is none of that name.
    #[must_use]
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        Some(&self.quantity(name)?.values)
    }

    fn quantity(&self, name: &str) -> Option<&Quantity> {
        self.quantities.iter().find(|own| own.name == name)
    }

    /// The numbers of a field by its name, in the order and number that bodies start with; none if they are not there.
    pub(super) fn field(&self, field: Field) -> Option<Vec<f64>> {
        let own = self
            .quantity(field.name())
            .or_else(|| self.quantity(field.full_name()))?;
        let width = field.components(D);
        let places: Vec<usize> = match field.shape() {
            Shape::Scalar => vec![0],
            // VTK has xx, yy, zz, xy, yz, xz.
            Shape::Tensor => vec![0, 1, 2, 4, 5, 3],
            Shape::Matrix if own.components == 9 => (0..D * D).map(|k| k / D * 3 + k % D).collect(),
            _ => (0..width).collect(),
        };
        if places.iter().any(|&k| k >= own.components) {
            return None;
        }
        let rows = own.values.chunks_exact(own.components);
        let numbers = rows.flat_map(|row| places.iter().map(|&k| row[k]));
        Some(numbers.collect())
    }

    fn of_vtu(bytes: &[u8]) -> io::Result<Self> {
        const DATA: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
        let starts = bytes.windows(DATA.len()).position(|own| own == DATA);
        let start = starts
            .ok_or_else(|| wrong("it has no appended raw data, as files of this crate do"))?;
        let data = &bytes[start + DATA.len()..];
        let xml = std::str::from_utf8(&bytes[..start]).map_err(|_| wrong("its head is no text"))?;
        if !xml.contains("type=\"UnstructuredGrid\"") || !xml.contains("header_type=\"UInt64\"") {
            return Err(wrong("it is no unstructured grid of this crate"));
        }
        let count = attribute(xml, "NumberOfPoints")?;
        let (mut points, mut quantities) = (Vec::new(), Vec::new());
        let [_, of_points] = xml
            .split_once("<PointData>")
            .map(|(a, b)| [a, b])
            .ok_or_else(|| wrong("it has no PointData"))?;
        let of_points = of_points.split("<Cells>").next().unwrap_or_default();
        for tag in of_points.split("<DataArray ").skip(1) {
            let tag = tag.split('>').next().unwrap_or_default();
            let components = attribute(tag, "NumberOfComponents")?;
            let values = numbers(data, attribute(tag, "offset")?, text(tag, "type")?)?;
            if components == 0 || Some(values.len()) != count.checked_mul(components) {
                return Err(wrong("an array is shorter than it states"));
            }
            let name = unescaped(text(tag, "Name")?);
            if name == "Points" {
                points = values
                    .chunks_exact(components)
                    .map(|x| core::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0)))
                    .collect();
            } else {
                quantities.push(Quantity {
                    name,
                    components,
                    values,
                });
            }
        }
        if points.len() != count {
            return Err(wrong("it has no positions of particles"));
        }
        Ok(Self { points, quantities })
    }

    fn of_table(table: &Csv) -> io::Result<Self> {
        let column = |name: &str| {
            let found = table.column(name);
            found.ok_or_else(|| {
                wrong(&format!(
                    "the column `{name}` is missing, or a cell is no number"
                ))
            })
        };
        let axes = AXES[..D].iter().map(|name| column(name));
        let axes: Vec<Vec<f64>> = axes.collect::<io::Result<_>>()?;
        let count = table.rows.len();
        let points = (0..count).map(|n| core::array::from_fn(|d| axes[d][n]));
        let mut quantities: Vec<Quantity> = Vec::new();
        let others = table.header.iter();
        for name in others.filter(|name| !AXES[..D].contains(&name.as_str())) {
            // Columns of text are not of a state.
            let Some(values) = table.column(name) else {
                continue;
            };
            let component = name
                .rsplit_once('_')
                .and_then(|(stem, k)| Some((stem, k.parse::<usize>().ok()?)));
            match (component, quantities.last_mut()) {
                (Some((stem, k)), Some(last))
                    if k > 1 && last.name == stem && last.components + 1 == k =>
                {
                    let rows = last.values.chunks_exact(last.components).zip(&values);
                    last.values = rows
                        .flat_map(|(row, next)| {
                            row.iter().chain([next]).copied().collect::<Vec<_>>()
                        })
                        .collect();
                    last.components = k;
                }
                (Some((stem, 1)), _) => quantities.push(Quantity {
                    name: stem.into(),
                    components: 1,
                    values,
                }),
                _ => quantities.push(Quantity {
                    name: name.clone(),
                    components: 1,
                    values,
                }),
            }
        }
        Ok(Self {
            points: points.collect(),
            quantities,
        })
    }
}

impl<const D: usize> Default for ParticleState<D> {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            quantities: Vec::new(),
        }
    }
}

fn wrong(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what)
}

fn file_error(action: &'static str, path: &Path, cause: io::Error) -> Error {
    let path = path.to_path_buf();
    Error::File {
        action,
        path,
        cause,
    }
}

/// The text of an attribute of a tag.
fn text<'a>(tag: &'a str, name: &str) -> io::Result<&'a str> {
    let start = tag.split_once(&format!("{name}=\""));
    let own = start.and_then(|(_, rest)| rest.split('"').next());
    own.ok_or_else(|| wrong(&format!("it lacks the attribute {name}")))
}

/// A whole number among the attributes of a tag.
fn attribute(tag: &str, name: &str) -> io::Result<usize> {
    let own = text(tag, name)?.parse();
    own.map_err(|_| wrong(&format!("the attribute {name} is no whole number")))
}

/// What stands in XML for signs of its own.
fn unescaped(text: &str) -> String {
    let pairs = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&amp;", "&"),
    ];
    let whole = |text: String, (from, to): (&str, &str)| text.replace(from, to);
    pairs.into_iter().fold(text.to_string(), whole)
}

/// The numbers of an array that starts at an offset of the data.
fn numbers(data: &[u8], offset: usize, kind: &str) -> io::Result<Vec<f64>> {
    let short = || wrong("it ends before its data");
    let head = data.get(offset..).and_then(|rest| rest.first_chunk());
    let length = u64::from_le_bytes(*head.ok_or_else(short)?);
    let start = offset + 8;
    let end = usize::try_from(length)
        .ok()
        .and_then(|length| start.checked_add(length));
    let own = end.and_then(|end| data.get(start..end)).ok_or_else(short)?;
    macro_rules! as_numbers {
        ($($name:literal $kind:ty),*) => {
            match kind {
                $($name => own
                    .chunks_exact(size_of::<$kind>())
                    .filter_map(|bytes| Some(<$kind>::from_le_bytes(bytes.try_into().ok()?) as f64))
                    .collect(),)*
                _ => return Err(wrong("it has an array of a type that this crate does not write")),
            }
        };
    }
    Ok(
        as_numbers!("Float64" f64, "Float32" f32, "Int32" i32, "UInt32" u32, "Int64" i64, "UInt8" u8),
    )
}
