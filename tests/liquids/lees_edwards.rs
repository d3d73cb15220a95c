//! Homogeneous shear without walls, by Lees–Edwards boundaries: the linear profile stays, a wave on it decays as
//! viscosity says, and momentum is what the boundary has given; with a control.

use meshfree::kernel::WendlandC2;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::term::LaminarViscosity;
use meshfree::term::viscosity::Inviscid;
use std::f64::consts::TAU;

const DENSITY: f64 = 1000.0;
/// Kinematic viscosity \[m²/s\].
const VISCOSITY: f64 = 0.02;
/// Particles along a side of the unit square, which is sheared by 1 per second.
const COUNT: f64 = 20.0;

/// How a run starts, apart from the linear profile.
#[derive(Clone, Copy, Default)]
struct Start {
    /// Amplitude of a wave of velocity along the flow \[m/s\].
    wave: f64,
    /// Velocity of all up the gradient \[m/s\].
    rise: f64,
    /// How far particles are off the lattice at most, in spacings.
    noise: f64,
}

/// A scheme that takes energy from shear by viscosity alone.
fn viscous() -> SchemeBuilder<WendlandC2, Inviscid, ExtrapolatedPressure, impl Effects<2>> {
    schemes::weakly_compressible()
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
}

/// The square under a scheme and its integrator.
fn square(scheme: impl Into<Scheme<f64, 2>>, start: Start) -> Scene<f64, 2> {
    let liquid = Liquid::new(DENSITY, 1480.0, DENSITY * VISCOSITY).linear();
    let liquid = liquid.material("liquid", SoundSpeed::Chosen(20.0));
    let body = Body::block("liquid", liquid.clone(), [0.0; 2], [1.0; 2], 1.0 / COUNT);
    let off = |x: f64, y: f64| (43_758.5 * (12.9 * COUNT * x + 78.2 * COUNT * y).sin()).fract();
    let moved = |&[x, y]: &[f64; 2]| {
        let [a, b] = [off(x, y), off(y, x)].map(|off| off * start.noise / COUNT);
        [x + a, y + b]
    };
    let points = body.points().iter().map(moved).collect();
    let body = Body::points_of("liquid", liquid, points, 1.0 / COUNT).start(|x, at_rest| {
        let wave = start.wave * (TAU * x[1]).sin();
        meshfree::scene::Start {
            velocity: [x[1] + wave, start.rise],
            ..at_rest
        }
    });
    Scene::new(scheme).body(body)
}

fn unit(axis: usize) -> Periodic {
    Periodic::along(axis, 0.0, 1.0)
}

fn sheared(scene: Scene<f64, 2>) -> Simulation<f64, 2> {
    let shear = LeesEdwards::new(unit(0), unit(1), 1.0);
    scene.boundary(shear).build().expect("a sheared square")
}

/// The largest difference \[m/s\] from the linear profile, and the amplitude of a wave on it \[m/s\].
fn departure(now: &Simulation<f64, 2>, rise: f64) -> [f64; 2] {
    let share = 2.0 / now.particles() as f64;
    now.all().fold([0.0; 2], |[most, wave], particle| {
        let (y, u) = (particle.position()[1], particle.velocity()[0]);
        // What rises keeps its velocity, so the profile rises too.
        let off = u - (y - rise * now.time());
        [off.abs().max(most), wave + share * off * (TAU * y).sin()]
    })
}

/// Momentum along the flow less what the boundary has given \[kg/s\].
fn own_momentum(now: &Simulation<f64, 2>) -> f64 {
    let ledger = now.ledger();
    ledger.whole.momentum[0] - ledger.boundary_impulse[0]
}

/// Sheared by 2, so that copies slide past each other twice; returns the departure then.
fn after(scene: Scene<f64, 2>, rise: f64) -> f64 {
    let mut flow = sheared(scene);
    let before = own_momentum(&flow);
    flow.run_until(2.0).expect("a stable run");
    let lost = own_momentum(&flow) / before - 1.0;
    assert!(lost.abs() < 1e-11, "momentum changes by {lost}");
    departure(&flow, rise)[0]
}

/// A lattice stays on the linear profile to rounding (2e-13), also where all of it rises through the period, which
/// wraps every particle twice.
#[test]
fn a_lattice_is_sheared_exactly() {
    let still = Start::default();
    let rising = Start { rise: 1.2, ..still };
    for (scene, rise) in [
        (square(viscous(), still), 0.0),
        (square(viscous(), rising), 1.2),
    ] {
        let off = after(scene, rise);
        assert!(off < 1e-11, "off by {off} m/s at {rise} m/s");
    }
}

/// Particles a fifth of a spacing off the lattice pass each other, and stay within 1.6 % of the profile.
#[test]
fn shear_stays_linear_among_particles_that_mix() {
    let start = Start {
        noise: 0.2,
        ..Start::default()
    };
    let off = after(square(viscous(), start), 0.0);
    assert!(off < 0.02, "off by {off} m/s");
}

/// Without the slide the jump at the seam spreads, and the profile is gone.
#[test]
fn plain_periods_do_not_keep_shear() {
    let scene = square(viscous(), Start::default());
    let mut flow = scene
        .boundary(unit(0))
        .boundary(unit(1))
        .build()
        .expect("a square");
    flow.run_until(1.0).expect("a stable run");
    let [off, _] = departure(&flow, 0.0);
    assert!(off > 0.4, "off by {off} m/s only");
}

/// The stress μ γ̇ as a wave on the shear feels it: exp(−ν k² t) gives back ν within 2 %.
#[test]
fn a_wave_on_the_shear_decays_by_viscosity() {
    let start = Start {
        wave: 0.1,
        ..Start::default()
    };
    let mut flow = sheared(square(viscous(), start));
    let first = departure(&flow, 0.0)[1];
    flow.run_until(2.0).expect("a stable run");
    let left = departure(&flow, 0.0)[1] / first;
    let viscosity = -left.ln() / (2.0 * TAU * TAU);
    assert!(
        (viscosity / VISCOSITY - 1.0).abs() < 0.02,
        "{viscosity} m²/s"
    );
}
