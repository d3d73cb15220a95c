//! What goes between host and device as a whole: the state of a group as numbers, in the order in which a device has them.
//! A device writes and reads arrays; what stands in them is known here.

use super::{Forces, Moment, Offloaded, Recorded};
use crate::particles::{Field, Fields};
use crate::scalar::Real;
use std::ops::Range;

/// The arrays that a device has of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Array {
    /// The columns of the state, as [`Layout`] has them.
    State,
    /// The rates at hand, slot by slot.
    Rates,
    /// Columns of their own.
    Columns,
    /// What wall laws see: accelerations \[m/s²\], normals, and velocity gradients \[1/s\] row by row, each component for all slots behind
    /// those of bodies.
    Walls,
    /// Records that are kept.
    Kept,
    /// Transforms of images.
    Transforms,
    /// What all pairs of a sweep share: the square of the reach \[m²\], the smoothing length \[m\], the lattice consistency factor, and the
    /// acceleration of all \[m/s²\]; of every block a one if it moves by forces; and a one for each two blocks with a contact that may open.
    Settings,
    /// The same for pairs that approach, of every block the share of a closing speed that counts.
    Approach,
}

/// Numbers of an array, from a place on.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// The array.
    pub array: Array,
    /// The place of the first.
    pub at: usize,
    /// They.
    pub numbers: Vec<f64>,
}

/// Where the columns of the state stand: fields, what a prediction saves, counts, and the places of lists.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// The fields of particles.
    pub fields: Fields,
    /// Dimensions.
    pub dimensions: usize,
    /// Slots of all particles.
    pub slots: usize,
    /// Slots below this move by forces.
    pub mobile: usize,
    /// The fields that a prediction saves.
    pub saved: Vec<Field>,
    /// How many numbers are counted.
    pub counts: usize,
}

impl Layout {
    /// Where a component of a field starts.
    #[must_use]
    pub fn field(&self, field: Field, k: usize) -> usize {
        (self.fields.offset(field, self.dimensions) + k) * self.slots
    }
    fn width_of_saved(&self, fields: &[Field]) -> usize {
        let widths = fields.iter().map(|own| own.components(self.dimensions));
        widths.sum()
    }
    /// Where a component of a field starts as a prediction has saved it.
    #[must_use]
    pub fn saved(&self, field: Field, k: usize) -> usize {
        let before = self.saved.iter().position(|own| *own == field).unwrap_or(0);
        let before = self.width_of_saved(&self.saved[..before]);
        (self.fields.width(self.dimensions) + before + k) * self.slots
    }
    /// Where a count starts.
    #[must_use]
    pub fn count(&self, k: usize) -> usize {
        let before = self.fields.width(self.dimensions) + self.width_of_saved(&self.saved);
        (before + k) * self.slots
    }
    /// Where that starts which lists were built for: places, and smoothing lengths where they vary.
    #[must_use]
    pub fn listed(&self, d: usize) -> usize {
        self.count(self.counts + d)
    }
    /// Whether smoothing lengths vary.
    #[must_use]
    pub fn varies(&self) -> bool {
        self.fields.contains(Field::SMOOTHING_LENGTH)
    }
    /// Numbers of all columns.
    #[must_use]
    pub fn numbers(&self) -> usize {
        self.listed(self.dimensions + usize::from(self.varies()))
    }
}

/// Numbers a record that the host keeps of those of a device, and where that also says if a particle is active in contacts.
fn kept<const D: usize>(fields: Fields) -> (usize, Option<usize>) {
    let active = Field::CONTACT_ACTIVITY;
    let at = fields.contains(active).then(|| fields.offset(active, D));
    (fields.width(D) - usize::from(at.is_some()), at)
}

/// From the scalar of the particles.
fn wide<T: Real>(all: &[T]) -> Vec<f64> {
    all.iter().map(|x| x.to_f64()).collect()
}

impl<T: Real, const D: usize> Offloaded<T, D> {
    /// Where the columns of the state of a group stand.
    #[must_use]
    pub fn layout(&self, group: usize) -> &Layout {
        &self.recorded[group].layout
    }

