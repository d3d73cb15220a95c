//! Ghosts by counting boxes of a lattice, a cost by hand, and the numbers of docs/ranks.md.

use super::*;
use approx::assert_relative_eq;

fn cube(side: u32, reach: f64) -> RankParts {
    RankParts {
        particles: f64::from(side).powi(3),
        sides: vec![f64::from(side); 3],
        periodic: vec![false; 3],
        reach,
        across: 0.0,
        over_boxes: [1.0; 3],
    }
}

/// Ghosts of boxes of a lattice by counting, as a mean over all boxes.
fn counted([nx, ny]: [i32; 2], [px, py]: [i32; 2], reach: i32) -> f64 {
    let (lx, ly) = (nx / px, ny / py);
    let mut ghosts = 0;
    for (a, b) in (0..px).flat_map(|a| (0..py).map(move |b| (a, b))) {
        for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
            let off = |x: i32, a: i32, l: i32| (a * l - x).max(x - (a + 1) * l + 1).max(0);
            let (dx, dy) = (off(x, a, lx), off(y, b, ly));
            ghosts += i32::from((dx, dy) != (0, 0) && dx.max(dy) <= reach);
        }
    }
    f64::from(ghosts) / f64::from(px * py)
}

#[test]
fn ghosts_are_those_that_counting_gives() {
    let plane = |nx: i32, ny: i32, reach: i32| RankParts {
        particles: f64::from(nx * ny),
        sides: vec![f64::from(nx), f64::from(ny)],
        periodic: vec![false; 2],
        reach: f64::from(reach),
        across: 0.0,
        over_boxes: [1.0; 3],
    };
    for (sides, boxes, reach) in [
        ([64, 64], [2, 2], 3),
        ([64, 64], [8, 8], 3),
        ([120, 20], [4, 1], 5),
        ([128, 32], [8, 2], 2),
    ] {
        let predicted = plane(sides[0], sides[1], reach).ghosts((boxes[0] * boxes[1]) as usize);
        assert_relative_eq!(
            predicted,
            counted(sides, boxes, reach),
            max_relative = 1e-12
        );
    }
}

#[test]
fn periods_have_two_neighbours_and_one_rank_has_no_ghosts() {
    let mut channel = cube(30, 2.0);
    channel.sides = vec![90.0, 10.0, 30.0];
    channel.periodic = vec![true, false, false];
    // Two ends of 300 particles, two deep.
    assert_relative_eq!(channel.ghosts(2), 1200.0, max_relative = 1e-12);
    channel.periodic[0] = false;
    assert_relative_eq!(channel.ghosts(2), 600.0, max_relative = 1e-12);
    channel.across = 80.0;
    // 40 of the 13 500 others, of which 600 are counted.
    let both = 640.0 - 40.0 * 600.0 / 13_500.0;
    assert_relative_eq!(channel.ghosts(2), both, max_relative = 1e-12);
    assert_relative_eq!(channel.ghosts(1), 0.0);
    channel.over_boxes = [1.5, 0.5, 0.25];
    assert_relative_eq!(channel.ghosts(2), 1.5 * both, max_relative = 1e-12);
    let boxes = RankParts {
        over_boxes: [1.0; 3],
        ..channel.clone()
    };
    // Of the number of ranks that is nearest.
    for (ranks, over) in [(3, 0.5), (4, 0.5), (5, 0.5), (6, 0.25), (100, 0.25)] {
        let expected = over * boxes.ghosts(ranks);
        assert_relative_eq!(channel.ghosts(ranks), expected, max_relative = 1e-12);
    }
    // No more than all others.
    assert_relative_eq!(cube(10, 99.0).ghosts(8), 875.0, max_relative = 1e-12);
}

/// Water in space, by the numbers of docs/notebook/ranks.md, with one rank a machine of so many cores.
fn water(particles: f64, cores: f64) -> RankModel {
    let million = RankModel {
        particles: 1e6,
        chunk: 512.0,
        bytes: 390e6,
        parts: vec![cube(100, 3.0)],
        own_alone: true,
        step: RankPrice {
            gathered: 19.0,
            exchanged: 3.0,
            each: 1700.0,
            of_ghost: 216.0,
            divided: 0.46 / cores,
            ..RankPrice::default()
        },
        list_build: RankPrice {
            gathered: 33.0,
            exchanged: 7.0,
            each: 4300.0,
            parts: 8e3,
            to_each: 8.0,
            of_ghost: 248.0,
            divided: 0.96 / cores,
            undivided: 0.0,
        },
        sort: RankPrice {
            gathered: 13.0,
            exchanged: 7.0,
            each: 270.0,
            to_each: 3100.0,
            divided: 0.19 / cores,
            ..RankPrice::default()
        },
        gather_all: RankPrice {
            gathered: 320.0,
            each: 2600.0,
            parts: 235e6,
            ..RankPrice::default()
        },
        list_builds: 0.05,
        sorts: 0.1,
        gathers_of_all: 0.0,
    };
    million.of_particles(particles).expect("particles")
}

