//! Questions about particles: by body or wall, in the order in which the scene placed them.
//! Values come out as `f64`, whatever the scalar of the simulation.

use super::Simulation;
use super::group::Group;
use super::population::{BodyState, Passed};
use super::side::Side;
use super::walls::WallState;
use super::which::{Which, find};
use crate::boundary::Pose;
use crate::error::Result;
use crate::material::Material;
use crate::material::eos::GuardCounts;
use crate::origin::{global, local};
use crate::particles::{Field, Shape};
use crate::scalar::{InstructionSet, Real};
use crate::scheme::Scheme;
use std::ops::Range;

/// A particle as it is now.
#[derive(Clone, Copy, Debug)]
pub struct ParticleView<'a, T: Real, const D: usize> {
    pub(super) group: &'a Group<T, D>,
    pub(super) slot: usize,
}

impl<T: Real, const D: usize> ParticleView<'_, T, D> {
    /// Its number in the whole simulation, which never changes.
    #[must_use]
    pub fn id(&self) -> usize {
        self.group.particles.first_id + self.group.particles.ids[self.slot] as usize
    }
    /// Whether it belongs to a body and not to a wall.
    pub(crate) fn is_mobile(&self) -> bool {
        self.slot < self.group.particles.mobile
    }
    /// Position \[m\] in the scene.
    #[must_use]
    pub fn position(&self) -> [f64; D] {
        self.group.particles.position(self.slot)
    }
    /// Velocity \[m/s\].
    #[must_use]
    pub fn velocity(&self) -> [f64; D] {
        self.group.particles.columns.vectors(Field::VELOCITY)[self.slot].map(Real::to_f64)
    }
    /// Acceleration \[m/s²\] at the last evaluation, by pairs, walls, couplings and loads; zero for particles of walls.
    #[must_use]
    pub fn acceleration(&self) -> [f64; D] {
        if !self.is_mobile() {
            return [0.0; D];
        }
        let coupled = self.group.force_apart(self.slot);
        let mass = self.group.particles.columns.raw(Field::MASS);
        core::array::from_fn(|d| {
            let own = self
                .group
                .work
                .acceleration(mass, self.slot * D + d)
                .to_f64();
            own + coupled.map_or(0.0, |force| force[d].to_f64() / self.mass())
        })
    }
    /// A scalar field, or `None` if the particle does not carry it or it is no scalar.
    #[must_use]
    pub fn scalar(&self, field: Field) -> Option<f64> {
        if field.shape() != Shape::Scalar {
            return None;
        }
        let column = self.group.particles.columns.raw(field);
        column.get(self.slot).map(|value| value.to_f64())
    }
    /// Density \[kg/m³\].
    #[must_use]
    pub fn density(&self) -> f64 {
        self.scalar(Field::DENSITY).unwrap_or(0.0)
    }
    /// Pressure \[Pa\], positive in compression.
    #[must_use]
    pub fn pressure(&self) -> f64 {
        self.scalar(Field::PRESSURE).unwrap_or(0.0)
    }
    /// Specific internal energy \[J/kg\], zero if it is not carried.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.scalar(Field::ENERGY).unwrap_or(0.0)
    }
    /// Mass \[kg\] (kg/m² in 1D, kg/m in 2D).
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.scalar(Field::MASS).unwrap_or(0.0)
    }
    /// Smoothing length \[m\].
    #[must_use]
    pub fn smoothing_length(&self) -> f64 {
        self.scalar(Field::SMOOTHING_LENGTH)
            .unwrap_or(self.group.neighborhood.smoothing_length)
    }
}

/// A wall, and the group of a liquid that meets it.
type OfWall<'a, T, const D: usize> = (&'a Group<T, D>, &'a WallState<T, D>);

/// The particles of a body or of a wall, in the order in which the scene placed them.
#[derive(Clone, Debug)]
pub struct ParticleViews<'a, T: Real, const D: usize> {
    group: &'a Group<T, D>,
    /// Where those are that are still to come.
    slots: core::slice::Iter<'a, u32>,
}

impl<'a, T: Real, const D: usize> ParticleViews<'a, T, D> {
    /// Those with some of the numbers that the group has given.
    pub(super) fn new(group: &'a Group<T, D>, ids: Range<usize>) -> Self {
        let slots = group.particles.slot_of[ids].iter();
        Self { group, slots }
    }

    /// Those of a body.
    pub(super) fn of_body((group, body): (&'a Group<T, D>, &BodyState<T>)) -> Self {
        Self::new(group, body.ids.clone())
    }
}

impl<'a, T: Real, const D: usize> Iterator for ParticleViews<'a, T, D> {
    type Item = ParticleView<'a, T, D>;

