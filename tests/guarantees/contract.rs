//! The contract that every pair term keeps: symmetric forces, finite at distance zero, nothing beyond
//! the support, the same in lanes as in scalars, and no field or sum that is not declared.

use crate::common::{self, AnyKernel, Random};
use meshfree::kernel::{Kernel, KernelKind};
use meshfree::particles::{Field, Output};
use meshfree::scalar::{Lane, Lanes};
use meshfree::term::viscosity::{
    Balsara, CullenDehnen, Inviscid, LimitedMonaghanGingold, MonaghanGingold, MorrisMonaghan,
    Riemann, SignalVelocity,
};
use meshfree::term::{
    Antuono, CentralViscosity, Compression, Crowding, DensityGradient, Fourtakas, InternalEnergy,
    KernelMoment, KernelSum, LaminarViscosity, LiquidNearWall, Molteni, PressureCurvature,
    PressureForce, PressureGradient, Probe, RenormalisedCompression, RiemannDiffusion, SlopeInH,
    Term, Unity, VelocityAtWall, VelocityGradient, Viscosity, ViscosityAtWall, probe,
};

macro_rules! for_each_viscosity_of {
    ($check:ident, $D:literal, $($Law:ident),*) => {
        $($check::<$D, _>(Viscosity($Law::default()));)*
    };
}

macro_rules! count {
    ($($Law:ident $name:literal),*) => { [$($name),*].len() };
}

#[test]
fn the_list_has_every_viscosity() {
    assert_eq!(
        meshfree::for_each_viscosity!(count),
        8,
        "add it to the list below"
    );
}

/// Every term of the crate that acts along rᵢⱼ or vᵢⱼ; each test below runs over this list in all
/// dimensions. Forces in other directions are held to what they conserve (`liquid_conservation`).
macro_rules! for_each_term {
    ($check:ident) => {{
        for_each_term!($check, 1);
        for_each_term!($check, 2);
        for_each_term!($check, 3);
    }};
    ($check:ident, $D:literal) => {{
        $check::<$D, _>(PressureForce);
        $check::<$D, _>(PressureCurvature {
            strength: 1.0 / 3.0,
        });
        $check::<$D, _>(InternalEnergy);
        $check::<$D, _>(KernelSum);
        $check::<$D, _>(Unity);
        $check::<$D, _>(KernelMoment);
        $check::<$D, _>(SlopeInH);
        $check::<$D, _>(Compression);
        $check::<$D, _>(VelocityGradient);
        $check::<$D, _>(PressureGradient);
        $check::<$D, _>(DensityGradient);
        $check::<$D, _>(LaminarViscosity);
        $check::<$D, _>(CentralViscosity);
        $check::<$D, _>(Molteni::default());
        $check::<$D, _>(Fourtakas::default());
        $check::<$D, _>(Antuono::default());
        $check::<$D, _>(RiemannDiffusion);
        $check::<$D, _>(Crowding::<$D> {
            repulsion: 0.2,
            at_spacing: 1.0,
        });
        $check::<$D, _>(LiquidNearWall);
        $check::<$D, _>(VelocityAtWall);
        $check::<$D, _>(ViscosityAtWall);
        $check::<$D, _>(RenormalisedCompression);
        for_each_viscosity_of!(
            $check,
            $D,
            Inviscid,
            MonaghanGingold,
            LimitedMonaghanGingold,
            SignalVelocity,
            Balsara,
            MorrisMonaghan,
            CullenDehnen,
            Riemann
        );
    }};
}

const WIDTH: usize = 8;

/// A particle with a random value in every field, at most `apart` from the origin along each axis.
#[derive(Clone)]
struct Particle(Vec<Vec<f64>>);

