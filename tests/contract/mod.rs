//! The contract that every pair term keeps: symmetric forces, finite at distance zero, nothing beyond
//! the support, the same in lanes as in scalars and as recorded, and no field or sum that is not declared.

use crate::common::{self, AnyKernel, Random};
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::name;
use meshfree::particles::{Field, Fields, Output, Outputs, Shape};
use meshfree::scalar::{Lane, Lanes, Real, Record, Traced};
use meshfree::term::{Layout, Pair, Probe, Sums, Term, TermDoc, probe};
use std::sync::LazyLock;

macro_rules! in_all_dimensions {
    ($check:ident: $($term:expr),*) => {
        $(
            $check::<1>(&$term);
            $check::<2>(&$term);
            $check::<3>(&$term);
        )*
    };
}

/// Holds every term of the crate to a check, in all dimensions.
macro_rules! for_each_term {
    ($check:ident) => {
        meshfree::for_each_term!(in_all_dimensions $check:)
    };
}

/// The fields that every term reads.
macro_rules! read {
    ($($term:expr),*) => { [$(Subject::<2>::reads(&$term)),*] };
}

macro_rules! written {
    ($($term:expr),*) => { [$(stringify!($term)),*] };
}

/// The types in the sources that implement a trait in D dimensions.
fn implementors(of: &str, folder: &std::path::Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            implementors(of, &path, found);
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        for line in text.lines().filter(|line| line.starts_with("impl<")) {
            if let Some((_, name)) = line.split_once(&format!("{of}<D> for ")) {
                let end = name.find(|c: char| !c.is_alphanumeric()).unwrap();
                found.push(name[..end].to_owned());
            }
        }
    }
}

#[test]
fn the_list_has_every_term_and_every_viscosity() {
    let sources = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    implementors(" Term", &sources, &mut all);
    implementors(" ArtificialViscosity", &sources, &mut all);
    let listed = meshfree::for_each_term!(written);
    // A list of all names, and more than a few: the sources were read.
    assert!(all.len() > 30, "{all:?}");
    // What does nothing has nothing to keep, what makes a list one term is of a test, and a rate is one of two that are listed.
    let apart = ["Nothing", "AsOne", "Rate"];
    for name in all.iter().filter(|name| !apart.contains(&name.as_str())) {
        let named = |term: &&str| {
            let words = term.split(|c: char| !c.is_alphanumeric());
            words.into_iter().any(|word| word == name)
        };
        assert!(listed.iter().any(named), "`for_each_term` lacks {name}");
    }
}

const WIDTH: usize = 8;

/// Most numbers of a field.
const COMPONENTS: usize = 9;

/// The fields of the crate, and those of effects that terms read.
static FIELDS: LazyLock<Vec<Field>> = LazyLock::new(|| {
    let reads = meshfree::for_each_term!(read);
    let all = reads.into_iter().fold(Fields::ALL, Fields::union);
    all.iter().collect()
});

fn index(field: Field) -> usize {
    let found = FIELDS.iter().position(|own| *own == field);
    found.expect("a field that terms read")
}

/// A particle with a random value in every field, at most `apart` from the origin along each axis.
#[derive(Clone)]
struct Particle(Vec<Vec<f64>>);

impl Particle {
    #[inline(never)]
    fn random(random: &mut Random, apart: f64) -> Self {
        // All with as many numbers as the largest has.
        let fields = FIELDS.iter().map(|&field| {
            let mut value = || match field {
                Field::POSITION | Field::REFERENCE_POSITION => apart * random.sign(),
                Field::POSITION_RESIDUAL => 0.0,
                Field::SMOOTHING_LENGTH => 1.0 + 0.1 * random.sign(),
                Field::VELOCITY
                | Field::MEAN_VELOCITY
                | Field::VELOCITY_GRADIENT
                | Field::PRESSURE_GRADIENT
                | Field::DIVERGENCE
                | Field::PRESSURE
                | Field::PRESSURE_COEFFICIENT => random.sign(),
                _ => 1.5 + random.sign(),
            };
            (0..COMPONENTS).map(|_| value()).collect()
        });
        Self(fields.collect())
    }
    fn get(&self, field: Field, k: usize) -> f64 {
        self.0[index(field)][k]
    }
    fn set(&mut self, field: Field, k: usize, value: f64) {
        self.0[index(field)][k] = value;
    }
}

