//! Tests that every law of the list passes, and the numbers of each law.
//! The sound speed is compared with differences of the pressure itself.

use super::*;
use crate::for_each_eos;
use crate::scalar::{Lanes, Real};
use approx::assert_relative_eq;
use proptest::prelude::*;

/// c² from central differences of p(ρ, e), or nothing where p has a kink nearby.
fn squared_by_differences<E: EquationOfState>(law: &E, density: f64, energy: f64) -> Option<f64> {
    let p = |rho: f64, e: f64| law.state(rho, e).pressure;
    let scale = law.state(density, energy).sound_speed.powi(2);
    let derivative = |f: &dyn Fn(f64) -> f64, step: f64, weight: f64| {
        let (forward, backward) = ((f(step) - f(0.0)) / step, (f(0.0) - f(-step)) / step);
        let smooth = weight * (forward - backward).abs() < 1e-3 * scale;
        smooth.then_some(0.5 * (forward + backward))
    };
    let by_density = derivative(&|d| p(density + d, energy), 1e-5 * density, 1.0)?;
    let weight = p(density, energy) / (density * density);
    let by_energy = derivative(&|d| p(density, energy + d), 1e2, weight.abs())?;
    Some(by_density + weight * by_energy)
}

/// Whether the state was one to compare: no guard acted and no kink is near.
fn sound_speed_is_the_derivative<E: EquationOfState>(law: &E, ratio: f64, energy: f64) -> bool {
    let density = ratio * law.reference_density();
    let state = law.state(density, energy);
    let unguarded = !(state.guards.compression || state.guards.expansion || state.guards.cut_off);
    let Some(squared) = squared_by_differences(law, density, energy).filter(|_| unguarded) else {
        return false;
    };
    let error = state.sound_speed.powi(2) / squared - 1.0;
    assert!(error.abs() < 1e-4, "{law:?} at {ratio}, {energy}: {error}");
    true
}

fn is_finite<T: Real, E: EquationOfState>(law: &E, density: f64, energy: f64) {
    let (rho, e) = (T::from_f64(density), T::from_f64(energy));
    let state = law.state(rho, e);
    let (p, c) = (state.pressure.to_f64(), state.sound_speed.to_f64());
    assert!(
        p.is_finite() && c.is_finite() && c > 0.0,
        "{law:?} at {density}, {energy}: p {p}, c {c}"
    );
}

fn lanes_equal_scalars<E: EquationOfState>(law: &E, ratio: f64, energy: f64) {
    let rest = law.reference_density();
    let rho = |k: usize| rest * (ratio + 0.13 * k as f64);
    let row = law.state(
        Lanes::<f64, 8, false>::from_fn(rho),
        Lanes::<f64, 8, false>::splat(energy),
    );
    for k in 0..8 {
        let one = law.state(rho(k), energy);
        assert_eq!(row.pressure.extract(k), one.pressure);
        assert_eq!(row.sound_speed.extract(k), one.sound_speed);
        assert_eq!(row.guards.compression.test(k), one.guards.compression);
        assert_eq!(row.guards.expansion.test(k), one.guards.expansion);
        assert_eq!(row.guards.cut_off.test(k), one.guards.cut_off);
    }
}

macro_rules! tests_of_all {
    ($($name:ident: $law:expr);*) => { $(
        mod $name {
            use super::*;
            proptest! {
                #![proptest_config(ProptestConfig::with_cases(400))]
                #[test]
                fn sound_speed(ratio in 0.6..1.7f64, energy in 1e3..2e7f64) {
                    sound_speed_is_the_derivative(&$law, ratio, energy);
                    sound_speed_is_the_derivative(&$law, ratio, 1e-2 * energy + 1e3);
                }
                #[test]
                fn finite(logarithm in -12.0..6.0f64, energy in -3.0..12.0f64, sign: bool) {
                    let law = $law;
                    let density = 10f64.powf(logarithm) * law.reference_density();
                    let energy = 10f64.powf(energy) * if sign { 1.0 } else { -1.0 };
                    for density in [density, -density, 0.0, law.reference_density()] {
                        for energy in [energy, 0.0] {
                            is_finite::<f32, _>(&law, density, energy);
                            is_finite::<f64, _>(&law, density, energy);
                        }
                    }
                }
                #[test]
                fn lanes(ratio in 0.3..3.0f64, energy in -1e6..2e7f64) {
                    lanes_equal_scalars(&$law, ratio, energy);
                }
            }
            /// So the comparison above is not an empty one.
            #[test]
            fn most_states_are_compared() {
                let grid = (0..400).map(|k| (0.8 + 0.04 * f64::from(k % 20), 1e3 + 5e4 * f64::from(k / 20)));
                let compared = grid.filter(|&(ratio, e)| sound_speed_is_the_derivative(&$law, ratio, e));
                assert!(compared.count() >= 200);
            }
            #[test]
            fn constants_are_sound() {
                let law = $law;
                assert_eq!(law.problems(), []);
                assert!(law.reference_density() > 0.0 && !law.name().is_empty());
            }
        }
    )* };
}
for_each_eos!(tests_of_all);

