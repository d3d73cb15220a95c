//! The state as a device needs it: columns, rates, walls, neighbour lists; and how it is taken back.
//! Lists are built here, from places that the device has sent, so they are those of the host.

use super::program::Kind;
use super::{Moment, Offloaded};
use crate::neighbors::{Block, ChunkList};
use crate::particles::{Columns, Field, Outputs};
use crate::scalar::{Real, width};
use crate::scheme::EnergyForm;
use crate::sweep::{Interaction, Reaction, Records, Results};
use crate::term::Stage;
use std::ops::Range;

/// How far particles have moved since lists were built.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    /// The square of the largest displacement \[m²\].
    pub farthest2: f64,
    /// The least and the largest component of displacements along each axis \[m\].
    pub range: [Vec<f64>; 2],
    /// By how much a smoothing length has grown at most \[m\].
    pub grown: f64,
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// The columns of all particles, those of walls behind those of bodies.
    #[must_use]
    pub fn columns(&self) -> &Columns<T, D> {
        &self.simulation.state.groups[0].particles.columns
    }

    /// The same, to be taken from the device.
    pub fn columns_mut(&mut self) -> &mut Columns<T, D> {
        &mut self.simulation.state.groups[0].particles.columns
    }

    /// Slots below this move by forces.
    #[must_use]
    pub fn mobile(&self) -> usize {
        self.simulation.state.groups[0].particles.mobile
    }

    /// Particles a cluster.
    #[must_use]
    pub fn cluster(&self) -> usize {
        width::<T>()
    }

    /// The rates at hand: which sums, and their numbers slot by slot for all that moves by forces.
    #[must_use]
    pub fn rates(&self) -> (Outputs, Vec<T>) {
        let group = &self.simulation.state.groups[0];
        let outputs = group.scheme.sums(Stage::Rates);
        let rates = &group.work.rates;
        let mut all = Vec::new();
        for slot in 0..group.particles.mobile {
            for sum in outputs.iter() {
                all.extend((0..sum.components(D)).map(|k| rates.get(sum, k, slot)));
            }
        }
        (outputs, all)
    }

    /// Forces \[N\] between blocks that came with the rates at hand: the block that feels, the one that exerts.
    #[must_use]
    pub fn forces(&self) -> Vec<([usize; 2], [f64; D])> {
        let mut all: Vec<([usize; 2], [f64; D])> = Vec::new();
        for own in self.simulation.state.groups[0].work.rates.reactions() {
            let pair = [own.on as usize, own.from as usize];
            match all.iter_mut().find(|other| other.0 == pair) {
                Some(sum) => (0..D).for_each(|d| sum.1[d] += own.force[d]),
                None => all.push((pair, own.force)),
            }
        }
        all
    }

    /// The records of particles and images that are kept for the work of kicks, as [`KeepStep::reads`](super::KeepStep) says but for
    /// whether particles are active in contacts; empty where no sweep sums that work.
    #[must_use]
    pub fn kept_records(&self) -> &[T] {
        self.simulation.state.groups[0].work.work_records.data()
    }

    /// Takes the rates back, as [`rates`](Self::rates) gives them, with the forces between blocks and the records that are kept, `stride`
    /// numbers each.
    pub fn take_rates(
        &mut self,
        numbers: &[T],
        forces: &[([usize; 2], [f64; D])],
        (records, stride): (Vec<T>, usize),
    ) {
        let group = &mut self.simulation.state.groups[0];
        let outputs = group.scheme.sums(Stage::Rates);
        group.work.rates = Results::of_rows(outputs, numbers, reactions(forces));
        // Nothing but pairs adds to the rates of what runs on a device.
        if group.scheme.sweeps_work() {
            group.work.work_records = Records::of_stored(records, stride);
        } else if group.scheme.energy == EnergyForm::Compatible {
            group.work.worked.copy(&group.work.rates);
        }
        group.work.records_of_rates = false;
        group.work.first_kick = None;
    }

    /// Books what forces \[N\] between blocks give in kicks over `dt` \[s\].
    pub fn book(&mut self, dt: f64, forces: &[([usize; 2], [f64; D])]) {
        let outputs = self.simulation.state.groups[0].work.rates.outputs();
        let work = &mut self.simulation.state.groups[0].work;
        let rates = Results::of_stored(outputs, (Vec::new(), 0), reactions(forces));
        let kept = core::mem::replace(&mut work.rates, rates);
        self.simulation.record_kick(None, dt);
        self.simulation.state.groups[0].work.rates = kept;
    }

    /// What a prediction has saved.
    #[must_use]
    pub fn saved(&self, field: Field) -> &[T] {
        let saved = &self.simulation.state.groups[0].work.predicted;
        let own = saved.iter().find(|own| own.0 == field);
        own.map_or(&[], |own| &own.1)
    }

    /// Takes what a prediction has saved back while one is under way, so that it follows what list builds do.
    pub fn take_saved(&mut self, saved: Vec<(Field, Vec<T>)>) {
        let work = &mut self.simulation.state.groups[0].work;
        work.is_predicted = !saved.is_empty();
        work.predicted = saved;
    }

    /// Counts that the device has made, in the order of [`Program::counts`](super::Program::counts).
    pub fn count(&mut self, counts: &[f64]) {
        let program = self.program.clone();
        let group = &mut self.simulation.state.groups[0];
        for (own, count) in program.counts.iter().zip(counts) {
            let count = count.round() as u64;
            match own.kind {
                Kind::Limit(name) => group.count(name, count),
                Kind::Guard(0) => group.guards.compression += count,
                Kind::Guard(1) => group.guards.expansion += count,
                Kind::Guard(_) => group.guards.cut_off += count,
            }
        }
    }

    /// Moves walls and boundaries to where they are at a moment; the slots of walls that move, whose columns the device needs anew, and
    /// whether it needs [transforms](Self::transforms) anew.
    pub fn place_walls(&mut self, moment: &Moment) -> (Vec<Range<usize>>, bool) {
        let group = &mut self.simulation.state.groups[0];
        group.place_walls(moment.time, moment.chord);
        let moving = group.walls.iter().filter(|wall| wall.motion.is_some());
        let slots = moving.map(|wall| wall.slots.start..wall.end).collect();
        (slots, self.place_boundaries(moment.time))
    }

    /// What wall laws see at the particles of walls at a time \[s\]: accelerations \[m/s²\], normals, and velocity gradients \[1/s\] row
    /// by row, each component for all slots behind those of bodies.
    #[must_use]
    pub fn walls(&self, time: f64) -> Vec<f64> {
        let group = &self.simulation.state.groups[0];
        let (mobile, slots) = (group.particles.mobile, group.particles.columns.slots());
        let count = slots - mobile;
        let mut all = vec![0.0; (2 * D + D * D) * count];
        for wall in &group.walls {
            let surface = wall.surface(&group.particles.ids, time, false);
            for slot in wall.slots.start..wall.end {
                let mut put = |k: usize, value: f64| all[k * count + slot - mobile] = value;
                let acceleration = surface.acceleration(slot);
                let normal = surface.normal(slot);
                let gradient = surface.velocity_gradient(slot);
                for a in 0..D {
                    put(a, acceleration[a]);
                    if let Some(normal) = &normal {
                        put(D + a, normal[a].to_f64());
                    }
                    for b in 0..D {
                        if let Some(gradient) = &gradient {
                            put(2 * D + a * D + b, gradient[(a, b)]);
                        }
                    }
                }
            }
        }
        all
    }

    /// The acceleration of all particles in the frame of their container \[m/s²\].
    #[must_use]
    pub fn body_force(&self) -> [f64; D] {
        self.simulation.state.groups[0].body_force.map(Real::to_f64)
    }

    /// The smoothing length \[m\] that serves all, and the lattice consistency factor.
    #[must_use]
    pub fn scales(&self) -> [f64; 2] {
        let group = &self.simulation.state.groups[0];
        let h = group.neighborhood.smoothing_length;
        [h, group.scheme.lattice_consistency_factor]
    }

    /// The neighbour lists, chunk by chunk.
    #[must_use]
    pub fn lists(&self) -> &[ChunkList] {
        self.simulation.state.groups[0].neighborhood.lists.chunks()
    }

    /// The blocks of the lists: bodies, then walls.
    #[must_use]
    pub fn blocks(&self) -> &[Block] {
        &self.simulation.state.groups[0].neighborhood.blocks
    }

    /// The share of a closing speed that counts where a particle meets one of each block: half where that mirrors its velocity.
    #[must_use]
    pub fn seen(&self) -> Vec<f64> {
        let group = &self.simulation.state.groups[0];
        let sticks = group.particles.columns.fields();
        let sticks = sticks.contains(Field::DYNAMIC_VISCOSITY);
        let share = |mirrored: &bool| if sticks && *mirrored { 0.5 } else { 1.0 };
        group.neighborhood.mirrored.iter().map(share).collect()
    }

    /// Whether a contact that may open is between blocks `a` and `b`, at `a * blocks + b`.
    #[must_use]
    pub fn contacts(&self) -> Vec<bool> {
        let interactions = &self.simulation.state.groups[0].neighborhood.interactions;
        let opens = interactions
            .iter()
            .map(|own| *own == Interaction::Unilateral);
        opens.collect()
    }

    /// The places for which lists were built \[m\], from the origin of the columns.
    #[must_use]
    pub fn listed(&self) -> &[[T; D]] {
        let slots = self.columns().slots();
        &self.simulation.state.groups[0].neighborhood.listed[..slots]
    }

    /// The smoothing lengths for which lists were built \[m\]; empty where one serves all.
    #[must_use]
    pub fn listed_lengths(&self) -> &[T] {
        let all = &self.simulation.state.groups[0].neighborhood.listed_h;
        &all[..all.len().min(self.columns().slots())]
    }

    /// Whether lists are outdated at a time \[s\]; else they serve once more.
    pub fn is_outdated(&mut self, moved: &Moved, time: f64) -> bool {
        let is_outdated = self.has_used_skin(moved, time);
        let neighborhood = &mut self.simulation.state.groups[0].neighborhood;
        neighborhood.served += u32::from(!is_outdated);
        is_outdated
    }

    fn has_used_skin(&self, moved: &Moved, time: f64) -> bool {
        let group = &self.simulation.state.groups[0];
        let shift = group.carried_since_listed(time);
        let left = group
            .neighborhood
            .left(&group.boundaries, moved.grown, (shift, time));
        let farthest = moved.farthest2.sqrt();
        if 2.0 * farthest <= left || !group.is_open() {
            return 2.0 * farthest > left;
        }
        let [low, high] = &moved.range;
        let apart: f64 = low.iter().zip(high).map(|(a, b)| (b - a).powi(2)).sum();
        apart.sqrt() > left
    }

    /// Builds lists for the places of the columns, which it may sort anew, at a time \[s\].
    pub fn rebuild(&mut self, time: f64) {
        let group = &mut self.simulation.state.groups[0];
        group.neighborhood.choose_skin();
        group.rebuild(time);
        group.neighborhood.served = 1;
        self.simulation.follow_moves(0);
    }
}

fn reactions<const D: usize>(forces: &[([usize; 2], [f64; D])]) -> Vec<Reaction<D>> {
    let of = |([on, from], force): &([usize; 2], [f64; D])| Reaction {
        on: *on as u32,
        from: *from as u32,
        force: *force,
    };
    forces.iter().map(of).collect()
}
