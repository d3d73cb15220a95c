//! What schemes start from, as effects: pressure force, densities from sums, internal energy, and what changes them.
//! Each gives its terms; the density and energy forms are numbers of the scheme, [`Setting`].

use super::{Effect, Setting};
use crate::term::{
    Compression, In, InternalEnergy, KernelSum, MidpointReconstruction, PressureForce,
    RenormalisedCompression, RenormalisedPressureForce, stage,
};

/// The pressure force, and the rate of compression whose work it does.
impl<const D: usize> Effect<D> for PressureForce {
    type Terms = (
        In<stage::Pressure, Self>,
        In<stage::Compression, Compression>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(Compression))
    }
}

/// Both with corrected gradients.
impl<const D: usize> Effect<D> for RenormalisedPressureForce {
    type Terms = (
        In<stage::Pressure, Self>,
        In<stage::Compression, RenormalisedCompression>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(RenormalisedCompression))
    }
}

/// A part of the pressure force.
impl<const D: usize> Effect<D> for MidpointReconstruction {
    type Terms = (In<stage::Pressure, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        super::not_negative(&[("strength of the midpoint reconstruction", self.strength)])
    }
}

/// Densities that may follow from sums, with the sums at rest and the contacts that go with them. A scheme without it integrates
/// its density.
impl<const D: usize> Effect<D> for KernelSum {
    type Terms = (In<stage::Sums, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
}

/// Internal energy, in an [`EnergyForm`](crate::scheme::EnergyForm). A scheme without it carries none.
impl<const D: usize> Effect<D> for InternalEnergy {
    type Terms = (In<stage::Power, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
}
