//! The device itself, by Vulkan: adapters, memory and kernels.
//! What a driver refuses is an error here, before anything runs.

use crate::kernel::{Array, Frame, THREADS};
use crate::{Dialect, Error, Part, Precision};
use pollster::block_on;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Backends, BufferUsages, Features};

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
}

/// What `f64` needs: numbers, and the integers that their bits are moved as.
const DOUBLE: Features = Features::SHADER_F64.union(Features::SHADER_INT64);

impl Adapter {
    fn of(adapter: &wgpu::Adapter) -> Self {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        Self {
            name: info.name,
            kind: format!("{:?}", info.device_type),
            driver: format!("{} {}", info.driver, info.driver_info),
            double: adapter.features().contains(DOUBLE),
            most_bound: limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size),
        }
    }
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
    inner: wgpu::Device,
    queue: wgpu::Queue,
    adapter: Adapter,
    threads: u32,
    most_groups: u32,
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

fn adapters() -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::VULKAN;
    block_on(wgpu::Instance::new(descriptor).enumerate_adapters(Backends::VULKAN))
}

impl Device {
    /// The adapters of this machine; empty without a driver.
    #[must_use]
    pub fn list() -> Vec<Adapter> {
        adapters().iter().map(Adapter::of).collect()
    }

    /// Opens the fastest kind of adapter that there is: a card, then what is built into the processor, then a driver in software.
    ///
    /// # Errors
    ///
    /// [`Error::NoAdapter`] without any, [`Error::Refused`] if it cannot be opened.
    pub fn open() -> Result<Self, Error> {
        use wgpu::DeviceType as D;
        let rank = |adapter: &wgpu::Adapter| match adapter.get_info().device_type {
            D::DiscreteGpu => 0,
            D::VirtualGpu => 1,
            D::IntegratedGpu => 2,
            D::Other => 3,
            D::Cpu => 4,
        };
        let best = adapters().into_iter().min_by_key(rank);
        Self::of(&best.ok_or(Error::NoAdapter)?)
    }

    /// Opens the adapter of a name, as [`Device::list`] gives it.
    ///
    /// # Errors
    ///
    /// [`Error::NoAdapter`] without any, [`Error::UnknownAdapter`] if none is called so, [`Error::Refused`] if it cannot be opened.
    pub fn named(name: &str) -> Result<Self, Error> {
        let all = adapters();
        if all.is_empty() {
            return Err(Error::NoAdapter);
        }
        let own = all.iter().find(|own| own.get_info().name == name);
        Self::of(own.ok_or_else(|| Error::UnknownAdapter {
            wanted: name.into(),
            found: all.iter().map(|own| own.get_info().name).collect(),
        })?)
    }

