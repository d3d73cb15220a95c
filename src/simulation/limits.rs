//! What effects ask of a step: their limits of it, and that the fields they integrate stay numbers.
//! The shortest is found as that of the other criteria.

use super::population::BodyState;
use super::vote::{Criterion, Vote};
use crate::collective::{Join, over};
use crate::effect::{StepProgram, View};
use crate::particles::Columns;
use crate::scalar::Real;
use std::ops::Range;

/// The vote, if no effect asks for a smaller step; negative where a limit is negative or no number.
pub(super) fn vote_of_effects<'a, T: Real, const D: usize>(
    program: &StepProgram<T, D>,
    bodies: impl Iterator<Item = (&'a BodyState<T>, View<'a, T, D>)>,
    mut vote: Vote,
) -> Vote {
    if vote.step < 0.0 {
        return vote;
    }
    for (body, view) in bodies {
        for limit in &program.limits {
            let view = view.of_limit(&**limit);
            let own = |slot| {
                let step = limit.step(&view, slot);
                Vote {
                    step: if step >= 0.0 { step } else { -1.0 },
                    criterion: Criterion::Effect(limit.name()),
                    particle: slot,
                }
            };
            vote = vote.and(over(body.slots.clone(), own));
        }
    }
    vote
}

/// Whether all that effects integrate is finite in a run of slots.
pub(super) fn are_finite<T: Real, const D: usize>(
    program: &StepProgram<T, D>,
    columns: &Columns<T, D>,
    run: Range<usize>,
) -> bool {
    program.evolved.iter().all(|own| {
        let width = own.field.components(D);
        let numbers = &columns.raw(own.field)[run.start * width..run.end * width];
        // What is no number, or infinite, is not zero times itself.
        let finite = |value: &T| *value * T::zero() == T::zero();
        numbers.iter().fold(true, |all, value| all & finite(value))
    })
}

/// A field of a particle that an effect integrates, and that is not finite, or a limit of its step that is negative
/// or no number; seen with what is around it.
pub(super) fn broken_effect<T: Real, const D: usize>(
    program: &StepProgram<T, D>,
    view: &View<'_, T, D>,
    slot: usize,
) -> Option<(&'static str, f64)> {
    let field = program.evolved.iter().find_map(|own| {
        let width = own.field.components(D);
        let column = view.column(own.field);
        let values = column[slot * width..(slot + 1) * width].iter();
        let wrong = values
            .map(|value| value.to_f64())
            .find(|value| !value.is_finite())?;
        Some((program.name_of(own.field), wrong))
    });
    field.or_else(|| {
        program.limits.iter().find_map(|limit| {
            let step = limit.step(&view.of_limit(&**limit), slot);
            (step.is_nan() || step < 0.0).then_some((limit.name(), step))
        })
    })
}
