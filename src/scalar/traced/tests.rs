//! A record gives the bits of the text that it was made of, on every lane, and refuses what it cannot hold.
//! The one text has every operation of a lane.

use super::*;
use crate::scalar::{Lanes, Real};

/// Every operation that a lane has.
fn everything<L: Lane>(a: L, b: L) -> Vec<L> {
    let either = a.lt(b) | !(a.le(L::zero()) & b.gt(L::of(0.3))) & L::Mask::all_of(true);
    let mut sum = a.mul_add(b, L::one()) / b.fused(b, L::of(0.1));
    sum += a.powi(3) - b.abs().powf(1.3);
    sum -= (-a).exp().min(b.abs().sqrt()).max(L::of(0.1));
    sum += a.sin() * b.cos() + (a * L::of(0.5)).acos() * b.atan() - a.cbrt();
    sum *= b.abs().root() + (b * b + L::of(0.1)).ln();
    sum /= a.recip().positive_part() + L::of(0.7);
    let halved = |[x, n]: [L; 2]| ([x * L::of(0.5), n + L::one()], x.lt(L::of(0.1)));
    let [left, steps] = L::iterate(12, [a.abs(), L::zero()], halved);
    sum += left * steps;
    vec![L::select(either, sum, a), L::select(a.ge(b), b, sum), b]
}

fn same_bits<T: Real, L: Lane<Scalar = T>>() {
    let record = Record::of(2, |given| everything(given[0], given[1])).unwrap();
    for k in 0..40 {
        let noise = |n: f64| {
            L::from_fn(|lane| T::from_f64((1e3 * ((11 * k + lane) as f64 + n).sin()).fract()))
        };
        let given = [noise(0.1), noise(0.2)];
        let expected = everything(given[0], given[1]);
        for (found, expected) in record.follow(&given).iter().zip(expected) {
            for lane in 0..L::WIDTH {
                let (found, expected) = (found.extract(lane), expected.extract(lane));
                assert_eq!(found.to_f64().to_bits(), expected.to_f64().to_bits());
            }
        }
    }
}

#[test]
fn a_record_has_the_bits_of_its_text_on_every_lane() {
    same_bits::<f64, f64>();
    same_bits::<f32, f32>();
    same_bits::<f64, Lanes<f64, 8, false>>();
    same_bits::<f64, Lanes<f64, 8, true>>();
    same_bits::<f32, Lanes<f32, 16, true>>();
}

#[test]
fn what_looks_at_elements_is_refused_by_its_name() {
    let refused = |text: fn(Traced) -> Traced| {
        let record = Record::of(1, |given| vec![text(given[0])]);
        record.unwrap_err().to_string()
    };
    let branch = refused(|x| if x.lt(Traced::one()).any() { x } else { -x });
    assert!(branch.contains("for which a comparison holds"), "{branch}");
    let branch = refused(|x| if x.lt(Traced::one()).test(0) { x } else { -x });
    assert!(branch.starts_with("a branch on a comparison"), "{branch}");
    assert!(refused(|x| x.map(f64::sin)).starts_with("a function of elements"));
    assert!(refused(|x| Traced::splat(x.extract(0))).starts_with("an element of a lane"));
    assert!(refused(|_| Traced::from_fn(|_| 1.0)).starts_with("a lane that is made"));
    assert!(refused(|x| if x.is_zero() { -x } else { x }).starts_with("whether"));
    // A number of a record that was written before.
    let mut kept = None;
    Record::of(1, |given| {
        kept = Some(given[0] * given[0] + given[0]);
        given.to_vec()
    })
    .unwrap();
    let stray = Record::of(1, |given| vec![given[0], kept.unwrap()]).unwrap_err();
    assert_eq!(stray.what, "a number of another record");
}

#[test]
fn a_record_within_a_record_keeps_to_itself() {
    let outer = Record::of(1, |given| {
        let inner = Record::of(1, |given| vec![given[0] + given[0]]).unwrap();
        assert_eq!(inner.follow(&[3.0]), [6.0]);
        vec![given[0] * given[0]]
    });
    assert_eq!(outer.unwrap().follow(&[3.0]), [9.0]);
}