fn metals() -> [(&'static str, f64, [f64; 5]); 5] {
    // S and the errors of the cubic at 1, 5, 10, 20, 30 %.
    [
        ("copper", 1.49, [1e-6, 1e-4, -0.11e-2, -0.74e-2, -2.2e-2]),
        ("aluminium", 1.34, [5e-7, 6e-5, -0.04e-2, -0.32e-2, -1.0e-2]),
        ("PMMA", 1.52, [1e-6, 2e-4, -0.12e-2, -0.85e-2, -2.5e-2]),
        ("steel", 1.92, [6e-6, 7e-4, -0.48e-2, -3.3e-2, -9.4e-2]),
        ("water", 1.75, [5e-6, 5e-4, -0.3e-2, -2.0e-2, -6e-2]),
    ]
}

#[test]
fn cubic_is_the_third_order_expansion() {
    for (name, s, errors) in metals() {
        let full = MieGruneisen::new(1000.0, 1000.0, s, 0.0);
        let cubic = full.with_form(Hugoniot::LamCubic);
        for (eta, stated) in [0.01, 0.05, 0.1, 0.2, 0.3].into_iter().zip(errors) {
            let error = cubic.hugoniot_pressure(eta) / full.hugoniot_pressure(eta) - 1.0;
            let room = if eta < 0.08 { 0.7 } else { 0.15 };
            assert!(
                (error.abs() / stated.abs() - 1.0).abs() < room,
                "{name} at {eta}: {error} against {stated}"
            );
        }
        // Fourth order: a tenth of the compression has a thousandth of the relative error.
        let error = |eta: f64| cubic.hugoniot_pressure(eta) / full.hugoniot_pressure(eta) - 1.0;
        let order = (error(2e-2) / error(1e-2)).log2();
        assert!((order - 3.0).abs() < 0.1, "{name}: {order}");
    }
}

#[test]
fn poles_of_the_hugoniot() {
    for (s, pole) in [(1.49, 2.04), (1.34, 2.94), (1.52, 1.92), (1.92, 1.09)] {
        let law = MieGruneisen::new(8930.0, 3940.0, s, 0.5);
        assert!((law.pole() - pole).abs() < 0.01);
        let same = law.with_form(Hugoniot::LsDyna {
            s2: 0.0,
            s3: 0.0,
            a: 0.5,
        });
        assert!((same.pole() - law.pole()).abs() < 1e-9);
        assert!(law.compression_limit() <= 0.8 * law.pole() + 1e-9);
    }
}

/// S₂ = S₃ = 0 and a = γ₀ give the full Hugoniot back in compression.
#[test]
fn ls_dyna_equals_full() {
    let full = MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02);
    let dyna = full.with_form(Hugoniot::LsDyna {
        s2: 0.0,
        s3: 0.0,
        a: 2.02,
    });
    for k in 0..30 {
        let density = 8930.0 * (1.0 + 0.02 * f64::from(k));
        let (one, other) = (full.state(density, 3e5), dyna.state(density, 3e5));
        assert!((one.pressure - other.pressure).abs() < 1e-12 * one.pressure);
        assert!((one.sound_speed - other.sound_speed).abs() < 1e-9);
    }
}

/// On the Hugoniot itself e = p_H η/(2ρ), and the law must return p_H.
#[test]
fn full_returns_its_hugoniot() {
    let law = MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02);
    for eta in [0.01, 0.1, 0.3, 0.6] {
        let (density, p) = (8930.0 * (1.0 + eta), law.hugoniot_pressure(eta));
        let state = law.state(density, 0.5 * p * eta / density);
        assert_relative_eq!(state.pressure, p, epsilon = 0.0, max_relative = 1e-12);
    }
}

