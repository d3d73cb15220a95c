//! Walls as one-sided Riemann problems: what strikes them alone does not bounce, what runs along them is left alone.
//! The controls are the same walls without, from which it does, and with normals that lean.

use meshfree::boundary::{Rotation, Translation};
use meshfree::geometry::{HalfSpace, Shape};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scalar::Real;

const DX: f64 = 0.01;
const SPEED: f64 = 2.0;

fn scheme<T: Real>(riemann: bool) -> Scheme<T, 2> {
    let base = schemes::weakly_compressible();
    if riemann {
        base.walls(RiemannWalls::default()).compose()
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
    let rain = rain.velocity([0.0, lift - SPEED]);
    let mut simulation = Scene::new(scheme(riemann))
        .body(rain)
        .wall(floor.clone().motion(Translation::steady([0.0, lift])))
        .build()
        .unwrap();
    let before = simulation.ledger().whole.momentum[1];
    simulation.run_until(0.08).unwrap();
    let whole = simulation.ledger().whole;
    let lack = whole.momentum[1] + simulation.wall_impulse(0).unwrap()[1] - before;
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

/// The floor of points, which is told what it faces.
fn told(fluid_side: impl Shape<2> + 'static) -> Wall<2> {
    Wall::of("floor", floor().points().to_vec(), DX).fluid_side(fluid_side)
}

#[test]
fn points_that_are_told_their_room_do_the_same() {
    let (around, _) = rebound::<f64>(true, 1, 0.0, &floor());
    let above = HalfSpace::new([0.0; 2], [0.0, -1.0]);
    let (told, _) = rebound::<f64>(true, 1, 0.0, &told(above));
    assert!((told - around).abs() < 1e-9, "{told} {around}");
}

/// The velocity of a body that is thrown, over [`SPEED`], after a time \[s\] beside a wall.
fn thrown(at: [[f64; 2]; 2], velocity: [f64; 2], wall: Wall<2>, time: f64) -> [f64; 2] {
    let body = Body::block("body", water(), at[0], at[1], DX).velocity(velocity);
    let scene = Scene::new(scheme::<f64>(true)).body(body).wall(wall);
    let mut simulation = scene.build().unwrap();
    simulation.run_until(time).unwrap();
    let whole = simulation.ledger().whole;
    [0, 1].map(|d| whole.momentum[d] / whole.mass / SPEED)
}

/// A floor that a motion has turned by a right angle into a wall: its normals turn with it.
#[test]
fn normals_turn_with_the_wall() {
    let quarter = core::f64::consts::FRAC_PI_2;
    let turned = floor().motion(Rotation::about([0.0; 2], move |_| [quarter, 0.0, 0.0]));
    let row = [[-9.0 * DX, 0.0], [-8.0 * DX, 10.0 * DX]];
    let leaves = -thrown(row, [SPEED, 0.0], turned, 0.08)[0];
    let (level, _) = rebound::<f64>(true, 1, 0.0, &floor());
    assert!((leaves - level).abs() < 1e-6, "{leaves} {level}");
}

/// A tongue that runs along a bed is left alone. With normals that lean forwards, the control, it is thrown up.
#[test]
fn what_runs_along_a_wall_keeps_its_speed() {
    let tongue = [[0.0; 2], [0.05, 0.02]];
    let after = |bed| thrown(tongue, [SPEED, 0.0], bed, 0.02);
    let level = after(floor());
    let leaning = after(told(HalfSpace::new([0.0; 2], [0.6, -0.8])));
    assert!(
        (level[0] - 1.0).abs() < 1e-12 && level[1].abs() < 1e-6,
        "{level:?}"
    );
    assert!(leaning[0] < 0.995 && leaning[1] > 0.1, "{leaning:?}");
}

#[test]
fn walls_that_know_no_room_are_refused_by_name() {
    let points = floor().points().to_vec();
    let rain = Body::block("rain", water::<f64>(), [0.0, DX], [0.1, 0.05], DX);
    let scene = Scene::new(scheme(true)).body(rain);
    let refused = scene.wall(Wall::of("floor", points, DX)).build();
    let text = refused.map(|_| ()).unwrap_err().to_string();
    assert!(
        text.contains("wall `floor` has no container of the liquid")
            && text.contains("Wall::fluid_side"),
        "{text}"
    );
}
