//! Planes that reflect hold liquid that has no pressure, as they hold what presses against them.
//! A drop that flies through a plane is the drop that comes from behind it.

use super::solids_in_tank::rubber;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::sweep::Transform;

/// Speed of the wall at y = 0 \[m/s\], against the drops.
const PISTON: f64 = 0.05;
const SPACING: f64 = 0.01;
const UNTIL: f64 = 0.12;

/// Cavitated drops of one particle each on their way to the corner of a plane at rest and one that moves.
fn drops<T: Real>() -> Body<T, 3> {
    let water = Liquid::new(1000.0, 1480.0, 1e-3)
        .material("water", SoundSpeed::Chosen(20.0))
        .with_pressure_cut_off(0.0);
    // Apart from each other; the second comes to the edge.
    let places = [[0.03, 0.3, 0.1], [0.05, 0.04, 0.3], [0.3, 0.05, 0.5]];
    let velocities = [[-1.0, 0.2, 0.1], [-1.1, -0.8, 0.0], [0.3, -1.2, 0.2]];
    Body::points_of("drops", water, places.to_vec(), SPACING).start(move |x, start| {
        let own = places.iter().position(|place| *place == x).unwrap_or(0);
        Start {
            velocity: velocities[own],
            density: 900.0,
            ..start
        }
    })
}

fn planes() -> [MirrorPlane<3>; 2] {
    [
        MirrorPlane::symmetry([0.0; 3], [-1.0, 0.0, 0.0]),
        MirrorPlane::wall([0.0; 3], [0.0, -1.0, 0.0]).moving(-PISTON),
    ]
}

fn flown<T: Real>(scene: Scene<T, 3>) -> Simulation<T, 3> {
    let mut simulation = scene.body(drops()).build().unwrap();
    simulation.run_until(UNTIL).unwrap();
    simulation
}

/// The place and velocity of every drop.
fn states(now: &Simulation<f64, 3>) -> Vec<[[f64; 3]; 2]> {
    now.all().map(|p| [p.position(), p.velocity()]).collect()
}

/// A plane whose images act, and which lets particles through.
#[derive(Debug)]
struct Open(MirrorPlane<3>);

impl Boundary<3> for Open {
    fn name(&self) -> String {
        "open plane".into()
    }
    fn images(&self) -> usize {
        1
    }
    fn transform(&self, image: usize, time: f64) -> Transform<f64, 3> {
        self.0.transform(image, time)
    }
    fn reaches(&self, image: usize, x: &[f64; 3], reach: f64, time: f64) -> bool {
        Boundary::<3>::reaches(&self.0, image, x, reach, time)
    }
    fn moves(&self) -> bool {
        Boundary::<3>::moves(&self.0)
    }
}

#[test]
fn a_torn_drop_does_not_pass_a_plane() {
    let scheme = || schemes::weakly_compressible().compose::<f64, 3>();
    let [at_rest, piston] = planes();
    let held = flown(
        Scene::new(scheme())
            .boundary(at_rest.clone())
            .boundary(piston.clone()),
    );
    let open = flown(
        Scene::new(scheme())
            .boundary(Open(at_rest))
            .boundary(Open(piston)),
    );
    let front = PISTON * UNTIL;
    let behind = |x: &[f64; 3]| x[0] < 0.0 || x[1] < front;
    assert!(states(&held).iter().all(|[x, _]| !behind(x)));
    // Its one image is not enough to close the gap: without the swap a drop passes. The second meets the edge,
    // where three images are.
    let passed: Vec<bool> = states(&open).iter().map(|[x, _]| behind(x)).collect();
    assert_eq!(passed, [true, false, true]);
    // It is the same flow, in which a drop and its image have changed places.
    for ([x, v], [y, u]) in states(&held).iter().zip(states(&open)) {
        let fold = |x: f64, plane: f64| if x < plane { 2.0 * plane - x } else { x };
        let turn = |v: f64, x: f64, plane: f64, w: f64| if x < plane { 2.0 * w - v } else { v };
        let folded = [fold(y[0], 0.0), fold(y[1], front), y[2]];
        let turned = [
            turn(u[0], y[0], 0.0, 0.0),
            turn(u[1], y[1], front, PISTON),
            u[2],
        ];
        for d in 0..3 {
            assert!((x[d] - folded[d]).abs() < 1e-12 && (v[d] - turned[d]).abs() < 1e-11);
        }
    }
}

