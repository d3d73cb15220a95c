//! A hundred bad inputs and more, each by its own name or number: all ranks return the error of one process, and where one rank alone has
//! it, all end and name that rank. Nothing hangs; with the good number of the same input everything is well.

use super::errors::named_by_all;
use super::watched;
use meshfree::boundary::{Inlet, Source, Wall};
use meshfree::coupling::ContactDensity;
use meshfree::prelude::*;
use meshfree::ranks::{self, Ranks};
use std::collections::BTreeSet;
use std::sync::Arc;

const RANKS: usize = 3;
const NAN: f64 = f64::NAN;
const INF: f64 = f64::INFINITY;

type Place = Option<Arc<dyn Ranks>>;

/// What a number is of, one that is good, those that are not, and what is done with it.
type Input = (
    &'static str,
    f64,
    &'static [f64],
    fn(f64, Place) -> Result<(), Error>,
);

fn built<const D: usize>(scene: Scene<f64, D>, place: Place) -> Result<Simulation<f64, D>, Error> {
    match place {
        Some(ranks) => scene.on_ranks(ranks).build(),
        None => scene.build(),
    }
}

/// Builds a scene, and takes a step.
fn step<const D: usize>(scene: Scene<f64, D>, place: Place) -> Result<(), Error> {
    built(scene, place)?.step().map(|_| ())
}

fn rod() -> Body<f64, 1> {
    Body::block("rod", catalogue::copper(), [0.0], [0.02], 1e-3)
}

fn rods(body: Body<f64, 1>) -> Scene<f64, 1> {
    Scene::new(schemes::impact()).body(body)
}

fn pool() -> Scene<f64, 2> {
    let water = catalogue::weakly_compressible_water(1.0);
    let pool = Body::block("water", water, [0.0; 2], [0.1; 2], 0.01);
    Scene::new(schemes::weakly_compressible()).body(pool)
}

fn tank(corner: f64, spacing: f64) -> Wall<2> {
    Wall::around("tank", [0.0; 2], [0.1, corner], spacing, 3, [[true; 2]; 2])
}

fn inlet(x: f64, velocity: f64, spacing: f64) -> Inlet<2> {
    let opening = (0..10).map(|k| [x, 0.01 * (f64::from(k) + 0.5)]).collect();
    Inlet::new("water", opening, [velocity, 0.0], spacing, 100)
}

/// Names that the scene does not have, by number.
fn named(number: f64, place: Place) -> Result<(), Error> {
    let scene = rods(rod());
    let scene = match number as usize {
        1 => scene.between("rod", "pad", Interaction::Bonded),
        2 => scene.fix("pad", |_| true),
        3 => scene.rigid("pad"),
        4 => scene.couple("rod", "pad", ContactDensity::new()),
        5 => scene.sub_cycle("pad", 4),
        6 => scene.at_rest_until_contact("pad"),
        7 => scene.fix_until("rod", |_| true, "never"),
        8 => scene.load(Load::acceleration(|_| [0.0]).on("pad")),
        9 => scene.body(rod()),
        10 => Scene::new(schemes::impact()),
        11 => scene.body(Body::block(" ", catalogue::copper(), [0.03], [0.04], 1e-3)),
        12 => scene.between("rod", "rod", Interaction::None),
        _ => scene,
    };
    step(scene, place)
}

