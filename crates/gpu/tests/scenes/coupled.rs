//! Several schemes in one scene, liquids that meet structures, and clamps, on the device as on the host.
//! Blocks and plates in a tank of water, by their neighbours as built and by the present ones.

use crate::common::{device, in_any_groups};
use crate::compare::{build, in_both, in_double, load, on, on_device, on_host, refused, resumed};
use approx::assert_relative_eq;
use meshfree::boundary::Rotation;
use meshfree::coupling::Coupling;
use meshfree::effect::NeoHookean;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::term::TermDoc;
use std::ops::Range;

const SPACING: f64 = 0.0125;

/// Gravity \[m/s²\].
const G: f64 = 9.81;

/// A body of a material over some columns and rows of particles, in water that fills a tank around it, let go with a spin.
fn in_water<T: Real>(
    [columns, rows]: [Range<usize>; 2],
    solid: impl Into<Scheme<T, 2>>,
    material: Material<T>,
) -> Scene<T, 2> {
    let at = |i: usize, j: usize| [i, j].map(|k| (k as f64 + 0.5) * SPACING);
    let within = |i: usize, j: usize| columns.contains(&i) && rows.contains(&j);
    let all = (0..40).flat_map(|i| (0..24).map(move |j| (i, j)));
    let (block, water): (Vec<_>, Vec<_>) = all.partition(|&(i, j)| within(i, j));
    let [block, water] = [block, water].map(|own| own.into_iter().map(|(i, j)| at(i, j)).collect());
    let spin = |[x, y]: [f64; 2], start| meshfree::scheme::Start {
        velocity: [-2.0 * (y - 0.1375), 2.0 * (x - 0.25)],
        ..start
    };
    let liquid = catalogue::weakly_compressible_water::<T>((2.0 * G * 0.3).sqrt());
    let size = [40.0 * SPACING, 30.0 * SPACING];
    let closed = [[true; 2], [true, false]];
    Scene::new(schemes::weakly_compressible())
        .body(Body::points_of("water", liquid, water, SPACING))
        .group(
            solid,
            [Body::points_of("block", material, block, SPACING).start(spin)],
        )
        .wall(Wall::around("tank", [0.0; 2], size, SPACING, 3, closed))
        .between("block", "tank", Interaction::None)
        .acceleration(|_| [0.0, -G])
}

fn rubber<T: Real>() -> Material<T> {
    Material::new("rubber", Linear::new(1500.0, 30.0)).with_shear_modulus(4e5)
}

/// By its neighbours as built.
fn block<T: Real>(fused: bool) -> Scene<T, 2> {
    let scheme = schemes::total_lagrangian().with(NeoHookean);
    on(in_water([14..26, 8..14], scheme, rubber()), fused)
}

/// By its present neighbours, whose lists are built anew.
fn soft<T: Real>(fused: bool) -> Scene<T, 2> {
    let scheme = schemes::impact_by_continuity().with(Hypoelastic);
    on(in_water([14..26, 8..14], scheme, rubber()), fused)
}

/// A plate across the tank, fixed at one end and turned to and fro at the other.
fn plate<T: Real>(fused: bool) -> Scene<T, 2> {
    let turns = |t: f64| {
        let (size, rate) = (0.01, 100.0);
        let (sine, cosine) = (rate * t).sin_cos();
        [
            size * sine,
            size * rate * cosine,
            -size * rate * rate * sine,
        ]
    };
    let turns = Rotation::about([0.45, 0.15], turns);
    let scheme = schemes::total_lagrangian().with(NeoHookean);
    let scene = in_water([0..40, 10..14], scheme, rubber())
        .fix("block", |x| x[0] < 3.0 * SPACING)
        .clamp("block", |x| x[0] > 37.0 * SPACING, turns);
    on(scene, fused)
}

