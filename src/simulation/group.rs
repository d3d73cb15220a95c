//! A group: the bodies that share a scheme, with their columns, neighbour lists and images.
//! It knows where particles are and who their neighbours are; physics happens in `evaluate`.

use crate::boundary::{Boundary, Emitter, Motion, Outlet, Pose, Slip};
use crate::error::{Error, Problem, Result};
use crate::material::Material;
use crate::material::eos::GuardCounts;
use crate::neighbors::{Block, ClusterLists, Grid, Radii, SearchInput};
use crate::particles::{Columns, Field};
use crate::scalar::{Lane, Real};
use crate::scheme::Scheme;
use crate::sweep::{Image, InstructionSet, Interaction, Records, Rows, SweepInput, Transform};
use crate::tensor::{Vector, determinant, length};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// A body in a simulation.
#[derive(Clone, Debug)]
pub struct BodyState<T: Real> {
    pub(crate) name: String,
    pub(crate) material: Material<T>,
    /// Slots of its particles; the rest of its run repeats the last of them.
    pub(crate) slots: Range<usize>,
    /// One past the last slot of its run, a whole number of clusters.
    pub(crate) end: usize,
    /// Identities that its particles have had.
    pub(crate) ids: Range<usize>,
    pub(crate) spacing: f64,
}

impl<T: Real> BodyState<T> {
    /// Its slots with the repeats.
    pub(crate) fn run(&self) -> Range<usize> {
        self.slots.start..self.end
    }
}

/// What has left a simulation through its outlets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Removed<const D: usize> {
    /// Particles.
    pub particles: u64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Momentum \[kg m/s\].
    pub momentum: [f64; D],
    /// Kinetic energy \[J\].
    pub kinetic: f64,
}

impl<const D: usize> Default for Removed<D> {
    fn default() -> Self {
        Self {
            particles: 0,
            mass: 0.0,
            momentum: [0.0; D],
            kinetic: 0.0,
        }
    }
}

/// A wall in a simulation: particles that a motion places.
#[derive(Clone, Debug)]
pub(crate) struct WallState<const D: usize> {
    pub name: String,
    /// Slots of its particles; the rest of the last cluster repeats the last of them.
    pub slots: Range<usize>,
    pub end: usize,
    /// Where its particles were in the scene, by identity.
    pub rest: Vec<[f64; D]>,
    pub motion: Option<Arc<dyn Motion<D>>>,
    pub slip: Slip,
    /// Velocity of its surface beside its motion \[m/s\].
    pub sliding: [f64; D],
    pub carries: bool,
    /// Mass of a particle as built, in the liquid's density \[kg\].
    pub mass: f64,
}

/// How an image's transform comes about: the boundary's own, after that of the image it mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Chain {
    parent: Option<u32>,
    boundary: u32,
    image: u32,
}

#[derive(Debug)]
pub(crate) struct Group<T: Real, const D: usize> {
    pub columns: Columns<T, D>,
    pub bodies: Vec<BodyState<T>>,
    pub walls: Vec<WallState<D>>,
    pub outlets: Vec<Outlet<D>>,
    /// Inlets, each with the body that it feeds.
    pub emitters: Vec<(usize, Emitter<D>)>,
    /// What has left through outlets.
    pub removed: Removed<D>,
    /// Slots below this move by forces; walls come behind.
    pub mobile: usize,
    /// What the loads give \[m/s²\].
    pub gravity: [f64; D],
    /// The same in the frame of the wall that carries the liquid.
    pub body_force: [T; D],
    pub boundaries: Vec<Box<dyn Boundary<T, D>>>,
    /// The box around bodies and walls as built \[m\], where walls alone bound the scene.
    pub domain: Option<[[f64; D]; 2]>,
    pub scheme: Scheme<T, D>,
    pub blocks: Vec<Block>,
    pub interactions: Vec<Interaction>,
    pub images: Vec<Image>,
    pub transforms: Vec<Transform<T, D>>,
    chains: Vec<Chain>,
    pub lists: ClusterLists,
    /// Positions of slots at the last list build, then of images.
    listed: Vec<[T; D]>,
    listed_h: Vec<T>,
    listed_time: f64,
    /// Beginning and end \[s\] of the drift under way.
    pub chord: Option<[f64; 2]>,
    pub records: Records<T>,
    pub work_records: Records<T>,
    /// Whether the records are those of the rates; all sweeps share them.
    pub records_of_rates: bool,
    pub rows: Rows<T, D>,
    pub scratch_rows: Rows<T, D>,
    /// Identity of the particle in each slot, and the slot of each particle.
    pub ids: Vec<u32>,
    pub slot_of: Vec<u32>,
    pub smoothing_length: f64,
    pub skin: f64,
    pub instructions: InstructionSet,
    pub guards: GuardCounts,
    pub limited_h: u64,
    /// Densities of torn liquid that were held, in particle steps.
    pub held_densities: u64,
    pub rebuilds: u64,
    /// Where the time went.
    pub phases: super::Phases,
    /// Entries of the lists after the last sort.
    sorted_entries: usize,
    pub unilateral: bool,
    /// What list builds have done to particles since states outside of the group were last told.
    pub moved: Moves<T, D>,
}

