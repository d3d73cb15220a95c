//! Physical viscosity: a pair form of the Laplacian, what walls without slip show, and laws that follow the shear.
//! Morris, Fox & Zhu 1997; Adami, Hu & Adams 2012, eqs. 22, 23.

use super::gradients::GRADIENT_SUMS;
use super::viscosity_switch::shear2;
use super::{Around, CONSTANTS, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Mask, Real};
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

/// What a wall without slip shows: the mirrored velocity of [`Laminar`] and the mean viscosity; one with slip has none. The buffer of an
/// inlet is liquid: it has its own velocity and the mean viscosity.
///
/// With ∇v_wall = L, its velocity is 2 v_wall(x_w) − Σ v_f W/Σ W − L·Σ r W/Σ W.
#[derive(Clone, Copy, Debug)]
struct NoSlip;

impl<const D: usize> PointLaw<D> for NoSlip {
    const NAME: &'static str = "walls without slip";
    const READS: Fields = Fields::of(&[Field::VELOCITY]);
    const WRITES: Fields = Fields::of(&[Field::VELOCITY, Field::DYNAMIC_VISCOSITY]);
    const SUMS: Outputs = Outputs::of(&[
        Output::UNITY,
        Output::LIQUID_VELOCITY,
        Output::LIQUID_ARM,
        Output::LIQUID_VISCOSITY,
    ]);
    const RUNG: Option<Rung> = Some(Rung::Constraint);
    const OF_WALLS: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let unity = at.sum(Output::UNITY);
        let (liquid, arm) = (
            at.sum_vector(Output::LIQUID_VELOCITY),
            at.sum_vector(Output::LIQUID_ARM),
        );
        let viscosity = at.sum(Output::LIQUID_VISCOSITY) / unity;
        let sticks = at.around.wall.is_some_and(|wall| wall.sticks());
        let flows = at.around.wall.is_some_and(|wall| wall.flows());
        let near = unity.gt(L::of(super::walls::DRY));
        let wet = L::Mask::all_of(sticks) & near;
        let viscous = L::Mask::all_of(sticks || flows) & near;
        at.set(
            Field::DYNAMIC_VISCOSITY,
            L::select(viscous, viscosity, L::zero()),
        );
        let gradient = at.wall.gradient;
        for d in 0..D {
            let own = at.get_at(Field::VELOCITY, d);
            let mut mirrored = own + own - liquid[d] / unity;
            for k in 0..D {
                mirrored -= gradient.0[d][k] * (arm[k] / unity);
            }
            at.set_at(Field::VELOCITY, d, L::select(wet, mirrored, own));
        }
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

impl<const D: usize> PointLaw<D> for GeneralisedNewtonian {
    const NAME: &'static str = "viscosity from shear";
    const READS: Fields = Fields::of(&[Field::DYNAMIC_VISCOSITY]);
    const WRITES: Fields = Fields::of(&[Field::DYNAMIC_VISCOSITY]);
    const SUMS: Outputs = Outputs::of(&GRADIENT_SUMS);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    fn prepare<T: Real>(&self, around: &Around<'_, T, D>, _all: &mut [f64; CONSTANTS]) -> bool {
        around.material.rheology().is_some()
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        if let Some(law) = at.around.material.rheology() {
            // √(2 D:D) with D the symmetric part of ∇v without its trace.
            let square = shear2(&at.velocity_gradient());
            at.set(
                Field::DYNAMIC_VISCOSITY,
                law.viscosity((square + square).sqrt()),
            );
        }
    }
}
