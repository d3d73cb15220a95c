//! From total to updated Lagrangian: a body that deforms too far for the neighbours it was built with starts anew with others.
//! Masses, places, velocities and internal energies are carried over to the bit, stress by its law.

use super::{Body, Start};
use crate::effect::{
    FiniteStrainPlasticity, Hypoelastic, InPlaneStress, NeoHookean, Plasticity, TotalLagrangian,
    stretches,
};
use crate::error::{Problem, Result};
use crate::scalar::Real;
use crate::simulation::{ParticleView, Simulation};
use crate::tensor::{Matrix, determinant};

/// When and how a [total-Lagrangian](TotalLagrangian) body goes on as an updated-Lagrangian one.
///
/// Kernels of the body as built say less and less of one that flows, breaks or folds. It is due where det F or a stretch of a
/// particle leaves the bounds given here; the body it makes then starts in a scene of its own, or of others, with
///
/// | quantity | in the new body |
/// |---|---|
/// | mass, position, velocity, internal energy | the same to the bit |
/// | stress σ = P Fᵀ/J | [`Hypoelastic::STRESS`] S = σ + p, with p = −tr σ/3 |
/// | density | ρ₀/J; of hyperelastic laws, whose pressure is not by the equation of state, that at which it has p |
/// | plastic strain and work | [`Plasticity::STRAIN`], [`Plasticity::WORK`], if there are any |
///
/// So mass, momentum, angular momentum and total energy are continuous to rounding, and stress is but for the half of a kick by
/// which internal energy is ahead of pressure. Internal energy has all work since the beginning, that of the hourglass control
/// too, which becomes heat. Stretches are those along the axes or wider
/// (bounds by Gershgorin's circles). The new scene starts at t = 0; sheets in plane stress are refused.
///
/// ```
/// use meshfree::effect::{FiniteStrainPlasticity, Hypoelastic, Plasticity};
/// use meshfree::prelude::*;
/// use meshfree::scene::Conversion;
///
/// // A copper bar on a plane of symmetry, until a particle is pressed to nine tenths.
/// let bar = Body::block("bar", catalogue::ofhc_copper(), [0.0; 2], [0.01, 0.004], 5e-4).velocity([-200.0, 0.0]);
/// let plane = || MirrorPlane::symmetry([0.0; 2], [-1.0, 0.0]);
/// let mut bar = Scene::<f64, 2>::new(schemes::total_lagrangian_impact().with(FiniteStrainPlasticity))
///     .body(bar)
///     .boundary(plane())
///     .build()?;
/// let conversion = Conversion::default().stretches([0.9, 2.0]);
/// while !conversion.is_due(&bar, "bar")? {
///     bar.step()?;
/// }
/// let scheme = schemes::impact_by_continuity().with(Hypoelastic).with(Plasticity);
/// let mut flowing = Scene::<f64, 2>::new(scheme)
///     .body(conversion.body(&bar, "bar")?)
///     .boundary(plane())
///     .build()?;
/// let [before, after] = [&bar, &flowing].map(|own| own.ledger().whole.total_energy());
/// assert!((after / before - 1.0).abs() < 1e-14);
/// flowing.run_until(1e-6)?;
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    volumes: [f64; 2],
    stretches: [f64; 2],
}

impl Default for Conversion {
    /// Volumes from 0.5 to 2 and stretches from 0.4 to 2: beyond, kernels as built lack what is near now, and well within
    /// what [`TotalLagrangian`] counts as beyond its validity.
    fn default() -> Self {
        Self {
            volumes: [0.5, 2.0],
            stretches: [0.4, 2.0],
        }
    }
}

impl Conversion {
    /// The least and the largest det F that a particle may have.
    #[must_use]
    pub const fn volumes(mut self, bounds: [f64; 2]) -> Self {
        self.volumes = bounds;
        self
    }
    /// The least and the largest stretch that a particle may have.
    #[must_use]
    pub const fn stretches(mut self, bounds: [f64; 2]) -> Self {
        self.stretches = bounds;
        self
    }

    /// Whether a particle of a body is beyond the bounds, at the last evaluation.
    ///
    /// # Errors
    /// If there is no such body, it is not total Lagrangian, or bounds are none.
    pub fn is_due<T: Real, const D: usize>(
        &self,
        simulation: &Simulation<T, D>,
        body: &str,
    ) -> Result<bool> {
        Ok(self.distortion(simulation, body)?.is_some())
    }

    /// The first particle of a body that is beyond the bounds, and in what, at the last evaluation: the reason for which a run with the
    /// neighbours as built should stop.
    ///
    /// # Errors
    /// As [`is_due`](Self::is_due).
    pub fn distortion<T: Real, const D: usize>(
        &self,
        simulation: &Simulation<T, D>,
        body: &str,
    ) -> Result<Option<Distortion<D>>> {
        for (what, [least, most]) in [("volumes", self.volumes), ("stretches", self.stretches)] {
            if !((0.0..1.0).contains(&least) && most > 1.0) {
                let value = if most > 1.0 { least } else { most };
                return Err(Problem::Parameter {
                    what: format!("a bound of the {what} at which body `{body}` is converted"),
                    value,
                    must_be: "the least must be from 0 to 1 and the largest above 1, where nothing is deformed",
                }
                .into());
            }
        }
        for (index, particle) in simulation.body(body)?.enumerate() {
            let gradient = deformation(&particle, body)?;
            let [most, least] = stretches(&gradient);
            let volume = determinant(&gradient);
            let found = [
                ("det F", volume, self.volumes),
                ("least stretch", least.sqrt().recip(), self.stretches),
                ("largest stretch", most.sqrt(), self.stretches),
            ];
            let beyond = |(_, value, [low, high]): &(&str, f64, [f64; 2])| {
                !(*low <= *value && *value <= *high)
            };
            if let Some((quantity, value, bounds)) = found.into_iter().find(beyond) {
                return Ok(Some(Distortion {
                    quantity,
                    value,
                    bounds,
                    particle: index,
                    position: particle.position(),
                    time: simulation.time(),
                }));
            }
        }
        Ok(None)
    }

