//! Couplings by forces as records for a device: what one does to two particles, its text followed once.
//! Friction has none: it remembers where its pairs have slid.

use super::{CoupledPair, CoupledParticle};
use crate::scalar::{Lane, Record, Traced, Unrecordable};

/// A coupling by forces, recorded. Its records are given the numbers of particles as [`CoupledParticle`] has them, field by field.
///
/// ```
/// use meshfree::coupling::{CoupledPair, CouplingRecord};
/// use meshfree::scalar::{Lane, Traced};
/// /// k (s − |r|) r/|r| for one pair or for a lane of them, which `Coupling::act` calls with scalars.
/// fn force<L: Lane, const D: usize>(pair: &CoupledPair<L, D>, stiffness: f64) -> [L; D] {
///     let r = pair.apart();
///     let distance = r.iter().fold(L::zero(), |sum, x| sum + *x * *x).sqrt();
///     r.map(|x| L::of(stiffness) * (pair.spacing() - distance) * x / distance)
/// }
/// let record = CouplingRecord::of::<2>(
///     |pair| (force(pair, 1e9), Traced::of(0.0)),
///     |on, from| Traced::of(0.5) * (on.mass.min(from.mass) / Traced::of(1e9)).sqrt(),
/// )?;
/// assert_eq!(record.act.results().len(), 3);
/// # Ok::<(), meshfree::scalar::Unrecordable>(())
/// ```
#[derive(Clone, Debug)]
pub struct CouplingRecord {
    /// [`Coupling::gather`](super::Coupling::gather) of two particles: the sum, and its gradient.
    pub gather: Option<Record>,
    /// [`Coupling::pressure`](super::Coupling::pressure) of a particle and the spacing: the pressure, and the energy.
    pub pressure: Option<Record>,
    /// [`Coupling::act`](super::Coupling::act) of two particles and their distance as built: the force, and the energy.
    pub act: Record,
    /// [`Coupling::step`](super::Coupling::step) of two particles.
    pub step: Record,
}

impl CouplingRecord {
    /// How many numbers a particle has.
    #[must_use]
    pub const fn width(d: usize) -> usize {
        3 * d + 6
    }

    /// The particle that numbers are.
    ///
    /// # Panics
    /// If there are fewer than [`width`](Self::width).
    #[must_use]
    pub fn particle<L: Lane, const D: usize>(numbers: &[L]) -> CoupledParticle<L, D> {
        let vector = |at: usize| core::array::from_fn(|d| numbers[at + d]);
        let at = 2 * D;
        CoupledParticle {
            position: vector(0),
            velocity: vector(D),
            mass: numbers[at],
            density: numbers[at + 1],
            spacing: numbers[at + 2],
            stiffness: numbers[at + 3],
            sum: numbers[at + 4],
            gradient: vector(at + 5),
            pressure: numbers[at + 5 + D],
        }
    }

    /// Of the force \[N\] of a pair with the energy that it stores \[J\], and of its largest stable step \[s\].
    ///
    /// # Errors
    /// As [`Record::of`].
    pub fn of<const D: usize>(
        act: impl FnOnce(&CoupledPair<Traced, D>) -> ([Traced; D], Traced),
        step: impl FnOnce(&CoupledParticle<Traced, D>, &CoupledParticle<Traced, D>) -> Traced,
    ) -> Result<Self, Unrecordable> {
        let width = Self::width(D);
        let act = Record::of(2 * width + 1, |x| {
            let (force, stored) = act(&CoupledPair {
                on: Self::particle(x),
                from: Self::particle(&x[width..]),
                rest: x[2 * width],
                anchor: None,
            });
            [&force[..], &[stored]].concat()
        })?;
        let step = Record::of(2 * width, |x| {
            vec![step(&Self::particle(x), &Self::particle(&x[width..]))]
        })?;
        Ok(Self {
            gather: None,
            pressure: None,
            act,
            step,
        })
    }

    /// The same of a coupling that [gathers](super::Coupling::gathers).
    ///
    /// # Errors
    /// As [`Record::of`].
    pub fn gathering<const D: usize>(
        self,
        gather: impl FnOnce(
            &CoupledParticle<Traced, D>,
            &CoupledParticle<Traced, D>,
        ) -> (Traced, [Traced; D]),
        pressure: impl FnOnce(&CoupledParticle<Traced, D>, Traced) -> (Traced, Traced),
    ) -> Result<Self, Unrecordable> {
        let width = Self::width(D);
        let gather = Record::of(2 * width, |x| {
            let (sum, gradient) = gather(&Self::particle(x), &Self::particle(&x[width..]));
            [&[sum], &gradient[..]].concat()
        })?;
        let pressure = Record::of(width + 1, |x| {
            let (pressure, stored) = pressure(&Self::particle(x), x[width]);
            vec![pressure, stored]
        })?;
        Ok(Self {
            gather: Some(gather),
            pressure: Some(pressure),
            ..self
        })
    }
}
