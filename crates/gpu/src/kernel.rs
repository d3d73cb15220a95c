//! What stands around the body of a kernel in each language: its buffers, its place among threads, and functions that it calls.
//! Bodies are made of the few statements that both languages have.

use crate::split::{functions, names, through_functions};
use crate::{Dialect, Language, Precision, elementary};

/// Threads of a work group.
pub const THREADS: u32 = 64;

/// An array that a kernel is given.
#[derive(Clone, Copy, Debug)]
pub struct Array {
    pub name: &'static str,
    /// Whether it holds numbers, and not indices.
    pub numbers: bool,
    pub writable: bool,
}

impl Array {
    pub const fn numbers(name: &'static str) -> Self {
        Self {
            name,
            numbers: true,
            writable: false,
        }
    }
    pub const fn indices(name: &'static str) -> Self {
        Self {
            numbers: false,
            ..Self::numbers(name)
        }
    }
    pub const fn written(self) -> Self {
        Self {
            writable: true,
            ..self
        }
    }
}

/// A kernel without its body, which runs for every `i` from `scene.first` on, `scene.count` of them.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    pub dialect: Dialect,
    pub name: &'a str,
    pub buffers: &'a [Array],
}

impl Frame<'_> {
    /// The whole text with a body, each array being bound as one.
    pub fn source(&self, body: &str, threads: u32) -> String {
        self.source_in_parts(body, threads, (&[], 0))
    }

    /// The same in WGSL with arrays that are bound in parts of so many bytes: how many each has, one where that is not said.
    pub fn source_in_parts(&self, body: &str, threads: u32, parts: (&[u64], u64)) -> String {
        let Self {
            dialect,
            name,
            buffers,
        } = *self;
        let t = dialect.scalar();
        let arrays = buffers.iter();
        match dialect.language {
            Language::Wgsl => {
                let (mut declared, mut body) = (String::new(), body.to_string());
                let mut binding = 0;
                for (n, own) in arrays.enumerate() {
                    let access = if own.writable { "read_write" } else { "read" };
                    let of = if own.numbers { t } else { "u32" };
                    let count = parts.0.get(n).copied().unwrap_or(1);
                    for name in names(own.name, count) {
                        binding += 1;
                        declared += &format!(
                            "@group(0) @binding({binding}) var<storage, {access}> {name}: array<{of}>;\n"
                        );
                    }
                    if count > 1 {
                        let bytes = if own.numbers {
                            dialect.precision.bytes() as u64
                        } else {
                            4
                        };
                        declared += &functions(own, of, (count, parts.1 / bytes));
                        body = through_functions(&body, own.name);
                    }
                }
                let (bits, endless, undefined) = match dialect.precision {
                    Precision::Single => ("u32", "0x7f800000u", "0x7fc00000u"),
                    Precision::Double => ("u64", "0x7ff0000000000000lu", "0x7ff8000000000000lu"),
                };
                // `scene.zero` is not known to the compiler, which would refuse such constants.
                let special = |name: &str, value: &str| {
                    if body.contains(name) {
                        format!("let {name} = bitcast<{t}>({bits}(scene.zero) + {value});\n")
                    } else {
                        String::new()
                    }
                };
                let functions = if body.contains("_of(") {
                    elementary::functions(dialect)
                } else {
                    String::new()
                };
                format!(
                    "struct Scene {{ count: u32, row: u32, zero: u32, first: u32, length: u32, stride: u32, target_at: u32, spare: u32, }}
@group(0) @binding(0) var<uniform> scene: Scene;
{}{functions}@compute @workgroup_size({threads})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
let n = id.y * scene.row + id.x;
if (n >= scene.count) {{ return; }}
let i = n + scene.first;
{}{}{body}}}
",
                    declared,
                    special("endless", endless),
                    special("undefined", undefined),
                )
            }
            Language::Cuda => {
                let arrays = arrays.map(|own| {
                    let constant = if own.writable { "" } else { "const " };
                    let of = if own.numbers { t } else { "unsigned" };
                    format!(", {constant}{of}* __restrict__ {}", own.name)
                });
                let of = match dialect.precision {
                    Precision::Single => |bits: u64| format!("__int_as_float({:#x})", bits >> 32),
                    Precision::Double => |bits: u64| format!("__longlong_as_double({bits:#x}ll)"),
                };
                let single = dialect.precision == Precision::Single;
                let special = |name: &str, [f, d]: [u64; 2]| {
                    if body.contains(name) {
                        format!(
                            "const {t} {name} = {};\n",
                            of(if single { f << 32 } else { d })
                        )
                    } else {
                        String::new()
                    }
                };
                // One group a multiprocessor at least: without the second bound small sweeps are held to 48 registers, and spill.
                format!(
                    "struct Scene {{ unsigned count, row, zero, first, length, stride, target_at, spare; }};
extern \"C\" __global__ void __launch_bounds__({threads}, 1) {name}(const Scene scene{}) {{
const unsigned n = blockIdx.x * blockDim.x + threadIdx.x;
if (n >= scene.count) return;
const unsigned i = n + scene.first;
{}{}{body}}}
",
                    arrays.collect::<String>(),
                    special("endless", [0x7f80_0000, 0x7ff0_0000_0000_0000]),
                    special("undefined", [0x7fc0_0000, 0x7ff8_0000_0000_0000]),
                )
            }
        }
    }
}

