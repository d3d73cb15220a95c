//! What a run will do, in counts, before it does it: steps, pairs, list builds and bytes, from the scene as it is.
//! One evaluation gives neighbours and the step; the integrator says how often a step asks for what.

use super::group::Group;
use super::{Phases, Simulation, Work, width};
use crate::clock::Instant;
use crate::error::{Error, Problem, Result};
use crate::integrator::System;
use crate::neighbors::listed_around;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::scheme::EnergyForm;
use crate::term::Stage;
use std::time::Duration;

/// Evaluations that a list serves, below which the next one has the thick skin.
const SHORT: f64 = 8.0;
/// The speed that a liquid or gas is taken to reach, over that of sound, unless it has more.
const MACH: f64 = 0.1;
/// Sums of density an evaluation where they are repeated until lengths follow: those of a blast, by their time.
const REPEATED: f64 = 2.5;
/// Least time over which an evaluation is timed.
const TIMED: Duration = Duration::from_millis(50);
/// Most evaluations for that.
const TIMES: u32 = 100;

/// A system that counts what an integrator asks of it.
#[derive(Debug, Default)]
struct Counter {
    evaluations: u32,
    kicks: u32,
    drifts: u32,
    combined: u32,
}

impl System for Counter {
    fn evaluate(&mut self, _: f64) -> Result<()> {
        self.evaluations += 1;
        Ok(())
    }
    fn kick(&mut self, _: f64) {
        self.kicks += 1;
    }
    fn drift(&mut self, _: f64, _: f64) -> Result<()> {
        self.drifts += 1;
        Ok(())
    }
    fn shift(&mut self, _: f64, _: f64) {}
    fn predict(&mut self, _: f64) {}
    fn restore(&mut self) {}
    fn save(&mut self, _: usize) {}
    fn load(&mut self, _: usize) {}
    fn combine(&mut self, _: usize, _: f64, _: f64, _: f64) {
        self.combined += 1;
    }
    fn accumulate(&mut self, _: usize, _: f64) {
        self.combined += 1;
    }
    fn has_rates(&self) -> bool {
        true
    }
}

