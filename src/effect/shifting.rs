//! Shifting: keeps the particles of a liquid evenly spread, and leaves its free surface alone.
//! Lind et al. 2012, Skillen et al. 2013; the transport velocity of Adami, Hu & Adams 2013.

use super::{DensityForm, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram};
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{ConcentrationGradient, In, Stage, stage};

/// How particles are kept evenly spread.
///
/// Where a flow strains, a lattice breaks up, and the kernel sums of a disordered neighbourhood read
/// as pressure: vortices decay far too fast without it ([defaults](crate#pages)).
///
/// Densities do not follow the shifts, and drift where viscosity is too weak to keep order:
/// [`VolumeConsistency`](super::VolumeConsistency) holds them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub enum Shifting {
    /// Against the gradient of their concentration.
    ///
    #[doc = include_str!("../../docs/equations/shifting_concentration.html")]
    ///
    /// (Lind et al. 2012; Skillen et al. 2013, eq. 15). The speed is that in the frame of the scene, so
    /// a tank that moves fast is better given as an [acceleration](crate::scene::Scene::acceleration).
    Concentration {
        /// Strength A; Skillen et al. use 1 to 6, in flows that stay better ordered.
        strength: f64,
        /// Whether a free surface is left alone. In a flow without one, voids must not pass for one, or
        /// nothing closes them.
        free_surface: bool,
    },
    /// By a background pressure that moves particles and not their momentum.
    ///
    #[doc = include_str!("../../docs/equations/shifting_transport.html")]
    ///
    /// (Adami, Hu & Adams 2013, eq. 8). For flow without free surface.
    ///
    /// The stress by which Adami et al. make momentum follow (their eq. 13) is left out: vortices are nearer without
    /// ([defaults](crate#pages)).
    TransportVelocity {
        /// Background pressure in units of ρ c².
        background: f64,
    },
}

impl Shifting {
    /// Free-surface shifting, A = 2.
    pub const STANDARD: Self = Self::Concentration {
        strength: 2.0,
        free_surface: true,
    };
    /// For flow that walls or periods enclose, A = 20.
    pub const CLOSED: Self = Self::Concentration {
        strength: 20.0,
        free_surface: false,
    };
    /// The transport velocity, 10 ρc².
    pub const TRANSPORT: Self = Self::TransportVelocity { background: 10.0 };
}

/// First moment −Σ V r·∇W/D of the neighbourhood at and below which a particle lies at a free
/// surface and is not shifted, and from which on it is shifted in full. A flat surface has a half.
const SURFACE: [f64; 2] = [0.75, 0.95];
/// Largest coefficient of the concentration's gradient in h²: shifting diffuses particles in explicit
/// steps, and overshoots beyond about a half (Skillen et al. 2013).
const STABLE: f64 = 0.3;
/// Longest shift in units of the smoothing length: larger ones come from pairs that have collapsed.
const LONGEST: f64 = 0.1;
/// What a shift adds to: places, and the rounding errors of these where the scheme keeps them.
pub(super) const PLACE: Fields = Fields::of(&[Field::POSITION, Field::POSITION_RESIDUAL]);

impl<const D: usize> Effect<D> for Shifting {
    type Terms = (In<stage::Continuity, ConcentrationGradient<D>>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, setting: &Setting) -> Self::Terms {
        let repulsion = match self {
            Self::Concentration { .. } => 0.2,
            Self::TransportVelocity { .. } => 0.0,
        };
        (In::new(ConcentrationGradient {
            repulsion,
            at_spacing: setting.kernel_at_spacing,
        }),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let by_mass = program.setting().density == DensityForm::ContinuityByMass;
        program.law(Stage::Continuity, *self);
        program.require(move |_| {
            by_mass.then(|| Problem::Incompatible {
                what:
                    "shifting weighs neighbours by volume, which continuity by mass does not carry"
                        .into(),
                remedy: "take DensityForm::Continuity, or leave out Shifting",
            })
        });
    }
}

impl<const D: usize> PointLaw<D> for Shifting {
    const NAME: &'static str = "shifting";
    const READS: Fields = Fields::of(&[Field::VELOCITY, Field::SOUND_SPEED]);
    const WRITES: Fields = PLACE;
    const ADDS: Fields = PLACE;
    const SUMS: Outputs = Outputs::of(&[Output::CONCENTRATION_GRADIENT, Output::MOMENT]);
    const OPTIONAL: Fields = Fields::of(&[Field::POSITION_RESIDUAL]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    const DOUBLE: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (h, c, dt) = (
            at.around.smoothing_length,
            at.get(Field::SOUND_SPEED),
            at.dt(),
        );
        let (speed, moment) = (length(&at.vector(Field::VELOCITY)), at.sum(Output::MOMENT));
        let factor = match *self {
            Self::Concentration {
                strength,
                free_surface,
            } => {
                let share = if free_surface {
                    share(SURFACE, moment)
                } else {
                    L::one()
                };
                (L::of(strength * h) * speed * dt).min(L::of(STABLE * h * h)) * share
            }
            // Σ (Vᵢ² + Vⱼ²) ∇W with nearly equal volumes, over the mass ρ V.
            Self::TransportVelocity { background } => L::of(background) * c * c * dt * dt,
        };
        let sum = at.sum_vector(Output::CONCENTRATION_GRADIENT);
        let (size, longest) = (factor * length(&sum), L::of(LONGEST * h));
        let factor = L::select(size.gt(longest), factor * longest / size, factor);
        for d in 0..D {
            at.displace(d, -factor * sum[d]);
        }
    }
}

/// The length of a vector.
#[inline(always)]
pub(super) fn length<L: Lane, const D: usize>(vector: &[L; D]) -> L {
    let mut square = L::zero();
    for own in vector {
        square += *own * *own;
    }
    square.sqrt()
}

/// How far a value has come from the first to the second of two.
#[inline(always)]
pub(super) fn share<L: Lane>([from, to]: [f64; 2], value: L) -> L {
    let share = (value - L::of(from)) / L::of(to - from);
    // What is no number stays one.
    L::one().min(L::zero().max(share))
}
