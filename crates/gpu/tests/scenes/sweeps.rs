//! A whole sweep of a liquid in space, on the device against the loop of the host, over the host's lists.
//! Disordered particles; a body and a wall; the same bits twice and for any size of work groups.

use crate::common::{Random, device, in_any_groups};
use meshfree::kernel::WendlandC2;
use meshfree::neighbors::{Block, ClusterLists, Radii, SearchInput};
use meshfree::particles::{Columns, Field};
use meshfree::scalar::{Lane, Real};
use meshfree::sweep::{
    FusedKernel, InstructionSet, Interaction, PairRecord, PairSweep, Pass, Records, Results, Root,
    SweepInput,
};
use meshfree::term::viscosity::MonaghanGingold;
use meshfree::term::{Fourtakas, PressureForce, Viscosity, parts::Compression};
use meshfree_gpu::{Device, Dialect, Error, Language, PairKernel, PairLists, Precision, Shared};

const H: f64 = 1.5;
const SIDES: [usize; 3] = [9, 9, 8];
/// The lattice consistency factor, and what accelerates all.
const FACTOR: f64 = 0.98;
const GRAVITY: [f64; 3] = [0.0, 0.3, -9.81];

type Sweep = FusedKernel<
    WendlandC2,
    (
        PressureForce,
        Viscosity<MonaghanGingold>,
        Compression,
        Fourtakas,
    ),
>;

fn sweep() -> Sweep {
    let viscosity = MonaghanGingold {
        alpha: 0.02,
        beta: 1.0,
    };
    let terms = (
        PressureForce,
        Viscosity(viscosity),
        Compression,
        Fourtakas::default(),
    );
    FusedKernel::new(WendlandC2, terms)
}

fn pair<T: Real>() -> PairRecord {
    let own = PairSweep::<T, 3>::record(&sweep(), Pass::Rates, false);
    own.expect("terms in lanes")
}

/// 5184 particles far from their lattice, of which the last eighth is a wall.
struct Scene<T> {
    columns: Columns<T, 3>,
    lists: ClusterLists,
    blocks: [Block; 2],
    width: usize,
}

impl<T: Real> Scene<T> {
    fn new() -> Self {
        let mut random = Random(3);
        let mut positions = Vec::new();
        for block in 0..SIDES.iter().product::<usize>() {
            let corner = [
                block % SIDES[0],
                block / SIDES[0] % SIDES[1],
                block / (SIDES[0] * SIDES[1]),
            ];
            for k in 0..8_usize {
                let cell = [k & 1, k >> 1 & 1, k >> 2];
                let own = |d: usize| (2 * corner[d] + cell[d]) as f64 + 0.4 * random.sign();
                positions.push([0, 1, 2].map(own));
            }
        }
        let slots = positions.len();
        let fields = PairSweep::<T, 3>::fields(&sweep());
        let mut columns = Columns::<T, 3>::new(fields, slots);
        for field in columns.fields().iter() {
            for (k, value) in columns.raw_mut(field).iter_mut().enumerate() {
                *value = T::from_f64(match field {
                    Field::POSITION => positions[k / 3][k % 3],
                    Field::POSITION_RESIDUAL => 1e-8 * random.sign(),
                    Field::VELOCITY => random.sign(),
                    Field::DENSITY => 1000.0 + 5.0 * random.sign(),
                    Field::SOUND_SPEED => 30.0,
                    Field::PRESSURE_COEFFICIENT | Field::PRESSURE => 4500.0 * random.sign(),
                    _ => 1.0 + 0.01 * random.sign(),
                });
            }
        }
        let width = <T::Wide<false> as Lane>::WIDTH;
        let water = slots / 8 * 7 / width * width;
        let blocks =
            [(0..water, false), (water..slots, true)].map(|(slots, wall)| Block { slots, wall });
        let mut lists = ClusterLists::default();
        lists.rebuild(&SearchInput {
            positions: columns.vectors(Field::POSITION),
            radii: Radii::Uniform(2.0 * H),
            blocks: &blocks,
            listed: &[],
            width,
            slots,
            skin: 0.2,
            instructions: InstructionSet::detect(),
        });
        Self {
            columns,
            lists,
            blocks,
            width,
        }
    }

    /// The sums of the host, side by side for each particle.
    fn on_host(&self, pair: &PairRecord) -> Vec<f64> {
        let interactions = [Interaction::Bonded; 4];
        let slots = self.columns.slots();
        let input = SweepInput {
            columns: &self.columns,
            ghosts: None,
            images: &[],
            transforms: &[],
            lists: &self.lists,
            blocks: &self.blocks,
            interactions: &interactions,
            smoothing_length: H,
            targets: 0..slots,
            among: None,
            goes_on: false,
            body_force: GRAVITY.map(T::from_f64),
            lattice_consistency_factor: FACTOR,
            instructions: InstructionSet::detect(),
            root: Root::Divider,
        };
        let (mut records, mut rows) = (Records::default(), Results::default());
        let sweep = sweep();
        sweep.pack(Pass::Rates, &input, &mut records);
        sweep.run(Pass::Rates, &input, &records, &mut rows);
        let mut all = Vec::new();
        for slot in 0..slots {
            for output in pair.writes.iter() {
                all.extend((0..output.components(3)).map(|k| rows.get(output, k, slot).to_f64()));
            }
        }
        all
    }

    /// What the pairs read, side by side for each particle.
    fn records(&self, pair: &PairRecord) -> Vec<f64> {
        let mut all = Vec::new();
        for slot in 0..self.columns.slots() {
            for field in pair.reads.iter() {
                let width = field.components(3);
                let own = &self.columns.raw(field)[slot * width..][..width];
                all.extend(own.iter().map(|value| value.to_f64()));
            }
        }
        all
    }