/// All that a pair makes of a term: forces, the sums of the crate, and those that the term declares.
fn numbers<L: Lane, const D: usize>(writes: Outputs, probe: &Probe<L, D>) -> Vec<L> {
    let mut all = vec![probe.radial, probe.shear];
    all.extend(probe.force);
    for output in Outputs::ALL.union(writes).iter() {
        for k in 0..output.components(D) {
            all.push(probe.sum(output, k));
        }
    }
    all
}

/// Where component `k` of a field stands among the values of a particle.
fn place(field: Field, k: usize) -> usize {
    COMPONENTS * index(field) + k
}

/// How many values a particle has.
fn placed() -> usize {
    COMPONENTS * FIELDS.len()
}

type Plain = Lanes<f64, WIDTH, false>;
type Fused = Lanes<f64, WIDTH, true>;
type Single = Lanes<f32, 16, true>;

/// A term for a row of particles against one, in lanes.
trait In<L: Lane, const D: usize> {
    fn act(&self, kernel: KernelKind, row: &[L], j: &[L::Broadcast]) -> Probe<L, D>;
}

impl<L: Lane, const D: usize, A: Term<D>> In<L, D> for A
where
    KernelKind: Kernel<D>,
{
    fn act(&self, kernel: KernelKind, row: &[L], j: &[L::Broadcast]) -> Probe<L, D> {
        probe(
            self,
            &AnyKernel(kernel),
            |field, k| row[place(field, k)],
            |field, k| j[place(field, k)],
        )
    }
}

/// A term without its type: so of each only its text in lanes is compiled, and a check once for all.
trait Subject<const D: usize>:
    In<f64, D> + In<Plain, D> + In<Fused, D> + In<Single, D> + In<Traced, D>
{
    fn reads(&self) -> Fields;
    fn writes(&self) -> Outputs;
    fn name(&self) -> String;
}

impl<const D: usize, A: Term<D>> Subject<D> for A
where
    KernelKind: Kernel<D>,
{
    fn reads(&self) -> Fields {
        A::READS
    }
    fn writes(&self) -> Outputs {
        A::WRITES
    }
    fn name(&self) -> String {
        format!("{} in {D}D", self.document().name)
    }
}

/// A row of particles by place, and one particle.
fn lay_out<T: Real, L: Lane<Scalar = T, Broadcast = T>>(
    row: &[Particle],
    j: &Particle,
) -> (Vec<L>, Vec<T>) {
    let mut places = (vec![L::zero(); placed()], vec![T::zero(); placed()]);
    for at in 0..placed() {
        let (field, k) = (at / COMPONENTS, at % COMPONENTS);
        places.0[at] = L::from_fn(|lane| T::from_f64(row[lane].0[field][k]));
        places.1[at] = T::from_f64(j.0[field][k]);
    }
    places
}

/// A term for two particles.
fn scalar<const D: usize>(
    term: &dyn Subject<D>,
    kernel: KernelKind,
    i: &Particle,
    j: &Particle,
) -> Probe<f64, D> {
    let (row, j) = lay_out::<f64, f64>(core::slice::from_ref(i), j);
    In::<f64, D>::act(term, kernel, &row, &j)
}

/// Whether a term is there to do nothing.
fn is_silent<const D: usize>(term: &dyn Subject<D>) -> bool {
    term.name().starts_with("no artificial viscosity")
}

fn forces_are_symmetric<const D: usize>(term: &dyn Subject<D>) {
    let mut random = Random(1);
    let mut acted = false;
    for round in 0..200 {
        let kernel = common::kernel(round);
        let (i, j) = (
            Particle::random(&mut random, 0.8),
            Particle::random(&mut random, 0.8),
        );
        let (there, back) = (scalar(term, kernel, &i, &j), scalar(term, kernel, &j, &i));
        let mut pairs = vec![(there.radial, back.radial), (there.shear, back.shear)];
        // A vector changes its sign where what multiplies r and v does not.
        pairs.extend((0..D).map(|d| (there.force[d], -back.force[d])));
        for (a, b) in pairs {
            acted |= a != 0.0;
            assert!(
                (a - b).abs() <= 1e-14 * (1.0 + a.abs()),
                "{}: {a} and {b}",
                term.name()
            );
        }
    }
    let force = term.writes().contains(Output::FORCE);
    assert_eq!(
        acted,
        force && !is_silent(term),
        "{} declares a force: {force}",
        term.name()
    );
}

#[test]
fn the_force_on_i_is_the_opposite_of_that_on_j() {
    for_each_term!(forces_are_symmetric);
}

