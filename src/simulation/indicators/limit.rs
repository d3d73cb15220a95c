//! What limits accuracy most, from the indicators of a state, and what one step better costs.
//! Estimates of leading errors, made to be compared with each other and not to be believed to a digit.

use super::super::stability::Extreme;
use super::super::{Criterion, Simulation};
use super::look::Look;
use super::report::{Indicators, Limit, LimitedBy, median};
use crate::neighbors::listed_around;
use crate::scalar::{Real, width};

/// Estimates below this are rounding.
const NOTHING: f64 = 1e-6;
/// Particles across from which on a body is not called thin: the rule of thumb of bending plates and films.
const THIN: f64 = 4.0;
/// By how much h/dx rises in one step better.
const RATIO: f64 = 1.25;

/// What the estimates are made of beside the indicators.
pub(super) struct Estimates {
    /// Median of h over the spacing.
    smoothing: Option<f64>,
    /// Median of |p| over the range of p.
    level: Option<f64>,
}

impl Estimates {
    pub fn of(looks: &[(usize, Look)], ranges: &[[Option<f64>; 2]]) -> Self {
        let of = |value: &dyn Fn(&(usize, Look)) -> Option<f64>| {
            let mut all: Vec<f64> = looks.iter().filter_map(value).collect();
            (!all.is_empty()).then(|| median(&mut all))
        };
        Self {
            smoothing: of(&|(_, look)| Some(look.smoothing)),
            level: of(&|(group, look)| Some(look.pressure.abs() / ranges[*group][0]?)),
        }
    }
}

/// How often the number of steps falls, or rises, when the length that sets them grows by a factor.
fn steps_with(criterion: Criterion, factor: f64) -> f64 {
    match criterion {
        Criterion::Viscous => factor * factor,
        Criterion::Force => factor.sqrt(),
        _ => factor,
    }
}

/// What limits a simulation, the most limiting first.
pub(super) fn limits<T: Real, const D: usize>(
    simulation: &Simulation<T, D>,
    indicators: &Indicators,
    estimates: &Estimates,
) -> Vec<Limit> {
    let criterion = simulation
        .vote()
        .map_or(Criterion::Acoustic, |vote| vote.criterion);
    let scheme = &simulation.state.groups[0].scheme;
    let finer = (
        "half the spacing".to_string(),
        Some(2.0_f64.powi(D as i32) * steps_with(criterion, 2.0)),
    );
    let wider = {
        let (now, most) = (scheme.h_over_dx, scheme.kernel.range.1);
        // Two digits, as people choose it.
        let then = ((RATIO * now).min(most) * 20.0).round() / 20.0;
        if then > 1.05 * now {
            let listed = |h_over_dx: f64| {
                listed_around(D, 1.1 * scheme.kernel.support * h_over_dx, width::<T>())
            };
            let cost = listed(then) / listed(now) / steps_with(criterion, then / now);
            (format!("h/dx {now} -> {then}"), Some(cost))
        } else {
            let what =
                format!("a kernel that takes more than h/dx {now}, such as Wendland's C4 at 1.8");
            (what, None)
        }
    };
    let mut all = Vec::new();
    let mut add = |by, error: f64, at: Option<&Extreme>, (remedy, cost): (String, Option<f64>)| {
        if error > NOTHING {
            all.push(Limit {
                by,
                error,
                at: at.cloned(),
                remedy,
                cost,
            });
        }
    };
    let steepest = [&indicators.fronts, &indicators.layers];
    let steepest = steepest.into_iter().flatten().map(|own| &own.worst);
    let steepest = steepest.max_by(|a, b| a.value.total_cmp(&b.value));
    if let (Some(front), Some(ratio)) = (steepest, estimates.smoothing) {
        let error = 2.0 * scheme.profile.spread * (ratio * front.value).powi(2);
        add(
            LimitedBy::Smoothing,
            error.min(1.0),
            Some(front),
            finer.clone(),
        );
    }
    if let Some(left) = &indicators.left {
        add(LimitedBy::Sums, left.median, None, wider.clone());
    }
    let pressure = indicators.fronts.as_ref().zip(estimates.smoothing);
    if let (Some((front, ratio)), Some(level), Some(disorder)) =
        (pressure, estimates.level, &indicators.disorder)
    {
        let error = 2.0 * level * disorder.median / (ratio * front.worst.value);
        add(LimitedBy::Disorder, error, Some(&disorder.worst), wider);
    }
    if let Some(drift) = indicators.drift {
        let remedy = "an effect that holds densities to the space of particles".to_string();
        add(LimitedBy::Drift, drift.abs(), None, (remedy, None));
    }
    for across in &indicators.thickness {
        if across.median < THIN {
            let at = Some(&across.worst);
            add(LimitedBy::Thickness, 1.0 / across.median, at, finer.clone());
        }
    }
    all.sort_by(|a, b| b.error.total_cmp(&a.error));
    all
}
