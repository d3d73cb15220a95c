//! Exchange of mass, momentum and energy between particles that do not move with the flow.
//! Oger, Marrone, Le Touzé & de Leffe 2016; Antuono, Sun, Marrone & Colagrossi 2021.

use super::consistent_shifting::SHIFT;
use super::{DensityForm, Point, PointLaw, Reach, Rung, SceneFacts, Setting};
use crate::error::Problem;
use crate::name;
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::term::{Layout, Pair, Sums, Term, TermDoc};

/// Rate of mass Σⱼ Fᵢⱼ \[kg/s\].
const MASS: Output = Output::scalar(name!("mass_exchange", "kg/s"));
/// Momentum over that of the mass itself, Σⱼ ½ Fᵢⱼ (uⱼ − uᵢ) \[N\].
const MOMENTUM: Output = Output::vector(name!("momentum_exchange", "N"));
/// Internal energy over that of the mass itself, Σⱼ ½ Fᵢⱼ (eⱼ − eᵢ) \[W\].
const ENERGY: Output = Output::scalar(name!("energy_exchange", "W"));

/// Rate of density \[kg/(m³ s)\] by δu: what it brings, and the volume that it compresses.
pub(super) const RATE: Output = Output::scalar(name!("density_rate_of_exchange", "kg/(m³ s)"));

/// Fields, and the energy where heat is exchanged.
const fn with_heat(fields: &[Field], heat: bool) -> Fields {
    let all = Fields::of(fields);
    if heat {
        all.union(Fields::of(&[Field::ENERGY]))
    } else {
        all
    }
}

/// What a pair exchanges, as particles move with u + δu: Fᵢⱼ = Vᵢ Vⱼ (ρᵢ δuᵢ + ρⱼ δuⱼ)·∇ᵢW/s of mass, which carries the mean velocity and
/// energy of the two. At rest (`STILL`) δu is −u. Nothing passes through walls.
#[derive(Clone, Copy, Debug)]
pub struct Exchange<const STILL: bool, const HEAT: bool>;

impl<const D: usize, const STILL: bool, const HEAT: bool> Term<D> for Exchange<STILL, HEAT> {
    const NAME: &'static str = "meshfree::exchange_of_mass";
    const READS: Fields = {
        let all = with_heat(&[Field::WEIGHT, Field::DENSITY, Field::VELOCITY], HEAT);
        if STILL {
            all
        } else {
            all.union(Fields::of(&[SHIFT]))
        }
    };
    const WRITES: Outputs = {
        let all = <Exchanged<STILL, HEAT> as PointLaw<D>>::SUMS;
        if STILL {
            all
        } else {
            all.union(Outputs::of(&[RATE]))
        }
    };
    #[inline(always)]
    fn pair<L: Lane, P: Layout>(&self, pair: &Pair<'_, L, D, P>, sums: &mut Sums<L, D, P>) {
        let (mut own, mut other) = (L::zero(), L::zero());
        for d in 0..D {
            let [a, b] = if STILL {
                [
                    -pair.i_at(Field::VELOCITY, d),
                    -pair.j_at(Field::VELOCITY, d),
                ]
            } else {
                [pair.i_at(SHIFT, d), pair.j_at(SHIFT, d)]
            };
            own = a.mul_add(pair.r[d], own);
            other = b.mul_add(pair.r[d], other);
        }
        let (density, others) = (pair.i(Field::DENSITY), pair.j(Field::DENSITY));
        let flux = pair.mobile * pair.mobile_i * (density * own + others * other);
        let volume = pair.j(Field::WEIGHT) * pair.f / pair.lattice_consistency_factor;
        if !STILL {
            sums.add_product(RATE, volume, flux + density * (own - other));
        }
        let mass = pair.i(Field::WEIGHT) * volume * flux;
        sums.add(MASS, mass);
        let half = L::of(-0.5) * mass;
        for d in 0..D {
            sums.add_product_at(MOMENTUM, d, half, pair.v[d]);
        }
        if HEAT {
            let jump = pair.i(Field::ENERGY) - pair.j(Field::ENERGY);
            sums.add_product(ENERGY, half, jump);
        }
    }
    fn document(&self) -> TermDoc {
        TermDoc {
            name: "exchange of mass".into(),
            equation: "dmᵢ/dt = Σⱼ Fᵢⱼ, d(m u)ᵢ/dt += Σⱼ Fᵢⱼ (uᵢ + uⱼ)/2, Fᵢⱼ = Vᵢ Vⱼ (ρᵢ δuᵢ + ρⱼ δuⱼ)·∇W/s",
            source: "Oger et al. 2016; Antuono et al. 2021",
        }
    }
}

