//! Place changes nothing: a scene that is moved by a power of two of spacings has the same bits, in every kind of scheme and in
//! both scalars, and one that is moved by anything else differs by the rounding of its places.

use super::bits::said_but_places;
use crate::common::Random;
use meshfree::boundary::{Boundary, Crush, Inlet, LeesEdwards, Outlet, Rotation, Wall};
use meshfree::coupling::ContactDensity;
use meshfree::effect::{FiniteStrainPlasticity, Hypoelastic, NeoHookean};
use meshfree::integrator::Predictor;
use meshfree::material::Material;
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::observe::{FlowPlane, PressureProbe, WaveGauge};
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::sweep::Transform;
use meshfree::tensor::{Matrix, Vector};
use meshfree::term::CentralViscosity;
use meshfree::term::viscosity::CullenDehnen;
use std::f64::consts::PI;

/// A power of two, so that places on a lattice are exact.
const DX: f64 = 1.0 / 64.0;
/// Shifts by powers of two of spacings: nearby, and to map coordinates.
const SHIFTS: [f64; 3] = [DX, -524_288.0, 4_194_304.0];

fn run<T: Real, const D: usize>(scene: Scene<T, D>, steps: usize) -> Simulation<T, D> {
    let mut simulation = scene.build().unwrap();
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation
}

/// The largest distance \[m\] between places of two runs, of which the second has been moved.
fn apart<T: Real, const D: usize>(
    one: &Simulation<T, D>,
    other: &Simulation<T, D>,
    shift: &[f64; D],
) -> f64 {
    let walls = 0..one.walls().count();
    let all = |of: &Simulation<T, D>| -> Vec<[f64; D]> {
        let walls = walls.clone().flat_map(|wall| of.wall(wall).unwrap());
        of.all().chain(walls).map(|p| p.position()).collect()
    };
    let (one, other) = (all(one), all(other));
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(&other);
    let off = pairs.flat_map(|(x, y)| (0..D).map(move |d| (y[d] - shift[d] - x[d]).abs()));
    off.fold(0.0, f64::max)
}

/// The farthest rounding \[m\] of places that are moved.
fn rounding<const D: usize>(shift: &[f64; D]) -> f64 {
    shift.iter().fold(1.0, |most: f64, s| most.max(s.abs())) * f64::EPSILON
}

/// The same bits wherever the scene is.
fn same_bits<T: Real, const D: usize>(name: &str, scene: impl Fn([f64; D]) -> Scene<T, D>) {
    const STEPS: usize = 60;
    let here = run(scene([0.0; D]), STEPS);
    let bits = said_but_places(&here);
    for by in SHIFTS {
        let shift = core::array::from_fn(|d| by / (1 << (2 * d)) as f64);
        let there = run(scene(shift), STEPS);
        assert!(
            said_but_places(&there) == bits,
            "{name} in {}, moved by {shift:?}",
            T::NAME
        );
        let off = apart(&here, &there, &shift);
        assert!(
            off <= rounding(&shift),
            "{name} in {}: {off:.1e} m",
            T::NAME
        );
    }
}

/// A shift that nothing is a whole number of.
fn anywhere<const D: usize>() -> [f64; D] {
    core::array::from_fn(|d| [523_456.789, 4_187_654.321, -77.7][d])
}

/// Differs by the rounding of places alone, however it grows.
fn same_places<T: Real, const D: usize>(
    name: &str,
    steps: usize,
    growth: f64,
    scene: impl Fn([f64; D]) -> Scene<T, D>,
) {
    let shift = anywhere();
    let (here, there) = (run(scene([0.0; D]), steps), run(scene(shift), steps));
    let off = apart(&here, &there, &shift);
    println!(
        "{name} in {}: {:.1e} of the rounding",
        T::NAME,
        off / rounding(&shift)
    );
    assert!(
        off <= growth * rounding(&shift),
        "{name} in {}: {off:.1e} m",
        T::NAME
    );
}

fn moved<const D: usize>(x: [f64; D], shift: [f64; D]) -> [f64; D] {
    core::array::from_fn(|d| x[d] + shift[d])
}

fn rods<T: Real>([s]: [f64; 1]) -> Scene<T, 1> {
    let dx = DX / 64.0;
    let rod = |name: &str, material, low: f64, high: f64| {
        Body::block(name, material, [s + low * dx], [s + high * dx], dx)
    };
    Scene::new(schemes::impact())
        .body(rod("striker", catalogue::copper(), 0.0, 40.0).velocity([20.0]))
        .body(rod("target", catalogue::pmma(), 40.0, 100.0))
        .boundary(MirrorPlane::wall([s + 100.0 * dx], [1.0]))
}

