//! The price of a run by effect: time of sweeps and laws, bytes of a particle, messages of ranks, and what set the steps.
//! Two looks at the clock for each sweep and for each law of a chunk.

use super::Simulation;
use crate::effect::MOST_LAWS;
use crate::scalar::Real;
use crate::term::Stage;
use core::fmt;
use std::time::Duration;

/// Time of the sweeps and laws of a group, by stage.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spent {
    pub sweeps: [Duration; Stage::COUNT],
    /// Time of each law, summed over threads.
    pub laws: [[Duration; MOST_LAWS]; Stage::COUNT],
    /// Pairs of all sweeps, those that the lists hold beyond the support among them.
    pub pairs: u64,
}

impl Spent {
    /// Takes the times of another, and keeps its own pairs.
    pub fn keep_times_of(&mut self, other: &Self) {
        let pairs = self.pairs;
        *self = Self { pairs, ..*other };
    }
}

/// What one sweep or law has cost.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CostLine {
    /// The stage that it belongs to.
    pub stage: &'static str,
    /// The terms of the sweep, or the law.
    pub what: String,
    /// Its time; of a law the sum over threads.
    pub time: Duration,
    /// Its share of the time of all steps.
    pub share: f64,
}

/// The cost of a run so far, by effect.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Cost {
    /// Sweeps and laws, in the order of a step; then neighbour lists, materials, the work of compatible energy, and
    /// integration.
    pub lines: Vec<CostLine>,
    /// Bytes a particle: the columns of each field, then lists, records and sums.
    pub bytes: Vec<(String, f64)>,
    /// Steps by the criterion that set them.
    pub steps: Vec<(&'static str, u64)>,
    /// Messages of this rank, on [ranks](crate::ranks). What they would be on other numbers of ranks,
    /// [`rank_model`](Simulation::rank_model) predicts.
    pub messages: Option<Messages>,
}

/// What a rank and the others said to each other, in the mean of all steps.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::ranks;
/// let all = ranks::in_threads(2, 1, |ranks| -> Result<_, Error> {
///     let mut rod = Scene::<f64, 1>::new(schemes::impact())
///         .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 5e-6).velocity([20.0]))
///         .on_ranks(ranks)
///         .build()?;
///     rod.run_until(1e-8)?;
///     Ok(rod.cost())
/// })?;
/// for cost in all {
///     let messages = cost?.messages.expect("ranks");
///     assert_eq!(messages.ranks, 2);
///     assert!(messages.gathered > 1.0 && messages.received > 0.0);
/// }
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Messages {
    /// The ranks.
    pub ranks: usize,
    /// Gatherings of all ranks in a step.
    pub gathered: f64,
    /// Exchanges with ranks near by in a step.
    pub exchanged: f64,
    /// Bytes that the rank gave in a step.
    pub sent: f64,
    /// Bytes that it got in a step.
    pub received: f64,
    /// Time of sending, receiving and waiting for others in all steps.
    pub waited: Duration,
    /// Its share of the time of all steps.
    pub share: f64,
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "time")?;
        for line in &self.lines {
            let CostLine {
                stage, what, share, ..
            } = line;
            writeln!(f, "  {:5.1} %  {stage:<11} {what}", 100.0 * share)?;
        }
        writeln!(f, "bytes a particle")?;
        for (what, bytes) in &self.bytes {
            writeln!(f, "  {bytes:7.1}  {what}")?;
        }
        writeln!(f, "steps set by")?;
        for (criterion, steps) in &self.steps {
            writeln!(f, "  {steps:7}  {criterion}")?;
        }
        if let Some(own) = &self.messages {
            writeln!(f, "messages a step, on {} ranks", own.ranks)?;
            writeln!(f, "  {:7.1}  gatherings", own.gathered)?;
            writeln!(f, "  {:7.1}  exchanges", own.exchanged)?;
            writeln!(f, "  {:7.0}  bytes sent", own.sent)?;
            writeln!(f, "  {:7.0}  bytes received", own.received)?;
            writeln!(
                f,
                "  {:5.1} %  of the time: messages and waiting",
                100.0 * own.share
            )?;
        }
        Ok(())
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// What the run has cost so far, by effect: print it.
    ///
    /// The terms of a stage share one loop, so a sweep is one line that names them all.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let mut simulation = Scene::<f64, 1>::new(schemes::impact())
    ///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
    ///     .build()?;
    /// simulation.run_until(1e-7)?;
    /// let cost = simulation.cost();
    /// assert!(cost.to_string().contains("corrected gradients"));
    /// assert_eq!(cost.steps.iter().map(|(_, steps)| steps).sum::<u64>(), simulation.steps());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn cost(&self) -> Cost {
        let phases = self.phases();
        let total = phases.total().as_secs_f64().max(f64::MIN_POSITIVE);
        let mut lines = Vec::new();
        let mut add = |stage, what: String, time: Duration| {
            if time > Duration::ZERO {
                let share = time.as_secs_f64() / total;
                lines.push(CostLine {
                    stage,
                    what,
                    time,
                    share,
                });
            }
        };
        let mut bytes = Vec::new();
        for group in &self.state.groups {
            let (spent, scheme) = (&group.work.spent, &group.scheme);
            for stage in Stage::ALL {
                if let Some(sweep) = scheme.sweep(stage) {
                    let terms = sweep.document().into_iter().map(|term| term.name);
                    let terms: Vec<_> = terms.filter(|name| !name.is_empty()).collect();
                    add(
                        stage.name(),
                        format!("pairs: {}", terms.join(", ")),
                        spent.sweeps[stage.number()],
                    );
                }
                for (k, law) in scheme.program.laws[stage.number()].iter().enumerate() {
                    add(
                        stage.name(),
                        law.name().into(),
                        spent.laws[stage.number()][k],
                    );
                }
            }
            let particles = group.particles.count().max(1) as f64;
            let columns = &group.particles.columns;
            for field in columns.fields().iter() {
                let name = scheme.program.name_of(field);
                let own = field.components(D) * size_of::<T>();
                bytes.push((format!("{} of {}", name, scheme.name()), own as f64));
            }
            let all = |what: &str, of: usize| {
                (
                    format!("{what} of {}", scheme.name()),
                    of as f64 / particles,
                )
            };
            bytes.push(all("neighbour lists", group.neighborhood.bytes()));
            bytes.push(all("records and sums", group.work.bytes()));
        }
        add("lists", "neighbour lists and images".into(), phases.lists);
        add(
            "state",
            "equations of state and coefficients".into(),
            phases.materials,
        );
        add(
            "kicks",
            "work of pair forces (compatible energy)".into(),
            phases.work,
        );
        add(
            "integration",
            "kicks, drifts, votes on the step".into(),
            phases.integration,
        );
        Cost {
            lines,
            bytes,
            steps: self.after_step().votes.clone(),
            messages: self.messages(total),
        }
    }

    /// Messages of this rank over steps that took so long \[s\].
    fn messages(&self, total: f64) -> Option<Messages> {
        let (_, ranks) = self.rank()?;
        let own = self.traffic()?;
        let steps = self.steps().max(1) as f64;
        Some(Messages {
            ranks,
            gathered: own.gathered as f64 / steps,
            exchanged: own.exchanged as f64 / steps,
            sent: own.sent as f64 / steps,
            received: own.received as f64 / steps,
            waited: own.waited,
            share: own.waited.as_secs_f64() / total,
        })
    }
}
