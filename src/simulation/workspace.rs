//! The workspace of a group: packed records, sums of sweeps, states that integrators keep, times.
//! Of it a checkpoint holds what the next step reads before it evaluates.

use super::Phases;
use super::cost::Spent;
use super::population::Moves;
use super::settle::Settling;
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::sweep::{Records, Results};

/// Columns of a saved state.
pub(super) type Saved<T> = Vec<(Field, Vec<T>)>;

/// Scratch of a group, and the rates at hand.
#[derive(Clone, Debug)]
pub(crate) struct Workspace<T: Real, const D: usize> {
    pub records: Records<T>,
    /// Records of the rates with the mean velocities of a kick.
    pub work_records: Records<T>,
    /// Whether the records are those of the rates; all sweeps share them.
    pub records_of_rates: bool,
    /// The rates of the last evaluation.
    pub rates: Results<T, D>,
    /// What the loads gave at that evaluation \[m/s²\].
    pub evaluated_gravity: [T; D],
    /// The work of the pair forces of the last evaluation, with the mean velocities of the first kick that took it.
    pub worked: Results<T, D>,
    /// Half of the time \[s\] of that kick, and where the images were in time \[s\]; none before there was one.
    pub first_kick: Option<[f64; 2]>,
    /// The time \[s\] at which smoothing lengths that follow the density were found; no number before they were.
    pub lengths_time: f64,
    /// The sums of the last other sweep.
    pub sums: Results<T, D>,
    /// What its liquid does to the particles of structures, which are walls here.
    pub coupling: Results<T, D>,
    /// What of a repeated law has settled.
    pub settling: Settling,
    /// What list builds have done to particles since saved states were last told.
    pub moved: Moves<T, D>,
    /// What a prediction has changed, and takes back.
    pub predicted: Saved<T>,
    /// Whether a prediction is under way.
    pub is_predicted: bool,
    /// States that an integrator keeps.
    pub kept: Vec<Saved<T>>,
    /// Where the time went.
    pub phases: Phases,
    /// Where the time went, by sweep and law.
    pub spent: Spent,
}

impl<T: Real, const D: usize> Default for Workspace<T, D> {
    fn default() -> Self {
        Self {
            records: Records::default(),
            work_records: Records::default(),
            records_of_rates: false,
            rates: Results::default(),
            evaluated_gravity: [T::zero(); D],
            worked: Results::default(),
            first_kick: None,
            lengths_time: f64::NAN,
            sums: Results::default(),
            coupling: Results::default(),
            settling: Settling::default(),
            moved: Moves::default(),
            predicted: Vec::new(),
            is_predicted: false,
            kept: Vec::new(),
            phases: Phases::default(),
            spent: Spent::default(),
        }
    }
}

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Component `k` of the column of accelerations, of particles with these masses.
    #[inline(always)]
    pub fn acceleration(&self, mass: &[T], k: usize) -> T {
        let (slot, d) = (k / D, k % D);
        self.rates.get(Output::FORCE, d, slot) / mass[slot] + self.evaluated_gravity[d]
    }

    /// Bytes held for records and sums.
    pub fn bytes(&self) -> usize {
        self.records.bytes()
            + self.work_records.bytes()
            + self.rates.bytes()
            + self.worked.bytes()
            + self.sums.bytes()
            + self.coupling.bytes()
    }
}
