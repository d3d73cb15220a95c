//! Laws, rates and limits as lane text: what happens to one particle, or to a row of particles at once.
//! They declare the fields and sums that they use as constants, as pair terms do.

use super::access::Access;
use super::shifting::PLACE;
use super::{Around, Rung};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::{Square, Symmetric};
use crate::term::{MOST_READS, MOST_SUMS};
use core::fmt::Debug;
use core::marker::PhantomData;

/// A [`Law`](super::Law) written once for one particle and for rows of them, in the arithmetic of [lanes](Lane).
///
/// Every such law is a `Law`, which [`StepProgram::law`](super::StepProgram::law) takes, and can be [recorded](crate::scalar::Record)
/// if it branches on nothing that differs between particles: where it decides, it takes [`Lane::select`], and where it iterates,
/// [`Lane::iterate`].
/// Mark [`point`](Self::point), and every function that it calls, `#[inline(always)]`. Without products that round once
/// ([`Lane::mul_add`]) its results are the same on every machine.
///
/// A field of `WRITES` that is not among `READS` or `ADDS` is not loaded: the law must set it for every particle, or it is NaN.
///
/// ```
/// use meshfree::effect::{Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram};
/// use meshfree::particles::{Field, Fields};
/// use meshfree::scalar::{Lane, Real};
/// use meshfree::term::Stage;
///
/// /// Pressures below zero rise to it.
/// #[derive(Clone, Copy, Debug)]
/// struct NoTension;
///
/// impl<const D: usize> PointLaw<D> for NoTension {
///     const NAME: &'static str = "no tension";
///     const READS: Fields = Fields::of(&[Field::PRESSURE]);
///     const WRITES: Fields = Fields::of(&[Field::PRESSURE]);
///     const RUNG: Option<Rung> = Some(Rung::Bound);
///     #[inline(always)]
///     fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
///         let pressure = at.get(Field::PRESSURE);
///         at.limited(pressure.lt(L::zero()));
///         at.set(Field::PRESSURE, pressure.positive_part());
///     }
/// }
///
/// impl<const D: usize> Effect<D> for NoTension {
///     type Terms = ();
///     fn terms(&self, _setting: &Setting) {}
///     fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
///         program.law(Stage::State, *self);
///     }
/// }
/// ```
pub trait PointLaw<const D: usize>: Debug + Send + Sync + 'static {
    /// See [`Law::name`](super::Law::name).
    const NAME: &'static str;
    /// See [`Law::reads`](super::Law::reads).
    const READS: Fields;
    /// See [`Law::writes`](super::Law::writes).
    const WRITES: Fields;
    /// See [`Law::sums`](super::Law::sums).
    const SUMS: Outputs = Outputs::NONE;
    /// See [`Law::adds`](super::Law::adds).
    const ADDS: Fields = Fields::NONE;
    /// See [`Law::optional`](super::Law::optional).
    const OPTIONAL: Fields = Fields::NONE;
    /// See [`Law::before`](super::Law::before).
    const BEFORE: Fields = Fields::NONE;
    /// See [`Law::rung`](super::Law::rung).
    const RUNG: Option<Rung> = None;
    /// Whether it is for particles of walls, and sees their [wall](AtWall).
    const OF_WALLS: bool = false;
    /// Whether it computes in `f64` where particles are stored in `f32`.
    const DOUBLE: bool = false;
    /// Those of `SUMS` that it uses, by its own parameters.
    fn summed(&self) -> Outputs {
        Self::SUMS
    }
    /// Those of `WRITES` that it writes, by its own parameters; of others [`Point::has`] says that they are not there.
    fn written(&self) -> Fields {
        Self::WRITES
    }
    /// Those of `OPTIONAL` that it does without, by its own parameters; it needs the others.
    fn spared(&self) -> Fields {
        Self::OPTIONAL
    }
    /// See [`Law::repeats`](super::Law::repeats); [`Point::changed`] takes the change.
    fn repeated(&self) -> Option<(usize, f64)> {
        None
    }
    /// Whether it acts on the particles of a body, or of a wall; what is the same for all of them goes to the `constants` of
    /// [`Point::constant`].
    fn prepare<T: Real>(
        &self,
        _around: &Around<'_, T, D>,
        _constants: &mut [f64; CONSTANTS],
    ) -> bool {
        true
    }
    /// Acts on a particle, or on each of a row.
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>);
}

