//! The plan of a group: the bodies of a scene that share a scheme, with the walls that they meet.
//! It is what the checks look at, and it lays out the columns from which a simulation starts.

use super::numerics::{FOLLOWING_SKINS, SKINS};
use super::{Body, Part, Scene};
use crate::boundary::{Emitter, Inflow, Inlet, Slip, Wall, boundary_from, motion_from};
use crate::origin::local;
use crate::particles::{Columns, Field, Fields};
use crate::ranks::Team;
use crate::scalar::{Real, width};
use crate::scheme::{Scheme, Smoothing};
use crate::simulation::{BodyState, Exchange, Group, Particles, Spins, Structure, WallState};
use crate::sweep::Interaction;
use std::sync::Arc;

/// Where a wall of a group comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// A wall of the scene, or the buffer of an inlet, by its number among them.
    Wall(usize),
    /// A body of another group, by the numbers of both.
    Structure(usize, usize),
}

/// The plan of a group.
pub(super) struct Plan<'a, T: Real, const D: usize> {
    pub scene: &'a Scene<T, D>,
    pub scheme: &'a Arc<Scheme<T, D>>,
    pub bodies: &'a [Body<T, D>],
    /// Its number among the groups.
    number: usize,
    /// Walls of the scene, then structures.
    pub walls: Vec<(Wall<D>, Origin)>,
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// The plans of all groups.
    pub(super) fn plans(&self) -> impl Iterator<Item = Plan<'_, T, D>> {
        (0..self.parts.len()).map(|number| self.plan(number))
    }

    fn plan(&self, number: usize) -> Plan<'_, T, D> {
        self.plan_of(number, &self.parts[number].scheme)
    }

    /// The plan of a group if it obeyed a scheme, as its own or as one that comes later.
    pub(super) fn plan_of<'a>(
        &'a self,
        number: usize,
        scheme: &'a Arc<Scheme<T, D>>,
    ) -> Plan<'a, T, D> {
        let part = &self.parts[number];
        let is_liquid = |part: &Part<T, D>| part.scheme.meets_walls();
        let mut walls = Vec::new();
        // Without a liquid they stand in the first group, which does not feel them.
        if is_liquid(part) || (number == 0 && !self.parts.iter().any(is_liquid)) {
            let own = self.walls.iter().enumerate();
            walls.extend(own.map(|(k, wall)| (wall.clone(), Origin::Wall(k))));
        }
        if is_liquid(part) {
            for (k, other) in self.parts.iter().enumerate() {
                if !is_liquid(other) {
                    let structures = other.bodies.iter().enumerate();
                    let met =
                        structures.filter(|(_, body)| self.wall_coupling_of(part, body).is_some());
                    walls.extend(met.map(|(b, body)| (as_wall(body), Origin::Structure(k, b))));
                }
            }
        }
        Plan {
            scene: self,
            scheme,
            bodies: &part.bodies,
            number,
            walls,
        }
    }
}

/// A body as the wall that liquids of other groups meet.
fn as_wall<T: Real, const D: usize>(body: &Body<T, D>) -> Wall<D> {
    let wall = Wall::of(&body.name, body.points.clone(), body.spacing);
    match body.slip {
        Slip::None => wall.no_slip(),
        Slip::Free => wall,
    }
}

