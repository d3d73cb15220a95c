//! The report on a run: what it measured, and what of it left the thresholds, where and when.
//! A threshold that is left is a breach.

use super::super::Simulation;
use super::arrangement::{Arrangement, arrangement};
use super::thresholds::Thresholds;
use super::voids;
use super::watch::{Measure, Seen};
use crate::collective::Collective;
use crate::scalar::Real;

/// A value with where and when it was met.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The time \[s\].
    pub time: f64,
    /// The body.
    pub body: String,
    /// The number of the particle in it.
    pub particle: usize,
    /// Where it was \[m\].
    pub position: Vec<f64>,
}

/// Steps of a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StepHistory {
    /// The shortest \[s\], with the particle that set it.
    pub least: Extreme,
    /// The criterion that set it.
    pub criterion: &'static str,
    /// The median \[s\], to a tenth.
    pub median: f64,
    /// Steps by the criterion that set them, since the scene was built.
    pub set_by: Vec<(&'static str, u64)>,
}

/// A threshold that was left.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Breach {
    /// What was measured.
    pub measure: &'static str,
    /// The value that first was beyond.
    pub value: f64,
    /// The threshold.
    pub limit: f64,
    /// When, where and at which particle; `None` of what is a sum over all.
    pub at: Option<Extreme>,
}

/// Whether a run was stable.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Verdict {
    /// Whether steps were watched, by [`keep_stability`](Simulation::keep_stability). Without, what follows is of the
    /// present state alone.
    pub watched: bool,
    /// What was left, the first in time before others, then sums.
    pub breaches: Vec<Breach>,
    /// The error that ended the run, if one did.
    pub failed: Option<String>,
}

impl Verdict {
    /// Whether steps were watched, nothing was left, and no error ended the run.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.watched && self.breaches.is_empty() && self.failed.is_none()
    }
    /// Whether a measure was left.
    #[must_use]
    pub fn breaks(&self, measure: &str) -> bool {
        self.breaches.iter().any(|own| own.measure == measure)
    }
}

/// How sound a run is. What could not be measured is `None`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StabilityReport {
    /// Now \[s\].
    pub time: f64,
    /// Steps that were watched.
    pub steps: u64,
    /// Particles now.
    pub particles: usize,
    /// Least and largest density over that at rest.
    pub density: Option<[Extreme; 2]>,
    /// The sound speed \[m/s\] at which the pressure found keeps [`Thresholds::compression`], where that is left. The pressure
    /// grows with the sound speed, the more the farther the liquid has given way: see what a run with this one says.
    pub sound_speed: Option<f64>,
    /// Least and largest smoothing length over that with which the body started, where it varies.
    pub smoothing: Option<[Extreme; 2]>,
    /// Limits that were applied, by name, and evaluations in which an equation of state left its range.
    pub limits: Vec<(&'static str, u64)>,
    /// All of these over particle steps.
    pub limited: f64,
    /// Residual of momentum over Σ m |v| or what has acted from outside, the larger; where that is known.
    pub momentum: Option<f64>,
    /// Energy created by the time integration, over the energy: of the [energy ledger](Simulation::keep_energy), or of a closed scene.
    pub energy_gain: Option<f64>,
    /// Change of the energy of a closed scene whose bodies carry internal energy.
    pub energy_closure: Option<f64>,
    /// Largest gain of [stored energy](Simulation::stored_energy) over the energy supplied since the scene was built, with the
    /// particle that gained most; `None` where nothing can be said.
    pub stored_energy: Option<Extreme>,
    /// The smallest distance of two particles that was seen, in local spacings.
    pub nearest: Option<Extreme>,
    /// The least quantile of nearest neighbours that was seen.
    pub quantile: Option<f64>,
    /// The largest share of particles with a neighbour within half a spacing that was seen.
    pub close: f64,
    /// The arrangement now.
    pub arrangement: Option<Arrangement>,
    /// Radius in spacings of the largest void that particles enclose now, and its centre \[m\].
    pub void: Option<(f64, Vec<f64>)>,
    /// The steps.
    pub step: Option<StepHistory>,
    /// λ T: by how many powers of e noise grew at the pace of the last third of the run.
    pub growth: Option<f64>,
    /// Particles outside of the walls now.
    pub leaked: u64,
    /// Particles that left through outlets.
    pub left: u64,
    /// Particles without neighbours now.
    pub ejected: u64,
    /// Time that watching took over that of all steps.
    pub price: f64,
    /// Whether the run was stable.
    pub verdict: Verdict,
}

