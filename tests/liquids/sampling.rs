//! Fields sampled at points and on grids: what is exact, what is of second order, and what is refused.
//! Scalars, vectors, tensors and matrices, the crate's own and an effect's.

use meshfree::effect::{Effect, NeoHookean, Setting, StepProgram};
use meshfree::material::eos::Linear;
use meshfree::name;
use meshfree::observe::SampleGrid;
use meshfree::prelude::*;

const SPACING: f64 = 0.02;
const STRAIN: Field = Field::tensor(name!("strain", "1"));
const TURN: Field = Field::matrix(name!("turn", "1"));

/// Fields that nothing changes.
#[derive(Clone, Copy, Debug)]
struct Marks;

impl<const D: usize> Effect<D> for Marks {
    type Terms = ();
    fn terms(&self, _: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(STRAIN, 0.0);
        program.declare(TURN, 0.0);
    }
}

/// A unit square of liquid: velocity, strain and turn are linear in place, or constant.
fn square(slope: f64) -> Simulation<f64, 2> {
    let water = catalogue::weakly_compressible_water(20.0);
    let body = Body::block("water", water, [0.0; 2], [1.0; 2], SPACING)
        .field(STRAIN, move |x| {
            [0, 1, 2, 3, 4, 5].map(|k| tensor(slope, x, k))
        })
        .field(TURN, move |x| [0, 1, 2, 3].map(|k| -tensor(slope, x, k)))
        .start(move |x, start| meshfree::scene::Start {
            velocity: velocity(slope, x),
            ..start
        });
    let scene = Scene::new(schemes::weakly_compressible().with(Marks)).body(body);
    scene.build().expect("a square")
}

fn velocity(slope: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [3.0 + slope * (x - 2.0 * y), -2.0 + slope * x]
}

fn tensor(slope: f64, [x, y]: [f64; 2], component: u8) -> f64 {
    1.0 + f64::from(component) + slope * (x + f64::from(component) * y)
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(0.0, f64::max)
}

#[test]
fn a_constant_is_exact_up_to_the_rim_and_beyond() {
    let square = square(0.0);
    let grid = SampleGrid::between([-0.06; 2], [1.06; 2], [57, 57]).expect("a grid");
    let sample = square
        .sample_grid(Field::VELOCITY, &grid)
        .expect("velocities");
    let (mut wet, mut off) = (0, 0.0_f64);
    for k in (0..sample.len()).filter(|&k| sample.filling()[k] > 0.0) {
        let v = sample.vector(k).expect("a vector");
        off = off.max(largest([v[0] - 3.0, v[1] + 2.0]));
        wet += 1;
    }
    assert!(wet > 50 * 50 && off < 1e-13, "{wet} {off}");
}

/// What is linear is exact where the lattice lies evenly around a point, off by 5e-5 elsewhere inside where it grows
/// by 0.02 from particle to particle, and on a face it is that of 0.7 spacings inside.
#[test]
fn what_is_linear_is_read_as_it_is() {
    let square = square(1.0);
    let off_at = |x: f64, y: f64| {
        let point = [x, y];
        let sample = |field| square.sample(field, &[point]).expect("a sample");
        let [v, strain, turn] = [Field::VELOCITY, STRAIN, TURN].map(sample);
        let v = v.vector(0).expect("a vector");
        let strain = *strain.tensor(0).expect("a tensor").components();
        let turn = turn.at(0).expect("a matrix");
        let wanted = velocity(1.0, point);
        let wanted_at = |k: usize| tensor(1.0, point, k as u8);
        let off_v = (0..2).map(|d| v[d] - wanted[d]);
        let off_strain = (0..6).map(|k| strain[k] - wanted_at(k));
        let off_turn = (0..4).map(|k| turn[k] + wanted_at(k));
        largest(off_v.chain(off_strain).chain(off_turn))
    };
    // A particle, a middle of four, a middle of two.
    for [x, y] in [[0.51, 0.33], [0.5, 0.32], [0.5, 0.33]] {
        assert!(off_at(x, y) < 1e-14, "{} at {x} m, {y} m", off_at(x, y));
    }
    assert!(off_at(0.504, 0.3371) < 1e-4, "{}", off_at(0.504, 0.3371));
    let top = square
        .sample(Field::VELOCITY, &[[0.5, 1.0]])
        .expect("velocities");
    let inside = 0.5 * (top.at(0).expect("a vector")[0] - velocity(1.0, [0.5, 1.0])[0]);
    assert!((inside / SPACING - 0.69).abs() < 0.02, "{inside} m");
}

