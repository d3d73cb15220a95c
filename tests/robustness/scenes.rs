//! Random scenes: each is built or refused with an error; what is built runs three steps to finite numbers or stops with an
//! error. Advice is asked of every one.

use super::guard;
use super::materials::material;
use super::numbers::Numbers;
use meshfree::boundary::{Periodic, Wall};
use meshfree::effect::NeoHookean;
use meshfree::prelude::*;
use meshfree::scene::Start;
use meshfree::scene::advice::Known;

type S = Scene<f64, 2>;

/// A material that goes with a scheme, most often.
fn usual(n: &mut Numbers, kind: usize) -> Material<f64> {
    match kind {
        0 => catalogue::weakly_compressible_water(n.scale(20.0, 100.0)),
        1 => [catalogue::copper(), catalogue::pmma(), catalogue::steel()][n.below(3)].clone(),
        _ => [catalogue::tank_pmma(), catalogue::ofhc_copper()][n.below(2)].clone(),
    }
}

/// A body, most often a block on a grid of cells that bodies share.
fn body(n: &mut Numbers, kind: usize, name: &str, place: f64, spacing: f64) -> Body<f64, 2> {
    let material = if n.part(4) {
        material(n)
    } else {
        usual(n, kind)
    };
    let size = [n.between(0.03, 0.1), n.between(0.03, 0.1)];
    let low = if n.part(6) { n.pair(0.1) } else { [place, 0.0] };
    let high = [low[0] + size[0], low[1] + size[1]];
    let kinds = if n.part(2) { 8 } else { 1 };
    let body = match 7 - n.below(kinds) {
        0 => Body::fill(name, material, &Ball::new(low, 0.5 * size[0]), spacing),
        1 => {
            let points = (0..n.below(30)).map(|_| n.pair(0.1)).collect();
            Body::points_of(name, material, points, spacing)
        }
        2 => {
            let hole = Ball::new(
                [low[0] + 0.5 * size[0], low[1] + 0.5 * size[1]],
                n.between(0.0, 0.02),
            );
            Body::fill(name, material, &Cuboid::new(low, high).minus(hole), spacing)
        }
        _ => Body::block(name, material, low, high, spacing),
    };
    let mut body = body;
    if n.part(2) {
        body = body.velocity(n.pair(30.0));
    }
    if n.part(4) {
        let (density, energy) = (n.scale(0.5, 2e4), n.between(-10.0, 1e5));
        body = match n.below(3) {
            0 => body.density(density),
            1 => body.energy(energy),
            _ => {
                let rate = n.between(-100.0, 100.0);
                body.start(move |x, own| Start {
                    velocity: [rate * x[1], -rate * x[0]],
                    ..own
                })
            }
        };
    }
    if n.part(5) {
        body = body.hydrostatic([0.0, n.between(-20.0, 0.0)], [0.0, n.between(0.0, 0.1)]);
    }
    if n.part(5) {
        body = body.jitter(n.between(0.0, 0.3), n.below(100) as u64);
    }
    if n.part(8) {
        body = body.no_slip();
    }
    body
}

fn scheme(n: &mut Numbers) -> (usize, Scheme<f64, 2>) {
    let ratio = n.between(1.0, 1.8);
    let wide = n.part(4);
    let factor = n.between(0.1, 0.9);
    let own_factor = n.part(6);
    macro_rules! composed {
        ($builder:expr) => {{
            let mut builder = $builder;
            if wide {
                builder = builder.h_over_dx(ratio);
            }
            if own_factor {
                builder = builder.step_factor(factor);
            }
            builder.compose()
        }};
    }
    match n.below(3) {
        0 => (0, composed!(schemes::weakly_compressible())),
        1 => (1, composed!(schemes::impact())),
        _ => (2, composed!(schemes::total_lagrangian().with(NeoHookean))),
    }
}

