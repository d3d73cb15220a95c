//! Couplings by forces on the device as on the host: contact of bodies under several schemes, ties, and a body that meets itself.
//! Momentum, what the ledger has of couplings, the same bits in any work groups, checkpoints, and what is refused.

use crate::common::{device, in_any_groups};
use crate::compare::{
    build, differences, in_both, in_double, load, on, on_device, on_host, refused, resumed,
};
use crate::neighbours;
use meshfree::coupling::{
    ContactDensity, CoupledPair, CoupledParticle, Coupling, CouplingRecord, PairForce, Penalty,
    Tied,
};
use meshfree::effect::{NeoHookean, StVenantKirchhoff};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::scalar::{Lane, Traced};
use meshfree::term::TermDoc;
use meshfree_gpu::Device;

const SPACING: f64 = 0.0125;

fn rubber<T: Real>() -> Material<T> {
    Material::new("rubber", Linear::new(1500.0, 30.0)).with_shear_modulus(4e5)
}

fn block<T: Real, const D: usize>(name: &str, low: [f64; D], cells: [usize; D]) -> Body<T, D> {
    let high = core::array::from_fn(|d| low[d] + cells[d] as f64 * SPACING);
    Body::block(name, rubber(), low, high, SPACING)
}

/// Two blocks of rubber that meet at a corner, one by its neighbours as built and one by its present ones.
fn blocks<T: Real>(coupling: impl Coupling<T, 2> + 'static, fused: bool) -> Scene<T, 2> {
    let solid = schemes::total_lagrangian().with(NeoHookean);
    let other = schemes::impact_by_continuity().with(Hypoelastic);
    let scene = Scene::new(solid)
        .body(block("left", [0.0; 2], [32, 32]).velocity([2.0, 0.5]))
        .group(
            other,
            [block("right", [32.5 * SPACING, 10.0 * SPACING], [32, 32]).velocity([-2.0, 0.0])],
        )
        .couple("left", "right", coupling);
    on(scene, fused)
}

/// Two blocks that turn while they meet, each by its present neighbours, which are listed and sorted on the way.
fn turning<T: Real>(coupling: impl Coupling<T, 2> + 'static, fused: bool) -> Scene<T, 2> {
    let scheme = || schemes::impact_by_continuity().with(Hypoelastic);
    let turns = |low: f64, speed: f64| {
        let [x, y] = [low + 16.0 * SPACING, 16.0 * SPACING];
        move |at: [f64; 2], start| meshfree::scheme::Start {
            velocity: [speed - 40.0 * (at[1] - y), 40.0 * (at[0] - x)],
            ..start
        }
    };
    let right = 33.0 * SPACING;
    let scene = Scene::new(scheme())
        .body(block("left", [0.0; 2], [32, 32]).start(turns(0.0, 1.0)))
        .group(
            scheme(),
            [block("right", [right, 0.0], [32, 32]).start(turns(right, -1.0))],
        )
        .couple("left", "right", coupling);
    on(scene, fused)
}

/// A user's spring between what is nearer than a mean spacing, stiffer the nearer it is.
#[derive(Clone, Copy, Debug)]
struct Stiffening(f64);

impl Stiffening {
    fn push<L: Lane, const D: usize>(self, pair: &CoupledPair<L, D>) -> [L; D] {
        let apart = pair.apart();
        let distance = apart.iter().fold(L::zero(), |sum, x| sum + *x * *x).sqrt();
        let depth = (pair.spacing() - distance).positive_part();
        let scale = L::of(self.0) * depth * (L::one() + depth / pair.spacing()) / distance;
        apart.map(|x| scale * x)
    }
    fn stable<L: Lane>(self, masses: [L; 2]) -> L {
        L::of(0.25) * (masses[0].min(masses[1]) / L::of(self.0)).sqrt()
    }
}

impl<T: Real, const D: usize> Coupling<T, D> for Stiffening {
    fn name(&self) -> &'static str {
        "stiffening"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "stiffening".into(),
            equation: "F = k δ (1 + δ/s) r/|r|, δ = s − |r|",
            source: "this test",
        }
    }
    fn reach(&self, spacings: [f64; 2]) -> f64 {
        0.5 * (spacings[0] + spacings[1])
    }
    fn act(&self, pair: &CoupledPair<T, D>) -> PairForce<T, D> {
        PairForce::of(self.push(pair))
    }
    fn step(&self, on: &CoupledParticle<T, D>, from: &CoupledParticle<T, D>) -> f64 {
        self.stable([on.mass, from.mass]).to_f64()
    }
    fn record(&self) -> Option<CouplingRecord> {
        let act = |pair: &_| (self.push::<_, D>(pair), Traced::of(0.0));
        CouplingRecord::of::<D>(act, |on, from| self.stable([on.mass, from.mass])).ok()
    }
}

