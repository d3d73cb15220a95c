//! Couplings by forces between pairs: the search, sums of their own, forces, work, and what pairs remember.
//! Pairs act in the order of the numbers of their particles, so results do not depend on threads or on lists.

use super::Simulation;
use super::couplings::coupled_particle;
use super::group::Group;
use super::pair_images::velocity;
use super::pair_list::PairList;
use super::population::Particles;
use crate::boundary::Boundary;
use crate::coupling::{CoupledPair, Coupling};
use crate::error::{Error, Problem, Result};
use crate::parallel::largest;
use crate::particles::Field;
use crate::scalar::Real;
use crate::tensor::Vector;
use std::sync::Arc;

/// Skin of the lists of pairs in mean spacings.
const SKIN: f64 = 0.4;
/// Distance in spacings that a pair has at least, as far as its approach is concerned.
const NEAREST: f64 = 0.5;

/// Two bodies, or a body and itself, that act on each other by forces between their particles.
#[derive(Clone, Debug)]
pub(crate) struct Couple<T: Real, const D: usize> {
    pub coupling: Arc<dyn Coupling<T, D>>,
    /// The group and the body there, of both sides.
    pub sides: [(usize, usize); 2],
    /// Their scene indices.
    pub indices: [usize; 2],
    /// How near particles act on each other \[m\].
    pub reach: f64,
    /// Pairs of a body with itself that are nearer than this as built \[m\] do not.
    pub exclusion: f64,
    /// Where particles are as built \[m\], where pairs are chosen by that.
    pub reference: [Vec<[f64; D]>; 2],
    /// The harmonic mean of ρc² of both bodies \[Pa\]; no number before the first evaluation.
    pub stiffness: f64,
    /// What the last evaluation has left.
    pub acting: Acting<T, D>,
    /// What its forces have worked on both sides since the start \[J\].
    pub work: [f64; 2],
    pub list: PairList<T, D>,
}

/// What an evaluation changes, and the next step needs as the last step has left it.
#[derive(Clone, Debug)]
pub(crate) struct Acting<T, const D: usize> {
    /// The force \[N\] on the first side.
    pub force: [f64; D],
    /// The largest step \[s\] that it bears.
    pub step: f64,
    /// The force \[N\] on particles of both sides, by their numbers in the body.
    pub forces: [Vec<(u32, [T; D])>; 2],
    /// Anchors of pairs \[m\], in the order of the numbers of their particles.
    pub anchors: Vec<([u32; 2], [T; D])>,
    /// Energy that it stores \[J\].
    pub stored: f64,
    /// Heat since the start \[J\].
    pub heat: f64,
    /// Penetration in mean spacings: now, and the largest since the start.
    pub penetration: [f64; 2],
    /// Pairs that act.
    pub pairs: usize,
    /// The force \[N\] of images on both sides, boundary by boundary.
    pub images: [Vec<[f64; D]>; 2],
}

impl<T, const D: usize> Default for Acting<T, D> {
    fn default() -> Self {
        Self {
            force: [0.0; D],
            step: f64::INFINITY,
            forces: [Vec::new(), Vec::new()],
            anchors: Vec::new(),
            stored: 0.0,
            heat: 0.0,
            penetration: [0.0; 2],
            pairs: 0,
            images: [Vec::new(), Vec::new()],
        }
    }
}

