//! Watching a simulation: pressure probes, wave gauges, flow through planes, any field at any points.
//! An observer reads and never writes, so a run with it is the run without it.
//!
//! | observer | reads |
//! |---|---|
//! | [`PressureProbe`] | pressure averaged over a disc on a wall, moving with it, and the force on that disc |
//! | [`WaveGauge`] | height of a free surface along a line, and the length of it that liquid wets |
//! | [`FlowPlane`] | mass beyond a plane, and its rate |
//! | [`Simulation::sample`](crate::simulation::Simulation::sample) | any field, the crate's or an effect's, at any points or on a [`SampleGrid`] |
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

pub use gauge::WaveGauge;
pub use grid::SampleGrid;
pub use plane::FlowPlane;
pub use probe::PressureProbe;
pub use sample::Sample;

/// The weight with which observers average, (1 − q/2)⁴ (1 + 2 q) for q < 2 (Wendland 1995).
fn weight(q: f64) -> f64 {
    if q < 2.0 {
        (1.0 - 0.5 * q).powi(4) * (1.0 + 2.0 * q)
    } else {
        0.0
    }
}

/// One over the integral of [`weight`] in `d` dimensions at h = 1.
fn normalisation(d: usize) -> f64 {
    match d {
        1 => 0.75,
        2 => 7.0 / (4.0 * core::f64::consts::PI),
        _ => 21.0 / (16.0 * core::f64::consts::PI),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_integrate_to_one() {
        for d in 1..=3 {
            let shell = |q: f64| match d {
                1 => 2.0,
                2 => core::f64::consts::TAU * q,
                _ => 2.0 * core::f64::consts::TAU * q * q,
            };
            let n = 2000;
            let step = 2.0 / f64::from(n);
            let sum: f64 = (0..n)
                .map(|k| (f64::from(k) + 0.5) * step)
                .map(|q| weight(q) * shell(q) * step)
                .sum();
            assert!((sum * normalisation(d) - 1.0).abs() < 1e-6);
        }
    }
}
