//! No artificial viscosity.
//! For smooth flow, and to see what the rest of a scheme does by itself.

use super::{ArtificialViscosity, Viscous};
use crate::particles::Fields;
use crate::scalar::Lane;
use crate::term::{Layout, Pair, TermDoc};

/// No artificial viscosity: Π = 0. Costs nothing, and shocks ring without end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Inviscid;

impl Inviscid {
    /// There is nothing to choose.
    pub const STANDARD: Self = Self;
}

impl<const D: usize> ArtificialViscosity<D> for Inviscid {
    const READS: Fields = Fields::NONE;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, _pair: &Pair<'_, L, D, P>) -> Viscous<L> {
        Viscous {
            pi: L::zero(),
            signal: L::zero(),
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "no artificial viscosity".into(),
            equation: "Π = 0",
            source: "",
        }
    }
}
