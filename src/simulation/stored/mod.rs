//! Stored energy, which is a function of the state, compared with the work that went into it.
//! Internal energy is integrated to balance the work of forces, so it cannot show energy that the time integration creates.

mod account;
mod measured;
mod parts;

pub(super) use account::EVERY;
pub(super) use account::Stores;

use super::Simulation;
use super::group::Group;
use super::population::BodyState;
use crate::collective::over;
use crate::output::table::significant;
use crate::particles::Field;
use crate::scalar::Real;
use core::fmt;
use measured::energies;

/// Energy that is stored by bodies and couplings, compared with what work and booked dissipation leave for it.
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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StoredPart {
    /// Its bodies, or the coupling and its bodies.
    pub name: String,
    /// How it stands, or why that cannot be said.
    pub balance: core::result::Result<StoredBalance, &'static str>,
}

/// Stored energy of a part and the work that went into it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Stored energy of bodies and couplings as a function of the state, compared with the work that went into it.
    #[must_use]
    pub fn stored_energy(&self) -> StoredEnergy {
        let stands = self.stands();
        let body = |(group, body): (&Group<T, D>, &BodyState<T>)| {
            let mass = group.particles.columns.raw(Field::MASS);
            let (stored, known) = over(body.slots.clone(), |slot| {
                let own = energies(group, body, slot);
                let stored = own.map_or(0.0, |[stored, _]| mass[slot].to_f64() * stored);
                (stored, own.is_some())
            });
            let said = stands && group.scheme.program.books_energy && known;
            (body.name.clone(), said.then_some(stored))
        };
        let part = |k: usize| {
            let measured = self.unsaid(k).map_or_else(|| self.measured(k), Err);
            let account = self.state.stores.accounts.get(k).and_then(Option::as_ref);
            let balance = measured.map(|own| {
                let gain = account.map_or(0.0, |account| own.gain(account.base));
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
            time: self.state.time,
            bodies: self.all_bodies().map(body).collect(),
            parts: self.stored_parts().map(part).collect(),
        }
    }

    /// Stops the run where stored energy exceeds what work and booked dissipation leave by more than this share of the
    /// largest energy supplied; 0.5 if not said, and infinity for never. See [`StoredEnergy`].
    pub fn limit_stored_energy(&mut self, share: f64) {
        self.on_both(&|own| own.state.stores.limit = share);
    }
}
