//! Couplings by forces as records: what a particle feels by those of the other side, each side by itself.
//! Pairs act in the order of the numbers of their particles, as on the host.

use super::program::{Given, Made, PointStep};
use super::record::{DT, HALF, Recorder, evaluated};
use crate::coupling::CouplingRecord;
use crate::error::Problem;
use crate::particles::{Field, Output};
use crate::scalar::{Lane, Real, Record, Traced, Unrecordable};
use crate::simulation::Simulation;
use crate::simulation::contact::{Couple, NEAREST};
use crate::simulation::side::Side;
use crate::term::Stage;
use core::ops::Range;

/// What a particle makes of a number that its pairs give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Summed {
    /// The sum over its pairs.
    Sum,
    /// The same, with the opposite sign if it is the second of a pair.
    Opposite,
    /// The sum over pairs of which it is the first.
    First,
    /// The largest; zero at least.
    Most,
    /// The smallest.
    Least,
}

/// Numbers that pairs give.
#[derive(Clone, Debug)]
pub struct PairStep {
    /// Of the numbers of both particles, as [`ContactSide::given`] has them, and of their distance as built.
    pub record: Record,
    /// Whether they stand in the order of the pair; if not, the particle that is given something comes first.
    pub ordered: bool,
    /// Where results go, as columns behind [`ContactSide::first`], and what is made of them.
    pub made: Vec<(usize, Summed)>,
}

/// A body that takes part in a coupling by forces.
#[derive(Clone, Debug)]
pub struct ContactSide {
    /// The number of its group.
    pub group: usize,
    /// Its slots, with what repeats its last particle, and without.
    pub slots: [Range<usize>; 2],
    /// What of a particle the coupling sees.
    pub given: Vec<Given>,
    /// The first of its columns.
    pub first: usize,
    /// What follows the [sums](ContactStep::gather) of each particle.
    pub own: PointStep,
}

/// A coupling by forces.
#[derive(Clone, Debug)]
pub struct ContactStep {
    /// The name of the coupling.
    pub name: &'static str,
    /// The two bodies, or one that meets itself.
    pub sides: Vec<ContactSide>,
    /// What is summed before forces.
    pub gather: Option<PairStep>,
    /// Forces.
    pub act: PairStep,
    /// Whether its pairs are those as built, whose [distances](super::Partners::rest) then it reads.
    pub as_built: bool,
    /// What the host reads of all particles of a side: columns behind its first, and what is made of them.
    pub found: Vec<(usize, Summed)>,
}

/// Columns of a side: sums with their gradient and the pressure; what is found; the force, its work, and where particles were listed.
const SUM: usize = 0;
const fn pressure<const D: usize>() -> usize {
    1 + D
}
pub(super) const fn stored<const D: usize>() -> usize {
    2 + D
}
pub(super) const fn moved<const D: usize>() -> usize {
    7 + D
}
pub(super) const fn force<const D: usize>() -> usize {
    8 + D
}
pub(super) const fn work<const D: usize>() -> usize {
    8 + 2 * D
}
pub(super) const fn listed<const D: usize>() -> usize {
    9 + 2 * D
}
pub(super) const fn width<const D: usize>() -> usize {
    9 + 3 * D
}

/// What of couplings does not run on a device.
pub(super) fn refused<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Vec<String> {
    let groups = &simulation.state.groups;
    let of = |couple: &Couple<T, D>| {
        let what = format!("the coupling `{}`", couple.coupling.name());
        let sides = couple.sides.iter();
        let silent = |side: &Side<D>| {
            let group = side.body().map(|own| &groups[own.0].scheme);
            group.is_some_and(|own| !own.sums(Stage::Rates).contains(Output::FORCE))
        };
        if couple.sides[1].is_wall() {
            Some(format!("{what} with a wall"))
        } else if !groups[0].boundaries.is_empty() {
            Some(format!("{what} among images of boundaries"))
        } else if sides.clone().any(silent) {
            Some(format!("{what} of a scheme without forces"))
        } else if couple.coupling.record().is_none() {
            Some(format!(
                "{what}, which has no record (as friction has none),"
            ))
        } else {
            None
        }
    };
    simulation.state.couples.iter().filter_map(of).collect()
}

/// The gap between two particles.
fn gap<const D: usize>(x: &[Traced], w: usize) -> Traced {
    let mut square = Traced::of(0.0);
    for d in 0..D {
        let own = x[d] - x[w + d];
        square += own * own;
    }
    square.sqrt()
}

