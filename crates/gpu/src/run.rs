//! A simulation whose steps run on a device: the operations of its integrator as launches, and what the host reads between them.
//! Images, walls that move, votes and the ledger are the host's; everything that is done once a particle or pair is the device's.

use crate::compile::Sizes;
use crate::compiled::{Compiled, Memory};
use crate::contact::Contact;
use crate::device::Buffer;
use crate::follow::Link;
use crate::kernel::{pack, unpack};
use crate::lists::Builder;
use crate::rounding::keeps_rounding;
use crate::stepping::Stepping;
use crate::{Device, Error, Language, Precision};
use meshfree::error::Error as HostError;
use meshfree::scalar::Real;
use meshfree::simulation::Simulation;
use meshfree::simulation::device::{
    Advance, Approaching, Forces, Found, Moment, Offloaded, Program,
};
use std::sync::Arc;

/// A simulation whose steps run on a device. [`Device::load`] makes one.
#[derive(Debug)]
pub struct Run<T: Real, const D: usize> {
    pub(crate) host: Offloaded<T, D>,
    pub(crate) device: Device,
    pub(crate) precision: Precision,
    pub(crate) groups: Vec<Group>,
    pub(crate) links: Vec<Link>,
    pub(crate) contacts: Vec<Contact>,
    /// Whether the host has the state of the device.
    pub(crate) is_taken: bool,
    /// Whether a vote of the present state is at hand.
    pub(crate) is_voted: bool,
    /// Forces between blocks of the last evaluation, group by group, once the host has read them, and the time \[s\] of kicks by them
    /// that are not booked yet.
    pub(crate) forces: Option<Vec<Forces<D>>>,
    pub(crate) kicked: f64,
    /// Why the next step is not taken.
    pub(crate) refused: Option<Error>,
}

/// A group of bodies under one scheme, on the device.
#[derive(Debug)]
pub(crate) struct Group {
    pub program: Arc<Program>,
    pub sizes: Sizes,
    pub compiled: Compiled,
    pub memory: Memory,
    /// What builds its lists, unless the host does.
    pub builder: Option<Builder>,
}

impl Group {
    fn new<T: Real, const D: usize>(
        device: &Device,
        host: &Offloaded<T, D>,
        number: usize,
        precision: Precision,
    ) -> Result<Self, Error> {
        let program = host.program(number);
        let blocks = host.blocks(number).len();
        let sizes = Sizes {
            layout: host.layout(number).clone(),
            rates: host.rates(number).0,
            blocks,
            cluster: host.cluster(),
            shared: host.shared(number, &host.begin_vote()).len(),
            settings: 3 + D + blocks * (1 + blocks),
        };
        let compiled = Compiled::new(device, &program, &sizes, precision)?;
        let memory = compiled.room(device, &sizes, &program)?;
        let builds = host.builds_lists(number);
        let builder = builds.then(|| Builder::new(device, (host, number, &sizes), precision));
        Ok(Self {
            builder: builder.transpose()?,
            memory,
            program,
            sizes,
            compiled,
        })
    }

    /// How many numbers a vote gives, with the forces between blocks.
    fn votes(&self) -> usize {
        self.compiled.vote.outputs + self.program.feels.len() * self.compiled.forces.outputs
    }
}

impl Device {
    /// Lets the steps of a simulation run on the device, from where it is.
    ///
    /// ```no_run
    /// use meshfree::prelude::*;
    /// use meshfree_gpu::Device;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let water = catalogue::weakly_compressible_water(2.0);
    /// let tank = Scene::<f64, 2>::new(schemes::weakly_compressible())
    ///     .body(Body::block("water", water, [0.0; 2], [0.3, 0.2], 0.02))
    ///     .wall(Wall::around("tank", [0.0; 2], [0.3, 0.3], 0.02, 3, [[true, true], [true, false]]))
    ///     .acceleration(|_| [0.0, -9.81]);
    /// let mut run = Device::open()?.load(tank.build()?)?;
    /// run.run_until(0.5)?;
    /// let simulation = run.into_simulation()?;
    /// assert!(simulation.steps() > 0);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Simulation`] with every part of the scene that does not run there, [`Error::NoDouble`] for a simulation in `f64` on an
    /// adapter without, [`Error::TooLarge`], [`Error::OutOfMemory`] and [`Error::Kernel`] as they say.
    pub fn load<T: Real, const D: usize>(
        &self,
        simulation: Simulation<T, D>,
    ) -> Result<Run<T, D>, Error> {
        Run::new(self.clone(), simulation)
    }
}

