//! The step as data: the entries of an evaluation, of the middle of a drift and of a kick, in their order.
//! These lists run, are checked when a scene is built, and are printed.

use super::{EnergyForm, Scheme, Smoothing};
use crate::effect::{DensityForm, Evolved, Update, When, reads_and_writes};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::term::{Stage, TermUse};

/// An entry of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Entry {
    /// Predicts smoothing lengths that follow the density.
    PredictLengths,
    /// Brings images and neighbour lists up to date.
    Lists,
    /// Sets the weights of pair sums by a density form.
    Weights(DensityForm),
    /// The sweep of a stage and its laws, both repeated where a law asks for it.
    Stage(Stage),
    /// The sweep of a stage.
    Sweep(Stage),
    /// The laws of a stage.
    Laws(Stage),
    /// The rates by which the next smoothing lengths are predicted.
    LengthRates,
    /// Equations of state.
    Materials,
    /// Pressure coefficients of the pair force.
    Coefficients,
    /// The laws of [`Stage::Rates`], and the forces that they add to those of pairs.
    ForcesOfLaws,
    /// Energy by the work of forces.
    Energy,
    /// Velocity by forces.
    Velocity,
    /// Other evolved fields.
    Evolve(When),
}

/// The entries of a step, by the operation of an integrator that runs them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Entries {
    pub evaluation: Vec<Entry>,
    /// In the middle of a drift.
    pub drift: Vec<Entry>,
    /// In a kick, before velocities change.
    pub work: Vec<Entry>,
    pub kick: Vec<Entry>,
}

/// What runs in an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A term of a sweep.
    Term,
    Law,
    /// An update of an evolved field.
    Update,
    Limit,
    /// The driver.
    Driver,
}

/// A part of an entry, with its declarations.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub kind: Kind,
    /// The stage or phase to which it belongs.
    pub stage: &'static str,
    pub name: String,
    /// The unit and update of an evolved field, in print.
    pub note: String,
    pub reads: Fields,
    /// Sums that it reads, of those that are there.
    pub sums: [Outputs; 2],
    /// Sums that it makes.
    pub makes: Outputs,
    pub writes: Fields,
}

impl Part {
    pub fn of(kind: Kind, stage: &'static str, name: impl Into<String>) -> Self {
        Self {
            kind,
            stage,
            name: name.into(),
            note: String::new(),
            reads: Fields::NONE,
            sums: [Outputs::NONE; 2],
            makes: Outputs::NONE,
            writes: Fields::NONE,
        }
    }

    /// A part of the driver.
    fn driver(stage: &'static str, name: &str, reads: &[Field], writes: &[Field]) -> Self {
        Self {
            reads: Fields::of(reads),
            writes: Fields::of(writes),
            ..Self::of(Kind::Driver, stage, name)
        }
    }
}

