//! Kicks, drifts, predictions and displacements as records.
//! They are the driver's own, and the same for all schemes.

use super::program::{Action, Given, KeepStep, Made, SweepStep};
use super::record::{DT, HALF, Recorder, add, carried, evaluated};
use super::travel::{DRIFT, KICK};
use crate::effect::When;
use crate::particles::{Field, Fields, Output};
use crate::scalar::{Lane, Real, Traced};
use crate::scheme::EnergyForm;
use crate::sweep::Pass;
use crate::term::Stage;

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    pub(super) fn kick(&mut self) -> Vec<Action> {
        let summed = self.group.scheme.sums(Stage::Rates).contains(Output::FORCE);
        let mut given = vec![DT, Given::Field(Field::MASS, 0)];
        for d in 0..D {
            given.push(Given::Field(Field::VELOCITY, d));
            given.push(if summed {
                Given::Rate(Output::FORCE, d)
            } else {
                Given::Constant(0.0)
            });
            given.push(evaluated::<D>(d));
        }
        let made = (0..D).map(|d| Made::Field(Field::VELOCITY, d)).collect();
        self.on_each(KICK, self.bodies(), (given, made), |x| {
            let own = |d: usize| {
                let [v, force, gravity] = [0, 1, 2].map(|k| x[2 + 3 * d + k]);
                v + x[0] * (force / x[1] + gravity)
            };
            (0..D).map(own).collect()
        })
    }

    /// e ← e + dt P/m.
    fn heat(&mut self, power: Given) -> Vec<Action> {
        let given = vec![
            Given::Field(Field::ENERGY, 0),
            Given::Field(Field::MASS, 0),
            power,
            DT,
        ];
        let made = vec![Made::Field(Field::ENERGY, 0)];
        self.on_each("energy", self.bodies(), (given, made), |x| {
            vec![x[0] + x[3] * x[2] / x[1]]
        })
    }

    /// What the work of a kick needs of an evaluation: the velocities with which the rates were summed, or all that its sweep read.
    pub(super) fn keep_rates(&mut self) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        if scheme.energy != EnergyForm::Compatible {
            return Vec::new();
        }
        if scheme.sweeps_work() {
            let Some(Action::Sweep(work)) = self.pass(Stage::Rates, Pass::Work, &self.bodies())
            else {
                return Vec::new();
            };
            return self.keep_records(&work, work.pair.reads);
        }
        let mut given: Vec<_> = (0..D).map(|d| Given::Field(Field::VELOCITY, d)).collect();
        let made = (0..D).map(|d| Made::Field(Field::MEAN_VELOCITY, d));
        let mut made: Vec<_> = made.collect();
        if let Some(own) = self.program.own_forces {
            given.extend((0..D).map(|d| Given::Rate(Output::FORCE, d)));
            made.extend((0..D).map(|d| Made::Column(own + d)));
        }
        self.on_each("summed velocities", self.bodies(), (given, made), |x| {
            x.to_vec()
        })
    }

    fn keep_records(&self, work: &SweepStep, fields: Fields) -> Vec<Action> {
        let image = self.image(fields);
        let keep = |image| KeepStep {
            reads: work.pair.reads,
            fields,
            image,
        };
        // What cannot be recorded is refused with the sweep.
        let all = image.into_iter().map(keep);
        all.map(|keep| Action::Keep(Box::new(keep))).collect()
    }

    /// The work of pair forces in a kick, with its mean velocities v̄ = v + a dt/2, by a sweep: e ← e + dt P/m.
    fn heat_by_sweep(&mut self) -> Vec<Action> {
        let Some(Action::Sweep(work)) = self.pass(Stage::Rates, Pass::Work, &self.bodies()) else {
            return Vec::new();
        };
        let mut given = vec![HALF, Given::Field(Field::MASS, 0)];
        for d in 0..D {
            given.extend([Given::Field(Field::VELOCITY, d), evaluated::<D>(d)]);
            given.push(Given::Rate(Output::FORCE, d));
        }
        let means = [Field::MEAN_VELOCITY, Field::MEAN_ACCELERATION];
        let made = means.map(|field| (0..D).map(move |d| Made::Field(field, d)));
        let made = made.into_iter().flatten().collect();
        let mut all = self.on_each("mean velocities", self.bodies(), (given, made), |x| {
            let acceleration = x[2..].chunks_exact(3).map(|own| own[2] / x[1] + own[1]);
            let acceleration: Vec<_> = acceleration.collect();
            let mean = x[2..].chunks_exact(3).zip(&acceleration);
            let mean: Vec<_> = mean.map(|(own, a)| own[0] + x[0] * *a).collect();
            [mean, acceleration].concat()
        });
        all.extend(self.keep_records(&work, Fields::of(&means)));
        all.push(Action::Sweep(work));
        all.extend(self.heat(Given::Sum(Output::POWER, 0)));
        all.extend(self.heat_of_laws());
        all
    }

    /// Energy in a kick: by the power of the rates, by a sweep of its own, or e ← e + dt (P − Fᵢ·(v̄ᵢ − uᵢ))/m with its mean
    /// velocities v̄ and those u of the rates.
    pub(super) fn heat_in_kick(&mut self) -> Vec<Action> {
        if self.group.scheme.energy != EnergyForm::Compatible {
            return self.heat(Given::Rate(Output::POWER, 0));
        }
        if self.group.scheme.sweeps_work() {
            return self.heat_by_sweep();
        }
        let mut given = vec![
            Given::Field(Field::ENERGY, 0),
            Given::Field(Field::MASS, 0),
            Given::Rate(Output::POWER, 0),
            DT,
            HALF,
        ];
        for d in 0..D {
            given.push(Given::Field(Field::VELOCITY, d));
            given.push(Given::Field(Field::MEAN_VELOCITY, d));
            let force = Given::Rate(Output::FORCE, d);
            let own = self.program.own_forces;
            given.extend([force, own.map_or(force, |own| Given::Column(own + d))]);
            given.push(evaluated::<D>(d));
        }
        let made = vec![Made::Field(Field::ENERGY, 0)];
        self.on_each("work", self.bodies(), (given, made), |x| {
            let [energy, mass, power, dt, half] = [x[0], x[1], x[2], x[3], x[4]];
            let mut spent = Traced::of(0.0);
            for own in x[5..].chunks_exact(5) {
                let since = own[0] + half * (own[2] / mass + own[4]) - own[1];
                spent += own[3] * since;
            }
            vec![energy + dt * (power - spent) / mass]
        })
    }

    /// Places, with what rounding loses of them where that is kept.
    fn places(&self) -> (Vec<Given>, Vec<Made>) {
        let fields = [Field::POSITION, Field::POSITION_RESIDUAL];
        let fields = fields.into_iter().filter(|field| self.has(*field));
        let all: Vec<_> = fields
            .flat_map(|field| (0..D).map(move |d| (field, d)))
            .collect();
        (
            all.iter()
                .map(|&(field, d)| Given::Field(field, d))
                .collect(),
            all.iter()
                .map(|&(field, d)| Made::Field(field, d))
                .collect(),
        )
    }

    pub(super) fn moves(&mut self, dt: Given) -> Vec<Action> {
        if !self.group.scheme.program.moves {
            return Vec::new();
        }
        let (mut given, made) = self.places();
        let (lost, first) = (given.len() > D, given.len());
        given.push(dt);
        given.extend((0..D).map(|d| Given::Field(Field::VELOCITY, d)));
        self.on_each(DRIFT, self.bodies(), (given, made), |x| {
            displaced::<D>(x, lost, |d| x[first] * x[first + 1 + d])
        })
    }

    /// By velocities over the first of the shared numbers, and then by accelerations times the second.
    pub(super) fn shift(&mut self) -> Vec<Action> {
        let mut all = self.moves(DT);
        if all.is_empty() {
            return all;
        }
        let (mut given, made) = self.places();
        let (lost, first) = (given.len() > D, given.len());
        given.extend([HALF, Given::Field(Field::MASS, 0)]);
        given.extend((0..D).map(|d| Given::Rate(Output::FORCE, d)));
        given.extend((0..D).map(evaluated::<D>));
        all.extend(self.on_each("shift", self.bodies(), (given, made), |x| {
            let own = &x[first..];
            displaced::<D>(x, lost, |d| own[0] * (own[2 + d] / own[1] + own[2 + D + d]))
        }));
        all
    }

    /// How far particles have moved since lists were built, but for what a container takes with it.
    pub(super) fn moved(&mut self) -> Vec<Action> {
        // Lists of the reference configuration stay.
        if self.group.scheme.density.keeps_neighbors() {
            return Vec::new();
        }
        let mut given: Vec<_> = (0..D).map(|d| Given::Field(Field::POSITION, d)).collect();
        given.extend((0..D).map(Given::Listed));
        given.extend((0..D).map(carried::<D>));
        let length = self.or(Field::SMOOTHING_LENGTH, 0.0);
        let listed = match length {
            Given::Constant(_) => length,
            _ => Given::Listed(D),
        };
        given.extend([length, listed]);
        let made = (0..2 + D).map(Made::Column).collect();
        self.on_each("displacement", self.everywhere(), (given, made), |x| {
            let by: Vec<_> = (0..D).map(|d| x[d] - x[D + d] - x[2 * D + d]).collect();
            let zero = Traced::of(0.0);
            let square = by.iter().fold(zero, |sum, own| sum + *own * *own);
            [&[square], &by[..], &[x[3 * D] - x[3 * D + 1]]].concat()
        })
    }

    pub(super) fn predictions(&mut self) {
        let saved: Vec<Field> = self
            .group
            .kicked()
            .filter(|field| self.has(*field))
            .collect();
        let all: Vec<_> = saved
            .iter()
            .flat_map(|&field| (0..field.components(D)).map(move |k| (field, k)))
            .collect();
        let given = all
            .iter()
            .map(|&(field, k)| Given::Field(field, k))
            .collect();
        let made = all
            .iter()
            .map(|&(field, k)| Made::Saved(field, k))
            .collect();
        let same = |x: &[Traced]| x.to_vec();
        let mut predict = self.on_each("saved state", self.bodies(), (given, made), same);
        predict.extend(self.kick());
        predict.extend(self.evolve(When::Kick));
        if self.group.scheme.energy != EnergyForm::None {
            predict.extend(self.heat(Given::Rate(Output::POWER, 0)));
        }
        let given = all
            .iter()
            .map(|&(field, k)| Given::Saved(field, k))
            .collect();
        let made = all
            .iter()
            .map(|&(field, k)| Made::Field(field, k))
            .collect();
        self.program.restore = self.on_each("restored state", self.bodies(), (given, made), same);
        (self.program.predict, self.program.saved) = (predict, saved);
    }
}

/// Places and their losses after a displacement.
fn displaced<const D: usize>(
    x: &[Traced],
    lost: bool,
    by: impl Fn(usize) -> Traced,
) -> Vec<Traced> {
    let (mut places, mut losses) = (Vec::new(), Vec::new());
    for d in 0..D {
        let (place, loss) = add(x[d], lost.then(|| x[D + d]), by(d));
        places.push(place);
        losses.extend(loss);
    }
    places.extend(losses);
    places
}
