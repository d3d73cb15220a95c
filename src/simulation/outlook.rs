//! What a run will do and take before it does it: its first steps are rehearsed, counted and timed, and taken back.
//! List builds, which first steps may not show, follow from speeds and accelerations.

use super::group::Group;
use super::neighborhood::{LASTING, Neighborhood};
use super::population::Particles;
use super::run::check_end;
use super::workspace::Workspace;
use super::{Simulation, Work};
use crate::collective::{largest, over};
use crate::error::Result;
use crate::neighbors::listed_around;
use crate::once::once;
use crate::particles::Field;
use crate::scalar::{Real, width};
use std::time::Duration;

/// Steps that are rehearsed at least. The first half of them fills memory and lets fronts form, and does not count.
const LEAST: u64 = 4;
/// The part of the run that is rehearsed at most, and the pairs after which no further step is begun: half a second or less.
const MOST: (f64, u64) = (0.05, 50_000_000);
/// List builds from which on what was seen of them counts.
const SEEN: u64 = 3;
/// Evaluations that a list serves, below which the next one has the thick skin.
const SHORT: f64 = LASTING[0] as f64;
/// The speed that a liquid or gas is taken to reach, over that of sound, unless it has more.
const MACH: f64 = 0.1;

/// What was at a time of a rehearsal.
struct Mark {
    time: f64,
    work: Work,
    lists: Duration,
}

impl Mark {
    fn of<T: Real, const D: usize>(simulation: &Simulation<T, D>) -> Self {
        Self {
            time: simulation.state.time,
            work: simulation.work(),
            lists: simulation.phases().lists,
        }
    }
}

/// List builds a step, and what they make of lists.
#[derive(Clone, Copy, Debug, Default)]
struct Builds {
    a_step: f64,
    /// Pairs of the lists over those of now.
    longer: f64,
    /// Bytes that they will hold beyond those of now.
    more: usize,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The work of a run from now until `end` \[s\], before it is done: steps, evaluations, list builds, pairs, bytes and
    /// time.
    ///
    /// It rehearses the run: it takes the first steps of it to see what they do and take, and takes them back, so that
    /// nothing of what comes is changed. These are four steps at least, and otherwise a twentieth of the time until the
    /// end or 5·10⁷ pairs, half a second of one thread. Pairs, steps and time of the whole are those of the later half of
    /// the rehearsal; list builds are those seen if three were, and otherwise follow from speeds and accelerations as they
    /// are. The state is held twice meanwhile.
    ///
    /// What the run makes of its scene later is not in it: neighbours of what is compressed, waves that break.
    /// What an integrator or an effect of your own keeps outside of fields is not taken back, and events are not looked at
    /// meanwhile.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut rods = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// let expected = rods.expected_work(2e-6)?;
    /// assert_eq!((rods.steps(), rods.time()), (0, 0.0));
    /// let before = rods.work();
    /// rods.run_until(2e-6)?;
    /// let pairs = (rods.work().pairs - before.pairs) as f64;
    /// assert!((expected.pairs as f64 / pairs - 1.0).abs() < 0.1, "{expected:?} {pairs}");
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`run_until`](Simulation::run_until) if a rehearsed step fails, and [`Error::Argument`](crate::error::Error::Argument) if the end is not finite.
    pub fn expected_work(&mut self, end: f64) -> Result<Work> {
        once!(self => &mut Simulation, |own, end: f64| -> Result<Work> {
            let expected = own.expect_work(end);
            own.agree_on(expected)
        })
    }

    fn expect_work(&mut self, end: f64) -> Result<Work> {
        check_end(end)?;
        self.check_failure()?;
        self.on_last_step(|own| {
            let (bytes, kept) = (own.bytes(), own.keep());
            own.state.watch = None;
            let events = core::mem::take(&mut own.events);
            let rehearsed = own.rehearse(end, bytes);
            *own.state = kept;
            (own.events, own.failed) = (events, None);
            rehearsed
        })
    }

    fn rehearse(&mut self, end: f64, bytes: usize) -> Result<Work> {
        let (begin, mut marks) = (self.state.time, vec![Mark::of(self)]);
        let (to, first) = (begin + MOST.0 * (end - begin), self.work());
        while self.state.time < end {
            let (steps, pairs) = (
                self.state.steps - first.steps,
                self.work().pairs - first.pairs,
            );
            if steps >= LEAST && (self.state.time >= to || pairs >= MOST.1) {
                break;
            }
            self.step_to(end - self.state.time)?;
            marks.push(Mark::of(self));
        }
        // The scene was built with lists.
        let a_build = marks[0].lists.as_secs_f64() / first.list_builds.max(1) as f64;
        let marks = &marks[marks.len() / 2..];
        let (from, last) = (&marks[0], &marks[marks.len() - 1]);
        // Copies of columns have no room to grow beyond what they hold.
        let bytes = bytes.max(last.work.bytes);
        let taken = last.work.steps - from.work.steps;
        if taken == 0 {
            // It is at its end.
            return Ok(Work {
                particles: first.particles,
                bytes,
                ..Work::default()
            });
        }
        let over =
            |count: fn(&Work) -> u64| (count(&last.work) - count(&from.work)) as f64 / taken as f64;
        let step = (last.time - from.time) / taken as f64;
        let evaluations = over(|work| work.evaluations);
        let ahead = |group: &Group<T, D>| {
            let (particles, neighborhood) = (&group.particles, &group.neighborhood);
            let a_step = if group.scheme.density.keeps_neighbors() {
                0.0
            } else {
                // Where particles go apart from what rests, and elsewhere, where any two may go against each other.
                let against = if group.is_open() { 1.0 } else { 2.0 };
                let way = neighborhood.skin / against;
                builds_a_step(particles, &group.work, way, (step, end - begin))
            };
            let spacings = particles.bodies.iter().map(|body| body.spacing);
            let largest = spacings.fold(f64::MIN_POSITIVE, f64::max);
            Builds::ahead(neighborhood, largest, a_step, evaluations)
        };
        let builds: Vec<_> = self.state.groups.iter().map(ahead).collect();
        let seen = last.work.list_builds - from.work.list_builds;
        let a_step = if seen >= SEEN {
            seen as f64 / taken as f64
        } else {
            builds.iter().map(|own| own.a_step).sum()
        };
        let spent = Spent::of(marks, a_build);
        let entries = |group: &Group<T, D>| group.neighborhood.lists.entries() as f64;
        let of_groups = |longer: &dyn Fn(usize) -> f64| -> f64 {
            let groups = self.state.groups.iter().enumerate();
            groups.map(|(k, group)| entries(group) * longer(k)).sum()
        };
        let longer = of_groups(&|k| builds[k].longer) / of_groups(&|_| 1.0).max(1.0);
        let steps = (end - begin) / step;
        let count = |own: f64| (steps * own).round() as u64;
        let seconds = steps * (spent.a_step + a_step * spent.a_build);
        Ok(Work {
            particles: last.work.particles,
            steps: steps.round() as u64,
            evaluations: count(evaluations),
            list_builds: count(a_step),
            pairs: count(over(|work| work.pairs) * longer),
            bytes: bytes + builds.iter().map(|own| own.more).sum::<usize>(),
            time: Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX),
        })
    }
}