    fn of(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        let limits = adapter.limits();
        let most_groups = limits.max_compute_workgroups_per_dimension;
        let opened = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: adapter.features() & DOUBLE,
            required_limits: limits,
            ..Default::default()
        }));
        let adapter = Adapter::of(adapter);
        let (device, queue) = opened.map_err(|error| Error::Refused {
            adapter: adapter.name.clone(),
            message: error.to_string(),
        })?;
        Ok(Self {
            inner: device,
            queue,
            adapter,
            threads: THREADS,
            most_groups,
            traffic: Arc::default(),
        })
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
        let most = self.inner.limits().max_compute_invocations_per_workgroup;
        let fits = (1..=most).contains(&threads);
        let sizes = [threads as usize, most as usize];
        Error::unless(fits, "threads of a work group, at most", sizes)?;
        self.threads = threads;
        Ok(self)
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

    /// Refuses a precision that the adapter does not have.
    pub(crate) fn can(&self, precision: Precision) -> Result<(), Error> {
        if precision == Precision::Double && !self.adapter.double {
            return Err(Error::NoDouble {
                adapter: self.adapter.name.clone(),
            });
        }
        Ok(())
    }

    /// What `make` makes, unless the driver refuses it.
    fn checked<V>(
        &self,
        make: impl FnOnce() -> V,
        refused: impl FnOnce(String) -> Error,
    ) -> Result<V, Error> {
        let scope = self.inner.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = make();
        match block_on(scope.pop()) {
            None => Ok(made),
            Some(error) => Err(refused(error.to_string())),
        }
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
            name: "main",
            buffers,
        };
        let source = frame.source(body, self.threads);
        let make = || {
            let module = self
                .inner
                .create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: None,
                    source: wgpu::ShaderSource::Wgsl(source.as_str().into()),
                });
            let entries: Vec<_> = (0..=buffers.len())
                .map(|n| wgpu::BindGroupLayoutEntry {
                    binding: n as u32,
                    visibility: wgpu::ShaderStages::COMPUTE,
                    ty: wgpu::BindingType::Buffer {
                        ty: match n.checked_sub(1) {
                            None => wgpu::BufferBindingType::Uniform,
                            Some(n) => wgpu::BufferBindingType::Storage {
                                read_only: !buffers[n].writable,
                            },
                        },
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                })
                .collect();
            let layout = self
                .inner
                .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                    label: None,
                    entries: &entries,
                });
            let whole = self
                .inner
                .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: None,
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                });
            let pipeline = self
                .inner
                .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: None,
                    layout: Some(&whole),
                    module: &module,
                    entry_point: Some("main"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    cache: None,
                });
            Kernel {
                pipeline,
                layout,
                threads: self.threads,
            }
        };
        self.checked(make, |message| Error::Kernel {
            part: Part {
                kind,
                name: name.into(),
            },
            message,
        })
    }

    fn fits(&self, what: &'static str, bytes: u64) -> Result<(), Error> {
        let most = self.adapter.most_bound;
        if bytes > most {
            return Err(Error::TooLarge { what, bytes, most });
        }
        Ok(())
    }

    /// Room for some bytes, all zero.
    pub(crate) fn room(&self, what: &'static str, bytes: usize) -> Result<wgpu::Buffer, Error> {
        let size = (bytes as u64).max(16).next_multiple_of(16);
        self.fits(what, size)?;
        let scope = self.inner.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let buffer = self.inner.create_buffer(&wgpu::BufferDescriptor {
            label: Some(what),
            size,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        match block_on(scope.pop()) {
            None => Ok(buffer),
            Some(_) => Err(Error::OutOfMemory { what }),
        }
    }

    /// Room that holds some bytes.
    pub(crate) fn upload(&self, what: &'static str, bytes: &[u8]) -> Result<wgpu::Buffer, Error> {
        let buffer = self.room(what, bytes.len())?;
        self.write(&buffer, bytes);
        Ok(buffer)
    }

    /// Writes bytes to the start of what has room for them.
    pub(crate) fn write(&self, buffer: &wgpu::Buffer, bytes: &[u8]) {
        self.write_at(buffer, 0, bytes);
    }

    /// Writes bytes to a place of what has room for them.
    pub(crate) fn write_at(&self, buffer: &wgpu::Buffer, at: usize, bytes: &[u8]) {
        self.count(1, bytes.len() as u64);
        self.queue.write_buffer(buffer, at as u64, bytes);
    }

    /// Binds buffers to a kernel that runs for some particles.
    pub(crate) fn bind(&self, kernel: &Kernel, buffers: &[&wgpu::Buffer], count: usize) -> Bound {
        let extent = Extent {
            count,
            ..Extent::default()
        };
        self.bind_over(kernel, buffers, extent)
    }

    /// The same, for particles from one on.
    pub(crate) fn bind_over(
        &self,
        kernel: &Kernel,
        buffers: &[&wgpu::Buffer],
        extent: Extent,
    ) -> Bound {
        let groups = (extent.count as u32).div_ceil(kernel.threads).max(1);
        let across = groups.min(self.most_groups);
        let Extent {
            count,
            first,
            length,
            stride,
            target,
        } = extent;
        let row = (across * kernel.threads) as usize;
        let scene = [count, row, 0, first, length, stride, target, 0].map(|own| own as u32);
        let scene = self.inner.create_buffer_init(&BufferInitDescriptor {
            label: None,
            contents: &scene.map(u32::to_ne_bytes).concat(),
            usage: BufferUsages::UNIFORM,
        });
        let all = core::iter::once(&scene).chain(buffers.iter().copied());
        let entries: Vec<_> = all
            .enumerate()
            .map(|(n, buffer)| wgpu::BindGroupEntry {
                binding: n as u32,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let group = self.inner.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &kernel.layout,
            entries: &entries,
        });
        Bound {
            pipeline: kernel.pipeline.clone(),
            group,
            groups: [across, groups.div_ceil(across)],
        }
    }

    /// Runs kernels one after another: each sees what those before it have written.
    pub(crate) fn launch(&self, kernels: &[&Bound]) {
        self.count(0, kernels.len() as u64);
        let mut encoder = self
            .inner
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for own in kernels {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&own.pipeline);
            pass.set_bind_group(0, &own.group, &[]);
            pass.dispatch_workgroups(own.groups[0], own.groups[1], 1);
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Bytes of a buffer from a place on, after all that was launched.
    pub(crate) fn download(
        &self,
        buffer: &wgpu::Buffer,
        at: usize,
        bytes: usize,
    ) -> Result<Vec<u8>, Error> {
        let lost = |message: String| Error::Lost { message };
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let size = (bytes as u64).next_multiple_of(8);
        self.count(2, size);
        self.count(3, 1);
        let back = self.inner.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self
            .inner
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, at as u64, &back, 0, size);
        self.queue.submit([encoder.finish()]);
        back.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        let waited = self.inner.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| lost(error.to_string()))?;
        let mapped = back.slice(..).get_mapped_range();
        let mapped = mapped.map_err(|error| lost(format!("{error:?}")))?;
        Ok(mapped[..bytes].to_vec())
    }
}

/// A compiled kernel.
#[derive(Debug)]
pub(crate) struct Kernel {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    threads: u32,
}

/// A kernel with what it works on.
#[derive(Debug)]
pub(crate) struct Bound {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    groups: [u32; 2],
}
