//! Sub-cycling: groups that take several steps in each step of the others, and what couplings do to them meanwhile.
//! Tuckerman, Berne & Martyna 1992, J. Chem. Phys. 97, 1990, equation 2.25: impulses outside, own steps inside.

use super::Simulation;
use super::population::Particles;
use crate::error::Result;
use crate::particles::Field;
use crate::scalar::Real;

/// How many more steps than were asked for a group may need before its step has collapsed.
const RUNAWAY: f64 = 64.0;

/// What a group that sub-cycles has beside others.
#[derive(Clone, Debug)]
pub(crate) struct SubCycle<T, const D: usize> {
    /// How many steps it may take in one of the others at most.
    pub most: u32,
    /// What couplings do to its particles \[N\], by slot, since the last evaluation.
    pub forces: Vec<[T; D]>,
    /// What these have worked on each body since the start \[J\].
    pub work: Vec<f64>,
    /// Steps taken since the start.
    pub steps: u64,
}

impl<T: Real, const D: usize> SubCycle<T, D> {
    pub fn new(most: u32, bodies: usize) -> Self {
        Self {
            most,
            forces: Vec::new(),
            work: vec![0.0; bodies],
            steps: 0,
        }
    }

    /// v ← v + dt F/m with what couplings do to its particles, and the work of that on each body: the change of kinetic
    /// energy.
    pub fn kick(&mut self, particles: &mut Particles<T, D>, dt: f64) {
        let step = T::from_f64(dt);
        let columns = &mut particles.columns;
        let [v, mass] = columns.many_mut([Field::VELOCITY, Field::MASS]);
        for (body, work) in particles.bodies.iter().zip(&mut self.work) {
            for slot in body.slots.clone() {
                for d in 0..D {
                    let v = &mut v[slot * D + d];
                    let before = v.to_f64();
                    *v += step * self.forces[slot][d] / mass[slot];
                    *work += 0.5 * mass[slot].to_f64() * (v.to_f64().powi(2) - before * before);
                }
            }
            // Slots behind the last particle repeat it, and nothing sorts anew what keeps its neighbours.
            if let Some(last) = body.slots.clone().last() {
                for slot in body.slots.end..body.end {
                    v.copy_within(last * D..(last + 1) * D, slot * D);
                }
            }
        }
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Steps of all groups that sub-cycle since the start; see [`Scene::sub_cycle`](crate::scene::Scene::sub_cycle).
    #[must_use]
    pub fn sub_steps(&self) -> u64 {
        let groups = self.after_step().groups.iter();
        let apart = groups.filter_map(|group| group.sub_cycle.as_ref());
        apart.map(|apart| apart.steps).sum()
    }

    /// How many equal steps a group needs in `span` \[s\] if it sub-cycles.
    pub(super) fn sub_steps_in(&mut self, group: usize, span: f64) -> Result<Option<u64>> {
        let Some(apart) = &self.state.groups[group].sub_cycle else {
            return Ok(None);
        };
        let most = f64::from(apart.most);
        let own = self.vote_of(group, self.control.courant)?;
        let own = self.approach_of(group, own)?;
        let count = (span / own.step).ceil().max(1.0);
        // A limit of zero or no number of steps at all is a step that has collapsed.
        if count.is_nan() || count > RUNAWAY * most {
            self.state.last_vote = Some(own);
            return Err(self.collapsed(span / count));
        }
        Ok(Some(count as u64))
    }
}
