//! Functions of numbers whose type is erased, which any lane can call: laws that a material holds.
//! A trait object has no generic methods, so it has one for each kind of lane, and a call finds its own.

use super::{Lane, OnOwnRows, Real, Traced, on_wide_registers};
use core::any::Any;

/// A function of `N` numbers in the arithmetic of lanes.
pub(crate) trait OfLanes<const N: usize> {
    fn of<L: Lane>(&self, given: [L; N]) -> L;
}

type Row = <f64 as Real>::Wide<false>;
type SingleRow = <f32 as Real>::Wide<false>;

/// The same without its type: what an object of a law has for every kind of lane.
pub trait Function<const N: usize> {
    /// Of a row of `f64`.
    fn of_row(&self, given: &[Row; N]) -> Row;
    /// Of a row of `f32`.
    fn of_single_row(&self, given: &[SingleRow; N]) -> SingleRow;
    /// Of single numbers.
    fn of_one(&self, given: &[f64; N]) -> f64;
    /// Of numbers of a record.
    fn of_traced(&self, given: &[Traced; N]) -> Traced;
}

/// A call of a function.
struct Call<'a, F, L, const N: usize>(&'a F, &'a [L; N]);

impl<F: OfLanes<N>, L: Lane, const N: usize> OnOwnRows for Call<'_, F, L, N> {
    type Output = L;
    #[inline(always)]
    fn run(self) -> L {
        self.0.of(*self.1)
    }
}

impl<const N: usize, F: OfLanes<N>> Function<N> for F {
    fn of_row(&self, given: &[Row; N]) -> Row {
        on_wide_registers(Call(self, given))
    }
    fn of_single_row(&self, given: &[SingleRow; N]) -> SingleRow {
        on_wide_registers(Call(self, given))
    }
    fn of_one(&self, given: &[f64; N]) -> f64 {
        self.of(*given)
    }
    fn of_traced(&self, given: &[Traced; N]) -> Traced {
        self.of(*given)
    }
}

/// Calls a function whose type is erased. Lanes of another kind than those above are taken element by element, in `f64`.
#[inline(always)]
pub(crate) fn call<L: Lane, const N: usize>(
    function: &(impl Function<N> + ?Sized),
    given: &[L; N],
) -> L {
    // Of one type are decided when the call is compiled.
    let any: &dyn Any = given;
    let back = |own: &dyn Any| *own.downcast_ref::<L>().expect("lanes of one type");
    if let Some(given) = any.downcast_ref() {
        return back(&function.of_row(given));
    }
    if let Some(given) = any.downcast_ref() {
        return back(&function.of_single_row(given));
    }
    if let Some(given) = any.downcast_ref() {
        return back(&function.of_one(given));
    }
    if let Some(given) = any.downcast_ref() {
        return back(&function.of_traced(given));
    }
    let one = |k| function.of_one(&given.map(|own| own.extract(k).to_f64()));
    L::from_fn(|k| Lane::of(one(k)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Lanes, Record};

    struct Quotient;
    impl OfLanes<2> for Quotient {
        fn of<L: Lane>(&self, [a, b]: [L; 2]) -> L {
            L::select(b.gt(L::zero()), a / b, L::of(0.1))
        }
    }

    fn rows<L: Lane>() {
        let given = [L::of(0.3), L::from_fn(|k| Lane::of(k as f64 - 1.0))];
        let own: L = call(&Quotient, &given);
        for k in 0..L::WIDTH {
            let [a, b] = given.map(|x| x.extract(k));
            let expected = if k > 1 { a / b } else { Lane::of(0.1) };
            assert!(own.extract(k) == expected);
        }
    }

    #[test]
    fn every_lane_calls_the_same_function() {
        rows::<f64>();
        rows::<Lanes<f64, 8, false>>();
        rows::<Lanes<f32, 16, false>>();
        let record = Record::of(2, |given| vec![call(&Quotient, &[given[0], given[1]])]);
        let record = record.expect("no branch");
        assert_eq!(record.follow(&[1.0, 4.0]), [0.25]);
        assert_eq!(record.follow(&[1.0_f32, -4.0]), [0.1]);
        // Lanes that have no method of their own.
        let other = Lanes::<f64, 2, false>::from_fn(|k| k as f64 + 1.0);
        assert_eq!(call(&Quotient, &[other, other]).extract(1), 1.0);
    }
}