/// Statements that both languages have, in their words.
impl Dialect {
    /// An index that does not change.
    pub(crate) fn index(self, name: &str, value: &str) -> String {
        match self.language {
            Language::Wgsl => format!("let {name} = {value};\n"),
            Language::Cuda => format!("const unsigned {name} = {value};\n"),
        }
    }
    /// A number that changes.
    pub(crate) fn variable(self, name: &str, value: &str) -> String {
        let t = self.scalar();
        match self.language {
            Language::Wgsl => format!("var {name}: {t} = {value};\n"),
            Language::Cuda => format!("{t} {name} = {value};\n"),
        }
    }
    /// An index that changes.
    pub(crate) fn counter(self, name: &str, value: &str) -> String {
        match self.language {
            Language::Wgsl => format!("var {name}: u32 = {value};\n"),
            Language::Cuda => format!("unsigned {name} = {value};\n"),
        }
    }
    /// The whole part of a number that is not negative.
    pub(crate) fn whole(self, value: &str) -> String {
        match self.language {
            Language::Wgsl => format!("u32({value})"),
            Language::Cuda => format!("unsigned({value})"),
        }
    }
    /// The head of a loop over indices.
    pub(crate) fn each(self, name: &str, from: &str, to: &str) -> String {
        let declared = match self.language {
            Language::Wgsl => "var",
            Language::Cuda => "unsigned",
        };
        format!("for ({declared} {name} = {from}; {name} < {to}; {name}++) {{\n")
    }
}

/// Numbers as a device holds them.
pub fn pack(numbers: impl Iterator<Item = f64>, precision: Precision) -> Vec<u8> {
    match precision {
        Precision::Single => numbers.flat_map(|x| (x as f32).to_ne_bytes()).collect(),
        Precision::Double => numbers.flat_map(f64::to_ne_bytes).collect(),
    }
}

/// What [`pack`] has packed.
pub fn unpack(bytes: &[u8], precision: Precision) -> Vec<f64> {
    match precision {
        Precision::Single => {
            let all = bytes.as_chunks::<4>().0.iter();
            all.map(|own| f64::from(f32::from_ne_bytes(*own))).collect()
        }
        Precision::Double => {
            let all = bytes.as_chunks::<8>().0.iter();
            all.map(|own| f64::from_ne_bytes(*own)).collect()
        }
    }
}

/// Indices as a device holds them.
pub fn pack_indices(all: &[u32]) -> Vec<u8> {
    all.iter().flat_map(|own| own.to_ne_bytes()).collect()
}

/// What [`pack_indices`] has packed.
pub fn unpack_indices(bytes: &[u8]) -> Vec<u32> {
    let all = bytes.as_chunks::<4>().0.iter();
    all.map(|own| u32::from_ne_bytes(*own)).collect()
}
