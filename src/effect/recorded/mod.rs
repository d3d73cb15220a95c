//! Laws, rates and limits of effects, recorded: what a device runs of them, which the tests follow to the bits of their loops here.
//! Laws that a material holds are recorded by their own text.

use super::access::Access;
use super::point::{AtWall, CONSTANTS, OfLaw, OfLimit, OfRate};
use super::{
    Around, BySum, DensityForm, Effect, Point, PointLaw, PointLimit, PointRate, Rate, Setting,
    StepProgram, View,
};
use crate::boundary::{Slip, WallSurface};
use crate::kernel::{Kernel, WendlandC2};
use crate::material::Material;
use crate::particles::{Columns, Field, Fields, Outputs};
use crate::scalar::{Lane, Mask, Real, Record, Traced, Unrecordable};
use crate::sweep::Results;
use crate::tensor::Square;
use crate::term::{MOST_READS, MOST_SUMS};

/// A law, rate or limit of an effect, recorded.
///
/// It is given, in this order, the numbers of the fields that it reads or writes, those of its sums, [`CONSTANTS`] numbers of the body, the
/// step \[s\], the present value of a rate, and what a law of walls sees of its wall ([`AtWall`]). It results in the numbers of
/// the fields that it writes, of [`Field::POSITION`] the displacement, one where it has limited, and its change if it
/// [repeats](super::Law::repeats); in the rate; or in the limit.
#[derive(Debug)]
pub struct PointRecord {
    /// Its name; of a rate, that of its field.
    pub name: String,
    /// What it does, or what keeps that from being recorded.
    pub record: Result<Record, Unrecordable>,
    /// The fields that it is given.
    pub fields: Fields,
    /// The fields that it makes.
    pub writes: Fields,
    /// The sums that it is given.
    pub sums: Outputs,
    /// Whether it computes in `f64` where particles are stored in `f32`.
    pub double: bool,
    /// Whether it is the growth g \[1/s\] of a rate g Y + s.
    pub growth: bool,
    /// The numbers of the body.
    pub constants: [f64; CONSTANTS],
    /// Whether it acts on the body at all.
    pub acts: bool,
}

/// Numbers, sums, constants, the step and the present value, and the wall.
type Given<const D: usize> = (
    [Traced; MOST_READS],
    [Traced; MOST_SUMS],
    [Traced; CONSTANTS],
    [Traced; 2],
    AtWall<Traced, D>,
);

fn given<const D: usize>(fields: Fields, sums: Outputs, all: &[Traced]) -> Given<D> {
    let (width, summed) = (fields.width(D), sums.width(D));
    let take = |from: usize, count: usize| move |k: usize| all[from + k.min(count)];
    let others = width + summed + CONSTANTS;
    let wall = &all[others + 2..];
    (
        core::array::from_fn(take(0, width)),
        core::array::from_fn(take(width, summed)),
        core::array::from_fn(take(width + summed, CONSTANTS)),
        [all[others], all[others + 1]],
        AtWall {
            fall: core::array::from_fn(|d| wall[d]),
            normal: core::array::from_fn(|d| wall[D + d]),
            gradient: Square(core::array::from_fn(|a| {
                core::array::from_fn(|b| wall[2 * D + a * D + b])
            })),
        },
    )
}

fn of<const D: usize>(
    name: &str,
    (fields, writes, sums): (Fields, Fields, Outputs),
    double: bool,
    text: impl FnOnce(Given<D>) -> Vec<Traced>,
    (constants, acts): ([f64; CONSTANTS], bool),
) -> PointRecord {
    let inputs = fields.width(D) + sums.width(D) + CONSTANTS + 2 + 2 * D + D * D;
    let record = Record::of(inputs, |all| text(given::<D>(fields, sums, all)));
    PointRecord {
        name: name.to_owned(),
        record,
        fields,
        writes,
        sums,
        double,
        growth: false,
        constants,
        acts,
    }
}

/// Records a law in a scheme that has some fields.
pub(super) fn law<T: Real, A: PointLaw<D>, const D: usize>(
    law: &A,
    around: &Around<'_, T, D>,
    there: Fields,
) -> PointRecord {
    let fields = A::READS.union(A::WRITES);
    let mut all = [0.0; CONSTANTS];
    let acts = PointLaw::prepare(law, around, &mut all);
    of::<D>(
        A::NAME,
        (fields, law.written(), A::SUMS),
        A::DOUBLE,
        |(mut numbers, sums, constants, [dt, _], wall)| {
            let mut point = Point::<Traced, D, OfLaw<T, A, D>> {
                numbers: &mut numbers,
                sums: &sums,
                there: &there,
                access: &Access::of_law::<T, D>(law),
                limited: None,
                change: None,
                dt,
                constants,
                displacement: [Traced::of(0.0); D],
                wall: &wall,
                around,
            };
            law.point(&mut point);
            let displacement = point.displacement;
            let limited = point.limited.unwrap_or_else(|| Mask::all_of(false));
            let change = point.change;
            let written = law.written().iter().flat_map(|field| {
                let start = fields.offset(field, D);
                start..start + field.components(D)
            });
            let places = fields.offset(Field::POSITION, D);
            let moved = A::WRITES.contains(Field::POSITION);
            let own = |k: usize| match k.checked_sub(places) {
                Some(d) if moved && d < D => displacement[d],
                _ => numbers[k],
            };
            let mut results: Vec<_> = written.map(own).collect();
            results.push(Lane::select(limited, Traced::of(1.0), Traced::of(0.0)));
            results.extend(change);
            results
        },
        (all, acts),
    )
}

