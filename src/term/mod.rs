//! Pair terms: one effect a file, each with its equation, its source, and the fields it touches.
//! A term adds to the sums of a pair; the sweep applies directions, so a tuple costs what fused code costs.
//!
//! A [`Term`] names the fields that it reads and the sums that it writes as constants. A particle
//! carries the union of what the terms of its scheme name, and nothing else. A tuple of terms is a list
//! that shares one loop over pairs.
//!
//! | term | equation of | makes |
//! |---|---|---|
//! | [`KernelSum`], [`Unity`], [`KernelMoment`], [`SlopeInH`] | density | sums that density is made of |
//! | [`Compression`] | density | rate of compression |
//! | [`VelocityGradient`], [`PressureGradient`] | – | gradients for viscosities and curvature |
//! | [`PressureForce`], [`MidpointReconstruction`] | momentum | force |
//! | [`Viscosity`] | momentum | force and signal of an [artificial viscosity](viscosity) |
//! | [`InternalEnergy`] | energy | half the power of all forces |
//! | [`RenormalisedPressureForce`], [`RenormalisedCompression`] | momentum, density | the same with corrected gradients |
//! | [`LaminarViscosity`], [`CentralViscosity`] | momentum | force of a physical viscosity |
//! | [`Molteni`], [`Fourtakas`], [`Antuono`], [`RiemannDiffusion`] | density | diffusion against noise |
//! | [`ConcentrationGradient`] | position | what shifting needs |
//! | [`LiquidNearWall`], [`VelocityAtWall`], [`ViscosityAtWall`] | walls | what wall particles take from the liquid |
//!
//! [`probe()`] evaluates a term for one pair, for tests of terms of your own.
//!
//! A force is set as its component along rᵢⱼ or along vᵢⱼ, which must be symmetric in i and j, or as a vector
//! ([`FreeForce`]), which must change its sign with them. Then it is opposite for the two, and the scheme
//! conserves momentum; angular momentum too where it lies along rᵢⱼ.
//!
//! # Artificial viscosity
//!
//! A viscosity is a term of fixed form, of which only Π differs:
//!
#![doc = include_str!("../../docs/equations/viscous_force.html")]
//!
//! The law of Monaghan & Gingold,
//!
#![doc = include_str!("../../docs/equations/monaghan_gingold.html")]
//!
//! acts wherever particles approach, in a smooth compression too. The limited form leaves it only the
//! jump that linear reconstruction from both sides does not explain:
//!
#![doc = include_str!("../../docs/equations/limited_jump.html")]
//!
//! Other laws let α follow the flow of each particle, as Morris & Monaghan do:
//!
#![doc = include_str!("../../docs/equations/morris_monaghan.html")]
//!
//! # A viscosity of one's own
//!
//! ```
//! use meshfree::particles::{Field, Fields};
//! use meshfree::prelude::*;
//! use meshfree::term::{Layout, Pair, TermDoc, Viscous};
//!
//! /// The quadratic law of von Neumann & Richtmyer, Π = β μ²/ρ̄ for approaching pairs.
//! #[derive(Clone, Debug)]
//! struct Quadratic {
//!     beta: f64,
//! }
//!
//! impl<const D: usize> ArtificialViscosity<D> for Quadratic {
//!     const READS: Fields = Fields::NONE;
//!     #[inline(always)]
//!     fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
//!         let approach = (-pair.v_dot_r).positive_part();
//!         let mu = pair.h * approach / pair.h.mul_add(pair.h * L::of(0.01), pair.r2);
//!         let density = (pair.i(Field::DENSITY) + pair.j(Field::DENSITY)) * L::of(0.5);
//!         Viscous {
//!             pi: mu * mu * L::of(self.beta) / density,
//!             signal: mu * L::of(0.6 * self.beta),
//!         }
//!     }
//!     fn document(&self) -> TermDoc {
//!         TermDoc {
//!             name: format!("quadratic viscosity, β = {}", self.beta),
//!             equation: "Π = β μ²/ρ̄, μ = h |v·r|/(r² + 0.01 h²), v·r < 0",
//!             source: "von Neumann & Richtmyer 1950",
//!         }
//!     }
//! }
//!
//! let scheme = SchemeBuilder::new(CubicSpline, Quadratic { beta: 2.0 })
//!     .density(DensityForm::NumberDensity);
//! let mut simulation = Scene::<f64, 1>::new(scheme)
//!     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//!     .boundary(MirrorPlane::wall([0.01], [1.0]))
//!     .build()?;
//! simulation.run_until(2e-7)?;
//! assert!(simulation.scheme().to_string().contains("quadratic viscosity, β = 2"));
//! # Ok::<(), Error>(())
//! ```

