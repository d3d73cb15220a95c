//! Joints of rigid bodies against closed forms: pendulums, linkages, springs and motors.
//! Energy is closed by the ledger, momentum stays to rounding, and the order of joints changes no bit.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use meshfree::boundary::Rotation;
use meshfree::coupling::Joint;
use meshfree::material::Material;
use meshfree::material::eos::Linear;
use meshfree::scene::{Body, Scene};
use meshfree::schemes;
use meshfree::simulation::{RigidBody, Simulation, StepControl};
use meshfree::sweep::Interaction;

pub(crate) const OUT: [f64; 3] = [0.0, 0.0, 1.0];
const G: f64 = 9.81;

pub(crate) fn bar(name: &str, low: [f64; 2], high: [f64; 2], dx: f64) -> Body<f64, 2> {
    let material = Material::new("steel", Linear::new(1000.0, 20.0));
    Body::block(name, material, low, high, dx)
}

pub(crate) fn scene() -> Scene<f64, 2> {
    Scene::new(schemes::impact_by_continuity())
}

/// The complete elliptic integral of the first kind of the modulus k, by the arithmetic–geometric mean.
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..20 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    core::f64::consts::FRAC_PI_2 / a
}

fn total(now: &Simulation<f64, 2>, name: &str) -> f64 {
    now.ledger().whole.total(name).unwrap()
}

/// Kinetic energy and that in the gravity of the scene.
fn energy(now: &Simulation<f64, 2>, g: f64) -> f64 {
    let high: f64 = now.all().map(|p| p.mass() * p.position()[1]).sum();
    now.ledger().whole.kinetic + g * high
}

/// The times at which a quantity goes up through zero, by interpolation between steps.
fn upward_crossings(
    now: &mut Simulation<f64, 2>,
    end: f64,
    mut of: impl FnMut(&Simulation<f64, 2>) -> f64,
) -> Vec<f64> {
    let (mut last, mut all) = ((now.time(), of(now)), Vec::new());
    now.run_with(end, |now| {
        let next = (now.time(), of(now));
        if last.1 < 0.0 && next.1 >= 0.0 {
            all.push(last.0 - last.1 * (next.0 - last.0) / (next.1 - last.1));
        }
        last = next;
    })
    .unwrap();
    all
}

#[test]
fn a_physical_pendulum_has_the_period_of_the_elliptic_integral() {
    // Let go at 90 degrees.
    let mut simulation = scene()
        .body(bar("bar", [0.0, -0.05], [1.0, 0.05], 0.05))
        .rigid("bar")
        .joint_to_ground("bar", Joint::hinge([0.0; 2], OUT))
        .acceleration(|_| [0.0, -G])
        .build()
        .unwrap();
    let RigidBody { mass, inertia, .. } = simulation.rigid_body("bar").unwrap();
    let about = inertia[2][2] + mass * 0.25;
    let small = core::f64::consts::TAU * (about / (mass * G * 0.5)).sqrt();
    let period = small * elliptic(0.5_f64.sqrt()) * core::f64::consts::FRAC_2_PI;
    let start = energy(&simulation, G);
    let size = mass * G * 0.5;
    let mut worst = 0.0_f64;
    let lowest = |now: &Simulation<f64, 2>| now.joints()[0].value + core::f64::consts::FRAC_PI_2;
    let times = upward_crossings(&mut simulation, 12.5 * period, |now| {
        worst = worst.max((energy(now, G) - start).abs() / size);
        lowest(now)
    });
    let found = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    println!(
        "period {} of 1, {} periods, energy {worst:e}, steps {}",
        found / period,
        times.len(),
        simulation.steps()
    );
    assert_relative_eq!(found, period, max_relative = 1e-3);
    assert!(worst < 1e-3, "{worst:e}");
    // What the ground gave, and gravity, are the momentum.
    let ledger = simulation.ledger();
    let weight = mass * G * simulation.time();
    assert_abs_diff_eq!(
        ledger.joint_impulse[0],
        ledger.whole.momentum[0],
        epsilon = 1e-9 * weight
    );
    assert_abs_diff_eq!(
        ledger.joint_impulse[1] - weight,
        ledger.whole.momentum[1],
        epsilon = 1e-9 * weight
    );
    // The hinge has not moved, after thousands of steps.
    let own = simulation.rigid_body("bar").unwrap();
    let arm = own.centre[0].hypot(own.centre[1]);
    assert_relative_eq!(arm, 0.5, max_relative = 1e-13);
}

