//! Physical viscosity: a pair form of the Laplacian, what walls without slip show, and laws that follow the shear.
//! Morris, Fox & Zhu 1997; Adami, Hu & Adams 2012, eqs. 22, 23.

use super::access::Summed;
use super::gradients::{GRADIENT_SUMS, velocity_gradient};
use super::{Chunk, Effect, Law, Rung, Setting, StepProgram, Tally};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::term::{In, Stage, Term, VelocityAtWall, VelocityGradient, ViscosityAtWall, stage};

/// A physical viscosity, of the liquids' own dynamic viscosity:
/// [`LaminarViscosity`](crate::term::LaminarViscosity), which follows, or
/// [`CentralViscosity`](crate::term::CentralViscosity).
///
#[doc = include_str!("../../docs/equations/laminar_viscosity.html")]
///
/// Walls [without slip](crate::boundary::Wall::no_slip) show the liquid its viscosity and its mirrored velocity
///
#[doc = include_str!("../../docs/equations/wall_velocity.html")]
///
/// with v_wall(x) \[m/s\] that the motion of the wall has at a place. Where it does not turn that is
/// 2 v_wall − Σ v_f W/Σ W of Adami, Hu & Adams 2012, eq. 23.
///
/// ```
/// use meshfree::effect::Laminar;
/// use meshfree::prelude::*;
/// use meshfree::term::LaminarViscosity;
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible()
///     .with(Laminar(LaminarViscosity))
///     .compose();
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Laminar<X>(pub X);

impl<const D: usize, X: Term<D>> Effect<D> for Laminar<X> {
    type Terms = (
        In<stage::Rates, X>,
        In<stage::Walls, VelocityAtWall>,
        In<stage::Walls, ViscosityAtWall>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (
            In::new(self.0.clone()),
            In::new(VelocityAtWall),
            In::new(ViscosityAtWall),
        )
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Walls, NoSlip);
    }
}

/// What a wall without slip shows: the mirrored velocity of [`Laminar`] and the mean viscosity; one with slip has none.
///
/// With ∇v_wall = L, its velocity is 2 v_wall(x_w) − Σ v_f W/Σ W − L·Σ r W/Σ W.
#[derive(Clone, Copy, Debug)]
struct NoSlip;

/// What a wall sees of the liquid before it.
const SEEN: [Output; 4] = [
    Output::UNITY,
    Output::LIQUID_VELOCITY,
    Output::LIQUID_ARM,
    Output::LIQUID_VISCOSITY,
];

impl<T: Real, const D: usize> Law<T, D> for NoSlip {
    fn name(&self) -> &'static str {
        "walls without slip"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::VELOCITY])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&SEEN)
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::VELOCITY, Field::DYNAMIC_VISCOSITY])
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Constraint)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let [unities, velocities, arms, viscosities] = SEEN.map(|sum| chunk.sum(sum));
        let first = chunk.first;
        let wall = chunk.around.wall.filter(|wall| wall.sticks());
        let dry = T::from_f64(super::walls::DRY);
        let ([], [velocity, viscosity]) =
            chunk.columns([], [Field::VELOCITY, Field::DYNAMIC_VISCOSITY]);
        for (n, (v, viscosity)) in velocity.chunks_exact_mut(D).zip(viscosity).enumerate() {
            let unity = unities.get(0, n);
            let Some(wall) = wall.filter(|_| unity > dry) else {
                *viscosity = T::zero();
                continue;
            };
            for (d, v) in v.iter_mut().enumerate() {
                let liquid = velocities.get(d, n);
                *v = *v + *v - liquid / unity;
            }
            if let Some(gradient) = wall.velocity_gradient(first + n) {
                for (d, v) in v.iter_mut().enumerate() {
                    for k in 0..D {
                        let arm = arms.get(k, n) / unity;
                        *v -= T::from_f64(gradient[(d, k)]) * arm;
                    }
                }
            }
            *viscosity = viscosities.get(0, n) / unity;
        }
        Tally::default()
    }
}

/// Lets the viscosity follow the shear rate by the
/// [law of each material](crate::material::Material::with_rheology), for liquids that are not
/// Newtonian.
///
#[doc = include_str!("../../docs/equations/shear_rate.html")]
///
/// D is the symmetric part of the velocity gradient without its trace, to which a wall
/// without slip shows the velocity that makes the liquid stick.
///
/// It costs a sweep for the velocity gradient, and goes with [`Laminar`]. Without it such a material keeps the
/// viscosity it has at rest.
///
/// ```
/// use meshfree::effect::{GeneralisedNewtonian, Laminar};
/// use meshfree::prelude::*;
/// use meshfree::term::LaminarViscosity;
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible()
///     .with(Laminar(LaminarViscosity))
///     .with(GeneralisedNewtonian)
///     .compose();
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct GeneralisedNewtonian;

impl<const D: usize> Effect<D> for GeneralisedNewtonian {
    type Terms = (In<stage::Flow, VelocityGradient>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(VelocityGradient),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Flow, *self);
    }
}

impl<T: Real, const D: usize> Law<T, D> for GeneralisedNewtonian {
    fn name(&self) -> &'static str {
        "viscosity from shear"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::DYNAMIC_VISCOSITY])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&GRADIENT_SUMS)
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::DYNAMIC_VISCOSITY])
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Flow)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let (around, gradients) = (chunk.around, GRADIENT_SUMS.map(|sum| chunk.sum(sum)));
        let ([], [viscosity]) = chunk.columns([], [Field::DYNAMIC_VISCOSITY]);
        if let Some(law) = around.material.rheology() {
            let mut rates = [T::zero(); SHEARED];
            for (part, viscosity) in viscosity.chunks_mut(SHEARED).enumerate() {
                let rates = &mut rates[..viscosity.len()];
                for (n, rate) in rates.iter_mut().enumerate() {
                    *rate = shear_rate(gradients, part * SHEARED + n);
                }
                law.viscosities(rates, viscosity);
            }
        }
        Tally::default()
    }
}

/// √(2 D:D) \[1/s\] with D the symmetric part of ∇v without its trace.
fn shear_rate<T: Real, const D: usize>(gradients: [Summed<'_, T, D>; 2], n: usize) -> T {
    let gradient = velocity_gradient(gradients, n);
    let half = T::from_f64(0.5);
    let mean = gradient.trace() / T::from_f64(D as f64);
    let mut square = T::zero();
    for a in 0..D {
        for b in 0..D {
            let own = (gradient[(a, b)] + gradient[(b, a)]) * half;
            let own = if a == b { own - mean } else { own };
            square += own * own;
        }
    }
    (square + square).sqrt()
}

/// Particles whose shear rates are on the stack at a time.
const SHEARED: usize = 64;