/// How a coupling by forces stands; see [couplings](crate::coupling#energy).
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The name of the coupling.
    pub name: &'static str,
    /// The bodies; a body that meets itself is there twice.
    pub bodies: [String; 2],
    /// Pairs that act.
    pub pairs: usize,
    /// The force on the first body \[N\]; zero for a body that meets itself.
    pub force: Vec<f64>,
    /// Energy that it stores \[J\].
    pub stored: f64,
    /// Heat of friction since the start \[J\].
    pub heat: f64,
    /// What it has worked on both bodies since the start \[J\].
    pub work: [f64; 2],
    /// How much nearer than a mean spacing the nearest pair is, in spacings; zero if none is nearer.
    pub penetration: f64,
    /// The largest since the start.
    pub largest_penetration: f64,
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// How all couplings by forces stand, in the order of the scene.
    #[must_use]
    pub fn contacts(&self) -> Vec<Contact> {
        let contact = |own: &Couple<T, D>| Contact {
            name: own.coupling.name(),
            bodies: own.sides.map(|(group, body)| {
                let bodies = &self.groups[group].particles.bodies;
                bodies[body].name.clone()
            }),
            pairs: own.acting.pairs,
            force: own.acting.force.to_vec(),
            stored: own.acting.stored,
            heat: own.acting.heat,
            work: own.work,
            penetration: own.acting.penetration[0],
            largest_penetration: own.acting.penetration[1],
        };
        self.couples.iter().map(contact).collect()
    }

    /// The largest penetration since the start, in mean spacings, of all couplings with a name.
    ///
    /// # Errors
    /// If no coupling by forces has that name; the error lists those that there are.
    pub fn largest_penetration(&self, coupling: &str) -> Result<f64> {
        let own = (self.couples.iter()).filter(|own| own.coupling.name() == coupling);
        let own = own.map(|own| own.acting.penetration[1]).reduce(f64::max);
        own.ok_or_else(|| {
            let known: Vec<_> = self.couples.iter().map(|own| own.coupling.name()).collect();
            Error::Argument(Problem::UnknownName {
                kind: "coupling by forces",
                name: coupling.into(),
                known: known.join(", "),
            })
        })
    }

    /// Gives bodies the forces of couplings between pairs, with the rates at hand.
    pub(super) fn act_in_pairs(&mut self) {
        for couple in &mut self.couples {
            couple.act(&mut self.groups, self.control.approach, self.evaluated);
        }
    }

    /// Books what couplings by forces work in a kick over `dt` \[s\].
    pub(super) fn record_couples(&mut self, dt: f64) {
        for couple in &mut self.couples {
            for side in 0..2 {
                couple.work[side] += couple.work_in_kick(side, &self.groups, dt);
            }
        }
    }
}

impl<T: Real, const D: usize> Couple<T, D> {
    /// Whether it is of a body with itself.
    pub fn is_self(&self) -> bool {
        self.sides[0] == self.sides[1]
    }

    /// The number of particles that a body has had.
    fn count(&self, side: usize, groups: &[Group<T, D>]) -> usize {
        let (group, body) = self.sides[side];
        groups[group].particles.bodies[body].ids.len()
    }

    /// The slot of a particle of a side, if it is there.
    fn slot(&self, side: usize, id: u32, groups: &[Group<T, D>]) -> Option<usize> {
        let (group, body) = self.sides[side];
        let particles = &groups[group].particles;
        let slot = particles.slot_of[particles.bodies[body].ids.start + id as usize];
        (slot != u32::MAX).then_some(slot as usize)
    }

    fn spacing(&self, groups: &[Group<T, D>]) -> f64 {
        let [first, second] = self
            .sides
            .map(|(group, body)| groups[group].particles.bodies[body].spacing);
        0.5 * (first + second)
    }

    fn work_in_kick(&self, side: usize, groups: &[Group<T, D>], dt: f64) -> f64 {
        let group = &groups[self.sides[side].0];
        let columns = &group.particles.columns;
        let (mass, v) = (columns.raw(Field::MASS), columns.vectors(Field::VELOCITY));
        let mut work = 0.0;
        for &(id, force) in &self.acting.forces[side] {
            let Some(slot) = self.slot(side, id, groups) else {
                continue;
            };
            for d in 0..D {
                // Where a group sub-cycles, the kick is that of couplings alone.
                let a = group.sub_cycle.as_ref().map_or_else(
                    || group.work.acceleration(mass, slot * D + d),
                    |apart| apart.forces[slot][d] / mass[slot],
                );
                work += force[d].to_f64() * (v[slot][d].to_f64() + 0.5 * dt * a.to_f64());
            }
        }
        dt * work
    }