/// Both scalars, with the same scene.
macro_rules! in_both {
    ($name:literal, $scene:ident) => {
        same_bits($name, $scene::<f64>);
        same_bits($name, $scene::<f32>);
    };
}

#[test]
fn rods_that_touch_and_part() {
    in_both!("rods", rods);
}

fn rod_before_a_wall_that_comes<T: Real>([s]: [f64; 1]) -> Scene<T, 1> {
    let rod = Body::block(
        "rod",
        catalogue::copper(),
        [s],
        [s + 127.0 / 128.0 * DX],
        DX / 128.0,
    );
    Scene::new(schemes::impact_by_continuity())
        .body(rod.velocity([30.0]))
        .boundary(MirrorPlane::wall([s + DX], [1.0]).moving(-20.0))
        .integrator(DriftKickDrift)
}

fn rod_through_a_period<T: Real>([s]: [f64; 1]) -> Scene<T, 1> {
    let rod = Body::block("rod", catalogue::copper(), [s], [s + DX], DX / 64.0);
    Scene::new(schemes::impact().energy(EnergyForm::Symmetric))
        .body(rod.start(move |x, start| Start {
            velocity: [4000.0 + 50.0 * (2.0 * PI / DX * (x[0] - s)).sin()],
            ..start
        }))
        .boundary(Periodic::along(0, s, s + DX))
        .integrator(RungeKutta4)
}

fn printed_leapfrog<T: Real>([s]: [f64; 1]) -> Scene<T, 1> {
    let dx = DX / 64.0;
    let block = |name, low: f64, high: f64| {
        Body::block(
            name,
            catalogue::copper(),
            [s + low * dx],
            [s + high * dx],
            dx,
        )
    };
    Scene::new(schemes::lam2002())
        .body(block("striker", 0.0, 40.0).velocity([20.0]))
        .body(block("target", 40.0, 100.0))
        .between("striker", "target", Interaction::Bonded)
        .integrator(LamLeapfrog {
            predictor: Predictor::Lagged,
        })
}

fn gas_between_mirrors<T: Real>([s]: [f64; 1]) -> Scene<T, 1> {
    let gas = IdealGas::new(1.4, 1.0);
    let tube = Body::block("tube", Material::new("gas", gas), [s - 0.5], [s + 0.5], DX);
    let tube = tube.start(move |x, start| Start {
        velocity: [-0.5 * (2.0 * PI * (x[0] - s)).sin()],
        energy: gas.energy(if x[0] < s { 1.0 } else { 0.5 }, 1.0),
        ..start
    });
    let scheme = SchemeBuilder::new(CubicSpline, CullenDehnen::default())
        .density(DensityForm::Summation)
        .with(ConsistentSmoothing {
            smallest: 0.05,
            largest: 20.0,
        });
    Scene::new(scheme)
        .body(tube)
        .boundary(MirrorPlane::symmetry([s - 0.5], [-1.0]))
        .boundary(MirrorPlane::symmetry([s + 0.5], [1.0]))
        .integrator(PositionVerlet)
}

#[test]
fn planes_and_periods_in_one_dimension_by_four_integrators() {
    in_both!("continuity", rod_before_a_wall_that_comes);
    in_both!("period", rod_through_a_period);
    in_both!("lam", printed_leapfrog);
    in_both!("gas", gas_between_mirrors);
}

fn spinning_plate<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let steel = catalogue::steel().with_shear_modulus(77e9);
    let struck = move |x: [f64; 2], start| {
        let [x, y] = [x[0] - s[0], x[1] - s[1]];
        Start {
            velocity: [2000.0 * (5.0 * DX - y), 2000.0 * (x - 10.0 * DX)],
            ..start
        }
    };
    let high = moved([20.0 * DX, 10.0 * DX], s);
    Scene::new(schemes::impact_by_continuity().with(Hypoelastic))
        .body(Body::block("plate", steel, s, high, DX).start(struck))
}

