//! The vote on the step, recorded: criteria of each particle, and pairs that approach each other.
//! What wins is found by the device; what follows from it is decided here.

use super::Offloaded;
use super::program::{Action, Given, Made, PointStep, SweepStep};
use super::record::{Recorder, evaluated, least_length, range};
use crate::effect::{Around, View};
use crate::error::{Error, Result};
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real, Record, Traced, TracedMask};
use crate::simulation::approach::{FASTEST, NEAREST};
use crate::simulation::control::StepControl;
use crate::simulation::vote::{Criterion, NO_VOTE, Vote};
use crate::sweep::PairRecord;
use crate::term::Stage;
use std::ops::Range;

/// 1/s and over the sum of sound speeds: how fast the pair closes that does so most.
const CLOSING: Output = Output::scalar(name!("closing_rate", "1/s"));
const MACH: Output = Output::scalar(name!("closing_mach", "1"));

/// Accelerations below this \[m/s²\] limit no step, and are none in `f32`.
const SLOWEST: f64 = 1e-30;

/// What the particles of a device ask for.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The shortest step \[s\] that a particle asks for; negative if its state is broken.
    pub step: f64,
    /// The slot of that particle; the lowest of those that ask for the same.
    pub slot: usize,
    /// The number of the criterion.
    pub criterion: usize,
    /// The square of the largest speed \[m²/s²\].
    pub speed2: f64,
    /// The least and the largest component of velocities along each axis \[m/s\].
    pub range: [Vec<f64>; 2],
    /// The least smoothing length \[m\].
    pub length: f64,
    /// The largest acceleration \[m/s²\].
    pub acceleration: f64,
}

