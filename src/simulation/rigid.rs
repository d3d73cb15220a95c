//! Bodies that move as rigid ones: mass and inertia, free rotation, and forces that are shared out over their particles.
//! The state is that of the particles; centre and rotation are kept to full precision.

use super::forces::Forces;
use super::population::Particles;
use super::spin::raised;
use crate::boundary::Boundary;
use crate::collective::over;
use crate::particles::Field;
use crate::scalar::Real;
use nalgebra::{Matrix3, SymmetricEigen, UnitQuaternion, Vector3};
use std::sync::Arc;

/// A body that moves as a rigid one.
#[derive(Clone, Debug)]
pub(crate) struct Rigid<const D: usize> {
    /// The body in its group.
    pub body: usize,
    /// Mass \[kg\].
    pub mass: f64,
    /// Where its particles are from the centre of mass \[m\], along principal axes, by number.
    pub places: Vec<Vector3<f64>>,
    /// Principal moments of inertia \[kg m²\].
    pub inertia: Vector3<f64>,
    /// The centre of mass \[m\].
    pub centre: [f64; D],
    /// From principal axes to space, now and as built.
    pub turn: UnitQuaternion<f64>,
    pub built: UnitQuaternion<f64>,
    /// What periods have brought its particles back by \[m\], by number; the centre goes on.
    pub back: Vec<[f64; D]>,
}

pub(super) fn lowered<const D: usize>(vector: &Vector3<f64>) -> [f64; D] {
    core::array::from_fn(|d| vector[d])
}

impl<const D: usize> Rigid<D> {
    /// Of points \[m\] of equal volume with their masses \[kg\].
    pub fn new(body: usize, points: &[[f64; D]], masses: &[f64]) -> Self {
        let all = 0..masses.len();
        let (mass, moment) = over(all.clone(), |id| {
            (masses[id], points[id].map(|x| masses[id] * x))
        });
        let centre = moment.map(|moment| moment / mass);
        let about: Vec<_> = points.iter().map(|x| raised(x) - raised(&centre)).collect();
        let inertia = Matrix3::from(over(all, |id| -> [[f64; 3]; 3] {
            let r = &about[id];
            let about = Matrix3::identity() * r.norm_squared() - r * r.transpose();
            (masses[id] * about).into()
        }));
        // In a plane the third axis is principal, and any two in the plane serve.
        let (moments, turn) = if D == 3 {
            let axes = SymmetricEigen::new(inertia);
            let mut turn = axes.eigenvectors;
            if turn.determinant() < 0.0 {
                turn.column_mut(2).neg_mut();
            }
            let turn = nalgebra::Rotation3::from_matrix_unchecked(turn);
            (
                axes.eigenvalues,
                UnitQuaternion::from_rotation_matrix(&turn),
            )
        } else {
            (inertia.diagonal(), UnitQuaternion::identity())
        };
        let back = turn.inverse();
        Self {
            body,
            mass,
            places: about.iter().map(|r| back * r).collect(),
            inertia: moments,
            centre,
            turn,
            built: turn,
            back: vec![[0.0; D]; points.len()],
        }
    }

    /// Takes note of what periods are about to bring back at `time` \[s\].
    pub fn note_periods<T: Real>(
        &mut self,
        particles: &Particles<T, D>,
        boundaries: &[Arc<dyn Boundary<D>>],
        time: f64,
    ) {
        for (id, back) in self.back.iter_mut().enumerate() {
            let slots = particles.slots_of(self.body, id as u32);
            if slots.is_empty() {
                continue;
            }
            let mut x = particles.columns.vectors(Field::POSITION)[slots.start].map(Real::to_f64);
            for boundary in boundaries {
                if let Some(through) = boundary.wrap(&x, time) {
                    x = through.point(&x);
                    for d in 0..D {
                        back[d] += through.shift[d];
                    }
                }
            }
        }
    }

    /// What a moment along principal axes does to the rotation: I⁻¹ of it, and nothing about what has no inertia.
    pub fn answer(&self, moment: &Vector3<f64>) -> Vector3<f64> {
        let least = 1e-12 * self.inertia.max();
        Vector3::from_fn(|d, _| {
            let turns = D == 3 || (D == 2 && d == 2);
            if turns && self.inertia[d] > least {
                moment[d] / self.inertia[d]
            } else {
                0.0
            }
        })
    }

    /// The same of a moment in space.
    pub fn answer_in_space(&self, moment: &Vector3<f64>) -> Vector3<f64> {
        self.answer_at(&self.turn, moment)
    }

    /// The same where it is turned otherwise.
    pub fn answer_at(&self, turn: &UnitQuaternion<f64>, moment: &Vector3<f64>) -> Vector3<f64> {
        turn * self.answer(&(turn.inverse() * moment))
    }

