//! The device itself: adapters, memory and kernels, by the driver that it is opened with.
//! What a driver refuses is an error here, before anything runs.

#[cfg(feature = "cuda")]
mod cuda;
mod vulkan;

use crate::kernel::{Array, Frame, THREADS};
use crate::split::MOST_ARRAYS;
use crate::{Dialect, Error, Language, Part, Precision};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use vulkan::Vulkan;

/// Bytes of whose multiples a binding may start.
const ALIGNED: u64 = 256;

/// What [`Device::list`] says about an adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Adapter {
    /// Its name, which [`Device::named`] takes.
    pub name: String,
    /// `DiscreteGpu`, `Cpu` for a driver in software, and so on.
    pub kind: String,
    /// The driver and its version.
    pub driver: String,
    /// Whether it computes in `f64`.
    pub double: bool,
    /// Bytes that a kernel can bind as one array.
    pub most_bound: u64,
    /// Arrays that a kernel can bind. An array beyond [`most_bound`](Self::most_bound) is bound as several.
    pub arrays: u32,
}

/// A device that kernels run on.
///
/// ```
/// use meshfree_gpu::{Device, Error};
/// match Device::open() {
///     Ok(device) => println!("{:?}", device.adapter()),
///     Err(Error::NoAdapter) => println!("no driver for Vulkan here"),
///     Err(error) => return Err(error),
/// }
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Device {
    driver: Driver,
    adapter: Adapter,
    threads: u32,
    traffic: Arc<[AtomicU64; 4]>,
}

/// What has gone over the bus, and what the device was told to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Kernels that were launched.
    pub launches: u64,
    /// Bytes to the device.
    pub sent: u64,
    /// Bytes from the device.
    pub received: u64,
    /// How often the host has waited for these.
    pub waits: u64,
}

/// The slots that a kernel runs for, and numbers that it is told.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extent {
    pub count: usize,
    pub first: usize,
    pub length: usize,
    pub stride: usize,
    pub target: usize,
}

impl Extent {
    pub fn of(slots: Range<usize>) -> Self {
        Self {
            count: slots.len(),
            first: slots.start,
            ..Self::default()
        }
    }

    /// The words that a kernel is told, with the threads of a row of groups.
    fn words(self, row: u32) -> [u32; 8] {
        let own = [self.first, self.length, self.stride, self.target];
        let [first, length, stride, target] = own.map(|own| own as u32);
        [self.count as u32, row, 0, first, length, stride, target, 0]
    }
}

/// What a device is driven by.
#[derive(Clone, Debug)]
enum Driver {
    Vulkan(Vulkan),
    #[cfg(feature = "cuda")]
    Cuda(cuda::Cuda),
    /// Nothing: kernels are kept as text, each with its name.
    Text(Language, Arc<Mutex<Vec<(String, String)>>>),
}

// What a driver has made, which is never handed to another one.
macro_rules! made {
    ($($(#[$meta:meta])* $name:ident: $vulkan:ty, $cuda:ty;)*) => { $(
        $(#[$meta])*
        #[derive(Debug)]
        pub(crate) enum $name {
            Vulkan($vulkan),
            #[cfg(feature = "cuda")]
            Cuda($cuda),
            Text,
        }

        impl $name {
            fn vulkan(&self) -> &$vulkan {
                let Self::Vulkan(own) = self else {
                    unreachable!("made by another driver")
                };
                own
            }
            #[cfg(feature = "cuda")]
            fn cuda(&self) -> &$cuda {
                let Self::Cuda(own) = self else {
                    unreachable!("made by another driver")
                };
                own
            }
        }
    )* };
}

made! {
    /// Memory of a device, which copies share.
    #[derive(Clone)]
    Buffer: wgpu::Buffer, Arc<cuda::Memory>;
    /// A compiled kernel.
    Kernel: vulkan::Kernel, cuda::Kernel;
    /// A kernel with what it works on.
    Bound: vulkan::Bound, cuda::Bound;
}

impl Buffer {
    /// Whether it is the same memory.
    pub fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Vulkan(own), Self::Vulkan(other)) => own == other,
            #[cfg(feature = "cuda")]
            (Self::Cuda(own), Self::Cuda(other)) => Arc::ptr_eq(own, other),
            _ => false,
        }
    }
}