    fn lists(&self) -> PairLists {
        PairLists::new(self.lists.chunks(), &self.blocks, self.width)
    }

    fn on_device(&self, device: &Device, pair: &PairRecord, precision: Precision) -> Vec<f64> {
        let kernel = PairKernel::new(device, "liquid", pair, (3, self.width), precision);
        let slots = self.columns.slots();
        let kernel = kernel.unwrap_or_else(|error| panic!("{error}"));
        kernel
            .run(
                device,
                (&self.records(pair), slots),
                &self.lists(),
                &shared(),
            )
            .unwrap_or_else(|error| panic!("{error}"))
    }
}

fn shared() -> Shared {
    Shared {
        smoothing_length: H,
        lattice_consistency_factor: FACTOR,
        body_force: GRAVITY.to_vec(),
    }
}

/// The largest difference over the largest value of each sum.
fn differences(found: &[f64], expected: &[f64], width: usize) -> Vec<f64> {
    assert_eq!(found.len(), expected.len());
    let of = |k: usize| {
        let pairs = found.iter().zip(expected).skip(k).step_by(width);
        let (apart, largest) = pairs.fold((0.0f64, 0.0f64), |(apart, largest), (a, b)| {
            (apart.max((a - b).abs()), largest.max(b.abs()))
        });
        assert!(largest > 0.0, "sum {k} is zero");
        apart / largest
    };
    (0..width).map(of).collect()
}

fn check<T: Real>(device: &Device, precision: Precision, most: f64) -> Vec<f64> {
    let scene = Scene::<T>::new();
    let pair = pair::<T>();
    let found = scene.on_device(device, &pair, precision);
    let width = pair.writes.width(3);
    let own = differences(&found, &scene.on_host(&pair), width);
    let neighbours = scene.lists().entries() / (scene.columns.slots() / scene.width);
    println!("{precision:?}: {own:?}, lists of {neighbours}");
    assert!(own.iter().all(|own| *own <= most), "{own:?}");
    // Not the order of neighbours alone: the sums are those of the same scene, and not of one a little beside.
    let mut beside = Scene::<T>::new();
    for x in beside.columns.vectors_mut(Field::POSITION) {
        x[0] *= T::from_f64(1.0 + 1e-4);
    }
    let beside = differences(&found, &beside.on_host(&pair), width);
    assert!(beside.iter().any(|own| *own > most), "{beside:?}");
    found
}

#[test]
fn a_sweep_has_the_forces_of_the_host() {
    let Some(device) = device("a sweep of a liquid") else {
        return;
    };
    check::<f64>(&device, Precision::Double, 1e-12);
    check::<f32>(&device, Precision::Single, 1e-5);
}

#[test]
fn a_sweep_has_the_same_bits_twice_and_in_any_work_groups() {
    let Some(device) = device("bits of a sweep") else {
        return;
    };
    let scene = Scene::<f64>::new();
    let pair = pair::<f64>();
    in_any_groups(device, |device| {
        let sums = scene.on_device(device, &pair, Precision::Double);
        sums.into_iter().map(f64::to_bits).collect()
    });
}

#[test]
fn what_does_not_fit_is_an_error() {
    let Some(device) = device("errors of sweeps") else {
        return;
    };
    let scene = Scene::<f64>::new();
    let pair = pair::<f64>();
    let kernel = PairKernel::new(&device, "liquid", &pair, (3, 8), Precision::Double);
    let kernel = kernel.unwrap_or_else(|error| panic!("{error}"));
    let (records, slots) = (scene.records(&pair), scene.columns.slots());
    let mut flat = shared();
    flat.body_force.pop();
    let all = shared();
    for (few, slots, shared, name) in [
        (&records[1..], slots, &all, "numbers of records"),
        (&records[..], slots - 64, &all, "clusters that have lists"),
        (&records[..], slots, &flat, "numbers of the body force"),
    ] {
        let found = kernel.run(&device, (few, slots), &scene.lists(), shared);
        assert!(
            matches!(found, Err(Error::Size { what, .. }) if what == name),
            "{name}: {found:?}"
        );
    }
    let lesser = device.clone().as_lesser(true, 1024);
    let many = kernel.run(&lesser, (&records, slots), &scene.lists(), &shared());
    assert!(matches!(many, Err(Error::TooLarge { .. })), "{many:?}");
    let unknown = Device::named("no such adapter");
    assert!(
        matches!(unknown, Err(Error::UnknownAdapter { .. })),
        "{unknown:?}"
    );
    assert!(device.with_threads(0).is_err());
}

/// The second language is written by the same walk. `--test cuda` compiles it.
#[test]
fn the_same_record_is_written_in_cuda() {
    let pair = pair::<f64>();
    let [wgsl, cuda] = [Language::Wgsl, Language::Cuda].map(|language| {
        let precision = Precision::Double;
        PairKernel::source(
            &pair,
            (3, 8),
            Dialect {
                language,
                precision,
            },
        )
    });
    let operations = |text: &str, declares: &str| text.matches(declares).count();
    let made = operations(&wgsl, "let t");
    assert!(made > 60, "{made}");
    assert_eq!(
        made,
        operations(&cuda, "const double t") + operations(&cuda, "const bool t")
    );
    assert!(cuda.contains("sweep(const Scene scene, const double* __restrict__ records"));
    assert!(!cuda.contains("let ") && !cuda.contains("f64"), "{cuda}");
}