impl Particle {
    fn random(random: &mut Random, apart: f64) -> Self {
        let fields = Field::ALL.iter().map(|&field| {
            (0..field.components(3))
                .map(|_| match field {
                    Field::Position => apart * random.sign(),
                    Field::PositionResidual => 0.0,
                    Field::SmoothingLength => 1.0 + 0.1 * random.sign(),
                    Field::Velocity
                    | Field::MeanVelocity
                    | Field::VelocityGradient
                    | Field::PressureGradient
                    | Field::Divergence
                    | Field::Pressure
                    | Field::PressureCoefficient => random.sign(),
                    _ => 1.5 + random.sign(),
                })
                .collect()
        });
        Self(fields.collect())
    }
    fn get(&self, field: Field, k: usize) -> f64 {
        self.0[field as usize][k]
    }
    fn set(&mut self, field: Field, k: usize, value: f64) {
        self.0[field as usize][k] = value;
    }
}

/// Compiled once for all tests.
#[inline(never)]
fn scalar<const D: usize, A: Term<D>>(
    term: &A,
    kernel: KernelKind,
    i: &Particle,
    j: &Particle,
) -> Probe<f64, D>
where
    KernelKind: Kernel<D>,
{
    let kernel = AnyKernel(kernel);
    probe(term, &kernel, |f, k| i.get(f, k), |f, k| j.get(f, k))
}

fn numbers<L: Lane, const D: usize>(probe: &Probe<L, D>) -> Vec<L> {
    let sums = Output::ALL
        .iter()
        .flat_map(|&output| (0..output.components(D)).map(move |k| probe.sum(output, k)));
    [probe.radial, probe.shear]
        .into_iter()
        .chain(sums)
        .collect()
}

fn name<const D: usize, A: Term<D>>(term: &A) -> String {
    format!("{} in {D}D", term.document().name)
}

fn forces_are_symmetric<const D: usize, A: Term<D>>(term: A)
where
    KernelKind: Kernel<D>,
{
    let mut random = Random(1);
    let mut acted = false;
    for round in 0..200 {
        let kernel = common::kernel(round);
        let (i, j) = (
            Particle::random(&mut random, 0.8),
            Particle::random(&mut random, 0.8),
        );
        let (there, back) = (scalar(&term, kernel, &i, &j), scalar(&term, kernel, &j, &i));
        for (a, b) in [(there.radial, back.radial), (there.shear, back.shear)] {
            acted |= a != 0.0;
            assert!(
                (a - b).abs() <= 1e-14 * (1.0 + a.abs()),
                "{}: {a} and {b}",
                name(&term)
            );
        }
    }
    let force = A::WRITES.contains(Output::Force);
    let silent = term.document().name == "no artificial viscosity";
    assert_eq!(
        acted,
        force && !silent,
        "{} declares a force: {force}",
        name(&term)
    );
}

#[test]
fn the_force_on_i_is_the_opposite_of_that_on_j() {
    for_each_term!(forces_are_symmetric);
}

fn finite_on_itself<const D: usize, A: Term<D>>(term: A)
where
    KernelKind: Kernel<D>,
{
    let mut random = Random(2);
    for round in 0..100 {
        let i = Particle::random(&mut random, 1.0);
        // The particle itself, and another one in its place.
        let mut j = Particle::random(&mut random, 1.0);
        for k in 0..3 {
            j.set(Field::Position, k, i.get(Field::Position, k));
        }
        for j in [&i, &j] {
            let result = scalar(&term, common::kernel(round), &i, j);
            let finite = numbers(&result).iter().all(|x| x.is_finite());
            assert!(finite, "{}: {result:?}", name(&term));
        }
    }
}

#[test]
fn everything_is_finite_at_distance_zero() {
    for_each_term!(finite_on_itself);
}

