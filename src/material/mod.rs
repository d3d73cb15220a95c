//! Materials: equations of state, viscosity laws and the catalogue of named materials.
//! A material is evaluated once per particle and step, never inside the pair loop.
//!
//! A [`Material`] is a name, a source, an equation of state and what else is known of it. The
//! law's type is erased, so one scene holds copper, water and air; each block of particles is still
//! evaluated by code compiled for its law.
//!
//! Materials of the [`catalogue`] carry the source of their constants, and can be had
//! [by name](catalogue::by_name). Where a law leaves the range in which it is valid a guard steps in, and
//! every such evaluation is counted ([`GuardCounts`]).
//!
//! A [`Liquid`] becomes a material at its physical [`SoundSpeed`] or at an artificial one, which costs
//! fewer steps; [`rheology`] holds viscosities that follow from the shear rate.
//!
//! [`strength`] holds the yield stresses of solids. Shear and strength act under schemes with the effects
//! [`Hypoelastic`](crate::effect::Hypoelastic) and [`Plasticity`](crate::effect::Plasticity); without them a solid is
//! a fluid with its equation of state. [`failure`] holds what ends them, under [`Damage`](crate::effect::Damage).
//!
//! ```
//! use meshfree::material::{Material, catalogue, eos::{MieGruneisen, TensionCutOff}};
//! let copper: Material<f64> = catalogue::copper();
//! let (p, c) = copper.state(8930.0 * 1.0025, 0.0);
//! assert!((p / 348e6 - 1.0).abs() < 0.01 && c > 3940.0);
//!
//! // Another law, or a material of one's own.
//! let spalling = copper.with_eos(TensionCutOff::new(
//!     MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02), -1.2e9));
//! assert_eq!(spalling.state(8000.0, 0.0).0, -1.2e9);
//! ```

pub mod catalogue;
mod cold;
pub mod eos;
pub mod failure;
mod liquid;
pub mod rheology;
mod solid;
pub mod strength;

pub use liquid::{Liquid, SoundSpeed};

use crate::scalar::{Lane, Real};
use core::fmt::Debug;
use eos::{EosState, EquationOfState, GuardCounts};
use failure::Failure;
use rheology::{RheologyObject, ViscosityLaw};
use std::sync::Arc;
use strength::{PlasticHeating, Strength};

/// Whether a constant of a material, in SI units, is not negative and so small that its products are numbers.
fn is_size(value: f64) -> bool {
    (0.0..1e100).contains(&value)
}

/// An equation of state whose type is erased: what a [`Material`] holds.
///
/// Sealed; [`Material::new`] makes one from any [`EquationOfState`].
pub trait EosObject<T: Real>: sealed::Sealed + Debug + Send + Sync + 'static {
    /// The law's name.
    fn name(&self) -> &'static str;
    /// Density ρ₀ \[kg/m³\] at zero pressure and energy; for a gas the density it starts with.
    fn reference_density(&self) -> f64;
    /// Whether the pressure depends on internal energy.
    fn uses_energy(&self) -> bool;
    /// What is wrong with the parameters, as `(field, value, what it must be)`.
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)>;
    /// Pressure \[Pa\] and sound speed \[m/s\] at one density \[kg/m³\] and energy \[J/kg\].
    fn state(&self, density: f64, energy: f64) -> (f64, f64);
    /// Least pressure \[Pa\] of a material with a [cut-off](Material::with_pressure_cut_off).
    fn pressure_cut_off(&self) -> Option<f64>;
    /// The same law with that least pressure \[Pa\] in place of the one it has.
    fn cut_at(&self, pressure: f64) -> Arc<dyn EosObject<T>>;
    /// Density \[kg/m³\] at a pressure \[Pa\] and energy \[J/kg\], to rounding: what a hydrostatic
    /// column starts with. `None` if the law does not reach that pressure: below its cut-off, or a
    /// gas without energy. Where a law has one pressure at several densities, one of them, on that
    /// side of ρ₀ where the pressure lies.
    ///
    /// ```
    /// use meshfree::material::{Material, eos::Linear};
    /// let water = Material::<f64>::new("water", Linear::new(1000.0, 20.0));
    /// // A metre below the surface.
    /// let density = water.eos().density_at(9810.0, 0.0);
    /// assert!(density.is_some_and(|rho| (rho - 1024.525).abs() < 1e-9));
    /// ```
    fn density_at(&self, pressure: f64, energy: f64) -> Option<f64>;
    /// Energy of compression a mass \[J/kg\], ∫ p(ρ′, 0)/ρ′² dρ′ from ρ₀ to ρ \[kg/m³\]: what a
    /// liquid without an energy of its own stores like a spring. For a law with energy it is the part
    /// of the cold curve alone. The relative error is 10⁻¹², 10⁻⁹ across a kink of the law.
    fn compression_energy(&self, density: f64) -> f64 {
        let law = |rho: f64| self.state(rho, 0.0);
        cold::compression_energy(law, self.reference_density(), density)
    }
    /// Pressures \[Pa\] and sound speeds \[m/s\] of a row of particles from densities \[kg/m³\] and
    /// specific internal energies \[J/kg\] (zero where absent), and how often guards acted. As many
    /// particles as the shortest slice has; nothing is allocated.
    fn evaluate(
        &self,
        density: &[T],
        energy: Option<&[T]>,
        pressure: &mut [T],
        sound_speed: &mut [T],
    ) -> GuardCounts;
}