    fn next(&mut self) -> Option<Self::Item> {
        // Those that have left are nowhere.
        let slot = self.slots.find(|&&slot| slot != u32::MAX)?;
        Some(ParticleView {
            group: self.group,
            slot: *slot as usize,
        })
    }
}

impl<T: Real, const D: usize> Simulation<T, D> {
    /// The place \[m\] in the scene from which columns of places count: see [place](crate::scene#place).
    #[must_use]
    pub fn origin(&self) -> [f64; D] {
        self.state.own().groups[0].particles.origin
    }

    /// Number of particles.
    #[must_use]
    pub fn particles(&self) -> usize {
        let all = |own: &Group<T, D>| match &own.all {
            Some(all) => all.particles.count(),
            None => own.particles.count(),
        };
        self.state.own().groups.iter().map(all).sum()
    }

    /// Every body with its group, in the order of the scene.
    pub(super) fn all_bodies(&self) -> impl Iterator<Item = (&Group<T, D>, &BodyState<T>)> + Clone {
        let groups = self.state.groups.iter();
        groups.flat_map(|group| group.particles.bodies.iter().map(move |body| (group, body)))
    }

    pub(super) fn body_count(&self) -> usize {
        self.state
            .groups
            .iter()
            .map(|group| group.particles.bodies.len())
            .sum()
    }

    /// Names of the bodies, in the order of the scene: those of its own scheme, then those of other
    /// [groups](crate::scene::Scene::group).
    pub fn bodies(&self) -> impl Iterator<Item = &str> + Clone {
        self.all_bodies().map(|(_, body)| body.name.as_str())
    }

    /// The particles of a body in the order in which the scene placed them; those that have left through an outlet
    /// are missing.
    ///
    /// # Errors
    /// If there is no such body; the error lists those that there are.
    pub fn body(&self, body: impl Which) -> Result<ParticleViews<'_, T, D>> {
        let all = self.all_bodies().map(|own| (&own.1.name, own));
        let (_, found) = find(&body, "body", all)?;
        Ok(ParticleViews::of_body(found))
    }

    /// The material of a body, and its spacing as built \[m\].
    pub(crate) fn material_and_spacing(&self, body: impl Which) -> Result<(&Material<T>, f64)> {
        let all = self.all_bodies().map(|own| (&own.1.name, own));
        let (_, (_, own)) = find(&body, "body", all)?;
        Ok((&own.material, own.spacing))
    }

    /// Sets every velocity \[m/s\] as a function of position \[m\] and present velocity, between steps.
    pub fn set_velocities(&mut self, velocity: impl Fn([f64; D], [f64; D]) -> [f64; D]) {
        for group in &mut self.state.groups {
            for slot in 0..group.particles.mobile {
                let now = ParticleView { group, slot };
                let next = velocity(now.position(), now.velocity());
                group.particles.columns.vectors_mut(Field::VELOCITY)[slot] = next.map(T::from_f64);
            }
        }
        self.forget_rates();
    }

