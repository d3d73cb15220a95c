//! What a scheme is, as far as its effects may ask: kernel, spacing, density form.
//! Evaluated when the scene is built, so the order in which a builder was told does not matter.

use super::surface_area::area_factor;
use super::{DensityForm, EnergyForm, Smoothing};
use crate::kernel::lattice::{gradients_at_surface, lattice_consistency_factor, lattice_unity};
use crate::kernel::{Kernel, KernelFacts};

/// What a scheme is, as far as its effects may ask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// What the kernel says about itself.
    pub kernel: KernelFacts,
    /// Ratio of smoothing length to spacing.
    pub h_over_dx: f64,
    /// How density follows from the particles.
    pub density: DensityForm,
    /// Whose pressure force acts.
    pub pressure_form: DensityForm,
    /// How internal energy follows from the work of pair forces.
    pub energy: EnergyForm,
    /// How smoothing lengths change.
    pub smoothing: Smoothing,
    /// First moment −Σ V r·∇W/D of the lattice.
    pub lattice_consistency_factor: f64,
    /// Σ V W over the lattice.
    pub lattice_unity: f64,
    /// hᴰ W at the spacing.
    pub kernel_at_spacing: f64,
    /// The factor of areas by which a flat surface along the lattice is exact, for [`SurfaceHeat`](super::SurfaceHeat).
    pub area_factor: f64,
}

impl Setting {
    pub(crate) fn of<const D: usize>(
        kernel: &impl Kernel<D>,
        h_over_dx: f64,
        (density, pressure_form): (DensityForm, DensityForm),
    ) -> Self {
        Self {
            kernel: KernelFacts::of(kernel),
            h_over_dx,
            density,
            pressure_form,
            energy: EnergyForm::None,
            smoothing: Smoothing::Fixed,
            lattice_consistency_factor: lattice_consistency_factor(kernel, h_over_dx),
            lattice_unity: lattice_unity(kernel, h_over_dx),
            kernel_at_spacing: kernel.normalisation() * Kernel::<D>::shape(kernel, 1.0 / h_over_dx),
            area_factor: area_factor(&gradients_at_surface(kernel, h_over_dx), h_over_dx),
        }
    }
}
