//! What schemes start from, as effects: pressure force, densities from sums, internal energy, and what changes them.
//! Each gives its terms, and registers what follows from their sums under the choices of a scheme, [`Setting`].

use super::continuity::{self, Divergence};
use super::density::{ContactActivity, SolvedSmoothing, SummedDensity};
use super::{
    BySum, DivergenceSmoothing, Effect, Evolved, Setting, Smoothing, StepProgram, Update, When,
};
use crate::particles::{Field, Output};
use crate::scalar::Real;
use crate::term::{
    Compression, In, InternalEnergy, KernelSum, MatrixPressureForce, MidpointReconstruction,
    PressureForce, RenormalisedCompression, RenormalisedPressureForce, Stage, stage,
};

/// How internal energy follows from the work of pair forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EnergyForm {
    /// Not carried: the materials do not ask for it.
    None,
    /// Each side takes half the power of every pair force; total energy drifts with the order of the
    /// step (Monaghan & Gingold 1983).
    ///
    #[doc = include_str!("../../docs/equations/energy_symmetric.html")]
    Symmetric,
    /// The work of every pair force with the mean velocity of each kick, so that total energy is
    /// conserved to rounding whatever the forces are (Owen 2014). Needs an integrator that kicks, and, but for
    /// [total-Lagrangian schemes](crate::scheme#energy), a second pass over the pairs of each kick.
    ///
    #[doc = include_str!("../../docs/equations/energy_compatible.html")]
    #[default]
    Compatible,
}

/// The pressure force, and the rate of compression whose work it does.
impl<const D: usize> Effect<D> for PressureForce {
    type Terms = (
        In<stage::Pressure, Self>,
        In<stage::Compression, Compression>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(Compression))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        follow_compression(program);
    }
}

/// Both with corrected gradients.
impl<const D: usize> Effect<D> for RenormalisedPressureForce {
    type Terms = (
        In<stage::Pressure, Self>,
        In<stage::Compression, RenormalisedCompression>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(RenormalisedCompression))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        follow_compression(program);
    }
}

/// Gradients from inverted matrices, and the work of each side's own pressure.
impl<const D: usize> Effect<D> for MatrixPressureForce {
    type Terms = (
        In<stage::Pressure, Self>,
        In<stage::Compression, RenormalisedCompression>,
    );
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self), In::new(RenormalisedCompression))
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        follow_compression(program);
    }
}

/// Integrates what follows the rate of compression.
fn follow_compression<T: Real, const D: usize>(program: &mut StepProgram<T, D>) {
    let setting = *program.setting();
    let compression = continuity::Compression {
        density: setting.density,
        pressure: setting.pressure_form,
    };
    if let Smoothing::Divergence(DivergenceSmoothing { smallest, largest }) = setting.smoothing {
        program.evolve(
            Evolved::kicked(Field::SMOOTHING_LENGTH)
                .at(When::Drift)
                .updated(Update::Within { smallest, largest })
                .by(Divergence(compression)),
        );
    }
    if setting.density.is_integrated() {
        let density = Evolved::kicked(Field::DENSITY)
            .at(When::Drift)
            .updated(Update::Exponential)
            .by(compression);
        program.evolve(density.keeping(Field::DENSITY_RESIDUAL));
    }
}

/// A part of the pressure force.
impl<const D: usize> Effect<D> for MidpointReconstruction {
    type Terms = (In<stage::Pressure, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn problems(&self) -> Vec<(&'static str, f64, &'static str)> {
        super::not_negative(&[("strength of the midpoint reconstruction", self.strength)])
    }
}

/// Densities that may follow from sums, with the sums at rest and the contacts that go with them. A scheme without it integrates
/// its density.
impl<const D: usize> Effect<D> for KernelSum {
    type Terms = (In<stage::Sums, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let setting = *program.setting();
        match setting.smoothing {
            _ if setting.density.is_integrated() => {}
            Smoothing::Consistent(own) => {
                let law = SolvedSmoothing {
                    eta: setting.h_over_dx,
                    limits: [own.smallest, own.largest],
                };
                program.law(Stage::Density, law);
            }
            _ => program.law(Stage::Density, SummedDensity(setting.density)),
        }
        // Smoothing that follows density takes bodies as one.
        if !matches!(setting.smoothing, Smoothing::Consistent(_)) {
            let stage = if setting.density.is_integrated() {
                Stage::Contacts
            } else {
                Stage::Density
            };
            program.law(stage, ContactActivity);
        }
    }
}

/// Internal energy, in an [`EnergyForm`]. A scheme without it carries none.
impl<const D: usize> Effect<D> for InternalEnergy {
    type Terms = (In<stage::Power, Self>,);
    const BOOKS_ENERGY: bool = true;
    fn terms(&self, _setting: &Setting) -> Self::Terms {
        (In::new(*self),)
    }
    fn register<T: Real>(&self, program: &mut StepProgram<T, D>) {
        let form = program.setting().energy;
        if form != EnergyForm::None {
            program.evolve(Evolved::kicked(Field::ENERGY).by(BySum {
                sum: Output::POWER,
                over: Some(Field::MASS),
            }));
        }
        if form == EnergyForm::Compatible {
            program.carry(Field::MEAN_VELOCITY);
            if !program.setting().density.keeps_neighbors() {
                program.carry(Field::MEAN_ACCELERATION);
            }
        }
    }
}