fn finite_on_itself<const D: usize>(term: &dyn Subject<D>) {
    let mut random = Random(2);
    for round in 0..100 {
        let i = Particle::random(&mut random, 1.0);
        // The particle itself, and another one in its place.
        let mut j = Particle::random(&mut random, 1.0);
        for k in 0..3 {
            for field in [Field::POSITION, Field::REFERENCE_POSITION] {
                j.set(field, k, i.get(field, k));
            }
        }
        for j in [&i, &j] {
            let result = scalar(term, common::kernel(round), &i, j);
            let finite = numbers(term.writes(), &result)
                .iter()
                .all(|x| x.is_finite());
            assert!(finite, "{}: {result:?}", term.name());
        }
    }
}

#[test]
fn everything_is_finite_at_distance_zero() {
    for_each_term!(finite_on_itself);
}

fn nothing_beyond<const D: usize>(term: &dyn Subject<D>)
where
    KernelKind: Kernel<D>,
{
    let mut random = Random(3);
    for &kernel in KernelKind::ALL {
        for stretch in [1.0 + 1e-12, 1.001, 2.0, 1e6, 1e100] {
            let mut i = Particle::random(&mut random, 1.0);
            let mut j = Particle::random(&mut random, 1.0);
            let h = 0.5 * (i.get(Field::SMOOTHING_LENGTH, 0) + j.get(Field::SMOOTHING_LENGTH, 0));
            for k in 0..3 {
                for field in [Field::POSITION, Field::REFERENCE_POSITION] {
                    i.set(field, k, 0.0);
                    j.set(field, k, 0.0);
                }
            }
            let away = Kernel::<D>::support(&kernel) * h * stretch;
            j.set(Field::POSITION, D - 1, away);
            j.set(Field::REFERENCE_POSITION, D - 1, away);
            let result = scalar(term, kernel, &i, &j);
            let silent = numbers(term.writes(), &result).iter().all(|&x| x == 0.0);
            assert!(
                silent,
                "{} at {stretch} supports of {kernel}: {result:?}",
                term.name()
            );
        }
    }
}

#[test]
fn nothing_acts_beyond_the_support() {
    for_each_term!(nothing_beyond);
}

/// All numbers of a term for a row of particles against one.
fn row_numbers<L: Lane<Scalar = f64, Broadcast = f64>, const D: usize>(
    (term, writes): (&dyn In<L, D>, Outputs),
    kernel: KernelKind,
    row: &[Particle],
    j: &Particle,
) -> Vec<L> {
    let (row, j) = lay_out::<f64, L>(row, j);
    numbers(writes, &term.act(kernel, &row, &j))
}

fn lanes_as_scalars<const D: usize>(term: &dyn Subject<D>) {
    let mut random = Random(4);
    for round in 0..70 {
        let kernel = common::kernel(round);
        let row: Vec<_> = (0..WIDTH)
            .map(|_| Particle::random(&mut random, 1.2))
            .collect();
        let j = Particle::random(&mut random, 1.2);
        let lanes = row_numbers::<Plain, D>((term, term.writes()), kernel, &row, &j);
        let fused = row_numbers::<Fused, D>((term, term.writes()), kernel, &row, &j);
        for (lane, i) in row.iter().enumerate() {
            let one = numbers(term.writes(), &scalar(term, kernel, i, &j));
            for (k, one) in one.iter().enumerate() {
                assert_eq!(lanes[k].extract(lane), *one, "{}, number {k}", term.name());
                let off = fused[k].extract(lane) - one;
                // A viscosity of two particles that nearly coincide is large.
                assert!(
                    off.abs() < 1e-12 * one.abs().max(1.0),
                    "{}, number {k}: fused {off}",
                    term.name()
                );
            }
        }
    }
}

#[test]
fn a_lane_is_the_scalar_to_the_bit_and_a_fused_lane_to_rounding() {
    for_each_term!(lanes_as_scalars);
}

fn declares_what_it_writes<const D: usize>(term: &dyn Subject<D>) {
    let mut random = Random(5);
    for round in 0..100 {
        let (i, j) = (
            Particle::random(&mut random, 0.5),
            Particle::random(&mut random, 0.5),
        );
        let result = scalar(term, common::kernel(round), &i, &j);
        let along = [result.radial, result.shear];
        let pushed = along.iter().chain(&result.force).any(|&force| force != 0.0);
        assert!(
            term.writes().contains(Output::FORCE) || !pushed,
            "{} sets a force",
            term.name()
        );
        for &output in Output::ALL {
            let written = (0..output.components(D)).any(|k| result.sum(output, k) != 0.0);
            let declared = term.writes().contains(output);
            assert!(
                declared || !written,
                "{} writes {}",
                term.name(),
                output.name()
            );
        }
        // Reading a field that is not declared trips an assertion inside the pair.
    }
}

