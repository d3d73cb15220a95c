//! What a checkpoint holds of a group: what it is made of, what couplings have done to it, and what is counted.
//! Of walls it is what follows the bodies that they are.

use super::change::{Change, Changes};
use super::held::{put_held, take_held};
use super::particles::{put_particles, take_particles};
use super::whole::{Kept, Whole};
use super::workspace::{put_neighborhood, put_workspace, take_neighborhood, take_workspace};
use crate::boundary::Pose;
use crate::material::eos::GuardCounts;
use crate::output::checkpoint::{Checkpoint, Read, damaged};
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::simulation::group::Group;
use crate::simulation::own_group::Lists;
use crate::simulation::soundness::NEGATIVE_ENERGY;
use crate::simulation::sources::{DrainState, SourceState};
use crate::simulation::sub_cycle::SubCycle;
use crate::simulation::walls::Structure;
use crate::simulation::workspace::Workspace;
use core::mem::take;

impl<T: Real, const D: usize> Group<T, D> {
    pub(super) fn put(&self, name: &str, file: &mut Checkpoint) {
        let Self {
            particles,
            neighborhood,
            work,
            scheme,
            share: _,
            all,
            walls,
            boundaries,
            // By the events, which are kept.
            exchanges: _,
            outlets: _,
            emitters,
            sources,
            drains,
            gravity,
            body_force,
            indices: _,
            is_met: _,
            sub_cycle,
            held,
            instructions: _,
            root: _,
            guards,
            limited,
            // Of a step under way.
            kept_times: _,
            given: _,
            joins_given: _,
        } = self;
        // Records of images follow from all particles.
        let records = work.records_of_rates && !walls.is_empty();
        let has_images = !boundaries.is_empty();
        if all.is_some() && has_images && (records || !work.work_records.data().is_empty()) {
            let mut together = self.clone();
            together.bring_together(Lists::None, None);
            together.put(name, file);
            return;
        }
        let (slots, whole) = (particles.columns.slots(), Whole::new(self));
        put_particles((particles, &whole), scheme, name, file);
        put_neighborhood((neighborhood, &whole), slots, name, file);
        file.put_one(format!("{name}/served"), neighborhood.served);
        put_workspace((work, &whole), (scheme, !walls.is_empty()), name, file);
        for (k, wall) in walls.iter().enumerate() {
            if let Some(structure) = &wall.structure {
                let Structure {
                    coupling: _,
                    group: _,
                    body: _,
                    accelerations,
                    spins: _,
                    before,
                    evaluated,
                    rigid: _,
                } = structure;
                let numbers = accelerations.as_flattened();
                file.put(format!("{name}/wall{k}/accelerations"), D, numbers);
                let numbers = before.as_flattened();
                file.put(format!("{name}/wall{k}/velocities_before"), D, numbers);
                file.put_one(format!("{name}/wall{k}/evaluated"), *evaluated);
            }
        }
        if let Some(SubCycle {
            count: _,
            forces,
            work,
            steps,
        }) = sub_cycle
        {
            file.put_reals(format!("{name}/apart/forces"), D, forces.as_flattened());
            file.put(format!("{name}/apart/work"), 1, work);
            file.put_one(format!("{name}/apart/steps"), *steps);
        }
        put_held(held, name, file);
        let layers: Vec<u64> = emitters.iter().map(|own| own.layers).collect();
        file.put(format!("{name}/handed_over"), 1, layers);
        for (k, wall) in walls.iter().enumerate() {
            if let Some(inflow) = &wall.inflow {
                file.put(format!("{name}/wall{k}/gone"), 1, &inflow.gone);
                file.put_one(format!("{name}/wall{k}/gone_by"), inflow.time);
            }
        }
        for (k, SourceState { entered, next, .. }) in sources.iter().enumerate() {
            file.put(format!("{name}/source{k}"), 1, [*entered, *next]);
        }
        for (k, DrainState { due, time, .. }) in drains.iter().enumerate() {
            file.put(format!("{name}/drain{k}"), 1, [*due, *time]);
        }
        let evaluated_gravity = work.evaluated_gravity.map(Real::to_f64);
        file.put(format!("{name}/gravity"), 1, gravity);
        file.put(format!("{name}/evaluated_gravity"), 1, evaluated_gravity);
        file.put_reals(format!("{name}/body_force"), 1, body_force);
        // Ranks have joined their counts when a call ends.
        let (guards, limited) = match all {
            Some(all) => (&all.guards, &all.limited),
            None => (guards, limited),
        };
        let GuardCounts {
            compression,
            expansion,
            cut_off,
        } = *guards;
        let guards = [compression, expansion, cut_off];
        file.put(format!("{name}/guards"), 1, guards);
        let (names, counts): (Vec<&str>, Vec<u64>) = limited.iter().copied().unzip();
        file.put_text(format!("{name}/limits"), names.join("\n"));
        file.put(format!("{name}/limited"), 1, counts);
    }

