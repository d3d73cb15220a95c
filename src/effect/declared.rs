//! Every law, rate and limit of the crate runs here under its declarations: it asks for what it declares, for all of that,
//! and for nothing else. Parts that are planted to ask for more are stopped by name.

use super::continuity::{Compression, Divergence};
use super::density::{ContactActivity, SolvedSmoothing, SummedDensity};
use super::gradients::CorrectedGradients;
use super::viscosity_switch::ViscositySwitch;
use super::{
    Around, ByField, Chunk, DensityForm, Effect, Evolved, Law, Limit, Point, PointLaw, Rate, Reach,
    Setting, Slices, StepProgram, Tally, View,
};
use crate::kernel::{Kernel, WendlandC2};
use crate::material::Material;
use crate::material::eos::Linear;
use crate::material::failure::SpallStrength;
use crate::material::rheology::Newtonian;
use crate::material::strength::PlasticHeating;
use crate::name;
use crate::particles::{Columns, Field, Fields, Output, Outputs, Shape};
use crate::scalar::{Lane, Real};
use crate::sweep::Results;
use crate::term::Stage;
use crate::term::viscosity::{CullenDehnen, MorrisMonaghan};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What has been asked for: fields to read, fields to write, sums.
type Asked = (Fields, Fields, Outputs);

const NOTHING: Asked = (Fields::NONE, Fields::NONE, Outputs::NONE);

thread_local! {
    static ASKED: Cell<Asked> = const { Cell::new(NOTHING) };
}

/// Notes what a part of a step has asked for.
pub(super) fn note(add: impl FnOnce(&mut Asked)) {
    let mut asked = ASKED.get();
    add(&mut asked);
    ASKED.set(asked);
}

/// Slots of a test.
pub(super) const SLOTS: usize = 24;

/// A material that flows, fails, shears, boils and has every other law that a law of a step may look for.
pub(super) fn material<T: Real>() -> Material<T> {
    Material::new("test", Linear::new(1000.0, 100.0))
        .with_shear_modulus(1e6)
        .with_yield_stress(1.0)
        .with_plastic_heating(PlasticHeating::new(400.0))
        .with_failure(SpallStrength::new(1e9))
        .with_rheology(Newtonian::new(1e-3))
        .with_pressure_cut_off(-1e3)
}

/// Columns in which matrices are unity and all other numbers are one.
fn columns<const D: usize>(fields: Fields) -> Columns<f64, D> {
    let mut columns = Columns::new(fields, SLOTS);
    for (field, column) in columns.iter_mut() {
        let is_matrix = field.shape() == Shape::Matrix;
        for (k, value) in column.iter_mut().enumerate() {
            *value = f64::from(u8::from(!is_matrix || (k % (D * D)).is_multiple_of(D + 1)));
        }
    }
    columns
}

pub(super) fn around<'a, T: Real, const D: usize>(
    sums: &'a Results<T, D>,
    material: &'a Material<T>,
) -> Around<'a, T, D> {
    Around {
        sums,
        material,
        wall: None,
        smoothing_length: 0.1,
        lattice_consistency_factor: 1.0,
        dt: 1e-3,
        time: 0.0,
        gravity: [0.0; D],
        origin: [0.0; D],
        in_drift: true,
    }
}