    /// How it is turned after `dt` \[s\] of free rotation with an angular momentum \[kg m²/s\] that stays: by rotations about the
    /// principal axes, one after the other and back (Dullweber, Leimkuhler & McLachlan 1997, J. Chem. Phys. 107, 5840).
    pub fn rotated(
        &self,
        mut turn: UnitQuaternion<f64>,
        momentum: &Vector3<f64>,
        dt: f64,
    ) -> UnitQuaternion<f64> {
        let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        for (axis, share) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
            let own = turn.inverse() * momentum;
            let angle = share * dt * self.answer(&own)[axis];
            if angle != 0.0 {
                turn *= UnitQuaternion::from_axis_angle(&axes[axis], angle);
            }
        }
        turn.renormalize();
        turn
    }

    /// The sum over its particles that are there of a vector in a slot, and of its moment about the centre.
    pub fn sums<T: Real>(
        &self,
        particles: &Particles<T, D>,
        of: impl Fn(usize) -> Vector3<f64> + Sync,
    ) -> [Vector3<f64>; 2] {
        let sums = over(0..self.places.len(), |id| {
            let Some(slot) = particles.slots_of(self.body, id as u32).next() else {
                return [[0.0; 3]; 2];
            };
            let own = of(slot);
            [own.into(), (self.turn * self.places[id]).cross(&own).into()]
        });
        sums.map(Vector3::from)
    }

    /// Gives its particles the forces that accelerate it as one, with the same sum and the same moment.
    pub fn share_forces<T: Real>(
        &self,
        particles: &Particles<T, D>,
        forces: &mut Forces<'_, T, D>,
    ) {
        let force = |slot: usize| raised(&forces.on(slot).map(Real::to_f64));
        let [sum, moment] = self.sums(particles, force);
        self.share(particles, forces, [sum, moment], Forces::set);
    }

    /// Adds a force \[N\] and a moment \[N m\] about the centre, shared out as what accelerates it as one.
    pub fn push<T: Real>(
        &self,
        particles: &Particles<T, D>,
        forces: &mut Forces<'_, T, D>,
        given: [Vector3<f64>; 2],
    ) {
        self.share(particles, forces, given, Forces::add);
    }

    /// Shares a force \[N\] and a moment \[N m\] about the centre out as what accelerates it as one.
    fn share<'f, T: Real>(
        &self,
        particles: &Particles<T, D>,
        forces: &mut Forces<'f, T, D>,
        [force, moment]: [Vector3<f64>; 2],
        put: impl Fn(&mut Forces<'f, T, D>, usize, [T; D]),
    ) {
        let (a, turning) = (force / self.mass, self.answer_in_space(&moment));
        for (id, place) in self.places.iter().enumerate() {
            let all = a + turning.cross(&(self.turn * place));
            for slot in particles.slots_of(self.body, id as u32) {
                let mass = particles.columns.raw(Field::MASS)[slot].to_f64();
                put(forces, slot, lowered(&(mass * all)).map(T::from_f64));
            }
        }
    }

    /// Its momentum \[kg m/s\], and its angular momentum \[kg m²/s\] about its centre.
    pub fn momenta<T: Real>(&self, particles: &Particles<T, D>) -> [Vector3<f64>; 2] {
        let columns = &particles.columns;
        let (mass, v) = (columns.raw(Field::MASS), columns.vectors(Field::VELOCITY));
        self.sums(particles, |slot| {
            mass[slot].to_f64() * raised(&v[slot].map(Real::to_f64))
        })
    }

    /// Brings its particles to where it is, with the velocities that it has.
    pub fn place<T: Real>(
        &self,
        particles: &mut Particles<T, D>,
        [momentum, spin]: [Vector3<f64>; 2],
    ) {
        let (v, turning) = (momentum / self.mass, self.answer_in_space(&spin));
        for (id, place) in self.places.iter().enumerate() {
            let place = self.turn * place;
            let (at, speed) = (raised(&self.centre) + place, v + turning.cross(&place));
            for slot in particles.slots_of(self.body, id as u32) {
                let [x, residual, velocity] = particles.columns.many_mut([
                    Field::POSITION,
                    Field::POSITION_RESIDUAL,
                    Field::VELOCITY,
                ]);
                for d in 0..D {
                    let k = slot * D + d;
                    let at = at[d] + self.back[id][d];
                    x[k] = T::from_f64(at);
                    if let Some(residual) = residual.get_mut(k) {
                        *residual = T::from_f64(at - x[k].to_f64());
                    }
                    velocity[k] = T::from_f64(speed[d]);
                }
            }
        }
    }
}