    /// All that a device has of a group, with walls as they are at a time \[s\].
    pub fn sent(&mut self, group: usize, time: f64) -> Vec<Numbers> {
        let own = &mut self.recorded[group];
        own.counted.fill(0);
        own.body_force.clear();
        own.entries = self.simulation.state.groups[group]
            .neighborhood
            .lists
            .entries();
        let own = &self.recorded[group];
        let (program, slots) = (&own.program, own.layout.slots);
        let mut all = vec![(Array::State, 0, self.state(group))];
        all.push((Array::Rates, 0, wide(&self.rates(group).1)));
        if let Some(first) = program.own_forces {
            let forces = self.own_forces(group);
            for d in 0..D {
                let forces = forces.iter().map(|force| force[d].to_f64());
                all.push((Array::Columns, (first + d) * slots, forces.collect()));
            }
        }
        if let Some(first) = program.held {
            all.push((Array::Columns, first * slots, self.held(group)));
        }
        all.extend(self.states_sent(group));
        all.push((Array::Walls, 0, self.walls(group, time)));
        all.push((Array::Kept, 0, self.kept(group)));
        let of = |(array, at, numbers)| Numbers { array, at, numbers };
        let mut all: Vec<_> = all.into_iter().map(of).collect();
        all.extend(self.contacts_sent(group));
        all.extend(self.settings(group));
        all
    }

    /// The columns of the state.
    fn state(&self, group: usize) -> Vec<f64> {
        let layout = &self.recorded[group].layout;
        let mut all = vec![0.0; layout.numbers()];
        let mut put = |at: usize, k: usize, width: usize, column: &[T]| {
            let own = column.iter().skip(k).step_by(width);
            for (to, from) in all[at..at + layout.slots].iter_mut().zip(own) {
                *to = from.to_f64();
            }
        };
        let columns = self.columns(group);
        for field in layout.fields.iter() {
            let width = field.components(D);
            for k in 0..width {
                put(layout.field(field, k), k, width, columns.raw(field));
            }
        }
        for &field in layout.saved.iter().filter(|_| self.is_predicted) {
            let (width, saved) = (field.components(D), self.saved(group, field));
            for k in 0..width {
                put(layout.saved(field, k), k, width, saved);
            }
        }
        let listed = self.listed(group).as_flattened();
        for d in 0..D {
            put(layout.listed(d), d, D, listed);
        }
        if layout.varies() {
            put(layout.listed(D), 0, 1, self.listed_lengths(group));
        }
        all
    }

    /// Records that are kept.
    fn kept(&self, group: usize) -> Vec<f64> {
        let (stride, active) = kept::<D>(self.recorded[group].kept);
        let (kept, columns) = (self.kept_records(group), self.columns(group));
        let (count, activity) = (columns.slots(), columns.raw(Field::CONTACT_ACTIVITY));
        let images = self.images(group);
        let mut all = Vec::new();
        // Lists that were built since may have fewer images: an evaluation keeps others then.
        let there = count + images.len() / 2;
        for (n, record) in kept.chunks_exact(stride.max(1)).take(there).enumerate() {
            let first = all.len();
            all.extend(record.iter().map(|own| own.to_f64()));
            if let Some(at) = active {
                let source = n.checked_sub(count).map(|n| images[2 * n] as usize);
                all.insert(first + at, activity[source.unwrap_or(n)].to_f64());
            }
        }
        all
    }

    /// What pairs share, if that has changed.
    fn settings(&mut self, group: usize) -> Vec<Numbers> {
        let force = self.body_force(group).to_vec();
        if force == self.recorded[group].body_force {
            return Vec::new();
        }
        self.recorded[group].body_force.clone_from(&force);
        let [h, factor] = self.scales(group);
        let reach = self.simulation.state.groups[group].scheme.kernel.support * h;
        let one = |is: bool| f64::from(u8::from(is));
        let mobile = self.blocks(group).iter().map(|block| one(!block.wall));
        let contacts: Vec<_> = self.contacts(group).into_iter().map(one).collect();
        let with = |array, table: Vec<f64>| Numbers {
            array,
            at: 0,
            numbers: [&[reach * reach, h, factor], &force[..], &table, &contacts].concat(),
        };
        let mobile = with(Array::Settings, mobile.collect());
        vec![mobile, with(Array::Approach, self.seen(group))]
    }

