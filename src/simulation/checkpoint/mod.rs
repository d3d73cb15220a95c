//! What a checkpoint holds of a simulation: what it puts, and beside it how that is taken back.
//! Structs are taken apart whole here, so a new part of one does not compile before it is said what becomes of it.
//!
//! Neighbour lists are not held: they follow from the positions that they were built from. Neither is what the scene
//! supplies again.

mod change;
mod couple;
mod group;
mod held;
mod joints;
mod particles;
mod ranks;
mod saved;
mod whole;
mod workspace;

use super::energy::Work;
use super::group::Group;
use super::impulses::Impulses;
use super::run_state::State;
use super::view::{Reading, rounding};
use super::{Criterion, Simulation, Vote};
use crate::error::{CheckpointProblem, Error, Result};
use crate::once::once;
use crate::output::checkpoint::{Checkpoint, Hashes, Read, damaged};
use crate::scalar::{Real, width};
use crate::scene::Described;
use crate::sweep::{InstructionSet, Root};
use std::path::Path;

pub use change::{Change, Difference};
pub(crate) use change::{Changes, differences};
pub(crate) use saved::saved_groups;

/// The version of what is held. It rises with every change of it.
const VERSION: &str = "6";

/// Parts of a scene that are hashed only where there are any.
pub(crate) const RARE: [&str; 5] = [
    "times at which steps end",
    "events",
    "joints",
    "schemes that come later",
    "sources and drains",
];

