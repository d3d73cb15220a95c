//! What a term sees of a pair of particles, with the numbers that the terms of a sweep may read and sum.
//! There is room for what the terms of one sweep read and write together, which is known at compile time.

use crate::particles::{Field, Fields, Outputs, Shape};
use crate::scalar::Lane;
use crate::tensor::Symmetric;
use core::marker::PhantomData;

/// Most numbers that the terms of a sweep can read of a particle.
///
/// A sweep that reads more does not compile. Here x takes three and each symmetric tensor six:
///
/// ```
/// # use meshfree::kernel::CubicSpline;
/// # use meshfree::name;
/// # use meshfree::particles::{Field, Fields, Name, Outputs};
/// # use meshfree::scalar::Lane;
/// # use meshfree::sweep::{FusedKernel, PairSweep};
/// # use meshfree::term::{Layout, Pair, Sums, Term, TermDoc};
/// # #[derive(Clone, Debug)]
/// # struct Reads<const TENSORS: usize>;
/// # impl<const TENSORS: usize> Term<3> for Reads<TENSORS> {
/// #     const NAME: &'static str = "meshfree::reads";
/// #     const READS: Fields = {
/// #         const NAMES: [&Name; 11] = [
/// #             name!("0", ""), name!("1", ""), name!("2", ""), name!("3", ""), name!("4", ""), name!("5", ""),
/// #             name!("6", ""), name!("7", ""), name!("8", ""), name!("9", ""), name!("10", ""),
/// #         ];
/// #         let (mut fields, mut k) = (Fields::NONE, 0);
/// #         while k < TENSORS {
/// #             fields = fields.union(Fields::of(&[Field::tensor(NAMES[k])]));
/// #             k += 1;
/// #         }
/// #         fields
/// #     };
/// #     const WRITES: Outputs = Outputs::NONE;
/// #     fn pair<L: Lane, P: Layout>(&self, _: &Pair<'_, L, 3, P>, _: &mut Sums<L, 3, P>) {}
/// #     fn document(&self) -> TermDoc {
/// #         TermDoc { name: "tensors".into(), equation: "", source: "" }
/// #     }
/// # }
/// let sweep: &dyn PairSweep<f64, 3> =
///     &FusedKernel::<_, _>::new(CubicSpline, (Reads::<10>,));
/// assert_eq!(sweep.fields().width(3), 3 + 10 * 6);
/// ```
/// ```compile_fail
/// # use meshfree::kernel::CubicSpline;
/// # use meshfree::name;
/// # use meshfree::particles::{Field, Fields, Name, Outputs};
/// # use meshfree::scalar::Lane;
/// # use meshfree::sweep::{FusedKernel, PairSweep};
/// # use meshfree::term::{Layout, Pair, Sums, Term, TermDoc};
/// # #[derive(Clone, Debug)]
/// # struct Reads<const TENSORS: usize>;
/// # impl<const TENSORS: usize> Term<3> for Reads<TENSORS> {
/// #     const NAME: &'static str = "meshfree::reads";
/// #     const READS: Fields = {
/// #         const NAMES: [&Name; 11] = [
/// #             name!("0", ""), name!("1", ""), name!("2", ""), name!("3", ""), name!("4", ""), name!("5", ""),
/// #             name!("6", ""), name!("7", ""), name!("8", ""), name!("9", ""), name!("10", ""),
/// #         ];
/// #         let (mut fields, mut k) = (Fields::NONE, 0);
/// #         while k < TENSORS {
/// #             fields = fields.union(Fields::of(&[Field::tensor(NAMES[k])]));
/// #             k += 1;
/// #         }
/// #         fields
/// #     };
/// #     const WRITES: Outputs = Outputs::NONE;
/// #     fn pair<L: Lane, P: Layout>(&self, _: &Pair<'_, L, 3, P>, _: &mut Sums<L, 3, P>) {}
/// #     fn document(&self) -> TermDoc {
/// #         TermDoc { name: "tensors".into(), equation: "", source: "" }
/// #     }
/// # }
/// let sweep: &dyn PairSweep<f64, 3> =
///     &FusedKernel::<_, _>::new(CubicSpline, (Reads::<11>,));
/// assert_eq!(sweep.fields().width(3), 3 + 11 * 6);
/// ```
pub const MOST_READS: usize = 64;
/// Most numbers that the sums of a sweep can hold; one that holds more does not compile.
pub const MOST_SUMS: usize = 72;

/// Fails to compile where the numbers of a sweep have no room.
pub(crate) const fn assert_room<P: Layout, const D: usize>() {
    assert!(
        P::READS.is_sound() && P::WRITES.is_sound(),
        "the terms of this sweep have too many fields or sums of effects, or two of one name"
    );
    assert!(
        P::READS.width(D) <= MOST_READS,
        "the terms of this sweep read more numbers of a particle than `meshfree::term::MOST_READS`"
    );
    assert!(
        P::WRITES.width(D) <= MOST_SUMS,
        "the terms of this sweep make more sums than `meshfree::term::MOST_SUMS` numbers"
    );
}

