//! Surface tension between two liquids by the curvature of their interface, as a force on the particles near it.
//! Brackbill, Kothe & Zemach 1992 (J. Comput. Phys. 100, 335); Morris 2000; Adami, Hu & Adams 2010 (J. Comput. Phys. 229, 5011).

use super::shifting::length;
use super::{
    Around, CONSTANTS, Effect, Point, PointLaw, PointLimit, Reach, Setting, StepProgram,
    not_negative,
};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{In, Layout, Pair, Stage, Sums, Term, TermDoc, stage};

/// Surface tension σ \[N/m\] between the bodies of two materials of one scheme, which are bonded.
///
/// The colour c is 1 in the first liquid and 0 in the second; its gradient, weighted by densities, is the normal of the interface
/// and spreads the force over the particles within the support of the kernel:
///
#[doc = include_str!("../../docs/equations/surface_tension.html")]
///
/// with c_ij = 1 where j is of the first liquid and i of the second, −1 in the opposite case and 0 elsewhere, masses m \[kg\], volumes
/// V \[m³\], densities ρ \[kg/m³\], curvature κ \[1/m\], the first moment s of the lattice, dimension D, and P the projection on the
/// tangent plane of i. The acceleration is the same on both sides
/// (Adami et al.). The curvature is the divergence of the normals in the tangent plane, reproducing as theirs, and weighted by |∇c| so that
/// normals of particles far from the interface, which few neighbours make, count little.
///
/// A drop of radius R \[m\] has a pressure higher by σ/R in two dimensions and 2σ/R in three. The step is limited by capillary waves (Brackbill et
/// al.). Forces are no pair forces: momentum changes by [`Ledger::law_impulse`](crate::simulation::Ledger::law_impulse),
/// and what the interface releases is [`EnergyLedger::law_work`](crate::simulation::EnergyLedger::law_work). Walls and other
/// liquids have no colour: contact angles and free surfaces have no tension.
///
/// Diffusion of density takes the jump of the pressure for an error: leave it out, or confine it by
/// [`WithinPhase`](super::WithinPhase). Particles need to be kept even by weak shifts, as
/// those of `Shifting::TransportVelocity { background: 3.0 }`: the strong ones of [`Shifting::CLOSED`](super::Shifting::CLOSED) hold the interface
/// back.
///
/// ```
/// use meshfree::effect::SurfaceTension;
/// use meshfree::material::eos::Tait;
/// use meshfree::prelude::*;
/// use meshfree::sweep::Interaction;
/// use meshfree::term::viscosity::Inviscid;
///
/// let oil = Material::new("oil", Tait::new(900.0, 1.0));
/// let water = Material::new("water", Tait::new(1000.0, 1.0));
/// let scheme = SchemeBuilder::liquid(WendlandC2, Inviscid)
///     .with(SurfaceTension::between("oil", "water", 0.03))
///     .between_bodies(Interaction::Bonded);
/// let layers = Scene::<f64, 2>::new(scheme)
///     .body(Body::block("oil", oil, [0.0; 2], [0.01, 0.005], 5e-4))
///     .body(Body::block("water", water, [0.0, 0.005], [0.01, 0.01], 5e-4))
///     .build()?;
/// assert!(layers.scheme().to_string().contains("curvature of the interface"));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct SurfaceTension {
    /// Surface tension σ \[N/m\].
    pub tension: f64,
    /// Names of the two materials.
    pub between: [String; 2],
}

impl SurfaceTension {
    /// A tension \[N/m\] between bodies of two materials, by the names of these.
    #[must_use]
    pub fn between(first: &str, second: &str, tension: f64) -> Self {
        Self {
            tension,
            between: [first.into(), second.into()],
        }
    }
}

