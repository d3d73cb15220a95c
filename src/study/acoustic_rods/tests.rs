//! Checks of the acoustic solution against numbers worked out by hand for the rods of Lam et al. (2001).
//! Impedances: copper 35.1842, steel 28.0245, aluminium 14.445, PMMA 3.094 MPa/(m/s).

use super::*;
use crate::study::Joint;
use proptest::prelude::*;

const COPPER: (f64, f64) = (8930.0, 3940.0);
const STEEL: (f64, f64) = (7850.0, 3570.0);
const ALUMINIUM: (f64, f64) = (2700.0, 5350.0);
const PMMA: (f64, f64) = (1190.0, 2600.0);

fn rod((density, sound_speed): (f64, f64), length: f64, velocity: f64) -> RodSegment {
    RodSegment {
        length,
        density,
        sound_speed,
        velocity,
    }
}

fn onto(target: (f64, f64)) -> AcousticSolution {
    AcousticRods::new()
        .segment(rod(COPPER, 0.010, 20.0))
        .contact(Contact::Unilateral)
        .segment(rod(target, 0.040, 0.0))
        .solve(60e-6)
        .unwrap()
}

fn padded(pad: f64, until: f64) -> AcousticSolution {
    AcousticRods::new()
        .segment(rod(COPPER, 0.010, 20.0))
        .segment(rod(PMMA, pad, 20.0))
        .contact(Contact::Unilateral)
        .segment(rod(COPPER, 0.040, 0.0))
        .solve(until)
        .unwrap()
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{value} instead of {expected} within {tolerance}"
    );
}

fn opening(waves: &AcousticSolution, joint: Joint) -> f64 {
    waves.contact_intervals(joint).unwrap()[0].until.unwrap()
}

#[test]
fn plateaus_and_speeds_behind_the_contact() {
    let expected = [
        (COPPER, 351.842, 10.0, 0.0, 1.269),
        (STEEL, 311.989, 11.1327, 2.2654, 1.401),
        (ALUMINIUM, 204.813, 14.1788, 8.3577, 0.935),
        (PMMA, 56.878, 18.3834, 16.7668, 1.923),
    ];
    for (target, plateau, speed, rebound, arrival) in expected {
        let waves = onto(target);
        close(waves.stress(0.005, 2.5e-6).unwrap(), -plateau * 1e6, 1e3);
        close(waves.velocity(0.010, 1e-6).unwrap(), speed, 1e-4);
        close(waves.velocity(0.005, 5.08e-6).unwrap(), rebound, 1e-4);
        let inside = waves.history(0.015).unwrap();
        close(inside[1].time, arrival * 1e-6, 1e-9);
        close(inside[2].time - inside[1].time, 5.076e-6, 1e-9);
        let striker = waves.history(0.005).unwrap();
        close(striker[1].time, 1.269e-6, 1e-9);
        close(striker[2].time, 3.807e-6, 1e-9);
    }
}

#[test]
fn later_steps_in_striker_and_target() {
    for (target, step) in [(STEEL, -35.3e6), (ALUMINIUM, -85.6e6), (PMMA, -47.7e6)] {
        let waves = onto(target);
        close(waves.stress(0.005, 7e-6).unwrap(), step, 0.06e6);
        close(waves.stress(0.015, 8e-6).unwrap(), step, 0.06e6);
    }
}

#[test]
fn contact_opens_at_the_echo_of_the_far_end() {
    for (target, time) in [(COPPER, 20.305), (STEEL, 22.409), (ALUMINIUM, 14.953)] {
        close(opening(&onto(target), Joint::Between(0)), time * 1e-6, 1e-9);
    }
    // Sixty reverberations in the striker leave 57·0.838ⁿ MPa, so only the echo (30.77 µs) opens PMMA.
    let pmma = opening(&onto(PMMA), Joint::Between(0));
    assert!(pmma > 26e-6, "{pmma}");
    close(pmma, 30.769e-6, 1e-9);
}

