//! Watching a simulation: pressure probes, wave gauges, flow through planes, any field at any points.
//! An observer reads and never writes, so a run with it is the run without it.
//!
//! | observer | reads |
//! |---|---|
//! | [`PressureProbe`] | pressure averaged over a disc on a wall, moving with it, and the force on that disc |
//! | [`WaveGauge`] | height of a free surface along a line, and the length of it that liquid wets |
//! | [`FlowPlane`] | mass beyond a plane, and its rate |
//! | [`Simulation::sample`](crate::simulation::Simulation::sample) | any field, the crate's or an effect's, at any points or on a [`SampleGrid`] |
//! | [`SurfaceMesh`] | the surface of a body as triangles, for rendering |
//!
//! Forces and impulses on whole walls are [`Simulation::wall_force`](crate::simulation::Simulation::wall_force)
//! and [`wall_impulse`](crate::simulation::Simulation::wall_impulse); energy is in the
//! [ledger](crate::simulation::Simulation::energy).
//!
//! ```
//! use meshfree::observe::{PressureProbe, WaveGauge};
//! use meshfree::prelude::*;
//! let depth = 0.2;
//! let water = catalogue::weakly_compressible_water(2.0);
//! let body = Body::block("water", water, [0.0; 2], [0.3, depth], 0.02);
//! let mut simulation = Scene::<f64, 2>::new(schemes::weakly_compressible())
//!     .body(body.hydrostatic([0.0, -9.81], [0.0, depth]))
//!     .wall(Wall::around("tank", [0.0; 2], [0.3, 0.3], 0.02, 3, [[true, true], [true, false]]))
//!     .acceleration(|_| [0.0, -9.81])
//!     .build()?;
//! let probe = PressureProbe::disc(&simulation, "bottom", [0.15, 0.0], [0.0, 1.0], 0.02)?;
//! let gauge = WaveGauge::upwards(&simulation, "middle", [0.15, 0.0], 1)?;
//! simulation.run_until(0.3)?;
//! let expected = 1000.0 * 9.81 * depth;
//! assert!((probe.pressure(&simulation) / expected - 1.0).abs() < 0.1);
//! assert!((gauge.height(&simulation) - depth).abs() < 0.01);
//! # Ok::<(), Error>(())
//! ```
//!
//! # Places
//!
//! A probe or gauge is put into a simulation, which refuses one that would read nothing because it is
//! outside of the scene: farther than the kernel reaches from the box around its bodies and walls as
//! built. Where walls alone do not bound a scene, because it has none or has other boundaries or inlets
//! too, liquid can come anywhere, and every place is accepted.
//!
//! # Planes and periods
//!
//! Probes, gauges and samples see the particles and their images behind planes and across periods, so that they read by
//! them what they would read in the whole of a symmetric or repeated scene. A sample behind a plane sees none of its images.

mod gauge;
mod grid;
mod place;
mod plane;
mod probe;
mod sample;
mod surface_mesh;

pub use gauge::WaveGauge;
pub use grid::SampleGrid;
pub use plane::FlowPlane;
pub use probe::PressureProbe;
pub use sample::Sample;
pub use surface_mesh::SurfaceMesh;

use crate::kernel::{Kernel, WendlandC2};

/// The weight with which observers average at q = r/h: Wendland's C2, which is a polynomial of its own in 1D.
fn weight<const D: usize>(q: f64) -> f64 {
    match D {
        1 => Kernel::<1>::shape(&WendlandC2, q),
        _ => Kernel::<2>::shape(&WendlandC2, q),
    }
}

/// One over the integral of [`weight`] at h = 1.
fn normalisation<const D: usize>() -> f64 {
    match D {
        1 => Kernel::<1>::normalisation(&WendlandC2),
        2 => Kernel::<2>::normalisation(&WendlandC2),
        _ => Kernel::<3>::normalisation(&WendlandC2),
    }
}
