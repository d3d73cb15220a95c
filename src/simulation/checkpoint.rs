//! What a checkpoint holds of a simulation: what it puts, and beside it how that is taken back.
//! Structs are taken apart whole here, so a new part of one does not compile before it is said what becomes of it.
//!
//! Neighbour lists are not held: they follow from the positions that they were built from. Neither is what the scene
//! supplies again.

use super::couplings::Structure;
use super::energy::Work;
use super::group::{Aside, Group};
use super::ledger::Impulses;
use super::neighborhood::Neighborhood;
use super::population::{BodyState, Moves, Particles, Removed};
use super::sub_cycle::SubCycle;
use super::workspace::{Saved, Workspace};
use super::{Criterion, Simulation, Vote, width};
use crate::error::{CheckpointProblem, Error, Result};
use crate::material::eos::GuardCounts;
use crate::output::checkpoint::{Checkpoint, Hashes, Read, damaged};
use crate::particles::{Columns, Field, Output, Outputs};
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::sweep::{InstructionSet, Reaction, Records, Results};
use crate::term::Stage;
use std::ops::Range;
use std::path::Path;

/// The version of what is held. It rises with every change of it.
const VERSION: &str = "1";

const FORMAT: &str = "meshfree checkpoint";

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Writes a checkpoint, from which [`Scene::resume`](crate::scene::Scene::resume) goes on to the same bits; see
    /// [checkpoint and restart](crate::simulation#checkpoint-and-restart). The file appears at once and whole: a crash
    /// while it is written leaves the one before.
    ///
    /// After an [evaluation](Self::evaluate) between steps it holds what the next step starts from.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written, and [`Error::Failed`] after a step that has failed: its state is
    /// none to go on from.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        self.check_failure()?;
        self.put().write(path.as_ref())
    }

    /// The same, as of a scene.
    pub(crate) fn of_scene(self, scene: Hashes) -> Self {
        Self { scene, ..self }
    }

    /// Goes on from the state in a file.
    pub(crate) fn resumed(mut self, path: &Path, file: &Checkpoint) -> Result<Self> {
        self.take(file).map_err(|problem| Error::Checkpoint {
            path: path.to_path_buf(),
            problem,
        })?;
        Ok(self)
    }

    fn put(&self) -> Checkpoint {
        let Self {
            groups,
            couples,
            domain: _,
            integrator: _,
            control: _,
            accelerations: _,
            loads: _,
            scene,
            time,
            steps,
            evaluations,
            rates_at_hand,
            first_step,
            last_vote,
            // What a process has counted, as it has its times.
            votes: _,
            impulses,
            work,
            evaluated,
            kept_impulses,
            aside,
            due,
            failed: _,
        } = self;
        // The next step takes up what was set aside.
        let now: Vec<_> = couples.iter().map(|own| (own.force, own.step)).collect();
        let (acting, evaluated, evaluations) = match aside {
            Some(aside) => (&aside.acting, &aside.evaluated, &aside.evaluations),
            None => (&now, evaluated, evaluations),
        };
        let mut file = Checkpoint::default();
        file.put_text("format", FORMAT);
        file.put_text("version", VERSION);
        file.put_text("crate version", env!("CARGO_PKG_VERSION"));
        file.put_text("scalar", T::NAME);
        file.put_text("dimension", D.to_string());
        file.put_text("lane width", width::<T>().to_string());
        file.put_text("instructions", format!("{:?}", self.instructions()));
        for (part, hash) in scene {
            file.put_text(format!("hash of {part}"), format!("{hash:016x}"));
        }
        file.put_one("time".into(), *time);
        file.put_one("steps".into(), *steps);
        file.put_one("evaluations".into(), *evaluations);
        file.put_one("rates_at_hand".into(), u32::from(*rates_at_hand));
        file.put_one("evaluated".into(), *evaluated);
        file.put_one("due".into(), *due);
        if let Some(step) = first_step {
            file.put_one("first_step".into(), *step);
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
        if let Some(Work { start, load, wall }) = work {
            file.put("work".into(), 1, [*start, *load, *wall]);
        }
        file.put("impulses".into(), 1, &impulses.values);
        for (k, kept) in kept_impulses.iter().enumerate() {
            file.put(format!("kept{k}/impulses"), 1, &kept.values);
            file.put_one(format!("kept{k}/time"), kept.time);
        }
        for (k, (force, step)) in acting.iter().enumerate() {
            file.put(format!("coupling{k}/force"), 1, force);
            file.put_one(format!("coupling{k}/step"), *step);
        }
        for (k, group) in groups.iter().enumerate() {
            let aside = aside.as_ref().and_then(|aside| aside.groups.get(k));
            group.put(aside, &format!("group{k}"), &mut file);
        }
        file
    }

    fn take(&mut self, file: &Checkpoint) -> Read<()> {
        self.check(file, InstructionSet::detect())?;
        let set = file.text("instructions")?;
        let set = InstructionSet::ALL
            .into_iter()
            .find(|own| format!("{own:?}") == set);
        let set = set.ok_or_else(|| damaged("its instruction set has no name"))?;
        for group in &mut self.groups {
            group.instructions = set;
        }
        self.time = file.get_one("time")?;
        self.steps = file.get_one("steps")?;
        self.evaluations = file.get_one("evaluations")?;
        self.rates_at_hand = file.get_one::<u32>("rates_at_hand")? != 0;
        self.evaluated = file.get_one("evaluated")?;
        self.due = file.get_one("due")?;
        self.first_step = None;
        if file.has("first_step") {
            self.first_step = Some(file.get_one("first_step")?);
        }
        self.last_vote = None;
        if file.has("last_vote/step") {
            let name = file.text("last vote")?;
            let limits = self
                .groups
                .iter()
                .flat_map(|group| &group.scheme.program.limits);
            let limits = limits.map(|limit| limit.name());
            let couplings = self.couples.iter().map(|couple| couple.coupling.name());
            let criteria = Criterion::ALL
                .into_iter()
                .chain(limits.chain(couplings).map(Criterion::Effect));
            let criterion = criteria.into_iter().find(|own| own.name() == name);
            self.last_vote = Some(Vote {
                step: file.get_one("last_vote/step")?,
                criterion: criterion.ok_or_else(|| damaged("its criterion has no name"))?,
                particle: file.get_one::<u64>("last_vote/particle")? as usize,
            });
        }
        self.work = None;
        if file.has("work") {
            let [start, load, wall] = file.get_array("work")?;
            self.work = Some(Work { start, load, wall });
        }
        let time = self.time;
        let values = file.get("impulses")?;
        self.impulses = Impulses { values, time };
        self.kept_impulses.clear();
        while let name = format!("kept{}", self.kept_impulses.len())
            && file.has(&format!("{name}/impulses"))
        {
            self.kept_impulses.push(Impulses {
                values: file.get(&format!("{name}/impulses"))?,
                time: file.get_one(&format!("{name}/time"))?,
            });
        }
        for (k, couple) in self.couples.iter_mut().enumerate() {
            couple.force = file.get_array(&format!("coupling{k}/force"))?;
            couple.step = file.get_one(&format!("coupling{k}/step"))?;
        }
        for (k, group) in self.groups.iter_mut().enumerate() {
            group.take_state(&format!("group{k}"), file)?;
        }
        Ok(())
    }

    /// The instruction set that its pair loops run on.
    fn instructions(&self) -> InstructionSet {
        let first = self.groups.first();
        let asked = first.map_or_else(InstructionSet::detect, |group| group.instructions);
        asked.or_baseline()
    }

    /// Whether a file goes on from a simulation like this one, on a machine of which `best` is the best.
    fn check(&self, file: &Checkpoint, best: InstructionSet) -> Read<()> {
        if file.text("format")? != FORMAT {
            return Err(damaged("it is no checkpoint"));
        }
        let found = file.text("version")?;
        if found != VERSION {
            return Err(CheckpointProblem::Version {
                found: found.into(),
                known: VERSION,
            });
        }
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
        let differs = |(part, hash): &&(&'static str, u64)| {
            let found = file.text(&format!("hash of {part}"));
            !found.is_ok_and(|found| found == format!("{hash:016x}"))
        };
        let parts: Vec<_> = self.scene.iter().filter(differs).collect();
        if !parts.is_empty() {
            let parts = parts.into_iter().map(|(part, _)| *part);
            return Err(CheckpointProblem::Scene {
                parts: parts.collect(),
            });
        }
        let set = file.text("instructions")?;
        let lacks = |own: InstructionSet| format!("{own:?}") == set && own > best;
        if InstructionSet::ALL.into_iter().any(lacks) {
            return Err(CheckpointProblem::Instructions { found: set.into() });
        }
        Ok(())
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    fn put(&self, aside: Option<&Aside<T, D>>, name: &str, file: &mut Checkpoint) {
        // What was set aside before lists were built is not taken up.
        let aside = aside.filter(|aside| aside.rebuilds == self.neighborhood.rebuilds);
        let Self {
            particles,
            neighborhood,
            work,
            scheme,
            walls,
            boundaries: _,
            outlets: _,
            emitters,
            gravity,
            evaluated_gravity,
            body_force,
            indices: _,
            is_met: _,
            sub_cycle,
            smoothing_length: _,
            instructions: _,
            guards,
            limited,
        } = self;
        let slots = particles.columns.slots();
        let evaluated_gravity = evaluated_gravity.map(Real::to_f64);
        let mut own = Put {
            columns: &particles.columns,
            rates: &work.rates,
            coupling: &work.coupling,
            apart: sub_cycle.as_ref().map_or(&[], |apart| &apart.forces),
            records: &work.records,
            work_records: &work.work_records,
            records_of_rates: work.records_of_rates,
            gravity: [*gravity, evaluated_gravity],
            body_force: *body_force,
            guards: *guards,
            limited,
            served: neighborhood.served,
        };
        if let Some(aside) = aside {
            own = Put::of(aside);
        }
        put_particles(particles, own.columns, scheme, name, file);
        put_neighborhood(neighborhood, slots, name, file);
        file.put_one(format!("{name}/served"), own.served);
        put_workspace(work, &own, (scheme, !walls.is_empty()), name, file);
        for (k, wall) in walls.iter().enumerate() {
            if let Some(structure) = &wall.structure {
                let Structure {
                    coupling: _,
                    group: _,
                    body: _,
                    accelerations,
                    before,
                    evaluated,
                } = structure;
                let numbers = accelerations.as_flattened();
                file.put(format!("{name}/wall{k}/accelerations"), D, numbers);
                let numbers = before.as_flattened();
                file.put(format!("{name}/wall{k}/velocities_before"), D, numbers);
                file.put_one(format!("{name}/wall{k}/evaluated"), *evaluated);
            }
        }
        if let Some(SubCycle {
            most: _,
            forces: _,
            work,
            steps,
        }) = sub_cycle
        {
            file.put_reals(format!("{name}/apart/forces"), D, own.apart.as_flattened());
            file.put(format!("{name}/apart/work"), 1, work);
            file.put_one(format!("{name}/apart/steps"), *steps);
        }
        let layers: Vec<u64> = emitters.iter().map(|(_, own)| own.handed_over()).collect();
        file.put(format!("{name}/handed_over"), 1, layers);
        let [gravity, evaluated_gravity] = own.gravity;
        file.put(format!("{name}/gravity"), 1, gravity);
        file.put(format!("{name}/evaluated_gravity"), 1, evaluated_gravity);
        file.put_reals(format!("{name}/body_force"), 1, &own.body_force);
        let GuardCounts {
            compression,
            expansion,
            cut_off,
        } = own.guards;
        let guards = [compression, expansion, cut_off];
        file.put(format!("{name}/guards"), 1, guards);
        let (names, counts): (Vec<&str>, Vec<u64>) = own.limited.iter().copied().unzip();
        file.put_text(format!("{name}/limits"), names.join("\n"));
        file.put(format!("{name}/limited"), 1, counts);
    }

    fn take_state(&mut self, name: &str, file: &Checkpoint) -> Read<()> {
        let scheme = self.scheme.clone();
        let layers = file.get_all(&format!("{name}/handed_over"), self.emitters.len())?;
        for ((_, emitter), layers) in self.emitters.iter().zip(layers) {
            emitter.set_handed_over(layers);
        }
        take_particles(&mut self.particles, &scheme, name, file)?;
        for wall in &self.walls {
            check_run(&self.particles, wall.slots.start..wall.end)?;
        }
        self.take_neighborhood(name, file)?;
        self.take_workspace(name, file)?;
        for (k, wall) in self.walls.iter_mut().enumerate() {
            if let Some(structure) = &mut wall.structure {
                let own = structure.accelerations.as_flattened_mut();
                let column = format!("{name}/wall{k}/accelerations");
                own.copy_from_slice(&file.get_all::<f64>(&column, own.len())?);
                let own = structure.before.as_flattened_mut();
                let column = format!("{name}/wall{k}/velocities_before");
                own.copy_from_slice(&file.get_all::<f64>(&column, own.len())?);
                structure.evaluated = file.get_one(&format!("{name}/wall{k}/evaluated"))?;
            }
        }
        if let Some(apart) = &mut self.sub_cycle {
            let count = self.particles.mobile;
            apart.forces.resize(count, [T::zero(); D]);
            let forces = file.get_all_reals(&format!("{name}/apart/forces"), count * D)?;
            apart.forces.as_flattened_mut().copy_from_slice(&forces);
            let bodies = apart.work.len();
            apart.work = file.get_all(&format!("{name}/apart/work"), bodies)?;
            apart.steps = file.get_one(&format!("{name}/apart/steps"))?;
        }
        self.gravity = file.get_array(&format!("{name}/gravity"))?;
        let evaluated: [f64; D] = file.get_array(&format!("{name}/evaluated_gravity"))?;
        self.evaluated_gravity = evaluated.map(T::from_f64);
        let force = file.get_all_reals::<T>(&format!("{name}/body_force"), D)?;
        self.body_force.copy_from_slice(&force);
        let [compression, expansion, cut_off] = file.get_array(&format!("{name}/guards"))?;
        self.guards = GuardCounts {
            compression,
            expansion,
            cut_off,
        };
        let names = file.text(&format!("{name}/limits"))?;
        let counts = file.get::<u64>(&format!("{name}/limited"))?;
        self.limited.clear();
        for (limit, count) in names.lines().zip(counts) {
            let known = limits(&scheme).find(|own| *own == limit);
            let known = known.ok_or_else(|| damaged(format!("there is no limit `{limit}`")))?;
            self.limited.push((known, count));
        }
        Ok(())
    }

    fn take_neighborhood(&mut self, name: &str, file: &Checkpoint) -> Read<()> {
        let slots = self.particles.columns.slots();
        let own = &mut self.neighborhood;
        own.listed_time = file.get_one(&format!("{name}/listed_time"))?;
        own.listed_reach = file.get_one(&format!("{name}/listed_reach"))?;
        let placed_time = file.get_one(&format!("{name}/placed_time"))?;
        own.skin = file.get_one(&format!("{name}/skin"))?;
        own.served = file.get_one(&format!("{name}/served"))?;
        own.rebuilds = file.get_one(&format!("{name}/rebuilds"))?;
        let entries = file.get_one::<u64>(&format!("{name}/sorted_entries"))?;
        own.sorted_entries = entries as usize;
        let (time, reach) = (own.listed_time, own.listed_reach);
        let x = file.get_all_reals(&format!("{name}/listed_position"), slots * D)?;
        let mut listed = vec![(Field::POSITION, x)];
        let h = self.particles.columns.raw(Field::SMOOTHING_LENGTH).len();
        let lengths = file.get_all_reals(&format!("{name}/listed_smoothing_length"), h)?;
        listed.push((Field::SMOOTHING_LENGTH, lengths));
        // Lists follow from the places and lengths that they were built from.
        let mut exchange = |columns: &mut Columns<T, D>| {
            for (field, column) in &mut listed {
                core::mem::swap(columns.column_mut(*field), column);
            }
        };
        exchange(&mut self.particles.columns);
        self.list(time, reach);
        exchange(&mut self.particles.columns);
        self.neighborhood
            .place_transforms(&self.boundaries, placed_time);
        Ok(())
    }

    fn take_workspace(&mut self, name: &str, file: &Checkpoint) -> Read<()> {
        let scheme = self.scheme.clone();
        let rows = |what: &str| take_rows(&scheme, &format!("{name}/{what}"), file);
        let saved = |what: &str, fields: Vec<Field>| -> Read<Saved<T>> {
            let mut columns = Saved::new();
            for field in fields {
                let column = format!("{name}/{what}/{}", column_name(&scheme, field));
                // What has no column is kept as none.
                let count = self.particles.columns.raw(field).len();
                let numbers = match count {
                    0 => Vec::new(),
                    _ => file.get_all_reals(&column, count)?,
                };
                columns.push((field, numbers));
            }
            Ok(columns)
        };
        let mut kept = Vec::new();
        while let what = format!("kept{}", kept.len())
            && let Ok(full) = file.get_one::<u32>(&format!("{name}/{what}/full"))
        {
            let fields = if full == 0 {
                Vec::new()
            } else {
                self.state().collect()
            };
            kept.push(saved(&what, fields)?);
        }
        self.work = Workspace {
            records: take_records(&format!("{name}/records"), file)?,
            work_records: take_records(&format!("{name}/work_records"), file)?,
            records_of_rates: file.get_one::<u32>(&format!("{name}/records_of_rates"))? != 0,
            rates: rows("rates")?,
            sums: rows("sums")?,
            coupling: rows("coupling")?,
            moved: Moves::default(),
            predicted: Saved::new(),
            is_predicted: false,
            kept,
            phases: super::Phases::default(),
            spent: super::cost::Spent::default(),
        };
        Ok(())
    }
}

/// What an evaluation between steps sets aside: the file has that, or what is there now.
struct Put<'a, T: Real, const D: usize> {
    columns: &'a Columns<T, D>,
    rates: &'a Results<T, D>,
    coupling: &'a Results<T, D>,
    apart: &'a [[T; D]],
    records: &'a Records<T>,
    work_records: &'a Records<T>,
    records_of_rates: bool,
    gravity: [[f64; D]; 2],
    body_force: [T; D],
    guards: GuardCounts,
    limited: &'a [(&'static str, u64)],
    served: u32,
}

