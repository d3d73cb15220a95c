//! What steps of a scene give on ranks: they are rehearsed on one rank, whose messages are counted by kind, and taken back.
//! So gatherings are those that the code makes, and none is written down twice.

use super::Simulation;
use super::divided::Share;
use super::group::Group;
use super::part::chunk_slots;
use super::run::check_end;
use super::stored::EVERY;
use crate::clock::Instant;
use crate::collective::Corners;
use crate::collective::over;
use crate::error::{Failure, Result};
use crate::once::once;
use crate::particles::Field;
use crate::ranks::{RankModel, RankParts, RankPrice, Ranks, Team, even};
use crate::scalar::Real;
use core::ops::Range;
use std::sync::Arc;

/// Steps without list builds whose mean is that of all, and steps that are tried for them.
const PLAIN: [u32; 2] = [3, 12];

/// A rank that is alone: it gets what it gives.
#[derive(Debug)]
struct Alone;

impl Ranks for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn count(&self) -> usize {
        1
    }

    fn gather(&self, own: &[u8], _: &[usize], all: &mut [u8]) -> core::result::Result<(), Failure> {
        all.copy_from_slice(own);
        Ok(())
    }

    fn exchange(
        &self,
        own: &[u8],
        _: &[usize],
        all: &mut [u8],
        _: &[usize],
    ) -> core::result::Result<(), Failure> {
        all.copy_from_slice(own);
        Ok(())
    }
}

/// What a step took.
struct Seen {
    price: RankPrice,
    /// List builds in it, and sorts.
    builds: u64,
    sorts: u64,
    /// Whether all particles were brought together for their stored energy.
    is_looked_at: bool,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// What a step of this scene gives and takes on ranks: [`RankModel::on`] predicts from it the time, the messages and the memory of
    /// a step on any number of ranks. List builds a step are those of [`expected_work`](Self::expected_work) until `end` \[s\]. They sort
    /// as often as those did that were rehearsed, and always where none was.
    ///
    /// It rehearses some steps on one rank, counts what that gives, and takes them back: nothing of what comes is changed. Times are
    /// those of this process with its threads. The state is held twice meanwhile. On ranks all call it.
    ///
    /// Ghosts are those of boxes, bytes and memory those of particles in place now. What the run makes of its scene later is not in it.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// use meshfree::ranks::Network;
    /// let water = catalogue::weakly_compressible_water(2.0);
    /// let mut pool = Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(Body::block("water", water, [0.0; 2], [0.6, 0.3], 0.01))
    ///     .boundary(MirrorPlane::wall([0.0; 2], [0.0, -1.0]))
    ///     .acceleration(|_| [0.0, -9.81])
    ///     .build()?;
    /// let model = pool.rank_model(0.1)?;
    /// assert_eq!((pool.steps(), model.particles), (0, 1800.0));
    /// let cost = model.on(2, &Network::default())?;
    /// // A cut of 30 particles, a few deep, whose records travel twice a step.
    /// assert!(cost.ghosts > 60.0 && cost.ghosts < 240.0, "{cost}");
    /// // The same water, larger, on more ranks.
    /// let large = model.of_particles(1e7)?.on(100, &Network::default())?;
    /// assert!(large.step > cost.step);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`expected_work`](Self::expected_work).
    pub fn rank_model(&mut self, end: f64) -> Result<RankModel> {
        once!(self => &mut Simulation, |own, end: f64| -> Result<RankModel> {
            let model = own.model_of_ranks(end);
            own.agree_on(model)
        })
    }

    fn model_of_ranks(&mut self, end: f64) -> Result<RankModel> {
        check_end(end)?;
        let expected = self.expected_work(end)?;
        let bytes = expected.bytes as f64;
        let builds = expected.list_builds as f64 / expected.steps.max(1) as f64;
        self.on_last_step(|own| {
            let kept = own.keep();
            let team = Arc::new(Team::new(Arc::new(Alone)));
            let others = own.team.replace(team.clone());
            // Scenes with events have the other form of a step, and events are not looked at meanwhile.
            let before = core::mem::replace(&mut own.steps_parts, own.events.is_empty());
            let events = core::mem::take(&mut own.events);
            for group in &mut own.state.groups {
                let near = &mut group.neighborhood;
                near.lists = near.all_lists().clone();
                let mut share = Share::new(team.clone());
                share.divide::<T>(&group.neighborhood.lists, group.particles.mobile);
                group.share = Some(share);
            }
            let model = own.rehearse_alone(&team, (bytes, builds.min(1.0)));
            *own.state = kept;
            (own.team, own.events, own.failed) = (others, events, None);
            own.steps_parts = before;
            model
        })
    }

