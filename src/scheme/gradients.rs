//! The gradients that the terms and laws of a scheme ask for, as a list of terms.
//! What nothing asks for leaves no arithmetic behind.

use crate::effect::{Effect, Effects};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::term::{
    ArtificialViscosity, DensityGradient, Layout, MomentMatrix, Pair, PressureGradient, Sums, Term,
    TermUse, Terms, VelocityGradient,
};
use core::marker::PhantomData;

/// Fields that the sweep for gradients can give.
const GRADIENTS: Fields = Fields::of(&[
    Field::VELOCITY_GRADIENT,
    Field::PRESSURE_GRADIENT,
    Field::DENSITY_GRADIENT,
    Field::CORRECTION,
]);

/// Those of some fields that the sweep for gradients can give.
const fn gradients_among(fields: Fields) -> Fields {
    fields.minus(fields.minus(GRADIENTS))
}

/// The sums of all gradients that a viscosity `V`, a wall law `W` and effects `E` read, each once.
pub(super) struct Gradients<V, W, E>(PhantomData<(V, W, E)>);

impl<V, W, E> core::fmt::Debug for Gradients<V, W, E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Gradients")
    }
}

impl<V, W, E> Clone for Gradients<V, W, E> {
    fn clone(&self) -> Self {
        Self(PhantomData)
    }
}

impl<V, W, E> Gradients<V, W, E> {
    pub const NEW: Self = Self(PhantomData);

    /// What others than the artificial viscosity ask for.
    pub const fn of_others<const D: usize>() -> Fields
    where
        W: Effect<D>,
        E: Effects<D>,
    {
        gradients_among(W::NEEDS.union(E::READS))
    }

    /// What is asked for.
    pub const fn wanted<const D: usize>() -> Fields
    where
        V: ArtificialViscosity<D>,
        W: Effect<D>,
        E: Effects<D>,
    {
        Self::of_others::<D>().union(gradients_among(V::NEEDS))
    }
}

impl<const D: usize, V, W, E> Terms<D> for Gradients<V, W, E>
where
    V: ArtificialViscosity<D>,
    W: Effect<D>,
    E: Effects<D>,
{
    const READS: Fields = {
        let (wanted, mut reads) = (Self::wanted::<D>(), <MomentMatrix as Term<D>>::READS);
        if wanted.contains(Field::VELOCITY_GRADIENT) {
            reads = reads.union(<VelocityGradient as Term<D>>::READS);
        }
        if wanted.contains(Field::PRESSURE_GRADIENT) {
            reads = reads.union(<PressureGradient as Term<D>>::READS);
        }
        reads
    };
    const WRITES: Outputs = {
        let (wanted, mut writes) = (Self::wanted::<D>(), Outputs::of(&[Output::MOMENT_MATRIX]));
        if wanted.contains(Field::VELOCITY_GRADIENT) {
            writes = writes.union(Outputs::of(&[Output::VELOCITY_GRADIENT]));
        }
        if wanted.contains(Field::PRESSURE_GRADIENT) {
            writes = writes.union(Outputs::of(&[Output::PRESSURE_GRADIENT]));
        }
        if wanted.contains(Field::DENSITY_GRADIENT) {
            writes = writes.union(Outputs::of(&[Output::DENSITY_GRADIENT]));
        }
        writes
    };
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // Each of the first two sums the moment matrix, and the last one that of the liquid alone.
        if const { Self::wanted::<D>().contains(Field::DENSITY_GRADIENT) } {
            DensityGradient.pair(pair, sums);
        } else if const { Self::wanted::<D>().contains(Field::VELOCITY_GRADIENT) } {
            VelocityGradient.pair(pair, sums);
        } else {
            MomentMatrix.pair(pair, sums);
        }
        if const { Self::wanted::<D>().contains(Field::PRESSURE_GRADIENT) } {
            PressureGradient.pair(pair, sums);
        }
    }
    fn uses(&self) -> Vec<TermUse> {
        let wanted = Self::wanted::<D>();
        let first = if wanted.contains(Field::DENSITY_GRADIENT) {
            TermUse::of::<D, _>(&DensityGradient)
        } else if wanted.contains(Field::VELOCITY_GRADIENT) {
            TermUse::of::<D, _>(&VelocityGradient)
        } else {
            TermUse::of::<D, _>(&MomentMatrix)
        };
        let pressure = wanted.contains(Field::PRESSURE_GRADIENT);
        let pressure = pressure.then(|| TermUse::of::<D, _>(&PressureGradient));
        core::iter::once(first).chain(pressure).collect()
    }
}