/// One in the first liquid, two in the second, zero elsewhere.
const COLOUR: Field = Field::scalar(name!("colour", "1"));
const STEEPNESS: Field = Field::scalar(name!("colour_gradient", "1/m"));
const NORMAL: Field = Field::vector(name!("interface_normal", "1"));
const GRADIENT: Output = Output::vector(name!("gradient of the colour", "1/m"));
const TURN: Output = Output::scalar(name!("turn of the normals", "1/m"));
const SPAN: Output = Output::scalar(name!("span of the turn", "1"));
/// Least |∇c| h of a particle at the interface.
const LEAST: f64 = 0.01;

impl<const D: usize> Effect<D> for SurfaceTension {
    type Terms = (
        In<stage::Flow, ColourGradient>,
        In<stage::Rates, InterfaceCurvature>,
    );
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(ColourGradient), In::new(InterfaceCurvature))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.declare(COLOUR, 0.0);
        program.declare(STEEPNESS, 0.0);
        program.declare(NORMAL, 0.0);
        program.law(Stage::State, Colours(self.between.clone()));
        program.law(Stage::Flow, Normals);
        program.law(Stage::Rates, Force(self.tension));
        program.limit(CapillaryWaves(self.tension));
        let names = self.between.clone();
        program.require(move |scene| {
            let there = |name: &String| scene.bodies.iter().any(|(_, own)| own.name == *name);
            let lacks = names.iter().find(|name| !there(name));
            if names[0] == names[1] {
                return Some(Problem::Incompatible {
                    what: format!(
                        "surface tension between the material `{}` and itself",
                        names[0]
                    ),
                    remedy: "give the two liquids materials of different names",
                });
            }
            lacks.map(|name| Problem::Incompatible {
                what: format!(
                    "surface tension of the material `{name}`, of which no body of the scheme is"
                ),
                remedy: "name the materials of two bodies, as Material::new has them",
            })
        });
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        not_negative(&[("surface tension", self.tension)])
    }
}

/// Writes the colour of each liquid.
#[derive(Clone, Debug)]
struct Colours([String; 2]);

impl<const D: usize> PointLaw<D> for Colours {
    const NAME: &'static str = "colours of liquids";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[COLOUR]);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        let of = |name: &String| f64::from(u8::from(*name == around.material.name));
        constants[0] = of(&self.0[0]) + 2.0 * of(&self.0[1]);
        true
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        at.set(COLOUR, at.constant(0));
    }
}

/// ∇c, towards the first liquid.
#[derive(Clone, Copy, Debug)]
pub struct ColourGradient;