/// An adapter that can be opened.
enum Found {
    Vulkan(wgpu::Adapter),
    #[cfg(feature = "cuda")]
    Cuda(cuda::Card),
}

impl Found {
    /// All, of which by Vulkan a card that CUDA has too stands behind.
    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        #[cfg(feature = "cuda")]
        all.extend(cuda::cards().into_iter().map(Self::Cuda));
        all.extend(vulkan::adapters().into_iter().map(Self::Vulkan));
        all
    }

    fn describe(&self) -> Adapter {
        match self {
            Self::Vulkan(own) => vulkan::describe(own),
            #[cfg(feature = "cuda")]
            Self::Cuda(own) => own.describe(),
        }
    }

    /// Its place among all: the fastest kind is the first.
    fn rank(&self) -> u8 {
        match self {
            Self::Vulkan(own) => vulkan::rank(own),
            #[cfg(feature = "cuda")]
            Self::Cuda(_) => 0,
        }
    }

    fn open(&self) -> Result<Device, Error> {
        let opened = match self {
            Self::Vulkan(own) => Vulkan::open(own).map(Driver::Vulkan),
            #[cfg(feature = "cuda")]
            Self::Cuda(own) => cuda::Cuda::open(*own).map(Driver::Cuda),
        };
        let adapter = self.describe();
        match opened {
            Ok(driver) => Ok(Device::driven(driver, adapter)),
            Err(message) => Err(Error::Refused {
                adapter: adapter.name,
                message,
            }),
        }
    }
}

impl Device {
    /// The adapters of this machine; empty without a driver. With the feature `cuda` cards of NVIDIA stand there twice, once as `… (CUDA 0)`.
    #[must_use]
    pub fn list() -> Vec<Adapter> {
        Found::all().iter().map(Found::describe).collect()
    }

    /// Opens the fastest kind of adapter that there is: a card, then what is built into the processor, then a driver in software. With the
    /// feature `cuda` that is a card by CUDA where there is its driver, and NVRTC or a folder of cubins ([`nvrtc`](crate::nvrtc)).
    ///
    /// # Errors
    ///
    /// [`Error::NoAdapter`] without any, [`Error::Refused`] if it cannot be opened.
    pub fn open() -> Result<Self, Error> {
        let best = Found::all().into_iter().min_by_key(Found::rank);
        best.ok_or(Error::NoAdapter)?.open()
    }

    /// Opens the adapter of a name, as [`Device::list`] gives it.
    ///
    /// # Errors
    ///
    /// [`Error::NoAdapter`] without any, [`Error::UnknownAdapter`] if none is called so, [`Error::Refused`] if it cannot be opened.
    pub fn named(name: &str) -> Result<Self, Error> {
        let all = Found::all();
        if all.is_empty() {
            return Err(Error::NoAdapter);
        }
        let names = || all.iter().map(|own| own.describe().name);
        let own = names().position(|own| own == name);
        let own = own.ok_or_else(|| Error::UnknownAdapter {
            wanted: name.into(),
            found: names().collect(),
        })?;
        all[own].open()
    }

    fn driven(driver: Driver, adapter: Adapter) -> Self {
        Self {
            driver,
            adapter,
            threads: THREADS,
            traffic: Arc::default(),
        }
    }

    /// None, for which kernels are written in a language: what it is given is kept, and not run.
    pub(crate) fn of_text(language: Language) -> Self {
        let adapter = Adapter {
            name: format!("{language:?}"),
            kind: "Other".into(),
            driver: String::new(),
            double: true,
            most_bound: u64::MAX,
            arrays: u32::MAX,
        };
        Self::driven(Driver::Text(language, Arc::default()), adapter)
    }

