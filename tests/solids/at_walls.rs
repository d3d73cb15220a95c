//! Solids at walls of particles, without a liquid: weight, friction, belts, floors that tilt, periods and tanks that move.
//! Without contact a block falls through the floor.

use meshfree::boundary::{Outlet, Pose, Wall};
use meshfree::coupling::{ContactDensity, Coupling, Penalty};
use meshfree::effect::NeoHookean;
use meshfree::error::{Error, Problem};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;
use meshfree::simulation::{ParticleView, Thresholds};
use meshfree::term::viscosity::MonaghanGingold;

const DX: f64 = 0.02;
const G: f64 = 9.81;

/// Density \[kg/m³\] and sound speed \[m/s\] of a material that a rigid block is made of.
fn stuff() -> Material<f64> {
    Material::new("stuff", Linear::new(2000.0, 20.0))
}

fn rubber(density: f64, youngs: f64) -> Material<f64> {
    let law = Linear::from_elastic_constants(density, youngs, 0.3);
    Material::new("rubber", law).with_shear_modulus(youngs / 2.6)
}

/// A floor three layers thick from x = `low` to `high` \[m\], whose face is y = 0.
fn floor(low: i32, high: i32) -> Wall<2> {
    let across = (low..high).flat_map(|i| (0..3).map(move |j| (f64::from(i), f64::from(j))));
    let points = across.map(|(i, j)| [(i + 0.5) * DX, -(j + 0.5) * DX]);
    Wall::of("floor", points.collect(), DX)
}

/// A block of 6 × 6 particles whose lower face is at `y` \[m\].
fn block<T: Real>(x: f64, y: f64, material: Material<T>) -> Body<T, 2> {
    Body::block("block", material, [x, y], [x + 0.12, y + 0.12], DX)
}

fn rigid(x: f64, y: f64) -> Scene<f64, 2> {
    Scene::new(schemes::impact_by_continuity())
        .body(block(x, y, stuff()))
        .rigid("block")
}

fn elastic(x: f64, y: f64) -> Scene<f64, 2> {
    let viscosity = MonaghanGingold {
        alpha: 1.0,
        beta: 0.0,
    };
    let scheme = schemes::total_lagrangian()
        .with(NeoHookean)
        .with_viscosity(viscosity);
    Scene::new(scheme).body(block(x, y, rubber(2000.0, 5e5)))
}

/// The mean place and velocity of the block.
fn middle(now: &Simulation<f64, 2>) -> [[f64; 2]; 2] {
    let all: Vec<_> = now.body("block").unwrap().collect();
    let mean = |of: &dyn Fn(&ParticleView<'_, f64, 2>) -> [f64; 2]| {
        core::array::from_fn(|d| all.iter().map(|p| of(p)[d]).sum::<f64>() / all.len() as f64)
    };
    [mean(&|p| p.position()), mean(&|p| p.velocity())]
}

/// How far the lowest particle is from the first layer of the floor \[spacings\].
fn gap(now: &Simulation<f64, 2>) -> f64 {
    let heights = now.body("block").unwrap().map(|p| p.position()[1]);
    heights.fold(f64::INFINITY, f64::min) / DX + 0.5
}

