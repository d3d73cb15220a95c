//! Ready schemes: the lists of terms that a user would write, with defaults that are measured.
//! Each prints itself with equations, fields and sources.
//!
//! Each returns a [`SchemeBuilder`], so a single choice can be changed and
//! the rest kept:
//!
//! ```
//! use meshfree::prelude::*;
//! let scheme: Scheme<f64, 1> = schemes::impact().h_over_dx(1.3).named("wider").compose();
//! assert!(scheme.to_string().starts_with("wider: cubic spline kernel, h/dx 1.3"));
//! ```
//!
//! | | [`impact`] | [`impact_by_continuity`] | [`lam2002`] |
//! |---|---|---|---|
//! | density | number density at rest | continuity, V | summation, smoothed |
//! | viscosity | limited, α = 2, β = 2 | the same | plain, α = 1, β = 2 |
//! | midpoint reconstruction χ | 1/3 | 1/3 | 0 |
//! | first-moment consistency factor at rest | yes | yes | no |
//! | energy | compatible | compatible | symmetric |
//! | step factor | 0.55 | 0.55 | 0.5 |
//!
//! | for liquids | [`weakly_compressible`] | [`riemann_liquid`] | [`ls_dyna_default`] | [`ls_dyna_fluid`] |
//! |---|---|---|---|---|
//! | continuity | by volume | by volume | by mass | by volume |
//! | viscosity | plain, α = 0.02 | Riemann | plain, α = 0.06, β = 1.5 | the same |
//! | density diffusion | Fourtakas, δ = 0.1 | Riemann | none | none |
//! | kernel, h/dx | Wendland C2, 1.5 | Wendland C2, 1.5 | cubic spline, 1.2 | cubic spline, 1.2 |
//! | smoothing length | fixed | fixed | by divergence | by divergence |
//! | first-moment consistency factor of the lattice | yes | yes | no | no |
//!
//! [`ls_dyna_renormalised`] and [`ls_dyna_fluid_renormalised`] correct the gradients of the last two.
//!
//! What an error costs with them, on seventeen problems with known answers, is in [accuracy and cost](crate#pages).

use crate::effect::{
    Cavitation, ConsistentSmoothing, DensityDiffusion, DivergenceSmoothing, ExtrapolatedPressure,
    HourglassControl, NoWalls, RenormalisedHypoelastic, TotalLagrangian,
};
use crate::kernel::{CubicSpline, WendlandC2, WendlandC4};
use crate::scheme::{DensityForm, EnergyForm, SchemeBuilder};
use crate::sweep::Interaction;
use crate::term::viscosity::{Inviscid, LimitedMonaghanGingold, MonaghanGingold, Riemann};
use crate::term::{
    Fourtakas, InternalEnergy, KernelSum, MatrixPressureForce, MidpointReconstruction,
    PressureForce, RenormalisedPressureForce, RiemannDiffusion,
};

/// What solids and gases start from, with a pressure force.
type Solid<P = PressureForce> = ((((), P), KernelSum), InternalEnergy);
/// What liquids start from, with a pressure force.
type Liquid<P = PressureForce> = (((), P), Cavitation);
/// Elastic structures with a viscosity.
type Structure<V> = SchemeBuilder<
    WendlandC2,
    V,
    NoWalls,
    ((((), TotalLagrangian), InternalEnergy), HourglassControl),
>;
/// Impact of solids.
type Impact<E> = SchemeBuilder<CubicSpline, LimitedMonaghanGingold, NoWalls, E>;
/// A liquid as LS-DYNA has it.
type LsDyna<P = PressureForce> = SchemeBuilder<
    CubicSpline,
    MonaghanGingold,
    ExtrapolatedPressure,
    (Liquid<P>, DivergenceSmoothing),
>;

/// Impact of solids with weak to moderate shocks: number density relative to the shape at rest,
/// midpoint reconstruction χ = 1/3, limited viscosity α = 2, β = 2, compatible energy, cubic spline at
/// h/dx 1.2.
///
/// The default for rods: steep fronts without overshoot ([rods](crate#pages)), waves at the right speed, bodies at rest free of
/// stress, contact that opens.
///
/// The error is the width of fronts, so a finer spacing buys more than any setting.
/// [`DriftKickDrift`](crate::integrator::DriftKickDrift) gives the same error with fewer pairs. Where rods are only compressed h/dx 1.0
/// gives the same error in 0.8 of the time. In one dimension, where rods stay in
/// tension, 1.3 leaves less ripple between neighbours than 1.2, and a front a little wider ([accuracy and cost](crate#pages)).
#[must_use]
pub fn impact()
-> SchemeBuilder<CubicSpline, LimitedMonaghanGingold, NoWalls, (Solid, MidpointReconstruction)> {
    // Less viscosity is steeper (α = 1.5: 0.080 µs), but leaves 2.5e-9 of the plateau at a joint 0.85 µs
    // ahead of the wave, where α = 2 leaves 8e-10.
    SchemeBuilder::new(CubicSpline, LimitedMonaghanGingold::STANDARD)
        .named("impact")
        .density(DensityForm::NumberDensity)
        .with(MidpointReconstruction::STANDARD)
}

