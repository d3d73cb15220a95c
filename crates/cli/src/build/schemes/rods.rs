//! Impact of rods with the options of a file.
//! Number density, without shear.

use crate::format::ImpactScheme;
use meshfree::prelude::{Scheme, schemes};

/// The scheme of a file.
pub(super) fn impact(own: &ImpactScheme) -> Scheme<f64, 1> {
    let ready = schemes::impact();
    let viscosity = super::limited(*ready.viscosity(), [own.alpha, own.beta]);
    let mut ready = ready.with_viscosity(viscosity);
    if let Some(ratio) = own.h_over_dx {
        ready = ready.h_over_dx(ratio);
    }
    ready.compose()
}
