//! A scene on the device against the same on the host, in f64 and in f32.
//! They may differ by 20 times what the host differs by with itself: with fused multiply-adds and without, in f32 and in f64.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::prelude::*;
use meshfree::scalar::InstructionSet;
use meshfree_gpu::{Device, Run};

/// How much more than the host differs by with itself.
const MORE: f64 = 20.0;

/// Compares a run in f64 with the host, `scene` being with fused multiply-adds or without. What is counted is the same.
pub(crate) fn in_double<const D: usize>(
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
    assert_relative_eq!(a.0.internal, b.0.internal, max_relative = 1e-10);
    let totals = a.0.totals.iter().zip(&b.0.totals);
    totals.for_each(|(a, b)| assert_relative_eq!(a.value, b.value, max_relative = 1e-8));
    assert_eq!(found.list_builds(), host.list_builds());
    assert_eq!(found.evaluations(), host.evaluations());
    assert_eq!(found.limits(), host.limits());
    assert_eq!(found.guard_counts(), host.guard_counts());
    assert_eq!(
        found.last_vote().map(|own| own.criterion),
        host.last_vote().map(|own| own.criterion)
    );
}

pub(crate) fn in_both<const D: usize>(
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

pub(crate) fn on<T: Real, const D: usize>(scene: Scene<T, D>, fused: bool) -> Scene<T, D> {
    scene.instructions(if fused {
        InstructionSet::detect()
    } else {
        InstructionSet::Baseline
    })
}

/// The simulation of a scene.
pub(crate) fn build<T: Real, const D: usize>(scene: Scene<T, D>) -> Simulation<T, D> {
    scene.build().unwrap_or_else(|error| panic!("{error}"))
}

/// A run on the device.
pub(crate) fn load<T: Real, const D: usize>(device: &Device, scene: Scene<T, D>) -> Run<T, D> {
    let run = device.load(build(scene));
    run.unwrap_or_else(|error| panic!("{error}"))
}

/// After some steps on the host.
pub(crate) fn on_host<T: Real, const D: usize>(
    scene: Scene<T, D>,
    steps: usize,
) -> Simulation<T, D> {
    let mut host = build(scene);
    for _ in 0..steps {
        host.step().unwrap_or_else(|error| panic!("{error}"));
    }
    host
}

/// After some steps on the device.
pub(crate) fn on_device<T: Real, const D: usize>(
    device: &Device,
    scene: Scene<T, D>,
    steps: usize,
) -> Simulation<T, D> {
    let mut run = load(device, scene);
    for _ in 0..steps {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    run.into_simulation()
        .unwrap_or_else(|error| panic!("{error}"))
}

/// The largest differences of places, velocities and densities of two runs of a scene.
pub(crate) fn differences<T: Real, U: Real, const D: usize>(
    one: &Simulation<T, D>,
    other: &Simulation<U, D>,
) -> [f64; 3] {
    assert_eq!(one.particles(), other.particles());
    let mut all = [0.0f64; 3];
    for (a, b) in one.all().zip(other.all()) {
        for d in 0..D {
            all[0] = all[0].max((a.position()[d] - b.position()[d]).abs());
            all[1] = all[1].max((a.velocity()[d] - b.velocity()[d]).abs());
        }
        all[2] = all[2].max((a.density() - b.density()).abs());
    }
    all
}

/// After `steps[0]` steps saved and resumed on the other side, for `steps[1]` more: as the host has gone on, and as the device has, which is
/// read on the way; and the host without a break. Both are within the bound.
pub(crate) fn resumed<const D: usize>(
    device: &Device,
    name: &str,
    scene: impl Fn(bool) -> Scene<f64, D>,
    steps: [usize; 2],
) -> [Simulation<f64, D>; 3] {
    let file = format!("meshfree-gpu-{}-{name}", std::process::id());
    let file = std::env::temp_dir().join(file);
    let whole = steps[0] + steps[1];
    let host = on_host(scene(false), whole);
    let most = differences(&on_host(scene(true), whole), &host);
    on_device(device, scene(false), steps[0])
        .save(&file)
        .unwrap();
    let mut here = scene(false).resume(&file).unwrap();
    (0..steps[1]).for_each(|_| here.step().map(drop).unwrap());
    on_host(scene(false), steps[0]).save(&file).unwrap();
    let mut there = device.load(scene(false).resume(&file).unwrap()).unwrap();
    for step in 0..steps[1] {
        there.step().unwrap();
        if step % 10 == 0 {
            there.simulation().unwrap();
        }
    }
    let there = there.into_simulation().unwrap();
    for own in [&here, &there] {
        let found = differences(own, &host);
        println!("{name}, resumed: {found:?}, host {most:?}");
        assert!((0..3).all(|k| found[k] <= MORE * most[k]), "{name}");
    }
    let _ = std::fs::remove_file(file);
    [here, there, host]
}

/// What a simulation is refused for.
#[track_caller]
pub(crate) fn refusal<T: Real, const D: usize>(simulation: Simulation<T, D>) -> String {
    match simulation.offload() {
        Ok(_) => panic!("it is not refused"),
        Err(error) => error.to_string(),
    }
}

/// Whether a scene is refused for all of some parts, each with a remedy.
#[track_caller]
pub(crate) fn refused<T: Real, const D: usize>(scene: Scene<T, D>, parts: &[&str]) {
    let text = refusal(build(scene));
    for part in parts {
        assert!(text.contains(part), "`{part}` is not in: {text}");
    }
    let remedies = ["host", "write it", "give what"];
    assert!(remedies.iter().any(|own| text.contains(own)), "{text}");
}
