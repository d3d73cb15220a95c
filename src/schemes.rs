//! Ready schemes: the lists of terms that a user would write, with defaults that are measured.
//! Each prints itself with equations, fields and sources.
//!
//! All three return a [`SchemeBuilder`], so a single choice can be changed and the rest kept:
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
//! | pressure curvature χ | 1/3 | 1/3 | 0 |
//! | normalised by the moment at rest | yes | yes | no |
//! | energy | compatible | compatible | symmetric |
//! | step factor | 0.55 | 0.55 | 0.5 |

use crate::kernel::{CubicSpline, WendlandC2};
use crate::scheme::{DensityForm, EnergyForm, LiquidBuilder, SchemeBuilder};
use crate::sweep::SmoothingMode;
use crate::term::Fourtakas;
use crate::term::viscosity::{LimitedMonaghanGingold, MonaghanGingold};

/// What [`impact`] returns: a scheme with curvature of the pressure, to be changed further.
pub type ImpactBuilder =
    SchemeBuilder<CubicSpline, LimitedMonaghanGingold, { SmoothingMode::Uniform.bit() }, true>;

/// Impact of solids with weak to moderate shocks: number density relative to the shape at rest,
/// pressure curvature χ = 1/3, limited viscosity α = 2, β = 2, compatible energy, cubic spline at
/// h/dx 1.2.
///
/// The default for rods: fronts of 0.09 µs at a spacing of 0.05 mm without overshoot, waves at the
/// right speed, bodies at rest free of stress, contact that opens.
#[must_use]
pub fn impact() -> ImpactBuilder {
    // Less viscosity is steeper (α = 1.5: 0.080 µs), but leaves 2.5e-9 of the plateau at a joint 0.85 µs
    // ahead of the wave, where α = 2 leaves 8e-10.
    SchemeBuilder::new(CubicSpline, LimitedMonaghanGingold::STANDARD)
        .named("impact")
        .density(DensityForm::NumberDensity)
        .pressure_curvature(1.0 / 3.0)
}

/// As [`impact`], with density by continuity in volume form: the same accuracy where bodies keep
/// their shape, and right where they do not.
#[must_use]
pub fn impact_by_continuity() -> ImpactBuilder {
    impact()
        .named("impact by continuity")
        .density(DensityForm::Continuity)
}

/// The scheme of Lam, Shen & Gong (2002), with its misprints corrected: summation smoothed at joints,
/// equation 25 at end particles, plain Monaghan–Gingold viscosity, symmetric energy, no
/// normalisation. Use it with [`LamLeapfrog`](crate::integrator::LamLeapfrog), and bond the bodies:
/// the paper has no contact law.
#[must_use]
pub fn lam2002() -> SchemeBuilder<CubicSpline, MonaghanGingold> {
    SchemeBuilder::new(CubicSpline, MonaghanGingold::default())
        .named("lam2002")
        .density(DensityForm::Lam)
        .energy(EnergyForm::Symmetric)
        .without_normalisation()
        // Half of what the leapfrog bears: the printed integrator is stable to 0.707 of it.
        .step_factor(0.5)
}

/// Liquids with a free surface, weakly compressible: continuity with the matching pressure force,
/// density diffusion off the hydrostatic state (Fourtakas, δ = 0.1), artificial viscosity α = 0.02,
/// Wendland C2 at h/dx 1.5, walls that do not hold what separates.
///
/// A column of 50 particles at rest keeps its pressure within 0.2 % at h/dx 1.5 and 2, and within 1.3 %
/// at 1.3.
#[must_use]
pub fn weakly_compressible() -> LiquidBuilder<WendlandC2, MonaghanGingold, Fourtakas> {
    LiquidBuilder::new(
        WendlandC2,
        MonaghanGingold {
            alpha: 0.02,
            beta: 0.0,
        },
    )
    .named("weakly compressible")
    .density_diffusion(Fourtakas::default())
}