    /// The kernels that were made where there is no device.
    pub(crate) fn texts(&self) -> Vec<(String, String)> {
        let Driver::Text(_, all) = &self.driver else {
            return Vec::new();
        };
        all.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What its kernels are written in.
    pub(crate) fn dialect(&self, precision: Precision) -> Dialect {
        let language = match &self.driver {
            Driver::Vulkan(_) => Language::Wgsl,
            #[cfg(feature = "cuda")]
            Driver::Cuda(_) => Language::Cuda,
            Driver::Text(language, _) => *language,
        };
        Dialect {
            language,
            precision,
        }
    }

    /// The adapter that it was opened on.
    #[must_use]
    pub fn adapter(&self) -> &Adapter {
        &self.adapter
    }

    /// Another number of threads a work group, for kernels that are made from now on; 64 by default. Results are the same.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if that is zero, or more than the device takes.
    pub fn with_threads(mut self, threads: u32) -> Result<Self, Error> {
        let most = match &self.driver {
            Driver::Vulkan(own) => own.most_threads(),
            #[cfg(feature = "cuda")]
            Driver::Cuda(_) => cuda::MOST_THREADS,
            Driver::Text(..) => u32::MAX,
        };
        let fits = (1..=most).contains(&threads);
        let sizes = [threads as usize, most as usize];
        Error::unless(fits, "threads of a work group, at most", sizes)?;
        self.threads = threads;
        Ok(self)
    }

    /// The same as an adapter would be that has less: no `f64`, or less to bind as one array \[bytes\]. So one sees what that refuses.
    #[must_use]
    pub fn as_lesser(mut self, double: bool, most_bound: u64) -> Self {
        self.adapter.double &= double;
        self.adapter.most_bound = self.adapter.most_bound.min(most_bound);
        self
    }

    /// What has gone over the bus since it was opened, by all that was loaded on it.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        let [launches, sent, received, waits] =
            [0, 1, 2, 3].map(|k| self.traffic[k].load(Ordering::Relaxed));
        Traffic {
            launches,
            sent,
            received,
            waits,
        }
    }

    fn count(&self, what: usize, by: u64) {
        self.traffic[what].fetch_add(by, Ordering::Relaxed);
    }

    /// Refuses a kernel that was made for another device, or by Vulkan for the same one opened another time.
    pub(crate) fn owns(&self, kernel: &Kernel) -> Result<(), Error> {
        let owns = match (&self.driver, kernel) {
            (Driver::Vulkan(own), Kernel::Vulkan(kernel)) => own.owns(kernel),
            #[cfg(feature = "cuda")]
            (Driver::Cuda(own), Kernel::Cuda(kernel)) => own.owns(kernel),
            (Driver::Text(..), Kernel::Text) => true,
            _ => false,
        };
        owns.then_some(()).ok_or(Error::OtherDevice)
    }

    /// Refuses a precision that the adapter does not have.
    pub(crate) fn can(&self, precision: Precision) -> Result<(), Error> {
        if precision == Precision::Double && !self.adapter.double {
            return Err(Error::NoDouble {
                adapter: self.adapter.name.clone(),
            });
        }
        Ok(())
    }

