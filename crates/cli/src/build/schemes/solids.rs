//! Solids that flow, with the options of a file.
//! As in the program `taylor_bar` of crates/validation, with the remedy of the tensile instability that it takes.

use crate::format::SolidScheme;
use meshfree::effect::{HourglassFree, Plasticity};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::prelude::{Scheme, schemes};
use meshfree::term::viscosity::LimitedMonaghanGingold;

/// The scheme of a file.
pub(super) fn solid<const D: usize>(own: &SolidScheme) -> Scheme<f64, D>
where
    WendlandC2: Kernel<D>,
{
    let ready = schemes::updated_lagrangian().with_kernel(WendlandC2);
    let standard = *ready.viscosity();
    ready
        .with_viscosity(LimitedMonaghanGingold {
            alpha: own.alpha.unwrap_or(0.5),
            beta: own.beta.unwrap_or(standard.beta),
        })
        .h_over_dx(own.h_over_dx.unwrap_or(2.0))
        .with(Plasticity)
        .with(HourglassFree::default())
        .compose()
}