/// What pairs that approach each other ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approaching {
    /// The shortest step \[s\], and the slot of the particle.
    pub step: (f64, usize),
    /// The largest closing speed over the mean sound speed of the pair, and the slot of the particle.
    pub mach: (f64, usize),
}

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// The vote.
    pub(super) fn votes(&mut self, control: &StepControl) {
        for body in 0..self.group.particles.bodies.len() {
            match self.vote_of(body, control) {
                Ok(step) => self.program.vote.push(Action::Points(step)),
                Err(problem) => self.problems.push(problem),
            }
        }
        for run in self.walls() {
            let velocity = (0..D).map(|d| Given::Field(Field::VELOCITY, d));
            let given = velocity.chain([self.length()]).collect();
            let made = (0..5 + D).map(Made::Column).collect();
            let step = PointStep::new("vote of walls", &run, (given, made), |x| {
                let [none, zero] = [f64::INFINITY, 0.0].map(Traced::of);
                [&[none, zero, square(&x[..D])], x, &[zero]].concat()
            });
            self.program.vote.extend(step.map(Action::Points));
        }
        self.approach(control);
    }

    /// The smoothing length.
    fn length(&self) -> Given {
        let uniform = self.group.neighborhood.smoothing_length;
        self.or(Field::SMOOTHING_LENGTH, uniform)
    }

    fn vote_of(
        &mut self,
        body: usize,
        control: &StepControl,
    ) -> core::result::Result<PointStep, crate::error::Problem> {
        let group = self.group;
        let (scheme, columns) = (&group.scheme, &group.particles.columns);
        let there = columns.fields();
        let held = &group.particles.bodies[body];
        let rates = scheme.sums(Stage::Rates);
        let rate = |sum: Output, k: usize| {
            if rates.contains(sum) {
                Given::Rate(sum, k)
            } else {
                Given::Constant(0.0)
            }
        };
        let field = |field: Field| {
            let components = 0..field.components(D);
            components.map(move |k| Given::Field(field, k))
        };
        let viscous = there.contains(Field::DYNAMIC_VISCOSITY);
        let mut given = vec![
            Given::Field(Field::SOUND_SPEED, 0),
            rate(Output::SIGNAL, 0),
            Given::Field(Field::DENSITY, 0),
            Given::Field(Field::MASS, 0),
            self.length(),
        ];
        given.extend(viscous.then_some(Given::Field(Field::DYNAMIC_VISCOSITY, 0)));
        let first = given.len();
        given.extend((0..D).map(|d| rate(Output::FORCE, d)));
        given.extend((0..D).map(evaluated::<D>));
        given.extend(field(Field::VELOCITY));
        given.extend(field(Field::POSITION));
        let evolved = scheme.program.evolved.iter();
        given.extend(evolved.flat_map(|own| field(own.field)));
        let (count, mut limits) = (given.len(), Vec::new());
        let around = Around {
            sums: &group.work.rates,
            material: &held.material,
            wall: None,
            smoothing_length: scheme.h_over_dx() * held.spacing,
            lattice_consistency_factor: scheme.lattice_consistency_factor,
            dt: 0.0,
            time: 0.0,
            gravity: group.gravity,
            origin: group.particles.origin,
            in_drift: false,
        };
        let view = View::new(columns, around);
        for limit in &scheme.program.limits {
            let record = limit.record(&view.of_limit(&**limit));
            let problem = |what: &str| crate::error::Problem::Incompatible {
                what: format!(
                    "the limit `{}` does not run on a device: {what}",
                    limit.name()
                ),
                remedy: "write it as a PointLimit, with the arithmetic of lanes and `Lane::select`",
            };
            let own = record.ok_or_else(|| problem("it loops over columns itself"))?;
            let record = own.record.map_err(|error| problem(error.what))?;
            let at = given.len();
            for own in own.fields.iter() {
                given.extend(field(own));
            }
            for sum in own.sums.iter() {
                given.extend((0..sum.components(D)).map(|k| rate(sum, k)));
            }
            limits.push((record, at..given.len()));
        }
        let most = if T::COMPENSATED {
            f64::from(f32::MAX)
        } else {
            f64::MAX
        };
        let made = (0..5 + D).map(Made::Column).collect();
        let asked = Asked {
            viscous,
            first,
            count,
            limits,
            most,
        };
        let text = |x: &[Traced]| asked.of::<D>(x, control);
        let step = PointStep::new("vote", &held.run(), (given, made), text);
        step.map_err(|error| crate::error::Problem::Incompatible {
            what: format!(
                "the vote on the step does not run on a device: {}",
                error.what
            ),
            remedy: "run the scene on the host",
        })
    }

    /// What pairs ask for that approach each other, as the host has it.
    fn approach(&mut self, control: &StepControl) {
        let scheme = &self.group.scheme;
        let mut reads = Fields::of(&[Field::POSITION, Field::VELOCITY, Field::SOUND_SPEED]);
        let length = self.length();
        if let Given::Field(field, _) = length {
            reads = reads.union(Fields::of(&[field]));
        }
        let of_spacing = NEAREST / scheme.h_over_dx;
        let stride = reads.width(D);
        let [x, v, c] = [Field::POSITION, Field::VELOCITY, Field::SOUND_SPEED]
            .map(|field| reads.offset(field, D));
        let pair = Record::of(2 * stride + PairRecord::shared(D), |all| {
            let (i, j) = (&all[..stride], &all[stride..2 * stride]);
            // The share of a closing speed that counts stands where others have whether j moves.
            let seen = all[2 * stride + 1];
            let (mut r2, mut across) = (Traced::of(0.0), Traced::of(0.0));
            for d in 0..D {
                let r = i[x + d] - j[x + d];
                r2 += r * r;
                across += r * (i[v + d] - j[v + d]);
            }
            let towards = (-across).positive_part() * seen;
            let h = match length {
                Given::Constant(h) => Traced::of(h),
                _ => i[reads.offset(Field::SMOOTHING_LENGTH, D)],
            };
            let nearest = h * Traced::of(of_spacing);
            let distance = r2.sqrt().max(nearest * Traced::of(1e-6));
            let closing = towards / distance;
            let rate = closing / distance.max(nearest);
            let mach = closing / (i[c] + j[c]);
            // In the order of storage.
            let mut both = vec![rate; 2];
            both[Outputs::of(&[CLOSING, MACH]).offset(MACH, D)] = mach;
            both
        });
        let slots = match (self.bodies().first(), self.bodies().last()) {
            (Some(first), Some(last)) => first.start..last.end,
            _ => return,
        };
        if let (Ok(record), Ok(image)) = (pair, self.image(reads)) {
            self.program
                .approach
                .push(Action::Sweep(Box::new(SweepStep {
                    name: "approach",
                    pair: PairRecord {
                        reads,
                        writes: Outputs::of(&[CLOSING, MACH]),
                        maxima: vec![true; 2],
                        listed: Field::POSITION,
                        support: scheme.kernel.support,
                        uniform: false,
                        record,
                        across: None,
                    },
                    image,
                    slots,
                    of_rates: false,
                    of_kept: false,
                    of_walls: false,
                })));
        }
        let mut given = vec![Given::Sum(CLOSING, 0), Given::Sum(MACH, 0)];
        given.extend((0..D).map(|d| Given::Field(Field::VELOCITY, d)));
        given.extend((0..2 * D).map(range::<D>));
        given.extend([length, least_length::<D>()]);
        let made = (0..2).map(Made::Column).collect::<Vec<_>>();
        let half = 0.5 * scheme.kernel.support;
        let share = control.approach;
        for run in self.bodies() {
            let step = PointStep::new("approach", &run, (given.clone(), made.clone()), |x| {
                let (v, low, high) = (&x[2..2 + D], &x[2 + D..2 + 2 * D], &x[2 + 2 * D..2 + 3 * D]);
                let apart = Traced::of(half) * (x[2 + 3 * D] + x[3 + 3 * D]);
                let farthest = |d: usize| (v[d] - low[d]).max(high[d] - v[d]);
                let farthest: Vec<_> = (0..D).map(farthest).collect();
                let unseen = square(&farthest).sqrt() / apart;
                let rate = x[0].max(unseen).max(Traced::of(SLOWEST));
                vec![Traced::of(share) / rate, -(x[1] + x[1])]
            });
            self.program.approach.extend(step.map(Action::Points));
        }
    }
}

