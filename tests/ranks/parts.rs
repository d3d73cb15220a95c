//! Ranks that step their own particles alone, in `run_until`: readings at odd moments, list builds on the way, and one set of bits.
//! Scenes of one particle, its neighbours and sums; a scene with more than that runs as before, which is tested too.

use super::bits::said;
use super::scenes::{
    DX, bent_plate, corner, crushed_tank, dam_break, down, gas_in_periods, periodic_gas,
    plate_at_wall, rod, rod_by_runge_kutta, tank_in_space,
};
use super::watched;
use meshfree::boundary::Wall;
use meshfree::effect::{FiveEquations, Hypoelastic, NeoHookean};
use meshfree::integrator::StrongStabilityPreserving3;
use meshfree::kernel::WendlandC2;
use meshfree::material::eos::{IdealGas, Linear, StiffenedGas};
use meshfree::material::{Material, SoundSpeed};
use meshfree::prelude::*;
use meshfree::ranks::{self, Ranks};
use meshfree::run::{Run, Schedule};
use meshfree::scene::Start;
use std::f64::consts::PI;
use std::sync::Arc;

/// Shares of a run at whose ends it is read: at two moments in one step, and nowhere in particular.
const READ: [f64; 5] = [0.13, 0.1305, 0.4, 0.77, 1.0];

/// What a run says at its readings, its list builds, and how often particles were exchanged.
struct Told {
    said: Vec<Vec<u64>>,
    work: [u64; 2],
    builds: u64,
    exchanged: u64,
}

fn told<T: Real, const D: usize>(scene: Scene<T, D>, end: f64, shares: &[f64]) -> Told {
    let mut simulation = scene.build().expect("the scene");
    let mut all = Vec::new();
    for share in shares {
        simulation.run_until(share * end).expect("a run");
        all.push(said(&simulation));
    }
    // The next step starts from where the last one ended, of all particles.
    simulation.step().expect("a step");
    all.push(said(&simulation));
    let work = simulation.work();
    Told {
        said: all,
        work: [work.pairs, simulation.bits_hash()],
        builds: simulation.list_builds(),
        exchanged: simulation.traffic().map_or(0, |own| own.exchanged),
    }
}

/// Compares runs of so many steps on ranks, and so many threads of each, with a plain one, over at least so many list builds.
fn one_set_of_bits_in_parts<T: Real, const D: usize>(
    name: &'static str,
    least: (usize, u64),
    divides: bool,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    one_set_of_bits_on(
        &[[1, 1], [2, 1], [3, 2], [4, 1]],
        name,
        least,
        divides,
        scene,
    );
}

/// The same on some numbers of ranks and threads.
fn one_set_of_bits_on<T: Real, const D: usize>(
    ranks: &'static [[usize; 2]],
    name: &'static str,
    (steps, builds): (usize, u64),
    divides: bool,
    scene: impl Fn() -> Scene<T, D> + Send + Sync + 'static,
) {
    watched(move || {
        let mut first = scene().build().expect("the scene");
        for _ in 0..steps {
            first.step().expect("a step");
        }
        let end = first.time();
        let plain = told(scene(), end, &READ);
        println!("{name}: {} list builds", plain.builds);
        assert!(plain.builds >= builds, "{name}: {} builds", plain.builds);
        let unseen = told(scene(), end, &[1.0]);
        assert!(
            unseen.said[..] == plain.said[READ.len() - 1..],
            "{name}: read"
        );
        for &[count, threads] in ranks {
            let program = |ranks: Arc<dyn Ranks>| told(scene().on_ranks(ranks), end, &READ);
            let all = ranks::in_threads(count, threads, program).expect("threads");
            for (rank, own) in all.into_iter().enumerate() {
                let at = format!("{name}: rank {rank} of {count} with {threads} threads");
                for (k, (own, plain)) in own.said.iter().zip(&plain.said).enumerate() {
                    assert!(own == plain, "{at}: other bits at reading {k}");
                }
                assert_eq!(own.work, plain.work, "{at}");
                assert_eq!(
                    own.exchanged > 0,
                    divides,
                    "{at}: {} exchanges",
                    own.exchanged
                );
            }
        }
    });
}

