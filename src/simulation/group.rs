//! A group: the bodies that share a scheme, with their columns, neighbour lists and images.
//! It knows where particles are and who their neighbours are; physics happens in `evaluate`.

use super::images::Chain;
use super::population::{Moves, Removed};
use super::state::Kept;
use super::walls::WallState;
use crate::boundary::{Boundary, Emitter, Outlet};
use crate::material::Material;
use crate::material::eos::GuardCounts;
use crate::neighbors::{Block, ClusterLists, Radii, SearchInput};
use crate::particles::{Columns, Field};
use crate::scalar::{Lane, Real};
use crate::scheme::Scheme;
use crate::sweep::{Image, InstructionSet, Interaction, Records, Rows, SweepInput, Transform};
use crate::tensor::{Vector, length};
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
    /// The same at the last evaluation.
    pub evaluated_gravity: [T; D],
    /// The same in the frame of the wall that carries the liquid.
    pub body_force: [T; D],
    pub boundaries: Vec<Arc<dyn Boundary<T, D>>>,
    pub scheme: Arc<Scheme<T, D>>,
    /// What each of its bodies, walls and boundaries is in the scene: bodies of all groups, then walls,
    /// then boundaries.
    pub seats: Vec<usize>,
    /// How many particles' numbers the groups before it have.
    pub first_id: usize,
    /// Whether a liquid of another group meets one of its bodies.
    pub is_met: bool,
    pub blocks: Vec<Block>,
    pub interactions: Vec<Interaction>,
    pub images: Vec<Image>,
    pub transforms: Vec<Transform<T, D>>,
    pub(super) chains: Vec<Chain>,
    pub lists: ClusterLists,
    /// Positions of slots at the last list build, then of images.
    pub(super) listed: Vec<[T; D]>,
    listed_h: Vec<T>,
    pub(super) listed_time: f64,
    /// Beginning and end \[s\] of the drift under way.
    pub chord: Option<[f64; 2]>,
    pub records: Records<T>,
    pub work_records: Records<T>,
    /// Whether the records are those of the rates; all sweeps share them.
    pub records_of_rates: bool,
    pub rows: Rows<T, D>,
    pub scratch_rows: Rows<T, D>,
    /// What its liquid does to the particles of structures, which are walls here.
    pub structure_rows: Rows<T, D>,
    /// Identity of the particle in each slot, and the slot of each particle.
    pub ids: Vec<u32>,
    pub slot_of: Vec<u32>,
    pub smoothing_length: f64,
    /// The skin of the lists as they are \[m\].
    skin: f64,
    /// Skins of lists that last, and of lists that do not \[m\].
    skins: [f64; 2],
    /// Evaluations that the lists have served since they were built.
    served: u32,
    pub instructions: InstructionSet,
    pub guards: GuardCounts,
    pub limited_h: u64,
    /// Densities of torn liquid that were held, in particle steps.
    pub held_densities: u64,
    pub rebuilds: u64,
    /// The list build with which corrections and viscosities were renewed.
    pub(super) renewed: u64,
    /// The time \[s\] until which they are kept.
    pub(super) renewed_until: f64,
    /// Where the time went.
    pub phases: super::Phases,
    /// Entries of the lists after the last sort.
    sorted_entries: usize,
    pub unilateral: bool,
    /// What list builds have done to particles since kept states were last told.
    pub moved: Moves<T, D>,
    /// What a prediction has changed, and takes back.
    pub(super) predicted: Kept<T>,
    /// States that an integrator keeps.
    pub(super) kept: Vec<Kept<T>>,
}

/// Growth of the lists since the last sort at which particles are sorted again.
const UNSORTED: f64 = 1.03;

/// Lists that served fewer evaluations get the thick skin, and those that served more the thin one again: twice the
/// skin lasts twice as long, so neither brings the other back.
const LASTING: [u32; 2] = [8, 24];

pub(crate) fn width<T: Real>() -> usize {
    <T::Wide<false> as Lane>::WIDTH
}

