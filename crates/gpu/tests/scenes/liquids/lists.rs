//! Neighbour lists that the device builds: the neighbours and the order of particles that the host finds, from the same places.
//! A dam break that is thrown at a wall, and a drop far away.

use super::{Fill, water};
use crate::common::{device, in_any_groups};
use crate::compare::{build, load, on, on_host};
use crate::neighbours::{are_those_of_the_host, on_host as offloaded};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::prelude::*;
use meshfree_gpu::Device;

/// Steps on, with a look at lists every so many steps; then particles must stand where the host has put them.
fn follows<T: Real, const D: usize>(device: &Device, steps: [usize; 2])
where
    WendlandC2: Kernel<D>,
{
    let scene = || water::<T, D>(Fill::Dam, false);
    let mut run = load(device, scene());
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
    println!("{D}D: neighbours and entries {first:?}, {last:?}; {builds} list builds");
    assert!(builds > 4 && builds == host.list_builds());
    let before = build(scene()).offload().unwrap();
    let (found, host) = (offloaded(&mut run), host.offload().unwrap());
    assert_ne!(host.ids(0), before.ids(0), "nothing was sorted");
    assert_eq!(found.ids(0), host.ids(0));
}

#[test]
fn neighbours_and_order_are_those_of_the_host() {
    let Some(device) = device("neighbours") else {
        return;
    };
    follows::<f64, 2>(&device, [4, 60]);
    follows::<f32, 2>(&device, [4, 60]);
    follows::<f64, 3>(&device, [3, 40]);
    follows::<f32, 3>(&device, [3, 40]);
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
    // Seven drops, the water and the tank are more blocks than a device lists.
    for (drops, builds) in [(3, true), (7, false)] {
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

#[test]
fn lists_are_the_same_twice_and_in_any_work_groups() {
    let Some(device) = device("bits of lists") else {
        return;
    };
    in_any_groups(device, |device| {
        let mut run = load(device, scattered(2));
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
    });
}