/// What the terms of one sweep read and write together; known at compile time.
pub trait Layout: 'static {
    /// The fields in the packed record of a particle.
    const READS: Fields;
    /// The sums that are kept.
    const WRITES: Outputs;
    /// Whether both particles of a pair have the same gradient factor, because one smoothing length serves both.
    const ONE_GRADIENT: bool = false;
}

/// A pair (i, j), or a row of pairs with the same j.
///
/// The gradient of the kernel at i is ∇ᵢWᵢⱼ = F rᵢⱼ with F ≤ 0 and rᵢⱼ = xᵢ − xⱼ. F and W vanish
/// beyond the support, so a term that is a multiple of one of them needs no mask. At rᵢⱼ = 0 (the
/// particle itself) everything is finite.
#[derive(Debug)]
pub struct Pair<'a, L: Lane, const D: usize, P: Layout> {
    /// Separation rᵢⱼ = xᵢ − xⱼ \[m\].
    pub r: [L; D],
    /// Squared distance \[m²\].
    pub r2: L,
    /// Relative velocity vᵢⱼ = vᵢ − vⱼ \[m/s\]; zero if no term reads velocities.
    pub v: [L; D],
    /// vᵢⱼ·rᵢⱼ \[m²/s\].
    pub v_dot_r: L,
    /// Mean smoothing length of the pair \[m\].
    pub h: L,
    /// Smoothing length of i \[m\].
    pub h_i: L,
    /// Kernel W \[m⁻ᴰ\]; with the smoothing length of i where it follows the density.
    pub w: L,
    /// Kernel W \[m⁻ᴰ\] as seen from j: with the smoothing length of j where it follows the density.
    pub w_j: L,
    /// Gradient factor F \[m⁻ᴰ⁻²\] of the pair: the mean of the next two.
    pub f: L,
    /// Gradient factor F \[m⁻ᴰ⁻²\] as seen from i: with its smoothing length where that follows the
    /// density, and zero across a contact that i does not touch.
    pub f_i: L,
    /// Gradient factor F \[m⁻ᴰ⁻²\] as seen from j.
    pub f_j: L,
    /// One where j moves by forces, zero where it belongs to a wall.
    pub mobile: L,
    /// One where i moves by forces, zero where it belongs to a wall.
    pub mobile_i: L,
    /// The acceleration \[m/s²\] that acts on all particles, in the frame of their container.
    pub body_force: [L; D],
    /// First moment −Σ V r·∇W/D of the lattice, for terms that are divided by it; one in schemes whose
    /// particles carry their own.
    pub lattice_consistency_factor: L,
    /// Whether gradient factors are those of a contact, which differ for the two.
    pub(crate) gated: bool,
    /// Whether i is the one that a row meets, and j the row.
    pub(crate) swapped: bool,
    /// The record of the row, which is i unless they are swapped.
    pub(crate) i: &'a [L; MOST_READS],
    /// The record of the one that it meets.
    pub(crate) j: &'a [L::Broadcast],
    pub(crate) layout: PhantomData<P>,
}

