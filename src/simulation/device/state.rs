//! The state as a device needs it: columns, rates, walls, neighbour lists; and how it is taken back.
//! Lists that a device does not build are built here, from places that it has sent.

use super::Offloaded;
use super::program::Kind;
use crate::neighbors::{Block, ChunkList};
use crate::particles::{Columns, Field, Output, Outputs};
use crate::scalar::{Real, width};
use crate::scheme::EnergyForm;
use crate::simulation::{Group, Simulation};
use crate::sweep::{Interaction, Reaction, Records, Results};
use crate::term::Stage;

/// Forces \[N\] between blocks: the one that feels, the one that exerts.
pub type Forces<const D: usize> = Vec<([usize; 2], [f64; D])>;

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

impl Moved {
    /// Nothing has moved in `dimensions` dimensions.
    pub(super) fn none(dimensions: usize) -> Self {
        Self {
            farthest2: 0.0,
            range: [vec![0.0; dimensions], vec![0.0; dimensions]],
            grown: 0.0,
        }
    }
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// The columns of all particles of a group, those of walls behind those of bodies.
    #[must_use]
    pub fn columns(&self, group: usize) -> &Columns<T, D> {
        &self.simulation.state.groups[group].particles.columns
    }

    /// The same, to be taken from the device.
    pub fn columns_mut(&mut self, group: usize) -> &mut Columns<T, D> {
        &mut self.simulation.state.groups[group].particles.columns
    }

    /// Slots below this move by forces.
    #[must_use]
    pub fn mobile(&self, group: usize) -> usize {
        self.simulation.state.groups[group].particles.mobile
    }

    /// Particles a cluster.
    #[must_use]
    pub fn cluster(&self) -> usize {
        width::<T>()
    }

