//! What goes over the bus as a whole: the state of a simulation, its lists and walls, to the device and back.
//! Where the device builds lists nothing of it does during a run.

use crate::run::Run;
use crate::{Error, PairLists};
use meshfree::scalar::Real;
use meshfree::simulation::device::{Array, Numbers};

impl<T: Real, const D: usize> Run<T, D> {
    pub(crate) fn write(&self, group: usize, all: &[Numbers]) {
        let memory = &self.groups[group].memory;
        for own in all {
            let at = own.at * self.precision.bytes();
            let numbers = self.numbers(own.numbers.iter().copied());
            self.device.write_at(memory.of(own.array), at, &numbers);
        }
    }

    /// Takes the whole state of a group to the device, with walls as they are at a time \[s\].
    pub(crate) fn send(&mut self, group: usize, time: f64) -> Result<(), Error> {
        let all = self.host.sent(group, time);
        // Those of what is kept have as many as there are images.
        let (kept, all): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|own| own.array == Array::Kept);
        self.write(group, &all);
        if !self.list_as_sent(group)? {
            let (lists, blocks) = (self.host.lists(group), self.host.blocks(group));
            let lists = PairLists::new(lists, blocks, self.host.cluster());
            let images = self.host.images(group);
            let transforms = self.numbers(self.host.transforms(group).into_iter());
            let own = &mut self.groups[group];
            own.compiled.bind(
                &self.device,
                &mut own.memory,
                (&own.sizes, &own.program),
                (Some(&lists), &images, &transforms),
            )?;
        }
        self.write(group, &kept);
        self.follow();
        self.meet_as_listed(group)?;
        self.is_voted = false;
        Ok(())
    }

    /// Tells the device which particles of walls that are bodies of other groups are which.
    pub(crate) fn follow(&self) {
        for link in &self.links {
            let maps = self.host.followed(link.wall[0], link.wall[1]);
            link.send(&self.device, &maps);
        }
    }

    /// Tells the device the pairs of couplings by forces of a group.
    pub(crate) fn meet_as_listed(&mut self, group: usize) -> Result<(), Error> {
        for contact in 0..self.contacts.len() {
            if self.contacts[contact].has(group) {
                self.send_partners(contact)?;
            }
        }
        Ok(())
    }

    /// Takes the pairs of a coupling to the device.
    fn send_partners(&mut self, contact: usize) -> Result<(), Error> {
        let sides = 0..self.host.couplings()[contact].sides.len();
        let all: Vec<_> = sides
            .map(|side| self.host.partners(contact, side))
            .collect();
        self.contacts[contact].send(&self.device, &self.groups, &all)
    }

    /// Particles of all couplings by forces feel these. The host reads a few numbers of each.
    pub(crate) fn meet(&mut self, time: f64) -> Result<(), Error> {
        for number in 0..self.contacts.len() {
            loop {
                let contact = &self.contacts[number];
                self.device.launch(&contact.bound);
                let width = contact.width();
                let sides = self.host.couplings()[number].sides.len();
                let found = self.read(&contact.found, width * sides)?;
                let found: Vec<_> = found.chunks(width).collect();
                if self.host.take_contact(number, &found)? {
                    break;
                }
                for group in contact.groups() {
                    self.take_group(group)?;
                }
                for (group, numbers) in self.host.list_contact(number, time) {
                    self.write(group, &[numbers]);
                }
                self.send_partners(number)?;
            }
        }
        Ok(())
    }

    /// Takes the whole state back, unless the host has it.
    pub(crate) fn take(&mut self) -> Result<(), Error> {
        if !self.is_taken {
            (0..self.groups.len()).try_for_each(|group| self.take_group(group))?;
        }
        self.is_taken = true;
        Ok(())
    }

    /// Takes the state of a group back.
    pub(crate) fn take_group(&mut self, group: usize) -> Result<(), Error> {
        let memory = &self.groups[group].memory;
        let wanted = self.host.wanted(group).into_iter();
        let found = wanted.map(|(array, at, count)| self.read_at(memory.of(array), at, count));
        let found = found.collect::<Result<Vec<_>, _>>()?;
        let none = Vec::new();
        let forces = self.forces.as_ref().map_or(&none, |all| &all[group]);
        let rest = self.host.taken(group, &found, forces);
        self.write(group, &rest);
        Ok(())
    }
}
