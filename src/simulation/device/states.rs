//! States that an integrator keeps, as columns of the device, and what it makes of them and of the rates.
//! The host has their impulses, and the states themselves while it builds lists.

use super::clock::Moment;
use super::program::{Action, Given, Made, PointStep, StateStep};
use super::record::{DT, Recorder, add, evaluated};
use super::state::Forces;
use super::transfer::Array;
use super::{Offloaded, Recorded};
use crate::effect::When;
use crate::particles::{Field, Output};
use crate::scalar::{Real, Traced};
use crate::simulation::evolve::{POSITIONS, state};
use crate::simulation::workspace::Saved;
use crate::sweep::two_sum;
use crate::term::Stage;
use std::ops::Range;

/// The column of a component of a field in a kept state.
type Kept<'a> = &'a dyn Fn(Field, usize) -> usize;

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    /// What an integrator does to the states that it keeps.
    pub(super) fn keep_states(&mut self) {
        let scheme = self.group.scheme.clone();
        let fields: Vec<Field> = state(&scheme.program).collect();
        let fields: Vec<Field> = fields.into_iter().filter(|own| self.has(*own)).collect();
        let numbers: Vec<_> = fields
            .iter()
            .flat_map(|&field| (0..field.components(D)).map(move |k| (field, k)))
            .collect();
        for _ in 0..self.states {
            let first = self.program.columns;
            self.program.columns += numbers.len();
            let present = || numbers.iter().copied();
            let columns = first..first + numbers.len();
            let same = |x: &[Traced]| x.to_vec();
            let given = present().map(|(field, k)| Given::Field(field, k)).collect();
            let made = columns.clone().map(Made::Column).collect();
            let save = self.on_each("kept state", self.bodies(), (given, made), same);
            let given = columns.clone().map(Given::Column).collect();
            let made = present().map(|(field, k)| Made::Field(field, k)).collect();
            let load = self.on_each("state as kept", self.bodies(), (given, made), same);
            let kept = |field: Field, k: usize| {
                let at = numbers.iter().position(|own| *own == (field, k));
                first + at.unwrap_or(0)
            };
            let [combine, accumulate] =
                [true, false].map(|combines| self.advanced(&kept, combines));
            self.program.states.push(StateStep {
                first,
                save,
                load,
                combine,
                accumulate,
            });
        }
        self.program.state = fields;
    }

    /// Rates over a time added to a combination of the kept state with the present one, or to the kept state.
    fn advanced(&mut self, kept: Kept<'_>, combines: bool) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        let summed = scheme.sums(Stage::Rates).contains(Output::FORCE);
        let mut all = Vec::new();
        for body in 0..self.group.particles.bodies.len() {
            let velocity = (0..D).map(|d| Given::Field(Field::VELOCITY, d)).collect();
            let [place, lost] = POSITIONS;
            let to = (body, kept, combines);
            all.extend(self.advance((place, Some(lost)), to, velocity, |_, x| x.to_vec()));
            let mut given = vec![Given::Field(Field::MASS, 0)];
            for d in 0..D {
                let force = Given::Rate(Output::FORCE, d);
                given.push(if summed { force } else { Given::Constant(0.0) });
                given.push(evaluated::<D>(d));
            }
            all.extend(self.advance((Field::VELOCITY, None), to, given, |_, x| {
                let own = x[1..].chunks_exact(2);
                own.map(|own| own[0] / x[0] + own[1]).collect()
            }));
            for own in &scheme.program.evolved {
                let mut given = Vec::new();
                let none = Given::Constant(0.0);
                let rates = self.rates(own, body, When::Kick, (none, &mut given));
                all.extend(rates.and_then(|rates| {
                    let of = |y: &[Traced], x: &[Traced]| rates.of::<D>(own.update, y, x);
                    self.advance((own.field, own.residual), to, given, of)
                }));
            }
        }
        all
    }

    /// The same of a field of a body, and of what rounding loses of it, by its rate, which is made of its values and further numbers.
    fn advance(
        &mut self,
        (field, residual): (Field, Option<Field>),
        (body, kept, combines): (usize, Kept<'_>, bool),
        further: Vec<Given>,
        rate: impl Fn(&[Traced], &[Traced]) -> Vec<Traced>,
    ) -> Option<Action> {
        let width = field.components(D);
        let residual = residual.filter(|field| self.has(*field));
        let numbers = core::iter::once(field).chain(residual);
        let numbers = numbers.flat_map(|field| (0..width).map(move |k| (field, k)));
        let numbers: Vec<_> = numbers.collect();
        let present = numbers.iter().map(|&(field, k)| Given::Field(field, k));
        let before = numbers
            .iter()
            .map(|&(field, k)| Given::Column(kept(field, k)));
        let given = present.chain(before).chain([DT]).chain(self.shares());
        let given = given.chain(further).collect();
        let made = numbers.iter().map(|&(field, k)| {
            if combines {
                Made::Field(field, k)
            } else {
                Made::Column(kept(field, k))
            }
        });
        let name = format!("the field `{}`", self.group.scheme.program.name_of(field));
        let run = self.group.particles.bodies[body].run();
        let count = numbers.len();
        let step = PointStep::new(&name, &run, (given, made.collect()), |x| {
            let (now, rest) = x.split_at(count);
            let (before, rest) = rest.split_at(count);
            let [dt, a, b, more] = [0, 1, 2, 3].map(|k| rest[k]);
            let rates = rate(&now[..width], &rest[4..]);
            let (mut results, mut losses) = (Vec::new(), Vec::new());
            for (k, rate) in rates.into_iter().enumerate() {
                let [lost, lost_before] = [now, before].map(|own| residual.map(|_| own[width + k]));
                let (next, loss) = match (combines, lost, lost_before) {
                    (false, ..) => add(before[k], lost_before, dt * rate),
                    // From the present value, of which nothing is rounded away.
                    (true, Some(lost), Some(lost_before)) => {
                        let apart = (before[k] - now[k]) + (lost_before - lost);
                        let change = a * apart + dt * rate;
                        let (next, rest) = two_sum(now[k], lost + change);
                        let (next, further) = two_sum(next, more * now[k]);
                        add(next, Some(further), rest + more * lost)
                    }
                    (true, ..) => (a * before[k] + b * now[k] + dt * rate, None),
                };
                results.push(next);
                losses.extend(loss);
            }
            results.extend(losses);
            results
        });
        self.keep(&name, step)
    }
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Keeps the present state in a slot of an integrator, or brings it back.
    pub fn begin_state(&mut self, slot: usize, saves: bool) -> Moment {
        self.keeps_states = true;
        self.forget_travel();
        let state = &mut self.simulation.state;
        if saves {
            state.save_impulses(slot);
        } else {
            state.load_impulses(slot);
        }
        self.begin_kick(0.0)
    }

    /// Begins `a` · kept + `b` · present + `dt` · rates, the state that is present then, with the forces \[N\] between blocks of these
    /// rates, group by group.
    pub fn begin_combination(
        &mut self,
        slot: usize,
        [a, b, dt]: [f64; 3],
        forces: &[Forces<D>],
    ) -> Moment {
        let rates = self.with_forces(forces, |own| own.impulse_rates());
        self.forget_travel();
        let state = &mut self.simulation.state;
        state.combine_impulses(slot, [a, b, dt], &rates);
        Moment {
            shares: [a, b, a + b - 1.0],
            ..self.begin_kick(dt)
        }
    }

    /// Begins to add `dt` · rates to a kept state, with the forces \[N\] between blocks of these rates, group by group.
    pub fn begin_accumulation(&mut self, slot: usize, dt: f64, forces: &[Forces<D>]) -> Moment {
        let rates = self.with_forces(forces, |own| own.impulse_rates());
        self.simulation.state.accumulate_impulses(slot, &rates, dt);
        self.begin_kick(dt)
    }

    /// Columns of the states that are kept within a step.
    fn places_of_states(&self, group: usize) -> impl Iterator<Item = Range<usize>> {
        let program = &self.recorded[group].program;
        let width: usize = program.state.iter().map(|own| own.components(D)).sum();
        let states = program.states.iter().filter(|_| self.keeps_states);
        states.map(move |own| own.first..own.first + width)
    }

    pub(super) fn states_wanted(&self, group: usize) -> Vec<(Array, usize, usize)> {
        let slots = self.recorded[group].layout.slots;
        let own = self.places_of_states(group);
        own.map(|own| (Array::Columns, own.start * slots, own.len() * slots))
            .collect()
    }

    /// Takes the states that are kept back, as many as are wanted, so that they follow what list builds do.
    pub(super) fn take_states(&mut self, group: usize, found: &[&[f64]]) {
        let slots = self.recorded[group].layout.slots;
        let program = self.recorded[group].program.clone();
        let own = &mut self.simulation.state.groups[group];
        let fields: Vec<_> = state(&own.scheme.program).collect();
        let of = |numbers: &&[f64]| {
            let mut rest = *numbers;
            let mut all: Saved<T> = Vec::new();
            for &field in &fields {
                let is_there = program.state.contains(&field);
                let width = if is_there { field.components(D) } else { 0 };
                let (own, behind) = rest.split_at(width * slots);
                let number = |n: usize| T::from_f64(own[n % width * slots + n / width]);
                all.push((field, (0..own.len()).map(number).collect()));
                rest = behind;
            }
            all
        };
        own.work.kept = found.iter().map(of).collect();
    }

    pub(super) fn states_sent(&self, group: usize) -> Vec<(Array, usize, Vec<f64>)> {
        let Recorded { layout, .. } = &self.recorded[group];
        let kept = &self.simulation.state.groups[group].work.kept;
        let places = self.places_of_states(group).zip(kept);
        let of = |(place, kept): (Range<usize>, &Saved<T>)| {
            let mut numbers = Vec::new();
            for (field, column) in kept.iter().filter(|own| !own.1.is_empty()) {
                let width = field.components(D);
                numbers.extend(
                    (0..width)
                        .flat_map(|k| column.iter().skip(k).step_by(width).map(|x| x.to_f64())),
                );
            }
            (Array::Columns, place.start * layout.slots, numbers)
        };
        places.map(of).collect()
    }
}