/// How list builds moved particles: what re-entered a period, and the new order of the slots.
/// States that an integrator keeps must follow.
#[derive(Clone, Debug)]
pub(crate) struct Moves<T, const D: usize> {
    /// Slots, in the order before sorting, that re-entered through a transform.
    pub wraps: Vec<(u32, Transform<T, D>)>,
    /// Slot k is what slot `order[k]` was; empty if the order is the old one.
    pub order: Vec<u32>,
}

impl<T, const D: usize> Default for Moves<T, D> {
    fn default() -> Self {
        Self {
            wraps: Vec::new(),
            order: Vec::new(),
        }
    }
}

/// Growth of the lists since the last sort at which particles are sorted again.
const UNSORTED: f64 = 1.03;

pub(crate) fn width<T: Real>() -> usize {
    <T::Wide<false> as Lane>::WIDTH
}

impl<T: Real, const D: usize> Group<T, D> {
    #[allow(clippy::too_many_arguments)]
    pub fn new(
        columns: Columns<T, D>,
        bodies: Vec<BodyState<T>>,
        walls: Vec<WallState<D>>,
        boundaries: Vec<Box<dyn Boundary<T, D>>>,
        scheme: Scheme<T, D>,
        interactions: Vec<Interaction>,
        smoothing_length: f64,
        skin: f64,
    ) -> Self {
        let slots = columns.slots();
        let unilateral = interactions.contains(&Interaction::Unilateral);
        Self {
            ids: (0..slots as u32).collect(),
            slot_of: (0..slots as u32).collect(),
            columns,
            blocks: Vec::new(),
            mobile: walls.first().map_or(slots, |wall| wall.slots.start),
            bodies,
            walls,
            outlets: Vec::new(),
            emitters: Vec::new(),
            removed: Removed::default(),
            gravity: [0.0; D],
            body_force: [T::zero(); D],
            boundaries,
            domain: None,
            scheme,
            interactions,
            images: Vec::new(),
            transforms: Vec::new(),
            chains: Vec::new(),
            lists: ClusterLists::default(),
            listed: Vec::new(),
            listed_h: Vec::new(),
            listed_time: 0.0,
            chord: None,
            records: Records::default(),
            work_records: Records::default(),
            records_of_rates: false,
            rows: Rows::default(),
            scratch_rows: Rows::default(),
            smoothing_length,
            skin,
            instructions: InstructionSet::detect(),
            guards: GuardCounts::default(),
            limited_h: 0,
            held_densities: 0,
            rebuilds: 0,
            phases: super::Phases::default(),
            sorted_entries: 0,
            unilateral,
            moved: Moves::default(),
        }
    }

    pub fn particles(&self) -> usize {
        self.bodies.iter().map(|body| body.slots.len()).sum()
    }

    pub fn body_of(&self, slot: usize) -> usize {
        self.bodies
            .partition_point(|body| body.end <= slot)
            .min(self.bodies.len() - 1)
    }

    /// The body, wall or boundary that a block stands for: images of a wall count as the wall.
    pub fn source_block(&self, block: usize) -> usize {
        let (bodies, boundaries) = (self.bodies.len(), self.boundaries.len());
        let direct = bodies + self.walls.len() + boundaries;
        if block < direct {
            block
        } else {
            bodies + (block - direct) / boundaries
        }
    }

    fn reach(&self) -> f64 {
        let h = self.columns.raw(Field::SmoothingLength);
        let largest = h
            .iter()
            .fold(self.smoothing_length, |m, h| m.max(h.to_f64()));
        self.scheme.kernel.support * largest + self.skin
    }

