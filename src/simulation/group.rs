//! A group: the bodies that share a scheme, with their particles, neighbourhood and workspace.
//! Physics happens in `stages`, by the laws of the scheme.

use super::divided::Share;
use super::exchange::Exchange;
use super::held::Held;
use super::neighborhood::Neighborhood;
use super::own_group::All;
use super::population::Particles;
use super::sources::{DrainState, SourceState};
use super::sub_cycle::SubCycle;
use super::walls::WallState;
use super::workspace::{Given, Workspace};
use crate::boundary::{Boundary, Emitter, Outlet, Pose};
use crate::clock::Instant;
use crate::error::Result;
use crate::material::eos::GuardCounts;
use crate::particles::Field;
use crate::scalar::Real;
use crate::scheme::Scheme;
use crate::sweep::{Ghosts, InstructionSet, Interaction, Root, SweepInput};
use std::sync::Arc;

#[derive(Clone, Debug)]
pub(crate) struct Group<T: Real, const D: usize> {
    pub particles: Particles<T, D>,
    pub neighborhood: Neighborhood<T, D>,
    pub work: Workspace<T, D>,
    pub scheme: Arc<Scheme<T, D>>,
    /// The part of this rank in it, on ranks.
    pub share: Option<Share>,
    /// The group of all particles, while the rank has its own alone.
    pub all: Option<Box<All<T, D>>>,
    /// The schemes that it obeys one after another, its first among them; none if that is all.
    pub exchanges: Vec<Exchange<T, D>>,
    pub walls: Vec<WallState<T, D>>,
    pub boundaries: Vec<Arc<dyn Boundary<D>>>,
    pub outlets: Vec<Outlet<D>>,
    pub emitters: Vec<Emitter<D>>,
    pub sources: Vec<SourceState<D>>,
    pub drains: Vec<DrainState<D>>,
    /// What the loads give \[m/s²\].
    pub gravity: [f64; D],
    /// The same in the frame of the wall that carries the liquid.
    pub body_force: [T; D],
    /// The scene index of each of its bodies, walls and boundaries: bodies of all groups, then walls,
    /// then boundaries.
    pub indices: Vec<usize>,
    /// Whether a liquid of another group meets one of its bodies.
    pub is_met: bool,
    /// What it has beside others if it takes several steps in one of theirs.
    pub sub_cycle: Option<SubCycle<T, D>>,
    /// Clamped particles and rigid bodies.
    pub held: Held<D>,
    pub instructions: InstructionSet,
    pub root: Root,
    pub guards: GuardCounts,
    /// Limits that laws and updates have applied, in particle steps, by name.
    pub limited: Vec<(&'static str, u64)>,
    /// The times \[s\] of kept states, and what came through boundaries before the ledger took it, where ranks part again.
    pub kept_times: Vec<f64>,
    pub given: Vec<Given<D>>,
    /// Whether ranks, of which each has what its own particles were given, have to join it.
    pub joins_given: bool,
}

/// What of a force by an image of another body is between the two, (f + R f)/2, and what the boundary gives, (f − R f)/2.
pub(super) fn shared_with_image<const D: usize>(
    force: [f64; D],
    turn: impl Fn(usize, usize) -> f64,
) -> ([f64; D], [f64; D]) {
    let turned: [f64; D] = core::array::from_fn(|d| (0..D).map(|k| turn(d, k) * force[k]).sum());
    let half = |sign: f64| core::array::from_fn(|d| 0.5 * (force[d] + sign * turned[d]));
    (half(1.0), half(-1.0))
}

impl<T: Real, const D: usize> Group<T, D> {
    pub fn new(
        particles: Particles<T, D>,
        walls: Vec<WallState<T, D>>,
        boundaries: Vec<Arc<dyn Boundary<D>>>,
        scheme: Arc<Scheme<T, D>>,
        interactions: Vec<Interaction>,
        smoothing_length: f64,
        skins: [f64; 2],
    ) -> Self {
        let reach = (scheme.kernel.support, smoothing_length);
        Self {
            particles,
            neighborhood: Neighborhood::new(interactions, reach, skins),
            work: Workspace::default(),
            scheme,
            share: None,
            all: None,
            exchanges: Vec::new(),
            walls,
            boundaries,
            outlets: Vec::new(),
            emitters: Vec::new(),
            sources: Vec::new(),
            drains: Vec::new(),
            gravity: [0.0; D],
            body_force: [T::zero(); D],
            indices: Vec::new(),
            is_met: false,
            sub_cycle: None,
            held: Held::default(),
            instructions: InstructionSet::detect(),
            root: Root::detect(),
            guards: GuardCounts::default(),
            limited: Vec::new(),
            kept_times: Vec::new(),
            given: Vec::new(),
            joins_given: false,
        }
    }