#[test]
fn a_grid_reads_what_its_points_read_and_knows_what_is_dry() {
    let square = square(1.0);
    let grid = SampleGrid::between([-0.5, 0.13], [1.5, 0.97], [21, 7]).expect("a grid");
    let whole = square
        .sample_grid(Field::VELOCITY, &grid)
        .expect("velocities");
    for (k, point) in grid.points().into_iter().enumerate() {
        let one = square
            .sample(Field::VELOCITY, &[point])
            .expect("a velocity");
        let (filling, dry) = (whole.filling()[k], !(-0.05..1.05).contains(&point[0]));
        assert!((filling - one.filling()[0]).abs() < 1e-13);
        assert_eq!(filling == 0.0, dry, "{point:?}");
        let [own, alone] = [&whole, &one].map(|sample| sample.components() * sample.len());
        assert_eq!((own, alone), (2 * 147, 2));
        let pair = whole.vector(k).zip(one.vector(0)).expect("vectors");
        let near = |d: usize| (pair.0[d] - pair.1[d]).abs() < 1e-13;
        assert!(if dry {
            pair.0[0].is_nan()
        } else {
            near(0) && near(1)
        });
    }
    let inner = square.sample(Field::DENSITY, &[[0.5; 2], [0.504, 0.3371], [0.5, 0.0]]);
    let inner = inner.expect("densities");
    let [middle, any, face] = [0, 1, 2].map(|k| inner.filling()[k]);
    assert!(largest([middle - 1.0, any - 1.0, face - 0.5]) < 0.006);
    assert!((inner.scalar(1).expect("a scalar") / 1000.0 - 1.0).abs() < 1e-14);
    assert!(inner.vector(0).is_none() && inner.scalar(3).is_none());
}

#[test]
fn what_cannot_be_sampled_is_refused_by_name() {
    let square = square(0.0);
    let message = |field, point| {
        let refused = square.sample(field, &[[0.0; 2], point]);
        refused.expect_err("no sample").to_string()
    };
    let listed = "there is no field called `energy`: the scene has position, velocity,";
    assert!(message(Field::ENERGY, [0.0; 2]).starts_with(listed));
    let dye = Field::scalar(name!("dye", "1"));
    assert!(message(dye, [0.0; 2]).contains("`meshfree::dye`"));
    let at = message(Field::VELOCITY, [0.0, f64::NAN]);
    assert!(
        at.contains("coordinate 1 of point 1") && at.contains("NaN"),
        "{at}"
    );
}

/// Behind a mirror both are mirrored, so an unmoved body is where it was built, far from zero as well.
#[test]
fn places_as_built_are_read_behind_mirrors_too() {
    let soft = meshfree::material::Material::new("soft", Linear::new(1000.0, 50.0));
    let soft = soft.with_shear_modulus(7e5);
    let body = Body::<f64, 2>::block("block", soft, [1e3, 0.0], [1000.2, 0.2], SPACING);
    let block = Scene::new(schemes::total_lagrangian().with(NeoHookean))
        .body(body)
        .boundary(MirrorPlane::symmetry([1e3, 0.0], [-1.0, 0.0]))
        .build()
        .expect("a block");
    let points = [[1000.001, 0.1], [1000.013, 0.05], [1000.1, 0.1]];
    let [built, now] = [Field::REFERENCE_POSITION, Field::POSITION]
        .map(|field| block.sample(field, &points).expect("places"));
    for point in 0..points.len() {
        let [built, now] = [&built, &now].map(|own| own.at(point).expect("a place"));
        let off = largest((0..2).map(|d| built[d] - now[d]));
        assert!(off < 1e-9, "{built:?} {now:?}");
    }
}
