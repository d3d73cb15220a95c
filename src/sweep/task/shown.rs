//! What a particle shows the other side of a contact that may open: no tension.
//! Which fields of a record carry it is known when a sweep is compiled.

use super::Composed;
use crate::particles::{Fields, Shape};
use crate::scalar::{Lane, Real};
use crate::tensor::Symmetric;
use crate::term::{Layout, MOST_READS, Terms};

/// What a particle shows the other side of a contact that may open, for the fields of a record that carry
/// tension ([`Term::TENSILE`](crate::term::Term::TENSILE)); all others are shown as they are.
#[derive(Clone, Copy)]
enum Compression {
    /// A pressure, where it is positive.
    Positive(usize),
    /// A stress, less what pulls.
    Tensor(usize),
    /// Nothing: a gradient of pressure has no meaning across a gap.
    Nothing(usize),
}

/// The fields of a record that a contact hides the tension of; a list, so that the loop sees only those.
pub(in crate::sweep) struct Shown {
    fields: [Compression; MOST_READS],
    count: usize,
}

impl Shown {
    const fn new(reads: Fields, tensile: Fields, d: usize) -> Self {
        let mut shown = Self {
            fields: [Compression::Nothing(0); MOST_READS],
            count: 0,
        };
        let mut place = 0;
        while let Some((field, next)) = reads.from(place) {
            if tensile.contains(field) {
                let at = reads.offset(field, d);
                let mut k = 0;
                while k < field.components(d) {
                    shown.fields[shown.count] = match field.shape() {
                        Shape::Scalar => Compression::Positive(at),
                        Shape::Tensor => Compression::Tensor(at),
                        _ => Compression::Nothing(at + k),
                    };
                    shown.count += 1;
                    // A tensor is one, all others go component by component.
                    k += if matches!(field.shape(), Shape::Tensor) {
                        6
                    } else {
                        1
                    };
                }
            }
            place = next;
        }
        shown
    }

    #[inline(always)]
    pub fn across<T: Real, P: Terms<D>, const D: usize, const HOW: u8, L: Lane>(record: &mut [L]) {
        let shown = const { &Self::new(Composed::<T, P, D, HOW>::READS, P::TENSILE, D) };
        if shown.count > 0 {
            shown.hide(record);
        }
    }

    /// Hides the tension of a record. Never inlined: contacts are few, and it is long.
    #[inline(never)]
    fn hide<L: Lane>(&self, record: &mut [L]) {
        for field in &self.fields[..self.count] {
            match *field {
                Compression::Positive(at) => record[at] = record[at].positive_part(),
                Compression::Tensor(at) => compress(&mut record[at..at + 6]),
                Compression::Nothing(at) => record[at] = L::zero(),
            }
        }
    }
}

/// Leaves of a stress what presses.
fn compress<L: Lane>(stress: &mut [L]) {
    let mut components = [L::zero(); 6];
    components.copy_from_slice(stress);
    let part = Symmetric::new(components).compressive_part();
    stress.copy_from_slice(part.components());
}
