//! Laws of effects as records, on each body and wall, with what their constants are when these depend on time.
//! A law whose text depends on time otherwise is refused.

use super::lengths::{change, limited, open};
use super::program::{Action, Given, Kind, Made, PointStep};
use super::record::{DT, Recorder, Sums, add, gravity};
use crate::effect::{Around, Law, PointRecord};
use crate::particles::Field;
use crate::scalar::{Lane, Real, Traced};
use crate::simulation::Group;
use crate::term::Stage;

/// A law whose numbers depend on when it acts, with the body or wall on which it does.
#[derive(Clone, Debug)]
pub(super) struct Timed {
    pub stage: Stage,
    pub law: usize,
    pub part: Of,
    pub in_drift: bool,
}

/// A body or a wall.
#[derive(Clone, Copy, Debug)]
pub(super) enum Of {
    Body(usize),
    Wall(usize),
}

/// Where laws act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Gate {
    /// On all particles.
    None,
    /// On particles that have not settled, whose changes and limits are noted in columns.
    Open,
}

/// When something acts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acting<const D: usize> {
    pub time: f64,
    pub dt: f64,
    pub gravity: [f64; D],
    pub in_drift: bool,
}

impl<T: Real, const D: usize> Recorder<'_, T, D> {
    pub(super) fn laws_of_bodies(&mut self, stage: Stage, sums: Sums) -> Vec<Action> {
        let bodies = 0..self.group.particles.bodies.len();
        bodies
            .flat_map(|body| self.laws(stage, Of::Body(body), sums, Gate::None))
            .collect()
    }

    pub(super) fn laws(&mut self, stage: Stage, part: Of, sums: Sums, gate: Gate) -> Vec<Action> {
        let scheme = self.group.scheme.clone();
        let laws = &scheme.program.laws[stage.number()];
        let mut all = Vec::new();
        for (number, law) in laws.iter().enumerate() {
            all.extend(self.law((stage, number), &**law, (part, gate), sums));
        }
        all
    }

    fn law(
        &mut self,
        (stage, number): (Stage, usize),
        law: &dyn Law<T, D>,
        (part, gate): (Of, Gate),
        sums: Sums,
    ) -> Option<Action> {
        let in_drift = self.in_drift;
        let of = |time: f64, dt: f64| {
            let gravity = self.group.gravity.map(|g| g + time);
            let acting = Acting {
                time,
                dt,
                gravity,
                in_drift,
            };
            record_law(self.group, law, part, acting)
        };
        let name = format!("the law `{}`", law.name());
        let (Some(own), Some(later)) = (of(0.0, 1.0), of(1.0, 0.0)) else {
            let what = format!("{name} does not run on a device: it loops over columns itself");
            self.refuse(what, "write it as a PointLaw");
            return None;
        };
        let record = match own.record {
            Ok(record) => record,
            Err(error) => {
                self.keep(&name, Err(error));
                return None;
            }
        };
        if own.double && T::COMPENSATED {
            let what = format!("{name} computes in f64 where particles are stored in f32");
            self.refuse(what, "run the scene in f64 on the device, or on the host");
            return None;
        }
        let same = |other: &PointRecord| other.record.as_ref() == Ok(&record);
        if !same(&later) {
            let what = format!(
                "{name} does not run on a device: it depends on time by more than its constants"
            );
            self.refuse(what, "give what depends on time by PointLaw::prepare");
            return None;
        }
        let is_timed = own.constants != later.constants || own.acts != later.acts;
        if !is_timed && !own.acts {
            return None;
        }
        // One of acting, and the constants, where they depend on time.
        let first = self.place_of_timed();
        if is_timed {
            self.timed.push(Timed {
                stage,
                law: number,
                part,
                in_drift,
            });
        }
        let constant = |k: usize| {
            if is_timed {
                Given::Shared(first + 1 + k)
            } else {
                Given::Constant(own.constants[k])
            }
        };
        let field = |field: Field, k: usize| {
            if self.has(field) {
                Given::Field(field, k)
            } else {
                Given::Constant(0.0)
            }
        };
        let mut given = Vec::new();
        for own in own.fields.iter() {
            given.extend((0..own.components(D)).map(|k| field(own, k)));
        }
        for own in own.sums.iter() {
            given.extend((0..own.components(D)).map(|k| sums.given(own, k)));
        }
        given.extend((0..own.constants.len()).map(constant));
        given.extend([DT, Given::Constant(0.0)]);
        let at_wall = given.len();
        given.extend((0..2 * D + D * D).map(|k| match part {
            Of::Wall(_) => Given::Wall(k),
            Of::Body(_) => Given::Constant(0.0),
        }));
        let (inputs, mut made, mut moved) = (given.len(), Vec::new(), None);
        let moves = own.writes.contains(Field::POSITION);
        for own in own.writes.iter() {
            for k in 0..own.components(D) {
                if moves && own.is(Field::POSITION) {
                    moved = Some(made.len() - k);
                }
                let place = [Field::POSITION, Field::POSITION_RESIDUAL];
                made.push(if !self.has(own) || (moves && place.contains(&own)) {
                    Made::Nothing
                } else {
                    Made::Field(own, k)
                });
            }
        }
        let (run, live) = match part {
            Of::Body(k) => (
                self.group.particles.bodies[k].run(),
                self.group.particles.bodies[k].slots.clone(),
            ),
            Of::Wall(k) => {
                let wall = &self.group.walls[k];
                (wall.slots.start..wall.end, wall.slots.clone())
            }
        };
        let changes = law.repeats().is_some();
        let change_at = made.len() + 1;
        made.push(match gate {
            Gate::None => self.count(Kind::Limit(law.name()), live),
            Gate::Open => Made::Column(limited::<D>(number)),
        });
        made.extend(changes.then_some(Made::Column(change::<D>())));
        let fall = given.len();
        if let Of::Wall(_) = part {
            given.extend((0..D).map(gravity));
        }
        // Places and what they lose, and what is there if the law does not act.
        let lost = self.has(Field::POSITION_RESIDUAL);
        let places = given.len();
        if moved.is_some() {
            for field in [Field::POSITION, Field::POSITION_RESIDUAL] {
                if self.has(field) {
                    given.extend((0..D).map(|d| Given::Field(field, d)));
                    made.extend((0..D).map(|d| Made::Field(field, d)));
                }
            }
        }
        let before = given.len();
        let is_open = Some(Given::Column(open::<D>())).filter(|_| gate == Gate::Open);
        given.extend(is_timed.then_some(Given::Shared(first)));
        given.extend(is_open);
        let old = given.len();
        if old > before {
            given.extend(made.iter().map(|own| match *own {
                Made::Field(field, k) => Given::Field(field, k),
                Made::Column(k) => Given::Column(k),
                _ => Given::Constant(0.0),
            }));
        }
        let step = PointStep::new(&name, &run, (given, made), |x| {
            let mut own = x[..inputs].to_vec();
            if let Of::Wall(_) = part {
                // Gravity less the acceleration of the wall.
                for d in 0..D {
                    own[at_wall + d] = x[fall + d] - x[at_wall + d];
                }
            }
            let mut results = record.follow(&own);
            if let Some(moved) = moved {
                let mut residuals = Vec::new();
                for d in 0..D {
                    let residual = lost.then(|| x[places + D + d]);
                    let (y, residual) = add(x[places + d], residual, results[moved + d]);
                    results.push(y);
                    residuals.extend(residual);
                }
                results.extend(residuals);
            }
            if changes && gate == Gate::Open {
                results[change_at] = results[change_at].max(x[old + change_at]);
            }
            for own in &x[before..old] {
                let acts = own.gt(Traced::of(0.5));
                let old = &x[old..];
                for (new, old) in results.iter_mut().zip(old) {
                    *new = Lane::select(acts, *new, *old);
                }
            }
            results
        });
        self.keep(&name, step)
    }
}

