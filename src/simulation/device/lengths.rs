//! Smoothing lengths that follow the density, recorded: their prediction, and stages that are repeated until they have settled.
//! The text is that of the host, which repeats pieces of 64 particles that have not settled.

use super::laws::{Gate, Of};
use super::program::{Action, Given, Made, Program, RepeatStep};
use super::record::{Recorder, Sums, since_lengths};
use crate::particles::Field;
use crate::scalar::{Lane, Real, Traced};
use crate::scheme::Entry;
use crate::simulation::evaluate::MOST_PREDICTED;
use crate::simulation::settle::PIECE;
use crate::term::Stage;

/// Columns of what is repeated, which nothing else writes: the change of each particle, whether its piece has not settled, and where laws
/// have limited.
pub(super) const fn change<const D: usize>() -> usize {
    Program::common(D)
}
pub(super) const fn open<const D: usize>() -> usize {
    change::<D>() + 1
}
pub(super) const fn limited<const D: usize>(law: usize) -> usize {
    change::<D>() + 2 + law
}

/// Most laws of a stage that is repeated.
pub(super) const MOST_REPEATED: usize = 2;

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// How often a stage is repeated at most, and until which change.
    pub(super) fn repeats(&self, stage: Stage) -> Option<(usize, f64)> {
        let laws = &self.group.scheme.program.laws[stage.number()];
        laws.iter().find_map(|law| law.repeats())
    }

    /// The columns behind those of all groups, and of what is repeated.
    pub(super) fn further_columns(&self) -> usize {
        let mut laws = self.group.scheme.program.laws.iter().flatten();
        let repeats = laws.any(|law| law.repeats().is_some());
        change::<D>() + if repeats { 2 + MOST_REPEATED } else { 0 }
    }

    /// The sweep of a stage and its laws, on particles that have not settled.
    pub(super) fn repeated(&mut self, stage: Stage) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        let laws = &scheme.program.laws[stage.number()];
        let Some((times, tolerance)) = self.repeats(stage) else {
            return Vec::new();
        };
        if laws.len() > MOST_REPEATED {
            let what = format!(
                "the stage `{}`, which repeats {} laws,",
                stage.name(),
                laws.len()
            );
            let most = "leave laws out: a device repeats two";
            self.refuse(format!("{what} does not run on a device"), most);
            return Vec::new();
        }
        let sums = Sums {
            of_rates: false,
            there: scheme.sums(stage),
        };
        let limits = (0..laws.len()).map(limited::<D>);
        let made = core::iter::once(open::<D>())
            .chain(limits)
            .map(Made::Column);
        let opened = vec![Given::Constant(1.0); 1 + laws.len()];
        let begin = self.on_each(
            "all particles are open",
            self.bodies(),
            (opened, made.collect()),
            |x| {
                let zero = Traced::of(0.0);
                x.iter()
                    .enumerate()
                    .map(|(k, own)| if k == 0 { *own } else { zero })
                    .collect()
            },
        );
        let mut actions = self.entry(Entry::Lists);
        actions.extend(self.sweep(stage, self.bodies()));
        let none = (
            vec![Given::Constant(0.0)],
            vec![Made::Column(change::<D>())],
        );
        actions.extend(self.on_each("no change", self.bodies(), none, |x| x.to_vec()));
        for body in 0..self.group.particles.bodies.len() {
            actions.extend(self.laws(stage, Of::Body(body), sums, Gate::Open));
        }
        let mut end = Vec::new();
        for (number, law) in laws.iter().enumerate() {
            for body in &self.group.particles.bodies {
                let given = vec![Given::Column(limited::<D>(number))];
                let kind = super::program::Kind::Limit(law.name());
                let made = vec![self.count(kind, body.slots.clone())];
                end.extend(
                    self.on_each("limited", vec![body.run()], (given, made), |x| x.to_vec()),
                );
            }
        }
        vec![Action::Repeat(Box::new(RepeatStep {
            times,
            tolerance,
            changes: change::<D>(),
            piece: PIECE,
            runs: self.bodies(),
            begin,
            actions,
            end,
        }))]
    }

    /// h as far ahead as it has changed since it was found.
    pub(super) fn predict_lengths(&mut self) -> Vec<Action> {
        let h = Field::SMOOTHING_LENGTH;
        let given = vec![
            Given::Field(h, 0),
            Given::Field(Field::SMOOTHING_RATE, 0),
            since_lengths::<D>(0),
        ];
        let made = vec![Made::Field(h, 0)];
        self.on_each(
            "prediction of smoothing lengths",
            self.everywhere(),
            (given, made),
            |x| {
                let most = Traced::of(MOST_PREDICTED);
                vec![x[0] * (Traced::of(1.0) + (x[1] * x[2]).max(-most).min(most))]
            },
        )
    }

    /// The rates of the next prediction.
    pub(super) fn length_rates(&mut self) -> Vec<Action> {
        let (found, rate) = (Field::FOUND_SMOOTHING_LENGTH, Field::SMOOTHING_RATE);
        let given = vec![
            Given::Field(Field::SMOOTHING_LENGTH, 0),
            Given::Field(found, 0),
            Given::Field(rate, 0),
            since_lengths::<D>(1),
            since_lengths::<D>(2),
        ];
        let made = vec![Made::Field(rate, 0), Made::Field(found, 0)];
        self.on_each(
            "rates of smoothing lengths",
            self.everywhere(),
            (given, made),
            |x| {
                let (zero, one) = (Traced::of(0.0), Traced::of(1.0));
                let known = x[1].gt(zero);
                let rate = (x[0] / Lane::select(known, x[1], one) - one) * x[3];
                let rate = Lane::select(known, rate, zero);
                let renewed = x[4].gt(Traced::of(0.5));
                vec![
                    Lane::select(renewed, rate, x[2]),
                    Lane::select(renewed, x[0], x[1]),
                ]
            },
        )
    }
}
