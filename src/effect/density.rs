//! Densities that follow from positions: by sums over neighbours, and with a smoothing length that follows.
//! Price 2012, section 2.3, for the last.

use super::{Chunk, DensityForm, Law, Rung, Tally};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;

/// Density from the kernel sum, and what contacts add to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SummedDensity(pub DensityForm);

impl SummedDensity {
    /// Whether sums are divided by the partition of unity.
    fn is_normalised(self) -> bool {
        matches!(self.0, DensityForm::Normalised | DensityForm::Lam)
    }
}

/// What particles know of themselves at rest, and of contacts, as far as the density form asks.
const AT_REST: [Field; 4] = [
    Field::REFERENCE_DENSITY,
    Field::REFERENCE_SUM,
    Field::CONSISTENCY_FACTOR,
    Field::CONTACT_THRESHOLD,
];

impl<T: Real, const D: usize> Law<T, D> for SummedDensity {
    fn name(&self) -> &'static str {
        "density from sums"
    }
    fn reads(&self) -> Fields {
        Fields::of(&AT_REST)
    }
    fn sums(&self) -> Outputs {
        let sums = Outputs::of(&[Output::KERNEL_SUM, Output::CONTACT_SUM]);
        if self.is_normalised() {
            sums.union(Outputs::of(&[Output::UNITY]))
        } else {
            sums
        }
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::DENSITY])
    }
    fn optional(&self) -> Fields {
        Fields::of(&AT_REST)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let [sums, contacts] = [Output::KERNEL_SUM, Output::CONTACT_SUM].map(|sum| chunk.sum(sum));
        let unity = self.is_normalised().then(|| chunk.sum(Output::UNITY));
        let ([rest, sum, moment, threshold], [density]) = chunk.columns(AT_REST, [Field::DENSITY]);
        let at = |column: &[T], n: usize| column.get(n).copied().unwrap_or(T::zero());
        for (n, density) in density.iter_mut().enumerate() {
            let (own, across) = (sums.get(0, n), contacts.get(0, n));
            let unity = || unity.map_or(T::one(), |sum| sum.get(0, n));
            *density = match self.0 {
                DensityForm::NumberDensity => {
                    // The other side of a contact compresses; it never pulls apart.
                    let pressed = (across - at(threshold, n)).positive_part();
                    let pressed = if threshold.is_empty() {
                        T::zero()
                    } else {
                        pressed
                    };
                    let compression = (own - at(sum, n) + pressed) / at(moment, n);
                    at(rest, n) * (T::one() + compression)
                }
                DensityForm::Normalised => (own + across) / unity(),
                DensityForm::Lam if at(sum, n) > T::zero() => (own + across) / unity(),
                _ => own + across,
            };
        }
        Tally::default()
    }
}

/// Marks particles that the other side of a contact presses against, in groups that have contacts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactActivity;

impl<T: Real, const D: usize> Law<T, D> for ContactActivity {
    fn name(&self) -> &'static str {
        "activity of contacts"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::CONTACT_THRESHOLD])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::CONTACT_SUM])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::CONTACT_ACTIVITY])
    }
    fn optional(&self) -> Fields {
        Fields::of(&[Field::CONTACT_THRESHOLD, Field::CONTACT_ACTIVITY])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let contacts = chunk.sum(Output::CONTACT_SUM);
        let ([threshold], [active]) =
            chunk.columns([Field::CONTACT_THRESHOLD], [Field::CONTACT_ACTIVITY]);
        for (n, (active, threshold)) in active.iter_mut().zip(threshold).enumerate() {
            let pressed = contacts.get(0, n) > *threshold;
            *active = if pressed { T::one() } else { T::zero() };
        }
        Tally::default()
    }
}

/// h = η (m/ρ)^(1/D) with ρ = Σ m W(h), by Newton's method (Price 2012, sect. 2.3), with the factors Ω of
/// grad-h terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolvedSmoothing {
    /// h/dx.
    pub eta: f64,
    /// Smallest and largest h in units of the first.
    pub limits: [f64; 2],
}

impl<T: Real, const D: usize> Law<T, D> for SolvedSmoothing {
    fn name(&self) -> &'static str {
        "smoothing consistent with density"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[
            Field::SMOOTHING_LENGTH,
            Field::DENSITY,
            Field::GRAD_H,
            Field::MASS,
        ])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::KERNEL_SUM, Output::SLOPE_IN_H])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::SMOOTHING_LENGTH, Field::DENSITY, Field::GRAD_H])
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Constraint)
    }
    fn repeats(&self) -> Option<(usize, f64)> {
        // What a step of Newton's method leaves is of the order of its square: less than 1e-6 of a density.
        Some((12, 1e-4))
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let [sums, slopes] = [Output::KERNEL_SUM, Output::SLOPE_IN_H].map(|sum| chunk.sum(sum));
        let eta = T::from_f64(self.eta);
        let [low, high] = self
            .limits
            .map(|limit| T::from_f64(limit * chunk.around.smoothing_length));
        let d = T::from_f64(D as f64);
        let ([mass], [h, density, omega]) = chunk.columns(
            [Field::MASS],
            [Field::SMOOTHING_LENGTH, Field::DENSITY, Field::GRAD_H],
        );
        let mut tally = Tally::default();
        for n in 0..h.len() {
            let h = &mut h[n];
            let summed = sums.get(0, n);
            // A particle counts itself: slots without a sum are of clusters that outlets have emptied, and stay as they are.
            if summed == T::zero() {
                continue;
            }
            let slope = slopes.get(0, n);
            let wanted = mass[n] * (eta / *h).powi(D as u32);
            // f = ρ(h) − m (η/h)^D and f′ = ∂ρ/∂h + D m η^D/h^(D+1).
            let step = (summed - wanted) / (slope + d * wanted / *h);
            let bounded = step.max(*h * T::from_f64(-0.5)).min(*h * T::from_f64(0.5));
            let next = (*h - bounded).max(low).min(high);
            let free = next > low && next < high;
            omega[n] = if free {
                T::one() + *h * slope / (d * summed)
            } else {
                T::one()
            };
            let change = ((next - *h) / *h).abs().to_f64();
            tally.change = tally.change.max(change);
            tally.limited += u64::from(!free);
            // The density at the new length, to the second order in the change.
            density[n] = summed + slope * (next - *h);
            *h = next;
        }
        tally
    }
}
