//! A square wall, clamped along its edges, under an even load: how many layers it takes to bend as a plate of Mindlin.
//! PMMA of Vesenjak & Ren (2007), 0.3 × 0.3 × 0.03 m: the struck wall of their tank.

use meshfree::effect::StVenantKirchhoff;
use meshfree::material::eos::Linear;
use meshfree::prelude::*;

const SIDE: f64 = 0.3;
const THICKNESS: f64 = 0.03;
const YOUNG: f64 = 3e9;
const POISSON: f64 = 0.35;
const DENSITY: f64 = 1180.0;
/// Deflection of the middle in q a⁴/D: of a thin plate, and what shear adds at a thickness of a tenth of the side, ν = 0.3 and
/// a shear factor of 5/6 (0.001505 of Mindlin's theory), which grows as D/G.
const THIN: f64 = 0.001_265;
const SHEAR: f64 = 0.000_240 * (1.0 - 0.3) / (1.0 - POISSON);

/// Deflection of the middle of the wall over that of a plate with shear, a quarter of it between planes of symmetry.
///
/// What is held are places of particles: the last held columns stand at the edges of the span. An odd number of columns is
/// free, so that the planes of symmetry lie between two.
fn deflection(layers: usize) -> f64 {
    let row = THICKNESS / layers as f64;
    let count = 2 * (0.5 * SIDE / row).round() as i64 - 1;
    let column = SIDE / count as f64;
    let half = (count - 1) / 2;
    let points = (-1..=half).flat_map(|i| {
        (-1..=half).flat_map(move |j| {
            (0..layers).map(move |k| {
                let z = (k as f64 + 0.5) * row;
                [i as f64 * column, j as f64 * column, z]
            })
        })
    });
    let law = Linear::from_elastic_constants(DENSITY, YOUNG, POISSON);
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let material = Material::new("PMMA", law).with_shear_modulus(shear);
    let spacing = (column * column * row).cbrt();
    let wall = Body::points_of("wall", material, points.collect(), spacing);
    let (held, middle) = (0.5 * column, 0.5 * SIDE);
    let load = 1e4 / (DENSITY * THICKNESS);
    // Critical for the first mode of the plate, which is at some 940 Hz.
    let drag = Load::acceleration(|at: &meshfree::simulation::LoadPoint<'_, 3>| {
        at.velocity.map(|v| -1.2e4 * v)
    });
    let mut scene = Scene::<f64, 3>::new(schemes::total_lagrangian().with(StVenantKirchhoff))
        .body(wall)
        .fix("wall", move |[x, y, _]| *x < held || *y < held)
        .boundary(MirrorPlane::symmetry([middle, 0.0, 0.0], [1.0, 0.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.0, middle, 0.0], [0.0, 1.0, 0.0]))
        .acceleration(move |_| [0.0, 0.0, -load])
        .load(drag.on("wall"))
        .build()
        .unwrap();
    let height = |now: &Simulation<f64, 3>| -> f64 {
        let near = |x: f64| (x - middle).abs() < 0.75 * column;
        let own = now
            .all()
            .filter(|p| near(p.position()[0]) && near(p.position()[1]));
        let [sum, n] = own.fold([0.0; 2], |[sum, n], p| [sum + p.position()[2], n + 1.0]);
        sum / n
    };
    let before = height(&scene);
    scene.run_until(1.5e-3).unwrap();
    let rigidity = YOUNG * THICKNESS.powi(3) / (12.0 * (1.0 - POISSON * POISSON));
    let plate = (THIN + SHEAR) * 1e4 * SIDE.powi(4) / rigidity;
    (before - height(&scene)) / plate
}

#[test]
fn six_layers_bend_as_a_plate_and_three_bend_too_far() {
    let [three, six] = [3, 6].map(deflection);
    println!(
        "deflection over that of Mindlin's plate: {three:.3} with three layers, {six:.3} with six"
    );
    assert!((six - 1.0).abs() < 0.1, "{six}");
    assert!(three > 1.1 && three < 1.4, "{three}");
}