#[test]
fn equal_rods_hand_the_pulse_over() {
    let waves = onto(COPPER);
    let pulse: Vec<Piece> = waves.snapshot(7.7e-6).unwrap();
    let loaded: Vec<&Piece> = pulse.iter().filter(|p| p.stress.abs() > 1.0).collect();
    close(loaded[0].from, 20.338e-3, 1e-6);
    close(loaded[loaded.len() - 1].to, 40.338e-3, 1e-6);
    assert!(loaded.iter().all(|p| (p.stress + 351.842e6).abs() < 1e3));
    let late = waves.snapshot(12.69035e-6).unwrap();
    let moving: f64 = late
        .iter()
        .filter(|p| p.velocity > 19.9)
        .map(|p| p.to - p.from)
        .sum();
    close(moving, 0.010, 1e-6);
    // Impact, unloading, opening; then the pulse only runs to and fro in the target.
    assert_eq!(waves.joints[1].iter().filter(|s| s.time < 25e-6).count(), 3);
}

#[test]
fn wall_turns_the_striker_round() {
    let waves = AcousticRods::new()
        .segment(rod(COPPER, 0.010, 20.0))
        .right_end(End::Wall)
        .solve(20e-6)
        .unwrap();
    close(waves.stress(0.005, 2e-6).unwrap(), -703.684e6, 1e3);
    close(opening(&waves, Joint::Right), 5.0761e-6, 1e-9);
    close(waves.velocity(0.003, 9e-6).unwrap(), -20.0, 1e-9);
    close(
        waves.impulse(Joint::Right, 20e-6).unwrap(),
        2.0 * 8930.0 * 0.010 * 20.0,
        1e-6,
    );
    let gap = waves
        .joint_history(Joint::Right)
        .unwrap()
        .last()
        .unwrap()
        .gap;
    close(gap, 0.0, 1e-15);
    close(
        waves.displacement(0.010, 10.0761e-6).unwrap(),
        -20.0 * 5e-6,
        1e-9,
    );
}

#[test]
fn pad_steps() {
    let half = padded(0.005, 10e-6);
    close(half.stress(0.005, 5e-6).unwrap(), -104.56e6, 0.005e6);
    close(half.stress(0.005, 9e-6).unwrap(), -161.15e6, 0.005e6);
    let steps = half.history(0.005).unwrap();
    let second = steps.iter().find(|s| s.stress < -161e6).unwrap();
    close(second.time, 8.268e-6, 0.001e-6);
    let whole = padded(0.010, 30e-6);
    close(whole.stress(0.005, 6e-6).unwrap(), -104.56e6, 0.005e6);
    let steps = whole.history(0.005).unwrap();
    assert!(steps.iter().any(|s| (s.stress + 87.7e6).abs() < 0.05e6));
    let spike = steps
        .iter()
        .find(|s| (s.time - 15.3e-6).abs() < 0.1e-6 && s.stress < -146e6);
    assert!(spike.is_some(), "{steps:?}");
    let double = padded(0.020, 30e-6);
    let steps = double.history(0.005).unwrap();
    for level in [-104.56e6, -87.7e6, -73.5e6, -135.1e6] {
        assert!(
            steps.iter().any(|s| (s.stress - level).abs() < 0.06e6),
            "{level}"
        );
    }
    let echo = steps.iter().find(|s| s.stress < -135e6).unwrap();
    close(echo.time, 24.3e-6, 0.1e-6);
}

#[test]
fn momentum_and_energy_are_exact() {
    for waves in [
        onto(PMMA),
        onto(ALUMINIUM),
        padded(0.0075, 40e-6),
        padded(0.005, 40e-6),
    ] {
        let (momentum, energy) = (waves.momentum(0.0).unwrap(), waves.energy(0.0).unwrap());
        for k in 1..=50 {
            let t = waves.until() * k as f64 / 50.0;
            close(waves.momentum(t).unwrap() / momentum, 1.0, 1e-9);
            close(waves.energy(t).unwrap() / energy, 1.0, 1e-9);
        }
    }
}