    /// Brings images and lists up to date with the positions at `time`.
    pub fn refresh(&mut self, time: f64) {
        let start = Instant::now();
        self.place_walls(time);
        if self.lists.chunks().is_empty() || self.outdated(time) {
            self.rebuild(time);
        } else if self.boundaries.iter().any(|b| b.moves()) {
            self.place_transforms(time);
        }
        self.phases.lists += start.elapsed();
    }

    /// Whether a particle has moved, or its support has grown, by more than the skin allows.
    fn outdated(&self, time: f64) -> bool {
        let positions = self.columns.vectors(Field::Position);
        // A tank takes its liquid with it; only what moves in the tank outdates lists.
        let shift = self.carried(time);
        let farthest = positions
            .par_iter()
            .zip(&self.listed)
            .with_min_len(4096)
            .map(|(now, then)| {
                (0..D)
                    .map(|d| ((now[d] - then[d]).to_f64() - shift[d]).powi(2))
                    .sum::<f64>()
            })
            .reduce(|| 0.0, f64::max)
            .sqrt();
        let h = self.columns.raw(Field::SmoothingLength);
        let grown = h
            .iter()
            .zip(&self.listed_h)
            .fold(0.0_f64, |m, (now, then)| m.max((*now - *then).to_f64()));
        // A moving boundary carries images towards particles that rest, and a boundary at rest reflects
        // what a tank does.
        let moved = shift.iter().any(|&s| s != 0.0);
        let shift = Vector::from(shift.map(T::from_f64));
        let carried: f64 = self
            .boundaries
            .iter()
            .filter(|boundary| moved || boundary.moves())
            .map(|boundary| {
                (0..boundary.images()).fold(0.0_f64, |most, k| {
                    let now = boundary.transform(k, time);
                    let then = boundary.transform(k, self.listed_time);
                    let by = now.rotation * shift - shift;
                    most.max(length(&(now.shift - then.shift + by)).to_f64())
                })
            })
            .sum();
        2.0 * farthest + carried + self.scheme.kernel.support * grown > self.skin
    }

    fn rebuild(&mut self, time: f64) {
        self.rebuilds += 1;
        self.listed_time = time;
        self.wrap();
        self.remove();
        let reach = self.reach();
        // Particles need new places in memory only when their rows have lost their shape.
        let entries = self.lists.entries() as f64;
        let sort = D > 1 && entries >= UNSORTED * self.sorted_entries as f64;
        if sort {
            self.sort();
        }
        let width = width::<T>();
        self.listed.clear();
        self.listed
            .extend_from_slice(self.columns.vectors(Field::Position));
        self.listed_h.clear();
        self.listed_h
            .extend_from_slice(self.columns.raw(Field::SmoothingLength));
        self.blocks.clear();
        let bodies = self.bodies.iter().map(|body| (&body.slots, false));
        let walls = self.walls.iter().map(|wall| (&wall.slots, true));
        self.blocks
            .extend(bodies.chain(walls).map(|(slots, wall)| Block {
                slots: slots.clone(),
                wall,
            }));
        self.place_images(time, reach);
        let h = &mut self.listed_h;
        let radii = if h.is_empty() {
            Radii::Uniform(self.scheme.kernel.support * self.smoothing_length)
        } else {
            for image in &self.images {
                h.push(h[image.source as usize]);
            }
            Radii::Varying(h.as_slice(), self.scheme.kernel.support)
        };
        let listed: Vec<bool> = self
            .interactions
            .iter()
            .map(|&interaction| interaction != Interaction::None)
            .collect();
        self.lists.rebuild(&SearchInput {
            positions: &self.listed,
            listed: &listed,
            radii,
            blocks: &self.blocks,
            width,
            slots: self.columns.slots(),
            skin: self.skin,
        });
        if sort {
            self.sorted_entries = self.lists.entries();
        }
    }

    /// Lets particles that have left a periodic domain re-enter.
    fn wrap(&mut self) {
        for boundary in &self.boundaries {
            for slot in 0..self.mobile {
                let x = self.columns.vectors(Field::Position)[slot];
                let Some(back) = boundary.wrap(&x) else {
                    continue;
                };
                let [x, residual, v] = self.columns.many_mut([
                    Field::Position,
                    Field::PositionResidual,
                    Field::Velocity,
                ]);
                back.re_enter(slot, x, residual, v);
                // Wraps are told by the order that outside states have now.
                let told = self.moved.order.get(slot).map_or(slot as u32, |&old| old);
                // Repeats have lost their own places in a new order, and follow their original.
                let repeat = self.bodies.iter().all(|body| !body.slots.contains(&slot));
                if !repeat || self.moved.order.is_empty() {
                    self.moved.wraps.push((told, back));
                }
            }
        }
    }

