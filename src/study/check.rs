//! What tests of exact solutions share: finite differences, and reference data that may be absent.
//! The differences are central and of second order.

use super::records::Record;
use std::path::PathBuf;

/// First derivative of `f` at `x`.
pub fn slope(f: impl Fn(f64) -> f64, x: f64, step: f64) -> f64 {
    (f(x + step) - f(x - step)) / (2.0 * step)
}

/// Second derivative of `f` at `x`.
pub fn curvature(f: impl Fn(f64) -> f64, x: f64, step: f64) -> f64 {
    (f(x + step) - 2.0 * f(x) + f(x - step)) / (step * step)
}

/// The record `name` of the reference data that lie beside the repository; says so where they do not.
pub fn reference(test: &str, name: &str) -> Option<Record> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data"));
    if !folder.is_dir() {
        println!("skipped: {test}, for the reference data are not beside the repository");
        return None;
    }
    Some(Record::read(folder.join(name)).expect("a record of the reference data"))
}
