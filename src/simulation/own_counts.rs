//! What a group counts while each rank has its own particles, and the sums of all ranks.
//! Each begins anew where these are told, so that nothing counts twice.

use super::group::Group;
use super::soundness::NEGATIVE_ENERGY;
use crate::material::eos::GuardCounts;
use crate::ranks::{Taken, What, put_number};
use crate::scalar::Real;
use core::mem::take;

impl<T: Real, const D: usize> Group<T, D> {
    /// Adds up what ranks have counted since they parted, which all know then, and each begins anew.
    pub(super) fn join_counts(&mut self) {
        let (Some(share), Some(mut all)) = (&self.share, self.all.take()) else {
            return;
        };
        let counts = self.counts(all.pairs);
        let mut sums = vec![0; counts.len()];
        let put = |to: &mut Vec<u8>| counts.iter().for_each(|own| put_number(*own, to));
        share.team.gather(What::State, put, |_, from| {
            let mut from = Taken(from);
            for sum in &mut sums {
                *sum += from.number()?;
            }
            from.0.is_empty().then_some(())
        });
        (self.guards, self.limited) = (all.guards, take(&mut all.limited));
        self.work.spent.pairs = all.pairs;
        self.add_counts(&sums);
        (all.guards, all.limited) = (take(&mut self.guards), take(&mut self.limited));
        all.pairs = self.work.spent.pairs;
        self.all = Some(all);
    }

    /// What guards and limits have counted, and how many pairs were summed beside some.
    fn counts(&self, pairs: u64) -> Vec<u64> {
        let GuardCounts {
            compression,
            expansion,
            cut_off,
        } = self.guards;
        let mut counts = vec![
            compression,
            expansion,
            cut_off,
            self.work.spent.pairs - pairs,
        ];
        counts.extend(self.names_of_limits().into_iter().map(|name| {
            let own = self.limited.iter().find(|own| own.0 == name);
            own.map_or(0, |own| own.1)
        }));
        counts
    }

    fn add_counts(&mut self, counts: &[u64]) {
        let [compression, expansion, cut_off, pairs, limited @ ..] = counts else {
            return;
        };
        self.guards += GuardCounts {
            compression: *compression,
            expansion: *expansion,
            cut_off: *cut_off,
        };
        self.work.spent.pairs += pairs;
        for (name, count) in self.names_of_limits().into_iter().zip(limited) {
            self.count(name, *count);
        }
    }

    /// Names of all limits that may be counted, in the order of the scheme.
    fn names_of_limits(&self) -> Vec<&'static str> {
        let program = &self.scheme.program;
        let laws = program.laws.iter().flatten().map(|law| law.name());
        let updates = program.evolved.iter().map(|own| program.name_of(own.field));
        let mut names = Vec::new();
        for name in laws.chain(updates).chain([NEGATIVE_ENERGY]) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }
}