#[test]
fn a_block_in_water_is_that_of_the_host() {
    let Some(device) = device("a block in water") else {
        return;
    };
    let single = || block::<f32>(false);
    in_both(&device, "Rubber in water", block::<f64>, single, 200);
    in_double(&device, "Soft block in water", soft::<f64>, 200);
    for scene in [block::<f64>, soft::<f64>] {
        let [found, host] = [
            on_device(&device, scene(false), 100),
            on_host(scene(false), 100),
        ];
        let forces = [&found, &host].map(|own| {
            let [on, back] = [["block", "water"], ["water", "block"]]
                .map(|[on, from]| own.force_between(on, from).unwrap());
            assert_relative_eq!(on[1], -back[1], max_relative = 1e-12);
            on
        });
        assert!(forces[1][1] > 1.0);
        assert_relative_eq!(forces[0][1], forces[1][1], max_relative = 1e-9);
    }
}

#[test]
fn bits_of_a_block_in_water_are_the_same_in_any_work_groups() {
    let Some(device) = device("bits of a block in water") else {
        return;
    };
    in_any_groups(device, |device| {
        let all = [block(false), soft(false), plate(false)];
        let after = |scene: Scene<f64, 2>| on_device(device, scene, 30);
        all.map(|scene| after(scene).bits_hash()).to_vec()
    });
}

#[test]
fn a_clamped_plate_in_water_is_that_of_the_host() {
    let Some(device) = device("a clamped plate in water") else {
        return;
    };
    let single = || plate::<f32>(false);
    in_both(&device, "Plate in water", plate::<f64>, single, 200);
    // What clamps give, also where a run is looked at on its way.
    let mut run = load(&device, plate::<f64>(false));
    let mut host = build(plate::<f64>(false));
    for _ in 0..10 {
        for _ in 0..10 {
            run.step().unwrap();
            host.step().unwrap();
        }
        let own = run.simulation().unwrap().clamps();
        for (a, b) in own.iter().zip(&host.clamps()) {
            assert_eq!((&a.body, a.particles), (&b.body, b.particles));
            for d in 0..2 {
                let [force, impulse] = [&b.force, &b.impulse].map(|own| own[0].hypot(own[1]));
                assert!((a.force[d] - b.force[d]).abs() < 1e-8 * force);
                assert!((a.impulse[d] - b.impulse[d]).abs() < 1e-9 * impulse);
            }
            assert!((a.work - b.work).abs() <= 1e-9 * host.clamps()[1].work.abs());
        }
    }
    assert!(host.clamps()[1].work.abs() > 0.0);
}

#[test]
fn a_checkpoint_of_a_plate_in_water_resumes_on_the_other_side() {
    let Some(device) = device("checkpoints of a plate in water") else {
        return;
    };
    let [here, there, host] = resumed(&device, "plate", plate::<f64>, [20, 20]);
    for own in [here, there] {
        let [a, b] = [&own, &host].map(|own| own.clamps()[1].work);
        assert_relative_eq!(a, b, max_relative = 1e-9);
    }
}

/// A wall by a text of its own, of which there is no record.
#[derive(Clone, Copy, Debug)]
struct Light;

impl<T: Real, const D: usize> Coupling<T, D> for Light {
    fn name(&self) -> &'static str {
        "light"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "light".into(),
            equation: "m = m_s",
            source: "this test",
        }
    }
    fn is_wall(&self) -> bool {
        true
    }
}

#[test]
fn what_does_not_run_is_refused_by_name() {
    let light = block::<f64>(false).couple("water", "block", Light);
    refused(
        light,
        &["a liquid that meets `block` by the coupling `light`"],
    );
    let twice = plate::<f64>(false).fix("block", |x| x[0] < SPACING);
    refused(twice, &["a particle that two clamps hold"]);
    let plane = MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]);
    refused(
        block::<f64>(false).boundary(plane),
        &["a liquid that meets `block` among images"],
    );
    let apart = block::<f64>(false).sub_cycle("block", 2);
    refused(apart, &["a group that sub-cycles"]);
}
