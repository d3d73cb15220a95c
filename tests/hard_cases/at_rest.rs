//! Liquids that should come to rest: a column in a tank, and a periodic box of particles displaced by a fifth.
//! Others keep their noise or let the surface rise; diffusion of density and a little viscosity damp it.

use super::harness::{Cures, Row};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;
use meshfree::simulation::Thresholds;

const GRAVITY: f64 = 9.81;
const DEPTH: f64 = 1.0;
const RHO: f64 = 1000.0;

/// Of a column after so many √(H/g): RMS error of the pressure over ρgH, rise of the mean height in spacings, and the RMS
/// speed over the speed of sound.
fn column(cures: Cures, count: usize, duration: f64) -> [f64; 3] {
    let sound = 10.0 * (GRAVITY * DEPTH).sqrt();
    let spacing = DEPTH / count as f64;
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(sound));
    let body = Body::block("water", water, [0.0; 2], [0.6, DEPTH], spacing)
        .jitter(0.01, 7)
        .hydrostatic([0.0, -GRAVITY], [0.0, DEPTH]);
    let sides = [[true; 2], [true, false]];
    let mut tank = Scene::new(cures.liquid())
        .body(body)
        .wall(Wall::around(
            "tank",
            [0.0; 2],
            [0.6, 1.5],
            spacing,
            5,
            sides,
        ))
        .acceleration(|_| [0.0, -GRAVITY])
        .build()
        .expect("a column");
    let count = tank.particles() as f64;
    let height = |now: &Simulation<f64, 2>| now.all().map(|p| p.position()[1]).sum::<f64>() / count;
    let before = height(&tank);
    tank.keep_stability(Thresholds {
        momentum: 1e-9,
        ..Thresholds::default()
    });
    tank.run_until(duration * (DEPTH / GRAVITY).sqrt())
        .expect("rest");
    println!("{}", tank.stability());
    let whole = RHO * GRAVITY * DEPTH;
    let error = |x: [f64; 2], p: f64| (p / whole - (1.0 - x[1] / DEPTH)).powi(2);
    let squares: f64 = tank.all().map(|p| error(p.position(), p.pressure())).sum();
    let speeds: f64 = tank
        .all()
        .map(|p| p.velocity().map(|v| v * v).iter().sum::<f64>())
        .sum();
    [
        (squares / count).sqrt(),
        (height(&tank) - before).abs() / spacing,
        (speeds / count).sqrt() / sound,
    ]
}

/// Neither viscosity nor diffusion of density to speak of.
const BARE: Cures = Cures {
    alpha: 1e-6,
    delta: 1e-6,
    ..Cures::NONE
};

#[test]
fn a_column_at_rest_keeps_its_pressure() {
    let [pressure, rise, speed] = column(Cures::NONE, 20, 40.0);
    let [noisy, risen, fast] = column(BARE, 20, 40.0);
    // What keeps a liquid in tension even is no cure here: shifting lets the surface rise, and the pressure errs by more.
    let even = column(Cures::EVEN, 20, 40.0);
    println!("rise {rise} {risen}; with the cures of tension {even:?}");
    assert!(rise < 0.5, "{rise}");
    let row = |criterion, value, control| Row {
        case: "hydrostatic tank, 40 √(H/g)",
        criterion,
        value,
        control,
    };
    row("RMS error of pressure over ρgH", pressure, noisy).at_most(0.01);
    row("RMS speed over sound", speed, fast).at_most(1e-4);
}

/// The RMS speed over the speed of sound of a periodic box of displaced particles, after so many crossings of it by
/// sound.
fn noise(cures: Cures) -> f64 {
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(10.0));
    // Under pressure, which tells the particles that they are displaced.
    let body = Body::block("water", water, [0.0; 2], [1.0; 2], 0.04)
        .jitter(0.2, 5)
        .density(1.01 * RHO);
    let mut bath = Scene::new(cures.liquid())
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .build()
        .expect("a box");
    bath.run_until(4.0).expect("rest");
    let speeds: f64 = bath
        .all()
        .map(|p| p.velocity().map(|v| v * v).iter().sum::<f64>())
        .sum();
    (speeds / bath.particles() as f64).sqrt() / 10.0
}

#[test]
fn displaced_particles_come_to_rest() {
    let row = Row {
        case: "displaced by 20 %, at rest",
        criterion: "RMS speed over sound after 40 crossings",
        value: noise(Cures::EVEN),
        control: noise(BARE),
    };
    row.at_most(1e-3);
}
