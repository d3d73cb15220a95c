//! A device by Vulkan, through `wgpu`.
//! Kernels are in WGSL.

use super::{Adapter, Extent};
use crate::kernel::{Array, Frame};
use crate::{Dialect, Error};
use pollster::block_on;
use std::num::NonZeroU64;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Backends, BindingResource, BufferUsages, Features};

/// What `f64` needs: numbers, and the integers that their bits are moved as.
const DOUBLE: Features = Features::SHADER_F64.union(Features::SHADER_INT64);

pub fn adapters() -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::VULKAN;
    block_on(wgpu::Instance::new(descriptor).enumerate_adapters(Backends::VULKAN))
}

pub fn describe(adapter: &wgpu::Adapter) -> Adapter {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    Adapter {
        name: info.name,
        kind: format!("{:?}", info.device_type),
        driver: format!("{} {}", info.driver, info.driver_info),
        double: adapter.features().contains(DOUBLE),
        most_bound: limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size),
        arrays: limits.max_storage_buffers_per_shader_stage,
    }
}

/// The place of an adapter among all: the fastest kind is the first.
pub fn rank(adapter: &wgpu::Adapter) -> u8 {
    use wgpu::DeviceType as D;
    match adapter.get_info().device_type {
        D::DiscreteGpu => 0,
        D::VirtualGpu => 1,
        D::IntegratedGpu => 2,
        D::Other => 3,
        D::Cpu => 4,
    }
}

#[derive(Clone, Debug)]
pub struct Vulkan {
    inner: wgpu::Device,
    queue: wgpu::Queue,
    most_groups: u32,
    /// Its own where it is opened: devices of two instances count alike.
    opened: Arc<()>,
    /// Why a kernel of arrays in parts could not be compiled.
    failed: Arc<Mutex<Option<String>>>,
}

/// A kernel, by its text, and what was compiled of it: for arrays of so many parts of some bytes each.
#[derive(Debug)]
pub struct Kernel {
    opened: Arc<()>,
    dialect: Dialect,
    buffers: Vec<Array>,
    body: String,
    threads: u32,
    made: Mutex<Vec<(Vec<u64>, Made)>>,
}

type Made = (wgpu::ComputePipeline, wgpu::BindGroupLayout);

/// A kernel with what it works on and how many groups; none that could not be compiled.
#[derive(Debug)]
pub struct Bound(Option<(wgpu::ComputePipeline, wgpu::BindGroup, [u32; 2])>);

