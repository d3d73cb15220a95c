//! Liquids that should come to rest: a column in a tank, and a periodic box of particles displaced by a fifth.
//! Others keep their noise or let the surface rise; diffusion of density and a little viscosity damp it.

use super::harness::{Cures, Row, Varied, lasting, seed};
use meshfree::material::SoundSpeed;
use meshfree::prelude::*;
use meshfree::simulation::Thresholds;

const GRAVITY: f64 = 9.81;
const DEPTH: f64 = 1.0;
const RHO: f64 = 1000.0;

/// A tank of water at rest.
#[derive(Clone, Copy, Debug)]
struct Tank {
    /// Cells a depth of a metre.
    count: usize,
    width: f64,
    /// Width and height of a step in its bottom, on the right.
    step: [f64; 2],
    /// In m/s².
    gravity: f64,
    /// Whether gravity points to the left, and the water fills the tank to its lid as a wall of water.
    sideways: bool,
}

const COLUMN: Tank = Tank {
    count: 20,
    width: 0.6,
    step: [0.0; 2],
    gravity: GRAVITY,
    sideways: false,
};

/// Of a tank after so many √(H/g): RMS error of the pressure over ρgH, rise of the mean height in spacings, and the RMS
/// speed over the speed of sound.
fn rest(own: Tank, cures: Cures, duration: f64) -> [f64; 3] {
    let sound = 10.0 * (own.gravity * DEPTH).sqrt();
    let spacing = DEPTH / own.count as f64;
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(sound));
    // Axes along and across gravity.
    let up = usize::from(!own.sideways);
    let by = |height: f64, across: f64| {
        if up == 1 {
            [across, height]
        } else {
            [height, across]
        }
    };
    let down = by(-own.gravity, 0.0);
    let [foot, top] = [own.width - own.step[0], own.step[1]];
    let stands =
        |x: [f64; 2]| x[1 - up] > foot && x[1 - up] < own.width && x[up] > 0.0 && x[up] < top;
    let sides = if own.sideways {
        [[true; 2]; 2]
    } else {
        [[true; 2], [true, false]]
    };
    let tank = Wall::around("tank", [0.0; 2], by(1.5, own.width), spacing, 5, sides);
    let block = Body::block(
        "water",
        water.clone(),
        [0.0; 2],
        by(DEPTH, own.width),
        spacing,
    );
    let (mut wet, mut dry) = (Vec::new(), tank.points().to_vec());
    for x in block.points() {
        if stands(*x) { &mut dry } else { &mut wet }.push(*x);
    }
    let body = Body::points_of("water", water, wet, spacing)
        .jitter(0.01, seed(7))
        .hydrostatic(down, by(DEPTH, 0.0));
    let scene = Scene::new(cures.liquid())
        .body(body)
        .wall(Wall::of("tank", dry, spacing))
        .acceleration(move |_| down);
    let mut tank = scene.varied().build().expect("a scene");
    let count = tank.particles() as f64;
    let height =
        |now: &Simulation<f64, 2>| now.all().map(|p| p.position()[up]).sum::<f64>() / count;
    let before = height(&tank);
    tank.keep_stability(Thresholds {
        momentum: 1e-9,
        ..Thresholds::default()
    });
    let ended = tank.run_until(lasting(duration) * (DEPTH / own.gravity).sqrt());
    println!("{own:?} {ended:?}\n{}", tank.stability());
    let whole = RHO * own.gravity * DEPTH;
    let error = |x: [f64; 2], p: f64| (p / whole - (1.0 - x[up] / DEPTH)).powi(2);
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

fn holds(case: &'static str, own: Tank, duration: f64) {
    let [pressure, rise, speed] = rest(own, Cures::NONE, duration);
    let [noisy, risen, fast] = rest(own, BARE, duration);
    println!("rise {rise} {risen}");
    assert!(rise < 0.5, "{rise}");
    let row = |criterion, value, control| Row {
        case,
        criterion,
        value,
        control,
    };
    row("RMS error of pressure over ρgH", pressure, noisy).at_most(0.01);
    row("RMS speed over sound", speed, fast).at_most(1e-4);
}

#[test]
fn a_column_at_rest_keeps_its_pressure() {
    holds("hydrostatic tank, 40 √(H/g)", COLUMN, 40.0);
    // What keeps a liquid in tension even is no cure here: shifting lets the surface rise, and the pressure errs by more.
    let even = rest(COLUMN, Cures::EVEN, 40.0);
    println!("with the cures of tension {even:?}");
}

#[test]
fn so_does_one_above_a_step() {
    let stepped = Tank {
        width: 1.0,
        step: [0.5, 0.4],
        ..COLUMN
    };
    holds("tank with a stepped bottom, 40 √(H/g)", stepped, 40.0);
}

#[test]
fn so_does_one_that_stands_against_a_wall_at_30_g() {
    let thrown = Tank {
        gravity: 30.0 * GRAVITY,
        sideways: true,
        ..COLUMN
    };
    holds("at rest against a wall at 30 g, 40 √(H/g)", thrown, 40.0);
}

/// The RMS speed over the speed of sound of a periodic box of displaced particles, after so many crossings of it by
/// sound.
fn noise(cures: Cures) -> f64 {
    let water: Material<f64> = catalogue::water_at(SoundSpeed::Chosen(10.0));
    // Under pressure, which tells the particles that they are displaced.
    let body = Body::block("water", water, [0.0; 2], [1.0; 2], 0.04)
        .jitter(0.2, seed(5))
        .density(1.01 * RHO);
    let bath = Scene::new(cures.liquid())
        .body(body)
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0));
    let mut bath = bath.varied().build().expect("a scene");
    bath.run_until(lasting(4.0)).expect("rest");
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
