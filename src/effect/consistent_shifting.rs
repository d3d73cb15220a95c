//! Shifting with its term in continuity: keeps a violent liquid even, its volume, and its free surface.
//! Sun, Colagrossi, Marrone, Antuono & Zhang 2019 (Comput. Methods Appl. Mech. Engrg. 348, 912).

use super::shifting::{PLACE, length, share};
use super::{
    BySum, DensityForm, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram, not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Moves particles of a liquid with u + δu, against the gradient of their concentration, and tells their densities.
///
#[doc = include_str!("../../docs/equations/consistent_shifting.html")]
///
/// with the sound speed c \[m/s\], the kernel W₀ at the spacing and the first moment s of the lattice (Sun et al. 2019). The first sum is
/// what the motion δu compresses, the second the mass that crosses into moved volumes. [`Shifting`](super::Shifting) has
/// neither: what it moves keeps its density.
///
/// **For flow in a plane.** In a closed tank in three dimensions it drives water into the walls, one particle in 25 within 80 ms at
/// 30 g ([sloshing](crate#pages)). [`ArbitraryLagrangian`](super::ArbitraryLagrangian), where mass passes between particles instead, does
/// not, nor does [`Shifting::STANDARD`](super::Shifting::STANDARD).
///
/// **Free surface**, by the first moment of the neighbourhood over that of the lattice, which is ½ at a flat surface: below
/// 0.95 the part of δu along Σ V ∇W, out of or into the liquid, fades, and is gone at 0.75; below 0.6 the rest
/// does, and drops and single rows are not moved. Rows below an even surface still are. **Cavitated liquid**, of no pressure, is left
/// alone too ([`in_tension`](Self::in_tension)): with a cut-off nothing there would take a spreading back.
///
/// δu follows the sound speed, so it is the same for every observer, and evens out over a distance √(a h c t). Sun et al. multiply by
/// the largest speed expected over c instead, and by more.
///
/// The paper's term in momentum, Σ V (ρᵢ uᵢ δuᵢ + ρⱼ uⱼ δuⱼ)·∇W, is left out: alone it depends on the frame in which u is
/// measured, and what would make up for that is no force between pairs. A tank at 30 g with each form, and what a does there, is in
/// [defaults](crate#pages).
///
/// It costs a sweep in every evaluation and two vectors a particle.
///
/// ```
/// use meshfree::effect::{ConsistentShifting, ExpansionMemory};
/// use meshfree::prelude::*;
/// let violent: Scheme<f64, 2> = schemes::weakly_compressible()
///     .with(ExpansionMemory)
///     .with(ConsistentShifting::default())
///     .compose();
/// assert!(violent.to_string().contains("consistent shifting"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ConsistentShifting {
    /// Strength a; 0.1: less leaves the layers of the first lattice in violent flow, more loses impulse. Zero is none.
    pub strength: f64,
    /// Whether particles without pressure are moved; not by default. Without a cut-off, in liquids that support tension, say yes.
    pub in_tension: bool,
}

impl Default for ConsistentShifting {
    fn default() -> Self {
        Self {
            strength: 0.1,
            in_tension: false,
        }
    }
}

impl ConsistentShifting {
    /// δu \[m/s\].
    pub const VELOCITY: Field = Field::vector(name!("shifting_velocity", "m/s"));
}

pub(super) const SHIFT: Field = ConsistentShifting::VELOCITY;
/// Σⱼ Vⱼ (1 + 0.2 (W/W₀)⁴) ∇W \[1/m\].
const CONCENTRATION: Output = Output::vector(name!("crowding", "1/m"));
/// Σⱼ Vⱼ ∇W \[1/m\], out of the liquid.
const OUTWARDS: Output = Output::vector(name!("outwards", "1/m"));
/// Σⱼ Vⱼ rᵢⱼ·∇W, which is −D where the kernel finds a full neighbourhood.
const FULLNESS: Output = Output::scalar(name!("gradient_moment", "1"));
/// Rate of density \[kg/(m³ s)\].
const RATE: Output = Output::scalar(name!("density_rate_of_shifting", "kg/(m³ s)"));

/// Strength of the repulsion of near pairs, as of Lind et al. 2012 and Sun et al. 2019.
const REPULSION: f64 = 0.2;
/// Fullness between which a particle begins to be shifted across the surface, and is in full.
const ACROSS: [f64; 2] = [0.75, 0.95];
/// The same along the surface.
const ALONG: [f64; 2] = [0.4, 0.6];
/// Largest δu in sound speeds: larger ones come from pairs that have collapsed.
const FASTEST: f64 = 0.1;

