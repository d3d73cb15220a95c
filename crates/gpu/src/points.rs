//! What happens to single particles, from a record: laws, rates, limits, equations of state.
//! Each thread follows the record for one particle.

use crate::device::Kernel;
use crate::kernel::{Array, Frame, THREADS, pack, unpack};
use crate::{Device, Dialect, Error, Precision, emit};
use meshfree::scalar::Record;

const BUFFERS: [Array; 2] = [Array::numbers("given"), Array::numbers("results").written()];

/// A record over single particles, compiled for a device.
#[derive(Debug)]
pub struct PointKernel {
    kernel: Kernel,
    inputs: usize,
    results: usize,
    precision: Precision,
}

/// How many numbers a record is given, as far as it looks.
pub(crate) fn inputs(record: &Record) -> usize {
    let all = record.operations().iter().map(|own| match own {
        meshfree::scalar::Operation::Input(k) => k + 1,
        _ => 0,
    });
    all.max().unwrap_or(0)
}

fn body(record: &Record, dialect: Dialect) -> String {
    let text = emit(record, dialect, &|k| {
        (format!("given[{k}u * scene.count + i]"), false)
    });
    let results = text.results.iter().enumerate();
    let stores = results.map(|(k, value)| format!("results[{k}u * scene.count + i] = {value};\n"));
    text.before + &stores.collect::<String>()
}

impl PointKernel {
    /// Compiles a record.
    ///
    /// # Errors
    ///
    /// [`Error::NoDouble`] if the adapter has no `f64`, [`Error::Kernel`] if its driver does not take the text.
    pub fn new(
        device: &Device,
        name: &str,
        record: &Record,
        precision: Precision,
    ) -> Result<Self, Error> {
        let dialect = device.dialect(precision);
        let body = body(record, dialect);
        Ok(Self {
            kernel: device.kernel(("record", name), (dialect, &BUFFERS), &body)?,
            inputs: inputs(record),
            results: record.results().len(),
            precision,
        })
    }

    /// The text of the kernel in a language.
    #[must_use]
    pub fn source(record: &Record, dialect: Dialect) -> String {
        let frame = Frame {
            dialect,
            name: "points",
            buffers: &BUFFERS,
        };
        frame.source(&body(record, dialect), THREADS)
    }

    /// What the record makes of columns of numbers, column by column.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if there are fewer columns than the record reads, or columns of different lengths; [`Error::TooLarge`] and
    /// [`Error::OutOfMemory`] if they do not fit; [`Error::Lost`] if the device fails, [`Error::OtherDevice`] for one of another device.
    pub fn run(&self, device: &Device, given: &[&[f64]]) -> Result<Vec<Vec<f64>>, Error> {
        device.owns(&self.kernel)?;
        let (there, wanted) = (given.len(), self.inputs);
        Error::unless(there >= wanted, "columns of numbers", [there, wanted])?;
        let count = given.first().map_or(0, |column| column.len());
        for own in given.iter().map(|column| column.len()) {
            Error::unless(own == count, "numbers of a column", [own, count])?;
        }
        let all = given.iter().flat_map(|column| column.iter().copied());
        let columns = device.upload("what the particles have", &pack(all, self.precision))?;
        let bytes = self.results * count * self.precision.bytes();
        let results = device.room("the results", bytes)?;
        device.launch([&device.bind(&self.kernel, &[&columns, &results], count)]);
        let found = unpack(&device.download(&results, 0, bytes)?, self.precision);
        Ok(found.chunks(count.max(1)).map(<[f64]>::to_vec).collect())
    }
}
