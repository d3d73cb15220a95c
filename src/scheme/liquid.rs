//! Schemes of weakly compressible liquids: density integrated with diffusion, walls of particles.
//! Two sweeps a step: the forces, and the rate of density at the middle of the drift.

use super::lattice::{lattice_moment, lattice_unity};
use super::{
    DEFAULT_STEP_FACTOR, DensityForm, EnergyForm, KernelFacts, Scheme, Shifting, Smoothing,
};
use crate::kernel::Kernel;
use crate::particles::Field;
use crate::scalar::Real;
use crate::sweep::{PairSweep, Program, SmoothingMode};
use crate::term::{
    ArtificialViscosity, Compression, Crowding, DensityGradient, LiquidAlongWall, LiquidNearWall,
    Nothing, PressureForce, RenormalisedCompression, RenormalisedPressureForce, Term, Unity,
    VelocityGradient, Viscosity, ViscosityAtWall,
};

/// What a scheme of liquids adds to one of solids and gases.
#[derive(Debug)]
pub(crate) struct Liquid<T: Real, const D: usize> {
    /// The sums of wall particles over liquid.
    pub wall: Box<dyn PairSweep<T, D>>,
    /// The velocity gradient that a viscosity follows, where it does.
    pub shear: Option<Box<dyn PairSweep<T, D>>>,
    /// Lowest pressure of a wall \[Pa\].
    pub wall_floor: f64,
    /// How particles are kept evenly spread.
    pub shifting: Option<Shifting>,
    /// Bulk viscosity over ρ c h.
    pub acoustic_damping: Option<f64>,
    /// How strongly densities are held to the space of their particles, and Σ V W on the lattice.
    pub volume_consistency: Option<(f64, f64)>,
    /// Whether corrections and viscosities are renewed with the neighbour lists only.
    pub dual_criteria: bool,
}

/// Chooses the parts of a scheme for liquids.
///
/// The type parameters are terms, so what a scheme does not name is not compiled into it: the kernel,
/// the artificial viscosity, the density diffusion, the physical viscosity, the sums of shifting, and that of
/// volume consistency.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree::term::{Antuono, LaminarViscosity};
/// let scheme: Scheme<f64, 2> = schemes::weakly_compressible()
///     .density_diffusion(Antuono::default())
///     .laminar_viscosity(LaminarViscosity)
///     .compose();
/// assert!(scheme.to_string().contains("laminar viscosity"));
/// ```
#[derive(Clone, Debug)]
pub struct LiquidBuilder<
    K,
    V,
    W = Nothing,
    R = Nothing,
    S = Nothing,
    U = Nothing,
    const MODES: u8 = { SmoothingMode::Uniform.bit() },
    const RENORMALISED: bool = false,
> {
    name: String,
    kernel: K,
    viscosity: V,
    diffusion: W,
    laminar: R,
    crowding: S,
    partition: U,
    density: DensityForm,
    h_over_dx: Option<f64>,
    step_factor: f64,
    wall_floor: f64,
    shifting: Option<Shifting>,
    acoustic_damping: Option<f64>,
    volume_consistency: Option<f64>,
    smoothing: Smoothing,
    general_viscosity: bool,
    dual_criteria: bool,
    normalised: bool,
}

impl<K, V> LiquidBuilder<K, V> {
    /// A scheme with a kernel and an artificial viscosity, and no density diffusion.
    #[must_use]
    pub fn new(kernel: K, viscosity: V) -> Self {
        Self {
            name: "liquid".into(),
            kernel,
            viscosity,
            diffusion: Nothing,
            laminar: Nothing,
            crowding: Nothing,
            partition: Nothing,
            density: DensityForm::Continuity,
            h_over_dx: None,
            step_factor: DEFAULT_STEP_FACTOR,
            wall_floor: 0.0,
            shifting: None,
            acoustic_damping: None,
            volume_consistency: None,
            smoothing: Smoothing::Fixed,
            general_viscosity: false,
            dual_criteria: false,
            normalised: true,
        }
    }
}

impl<K, V, R, const MODES: u8, const RENORMALISED: bool>
    LiquidBuilder<K, V, Nothing, R, Nothing, Nothing, MODES, RENORMALISED>
{
    /// Continuity and pressure in their mass form, [`DensityForm::ContinuityByMass`]. Diffusion and
    /// shifting weigh neighbours by volume, which this form does not carry.
    #[must_use]
    pub fn by_mass(mut self) -> Self {
        self.density = DensityForm::ContinuityByMass;
        self
    }
}

