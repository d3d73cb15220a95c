//! Neighbour lists hold every pair within reach, against a search over all pairs, and stay valid
//! while particles move within the skin.

use crate::common::Random;
use meshfree::boundary::{MirrorPlane, Outlet, Periodic};
use meshfree::material::catalogue;
use meshfree::neighbors::{Block, ClusterLists, Radii, SearchInput};
use meshfree::scalar::InstructionSet;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
use meshfree::simulation::{Simulation, StepControl};
use proptest::prelude::*;

const WIDTH: usize = 8;

/// Random points in blocks, the ends of clusters filled with the last point of the block, then images.
struct Points<const D: usize> {
    positions: Vec<[f64; D]>,
    h: Vec<f64>,
    blocks: Vec<Block>,
    slots: usize,
}

fn points<const D: usize>(seed: u64, outliers: bool) -> Points<D> {
    let mut random = Random(seed);
    let mut set = Points {
        positions: Vec::new(),
        h: Vec::new(),
        blocks: Vec::new(),
        slots: 0,
    };
    for _ in 0..1 + random.below(3) {
        let start = set.positions.len();
        for _ in 0..1 + random.below(60) {
            let mut x = random.vector::<D>(4.0);
            if outliers && random.below(20) == 0 {
                x = x.map(|x| x * 10_f64.powi(1 + random.below(12) as i32));
            }
            set.positions.push(x);
            set.h.push(1.0 + 0.8 * random.sign());
        }
        let end = set.positions.len();
        while set.positions.len() % WIDTH != 0 {
            set.positions.push(set.positions[end - 1]);
            set.h.push(set.h[end - 1]);
        }
        set.blocks.push(Block {
            slots: start..end,
            wall: false,
        });
    }
    set.slots = set.positions.len();
    let images = random.below(40);
    for _ in 0..images {
        set.positions.push(random.vector(4.5));
        set.h.push(1.0 + 0.8 * random.sign());
    }
    set.blocks.push(Block {
        slots: set.slots..set.slots + images,
        wall: false,
    });
    set
}

fn lists_hold_all<const D: usize>(
    seed: u64,
    varying: bool,
    outliers: bool,
) -> Result<(), TestCaseError> {
    let set = points::<D>(seed, outliers);
    let (support, skin) = (0.9, 0.15);
    let radii = if varying {
        Radii::Varying(&set.h, support)
    } else {
        Radii::Uniform(support)
    };
    let mut lists = ClusterLists::default();
    // A rebuild on top of an old list leaves nothing behind.
    for _ in 0..2 {
        lists.rebuild(&SearchInput {
            positions: &set.positions,
            radii,
            listed: &[],
            blocks: &set.blocks,
            width: WIDTH,
            slots: set.slots,
            skin,
            instructions: InstructionSet::detect(),
        });
    }
    let mut entries = 0;
    for cluster in 0..set.slots / WIDTH {
        let chunk = &lists.chunks()[cluster / meshfree::neighbors::CHUNK];
        let at = cluster % meshfree::neighbors::CHUNK;
        let segments = &chunk.segments[chunk.starts[at] as usize..chunk.starts[at + 1] as usize];
        let mut listed = Vec::new();
        for segment in segments {
            let own = &chunk.neighbors[segment.start as usize..segment.end as usize];
            let block = &set.blocks[segment.block as usize].slots;
            prop_assert!(
                own.iter().all(|&j| block.contains(&(j as usize))),
                "wrong block"
            );
            listed.extend_from_slice(own);
        }
        entries += listed.len();
        prop_assert!(
            segments
                .windows(2)
                .all(|pair| pair[0].block <= pair[1].block),
            "order of blocks"
        );
        let once: std::collections::BTreeSet<u32> = listed.iter().copied().collect();
        prop_assert_eq!(once.len(), listed.len(), "repeats");
        for i in cluster * WIDTH..(cluster + 1) * WIDTH {
            for j in set.blocks.iter().flat_map(|block| block.slots.clone()) {
                let apart: f64 = (0..D)
                    .map(|d| (set.positions[i][d] - set.positions[j][d]).powi(2))
                    .sum::<f64>()
                    .sqrt();
                let reach = if varying {
                    support * set.h[i].max(set.h[j])
                } else {
                    support
                };
                prop_assert!(
                    apart > reach + skin || listed.contains(&(j as u32)),
                    "{j} at {apart} from {i} is missing"
                );
            }
        }
        // Nobody is listed that no member of the cluster can reach.
        for &j in &listed {
            let least = (cluster * WIDTH..(cluster + 1) * WIDTH)
                .map(|i| {
                    (0..D)
                        .map(|d| (set.positions[i][d] - set.positions[j as usize][d]).powi(2))
                        .sum::<f64>()
                        .sqrt()
                })
                .fold(f64::INFINITY, f64::min);
            let widest = if varying { 1.8 } else { 1.0 };
            prop_assert!(least <= support * widest + skin + 1e-9);
        }
    }
    prop_assert_eq!(entries, lists.entries());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn lists_in_a_row_hold_every_pair_within_reach(seed in any::<u64>(), varying in any::<bool>(), outliers in any::<bool>()) {
        lists_hold_all::<1>(seed, varying, outliers)?;
    }
    #[test]
    fn lists_in_a_plane_hold_every_pair_within_reach(seed in any::<u64>(), varying in any::<bool>(), outliers in any::<bool>()) {
        lists_hold_all::<2>(seed, varying, outliers)?;
    }
    #[test]
    fn lists_in_space_hold_every_pair_within_reach(seed in any::<u64>(), varying in any::<bool>(), outliers in any::<bool>()) {
        lists_hold_all::<3>(seed, varying, outliers)?;
    }
}