    /// Sorts every body along the space-filling curve, in cells that hold a particle each, so that the
    /// members of a cluster are the corners of a cube as far as the flow allows.
    fn sort(&mut self) {
        let positions = self.columns.vectors(Field::Position);
        let spacing = self
            .bodies
            .iter()
            .fold(f64::INFINITY, |least, body| least.min(body.spacing));
        let grid = Grid::centred(positions, spacing);
        let mut order: Vec<u32> = (0..self.columns.slots() as u32).collect();
        // Walls keep their shape, so sorting them once serves.
        let walls = if self.rebuilds > 1 {
            &[][..]
        } else {
            &self.walls
        };
        let walls = walls.iter().map(|wall| (&wall.slots, wall.end));
        let bodies = self.bodies.iter().map(|body| (&body.slots, body.end));
        for (slots, end) in bodies.chain(walls) {
            let keys: Vec<u64> = positions[slots.clone()]
                .par_iter()
                .map(|x| grid.order(x))
                .collect();
            let own = &mut order[slots.clone()];
            own.par_sort_by_key(|&slot| keys[slot as usize - slots.start]);
            if let Some(&last) = order[slots.clone()].last() {
                order[slots.end..end].fill(last);
            }
        }
        self.reorder(&order);
    }

    /// Takes out what outlets take; the slots behind the last particle of a body repeat it.
    fn remove(&mut self) {
        if self.outlets.is_empty() {
            return;
        }
        let mut order: Vec<u32> = (0..self.columns.slots() as u32).collect();
        let mut any = false;
        for k in 0..self.bodies.len() {
            let (slots, end) = (self.bodies[k].slots.clone(), self.bodies[k].end);
            let mut kept = slots.start;
            for slot in slots.clone() {
                let x = self.columns.vectors(Field::Position)[slot].map(Real::to_f64);
                let v = self.columns.vectors(Field::Velocity)[slot].map(Real::to_f64);
                if !self.outlets.iter().any(|outlet| outlet.takes(&x, &v)) {
                    order[kept] = slot as u32;
                    kept += 1;
                    continue;
                }
                any = true;
                self.slot_of[self.ids[slot] as usize] = u32::MAX;
                let mass = self.columns.raw(Field::Mass)[slot].to_f64();
                self.removed.particles += 1;
                self.removed.mass += mass;
                for d in 0..D {
                    self.removed.momentum[d] += mass * v[d];
                    self.removed.kinetic += 0.5 * mass * v[d] * v[d];
                }
            }
            if kept > slots.start {
                let last = order[kept - 1];
                order[kept..end].fill(last);
            }
            self.bodies[k].slots.end = kept;
        }
        if any {
            self.reorder(&order);
        }
    }

    /// Lets particles enter that are due at `time`; whether there were any.
    ///
    /// # Errors
    /// If a body's reserve is used up.
    pub fn emit(&mut self, time: f64) -> Result<bool> {
        let mut any = false;
        for k in 0..self.emitters.len() {
            while let Some((layer, velocity)) = self.emitters[k].1.due(time) {
                any = true;
                for x in layer {
                    self.insert(self.emitters[k].0, x, velocity)?;
                }
            }
        }
        if any {
            // Lists do not know the new ones.
            self.rebuild(time);
        }
        Ok(any)
    }

