//! A lane that records what is done to it, and the record, which any other lane can follow.
//! So the one text of a term or kernel also serves a device that this crate does not run on.

use super::{Lane, Mask};
use core::ops::{
    Add, AddAssign, BitAnd, BitOr, Div, DivAssign, Mul, MulAssign, Neg, Not, Sub, SubAssign,
};
use num_traits::{One, Zero};
use std::cell::RefCell;

/// A number that is not known yet: the place of an operation in the [`Record`] that is being written.
///
/// It is a [`Lane`] of one element, so any text that is generic over lanes takes it. What asks for the
/// element itself cannot be recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traced(u32);

/// The outcome of a comparison of two [`Traced`] numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TracedMask(u32);

impl Traced {
    /// Its place among the [operations](Record::operations).
    #[must_use]
    pub fn place(self) -> usize {
        self.0 as usize
    }
}

impl TracedMask {
    /// Its place among the [operations](Record::operations).
    #[must_use]
    pub fn place(self) -> usize {
        self.0 as usize
    }
}

/// An operation on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// −a
    Negate,
    /// [`Lane::sqrt`]
    SquareRoot,
    /// [`Lane::root`]
    Root,
    /// |a|
    Absolute,
    /// eᵃ
    Exponential,
    /// ln a
    Logarithm,
    /// [`Lane::cbrt`]
    CubeRoot,
    /// [`Lane::sin`]
    Sine,
    /// [`Lane::cos`]
    Cosine,
    /// [`Lane::acos`]
    ArcCosine,
    /// [`Lane::atan`]
    ArcTangent,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// a + b
    Add,
    /// a − b
    Subtract,
    /// a b
    Multiply,
    /// a/b
    Divide,
    /// The smaller of the two, b where neither is.
    Smaller,
    /// The larger of the two, b where neither is.
    Larger,
}

/// One line of a [`Record`]: what makes the number, or the mask, in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// One of the numbers that the text was given.
    Input(usize),
    /// A constant, to be rounded to the scalar.
    Constant(f64),
    /// A function of one number.
    Unary(Unary, Traced),
    /// A function of two numbers.
    Binary(Binary, Traced, Traced),
    /// a b + c, with one rounding where lanes are fused.
    MulAdd(Traced, Traced, Traced),
    /// a b + c, with one rounding everywhere.
    Fused(Traced, Traced, Traced),
    /// A number to a constant power.
    Power(Traced, f64),
    /// a < b
    Less(Traced, Traced),
    /// a ≤ b
    LessOrEqual(Traced, Traced),
    /// A mask that is the same everywhere.
    Everywhere(bool),
    /// Where both masks hold.
    And(TracedMask, TracedMask),
    /// Where either mask holds.
    Or(TracedMask, TracedMask),
    /// Where the mask does not hold.
    Not(TracedMask),
    /// The first number where the mask holds, the second elsewhere.
    Select(TracedMask, Traced, Traced),
}

impl Operation {
    /// The places that it takes numbers and masks from.
    fn operands(self) -> [Option<u32>; 3] {
        use Operation as O;
        match self {
            O::Input(_) | O::Constant(_) | O::Everywhere(_) => [None; 3],
            O::Unary(_, a) | O::Power(a, _) => [Some(a.0), None, None],
            O::Not(a) => [Some(a.0), None, None],
            O::Binary(_, a, b) | O::Less(a, b) | O::LessOrEqual(a, b) => {
                [Some(a.0), Some(b.0), None]
            }
            O::And(a, b) | O::Or(a, b) => [Some(a.0), Some(b.0), None],
            O::MulAdd(a, b, c) | O::Fused(a, b, c) => [Some(a.0), Some(b.0), Some(c.0)],
            O::Select(mask, a, b) => [Some(mask.0), Some(a.0), Some(b.0)],
        }
    }
}

/// What a text does that cannot be recorded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{what} cannot be recorded; write the text with the arithmetic of lanes and `Lane::select`"
)]
pub struct Unrecordable {
    /// What the text did first of it.
    pub what: &'static str,
}

/// What is being recorded.
#[derive(Default)]
struct Tape {
    operations: Vec<Operation>,
    refused: Option<&'static str>,
}

thread_local! {
    static TAPE: RefCell<Option<Tape>> = const { RefCell::new(None) };
}

/// Writes an operation down and returns its place. Without a record that is being written there is none.
fn write(operation: Operation) -> u32 {
    TAPE.with_borrow_mut(|tape| {
        tape.as_mut().map_or(u32::MAX, |tape| {
            tape.operations.push(operation);
            (tape.operations.len() - 1) as u32
        })
    })
}

fn number(operation: Operation) -> Traced {
    Traced(write(operation))
}

fn mask(operation: Operation) -> TracedMask {
    TracedMask(write(operation))
}