/// What a device has of a simulation: groups, what links them, and couplings by forces.
type Made = (Precision, Vec<Group>, Vec<Link>, Vec<Contact>);

fn made<T: Real, const D: usize>(device: &Device, host: &Offloaded<T, D>) -> Result<Made, Error> {
    let precision = match size_of::<T>() {
        4 => Precision::Single,
        _ => Precision::Double,
    };
    let group = |number| Group::new(device, host, number, precision);
    let groups = (0..host.groups()).map(group);
    let groups = groups.collect::<Result<Vec<_>, _>>()?;
    let links = Link::all(device, &groups, precision)?;
    let contacts = host.couplings().iter();
    let contacts = contacts.map(|own| Contact::new(device, &groups, own, precision));
    let contacts = contacts.collect::<Result<Vec<_>, _>>()?;
    Ok((precision, groups, links, contacts))
}

/// The kernels of the steps of a simulation, each with its name, in a language: what [`Device::load`] compiles, written without a device.
///
/// ```
/// use meshfree::prelude::*;
/// use meshfree_gpu::{Language, sources};
/// let rod = Scene::<f64, 1>::new(schemes::impact())
///     .body(Body::block("rod", catalogue::copper(), [0.0], [0.01], 2e-4))
///     .build()?;
/// let kernels = sources(rod, Language::Cuda)?;
/// assert!(kernels.iter().all(|(_, text)| text.contains("__global__")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`Error::Simulation`] with every part of the scene that does not run on a device.
pub fn sources<T: Real, const D: usize>(
    simulation: Simulation<T, D>,
    language: Language,
) -> Result<Vec<(String, String)>, Error> {
    let paper = Device::of_text(language);
    made(&paper, &simulation.offload()?)?;
    Ok(paper.texts())
}

impl<T: Real, const D: usize> Run<T, D> {
    fn new(device: Device, simulation: Simulation<T, D>) -> Result<Self, Error> {
        let host = simulation.offload()?;
        if T::COMPENSATED {
            keeps_rounding(&device)?;
        }
        let (precision, groups, links, contacts) = made(&device, &host)?;
        let mut own = Self {
            host,
            device,
            precision,
            groups,
            links,
            contacts,
            is_taken: true,
            is_voted: false,
            forces: None,
            kicked: 0.0,
            refused: None,
        };
        own.send_all()?;
        Ok(own)
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Time \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.host.simulation().time()
    }