/// The sound speed of the cubic in closed form, as its page states it.
#[test]
fn cubic_sound_speed_in_closed_form() {
    let (rho0, c0, s, gamma) = (8930.0, 3940.0, 1.49, 2.02);
    let law = MieGruneisen::new(rho0, c0, s, gamma).with_form(Hugoniot::LamCubic);
    let (k, a0) = (s - 1.0, rho0 * c0 * c0);
    let (b0, d0) = (a0 * (1.0 + 2.0 * k), a0 * (2.0 * k + 3.0 * k * k));
    for (eta, e) in [(0.0025, 50.0), (0.1, 1e5), (0.4, 1e6), (-0.02, 1e4)] {
        let rho: f64 = rho0 * (1.0 + eta);
        let curve = a0 * eta + b0 * eta * eta + d0 * eta.powi(3);
        let slope = a0 + 2.0 * b0 * eta + 3.0 * d0 * eta * eta;
        let p = (1.0 - 0.5 * gamma * eta) * curve + gamma * rho * e;
        let squared = ((1.0 - 0.5 * gamma * eta) * slope - 0.5 * gamma * curve) / rho0
            + gamma * e
            + gamma * p / rho;
        let state = law.state(rho, e);
        assert_relative_eq!(state.pressure, p, epsilon = 0.0, max_relative = 1e-12);
        assert_relative_eq!(
            state.sound_speed,
            squared.sqrt(),
            epsilon = 0.0,
            max_relative = 1e-12
        );
    }
}

/// p and c meet from both sides at ρ₀ and at the limits of compression.
#[test]
fn branches_join() {
    fn joins<E: EquationOfState>(law: &E, density: f64, energy: f64) {
        let (below, above) = (density * (1.0 - 1e-10), density * (1.0 + 1e-10));
        let (low, high) = (law.state(below, energy), law.state(above, energy));
        let impedance = density * high.sound_speed.powi(2);
        assert!(
            (low.pressure - high.pressure).abs() < 1e-8 * impedance,
            "{law:?}"
        );
        assert!(
            (low.sound_speed / high.sound_speed - 1.0).abs() < 1e-8,
            "{law:?}"
        );
    }
    let full = MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02);
    let dyna = Hugoniot::LsDyna {
        s2: 0.1,
        s3: -0.05,
        a: 0.47,
    };
    for form in [Hugoniot::LamCubic, Hugoniot::Full, dyna] {
        let law = full.with_form(form);
        joins(&law, 8930.0, 2e5);
        // Behind a shock of that strength; far below its energy the tangent is held at ρ₀C₀²/2.
        let eta = law.compression_limit();
        let density = 8930.0 * (1.0 + eta);
        joins(
            &law,
            density,
            0.5 * law.hugoniot_pressure(eta) * eta / density,
        );
    }
    joins(&Tait::new(1000.0, 1480.0), 2000.0, 0.0);
    joins(&Murnaghan::new(8930.0, 137e9, 4.5), 2.0 * 8930.0, 0.0);
    joins(&Jwl::tnt(), 1630.0 / 0.3, 1e7);
    joins(&Tillotson::aluminium(), 2700.0, 2e6);
    joins(&Tillotson::aluminium(), 2700.0, 8e6);
    joins(&Tillotson::aluminium(), 2700.0, 2e7);
}

/// In energy Tillotson's pressure is continuous where the blend begins and ends.
#[test]
fn tillotson_is_continuous_in_energy() {
    let law = Tillotson::aluminium();
    for ratio in [0.3, 0.6, 0.9, 1.2] {
        for energy in [law.incipient_vaporisation, law.complete_vaporisation] {
            let p = |e: f64| law.state(ratio * 2700.0, e).pressure;
            let jump = p(energy * (1.0 + 1e-9)) - p(energy * (1.0 - 1e-9));
            assert!(jump.abs() < 1e4, "{jump}");
        }
    }
    // Compressed and cold: A μ + B μ².
    let p = law.state(2970.0, 0.0).pressure;
    assert!((p - (75.2e9 * 0.1 + 65e9 * 0.01)).abs() < 1.0);
    // Thin and hot: an ideal gas with γ − 1 = a.
    let p = law.state(0.27, 5e7).pressure;
    assert_relative_eq!(p, 0.5 * 0.27 * 5e7, epsilon = 0.0, max_relative = 1e-6);
}

