//! Every law, rate and limit of the crate is recorded here, and the record followed to the bits of its loop on the host.
//! Laws that a material holds are recorded in `material`.

use super::PointRecord;
use crate::boundary::{Slip, WallSurface};
use crate::effect::continuity::{Compression, Divergence};
use crate::effect::declared::{SLOTS, around, optional};
use crate::effect::density::{ContactActivity, SolvedSmoothing, SummedDensity};
use crate::effect::gradients::CorrectedGradients;
use crate::effect::viscosity_switch::ViscositySwitch;
use crate::effect::{
    Around, Chunk, DensityForm, Effect, Evolved, PlaneStress, Plasticity, Setting, Slices,
    StepProgram, UniaxialStress, View,
};
use crate::kernel::{Kernel, WendlandC2};
use crate::material::Material;
use crate::material::failure::JohnsonCookFailure;
use crate::material::rheology::CarreauYasuda;
use crate::material::strength::JohnsonCook;
use crate::particles::{Columns, Field, Fields, Outputs, Shape};
use crate::scalar::Real;
use crate::sweep::{Results, add_compensated};
use crate::tensor::Matrix;
use crate::term::Stage;
use crate::term::viscosity::{CullenDehnen, MorrisMonaghan};

impl PointRecord {
    /// What is made of some numbers, in the precision of the part.
    fn follow<T: Real>(&self, given: &[f64]) -> Vec<T> {
        let record = self.record.as_ref().expect("a record");
        if self.double {
            return record.follow(given).into_iter().map(T::from_f64).collect();
        }
        let given: Vec<_> = given.iter().map(|value| T::from_f64(*value)).collect();
        record.follow(&given)
    }
}

/// Numbers without pattern, most of them positive; in matrices near unity.
fn noise<T: Real>(n: usize) -> T {
    T::from_f64(2.0 * (1e4 * (n as f64 + 0.7).sin()).fract().abs() - 0.3)
}

fn columns<T: Real, const D: usize>(fields: Fields) -> Columns<T, D> {
    let mut columns = Columns::new(fields, SLOTS);
    for (n, (field, column)) in columns.iter_mut().enumerate() {
        let is_matrix = field.shape() == Shape::Matrix;
        for (k, value) in column.iter_mut().enumerate() {
            let own = noise::<T>(7 * k + 1000 * n);
            *value = match is_matrix {
                true if (k % (D * D)).is_multiple_of(D + 1) => T::one() + own * T::from_f64(0.2),
                true => own * T::from_f64(0.2),
                false => own,
            };
        }
    }
    columns
}

fn sums<T: Real, const D: usize>(outputs: Outputs) -> Results<T, D> {
    let data = (0..outputs.width(D) * SLOTS.next_multiple_of(16))
        .map(noise)
        .collect();
    Results::of_stored(outputs, (data, 0), Vec::new())
}

fn same<T: Real>(found: T, expected: T, what: &str) {
    let (found, expected) = (found.to_f64(), expected.to_f64());
    assert!(
        found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan()),
        "{what}: {found:e} {expected:e}"
    );
}

/// The numbers of a particle that a record is given, the step and a present value.
fn numbers<T: Real, const D: usize>(
    own: &PointRecord,
    columns: &Columns<T, D>,
    summed: &Results<T, D>,
    slot: usize,
    others: [f64; 2],
    wall: Option<&Seen<D>>,
) -> Vec<f64> {
    let mut all = Vec::new();
    for field in own.fields.iter() {
        let width = field.components(D);
        let column = columns.raw(field).get(slot * width..(slot + 1) * width);
        all.extend((0..width).map(|k| column.map_or(0.0, |column| column[k].to_f64())));
    }
    for output in own.sums.iter() {
        all.extend((0..output.components(D)).map(|k| summed.get(output, k, slot).to_f64()));
    }
    all.extend(own.constants);
    all.extend(others);
    if let Some(wall) = wall {
        all.extend((0..D).map(|d| GRAVITY - wall.accelerations[slot][d]));
        all.extend(wall.normals[slot]);
        all.extend((0..D * D).map(|k| wall.gradients[slot][(k / D, k % D)]));
    }
    all
}

/// Of all axes \[m/s²\].
const GRAVITY: f64 = 0.7;

/// A wall without slip whose particles have accelerations, normals and spins without pattern.
struct Seen<const D: usize> {
    ids: Vec<u32>,
    rest: Vec<[f64; D]>,
    normals: Vec<[f64; D]>,
    accelerations: Vec<[f64; D]>,
    gradients: Vec<Matrix<f64, D>>,
}

