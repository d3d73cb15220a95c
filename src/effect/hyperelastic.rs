//! Hyperelastic stresses of total-Lagrangian solids: what a law makes of the deformation gradient, and its energy.
//! Laws are files of their own; this is what they share.

use super::total_lagrangian::{require_solid, stretches_of};
use super::{
    Around, CONSTANTS, LedgerColumn, Point, PointLaw, Reach, StepProgram, TotalLagrangian,
};
use crate::name;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::tensor::Square;
use crate::term::{Stage, TermDoc};
use core::fmt::Debug;

/// Energy that is stored in the deformation, over mass \[J/kg\].
pub(super) const ELASTIC: Field = Field::scalar(name!("elastic_energy", "J/kg"));
const F: Field = TotalLagrangian::DEFORMATION;
const PIOLA: Field = TotalLagrangian::PIOLA;

/// What a law makes of a deformation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response<L, const D: usize> {
    /// First Piola–Kirchhoff stress P \[Pa\].
    pub piola: Square<L, D>,
    /// −tr σ/3, with what is out of the plane \[Pa\].
    pub pressure: L,
    /// Stored energy ψ over the volume as built \[J/m³\].
    pub energy: L,
    /// Upper bound of the stiffness ∂²ψ/∂F² along any direction \[Pa\], for the step.
    pub stiffness: L,
}

/// A stored energy ψ(F) of Lamé's constants λ and μ \[Pa\].
pub(super) trait StoredEnergy: Copy + Debug + Send + Sync + 'static {
    const NAME: &'static str;
    /// The response to F, whose determinant, inverse, and bounds of the squared stretches and their inverses are given.
    fn respond<L: Lane, const D: usize>(
        &self,
        lame: [L; 2],
        gradient: &Square<L, D>,
        volume: L,
        back: &Square<L, D>,
        stretches: [L; 2],
    ) -> Response<L, D>;
}

/// What all hyperelastic laws do in a step.
pub(super) fn register<T: Real, const D: usize>(
    program: &mut StepProgram<T, D>,
    law: impl StoredEnergy,
    document: TermDoc,
) {
    declare(program, document);
    program.law(Stage::State, Hyperelastic(law));
}

/// The fields and the column of the ledger that all of them have.
pub(super) fn declare<T: Real, const D: usize>(program: &mut StepProgram<T, D>, document: TermDoc) {
    program.declare(PIOLA, 0.0);
    program.declare(ELASTIC, 0.0);
    program.store(ELASTIC);
    program.replace_pressure();
    program.ledger(LedgerColumn {
        name: "elastic energy",
        unit: "J",
        field: ELASTIC,
        times_mass: true,
        factor: 1.0,
    });
    program.document(document);
    require_solid(program);
}

/// P, the pressure of it, and the speed of longitudinal waves along X.
#[derive(Clone, Copy, Debug)]
struct Hyperelastic<E>(E);

impl<const D: usize, E: StoredEnergy> PointLaw<D> for Hyperelastic<E> {
    const NAME: &'static str = E::NAME;
    const READS: Fields = Fields::of(&[F, Field::REFERENCE_DENSITY]);
    const WRITES: Fields = Fields::of(&[PIOLA, ELASTIC, Field::PRESSURE, Field::SOUND_SPEED]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        [constants[0], constants[1]] = lame(around);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (gradient, rest) = (at.matrix(F), at.get(Field::REFERENCE_DENSITY));
        let (volume, back) = (gradient.determinant(), gradient.inverse(0.0).0);
        let bounds = stretches_of(&gradient, &back);
        let lame = [at.constant(0), at.constant(1)];
        let own = self.0.respond(lame, &gradient, volume, &back, bounds);
        at.set_matrix(PIOLA, &own.piola);
        at.set(ELASTIC, own.energy / rest);
        at.set(Field::PRESSURE, own.pressure);
        at.set(Field::SOUND_SPEED, (own.stiffness / rest).sqrt());
    }
}