/// As [`impact`], with density by continuity in volume form: the same accuracy where bodies keep
/// their shape, and right where they do not.
#[must_use]
pub fn impact_by_continuity()
-> SchemeBuilder<CubicSpline, LimitedMonaghanGingold, NoWalls, (Solid, MidpointReconstruction)> {
    impact()
        .named("impact by continuity")
        .density(DensityForm::Continuity)
}

/// Solids that carry shear and may flow: [`impact_by_continuity`] with all gradients corrected, those that compress, those
/// that strain and those of the force ([`RenormalisedHypoelastic`]).
///
/// A plate of ten rows swings with a period 3 % too long, where without the corrections it is 11 % too short; at h/dx 1.0 it
/// is 1.9 % ([solids](crate#pages)). Add what the body does beyond elasticity, and a remedy for the tensile instability after it:
///
/// ```
/// use meshfree::effect::{HourglassFree, Plasticity};
/// use meshfree::prelude::*;
/// let scheme: Scheme<f64, 3> =
///     schemes::updated_lagrangian().with(Plasticity).with(HourglassFree::default()).compose();
/// assert!(scheme.to_string().contains("corrected gradients"));
/// ```
///
/// Where there are no shocks, α = 0.2 lost two fifths less energy of colliding rings ([solids](crate#pages)); with less,
/// `.without_midpoint_reconstruction()` keeps pressures of neighbours from alternating, and without any viscosity bodies break.
///
/// Bodies that meet are groups of their own with a coupling between them.
#[must_use]
pub fn updated_lagrangian() -> Impact<(
    (Solid<RenormalisedPressureForce>, RenormalisedHypoelastic),
    MidpointReconstruction,
)> {
    impact_by_continuity()
        .without_midpoint_reconstruction()
        .renormalised()
        .named("updated Lagrangian")
        .with(RenormalisedHypoelastic)
        .with(MidpointReconstruction::STANDARD)
}

/// The scheme of Lam, Shen & Gong (2002), with its misprints corrected: summation smoothed at joints,
/// equation 25 at end particles, plain Monaghan–Gingold viscosity, symmetric energy, no
/// consistency factor. Use it with [`LamLeapfrog`](crate::integrator::LamLeapfrog), and bond the bodies:
/// the paper has no contact law.
#[must_use]
pub fn lam2002() -> SchemeBuilder<CubicSpline, MonaghanGingold> {
    SchemeBuilder::new(CubicSpline, MonaghanGingold::default())
        .named("lam2002")
        .density(DensityForm::Lam)
        .energy(EnergyForm::Symmetric)
        .without_consistency_factor()
        // Half of what the leapfrog bears: the printed integrator is stable to 0.707 of it.
        .step_factor(0.5)
}

