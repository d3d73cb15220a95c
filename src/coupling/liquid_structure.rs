//! Liquid and structure: the structure is a wall of the liquid that moves, and takes the reaction of the liquid.
//! After Antoci, Gallati & Sibilla 2007, with the wall pressure of Adami, Hu & Adams 2012.

use super::{CoupledParticle, Coupling};
use crate::scalar::Real;
#[cfg(feature = "devices")]
use crate::scalar::Record;
use crate::term::TermDoc;

/// A body of solid that a liquid meets as a wall.
///
/// Its particles stand among those of the liquid with the liquid's density at rest and their own volume,
/// m = ρ₀ m_s/ρ_s, so that the liquid's kernel sums are full at it and its inertia near the wall is its own. The wall
/// law of the liquid's scheme gives them a pressure, in which the acceleration of the structure counts (Adami, Hu &
/// Adams 2012, eq. 27), and the pair forces on the liquid act on the structure with the opposite sign (Antoci, Gallati
/// & Sibilla 2007, section 2.3).
///
/// It acts between every liquid and every solid of another group of which [`Scene::between`] says nothing else; the
/// structure's particles must be no farther apart than the liquid's.
///
/// [`Scene::between`]: crate::scene::Scene::between
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LiquidStructure;

impl<T: Real, const D: usize> Coupling<T, D> for LiquidStructure {
    fn name(&self) -> &'static str {
        "liquid and structure"
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: Coupling::<T, D>::name(self).into(),
            equation: "structure as wall, m = ρ₀ m_s/ρ_s; F on the structure = −Σ F on the liquid",
            source: "Antoci, Gallati & Sibilla 2007; Adami, Hu & Adams 2012, eq. 27",
        }
    }
    fn is_wall(&self) -> bool {
        true
    }
    fn wall_mass(&self, rest: T, particle: &CoupledParticle<T, D>) -> T {
        rest * particle.mass / particle.density
    }
    #[cfg(feature = "devices")]
    fn wall_mass_record(&self) -> Option<Record> {
        Record::of(3, |x| vec![x[0] * x[1] / x[2]]).ok()
    }
}
