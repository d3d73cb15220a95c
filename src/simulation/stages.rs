//! Stages: a sweep over pairs, and then the laws of the scheme, chunk by chunk in one pass over particles.
//! The driver of everything that effects do; it knows none of them.

use super::group::Group;
use super::settle::{Outcome, Settling, join, run_pieces};
use crate::clock::Instant;
use crate::effect::{Around, Chunk, Law, MOST_LAWS, Slices};
use crate::parallel::GRAIN;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::sweep::{PairSweep, SweepInput};
use crate::term::Stage;
use std::ops::Range;

/// Where and when a stage runs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// The time \[s\].
    pub time: f64,
    /// The step \[s\] over which it acts.
    pub dt: f64,
    /// Whether the sums are those of a sweep in the middle of a drift.
    pub in_drift: bool,
    /// Whether the sums are those of the rates.
    pub of_rates: bool,
}

impl Moment {
    /// In an evaluation at `time` \[s\].
    pub fn at(time: f64) -> Self {
        Self {
            time,
            dt: 0.0,
            in_drift: false,
            of_rates: false,
        }
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Runs a sweep over particles of bodies into the sums.
    pub(super) fn sum(&mut self, choose: impl Fn(&Scheme<T, D>) -> Option<&dyn PairSweep<T, D>>) {
        self.sum_over(0..self.particles.mobile, None, choose);
    }

    /// Runs a sweep over some slots into the sums, or over some of these.
    fn sum_over(
        &mut self,
        targets: Range<usize>,
        among: Option<&[Range<usize>]>,
        choose: impl Fn(&Scheme<T, D>) -> Option<&dyn PairSweep<T, D>>,
    ) {
        let mut records = core::mem::take(&mut self.work.records);
        self.work.records_of_rates = false;
        let mut sums = core::mem::take(&mut self.work.sums);
        if let Some(sweep) = choose(&self.scheme) {
            let input = SweepInput {
                targets,
                among,
                ..self.input()
            };
            let [packed, summed] = self.pack_and_run(sweep, &input, &mut records, &mut sums);
            let pairs = match among {
                Some(runs) => runs
                    .iter()
                    .map(|run| self.neighborhood.pairs_of(run.clone()))
                    .sum(),
                None => self.neighborhood.pairs_of(input.targets),
            };
            self.work.phases.packing += packed;
            self.work.phases.pairs += summed;
            self.work.spent.pairs += pairs;
        }
        self.work.records = records;
        self.work.sums = sums;
    }

    /// Runs the sweep of a stage over particles of bodies into the sums.
    pub(super) fn sum_stage(&mut self, stage: Stage) {
        let start = Instant::now();
        self.sum(|scheme| scheme.sweep(stage));
        self.work.spent.sweeps[stage.number()] += start.elapsed();
    }

    /// Runs the sweep of a stage, if there is one, and its laws.
    pub(super) fn run_stage(&mut self, stage: Stage, moment: Moment) {
        let scheme = self.scheme.clone();
        let laws = &scheme.program.laws[stage.number()];
        let repeats = laws.iter().find_map(|law| law.repeats());
        let limited = if let Some(repeats) = repeats {
            self.settle(stage, repeats, moment)
        } else {
            if scheme.sweep(stage).is_some() {
                self.sum_stage(stage);
            }
            self.run_laws(stage, laws, moment, None)
        };
        for (law, limited) in laws.iter().zip(limited) {
            self.count(law.name(), limited);
        }
    }

    /// Runs the sweep of a stage and its laws again, with new lists, on particles that they change much.
    fn settle(
        &mut self,
        stage: Stage,
        (times, tolerance): (usize, f64),
        moment: Moment,
    ) -> [u64; MOST_LAWS] {
        let scheme = self.scheme.clone();
        let laws = &scheme.program.laws[stage.number()];
        let mut settling = core::mem::take(&mut self.work.settling);
        settling.open_all(&self.particles.bodies);
        for _ in 0..times {
            let rebuilds = self.neighborhood.rebuilds;
            self.refresh(moment.time, None);
            if self.neighborhood.rebuilds != rebuilds {
                // Particles may have other places.
                settling.open_all(&self.particles.bodies);
            }
            let start = Instant::now();
            self.sum_over(0..self.particles.mobile, Some(&settling.open), |scheme| {
                scheme.sweep(stage)
            });
            self.work.spent.sweeps[stage.number()] += start.elapsed();
            self.run_laws(stage, laws, moment, Some((&mut settling, tolerance)));
            let is_open = settling.find_open(&self.particles.bodies);
            if !self.apart().map_or(is_open, |(team, _)| team.any(is_open)) {
                break;
            }
        }
        let limited = settling.limited();
        self.work.settling = settling;
        limited
    }

    /// Runs the laws of a stage without its sweep.
    pub(super) fn apply_laws(&mut self, stage: Stage, moment: Moment) {
        let scheme = self.scheme.clone();
        let laws = &scheme.program.laws[stage.number()];
        let limited = self.run_laws(stage, laws, moment, None);
        for (law, limited) in laws.iter().zip(limited) {
            self.count(law.name(), limited);
        }
    }

    /// Laws on all particles of bodies, or on those that have not settled to a tolerance, body by body; the particles at
    /// which each applied a limit.
    fn run_laws(
        &mut self,
        stage: Stage,
        laws: &[Box<dyn Law<T, D>>],
        moment: Moment,
        settling: Option<(&mut Settling, f64)>,
    ) -> [u64; MOST_LAWS] {
        let mut outcomes = [Outcome::default(); MOST_LAWS];
        if laws.is_empty() {
            return outcomes.map(|outcome| outcome.limited);
        }
        let mut settling = settling
            .map(|(settling, tolerance)| (settling.by_body(&self.particles.bodies), tolerance));
        let mut rest = Slices::of(&mut self.particles.columns);
        for body in &self.particles.bodies {
            let run = body.run();
            let (own, behind) = rest.split(run.len());
            rest = behind;
            let around = Around {
                sums: if moment.of_rates {
                    &self.work.rates
                } else {
                    &self.work.sums
                },
                material: &body.material,
                wall: None,
                smoothing_length: self.scheme.h_over_dx() * body.spacing,
                lattice_consistency_factor: self.scheme.lattice_consistency_factor,
                dt: moment.dt,
                time: moment.time,
                gravity: self.gravity,
                origin: self.particles.origin,
                in_drift: moment.in_drift,
            };
            let live = body.slots.end;
            let others = match &mut settling {
                Some((pieces, tolerance)) => {
                    let pieces = pieces.next().unwrap_or_default();
                    run_pieces(laws, own, run, live, around, (pieces, *tolerance))
                }
                None => run_chunks(laws, own, run, live, around),
            };
            join(&mut outcomes, &others);
        }
        let spent = &mut self.work.spent.laws[stage.number()];
        for (own, outcome) in spent.iter_mut().zip(&outcomes) {
            *own += outcome.time;
        }
        outcomes.map(|outcome| outcome.limited)
    }

    /// The stage of walls: what they take from the liquid, and the laws that answer it.
    pub(super) fn run_walls(&mut self, time: f64) {
        if self.walls.is_empty() || !self.scheme.meets_walls() {
            return;
        }
        let slots = self.particles.mobile..self.particles.columns.slots();
        let start = Instant::now();
        self.sum_over(slots, None, |scheme| scheme.sweep(Stage::Walls));
        self.work.spent.sweeps[Stage::Walls.number()] += start.elapsed();
        let scheme = self.scheme.clone();
        let laws = &scheme.program.laws[Stage::Walls.number()];
        let rest = Slices::of(&mut self.particles.columns);
        let (_, mut rest) = rest.split(self.particles.mobile);
        let Some(body) = self.particles.bodies.first() else {
            return;
        };
        let mut outcomes = [Outcome::default(); MOST_LAWS];
        for (number, wall) in self.walls.iter().enumerate() {
            let run = wall.slots.start..wall.end;
            let (own, behind) = rest.split(run.len());
            rest = behind;
            let flows = self.emitters.iter().any(|own| own.wall == number) || wall.inflow.is_some();
            let surface = wall.surface(&self.particles.ids, time, flows);
            let around = Around {
                sums: &self.work.sums,
                material: &body.material,
                wall: Some(&surface),
                smoothing_length: self.neighborhood.smoothing_length,
                lattice_consistency_factor: self.scheme.lattice_consistency_factor,
                dt: 0.0,
                time,
                gravity: self.gravity,
                origin: self.particles.origin,
                in_drift: false,
            };
            join(
                &mut outcomes,
                &run_chunks(laws, own, run, wall.slots.end, around),
            );
        }
        let spent = &mut self.work.spent.laws[Stage::Walls.number()];
        for (own, outcome) in spent.iter_mut().zip(&outcomes) {
            *own += outcome.time;
        }
        for own in &scheme.program.least_on_rigid {
            self.find_least_on_rigid(*own);
        }
    }

    /// Writes the smallest value of a field on wet particles of each rigid body to another field of all of its particles.
    fn find_least_on_rigid(&mut self, [of, to]: [Field; 2]) {
        let sums = &self.work.sums;
        let [from, least] = self.particles.columns.many_mut([of, to]);
        for wall in &self.walls {
            if !wall.structure.as_ref().is_some_and(|own| own.rigid) {
                continue;
            }
            // Liquid reaches those whose sums of it are not empty.
            let wet = wall
                .slots
                .clone()
                .filter(|slot| sums.get(Output::UNITY, 0, *slot) > T::zero());
            let smallest = wet.map(|slot| from[slot]).reduce(T::min);
            least[wall.slots.start..wall.end].fill(smallest.unwrap_or_else(T::zero));
        }
    }

    /// A column of this group taken out for a while, to be changed with all others in sight.
    pub(super) fn take(&mut self, field: Field) -> Vec<T> {
        core::mem::take(self.particles.columns.column_mut(field))
    }
}

/// Laws over a run of slots, of which those before `live` are particles and the others repeat the last.
fn run_chunks<T: Real, const D: usize>(
    laws: &[Box<dyn Law<T, D>>],
    columns: Slices<'_, T>,
    slots: Range<usize>,
    live: usize,
    around: Around<'_, T, D>,
) -> [Outcome; MOST_LAWS] {
    if slots.len() > GRAIN {
        let half = (slots.len() / GRAIN).div_ceil(2) * GRAIN;
        let (low, high) = columns.split(half);
        let middle = slots.start + half;
        let (mut outcomes, others) = crate::parallel::join(
            || run_chunks(laws, low, slots.start..middle, live, around),
            || run_chunks(laws, high, middle..slots.end, live, around),
        );
        join(&mut outcomes, &others);
        return outcomes;
    }
    let mut outcomes = [Outcome::default(); MOST_LAWS];
    let mut chunk = Chunk::new(columns, slots.clone(), live, around);
    for (law, outcome) in laws.iter().zip(&mut outcomes) {
        let start = Instant::now();
        outcome.limited = chunk.run(&**law).limited;
        outcome.time = start.elapsed();
    }
    outcomes
}
