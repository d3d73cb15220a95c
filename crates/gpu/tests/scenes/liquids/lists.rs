//! Neighbour lists that the device builds: the neighbours and the order of particles that the host finds, from the same places.
//! A dam break that is thrown at a wall, a drop far away, and gas among images.

use super::{Fill, water};
use crate::common::{device, in_any_groups};
use crate::compare::{build, load, on, on_host};
use crate::neighbours::{are_in_lists_of_the_host, are_those_of_the_host, on_host as offloaded};
use meshfree::material::eos::IdealGas;
use meshfree::particles::Field;
use meshfree::prelude::*;
use meshfree::scheme::Start;
use meshfree::simulation::ParticleView;
use meshfree::simulation::device::Offloaded;
use meshfree_gpu::Device;
use std::f64::consts::TAU;

/// Steps on, with a look at lists every so many steps; then particles must stand where the host has put them.
fn follows<T: Real, const D: usize>(
    device: &Device,
    name: &str,
    scene: impl Fn() -> Scene<T, D>,
    steps: [usize; 2],
) {
    let mut run = load(device, scene());
    let images = |host: Offloaded<T, D>| host.images(0).len() / 2;
    assert!(offloaded(&mut run).builds_lists(0));
    let first = are_those_of_the_host(&mut run);
    for _ in 0..steps[0] {
        for _ in 0..steps[1] {
            run.step().unwrap_or_else(|error| panic!("{error}"));
        }
        are_those_of_the_host(&mut run);
    }
    let last = are_those_of_the_host(&mut run);
    let host = on_host(scene(), steps[0] * steps[1]);
    let builds = run.simulation().unwrap().list_builds();
    println!("{name} in {D}D: neighbours and entries {first:?}, {last:?}; {builds} list builds");
    assert!(builds > 4 && builds == host.list_builds());
    let before = build(scene()).offload().unwrap();
    let (found, host) = (offloaded(&mut run), host.offload().unwrap());
    assert_ne!(host.ids(0), before.ids(0), "nothing was sorted");
    assert_eq!(found.ids(0), host.ids(0));
    assert_eq!(images(found), images(host));
}

#[test]
fn neighbours_and_order_are_those_of_the_host() {
    let Some(device) = device("neighbours") else {
        return;
    };
    let dam = "dam";
    follows(&device, dam, || water::<f64, 2>(Fill::Dam, false), [4, 60]);
    follows(&device, dam, || water::<f32, 2>(Fill::Dam, false), [4, 60]);
    follows(&device, dam, || water::<f64, 3>(Fill::Dam, false), [3, 40]);
    follows(&device, dam, || water::<f32, 3>(Fill::Dam, false), [3, 40]);
}

/// Gas that streams through two periods and along a plane that moves away; what is nearer to the corner has longer supports.
fn streaming<T: Real>() -> Scene<T, 3> {
    let gas = IdealGas::new(1.4, 1.0);
    let flow = move |[x, y, z]: [f64; 3], start: Start<3>| Start {
        velocity: [0.3, -0.2, 0.2 * (TAU * (x + y)).sin()],
        energy: gas.energy(1.0, 1.0) * (1.0 + 0.3 * z),
        ..start
    };
    let body = Body::block(
        "gas",
        Material::new("gas", gas),
        [0.0; 3],
        [1.0, 1.0, 0.5],
        0.1,
    );
    Scene::new(schemes::gas())
        .body(body.start(flow))
        .boundary(Periodic::along(0, 0.0, 1.0))
        .boundary(Periodic::along(1, 0.0, 1.0))
        .boundary(MirrorPlane::wall([0.0; 3], [0.0, 0.0, -1.0]))
        .boundary(MirrorPlane::wall([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]).moving(0.1))
}

/// What has left a period re-enters there; images are those of the host.
#[test]
fn neighbours_among_images_are_those_of_the_host() {
    let Some(device) = device("neighbours among images") else {
        return;
    };
    follows(&device, "gas", streaming::<f64>, [3, 40]);
    follows(&device, "gas", streaming::<f32>, [2, 10]);
    let host = on_host(streaming::<f64>(), 120);
    let start = build(streaming::<f64>());
    let far = |(a, b): (ParticleView<f64, 3>, ParticleView<f64, 3>)| {
        (a.position()[0] - b.position()[0]).abs() > 0.5
    };
    let [a, b] = [&start, &host].map(|own| own.body("gas").unwrap());
    assert!(
        a.zip(b).filter(|own| far(*own)).count() > 20,
        "nothing has re-entered"
    );
}

