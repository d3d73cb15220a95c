//! Small scenes of each kind that runs on a device; what is compiled of them does not depend on their size.
//! Schemes come from outside, so that each has the effects that its precision runs.

use meshfree::integrator::StrongStabilityPreserving3;
use meshfree::material::eos::{IdealGas, Linear};
use meshfree::material::failure::JohnsonCookFailure;
use meshfree::material::strength::{JohnsonCook, PlasticHeating};
use meshfree::prelude::*;

const SPACING: f64 = 0.05;

/// Numbers that differ along the first axis, or along the last.
fn first<const D: usize>(own: f64, others: f64) -> [f64; D] {
    core::array::from_fn(|d| if d == 0 { own } else { others })
}
fn last<const D: usize>(own: f64, others: f64) -> [f64; D] {
    core::array::from_fn(|d| if d + 1 == D { own } else { others })
}

/// To and fro along the first axis.
fn swing<const D: usize>() -> Translation<D> {
    Translation::new(
        |t: f64| first(0.01 * (20.0 * t).sin(), 0.0),
        |t: f64| first(0.2 * (20.0 * t).cos(), 0.0),
        |t: f64| first(-4.0 * (20.0 * t).sin(), 0.0),
    )
}

/// A tank of a size, open at the top.
fn around<const D: usize>(size: f64) -> Wall<D> {
    let mut closed = [[true; 2]; D];
    closed[D - 1][1] = false;
    Wall::around("tank", [0.0; D], [size; D], SPACING, 3, closed)
}

fn water<T: Real>() -> Material<T> {
    let water = catalogue::weakly_compressible_water::<T>(2.0).with_dynamic_viscosity(1.0);
    water.with_pressure_cut_off(-1e3)
}

/// Water in a tank that swings and to which it sticks.
pub fn tank<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    let high = last(0.15, 0.3);
    Scene::new(scheme)
        .body(Body::block("water", water(), [0.0; D], high, SPACING))
        .wall(around(0.3).no_slip().motion(swing()))
        .acceleration(|_| last(-9.81, 0.0))
}

/// Oil on water, periodic along the first axis and between planes along the last.
pub fn layers<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    let oil = Material::new("oil", Linear::new(900.0, 20.0)).with_dynamic_viscosity(2.0);
    let plane = |at, side| MirrorPlane::wall(last(at, 0.0), last(side, 0.0));
    Scene::new(scheme)
        .body(Body::block(
            "water",
            water(),
            [0.0; D],
            last(0.2, 0.4),
            SPACING,
        ))
        .body(Body::block("oil", oil, last(0.2, 0.0), [0.4; D], SPACING))
        .boundary(Periodic::along(0, 0.0, 0.4))
        .boundary(plane(0.0, -1.0))
        .boundary(plane(0.4, 1.0))
        .acceleration(|_| last(-9.81, 0.0))
}

/// A gas that is hot on one side, between planes.
pub fn blast<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    let air = Material::<T>::new("air", IdealGas::new(1.4, 1.0));
    let start = |x: [f64; D], start| meshfree::scheme::Start {
        energy: if x[0] < 0.2 { 20.0 } else { 1.0 },
        ..start
    };
    let gas = Body::block("air", air, [0.0; D], [0.5; D], SPACING).start(start);
    Scene::new(scheme)
        .body(gas)
        .boundary(MirrorPlane::symmetry([0.0; D], first(-1.0, 0.0)))
        .boundary(MirrorPlane::symmetry([0.5; D], first(1.0, 0.0)))
}

/// The same by an integrator that keeps states.
pub fn kept_blast<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    blast(scheme).integrator(StrongStabilityPreserving3)
}

/// Two bars of copper that meet, one of them at a rigid plane.
pub fn bars<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    let strength = JohnsonCook::new(90e6, 292e6, 0.31).with_rate_sensitivity(0.025);
    let failure = JohnsonCookFailure::new(0.54, 4.89, -3.03).with_rate_sensitivity(0.014);
    let copper = catalogue::copper::<T>()
        .with_shear_modulus(46e9)
        .with_plastic_heating(PlasticHeating::new(383.0))
        .with_strength(strength.with_softening(1.09, 1356.0))
        .with_failure(failure.with_heat_sensitivity(1.12, 1356.0));
    let bar = |name, low: f64, speed: f64| {
        let high = first(low + 0.4, 0.2);
        Body::block(name, copper.clone(), first(low, 0.0), high, SPACING)
            .velocity(first(-speed, 0.0))
    };
    Scene::new(scheme)
        .body(bar("left", 0.0, 50.0))
        .body(bar("right", 0.45, 150.0))
        .boundary(MirrorPlane::wall([0.0; D], first(-1.0, 0.0)))
}

/// A free body that is bent, by its neighbours as built.
pub fn bent<T: Real, const D: usize>(scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    let strength = JohnsonCook::new(90e6, 292e6, 0.31).with_rate_sensitivity(0.025);
    let copper = catalogue::copper::<T>()
        .with_shear_modulus(46e9)
        .with_plastic_heating(PlasticHeating::new(383.0))
        .with_strength(strength.with_softening(1.09, 1356.0));
    let bend = |x: [f64; D], start| meshfree::scheme::Start {
        velocity: last(50.0 * x[0], 0.0),
        ..start
    };
    let body = Body::block("bar", copper, [0.0; D], first(0.6, 0.2), SPACING).start(bend);
    Scene::new(scheme).body(body)
}

/// A plate of rubber across a tank of water, fixed at one end and moved at the other.
pub fn plate<T: Real, const D: usize>(solid: impl Into<Scheme<T, D>>) -> Scene<T, D>
where
    WendlandC2: Kernel<D>,
{
    let side = 8_usize;
    let all = (0..side.pow(D as u32)).map(|n| {
        let along: [usize; D] = core::array::from_fn(|d| n / side.pow(d as u32) % side);
        (along[D - 1], along.map(|k| (k as f64 + 0.5) * SPACING))
    });
    let (plate, liquid): (Vec<_>, Vec<_>) = all.partition(|own| (3..5).contains(&own.0));
    let [plate, liquid] = [plate, liquid].map(|own| own.into_iter().map(|own| own.1).collect());
    let rubber = Material::new("rubber", Linear::new(1500.0, 30.0)).with_shear_modulus(4e5);
    Scene::new(schemes::weakly_compressible())
        .body(Body::points_of("water", water(), liquid, SPACING))
        .group(solid, [Body::points_of("plate", rubber, plate, SPACING)])
        .wall(around(side as f64 * SPACING))
        .between("plate", "tank", Interaction::None)
        .fix("plate", |x| x[0] < 2.0 * SPACING)
        .clamp("plate", |x| x[0] > 6.0 * SPACING, swing())
        .acceleration(|_| last(-9.81, 0.0))
}
