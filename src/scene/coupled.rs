//! Which bodies act on each other, or on themselves, and how: what the scene says, or what follows from its schemes.
//! A liquid meets the solids of other groups as walls unless a coupling or [`Interaction::None`] says otherwise.

use super::{Body, Coupled, Part, Scene};
use crate::coupling::{Coupling, LiquidStructure};
use crate::origin::local;
use crate::scalar::Real;
use crate::simulation::{Acting, Couple, PairList, SubCycle};
use crate::sweep::Interaction;
use std::sync::Arc;

impl<T: Real, const D: usize> Scene<T, D> {
    /// What was said of two bodies.
    pub(super) fn coupling(&self, first: &str, second: &str) -> Option<&Coupled<T, D>> {
        let meant = |own: &&Coupled<T, D>| {
            (own.first == first && own.second == second)
                || (own.first == second && own.second == first)
        };
        self.couplings.iter().rfind(meant)
    }

    /// By which coupling a solid is a wall of a liquid, if it is one.
    pub(super) fn wall_coupling(
        &self,
        liquid: &str,
        solid: &str,
    ) -> Option<Arc<dyn Coupling<T, D>>> {
        match self.coupling(liquid, solid) {
            Some(said) => said.coupling.is_wall().then(|| said.coupling.clone()),
            None if self.said_between(liquid, solid) == Some(Interaction::None) => None,
            None => Some(Arc::new(LiquidStructure)),
        }
    }

    /// By which coupling a body is a wall of a liquid's part, if it is one of any of its bodies.
    pub(super) fn wall_coupling_of(
        &self,
        part: &Part<T, D>,
        solid: &Body<T, D>,
    ) -> Option<Arc<dyn Coupling<T, D>>> {
        let mut bodies = part.bodies.iter();
        bodies.find_map(|own| self.wall_coupling(&own.name, &solid.name))
    }

    /// The group and the number there of a body.
    pub(super) fn place_of(&self, name: &str) -> Option<(usize, usize)> {
        self.parts.iter().enumerate().find_map(|(group, part)| {
            let body = part.bodies.iter().position(|body| body.name == name)?;
            Some((group, body))
        })
    }

    /// What acts by forces between particles, in places that are counted from an origin \[m\].
    pub(super) fn couples(&self, origin: &[f64; D]) -> Vec<Couple<T, D>> {
        let couple = |own: &Coupled<T, D>| {
            let sides = [self.place_of(&own.first)?, self.place_of(&own.second)?];
            let body = |(group, body): (usize, usize)| &self.parts[group].bodies[body];
            let reach = own.coupling.reach(sides.map(|side| body(side).spacing));
            let before = |(group, body)| -> usize {
                self.parts[..group]
                    .iter()
                    .map(|part| part.bodies.len())
                    .sum::<usize>()
                    + body
            };
            let by_reference = own.exclusion > 0.0 || own.coupling.as_built();
            let reference = |side| -> Vec<[f64; D]> {
                let points = if by_reference {
                    &body(side).points[..]
                } else {
                    &[]
                };
                points.iter().map(|x| local(x, origin)).collect()
            };
            (reach > 0.0).then(|| Couple {
                coupling: own.coupling.clone(),
                sides,
                indices: sides.map(before),
                reach,
                exclusion: own.exclusion,
                reference: sides.map(reference),
                stiffness: f64::NAN,
                acting: Acting::default(),
                work: [0.0; 2],
                list: PairList::default(),
            })
        };
        self.couplings.iter().filter_map(couple).collect()
    }

    /// What a group that sub-cycles has beside others.
    pub(super) fn sub_cycle_of(&self, group: usize) -> Option<SubCycle<T, D>> {
        let own = |(name, _): &&(String, u32)| self.place_of(name).map(|at| at.0) == Some(group);
        let (_, most) = self.sub_cycled.iter().rfind(own)?;
        let spreads = self.spread.iter();
        let spreads = spreads.filter_map(|name| self.place_of(name));
        Some(SubCycle {
            spreads: spreads.into_iter().any(|at| at.0 == group),
            ..SubCycle::new(*most, self.parts[group].bodies.len())
        })
    }
}
