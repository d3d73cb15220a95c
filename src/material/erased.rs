//! Equations of state without their types: what a material holds, and how rows of particles are evaluated by it.
//! The loop over particles is compiled for the law behind it.

use super::cold;
use super::eos::{EosState, EquationOfState, GuardCounts};
use crate::scalar::{Lane, Real};
use core::fmt::Debug;
use std::sync::Arc;

/// An equation of state whose type is erased: what a [`Material`](super::Material) holds.
///
/// Sealed; [`Material::new`](super::Material::new) makes one from any [`EquationOfState`].
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
    /// Least pressure \[Pa\] of a material with a [cut-off](super::Material::with_pressure_cut_off).
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
    /// Energy over mass \[J/kg\] that is stored at a density \[kg/m³\] and internal energy \[J/kg\], a pressure cut-off
    /// counted; `None` where it is no function of these. See [`EquationOfState::stored_energy`].
    ///
    /// ```
    /// use meshfree::material::{Material, catalogue, eos::Linear};
    /// let water = Material::<f64>::new("water", Linear::new(1000.0, 20.0));
    /// // ½ c₀² ε² for small strains.
    /// let stored = water.eos().stored_energy(1001.0, 0.0);
    /// assert!(stored.is_some_and(|energy| (energy / 2e-4 - 1.0).abs() < 2e-3));
    /// assert_eq!(catalogue::copper::<f64>().eos().stored_energy(9000.0, 0.0), None);
    /// ```
    fn stored_energy(&self, density: f64, energy: f64) -> Option<f64>;
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
    /// The law with its cut-off, recorded for a device: pressure \[Pa\] and sound speed \[m/s\] of a density \[kg/m³\] and an energy
    /// \[J/kg\], and one where each of the guards acts, in the order of [`GuardCounts`].
    ///
    /// # Errors
    /// If the law does what cannot be recorded.
    #[cfg(feature = "devices")]
    fn record(&self) -> Result<crate::scalar::Record, crate::scalar::Unrecordable>;
}

mod sealed {
    pub trait Sealed {}
    impl<E> Sealed for super::Erased<E> {}
}

/// The law behind an [`EosObject`]; a type of its own keeps the two traits' methods apart.
#[derive(Debug)]
pub(super) struct Erased<E> {
    pub law: E,
    /// Kept beside the law rather than around it, so that a cut-off can be set on any material.
    pub cut_off: Option<f64>,
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
    fn stored_energy(&self, density: f64, energy: f64) -> Option<f64> {
        let rest = self.law.reference_density();
        let law = |rho: f64| {
            let state = self.law.state(rho, energy);
            (state.pressure, state.sound_speed)
        };
        let of = |density: f64| {
            let own = self.law.stored_energy(density, energy);
            let sum = || cold::compression_energy(law, rest, density);
            own.or_else(|| (!self.law.uses_energy()).then(sum))
        };
        // Beyond the cut-off the pressure is constant, so only work against it is stored.
        let cut = self
            .cut_off
            .filter(|least| !self.law.uses_energy() && density < rest && law(density).0 < *least);
        let Some(least) = cut else {
            return of(density);
        };
        let begins = cold::density_at(law, rest, least)?;
        Some(of(begins)? + least * (1.0 / begins - 1.0 / density))
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
    #[cfg(feature = "devices")]
    fn record(&self) -> Result<crate::scalar::Record, crate::scalar::Unrecordable> {
        use crate::scalar::{Record, Traced};
        Record::of(2, |given| {
            let state = self.cut_state(given[0], given[1]);
            let guards = state.guards;
            let acts = |mask| Lane::select(mask, Traced::of(1.0), Traced::of(0.0));
            let acted = [guards.compression, guards.expansion, guards.cut_off].map(acts);
            [&[state.pressure, state.sound_speed][..], &acted].concat()
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::material::eos::{Linear, MieGruneisen, TensionCutOff};

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
        let water = water.with_eos(Linear::new(1000.0, 20.0));
        assert_eq!(water.state(500.0, 0.0), (-101e3, 20.0));
        let water = water.with_pressure_cut_off(-1e3);
        assert_eq!(water.state(500.0, 0.0), (-1e3, 20.0));
    }

    /// Guards on the way must not turn an undefined pressure into a valid one.
    #[test]
    fn an_undefined_pressure_is_not_cut() {
        let law = Linear::new(1000.0, 20.0);
        let water = Material::<f64>::new("water", law).with_pressure_cut_off(0.0);
        assert!(water.state(f64::NAN, 0.0).0.is_nan());
        let wrapped = Material::<f64>::new("water", TensionCutOff::new(law, 0.0));
        assert!(wrapped.state(f64::NAN, 0.0).0.is_nan());
    }
}