impl Vulkan {
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, String> {
        let limits = adapter.limits();
        let most_groups = limits.max_compute_workgroups_per_dimension;
        let opened = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: adapter.features() & DOUBLE,
            required_limits: limits,
            ..Default::default()
        }));
        let (inner, queue) = opened.map_err(|error| error.to_string())?;
        Ok(Self {
            inner,
            queue,
            most_groups,
            opened: Arc::default(),
            failed: Arc::default(),
        })
    }

    pub fn owns(&self, kernel: &Kernel) -> bool {
        Arc::ptr_eq(&self.opened, &kernel.opened)
    }

    pub fn most_threads(&self) -> u32 {
        self.inner.limits().max_compute_invocations_per_workgroup
    }

    /// Compiles a kernel, unless the driver refuses it.
    pub fn kernel(&self, frame: &Frame<'_>, body: &str, threads: u32) -> Result<Kernel, String> {
        let own = Kernel {
            opened: self.opened.clone(),
            dialect: frame.dialect,
            buffers: frame.buffers.to_vec(),
            body: body.into(),
            threads,
            made: Mutex::default(),
        };
        self.made(&own, &vec![1; frame.buffers.len()], 0)?;
        Ok(own)
    }

    /// What a kernel is compiled to for arrays of so many parts of some bytes each.
    fn made(&self, kernel: &Kernel, parts: &[u64], bytes: u64) -> Result<Made, String> {
        let mut all = kernel.made.lock().unwrap_or_else(PoisonError::into_inner);
        // Devices that bind less than each other share kernels, also those for whole arrays.
        let is_whole = parts.iter().all(|own| *own == 1);
        let key = [parts, &[if is_whole { 0 } else { bytes }]].concat();
        if let Some((_, made)) = all.iter().find(|own| own.0 == key) {
            return Ok(made.clone());
        }
        let frame = Frame {
            dialect: kernel.dialect,
            name: "kernel",
            buffers: &kernel.buffers,
        };
        let source = frame.source_in_parts(&kernel.body, kernel.threads, (parts, bytes));
        let each = kernel.buffers.iter().zip(parts);
        let writable = each.flat_map(|(own, parts)| (0..*parts).map(|_| own.writable));
        let made = self.compile(&source, &writable.collect::<Vec<_>>())?;
        all.push((key, made.clone()));
        Ok(made)
    }

    /// Compiles a text, whose arrays are written or only read.
    fn compile(&self, source: &str, writable: &[bool]) -> Result<Made, String> {
        let scope = self.inner.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = self
            .inner
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
        let entries: Vec<_> = (0..=writable.len())
            .map(|n| wgpu::BindGroupLayoutEntry {
                binding: n as u32,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: match n.checked_sub(1) {
                        None => wgpu::BufferBindingType::Uniform,
                        Some(n) => wgpu::BufferBindingType::Storage {
                            read_only: !writable[n],
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
        match block_on(scope.pop()) {
            None => Ok((pipeline, layout)),
            Some(error) => Err(error.to_string()),
        }
    }

    /// Room for some bytes, all zero.
    pub fn room(&self, what: &'static str, size: u64) -> Result<wgpu::Buffer, Error> {
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

    pub fn write(&self, buffer: &wgpu::Buffer, at: usize, bytes: &[u8]) {
        self.queue.write_buffer(buffer, at as u64, bytes);
    }

    /// Binds arrays to a kernel, of which those that are larger than `most` bytes in parts of some bytes.
    pub fn bind(
        &self,
        kernel: &Kernel,
        buffers: &[&wgpu::Buffer],
        extent: Extent,
        [most, bytes]: [u64; 2],
    ) -> Bound {
        let groups = (extent.count as u32).div_ceil(kernel.threads).max(1);
        let across = groups.min(self.most_groups);
        let scene = extent.words(across * kernel.threads);
        let scene = self.inner.create_buffer_init(&BufferInitDescriptor {
            label: None,
            contents: &scene.map(u32::to_ne_bytes).concat(),
            usage: BufferUsages::UNIFORM,
        });
        let parts = |own: &&wgpu::Buffer| match own.size() {
            size if size > most => size.div_ceil(bytes),
            _ => 1,
        };
        let parts: Vec<_> = buffers.iter().map(parts).collect();
        let (pipeline, layout) = match self.made(kernel, &parts, bytes) {
            Ok(made) => made,
            Err(message) => {
                // What is read next says so.
                self.failed().get_or_insert(message);
                return Bound(None);
            }
        };
        let mut all = vec![scene.as_entire_binding()];
        for (buffer, parts) in buffers.iter().zip(parts) {
            all.extend((0..parts).map(|k| {
                BindingResource::Buffer(wgpu::BufferBinding {
                    buffer,
                    offset: k * bytes,
                    // The last has what is left.
                    size: NonZeroU64::new(bytes).filter(|_| k + 1 < parts),
                })
            }));
        }
        let entries = all.into_iter().enumerate();
        let entries: Vec<_> = entries
            .map(|(n, resource)| wgpu::BindGroupEntry {
                binding: n as u32,
                resource,
            })
            .collect();
        let group = self.inner.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        });
        let groups = [across, groups.div_ceil(across)];
        Bound(Some((pipeline, group, groups)))
    }

    fn failed(&self) -> MutexGuard<'_, Option<String>> {
        self.failed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn launch<'a>(&self, kernels: impl Iterator<Item = &'a Bound>) {
        let mut encoder = self
            .inner
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (pipeline, group, [across, down]) in kernels.filter_map(|own| own.0.as_ref()) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(*across, *down, 1);
        }
        self.queue.submit([encoder.finish()]);
    }

    pub fn read(&self, buffer: &wgpu::Buffer, at: usize, size: u64) -> Result<Vec<u8>, String> {
        if let Some(message) = &*self.failed() {
            return Err(message.clone());
        }
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
        waited.map_err(|error| error.to_string())?;
        let mapped = back.slice(..).get_mapped_range();
        Ok(mapped.map_err(|error| format!("{error:?}"))?.to_vec())
    }
}