/// A block of water off its lattice by whole numbers of 2⁻²² m, with random velocities.
fn splash<T: Real>(s: [f64; 2], counts: [usize; 2]) -> Body<T, 2> {
    let mut random = Random(3);
    let step = (-22_f64).exp2();
    let mut off = || (0.1 * DX * random.sign() / step).round() * step;
    let mut points = Vec::new();
    for k in 0..counts[0] * counts[1] {
        let on = [(k % counts[0]) as f64 + 0.5, (k / counts[0]) as f64 + 0.5];
        points.push(moved(on.map(|x| x * DX + off()), s));
    }
    let water = catalogue::weakly_compressible_water(2.0).with_dynamic_viscosity(0.5);
    let random = std::cell::RefCell::new(random);
    Body::points_of("water", water, points, DX).start(|_, start| Start {
        velocity: random.borrow_mut().vector(1.0),
        ..start
    })
}

fn down<const D: usize>(_time: f64) -> [f64; D] {
    core::array::from_fn(|d| if d + 1 == D { -9.81 } else { 0.0 })
}

fn around(name: &str, s: [f64; 2], counts: [f64; 2], closed: [[bool; 2]; 2]) -> Wall<2> {
    Wall::around(name, s, moved(counts.map(|n| n * DX), s), DX, 4, closed)
}

fn tank<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    Scene::new(schemes::weakly_compressible())
        .body(splash(s, [10, 10]))
        .wall(around("tank", s, [12.0, 14.0], [[true; 2], [true, false]]))
        .acceleration(down)
}

fn riemann_tank<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    Scene::new(schemes::weakly_compressible().walls(RiemannWalls::default()))
        .body(splash(s, [10, 10]))
        .wall(around("tank", s, [12.0, 14.0], [[true; 2], [true, false]]))
        .acceleration(down)
}

fn moving_tank<T: Real>(s: [f64; 2], motion: impl Fn(Wall<2>) -> Wall<2>) -> Scene<T, 2> {
    let scheme = schemes::weakly_compressible().with(Laminar(CentralViscosity));
    Scene::new(scheme)
        .body(splash(s, [10, 10]))
        .wall(motion(around("tank", s, [10.0; 2], [[true; 2]; 2])))
        .acceleration(down)
}

/// s = 0.02 sin(60 t), with its two derivatives.
fn swing(t: f64) -> [f64; 3] {
    let (sine, cosine) = (60.0 * t).sin_cos();
    [0.02 * sine, 1.2 * cosine, -72.0 * sine]
}

fn rolling_tank<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let centre = moved([5.0 * DX; 2], s);
    moving_tank(s, |wall| {
        wall.motion(Rotation::about(centre, swing))
            .no_slip()
            .container_frame()
    })
}

fn sliding_tank<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let part = |order: usize| move |t: f64| [swing(t)[order], 0.0];
    moving_tank(s, |wall| {
        wall.motion(Translation::new(part(0), part(1), part(2)))
            .container_frame()
    })
}

fn crushed_tank<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let fixed = s[1];
    moving_tank(s, |wall| {
        wall.motion(Crush::along(1, fixed, |t| [0.5 * t, 0.5, 0.0]))
    })
}

#[test]
fn liquids_in_tanks_at_rest_and_moving() {
    in_both!("plate", spinning_plate);
    in_both!("tank", tank);
    in_both!("Riemann walls", riemann_tank);
    in_both!("rolling", rolling_tank);
    in_both!("sliding", sliding_tank);
    in_both!("crushed", crushed_tank);
}

fn channel<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let opening = (0..10)
        .map(|k| moved([0.0, DX * (f64::from(k) + 0.5)], s))
        .collect();
    let water = catalogue::weakly_compressible_water(2.0);
    let high = moved([20.0 * DX, 10.0 * DX], s);
    let low = moved([-6.0 * DX, 0.0], s);
    let floors = Wall::around(
        "floors",
        low,
        moved([30.0 * DX, 10.0 * DX], s),
        DX,
        4,
        [[false; 2], [true; 2]],
    );
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, s, high, DX).velocity([4.0, 0.0]))
        .inlet(Inlet::new("water", opening, [4.0, 0.0], DX, 100))
        .outlet(Outlet::plane(moved([20.5 * DX, 0.0], s), [1.0, 0.0]))
        .outlet(Outlet::outside_box(moved([-1.0; 2], s), moved([1.0; 2], s)))
        .wall(floors)
}

fn soft<T: Real>(name: &str) -> Material<T> {
    Material::new(name, Linear::new(1100.0, 40.0))
        .with_shear_modulus(5e5)
        .with_yield_stress(2e3)
}

