//! The particles of a group, and their order: what enters, leaves, re-enters, and is sorted.
//! States outside are told of every change.

use super::energy::kinetic;
use crate::boundary::{Boundary, Outlet};
use crate::collective::Collective;
use crate::effect::StepProgram;
use crate::error::{Error, Problem, Result};
use crate::material::Material;
use crate::neighbors::Grid;
use crate::origin::global;
use crate::parallel::sort_by_key;
use crate::particles::{Columns, Field};
use crate::scalar::Real;
use crate::scheme::{Scheme, Start};
use crate::sweep::Transform;
use crate::tensor::Vector;
use std::ops::Range;
use std::sync::Arc;

/// A body in a simulation.
#[derive(Clone, Debug)]
pub struct BodyState<T: Real> {
    pub(crate) name: String,
    pub(crate) material: Material<T>,
    /// Slots of its particles; the rest of its run repeats the last of them.
    pub(crate) slots: Range<usize>,
    /// One past the last slot of its run, a whole number of clusters.
    pub(crate) end: usize,
    /// Identities that its particles have had.
    pub(crate) ids: Range<usize>,
    pub(crate) spacing: f64,
}

impl<T: Real> BodyState<T> {
    /// Its slots with the repeats.
    pub(crate) fn run(&self) -> Range<usize> {
        self.slots.start..self.end
    }

    /// The slot of one of its particles, with those that repeat it.
    pub(crate) fn with_repeats(&self, slot: usize) -> Range<usize> {
        let is_last = slot + 1 == self.slots.end;
        slot..if is_last { self.end } else { slot + 1 }
    }
}

/// The particles of a group. A checkpoint holds all of it but how they have moved, which saved states know between steps.
#[derive(Clone, Debug)]
pub(crate) struct Particles<T: Real, const D: usize> {
    pub columns: Columns<T, D>,
    pub bodies: Vec<BodyState<T>>,
    /// Slots below this move by forces; walls come behind.
    pub mobile: usize,
    /// Identity of the particle in each slot, and the slot of each particle.
    pub ids: Vec<u32>,
    pub slot_of: Vec<u32>,
    /// What has left through outlets and drains, and what has entered through inlets and sources.
    pub removed: Passed<D>,
    pub entered: Passed<D>,
    /// How many particles' numbers the groups before it have.
    pub first_id: usize,
    /// The place \[m\] from which columns of places count.
    pub origin: [f64; D],
    /// What list builds have done to them since saved states were last told.
    pub moved: Moves<T, D>,
}

impl<T: Real, const D: usize> Particles<T, D> {
    /// Columns with bodies, of which the slots below `mobile` are, with places counted from an origin \[m\].
    pub fn new(
        columns: Columns<T, D>,
        bodies: Vec<BodyState<T>>,
        mobile: usize,
        origin: [f64; D],
    ) -> Self {
        let ids = (0..columns.slots() as u32).collect();
        let mut own = Self {
            columns,
            bodies,
            mobile,
            ids,
            slot_of: Vec::new(),
            removed: Passed::default(),
            entered: Passed::default(),
            first_id: 0,
            origin,
            moved: Moves::default(),
        };
        own.find_slots(core::iter::empty());
        own
    }

    /// Finds the slot of each particle of bodies and of some walls by identities.
    pub fn find_slots(&mut self, walls: impl Iterator<Item = Range<usize>>) {
        self.slot_of = self.slots_of_ids(&self.ids, walls);
    }

    /// The slot of each particle of bodies and of some walls by the identities in all slots.
    pub fn slots_of_ids(&self, ids: &[u32], walls: impl Iterator<Item = Range<usize>>) -> Vec<u32> {
        let mut slot_of: Vec<u32> = (0..ids.len() as u32).collect();
        for body in &self.bodies {
            slot_of[body.ids.clone()].fill(u32::MAX);
        }
        let bodies = self.bodies.iter().map(|body| body.slots.clone());
        for slot in bodies.chain(walls).flatten() {
            slot_of[ids[slot] as usize] = slot as u32;
        }
        slot_of
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.bodies.iter().map(|body| body.slots.len()).sum()
    }

