//! Checks of the Riemann solver: Toro's five tests, vacuum, stiffened gases and the jump conditions.
//! Star values of the tests are those of Toro (2009), Table 4.3, to the digits printed there.

use super::*;
use proptest::prelude::*;

fn state(density: f64, velocity: f64, pressure: f64) -> GasState {
    GasState {
        density,
        velocity,
        pressure,
    }
}

fn near(value: f64, expected: f64, relative: f64) {
    assert!(
        (value - expected).abs() <= relative * expected.abs().max(1e-12),
        "{value} instead of {expected}"
    );
}

#[test]
fn tests_of_toro() {
    let air = Gas::ideal(1.4);
    let cases = [
        (
            state(1.0, 0.0, 1.0),
            state(0.125, 0.0, 0.1),
            0.30313,
            0.92745,
            0.42632,
            0.26557,
        ),
        (
            state(1.0, -2.0, 0.4),
            state(1.0, 2.0, 0.4),
            0.00189,
            0.0,
            0.02185,
            0.02185,
        ),
        (
            state(1.0, 0.0, 1000.0),
            state(1.0, 0.0, 0.01),
            460.894,
            19.5975,
            0.57506,
            5.99924,
        ),
        (
            state(1.0, 0.0, 0.01),
            state(1.0, 0.0, 100.0),
            46.0950,
            -6.19633,
            5.99242,
            0.57511,
        ),
        (
            state(5.99924, 19.5975, 460.894),
            state(5.99242, -6.19633, 46.0950),
            1691.64,
            8.68975,
            14.2823,
            31.0426,
        ),
    ];
    for (left, right, p, u, left_density, right_density) in cases {
        let tube = RiemannProblem::new(air, left, air, right).unwrap();
        near(tube.star_pressure(), p, 3e-3);
        assert!((tube.star_velocity().unwrap() - u).abs() < 1e-4);
        near(tube.star_densities().0, left_density, 1e-3);
        near(tube.star_densities().1, right_density, 1e-3);
    }
}

#[test]
fn a_vacuum_opens_when_the_gases_part_fast_enough() {
    let air = Gas::ideal(1.4);
    let part =
        |u: f64| RiemannProblem::new(air, state(1.0, -u, 0.4), air, state(1.0, u, 0.4)).unwrap();
    let escape = 5.0 * (1.4f64 * 0.4).sqrt();
    assert!(part(0.99 * escape).star_velocity().is_some());
    let open = part(1.01 * escape);
    assert!(open.star_velocity().is_none());
    assert_eq!(open.sample(0.0).density, 0.0);
    assert!(open.sample(-2.0 * escape).density > 0.0);
    let burst = RiemannProblem::new(air, state(1.0, 0.0, 1.0), air, state(0.0, 0.0, 0.0)).unwrap();
    let a = 1.4f64.sqrt();
    near(burst.sample(0.0).density, (5.0f64 / 6.0).powi(5), 1e-12);
    assert_eq!(burst.sample(5.01 * a).density, 0.0);
    assert!(burst.sample(4.9 * a).density > 0.0);
    let mirrored =
        RiemannProblem::new(air, state(0.0, 0.0, 0.0), air, state(1.0, 0.0, 1.0)).unwrap();
    near(
        mirrored.sample(0.3).density,
        burst.sample(-0.3).density,
        1e-14,
    );
    near(
        mirrored.sample(0.3).velocity,
        -burst.sample(-0.3).velocity,
        1e-14,
    );
}

