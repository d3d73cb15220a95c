//! Stored energy, which is a function of the state, held against the work that went into it.
//! Internal energy is integrated to balance the work of forces, so it alone is silent about energy from nowhere.

use super::Simulation;
use super::contact::Couple;
use super::group::Group;
use super::population::BodyState;
use super::side::Side;
use super::stability::Seen;
use crate::error::{Error, Result};
use crate::output::table::significant;
use crate::particles::Field;
use crate::scalar::Real;
use crate::scheme::EnergyForm;
use core::fmt;

/// Steps from one look to the next.
const EVERY: u64 = 32;
/// Share of the energy supplied at which a run stops.
const STOPS: f64 = 0.5;
/// Roundings of m c² by which a stored energy, and roundings by which an integrated one, may be off.
const ROUNDINGS: [f64; 2] = [4.0, 1e3];

/// Energy that is stored by bodies and couplings, beside what work and booked dissipation leave for it.
///
/// For each part of a scene that shares its energy,
///
/// gain = (stored now − stored at the start) − (work that forces took − dissipation booked),
///
/// which is zero or negative: dissipation that has no column of its own (viscosities, shifting, diffusion of density)
/// makes it negative. What is above zero comes from the integration in time, or from forces that follow from no energy.
/// It is looked at every 32 steps of the run, whoever reads, and its share is of the largest energy supplied so far,
///
/// supplied = kinetic and stored energy at the start + net work and heat from outside since,
///
/// of which the second is the change of kinetic and internal energy of a part that carries internal energy. A look is
/// one sum over the particles.
///
/// | part | stored, as a function of the state | the work that forces took |
/// |---|---|---|
/// | bodies of a scheme with internal energy | Σ m ψ(F)/ρ₀ of hyperelastic laws; Σ m (∫ p/ρ² dρ + S:S/(4Gρ)) of hypoelastic ones; Σ m ∫ p/ρ² dρ where the pressure depends on density alone; Σ m e of gases | change of internal energy |
/// | liquids without one, where [energy is kept](Simulation::keep_energy) | Σ m ∫ p/ρ² dρ | work of loads and walls less the gain of kinetic energy |
/// | a coupling by forces | that of its springs | minus its work on both sides |
///
/// Columns of dissipation are plastic work and the heat of friction. Hourglass control counts as storing no less than
/// nothing, since its force follows from no energy: what it gives beyond what it has taken counts as a gain.
///
/// ```
/// use meshfree::effect::NeoHookean;
/// use meshfree::prelude::*;
/// let rubber = Material::new("rubber", meshfree::material::eos::Linear::new(1010.0, 54.0)).with_shear_modulus(7e5);
/// let pulled = |[x, _]: [f64; 2], start| meshfree::scheme::Start { velocity: [10.0 * (x - 0.05), 0.0], ..start };
/// let mut block = Scene::<f64, 2>::new(schemes::total_lagrangian().with(NeoHookean))
///     .body(Body::block("block", rubber, [0.0; 2], [0.1, 0.05], 0.005).start(pulled))
///     .build()?;
/// block.run_until(1e-3)?;
/// let stored = block.stored_energy();
/// println!("{stored}");
/// assert!(stored.body("block").is_some_and(|energy| energy > 0.0));
/// let balance = stored.parts[0].balance.as_ref().expect("a hyperelastic solid is checkable");
/// assert!(balance.gain.abs() < 0.01 * balance.supplied);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StoredEnergy {
    /// Time \[s\].
    pub time: f64,
    /// Every body by name, with what it stores \[J\]; `None` if that is no function of its state.
    pub bodies: Vec<(String, Option<f64>)>,
    /// The parts that share their energy: bodies of a scheme, liquids, couplings.
    pub parts: Vec<StoredPart>,
}

/// A part of a scene that shares its energy.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredPart {
    /// Its bodies, or the coupling and its bodies.
    pub name: String,
    /// How it stands, or why that cannot be said.
    pub balance: core::result::Result<StoredBalance, &'static str>,
}

/// Stored energy of a part beside the work that went into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredBalance {
    /// Stored now \[J\].
    pub stored: f64,
    /// Dissipation booked since the start \[J\].
    pub dissipated: f64,
    /// By how much the stored energy exceeds what work and booked dissipation leave \[J\].
    pub gain: f64,
    /// The largest energy supplied so far \[J\].
    pub supplied: f64,
    /// The largest gain over the energy supplied that was seen since the start.
    pub largest: f64,
}