/// Sums and looks at the present state, and what was watched.
pub(super) fn of<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> StabilityReport {
    let fresh;
    let watch = if let Some(watch) = &simulation.state.watch {
        &**watch
    } else {
        fresh = super::Watch::of_now(simulation, Thresholds::default());
        &fresh
    };
    let named = |seen: Seen<D>| {
        let (body, particle) = simulation.locate(seen.id);
        Extreme {
            value: seen.value,
            time: seen.time,
            body,
            particle,
            position: seen.position.to_vec(),
        }
    };
    let both = |own: [Option<Seen<D>>; 2]| Some([named(own[0]?), named(own[1]?)]);
    let now = arrangement(&simulation.state.groups);
    let limits: Vec<_> = simulation
        .limits()
        .into_iter()
        .map(|(name, count)| {
            let before = watch.limits.iter().find(|own| own.0 == name);
            (name, count - before.map_or(0, |own| own.1))
        })
        .chain([(
            "equation of state out of its range",
            simulation.guard_counts().total() - watch.guards,
        )])
        .filter(|(_, count)| *count > 0)
        .collect();
    let applied: u64 = limits.iter().map(|own| own.1).sum();
    let (momentum, energy_gain, energy_closure) = residuals(simulation, watch);
    let points: Vec<[f64; D]> = simulation.all().map(|own| own.position()).collect();
    let walls = (simulation.state.groups.iter()).flat_map(|group| {
        let own = group.walls.iter().filter(|wall| wall.structure.is_none());
        own.flat_map(|wall| {
            wall.slots
                .clone()
                .map(|slot| group.particles.position(slot))
        })
    });
    let occupied: Vec<_> = points.into_iter().chain(walls).collect();
    let widest = simulation.all_bodies().map(|(_, body)| body.spacing);
    let void = voids::largest(&occupied, widest.fold(0.0, f64::max));
    let mut nearest = watch.nearest.map(named);
    let mut quantile = watch.quantile.map(|own| own.value);
    if let Some(now) = &now {
        quantile = Some(quantile.map_or(now.quantile, |own| own.min(now.quantile)));
        if nearest.as_ref().is_none_or(|own| now.nearest < own.value) {
            let (slot, group) = now.at;
            nearest = (slot != usize::MAX).then(|| {
                let group = &simulation.state.groups[group];
                let id = group.particles.first_id + group.particles.ids[slot] as usize;
                let (body, particle) = simulation.locate(id);
                Extreme {
                    value: now.nearest,
                    time: simulation.state.time,
                    body,
                    particle,
                    position: group.particles.position(slot).to_vec(),
                }
            });
        }
    }
    let step = watch.least_step.map(|(seen, criterion)| StepHistory {
        least: named(seen),
        criterion,
        median: watch.median_step(),
        set_by: simulation.after_step().votes.clone(),
    });
    let total = simulation.phases().total().as_secs_f64() + watch.spent.as_secs_f64();
    let mut report = StabilityReport {
        time: simulation.state.time,
        steps: watch.steps,
        particles: simulation.particles(),
        density: both(watch.density),
        sound_speed: watch.compression.sound_speed(),
        smoothing: both(watch.smoothing),
        limits,
        limited: applied as f64 / watch.particle_steps.max(1.0),
        momentum,
        energy_gain,
        energy_closure,
        stored_energy: simulation.largest_gain().map(named),
        nearest,
        quantile,
        close: watch.worst_close.max(now.map_or(0.0, |now| now.close)),
        arrangement: now,
        void: void.map(|(radius, centre)| (radius, centre.to_vec())),
        step,
        growth: watch.growth(),
        leaked: simulation.leaked().0,
        left: simulation.removed().particles - watch.removed,
        ejected: now.map_or(0, |now| now.alone),
        price: watch.spent.as_secs_f64() / total.max(f64::MIN_POSITIVE),
        verdict: Verdict::default(),
    };
    let first: Vec<_> = (Measure::ALL.iter().zip(watch.first))
        .filter_map(|(measure, seen)| Some((*measure, named(seen?))))
        .collect();
    report.verdict = judge(&report, &watch.thresholds, first, T::EPSILON);
    report.verdict.failed.clone_from(&simulation.failed);
    report
}