    /// Appends one particle to a body, like its material at rest.
    fn insert(&mut self, body: usize, x: [f64; D], velocity: [f64; D]) -> Result<()> {
        let (slots, end) = (self.bodies[body].slots.clone(), self.bodies[body].end);
        let free = self.bodies[body]
            .ids
            .clone()
            .find(|&id| self.slot_of[id] == u32::MAX);
        let (Some(id), true) = (free, slots.end < end) else {
            return Err(Error::Argument(Problem::Parameter {
                what: format!("reserve of the inlet of body `{}`", self.bodies[body].name),
                value: slots.len() as f64,
                must_be: "all of it has entered and none has left: give the inlet a larger reserve, \
                          or put an outlet where the flow ends",
            }));
        };
        let slot = slots.end;
        let source = if slots.is_empty() {
            slot
        } else {
            slots.end - 1
        };
        self.columns.copy_slot(source, slot);
        let density = self.bodies[body].material.reference_density();
        let mass = density * self.bodies[body].spacing.powi(D as i32);
        let rounded = x.map(T::from_f64);
        self.columns.vectors_mut(Field::Position)[slot] = rounded;
        self.columns.vectors_mut(Field::Velocity)[slot] = velocity.map(T::from_f64);
        if let Some(residual) = self
            .columns
            .vectors_mut(Field::PositionResidual)
            .get_mut(slot)
        {
            *residual = core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
        }
        for (field, value) in [
            (Field::Density, density),
            (Field::DensityResidual, 0.0),
            (Field::Mass, mass),
        ] {
            if let Some(place) = self.columns.raw_mut(field).get_mut(slot) {
                *place = T::from_f64(value);
            }
        }
        self.bodies[body].slots.end = slot + 1;
        self.ids[slot] = id as u32;
        self.slot_of[id] = slot as u32;
        Ok(())
    }

    /// Rearranges the slots, and remembers it for states outside.
    fn reorder(&mut self, order: &[u32]) {
        if order.iter().enumerate().all(|(k, &from)| k as u32 == from) {
            return;
        }
        self.columns.permute(order);
        self.rows.permute(order);
        if self.moved.order.is_empty() {
            self.moved.order.extend_from_slice(order);
        } else {
            let before = core::mem::take(&mut self.moved.order);
            self.moved.order = order.iter().map(|&k| before[k as usize]).collect();
        }
        self.ids = order.iter().map(|&from| self.ids[from as usize]).collect();
        let walls = self.walls.iter().map(|wall| &wall.slots);
        for slots in self.bodies.iter().map(|body| &body.slots).chain(walls) {
            for slot in slots.clone() {
                self.slot_of[self.ids[slot] as usize] = slot as u32;
            }
        }
    }

    /// Brings walls that move to their places, and gives all walls their own velocity.
    fn place_walls(&mut self, time: f64) {
        self.body_force = self.gravity.map(T::from_f64);
        for wall in &self.walls {
            let pose = wall.motion.as_ref().map(|motion| match self.chord {
                Some(ends) => motion
                    .pose(time)
                    .on_chord(ends.map(|end| motion.pose(end)), ends),
                None => motion.pose(time),
            });
            if wall.carries {
                let acceleration = pose
                    .as_ref()
                    .map_or([0.0; D], |pose| pose.of(2, &wall.rest[0]));
                for d in 0..D {
                    self.body_force[d] -= T::from_f64(acceleration[d]);
                }
            }
            // What sticks to a wall at rest has overwritten its velocity.
            if pose.is_none() && self.rebuilds > 0 {
                if wall.slip == Slip::None {
                    let own = wall.slots.start..wall.end;
                    let v = wall.sliding.map(T::from_f64);
                    self.columns.vectors_mut(Field::Velocity)[own].fill(v);
                }
                continue;
            }
            let pose = pose.unwrap_or_else(Pose::rest);
            // A wall that is crushed has its particles closer, and each stands for less volume.
            let mass = T::from_f64(wall.mass * determinant(&pose.linear[0]).abs());
            if let Some(masses) = self
                .columns
                .raw_mut(Field::Mass)
                .get_mut(wall.slots.start..wall.end)
            {
                masses.fill(mass);
            }
            for slot in wall.slots.start..wall.end {
                let at = (self.ids[slot] as usize - wall.slots.start).min(wall.rest.len() - 1);
                let (x, own) = (pose.of(0, &wall.rest[at]), pose.of(1, &wall.rest[at]));
                let v: [f64; D] = core::array::from_fn(|d| own[d] + wall.sliding[d]);
                let rounded = x.map(T::from_f64);
                self.columns.vectors_mut(Field::Position)[slot] = rounded;
                self.columns.vectors_mut(Field::Velocity)[slot] = v.map(T::from_f64);
                if let Some(residual) = self
                    .columns
                    .vectors_mut(Field::PositionResidual)
                    .get_mut(slot)
                {
                    *residual = core::array::from_fn(|d| T::from_f64(x[d] - rounded[d].to_f64()));
                }
                for boundary in &self.boundaries {
                    if let Some(back) = boundary.wrap(&rounded) {
                        let [x, residual, v] = self.columns.many_mut([
                            Field::Position,
                            Field::PositionResidual,
                            Field::Velocity,
                        ]);
                        back.re_enter(slot, x, residual, v);
                    }
                }
            }
        }
    }