fn structure<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let [low, high] = [[-5.0, -10.0], [15.0, 0.0]].map(|x| moved(x.map(|x: f64| x * DX), s));
    let block = Body::block(
        "block",
        Material::new("soft", Linear::new(2000.0, 40.0)),
        low,
        high,
        DX,
    );
    Scene::new(schemes::weakly_compressible().with(Laminar(CentralViscosity)))
        .body(splash(s, [10, 10]))
        .group(schemes::impact(), [block.no_slip()])
        .acceleration(down)
        .sub_cycle("block", 16)
}

/// Water on an elastic plate that is clamped, a block that yields and touches it by a coupling, a wall, and a rigid body.
fn mixed<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let at = |x: [f64; 2]| moved(x.map(|x| x * DX), s);
    let water = catalogue::weakly_compressible_water(2.0);
    let plate = Body::block(
        "plate",
        soft("plate"),
        at([-4.0, -5.0]),
        at([14.0, 0.0]),
        DX,
    );
    let block = Body::block(
        "block",
        soft("block"),
        at([2.0, -10.5]),
        at([8.0, -5.5]),
        DX,
    );
    let wood = Material::new("wood", Linear::new(600.0, 20.0));
    let log = Body::block("log", wood, at([3.0, 8.0]), at([7.0, 12.0]), DX);
    let (from, to) = (s[0], s[0] + 10.0 * DX);
    Scene::new(schemes::weakly_compressible())
        .body(Body::block("water", water, s, at([10.0, 8.0]), DX))
        .group(schemes::total_lagrangian().with(NeoHookean), [plate])
        .group(
            schemes::total_lagrangian().with(FiniteStrainPlasticity),
            [block.velocity([0.0, 2.0])],
        )
        .group(schemes::impact_by_continuity(), [log.velocity([0.3, -1.0])])
        .rigid("log")
        .wall(around("tank", s, [10.0; 2], [[true; 2], [false; 2]]))
        .fix("plate", move |[x, _]| !(from..to).contains(x))
        .couple("plate", "block", ContactDensity::new())
        .between("water", "block", Interaction::None)
        .between("plate", "log", Interaction::None)
        .between("block", "log", Interaction::None)
        .between("plate", "tank", Interaction::None)
        .between("block", "tank", Interaction::None)
        .between("log", "tank", Interaction::None)
        .sub_cycle("plate", 8)
        .acceleration(down)
}

#[test]
fn what_enters_and_leaves() {
    in_both!("channel", channel);
}

#[test]
fn liquids_with_elastic_plastic_and_rigid_bodies() {
    in_both!("structure", structure);
    in_both!("mixed", mixed);
}

fn shifted<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let k = 2.0 * PI / (20.0 * DX);
    let water = catalogue::weakly_compressible_water(1.0);
    let high = moved([20.0 * DX; 2], s);
    Scene::new(schemes::weakly_compressible().with(Shifting::CLOSED))
        .body(
            Body::block("water", water, s, high, DX).start(move |x, start| {
                let [x, y] = [k * (x[0] - s[0]), k * (x[1] - s[1])];
                Start {
                    velocity: [x.sin() * y.cos(), -x.cos() * y.sin()],
                    ..start
                }
            }),
        )
        .boundary(Periodic::along(0, s[0], high[0]))
        .boundary(Periodic::along(1, s[1], high[1]))
}

fn sheared<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let liquid = catalogue::weakly_compressible_water(2.0).with_dynamic_viscosity(1.0);
    let high = moved([16.0 * DX; 2], s);
    let period = |axis: usize| Periodic::along(axis, s[axis], high[axis]);
    let body = Body::block("liquid", liquid, s, high, DX);
    Scene::new(schemes::weakly_compressible().with(Laminar(CentralViscosity)))
        .body(body.start(move |x, start| Start {
            velocity: [4.0 * (x[1] - s[1]), 0.0],
            ..start
        }))
        .boundary(LeesEdwards::new(period(0), period(1), 4.0))
}

/// A drop in a corner of mirrors, one of which is oblique.
fn corner<T: Real>(s: [f64; 3]) -> Scene<T, 3> {
    let water = catalogue::weakly_compressible_water(2.0);
    let drop = Body::block("drop", water, s, moved([6.0 * DX; 3], s), DX);
    Scene::new(schemes::weakly_compressible())
        .body(drop.velocity([-1.0, 0.2, -0.5]))
        .boundary(MirrorPlane::wall(s, [-1.0, 0.0, -0.25]))
        .boundary(MirrorPlane::wall(s, [0.0, -1.0, 0.0]))
        .acceleration(down)
}