/// Residual of momentum, gain and closure of energy.
fn residuals<T: Real, const D: usize>(
    simulation: &Simulation<T, D>,
    watch: &super::Watch<D>,
) -> (Option<f64>, Option<f64>, Option<f64>) {
    let (momentum, _, [energy, scale]) = simulation.state_sums();
    let residual = simulation.books_momentum().then(|| {
        let outer = simulation.outer_impulse();
        let mut all = Collective::new();
        for own in simulation.all() {
            all.add(own.mass() * own.velocity().iter().map(|v| v.abs()).sum::<f64>());
        }
        let mut scale = all.value();
        let (mut off, mut given) = (0.0_f64, 0.0_f64);
        for d in 0..D {
            let by = outer[d] - watch.impulse[d];
            off = off.max((momentum[d] - watch.momentum[d] - by - watch.load[d]).abs());
            given = given.max(by.abs()).max(watch.load[d].abs());
        }
        scale = scale.max(given);
        if off == 0.0 {
            0.0
        } else {
            off / scale.max(f64::MIN_POSITIVE)
        }
    });
    let scale = scale.max(watch.energy_scale).max(f64::MIN_POSITIVE);
    let change = (energy - watch.energy) / scale;
    let closed = simulation.is_closed();
    let gain = match simulation.energy() {
        Some(own) => Some((watch.dissipated - own.dissipated) / scale),
        None => closed.then_some(change),
    };
    let closure = (closed && simulation.carries_energy()).then_some(change.abs());
    (residual, gain.map(|gain| gain.max(0.0)), closure)
}

/// What of a report is beyond the thresholds; what was so first while the run went on is given.
fn judge(
    report: &StabilityReport,
    limits: &Thresholds,
    mut first: Vec<(Measure, Extreme)>,
    epsilon: f64,
) -> Verdict {
    first.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
    let median = report.step.as_ref().map_or(0.0, |step| step.median);
    let mut breaches: Vec<Breach> = Vec::new();
    for (measure, at) in first {
        let (measure, limit) = match measure {
            Measure::Thin => ("density", limits.density[0]),
            Measure::Dense => ("density", limits.density[1]),
            Measure::Compressed => ("compression", limits.compression),
            Measure::Nearest => ("nearest", limits.nearest),
            Measure::Quantile => ("quantile", limits.quantile),
            Measure::Step => ("step", limits.step * median),
            Measure::Leaked => ("leaked", limits.leaked as f64),
        };
        let value = at.value;
        breaches.push(Breach {
            measure,
            value,
            limit,
            at: Some(at),
        });
    }
    let stored = report.stored_energy.as_ref();
    if let Some(own) = stored.filter(|own| own.value > limits.stored_energy) {
        breaches.push(Breach {
            measure: "stored energy",
            value: own.value,
            limit: limits.stored_energy,
            at: Some(own.clone()),
        });
    }
    let rounding = 1e3 * epsilon;
    let now = report.arrangement;
    let void = report.void.as_ref().map(|own| own.0);
    for (measure, value, limit) in [
        ("limited", Some(report.limited), limits.limited),
        ("momentum", report.momentum, limits.momentum.max(rounding)),
        (
            "energy gain",
            report.energy_gain,
            limits.energy_gain.max(rounding),
        ),
        (
            "energy",
            report.energy_closure,
            limits.energy_closure.max(rounding),
        ),
        ("clumping", now.map(|now| 1.0 - now.mean), limits.clumping),
        ("void", void, limits.voids),
        ("growth of noise", report.growth, limits.growth),
        ("leaked", Some(report.leaked as f64), limits.leaked as f64),
        (
            "ejected",
            Some(report.ejected as f64),
            limits.ejected as f64,
        ),
    ] {
        // What is no number is beyond.
        let beyond = |value: &f64| value.is_nan() || *value > limit;
        let known = breaches.iter().any(|own| own.measure == measure);
        if let Some(value) = value.filter(beyond).filter(|_| !known) {
            breaches.push(Breach {
                measure,
                value,
                limit,
                at: None,
            });
        }
    }
    for (measure, value, limit) in [
        (
            "nearest",
            report.nearest.as_ref().map(|own| own.value),
            limits.nearest,
        ),
        ("quantile", report.quantile, limits.quantile),
    ] {
        let known = breaches.iter().any(|own| own.measure == measure);
        if let Some(value) = value.filter(|value| *value < limit && !known) {
            let at = report.nearest.clone().filter(|_| measure == "nearest");
            breaches.push(Breach {
                measure,
                value,
                limit,
                at,
            });
        }
    }
    Verdict {
        watched: report.steps > 0,
        breaches,
        failed: None,
    }
}
