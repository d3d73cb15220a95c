//! How smoothing lengths change: laws of a scheme, each with the loops that it needs.
//! Vesenjak & Ren 2007, eq. 6; Springel & Hernquist 2002.

use super::{Effect, Setting};
use crate::sweep::SmoothingMode;

/// How the smoothing length changes. As an effect it is the choice of a run: loops of every law are compiled.
/// [`MixedSpacing`], [`DivergenceSmoothing`] and [`ConsistentSmoothing`] each compile their own alone. The last of a list holds.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Smoothing {
    /// Fixed, h = η dx with one dx.
    #[default]
    Fixed,
    /// Fixed, h = η dx of every body: pairs use the mean of both.
    Mixed,
    /// Follows the divergence.
    Divergence(DivergenceSmoothing),
    /// Follows the density.
    Consistent(ConsistentSmoothing),
}

impl Smoothing {
    /// How pairs get their smoothing length.
    pub(crate) fn mode(self) -> SmoothingMode {
        match self {
            Self::Fixed => SmoothingMode::Uniform,
            Self::Mixed | Self::Divergence(_) => SmoothingMode::Mean,
            Self::Consistent(_) => SmoothingMode::Own,
        }
    }

    /// Whether the smoothing length of a particle changes.
    pub(crate) fn varies(self) -> bool {
        matches!(self, Self::Divergence(_) | Self::Consistent(_))
    }

    /// This law, or the one that is said after it. Lengths that vary may differ from body to body already.
    pub(super) fn then(self, next: Option<Self>) -> Self {
        match next {
            Some(Self::Mixed) if self.varies() => self,
            next => next.unwrap_or(self),
        }
    }
}

/// Allows bodies of different spacing: pairs use the mean of their smoothing lengths.
#[derive(Clone, Copy, Debug, Default)]
pub struct MixedSpacing;

/// Smoothing lengths that follow the divergence within limits, as in LS-DYNA (Vesenjak & Ren 2007, eq. 6).
///
#[doc = include_str!("../../docs/equations/smoothing_divergence.html")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct DivergenceSmoothing {
    /// Smallest h in units of η dx, the first of the body.
    pub smallest: f64,
    /// Largest h in units of η dx.
    pub largest: f64,
}

/// Smoothing lengths that are solved together with the density, with grad-h terms: η is h/dx
/// (Springel & Hernquist 2002; Price 2012).
///
#[doc = include_str!("../../docs/equations/smoothing_consistent.html")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ConsistentSmoothing {
    /// Smallest h in units of η dx, the first of the body.
    pub smallest: f64,
    /// Largest h in units of η dx.
    pub largest: f64,
}

macro_rules! law {
    ($($Law:ty: $modes:expr, $smoothing:expr;)*) => {$(
        impl<const D: usize> Effect<D> for $Law {
            type Terms = ();
            const MODES: u8 = $modes;
            const BOOKS_ENERGY: bool = true;
            fn terms(&self, _setting: &Setting) {}
            fn smoothing(&self) -> Option<Smoothing> {
                Some($smoothing(*self))
            }
        }
    )*};
}
law! {
    Smoothing: SmoothingMode::ALL, core::convert::identity;
    MixedSpacing: SmoothingMode::Mean.bit(), |_| Smoothing::Mixed;
    DivergenceSmoothing: SmoothingMode::Mean.bit(), Smoothing::Divergence;
    ConsistentSmoothing: SmoothingMode::Own.bit(), Smoothing::Consistent;
}