impl Entries {
    pub(super) fn of<T: Real, const D: usize>(scheme: &Scheme<T, D>) -> Self {
        let follows = matches!(scheme.smoothing, Smoothing::Consistent(_));
        let (density, force) = (scheme.density, scheme.pressure_form);
        let has_laws = |stage: Stage| !scheme.program.laws[stage.number()].is_empty();
        let stage = |stage: Stage| {
            let runs = scheme.sweep(stage).is_some() || has_laws(stage);
            runs.then_some(Entry::Stage(stage))
        };
        let evolves = |when| scheme.program.evolves_at(when);
        let mut sweeps = scheme.sweeps.iter().flatten();
        let presses = sweeps.any(|sweep| sweep.fields().contains(Field::PRESSURE_COEFFICIENT));
        let evaluation = [
            follows.then_some(Entry::PredictLengths),
            Some(Entry::Lists),
            (force != density).then_some(Entry::Weights(density)),
            stage(Stage::Contacts),
            stage(Stage::Density),
            follows.then_some(Entry::LengthRates),
            (!scheme.program.gives_state).then_some(Entry::Materials),
            stage(Stage::State),
            // Walls that nothing sums over are met by nobody.
            stage(Stage::Walls).filter(|_| scheme.meets_walls()),
            (force.is_integrated() || force != density).then_some(Entry::Weights(force)),
            presses.then_some(Entry::Coefficients),
            stage(Stage::Gradients),
            stage(Stage::Flow),
            Some(Entry::Sweep(Stage::Rates)),
            has_laws(Stage::Rates).then_some(Entry::ForcesOfLaws),
        ];
        let bounds = has_laws(Stage::Bounds).then_some(Entry::Laws(Stage::Bounds));
        let summed = scheme.sweep(Stage::Continuity);
        let mut drift = [
            has_laws(Stage::HalfStep).then_some(Entry::Laws(Stage::HalfStep)),
            summed.map(|_| Entry::Sweep(Stage::Continuity)),
            evolves(When::Drift).then_some(Entry::Evolve(When::Drift)),
            has_laws(Stage::Continuity).then_some(Entry::Laws(Stage::Continuity)),
            None,
        ];
        let acts = drift.iter().any(Option::is_some);
        drift[4] = bounds.filter(|_| acts);
        let kick = [
            Some(Entry::Velocity),
            evolves(When::Kick).then_some(Entry::Evolve(When::Kick)),
            bounds.filter(|_| evolves(When::Kick)),
        ];
        let carries_energy = scheme.energy != EnergyForm::None;
        Self {
            evaluation: evaluation.into_iter().flatten().collect(),
            drift: drift.into_iter().flatten().collect(),
            work: Vec::from_iter(carries_energy.then_some(Entry::Energy)),
            kick: kick.into_iter().flatten().collect(),
        }
    }

    /// All entries by phase, in the order of a step.
    pub(super) fn phases(&self) -> [(&'static str, Vec<Entry>); 3] {
        [
            ("evaluation", self.evaluation.clone()),
            ("middle of a drift", self.drift.clone()),
            ("kick", [&self.work[..], &self.kick[..]].concat()),
        ]
    }
}

impl<T: Real, const D: usize> Scheme<T, D> {
    /// The parts of an entry, in their order.
    pub(super) fn parts(&self, entry: Entry) -> Vec<Part> {
        match entry {
            Entry::PredictLengths => vec![Part::driver(
                "density",
                "prediction of smoothing lengths",
                &[Field::SMOOTHING_LENGTH, Field::SMOOTHING_RATE],
                &[Field::SMOOTHING_LENGTH],
            )],
            Entry::Lists => vec![Part::driver(
                "lists",
                "images and neighbour lists",
                &[Field::POSITION],
                &[],
            )],
            Entry::Weights(form) => {
                let reads = form.reads_of_weight();
                let name = format!("weights by {form}");
                vec![Part {
                    // Density stands in for one at rest that the scheme does not have.
                    reads: reads.minus(reads.minus(self.fields())),
                    ..Part::driver("state", &name, &[], &[Field::WEIGHT])
                }]
            }
            Entry::Stage(stage) => {
                let terms = self.term_parts(stage).into_iter();
                terms.chain(self.law_parts(stage)).collect()
            }
            Entry::Sweep(stage) => self.term_parts(stage),
            Entry::Laws(stage) => self.law_parts(stage).collect(),
            Entry::LengthRates => vec![Part::driver(
                "density",
                "rates of smoothing lengths",
                &[Field::SMOOTHING_LENGTH, Field::FOUND_SMOOTHING_LENGTH],
                &[Field::SMOOTHING_RATE, Field::FOUND_SMOOTHING_LENGTH],
            )],
            Entry::Materials => {
                let mut reads = vec![Field::DENSITY];
                if self.energy != EnergyForm::None {
                    reads.push(Field::ENERGY);
                }
                if self.density == DensityForm::Lam {
                    reads.push(Field::REFERENCE_DENSITY);
                }
                let writes = [Field::PRESSURE, Field::SOUND_SPEED];
                vec![Part::driver("state", "equations of state", &reads, &writes)]
            }
            Entry::Coefficients => {
                let reads = Fields::of(&[
                    Field::DENSITY,
                    Field::PRESSURE,
                    Field::CONSISTENCY_FACTOR,
                    Field::REFERENCE_DENSITY,
                    Field::GRAD_H,
                ]);
                let name = format!("pressure force by {}", self.pressure_form);
                vec![Part {
                    reads: reads.minus(reads.minus(self.fields())),
                    ..Part::driver("state", &name, &[], &[Field::PRESSURE_COEFFICIENT])
                }]
            }
            Entry::ForcesOfLaws => {
                let adds = self.fields().contains(Field::FORCE);
                let zero = Part::driver("rates", "zero force of laws", &[], &[Field::FORCE]);
                let zero = adds.then_some(zero).into_iter();
                zero.chain(self.law_parts(Stage::Rates)).collect()
            }
            Entry::Energy => self
                .evolved(When::Kick)
                .filter(|own| own.field == Field::ENERGY)
                .map(|own| self.update_part(own))
                .collect(),
            Entry::Velocity => vec![Part {
                sums: [Outputs::of(&[Output::FORCE]), self.sums(Stage::Rates)],
                ..Part::driver("kick", "velocity", &[Field::MASS], &[Field::VELOCITY])
            }],
            Entry::Evolve(when) => self
                .evolved(when)
                .filter(|own| own.field != Field::ENERGY)
                .map(|own| self.update_part(own))
                .collect(),
        }
    }