/// A random scene.
fn scene(n: &mut Numbers) -> S {
    let spacing = n.between(0.004, 0.01);
    let (kind, own) = scheme(n);
    let mut scene = S::new(own).memory_limit(200_000_000);
    let bodies = [1, 1, 2, 3][n.below(4)];
    let names = ["a", "b", if n.part(20) { "a" } else { "c" }];
    for (k, name) in names.iter().enumerate().take(bodies) {
        let place = 0.12 * k as f64 * n.between(0.8, 1.0);
        let spacing = if n.part(8) {
            n.between(0.004, 0.01)
        } else {
            spacing
        };
        scene = scene.body(body(n, kind, name, place, spacing));
    }
    // Most often one that there is.
    let name = move |n: &mut Numbers| {
        let all = if n.part(4) { 5 } else { bodies };
        ["a", "b", "c", "d", "nobody"][n.below(all)]
    };
    if n.part(4) {
        let (kind, other) = scheme(n);
        let own = body(n, kind, "d", -0.11, spacing);
        scene = scene.group(other, [own]);
        if n.part(3) {
            scene = scene.sub_cycle(name(n), n.below(20) as u32);
        }
    }
    let interaction = |n: &mut Numbers| {
        use meshfree::sweep::Interaction::{Bonded, None, Unilateral};
        [Bonded, None, Unilateral][n.below(3)]
    };
    if n.part(2) {
        scene = scene.between(name(n), name(n), interaction(n));
    }
    if n.part(4) {
        let (a, b) = (name(n), name(n));
        scene = match n.below(4) {
            0 => scene.couple(
                a,
                b,
                Penalty::new()
                    .stiffness(n.scale(1.0, 1e12))
                    .friction(n.between(0.0, 1.0)),
            ),
            1 => scene.couple(a, b, ContactDensity::new()),
            2 => scene.couple_self(a, n.between(0.0, 0.1), Penalty::new()),
            _ => scene.couple(a, b, Tied::new()),
        };
    }
    if (kind == 0 && n.once_in(3)) || n.part(10) {
        let closed = [[true, !n.part(4)], [true, !n.part(2)]];
        let high = [0.12 * bodies as f64, n.between(0.05, 0.2)];
        let mut wall = Wall::around("tank", [0.0; 2], high, spacing, n.below(5), closed);
        if n.part(3) {
            let v = n.pair(3.0);
            wall = wall.motion(Translation::steady(v));
        }
        if n.part(3) {
            wall = wall.no_slip();
        }
        scene = scene.wall(wall);
    }
    if n.part(5) {
        scene = scene.boundary(match n.below(3) {
            0 => MirrorPlane::wall(
                [n.between(-0.01, 0.0), 0.0],
                [n.between(-1.0, -0.5), n.between(0.0, 1e-9)],
            ),
            1 => MirrorPlane::symmetry(n.pair(0.1), n.pair(1.0)),
            _ => MirrorPlane::wall([0.0, 0.0], [0.0, -1.0]).moving(n.between(-3.0, 3.0)),
        });
    }
    if n.part(8) {
        let low = n.between(-0.01, 0.0);
        scene = scene.boundary(Periodic::along(n.below(2), low, low + n.between(0.05, 0.4)));
    }
    if n.part(5) {
        scene = scene.outlet(match n.below(3) {
            0 => Outlet::plane(n.pair(0.3), n.pair(1.0)),
            1 => Outlet::outside_box(n.pair(0.2), n.pair(0.4)),
            _ => Outlet::faster_than(n.between(0.0, 100.0)),
        });
    }
    if n.part(3) {
        let g = n.pair(300.0);
        scene = scene.acceleration(move |t| g.map(|g| g * (1.0 + t)));
    }
    if n.part(6) {
        let (k, body) = (n.between(0.0, 1e4), name(n));
        let mut load = if n.part(2) {
            Load::acceleration(move |at| at.velocity.map(|v| -k * v))
        } else {
            Load::heating(move |at| if at.since("moved").is_some() { k } else { 0.0 })
        };
        if n.part(2) {
            load = load.on(body);
        }
        scene = scene.load(load);
    }
    if n.part(8) {
        let far = n.between(0.0, 0.1);
        scene = scene.event("moved", move |now| now.all().any(|p| p.position()[0] > far));
    }
    if n.part(6) {
        let (left, body) = (n.between(0.0, 0.05), name(n));
        let v = n.pair(10.0);
        scene = match n.below(4) {
            0 => scene.fix(body, move |x| x[0] < left),
            1 => scene.clamp(body, move |x| x[0] < left, Translation::steady(v)),
            2 => scene.at_rest_until_contact(body),
            _ => scene.fix_until(body, move |x| x[0] < left, "moved"),
        };
    }
    if n.part(10) {
        scene = scene.rigid(name(n));
    }
    scene = match n.below(8) {
        0 => scene.integrator(DriftKickDrift),
        1 => scene.integrator(PositionVerlet),
        2 => scene.integrator(RungeKutta4),
        3 => scene.integrator(Midpoint),
        _ => scene,
    };
    if n.part(5) {
        let values = [
            n.between(0.05, 1.0),
            n.between(0.05, 1.0),
            n.scale(1e-9, 1e-3),
        ];
        let fixed = n.once_in(3);
        scene = scene.steps(move |own| StepControl {
            courant: values[0],
            force: values[1],
            fixed: fixed.then_some(values[2]),
            ..own
        });
    }
    if n.part(6) {
        scene = scene.skin(n.between(0.0, 1.0));
    }
    scene
}

