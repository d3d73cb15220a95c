//! The pressure force of a scheme and the gradients that its terms ask for, as lists of terms.
//! What the type of a scheme rules out leaves no arithmetic behind.

use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;
use crate::term::{
    ArtificialViscosity, Compression, DensityGradient, Layout, MidpointReconstruction,
    MomentMatrix, Pair, PressureForce, PressureGradient, RenormalisedCompression,
    RenormalisedPressureForce, Sums, Term, TermDoc, Terms, VelocityGradient, not_empty,
};
use core::marker::PhantomData;

/// Pressure at the middle of a pair is reconstructed.
pub const MIDPOINT: u8 = 1;
/// Gradients of force and compression are renormalised.
pub const RENORMALISED: u8 = 2;
/// Internal energy is carried.
pub const ENERGY: u8 = 4;
/// Kernels are those of the reference configuration, and forces follow from stresses of effects alone.
pub const REFERENCE: u8 = 8;

/// The pressure force.
#[derive(Clone, Debug)]
pub(super) struct Pressure<const FLAGS: u8> {
    pub curvature: MidpointReconstruction,
}

impl<const D: usize, const FLAGS: u8> Terms<D> for Pressure<FLAGS> {
    const READS: Fields = {
        let own = if FLAGS & RENORMALISED != 0 {
            <RenormalisedPressureForce as Term<D>>::READS
        } else {
            <PressureForce as Term<D>>::READS
        };
        if FLAGS & MIDPOINT != 0 {
            own.union(<MidpointReconstruction as Term<D>>::READS)
        } else {
            own
        }
    };
    const WRITES: Outputs = Outputs::of(&[Output::FORCE]);
    not_empty!(D);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        if const { FLAGS & RENORMALISED != 0 } {
            RenormalisedPressureForce.pair(pair, sums);
        } else {
            PressureForce.pair(pair, sums);
        }
        if const { FLAGS & MIDPOINT != 0 } {
            self.curvature.pair(pair, sums);
        }
    }
    fn document(&self) -> Vec<TermDoc> {
        let mut documents = vec![if FLAGS & RENORMALISED != 0 {
            Term::<D>::document(&RenormalisedPressureForce)
        } else {
            Term::<D>::document(&PressureForce)
        }];
        if FLAGS & MIDPOINT != 0 {
            documents.push(Term::<D>::document(&self.curvature));
        }
        documents
    }
}

/// The rate of compression.
#[derive(Clone, Debug)]
pub(super) struct Rate<const FLAGS: u8>;

impl<const D: usize, const FLAGS: u8> Term<D> for Rate<FLAGS> {
    const READS: Fields = if FLAGS & RENORMALISED != 0 {
        <RenormalisedCompression as Term<D>>::READS
    } else {
        <Compression as Term<D>>::READS
    };
    const WRITES: Outputs = Outputs::of(&[Output::COMPRESSION]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        if const { FLAGS & RENORMALISED != 0 } {
            RenormalisedCompression.pair(pair, sums);
        } else {
            Compression.pair(pair, sums);
        }
    }
    fn document(&self) -> TermDoc {
        if FLAGS & RENORMALISED != 0 {
            Term::<D>::document(&RenormalisedCompression)
        } else {
            Term::<D>::document(&Compression)
        }
    }
}

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

/// The sums of all gradients that the terms of a scheme read, each once.
pub(super) struct Gradients<V, N, const FLAGS: u8>(PhantomData<fn() -> (V, N)>);

impl<V, N, const FLAGS: u8> core::fmt::Debug for Gradients<V, N, FLAGS> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Gradients")
    }
}

impl<V, N, const FLAGS: u8> Clone for Gradients<V, N, FLAGS> {
    fn clone(&self) -> Self {
        Self(PhantomData)
    }
}

/// What the terms and laws of walls and effects read, as a type.
pub(super) trait Needs: 'static {
    const NEEDS: Fields;
}

impl<V: 'static, N: Needs, const FLAGS: u8> Gradients<V, N, FLAGS> {
    pub const NEW: Self = Self(PhantomData);

    /// What others than the artificial viscosity ask for.
    pub const fn of_others<const D: usize>() -> Fields {
        let force = <Pressure<FLAGS> as Terms<D>>::READS;
        gradients_among(N::NEEDS.union(force))
    }

    /// What is asked for.
    pub const fn wanted<const D: usize>() -> Fields
    where
        V: ArtificialViscosity<D>,
    {
        Self::of_others::<D>().union(gradients_among(V::NEEDS))
    }
}

impl<const D: usize, V, N, const FLAGS: u8> Terms<D> for Gradients<V, N, FLAGS>
where
    V: ArtificialViscosity<D>,
    N: Needs,
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
    not_empty!(D);
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
    fn document(&self) -> Vec<TermDoc> {
        let wanted = Self::wanted::<D>();
        let mut documents = Vec::new();
        if wanted.contains(Field::DENSITY_GRADIENT) {
            documents.push(Term::<D>::document(&DensityGradient));
        } else if wanted.contains(Field::VELOCITY_GRADIENT) {
            documents.push(Term::<D>::document(&VelocityGradient));
        } else {
            documents.push(Term::<D>::document(&MomentMatrix));
        }
        if wanted.contains(Field::PRESSURE_GRADIENT) {
            documents.push(Term::<D>::document(&PressureGradient));
        }
        documents
    }
}