    /// Place \[m\] in the scene of the particle in a slot.
    pub fn position(&self, slot: usize) -> [f64; D] {
        let residual = self.columns.raw(Field::POSITION_RESIDUAL);
        let x = self.columns.vectors(Field::POSITION)[slot];
        let own = core::array::from_fn(|d| {
            let lost = residual.get(slot * D + d).map_or(0.0, |r| r.to_f64());
            x[d].to_f64() + lost
        });
        global(&own, &self.origin)
    }

    /// The slots of a particle of a body: its own, and those that repeat it; none if it has left.
    pub fn slots_of(&self, body: usize, id: u32) -> Range<usize> {
        let body = &self.bodies[body];
        let slot = self.slot_of[body.ids.start + id as usize];
        if slot == u32::MAX {
            return 0..0;
        }
        body.with_repeats(slot as usize)
    }

    /// The body of a slot.
    pub fn body_of(&self, slot: usize) -> usize {
        self.bodies
            .partition_point(|body| body.end <= slot)
            .min(self.bodies.len() - 1)
    }
}

/// Particles that have left a simulation through outlets and drains, or [entered](super::Simulation::entered) it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Passed<const D: usize> {
    /// Particles.
    pub particles: u64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Momentum \[kg m/s\].
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::components"))]
    pub momentum: [f64; D],
    /// Kinetic energy \[J\].
    pub kinetic: f64,
}

impl<const D: usize> Default for Passed<D> {
    fn default() -> Self {
        Self {
            particles: 0,
            mass: 0.0,
            momentum: [0.0; D],
            kinetic: 0.0,
        }
    }
}

impl<const D: usize> Passed<D> {
    /// With what has left another group.
    pub(super) fn and(self, other: &Self) -> Self {
        Self {
            particles: self.particles + other.particles,
            mass: self.mass + other.mass,
            momentum: core::array::from_fn(|d| self.momentum[d] + other.momentum[d]),
            kinetic: self.kinetic + other.kinetic,
        }
    }
}

/// A particle that re-entered through a boundary.
#[derive(Clone, Debug)]
pub(crate) struct ReEntry<T, const D: usize> {
    /// Its slot in the order before sorting.
    pub slot: usize,
    pub through: Transform<T, D>,
    /// When \[s\].
    pub time: f64,
    /// The body that it is of, and the boundary; none for a repeat, and where nothing is given.
    pub given: Option<[usize; 2]>,
    pub mass: T,
    /// Its velocity before \[m/s\].
    pub velocity: Vector<T, D>,
}

impl<T: Real, const D: usize> ReEntry<T, D> {
    /// How it went through for a state at another time \[s\], in which a boundary that moves was elsewhere.
    pub fn through_at(&self, time: f64) -> Transform<T, D> {
        let later = T::from_f64(time - self.time);
        Transform {
            shift: self.through.shift + self.through.velocity * later,
            ..self.through.clone()
        }
    }

    /// The momentum \[kg m/s\] that the boundary gave a state in which the particle had that velocity.
    pub fn impulse(&self, velocity: &Vector<T, D>) -> [f64; D] {
        let after = self.through.rotation * velocity + self.through.velocity;
        core::array::from_fn(|d| self.mass.to_f64() * (after[d] - velocity[d]).to_f64())
    }
}

/// How list builds moved particles: what re-entered, and the new order of the slots.
/// States that an integrator keeps must follow.
#[derive(Clone, Debug)]
pub(crate) struct Moves<T, const D: usize> {
    pub wraps: Vec<ReEntry<T, D>>,
    /// Slot k is what slot `order[k]` was; empty if the order is the old one.
    pub order: Vec<u32>,
}

impl<T, const D: usize> Default for Moves<T, D> {
    fn default() -> Self {
        Self {
            wraps: Vec::new(),
            order: Vec::new(),
        }
    }
}

