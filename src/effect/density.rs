//! Densities that follow from positions: by sums over neighbours, and with a smoothing length that follows.
//! Price 2012, section 2.3, for the last.

use super::{Chunk, DensityForm, Law, Tally};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;

/// Density from the kernel sum, and what contacts add to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SummedDensity(pub DensityForm);

impl<T: Real, const D: usize> Law<T, D> for SummedDensity {
    fn name(&self) -> &'static str {
        "density from sums"
    }
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::KERNEL_SUM])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::DENSITY])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let (sums, first) = (chunk.around.sums, chunk.first);
        let [density, rest, sum, moment, threshold] = chunk.columns([
            Field::DENSITY,
            Field::REFERENCE_DENSITY,
            Field::REFERENCE_SUM,
            Field::CONSISTENCY_FACTOR,
            Field::CONTACT_THRESHOLD,
        ]);
        let at = |column: &[T], n: usize| column.get(n).copied().unwrap_or(T::zero());
        for (n, density) in density.iter_mut().enumerate() {
            let slot = first + n;
            let own = sums.get(Output::KERNEL_SUM, 0, slot);
            let across = sums.get(Output::CONTACT_SUM, 0, slot);
            let unity = || sums.get(Output::UNITY, 0, slot);
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
        Fields::NONE
    }
    fn writes(&self) -> Fields {
        Fields::NONE
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let (sums, first) = (chunk.around.sums, chunk.first);
        let [active, threshold] =
            chunk.columns([Field::CONTACT_ACTIVITY, Field::CONTACT_THRESHOLD]);
        for (n, (active, threshold)) in active.iter_mut().zip(threshold).enumerate() {
            let pressed = sums.get(Output::CONTACT_SUM, 0, first + n) > *threshold;
            *active = if pressed { T::one() } else { T::zero() };
        }
        Tally::default()
    }
}

/// h = η (m/ρ)^(1/D) with ρ = Σ m W(h), by Newton's method (Price 2012, sect. 2.3), with the factors Ω of
/// grad-h terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConsistentSmoothing {
    /// h/dx.
    pub eta: f64,
    /// Smallest and largest h in units of the first.
    pub limits: [f64; 2],
}

impl<T: Real, const D: usize> Law<T, D> for ConsistentSmoothing {
    fn name(&self) -> &'static str {
        "smoothing consistent with density"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::MASS])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::KERNEL_SUM, Output::SLOPE_IN_H])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::SMOOTHING_LENGTH, Field::DENSITY, Field::GRAD_H])
    }
    fn repeats(&self) -> Option<(usize, f64)> {
        // What a step of Newton's method leaves is of the order of its square: less than 1e-6 of a density.
        Some((12, 1e-4))
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let (sums, first) = (chunk.around.sums, chunk.first);
        let eta = T::from_f64(self.eta);
        let [low, high] = self
            .limits
            .map(|limit| T::from_f64(limit * chunk.around.smoothing_length));
        let d = T::from_f64(D as f64);
        let [h, density, mass, omega] = chunk.columns([
            Field::SMOOTHING_LENGTH,
            Field::DENSITY,
            Field::MASS,
            Field::GRAD_H,
        ]);
        let mut tally = Tally::default();
        for n in 0..h.len() {
            let h = &mut h[n];
            let summed = sums.get(Output::KERNEL_SUM, 0, first + n);
            // A particle counts itself: slots without a sum are of clusters that outlets have emptied, and stay as they are.
            if summed == T::zero() {
                continue;
            }
            let slope = sums.get(Output::SLOPE_IN_H, 0, first + n);
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
