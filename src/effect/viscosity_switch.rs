//! Coefficients of artificial viscosity that follow the flow, once a step.
//! The law is the viscosity's own (Morris & Monaghan 1997, Cullen & Dehnen 2010); here are the sums that it sees.

use super::{Around, CONSTANTS, DensityForm, Point, PointLaw, Reach, Rung};
use crate::particles::{Field, Fields, Output, Outputs};
use crate::scalar::{Lane, Real};
use crate::tensor::Square;
use crate::term::viscosity::{ArtificialViscosity, Surroundings, SwitchObject};

/// The switch of a viscosity.
#[derive(Debug)]
pub(crate) struct ViscositySwitch {
    pub switch: Box<dyn SwitchObject>,
    /// What it reads and particles must have: of the flow before, and of gradients.
    needs: Fields,
    /// Sums that it sees.
    sums: Outputs,
    /// The form whose weights the rates have.
    form: DensityForm,
    /// Support of the kernel in units of h.
    support: f64,
}

impl ViscositySwitch {
    /// That of a viscosity, if it has one, where rates have the weights of a form and the kernel a support in units of h.
    pub fn of<V: ArtificialViscosity<D>, const D: usize>(
        viscosity: &V,
        form: DensityForm,
        support: f64,
    ) -> Option<Self> {
        let switch = viscosity.switch()?;
        let mut needs = switch.keeps();
        if viscosity.needs_velocity_gradient() {
            needs = needs.union(Fields::of(&[Field::VELOCITY_GRADIENT]));
        }
        let unseen = V::WRITES.minus(LIMITER);
        Some(Self {
            switch,
            needs,
            sums: V::WRITES.minus(unseen).union(COMPRESSION),
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

const COMPRESSION: Outputs = Outputs::of(&[Output::COMPRESSION]);

/// Sums by which a switch tells a shock from shear and noise.
const LIMITER: Outputs =
    Outputs::of(&[Output::DIVERGENCE_SIGN, Output::UNITY, Output::SIGNAL_SPEED]);

impl<const D: usize> PointLaw<D> for ViscositySwitch {
    const NAME: &'static str = "coefficients of viscosity";
    const READS: Fields = Fields::of(&[
        Field::VISCOSITY_COEFFICIENT,
        Field::DENSITY,
        Field::SOUND_SPEED,
    ])
    .union(WHERE_CARRIED);
    const WRITES: Fields = Fields::of(&[Field::VISCOSITY_COEFFICIENT, Field::DIVERGENCE]);
    const SUMS: Outputs = COMPRESSION.union(LIMITER);
    const OPTIONAL: Fields = WHERE_CARRIED;
    const RUNG: Option<Rung> = Some(Rung::Trial);
    fn summed(&self) -> Outputs {
        self.sums
    }
    fn spared(&self) -> Fields {
        WHERE_CARRIED.minus(self.needs)
    }
    fn prepare<T: Real>(&self, around: &Around<'_, T, D>, _all: &mut [f64; CONSTANTS]) -> bool {
        // Coefficients follow the flow once a step, however many evaluations it takes.
        around.dt > 0.0
    }
    #[inline(always)]
    fn point<L: Lane, P: Reach>(&self, at: &mut Point<'_, L, D, P>) {
        let (zero, one) = (L::zero(), L::one());
        let sum = |output: Output| {
            if self.sums.contains(output) {
                at.sum(output)
            } else {
                zero
            }
        };
        let (density, sound_speed) = (at.get(Field::DENSITY), at.get(Field::SOUND_SPEED));
        let rest = at.get_or(Field::REFERENCE_DENSITY, one);
        let moment = at.get_or(Field::CONSISTENCY_FACTOR, one);
        let compression = at.sum(Output::COMPRESSION);
        let (h, unity) = (at.smoothing_length(), sum(Output::UNITY));
        let sign = sum(Output::DIVERGENCE_SIGN) / unity;
        let around = Surroundings {
            divergence: -self.form.compression(compression, density, rest, moment),
            divergence_before: at.get(Field::DIVERGENCE),
            divergence_sign: L::select(unity.gt(zero), sign, zero),
            shear2: shear2(&at.matrix(Field::VELOCITY_GRADIENT)),
            sound_speed,
            signal_speed: sum(Output::SIGNAL_SPEED).max(sound_speed),
            h,
            support: L::of(self.support) * h,
        };
        let alpha = at.get(Field::VISCOSITY_COEFFICIENT);
        let next = self.switch.next(alpha, &around, at.dt());
        at.set(Field::VISCOSITY_COEFFICIENT, next);
        if at.has(Field::DIVERGENCE) {
            at.set(Field::DIVERGENCE, around.divergence);
        }
    }
}

/// tr S Sᵀ of the traceless symmetric part of a velocity gradient; zero in one dimension.
#[inline(always)]
pub(super) fn shear2<L: Lane, const D: usize>(gradient: &Square<L, D>) -> L {
    let mean = gradient.trace() / L::of(D as f64);
    let mut sum = L::zero();
    for a in 0..D {
        for b in 0..D {
            let mut s = (gradient.0[a][b] + gradient.0[b][a]) * L::of(0.5);
            if a == b {
                s -= mean;
            }
            sum += s * s;
        }
    }
    sum
}
