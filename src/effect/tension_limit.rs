//! What plastic flow asks of the limit of tension: a solid that breaks before it can yield has no use for its strength.
//! The limit is a cut-off of the pressure, or the spall strength where damage acts.

use super::{Damage, SceneFacts};
use crate::error::Problem;
use crate::material::strength::{PlasticState, ROOM_TEMPERATURE};
use crate::scalar::Real;

/// A body whose yield stress, at rest and at the mean tension where its pressure is cut off or it spalls, is above that
/// tension. In uniaxial strain mean tension is about the yield stress when flow begins (K/2G of it, 1.08 at a Poisson ratio of
/// 0.3), so such a solid parts before it flows.
pub(super) fn yields_beyond_tension<T: Real>(scene: &SceneFacts<'_, T>) -> Option<Problem> {
    let breaks = scene.written.contains(Damage::DAMAGE);
    scene.bodies.iter().find_map(|(body, material)| {
        let cut_off = material.eos().pressure_cut_off();
        let spall = || {
            let law = material.failure().filter(|_| breaks)?;
            law.pressure_at_failure()
        };
        let tension = cut_off.into_iter().chain(spall()).fold(f64::INFINITY, |least, p| least.min(-p));
        let state = PlasticState {
            temperature: ROOM_TEMPERATURE,
            pressure: -tension,
            ..PlasticState::default()
        };
        let law = material.strength().filter(|_| tension.is_finite())?;
        let stress = law.yield_stress(&state);
        (stress > tension).then(|| Problem::Incompatible {
            what: format!(
                "body `{body}`, of {}, yields at {stress} Pa and supports a tension of only {tension} Pa, by its \
                 cut-off or its spall strength: it separates before it yields",
                material.name
            ),
            remedy: "set the cut-off (Material::with_pressure_cut_off) or the spall strength beyond the yield stress, or take a \
                     strength that falls with tension (DruckerPrager, TensionCompression)",
        })
    })
}
