//! An effect that a scheme does not name is in no loop, no column and no law: tests over all effects of the crate.
//! A list in which it is absent has the same loops, by type, with the same operations a pair, as a list written without it.

use super::{Cavitation, DensityForm};
use super::{Effect, Effects, HourglassControl, Setting, StepProgram, TotalLagrangian};
use crate::kernel::{Kernel, WendlandC2};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Operation, Record, Traced};
use crate::term::{Layout, Pair, Sums, Term, TermDoc, Terms, probe, stage};
use core::any::type_name;
use core::fmt::Debug;
use core::marker::PhantomData;

/// An effect that is not there: an entry of a list, by type, with nothing of what `A` is.
#[derive(Clone, Debug)]
struct Absent<A>(PhantomData<A>);

impl<const D: usize, A: Clone + Debug + Send + Sync + 'static> Effect<D> for Absent<A> {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
}

/// A list of terms as one term, to be recorded.
#[derive(Clone, Debug)]
struct AsOne<A>(A);

impl<const D: usize, A: Terms<D>> Term<D> for AsOne<A> {
    const NAME: &'static str = "meshfree::as_one";
    const READS: Fields = A::READS;
    const WRITES: Outputs = A::WRITES;
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        self.0.pair(pair, sums);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: String::new(),
            equation: "",
            source: "",
        }
    }
}

/// The loop of a stage: its type, how many operations a pair takes, and how many numbers it reads and sums.
#[derive(Clone, Debug, PartialEq)]
struct Loop {
    stage: &'static str,
    terms: &'static str,
    operations: usize,
    reads: usize,
    sums: usize,
}

