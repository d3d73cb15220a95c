//! The entries of a step as records: laws, updates, equations of state, kicks and drifts as the driver does them.
//! What depends on time is a shared number; what does so otherwise is refused.

use super::images::image_record;
use super::laws::{Gate, Of, Timed};
use super::program::{Action, Counted, Given, Kind, Made, PointStep, Program, SweepStep};
use crate::effect::{DensityForm, Smoothing};
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real, Record, Traced, Unrecordable};
use crate::scheme::Entry;
use crate::simulation::Group;
use crate::simulation::control::StepControl;
use crate::sweep::{Pass, two_sum};
use crate::term::Stage;
use std::ops::Range;

/// Places of [`Offloaded::shared`](super::Offloaded::shared).
pub(super) const DT: Given = Given::Shared(0);
pub(super) const HALF: Given = Given::Shared(1);
/// Gravity now, and at the last evaluation.
pub(super) const fn gravity(d: usize) -> Given {
    Given::Shared(2 + d)
}
pub(super) const fn evaluated<const D: usize>(d: usize) -> Given {
    Given::Shared(2 + D + d)
}
/// The least and the largest component of all velocities.
pub(super) const fn range<const D: usize>(k: usize) -> Given {
    Given::Shared(2 + 2 * D + k)
}
/// The least smoothing length.
pub(super) const fn least_length<const D: usize>() -> Given {
    Given::Shared(2 + 4 * D)
}
/// How far a container has gone since lists were built.
pub(super) const fn carried<const D: usize>(d: usize) -> Given {
    Given::Shared(3 + 4 * D + d)
}
/// The time since smoothing lengths were found, its inverse, and whether there is any, where lengths follow the density.
pub(super) const fn since_lengths<const D: usize>(k: usize) -> Given {
    Given::Shared(3 + 5 * D + k)
}
/// How many there are in any scene.
const fn common<const D: usize>() -> usize {
    3 + 5 * D
}
/// The recorder of a group.
pub(super) struct Recorder<'a, T: Real, const D: usize> {
    pub group: &'a Group<T, D>,
    pub program: Program,
    pub timed: Vec<Timed>,
    pub problems: Vec<Problem>,
    /// Whether the entries are those of the middle of a drift.
    pub(super) in_drift: bool,
    /// How many actions of a kick are of its work, and come before velocities change.
    pub(super) of_work: usize,
    /// How many states the integrator keeps.
    pub(super) states: usize,
}

/// Where sums of an entry are.
#[derive(Clone, Copy)]
pub(super) struct Sums {
    pub of_rates: bool,
    pub there: Outputs,
}

impl Sums {
    pub fn given(&self, sum: Output, k: usize) -> Given {
        if !self.there.contains(sum) {
            Given::Constant(0.0)
        } else if self.of_rates {
            Given::Rate(sum, k)
        } else {
            Given::Sum(sum, k)
        }
    }
}

/// y + change, and what rounding loses of it where that is kept.
pub(super) fn add(y: Traced, lost: Option<Traced>, change: Traced) -> (Traced, Option<Traced>) {
    match lost {
        Some(lost) => {
            let (y, lost) = two_sum(y, lost + change);
            (y, Some(lost))
        }
        None => (y + change, None),
    }
}
impl<'a, T: Real, const D: usize> Recorder<'a, T, D> {
    /// Of a group, on whose particles couplings by forces may act, under an integrator that keeps so many states.
    pub fn new(group: &'a Group<T, D>, is_pushed: bool, states: usize) -> Self {
        let mut own = Self {
            group,
            program: Program::default(),
            timed: Vec::new(),
            problems: Vec::new(),
            in_drift: false,
            of_work: 0,
            states,
        };
        let further = own.further_columns();
        let others = is_pushed
            || group.has_forces_of_laws()
            || group.is_met
            || !group.held.clamps.is_empty();
        let own_forces = (others && group.keeps_rates_of_pairs()).then_some(further);
        own.program.columns = further + own_forces.map_or(0, |_| D);
        own.program.own_forces = own_forces;
        own
    }

