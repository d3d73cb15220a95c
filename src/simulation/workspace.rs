//! The workspace of a group: packed records, sums of sweeps, states that integrators keep, times.
//! Of it a checkpoint holds what the next step reads before it evaluates.

use super::Phases;
use super::cost::Spent;
use super::population::Moves;
use super::settle::Settling;
use crate::particles::{Columns, Field, Output};
use crate::scalar::Real;
use crate::sweep::{Records, Results};
use crate::tensor::Vector;

/// Columns of a saved state.
pub(super) type Saved<T> = Vec<(Field, Vec<T>)>;

/// What came through a boundary while lists were built: the number of a saved state, or none for the present one,
/// the body and the boundary, and the momentum \[kg m/s\].
pub(super) type Given<const D: usize> = (Option<usize>, [usize; 2], [f64; D]);

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
    /// The time \[s\] of that evaluation.
    pub evaluated_time: f64,
    /// What the loads gave at that evaluation \[m/s²\].
    pub evaluated_gravity: [T; D],
    /// The work of the pair forces of the last evaluation, with the mean velocities of the first kick that took it; where no
    /// sweep sums it, the rates of that evaluation before others than pairs added forces.
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
            evaluated_time: 0.0,
            evaluated_gravity: [T::zero(); D],
            worked: Results::default(),
            first_kick: None,
            lengths_time: f64::NAN,
            sums: Results::default(),
            coupling: Results::default(),
            settling: Settling::default(),
            predicted: Vec::new(),
            is_predicted: false,
            kept: Vec::new(),
            phases: Phases::default(),
            spent: Spent::default(),
        }
    }
}

impl<T: Real, const D: usize> Workspace<T, D> {
    /// Frees what a prediction has taken back.
    pub fn forget_taken_back(&mut self) {
        if !self.is_predicted {
            self.predicted = Vec::new();
        }
    }

    /// Forgets records, of which lists that are built next have no use.
    pub fn forget_records(&mut self) {
        (self.records, self.work_records) = Default::default();
        self.records_of_rates = false;
    }

    /// Component `k` of the column of accelerations, of particles with these masses.
    #[inline(always)]
    pub fn acceleration(&self, mass: &[T], k: usize) -> T {
        let (slot, d) = (k / D, k % D);
        self.rates.get(Output::FORCE, d, slot) / mass[slot] + self.evaluated_gravity[d]
    }

    /// The power \[W\] of a force \[N\] on the particle in a slot, with its velocity in `ahead` \[s\].
    pub fn power(&self, columns: &Columns<T, D>, force: &[f64; D], slot: usize, ahead: f64) -> f64 {
        let v = &columns.vectors(Field::VELOCITY)[slot];
        let mass = columns.raw(Field::MASS);
        let of = |d: usize| {
            let a = self.acceleration(mass, slot * D + d).to_f64();
            force[d] * (v[d].to_f64() + ahead * a)
        };
        (0..D).map(of).sum()
    }

    /// Brings saved states into the order of the particles after a list build, and through the boundaries that
    /// particles have crossed, each where it was at the time \[s\] of the state. Gives what these gave.
    pub fn follow(
        &mut self,
        moved: &mut Moves<T, D>,
        time_of: impl Fn(usize) -> f64,
    ) -> Vec<Given<D>> {
        let mut given = Vec::new();
        let at = |v: &[T], slot: usize| Vector::from_row_slice(&v[slot * D..(slot + 1) * D]);
        for (number, kept) in self.kept.iter_mut().enumerate() {
            let Ok([(_, x), (_, residual), (_, v)]) = kept.get_disjoint_mut([0, 1, 2]) else {
                continue;
            };
            if !x.is_empty() {
                for entry in &moved.wraps {
                    let impulse = entry.impulse(&at(v, entry.slot));
                    given.extend(entry.given.map(|to| (Some(number), to, impulse)));
                    let through = entry.through_at(time_of(number));
                    through.re_enter(entry.slot, x, residual, v);
                }
            }
            for (field, column) in kept.iter_mut().skip(3) {
                for entry in &moved.wraps {
                    entry.through.turn_field(*field, entry.slot, column);
                }
            }
        }
        // A prediction is taken back: what it started from is the present state, and none is under way otherwise.
        let predicted = if self.is_predicted {
            self.predicted.as_mut_slice()
        } else {
            &mut []
        };
        let (start, others) = predicted.split_at_mut(predicted.len().min(1));
        let mut start = start.first_mut().map(|own| &mut own.1);
        for entry in &moved.wraps {
            let velocity = start.as_ref().map_or(entry.velocity, |v| at(v, entry.slot));
            let impulse = entry.impulse(&velocity);
            given.extend(entry.given.map(|to| (None, to, impulse)));
            if let Some(v) = &mut start {
                entry.through.turn(entry.slot, v);
            }
        }
        for (field, column) in others.iter_mut() {
            for entry in &moved.wraps {
                entry.through.turn_field(*field, entry.slot, column);
            }
        }
        if !moved.order.is_empty() {
            let columns = self.kept.iter_mut().flatten();
            for (_, column) in columns.chain(predicted) {
                let width = column.len() / moved.order.len();
                let before = column.clone();
                for (k, &from) in moved.order.iter().enumerate() {
                    let from = from as usize * width;
                    column[k * width..(k + 1) * width].copy_from_slice(&before[from..from + width]);
                }
            }
        }
        moved.wraps.clear();
        moved.order.clear();
        given
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