/// The same without projection: multipliers from accelerations alone, by a leapfrog with as many steps.
#[test]
fn without_projection_the_length_drifts() {
    let (mut x, mut v, steps, dt) = ([1.0, 0.0_f64], [0.0, 0.0_f64], 10_000, 1e-3);
    for _ in 0..steps {
        let along = x[0] * x[0] + x[1] * x[1];
        let pull = (v[0] * v[0] + v[1] * v[1] - G * x[1]) / along;
        v = [v[0] - dt * pull * x[0], v[1] - dt * (pull * x[1] + G)];
        x = [x[0] + dt * v[0], x[1] + dt * v[1]];
    }
    let control = (x[0].hypot(x[1]) - 1.0).abs();
    let mut simulation = scene()
        .body(bar("bob", [0.9, -0.1], [1.1, 0.1], 0.1))
        .rigid("bob")
        .joint_to_ground("bob", Joint::ball([0.0; 2]))
        .acceleration(|_| [0.0, -G])
        .steps(|own| StepControl {
            fixed: Some(dt),
            ..own
        })
        .build()
        .unwrap();
    simulation.run_until(10.0).unwrap();
    let [x, y] = simulation.rigid_body("bob").unwrap().centre;
    let held = (x.hypot(y) - 1.0).abs();
    println!("length off by {held:e}, without projection by {control:e}");
    assert!(held < 1e-13 && control > 1e-2, "{held:e}, {control:e}");
}

/// A crank of 0.3 m at 3 rad/s, by a motor or a clamp, a rod of 1 m and a block that slides.
fn slider_crank(clamped: bool) -> Scene<f64, 2> {
    let (dx, [r, l, speed]) = (0.05, CRANK);
    let own = scene()
        .body(bar("crank", [0.0, 0.0], [r, dx], dx))
        .body(bar("rod", [r, 0.0], [r + l, dx], dx))
        .body(bar("block", [r + l, -dx], [r + l + 0.2, 2.0 * dx], dx))
        .rigid("crank")
        .rigid("rod")
        .rigid("block")
        .between("crank", "rod", Interaction::None)
        .between("crank", "block", Interaction::None)
        .between("rod", "block", Interaction::None)
        .joint_to_ground("block", Joint::slider([r + l, 0.5 * dx], [1.0, 0.0]))
        .joint("rod", "crank", Joint::hinge([r, 0.5 * dx], OUT))
        .joint("block", "rod", Joint::hinge([r + l, 0.5 * dx], OUT));
    let axle = [0.0, 0.5 * dx];
    if clamped {
        let turns = Rotation::about(axle, move |t| [speed * t, speed, 0.0]);
        own.clamp("crank", |_| true, turns)
    } else {
        own.joint_to_ground("crank", Joint::hinge(axle, OUT).speed(move |_| speed))
    }
}

/// Radius \[m\], length of the rod \[m\], and speed \[rad/s\].
const CRANK: [f64; 3] = [0.3, 1.0, 3.0];

/// Masses \[kg\] of the rod, of 20 particles, and of the block, of 12, with ρ Δx² = 2.5 kg each.
const CRANKED: [f64; 2] = [50.0, 30.0];

/// Acceleration of the block along x \[m/s²\], by the second derivative of x(θ) = r cos θ + √(l² − r² sin² θ).
fn acceleration_of_block(time: f64) -> f64 {
    let [r, l, speed] = CRANK;
    let (sin, cos) = (speed * time).sin_cos();
    let along = (l * l - (r * sin).powi(2)).sqrt();
    let turned =
        r * r * (cos * cos - sin * sin) / along + (r * r * sin * cos).powi(2) / along.powi(3);
    -speed * speed * (r * cos + turned)
}

