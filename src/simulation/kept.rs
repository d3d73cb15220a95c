//! The state of a simulation, of which a copy takes the place: rehearsals, readings and evaluations go on from the copy.
//! The simulation is taken apart whole here, so a new part of it does not compile before it is said what becomes of it.

use super::contact::Couple;
use super::event::Happened;
use super::group::Group;
use super::ledger::Impulses;
use super::{Simulation, Vote, energy, stability, stored};
use crate::scalar::Real;
use core::mem::swap;

/// What steps change.
#[derive(Debug)]
pub(super) struct Kept<T: Real, const D: usize> {
    pub groups: Vec<Group<T, D>>,
    pub couples: Vec<Couple<T, D>>,
    pub time: f64,
    pub steps: u64,
    pub evaluations: u64,
    pub rates_at_hand: bool,
    pub first_step: Option<f64>,
    pub step_before: Option<f64>,
    pub last_vote: Option<Vote>,
    pub votes: Vec<(&'static str, u64)>,
    pub impulses: Impulses,
    pub work: Option<energy::Work>,
    pub evaluated: f64,
    pub impulses_of_states: Vec<Impulses>,
    pub due: f64,
    pub watch: Option<Box<stability::Watch<D>>>,
    pub stores: stored::Stores<D>,
    pub happened: Happened,
    /// Layers that inlets have handed over, group by group.
    pub handed_over: Vec<u64>,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Keeps the state, of which a copy takes the place.
    pub(super) fn keep(&mut self) -> Kept<T, D> {
        let handed_over = self.emitters().map(|own| own.handed_over()).collect();
        let Self {
            groups,
            couples,
            domain: _,
            integrator: _,
            control: _,
            accelerations: _,
            loads: _,
            step_ends: _,
            built: _,
            #[cfg(feature = "checkpoint")]
                scene: _,
            #[cfg(feature = "checkpoint")]
                described: _,
            time,
            steps,
            evaluations,
            rates_at_hand,
            first_step,
            step_before,
            last_vote,
            votes,
            impulses,
            work,
            evaluated,
            kept_impulses,
            aside: _,
            shown: _,
            due,
            failed: _,
            watch,
            stores,
            events: _,
            happened,
        } = self;
        let mut kept = Kept {
            groups: groups.clone(),
            couples: couples.clone(),
            time: *time,
            steps: *steps,
            evaluations: *evaluations,
            rates_at_hand: *rates_at_hand,
            first_step: *first_step,
            step_before: *step_before,
            last_vote: *last_vote,
            votes: votes.clone(),
            impulses: impulses.clone(),
            work: *work,
            evaluated: *evaluated,
            impulses_of_states: kept_impulses.clone(),
            due: *due,
            watch: watch.clone(),
            stores: stores.clone(),
            happened: happened.clone(),
            handed_over,
        };
        self.exchange_state(&mut kept);
        kept
    }

    /// Exchanges the state with what was kept. A failure is no part of it.
    pub(super) fn exchange_state(&mut self, kept: &mut Kept<T, D>) {
        let Kept {
            groups,
            couples,
            time,
            steps,
            evaluations,
            rates_at_hand,
            first_step,
            step_before,
            last_vote,
            votes,
            impulses,
            work,
            evaluated,
            impulses_of_states,
            due,
            watch,
            stores,
            happened,
            handed_over,
        } = kept;
        // Copies of an inlet share their count.
        for (own, layers) in self.emitters().zip(handed_over) {
            let now = own.handed_over();
            own.set_handed_over(*layers);
            *layers = now;
        }
        swap(&mut self.groups, groups);
        swap(&mut self.couples, couples);
        swap(&mut self.time, time);
        swap(&mut self.steps, steps);
        swap(&mut self.evaluations, evaluations);
        swap(&mut self.rates_at_hand, rates_at_hand);
        swap(&mut self.first_step, first_step);
        swap(&mut self.step_before, step_before);
        swap(&mut self.last_vote, last_vote);
        swap(&mut self.votes, votes);
        swap(&mut self.impulses, impulses);
        swap(&mut self.work, work);
        swap(&mut self.evaluated, evaluated);
        swap(&mut self.kept_impulses, impulses_of_states);
        swap(&mut self.due, due);
        swap(&mut self.watch, watch);
        swap(&mut self.stores, stores);
        swap(&mut self.happened, happened);
    }

    /// Puts back what was kept. The time that was spent meanwhile stays spent.
    pub(super) fn put_back(&mut self, mut kept: Kept<T, D>) {
        for (before, now) in kept.groups.iter_mut().zip(&self.groups) {
            before.work.phases = now.work.phases;
            before.work.spent.keep_times_of(&now.work.spent);
        }
        if let (Some(before), Some(now)) = (&mut kept.watch, &self.watch) {
            before.spent = now.spent;
        }
        self.exchange_state(&mut kept);
    }

    fn emitters(&self) -> impl Iterator<Item = &crate::boundary::Emitter<D>> {
        let groups = self.groups.iter();
        groups.flat_map(|group| group.emitters.iter().map(|(_, own)| own))
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
