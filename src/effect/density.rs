//! Densities that follow from positions: by sums over neighbours, and with a smoothing length that follows.
//! Price 2012, section 2.3, for the last.

use super::{DensityForm, Point, PointLaw, Reach, Rung};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// Density from the kernel sum, and what contacts add to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SummedDensity(pub DensityForm);

/// What particles know of themselves at rest, and of contacts, as far as the density form asks.
const AT_REST: Fields = Fields::of(&[
    Field::REFERENCE_DENSITY,
    Field::REFERENCE_SUM,
    Field::CONSISTENCY_FACTOR,
    Field::CONTACT_THRESHOLD,
]);

impl<const D: usize> PointLaw<D> for SummedDensity {
    const NAME: &'static str = "density from sums";
    const READS: Fields = AT_REST;
    const WRITES: Fields = Fields::of(&[Field::DENSITY]);
    const SUMS: Outputs = Outputs::of(&[Output::KERNEL_SUM, Output::CONTACT_SUM, Output::UNITY]);
    const OPTIONAL: Fields = AT_REST;
    fn summed(&self) -> Outputs {
        // Whether sums are divided by the partition of unity.
        match self.0 {
            DensityForm::Normalised | DensityForm::Lam => <Self as PointLaw<D>>::SUMS,
            _ => Outputs::of(&[Output::KERNEL_SUM, Output::CONTACT_SUM]),
        }
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (own, across) = (at.sum(Output::KERNEL_SUM), at.sum(Output::CONTACT_SUM));
        let [rest, sum, moment, threshold] = [
            at.get(Field::REFERENCE_DENSITY),
            at.get(Field::REFERENCE_SUM),
            at.get(Field::CONSISTENCY_FACTOR),
            at.get(Field::CONTACT_THRESHOLD),
        ];
        let density = match self.0 {
            DensityForm::NumberDensity => {
                // The other side of a contact compresses; it never pulls apart.
                let pressed = if at.has(Field::CONTACT_THRESHOLD) {
                    (across - threshold).positive_part()
                } else {
                    L::zero()
                };
                rest * (L::one() + (own - sum + pressed) / moment)
            }
            DensityForm::Normalised => (own + across) / at.sum(Output::UNITY),
            DensityForm::Lam => {
                let normalised = (own + across) / at.sum(Output::UNITY);
                L::select(sum.gt(L::zero()), normalised, own + across)
            }
            _ => own + across,
        };
        at.set(Field::DENSITY, density);
    }
}

/// Marks particles that the other side of a contact presses against, in groups that have contacts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactActivity;

impl<const D: usize> PointLaw<D> for ContactActivity {
    const NAME: &'static str = "activity of contacts";
    const READS: Fields = Fields::of(&[Field::CONTACT_THRESHOLD]);
    const WRITES: Fields = Fields::of(&[Field::CONTACT_ACTIVITY]);
    const SUMS: Outputs = Outputs::of(&[Output::CONTACT_SUM]);
    const OPTIONAL: Fields = Fields::of(&[Field::CONTACT_THRESHOLD, Field::CONTACT_ACTIVITY]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let pressed = at
            .sum(Output::CONTACT_SUM)
            .gt(at.get(Field::CONTACT_THRESHOLD));
        at.set(
            Field::CONTACT_ACTIVITY,
            L::select(pressed, L::one(), L::zero()),
        );
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

impl<const D: usize> PointLaw<D> for SolvedSmoothing {
    const NAME: &'static str = "smoothing consistent with density";
    const READS: Fields = <Self as PointLaw<D>>::WRITES.union(Fields::of(&[Field::MASS]));
    const WRITES: Fields = Fields::of(&[Field::SMOOTHING_LENGTH, Field::DENSITY, Field::GRAD_H]);
    const SUMS: Outputs = Outputs::of(&[Output::KERNEL_SUM, Output::SLOPE_IN_H]);
    const RUNG: Option<Rung> = Some(Rung::Constraint);
    fn repeated(&self) -> Option<(usize, f64)> {
        // What a step of Newton's method leaves is of the order of its square: less than 1e-6 of a density.
        Some((12, 1e-4))
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (summed, slope) = (at.sum(Output::KERNEL_SUM), at.sum(Output::SLOPE_IN_H));
        let (h, d) = (at.get(Field::SMOOTHING_LENGTH), L::of(D as f64));
        let [low, high] = self
            .limits
            .map(|limit| L::of(limit * at.around.smoothing_length));
        let wanted = at.get(Field::MASS) * (L::of(self.eta) / h).powi(D as u32);
        // f = ρ(h) − m (η/h)^D and f′ = ∂ρ/∂h + D m η^D/h^(D+1).
        let step = (summed - wanted) / (slope + d * wanted / h);
        let bounded = step.max(h * L::of(-0.5)).min(h * L::of(0.5));
        let next = (h - bounded).max(low).min(high);
        let free = next.gt(low) & next.lt(high);
        let omega = L::select(free, L::one() + h * slope / (d * summed), L::one());
        // The density at the new length, to the second order in the change.
        let density = summed + slope * (next - h);
        // A particle counts itself: slots without a sum are of clusters that outlets have emptied, and stay as they are.
        let empty = summed.le(L::zero()) & summed.ge(L::zero());
        let change = ((next - h) / h).abs();
        at.changed(L::select(empty, L::zero(), change));
        at.limited(!(free | empty));
        let [was, omega_was] = [at.get(Field::DENSITY), at.get(Field::GRAD_H)];
        at.set(Field::GRAD_H, L::select(empty, omega_was, omega));
        at.set(Field::DENSITY, L::select(empty, was, density));
        at.set(Field::SMOOTHING_LENGTH, L::select(empty, h, next));
    }
}