/// Liquids with a free surface, weakly compressible: continuity with the matching pressure force,
/// density diffusion off the hydrostatic state (Fourtakas, δ = 0.1), artificial viscosity α = 0.02,
/// Wendland C2 at h/dx 1.5, walls that do not hold what separates.
///
/// What to change where a scene is not violent; the numbers, and more, are in [accuracy and cost](crate#pages):
///
/// | scene | change | what it buys |
/// |---|---|---|
/// | sound in water that is otherwise still | α = 0, `Fourtakas { delta: 0.0 }` | fourth order, where waves lose 5 % on 64 particles with diffusion |
/// | sound, water hammer | `.density_diffusion(Antuono::default())` | waves lose a fifteenth of what they lose without; half as many pairs again |
/// | water that stays at rest, a front on a dry bed | `.with_kernel(CubicSpline).h_over_dx(1.2)` | the same error in a third of the time; waves lose three times as much |
/// | waves | `.h_over_dx(2.0)` and α = 0.005 | crests lose less than half, in the same time |
/// | waves, from crest to crest | `.renormalised()` and α = 0.005 | on 40 particles a wavelength crests keep their height within 0.4 % a period, where they lose 6 %; a sweep more |
/// | viscous flow without a surface | `.with_kernel(WendlandC4).h_over_dx(2.2)` | half the error of velocities in less time |
///
/// **Slow viscous flow under pressure** is too slow where p ≫ μ |∇v| + ρ v²: the pressure force hardens the lattice of
/// particles against shear, vortices of Re 10 under 300 μ U k have 0.57 of their speed. With
/// [`PressureDifference`](crate::effect::PressureDifference) and [`ConsistentShifting`](crate::effect::ConsistentShifting) they have 1.02 of it
/// under any pressure. [`Scene::advise`](crate::scene::Scene::advise) names the condition, and [hard cases](crate#pages) has numbers. A sound speed of ten times the flow is too low where viscosity makes the
/// pressure, as in films; advice and the [verdict](crate::simulation::Thresholds::compression) name one that is not.
///
/// Not h/dx 1.3, with which finer spacings make waves and pressure at rest worse. At 1.5 the front of a dam break is nearer than
/// at 2.0. [`DriftKickDrift`](crate::integrator::DriftKickDrift) takes half as many pairs again here. What still water does is in
/// [gentle and closed flows](crate#pages).
#[must_use]
pub fn weakly_compressible() -> SchemeBuilder<
    WendlandC2,
    MonaghanGingold,
    ExtrapolatedPressure,
    (Liquid, DensityDiffusion<Fourtakas>),
> {
    SchemeBuilder::liquid(
        WendlandC2,
        MonaghanGingold {
            alpha: 0.02,
            beta: 0.0,
        },
    )
    .named("weakly compressible")
    .with(DensityDiffusion(Fourtakas::default()))
}

/// Gases: summed density with a smoothing length that is consistent with it between a fifth and five times η dx of the body,
/// pressure force by [matrix gradients](MatrixPressureForce), limited viscosity with α = 1 and β = 1, compatible energy, Wendland C4;
/// bodies are one gas where they meet.
///
/// Gradients are exact for linear fields, and viscosity acts on what linear reconstruction leaves of a jump. So one choice serves shocks,
/// gas that turns and gas that shears: what to change, and why, by the numbers of [accuracy and cost](crate#pages), is
///
/// | scene | change |
/// |---|---|
/// | contacts that must have one pressure | `.with(ArtificialConduction::default())`: the largest error of a sliding contact 0.06 for 0.24, contacts twice as wide |
/// | shocks in one dimension | `.h_over_dx(1.5)`: a sixth less error; in a plane and in space disorder costs more than it gives |
///
/// The plain force, `SchemeBuilder::new(WendlandC4, SignalVelocity::STANDARD)` with the same density, takes a half of the time a step.
/// For an error it costs more in all that was measured but a blast from a point
/// (Sedov), whose L1 error of density is a tenth smaller with it, and whose peak is three fifths of this one's.
///
/// ```
/// use meshfree::prelude::*;
/// // Two halves of a uniform gas stay uniform where they meet.
/// let air = || Material::new("gas", meshfree::material::eos::IdealGas::new(1.4, 1.0));
/// let half = |name, low: f64| {
///     Body::block(name, air(), [low], [low + 0.5], 0.01).energy(2.5)
/// };
/// let simulation = Scene::<f64, 1>::new(schemes::gas())
///     .body(half("left", 0.0))
///     .body(half("right", 0.5))
///     .boundary(meshfree::boundary::Periodic::along(0, 0.0, 1.0))
///     .build()?;
/// assert!(simulation.all().all(|particle| (particle.density() - 1.0).abs() < 1e-3));
/// # Ok::<(), Error>(())
/// ```
#[must_use]
pub fn gas() -> SchemeBuilder<
    WendlandC4,
    LimitedMonaghanGingold,
    NoWalls,
    (Solid<MatrixPressureForce>, ConsistentSmoothing),
> {
    let viscosity = LimitedMonaghanGingold {
        alpha: 1.0,
        beta: 1.0,
    };
    SchemeBuilder::new(WendlandC4, viscosity)
        .named("gas")
        .density(DensityForm::Summation)
        .matrix_gradients()
        .between_bodies(Interaction::Bonded)
        .with(ConsistentSmoothing {
            smallest: 0.2,
            largest: 5.0,
        })
}

