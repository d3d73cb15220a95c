//! A law at given energy, run backwards: density from pressure, and energy from density.
//! Both work from the state alone, so they serve every equation of state.

use crate::scalar::Lane;

/// The first step \[1\] of ln(ρ/ρ₀) away from rest; each next one is twice as large.
const FIRST_STEP: f64 = 0.01;
/// Steps away from rest: the last lies at ρ/ρ₀ = exp(±10.24).
const STEPS: u32 = 11;
/// Halvings of an interval of the integral; a kink of the law is then 10⁻⁹ of the interval wide.
const HALVINGS: u32 = 30;
/// Relative error of the integral at which halving stops.
const TOLERANCE: f64 = 1e-12;

/// Density \[kg/m³\] at which `law`, a function of density that returns pressure \[Pa\] and sound
/// speed \[m/s\], gives the pressure: the root next to `rest` \[kg/m³\] on the side where the pressure
/// lies, to rounding; nothing if the law does not reach that pressure.
///
/// Newton's method with dp/dρ = c² inside a bracket, with a bisection wherever it does not halve the
/// error: c² is the slope at constant entropy, so for a law with energy it is not quite the right one.
pub(super) fn density_at(law: impl Fn(f64) -> (f64, f64), rest: f64, pressure: f64) -> Option<f64> {
    let (p, c) = law(rest);
    let at_rest = p - pressure;
    if at_rest == 0.0 {
        return Some(rest);
    }
    if !at_rest.is_finite() {
        return None;
    }
    let beyond = |residual: f64| residual * at_rest.signum() <= 0.0;
    let mut near = rest;
    let mut far = (0..STEPS).find_map(|k| {
        let step = FIRST_STEP * f64::from(1 << k);
        let density = rest * Lane::exp(-step.copysign(at_rest));
        if beyond(law(density).0 - pressure) {
            return Some(density);
        }
        near = density;
        None
    })?;
    let guess = rest - at_rest / (c * c);
    let mut density = if (guess - near) * (guess - far) < 0.0 {
        guess
    } else {
        0.5 * (near + far)
    };
    let mut last = f64::INFINITY;
    // Every second step at least is a bisection, so the bracket closes long before the end.
    for _ in 0..200 {
        let (p, c) = law(density);
        let residual = p - pressure;
        let newton = density - residual / (c * c);
        if (newton - density).abs() <= f64::EPSILON * density {
            break;
        }
        *(if beyond(residual) {
            &mut far
        } else {
            &mut near
        }) = density;
        let inside = (newton - near) * (newton - far) < 0.0;
        let next = if inside && 2.0 * residual.abs() <= last {
            newton
        } else {
            0.5 * (near + far)
        };
        if (near - far).abs() <= f64::EPSILON * density {
            break;
        }
        last = residual.abs();
        density = next;
    }
    Some(density)
}

/// ∫ p/ρ² dρ \[J/kg\] from `rest` to `density` \[kg/m³\] for a `law` as above, by Gauss–Lobatto sums of
/// five points on intervals that are halved until the sums agree.
pub(super) fn compression_energy(law: impl Fn(f64) -> (f64, f64), rest: f64, density: f64) -> f64 {
    let integrand = |rho: f64| law(rho).0 / (rho * rho);
    let scale = gauss_lobatto(&|rho| integrand(rho).abs(), rest, density).abs();
    // Near rest the pressure has the rounding of the density, and sums cannot agree to more digits.
    let c = law(rest).1.max(law(density).1);
    let rounding = 4.0 * f64::EPSILON * c * c * ((density - rest) / rest.min(density)).abs();
    let tolerance = TOLERANCE * scale + rounding;
    halved(&integrand, (rest, density), tolerance, HALVINGS)
}

/// The integral over an interval, which is halved where its halves do not add up to the whole.
fn halved(f: &impl Fn(f64) -> f64, (from, to): (f64, f64), tolerance: f64, halvings: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let halves = gauss_lobatto(f, from, middle) + gauss_lobatto(f, middle, to);
    let error = (halves - gauss_lobatto(f, from, to)).abs();
    // False where the law gives no number, so that is not halved to the end.
    if halvings > 0 && error > tolerance {
        halved(f, (from, middle), tolerance, halvings - 1)
            + halved(f, (middle, to), tolerance, halvings - 1)
    } else {
        halves
    }
}

/// Exact for polynomials of degree seven. Lobatto's points take in both ends, and so see a law that is
/// flat from close to rest on, which points inside an interval miss.
fn gauss_lobatto(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let inner = half * (3.0_f64 / 7.0).sqrt();
    let ends = 0.1 * (f(from) + f(to));
    let inside = 49.0 / 90.0 * (f(middle - inner) + f(middle + inner));
    half * (ends + inside + 32.0 / 45.0 * f(middle))
}

#[cfg(test)]
mod tests {
    use crate::for_each_eos;
    use crate::material::Material;
    use crate::material::eos::{EquationOfState, Linear, Tait, TensionCutOff};

    /// p(ρ(p)) = p to the rounding of ρ, for states of every law on either side of rest.
    fn there_and_back(law: impl EquationOfState) {
        let material = Material::<f64>::new("any", law);
        let rest = material.reference_density();
        let mut found = 0;
        for k in 0..60 {
            let (ratio, energy) = (0.93 + 0.02 * f64::from(k % 20), 2e5 * f64::from(k / 20));
            let (pressure, _) = material.state(ratio * rest, energy);
            let density = material.eos().density_at(pressure, energy);
            let density = density.expect("the law has just given this pressure");
            let (again, c) = material.state(density, energy);
            let rounding = 4.0 * f64::EPSILON * (rest * c * c + pressure.abs());
            assert!((again - pressure).abs() <= rounding, "{ratio}, {energy}");
            found += usize::from((density / (ratio * rest) - 1.0).abs() < 1e-9);
        }
        // A gas without energy and a law in its cut-off have one pressure at many densities.
        assert!(found >= 30, "{found}");
    }