#[test]
fn no_term_writes_a_sum_that_it_does_not_declare() {
    for_each_term!(declares_what_it_writes);
}

/// Fields that the sweep itself uses on behalf of the term: velocities in v and the power of
/// forces, and what rounding has taken from positions.
const USED_BY_THE_SWEEP: [Field; 2] = [Field::VELOCITY, Field::POSITION_RESIDUAL];

fn reads_matter<const D: usize>(term: &dyn Subject<D>) {
    if is_silent(term) {
        return;
    }
    for field in term
        .reads()
        .iter()
        .filter(|field| !USED_BY_THE_SWEEP.contains(field))
    {
        let mut random = Random(6);
        let matters = (0..200).any(|round| {
            let kernel = common::kernel(round);
            let (mut i, mut j) = (
                Particle::random(&mut random, 0.8),
                Particle::random(&mut random, 0.8),
            );
            // Some terms act between alike particles alone.
            let scalars = term
                .reads()
                .iter()
                .filter(|own| own.shape() == Shape::Scalar);
            for alike in scalars.filter(|own| *own != field && round % 4 > 1) {
                j.set(alike, 0, i.get(alike, 0));
            }
            let before = numbers(term.writes(), &scalar(term, kernel, &i, &j));
            let other = Particle::random(&mut random, 0.8);
            // Of some fields only matters whether both particles have the same.
            let share = [0.75, 1.0][round % 2];
            for k in 0..field.components(D) {
                i.set(field, k, other.get(field, k));
                j.set(field, k, share * other.get(field, k));
            }
            before != numbers(term.writes(), &scalar(term, kernel, &i, &j))
        });
        assert!(
            matters,
            "{} reads {} for nothing",
            term.name(),
            field.name()
        );
    }
}

#[test]
fn every_declared_field_changes_something() {
    for_each_term!(reads_matter);
}

/// The numbers of a term for a row of particles, and what its record makes of them.
fn follows<T: Real, L: Lane<Scalar = T, Broadcast = T>, const D: usize>(
    term: &dyn In<L, D>,
    kernel: KernelKind,
    (name, writes, record): (&str, Outputs, &Record),
    random: &mut Random,
) {
    let row: Vec<_> = (0..L::WIDTH)
        .map(|_| Particle::random(random, 1.2))
        .collect();
    let (row, j) = lay_out::<T, L>(&row, &Particle::random(random, 1.2));
    let expected = numbers(writes, &term.act(kernel, &row, &j));
    let inputs: Vec<L> = row.into_iter().chain(j.into_iter().map(L::splat)).collect();
    let found = record.follow(&inputs);
    assert_eq!(found.len(), expected.len());
    for (number, (found, expected)) in found.iter().zip(expected).enumerate() {
        for lane in 0..L::WIDTH {
            let (found, expected) = (
                found.extract(lane).to_f64(),
                expected.extract(lane).to_f64(),
            );
            assert_eq!(
                found.to_bits(),
                expected.to_bits(),
                "{name}, number {number}: {found} for {expected}"
            );
        }
    }
}

fn can_be_recorded<const D: usize>(term: &dyn Subject<D>) {
    let mut random = Random(7);
    let (name, writes) = (term.name(), term.writes());
    for &kernel in KernelKind::ALL {
        let record = Record::of(2 * placed(), |inputs| {
            let (i, j) = inputs.split_at(placed());
            numbers(writes, &In::<Traced, D>::act(term, kernel, i, j))
        });
        let record = record.unwrap_or_else(|error| panic!("{name}: {error}"));
        for _ in 0..3 {
            let recorded = (name.as_str(), writes, &record);
            follows::<f64, f64, D>(term, kernel, recorded, &mut random);
            follows::<f64, Plain, D>(term, kernel, recorded, &mut random);
            follows::<f64, Fused, D>(term, kernel, recorded, &mut random);
            follows::<f32, Single, D>(term, kernel, recorded, &mut random);
        }
    }
}

#[test]
fn the_record_of_a_term_has_its_bits_on_every_lane() {
    for_each_term!(can_be_recorded);
}

