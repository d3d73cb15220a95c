//! Impact of rods with the options of a file.
//! Number density, without shear.

use crate::format::ImpactScheme;
use meshfree::prelude::{Scheme, schemes};
use meshfree::term::viscosity::LimitedMonaghanGingold;

/// The scheme of a file.
pub(super) fn impact(own: &ImpactScheme) -> Scheme<f64, 1> {
    let ready = schemes::impact();
    let standard = *ready.viscosity();
    let mut ready = ready.with_viscosity(LimitedMonaghanGingold {
        alpha: own.alpha.unwrap_or(standard.alpha),
        beta: own.beta.unwrap_or(standard.beta),
    });
    if let Some(ratio) = own.h_over_dx {
        ready = ready.h_over_dx(ratio);
    }
    ready.compose()
}
