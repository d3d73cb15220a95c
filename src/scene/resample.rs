//! Bodies that start from a state: with the same particles, or with their own, to which the state is interpolated.
//! Linear reproducing interpolation by weighted least squares (Lancaster & Salkauskas 1981, Math. Comp. 37, 141).

use super::{Body, ParticleState, Start};
use crate::error::{Error, Problem, Result};
use crate::material::Material;
use crate::neighbors::Cells;
use crate::particles::Field;
use crate::scalar::Real;
use crate::tensor::{Matrix, Vector, inverse, length};
use std::collections::HashMap;

/// Radius of the weights in mean distances of the state's particles.
const RADIUS: f64 = 2.0;
/// The least pivot of the moments, relative to the largest, with which slopes are fitted; with less the mean is taken.
const SINGULAR: f64 = 1e-6;

impl<T: Real, const D: usize> Body<T, D> {
    /// The particles of a state, at their places, with velocity, density, internal energy and mass as far as the state has them; else
    /// as [`points_of`](Self::points_of) has them. `spacing` \[m\] is that of the state. Fields of effects are taken by
    /// [`field_from`](Self::field_from).
    ///
    /// # Errors
    /// If the state has no particles.
    pub fn of_state(
        name: &str,
        material: Material<T>,
        state: &ParticleState<D>,
        spacing: f64,
    ) -> Result<Self> {
        let points = state.points().to_vec();
        let mut body = Self::points_of(name, material, points, spacing).started_from(state)?;
        if let Some(masses) = state.values("mass") {
            body.masses = masses.to_vec();
        }
        Ok(body)
    }

    /// Starts velocity, density and internal energy with those of a state, interpolated to the places of the particles. What the state
    /// does not have stays as it is.
    ///
    /// A particle that is where one of the state is takes its numbers, to the bit. Others take weighted least squares of the particles
    /// of the state within two of their mean distances: exact for what is linear, and within O(dx²) for what is smooth. Numbers
    /// beyond the surface of the state follow its slope. The mass of a particle is that of its volume, ρ dxᴰ, so the mass of the
    /// body is the integral of the density by its own particles.
    ///
    /// # Errors
    /// If a particle has none of the state within that distance, or the state has none at all.
    pub fn started_from(mut self, state: &ParticleState<D>) -> Result<Self> {
        let from = Interpolation::of(state, &self)?;
        let velocity = from.take(state.field(Field::VELOCITY), D);
        let scalar = |field: Field| from.take(state.field(field), 1);
        let [density, energy] = [Field::DENSITY, Field::ENERGY].map(scalar);
        let start_of = |n: usize| {
            let start = self.start_of(n);
            Start {
                velocity: velocity.as_ref().map_or(start.velocity, |own| {
                    core::array::from_fn(|d| own[n * D + d])
                }),
                density: density.as_ref().map_or(start.density, |own| own[n]),
                energy: energy.as_ref().map_or(start.energy, |own| own[n]),
            }
        };
        self.set_starts((0..self.points.len()).map(start_of).collect());
        Ok(self)
    }

    /// Starts a field that an effect declares or integrates with that of a state, by its name, as
    /// [`started_from`](Self::started_from) does.
    ///
    /// # Errors
    /// As there, and if the state has no such field.
    pub fn field_from(mut self, state: &ParticleState<D>, field: Field) -> Result<Self> {
        let from = Interpolation::of(state, &self)?;
        let components = field.components(D);
        let Some(values) = from.take(state.field(field), components) else {
            return Err(Error::Argument(Problem::Incompatible {
                what: format!("the state has no field {}", field.name()),
                remedy: "leave it out, or write the state with it: Simulation::vtu has all fields that the scheme keeps",
            }));
        };
        self.fields.push(super::body::StartField {
            field,
            components,
            values,
        });
        Ok(self)
    }
}

/// Of which particles of a state each particle of a body takes its numbers, with weights that sum to one.
struct Interpolation {
    weights: Vec<Vec<(usize, f64)>>,
}

