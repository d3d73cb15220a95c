//! What an integrator does to the state on the device: its operations as launches.
//! Lists are looked at where the step program has them.

use crate::Error;
use crate::compile::Piece;
use crate::compiled::Compiled;
use crate::run::Run;
use meshfree::error::Error as HostError;
use meshfree::integrator::System;
use meshfree::scalar::Real;
use meshfree::simulation::device::{Forces, Moment, Moved, Offloaded};

/// Places in `StateStep::lists`.
const SAVE: usize = 0;
const LOAD: usize = 1;
const COMBINE: usize = 2;
const ACCUMULATE: usize = 3;

impl<T: Real, const D: usize> Run<T, D> {
    /// Runs the pieces of a list of all groups at a moment.
    fn act(
        &mut self,
        pieces: impl Fn(&Compiled) -> &[Piece],
        moment: &Moment,
    ) -> Result<(), Error> {
        for group in 0..self.groups.len() {
            let own = pieces(&self.groups[group].compiled).to_vec();
            if !own.is_empty() {
                self.share(group, moment);
                self.act_on(group, &own, moment)?;
            }
        }
        Ok(())
    }

    /// Brings walls that are bodies of other groups to these, or these the forces on the walls.
    fn link(&self, what: usize, moment: &Moment) {
        if self.links.is_empty() {
            return;
        }
        (0..self.groups.len()).for_each(|group| self.share(group, moment));
        let all = self.links.iter().map(|link| &link.bound[what]);
        self.device.launch(all);
    }

    /// The same as [`act`](Self::act) of a group; whether lists were built anew.
    fn act_on(&mut self, group: usize, pieces: &[Piece], moment: &Moment) -> Result<bool, Error> {
        let mut rebuilt = false;
        for part in pieces.split_inclusive(|piece| !matches!(piece, Piece::Kernel(_))) {
            let kernels = self.groups[group].compiled.of(part);
            if !kernels.is_empty() {
                self.device.launch(kernels);
            }
            match part.last() {
                Some(Piece::Lists) => rebuilt |= self.bring_lists(group, moment)?,
                Some(Piece::Repeat(k)) => self.repeat(group, *k, moment)?,
                _ => {}
            }
        }
        Ok(rebuilt)
    }

    /// Repeats what particles need to settle. The host reads one number each time.
    fn repeat(&mut self, group: usize, number: usize, moment: &Moment) -> Result<(), Error> {
        let own = &self.groups[group].compiled.repeats[number];
        let (times, begin, end) = (own.times, own.begin.clone(), own.end.clone());
        // Lists are the first of what is repeated: where they were built anew particles have other places.
        let is_lists = |piece: &Piece| matches!(piece, Piece::Lists);
        let after = own.pieces.iter().position(is_lists).map_or(0, |at| at + 1);
        let [lists, pieces] = [&own.pieces[..after], &own.pieces[after..]].map(<[_]>::to_vec);
        self.act_on(group, &begin, moment)?;
        for _ in 0..times {
            if self.act_on(group, &lists, moment)? {
                self.act_on(group, &begin, moment)?;
            }
            self.act_on(group, &pieces, moment)?;
            let own = &self.groups[group];
            self.device.launch(&own.compiled.open.bound);
            if self.read(&own.memory.moves, 1)?[0] == 0.0 {
                break;
            }
        }
        self.act_on(group, &end, moment).map(|_| ())
    }

    /// Walls go to their places, and lists are built anew if particles have used up their skin; whether they were.
    fn bring_lists(&mut self, group: usize, moment: &Moment) -> Result<bool, Error> {
        let walls = self.host.place_walls(group, moment);
        self.write(group, &walls);
        let own = &self.groups[group];
        if own.compiled.lists.moved.is_empty() || self.host.surely_serve(group, moment.time) {
            return Ok(false);
        }
        let all = own.compiled.of(&own.compiled.lists.moved).into_iter();
        self.device.launch(all.chain(&own.compiled.moved.bound));
        let found = self.read(&own.memory.moves, own.compiled.moved.outputs)?;
        let moved = Moved {
            farthest2: found[0],
            grown: found[1],
            range: [found[2..2 + D].to_vec(), found[2 + D..].to_vec()],
        };
        let is_outdated = self.host.is_outdated(group, moved, moment.time);
        if is_outdated {
            if self.rebuild(group, moment.time)? {
                self.meet_as_listed(group)?;
            } else {
                self.host.leave_lists(group);
                self.take_group(group)?;
                self.host.rebuild(group, moment.time);
                self.send(group, moment.time)?;
            }
            self.is_taken = false;
            self.share(group, moment);
        }
        Ok(is_outdated)
    }
}