fn loop_of<const D: usize, A: Terms<D>>(stage: &'static str, terms: A) -> Loop
where
    WendlandC2: Kernel<D>,
{
    let fields = const { &Fields::ALL.union(A::READS) };
    let size = fields.width(D);
    let record = Record::of(2 * size, |given| {
        let number =
            |side: usize| move |field: Field, k| given[side * size + fields.offset(field, D) + k];
        let own = AsOne(terms.clone());
        let pair = probe::<Traced, D, _, _>(&own, &WendlandC2, number(0), number(1));
        let mut results = vec![pair.radial, pair.shear];
        results.extend(pair.force);
        for sum in A::WRITES.without(Output::FORCE).iter() {
            results.extend((0..sum.components(D)).map(|k| pair.sum(sum, k)));
        }
        results
    });
    let record = record.expect("terms are written with the arithmetic of lanes");
    Loop {
        stage,
        terms: type_name::<A>(),
        operations: operations(&record),
        reads: A::READS.width(D),
        sums: A::WRITES.width(D),
    }
}

fn operations(record: &Record) -> usize {
    let acts = |operation: &&Operation| {
        !matches!(
            operation,
            Operation::Input(_) | Operation::Constant(_) | Operation::Everywhere(_)
        )
    };
    record.operations().iter().filter(acts).count()
}

/// The loops of a list, stage by stage.
fn loops<const D: usize, E: Effects<D>>(list: &E, setting: &Setting) -> Vec<Loop>
where
    WendlandC2: Kernel<D>,
{
    macro_rules! all {
        ($($marker:ident),*) => {
            vec![$(loop_of::<D, _>(stringify!($marker), list.at::<stage::$marker>(setting))),*]
        };
    }
    all!(
        Reference,
        Sums,
        Density,
        Walls,
        Gradients,
        Flow,
        Pressure,
        Rates,
        Power,
        Compression,
        Continuity
    )
}

/// Everything that a list does beside its terms, in words.
fn program<const D: usize, E: Effects<D>>(list: &E, setting: &Setting) -> Vec<String> {
    let mut program = StepProgram::<f64, D>::new(*setting);
    list.register(&mut program);
    let mut parts = vec![
        format!("{:?}", program.fields().iter().collect::<Vec<_>>()),
        format!("{:?}", program.declared),
        format!("{:?} {:?}", program.evolved, program.pending.len()),
        format!("{:?} {:?}", program.ledger, program.documents),
        format!("{:?} {}", program.step_factor(), program.wall_normals),
        format!("{:?} {}", program.least_on_rigid, program.moves),
        format!("{}", program.requirements.len()),
    ];
    let laws = program.laws.iter().flatten();
    parts.push(format!("{:?} {}", list.smoothing(), E::MODES));
    parts.extend(laws.map(|law| format!("{law:?}")));
    parts.extend(program.limits.iter().map(|limit| limit.name().to_owned()));
    parts
}

/// What an effect adds to a list: numbers a particle, numbers and operations of its pairs, laws.
struct Price {
    name: &'static str,
    numbers: usize,
    reads: usize,
    operations: usize,
}

/// What a list is made of, without its type: so a comparison of lists is compiled once.
struct Written {
    loops: Vec<Loop>,
    program: Vec<String>,
    reads: Fields,
    /// Of the list and of its program.
    numbers: usize,
    sound: bool,
}

fn written<const D: usize, E: Effects<D>>(list: &E, setting: &Setting) -> Written
where
    WendlandC2: Kernel<D>,
{
    let mut program = StepProgram::<f64, D>::new(*setting);
    list.register(&mut program);
    Written {
        loops: loops::<D, E>(list, setting),
        program: self::program(list, setting),
        reads: E::READS,
        numbers: E::READS.union(program.fields()).width(D),
        sound: list.problems().is_empty(),
    }
}

/// A list with an effect that is absent against the list without it; gives what the effect adds where it is there.
fn check<const D: usize, B: Effects<D>, A: Effect<D>>(
    name: &'static str,
    base: &B,
    effect: &A,
    setting: &Setting,
) -> Price
where
    WendlandC2: Kernel<D>,
{
    let off = (base.clone(), Absent::<A>(PhantomData));
    let on = (base.clone(), effect.clone());
    compare(
        name,
        &written(base, setting),
        &written(&off, setting),
        &written(&on, setting),
    )
}

fn compare(name: &'static str, without: &Written, off: &Written, with: &Written) -> Price {
    assert_eq!(off.loops, without.loops, "{name}");
    assert_eq!(off.program, without.program, "{name}");
    assert_eq!(off.reads, without.reads, "{name}");
    assert!(off.sound);
    // The comparison would see the effect: it adds something, and to its loops operations.
    let more = with.loops != without.loops || with.program != without.program;
    assert!(more, "{name} does nothing");
    for (own, other) in with.loops.iter().zip(&without.loops) {
        let differs = own.terms != other.terms;
        assert_eq!(
            differs,
            own.operations > other.operations,
            "{name}: {own:?} {other:?}"
        );
    }
    let more = |of: fn(&Loop) -> usize| {
        let sum = |list: &Written| list.loops.iter().map(of).sum::<usize>();
        sum(with) - sum(without)
    };
    Price {
        name,
        numbers: with.numbers - without.numbers,
        reads: more(|own| own.reads),
        operations: more(|own| own.operations),
    }
}

fn setting<const D: usize>(density: DensityForm) -> Setting
where
    WendlandC2: Kernel<D>,
{
    Setting::of::<D>(&WendlandC2, 1.3, (density, density))
}

#[test]
fn an_absent_effect_leaves_no_trace() {
    let liquid = setting::<2>(DensityForm::Continuity);
    let total = setting::<2>(DensityForm::Deformation);
    let rod = setting::<1>(DensityForm::Continuity);
    let mut prices = Vec::new();
    macro_rules! each {
        (liquid [$($a:expr),*] solid [$($b:expr),*] total_lagrangian [$($c:expr),*] sheet [$($d:expr),*] rod [$($e:expr),*]) => {
            $(prices.push(check::<2, _, _>(stringify!($a), &(), &$a, &liquid));)*
            $(prices.push(check::<2, _, _>(stringify!($a), &((), Cavitation), &$a, &liquid));)*
            $(prices.push(check::<2, _, _>(stringify!($b), &(), &$b, &liquid));)*
            $(prices.push(check::<2, _, _>(stringify!($c), &(), &$c, &total));)*
            $(prices.push(check::<2, _, _>(
                stringify!($c), &(((), TotalLagrangian), HourglassControl::default()), &$c, &total));)*
            $(prices.push(check::<2, _, _>(stringify!($d), &(), &$d, &total));)*
            $(prices.push(check::<1, _, _>(stringify!($e), &(), &$e, &rod));)*
        };
    }
    crate::for_each_effect!(each);
    println!("effect | numbers a particle | numbers read by pairs | operations a pair");
    for Price {
        name,
        numbers,
        reads,
        operations,
    } in &prices
    {
        let name = name.replace("$crate::", "").replace("crate::effect::", "");
        println!("{name} | {numbers} | {reads} | {operations}");
    }
    assert!(prices.iter().any(|price| price.operations == 0));
    assert!(prices.iter().any(|price| price.operations > 20));
}

#[test]
fn a_choice_at_run_time_of_an_effect_without_terms_is_none() {
    let liquid = setting::<2>(DensityForm::Continuity);
    let none = ((), None::<super::AcousticDamping>);
    assert_eq!(loops::<2, _>(&none, &liquid), loops::<2, _>(&(), &liquid));
    assert_eq!(
        program::<2, _>(&none, &liquid),
        program::<2, _>(&(), &liquid)
    );
}

#[test]
fn the_list_has_every_effect() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/effect");
    macro_rules! written {
        ($($group:ident [$($effect:expr),*])*) => { [$($(stringify!($effect)),*),*].join(" ") };
    }
    let listed = crate::for_each_effect!(written);
    let listed: std::collections::HashSet<&str> =
        listed.split(|c: char| !c.is_alphanumeric()).collect();
    let mut found = 0;
    let entries = std::fs::read_dir(folder).expect("the sources");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    for path in paths.filter(|path| path.is_file()) {
        let text = std::fs::read_to_string(path).expect("a text");
        for line in text.lines().filter(|line| line.starts_with("impl")) {
            let Some((_, rest)) = line.split_once("> for ") else {
                continue;
            };
            let is_effect = line.contains(" Effect<");
            let end = rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(0);
            let name = &rest[..end];
            // What is nothing, what holds another, and what names a sum that the forces of others make.
            if is_effect
                && ![
                    "NoWalls",
                    "Option",
                    "During",
                    "Absent",
                    "InPlaneStress",
                    "InternalEnergy",
                ]
                .contains(&name)
            {
                found += 1;
                assert!(listed.contains(name), "`for_each_effect` lacks {name}");
            }
        }
    }
    assert!(found > 20, "{found}");
}