fn pressures<const D: usize>(simulation: &Simulation<f64, D>) -> Vec<f64> {
    simulation
        .all()
        .map(|particle| particle.pressure())
        .collect()
}

/// Largest difference over the largest value.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let top = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter()
        .zip(b)
        .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
        / top
}

fn impact(skin: f64) -> Simulation<f64, 1> {
    let mut simulation = Scene::new(schemes::impact())
        .body(Body::block("striker", catalogue::copper(), [0.0], [0.005], 1e-4).velocity([400.0]))
        .body(Body::block(
            "target",
            catalogue::aluminium(),
            [0.005],
            [0.02],
            1e-4,
        ))
        .boundary(MirrorPlane::wall([0.02], [1.0]))
        .skin(skin)
        .steps(|control| StepControl {
            fixed: Some(1e-9),
            ..control
        })
        .build()
        .unwrap();
    for _ in 0..600 {
        simulation.step().unwrap();
    }
    simulation
}

#[test]
fn a_rod_impact_does_not_feel_the_skin() {
    let (thin, thick) = (impact(0.02), impact(0.3));
    println!(
        "{} and {} list builds",
        thin.list_builds(),
        thick.list_builds()
    );
    assert!(thin.list_builds() > 3 * thick.list_builds() && thick.list_builds() > 1);
    let apart = apart(&pressures(&thin), &pressures(&thick));
    assert!(apart < 1e-9, "{apart:.3e}");
}

/// Edge of a sheet that shears \[m\].
const LENGTH: f64 = 0.016;

/// A sheet that shears and moves as a whole, with what else `scene` gives it.
fn shear(
    skin: f64,
    velocity: [f64; 2],
    scene: impl FnOnce(Scene<f64, 2>) -> Scene<f64, 2>,
) -> Simulation<f64, 2> {
    let k = 2.0 * std::f64::consts::PI / LENGTH;
    let sheet = Body::block("sheet", catalogue::copper(), [0.0; 2], [LENGTH; 2], 1e-3).start(
        move |x, start| meshfree::scene::Start {
            velocity: [
                velocity[0] + 60.0 * (k * x[1]).sin(),
                velocity[1] + 60.0 * (k * x[0]).cos(),
            ],
            ..start
        },
    );
    let mut simulation = scene(Scene::new(schemes::impact_by_continuity()).body(sheet))
        .skin(skin)
        .steps(|control| StepControl {
            fixed: Some(4e-8),
            ..control
        })
        .build()
        .unwrap();
    for _ in 0..400 {
        simulation.step().unwrap();
    }
    simulation
}