/// Kinetic energy of rod and block \[J\]; that of the crank is constant. The rod's angle φ follows from l sin φ = r sin θ.
fn kinetic_of_rod_and_block(time: f64) -> f64 {
    let ([r, l, speed], [rod, block]) = (CRANK, CRANKED);
    let (sin, cos) = (speed * time).sin_cos();
    let along = (l * l - (r * sin).powi(2)).sqrt();
    let spin = speed * r * cos / along;
    let block_speed = -speed * r * sin * (1.0 + r * cos / along);
    // The middle of the rod is half way between its ends.
    let [u, v] = [0.5 * (block_speed - speed * r * sin), 0.5 * speed * r * cos];
    // Of 20 points in a row.
    let inertia = rod * (l * l - 0.05 * 0.05) / 12.0;
    0.5 * (rod * (u * u + v * v) + inertia * spin * spin + block * block_speed * block_speed)
}

#[test]
fn a_slider_crank_follows_its_closed_form() {
    let [r, l, speed] = CRANK;
    // A clamp follows its motion to the square of the step, a motor to rounding.
    for (clamped, apart) in [(false, 1e-12), (true, 1e-6)] {
        let mut simulation = slider_crank(clamped).build().unwrap();
        let start = simulation.ledger().whole.kinetic;
        let (mut worst, mut unpaid) = (0.0_f64, 0.0_f64);
        // Force of the rod on the block, and power of the motor: largest error and largest value.
        let (mut force, mut power, mut last) = ([0.0_f64; 2], [0.0_f64; 2], 0.0);
        simulation
            .run_with(5.0, |now| {
                let dt = now.time() - last;
                // The first step has the blow with which the crank starts. Forces of what holds are means of a step.
                if last > 0.0 {
                    let exact = CRANKED[1] * acceleration_of_block(last + 0.5 * dt);
                    let found = now.joints()[2].force[0];
                    force = [
                        force[0].max((found - exact).abs()),
                        force[1].max(exact.abs()),
                    ];
                    let [before, after] = [last, now.time()].map(kinetic_of_rod_and_block);
                    let exact = (after - before) / dt;
                    let found = now
                        .joints()
                        .get(3)
                        .map_or(exact, |motor| motor.moment[2] * speed);
                    power = [
                        power[0].max((found - exact).abs()),
                        power[1].max(exact.abs()),
                    ];
                }
                last = now.time();
                let angle = speed * now.time();
                let exact = r * angle.cos() + (l * l - (r * angle.sin()).powi(2)).sqrt() - r - l;
                worst = worst.max((now.joints()[0].value - exact).abs());
                let gained = now.ledger().whole.kinetic - start;
                let paid = if clamped {
                    now.clamps()[0].work
                } else {
                    total(now, "work of motors")
                };
                unpaid = unpaid.max((gained - paid).abs());
            })
            .unwrap();
        let kinetic = simulation.ledger().whole.kinetic;
        println!(
            "clamped {clamped}: off by {worst:e} m, energy by {:e}, force and power by {:e} and {:e}, steps {}",
            unpaid / kinetic,
            force[0] / force[1],
            power[0] / power[1],
            simulation.steps()
        );
        assert!(force[0] < 0.01 * force[1], "{force:?}");
        assert!(power[0] < 0.01 * power[1], "{power:?}");
        assert!(worst < apart, "{worst:e}");
        assert!(unpaid < 1e-5 * kinetic, "{unpaid:e} of {kinetic}");
        if !clamped {
            // Turns count.
            assert_relative_eq!(simulation.joints()[3].value, 15.0, max_relative = 1e-12);
        }
    }
}

