//! Couplings by forces between pairs: the search, sums of their own, forces, work, and what pairs remember.
//! Pairs act in the order of the numbers of their particles, so results do not depend on threads or on lists.

use super::energy::power;
use super::group::Group;
use super::group::shared_with_image;
use super::pair_list::PairList;
use super::side::{MetWall, Side, carry};
use crate::boundary::Boundary;
use crate::collective::{Collective, over};
use crate::coupling::{Anchor, CoupledPair, Coupling};
use crate::particles::Field;
use crate::scalar::Real;
use crate::tensor::{Matrix, Vector};
use std::sync::Arc;

/// Skin of the lists of pairs in mean spacings.
const SKIN: f64 = 0.4;
/// Distance in spacings that a pair has at least, as far as its approach is concerned.
pub(crate) const NEAREST: f64 = 0.5;

/// Two bodies, a body and itself, or a body and a wall of particles, that act on each other by forces between their
/// particles.
#[derive(Clone, Debug)]
pub(crate) struct Couple<T: Real, const D: usize> {
    pub coupling: Arc<dyn Coupling<T, D>>,
    /// A body, and a body or a wall.
    pub sides: [Side<D>; 2],
    /// Their scene indices.
    pub indices: [usize; 2],
    /// How near particles act on each other \[m\].
    pub reach: f64,
    /// Pairs of a body with itself that are nearer than this as built \[m\] do not.
    pub exclusion: f64,
    /// Where particles are as built \[m\], where pairs are chosen by that.
    pub reference: [Vec<[f64; D]>; 2],
    /// The harmonic mean of ρc² of both sides \[Pa\]; no number before the first evaluation.
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
    /// Its largest stable step \[s\].
    pub step: f64,
    /// The force \[N\] on particles of both sides, by their numbers in the body.
    pub forces: [Vec<(u32, [T; D])>; 2],
    /// Σ F_a r_b \[N m\] of forces on the first side and places as seen from the particle of a wall: the surface that they act
    /// at is that far from it.
    pub moments: Matrix<f64, D>,
    /// Anchors of pairs \[m\], in the order of the numbers of their particles.
    pub anchors: Vec<([u64; 2], Anchor<T, D>)>,
    /// Energy that it stores \[J\].
    pub stored: f64,
    /// Heat since the start \[J\].
    pub heat: f64,
    /// Penetration in mean spacings: now, and the largest since the start.
    pub penetration: [f64; 2],
    /// Pairs that act.
    pub pairs: usize,
    /// The force \[N\] of boundaries on both sides, by images, boundary by boundary; images of a wall count as the wall.
    pub images: [Vec<[f64; D]>; 2],
    /// When it was \[s\].
    pub time: f64,
}

impl<T, const D: usize> Default for Acting<T, D> {
    fn default() -> Self {
        Self {
            force: [0.0; D],
            step: f64::INFINITY,
            forces: [Vec::new(), Vec::new()],
            moments: Matrix::zeros(),
            anchors: Vec::new(),
            stored: 0.0,
            heat: 0.0,
            penetration: [0.0; 2],
            pairs: 0,
            images: [Vec::new(), Vec::new()],
            time: f64::NAN,
        }
    }
}

impl<T: Real, const D: usize> Couple<T, D> {
    /// Whether it is of a body with itself.
    pub fn is_self(&self) -> bool {
        let [first, second] = self.sides.each_ref().map(Side::body);
        first == second
    }

    /// The mean spacing \[m\].
    pub fn spacing(&self, groups: &[Group<T, D>]) -> f64 {
        let [first, second] = self.sides.each_ref().map(|side| side.spacing(groups));
        0.5 * (first + second)
    }

    /// What its forces on a side work in a kick over `dt` \[s\] \[J\].
    pub fn work_in_kick(&self, side: usize, groups: &[Group<T, D>], dt: f64) -> f64 {
        let group = match &self.sides[side] {
            Side::Body { group, .. } => &groups[*group],
            Side::Wall(wall) => return -dt * self.power_of_wall(wall),
        };
        let columns = &group.particles.columns;
        let (mass, v) = (columns.raw(Field::MASS), columns.vectors(Field::VELOCITY));
        let forces = &self.acting.forces[side];
        let power = over(0..forces.len(), |k| {
            let (id, force) = (forces[k].0, forces[k].1.map(Real::to_f64));
            let Some((_, slot)) = self.sides[side].slot(id, groups) else {
                return 0.0;
            };
            // Where a group sub-cycles, the kick is that of couplings alone.
            let Some(apart) = group.force_apart(slot) else {
                return group.work.power(columns, &force, slot, 0.5 * dt);
            };
            power(
                &force,
                &core::array::from_fn(|d| {
                    let a = (apart[d] / mass[slot]).to_f64();
                    v[slot][d].to_f64() + 0.5 * dt * a
                }),
            )
        });
        dt * power
    }