impl<'a, T: Real, const D: usize> Put<'a, T, D> {
    fn of(aside: &'a Aside<T, D>) -> Self {
        let Aside {
            columns,
            rates,
            coupling,
            apart,
            records,
            work_records,
            records_of_rates,
            gravity,
            body_force,
            guards,
            limited,
            served,
            rebuilds: _,
        } = aside;
        Self {
            columns,
            rates,
            coupling,
            apart,
            records,
            work_records,
            records_of_rates: *records_of_rates,
            gravity: *gravity,
            body_force: *body_force,
            guards: *guards,
            limited,
            served: *served,
        }
    }
}

/// A column's name in files. Fields that effects declare may share a name.
fn column_name<T: Real, const D: usize>(scheme: &Scheme<T, D>, field: Field) -> String {
    let name_of = |field: Field| scheme.program.name_of(field).0;
    let mut others = scheme.fields().iter().filter(|other| *other != field);
    let name = name_of(field);
    if others.any(|other| name_of(other) == name) {
        return format!("{name} {}", field.place());
    }
    name.into()
}

/// Names under which limits are counted.
fn limits<T: Real, const D: usize>(scheme: &Scheme<T, D>) -> impl Iterator<Item = &'static str> {
    let program = &scheme.program;
    let laws = program.laws.iter().flatten().map(|law| law.name());
    let evolved = program.evolved.iter();
    let counted = evolved.map(|own| program.name_of(own.field).0);
    laws.chain(counted)
        .chain([super::soundness::NEGATIVE_ENERGY])
}

