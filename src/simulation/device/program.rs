//! The recorded step program of a simulation: sums over pairs, and what happens to single particles between them.
//! It holds no particle; a device makes kernels of it once.

use crate::particles::{Field, Fields, Output};
use crate::scalar::{Lane, Record, Traced, Unrecordable};
use crate::sweep::PairRecord;
use std::ops::Range;

/// A number that a [`PointStep`] is given of a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// A component of a field.
    Field(Field, usize),
    /// The same as it was before a prediction.
    Saved(Field, usize),
    /// A component of the place for which lists were built; behind the last of them the smoothing length where that varies.
    Listed(usize),
    /// A column of its own, as an earlier step has made it.
    Column(usize),
    /// A component of a sum of the last evaluation of the rates.
    Rate(Output, usize),
    /// A component of a sum of the last other sweep.
    Sum(Output, usize),
    /// What a wall law sees at a particle of a wall, by its place in [`Array::Walls`](super::Array::Walls).
    Wall(usize),
    /// A number that all particles share, by its place in [`Offloaded::shared`](super::Offloaded::shared).
    Shared(usize),
    /// What has been [counted](Made::Count).
    Count(usize),
    /// A constant.
    Constant(f64),
}

/// Where a result of a [`PointStep`] goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Made {
    /// A component of a field.
    Field(Field, usize),
    /// What a prediction takes back.
    Saved(Field, usize),
    /// A [count](Program::counts), which the step has added to.
    Count(usize),
    /// A column of its own.
    Column(usize),
    /// What a wall law sees at a particle of a wall.
    Wall(usize),
    /// A component of a sum of the last evaluation of the rates.
    Rate(Output, usize),
    /// Nowhere.
    Nothing,
}

/// What happens to single particles, recorded.
#[derive(Clone, Debug)]
pub struct PointStep {
    /// Its name.
    pub name: String,
    /// The slots that it acts on.
    pub slots: Range<usize>,
    /// What it does.
    pub record: Record,
    /// Its inputs.
    pub given: Vec<Given>,
    /// Where its results go, as many as there are.
    pub made: Vec<Made>,
}

impl PointStep {
    /// What a text does to some numbers.
    pub(super) fn new(
        name: impl Into<String>,
        slots: &Range<usize>,
        (given, made): (Vec<Given>, Vec<Made>),
        text: impl FnOnce(&[Traced]) -> Vec<Traced>,
    ) -> Result<Self, Unrecordable> {
        let (inputs, mut all) = (given.len(), given);
        let counts = made.iter().enumerate().filter_map(|(at, made)| match made {
            Made::Count(k) => Some((at, Given::Count(*k))),
            _ => None,
        });
        let counts: Vec<_> = counts.collect();
        all.extend(counts.iter().map(|count| count.1));
        let record = Record::of(all.len(), |x| {
            let mut results = text(&x[..inputs]);
            for ((at, _), before) in counts.iter().zip(&x[inputs..]) {
                results[*at] += *before;
            }
            results
        })?;
        Ok(Self {
            name: name.into(),
            slots: slots.clone(),
            record,
            given: all,
            made,
        })
    }

    /// Steps by the run of slots that they act on, in their order: each run has one that does what all of its steps do.
    ///
    /// # Errors
    /// [`Unrecordable`] as [`Record::of`], with the names of the steps.
    pub fn joined(steps: &[&Self]) -> Result<Vec<Self>, (String, Unrecordable)> {
        let mut runs: Vec<Vec<&Self>> = Vec::new();
        for step in steps {
            match runs.iter_mut().find(|own| own[0].slots == step.slots) {
                Some(own) => own.push(step),
                None => runs.push(vec![step]),
            }
        }
        let join = |steps: Vec<&Self>| {
            let names: Vec<_> = steps.iter().map(|step| step.name.as_str()).collect();
            let name = names.join(", ");
            let joined = Self::one_of(&steps, name.clone());
            joined.map_err(|error| (name, error))
        };
        runs.into_iter().map(join).collect()
    }

    fn one_of(steps: &[&Self], name: String) -> Result<Self, Unrecordable> {
        let mut given = Vec::new();
        for own in steps.iter().flat_map(|step| &step.given) {
            if !matches!(own, Given::Constant(_)) && !given.contains(own) {
                given.push(*own);
            }
        }
        let mut made = Vec::new();
        let text = |x: &[Traced]| {
            let mut now: Vec<_> = given.iter().copied().zip(x.iter().copied()).collect();
            for step in steps {
                let read = |own: &Given| match own {
                    Given::Constant(value) => Traced::of(*value),
                    own => now
                        .iter()
                        .find(|known| known.0 == *own)
                        .map_or(Traced::of(0.0), |known| known.1),
                };
                let results = step
                    .record
                    .follow(&step.given.iter().map(read).collect::<Vec<_>>());
                for (to, value) in step.made.iter().zip(results) {
                    let Some(place) = to.place() else {
                        continue;
                    };
                    match now.iter_mut().find(|known| known.0 == place) {
                        Some(known) => known.1 = value,
                        None => now.push((place, value)),
                    }
                    if !made.contains(to) {
                        made.push(*to);
                    }
                }
            }
            let value = |made: &Made| now.iter().find(|own| Some(own.0) == made.place());
            made.iter().filter_map(value).map(|own| own.1).collect()
        };
        let record = Record::of(given.len(), text)?;
        Ok(Self {
            name,
            slots: steps[0].slots.clone(),
            record,
            given,
            made,
        })
    }
}

