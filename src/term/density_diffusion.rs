//! Density diffusion of weakly compressible liquids: what removes the noise of their pressure.
//! Molteni & Colagrossi 2009; Antuono et al. 2010; Fourtakas et al. 2019; Zhang, Hu & Adams 2017.

use super::{Layout, Pair, Sums, Term, TermDoc, not_negative};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Lane;

/// The δ that all forms take by default (Antuono et al. 2010; Fourtakas et al. 2019).
const STANDARD_DELTA: f64 = 0.1;
/// What errors call it.
const DELTA: &str = "delta of the density diffusion";

const READS: Fields = Fields::of(&[Field::WEIGHT, Field::DENSITY, Field::SOUND_SPEED]);
const WRITES: Outputs = Outputs::of(&[Output::DENSITY_DIFFUSION]);

/// δ h c̄ Vⱼ times −2 F: what all forms multiply a density difference with.
///
/// Walls do not diffuse: their density does not follow from the flow.
#[inline(always)]
fn factor<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>, delta: f64) -> L {
    let sound_speed = pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED);
    pair.h * sound_speed * pair.j(Field::WEIGHT) * pair.f * pair.mobile * L::of(-delta)
}

/// Diffusion of the whole density difference.
///
#[doc = include_str!("../../docs/equations/molteni.html")]
///
/// (Molteni & Colagrossi 2009).
///
/// It smooths the hydrostatic gradient too, which lets a free surface rise slowly: for violent flow
/// of short duration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Molteni {
    /// Strength δ; 0.1.
    pub delta: f64,
}

impl Default for Molteni {
    fn default() -> Self {
        Self {
            delta: STANDARD_DELTA,
        }
    }
}

impl<const D: usize> Term<D> for Molteni {
    const NAME: &'static str = "meshfree::molteni";
    const READS: Fields = READS;
    const WRITES: Outputs = WRITES;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let jump = pair.j(Field::DENSITY) - pair.i(Field::DENSITY);
        sums.add(Output::DENSITY_DIFFUSION, factor(pair, self.delta) * jump);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("density diffusion, δ = {}", self.delta),
            equation: "dρᵢ/dt += δ h c Σⱼ Vⱼ 2 (ρⱼ − ρᵢ) rⱼᵢ·∇W/r²",
            source: "Molteni & Colagrossi 2009",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[(DELTA, self.delta)])
    }
}

/// Diffusion of what differs from the hydrostatic state.
///
#[doc = include_str!("../../docs/equations/fourtakas.html")]
///
/// (Fourtakas et al. 2019, eqs. 12 to 14, with density differences written as pressure differences over
/// c², so that the hydrostatic part needs no inverse of the equation of state). The mean density makes
/// it exact to third order in the distance; with the density of one side still water gains pressure.
///
/// g is the body force in the frame of the wall that
/// [carries the liquid](crate::boundary::Wall::container_frame), so a tank under 30 g is at rest in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Fourtakas {
    /// Strength δ; 0.1.
    pub delta: f64,
}

impl Default for Fourtakas {
    fn default() -> Self {
        Self {
            delta: STANDARD_DELTA,
        }
    }
}

/// pᵢ − pⱼ less its hydrostatic part, which liquid that has no pressure does not have: where it falls or
/// has cavitated there is nothing to leave out.
#[inline(always)]
fn dynamic_jump<L: Lane, const D: usize, P: Layout>(pair: &Pair<'_, L, D, P>) -> L {
    let (p_i, p_j) = (pair.i(Field::PRESSURE), pair.j(Field::PRESSURE));
    let densities = pair.i(Field::DENSITY) + pair.j(Field::DENSITY);
    // A loop, because a closure may be compiled without the instructions of the pair loop.
    let mut weight = L::zero();
    for d in 0..D {
        weight = (pair.body_force[d] * L::of(-0.5)).mul_add(pair.r[d], weight);
    }
    let jump = p_i - p_j;
    let pressed = p_j.gt(-p_i);
    L::select(pressed, densities.mul_add(weight, jump), jump)
}

impl<const D: usize> Term<D> for Fourtakas {
    const NAME: &'static str = "meshfree::fourtakas";
    const READS: Fields = READS.union(Fields::of(&[Field::PRESSURE]));
    const WRITES: Outputs = WRITES;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        // What depends on i alone is the compiler's to lift out of the loop.
        let own = pair.h * L::of(2.0 * self.delta) * pair.mobile / pair.i(Field::SOUND_SPEED);
        let rate = pair.j(Field::WEIGHT) * pair.f * own;
        let jump = pair.from_forward(dynamic_jump(&pair.forward()));
        sums.add_product(Output::DENSITY_DIFFUSION, rate, jump);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!(
                "density diffusion off the hydrostatic state, δ = {}",
                self.delta
            ),
            equation: "dρᵢ/dt += δ h/c Σⱼ Vⱼ 2 (pⱼ − pᵢ − ρ̄ g·rⱼᵢ) rⱼᵢ·∇W/r²",
            source: "Fourtakas et al. 2019, eqs. 12-14",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[(DELTA, self.delta)])
    }
}

