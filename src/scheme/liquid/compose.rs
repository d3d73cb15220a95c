//! How the choices of a [`LiquidBuilder`] are compiled into sweeps over pairs.
//! Two sweeps a step, or one that sums forces and the rate of density together.

use super::super::lattice::{lattice_moment, lattice_unity};
use super::super::{EnergyForm, KernelFacts, Scheme};
use super::{Liquid, LiquidBuilder};
use crate::kernel::Kernel;
use crate::particles::Field;
use crate::scalar::Real;
use crate::sweep::{PairSweep, Program, SmoothingMode};
use crate::term::{
    ArtificialViscosity, Compression, DensityGradient, LiquidNearWall, PressureForce,
    RenormalisedCompression, RenormalisedPressureForce, Term, VelocityAtWall, VelocityGradient,
    Viscosity, ViscosityAtWall,
};

impl<K, V, W, R, S, U, const MODES: u8, const RENORMALISED: bool>
    LiquidBuilder<K, V, W, R, S, U, MODES, RENORMALISED>
{
    /// Compiles the choices into sweeps: the forces, and the rate of density at the middle of the drift.
    #[must_use]
    pub fn compose<T: Real, const D: usize>(self) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        W: Term<D>,
        R: Term<D>,
        S: Term<D>,
        U: Term<D>,
    {
        let (kernel, mode) = (self.kernel, Self::MODE);
        let viscosity = Viscosity(self.viscosity.clone());
        let (laminar, diffusion) = (self.laminar.clone(), self.diffusion.clone());
        let (crowding, partition) = (self.crowding.clone(), self.partition.clone());
        let rates: Box<dyn PairSweep<T, D>> = if const { RENORMALISED } {
            let terms = (RenormalisedPressureForce, viscosity, laminar);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        } else {
            let terms = (PressureForce, viscosity, laminar);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        };
        let compression: Box<dyn PairSweep<T, D>> = if const { RENORMALISED } {
            let terms = (RenormalisedCompression, diffusion, crowding, partition);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        } else {
            let terms = (Compression, diffusion, crowding, partition);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        };
        self.assemble(rates, Some(compression))
    }

    const MODE: SmoothingMode = if MODES == SmoothingMode::Uniform.bit() {
        SmoothingMode::Uniform
    } else {
        SmoothingMode::Mean
    };

    /// The scheme with these sums of forces and of density's rate; without the latter, the forces' sweep
    /// makes both.
    fn assemble<T: Real, const D: usize>(
        self,
        rates: Box<dyn PairSweep<T, D>>,
        compression: Option<Box<dyn PairSweep<T, D>>>,
    ) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        W: Term<D>,
        R: Term<D>,
    {
        let (kernel, mode) = (self.kernel, Self::MODE);
        let h_over_dx = self.h_over_dx.unwrap_or(kernel.h_over_dx());
        let gradient: Option<Box<dyn PairSweep<T, D>>> =
            if const { W::READS.contains(Field::DensityGradient) } {
                let terms = (DensityGradient,);
                Some(Box::new(Program::<_, _, MODES>::new(kernel, terms, mode)))
            } else if const { RENORMALISED } {
                let terms = (VelocityGradient,);
                Some(Box::new(Program::<_, _, MODES>::new(kernel, terms, mode)))
            } else {
                None
            };
        let shear: Option<Box<dyn PairSweep<T, D>>> = if self.general_viscosity {
            let terms = (VelocityGradient,);
            Some(Box::new(Program::<_, _, MODES>::new(kernel, terms, mode)))
        } else {
            None
        };
        let viscosity_problems = self.viscosity.problems();
        let wall: Box<dyn PairSweep<T, D>> = if const { R::READS.contains(Field::DynamicViscosity) }
        {
            let terms = (LiquidNearWall, VelocityAtWall, ViscosityAtWall);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        } else if self.riemann_walls {
            let terms = (LiquidNearWall, VelocityAtWall);
            Box::new(Program::<_, _, MODES>::new(kernel, terms, mode))
        } else {
            Box::new(Program::<_, _, MODES>::new(kernel, (LiquidNearWall,), mode))
        };
        Scheme {
            name: self.name,
            kernel: KernelFacts::of(&kernel),
            density: self.density,
            pressure_form: self.density,
            energy: EnergyForm::None,
            smoothing: self.smoothing,
            h_over_dx,
            step_factor: self.step_factor
                * damped_step(self.acoustic_damping, kernel.stable_step()),
            normalised: false,
            viscosity_problems,
            kernel_problems: crate::kernel::problems_of(&kernel),
            switch: None,
            reference: None,
            sums: None,
            compression,
            gradient,
            rates,
            lattice_moment: if self.normalised {
                lattice_moment(&kernel, h_over_dx)
            } else {
                1.0
            },
            liquid: Some(Liquid {
                wall,
                shear,
                wall_floor: self.wall_floor,
                shifting: self.shifting,
                acoustic_damping: self.acoustic_damping,
                volume_consistency: self
                    .volume_consistency
                    .map(|own| (own, lattice_unity(&kernel, h_over_dx))),
                riemann_walls: self.riemann_walls,
                reversible_tearing: self.reversible_tearing,
                dual_criteria: self.dual_criteria,
            }),
        }
    }
}

