//! A square of water that flies into a corner of walls: two faces strike at once, and a jet leaves along each.
//! Others go through the wall, or take a pressure there that no water hammer has.

use super::harness::{Cures, Row, Varied, seed};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;
use meshfree::simulation::Thresholds;

const SPEED: f64 = 1.0;
const SOUND: f64 = 20.0;

/// The largest pressure over ρ c v, and the deepest particle beyond the face of a wall in spacings.
fn strike(cures: Cures) -> [f64; 2] {
    let spacing = 0.005;
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(SOUND));
    let water = water.with_pressure_cut_off(0.0);
    let body = Body::block("water", water, [0.0; 2], [0.2; 2], spacing)
        .jitter(0.01, seed(6))
        .velocity([-SPEED, -SPEED]);
    let sides = [[true, false], [true, false]];
    let mut scene = Scene::new(cures.liquid())
        .body(body)
        .wall(Wall::around(
            "corner", [0.0; 2], [0.4; 2], spacing, 5, sides,
        ))
        .varied()
        .build()
        .expect("a corner");
    scene.keep_stability(Thresholds {
        limited: 1.0,
        ..Thresholds::default()
    });
    let (mut most, mut deep) = (0.0_f64, 0.0_f64);
    let ended = scene.run_with(0.1, |now| {
        for p in now.all() {
            let [x, y] = p.position();
            most = most.max(p.pressure());
            deep = deep.max(-x).max(-y);
        }
    });
    assert!(ended.is_ok(), "{ended:?}");
    println!("{}", scene.stability());
    [most / (1000.0 * SOUND * SPEED), deep / spacing]
}

/// Two hammers that meet in the corner give 2 ρ c v by linear theory. The control has neither viscosity nor diffusion of density.
#[test]
fn water_in_a_corner_stays_before_the_walls() {
    let struck = Cures {
        alpha: 0.1,
        ..Cures::VIOLENT
    };
    let bare = Cures {
        alpha: 1e-6,
        delta: 1e-6,
        ..Cures::NONE
    };
    let [[pressure, depth], [loud, through]] = [struck, bare].map(strike);
    println!("ready liquid {:?}", strike(Cures::NONE));
    let row = |criterion, value, control| Row {
        case: "corner impact",
        criterion,
        value,
        control,
    };
    row(
        "largest pressure over ρ c v; α = 0.1, consistent shifting, memory",
        pressure,
        loud,
    )
    .at_most(3.0);
    row("depth in the wall in spacings; the same", depth, through).at_most(0.5);
}