fn refuse(what: &'static str) {
    TAPE.with_borrow_mut(|tape| {
        if let Some(tape) = tape {
            tape.refused.get_or_insert(what);
        }
    });
}

/// Everything that a text does to its numbers, in order.
///
/// ```
/// use meshfree::scalar::{Lane, Lanes, Record};
/// fn kinetic_energy<L: Lane>(mass: L, speed: L) -> L {
///     L::of(0.5) * mass * speed * speed
/// }
/// let record = Record::of(2, |given| vec![kinetic_energy(given[0], given[1])])?;
/// assert_eq!(record.follow(&[2.0, 3.0]), [9.0]);
/// let speeds = Lanes::<f32, 4, false>::from_fn(|k| k as f32);
/// assert_eq!(record.follow(&[Lanes::of(2.0), speeds])[0].extract(3), 9.0);
/// # Ok::<(), meshfree::scalar::Unrecordable>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    operations: Vec<Operation>,
    results: Vec<Traced>,
}

impl Record {
    /// Records what `text` does to `inputs` numbers, up to those that it returns.
    ///
    /// # Errors
    ///
    /// [`Unrecordable`] if it looks at an element of a lane or a mask, applies a function to elements, or
    /// returns a number that it did not make of its own.
    pub fn of(
        inputs: usize,
        text: impl FnOnce(&[Traced]) -> Vec<Traced>,
    ) -> Result<Self, Unrecordable> {
        let before = TAPE.replace(Some(Tape::default()));
        let given: Vec<_> = (0..inputs).map(|k| number(Operation::Input(k))).collect();
        let results = text(&given);
        let Tape {
            operations,
            refused,
        } = TAPE.replace(before).unwrap_or_default();
        let foreign = |place: u32, end: usize| place as usize >= end;
        let strays = operations.iter().enumerate().any(|(end, operation)| {
            let operands = operation.operands();
            operands.into_iter().flatten().any(|at| foreign(at, end))
        }) || results.iter().any(|at| foreign(at.0, operations.len()));
        let strays = strays.then_some("a number of another record");
        match refused.or(strays) {
            Some(what) => Err(Unrecordable { what }),
            None => Ok(Self {
                operations,
                results,
            }),
        }
    }

    /// The operations, each with operands from before it.
    #[must_use]
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// The numbers that the text returned.
    #[must_use]
    pub fn results(&self) -> &[Traced] {
        &self.results
    }

    /// Does the same to other numbers; an input that is not given is zero. The bits are those of the text on
    /// the same lanes.
    #[must_use]
    pub fn follow<L: Lane>(&self, inputs: &[L]) -> Vec<L> {
        let mut numbers = vec![L::zero(); self.operations.len()];
        let mut masks = vec![L::Mask::all_of(false); self.operations.len()];
        for (at, &operation) in self.operations.iter().enumerate() {
            let value = |a: Traced| numbers[a.place()];
            let holds = |a: TracedMask| masks[a.place()];
            let number = match operation {
                Operation::Input(k) => inputs.get(k).copied().unwrap_or_else(L::zero),
                Operation::Constant(value) => L::of(value),
                Operation::Unary(operation, a) => unary(operation, value(a)),
                Operation::Binary(operation, a, b) => binary(operation, value(a), value(b)),
                Operation::MulAdd(a, b, c) => value(a).mul_add(value(b), value(c)),
                Operation::Fused(a, b, c) => value(a).fused(value(b), value(c)),
                Operation::Power(a, exponent) => value(a).powf(exponent),
                Operation::Select(mask, a, b) => L::select(holds(mask), value(a), value(b)),
                Operation::Less(a, b) => {
                    masks[at] = value(a).lt(value(b));
                    continue;
                }
                Operation::LessOrEqual(a, b) => {
                    masks[at] = value(a).le(value(b));
                    continue;
                }
                Operation::Everywhere(everywhere) => {
                    masks[at] = L::Mask::all_of(everywhere);
                    continue;
                }
                Operation::And(a, b) => {
                    masks[at] = holds(a) & holds(b);
                    continue;
                }
                Operation::Or(a, b) => {
                    masks[at] = holds(a) | holds(b);
                    continue;
                }
                Operation::Not(a) => {
                    masks[at] = !holds(a);
                    continue;
                }
            };
            numbers[at] = number;
        }
        self.results.iter().map(|at| numbers[at.place()]).collect()
    }
}

fn unary<L: Lane>(operation: Unary, a: L) -> L {
    match operation {
        Unary::Negate => -a,
        Unary::SquareRoot => a.sqrt(),
        Unary::Root => a.root(),
        Unary::Absolute => a.abs(),
        Unary::Exponential => a.exp(),
        Unary::Logarithm => a.ln(),
        Unary::CubeRoot => a.cbrt(),
        Unary::Sine => a.sin(),
        Unary::Cosine => a.cos(),
        Unary::ArcCosine => a.acos(),
        Unary::ArcTangent => a.atan(),
    }
}

