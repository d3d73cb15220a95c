//! The artificial viscosities by name, for command lines and files.
//! A kind is itself a viscosity, with a branch in the pair loop.

use super::{
    ArtificialViscosity, Balsara, CullenDehnen, Inviscid, LimitedMonaghanGingold, MonaghanGingold,
    MorrisMonaghan, Riemann, SignalVelocity, SwitchObject, Viscous,
};
use crate::particles::{Fields, Outputs};
use crate::scalar::Lane;
use crate::term::{Layout, Pair, Sums, TermDoc};
use core::fmt;
use core::str::FromStr;

/// Calls a macro with the list of all artificial viscosities, as `Type "name on the command line"`
/// separated by commas. Every test, benchmark and menu that runs over all viscosities takes them from
/// here.
///
/// ```
/// macro_rules! names {
///     ($($Viscosity:ident $name:literal),*) => { [$($name),*] };
/// }
/// let names = meshfree::for_each_viscosity!(names);
/// assert!(names.contains(&"limited"));
/// ```
#[macro_export]
macro_rules! for_each_viscosity {
    ($callback:ident) => {
        $callback! {
            Inviscid "none",
            MonaghanGingold "mg",
            LimitedMonaghanGingold "limited",
            SignalVelocity "signal",
            Balsara "balsara",
            MorrisMonaghan "morris-monaghan",
            CullenDehnen "cullen-dehnen",
            Riemann "riemann"
        }
    };
}

macro_rules! viscosity_kind {
    ($($Law:ident $name:literal),*) => {
        /// The artificial viscosities by name, each with its parameters.
        ///
        /// A kind is itself a viscosity: a program that takes the law from its user is compiled once,
        /// with a branch in the pair loop, and particles that carry what any of the laws reads. The
        /// sweeps before the rates run only for a law that needs them.
        ///
        /// On a command line a name may be followed by α and β: `limited`, `mg:0.5`, `mg:0.5,1`. For
        /// laws with a switch these are the largest α and the β that goes with it; for the Riemann
        /// solver the share of its dissipation and its limiter.
        ///
        /// ```
        /// use meshfree::term::viscosity::{MonaghanGingold, ViscosityKind};
        /// let kind: ViscosityKind = "mg:0.5".parse()?;
        /// assert_eq!(kind, MonaghanGingold { alpha: 0.5, beta: 2.0 }.into());
        /// assert_eq!(kind.with_alpha(1.0).to_string(), "mg");
        /// # Ok::<(), meshfree::term::viscosity::UnknownViscosity>(())
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub enum ViscosityKind {
            $(
                #[doc = concat!("[`", stringify!($Law), "`](struct@", stringify!($Law), "), `", $name, "` on a command line.")]
                $Law($Law),
            )*
        }

        impl ViscosityKind {
            /// All viscosities, with their standard parameters.
            pub const ALL: &'static [Self] = &[$(Self::$Law($Law::STANDARD)),*];

            /// The name on a command line, such as `morris-monaghan`.
            #[must_use]
            pub const fn key(&self) -> &'static str {
                match self {
                    $(Self::$Law(_) => $name,)*
                }
            }

            /// The linear coefficient α, if the law has one.
            #[must_use]
            pub fn alpha(&self) -> Option<f64> {
                match self { $(Self::$Law(law) => law.coefficients().map(|c| c.0),)* }
            }
            /// The quadratic coefficient β, if the law has one.
            #[must_use]
            pub fn beta(&self) -> Option<f64> {
                match self { $(Self::$Law(law) => law.coefficients().map(|c| c.1),)* }
            }
            /// The law with another α and β, which change nothing where a law has none.
            #[must_use]
            pub fn with_coefficients(self, alpha: f64, beta: f64) -> Self {
                match self { $(Self::$Law(law) => Self::$Law(law.with(alpha, beta)),)* }
            }
        }

        $(
            impl From<$Law> for ViscosityKind {
                fn from(law: $Law) -> Self {
                    Self::$Law(law)
                }
            }
        )*

        impl<const D: usize> ArtificialViscosity<D> for ViscosityKind {
            const READS: Fields =
                Fields::NONE$(.union(<$Law as ArtificialViscosity<D>>::READS))*;
            const NEEDS: Fields =
                Fields::NONE$(.union(<$Law as ArtificialViscosity<D>>::NEEDS))*;
            const WRITES: Outputs =
                Outputs::NONE$(.union(<$Law as ArtificialViscosity<D>>::WRITES))*;
            // Called, not copied into every loop: a choice at run time is paid at run time.
            #[inline(never)]
            fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>) -> Viscous<L> {
                match self { $(Self::$Law(law) => law.pair(pair),)* }
            }
            #[inline(never)]
            fn sums<L: Lane, P: Layout>(
                &self,
                pair: &Pair<'_, L, D, P>,
                sums: &mut Sums<L, D, P>,
            ) {
                match self { $(Self::$Law(law) => law.sums(pair, sums),)* }
            }
            fn document(&self) -> TermDoc {
                match self {
                    $(Self::$Law(law) => ArtificialViscosity::<D>::document(law),)*
                }
            }
            fn needs_velocity_gradient(&self) -> bool {
                match self {
                    $(Self::$Law(law) => ArtificialViscosity::<D>::needs_velocity_gradient(law),)*
                }
            }
            fn switch(&self) -> Option<Box<dyn SwitchObject>> {
                match self { $(Self::$Law(law) => ArtificialViscosity::<D>::switch(law),)* }
            }
            fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
                match self { $(Self::$Law(law) => ArtificialViscosity::<D>::problems(law),)* }
            }
        }
    };
}
for_each_viscosity!(viscosity_kind);

