//! Walls and bodies without slip that turn: a full drum, and liquid between two cylinders.
//! Liquid in a drum turns as a solid with it, and between cylinders the torque is that of Couette's flow.

use meshfree::effect::{ExtrapolatedPressure, VolumeConsistency};
use meshfree::geometry::{fill, layers};
use meshfree::material::eos::Linear;
use meshfree::material::{Liquid, SoundSpeed};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::term::viscosity::Inviscid;
use meshfree::term::{Antuono, CentralViscosity, LaminarViscosity};

/// Rate of turning \[rad/s\] and radius \[m\] of the drum; dynamic viscosity \[Pa s\] and density \[kg/m³\] of the liquid.
const OMEGA: f64 = 1.0;
const RADIUS: f64 = 1.0;
const VISCOSITY: f64 = 200.0;
const DENSITY: f64 = 1000.0;

/// A liquid with nothing else that takes energy from shear. Its density diffusion leaves linear densities alone, and with
/// them the pressure of a liquid that turns.
fn laminar() -> Scheme<f64, 2> {
    schemes::weakly_compressible()
        .density_diffusion(Antuono::default())
        .with_viscosity(Inviscid)
        .with(Laminar(LaminarViscosity))
        .compose()
}

/// A closed domain that is sheared: forces of friction along the line between particles, which keep angular momentum, particles
/// that stay evenly spread, densities that stay those of their places, and walls that pull as well as push.
pub fn sheared() -> Scheme<f64, 2> {
    schemes::weakly_compressible()
        .h_over_dx(2.0)
        .density_diffusion(Antuono::default())
        .walls(ExtrapolatedPressure {
            floor: f64::NEG_INFINITY,
        })
        .with_viscosity(Inviscid)
        .with(Laminar(CentralViscosity))
        .with(Shifting::CLOSED)
        .with(VolumeConsistency { strength: 0.05 })
        .compose()
}

fn liquid(points: Vec<[f64; 2]>, spacing: f64, rate: impl Fn(f64) -> f64) -> Body<f64, 2> {
    let water = Liquid::new(DENSITY, 1500.0, VISCOSITY)
        .material("water", SoundSpeed::artificial(OMEGA * RADIUS));
    Body::points_of("water", water, points, spacing).start(|[x, y], start| {
        let turning = rate(x.hypot(y));
        Start {
            velocity: [-turning * y, turning * x],
            ..start
        }
    })
}

/// What the drum is made of.
#[derive(Clone, Copy, Debug)]
enum Drum {
    Wall,
    Led,
    Rigid,
}

/// A solid so heavy that the liquid does not brake it.
fn lead(points: Vec<[f64; 2]>, spacing: f64) -> Body<f64, 2> {
    let lead = Material::new("lead", Linear::new(1e9, 10.0));
    Body::points_of("drum", lead, points, spacing)
        .no_slip()
        .start(|[x, y], start| Start {
            velocity: [-OMEGA * y, OMEGA * x],
            ..start
        })
}

fn turning() -> Rotation<2> {
    Rotation::about([0.0; 2], |t| [OMEGA * t, OMEGA, 0.0])
}

/// Angular momentum of the liquid in a drum with `count` particles on its radius, over Σ m r² ω, after `time` \[s\] from
/// 0.95 of it.
fn drum(of: Drum, count: f64, time: f64) -> f64 {
    let spacing = RADIUS / count;
    let ball = Ball::new([0.0; 2], RADIUS);
    let origin = [0.5 * spacing; 2];
    let inside = fill(&ball, spacing, origin).expect("a drum");
    let shell = layers(&ball, spacing, 4.0 * spacing, origin).expect("a shell");
    let scene = Scene::<f64, 2>::new(laminar()).body(liquid(inside, spacing, |_| 0.95 * OMEGA));
    let solid = schemes::impact_by_continuity();
    let scene = match of {
        Drum::Wall => scene.wall(Wall::of("drum", shell, spacing).no_slip().motion(turning())),
        Drum::Led => scene
            .group(solid, [lead(shell, spacing)])
            .clamp("drum", |_| true, turning()),
        Drum::Rigid => scene.group(solid, [lead(shell, spacing)]).rigid("drum"),
    };
    let mut simulation = scene.build().expect("a drum full of water");
    simulation.run_until(time).expect("a turn");
    let (mut momentum, mut solid) = (0.0, 0.0);
    for particle in simulation.body("water").expect("water") {
        let ([x, y], [u, v], m) = (particle.position(), particle.velocity(), particle.mass());
        momentum += m * (x * v - y * u);
        solid += m * (x * x + y * y) * OMEGA;
    }
    momentum / solid
}

