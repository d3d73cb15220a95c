//! The cost of a step on any number of ranks, predicted from what a scene gives, computes and gathers, and from a network.
//! Ghosts follow from the surface of a rank's part; gatherings are those that the crate makes.

mod parts;
#[cfg(test)]
mod tests;

pub use parts::RankParts;

use crate::error::{Error, Problem, Result};
use core::fmt;

/// A network by two numbers: a message of b bytes takes the time λ + b/β, with the latency λ and the bandwidth β.
///
/// A gathering of all ranks takes λ log₂ P + b/β with the bytes b that a rank receives, which is what recursive doubling takes (Thakur,
/// Rabenseifner & Gropp 2005, International Journal of High Performance Computing Applications 19, 49–66).
///
/// ```
/// use meshfree::ranks::Network;
/// let ethernet = Network { latency: 2e-5, bandwidth: 1.2e9 };
/// assert!(ethernet.latency > Network::default().latency);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Network {
    /// Time λ of an empty message \[s\]: 2 µs by default, as MPI has it between two machines (1.93 µs in Squyres 2014, "MPI over 40Gb
    /// Ethernet", Cisco).
    pub latency: f64,
    /// Bytes a second β that one rank receives: 10 GB/s by default, 80 % of the 100 Gbit/s of InfiniBand EDR.
    pub bandwidth: f64,
}

impl Default for Network {
    fn default() -> Self {
        Self {
            latency: 2e-6,
            bandwidth: 1e10,
        }
    }
}

/// What one kind of step gives and computes, of all particles of the scene.
///
/// On P ranks, with g ghosts of a rank, a rank receives `each` (P − 1) + `parts` (1 − 1/P) + `to_each` P + `of_ghost` g bytes.
///
/// ```
/// use meshfree::ranks::RankPrice;
/// let price = RankPrice { gathered: 20.0, each: 400.0, divided: 0.7, ..RankPrice::default() };
/// assert_eq!(price.parts, 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RankPrice {
    /// Gatherings of all ranks.
    pub gathered: f64,
    /// Exchanges with ranks near by.
    pub exchanged: f64,
    /// Bytes that each rank gives to gatherings whatever it has: headers, votes, joined numbers.
    pub each: f64,
    /// Bytes of gatherings to which each rank gives a part: sums, lists, particles.
    pub parts: f64,
    /// Bytes of a letter to each rank.
    pub to_each: f64,
    /// Bytes that travel for one ghost.
    pub of_ghost: f64,
    /// Time \[s\] of what ranks divide among them, on one rank.
    pub divided: f64,
    /// Time \[s\] of what every rank does for all particles.
    pub undivided: f64,
}

impl RankPrice {
    fn numbers(&self) -> [(&'static str, f64); 8] {
        [
            ("gatherings of a step", self.gathered),
            ("exchanges of a step", self.exchanged),
            ("bytes of each rank", self.each),
            ("bytes of parts", self.parts),
            ("bytes to each rank", self.to_each),
            ("bytes of a ghost", self.of_ghost),
            ("divided time of a step [s]", self.divided),
            ("undivided time of a step [s]", self.undivided),
        ]
    }

    /// So many times all of it.
    pub(crate) fn times(self, by: f64) -> Self {
        Self {
            gathered: self.gathered * by,
            exchanged: self.exchanged * by,
            each: self.each * by,
            to_each: self.to_each * by,
            of_ghost: self.of_ghost * by,
            ..self.of_more(by)
        }
    }

    /// Of a scene that is larger in all directions, with so many times the particles.
    fn of_more(self, times: f64) -> Self {
        Self {
            parts: self.parts * times,
            divided: self.divided * times,
            undivided: self.undivided * times,
            ..self
        }
    }
}

/// What a step of a scene gives and takes, from which its cost on any number of ranks follows.
///
/// [`Simulation::rank_model`](crate::simulation::Simulation::rank_model) makes it of a scene. A step on P ranks takes
///
/// ```text
/// t(P) = d s + u + G λ log₂ P + E λ + b/β,   s = ⌈C/P⌉/C
/// ```
///
/// with the divided and undivided times d and u \[s\], G gatherings, E exchanges, b bytes that a rank receives, latency λ \[s\],
/// bandwidth β \[bytes/s\] and C chunks of particles, of which a rank has whole ones. All are means over steps with and without list
/// builds.
///
/// ```
/// use meshfree::ranks::{Network, RankModel, RankParts, RankPrice};
/// // A million particles of water in space, on one core: 0.67 s a step, 300 bytes a particle.
/// let water = RankModel {
///     particles: 1e6,
///     chunk: 512.0,
///     bytes: 3e8,
///     parts: vec![RankParts {
///         particles: 1e6,
///         sides: vec![1.0; 3],
///         periodic: vec![false; 3],
///         reach: 0.03,
///         across: 0.0,
///         over_boxes: [1.0; 3],
///     }],
///     own_alone: true,
///     step: RankPrice { gathered: 25.0, exchanged: 2.0, each: 500.0, of_ghost: 160.0, divided: 0.67, ..RankPrice::default() },
///     list_build: RankPrice { gathered: 45.0, exchanged: 7.0, each: 1e3, parts: 8e3, of_ghost: 180.0, divided: 1.0, ..RankPrice::default() },
///     sort: RankPrice { gathered: 10.0, exchanged: 6.0, to_each: 2e3, divided: 0.1, ..RankPrice::default() },
///     gather_all: RankPrice { gathered: 2.0, each: 16.0, parts: 3e8, ..RankPrice::default() },
///     list_builds: 0.04,
///     sorts: 0.3,
///     gathers_of_all: 0.0,
/// };
/// let [one, many] = [1, 64].map(|ranks| water.on(ranks, &Network::default()));
/// let (one, many) = (one?, many?);
/// assert!(one.step / many.step > 20.0 && one.step / many.step < 64.0);
/// assert!(many.memory < 0.1 * one.memory);
/// # Ok::<(), meshfree::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RankModel {
    /// Particles of bodies and walls, with those that fill rows of lanes.
    pub particles: f64,
    /// Particles of a chunk, which no two ranks share.
    pub chunk: f64,
    /// Bytes of particles, lists and records.
    pub bytes: f64,
    /// What is cut among ranks.
    pub parts: Vec<RankParts>,
    /// Whether ranks step their own particles alone between list builds.
    pub own_alone: bool,
    /// A step without a list build.
    pub step: RankPrice,
    /// A step with a list build that does not sort particles.
    pub list_build: RankPrice,
    /// What sorting particles along the space-filling curve adds to it.
    pub sort: RankPrice,
    /// Bringing all particles together, as at the end of a run and where an observer is due.
    pub gather_all: RankPrice,
    /// List builds a step, at most one.
    pub list_builds: f64,
    /// Sorts a list build, at most one.
    pub sorts: f64,
    /// How often a step all particles are brought together beside list builds.
    pub gathers_of_all: f64,
}