impl StoredEnergy {
    /// What a body stores \[J\]; `None` if there is no such body, or if it is no function of its state.
    #[must_use]
    pub fn body(&self, name: &str) -> Option<f64> {
        self.bodies.iter().find(|own| own.0 == name)?.1
    }
    /// The largest gain over the energy supplied of all parts; `None` where nothing can be said of any.
    #[must_use]
    pub fn largest(&self) -> Option<f64> {
        let known = self.parts.iter().filter_map(|part| part.balance.ok());
        known.map(|own| own.largest).reduce(f64::max)
    }
}

impl fmt::Display for StoredEnergy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "stored energy at {} s", significant(self.time, 4))?;
        for (name, stored) in &self.bodies {
            match stored {
                Some(stored) => writeln!(f, "  {name:<26} {} J", significant(*stored, 4))?,
                None => writeln!(f, "  {name:<26} not checkable")?,
            }
        }
        for part in &self.parts {
            write!(f, "  gain of {:<18} ", part.name)?;
            match &part.balance {
                Ok(own) => {
                    let numbers = [own.gain, own.supplied, own.dissipated, own.largest];
                    let [gain, supplied, dissipated, largest] =
                        numbers.map(|own| significant(own, 3));
                    writeln!(
                        f,
                        "{gain} J of {supplied} J supplied, {dissipated} J dissipated and booked; largest share {largest}"
                    )?;
                }
                Err(why) => writeln!(f, "not checkable: {why}")?,
            }
        }
        Ok(())
    }
}

/// What is kept of a part from look to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Account<const D: usize> {
    /// What is stored beyond the work at hand where the gain is zero \[J\].
    base: f64,
    /// The last gain \[J\].
    gain: f64,
    /// What energy is supplied from \[J\].
    given: f64,
    pub supplied: f64,
    /// Particles, and those that have left.
    population: [u64; 2],
    pub worst: Seen<D>,
}

/// How many numbers an account is, beside the position.
#[cfg(feature = "checkpoint")]
const NUMBERS: usize = 9;

/// What is kept of stored energy: an account for each group, one of liquids, and one for each coupling.
#[derive(Clone, Debug)]
pub(super) struct Stores<const D: usize> {
    limit: f64,
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

/// The present state of a part.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    stored: f64,
    dissipated: f64,
    kinetic: f64,
    /// What work has left for it: internal energy, or minus the work of a coupling, or the work of loads and walls less
    /// kinetic energy. With the kinetic energy it changes by what is outside alone.
    work: f64,
    /// By how much rounding may have them off.
    rounding: f64,
    population: [u64; 2],
    /// The particle with the largest gain of its own, as group and slot.
    at: (usize, usize),
}

impl Measured {
    /// Stored energy less the work that is left for it.
    fn gain<const D: usize>(&self, account: Option<&Account<D>>) -> f64 {
        self.stored + self.dissipated - self.work - account.map_or(0.0, |own| own.base)
    }
}

