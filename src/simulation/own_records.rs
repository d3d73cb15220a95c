//! Records of the rates where all particles come together: those that sums over walls read, since nothing else reads records that it has
//! not packed. The rest is memory that is never written, which a machine does not hold.

use super::group::Group;
use super::own_group::Own;
use super::part::chunk_slots;
use crate::ranks::What;
use crate::scalar::Real;

impl<T: Real, const D: usize> Group<T, D> {
    /// Which particles sums over walls read: those of walls, and those that the lists of these name on any rank. None is told apart
    /// where there are images, by which forces on planes are summed too.
    pub(super) fn read_by_walls(&self) -> Option<Vec<bool>> {
        let (all, (team, part)) = (self.all.as_ref()?, self.apart()?);
        if !self.boundaries.is_empty() {
            return None;
        }
        let slots = all.slots();
        let named: Vec<usize> = part.named(slots).collect();
        let mut is_read = vec![false; slots];
        is_read[all.particles.mobile..].fill(true);
        let lists = self.neighborhood.lists.chunks();
        for list in &lists[(self.particles.mobile / chunk_slots::<T>()).min(lists.len())..] {
            for &j in &list.neighbors {
                is_read[named[j as usize]] = true;
            }
        }
        let bit = |(k, is_read): (usize, &bool)| u8::from(*is_read) << k;
        let bits = |run: &[bool]| run.iter().enumerate().map(bit).sum::<u8>();
        let own: Vec<u8> = is_read.chunks(8).map(bits).collect();
        team.gather(
            What::State,
            |to| to.extend(own),
            |_, bits| {
                for (slot, is_read) in is_read.iter_mut().enumerate() {
                    *is_read |= bits.get(slot / 8)? >> (slot % 8) & 1 == 1;
                }
                Some(())
            },
        );
        Some(is_read)
    }
}

impl<T: Real, const D: usize> Own<T, D> {
    /// So many numbers of all particles, `width` a slot, of which those that are not read are zero.
    pub(super) fn gather_some(
        &self,
        own: Vec<T>,
        (width, count): (usize, usize),
        is_read: &[bool],
    ) -> Vec<T> {
        let team = &self.share.team;
        let of = |rank: usize| {
            let slots = self.runs[rank].iter().cloned().flatten();
            slots.filter(|slot| is_read[*slot])
        };
        let mut ends = vec![0];
        ends.extend((0..team.count()).scan(0, |end, rank| {
            *end += width * of(rank).count();
            Some(*end)
        }));
        let mut some = vec![T::zero(); ends[team.count()]];
        let places = some[ends[team.rank()]..].chunks_exact_mut(width);
        for (place, slot) in places.zip(of(team.rank())) {
            place.copy_from_slice(&own[width * self.part.at(slot)..][..width]);
        }
        drop(own);
        let runs_of = |rank: usize| [ends[rank]..ends[rank + 1], 0..0];
        team.gather_numbers(What::State, &mut some, runs_of, Vec::new(), |_, _| Some(()));
        let mut all = vec![T::zero(); count];
        let slots = (0..team.count()).flat_map(of);
        for (slot, read) in slots.zip(some.chunks_exact(width)) {
            all[width * slot..][..width].copy_from_slice(read);
        }
        all
    }
}