/// A rod of two schemes, tied, that is bent and pulled.
fn tied<T: Real>(fused: bool) -> Scene<T, 3> {
    let ends = |[x, _, z]: [f64; 3], start| meshfree::scheme::Start {
        velocity: [2.0 * x, 0.0, 3.0 * x * x + z],
        ..start
    };
    let along = 12.0 * SPACING;
    let other = schemes::total_lagrangian().with(StVenantKirchhoff);
    let scene = Scene::new(schemes::total_lagrangian().with(NeoHookean))
        .body(block("left", [-along, 0.0, 0.0], [12, 8, 8]).start(ends))
        .group(other, [block("right", [0.0; 3], [12, 8, 8]).start(ends)])
        .couple("left", "right", Tied::new());
    on(scene, fused)
}

/// A horseshoe of rubber whose ends meet.
fn horseshoe<T: Real>(coupling: impl Coupling<T, 2> + 'static, fused: bool) -> Scene<T, 2> {
    let at = |(i, j): (usize, usize)| [i, j].map(|k| (k as f64 + 0.5) * SPACING);
    let all = (0..60).flat_map(|i| (0..27).map(move |j| (i, j)));
    let points = all.filter(|&(i, j)| i < 12 || !(12..15).contains(&j));
    let middle = 13.5 * SPACING;
    let closes = move |[x, y]: [f64; 2], start| meshfree::scheme::Start {
        velocity: [0.0, -3.0 * x * (y - middle).signum()],
        ..start
    };
    let body = Body::points_of("shoe", rubber(), points.map(at).collect(), SPACING).start(closes);
    let scheme = schemes::total_lagrangian().with(NeoHookean);
    let scene = Scene::new(scheme).body(body);
    on(scene.couple_self("shoe", 2.9 * SPACING, coupling), fused)
}

/// Momentum stays, and what the ledger has of a coupling is that of the host.
fn is_kept<const D: usize>(device: &Device, scene: impl Fn() -> Scene<f64, D>, steps: usize) {
    let start = build(scene());
    let scale: f64 = start
        .all()
        .map(|own| own.mass() * speed(&own.velocity()))
        .sum();
    let [found, host] = [on_device(device, scene(), steps), on_host(scene(), steps)];
    let before = start.ledger().whole.momentum;
    for (now, before) in found.ledger().whole.momentum.iter().zip(&before) {
        assert!((now - before).abs() < 1e-12 * scale, "{now} {before}");
    }
    let [a, b] = [&found, &host].map(|own| own.contacts()[0].clone());
    assert!(b.pairs > 0 && b.stored > 0.0, "{b:?}");
    assert_eq!((a.pairs, &a.bodies), (b.pairs, &b.bodies));
    let near = |a: f64, b: f64, of: f64| assert!((a - b).abs() <= 1e-9 * of.abs(), "{a} {b} {of}");
    let most = b.force.iter().fold(0.0f64, |most, own| most.max(own.abs()));
    a.force
        .iter()
        .zip(&b.force)
        .for_each(|(a, b)| near(*a, *b, most));
    near(a.stored, b.stored, b.stored);
    let worked = b.work[0].abs() + b.work[1].abs();
    (0..2).for_each(|side| near(a.work[side], b.work[side], worked));
    near(a.penetration, b.penetration, 1.0);
    near(a.largest_penetration, b.largest_penetration, 1.0);
    assert!(a.work[0] != 0.0);
    println!("contact {a:?}");
}

