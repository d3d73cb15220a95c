//! Walls and bodies without slip that turn: a full drum, and liquid between two cylinders.
//! Liquid in a drum turns as a solid with it, and between cylinders the torque is that of Couette's flow.

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

/// The same with forces between particles along the line between them, which keep angular momentum.
fn central() -> Scheme<f64, 2> {
    schemes::weakly_compressible()
        .density_diffusion(Antuono::default())
        .with_viscosity(Inviscid)
        .with(Laminar(CentralViscosity))
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

/// Moments \[N\] of the liquid on the inner and the outer cylinder, over that of Couette's flow, with `count` particles across the
/// gap.
fn torques(scheme: Scheme<f64, 2>, count: f64, [inner, outer]: [f64; 2]) -> [f64; 2] {
    let radii = [0.5, 1.0];
    let spacing = (radii[1] - radii[0]) / count;
    let [small, large] = radii.map(|r| Ball::new([0.0; 2], r));
    let origin = [0.5 * spacing; 2];
    let reach = 4.0 * spacing;
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
    let mut simulation = Scene::<f64, 2>::new(scheme)
        .body(liquid(gap, spacing, |r| a + b / (r * r)))
        .wall(wall("inner", core, inner))
        .wall(wall("outer", shell, outer))
        .build()
        .expect("two cylinders");
    simulation.run_until(0.4).expect("a start");
    let exact = 4.0 * core::f64::consts::PI * VISCOSITY * b;
    let (mut sums, readings) = ([0.0; 2], 20);
    for k in 1..=readings {
        simulation
            .run_until(0.4 + 0.02 * f64::from(k))
            .expect("a turn");
        for ([x, y], [fx, fy]) in simulation.wall_particle_forces() {
            let side = usize::from(x.hypot(y) > 0.75);
            sums[side] += (x * fy - y * fx) / (exact * f64::from(readings));
        }
    }
    sums
}

/// The Laplacian of a velocity takes μ ∂v/∂n for the friction, which is that of a liquid on a cylinder at rest.
#[test]
#[ignore = "takes half a minute"]
fn a_cylinder_at_rest_feels_the_torque_of_couette() {
    for (rates, at_rest) in [([OMEGA, 0.0], 1), ([0.0, OMEGA], 0)] {
        let torques = torques(laminar(), 20.0, rates);
        println!("{rates:?}: {torques:.4?}");
        assert!((torques[at_rest].abs() - 1.0).abs() < 0.02, "{torques:?}");
    }
}

/// Forces along the line between particles give both cylinders the same torque.
#[test]
#[ignore = "takes half a minute"]
fn central_forces_keep_angular_momentum_between_cylinders() {
    for rates in [[OMEGA, 0.0], [0.0, OMEGA]] {
        let torques = torques(central(), 20.0, rates);
        println!("{rates:?}: {torques:.4?}");
        assert!((torques[0] + torques[1]).abs() < 0.03, "{torques:?}");
    }
}
