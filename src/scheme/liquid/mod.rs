//! Schemes of weakly compressible liquids: density integrated with diffusion, walls of particles.
//! Two sweeps a step: the forces, and the rate of density at the middle of the drift.

mod compose;

pub use compose::ONE_EVALUATION_STEP;

use super::{DEFAULT_STEP_FACTOR, DensityForm, Shifting, Smoothing};
use crate::kernel::Kernel;
use crate::scalar::Real;
use crate::sweep::{PairSweep, SmoothingMode};
use crate::term::{Crowding, Nothing, Unity};

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
    /// Whether walls meet liquid as in a Riemann problem.
    pub riemann_walls: bool,
    /// Whether torn liquid remembers how far it is torn.
    pub reversible_tearing: bool,
    /// Whether corrections and viscosities are renewed with the neighbour lists, or after h²/(4 ν).
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
    riemann_walls: bool,
    reversible_tearing: bool,
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
            riemann_walls: false,
            reversible_tearing: false,
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
            riemann_walls: self.riemann_walls,
            reversible_tearing: self.reversible_tearing,
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
    /// Step in units of h/(c + signal), which
    /// [`compose_with_one_evaluation`](LiquidBuilder::compose_with_one_evaluation) shortens.
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
    /// Lets liquid that has torn at its [cut-off](crate::material::Material::with_pressure_cut_off) close
    /// where it tore: below the density ρ_t at which it tears continuity goes on in
    /// τ = ln(ρ/ρ_t), dτ/dt = Σⱼ Vⱼ vᵢⱼ·∇W, while pairs see ρ_t; pressure comes back with τ = 0.
    ///
    /// ρ_t \[kg/m³\] is the density of the equation of state at the cut-off. With volumes that no longer grow,
    /// dτ/dt is the rate of Σ V W, so a drop that has left a neighbourhood
    /// meets the next one with what it lacked: −1 at most, where τ ends. It adds a number a particle and
    /// no sum.
    ///
    /// Without it torn liquid is held at nine tenths of ρ_t and forgets how far it was torn: it has pressure
    /// again before it has closed, and spray bears itself like a gas. In `sloshing_tank` at a cut-off of 0 and
    /// constant 30 g the space that is at least half full is 7.1 % short after 200 ms at 10 mm without it, and
    /// 1.6 % wide with it; 1.25 s after a half sine it is 5.2 % short at 20 mm, and 2.2 % wide. Single drops
    /// strike harder with it (most first peaks of Lobovský et al. and SPHERIC 10, `docs/dam_breaks.md`), so it is
    /// a choice.
    ///
    /// The law is this crate's own; `docs/sloshing.md` has what else was tried. It needs a material with a cut-off, and an integrator that kicks.
    #[must_use]
    pub fn reversible_tearing(mut self) -> Self {
        self.reversible_tearing = true;
        self
    }
    /// Lets walls meet liquid as in a one-sided Riemann problem: liquid that moves into a wall at the speed u \[m/s\]
    /// feels ρβu \[Pa\] more than [Adami's pressure](crate::term::LiquidNearWall), β = min(6 |u|, c).
    ///
    /// It is the pressure p* between the liquid and its mirror image by Zhang, Hu & Adams 2017 (eqs. 13, 14), whose
    /// limiter 3 sees twice the speed u. Theirs acts on approach alone; here liquid that leaves feels as much less,
    /// down to the [floor](Self::wall_pressure_floor): on approach alone the peak at SPHERIC 2's box is 28 kPa at
    /// 36.7 mm, both ways 26, without 32.
    ///
    /// A particle that strikes an elastic wall alone bounces, and hits it with up to twice its momentum; water
    /// spreads. A row thrown at a floor leaves it with 0.39 of its speed without this, 0.12 with it. u is the mean
    /// over the kernel along the wall's normal. So a wall must know the room that it faces: one
    /// [around](crate::boundary::Wall::around) a box does, others are [told](crate::boundary::Wall::facing), and a
    /// scene with one that is not is refused. It costs D sums a wall particle. It leaves water at rest and the period
    /// of a standing wave as they are, within 10⁻⁴ (`tests/liquids/gentle_flows.rs`); it is not the default: not every wall knows
    /// its room, and water that starts [off its lattice](crate::scene::Body::jitter) strikes that box no harder without.
    ///
    /// ```
    /// use meshfree::prelude::*;
    /// let scheme: Scheme<f64, 2> = schemes::weakly_compressible().riemann_walls().compose();
    /// assert!(scheme.to_string().contains("Riemann"));
    /// ```
    #[must_use]
    pub fn riemann_walls(mut self) -> Self {
        self.riemann_walls = true;
        self
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
    /// lists are kept in any case until a particle has moved by half of their
    /// [skin](crate::scene::Scene::skin), 0.1 h; with this the
    /// corrections of [`renormalised`](Self::renormalised) gradients and the viscosities of
    /// [`generalised_newtonian`](Self::generalised_newtonian) liquids are kept as long, or for h²/(4 ν), and save
    /// their sweep in the steps between: a standing wave with renormalised gradients takes 0.71 of the time, and its
    /// period is 0.16 % long where it was 0.14 %. The other terms share the sweep of the pressure, and would save
    /// nothing: a scheme with neither is refused, and so are corrections under diffusion by gradients of density
    /// ([`Antuono`](crate::term::Antuono)), which follow sound.
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
}