/// A block that falls by two spacings lies a spacing before the floor, which bears its weight; all that it had is heat or
/// spring; without contact it falls through.
#[test]
fn blocks_come_to_rest_on_a_floor() {
    let damped = || Penalty::new().damping(0.5);
    let weight = 2000.0 * 0.12 * 0.12 * G;
    let falls = |scene: Scene<f64, 2>| scene.wall(floor(-8, 20)).acceleration(|_| [0.0, -G]);
    for (name, scene) in [("rigid", rigid(0.0, 0.04)), ("elastic", elastic(0.0, 0.04))] {
        let mut simulation = falls(scene)
            .couple("block", "floor", damped())
            .build()
            .unwrap();
        simulation.run_until(1.2).unwrap();
        let (mut force, mut samples) = (0.0, 0);
        simulation
            .run_with(1.5, |now| {
                force -= now.wall_force("floor").unwrap()[1] / weight;
                samples += 1;
            })
            .unwrap();
        let (force, gap) = (force / f64::from(samples), gap(&simulation));
        let ledger = simulation.ledger().whole;
        let contact = &simulation.contacts()[0];
        println!("{name}: gap {gap}, floor bears {force}, {contact:?}");
        // Particles lie above those of the floor, or in the hollows between them.
        let hollow = 0.75_f64.sqrt();
        let off = (gap - 1.0).abs().min((gap - hollow).abs());
        assert!(off < 0.1, "{name}: {gap}");
        assert!((force - 1.0).abs() < 0.01, "{name}: {force}");
        // What the floor took up is what gravity gave.
        let given = simulation.wall_impulse("floor").unwrap()[1] / (weight * simulation.time());
        let lacks = 1.0 + given + ledger.momentum[1] / (weight * simulation.time());
        assert!(lacks.abs() < 1e-11, "{name}: {lacks:e}");
        assert_eq!(contact.bodies, ["block".to_owned(), "floor".to_owned()]);
        assert_eq!(contact.work[1], 0.0);
        // The force on every particle of the floor is given with its place.
        let forces = simulation.wall_particle_forces();
        let sum: f64 = forces.iter().map(|own| own.1[1]).sum();
        let whole = simulation.wall_force("floor").unwrap()[1];
        assert!((sum / whole - 1.0).abs() < 1e-9, "{name}: {sum} {whole}");
        let pressed: Vec<_> = forces.iter().filter(|own| own.1[1] != 0.0).collect();
        let under = |x: f64, y: f64| y < 0.0 && y > -1.5 * DX && x > -DX && x < 0.12 + DX;
        assert!(!pressed.is_empty(), "{name}");
        assert!(
            pressed.iter().all(|own| under(own.0[0], own.0[1])),
            "{pressed:?}"
        );

        let none = |scene: Scene<f64, 2>| scene.between("floor", "block", Interaction::None);
        let start = if name == "rigid" {
            rigid(0.0, 0.04)
        } else {
            elastic(0.0, 0.04)
        };
        let mut through = none(falls(start)).build().unwrap();
        through.run_until(0.4).unwrap();
        let [[_, y], _] = middle(&through);
        let fallen = 0.1 - 0.5 * G * 0.16;
        assert!((y - fallen).abs() < 1e-3, "{name}: {y} of {fallen}");
    }
}

/// Kinetic energy, what gravity has in store, springs and heat of friction stay together; single precision holds as well.
#[test]
fn a_block_that_bounces_keeps_its_energy() {
    fn kept<T: Real>(coupling: impl Coupling<T, 2> + 'static) -> [f64; 2] {
        let law = Linear::new(2000.0, 20.0);
        let mut simulation = Scene::<T, 2>::new(schemes::impact_by_continuity())
            .body(block(0.0, 0.04, Material::new("stuff", law)))
            .rigid("block")
            .wall(floor(-8, 20))
            .couple("block", "floor", coupling)
            .acceleration(|_| [0.0, -G])
            .build()
            .unwrap();
        let (mut worst, mut deepest) = (0.0_f64, 0.0_f64);
        let mass = 2000.0 * 0.12 * 0.12;
        simulation
            .run_with(1.0, |now| {
                let heights = now.body("block").unwrap().map(|p| p.position()[1]);
                let y = heights.sum::<f64>() / 36.0;
                let ledger = now.ledger().whole;
                let stored = ledger.total("energy of couplings").unwrap();
                let whole = ledger.kinetic + stored + mass * G * (y - 0.06);
                worst = worst.max((whole / (mass * G * 0.04) - 1.0).abs());
                deepest = deepest.max(now.contacts()[0].largest_penetration);
            })
            .unwrap();
        [worst, deepest]
    }
    for (name, [worst, deepest]) in [
        ("penalty", kept::<f64>(Penalty::new())),
        ("contact density", kept::<f64>(ContactDensity::new())),
        ("penalty, f32", kept::<f32>(Penalty::new())),
        ("contact density, f32", kept::<f32>(ContactDensity::new())),
    ] {
        println!("{name}: energy changes by {worst:e}, deepest {deepest}");
        assert!(worst < 0.02 && deepest < 0.5, "{name}: {worst}, {deepest}");
    }
}

/// What a wall works is known: something is said of what contact stores, and nothing against it.
#[track_caller]
fn blames_nothing(now: &Simulation<f64, 2>) {
    let stored = now.stored_energy();
    let contact = stored.parts.iter().find(|part| part.name != "block");
    assert!(contact.is_some_and(|part| part.balance.is_ok()), "{stored}");
    assert!(!now.stability().verdict.breaks("stored energy"), "{stored}");
}

/// Gravity \[m/s²\] of a slope of some tangent.
fn slope(tangent: f64) -> [f64; 2] {
    let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
    [G * tangent * cos, -G * cos]
}