    /// Power \[W\] of a wall on the body, whose particles it meets where they are: friction measures its way there.
    pub fn power_of_wall(&self, wall: &MetWall<D>) -> f64 {
        let pose = wall.pose(self.acting.time);
        let forces = &self.acting.forces[1];
        let taken = over(0..forces.len(), |k| {
            power(&forces[k].1, &wall.velocity(&pose, forces[k].0 as usize))
        });
        let turning = pose.velocity_gradient();
        -taken + turning.map_or(0.0, |l| l.dot(&self.acting.moments))
    }

    /// The stiffness, at the first evaluation.
    fn stiffen(&mut self, groups: &[Group<T, D>]) {
        if self.stiffness.is_nan() {
            let [a, b] = self.sides.each_ref().map(|side| side.stiffness(groups));
            self.stiffness = 2.0 / (1.0 / a + 1.0 / b);
        }
    }

    /// Forces between all pairs within reach, on the groups of both sides.
    pub fn act(&mut self, groups: &mut [Group<T, D>], approach: f64, time: f64) {
        self.stiffen(groups);
        if !self.list_serves(groups, time) {
            self.list(groups, time);
        }
        let boundaries = &groups[0].boundaries;
        let boundary_count = boundaries.len();
        self.list.images.chains.place(boundaries, time);
        let spacing = self.spacing(groups);
        let mut list = core::mem::take(&mut self.list);
        self.see(&mut list, groups, time);
        let as_built = self.coupling.as_built();
        let reach = if as_built { f64::INFINITY } else { self.reach };
        let gap = |x: &[T; D], y: &[T; D]| -> f64 {
            let square = (0..D).map(|d| (x[d].to_f64() - y[d].to_f64()).powi(2));
            square.sum::<f64>().sqrt()
        };
        let is_self = self.is_self();
        let with_wall = self.sides[1].is_wall();
        let acting = &mut self.acting;
        if let Side::Wall(wall) = &self.sides[1]
            && let Some(carried) = wall.carries([acting.time, time])
        {
            carry(&mut acting.anchors, carried);
        }
        acting.time = time;
        // Stored, and heat.
        let mut energies = Collective::new();
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
                    energies.add([stored, 0.0]);
                }
            }
            for row in 0..list.particles.len() {
                let Some([source, chain]) = list.image_rows[row] else {
                    continue;
                };
                let Some(source) = list.particles.get(source as usize).copied() else {
                    continue;
                };
                let turn = &list.images.chains.transforms[chain as usize].rotation;
                let own = &mut list.particles[row];
                (own.sum, own.pressure) = (source.sum, source.pressure);
                own.gradient = (turn * Vector::from(source.gradient)).into();
            }
        }
        let (mut mutual, mut moments) = (Collective::new(), Collective::new());
        acting.step = f64::INFINITY;
        acting.pairs = 0;
        acting.penetration[0] = 0.0;
        for given in &mut list.given {
            given.clear();
            given.resize(boundary_count, Collective::new());
        }
        list.forces.clear();
        list.forces.resize(list.rows.len(), [T::zero(); D]);
        list.anchors.clear();
        let second = usize::from(!is_self);
        let mut before = acting.anchors.iter().peekable();
        for &[a, b] in &list.pairs {
            let [on, from] = [a, b].map(|row| list.particles[row as usize]);
            let distance = gap(&on.position, &from.position);
            if distance >= reach || distance.is_nan() {
                continue;
            }
            let numbers = [a, b].map(|row| list.rows[row as usize]);
            let ids =
                [(0, numbers[0]), (second, numbers[1])].map(|(side, id)| list.images.key(side, id));
            let chains = [a, b].map(|row| list.image_rows[row as usize].map(|own| own[1] as usize));
            // With an image it is half of a pair, whose other half is listed too.
            let share = if chains == [None; 2] { 1.0 } else { 0.5 };
            while before.peek().is_some_and(|own| own.0 < ids) {
                before.next();
            }
            let rest = if as_built {
                let at = |side: usize| list.listed[side.min(second)].places[numbers[side] as usize];
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
            energies.add([share * own.stored, share * own.heat]);
            if let Some(anchor) = own.anchor {
                list.anchors.push((ids, anchor));
            }
            acting.penetration[0] = acting.penetration[0].max(1.0 - distance / spacing);
            if own.force.iter().any(|force| *force != T::zero()) {
                acting.pairs += 1;
            }
            let force = own.force.map(Real::to_f64);
            let part = |chain: usize| {
                if second == 0 {
                    return ([0.0; D], force);
                }
                let turn = &list.images.chains.transforms[chain].rotation;
                shared_with_image(force, |d, k| turn[(d, k)].to_f64())
            };
            let mut give = |side: usize, chain: usize, force: [f64; D]| {
                list.given[side][list.images.boundary(chain)].add(force);
            };
            if with_wall && chains[1].is_none() {
                let apart = Vector::<f64, D>::from_fn(|d, _| {
                    on.position[d].to_f64() - from.position[d].to_f64()
                });
                let moment: [[f64; D]; D] = (Vector::from(force) * apart.transpose()).into();
                moments.add(moment);
            }
            match chains {
                [None, None] => mutual.add(force),
                [None, Some(_)] if with_wall => mutual.add(force),
                // The other half of the pair has an image of the wall.
                [Some(_), _] if with_wall => {}
                [None, Some(chain)] => {
                    let (own, given) = part(chain);
                    mutual.add(own);
                    give(0, chain, given);
                }
                // What the first side feels of the other half of the pair is counted there.
                [Some(chain), _] => give(second, chain, part(chain).1.map(|force| -force)),
            }
            for d in 0..D {
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
        let [stored, heat] = energies.value();
        (acting.stored, acting.heat) = (stored, acting.heat + heat);
        acting.moments = moments.value().into();
        acting.force = if is_self { [0.0; D] } else { mutual.value() };
        for (images, given) in acting.images.iter_mut().zip(&list.given) {
            images.clear();
            images.extend(given.iter().map(Collective::value));
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
            if let Some((group, slot)) = self.sides[side].slot(id, groups) {
                groups[group].push(slot, force);
            } else if !self.sides[side].is_wall() {
                continue;
            }
            self.acting.forces[side].push((id, force));
        }
    }

    /// Reads the particles of all rows.
    fn see(&self, list: &mut PairList<T, D>, groups: &[Group<T, D>], time: f64) {
        let poses = self.sides.each_ref().map(|side| side.pose(time));
        let stiffness = T::from_f64(self.stiffness);
        list.particles.clear();
        for (row, &id) in list.rows.iter().enumerate() {
            let side = usize::from(row >= list.split);
            let (id, chain) = list.images.source(side, id);
            let own = (&poses[side], &list.listed[side]);
            let mut particle = self.sides[side].see(id, own.0, own.1, groups);
            if let Some(chain) = chain {
                let own = &list.images.chains.transforms[chain];
                particle.position = own.point(&particle.position);
                particle.velocity = own.velocity_of(&particle.velocity);
            }
            particle.stiffness = stiffness;
            list.particles.push(particle);
        }
    }

    /// Whether no particle has moved so far that the list could miss a pair.
    fn list_serves(&self, groups: &[Group<T, D>], time: f64) -> bool {
        if self.list.listed[0].places.is_empty() {
            return false;
        }
        if self.coupling.as_built() {
            return true;
        }
        let times = [self.list.time, time];
        let moved = |side: usize| self.sides[side].gone(&self.list.listed[side], groups, times);
        let first = moved(0);
        let second = if self.is_self() { first } else { moved(1) };
        let boundaries: &[Arc<dyn Boundary<D>>] = &groups[0].boundaries;
        let carried = self.list.images.chains.carried(boundaries, times);
        first + second + carried <= self.list.skin
    }

    /// Lists pairs that may be within reach before particles have moved by half the skin.
    pub fn list(&mut self, groups: &[Group<T, D>], time: f64) {
        let mut list = core::mem::take(&mut self.list);
        let skin = SKIN * self.spacing(groups);
        list.skin = skin;
        let as_built = self.coupling.as_built();
        let reach = self.reach + if as_built { 0.0 } else { skin };
        // Images of places as built are those of the scene as built.
        list.time = if as_built { 0.0 } else { time };
        let boundaries = &groups[0].boundaries;
        list.images.clear();
        for side in 0..if self.is_self() { 1 } else { 2 } {
            let listed = &mut list.listed[side];
            if as_built {
                listed.places.clone_from(&self.reference[side]);
            } else {
                self.sides[side].list(listed, groups, time);
            }
            let places = &mut listed.places;
            list.images
                .add(side, places, boundaries, (reach, list.time));
        }
        list.find(self.is_self(), reach);
        if self.is_self() && self.exclusion > 0.0 {
            let (rest, least) = (&self.reference[0], self.exclusion);
            list.images.chains.place(boundaries, 0.0);
            let images = &list.images;
            let built = |id: u32| match images.source(0, id) {
                (id, None) => rest[id as usize],
                (id, Some(chain)) => {
                    let image =
                        images.chains.transforms[chain].point(&rest[id as usize].map(T::from_f64));
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
