//! The languages that a record is written in, and the precision of its numbers.
//! All that differs between them is here.

/// A language of devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Language {
    /// The language of WebGPU, which `wgpu` translates for Vulkan.
    Wgsl,
    /// CUDA C.
    Cuda,
}

/// The precision that a device computes in.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Precision {
    /// `f32`
    Single,
    /// `f64`
    Double,
}

impl Precision {
    /// Bytes a number.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::Single => 4,
            Self::Double => 8,
        }
    }
}

/// A language and a precision.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Dialect {
    /// The language.
    pub language: Language,
    /// The precision.
    pub precision: Precision,
}

impl Dialect {
    /// The name of the scalar type.
    #[must_use]
    pub fn scalar(self) -> &'static str {
        match (self.language, self.precision) {
            (Language::Wgsl, Precision::Single) => "f32",
            (Language::Wgsl, Precision::Double) => "f64",
            (Language::Cuda, Precision::Single) => "float",
            (Language::Cuda, Precision::Double) => "double",
        }
    }

    /// A constant, rounded to the scalar.
    #[must_use]
    pub fn constant(self, value: f64) -> String {
        let rounded = match self.precision {
            Precision::Single => f64::from(value as f32),
            Precision::Double => value,
        };
        // WGSL has no literal of these: kernels have names for them.
        if rounded.is_nan() {
            return "undefined".into();
        }
        if rounded.is_infinite() {
            return if rounded > 0.0 {
                "endless"
            } else {
                "(-endless)"
            }
            .into();
        }
        let digits = match self.precision {
            Precision::Single => format!("{:e}", value as f32),
            Precision::Double => format!("{value:e}"),
        };
        let digits = if digits.contains('.') {
            digits
        } else {
            digits.replace('e', ".0e")
        };
        let suffix = match (self.language, self.precision) {
            (Language::Wgsl, Precision::Double) => "lf",
            (Language::Cuda, Precision::Double) => "",
            (_, Precision::Single) => "f",
        };
        if digits.starts_with('-') {
            format!("({digits}{suffix})")
        } else {
            format!("{digits}{suffix}")
        }
    }

    /// The declaration of a number, or of a mask.
    #[must_use]
    pub fn declare(self, is_mask: bool, name: &str, value: &str) -> String {
        let of = if is_mask { "bool" } else { self.scalar() };
        match self.language {
            Language::Wgsl => format!("let {name}: {of} = {value};"),
            Language::Cuda => format!("const {of} {name} = {value};"),
        }
    }

    /// A number through its bits, which a driver that reorders sums cannot see through: `scene.zero` is not known to it.
    #[must_use]
    pub(crate) fn opaque(self, value: &str) -> String {
        match (self.language, self.precision) {
            (Language::Wgsl, Precision::Single) => {
                format!("bitcast<f32>(bitcast<u32>({value}) ^ scene.zero)")
            }
            (Language::Wgsl, Precision::Double) => {
                format!("bitcast<f64>(bitcast<u64>({value}) ^ u64(scene.zero))")
            }
            // CUDA C keeps the order of sums; a product that is fused into one is not rounded, and nothing else is lost.
            (Language::Cuda, _) => value.into(),
        }
    }

    /// One of two numbers.
    #[must_use]
    pub fn select(self, mask: &str, yes: &str, no: &str) -> String {
        match self.language {
            Language::Wgsl => format!("select({no}, {yes}, {mask})"),
            Language::Cuda => format!("({mask} ? {yes} : {no})"),
        }
    }

    /// The name of a function that the language has itself.
    #[must_use]
    pub fn function(self, name: &str) -> String {
        match (self.language, self.precision, name) {
            (Language::Cuda, Precision::Single, "abs") => "fabsf".into(),
            (Language::Cuda, Precision::Double, "abs") => "fabs".into(),
            (Language::Cuda, Precision::Single, _) => format!("{name}f"),
            _ => name.into(),
        }
    }

    /// The name of an elementary function: one of `exp`, `log`, `cbrt`, `sin`, `cos`, `acos` and `atan`.
    #[must_use]
    pub fn elementary(self, name: &str) -> String {
        match self.language {
            // See `elementary.rs`.
            Language::Wgsl => format!("{name}_of"),
            Language::Cuda => self.function(name),
        }
    }
}
