//! What one particle says of the sums over its neighbours: how far they are from those of a continuum.
//! Read from the neighbour lists at hand; a particle whose support a free surface cuts says nothing.

use super::super::group::Group;
use super::super::query::ParticleView;
use crate::geometry::edge;
use crate::neighbors::CHUNK;
use crate::parallel::{cut, for_each};
use crate::particles::Field;
use crate::scalar::{Real, width};
use crate::scheme::DensityForm;
use crate::tensor::{Matrix, Vector, inverse};
use core::sync::atomic::{AtomicU8, Ordering};

/// How far a particle looks for others in front of it, in local spacings.
const NEAR: f64 = 2.0;
/// Cosine of the half angle of the cone in front of a particle: 45°, in which every lattice has a neighbour.
const CONE: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// What one particle says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub slot: usize,
    /// |1 − Σ V W|.
    pub unity: f64,
    /// ‖Σ V r⊗∇W − 1‖/√D.
    pub gradient: f64,
    /// The same with the factor of the scheme divided out.
    pub left: f64,
    /// h |Σ V ∇W|.
    pub disorder: f64,
    /// ρ₀ Σ V₀ W over the sum of the lattice and ρ, less one; no number where no density is carried.
    pub density: f64,
    /// dx |∇p| \[Pa\] and p \[Pa\].
    pub steepness: f64,
    pub pressure: f64,
    /// dx ‖∇v‖ \[m/s\].
    pub shear: f64,
    /// h over the spacing.
    pub smoothing: f64,
}

/// A group with what is known of its particles.
pub(super) struct Looker<'a, T: Real, const D: usize> {
    pub group: &'a Group<T, D>,
    /// Whether each particle is at a free surface: not yet known, no, yes.
    free: Vec<AtomicU8>,
    /// Whether sums are over the reference configuration.
    total: bool,
}

impl<'a, T: Real, const D: usize> Looker<'a, T, D> {
    pub fn new(group: &'a Group<T, D>) -> Self {
        let mut free = Vec::new();
        free.resize_with(group.particles.mobile, AtomicU8::default);
        let total = group.scheme.density == DensityForm::Deformation;
        Self { group, free, total }
    }

    /// What some of its particles say: those of every `stride`-th chunk of lists.
    pub fn looks(&self, stride: usize) -> (usize, Vec<Look>) {
        let particles = &self.group.particles;
        let each = CHUNK * width::<T>();
        let chunks = particles.mobile.div_ceil(each);
        let listed = self.group.neighborhood.lists.chunks().len();
        let wanted: Vec<usize> = (0..chunks.min(listed)).step_by(stride).collect();
        let mut all: Vec<(usize, Vec<Look>)> = vec![(0, Vec::new()); wanted.len()];
        for_each(cut(&mut all, 1), |k, own| {
            let first = wanted[k] * each;
            for slot in first..(first + each).min(particles.mobile) {
                // The rest of a body's run repeats the last of it.
                let body = &particles.bodies[particles.body_of(slot)];
                if body.slots.contains(&slot) {
                    own[0].0 += 1;
                    own[0].1.extend(self.look(slot));
                }
            }
        });
        let count = all.iter().map(|own| own.0).sum();
        (count, all.into_iter().flat_map(|own| own.1).collect())
    }

    /// The field in which the sums of the scheme measure distances.
    fn places(&self) -> Field {
        if self.total {
            Field::REFERENCE_POSITION
        } else {
            Field::POSITION
        }
    }

    /// The volume \[mᴰ\] of a slot in the configuration of the sums.
    fn volume(&self, slot: usize) -> f64 {
        let columns = &self.group.particles.columns;
        let mass = columns.raw(Field::MASS)[slot].to_f64();
        if self.total && slot < self.group.particles.mobile {
            return mass / self.rest(slot);
        }
        mass / columns.raw(Field::DENSITY)[slot].to_f64()
    }

    /// The density \[kg/m³\] of a slot's material at rest; that of the body before it for walls.
    fn rest(&self, slot: usize) -> f64 {
        let particles = &self.group.particles;
        let material = &particles.bodies[particles.body_of(slot)].material;
        material.reference_density()
    }

    /// The local spacing \[m\].
    pub fn spacing(&self, slot: usize) -> f64 {
        edge::<D>(self.volume(slot))
    }