    /// Whether the group needs no evaluation in mid-drift.
    pub fn drifts_at_once(&self) -> bool {
        !self.scheme.acts_in_drift() && (!self.is_met || self.sub_cycles())
    }

    /// Whether it, with this number, steps where one does that sub-cycles alone, or all that do not.
    pub fn steps_with(&self, alone: Option<usize>, number: usize) -> bool {
        alone.map_or(!self.sub_cycles(), |alone| alone == number)
    }

    /// Whether bodies touch that may part.
    pub fn has_contacts(&self) -> bool {
        self.neighborhood
            .interactions
            .contains(&Interaction::Unilateral)
    }

    /// Whether laws of its scheme add forces.
    pub fn has_forces_of_laws(&self) -> bool {
        !self.particles.columns.raw(Field::FORCE).is_empty()
    }

    /// Counts limits that were applied.
    pub fn count(&mut self, name: &'static str, limited: u64) {
        if limited == 0 {
            return;
        }
        match self.limited.iter_mut().find(|own| own.0 == name) {
            Some(own) => own.1 += limited,
            None => self.limited.push((name, limited)),
        }
    }

    /// The body or wall of a block, by its number in the group, and the boundary if the block is of images.
    fn owner(&self, block: u32) -> (usize, Option<usize>) {
        let direct = self.particles.bodies.len() + self.walls.len();
        match (block as usize).checked_sub(direct) {
            None => (block as usize, None),
            Some(image) => {
                let count = self.boundaries.len();
                (image / count, Some(image % count))
            }
        }
    }

    /// Forces between blocks at the last evaluation, with their scene indices: which feels,
    /// which exerts, and the force \[N\]. A structure is the body that it is.
    ///
    /// A force f by images of another body, which a boundary with the rotation R shows, is half of a pair: the other body
    /// feels −R f by images of the first. So (f + R f)/2 is what the two do to each other, all of it across a period and what is along a
    /// plane of symmetry, and the boundary gives the rest. By its own images a body feels the boundary, and by those of a
    /// wall the wall.
    pub fn reactions(&self) -> impl Iterator<Item = (usize, usize, [f64; D])> {
        let direct = self.particles.bodies.len() + self.walls.len();
        let is_wall = |own: usize| {
            let wall = own.checked_sub(self.particles.bodies.len());
            wall.is_some_and(|wall| self.walls[wall].structure.is_none())
        };
        let rates = self.work.rates.reactions();
        let all = rates.chain(self.work.coupling.reactions());
        all.flat_map(move |reaction| {
            let on = self.indices[self.owner(reaction.on).0];
            let (own, boundary) = self.owner(reaction.from);
            let (from, force) = (self.indices[own], reaction.force);
            let (mutual, given) = match boundary {
                Some(_) if on == from => ([0.0; D], force),
                Some(boundary) if !is_wall(own) => {
                    let time = self.neighborhood.placed_time;
                    let turn = self.boundaries[boundary].transform(0, time).rotation;
                    shared_with_image(force, |d, k| turn[(d, k)].to_f64())
                }
                _ => (force, [0.0; D]),
            };
            let boundary = boundary.map(|own| (on, self.indices[direct + own], given));
            core::iter::once((on, from, mutual)).chain(boundary)
        })
    }

    /// Adds a force \[N\] of a coupling on a particle: to its rates, or apart from them where it sub-cycles.
    pub fn push(&mut self, slot: usize, force: [T; D]) {
        let (mut forces, particles, _) = self.forces(true);
        let body = &particles.bodies[particles.body_of(slot)];
        // What repeats the last particle goes where that goes.
        for slot in body.with_repeats(slot) {
            forces.add(slot, force);
        }
    }