impl<K, V, W, R, S, U, const MODES: u8, const RENORMALISED: bool>
    LiquidBuilder<K, V, W, R, S, U, MODES, RENORMALISED>
{
    fn with<K2, V2, W2, R2, S2, U2, const M: u8, const N: bool>(
        self,
        change: impl FnOnce(K, V, W, R, S, U) -> (K2, V2, W2, R2, S2, U2),
    ) -> LiquidBuilder<K2, V2, W2, R2, S2, U2, M, N> {
        let (kernel, viscosity, diffusion, laminar, crowding, partition) = change(
            self.kernel,
            self.viscosity,
            self.diffusion,
            self.laminar,
            self.crowding,
            self.partition,
        );
        LiquidBuilder {
            name: self.name,
            kernel,
            viscosity,
            diffusion,
            laminar,
            crowding,
            partition,
            density: self.density,
            h_over_dx: self.h_over_dx,
            step_factor: self.step_factor,
            wall_floor: self.wall_floor,
            shifting: self.shifting,
            acoustic_damping: self.acoustic_damping,
            volume_consistency: self.volume_consistency,
            smoothing: self.smoothing,
            general_viscosity: self.general_viscosity,
            dual_criteria: self.dual_criteria,
            normalised: self.normalised,
        }
    }
    /// The same choices with another kernel.
    #[must_use]
    pub fn with_kernel<L>(self, kernel: L) -> LiquidBuilder<L, V, W, R, S, U, MODES, RENORMALISED> {
        self.with(|_, v, w, r, s, u| (kernel, v, w, r, s, u))
    }
    /// The same choices with another artificial viscosity;
    /// [`Inviscid`](crate::term::viscosity::Inviscid) for none.
    #[must_use]
    pub fn with_viscosity<X>(
        self,
        viscosity: X,
    ) -> LiquidBuilder<K, X, W, R, S, U, MODES, RENORMALISED> {
        self.with(|k, _, w, r, s, u| (k, viscosity, w, r, s, u))
    }
    /// The same choices with another density diffusion; [`Nothing`] for none.
    #[must_use]
    pub fn density_diffusion<X>(
        self,
        diffusion: X,
    ) -> LiquidBuilder<K, V, X, R, S, U, MODES, RENORMALISED> {
        self.with(|k, v, _, r, s, u| (k, v, diffusion, r, s, u))
    }
    /// A physical viscosity, [`LaminarViscosity`](crate::term::LaminarViscosity) or
    /// [`CentralViscosity`](crate::term::CentralViscosity), of the liquids' own dynamic viscosity.
    #[must_use]
    pub fn laminar_viscosity<X>(
        self,
        laminar: X,
    ) -> LiquidBuilder<K, V, W, X, S, U, MODES, RENORMALISED> {
        self.with(|k, v, w, _, s, u| (k, v, w, laminar, s, u))
    }
    /// Keeps particles evenly spread and leaves a free surface alone.
    #[must_use]
    pub fn shifting<const D: usize>(
        mut self,
        shifting: Shifting,
    ) -> LiquidBuilder<K, V, W, R, Crowding<D>, U, MODES, RENORMALISED>
    where
        K: Kernel<D>,
    {
        let h_over_dx = self.h_over_dx.unwrap_or(self.kernel.h_over_dx());
        let repulsion = match shifting {
            Shifting::Concentration { .. } => 0.2,
            Shifting::TransportVelocity { .. } => 0.0,
        };
        let at_spacing =
            self.kernel.normalisation() * Kernel::<D>::shape(&self.kernel, 1.0 / h_over_dx);
        self.shifting = Some(shifting);
        self.with(|k, v, w, r, _, u| {
            let crowding = Crowding::<D> {
                repulsion,
                at_spacing,
            };
            (k, v, w, r, crowding, u)
        })
    }
    /// Lets the smoothing length follow the divergence within limits
    /// ([`Smoothing::Divergence`]), as LS-DYNA does.
    #[must_use]
    pub fn smoothing(
        mut self,
        smallest: f64,
        largest: f64,
    ) -> LiquidBuilder<K, V, W, R, S, U, { SmoothingMode::Mean.bit() }, RENORMALISED> {
        self.smoothing = Smoothing::Divergence { smallest, largest };
        self.with(|k, v, w, r, s, u| (k, v, w, r, s, u))
    }
    /// Allows bodies of different spacing: pairs use the mean of their smoothing lengths.
    #[must_use]
    pub fn mixed_spacing(
        self,
    ) -> LiquidBuilder<K, V, W, R, S, U, { SmoothingMode::Mean.bit() }, RENORMALISED> {
        self.with(|k, v, w, r, s, u| (k, v, w, r, s, u))
    }
    /// Corrects gradients of pressure force and compression, so that they are exact for linear fields, for
    /// the price of a sweep.
    #[must_use]
    pub fn renormalised(self) -> LiquidBuilder<K, V, W, R, S, U, MODES, true> {
        self.without_normalisation()
            .with(|k, v, w, r, s, u| (k, v, w, r, s, u))
    }
    /// A name for reports.
    #[must_use]
    pub fn named(mut self, name: &str) -> Self {
        self.name = name.into();
        self
    }
    /// Ratio of smoothing length to spacing; the kernel's recommendation if not given. Give it before
    /// [`shifting`](Self::shifting).
    #[must_use]
    pub fn h_over_dx(mut self, ratio: f64) -> Self {
        self.h_over_dx = Some(ratio);
        self
    }
    /// Step in units of h/(c + signal).
    #[must_use]
    pub fn step_factor(mut self, factor: f64) -> Self {
        self.step_factor = factor;
        self
    }
    /// The lowest pressure \[Pa\] that a wall can show the liquid: 0 if not given, so nothing sticks.
    /// In a closed domain that is always full, minus infinity.
    #[must_use]
    pub fn wall_pressure_floor(mut self, floor: f64) -> Self {
        self.wall_floor = floor;
        self
    }
    /// Holds densities to the space that particles really take, in flow that walls or periods enclose:
    /// dρᵢ/dt += κ (c/h) ρᵢ (Σⱼ Vⱼ Wᵢⱼ/U₀ − 1), with U₀ the sum on the lattice.
    ///
    /// Continuity integrates velocities, and knows nothing of where disorder and [`Shifting`] have moved
    /// particles: volumes m/ρ and the space between particles part. This is the re-initialisation of density
    /// by kernel sums (Colagrossi & Landrini 2003) done a little in every step; walls fill space too. A cavity
    /// at Re 1000 on 100² particles comes within 3.1 % of the lid's speed at κ = 0.05; on 50² it is 60 % off
    /// without, 11 % off at 0.02, and 21 % at 0.1, where noise of the sums enters the pressure. Taylor–Green
    /// vortices lose less than 0.1 % more.
    ///
    /// In a crushed structure from which liquid is driven out (`cellular_filler`) the volume that leaves is 13 to
    /// 16 % too large without it, and 1.7 % with it and shifting.
    ///
    /// U₀ belongs to one smoothing length, so the law does not go with lengths that vary or differ.
    /// At a free surface neighbourhoods are not full and the law is wrong: confined to particles inside, it
    /// still stirred a column at rest to 0.0025 c.
    #[must_use]
    pub fn volume_consistency(
        mut self,
        strength: f64,
    ) -> LiquidBuilder<K, V, W, R, S, Unity, MODES, RENORMALISED> {
        self.volume_consistency = Some(strength);
        self.with(|k, v, w, r, s, _| (k, v, w, r, s, Unity))
    }
    /// Damps sound by a bulk viscosity ζ = λ ρ c h: liquid shows its neighbours the pressure p − ζ ∇·v
    /// (after Sun, Pilloton, Antuono & Colagrossi 2023).
    ///
    /// The sound of a weakly compressible liquid is not that of the real one, and what an impact leaves
    /// ringing in a corner no dissipation between particles reaches. A wave of wave number k decays by
    /// exp(−λ c h k² t/2); shear is not touched. The step shortens, at λ = 0.3 by a quarter.
    #[must_use]
    pub fn acoustic_damping(mut self, strength: f64) -> Self {
        self.acoustic_damping = Some(strength);
        self
    }
    /// Lets the viscosity follow the shear rate γ̇ = √(2 D:D) by the
    /// [law of each material](crate::material::Material::with_rheology), for liquids that are not
    /// Newtonian. D is the symmetric part of the velocity gradient without its trace, to which a wall
    /// without slip shows the velocity that makes the liquid stick.
    ///
    /// It costs a sweep for the velocity gradient, and needs a
    /// [physical viscosity](Self::laminar_viscosity). Without it such a material keeps the viscosity it
    /// has at rest.
    #[must_use]
    pub fn generalised_newtonian(mut self) -> Self {
        self.general_viscosity = true;
        self
    }

    /// Steps by two criteria: what follows the flow is renewed once an advection step, what follows sound in
    /// every step (after Zhang, Rezavand & Hu 2020).
    ///
    /// Sound sets the step of a weakly compressible liquid, and the flow changes by little in it. Neighbour
    /// lists are kept in any case until a particle has moved by half of their skin, 0.1 h; with this the
    /// corrections of [`renormalised`](Self::renormalised) gradients and the viscosities of
    /// [`generalised_newtonian`](Self::generalised_newtonian) liquids are kept as long, or for h²/(4 ν), and save
    /// their sweep in the steps between. The other terms share the sweep of the pressure, and would save nothing.
    #[must_use]
    pub fn dual_criteria(mut self) -> Self {
        self.dual_criteria = true;
        self
    }

    /// Leaves out the normalisation by the first moment −Σ V r·∇W/D of the lattice, by which force and
    /// compression are divided: without it a column at h/dx 1.3 with Wendland C2 is 2.7 % too heavy.
    #[must_use]
    pub fn without_normalisation(mut self) -> Self {
        self.normalised = false;
        self
    }

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
            let terms = (LiquidNearWall, LiquidAlongWall, ViscosityAtWall);
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
/// 0.3 h/c they are up to twice as large, at 0.55 h/c the fluctuations four to ten times.
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
    use crate::schemes::weakly_compressible;
    use crate::term::{Antuono, LaminarViscosity};

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