    fn rehearse_alone(
        &mut self,
        team: &Team,
        (bytes, list_builds): (f64, f64),
    ) -> Result<RankModel> {
        // It finds its ghosts in the first step, and those after a list build again.
        self.see_step(team)?;
        let mut plain: Vec<Seen> = Vec::new();
        let mut building = Vec::new();
        for _ in 0..PLAIN[1] {
            let seen = self.see_step(team)?;
            if seen.builds > 0 {
                building.push(seen);
            } else if !seen.is_looked_at {
                plain.push(seen);
            }
            if plain.len() == PLAIN[0] as usize {
                break;
            }
        }
        let own_alone = self.is_parted() || (self.steps_parts && self.may_part());
        let plain = mean(if plain.is_empty() { &building } else { &plain });
        let built = self.see_list_build(team, false)?;
        let sorted = self.see_list_build(team, true)?;
        // Neighbours of a reference stay.
        let list_build = if built.builds > 0 { built.price } else { plain };
        let sort = if D > 1 && sorted.builds > 0 {
            excess(sorted.price, list_build)
        } else {
            RankPrice::default()
        };
        let builds = building.iter().map(|own| own.builds).sum::<u64>();
        let sorts = building.iter().map(|own| own.sorts).sum::<u64>();
        let looks = self.state.stores.accounts.iter().any(Option::is_some);
        let gather_all = self.see(team, |own| {
            own.bring_together();
            Ok(())
        })?;
        Ok(RankModel {
            particles: self
                .state
                .groups
                .iter()
                .map(|own| own.particles.columns.slots())
                .sum::<usize>() as f64,
            chunk: chunk_slots::<T>() as f64,
            bytes,
            parts: self.state.groups.iter().flat_map(Group::parts).collect(),
            own_alone,
            step: plain,
            list_build,
            sort,
            gather_all: gather_all.price,
            list_builds,
            // As often as was seen, and always where it was not.
            sorts: if own_alone && builds > 0 {
                sorts as f64 / builds as f64
            } else {
                1.0
            },
            gathers_of_all: if own_alone && looks {
                1.0 / EVERY as f64
            } else {
                0.0
            },
        })
    }

    /// What a step with a list build takes that sorts particles, where they can be sorted, or does not.
    fn see_list_build(&mut self, team: &Team, sorts: bool) -> Result<Seen> {
        loop {
            for group in &mut self.state.groups {
                group.neighborhood.outdate(sorts);
            }
            let seen = self.see_step(team)?;
            if !seen.is_looked_at {
                return Ok(seen);
            }
        }
    }

    fn see_step(&mut self, team: &Team) -> Result<Seen> {
        self.see(team, |own| own.step_to(f64::INFINITY).map(|_| ()))
    }

    /// What an act gives and takes.
    fn see(&mut self, team: &Team, act: impl FnOnce(&mut Self) -> Result<()>) -> Result<Seen> {
        let (traffic, given) = (team.traffic(), team.given());
        let (start, phases, builds) = (Instant::now(), self.phases(), self.list_builds());
        act(self)?;
        let (now, gave) = (team.traffic(), team.given());
        let (taken, spent) = (start.elapsed().as_secs_f64(), self.phases().since(&phases));
        let builds = self.list_builds() - builds;
        let swept = spent.lists + spent.pairs + spent.walls + spent.work;
        // Ranks that step their own particles do everything for these alone.
        let divided = if self.is_parted() {
            taken
        } else {
            swept.as_secs_f64().min(taken)
        };
        let groups = self.state.groups.len() as f64;
        Ok(Seen {
            price: RankPrice {
                gathered: (now.gathered - traffic.gathered) as f64,
                exchanged: (now.exchanged - traffic.exchanged) as f64,
                each: (gave.each - given.each) as f64,
                parts: (gave.parts - given.parts) as f64,
                to_each: (gave.to_each - given.to_each) as f64,
                // Ghosts of all groups are one sum.
                of_ghost: (gave.of_ghost - given.of_ghost) as f64 / groups,
                divided,
                undivided: taken - divided,
            },
            builds,
            sorts: now.travelled - traffic.travelled,
            is_looked_at: self.state.steps.is_multiple_of(EVERY),
        })
    }
}

fn combined(a: RankPrice, b: RankPrice, of: fn(f64, f64) -> f64) -> RankPrice {
    RankPrice {
        gathered: of(a.gathered, b.gathered),
        exchanged: of(a.exchanged, b.exchanged),
        each: of(a.each, b.each),
        parts: of(a.parts, b.parts),
        to_each: of(a.to_each, b.to_each),
        of_ghost: of(a.of_ghost, b.of_ghost),
        divided: of(a.divided, b.divided),
        undivided: of(a.undivided, b.undivided),
    }
}

fn plus(a: RankPrice, b: RankPrice) -> RankPrice {
    combined(a, b, |a, b| a + b)
}

/// By how much one is more than another.
fn excess(a: RankPrice, b: RankPrice) -> RankPrice {
    combined(a, b, |a, b| (a - b).max(0.0))
}

fn mean(all: &[Seen]) -> RankPrice {
    let sum = (all.iter()).fold(RankPrice::default(), |sum, own| plus(sum, own.price));
    sum.times(1.0 / all.len().max(1) as f64)
}