/// What an integrator does to the state on the device.
pub(crate) struct Stepping<'a, T: Real, const D: usize> {
    pub(crate) run: &'a mut Run<T, D>,
    /// The first error of the device, after which nothing is done.
    pub(crate) lost: Option<Error>,
}

impl<T: Real, const D: usize> Stepping<'_, T, D> {
    fn act(&mut self, pieces: impl Fn(&Compiled) -> &[Piece], moment: &Moment) {
        if self.lost.is_none() {
            self.lost = self.run.act(pieces, moment).err();
        }
    }

    /// An error in the place of one of the device.
    fn outcome(&self) -> Result<(), HostError> {
        match &self.lost {
            None => Ok(()),
            Some(error) => Err(HostError::Failed {
                cause: error.to_string(),
            }),
        }
    }
}

impl<T: Real, const D: usize> System for Stepping<'_, T, D> {
    fn evaluate(&mut self, offset: f64) -> Result<(), HostError> {
        self.outcome()?;
        if self.run.kicked != 0.0 {
            // By forces that the next evaluation writes over.
            self.know_forces();
        }
        let moment = self.run.host.begin_evaluation(offset)?;
        self.run.link(0, &moment);
        self.act(|own| &own.lists.evaluation, &moment);
        self.act(|own| &own.lists.reacts, &moment);
        self.run.link(1, &moment);
        if self.lost.is_none() {
            match self.run.meet(moment.time) {
                Err(Error::Simulation(error)) => return Err(error),
                met => self.lost = met.err(),
            }
        }
        self.act(|own| &own.lists.hold, &moment);
        self.run.forces = None;
        self.outcome()
    }

    fn kick(&mut self, dt: f64) {
        let moment = self.run.host.begin_kick(dt);
        match &self.run.forces {
            Some(forces) => self.run.host.book(dt, forces),
            None => self.run.kicked += dt,
        }
        self.act(|own| &own.lists.kick, &moment);
    }

    fn drift(&mut self, dt: f64, offset: f64) -> Result<(), HostError> {
        let moment = self.run.host.begin_drift(dt, offset)?;
        self.act(|own| &own.lists.drift_begins, &moment);
        self.run.link(0, &moment);
        self.act(|own| &own.lists.drift_middle, &moment);
        self.act(|own| &own.lists.drift_ends, &moment);
        self.outcome()
    }

    fn shift(&mut self, dv: f64, da: f64) {
        let moment = self.run.host.begin_shift(dv, da);
        self.act(|own| &own.lists.shift, &moment);
    }

    fn predict(&mut self, dt: f64) {
        let moment = self.run.host.begin_prediction(Some(dt));
        self.act(|own| &own.lists.predict, &moment);
    }

    fn restore(&mut self) {
        let moment = self.run.host.begin_prediction(None);
        self.act(|own| &own.lists.restore, &moment);
    }

    fn save(&mut self, slot: usize) {
        self.change_state(slot, SAVE, |host, _| host.begin_state(slot, true));
    }
    fn load(&mut self, slot: usize) {
        self.change_state(slot, LOAD, |host, _| host.begin_state(slot, false));
    }
    fn combine(&mut self, slot: usize, a: f64, b: f64, dt: f64) {
        self.know_forces();
        self.change_state(slot, COMBINE, |host, forces| {
            host.begin_combination(slot, [a, b, dt], forces)
        });
    }
    fn accumulate(&mut self, slot: usize, dt: f64) {
        self.know_forces();
        self.change_state(slot, ACCUMULATE, |host, forces| {
            host.begin_accumulation(slot, dt, forces)
        });
    }

    fn has_rates(&self) -> bool {
        self.run.host.has_rates()
    }
}

impl<T: Real, const D: usize> Stepping<'_, T, D> {
    /// Asks for the forces between blocks of the last evaluation, unless the host has them.
    fn know_forces(&mut self) {
        if self.lost.is_some() || self.run.forces.is_some() {
            return;
        }
        let run = &mut *self.run;
        for group in &run.groups {
            run.device.launch(&group.compiled.vote.bound);
        }
        match run.votes() {
            Ok((_, forces)) => run.book(forces),
            Err(error) => self.lost = Some(error),
        }
    }

    /// Does something to a kept state.
    fn change_state(
        &mut self,
        slot: usize,
        what: usize,
        begin: impl FnOnce(&mut Offloaded<T, D>, &[Forces<D>]) -> Moment,
    ) {
        let run = &mut *self.run;
        let mut groups = run.groups.iter();
        if !groups.all(|own| slot < own.compiled.lists.states.len()) {
            let name = run.host.integrator().name();
            self.lost.get_or_insert(Error::KeptState { name });
            return;
        }
        let forces = run.forces.as_deref().unwrap_or_default();
        let moment = begin(&mut run.host, forces);
        self.act(|own| &own.lists.states[slot][what], &moment);
    }
}
