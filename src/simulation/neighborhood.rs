//! The neighbourhood of a group: lists of who is near, images behind boundaries, and how long both last.
//! It is rebuilt from the positions that it remembers, so a checkpoint needs no lists.

use super::divided::Share;
use super::images::Chains;
use super::population::Particles;
use super::walls::WallState;
use crate::boundary::Boundary;
use crate::collective::{Corners, largest, over};
use crate::neighbors::{Block, ClusterLists, LocalBlock, Radii, SearchInput};
use crate::parallel::apart;
use crate::particles::Field;
use crate::ranks::Team;
use crate::scalar::{Real, width};
use crate::sweep::{Image, InstructionSet, Interaction};
use crate::tensor::{Vector, length};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Neighbour lists of a group and the images in them.
#[derive(Clone, Debug)]
pub(crate) struct Neighborhood<T: Real, const D: usize> {
    pub blocks: Vec<Block>,
    /// Whether particles of a block take a mirrored velocity, where a liquid sticks to them: those of some walls, and their
    /// images.
    pub mirrored: Vec<bool>,
    pub interactions: Vec<Interaction>,
    pub images: Vec<Image>,
    /// What makes the images.
    pub chains: Chains<T, D>,
    /// Shared with copies of the state until one of them lists anew. On ranks those of own chunks.
    pub lists: Arc<ClusterLists>,
    /// On ranks those of all chunks, from the first reading that needs them on.
    pub whole: OnceLock<Arc<ClusterLists>>,
    /// Positions of slots at the last list build, then of images; shared as the lists are.
    pub listed: Arc<Vec<[T; D]>>,
    pub listed_h: Vec<T>,
    pub listed_time: f64,
    /// How far from a boundary particles have images in the lists \[m\].
    pub listed_reach: f64,
    /// The time \[s\] at which the transforms of images are.
    pub placed_time: f64,
    /// The skin of the lists as they are \[m\].
    pub skin: f64,
    /// Skins of lists that last, and of lists that do not \[m\].
    pub skins: [f64; 2],
    /// Evaluations that the lists have served since they were built.
    pub served: u32,
    pub rebuilds: u64,
    /// Entries of the lists after the last sort.
    pub sorted_entries: usize,
    /// Support of the kernel in units of h.
    pub support: f64,
    /// The smoothing length where it is the same for all, and the largest as built \[m\].
    pub smoothing_length: f64,
}

/// Growth of the lists since the last sort at which particles are sorted again.
const UNSORTED: f64 = 1.03;

/// Lists that served fewer evaluations get the thick skin, and those that served more the thin one again: twice the
/// skin lasts twice as long, so neither brings the other back.
pub const LASTING: [u32; 2] = [16, 48];

impl<T: Real, const D: usize> Neighborhood<T, D> {
    pub fn new(
        interactions: Vec<Interaction>,
        (support, smoothing_length): (f64, f64),
        skins: [f64; 2],
    ) -> Self {
        Self {
            blocks: Vec::new(),
            mirrored: Vec::new(),
            interactions,
            images: Vec::new(),
            chains: Chains::default(),
            lists: Arc::default(),
            whole: OnceLock::new(),
            listed: Arc::default(),
            listed_h: Vec::new(),
            listed_time: 0.0,
            listed_reach: 0.0,
            placed_time: 0.0,
            skin: skins[0],
            skins,
            served: 0,
            rebuilds: 0,
            sorted_entries: 0,
            support,
            smoothing_length,
        }
    }

    /// How far a pair reaches, with the skin \[m\].
    pub fn reach(&self, particles: &Particles<T, D>) -> f64 {
        let h = particles.columns.raw(Field::SMOOTHING_LENGTH);
        let largest = largest(0..h.len(), |slot| h[slot].to_f64());
        self.support * largest.max(self.smoothing_length) + self.skin
    }

    /// Makes the lists outdated, for a rehearsal, with the skin that they have; the next list build sorts particles or does not.
    pub fn outdate(&mut self, sort: bool) {
        self.sorted_entries = if sort { 0 } else { usize::MAX };
        self.served = u32::midpoint(LASTING[0], LASTING[1]);
        if let Some(first) = Arc::make_mut(&mut self.listed).first_mut() {
            // No particle is as far away as that.
            first[0] = T::from_f64(f64::from(f32::MAX).sqrt());
        }
    }