mod sealed {
    pub trait Sealed {}
    impl<E> Sealed for super::Erased<E> {}
}

/// The law behind an [`EosObject`]; a type of its own keeps the two traits' methods apart.
#[derive(Debug)]
struct Erased<E> {
    law: E,
    /// Kept beside the law rather than around it, so that a cut-off can be set on any material.
    cut_off: Option<f64>,
}

impl<E: EquationOfState> Erased<E> {
    /// The law's state with the cut-off, which leaves its sound speed alone.
    #[inline(always)]
    fn cut_state<L: Lane>(&self, density: L, energy: L) -> EosState<L> {
        let mut state = self.law.state(density, energy);
        if let Some(least) = self.cut_off {
            let least = L::of(least);
            let below = state.pressure.lt(least);
            state.guards.cut_off = state.guards.cut_off | below;
            state.pressure = L::select(below, least, state.pressure);
        }
        state
    }
}

impl<T: Real, E: EquationOfState> EosObject<T> for Erased<E> {
    fn name(&self) -> &'static str {
        self.law.name()
    }
    fn reference_density(&self) -> f64 {
        self.law.reference_density()
    }
    fn uses_energy(&self) -> bool {
        self.law.uses_energy()
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.law.problems();
        let wrong = |least: &f64| !(least.is_finite() && *least <= 0.0);
        if let Some(least) = self.cut_off.filter(wrong) {
            problems.push(("pressure_cut_off", least, "zero or negative, and finite"));
        }
        problems
    }
    fn state(&self, density: f64, energy: f64) -> (f64, f64) {
        let state = self.cut_state(density, energy);
        (state.pressure, state.sound_speed)
    }
    fn pressure_cut_off(&self) -> Option<f64> {
        self.cut_off
    }
    fn cut_at(&self, pressure: f64) -> Arc<dyn EosObject<T>> {
        Arc::new(Self {
            law: self.law.clone(),
            cut_off: Some(pressure),
        })
    }
    fn density_at(&self, pressure: f64, energy: f64) -> Option<f64> {
        // Without the cut-off: at the cut itself it is the density at which cutting begins.
        let law = |rho: f64| {
            let state = self.law.state(rho, energy);
            (state.pressure, state.sound_speed)
        };
        let within = self.cut_off.is_none_or(|least| pressure >= least);
        within
            .then(|| cold::density_at(law, self.law.reference_density(), pressure))
            .flatten()
    }
    fn evaluate(
        &self,
        density: &[T],
        energy: Option<&[T]>,
        pressure: &mut [T],
        sound_speed: &mut [T],
    ) -> GuardCounts {
        let mut count = density.len().min(pressure.len()).min(sound_speed.len());
        count = energy.map_or(count, |energy| count.min(energy.len()));
        let width = <T::Wide<false> as Lane>::WIDTH;
        let blocks = count - count % width;
        let mut counts =
            rows::<T, T::Wide<false>, E>(self, 0..blocks, density, energy, pressure, sound_speed);
        counts += rows::<T, T, E>(self, blocks..count, density, energy, pressure, sound_speed);
        counts
    }
}

/// Evaluates the law on a range of particles, one row of lanes after another.
fn rows<T: Real, L: Lane<Scalar = T>, E: EquationOfState>(
    law: &Erased<E>,
    range: core::ops::Range<usize>,
    density: &[T],
    energy: Option<&[T]>,
    pressure: &mut [T],
    sound_speed: &mut [T],
) -> GuardCounts {
    let mut counts = GuardCounts::default();
    for start in range.step_by(L::WIDTH) {
        let row = start..start + L::WIDTH;
        let rho = &density[row.clone()];
        let e = energy.map(|energy| &energy[row.clone()]);
        let state = law.cut_state(
            L::from_fn(|k| rho[k]),
            e.map_or(L::zero(), |e| L::from_fn(|k| e[k])),
        );
        counts.record(&state.guards);
        for (k, p) in pressure[row.clone()].iter_mut().enumerate() {
            *p = state.pressure.extract(k);
        }
        for (k, c) in sound_speed[row].iter_mut().enumerate() {
            *c = state.sound_speed.extract(k);
        }
    }
    counts
}

