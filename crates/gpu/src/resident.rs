//! Particles that stay on a device: sweeps and updates one after another, with nothing over the bus.
//! Lists are those that the host gave, which hold until a particle has moved by half of their skin.

use crate::device::Bound;
use crate::kernel::{Array, Frame, unpack};
use crate::{Device, Dialect, Error, PairKernel, PairLists, Part, Shared, emit};
use meshfree::particles::{Field, Output};
use meshfree::scalar::Record;

/// What an update is given of a particle: a component of a field, or of a sum of the sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// Of a field that the sweep reads.
    Field(Field, usize),
    /// Of a sum, as the last sweep has left it.
    Sum(Output, usize),
}

/// A sweep or an update, ready to run.
#[derive(Debug)]
pub struct Launch(Bound);

/// Particles on a device, with the sweep that they are there for.
#[derive(Debug)]
pub struct Resident<'a> {
    device: &'a Device,
    kernel: &'a PairKernel,
    records: wgpu::Buffer,
    rows: wgpu::Buffer,
    sweep: Launch,
    count: usize,
}

const BUFFERS: [Array; 2] = [Array::numbers("records").written(), Array::numbers("rows")];

impl<'a> Resident<'a> {
    /// Takes particles to the device: records, lists and what pairs share, as [`PairKernel::run`] takes them.
    ///
    /// # Errors
    ///
    /// As [`PairKernel::run`].
    pub fn new(
        device: &'a Device,
        kernel: &'a PairKernel,
        (records, count): (&[f64], usize),
        lists: &PairLists,
        shared: &Shared,
    ) -> Result<Self, Error> {
        let (records, rows, sweep) = kernel.bind(device, (records, count), lists, shared)?;
        Ok(Self {
            device,
            kernel,
            records,
            rows,
            sweep: Launch(sweep),
            count,
        })
    }

    /// The sweep.
    #[must_use]
    pub fn sweep(&self) -> &Launch {
        &self.sweep
    }

    fn field(&self, field: Field, k: usize) -> Result<String, Error> {
        let d = self.kernel.dimensions;
        if !self.kernel.reads.contains(field) || k >= field.components(d) {
            return Err(Error::Absent {
                what: "field",
                name: field.name(),
            });
        }
        let at = self.kernel.reads.offset(field, d) + k;
        Ok(format!("records[i * {}u + {at}u]", self.kernel.stride))
    }

    fn sum(&self, sum: Output, k: usize) -> Result<String, Error> {
        let d = self.kernel.dimensions;
        if !self.kernel.writes.contains(sum) || k >= sum.components(d) {
            return Err(Error::Absent {
                what: "sum",
                name: sum.name(),
            });
        }
        let at = self.kernel.writes.offset(sum, d) + k;
        Ok(format!("rows[i * {}u + {at}u]", self.kernel.sums))
    }

    /// What happens to single particles, from a record: its inputs are `given`, its results go to components of fields.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if the record has other inputs or results, [`Error::Absent`] if the sweep does not have a field or sum,
    /// [`Error::Kernel`] if the driver does not take the text.
    pub fn update(
        &self,
        name: &str,
        record: &Record,
        given: &[Given],
        to: &[(Field, usize)],
    ) -> Result<Launch, Error> {
        for (what, found, wanted) in [
            (
                "inputs of an update",
                given.len(),
                crate::points::inputs(record),
            ),
            ("results of an update", to.len(), record.results().len()),
        ] {
            if found != wanted {
                return Err(Error::Size {
                    what,
                    found,
                    wanted,
                });
            }
        }
        let dialect = Dialect::wgsl(self.kernel.precision);
        // All is read before anything is written.
        let mut body = String::new();
        for (k, own) in given.iter().enumerate() {
            let value = match *own {
                Given::Field(field, k) => self.field(field, k)?,
                Given::Sum(sum, k) => self.sum(sum, k)?,
            };
            body += &(dialect.declare(false, &format!("a{k}"), &value) + "\n");
        }
        let text = emit(record, dialect, &|k| (format!("a{k}"), false));
        body += &text.before;
        for (value, &(field, k)) in text.results.iter().zip(to) {
            body += &format!("{} = {value};\n", self.field(field, k)?);
        }
        let part = Part {
            kind: "update",
            name: name.into(),
        };
        let frame = Frame {
            dialect,
            name: "update",
            buffers: &BUFFERS,
        };
        let kernel = self.device.kernel(&part, &frame, &body)?;
        let buffers = [&self.records, &self.rows];
        Ok(Launch(self.device.bind(&kernel, &buffers, self.count)))
    }

    /// Runs sweeps and updates in their order, all of them some times.
    pub fn run(&self, order: &[&Launch], times: usize) {
        let all = (0..times).flat_map(|_| order.iter().map(|own| &own.0));
        self.device.launch(&all.collect::<Vec<_>>());
    }

    /// The records of the particles, after all that was run.
    ///
    /// # Errors
    ///
    /// [`Error::Lost`] if the device fails.
    pub fn records(&self) -> Result<Vec<f64>, Error> {
        let precision = self.kernel.precision;
        let bytes = self.count * self.kernel.stride * precision.bytes();
        Ok(unpack(
            &self.device.download(&self.records, bytes)?,
            precision,
        ))
    }
}
