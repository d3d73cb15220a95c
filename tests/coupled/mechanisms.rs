//! Rigid bodies with joints, and piles of them, in water: a flap that floats on its hinge, and thin plates that come to rest.
//! What the hinge does is in the ledger.

use super::solids_in_tank::{DX, G, boxed, liquid, stuff, tank, water};
use approx::assert_relative_eq;
use meshfree::coupling::{Joint, Penalty};
use meshfree::prelude::*;
use meshfree::scheme::Start;

/// A light flap hinged near the floor swings out and back upright, and the hinge holds its buoyancy less its weight.
#[test]
fn a_hinged_flap_floats_upright() {
    let (low, size, density) = ([14.0, 4.0], [3.0, 9.0], 400.0);
    let high = [low[0] + size[0], low[1] + size[1]];
    let hinge = [15.5 * DX, 4.5 * DX];
    let spin = 10.0;
    let turns = move |[x, y]: [f64; 2], start: Start<2>| Start {
        velocity: [-spin * (y - hinge[1]), spin * (x - hinge[0])],
        ..start
    };
    let flap = boxed("flap", stuff(density), low, size).start(turns);
    let mut simulation = liquid()
        .body(water(31, 18, &[[low, high]]))
        .wall(tank(31, 26))
        .group(schemes::impact_by_continuity(), [flap])
        .rigid("flap")
        .between("flap", "tank", Interaction::None)
        .joint_to_ground("flap", Joint::hinge(hinge, [0.0, 0.0, 1.0]))
        .build()
        .unwrap();
    simulation.keep_energy();
    let own = simulation.rigid_body("flap").unwrap();
    let start = simulation.energy().unwrap();
    let (mut most, mut sums, mut time, mut last) = (0.0_f64, [0.0; 2], 0.0, 0.0);
    simulation
        .run_with(3.0, |now| {
            let (joint, dt) = (&now.joints()[0], now.time() - last);
            last = now.time();
            most = most.max(joint.value.abs());
            if last > 2.0 {
                sums[0] += dt * joint.value;
                sums[1] += dt * joint.force[1];
                time += dt;
            }
        })
        .unwrap();
    let [angle, held] = sums.map(|sum| sum / time);
    let lift = G * (own.mass - 1000.0 * size[0] * size[1] * DX * DX);
    let end = simulation.energy().unwrap();
    let flap =
        0.5 * own.inertia[2][2] * spin * spin + own.mass * 4.0 * 4.0 * DX * DX * spin * spin * 0.5;
    println!(
        "swings to {most}, rests at {angle}, hinge {held} of {lift}, work of the hinge {:e}, dissipated {:e} of {:e}, kinetic {:e}, steps {}",
        end.joint_work,
        end.dissipated,
        start.kinetic,
        end.kinetic,
        simulation.steps()
    );
    assert!(most > 0.08, "{most}");
    assert!(angle.abs() < 0.03, "{angle}");
    assert_relative_eq!(held, lift, max_relative = 0.01);
    assert!(
        end.joint_work.abs() < 0.01 * flap,
        "{:e} of {flap:e}",
        end.joint_work
    );
    // What the swing had is dissipated in the water.
    assert!(
        end.kinetic < 0.05 * start.kinetic,
        "{:e} of {:e}",
        end.kinetic,
        start.kinetic
    );
    assert!(end.dissipated > 0.0, "{:e}", end.dissipated);
}

/// A flap of 3 by 9 spacings that is hinged near the floor of a tank of water and does not reach its walls.
fn flap_on(hinge: Joint<2>) -> Simulation<f64, 2> {
    let (low, high) = ([14.0, 4.0], [17.0, 13.0]);
    let mut simulation = liquid()
        .body(water(31, 18, &[[low, high]]))
        .wall(tank(31, 26))
        .group(
            schemes::impact_by_continuity(),
            [boxed("flap", stuff(400.0), low, [3.0, 9.0])],
        )
        .rigid("flap")
        .between("flap", "tank", Interaction::None)
        .joint_to_ground("flap", hinge)
        .build()
        .unwrap();
    simulation.evaluate().unwrap();
    simulation
}