impl<const D: usize> Effect<D> for ConsistentShifting {
    type Terms = (
        In<stage::Flow, Crowding>,
        In<stage::Continuity, ShiftedContinuity>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, setting: &Setting) -> Self::Terms {
        let over_kernel_at_spacing = 1.0 / setting.kernel_at_spacing;
        (
            In::new(Crowding {
                over_kernel_at_spacing,
            }),
            In::new(ShiftedContinuity),
        )
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let by_volume = program.setting().density == DensityForm::Continuity;
        program.declare(SHIFT, 0.0);
        program.law(Stage::Flow, *self);
        program.law(Stage::Continuity, Displace);
        program.contribute(
            Field::DENSITY,
            BySum {
                sum: RATE,
                over: None,
            },
        );
        program.document(TermDoc {
            name: format!("consistent shifting, a = {}", self.strength),
            equation: "dx/dt = u + δu, δuᵢ = −a h c Σⱼ Vⱼ (1 + 0.2 (W/W₀)⁴) ∇W",
            source: "after Sun et al. 2019",
        });
        program.require(move |_| {
            (!by_volume).then(|| Problem::Incompatible {
                what: "ConsistentShifting moves particles in the middle of a drift by sums over volumes, which this \
                       scheme does not make there"
                    .into(),
                remedy: "take DensityForm::Continuity, or leave out ConsistentShifting",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("strength of the consistent shifting", self.strength)])
    }
}

impl<const D: usize> PointLaw<D> for ConsistentShifting {
    const NAME: &'static str = "velocity of consistent shifting";
    const READS: Fields = Fields::of(&[Field::SOUND_SPEED, Field::PRESSURE]);
    const WRITES: Fields = Fields::of(&[SHIFT]);
    const SUMS: Outputs = Outputs::of(&[CONCENTRATION, OUTWARDS, FULLNESS]);
    const DOUBLE: bool = true;
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (h, c) = (at.around.smoothing_length, at.get(Field::SOUND_SPEED));
        let (gradient, normal) = (at.sum_vector(CONCENTRATION), at.sum_vector(OUTWARDS));
        let full = D as f64 * at.around.lattice_consistency_factor;
        let fullness = -at.sum(FULLNESS) / L::of(full);
        let (across, along) = (share(ACROSS, fullness), share(ALONG, fullness));
        let near_surface = across.lt(L::one());
        let mut shift = [L::zero(); D];
        let (mut square, mut dot) = (L::zero(), L::zero());
        for d in 0..D {
            shift[d] = L::of(-self.strength * h) * c * gradient[d];
            square += normal[d] * normal[d];
            dot += shift[d] * normal[d];
        }
        let part = L::select(square.gt(L::zero()), dot / square, L::zero());
        for d in 0..D {
            let tangential = along * (shift[d] - (L::one() - across) * part * normal[d]);
            shift[d] = L::select(near_surface, tangential, shift[d]);
        }
        let (speed, fastest) = (length(&shift), L::of(FASTEST) * c);
        let held = L::select(speed.gt(fastest), fastest / speed, L::one());
        let still = at.get(Field::PRESSURE).le(L::zero());
        for d in 0..D {
            let own = held * shift[d];
            let own = if self.in_tension {
                own
            } else {
                L::select(still, L::zero(), own)
            };
            at.set_at(SHIFT, d, own);
        }
    }
}

/// Moves particles by δu.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displace;

impl<const D: usize> PointLaw<D> for Displace {
    const NAME: &'static str = "consistent shifting";
    const READS: Fields = Fields::of(&[SHIFT]);
    const WRITES: Fields = PLACE;
    const ADDS: Fields = PLACE;
    const OPTIONAL: Fields = Fields::of(&[Field::POSITION_RESIDUAL]);
    const RUNG: Option<Rung> = Some(Rung::Flow);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        for d in 0..D {
            at.displace(d, at.dt() * at.get_at(SHIFT, d));
        }
    }
}

/// The gradient of the concentration, the way out, and how full the neighbourhood is.
#[derive(Clone, Copy, Debug)]
pub struct Crowding {
    /// One over hᴰ W of the spacing.
    pub over_kernel_at_spacing: f64,
}