/// Records a rate as a view of it has access.
pub(super) fn rate<T: Real, A: PointRate<D>, const D: usize>(
    rate: &A,
    view: &View<'_, T, D>,
) -> PointRecord {
    let mut all = [0.0; CONSTANTS];
    let acts = PointRate::prepare(rate, &view.around, &mut all);
    let carried = view.columns.fields();
    let there = carried.minus(carried.minus(A::READS));
    let own = of::<D>(
        &view.access.name(),
        (A::READS, Fields::NONE, A::SUMS),
        false,
        |(mut numbers, sums, constants, [dt, present], wall)| {
            let point = Point::<Traced, D, OfRate<T, A, D>> {
                numbers: &mut numbers,
                sums: &sums,
                there: &there,
                access: &view.access,
                limited: None,
                change: None,
                dt,
                constants,
                displacement: [Traced::of(0.0); D],
                wall: &wall,
                around: &view.around,
            };
            let width = if A::GROWTH {
                1
            } else {
                view.access.components::<D>()
            };
            let mut own = vec![Traced::of(0.0); width];
            rate.point(&point, present, &mut own);
            own
        },
        (all, acts),
    );
    PointRecord {
        growth: A::GROWTH,
        ..own
    }
}

/// Records a limit.
pub(super) fn limit<T: Real, A: PointLimit<D>, const D: usize>(
    limit: &A,
    view: &View<'_, T, D>,
) -> PointRecord {
    of::<D>(
        A::NAME,
        (A::READS, Fields::NONE, A::SUMS),
        true,
        |(mut numbers, sums, constants, [dt, _], wall)| {
            let point = Point::<Traced, D, OfLimit<T, A, D>> {
                numbers: &mut numbers,
                sums: &sums,
                there: &A::READS,
                access: &view.access,
                limited: None,
                change: None,
                dt,
                constants,
                displacement: [Traced::of(0.0); D],
                wall: &wall,
                around: &view.around,
            };
            vec![PointLimit::step(limit, &point)]
        },
        ([0.0; CONSTANTS], true),
    )
}

/// Records a rate that is a sum.
pub(super) fn by_sum<T: Real, const D: usize>(rate: &BySum) -> PointRecord {
    let (fields, sums) = (Rate::<T, D>::reads(rate), Rate::<T, D>::sums(rate));
    of::<D>(
        rate.sum.name(),
        (fields, Fields::NONE, sums),
        false,
        |(numbers, sums, ..)| {
            let over = rate.over.map(|_| numbers[0]);
            let own = &sums[..rate.sum.components(D)];
            own.iter().map(|sum| BySum::point(*sum, over)).collect()
        },
        ([0.0; CONSTANTS], true),
    )
}

/// Everything that an effect does to single particles in a scheme of a density form, with the Wendland kernel at h = 1.3 dx, recorded for
/// a material; what acts on a wall is recorded as there. Particles have the fields `more` in addition to those that the effect names.
///
/// ```
/// use meshfree::effect::{Cavitation, DensityForm, parts::point_records};
/// use meshfree::{material::catalogue, particles::Fields};
/// let water = catalogue::water::<f64>().with_pressure_cut_off(0.0);
/// let all = point_records::<f64, 2>(&Cavitation, DensityForm::Continuity, &water, Fields::NONE);
/// assert!(!all.is_empty() && all.iter().all(|own| own.record.is_ok()));
/// ```
#[cfg(any(test, feature = "devices"))]
#[must_use]
pub fn point_records<T: Real, const D: usize>(
    effect: &impl Effect<D>,
    density: DensityForm,
    material: &Material<T>,
    more: Fields,
) -> Vec<PointRecord>
where
    WendlandC2: Kernel<D>,
{
    let setting = Setting::of::<D>(&WendlandC2, 1.3, (density, density));
    let mut program = StepProgram::<T, D>::new(setting);
    effect.register(&mut program);
    let (sums, nothing) = (Results::default(), [].as_slice());
    let surface = WallSurface::new((&[], 0), (&[], &[]), (None, Slip::None), Some(nothing), &[]);
    let around = Around {
        sums: &sums,
        material,
        wall: Some(&surface),
        smoothing_length: 1.0,
        lattice_consistency_factor: 1.0,
        dt: 1e-3,
        time: 0.0,
        gravity: [0.0; D],
        origin: [0.0; D],
        in_drift: true,
    };
    let fields = program.fields().union(more);
    let columns = Columns::new(fields, 0);
    let view = View::new(&columns, around);
    let mut all = Vec::new();
    for law in program.laws.iter().flatten() {
        let own = law.reads().union(law.writes());
        all.push((
            law.name().to_owned(),
            law.record(&around, own.minus(own.minus(fields))),
        ));
    }
    let evolved = program
        .evolved
        .iter()
        .flat_map(|own| own.rates.iter().map(|rate| (own.field, rate)));
    let pending = program.pending.iter().map(|(field, rate)| (*field, rate));
    for (field, rate) in evolved.chain(pending) {
        let view = view.of_rate(&**rate, field);
        all.push((view.access.name(), rate.record(&view)));
    }
    for limit in &program.limits {
        all.push((
            limit.name().to_owned(),
            limit.record(&view.of_limit(&**limit)),
        ));
    }
    let unwritten = |name| PointRecord {
        name,
        record: Err(Unrecordable {
            what: "a loop over columns",
        }),
        fields: Fields::NONE,
        writes: Fields::NONE,
        sums: Outputs::NONE,
        double: false,
        growth: false,
        constants: [0.0; CONSTANTS],
        acts: true,
    };
    all.into_iter()
        .map(|(name, own)| own.unwrap_or_else(|| unwritten(name)))
        .collect()
}

#[cfg(test)]
mod tests;