/// Time \[s\] of a step without list builds, and of a build.
#[derive(Clone, Copy, Debug)]
struct Spent {
    a_step: f64,
    a_build: f64,
}

impl Spent {
    /// Means over steps. A build is taken to cost what one did before if none is seen.
    fn of(marks: &[Mark], a_build: f64) -> Self {
        let (mut without, mut looks, mut building) = (0.0, 0.0, 0.0);
        let (mut unbuilt, mut builds) = (0, 0);
        for two in marks.windows(2) {
            let lists = two[1].lists.saturating_sub(two[0].lists).as_secs_f64();
            let time = two[1].work.time.saturating_sub(two[0].work.time);
            without += (time.as_secs_f64() - lists).max(0.0);
            let built = two[1].work.list_builds - two[0].work.list_builds;
            if built > 0 {
                (building, builds) = (building + lists, builds + built);
            } else {
                (looks, unbuilt) = (looks + lists, unbuilt + 1);
            }
        }
        let over = |sum: f64, count: u64| (count > 0).then(|| sum / count as f64);
        let steps = marks.len().saturating_sub(1) as u64;
        Self {
            a_step: over(without, steps).unwrap_or(0.0) + over(looks, unbuilt).unwrap_or(0.0),
            a_build: over(building, builds).unwrap_or(a_build),
        }
    }
}

impl Builds {
    /// In steps with so many evaluations, of which so many build lists as these are, with bodies of `spacing` \[m\].
    fn ahead<T: Real, const D: usize>(
        neighborhood: &Neighborhood<T, D>,
        spacing: f64,
        a_step: f64,
        evaluations: f64,
    ) -> Self {
        let mut builds = Self {
            a_step,
            longer: 1.0,
            more: 0,
        };
        // Lists that last for few evaluations get the thick skin, which lasts longer.
        let [thin, thick] = neighborhood.skins;
        let is_thin = neighborhood.skin < thick;
        if is_thin && builds.a_step * SHORT > evaluations.max(1.0) {
            let reach = neighborhood.support * neighborhood.smoothing_length;
            let listed = |skin: f64| listed_around(D, (reach + skin) / spacing, width::<T>());
            builds.a_step *= thin / thick;
            builds.longer = listed(thick) / listed(thin);
            let bytes = neighborhood.lists.bytes() as f64;
            builds.more = ((builds.longer - 1.0).max(0.0) * bytes) as usize;
        }
        builds
    }
}

/// List builds a step of `step` \[s\], when the fastest particle speeds up as all do in the mean now for `time` \[s\], up to a
/// tenth of its sound, and may go as far as `way` \[m\].
fn builds_a_step<T: Real, const D: usize>(
    particles: &Particles<T, D>,
    work: &Workspace<T, D>,
    way: f64,
    (step, time): (f64, f64),
) -> f64 {
    let columns = &particles.columns;
    let (v, c) = (
        columns.vectors(Field::VELOCITY),
        columns.raw(Field::SOUND_SPEED),
    );
    let mass = columns.raw(Field::MASS);
    let length = |vector: &[T; D]| {
        let square = vector.iter().map(|own| own.to_f64().powi(2));
        square.sum::<f64>().sqrt()
    };
    let all = 0..particles.mobile;
    let speed = largest(all.clone(), |slot| length(&v[slot]));
    let sound = largest(all.clone(), |slot| c[slot].to_f64());
    // The mean, for what a free face begins with does not last.
    let acceleration = over(all, |slot| {
        length(&core::array::from_fn(|d| {
            work.acceleration(mass, slot * D + d)
        }))
    }) / particles.mobile.max(1) as f64;
    let most = speed.max(MACH * sound);
    // The mean of a speed that grows from the one and stays at the other.
    let until = ((most - speed) / acceleration.max(f64::MIN_POSITIVE)).min(time);
    let reached = (speed + acceleration * until).min(most);
    let mean = reached - 0.5 * (reached - speed) * until / time.max(f64::MIN_POSITIVE);
    (mean * step / way).min(1.0)
}
