//! Sweeps against sums written out by hand, over all pairs of a small scene.
//! Here for forces in any direction, in each pass.

use super::*;
use crate::integrator::KickDriftKick;
use crate::kernel::{Kernel, WendlandC2};
use crate::material::catalogue;
use crate::name;
use crate::neighbors::{Block, ClusterLists, Radii, SearchInput};
use crate::particles::{Columns, Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::scene::{Body, Scene};
use crate::scheme::{EnergyForm, SchemeBuilder};
use crate::term::viscosity::{ArtificialViscosity, Viscous};
use crate::term::{InternalEnergy, Layout, Pair, PressureForce, Sums, Term, TermDoc};

/// F = k mᵢ mⱼ F A r with a symmetric matrix A: opposite for the two, and off the line of centres.
#[derive(Clone, Copy, Debug)]
struct Oblique {
    strength: f64,
}

const DIRECTIONS: [[f64; 2]; 2] = [[0.4, 1.1], [1.1, -0.7]];

impl Oblique {
    #[inline(always)]
    fn force<L: Lane>(self, masses: L, f: L, r: [L; 2]) -> [L; 2] {
        let factor = masses * f * L::of(self.strength);
        DIRECTIONS.map(|[x, y]| factor * (r[0] * L::of(x) + r[1] * L::of(y)))
    }
}

impl Term<2> for Oblique {
    const NAME: &'static str = "meshfree::oblique";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::MASS]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 2, P>, sums: &mut Sums<L, 2, P>) {
        let masses = pair.i(Field::MASS) * pair.j(Field::MASS);
        let force = self.force(masses, pair.f, pair.r);
        // Both ways to say it.
        sums.force.add(0, force[0]);
        sums.add_at(Output::FORCE, 1, force[1]);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "oblique force".into(),
            equation: "F = k mᵢ mⱼ F A r",
            source: "",
        }
    }
}

const H: f64 = 1.3;

/// 36 particles off their lattice, each moving on its own.
fn particles() -> Columns<f64, 2> {
    let fields = [
        Field::POSITION,
        Field::VELOCITY,
        Field::MEAN_VELOCITY,
        Field::MEAN_ACCELERATION,
        Field::MASS,
        Field::WEIGHT,
        Field::PRESSURE_COEFFICIENT,
    ];
    // The last cluster is filled up with its last particle, as in a simulation.
    let mut columns = Columns::new(Fields::of(&fields), 40);
    for slot in 0..40 {
        let k = slot.min(35);
        let noise = |n: f64| (1e4 * (k as f64 + n).sin()).fract();
        columns.vectors_mut(Field::POSITION)[slot] = [
            (k % 6) as f64 + 0.2 * noise(0.1),
            (k / 6) as f64 + 0.2 * noise(0.2),
        ];
        columns.vectors_mut(Field::VELOCITY)[slot] = [noise(0.3), noise(0.4)];
        columns.vectors_mut(Field::MEAN_VELOCITY)[slot] = [noise(0.5), noise(0.6)];
        columns.vectors_mut(Field::MEAN_ACCELERATION)[slot] = [noise(1.1), noise(1.2)];
        columns.raw_mut(Field::MASS)[slot] = 1.0 + 0.5 * noise(0.7);
        columns.raw_mut(Field::WEIGHT)[slot] = 1.0 + 0.5 * noise(0.8);
        columns.raw_mut(Field::PRESSURE_COEFFICIENT)[slot] = noise(0.9);
    }
    columns
}

