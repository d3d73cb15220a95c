//! What a watched run keeps from step to step: extremes with their times, a histogram of steps, samples of noise.
//! Of fixed size, so that a step allocates nothing.

use super::super::Simulation;
use super::super::group::Group;
use super::super::population::Particles;
use super::arrangement::arrangement;
use super::compression::Compression;
use super::thresholds::Thresholds;
use crate::clock::Instant;
use crate::collective::{Collective, Least, over};
use crate::origin::local;
use crate::particles::Field;
use crate::scalar::Real;
use std::time::Duration;

/// Bins of steps, eight an octave about the first.
const BINS: usize = 512;
const OCTAVE: f64 = 8.0;
/// Samples of noise; when they are full every other one goes, and they are taken half as often.
const SAMPLES: usize = 128;
/// Steps after which a step can be called short.
const SETTLED: u64 = 100;

/// A value, with where and when it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Seen<const D: usize> {
    pub value: f64,
    pub time: f64,
    /// Number of the particle in the whole simulation.
    pub id: usize,
    pub position: [f64; D],
}

/// What is compared with thresholds during the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Measure {
    Thin,
    Dense,
    Compressed,
    Nearest,
    Quantile,
    Step,
    Leaked,
}

impl Measure {
    pub const ALL: [Self; 7] = [
        Self::Thin,
        Self::Dense,
        Self::Compressed,
        Self::Nearest,
        Self::Quantile,
        Self::Step,
        Self::Leaked,
    ];
}

/// A run that is watched.
#[derive(Clone, Debug)]
pub(in super::super) struct Watch<const D: usize> {
    pub thresholds: Thresholds,
    pub begun: f64,
    pub steps: u64,
    /// Particle steps.
    pub particle_steps: f64,
    /// Limits and guards at the start.
    pub limits: Vec<(&'static str, u64)>,
    pub guards: u64,
    pub removed: u64,
    /// The least and the largest density over that at rest, and smoothing length over the first.
    pub density: [Option<Seen<D>>; 2],
    /// How far and how long liquids are compressed.
    pub compression: Compression,
    pub smoothing: [Option<Seen<D>>; 2],
    pub nearest: Option<Seen<D>>,
    pub quantile: Option<Seen<D>>,
    pub worst_close: f64,
    pub least_step: Option<(Seen<D>, &'static str)>,
    bins: [u32; BINS],
    first_step: f64,
    /// Times \[s\] and logarithms of noise.
    noise: [(f64, f64); SAMPLES],
    noises: usize,
    stride: u64,
    taken: u64,
    pub first: [Option<Seen<D>>; Measure::ALL.len()],
    /// Momentum, impulses of walls and boundaries, and energy at the start, and the impulse of loads since.
    pub momentum: Vec<f64>,
    pub impulse: Vec<f64>,
    pub energy: f64,
    /// What energies are compared with: kinetic and internal ones, whatever their signs.
    pub energy_scale: f64,
    pub dissipated: f64,
    pub load: [f64; D],
    pub mass: f64,
    before: [f64; D],
    last: f64,
    pub spent: Duration,
}

/// The least and the largest (with the opposite sign) of a column over what it is at rest in each body.
fn extremes<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    field: Field,
    rest: impl Fn(usize) -> f64 + Sync,
) -> [Least; 2] {
    let column = particles.columns.raw(field);
    let mut all = Collective::new();
    let bodies = particles.bodies.iter().enumerate();
    for (k, body) in bodies.filter(|_| !column.is_empty()) {
        let over = 1.0 / rest(k);
        all.add_range(body.slots.clone(), |slot| {
            let value = column[slot].to_f64() * over;
            [Least(value, slot), Least(-value, slot)]
        });
    }
    all.value()
}

impl<const D: usize> Watch<D> {
    pub fn new<T: Real>(simulation: &Simulation<T, D>, thresholds: Thresholds) -> Self {
        let (momentum, mass, [energy, energy_scale]) = simulation.state_sums();
        let mut watch = Self {
            thresholds,
            begun: simulation.state.time,
            steps: 0,
            particle_steps: 0.0,
            limits: simulation.limits(),
            guards: simulation.guard_counts().total(),
            removed: simulation.removed().particles,
            density: [None; 2],
            compression: Compression::of(simulation),
            smoothing: [None; 2],
            nearest: None,
            quantile: None,
            worst_close: 0.0,
            least_step: None,
            bins: [0; BINS],
            first_step: 0.0,
            noise: [(0.0, 0.0); SAMPLES],
            noises: 0,
            stride: 1,
            taken: 0,
            first: [None; Measure::ALL.len()],
            momentum,
            impulse: simulation.outer_impulse(),
            energy,
            energy_scale,
            dissipated: simulation.energy().map_or(0.0, |own| own.dissipated),
            load: [0.0; D],
            mass,
            before: simulation.body_acceleration(simulation.state.time),
            last: simulation.state.time,
            spent: Duration::ZERO,
        };
        watch.look_at_bounds(simulation);
        watch
    }

