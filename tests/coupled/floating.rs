//! A rigid box that floats: it settles at the draught of Archimedes, upright, and the water keeps what it gives.
//! The box is a wall to the water, and the water's forces move it as one.

use meshfree::boundary::Wall;
use meshfree::coupling::ContactDensity;
use meshfree::material::Material;
use meshfree::material::catalogue;
use meshfree::material::eos::Linear;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
use meshfree::term::viscosity::MonaghanGingold;

#[test]
fn a_box_floats_at_the_draught_of_archimedes() {
    let (dx, width, depth, size) = (0.02, 1.0, 0.4, [0.28, 0.2]);
    let share = 0.5;
    let wood = Material::new("wood", Linear::new(1000.0 * share, 12.0));
    let left = 0.5 * (width - size[0]);
    // Let in at its draught but for a fifth of its height.
    let draught = share * size[1];
    let high = depth + 0.04;
    let floats = Body::block(
        "box",
        wood,
        [left, high - draught],
        [left + size[0], high - draught + size[1]],
        dx,
    );
    let inside = |[x, y]: [f64; 2]| x > left && x < left + size[0] && y > high - draught;
    let mut water = Vec::new();
    for j in 0..20 {
        for i in 0..50 {
            let x = [(f64::from(i) + 0.5) * dx, (f64::from(j) + 0.5) * dx];
            if !inside(x) {
                water.push(x);
            }
        }
    }
    let area = water.len() as f64 * dx * dx;
    let viscosity = MonaghanGingold {
        alpha: 0.3,
        beta: 0.0,
    };
    let mut tank = Vec::new();
    for j in -4..40 {
        for i in -4..54 {
            if j < 0 || !(0..50).contains(&i) {
                tank.push([(f64::from(i) + 0.5) * dx, (f64::from(j) + 0.5) * dx]);
            }
        }
    }
    let mut simulation =
        Scene::<f64, 2>::new(schemes::weakly_compressible().with_viscosity(viscosity))
            .body(Body::points_of(
                "water",
                catalogue::weakly_compressible_water(12.0),
                water,
                dx,
            ))
            .group(schemes::impact_by_continuity(), [floats])
            .wall(Wall::of("tank", tank, dx))
            .rigid("box")
            .couple("box", "tank", ContactDensity::new())
            .acceleration(|_| [0.0, -9.81])
            .build()
            .unwrap();
    let (mut sum, mut time, mut tilt) = (0.0, 0.0, 0.0_f64);
    let mut last = 0.0;
    simulation
        .run_with(1.6, |now| {
            let places: Vec<[f64; 2]> = now.body("box").unwrap().map(|p| p.position()).collect();
            let middle = places.iter().map(|x| x[1]).sum::<f64>() / places.len() as f64;
            let dt = now.time() - last;
            last = now.time();
            if last > 1.0 {
                sum += dt * middle;
                time += dt;
                tilt = tilt.max((places[0][1] - places[13][1]).abs() / size[0]);
            }
        })
        .unwrap();
    let middle = sum / time;
    let level = (area + size[0] * draught) / width;
    let found = level - (middle - 0.5 * size[1]);
    println!("draught {found} of {draught}, tilt {tilt}, level {level}");
    assert!((found / draught - 1.0).abs() < 0.05, "{found}");
    assert!(tilt < 0.05, "{tilt}");
}
