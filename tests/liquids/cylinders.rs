//! Creeping flow through a square array of cylinders, whose drag Sangani & Acrivos (1982) computed.
//! Particles that are packed to the surface of a cylinder, against a lattice.

use crate::drum::sheared;
use meshfree::geometry::{fill, pack};
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;

/// Drag on a cylinder over the dynamic viscosity times the mean velocity, where cylinders fill a fifth of space.
const EXACT: f64 = 51.53;

/// The drag over the exact one, with `count` particles on the side of a cell; Reynolds number 0.5 of the radius.
fn drag(count: f64, packed: bool) -> f64 {
    let spacing = 1.0 / count;
    let disc = Ball::new([0.5; 2], (0.2 / std::f64::consts::PI).sqrt());
    let cell = Cuboid::new([0.0; 2], [1.0; 2]).minus(disc);
    let [liquid, core] = if packed {
        [
            pack(&cell, spacing, [0.0; 2]).expect("a cell"),
            pack(&disc, spacing, [0.0; 2]).expect("a cylinder"),
        ]
    } else {
        [
            fill(&cell, spacing, [0.0; 2]).expect("a cell"),
            fill(&disc, spacing, [0.0; 2]).expect("a cylinder"),
        ]
    };
    let viscosity = 0.5;
    // Pressure is 26 in these units, so this sound is fast enough for 1 % of compression.
    let water = Liquid::new(1.0, 1500.0, viscosity).material("water", SoundSpeed::Chosen(50.0));
    // A load on the liquid and a gradient of pressure differ by what lifts the cylinder: the drag is that on the whole cell.
    let force = EXACT * viscosity;
    let mut flow = Scene::<f64, 2>::new(sheared())
        .body(Body::points_of("water", water, liquid, spacing))
        .wall(
            Wall::of("cylinder", core, spacing)
                .no_slip()
                .fluid_side(disc.complement()),
        )
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .acceleration(move |_| [force, 0.0])
        .build()
        .expect("an array");
    flow.run_until(0.4).expect("a start");
    let (mut sum, mut steps) = (0.0, 0);
    let area = spacing * spacing;
    let read = |now: &Simulation<f64, 2>| {
        sum += area
            * now
                .all()
                .map(|particle| particle.velocity()[0])
                .sum::<f64>();
        steps += 1;
    };
    flow.run_with(0.8, read).expect("a flow");
    f64::from(steps) / sum
}

/// Eight particles on a radius. A lattice has discs of other areas on other spacings.
#[test]
fn drag_of_a_cylinder_array_is_that_of_stokes_flow_on_packed_particles() {
    let [packed, lattice] =
        [true, false].map(|packed| [30.0, 33.0].map(|count| drag(count, packed)));
    let text = format!("drag over the exact one: packed {packed:.4?}, lattice {lattice:.4?}");
    println!("{text}");
    for ratio in packed {
        approx::assert_abs_diff_eq!(ratio, 1.0, epsilon = 0.02);
    }
    assert!(
        lattice.iter().all(|ratio| (ratio - 1.0).abs() > 0.02),
        "{text}"
    );
}
