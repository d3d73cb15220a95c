//! Walls that are bodies of other groups: kernels that bring them to these, and that add what they feel to the forces there.
//! The host says which particle is which, anew when either group has its particles sorted.

use crate::device::{Bound, Buffer, Extent};
use crate::fuse::Around;
use crate::kernel::{Array, pack_indices};
use crate::run::Group;
use crate::{Device, Dialect, Error, Precision, emit};
use meshfree::particles::Output;
use meshfree::simulation::device::{FollowStep, Given};

/// Such a wall, bound to the memory of both groups.
#[derive(Debug)]
pub(crate) struct Link {
    /// Its group, and its number among such walls there.
    pub wall: [usize; 2],
    /// The slot of the body for each of the wall, and the reverse.
    maps: [Buffer; 2],
    /// What brings the wall to the body, and what adds forces.
    pub bound: [Bound; 2],
}

/// What surrounds steps of a group.
pub(crate) fn around(group: &Group, dialect: Dialect) -> Around<'_> {
    Around {
        layout: &group.sizes.layout,
        rates: group.sizes.rates,
        // The forces on walls are those of the rates.
        sums: group.sizes.rates,
        dialect,
    }
}

fn follow(step: &FollowStep, own: &Around<'_>, other: &Around<'_>) -> String {
    let text = emit(&step.record, own.dialect, &|k| {
        let text = match k.checked_sub(step.own.len()) {
            None => own.read(step.own[k], ["", "i"]),
            Some(k) => other.read(step.from[k], ["from_", "source"]),
        };
        (text, false)
    });
    let source = own.dialect.index("source", "map[n]");
    source + &text.before + &own.write(&step.made, &text.results, &[])
}

fn push(own: &Around<'_>, other: &Around<'_>) -> String {
    let mut body = own.dialect.index("source", "map[n]");
    for d in 0..own.layout.dimensions {
        let to = other.read(Given::Rate(Output::FORCE, d), ["", "i"]);
        let from = own.read(Given::Sum(Output::FORCE, d), ["", "source"]);
        body += &format!("{to} = {to} + {from};\n");
    }
    body
}

impl Link {
    pub fn all(
        device: &Device,
        groups: &[Group],
        precision: Precision,
    ) -> Result<Vec<Self>, Error> {
        let walls = groups.iter().enumerate().flat_map(|(k, group)| {
            let steps = group.program.follows.iter().enumerate();
            steps.map(move |(number, step)| ([k, number], step))
        });
        let link = |(wall, step): ([usize; 2], &FollowStep)| {
            let (own, other) = (&groups[wall[0]], &groups[step.group]);
            let dialect = device.dialect(precision);
            let [a, b] = [own, other].map(|group| around(group, dialect));
            let kernel = |name: &str, buffers: &[Array], body: &str| {
                device.kernel(("coupling", name), (dialect, buffers), body)
            };
            let runs = [&step.slots, &step.body];
            let map = |k: usize| device.room("which particle is which", 4 * runs[k].len());
            let maps = [map(0)?, map(1)?];
            let extent = |k: usize| Extent::of(runs[k].clone());
            let numbers = Array::numbers;
            let arrays = [
                numbers("state").written(),
                numbers("walls").written(),
                numbers("from_state"),
                numbers("from_rates"),
                numbers("from_numbers"),
                Array::indices("map"),
            ];
            let to_body = kernel("walls that are bodies", &arrays, &follow(step, &a, &b))?;
            let (m, o) = (&own.memory, &other.memory);
            let buffers = [&m.state, &m.walls, &o.state, &o.rates, &o.shared, &maps[0]];
            let to_body = device.bind_over(&to_body, &buffers, extent(0));
            let arrays = [
                numbers("rates").written(),
                numbers("sums"),
                Array::indices("map"),
            ];
            let forces = kernel("forces on bodies", &arrays, &push(&a, &b))?;
            let forces = device.bind_over(&forces, &[&o.rates, &m.sums, &maps[1]], extent(1));
            Ok(Self {
                wall,
                maps,
                bound: [to_body, forces],
            })
        };
        walls.map(link).collect()
    }

    /// Tells the device which particle is which.
    pub fn send(&self, device: &Device, maps: &[Vec<u32>; 2]) {
        for (to, map) in self.maps.iter().zip(maps) {
            device.write(to, &pack_indices(map));
        }
    }
}