impl<K, V, W, R> LiquidBuilder<K, V, W, R> {
    /// [Composes](Self::compose) for one evaluation a step: one sweep sums forces and the rate of density,
    /// and density is kicked with velocity, where [`compose`](Self::compose) sums density's rate in a sweep
    /// of its own at the middle of the drift.
    ///
    /// The sweep sees velocity and density set a step ahead with the last rates, and
    /// [`KickDriftKick`](crate::integrator::KickDriftKick) corrects both once with what it finds:
    ///
    /// ```text
    /// y* = yₙ + dt rₙ,  rₙ₊₁ = f(xₙ₊₁, y*),  yₙ₊₁ = yₙ + dt (rₙ + rₙ₊₁)/2,  y = (v, ρ)
    /// ```
    ///
    /// On sound, y' = iω y, a step multiplies y by a root of z² − (1 + 3iω dt/2) z + iω dt/2 = 0, as the
    /// two-step method of Adams and Bashforth does: |z| = 1 + (ω dt)⁴/4, so sound grows that nothing damps,
    /// where the sweep at the middle makes a leapfrog that is neutral up to ω dt = 2. It takes density
    /// diffusion or viscosity to hold the step, which is therefore shortened by [`ONE_EVALUATION_STEP`].
    ///
    /// For uniform spacing, without [`shifting`](Self::shifting),
    /// [`volume_consistency`](Self::volume_consistency) and [`renormalised`](Self::renormalised) gradients,
    /// and without walls [without slip](crate::boundary::Wall::no_slip): the velocity that makes a liquid
    /// stick belongs to the forces, not to the compression.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let scheme: Scheme<f64, 2> = schemes::weakly_compressible().compose_with_one_evaluation();
    /// let two: Scheme<f64, 2> = schemes::weakly_compressible().compose();
    /// assert_eq!(scheme.fields(), two.fields());
    /// ```
    #[must_use]
    pub fn compose_with_one_evaluation<T: Real, const D: usize>(mut self) -> Scheme<T, D>
    where
        K: Kernel<D>,
        V: ArtificialViscosity<D>,
        W: Term<D>,
        R: Term<D>,
    {
        self.step_factor *= ONE_EVALUATION_STEP;
        let terms = (
            PressureForce,
            Viscosity(self.viscosity.clone()),
            self.laminar.clone(),
            Compression,
            self.diffusion.clone(),
        );
        let rates = Program::<_, _, { SmoothingMode::Uniform.bit() }>::new(
            self.kernel,
            terms,
            SmoothingMode::Uniform,
        );
        self.assemble(Box::new(rates), None)
    }
}

/// By what [`LiquidBuilder::compose_with_one_evaluation`] shortens the step: 0.25 h/c where two sweeps
/// take 0.55 h/c.
///
/// On a lattice density diffusion holds noise up to 0.55 h/c, that of a Riemann solver up to 0.35 h/c. Liquid
/// that strikes a wall has fewer neighbours to diffuse to, and walls do not diffuse: of a dam break on 2500
/// particles 0.25 h/c keeps the fluctuations of density and the greatest speeds that two sweeps have, at
/// 0.3 h/c they are up to twice as large, at 0.55 h/c the fluctuations four to ten times. It belongs to
/// kick-drift-kick; for a Runge–Kutta method of higher order divide [`step_factor`](LiquidBuilder::step_factor) by it.
pub const ONE_EVALUATION_STEP: f64 = 0.25 / 0.55;