use crate::particles::{Field, Fields, Output, Outputs, Shape};
use crate::scalar::Lane;
use crate::tensor::Symmetric;
use core::fmt::Debug;
use core::marker::PhantomData;

mod concentration;
mod density_diffusion;
mod force;
mod gradient;
mod laminar_viscosity;
mod momentum;
mod probe;
mod renormalised;
mod staged;
mod stages;
mod sums;
pub mod viscosity;
mod wall;

pub use concentration::{ConcentrationGradient, Nothing};
pub use density_diffusion::{Antuono, Fourtakas, Molteni, RiemannDiffusion, STANDARD_DELTA};
pub use force::{Along, FreeForce};
pub use gradient::{DensityGradient, MomentMatrix, PressureGradient, VelocityGradient};
pub use laminar_viscosity::{CentralViscosity, LaminarViscosity};
pub use momentum::{InternalEnergy, MidpointReconstruction, PressureForce};
pub use probe::{Probe, probe};
pub use renormalised::{RenormalisedCompression, RenormalisedPressureForce};
pub use staged::{In, Join, StageMarker, StagedTerms, stage};
pub use stages::Stage;
pub use sums::{Compression, KernelMoment, KernelSum, SlopeInH, Unity};
pub use viscosity::{ArtificialViscosity, Viscosity, Viscous};
pub use wall::{LiquidNearWall, VelocityAtWall, ViscosityAtWall};

/// Most numbers that the terms of a sweep can read of a particle.
///
/// A sweep that reads more does not compile. Here x takes three and each symmetric tensor six:
///
/// ```
/// # use meshfree::kernel::CubicSpline;
/// # use meshfree::particles::{Field, Fields, Outputs};
/// # use meshfree::scalar::Lane;
/// # use meshfree::sweep::{PairSweep, FusedKernel, SmoothingMode};
/// # use meshfree::term::{Layout, Pair, Sums, Term, TermDoc};
/// # #[derive(Clone, Debug)]
/// # struct Reads<const TENSORS: usize>;
/// # impl<const TENSORS: usize> Term<3> for Reads<TENSORS> {
/// #     const READS: Fields = {
/// #         let (mut fields, mut k) = (Fields::NONE, 0);
/// #         while k < TENSORS {
/// #             fields = fields.union(Fields::of(&[Field::tensor(k as u8)]));
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
///     &FusedKernel::<_, _>::new(CubicSpline, (Reads::<10>,), SmoothingMode::Uniform);
/// assert_eq!(sweep.fields().width(3), 3 + 10 * 6);
/// ```
/// ```compile_fail
/// # use meshfree::kernel::CubicSpline;
/// # use meshfree::particles::{Field, Fields, Outputs};
/// # use meshfree::scalar::Lane;
/// # use meshfree::sweep::{PairSweep, FusedKernel, SmoothingMode};
/// # use meshfree::term::{Layout, Pair, Sums, Term, TermDoc};
/// # #[derive(Clone, Debug)]
/// # struct Reads<const TENSORS: usize>;
/// # impl<const TENSORS: usize> Term<3> for Reads<TENSORS> {
/// #     const READS: Fields = {
/// #         let (mut fields, mut k) = (Fields::NONE, 0);
/// #         while k < TENSORS {
/// #             fields = fields.union(Fields::of(&[Field::tensor(k as u8)]));
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
///     &FusedKernel::<_, _>::new(CubicSpline, (Reads::<11>,), SmoothingMode::Uniform);
/// assert_eq!(sweep.fields().width(3), 3 + 11 * 6);
/// ```
pub const MOST_READS: usize = 64;
/// Most numbers that the sums of a sweep can hold; one that holds more does not compile.
pub const MOST_SUMS: usize = 72;