    /// A skin that suits how long the lists have lasted. It depends on the flow alone, and not on the time that
    /// anything took, so that the next run makes the same lists.
    pub fn choose_skin(&mut self) {
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

    /// Whether particles need new places in memory: only when their rows have lost their shape, and lists have so many entries by that.
    pub fn wants_sort(&self, entries: usize) -> bool {
        D > 1 && entries as f64 >= UNSORTED * self.sorted_entries as f64
    }

    /// Whether a particle has moved, or its support has grown, by more than the skin allows. `shift` \[m\] is how far
    /// a container that takes its liquid with it has gone: only what moves in it outdates lists. Where nothing happens
    /// at places (`open`), what moves together does not outdate them either.
    pub fn outdated(
        &self,
        particles: &Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        (open, team): (bool, Option<&Team>),
        (shift, time): ([f64; D], f64),
    ) -> bool {
        let positions = particles.columns.vectors(Field::POSITION);
        let moved_by = |slot: usize, d: usize| {
            let (now, then): (&[T; D], &[T; D]) = (&positions[slot], &self.listed[slot]);
            (now[d] - then[d]).to_f64() - shift[d]
        };
        let farthest = largest(0..positions.len(), |slot| {
            (0..D).map(|d| moved_by(slot, d).powi(2)).sum::<f64>()
        });
        let h = particles.columns.raw(Field::SMOOTHING_LENGTH);
        let grown = largest(0..h.len().min(self.listed_h.len()), |slot| {
            (h[slot] - self.listed_h[slot]).to_f64()
        });
        let [farthest, grown] =
            team.map_or([farthest, grown], |team| team.largest([farthest, grown]));
        let farthest = farthest.sqrt();
        let left = self.left(boundaries, grown, (shift, time));
        if 2.0 * farthest <= left || !open {
            return 2.0 * farthest > left;
        }
        // What moves together stays together: no pair's distance changes by more than the corners of all displacements are apart.
        let mut corners = [over(0..positions.len(), |slot| {
            Corners::<D>::at(core::array::from_fn(|d| moved_by(slot, d)))
        })];
        if let Some(team) = team {
            team.join_corners(&mut corners, &mut []);
        }
        let apart2: f64 = corners[0].extent().iter().map(|apart| apart.powi(2)).sum();
        apart2.sqrt() > left
    }

    /// What is left of the skin \[m\] where lengths have grown by `grown` \[m\] at most.
    pub(super) fn left(
        &self,
        boundaries: &[Arc<dyn Boundary<D>>],
        grown: f64,
        (shift, time): ([f64; D], f64),
    ) -> f64 {
        // A moving boundary carries images towards particles that rest, and a boundary at rest reflects
        // what a container does.
        let moved = shift.iter().any(|&s| s != 0.0);
        let shift = Vector::from(shift.map(T::from_f64));
        let carried: f64 = boundaries
            .iter()
            .filter(|boundary| moved || boundary.moves())
            .map(|boundary| {
                (0..boundary.images()).fold(0.0_f64, |most, k| {
                    let now = boundary.transform(k, time).to_scalar::<T>();
                    let then = boundary.transform(k, self.listed_time).to_scalar::<T>();
                    let by = now.rotation * shift - shift;
                    most.max(length(&(now.shift - then.shift + by)).to_f64())
                })
            })
            .sum();
        self.skin - carried - self.support * grown
    }

    /// Lists neighbours at the present positions, with images within `reach` \[m\]; it remembers where particles are, as
    /// blocks of bodies and walls.
    pub fn list(
        &mut self,
        particles: &Particles<T, D>,
        walls: &[WallState<T, D>],
        boundaries: &[Arc<dyn Boundary<D>>],
        at: (f64, f64),
        (instructions, share): (InstructionSet, Option<&mut Share>),
    ) {
        self.remember(particles);
        self.place_blocks(particles, walls, boundaries, at);
        self.search_anew(instructions, |lists, input| match share {
            None => lists.rebuild(input),
            Some(share) => share.list(lists, input, particles.mobile),
        });
    }

    /// Remembers where particles are, from which lists are built.
    pub(super) fn remember(&mut self, particles: &Particles<T, D>) {
        if Arc::get_mut(&mut self.listed).is_none() {
            self.listed = Arc::default();
        }
        let listed = Arc::make_mut(&mut self.listed);
        listed.clear();
        listed.extend_from_slice(particles.columns.vectors(Field::POSITION));
        self.listed_h.clear();
        self.listed_h
            .extend_from_slice(particles.columns.raw(Field::SMOOTHING_LENGTH));
    }

    /// Finds blocks, and images within `reach` \[m\], of particles where they are listed.
    pub(super) fn place_blocks(
        &mut self,
        particles: &Particles<T, D>,
        walls: &[WallState<T, D>],
        boundaries: &[Arc<dyn Boundary<D>>],
        (time, reach): (f64, f64),
    ) {
        self.listed_reach = reach;
        self.blocks.clear();
        let bodies = particles.bodies.iter().map(|body| body.slots.clone());
        let block = |wall| move |slots| Block { slots, wall };
        self.blocks.extend(bodies.map(block(false)));
        self.mirrored.clear();
        self.mirrored.resize(particles.bodies.len(), false);
        self.mirrored
            .extend(walls.iter().map(|wall| wall.is_mirrored()));
        let walls_of = walls.iter().map(|wall| wall.slots.clone());
        self.blocks.extend(walls_of.map(block(true)));
        let bodies = particles.bodies.iter().map(|body| (&body.slots, None));
        let walls = walls.iter().map(|wall| (&wall.slots, Some(wall)));
        let slots = |own: &Range<usize>| own.start as u32..own.end as u32;
        let sources = bodies.chain(walls).map(|(own, wall)| (slots(own), wall));
        self.place_images(sources, boundaries, time);
    }

    /// Lists neighbours at places, with smoothing lengths where they vary, for which a device has listed them. Those of images are known.
    #[cfg(feature = "devices")]
    pub fn list_again(
        &mut self,
        (mut listed, mut listed_h): (Vec<[T; D]>, Vec<T>),
        instructions: InstructionSet,
    ) {
        listed.extend_from_slice(&self.listed[listed.len()..]);
        listed_h.extend_from_slice(&self.listed_h[listed_h.len()..]);
        (self.listed, self.listed_h) = (Arc::new(listed), listed_h);
        self.search_anew(instructions, |lists, input| lists.rebuild(input));
    }

    /// Lists neighbours of the particles in the first slots, where each block is what is here of a block of all ranks.
    pub(super) fn search_own(
        &mut self,
        blocks: &[LocalBlock<D>],
        (instructions, slots): (InstructionSet, usize),
    ) {
        self.search_anew(instructions, |lists, input| {
            lists.rebuild_local(&SearchInput { slots, ..*input }, blocks);
        });
    }

    fn search_anew(
        &mut self,
        instructions: InstructionSet,
        act: impl FnOnce(&mut ClusterLists, &SearchInput<'_, T, D>),
    ) {
        self.whole = OnceLock::new();
        let mut lists = core::mem::take(&mut self.lists);
        if Arc::get_mut(&mut lists).is_none() {
            lists = Arc::default();
        }
        let new = Arc::make_mut(&mut lists);
        self.search(instructions, |input| act(new, input));
        self.lists = lists;
    }

    /// Makes lists of some chunks, which are not here.
    pub(super) fn search_some(&mut self, instructions: InstructionSet, chunks: &[Range<usize>]) {
        self.search_anew(instructions, |lists, input| {
            lists.rebuild_some(input, chunks);
        });
    }

    /// Searches for neighbours at the places of the last list build.
    fn search<V>(
        &self,
        instructions: InstructionSet,
        act: impl FnOnce(&SearchInput<'_, T, D>) -> V,
    ) -> V {
        let radii = if self.listed_h.is_empty() {
            Radii::Uniform(self.support * self.smoothing_length)
        } else {
            Radii::Varying(self.listed_h.as_slice(), self.support)
        };
        let interactions = self.interactions.iter();
        let listed: Vec<bool> = interactions.map(|own| *own != Interaction::None).collect();
        act(&SearchInput {
            positions: &self.listed,
            listed: &listed,
            radii,
            blocks: &self.blocks,
            width: width::<T>(),
            slots: self.listed.len() - self.images.len(),
            skin: self.skin,
            instructions,
        })
    }

    /// The lists of all chunks, of which a rank makes those of others when something that reads needs them.
    pub fn all_lists(&self) -> &Arc<ClusterLists> {
        if self.lists.is_whole() {
            return &self.lists;
        }
        self.whole.get_or_init(|| {
            let mut lists = ClusterLists::default();
            self.search(InstructionSet::detect(), |input| {
                // Not by threads that may be asked for something that waits for these lists.
                apart(|| lists.rebuild(input));
            });
            Arc::new(lists)
        })
    }

    /// Finds which images are needed of the particles of each body and of each wall, by their numbers. They are blocks of their own, one a
    /// boundary.
    pub(super) fn place_images<'a, S: Iterator<Item = u32> + Clone>(
        &mut self,
        sources: impl Iterator<Item = (S, Option<&'a WallState<T, D>>)>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        self.images.clear();
        self.chains.clear();
        if boundaries.is_empty() {
            return;
        }
        let listed = Arc::make_mut(&mut self.listed);
        let mut images = Vec::new();
        for (sources, wall) in sources {
            images.clear();
            for b in 0..boundaries.len() {
                let before = images.len();
                let at = (self.listed_reach, time);
                let place = |own: u32| (own, listed[own as usize].map(Real::to_f64));
                let sources = sources.clone().map(place);
                self.chains.show(sources, &mut images, (boundaries, b), at);
                let start = listed.len();
                for (image, x) in &images[before..] {
                    self.images.push(*image);
                    listed.push(x.map(T::from_f64));
                    if let Some(h) = self.listed_h.get(image.source as usize) {
                        self.listed_h.push(*h);
                    }
                }
                self.blocks.push(Block {
                    slots: start..listed.len(),
                    wall: wall.is_some(),
                });
                self.mirrored.push(wall.is_some_and(WallState::is_mirrored));
            }
        }
        self.place_transforms(boundaries, time);
    }

    /// Brings the transforms of images up to date.
    pub(super) fn place_transforms(&mut self, boundaries: &[Arc<dyn Boundary<D>>], time: f64) {
        self.placed_time = time;
        self.chains.place(boundaries, time);
    }

    /// The pairs of a sweep over these slots.
    pub fn pairs_of(&self, slots: Range<usize>) -> u64 {
        let width = width::<T>();
        (width * self.lists.entries_of(slots, width)) as u64
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.lists.bytes() + self.listed.capacity() * size_of::<[T; D]>()
    }
}
