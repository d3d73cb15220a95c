//! Weakly compressible liquids with the options of a file.
//! Effects without pair terms are chosen at run time: they are in no loop that is compiled.

use super::super::{Part, vector};
use crate::fault::Fault;
use crate::format::LiquidScheme;
use meshfree::effect::{AcousticDamping, Effect, ExpansionMemory, ExtrapolatedPressure, Sponge};
use meshfree::kernel::{Kernel, WendlandC2};
use meshfree::prelude::{Scheme, schemes};
use meshfree::term::Fourtakas;
use meshfree::term::viscosity::MonaghanGingold;

/// The scheme of a file.
pub(super) fn liquid<const D: usize>(own: &LiquidScheme) -> Part<Scheme<f64, D>>
where
    WendlandC2: Kernel<D>,
{
    let field = "scheme.weakly_compressible";
    let sponge = match &own.sponge {
        None => None,
        Some(own) => {
            let place = vector::<D>(&own.place, &format!("{field}.sponge.place"))?;
            let normal = vector::<D>(&own.normal, &format!("{field}.sponge.normal"))?;
            let layer = Sponge::beyond(place, normal, own.thickness, own.rate);
            Some(right::<D, _>(layer, &format!("{field}.sponge"))?)
        }
    };
    let damping = own.acoustic_damping.filter(|strength| *strength != 0.0);
    let damping = damping.map(|strength| {
        let damping = AcousticDamping { strength };
        right::<D, _>(damping, &format!("{field}.acoustic_damping"))
    });
    let ready = schemes::weakly_compressible();
    let standard = *ready.viscosity();
    let mut ready = ready
        .with_viscosity(MonaghanGingold {
            alpha: own.alpha.unwrap_or(standard.alpha),
            ..standard
        })
        .density_diffusion(Fourtakas {
            delta: own.delta.unwrap_or(Fourtakas::default().delta),
        })
        .walls(ExtrapolatedPressure {
            floor: own
                .wall_floor
                .unwrap_or(ExtrapolatedPressure::default().floor),
        });
    if let Some(ratio) = own.h_over_dx {
        ready = ready.h_over_dx(ratio);
    }
    Ok(ready
        .with(damping.transpose()?)
        .with(own.expansion_memory.then_some(ExpansionMemory))
        .with(sponge)
        .compose())
}

/// An effect, unless its numbers make none.
fn right<const D: usize, A: Effect<D>>(effect: A, field: &str) -> Part<A> {
    match effect.problems().first() {
        Some(problem) => Err(Fault::of_part(field, *problem)),
        None => Ok(effect),
    }
}