/// Fails to compile where the numbers of a sweep have no room.
pub(crate) const fn assert_room<P: Layout, const D: usize>() {
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
    pub(crate) i: &'a [L; MOST_READS],
    pub(crate) j: &'a [L::Broadcast],
    pub(crate) layout: PhantomData<P>,
}

impl<L: Lane, const D: usize, P: Layout> Pair<'_, L, D, P> {
    /// A scalar field of i. The field must be among the term's `READS`.
    #[inline(always)]
    #[must_use]
    pub fn i(&self, field: Field) -> L {
        debug_assert!(P::READS.contains(field));
        self.i[P::READS.offset(field, D)]
    }
    /// A scalar field of j.
    #[inline(always)]
    #[must_use]
    pub fn j(&self, field: Field) -> L {
        debug_assert!(P::READS.contains(field));
        L::broadcast(self.j[P::READS.offset(field, D)])
    }
    /// Component `k` of a vector or matrix field of i.
    #[inline(always)]
    #[must_use]
    pub fn i_at(&self, field: Field, k: usize) -> L {
        debug_assert!(P::READS.contains(field));
        self.i[P::READS.offset(field, D) + k]
    }
    /// Component `k` of a vector or matrix field of j.
    #[inline(always)]
    #[must_use]
    pub fn j_at(&self, field: Field, k: usize) -> L {
        debug_assert!(P::READS.contains(field));
        L::broadcast(self.j[P::READS.offset(field, D) + k])
    }
    /// A symmetric tensor of i.
    #[inline(always)]
    #[must_use]
    pub fn i_tensor(&self, field: Field) -> Symmetric<L> {
        debug_assert!(P::READS.contains(field) && field.shape() == Shape::Tensor);
        let at = P::READS.offset(field, D);
        let mut tensor = [L::zero(); 6];
        tensor.copy_from_slice(&self.i[at..at + 6]);
        Symmetric::new(tensor)
    }
    /// A symmetric tensor of j.
    #[inline(always)]
    #[must_use]
    pub fn j_tensor(&self, field: Field) -> Symmetric<L> {
        debug_assert!(P::READS.contains(field) && field.shape() == Shape::Tensor);
        let at = P::READS.offset(field, D);
        let mut tensor = [L::zero(); 6];
        for k in 0..6 {
            tensor[k] = L::broadcast(self.j[at + k]);
        }
        Symmetric::new(tensor)
    }
    /// vᵢⱼ·vᵢⱼ \[m²/s²\].
    #[inline(always)]
    #[must_use]
    pub fn v2(&self) -> L {
        (1..D).fold(self.v[0] * self.v[0], |sum, d| {
            self.v[d].mul_add(self.v[d], sum)
        })
    }
}

/// The sums of a row of particles over their neighbours.
#[derive(Debug)]
pub struct Sums<L: Lane, const D: usize, P: Layout> {
    /// This pair's force on i along rᵢⱼ, divided by rᵢⱼ \[N/m\]: symmetric in i and j.
    pub radial: Along<L>,
    /// This pair's force on i along vᵢⱼ, divided by vᵢⱼ \[N s/m\]: symmetric in i and j.
    pub shear: Along<L>,
    /// This pair's force on i in any other direction \[N\]: antisymmetric in i and j.
    pub force: FreeForce<L, D>,
    pub(crate) kept: [L; MOST_SUMS],
    layout: PhantomData<P>,
}

