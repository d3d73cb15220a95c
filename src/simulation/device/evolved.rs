//! Evolved fields as records: their rates, how they change, and what rounding loses of them.
//! The text is that of the host's updates, for one particle.

use super::images::square;
use super::laws::{Acting, around};
use super::program::{Action, Given, Kind, Made, PointStep};
use super::record::{DT, Recorder, Sums, add};
use crate::effect::gradients::{GRADIENT_SUMS, SINGULAR};
use crate::effect::{Evolved, Update, View, When};
use crate::particles::Field;
use crate::scalar::{Lane, Real, Record, Traced};
use crate::tensor::{Square, Symmetric};
use crate::term::Stage;
use std::ops::Range;

/// eˣ − 1 as the host has it.
fn expm1<L: Lane>(x: L) -> L {
    let term = |n: f64| L::of(1.0 / n);
    let series =
        x * (L::one() + x * (term(2.0) + x * (term(6.0) + x * (term(24.0) + x * term(120.0)))));
    L::select(x.abs().gt(L::of(0.01)), x.exp() - L::one(), series)
}

/// ½ (∇v − ∇vᵀ) from the velocity gradient, or from its sum and that of the moments that correct it.
fn spin<const D: usize>(numbers: &[Traced]) -> Square<Traced, D> {
    let (gradient, moments) = numbers.split_at(D * D);
    let mut gradient = square::<D>(gradient);
    if !moments.is_empty() {
        gradient = gradient.times(&square(moments).inverse(SINGULAR).0);
    }
    let apart = gradient.plus(Traced::of(-1.0), &gradient.transposed());
    apart.scaled(Traced::of(0.5))
}

/// Records of the rates of a field, each with the places of its inputs and whether it is a growth.
pub(super) struct FieldRates {
    all: Vec<(Record, Range<usize>, bool)>,
    /// Where what turns tensors starts.
    turning: usize,
}

impl FieldRates {
    /// The sums of growths and of sources.
    fn sums(&self, x: &[Traced], width: usize) -> (Traced, Vec<Traced>) {
        let mut growth = Traced::of(0.0);
        let mut sources = vec![Traced::of(0.0); width];
        for (record, at, is_growth) in &self.all {
            let found = record.follow(&x[at.clone()]);
            if *is_growth {
                growth += found[0];
            } else {
                let both = sources.iter_mut().zip(found);
                both.for_each(|(sum, own)| *sum += own);
            }
        }
        (growth, sources)
    }

