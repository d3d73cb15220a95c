//! What of a simulation does not run on a device, by its name and with a remedy.
//! Nothing is left out in silence.

use super::{clamps, contacts, structures};
use crate::effect::DensityForm;
use crate::error::Problem;
use crate::scalar::Real;
use crate::simulation::{Group, Simulation};

/// What is to be done about most.
const ON_HOST: &str = "run the scene on the host (Simulation::run_until), or leave that part out";

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The parts of the scene that do not run on a device.
    pub(super) fn not_on_device(&self) -> Vec<Problem> {
        let mut parts = Vec::new();
        let mut part = |is_there: bool, what: &dyn Fn() -> String| {
            if is_there {
                parts.push(what());
            }
        };
        let state = &self.state;
        for what in contacts::refused(self) {
            part(true, &|| what.clone());
        }
        part(!state.joints.is_empty(), &|| "joints".into());
        for group in &state.groups {
            part(clamps::overlap(&group.held.clamps), &|| {
                "a particle that two clamps hold".into()
            });
            for rigid in &group.held.rigid {
                let body = &group.particles.bodies[rigid.body].name;
                part(true, &|| format!("the rigid body `{body}`"));
            }
            part(group.sub_cycles(), &|| "a group that sub-cycles".into());
            for what in structures::refused(group) {
                part(true, &|| what.clone());
            }
            let scheme = &group.scheme;
            part(!group.exchanges.is_empty(), &|| {
                "schemes that follow each other by events".into()
            });
            for emitter in &group.emitters {
                let wall = &group.walls[emitter.wall].name;
                part(true, &|| format!("the inlet `{wall}`"));
            }
            for wall in group.walls.iter().filter(|wall| wall.inflow.is_some()) {
                part(true, &|| format!("the inlet `{}`", wall.name));
            }
            for _ in &group.outlets {
                part(true, &|| "an outlet".into());
            }
            for own in &group.sources {
                part(true, &|| {
                    format!("the source of `{}`", group.particles.bodies[own.body].name)
                });
            }
            for _ in &group.drains {
                part(true, &|| "a drain".into());
            }
            part(group.share.is_some(), &|| "a scene on ranks".into());
            part(scheme.density == DensityForm::Lam, &|| {
                "density by Lam et al. (DensityForm::Lam)".into()
            });
        }
        for load in &self.loads {
            part(true, &|| format!("the load ({load})"));
        }
        for event in &self.events {
            part(true, &|| format!("the event `{}`", event.name));
        }
        let keeps = self.integrator.slots() > 0;
        let pushed = |group: &Group<T, D>| group.has_forces_of_laws() || !group.held.is_empty();
        let pushed = state.groups.iter().any(pushed) || !state.couples.is_empty();
        part(keeps && pushed, &|| {
            format!(
                "the integrator {}, which keeps states, with forces that are no pair's",
                self.integrator.name()
            )
        });
        part(state.work.is_some(), &|| {
            "the energy ledger (Simulation::keep_energy)".into()
        });
        part(state.watch.is_some(), &|| {
            "a run that is watched (Simulation::keep_stability)".into()
        });
        parts
            .into_iter()
            .map(|what| Problem::Incompatible {
                what: format!("{what} does not run on a device"),
                remedy: ON_HOST,
            })
            .collect()
    }
}
