//! An effect in a window of time: its laws and limits act between two times, and not before or after.
//! For effects without pair terms: a loop over pairs has no clock.

use super::{Chunk, Effect, Law, Limit, Rung, Setting, StepProgram, Tally, View};
use crate::error::Problem;
use crate::particles::{Fields, Outputs};
use crate::scalar::Real;

/// An effect without pair terms whose laws and limits of the step act from `from` \[s\] until before `until` \[s\].
///
/// What it shortens the step by, it shortens it by throughout: the step factor of a scheme is one number. An effect that
/// integrates a field has no window, since what is integrated has a rate at all times; a scheme with one is refused.
///
/// ```
/// use meshfree::effect::During;
/// use meshfree::prelude::*;
/// // Damps sound after the impact alone.
/// let damping = During { effect: AcousticDamping { strength: 0.3 }, from: 0.02, until: f64::INFINITY };
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible().with(damping).compose();
/// assert!(scheme.step_program().contains("acoustic damping"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct During<A> {
    /// The effect.
    pub effect: A,
    /// When it begins \[s\].
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub from: f64,
    /// When it ends \[s\]; infinity for never.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial::unbounded"))]
    pub until: f64,
}

impl<A> During<A> {
    /// The same window around something else.
    fn around<B>(&self, effect: B) -> During<B> {
        During {
            effect,
            from: self.from,
            until: self.until,
        }
    }

    fn is_on(&self, time: f64) -> bool {
        time >= self.from && time < self.until
    }
}

impl<const D: usize, A: Effect<D, Terms = ()>> Effect<D> for During<A> {
    type Terms = ();
    const NEEDS: Fields = A::NEEDS;
    const BOOKS_ENERGY: bool = A::BOOKS_ENERGY;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let rates = |program: &StepProgram<T, D>| {
            let evolved = program.evolved.iter().map(|own| own.rates.len() + 1);
            evolved.sum::<usize>() + program.pending.len()
        };
        let laws = core::array::from_fn::<_, { crate::term::Stage::COUNT }, _>(|stage| {
            program.laws[stage].len()
        });
        let (limits, integrated) = (program.limits.len(), rates(program));
        self.effect.register(program);
        for (all, first) in program.laws.iter_mut().zip(laws) {
            let own = all.split_off(first);
            let own = own.into_iter();
            all.extend(own.map(|law| Box::new(self.around(law)) as Box<dyn Law<T, D>>));
        }
        let own = program.limits.split_off(limits).into_iter();
        let own = own.map(|limit| Box::new(self.around(limit)) as Box<dyn Limit<T, D>>);
        program.limits.extend(own);
        if rates(program) > integrated {
            program.require(|_| {
                Some(Problem::Incompatible {
                    what: "an effect that integrates a field is limited to a window of time".into(),
                    remedy: "take it without `During`, or let its strength follow the time in a law of your own",
                })
            });
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.effect.problems();
        if self.from.is_nan() {
            let must_be = "it must be a time in seconds, or minus infinity";
            problems.push(("begin of the window of an effect", self.from, must_be));
        }
        if self.until.is_nan() || self.until <= self.from {
            let must_be = "it must be after the begin, in seconds, or infinity";
            problems.push(("end of the window of an effect", self.until, must_be));
        }
        problems
    }
}

impl<T: Real, const D: usize> Law<T, D> for During<Box<dyn Law<T, D>>> {
    fn name(&self) -> &'static str {
        self.effect.name()
    }
    fn reads(&self) -> Fields {
        self.effect.reads()
    }
    fn sums(&self) -> Outputs {
        self.effect.sums()
    }
    fn writes(&self) -> Fields {
        self.effect.writes()
    }
    fn adds(&self) -> Fields {
        self.effect.adds()
    }
    fn optional(&self) -> Fields {
        self.effect.optional()
    }
    fn before(&self) -> Fields {
        self.effect.before()
    }
    fn rung(&self) -> Option<Rung> {
        self.effect.rung()
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        if self.is_on(chunk.around.time) {
            self.effect.apply(chunk)
        } else {
            Tally::default()
        }
    }
    fn repeats(&self) -> Option<(usize, f64)> {
        self.effect.repeats()
    }
}

impl<T: Real, const D: usize> Limit<T, D> for During<Box<dyn Limit<T, D>>> {
    fn name(&self) -> &'static str {
        self.effect.name()
    }
    fn reads(&self) -> Fields {
        self.effect.reads()
    }
    fn sums(&self) -> Outputs {
        self.effect.sums()
    }
    fn step(&self, at: &View<'_, T, D>, slot: usize) -> f64 {
        if self.is_on(at.around.time) {
            self.effect.step(at, slot)
        } else {
            f64::INFINITY
        }
    }
}