    pub(super) fn take_state(
        &mut self,
        name: &str,
        file: &Checkpoint,
        changes: Changes<'_>,
    ) -> Read<()> {
        let scheme = self.scheme.clone();
        let layers = file.get_all(&format!("{name}/handed_over"), self.emitters.len())?;
        for (emitter, layers) in self.emitters.iter_mut().zip(layers) {
            emitter.layers = layers;
            let buffer = &mut self.walls[emitter.wall];
            buffer.set_motion(emitter.inflow(), &self.particles.origin);
        }
        for (k, wall) in self.walls.iter_mut().enumerate() {
            if let Some(inflow) = &mut wall.inflow {
                let count = inflow.gone.len();
                inflow.gone = file.get_all(&format!("{name}/wall{k}/gone"), count)?;
                inflow.time = file.get_one(&format!("{name}/wall{k}/gone_by"))?;
            }
        }
        for (k, own) in self.sources.iter_mut().enumerate() {
            [own.entered, own.next] = file.get_array(&format!("{name}/source{k}"))?;
            if own.next >= own.source.points.len() as u64 {
                return Err(damaged("a source has no point whose turn it is"));
            }
        }
        for (k, own) in self.drains.iter_mut().enumerate() {
            [own.due, own.time] = file.get_array(&format!("{name}/drain{k}"))?;
        }
        let kept = Kept::new(self);
        take_particles(self, &kept, (name, file), changes)?;
        let columns = (&self.particles.columns, &kept);
        let taken = take_neighborhood(&mut self.neighborhood, columns, name, file)?;
        self.work = if changes.is_anew {
            Workspace {
                lengths_time: file.get_one(&format!("{name}/lengths_time"))?,
                ..Workspace::default()
            }
        } else {
            let all = self.all.as_ref().map(|all| &*all.particles);
            let mobile = all.unwrap_or(&self.particles).mobile;
            take_workspace(columns, (&scheme, mobile), name, file)?
        };
        // Lists follow from the places and lengths that they were built from.
        let (mut listed, placed_time) = taken;
        let mut exchange = |columns: &mut crate::particles::Columns<T, D>| {
            for (field, column) in &mut listed {
                core::mem::swap(columns.column_mut(*field), column);
            }
        };
        exchange(&mut self.particles.columns);
        let near = &self.neighborhood;
        self.list_read((near.listed_time, near.listed_reach));
        exchange(&mut self.particles.columns);
        self.neighborhood
            .place_transforms(&self.boundaries, placed_time);
        if self.all.is_some() {
            self.show_images_again();
        }
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
        take_held(&mut self.held, (name, file), changes)?;
        self.gravity = file.get_array(&format!("{name}/gravity"))?;
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
            match known {
                Some(known) => self.limited.push((known, count)),
                None if changes.has(Change::Viscosity) => {}
                None => return Err(damaged(format!("there is no limit `{limit}`"))),
            }
        }
        if let Some(all) = &mut self.all {
            let own = (&mut self.guards, &mut self.limited);
            (all.guards, all.limited) = (take(own.0), take(own.1));
        }
        Ok(())
    }

    /// Brings walls that are none of bodies or inlets to where their motions have them at `time` \[s\], or where they are built.
    pub(super) fn stand_walls(&mut self, time: f64) {
        let of_inlets: Vec<usize> = self.emitters.iter().map(|own| own.wall).collect();
        for (k, wall) in self.walls.iter().enumerate() {
            if wall.structure.is_none() && wall.inflow.is_none() && !of_inlets.contains(&k) {
                let pose = wall.pose(time, None).unwrap_or_else(Pose::rest);
                wall.place(&pose, &mut self.particles, &self.boundaries, time);
            }
        }
    }
}

/// Names under which limits are counted.
fn limits<T: Real, const D: usize>(scheme: &Scheme<T, D>) -> impl Iterator<Item = &'static str> {
    let program = &scheme.program;
    let laws = program.laws.iter().flatten().map(|law| law.name());
    let evolved = program.evolved.iter();
    let counted = evolved.map(|own| program.name_of(own.field));
    laws.chain(counted).chain([NEGATIVE_ENERGY])
}