    /// How far the wall that carries the liquid has gone since the last list build \[m\].
    fn carried(&self, time: f64) -> [f64; D] {
        let Some(wall) = self.walls.iter().find(|wall| wall.carries) else {
            return [0.0; D];
        };
        let Some(motion) = &wall.motion else {
            return [0.0; D];
        };
        let now = motion.pose(time).of(0, &wall.rest[0]);
        let then = motion.pose(self.listed_time).of(0, &wall.rest[0]);
        core::array::from_fn(|d| now[d] - then[d])
    }

    /// Finds which images are needed. Later boundaries also mirror the images of earlier ones, which
    /// fills edges and corners. The images of bodies and of each wall are blocks of their own.
    fn place_images(&mut self, time: f64, reach: f64) {
        self.images.clear();
        self.chains.clear();
        if self.boundaries.is_empty() {
            return;
        }
        let bodies: Vec<Range<usize>> = self.bodies.iter().map(|body| body.slots.clone()).collect();
        self.place_images_of(&bodies, false, time, reach);
        for wall in 0..self.walls.len() {
            self.place_images_of(&[self.walls[wall].slots.clone()], true, time, reach);
        }
        self.place_transforms(time);
    }

    /// One block of images a boundary, of the particles in `sources`.
    fn place_images_of(&mut self, sources: &[Range<usize>], wall: bool, time: f64, reach: f64) {
        let slots = self.columns.slots();
        let before = self.images.len();
        let mut candidates: Vec<(u32, Option<u32>, [T; D])> = Vec::new();
        for (b, boundary) in self.boundaries.iter().enumerate() {
            let start = self.images.len();
            for k in 0..boundary.images() {
                let own = boundary.transform(k, time);
                candidates.clear();
                let near = |x: &[T; D]| boundary.reaches(k, x, reach, time);
                let positions = self.columns.vectors(Field::Position);
                for slot in sources.iter().flat_map(Clone::clone) {
                    if near(&positions[slot]) {
                        candidates.push((slot as u32, None, positions[slot]));
                    }
                }
                for (image, x) in self.images[before..start]
                    .iter()
                    .zip(&self.listed[slots + before..])
                {
                    if near(x) {
                        candidates.push((image.source, Some(image.transform), *x));
                    }
                }
                for &(source, parent, x) in &candidates {
                    let chain = Chain {
                        parent,
                        boundary: b as u32,
                        image: k as u32,
                    };
                    let known = self.chains.iter().position(|c| *c == chain);
                    let transform = known.unwrap_or(self.chains.len()) as u32;
                    if known.is_none() {
                        self.chains.push(chain);
                    }
                    self.images.push(Image { source, transform });
                    self.listed.push(own.point(&x));
                }
            }
            self.blocks.push(Block {
                slots: slots + start..slots + self.images.len(),
                wall,
            });
        }
    }

    fn place_transforms(&mut self, time: f64) {
        self.transforms.clear();
        for chain in &self.chains {
            let own =
                self.boundaries[chain.boundary as usize].transform(chain.image as usize, time);
            let whole = match chain.parent {
                Some(parent) => self.transforms[parent as usize].then(&own),
                None => own,
            };
            self.transforms.push(whole);
        }
    }

    /// What a sweep over all that moves by forces works on.
    pub fn input(&self) -> SweepInput<'_, T, D> {
        SweepInput {
            targets: 0..self.mobile,
            body_force: self.body_force,
            columns: &self.columns,
            images: &self.images,
            transforms: &self.transforms,
            lists: &self.lists,
            blocks: &self.blocks,
            interactions: &self.interactions,
            smoothing_length: self.smoothing_length,
            lattice_moment: self.scheme.lattice_moment,
            instructions: self.instructions,
        }
    }

    /// Bytes held for particles, lists and records.
    pub fn bytes(&self) -> usize {
        self.columns.bytes_per_particle() * self.columns.slots()
            + self.lists.bytes()
            + self.records.bytes()
            + self.work_records.bytes()
            + self.rows.bytes()
            + self.scratch_rows.bytes()
            + self.listed.capacity() * size_of::<[T; D]>()
    }
}