    /// Forces between all pairs within reach, on the groups of both sides.
    fn act(&mut self, groups: &mut [Group<T, D>], approach: f64, time: f64) {
        if self.stiffness.is_nan() {
            let [a, b] = self
                .sides
                .map(|(group, body)| stiffness_of(&groups[group].particles, body));
            self.stiffness = 2.0 / (1.0 / a + 1.0 / b);
        }
        if !self.list_serves(groups, time) {
            self.list(groups, time);
        }
        let boundaries = &groups[self.sides[0].0].boundaries;
        let boundary_count = boundaries.len();
        self.list.images.place(boundaries, time);
        let spacing = self.spacing(groups);
        let mut list = core::mem::take(&mut self.list);
        self.see(&mut list, groups);
        let as_built = self.coupling.as_built();
        let reach = if as_built { f64::INFINITY } else { self.reach };
        let gap = |x: &[T; D], y: &[T; D]| -> f64 {
            let square = (0..D).map(|d| (x[d].to_f64() - y[d].to_f64()).powi(2));
            square.sum::<f64>().sqrt()
        };
        let acting = &mut self.acting;
        acting.stored = 0.0;
        if self.coupling.gathers() {
            for &[a, b] in &list.pairs {
                let [on, from] = [a, b].map(|row| list.particles[row as usize]);
                // What is not there is no number away.
                if gap(&on.position, &from.position) < reach {
                    for (row, seen) in [(a, (&on, &from)), (b, (&from, &on))] {
                        if list.image_rows[row as usize].is_some() {
                            continue;
                        }
                        let (sum, gradient) = self.coupling.gather(seen.0, seen.1);
                        let own = &mut list.particles[row as usize];
                        own.sum += sum;
                        for d in 0..D {
                            own.gradient[d] += gradient[d];
                        }
                    }
                }
            }
            for (own, image) in list.particles.iter_mut().zip(&list.image_rows) {
                if image.is_none() {
                    let (pressure, stored) = self.coupling.pressure(own, T::from_f64(spacing));
                    own.pressure = pressure;
                    acting.stored += stored;
                }
            }
            for row in 0..list.particles.len() {
                let Some([source, chain]) = list.image_rows[row] else {
                    continue;
                };
                let Some(source) = list.particles.get(source as usize).copied() else {
                    continue;
                };
                let turn = &list.images.transforms[chain as usize].rotation;
                let own = &mut list.particles[row];
                (own.sum, own.pressure) = (source.sum, source.pressure);
                own.gradient = (turn * Vector::from(source.gradient)).into();
            }
        }
        acting.force = [0.0; D];
        acting.step = f64::INFINITY;
        acting.pairs = 0;
        acting.penetration[0] = 0.0;
        for images in &mut acting.images {
            images.clear();
            images.resize(boundary_count, [0.0; D]);
        }
        list.forces.clear();
        list.forces.resize(list.rows.len(), [T::zero(); D]);
        list.anchors.clear();
        let mut before = acting.anchors.iter().peekable();
        for &[a, b] in &list.pairs {
            let [on, from] = [a, b].map(|row| list.particles[row as usize]);
            let distance = gap(&on.position, &from.position);
            if distance >= reach || distance.is_nan() {
                continue;
            }
            let numbers = [a, b].map(|row| list.rows[row as usize]);
            let second = usize::from(self.sides[0] != self.sides[1]);
            let ids =
                [(0, numbers[0]), (second, numbers[1])].map(|(side, id)| list.images.key(side, id));
            let chains = [a, b].map(|row| list.image_rows[row as usize].map(|own| own[1] as usize));
            // With an image it is half of a pair, whose other half is listed too.
            let share = if chains == [None; 2] { 1.0 } else { 0.5 };
            while before.peek().is_some_and(|own| own.0 < ids) {
                before.next();
            }
            let rest = if as_built {
                let at = |side: usize| list.listed[side.min(second)][numbers[side] as usize];
                (0..D)
                    .map(|d| (at(0)[d] - at(1)[d]).powi(2))
                    .sum::<f64>()
                    .sqrt()
            } else {
                0.0
            };
            let own = self.coupling.act(&CoupledPair {
                on,
                from,
                rest: T::from_f64(rest),
                anchor: before.peek().filter(|own| own.0 == ids).map(|own| own.1),
            });
            acting.stored += share * own.stored;
            acting.heat += share * own.heat;
            if let Some(anchor) = own.anchor {
                list.anchors.push((ids, anchor));
            }
            acting.penetration[0] = acting.penetration[0].max(1.0 - distance / spacing);
            if own.force.iter().any(|force| *force != T::zero()) {
                acting.pairs += 1;
            }
            for d in 0..D {
                let force = own.force[d].to_f64();
                match chains {
                    [None, None] => acting.force[d] += force,
                    [None, Some(chain)] => {
                        acting.images[0][list.images.boundary(chain)][d] += force;
                    }
                    [Some(chain), _] => {
                        acting.images[second][list.images.boundary(chain)][d] -= force;
                    }
                }
                list.forces[a as usize][d] += own.force[d];
                list.forces[b as usize][d] -= own.force[d];
            }
            let closing = (0..D).map(|d| {
                let v = from.velocity[d] - on.velocity[d];
                (v * (on.position[d] - from.position[d])).to_f64()
            });
            let closing = closing.sum::<f64>() / distance.max(f64::MIN_POSITIVE);
            let mut step = self.coupling.step(&on, &from);
            if closing > 0.0 && !as_built {
                step = step.min(approach * distance.max(NEAREST * spacing) / closing);
            }
            // What is no number is no step at all.
            acting.step = if step >= 0.0 {
                acting.step.min(step)
            } else {
                0.0
            };
        }
        core::mem::swap(&mut acting.anchors, &mut list.anchors);
        acting.penetration[1] = acting.penetration[1].max(acting.penetration[0]);
        if self.sides[0] == self.sides[1] {
            acting.force = [0.0; D];
        }
        self.list = list;
        self.hand_over(groups);
    }

