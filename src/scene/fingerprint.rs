//! The fingerprint of a scene: a hash of each of its parts, by which a checkpoint knows its scene again.
//! What closures do cannot be hashed; of loads their number, kind and body is, of motions their names.

use super::{Body, Scene};
use crate::boundary::Wall;
use crate::output::checkpoint::{Hash, Hashes};
use crate::output::values::{Values, without_addresses};
use crate::scalar::Real;
use crate::scheme::Scheme;
use core::fmt::Debug;
use std::sync::Arc;

impl<T: Real, const D: usize> Scene<T, D> {
    /// The hash of each part, by its name in messages.
    pub(super) fn hashes(&self) -> Hashes {
        let Self {
            parts,
            walls,
            outlets,
            inlets,
            sources,
            drains,
            boundaries,
            integrator,
            contacts,
            couplings,
            sub_cycled,
            clamps,
            rigid,
            joints,
            accelerations,
            loads,
            step_ends,
            events,
            exchanges,
            control,
            skin,
            // A checkpoint says on which it runs on.
            instructions: _,
            root: _,
            // What a machine has to give is not of the scene.
            memory: _,
            ranks_here: _,
            // No bit depends on them.
            ranks: _,
        } = self;
        let schemes = of_texts(parts.iter().map(|part| scheme_text(&part.scheme)));
        let mut bodies = Hash::new();
        for part in parts {
            text(&mut bodies, part.bodies.len());
            for body in &part.bodies {
                hash_body(body, &mut bodies);
            }
        }
        let facing = parts.iter().any(|part| part.scheme.program.wall_normals);
        let mut all_walls = Hash::new();
        for wall in walls {
            hash_wall(wall, facing, &mut all_walls);
        }
        let count = debug(accelerations.len());
        let all_loads = core::iter::once(count).chain(loads.iter().map(ToString::to_string));
        let mut all = vec![
            ("schemes", schemes),
            ("bodies", bodies.value()),
            ("walls", all_walls.value()),
            ("boundaries", of_texts(boundaries.iter().map(debug))),
            ("inlets", of_texts(inlets.iter().map(debug))),
            ("outlets", of_texts(outlets.iter().map(debug))),
            (
                "the integrator",
                of_texts([integrator.name(), debug(integrator)]),
            ),
            ("what bodies do to each other", of_texts([debug(contacts)])),
            (
                "couplings and sub-cycling",
                of_texts(
                    couplings
                        .iter()
                        .map(|own| debug((&own.first, &own.second, &own.coupling, own.exclusion)))
                        .chain([debug(sub_cycled)]),
                ),
            ),
            (
                "clamps and rigid bodies",
                of_texts(
                    clamps
                        .iter()
                        .map(|own| {
                            let points = self.bodies().find(|body| body.name == own.body);
                            let points = points.map_or(&[][..], |body| &body.points);
                            let motion = own.motion.as_ref().map(|motion| motion.name());
                            debug((&own.body, own.particles(points), motion))
                        })
                        .chain([debug(rigid)]),
                ),
            ),
            ("the loads", of_texts(all_loads)),
            ("the choice of steps", of_texts([debug(control)])),
            ("the skin of neighbour lists", of_texts([debug(skin)])),
        ];
        if !step_ends.is_empty() {
            all.push(("times at which steps end", of_texts([debug(step_ends)])));
        }
        if !joints.is_empty() {
            all.push(("joints", of_texts(sorted(joints))));
        }
        if !sources.is_empty() || !drains.is_empty() {
            let text = debug((sources, drains));
            all.push(("sources and drains", of_texts([text])));
        }
        // Files of scenes without events are as they were.
        if !events.is_empty() {
            let until: Vec<_> = clamps.iter().map(|own| &own.until).collect();
            let since: Vec<_> = clamps.iter().filter_map(|own| own.since.as_ref()).collect();
            let since = (!since.is_empty()).then(|| debug(since));
            let texts = [debug(events), debug(until)].into_iter().chain(since);
            all.push(("events", of_texts(texts)));
        }
        if !exchanges.is_empty() {
            let text = |own: &super::ExchangeOf<T, D>| {
                debug((&own.body, &own.event)) + &scheme_text(&own.scheme)
            };
            all.push((
                "schemes that come later",
                of_texts(exchanges.iter().map(text)),
            ));
        }
        all
    }
}

