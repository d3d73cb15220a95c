//! Planes that mirror, impact with contacts that open, solids that flow and fail, and gases: on the device as on the host.
//! Energy is that of the work of kicks, which keeps its sum.

use crate::common::{device, in_any_groups};
use crate::compare::{in_both, in_double, load, on, on_device};
use crate::neighbours;
use meshfree::effect::{Damage, Effect, Point, PointRate, Reach, Setting, StepProgram};
use meshfree::kernel::{Kernel, WendlandC4};
use meshfree::material::eos::IdealGas;
use meshfree::material::failure::SpallStrength;
use meshfree::material::strength::PerfectPlasticity;
use meshfree::prelude::*;
use meshfree::scalar::Lane;
use meshfree_gpu::{Device, Run};

/// Deviatoric stress that relaxes at a rate \[1/s\]: growth of a field that turns with the material.
#[derive(Clone, Copy, Debug)]
struct Relaxing(f64);

impl<const D: usize> Effect<D> for Relaxing {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.contribute(Hypoelastic::STRESS, *self);
    }
}

impl<const D: usize> PointRate<D> for Relaxing {
    const GROWTH: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, _at: &Point<'_, L, D, P>, _: L, rate: &mut [L]) {
        rate[0] -= L::of(self.0);
    }
}

/// Water that sloshes between planes, of which one comes nearer.
fn pushed<T: Real>(fused: bool) -> Scene<T, 2> {
    let water = catalogue::weakly_compressible_water::<T>(2.0);
    let start = |[x, y]: [f64; 2], start| meshfree::scheme::Start {
        velocity: [0.5 * (10.0 * y).sin(), 0.5 * (10.0 * x).sin()],
        ..start
    };
    let body = Body::block("water", water, [0.0; 2], [0.3, 0.2], 0.0125).start(start);
    let scene = Scene::new(schemes::weakly_compressible())
        .body(body)
        .boundary(MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]).moving(-0.1))
        .boundary(MirrorPlane::symmetry([0.3, 0.0], [1.0, 0.0]))
        .boundary(MirrorPlane::symmetry([0.0; 2], [0.0, -1.0]))
        .acceleration(|_| [0.0, -9.81]);
    on(scene, fused)
}

#[test]
fn water_between_planes_is_that_of_the_host() {
    let Some(device) = device("water between planes") else {
        return;
    };
    let single = || pushed::<f32>(false);
    in_both(&device, "Planes", pushed::<f64>, single, 100);
}

/// Two copper rods that meet and part, one of them against a wall.
fn rods<T: Real>(fused: bool) -> Scene<T, 1> {
    let rod = |name: &str, low: f64, high: f64| {
        Body::block(name, catalogue::copper::<T>(), [low], [high], 2e-4)
    };
    let scene = Scene::new(schemes::impact())
        .body(rod("left", 0.0, 0.01).velocity([-50.0]))
        .body(rod("right", 0.0102, 0.02).velocity([-150.0]))
        .boundary(MirrorPlane::wall([-1e-4], [-1.0]));
    on(scene, fused)
}

/// A tube of gas with ends that mirror, hot at one end.
fn tube<T: Real>(fused: bool) -> Scene<T, 1> {
    let air = Material::new("air", IdealGas::new(1.4, 1.0));
    let half = |name: &str, low: f64, energy: f64| {
        Body::block(name, air.clone(), [low], [low + 0.5], 0.01).energy(energy)
    };
    let scheme = schemes::impact_by_continuity().between_bodies(Interaction::Bonded);
    let scene = Scene::new(scheme)
        .body(half("hot", 0.0, 2.5))
        .body(half("cold", 0.5, 1.5))
        .boundary(MirrorPlane::symmetry([0.0], [-1.0]))
        .boundary(MirrorPlane::symmetry([1.0], [1.0]));
    on(scene, fused)
}

