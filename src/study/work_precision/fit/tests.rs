//! Laws that are known are found, intervals hold what they say, and what values do not support is rejected.
//! Scatter is made up by numbers that are the same in every run.

use super::*;

/// Numbers between 0 and 1, the same in every run.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A number of zero mean and unit variance (Box & Muller 1958).
fn normal(next: &mut impl FnMut() -> f64) -> f64 {
    let (a, b) = (next().max(1e-300), next());
    (-2.0 * a.ln()).sqrt() * (core::f64::consts::TAU * b).cos()
}

#[test]
fn floors_and_orders_that_are_known_are_found() {
    let x: Vec<f64> = (0..6).map(|k| 0.1 * 0.5_f64.powi(k)).collect();
    for (floor, order) in [(0.0, 1.0), (1e-3, 1.5), (2e-2, 2.0), (1e-4, 0.5)] {
        let y: Vec<f64> = x.iter().map(|x: &f64| floor + x.powf(order)).collect();
        let fit = PowerFit::of(&x, &y).unwrap();
        assert!((fit.order().value - order).abs() < 0.02, "{fit:?}");
        assert!(
            (fit.floor().value - floor).abs() < 0.02 * floor + 2e-5,
            "{fit:?}"
        );
        assert!(fit.scatter() < 1e-3, "{fit:?}");
    }
}

/// How often the intervals of order, floor and a prediction hold what is known, where there is a law.
fn held(scatter: f64, trials: u32) -> [f64; 3] {
    let x: Vec<f64> = (0..5).map(|k| 0.1 * 0.5_f64.powi(k)).collect();
    let (floor, order) = (3e-3, 1.5);
    let law = |x: f64| floor + x.powf(order);
    let mut next = numbers();
    let (mut held, mut answers) = ([0.0; 3], 0.0);
    for _ in 0..trials {
        let of = |x: &f64| law(*x) * (scatter * normal(&mut next)).exp();
        let Ok(fit) = PowerFit::of(&x, &x.iter().map(of).collect::<Vec<_>>()) else {
            continue;
        };
        answers += 1.0;
        let half = 0.5 * x[4];
        let known = [
            (fit.order(), order),
            (fit.floor(), floor),
            (fit.at(half).unwrap(), law(half)),
        ];
        for (held, (estimate, exact)) in held.iter_mut().zip(known) {
            let within = estimate.low <= exact && exact <= estimate.high;
            *held += f64::from(u8::from(within));
        }
    }
    assert!(
        answers >= 0.8 * f64::from(trials),
        "{answers} of {trials} have a law"
    );
    held.map(|held| held / answers)
}

#[test]
fn intervals_hold_what_they_say() {
    // As presumed, and twice that, which five values do not tell for certain.
    let (presumed, more) = (held(0.05, 100), held(0.1, 100));
    println!("within: {presumed:?} at 5 %, {more:?} at 10 %");
    assert!(presumed.iter().all(|share| *share >= 0.9), "{presumed:?}");
    assert!(
        more.iter().all(|share| (0.7..1.0).contains(share)),
        "{more:?}"
    );
}

#[test]
fn what_is_coarse_is_left_out_where_it_follows_another_law() {
    let x: Vec<f64> = (0..6).map(|k| 0.1 * 0.5_f64.powi(k)).collect();
    // First order on fine spacings, fourth on coarse ones.
    let of = |x: &f64| 0.01 * x + 50.0 * x.powi(4);
    let fit = PowerFit::of(&x, &x.iter().map(of).collect::<Vec<_>>()).unwrap();
    assert!(fit.range().1 < 0.06, "{fit:?}");
    assert!((fit.order().value - 1.0).abs() < 0.1, "{fit:?}");
    let half = 0.5 * x[5];
    // With all of them it would be 2.2 times as much.
    assert!((fit.at(half).unwrap().value / of(&half) - 1.0).abs() < 0.1);
    // What wanders has no order.
    let none = PowerFit::of(&x[..4], &[0.665, 0.67, 0.724, 0.641]);
    assert!(matches!(none, Err(Refusal::NoOrder { .. })), "{none:?}");
}

#[test]
fn what_the_values_do_not_bear_is_refused() {
    let x = [0.4, 0.2, 0.1];
    let two = PowerFit::of(&x[..2], &[0.2, 0.1]).unwrap_err().to_string();
    assert!(two.contains("three") && two.contains('2'), "{two}");
    assert!(matches!(
        PowerFit::of(&[0.12, 0.11, 0.1], &x),
        Err(Refusal::NarrowSpacings { .. })
    ));
    assert!(matches!(
        PowerFit::of(&x, &[0.1, 0.1, 0.2]),
        Err(Refusal::Grows { .. })
    ));
    assert!(matches!(
        PowerFit::of(&x, &[0.4, 0.01, 0.3]),
        Err(Refusal::Scatter { .. })
    ));
    assert!(matches!(
        PowerFit::of(&x, &[0.4, 0.0, 0.3]),
        Err(Refusal::NoLogarithm { spacing, value, .. }) if spacing == 0.2 && value == 0.0
    ));
    let fit = PowerFit::of(&[0.4, 0.2, 0.1, 0.05], &[0.41, 0.21, 0.11, 0.06]).unwrap();
    assert!(fit.at(0.0126).is_ok());
    assert!(matches!(fit.at(0.0124), Err(Refusal::TooFar { .. })));
    assert!(matches!(fit.inverse(0.005), Err(Refusal::Floor { .. })));
    // With units: spacings in metres, errors in percent.
    let far = fit.at(0.0124).unwrap_err().to_string();
    assert!(far.contains("a spacing of 0.0124 m"), "{far}");
    let floor = fit.inverse(0.005).unwrap_err().to_string();
    assert!(floor.contains("an error of 0.500 %"), "{floor}");
    let spacing = fit.inverse(0.03).unwrap();
    assert!(
        (spacing.value - 0.02).abs() < 1e-3 && spacing.low < 0.02,
        "{spacing:?}"
    );
}