#[test]
fn jump_conditions_hold_in_stiffened_gases() {
    let water = Gas {
        gamma: 4.4,
        stiffness: 6e8,
    };
    let air = Gas::ideal(1.4);
    let left = state(1000.0, 0.0, 1e9);
    let right = state(50.0, 0.0, 1e5);
    let tube = RiemannProblem::new(water, left, air, right).unwrap();
    let Wave::Shock { speed } = tube.right_wave() else {
        panic!("no shock");
    };
    let (ahead, behind) = (right, tube.sample(0.999 * speed));
    let mass = |s: &GasState| s.density * (s.velocity - speed);
    let momentum = |s: &GasState| mass(s) * s.velocity + s.pressure;
    let energy = |s: &GasState, gas: &Gas| {
        let total = s.density * (gas.energy(s) + 0.5 * s.velocity.powi(2));
        total * (s.velocity - speed) + s.pressure * s.velocity
    };
    near(mass(&behind), mass(&ahead), 1e-12);
    near(momentum(&behind), momentum(&ahead), 1e-10);
    near(energy(&behind, &air), energy(&ahead, &air), 1e-10);
    let Wave::Rarefaction { head, tail } = tube.left_wave() else {
        panic!("no rarefaction");
    };
    let inside = tube.sample(0.5 * (head + tail));
    let entropy = |s: &GasState| (s.pressure + 6e8) / s.density.powf(4.4);
    near(entropy(&inside), entropy(&left), 1e-12);
    near(
        inside.velocity - water.sound_speed(&inside),
        0.5 * (head + tail),
        1e-12,
    );
    near(
        tube.sample(tail + 1e-9).pressure,
        tube.star_pressure(),
        1e-9,
    );
}

#[test]
fn weak_waves_are_acoustic_and_equal_states_stay() {
    let water = Gas {
        gamma: 7.0,
        stiffness: 3e8,
    };
    let (left, right) = (state(1000.0, 0.1, 1e5), state(1000.0, -0.1, 1e5));
    let pulse = RiemannProblem::new(water, left, water, right).unwrap();
    let rise = 1000.0 * water.sound_speed(&left) * 0.1;
    near(pulse.star_pressure() - 1e5, rise, 1e-3);
    let rest = RiemannProblem::new(water, left, water, left).unwrap();
    near(rest.star_pressure(), 1e5, 1e-9);
    near(rest.sample(0.0).velocity, 0.1, 1e-9);
    assert!(RiemannProblem::new(Gas::ideal(1.0), left, water, right).is_err());
    assert!(RiemannProblem::new(water, state(1.0, 0.0, -4e8), water, right).is_err());
}

#[test]
fn a_void_between_unlike_gases_is_refused() {
    let water = Gas {
        gamma: 7.0,
        stiffness: 3e8,
    };
    let air = Gas::ideal(1.4);
    let part =
        |u: f64| RiemannProblem::new(water, state(1000.0, 0.0, 1e5), air, state(1.2, u, 1e5));
    assert!(part(100.0).is_ok() && part(2000.0).is_err() && part(1e4).is_err());
}

fn any_state() -> impl Strategy<Value = GasState> {
    (-3.0..3.0f64, -2.0..2.0f64, -3.0..3.0f64)
        .prop_map(|(d, u, p)| state(10f64.powf(d), u, 10f64.powf(p)))
}

proptest! {
    /// Both waves of any two states lead to one pressure and velocity, and mirroring changes nothing.
    #[test]
    fn star_states_agree(left in any_state(), right in any_state(), g in 1.05..4.0f64) {
        let gas = Gas::ideal(g);
        let tube = RiemannProblem::new(gas, left, gas, right).unwrap();
        let turn = |s: GasState| state(s.density, -s.velocity, s.pressure);
        let mirror = RiemannProblem::new(gas, turn(right), gas, turn(left)).unwrap();
        if let Some(u) = tube.star_velocity() {
            let speed = tube.left.sound_speed + tube.right.sound_speed;
            prop_assert!((u + mirror.star_velocity().unwrap()).abs() < 1e-9 * speed);
            let p = tube.star_pressure();
            prop_assert!(p > 0.0);
            let from_left = left.velocity - tube.left.jump(p).0;
            let from_right = right.velocity + tube.right.jump(p).0;
            prop_assert!((from_left - from_right).abs() < 1e-9 * speed, "{} {}", from_left, from_right);
        } else {
            prop_assert!(mirror.star_velocity().is_none());
        }
    }
}
