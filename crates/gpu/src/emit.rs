//! A record as text of a device language, by one walk for all of them.
//! What no result needs is left out, what is done twice is done once, and what does not vary in a loop stands before it.

use crate::{Dialect, Precision};
use core::fmt::Write;
use meshfree::scalar::{Binary, Lane, Operation, Real, Record, Traced, TracedMask, Unary};
use std::collections::HashMap;

/// The text of a record.
#[derive(Clone, Debug)]
pub struct Text {
    /// Declarations of what does not vary in the loop.
    pub before: String,
    /// Declarations of what does.
    pub within: String,
    /// Expressions of the results.
    pub results: Vec<String>,
    /// How many operations there are before the loop, and in it.
    pub counts: [usize; 2],
}

/// The places that an operation takes numbers and masks from.
fn operands(operation: Operation) -> Vec<usize> {
    use Operation as O;
    match operation {
        O::Input(_) | O::Constant(_) | O::Everywhere(_) => Vec::new(),
        O::Unary(_, a) | O::Power(a, _) => vec![a.place()],
        O::Not(a) => vec![a.place()],
        O::Binary(_, a, b) | O::Less(a, b) | O::LessOrEqual(a, b) => vec![a.place(), b.place()],
        O::And(a, b) | O::Or(a, b) => vec![a.place(), b.place()],
        O::MulAdd(a, b, c) | O::Fused(a, b, c) => vec![a.place(), b.place(), c.place()],
        O::Select(mask, a, b) => vec![mask.place(), a.place(), b.place()],
    }
}

/// Which places the results need.
fn needed(record: &Record) -> Vec<bool> {
    let operations = record.operations();
    let mut needed = vec![false; operations.len()];
    for result in record.results() {
        needed[result.place()] = true;
    }
    for at in (0..operations.len()).rev() {
        if needed[at] {
            for operand in operands(operations[at]) {
                needed[operand] = true;
            }
        }
    }
    needed
}

/// Which sums and differences a difference takes apart again, as two-sums do for what rounding loses: drivers may not cancel them.
fn kept_apart(operations: &[Operation]) -> Vec<bool> {
    use Operation as O;
    let mut all = vec![false; operations.len()];
    for operation in operations {
        let O::Binary(Binary::Subtract, x, y) = *operation else {
            continue;
        };
        if let O::Binary(Binary::Add, a, b) = operations[x.place()] {
            all[x.place()] |= a == y || b == y;
        }
        if let O::Binary(Binary::Subtract, a, _) = operations[y.place()] {
            all[y.place()] |= a == x;
        }
    }
    all
}

/// What an operation becomes.
enum Made {
    /// An expression that stands where it is used: an input, a constant, or another place.
    Plain(String),
    Number(String),
    Mask(String),
}

