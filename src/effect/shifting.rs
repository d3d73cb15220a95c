//! Shifting: keeps the particles of a liquid evenly spread, and leaves its free surface alone.
//! Lind et al. 2012, Skillen et al. 2013; the transport velocity of Adami, Hu & Adams 2013.

use super::{Chunk, DensityForm, Effect, Law, Rung, Setting, StepProgram, Tally};
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::sweep::add_compensated;
use crate::term::{ConcentrationGradient, In, Stage, stage};

/// How particles are kept evenly spread.
///
/// Where a flow strains, a lattice breaks up, and the kernel sums of a disordered neighbourhood read
/// as pressure: vortices decay far too fast without it ([defaults](crate#pages)).
///
/// Densities do not follow the shifts, and drift where viscosity is too weak to keep order:
/// [`VolumeConsistency`](super::VolumeConsistency) holds them.
#[derive(Clone, Copy, Debug, PartialEq)]
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

impl<T: Real, const D: usize> Law<T, D> for Shifting {
    fn name(&self) -> &'static str {
        "shifting"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[Field::VELOCITY, Field::SOUND_SPEED])
    }
    fn sums(&self) -> Outputs {
        Outputs::of(&[Output::CONCENTRATION_GRADIENT, Output::MOMENT])
    }
    fn writes(&self) -> Fields {
        PLACE
    }
    fn adds(&self) -> Fields {
        PLACE
    }
    fn optional(&self) -> Fields {
        Fields::of(&[Field::POSITION_RESIDUAL])
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Flow)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        let [concentration, moments] =
            [Output::CONCENTRATION_GRADIENT, Output::MOMENT].map(|sum| chunk.sum(sum));
        let dt = chunk.around.dt;
        let h = chunk.around.smoothing_length;
        let ([v, c], [x, residual]) = chunk.columns(
            [Field::VELOCITY, Field::SOUND_SPEED],
            [Field::POSITION, Field::POSITION_RESIDUAL],
        );
        for (n, (x, v)) in x.chunks_exact_mut(D).zip(v.chunks_exact(D)).enumerate() {
            let factor = match *self {
                Self::Concentration {
                    strength,
                    free_surface,
                } => {
                    let speed = v.iter().fold(0.0, |s, v| s + v.to_f64().powi(2)).sqrt();
                    let moment = moments.get(0, n).to_f64();
                    let inside = (moment - SURFACE[0]) / (SURFACE[1] - SURFACE[0]);
                    let share = if free_surface {
                        inside.clamp(0.0, 1.0)
                    } else {
                        1.0
                    };
                    (strength * h * speed * dt).min(STABLE * h * h) * share
                }
                // Σ (Vᵢ² + Vⱼ²) ∇W with nearly equal volumes, over the mass ρ V.
                Self::TransportVelocity { background } => {
                    let c = c[n].to_f64();
                    background * c * c * dt * dt
                }
            };
            let longest = LONGEST * h;
            let sum: [f64; D] = core::array::from_fn(|d| concentration.get(d, n).to_f64());
            let size = factor * sum.iter().fold(0.0, |s, g| s + g * g).sqrt();
            let factor = if size > longest {
                factor * longest / size
            } else {
                factor
            };
            for d in 0..D {
                let by = T::from_f64(-factor * sum[d]);
                add_compensated(&mut x[d], residual.get_mut(n * D + d), by);
            }
        }
        Tally::default()
    }
}