    /// Replaces forces on what is held at `time` \[s\]: of its own, or of couplings where it sub-cycles.
    pub fn hold(&mut self, time: f64, coupled: bool) {
        let (mut forces, particles, held) = self.forces(coupled);
        held.hold(particles, &mut forces, time);
    }

    /// Brings images and lists up to date with the positions at `time`; `chord` \[s\] are the ends of the drift
    /// under way, along which walls go straight.
    pub fn refresh(&mut self, time: f64, chord: Option<[f64; 2]>) {
        let start = Instant::now();
        self.place_walls(time, chord);
        let shift = self.carried_since_listed(time);
        let is_first = self.neighborhood.lists.chunks().is_empty();
        if is_first
            || !self.scheme.density.keeps_neighbors()
                && self.neighborhood.outdated(
                    &self.particles,
                    &self.boundaries,
                    (self.is_open(), self.apart().map(|own| &**own.0)),
                    (shift, time),
                )
        {
            if !is_first {
                self.neighborhood.choose_skin();
            }
            if self.all.is_some() {
                self.rebuild_apart(time);
            } else {
                self.rebuild(time);
            }
        } else if self.boundaries.iter().any(|b| b.moves()) {
            self.neighborhood.place_transforms(&self.boundaries, time);
        }
        self.neighborhood.served += 1;
        self.work.phases.lists += start.elapsed();
    }

    /// How far a container that takes its liquid with it has gone since the lists were built \[m\].
    pub(super) fn carried_since_listed(&self, time: f64) -> [f64; D] {
        let listed_time = self.neighborhood.listed_time;
        let container = self.walls.iter().find(|wall| wall.container_frame);
        container.map_or([0.0; D], |wall| wall.carried([listed_time, time]))
    }

    /// Whether nothing happens at places: there are no images, and no outlets, which take particles where lists are made.
    pub fn is_open(&self) -> bool {
        self.boundaries.is_empty() && self.outlets.is_empty()
    }

    /// Brings walls that move to their places, and gives all walls their own velocity.
    pub(super) fn place_walls(&mut self, time: f64, chord: Option<[f64; 2]>) {
        self.body_force = self.gravity.map(T::from_f64);
        let listed = self.neighborhood.rebuilds > 0;
        for wall in &mut self.walls {
            wall.flow(&mut self.particles, &self.boundaries, time, chord);
        }
        let placed = |wall: &&WallState<T, D>| wall.structure.is_none() && wall.inflow.is_none();
        for wall in self.walls.iter().filter(placed) {
            let pose = wall.pose(time, chord);
            if let Some(pose) = pose.as_ref().filter(|_| wall.container_frame) {
                let acceleration = pose.of(2, &wall.rest[0]);
                for d in 0..D {
                    self.body_force[d] -= T::from_f64(acceleration[d]);
                }
            }
            // What sticks to a wall at rest has overwritten its velocity.
            if pose.is_none() && listed {
                if wall.is_mirrored() {
                    wall.stand(&mut self.particles);
                }
                continue;
            }
            let pose = pose.unwrap_or_else(Pose::rest);
            wall.place(&pose, &mut self.particles, &self.boundaries, time);
        }
    }

    /// Lets particles enter and leave that are due at `time`; whether there were any.
    ///
    /// # Errors
    /// If a body's reserve is used up, or what enters finds no place.
    pub fn emit(&mut self, time: f64) -> Result<bool> {
        let mut any = self.drain(time);
        any |= self.feed(time)?;
        for emitter in &mut self.emitters {
            while let Some(layer) = emitter.due(time) {
                any = true;
                for state in layer {
                    self.particles
                        .insert(&self.scheme, emitter.body, state, None)?;
                }
                let buffer = &mut self.walls[emitter.wall];
                buffer.set_motion(emitter.inflow(), &self.particles.origin);
            }
        }
        for wall in &mut self.walls {
            let slots = wall.slots.clone();
            let Some(inflow) = &mut wall.inflow else {
                continue;
            };
            let (body, particles) = (inflow.body, &mut self.particles);
            let material = particles.bodies[body].material.clone();
            let name = particles.bodies[body].name.clone();
            inflow.advance((time, &name), |own| {
                any = true;
                // Of the pressure that the buffer had before the liquid, or waves would start from it.
                let slot = particles.slot_of[slots.start + own.number] as usize;
                let pressure = particles.columns.raw(Field::PRESSURE)[slot].to_f64();
                let density = material.eos().density_at(pressure, 0.0);
                particles.insert(&self.scheme, body, [own.x, own.velocity], density)
            })?;
        }
        if any {
            // Lists do not know the new ones.
            self.rebuild(time);
        }
        Ok(any)
    }