#[test]
fn a_sheet_that_shears_through_its_periods_does_not_feel_the_skin() {
    // Lists, order and images all change.
    let periods = |scene: Scene<f64, 2>| {
        let scene = scene.boundary(Periodic::along(0, 0.0, LENGTH));
        scene.boundary(Periodic::along(1, 0.0, LENGTH))
    };
    let of = |skin| shear(skin, [300.0, 200.0], periods);
    let (thin, thick) = (of(0.02), of(0.3));
    println!(
        "{} and {} list builds",
        thin.list_builds(),
        thick.list_builds()
    );
    assert!(thin.list_builds() > 3 * thick.list_builds() && thick.list_builds() > 1);
    let apart = apart(&pressures(&thin), &pressures(&thick));
    println!("apart {apart:.3e}");
    assert!(apart < 1e-8, "{apart:.3e}");
}

#[test]
fn lists_last_while_particles_move_together() {
    let free = |scene| scene;
    let (moving, still) = ([600.0, -300.0], [0.0; 2]);
    let [fast, slow, thick] = [(0.02, moving), (0.02, still), (0.3, moving)]
        .map(|(skin, velocity)| shear(skin, velocity, free));
    // The control: an outlet takes particles where lists are made, and makes them follow places, however far away it is.
    let far = Outlet::plane([1.0, 0.0], [1.0, 0.0]);
    let watched = shear(0.02, moving, |scene| scene.outlet(far));
    let [fast_builds, slow_builds, watched_builds] =
        [&fast, &slow, &watched].map(|own| own.list_builds() as f64);
    println!("{fast_builds} builds moving, {slow_builds} at rest, {watched_builds} watched");
    assert!((fast_builds / slow_builds - 1.0).abs() < 0.1);
    assert!(watched_builds > 2.0 * fast_builds && slow_builds > 10.0);
    // And they miss no pair.
    assert!(fast.list_builds() > 3 * thick.list_builds());
    let apart = apart(&pressures(&fast), &pressures(&thick));
    println!("apart {apart:.3e}");
    assert!(apart < 1e-8, "{apart:.3e}");
}

#[test]
fn a_wall_that_comes_is_a_body_that_goes() {
    let rod = |velocity: f64, wall: f64| {
        let mut simulation = Scene::new(schemes::impact())
            .body(
                Body::block("rod", catalogue::copper(), [0.0], [0.005], 1e-4).velocity([velocity]),
            )
            .boundary(MirrorPlane::wall([0.0055], [1.0]).moving(wall))
            .steps(|control| StepControl {
                fixed: Some(4e-9),
                ..control
            })
            .build()
            .unwrap();
        simulation.run_until(6e-6).unwrap();
        simulation
    };
    let (goes, comes) = (rod(200.0, 0.0), rod(0.0, -200.0));
    let top = pressures(&goes).iter().fold(0.0_f64, |m, p| m.max(p.abs()));
    assert!(top > 1e9, "they have not met: {top}");
    let apart = apart(&pressures(&goes), &pressures(&comes));
    assert!(apart < 1e-9, "{apart:.3e}");
}

/// List builds of 120 steps in which a rod flies off at `speed` \[m/s\] from one at rest, and of 300 more at a
/// tenth of that.
fn flight(skin: Option<f64>, speed: f64) -> [u64; 2] {
    let rod =
        |name, from: f64| Body::block(name, catalogue::copper(), [from], [from + 0.002], 1e-4);
    let mut scene = Scene::<f64, 1>::new(schemes::impact())
        .body(rod("at rest", 0.0))
        .body(rod("drop", 0.01).velocity([speed]))
        .steps(|control| StepControl {
            fixed: Some(1e-9),
            ..control
        });
    if let Some(skin) = skin {
        scene = scene.skin(skin);
    }
    let mut simulation = scene.build().unwrap();
    let builds = |simulation: &mut Simulation<f64, 1>, steps: usize| {
        let before = simulation.list_builds();
        for _ in 0..steps {
            simulation.step().unwrap();
        }
        simulation.list_builds() - before
    };
    let fast = builds(&mut simulation, 120);
    simulation.set_velocities(|_, v| v.map(|v| 0.1 * v));
    [fast, builds(&mut simulation, 400)]
}