impl Made {
    /// What reads there.
    #[must_use]
    pub fn place(self) -> Option<Given> {
        Some(match self {
            Self::Field(field, k) => Given::Field(field, k),
            Self::Saved(field, k) => Given::Saved(field, k),
            Self::Count(k) => Given::Count(k),
            Self::Column(k) => Given::Column(k),
            Self::Wall(k) => Given::Wall(k),
            Self::Rate(sum, k) => Given::Rate(sum, k),
            Self::Nothing => return None,
        })
    }
}

/// Sums over the pairs of some particles.
#[derive(Clone, Debug)]
pub struct SweepStep {
    /// The stage that it belongs to.
    pub name: &'static str,
    /// One pair.
    pub pair: PairRecord,
    /// Where there are boundaries: what an image shows of its source, from that and a [transform](super::Offloaded::transforms).
    pub image: Option<Record>,
    /// The slots whose sums are wanted.
    pub slots: Range<usize>,
    /// Whether its sums are the rates, which stay until the next evaluation and whose forces between blocks are booked.
    pub of_rates: bool,
    /// Whether it reads [records that are kept](Action::Keep), and not those of the present state.
    pub of_kept: bool,
    /// Whether it sums what the particles of [walls that are bodies](FollowStep) feel, whose forces between blocks are booked with
    /// those of the rates.
    pub of_walls: bool,
}

/// A wall that is a body of another group: it follows that, and what it feels is added to the forces on it.
#[derive(Clone, Debug)]
pub struct FollowStep {
    /// The slots of the wall.
    pub slots: Range<usize>,
    /// The number of the other group.
    pub group: usize,
    /// The slots of the body there.
    pub body: Range<usize>,
    /// What becomes of a particle of the wall.
    pub record: Record,
    /// Its inputs: of the particle of the wall, and behind them of that of the body, which
    /// [`Offloaded::followed`](super::Offloaded::followed) gives.
    pub own: Vec<Given>,
    /// See [`own`](Self::own).
    pub from: Vec<Given>,
    /// Where its results go, as many as there are.
    pub made: Vec<Made>,
}

/// Records that stay from an evaluation to the kicks by its forces, whose work is summed over them.
#[derive(Clone, Debug)]
pub struct KeepStep {
    /// What a record has.
    pub reads: Fields,
    /// What of it is brought up to date.
    pub fields: Fields,
    /// That of an image, as in [`SweepStep::image`], from `fields` alone.
    pub image: Option<Record>,
}

/// Actions that are repeated on particles that have not settled, as a smoothing length and the density that it gives are.
///
/// Particles settle [`piece`](Self::piece) at a time, as on the host: a column has how much each has changed, and the next a one while
/// any of its piece has changed by the tolerance or more.
#[derive(Clone, Debug)]
pub struct RepeatStep {
    /// Most repetitions.
    pub times: usize,
    /// The change at which particles have settled.
    pub tolerance: f64,
    /// The column of changes.
    pub changes: usize,
    /// Particles that settle together.
    pub piece: usize,
    /// Runs of slots, each of which pieces start with.
    pub runs: Vec<Range<usize>>,
    /// What opens all particles: at first, and where lists were built anew.
    pub begin: Vec<Action>,
    /// What is repeated.
    pub actions: Vec<Action>,
    /// What follows.
    pub end: Vec<Action>,
}

/// An entry of a step.
#[derive(Clone, Debug)]
pub enum Action {
    /// Walls go to their places, and images and neighbour lists are brought up to date.
    Lists,
    /// Sums over pairs.
    Sweep(Box<SweepStep>),
    /// Records are kept, or what changes in them is renewed.
    Keep(Box<KeepStep>),
    /// Actions are repeated until particles have settled.
    Repeat(Box<RepeatStep>),
    /// What happens to single particles.
    Points(PointStep),
}

/// A number of particles and steps that is counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Counted {
    pub(super) kind: Kind,
    /// The slots over which it is summed.
    pub slots: Range<usize>,
}

/// What happens to a state that an integrator keeps.
#[derive(Clone, Debug, Default)]
pub struct StateStep {
    /// The first of its columns, which has the first component of the first field of the [state](Program::state).
    pub first: usize,
    /// The present state is kept.
    pub save: Vec<Action>,
    /// It is brought back.
    pub load: Vec<Action>,
    /// The present state becomes its share of itself and of the kept one, and rates over a time.
    pub combine: Vec<Action>,
    /// Rates over a time are added to the kept state.
    pub accumulate: Vec<Action>,
}

