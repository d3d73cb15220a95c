//! The part of a rank in a group: the chunks whose sums and lists it makes, before all ranks get those of all.
//! Without ranks the sweep and the search run as they are.

use super::Simulation;
use super::group::Group;
use crate::clock::Instant;
use crate::collective::over;
use crate::error::{Error, Result};
use crate::neighbors::{CHUNK, ClusterLists, SearchInput};
use crate::particles::Field;
use crate::ranks::{Division, Source, Stamp, Taken, Team, Traffic, What};
use crate::scalar::{Real, width};
use crate::sweep::{InstructionSet, PairSweep, Pass, Records, Results, Root, SweepInput};
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

/// Cost of the slowest rank over the mean at which chunks are cut anew.
const SLOWEST: f64 = 1.1;

/// Part of that cost at which another cut that costs more is worth the way of particles to it.
const WORTH: f64 = 0.95;

/// The sum of the last digits of all velocities: of other motions it is another.
fn motion_of<T: Real, const D: usize>(group: &Group<T, D>) -> u64 {
    let velocities = group.particles.columns.vectors(Field::VELOCITY);
    over(0..velocities.len(), |slot| {
        Stamp::digits(velocities[slot].map(Real::to_f64))
    })
}

/// The part of a rank in a group.
#[derive(Clone, Debug)]
pub(crate) struct Share {
    pub team: Arc<Team>,
    division: Division,
}

impl Share {
    pub fn new(team: Arc<Team>) -> Self {
        Self {
            team,
            division: Division::default(),
        }
    }

    /// Cuts the chunks of new lists, of which particles that move by forces fill the first `mobile` slots.
    pub fn divide<T: Real>(&mut self, lists: &ClusterLists, mobile: usize) {
        let mobile = mobile.div_ceil(CHUNK * width::<T>());
        self.division = Division::new(&lists.costs(), mobile, self.team.count());
    }

    /// The chunks of all ranks.
    pub fn division(&self) -> &Division {
        &self.division
    }

    /// Whether these lists were cut.
    pub fn is_divided(&self, lists: &ClusterLists) -> bool {
        let [mobile, others] = self.division.of(self.team.count() - 1);
        mobile.end.max(others.end) == lists.chunks().len()
    }

    /// Cuts the chunks as said.
    pub fn set_division(&mut self, division: Division) {
        self.division = division;
    }

    /// How chunks of these costs, of which so many have particles that move by forces, are cut anew: where the slowest rank is more than a
    /// tenth above the mean.
    pub fn better_division(&self, costs: &[usize], of_mobile: usize) -> Option<Division> {
        let new = Division::new(costs, of_mobile, self.team.count());
        let [now, then] = [&new, &self.division].map(|own| own.imbalance(costs));
        // Few chunks cannot be cut better, and would go to and fro; and what ranks step by parts stays so.
        let is_better = now <= SLOWEST || now < WORTH * then;
        let stays = self.division.is_full() && !new.is_full();
        (then > SLOWEST && is_better && !stays).then_some(new)
    }

    /// Makes the lists of own chunks as they were cut before, which are cut anew where the slowest rank would be more than a tenth
    /// above the mean. Of others' lists a rank knows how long they are.
    pub fn list<T: Real, const D: usize>(
        &mut self,
        lists: &mut ClusterLists,
        input: &SearchInput<'_, T, D>,
        mobile: usize,
    ) {
        let rank = self.team.rank();
        let chunks = (input.slots / input.width).div_ceil(CHUNK);
        let of_mobile = mobile.div_ceil(CHUNK * input.width).min(chunks);
        if !self.division.is_of(chunks, of_mobile) {
            self.division = Division::new(&vec![1; chunks], of_mobile, self.team.count());
        }
        let made = self.division.of(rank);
        lists.keep(&made);
        lists.rebuild_some(input, &made);
        let mut own = Vec::new();
        for run in &made {
            lists.put_counts(run.clone(), &mut own);
        }
        let take = |other: usize, from: &[u8]| {
            let mut from = Taken(from);
            for run in self.division.of(other) {
                lists.take_counts(run, &mut from)?;
            }
            from.0.is_empty().then_some(())
        };
        self.team
            .gather(What::Lists, |to| to.append(&mut own), take);
        if self.team.is_broken() {
            // What is under way goes on to where the error is told.
            lists.rebuild(input);
        }
        let Some(new) = self.better_division(&lists.costs(), of_mobile) else {
            return;
        };
        self.division = new;
        let wanted = self.division.of(rank);
        lists.keep(&wanted);
        let missing: Vec<_> = wanted
            .iter()
            .flat_map(|run| lists.missing(run.clone()))
            .collect();
        if !missing.is_empty() {
            lists.rebuild_some(input, &missing);
        }
    }

