//! A device by CUDA, through `cudarc`: kernels are in CUDA C, and all is done in the order of the default stream.
//! It was run against a stand-in for the driver, with kernels compiled for the host, and on no card, since none could be reached.

use super::{Adapter, Extent};
use crate::kernel::Frame;
use crate::{Error, nvrtc};
use core::ffi::c_void;
use cudarc::driver::{CudaContext, CudaFunction, DriverError, result, sys};
use cudarc::nvrtc::Ptx;
use std::sync::Arc;

/// Threads of a block that every card takes.
pub const MOST_THREADS: u32 = 1024;

/// A card, by its number.
#[derive(Clone, Copy, Debug)]
pub struct Card {
    number: i32,
    device: sys::CUdevice,
}

fn said(error: DriverError) -> String {
    error.to_string()
}

/// The cards of this machine; none without the driver, or with nothing to compile kernels by.
pub fn cards() -> Vec<Card> {
    // SAFETY: loading the library runs its initialisers and nothing else.
    if !(unsafe { sys::is_culib_present() } && nvrtc::has_code()) || result::init().is_err() {
        return Vec::new();
    }
    let card = |number| {
        let device = result::device::get(number).ok()?;
        Some(Card { number, device })
    };
    let count = result::device::get_count().unwrap_or(0);
    (0..count).filter_map(card).collect()
}

impl Card {
    /// Its architecture, as `sm_90`.
    fn architecture(self) -> Result<String, DriverError> {
        use sys::CUdevice_attribute as A;
        // SAFETY: the device is one that the driver has given.
        let number = |what| unsafe { result::device::get_attribute(self.device, what) };
        let major = number(A::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR)?;
        let minor = number(A::CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR)?;
        Ok(format!("sm_{major}{minor}"))
    }

    pub fn describe(self) -> Adapter {
        let name = result::device::get_name(self.device).unwrap_or_default();
        let mut version = 0;
        // SAFETY: it is given a place for a number.
        let _ = unsafe { sys::cuDriverGetVersion(&raw mut version) };
        // SAFETY: the device is one that the driver has given.
        let most = unsafe { result::device::total_mem(self.device) };
        Adapter {
            name: format!("{name} (CUDA {})", self.number),
            kind: "DiscreteGpu".into(),
            driver: format!(
                "CUDA {}.{} {}",
                version / 1000,
                version % 1000 / 10,
                self.architecture().unwrap_or_default()
            ),
            double: true,
            most_bound: most.unwrap_or(0) as u64,
            arrays: 1,
        }
    }
}

#[derive(Clone, Debug)]
pub struct Cuda {
    context: Arc<CudaContext>,
    architecture: String,
}

/// A compiled kernel.
#[derive(Debug)]
pub struct Kernel {
    /// The number of its card.
    card: usize,
    function: CudaFunction,
    threads: u32,
}

/// Memory of a card, which is freed with the last that knows it.
#[derive(Debug)]
pub struct Memory {
    context: Arc<CudaContext>,
    at: sys::CUdeviceptr,
    size: usize,
}

impl Drop for Memory {
    fn drop(&mut self) {
        let bound = self.context.bind_to_thread();
        // SAFETY: it was allocated, and nothing knows it any longer; the driver waits for kernels.
        let freed = bound.and_then(|()| unsafe { result::free_sync(self.at) });
        self.context.record_err(freed);
    }
}

impl Memory {
    /// Where some bytes from a place on are.
    fn place(&self, at: usize, bytes: usize) -> sys::CUdeviceptr {
        assert!(at + bytes <= self.size, "within what was allocated");
        self.at + at as u64
    }
}

/// A kernel with what it works on.
#[derive(Debug)]
pub struct Bound {
    function: CudaFunction,
    scene: [u32; 8],
    buffers: Vec<Arc<Memory>>,
    groups: u32,
    threads: u32,
}

