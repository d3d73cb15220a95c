//! Bars in one dimension that are free to widen: the lateral strain by which lateral stress is zero.
//! Without it a line of particles is a layer of an infinite plate, in uniaxial strain.

use super::{
    Chunk, Effect, Evolved, Hypoelastic, Law, Rate, Setting, StepProgram, Tally, View, When,
};
use crate::error::Problem;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::tensor::Symmetric;
use crate::term::{Stage, TermDoc};

/// Uniaxial stress, for [`Hypoelastic`] solids in one dimension: slender bars, whose waves run at √(E/ρ).
///
/// ε̇_yy = ε̇_zz = −ν ε̇_xx,  p = S_yy,  so that σ_yy = σ_zz = S_yy − p = 0 and dσ_xx/dt = E ε̇_xx
///
/// with Young's modulus E = 9KG/(3K + G) and Poisson's ratio ν of the material at rest;
/// [`Plasticity`](super::Plasticity) keeps lateral stress at zero too. The pressure of the equation of state does not
/// act. Strains are small: the force is that on the cross-section at rest, so at a strain of 10 % it is some 10 % too
/// small in compression, and too large in tension. The step, and viscosity, take the speed of longitudinal waves in the bulk, which is above
/// that of the bar.
///
/// | it adds | as |
/// |---|---|
/// | [`LATERAL_STRAIN`](Self::LATERAL_STRAIN) | ε_yy = ε_zz, positive where the bar has widened |
///
/// ```
/// use meshfree::effect::{Hypoelastic, UniaxialStress};
/// use meshfree::prelude::*;
///
/// let steel = catalogue::steel_4340();
/// let strike = Body::block("rod", steel, [0.0], [0.05], 5e-4).velocity([-5.0]);
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(UniaxialStress);
/// let mut rod = Scene::<f64, 1>::new(scheme)
///     .body(strike)
///     .boundary(MirrorPlane::wall([0.0], [-1.0]))
///     .build()?;
/// rod.run_until(4e-6)?;
/// let foot = rod.body("rod")?.next().and_then(|p| p.scalar(UniaxialStress::LATERAL_STRAIN));
/// assert!(foot.is_some_and(|strain| strain > 0.0));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct UniaxialStress;

impl UniaxialStress {
    /// Lateral strain.
    pub const LATERAL_STRAIN: Field = Field::scalar(11);
}

const STRESS: Field = Hypoelastic::STRESS;
const LATERAL_STRAIN: Field = UniaxialStress::LATERAL_STRAIN;
const GRADIENT: Outputs = Outputs::of(&[Output::VELOCITY_GRADIENT, Output::MOMENT_MATRIX]);

impl Effect<1> for UniaxialStress {
    type Terms = ();
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, 1>) {
        program.declare(LATERAL_STRAIN, "lateral_strain", "1", 0.0);
        let strain = Evolved::kicked(LATERAL_STRAIN).at(When::Drift);
        program.evolve(strain.by(*self));
        program.contribute(STRESS, WideningStress);
        program.law(Stage::State, *self);
        program.document(TermDoc {
            name: "uniaxial stress".into(),
            equation: "D_yy = D_zz = −ν D_xx, p = S_yy",
            source: "Hooke's law with σ_yy = σ_zz = 0",
        });
        program.require(|scene| {
            (!scene.integrated.contains(STRESS)).then(|| Problem::Incompatible {
                what: "UniaxialStress needs a deviatoric stress, which nothing in the scheme integrates"
                    .into(),
                remedy: "add the elastic solid as well: .with(Hypoelastic)",
            })
        });
    }
}

/// −ν ∂v/∂x of each particle.
fn widening<T: Real>(at: &View<'_, T, 1>, slot: usize) -> T {
    let poisson = at.around.material.poisson_ratio().unwrap_or(0.0);
    at.velocity_gradient(slot)[(0, 0)] * T::from_f64(-poisson)
}

impl<T: Real> Rate<T, 1> for UniaxialStress {
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        GRADIENT
    }
    fn source(&self, at: &View<'_, T, 1>, first: usize, source: &mut [T]) {
        for (n, rate) in source.iter_mut().enumerate() {
            *rate += widening(at, first + n);
        }
    }
}

/// What widening adds to the rate of S, 2 G (D − tr D/3) of its two components.
#[derive(Clone, Copy, Debug)]
struct WideningStress;

impl<T: Real> Rate<T, 1> for WideningStress {
    fn reads(&self) -> Fields {
        Fields::NONE
    }
    fn sums(&self) -> Outputs {
        GRADIENT
    }
    fn source(&self, at: &View<'_, T, 1>, first: usize, source: &mut [T]) {
        let twice = T::from_f64(2.0 * at.around.material.shear_modulus.unwrap_or(0.0));
        for (n, source) in source.chunks_exact_mut(6).enumerate() {
            let rate = widening(at, first + n);
            let strain = Symmetric::diagonal([T::zero(), rate, rate]);
            for (sum, rate) in source.iter_mut().zip(strain.deviator().components()) {
                *sum += twice * *rate;
            }
        }
    }
}