impl<T: Real, const D: usize> Plan<'_, T, D> {
    /// Inlets of its bodies, with their numbers in the scene.
    pub fn inlets(&self) -> impl Iterator<Item = (usize, &Inlet<D>)> {
        let own = |inlet: &Inlet<D>| self.bodies.iter().any(|body| body.name == inlet.body);
        let all = self.scene.inlets.iter().enumerate();
        all.filter(move |(_, inlet)| own(inlet))
    }

    /// Lays the group out, with places counted from an origin \[m\]. Ranks lay their own particles out alone where they `part` and the
    /// group may.
    pub fn lay_out(
        mut self,
        origin: [f64; D],
        team: Option<&Arc<Team>>,
        part: bool,
    ) -> Group<T, D> {
        let mut group = self.without_numbers(origin);
        if let Some(team) = team {
            group.share(team);
        }
        let parts = part && group.begin_apart(|group, runs| self.fill(group, runs));
        if !parts {
            let all = 0..group.particles.columns.slots();
            group.particles.columns = self.fill(&group, &[all]);
        }
        self.scene.hold(self.number, &mut group);
        group
    }

    /// The group before any number of a particle is there, with a column for each field that the scheme or a contact names.
    pub fn without_numbers(&mut self, origin: [f64; D]) -> Group<T, D> {
        let (emitters, inflows) = self.place_inlets(&origin);
        let interactions = self.interactions();
        let unilateral = interactions.contains(&Interaction::Unilateral);
        let fields_of = |scheme: &Scheme<T, D>| {
            let fields = self.scene.fields_of(scheme, self.bodies);
            if !unilateral {
                return fields;
            }
            fields.union(Fields::of(&[
                Field::CONTACT_ACTIVITY,
                Field::CONTACT_THRESHOLD,
            ]))
        };
        let fields = fields_of(self.scheme);
        let exchanges = self.exchanges(fields_of);
        let width = width::<T>();
        let counts = self.bodies.iter().map(|body| self.capacity(body));
        let slots = counts
            .chain(self.walls.iter().map(|(wall, _)| wall.points.len()))
            .map(|count| count.next_multiple_of(width))
            .sum();
        let mut bodies = Vec::new();
        let mut start = 0;
        for body in self.bodies {
            let own = start..start + body.points.len();
            let ids = start..start + self.capacity(body);
            start = ids.end.next_multiple_of(width);
            bodies.push(BodyState {
                name: body.name.clone(),
                material: body.material.clone(),
                ids,
                slots: own,
                end: start,
                spacing: body.spacing,
            });
        }
        let mut walls = Vec::new();
        for (wall, from) in &self.walls {
            let own = start..start + wall.points.len();
            start = own.end.next_multiple_of(width);
            walls.push(self.wall_state(wall, *from, own, start, &origin));
        }
        let widest = bodies
            .iter()
            .fold(0.0_f64, |most, body| most.max(body.spacing));
        let h = self.scheme.h_over_dx * widest;
        let support = self.scheme.kernel.support * h;
        let skins = self.skins().map(|skin| skin * support);
        let mobile = walls.first().map_or(slots, |wall| wall.slots.start);
        let boundaries = self.scene.boundaries.iter();
        let boundaries = boundaries.map(|own| boundary_from(own, &origin));
        let mut group = Group::new(
            Particles::new(
                Columns::without_numbers(fields, slots),
                bodies,
                mobile,
                origin,
            ),
            walls,
            boundaries.collect(),
            self.scheme.clone(),
            interactions,
            h,
            skins,
        );
        group.indices = self.indices();
        group.instructions = self.scene.instructions;
        group.root = self.scene.root;
        // What keeps its neighbours stays whole.
        if !self.scheme.density.keeps_neighbors() {
            let outlets = self.scene.outlets.iter();
            group.outlets = outlets.map(|own| own.seen_from(&origin)).collect();
        }
        group.emitters = emitters;
        (group.sources, group.drains) = (self.sources(&origin), self.drains());
        for (wall, inflow) in inflows {
            group.walls[wall].inflow = Some(inflow);
        }
        group.exchanges = exchanges;
        group.sub_cycle = self.scene.sub_cycle_of(self.number);
        group
    }

    /// The schemes that the group obeys one after another, with the fields that a particle carries under each; none if it has one.
    fn exchanges(&self, fields_of: impl Fn(&Scheme<T, D>) -> Fields) -> Vec<Exchange<T, D>> {
        let of = |event, scheme: &Arc<Scheme<T, D>>| Exchange {
            event,
            scheme: scheme.clone(),
            fields: fields_of(scheme),
        };
        let later = self.scene.exchanges_of(self.number).map(|own| {
            let event = self.scene.events.iter().position(|e| e.name == own.event);
            of(event, &own.scheme)
        });
        let mut all: Vec<_> = later.collect();
        if !all.is_empty() {
            all.insert(0, of(None, self.scheme));
        }
        all
    }

    /// Skins of the lists over the support: of lists that last, and of lists that do not.
    fn skins(&self) -> [f64; 2] {
        match self.scene.skin {
            Some(skin) => [skin; 2],
            // Images reach through a period as far as the check of the boundaries found room for.
            // Lengths that follow the density change in every step, and what a list holds too much of every sum looks at.
            None if matches!(self.scheme.smoothing, Smoothing::Consistent(_)) => FOLLOWING_SKINS,
            None if !self.scene.boundaries.is_empty() => [SKINS[0]; 2],
            None => SKINS,
        }
    }

    fn wall_state(
        &self,
        wall: &Wall<D>,
        from: Origin,
        slots: std::ops::Range<usize>,
        end: usize,
        origin: &[f64; D],
    ) -> WallState<T, D> {
        let (index, structure) = match from {
            Origin::Wall(index) => (index, None),
            Origin::Structure(group, body) => {
                let part = &self.scene.parts[self.number];
                let solid = &self.scene.parts[group].bodies[body];
                let coupling = self.scene.wall_coupling_of(part, solid);
                let apart = self.scene.sub_cycle_of(group);
                let apart = apart.map(|_| wall.points.len());
                (
                    0,
                    coupling.map(|coupling| Structure {
                        coupling,
                        group,
                        body,
                        accelerations: vec![[0.0; D]; wall.points.len()],
                        spins: match wall.slip {
                            Slip::None => Spins::new(&wall.points, wall.spacing),
                            Slip::Free => Spins::default(),
                        },
                        before: vec![[0.0; D]; apart.unwrap_or(0)],
                        evaluated: f64::NAN,
                        rigid: self.scene.rigid.contains(&solid.name),
                    }),
                )
            }
        };
        let normals = if self.scheme.program.wall_normals {
            wall.normals()
        } else {
            Vec::new()
        };
        WallState {
            name: wall.name.clone(),
            slots,
            end,
            rest: wall.points.iter().map(|x| local(x, origin)).collect(),
            normals: normals.into(),
            motion: wall.motion.as_ref().map(|own| motion_from(own, origin)),
            inflow: None,
            slip: wall.slip,
            sliding: wall.sliding,
            container_frame: wall.container_frame,
            mass: self.wall_mass(wall),
            index,
            structure,
        }
    }

    /// The scene indices of its bodies, walls and boundaries: bodies of all groups, then walls and the
    /// buffers of inlets, then boundaries.
    fn indices(&self) -> Vec<usize> {
        let scene = self.scene;
        let before = |number: usize| -> usize {
            scene.parts[..number]
                .iter()
                .map(|part| part.bodies.len())
                .sum()
        };
        let bodies = before(scene.parts.len());
        let boundaries = bodies + scene.walls.len() + scene.inlets.len();
        let first = before(self.number);
        let own = first..first + self.bodies.len();
        let walls = self.walls.iter().map(|(_, origin)| match *origin {
            Origin::Wall(index) => bodies + index,
            Origin::Structure(group, body) => before(group) + body,
        });
        own.chain(walls)
            .chain(boundaries..boundaries + scene.boundaries.len())
            .collect()
    }

    /// Particles that a body can have: those that it starts with, and what may enter.
    fn capacity(&self, body: &Body<T, D>) -> usize {
        body.points.len() + self.scene.reserve_of(&body.name)
    }

    /// Puts a buffer behind every inlet, before the structures, and returns what hands its layers over, and what moves buffers
    /// of other velocities, by the numbers of their walls.
    fn place_inlets(&mut self, origin: &[f64; D]) -> (Vec<Emitter<D>>, Vec<(usize, Inflow<D>)>) {
        let reach = self.scheme.kernel.support * self.scheme.h_over_dx;
        let is_wall = |(_, origin): &(Wall<D>, Origin)| matches!(origin, Origin::Wall(_));
        let structures = self.walls.partition_point(is_wall);
        let layers = reach.ceil() as usize + 1;
        let (mut buffers, mut emitters, mut inflows) = (Vec::new(), Vec::new(), Vec::new());
        for (k, inlet) in self.inlets() {
            let at = structures + buffers.len();
            buffers.push((
                inlet.buffer(layers),
                Origin::Wall(self.scene.walls.len() + k),
            ));
            let fed = self.bodies.iter().position(|body| body.name == inlet.body);
            let Some(fed) = fed else {
                continue;
            };
            let material = &self.bodies[fed].material;
            let (_, sound_speed) = material.state(material.reference_density(), 0.0);
            match inlet.inflow(layers, (fed, sound_speed), origin) {
                Some(inflow) => inflows.push((at, inflow)),
                None => emitters.push(inlet.emitter(fed, at, origin)),
            }
        }
        self.walls.splice(structures..structures, buffers);
        (emitters, inflows)
    }

    /// What every block does to every other: bodies, walls, images of bodies by boundary, and images of
    /// each wall by boundary.
    pub fn interactions(&self) -> Vec<Interaction> {
        if self.scheme.meets_walls() {
            return self.liquid_interactions();
        }
        let (bodies, boundaries) = (self.bodies.len(), self.scene.boundaries.len());
        let direct = bodies + self.walls.len();
        let blocks = direct * (1 + boundaries);
        // Solids meet walls of particles by couplings. Boundaries feel nothing, so their rows name no contact that a scene
        // would pay for.
        let mut all = vec![Interaction::None; blocks * blocks];
        for body in 0..bodies {
            all[body * blocks..body * blocks + bodies].fill(self.scheme.between);
        }
        let index = |name: &str| self.bodies.iter().position(|body| body.name == name);
        for k in 0..blocks {
            all[k * blocks + k] = Interaction::Bonded;
        }
        for own in &self.scene.couplings {
            if let (Some(a), Some(b)) = (index(&own.first), index(&own.second))
                && a != b
            {
                all[a * blocks + b] = Interaction::None;
                all[b * blocks + a] = Interaction::None;
            }
        }
        for (first, second, interaction) in &self.scene.contacts {
            if let (Some(a), Some(b)) = (index(first), index(second)) {
                all[a * blocks + b] = *interaction;
                all[b * blocks + a] = *interaction;
            }
        }
        for (k, boundary) in self.scene.boundaries.iter().enumerate() {
            for (body, of) in (0..bodies).flat_map(|body| (0..bodies).map(move |of| (body, of))) {
                // Bodies do across a period or a plane of symmetry what they do to each other.
                let own = all[body * blocks + of];
                all[body * blocks + direct + of * boundaries + k] = match boundary.interaction() {
                    Interaction::Bonded => own,
                    _ if own == Interaction::None => own,
                    other => other,
                };
            }
        }
        all
    }

    /// Liquids act on liquids and walls, and walls ask only for liquids. Nothing opens as a contact
    /// does: the floor of wall pressures and the cut-off of the material let liquids part.
    fn liquid_interactions(&self) -> Vec<Interaction> {
        let (bodies, walls) = (self.bodies.len(), self.walls.len());
        let boundaries = self.scene.boundaries.len();
        let direct = bodies + walls;
        let blocks = direct * (1 + boundaries);
        let images = |of: usize| direct + boundaries * of..direct + boundaries * (of + 1);
        let is_wall =
            |block: usize| (bodies..direct).contains(&block) || block >= images(bodies).start;
        let mut all = vec![Interaction::None; blocks * blocks];
        for on in 0..bodies + walls {
            for from in 0..blocks {
                if !(is_wall(on) && is_wall(from)) {
                    all[on * blocks + from] = Interaction::Bonded;
                }
            }
        }
        // Two bodies that do not meet, or a body and a structure, with the images of the structure.
        let blocks_of = |name: &str| -> Vec<usize> {
            let structure = |(wall, origin): &(Wall<D>, Origin)| {
                wall.name == name && matches!(origin, Origin::Structure(..))
            };
            let body = self.bodies.iter().position(|body| body.name == name);
            let wall = || self.walls.iter().position(structure);
            let found = body.or_else(|| Some(bodies + wall()?));
            found.map_or(Vec::new(), |own| images(own).chain([own]).collect())
        };
        let contacts = self.scene.contacts.iter();
        let apart = contacts.filter(|own| own.2 == Interaction::None);
        let apart = apart.map(|(first, second, _)| (first, second));
        let couplings = self.scene.couplings.iter();
        let by_force = couplings.filter(|own| !own.coupling.is_wall() && own.first != own.second);
        let by_force = by_force.map(|own| (&own.first, &own.second));
        for (first, second) in apart.chain(by_force) {
            for a in blocks_of(first) {
                for b in blocks_of(second) {
                    all[a * blocks + b] = Interaction::None;
                    all[b * blocks + a] = Interaction::None;
                }
            }
        }
        all
    }

    pub fn is_mixed(&self) -> bool {
        let first = self.bodies.first().map_or(0.0, |body| body.spacing);
        // A spacing that is no number has its own problem, and differs from nothing.
        let differs = |spacing: f64| (spacing - first).abs() > 1e-9 * first.abs();
        self.bodies.iter().any(|body| differs(body.spacing))
    }

    pub fn is_uniform(&self) -> bool {
        self.scheme.smoothing == Smoothing::Fixed
            && !self.scheme.fields().contains(Field::SMOOTHING_LENGTH)
    }
}