/// What a step will do, and what an evaluation of the present state took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outlook {
    /// The step \[s\].
    pub step: f64,
    pub particles: usize,
    /// Evaluations a step.
    pub evaluations: f64,
    /// Pairs of an evaluation, and those that a step sums beside its evaluations.
    pub pairs: f64,
    pub beside: f64,
    /// List builds a step.
    pub builds: f64,
    pub bytes: usize,
    /// Time \[s\] of an evaluation, of its sweeps, of a look at the age of lists, and of a list build.
    pub evaluation: f64,
    pub sweeps: f64,
    pub check: f64,
    pub build: f64,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The work of a run from now until `end` \[s\], before it is done: steps by the criteria as they are, pairs by the
    /// neighbours as they are, list builds by the speeds and accelerations as they are. Its time is zero: a
    /// [cost model](crate::study::cost_model) knows that.
    ///
    /// It evaluates the rates once, which changes nothing of what comes. What the run makes of its scene is not in it:
    /// steps of a front that sharpens, neighbours of what is compressed; groups that sub-cycle count as often as their own
    /// steps fit into those of the others now.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut rods = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .boundary(MirrorPlane::wall([0.01], [1.0]))
    ///     .build()?;
    /// let expected = rods.expected_work(2e-6)?;
    /// let before = rods.work();
    /// rods.run_until(2e-6)?;
    /// let pairs = (rods.work().pairs - before.pairs) as f64;
    /// assert!((expected.pairs as f64 / pairs - 1.0).abs() < 0.1, "{expected:?} {pairs}");
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`evaluate`](Simulation::evaluate), and [`Error::Argument`] if the end is not finite.
    pub fn expected_work(&mut self, end: f64) -> Result<Work> {
        let outlook = self.outlook(end, Duration::ZERO)?;
        let steps = ((end - self.time) / outlook.step).max(0.0);
        Ok(Work {
            particles: outlook.particles,
            steps: steps.round() as u64,
            evaluations: (steps * outlook.evaluations).round() as u64,
            list_builds: (steps * outlook.builds).round() as u64,
            pairs: (steps * (outlook.evaluations * outlook.pairs + outlook.beside)).round() as u64,
            bytes: outlook.bytes,
            time: Duration::ZERO,
        })
    }

    /// What a step will do on the way to `end` \[s\], and, if evaluations may be repeated for `timing`, what they take.
    pub(crate) fn outlook(&mut self, end: f64, timing: Duration) -> Result<Outlook> {
        if !end.is_finite() {
            return Err(Error::Argument(Problem::Parameter {
                what: "end of the run".into(),
                value: end,
                must_be: "must be a finite time in seconds",
            }));
        }
        let before = (self.pairs_by_group(), self.phases());
        if self.steps == 0 {
            // The state is the one to step from, so nothing has to be set aside.
            self.check_failure()?;
            System::evaluate(self, 0.0)?;
        } else {
            self.evaluate()?;
        }
        let first = self.phases().since(&before.1);
        let mut pairs = self.pairs_by_group();
        for (now, before) in pairs.iter_mut().zip(&before.0) {
            *now -= before;
        }
        // Once more, with lists and memory in place. Before the first step each evaluation gives the same, and later the next
        // step takes back what was set aside.
        let mut timed = first;
        let mut check = 0.0;
        if timing > Duration::ZERO {
            let kept: Vec<_> = (self.groups.iter())
                .map(|group| (group.guards, group.limited.clone()))
                .collect();
            let (begin, from, evaluations) = (Instant::now(), self.phases(), self.evaluations);
            let summed = self.pairs_by_group();
            let mut times = 0;
            while times < TIMES && (times == 0 || begin.elapsed() < timing.min(TIMED)) {
                System::evaluate(self, 0.0)?;
                times += 1;
            }
            timed = self.phases().since(&from).over(times);
            check = timed.lists.as_secs_f64();
            // Densities that were found by repeated sums are found sooner from where they are.
            for ((own, now), before) in pairs.iter_mut().zip(self.pairs_by_group()).zip(summed) {
                let again = (now - before) / u64::from(times);
                *own = if again > 0 { again } else { *own };
            }
            self.evaluations = evaluations;
            for (group, (guards, limited)) in self.groups.iter_mut().zip(kept) {
                (group.guards, group.limited) = (guards, limited);
            }
        }
        let vote = self.vote()?;
        let step = self.control.fixed.unwrap_or(vote.step).min(end - self.time);
        let step = step.max(f64::MIN_POSITIVE);
        let mut asked = Counter::default();
        let integrator = self.integrator.clone();
        integrator.step(&mut asked, step)?;
        let mut outlook = Outlook {
            step,
            particles: self.particles(),
            evaluations: f64::from(asked.evaluations),
            evaluation: timed.evaluation().as_secs_f64(),
            sweeps: timed.pairs.as_secs_f64(),
            check,
            build: self.time_of_a_build(&before.1, check),
            ..Outlook::default()
        };
        let serves = outlook.evaluations.max(1.0);
        for (k, own) in pairs.into_iter().enumerate() {
            let group = &self.groups[k];
            // Steps of a group in one of the others.
            let often = if group.sub_cycle.is_some() {
                let own = self.vote_of(k, self.control.courant)?.step;
                (step / own).ceil().clamp(1.0, group.steps_at_most())
            } else {
                1.0
            };
            let a_sweep = group.pairs_of(group.input().targets) as f64;
            let kicks = f64::from(u8::from(group.scheme.energy == EnergyForm::Compatible));
            let drifts = f64::from(u8::from(group.scheme.sums_in_drift()));
            // Kicks with the same forces share one sum of their work.
            let worked = asked.kicks.min(asked.evaluations.max(1));
            let beside = kicks * f64::from(worked) + drifts * f64::from(asked.drifts);
            let builds = group.builds_a_step(step, end - self.time);
            // Lists that last for few evaluations get the thick skin, which lasts longer.
            let [thin, thick] = group.neighborhood.skins;
            let (builds, more) = if builds * SHORT > serves && thick > thin {
                let reach = group.scheme.kernel.support * group.smoothing_length;
                let listed = |skin: f64| {
                    let reach = (reach + skin) / group.spacing();
                    listed_around(D, reach, width::<T>())
                };
                (builds * thin / thick, listed(thick) / listed(thin))
            } else {
                (builds, 1.0)
            };
            let laws = &group.scheme.program.laws[Stage::Density.number()];
            let repeated = laws.iter().any(|law| law.repeats().is_some());
            // On a lattice once is enough.
            let repeats = if repeated { REPEATED - 1.0 } else { 0.0 };
            // A group that sub-cycles has its rates at hand, of one sweep at least.
            let own = (own as f64).max(a_sweep);
            outlook.pairs += often * (own + repeats * a_sweep) * more;
            outlook.beside += often * beside * a_sweep * more;
            outlook.builds += builds;
            outlook.bytes += group.bytes_in_run(more);
        }
        Ok(outlook)
    }

    /// Time \[s\] of a list build, by those so far: the scene was built with the first. A look at the age of lists takes `check`.
    fn time_of_a_build(&self, so_far: &Phases, check: f64) -> f64 {
        let looks = self.evaluations as f64 * check;
        let lists = so_far.lists.as_secs_f64() - looks;
        lists.max(0.0) / self.list_builds().max(1) as f64
    }

    fn pairs_by_group(&self) -> Vec<u64> {
        let groups = self.groups.iter();
        groups.map(|group| group.work.spent.pairs).collect()
    }
}

