//! The origin of a scene: the place from which the columns of its particles count.
//! Places are converted where they enter and leave a simulation, and nowhere else.

/// A place \[m\] of the scene, counted from its origin.
pub(crate) fn local<const D: usize>(place: &[f64; D], origin: &[f64; D]) -> [f64; D] {
    core::array::from_fn(|d| place[d] - origin[d])
}

/// A place \[m\] counted from the origin, in the scene.
pub(crate) fn global<const D: usize>(place: &[f64; D], origin: &[f64; D]) -> [f64; D] {
    core::array::from_fn(|d| place[d] + origin[d])
}

/// The middle \[m\] of the box around some places; zero of none.
///
/// Where two sets of places differ by a shift, and all of them are whole numbers of some power of two, so do their
/// middles, to the bit: then the places counted from them are the same.
pub(crate) fn middle<'a, const D: usize>(places: impl Iterator<Item = &'a [f64; D]>) -> [f64; D] {
    let start = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
    let [low, high] = places.fold(start, |[low, high], x| {
        [
            core::array::from_fn(|d| low[d].min(x[d])),
            core::array::from_fn(|d| high[d].max(x[d])),
        ]
    });
    core::array::from_fn(|d| {
        let middle = low[d] + 0.5 * (high[d] - low[d]);
        if middle.is_finite() { middle } else { 0.0 }
    })
}
