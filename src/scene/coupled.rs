//! Which bodies act on each other, or on themselves, and how: what the scene says, or what follows from its schemes.
//! A liquid meets the solids of other groups as walls unless a coupling or [`Interaction::None`] says otherwise.

use super::{Body, Coupled, Part, Scene};
use crate::boundary::motion_from;
use crate::coupling::{Coupling, LiquidStructure};
use crate::origin::local;
use crate::scalar::Real;
use crate::simulation::{Acting, Couple, MetWall, PairList, Side, SubCycle};
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

    /// The number of a wall of particles.
    pub(super) fn wall_number(&self, name: &str) -> Option<usize> {
        self.walls.iter().position(|wall| wall.name == name)
    }

    /// What a coupling by forces names, with its scene index, its spacing \[m\] and where its particles are as built \[m\],
    /// in places that are counted from an origin \[m\].
    pub(super) fn side_of(
        &self,
        name: &str,
        origin: &[f64; D],
    ) -> Option<(Side<D>, usize, f64, Vec<[f64; D]>)> {
        let from = |points: &[[f64; D]]| points.iter().map(|x| local(x, origin)).collect();
        if let Some((group, body)) = self.place_of(name) {
            let before = self.parts[..group].iter().map(|part| part.bodies.len());
            let index = before.sum::<usize>() + body;
            let own = &self.parts[group].bodies[body];
            let side = Side::Body { group, body };
            return Some((side, index, own.spacing, from(&own.points)));
        }
        let number = self.wall_number(name)?;
        let wall = &self.walls[number];
        let met = MetWall {
            name: wall.name.clone(),
            rest: from(&wall.points),
            spacing: wall.spacing,
            motion: wall.motion.as_ref().map(|own| motion_from(own, origin)),
            sliding: wall.sliding,
        };
        let index = self.bodies().count() + number;
        let built = met.places(0.0);
        Some((Side::Wall(Arc::new(met)), index, wall.spacing, built))
    }

    /// What acts by forces between particles, in places that are counted from an origin \[m\].
    pub(super) fn couples(&self, origin: &[f64; D]) -> Vec<Couple<T, D>> {
        let couple = |own: &Coupled<T, D>| {
            let sides = [
                self.side_of(&own.first, origin)?,
                self.side_of(&own.second, origin)?,
            ];
            let reach = own.coupling.reach(sides.each_ref().map(|side| side.2));
            let by_reference = own.exclusion > 0.0 || own.coupling.as_built();
            let indices = sides.each_ref().map(|side| side.1);
            let reference = sides.each_ref().map(|side| {
                if by_reference {
                    side.3.clone()
                } else {
                    Vec::new()
                }
            });
            (reach > 0.0).then(|| Couple {
                coupling: own.coupling.clone(),
                sides: sides.map(|side| side.0),
                indices,
                reach,
                exclusion: own.exclusion,
                reference,
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
        let (_, count) = self.sub_cycled.iter().rfind(own)?;
        Some(SubCycle::new(*count, self.parts[group].bodies.len()))
    }
}