/// The artificial viscosity of the LS-DYNA schemes: the linear and quadratic coefficients of its bulk
/// viscosity, 0.06 and 1.5.
const BULK: MonaghanGingold = MonaghanGingold {
    alpha: 0.06,
    beta: 1.5,
};
/// Limits of the smoothing length in units of the first (HMIN and HMAX of its section card).
const LIMITS: DivergenceSmoothing = DivergenceSmoothing {
    smallest: 0.2,
    largest: 2.0,
};

/// FORM 5 of LS-DYNA, "fluid particle approximation": continuity and pressure by volume, cubic spline at
/// h/dx 1.2, bulk viscosity, smoothing length that follows the divergence between 0.2 and 2 of the first,
/// neither density diffusion nor consistency factor.
///
/// The equations behind the forms are as generally understood; its theory manual was not at hand. Its
/// renormalised sibling FORM 6 is [`ls_dyna_fluid_renormalised`].
#[must_use]
pub fn ls_dyna_fluid() -> LsDyna {
    SchemeBuilder::liquid(CubicSpline, BULK)
        .named("LS-DYNA FORM 5, fluid")
        .h_over_dx(1.2)
        .without_consistency_factor()
        .with(LIMITS)
}

/// FORM 0 of LS-DYNA, the default: continuity by mass with the σ/ρ² force; the rest as
/// [`ls_dyna_fluid`].
#[must_use]
pub fn ls_dyna_default() -> LsDyna {
    ls_dyna_fluid()
        .density(DensityForm::ContinuityByMass)
        .named("LS-DYNA FORM 0, default")
}

/// FORM 1 of LS-DYNA: [`ls_dyna_default`] with renormalised gradients.
#[must_use]
pub fn ls_dyna_renormalised() -> LsDyna<RenormalisedPressureForce> {
    ls_dyna_default()
        .renormalised()
        .named("LS-DYNA FORM 1, renormalised")
}

/// FORM 6 of LS-DYNA: [`ls_dyna_fluid`] with renormalised gradients.
#[must_use]
pub fn ls_dyna_fluid_renormalised() -> LsDyna<RenormalisedPressureForce> {
    ls_dyna_fluid()
        .renormalised()
        .named("LS-DYNA FORM 6, fluid renormalised")
}

/// Violent liquids without a coefficient to choose: the dissipation of a Riemann solver between
/// particles in momentum and continuity (Zhang, Hu & Adams 2017), the rest as
/// [`weakly_compressible`].
#[must_use]
pub fn riemann_liquid() -> SchemeBuilder<
    WendlandC2,
    Riemann,
    ExtrapolatedPressure,
    (Liquid, DensityDiffusion<RiemannDiffusion>),
> {
    weakly_compressible()
        .named("Riemann liquid")
        .with_viscosity(Riemann::STANDARD)
        .density_diffusion(RiemannDiffusion)
}

/// Elastic structures: total Lagrangian with hourglass control α = 0.1, Wendland C2 at h/dx 0.8, no artificial viscosity,
/// compatible energy. Add a stress: `.with(NeoHookean)`.
///
/// Neighbours that stay cannot pair, so h may be small, and bending asks for it: particles at a free surface see the
/// strain of those behind them ([defaults](crate#pages) has periods of a plate). On a lattice 0.8 reaches the neighbours across the diagonal of a face; in a disordered body a particle may lack some.
///
/// In three dimensions it does not reach across the diagonal of a cube, and a body that is wrung gets zigzags that come and go:
/// take `.h_over_dx(1.0)` there, with a tenth of them ([solids](crate#pages)). What bends in three dimensions is too soft with
/// it: with n × n particles in its section a beam loses 13 % of its first frequency at n = 4, 7 % at 6 and 5 % at 8, at 0.8 7, 4
/// and 3 %.
#[must_use]
pub fn total_lagrangian() -> Structure<Inviscid> {
    SchemeBuilder::total_lagrangian(WendlandC2, Inviscid)
        .named("total Lagrangian")
        .h_over_dx(0.8)
        .with(HourglassControl::default())
}

/// As [`total_lagrangian`], with the viscosity of Monaghan and Gingold, α = 1, β = 2, for shocks. It carries a load of its own,
/// in proportion to the spacing: where shocks are weak, as in a Taylor bar ([solids](crate#pages)), α = 0.1 is nearer.
#[must_use]
pub fn total_lagrangian_impact() -> Structure<MonaghanGingold> {
    total_lagrangian()
        .named("total Lagrangian impact")
        .with_viscosity(MonaghanGingold::STANDARD)
}
