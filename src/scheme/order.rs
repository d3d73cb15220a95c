//! The order of a step: every field and sum that a stage reads has been written by then, or belongs to the state.
//! Fields and sums of effects have full names, and one name is one thing.

use super::Scheme;
use super::entry::{Entry, Kind, Part};
use crate::effect::MOST_LAWS;
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::sweep::PairSweep;
use crate::term::Stage;

/// What the driver itself gives every particle before a step, or keeps for it.
const GIVEN: Fields = Fields::of(&[
    Field::POSITION,
    Field::POSITION_RESIDUAL,
    Field::VELOCITY,
    Field::MEAN_VELOCITY,
    Field::MEAN_ACCELERATION,
    Field::MASS,
    Field::DENSITY,
    Field::SMOOTHING_LENGTH,
    Field::WEIGHT,
    Field::CONSISTENCY_FACTOR,
    Field::GRAD_H,
    Field::FOUND_SMOOTHING_LENGTH,
    Field::SMOOTHING_RATE,
    Field::CONTACT_ACTIVITY,
    Field::CONTACT_THRESHOLD,
    Field::DYNAMIC_VISCOSITY,
]);
/// Densities and sums at rest.
const REFERENCE: Fields = Fields::of(&[Field::REFERENCE_SUM, Field::REFERENCE_DENSITY]);

impl<T: Real, const D: usize> Scheme<T, D> {
    /// What is wrong with the order of the entries, and with the names of fields and sums.
    pub(crate) fn misordered(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        self.check_room(&mut problems);
        if !problems.is_empty() {
            // What has no room would be missed everywhere.
            return problems;
        }
        let laws = Stage::ALL.map(|stage| self.program.sequence(stage).err());
        problems.extend(laws.into_iter().flatten());
        self.check_names(&mut problems);
        self.check_forces(&mut problems);
        self.check_evolved(&mut problems);
        let parts = |entries: &[Entry]| -> Vec<Part> {
            entries.iter().flat_map(|own| self.parts(*own)).collect()
        };
        let [evaluation, drift, kick] = self.entries.phases().map(|(_, own)| parts(&own));
        // What a drift writes is there for the evaluation after it, as what belongs to the state.
        let written = |known: Fields, part: &Part| known.union(part.writes);
        let mut known = drift.iter().fold(self.state(), written);
        // The stage of the reference configuration runs once, when the scene is built.
        let reference = parts(&[Entry::Stage(Stage::Reference)]);
        let rest = [evaluation, drift, kick].concat();
        for part in reference.iter().chain(&rest) {
            self.check(part, known, &mut problems);
            known = written(known, part);
        }
        for limit in &self.program.limits {
            let part = Part {
                reads: limit.reads(),
                sums: [limit.sums(), self.sums(Stage::Rates)],
                ..Part::of(Kind::Limit, Stage::Rates.name(), limit.name())
            };
            self.check(&part, known, &mut problems);
        }
        problems
    }