impl<const D: usize> Term<D> for Crowding {
    const NAME: &'static str = "meshfree::crowding";
    const READS: Fields = Fields::of(&[Field::WEIGHT]);
    const WRITES: Outputs = Outputs::of(&[CONCENTRATION, OUTWARDS, FULLNESS]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // Times the fourth root of the strength, so that the fourth power and one are a single product and sum.
        let root = REPULSION.sqrt().sqrt() * self.over_kernel_at_spacing;
        let ratio = pair.w * (pair.h.powi(D as u32) * L::of(root));
        let square = ratio * ratio;
        let gradient = pair.j(Field::WEIGHT) * pair.f;
        let crowded = gradient * square.mul_add(square, L::one());
        for d in 0..D {
            sums.add_product_at(CONCENTRATION, d, crowded, pair.r[d]);
            sums.add_product_at(OUTWARDS, d, gradient, pair.r[d]);
        }
        sums.add_product(FULLNESS, gradient, pair.r2);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "concentration gradient".into(),
            equation: "Σⱼ Vⱼ (1 + 0.2 (W/W₀)⁴) ∇W, Σⱼ Vⱼ ∇W, Σⱼ Vⱼ r·∇W",
            source: "Lind et al. 2012, eq. 24; Sun et al. 2019",
        }
    }
}

/// What shifting does to density.
#[derive(Clone, Copy, Debug)]
pub struct ShiftedContinuity;

impl<const D: usize> Term<D> for ShiftedContinuity {
    const NAME: &'static str = "meshfree::shifted_continuity";
    const READS: Fields = Fields::of(&[Field::WEIGHT, Field::DENSITY, SHIFT]);
    const WRITES: Outputs = Outputs::of(&[RATE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let (mut own, mut other) = (L::zero(), L::zero());
        for d in 0..D {
            own = pair.i_at(SHIFT, d).mul_add(pair.r[d], own);
            other = pair.j_at(SHIFT, d).mul_add(pair.r[d], other);
        }
        let (density, others) = (pair.i(Field::DENSITY), pair.j(Field::DENSITY));
        // Both sums at once: ρᵢ (δuᵢ − δuⱼ) + ρᵢ δuᵢ + ρⱼ δuⱼ.
        let moved = (density + density) * own + (others - density) * other;
        let volume = pair.j(Field::WEIGHT) * pair.f / pair.lattice_consistency_factor;
        sums.add_product(RATE, volume, moved);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "continuity of shifting".into(),
            equation: "dρᵢ/dt += Σⱼ Vⱼ [ρᵢ (δuᵢ − δuⱼ) + ρᵢ δuᵢ + ρⱼ δuⱼ]·∇W/s",
            source: "Sun et al. 2019",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::*;
    use crate::scheme::Start;

    /// A pressed block, displaced by a share of its spacing, that moves at a speed.
    fn block(displaced: f64, speed: f64, strength: f64) -> Simulation<f64, 2> {
        let scheme = schemes::weakly_compressible().with(ConsistentShifting {
            strength,
            ..ConsistentShifting::default()
        });
        let start = |_, own| Start {
            velocity: [speed, 0.5 * speed],
            density: 1010.0,
            ..own
        };
        let water = catalogue::weakly_compressible_water(1.0);
        let body = Body::block("water", water, [0.0; 2], [1.0; 2], 0.05);
        Scene::new(scheme)
            .body(body.jitter(displaced, 3).start(start))
            .build()
            .unwrap()
    }

    /// The largest δu of particles more than a support within the block.
    fn fastest(own: &Simulation<f64, 2>) -> f64 {
        let inside = |p: [f64; 2]| p.iter().all(|x| (0.2..0.8).contains(x));
        let all = own.all().filter(|p| inside(p.position()));
        let all = all.filter_map(|p| p.vector(SHIFT));
        all.map(|[x, y]| x.hypot(y)).fold(0.0, f64::max)
    }

    /// Nothing moves within a lattice; what is displaced does.
    #[test]
    fn an_even_lattice_is_not_shifted() {
        let (even, uneven) = (block(0.0, 0.0, 0.1), block(0.2, 0.0, 0.1));
        assert!(fastest(&uneven) > 0.01, "{}", fastest(&uneven));
        assert!(fastest(&even) < 1e-9, "{}", fastest(&even));
    }

    /// The same for every observer.
    #[test]
    fn a_block_that_moves_is_shifted_as_one_at_rest() {
        let (mut still, mut moving) = (block(0.2, 0.0, 0.1), block(0.2, 30.0, 0.1));
        for own in [&mut still, &mut moving] {
            for _ in 0..20 {
                own.step_at_most(1e-3).unwrap();
            }
        }
        let shift = 30.0 * moving.time();
        let pairs = still.all().zip(moving.all());
        let apart = pairs.map(|(a, b)| {
            let (x, y) = (a.position(), b.position());
            (y[0] - x[0] - shift)
                .abs()
                .max((y[1] - x[1] - 0.5 * shift).abs())
        });
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 1e-9, "{apart}");
    }
}