const NO_ENERGY: &str =
    "no internal energy is integrated; Simulation::keep_energy books the work instead";

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Stored energy of bodies and couplings as a function of the state, beside the work that went into it.
    #[must_use]
    pub fn stored_energy(&self) -> StoredEnergy {
        let stands = self.stands();
        let body = |(group, body): (&Group<T, D>, &BodyState<T>)| {
            let mass = group.particles.columns.raw(Field::MASS);
            let add = |sum: f64, slot: usize| {
                let [stored, _] = energies(group, body, slot)?;
                Some(sum + mass[slot].to_f64() * stored)
            };
            let said = stands && group.scheme.program.books_energy;
            let stored = said
                .then(|| body.slots.clone().try_fold(0.0, add))
                .flatten();
            (body.name.clone(), stored)
        };
        let part = |k: usize| {
            let measured = self.unsaid(k).map_or_else(|| self.measured(k), Err);
            let account = self.stores.accounts.get(k).and_then(Option::as_ref);
            let balance = measured.map(|own| {
                let gain = account.map_or(0.0, |_| own.gain(account));
                let start = own.kinetic + own.stored;
                StoredBalance {
                    stored: own.stored,
                    dissipated: own.dissipated,
                    gain,
                    supplied: account.map_or(start, |own| own.supplied),
                    largest: account.map_or(0.0, |own| own.worst.value),
                }
            });
            StoredPart {
                name: self.name_of_part(k),
                balance,
            }
        };
        StoredEnergy {
            time: self.time,
            bodies: self.all_bodies().map(body).collect(),
            parts: self.stored_parts().map(part).collect(),
        }
    }

    /// Stops the run where stored energy exceeds what work and booked dissipation leave by more than this share of the
    /// largest energy supplied; 0.5 if not said, and infinity for never. See [`StoredEnergy`].
    pub fn limit_stored_energy(&mut self, share: f64) {
        self.on_both(&|own| own.stores.limit = share);
    }

    /// Parts of which there is something to say: groups with internal energy, liquids without, and couplings.
    fn stored_parts(&self) -> impl Iterator<Item = usize> {
        let groups = self.groups.len();
        let of_liquids = self.groups.iter().any(|group| !has_energy(group));
        let all = 0..groups + 1 + self.couples.len();
        all.filter(move |&k| match self.groups.get(k) {
            Some(group) => has_energy(group),
            None => k > groups || of_liquids,
        })
    }

    fn name_of_part(&self, k: usize) -> String {
        let names = |groups: &mut dyn Iterator<Item = &Group<T, D>>| {
            let bodies = groups.flat_map(|group| &group.particles.bodies);
            let names: Vec<_> = bodies.map(|body| body.name.as_str()).collect();
            names.join(", ")
        };
        if let Some(group) = self.groups.get(k) {
            return names(&mut core::iter::once(group));
        }
        match self.couple_of(k) {
            None => names(&mut self.groups.iter().filter(|group| !has_energy(group))),
            Some(couple) => {
                let [first, second] = couple.sides.each_ref().map(|side| side.name(&self.groups));
                format!("{} of {first} and {second}", couple.coupling.name())
            }
        }
    }

    fn couple_of(&self, k: usize) -> Option<&Couple<T, D>> {
        self.couples.get(k.checked_sub(self.groups.len() + 1)?)
    }

    /// Whether all that follows from positions has been evaluated at the present ones.
    fn stands(&self) -> bool {
        let step = self.last_vote.map_or(0.0, |vote| vote.step);
        let off = (self.evaluated - self.time).abs();
        self.rates_at_hand && off <= 1e-9 * step + 2e-12 * self.time.abs()
    }

    /// Why nothing can be said of a part, as the scene was built.
    fn unsaid(&self, k: usize) -> Option<&'static str> {
        if !self.integrator.kicks() {
            return Some("the integrator leaves no forces that belong to the end of a step");
        }
        if let Some(group) = self.groups.get(k) {
            return self.unsaid_of_group(group);
        }
        if let Some(couple) = self.couple_of(k) {
            let apart = |side: &Side<D>| {
                let body = side.body();
                body.is_some_and(|(group, _)| self.groups[group].sub_cycle.is_some())
            };
            return if !couple.coupling.books_energy() {
                Some("the coupling does not say what it stores")
            } else if couple.sides.iter().any(apart) {
                Some("a side sub-cycles, and its work is booked with that of its other couplings")
            } else {
                None
            };
        }
        let moves = |group: &Group<T, D>| group.boundaries.iter().any(|own| own.moves());
        if self.work.is_none() {
            Some(NO_ENERGY)
        } else if self.groups.iter().any(has_energy) {
            Some("bodies with internal energy take part")
        } else if !self
            .groups
            .iter()
            .all(|group| group.scheme.program.books_energy)
        {
            Some("an effect does not say what it stores")
        } else if self.groups.iter().any(moves) {
            Some("the work of a boundary that moves is not booked")
        } else if self.groups.iter().any(|group| !group.held.is_empty()) {
            Some("the work of what holds particles is not booked")
        } else if self.groups.iter().any(|group| !has_law(group)) {
            Some("the pressure of a material depends on internal energy")
        } else {
            None
        }
    }

    fn unsaid_of_group(&self, group: &Group<T, D>) -> Option<&'static str> {
        if !group.scheme.program.books_energy {
            Some("an effect does not say what it stores")
        } else if group.scheme.energy != EnergyForm::Compatible {
            Some("the energy form does not balance the work of a step")
        } else if !has_law(group) {
            Some("the pressure of a material depends on internal energy")
        } else if !group.walls.is_empty() {
            Some("walls take part of the work")
        } else if group.held.asleep.is_some() {
            Some("particles may sleep")
        } else if self.loads.iter().any(|load| load.heats()) {
            Some("a load heats or cools")
        } else {
            None
        }
    }

    /// The present state of a part of which something can be said.
    fn measured(&self, k: usize) -> core::result::Result<Measured, &'static str> {
        if !self.stands() {
            return Err("nothing has been evaluated at the present state");
        }
        let lost = "the pressure of a material depends on internal energy";
        let mut sum = Measured::default();
        if let Some(group) = self.groups.get(k) {
            add_bodies(&mut sum, group, k).ok_or(lost)?;
            return Ok(sum);
        }
        if let Some(couple) = self.couple_of(k) {
            for (number, body) in couple.sides.iter().filter_map(Side::body) {
                let group = &self.groups[number];
                let body = &group.particles.bodies[body];
                for slot in body.slots.clone() {
                    sum.kinetic += kinetic(group, slot);
                }
                sum.population[0] += body.slots.len() as u64;
                sum.at = (number, body.slots.start);
            }
            sum.stored = couple.acting.stored;
            sum.dissipated = couple.acting.heat;
            sum.work = -couple.work[0] - couple.work[1];
            sum.at = self.strongest(couple).unwrap_or(sum.at);
            // What was taken from what is supplied, if the sides are the same body, is counted once.
            if couple.is_self() {
                sum.kinetic *= 0.5;
            }
            return Ok(sum);
        }
        for (number, group) in self.groups.iter().enumerate() {
            add_bodies(&mut sum, group, number).ok_or(lost)?;
        }
        for couple in &self.couples {
            sum.stored += couple.acting.stored;
            sum.dissipated += couple.acting.heat;
        }
        let work = self.work.unwrap_or_default();
        let removed = self.removed().kinetic;
        sum.work = work.load + work.wall - sum.kinetic - removed;
        Ok(sum)
    }

    /// The particle on which a coupling acts most.
    fn strongest(&self, couple: &Couple<T, D>) -> Option<(usize, usize)> {
        let mut found = (0.0, None);
        for (side, forces) in couple.acting.forces.iter().enumerate() {
            let Some((number, body)) = couple.sides[side].body() else {
                continue;
            };
            let particles = &self.groups[number].particles;
            for (id, force) in forces {
                let square: f64 = force.iter().map(|f| f.to_f64().powi(2)).sum();
                if square > found.0 {
                    found = (
                        square,
                        particles
                            .slots_of(body, *id)
                            .next()
                            .map(|slot| (number, slot)),
                    );
                }
            }
        }
        found.1
    }

    /// Begins the accounts at a state that has just been evaluated, or lets them go on from it.
    pub(super) fn begin_stores(&mut self, changed: bool) {
        let count = self.groups.len() + 1 + self.couples.len();
        if !changed && self.stores.accounts.len() == count && !self.lacks_liquids() {
            return;
        }
        self.stores.accounts.resize(count, None);
        for k in 0..count {
            if self.unsaid(k).is_none()
                && let Ok(now) = self.measured(k)
            {
                let before = self.stores.accounts[k];
                self.stores.accounts[k] = Some(self.opened(&now, before));
            }
        }
    }

    /// Whether the energy of liquids is kept from now on.
    fn lacks_liquids(&self) -> bool {
        let at = self.groups.len();
        self.work.is_some() && self.stores.accounts[at].is_none() && self.unsaid(at).is_none()
    }

    /// An account that goes on from the present state with the gain that it had.
    fn opened(&self, now: &Measured, before: Option<Account<D>>) -> Account<D> {
        let (group, slot) = now.at;
        let off = now.gain::<D>(None);
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
        let particles = &self.groups[group].particles;
        let id = particles.ids.get(slot).map_or(0, |id| *id as usize);
        let held = slot < particles.columns.slots();
        Seen {
            value: share,
            time: self.time,
            id: particles.first_id + id,
            position: if held {
                particles.position(slot)
            } else {
                [0.0; D]
            },
        }
    }

    /// The largest gain of all parts since the start; `None` where nothing can be said of any.
    pub(super) fn largest_gain(&self) -> Option<Seen<D>> {
        let known = self.stores.accounts.iter().flatten();
        let worst = known.map(|own| own.worst);
        worst.reduce(|a, b| if b.value > a.value { b } else { a })
    }

    /// Looks at the state after a step, in some.
    pub(super) fn look_at_stores(&mut self) -> Result<()> {
        if !self.steps.is_multiple_of(EVERY) || !self.stands() {
            return Ok(());
        }
        for k in 0..self.stores.accounts.len() {
            let Some(mut account) = self.stores.accounts[k] else {
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
                self.stores.accounts[k] = Some(self.opened(&now, Some(account)));
                continue;
            }
            account.gain = now.gain(Some(&account));
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
            self.stores.accounts[k] = Some(account);
            if share > self.stores.limit {
                let (body, particle) = self.locate(account.worst.id);
                return Err(Error::StoredEnergy {
                    part: self.name_of_part(k),
                    gain: account.gain,
                    supplied: account.supplied,
                    limit: self.stores.limit,
                    body,
                    particle,
                    position: account.worst.position.to_vec(),
                    time: self.time,
                    step: self.steps,
                });
            }
        }
        Ok(())
    }
}

