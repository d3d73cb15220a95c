//! Union, intersection and complement of shapes.
//! min(a, b), max(a, b) and −a of their distances.

use super::Shape;

/// What is in one shape or in the other, by [`Shape::union`]: d = min(a, b).
///
/// Exact outside, where both are; inside at most the depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Union<A, B> {
    first: A,
    second: B,
}

impl<A, B> Union<A, B> {
    pub(super) fn new(first: A, second: B) -> Self {
        Self { first, second }
    }
}

impl<const D: usize, A: Shape<D>, B: Shape<D>> Shape<D> for Union<A, B> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        let (a, b) = (
            self.first.signed_distance(x),
            self.second.signed_distance(x),
        );
        a.min(b)
    }
    fn inside_row(&self, row: &[[f64; D]], inside: &mut [bool]) {
        let mut second = vec![false; row.len()];
        self.first.inside_row(row, inside);
        self.second.inside_row(row, &mut second);
        for (inside, second) in inside.iter_mut().zip(second) {
            *inside |= second;
        }
    }
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        let (a, b) = (self.first.bounds(), self.second.bounds());
        (
            core::array::from_fn(|d| a.0[d].min(b.0[d])),
            core::array::from_fn(|d| a.1[d].max(b.1[d])),
        )
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        [self.first.problems(), self.second.problems()].concat()
    }
}

/// What is in one shape and in the other, by [`Shape::intersection`]: d = max(a, b).
///
/// Exact inside, where both are; outside at most the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intersection<A, B> {
    first: A,
    second: B,
}

impl<A, B> Intersection<A, B> {
    pub(super) fn new(first: A, second: B) -> Self {
        Self { first, second }
    }
}

impl<const D: usize, A: Shape<D>, B: Shape<D>> Shape<D> for Intersection<A, B> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        let (a, b) = (
            self.first.signed_distance(x),
            self.second.signed_distance(x),
        );
        a.max(b)
    }
    fn inside_row(&self, row: &[[f64; D]], inside: &mut [bool]) {
        let mut second = vec![false; row.len()];
        self.first.inside_row(row, inside);
        self.second.inside_row(row, &mut second);
        for (inside, second) in inside.iter_mut().zip(second) {
            *inside &= second;
        }
    }
    /// The low corner is above the high one where the shapes are apart.
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        let (a, b) = (self.first.bounds(), self.second.bounds());
        (
            core::array::from_fn(|d| a.0[d].max(b.0[d])),
            core::array::from_fn(|d| a.1[d].min(b.1[d])),
        )
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        [self.first.problems(), self.second.problems()].concat()
    }
}

/// All that is not in a shape, by [`Shape::complement`]: d = −a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complement<S> {
    shape: S,
}

impl<S> Complement<S> {
    pub(super) fn new(shape: S) -> Self {
        Self { shape }
    }
}

impl<const D: usize, S: Shape<D>> Shape<D> for Complement<S> {
    fn signed_distance(&self, x: &[f64; D]) -> f64 {
        -self.shape.signed_distance(x)
    }
    fn inside_row(&self, row: &[[f64; D]], inside: &mut [bool]) {
        self.shape.inside_row(row, inside);
        for inside in inside {
            *inside = !*inside;
        }
    }
    fn bounds(&self) -> ([f64; D], [f64; D]) {
        ([f64::NEG_INFINITY; D], [f64::INFINITY; D])
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        self.shape.problems()
    }
}