#[test]
fn gap_is_the_difference_of_displacements_and_closes_again() {
    // A light bar between a wall and a heavy one: its contacts open and close many times.
    let waves = AcousticRods::new()
        .segment(rod(PMMA, 0.010, 0.0))
        .contact(Contact::Unilateral)
        .segment(rod(COPPER, 0.013, -5.0))
        .left_end(End::Wall)
        .solve(200e-6)
        .unwrap();
    let intervals = waves.contact_intervals(Joint::Between(0)).unwrap();
    let wall = waves.contact_intervals(Joint::Left).unwrap();
    assert!(
        intervals.len() > 1 || wall.len() > 1,
        "{intervals:?} {wall:?}"
    );
    let energy = waves.energy(0.0).unwrap();
    close(waves.energy(200e-6).unwrap() / energy, 1.0, 1e-9);
    let impulse = waves.impulse(Joint::Left, 200e-6).unwrap();
    let change = waves.momentum(200e-6).unwrap() - waves.momentum(0.0).unwrap();
    close(impulse / change, 1.0, 1e-9);
    for state in waves.joint_history(Joint::Between(0)).unwrap() {
        let copper = waves.displacement(0.010, state.time).unwrap();
        let pmma = waves.displacement(0.010 - 1e-13, state.time).unwrap();
        close(copper - pmma, state.gap, 1e-12);
        assert!(state.gap >= 0.0 && state.stress <= 1e-3);
    }
}

#[test]
fn clamped_and_bonded_joints_pull() {
    let waves = AcousticRods::new()
        .segment(rod(STEEL, 0.02, 3.0))
        .left_end(End::Bonded)
        .solve(5e-6)
        .unwrap();
    close(waves.stress(0.0, 1e-6).unwrap(), 28.0245e6 * 3.0, 1.0);
    let glued = AcousticRods::new()
        .starting_at(-0.01)
        .segment(rod(STEEL, 0.01, -1.0))
        .segment(rod(STEEL, 0.01, 1.0))
        .solve(2e-6)
        .unwrap();
    close(glued.stress(0.0, 1e-6).unwrap(), 28.0245e6, 1.0);
}

#[test]
fn questions_outside_are_refused() {
    let waves = onto(COPPER);
    assert!(waves.stress(0.06, 1e-6).is_err());
    assert!(waves.stress(0.01, 1.0).is_err());
    assert!(waves.joint_history(Joint::Between(1)).is_err());
    assert!(AcousticRods::new().solve(1.0).is_err());
    assert!(
        AcousticRods::new()
            .segment(rod((0.0, 1.0), 1.0, 0.0))
            .solve(1.0)
            .is_err()
    );
}

#[test]
fn pads_leave_the_target() {
    for (pad, opened) in [(0.005, 0.0), (0.0075, 0.0), (0.010, 0.0), (0.020, 0.0)] {
        let waves = padded(pad, 60e-6);
        println!(
            "{pad} {:?} {opened}",
            waves.contact_intervals(Joint::Between(1)).unwrap()
        );
    }
}

fn end() -> impl Strategy<Value = End> {
    prop_oneof![Just(End::Free), Just(End::Wall), Just(End::Bonded)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    #[test]
    fn any_chain_conserves_and_no_contact_pulls(
        parts in prop::collection::vec(
            (0usize..4, 1u32..8, -20.0..20.0f64, any::<bool>()), 1..5),
        left in end(),
        right in end(),
    ) {
        let mut rods = AcousticRods::new().left_end(left).right_end(right);
        for &(material, length, velocity, bonded) in &parts {
            let material = [COPPER, STEEL, ALUMINIUM, PMMA][material];
            rods = rods.segment(rod(material, 0.002 * f64::from(length), velocity));
            rods = rods.contact(if bonded { Contact::Bonded } else { Contact::Unilateral });
        }
        let until = 12e-6;
        let waves = rods.solve(until).unwrap();
        let energy = waves.energy(0.0).unwrap();
        prop_assert!((waves.energy(until).unwrap() / energy - 1.0).abs() < 1e-8);
        let change = waves.momentum(until).unwrap() - waves.momentum(0.0).unwrap();
        let ends = waves.impulse(Joint::Left, until).unwrap()
            - waves.impulse(Joint::Right, until).unwrap();
        prop_assert!((change - ends).abs() < 1e-8 * (energy * 1e4).sqrt());
        for (k, part) in parts[1..].iter().zip(&parts).map(|pair| pair.1).enumerate() {
            let states = waves.joint_history(Joint::Between(k)).unwrap();
            prop_assert!(states.iter().all(|s| s.gap >= -1e-18));
            if !part.3 {
                prop_assert!(states.iter().all(|s| s.stress <= 1.0));
            }
        }
    }
}
