//! Gases with the options of a file.
//! Summed density with smoothing lengths that follow it.

use crate::format::GasScheme;
use meshfree::kernel::{Kernel, WendlandC4};
use meshfree::prelude::{Scheme, schemes};

/// The scheme of a file.
pub(super) fn gas<const D: usize>(own: &GasScheme) -> Scheme<f64, D>
where
    WendlandC4: Kernel<D>,
{
    let ready = schemes::gas();
    let viscosity = super::limited(*ready.viscosity(), [own.alpha, own.beta]);
    let mut ready = ready.with_viscosity(viscosity);
    if let Some(ratio) = own.h_over_dx {
        ready = ready.h_over_dx(ratio);
    }
    ready.compose()
}