/// Diffusion of what differs from a linear field: δ-SPH.
///
#[doc = include_str!("../../docs/equations/antuono.html")]
///
/// with corrected gradients (Antuono et al. 2010, eq. 9).
///
/// It costs a sweep for the gradient, and needs to know nothing of body forces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Antuono {
    /// Strength δ; 0.1.
    pub delta: f64,
}

impl Default for Antuono {
    fn default() -> Self {
        Self {
            delta: STANDARD_DELTA,
        }
    }
}

impl<const D: usize> Term<D> for Antuono {
    const NAME: &'static str = "meshfree::antuono";
    const READS: Fields = READS.union(Fields::of(&[Field::DENSITY_GRADIENT]));
    const WRITES: Outputs = WRITES;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let mut bent = pair.j(Field::DENSITY) - pair.i(Field::DENSITY);
        let field = Field::DENSITY_GRADIENT;
        // A loop, because a closure may be compiled without the instructions of the pair loop: then ten times slower.
        for d in 0..D {
            let mean = (pair.i_at(field, d) + pair.j_at(field, d)) * L::of(0.5);
            bent = mean.mul_add(pair.r[d], bent);
        }
        sums.add(Output::DENSITY_DIFFUSION, factor(pair, self.delta) * bent);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: format!("δ-SPH density diffusion, δ = {}", self.delta),
            equation: "dρᵢ/dt += δ h c Σⱼ Vⱼ [2 (ρⱼ − ρᵢ) − (∇ρᵢ + ∇ρⱼ)·rⱼᵢ] rⱼᵢ·∇W/r²",
            source: "Antuono et al. 2010, eq. 9",
        }
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[(DELTA, self.delta)])
    }
}

/// What a Riemann solver between two particles adds to the continuity equation.
///
/// With the velocity v* of the contact along the pair,
///
#[doc = include_str!("../../docs/equations/riemann_diffusion.html")]
///
/// (Zhang, Hu & Adams 2017, eqs. 8, 12, with the hydrostatic
/// part left out). Join it with [`Riemann`](crate::term::viscosity::Riemann) as viscosity.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RiemannDiffusion;

impl<const D: usize> Term<D> for RiemannDiffusion {
    const NAME: &'static str = "meshfree::riemann_diffusion";
    const READS: Fields = READS.union(Fields::of(&[Field::PRESSURE]));
    const WRITES: Outputs = WRITES;
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let dynamic = dynamic_jump(pair);
        let c = (pair.i(Field::SOUND_SPEED) + pair.j(Field::SOUND_SPEED)) * L::of(0.5);
        let rate = pair.j(Field::WEIGHT) * dynamic * pair.r2.sqrt() * pair.f / c;
        sums.add(Output::DENSITY_DIFFUSION, rate * pair.mobile);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "density diffusion of a Riemann solver".into(),
            equation: "dρᵢ/dt += Σⱼ Vⱼ (pᵢ − pⱼ + ρ̄ g·rⱼᵢ) |r| F/c̄",
            source: "Zhang, Hu & Adams 2017, eqs. 8, 12",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::CubicSpline;
    use crate::term::probe;

    /// dρᵢ/dt of a pair half a smoothing length apart, along a body force of 1 m/s².
    fn rate(p_i: f64, p_j: f64) -> f64 {
        let particle = |x: f64, density: f64, pressure: f64| {
            move |field: Field, _: usize| match field {
                Field::POSITION => x,
                Field::DENSITY => density,
                Field::PRESSURE => pressure,
                Field::SOUND_SPEED => 10.0,
                Field::WEIGHT => 0.1,
                _ => 1.0,
            }
        };
        let (i, j) = (particle(0.0, 1000.0, p_i), particle(0.5, 1002.0, p_j));
        let found = probe::<f64, 1, _, _>(&Fourtakas::default(), &CubicSpline, i, j);
        found.sum(Output::DENSITY_DIFFUSION, 0)
    }

    #[test]
    fn only_liquid_under_pressure_has_a_hydrostatic_part() {
        // rⱼᵢ·∇W/r² = -F, and F = 2/3 (9/4 q - 3) = -5/4 at q = 1/2; the weight of the liquid between is
        // 1001 kg/m³ · 1 m/s² · 0.5 m.
        let expected = |jump: f64| 0.1 * 1.0 / 10.0 * 0.1 * 2.0 * jump * 1.25;
        let weight = 500.5;
        let cases = [
            // At rest, pressed evenly, and with pressure on one side alone.
            ((1000.0, 1000.0 + weight), 0.0),
            ((1000.0, 1000.0), -weight),
            ((0.0, 10.0), 10.0 - weight),
            // Without pressure, and cavitated.
            ((0.0, 0.0), 0.0),
            ((10.0, -20.0), -30.0),
            ((-10.0, 10.0), 20.0),
        ];
        for ((p_i, p_j), jump) in cases {
            let rate = rate(p_i, p_j);
            assert!(
                (rate - expected(jump)).abs() < 1e-14 * weight,
                "{p_i} {p_j}: {rate} {}",
                expected(jump)
            );
        }
    }
}