impl ViscosityKind {
    /// The law with another α.
    #[must_use]
    pub fn with_alpha(self, alpha: f64) -> Self {
        match self.beta() {
            Some(beta) => self.with_coefficients(alpha, beta),
            None => self,
        }
    }

    /// The law with another β.
    #[must_use]
    pub fn with_beta(self, beta: f64) -> Self {
        match self.alpha() {
            Some(alpha) => self.with_coefficients(alpha, beta),
            None => self,
        }
    }

    /// The law of the same name with its standard parameters.
    fn standard(&self) -> Self {
        let same = Self::ALL.iter().find(|kind| kind.key() == self.key());
        same.copied().unwrap_or(*self)
    }
}

/// α and β of a law under one face.
trait Coefficients: Sized {
    fn coefficients(&self) -> Option<(f64, f64)>;
    fn with(self, alpha: f64, beta: f64) -> Self;
}

impl Coefficients for Inviscid {
    fn coefficients(&self) -> Option<(f64, f64)> {
        None
    }
    fn with(self, _alpha: f64, _beta: f64) -> Self {
        self
    }
}

macro_rules! fixed {
    ($($Law:ident $beta:ident),*) => {$(
        impl Coefficients for $Law {
            fn coefficients(&self) -> Option<(f64, f64)> {
                Some((self.alpha, self.$beta))
            }
            fn with(self, alpha: f64, beta: f64) -> Self {
                Self { alpha, $beta: beta }
            }
        }
    )*};
}
fixed!(MonaghanGingold beta, LimitedMonaghanGingold beta, SignalVelocity beta, Balsara beta, Riemann limiter);

macro_rules! switched {
    ($($Law:ident),*) => {$(
        impl Coefficients for $Law {
            fn coefficients(&self) -> Option<(f64, f64)> {
                Some((self.maximum, self.maximum * self.beta_over_alpha))
            }
            fn with(self, alpha: f64, beta: f64) -> Self {
                // Without a linear part there is no ratio: keep the one there was.
                let beta_over_alpha = if alpha == 0.0 { self.beta_over_alpha } else { beta / alpha };
                Self { maximum: alpha, beta_over_alpha, ..self }
            }
        }
    )*};
}
switched!(MorrisMonaghan, CullenDehnen);

impl fmt::Display for ViscosityKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let standard = self.standard();
        match (self.alpha(), self.beta()) {
            (Some(alpha), Some(beta)) if self.beta() != standard.beta() => {
                f.pad(&format!("{}:{alpha},{beta}", self.key()))
            }
            (Some(alpha), _) if self.alpha() != standard.alpha() => {
                f.pad(&format!("{}:{alpha}", self.key()))
            }
            _ => f.pad(self.key()),
        }
    }
}

/// A text that names no viscosity of [`ViscosityKind::ALL`], or whose numbers cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown viscosity `{given}`; write a name, or name:alpha or name:alpha,beta; known are {}",
    known_viscosities()
)]
pub struct UnknownViscosity {
    /// The text that was given.
    pub given: String,
}

fn known_viscosities() -> String {
    let names: Vec<_> = ViscosityKind::ALL.iter().map(ViscosityKind::key).collect();
    names.join(", ")
}

impl FromStr for ViscosityKind {
    type Err = UnknownViscosity;
    fn from_str(text: &str) -> Result<Self, UnknownViscosity> {
        parse(text).ok_or_else(|| UnknownViscosity {
            given: text.to_owned(),
        })
    }
}

fn parse(text: &str) -> Option<ViscosityKind> {
    let text = text.trim().to_ascii_lowercase();
    let (name, numbers) = match text.split_once(':') {
        Some((name, numbers)) => (name, Some(numbers)),
        None => (text.as_str(), None),
    };
    let name = name.trim().replace(['_', ' '], "-");
    let kind = *ViscosityKind::ALL.iter().find(|kind| kind.key() == name)?;
    let Some(numbers) = numbers else {
        return Some(kind);
    };
    let (alpha, beta) = match numbers.split_once(',') {
        Some((alpha, beta)) => (alpha, Some(beta)),
        None => (numbers, None),
    };
    // A number for a law without numbers is a mistake, not a default.
    kind.alpha()?;
    let kind = kind.with_alpha(alpha.trim().parse().ok()?);
    match beta {
        Some(beta) => Some(kind.with_beta(beta.trim().parse().ok()?)),
        None => Some(kind),
    }
}