    fn place_of_shares(&self) -> usize {
        let follows = matches!(self.group.scheme.smoothing, Smoothing::Consistent(_));
        common::<D>() + 3 * usize::from(follows)
    }

    /// [What](super::Moment::shares) a combination is made by.
    pub(super) fn shares(&self) -> [Given; 3] {
        [0, 1, 2].map(|k| Given::Shared(self.place_of_shares() + k))
    }

    /// Where the numbers of the next law start among the shared ones.
    pub(super) fn place_of_timed(&self) -> usize {
        let shares = 3 * usize::from(self.states > 0);
        self.place_of_shares() + shares + 5 * self.timed.len()
    }

    fn there(&self) -> Fields {
        self.group.particles.columns.fields()
    }

    pub(super) fn has(&self, field: Field) -> bool {
        self.there().contains(field)
    }

    /// A field, or a number where the particles do not have it.
    pub(super) fn or(&self, field: Field, otherwise: f64) -> Given {
        if self.has(field) {
            Given::Field(field, 0)
        } else {
            Given::Constant(otherwise)
        }
    }

    pub(super) fn refuse(&mut self, what: String, remedy: &'static str) {
        let problem = Problem::Incompatible { what, remedy };
        if !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }

    pub(super) fn keep(
        &mut self,
        name: &str,
        made: Result<PointStep, Unrecordable>,
    ) -> Option<Action> {
        match made {
            Ok(step) => Some(Action::Points(step)),
            Err(error) => {
                let what = format!("{name} does not run on a device: {}", error.what);
                self.refuse(
                    what,
                    "write it with the arithmetic of lanes and `Lane::select`",
                );
                None
            }
        }
    }

    /// Slots of all bodies, and of all walls, with what repeats their last particles.
    pub fn bodies(&self) -> Vec<Range<usize>> {
        let bodies = self.group.particles.bodies.iter();
        bodies.map(|body| body.run()).collect()
    }

    pub fn walls(&self) -> Vec<Range<usize>> {
        let walls = self.group.walls.iter();
        walls.map(|wall| wall.slots.start..wall.end).collect()
    }

    /// Everything.
    pub fn all(&mut self, control: &StepControl) {
        let scheme = self.group.scheme.clone();
        let entries = &scheme.entries;
        let of = |own: &mut Self, entries: &[Entry]| -> Vec<Action> {
            let actions = entries.iter().flat_map(|entry| own.entry(*entry));
            actions.collect()
        };
        self.program.evaluation = of(self, &entries.evaluation);
        self.in_drift = true;
        if !entries.drift.is_empty() {
            self.program.drift_middle = self.entry(Entry::Lists);
        }
        let middle = of(self, &entries.drift);
        self.program.drift_middle.extend(middle);
        self.in_drift = false;
        self.program.kick = of(self, &entries.work);
        self.of_work = self.program.kick.len();
        let kick = of(self, &entries.kick);
        self.program.kick.extend(kick);
        let mut begins = Vec::new();
        if scheme.acts_in_drift() {
            begins.extend(self.predict_weights());
        }
        // What a liquid meets is looked at in the middle.
        let at_once = self.group.drifts_at_once();
        begins.extend(self.moves(if at_once { DT } else { HALF }));
        self.program.drift_begins = begins;
        if !at_once {
            self.program.drift_ends = self.moves(HALF);
        }
        self.program.shift = self.shift();
        self.predictions();
        self.program.moved = self.moved();
        self.votes(control);
    }