    /// The body as it is now, for a scheme with [`Hypoelastic`], and [`Plasticity`] if it has flowed.
    ///
    /// # Errors
    /// If there is no such body, or it is not total Lagrangian, or in plane stress.
    pub fn body<T: Real, const D: usize>(
        &self,
        simulation: &Simulation<T, D>,
        body: &str,
    ) -> Result<Body<T, D>> {
        let (material, spacing) = simulation.material_and_spacing(body)?;
        let particles: Vec<_> = simulation.body(body)?.collect();
        let places = particles.iter().map(ParticleView::position).collect();
        let mut own = Body::points_of(body, material.clone(), places, spacing);
        let (mut stresses, mut masses, mut flowed) = (Vec::new(), Vec::new(), Vec::new());
        let mut starts = Vec::new();
        for particle in &particles {
            let (pressure, energy) = (particle.pressure(), particle.energy());
            stresses.push(deviatoric_stress(particle, body)?);
            masses.push(particle.mass());
            let mut density = particle.density();
            let yields = particle.tensor(FiniteStrainPlasticity::INVERSE_PLASTIC);
            if yields.is_some() {
                let number = |field| particle.scalar(field).unwrap_or(0.0);
                flowed.push([number(Plasticity::STRAIN), number(Plasticity::WORK)]);
            } else {
                // Pressure of a hyperelastic law is not that of the equation of state.
                let at = material.eos().density_at(pressure, energy);
                density = at.unwrap_or(density);
            }
            starts.push(Start {
                velocity: particle.velocity(),
                density,
                energy,
            });
        }
        own.set_starts(starts);
        own.masses = masses;
        own = own.listed(Hypoelastic::STRESS, &stresses);
        if !flowed.is_empty() {
            for (k, field) in [Plasticity::STRAIN, Plasticity::WORK]
                .into_iter()
                .enumerate()
            {
                let column: Vec<_> = flowed.iter().map(|own| [own[k]]).collect();
                own = own.listed(field, &column);
            }
        }
        Ok(own)
    }
}

/// Where a total-Lagrangian body is deformed beyond the bounds of a [`Conversion`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Distortion<const D: usize> {
    /// `det F`, `least stretch` or `largest stretch`.
    pub quantity: &'static str,
    /// Its value \[1\].
    pub value: f64,
    /// The bounds that it has left.
    pub bounds: [f64; 2],
    /// The index of the particle in its body.
    pub particle: usize,
    /// Its place \[m\].
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub position: [f64; D],
    /// When \[s\].
    pub time: f64,
}

impl<const D: usize> core::fmt::Display for Distortion<D> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let [low, high] = self.bounds;
        write!(
            f,
            "{} {:.3} of particle {} at {:.4?} m is not from {low} to {high}, at t = {:.6} s",
            self.quantity, self.value, self.particle, self.position, self.time
        )
    }
}

/// F of a particle.
fn deformation<T: Real, const D: usize>(
    particle: &ParticleView<'_, T, D>,
    body: &str,
) -> Result<Matrix<f64, D>> {
    let sheet = particle.scalar(InPlaneStress::<NeoHookean>::THICKNESS);
    let total = particle.matrix(TotalLagrangian::DEFORMATION);
    match (total, sheet) {
        (Some(rows), None) => Ok(Matrix::from_fn(|a, b| rows[a][b])),
        (None, _) => Err(Problem::Incompatible {
            what: format!("body `{body}` has no deformation gradient to be converted by"),
            remedy: "convert a body of a total-Lagrangian scheme (schemes::total_lagrangian)",
        }
        .into()),
        (_, Some(_)) => Err(Problem::Incompatible {
            what: format!(
                "body `{body}` is a sheet in plane stress, whose thickness would be lost"
            ),
            remedy: "convert bodies in plane strain or in space",
        }
        .into()),
    }
}

/// S = σ + p of a particle \[Pa\], xx, yy, zz, yz, xz, xy: σ = P Fᵀ/J in the space of the body, and beyond it what p = −tr σ/3
/// leaves.
fn deviatoric_stress<T: Real, const D: usize>(
    particle: &ParticleView<'_, T, D>,
    body: &str,
) -> Result<[f64; 6]> {
    let gradient = deformation(particle, body)?;
    let rows = particle
        .matrix(TotalLagrangian::PIOLA)
        .unwrap_or([[0.0; D]; D]);
    let piola = Matrix::<f64, D>::from_fn(|a, b| rows[a][b]);
    let stress = piola * gradient.transpose() / determinant(&gradient);
    let pressure = particle.pressure();
    let outside = (-3.0 * pressure - stress.trace()) / (3 - D).max(1) as f64;
    let at = |a: usize, b: usize| {
        let own = match (a < D && b < D, a == b) {
            (true, _) => 0.5 * (stress[(a, b)] + stress[(b, a)]),
            (false, true) => outside,
            (false, false) => 0.0,
        };
        if a == b { own + pressure } else { own }
    };
    Ok([at(0, 0), at(1, 1), at(2, 2), at(1, 2), at(0, 2), at(0, 1)])
}