impl<T: Real, const D: usize> Group<T, D> {
    /// The largest spacing of its bodies \[m\].
    fn spacing(&self) -> f64 {
        let bodies = self.particles.bodies.iter();
        bodies.fold(f64::MIN_POSITIVE, |most, body| most.max(body.spacing))
    }

    /// List builds a step, when the fastest particle speeds up as all do in the mean now for `time` \[s\], up to a tenth of its sound.
    fn builds_a_step(&self, step: f64, time: f64) -> f64 {
        if self.scheme.density.keeps_neighbors() {
            return 0.0;
        }
        let columns = &self.particles.columns;
        let (v, c) = (
            columns.vectors(Field::VELOCITY),
            columns.raw(Field::SOUND_SPEED),
        );
        let mass = columns.raw(Field::MASS);
        let length = |vector: &[T; D]| {
            let square = vector.iter().map(|own| own.to_f64().powi(2));
            square.sum::<f64>().sqrt()
        };
        let (mut speed, mut acceleration, mut sound) = (0.0_f64, 0.0_f64, 0.0_f64);
        for slot in 0..self.particles.mobile {
            let force = self.work.rates.vector(Output::FORCE, slot);
            let a: [T; D] =
                core::array::from_fn(|d| force[d] / mass[slot] + self.evaluated_gravity[d]);
            speed = speed.max(length(&v[slot]));
            acceleration += length(&a);
            sound = sound.max(c[slot].to_f64());
        }
        // The mean, for what a free face begins with does not last.
        acceleration /= self.particles.mobile.max(1) as f64;
        let most = speed.max(MACH * sound);
        // The mean of a speed that grows from the one and stays at the other.
        let until = ((most - speed) / acceleration.max(f64::MIN_POSITIVE)).min(time);
        let reached = (speed + acceleration * until).min(most);
        let mean = reached - 0.5 * (reached - speed) * until / time.max(f64::MIN_POSITIVE);
        (2.0 * mean * step / self.neighborhood.skin).min(1.0)
    }

    /// Bytes that it will hold once it has stepped, when lists grow by a factor.
    fn bytes_in_run(&self, lists: f64) -> usize {
        let number = size_of::<T>();
        let slots = self.particles.columns.slots();
        // Sums of the drift and of kicks, which the first step makes.
        let sweep = |stage| {
            let outputs = self.scheme.sweep(stage).map(|sweep| sweep.outputs());
            outputs.map_or(0, |outputs| outputs.width(D))
        };
        let mut width = sweep(Stage::Continuity);
        if self.scheme.energy == EnergyForm::Compatible {
            width = width.max(sweep(Stage::Rates));
        }
        let (now, wanted) = (self.work.sums.bytes(), width * slots * number);
        let sums = wanted.saturating_sub(now);
        let more = (lists - 1.0) * self.neighborhood.lists.bytes() as f64;
        self.bytes() + sums + more.max(0.0) as usize
    }
}

impl Phases {
    /// A share of all phases.
    fn over(&self, times: u32) -> Self {
        let of = |own: Duration| own / times.max(1);
        Self {
            lists: of(self.lists),
            packing: of(self.packing),
            pairs: of(self.pairs),
            walls: of(self.walls),
            materials: of(self.materials),
            integration: of(self.integration),
        }
    }
}