fn put_particles<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    columns: &Columns<T, D>,
    scheme: &Scheme<T, D>,
    name: &str,
    file: &mut Checkpoint,
) {
    let Particles {
        columns: _,
        bodies,
        mobile: _,
        ids,
        slot_of,
        removed,
        first_id: _,
    } = particles;
    for field in columns.fields().iter() {
        let column = format!("{name}/particles/{}", column_name(scheme, field));
        file.put_reals(column, field.components(D), columns.raw(field));
    }
    let end = |body: &BodyState<T>| {
        let BodyState {
            name: _,
            material: _,
            slots,
            end: _,
            ids: _,
            spacing: _,
        } = body;
        slots.end as u64
    };
    let ends: Vec<u64> = bodies.iter().map(end).collect();
    file.put(format!("{name}/body_ends"), 1, ends);
    file.put(format!("{name}/ids"), 1, ids);
    file.put(format!("{name}/slot_of"), 1, slot_of);
    let Removed {
        particles,
        mass,
        momentum,
        kinetic,
    } = removed;
    file.put_one(format!("{name}/removed/particles"), *particles);
    file.put_one(format!("{name}/removed/mass"), *mass);
    file.put(format!("{name}/removed/momentum"), 1, momentum);
    file.put_one(format!("{name}/removed/kinetic"), *kinetic);
}