impl Cuda {
    pub fn open(card: Card) -> Result<Self, String> {
        Ok(Self {
            context: CudaContext::new(card.number as usize).map_err(said)?,
            architecture: card.architecture().map_err(said)?,
        })
    }

    pub fn kernel(&self, frame: &Frame<'_>, body: &str, threads: u32) -> Result<Kernel, String> {
        let source = frame.source(body, threads);
        let code = Ptx::from_binary(nvrtc::code(&source, &self.architecture)?);
        let module = self.context.load_module(code).map_err(said)?;
        let function = module.load_function("kernel").map_err(said)?;
        Ok(Kernel {
            card: self.context.ordinal(),
            function,
            threads,
        })
    }

    pub fn owns(&self, kernel: &Kernel) -> bool {
        self.context.ordinal() == kernel.card
    }

    /// Room for some bytes, all zero.
    pub fn room(&self, what: &'static str, size: u64) -> Result<Arc<Memory>, Error> {
        let size = size as usize;
        let made = || {
            self.context.bind_to_thread()?;
            let own = Memory {
                context: self.context.clone(),
                // SAFETY: the context is that of the thread.
                at: unsafe { result::malloc_sync(size) }?,
                size,
            };
            // SAFETY: it has room for so many bytes.
            unsafe { result::memset_d8_sync(own.at, 0, size) }?;
            Ok(Arc::new(own))
        };
        made().map_err(|error: DriverError| match error.0 {
            sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY => Error::OutOfMemory { what },
            _ => Error::Lost {
                message: said(error),
            },
        })
    }

    /// Writes bytes after all that was launched. What fails is told when something is read.
    pub fn write(&self, to: &Memory, at: usize, bytes: &[u8]) {
        let place = to.place(at, bytes.len());
        let bound = self.context.bind_to_thread();
        // SAFETY: the memory has room for them, and the driver has read them when it returns.
        let written = bound.and_then(|()| unsafe { result::memcpy_htod_sync(place, bytes) });
        self.context.record_err(written);
    }

    pub fn bind(&self, kernel: &Kernel, buffers: Vec<Arc<Memory>>, extent: Extent) -> Bound {
        let groups = (extent.count as u32).div_ceil(kernel.threads).max(1);
        Bound {
            function: kernel.function.clone(),
            scene: extent.words(groups * kernel.threads),
            buffers,
            groups,
            threads: kernel.threads,
        }
    }

    /// Launches kernels one after another. What fails is told when something is read.
    pub fn launch<'a>(&self, kernels: impl Iterator<Item = &'a Bound>) {
        for own in kernels {
            let bound = self.context.bind_to_thread();
            self.context.record_err(bound.and_then(|()| own.launch()));
        }
    }

    /// Bytes from a place on, after all that was launched.
    pub fn read(&self, from: &Memory, at: usize, count: usize) -> Result<Vec<u8>, String> {
        let (place, mut bytes) = (from.place(at, count), vec![0; count]);
        let bound = self.context.bind_to_thread();
        // SAFETY: there are so many bytes, and room for them.
        let read = bound.and_then(|()| unsafe { result::memcpy_dtoh_sync(&mut bytes, place) });
        read.map_err(said).map(|()| bytes)
    }
}

impl Bound {
    fn launch(&self) -> Result<(), DriverError> {
        let mut scene = self.scene;
        let mut places: Vec<_> = self.buffers.iter().map(|own| own.at).collect();
        // As `Frame::source` declares them: the scene by its value, then a pointer for each array.
        let mut all: Vec<*mut c_void> = vec![scene.as_mut_ptr().cast()];
        all.extend(
            places
                .iter_mut()
                .map(|own| (&raw mut *own).cast::<c_void>()),
        );
        let (groups, threads) = ((self.groups, 1, 1), (self.threads, 1, 1));
        let stream = result::stream::null();
        // SAFETY: the arguments are those of the kernel, whose memory is held and whose threads stay within `count`.
        unsafe {
            let function = self.function.cu_function();
            result::launch_kernel(function, groups, threads, 0, stream, &mut all)
        }
    }
}
