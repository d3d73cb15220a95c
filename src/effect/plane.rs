//! A layer behind a plane that an effect names by a place and a normal, whatever the dimension of the scene.
//! How far particles are beyond it is lane text.

use crate::scalar::Lane;

/// A plane through a place \[m\] with a normal of any length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    place: [f64; 3],
    normal: [f64; 3],
    /// Length of the normal as given.
    length: f64,
    dimensions: usize,
}

/// Coordinates, and zero beyond them.
pub(super) fn padded<const D: usize>(x: [f64; D]) -> [f64; 3] {
    core::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0))
}

/// A layer of some thickness \[m\] behind a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layer {
    plane: Plane,
    pub thickness: f64,
}

impl Layer {
    pub fn new<const D: usize>(place: [f64; D], normal: [f64; D], thickness: f64) -> Self {
        let plane = Plane::new(place, normal);
        Self { plane, thickness }
    }

    /// min(max(d/L, 0), 1)² of the distance d beyond the plane and the thickness L.
    #[inline(always)]
    pub fn ramp<L: Lane, const D: usize>(&self, x: &[L; D], origin: &[f64; D]) -> L {
        let share = self.plane.beyond(x, origin) * L::of(1.0 / self.thickness);
        let share = share.positive_part().min(L::one());
        share * share
    }

    /// What is wrong with it in a scene of `dimensions`; errors call its thickness `what`.
    pub fn problems(
        &self,
        dimensions: usize,
        what: &'static str,
    ) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems: Vec<_> = self.plane.problem(dimensions).into_iter().collect();
        if !(self.thickness.is_finite() && self.thickness > 0.0) {
            let must_be = "it must be finite and positive, in metres";
            problems.push((what, self.thickness, must_be));
        }
        problems
    }
}

impl Plane {
    pub fn new<const D: usize>(place: [f64; D], normal: [f64; D]) -> Self {
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        Self {
            place: padded(place),
            normal: padded(normal.map(|n| n / length)),
            length,
            dimensions: D,
        }
    }

    /// How far \[m\] a place, which counts from an origin, is beyond the plane.
    #[inline(always)]
    pub fn beyond<L: Lane, const D: usize>(&self, x: &[L; D], origin: &[f64; D]) -> L {
        let mut beyond = L::zero();
        for d in 0..D {
            let out = x[d] - L::of(self.place[d] - origin[d]);
            beyond = out.mul_add(L::of(self.normal[d]), beyond);
        }
        beyond
    }

    /// What is wrong with it in a scene of `dimensions`, if anything.
    pub fn problem(&self, dimensions: usize) -> Option<(&'static str, f64, &'static str)> {
        let places = self.place.iter().copied();
        if self.dimensions != dimensions {
            return Some((
                "number of coordinates of the plane of an effect",
                self.dimensions as f64,
                "it must be that of the scene's dimensions",
            ));
        }
        if let Some(bad) = places.into_iter().find(|x| !x.is_finite()) {
            let what = "place of the plane of an effect";
            return Some((what, bad, "it must be finite, in metres"));
        }
        (!(self.length.is_finite() && self.length > 0.0)).then_some((
            "length of the normal of the plane of an effect",
            self.length,
            "it must be finite and not zero: any length will do",
        ))
    }
}