fn nothing_beyond<const D: usize, A: Term<D>>(term: A)
where
    KernelKind: Kernel<D>,
{
    let mut random = Random(3);
    for &kernel in KernelKind::ALL {
        for stretch in [1.0 + 1e-12, 1.001, 2.0, 1e6, 1e100] {
            let mut i = Particle::random(&mut random, 1.0);
            let mut j = Particle::random(&mut random, 1.0);
            let h = 0.5 * (i.get(Field::SmoothingLength, 0) + j.get(Field::SmoothingLength, 0));
            for k in 0..3 {
                i.set(Field::Position, k, 0.0);
                j.set(Field::Position, k, 0.0);
            }
            let away = Kernel::<D>::support(&kernel) * h * stretch;
            j.set(Field::Position, D - 1, away);
            let result = scalar(&term, kernel, &i, &j);
            let silent = numbers(&result).iter().all(|&x| x == 0.0);
            assert!(
                silent,
                "{} at {stretch} supports of {kernel}: {result:?}",
                name(&term)
            );
        }
    }
}

#[test]
fn nothing_acts_beyond_the_support() {
    for_each_term!(nothing_beyond);
}

fn lanes_as_scalars<const D: usize, A: Term<D>>(term: A)
where
    KernelKind: Kernel<D>,
{
    let mut random = Random(4);
    for round in 0..70 {
        let kernel = AnyKernel(common::kernel(round));
        let row: Vec<_> = (0..WIDTH)
            .map(|_| Particle::random(&mut random, 1.2))
            .collect();
        let j = Particle::random(&mut random, 1.2);
        let lanes: Probe<Lanes<f64, WIDTH, false>, D> = probe(
            &term,
            &kernel,
            |f, k| Lanes::from_fn(|lane| row[lane].get(f, k)),
            |f, k| j.get(f, k),
        );
        let fused: Probe<Lanes<f64, WIDTH, true>, D> = probe(
            &term,
            &kernel,
            |f, k| Lanes::from_fn(|lane| row[lane].get(f, k)),
            |f, k| j.get(f, k),
        );
        for (lane, i) in row.iter().enumerate() {
            let one = numbers(&scalar(&term, kernel.0, i, &j));
            let (lanes, fused) = (numbers(&lanes), numbers(&fused));
            for (k, one) in one.iter().enumerate() {
                assert_eq!(lanes[k].extract(lane), *one, "{}, number {k}", name(&term));
                let off = fused[k].extract(lane) - one;
                // A viscosity of two particles that nearly coincide is large.
                assert!(
                    off.abs() < 1e-12 * one.abs().max(1.0),
                    "{}, number {k}: fused {off}",
                    name(&term)
                );
            }
        }
    }
}

#[test]
fn a_lane_is_the_scalar_to_the_bit_and_a_fused_lane_to_rounding() {
    for_each_term!(lanes_as_scalars);
}

fn declares_what_it_writes<const D: usize, A: Term<D>>(term: A)
where
    KernelKind: Kernel<D>,
{
    let mut random = Random(5);
    for round in 0..100 {
        let (i, j) = (
            Particle::random(&mut random, 0.5),
            Particle::random(&mut random, 0.5),
        );
        let result = scalar(&term, common::kernel(round), &i, &j);
        for &output in Output::ALL {
            let written = (0..output.components(D)).any(|k| result.sum(output, k) != 0.0);
            let declared = A::WRITES.contains(output);
            assert!(
                declared || !written,
                "{} writes {}",
                name(&term),
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
const USED_BY_THE_SWEEP: [Field; 2] = [Field::Velocity, Field::PositionResidual];

fn reads_matter<const D: usize, A: Term<D>>(term: A)
where
    KernelKind: Kernel<D>,
{
    if term.document().name == "no artificial viscosity" {
        return;
    }
    for field in A::READS
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
            let before = numbers(&scalar(&term, kernel, &i, &j));
            let other = Particle::random(&mut random, 0.8);
            for k in 0..field.components(D) {
                i.set(field, k, other.get(field, k));
                j.set(field, k, 0.75 * other.get(field, k));
            }
            before != numbers(&scalar(&term, kernel, &i, &j))
        });
        assert!(
            matters,
            "{} reads {} for nothing",
            name(&term),
            field.name()
        );
    }
}

#[test]
fn every_declared_field_changes_something() {
    for_each_term!(reads_matter);
}
