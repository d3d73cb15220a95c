//! The pressure force inside a liquid by differences of pressure: slow viscous flow, whatever pressure it is under.
//! After Sun, Colagrossi, Marrone & Zhang 2018, with the gradients of Randles & Libersky 1996.

use super::shifting::share;
use super::{DensityForm, Effect, Point, PointLaw, Reach, Setting, StepProgram};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Takes the pressure force inside a liquid from differences of pressure, exact for linear pressures on any arrangement of particles.
///
#[doc = include_str!("../../docs/equations/pressure_difference.html")]
///
/// with the volumes V \[m³ in space\], the pressure p \[Pa\], the first moment s of the lattice and the share λ.
///
/// **Why.** The pair form −Σ Vᵢ Vⱼ (pᵢ + pⱼ) ∇W pushes particles of a uniform pressure p₀ towards an even arrangement, by
/// −2 p₀ Vᵢ Σ Vⱼ ∇W. In slow flow this force is no longer small compared with the viscous one: the lattice resists shear like a solid, in
/// proportion to p₀. Differences leave it out.
///
/// **It needs shifting**, which then keeps particles even in its place: [`ConsistentShifting`](super::ConsistentShifting), whose
/// displacements follow the sound speed, or [`Shifting::CLOSED`](super::Shifting::CLOSED). A scheme without is refused.
/// [`VolumeConsistency`](super::VolumeConsistency) holds the mean pressure of a closed container.
///
/// **Free surface.** λ is one where the first moment −Σ V r·∇W/D of the neighbourhood is at least 0.95 of that of the lattice, and falls
/// to zero at 0.75; a flat surface has one half. There the pair form stays, which holds the pressure of the surface at zero. Particles with
/// λ below one are counted as limited; inside the liquid some are where particles are displaced by more than a tenth of the spacing. Still water of low viscosity below a free surface is noisier with this effect
/// ([gentle and closed flows](crate#pages)): it is for viscous liquids.
///
/// **Rigid bodies** ([`Scene::rigid`](crate::scene::Scene::rigid)) feel pᵢ + pⱼ − 2 pᵣ from each pair with the liquid, where pᵣ is the
/// smallest pressure that the liquid shows the body. A uniform pressure does not move a closed body, but its sums over a disordered
/// neighbourhood do. A body that pierces a free surface has pᵣ = 0; one that lies on a floor is moved as if liquid got beneath it.
/// Other structures and walls feel the pair form.
///
/// **Conservation.** What the differences add acts on single particles, so momentum is not conserved to rounding.
/// [`Ledger::law_impulse`](crate::simulation::Ledger::law_impulse) has what is lost, and `work of laws` the energy.
///
/// It costs 2D + D² sums and D more a pair in the sweep of the rates.
///
/// ```
/// use meshfree::effect::{ConsistentShifting, PressureDifference};
/// use meshfree::prelude::*;
/// use meshfree::term::LaminarViscosity;
/// use meshfree::term::viscosity::Inviscid;
/// let slow: Scheme<f64, 2> = schemes::weakly_compressible()
///     .with_viscosity(Inviscid)
///     .with(Laminar(LaminarViscosity))
///     .with(ConsistentShifting { in_tension: true, ..ConsistentShifting::default() })
///     .with(PressureDifference)
///     .compose();
/// assert!(slow.to_string().contains("pressure by differences"));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PressureDifference;

/// First moments of the neighbourhood over that of the lattice between which the share λ goes from zero to one.
const INSIDE: [f64; 2] = [0.75, 0.95];

/// pᵣ \[Pa\] on rigid bodies, zero elsewhere.
const REFERENCE: Field = Field::scalar(name!("reference_pressure", "Pa"));
/// Σⱼ Vⱼ (Xᵢ + Xⱼ) ∇W \[Pa/m\], the pair form.
const PAIRED: Output = Output::vector(name!("paired_pressure", "Pa/m"));
/// Σⱼ Vⱼ pᵣ ∇W/s \[Pa/m\] over rigid bodies.
const TAKEN: Output = Output::vector(name!("reference_pressure_taken", "Pa/m"));
/// Σⱼ Vⱼ (pⱼ − pᵢ) ∇W \[Pa/m\].
const SLOPE: Output = Output::vector(name!("pressure_slope", "Pa/m"));
/// −Σⱼ Vⱼ r ⊗ ∇W.
const MOMENT: Output = Output::matrix(name!("moment_of_pressure_slope", "1"));