    /// dY/dt = g Y + s of a field with values Y, from the sums of growths g and of sources s. A length grows by g/D in D dimensions, and
    /// of a tensor that turns with the spin W there is W Y − Y W, too.
    pub fn of<const D: usize>(&self, update: Update, y: &[Traced], x: &[Traced]) -> Vec<Traced> {
        let (growth, mut rates) = self.sums(x, y.len());
        // A length spans a volume.
        let share = match update {
            Update::Within { .. } => Traced::of(D as f64),
            _ => Traced::of(1.0),
        };
        for (rate, y) in rates.iter_mut().zip(y) {
            *rate = *y * growth / share + *rate;
        }
        if update == Update::Rotated {
            let tensor = Symmetric::new(core::array::from_fn(|k| y[k]));
            let turn = spin::<D>(&x[self.turning..]).spun(&tensor);
            for (rate, turn) in rates.iter_mut().zip(turn.components()) {
                *rate += *turn;
            }
        }
        rates
    }
}

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    pub(super) fn evolve(&mut self, when: When) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        let mut all = Vec::new();
        for own in &scheme.program.evolved {
            if own.when != when || own.field == Field::ENERGY {
                continue;
            }
            for body in 0..self.group.particles.bodies.len() {
                all.extend(self.update(own, body));
            }
        }
        all
    }

    /// The rates of a field of a body in a kick or a drift, whose inputs are added to `given`; what they see as a step is given, too.
    pub(super) fn rates(
        &mut self,
        own: &Evolved<T, D>,
        body: usize,
        when: When,
        (step, given): (Given, &mut Vec<Given>),
    ) -> Option<FieldRates> {
        let scheme = self.group.scheme.clone();
        let name = format!("the field `{}`", scheme.program.name_of(own.field));
        let sums = match when {
            When::Kick => Sums {
                of_rates: true,
                there: scheme.sums(Stage::Rates),
            },
            When::Drift => Sums {
                of_rates: false,
                there: scheme.sums(Stage::Continuity),
            },
        };
        let acting = Acting {
            time: 0.0,
            dt: 1.0,
            gravity: self.group.gravity,
            in_drift: when == When::Drift,
        };
        let around = around(self.group, body, acting);
        let view = View::new(&self.group.particles.columns, around);
        let mut all = Vec::new();
        for rate in &own.rates {
            let Some(part) = rate.record(&view.of_rate(&**rate, own.field)) else {
                let what = format!(
                    "a rate of {name} does not run on a device: it loops over columns itself"
                );
                self.refuse(what, "write it as a PointRate");
                return None;
            };
            if !part.acts {
                continue;
            }
            let record = match part.record {
                Ok(record) => record,
                Err(error) => {
                    self.keep(&format!("a rate of {name}"), Err(error));
                    return None;
                }
            };
            let first = given.len();
            for field in part.fields.iter() {
                given.extend((0..field.components(D)).map(|k| {
                    if self.has(field) {
                        Given::Field(field, k)
                    } else {
                        Given::Constant(0.0)
                    }
                }));
            }
            for sum in part.sums.iter() {
                given.extend((0..sum.components(D)).map(|k| sums.given(sum, k)));
            }
            given.extend(part.constants.map(Given::Constant));
            given.extend([step, Given::Field(own.field, 0)]);
            all.push((record, first..given.len(), part.growth));
        }
        let turning = given.len();
        if own.update == Update::Rotated {
            let [gradient, moments] = GRADIENT_SUMS;
            if sums.there.contains(gradient) {
                let both =
                    [gradient, moments].map(|sum| (0..D * D).map(move |k| sums.given(sum, k)));
                given.extend(both.into_iter().flatten());
            } else {
                let all = (0..D * D).map(|k| Given::Field(Field::VELOCITY_GRADIENT, k));
                given.extend(all);
            }
        }
        Some(FieldRates { all, turning })
    }

    /// A field of a body over a step as its declaration says.
    fn update(&mut self, own: &Evolved<T, D>, body: usize) -> Option<Action> {
        let scheme = self.group.scheme.clone();
        let name = format!("the field `{}`", scheme.program.name_of(own.field));
        let width = own.field.components(D);
        let mut given: Vec<_> = (0..width).map(|k| Given::Field(own.field, k)).collect();
        let residual = own.residual.filter(|field| self.has(*field));
        if let Some(field) = residual {
            given.extend((0..width).map(|k| Given::Field(field, k)));
        }
        given.push(DT);
        let step_at = given.len() - 1;
        let rates = self.rates(own, body, own.when, (DT, &mut given))?;
        let mut made: Vec<_> = (0..width).map(|k| Made::Field(own.field, k)).collect();
        if let Some(field) = residual {
            made.extend((0..width).map(|k| Made::Field(field, k)));
        }
        let held = &self.group.particles.bodies[body];
        let (run, live) = (held.run(), held.slots.clone());
        if matches!(own.update, Update::Within { .. }) {
            made.push(self.count(Kind::Limit(scheme.program.name_of(own.field)), live));
        }
        let h = scheme.h_over_dx() * held.spacing;
        let step = PointStep::new(&name, &run, (given, made), |x| {
            let dt = x[step_at];
            let (growth, mut sources) = rates.sums(x, width);
            if own.update == Update::Rotated {
                for (source, y) in sources.iter_mut().zip(x) {
                    *source += *y * growth;
                }
                let spin = spin::<D>(&x[rates.turning..]);
                let of = |numbers: &[Traced]| Symmetric::new(core::array::from_fn(|k| numbers[k]));
                let moved = of(&x[..width]).plus(dt, &of(&sources));
                let turn = Square::rotation(&spin.scaled(dt));
                return turn.turned(&moved).components().to_vec();
            }
            let (mut results, mut lost) = (Vec::new(), Vec::new());
            for k in 0..width {
                let y = x[k];
                let change = match own.update {
                    Update::Increment => dt * (y * growth + sources[k]),
                    Update::Exponential => y * expm1(growth * dt) + dt * sources[k],
                    Update::Within { smallest, largest } => {
                        let next = y * (growth * dt / Traced::of(D as f64)).exp();
                        let held = next.max(Traced::of(smallest * h));
                        let held = held.min(Traced::of(largest * h));
                        let moved = held.lt(next) | next.lt(held);
                        results.push(held);
                        lost.push(Lane::select(moved, Traced::of(1.0), Traced::of(0.0)));
                        continue;
                    }
                    // Turned as a whole before.
                    Update::Rotated => continue,
                };
                let (next, rest) = add(y, residual.map(|_| x[width + k]), change);
                results.push(next);
                lost.extend(rest);
            }
            results.extend(lost);
            results
        });
        self.keep(&name, step)
    }
}
