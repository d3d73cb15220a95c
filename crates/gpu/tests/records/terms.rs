//! Every pair term of the crate, under each kernel in turn and in one to three dimensions.
//! A record is one pair: the fields of i, then those of j.

use super::common::{self, Random};
use super::{COUNT, Outcome};
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::particles::{Field, Fields, Output, Shape};
use meshfree::scalar::{Lane, Record, Traced, Unrecordable};
use meshfree::term::{Term, probe};

/// A pair of a term, recorded, with the fields of each side.
fn record<const D: usize, A: Term<D>>(
    term: &A,
    kernel: &impl Kernel<D>,
) -> (Fields, Result<Record, Unrecordable>) {
    let fields = A::READS.union(Fields::of(&[
        Field::POSITION,
        Field::VELOCITY,
        Field::SMOOTHING_LENGTH,
    ]));
    let width = fields.width(D);
    let record = Record::of(2 * width, |given| {
        let side = |from: usize| {
            move |field: Field, k: usize| {
                // What a probe asks for beside the fields that are read is zero.
                if fields.contains(field) {
                    given[from + fields.offset(field, D) + k]
                } else {
                    Lane::of(0.0)
                }
            }
        };
        let found = probe::<Traced, D, _, _>(term, kernel, side(0), side(width));
        let mut results = vec![found.radial, found.shear];
        results.extend(found.force);
        for output in A::WRITES.without(Output::FORCE).iter() {
            results.extend((0..output.components(D)).map(|k| found.sum(output, k)));
        }
        results
    });
    (fields, record)
}

/// Particles with a value without pattern in every field.
fn side<const D: usize>(fields: Fields, random: &mut Random) -> Vec<Vec<f64>> {
    let mut columns = Vec::new();
    for field in fields.iter() {
        for k in 0..field.components(D) {
            let mut value = || match field {
                Field::POSITION | Field::REFERENCE_POSITION => 0.8 * random.sign(),
                Field::POSITION_RESIDUAL => 0.0,
                Field::SMOOTHING_LENGTH => 1.0 + 0.1 * random.sign(),
                Field::VELOCITY | Field::MEAN_VELOCITY | Field::PRESSURE_GRADIENT => random.sign(),
                Field::DIVERGENCE | Field::PRESSURE | Field::PRESSURE_COEFFICIENT => random.sign(),
                _ if field.shape() == Shape::Matrix => {
                    0.3 * random.sign() + f64::from(u8::from(k % (D + 1) == 0))
                }
                _ => 1.5 + random.sign(),
            };
            columns.push((0..COUNT).map(|_| value()).collect());
        }
    }
    columns
}

/// One pair of a term under a kernel.
pub(crate) fn check<const D: usize>(
    (outcome, device): (&mut Outcome, &meshfree_gpu::Device),
    (name, term): (&str, &impl Term<D>),
    kernel: &impl Kernel<D>,
    turn: u64,
) {
    let (fields, record) = record(term, kernel);
    let name = format!("{name} in {D}D");
    let record = record.unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut random = Random(turn);
    let mut columns = side::<D>(fields, &mut random);
    columns.extend(side::<D>(fields, &mut random));
    outcome.check(device, &name, &record, &columns, true);
}

fn all<const D: usize>(outcome: &mut Outcome, device: &meshfree_gpu::Device)
where
    KernelKind: Kernel<D>,
{
    let mut turn = 0;
    macro_rules! each {
        ($($term:expr),*) => { $({
            turn += 1;
            let kernel = KernelKind::ALL[turn % KernelKind::ALL.len()];
            let name = stringify!($term).replace("$crate :: ", "").replace("$crate::", "");
            check::<D>((outcome, device), (&name, &$term), &kernel, turn as u64);
        })* };
    }
    meshfree::for_each_term!(each);
}

#[test]
fn pair_terms() {
    let Some(device) = common::device("pair terms") else {
        return;
    };
    let mut outcome = Outcome::new();
    all::<1>(&mut outcome, &device);
    all::<2>(&mut outcome, &device);
    all::<3>(&mut outcome, &device);
    assert!(outcome.end() > 120);
}