    /// Gives particles their forces.
    fn hand_over(&mut self, groups: &mut [Group<T, D>]) {
        for side in 0..2 {
            self.acting.forces[side].clear();
        }
        for (row, &id) in self.list.rows.iter().enumerate() {
            let side = usize::from(row >= self.list.split);
            let force = self.list.forces[row];
            let image = self.list.image_rows[row].is_some();
            if image || force.iter().all(|force| *force == T::zero()) {
                continue;
            }
            if let Some(slot) = self.slot(side, id, groups) {
                groups[self.sides[side].0].push(slot, force);
                self.acting.forces[side].push((id, force));
            }
        }
    }

    /// Reads the particles of all rows.
    fn see(&self, list: &mut PairList<T, D>, groups: &[Group<T, D>]) {
        let spacings = self
            .sides
            .map(|(group, body)| T::from_f64(groups[group].particles.bodies[body].spacing));
        let stiffness = T::from_f64(self.stiffness);
        list.particles.clear();
        for (row, &id) in list.rows.iter().enumerate() {
            let side = usize::from(row >= list.split);
            let columns = &groups[self.sides[side].0].particles.columns;
            let mut particle = coupled_particle(columns, 0, spacings[side]);
            let (id, chain) = list.images.source(side, id);
            match self.slot(side, id, groups) {
                Some(slot) => particle = coupled_particle(columns, slot, spacings[side]),
                None => particle.position = [T::from_f64(f64::NAN); D],
            }
            if let Some(chain) = chain {
                let own = &list.images.transforms[chain];
                particle.position = own.point(&particle.position);
                particle.velocity = velocity(own, &particle.velocity);
            }
            particle.stiffness = stiffness;
            list.particles.push(particle);
        }
    }