const FORMAT: &str = "meshfree checkpoint";

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Writes a checkpoint, from which [`Scene::resume`](crate::scene::Scene::resume) goes on to the same bits; see
    /// [checkpoint and restart](crate::simulation#checkpoint-and-restart). The file appears at once and whole: a crash
    /// while it is written leaves the one before.
    ///
    /// It holds the state that the next step starts from, and the time that is [shown](crate::simulation#readings) where that
    /// is another.
    ///
    /// On [ranks](crate::ranks) all call it, and see the same folder. Each writes a part of its own next to `path`, as `run.a0` and `run.a1`
    /// for `run`, and when all are there the first one a manifest at `path`, by which the checkpoint counts; parts are `a` and `b` in turn.
    /// Any number of ranks resumes from it, and one process without ranks.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written, on several ranks as the same [`Error::Rank`] on all, after which the simulation can go
    /// on; and [`Error::Failed`] after a step that has failed: its state is none to go on from.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        once!(self => &Simulation, |own, path: &Path| -> Result<()> {
            own.check_failure()?;
            match own.team.as_deref().filter(|team| team.count() > 1) {
                Some(team) => own.save_in_parts(team, path),
                None => own.agree_on(own.put(Checkpoint::default()).write(path)),
            }
        })
    }

    /// The same, as of a scene.
    pub(crate) fn of_scene(self, scene: Hashes, described: Described) -> Self {
        Self {
            scene,
            described,
            ..self
        }
    }

    /// Goes on from the state in a file, of a scene that may differ in what is named.
    pub(crate) fn resumed(
        mut self,
        path: &Path,
        file: &Checkpoint,
        changes: Changes<'_>,
    ) -> Result<Self> {
        let problem = |problem| Error::Checkpoint {
            path: path.to_path_buf(),
            problem,
        };
        let holds = |group: &Group<T, D>| !group.held.clamps.is_empty();
        let changes =
            if self.state.groups.iter().any(holds) || file.has_numbers("/clamp", "/forces") {
                changes
            } else {
                changes.without_clamps()
            };
        self.take(file, changes).map_err(problem)?;
        if self.state.own().is_parted() {
            self.begin_parts()?;
            // Books of energy are of all particles.
            if self.state.own().work.is_some() {
                self.bring_together();
            }
        }
        if changes.is_anew {
            self.evaluate_together()?;
        }
        if let Ok(shown) = file.get_one::<f64>("shown") {
            if (shown - self.state.time).abs() <= rounding(shown) {
                self.show_at(shown);
            } else {
                let next = self.next_step()?;
                self.show(shown, next)?;
            }
        }
        self.end_parts();
        Ok(self)
    }

    fn put(&self, mut file: Checkpoint) -> Checkpoint {
        let Self {
            state: shown,
            domain: _,
            integrator: _,
            control: _,
            accelerations: _,
            loads: _,
            step_ends: _,
            built: _,
            events: _,
            scene,
            described,
            aside: _,
            shown: reading,
            failed: _,
            pair_forces: _,
            team: _,
            steps_parts: _,
        } = self;
        let shown = shown.own();
        // The next step starts from the state after the last one. While another is shown, no particles enter.
        let last = self.after_step();
        let State {
            groups,
            couples,
            joints,
            time,
            steps,
            evaluations,
            rates_at_hand,
            first_step,
            step_before,
            last_vote,
            // What a process has counted, as it has its times.
            votes: _,
            impulses,
            kept_impulses,
            work,
            evaluated,
            due,
            watch: _,
            stores,
            happened,
        } = last;
        let time = match reading {
            Reading::Rounded(own) => own,
            _ => time,
        };
        file.put_text("format", FORMAT);
        file.put_text("version", VERSION);
        file.put_text("crate version", env!("CARGO_PKG_VERSION"));
        file.put_text("scalar", T::NAME);
        file.put_text("dimension", D.to_string());
        file.put_text("lane width", width::<T>().to_string());
        file.put_text("instructions", format!("{:?}", self.instructions()));
        if let Some(group) = groups.first() {
            file.put_text("root", format!("{:?}", group.root));
        }
        for (part, hash) in scene {
            file.put_text(format!("hash of {part}"), format!("{hash:016x}"));
        }
        for (part, values) in described {
            file.put_text(format!("values of {part}"), values.text());
        }
        file.put("origin".into(), 1, self.origin());
        file.put_one("time".into(), *time);
        if *time != shown.time {
            file.put_one("shown".into(), shown.time);
        }
        file.put_one("steps".into(), *steps);
        file.put_one("evaluations".into(), *evaluations);
        file.put_one("rates_at_hand".into(), u32::from(*rates_at_hand));
        file.put_one("evaluated".into(), *evaluated);
        file.put_one("due".into(), *due);
        if let Some(step) = first_step {
            file.put_one("first_step".into(), *step);
        }
        if let Some(step) = step_before {
            file.put_one("step_before".into(), *step);
        }
        if let Some(vote) = last_vote {
            let Vote {
                step,
                criterion,
                particle,
            } = vote;
            file.put_text("last vote", criterion.name());
            file.put_one("last_vote/step".into(), *step);
            file.put_one("last_vote/particle".into(), *particle as u64);
        }
        if let Some(Work {
            start,
            load,
            wall,
            laws,
            joints,
        }) = work
        {
            file.put("work".into(), 1, [*start, *load, *wall, *laws]);
            file.put_one("work of joints".into(), *joints);
        }
        let (width, rows) = stores.rows();
        file.put_one("stored energy/limit".into(), stores.limit());
        file.put("stored energy/accounts".into(), width, rows);
        file.put("impulses".into(), 1, &impulses.values);
        for (k, kept) in kept_impulses.iter().enumerate() {
            file.put(format!("kept{k}/impulses"), 1, &kept.values);
            file.put_one(format!("kept{k}/time"), kept.time);
        }
        for (k, (name, at)) in happened.iter().enumerate() {
            file.put_text(format!("event {k}"), name.clone());
            if let Some(at) = at {
                file.put_one(format!("event{k}/time"), *at);
            }
        }
        for (k, couple) in couples.iter().enumerate() {
            couple.put(&format!("coupling{k}"), &mut file);
        }
        joints.put(&mut file);
        for (k, group) in groups.iter().enumerate() {
            group.put(&format!("group{k}"), &mut file);
        }
        file
    }

    fn take(&mut self, file: &Checkpoint, changes: Changes<'_>) -> Read<()> {
        self.check(file, changes, InstructionSet::detect())?;
        let set = file.text("instructions")?;
        let set = InstructionSet::ALL
            .into_iter()
            .find(|own| format!("{own:?}") == set);
        let set = set.ok_or_else(|| damaged("its instruction set has no name"))?;
        // Files of before there was a choice have none.
        let root = match file.text("root") {
            Ok(name) => Root::ALL
                .into_iter()
                .find(|own| format!("{own:?}") == name)
                .ok_or_else(|| damaged("its root has no name"))?,
            Err(_) => Root::Products,
        };
        for group in &mut self.state.groups {
            group.instructions = set;
            group.root = root;
        }
        // It follows from bodies and walls, which are those of the file.
        let origin: [f64; D] = file.get_array("origin")?;
        if origin != self.origin() {
            return Err(damaged("its places count from another origin"));
        }
        self.state.time = file.get_one("time")?;
        self.state.steps = file.get_one("steps")?;
        self.state.evaluations = file.get_one("evaluations")?;
        self.state.rates_at_hand = file.get_one::<u32>("rates_at_hand")? != 0;
        self.state.evaluated = file.get_one("evaluated")?;
        self.state.due = file.get_one("due")?;
        self.state.first_step = None;
        if file.has("first_step") {
            self.state.first_step = Some(file.get_one("first_step")?);
        }
        self.state.step_before = None;
        if file.has("step_before") {
            self.state.step_before = Some(file.get_one("step_before")?);
        }
        self.state.last_vote = None;
        if file.has("last_vote/step") {
            let name = file.text("last vote")?;
            let limits = self
                .state
                .groups
                .iter()
                .flat_map(|group| &group.scheme.program.limits);
            let limits = limits.map(|limit| limit.name());
            let couplings = self
                .state
                .couples
                .iter()
                .map(|couple| couple.coupling.name());
            let names = limits.chain(couplings).chain([super::joint_forces::LIMIT]);
            let criteria = Criterion::ALL
                .into_iter()
                .chain(names.map(Criterion::Effect));
            let criterion = criteria.into_iter().find(|own| own.name() == name);
            // What set the last step may be gone with a change.
            if criterion.is_some() || changes.is_empty() {
                self.state.last_vote = Some(Vote {
                    step: file.get_one("last_vote/step")?,
                    criterion: criterion.ok_or_else(|| damaged("its criterion has no name"))?,
                    particle: file.get_one::<u64>("last_vote/particle")? as usize,
                });
            }
        }
        self.state.work = None;
        if file.has("work") {
            let [start, load, wall, laws] = file.get_array("work")?;
            self.state.work = Some(Work {
                start,
                load,
                wall,
                laws,
                // Files of before there were any have none.
                joints: file.get_one("work of joints").unwrap_or(0.0),
            });
        }
        // Files of before there were any begin them anew.
        if file.has("stored energy/limit") {
            let limit = file.get_one("stored energy/limit")?;
            let rows: Vec<f64> = file.get("stored energy/accounts")?;
            self.state.stores.take_rows(limit, &rows);
        }
        let time = self.state.time;
        let values = file.get("impulses")?;
        self.state.impulses = Impulses { values, time };
        self.state.kept_impulses.clear();
        while let name = format!("kept{}", self.state.kept_impulses.len())
            && file.has(&format!("{name}/impulses"))
        {
            self.state.kept_impulses.push(Impulses {
                values: file.get(&format!("{name}/impulses"))?,
                time: file.get_one(&format!("{name}/time"))?,
            });
        }
        for (name, at) in &mut self.state.happened {
            *at = None;
            let mut known = (0..).map_while(|k| file.text(&format!("event {k}")).ok());
            let place = known.position(|own| own == name);
            let column = place.map(|k| format!("event{k}/time"));
            if let Some(column) = column.filter(|own| file.has(own)) {
                *at = Some(file.get_one(&column)?);
            }
        }
        self.exchange_schemes();
        for (k, couple) in self.state.couples.iter_mut().enumerate() {
            couple.take_state(&format!("coupling{k}"), file)?;
        }
        self.state.joints.take_state(file)?;
        for (k, group) in self.state.groups.iter_mut().enumerate() {
            group.take_state(&format!("group{k}"), file, changes)?;
        }
        if changes.has(Change::Walls) {
            let time = self.state.time;
            for group in &mut self.state.groups {
                group.stand_walls(time);
            }
        }
        if changes.is_anew {
            self.state.rates_at_hand = false;
            self.state.kept_impulses.clear();
        }
        self.follow_clamps(false);
        if changes.has(Change::Motions) {
            let state = &mut *self.state;
            for group in &mut state.groups {
                for k in 0..group.held.clamps.len() {
                    if !group.held.clamps[k].is_free {
                        (group.held).take_hold(k, &mut group.particles, state.time);
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether a file goes on from a simulation like this one, on a machine of which `best` is the best.
    fn check(&self, file: &Checkpoint, changes: Changes<'_>, best: InstructionSet) -> Read<()> {
        check_format(file)?;
        let kinds = [
            ("scalar", T::NAME.to_string()),
            ("dimension", D.to_string()),
            ("lane width", width::<T>().to_string()),
        ];
        for (what, own) in kinds {
            let found = file.text(what)?;
            if found != own {
                return Err(CheckpointProblem::Kind {
                    what,
                    found: found.into(),
                    own,
                });
            }
        }
        let all = differences((&self.scene, &self.described), &RARE, file);
        let parts = changes.refused(&all, &self.described, file);
        if !parts.is_empty() {
            let refused = all.iter().filter(|own| parts.contains(&own.part));
            let values = refused.map(ToString::to_string).collect();
            return Err(CheckpointProblem::Scene { parts, values });
        }
        let set = file.text("instructions")?;
        let lacks =
            |own: InstructionSet| format!("{own:?}") == set && (own > best || !own.compiled());
        if InstructionSet::ALL.into_iter().any(lacks) {
            return Err(CheckpointProblem::Instructions { found: set.into() });
        }
        Ok(())
    }
}

/// Whether a file holds what this version of the crate knows.
fn check_format(file: &Checkpoint) -> Read<()> {
    if file.text("format")? != FORMAT {
        return Err(damaged("it is no checkpoint by itself"));
    }
    let found = file.text("version")?;
    if found == VERSION {
        return Ok(());
    }
    Err(CheckpointProblem::Version {
        found: found.into(),
        known: VERSION,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::{Body, Scene, catalogue, schemes};

    #[test]
    fn instructions_that_a_machine_lacks_are_named() {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-3);
        let scene = Scene::<f64, 1>::new(schemes::impact()).body(rod);
        let simulation = scene.build().unwrap();
        let mut file = simulation.put(Checkpoint::default());
        for (set, best, runs) in [
            (
                "Baseline",
                InstructionSet::Baseline,
                InstructionSet::Baseline.compiled(),
            ),
            (
                "Avx2",
                InstructionSet::Avx512,
                InstructionSet::Avx2.compiled(),
            ),
            ("Avx2", InstructionSet::Baseline, false),
            ("Avx512", InstructionSet::Avx2, false),
        ] {
            file.put_text("instructions", set);
            let found = set.into();
            let lacks = Err(CheckpointProblem::Instructions { found });
            let expected = if runs { Ok(()) } else { lacks };
            assert_eq!(
                simulation.check(&file, Changes::default(), best),
                expected,
                "{set}"
            );
        }
    }
}
