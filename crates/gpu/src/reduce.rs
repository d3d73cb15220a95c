//! Sums and extremes over particles: trees whose shape depends on their number alone, so bits do not depend on work groups.
//! A thread takes 64 numbers, and the next level those of 64 threads, until one is left.

use crate::device::{Bound, Buffer, Extent, Kernel};
use crate::kernel::Array;
use crate::{Device, Dialect, Error, Precision};

/// Numbers that a thread takes.
const SHARE: usize = 64;

/// What is found of columns of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Find {
    /// The sum of a column.
    Sum(usize),
    /// Its smallest number.
    Least(usize),
    /// Its largest number.
    Most(usize),
    /// Its smallest number, the lowest slot that has it, and the number of another column there.
    LeastAt(usize, usize),
}

impl Find {
    fn outputs(self) -> usize {
        match self {
            Self::LeastAt(..) => 3,
            _ => 1,
        }
    }
}

/// The kernels of a reduction: of columns, and of what another level has left.
#[derive(Debug)]
pub struct Reduction {
    first: Kernel,
    later: Kernel,
    pub outputs: usize,
    /// Where it is bound once and for all.
    pub bound: Vec<Bound>,
}

const BUFFERS: [Array; 2] = [Array::numbers("given"), Array::numbers("found").written()];

fn body(finds: &[Find], is_first: bool, dialect: Dialect) -> String {
    let t = dialect.scalar();
    let (mut body, mut at) = (String::new(), 0);
    // What is read of a slot, place by place of the outputs.
    let mut read = Vec::new();
    for find in finds {
        let column = |c: usize| format!("given[{c}u * scene.stride + at]");
        let own: Vec<String> = if is_first {
            match *find {
                Find::Sum(c) | Find::Least(c) | Find::Most(c) => vec![column(c)],
                Find::LeastAt(c, other) => vec![column(c), format!("{t}(at)"), column(other)],
            }
        } else {
            (at..at + find.outputs()).map(column).collect()
        };
        read.push((at, own));
        at += find.outputs();
    }
    body += "{\n";
    body += &dialect.index("at", "i");
    for (at, own) in &read {
        for (k, text) in own.iter().enumerate() {
            let name = format!("o{}", at + k);
            body = dialect.variable(&name, &dialect.constant(0.0)) + &body;
            body += &format!("{name} = {text};\n");
        }
    }
    body += "}\n";
    body += &dialect.each("q", "1u", &format!("{SHARE}u"));
    body += &dialect.index("at", "i + q * scene.count");
    body += "if (at < scene.first + scene.length) {\n";
    for (find, (at, own)) in finds.iter().zip(&read) {
        for (k, text) in own.iter().enumerate() {
            body += &(dialect.declare(false, &format!("n{}", at + k), text) + "\n");
        }
        let (o, n) = (format!("o{at}"), format!("n{at}"));
        match find {
            Find::Sum(_) => body += &format!("{o} = {o} + {n};\n"),
            Find::Least(_) => body += &format!("if ({n} < {o}) {{ {o} = {n}; }}\n"),
            Find::Most(_) => body += &format!("if ({n} > {o}) {{ {o} = {n}; }}\n"),
            Find::LeastAt(..) => {
                let [slot, other] = [at + 1, at + 2];
                body += &format!(
                    "if ({n} < {o} || ({n} == {o} && n{slot} < o{slot})) {{\n\
                     {o} = {n};\no{slot} = n{slot};\no{other} = n{other};\n}}\n"
                );
            }
        }
    }
    body += "}\n}\n";
    for k in 0..at {
        body += &format!("found[scene.target_at + {k}u * scene.count + n] = o{k};\n");
    }
    body
}

impl Reduction {
    pub fn new(device: &Device, finds: &[Find], precision: Precision) -> Result<Self, Error> {
        let dialect = device.dialect(precision);
        let name = format!("{finds:?}");
        let kernel = |is_first| {
            let body = body(finds, is_first, dialect);
            device.kernel(("reduction", &name), (dialect, &BUFFERS), &body)
        };
        Ok(Self {
            first: kernel(true)?,
            later: kernel(false)?,
            outputs: finds.iter().map(|find| find.outputs()).sum(),
            bound: Vec::new(),
        })
    }

    /// How many numbers a level between has at most, for some particles.
    pub fn between(&self, count: usize) -> usize {
        self.outputs * count.div_ceil(SHARE)
    }

    /// The levels over `count` slots from one on, of columns of `stride` numbers; what is found goes to a place of `answers`.
    pub fn bind(
        &self,
        device: &Device,
        (columns, stride): (&Buffer, usize),
        (first, count): (usize, usize),
        between: [&Buffer; 2],
        (answers, target): (&Buffer, usize),
    ) -> Vec<Bound> {
        let mut all = Vec::new();
        let mut own = Extent {
            first,
            length: count,
            stride,
            ..Extent::default()
        };
        let (mut kernel, mut from, mut level) = (&self.first, columns, 0);
        while own.length > 0 {
            own.count = own.length.div_ceil(SHARE);
            let is_last = own.count == 1;
            own.target = if is_last { target } else { 0 };
            let to = if is_last { answers } else { between[level % 2] };
            all.push(device.bind_over(kernel, &[from, to], own));
            if is_last {
                break;
            }
            own = Extent {
                first: 0,
                length: own.count,
                stride: own.count,
                ..own
            };
            (kernel, from, level) = (&self.later, to, level + 1);
        }
        all
    }
}