    /// A look at the present state alone, of which no duration is known.
    pub fn of_now<T: Real>(simulation: &Simulation<T, D>, thresholds: Thresholds) -> Self {
        let mut watch = Self::new(simulation, thresholds);
        watch.compression.forget_durations();
        watch.look_at_compression(simulation);
        watch
    }

    /// Looks at the state after a step.
    pub fn look<T: Real>(&mut self, simulation: &Simulation<T, D>) {
        let start = Instant::now();
        self.steps += 1;
        self.particle_steps += simulation.particles() as f64;
        self.look_at_bounds(simulation);
        self.look_at_step(simulation);
        let now = simulation.body_acceleration(simulation.state.time);
        let half = 0.5 * (simulation.state.time - self.last);
        for d in 0..D {
            self.load[d] += half * self.mass * (self.before[d] + now[d]);
        }
        (self.before, self.last) = (now, simulation.state.time);
        if self.steps.is_multiple_of(self.thresholds.every.max(1)) {
            self.look_at_arrangement(simulation);
        }
        self.spent += start.elapsed();
    }

    fn look_at_bounds<T: Real>(&mut self, simulation: &Simulation<T, D>) {
        for group in &simulation.state.groups {
            let rest = |body: usize| group.particles.bodies[body].material.reference_density();
            let density = extremes(&group.particles, Field::DENSITY, rest);
            let first =
                |body: usize| group.scheme.h_over_dx() * group.particles.bodies[body].spacing;
            let lengths = extremes(&group.particles, Field::SMOOTHING_LENGTH, first);
            for (all, found) in [(&mut self.density, density), (&mut self.smoothing, lengths)] {
                for (side, Least(value, slot)) in found.into_iter().enumerate() {
                    let sign = if side == 0 { 1.0 } else { -1.0 };
                    let beyond = all[side].is_none_or(|own| value < sign * own.value);
                    if slot != usize::MAX && beyond {
                        all[side] = Some(simulation.seen(group, slot, sign * value));
                    }
                }
            }
        }
        let [thin, dense] = self.density;
        let [least, most] = self.thresholds.density;
        self.hold(Measure::Thin, thin, |value| value < least);
        self.hold(Measure::Dense, dense, |value| value > most);
        self.look_at_compression(simulation);
    }

    fn look_at_compression<T: Real>(&mut self, simulation: &Simulation<T, D>) {
        let lasting = self
            .compression
            .look(simulation, self.thresholds.compression);
        if let Some((group, slot, value)) = lasting {
            let seen = simulation.seen(&simulation.state.groups[group], slot, value);
            self.hold(Measure::Compressed, Some(seen), |_| true);
        }
    }

    fn look_at_step<T: Real>(&mut self, simulation: &Simulation<T, D>) {
        let Some(vote) = simulation.state.last_vote else {
            return;
        };
        if vote.criterion == super::super::Criterion::End {
            return;
        }
        if self.first_step == 0.0 {
            self.first_step = vote.step;
        }
        let bin = (OCTAVE * (vote.step / self.first_step).log2()).round() as i64;
        self.bins[(bin + BINS as i64 / 2).clamp(0, BINS as i64 - 1) as usize] += 1;
        if self.least_step.is_none_or(|(own, _)| vote.step < own.value) {
            let position = simulation.position_of(vote.particle);
            let seen = Seen {
                value: vote.step,
                time: simulation.state.time,
                id: vote.particle,
                position,
            };
            self.least_step = Some((seen, vote.criterion.name()));
            let median = self.median_step();
            if self.steps > SETTLED {
                let least = self.thresholds.step * median;
                self.hold(Measure::Step, Some(seen), |value| value < least);
            }
        }
    }