    fn evolved(&self, when: When) -> impl Iterator<Item = &Evolved<T, D>> {
        let evolved = self.program.evolved.iter();
        evolved.filter(move |own| own.when == when)
    }

    /// The sums of the sweep of a stage.
    pub(crate) fn sums(&self, stage: Stage) -> Outputs {
        self.sweep(stage)
            .map_or(Outputs::NONE, |sweep| sweep.outputs())
    }

    /// The terms of a sweep, in the order in which they run.
    fn term_parts(&self, stage: Stage) -> Vec<Part> {
        let Some(sweep) = self.sweep(stage) else {
            return Vec::new();
        };
        let mut terms = sweep.uses();
        terms.retain(|term| !term.document.name.is_empty());
        let part = |term: TermUse| Part {
            reads: term.reads.minus(term.reads.minus(sweep.fields())),
            makes: term.writes.minus(term.writes.minus(sweep.outputs())),
            ..Part::of(Kind::Term, stage.name(), term.document.name)
        };
        terms.into_iter().map(part).collect()
    }

    fn law_parts(&self, stage: Stage) -> impl Iterator<Item = Part> {
        let carried = self.fields();
        let laws = self.program.laws[stage.number()].iter();
        laws.map(move |law| {
            let [reads, writes] = reads_and_writes(&**law, carried);
            Part {
                reads,
                sums: [law.sums(), self.sums(stage)],
                writes,
                ..Part::of(Kind::Law, stage.name(), law.name())
            }
        })
    }

    /// The update of an evolved field by its rates, which see the sums of one sweep.
    fn update_part(&self, own: &Evolved<T, D>) -> Part {
        let (stage, summed) = match own.when {
            When::Kick => ("kick", self.sums(Stage::Rates)),
            When::Drift => ("drift", self.sums(Stage::Continuity)),
        };
        let (mut reads, mut sums) = (Fields::NONE, Outputs::NONE);
        for rate in &own.rates {
            let absent = rate.optional().minus(self.fields());
            reads = reads.union(rate.reads().minus(absent));
            sums = sums.union(rate.sums());
        }
        if own.update == Update::Rotated && !summed.contains(Output::VELOCITY_GRADIENT) {
            reads = reads.union(Fields::of(&[Field::VELOCITY_GRADIENT]));
        }
        let residual = own.residual.map_or(Fields::NONE, |own| Fields::of(&[own]));
        let kept = own.residual.map_or("", |_| ", rounding kept");
        let name = self.program.name_of(own.field);
        Part {
            note: format!(" [{}], {:?}{kept}", own.field.unit(), own.update),
            reads,
            sums: [sums, summed],
            writes: Fields::of(&[own.field]).union(residual),
            ..Part::of(Kind::Update, stage, name)
        }
    }
}