impl Interpolation {
    fn of<T: Real, const D: usize>(state: &ParticleState<D>, body: &Body<T, D>) -> Result<Self> {
        let refuse = |what: String, value: f64, must_be| {
            Err(Error::Argument(Problem::Parameter {
                what,
                value,
                must_be,
            }))
        };
        let points = state.points();
        let wrong = points.iter().flatten().find(|x| !x.is_finite());
        if points.is_empty() || wrong.is_some() {
            let what = format!(
                "number of particles of the state that body `{}` starts from",
                body.name
            );
            let must_be = "it must have at least one, at places that are finite";
            return refuse(what, wrong.map_or(0.0, |x| *x), must_be);
        }
        let bits = |x: &[f64; D]| x.map(f64::to_bits);
        let known: HashMap<_, usize> = points.iter().map(bits).zip(0..).collect();
        let radius = RADIUS * distance(state);
        let all: Vec<u32> = (0..points.len() as u32).collect();
        let cells = Cells::build(points, &all, 0.5 * radius);
        let mut weights = Vec::with_capacity(body.points.len());
        for x in &body.points {
            if let Some(&same) = known.get(&bits(x)) {
                weights.push(vec![(same, 1.0)]);
                continue;
            }
            let mut near = Vec::new();
            cells.for_each_run(x.map(|x| x - radius), x.map(|x| x + radius), |run| {
                for &n in run {
                    let r =
                        Vector::<f64, D>::from_fn(|d, _| (points[n as usize][d] - x[d]) / radius);
                    let s: f64 = length(&r);
                    if s < 1.0 {
                        // Wendland's kernel C2.
                        near.push((n as usize, r, (1.0 - s).powi(4) * (1.0 + 4.0 * s)));
                    }
                }
            });
            if near.is_empty() {
                let what = format!(
                    "distance of a particle of body `{}` at {x:?} m from the state",
                    body.name
                );
                let must_be = "it must be less, in metres: the body reaches beyond the particles that it is to start from";
                return refuse(what, radius, must_be);
            }
            near.sort_by_key(|own| own.0);
            weights.push(linear(&near));
        }
        Ok(Self { weights })
    }

    /// The numbers of a quantity at the particles of a body.
    fn take(&self, values: Option<Vec<f64>>, width: usize) -> Option<Vec<f64>> {
        let values = values?;
        let mut taken = Vec::with_capacity(self.weights.len() * width);
        for weights in &self.weights {
            for k in 0..width {
                let own = weights
                    .iter()
                    .map(|(n, weight)| weight * values[n * width + k]);
                taken.push(own.sum());
            }
        }
        Some(taken)
    }
}

/// The weights that give the constant of a weighted fit of a plane to what is around the origin.
fn linear<const D: usize>(near: &[(usize, Vector<f64, D>, f64)]) -> Vec<(usize, f64)> {
    let sum: f64 = near.iter().map(|own| own.2).sum();
    let mut mean = Vector::<f64, D>::zeros();
    for (_, r, w) in near {
        mean += *r * (w / sum);
    }
    let mut moments = Matrix::<f64, D>::zeros();
    for (_, r, w) in near {
        let off = *r - mean;
        moments += off * off.transpose() * (w / sum);
    }
    // f(0) = f̄ − mean·slope, with the slope by the moments about the mean.
    let slope = inverse(&moments, SINGULAR).map(|inverse| inverse * mean);
    let weight = |(n, r, w): &(usize, Vector<f64, D>, f64)| {
        let tilt = slope.map_or(0.0, |slope| (*r - mean).dot(&slope));
        (*n, w / sum * (1.0 - tilt))
    };
    near.iter().map(weight).collect()
}

/// Mean distance \[m\] of the particles of a state: by their volumes, or by the box around them.
fn distance<const D: usize>(state: &ParticleState<D>) -> f64 {
    let count = state.len() as f64;
    let side = |d: usize| {
        let all = || state.points().iter().map(|x| x[d]);
        let [low, high] = [
            all().fold(f64::INFINITY, f64::min),
            all().fold(f64::NEG_INFINITY, f64::max),
        ];
        high - low
    };
    let volumes = state.values("mass").zip(state.values("density"));
    let sum = volumes.map(|(mass, density)| mass.iter().zip(density).map(|(m, rho)| m / rho).sum());
    let volume: f64 = sum.unwrap_or_else(|| (0..D).map(side).product());
    crate::geometry::edge::<D>(volume / count)
}