fn binary<L: Lane>(operation: Binary, a: L, b: L) -> L {
    match operation {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Smaller => a.min(b),
        Binary::Larger => a.max(b),
    }
}

macro_rules! operator {
    ($Op:ident, $op:ident, $Assign:ident, $assign:ident, $Binary:ident) => {
        impl $Op for Traced {
            type Output = Self;
            fn $op(self, other: Self) -> Self {
                number(Operation::Binary(Binary::$Binary, self, other))
            }
        }
        impl $Assign for Traced {
            fn $assign(&mut self, other: Self) {
                *self = self.$op(other);
            }
        }
    };
}
operator!(Add, add, AddAssign, add_assign, Add);
operator!(Sub, sub, SubAssign, sub_assign, Subtract);
operator!(Mul, mul, MulAssign, mul_assign, Multiply);
operator!(Div, div, DivAssign, div_assign, Divide);

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        number(Operation::Unary(Unary::Negate, self))
    }
}

impl Zero for Traced {
    fn zero() -> Self {
        Self::splat(0.0)
    }
    fn is_zero(&self) -> bool {
        refuse("whether a number is zero");
        false
    }
}

impl One for Traced {
    fn one() -> Self {
        Self::splat(1.0)
    }
}

impl BitAnd for TracedMask {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        mask(Operation::And(self, other))
    }
}

impl BitOr for TracedMask {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        mask(Operation::Or(self, other))
    }
}

impl Not for TracedMask {
    type Output = Self;
    fn not(self) -> Self {
        mask(Operation::Not(self))
    }
}

impl Mask for TracedMask {
    const WIDTH: usize = 1;
    fn all_of(value: bool) -> Self {
        mask(Operation::Everywhere(value))
    }
    fn count(self) -> usize {
        refuse("the number of elements for which a comparison holds");
        0
    }
    fn test(self, _k: usize) -> bool {
        refuse("a branch on a comparison");
        false
    }
}

impl Lane for Traced {
    type Scalar = f64;
    type Broadcast = Self;
    type Mask = TracedMask;
    const WIDTH: usize = 1;
    fn splat(value: f64) -> Self {
        number(Operation::Constant(value))
    }
    fn broadcast(value: Self) -> Self {
        value
    }
    fn from_fn(_f: impl FnMut(usize) -> f64) -> Self {
        refuse("a lane that is made of elements");
        Self::splat(f64::NAN)
    }
    fn extract(self, _k: usize) -> f64 {
        refuse("an element of a lane");
        f64::NAN
    }
    fn map(self, _f: impl Fn(f64) -> f64) -> Self {
        refuse("a function of elements");
        Self::splat(f64::NAN)
    }
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        number(Operation::MulAdd(self, factor, summand))
    }
    fn fused(self, factor: Self, summand: Self) -> Self {
        number(Operation::Fused(self, factor, summand))
    }
    fn sqrt(self) -> Self {
        number(Operation::Unary(Unary::SquareRoot, self))
    }
    fn root(self) -> Self {
        number(Operation::Unary(Unary::Root, self))
    }
    fn abs(self) -> Self {
        number(Operation::Unary(Unary::Absolute, self))
    }
    fn min(self, other: Self) -> Self {
        number(Operation::Binary(Binary::Smaller, self, other))
    }
    fn max(self, other: Self) -> Self {
        number(Operation::Binary(Binary::Larger, self, other))
    }
    fn lt(self, other: Self) -> TracedMask {
        mask(Operation::Less(self, other))
    }
    fn le(self, other: Self) -> TracedMask {
        mask(Operation::LessOrEqual(self, other))
    }
    fn select(mask: TracedMask, yes: Self, no: Self) -> Self {
        number(Operation::Select(mask, yes, no))
    }
    fn somewhere(_mask: TracedMask) -> bool {
        true
    }
    fn powf(self, exponent: f64) -> Self {
        number(Operation::Power(self, exponent))
    }
    fn exp(self) -> Self {
        number(Operation::Unary(Unary::Exponential, self))
    }
    fn ln(self) -> Self {
        number(Operation::Unary(Unary::Logarithm, self))
    }
    fn cbrt(self) -> Self {
        number(Operation::Unary(Unary::CubeRoot, self))
    }
    fn sin(self) -> Self {
        number(Operation::Unary(Unary::Sine, self))
    }
    fn cos(self) -> Self {
        number(Operation::Unary(Unary::Cosine, self))
    }
    fn acos(self) -> Self {
        number(Operation::Unary(Unary::ArcCosine, self))
    }
    fn atan(self) -> Self {
        number(Operation::Unary(Unary::ArcTangent, self))
    }
}

#[cfg(test)]
mod tests;