fn take_particles<T: Real, const D: usize>(
    particles: &mut Particles<T, D>,
    scheme: &Scheme<T, D>,
    name: &str,
    file: &Checkpoint,
) -> Read<()> {
    let slots = particles.columns.slots();
    for field in particles.columns.fields().iter() {
        let column = format!("{name}/particles/{}", column_name(scheme, field));
        let numbers = file.get_all_reals(&column, slots * field.components(D))?;
        *particles.columns.column_mut(field) = numbers;
    }
    let ends = file.get_all::<u64>(&format!("{name}/body_ends"), particles.bodies.len())?;
    particles.ids = file.get_all(&format!("{name}/ids"), slots)?;
    particles.slot_of = file.get_all(&format!("{name}/slot_of"), slots)?;
    for (k, end) in ends.into_iter().enumerate() {
        let run = particles.bodies[k].run();
        check_run(particles, run.clone())?;
        let end = end as usize;
        if !(run.start..=run.end).contains(&end) {
            return Err(damaged("a body ends outside of its run"));
        }
        particles.bodies[k].slots.end = end;
    }
    particles.removed = Removed {
        particles: file.get_one(&format!("{name}/removed/particles"))?,
        mass: file.get_one(&format!("{name}/removed/mass"))?,
        momentum: file.get_array(&format!("{name}/removed/momentum"))?,
        kinetic: file.get_one(&format!("{name}/removed/kinetic"))?,
    };
    Ok(())
}