impl StateStep {
    /// All that happens to it.
    #[must_use]
    pub fn lists(&self) -> [&Vec<Action>; 4] {
        [&self.save, &self.load, &self.combine, &self.accumulate]
    }
}

/// What is counted.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// A limit that a law or an update has applied, by its name.
    Limit(&'static str),
    /// A guard of an equation of state, by its place in `GuardCounts`.
    Guard(usize),
}

/// The step program, recorded. Actions run in their order.
///
/// | list | when | [`Offloaded::shared`](super::Offloaded::shared) |
/// |---|---|---|
/// | [`evaluation`](Self::evaluation) | all rates are evaluated | of `evaluation` |
/// | [`kick`](Self::kick) | velocities change | of `kick` |
/// | [`drift_begins`](Self::drift_begins), then [`drift_middle`](Self::drift_middle) and [`drift_ends`](Self::drift_ends) | places change | of `drift` |
/// | [`shift`](Self::shift) | places change by velocity and acceleration | of `shift` |
/// | [`predict`](Self::predict) | what a kick changes is saved, and predicted | of `kick` |
/// | [`restore`](Self::restore) | it is taken back | any |
/// | [`states`](Self::states) | an integrator keeps the state, and combines it with the present one | of `state`, `combination` and `accumulation` |
/// | [`vote`](Self::vote), [`approach`](Self::approach) | before a step | of `vote` |
/// | [`moved`](Self::moved) | where lists may be outdated | of the evaluation or drift |
/// | [`follows`](Self::follows), [`reacts`](Self::reacts), [`hold`](Self::hold) | before and after evaluations of all groups | of `evaluation` |
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// An evaluation.
    pub evaluation: Vec<Action>,
    /// A kick.
    pub kick: Vec<Action>,
    /// The first half of a drift; all of it if there is no [middle](Self::drift_middle).
    pub drift_begins: Vec<Action>,
    /// The middle of a drift.
    pub drift_middle: Vec<Action>,
    /// The second half of a drift.
    pub drift_ends: Vec<Action>,
    /// A drift by velocity, and by acceleration.
    pub shift: Vec<Action>,
    /// A prediction.
    pub predict: Vec<Action>,
    /// The end of it.
    pub restore: Vec<Action>,
    /// The states that an integrator keeps.
    pub states: Vec<StateStep>,
    /// The fields of these states, as their columns stand.
    pub state: Vec<Field>,
    /// Of every particle its largest stable step \[s\], negative where its state is broken, the number of its criterion, the square of
    /// its speed, its velocity, its smoothing length and its acceleration.
    pub vote: Vec<Action>,
    /// Where pairs may close too fast: the sweep that tells by how much, and of every particle its largest stable step \[s\] and
    /// minus the closing speed over the mean sound speed.
    pub approach: Vec<Action>,
    /// Of every particle the square of its displacement \[m²\] since lists were built, the displacement \[m\], and by how much its
    /// smoothing length has grown \[m\].
    pub moved: Vec<Action>,
    /// Before evaluations and in the middle of drifts: walls that are bodies of other groups, and what these feel after an evaluation.
    pub follows: Vec<FollowStep>,
    /// The forces on them, summed after all groups have evaluated their rates.
    pub reacts: Vec<Action>,
    /// The forces on clamped particles, after all others.
    pub hold: Vec<Action>,
    /// The first column of what is clamped.
    pub held: Option<usize>,
    /// Blocks whose forces are booked: bodies, and walls that are; each with its slots.
    pub feels: Vec<(usize, Range<usize>)>,
    /// What is counted.
    pub counts: Vec<Counted>,
    /// The fields that a prediction saves.
    pub saved: Vec<Field>,
    /// How many columns of their own actions make.
    pub columns: usize,
    /// The first column of what laws of the rates have given in kicks: momentum, then work.
    pub given: Option<usize>,
    /// The first column of the forces of pairs alone, where others add to the rates and work is done by those.
    pub own_forces: Option<usize>,
}

impl Program {
    /// How many columns votes and displacements make in `d` dimensions; what is [repeated](RepeatStep) has those behind them.
    #[must_use]
    pub const fn common(d: usize) -> usize {
        5 + d
    }

    /// All actions.
    pub fn actions(&self) -> impl Iterator<Item = &Action> {
        [
            &self.evaluation,
            &self.kick,
            &self.drift_begins,
            &self.drift_middle,
            &self.drift_ends,
            &self.shift,
            &self.predict,
            &self.restore,
            &self.vote,
            &self.approach,
            &self.moved,
            &self.reacts,
            &self.hold,
        ]
        .into_iter()
        .chain(self.states.iter().flat_map(StateStep::lists))
        .flatten()
    }
}