impl<L: Lane, const D: usize, P: Layout> Sums<L, D, P> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let zero = L::zero();
        Self {
            radial: Along::NOTHING,
            shear: Along::NOTHING,
            force: FreeForce::NOTHING,
            kept: [zero; MOST_SUMS],
            layout: PhantomData,
        }
    }
    /// The sums that are kept, copied.
    #[inline(always)]
    pub(crate) fn copied(&self) -> Self {
        let mut copy = Self::new();
        copy.take(self);
        copy
    }
    /// Takes over the sums that are kept.
    #[inline(always)]
    pub(crate) fn take(&mut self, from: &Self) {
        let width = P::WRITES.width(D);
        self.kept[..width].copy_from_slice(&from.kept[..width]);
    }
    /// Sets the sums that are kept to zero.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.kept[..P::WRITES.width(D)].fill(L::zero());
    }
    /// Forgets the forces of the pair before.
    #[inline(always)]
    pub(crate) fn next_pair(&mut self) {
        self.radial = Along::NOTHING;
        self.shear = Along::NOTHING;
        self.force = FreeForce::NOTHING;
    }
    /// The kept force; zero where no term sets one.
    #[inline(always)]
    pub(crate) fn kept_force(&self) -> [L; D] {
        if !P::WRITES.contains(Output::FORCE) {
            return [L::zero(); D];
        }
        let at = P::WRITES.offset(Output::FORCE, D);
        core::array::from_fn(|d| self.kept[at + d])
    }
    /// Adds to a scalar sum.
    ///
    /// Power that is added here ([`Output::POWER`]) is energy that no force has done, such as heat that is
    /// conducted; the power of forces the sweep adds by itself.
    #[inline(always)]
    pub fn add(&mut self, output: Output, value: L) {
        self.add_at(output, 0, value);
    }
    /// Adds a product to a scalar sum, with one rounding where lanes are fused.
    #[inline(always)]
    pub fn add_product(&mut self, output: Output, a: L, b: L) {
        if output == Output::FORCE {
            self.force.add(0, a * b);
        } else if P::WRITES.contains(output) {
            let kept = &mut self.kept[P::WRITES.offset(output, D)];
            *kept = a.mul_add(b, *kept);
        }
    }
    /// Adds to component `k` of a sum.
    ///
    /// What is added to [`Output::FORCE`] is a [free force](Self::force) of the pair: its power and its work
    /// count as those of any other.
    #[inline(always)]
    pub fn add_at(&mut self, output: Output, k: usize, value: L) {
        if output == Output::FORCE {
            self.force.add(k, value);
        } else if P::WRITES.contains(output) {
            self.kept[P::WRITES.offset(output, D) + k] += value;
        }
    }
    /// Sets the kernel sum to zero and returns what it was.
    #[inline(always)]
    pub(crate) fn take_kernel_sum(&mut self) -> L {
        if P::WRITES.contains(Output::KERNEL_SUM) {
            let at = P::WRITES.offset(Output::KERNEL_SUM, D);
            core::mem::replace(&mut self.kept[at], L::zero())
        } else {
            L::zero()
        }
    }
    /// Moves the kernel sum to the contact sum, and puts back what was taken.
    #[inline(always)]
    pub(crate) fn divert_kernel_sum(&mut self, taken: L) {
        let across = self.take_kernel_sum();
        self.add(Output::KERNEL_SUM, taken);
        self.add(Output::CONTACT_SUM, across);
    }
    /// Raises a maximum.
    #[inline(always)]
    pub fn raise(&mut self, output: Output, value: L) {
        if P::WRITES.contains(output) {
            let kept = &mut self.kept[P::WRITES.offset(output, D)];
            *kept = kept.max(value);
        }
    }
}

/// What a term is, for people: printed by a scheme and collected in the documentation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TermDoc {
    /// The field's name of the effect.
    pub name: String,
    /// The equation, in plain text.
    pub equation: &'static str,
    /// Author, year and equation number.
    pub source: &'static str,
}

/// What a term of a sweep reads and writes, for the check of a scheme's order.
#[derive(Clone, Debug, PartialEq)]
pub struct TermUse {
    /// Its name.
    pub name: String,
    /// What it reads.
    pub reads: Fields,
    /// What it writes.
    pub writes: Outputs,
}

