//! Scenes on the device against the same scenes on the host, in f64 and in f32.
//! They may differ by 20 times what the host differs by with itself: with fused multiply-adds and without, in f32 and in f64.

use super::common::device;
use super::{Fill, differences, on_device, on_host, plate, stirred, vortices, water};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::prelude::*;
use meshfree::scalar::InstructionSet;
use meshfree_gpu::Device;

/// How much more than the host differs by with itself.
const MORE: f64 = 20.0;

/// Compares a run in f64 with the host, `scene` being with fused multiply-adds or without. What is counted is the same.
fn in_double<const D: usize>(
    device: &Device,
    name: &str,
    scene: impl Fn(bool) -> Scene<f64, D>,
    steps: usize,
) {
    let host = on_host(scene(false), steps);
    let fused = on_host(scene(true), steps);
    let found = on_device(device, scene(false), steps);
    let (own, most) = (differences(&found, &host), differences(&fused, &host));
    println!("{name} in {D}D, {steps} steps, f64: {own:?}, host {most:?}");
    if InstructionSet::detect() > InstructionSet::Baseline {
        assert!((0..3).all(|k| own[k] <= MORE * most[k]), "{name}");
    }
    let given = |own: &Simulation<f64, D>| {
        let ledger = own.ledger();
        let impulse = own.wall_impulse("tank").unwrap_or([0.0; D]);
        (ledger.whole, impulse, ledger.boundary_impulse)
    };
    let [a, b] = [&found, &host].map(given);
    let speed = (2.0 * b.0.kinetic / b.0.mass).sqrt();
    let most = b.0.mass * speed + b.1[D - 1].abs();
    for d in 0..D {
        assert_abs_diff_eq!(a.0.momentum[d], b.0.momentum[d], epsilon = 1e-11 * most);
        assert_abs_diff_eq!(a.1[d], b.1[d], epsilon = 1e-11 * most);
        assert_abs_diff_eq!(a.2[d], b.2[d], epsilon = 1e-11 * most);
    }
    assert_relative_eq!(a.0.kinetic, b.0.kinetic, max_relative = 1e-10);
    assert_eq!(a.0.mass, b.0.mass);
    assert_eq!(found.list_builds(), host.list_builds());
    assert_eq!(found.evaluations(), host.evaluations());
    assert_eq!(found.limits(), host.limits());
    assert_eq!(found.guard_counts(), host.guard_counts());
    assert_eq!(
        found.last_vote().map(|own| own.criterion),
        host.last_vote().map(|own| own.criterion)
    );
}

fn in_both<const D: usize>(
    device: &Device,
    name: &str,
    double: impl Fn(bool) -> Scene<f64, D>,
    single: impl Fn() -> Scene<f32, D>,
    steps: usize,
) {
    in_double(device, name, &double, steps);
    let host = on_host(single(), steps);
    let double = on_host(double(false), steps);
    let found = on_device(device, single(), steps);
    let (own, most) = (differences(&found, &host), differences(&host, &double));
    println!("{name} in {D}D, {steps} steps, f32: {own:?}, host {most:?}");
    assert!((0..3).all(|k| own[k] <= MORE * most[k]), "{name}");
}

fn tank_in_both<const D: usize>(device: &Device, fill: Fill, steps: usize)
where
    WendlandC2: Kernel<D>,
{
    let double = |fused| water::<f64, D>(fill, fused);
    let single = || water::<f32, D>(fill, false);
    in_both(device, &format!("{fill:?}"), double, single, steps);
}

#[test]
fn water_in_the_plane_is_that_of_the_host() {
    let Some(device) = device("water in the plane") else {
        return;
    };
    for fill in [Fill::Still, Fill::Dam] {
        tank_in_both::<2>(&device, fill, 200);
    }
}

/// Particles leave on one side and enter on the other, where their images are.
#[test]
fn a_periodic_flow_is_that_of_the_host() {
    let Some(device) = device("a periodic flow") else {
        return;
    };
    let single = || vortices::<f32>(false);
    in_both(&device, "Vortices", vortices::<f64>, single, 200);
}

/// Deformation gradients, stresses, hourglass control, and energy by the work of kicks.
#[test]
fn a_plate_that_bends_is_that_of_the_host() {
    let Some(device) = device("a plate that bends") else {
        return;
    };
    let single = || plate::<f32>(false);
    in_both(&device, "Plate", plate::<f64>, single, 200);
    // Internal energy takes what kinetic energy loses.
    let found = on_device(&device, plate::<f64>(false), 200);
    let host = on_host(plate::<f64>(false), 200);
    let [start, a, b] =
        [&on_host(plate::<f64>(false), 0), &found, &host].map(|own| own.ledger().whole);
    assert_relative_eq!(a.internal, b.internal, max_relative = 1e-10);
    assert!(a.internal - start.internal > 1e-3 * start.kinetic);
    assert_relative_eq!(a.total_energy(), start.total_energy(), max_relative = 1e-12);
    assert!(found.stored_energy().largest().is_some());
}

/// Viscous forces, walls without slip, shifts, and walls that move and show their acceleration.
#[test]
fn a_viscous_liquid_in_a_tank_that_swings_is_that_of_the_host() {
    let Some(device) = device("a viscous liquid in a tank that swings") else {
        return;
    };
    in_double(&device, "Swinging", stirred::<f64>, 200);
}

#[test]
fn water_in_space_is_that_of_the_host() {
    let Some(device) = device("water in space") else {
        return;
    };
    for fill in [Fill::Still, Fill::Dam] {
        tank_in_both::<3>(&device, fill, 100);
    }
}
