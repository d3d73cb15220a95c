//! The parts of the offer of a rank: its columns, where they were listed, saved states, sums and records.
//! They have the order in which `bring_together` in `own_group` asks for them.

use super::group::Group;
use super::run_state::State;
use crate::ranks::put_numbers;
use crate::scalar::Real;
use crate::sweep::Results;
use std::ops::Range;

/// A part: numbers of particles, or sums over so many chunks.
enum OwnPart<'a, T: Real, const D: usize> {
    Numbers(&'a [T]),
    Words(Vec<u32>),
    Sums(&'a Results<T, D>, usize),
}

impl<T: Real, const D: usize> OwnPart<'_, T, D> {
    /// Adds it to a message.
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Self::Numbers(own) => put_numbers(own, to),
            Self::Words(own) => put_numbers(own, to),
            Self::Sums(own, chunks) => own.put(*chunks, to),
        }
    }
}

impl<T: Real, const D: usize> State<T, D> {
    /// The bytes of a part; none behind the last part.
    pub(super) fn part(&self, part: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut parts = self.groups.iter().flat_map(Group::own_parts);
        if let Some(own) = parts.nth(part) {
            own.put(&mut bytes);
        }
        bytes
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// All parts of this group; none if it has all particles.
    fn own_parts(&self) -> Vec<OwnPart<'_, T, D>> {
        let Some(all) = &self.all else {
            return Vec::new();
        };
        let (columns, work, count) = (&self.particles.columns, &self.work, all.part.count());
        let mut parts = Vec::new();
        for field in columns.fields().iter() {
            let own = columns.raw(field);
            parts.push(OwnPart::Numbers(&own[..field.components(D) * count]));
        }
        let mut ids = self.particles.ids.clone();
        all.part.number_walls(&mut ids, &all.walls, false);
        let near = &self.neighborhood;
        parts.push(OwnPart::Words(ids));
        parts.push(OwnPart::Numbers(near.listed[..count].as_flattened()));
        if !near.listed_h.is_empty() {
            parts.push(OwnPart::Numbers(&near.listed_h));
        }
        parts.push(OwnPart::Words(near.lists.counts().to_vec()));
        for (field, column) in work.saved().filter(|own| !own.1.is_empty()) {
            parts.push(OwnPart::Numbers(&column[..field.components(D) * count]));
        }
        let chunks = all.part.chunks.iter().map(Range::len).sum();
        parts.extend([&work.rates, &work.worked].map(|own| OwnPart::Sums(own, chunks)));
        let records = [
            (&work.records, work.records_of_rates),
            (&work.work_records, true),
        ];
        for (own, _) in records
            .into_iter()
            .filter(|own| own.1 && own.0.stride() > 0)
        {
            parts.push(OwnPart::Numbers(&own.data()[..own.stride() * count]));
        }
        parts
    }
}