fn speed<const D: usize>(v: &[f64; D]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[test]
fn blocks_that_collide_are_those_of_the_host() {
    let Some(device) = device("blocks that collide") else {
        return;
    };
    let density = |fused| blocks::<f64>(ContactDensity::new(), fused);
    let single = || blocks::<f32>(ContactDensity::new(), false);
    in_both(&device, "Blocks", density, single, 200);
    is_kept(&device, || density(false), 200);
    let damped = |fused| blocks::<f64>(Penalty::new().damping(0.2), fused);
    in_double(&device, "Damped blocks", damped, 200);
    is_kept(&device, || damped(false), 200);
}

#[test]
fn what_is_listed_and_sorted_there_meets_as_on_the_host() {
    let Some(device) = device("blocks that turn") else {
        return;
    };
    let density = |fused| turning::<f64>(ContactDensity::new(), fused);
    in_double(&device, "Turning blocks", density, 200);
    is_kept(&device, || density(false), 200);
    let mut run = load(&device, density(false));
    let before = neighbours::on_host(&mut run);
    // A look after each step changes no bit.
    for _ in 0..200 {
        run.step().unwrap();
        run.simulation().unwrap();
    }
    let after = neighbours::on_host(&mut run);
    println!("{} list builds", run.list_builds());
    for group in 0..2 {
        assert!(before.builds_lists(group));
        assert_ne!(before.ids(group), after.ids(group), "nothing was sorted");
    }
    assert!(run.list_builds() > 10, "{}", run.list_builds());
    let unseen = on_device(&device, density(false), 200);
    assert_eq!(
        run.into_simulation().unwrap().bits_hash(),
        unseen.bits_hash()
    );
}

#[test]
fn a_coupling_of_a_user_is_that_of_the_host() {
    let Some(device) = device("a coupling of a user") else {
        return;
    };
    let scene = |fused| blocks::<f64>(Stiffening(3e6), fused);
    in_double(&device, "A user's coupling", scene, 200);
    let [found, host] = [
        on_device(&device, scene(false), 200),
        on_host(scene(false), 200),
    ];
    let [a, b] = [&found, &host].map(|own| own.contacts()[0].clone());
    assert!(b.pairs > 0 && b.work[0] != 0.0, "{b:?}");
    assert_eq!(a.pairs, b.pairs);
    assert!((a.work[0] / b.work[0] - 1.0).abs() < 1e-9, "{a:?} {b:?}");
}

#[test]
fn a_tied_rod_is_that_of_the_host() {
    let Some(device) = device("a tied rod") else {
        return;
    };
    in_both(&device, "Tied rod", tied::<f64>, || tied::<f32>(false), 200);
    is_kept(&device, || tied(false), 200);
}

#[test]
fn a_body_that_meets_itself_is_that_of_the_host() {
    let Some(device) = device("a body that meets itself") else {
        return;
    };
    let scene = |fused| horseshoe::<f64>(ContactDensity::new(), fused);
    in_double(&device, "Horseshoe", scene, 120);
    is_kept(&device, || scene(false), 120);
    let damped = || horseshoe::<f64>(Penalty::new().damping(0.1), false);
    is_kept(&device, damped, 120);
}

#[test]
fn bits_of_contact_are_the_same_in_any_work_groups() {
    let Some(device) = device("bits of contact") else {
        return;
    };
    in_any_groups(device, |device| {
        let blocks = blocks::<f64>(ContactDensity::new(), false);
        let shoe = horseshoe::<f64>(ContactDensity::new(), false);
        vec![
            on_device(device, blocks, 60).bits_hash(),
            on_device(device, shoe, 60).bits_hash(),
        ]
    });
}

#[test]
fn a_checkpoint_of_contact_resumes_on_the_other_side() {
    let Some(device) = device("checkpoints of contact") else {
        return;
    };
    let scene = |fused| blocks::<f64>(ContactDensity::new(), fused);
    let [here, there, host] = resumed(&device, "contact", scene, [60, 60]);
    let work = host.contacts()[0].work;
    for own in [here, there] {
        let own = own.contacts()[0].work;
        assert!(
            (0..2).all(|k| (own[k] / work[k] - 1.0).abs() < 1e-9),
            "{own:?} {work:?}"
        );
    }
}

#[test]
fn a_reading_of_contact_between_two_steps_is_that_of_the_host() {
    let Some(device) = device("readings of contact") else {
        return;
    };
    let scene = |fused| blocks::<f64>(ContactDensity::new(), fused);
    // After fewer the host may have the places of itself to the last bit, which bounds nothing.
    let most = differences(&on_host(scene(true), 60), &on_host(scene(false), 60));
    let mut run = load(&device, scene(false));
    let mut host = build(scene(false));
    let end = 60.3 * host.step().unwrap();
    run.run_until(end).unwrap();
    host.run_until(end).unwrap();
    let found = differences(run.simulation().unwrap(), &host);
    assert!((0..3).all(|k| found[k] <= 20.0 * most[k]), "{found:?}");
}

#[test]
fn couplings_that_do_not_run_are_refused_by_name() {
    let slides = blocks::<f64>(Penalty::new().friction(0.2), false);
    refused(slides, &["the coupling `penalty`, which has no record"]);
    let slides = blocks::<f64>(ContactDensity::new().friction(0.2), false);
    refused(
        slides,
        &["the coupling `contact density`, which has no record"],
    );
    let plane = MirrorPlane::symmetry([0.0, -0.2], [0.0, -1.0]);
    let imaged = blocks::<f64>(ContactDensity::new(), false).boundary(plane);
    refused(imaged, &["the coupling `contact density` among images"]);
    let floor = Wall::around(
        "floor",
        [-0.5, -0.5],
        [1.0, 1.0],
        SPACING,
        2,
        [[true; 2]; 2],
    );
    let on_floor = blocks::<f64>(ContactDensity::new(), false)
        .wall(floor)
        .between("right", "floor", Interaction::None)
        .couple("left", "floor", Penalty::new());
    refused(on_floor, &["the coupling `penalty` with a wall"]);
}