#[test]
fn a_dam_breaks_in_a_plane() {
    one_set_of_bits_in_parts("dam break", (250, 5), true, dam_break);
}

#[test]
fn water_sloshes_in_a_tank_in_space() {
    one_set_of_bits_in_parts("tank in space, f32", (90, 5), true, tank_in_space);
}

#[test]
fn water_falls_into_a_corner_of_mirrors() {
    one_set_of_bits_in_parts("corner", (250, 5), true, corner);
}

#[test]
fn a_tank_is_crushed() {
    one_set_of_bits_in_parts("crushed", (150, 4), true, crushed_tank);
}

#[test]
fn a_gas_flows_through_periods() {
    one_set_of_bits_in_parts("periodic gas", (80, 5), true, periodic_gas);
}

#[test]
fn a_rod_flows_through_a_period() {
    one_set_of_bits_in_parts("rod", (300, 5), true, || rod(400.0));
}

#[test]
fn a_rod_flows_by_runge_kutta() {
    one_set_of_bits_in_parts("Runge-Kutta", (60, 4), true, rod_by_runge_kutta);
}

/// In a plane, where list builds sort: states that the integrator keeps go to other ranks with their particles.
#[test]
fn a_gas_flows_by_runge_kutta() {
    let gas = || gas_in_periods(EnergyForm::Symmetric).integrator(StrongStabilityPreserving3);
    one_set_of_bits_in_parts("gas by Runge-Kutta", (80, 5), true, gas);
}

#[test]
fn a_plate_swings_by_its_reference_neighbours() {
    one_set_of_bits_in_parts("total-Lagrangian plate", (80, 1), true, bent_plate);
}

/// A steel plate that turns.
pub(super) fn turning_plate() -> Scene<f64, 2> {
    let steel = catalogue::steel().with_shear_modulus(77e9);
    let plate = Body::block("plate", steel, [0.0; 2], [0.08, 0.04], 1e-3);
    let plate = plate.start(|[x, y], start| Start {
        velocity: [-4000.0 * (y - 0.02), 4000.0 * (x - 0.04)],
        ..start
    });
    Scene::<f64, 2>::new(schemes::impact_by_continuity().with(Hypoelastic)).body(plate)
}

#[test]
fn a_plate_that_turns_by_continuity() {
    one_set_of_bits_in_parts("elastic plate that turns", (150, 5), true, turning_plate);
}

#[test]
fn a_plate_that_strikes_a_wall_runs_as_before() {
    one_set_of_bits_in_parts("plate at a wall", (60, 2), false, plate_at_wall);
}

#[test]
fn a_plate_that_is_held_runs_as_before() {
    one_set_of_bits_in_parts("held plate", (40, 1), false, || {
        bent_plate().fix("plate", |[x, _]| *x < 0.05)
    });
}

