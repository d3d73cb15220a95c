//! The parts of a scene that share their energy: groups that carry internal energy, liquids, and couplings.
//! Where nothing can be said of one, the reason.

use crate::scalar::Real;
use crate::scheme::EnergyForm;
use crate::simulation::Simulation;
use crate::simulation::contact::Couple;
use crate::simulation::group::Group;
use crate::simulation::population::BodyState;
use crate::simulation::side::Side;

const NO_ENERGY: &str =
    "no internal energy is integrated; Simulation::keep_energy books the work instead";

impl<T: Real, const D: usize> Simulation<T, D> {
    /// Parts of which there is something to say: groups with internal energy, liquids without, and couplings.
    pub(super) fn stored_parts(&self) -> impl Iterator<Item = usize> {
        let groups = self.state.groups.len();
        let of_liquids = self.state.groups.iter().any(|group| !has_energy(group));
        let all = 0..groups + 1 + self.state.couples.len();
        all.filter(move |&k| match self.state.groups.get(k) {
            Some(group) => has_energy(group),
            None => k > groups || of_liquids,
        })
    }

    pub(super) fn name_of_part(&self, k: usize) -> String {
        let names = |groups: &mut dyn Iterator<Item = &Group<T, D>>| {
            let bodies = groups.flat_map(|group| &group.particles.bodies);
            let names: Vec<_> = bodies.map(|body| body.name.as_str()).collect();
            names.join(", ")
        };
        if let Some(group) = self.state.groups.get(k) {
            return names(&mut core::iter::once(group));
        }
        match self.couple_of(k) {
            None => names(&mut self.state.groups.iter().filter(|group| !has_energy(group))),
            Some(couple) => {
                let [first, second] = couple
                    .sides
                    .each_ref()
                    .map(|side| side.name(&self.state.groups));
                format!("{} of {first} and {second}", couple.coupling.name())
            }
        }
    }

    pub(super) fn couple_of(&self, k: usize) -> Option<&Couple<T, D>> {
        self.state
            .couples
            .get(k.checked_sub(self.state.groups.len() + 1)?)
    }

    /// Why nothing can be said of a part, as the scene was built.
    pub(super) fn unsaid(&self, k: usize) -> Option<&'static str> {
        if !self.integrator.kicks() {
            return Some("the integrator leaves no forces that belong to the end of a step");
        }
        if let Some(group) = self.state.groups.get(k) {
            return self.unsaid_of_group(group);
        }
        if let Some(couple) = self.couple_of(k) {
            let apart = |side: &Side<D>| {
                let body = side.body();
                body.is_some_and(|(group, _)| self.state.groups[group].sub_cycles())
            };
            return if !couple.coupling.books_energy() {
                Some("the coupling does not say what it stores")
            } else if couple.sides.iter().any(apart) {
                Some("a side sub-cycles, and its work is booked with that of its other couplings")
            } else {
                None
            };
        }
        let moves = |group: &Group<T, D>| group.boundaries.iter().any(|own| own.moves());
        if self.state.work.is_none() {
            Some(NO_ENERGY)
        } else if self.state.groups.iter().any(has_energy) {
            Some("bodies with internal energy take part")
        } else if !self
            .state
            .groups
            .iter()
            .all(|group| group.scheme.program.books_energy)
        {
            Some("an effect does not say what it stores")
        } else if self.state.groups.iter().any(moves) {
            Some("the work of a boundary that moves is not booked")
        } else if self.state.groups.iter().any(|group| !group.held.is_empty()) {
            Some("the work of what holds particles is not booked")
        } else if self.state.groups.iter().any(|group| !has_law(group)) {
            Some("the pressure of a material depends on internal energy")
        } else {
            None
        }
    }

    fn unsaid_of_group(&self, group: &Group<T, D>) -> Option<&'static str> {
        if !group.scheme.program.books_energy {
            Some("an effect does not say what it stores")
        } else if group.scheme.energy != EnergyForm::Compatible {
            Some("the energy form does not balance the work of a step")
        } else if !has_law(group) {
            Some("the pressure of a material depends on internal energy")
        } else if !group.walls.is_empty() {
            Some("walls take part of the work")
        } else if self.loads.iter().any(|load| load.heats()) {
            Some("a load heats or cools")
        } else if !group.scheme.program.heating.is_empty() {
            Some("heat is conducted")
        } else {
            None
        }
    }
}

/// Whether its bodies carry an internal energy.
pub(super) fn has_energy<T: Real, const D: usize>(group: &Group<T, D>) -> bool {
    group.scheme.energy != EnergyForm::None
}

/// Whether what its materials store is a function of the state.
pub(super) fn has_law<T: Real, const D: usize>(group: &Group<T, D>) -> bool {
    let known = |body: &BodyState<T>| {
        let eos = body.material.eos();
        eos.stored_energy(eos.reference_density(), 0.0).is_some()
    };
    !group.scheme.program.presses || group.particles.bodies.iter().all(known)
}
