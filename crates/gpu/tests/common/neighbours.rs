//! The neighbours that lists of the device have, against those of the host and against all particles.
//! Lists hold more than neighbours, as far as the skin goes, but none twice.

use meshfree::particles::Field;
use meshfree::scalar::Real;
use meshfree::simulation::device::{Bounds, Offloaded};
use meshfree_gpu::{PairLists, Run};

/// The run as the host has it now.
pub fn on_host<T: Real, const D: usize>(run: &mut Run<T, D>) -> Offloaded<T, D> {
    let simulation = run.simulation().expect("a device").clone();
    simulation
        .offload()
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Asserts that each particle has the same neighbours within reach in the lists of the device, in those of the host and among all, images
/// with them; how many there are, and how many entries lists have.
pub fn are_those_of_the_host<T: Real, const D: usize>(run: &mut Run<T, D>) -> [usize; 2] {
    compared(run, true)
}

/// The same of lists alone, for more particles than can be asked one by one.
pub fn are_in_lists_of_the_host<T: Real, const D: usize>(run: &mut Run<T, D>) -> [usize; 2] {
    compared(run, false)
}

fn compared<T: Real, const D: usize>(run: &mut Run<T, D>, asks_all: bool) -> [usize; 2] {
    let host = on_host(run);
    let lists = run.lists(0).expect("a device");
    let columns = host.columns(0);
    let places = columns.vectors(Field::POSITION);
    let mut places: Vec<[f64; D]> = places.iter().map(|x| x.map(Real::to_f64)).collect();
    let lengths = columns.raw(Field::SMOOTHING_LENGTH);
    let mut lengths: Vec<f64> = lengths.iter().map(|h| h.to_f64()).collect();
    let bounds = Bounds {
        range: [[0.0; D], [1.0; D]],
        lengths: (!lengths.is_empty()).then_some([1.0; 2]),
    };
    let search = host.search(0, &bounds);
    let (slots, blocks) = (places.len(), host.blocks(0).len());
    let (listed, members) = (host.members(0), blocks * blocks);
    let mut members = listed[members..].to_vec();
    members.extend(host.listed_images(0).1);
    let transforms = host.transforms(0);
    for own in host.images(0).as_chunks::<2>().0 {
        let [source, by] = own.map(|k| k as usize);
        let by = &transforms[by * (D * D + 2 * D)..];
        let x = places[source];
        let turned = |d: usize| (0..D).map(|k| by[d * D + k] * x[k]).sum::<f64>();
        places.push(core::array::from_fn(|d| turned(d) + by[D * D + d]));
        lengths.extend(lengths.get(source).copied());
    }
    assert_eq!(members.len(), places.len());
    let support = |slot: usize| match lengths.get(slot) {
        Some(h) => h * search.supports[1],
        None => search.supports[0],
    };
    let listed = |i: usize, j: usize| {
        let [a, b] = [i, j].map(|slot| members[slot] as usize);
        b < blocks && listed[a * blocks + b] != 0
    };
    let within = |i: usize, j: usize| {
        let square = (0..D).map(|d| (places[i][d] - places[j][d]).powi(2));
        square.sum::<f64>().sqrt() < support(i).max(support(j)) * (1.0 - 1e-6)
    };
    let of = |lists: &PairLists, i: usize| {
        let mut all = Vec::new();
        for (block, own) in lists.of(i) {
            assert!(own.iter().all(|&j| members[j as usize] == block));
            all.extend_from_slice(own);
        }
        let entries = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), entries, "slot {i} has a neighbour twice");
        all.retain(|&j| within(i, j as usize));
        all
    };
    let other = PairLists::new(host.lists(0), host.blocks(0), host.cluster());
    let mut found = 0;
    for i in (0..slots).filter(|&i| (members[i] as usize) < blocks) {
        let own = of(&other, i);
        assert_eq!(of(&lists, i), own, "slot {i} on the device");
        found += own.len();
        if asks_all {
            let all = (0..places.len()).filter(|&j| listed(i, j) && within(i, j));
            let all: Vec<u32> = all.map(|j| j as u32).collect();
            assert_eq!(own, all, "slot {i} on the host");
        }
    }
    [found, lists.entries()]
}
