//! What the hard cases share: a row of the table, the composed liquid, the same bits on one and two threads.
//! A cure of strength zero is the control, so that a case and its control run through the same loops.

use meshfree::effect::{ArtificialPressure, ConsistentShifting, ExpansionMemory, PairingControl};
use meshfree::neighbors::Cells;
use meshfree::prelude::*;
use meshfree::simulation::StepControl;
use meshfree::term::Fourtakas;
use meshfree::term::viscosity::MonaghanGingold;

/// A number of the environment by which all cases are varied: see `variations.rs`.
fn asked(name: &str, usual: f64) -> f64 {
    let asked = std::env::var(name).ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(usual)
}

/// The seed of a perturbed start, or another: `MESHFREE_SEED` more.
pub fn seed(usual: u64) -> u64 {
    usual + asked("MESHFREE_SEED", 0.0) as u64
}

/// A duration that a case chooses for itself, or `MESHFREE_DURATION` times it. Where an exact solution ends a run it is not asked.
pub fn lasting(duration: f64) -> f64 {
    duration * asked("MESHFREE_DURATION", 1.0)
}

/// A scene whose steps may be varied.
pub trait Varied {
    /// Its steps are `MESHFREE_STEP` of what they were.
    fn varied(self) -> Self;
}

impl<const D: usize> Varied for Scene<f64, D> {
    fn varied(self) -> Self {
        let share = asked("MESHFREE_STEP", 1.0);
        self.steps(|own| StepControl {
            courant: share * own.courant,
            force: share * own.force,
            viscous: share * own.viscous,
            approach: share * own.approach,
            ..own
        })
    }
}

/// A line of the table: what a case asks, what it gave, and what its control without the cure gave.
#[derive(Clone, Debug)]
pub struct Row {
    pub case: &'static str,
    pub criterion: &'static str,
    pub value: f64,
    pub control: f64,
}

impl Row {
    /// Prints the row, and holds the case to its bound and the control to be beyond it.
    pub fn at_most(self, bound: f64) {
        self.print(&format!("≤ {bound}"), self.control);
        assert!(self.value <= bound, "the case fails: {self:?}");
        assert!(
            varied() || self.control > bound,
            "the control holds: {self:?}"
        );
    }
    /// The same with a bound from below.
    pub fn at_least(self, bound: f64) {
        self.print(&format!("≥ {bound}"), self.control);
        assert!(self.value >= bound, "the case fails: {self:?}");
        assert!(
            varied() || self.control < bound,
            "the control holds: {self:?}"
        );
    }
    fn print(&self, bound: &str, control: f64) {
        let control = if control.is_nan() {
            "none".into()
        } else {
            format!("{control:e}")
        };
        let Self {
            case,
            criterion,
            value,
            ..
        } = self;
        println!("| {case} | {criterion} | {bound} | {value:e} | {control} |");
    }
}

/// Whether all cases are varied: then controls are shown, and not held to fail.
fn varied() -> bool {
    ["MESHFREE_SEED", "MESHFREE_DURATION", "MESHFREE_STEP"]
        .iter()
        .any(|name| std::env::var(name).is_ok())
}

/// How strongly each of the cures of a liquid acts.
#[derive(Clone, Copy, Debug)]
pub struct Cures {
    pub shifting: Shifting,
    /// Of the consistent shifting.
    pub even: f64,
    /// Whether torn liquid remembers how far it has expanded.
    pub memory: bool,
    pub pressure: f64,
    pub pairing: f64,
    pub volume: f64,
    pub alpha: f64,
    pub delta: f64,
}

impl Cures {
    /// A ready liquid with nothing added.
    pub const NONE: Self = Self {
        shifting: Shifting::Concentration {
            strength: 0.0,
            free_surface: true,
        },
        even: 0.0,
        memory: false,
        pressure: 0.0,
        pairing: 0.0,
        volume: 0.0,
        alpha: 0.02,
        delta: 0.1,
    };
    /// With what keeps a liquid in tension even.
    pub const EVEN: Self = Self {
        shifting: Shifting::STANDARD,
        pressure: 0.3,
        pairing: 0.005,
        ..Self::NONE
    };

    /// With what keeps a violent liquid even.
    pub const VIOLENT: Self = Self {
        even: 0.1,
        memory: true,
        ..Self::NONE
    };

    /// The liquid with them.
    pub fn liquid(self) -> Scheme<f64, 2> {
        let diffusion = Fourtakas { delta: self.delta };
        let viscosity = MonaghanGingold {
            alpha: self.alpha,
            beta: 0.0,
        };
        schemes::weakly_compressible()
            .with_viscosity(viscosity)
            .density_diffusion(diffusion)
            .with(self.shifting)
            .with(ConsistentShifting {
                strength: self.even,
                ..ConsistentShifting::default()
            })
            .with(self.memory.then_some(ExpansionMemory))
            .with(ArtificialPressure {
                share: self.pressure,
                ..ArtificialPressure::default()
            })
            .with(PairingControl {
                strength: self.pairing,
            })
            .with(VolumeConsistency {
                strength: self.volume,
            })
            .compose()
    }
}

/// Runs on so many threads.
pub fn on_threads<R: Send>(threads: usize, run: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    pool.install(run)
}

/// Holds a run to give the same bits on one and on two threads.
pub fn same_bits<const D: usize>(run: impl Fn() -> Simulation<f64, D> + Sync) {
    let bits = |threads| {
        on_threads(threads, || {
            let simulation = run();
            let numbers = simulation.all().flat_map(|own| {
                let both = own.position().into_iter().chain(own.velocity());
                both.map(f64::to_bits).collect::<Vec<_>>()
            });
            numbers.collect::<Vec<_>>()
        })
    };
    assert!(bits(1) == bits(2), "one and two threads differ");
}

/// Share of the particles in the largest set that links of at most `link` \[m\] connect.
pub fn largest_piece<const D: usize>(simulation: &Simulation<f64, D>, link: f64) -> f64 {
    let places: Vec<_> = simulation.all().map(|own| own.position()).collect();
    largest_share(&places, link)
}

/// The same of any places.
pub fn largest_share<const D: usize>(places: &[[f64; D]], link: f64) -> f64 {
    let all: Vec<u32> = (0..places.len() as u32).collect();
    let cells = Cells::build(places, &all, link);
    let mut seen = vec![false; places.len()];
    let mut largest = 0;
    for start in 0..places.len() {
        let (mut front, mut count) = (vec![start], 0);
        while let Some(k) = front.pop() {
            if std::mem::replace(&mut seen[k], true) {
                continue;
            }
            count += 1;
            let x = places[k];
            let [low, high] = [-link, link].map(|by| x.map(|x| x + by));
            cells.for_each_run(low, high, |run| {
                for &j in run {
                    let r2: f64 = (0..D).map(|d| (places[j as usize][d] - x[d]).powi(2)).sum();
                    if r2 <= link * link && !seen[j as usize] {
                        front.push(j as usize);
                    }
                }
            });
        }
        largest = largest.max(count);
    }
    largest as f64 / places.len() as f64
}