/// One effect between pairs of particles.
///
/// Mark [`pair`](Term::pair), and every function that it calls, `#[inline(always)]`. The pair loop is compiled
/// for wider instructions than the rest of a program, and what is not inlined into it runs without them, several
/// times slower. A closure that a loop calls counts as such a function.
///
/// Write it with the arithmetic of lanes and [`Lane::select`] only, so that it can be
/// [recorded](crate::scalar::Record). The sweep borrows the term, so a table that it holds is not copied.
///
/// ```
/// use meshfree::particles::{Field, Fields, Output, Outputs};
/// use meshfree::scalar::Lane;
/// use meshfree::term::{Layout, Pair, Sums, Term, TermDoc};
///
/// const SUMMED: Output = Output::scalar(0);
///
/// /// Counts mass within the support, weighted with the kernel: the summed density.
/// #[derive(Clone, Debug)]
/// struct SummedDensity;
///
/// impl<const D: usize> Term<D> for SummedDensity {
///     const READS: Fields = Fields::of(&[Field::MASS]);
///     const WRITES: Outputs = Outputs::of(&[SUMMED]);
///     #[inline(always)]
///     fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
///         sums.add(SUMMED, pair.j(Field::MASS) * pair.w);
///     }
///     fn document(&self) -> TermDoc {
///         TermDoc { name: "summed density".into(), equation: "ρᵢ = Σⱼ mⱼ Wᵢⱼ", source: "Gingold & Monaghan 1977" }
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a pair term in {D} dimensions",
    note = "implement `Term<{D}>`: the fields it reads and writes, and what a pair adds to the sums"
)]
pub trait Term<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Fields of i and j that the term reads, beside the position.
    const READS: Fields;
    /// Sums that the term adds to. A term that sets `radial`, `shear` or `force` names [`Output::FORCE`].
    const WRITES: Outputs;
    /// Those of `READS` that carry tension, of which two sides of a contact that may open see only the
    /// compression: of a scalar (positive in compression) its positive part, of a symmetric tensor (positive
    /// in tension) its [compressive part](Symmetric::compressive_part), of a vector or matrix nothing.
    ///
    /// Unless a term says otherwise, [what counts as a stress](Fields::stresses). Name here a pressure of your
    /// own; leave out a tensor that is no stress. What one term of a sweep names counts for all of them.
    const TENSILE: Fields = Self::READS.stresses();
    /// Adds what this pair contributes. A force on i must be the opposite of that on j.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>);
    /// What the term is, for people.
    fn document(&self) -> TermDoc;
}

/// A list of terms that share one sweep: a tuple.
pub trait Terms<const D: usize>: Clone + Debug + Send + Sync + 'static {
    /// Union of what the terms read.
    const READS: Fields;
    /// Union of what the terms write.
    const WRITES: Outputs;
    /// Union of what the terms read and carries tension.
    const TENSILE: Fields;
    /// These terms and then others, as one list without empty parts.
    type Then<B: Terms<D>>: Terms<D>;
    /// These terms and then others.
    fn then<B: Terms<D>>(self, next: B) -> Self::Then<B>;
    /// Others and then these terms, where the others are not empty.
    type After<A: Terms<D>>: Terms<D>;
    /// Others and then these terms.
    fn after<A: Terms<D>>(self, first: A) -> Self::After<A>;
    /// Adds what this pair contributes to every term.
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>);
    /// The terms, for people.
    fn document(&self) -> Vec<TermDoc>;
    /// What each term reads and writes; all together as one if not given.
    fn uses(&self) -> Vec<TermUse> {
        let names: Vec<_> = self.document().into_iter().map(|own| own.name).collect();
        vec![TermUse {
            name: names.join(", "),
            reads: Self::READS,
            writes: Self::WRITES,
        }]
    }
}

impl<const D: usize> Terms<D> for () {
    const READS: Fields = Fields::NONE;
    const WRITES: Outputs = Outputs::NONE;
    const TENSILE: Fields = Fields::NONE;
    type Then<B: Terms<D>> = B;
    fn then<B: Terms<D>>(self, next: B) -> B {
        next
    }
    type After<A: Terms<D>> = A;
    fn after<A: Terms<D>>(self, first: A) -> A {
        first
    }
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>, _sums: &mut Sums<L, D, P>) {}
    fn document(&self) -> Vec<TermDoc> {
        Vec::new()
    }
    fn uses(&self) -> Vec<TermUse> {
        Vec::new()
    }
}