    /// Whether no particle has moved so far that the list could miss a pair.
    fn list_serves(&self, groups: &[Group<T, D>], time: f64) -> bool {
        if self.list.listed[0].is_empty() {
            return false;
        }
        if self.coupling.as_built() {
            return true;
        }
        let moved = |side: usize| {
            let (group, body) = self.sides[side];
            let particles = &groups[group].particles;
            let body = &particles.bodies[body];
            let x = particles.columns.vectors(Field::POSITION);
            let listed = &self.list.listed[side];
            let far = |slot: usize| {
                let before = &listed[particles.ids[slot] as usize - body.ids.start];
                let square = (0..D).map(|d| (x[slot][d].to_f64() - before[d]).powi(2));
                let square = square.sum::<f64>();
                // One that was not there has come from anywhere.
                if square.is_nan() {
                    f64::INFINITY
                } else {
                    square
                }
            };
            largest(body.slots.clone(), far).sqrt()
        };
        let first = moved(0);
        let second = if self.is_self() { first } else { moved(1) };
        let boundaries: &[Arc<dyn Boundary<D>>] = &groups[self.sides[0].0].boundaries;
        let carried = self.list.images.carried(boundaries, [self.list.time, time]);
        first + second + carried <= self.list.skin
    }

    /// Lists pairs that may be within reach before particles have moved by half the skin.
    fn list(&mut self, groups: &[Group<T, D>], time: f64) {
        let mut list = core::mem::take(&mut self.list);
        let skin = SKIN * self.spacing(groups);
        list.skin = skin;
        let as_built = self.coupling.as_built();
        let reach = self.reach + if as_built { 0.0 } else { skin };
        // Images of places as built are those of the scene as built.
        list.time = if as_built { 0.0 } else { time };
        let boundaries = &groups[self.sides[0].0].boundaries;
        list.images.clear();
        for side in 0..if self.is_self() { 1 } else { 2 } {
            let listed = &mut list.listed[side];
            listed.clear();
            if as_built {
                listed.extend_from_slice(&self.reference[side]);
                list.images.add(side, listed, boundaries, reach, list.time);
                continue;
            }
            listed.resize(self.count(side, groups), [f64::NAN; D]);
            let (group, body) = self.sides[side];
            let particles = &groups[group].particles;
            let body = &particles.bodies[body];
            for slot in body.slots.clone() {
                let id = particles.ids[slot] as usize - body.ids.start;
                let x = particles.columns.vectors(Field::POSITION)[slot];
                listed[id] = x.map(Real::to_f64);
            }
            list.images.add(side, listed, boundaries, reach, time);
        }
        list.find(self.is_self(), reach);
        if self.is_self() && self.exclusion > 0.0 {
            let (rest, least) = (&self.reference[0], self.exclusion);
            list.images.place(boundaries, 0.0);
            let images = &list.images;
            let built = |id: u32| match images.source(0, id) {
                (id, None) => rest[id as usize],
                (id, Some(chain)) => {
                    let image = images.transforms[chain].point(&rest[id as usize].map(T::from_f64));
                    image.map(Real::to_f64)
                }
            };
            list.found.retain(|&[a, b]| {
                let (x, y) = (built(a), built(b));
                let apart = |d: usize| (x[d] - y[d]).powi(2);
                (0..D).map(apart).sum::<f64>() >= least * least
            });
        }
        list.number(self.is_self());
        self.list = list;
    }
}

/// The largest ρc² of a body \[Pa\].
fn stiffness_of<T: Real, const D: usize>(particles: &Particles<T, D>, body: usize) -> f64 {
    let columns = &particles.columns;
    let (rho, c) = (columns.raw(Field::DENSITY), columns.raw(Field::SOUND_SPEED));
    let own = particles.bodies[body].slots.clone();
    own.fold(0.0, |most: f64, slot| {
        most.max(rho[slot].to_f64() * c[slot].to_f64().powi(2))
    })
}
