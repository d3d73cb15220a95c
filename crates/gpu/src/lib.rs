//! Schemes of [meshfree](::meshfree) on a GPU, from the one text in which their parts are written.
//!
//! A part in the arithmetic of lanes is [recorded](meshfree::scalar::Record), and [`emit`](emit()) writes the record in the language of a
//! device. [`Device`] runs such text by Vulkan: [`PointKernel`] for what happens to single particles, [`PairKernel`] for sums over
//! neighbours. What cannot run there is an [`Error`] that names it; nothing falls back to the host.
//!
//! ```
//! use meshfree::scalar::Record;
//! use meshfree_gpu::{Device, PointKernel, Precision};
//! let record = Record::of(2, |given| vec![given[0] * given[1]])?;
//! // Without a driver there is nothing to run it on.
//! let Ok(device) = Device::open() else { return Ok(()) };
//! let product = PointKernel::new(&device, "product", &record, Precision::Single)?;
//! assert_eq!(product.run(&device, &[&[2.0, 3.0], &[5.0, 7.0]])?, [vec![10.0, 21.0]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod device;
mod dialect;
mod elementary;
mod emit;
mod error;
mod kernel;
mod pairs;
mod points;
mod resident;

pub use device::{Adapter, Device};
pub use dialect::{Dialect, Language, Precision};
pub use emit::{Text, emit};
pub use error::{Error, Part};
pub use pairs::{PairKernel, PairLists, Shared};
pub use points::PointKernel;
pub use resident::{Given, Launch, Resident};