    pub(super) fn entry(&mut self, entry: Entry) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        let of = |stage: Stage| Sums {
            of_rates: stage == Stage::Rates,
            there: scheme.sums(stage),
        };
        match entry {
            Entry::Lists => {
                let mut all = vec![Action::Lists];
                all.extend(self.stand());
                all
            }
            Entry::Weights(form) => self.weights(form),
            Entry::Coefficients => self.coefficients(),
            Entry::Materials => self.materials(),
            Entry::Sweep(stage) => {
                let mut all = self.sweep(stage, self.bodies());
                if stage == Stage::Rates {
                    all.extend(self.keep_rates());
                }
                all
            }
            Entry::Stage(Stage::Contacts) if !self.group.has_contacts() => Vec::new(),
            Entry::Stage(Stage::Walls) => {
                if self.group.walls.is_empty() || !scheme.meets_walls() {
                    return Vec::new();
                }
                let mut all = self.sweep(Stage::Walls, self.walls());
                for wall in 0..self.group.walls.len() {
                    all.extend(self.laws(
                        Stage::Walls,
                        Of::Wall(wall),
                        of(Stage::Walls),
                        Gate::None,
                    ));
                }
                all
            }
            Entry::Stage(stage) if self.repeats(stage).is_some() => self.repeated(stage),
            Entry::Stage(stage) => {
                let mut all = self.sweep(stage, self.bodies());
                all.extend(self.laws_of_bodies(stage, of(stage)));
                all
            }
            Entry::Laws(stage) => self.laws_of_bodies(stage, of(stage)),
            Entry::Velocity => self.kick(),
            Entry::Energy => self.heat_in_kick(),
            Entry::Evolve(when) => self.evolve(when),
            Entry::PredictLengths => self.predict_lengths(),
            Entry::LengthRates => self.length_rates(),
            Entry::ForcesOfLaws => self.laws_of_rates(of(Stage::Rates)),
        }
    }

    pub(super) fn sweep(&mut self, stage: Stage, runs: Vec<Range<usize>>) -> Vec<Action> {
        self.pass(stage, Pass::Rates, &runs).into_iter().collect()
    }

    /// A pass of the sweep of a stage over some runs of slots.
    pub(super) fn pass(
        &mut self,
        stage: Stage,
        pass: Pass,
        runs: &[Range<usize>],
    ) -> Option<Action> {
        let scheme = self.group.scheme.clone();
        let sweep = scheme.sweep(stage)?;
        let (first, last) = (runs.first()?, runs.last()?);
        let recorded = sweep.record(pass, self.group.has_contacts());
        let recorded = recorded.and_then(|pair| Ok((self.image(pair.reads)?, pair)));
        match recorded {
            Ok((image, pair)) => Some(Action::Sweep(Box::new(SweepStep {
                name: stage.name(),
                pair,
                image,
                slots: first.start..last.end,
                of_rates: stage == Stage::Rates && pass == Pass::Rates,
                of_kept: pass == Pass::Work,
                of_walls: false,
            }))),
            Err(error) => {
                let terms: Vec<_> = sweep.document().into_iter().map(|term| term.name).collect();
                let what = format!(
                    "the sweep `{}` ({}) does not run on a device: {}",
                    stage.name(),
                    terms.join(", "),
                    error.what
                );
                self.refuse(
                    what,
                    "write its terms with the arithmetic of lanes and `Lane::select`",
                );
                None
            }
        }
    }

    /// The record of an image, where there are any.
    pub(super) fn image(&self, reads: Fields) -> Result<Option<Record>, Unrecordable> {
        let is_open = self.group.boundaries.is_empty();
        (!is_open).then(|| image_record::<D>(reads)).transpose()
    }

    /// Walls at rest that liquid sticks to have their own velocity again.
    fn stand(&mut self) -> Vec<Action> {
        let mut all = Vec::new();
        for wall in &self.group.walls {
            if wall.motion.is_some() || !wall.is_mirrored() {
                continue;
            }
            let velocity = |d| Given::Constant(wall.sliding[d]);
            let given = (0..D).map(velocity).collect();
            let made = (0..D).map(|d| Made::Field(Field::VELOCITY, d)).collect();
            let run = wall.slots.start..wall.end;
            let step = PointStep::new("velocity of a wall", &run, (given, made), |x| x.to_vec());
            all.extend(step.map(Action::Points));
        }
        all
    }

    /// A step on each run, made by a function of it.
    pub(super) fn on_each(
        &mut self,
        name: &str,
        runs: Vec<Range<usize>>,
        (given, made): (Vec<Given>, Vec<Made>),
        text: impl Fn(&[Traced]) -> Vec<Traced>,
    ) -> Vec<Action> {
        let mut all = Vec::new();
        for run in runs {
            let step = PointStep::new(name, &run, (given.clone(), made.clone()), &text);
            all.extend(self.keep(name, step));
        }
        all
    }

    pub(super) fn everywhere(&self) -> Vec<Range<usize>> {
        [self.bodies(), self.walls()].concat()
    }

    fn weights(&mut self, form: DensityForm) -> Vec<Action> {
        let density = Given::Field(Field::DENSITY, 0);
        let rest = if self.has(Field::REFERENCE_DENSITY) {
            Given::Field(Field::REFERENCE_DENSITY, 0)
        } else {
            density
        };
        let given = vec![Given::Field(Field::MASS, 0), density, rest];
        let made = vec![Made::Field(Field::WEIGHT, 0)];
        self.on_each("weights", self.everywhere(), (given, made), |x| {
            vec![form.weight(x[0], x[1], x[2])]
        })
    }

    fn predict_weights(&mut self) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        if scheme.density == DensityForm::ContinuityByMass {
            return Vec::new();
        }
        let rates = scheme.sums(Stage::Rates);
        if !scheme.density.is_integrated() || !rates.contains(Output::COMPRESSION) {
            if scheme.pressure_form != scheme.density {
                return self.weights(scheme.density);
            }
            return Vec::new();
        }
        let form = scheme.pressure_form;
        let lattice = scheme.lattice_consistency_factor;
        let given = vec![
            Given::Field(Field::MASS, 0),
            Given::Field(Field::DENSITY, 0),
            self.or(Field::REFERENCE_DENSITY, 1.0),
            self.or(Field::CONSISTENCY_FACTOR, lattice),
            Given::Rate(Output::COMPRESSION, 0),
            HALF,
        ];
        let made = vec![Made::Field(Field::WEIGHT, 0)];
        self.on_each("weights ahead", self.bodies(), (given, made), |x| {
            let rate = form.compression(x[4], x[1], x[2], x[3]);
            vec![x[0] / (x[1] * (Traced::of(1.0) + x[5] * rate))]
        })
    }

    fn coefficients(&mut self) -> Vec<Action> {
        let form = self.group.scheme.pressure_form;
        let lattice = self.group.scheme.lattice_consistency_factor;
        let given = vec![
            Given::Field(Field::PRESSURE, 0),
            self.or(Field::GRAD_H, 1.0),
            Given::Field(Field::DENSITY, 0),
            self.or(Field::REFERENCE_DENSITY, 1.0),
            self.or(Field::CONSISTENCY_FACTOR, lattice),
        ];
        let made = vec![Made::Field(Field::PRESSURE_COEFFICIENT, 0)];
        self.on_each("coefficients", self.everywhere(), (given, made), |x| {
            vec![form.coefficient(x[0] / x[1], x[2], x[3], x[4])]
        })
    }

    fn materials(&mut self) -> Vec<Action> {
        let mut all = Vec::new();
        let group = self.group;
        for body in &group.particles.bodies {
            let name = format!("the equation of state `{}`", body.material.eos().name());
            let record = match body.material.eos().record() {
                Ok(record) => record,
                Err(error) => {
                    let what = format!("{name} does not run on a device: {}", error.what);
                    self.refuse(
                        what,
                        "write it with the arithmetic of lanes and `Lane::select`",
                    );
                    continue;
                }
            };
            let run = body.run();
            let mut made = vec![
                Made::Field(Field::PRESSURE, 0),
                Made::Field(Field::SOUND_SPEED, 0),
            ];
            for guard in 0..3 {
                made.push(self.count(Kind::Guard(guard), run.clone()));
            }
            let given = vec![Given::Field(Field::DENSITY, 0), self.or(Field::ENERGY, 0.0)];
            let step = PointStep::new(&name, &run, (given, made), |x| record.follow(x));
            all.extend(self.keep(&name, step));
        }
        all
    }

    /// A place where something is counted over some slots.
    pub(super) fn count(&mut self, kind: Kind, slots: Range<usize>) -> Made {
        let own = Counted { kind, slots };
        let known = self.program.counts.iter().position(|other| *other == own);
        Made::Count(known.unwrap_or_else(|| {
            self.program.counts.push(own);
            self.program.counts.len() - 1
        }))
    }
}
