//! A simulation whose steps run on a device: the operations of its integrator as launches, and what the host reads between them.
//! Lists, walls that move, votes and the ledger are the host's; everything that is done once a particle or pair is the device's.

use crate::compile::Sizes;
use crate::compiled::{Compiled, Memory};
use crate::fuse::Layout;
use crate::kernel::{pack, unpack};
use crate::stepping::Stepping;
use crate::{Device, Error, Part, PointKernel, Precision};
use meshfree::error::Error as HostError;
use meshfree::neighbors::Block;
use meshfree::scalar::{Real, Record};
use meshfree::simulation::Simulation;
use meshfree::simulation::device::{Advance, Approaching, Found, Moment, Offloaded, Program};
use std::sync::Arc;

/// Forces \[N\] between blocks: on which, from which.
type Forces<const D: usize> = Vec<([usize; 2], [f64; D])>;

/// A simulation whose steps run on a device. [`Device::load`] makes one.
#[derive(Debug)]
pub struct Run<T: Real, const D: usize> {
    pub(crate) host: Offloaded<T, D>,
    pub(crate) device: Device,
    pub(crate) program: Arc<Program>,
    pub(crate) precision: Precision,
    pub(crate) sizes: Sizes,
    pub(crate) compiled: Compiled,
    pub(crate) memory: Memory,
    /// Whether the host has the state of the device.
    pub(crate) is_taken: bool,
    /// Whether a vote of the present state is at hand.
    pub(crate) is_voted: bool,
    /// Forces between blocks of the last evaluation, once the host has read them, and the time \[s\] of kicks by them that are not
    /// booked yet.
    pub(crate) forces: Option<Forces<D>>,
    pub(crate) kicked: f64,
    /// Counts that the host has had, of the columns on the device.
    pub(crate) counted: Vec<u64>,
    pub(crate) is_predicted: bool,
    /// Why the next step is not taken.
    pub(crate) refused: Option<Error>,
    pub(crate) body_force: [f64; D],
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

/// Refuses a driver that does not keep what the rounding of a sum loses (Knuth's two-sum), as places in `f32` need it.
fn keeps_rounding(device: &Device) -> Result<(), Error> {
    let record = Record::of(2, |given| {
        let [a, b] = [given[0], given[1]];
        let sum = a + b;
        let part = sum - a;
        vec![sum, (a - (sum - part)) + (b - part)]
    });
    let record = record.map_err(|error| Error::Recorded {
        part: Part {
            kind: "record",
            name: "two-sum".into(),
        },
        what: error.what,
    })?;
    let kernel = PointKernel::new(device, "two-sum", &record, Precision::Single)?;
    let numbers: [f32; 6] = [1.0, 0.3, 1e6, -7.0, 3e-5, 1.0 / 3.0];
    let pairs = numbers.map(|a| numbers.map(|b| (a, b * 1e-4)));
    let [a, b]: [Vec<f64>; 2] = [0, 1].map(|k| {
        let own = pairs.as_flattened().iter();
        own.map(|pair| f64::from([pair.0, pair.1][k])).collect()
    });
    let found = kernel.run(device, &[&a, &b])?;
    let all = a.iter().zip(&b).zip(found[0].iter().zip(&found[1]));
    // In f64 the sum of both is exact.
    let is_kept = |((a, b), (sum, lost)): ((&f64, &f64), (&f64, &f64))| a + b == sum + lost;
    if all.into_iter().all(is_kept) {
        return Ok(());
    }
    Err(Error::Reordered {
        adapter: device.adapter().name.clone(),
    })
}

impl<T: Real, const D: usize> Run<T, D> {
    fn new(device: Device, simulation: Simulation<T, D>) -> Result<Self, Error> {
        let host = simulation.offload()?;
        let program = host.program();
        let precision = match size_of::<T>() {
            4 => Precision::Single,
            _ => Precision::Double,
        };
        if T::COMPENSATED {
            keeps_rounding(&device)?;
        }
        let blocks = host.blocks();
        // Blocks of images come behind those of all particles.
        let slots = host.columns().slots();
        let is_body = |block: &&Block| !block.wall && block.slots.start < slots;
        let bodies = blocks.iter().filter(is_body);
        let sizes = Sizes {
            layout: Layout {
                fields: host.columns().fields(),
                dimensions: D,
                slots: host.columns().slots(),
                mobile: host.mobile(),
                saved: program.saved.clone(),
                counts: program.counts.len(),
            },
            rates: host.rates().0,
            blocks: blocks.len(),
            bodies: bodies.map(|block| block.slots.clone()).collect(),
            cluster: host.cluster(),
            shared: host.shared(&host.begin_vote()).len(),
            settings: 3 + D + blocks.len() * (1 + blocks.len()),
        };
        let compiled = Compiled::new(&device, &program, &sizes, precision)?;
        let memory = compiled.room(&device, &sizes)?;
        let mut own = Self {
            counted: vec![0; program.counts.len()],
            host,
            device,
            program,
            precision,
            sizes,
            compiled,
            memory,
            is_taken: true,
            is_voted: false,
            forces: None,
            kicked: 0.0,
            is_predicted: false,
            refused: None,
            body_force: [f64::NAN; D],
        };
        own.send(own.time())?;
        own.forces = Some(own.host.forces());
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

    /// Takes the next step of the run, and returns its size \[s\].
    ///
    /// # Errors
    ///
    /// As [`run_until`](Self::run_until).
    pub fn step(&mut self) -> Result<f64, Error> {
        self.go_on()?;
        self.look()?;
        match self.host.advance(f64::INFINITY)? {
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
        if self.time() >= end {
            return Ok(false);
        }
        self.go_on()?;
        self.look()?;
        match self.host.advance(end)? {
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

    /// Goes on from the state after the last step, where another was shown.
    fn go_on(&mut self) -> Result<(), Error> {
        if let Some(error) = self.refused.take() {
            return Err(error);
        }
        self.host.check()?;
        if self.host.return_to_last_step() {
            self.send(self.time())?;
            self.forces = Some(self.host.forces());
            self.is_taken = true;
        }
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

    pub(crate) fn read(&self, from: &wgpu::Buffer, count: usize) -> Result<Vec<f64>, Error> {
        let bytes = count * self.precision.bytes();
        Ok(unpack(&self.device.download(from, bytes)?, self.precision))
    }

    pub(crate) fn share(&self, moment: &Moment) {
        let shared = self.host.shared(moment).into_iter();
        self.device
            .write(&self.memory.shared, &self.numbers(shared));
    }

    /// Votes on the next step, unless that is done.
    fn look(&mut self) -> Result<(), Error> {
        if self.is_voted {
            return Ok(());
        }
        let moment = self.host.begin_vote();
        self.share(&moment);
        let mut all = self.compiled.of(&self.compiled.lists.vote);
        all.extend(&self.compiled.of_vote);
        self.device.launch(&all);
        let count =
            self.compiled.vote.outputs + self.sizes.bodies.len() * self.compiled.forces.outputs;
        let found = self.read(&self.memory.votes, count)?;
        let (vote, forces) = found.split_at(self.compiled.vote.outputs);
        // Those of rates that came from the host are known.
        if self.forces.is_none() {
            self.book(self.forces_of(forces));
        }
        let found = Found {
            step: vote[0],
            slot: vote[1] as usize,
            criterion: vote[2] as usize,
            speed2: vote[3],
            length: vote[4],
            range: [vote[5..5 + D].to_vec(), vote[5 + D..5 + 2 * D].to_vec()],
        };
        if found.step < 0.0 {
            self.take()?;
        }
        let (device, compiled, memory) = (&self.device, &self.compiled, &self.memory);
        let (precision, mut met) = (self.precision, None);
        let voted = self.host.vote(&found, |host| {
            let shared = host.shared(&moment).into_iter();
            device.write(&memory.shared, &pack(shared, precision));
            let mut all = compiled.of(&compiled.lists.approach);
            all.extend(&compiled.of_approach);
            device.launch(&all);
            let bytes = compiled.approach.outputs * precision.bytes();
            let found = unpack(&device.download(&memory.meetings, bytes)?, precision);
            let own = Approaching {
                step: (found[0], found[1] as usize),
                mach: (-found[3], found[4] as usize),
            };
            met = Some(own);
            Ok::<_, Error>(own)
        });
        match (voted, met) {
            // The error names a particle, of which the host needs the state.
            (Err(Error::Simulation(HostError::SoundSpeedTooLow { .. })), Some(met)) => {
                self.take()?;
                self.host.vote(&found, |_| Ok::<_, Error>(met))?;
            }
            (voted, _) => voted?,
        }
        self.is_voted = true;
        Ok(())
    }

    pub(crate) fn forces_of(&self, numbers: &[f64]) -> Forces<D> {
        let mut all = Vec::new();
        for (on, numbers) in numbers.chunks(self.compiled.forces.outputs).enumerate() {
            for (from, force) in numbers.as_chunks::<D>().0.iter().enumerate() {
                if from != on {
                    all.push(([on, from], *force));
                }
            }
        }
        all
    }

    /// Books kicks by the forces of the last evaluation, which the host has now.
    pub(crate) fn book(&mut self, forces: Forces<D>) {
        if self.kicked != 0.0 {
            self.host.book(core::mem::take(&mut self.kicked), &forces);
        }
        self.forces = Some(forces);
    }
}