/// A second body so far away that cells of the table stand for several of the grid.
fn scattered(drops: usize) -> Scene<f64, 2> {
    let mut scene = water::<f64, 2>(Fill::Dam, false);
    for k in 0..drops {
        let drop = catalogue::weakly_compressible_water(2.5);
        let at = [3.0 + 40.0 * k as f64, 7.0 + 9.0 * k as f64];
        let high = at.map(|x| x + 0.1);
        let name = format!("drop {k}");
        scene = scene.body(Body::block(&name, drop, at, high, 0.0125).velocity([-3.0, 2.0]));
    }
    on(scene, false)
}

#[test]
fn neighbours_of_what_is_far_away_are_found() {
    let Some(device) = device("neighbours far away") else {
        return;
    };
    // These many drops, the water and the tank are more blocks than a device lists.
    for (drops, builds) in [(3, true), (31, false)] {
        let mut run = load(&device, scattered(drops));
        assert_eq!(offloaded(&mut run).builds_lists(0), builds);
        are_those_of_the_host(&mut run);
        for _ in 0..60 {
            run.step().unwrap_or_else(|error| panic!("{error}"));
        }
        let found = are_those_of_the_host(&mut run);
        let host = on_host(scattered(drops), 60);
        println!("{drops} drops: {found:?}, {} builds", host.list_builds());
        assert_eq!(run.simulation().unwrap().list_builds(), host.list_builds());
        assert!(host.list_builds() > 2);
        let host = host.offload().unwrap();
        assert_eq!(offloaded(&mut run).ids(0), host.ids(0));
    }
}

/// Clusters of which the curve has some particles on one side of many others, and some on the other: there is no end to a box around
/// these, and drivers in software leave a loop after 65 535 rounds.
#[test]
fn neighbours_of_clusters_in_pieces_are_found() {
    let Some(device) = device("clusters in pieces") else {
        return;
    };
    // A square in one quarter of the curve, of which the last particle shares a cluster with three in each of two others.
    let (count, spacing) = (299, 0.01);
    let at = |k: usize| [k % count, k / count].map(|k| k as f64 * spacing);
    let apart = (0..3).map(|k| 6.5 + spacing * f64::from(k));
    let apart = apart.flat_map(|x| [[x, 0.0], [0.0, x]]);
    let points = (0..count * count).map(at).chain(apart).collect();
    let water = catalogue::weakly_compressible_water::<f64>(2.5);
    let body = Body::points_of("water", water, points, spacing);
    let scene = Scene::<f64, 2>::new(schemes::weakly_compressible()).body(body);
    let mut run = load(&device, scene);
    let host = offloaded(&mut run);
    let places = host.columns(0).vectors(Field::POSITION);
    let apart = places.chunks(host.cluster()).filter(|own| {
        let far = |x: &[f64; 2]| (x[0] - own[0][0]).hypot(x[1] - own[0][1]);
        own.iter().map(far).fold(0.0, f64::max) > 1.0
    });
    assert!(apart.count() > 0);
    println!("{:?}", are_in_lists_of_the_host(&mut run));
}

#[test]
fn lists_are_the_same_twice_and_in_any_work_groups() {
    let Some(device) = device("bits of lists") else {
        return;
    };
    in_any_groups(device.clone(), |device| bits_of_lists(device, scattered(2)));
    in_any_groups(device, |device| bits_of_lists(device, streaming::<f64>()));
}

/// Lists and order after some steps, and what has become of the scene.
fn bits_of_lists<const D: usize>(device: &Device, scene: Scene<f64, D>) -> Vec<u64> {
    let mut run = load(device, scene);
    for _ in 0..60 {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let (lists, host) = (run.lists(0).unwrap(), offloaded(&mut run));
    let mut bits: Vec<u64> = host.ids(0).iter().map(|id| u64::from(*id)).collect();
    for slot in (0..host.columns(0).slots()).step_by(host.cluster()) {
        for (block, own) in lists.of(slot) {
            bits.push(u64::from(block));
            bits.extend(own.iter().map(|j| u64::from(*j)));
        }
    }
    bits.push(run.simulation().unwrap().bits_hash());
    bits
}