/// By what a bulk viscosity shortens the stable step Δ \[h/c\] of a leapfrog.
///
/// It acts half a step late, so a wave that the step samples at ω dt is stable while
/// (ω dt)² (λ h/(2 c dt) + 1/4) ≤ 1, of which the shortest wave makes dt = √(λ² + Δ²) − λ.
fn damped_step(strength: Option<f64>, stable: f64) -> f64 {
    strength.map_or(1.0, |strength| {
        let ratio = strength / stable;
        (ratio * ratio + 1.0).sqrt() - ratio
    })
}

impl<T, const D: usize, K, V, W, R, S, U, const MODES: u8, const RENORMALISED: bool>
    From<LiquidBuilder<K, V, W, R, S, U, MODES, RENORMALISED>> for Scheme<T, D>
where
    T: Real,
    K: Kernel<D>,
    V: ArtificialViscosity<D>,
    W: Term<D>,
    R: Term<D>,
    S: Term<D>,
    U: Term<D>,
{
    fn from(builder: LiquidBuilder<K, V, W, R, S, U, MODES, RENORMALISED>) -> Self {
        builder.compose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::Output;
    use crate::scheme::Shifting;
    use crate::schemes::weakly_compressible;
    use crate::term::{Antuono, LaminarViscosity, Nothing};

    #[test]
    fn an_effect_that_is_not_named_has_no_column_and_no_sum() {
        let plain = weakly_compressible().compose::<f64, 3>();
        let damped = weakly_compressible()
            .acoustic_damping(0.3)
            .compose::<f64, 3>();
        let added = |scheme: &Scheme<f64, 3>| -> Vec<Field> {
            let own = scheme.fields().iter();
            own.filter(|&field| !plain.fields().contains(field))
                .collect()
        };
        let sticky = weakly_compressible()
            .laminar_viscosity(LaminarViscosity)
            .compose();
        assert_eq!(added(&sticky), [Field::DynamicViscosity]);
        let curved = weakly_compressible()
            .density_diffusion(Antuono::default())
            .compose();
        assert_eq!(added(&curved), [Field::DensityGradient]);
        assert_eq!(
            added(&weakly_compressible().renormalised().compose()),
            [Field::Correction]
        );
        assert_eq!(
            added(&weakly_compressible().smoothing(0.5, 2.0).compose()),
            [Field::SmoothingLength]
        );
        assert_eq!(added(&damped), [Field::Divergence]);
        assert!(damped.to_string().contains("against sound, λ = 0.3"));
        // 3 + 3 + 6 numbers: places, velocities, and what pressure and continuity need.
        assert_eq!(plain.fields().width(3), 12);
        assert!(!plain.fields().contains(Field::Energy));

        let sums = |scheme: &Scheme<f64, 3>| -> Vec<Output> {
            scheme
                .compression
                .iter()
                .flat_map(|sweep| sweep.outputs().iter().collect::<Vec<_>>())
                .collect()
        };
        let bare = weakly_compressible().density_diffusion(Nothing).compose();
        assert_eq!(sums(&bare), [Output::Compression]);
        assert_eq!(
            sums(&plain),
            [Output::Compression, Output::DensityDiffusion]
        );
        // What a row stores a particle: a term that is left out stores nothing.
        let stored = |scheme: &Scheme<f64, 3>| -> Option<usize> {
            scheme
                .compression
                .as_ref()
                .map(|sweep| sweep.outputs().width(3))
        };
        assert_eq!((stored(&bare), stored(&plain)), (Some(1), Some(2)));
        let shifted = weakly_compressible().shifting(Shifting::STANDARD).compose();
        assert_eq!(sums(&shifted)[2..], [Output::Moment, Output::Crowding]);
        assert_eq!(shifted.fields(), plain.fields());
    }
}
