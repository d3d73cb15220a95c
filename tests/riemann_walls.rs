//! Walls as one-sided Riemann problems: what strikes them alone does not bounce, and nothing else changes.
//! The control is the same wall without, from which it does.

use meshfree::boundary::Translation;
use meshfree::geometry::Cuboid;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scalar::Real;

const DX: f64 = 0.01;
const SPEED: f64 = 2.0;

fn scheme<T: Real>(riemann: bool) -> Scheme<T, 2> {
    let base = schemes::weakly_compressible();
    if riemann {
        base.riemann_walls().compose()
    } else {
        base.compose()
    }
}

fn water<T: Real>() -> Material<T> {
    let water = Liquid::new(1000.0, 1480.0, 1e-3);
    let water = water.material("water", SoundSpeed::Chosen(20.0));
    water.with_pressure_cut_off(0.0)
}

/// Rows of water that fall onto a floor at [`SPEED`] without gravity, seen from a frame in which the floor
/// moves at `lift`; returns the speed at which they leave it over that at which they came, and the error of
/// the momentum over it.
fn rebound<T: Real>(riemann: bool, rows: usize, lift: f64, floor: &Wall<2>) -> (f64, f64) {
    let low = 8.0 * DX;
    let top = low + rows as f64 * DX;
    let rain = Body::block("rain", water::<T>(), [0.0, low], [10.0 * DX, top], DX);
    let rain = rain.start(move |_, start| meshfree::scene::Start {
        velocity: [0.0, lift - SPEED],
        ..start
    });
    let mut simulation = Scene::new(scheme(riemann))
        .body(rain)
        .wall(floor.clone().motion(Translation::steady([0.0, lift])))
        .build()
        .unwrap();
    let before = simulation.ledger().whole.momentum[1];
    simulation.run_until(0.08).unwrap();
    let whole = simulation.ledger().whole;
    let lack = whole.momentum[1] + simulation.wall_impulse(0)[1] - before;
    let leaves = whole.momentum[1] / whole.mass - lift;
    (leaves / SPEED, (lack / (whole.mass * SPEED)).abs())
}

fn floor() -> Wall<2> {
    let below = [[false; 2], [true, false]];
    Wall::around("floor", [-0.1, 0.0], [0.2, 0.3], DX, 4, below)
}

#[test]
fn what_strikes_a_wall_alone_does_not_bounce() {
    let (soft, lack) = rebound::<f64>(true, 1, 0.0, &floor());
    let (hard, _) = rebound::<f64>(false, 1, 0.0, &floor());
    assert!(soft.abs() < 0.15 && hard > 0.3, "{soft} {hard}");
    assert!(lack < 1e-12, "{lack}");
    // Nor do several rows, which touch each other.
    let [soft_rows, hard_rows] =
        [true, false].map(|riemann| rebound::<f64>(riemann, 3, 0.0, &floor()).0);
    assert!(
        soft_rows.abs() < 0.05 && hard_rows > 0.15,
        "{soft_rows} {hard_rows}"
    );
    // It is the same seen from a frame that moves, and in f32.
    let (moved, _) = rebound::<f64>(true, 1, 0.7, &floor());
    let (single, _) = rebound::<f32>(true, 1, 0.0, &floor());
    assert!(
        (moved - soft).abs() < 1e-6 && (single - soft).abs() < 1e-4,
        "{soft} {moved} {single}"
    );
}

/// A wall of points has the normals of the shape it is told of, and then does the same.
#[test]
fn points_that_face_a_shape_do_the_same() {
    let room = Cuboid::new([-1.0, 0.0], [1.0, 1.0]);
    let points = floor().points().to_vec();
    let own = Wall::of("floor", points.clone(), DX).facing(&room);
    let same = rebound::<f64>(true, 1, 0.0, &own).0 - rebound::<f64>(true, 1, 0.0, &floor()).0;
    assert!(same.abs() < 1e-9, "{same}");
}

#[test]
fn walls_without_normals_are_refused_by_name() {
    let points = floor().points().to_vec();
    let rain = Body::block("rain", water::<f64>(), [0.0, DX], [0.1, 0.05], DX);
    let scene = Scene::new(scheme(true)).body(rain);
    let refused = scene.wall(Wall::of("floor", points, DX)).build();
    let text = refused.map(|_| ()).unwrap_err().to_string();
    assert!(
        text.contains("wall `floor` has no normals") && text.contains("Wall::facing"),
        "{text}"
    );
}
