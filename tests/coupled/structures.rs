//! Liquids and structures that bend: a column of water on an elastic plate, against the statics of thick plates.
//! Momentum goes from the water through the plate into its clamps.

use meshfree::boundary::Wall;
use meshfree::effect::NeoHookean;
use meshfree::material::SoundSpeed;
use meshfree::material::eos::Linear;
use meshfree::particles::Field;
use meshfree::prelude::*;

pub(super) const LENGTH: f64 = 0.2;
const HEIGHT: f64 = 0.02;
pub(super) const DEPTH: f64 = 0.1;
pub(super) const DENSITY: f64 = 1100.0;
const YOUNGS: f64 = 4e6;
const POISSON: f64 = 0.3;
pub(super) const GRAVITY: f64 = 9.81;
pub(super) const DX: f64 = HEIGHT / 5.0;

/// The deflection \[m\] of the middle of a plate that is clamped at both ends, under the water's weight and its own
/// (Timoshenko 1921, with a shear coefficient of 5/6), in plane strain.
pub(super) fn deflection() -> f64 {
    let load = GRAVITY * (1000.0 * DEPTH + DENSITY * HEIGHT);
    let stiffness = YOUNGS * HEIGHT.powi(3) / (12.0 * (1.0 - POISSON * POISSON));
    let shear = 5.0 / 6.0 * HEIGHT * YOUNGS / (2.0 * (1.0 + POISSON));
    // What is held is places of particles, so the span is from place to place.
    let span = LENGTH + DX;
    load * span.powi(4) / (384.0 * stiffness) + load * span * span / (8.0 * shear)
}

pub(super) fn scene() -> Scene<f64, 2> {
    let water = catalogue::water_at(SoundSpeed::artificial(2.0));
    let law = Linear::from_elastic_constants(DENSITY, YOUNGS, POISSON);
    let shear = YOUNGS / (2.0 * (1.0 + POISSON));
    let rubber = Material::new("rubber", law).with_shear_modulus(shear);
    let held = 3.0 * DX;
    let plate = Body::block("plate", rubber, [-held, -HEIGHT], [LENGTH + held, 0.0], DX);
    let sides = [[true; 2], [false; 2]];
    let tank = Wall::around("tank", [0.0; 2], [LENGTH, DEPTH + 4.0 * DX], DX, 3, sides);
    Scene::new(schemes::weakly_compressible())
        .body(
            Body::block("water", water, [0.0; 2], [LENGTH, DEPTH], DX)
                .hydrostatic([0.0, -GRAVITY], [0.0, DEPTH]),
        )
        .group(schemes::total_lagrangian().with(NeoHookean), [plate])
        .wall(tank)
        .fix("plate", |[x, _]| !(0.0..LENGTH).contains(x))
        .between("plate", "tank", Interaction::None)
        .sub_cycle("plate", 5)
        .acceleration(|_| [0.0, -GRAVITY])
}

/// How far the middle of the plate has sunk \[m\].
pub(super) fn middle(now: &Simulation<f64, 2>) -> f64 {
    let near = now.body("plate").unwrap().filter(|p| {
        let [x, _] = p.vector(Field::REFERENCE_POSITION).unwrap();
        (x - 0.5 * LENGTH).abs() < DX
    });
    let (sum, count) = near.fold((0.0, 0), |(sum, count), p| {
        (sum + p.position()[1], count + 1)
    });
    -0.5 * HEIGHT - sum / f64::from(count)
}

/// It swings about its static deflection, which two periods give to a few per cent.
#[test]
fn a_plate_bears_a_column_of_water() {
    let mut simulation = scene().build().unwrap();
    let theory = deflection();
    let mut samples = Vec::new();
    while simulation.time() < 0.4 {
        simulation.step().unwrap();
        samples.push((simulation.time(), middle(&simulation)));
    }
    // From one fall through the level of theory to the last.
    let falls: Vec<_> = samples
        .windows(2)
        .filter(|pair| pair[0].1 < theory && pair[1].1 >= theory)
        .map(|pair| pair[1].0)
        .collect();
    let (from, to) = (falls[0], falls[falls.len() - 1]);
    let within = samples
        .windows(2)
        .filter(|pair| pair[0].0 >= from && pair[1].0 <= to);
    let area = within.fold(0.0, |sum, pair| sum + (pair[1].0 - pair[0].0) * pair[1].1);
    let mean = area / (to - from) / theory;
    // Five particles through the thickness bend 8 % too far (`schemes::total_lagrangian`).
    assert!(falls.len() > 2 && (mean - 1.0).abs() < 0.1, "{mean}");
    // The ledger knows who bore the weight.
    let ledger = simulation.ledger();
    let weight = GRAVITY * simulation.time() * ledger.whole.mass;
    let [_, walls] = simulation.wall_impulse("tank").unwrap();
    let held = simulation.clamps()[0].impulse[1];
    let lacks = (ledger.whole.momentum[1] - (held - walls - weight)) / weight;
    assert!(lacks.abs() < 1e-10, "{lacks:e}");
    assert_eq!(simulation.clamps()[0].work, 0.0);
}

/// Water carries no stress because a plate is in the scene, and the plate no pressure of walls.
#[test]
fn each_group_carries_its_own_fields() {
    let simulation = scene().build().unwrap();
    let [water, plate] =
        ["water", "plate"].map(|body| simulation.body(body).unwrap().next().unwrap());
    assert!(
        water
            .matrix(meshfree::effect::TotalLagrangian::PIOLA)
            .is_none()
    );
    assert!(
        plate
            .matrix(meshfree::effect::TotalLagrangian::PIOLA)
            .is_some()
    );
}