    /// Moves walls and boundaries of a group to where they are at a moment; what of it a device needs anew.
    pub fn place_walls(&mut self, number: usize, moment: &Moment) -> Vec<Numbers> {
        let group = &mut self.simulation.state.groups[number];
        group.place_walls(moment.time, moment.chord);
        let moving = group.walls.iter().filter(|wall| wall.motion.is_some());
        let slots: Vec<_> = moving.map(|wall| wall.slots.start..wall.end).collect();
        let mut all: Vec<_> = slots
            .iter()
            .flat_map(|slots| self.wall(number, slots))
            .collect();
        if !slots.is_empty() {
            all.extend(self.placed(number, moment.time));
        }
        if self.place_boundaries(number, moment.time) {
            all.push(Numbers {
                array: Array::Transforms,
                at: 0,
                numbers: self.transforms(number),
            });
        }
        all.extend(self.settings(number));
        all
    }

    /// What of a wall changes as it moves.
    fn wall(&self, group: usize, slots: &Range<usize>) -> Vec<Numbers> {
        let (layout, columns) = (&self.recorded[group].layout, self.columns(group));
        let places = [Field::POSITION, Field::POSITION_RESIDUAL];
        let fields = places.into_iter().chain([Field::VELOCITY, Field::MASS]);
        let fields = fields.filter(|field| layout.fields.contains(*field));
        let components = fields.flat_map(|field| {
            let width = field.components(D);
            (0..width).map(move |k| (field, k, width))
        });
        let of = |(field, k, width): (Field, usize, usize)| {
            let column = columns.raw(field);
            let own = slots.clone().map(|slot| column[slot * width + k].to_f64());
            Numbers {
                array: Array::State,
                at: layout.field(field, k) + slots.start,
                numbers: own.collect(),
            }
        };
        components.map(of).collect()
    }

    /// What is known of walls, but for those that follow bodies, which stand behind the others.
    fn placed(&self, group: usize, time: f64) -> Vec<Numbers> {
        let Recorded {
            layout, program, ..
        } = &self.recorded[group];
        let count = layout.slots - layout.mobile;
        let follows = program.follows.first();
        let placed = follows.map_or(count, |step| step.slots.start - layout.mobile);
        let walls = self.walls(group, time);
        let of = |(k, walls): (usize, &[f64])| Numbers {
            array: Array::Walls,
            at: k * count,
            numbers: walls[..placed].to_vec(),
        };
        walls.chunks(count.max(1)).enumerate().map(of).collect()
    }

    /// The numbers of arrays of a group that [`taken`](Self::taken) asks for: from where, and how many.
    #[must_use]
    pub fn wanted(&self, group: usize) -> Vec<(Array, usize, usize)> {
        let own = &self.recorded[group];
        let (layout, program, slots) = (&own.layout, &own.program, own.layout.slots);
        let rates = self.rates(group).0.width(D) * layout.mobile;
        let state = if own.is_listed_there {
            layout.numbers()
        } else {
            layout.listed(0)
        };
        let mut all = vec![(Array::State, 0, state), (Array::Rates, 0, rates)];
        let forces = program.own_forces;
        all.extend(forces.map(|first| (Array::Columns, first * slots, D * slots)));
        let given = program.held.map(|first| {
            let changes = self.held_changes();
            let first = (first + changes.start) * slots;
            (Array::Columns, first, changes.len() * slots)
        });
        all.extend(given);
        let given = program.given;
        all.extend(given.map(|first| (Array::Columns, first * slots, (D + 1) * slots)));
        all.extend(self.states_wanted(group));
        all.extend(self.contacts_wanted(group));
        if !program.follows.is_empty() {
            all.push((Array::Walls, 0, D * (slots - layout.mobile)));
        }
        let kept = own.kept.width(D);
        if kept > 0 {
            let count = slots + self.images(group).len() / 2;
            all.push((Array::Kept, 0, kept * count));
        }
        all
    }