impl<T: Real, const D: usize> Scene<T, D> {
    /// What is hashed, as far as it has names: by these a checkpoint of another scene says what differs.
    pub(super) fn values(&self) -> Described {
        let mut schemes = Values::default();
        for (k, part) in self.parts.iter().enumerate() {
            let text = format!("{}\n{}", part.scheme, part.scheme.step_program());
            for (n, line) in text.lines().enumerate() {
                let line = without_addresses(line.trim());
                schemes.one(format!("line {} of scheme {}", n + 1, k + 1), line);
            }
        }
        let mut bodies = Values::default();
        for body in self.bodies() {
            describe_body(body, &mut bodies);
        }
        let mut walls = Values::default();
        for wall in &self.walls {
            let name = format!("wall `{}`", wall.name);
            walls.one(format!("{name}.particles"), wall.points.len().to_string());
            walls.all(&format!("{name}.spacing"), &wall.spacing);
            walls.all(&format!("{name}.motion"), &wall.motion);
            walls.all(&format!("{name}.slip"), &wall.slip);
            walls.all(&format!("{name}.sliding"), &wall.sliding);
            walls.all(&format!("{name}.container_frame"), &wall.container_frame);
            let mut hash = Hash::new();
            hash.numbers(wall.points.as_flattened());
            let hash = format!("{:016x}", hash.value());
            walls.one(format!("hash of positions of {name}"), hash);
        }
        let mut held = Values::default();
        for (k, own) in self.clamps.iter().enumerate() {
            let name = format!("clamp {} of `{}`", k + 1, own.body);
            let points = self.bodies().find(|body| body.name == own.body);
            let points = points.map_or(&[][..], |body| &body.points);
            let mut hash = Hash::new();
            text(&mut hash, own.particles(points));
            let hash = format!("{:016x}", hash.value());
            held.one(format!("hash of particles of {name}"), hash);
            held.all(&format!("{name}.motion"), &own.motion);
            held.all(&format!("{name}.since"), &own.since);
            held.all(&format!("{name}.until"), &own.until);
        }
        held.one("rigid bodies", self.rigid.join(", "));
        let mut joints = Values::default();
        for (k, own) in sorted(&self.joints).into_iter().enumerate() {
            joints.one(format!("joint {}", k + 1), own);
        }
        let mut loads = Values::default();
        let count = self.accelerations.len().to_string();
        loads.one("number of uniform accelerations", count);
        for (k, load) in self.loads.iter().enumerate() {
            loads.one(format!("load {}", k + 1), load.to_string());
        }
        let mut couplings = Values::default();
        for (k, own) in self.couplings.iter().enumerate() {
            let own = (&own.first, &own.second, &own.coupling, own.exclusion);
            couplings.all(&format!("coupling {}", k + 1), &own);
        }
        couplings.all("sub-cycled", &self.sub_cycled);
        let all = |name: &str, value: &dyn Debug| {
            let mut values = Values::default();
            values.all(name, &value);
            values
        };
        vec![
            ("schemes", schemes),
            ("bodies", bodies),
            ("walls", walls),
            ("boundaries", all("boundaries", &self.boundaries)),
            ("inlets", all("inlets", &self.inlets)),
            ("outlets", all("outlets", &self.outlets)),
            ("the integrator", all("integrator", &self.integrator)),
            (
                "what bodies do to each other",
                all("between", &self.contacts),
            ),
            ("clamps and rigid bodies", held),
            ("the loads", loads),
            ("couplings and sub-cycling", couplings),
            (
                "times at which steps end",
                all("step_ends", &self.step_ends),
            ),
            ("events", all("events", &self.events)),
            ("joints", joints),
            ("the choice of steps", all("steps", &self.control)),
            ("the skin of neighbour lists", all("skin", &self.skin)),
        ]
    }
}