impl<T: Real> Law<T, 1> for UniaxialStress {
    fn name(&self) -> &'static str {
        "pressure of uniaxial stress"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[STRESS])
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::PRESSURE])
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, 1>) -> Tally {
        let [pressure, stress] = chunk.columns([Field::PRESSURE, STRESS]);
        for (pressure, stress) in pressure.iter_mut().zip(stress.chunks_exact(6)) {
            *pressure = stress[1];
        }
        Tally::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::Plasticity;
    use crate::material::eos::Linear;
    use crate::material::strength::LinearHardening;
    use crate::prelude::*;
    use crate::scheme::Start;

    const RHO: f64 = 1000.0;
    const YOUNG: f64 = 1e7;
    const POISSON: f64 = 0.3;
    const YIELD: f64 = 2e3;
    const HARDENING: f64 = 5e6;

    /// The stress −σ_xx \[Pa\] of a bar that is struck at twice 0.05 m/s, by place.
    fn struck(law: LinearHardening, time: f64) -> (Simulation<f64, 1>, Vec<[f64; 2]>) {
        let material = Material::new("metal", Linear::from_elastic_constants(RHO, YOUNG, POISSON))
            .with_shear_modulus(YOUNG / (2.0 * (1.0 + POISSON)))
            .with_strength(law);
        let scheme = schemes::impact_by_continuity()
            .with(UniaxialStress)
            .with(Hypoelastic)
            .with(Plasticity);
        let start = |[x]: [f64; 1], own: Start<1>| Start {
            velocity: [if x < 0.0 { 0.05 } else { -0.05 }],
            ..own
        };
        let mut bar = Scene::<f64, 1>::new(scheme)
            .body(Body::block("bar", material, [-1.0], [1.0], 2e-3).start(start))
            .build()
            .unwrap();
        bar.run_until(time).unwrap();
        let mut all: Vec<_> = bar
            .all()
            .map(|p| {
                let stress = p.tensor(STRESS).unwrap();
                [p.position()[0], p.pressure() - stress.components()[0]]
            })
            .collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        (bar, all)
    }

    /// Where the stress, from the right, first reaches a value.
    fn front(profile: &[[f64; 2]], value: f64) -> f64 {
        let k = profile.iter().rposition(|[_, s]| *s >= value).unwrap();
        let ([x0, s0], [x1, s1]) = (profile[k], profile[k + 1]);
        x0 + (value - s0) / (s1 - s0) * (x1 - x0)
    }

    fn mean(profile: &[[f64; 2]], from: f64, to: f64) -> f64 {
        let inside = profile.iter().filter(|[x, _]| (from..to).contains(x));
        let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), [_, s]| (sum + s, count + 1.0));
        sum / count
    }

    /// A bar of a bilinear material: an elastic wave of the yield stress at √(E/ρ), then a plastic one at √(E_t/ρ) with
    /// the tangent modulus E_t = E H/(E + H) (Taylor, von Kármán).
    #[test]
    fn waves_run_at_the_speeds_of_a_slender_bar() {
        let tangent = YOUNG * HARDENING / (YOUNG + HARDENING);
        let [elastic, plastic] = [YOUNG, tangent].map(|modulus| (modulus / RHO).sqrt());
        let before = YIELD / (RHO * elastic);
        let plateau = YIELD + RHO * plastic * (0.05 - before);
        let law = LinearHardening::new(YIELD, HARDENING);
        let [(first, early), (last, late)] = [3e-3, 6e-3].map(|time| struck(law, time));
        let time = last.time() - first.time();
        let speed = |value| (front(&late, value) - front(&early, value)) / time;
        let found = [
            mean(&late, 0.42, 0.52) / YIELD,
            speed(0.5 * YIELD) / elastic,
            speed(0.5 * (YIELD + plateau)) / plastic,
            mean(&late, 0.08, 0.27) / plateau,
        ];
        println!("precursor, its speed, plastic speed, plateau over exact: {found:?}");
        // Measured within 0.001.
        assert!(
            found.iter().all(|value| (value - 1.0).abs() < 0.003),
            "{found:?}"
        );
        for p in last.all() {
            let stress = p.tensor(STRESS).unwrap();
            let [_, yy, zz, ..] = *stress.components();
            assert!((yy - p.pressure()).abs() < 1e-9 * YIELD && (yy - zz).abs() < 1e-9 * YIELD);
        }
        // σ/E elastic, the rest plastic and without change of volume.
        let inside: Vec<_> = last
            .all()
            .filter(|p| (0.08..0.27).contains(&p.position()[0]))
            .map(|p| p.scalar(LATERAL_STRAIN).unwrap())
            .collect();
        let lateral = inside.iter().sum::<f64>() / inside.len() as f64;
        let exact = POISSON * plateau / YOUNG + 0.5 * (plateau - YIELD) / HARDENING;
        assert!((lateral / exact - 1.0).abs() < 0.01, "{lateral} {exact}");
        let drift = last.ledger().whole.total_energy() / (0.5 * 2.0 * RHO * 0.05 * 0.05) - 1.0;
        assert!(drift.abs() < 1e-12, "{drift}");
        // Without yield one wave of ρ c v.
        let (_, whole) = struck(LinearHardening::new(1e9, 0.0), 6e-3);
        let alone = mean(&whole, 0.08, 0.5) / (RHO * elastic * 0.05);
        assert!((alone - 1.0).abs() < 0.01, "{alone}");
    }
}