#[test]
fn a_free_force_counts_in_force_power_and_work() {
    let columns = particles();
    let oblique = Oblique { strength: 0.8 };
    let sweep = FusedKernel::<_, _>::new(WendlandC2, (oblique, PressureForce, InternalEnergy));
    let sweep: &dyn PairSweep<f64, 2> = &sweep;
    let blocks = [Block {
        slots: 0..36,
        wall: false,
    }];
    let mut lists = ClusterLists::default();
    lists.rebuild(&SearchInput {
        positions: columns.vectors(Field::POSITION),
        radii: Radii::Uniform(2.0 * H),
        blocks: &blocks,
        listed: &[],
        width: 8,
        slots: 40,
        skin: 0.1,
        instructions: InstructionSet::detect(),
    });
    let input = SweepInput {
        columns: &columns,
        ghosts: None,
        images: &[],
        transforms: &[],
        lists: &lists,
        blocks: &blocks,
        interactions: &[Interaction::Bonded],
        smoothing_length: H,
        targets: 0..36,
        among: None,
        goes_on: false,
        body_force: [0.0; 2],
        lattice_consistency_factor: 1.0,
        instructions: InstructionSet::detect(),
        root: Root::detect(),
    };
    let (mut records, mut rates, mut works) =
        (Records::default(), Results::default(), Results::default());
    sweep.pack(Pass::Rates, &input, &mut records);
    sweep.run(Pass::Rates, &input, &records, &mut rates);
    sweep.pack(Pass::Work, &input, &mut records);
    sweep.run(Pass::Work, &input, &records, &mut works);

    let at = |field: Field, slot: usize| columns.vectors(field)[slot];
    let one = |field: Field, slot: usize| columns.raw(field)[slot];
    let between =
        |field: Field, i: usize, j: usize| [0, 1].map(|d| at(field, i)[d] - at(field, j)[d]);
    let norm = Kernel::<2>::normalisation(&WendlandC2) / H.powi(4);
    // How much of the power the oblique force has: if it were lost, the sums would be off by so much.
    let (mut oblique_power, mut oblique_work) = (0.0_f64, 0.0_f64);
    for i in 0..36 {
        let (mut force, mut power, mut work, mut gained) = ([0.0; 2], 0.0, 0.0, 0.0);
        for j in (0..36).filter(|&j| j != i) {
            let r = between(Field::POSITION, i, j);
            let f = norm * Kernel::<2>::slope_over_q(&WendlandC2, r[0].hypot(r[1]) / H);
            let free = oblique.force(one(Field::MASS, i) * one(Field::MASS, j), f, r);
            let stress = one(Field::PRESSURE_COEFFICIENT, i) + one(Field::PRESSURE_COEFFICIENT, j);
            let pressure = one(Field::WEIGHT, i) * one(Field::WEIGHT, j) * stress * f;
            let (v, mean) = (
                between(Field::VELOCITY, i, j),
                between(Field::MEAN_VELOCITY, i, j),
            );
            let acceleration = between(Field::MEAN_ACCELERATION, i, j);
            for d in 0..2 {
                let pair = free[d] - pressure * r[d];
                force[d] += pair;
                power -= 0.5 * pair * v[d];
                work -= 0.5 * pair * mean[d];
                gained -= 0.5 * pair * acceleration[d];
                oblique_power += (free[d] * v[d]).abs();
                oblique_work += (free[d] * mean[d]).abs();
            }
        }
        let found = rates.vector(Output::FORCE, i);
        let off = [
            found[0] - force[0],
            found[1] - force[1],
            rates.get(Output::POWER, 0, i) - power,
            works.get(Output::POWER, 0, i) - work,
            works.get(Output::POWER_OF_ACCELERATION, 0, i) - gained,
        ];
        assert!(off.iter().all(|off| off.abs() < 1e-13), "{i}: {off:?}");
    }
    assert!(oblique_power > 1.0 && oblique_work > 1.0);
}

/// The oblique force as part of a viscosity, which a scheme takes.
#[derive(Clone, Debug)]
struct ObliqueViscosity(Oblique);

impl ArtificialViscosity<2> for ObliqueViscosity {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, 2, P>) -> Viscous<L> {
        Viscous {
            pi: L::zero(),
            signal: L::zero(),
        }
    }
    #[inline(always)]
    fn sums<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 2, P>, sums: &mut Sums<L, 2, P>) {
        let masses = pair.i(Field::MASS) * pair.j(Field::MASS);
        sums.force += self.0.force(masses, pair.f, pair.r);
    }
    fn document(&self) -> TermDoc {
        Term::document(&self.0)
    }
}

/// Kinetic energy at the end \[J\], and the error of the total energy beside the larger kinetic one.
fn energy_after_a_run(strength: f64) -> (f64, f64) {
    let scheme = SchemeBuilder::new(WendlandC2, ObliqueViscosity(Oblique { strength }))
        .energy(EnergyForm::Compatible);
    let size = 8e-3;
    let mut simulation = Scene::<f64, 2>::new(scheme)
        .body(
            Body::block("sheet", catalogue::copper(), [0.0; 2], [size; 2], 1e-3).start(
                |x, start| crate::scene::Start {
                    velocity: [20.0 * (x[1] / size).sin(), -10.0 * x[0] / size],
                    ..start
                },
            ),
        )
        .integrator(KickDriftKick)
        .build()
        .unwrap();
    let before = simulation.ledger().whole;
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let after = simulation.ledger().whole;
    let scale = after.kinetic.max(before.kinetic);
    (
        after.kinetic,
        (after.total_energy() - before.total_energy()) / scale,
    )
}

#[test]
fn a_free_force_conserves_total_energy_to_rounding_in_the_compatible_form() {
    let (without, error) = energy_after_a_run(0.0);
    assert!(error.abs() < 1e-12, "{error:e}");
    let (with, error) = energy_after_a_run(20.0);
    assert!(error.abs() < 1e-12, "{error:e}");
    println!("kinetic energy {without} J without, {with} J with");
    // Its work is what would be missing.
    assert!((with / without - 1.0).abs() > 1e-3, "{with} {without}");
}

