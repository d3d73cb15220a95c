//! Sums that make density: kernel sums, the moments that normalise them, and the rate of compression.
//! Gingold & Monaghan 1977; Randles & Libersky 1996; Bonet & Lok 1999.

use super::{Layout, Pair, Sums, Term, TermDoc};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// Sᵢ = Σⱼ Bⱼ Wᵢⱼ, the particle itself included.
#[derive(Clone, Copy, Debug)]
pub struct KernelSum;

impl<const D: usize> Term<D> for KernelSum {
    const NAME: &'static str = "meshfree::kernel_sum";
    const READS: Fields = Fields::of(&[Field::POSITION_RESIDUAL, Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[Output::KERNEL_SUM, Output::CONTACT_SUM]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        sums.add(Output::KERNEL_SUM, pair.j(Field::WEIGHT) * pair.w);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "kernel sum".into(),
            equation: "Sᵢ = Σⱼ Bⱼ Wᵢⱼ",
            source: "Gingold & Monaghan 1977; Lam, Shen & Gong 2002, eq. 18",
        }
    }
}

/// Σⱼ (Bⱼ/ρⱼ) Wᵢⱼ, which is one where the kernel finds a full neighbourhood.
#[derive(Clone, Copy, Debug)]
pub struct Unity;

impl<const D: usize> Term<D> for Unity {
    const NAME: &'static str = "meshfree::unity";
    const READS: Fields = Fields::of(&[Field::POSITION_RESIDUAL, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[Output::UNITY]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY);
        sums.add(Output::UNITY, volume * pair.w);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "partition of unity".into(),
            equation: "uᵢ = Σⱼ (mⱼ/ρⱼ) Wᵢⱼ",
            source: "Randles & Libersky 1996; Lam, Shen & Gong 2002, eq. 25",
        }
    }
}

/// Mᵢ = −Σⱼ Bⱼ rᵢⱼ·∇W / D, which a lattice makes differ from Sᵢ: the factor by which uncorrected
/// waves run too fast or too slow.
#[derive(Clone, Copy, Debug)]
pub struct KernelMoment;

impl<const D: usize> Term<D> for KernelMoment {
    const NAME: &'static str = "meshfree::kernel_moment";
    const READS: Fields = Fields::of(&[Field::POSITION_RESIDUAL, Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[Output::MOMENT]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let moment = pair.j(Field::WEIGHT) * pair.r2 * pair.f;
        sums.add(Output::MOMENT, -moment * L::of(1.0 / D as f64));
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "first moment of the kernel gradient".into(),
            equation: "Mᵢ = −Σⱼ Bⱼ rᵢⱼ·∇Wᵢⱼ / D",
            source: "trace of the moment matrix of Randles & Libersky 1996",
        }
    }
}

/// Σⱼ Bⱼ ∂W/∂h with ∂W/∂h = −(D W + r² F)/h, for smoothing lengths that follow the density.
#[derive(Clone, Copy, Debug)]
pub struct SlopeInH;

impl<const D: usize> Term<D> for SlopeInH {
    const NAME: &'static str = "meshfree::slope_in_h";
    const READS: Fields = Fields::of(&[Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[Output::SLOPE_IN_H]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let slope = pair.w.mul_add(L::of(D as f64), pair.r2 * pair.f_i);
        // What belongs to the row alone is divided once for all of its neighbours.
        let over_h = -pair.h_i.recip();
        sums.add_product(Output::SLOPE_IN_H, pair.j(Field::WEIGHT) * slope, over_h);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "slope of the kernel sum in h".into(),
            equation: "Σⱼ Bⱼ ∂W/∂h",
            source: "Springel & Hernquist 2002, eq. 4; Price 2012, eq. 27",
        }
    }
}

/// Σⱼ Bⱼ vᵢⱼ·∇W: the rate at which the neighbourhood closes in.
#[derive(Clone, Copy, Debug)]
pub struct Compression;

impl<const D: usize> Term<D> for Compression {
    const NAME: &'static str = "meshfree::compression";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[Output::COMPRESSION]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        sums.add_product(
            Output::COMPRESSION,
            pair.j(Field::WEIGHT) * pair.f,
            pair.v_dot_r,
        );
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "rate of compression".into(),
            equation: "−∇·v = Σⱼ Vⱼ vᵢⱼ·∇Wᵢⱼ / sᵢ",
            source: "Monaghan 1992, eq. 3.9; volume form for density ratios other than one",
        }
    }
}