/// A bar on a rigid wall that flows and fails, by its present neighbours.
fn bar<T: Real, const D: usize>(fused: bool, scheme: impl Into<Scheme<T, D>>) -> Scene<T, D> {
    let copper = catalogue::copper::<T>().with_shear_modulus(46e9);
    let copper = copper
        .with_strength(PerfectPlasticity::new(0.2e9))
        .with_failure(SpallStrength::new(0.5e9));
    let (mut size, mut away, mut velocity) = ([0.003; D], [0.0; D], [0.0; D]);
    (size[0], away[0], velocity[0]) = (0.008, -1.0, -300.0);
    let body = Body::block("bar", copper, [0.0; D], size, 5e-4).velocity(velocity);
    let scene = Scene::new(scheme)
        .body(body)
        .boundary(MirrorPlane::wall([0.0; D], away));
    on(scene, fused)
}

#[test]
fn impacts_in_one_dimension_are_those_of_the_host() {
    let Some(device) = device("impacts in one dimension") else {
        return;
    };
    in_both(&device, "Rods", rods::<f64>, || rods::<f32>(false), 200);
    in_double(&device, "Tube", tube::<f64>, 200);
    let [start, end] = [0, 200].map(|steps| on_device(&device, rods::<f64>(false), steps));
    let [start, end] = [start, end].map(|own| own.ledger().whole);
    assert!(end.internal - start.internal > 0.1 * start.kinetic);
    approx::assert_relative_eq!(
        end.total_energy(),
        start.total_energy(),
        max_relative = 1e-12
    );
}

#[test]
fn bars_that_flow_and_fail_are_those_of_the_host() {
    let Some(device) = device("bars that flow and fail") else {
        return;
    };
    let scheme = |relaxing: Option<Relaxing>| {
        let own = schemes::impact_by_continuity().with(Hypoelastic);
        own.with(Plasticity).with(Damage).with(relaxing)
    };
    let double = |fused| bar::<f64, 2>(fused, scheme(None));
    in_double(&device, "Bar", double, 100);
    let relaxing = |fused| bar::<f64, 2>(fused, scheme(Some(Relaxing(5e6))));
    in_double(&device, "Relaxing bar", relaxing, 60);
    let [own, without] = [relaxing(false), double(false)].map(|scene| {
        let end = on_device(&device, scene, 60);
        end.ledger().whole.total("distortion").expect("a solid")
    });
    assert!(own < 0.95 * without, "{own} {without}");
    // In space, with corrected gradients.
    let in_space = |fused| bar::<f64, 3>(fused, schemes::updated_lagrangian().with(Plasticity));
    in_double(&device, "Bar", in_space, 40);
    let end = on_device(&device, double(false), 100);
    for name in ["plastic work", "failed mass"] {
        assert!(end.ledger().whole.total(name) > Some(0.0), "{name}");
    }
}

/// A gas whose middle is hot, between planes, with smoothing lengths that follow the density.
fn blast<T: Real>(fused: bool) -> Scene<T, 2> {
    let air = Material::<T>::new("air", IdealGas::new(1.4, 1.0));
    let start = |[x, y]: [f64; 2], start| meshfree::scheme::Start {
        energy: if x.hypot(y) < 0.2 { 20.0 } else { 1.0 },
        ..start
    };
    let body = Body::block("air", air, [0.0; 2], [0.5; 2], 0.025).start(start);
    let mut scene = Scene::new(schemes::gas()).body(body);
    for axis in 0..2 {
        for (end, side) in [(0.0, -1.0), (0.5, 1.0)] {
            let (mut point, mut normal) = ([0.0; 2], [0.0; 2]);
            (point[axis], normal[axis]) = (end, side);
            scene = scene.boundary(MirrorPlane::symmetry(point, normal));
        }
    }
    on(scene, fused)
}

#[test]
fn a_gas_with_consistent_smoothing_is_that_of_the_host() {
    let Some(device) = device("a gas with consistent smoothing") else {
        return;
    };
    in_both(&device, "Blast", blast::<f64>, || blast::<f32>(false), 30);
}