/// Amontons and Coulomb: a block on a slope stays where μ exceeds the tangent, and slides by g (sin − μ cos); one that is
/// pushed comes to rest after v²/2μg; one on a belt goes with it after v/μg.
#[test]
fn blocks_rub_on_walls_as_coulomb_has_it() {
    let slides = |tangent: f64, mu: f64, v: f64, belt: f64, time: f64| {
        let [x, y] = slope(tangent);
        let start = block(0.0, 0.0, stuff()).velocity([v, 0.0]);
        let mut simulation = Scene::<f64, 2>::new(schemes::impact_by_continuity())
            .body(start)
            .rigid("block")
            .wall(floor(-60, 90).sliding([belt, 0.0]))
            .couple("block", "floor", ContactDensity::new().friction(mu))
            // Across the floor first, and then along it, slowly, so that it neither bounces nor swings.
            .acceleration(move |t| {
                let on = 1.0_f64.min(t / 0.05);
                [x * ((t - 0.05) / 0.05).clamp(0.0, 1.0), y * on]
            })
            .build()
            .unwrap();
        simulation.keep_stability(Thresholds::default());
        simulation.run_until(0.1).unwrap();
        let before = middle(&simulation);
        simulation.run_until(0.1 + time).unwrap();
        let [[x, _], [u, _]] = middle(&simulation);
        blames_nothing(&simulation);
        let heat = simulation.contacts()[0].heat;
        println!("slope {tangent}, mu {mu}, v {v}, belt {belt}: {x}, {u}, heat {heat}");
        (
            [x - before[0][0], u - before[1][0]],
            before[1][0],
            simulation,
        )
    };
    // It sticks: it swings on the springs of friction, and is after twice the time where it was.
    let [early, late] = [0.3, 0.6].map(|time| slides(0.4, 0.45, 0.0, 0.0, time).0[0]);
    let drift = (late - early).abs() / 0.3;
    assert!(early.abs().max(late.abs()) < 0.02 * DX, "{early} {late}");
    assert!(drift < 1e-3, "{drift} m/s");
    // It slides.
    let cos = 1.0 / 1.16_f64.sqrt();
    let ([_, u], ..) = slides(0.4, 0.2, 0.0, 0.0, 0.3);
    let exact = 0.3 * G * (0.4 - 0.2) * cos;
    assert!((u / exact - 1.0).abs() < 0.02, "{u} of {exact}");
    // It comes to rest, and what it had is heat.
    let ([x, u], v, simulation) = slides(0.0, 0.3, 1.0, 0.0, 0.6);
    let way = v * v / (2.0 * 0.3 * G);
    assert!((x / way - 1.0).abs() < 0.02, "{x} of {way}");
    assert!((u + v).abs() < 5e-3, "{u} {v}");
    let had = 0.5 * 2000.0 * 0.12 * 0.12;
    assert!((simulation.contacts()[0].heat / had - 1.0).abs() < 0.03);
    // The belt takes it along, and works twice what it gains: the half is heat.
    let ([_, u], v, simulation) = slides(0.0, 0.3, 0.0, 0.5, 0.5);
    assert!((u + v - 0.5).abs() < 5e-3, "{}", u + v);
    let gains = 0.5 * 2000.0 * 0.12 * 0.12 * 0.25;
    let contact = &simulation.contacts()[0];
    println!("belt: {contact:?}, gains {gains}");
    assert!((contact.work[1] / (-2.0 * gains) - 1.0).abs() < 0.03);
    assert!((contact.heat / gains - 1.0).abs() < 0.05);
}

/// A motion about the origin, by an angle that grows as time does.
#[derive(Clone, Copy, Debug)]
struct Tilts(f64);

impl meshfree::boundary::Motion<2> for Tilts {
    fn name(&self) -> String {
        format!("turns at {} rad/s", self.0)
    }
    fn pose(&self, time: f64) -> Pose<2> {
        // It begins to turn gently.
        let begin = 0.2;
        let (angle, rate, growth) = if time < begin {
            (
                0.5 * self.0 / begin * time * time,
                self.0 / begin * time,
                self.0 / begin,
            )
        } else {
            (self.0 * (time - 0.5 * begin), self.0, 0.0)
        };
        let (sin, cos) = angle.sin_cos();
        let turn = nalgebra::Matrix2::new(cos, -sin, sin, cos);
        let across = nalgebra::Matrix2::new(-sin, -cos, cos, -sin);
        Pose {
            linear: [turn, across * rate, across * growth - turn * (rate * rate)],
            ..Pose::rest()
        }
    }
}

