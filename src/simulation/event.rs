//! Events: conditions on the state that are looked at after every step, and the times at which they first held.
//! Loads, clamps and users ask for them; a checkpoint keeps them.

use super::run_state::State;
use super::{Simulation, find};
use crate::error::Result;
use crate::scalar::Real;
use core::fmt;
use std::sync::Arc;

/// Whether something has happened, by the state after a step.
pub(crate) type Condition<T, const D: usize> = Arc<dyn Fn(&Simulation<T, D>) -> bool + Send + Sync>;

/// An event of a scene, and when it happened.
pub(crate) struct Event<T: Real, const D: usize> {
    pub name: String,
    pub condition: Condition<T, D>,
}

impl<T: Real, const D: usize> Clone for Event<T, D> {
    fn clone(&self) -> Self {
        Self {
            name: self.name.clone(),
            condition: self.condition.clone(),
        }
    }
}

impl<T: Real, const D: usize> fmt::Debug for Event<T, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Event({})", self.name)
    }
}

/// What has happened: the names of all events, and the time \[s\] of those that have.
pub(crate) type Happened = Vec<(String, Option<f64>)>;

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The time \[s\] at which an [event](crate::scene::Scene::event) first held, at the end of a step; nothing if it has not.
    ///
    /// # Errors
    /// If the scene has no such event; the error lists those that there are.
    pub fn event(&self, name: &str) -> Result<Option<f64>> {
        let all = self.state.happened.iter();
        let all = all.map(|(name, at)| (std::borrow::Cow::Borrowed(name.as_str()), *at));
        Ok(find(&name, "event", all)?.1)
    }

    /// The same with these events, none of which has happened.
    pub(crate) fn with_events(mut self, events: Vec<Event<T, D>>) -> Self {
        self.state.happened = events.iter().map(|own| (own.name.clone(), None)).collect();
        self.events = events;
        self
    }

    /// Looks at the conditions of what has not happened, after a step.
    pub(super) fn watch_events(&mut self) {
        for k in 0..self.events.len() {
            if self.state.happened[k].1.is_none() {
                let condition = self.events[k].condition.clone();
                if condition(self) {
                    self.state.happened[k].1 = Some(self.state.time);
                }
            }
        }
    }

    /// Lets clamps begin and end by what has happened, and, after a step, stops what they catch; whether any changed.
    pub(super) fn follow_clamps(&mut self, catches: bool) -> bool {
        let State {
            happened,
            groups,
            time,
            ..
        } = &mut *self.state;
        let has = |event: Option<usize>| event.map(|event| happened[event].1.is_some());
        let mut any = false;
        for group in groups {
            for k in 0..group.held.clamps.len() {
                let own = &mut group.held.clamps[k];
                let is_free = has(own.since) == Some(false) || has(own.until) == Some(true);
                let changed = core::mem::replace(&mut own.is_free, is_free) != is_free;
                if changed && catches && !is_free {
                    group.held.take_hold(k, &mut group.particles, *time);
                }
                any |= changed;
            }
        }
        any
    }

    /// Whether a body feels another body, a wall or a boundary, or a coupling has pairs that act on it.
    pub(crate) fn touches(&self, body: &str) -> bool {
        let Some(on) = self.bodies().position(|name| name == body) else {
            return false;
        };
        let by_force = self.contacts().into_iter();
        let coupled = by_force
            .filter(|own| own.pairs > 0)
            .any(|own| own.bodies.iter().any(|name| name == body));
        coupled || self.feels_another(on)
    }
}