/// Two bars that hang on each other, with a spring between them, in a scene that may be elsewhere; the joints in either order.
fn double_pendulum([x, y]: [f64; 2], turned_round: bool) -> Scene<f64, 2> {
    let dx = 0.0625;
    let all = [
        (None, Joint::hinge([x, y], OUT)),
        (Some(()), Joint::hinge([x + 1.0, y], OUT).stiffness(2.0)),
    ];
    let mut scene = scene()
        .body(bar("upper", [x, y - dx], [x + 1.0, y + dx], dx))
        .body(bar("lower", [x + 1.0, y - dx], [x + 2.0, y + dx], dx))
        .rigid("upper")
        .rigid("lower")
        .between("upper", "lower", Interaction::None)
        .acceleration(|_| [0.0, -G]);
    for k in if turned_round { [1, 0] } else { [0, 1] } {
        let (second, joint) = all[k].clone();
        scene = match second {
            None => scene.joint_to_ground("upper", joint),
            Some(()) => scene.joint("lower", "upper", joint),
        };
    }
    scene
}

fn bits(now: &Simulation<f64, 2>) -> Vec<u64> {
    let velocities = now.all().flat_map(|p| p.velocity());
    let joints = now
        .joints()
        .into_iter()
        .flat_map(|own| [own.value, own.work, own.impulse[0]]);
    let mut joints: Vec<u64> = joints.map(f64::to_bits).collect();
    joints.sort_unstable();
    velocities.map(f64::to_bits).chain(joints).collect()
}

#[test]
fn a_double_pendulum_keeps_its_energy() {
    let mut simulation = double_pendulum([0.0; 2], false).build().unwrap();
    let start = energy(&simulation, G);
    let size = simulation.ledger().whole.mass * G;
    let (mut worst, mut gap) = (0.0_f64, 0.0_f64);
    simulation
        .run_with(15.0, |now| {
            let stored = total(now, "energy of joints");
            worst = worst.max((energy(now, G) + stored - start).abs() / size);
            let [upper, lower] = ["upper", "lower"].map(|name| now.rigid_body(name).unwrap());
            let end = |own: &RigidBody<2>, side: f64| -> [f64; 2] {
                core::array::from_fn(|d| own.centre[d] + side * 0.5 * own.orientation[d][0])
            };
            let (a, b) = (end(&upper, 1.0), end(&lower, -1.0));
            gap = gap.max((a[0] - b[0]).hypot(a[1] - b[1]));
        })
        .unwrap();
    println!(
        "energy {worst:e}, gap {gap:e}, steps {}",
        simulation.steps()
    );
    assert!(worst < 1e-3, "{worst:e}");
    assert!(gap < 1e-13, "{gap:e}");
}

#[test]
fn order_and_place_change_no_bit() {
    let run = |at, turned_round| {
        let mut simulation = double_pendulum(at, turned_round).build().unwrap();
        simulation.run_until(1.0).unwrap();
        bits(&simulation)
    };
    let first = run([0.0; 2], false);
    assert_eq!(first, run([0.0; 2], true));
    assert_eq!(first, run([1024.0, -64.0], false));
}

#[cfg(feature = "checkpoint")]
#[test]
fn a_checkpoint_goes_on_to_the_same_bits() {
    let file = std::env::temp_dir().join(format!("meshfree-joints-{}", std::process::id()));
    let mut whole = double_pendulum([0.0; 2], false).build().unwrap();
    whole.run_until(1.0).unwrap();
    whole.save(&file).unwrap();
    let mut resumed = double_pendulum([0.0; 2], true).resume(&file).unwrap();
    let other = scene_with_another_spring().differences(&file).unwrap();
    std::fs::remove_file(&file).ok();
    for end in [1.0, 2.0] {
        whole.run_until(end).unwrap();
        resumed.run_until(end).unwrap();
        assert_eq!(bits(&whole), bits(&resumed));
    }
    assert!(other.iter().any(|own| own.part == "joints"), "{other:?}");
}

#[cfg(feature = "checkpoint")]
fn scene_with_another_spring() -> Scene<f64, 2> {
    double_pendulum([0.0; 2], false).joint(
        "lower",
        "upper",
        Joint::spring([0.5, 0.0], [1.5, 0.0], 1.0),
    )
}