/// A material: an equation of state, its name and source, and constants that models may ask for.
/// Cloning is cheap: clones share the law.
#[derive(Clone, Debug)]
pub struct Material<T: Real> {
    /// The name in reports.
    pub name: String,
    /// Where the constants come from.
    pub source: String,
    /// Yield stress Y₀ \[Pa\] in simple tension, if known; a [law of strength](Self::with_strength) goes before it.
    pub yield_stress: Option<f64>,
    /// Shear modulus G \[Pa\], if known.
    pub shear_modulus: Option<f64>,
    /// Dynamic viscosity μ \[Pa s\], if known; a [rheology](Self::with_rheology) goes before it.
    pub dynamic_viscosity: Option<f64>,
    rheology: Option<Arc<dyn RheologyObject<T>>>,
    strength: Option<Arc<dyn Strength>>,
    plastic_heating: Option<PlasticHeating>,
    failure: Option<Arc<dyn Failure>>,
    sound_speed: SoundSpeed,
    eos: Arc<dyn EosObject<T>>,
}

impl<T: Real> Material<T> {
    /// A name and an equation of state; the other constants are unknown until set.
    #[must_use]
    pub fn new(name: impl Into<String>, eos: impl EquationOfState) -> Self {
        Self {
            name: name.into(),
            source: String::new(),
            yield_stress: None,
            shear_modulus: None,
            dynamic_viscosity: None,
            rheology: None,
            strength: None,
            plastic_heating: None,
            failure: None,
            sound_speed: SoundSpeed::Physical,
            eos: Arc::new(Erased {
                law: eos,
                cut_off: None,
            }),
        }
    }

    /// The same material with another equation of state; a pressure cut-off stays.
    #[must_use]
    pub fn with_eos(mut self, eos: impl EquationOfState) -> Self {
        self.eos = Arc::new(Erased {
            law: eos,
            cut_off: self.eos.pressure_cut_off(),
        });
        self.sound_speed = SoundSpeed::Physical;
        self
    }
    /// A least pressure \[Pa\], zero or negative: p = max(p_law, p_min), each cut counted under
    /// [`cut_off`](GuardCounts::cut_off). A liquid with a free surface takes 0, one that cavitates
    /// about −101 kPa (absolute zero below the atmosphere), degassed water down to −1 MPa.
    /// [`TensionCutOff`](eos::TensionCutOff) is the same as a law.
    ///
    /// ```
    /// use meshfree::material::{Material, catalogue};
    /// let water: Material<f64> = catalogue::water().with_pressure_cut_off(0.0);
    /// assert_eq!(water.state(990.0, 0.0).0, 0.0);
    /// assert!(water.state(1001.0, 0.0).0 > 2e6);
    /// ```
    #[must_use]
    pub fn with_pressure_cut_off(mut self, pressure: f64) -> Self {
        self.eos = self.eos.cut_at(pressure);
        self
    }
    /// Where the constants come from.
    #[must_use]
    pub fn with_source(mut self, source: impl Into<String>) -> Self {
        self.source = source.into();
        self
    }
    /// A constant dynamic viscosity μ \[Pa s\], in place of any [rheology](Self::with_rheology).
    #[must_use]
    pub fn with_dynamic_viscosity(mut self, dynamic_viscosity: f64) -> Self {
        self.dynamic_viscosity = Some(dynamic_viscosity);
        self.rheology = None;
        self
    }
    /// A viscosity that follows from the shear rate, in place of a constant one.
    #[must_use]
    pub fn with_rheology(mut self, law: impl ViscosityLaw) -> Self {
        self.dynamic_viscosity = None;
        self.rheology = Some(Arc::new(rheology::Erased(law)));
        self
    }