#[test]
fn guards_are_counted() {
    let copper = MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02);
    assert!(copper.state::<f64>(8930.0 * 2.5, 0.0).guards.compression);
    assert!(copper.state::<f64>(8930.0 * 0.5, 0.0).guards.expansion);
    let none = copper.state::<f64>(8930.0 * 1.3, 1e6).guards;
    assert!(!(none.compression || none.expansion || none.cut_off));
    let cut = TensionCutOff::new(copper, -1e9).state::<f64>(8930.0 * 0.9, 0.0);
    assert!(cut.guards.cut_off && cut.pressure == -1e9);
    assert!(
        IdealGas::new(1.4, 1.0)
            .state::<f64>(1.0, -5.0)
            .guards
            .expansion
    );
    assert!(
        StiffenedGas::water()
            .state::<f64>(500.0, 0.0)
            .guards
            .expansion
    );
    assert!(
        Tait::new(1000.0, 10.0)
            .state::<f64>(2100.0, 0.0)
            .guards
            .compression
    );
    assert!(
        Tait::new(1000.0, 10.0)
            .state::<f64>(100.0, 0.0)
            .guards
            .expansion
    );
    assert!(
        Tillotson::aluminium()
            .state::<f64>(2700.0, -1.0)
            .guards
            .expansion
    );
    assert!(Jwl::tnt().state::<f64>(6000.0, 0.0).guards.compression);

    let mut counts = GuardCounts::default();
    let row = Lanes::<f64, 8, false>::from_fn(|k| 8930.0 * (0.5 + 0.5 * k as f64));
    counts.record(&copper.state(row, Lanes::of(0.0)).guards);
    // Ratios 0.5, 1, 1.5, … 4: one too thin; those from 2 on beyond the limit.
    assert_eq!((counts.expansion, counts.compression), (1, 5));
    counts += counts;
    assert_eq!(counts.total(), 12);
}

#[test]
fn gases_in_closed_form() {
    let air = IdealGas::new(1.4, 1.2);
    let state = air.state(1.2, air.energy(1e5, 1.2));
    assert!((state.pressure - 1e5).abs() < 1e-9);
    assert!((state.sound_speed - (1.4 * 1e5 / 1.2f64).sqrt()).abs() < 1e-10);

    // The usual form of the stiffened gas, with its own zero of energy.
    let (gamma, p_inf, law) = (4.4, 6e8, StiffenedGas::water());
    let (rho, e) = (1080.0, 3e5);
    let usual =
        (gamma - 1.0) * rho * (e + gamma * p_inf / ((gamma - 1.0) * 1000.0)) - gamma * p_inf;
    let state = law.state(rho, e);
    assert_relative_eq!(state.pressure, usual, epsilon = 0.0, max_relative = 1e-12);
    assert_relative_eq!(
        state.sound_speed.powi(2),
        gamma * (usual + p_inf) / rho,
        epsilon = 0.0,
        max_relative = 1e-12
    );
    assert_eq!(law.state(1000.0, 0.0).pressure, 0.0);

    let gas = Polynomial::new(1.2, [0.0, 0.0, 0.0, 0.0, 0.4, 0.4, 0.0]);
    let (one, other) = (gas.state(4.0, 3e5), air.state(4.0, 3e5));
    assert_relative_eq!(
        one.pressure,
        other.pressure,
        epsilon = 0.0,
        max_relative = 1e-12
    );
    assert_relative_eq!(
        one.sound_speed,
        other.sound_speed,
        epsilon = 0.0,
        max_relative = 1e-12
    );
}

/// A compression of 10⁻⁵ keeps its digits in `f32`.
#[test]
fn small_compressions_in_single_precision() {
    let rho = 8930.0f32 + 0.0893;
    let eta = (f64::from(rho) - 8930.0) / 8930.0;
    let p = MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02)
        .state(rho, 0.0)
        .pressure;
    let exact = MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02)
        .state(f64::from(rho), 0.0)
        .pressure;
    assert!((f64::from(p) / exact - 1.0).abs() < 5e-7 && eta > 9e-6);
    for gamma in [7.0, 7.15] {
        let law = Tait::new(1000.0, 1480.0).with_gamma(gamma);
        let (p, exact) = (
            law.state(1000.01f32, 0.0),
            law.state(f64::from(1000.01f32), 0.0),
        );
        assert_relative_eq!(
            f64::from(p.pressure),
            exact.pressure,
            epsilon = 0.0,
            max_relative = 5e-7
        );
    }
}

#[test]
fn power_laws_agree() {
    for ratio in [0.9, 0.99, 1.0, 1.01, 1.3] {
        let tait = Tait::new(1000.0, 1480.0).state(1000.0 * ratio, 0.0);
        let plain = 1000.0 * 1480.0 * 1480.0 / 7.0 * (f64::powi(ratio, 7) - 1.0);
        assert!((tait.pressure - plain).abs() < 1e-3 + 1e-12 * plain.abs());
        assert!((tait.sound_speed - 1480.0 * f64::powi(ratio, 3)).abs() < 1e-9);
        let murnaghan = Murnaghan::new(1000.0, 1000.0 * 1480.0 * 1480.0, 7.0);
        let same = murnaghan.state(1000.0 * ratio, 0.0);
        assert!((same.pressure - tait.pressure).abs() < 1e-3);
    }
}