/// A coupling as steps, whose sides are given.
fn step<T: Real, const D: usize>(
    couple: &Couple<T, D>,
    sides: Vec<ContactSide>,
    (record, spacing, approach): (&CouplingRecord, f64, f64),
) -> core::result::Result<ContactStep, Unrecordable> {
    let w = CouplingRecord::width(D);
    let as_built = couple.coupling.as_built();
    let near = |x: &[Traced], values: Vec<Traced>, beyond: &[f64]| -> Vec<Traced> {
        if as_built {
            return values;
        }
        let near = gap::<D>(x, w).lt(Traced::of(couple.reach));
        let all = values.iter().zip(beyond);
        all.map(|(value, beyond)| Lane::select(near, *value, Traced::of(*beyond)))
            .collect()
    };
    let gather = record.gather.as_ref().map(|gather| {
        let none = vec![0.0; 1 + D];
        let record = Record::of(2 * w, |x| near(x, gather.follow(x), &none))?;
        Ok(PairStep {
            record,
            ordered: false,
            made: (SUM..=D).map(|k| (k, Summed::Sum)).collect(),
        })
    });
    let none = [&vec![0.0; D + 3][..], &[f64::INFINITY]].concat();
    let act = Record::of(2 * w + 1, |x| {
        let (zero, one) = (Traced::of(0.0), Traced::of(1.0));
        let mut results = record.act.follow(x);
        let acts = results[..D].iter().map(|own| zero.lt(own.abs()));
        let acts = acts.reduce(|a, b| a | b);
        results.extend(acts.map(|acts| Lane::select(acts, one, zero)));
        let distance = gap::<D>(x, w);
        results.push(one - distance / Traced::of(spacing));
        let mut step = record.step.follow(&x[..2 * w])[0];
        if !as_built {
            let mut closing = zero;
            for d in 0..D {
                closing += (x[w + D + d] - x[D + d]) * (x[d] - x[w + d]);
            }
            let nearest = Traced::of(1e-6 * spacing);
            let closing = closing / distance.max(nearest);
            let way = distance.max(Traced::of(NEAREST * spacing)) * Traced::of(approach);
            let closes = closing.gt(zero);
            step = Lane::select(closes, step.min(way / closing), step);
        }
        // What is no number is no step at all.
        results.push(Lane::select(step.ge(zero), step, zero));
        near(x, results, &none)
    })?;
    let mut made: Vec<_> = (0..D)
        .map(|d| (force::<D>() + d, Summed::Opposite))
        .collect();
    let kinds = [Summed::First, Summed::First, Summed::Most, Summed::Least];
    made.extend(
        kinds
            .into_iter()
            .enumerate()
            .map(|(k, own)| (stored::<D>() + 1 + k, own)),
    );
    let kinds = [
        Summed::Sum,
        Summed::Sum,
        Summed::Sum,
        Summed::Most,
        Summed::Least,
        Summed::Most,
    ];
    let found = kinds.into_iter().chain([Summed::Sum; D]).enumerate();
    Ok(ContactStep {
        name: couple.coupling.name(),
        sides,
        gather: gather.transpose()?,
        act: PairStep {
            record: act,
            ordered: true,
            made,
        },
        as_built,
        found: found.map(|(k, own)| (stored::<D>() + k, own)).collect(),
    })
}

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// A side of a coupling in the group, with the forces that it gives and the work of these in kicks.
    fn side(
        &mut self,
        (couple, record): (&Couple<T, D>, &CouplingRecord),
        (group, body): (usize, usize),
        spacings: [f64; 2],
    ) -> core::result::Result<ContactSide, Unrecordable> {
        let first = self.program.columns;
        self.program.columns += width::<D>();
        let held = &self.group.particles.bodies[body];
        let slots = [held.run(), held.slots.clone()];
        let of = |field| (0..D).map(move |d| Given::Field(field, d));
        let mut given: Vec<_> = of(Field::POSITION).chain(of(Field::VELOCITY)).collect();
        given.extend([Field::MASS, Field::DENSITY].map(|field| Given::Field(field, 0)));
        given.extend([spacings[0], couple.stiffness].map(Given::Constant));
        given.extend((first..=first + pressure::<D>()).map(Given::Column));
        let (w, mut reads, mut made) = (given.len(), given.clone(), Vec::new());
        let as_built = couple.coupling.as_built();
        if !as_built {
            reads.extend((0..D).map(|d| Given::Column(first + listed::<D>() + d)));
            made.push(Made::Column(first + moved::<D>()));
        }
        if record.pressure.is_some() {
            made.extend([pressure::<D>(), stored::<D>()].map(|k| Made::Column(first + k)));
        }
        let own = PointStep::new("coupling", &slots[0], (reads, made), |x| {
            let mut results = Vec::new();
            if !as_built {
                let gone = gap::<D>(x, w);
                results.push(gone * gone);
            }
            if let Some(record) = &record.pressure {
                let given = [&x[..w], &[Traced::of(spacings[1])]].concat();
                results.extend(record.follow(&given));
            }
            results
        })?;
        let given_force = |d: usize| Given::Column(first + force::<D>() + d);
        let mut reads: Vec<_> = (0..D).map(|d| Given::Rate(Output::FORCE, d)).collect();
        let made = (0..D).map(|d| Made::Rate(Output::FORCE, d)).collect();
        reads.extend((0..D).map(given_force));
        let run = vec![slots[0].clone()];
        let pushed = self.on_each("forces of couplings", run.clone(), (reads, made), |x| {
            (0..D).map(|d| x[d] + x[D + d]).collect()
        });
        self.program.hold.extend(pushed);
        let mut reads = vec![DT, HALF, Given::Field(Field::MASS, 0)];
        for d in 0..D {
            reads.extend([given_force(d), Given::Field(Field::VELOCITY, d)]);
            reads.extend([Given::Rate(Output::FORCE, d), evaluated::<D>(d)]);
        }
        let total = first + work::<D>();
        reads.push(Given::Column(total));
        let made = vec![Made::Column(total)];
        let booked = self.on_each("work of couplings", run, (reads, made), |x| {
            let mut power = Traced::of(0.0);
            for own in x[3..3 + 4 * D].chunks_exact(4) {
                power += own[0] * (own[1] + x[1] * (own[2] / x[2] + own[3]));
            }
            vec![x[3 + 4 * D] + x[0] * power]
        });
        let at = self.of_work;
        self.program.kick.splice(at..at, booked);
        Ok(ContactSide {
            group,
            slots,
            given,
            first,
            own,
        })
    }
}

