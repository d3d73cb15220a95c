//! A jet along a floor that strikes a step, against free streamlines.
//! Pressures on the step, down to one spacing from the edge that the jet leaves.

use meshfree::material::{Liquid, SoundSpeed};
use meshfree::observe::PressureProbe;
use meshfree::prelude::*;
use meshfree::study::jet_on_step::JetOnStep;

const SPEED: f64 = 3.0;
/// Depth of the jet and height of the step \[m\]: water against the box of SPHERIC 2.
const DEPTH: f64 = 0.105;
const STEP: f64 = 0.161;
/// Heights of sensors \[m\].
const SENSORS: [f64; 4] = [0.021, 0.061, 0.101, 0.141];

/// Pressures at the sensors over ½ρU², in the mean of the steady flow, with `rows` of particles over the jet.
fn coefficients(rows: usize) -> [f64; 4] {
    let spacing = DEPTH / rows as f64;
    let layers = 3;
    let water = Liquid::new(1000.0, 1480.0, 1e-3)
        .material("water", SoundSpeed::Chosen(46.5))
        .with_pressure_cut_off(0.0);
    let jet = Body::block("jet", water, [0.0; 2], [1.6, DEPTH], spacing).velocity([-SPEED, 0.0]);
    let lattice = |columns: usize, rows: usize, at: &dyn Fn(f64, f64) -> [f64; 2]| {
        let cells = (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j)));
        cells
            .map(|(i, j)| at(i as f64 + 0.5, j as f64 + 0.5))
            .collect::<Vec<_>>()
    };
    let floor = lattice((2.0 / spacing) as usize, layers, &|i, j| {
        [i * spacing, -j * spacing]
    });
    let count = (STEP / spacing).round();
    let height = STEP / count;
    let step = lattice(layers, count as usize + layers, &|i, j| {
        [-i * spacing, STEP - j * height]
    });
    let mut simulation = Scene::<f64, 2>::new(
        schemes::weakly_compressible()
            .with(AcousticDamping { strength: 0.3 })
            .compose(),
    )
    .body(jet)
    .wall(Wall::of("floor", floor, spacing))
    .wall(Wall::of("step", step, spacing))
    .outlet(Outlet::outside_box([-0.3, -0.5], [2.0, 0.6]))
    .build()
    .unwrap();
    let sensors = SENSORS
        .map(|z| PressureProbe::disc(&simulation, "sensor", [0.0, z], [1.0, 0.0], 0.01).unwrap());
    let (mut sums, mut samples) = ([0.0; 4], 0.0);
    simulation
        .run_with(0.4, |now| {
            if now.time() > 0.25 {
                let pressures = PressureProbe::pressures(&sensors, now);
                for (sum, pressure) in sums.iter_mut().zip(pressures) {
                    *sum += pressure;
                }
                samples += 1.0;
            }
        })
        .unwrap();
    sums.map(|sum| sum / samples / (0.5 * 1000.0 * SPEED * SPEED))
}

#[test]
fn pressures_on_the_step_converge_to_those_of_free_streamlines() {
    let exact = JetOnStep::new(DEPTH, STEP).unwrap();
    let exact = SENSORS.map(|z| exact.pressure_coefficient(z).unwrap());
    let [coarse, fine] = [6, 11].map(coefficients);
    println!("exact {exact:.3?}, 6 rows {coarse:.3?}, 11 rows {fine:.3?}");
    for k in 0..3 {
        assert!((fine[k] - exact[k]).abs() < 0.05, "sensor {}", k + 1);
    }
    // Kernels reach over the edge: a sensor two spacings below it reads most of the pressure, one spacing below it
    // a third is missing.
    assert!((fine[3] - exact[3]).abs() < 0.08 && exact[3] - coarse[3] > 0.12);
}