/// Whether its bodies carry an internal energy.
fn has_energy<T: Real, const D: usize>(group: &Group<T, D>) -> bool {
    group.scheme.energy != EnergyForm::None
}

/// Whether what its materials store is a function of the state.
fn has_law<T: Real, const D: usize>(group: &Group<T, D>) -> bool {
    let known = |body: &BodyState<T>| {
        let eos = body.material.eos();
        eos.stored_energy(eos.reference_density(), 0.0).is_some()
    };
    !group.scheme.program.presses || group.particles.bodies.iter().all(known)
}

/// What a particle stores and has dissipated by booked means, over its mass \[J/kg\].
fn energies<T: Real, const D: usize>(
    group: &Group<T, D>,
    body: &BodyState<T>,
    slot: usize,
) -> Option<[f64; 2]> {
    let (columns, program) = (&group.particles.columns, &group.scheme.program);
    let at = |field: &Field| {
        let value = columns.raw(*field).get(slot);
        value.map_or(0.0, |value| value.to_f64())
    };
    let mut stored: f64 = program.stored.iter().map(at).sum();
    if program.presses {
        let eos = body.material.eos();
        stored += eos.stored_energy(at(&Field::DENSITY), at(&Field::ENERGY))?;
    }
    Some([stored, program.dissipated.iter().map(at).sum()])
}