/// A floor tilts under a block: friction, which remembers places in the frame of the wall, holds it until the tangent of the
/// slope is μ.
#[test]
fn a_floor_tilts_until_friction_gives_way() {
    let rate = -0.4;
    let mut simulation = rigid(-0.06, 0.0)
        .wall(floor(-60, 60).motion(Tilts(rate)))
        .couple("block", "floor", ContactDensity::new().friction(0.3))
        .acceleration(|t| [0.0, -G * 1.0_f64.min(t / 0.05)])
        .build()
        .unwrap();
    simulation.keep_stability(Thresholds::default());
    simulation.keep_energy();
    let mut along = Vec::new();
    simulation
        .run_with(1.1, |now| {
            let pose = now.wall_pose("floor").unwrap();
            let turn = pose.linear[0];
            let [x, _] = middle(now);
            along.push((now.time(), turn[(0, 0)] * x[0] + turn[(1, 0)] * x[1]));
        })
        .unwrap();
    let at = |time: f64| along.iter().rfind(|own| own.0 <= time).unwrap().1;
    // The slope is 0.3 at an angle of 0.2915, after 0.829 s.
    let gives_way = 0.3_f64.atan() / -rate + 0.1;
    let [early, late] = [at(gives_way - 0.05) - at(0.1), at(1.1) - at(0.1)];
    println!(
        "slips by {} spacings before and {} after",
        early / DX,
        late / DX
    );
    assert!(early.abs() < 0.05 * DX, "{}", early / DX);
    assert!(late > 0.2 * DX, "{}", late / DX);
    let [wall, contact] = [
        simulation.energy().unwrap().wall_work,
        -simulation.contacts()[0].work[1],
    ];
    assert!((wall / contact - 1.0).abs() < 1e-9, "{wall} {contact}");
    blames_nothing(&simulation);
    let gain = simulation.stored_energy().parts;
    let gain = gain.iter().find_map(|part| part.balance.ok()).unwrap();
    assert!(gain.gain.abs() < 0.01 * gain.supplied, "{gain:?}");
}

/// A block slides through a period again and again: it keeps its speed, its shape and what the floor bears.
#[test]
fn blocks_slide_across_a_period() {
    let period = 30.0 * DX;
    for (name, scene) in [("rigid", rigid(0.3, 0.0)), ("elastic", elastic(0.3, 0.0))] {
        let slides = |scene: Scene<f64, 2>| {
            scene
                .wall(floor(0, 30))
                .boundary(Periodic::along(0, 0.0, period))
                .acceleration(|t| [0.0, -G * 1.0_f64.min(t / 0.1)])
        };
        let mut simulation = slides(scene)
            .couple("block", "floor", ContactDensity::new())
            .build()
            .unwrap();
        simulation.set_velocities(|_, _| [1.0, 0.0]);
        let weight = 2000.0 * 0.12 * 0.12 * G;
        simulation.run_until(0.2).unwrap();
        let before = simulation.wall_impulse("floor").unwrap()[1];
        simulation.run_until(2.0).unwrap();
        let ledger = simulation.ledger().whole;
        let impulse = simulation.wall_impulse("floor").unwrap()[1] - before;
        let borne = -impulse / (weight * (simulation.time() - 0.2));
        let speed = ledger.momentum[0] / ledger.mass;
        println!("{name}: bears {borne}, speed {speed}");
        assert!((borne - 1.0).abs() < 0.01, "{name}: {borne}");
        assert!((speed - 1.0).abs() < 5e-3, "{name}: {speed}");
        // It lies where it lay, after three periods and a third.
        let heights = simulation.body("block").unwrap().map(|p| p.position()[1]);
        let [low, high] = heights.fold([1.0_f64, 0.0], |[low, high], y| [low.min(y), high.max(y)]);
        assert!(
            (low / DX - 0.5).abs() < 0.1 && (high / DX - 5.5).abs() < 0.1,
            "{low} {high}"
        );
        if name == "rigid" {
            let xs: Vec<f64> = simulation
                .body("block")
                .unwrap()
                .map(|p| p.position()[0])
                .collect();
            let x = (0.3 + 0.01 + 2.0) % period;
            assert!((xs[0] - x).abs() < 0.05 * DX, "{} {x}", xs[0]);
            assert!(xs.iter().all(|x| (-1e-2..period + 1e-2).contains(x)));
        }
    }
}