    /// The rates at hand: which sums, and their numbers slot by slot for all that moves by forces.
    #[must_use]
    pub fn rates(&self, group: usize) -> (Outputs, Vec<T>) {
        let group = &self.simulation.state.groups[group];
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

    /// Forces \[N\] between blocks that came with the rates at hand: the block that feels, the one that exerts. Bodies feel, and walls
    /// that are [bodies of other groups](super::FollowStep).
    #[must_use]
    pub fn forces(&self, group: usize) -> Forces<D> {
        let mut all: Forces<D> = Vec::new();
        let work = &self.simulation.state.groups[group].work;
        for own in work.rates.reactions().chain(work.coupling.reactions()) {
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
    pub(super) fn kept_records(&self, group: usize) -> &[T] {
        self.simulation.state.groups[group].work.work_records.data()
    }

    /// The forces \[N\] that pairs of a group give with the rates at hand, slot by slot for all that moves by forces; empty where they
    /// are in the [rates](Self::rates), to which nothing else adds.
    pub(super) fn own_forces(&self, group: usize) -> Vec<[T; D]> {
        let (own, group) = (&self.recorded[group], &self.simulation.state.groups[group]);
        let there = 0..own.program.own_forces.map_or(0, |_| group.particles.mobile);
        let worked = &group.work.worked;
        there
            .map(|slot| worked.vector(Output::FORCE, slot))
            .collect()
    }

    /// Takes the rates of a group back, as [`rates`](Self::rates) gives them, with its [own forces](Self::own_forces), the forces between
    /// blocks, and the records that are kept, `stride` numbers each.
    pub(super) fn take_rates(
        &mut self,
        number: usize,
        (numbers, own): (&[T], &[[T; D]]),
        forces: &[([usize; 2], [f64; D])],
        (records, stride): (Vec<T>, usize),
    ) {
        let group = &mut self.simulation.state.groups[number];
        let outputs = group.scheme.sums(Stage::Rates);
        let bodies = group.particles.bodies.len();
        let (of_bodies, of_structures): (Forces<D>, Forces<D>) =
            forces.iter().partition(|own| own.0[0] < bodies);
        group.work.rates = Results::of_rows(outputs, numbers, reactions(&of_bodies));
        let of_structures = reactions(&of_structures);
        if !of_structures.is_empty() {
            group.work.coupling = Results::of_stored(outputs, (Vec::new(), 0), of_structures);
        }
        if group.scheme.sweeps_work() {
            group.work.work_records = Records::of_stored(records, stride);
        } else if group.scheme.energy == EnergyForm::Compatible {
            group.work.worked.copy(&group.work.rates);
            for (slot, force) in own.iter().enumerate() {
                group.work.worked.set(Output::FORCE, slot, *force);
            }
        }
        group.work.records_of_rates = false;
        group.work.first_kick = None;
    }

    /// Books what forces \[N\] between blocks give in kicks over `dt` \[s\], group by group.
    pub fn book(&mut self, dt: f64, forces: &[Forces<D>]) {
        self.with_forces(forces, |own| own.record_kick(None, dt));
    }

    /// Acts on the simulation as if forces \[N\] between blocks came with its rates, group by group.
    pub(super) fn with_forces<V>(
        &mut self,
        forces: &[Forces<D>],
        act: impl FnOnce(&mut Simulation<T, D>) -> V,
    ) -> V {
        let mut kept = Vec::new();
        for (group, forces) in self.simulation.state.groups.iter_mut().zip(forces) {
            let outputs = group.work.rates.outputs();
            let rates = Results::of_stored(outputs, (Vec::new(), 0), reactions(forces));
            let coupling = core::mem::take(&mut group.work.coupling);
            let rates = core::mem::replace(&mut group.work.rates, rates);
            // What clamps give is added up on the device.
            let clamps = core::mem::take(&mut group.held.clamps);
            kept.push((rates, coupling, clamps));
        }
        // What laws give and forces of couplings work is, too.
        let columns = |group: &mut Group<T, D>| {
            core::mem::take(group.particles.columns.column_mut(Field::FORCE))
        };
        let groups = self.simulation.state.groups.iter_mut();
        let of_laws: Vec<_> = groups.map(columns).collect();
        let couples = self.simulation.state.couples.iter_mut();
        let forces: Vec<_> = couples
            .map(|own| core::mem::take(&mut own.acting.forces))
            .collect();
        let given = act(&mut self.simulation);
        for (group, forces) in self.simulation.state.groups.iter_mut().zip(of_laws) {
            *group.particles.columns.column_mut(Field::FORCE) = forces;
        }
        for (own, forces) in self.simulation.state.couples.iter_mut().zip(forces) {
            own.acting.forces = forces;
        }
        for (group, kept) in self.simulation.state.groups.iter_mut().zip(kept) {
            (group.work.rates, group.work.coupling, group.held.clamps) = kept;
        }
        given
    }

    /// What a prediction has saved.
    pub(super) fn saved(&self, group: usize, field: Field) -> &[T] {
        let saved = &self.simulation.state.groups[group].work.predicted;
        let own = saved.iter().find(|own| own.0 == field);
        own.map_or(&[], |own| &own.1)
    }

    /// Takes what a prediction has saved back while one is under way, so that it follows what list builds do.
    pub(super) fn take_saved(&mut self, group: usize, saved: Vec<(Field, Vec<T>)>) {
        let work = &mut self.simulation.state.groups[group].work;
        work.is_predicted = !saved.is_empty();
        work.predicted = saved;
    }

    /// Counts that the device has made, in the order of [`Program::counts`](super::Program::counts).
    pub(super) fn count(&mut self, group: usize, counts: &[u64]) {
        let program = self.program(group);
        let group = &mut self.simulation.state.groups[group];
        for (own, count) in program.counts.iter().zip(counts) {
            let count = *count;
            match own.kind {
                Kind::Limit(name) => group.count(name, count),
                Kind::Guard(0) => group.guards.compression += count,
                Kind::Guard(1) => group.guards.expansion += count,
                Kind::Guard(_) => group.guards.cut_off += count,
            }
        }
    }

    /// What wall laws see at the particles of walls at a time \[s\]: accelerations \[m/s²\], normals, and velocity gradients \[1/s\] row
    /// by row, each component for all slots behind those of bodies.
    pub(super) fn walls(&self, group: usize, time: f64) -> Vec<f64> {
        let group = &self.simulation.state.groups[group];
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
    pub(super) fn body_force(&self, group: usize) -> [f64; D] {
        self.simulation.state.groups[group]
            .body_force
            .map(Real::to_f64)
    }

    /// The smoothing length \[m\] that serves all, and the lattice consistency factor.
    pub(super) fn scales(&self, group: usize) -> [f64; 2] {
        let group = &self.simulation.state.groups[group];
        let h = group.neighborhood.smoothing_length;
        [h, group.scheme.lattice_consistency_factor]
    }

    /// The neighbour lists, chunk by chunk.
    #[must_use]
    pub fn lists(&self, group: usize) -> &[ChunkList] {
        self.simulation.state.groups[group]
            .neighborhood
            .lists
            .chunks()
    }

    /// The blocks of the lists: bodies, then walls.
    #[must_use]
    pub fn blocks(&self, group: usize) -> &[Block] {
        &self.simulation.state.groups[group].neighborhood.blocks
    }

    /// The share of a closing speed that counts where a particle meets one of each block: half where that mirrors its velocity.
    pub(super) fn seen(&self, group: usize) -> Vec<f64> {
        let group = &self.simulation.state.groups[group];
        let sticks = group.particles.columns.fields();
        let sticks = sticks.contains(Field::DYNAMIC_VISCOSITY);
        let share = |mirrored: &bool| if sticks && *mirrored { 0.5 } else { 1.0 };
        group.neighborhood.mirrored.iter().map(share).collect()
    }

    /// Whether a contact that may open is between blocks `a` and `b`, at `a * blocks + b`.
    pub(super) fn contacts(&self, group: usize) -> Vec<bool> {
        let interactions = &self.simulation.state.groups[group]
            .neighborhood
            .interactions;
        let opens = interactions
            .iter()
            .map(|own| *own == Interaction::Unilateral);
        opens.collect()
    }

    /// The places for which lists were built \[m\], from the origin of the columns.
    pub(super) fn listed(&self, group: usize) -> &[[T; D]] {
        let slots = self.columns(group).slots();
        &self.simulation.state.groups[group].neighborhood.listed[..slots]
    }

    /// The smoothing lengths for which lists were built \[m\]; empty where one serves all.
    pub(super) fn listed_lengths(&self, group: usize) -> &[T] {
        let all = &self.simulation.state.groups[group].neighborhood.listed_h;
        &all[..all.len().min(self.columns(group).slots())]
    }

    /// Whether lists are outdated at a time \[s\]; else they serve once more.
    pub fn is_outdated(&mut self, group: usize, moved: Moved, time: f64) -> bool {
        let is_outdated = self.has_used_skin(group, &moved, 0.0, time);
        self.recorded[group].travel.is_at(moved);
        let neighborhood = &mut self.simulation.state.groups[group].neighborhood;
        neighborhood.served += u32::from(!is_outdated);
        is_outdated
    }

    /// Whether particles that have moved so far, and by a share more, have used up the skin.
    pub(super) fn has_used_skin(&self, group: usize, moved: &Moved, more: f64, time: f64) -> bool {
        let group = &self.simulation.state.groups[group];
        let shift = group.carried_since_listed(time);
        let left = group
            .neighborhood
            .left(&group.boundaries, moved.grown, (shift, time));
        let left = left / (1.0 + more);
        let farthest = moved.farthest2.sqrt();
        if 2.0 * farthest <= left || !group.is_open() {
            return 2.0 * farthest > left;
        }
        let [low, high] = &moved.range;
        let apart: f64 = low.iter().zip(high).map(|(a, b)| (b - a).powi(2)).sum();
        apart.sqrt() > left
    }

    /// Builds lists for the places of the columns, which it may sort anew, at a time \[s\].
    pub fn rebuild(&mut self, number: usize, time: f64) {
        self.recorded[number].travel.is_at(Moved::none(D));
        let group = &mut self.simulation.state.groups[number];
        group.neighborhood.choose_skin();
        group.re_enter(time);
        group.sort_and_list(time, self.recorded[number].entries);
        group.neighborhood.served = 1;
        self.simulation.follow_moves(number);
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
