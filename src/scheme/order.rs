//! The order of a step: every field and sum that a stage reads has been written by then, or belongs to the state.
//! Fields and sums of effects have full names, and one name is one thing.

use super::Scheme;
use crate::effect::{MOST_LAWS, Update, When, reads_and_writes};
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::term::{Stage, TermUse};

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
/// What equations of state write, after the densities.
const STATE: Fields = Fields::of(&[Field::PRESSURE, Field::SOUND_SPEED]);
/// What the pressure form makes of it, once the pressures of walls are known.
const COEFFICIENTS: Fields = Fields::of(&[Field::PRESSURE_COEFFICIENT]);
/// What is zero before the laws of the rates, and they add to.
const OF_LAWS: Fields = Fields::of(&[Field::FORCE]);
const REFERENCE: Fields = Fields::of(&[Field::REFERENCE_SUM, Field::REFERENCE_DENSITY]);
/// The stages up to the end of an evaluation, in their order; those of a drift come between two evaluations.
const EVALUATION: [Stage; 7] = [
    Stage::Reference,
    Stage::Density,
    Stage::State,
    Stage::Walls,
    Stage::Gradients,
    Stage::Flow,
    Stage::Rates,
];

/// What a part of a step reads.
struct Reader {
    name: String,
    stage: Stage,
    fields: Fields,
    sums: Outputs,
}

impl<T: Real, const D: usize> Scheme<T, D> {
    /// What is wrong with the order of the stages, and with the names of fields and sums.
    pub(crate) fn misordered(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        self.check_room(&mut problems);
        if !problems.is_empty() {
            // What has no room would be missed everywhere.
            return problems;
        }
        let laws = Stage::ALL.map(|stage| self.program.sequence(stage).err());
        problems.extend(laws.into_iter().flatten());
        self.check_forces(&mut problems);
        let later = [Stage::Continuity, Stage::Bounds];
        // What a drift writes is there for the evaluation after it, as what belongs to the state.
        let mut known = later
            .iter()
            .fold(self.state(), |all, stage| all.union(self.written(*stage)));
        for stage in EVALUATION {
            match stage {
                Stage::State => known = known.union(STATE),
                Stage::Gradients => known = known.union(COEFFICIENTS),
                _ => {}
            }
            known = self.check_stage(stage, known, &mut problems);
        }
        for stage in later {
            known = self.check_stage(stage, known, &mut problems);
        }
        self.check_evolved(known, &mut problems);
        for limit in &self.program.limits {
            let reader = Reader {
                name: format!("the limit `{}`", limit.name()),
                stage: Stage::Rates,
                fields: limit.reads(),
                sums: limit.sums(),
            };
            self.check(&reader, known, self.sums(Stage::Rates), &mut problems);
        }
        problems
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

    /// Fields that the laws of a stage write.
    fn written(&self, stage: Stage) -> Fields {
        let (laws, carried) = (self.program.laws[stage.number()].iter(), self.fields());
        laws.fold(Fields::NONE, |all, law| {
            let [_, writes] = reads_and_writes(&**law, carried);
            all.union(writes)
        })
    }

    /// The sums of the sweep that the laws of a stage see.
    fn sums(&self, stage: Stage) -> Outputs {
        // Contacts are asked for with the sums at rest where density does not follow from sums.
        let contacts = (self.reference.as_deref())
            .filter(|_| stage == Stage::Density && self.density.is_integrated());
        let sweeps = self.sweep(stage).into_iter().chain(contacts);
        sweeps.fold(Outputs::NONE, |all, sweep| all.union(sweep.outputs()))
    }

    /// Checks the sweep of a stage and then its laws, in their order; what is known after them.
    fn check_stage(&self, stage: Stage, mut known: Fields, problems: &mut Vec<Problem>) -> Fields {
        let uses = self.sweep(stage).map(|sweep| sweep.uses());
        // Walls without a sweep over them are met by nobody.
        if stage == Stage::Walls && uses.is_none() {
            return known;
        }
        for TermUse { name, reads, .. } in uses.into_iter().flatten() {
            let reader = Reader {
                name: format!("the term `{name}`"),
                stage,
                fields: reads,
                sums: Outputs::NONE,
            };
            self.check(&reader, known, Outputs::NONE, problems);
        }
        if stage == Stage::Rates {
            known = known.union(OF_LAWS);
        }
        for law in &self.program.laws[stage.number()] {
            let [reads, writes] = reads_and_writes(&**law, self.fields());
            let reader = Reader {
                name: format!("the law `{}`", law.name()),
                stage,
                fields: reads,
                sums: law.sums(),
            };
            self.check(&reader, known, self.sums(stage), problems);
            known = known.union(writes);
        }
        known
    }

    /// Rates of fields that are integrated, which see everything, but the sums of one sweep alone.
    fn check_evolved(&self, known: Fields, problems: &mut Vec<Problem>) {
        let mut seen = Fields::NONE;
        for own in &self.program.evolved {
            let stage = match own.when {
                When::Kick => Stage::Rates,
                When::Drift => Stage::Continuity,
            };
            let name = self.program.name_of(own.field);
            if seen.contains(own.field) {
                problems.push(Problem::Incompatible {
                    what: format!("the scheme {} integrates {name} twice", self.name),
                    remedy: "let one effect integrate it, and the other contribute to its rate \
                             (StepProgram::contribute)",
                });
            }
            seen = seen.union(Fields::of(&[own.field]));
            let reader = |fields, sums| Reader {
                name: format!("the rate of {name}"),
                stage,
                fields,
                sums,
            };
            for rate in &own.rates {
                let absent = rate.optional().minus(self.fields());
                let reader = reader(rate.reads().minus(absent), rate.sums());
                self.check(&reader, known, self.sums(stage), problems);
            }
            let sums = self.sums(stage);
            if own.update == Update::Rotated && !sums.contains(Output::VELOCITY_GRADIENT) {
                let spin = reader(Fields::of(&[Field::VELOCITY_GRADIENT]), Outputs::NONE);
                self.check(&spin, known, sums, problems);
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

    /// Whether all that something reads is there.
    fn check(&self, by: &Reader, known: Fields, summed: Outputs, problems: &mut Vec<Problem>) {
        let mut missing = |kind, quantity: &str| {
            problems.push(Problem::NotWritten {
                scheme: self.name.clone(),
                reader: by.name.clone(),
                kind,
                quantity: quantity.into(),
                stage: by.stage.name(),
            });
        };
        for field in by.fields.minus(known).iter() {
            missing("field", self.program.name_of(field));
        }
        for sum in by.sums.minus(summed).iter() {
            missing("sum", self.name_of_sum(sum));
        }
    }

    /// The sums of all sweeps.
    fn all_sums(&self) -> Outputs {
        let sweeps = self.sweeps.iter().flatten();
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