    /// The equation of state.
    #[must_use]
    pub fn eos(&self) -> &dyn EosObject<T> {
        &*self.eos
    }
    /// The viscosity law: the [one given](Self::with_rheology), or the Newtonian of the constant
    /// [`dynamic_viscosity`](Self::dynamic_viscosity); `None` for what has no viscosity.
    #[must_use]
    pub fn rheology(&self) -> Option<&dyn RheologyObject<T>> {
        let constant = self.dynamic_viscosity.as_ref();
        self.rheology
            .as_deref()
            .or(constant.map(|viscosity| viscosity as &dyn RheologyObject<T>))
    }
    /// How the sound speed of a [`Liquid`] was chosen; [`Physical`](SoundSpeed::Physical) for all else.
    #[must_use]
    pub const fn sound_speed(&self) -> SoundSpeed {
        self.sound_speed
    }
    /// Density ρ₀ \[kg/m³\] of the law at rest.
    #[must_use]
    pub fn reference_density(&self) -> f64 {
        self.eos.reference_density()
    }
    /// Whether the pressure depends on internal energy.
    #[must_use]
    pub fn uses_energy(&self) -> bool {
        self.eos.uses_energy()
    }
    /// Pressure \[Pa\] and sound speed \[m/s\] at one density \[kg/m³\] and energy \[J/kg\].
    #[must_use]
    pub fn state(&self, density: f64, energy: f64) -> (f64, f64) {
        self.eos.state(density, energy)
    }
    /// Whether pressure follows from energy alone, so that twice the cold density has no more than a few times the
    /// pressure: the density of a gas at rest is only what it starts with, and its energy is never negative.
    pub(crate) fn is_gas(&self) -> bool {
        let rest = self.reference_density();
        let [once, twice] = [rest, 2.0 * rest].map(|density| self.state(density, 0.0).0);
        twice.abs() <= 4.0 * once.abs()
    }
    /// Acoustic impedance ρ₀ c \[kg/(m² s)\] at rest.
    #[must_use]
    pub fn impedance(&self) -> f64 {
        let density = self.reference_density();
        density * self.state(density, 0.0).1
    }
    /// Bulk modulus K = ρ₀ c² \[Pa\] at rest.
    #[must_use]
    pub fn bulk_modulus(&self) -> f64 {
        let density = self.reference_density();
        density * self.state(density, 0.0).1.powi(2)
    }
    /// Constants that are numbers, and whose products are none: what a law makes of them must be finite.
    fn problems_of_size(&self) -> Vec<(&'static str, f64, &'static str)> {
        let rest = self.reference_density();
        let far = self.state(1.1 * rest, self.state(rest, 0.0).1.powi(2));
        let all = [
            ("reference_density", rest),
            ("sound_speed", self.state(rest, 0.0).1),
            ("bulk_modulus", self.bulk_modulus()),
            ("pressure at 1.1 of the density", far.0.abs()),
            ("sound_speed at 1.1 of the density", far.1),
        ];
        let wrong = all.into_iter().filter(|own| !is_size(own.1));
        wrong
            .map(|(what, value)| (what, value, "finite and below 1e100 in SI units"))
            .collect()
    }
    /// What is wrong with the constants, as `(field, value, what it must be)`; empty if nothing.
    #[must_use]
    pub fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        let mut problems = self.eos.problems();
        if problems.is_empty() {
            problems.extend(self.problems_of_size());
        }
        let constants = [
            ("yield_stress", self.yield_stress),
            ("shear_modulus", self.shear_modulus),
            ("dynamic_viscosity", self.dynamic_viscosity),
        ];
        for (field, value) in constants {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value >= 0.0)) {
                let must_be = if field == "shear_modulus" {
                    "finite and not negative; of elastic constants: a positive modulus and a Poisson ratio above -1"
                } else {
                    "finite and not negative"
                };
                problems.push((field, value, must_be));
            }
        }
        if let Some(law) = &self.rheology {
            problems.extend(law.problems());
        }
        problems.extend(self.problems_of_solids());
        problems.extend(self.sound_speed.problems());
        problems
    }
}

#[cfg(test)]
mod tests {
    use super::eos::{MieGruneisen, TensionCutOff};
    use super::*;