/// Two blocks on a rod of one metre, which turn about their common centre as they fly.
#[test]
fn free_bodies_on_a_rod_keep_momentum_and_turn_evenly() {
    let spin = 4.0;
    let turns =
        move |[x, y]: [f64; 2], start: meshfree::scheme::Start<2>| meshfree::scheme::Start {
            velocity: [0.3 - spin * y, spin * x],
            ..start
        };
    let block = |name, x: f64| bar(name, [x - 0.1, -0.1], [x + 0.1, 0.1], 0.1).start(turns);
    let mut simulation = scene()
        .body(block("left", -0.5))
        .body(block("right", 0.5))
        .rigid("left")
        .rigid("right")
        .joint("left", "right", Joint::distance([-0.5, 0.0], [0.5, 0.0]))
        .build()
        .unwrap();
    let momenta = |now: &Simulation<f64, 2>| {
        let momentum = now.ledger().whole.momentum;
        let spin: f64 = now
            .all()
            .map(|p| {
                let ([x, y], [u, v]) = (p.position(), p.velocity());
                p.mass() * (x * v - y * u)
            })
            .sum();
        [momentum[0], momentum[1], spin]
    };
    let (before, kinetic) = (momenta(&simulation), simulation.ledger().whole.kinetic);
    simulation.run_until(5.0).unwrap();
    let after = momenta(&simulation);
    for k in 0..3 {
        assert_abs_diff_eq!(after[k], before[k], epsilon = 1e-11 * before[2]);
    }
    let [left, right] = ["left", "right"].map(|name| simulation.rigid_body(name).unwrap());
    let angle = (right.centre[1] - left.centre[1]).atan2(right.centre[0] - left.centre[0]);
    let turned = (angle - spin * 5.0).rem_euclid(core::f64::consts::TAU);
    let off = turned.min(core::f64::consts::TAU - turned);
    let lost = (simulation.ledger().whole.kinetic / kinetic - 1.0).abs();
    // The rod pulls by m ω² L/2.
    let pull = simulation.joints()[0].force[0].hypot(simulation.joints()[0].force[1]);
    println!("angle off by {off:e} of 20, energy {lost:e}, pull {pull}");
    assert!(off < 0.02, "{off:e}");
    assert!(lost < 1e-11, "{lost:e}");
    assert_relative_eq!(pull, left.mass * spin * spin * 0.5, max_relative = 1e-3);
}

#[test]
fn a_spring_has_its_period_and_a_damper_its_decay() {
    for damping in [0.0, 8.0] {
        let (k, start) = (400.0, 0.1);
        let mut simulation = scene()
            .body(bar("mass", [0.9, -0.1], [1.1, 0.1], 0.1))
            .rigid("mass")
            .joint_to_ground(
                "mass",
                Joint::slider([1.0, 0.0], [1.0, 0.0])
                    .stiffness(k)
                    .damping(damping)
                    .rest(-start),
            )
            .build()
            .unwrap();
        let mass = simulation.rigid_body("mass").unwrap().mass;
        let gamma = 0.5 * damping / mass;
        let omega = (k / mass - gamma * gamma).sqrt();
        let end = 6.0 * core::f64::consts::TAU / omega;
        let (mut worst, mut open) = (0.0_f64, 0.0_f64);
        simulation
            .run_with(end, |now| {
                let t = now.time();
                let (sin, cos) = (omega * t).sin_cos();
                let exact = start * (-gamma * t).exp() * (cos + gamma / omega * sin) - start;
                worst = worst.max((now.joints()[0].value - exact).abs() / start);
                let held = now.ledger().whole.kinetic
                    + total(now, "energy of joints")
                    + total(now, "heat of joints");
                open = open.max((held / (0.5 * k * start * start) - 1.0).abs());
            })
            .unwrap();
        println!(
            "damping {damping}: off by {worst:e}, energy {open:e}, steps {}",
            simulation.steps()
        );
        // A phase error of 0.05 % of six periods is 0.016 of the amplitude.
        assert!(worst < 0.02, "{worst:e}");
        assert!(open < 3e-3, "{open:e}");
    }
}