impl<const D: usize> Seen<D> {
    fn new() -> Self {
        let vectors = |from: usize| {
            let own = |k: usize| core::array::from_fn(|d| noise(from + D * k + d));
            (0..SLOTS).map(own).collect()
        };
        let gradient = |k: usize| Matrix::from_fn(|a, b| noise(9000 + 9 * k + D * a + b));
        Self {
            ids: (0..SLOTS as u32).collect(),
            rest: vec![[0.0; D]; SLOTS],
            normals: vectors(7000),
            accelerations: vectors(8000),
            gradients: (0..SLOTS).map(gradient).collect(),
        }
    }
    fn surface<T: Real>(&self) -> WallSurface<'_, T, D> {
        WallSurface::new(
            (&self.ids, 0),
            (&self.rest, &self.normals),
            (None, Slip::None),
            Some(&self.accelerations),
            &self.gradients,
        )
    }
}

/// One whose strength and failure take every branch.
fn material<T: Real>() -> Material<T> {
    let strength = JohnsonCook::new(0.2, 0.5, 0.31).with_rate_sensitivity(0.025);
    let failure = JohnsonCookFailure::new(0.05, 3.44, -2.12).with_rate_sensitivity(0.002);
    crate::effect::declared::material()
        .with_strength(strength.with_softening(1.09, 1356.0))
        .with_failure(failure.with_heat_sensitivity(0.61, 1793.0))
        .with_rheology(CarreauYasuda::new(0.056, 3.45e-3, 3.313, 0.3568))
}

/// Follows the records of all parts of a program.
fn check<T: Real, const D: usize>(program: &StepProgram<T, D>, fields: Fields) -> usize {
    let (material, mut followed) = (material::<T>(), 0);
    let seen = Seen::new();
    let surface = seen.surface();
    for (law, in_drift) in program
        .laws
        .iter()
        .flatten()
        .flat_map(|law| [(law, true), (law, false)])
    {
        let summed = sums::<T, D>(law.sums());
        let around = Around {
            in_drift,
            wall: Some(&surface),
            gravity: [GRAVITY; D],
            ..around(&summed, &material)
        };
        let there = law.reads().union(law.writes());
        let there = there.minus(there.minus(fields));
        let own = law.record(&around, there);
        let own = own.unwrap_or_else(|| panic!("{} is no text of lanes", law.name()));
        if !own.acts {
            continue;
        }
        let before = columns::<T, D>(fields);
        let mut after = before.clone();
        let live = SLOTS - 3;
        let tally = Chunk::new(Slices::of(&mut after), 0..SLOTS, live, around).run(&**law);
        let mut limited = 0;
        for slot in 0..SLOTS {
            let others = [around.dt, 0.0];
            let given = numbers(&own, &before, &summed, slot, others, Some(&seen));
            let results = own.follow::<T>(&given);
            let mut found = results.iter();
            for field in own.writes.iter() {
                let width = field.components(D);
                for (k, found) in found.by_ref().take(width).enumerate() {
                    let at = slot * width + k;
                    if field == Field::POSITION {
                        let mut x = before.raw(field)[at];
                        let mut lost = before.raw(Field::POSITION_RESIDUAL).get(at).copied();
                        add_compensated(&mut x, lost.as_mut(), *found);
                        same(x, after.raw(field)[at], &format!("{law:?}"));
                    } else if field == Field::POSITION_RESIDUAL {
                        // With the position.
                    } else if let Some(expected) = after.raw(field).get(at) {
                        same(*found, *expected, &format!("{law:?}, {field:?} of {slot}"));
                    }
                }
            }
            let limits = found.next().is_some_and(|own| *own > T::zero());
            limited += u64::from(slot < live && limits);
        }
        assert_eq!(limited, tally.limited, "{law:?}");
        followed += 1;
    }
    let columns = columns::<T, D>(fields);
    let rates = program
        .evolved
        .iter()
        .flat_map(|own| own.rates.iter().map(|rate| (own.field, rate)));
    for (field, rate) in rates.chain(program.pending.iter().map(|(field, rate)| (*field, rate))) {
        let summed = sums::<T, D>(rate.sums());
        let view = View::new(&columns, around(&summed, &material)).of_rate(&**rate, field);
        let own = rate.record(&view);
        let own = own.unwrap_or_else(|| panic!("{rate:?} is no text of lanes"));
        let present: Vec<T> = (0..SLOTS).map(noise).collect();
        let (mut growth, width) = (vec![T::zero(); SLOTS], field.components(D));
        let mut source = vec![T::zero(); SLOTS * width];
        rate.growth(&view, 0, &present, &mut growth);
        rate.source(&view, 0, &mut source);
        for slot in 0..SLOTS {
            let given = numbers(
                &own,
                &columns,
                &summed,
                slot,
                [view.around.dt, present[slot].to_f64()],
                None,
            );
            let found = own.follow::<T>(&given);
            let expected = if source.iter().any(|value| *value != T::zero()) {
                &source[slot * width..(slot + 1) * width]
            } else {
                &growth[slot..=slot]
            };
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(expected) {
                same(*found, *expected, &format!("{rate:?} of {slot}"));
            }
        }
        followed += 1;
    }
    for limit in &program.limits {
        let summed = sums::<T, D>(limit.sums());
        let view = View::new(&columns, around(&summed, &material)).of_limit(&**limit);
        let own = limit.record(&view);
        let own = own.unwrap_or_else(|| panic!("{} is no text of lanes", limit.name()));
        for slot in 0..SLOTS {
            let given = numbers(&own, &columns, &summed, slot, [0.0; 2], None);
            same(own.follow(&given)[0], limit.step(&view, slot), limit.name());
        }
        followed += 1;
    }
    followed
}

