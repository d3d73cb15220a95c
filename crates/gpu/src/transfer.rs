//! What goes over the bus as a whole: the state of a simulation, its lists and walls, to the device and back.
//! Between list builds nothing of it does.

use crate::pairs::settings;
use crate::run::Run;
use crate::{Error, PairLists, Shared};
use meshfree::particles::Field;
use meshfree::scalar::Real;
use std::ops::Range;

impl<T: Real, const D: usize> Run<T, D> {
    /// Takes the whole state of a group to the device, with walls as they are at a time \[s\].
    pub(crate) fn send(&mut self, group: usize, time: f64) -> Result<(), Error> {
        let own = &self.groups[group];
        let (layout, memory) = (&own.sizes.layout, &own.memory);
        let slots = layout.slots;
        let mut all = vec![0.0; layout.numbers()];
        let mut put = |at: usize, k: usize, width: usize, column: &[T]| {
            let own = column.iter().skip(k).step_by(width);
            for (to, from) in all[at..at + slots].iter_mut().zip(own) {
                *to = from.to_f64();
            }
        };
        let columns = self.host.columns(group);
        for field in layout.fields.iter() {
            let width = field.components(D);
            for k in 0..width {
                put(layout.field(field, k), k, width, columns.raw(field));
            }
        }
        for &field in layout.saved.iter().filter(|_| self.is_predicted) {
            let (width, saved) = (field.components(D), self.host.saved(group, field));
            for k in 0..width {
                put(layout.saved(field, k), k, width, saved);
            }
        }
        let listed: Vec<T> = self.host.listed(group).iter().flatten().copied().collect();
        for d in 0..D {
            put(layout.listed(d), d, D, &listed);
        }
        if layout.varies() {
            put(layout.listed(D), 0, 1, self.host.listed_lengths(group));
        }
        let write = |to: &wgpu::Buffer, at: usize, all: Vec<f64>| {
            let at = at * self.precision.bytes();
            self.device.write_at(to, at, &self.numbers(all.into_iter()));
        };
        write(&memory.state, 0, all);
        let (_, rates) = self.host.rates(group);
        let rates = rates.into_iter().map(|x| x.to_f64());
        write(&memory.rates, 0, rates.collect());
        if let Some(first) = own.program.own_forces {
            let forces = self.host.own_forces(group);
            for d in 0..D {
                let forces = forces.iter().map(|force| force[d].to_f64());
                write(&memory.columns, (first + d) * slots, forces.collect());
            }
        }
        if let Some(first) = own.program.held {
            write(&memory.columns, first * slots, self.host.held(group));
        }
        write(&memory.walls, 0, self.host.walls(group, time));
        let (lists, blocks) = (self.host.lists(group), self.host.blocks(group));
        let lists = PairLists::new(lists, blocks, own.sizes.cluster);
        let images = self.host.images(group);
        let transforms = self.numbers(self.host.transforms(group).into_iter());
        let own = &mut self.groups[group];
        own.counted.fill(0);
        own.body_force.clear();
        own.compiled.bind(
            &self.device,
            &mut own.memory,
            (&own.sizes, &own.program),
            (&lists, &images, &transforms),
        )?;
        self.send_settings(group);
        self.send_kept(group);
        for link in &self.links {
            let maps = self.host.followed(link.wall[0], link.wall[1]);
            link.send(&self.device, &maps);
        }
        self.is_voted = false;
        Ok(())
    }

    /// Sends where images are now.
    pub(crate) fn send_transforms(&self, group: usize) {
        let transforms = self.numbers(self.host.transforms(group).into_iter());
        let memory = &self.groups[group].memory;
        self.device.write(&memory.transforms, &transforms);
    }

    /// Numbers a record that the host keeps, and whether that of the device also says if a particle is active in contacts, and where.
    fn kept(&self, group: usize) -> (usize, Option<usize>) {
        let (fields, active) = (self.groups[group].compiled.kept, Field::CONTACT_ACTIVITY);
        let at = fields.contains(active).then(|| fields.offset(active, D));
        (fields.width(D) - usize::from(at.is_some()), at)
    }

    /// Sends records that are kept.
    fn send_kept(&self, group: usize) {
        let (stride, active) = self.kept(group);
        let (kept, columns) = (self.host.kept_records(group), self.host.columns(group));
        let (count, activity) = (columns.slots(), columns.raw(Field::CONTACT_ACTIVITY));
        let images = self.host.images(group);
        let mut all = Vec::new();
        for (n, record) in kept.chunks_exact(stride.max(1)).enumerate() {
            let first = all.len();
            all.extend(record.iter().map(|own| own.to_f64()));
            if let Some(at) = active {
                let source = n.checked_sub(count).map(|n| images[2 * n] as usize);
                all.insert(first + at, activity[source.unwrap_or(n)].to_f64());
            }
        }
        let all = self.numbers(all.into_iter());
        self.device.write(&self.groups[group].memory.kept, &all);
    }

    /// Takes records that are kept back.
    fn take_kept(&self, group: usize) -> Result<(Vec<T>, usize), Error> {
        let (stride, active) = self.kept(group);
        if stride == 0 {
            return Ok((Vec::new(), 0));
        }
        let group = (&self.groups[group], self.host.images(group).len() / 2);
        let width = group.0.compiled.kept.width(D);
        let count = group.0.sizes.layout.slots + group.1;
        let all = self.read(&group.0.memory.kept, width * count)?;
        let own = all.iter().enumerate();
        let own = own.filter(|(k, _)| Some(k % width) != active);
        Ok((own.map(|(_, x)| T::from_f64(*x)).collect(), stride))
    }

