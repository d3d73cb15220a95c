//! What a chunk is among blocks: who meets whom, across what, and for which side their sums are made.
//! Known without kernel and terms, so it is compiled once and not for every loop.

use crate::neighbors::{Block, Order, Segment};
use crate::scalar::{Lane, Real};
use crate::sweep::Interaction;
use std::ops::Range;

/// The meetings of a chunk with blocks.
pub(super) struct Meetings<'a> {
    pub blocks: &'a [Block],
    pub interactions: &'a [Interaction],
    /// The slots whose sums are wanted.
    pub targets: &'a Range<usize>,
    /// The slots of the chunk.
    pub inside: Range<usize>,
    /// Whether the loop sums pairs of one chunk for both of them.
    pub for_both: bool,
    /// Whether it does not look across a contact that may open.
    pub one_sided: bool,
}

/// How a row meets a segment of its neighbours.
pub(super) struct Meeting {
    /// Whether that is across a contact that may open.
    pub contact: bool,
    /// Whether the pairs are summed for both sides.
    pub both: bool,
}

impl Meetings<'_> {
    /// How a row of a block meets a segment, unless it does not or has been met by it.
    #[inline(never)]
    pub fn of(&self, block: usize, segment: &Segment) -> Option<Meeting> {
        let other = segment.block as usize;
        let interaction = self.interactions[block * self.blocks.len() + other];
        let contact = interaction == Interaction::Unilateral;
        // A gradient does not look across a contact that may open, unless it shares the sweep of what must.
        if interaction == Interaction::None || (contact && self.one_sided) {
            return None;
        }
        let both = self.for_both && other == block && !contact && self.wants(&self.blocks[block]);
        if both && segment.order == Order::Earlier {
            return None;
        }
        let both = both && segment.order == Order::Later;
        Some(Meeting { contact, both })
    }

    /// Whether all sums of a block's particles in the chunk are wanted: then pairs may be summed for both.
    fn wants(&self, block: &Block) -> bool {
        self.targets.start <= block.slots.start.max(self.inside.start)
            && self.targets.end >= block.slots.end.min(self.inside.end)
    }

    /// Adds to the rows of the chunk what earlier rows have summed for their particles, lane by lane: `raised` says which are
    /// maxima. Slots behind the last particle of a block repeat it. What was added is cleared for the next chunk. Always
    /// inlined: as a call it costs a sweep in a plane 6 %.
    #[inline(always)]
    pub fn add_later<T: Real, L: Lane<Scalar = T>>(
        &self,
        later: &mut [T],
        out: &mut [T],
        row: usize,
        raised: u128,
    ) {
        let firsts = self.inside.clone().step_by(L::WIDTH);
        for (first, (later, out)) in
            firsts.zip(later.chunks_mut(L::WIDTH * row).zip(out.chunks_mut(row)))
        {
            let own = block_of(self.blocks, first).map(|block| &self.blocks[block]);
            let Some(own) = own.filter(|own| self.targets.contains(&first) && self.wants(own))
            else {
                continue;
            };
            let members = own.slots.end - first;
            for slot in 0..L::WIDTH {
                let own = &later[slot.min(members - 1) * row..][..row];
                for (k, lanes) in own.chunks_exact(L::WIDTH).enumerate() {
                    let sum = &mut out[k * L::WIDTH + slot];
                    *sum = if raised >> k & 1 == 1 {
                        sum.max(T::halves(lanes, true))
                    } else {
                        *sum + T::halves(lanes, false)
                    };
                }
            }
            later.fill(T::zero());
        }
    }
}

/// The block that a slot belongs to, unless no particle owns it any more.
pub(super) fn block_of(blocks: &[Block], slot: usize) -> Option<usize> {
    let block = blocks.partition_point(|b| b.slots.end <= slot);
    let own = blocks.get(block)?.slots.contains(&slot);
    own.then_some(block)
}