    fn look_at_arrangement<T: Real>(&mut self, simulation: &Simulation<T, D>) {
        if let Some(now) = arrangement(&simulation.state.groups) {
            let (slot, group) = now.at;
            if slot != usize::MAX {
                let at =
                    |value| Some(simulation.seen(&simulation.state.groups[group], slot, value));
                let least = |own: Option<Seen<D>>, value| {
                    if own.is_none_or(|own| value < own.value) {
                        at(value)
                    } else {
                        own
                    }
                };
                self.nearest = least(self.nearest, now.nearest);
                self.quantile = least(self.quantile, now.quantile);
            }
            self.worst_close = self.worst_close.max(now.close);
            self.take_noise(simulation.state.time, now.noise);
            let (nearest, quantile) = (self.thresholds.nearest, self.thresholds.quantile);
            self.hold(Measure::Nearest, self.nearest, |value| value < nearest);
            self.hold(Measure::Quantile, self.quantile, |value| value < quantile);
        }
        let (leaked, seen) = simulation.leaked();
        if leaked > self.thresholds.leaked {
            self.hold(Measure::Leaked, seen, |_| true);
        }
    }

    /// Remembers what is the first of its kind beyond a threshold.
    fn hold(&mut self, of: Measure, seen: Option<Seen<D>>, beyond: impl Fn(f64) -> bool) {
        let first = &mut self.first[of as usize];
        if first.is_none() {
            *first = seen.filter(|seen| beyond(seen.value));
        }
    }

    fn take_noise(&mut self, time: f64, noise: f64) {
        self.taken += 1;
        if !self.taken.is_multiple_of(self.stride) {
            return;
        }
        if self.noises == SAMPLES {
            for k in 0..SAMPLES / 2 {
                self.noise[k] = self.noise[2 * k + 1];
            }
            self.noises = SAMPLES / 2;
            self.stride *= 2;
            if !self.taken.is_multiple_of(self.stride) {
                return;
            }
        }
        self.noise[self.noises] = (time, noise.max(f64::MIN_POSITIVE).ln());
        self.noises += 1;
    }

    /// The step below which half of all steps are \[s\], to a tenth.
    pub fn median_step(&self) -> f64 {
        let all: u64 = self.bins.iter().map(|own| u64::from(*own)).sum();
        let mut below = 0;
        let bin = self.bins.iter().position(|own| {
            below += u64::from(*own);
            2 * below >= all.max(1)
        });
        let octaves = (bin.unwrap_or(BINS / 2) as f64 - BINS as f64 / 2.0) / OCTAVE;
        self.first_step * octaves.exp2()
    }

