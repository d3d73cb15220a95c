//! Advice: the dimensionless numbers of a scene, and which effects they call for.
//! It says require, recommend, optional, skip or impossible, with number, band and reason, and changes nothing.
//!
//! [`Scene::advise`] reads materials, velocities, loads, motions, sizes and spacings; what a scene cannot know, such as a surface
//! tension, comes with [`Known`]. [`Scene::strict`] makes what is required and missing an error.
//!
//! ```
//! use meshfree::prelude::*;
//! use meshfree::scene::advice::{Known, Need};
//! let rods = Scene::<f64, 1>::new(schemes::impact())
//!     .body(Body::block("striker", catalogue::copper(), [0.0], [0.01], 2e-4).velocity([20.0]))
//!     .body(Body::block("target", catalogue::copper(), [0.01], [0.05], 2e-4));
//! let advice = rods.advise(26e-6, &Known::default());
//! println!("{advice}");
//! let strength = advice.of("plasticity").next().map(|line| (line.value, line.need));
//! assert!(strength.is_some_and(|(ratio, need)| (ratio - 0.463).abs() < 1e-3 && need == Need::Skip));
//! // Nothing that is required is missing.
//! let simulation = rods.strict(26e-6, &Known::default())?.build()?;
//! # assert_eq!(simulation.particles(), 250);
//! # Ok::<(), Error>(())
//! ```
//!
//! # The numbers
//!
//! U is the speed of the flow \[m/s\], the largest of what bodies start with, what walls and loads give and
//! [`Known::speed`]; u the particle velocity behind the shock of an impact; L the largest extent \[m\] of a liquid, of a solid
//! its extent along the impact; t the end time \[s\]; h and dx smoothing length and spacing \[m\].
//!
//! | effect | number | skip | require |
//! |---|---|---|---|
//! | physical sound speed | U/c; t c/L | < 0.1; ≥ 10⁴ | ≥ 0.1; < 100 |
//! | energy and shock viscosity | u/c, U/c | < 0.1 | ≥ 0.3 |
//! | nonlinear equation of state | S u/c | < 0.01 | ≥ 0.1 |
//! | plasticity | ρ c ΔU/(2 Y), of unlike bodies Z₁Z₂/(Z₁+Z₂) ΔU/Y; E ε/Y of clamps that move | < 0.8 | ≥ 1 |
//! | plasticity in the flow | ρ ΔU²/Y (Johnson 1972) | < 10⁻³ | never: the number above decides |
//! | thermal pressure | Γ ρ e/p, e = u²/2 | < 0.01 | ≥ 0.05 |
//! | heat conduction | κ t/L² | < 0.1 | ≥ 0.1 |
//! | rate of strain in the yield stress | Y(ε̇)/Y(0) − 1 | < 0.05 | ≥ 0.1 |
//! | sign of pressure in the yield stress | Y(p)/Y(−p) − 1 | < 0.05 | ≥ 0.1 |
//! | contact that opens | t c/(2 L) | < 1 | ≥ 1 |
//! | viscosity | U L/ν | ≥ 10⁴ | < 10³ |
//! | viscosity, against that of the scheme | (α h c/10)/ν | Re ≥ 10⁴ | impossible ≥ 1 |
//! | no-slip walls | U dx/ν | ≥ 50 | < 10 |
//! | sound speed above that of viscous pressure | p_v/(ρ c²), p_v of lubrication theory: 1.5 μ V L²/h³ of a film that plates close with V, 12 μ U L/h² of a gap with [`Known::gap`] and [`Known::speed`] | < 0.01 | impossible ≥ 0.03 |
//! | pressure by differences, in slow viscous flow (Re < 10³) | p/(μ U/L + ρ U²) | < 3 | recommended ≥ 30 |
//! | gravity | U/√(g L), or a/g | ≥ 10 | < 10 |
//! | surface tension | ρ U² L/σ; ρ a L²/σ | ≥ 10³ | < 100; < 10 |
//! | two-way coupling | 0.014 (ρ U²/E)(L/t)³ | < 10⁻³ | ≥ 10⁻² |
//! | two-way coupling, added mass | ρ L/(ρₛ t) | < 0.1 | ≥ 1, where the wall bends by 10⁻² or more |
//! | cavitation | (p − p_v)/(ρ U²/2) | ≥ 1 | < 0 |
//! | gas next to the liquid | ρ₂/ρ₁ | < 0.01 without pockets | ≥ 0.01 |
//! | spacing across a wall, gap or film | thickness/dx | ≥ 5 | impossible < 4 |
//! | spacing across what bends in three dimensions | thickness/dx | ≥ 7.5 | never: it costs accuracy |
//! | rows of a [recorded motion](crate::boundary::Recorded) | how far the spline through every other row s₂ passes the rows, over the amplitude A | < 0.01 | impossible ≥ 0.1 |
//! | rows of an [open boundary](crate::boundary::TimeSeries) | the same of a flow, strength or pressure q, over half the range A of its rows | < 0.01 | impossible ≥ 0.1 |
//!
//! They are estimates of orders of magnitude, and their bands customary ones: a number near a bound says little.
//! An [ablation](crate::study::ablation) tells what an effect really changes.

