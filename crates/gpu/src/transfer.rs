//! What goes over the bus as a whole: the state of a simulation, its lists and walls, to the device and back.
//! Between list builds nothing of it does.

use crate::pairs::settings;
use crate::run::Run;
use crate::{Error, PairLists, Shared};
use meshfree::particles::Field;
use meshfree::scalar::Real;
use std::ops::Range;

impl<T: Real, const D: usize> Run<T, D> {
    /// Takes the whole state to the device, with walls as they are at a time \[s\].
    pub(crate) fn send(&mut self, time: f64) -> Result<(), Error> {
        let layout = &self.sizes.layout;
        let slots = layout.slots;
        let mut all = vec![0.0; layout.numbers()];
        let mut put = |at: usize, k: usize, width: usize, column: &[T]| {
            let own = column.iter().skip(k).step_by(width);
            for (to, from) in all[at..at + slots].iter_mut().zip(own) {
                *to = from.to_f64();
            }
        };
        for field in layout.fields.iter() {
            let width = field.components(D);
            for k in 0..width {
                put(
                    layout.field(field, k),
                    k,
                    width,
                    self.host.columns().raw(field),
                );
            }
        }
        if self.is_predicted {
            for &field in &layout.saved {
                let width = field.components(D);
                for k in 0..width {
                    put(layout.saved(field, k), k, width, self.host.saved(field));
                }
            }
        }
        let listed: Vec<T> = self.host.listed().iter().flatten().copied().collect();
        for d in 0..D {
            put(layout.listed(d), d, D, &listed);
        }
        if layout.varies() {
            put(layout.listed(D), 0, 1, self.host.listed_lengths());
        }
        self.device
            .write(&self.memory.state, &self.numbers(all.into_iter()));
        let (_, rates) = self.host.rates();
        let rates = self.numbers(rates.into_iter().map(|x| x.to_f64()));
        self.device.write(&self.memory.rates, &rates);
        self.counted.fill(0);
        self.send_walls(time);
        let lists = PairLists::new(self.host.lists(), self.host.blocks(), self.sizes.cluster);
        let images = self.host.images();
        let transforms = self.numbers(self.host.transforms().into_iter());
        self.body_force = [f64::NAN; D];
        self.send_settings();
        let (compiled, memory) = (&mut self.compiled, &mut self.memory);
        compiled.bind(
            &self.device,
            memory,
            &self.sizes,
            (&lists, &images, &transforms),
        )?;
        self.send_kept();
        self.is_voted = false;
        Ok(())
    }

    /// Sends where images are now.
    pub(crate) fn send_transforms(&self) {
        let transforms = self.numbers(self.host.transforms().into_iter());
        self.device.write(&self.memory.transforms, &transforms);
    }

    /// Numbers a record that the host keeps, and whether that of the device also says if a particle is active in contacts, and where.
    fn kept(&self) -> (usize, Option<usize>) {
        let (fields, active) = (self.compiled.kept, Field::CONTACT_ACTIVITY);
        let at = fields.contains(active).then(|| fields.offset(active, D));
        (fields.width(D) - usize::from(at.is_some()), at)
    }

    /// Sends records that are kept.
    fn send_kept(&self) {
        let (stride, active) = self.kept();
        let (kept, count) = (self.host.kept_records(), self.host.columns().slots());
        let activity = self.host.columns().raw(Field::CONTACT_ACTIVITY);
        let images = self.host.images();
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
        self.device.write(&self.memory.kept, &all);
    }

    /// Takes records that are kept back.
    fn take_kept(&self) -> Result<(Vec<T>, usize), Error> {
        let (stride, active) = self.kept();
        if stride == 0 {
            return Ok((Vec::new(), 0));
        }
        let width = self.compiled.kept.width(D);
        let count = self.sizes.layout.slots + self.host.images().len() / 2;
        let all = self.read(&self.memory.kept, width * count)?;
        let own = all.iter().enumerate();
        let own = own.filter(|(k, _)| Some(k % width) != active);
        Ok((own.map(|(_, x)| T::from_f64(*x)).collect(), stride))
    }