#[test]
fn few_particles_on_many_ranks_run_as_before() {
    const MANY: [[usize; 2]; 2] = [[3, 1], [6, 1]];
    one_set_of_bits_on(&MANY, "few in a rod", (300, 3), false, || {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 4e-4);
        Scene::<f64, 1>::new(schemes::impact())
            .body(rod.velocity([900.0]))
            .boundary(Periodic::along(0, 0.0, 0.01))
    });
    one_set_of_bits_on(&MANY, "few in a dam break", (150, 3), false, || {
        let water = catalogue::weakly_compressible_water(4.0);
        let open = [[true; 2], [true, false]];
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [0.0; 2], [0.1, 0.2], DX))
            .wall(Wall::around("tank", [0.0; 2], [0.3, 0.3], DX, 4, open))
            .acceleration(down)
    });
    one_set_of_bits_on(&MANY, "few in a tank of two fluids", (60, 1), false, || {
        let (water, air) = (StiffenedGas::new(4.4, 1e6, 1000.0), IdealGas::new(1.4, 1.2));
        let scheme = SchemeBuilder::five_equations(WendlandC2, FiveEquations::new(water, air));
        let block = |name, fluid: Material<f64>, low, high, energy| {
            Body::block(name, fluid, [0.0, low], [0.2, high], DX).energy(energy)
        };
        let liquid = Material::new("water", water);
        Scene::<f64, 2>::new(scheme)
            .body(block("water", liquid, 0.0, 0.1, 1e5 / 3400.0))
            .body(block(
                "air",
                Material::new("air", air),
                0.1,
                0.2,
                1e5 / 0.48,
            ))
            .wall(Wall::around(
                "tank",
                [0.0; 2],
                [0.2; 2],
                DX,
                3,
                [[true; 2]; 2],
            ))
            .acceleration(|_| [20.0, -9.81])
    });
    one_set_of_bits_on(&MANY, "few in a plate", (80, 1), false, || {
        let rubber = Material::new("rubber", Linear::new(1100.0, 40.0)).with_shear_modulus(5e5);
        let plate = Body::block("plate", rubber, [0.0; 2], [0.3, 0.1], DX);
        let plate = plate.start(|[x, _], start| Start {
            velocity: [0.0, 9.0 * x * x],
            ..start
        });
        Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean)).body(plate)
    });
}

/// What observers see at their times, and the end.
fn observed<T: Real, const D: usize>(scene: Scene<T, D>, end: f64) -> (Vec<Vec<u64>>, u64) {
    let mut simulation = scene.build().expect("the scene");
    let mut seen = Vec::new();
    Run::new(&mut simulation, end)
        .observe(Schedule::every(end / 7.0), |now| {
            seen.push(said(now));
            Ok(())
        })
        .go()
        .expect("a run");
    seen.push(said(&simulation));
    let exchanged = simulation.traffic().map_or(0, |own| own.exchanged);
    (seen, exchanged)
}

#[test]
fn observers_see_all_particles() {
    watched(|| {
        let plain = observed(dam_break(), 0.03).0;
        assert!(plain.len() > 7);
        let all = ranks::in_threads(3, 1, |ranks| observed(dam_break().on_ranks(ranks), 0.03));
        for (seen, exchanged) in all.expect("threads") {
            assert!(seen == plain && exchanged > 50, "{exchanged}");
        }
    });
}

/// All that walks over the neighbours of any particle, in words.
fn walked(now: &Simulation<f64, 2>) -> String {
    let mut nearest = 0.0;
    for particle in now.all() {
        particle.for_each_neighbor(|other| nearest += other.distance());
    }
    let force = now.wall_force("tank").expect("the tank");
    let [indicators, stability] = [
        format!("{:?}", now.indicators()),
        format!("{:?}", now.stability()),
    ];
    format!("{nearest:e} {force:?} {indicators} {stability}")
}

/// One rank may read alone, more than once, while the others go on.
#[test]
fn one_rank_reads_alone() {
    fn read_by(scene: Scene<f64, 2>, reads: impl Fn(usize) -> bool) -> (Option<String>, Vec<u64>) {
        let mut now = scene.build().expect("the scene");
        let reads = now.rank().is_none_or(|(rank, _)| reads(rank));
        now.run_until(0.0111).expect("a run");
        let first = reads.then(|| walked(&now));
        now.run_until(0.03).expect("a run");
        let second = reads.then(|| walked(&now) + &walked(&now));
        now.run_until(0.04).expect("a run");
        (first.zip(second).map(|(a, b)| a + &b), said(&now))
    }
    watched(|| {
        let (words, bits) = read_by(dam_break(), |_| true);
        let all = ranks::in_threads(3, 2, |ranks| {
            read_by(dam_break().on_ranks(ranks), |rank| rank == 1)
        });
        let all = all.expect("threads");
        assert_eq!(all[1].0, words);
        assert!(all.iter().all(|own| own.1 == bits));
        assert_eq!([&all[0].0, &all[2].0], [&None, &None]);
    });
}