impl<const D: usize> Effect<D> for PressureDifference {
    type Terms = (In<stage::Rates, PressureSlope>,);
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(PressureSlope),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let by_volume = program.setting().density == DensityForm::Continuity;
        program.least_on_rigid_bodies(Field::PRESSURE, REFERENCE);
        program.law(Stage::Rates, *self);
        program.document(TermDoc {
            name: "pressure by differences".into(),
            equation: "mᵢ dvᵢ/dt = −Vᵢ [λ L Σⱼ Vⱼ (pⱼ − pᵢ) ∇W + (1 − λ) Σⱼ Vⱼ (pᵢ + pⱼ) ∇W/s]",
            source: "after Sun et al. 2018; Randles & Libersky 1996",
        });
        program.require(move |scene| {
            (!by_volume || scene.written.contains(Field::CORRECTION)).then(|| {
                Problem::Incompatible {
                    what: "PressureDifference takes the place of the pressure force by volumes, and this scheme has another"
                        .into(),
                    remedy: "take DensityForm::Continuity without renormalised gradients, or leave out PressureDifference",
                }
            })
        });
        program.require(|scene| {
            (!scene.written.contains(Field::POSITION)).then(|| Problem::Incompatible {
                what: "PressureDifference leaves out the force that keeps particles even, and nothing else in this scheme does"
                    .into(),
                remedy: "add ConsistentShifting or Shifting",
            })
        });
    }
}

impl<const D: usize> PointLaw<D> for PressureDifference {
    const NAME: &'static str = "pressure by differences";
    const READS: Fields = Fields::of(&[Field::WEIGHT]);
    const WRITES: Fields = Fields::of(&[Field::FORCE]);
    const ADDS: Fields = Fields::of(&[Field::FORCE]);
    const SUMS: Outputs = Outputs::of(&[PAIRED, TAKEN, SLOPE, MOMENT]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let moment = at.sum_matrix(MOMENT);
        let mut trace = L::zero();
        for d in 0..D {
            trace += moment.0[d][d];
        }
        let full = D as f64 * at.around.lattice_consistency_factor;
        let (correction, singular) = moment.inverse(super::gradients::SINGULAR);
        let inside = share(INSIDE, trace / L::of(full));
        let inside = L::select(singular, L::zero(), inside);
        at.limited(inside.lt(L::one()));
        let (slope, volume) = (at.sum_vector(SLOPE), at.get(Field::WEIGHT));
        for d in 0..D {
            let mut gradient = L::zero();
            for k in 0..D {
                gradient += correction.0[d][k] * slope[k];
            }
            let (paired, taken) = (at.sum_at(PAIRED, d), at.sum_at(TAKEN, d));
            let force = inside * (paired - gradient) - (taken + taken);
            at.add_at(Field::FORCE, d, volume * force);
        }
    }
}

/// The sums of [`PressureDifference`], and the force −2 pᵣ Vᵢ Vⱼ ∇W/s that it takes from pairs of a liquid and a rigid body.
#[derive(Clone, Copy, Debug)]
pub struct PressureSlope;