impl<T: Real, const D: usize> Particles<T, D> {
    /// Lets particles that have left a period, or crossed a plane, re-enter.
    pub fn wrap(
        &mut self,
        boundaries: &[Arc<dyn Boundary<D>>],
        program: &StepProgram<T, D>,
        time: f64,
    ) {
        for (b, boundary) in boundaries.iter().enumerate() {
            for slot in 0..self.mobile {
                let x = self.columns.vectors(Field::POSITION)[slot].map(Real::to_f64);
                let through = if boundary.crossed(&x, time) {
                    boundary.transform(0, time)
                } else if let Some(through) = boundary.wrap(&x, time) {
                    through
                } else {
                    continue;
                };
                let through = through.to_scalar::<T>();
                let body = self.bodies.iter().position(|own| own.slots.contains(&slot));
                let velocity = Vector::from(self.columns.vectors(Field::VELOCITY)[slot]);
                let [x, residual, v] = self.columns.many_mut([
                    Field::POSITION,
                    Field::POSITION_RESIDUAL,
                    Field::VELOCITY,
                ]);
                through.re_enter(slot, x, residual, v);
                for field in program.state() {
                    through.turn_field(field, slot, self.columns.raw_mut(field));
                }
                // Repeats have lost their own places in a new order, and follow their original.
                if body.is_none() && !self.moved.order.is_empty() {
                    continue;
                }
                let given = body.filter(|_| through.turns());
                // Wraps are told by the order that outside states have now.
                let old = self.moved.order.get(slot);
                self.moved.wraps.push(ReEntry {
                    slot: old.map_or(slot, |&old| old as usize),
                    through,
                    time,
                    given: given.map(|body| [body, b]),
                    mass: self.columns.raw(Field::MASS)[slot],
                    velocity,
                });
            }
        }
    }

    /// Sorts every body along the space-filling curve, in cells that hold a particle each, so that the
    /// members of a cluster are the corners of a cube as far as the flow allows, and so some walls: their slots, and the end of the last
    /// cluster. The order, as that of [`Moves`].
    #[must_use]
    pub fn sort(&mut self, walls: impl Iterator<Item = (Range<usize>, usize)> + Clone) -> Vec<u32> {
        let positions = self.columns.vectors(Field::POSITION);
        let spacing = self
            .bodies
            .iter()
            .fold(f64::INFINITY, |least, body| least.min(body.spacing));
        let grid = Grid::centred(positions, spacing);
        let mut order: Vec<u32> = (0..self.columns.slots() as u32).collect();
        let bodies = self
            .bodies
            .iter()
            .map(|body| (body.slots.clone(), body.end));
        for (slots, end) in bodies.chain(walls.clone()) {
            let keys = grid.orders(&positions[slots.clone()]);
            sort_by_key(&mut order[slots.clone()], slots.start, &keys);
            if let Some(&last) = order[slots.clone()].last() {
                order[slots.end..end].fill(last);
            }
        }
        self.reorder(order, walls.map(|(slots, _)| slots))
    }

    /// Takes out what outlets take; the slots behind the last particle of a body repeat it. What is `whole` leaves when they
    /// take all of it. The order, as that of [`Moves`].
    #[must_use]
    pub fn remove(&mut self, outlets: &[Outlet<D>], whole: impl Fn(usize) -> bool) -> Vec<u32> {
        if outlets.is_empty() {
            return Vec::new();
        }
        self.take_out(whole, |columns, slot| {
            let [x, v] = [Field::POSITION, Field::VELOCITY]
                .map(|field| columns.vectors(field)[slot].map(Real::to_f64));
            outlets.iter().any(|own| own.takes(&x, &v))
        })
    }