/// Runs all parts of a program on columns for some fields, and shows what each has asked for.
fn run<const D: usize>(
    program: &StepProgram<f64, D>,
    fields: Fields,
    mut see: impl FnMut(String, Asked, Asked),
) {
    let (sums, material) = (Results::default(), material::<f64>());
    let around = || around(&sums, &material);
    for law in program.laws.iter().flatten() {
        ASKED.set(NOTHING);
        let mut columns = columns::<D>(fields);
        Chunk::new(Slices::of(&mut columns), 0..SLOTS, SLOTS, around()).run(&**law);
        let declared = (law.reads(), law.writes(), law.sums());
        see(law.name().into(), declared, ASKED.get());
    }
    let columns = columns::<D>(fields);
    let view = View::new(&columns, around());
    let rates = (program.evolved.iter())
        .flat_map(|own| own.rates.iter().map(|rate| (own.field, rate)))
        .chain(program.pending.iter().map(|(field, rate)| (*field, rate)));
    for (field, rate) in rates {
        ASKED.set(NOTHING);
        let view = view.of_rate(&**rate, field);
        let mut rates = vec![0.0; SLOTS * field.components(D)];
        rate.growth(&view, 0, &[1.0; SLOTS], &mut [0.0; SLOTS]);
        rate.source(&view, 0, &mut rates);
        let declared = (rate.reads(), Fields::NONE, rate.sums());
        see(format!("rate of {field:?}"), declared, ASKED.get());
    }
    for limit in &program.limits {
        ASKED.set(NOTHING);
        limit.step(&view.of_limit(&**limit), 0);
        let declared = (limit.reads(), Fields::NONE, limit.sums());
        see(limit.name().into(), declared, ASKED.get());
    }
}

/// What a program may use where a scheme has it.
pub(super) fn optional<T: Real, const D: usize>(program: &StepProgram<T, D>) -> Fields {
    let laws = program.laws.iter().flatten().map(|law| law.optional());
    let rates = program.evolved.iter().flat_map(|own| &own.rates);
    let pending = program.pending.iter().map(|(_, rate)| rate);
    let rates = rates.chain(pending).map(|rate| rate.optional());
    laws.chain(rates).fold(Fields::NONE, Fields::union)
}

/// Parts of a program without what is optional, and with it; how many parts there are.
fn check<const D: usize>(name: &str, program: &StepProgram<f64, D>) -> usize {
    for law in program.laws.iter().flatten() {
        let (reads, writes) = (law.reads(), law.writes());
        assert!(law.before().minus(reads).is_empty(), "{name}: {law:?}");
        let all = reads.union(writes);
        assert!(law.optional().minus(all).is_empty(), "{name}: {law:?}");
        assert!(law.adds().minus(writes).is_empty(), "{name}: {law:?}");
        // Who changes a field says where it stands, so that others can stand elsewhere.
        let changes = reads.minus(reads.minus(writes));
        assert!(
            changes.is_empty() || law.rung().is_some(),
            "{name}: {law:?}"
        );
    }
    let mut parts = 0;
    run(program, program.fields(), |_, _, _| {});
    let all = program.fields().union(optional(program));
    run(program, all, |part, declared, asked| {
        parts += 1;
        let (reads, writes, sums) = asked;
        assert_eq!(declared.1, writes, "{name}, {part}: writes");
        assert_eq!(declared.2, sums, "{name}, {part}: sums");
        // What it changes it may read where it writes.
        let unread = declared.0.minus(reads).minus(writes);
        assert!(unread.is_empty(), "{name}, {part} does not read {unread:?}");
    });
    parts
}

fn setting<const D: usize>(density: DensityForm) -> Setting
where
    WendlandC2: Kernel<D>,
{
    Setting::of::<D>(&WendlandC2, 1.3, (density, density))
}

fn effect<const D: usize>(name: &str, density: DensityForm, effect: &impl Effect<D>) -> usize
where
    WendlandC2: Kernel<D>,
{
    let mut program = StepProgram::new(setting::<D>(density));
    effect.register(&mut program);
    check(name, &program)
}

#[test]
fn every_part_of_an_effect_asks_for_what_it_declares() {
    let mut parts = 0;
    macro_rules! each {
        (liquid [$($a:expr),*] solid [$($b:expr),*] total_lagrangian [$($c:expr),*] sheet [$($d:expr),*] rod [$($e:expr),*]) => {
            $(parts += effect::<2>(stringify!($a), DensityForm::Continuity, &$a);)*
            $(parts += effect::<2>(stringify!($b), DensityForm::Continuity, &$b);)*
            $(parts += effect::<2>(stringify!($c), DensityForm::Deformation, &$c);)*
            $(parts += effect::<2>(stringify!($d), DensityForm::Deformation, &$d);)*
            $(parts += effect::<1>(stringify!($e), DensityForm::Continuity, &$e);)*
        };
    }
    crate::for_each_effect!(each);
    assert!(parts > 40, "{parts}");
}