/// What carries a stress: the force Vᵢ Vⱼ (σᵢ + σⱼ)·∇W.
#[derive(Clone, Copy, Debug)]
struct StressForce;

const STRESS: Field = Field::tensor(name!("stress", "Pa"));

impl Term<2> for StressForce {
    const NAME: &'static str = "meshfree::stress_force";
    const READS: Fields = Fields::of(&[Field::WEIGHT, STRESS]);
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, 2, P>, sums: &mut Sums<L, 2, P>) {
        let volumes = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT);
        let stress = pair.i_tensor(STRESS).plus(L::one(), &pair.j_tensor(STRESS));
        let traction = stress.dot(&pair.r);
        sums.force += traction.map(|t| volumes * pair.f * t);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "force of a stress".into(),
            equation: "Vᵢ Vⱼ (σᵢ + σⱼ)·∇W",
            source: "",
        }
    }
}

/// The force between two blocks side by side along x, of eight particles each, that both carry `stress`.
fn across(stress: [f64; 6], interaction: Interaction) -> [f64; 2] {
    let mut columns =
        Columns::<f64, 2>::new(Fields::of(&[Field::POSITION, Field::WEIGHT, STRESS]), 16);
    for slot in 0..16 {
        // Two columns of four on either side of x = 2.
        let (side, k) = (slot / 8, slot % 8);
        columns.vectors_mut(Field::POSITION)[slot] =
            [(2 * side + k / 4) as f64 + 0.5, (k % 4) as f64];
        columns.raw_mut(Field::WEIGHT)[slot] = 1.0;
        columns.raw_mut(STRESS)[6 * slot..6 * slot + 6].copy_from_slice(&stress);
    }
    let sweep = FusedKernel::<_, _>::new(WendlandC2, (StressForce,));
    let sweep: &dyn PairSweep<f64, 2> = &sweep;
    let block = |slots| Block { slots, wall: false };
    let blocks = [block(0..8), block(8..16)];
    let mut lists = ClusterLists::default();
    lists.rebuild(&SearchInput {
        positions: columns.vectors(Field::POSITION),
        radii: Radii::Uniform(2.0 * H),
        blocks: &blocks,
        listed: &[],
        width: 8,
        slots: 16,
        skin: 0.1,
        instructions: InstructionSet::detect(),
    });
    let input = SweepInput {
        columns: &columns,
        ghosts: None,
        images: &[],
        transforms: &[],
        lists: &lists,
        blocks: &blocks,
        interactions: &[
            Interaction::Bonded,
            interaction,
            interaction,
            Interaction::Bonded,
        ],
        smoothing_length: H,
        targets: 0..16,
        among: None,
        goes_on: false,
        body_force: [0.0; 2],
        lattice_consistency_factor: 1.0,
        instructions: InstructionSet::detect(),
        root: Root::detect(),
    };
    let (mut records, mut rows) = (Records::default(), Results::default());
    sweep.pack(Pass::Rates, &input, &mut records);
    sweep.run(Pass::Rates, &input, &records, &mut rows);
    let forces: Vec<_> = rows.reactions().collect();
    assert_eq!(forces.len(), 2);
    for d in 0..2 {
        let sum = forces[0].force[d] + forces[1].force[d];
        assert!(sum.abs() < 1e-14, "not opposite: {forces:?}");
    }
    forces[0].force
}

#[test]
fn a_stress_presses_across_a_contact_that_opens_and_does_not_pull() {
    let along = |xx: f64| [xx, 0.0, 0.0, 0.0, 0.0, 0.0];
    let (bonded, open) = (Interaction::Bonded, Interaction::Unilateral);
    let pulled = across(along(2.0), bonded);
    assert!(pulled[0] > 1.0, "{pulled:?}");
    assert_eq!(across(along(2.0), open), [0.0; 2]);
    assert_eq!(across(along(-2.0), open), across(along(-2.0), bonded));
    // A shear is a pull and a push, crosswise: only the push is left, and half of it is normal.
    let shear = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let push = [-0.5, -0.5, 0.0, 0.0, 0.0, 0.5];
    let (found, expected) = (across(shear, open), across(push, bonded));
    for d in 0..2 {
        assert!((found[d] - expected[d]).abs() < 1e-13, "{found:?}");
    }
}

#[test]
fn what_unwinds_leaves_no_sums_behind() {
    fn leaves_none<T: Real>() {
        let broken = std::panic::catch_unwind(|| {
            T::with_room(64, &mut |room| {
                room.fill(T::one());
                panic!("a term of a user's own");
            });
        });
        assert!(broken.is_err());
        T::with_room(64, &mut |room| {
            assert!(room.iter().all(|own| own.is_zero()));
        });
    }
    leaves_none::<f64>();
    leaves_none::<f32>();
}
