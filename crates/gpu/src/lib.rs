//! Schemes and scenes of [meshfree] on a GPU, from the one text in which their parts are written.
//!
//! [`Device::load`] takes a simulation and gives a [`Run`], which steps on the device. Liquids, solids and gases do; what a scene has
//! that does not run there is an [`Error`] that names it, and nothing falls back to the host.
//!
//! ```no_run
//! use meshfree::prelude::*;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let water = catalogue::weakly_compressible_water(2.0);
//! let tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
//!     .body(Body::block("water", water, [0.0; 2], [0.3, 0.2], 0.02))
//!     .wall(Wall::around("tank", [0.0; 2], [0.6, 0.6], 0.02, 3, [[true, true], [true, false]]))
//!     .acceleration(|_| [0.0, -9.81]);
//! let mut run = meshfree_gpu::Device::open()?.load(tank.build()?)?;
//! run.run_until(0.5)?;
//! let simulation = run.into_simulation()?;
//! # Ok(())
//! # }
//! ```
//!
//! A part in the arithmetic of lanes is [recorded](meshfree::scalar::Record), and [`emit`](emit()) writes the record in the language of a
//! device. [`Device`] runs such text by Vulkan: [`PointKernel`] for what happens to single particles, [`PairKernel`] for sums over
//! neighbours. The feature `cuda` adds cards of NVIDIA by their own driver, on which it has not run yet.
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

mod cells;
mod compile;
mod compiled;
mod contact;
mod device;
mod dialect;
mod elementary;
mod emit;
mod error;
mod follow;
mod fuse;
mod kernel;
mod lists;
#[cfg(feature = "cuda")]
pub mod nvrtc;
mod pairs;
mod points;
mod reduce;
mod rounding;
mod run;
mod sort;
mod split;
mod stepping;
mod transfer;

pub use device::{Adapter, Device, Traffic};
pub use dialect::{Dialect, Language, Precision};
pub use emit::{Text, emit};
pub use error::{Error, Part};
pub use pairs::{PairKernel, PairLists, Shared};
pub use points::PointKernel;
pub use run::{Run, sources};