    /// Compiles a kernel of a part, by its kind and name, from its body.
    pub(crate) fn kernel(
        &self,
        (kind, name): (&'static str, &str),
        (dialect, buffers): (Dialect, &[Array]),
        body: &str,
    ) -> Result<Kernel, Error> {
        self.can(dialect.precision)?;
        let frame = Frame {
            dialect,
            name: "kernel",
            buffers,
        };
        let part = Part {
            kind,
            name: name.into(),
        };
        let made = match &self.driver {
            Driver::Vulkan(own) => own.kernel(&frame, body, self.threads).map(Kernel::Vulkan),
            #[cfg(feature = "cuda")]
            Driver::Cuda(own) => own.kernel(&frame, body, self.threads).map(Kernel::Cuda),
            Driver::Text(_, all) => {
                let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
                all.push((part.to_string(), frame.source(body, self.threads)));
                Ok(Kernel::Text)
            }
        };
        made.map_err(|message| Error::Kernel { part, message })
    }

    /// Bytes of a part of what is bound in parts: they start at multiples that all drivers take.
    fn part(&self) -> u64 {
        self.adapter.most_bound / ALIGNED * ALIGNED
    }

    fn fits(&self, what: &'static str, bytes: u64) -> Result<(), Error> {
        // So that a kernel whose arrays all have so many parts can bind them.
        let parts = u64::from(self.adapter.arrays / MOST_ARRAYS);
        let most = (self.part().saturating_mul(parts)).max(self.adapter.most_bound);
        if bytes > most {
            return Err(Error::TooLarge { what, bytes, most });
        }
        Ok(())
    }

    /// Room for some bytes, all zero.
    pub(crate) fn room(&self, what: &'static str, bytes: usize) -> Result<Buffer, Error> {
        let size = (bytes as u64).max(16).next_multiple_of(16);
        self.fits(what, size)?;
        match &self.driver {
            Driver::Vulkan(own) => own.room(what, size).map(Buffer::Vulkan),
            #[cfg(feature = "cuda")]
            Driver::Cuda(own) => own.room(what, size).map(Buffer::Cuda),
            Driver::Text(..) => Ok(Buffer::Text),
        }
    }

    /// Room that holds some bytes.
    pub(crate) fn upload(&self, what: &'static str, bytes: &[u8]) -> Result<Buffer, Error> {
        let buffer = self.room(what, bytes.len())?;
        self.write(&buffer, bytes);
        Ok(buffer)
    }

    /// Writes bytes to the start of what has room for them.
    pub(crate) fn write(&self, buffer: &Buffer, bytes: &[u8]) {
        self.write_at(buffer, 0, bytes);
    }

    /// Writes bytes to a place of what has room for them.
    pub(crate) fn write_at(&self, buffer: &Buffer, at: usize, bytes: &[u8]) {
        self.count(1, bytes.len() as u64);
        match &self.driver {
            Driver::Vulkan(own) => own.write(buffer.vulkan(), at, bytes),
            #[cfg(feature = "cuda")]
            Driver::Cuda(own) => own.write(buffer.cuda(), at, bytes),
            Driver::Text(..) => {}
        }
    }

    /// Binds buffers to a kernel that runs for some particles.
    pub(crate) fn bind(&self, kernel: &Kernel, buffers: &[&Buffer], count: usize) -> Bound {
        self.bind_over(kernel, buffers, Extent::of(0..count))
    }

    /// The same, for particles from one on.
    pub(crate) fn bind_over(&self, kernel: &Kernel, buffers: &[&Buffer], extent: Extent) -> Bound {
        match &self.driver {
            Driver::Vulkan(own) => {
                let buffers: Vec<_> = buffers.iter().map(|own| own.vulkan()).collect();
                let most = [self.adapter.most_bound, self.part()];
                Bound::Vulkan(own.bind(kernel.vulkan(), &buffers, extent, most))
            }
            #[cfg(feature = "cuda")]
            Driver::Cuda(own) => {
                let buffers = buffers.iter().map(|own| own.cuda().clone()).collect();
                Bound::Cuda(own.bind(kernel.cuda(), buffers, extent))
            }
            Driver::Text(..) => Bound::Text,
        }
    }

    /// Runs kernels one after another: each sees what those before it have written.
    pub(crate) fn launch<'a>(&self, kernels: impl IntoIterator<Item = &'a Bound>) {
        let kernels = kernels.into_iter().inspect(|_| self.count(0, 1));
        match &self.driver {
            Driver::Vulkan(own) => own.launch(kernels.map(Bound::vulkan)),
            #[cfg(feature = "cuda")]
            Driver::Cuda(own) => own.launch(kernels.map(Bound::cuda)),
            Driver::Text(..) => {}
        }
    }

    /// Bytes of a buffer from a place on, after all that was launched.
    pub(crate) fn download(
        &self,
        buffer: &Buffer,
        at: usize,
        bytes: usize,
    ) -> Result<Vec<u8>, Error> {
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let size = (bytes as u64).next_multiple_of(8);
        self.count(2, size);
        self.count(3, 1);
        let read = match &self.driver {
            Driver::Vulkan(own) => own.read(buffer.vulkan(), at, size),
            #[cfg(feature = "cuda")]
            Driver::Cuda(own) => own.read(buffer.cuda(), at, bytes),
            Driver::Text(..) => Err("there is none".into()),
        };
        let mut read = read.map_err(|message| Error::Lost { message })?;
        read.truncate(bytes);
        Ok(read)
    }
}
