//! What a group that takes several steps in each step of the others has beside them: what couplings do to it meanwhile.
//! Tuckerman, Berne & Martyna 1992, J. Chem. Phys. 97, 1990, equation 2.25: impulses outside, own steps inside.

use super::population::Particles;
use crate::collective::Collective;
use crate::particles::Field;
use crate::scalar::Real;

/// What a group that sub-cycles has beside others.
#[derive(Clone, Debug)]
pub(crate) struct SubCycle<T, const D: usize> {
    /// How many steps it takes in one of the others.
    pub count: u32,
    /// What couplings do to its particles \[N\], by slot, since the last evaluation.
    pub forces: Vec<[T; D]>,
    /// What these have worked on each body since the start \[J\].
    pub work: Vec<f64>,
    /// Steps taken since the start.
    pub steps: u64,
}

impl<T: Real, const D: usize> SubCycle<T, D> {
    pub fn new(count: u32, bodies: usize) -> Self {
        Self {
            count,
            forces: Vec::new(),
            work: vec![0.0; bodies],
            steps: 0,
        }
    }

    /// How many equal steps it takes in a drift over a share of a step of the others, and how many of them come before the middle of
    /// that drift.
    pub fn steps_in(&self, share: f64) -> [u64; 2] {
        // A share is a quotient, and one step more for its rounding would be none of those asked for.
        let all = (f64::from(self.count) * share.abs() * (1.0 - 1e-9)).ceil() as u64;
        [all, all.div_ceil(2)]
    }

    /// By which share of that drift those steps end behind its middle.
    pub fn beyond_middle(&self, share: f64) -> f64 {
        let [all, before] = self.steps_in(share);
        before as f64 / all as f64 - 0.5
    }

    /// v ← v + dt F/m with what couplings do to its particles, and the work of that on each body: the change of kinetic
    /// energy.
    pub fn kick(&mut self, particles: &mut Particles<T, D>, dt: f64) {
        let step = T::from_f64(dt);
        let columns = &mut particles.columns;
        let [v, mass] = columns.many_mut([Field::VELOCITY, Field::MASS]);
        for (body, work) in particles.bodies.iter().zip(&mut self.work) {
            let mut gained = Collective::new();
            for slot in body.slots.clone() {
                for d in 0..D {
                    let v = &mut v[slot * D + d];
                    let before = v.to_f64();
                    *v += step * self.forces[slot][d] / mass[slot];
                    let twice = v.to_f64().powi(2) - before * before;
                    gained.add(0.5 * mass[slot].to_f64() * twice);
                }
            }
            *work += gained.value();
            // Slots behind the last particle repeat it, and nothing sorts anew what keeps its neighbours.
            if let Some(last) = body.slots.clone().last() {
                for slot in body.slots.end..body.end {
                    v.copy_within(last * D..(last + 1) * D, slot * D);
                }
            }
        }
    }
}