    /// λ T: the exponent at which noise grew over the last third of the samples, times the time watched; `None` of less
    /// than eight samples.
    pub fn growth(&self) -> Option<f64> {
        let samples = &self.noise[..self.noises];
        let last = &samples[2 * self.noises / 3..];
        if last.len() < 8 {
            return None;
        }
        let n = last.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| last.iter().map(of).sum::<f64>() / n;
        let (t, y) = (mean(|s| s.0), mean(|s| s.1));
        let above: f64 = last.iter().map(|s| (s.0 - t) * (s.1 - y)).sum();
        let below: f64 = last.iter().map(|s| (s.0 - t).powi(2)).sum();
        (below > 0.0).then(|| above / below * (self.last - self.begun))
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// A value of the particle in a slot, now.
    fn seen(&self, group: &Group<T, D>, slot: usize, value: f64) -> Seen<D> {
        Seen {
            value,
            time: self.state.time,
            id: group.particles.first_id + group.particles.ids[slot] as usize,
            position: group.particles.position(slot),
        }
    }

    /// Where a particle is, by its number; zero of none.
    fn position_of(&self, id: usize) -> [f64; D] {
        let place = |group: &Group<T, D>| {
            let own = id.checked_sub(group.particles.first_id)?;
            let slot = *group.particles.slot_of.get(own)? as usize;
            (slot < group.particles.columns.slots()).then(|| group.particles.position(slot))
        };
        self.state
            .groups
            .iter()
            .rev()
            .find_map(place)
            .unwrap_or([0.0; D])
    }

    /// Particles farther than a spacing outside of the box of the walls, where walls alone bound the scene, and the first.
    pub(super) fn leaked(&self) -> (u64, Option<Seen<D>>) {
        let Some([low, high]) = self.domain else {
            return (0, None);
        };
        if self.state.groups.iter().any(|group| {
            (group.walls.iter()).any(|wall| wall.motion.is_some() || wall.inflow.is_some())
        }) {
            return (0, None);
        }
        let (mut count, mut first) = (0, None);
        for group in &self.state.groups {
            let [low, high] = [low, high].map(|corner| local(&corner, &group.particles.origin));
            for body in &group.particles.bodies {
                let x = group.particles.columns.vectors(Field::POSITION);
                let (outside, at) = over(body.slots.clone(), |slot| {
                    let outside = (0..D).any(|d| {
                        let x = x[slot][d].to_f64();
                        x < low[d] - body.spacing || x > high[d] + body.spacing
                    });
                    (u64::from(outside), outside.then_some((slot, ())))
                });
                count += outside;
                first = first.or_else(|| at.map(|(slot, ())| self.seen(group, slot, 1.0)));
            }
        }
        (count, first)
    }

    /// Momentum, mass, and the energy at hand with its scale: kinetic, internal and of couplings, or kinetic and of
    /// compression; less what laws have worked.
    pub(super) fn state_sums(&self) -> (Vec<f64>, f64, [f64; 2]) {
        let whole = self.ledger().whole;
        let energies = if self.carries_energy() {
            let of = |name| whole.total(name).unwrap_or(0.0);
            let inside = whole.internal + of("energy of couplings") + of("heat of couplings");
            [whole.kinetic, inside]
        } else {
            let stored = self.stored();
            [stored.0, stored.1]
        };
        // What laws have worked came from their own store, or from outside.
        let energies = [energies[0], energies[1] - self.work_of_laws(None)];
        let scale = energies[0] + energies[1].abs();
        (
            whole.momentum,
            whole.mass,
            [energies[0] + energies[1], scale],
        )
    }

    /// Whether all bodies carry an internal energy.
    pub(super) fn carries_energy(&self) -> bool {
        let has = |group: &Group<T, D>| !group.particles.columns.raw(Field::ENERGY).is_empty();
        self.state.groups.iter().all(has)
    }

    /// Momentum \[kg m/s\] that walls, boundaries and laws have given bodies since the start.
    pub(super) fn outer_impulse(&self) -> Vec<f64> {
        let ledger = self.ledger();
        let mut sum = ledger.boundary_impulse;
        for (sum, given) in sum.iter_mut().zip(ledger.law_impulse) {
            *sum += given;
        }
        for wall in 0..self.wall_count() {
            if let Ok(given) = self.wall_impulse(wall) {
                for d in 0..D {
                    sum[d] -= given[d];
                }
            }
        }
        sum
    }

    /// Whether what acts from outside is known to the momentum residual: uniform loads, walls, boundaries and laws.
    pub(super) fn books_momentum(&self) -> bool {
        let own = |group: &Group<T, D>| {
            let flows = group.walls.iter().any(|wall| wall.inflow.is_some());
            let leaves = group.outlets.iter().any(|outlet| outlet.open().is_some());
            let enters = !group.emitters.is_empty() || !group.sources.is_empty() || flows;
            !enters && group.held.is_empty() && !leaves
        };
        self.loads.is_empty() && self.state.groups.iter().all(own) && self.removed().particles == 0
    }

    /// Whether nothing does work on the bodies.
    pub(super) fn is_closed(&self) -> bool {
        let still = |group: &Group<T, D>| {
            group
                .walls
                .iter()
                .all(|w| w.motion.is_none() || w.structure.is_some())
                && group.boundaries.iter().all(|boundary| !boundary.moves())
        };
        self.books_momentum()
            && self.accelerations.is_empty()
            && self.state.groups.iter().all(still)
    }
}
