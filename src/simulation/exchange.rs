//! Schemes that a group takes in exchange for its own when an event happens: effects with pair terms in a window of time.
//! Each is a step program of its own, so a step pays for nothing that is not in force.

use super::Simulation;
use super::population::Particles;
use super::run_state::State;
use super::workspace::Workspace;
use crate::error::Result;
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use crate::scheme::Scheme;
use std::sync::Arc;

/// A scheme that a group obeys from an event on.
#[derive(Clone, Debug)]
pub(crate) struct Exchange<T: Real, const D: usize> {
    /// The number of the event; none for the scheme that it starts with.
    pub event: Option<usize>,
    pub scheme: Arc<Scheme<T, D>>,
    /// What a particle carries under it.
    pub fields: Fields,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Gives groups the schemes that are in force by what has happened; whether any changed.
    pub(super) fn exchange_schemes(&mut self) -> bool {
        let mut any = false;
        let State {
            groups, happened, ..
        } = &mut *self.state;
        for group in groups {
            // The last in time, and of those at once the last that was named.
            let mut last = (f64::NEG_INFINITY, None);
            for (k, own) in group.exchanges.iter().enumerate() {
                let since = match own.event {
                    Some(event) => happened[event].1,
                    None => Some(f64::NEG_INFINITY),
                };
                if let Some(since) = since.filter(|since| *since >= last.0) {
                    last = (since, Some(k));
                }
            }
            if let Some(k) = last.1
                && !Arc::ptr_eq(&group.exchanges[k].scheme, &group.scheme)
            {
                let own = &group.exchanges[k];
                own.begin(&mut group.particles);
                group.scheme = own.scheme.clone();
                group.work = Workspace {
                    phases: group.work.phases,
                    spent: group.work.spent,
                    lengths_time: group.work.lengths_time,
                    evaluated_gravity: group.work.evaluated_gravity,
                    ..Workspace::default()
                };
                any = true;
            }
        }
        any
    }

    /// The same after a step, and clamps that begin or end, with rates anew where any changed.
    pub(super) fn follow_events(&mut self) -> Result<()> {
        let held = self.follow_clamps(true);
        if self.exchange_schemes() || held {
            self.forget_rates();
            self.evaluate_together()?;
        }
        Ok(())
    }
}

impl<T: Real, const D: usize> Exchange<T, D> {
    /// Gives particles what they carry under its scheme. What that is beside what they carried before begins as at a start,
    /// and what they do not carry is forgotten.
    fn begin(&self, particles: &mut Particles<T, D>) {
        let columns = &mut particles.columns;
        let new = self.fields.minus(columns.fields());
        columns.set_fields(self.fields);
        for body in &particles.bodies {
            for slot in body.run() {
                self.scheme.begin(columns, slot, &body.material, new);
            }
        }
        if new.contains(Field::CORRECTION) {
            let slots = columns.slots();
            let rows = columns.raw_mut(Field::CORRECTION);
            // The liquid corrects the gradients; a wall takes them as they are.
            for slot in particles.mobile..slots {
                for d in 0..D {
                    rows[slot * D * D + d * (D + 1)] = T::one();
                }
            }
        }
    }
}