    /// The direction in which nothing is before a particle, if it is at a face: of all that it sees, or of its own body. Zero of
    /// one that is alone.
    pub fn face(&self, slot: usize, of_body: bool) -> Option<[f64; D]> {
        let particles = &self.group.particles;
        let own = particles.body_of(slot);
        let spacing = self.spacing(slot);
        let positions = particles.columns.vectors(self.places());
        // Those that count: from the particle to them, how far that is, and how many spacings.
        let near = || {
            let neighbors = self.group.neighborhood.of(slot);
            neighbors.filter_map(|other| {
                let mobile = other.slot < particles.mobile;
                if of_body && !(mobile && particles.body_of(other.slot) == own) {
                    return None;
                }
                let r = other.from(&positions[slot], positions);
                let distance = r.iter().map(|r| r * r).sum::<f64>().sqrt();
                let mean = if mobile {
                    0.5 * (spacing + self.spacing(other.slot))
                } else {
                    spacing
                };
                let q = distance / mean;
                (q < NEAR).then_some((r, distance, q))
            })
        };
        let (mut lacks, mut weights) = ([0.0; D], 0.0);
        for (r, distance, q) in near() {
            let weight = 1.0 - q / NEAR;
            weights += weight;
            for d in 0..D {
                lacks[d] -= weight * r[d] / distance.max(f64::MIN_POSITIVE);
            }
        }
        let length = lacks.iter().map(|n| n * n).sum::<f64>().sqrt();
        if weights == 0.0 {
            return Some([0.0; D]);
        }
        // A lattice lacks nothing, but for rounding.
        if length < 1e-6 * weights {
            return None;
        }
        let normal = lacks.map(|n| n / length);
        let ahead = |(r, distance, _): ([f64; D], f64, f64)| {
            (0..D).map(|d| r[d] * normal[d]).sum::<f64>() > CONE * distance
        };
        (!near().any(ahead)).then_some(normal)
    }

    /// Whether a particle is at a free surface; found once.
    fn is_free(&self, slot: usize) -> bool {
        let Some(known) = self.free.get(slot) else {
            return false;
        };
        match known.load(Ordering::Relaxed) {
            0 => {
                let free = self.face(slot, false).is_some();
                known.store(1 + u8::from(free), Ordering::Relaxed);
                free
            }
            known => known == 2,
        }
    }

    /// What a particle says, unless a free surface cuts its support.
    pub fn look(&self, slot: usize) -> Option<Look> {
        if self.is_free(slot) {
            return None;
        }
        let (scheme, columns) = (&self.group.scheme, &self.group.particles.columns);
        let setting = scheme.program.setting();
        let pressures = columns.raw(Field::PRESSURE);
        let velocities = columns.vectors(Field::VELOCITY);
        let own = ParticleView {
            group: self.group,
            slot,
        };
        let (h, spacing, rest) = (own.smoothing_length(), self.spacing(slot), self.rest(slot));
        let itself = scheme.profile.at(0.0)[0] / h.powi(D as i32);
        let (mut unity, mut sum) = (self.volume(slot) * itself, {
            let mass = columns.raw(Field::MASS)[slot].to_f64();
            mass / rest * itself
        });
        let mut first = Vector::<f64, D>::from_element(0.0);
        let mut moment = Matrix::<f64, D>::from_element(0.0);
        let mut of_pressure = Vector::<f64, D>::from_element(0.0);
        let mut of_velocity = Matrix::<f64, D>::from_element(0.0);
        let (p, v) = (pressures[slot].to_f64(), velocities[slot]);
        let mut whole = true;
        own.for_each_neighbor(|other| {
            let from = other.particle().slot;
            whole &= !self.is_free(from);
            if !whole {
                return;
            }
            let (w, volume) = (other.kernel(), self.volume(from));
            unity += volume * w;
            let mass = columns.raw(Field::MASS)[from].to_f64();
            sum += mass / self.rest(from) * w;
            let weighted = Vector::<f64, D>::from(other.kernel_gradient()) * volume;
            first += weighted;
            moment += weighted * Vector::<f64, D>::from(other.offset()).transpose();
            of_pressure += weighted * (pressures[from].to_f64() - p);
            let there = other.velocity();
            let jump = Vector::<f64, D>::from_fn(|d, _| there[d] - v[d].to_f64());
            of_velocity += jump * weighted.transpose();
        });
        if !whole {
            return None;
        }
        let consistency = columns.raw(Field::CONSISTENCY_FACTOR);
        let factor = if scheme.consistent_at_rest {
            consistency.get(slot).map_or(1.0, |own| own.to_f64())
        } else {
            scheme.lattice_consistency_factor
        };
        let departs = |from: f64| {
            let one = Matrix::<f64, D>::identity() * from;
            ((moment - one) / from).norm() / (D as f64).sqrt()
        };
        let corrected = inverse(&moment, 1e-6)?;
        let density = columns.raw(Field::DENSITY)[slot].to_f64();
        Some(Look {
            slot,
            unity: (1.0 - unity).abs(),
            gradient: departs(1.0),
            // Gradients of the reference configuration are corrected by their own matrix.
            left: if self.total { 0.0 } else { departs(factor) },
            disorder: h * first.norm(),
            density: if self.total {
                f64::NAN
            } else {
                rest * sum / (setting.lattice_unity * density) - 1.0
            },
            steepness: spacing * (corrected * of_pressure).norm(),
            pressure: p,
            shear: spacing * (of_velocity * corrected.transpose()).norm(),
            smoothing: h / spacing,
        })
    }
}