    macro_rules! round_trips {
        ($($name:ident: $law:expr);*) => { $(
            #[test]
            fn $name() {
                there_and_back($law);
            }
        )* };
    }
    for_each_eos!(round_trips);

    /// Strains whose digits drown in those of the density must not be halved without end.
    #[test]
    fn the_integral_is_cheap() {
        fn evaluations(law: impl EquationOfState) {
            let rest = law.reference_density();
            for k in 2..80 {
                for sign in [1.0, -1.0] {
                    let calls = core::cell::Cell::new(0);
                    let state = |rho: f64| {
                        calls.set(calls.get() + 1);
                        let state = law.state(rho, 0.0);
                        (state.pressure, state.sound_speed)
                    };
                    let density = rest * (1.0 + sign * 10f64.powf(-0.2 * f64::from(k)));
                    let energy = super::compression_energy(state, rest, density);
                    assert!(
                        energy.is_finite() && calls.get() < 3000,
                        "{law:?} {density}"
                    );
                    if k > 10 {
                        assert!(calls.get() <= 50, "{law:?} {density}: {}", calls.get());
                    }
                }
            }
        }
        macro_rules! evaluations_of_all {
            ($($name:ident: $law:expr);*) => { $( evaluations($law); )* };
        }
        for_each_eos!(evaluations_of_all);
    }

    #[test]
    fn pressures_that_a_law_does_not_reach() {
        let water = Material::<f64>::new("water", Linear::new(1000.0, 1480.0));
        // At zero density it pulls with ρ₀c₀².
        assert_eq!(water.eos().density_at(-1.1 * 2.1904e9, 0.0), None);
        assert_eq!(water.eos().density_at(f64::NAN, 0.0), None);
        assert_eq!(water.eos().density_at(f64::INFINITY, 0.0), None);
        assert_eq!(water.eos().density_at(0.0, 0.0), Some(1000.0));
    }

    #[test]
    fn inverses_in_closed_form() {
        let tait = Material::<f64>::new("water", Tait::new(1000.0, 20.0));
        let linear = Material::<f64>::new("water", Linear::new(1000.0, 20.0));
        for pressure in [-4e3, -1.0, 1e-3, 9810.0, 5e5] {
            let stiffness = 1000.0 * 400.0 / 7.0;
            let exact = 1000.0 * (pressure / stiffness + 1.0_f64).powf(1.0 / 7.0);
            let found = tait.eos().density_at(pressure, 0.0).expect("within range");
            assert!((found / exact - 1.0).abs() < 1e-15 * 4.0, "{pressure}");
            let exact = 1000.0 + pressure / 400.0;
            let found = linear.eos().density_at(pressure, 0.0).expect("in range");
            assert!((found / exact - 1.0).abs() < 1e-15, "{pressure}");
        }
    }

    #[test]
    fn energies_in_closed_form() {
        let (rest, c): (f64, f64) = (1000.0, 20.0);
        let linear = Material::<f64>::new("water", Linear::new(rest, c));
        let tait = Material::<f64>::new("water", Tait::new(rest, c));
        for ratio in [0.5, 0.9, 0.99, 0.9999, 1.0, 1.0001, 1.01, 1.1, 1.9] {
            let density: f64 = ratio * rest;
            // Both closed forms cancel near rest: their error is a rounding of c².
            let rounding = 1e-14 * c * c;
            let exact = c * c * (ratio.ln() + 1.0 / ratio - 1.0);
            let energy = linear.eos().compression_energy(density);
            assert!((energy - exact).abs() < rounding, "{ratio}: {energy}");
            let exact = c * c / 7.0 * ((ratio.powi(6) - 1.0) / 6.0 + 1.0 / ratio - 1.0);
            let energy = tait.eos().compression_energy(density);
            let rounding = rounding * (1.0 + ratio.powi(6));
            assert!((energy - exact).abs() < rounding, "{ratio}: {energy}");
            assert!(energy >= 0.0);
        }
        // A strain of 10⁻⁶ keeps its digits: c²ε²/2.
        let energy = linear.eos().compression_energy(1000.001);
        assert!((energy / 200e-12 - 1.0).abs() < 2e-6, "{energy}");
    }

    /// A cut law has a kink; beyond it the energy is that of a constant pressure.
    #[test]
    fn energy_across_a_kink() {
        let (rest, c, least): (f64, f64, f64) = (1000.0, 1480.0, -101e3);
        let law = Linear::new(rest, c);
        let kink = rest + least / (c * c);
        let part = |ratio: f64| c * c * (ratio.ln() + 1.0 / ratio - 1.0);
        let exact = part(kink / rest) + least * (1.0 / kink - 1.0 / 990.0);
        let wrapped = Material::<f64>::new("water", TensionCutOff::new(law, least));
        let set = Material::<f64>::new("water", law).with_pressure_cut_off(least);
        for material in [wrapped, set] {
            let energy = material.eos().compression_energy(990.0);
            assert!((energy / exact - 1.0).abs() < 1e-9, "{energy} for {exact}");
        }
    }
}