/// Particles stay in the run of their body or wall.
fn check_run<T: Real, const D: usize>(particles: &Particles<T, D>, run: Range<usize>) -> Read<()> {
    let inside = |slot: &u32| run.contains(&(*slot as usize));
    let ids = particles.ids[run.clone()].iter().all(inside);
    let slots = particles.slot_of[run.clone()].iter();
    if ids && slots.filter(|slot| **slot != u32::MAX).all(inside) {
        return Ok(());
    }
    Err(damaged("a particle is outside of the run of its body"))
}

fn put_neighborhood<T: Real, const D: usize>(
    neighborhood: &Neighborhood<T, D>,
    slots: usize,
    name: &str,
    file: &mut Checkpoint,
) {
    let Neighborhood {
        blocks: _,
        interactions: _,
        images: _,
        transforms: _,
        chains: _,
        lists: _,
        listed,
        listed_h,
        listed_time,
        listed_reach,
        placed_time,
        skin,
        skins: _,
        served: _,
        rebuilds,
        sorted_entries,
        support: _,
        smoothing_length: _,
    } = neighborhood;
    // Images stand behind the slots.
    let listed = listed[..slots].as_flattened();
    let lengths = &listed_h[..slots.min(listed_h.len())];
    file.put_reals(format!("{name}/listed_position"), D, listed);
    file.put_reals(format!("{name}/listed_smoothing_length"), 1, lengths);
    file.put_one(format!("{name}/listed_time"), *listed_time);
    file.put_one(format!("{name}/listed_reach"), *listed_reach);
    file.put_one(format!("{name}/placed_time"), *placed_time);
    file.put_one(format!("{name}/skin"), *skin);
    file.put_one(format!("{name}/rebuilds"), *rebuilds);
    file.put_one(format!("{name}/sorted_entries"), *sorted_entries as u64);
}