    /// Sends what is known of walls, but for those that follow bodies, which stand behind the others.
    pub(crate) fn send_walls(&self, group: usize, time: f64) {
        let (walls, own) = (self.host.walls(group, time), &self.groups[group]);
        let (layout, follows) = (&own.sizes.layout, own.program.follows.first());
        let count = layout.slots - layout.mobile;
        let placed = follows.map_or(count, |step| step.slots.start - layout.mobile);
        for (k, walls) in walls.chunks(count.max(1)).enumerate() {
            let at = k * count * self.precision.bytes();
            let walls = self.numbers(walls[..placed].iter().copied());
            self.device.write_at(&own.memory.walls, at, &walls);
        }
    }

    /// Sends what pairs share, if that has changed.
    pub(crate) fn send_settings(&mut self, group: usize) {
        let force = self.host.body_force(group).to_vec();
        let own = &mut self.groups[group];
        if force == own.body_force {
            return;
        }
        own.body_force.clone_from(&force);
        let own = &self.groups[group];
        let [h, factor] = self.host.scales(group);
        let shared = Shared {
            smoothing_length: h,
            lattice_consistency_factor: factor,
            body_force: force,
        };
        let blocks = self.host.blocks(group).iter();
        let mobile = blocks.map(|block| f64::from(u8::from(!block.wall)));
        let mobile: Vec<_> = mobile.collect();
        let contacts = self.host.contacts(group).into_iter();
        let contacts: Vec<f64> = contacts.map(|own| f64::from(u8::from(own))).collect();
        for (to, table) in [
            (&own.memory.settings, mobile),
            (&own.memory.approach, self.host.seen(group)),
        ] {
            let table = [&table[..], &contacts].concat();
            let all = settings(own.compiled.support, &shared, &table);
            self.device.write(to, &self.numbers(all.into_iter()));
        }
    }

    /// Takes the whole state back, unless the host has it.
    pub(crate) fn take(&mut self) -> Result<(), Error> {
        if !self.is_taken {
            for group in 0..self.groups.len() {
                self.take_group(group)?;
            }
        }
        self.is_taken = true;
        Ok(())
    }

    /// Takes the state of a group back.
    pub(crate) fn take_group(&mut self, group: usize) -> Result<(), Error> {
        let own = &self.groups[group];
        let (layout, memory, program) = (&own.sizes.layout, &own.memory, &own.program);
        let (slots, end) = (layout.slots, layout.listed(0));
        let all = self.read(&memory.state, end)?;
        let column = |at: &dyn Fn(usize) -> usize, width: usize| -> Vec<T> {
            let number = |n: usize| T::from_f64(all[at(n % width) + n / width]);
            (0..slots * width).map(number).collect()
        };
        for field in layout.fields.iter() {
            let own = column(&|k| layout.field(field, k), field.components(D));
            let columns = self.host.columns_mut(group);
            columns.raw_mut(field).copy_from_slice(&own);
        }
        let saved = layout.saved.iter().filter(|_| self.is_predicted);
        let saved = saved.map(|&field| {
            let own = column(&|k| layout.saved(field, k), field.components(D));
            (field, own)
        });
        self.host.take_saved(group, saved.collect());
        let counts = program.counts.iter().enumerate().map(|(k, own)| {
            let at = layout.count(k);
            let slots = &all[at + own.slots.start..at + own.slots.end];
            slots.iter().map(|count| count.round() as u64).sum::<u64>()
        });
        let counts: Vec<u64> = counts.collect();
        let new = counts.iter().zip(&own.counted);
        let new: Vec<f64> = new.map(|(now, then)| (now - then) as f64).collect();
        self.host.count(group, &new);
        let count = own.sizes.rates.width(D) * layout.mobile;
        let rates = self.read(&memory.rates, count)?;
        let rates: Vec<T> = rates.into_iter().map(T::from_f64).collect();
        let mut forces = Vec::new();
        if let Some(first) = program.own_forces {
            let all = self.read_at(&memory.columns, first * slots, D * slots)?;
            let of = |slot| core::array::from_fn(|d| T::from_f64(all[d * slots + slot]));
            forces.extend((0..layout.mobile).map(of));
        }
        if let Some(first) = program.held {
            let Range { start, end } = self.host.held_changes();
            let at = (first + start) * slots;
            let mut given = self.read_at(&memory.columns, at, (end - start) * slots)?;
            self.host.take_held(group, &given);
            // Sums that were taken are not taken again.
            given[D * slots..].fill(0.0);
            let at = at * self.precision.bytes();
            let given = self.numbers(given.into_iter());
            self.device.write_at(&memory.columns, at, &given);
        }
        if !program.follows.is_empty() {
            let walls = self.read(&memory.walls, D * (slots - layout.mobile))?;
            self.host.take_walls(group, &walls);
        }
        let reactions = self.forces.as_ref().map_or(&[][..], |all| &all[group]);
        let kept = self.take_kept(group)?;
        self.host
            .take_rates(group, (&rates, &forces), reactions, kept);
        self.groups[group].counted = counts;
        Ok(())
    }

    /// Sends what of a wall changes as it moves.
    pub(crate) fn send_wall(&self, group: usize, slots: &Range<usize>) {
        let (layout, memory) = (&self.groups[group].sizes.layout, &self.groups[group].memory);
        for field in [
            Field::POSITION,
            Field::POSITION_RESIDUAL,
            Field::VELOCITY,
            Field::MASS,
        ] {
            let (column, width) = (self.host.columns(group).raw(field), field.components(D));
            if column.is_empty() {
                continue;
            }
            for k in 0..width {
                let own = slots.clone().map(|slot| column[slot * width + k].to_f64());
                let at = (layout.field(field, k) + slots.start) * self.precision.bytes();
                self.device.write_at(&memory.state, at, &self.numbers(own));
            }
        }
    }
}