/// Whether couplings by forces act on bodies of a group.
pub(super) fn push<T: Real, const D: usize>(simulation: &Simulation<T, D>, group: usize) -> bool {
    let sides = simulation.state.couples.iter().flat_map(|own| &own.sides);
    sides.filter_map(Side::body).any(|own| own.0 == group)
}

/// The sides of all couplings by forces in a group, each with the number of the coupling and its own; before what is clamped.
pub(super) fn sides_of<T: Real, const D: usize>(
    simulation: &Simulation<T, D>,
    recorder: &mut Recorder<'_, T, D>,
    group: usize,
) -> Vec<([usize; 2], ContactSide)> {
    let mut all = Vec::new();
    let groups = &simulation.state.groups;
    for (number, couple) in simulation.state.couples.iter().enumerate() {
        // Refused by name before, if there is none.
        let Some(record) = couple.coupling.record() else {
            continue;
        };
        let count = 2 - usize::from(couple.is_self());
        for (side, own) in couple.sides.iter().take(count).enumerate() {
            let Some(at) = own.body().filter(|at| at.0 == group) else {
                continue;
            };
            let spacings = [own.spacing(groups), couple.spacing(groups)];
            match recorder.side((couple, &record), at, spacings) {
                Ok(own) => all.push(([number, side], own)),
                Err(error) => recorder
                    .problems
                    .push(cannot(couple.coupling.name(), &error)),
            }
        }
    }
    all
}

/// All couplings by forces, of their sides.
pub(super) fn all<T: Real, const D: usize>(
    simulation: &Simulation<T, D>,
    mut sides: Vec<([usize; 2], ContactSide)>,
) -> core::result::Result<Vec<ContactStep>, Problem> {
    let (mut all, groups) = (Vec::new(), &simulation.state.groups);
    sides.sort_by_key(|own| own.0);
    for (number, couple) in simulation.state.couples.iter().enumerate() {
        let Some(record) = couple.coupling.record() else {
            continue;
        };
        let (own, rest) = sides.into_iter().partition(|own| own.0[0] == number);
        sides = rest;
        let own = Vec::into_iter(own).map(|own| own.1).collect();
        let with = (&record, couple.spacing(groups), simulation.control.approach);
        let made = step(couple, own, with);
        all.push(made.map_err(|error| cannot(couple.coupling.name(), &error))?);
    }
    Ok(all)
}

/// A coupling whose records do not follow.
fn cannot(name: &str, error: &Unrecordable) -> Problem {
    Problem::Incompatible {
        what: format!(
            "the coupling `{name}` does not run on a device: {}",
            error.what
        ),
        remedy: "write it with the arithmetic of lanes and `Lane::select`",
    }
}