    /// The chunks of a rank among those of a sweep.
    fn chunks_of<T: Real>(&self, rank: usize, targets: &Range<usize>) -> [Range<usize>; 2] {
        let slots = CHUNK * width::<T>();
        let wanted = targets.start / slots..targets.end.div_ceil(slots);
        self.division.of(rank).map(|own| {
            let start = own.start.max(wanted.start);
            start..own.end.min(wanted.end).max(start)
        })
    }

    /// Makes the sums of own chunks, and gets those of the others.
    fn sum<T: Real, const D: usize>(
        &self,
        (sweep, pass): (&dyn PairSweep<T, D>, Pass),
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Results<T, D>,
    ) {
        let slots = CHUNK * width::<T>();
        let (targets, end) = (input.targets.clone(), input.targets.end);
        let whole = core::slice::from_ref(&targets);
        let mut runs = Vec::new();
        for own in self.chunks_of::<T>(self.team.rank(), &targets) {
            let own = own.start * slots..own.end * slots;
            let both = input
                .among
                .unwrap_or(whole)
                .iter()
                .map(|run| run.start.max(own.start)..run.end.min(own.end));
            runs.extend(both.filter(|run| !run.is_empty()));
        }
        let narrowed = SweepInput {
            among: Some(&runs),
            targets: targets.clone(),
            ..*input
        };
        sweep.run(pass, &narrowed, records, rows);
        let chunks: Vec<_> = (0..self.team.count())
            .map(|rank| self.chunks_of::<T>(rank, &targets))
            .collect();
        let numbers_of =
            |own: &[Range<usize>; 2]| own.each_ref().map(|run| rows.numbers_of(run, end));
        let numbers: Vec<_> = chunks.iter().map(numbers_of).collect();
        rows.gather(Source::All(&self.team, What::Sums), &numbers, &chunks);
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The same on these ranks.
    pub(crate) fn on(mut self, team: Option<Arc<Team>>) -> Self {
        self.team = team;
        self
    }

    /// Ends a call on all ranks alike, if there are any.
    pub(super) fn agree<V>(&mut self, outcome: Result<V>) -> Result<V> {
        let agreed = self.agree_on(outcome);
        match agreed {
            Err(Error::Rank { .. }) => self.keep_failure(agreed),
            agreed => agreed,
        }
    }

    /// The same of what leaves the simulation as it is.
    pub(crate) fn agree_on<V>(&self, outcome: Result<V>) -> Result<V> {
        let Some(team) = &self.team else {
            return outcome;
        };
        let own = self.state.own();
        let parted = own.is_parted();
        let stamp = Stamp {
            steps: own.steps,
            time: own.time,
            particles: if parted { 0 } else { self.particles() },
            motion: if parted {
                // Particles are elsewhere; loads are functions of the program.
                Stamp::digits(own.groups.iter().flat_map(|group| group.gravity))
            } else {
                own.groups.iter().map(motion_of).sum()
            },
        };
        team.agree(Some(stamp), outcome)
    }

    /// What the first rank says, for what all decide by a clock.
    pub(crate) fn as_first_rank(&self, own: Option<(String, String)>) -> Option<(String, String)> {
        let Some(team) = &self.team else {
            return own;
        };
        let mut said = None;
        let put = |to: &mut Vec<u8>| {
            if let Some((name, why)) = own.filter(|_| team.rank() == 0) {
                to.extend(format!("{name}\0{why}").into_bytes());
            }
        };
        team.gather(What::Decision, put, |rank, text| {
            if rank == 0 {
                let text = String::from_utf8_lossy(text).into_owned();
                said = text
                    .split_once('\0')
                    .map(|(name, why)| (name.into(), why.into()));
            }
            Some(())
        });
        said
    }

    /// The number of this rank and of how many, on [ranks](crate::ranks).
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
    ///     .build()?;
    /// assert_eq!(simulation.rank(), None);
    /// assert!(simulation.is_first_rank());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn rank(&self) -> Option<(usize, usize)> {
        let team = self.team.as_ref()?;
        Some((team.rank(), team.count()))
    }

    /// Whether this is the first rank, or the only process: the one that prints, and writes files.
    #[must_use]
    pub fn is_first_rank(&self) -> bool {
        self.team.as_ref().is_none_or(|team| team.rank() == 0)
    }