fn setting<const D: usize>(density: DensityForm) -> Setting
where
    WendlandC2: Kernel<D>,
{
    Setting::of::<D>(&WendlandC2, 1.3, (density, density))
}

/// A program with its optional fields, and without them.
fn both<T: Real, const D: usize>(program: &StepProgram<T, D>) -> usize {
    check(program, program.fields());
    check(program, program.fields().union(optional(program)))
}

fn effect<T: Real, const D: usize>(effect: &impl Effect<D>, density: DensityForm) -> usize
where
    WendlandC2: Kernel<D>,
{
    let mut program = StepProgram::<T, D>::new(setting::<D>(density));
    effect.register(&mut program);
    both(&program)
}

/// Laws and rates of the scheme itself.
fn of_the_scheme<T: Real, const D: usize>() -> usize
where
    WendlandC2: Kernel<D>,
{
    let mut followed = 0;
    for form in [
        DensityForm::NumberDensity,
        DensityForm::Normalised,
        DensityForm::Lam,
        DensityForm::Summation,
        DensityForm::Continuity,
    ] {
        let mut program = StepProgram::<T, D>::new(setting::<D>(form));
        program.law(Stage::Density, SummedDensity(form));
        program.law(Stage::Density, ContactActivity);
        program.law(
            Stage::Density,
            SolvedSmoothing {
                eta: 1.3,
                limits: [0.5, 2.0],
            },
        );
        program.law(
            Stage::Gradients,
            CorrectedGradients {
                wanted: Fields::of(&[Field::PRESSURE_GRADIENT]),
                by_kernel: true,
            },
        );
        for switch in [
            ViscositySwitch::of::<_, D>(&MorrisMonaghan::STANDARD, form, 2.0),
            ViscositySwitch::of::<_, D>(&CullenDehnen::STANDARD, form, 2.0),
        ] {
            program.law(Stage::Rates, switch.expect("a switch"));
        }
        let compression = Compression {
            density: form,
            pressure: form,
        };
        program.evolve(Evolved::kicked(Field::DENSITY).by(compression));
        program.evolve(Evolved::kicked(Field::SMOOTHING_LENGTH).by(Divergence(compression)));
        followed += both(&program);
    }
    followed
}

fn all<T: Real>() -> usize {
    let mut followed = 0;
    macro_rules! each {
        (liquid [$($a:expr),*] solid [$($b:expr),*] total_lagrangian [$($c:expr),*] sheet [$($d:expr),*] rod [$($e:expr),*]) => {
            $(followed += effect::<T, 2>(&$a, DensityForm::Continuity);)*
            $(followed += effect::<T, 3>(&$b, DensityForm::Continuity);)*
            $(followed += effect::<T, 3>(&$c, DensityForm::Deformation);)*
            $(followed += effect::<T, 2>(&$d, DensityForm::Deformation);)*
            $(followed += effect::<T, 1>(&$e, DensityForm::Continuity);)*
        };
    }
    crate::for_each_effect!(each);
    followed + of_the_scheme::<T, 2>()
}

#[test]
fn records_have_the_bits_of_loops_on_the_host() {
    let followed = all::<f64>();
    assert!(followed > 40, "{followed}");
    assert_eq!(all::<f32>(), followed);
}

/// Flow of sheets and rods, whose effects change what plastic flow does.
#[test]
fn plastic_flow_is_recorded_with_sheets_and_rods() {
    let mut program = StepProgram::<f64, 2>::new(setting::<2>(DensityForm::Continuity));
    program.law(Stage::Continuity, Plasticity);
    let own = program.fields();
    assert_eq!(
        check(
            &program,
            own.union(Fields::of(&[PlaneStress::THICKNESS_STRAIN]))
        ),
        1
    );
    assert_eq!(
        check(
            &program,
            own.union(Fields::of(&[UniaxialStress::LATERAL_STRAIN]))
        ),
        1
    );
}