/// Shape, slope and gradient of a kernel for three numbers.
fn text<L: Lane, K: Kernel<D>, const D: usize>(kernel: &K, given: &[L]) -> Vec<L> {
    let gradient = kernel.gradient(given[0], given[1], given[2]);
    vec![
        kernel.shape(given[0]),
        kernel.slope_over_q(given[0]),
        gradient,
    ]
}

fn kernel_follows<T: Real, L: Lane<Scalar = T>>(
    name: &str,
    record: &Record,
    text: &dyn Fn(&[L]) -> Vec<L>,
) {
    let mut random = Random(8);
    for _ in 0..50 {
        let given: [L; 3] =
            core::array::from_fn(|_| L::from_fn(|_| T::from_f64(3.5 * random.unit())));
        let expected = text(&given);
        for (found, expected) in record.follow(&given).iter().zip(expected) {
            for lane in 0..L::WIDTH {
                let (found, expected) = (found.extract(lane), expected.extract(lane));
                let bits = (found.to_f64().to_bits(), expected.to_f64().to_bits());
                assert_eq!(bits.0, bits.1, "{name}");
            }
        }
    }
}

macro_rules! kernels {
    ($($Kernel:ident $name:literal),*) => {$(
        kernels_on_lanes::<_, 1>(&meshfree::kernel::$Kernel);
        kernels_on_lanes::<_, 2>(&meshfree::kernel::$Kernel);
        kernels_on_lanes::<_, 3>(&meshfree::kernel::$Kernel);
    )*};
}

fn kernels_on_lanes<K: Kernel<D>, const D: usize>(kernel: &K) {
    let name = format!("{} in {D}D", kernel.name());
    let record = Record::of(3, |given| text(kernel, given)).unwrap();
    kernel_follows::<f64, f64>(&name, &record, &|given| text(kernel, given));
    kernel_follows::<f64, Fused>(&name, &record, &|given| text(kernel, given));
    kernel_follows::<f32, Single>(&name, &record, &|given| text(kernel, given));
}

#[test]
fn the_record_of_a_kernel_has_its_bits_on_every_lane() {
    meshfree::for_each_kernel!(kernels);
}

/// Reads an own stress on both sides: f (σᵢ + σⱼ)·r.
#[derive(Clone, Debug)]
struct Stress;

const STRESS: Field = Field::tensor(name!("stress", "Pa"));
const TRACTION: Output = Output::vector(name!("traction", "N"));

impl<const D: usize> Term<D> for Stress {
    const NAME: &'static str = "tests::stress";
    const READS: Fields = Fields::of(&[STRESS]);
    const WRITES: Outputs = Outputs::of(&[TRACTION]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let stress = pair.i_tensor(STRESS).plus(L::one(), &pair.j_tensor(STRESS));
        let traction = stress.dot(&pair.r);
        for d in 0..D {
            sums.add_at(TRACTION, d, pair.f * traction[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "stress".into(),
            equation: "F (σᵢ + σⱼ)·r",
            source: "",
        }
    }
}

#[inline(never)]
fn tensors_on_both_sides<const D: usize>()
where
    KernelKind: Kernel<D>,
{
    let r = [0.3, -0.4, 0.2];
    let sides = [
        [1.0, 2.0, 3.0, 0.4, 0.5, 0.6],
        [-2.0, 0.5, 1.5, -0.1, 0.3, 0.2],
    ];
    let field = |side: usize| {
        move |field: Field, k: usize| match field {
            Field::POSITION if side == 0 => r[k],
            STRESS => sides[side][k],
            Field::SMOOTHING_LENGTH => 1.0,
            _ => 0.0,
        }
    };
    let kernel = KernelKind::CubicSpline;
    let found = probe::<f64, D, _, _>(&Stress, &kernel, field(0), field(1));
    // The rows of xx, yy, zz, yz, xz, xy.
    let places = [[0, 5, 4], [5, 1, 3], [4, 3, 2]];
    let distance = (0..D).map(|d| r[d] * r[d]).sum::<f64>().sqrt();
    let f = Kernel::<D>::normalisation(&kernel) * Kernel::<D>::slope_over_q(&kernel, distance);
    for d in 0..D {
        let traction: f64 = (0..D)
            .map(|c| (sides[0][places[d][c]] + sides[1][places[d][c]]) * r[c])
            .sum();
        common::assert_close(found.sum(TRACTION, d), f * traction, 1e-15, "traction");
    }
}

#[test]
fn an_own_tensor_is_read_on_both_sides_of_a_pair() {
    tensors_on_both_sides::<1>();
    tensors_on_both_sides::<2>();
    tensors_on_both_sides::<3>();
}