/// A line of the cost of a step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RankCostLine {
    /// What it is.
    pub what: &'static str,
    /// Bytes that a rank receives for it in a step.
    pub received: f64,
    /// Its time in a step \[s\].
    pub seconds: f64,
}

/// The predicted cost of a step on ranks, as a mean over steps with and without list builds.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RankCost {
    /// The ranks.
    pub ranks: usize,
    /// Ghosts of a rank, none where ranks do not step their own particles alone.
    pub ghosts: f64,
    /// Gatherings of all ranks in a step.
    pub gathered: f64,
    /// Exchanges in a step.
    pub exchanged: f64,
    /// Bytes that a rank receives in a step.
    pub received: f64,
    /// Where the time goes: work, and messages by what they hold.
    pub lines: Vec<RankCostLine>,
    /// The time of a step \[s\].
    pub step: f64,
    /// Bytes that a rank holds, without its ghosts: the places of all particles as the scene has them, and the columns, lists and records of
    /// its own particles, or of all particles where ranks do not step their own alone. A reading adds the columns of all particles.
    pub memory: f64,
}

impl RankCost {
    /// The line that takes most time: what limits the scene on so many ranks.
    #[must_use]
    pub fn largest(&self) -> Option<&RankCostLine> {
        let by_time = |a: &&RankCostLine, b: &&RankCostLine| a.seconds.total_cmp(&b.seconds);
        self.lines.iter().max_by(by_time)
    }
}

impl fmt::Display for RankCost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} ranks: {:.3e} s a step, {:.3e} bytes held by a rank",
            self.ranks, self.step, self.memory
        )?;
        writeln!(
            f,
            "  a step has {:.1} gatherings and {:.1} exchanges; a rank has {:.0} ghosts",
            self.gathered, self.exchanged, self.ghosts
        )?;
        for line in &self.lines {
            let RankCostLine {
                what,
                received,
                seconds,
            } = line;
            let share = 100.0 * seconds / self.step.max(f64::MIN_POSITIVE);
            writeln!(f, "  {share:5.1} %  {received:10.3e} bytes  {what}")?;
        }
        Ok(())
    }
}

impl RankModel {
    /// The same scene with so many particles at the same spacing: larger in all directions.
    ///
    /// # Errors
    /// [`Error::Argument`] if the number is not positive and finite.
    pub fn of_particles(&self, particles: f64) -> Result<Self> {
        if !(particles.is_finite() && particles > 0.0) {
            return Err(refused(
                "number of particles of a rank model",
                particles,
                "must be positive and finite",
            ));
        }
        let times = particles / self.particles;
        let own = self.clone();
        Ok(Self {
            particles,
            bytes: own.bytes * times,
            parts: own
                .parts
                .into_iter()
                .map(|own| own.of_more(times))
                .collect(),
            step: own.step.of_more(times),
            list_build: own.list_build.of_more(times),
            sort: own.sort.of_more(times),
            gather_all: own.gather_all.of_more(times),
            ..own
        })
    }