/// What a vote is given, and in which order: speeds, density, mass, smoothing length and viscosity; from `first` on force, gravity, velocity and place;
/// up to `count` what must be numbers; behind that what limits of effects read.
struct Asked {
    viscous: bool,
    first: usize,
    count: usize,
    limits: Vec<(Record, Range<usize>)>,
    /// The largest number.
    most: f64,
}

impl Asked {
    fn of<const D: usize>(&self, x: &[Traced], control: &StepControl) -> Vec<Traced> {
        let (zero, first) = (Traced::of(0.0), self.first);
        let own = |d: usize| x[first + d] / x[3] + x[first + D + d];
        let own: Vec<_> = (0..D).map(own).collect();
        let acceleration = square(&own).sqrt().max(Traced::of(SLOWEST));
        let viscosity = self.viscous.then(|| x[5]);
        let speed = x[0] + x[1];
        let by = control.limits(x[4], speed, acceleration, (x[2], viscosity));
        let (mut step, mut kind) = (by[0], zero);
        let mut all: Vec<Traced> = by[1..].to_vec();
        let mut sound = x[2].gt(zero);
        for (record, at) in &self.limits {
            let limit = record.follow(&x[at.clone()])[0];
            sound = sound & limit.ge(zero);
            all.push(limit);
        }
        for (k, limit) in all.into_iter().enumerate() {
            let less = limit.lt(step);
            step = Lane::select(less, limit, step);
            kind = Lane::select(less, Traced::of(k as f64 + 1.0), kind);
        }
        // What is no number, or infinite, is not within the largest number.
        let is_number = |x: &Traced| x.abs().le(Traced::of(self.most));
        let numbers = x[..self.count].iter().map(is_number);
        let sound = numbers.fold(sound, |all: TracedMask, own| all & own);
        let velocity = &x[first + 2 * D..first + 3 * D];
        let sound = sound & is_number(&acceleration);
        let step = Lane::select(sound, step, Traced::of(-1.0));
        [
            &[step, kind, square(velocity)],
            velocity,
            &[x[4], acceleration],
        ]
        .concat()
    }
}