impl<const D: usize> Term<D> for PressureSlope {
    const NAME: &'static str = "meshfree::pressure_difference";
    const READS: Fields = Fields::of(&[
        Field::WEIGHT,
        Field::PRESSURE,
        Field::PRESSURE_COEFFICIENT,
        REFERENCE,
    ]);
    const WRITES: Outputs = Outputs::of(&[PAIRED, TAKEN, SLOPE, MOMENT, Output::FORCE]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let over_lattice = pair.lattice_consistency_factor.recip();
        // At most one side is a rigid body: walls form no pairs.
        let reference = (pair.i(REFERENCE) + pair.j(REFERENCE)) * over_lattice;
        let weights = pair.i(Field::WEIGHT) * pair.j(Field::WEIGHT);
        sums.gradient.add_product(weights, reference + reference);
        let factor = pair.j(Field::WEIGHT) * pair.f;
        let taken = pair.j(REFERENCE) * over_lattice;
        let paired = pair.i(Field::PRESSURE_COEFFICIENT) + pair.j(Field::PRESSURE_COEFFICIENT);
        let rise = pair.j(Field::PRESSURE) - pair.i(Field::PRESSURE);
        for b in 0..D {
            let gradient = factor * pair.r[b];
            sums.add_product_at(PAIRED, b, paired, gradient);
            sums.add_product_at(TAKEN, b, taken, gradient);
            sums.add_product_at(SLOPE, b, rise, gradient);
            for a in 0..D {
                sums.add_product_at(MOMENT, a * D + b, -pair.r[a], gradient);
            }
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "differences of pressure".into(),
            equation: "Σⱼ Vⱼ (pⱼ − pᵢ) ∇W, −Σⱼ Vⱼ r ⊗ ∇W, Σⱼ Vⱼ (pᵢ + pⱼ) ∇W/s; +2 Vᵢ Vⱼ pᵣ ∇W/s at rigid bodies",
            source: "Randles & Libersky 1996",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::ConsistentShifting;
    use crate::material::eos::Linear;
    use crate::prelude::*;
    use crate::scheme::Start;
    use crate::term::viscosity::Inviscid;

    const SOUND: f64 = 20.0;
    const SLOPE_OF_DENSITY: [f64; 2] = [3.0, -2.0];

    fn plain() -> Scheme<f64, 2> {
        schemes::weakly_compressible()
            .with_viscosity(Inviscid)
            .compose()
    }
    /// Shifting of no strength, so that particles stay where the test puts them.
    fn differences() -> Scheme<f64, 2> {
        schemes::weakly_compressible()
            .with_viscosity(Inviscid)
            .with(ConsistentShifting {
                strength: 0.0,
                in_tension: true,
            })
            .with(PressureDifference)
            .compose()
    }
    fn liquid() -> Material<f64> {
        Material::new("liquid", Linear::new(1000.0, SOUND))
    }

    /// The largest error of the acceleration over the exact one, inside a block whose particles are displaced by up to 0.05
    /// spacings, so that λ is one, and whose pressure is linear.
    fn error(scheme: Scheme<f64, 2>) -> f64 {
        let [a, b] = SLOPE_OF_DENSITY;
        let body = Body::block("liquid", liquid(), [0.0; 2], [1.0; 2], 0.05).jitter(0.05, 5);
        let mut block = Scene::new(scheme)
            .body(body.start(|[x, y], own| Start {
                density: 1005.0 + a * x + b * y,
                ..own
            }))
            .build()
            .unwrap();
        let inside = |p: [f64; 2]| p.iter().all(|x| (0.25..0.75).contains(x));
        let dt = 1e-9;
        block.step_at_most(dt).unwrap();
        let errors = block.all().filter(|p| inside(p.position())).map(|p| {
            let exact = SLOPE_OF_DENSITY.map(|slope| -SOUND * SOUND * slope / p.density());
            let found = p.velocity().map(|v| v / block.time());
            (found[0] - exact[0]).hypot(found[1] - exact[1]) / exact[0].hypot(exact[1])
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn a_linear_pressure_has_its_gradient_on_a_disordered_lattice() {
        let (exact, control) = (error(differences()), error(plain()));
        assert!(exact < 1e-7, "{exact}");
        assert!(control > 0.1, "{control}");
    }

    /// The force of a liquid of uniform pressure on a rigid disc among displaced particles, over p times its diameter.
    fn push(scheme: Scheme<f64, 2>) -> f64 {
        let (dx, radius) = (0.05, 0.2);
        let block = Body::block("all", liquid(), [0.0; 2], [1.0; 2], dx);
        let is_disc = |x: &[f64; 2]| (x[0] - 0.5).hypot(x[1] - 0.5) < radius;
        let (disc, wet): (Vec<_>, Vec<_>) = block.points().iter().copied().partition(is_disc);
        let metal = Material::new("metal", Linear::new(2000.0, SOUND));
        let wet = Body::points_of("liquid", liquid(), wet, dx).jitter(0.3, 5);
        let scene = Scene::new(scheme)
            .body(wet.start(|_, own| Start {
                density: 1005.0,
                ..own
            }))
            .group(
                schemes::impact_by_continuity(),
                [Body::points_of("disc", metal, disc, dx)],
            )
            .rigid("disc")
            .boundary(Periodic::along(0, 0.0, 1.0))
            .boundary(Periodic::along(1, 0.0, 1.0))
            .build()
            .unwrap();
        let [x, y] = scene.force_between("disc", "liquid").unwrap();
        x.hypot(y) / (5.0 * SOUND * SOUND * 2.0 * radius)
    }

    #[test]
    fn a_uniform_pressure_does_not_push_a_rigid_disc() {
        let (none, control) = (push(differences()), push(plain()));
        assert!(none < 1e-9, "{none}");
        assert!(control > 1e-3, "{control}");
    }

    #[test]
    fn a_scheme_that_does_not_shift_is_refused() {
        let scene = |scheme: Scheme<f64, 2>| {
            let body = Body::block("liquid", liquid(), [0.0; 2], [1.0; 2], 0.1);
            Scene::new(scheme).body(body).build().map(|_| ())
        };
        let unshifted = schemes::weakly_compressible().with(PressureDifference);
        let refused = scene(unshifted.compose()).unwrap_err().to_string();
        assert!(refused.contains("add ConsistentShifting"), "{refused}");
        let renormalised = schemes::weakly_compressible()
            .renormalised()
            .with(Shifting::CLOSED)
            .with(PressureDifference);
        let refused = scene(renormalised.compose()).unwrap_err().to_string();
        assert!(refused.contains("renormalised"), "{refused}");
        assert!(scene(differences()).is_ok());
    }
}
