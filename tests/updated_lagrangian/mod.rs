//! Updated-Lagrangian solids: rings that collide, stretched lattices, waves in every kinematics, sheets that yield, spall.
//! Each runs with the cures of the tensile instability that the advice names, and without.

mod bending;
mod rings;
mod scale;
mod sheets;
mod spall;
mod stretched;
mod waves;

use meshfree::effect::{ArtificialStress, HourglassFree, Hypoelastic};
use meshfree::material::eos::Linear;
use meshfree::prelude::*;

const RHO: f64 = 1000.0;

/// A material of Young's modulus \[Pa\] and Poisson's ratio.
fn elastic(young: f64, poisson: f64) -> Material<f64> {
    let law = Linear::from_elastic_constants(RHO, young, poisson);
    Material::new("elastic", law).with_shear_modulus(young / (2.0 * (1.0 + poisson)))
}

/// What is done against the tensile instability.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cure {
    None,
    ArtificialStress,
    HourglassFree,
}

/// An elastic solid in the plane, with a cure.
fn plane(cure: Cure) -> Scheme<f64, 2> {
    let scheme = schemes::impact_by_continuity().with(Hypoelastic);
    match cure {
        Cure::None => scheme.compose(),
        Cure::ArtificialStress => scheme.with(ArtificialStress::default()).compose(),
        Cure::HourglassFree => scheme.with(HourglassFree::default()).compose(),
    }
}