/// A part of a [`Rate`](super::Rate) written once for one particle and for rows of them, as a [`PointLaw`] is.
pub trait PointRate<const D: usize>: Debug + Send + Sync + 'static {
    /// See [`Rate::reads`](super::Rate::reads).
    const READS: Fields = Fields::NONE;
    /// See [`Rate::sums`](super::Rate::sums).
    const SUMS: Outputs = Outputs::NONE;
    /// See [`Rate::optional`](super::Rate::optional).
    const OPTIONAL: Fields = Fields::NONE;
    /// Whether it is a part of the growth g \[1/s\] of dY/dt = g Y + s, and not of s.
    const GROWTH: bool = false;
    /// See [`PointLaw::prepare`].
    fn prepare<T: Real>(
        &self,
        _around: &Around<'_, T, D>,
        _constants: &mut [f64; CONSTANTS],
    ) -> bool {
        true
    }
    /// Adds to `rate`, which has the components of the field, or one number of growth. `present` is the first component of Y where
    /// it is asked for its growth.
    fn point<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>, present: L, rate: &mut [L]);
}

/// A [`Limit`](super::Limit) written once for one particle and for rows of them, as a [`PointLaw`] is. It computes in `f64`.
pub trait PointLimit<const D: usize>: Debug + Send + Sync + 'static {
    /// See [`Limit::name`](super::Limit::name).
    const NAME: &'static str;
    /// See [`Limit::reads`](super::Limit::reads).
    const READS: Fields;
    /// See [`Limit::sums`](super::Limit::sums).
    const SUMS: Outputs = Outputs::NONE;
    /// See [`Limit::step`](super::Limit::step).
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L;
}

/// Most numbers that are the same for all particles of a body.
pub const CONSTANTS: usize = 4;

/// What a law, rate or limit of a [`Point`] declares; known at compile time.
pub trait Reach: 'static {
    /// The scalar that particles are stored in.
    type Scalar: Real;
    /// Fields that may be read.
    const READS: Fields;
    /// Fields that may be written.
    const WRITES: Fields;
    /// Sums that may be read.
    const SUMS: Outputs;
    /// Fields that have a place in a row.
    const ALL: Fields = Self::READS.union(Self::WRITES);
}

/// The reach of a law.
pub(super) struct OfLaw<T, A, const D: usize>(PhantomData<(T, A)>);
impl<T: Real, const D: usize, A: PointLaw<D>> Reach for OfLaw<T, A, D> {
    type Scalar = T;
    const READS: Fields = A::READS;
    const WRITES: Fields = A::WRITES;
    const SUMS: Outputs = A::SUMS;
}

/// The reach of a rate.
pub(super) struct OfRate<T, A, const D: usize>(PhantomData<(T, A)>);
impl<T: Real, const D: usize, A: PointRate<D>> Reach for OfRate<T, A, D> {
    type Scalar = T;
    const READS: Fields = A::READS;
    const WRITES: Fields = Fields::NONE;
    const SUMS: Outputs = A::SUMS;
}

/// The reach of a limit.
pub(super) struct OfLimit<T, A, const D: usize>(PhantomData<(T, A)>);
impl<T: Real, const D: usize, A: PointLimit<D>> Reach for OfLimit<T, A, D> {
    type Scalar = T;
    const READS: Fields = A::READS;
    const WRITES: Fields = Fields::NONE;
    const SUMS: Outputs = A::SUMS;
}

/// What laws [of walls](PointLaw::OF_WALLS) see of the wall at a particle; all zero for others.
#[derive(Clone, Copy, Debug)]
pub struct AtWall<L, const D: usize> {
    /// Gravity less the acceleration of the wall \[m/s²\].
    pub fall: [L; D],
    /// The unit vector from the liquid into the wall, where the scheme
    /// [asks for normals](super::StepProgram::ask_for_wall_normals).
    pub normal: [L; D],
    /// The velocity gradient ∂vₐ/∂x_b of the wall \[1/s\], row a.
    pub gradient: Square<L, D>,
}