    /// Steps taken.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.host.simulation().steps()
    }

    /// Neighbour lists built, of all groups.
    #[must_use]
    pub fn list_builds(&self) -> u64 {
        self.host.simulation().list_builds()
    }

    /// Takes the next step of the run, and returns its size \[s\].
    ///
    /// # Errors
    ///
    /// As [`run_until`](Self::run_until).
    pub fn step(&mut self) -> Result<f64, Error> {
        match self.next(f64::INFINITY)? {
            Advance::Step(size) => self.take_step(size).map(|()| size),
            _ => Ok(0.0),
        }
    }

    /// Steps until `end` \[s\], as [`Simulation::run_until`] does: no step is cut, and what is shown at an end between two steps is a copy
    /// that has taken a shortened step.
    ///
    /// # Errors
    ///
    /// [`Error::Simulation`] with the errors of [`Simulation::run_until`], [`Error::Lost`] if the device fails.
    pub fn run_until(&mut self, end: f64) -> Result<(), Error> {
        while self.step_until(end)? {}
        Ok(())
    }

    /// The same, with the simulation shown to `observe` after every step, and at the end if that is between two steps. It costs a copy
    /// of all columns each time.
    ///
    /// # Errors
    ///
    /// As [`run_until`](Self::run_until).
    pub fn run_with(
        &mut self,
        end: f64,
        mut observe: impl FnMut(&Simulation<T, D>),
    ) -> Result<(), Error> {
        while self.step_until(end)? {
            observe(self.simulation()?);
        }
        Ok(())
    }

    /// Takes the next step of the run if it ends by `end` \[s\], and otherwise shows the state at that time; whether time went on.
    ///
    /// # Errors
    ///
    /// As [`run_until`](Self::run_until).
    pub fn step_until(&mut self, end: f64) -> Result<bool, Error> {
        self.host.check_end(end)?;
        if self.time() >= end {
            return Ok(false);
        }
        match self.next(end)? {
            Advance::Done => return Ok(false),
            Advance::Step(size) => {
                self.take_step(size)?;
                self.host.show_rounded(end);
            }
            Advance::Reading(size) => {
                self.take()?;
                self.host.begin_reading();
                self.take_step(size)?;
                self.take()?;
                self.host.show(end);
            }
        }
        Ok(true)
    }

    /// The simulation as it is now: all columns are copied, unless they were since the last step.
    ///
    /// # Errors
    ///
    /// [`Error::Lost`] if the device fails.
    pub fn simulation(&mut self) -> Result<&Simulation<T, D>, Error> {
        self.take()?;
        Ok(self.host.simulation())
    }

    /// The simulation, which steps on the host again, and can be saved there.
    ///
    /// # Errors
    ///
    /// [`Error::Lost`] if the device fails.
    pub fn into_simulation(mut self) -> Result<Simulation<T, D>, Error> {
        self.take()?;
        Ok(self.host.into_simulation())
    }

    /// What has become of an operation, by its own error or one of the device. A run goes no further after either.
    pub(crate) fn went(
        &mut self,
        own: Result<(), HostError>,
        lost: Option<Error>,
    ) -> Result<(), Error> {
        if let Some(lost) = lost {
            let cause = lost.to_string();
            self.host.fail(HostError::Failed { cause });
            return Err(lost);
        }
        own.map_err(|error| self.host.fail(error).into())
    }

    /// Goes on from the state after the last step, where another was shown: what is to be done next until `end` \[s\].
    fn next(&mut self, end: f64) -> Result<Advance, Error> {
        if let Some(error) = self.refused.take() {
            return Err(error);
        }
        self.host.check()?;
        if self.host.return_to_last_step() {
            self.send_all()?;
        }
        self.look()?;
        Ok(self.host.advance(end)?)
    }

    /// Takes the state of the host to the device, with the forces of its rates.
    fn send_all(&mut self) -> Result<(), Error> {
        for group in 0..self.groups.len() {
            self.send(group, self.time())?;
        }
        let forces = (0..self.groups.len()).map(|group| self.host.forces(group));
        self.forces = Some(forces.collect());
        self.is_taken = true;
        Ok(())
    }

    fn take_step(&mut self, size: f64) -> Result<(), Error> {
        self.host.begin_step()?;
        let integrator = self.host.integrator();
        self.is_voted = false;
        self.is_taken = false;
        let mut system = Stepping {
            run: self,
            lost: None,
        };
        let stepped = integrator.step(&mut system, size);
        let lost = system.lost.take();
        self.went(stepped, lost)?;
        self.host.end_step();
        // What has become of the step is seen at once, with what the next one may be.
        match self.look() {
            // The step itself is sound: as on the host, the next one is refused.
            Err(error @ Error::Simulation(HostError::SoundSpeedTooLow { .. })) => {
                self.refused = Some(error);
            }
            looked => looked?,
        }
        if self.host.looks_at_energy() {
            self.take()?;
            self.host.look_at_energy()?;
        }
        Ok(())
    }

    pub(crate) fn numbers(&self, all: impl Iterator<Item = f64>) -> Vec<u8> {
        pack(all, self.precision)
    }

    pub(crate) fn read(&self, from: &Buffer, count: usize) -> Result<Vec<f64>, Error> {
        self.read_at(from, 0, count)
    }

    pub(crate) fn read_at(
        &self,
        from: &Buffer,
        first: usize,
        count: usize,
    ) -> Result<Vec<f64>, Error> {
        let [at, bytes] = [first, count].map(|own| own * self.precision.bytes());
        let bytes = self.device.download(from, at, bytes)?;
        Ok(unpack(&bytes, self.precision))
    }

    pub(crate) fn share(&self, group: usize, moment: &Moment) {
        let shared = self.host.shared(group, moment).into_iter();
        let memory = &self.groups[group].memory;
        self.device.write(&memory.shared, &self.numbers(shared));
    }

    /// What groups have voted for, and the forces between their blocks.
    pub(crate) fn votes(&self) -> Result<(Vec<Vec<f64>>, Vec<Forces<D>>), Error> {
        let (mut votes, mut forces) = (Vec::new(), Vec::new());
        for own in &self.groups {
            let mut found = self.read(&own.memory.votes, own.votes())?;
            let of_blocks = found.split_off(own.compiled.vote.outputs);
            let (mut all, width) = (Vec::new(), own.compiled.forces.outputs);
            for ((on, _), numbers) in own.program.feels.iter().zip(of_blocks.chunks(width)) {
                for (from, force) in numbers.as_chunks::<D>().0.iter().enumerate() {
                    if from != *on {
                        all.push(([*on, from], *force));
                    }
                }
            }
            votes.push(found);
            forces.push(all);
        }
        Ok((votes, forces))
    }

    /// Votes on the next step, unless that is done.
    fn look(&mut self) -> Result<(), Error> {
        if self.is_voted {
            return Ok(());
        }
        let moment = self.host.begin_vote();
        for (number, group) in self.groups.iter().enumerate() {
            self.share(number, &moment);
            let own = &group.compiled;
            let all = own.of(&own.lists.vote).into_iter();
            self.device.launch(all.chain(&own.vote.bound));
        }
        let (votes, forces) = self.votes()?;
        // Those of rates that came from the host are known.
        if self.forces.is_none() {
            self.book(forces);
        }
        let found = votes.iter().map(|vote| Found {
            step: vote[0],
            slot: vote[1] as usize,
            criterion: vote[2] as usize,
            speed2: vote[3],
            length: vote[4],
            acceleration: vote[5],
            range: [vote[6..6 + D].to_vec(), vote[6 + D..6 + 2 * D].to_vec()],
        });
        let found: Vec<_> = found.collect();
        if found.iter().any(|found| found.step < 0.0) {
            self.take()?;
        }
        let (device, groups, precision) = (&self.device, &self.groups, self.precision);
        let mut met = vec![None; groups.len()];
        let voted = self.host.vote(&found, |host, number| {
            let Group {
                compiled, memory, ..
            } = &groups[number];
            let shared = host.shared(number, &moment).into_iter();
            device.write(&memory.shared, &pack(shared, precision));
            let all = compiled.of(&compiled.lists.approach).into_iter();
            device.launch(all.chain(&compiled.approach.bound));
            let bytes = compiled.approach.outputs * precision.bytes();
            let found = unpack(&device.download(&memory.meetings, 0, bytes)?, precision);
            let own = Approaching {
                step: (found[0], found[1] as usize),
                mach: (-found[3], found[4] as usize),
            };
            met[number] = Some(own);
            Ok::<_, Error>(own)
        });
        if let Err(Error::Simulation(HostError::SoundSpeedTooLow { .. })) = voted {
            // The error names a particle, of which the host needs the state.
            self.take()?;
            self.host.vote(&found, |_, number| {
                let none = || Error::Lost {
                    message: "no answer".into(),
                };
                met[number].ok_or_else(none)
            })?;
        }
        voted?;
        self.is_voted = true;
        Ok(())
    }

    /// Books kicks by the forces of the last evaluation, which the host has now.
    pub(crate) fn book(&mut self, forces: Vec<Forces<D>>) {
        if self.kicked != 0.0 {
            self.host.book(core::mem::take(&mut self.kicked), &forces);
        }
        self.forces = Some(forces);
    }
}