    /// Whether the terms of every sweep have names of their own, by which they are ordered.
    fn check_names(&self, problems: &mut Vec<Problem>) {
        for stage in Stage::ALL {
            let mut terms = self.sweep(stage).map_or(Vec::new(), PairSweep::uses);
            terms.sort_by(|a, b| (a.name, &a.text).cmp(&(b.name, &b.text)));
            for pair in terms.windows(2).filter(|pair| pair[0].name == pair[1].name) {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the terms `{}` and `{}` of the stage {} have one name, {}",
                        pair[0].document.name,
                        pair[1].document.name,
                        stage.name(),
                        pair[0].name
                    ),
                    remedy: "leave one of the two effects out, or give its term a name of its own (Term::NAME)",
                });
            }
        }
    }

    /// Whether laws give forces where these join others.
    fn check_forces(&self, problems: &mut Vec<Problem>) {
        for stage in Stage::ALL.into_iter().filter(|own| *own != Stage::Rates) {
            let mut laws = self.program.laws[stage.number()].iter();
            if let Some(law) = laws.find(|law| law.writes().contains(Field::FORCE)) {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the law `{}` of the scheme {} gives particles a force at the stage {}, where forces are not summed",
                        law.name(),
                        self.name,
                        stage.name()
                    ),
                    remedy: "run it at Stage::Rates; what it needs of an earlier stage a law there writes to a field",
                });
            }
        }
    }

    /// Fields that particles have when a step begins.
    fn state(&self) -> Fields {
        let program = &self.program;
        let mut known = GIVEN.union(program.carried());
        if self.density.has_reference() && self.reference.is_some() {
            known = known.union(REFERENCE);
        }
        let residuals = program.evolved.iter().filter_map(|own| own.residual);
        program
            .state()
            .chain(residuals)
            .fold(known, |all, field| all.union(Fields::of(&[field])))
    }

    /// Whether each evolved field is integrated once, and each part of a rate by something.
    fn check_evolved(&self, problems: &mut Vec<Problem>) {
        let mut seen = Fields::NONE;
        for own in &self.program.evolved {
            if seen.contains(own.field) {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the scheme {} integrates {} twice",
                        self.name,
                        self.program.name_of(own.field)
                    ),
                    remedy: "let one effect integrate it, and the other contribute to its rate \
                             (StepProgram::contribute)",
                });
            }
            seen = seen.union(Fields::of(&[own.field]));
        }
        for (k, own) in self.program.evolved.iter().enumerate() {
            let mut rest = self.program.evolved[k + 1..].iter();
            if let Some(other) = rest.find(|other| other.precedes(own)) {
                let [own, other] = [own, other].map(|one| self.program.name_of(one.field));
                problems.push(Problem::Incompatible {
                    what: format!(
                        "the rate of {other} of the scheme {} reads {own} as it is before that changes, and the rate of {own}, by \
                         itself or through others, {other}",
                        self.name
                    ),
                    remedy: "let a law write one of the rates into a field, and integrate by that (ByField)",
                });
            }
        }
        for (field, _) in &self.program.pending {
            problems.push(Problem::Incompatible {
                what: format!(
                    "an effect of the scheme {} adds to the rate of {}, which nothing integrates",
                    self.name,
                    self.program.name_of(*field)
                ),
                remedy: "take a form that integrates it, or leave the effect out",
            });
        }
    }

    /// Whether all that a part reads is there.
    fn check(&self, part: &Part, known: Fields, problems: &mut Vec<Problem>) {
        let mut missing = |kind, quantity: &str| {
            problems.push(Problem::NotWritten {
                scheme: self.name.clone(),
                reader: named(part),
                kind,
                quantity: quantity.into(),
                stage: part.stage,
            });
        };
        for field in part.reads.minus(known).iter() {
            missing("field", self.program.name_of(field));
        }
        let [sums, summed] = part.sums;
        for sum in sums.minus(summed).iter() {
            missing("sum", self.name_of_sum(sum));
        }
    }

    /// The sums of all sweeps.
    fn all_sums(&self) -> Outputs {
        let sweeps = self.sweeps.iter().flatten().chain(&self.reference);
        sweeps.fold(Outputs::NONE, |all, sweep| all.union(sweep.outputs()))
    }

    /// The name of a sum: the full one if another of the scheme has the same name.
    pub(super) fn name_of_sum(&self, sum: Output) -> &'static str {
        sum.name_among(self.all_sums().iter())
    }

    /// Whether every field and sum has a name of its own, and room; and whether the laws of every stage have.
    fn check_room(&self, problems: &mut Vec<Problem>) {
        let all = [
            ("fields", self.fields().fault()),
            ("sums", self.all_sums().fault()),
        ];
        for (kind, fault) in all {
            problems.extend(fault.map(|fault| Problem::Names {
                scheme: self.name.clone(),
                kind,
                fault,
            }));
        }
        for laws in &self.program.laws {
            if let Some(law) = laws.get(MOST_LAWS) {
                problems.push(Problem::Incompatible {
                    what: format!(
                        "a stage of the scheme {} has room for {MOST_LAWS} laws, and not for `{}`",
                        self.name,
                        law.name()
                    ),
                    remedy: "leave effects out",
                });
            }
        }
    }
}

/// How problems name a part.
fn named(part: &Part) -> String {
    let name = &part.name;
    match part.kind {
        Kind::Term => format!("the term `{name}`"),
        Kind::Law => format!("the law `{name}`"),
        Kind::Update => format!("the rate of {name}"),
        Kind::Limit => format!("the limit `{name}`"),
        Kind::Driver => format!("the entry `{name}`"),
    }
}