pub fn case(seed: u64) -> &'static str {
    let mut n = Numbers::of(seed);
    let scene = scene(&mut n);
    let known = Known {
        surface_tension: n.once_in(2).then(|| n.scale(1e-3, 1.0)),
        speed: n.once_in(3).then(|| n.scale(1e-2, 1e2)),
        gap: n.once_in(3).then(|| n.scale(1e-3, 1.0)),
        ..Known::default()
    };
    assert!(
        !scene
            .advise(n.scale(1e-6, 1.0), &known)
            .to_string()
            .is_empty()
    );
    let mut simulation = match scene.build() {
        Ok(simulation) => simulation,
        Err(error) => {
            let text = error.to_string();
            assert!(!text.is_empty());
            if std::env::var("MESHFREE_WHY").is_ok() {
                println!("{seed}: {text}");
            }
            return "refused";
        }
    };
    for _ in 0..3 {
        if let Err(error) = simulation.step() {
            assert!(!error.to_string().is_empty());
            return "stopped";
        }
    }
    for particle in simulation.all() {
        let numbers = particle.position().into_iter().chain(particle.velocity());
        let state = [particle.density(), particle.pressure(), particle.energy()];
        for value in numbers.chain(state) {
            assert!(value.is_finite(), "{value} after three steps");
        }
    }
    assert!(simulation.time().is_finite() && simulation.ledger().whole.mass.is_finite());
    "ran"
}

#[test]
fn scenes_are_built_or_refused() {
    let words = guard::all("scenes", 0, 400, case);
    for word in ["refused", "ran"] {
        assert!(guard::share(&words, word) > 20, "{word}: {words:?}");
    }
}

/// A million: ten minutes on two cores; `MESHFREE_CASES` says how many instead.
#[test]
#[ignore = "a million scenes, ten minutes; MESHFREE_CASES for fewer"]
fn a_million_scenes() {
    let from = std::env::var("MESHFREE_FROM")
        .ok()
        .and_then(|n| n.parse().ok());
    guard::all("scenes", from.unwrap_or(1000), guard::asked(), case);
}

/// What a scene comes to: the error that ends it, or the bits after three steps.
fn end_of(scene: S) -> String {
    let ran = scene.build().and_then(|mut run| {
        (0..3).try_for_each(|_| run.step().map(|_| ()))?;
        run.run_until(run.time() * 1.3)?;
        Ok(format!("{:016x}", run.bits_hash()))
    });
    ran.unwrap_or_else(|error| error.to_string())
}

/// Every rank comes to what one process comes to; and where one of three has another scene, all end, and say which.
fn on_ranks(seed: u64) -> &'static str {
    use meshfree::ranks::in_threads;
    let of = |seed| scene(&mut Numbers::of(seed));
    let plain = end_of(of(seed));
    let count = 2 + seed as usize % 2;
    let all = in_threads(count, 1, |ranks| end_of(of(seed).on_ranks(ranks))).expect("threads");
    assert_eq!(all, vec![plain.clone(); count]);
    let other = seed as usize % 3;
    let apart = in_threads(3, 1, |ranks| {
        let seed = if ranks.rank() == other {
            seed + 1
        } else {
            seed
        };
        end_of(of(seed).on_ranks(ranks))
    });
    let is_bits = |own: &String| own.len() == 16 && u64::from_str_radix(own, 16).is_ok();
    let apart = apart.expect("threads");
    assert!(
        !apart.iter().any(is_bits) || apart.iter().all(|own| *own == plain),
        "{apart:#?}"
    );
    if is_bits(&plain) { "ran" } else { "refused" }
}

#[test]
fn scenes_on_ranks_come_to_what_they_come_to_alone() {
    let words = guard::all("scenes on ranks", 0, 250, on_ranks);
    assert!(guard::share(&words, "refused") >= 100, "{words:?}");
    assert!(guard::share(&words, "ran") > 20, "{words:?}");
}