/// Kinetic energy of the particle in a slot \[J\].
fn kinetic<T: Real, const D: usize>(group: &Group<T, D>, slot: usize) -> f64 {
    let columns = &group.particles.columns;
    let v = columns.vectors(Field::VELOCITY)[slot];
    let v2: f64 = v.iter().map(|v| v.to_f64().powi(2)).sum();
    0.5 * columns.raw(Field::MASS)[slot].to_f64() * v2
}

/// Adds the bodies of a group; `None` if one stores what cannot be said.
fn add_bodies<T: Real, const D: usize>(
    sum: &mut Measured,
    group: &Group<T, D>,
    number: usize,
) -> Option<()> {
    let columns = &group.particles.columns;
    let [mass, internal, sound] =
        [Field::MASS, Field::ENERGY, Field::SOUND_SPEED].map(|field| columns.raw(field));
    let mut most = f64::NEG_INFINITY;
    let (mut stiff, mut size) = (0.0, 0.0);
    for body in &group.particles.bodies {
        for slot in body.slots.clone() {
            let m = mass[slot].to_f64();
            let [stored, dissipated] = energies(group, body, slot)?.map(|own| m * own);
            let own = m * internal.get(slot).map_or(0.0, |e| e.to_f64());
            let moving = kinetic(group, slot);
            sum.stored += stored;
            sum.dissipated += dissipated;
            sum.work += own;
            sum.kinetic += moving;
            stiff += m * sound.get(slot).map_or(0.0, |c| c.to_f64().powi(2));
            size += own.abs();
            let gain = if has_energy(group) {
                stored + dissipated - own
            } else {
                stored + moving
            };
            if gain > most {
                (most, sum.at) = (gain, (number, slot));
            }
        }
        sum.population[0] += body.slots.len() as u64;
    }
    sum.population[1] += group.particles.removed.particles;
    let epsilon = if size_of::<T>() == 4 {
        f64::from(f32::EPSILON)
    } else {
        f64::EPSILON
    };
    sum.rounding += epsilon * (ROUNDINGS[0] * stiff + ROUNDINGS[1] * size);
    Some(())
}
