//! The state of a run: what steps change, and nothing else.
//! A copy takes its place in rehearsals, readings and evaluations; a checkpoint holds it.

use super::contact::Couple;
use super::event::Happened;
use super::group::Group;
use super::impulses::Impulses;
use super::joints::Joints;
use super::{Simulation, Vote, energy, stability, stored};
use crate::scalar::Real;
use core::mem::replace;

/// What steps change.
#[derive(Clone, Debug)]
pub(in crate::simulation) struct State<T: Real, const D: usize> {
    /// Bodies by the schemes that they share; there is one at least.
    pub groups: Vec<Group<T, D>>,
    /// Bodies that act on each other, or on themselves, by forces between pairs.
    pub couples: Vec<Couple<T, D>>,
    /// Joints of rigid bodies.
    pub joints: Joints<D>,
    /// Time \[s\].
    pub time: f64,
    pub steps: u64,
    pub evaluations: u64,
    pub rates_at_hand: bool,
    pub first_step: Option<f64>,
    /// The step before \[s\], as it was before a cut.
    pub step_before: Option<f64>,
    pub last_vote: Option<Vote>,
    /// Steps by the criterion that set them.
    pub votes: Vec<(&'static str, u64)>,
    pub impulses: Impulses,
    /// Impulses of the states that integrators keep.
    pub kept_impulses: Vec<Impulses>,
    /// Work done on a liquid, where it is kept.
    pub work: Option<energy::Work>,
    /// The time \[s\] of the last evaluation.
    pub evaluated: f64,
    /// Time \[s\] over which what follows the flow once a step has yet to do so.
    pub due: f64,
    /// What a watched run keeps.
    pub watch: Option<Box<stability::Watch<D>>>,
    /// What is kept of stored energy.
    pub stores: stored::Stores<D>,
    /// What of its events has happened.
    pub happened: Happened,
}

impl<T: Real, const D: usize> State<T, D> {
    /// That of particles as built.
    pub fn new(groups: Vec<Group<T, D>>, couples: Vec<Couple<T, D>>) -> Self {
        Self {
            groups,
            couples,
            joints: Joints::default(),
            time: 0.0,
            steps: 0,
            evaluations: 0,
            rates_at_hand: false,
            first_step: None,
            step_before: None,
            last_vote: None,
            votes: Vec::new(),
            impulses: Impulses::default(),
            kept_impulses: Vec::new(),
            work: None,
            evaluated: 0.0,
            due: 0.0,
            watch: None,
            stores: stored::Stores::default(),
            happened: Happened::new(),
        }
    }
}

impl<T: Real, const D: usize> State<T, D> {
    /// Keeps the present impulses in a slot of an integrator.
    pub(super) fn save_impulses(&mut self, slot: usize) {
        let kept = &mut self.kept_impulses;
        if kept.len() <= slot {
            kept.resize_with(slot + 1, Default::default);
        }
        kept[slot].clone_from(&self.impulses);
    }

    /// Brings kept impulses back.
    pub(super) fn load_impulses(&mut self, slot: usize) {
        if let Some(kept) = self.kept_impulses.get(slot) {
            self.impulses.clone_from(kept);
        }
    }

    /// a · kept + b · present + dt · rates.
    pub(super) fn combine_impulses(&mut self, slot: usize, by: [f64; 3], rates: &Impulses) {
        let [a, b, dt] = by;
        if let Some(kept) = self.kept_impulses.get(slot) {
            self.impulses = kept.combine(a, &self.impulses, b, rates, dt);
        }
    }

    /// kept + dt · rates, which is kept then.
    pub(super) fn accumulate_impulses(&mut self, slot: usize, rates: &Impulses, dt: f64) {
        if let Some(kept) = self.kept_impulses.get_mut(slot) {
            *kept = kept.combine(1.0, rates, dt, rates, 0.0);
        }
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Keeps the state, of which a copy takes the place.
    pub(super) fn keep(&mut self) -> State<T, D> {
        self.forget_taken_back();
        let copy = State::clone(&self.state);
        replace(&mut *self.state, copy)
    }

    /// Frees what the prediction of the last step has taken back.
    pub(super) fn forget_taken_back(&mut self) {
        for group in &mut self.state.groups {
            group.work.forget_taken_back();
        }
    }

    /// Restores the saved state. The time that was spent meanwhile stays spent.
    pub(super) fn put_back(&mut self, mut kept: State<T, D>) {
        for (before, now) in kept.groups.iter_mut().zip(&self.state.groups) {
            before.work.phases = now.work.phases;
            before.work.spent.keep_times_of(&now.work.spent);
        }
        if let (Some(before), Some(now)) = (&mut kept.watch, &self.state.watch) {
            before.spent = now.spent;
        }
        *self.state = kept;
    }
}

#[cfg(test)]
mod tests {
    use crate::material::{Material, eos::IdealGas};
    use crate::prelude::*;
    use crate::simulation::ParticleView;

    /// Two rods of gas that meet, with lists that are built in every step and an event on the way.
    fn gases() -> Simulation<f64, 1> {
        let gas = Material::new("gas", IdealGas::new(1.4, 1.0));
        let body = |name, x| Body::block(name, gas.clone(), [x], [x + 1.0], 0.02).energy(1.0);
        Scene::new(schemes::gas())
            .body(body("left", 0.0).velocity([0.5]))
            .body(body("right", 1.0))
            .boundary(MirrorPlane::wall([0.0], [-1.0]))
            .event("late", |now: &Simulation<f64, 1>| now.time() > 0.2)
            .build()
            .unwrap()
    }

    #[test]
    fn a_rehearsal_leaves_no_trace() {
        let (mut plain, mut looked) = (gases(), gases());
        for end in [0.1, 0.3, 0.5] {
            let before = looked.work();
            let expected = looked.expected_work(2.0).unwrap();
            assert!(expected.steps > 20 && expected.pairs > 0, "{expected:?}");
            assert_eq!(looked.work(), before);
            assert_eq!(looked.event("late").unwrap(), plain.event("late").unwrap());
            plain.run_until(end).unwrap();
            looked.run_until(end).unwrap();
            let state = |now: &Simulation<f64, 1>| -> Vec<[u64; 3]> {
                let of = |own: ParticleView<'_, f64, 1>| {
                    [own.position()[0], own.velocity()[0], own.energy()].map(f64::to_bits)
                };
                now.all().map(of).collect()
            };
            assert_eq!(state(&plain), state(&looked));
            assert_eq!(plain.steps(), looked.steps());
            assert_eq!(plain.list_builds(), looked.list_builds());
        }
    }
}