/// What the drops gained and what the planes gave agree to `rounding` \[kg m/s\].
fn balance<T: Real>(scene: Scene<T, 3>, rounding: f64) {
    let [at_rest, piston] = planes();
    let before = Scene::new(schemes::weakly_compressible().compose::<T, 3>()).body(drops());
    let before = before.build().unwrap().ledger().whole.momentum;
    let ledger = flown(scene.boundary(at_rest).boundary(piston)).ledger();
    let given = ledger.boundary_impulse;
    for d in 0..3 {
        let gained = ledger.whole.momentum[d] - before[d];
        let error = (gained - given[d]).abs();
        assert!(error < rounding, "{d}: {gained:e} and {:e}", given[d]);
    }
    // Two drops turn on the plane at rest, two on the piston.
    assert!(given[0] > 3e-3 && given[1] > 3e-3);
}

#[test]
fn what_a_plane_gives_a_drop_is_in_the_ledger() {
    let scheme = schemes::weakly_compressible;
    balance::<f64>(Scene::new(scheme().compose()), 1e-14);
    balance::<f32>(Scene::new(scheme().compose()), 1e-9);
}

#[test]
fn a_body_behind_a_plane_is_refused() {
    let turned_round = MirrorPlane::symmetry([0.0; 3], [1.0, 0.0, 0.0]);
    let scheme = schemes::weakly_compressible().compose::<f64, 3>();
    let scene = Scene::<f64, 3>::new(scheme)
        .body(drops())
        .boundary(turned_round);
    let complaint = scene.build().unwrap_err().to_string();
    assert!(complaint.contains("`drops`") && complaint.contains("reverse the normal"));
}

/// Planes that nothing comes near.
fn far(count: usize) -> impl Iterator<Item = MirrorPlane<2>> {
    (0..count).map(move |k| {
        let (sin, cos) = (1.5 * k as f64 / count as f64).sin_cos();
        MirrorPlane::symmetry([9.0 * cos, 9.0 * sin], [cos, sin])
    })
}

/// Runs a scene in the corner of two planes, between which others stand in the list.
fn in_a_corner(scene: Scene<f64, 2>, others: usize) -> Vec<[f64; 2]> {
    let [left, floor] = [[-1.0, 0.0], [0.0, -1.0]].map(|n| MirrorPlane::symmetry([0.0; 2], n));
    let scene = far(others).fold(scene.boundary(left), Scene::boundary);
    let mut now = scene.boundary(floor).build().unwrap();
    for _ in 0..20 {
        now.step().unwrap();
    }
    now.all().map(|particle| particle.position()).collect()
}

#[test]
fn planes_that_nothing_reaches_change_no_bit() {
    let water = || {
        let water = catalogue::weakly_compressible_water(5.0);
        let drop = Body::block("drop", water, [0.0; 2], [0.1; 2], 0.01).velocity([-1.0, -0.7]);
        Scene::<f64, 2>::new(schemes::weakly_compressible()).body(drop)
    };
    assert_eq!(in_a_corner(water(), 0), in_a_corner(water(), 38));
    let blocks = || {
        let block = |name, low: f64, v| {
            let rubber = rubber(1000.0, 1e6);
            Body::block(name, rubber, [0.0, low], [0.1, low + 0.05], 0.01).velocity(v)
        };
        Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean))
            .body(block("lower", 0.0, [0.0; 2]))
            .body(block("upper", 0.06, [-0.5, -2.0]))
            .couple("lower", "upper", Penalty::new().friction(0.3))
            .couple_self("upper", 0.03, Penalty::new())
    };
    assert_eq!(in_a_corner(blocks(), 0), in_a_corner(blocks(), 28));
}

#[test]
fn more_planes_than_can_be_told_apart_are_refused() {
    let water = catalogue::weakly_compressible_water(5.0);
    let drop = Body::block("drop", water, [0.0; 2], [0.1; 2], 0.01);
    let scene = Scene::<f64, 2>::new(schemes::weakly_compressible()).body(drop);
    let scene = far(65).fold(scene, Scene::boundary);
    let complaint = scene.build().unwrap_err().to_string();
    assert!(
        complaint.contains("number of boundaries is 65"),
        "{complaint}"
    );
    let rods = Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean)).body(
        Body::block("block", rubber(1000.0, 1e6), [0.0; 2], [0.1; 2], 0.01),
    );
    let rods = rods.couple_self("block", 0.03, Penalty::new());
    let complaint = far(32).fold(rods, Scene::boundary).build().unwrap_err();
    let complaint = complaint.to_string();
    assert!(complaint.contains("images of images"), "{complaint}");
}