/// Gives each particle what the others have passed to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exchanged<const STILL: bool, const HEAT: bool>;

impl<const D: usize, const STILL: bool, const HEAT: bool> PointLaw<D> for Exchanged<STILL, HEAT> {
    const NAME: &'static str = "exchange of mass";
    const READS: Fields = {
        let adds = <Self as PointLaw<D>>::ADDS;
        if STILL {
            adds.union(Fields::of(&[Field::WEIGHT]))
        } else {
            adds
        }
    };
    const WRITES: Fields = {
        let adds = <Self as PointLaw<D>>::ADDS;
        if STILL {
            adds.union(Fields::of(&[Field::DENSITY]))
        } else {
            adds
        }
    };
    const ADDS: Fields = with_heat(&[Field::MASS, Field::VELOCITY], HEAT);
    const SUMS: Outputs = {
        let all = Outputs::of(&[MASS, MOMENTUM]);
        if HEAT {
            all.union(Outputs::of(&[ENERGY]))
        } else {
            all
        }
    };
    const RUNG: Option<Rung> = Some(Rung::Flow);
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let mass = at.get(Field::MASS) + at.dt() * at.sum(MASS);
        let (step, mut square) = (at.dt() / mass, L::zero());
        for d in 0..D {
            let gained = step * at.sum_at(MOMENTUM, d);
            square += gained * gained;
            at.add_at(Field::VELOCITY, d, gained);
        }
        if HEAT {
            // A flux of the mean velocity keeps kinetic energy; what a step of finite size adds to it comes out of the heat.
            let gained = step * at.sum(ENERGY) - L::of(0.5) * square;
            at.add_at(Field::ENERGY, 0, gained);
        }
        if STILL {
            // Volumes stay.
            at.set(Field::DENSITY, mass / at.get(Field::WEIGHT));
        }
        at.add_at(Field::MASS, 0, at.dt() * at.sum(MASS));
    }
}

/// Why a scene cannot have a form that exchanges mass.
pub(super) fn problem<T: Real, const HEAT: bool>(
    name: &str,
    setting: &Setting,
    scene: &SceneFacts<'_, T>,
) -> Option<Problem> {
    let refuse = |what: String, remedy| Some(Problem::Incompatible { what, remedy });
    if setting.density != DensityForm::Continuity {
        return refuse(
            format!(
                "{name} exchanges mass in the middle of a drift, by sums over volumes that this scheme does not make there"
            ),
            "take DensityForm::Continuity, or leave it out",
        );
    }
    if HEAT != scene.integrated.contains(Field::ENERGY) {
        return refuse(
            format!(
                "{name}::<{HEAT}> exchanges internal energy where the scheme carries none, or leaves out what it carries"
            ),
            "say `::<true>` with a scheme that keeps energy, and `::<false>` with one that does not",
        );
    }
    let mut bodies = scene.bodies.iter();
    let first = bodies.next()?.1;
    let all = format!("{first:?}");
    let (_, other) = bodies.find(|(_, own)| format!("{own:?}") != all)?;
    let (first, other) = (&first.name, &other.name);
    refuse(
        format!("{name} lets mass pass between bodies of {first} and of {other}"),
        "give the bodies of one scheme one material, or leave it out",
    )
}