/// Values of parts of a scene, by the names of the parts.
pub(crate) type Described = Vec<(&'static str, Values)>;

/// What a body is by names; what each particle starts with is told where it is the same for all.
fn describe_body<T: Real, const D: usize>(body: &Body<T, D>, values: &mut Values) {
    let name = format!("body `{}`", body.name);
    values.all(&format!("{name}.material"), &body.material);
    values.all(&format!("{name}.spacing"), &body.spacing);
    values.all(&format!("{name}.slip"), &body.slip);
    values.one(format!("{name}.particles"), body.points.len().to_string());
    let mut hashed = |what: &str, numbers: &[f64]| {
        let mut hash = Hash::new();
        hash.numbers(numbers);
        values.one(
            format!("hash of {what} of {name}"),
            format!("{:016x}", hash.value()),
        );
    };
    hashed("positions", body.points.as_flattened());
    hashed("masses", &body.masses);
    for own in &body.fields {
        hashed(&debug(own.field), &own.values);
    }
    if let [start] = &body.starts[..] {
        values.all(&format!("{name}.start"), start);
        return;
    }
    let numbers = |start: &crate::scheme::Start<D>| -> Vec<f64> {
        let state = start.velocity.into_iter();
        state.chain([start.density, start.energy]).collect()
    };
    let all: Vec<f64> = body.starts.iter().flat_map(numbers).collect();
    hashed("starts", &all);
}

/// All that a scheme says of itself.
fn scheme_text<T: Real, const D: usize>(scheme: &Arc<Scheme<T, D>>) -> String {
    let program = &scheme.program;
    let (declared, limits) = (&program.declared, &program.limits);
    let printed = format!("{scheme}\n{}", scheme.step_program());
    printed + &debug((scheme, declared, limits))
}

/// Its debug text without the addresses of functions.
fn debug(value: impl Debug) -> String {
    without_addresses(&format!("{value:?}"))
}

/// The texts of what has no order.
fn sorted(all: &[impl Debug]) -> Vec<String> {
    let mut all: Vec<String> = all.iter().map(debug).collect();
    all.sort_unstable();
    all
}

fn text(hash: &mut Hash, value: impl Debug) {
    hash.bytes(debug(value).as_bytes());
    // Ends a text, which has no such byte.
    hash.bytes(&[0xff]);
}

fn of_texts(texts: impl IntoIterator<Item = String>) -> u64 {
    let mut hash = Hash::new();
    for one in texts {
        hash.bytes(one.as_bytes());
        hash.bytes(&[0xff]);
    }
    hash.value()
}

fn hash_body<T: Real, const D: usize>(body: &Body<T, D>, hash: &mut Hash) {
    let Body {
        name,
        material,
        points,
        spacing,
        starts: _,
        slip,
        fields,
        masses,
        // A scene with an error is not built.
        shape: _,
        // Known by its densities.
        hydrostatic: _,
    } = body;
    text(hash, (name, material, spacing, slip, points.len()));
    hash.numbers(points.as_flattened());
    for start in (0..points.len()).map(|k| body.start_of(k)) {
        hash.numbers(&start.velocity);
        hash.numbers(&[start.density, start.energy]);
    }
    for own in fields {
        text(hash, (own.field, own.components));
        hash.numbers(&own.values);
    }
    hash.numbers(masses);
}

fn hash_wall<const D: usize>(wall: &Wall<D>, facing: bool, hash: &mut Hash) {
    let Wall {
        name,
        points,
        spacing,
        motion,
        slip,
        sliding,
        container_frame,
        shape: _,
        // Known by its normals.
        fluid_side: _,
    } = wall;
    let motion = motion.as_ref().map(|motion| motion.name());
    text(
        hash,
        (name, spacing, motion, slip, sliding, container_frame),
    );
    text(hash, points.len());
    hash.numbers(points.as_flattened());
    if facing {
        hash.numbers(wall.normals().as_flattened());
    }
}