/// The formula of one page, written out by hand for one case.
#[test]
fn a_step_takes_what_its_parts_take() {
    let network = Network {
        latency: 1e-5,
        bandwidth: 1e9,
    };
    let cost = water(8e6, 1.0).on(8, &network).expect("a cost");
    let ghosts = 103.0_f64.powi(3) - 1e6;
    assert_relative_eq!(cost.ghosts, ghosts, max_relative = 1e-12);
    let each = 0.95 * 1700.0 + 0.05 * (4300.0 + 0.1 * 270.0);
    let votes = 7.0 * each + 8.0 * 0.05 * (8.0 + 0.1 * 3100.0);
    let of_chunks = 0.05 * 8e3 * 8.0 * 7.0 / 8.0;
    let bytes = ghosts * (0.95 * 216.0 + 0.05 * 248.0) + votes + of_chunks;
    assert_relative_eq!(cost.received, bytes, max_relative = 1e-12);
    let share = (8e6_f64 / 512.0 / 8.0).ceil() / 15_625.0;
    let work = 0.95 * 0.46 + 0.05 * (0.96 + 0.1 * 0.19);
    let gathered = 0.95 * 19.0 + 0.05 * (33.0 + 0.1 * 13.0);
    let exchanged = 0.95 * 3.0 + 0.05 * (7.0 + 0.1 * 7.0);
    let waiting = 1e-5 * (3.0 * gathered + exchanged);
    assert_relative_eq!(
        cost.step,
        8.0 * share * work + waiting + bytes / 1e9,
        max_relative = 1e-12
    );
    // Alone it has neither ghosts nor messages of others, and letters to itself.
    let alone = water(8e6, 1.0).on(1, &network).expect("a cost");
    let letters = 0.05 * (8.0 + 0.1 * 3100.0) / 1e9;
    assert_relative_eq!(alone.step, 8.0 * work + letters, max_relative = 1e-12);
}

/// What limits first; `cargo test --lib ranks::model -- --nocapture` prints it.
#[test]
fn memory_and_gatherings_limit_first() {
    let network = Network::default();
    println!("particles, ranks: ms a step, speed-up, GB of a rank, largest");
    for particles in [1e6, 1e8, 1e10] {
        let model = water(particles, 32.0);
        let one = model.on(1, &network).expect("a cost");
        for ranks in [1, 10, 100, 1000, 10_000] {
            let cost = model.on(ranks, &network).expect("a cost");
            let largest = cost.largest().expect("a line");
            println!(
                "{particles:.0e}, {ranks}: {:.3e}, {:.1}, {:.3e}, {}",
                1e3 * cost.step,
                one.step / cost.step,
                1e-9 * cost.memory,
                largest.what
            );
            // Of the whole scene a rank has places.
            let memory = particles * (24.0 + 390.0 / ranks as f64);
            assert_relative_eq!(cost.memory, memory, max_relative = 1e-12);
        }
    }
    // A hundred ranks are 80 times as fast; of ten thousand most wait for each other, unless there is more to do.
    let step = |particles, ranks| water(particles, 32.0).on(ranks, &network).expect("a cost");
    let speed_up = |particles, ranks| step(particles, 1).step / step(particles, ranks).step;
    assert!(speed_up(1e8, 100) > 80.0 && speed_up(1e8, 10_000) < 600.0);
    let limit = step(1e8, 10_000);
    let limit = limit.largest().expect("a line").what;
    assert!(limit.starts_with("gatherings"), "{limit}");
    assert!(speed_up(1e10, 10_000) > 6000.0);
}

#[test]
fn wrong_numbers_are_refused_by_name() {
    let network = Network::default();
    let model = water(1e6, 1.0);
    let text = |outcome: Result<RankCost>| outcome.expect_err("refused").to_string();
    assert!(text(model.on(0, &network)).contains("number of ranks"));
    for bandwidth in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let wrong = Network {
            bandwidth,
            ..network
        };
        assert!(text(model.on(2, &wrong)).contains("bandwidth of the network"));
    }
    let wrong = Network {
        latency: -1e-6,
        ..network
    };
    assert!(text(model.on(2, &wrong)).contains("latency of the network"));
    let mut wrong = model.clone();
    wrong.list_build.of_ghost = f64::NAN;
    assert!(text(wrong.on(2, &network)).contains("bytes of a ghost"));
    let mut wrong = model.clone();
    wrong.list_builds = 1.5;
    assert!(text(wrong.on(2, &network)).contains("list builds"));
    let mut wrong = model.clone();
    wrong.sorts = -0.5;
    assert!(text(wrong.on(2, &network)).contains("sorts"));
    let mut wrong = model.clone();
    wrong.parts[0].sides[1] = f64::INFINITY;
    assert!(text(wrong.on(2, &network)).contains("side of a part"));
    assert!(model.of_particles(0.0).is_err() && model.of_particles(f64::NAN).is_err());
}