/// What an operation makes of numbers that are known, in the arithmetic of the device.
fn fold<L: Lane>(operation: Operation, value: &dyn Fn(Traced) -> Option<f64>) -> Option<f64> {
    use Operation as O;
    let number = |at| value(at).map(L::of);
    let found = match operation {
        O::Constant(own) => L::of(own),
        O::Unary(function, a) => {
            let a = number(a)?;
            match function {
                Unary::Negate => -a,
                Unary::SquareRoot | Unary::Root => a.sqrt(),
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
        O::Binary(function, a, b) => {
            let (a, b) = (number(a)?, number(b)?);
            match function {
                Binary::Add => a + b,
                Binary::Subtract => a - b,
                Binary::Multiply => a * b,
                Binary::Divide => a / b,
                Binary::Smaller => a.min(b),
                Binary::Larger => a.max(b),
            }
        }
        O::MulAdd(a, b, c) | O::Fused(a, b, c) => number(a)?.mul_add(number(b)?, number(c)?),
        O::Power(a, exponent) => number(a)?.powf(exponent),
        _ => return None,
    };
    Some(found.extract(0).to_f64())
}

/// Names of places, and how operations read with them.
struct Names {
    dialect: Dialect,
    of: Vec<String>,
    /// Numbers and masks that are known.
    values: Vec<Option<f64>>,
    masks: Vec<Option<bool>>,
}

impl Names {
    fn number(&self, at: Traced) -> &str {
        &self.of[at.place()]
    }
    fn mask(&self, at: TracedMask) -> &str {
        &self.of[at.place()]
    }
    fn is_zero(&self, at: Traced) -> bool {
        self.values[at.place()] == Some(0.0)
    }
    fn known(&self, at: TracedMask) -> Option<bool> {
        self.masks[at.place()]
    }
    /// The number or the mask of an operation on what is known.
    fn learn(&mut self, at: usize, operation: Operation) -> bool {
        use Operation as O;
        let value = |own: Traced| self.values[own.place()];
        let number = match self.dialect.precision {
            Precision::Single => fold::<f32>(operation, &value),
            Precision::Double => fold::<f64>(operation, &value),
        };
        let both = |a, b| Some((value(a)?, value(b)?));
        let mask = match operation {
            O::Everywhere(own) => Some(own),
            O::Less(a, b) => both(a, b).map(|(a, b)| a < b),
            O::LessOrEqual(a, b) => both(a, b).map(|(a, b)| a <= b),
            O::Not(a) => self.known(a).map(|own| !own),
            O::And(a, b) | O::Or(a, b) => {
                let ends = matches!(operation, O::Or(..));
                match (self.known(a), self.known(b)) {
                    (Some(own), _) | (_, Some(own)) if own == ends => Some(ends),
                    (Some(_), Some(_)) => Some(!ends),
                    _ => None,
                }
            }
            _ => None,
        };
        if let Some(number) = number {
            self.of[at] = self.dialect.constant(number);
            self.values[at] = Some(number);
        } else if let Some(mask) = mask {
            self.of[at] = mask.to_string();
            self.masks[at] = Some(mask);
        }
        number.is_some() || mask.is_some()
    }
    fn unary(&self, function: Unary, a: &str) -> String {
        let d = self.dialect;
        let name = match function {
            Unary::Negate => return format!("-{a}"),
            Unary::SquareRoot | Unary::Root => d.function("sqrt"),
            Unary::Absolute => d.function("abs"),
            Unary::Exponential => d.elementary("exp"),
            Unary::Logarithm => d.elementary("log"),
            Unary::CubeRoot => d.elementary("cbrt"),
            Unary::Sine => d.elementary("sin"),
            Unary::Cosine => d.elementary("cos"),
            Unary::ArcCosine => d.elementary("acos"),
            Unary::ArcTangent => d.elementary("atan"),
        };
        format!("{name}({a})")
    }
    fn binary(&self, function: Binary, a: Traced, b: Traced) -> Made {
        let (x, y) = (self.number(a), self.number(b));
        let text = match function {
            Binary::Add if self.is_zero(a) => return Made::Plain(y.into()),
            Binary::Add | Binary::Subtract if self.is_zero(b) => return Made::Plain(x.into()),
            Binary::Add => format!("{x} + {y}"),
            Binary::Subtract => format!("{x} - {y}"),
            Binary::Multiply => format!("{x} * {y}"),
            Binary::Divide => format!("{x} / {y}"),
            // As lanes do, the second where neither is.
            Binary::Smaller => self.dialect.select(&format!("{x} < {y}"), x, y),
            Binary::Larger => self.dialect.select(&format!("{x} > {y}"), x, y),
        };
        Made::Number(text)
    }
    /// eʸ ˡⁿ ˣ of a size, with the sign of an odd power.
    fn power(&self, a: Traced, exponent: f64) -> String {
        let (d, x) = (self.dialect, self.number(a));
        let y = d.constant(exponent);
        if d.elementary("exp") == d.function("exp") {
            return format!("{}({x}, {y})", d.function("pow"));
        }
        let whole = exponent == exponent.trunc();
        let size = if whole {
            format!("{}({x})", d.function("abs"))
        } else {
            x.into()
        };
        let power = format!("exp_of({y} * log_of({size}))");
        if whole && exponent % 2.0 != 0.0 {
            let zero = d.constant(0.0);
            return d.select(&format!("{x} < {zero}"), &format!("-{power}"), &power);
        }
        power
    }
    fn make(&self, operation: Operation, input: &dyn Fn(usize) -> String) -> Made {
        use Operation as O;
        let d = self.dialect;
        match operation {
            O::Input(k) => Made::Plain(input(k)),
            // Known before.
            O::Constant(_) | O::Everywhere(_) => Made::Plain(String::new()),
            O::Unary(function, a) => Made::Number(self.unary(function, self.number(a))),
            O::Binary(function, a, b) => self.binary(function, a, b),
            O::MulAdd(a, b, c) if self.is_zero(c) => self.binary(Binary::Multiply, a, b),
            O::MulAdd(a, b, c) | O::Fused(a, b, c) => {
                let fma = d.function("fma");
                let [a, b, c] = [a, b, c].map(|at| self.number(at));
                Made::Number(format!("{fma}({a}, {b}, {c})"))
            }
            O::Power(_, 0.0) => Made::Plain(d.constant(1.0)),
            O::Power(a, exponent) => Made::Number(self.power(a, exponent)),
            O::Less(a, b) => Made::Mask(format!("{} < {}", self.number(a), self.number(b))),
            O::LessOrEqual(a, b) => Made::Mask(format!("{} <= {}", self.number(a), self.number(b))),
            O::And(a, b) | O::Or(a, b) => {
                for (own, other) in [(a, b), (b, a)] {
                    if self.known(own).is_some() {
                        return Made::Plain(self.mask(other).into());
                    }
                }
                let sign = if matches!(operation, O::Or(..)) {
                    "||"
                } else {
                    "&&"
                };
                Made::Mask(format!("{} {sign} {}", self.mask(a), self.mask(b)))
            }
            O::Not(a) => Made::Mask(format!("!{}", self.mask(a))),
            O::Select(mask, a, b) => match self.known(mask) {
                Some(true) => Made::Plain(self.number(a).into()),
                Some(false) => Made::Plain(self.number(b).into()),
                None if a == b => Made::Plain(self.number(a).into()),
                None => Made::Number(d.select(self.mask(mask), self.number(a), self.number(b))),
            },
        }
    }
}

/// Writes a record. `input` has the expression of an input, and whether it varies in the loop.
///
/// ```
/// use meshfree::scalar::Record;
/// use meshfree_gpu::{Dialect, Language, Precision, emit};
/// let record = Record::of(2, |given| vec![given[0] * given[0] * given[1]])?;
/// let dialect = Dialect { language: Language::Cuda, precision: Precision::Double };
/// let text = emit(&record, dialect, &|k| (["a", "b"][k].into(), k == 1));
/// assert_eq!(text.before, "const double t2 = a * a;\n");
/// assert_eq!(text.within, "const double t3 = t2 * b;\n");
/// # Ok::<(), meshfree::scalar::Unrecordable>(())
/// ```
#[must_use]
pub fn emit(record: &Record, dialect: Dialect, input: &dyn Fn(usize) -> (String, bool)) -> Text {
    emit_as('t', record, dialect, input)
}

/// The same with names that start with a letter.
pub(crate) fn emit_as(
    letter: char,
    record: &Record,
    dialect: Dialect,
    input: &dyn Fn(usize) -> (String, bool),
) -> Text {
    let operations = record.operations();
    let (needed, kept_apart) = (needed(record), kept_apart(operations));
    let mut names = Names {
        dialect,
        of: vec![String::new(); operations.len()],
        values: vec![None; operations.len()],
        masks: vec![None; operations.len()],
    };
    let mut varies = vec![false; operations.len()];
    let mut known: HashMap<String, String> = HashMap::new();
    let mut text = Text {
        before: String::new(),
        within: String::new(),
        results: Vec::new(),
        counts: [0; 2],
    };
    for (at, &operation) in operations.iter().enumerate() {
        if !needed[at] || names.learn(at, operation) {
            continue;
        }
        varies[at] = match operation {
            Operation::Input(k) => input(k).1,
            _ => operands(operation).iter().any(|&own| varies[own]),
        };
        let (is_mask, made) = match names.make(operation, &|k| input(k).0) {
            Made::Plain(made) => {
                // Another place under its name, with what is known of it.
                let same = |own: &usize| names.of[*own] == made;
                if let Some(own) = operands(operation).into_iter().find(same) {
                    names.values[at] = names.values[own];
                    names.masks[at] = names.masks[own];
                }
                names.of[at] = made;
                continue;
            }
            Made::Number(made) if kept_apart[at] => (false, dialect.opaque(&made)),
            Made::Number(made) => (false, made),
            Made::Mask(made) => (true, made),
        };
        names.of[at] = if let Some(name) = known.get(&made) {
            name.clone()
        } else {
            let name = format!("{letter}{at}");
            let (to, count) = if varies[at] {
                (&mut text.within, 1)
            } else {
                (&mut text.before, 0)
            };
            writeln!(to, "{}", dialect.declare(is_mask, &name, &made)).expect("a string");
            text.counts[count] += 1;
            known.insert(made, name.clone());
            name
        };
    }
    let results = record.results().iter();
    text.results = results.map(|at| names.number(*at).to_owned()).collect();
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(record: &Record) -> Text {
        let dialect = Dialect {
            language: crate::Language::Wgsl,
            precision: Precision::Double,
        };
        emit(record, dialect, &|k| (format!("a{k}"), k > 0))
    }

    #[test]
    fn what_is_dead_or_done_twice_is_left_out() {
        let record = Record::of(2, |given| {
            let [a, b] = [given[0], given[1]];
            let _ = a / b;
            vec![(a + b) * (a + b), a + b]
        });
        let found = text(&record.expect("arithmetic"));
        assert_eq!(found.counts, [0, 2]);
        assert!(!found.within.contains('/'), "{}", found.within);
        // The square is made of the sum, which is the other result.
        let [square, sum] = &found.results[..] else {
            panic!("{:?}", found.results);
        };
        assert!(
            found.within.contains(&format!("{sum} * {sum}")) && square != sum,
            "{}",
            found.within
        );
    }

    #[test]
    fn what_does_not_vary_stands_before_the_loop() {
        let record = Record::of(2, |given| vec![(given[0] * given[0]) / given[1]]);
        let found = text(&record.expect("arithmetic"));
        assert_eq!(found.before, "let t2: f64 = a0 * a0;\n");
        assert_eq!(found.within, "let t3: f64 = t2 / a1;\n");
    }

    #[test]
    fn choices_that_are_known_are_made() {
        use meshfree::scalar::Mask;
        let record = Record::of(2, |given| {
            let always = <Traced as Lane>::Mask::all_of(true);
            let nothing = Traced::splat(0.0);
            let sum = given[0].mul_add(given[1], nothing) + nothing;
            vec![Lane::select(always & !always, nothing, sum)]
        });
        let found = text(&record.expect("arithmetic"));
        assert_eq!(found.within, "let t4: f64 = a0 * a1;\n");
        assert_eq!(found.results, ["t4"]);
    }
}