/// Lamé's constants λ and μ \[Pa\] of a material.
pub(super) fn lame<T: Real, const D: usize>(around: &Around<'_, T, D>) -> [f64; 2] {
    let shear = around.material.shear_modulus.unwrap_or(0.0);
    [around.material.bulk_modulus() - 2.0 / 3.0 * shear, shear]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::{NeoHookean, StVenantKirchhoff};
    use crate::tensor::{Matrix, rotation};

    struct Of<const D: usize> {
        piola: Matrix<f64, D>,
        pressure: f64,
        energy: f64,
        stiffness: f64,
    }

    fn respond<E: StoredEnergy, const D: usize>(law: E, gradient: &Matrix<f64, D>) -> Of<D> {
        let own = Square::<f64, D>(core::array::from_fn(|a| {
            core::array::from_fn(|b| gradient[(a, b)])
        }));
        let back = own.inverse(0.0).0;
        let bounds = stretches_of(&own, &back);
        let own = law.respond([3.0, 2.0], &own, own.determinant(), &back, bounds);
        Of {
            piola: Matrix::from_fn(|a, b| own.piola.0[a][b]),
            pressure: own.pressure,
            energy: own.energy,
            stiffness: own.stiffness,
        }
    }

    /// A deformation that is neither small nor along axes.
    fn deformed<const D: usize>() -> Matrix<f64, D> {
        Matrix::from_fn(|a, b| {
            f64::from(u8::from(a == b)) + 0.07 * (2.0 * a as f64 - 3.0 * b as f64 + 1.0).sin()
        })
    }

    fn derives_from_its_energy_and_turns<E: StoredEnergy, const D: usize>(law: E) {
        let gradient = deformed::<D>();
        let own = respond(law, &gradient);
        let small = 1e-5;
        for a in 0..D {
            for b in 0..D {
                let energy = |by: f64| {
                    let mut moved = gradient;
                    moved[(a, b)] += by;
                    respond(law, &moved).energy
                };
                let slope = (energy(small) - energy(-small)) / (2.0 * small);
                assert!(
                    (slope - own.piola[(a, b)]).abs() < 1e-8,
                    "{slope} {}",
                    own.piola[(a, b)]
                );
                // No direction is stiffer than the step is told.
                let stress = |by: f64| {
                    let mut moved = gradient;
                    moved[(a, b)] += by;
                    respond(law, &moved).piola[(a, b)]
                };
                let stiff = (stress(small) - stress(-small)) / (2.0 * small);
                assert!(
                    stiff < own.stiffness * (1.0 + 1e-6),
                    "{stiff} {}",
                    own.stiffness
                );
            }
        }
        // All the way round, a tenth at a time.
        for tenth in 1..=10 {
            let angle = 0.2 * std::f64::consts::PI * f64::from(tenth);
            let spin = Matrix::<f64, D>::from_fn(|a, b| {
                angle * (b as f64 - a as f64).signum() * f64::from(u8::from(a + b == 1))
            });
            let turn = rotation(&spin);
            let turned = respond(law, &(turn * gradient));
            assert!((turned.piola - turn * own.piola).norm() < 1e-13);
            assert!(
                (turned.energy - own.energy).abs() < 1e-13
                    && (turned.pressure - own.pressure).abs() < 1e-13
            );
        }
    }

    #[test]
    fn stresses_derive_from_energies_and_turn_with_the_body() {
        derives_from_its_energy_and_turns::<_, 1>(NeoHookean);
        derives_from_its_energy_and_turns::<_, 2>(NeoHookean);
        derives_from_its_energy_and_turns::<_, 3>(NeoHookean);
        derives_from_its_energy_and_turns::<_, 2>(StVenantKirchhoff);
        derives_from_its_energy_and_turns::<_, 3>(StVenantKirchhoff);
    }

    /// Both are Hooke's law for small strains: σₓₓ of uniaxial strain is (λ + 2μ) ε.
    #[test]
    fn small_strains_obey_hooke() {
        let strain = 1e-6;
        let mut gradient = Matrix::<f64, 3>::identity();
        gradient[(0, 0)] += strain;
        for own in [
            respond(NeoHookean, &gradient),
            respond(StVenantKirchhoff, &gradient),
        ] {
            assert!((own.piola[(0, 0)] / strain / 7.0 - 1.0).abs() < 1e-5);
            assert!((own.pressure / strain + 13.0 / 3.0).abs() < 1e-4);
            assert!((own.energy / (3.5 * strain * strain) - 1.0).abs() < 1e-3);
        }
    }
}