    /// What this rank and the others said to each other until now, on [ranks](crate::ranks).
    #[must_use]
    pub fn traffic(&self) -> Option<Traffic> {
        self.team.as_ref().map(|team| team.traffic())
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// Runs a sweep, or the part of this rank and then gets the sums of the others.
    pub(super) fn run_sweep(
        &self,
        (sweep, pass): (&dyn PairSweep<T, D>, Pass),
        input: &SweepInput<'_, T, D>,
        records: &Records<T>,
        rows: &mut Results<T, D>,
    ) {
        match self.share.as_ref().filter(|_| self.all.is_none()) {
            None => sweep.run(pass, input, records, rows),
            Some(share) => share.sum((sweep, pass), input, records, rows),
        }
    }

    /// Packs records and runs a sweep over all of its particles: where a rank has its own alone, over those whose neighbours are all
    /// here while those of others come, and then over the rest. What both took.
    pub(super) fn pack_and_run(
        &self,
        sweep: &dyn PairSweep<T, D>,
        input: &SweepInput<'_, T, D>,
        records: &mut Records<T>,
        rows: &mut Results<T, D>,
    ) -> [Duration; 2] {
        let (start, pass) = (Instant::now(), Pass::Rates);
        let apart = self.apart().filter(|_| input.among.is_none());
        let Some((_, part)) = apart else {
            sweep.pack(pass, input, records);
            let packed = start.elapsed();
            self.run_sweep((sweep, pass), input, records, rows);
            return [packed, start.elapsed().saturating_sub(packed)];
        };
        let [inner, outer] = part.inner_and_outer(&input.targets);
        let over = |among, goes_on| SweepInput {
            among: Some(among),
            goes_on,
            targets: input.targets.clone(),
            ..*input
        };
        let mut summed = Duration::ZERO;
        sweep.pack_beside(pass, input, records, &mut |own| {
            let begun = Instant::now();
            sweep.run(pass, &over(&inner, false), own, rows);
            summed = begun.elapsed();
        });
        let packed = start.elapsed().saturating_sub(summed);
        sweep.run(pass, &over(&outer, true), records, rows);
        [packed, start.elapsed().saturating_sub(packed)]
    }

    /// Makes it a group of these ranks, whose loops run on what all of their machines have.
    pub(crate) fn share(&mut self, team: &Arc<Team>) {
        self.share = Some(Share::new(team.clone()));
        let sets = [
            InstructionSet::Baseline,
            InstructionSet::Avx2,
            InstructionSet::Avx512,
        ];
        let roots = [Root::Divider, Root::Products];
        let set = sets.iter().position(|own| *own == self.instructions);
        let root = roots.iter().position(|own| *own == self.root);
        let own = [set, root].map(|own| own.unwrap_or(0) as u8);
        let mut all = own;
        team.gather(
            What::Instructions,
            |to| to.extend(own),
            |_, other| {
                let other: [u8; 2] = other.try_into().ok()?;
                all = core::array::from_fn(|k| all[k].min(other[k]));
                Some(())
            },
        );
        self.instructions = sets[usize::from(all[0])];
        self.root = roots[usize::from(all[1])];
    }
}

#[cfg(test)]
mod tests {
    use crate::prelude::{Body, Scene, Wall, catalogue, schemes};
    use crate::ranks::{even, in_threads};

    /// What the lists of each rank cost over the mean, after ten list builds of water that is on one side of its tank.
    #[test]
    fn the_slowest_rank_is_within_a_tenth_of_the_mean() {
        let all = in_threads(2, 1, |ranks| {
            let water = catalogue::weakly_compressible_water(4.0);
            let open = [[true; 2], [true, false]];
            let mut now = Scene::<f64, 2>::new(schemes::weakly_compressible())
                .body(Body::block("water", water, [0.0; 2], [0.8, 0.8], 0.006))
                .wall(Wall::around("tank", [0.0; 2], [2.4, 1.2], 0.006, 4, open))
                .acceleration(|_| [0.0, -9.81])
                .on_ranks(ranks)
                .build()
                .expect("the scene");
            while now.list_builds() < 11 {
                now.step().expect("a step");
            }
            let group = &now.state.groups[0];
            let division = group.share.as_ref().expect("ranks").division();
            let chunks = group.neighborhood.lists.chunks();
            let costs = group.neighborhood.lists.costs();
            let cost = |own: Vec<usize>| own.iter().map(|&k| costs[k]).sum::<usize>() as f64;
            let by_cost = |rank| cost(division.of(rank).into_iter().flatten().collect());
            let by_number = |rank| cost(even(chunks.len(), rank, 2).collect());
            [[0, 1].map(by_cost), [0, 1].map(by_number)]
        });
        let over_mean = |costs: [f64; 2]| 2.0 * costs[0].max(costs[1]) / (costs[0] + costs[1]);
        for costs in all.expect("threads") {
            assert!(over_mean(costs[0]) < 1.1, "{costs:?}");
            // The control: so many chunks for each.
            assert!(over_mean(costs[1]) > 1.1, "{costs:?}");
        }
    }
}