/// What is around the particles of a body.
pub(super) fn around<T: Real, const D: usize>(
    group: &Group<T, D>,
    body: usize,
    acting: Acting<D>,
) -> Around<'_, T, D> {
    let body = &group.particles.bodies[body];
    Around {
        sums: &group.work.sums,
        material: &body.material,
        wall: None,
        smoothing_length: group.scheme.h_over_dx() * body.spacing,
        lattice_consistency_factor: group.scheme.lattice_consistency_factor,
        dt: acting.dt,
        time: acting.time,
        gravity: acting.gravity,
        origin: group.particles.origin,
        in_drift: acting.in_drift,
    }
}

/// A law as it acts on a body or a wall.
pub(super) fn record_law<T: Real, const D: usize>(
    group: &Group<T, D>,
    law: &dyn Law<T, D>,
    part: Of,
    acting: Acting<D>,
) -> Option<PointRecord> {
    let there = group.particles.columns.fields();
    let own = law.reads().union(law.writes());
    let there = own.minus(own.minus(there));
    match part {
        Of::Body(body) => law.record(&around(group, body, acting), there),
        Of::Wall(number) => {
            let wall = &group.walls[number];
            let surface = wall.surface(&group.particles.ids, acting.time, false);
            let around = Around {
                wall: Some(&surface),
                smoothing_length: group.neighborhood.smoothing_length,
                dt: 0.0,
                ..around(group, 0, acting)
            };
            law.record(&around, there)
        }
    }
}