    fn rows_equal_single_states<T: Real>() {
        let law = TensionCutOff::new(MieGruneisen::new(8930.0, 3940.0, 1.49, 2.02), -5e9);
        let material = Material::<T>::new("copper", law);
        let count = 3 * <T::Wide<false> as Lane>::WIDTH + 5;
        let density: Vec<T> = (0..count)
            .map(|k| T::from_f64(7000.0 + 90.0 * k as f64))
            .collect();
        let energy: Vec<T> = (0..count).map(|k| T::from_f64(10.0 * k as f64)).collect();
        let (mut p, mut c) = (vec![T::default(); count], vec![T::default(); count]);
        let counts = material
            .eos()
            .evaluate(&density, Some(&energy), &mut p, &mut c);
        let mut cuts = 0;
        for k in 0..count {
            let state = law.state(density[k], energy[k]);
            assert_eq!((p[k], c[k]), (state.pressure, state.sound_speed));
            cuts += u64::from(state.guards.cut_off);
        }
        assert!(cuts > 0 && counts.cut_off == cuts && counts.total() == cuts);

        let without = material.eos().evaluate(&density, None, &mut p, &mut c);
        assert_eq!(without.cut_off, cuts);
        assert_eq!(
            p[count - 1],
            law.state(density[count - 1], T::default()).pressure
        );
    }

    #[test]
    fn rows_equal_single_states_in_both_precisions() {
        rows_equal_single_states::<f32>();
        rows_equal_single_states::<f64>();
    }

    /// A cut-off set on the material and one around the law give the same bits and counts.
    fn cut_off_equals_the_wrapped_law<T: Real>(least: f64) {
        let law = MieGruneisen::new(1000.0, 1480.0, 1.92, 0.1);
        let set = Material::<T>::new("water", law).with_pressure_cut_off(least);
        let wrapped = Material::<T>::new("water", TensionCutOff::new(law, least));
        let count = <T::Wide<false> as Lane>::WIDTH + 3;
        let density: Vec<T> = (0..count)
            .map(|k| T::from_f64(999.8 + 0.03 * k as f64))
            .collect();
        let close = |material: &Material<T>| {
            let (mut p, mut c) = (vec![T::default(); count], vec![T::default(); count]);
            let counts = material.eos().evaluate(&density, None, &mut p, &mut c);
            (p, c, counts)
        };
        let (p, c, counts) = close(&set);
        assert_eq!((p.clone(), c, counts), close(&wrapped));
        let cut = p.iter().filter(|p| **p == T::from_f64(least)).count();
        assert!(cut > 0 && cut < count && counts.cut_off == cut as u64);
        assert!(p.iter().all(|p| *p >= T::from_f64(least)));
    }

    #[test]
    fn cut_offs_of_a_liquid() {
        for least in [0.0, -101e3] {
            cut_off_equals_the_wrapped_law::<f32>(least);
            cut_off_equals_the_wrapped_law::<f64>(least);
        }
        let law = MieGruneisen::new(1000.0, 1480.0, 1.92, 0.1);
        let water = Material::<f64>::new("water", law).with_pressure_cut_off(-101e3);
        assert_eq!(water.eos().density_at(-102e3, 0.0), None);
        let cut = water
            .eos()
            .density_at(-101e3, 0.0)
            .expect("the cut-off itself");
        assert!((cut - (1000.0 - 101e3 / 1480f64.powi(2))).abs() < 1e-3);
        // It stays with another law, and another one replaces it.
        let water = water.with_eos(super::eos::Linear::new(1000.0, 20.0));
        assert_eq!(water.state(500.0, 0.0), (-101e3, 20.0));
        let water = water.with_pressure_cut_off(-1e3);
        assert_eq!(water.state(500.0, 0.0), (-1e3, 20.0));
    }

    /// Guards on the way must not turn an undefined pressure into a valid one.
    #[test]
    fn an_undefined_pressure_is_not_cut() {
        let law = super::eos::Linear::new(1000.0, 20.0);
        let water = Material::<f64>::new("water", law).with_pressure_cut_off(0.0);
        assert!(water.state(f64::NAN, 0.0).0.is_nan());
        let wrapped = Material::<f64>::new("water", TensionCutOff::new(law, 0.0));
        assert!(wrapped.state(f64::NAN, 0.0).0.is_nan());
    }

    #[test]
    fn problems_are_named() {
        let law = TensionCutOff::new(MieGruneisen::new(-1.0, 3940.0, 1.49, 2.02), 5e9);
        let material = Material::<f64>::new("wrong", law).with_yield_stress(f64::NAN);
        let fields: Vec<_> = material
            .problems()
            .iter()
            .map(|problem| problem.0)
            .collect();
        assert_eq!(
            fields,
            ["reference_density", "minimum_pressure", "yield_stress"]
        );
        for wrong in [1.0, f64::NAN, f64::NEG_INFINITY] {
            let law = MieGruneisen::new(1000.0, 1480.0, 1.92, 0.1);
            let problems = Material::<f64>::new("water", law)
                .with_pressure_cut_off(wrong)
                .problems();
            assert!(problems.len() == 1 && problems[0].0 == "pressure_cut_off");
        }
    }
}