    /// Takes out the particles of which `leaves` holds, by their slots, as [`remove`](Self::remove) does.
    #[must_use]
    pub fn take_out(
        &mut self,
        whole: impl Fn(usize) -> bool,
        leaves: impl Fn(&Columns<T, D>, usize) -> bool,
    ) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.columns.slots() as u32).collect();
        let mut any = false;
        for k in 0..self.bodies.len() {
            let (slots, end) = (self.bodies[k].slots.clone(), self.bodies[k].end);
            let mut kept = slots.start;
            let mut left = Collective::new();
            if whole(k) && !slots.clone().all(|slot| leaves(&self.columns, slot)) {
                continue;
            }
            for slot in slots.clone() {
                if !leaves(&self.columns, slot) {
                    order[kept] = slot as u32;
                    kept += 1;
                    continue;
                }
                any = true;
                self.slot_of[self.ids[slot] as usize] = u32::MAX;
                let v = self.columns.vectors(Field::VELOCITY)[slot].map(Real::to_f64);
                let mass = self.columns.raw(Field::MASS)[slot].to_f64();
                left.add((
                    v.map(|v| mass * v),
                    [mass, kinetic(&self.columns, slot)],
                    1_u64,
                ));
            }
            let (momentum, [mass, kinetic], particles) = left.value();
            self.removed = self.removed.and(&Passed {
                particles,
                mass,
                momentum,
                kinetic,
            });
            if kept > slots.start {
                let last = order[kept - 1];
                order[kept..end].fill(last);
            }
            self.bodies[k].slots.end = kept;
        }
        if any {
            return self.reorder(order, core::iter::empty());
        }
        Vec::new()
    }

    /// Appends one particle to a body, like its material at rest or of a density \[kg/m³\], at a place \[m\] that is counted
    /// from the origin.
    ///
    /// # Errors
    /// If the reserve of the body is used up.
    pub fn insert(
        &mut self,
        scheme: &Scheme<T, D>,
        body: usize,
        [x, velocity]: [[f64; D]; 2],
        density: Option<f64>,
    ) -> Result<()> {
        let (slots, end) = (self.bodies[body].slots.clone(), self.bodies[body].end);
        let free = self.bodies[body]
            .ids
            .clone()
            .find(|&id| self.slot_of[id] == u32::MAX);
        let (Some(id), true) = (free, slots.end < end) else {
            return Err(Error::Argument(Problem::Parameter {
                what: format!("reserve of what enters body `{}`", self.bodies[body].name),
                value: slots.len() as f64,
                must_be: "all of it has entered and none has left: give the inlet or source a larger reserve, \
                          or put an outlet where the flow ends",
            }));
        };
        let slot = slots.end;
        let start = Start {
            velocity,
            density: density.unwrap_or_else(|| self.bodies[body].material.reference_density()),
            energy: 0.0,
        };
        let own = &self.bodies[body];
        let (material, spacing) = (own.material.clone(), own.spacing);
        scheme.place(&mut self.columns, slot, (&material, spacing), x, &start);
        self.bodies[body].slots.end = slot + 1;
        self.ids[slot] = id as u32;
        self.slot_of[id] = slot as u32;
        let mass = self.columns.raw(Field::MASS)[slot].to_f64();
        let v = self.columns.vectors(Field::VELOCITY)[slot].map(Real::to_f64);
        self.entered = self.entered.and(&Passed {
            particles: 1,
            mass,
            momentum: v.map(|v| mass * v),
            kinetic: kinetic(&self.columns, slot),
        });
        Ok(())
    }

    /// Rearranges the slots of bodies and some walls, and remembers it for states outside. The order; empty if it is the
    /// old one.
    fn reorder(&mut self, order: Vec<u32>, walls: impl Iterator<Item = Range<usize>>) -> Vec<u32> {
        if order.iter().enumerate().all(|(k, &from)| k as u32 == from) {
            return Vec::new();
        }
        self.columns.permute(&order);
        self.moved.order = if self.moved.order.is_empty() {
            order.clone()
        } else {
            in_order(&self.moved.order, &order)
        };
        self.renumber(&order, walls);
        order
    }

    /// Notes that slot k of bodies and some walls has the particle that slot `order[k]` had.
    pub fn renumber(&mut self, order: &[u32], walls: impl Iterator<Item = Range<usize>>) {
        self.ids = in_order(&self.ids, order);
        let bodies = self.bodies.iter().map(|body| body.slots.clone());
        for slot in bodies.chain(walls).flatten() {
            self.slot_of[self.ids[slot] as usize] = slot as u32;
        }
    }
}

fn in_order(before: &[u32], order: &[u32]) -> Vec<u32> {
    order.iter().map(|&from| before[from as usize]).collect()
}