fn put_workspace<T: Real, const D: usize>(
    work: &Workspace<T, D>,
    own: &Put<'_, T, D>,
    (scheme, has_walls): (&Scheme<T, D>, bool),
    name: &str,
    file: &mut Checkpoint,
) {
    let Workspace {
        records: _,
        work_records: _,
        records_of_rates: _,
        rates: _,
        sums,
        coupling: _,
        // Saved states have been told between steps.
        moved: _,
        // A prediction is taken back in the step that makes it.
        predicted: _,
        is_predicted: _,
        kept,
        phases: _,
        spent: _,
    } = work;
    // Only sums over walls read records without packing them.
    let records = if own.records_of_rates && has_walls {
        own.records
    } else {
        &Records::default()
    };
    put_records(records, &format!("{name}/records"), file);
    put_records(own.work_records, &format!("{name}/work_records"), file);
    let of_rates = u32::from(own.records_of_rates);
    file.put_one(format!("{name}/records_of_rates"), of_rates);
    let all = [
        ("rates", own.rates),
        ("sums", sums),
        ("coupling", own.coupling),
    ];
    for (what, rows) in all {
        put_rows(rows, &format!("{name}/{what}"), file);
    }
    let mut put_saved = |what: &str, saved: &Saved<T>| {
        for (field, column) in saved.iter().filter(|(_, column)| !column.is_empty()) {
            let name = format!("{name}/{what}/{}", column_name(scheme, *field));
            file.put_reals(name, field.components(D), column);
        }
    };
    for (k, saved) in kept.iter().enumerate() {
        put_saved(&format!("kept{k}"), saved);
    }
    for (k, saved) in kept.iter().enumerate() {
        let full = u32::from(!saved.is_empty());
        file.put_one(format!("{name}/kept{k}/full"), full);
    }
}