    /// All particles, body after body.
    pub fn all(&self) -> impl Iterator<Item = ParticleView<'_, T, D>> {
        self.all_bodies().flat_map(ParticleViews::of_body)
    }

    pub(super) fn wall_count(&self) -> usize {
        let walls = self.state.groups.iter().flat_map(|group| &group.walls);
        let indices = walls
            .filter(|wall| wall.structure.is_none())
            .map(|wall| wall.index + 1);
        indices.max().unwrap_or(0)
    }

    /// A wall of the scene by its index, and the first group of liquids that meets it.
    pub(super) fn find_wall(&self, index: usize) -> Option<OfWall<'_, T, D>> {
        self.state.groups.iter().find_map(|group| {
            let own = |wall: &&WallState<T, D>| wall.structure.is_none() && wall.index == index;
            Some((group, group.walls.iter().find(own)?))
        })
    }

    /// Every wall with the first group of liquids that meets it, in the order of the scene.
    pub(super) fn all_walls(&self) -> impl Iterator<Item = OfWall<'_, T, D>> + Clone {
        (0..self.wall_count()).filter_map(|index| self.find_wall(index))
    }

    /// The index and the state of a wall.
    pub(super) fn wall_of(&self, wall: &impl Which) -> Result<(usize, OfWall<'_, T, D>)> {
        find(wall, "wall", self.all_walls().map(|own| (&own.1.name, own)))
    }

    /// Names of the walls, in the order of the scene, then those of the buffers of inlets.
    pub fn walls(&self) -> impl Iterator<Item = &str> + Clone {
        self.all_walls().map(|(_, wall)| wall.name.as_str())
    }

    /// The particles of a wall in the order in which the scene placed them; in a scene of several liquids as the first
    /// of them meets it.
    ///
    /// # Errors
    /// If there is no such wall; the error lists those that there are.
    pub fn wall(&self, wall: impl Which) -> Result<ParticleViews<'_, T, D>> {
        let (_, (group, wall)) = self.wall_of(&wall)?;
        Ok(ParticleViews::new(group, wall.slots.clone()))
    }

    /// Where a wall is now: the pose of its motion; at rest without one.
    ///
    /// # Errors
    /// If there is no such wall; the error lists those that there are.
    pub fn wall_pose(&self, wall: impl Which) -> Result<Pose<D>> {
        let (_, (_, wall)) = self.wall_of(&wall)?;
        let motion = wall.motion.as_ref();
        // The motion is in places that are counted from the origin.
        let back = self.origin().map(|x| -x);
        let pose = motion.map(|motion| motion.pose_from(&back, self.state.time));
        Ok(pose.unwrap_or_else(Pose::rest))
    }

    /// The groups that observers read: those of liquids, which meet all other bodies as walls, or all.
    pub(super) fn observed(&self) -> impl Iterator<Item = &Group<T, D>> {
        let is_liquid = |group: &Group<T, D>| group.scheme.meets_walls();
        let any = self.state.groups.iter().any(is_liquid);
        self.state
            .groups
            .iter()
            .filter(move |group| !any || is_liquid(group))
    }

    /// Shows every particle, of bodies and walls, and every image of one, that is within reach of a place, with the number of
    /// that place and where it is \[m\]; places and reaches \[m\] are pairs. Once over all particles, however many places
    /// there are.
    pub(crate) fn near(
        &self,
        places: &[([f64; D], f64)],
        mut visit: impl FnMut(usize, ParticleView<'_, T, D>, [f64; D]),
    ) {
        // Most particles are outside of the box around all places, and no more is looked at then.
        let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for (x, reach) in places {
            for d in 0..D {
                low[d] = low[d].min(x[d] - reach);
                high[d] = high[d].max(x[d] + reach);
            }
        }
        for group in self.observed() {
            let walls = group.walls.iter().map(|wall| wall.slots.clone());
            let bodies = group.particles.bodies.iter().map(|body| body.slots.clone());
            let positions = group.particles.columns.vectors(Field::POSITION);
            let origin = &group.particles.origin;
            let [low, high] = [low, high].map(|corner| local(&corner, origin));
            for slots in bodies.chain(walls) {
                for (slot, x) in slots.clone().zip(&positions[slots]) {
                    if (0..D).any(|d| !(low[d]..=high[d]).contains(&x[d].to_f64())) {
                        continue;
                    }
                    for (k, (place, reach)) in places.iter().enumerate() {
                        let place = local(place, origin);
                        let r2: f64 = (0..D).map(|d| (x[d].to_f64() - place[d]).powi(2)).sum();
                        if r2 < reach * reach {
                            let particle = ParticleView { group, slot };
                            visit(k, particle, particle.position());
                        }
                    }
                }
            }
        }
        if !self.state.groups[0].boundaries.is_empty() {
            self.images_near(places, visit);
        }
    }

    /// The same of images.
    fn images_near(
        &self,
        places: &[([f64; D], f64)],
        mut visit: impl FnMut(usize, ParticleView<'_, T, D>, [f64; D]),
    ) {
        let most = places
            .iter()
            .fold(0.0_f64, |most, (_, reach)| most.max(*reach));
        let mut images = Vec::new();
        for group in self.observed() {
            let walls = group.walls.iter().map(|wall| wall.slots.clone());
            let bodies = group.particles.bodies.iter().map(|body| body.slots.clone());
            for slot in bodies.chain(walls).flatten() {
                let particle = ParticleView { group, slot };
                self.images_of(&particle.position(), most, &mut images);
                for image in &images {
                    for (k, (place, reach)) in places.iter().enumerate() {
                        let r2: f64 = (0..D).map(|d| (image.at[d] - place[d]).powi(2)).sum();
                        if r2 < reach * reach {
                            visit(k, particle, image.at);
                        }
                    }
                }
            }
        }
    }

    /// The force \[N\] of the bodies on every wall particle at the last evaluation, with its position
    /// \[m\]: the forces on the bodies with the opposite sign. A sweep over the walls, when asked for.
    /// Structures are walls to the liquids of a scene; what solids press on walls by contact comes after.
    #[must_use]
    pub fn wall_particle_forces(&self) -> Vec<([f64; D], [f64; D])> {
        let mut forces = Vec::new();
        for group in &self.state.groups {
            let at = |(slot, force)| (group.particles.position(slot), force);
            forces.extend(group.forces_on_walls().into_iter().flatten().map(at));
        }
        for couple in &self.state.couples {
            let Side::Wall(wall) = &couple.sides[1] else {
                continue;
            };
            let pose = wall.pose(couple.acting.time);
            forces.extend(couple.acting.forces[1].iter().map(|(id, force)| {
                let x = global(&pose.of(0, &wall.rest[*id as usize]), &self.origin());
                (x, force.map(Real::to_f64))
            }));
        }
        forces
    }

    /// What has left through outlets.
    #[must_use]
    pub fn removed(&self) -> Passed<D> {
        let removed = self
            .state
            .groups
            .iter()
            .map(|group| &group.particles.removed);
        removed.fold(Passed::default(), |sum, other| sum.and(other))
    }

    /// Smoothing length \[m\] as built, of the first group of liquids or, without one, of the first body.
    #[must_use]
    pub fn smoothing_length(&self) -> f64 {
        self.observed()
            .next()
            .map_or(0.0, |group| group.neighborhood.smoothing_length)
    }

    /// How far the kernel of that group reaches \[m\].
    pub(crate) fn reach(&self) -> f64 {
        let group = self.observed().next();
        group.map_or(0.0, |group| {
            group.scheme.kernel.support * group.neighborhood.smoothing_length
        })
    }

    /// Spacing \[m\] of the first body, or of the first liquid body of a scene with liquids.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        let first = self
            .observed()
            .find_map(|group| group.particles.bodies.first());
        first.map_or(0.0, |body| body.spacing)
    }

    /// Counts of what guards did, by kind, since the start.
    #[must_use]
    pub fn guard_counts(&self) -> GuardCounts {
        self.state
            .groups
            .iter()
            .fold(GuardCounts::default(), |mut sum, group| {
                sum += group.guards;
                sum
            })
    }

    /// Limits that laws and updates have applied since the start, in the order of their names, in particle steps or evaluations: smoothing
    /// lengths held at a limit, densities of cavitated liquid held from thinning out further, gas whose internal energy is
    /// negative: a few ahead of a strong shock do no harm, many say that the viscosity is too weak or the step too long.
    #[must_use]
    pub fn limits(&self) -> Vec<(&'static str, u64)> {
        let mut all: Vec<(&'static str, u64)> = Vec::new();
        for (name, count) in self.state.groups.iter().flat_map(|group| &group.limited) {
            match all.iter_mut().find(|own| own.0 == *name) {
                Some(own) => own.1 += count,
                None => all.push((name, *count)),
            }
        }
        // Whichever acted first.
        all.sort_unstable();
        all
    }

    /// How often the limit with a name was applied; zero if it never was.
    #[must_use]
    pub fn limited(&self, name: &str) -> u64 {
        let limits = self.limits();
        limits
            .iter()
            .find(|own| own.0 == name)
            .map_or(0, |own| own.1)
    }

    /// Smoothing lengths that were held at a limit, in particle evaluations since the start.
    #[must_use]
    pub fn limited_smoothing_lengths(&self) -> u64 {
        let limits = self.limits().into_iter();
        let own = limits.filter(|(name, _)| name.starts_with("smoothing"));
        own.map(|(_, count)| count).sum()
    }

    /// Builds of the neighbour lists since the start.
    #[must_use]
    pub fn list_builds(&self) -> u64 {
        let groups = self.after_step().groups.iter();
        groups.map(|group| group.neighborhood.rebuilds).sum()
    }

    /// Steps of all groups that sub-cycle since the start; see [`Scene::sub_cycle`](crate::scene::Scene::sub_cycle).
    #[must_use]
    pub fn sub_steps(&self) -> u64 {
        let groups = self.after_step().groups.iter();
        groups.map(Group::sub_steps).sum()
    }

    /// Bytes held for particles, lists and records of the run. While a state [between two steps](crate::simulation#readings)
    /// is shown, or one that was [evaluated](Self::evaluate) between them, there are twice as many but for the lists. On
    /// [ranks](crate::ranks) those of this rank, without what it has read from others.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.state.own().groups.iter().map(Group::bytes).sum()
    }

    /// The scheme of the bodies: that of the scene itself, whose first group they are.
    #[must_use]
    pub fn scheme(&self) -> &Scheme<T, D> {
        &self.state.own().groups[0].scheme
    }

    /// The schemes of all groups, that of the scene first.
    pub fn schemes(&self) -> impl Iterator<Item = &Scheme<T, D>> {
        let groups = self.state.own().groups.iter();
        groups.map(|group| &*group.scheme)
    }

    /// The instruction set that its pair loops run on.
    pub(crate) fn instructions(&self) -> InstructionSet {
        self.state.own().groups[0].instructions.or_detected()
    }

    /// The integrator's name.
    #[must_use]
    pub fn integrator_name(&self) -> String {
        self.integrator.name()
    }
}