    /// Lets particles that have crossed a boundary re-enter.
    pub(super) fn re_enter(&mut self, time: f64) {
        self.held
            .note_periods(&self.particles, &self.boundaries, time);
        self.particles
            .wrap(&self.boundaries, &self.scheme.program, time);
    }

    /// Notes that lists are built anew.
    pub(super) fn begin_rebuild(&mut self, time: f64) {
        self.neighborhood.rebuilds += 1;
        self.neighborhood.served = 0;
        self.neighborhood.listed_time = time;
        self.work.first_kick = None;
        // Particles and images have other places in them.
        self.work.records_of_rates = false;
    }

    /// Lets particles re-enter and leave, sorts them if that pays, and lists their neighbours.
    pub fn rebuild(&mut self, time: f64) {
        self.re_enter(time);
        self.sort_and_list(time, self.neighborhood.lists.entries());
    }

    /// The same of particles that have re-entered, whose lists have so many entries.
    pub(super) fn sort_and_list(&mut self, time: f64, entries: usize) {
        self.begin_rebuild(time);
        let held = &self.held;
        let outlets: Vec<_> = self.outlets.iter().map(|own| own.at(time)).collect();
        let removed = self.particles.remove(&outlets, |body| held.is_rigid(body));
        self.work.rates.permute(&removed);
        let sort = self.neighborhood.wants_sort(entries);
        let reach = self.neighborhood.reach(&self.particles);
        if sort {
            // Walls keep their shape, so sorting them once serves; structures may not.
            let first = self.neighborhood.rebuilds <= 1;
            let sorted = self.walls.iter();
            let sorted = sorted.filter(|wall| first || wall.structure.is_some());
            let runs = sorted.map(|wall| (wall.slots.clone(), wall.end));
            let order = self.particles.sort(runs);
            self.work.rates.permute(&order);
        }
        self.list(time, reach);
        if sort {
            self.neighborhood.sorted_entries = self.neighborhood.lists.entries();
        }
    }

    /// Lists neighbours at the present positions, with images within `reach` \[m\].
    pub fn list(&mut self, time: f64, reach: f64) {
        let at = (time, reach);
        let (walls, boundaries) = (&self.walls, &self.boundaries);
        let on = (self.instructions, self.share.as_mut());
        self.neighborhood
            .list(&self.particles, walls, boundaries, at, on);
    }

    /// What a sweep over all that moves by forces works on.
    pub fn input(&self) -> SweepInput<'_, T, D> {
        SweepInput {
            targets: 0..self.particles.mobile,
            among: None,
            goes_on: false,
            body_force: self.body_force,
            columns: &self.particles.columns,
            ghosts: self.apart().map(|(_, part)| &*part.halo as &dyn Ghosts<T>),
            images: &self.neighborhood.images,
            transforms: &self.neighborhood.chains.transforms,
            lists: &self.neighborhood.lists,
            blocks: &self.neighborhood.blocks,
            interactions: &self.neighborhood.interactions,
            smoothing_length: self.neighborhood.smoothing_length,
            lattice_consistency_factor: self.scheme.lattice_consistency_factor,
            instructions: self.instructions,
            root: self.root,
        }
    }

    /// Bytes held for particles, lists and records.
    pub fn bytes(&self) -> usize {
        let columns = &self.particles.columns;
        columns.bytes_per_particle() * columns.slots()
            + self.neighborhood.bytes()
            + self.work.bytes()
    }
}