fn put_records<T: Real>(records: &Records<T>, name: &str, file: &mut Checkpoint) {
    file.put_reals(name.into(), records.stride().max(1), records.data());
    file.put_one(format!("{name}/stride"), records.stride() as u64);
}

fn take_records<T: Real>(name: &str, file: &Checkpoint) -> Read<Records<T>> {
    let stride = file.get_one::<u64>(&format!("{name}/stride"))? as usize;
    Ok(Records::of_stored(file.get_reals(name)?, stride))
}

/// A sum's name in files: those that effects declare have no names of their own.
fn sum_name(sum: Output) -> String {
    format!("{} {}", sum.name(), sum.place())
}

fn put_rows<T: Real, const D: usize>(rows: &Results<T, D>, name: &str, file: &mut Checkpoint) {
    let names: Vec<_> = rows.outputs().iter().map(sum_name).collect();
    let (data, first) = rows.stored();
    file.put_text(name, names.join("\n"));
    file.put_reals(name.into(), 1, data);
    file.put_one(format!("{name}/first"), first as u64);
    let blocks: Vec<u32> = rows
        .reactions()
        .flat_map(|Reaction { on, from, force: _ }| [*on, *from])
        .collect();
    let forces: Vec<f64> = rows
        .reactions()
        .flat_map(|reaction| reaction.force)
        .collect();
    file.put(format!("{name}/reactions/blocks"), 2, blocks);
    file.put(format!("{name}/reactions/force"), D, forces);
}

fn take_rows<T: Real, const D: usize>(
    scheme: &Scheme<T, D>,
    name: &str,
    file: &Checkpoint,
) -> Read<Results<T, D>> {
    let sweeps = Stage::ALL
        .into_iter()
        .filter_map(|stage| scheme.sweep(stage));
    let sweeps = sweeps.chain(scheme.reference.as_deref());
    let known = sweeps.fold(Outputs::ALL, |all, sweep| all.union(sweep.outputs()));
    let mut outputs = Outputs::NONE;
    for sum in file.text(name)?.lines() {
        let own = known.iter().find(|own| sum_name(*own) == sum);
        let own = own.ok_or_else(|| damaged(format!("there is no sum `{sum}`")))?;
        outputs = outputs.union(Outputs::of(&[own]));
    }
    let first = file.get_one::<u64>(&format!("{name}/first"))? as usize;
    let blocks = file.get::<u32>(&format!("{name}/reactions/blocks"))?;
    let (blocks, _) = blocks.as_chunks::<2>();
    let column = format!("{name}/reactions/force");
    let forces = file.get_all::<f64>(&column, blocks.len() * D)?;
    let (forces, _) = forces.as_chunks::<D>();
    let reactions = blocks
        .iter()
        .zip(forces)
        .map(|([on, from], force)| Reaction {
            on: *on,
            from: *from,
            force: *force,
        });
    let data = file.get_reals(name)?;
    Ok(Results::of_stored(
        outputs,
        (data, first),
        reactions.collect(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::{Body, Scene, catalogue, schemes};

    #[test]
    fn instructions_that_a_machine_lacks_are_named() {
        let rod = Body::block("rod", catalogue::copper(), [0.0], [0.01], 1e-3);
        let scene = Scene::<f64, 1>::new(schemes::impact()).body(rod);
        let simulation = scene.instructions(InstructionSet::Baseline).build();
        let simulation = simulation.unwrap();
        let mut file = simulation.put();
        for (set, best, runs) in [
            ("Baseline", InstructionSet::Baseline, true),
            ("Avx2", InstructionSet::Avx512, true),
            ("Avx2", InstructionSet::Baseline, false),
            ("Avx512", InstructionSet::Avx2, false),
        ] {
            file.put_text("instructions", set);
            let found = set.into();
            let lacks = Err(CheckpointProblem::Instructions { found });
            let expected = if runs { Ok(()) } else { lacks };
            assert_eq!(simulation.check(&file, best), expected, "{set}");
        }
    }
}
