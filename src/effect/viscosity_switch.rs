//! Coefficients of artificial viscosity that follow the flow, once a step.
//! The law is the viscosity's own (Morris & Monaghan 1997, Cullen & Dehnen 2010); here are the sums that it sees.

use super::access::Summed;
use super::{Chunk, DensityForm, Law, Rung, Tally};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::Real;
use crate::term::viscosity::{ArtificialViscosity, Surroundings, Switch};

/// The switch of a viscosity.
#[derive(Debug)]
pub(crate) struct ViscositySwitch<T> {
    pub switch: Box<dyn Switch<T>>,
    /// What it reads and particles must have: of the flow before, and of gradients.
    needs: Fields,
    /// Sums that the viscosity adds to for it.
    sums: Outputs,
    /// The form whose weights the rates have.
    form: DensityForm,
    /// Support of the kernel in units of h.
    support: f64,
}

impl<T: Real> ViscositySwitch<T> {
    /// That of a viscosity, if it has one, where rates have the weights of a form and the kernel a support in units of h.
    pub fn of<V: ArtificialViscosity<D>, const D: usize>(
        viscosity: &V,
        form: DensityForm,
        support: f64,
    ) -> Option<Self> {
        let switch = viscosity.switch::<T>()?;
        let mut needs = switch.keeps();
        if viscosity.needs_velocity_gradient() {
            needs = needs.union(Fields::of(&[Field::VELOCITY_GRADIENT]));
        }
        Some(Self {
            switch,
            needs,
            sums: V::WRITES,
            form,
            support,
        })
    }
}

/// What only some switches and some schemes have.
const WHERE_CARRIED: Fields = Fields::of(&[
    Field::DIVERGENCE,
    Field::REFERENCE_DENSITY,
    Field::CONSISTENCY_FACTOR,
    Field::SMOOTHING_LENGTH,
    Field::VELOCITY_GRADIENT,
]);

/// Sums by which a switch tells a shock from shear and noise.
const LIMITER: [Output; 3] = [Output::DIVERGENCE_SIGN, Output::UNITY, Output::SIGNAL_SPEED];

impl<T: Real, const D: usize> Law<T, D> for ViscositySwitch<T> {
    fn name(&self) -> &'static str {
        "coefficients of viscosity"
    }
    fn reads(&self) -> Fields {
        Fields::of(&[
            Field::VISCOSITY_COEFFICIENT,
            Field::DENSITY,
            Field::SOUND_SPEED,
        ])
        .union(WHERE_CARRIED)
    }
    fn sums(&self) -> Outputs {
        self.sums.union(Outputs::of(&[Output::COMPRESSION]))
    }
    fn writes(&self) -> Fields {
        Fields::of(&[Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE])
    }
    fn optional(&self) -> Fields {
        WHERE_CARRIED.minus(self.needs)
    }
    fn rung(&self) -> Option<Rung> {
        Some(Rung::Trial)
    }
    fn apply(&self, chunk: &mut Chunk<'_, T, D>) -> Tally {
        // Coefficients follow the flow once a step, however many evaluations it takes.
        if chunk.around.dt <= 0.0 {
            return Tally::default();
        }
        let compression = chunk.sum(Output::COMPRESSION);
        let summed = Law::<T, D>::sums(self);
        let [signs, unities, signals] =
            LIMITER.map(|sum| summed.contains(sum).then(|| chunk.sum(sum)));
        let reach = T::from_f64(self.support);
        let uniform = T::from_f64(chunk.around.smoothing_length);
        let dt = T::from_f64(chunk.around.dt);
        let ([density, rest, moment, h, sound_speed, gradient], [alpha, divergence]) = chunk
            .columns(
                [
                    Field::DENSITY,
                    Field::REFERENCE_DENSITY,
                    Field::CONSISTENCY_FACTOR,
                    Field::SMOOTHING_LENGTH,
                    Field::SOUND_SPEED,
                    Field::VELOCITY_GRADIENT,
                ],
                [Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE],
            );
        let at = |column: &[T], n: usize, absent: T| column.get(n).copied().unwrap_or(absent);
        let sum_of = |sum: Option<Summed<'_, T, D>>, n| sum.map_or(T::zero(), |sum| sum.get(0, n));
        for (n, alpha) in alpha.iter_mut().enumerate() {
            let sum = compression.get(0, n);
            let (rest, moment) = (at(rest, n, T::one()), at(moment, n, T::one()));
            let h = at(h, n, uniform);
            let unity = sum_of(unities, n);
            let around = Surroundings {
                divergence: -self.form.compression(sum, density[n], rest, moment),
                divergence_before: at(divergence, n, T::zero()),
                divergence_sign: if unity > T::zero() {
                    sum_of(signs, n) / unity
                } else {
                    T::zero()
                },
                shear2: shear2::<T, D>(gradient.get(n * D * D..(n + 1) * D * D)),
                sound_speed: sound_speed[n],
                signal_speed: sum_of(signals, n).max(sound_speed[n]),
                h,
                support: reach * h,
            };
            *alpha = self.switch.next(*alpha, &around, dt);
            if let Some(divergence) = divergence.get_mut(n) {
                *divergence = around.divergence;
            }
        }
        Tally::default()
    }
}

/// tr S Sᵀ of the traceless symmetric part of a velocity gradient; zero in one dimension.
fn shear2<T: Real, const D: usize>(gradient: Option<&[T]>) -> T {
    let Some(gradient) = gradient.filter(|_| D > 1) else {
        return T::zero();
    };
    let half = T::from_f64(0.5);
    let mean = (0..D).fold(T::zero(), |sum, a| sum + gradient[a * D + a]) / T::from_f64(D as f64);
    let mut sum = T::zero();
    for a in 0..D {
        for b in 0..D {
            let mut s = (gradient[a * D + b] + gradient[b * D + a]) * half;
            if a == b {
                s -= mean;
            }
            sum += s * s;
        }
    }
    sum
}
