//! What sources and drains do between steps: particles that are due appear and leave, and how many there were.
//! The mass that has passed is within half a particle of the integral of the rate.

use super::Simulation;
use super::group::Group;
use super::population::Passed;
use crate::boundary::{Drain, Source};
use crate::error::{Error, Result};
use crate::particles::Field;
use crate::scalar::Real;

/// Distance in spacings of the body within which a point of a source is covered.
const COVERED: f64 = 0.9;

/// A part of the spacing to which depths within a drain are told apart, so that their rounding does not choose who leaves.
const TOLD_APART: f64 = 1e-6;

/// A source of a group.
#[derive(Clone, Debug)]
pub(crate) struct SourceState<const D: usize> {
    /// With points that are counted from the origin of the group.
    pub source: Source<D>,
    /// The body that it feeds, of the group.
    pub body: usize,
    /// How many particles have entered, and whose turn is next.
    pub entered: u64,
    pub next: u64,
}

/// A drain of a group.
#[derive(Clone, Debug)]
pub(crate) struct DrainState<const D: usize> {
    pub drain: Drain<D>,
    /// Mass \[kg\] that is due at `time` \[s\].
    pub due: f64,
    pub time: f64,
}

impl<const D: usize> SourceState<D> {
    pub fn new(source: &Source<D>, body: usize, origin: &[f64; D]) -> Self {
        Self {
            source: source.seen_from(origin),
            body,
            entered: 0,
            next: 0,
        }
    }
}

impl<const D: usize> DrainState<D> {
    pub fn new(drain: &Drain<D>) -> Self {
        Self {
            drain: drain.clone(),
            due: 0.0,
            time: 0.0,
        }
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Lets particles of sources enter that are due at `time` \[s\]; whether there were any.
    ///
    /// # Errors
    /// If a body's reserve is used up, or as many particles wait as a source has points.
    pub(super) fn feed(&mut self, time: f64) -> Result<bool> {
        let mut sources = core::mem::take(&mut self.sources);
        let fed = sources
            .iter_mut()
            .try_fold(false, |any, own| Ok(self.feed_by(own, time)? || any));
        self.sources = sources;
        fed
    }

    fn feed_by(&mut self, own: &mut SourceState<D>, time: f64) -> Result<bool> {
        let body = &self.particles.bodies[own.body];
        let each = body.material.reference_density() * body.spacing.powi(D as i32);
        let all = own.source.supply.between([f64::NEG_INFINITY, time]);
        let due = |entered: u64| all - (entered as f64 + 0.5) * each;
        if due(own.entered) < 0.0 {
            return Ok(false);
        }
        let (near, points) = (COVERED * body.spacing, &own.source.points);
        let name = body.name.clone();
        let is_near = |a: &[f64; D], b: &[f64; D]| {
            let square: f64 = (0..D).map(|d| (a[d] - b[d]).powi(2)).sum();
            square < near * near
        };
        let x = self.particles.columns.vectors(Field::POSITION);
        let x = x.iter().map(|x| x.map(Real::to_f64));
        let mut covering: Vec<[f64; D]> = x
            .filter(|x| points.iter().any(|point| is_near(x, point)))
            .collect();
        let (count, before) = (points.len() as u64, own.entered);
        for _ in 0..count {
            let point = own.source.points[own.next as usize];
            own.next = (own.next + 1) % count;
            if covering.iter().any(|x| is_near(x, &point)) {
                continue;
            }
            let state = [point, own.source.velocity];
            self.particles.insert(&self.scheme, own.body, state, None)?;
            covering.push(point);
            own.entered += 1;
            if due(own.entered) < 0.0 {
                break;
            }
        }
        if due(own.entered) > count as f64 * each {
            return Err(Error::Function {
                what: format!(
                    "mass that waits at the source of body `{name}`, whose points are covered,"
                ),
                value: all - own.entered as f64 * each,
                time,
                must_be: "it must be below that of a particle a point, in kg: give the source more points, points in the open, a \
                          velocity, or a lower rate",
            });
        }
        Ok(own.entered > before)
    }

    /// Takes out what drains take by `time` \[s\]; whether there was any.
    pub(super) fn drain(&mut self, time: f64) -> bool {
        let mut drains = core::mem::take(&mut self.drains);
        let mut any = false;
        for own in &mut drains {
            own.due += own.drain.supply.between([own.time, time]);
            own.time = time;
            any |= self.drain_by(own);
        }
        self.drains = drains;
        any
    }

    fn drain_by(&mut self, own: &mut DrainState<D>) -> bool {
        let columns = &self.particles.columns;
        let mass = columns.raw(Field::MASS);
        let takes = |body: usize| {
            let name = &self.particles.bodies[body].name;
            let only = own.drain.body.as_ref();
            !self.held.is_rigid(body) && only.is_none_or(|only| only == name)
        };
        let bodies = (0..self.particles.bodies.len()).filter(|&body| takes(body));
        let slots = bodies.flat_map(|body| self.particles.bodies[body].slots.clone());
        let least = slots
            .clone()
            .map(|slot| mass[slot].to_f64())
            .fold(f64::INFINITY, f64::min);
        if own.due < 0.5 * least {
            return false;
        }
        let spacing = self.particles.bodies.iter().map(|body| body.spacing);
        let step = TOLD_APART * spacing.fold(f64::INFINITY, f64::min);
        let mut within: Vec<(i64, u32, usize)> = slots
            .filter_map(|slot| {
                let depth = own
                    .drain
                    .shape
                    .signed_distance(&self.particles.position(slot));
                let rank = (depth / step).round() as i64;
                (rank <= 0).then_some((rank, self.particles.ids[slot], slot))
            })
            .collect();
        within.sort_unstable();
        let mut leaving = Vec::new();
        for &(_, _, slot) in &within {
            let mass = mass[slot].to_f64();
            if own.due < 0.5 * mass {
                break;
            }
            own.due -= mass;
            leaving.push(slot);
        }
        if leaving.len() == within.len() {
            own.due = own.due.min(0.0);
        }
        if leaving.is_empty() {
            return false;
        }
        leaving.sort_unstable();
        let order = self
            .particles
            .take_out(|_| false, |_, slot| leaving.binary_search(&slot).is_ok());
        self.work.rates.permute(&order);
        true
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// What has entered through [inlets](crate::boundary::Inlet) and [sources](crate::boundary::Source), with the mass, momentum and
    /// kinetic energy that it brought: the mass of bodies is that at the start and this, less what was
    /// [removed](Self::removed).
    #[must_use]
    pub fn entered(&self) -> Passed<D> {
        let groups = self.state.groups.iter();
        let entered = groups.map(|group| &group.particles.entered);
        entered.fold(Passed::default(), |sum, other| sum.and(other))
    }
}