impl<const D: usize> Term<D> for ColourGradient {
    const NAME: &'static str = "meshfree::colour_gradient";
    const READS: Fields = Fields::of(&[COLOUR, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[GRADIENT]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let [density_i, density_j] = [pair.i(Field::DENSITY), pair.j(Field::DENSITY)];
        let [v_i, v_j] = [
            pair.i(Field::MASS) / density_i,
            pair.j(Field::MASS) / density_j,
        ];
        // ±1 between the two liquids, zero within one and towards what has no colour.
        let [colour_i, colour_j] = [pair.i(COLOUR), pair.j(COLOUR)];
        let across = (colour_i - colour_j) * colour_i * colour_j * L::of(0.5);
        let share = density_i / ((density_i + density_j) * v_i * pair.lattice_consistency_factor);
        let factor = (v_i * v_i + v_j * v_j) * share * across * pair.f;
        for d in 0..D {
            sums.add_product_at(GRADIENT, d, factor, pair.r[d]);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "gradient of the colour".into(),
            equation: "∇cᵢ = Σⱼ (Vᵢ² + Vⱼ²)/(s Vᵢ) ρᵢ/(ρᵢ + ρⱼ) cᵢⱼ ∇W",
            source: "Adami, Hu & Adams 2010",
        }
    }
}

/// Writes normals and |∇c|.
#[derive(Clone, Copy, Debug)]
struct Normals;

impl<const D: usize> PointLaw<D> for Normals {
    const NAME: &'static str = "normals of the interface";
    const READS: Fields = Fields::NONE;
    const WRITES: Fields = Fields::of(&[NORMAL, STEEPNESS]);
    const SUMS: Outputs = Outputs::of(&[GRADIENT]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let gradient = at.sum_vector(GRADIENT);
        let (steepness, least) = (length(&gradient), L::of(LEAST / at.around.smoothing_length));
        let share = L::select(steepness.gt(least), L::one(), L::zero());
        at.set(STEEPNESS, share * steepness);
        for d in 0..D {
            at.set_at(NORMAL, d, share * gradient[d] / steepness.max(least));
        }
    }
}

/// Sums whose quotient is the curvature over D − 1.
#[derive(Clone, Copy, Debug)]
pub struct InterfaceCurvature;

impl<const D: usize> Term<D> for InterfaceCurvature {
    const NAME: &'static str = "meshfree::interface_curvature";
    const READS: Fields = Fields::of(&[NORMAL, STEEPNESS, Field::MASS, Field::DENSITY]);
    const WRITES: Outputs = Outputs::of(&[TURN, SPAN]);
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let volume = pair.j(Field::MASS) / pair.j(Field::DENSITY);
        let weight = volume * pair.j(STEEPNESS) * pair.f;
        let (mut along, mut turn, mut span) = (L::zero(), L::zero(), L::zero());
        for d in 0..D {
            along += pair.r[d] * pair.i_at(NORMAL, d);
        }
        for d in 0..D {
            // What is normal to i drops out of nⱼ − nᵢ.
            let tangent = pair.r[d] - pair.i_at(NORMAL, d) * along;
            turn += pair.j_at(NORMAL, d) * tangent;
            span += tangent * tangent;
        }
        sums.add_product(TURN, weight, turn);
        sums.add_product(SPAN, weight, span);
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "curvature of the interface".into(),
            equation: "κᵢ = (D − 1) Σⱼ Vⱼ |∇cⱼ| nⱼ·P∇W / Σⱼ Vⱼ |∇cⱼ| rᵢⱼ·P∇W",
            source: "Morris 2000; Adami, Hu & Adams 2010, in the tangent plane",
        }
    }
}

/// σ κ V ∇c.
#[derive(Clone, Copy, Debug)]
struct Force(f64);

impl<const D: usize> PointLaw<D> for Force {
    const NAME: &'static str = "surface tension";
    const READS: Fields = Fields::of(&[NORMAL, STEEPNESS, Field::MASS, Field::DENSITY]);
    const WRITES: Fields = Fields::of(&[Field::FORCE]);
    const ADDS: Fields = Fields::of(&[Field::FORCE]);
    const SUMS: Outputs = Outputs::of(&[TURN, SPAN]);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (span, steepness) = (at.sum(SPAN), at.get(STEEPNESS));
        let factor = L::of(self.0 * (D as f64 - 1.0));
        let curvature = at.sum(TURN) / span;
        let size = factor * curvature * steepness * at.get(Field::MASS) / at.get(Field::DENSITY);
        let curved = steepness.gt(L::zero()) & span.lt(L::zero());
        let size = L::select(curved, size, L::zero());
        for d in 0..D {
            at.add_at(Field::FORCE, d, size * at.get_at(NORMAL, d));
        }
    }
}

/// The time in which a capillary wave of the shortest length passes a particle at the interface.
#[derive(Clone, Copy, Debug)]
struct CapillaryWaves(f64);

impl<const D: usize> PointLimit<D> for CapillaryWaves {
    const NAME: &'static str = "capillary waves: 0.25 sqrt(ρ h³/(2π σ))";
    const READS: Fields = Fields::of(&[STEEPNESS, Field::DENSITY]);
    #[inline(always)]
    fn step<L: Lane, P: Reach>(&self, at: &Point<'_, L, D, P>) -> L {
        let inertia = at.get(Field::DENSITY) * L::of(at.around.smoothing_length.powi(3));
        let step = L::of(0.25) * (inertia / L::of(core::f64::consts::TAU * self.0)).sqrt();
        L::select(at.get(STEEPNESS).gt(L::zero()), step, L::of(f64::INFINITY))
    }
}