#[test]
fn periods_shears_and_oblique_mirrors() {
    in_both!("shifted", shifted);
    in_both!("sheared", sheared);
    in_both!("corner", corner);
}

#[test]
fn moved_by_anything_else_a_scene_differs_by_rounding() {
    same_places("rods", 60, 4.0, rods::<f64>);
    same_places("rods", 60, 4.0, rods::<f32>);
    same_places("tank", 60, 4.0, tank::<f64>);
    same_places("tank", 60, 4.0, tank::<f32>);
    same_places("rolling", 60, 4.0, rolling_tank::<f64>);
    same_places("rolling", 60, 4.0, rolling_tank::<f32>);
    same_places("channel", 60, 4.0, channel::<f32>);
    same_places("mixed", 60, 4.0, mixed::<f64>);
    same_places("mixed", 60, 4.0, mixed::<f32>);
    same_places("sheared", 60, 4.0, sheared::<f32>);
    // What is asked with the origin added has its rounding in every step.
    same_places("well", 60, 40.0, well::<f32>);
    same_places("glide", 60, 40.0, glide::<f32>);
}

/// A load by place.
fn well<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    Scene::new(schemes::weakly_compressible())
        .body(splash(s, [10, 10]))
        .load(Load::acceleration(move |at| {
            core::array::from_fn(|d| -400.0 * (at.position[d] - s[d]))
        }))
}

/// A boundary of a user's own, which does not know of origins: periodic along x, and turned over in y.
#[derive(Clone, Debug)]
struct Glide {
    low: [f64; 2],
    period: f64,
}

impl Glide {
    fn by(&self, periods: f64) -> Transform<f64, 2> {
        let over = if periods as i64 % 2 == 0 { 1.0 } else { -1.0 };
        Transform {
            rotation: Matrix::<f64, 2>::new(1.0, 0.0, 0.0, over),
            shift: Vector::<f64, 2>::new(periods * self.period, (1.0 - over) * self.low[1]),
            velocity: Vector::<f64, 2>::zeros(),
        }
    }
}

impl Boundary<2> for Glide {
    fn name(&self) -> String {
        "glide".into()
    }
    fn images(&self) -> usize {
        2
    }
    fn transform(&self, image: usize, _time: f64) -> Transform<f64, 2> {
        self.by(if image == 0 { 1.0 } else { -1.0 })
    }
    fn reaches(&self, image: usize, x: &[f64; 2], reach: f64, _time: f64) -> bool {
        let x = x[0] - self.low[0];
        if image == 0 {
            x < reach
        } else {
            x > self.period - reach
        }
    }
    fn wrap(&self, x: &[f64; 2], _time: f64) -> Option<Transform<f64, 2>> {
        let periods = ((x[0] - self.low[0]) / self.period).floor();
        (periods != 0.0).then(|| self.by(-periods))
    }
}

fn glide<T: Real>(s: [f64; 2]) -> Scene<T, 2> {
    let low = moved([0.0, 3.0 * DX], s);
    Scene::new(schemes::weakly_compressible())
        .body(splash(s, [10, 6]))
        .boundary(Glide {
            low,
            period: 10.0 * DX,
        })
}