const INPUTS: [Input; 26] = [
    ("spacing", 1e-3, &[NAN, INF, 0.0, -1e-3, 1.0], |x, at| {
        step(
            rods(Body::block("rod", catalogue::copper(), [0.0], [0.02], x)),
            at,
        )
    }),
    ("corner", 0.02, &[NAN, INF, -0.02, 1e9], |x, at| {
        step(
            rods(Body::block("rod", catalogue::copper(), [0.0], [x], 1e-3)),
            at,
        )
    }),
    ("velocity", 20.0, &[NAN, INF, -INF, 1e300, -3e8], |x, at| {
        step(rods(rod().velocity([x])), at)
    }),
    ("energy", 10.0, &[NAN, INF, -INF, 1e300, -1e12], |x, at| {
        step(rods(rod().energy(x)), at)
    }),
    (
        "density",
        8930.0,
        &[NAN, INF, 0.0, -8930.0, 89.3],
        |x, at| step(rods(rod().density(x)), at),
    ),
    ("jitter", 0.1, &[NAN, INF, -0.1, 0.5], |x, at| {
        step(rods(rod().jitter(x, 1)), at)
    }),
    ("place of a point", 0.001, &[NAN, INF, 1e300], |x, at| {
        let points = vec![[0.0], [x], [0.002]];
        step(
            rods(Body::points_of("rod", catalogue::copper(), points, 1e-3)),
            at,
        )
    }),
    ("hydrostatic start", -9.81, &[NAN, INF, -INF], |x, at| {
        step(rods(rod().hydrostatic([x], [0.02])), at)
    }),
    ("fixed step", 1e-9, &[NAN, 0.0, -1e-9, 1e-6], |x, at| {
        let fixed = move |own| StepControl {
            fixed: Some(x),
            ..own
        };
        step(rods(rod()).steps(fixed), at)
    }),
    ("step factor", 0.3, &[NAN, 0.0, -0.3, 100.0], |x, at| {
        step(
            rods(rod()).steps(move |own| StepControl { courant: x, ..own }),
            at,
        )
    }),
    ("skin", 0.2, &[NAN, -1.0, -INF], |x, at| {
        step(rods(rod()).skin(x), at)
    }),
    ("smoothing", 1.2, &[NAN, 1.5, 0.3, -1.2], |x, at| {
        let sheet = Body::block("sheet", catalogue::copper(), [0.0; 2], [0.01; 2], 1e-3);
        step(
            Scene::<f64, 2>::new(schemes::impact().h_over_dx(x)).body(sheet),
            at,
        )
    }),
    ("memory", 1e9, &[0.0, 1.0, 1000.0], |x, at| {
        step(pool().memory_limit(x as u64), at)
    }),
    ("period", 0.02, &[NAN, INF, -1.0, 1e-3], |x, at| {
        step(rods(rod()).boundary(Periodic::along(0, 0.0, x)), at)
    }),
    ("normal", 1.0, &[NAN, INF, 0.0], |x, at| {
        step(rods(rod()).boundary(MirrorPlane::wall([0.021], [x])), at)
    }),
    ("corner of a wall", 0.1, &[NAN, INF, 0.0, -0.1], |x, at| {
        step(pool().wall(tank(x, 0.01)), at)
    }),
    (
        "spacing of a wall",
        0.01,
        &[NAN, INF, 0.0, -0.01, 1e-12],
        |x, at| step(pool().wall(tank(0.1, x)), at),
    ),
    ("opening", 0.0, &[NAN, INF], |x, at| {
        step(pool().inlet(inlet(x, 1.0, 0.01)), at)
    }),
    ("velocity of an inlet", 1.0, &[NAN, INF, 0.0], |x, at| {
        step(pool().inlet(inlet(0.0, x, 0.01)), at)
    }),
    (
        "spacing of an inlet",
        0.01,
        &[NAN, INF, 0.0, -0.01, 0.011],
        |x, at| step(pool().inlet(inlet(0.0, 1.0, x)), at),
    ),
    ("rate of a source", 1.0, &[NAN, -1.0, -INF], |x, at| {
        let hose = vec![[0.05, 0.2]];
        step(
            pool().source(Source::new("water", hose, x, 100).velocity([0.0, -1.0])),
            at,
        )
    }),
    ("acceleration", 1.0, &[NAN, INF, -INF], |x, at| {
        step(rods(rod()).acceleration(move |_| [x]), at)
    }),
    ("acceleration later", 1.0, &[NAN, INF, -INF], |x, at| {
        let late = move |t| [if t > 1e-6 { x } else { 0.0 }];
        built(rods(rod()).acceleration(late), at)?.run_until(2e-6)
    }),
    ("load", 1.0, &[NAN, INF, -INF, 1e300], |x, at| {
        let load = Load::acceleration(move |at| [if at.time > 1e-6 { x } else { 0.0 }]);
        built(rods(rod()).load(load), at)?.run_until(2e-6)
    }),
    ("end of a run", 1e-7, &[NAN, INF, -INF], |x, at| {
        built(rods(rod()), at)?.run_until(x)
    }),
    ("limit of a step", 1e-9, &[NAN, 0.0, -1.0, -INF], |x, at| {
        built(rods(rod()), at)?.step_at_most(x).map(|_| ())
    }),
];

/// What all ranks say, each with its number.
fn on_ranks(
    run: fn(f64, Place) -> Result<(), Error>,
    number: impl Fn(usize) -> f64 + Send + Sync + 'static,
) -> Vec<String> {
    watched(move || {
        let said = |ranks: Arc<dyn Ranks>| {
            let number = number(ranks.rank());
            run(number, Some(ranks)).map_or_else(|error| error.to_string(), |()| "well".into())
        };
        ranks::in_threads(RANKS, 1, said).expect("threads")
    })
}

#[test]
fn a_hundred_bad_inputs_are_one_error_on_all_ranks() {
    const NAMES: &[f64] = &[
        1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0,
    ];
    let names: Input = ("name", 0.0, NAMES, named);
    let mut texts = BTreeSet::new();
    let mut failed = 0;
    for (what, good, bad, run) in INPUTS.into_iter().chain([names]) {
        // The control: nothing but the number is wrong.
        assert_eq!(on_ranks(run, move |_| good), ["well"; RANKS], "{what}");
        for &bad in bad {
            let plain = run(bad, None).expect_err(what).to_string();
            let all = on_ranks(run, move |_| bad);
            assert_eq!(all, vec![plain.clone(); RANKS], "{what}: {bad}");
            texts.insert(format!("{what}: {plain}"));
            failed = (failed + 1) % RANKS;
            let all = on_ranks(run, move |rank| if rank == failed { bad } else { good });
            assert_eq!(all[failed], plain, "{what}: {bad}");
            named_by_all(&all, failed, &plain);
        }
    }
    println!("{} inputs", texts.len());
    assert!(texts.len() >= 100, "{texts:#?}");
}