impl<T: Real, const D: usize> Group<T, D> {
    #[allow(clippy::too_many_arguments)]
    pub fn new(
        columns: Columns<T, D>,
        bodies: Vec<BodyState<T>>,
        walls: Vec<WallState<D>>,
        boundaries: Vec<Arc<dyn Boundary<T, D>>>,
        scheme: Arc<Scheme<T, D>>,
        interactions: Vec<Interaction>,
        smoothing_length: f64,
        skins: [f64; 2],
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
            evaluated_gravity: [T::zero(); D],
            body_force: [T::zero(); D],
            boundaries,
            scheme,
            seats: Vec::new(),
            first_id: 0,
            is_met: false,
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
            structure_rows: Rows::default(),
            smoothing_length,
            skin: skins[0],
            skins,
            served: 0,
            instructions: InstructionSet::detect(),
            guards: GuardCounts::default(),
            limited_h: 0,
            held_densities: 0,
            rebuilds: 0,
            renewed: 0,
            renewed_until: f64::NEG_INFINITY,
            phases: super::Phases::default(),
            sorted_entries: 0,
            unilateral,
            moved: Moves::default(),
            predicted: Kept::default(),
            kept: Vec::new(),
        }
    }

    /// Whether nobody looks at it on its way through a drift.
    pub fn drifts_at_once(&self) -> bool {
        self.scheme.compression.is_none() && !self.is_met
    }

    pub fn particles(&self) -> usize {
        self.bodies.iter().map(|body| body.slots.len()).sum()
    }

    pub fn body_of(&self, slot: usize) -> usize {
        self.bodies
            .partition_point(|body| body.end <= slot)
            .min(self.bodies.len() - 1)
    }

    /// What a block stands for in the scene: images of a wall count as the wall, and a structure as the
    /// body that it is.
    pub fn seat(&self, block: u32) -> usize {
        let (block, bodies, boundaries) =
            (block as usize, self.bodies.len(), self.boundaries.len());
        let direct = bodies + self.walls.len() + boundaries;
        self.seats[if block < direct {
            block
        } else {
            bodies + (block - direct) / boundaries
        }]
    }

    /// Forces between blocks at the last evaluation, with what they stand for in the scene: which feels,
    /// which exerts, and the force \[N\].
    pub fn reactions(&self) -> impl Iterator<Item = (usize, usize, &[f64; D])> {
        self.rows
            .reactions()
            .chain(self.structure_rows.reactions())
            .map(|reaction| {
                (
                    self.seat(reaction.on),
                    self.seat(reaction.from),
                    &reaction.force,
                )
            })
    }

    fn reach(&self) -> f64 {
        let h = self.columns.raw(Field::SMOOTHING_LENGTH);
        let largest = h
            .iter()
            .fold(self.smoothing_length, |m, h| m.max(h.to_f64()));
        self.scheme.kernel.support * largest + self.skin
    }

    /// Brings images and lists up to date with the positions at `time`.
    pub fn refresh(&mut self, time: f64) {
        let start = Instant::now();
        self.place_walls(time);
        if self.lists.chunks().is_empty() {
            self.rebuild(time);
        } else if self.outdated(time) {
            self.choose_skin();
            self.rebuild(time);
        } else if self.boundaries.iter().any(|b| b.moves()) {
            self.place_transforms(time);
        }
        self.served += 1;
        self.phases.lists += start.elapsed();
    }

    /// A skin that suits how long the lists have lasted. It depends on the flow alone, and not on the time that
    /// anything took, so that the next run makes the same lists.
    fn choose_skin(&mut self) {
        let [thin, thick] = self.skins;
        let skin = if self.served < LASTING[0] {
            thick
        } else if self.served > LASTING[1] {
            thin
        } else {
            self.skin
        };
        if skin != self.skin {
            self.skin = skin;
            // Lengths of lists with another skin do not compare: particles are sorted anew.
            self.sorted_entries = 0;
        }
    }

    /// Whether a particle has moved, or its support has grown, by more than the skin allows.
    fn outdated(&self, time: f64) -> bool {
        let positions = self.columns.vectors(Field::POSITION);
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
        let h = self.columns.raw(Field::SMOOTHING_LENGTH);
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

    pub(super) fn rebuild(&mut self, time: f64) {
        self.rebuilds += 1;
        self.served = 0;
        self.listed_time = time;
        self.wrap(time);
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
            .extend_from_slice(self.columns.vectors(Field::POSITION));
        self.listed_h.clear();
        self.listed_h
            .extend_from_slice(self.columns.raw(Field::SMOOTHING_LENGTH));
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
            + self.structure_rows.bytes()
            + self.listed.capacity() * size_of::<[T; D]>()
    }
}