impl<L: Lane, const D: usize> AtWall<L, D> {
    /// Without a wall.
    #[inline(always)]
    pub(super) fn none() -> Self {
        Self {
            fall: [L::zero(); D],
            normal: [L::zero(); D],
            gradient: Square::zero(),
        }
    }
}

/// A particle in the hands of a law, rate or limit, or a row of particles: the fields and sums that it declares, and no others. Whoever
/// asks for more ends the run with a panic that names both.
#[derive(Debug)]
pub struct Point<'a, L: Lane, const D: usize, P: Reach> {
    pub(super) numbers: &'a mut [L; MOST_READS],
    pub(super) sums: &'a [L; MOST_SUMS],
    /// Fields that have a column.
    pub(super) there: &'a Fields,
    pub(super) access: &'a Access,
    pub(super) limited: Option<L::Mask>,
    pub(super) change: Option<L>,
    pub(super) dt: L,
    pub(super) constants: [L; CONSTANTS],
    /// By how much the particles are moved \[m\].
    pub(super) displacement: [L; D],
    /// The wall that the particles belong to.
    pub wall: &'a AtWall<L, D>,
    /// What is around the particles of the row, the same for all of them.
    pub around: &'a Around<'a, P::Scalar, D>,
}

impl<L: Lane, const D: usize, P: Reach> Point<'_, L, D, P> {
    /// Where the numbers of a field start.
    #[inline(always)]
    const fn place(field: Field) -> usize {
        P::ALL.offset(field, D)
    }
    /// Whether the scheme has a field that is declared optional, and the law writes what it might.
    #[inline(always)]
    #[must_use]
    pub fn has(&self, field: Field) -> bool {
        self.there.contains(field)
    }
    /// A scalar field; zero where it is optional and the scheme does not have it.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn get(&self, field: Field) -> L {
        self.get_at(field, 0)
    }
    /// A scalar field where the scheme has it, and another value elsewhere.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn get_or(&self, field: Field, otherwise: L) -> L {
        let own = self.get(field);
        if self.has(field) { own } else { otherwise }
    }
    /// Component `k` of a field.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn get_at(&self, field: Field, k: usize) -> L {
        if cfg!(test) || !P::READS.contains(field) {
            self.access.read(field);
        }
        self.numbers[Self::place(field) + k]
    }
    /// A vector field.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn vector(&self, field: Field) -> [L; D] {
        let mut vector = [L::zero(); D];
        for d in 0..D {
            vector[d] = self.get_at(field, d);
        }
        vector
    }
    /// A matrix field.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn matrix(&self, field: Field) -> Square<L, D> {
        let mut matrix = Square::zero();
        for a in 0..D {
            for b in 0..D {
                matrix.0[a][b] = self.get_at(field, a * D + b);
            }
        }
        matrix
    }
    /// A symmetric tensor.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn tensor(&self, field: Field) -> Symmetric<L> {
        let mut tensor = [L::zero(); 6];
        for k in 0..6 {
            tensor[k] = self.get_at(field, k);
        }
        Symmetric::new(tensor)
    }
    /// Sets a scalar field.
    #[inline(always)]
    #[track_caller]
    pub fn set(&mut self, field: Field, value: L) {
        self.set_at(field, 0, value);
    }
    /// Sets component `k` of a field.
    ///
    /// # Panics
    /// If the law does not declare that it writes the field, or if it is a place, which [`displace`](Self::displace) changes.
    #[inline(always)]
    #[track_caller]
    pub fn set_at(&mut self, field: Field, k: usize, value: L) {
        if cfg!(test) || !P::WRITES.contains(field) {
            self.access.write(field);
        }
        assert!(
            !PLACE.contains(field),
            "laws of points move particles by `Point::displace`"
        );
        self.numbers[Self::place(field) + k] = value;
    }
    /// Sets a matrix field.
    #[inline(always)]
    #[track_caller]
    pub fn set_matrix(&mut self, field: Field, matrix: &Square<L, D>) {
        for a in 0..D {
            for b in 0..D {
                self.set_at(field, a * D + b, matrix.0[a][b]);
            }
        }
    }
    /// Sets a symmetric tensor.
    #[inline(always)]
    #[track_caller]
    pub fn set_tensor(&mut self, field: Field, tensor: &Symmetric<L>) {
        for k in 0..6 {
            self.set_at(field, k, tensor.components()[k]);
        }
    }
    /// Adds to component `k` of a field that the law writes.
    #[inline(always)]
    #[track_caller]
    pub fn add_at(&mut self, field: Field, k: usize, value: L) {
        let before = self.numbers[Self::place(field) + k];
        self.set_at(field, k, before + value);
    }
    /// Moves a particle along axis `d`, with the rounding error of its place kept where the scheme has a field for it. Such a law
    /// writes and [adds](PointLaw::ADDS) to [`Field::POSITION`] and [`Field::POSITION_RESIDUAL`], of which the second is optional.
    #[inline(always)]
    #[track_caller]
    pub fn displace(&mut self, d: usize, by: L) {
        for field in [Field::POSITION, Field::POSITION_RESIDUAL] {
            if cfg!(test) || !P::WRITES.contains(field) {
                self.access.write(field);
            }
        }
        self.displacement[d] = by;
    }
    /// A sum over neighbours; zero where nothing was summed.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn sum(&self, output: Output) -> L {
        self.sum_at(output, 0)
    }
    /// Component `k` of a sum.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn sum_at(&self, output: Output, k: usize) -> L {
        if cfg!(test) || !P::SUMS.contains(output) {
            self.access.sum(output);
        }
        self.sums[P::SUMS.offset(output, D) + k]
    }
    /// A sum of vectors.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn sum_vector(&self, output: Output) -> [L; D] {
        let mut vector = [L::zero(); D];
        for d in 0..D {
            vector[d] = self.sum_at(output, d);
        }
        vector
    }
    /// A sum of matrices.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn sum_matrix(&self, output: Output) -> Square<L, D> {
        let mut matrix = Square::zero();
        for a in 0..D {
            for b in 0..D {
                matrix.0[a][b] = self.sum_at(output, a * D + b);
            }
        }
        matrix
    }
    /// The step \[s\] of [`Around::dt`].
    #[inline(always)]
    #[must_use]
    pub fn dt(&self) -> L {
        self.dt
    }
    /// A number that is the same for all particles of the body.
    #[inline(always)]
    #[must_use]
    pub fn constant(&self, k: usize) -> L {
        self.constants[k]
    }
    /// The smoothing length \[m\], of the particle where the scheme has it and else of the body.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn smoothing_length(&self) -> L {
        self.get_or(Field::SMOOTHING_LENGTH, L::of(self.around.smoothing_length))
    }
    /// The corrected velocity gradient ∂vₐ/∂x_b \[1/s\], from the sums of a [term](crate::term::VelocityGradient).
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn velocity_gradient(&self) -> Square<L, D> {
        let summed = self.sum_matrix(Output::VELOCITY_GRADIENT);
        summed.times(&self.correction())
    }
    /// The inverse of the sum of the moment matrix, which makes gradients exact for linear fields.
    #[inline(always)]
    #[track_caller]
    #[must_use]
    pub fn correction(&self) -> Square<L, D> {
        // A thin jet has no gradient across itself: the sum is left uncorrected there.
        self.sum_matrix(Output::MOMENT_MATRIX)
            .inverse(super::gradients::SINGULAR)
            .0
    }
    /// The relative change of a law that is repeated.
    #[inline(always)]
    pub fn changed(&mut self, change: L) {
        self.change = Some(change);
    }
    /// Counts the particles of the row where a mask holds among those that the law has limited. Called once.
    #[inline(always)]
    pub fn limited(&mut self, mask: L::Mask) {
        self.limited = Some(mask);
    }
}
