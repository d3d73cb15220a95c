//! Liquid at its tension cut-off: densities that are held, with or without memory of the expansion.
//! Both are of this crate; the page on [sloshing](crate#pages) has their effect.

use super::{Around, CONSTANTS, Effect, Point, PointLaw, Reach, Rung, Setting, StepProgram};
use crate::error::Problem;
use crate::particles::{Field, Fields};
use crate::scalar::{Lane, Real};
use crate::term::{Stage, TermDoc};

/// Keeps a liquid that has cavitated at its [cut-off](crate::material::Material::with_pressure_cut_off) from
/// thinning out: spray is still water, and volumes m/ρ weigh its forces.
///
#[doc = include_str!("../../docs/equations/cavitation.html")]
///
/// It is held at nine tenths of the density ρ_t of the cut-off; with [`ExpansionMemory`] at ρ_t.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cavitation;

impl<const D: usize> Effect<D> for Cavitation {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.law(Stage::Bounds, *self);
    }
}

/// Lets liquid that has cavitated at its [cut-off](crate::material::Material::with_pressure_cut_off) close
/// where it opened. Below the density ρ_t of the cut-off continuity goes on in the expansion τ.
///
#[doc = include_str!("../../docs/equations/expansion_memory.html")]
///
/// Pairs see ρ_t meanwhile; pressure comes back with τ = 0.
///
/// ρ_t \[kg/m³\] is the density of the equation of state at the cut-off. With volumes that no longer grow,
/// dτ/dt is the rate of Σ V W, so a drop that has left a neighbourhood
/// meets the next one with what it lacked: −1 at most, where τ ends. It adds a number a particle and
/// no sum.
///
/// Without it cavitated liquid is held at nine tenths of ρ_t and forgets how far it had expanded: it has pressure
/// again before it has closed, and spray behaves like a gas. Single drops strike harder with it, so it is a
/// choice. It needs a material with a cut-off, and an integrator that kicks.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExpansionMemory;

impl<const D: usize> Effect<D> for ExpansionMemory {
    type Terms = ();
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) {}
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        program.carry(Field::EXPANSION);
        program.require(|scene| {
            let cuts_off = |(_, material): &(&str, &crate::material::Material<T>)| {
                material.eos().pressure_cut_off().is_some()
            };
            let bodies = &scene.bodies;
            (!bodies.is_empty() && !bodies.iter().any(cuts_off)).then(|| Problem::Incompatible {
                what: "the scheme remembers how far cavitated liquid has expanded, and none of its bodies can \
                       cavitate"
                    .into(),
                remedy: "give the material a cut-off (Material::with_pressure_cut_off), or leave out \
                         ExpansionMemory",
            })
        });
        program.require(|scene| {
            (!scene.kicks).then(|| Problem::Incompatible {
                what: format!(
                    "the integrator {} does not hold densities of cavitated liquid",
                    scene.integrator
                ),
                remedy: "take an integrator that kicks (kick-drift-kick), or leave out ExpansionMemory",
            })
        });
        program.document(TermDoc {
            name: "memory of expansion".into(),
            equation: "ρ = ρ_t while τ = ln(ρ/ρ_t) by continuity is below 0, τ ≥ −1",
            source: "of this crate",
        });
    }
}

/// Without rounding that is kept, and without memory, there is the density alone.
const CHANGED: [Field; 3] = [Field::DENSITY, Field::DENSITY_RESIDUAL, Field::EXPANSION];

impl<const D: usize> PointLaw<D> for Cavitation {
    const NAME: &'static str = "cavitation";
    const READS: Fields = Fields::of(&CHANGED);
    const WRITES: Fields = Fields::of(&CHANGED);
    const OPTIONAL: Fields = Fields::of(&CHANGED).without(Field::DENSITY);
    const RUNG: Option<Rung> = Some(Rung::Constraint);
    fn prepare<T: Real>(
        &self,
        around: &Around<'_, T, D>,
        constants: &mut [f64; CONSTANTS],
    ) -> bool {
        let eos = around.material.eos();
        let cut_off = eos.pressure_cut_off();
        let at_cut_off = cut_off.and_then(|pressure| eos.density_at(pressure, 0.0));
        let density = at_cut_off.unwrap_or(0.0);
        [constants[0], constants[1]] = [HELD * density, density];
        at_cut_off.is_some()
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let [tau, residual] = [Field::EXPANSION, Field::DENSITY_RESIDUAL].map(|own| at.get(own));
        let least = at.constant(usize::from(at.has(Field::EXPANSION)));
        let held = at.get(Field::DENSITY);
        let thin = tau.lt(L::zero());
        let density = if at.has(Field::EXPANSION) && L::somewhere(thin) {
            L::select(thin, held * tau.exp(), held)
        } else {
            held
        };
        // What is no number stays one, and ends the run.
        let low = density.lt(least);
        if at.has(Field::EXPANSION) {
            let mut tau = L::zero();
            if L::somewhere(low) {
                let thinned = (density / least).ln().max(L::of(FARTHEST));
                tau = L::select(low, thinned, tau);
            }
            at.set(Field::EXPANSION, tau);
        }
        let density = L::select(low, least, density);
        at.set(Field::DENSITY, density);
        at.limited(low);
        // What rounding has left belongs to the density that was.
        let is_least = density.le(least) & least.le(density);
        at.set(
            Field::DENSITY_RESIDUAL,
            L::select(is_least, L::zero(), residual),
        );
    }
}

/// Share of the density at the cut-off that a liquid keeps however far it expands. Spray otherwise
/// fell to a fifth of it, struck walls with five times its volume, and its diffusion made densities
/// negative; at nine tenths volumes are at most a ninth too large, and what was drawn apart a little
/// still closes without pressure.
const HELD: f64 = 0.9;

/// Farthest that cavitated liquid expands, as the logarithm of what its density would be: that of a particle
/// which has lost all of its neighbourhood, Σ V W = 1.
const FARTHEST: f64 = -1.0;