impl<T: Real, const D: usize> Group<T, D> {
    /// What is cut among ranks: the particles that move by forces, and all others, where lists were cut.
    fn parts(&self) -> Vec<RankParts> {
        let (mobile, slots) = (self.particles.mobile, self.particles.columns.slots());
        let size = chunk_slots::<T>();
        let chunks = self.neighborhood.lists.chunks();
        let of_mobile = mobile.div_ceil(size).min(chunks.len());
        // Particles of either kind that the lists of either kind name.
        let named = |chunks: Range<usize>| {
            let mut is_named = vec![false; slots];
            for list in &self.neighborhood.lists.chunks()[chunks] {
                for &j in &list.neighbors {
                    let image = (j as usize).checked_sub(slots);
                    let source = image.and_then(|k| self.neighborhood.images.get(k));
                    let source = source.map_or(j as usize, |image| image.source as usize);
                    is_named[source] = true;
                }
            }
            let count = |slots: Range<usize>| is_named[slots].iter().filter(|own| **own).count();
            [count(0..mobile), count(mobile..slots)]
        };
        let [by_mobile, by_others] = [0..of_mobile, of_mobile..chunks.len()].map(named);
        let kinds = [
            (0..mobile, by_mobile[0], by_others[0]),
            (mobile..slots, by_others[1], by_mobile[1]),
        ];
        let reach = self.neighborhood.reach(&self.particles);
        let kinds = kinds.into_iter().filter(|(run, ..)| !run.is_empty());
        let part = |(run, alike, across): (Range<usize>, usize, usize)| {
            let (sides, periodic) = self.box_around(run.clone());
            let boxes = RankParts {
                particles: run.len() as f64,
                sides,
                periodic,
                reach: if alike > 0 { reach } else { 0.0 },
                across: across as f64,
                over_boxes: [1.0; 3],
            };
            let over_boxes = self.ghosts_over_boxes(run, &boxes);
            RankParts {
                over_boxes,
                ..boxes
            }
        };
        kinds.map(part).collect()
    }

    /// How many more ghosts lists of parts of the curve name than boxes have, on two, four and eight ranks; on more than there are
    /// chunks, as on fewer.
    fn ghosts_over_boxes(&self, kind: Range<usize>, boxes: &RankParts) -> [f64; 3] {
        let lists = self.neighborhood.lists.chunks();
        let (size, slots) = (chunk_slots::<T>(), self.particles.columns.slots());
        let of_mobile = self.particles.mobile.div_ceil(size).min(lists.len());
        let source = |j: u32| match (j as usize).checked_sub(slots) {
            None => j as usize,
            Some(k) => self.neighborhood.images[k].source as usize,
        };
        let ghosts = |ranks: usize| {
            let mut ghosts = 0;
            for rank in 0..ranks {
                let mut is_named = vec![false; slots];
                let cut = |first: usize, end: usize| {
                    let own = even(end - first, rank, ranks);
                    first + own.start..first + own.end
                };
                let own = [cut(0, of_mobile), cut(of_mobile, lists.len())];
                for list in own.iter().cloned().flat_map(|own| &lists[own]) {
                    list.neighbors
                        .iter()
                        .for_each(|&j| is_named[source(j)] = true);
                }
                for own in own {
                    is_named[(own.start * size).min(slots)..(own.end * size).min(slots)]
                        .fill(false);
                }
                ghosts += is_named[kind.clone()].iter().filter(|own| **own).count();
            }
            ghosts as f64 / ranks as f64
        };
        let mut last = 1.0;
        [2, 4, 8].map(|ranks| {
            if ranks * size <= kind.len() {
                let own = ghosts(ranks) / boxes.ghosts(ranks);
                last = if own.is_finite() { own } else { last };
            }
            last
        })
    }

    /// Sides of the box around some particles, with half a spacing at each face, and whether there are periods along them.
    fn box_around(&self, run: Range<usize>) -> (Vec<f64>, Vec<bool>) {
        let positions = self.particles.columns.vectors(Field::POSITION);
        let at = |slot: usize| Corners::<D>::at(positions[slot].map(Real::to_f64));
        let Corners([low, high]) = over(run, at);
        let spacings = self.particles.bodies.iter().map(|body| body.spacing);
        let spacing = spacings.fold(0.0, f64::max);
        let sides = (0..D).map(|d| high[d] - low[d] + spacing).collect();
        let beyond = |d: usize| {
            let middle: [f64; D] = core::array::from_fn(|k| 0.5 * (low[k] + high[k]));
            let mut x = middle;
            x[d] += high[d] - low[d] + spacing;
            let time = self.neighborhood.placed_time;
            let wraps = |x: &[f64; D]| {
                self.boundaries
                    .iter()
                    .any(|own| own.wrap(x, time).is_some())
            };
            wraps(&x) && !wraps(&middle)
        };
        (sides, (0..D).map(beyond).collect())
    }
}