fn square(vector: &[Traced]) -> Traced {
    let mut sum = Traced::of(0.0);
    for own in vector {
        sum += *own * *own;
    }
    sum
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// The vote of the particles by what each group asks for. Where pairs may close too fast, the numbers of
    /// [`Program::approach`](super::Program::approach) of a group are asked of `approaching`, after the least and the largest component of
    /// velocities were set as [shared](Self::shared) numbers.
    ///
    /// # Errors
    /// [`Error::NotFinite`] where the state is broken, of which the host must have a copy ([`columns_mut`](Self::columns_mut)) then,
    /// and [`Error::SoundSpeedTooLow`].
    pub fn vote<E: From<Error>>(
        &mut self,
        found: &[Found],
        mut approaching: impl FnMut(&mut Self, usize) -> core::result::Result<Approaching, E>,
    ) -> core::result::Result<(), E> {
        let mut vote = NO_VOTE;
        for (k, found) in found.iter().enumerate() {
            if found.step < 0.0 {
                let group = &self.simulation.state.groups[k];
                let error = self.simulation.broken(group, found.slot);
                return Err(self.fail(error).into());
            }
            let own = self.vote_at(
                k,
                found.step,
                self.criterion(k, found.criterion),
                found.slot,
            );
            if k == 0 || own.step < vote.step {
                vote = own;
            }
        }
        for (k, found) in found.iter().enumerate() {
            let (shifted, range) = self.range_with_images(k, &found.range);
            self.recorded[k].range = [range, vec![found.length]].concat();
            let are_there_walls = !self.simulation.state.groups[k].walls.is_empty();
            self.recorded[k].travel.vote(found, are_there_walls);
            if !self.may_meet(k, (found, shifted), vote.step) {
                continue;
            }
            let own = approaching(self, k)?;
            if self.simulation.state.groups[k].scheme.meets_walls() && own.mach.0 > FASTEST {
                let error = self.too_fast(k, own.mach);
                return Err(self.fail(error).into());
            }
            if own.step.0 < vote.step {
                vote = self.vote_at(k, own.step.0, Criterion::Approach, own.step.1);
            }
        }
        self.last_vote = Some(self.simulation.of_couples(vote));
        Ok(())
    }

    fn criterion(&self, group: usize, number: usize) -> Criterion {
        match number {
            0 => Criterion::Acoustic,
            1 => Criterion::Force,
            2 => Criterion::Viscous,
            other => {
                let limits = &self.simulation.state.groups[group].scheme.program.limits;
                let limit = limits.get(other - 3);
                limit.map_or(Criterion::Fixed, |limit| Criterion::Effect(limit.name()))
            }
        }
    }

    fn vote_at(&self, group: usize, step: f64, criterion: Criterion, slot: usize) -> Vote {
        let particles = &self.simulation.state.groups[group].particles;
        match particles.ids.get(slot).filter(|_| step < f64::INFINITY) {
            Some(&id) => Vote {
                step,
                criterion,
                particle: particles.first_id + id as usize,
            },
            None => NO_VOTE,
        }
    }

    /// Whether a pair may close by more than its share in a step \[s\].
    fn may_meet(&self, number: usize, (found, shifted): (&Found, f64), limit: f64) -> bool {
        let group = &self.simulation.state.groups[number];
        let bearable =
            self.simulation.control.approach * NEAREST * found.length / group.scheme.h_over_dx;
        let harmless = |speed: f64| speed == 0.0 || speed * limit <= bearable;
        if harmless(2.0 * found.speed2.sqrt() + shifted) {
            return false;
        }
        let (low, high) = self.recorded[number].range[..2 * D].split_at(D);
        let spread: f64 = low.iter().zip(high).map(|(a, b)| (b - a).powi(2)).sum();
        !harmless(spread.sqrt())
    }

    fn too_fast(&self, group: usize, (mach, slot): (f64, usize)) -> Error {
        let particles = &self.simulation.state.groups[group].particles;
        let body = &particles.bodies[particles.body_of(slot)];
        let sound_speed = particles.columns.raw(Field::SOUND_SPEED)[slot].to_f64();
        Error::SoundSpeedTooLow {
            body: body.name.clone(),
            particle: (particles.ids[slot] as usize).saturating_sub(body.ids.start),
            speed: mach * sound_speed,
            sound_speed,
            position: particles.position(slot).to_vec(),
            time: self.simulation.state.time,
        }
    }

    /// The next step by the last vote.
    pub(super) fn next(&mut self) -> Result<Vote> {
        let vote = self.last_vote.unwrap_or(NO_VOTE);
        let limit = self.simulation.control.fixed.map(|_| vote);
        let vote = self.simulation.grown(vote);
        let next = self.simulation.next_by(vote, limit);
        self.simulation.keep_broken(next)
    }

    /// How a vote of a group is to be held: a fixed step against the largest one that is stable. What a user asks of the first scheme
    /// may be more than another allows.
    pub(super) fn control_of_vote(&self, group: usize) -> StepControl {
        let simulation = &self.simulation;
        let mut control = simulation.control;
        let factor = |group: usize| simulation.state.groups[group].scheme.step_factor;
        if control.fixed.is_some() {
            control.courant = control.courant.max(factor(0));
        }
        if group > 0 {
            control.courant = control.courant.min(factor(group));
        }
        control.courant *= simulation.integrator.stability();
        control
    }
}