#[test]
fn bits_are_the_same_twice_and_in_any_work_groups() {
    let Some(device) = device("bits of impacts and gases") else {
        return;
    };
    in_any_groups(device, |device| {
        let rods = on_device(device, rods::<f64>(false), 60).bits_hash();
        vec![rods, on_device(device, blast::<f64>(false), 20).bits_hash()]
    });
}

/// Two rods that meet without a wall.
fn free_rods<T: Real>(fused: bool) -> Scene<T, 1> {
    let rod = |name: &str, low: f64, high: f64| {
        Body::block(name, catalogue::copper::<T>(), [low], [high], 2e-4)
    };
    let scene = Scene::new(schemes::impact())
        .body(rod("left", 0.0, 0.01).velocity([-50.0]))
        .body(rod("right", 0.0102, 0.02).velocity([-150.0]));
    on(scene, fused)
}

/// Two clouds of gas that run into each other in a vacuum, the second of particles of another spacing.
fn clouds<T: Real, const D: usize>(fused: bool, spacings: [f64; 2]) -> Scene<T, D>
where
    WendlandC4: Kernel<D>,
{
    let air = Material::<T>::new("air", IdealGas::new(1.4, 1.0));
    let cloud = |name: &str, at: f64, spacing: f64, speed: f64| {
        let (mut low, mut high, mut velocity) = ([0.0; D], [0.5; D], [0.5 * speed; D]);
        (low[0], high[0], velocity[0]) = (at, at + 0.25, speed);
        let own = Body::block(name, air.clone(), low, high, spacing);
        own.energy(1.0).velocity(velocity)
    };
    let scene = Scene::new(schemes::gas())
        .body(cloud("left", 0.0, spacings[0], 1.0))
        .body(cloud("right", 0.25, spacings[1], -1.0));
    on(scene, fused)
}

/// In one dimension, across contacts, and with smoothing lengths that vary.
#[test]
fn lists_that_the_device_builds_serve_as_those_of_the_host() {
    let Some(device) = device("lists of solids and gases") else {
        return;
    };
    let single = || free_rods::<f32>(false);
    in_both(&device, "Free rods", free_rods::<f64>, single, 200);
    let mut rods = load(&device, free_rods::<f64>(false));
    neighbours::are_those_of_the_host(&mut rods);
    for _ in 0..200 {
        rods.step().unwrap();
    }
    println!("{:?}", neighbours::are_those_of_the_host(&mut rods));
    // In these steps no smoothing length is found a repetition sooner there than here, which differs by its tolerance.
    in_double(
        &device,
        "Clouds",
        |fused| clouds::<_, 2>(fused, [0.025; 2]),
        40,
    );
    // Where lengths differ by more than three the host builds lists, for which all columns cross the bus.
    let plane = |spacing| load(&device, clouds::<f64, 2>(false, [0.025, spacing]));
    are_listed(&device, plane(0.025), false);
    are_listed(&device, plane(0.125), true);
    // A driver in software ends threads that look at too many particles.
    let space = load(&device, clouds::<f64, 3>(false, [0.05, 0.125]));
    are_listed(&device, space, device.adapter().kind == "Cpu");
}

/// The lists of some steps are those of the host, which builds them or not.
fn are_listed<const D: usize>(device: &Device, mut run: Run<f64, D>, is_on_host: bool) {
    let slots = neighbours::on_host(&mut run).columns(0).slots() as u64;
    let (first, mut most) = (neighbours::are_those_of_the_host(&mut run), 0);
    for _ in 0..6 {
        let before = device.traffic().received;
        run.step().unwrap();
        most = most.max(device.traffic().received - before);
    }
    let last = neighbours::are_those_of_the_host(&mut run);
    let builds = run.simulation().unwrap().list_builds();
    println!("{first:?}, {last:?}, {builds} list builds, {most} bytes for {slots} slots");
    assert!(builds > 2);
    // More than 25 numbers a slot, or not much more than which particle is where.
    assert!(
        if is_on_host {
            most > 200 * slots
        } else {
            most < 50 * slots
        },
        "{most}"
    );
}