/// While one rank reads a simulation alone, or a copy of it, the others may go on with another one, or end.
#[test]
fn one_rank_reads_one_simulation_of_two() {
    fn read_by(scene: impl Fn() -> Scene<f64, 2>, reads: impl Fn(usize) -> bool) -> Vec<Vec<u64>> {
        let [mut first, mut second] = [scene(), scene()].map(|own| own.build().expect("the scene"));
        let reads = first.rank().is_none_or(|(rank, _)| reads(rank));
        let mut seen = Vec::new();
        let mut read = |now: &Simulation<f64, 2>| {
            if reads {
                seen.push(said(now));
            }
        };
        first.run_until(0.0111).expect("a run");
        second.run_until(0.0123).expect("a run");
        read(&first);
        second.run_until(0.02).expect("a run");
        read(&first);
        read(&second.clone());
        first.set_velocities(|_, [u, v]| [0.99 * u, v]);
        read(&second);
        first.run_until(0.0203).expect("a run");
        drop(second);
        read(&first);
        seen
    }
    watched(|| {
        let plain = read_by(dam_break, |_| true);
        let all = ranks::in_threads(3, 1, |ranks| {
            read_by(|| dam_break().on_ranks(ranks.clone()), |rank| rank == 2)
        });
        let all = all.expect("threads");
        assert!(all[2] == plain);
        assert!(all[0].is_empty() && all[1].is_empty());
    });
}