/// Laws and rates of the scheme itself, and of viscosities, in two dimensions and in one.
fn of_the_scheme<const D: usize>()
where
    WendlandC2: Kernel<D>,
{
    let new = || StepProgram::<f64, D>::new(setting::<D>(DensityForm::Continuity));
    let law = |name, stage, law: &dyn Fn(&mut StepProgram<f64, D>, Stage)| {
        let mut program = new();
        law(&mut program, stage);
        assert_eq!(check(name, &program), 1);
    };
    for form in [
        DensityForm::NumberDensity,
        DensityForm::Normalised,
        DensityForm::Lam,
        DensityForm::Summation,
    ] {
        law("density", Stage::Density, &|program, stage| {
            program.law(stage, SummedDensity(form));
        });
    }
    law("contacts", Stage::Density, &|program, stage| {
        program.law(stage, ContactActivity);
    });
    let smoothing = SolvedSmoothing {
        eta: 1.3,
        limits: [0.5, 2.0],
    };
    law("smoothing", Stage::Density, &|program, stage| {
        program.law(stage, smoothing);
    });
    for wanted in [
        Fields::of(&[Field::VELOCITY_GRADIENT]),
        Fields::of(&[Field::PRESSURE_GRADIENT, Field::CORRECTION]),
        Fields::of(&[Field::DENSITY_GRADIENT]),
    ] {
        law("gradients", Stage::Gradients, &|program, stage| {
            program.law(
                stage,
                CorrectedGradients {
                    wanted,
                    by_kernel: false,
                },
            );
        });
    }
    let form = DensityForm::Continuity;
    for own in [
        ViscositySwitch::of::<_, D>(&MorrisMonaghan::STANDARD, form, 2.0),
        ViscositySwitch::of::<_, D>(&CullenDehnen::STANDARD, form, 2.0),
    ] {
        let mut program = new();
        program.law(Stage::Rates, own.expect("a switch"));
        assert_eq!(check("switch", &program), 1);
    }
    let compression = Compression {
        density: DensityForm::Continuity,
        pressure: DensityForm::Continuity,
    };
    let mut program = new();
    program.evolve(Evolved::kicked(Field::DENSITY).by(compression));
    program.evolve(Evolved::kicked(Field::SMOOTHING_LENGTH).by(Divergence(compression)));
    program.evolve(Evolved::kicked(Field::ENERGY).by(ByField(Field::PRESSURE)));
    assert_eq!(check("continuity", &program), 3);
}

#[test]
fn every_part_of_a_scheme_asks_for_what_it_declares() {
    of_the_scheme::<1>();
    of_the_scheme::<2>();
}

const COLOUR: Field = Field::scalar(name!("colour", "1"));
const FLOW: Output = Output::scalar(name!("flow", "W"));

/// A part of a step that declares to read a colour, and then lies.
#[derive(Clone, Copy, Debug)]
enum Liar {
    ReadsDensity,
    WritesColour,
    WritesDensity,
    ReadsFlow,
}

impl<T: Real, const D: usize> Law<T, D> for Liar {
    fn name(&self) -> &'static str {
        "a liar"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[COLOUR])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::PRESSURE])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let ([colour], [pressure]) = chunk.columns([COLOUR], [Field::PRESSURE]);
        pressure.copy_from_slice(colour);
        match self {
            Self::ReadsDensity => _ = chunk.columns([Field::DENSITY], []),
            Self::WritesColour => _ = chunk.columns([], [COLOUR]),
            Self::WritesDensity => _ = chunk.columns([], [Field::DENSITY]),
            Self::ReadsFlow => _ = chunk.sum(FLOW),
        }
        Tally::default()
    }
}