    /// The cost of a step on so many ranks.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no rank, if the latency is negative or the bandwidth not positive, or if a number of the model
    /// is negative or not finite.
    pub fn on(&self, ranks: usize, network: &Network) -> Result<RankCost> {
        self.check(ranks, network)?;
        let count = ranks as f64;
        let builds = self.list_builds;
        let weighed = [
            (1.0 - builds, &self.step),
            (builds, &self.list_build),
            (builds * self.sorts, &self.sort),
            (self.gathers_of_all, &self.gather_all),
        ];
        let mean = |of: fn(&RankPrice) -> f64| -> f64 {
            weighed.iter().map(|(weight, own)| weight * of(own)).sum()
        };
        let (gathered, exchanged) = (mean(|own| own.gathered), mean(|own| own.exchanged));
        let chunks = (self.particles / self.chunk).ceil().max(1.0);
        let share = (chunks / count).ceil() / chunks;
        let divided = share * mean(|own| own.divided);
        let undivided = mean(|own| own.undivided);
        let of_all = self.parts.iter().map(|parts| parts.ghosts(ranks));
        // Where every rank has all particles there are none.
        let ghosts = of_all.filter(|_| self.own_alone).fold(0.0, |a, b| a + b);
        let others = 1.0 - 1.0 / count;
        let votes = (count - 1.0) * mean(|own| own.each) + count * mean(|own| own.to_each);
        let of_ghosts = ghosts * mean(|own| own.of_ghost);
        let sums = (1.0 - builds) * others * self.step.parts;
        let listing = self.list_build.parts + self.sorts * self.sort.parts;
        let listing = builds * others * listing;
        let looking = self.gathers_of_all * others * self.gather_all.parts;
        // One rank waits for nobody.
        let waits = if ranks > 1 { network.latency } else { 0.0 };
        let travel = |bytes: f64| bytes / network.bandwidth;
        let line = |what, received, seconds| RankCostLine {
            what,
            received,
            seconds,
        };
        let lines = vec![
            line("work that ranks divide", 0.0, divided),
            line("work that every rank does", 0.0, undivided),
            line("ghosts", of_ghosts, exchanged * waits + travel(of_ghosts)),
            line(
                "gatherings: waiting, headers, votes",
                votes,
                gathered * waits * count.log2() + travel(votes),
            ),
            line("sums of all particles", sums, travel(sums)),
            line("list builds: what chunks cost", listing, travel(listing)),
            line(
                "all particles, for what is looked at",
                looking,
                travel(looking),
            ),
        ];
        let directions = self.parts.first().map_or(0, |parts| parts.sides.len());
        let places = (directions * size_of::<f64>()) as f64 * self.particles;
        let own = if self.own_alone { count } else { 1.0 };
        Ok(RankCost {
            ranks,
            ghosts,
            gathered,
            exchanged,
            received: lines.iter().map(|line| line.received).sum(),
            step: lines.iter().map(|line| line.seconds).sum(),
            lines,
            memory: places + self.bytes / own,
        })
    }

    fn check(&self, ranks: usize, network: &Network) -> Result<()> {
        if ranks == 0 {
            return Err(refused("number of ranks", 0.0, "must be one or more"));
        }
        let Network { latency, bandwidth } = *network;
        if !(latency.is_finite() && latency >= 0.0) {
            let must_be = "must be zero or positive, in seconds";
            return Err(refused("latency of the network", latency, must_be));
        }
        if !(bandwidth.is_finite() && bandwidth > 0.0) {
            let must_be = "must be positive, in bytes a second";
            return Err(refused("bandwidth of the network", bandwidth, must_be));
        }
        for (what, value) in [
            ("particles of the model", self.particles),
            ("chunk", self.chunk),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(refused(what, value, "must be positive and finite"));
            }
        }
        for (what, value, must_be) in [
            (
                "list builds",
                self.list_builds,
                "must be between zero and one a step",
            ),
            (
                "sorts",
                self.sorts,
                "must be between zero and one a list build",
            ),
        ] {
            if !(0.0..=1.0).contains(&value) {
                return Err(refused(what, value, must_be));
            }
        }
        let prices = [&self.step, &self.list_build, &self.sort, &self.gather_all];
        let own = [
            ("bytes of the scene", self.bytes),
            ("gathers of all particles a step", self.gathers_of_all),
        ];
        let of_parts = self.parts.iter().flat_map(|parts| {
            let own = [
                ("particles of a part", parts.particles),
                ("reach of a part [m]", parts.reach),
                ("particles across of a part", parts.across),
            ];
            let sides = parts.sides.iter().map(|side| ("side of a part [m]", *side));
            let over_boxes = parts
                .over_boxes
                .map(|own| ("ghosts of a part over those of a box", own));
            own.into_iter().chain(sides).chain(over_boxes)
        });
        let prices = prices.into_iter().flat_map(RankPrice::numbers);
        for (what, value) in own.into_iter().chain(of_parts).chain(prices) {
            if !(value.is_finite() && value >= 0.0) {
                return Err(refused(what, value, "must be zero or positive, and finite"));
            }
        }
        Ok(())
    }
}

fn refused(what: &str, value: f64, must_be: &'static str) -> Error {
    Error::Argument(Problem::Parameter {
        what: what.into(),
        value,
        must_be,
    })
}