mod bands;
mod known;
mod liquids;
mod measures;
mod print;
mod rows;
mod solids;
mod viscous;

pub use bands::{Band, Scale};
pub use known::Known;

use super::Scene;
use crate::error::{BuildError, Error, Problem, Result};
use crate::scalar::Real;
use measures::Measures;

/// How much a scene needs an effect, from most to least; what cannot be had comes last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Need {
    /// The answer is wrong without it.
    Require,
    /// It is at the limit: worth its price as a check.
    Recommend,
    /// It changes some answers: see the reason.
    Optional,
    /// It changes nothing that shows.
    Skip,
    /// The scene cannot show it as it is.
    Impossible,
}

impl Need {
    /// Its name in a table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Require => "require",
            Self::Recommend => "recommend",
            Self::Optional => "optional",
            Self::Skip => "skip",
            Self::Impossible => "impossible",
        }
    }
}

/// A line of advice: an effect, the number that speaks for or against it, and why.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Line {
    /// The effect.
    pub effect: &'static str,
    /// The body, or bodies, that it is about.
    pub of: String,
    /// The number, as a formula.
    pub number: &'static str,
    /// Its value \[1\].
    pub value: f64,
    /// What follows.
    pub need: Need,
    /// The band in which the value lies.
    pub band: String,
    /// Why.
    pub reason: String,
    /// Whether the scene has the effect, where that is known.
    pub present: Option<bool>,
}

impl Line {
    /// Whether it is required, and not there, or impossible.
    #[must_use]
    pub fn is_missing(&self) -> bool {
        match self.need {
            Need::Require => self.present == Some(false),
            Need::Impossible => true,
            _ => false,
        }
    }

    /// With more to the reason.
    fn because(mut self, more: &str) -> Self {
        self.reason = format!("{}; {more}", self.reason);
        self
    }

    /// With another need, for another reason.
    fn rather(self, need: Need, reason: &str) -> Self {
        Self { need, ..self }.because(reason)
    }
}

/// What the numbers of a scene say of effects: print it.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Advice {
    /// The lines, what concerns liquids first.
    pub lines: Vec<Line>,
    /// Numbers that could not be computed, and what would have to be known.
    pub unknown: Vec<String>,
}

impl Advice {
    /// The lines about an effect.
    pub fn of<'a>(&'a self, effect: &'a str) -> impl Iterator<Item = &'a Line> {
        self.lines.iter().filter(move |line| line.effect == effect)
    }

    /// What is required, and not there, or impossible.
    pub fn missing(&self) -> impl Iterator<Item = &Line> {
        self.lines.iter().filter(|line| line.is_missing())
    }

    fn add(&mut self, line: Line) {
        // What is no number says nothing.
        if line.value.is_nan() {
            self.unknown.push(format!(
                "{} of {}: {} is no number",
                line.effect, line.of, line.number
            ));
        } else {
            self.lines.push(line);
        }
    }

    fn lacks(&mut self, what: String) {
        if !self.unknown.contains(&what) {
            self.unknown.push(what);
        }
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// What the dimensionless numbers of the scene say of effects, for a run to `end` \[s\]; nothing is changed. See the
    /// [table of numbers](self).
    ///
    /// A scene that cannot be built is advised on as far as its numbers are numbers. Motions and loads are looked at at 257
    /// times between zero and `end`; those that depend on the particle ([`Scene::load`]) are not known to it.
    #[must_use]
    pub fn advise(&self, end: f64, known: &Known) -> Advice {
        let mut advice = Advice::default();
        for problem in known.problems() {
            advice.lacks(problem.to_string());
        }
        let measures = Measures::of(self, end, known);
        self.advise_on_liquids(&measures, known, &mut advice);
        self.advise_on_solids(&measures, known, &mut advice);
        self.advise_on_spacing(known, &mut advice);
        self.advise_on_rows(&mut advice);
        advice
    }

    /// The scene, unless [advice](Self::advise) for a run to `end` \[s\] requires an effect that is not there, or calls what
    /// it has impossible.
    ///
    /// # Errors
    /// [`Error::Build`] with every effect that is missing, its number and the reason.
    pub fn strict(self, end: f64, known: &Known) -> Result<Self> {
        let mut problems = Vec::new();
        if !(end.is_finite() && end > 0.0) {
            problems.push(Problem::Parameter {
                what: "end time of the advice".into(),
                value: end,
                must_be: "it must be finite and positive, in seconds",
            });
        }
        problems.extend(known.problems());
        let advice = self.advise(end, known);
        problems.extend(advice.missing().map(|line| Problem::Incompatible {
            what: format!(
                "{} of {} is {}: {} is {:.3}, {}; {}",
                line.effect,
                line.of,
                if line.need == Need::Impossible {
                    "impossible"
                } else {
                    "required and missing"
                },
                line.number,
                line.value,
                line.band,
                line.reason
            ),
            remedy: "give the scene the effect, or build it without Scene::strict if you know better",
        }));
        if problems.is_empty() {
            Ok(self)
        } else {
            Err(Error::Build(BuildError { problems }))
        }
    }
}