/// Still water in f32: as still at map coordinates as anywhere, and observers read it there.
#[test]
fn still_water_is_as_still_on_a_map() {
    let scene = |s: [f64; 2]| {
        let water = catalogue::weakly_compressible_water(2.0);
        let body = Body::block("water", water, s, moved([24.0 * DX, 12.0 * DX], s), DX);
        Scene::<f32, 2>::new(schemes::weakly_compressible())
            .body(body.hydrostatic([0.0, -9.81], moved([0.0, 12.0 * DX], s)))
            .wall(around("tank", s, [24.0, 16.0], [[true; 2], [true, false]]))
            .acceleration(down)
    };
    let look = |s: [f64; 2]| {
        let mut simulation = scene(s).build().unwrap();
        let middle = moved([12.0 * DX, 0.0], s);
        let probe = PressureProbe::disc(&simulation, "bottom", middle, [0.0, 1.0], 2.0 * DX);
        let gauge = WaveGauge::upwards(&simulation, "middle", middle, 1);
        let plane = FlowPlane::new(middle, [1.0, 0.0]);
        let mut fastest = 0.0_f64;
        let speed = |now: &Simulation<f32, 2>| {
            let speeds = now.all().map(|p| p.velocity()[0].hypot(p.velocity()[1]));
            speeds.fold(0.0, f64::max)
        };
        simulation
            .run_with(0.3, |now| fastest = fastest.max(speed(now)))
            .unwrap();
        let sample = simulation
            .sample(Field::POSITION, &[moved([0.2, 0.1], s)])
            .unwrap();
        let [x, y] = sample.vector(0).unwrap();
        let read = [
            fastest,
            probe.unwrap().pressure(&simulation),
            gauge.unwrap().height(&simulation),
            plane.unwrap().mass_beyond(&simulation),
            x - s[0],
            y - s[1],
        ];
        (said_but_places(&simulation), read)
    };
    let (bits, here) = look([0.0; 2]);
    println!("{here:?}");
    assert!(here[0] < 0.05, "{} m/s", here[0]);
    for s in [[10_240.0, 0.0], [0.0, -131_072.0], [524_288.0, 4_194_304.0]] {
        let (other, there) = look(s);
        assert!(other == bits, "at {s:?}");
        for (one, other) in here.iter().zip(there) {
            assert!(
                (one - other).abs() <= 1e-6 * one.abs(),
                "{here:?} {there:?} at {s:?}"
            );
        }
    }
    let (_, there) = look([5e5, 4.2e6]);
    assert!((there[0] / here[0] - 1.0).abs() < 0.1, "{there:?}");
}

/// Files hold the origin, and are of the scene where it was.
#[cfg(feature = "checkpoint")]
#[test]
fn a_run_goes_on_where_it_was() {
    let path = std::env::temp_dir().join(format!("meshfree-place-{}", std::process::id()));
    let mut whole = run(tank::<f32>(anywhere()), 20);
    whole.save(&path).unwrap();
    let mut resumed = tank::<f32>(anywhere()).resume(&path).unwrap();
    assert_eq!(resumed.origin(), whole.origin());
    let elsewhere = tank::<f32>([0.0; 2]).resume(&path);
    std::fs::remove_file(&path).unwrap();
    assert!(elsewhere.unwrap_err().to_string().contains("bodies"));
    for _ in 0..20 {
        whole.step().unwrap();
        resumed.step().unwrap();
    }
    assert!(said_but_places(&whole) == said_but_places(&resumed));
    assert!(apart(&whole, &resumed, &[0.0; 2]) == 0.0);
}

/// Water in a tank, and a drop as far away as f32 allows, or a little farther.
fn far_drop<T: Real>(spacings: f64) -> Scene<T, 2> {
    let water = || catalogue::weakly_compressible_water(2.0);
    let body = Body::block("water", water(), [0.0; 2], [24.0 * DX, 12.0 * DX], DX);
    let [low, high] = [0.0, 4.0].map(|n| [(spacings + n) * DX, 20.0 * DX + n * DX]);
    Scene::new(schemes::weakly_compressible())
        .body(body.hydrostatic([0.0, -9.81], [0.0, 12.0 * DX]))
        .body(Body::block("drop", water(), low, high, DX))
        .wall(around(
            "tank",
            [0.0; 2],
            [24.0, 16.0],
            [[true; 2], [true, false]],
        ))
        .acceleration(down)
}

#[test]
fn how_far_a_scene_may_reach() {
    let fastest = |scene: Scene<f32, 2>| {
        let mut simulation = scene.build().unwrap();
        let mut fastest = 0.0_f64;
        let speed = |now: &Simulation<f32, 2>| {
            let water = now.body("water").unwrap();
            let speeds = water.map(|p| p.velocity()[0].hypot(p.velocity()[1]));
            speeds.fold(0.0, f64::max)
        };
        simulation
            .run_with(0.3, |now| fastest = fastest.max(speed(now)))
            .unwrap();
        fastest
    };
    for spacings in [40.0, 1_600.0, 16_000.0, 160_000.0] {
        println!("{spacings}: {} m/s", fastest(far_drop(spacings)));
    }
    let [near, far] = [40.0, 160_000.0].map(|spacings| fastest(far_drop(spacings)));
    assert!(far < 1.5 * near, "{far} of {near} m/s");
    let problems = far_drop::<f32>(170_000.0).problems();
    let text = problems[0].to_string();
    assert!(
        text.contains("distance of body `water`") && text.contains("take f64"),
        "{text}"
    );
    assert_eq!(far_drop::<f64>(170_000.0).problems(), []);
}