impl<T: Real, const D: usize> Rate<T, D> for Liar {
    fn reads(&self) -> Fields {
        Fields::of(&[COLOUR])
    }
    fn sums(&self) -> Outputs {
        Outputs::NONE
    }
    fn source(&self, at: &View<'_, T, D>, _first: usize, _source: &mut [T]) {
        match self {
            Self::ReadsFlow => _ = at.sum(FLOW),
            _ => _ = at.column(Field::DENSITY),
        }
    }
}

impl<T: Real, const D: usize> Limit<T, D> for Liar {
    fn name(&self) -> &'static str {
        "a liar"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[COLOUR])
    }
    fn step(&self, at: &View<'_, T, D>, slot: usize) -> f64 {
        match self {
            Self::ReadsFlow => at.sum(FLOW).get(0, slot).to_f64(),
            Self::WritesColour => at.velocity_gradient(slot)[(0, 0)].to_f64(),
            _ => at.column(Field::DENSITY)[slot].to_f64(),
        }
    }
}

/// The same of points.
#[derive(Clone, Copy, Debug)]
struct PointLiar(Liar);

impl<const D: usize> PointLaw<D> for PointLiar {
    const NAME: &'static str = "a liar";
    const READS: Fields = Fields::of(&[COLOUR]);
    const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let colour = at.get(COLOUR);
        at.set(Field::PRESSURE, colour);
        match self.0 {
            Liar::ReadsDensity => _ = at.get(Field::DENSITY),
            Liar::WritesColour => at.set(COLOUR, colour),
            Liar::WritesDensity => at.set(Field::DENSITY, colour),
            Liar::ReadsFlow => _ = at.sum(FLOW),
        }
    }
}

/// Of what a program dies in which every field is carried.
fn dies_of(register: impl FnOnce(&mut StepProgram<f64, 2>)) -> String {
    let mut program = StepProgram::new(setting::<2>(DensityForm::Continuity));
    program.declare(COLOUR, 0.0);
    register(&mut program);
    let fields = Fields::of(&[COLOUR, Field::DENSITY, Field::PRESSURE]);
    let died = catch_unwind(AssertUnwindSafe(|| run(&program, fields, |_, _, _| {})));
    *died.expect_err("a lie").downcast().expect("words")
}

#[test]
fn who_asks_for_more_is_stopped_by_name() {
    for (liar, does) in [
        (Liar::ReadsDensity, "reads the field `density`"),
        (Liar::WritesColour, "writes the field `colour`"),
        (Liar::WritesDensity, "writes the field `density`"),
        (Liar::ReadsFlow, "reads the sum `flow`"),
    ] {
        for text in [
            dies_of(|program| program.law(Stage::State, liar)),
            dies_of(|program| program.law(Stage::State, PointLiar(liar))),
        ] {
            assert!(text.contains(&format!("the law `a liar` {does}")), "{text}");
        }
    }
    for (liar, does) in [
        (Liar::ReadsDensity, "reads the field `density`"),
        (Liar::ReadsFlow, "reads the sum `flow`"),
    ] {
        let text = dies_of(|program| program.evolve(Evolved::kicked(COLOUR).by(liar)));
        assert!(
            text.contains(&format!("the rate of `colour` {does}")),
            "{text}"
        );
    }
    for (liar, does) in [
        (Liar::ReadsDensity, "reads the field `density`"),
        (Liar::ReadsFlow, "reads the sum `flow`"),
        (Liar::WritesColour, "reads the sum `velocity_gradient`"),
    ] {
        let text = dies_of(|program| program.limit(liar));
        assert!(
            text.contains(&format!("the limit `a liar` {does}")),
            "{text}"
        );
    }
}