/// Calls a macro with one term of each kind, as expressions separated by commas, after whatever else it is
/// given. Every test and benchmark that runs over all terms takes them from here.
///
/// ```
/// use meshfree::term::Term;
/// fn writes<T: Term<2>>(_term: &T) -> usize {
///     T::WRITES.iter().count()
/// }
/// macro_rules! most {
///     ($least:literal: $($term:expr),*) => { [$least, $(writes(&$term)),*].into_iter().max() };
/// }
/// assert_eq!(meshfree::for_each_term!(most 1:), Some(5));
/// ```
#[macro_export]
macro_rules! for_each_term {
    ($callback:ident $($given:tt)*) => {
        $callback! {
            $($given)*
            $crate::term::PressureForce,
            $crate::term::MidpointReconstruction { strength: 1.0 / 3.0 },
            $crate::term::InternalEnergy,
            $crate::term::KernelSum,
            $crate::term::Unity,
            $crate::term::KernelMoment,
            $crate::term::SlopeInH,
            $crate::term::Compression,
            $crate::term::VelocityGradient,
            $crate::term::PressureGradient,
            $crate::term::DensityGradient,
            $crate::term::MomentMatrix,
            $crate::term::LaminarViscosity,
            $crate::term::CentralViscosity,
            $crate::term::Molteni::default(),
            $crate::term::Fourtakas::default(),
            $crate::term::Antuono::default(),
            $crate::term::RiemannDiffusion,
            $crate::term::ConcentrationGradient { repulsion: 0.2, at_spacing: 1.0 },
            $crate::term::LiquidNearWall,
            $crate::term::VelocityAtWall,
            $crate::term::ViscosityAtWall,
            $crate::effect::VelocityBeforeWall,
            $crate::effect::Hypoelastic,
            $crate::term::RenormalisedPressureForce,
            $crate::term::RenormalisedCompression,
            $crate::term::Viscosity($crate::term::viscosity::Inviscid),
            $crate::term::Viscosity($crate::term::viscosity::MonaghanGingold::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::LimitedMonaghanGingold::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::SignalVelocity::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::Balsara::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::MorrisMonaghan::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::CullenDehnen::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::Riemann::STANDARD),
            $crate::term::Viscosity($crate::term::viscosity::LamPrinted { alpha: 1.0, beta: 2.0 })
        }
    };
}

macro_rules! tuple {
    ($($name:ident),*) => {
        #[allow(non_snake_case)]
        impl<const D: usize, $($name: Term<D>),*> Terms<D> for ($($name,)*) {
            const READS: Fields = Fields::NONE$(.union($name::READS))*;
            const WRITES: Outputs = Outputs::NONE$(.union($name::WRITES))*;
            const TENSILE: Fields = Fields::NONE$(.union($name::TENSILE))*;
            type Then<Next: Terms<D>> = Next::After<Self>;
            fn then<Next: Terms<D>>(self, next: Next) -> Self::Then<Next> {
                next.after(self)
            }
            type After<First: Terms<D>> = Join<First, Self>;
            fn after<First: Terms<D>>(self, first: First) -> Self::After<First> {
                Join(first, self)
            }
            #[inline(always)]
            fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
                let ($($name,)*) = self;
                $($name.pair(pair, sums);)*
            }
            fn document(&self) -> Vec<TermDoc> {
                let ($($name,)*) = self;
                let mut documents = vec![$($name.document(),)*];
                documents.retain(|document| !document.name.is_empty());
                documents
            }
            fn uses(&self) -> Vec<TermUse> {
                let ($($name,)*) = self;
                vec![$(TermUse {
                    name: $name.document().name,
                    reads: $name::READS,
                    writes: $name::WRITES,
                },)*]
            }
        }
    };
}
tuple!(A);
tuple!(A, B);
tuple!(A, B, C);
tuple!(A, B, C, E);
tuple!(A, B, C, E, F);
tuple!(A, B, C, E, F, G);
tuple!(A, B, C, E, F, G, H);
tuple!(A, B, C, E, F, G, H, I);