    /// Takes a group back from numbers as they were [`wanted`](Self::wanted), with the forces between its blocks; what the device is to be
    /// told then.
    pub fn taken(&mut self, group: usize, found: &[Vec<f64>], forces: &Forces<D>) -> Vec<Numbers> {
        let places = self.wanted(group);
        let mut found = found.iter().zip(places);
        let mut next = || found.next().map_or(&[][..], |own| &own.0[..]);
        let (state, rates) = (next(), next());
        self.take_state(group, state);
        self.take_lists(group, state);
        let narrow = |all: &[f64]| -> Vec<T> { all.iter().map(|x| T::from_f64(*x)).collect() };
        let own = &self.recorded[group];
        let (layout, program) = (own.layout.clone(), own.program.clone());
        let (slots, fields) = (layout.slots, own.kept);
        let (mut forces_of_pairs, mut rest) = (Vec::new(), Vec::new());
        if program.own_forces.is_some() {
            let all = next();
            let of = |slot| core::array::from_fn(|d| T::from_f64(all[d * slots + slot]));
            forces_of_pairs.extend((0..layout.mobile).map(of));
        }
        if let Some(first) = program.held {
            let mut given = next().to_vec();
            self.take_held(group, &given);
            // Sums that were taken are not taken again.
            given[D * slots..].fill(0.0);
            rest.push(Numbers {
                array: Array::Columns,
                at: (first + self.held_changes().start) * slots,
                numbers: given,
            });
        }
        if let Some(first) = program.given {
            self.take_given(group, next());
            rest.push(Numbers {
                array: Array::Columns,
                at: first * slots,
                numbers: vec![0.0; (D + 1) * slots],
            });
        }
        let states: Vec<_> = self.states_wanted(group).iter().map(|_| next()).collect();
        self.take_states(group, &states);
        rest.extend(self.contacts_taken(group, &mut next));
        if !program.follows.is_empty() {
            self.take_walls(group, next());
        }
        let (stride, active) = kept::<D>(fields);
        let mut records = narrow(next());
        let mut n = 0;
        records.retain(|_| {
            n += 1;
            Some((n - 1) % (stride + 1)) != active
        });
        let rates = (&narrow(rates)[..], &forces_of_pairs[..]);
        self.take_rates(group, rates, forces, (records, stride));
        rest
    }

    fn take_state(&mut self, group: usize, all: &[f64]) {
        let layout = self.recorded[group].layout.clone();
        let column = |at: &dyn Fn(usize) -> usize, width: usize| -> Vec<T> {
            let number = |n: usize| T::from_f64(all[at(n % width) + n / width]);
            (0..layout.slots * width).map(number).collect()
        };
        for field in layout.fields.iter() {
            let own = column(&|k| layout.field(field, k), field.components(D));
            let columns = self.columns_mut(group);
            columns.raw_mut(field).copy_from_slice(&own);
        }
        let saved = layout.saved.iter().filter(|_| self.is_predicted);
        let saved = saved.map(|&field| {
            let own = column(&|k| layout.saved(field, k), field.components(D));
            (field, own)
        });
        self.take_saved(group, saved.collect());
        let own = &mut self.recorded[group];
        let counts = own.program.counts.iter().enumerate().map(|(k, own)| {
            let at = layout.count(k);
            let slots = &all[at + own.slots.start..at + own.slots.end];
            slots.iter().map(|count| count.round() as u64).sum::<u64>()
        });
        let counts: Vec<u64> = counts.collect();
        let then = core::mem::replace(&mut own.counted, counts.clone());
        let new = counts.iter().zip(then).map(|(now, then)| now - then);
        self.count(group, &new.collect::<Vec<_>>());
    }
}