#[test]
fn lists_that_do_not_last_get_a_thicker_skin_and_lose_it_again() {
    let [thin, thick, own] = [Some(0.1), Some(0.2), None].map(|skin| flight(skin, 6000.0));
    println!("builds at 0.1, 0.2 and as chosen: {thin:?}, {thick:?}, {own:?}");
    assert!(thin[0] > 120 / 8 && thick[0] <= 120 / 4);
    assert!(own[0] <= thick[0] + 1);
    // Slow again, they are thin but for the first of them.
    assert!(thick[1] + 3 < thin[1] && thin[1] <= own[1] + 1);
    // Lists that last keep the thin skin.
    assert_eq!(flight(None, 1000.0), flight(Some(0.1), 1000.0));
}

/// Counted work is entries of lists: those of two parts are those of the whole, wherever it is cut.
#[test]
fn entries_of_parts_add_up() {
    let places = (0..3000).map(|k| {
        [
            0.013 * f64::from(k * 37 % 101),
            0.017 * f64::from(k * 53 % 97),
        ]
    });
    let places: Vec<[f64; 2]> = places.collect();
    let blocks = [(0..2000, false), (2000..3000, true)].map(|(slots, wall)| Block { slots, wall });
    let mut lists = ClusterLists::default();
    lists.rebuild(&SearchInput {
        positions: &places,
        radii: Radii::Uniform(0.1),
        blocks: &blocks,
        listed: &[],
        width: 4,
        slots: 3000,
        skin: 0.01,
        instructions: InstructionSet::detect(),
    });
    for cut in [0, 4, 128, 400, 1996, 2000, 2996, 3000] {
        let parts = [0..cut, cut..3000].map(|slots| lists.entries_of(slots, 4));
        assert_eq!(parts.iter().sum::<usize>(), lists.entries(), "{cut}");
    }
    assert!(lists.entries_of(0..4, 4) > 0 && lists.entries() > 10_000);
}

/// Neighbours of a sheet that is periodic along x and mirrored at y = 0, against a search over all places.
#[test]
fn neighbors_of_a_particle_are_all_that_its_kernel_reaches() {
    const EDGE: f64 = 0.02;
    let sheet = Body::block("sheet", catalogue::copper(), [0.0; 2], [EDGE; 2], 1e-3);
    let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
        .body(sheet.jitter(0.2, 7).velocity([30.0, -20.0]))
        .boundary(Periodic::along(0, 0.0, EDGE))
        .boundary(MirrorPlane::symmetry([0.0; 2], [0.0, -1.0]))
        .build()
        .unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let reach = simulation.scheme().kernel().support * simulation.smoothing_length();
    let all: Vec<_> = simulation.all().collect();
    let (mut images, mut unity) = (0, 0.0);
    for own in &all {
        let x = own.position();
        let mut expected = Vec::new();
        for other in &all {
            let [y, v] = [other.position(), other.velocity()];
            for period in [-EDGE, 0.0, EDGE] {
                for mirror in [1.0, -1.0] {
                    let r = [y[0] + period - x[0], mirror * y[1] - x[1]];
                    let itself = period == 0.0 && mirror == 1.0 && other.id() == own.id();
                    if r[0].hypot(r[1]) < reach * (1.0 - 1e-9) && !itself {
                        let image = period != 0.0 || mirror < 0.0;
                        expected.push((other.id(), image, r, [v[0], mirror * v[1]]));
                    }
                }
            }
        }
        let mut found = Vec::new();
        own.for_each_neighbor(|neighbor| {
            let other = neighbor.particle();
            images += usize::from(neighbor.is_image());
            unity += neighbor.kernel() * other.mass() / other.density();
            assert!(
                (neighbor.distance() - neighbor.offset()[0].hypot(neighbor.offset()[1])).abs()
                    < 1e-15
            );
            found.push((
                other.id(),
                neighbor.is_image(),
                neighbor.offset(),
                neighbor.velocity(),
            ));
        });
        assert_eq!(found.len(), expected.len());
        for (id, image, r, v) in found {
            let same = |own: &&(usize, bool, [f64; 2], [f64; 2])| {
                (own.0, own.1) == (id, image) && (0..2).all(|d| (own.2[d] - r[d]).abs() < 1e-12)
            };
            let own = expected
                .iter()
                .find(same)
                .expect("a neighbour that is there");
            assert!((0..2).all(|d| (own.3[d] - v[d]).abs() < 1e-12));
        }
    }
    assert!(images > 500, "{images}");
    // Without what a particle adds itself.
    assert!((0.5..1.0).contains(&(unity / all.len() as f64)), "{unity}");
}
