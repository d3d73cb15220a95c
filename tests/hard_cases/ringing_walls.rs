//! A box of PMMA that takes eight steps in one of the water's in it, at 30 g: impulses of the water, once a step of its own,
//! resonate with modes of the walls. The cure is an artificial viscosity of the walls.

use super::harness::{Cures, Row, Varied, lasting};
use meshfree::effect::{HourglassControl, StVenantKirchhoff};
use meshfree::material::SoundSpeed;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::term::viscosity::MonaghanGingold;

const DX: f64 = 0.01;
/// Particles along a side of the box, layers of its walls, and layers of water.
const SIDE: i64 = 30;
const THICK: i64 = 3;
const DEEP: i64 = 20;

/// Mean kinetic energy \[J/m\] over the second half of 12 ms, of walls that take so many steps in one of the water's.
fn shaken(count: u32, alpha: f64) -> f64 {
    let (side, depth) = (SIDE as f64 * DX, DEEP as f64 * DX);
    let inside = |k: i64| (0..SIDE).contains(&k);
    let walls = (-THICK..SIDE + THICK)
        .flat_map(|j| (-THICK..SIDE + THICK).map(move |i| [i, j]))
        .filter(|at| !at.iter().all(|k| inside(*k)))
        .map(|at| at.map(|k| (k as f64 + 0.5) * DX));
    let pmma = Linear::from_elastic_constants(1180.0, 3e9, 0.35);
    let pmma = Material::new("PMMA", pmma).with_shear_modulus(3e9 / 2.7);
    let walls = Body::points_of("walls", pmma, walls.collect(), DX);
    let viscosity = MonaghanGingold { alpha, beta: 0.0 };
    let scheme = SchemeBuilder::total_lagrangian(WendlandC2, viscosity)
        .h_over_dx(0.8)
        .with(HourglassControl::default())
        .with(StVenantKirchhoff);
    let water = catalogue::water_at(SoundSpeed::Chosen(100.0)).with_pressure_cut_off(0.0);
    let (down, surface) = ([0.0, -9.81], [0.0, depth]);
    let water = Body::block("water", water, [0.0; 2], [side, depth], DX).hydrostatic(down, surface);
    let corner = move |x: &[f64; 2]| x.iter().all(|x| !(0.0..=side).contains(x));
    let scene = Scene::new(Cures::NONE.liquid())
        .body(water)
        .group(scheme, [walls])
        .fix("walls", corner)
        .sub_cycle("walls", count)
        .acceleration(move |_| [-30.0 * 9.81, down[1]]);
    let mut own = scene.varied().build().expect("a scene");
    let (samples, end) = (40, lasting(0.012));
    let mut sum = 0.0;
    for k in 1..=samples {
        let time = end * f64::from(k) / f64::from(samples);
        if let Err(error) = own.run_with(time, |_| {}) {
            println!("{error}");
            return f64::INFINITY;
        }
        if 2 * k > samples {
            let ledger = own.ledger();
            let walls = ledger.bodies.iter().find(|(name, _)| name == "walls");
            sum += walls.expect("walls").1.kinetic / (0.5 * f64::from(samples));
        }
    }
    println!(
        "{count} steps, α {alpha}: kinetic energy {sum} J/m, {} steps",
        own.steps()
    );
    sum
}

#[test]
fn water_does_not_make_its_walls_ring() {
    let quiet = shaken(2, 0.0);
    Row {
        case: "box of water with elastic walls at 30 g",
        criterion: "kinetic energy of the walls at 8 steps in one of the water's over that at 2; α = 0.2, control: 0",
        value: shaken(8, 0.2) / quiet,
        control: shaken(8, 0.0) / quiet,
    }
    .at_most(1.2);
}