/// The Chapman–Jouguet state of TNT follows from the law: the slowest detonation has
/// D = 6930 m/s and p = 21 GPa (Dobratz & Crawford 1985).
#[test]
fn tnt_detonates_at_its_measured_speed() {
    let tnt = Jwl::tnt();
    let (mut slowest, mut pressure) = (f64::MAX, 0.0);
    for k in 0..4000 {
        let volume = 0.6 + 0.0001 * f64::from(k);
        if volume > 0.95 {
            break;
        }
        // p on the Hugoniot of the products: e = e₀ + p (1 − V)/(2ρ₀), p linear in e.
        let rho = tnt.reference_density / volume;
        let at = |e: f64| tnt.state(rho, e).pressure;
        let cold = at(tnt.detonation_energy);
        let p = cold / (1.0 - tnt.omega * rho * 0.5 * (1.0 - volume) / tnt.reference_density);
        let speed = (p / (tnt.reference_density * (1.0 - volume))).sqrt();
        if speed < slowest {
            (slowest, pressure) = (speed, p);
        }
    }
    assert_relative_eq!(slowest, 6930.0, epsilon = 0.0, max_relative = 5e-3);
    assert_relative_eq!(pressure, 21e9, epsilon = 0.0, max_relative = 1e-2);
}

/// ∫ p/ρ² dρ by Simpson's rule on the law's own pressure, whose error is of the fourth order in the step.
fn work_of_compression<T: Real>(material: &crate::material::Material<T>, density: f64) -> f64 {
    // So many that a kink, as of a cut-off, is within one ten-thousandth of a per cent.
    let (rest, cells) = (material.reference_density(), 200_000);
    let step = (density - rest) / f64::from(2 * cells);
    let at = |k: u32| {
        let rho = rest + step * f64::from(k);
        material.state(rho, 0.0).0 / (rho * rho)
    };
    let cell = |k: u32| at(2 * k) + 4.0 * at(2 * k + 1) + at(2 * k + 2);
    step / 3.0 * (0..cells).map(cell).sum::<f64>()
}

#[test]
fn stored_energies_are_the_work_of_the_pressure() {
    use crate::material::Material;
    let cut = |material: Material<f64>| material.with_pressure_cut_off(-1e5);
    let water = Material::<f64>::new("water", Tait::new(1000.0, 1480.0));
    let rigid = Material::new("copper", Murnaghan::new(8930.0, 137e9, 5.0));
    let slow = Material::new("one", Tait::new(1000.0, 30.0).with_gamma(1.0));
    let fraction = Material::new("fraction", Tait::new(1000.0, 30.0).with_gamma(7.15));
    let linear = Material::new("linear", Linear::new(1000.0, 20.0));
    let wrapped = Material::new(
        "wrapped",
        TensionCutOff::new(Tait::new(1000.0, 1480.0), -1e5),
    );
    let cases = [
        water.clone(),
        cut(water),
        cut(linear.clone()),
        linear,
        rigid,
        slow,
        fraction,
        wrapped,
    ];
    for material in cases {
        let stored = |ratio: f64| {
            let density = ratio * material.reference_density();
            material.eos().stored_energy(density, 0.0).unwrap()
        };
        assert_eq!(stored(1.0), 0.0, "{}", material.name);
        // Beyond twice the density at rest the power laws have no closed form, and are summed.
        for ratio in [0.5, 0.9, 0.999, 1.001, 1.1, 1.9, 2.5] {
            let density = ratio * material.reference_density();
            let (closed, sum) = (stored(ratio), work_of_compression(&material, density));
            let off = (closed / sum - 1.0).abs();
            assert!(off < 1e-7, "{} at {ratio}: {closed} {sum}", material.name);
        }
        // ½ c² ε² to the first order, without rounding.
        let (_, c) = material.state(material.reference_density(), 0.0);
        let off = stored(1.0 + 1e-6) / (0.5e-12 * c * c) - 1.0;
        assert!(off.abs() < 1e-4, "{}: {off}", material.name);
    }
}

#[test]
fn what_depends_on_energy_is_not_said_to_be_stored() {
    use crate::material::Material;
    let gas = Material::<f64>::new("gas", IdealGas::new(1.4, 1.0));
    assert_eq!(gas.eos().stored_energy(2.0, 3.0), Some(3.0));
    let copper = Material::<f64>::new("copper", MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02));
    assert_eq!(copper.eos().stored_energy(9000.0, 0.0), None);
    let cut = copper.with_pressure_cut_off(-1e9);
    assert_eq!(cut.eos().stored_energy(8000.0, 0.0), None);
}
