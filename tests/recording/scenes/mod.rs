//! The scenes of the recording, and what several of them are made of.
//! Each is one short function, so a change of the interface is made in few places.

mod liquids;
mod openings;
mod solids;

use super::{Plan, Scenes};

/// All scenes.
pub fn all() -> Scenes {
    let mut scenes = Scenes::default();
    solids::add(&mut scenes);
    liquids::add(&mut scenes);
    openings::add(&mut scenes);
    scenes
}

/// A flow without pattern: numbers between −1 and 1 that products and remainders alone make of a place, so
/// that no function of the platform is in them.
fn noise<const D: usize>(x: [f64; D]) -> [f64; D] {
    core::array::from_fn(|d| {
        let sum: f64 = (0..D).map(|k| x[k] * (391.25 + 87.5 * k as f64)).sum();
        let y = 2.0 * (sum + 0.375 * d as f64).rem_euclid(1.0) - 1.0;
        4.0 * y * (1.0 - y.abs())
    })
}