#[test]
fn motors_of_given_torque_and_force_pay_what_they_give() {
    let mut simulation = scene()
        .body(bar("wheel", [-0.2, -0.2], [0.2, 0.2], 0.1))
        .body(bar("cart", [1.0, -0.2], [1.4, 0.2], 0.1))
        .rigid("wheel")
        .rigid("cart")
        .joint_to_ground("wheel", Joint::hinge([0.0; 2], OUT).force(|_| 2.0))
        .joint_to_ground(
            "cart",
            Joint::slider([1.0, 0.0], [0.0, 3.0]).force(|t| 40.0 * t),
        )
        .build()
        .unwrap();
    simulation.run_until(1.5).unwrap();
    let (t, joints) = (simulation.time(), simulation.joints());
    let [wheel, cart] = ["wheel", "cart"].map(|name| simulation.rigid_body(name).unwrap());
    assert_relative_eq!(
        joints[0].value,
        0.5 * 2.0 / wheel.inertia[2][2] * t * t,
        max_relative = 1e-9
    );
    assert_relative_eq!(
        joints[1].rate,
        20.0 * t * t / cart.mass,
        max_relative = 1e-3
    );
    let ledger = simulation.ledger().whole;
    assert_relative_eq!(
        total(&simulation, "work of motors"),
        ledger.kinetic,
        max_relative = 1e-12
    );
    assert_relative_eq!(
        simulation.ledger().joint_impulse[1],
        ledger.momentum[1],
        max_relative = 1e-12
    );
}

/// A door in space on an axis that leans: a pendulum under g sin of the lean.
#[test]
fn a_door_on_a_leaning_axis_is_a_pendulum() {
    let lean = 0.4_f64;
    let axis = [lean.sin(), 0.0, lean.cos()];
    let door = |name| {
        let material = Material::new("wood", Linear::new(600.0, 20.0));
        Body::block(name, material, [-0.05, 0.0, -0.4], [0.05, 0.6, 0.4], 0.1)
    };
    let mut simulation = Scene::<f64, 3>::new(schemes::impact_by_continuity())
        .body(door("door"))
        .rigid("door")
        .joint_to_ground("door", Joint::hinge([0.0; 3], axis))
        .acceleration(|_| [0.0, 0.0, -G])
        .build()
        .unwrap();
    let own = simulation.rigid_body("door").unwrap();
    let about: f64 = (0..3)
        .map(|a| {
            (0..3)
                .map(|b| axis[a] * own.inertia[a][b] * axis[b])
                .sum::<f64>()
        })
        .sum::<f64>()
        + own.mass * 0.09;
    // It swings about where its centre is lowest, a quarter of a turn away; let go there it would rest.
    let period = core::f64::consts::TAU
        * (about / (own.mass * G * lean.sin() * 0.3)).sqrt()
        * elliptic(0.5_f64.sqrt())
        * core::f64::consts::FRAC_2_PI;
    let (mut last, mut all, mut start, mut worst) = ((0.0, -1.0), Vec::new(), None, 0.0_f64);
    simulation
        .run_with(2.6 * period, |now| {
            let own = now.rigid_body("door").unwrap();
            let energy = now.ledger().whole.kinetic + own.mass * G * own.centre[2];
            worst = worst.max((energy - *start.get_or_insert(energy)).abs());
            let angle = now.joints()[0].value;
            let next = (now.time(), angle.abs() - core::f64::consts::FRAC_PI_2);
            if last.1 < 0.0 && next.1 >= 0.0 {
                all.push(last.0 - last.1 * (next.0 - last.0) / (next.1 - last.1));
            }
            last = next;
        })
        .unwrap();
    let found = (all[all.len() - 1] - all[0]) / (all.len() - 1) as f64;
    let size = own.mass * G * lean.sin() * 0.3;
    println!(
        "period {} of 1, energy {:e}, steps {}",
        found / period,
        worst / size,
        simulation.steps()
    );
    assert_relative_eq!(found, period, max_relative = 2e-3);
    assert!(worst < 1e-3 * size, "{worst:e}");
    let own = simulation.rigid_body("door").unwrap();
    let arm = own.centre.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert_relative_eq!(arm, 0.3, max_relative = 1e-12);
}
