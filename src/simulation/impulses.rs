//! Impulses between blocks since the start, and the forces that give them, summed block by block.
//! They keep their memory from one kick to the next.

use crate::collective::{Collective, ExactSum};
use crate::ranks::{Taken, Team, What, put_number};
use std::collections::BTreeMap;

/// Momentum that blocks have given each other \[kg m/s\]: bodies first, then boundaries. Behind them, body by body, what forces of
/// laws have given, and their work \[J\].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Impulses {
    pub values: Vec<f64>,
    /// The time \[s\] of the state that they belong to; of rates it is one.
    pub time: f64,
}

impl Impulses {
    pub fn add(&mut self, index: usize, value: f64) {
        if self.values.len() <= index {
            self.values.resize(index + 1, 0.0);
        }
        self.values[index] += value;
    }
    /// Adds the sums of forces \[N\] over `dt` \[s\], of which none are left.
    pub fn add_sums<const D: usize>(&mut self, forces: &mut PairForces<D>, dt: f64) {
        forces.places.fill(0);
        for (pair, sum) in forces.sums.drain(..) {
            for (d, force) in sum.value().into_iter().enumerate() {
                self.add(pair * D + d, dt * force);
            }
        }
    }
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.values.iter().copied()
    }
    pub fn get(&self, index: usize) -> f64 {
        self.values.get(index).copied().unwrap_or(0.0)
    }
    /// a · self + b · other + dt · rate.
    pub fn combine(&self, a: f64, other: &Self, b: f64, rate: &Self, dt: f64) -> Self {
        let length = self
            .values
            .len()
            .max(other.values.len())
            .max(rate.values.len());
        let sum = |k: usize| a * self.get(k) + b * other.get(k) + dt * rate.get(k);
        Self {
            values: (0..length).map(sum).collect(),
            time: a * self.time + b * other.time + dt * rate.time,
        }
    }
}

/// Sums of forces \[N\], or of impulses, between blocks, by the number of the pair.
#[derive(Clone, Debug, Default)]
pub(super) struct PairForces<const D: usize> {
    /// One more than the place of the sum of a pair; zero before its first force.
    places: Vec<usize>,
    sums: Vec<(usize, Collective<[f64; D]>)>,
}

impl<const D: usize> PairForces<D> {
    pub fn add(&mut self, pair: usize, force: [f64; D]) {
        if self.places.len() <= pair {
            self.places.resize(pair + 1, 0);
        }
        if self.places[pair] == 0 {
            self.sums.push((pair, Collective::new()));
            self.places[pair] = self.sums.len();
        }
        self.sums[self.places[pair] - 1].1.add(force);
    }

    /// The sums of all ranks, each of which has those of its particles.
    pub fn join(&mut self, team: &Team) {
        let put = |to: &mut Vec<u8>| {
            for (pair, sum) in &self.sums {
                put_number(*pair as u64, to);
                sum.parts().iter().for_each(|own| own.put(to));
            }
        };
        let mut all: BTreeMap<u64, [ExactSum; D]> = BTreeMap::new();
        team.gather(What::Numbers, put, |_, from| {
            let mut from = Taken(from);
            while !from.0.is_empty() {
                let pair = from.number()?;
                let sums = all.entry(pair);
                let sums = sums.or_insert_with(|| core::array::from_fn(|_| ExactSum::ZERO));
                for sum in sums {
                    sum.take(&mut from)?;
                }
            }
            Some(())
        });
        if team.is_broken() {
            return;
        }
        self.places.fill(0);
        self.sums.clear();
        for (pair, sums) in all {
            self.sums.push((pair as usize, Collective::of_parts(sums)));
        }
    }
}
