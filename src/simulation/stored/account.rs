//! Accounts of stored energy: gain and supply of each part of a scene, looked at on the way, and where a run stops for them.
//! They go on over changes of the state, over what enters and leaves, and through checkpoints.

use super::measured::Measured;
use crate::error::{Error, Result};
use crate::scalar::Real;
use crate::simulation::Simulation;
use crate::simulation::stability::Seen;

/// Steps from one look to the next.
pub(in crate::simulation) const EVERY: u64 = 32;
/// Share of the energy supplied at which a run stops.
const STOPS: f64 = 0.5;

/// What is kept of a part from look to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::simulation) struct Account<const D: usize> {
    /// What is stored beyond the work at hand where the gain is zero \[J\].
    pub base: f64,
    /// The last gain \[J\].
    pub gain: f64,
    /// What energy is supplied from \[J\].
    given: f64,
    pub supplied: f64,
    /// Particles, and those that have left.
    population: [u64; 2],
    pub worst: Seen<D>,
}

/// How many numbers an account is, without the position.
#[cfg(feature = "checkpoint")]
const NUMBERS: usize = 9;

/// What is kept of stored energy: an account for each group, one of liquids, and one for each coupling.
#[derive(Clone, Debug)]
pub(in crate::simulation) struct Stores<const D: usize> {
    pub limit: f64,
    pub accounts: Vec<Option<Account<D>>>,
}

impl<const D: usize> Default for Stores<D> {
    fn default() -> Self {
        Self {
            limit: STOPS,
            accounts: Vec::new(),
        }
    }
}

impl<const D: usize> Stores<D> {
    /// Lets the account of a part begin anew.
    pub fn forget(&mut self, part: usize) {
        if let Some(own) = self.accounts.get_mut(part) {
            *own = None;
        }
    }
}

#[cfg(feature = "checkpoint")]
impl<const D: usize> Stores<D> {
    /// As rows of a file; that of an account that has not begun is no number.
    pub fn rows(&self) -> (usize, Vec<f64>) {
        let mut rows = Vec::new();
        for own in &self.accounts {
            let Some(own) = own else {
                rows.extend([f64::NAN; NUMBERS]);
                rows.extend([f64::NAN; D]);
                continue;
            };
            let [count, left] = own.population.map(|count| count as f64);
            let worst = own.worst;
            rows.extend([own.base, own.gain, own.given, own.supplied, count, left]);
            rows.extend([worst.value, worst.time, worst.id as f64]);
            rows.extend(worst.position);
        }
        (NUMBERS + D, rows)
    }

    pub fn take_rows(&mut self, limit: f64, rows: &[f64]) {
        self.limit = limit;
        let account = |row: &[f64]| {
            let [base, gain, given, supplied, count, left, share, time, id] =
                core::array::from_fn(|k| row[k]);
            (!base.is_nan()).then(|| Account {
                base,
                gain,
                given,
                supplied,
                population: [count as u64, left as u64],
                worst: Seen {
                    value: share,
                    time,
                    id: id as usize,
                    position: core::array::from_fn(|d| row[NUMBERS + d]),
                },
            })
        };
        self.accounts = rows.chunks_exact(NUMBERS + D).map(account).collect();
    }

    pub fn limit(&self) -> f64 {
        self.limit
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Begins the accounts at a state that has just been evaluated, or lets them go on from it.
    pub(in crate::simulation) fn begin_stores(&mut self, changed: bool) {
        let count = self.state.groups.len() + 1 + self.state.couples.len();
        if !changed && self.state.stores.accounts.len() == count && !self.lacks_liquids() {
            return;
        }
        self.state.stores.accounts.resize(count, None);
        for k in 0..count {
            if self.unsaid(k).is_none()
                && let Ok(now) = self.measured(k)
            {
                let before = self.state.stores.accounts[k];
                self.state.stores.accounts[k] = Some(self.opened(&now, before));
            }
        }
    }

    /// Whether the energy of liquids is kept from now on.
    fn lacks_liquids(&self) -> bool {
        let at = self.state.groups.len();
        self.state.work.is_some()
            && self.state.stores.accounts[at].is_none()
            && self.unsaid(at).is_none()
    }

    /// An account that goes on from the present state with the gain that it had.
    fn opened(&self, now: &Measured, before: Option<Account<D>>) -> Account<D> {
        let (group, slot) = now.at;
        let off = now.gain(0.0);
        let start = now.kinetic + now.stored;
        let nowhere = || self.gain_at(0.0, (group, slot));
        let given = now.kinetic + now.work;
        match before {
            None => Account {
                base: off,
                gain: 0.0,
                given: given - start,
                supplied: start,
                population: now.population,
                worst: nowhere(),
            },
            Some(own) => Account {
                base: off - own.gain,
                supplied: own.supplied.max(given - own.given),
                population: now.population,
                ..own
            },
        }
    }

    fn gain_at(&self, share: f64, (group, slot): (usize, usize)) -> Seen<D> {
        let particles = &self.state.groups[group].particles;
        let id = particles.ids.get(slot).map_or(0, |id| *id as usize);
        let held = slot < particles.columns.slots();
        Seen {
            value: share,
            time: self.state.time,
            id: particles.first_id + id,
            position: if held {
                particles.position(slot)
            } else {
                [0.0; D]
            },
        }
    }

    /// The largest gain of all parts since the start; `None` where nothing can be said of any.
    pub(in crate::simulation) fn largest_gain(&self) -> Option<Seen<D>> {
        let known = self.state.stores.accounts.iter().flatten();
        let worst = known.map(|own| own.worst);
        worst.reduce(|a, b| if b.value > a.value { b } else { a })
    }

    /// Looks at the state after a step, in some.
    pub(in crate::simulation) fn look_at_stores(&mut self) -> Result<()> {
        if !self.state.steps.is_multiple_of(EVERY) || !self.stands() {
            return Ok(());
        }
        if self.state.stores.accounts.iter().any(Option::is_some) {
            self.bring_together();
        }
        for k in 0..self.state.stores.accounts.len() {
            let Some(mut account) = self.state.stores.accounts[k] else {
                continue;
            };
            if self.unsaid(k).is_some() {
                continue;
            }
            let Ok(now) = self.measured(k) else {
                continue;
            };
            // What has entered or left since has taken its energies along.
            if now.population != account.population {
                self.state.stores.accounts[k] = Some(self.opened(&now, Some(account)));
                continue;
            }
            account.gain = now.gain(account.base);
            let given = now.kinetic + now.work - account.given;
            account.supplied = account.supplied.max(given);
            let beyond = (account.gain - now.rounding).max(0.0);
            let share = if beyond > 0.0 {
                beyond / account.supplied.max(now.rounding).max(f64::MIN_POSITIVE)
            } else {
                0.0
            };
            if share > account.worst.value {
                account.worst = self.gain_at(share, now.at);
            }
            self.state.stores.accounts[k] = Some(account);
            if share > self.state.stores.limit {
                let (body, particle) = self.locate(account.worst.id);
                return Err(Error::StoredEnergy {
                    part: self.name_of_part(k),
                    gain: account.gain,
                    supplied: account.supplied,
                    limit: self.state.stores.limit,
                    body,
                    particle,
                    position: account.worst.position.to_vec(),
                    time: self.state.time,
                    step: self.state.steps,
                });
            }
        }
        Ok(())
    }
}