    pub(crate) fn send_walls(&self, time: f64) {
        let walls = self.host.walls(time).into_iter();
        self.device.write(&self.memory.walls, &self.numbers(walls));
    }

    /// Sends what pairs share, if that has changed.
    pub(crate) fn send_settings(&mut self) {
        let force = self.host.body_force();
        if force == self.body_force {
            return;
        }
        self.body_force = force;
        let [h, factor] = self.host.scales();
        let shared = Shared {
            smoothing_length: h,
            lattice_consistency_factor: factor,
            body_force: force.to_vec(),
        };
        let mobile = self
            .host
            .blocks()
            .iter()
            .map(|block| f64::from(u8::from(!block.wall)));
        let mobile: Vec<_> = mobile.collect();
        let contacts = self.host.contacts().into_iter();
        let contacts: Vec<f64> = contacts.map(|own| f64::from(u8::from(own))).collect();
        for (to, table) in [
            (&self.memory.settings, mobile),
            (&self.memory.approach, self.host.seen()),
        ] {
            let table = [&table[..], &contacts].concat();
            let all = settings(self.compiled.support, &shared, &table);
            self.device.write(to, &self.numbers(all.into_iter()));
        }
    }

    /// Takes the whole state back, unless the host has it.
    pub(crate) fn take(&mut self) -> Result<(), Error> {
        if self.is_taken {
            return Ok(());
        }
        let layout = &self.sizes.layout;
        let (slots, end) = (layout.slots, layout.listed(0));
        let all = self.read(&self.memory.state, end)?;
        let column = |at: &dyn Fn(usize) -> usize, width: usize| -> Vec<T> {
            let number = |n: usize| T::from_f64(all[at(n % width) + n / width]);
            (0..slots * width).map(number).collect()
        };
        for field in layout.fields.iter() {
            let own = column(&|k| layout.field(field, k), field.components(D));
            self.host.columns_mut().raw_mut(field).copy_from_slice(&own);
        }
        let saved = layout.saved.iter().filter(|_| self.is_predicted);
        let saved = saved.map(|&field| {
            let own = column(&|k| layout.saved(field, k), field.components(D));
            (field, own)
        });
        self.host.take_saved(saved.collect());
        let counts = self.program.counts.iter().enumerate().map(|(k, own)| {
            let at = layout.count(k);
            let slots = &all[at + own.slots.start..at + own.slots.end];
            slots.iter().map(|count| count.round() as u64).sum::<u64>()
        });
        let counts: Vec<u64> = counts.collect();
        let new = counts.iter().zip(&self.counted);
        let new: Vec<f64> = new.map(|(now, then)| (now - then) as f64).collect();
        self.host.count(&new);
        self.counted = counts;
        let count = self.sizes.rates.width(D) * layout.mobile;
        let rates = self.read(&self.memory.rates, count)?;
        let rates: Vec<T> = rates.into_iter().map(T::from_f64).collect();
        let forces = self.forces.clone().unwrap_or_default();
        let kept = self.take_kept()?;
        self.host.take_rates(&rates, &forces, kept);
        self.is_taken = true;
        Ok(())
    }

    /// Sends what of a wall changes as it moves.
    pub(crate) fn send_wall(&self, slots: &Range<usize>) {
        let layout = &self.sizes.layout;
        for field in [
            Field::POSITION,
            Field::POSITION_RESIDUAL,
            Field::VELOCITY,
            Field::MASS,
        ] {
            let (column, width) = (self.host.columns().raw(field), field.components(D));
            if column.is_empty() {
                continue;
            }
            for k in 0..width {
                let own = slots.clone().map(|slot| column[slot * width + k].to_f64());
                let at = (layout.field(field, k) + slots.start) * self.precision.bytes();
                self.device
                    .write_at(&self.memory.state, at, &self.numbers(own));
            }
        }
    }
}