impl<L: Lane, const D: usize, P: Layout> Pair<'_, L, D, P> {
    /// The pair as j sees it, which has the smoothing length and the kernel that are given.
    #[inline(always)]
    pub(crate) fn swapped(&self, h_j: L, w_j: L) -> Self {
        // Loops, for a closure would be compiled without wide instructions.
        let (mut r, mut v) = (self.r, self.v);
        for d in 0..D {
            (r[d], v[d]) = (-r[d], -v[d]);
        }
        Self {
            r,
            v,
            h_i: h_j,
            w: w_j,
            w_j: self.w,
            f_i: self.f_j,
            f_j: self.f_i,
            mobile: self.mobile_i,
            mobile_i: self.mobile,
            swapped: !self.swapped,
            ..*self
        }
    }
    /// A number of the row's record, or of the one that it meets.
    #[inline(always)]
    fn number(&self, at: usize, of_one: bool) -> L {
        if of_one {
            L::broadcast(self.j[at])
        } else {
            self.i[at]
        }
    }
    /// The pair as its first side sees it. A sweep may sum a pair for both sides when it meets it; what only changes its sign
    /// between them, and is dear, a term takes from here and hands to [`from_forward`](Self::from_forward): it is then made once.
    ///
    /// A method and not a function that takes one, because what is not inlined runs without wide instructions.
    #[inline(always)]
    #[must_use]
    pub fn forward(&self) -> Self {
        if self.swapped {
            self.swapped(self.h_i, self.w_j)
        } else {
            Self { ..*self }
        }
    }
    /// A quantity of the pair from that of [`forward`](Self::forward), with the opposite sign if that is the other side.
    #[inline(always)]
    #[must_use]
    pub fn from_forward(&self, antisymmetric: L) -> L {
        if self.swapped {
            -antisymmetric
        } else {
            antisymmetric
        }
    }
    /// A scalar field of i. The field must be among the term's `READS`.
    #[inline(always)]
    #[must_use]
    pub fn i(&self, field: Field) -> L {
        self.i_at(field, 0)
    }
    /// A scalar field of j.
    #[inline(always)]
    #[must_use]
    pub fn j(&self, field: Field) -> L {
        self.j_at(field, 0)
    }
    /// Component `k` of a vector or matrix field of i.
    #[inline(always)]
    #[must_use]
    pub fn i_at(&self, field: Field, k: usize) -> L {
        debug_assert!(const { &P::READS }.contains(field));
        self.number(const { &P::READS }.offset(field, D) + k, self.swapped)
    }
    /// Component `k` of a vector or matrix field of j.
    #[inline(always)]
    #[must_use]
    pub fn j_at(&self, field: Field, k: usize) -> L {
        debug_assert!(const { &P::READS }.contains(field));
        self.number(const { &P::READS }.offset(field, D) + k, !self.swapped)
    }
    /// A symmetric tensor of i.
    #[inline(always)]
    #[must_use]
    pub fn i_tensor(&self, field: Field) -> Symmetric<L> {
        debug_assert!(field.shape() == Shape::Tensor);
        let mut tensor = [L::zero(); 6];
        for k in 0..6 {
            tensor[k] = self.i_at(field, k);
        }
        Symmetric::new(tensor)
    }
    /// A symmetric tensor of j.
    #[inline(always)]
    #[must_use]
    pub fn j_tensor(&self, field: Field) -> Symmetric<L> {
        debug_assert!(field.shape() == Shape::Tensor);
        let mut tensor = [L::zero(); 6];
        for k in 0..6 {
            tensor[k] = self.j_at(field, k);
        }
        Symmetric::new(tensor)
    }
    /// Separation Xᵢⱼ = Xᵢ − Xⱼ \[m\] in the reference configuration, of which kernel and gradient factor are where a term
    /// reads [`Field::REFERENCE_POSITION`]: ∇₀W = F Xᵢⱼ.
    #[inline(always)]
    #[must_use]
    pub fn reference(&self) -> [L; D] {
        let mut apart = [L::zero(); D];
        for d in 0..D {
            apart[d] =
                self.i_at(Field::REFERENCE_POSITION, d) - self.j_at(Field::REFERENCE_POSITION, d);
        }
        apart
    }
    /// The weight gᵢ of gradients that are exact for linear fields, Gᵢ = Cᵢ gᵢ rᵢⱼ with the [inverse](Field::CORRECTION) Cᵢ of
    /// −Σⱼ Vⱼ gᵢ rᵢⱼ ⊗ rᵢⱼ, as i sees it; of its scale nothing depends, for that cancels.
    ///
    /// It is F, and −W with the particle's own smoothing length where this follows the density: the integral approach of
    /// García-Senz, Cabezón & Escartín (2012). A kernel weighs near neighbours more than its slope does:
    /// on Gresho's vortex that takes a fifth off the error ([hard cases](crate#pages)).
    #[inline(always)]
    #[must_use]
    pub fn weight_i(&self) -> L {
        if const { P::ONE_GRADIENT } {
            self.f_i
        } else {
            -self.w
        }
    }
    /// The weight gⱼ as j sees it.
    #[inline(always)]
    #[must_use]
    pub fn weight_j(&self) -> L {
        if const { P::ONE_GRADIENT } {
            self.f_j
        } else {
            -self.w_j
        }
    }
    /// The weight of sums of gradients: that of the row, or F of the pair where both have one.
    #[inline(always)]
    #[must_use]
    pub(crate) fn weight(&self) -> L {
        if const { P::ONE_GRADIENT } {
            self.f
        } else {
            -self.w
        }
    }
    /// Vᵢ Vⱼ \[m²ᴰ\], each a quotient of its own, so that it is made once a row and once a neighbour.
    #[inline(always)]
    #[must_use]
    pub fn volumes(&self) -> L {
        self.i(Field::MASS) / self.i(Field::DENSITY)
            * (self.j(Field::MASS) / self.j(Field::DENSITY))
    }
    /// vᵢⱼ·vᵢⱼ \[m²/s²\].
    #[inline(always)]
    #[must_use]
    pub fn v2(&self) -> L {
        // A loop, because a closure may be compiled without the instructions of the pair loop.
        let mut sum = self.v[0] * self.v[0];
        for d in 1..D {
            sum = self.v[d].mul_add(self.v[d], sum);
        }
        sum
    }
}