/// Mirrored in the surface of the drum and not in its particles: 1 + dx/(2 R) without that, 1.07 and 1.035.
#[test]
fn liquid_in_a_drum_turns_with_it() {
    for (count, of) in [
        (6.0, Drum::Wall),
        (8.0, Drum::Wall),
        (16.0, Drum::Wall),
        (8.0, Drum::Led),
        (8.0, Drum::Rigid),
    ] {
        let least = if count < 8.0 { 0.02 } else { 0.002 };
        let ratio = drum(of, count, 4.0);
        println!("{of:?}, R/dx {count}: {ratio:.5}");
        assert!((ratio - 1.0).abs() < least, "{of:?} {count}: {ratio}");
    }
}

/// Moments \[N\] of the liquid on the inner and the outer cylinder, over that of Couette's flow, with 20 particles across the
/// gap: means over all steps between two times \[s\].
fn torques([inner, outer]: [f64; 2], [begin, end]: [f64; 2]) -> [f64; 2] {
    let radii = [0.5, 1.0];
    let spacing = (radii[1] - radii[0]) / 20.0;
    let [small, large] = radii.map(|r| Ball::new([0.0; 2], r));
    let origin = [0.5 * spacing; 2];
    let reach = 5.0 * spacing;
    let mut gap = fill(&large, spacing, origin).expect("a gap");
    let core: Vec<[f64; 2]> = (fill(&small, spacing, origin)
        .expect("a cylinder")
        .into_iter())
    .filter(|x| small.signed_distance(x) > -reach)
    .collect();
    gap.retain(|x| !small.signed_distance(x).is_sign_negative());
    let shell = layers(&large, spacing, reach, origin).expect("a shell");
    let wall = |name: &str, points: Vec<[f64; 2]>, rate: f64| {
        let motion = Rotation::about([0.0; 2], move |t| [rate * t, rate, 0.0]);
        Wall::of(name, points, spacing).no_slip().motion(motion)
    };
    let squares = radii.map(|r| r * r);
    let between = squares[1] - squares[0];
    let (a, b) = (
        (outer * squares[1] - inner * squares[0]) / between,
        (inner - outer) * squares[0] * squares[1] / between,
    );
    let mut simulation = Scene::<f64, 2>::new(sheared())
        .body(liquid(gap, spacing, |r| a + b / (r * r)))
        .wall(wall("inner", core, inner))
        .wall(wall("outer", shell, outer))
        .build()
        .expect("two cylinders");
    simulation.run_until(begin).expect("a start");
    let exact = 4.0 * core::f64::consts::PI * VISCOSITY * b * (end - begin);
    let (mut sums, mut time) = ([0.0; 2], begin);
    // Steps of walls of a lattice feel every wave of pressure: of single readings the torque scatters by a fifth.
    let add = |now: &Simulation<f64, 2>| {
        let dt = now.time() - time;
        time = now.time();
        for ([x, y], [fx, fy]) in now.wall_particle_forces() {
            sums[usize::from(x.hypot(y) > 0.75)] += dt * (x * fy - y * fx) / exact;
        }
    };
    simulation.run_with(end, add).expect("a turn");
    sums
}

fn both_feel_couette(rates: [f64; 2], times: [f64; 2]) {
    let torques = torques(rates, times);
    println!("{rates:?}: {torques:.4?}");
    for (torque, sign) in torques.into_iter().zip([-1.0, 1.0]) {
        assert!((sign * torque - 1.0).abs() < 0.02, "{torques:?}");
    }
}

#[test]
fn cylinders_feel_the_torque_of_couette() {
    both_feel_couette([0.0, OMEGA], [0.5, 1.0]);
}

#[test]
#[ignore = "takes a minute"]
fn cylinders_feel_the_torque_of_couette_whichever_turns() {
    for rates in [[OMEGA, 0.0], [0.0, OMEGA]] {
        both_feel_couette(rates, [0.5, 2.5]);
    }
}
