//! What a group that takes several steps in each step of the others has beside them: what couplings do to it meanwhile.
//! Tuckerman, Berne & Martyna 1992, J. Chem. Phys. 97, 1990, equation 2.25: impulses outside, own steps inside.

use super::forces::Forces;
use super::group::Group;
use super::held::Held;
use super::population::Particles;
use crate::collective::Collective;
use crate::particles::Field;
use crate::scalar::Real;
use std::ops::Range;

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
    fn steps_in(&self, share: f64) -> [u64; 2] {
        // A share is a quotient, and one step more for its rounding would be none of those asked for.
        let all = (f64::from(self.count) * share.abs() * (1.0 - 1e-9)).ceil() as u64;
        [all, all.div_ceil(2)]
    }

    /// By which share of that drift those steps end behind its middle.
    fn beyond_middle(&self, share: f64) -> f64 {
        let [all, before] = self.steps_in(share);
        before as f64 / all as f64 - 0.5
    }

    /// v ← v + dt F/m with what couplings do to its particles, and the work of that on each body: the change of kinetic
    /// energy.
    fn kick(&mut self, particles: &mut Particles<T, D>, dt: f64) {
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

/// What is asked of a group, whether it sub-cycles or not.
impl<T: Real, const D: usize> Group<T, D> {
    /// Whether it takes steps of its own, and couplings act on it by impulses between these.
    pub fn sub_cycles(&self) -> bool {
        self.sub_cycle.is_some()
    }

    /// How many steps it takes in one of the others.
    pub fn step_ratio(&self) -> f64 {
        let apart = self.sub_cycle.as_ref();
        apart.map_or(1.0, |apart| f64::from(apart.count))
    }

    /// Steps taken alone since the start.
    pub fn sub_steps(&self) -> u64 {
        self.sub_cycle.as_ref().map_or(0, |apart| apart.steps)
    }

    /// The steps to take alone, of how many, in a drift over a share of a step of the others: those before its middle, or the others.
    pub fn take_steps(&mut self, share: f64, before_middle: bool) -> (Range<u64>, u64) {
        let Some(apart) = &mut self.sub_cycle else {
            return (0..0, 1);
        };
        let [count, middle] = apart.steps_in(share);
        let steps = if before_middle {
            0..middle
        } else {
            middle..count
        };
        apart.steps += steps.end - steps.start;
        (steps, count)
    }

    /// How far \[s\] it is ahead of the middle of a drift over such a share.
    pub fn ahead(&self, [drift, share]: [f64; 2]) -> f64 {
        let apart = self.sub_cycle.as_ref().filter(|_| drift != 0.0);
        apart.map_or(0.0, |apart| drift * apart.beyond_middle(share))
    }

    /// Its forces to be changed, or those among which the forces of couplings are, with whom they act on.
    pub fn forces(&mut self, coupled: bool) -> (Forces<'_, T, D>, &Particles<T, D>, &mut Held<D>) {
        let forces = match &mut self.sub_cycle {
            Some(apart) if coupled => Forces::Apart(&mut apart.forces),
            _ => Forces::Own(&mut self.work),
        };
        (forces, &self.particles, &mut self.held)
    }

    /// What couplings do to a particle \[N\] apart from its forces, if it sub-cycles.
    pub fn force_apart(&self, slot: usize) -> Option<[T; D]> {
        self.sub_cycle.as_ref()?.forces.get(slot).copied()
    }

    /// The work of couplings on a body \[J\], if it sub-cycles.
    pub fn work_apart(&self, body: usize) -> Option<f64> {
        self.sub_cycle.as_ref()?.work.get(body).copied()
    }

    /// Forgets what couplings did, before they act anew.
    pub fn forget_forces_apart(&mut self) {
        if let Some(apart) = &mut self.sub_cycle {
            apart.forces.clear();
            apart.forces.resize(self.particles.mobile, [T::zero(); D]);
        }
    }

    /// Kicks by what couplings do to it, if it sub-cycles.
    pub fn kick_apart(&mut self, dt: f64) {
        if let Some(apart) = &mut self.sub_cycle {
            apart.kick(&mut self.particles, dt);
        }
    }
}