#[cfg(feature = "checkpoint")]
#[test]
fn a_run_in_parts_is_saved_and_goes_on_anywhere() {
    let folder = std::env::temp_dir().join(format!("meshfree-parts-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let (scene, path) = (|| rod(400.0), folder.join("rod"));
    watched(move || {
        let mut plain = scene().build().expect("the scene");
        let end = 100.0 * plain.step().expect("a step");
        plain.run_until(end).expect("a run");
        plain.run_until(2.0 * end).expect("a run");
        let expected = said(&plain);
        let written = ranks::in_threads(3, 1, |ranks| {
            let mut simulation = scene().on_ranks(ranks).build().expect("the scene");
            simulation.run_until(end).expect("a run");
            simulation.save(&path).expect("a file");
        });
        written.expect("threads");
        let go_on = |scene: Scene<f64, 1>| {
            let mut simulation = scene.resume(&path).expect("a checkpoint");
            simulation.run_until(2.0 * end).expect("a run");
            said(&simulation)
        };
        assert!(go_on(scene()) == expected, "without ranks");
        for count in [1, 2, 4] {
            let all = ranks::in_threads(count, 1, |ranks| go_on(scene().on_ranks(ranks)));
            for own in all.expect("threads") {
                assert!(own == expected, "on {count} ranks");
            }
        }
    });
    let _ = std::fs::remove_dir_all(folder);
}

/// Water that is faster than its sound is refused by what all particles say, of the same particle on all ranks; and an error of one rank
/// in the middle of a step reaches those that wait for its particles.
#[test]
fn errors_are_those_of_all_particles() {
    let fast = || {
        let water = catalogue::weakly_compressible_water(0.4);
        let tank = Wall::around(
            "tank",
            [0.0; 2],
            [0.9, 0.6],
            DX,
            4,
            [[true; 2], [true, false]],
        );
        Scene::<f64, 2>::new(schemes::weakly_compressible())
            .body(Body::block("water", water, [0.02, 0.0], [0.82, 0.4], DX))
            .wall(tank)
            .acceleration(|_| [60.0, -9.81])
    };
    watched(move || {
        fn run<const D: usize>(scene: Scene<f64, D>) -> Result<(), Error> {
            scene.build()?.run_until(2.0)
        }
        let plain = run(fast())
            .expect_err("water faster than its sound")
            .to_string();
        println!("{plain}");
        let all = ranks::in_threads(3, 1, |ranks| run(fast().on_ranks(ranks)));
        for own in all.expect("threads") {
            assert_eq!(own.expect_err("the same").to_string(), plain);
        }
        let all = ranks::in_threads(3, 1, |ranks| {
            let is_wrong = ranks.rank() == 1;
            let late = move |t| if is_wrong && t > 0.004 { f64::NAN } else { 0.0 };
            let scene = dam_break().acceleration(move |t| [late(t), 0.0]);
            run(scene.on_ranks(ranks))
                .expect_err("one is wrong")
                .to_string()
        });
        let all = all.expect("threads");
        assert!(all[1].contains("acceleration of the scene"), "{all:#?}");
        for rank in [0, 2] {
            assert!(all[rank].starts_with("rank 1 has failed"), "{all:#?}");
            assert!(all[rank].contains(&all[1]), "{all:#?}");
        }
        // Another function, or another state, is no error of its own.
        let all = ranks::in_threads(3, 1, |ranks| {
            let other = if ranks.rank() == 2 { 1e-12 } else { 0.0 };
            let pulled = dam_break().acceleration(move |_| [other, 0.0]);
            let ended = run(pulled.on_ranks(ranks.clone()));
            let moved = run(rod(400.0 + other * 1e3).on_ranks(ranks));
            [ended, moved].map(|ended| ended.expect_err("another scene").to_string())
        });
        for own in all.expect("threads").into_iter().flatten() {
            assert!(own.starts_with("rank 2 has failed"), "{own}");
        }
    });
}

/// A long channel with a period: bytes of a step are those of the ends of a rank's run, and do not grow with the length of the channel.
#[test]
fn bytes_of_a_step_do_not_grow_with_the_length_of_a_channel() {
    let counted = |length: f64| {
        watched(move || {
            let scene = move || {
                let water = catalogue::water_at(SoundSpeed::artificial(2.0));
                let body = Body::block("water", water, [0.0; 2], [length, 0.2], DX);
                Scene::<f64, 2>::new(schemes::weakly_compressible())
                    .body(body.start(|x, start| Start {
                        velocity: [0.02 + 0.01 * (PI * x[1] / 0.2).sin(), 0.0],
                        ..start
                    }))
                    .boundary(Periodic::along(0, 0.0, length))
                    .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
                    .boundary(MirrorPlane::wall([0.0, 0.2], [0.0, 1.0]))
            };
            let all = ranks::in_threads(2, 1, |ranks| {
                let mut simulation = scene().on_ranks(ranks).build().expect("the scene");
                let steps = |simulation: &mut Simulation<f64, 2>, count: f64| {
                    let before = simulation.traffic().expect("ranks");
                    let builds = simulation.list_builds();
                    let end = simulation.time() + count * 1e-3;
                    let begun = simulation.steps();
                    simulation.run_until(end).expect("a run");
                    assert_eq!(simulation.list_builds(), builds);
                    let after = simulation.traffic().expect("ranks");
                    (simulation.steps() - begun, after.received - before.received)
                };
                // Ranks find once between list builds what they need of each other.
                steps(&mut simulation, 1.0);
                // Two runs that differ in their length alone: what is agreed on at their ends is the same.
                let short = steps(&mut simulation, 2.0);
                let long = steps(&mut simulation, 6.0);
                (long.1 as f64 - short.1 as f64) / (long.0 - short.0) as f64
            });
            all.expect("threads")
        })
    };
    let lengths = [2.0, 4.0, 8.0, 16.0];
    let bytes = lengths.map(|length| counted(length)[0]);
    println!("bytes a step: {bytes:?} of channels of {lengths:?} m");
    // How the curve is cut makes a difference; eight times the particles do not.
    let [least, most] = [f64::min, f64::max].map(|of| bytes.into_iter().reduce(of).expect("four"));
    assert!(most < 2.0 * least, "{bytes:?}");
    // Of the 16 000 particles that a rank lacks in the longest all sums are 40 bytes each.
    assert!(bytes[3] < 0.1 * 40.0 * 16_000.0, "{bytes:?}");
}