/// A flap on a spring swings with the period that its inertia and that of the water around it give. The inertia is the moment in
/// phase with the angular acceleration which a motor needs for the same swing in the same tank; it has what the flap's weight and
/// buoyancy do as well. Both runs are of this crate, so this compares two independent ways to one number, and not either with theory:
/// the water of a swing that is free, and the moment where the swing is prescribed.
#[test]
fn a_flap_on_a_spring_has_the_period_of_its_inertia_and_the_waters() {
    let hinge = || Joint::hinge([15.5 * DX, 4.5 * DX], [0.0, 0.0, 1.0]);
    let (stiffness, swing) = (200.0, 0.02);
    // Let go at rest, one swing from where the spring rests.
    let mut free = flap_on(hinge().stiffness(stiffness).rest(swing));
    let (mut last, mut turns) = ([0.0; 2], Vec::new());
    free.run_with(1.5, |now| {
        let next = [now.time(), now.joints()[0].rate];
        // The rate is zero at ends of swings, wherever their middle is.
        if (last[1] < 0.0) != (next[1] < 0.0) && last[0] > 0.0 {
            turns.push(last[0] - last[1] * (next[0] - last[0]) / (next[1] - last[1]));
        }
        last = next;
    })
    .unwrap();
    let found = (turns[6] - turns[0]) / 3.0;
    let omega = core::f64::consts::TAU / found;
    let mut driven = flap_on(hinge().speed(move |t| swing * omega * (omega * t).sin()));
    driven.run_until(2.0 * found).unwrap();
    let (mut moments, mut last) = ([0.0; 2], driven.time());
    driven
        .run_with(6.0 * found, |now| {
            let dt = now.time() - last;
            // The moment is the mean of the step.
            let (sin, cos) = (omega * (last + 0.5 * dt)).sin_cos();
            last = now.time();
            let moment = 0.5 * dt / found * now.joints()[0].moment[2];
            moments = [moments[0] + moment * cos, moments[1] + moment * sin];
        })
        .unwrap();
    let inertia = moments[0] / (swing * omega * omega);
    let damping = moments[1] / (swing * omega);
    let expected = (stiffness / inertia - (0.5 * damping / inertia).powi(2)).sqrt();
    let period = core::f64::consts::TAU / expected;
    let own = driven.rigid_body("flap").unwrap();
    let own = own.inertia[2][2] + own.mass * (4.0 * DX).powi(2);
    println!(
        "period {found} s of {period} s, inertia {inertia} of which {own} the flap's, damping {damping}, turns {turns:?}"
    );
    assert_relative_eq!(found, period, max_relative = 0.01);
    // Without the water the period would be another.
    assert!(inertia > 1.5 * own, "{inertia} and {own}");
}

/// Four plates of two particles sink onto each other and lie.
#[test]
fn four_thin_plates_come_to_rest_as_a_pile() {
    let places = [[8.0, 2.0], [10.0, 6.0], [7.0, 10.0], [9.0, 14.0]];
    let size = [12.0, 2.0];
    let names = ["a", "b", "c", "d"];
    let holes = places.map(|low| [low, [low[0] + size[0], low[1] + size[1]]]);
    let plates = (0..4).map(|k| boxed(names[k], stuff(3000.0), places[k], size));
    let mut scene = liquid()
        .body(water(30, 24, &holes))
        .wall(tank(30, 30))
        .group(schemes::impact_by_continuity(), plates);
    let contact = || Penalty::new().damping(0.3).friction(0.3);
    for (k, name) in names.into_iter().enumerate() {
        scene = scene.rigid(name).couple(name, "tank", contact());
        for other in &names[..k] {
            scene = scene.couple(name, other, contact());
        }
    }
    let mut simulation = scene.build().unwrap();
    let speed = |now: &Simulation<f64, 2>| {
        let all = names.map(|name| {
            let [u, v] = now.rigid_body(name).unwrap().velocity;
            u.hypot(v)
        });
        all.into_iter().fold(0.0, f64::max)
    };
    let (mut fastest, mut late) = (0.0_f64, 0.0_f64);
    simulation
        .run_with(4.0, |now| {
            fastest = fastest.max(speed(now));
            if now.time() > 3.5 {
                late = late.max(speed(now));
            }
        })
        .unwrap();
    let heights = names.map(|name| simulation.rigid_body(name).unwrap().centre[1] / DX);
    let tilts = names.map(|name| simulation.rigid_body(name).unwrap().orientation[1][0]);
    let floor = simulation.force_between("a", "tank").unwrap()[1];
    println!(
        "fastest {fastest}, late {late}, heights {heights:?}, tilts {tilts:?}, floor {floor}, steps {}",
        simulation.steps()
    );
    assert!(
        fastest > 0.1 && late < 0.02 * fastest,
        "{late} of {fastest}"
    );
    for k in 1..4 {
        assert!(heights[k] - heights[k - 1] > 1.5, "{heights:?}");
    }
}