/// A box that is shaken carries a block along: momentum is that of its walls, and their work is what there is more of.
#[test]
fn a_shaken_box_works_on_what_is_in_it() {
    let shakes = Translation::new(
        |t| [0.05 * (10.0 * t).sin() - 0.5 * t, 0.0],
        |t| [0.5 * (10.0 * t).cos() - 0.5, 0.0],
        |t| [-5.0 * (10.0 * t).sin(), 0.0],
    );
    let tank = Wall::around("tank", [0.0; 2], [0.4, 0.4], DX, 3, [[true; 2]; 2]).motion(shakes);
    let mut simulation = rigid(0.1, 0.0)
        .wall(tank)
        .couple("block", "tank", ContactDensity::new().friction(0.2))
        .acceleration(|t| [0.0, -G * 1.0_f64.min(t / 0.1)])
        .build()
        .unwrap();
    simulation.keep_energy();
    simulation.keep_stability(Thresholds::default());
    simulation.run_until(1.5).unwrap();
    blames_nothing(&simulation);
    let ledger = simulation.ledger().whole;
    let [x, y] = simulation.wall_impulse("tank").unwrap();
    let weight = ledger.mass * G * (simulation.time() - 0.05);
    assert!((ledger.momentum[0] + x).abs() < 1e-12 * weight, "{x}");
    assert!(
        (ledger.momentum[1] + y + weight).abs() < 1e-6 * weight,
        "{y}"
    );
    let contact = &simulation.contacts()[0];
    let [[_, y], _] = middle(&simulation);
    let lifted = ledger.mass * G * (y - 0.06);
    let kept = ledger.kinetic + lifted + contact.stored + contact.heat + contact.work[1];
    println!("{contact:?}, kinetic {}, kept {kept}", ledger.kinetic);
    assert!(
        contact.heat > 1.0 && kept.abs() < 0.02 * contact.heat,
        "{kept}"
    );
    let energy = simulation.energy().unwrap();
    assert!(
        (energy.wall_work / -contact.work[1] - 1.0).abs() < 1e-9,
        "{energy:?}"
    );
}

/// What passes an outlet leaves as a whole, and what it was is counted.
#[test]
fn a_rigid_block_leaves_by_an_outlet_as_one() {
    let mut simulation = rigid(0.0, 0.05)
        .outlet(Outlet::plane([0.3, 0.0], [1.0, 0.0]))
        .build()
        .unwrap();
    simulation.set_velocities(|_, _| [1.0, 0.0]);
    simulation.run_until(0.25).unwrap();
    assert_eq!(simulation.particles(), 36, "some of it is inside");
    simulation.run_until(0.5).unwrap();
    let removed = simulation.removed();
    let mass = 2000.0 * 0.12 * 0.12;
    assert_eq!((simulation.particles(), removed.particles), (0, 36));
    assert!((removed.momentum[0] / mass - 1.0).abs() < 1e-12);
}

fn problems(scene: Scene<f64, 2>) -> Vec<Problem> {
    match scene.build() {
        Err(Error::Build(error)) => error.problems,
        other => panic!("{:?}", other.map(|_| ())),
    }
}

/// A scene that does not say how a solid meets a wall is refused, with the line to write; so is what is said in vain.
#[test]
fn contact_with_walls_is_named() {
    let scene = || rigid(0.0, 0.04).wall(floor(-8, 20));
    let found = problems(scene());
    let [said @ Problem::ContactNotNamed { body, wall, .. }] = found.as_slice() else {
        panic!("{found:?}")
    };
    assert_eq!((body.as_str(), wall.as_str()), ("block", "floor"));
    let said = said.to_string();
    for line in [
        r#".couple("block", "floor", ContactDensity::new())"#,
        r#".between("block", "floor", Interaction::None)"#,
    ] {
        assert!(said.contains(line), "{said}");
    }
    // Both lines do.
    let contact = scene().couple("block", "floor", ContactDensity::new());
    assert!(contact.problems().is_empty());
    let none = scene().between("block", "floor", Interaction::None);
    assert!(none.problems().is_empty());
    // What is clamped as a whole does not move.
    let clamped = elastic(0.0, 0.04).wall(floor(-8, 20));
    assert!(clamped.fix("block", |_| true).problems().is_empty());
    let one = |scene: Scene<f64, 2>, part: &str| {
        let found = problems(scene);
        let said = found.iter().any(|own| own.to_string().contains(part));
        assert!(said, "{found:?}");
    };
    one(
        scene().couple("floor", "block", Penalty::new()),
        "name the body first",
    );
    one(
        scene().between("block", "floor", Interaction::Bonded),
        "name their contact with Scene::couple",
    );
    one(
        scene().couple("block", "roof", Penalty::new()),
        "no body called `roof`",
    );
    let inside = rigid(0.0, -0.01).wall(floor(-8, 20));
    let inside = problems(inside.couple("block", "floor", Penalty::new()));
    assert!(
        matches!(inside[..], [Problem::Overlap { .. }]),
        "{inside:?}"
    );
    // A plane turns images; walls of particles do instead.
    one(
        rigid(0.0, 0.04).boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0])),
        "bound the scene by walls of particles",
    );
}
