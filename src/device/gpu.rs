//! Adapters, buffers and passes: what this program asks of `wgpu`.

use std::{
    ops::Range,
    sync::{
        Arc, Mutex, OnceLock,
        atomic::{AtomicU64, Ordering},
    },
};

use bytemuck::Pod;
use wgpu::util::DeviceExt as _;

use super::shaders::{GROUP, ROW};
use crate::error::{Error, ErrorCode, ErrorKind, Result};

/// A graphics card or a software driver.
#[derive(Clone, Debug, PartialEq)]
pub struct Adapter {
    /// Its number, from 0.
    pub number: usize,
    /// Name.
    pub name: String,
    /// Interface: Vulkan, Metal or Dx12.
    pub backend: String,
    /// Kind: a discrete, integrated, virtual or other card, or the processor.
    pub kind: String,
    /// Driver and its version.
    pub driver: String,
    /// Memory of the card, B; `None` where the interface does not tell it.
    pub memory_bytes: Option<u64>,
    /// Largest part of a buffer that a shader reads, B.
    pub binding_bytes: u64,
    /// Largest buffer, B.
    pub buffer_bytes: u64,
    /// Whether the processor does the work.
    pub is_software: bool,
}

/// Arrays of the shader with most of them, the search.
const STORAGE_BUFFERS: u32 = 16;

/// A remedy where no card can be used.
const DRIVERS: &str = "install the driver of the card: on Linux its Vulkan driver and the loader (libvulkan1); `pontoon bench \
    --devices` lists what is found. Without --device the processor computes";

/// The instance of this program: a driver gives only so many (NVIDIA's some thirty).
fn instance() -> &'static wgpu::Instance {
    static INSTANCE: OnceLock<wgpu::Instance> = OnceLock::new();
    INSTANCE.get_or_init(|| {
        let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        wgpu::Instance::new(wgpu::InstanceDescriptor { backends, ..descriptor })
    })
}

fn all_adapters(instance: &wgpu::Instance) -> Vec<(wgpu::Adapter, Adapter)> {
    let found = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let describe = |(number, adapter): (usize, wgpu::Adapter)| {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        let summary = Adapter {
            number,
            name: info.name,
            backend: format!("{:?}", info.backend),
            kind: format!("{:?}", info.device_type),
            driver: format!("{} {}", info.driver, info.driver_info).trim().into(),
            memory_bytes: memory(&adapter),
            binding_bytes: limits.max_storage_buffer_binding_size,
            buffer_bytes: limits.max_buffer_size,
            is_software: info.device_type == wgpu::DeviceType::Cpu,
        };
        (adapter, summary)
    };
    found.into_iter().enumerate().map(describe).collect()
}

/// The largest heap (B) of the card's own memory, which Vulkan tells.
#[cfg(any(target_os = "linux", target_os = "windows"))]
#[allow(unsafe_code)]
fn memory(adapter: &wgpu::Adapter) -> Option<u64> {
    /// `VK_MEMORY_HEAP_DEVICE_LOCAL_BIT`.
    const OWN: u32 = 1;
    // SAFETY: the handle is only read, and belongs to the adapter, which lives longer.
    let vulkan = unsafe { adapter.as_hal::<wgpu::hal::api::Vulkan>() }?;
    let (instance, device) = (vulkan.shared_instance().raw_instance(), vulkan.raw_physical_device());
    // SAFETY: the device is one of this instance.
    let memory = unsafe { instance.get_physical_device_memory_properties(device) };
    let heaps = memory.memory_heaps.iter().take(memory.memory_heap_count as usize);
    heaps.filter(|heap| heap.flags.as_raw() & OWN != 0).map(|heap| heap.size).max()
}

#[cfg(not(any(target_os = "linux", target_os = "windows")))]
fn memory(_: &wgpu::Adapter) -> Option<u64> {
    None
}

/// The adapters of this machine.
pub fn adapters() -> Vec<Adapter> {
    all_adapters(instance()).into_iter().map(|(_, summary)| summary).collect()
}

/// An opened adapter.
pub(super) struct Gpu {
    pub(super) adapter: Adapter,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// The first error that the driver reported.
    failure: Arc<Mutex<Option<String>>>,
    /// How often the host has waited for the device.
    waits: AtomicU64,
}

/// A pipeline with its buffers, and its number of workgroups.
pub(super) struct Pass {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    groups: usize,
}

/// A shader, compiled: the layout of its bindings, and the pipelines of its functions.
pub(super) struct Shader {
    group: wgpu::BindGroupLayout,
    bindings: Vec<u32>,
    pipelines: Vec<(&'static str, wgpu::ComputePipeline)>,
}

/// The bindings that a shader declares, one a line: number, and whether it is a uniform, read, or read and written.
fn declared_bindings(text: &str) -> Vec<(u32, wgpu::BufferBindingType)> {
    let declared = text.lines().filter_map(|line| line.strip_prefix("@group(0) @binding("));
    declared
        .filter_map(|line| {
            let (number, rest) = line.split_once(')')?;
            let kind = if rest.contains("var<uniform>") {
                wgpu::BufferBindingType::Uniform
            } else {
                wgpu::BufferBindingType::Storage { read_only: rest.contains("var<storage, read>") }
            };
            Some((number.parse().ok()?, kind))
        })
        .collect()
}

impl Gpu {
    /// Opens the adapter that `name` selects: a number, `gpu` for the first graphics card, or part of a name. A software driver
    /// is opened only by its number or name.
    pub(super) fn open(name: &str) -> Result<Self> {
        let unavailable = |what: String, help: String| {
            Err(Error::new(ErrorKind::Usage, what).with_code(ErrorCode::NoDevice).help(help))
        };
        let found = all_adapters(instance());
        let list = || {
            let lines = found.iter().map(|(_, adapter)| format!("{}: {}", adapter.number, adapter.name));
            lines.collect::<Vec<_>>().join(", ")
        };
        let lower = name.to_lowercase();
        let chosen = found.iter().find(|(_, adapter)| match (name.parse::<usize>(), name) {
            (Ok(number), _) => adapter.number == number,
            (_, "gpu") => !adapter.is_software,
            _ => adapter.name.to_lowercase().contains(&lower),
        });
        let Some((raw, adapter)) = chosen else {
            if found.is_empty() {
                return unavailable("no graphics card was found".into(), DRIVERS.into());
            }
            let help = format!("there are {}. {DRIVERS}", list());
            return unavailable(format!("there is no device {name:?}"), help);
        };
        let limits = raw.limits();
        let storage = limits.max_storage_buffers_per_shader_stage;
        if storage < STORAGE_BUFFERS {
            let what = format!("{} lets a shader read {storage} arrays; {STORAGE_BUFFERS} are needed", adapter.name);
            return unavailable(what, DRIVERS.into());
        }
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let (device, queue) = match pollster::block_on(raw.request_device(&descriptor)) {
            Ok(opened) => opened,
            Err(why) => return unavailable(format!("{} cannot be opened: {why}", adapter.name), DRIVERS.into()),
        };
        let failure = Arc::new(Mutex::new(None));
        let note = |failure: &Arc<Mutex<Option<String>>>, what: String| {
            if let Ok(mut first) = failure.lock() {
                first.get_or_insert(what);
            }
        };
        let (of_error, of_loss) = (failure.clone(), failure.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| note(&of_error, error.to_string())));
        device.set_device_lost_callback(move |reason, text| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                note(&of_loss, format!("the device was lost: {text}"));
            }
        });
        Ok(Self { adapter: adapter.clone(), device, queue, failure, waits: AtomicU64::new(0) })
    }

    /// How often the host has waited for the device.
    pub(super) fn waits(&self) -> u64 {
        self.waits.load(Ordering::Relaxed)
    }

    /// The error that the driver reported, if any.
    pub(super) fn check(&self) -> Result<()> {
        let what = self.failure.lock().ok().and_then(|first| first.clone());
        match what {
            None => Ok(()),
            Some(what) => Err(self.failed(&what)),
        }
    }

    fn failed(&self, what: &str) -> Error {
        Error::new(ErrorKind::Usage, format!("{} failed: {what}", self.adapter.name))
            .with_code(ErrorCode::DeviceFailed)
            .help(
                "where memory ran out, use fewer particles or another device; without --device the processor computes",
            )
    }

    /// A buffer of `bytes`, zeros.
    pub(super) fn buffer(&self, bytes: usize) -> Result<wgpu::Buffer> {
        let size = bytes.next_multiple_of(16).max(16) as u64;
        let most = self.adapter.binding_bytes.min(self.adapter.buffer_bytes);
        if size > most {
            let what = format!("an array takes {:.1} GB, and {} allows {:.1}", gb(size), self.adapter.name, gb(most));
            return Err(Error::new(ErrorKind::Usage, what)
                .with_code(ErrorCode::DeviceFailed)
                .help("use fewer particles, or leave --device out"));
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        self.check()?;
        Ok(buffer)
    }

    /// A uniform with `data`.
    pub(super) fn uniform<T: Pod>(&self, data: &[T]) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::UNIFORM;
        let contents = bytemuck::cast_slice(data);
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    }

    /// Writes `data` to `buffer` from its byte `at` on, before the next passes run.
    pub(super) fn write<T: Pod>(&self, buffer: &wgpu::Buffer, at: usize, data: &[T]) {
        if !data.is_empty() {
            self.queue.write_buffer(buffer, at as u64, bytemuck::cast_slice(data));
        }
    }

    /// Compiles the functions `entries` of a shader.
    pub(super) fn shader(&self, text: &str, entries: &[&'static str]) -> Result<Shader> {
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let declared = declared_bindings(text);
        let binding = |&(binding, ty): &(u32, wgpu::BufferBindingType)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let bindings: Vec<_> = declared.iter().map(binding).collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: None, entries: &bindings };
        let group = self.device.create_bind_group_layout(&descriptor);
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&group)],
            immediate_size: 0,
        });
        let pipeline = |&entry: &&'static str| {
            let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
            (entry, pipeline)
        };
        let pipelines = entries.iter().map(pipeline).collect();
        self.check()?;
        Ok(Shader { group, bindings: declared.into_iter().map(|(binding, _)| binding).collect(), pipelines })
    }

    /// A pass that runs the function `entry` of a shader on `threads` threads; `buffers` are all buffers of the shader, in the
    /// order of their bindings.
    pub(super) fn pass(&self, shader: &Shader, entry: &str, threads: usize, buffers: &[&wgpu::Buffer]) -> Result<Pass> {
        let compiled = shader.pipelines.iter().find(|(name, _)| *name == entry);
        let Some((_, pipeline)) = compiled else { return Err(self.failed(&format!("no shader has {entry}"))) };
        let bound =
            |&binding: &u32| wgpu::BindGroupEntry { binding, resource: buffers[binding as usize].as_entire_binding() };
        let entries: Vec<_> = shader.bindings.iter().map(bound).collect();
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &shader.group, entries: &entries };
        let group = self.device.create_bind_group(&descriptor);
        self.check()?;
        Ok(Pass { pipeline: pipeline.clone(), group, groups: threads.div_ceil(GROUP).max(1) })
    }

    /// Runs `passes` in their order after the `copies` of whole buffers.
    pub(super) fn run<'a>(
        &self,
        copies: &[(&wgpu::Buffer, &wgpu::Buffer)],
        passes: impl IntoIterator<Item = &'a Pass>,
    ) {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for (from, to) in copies {
            encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
        }
        {
            let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            for pass in passes {
                compute.set_pipeline(&pass.pipeline);
                compute.set_bind_group(0, &pass.group, &[]);
                compute.dispatch_workgroups(pass.groups.min(ROW) as u32, pass.groups.div_ceil(ROW) as u32, 1);
            }
        }
        self.queue.submit([encoder.finish()]);
    }

    /// The first `counts` numbers of each of the `buffers`, after all passes have run.
    pub(super) fn read<T: Pod, const N: usize>(&self, buffers: [(&wgpu::Buffer, usize); N]) -> Result<[Vec<T>; N]> {
        self.read_ranges(buffers.map(|(buffer, count)| (buffer, 0..count)))
    }

    /// The numbers in these ranges of the buffers, after all passes have run.
    pub(super) fn read_ranges<T: Pod, const N: usize>(
        &self,
        buffers: [(&wgpu::Buffer, Range<usize>); N],
    ) -> Result<[Vec<T>; N]> {
        let counts = buffers.each_ref().map(|(_, range)| range.len());
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let copied = buffers.map(|(buffer, range)| {
            if range.is_empty() {
                return None;
            }
            let [start, size] = [range.start, range.len()].map(|count| (count * size_of::<T>()) as u64);
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            });
            encoder.copy_buffer_to_buffer(buffer, start, &copy, 0, size);
            Some(copy)
        });
        self.queue.submit([encoder.finish()]);
        let failure = self.failure.clone();
        for copy in copied.iter().flatten() {
            let failure = failure.clone();
            copy.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                if let (Err(why), Ok(mut first)) = (result, failure.lock()) {
                    first.get_or_insert(why.to_string());
                }
            });
        }
        self.waits.fetch_add(1, Ordering::Relaxed);
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|why| self.failed(&why.to_string()))?;
        self.check()?;
        let mut out: [Vec<T>; N] = std::array::from_fn(|_| Vec::new());
        for ((out, copy), count) in out.iter_mut().zip(&copied).zip(counts) {
            let Some(copy) = copy else { continue };
            let range = copy.slice(..).get_mapped_range().map_err(|why| self.failed(&why.to_string()))?;
            *out = bytemuck::pod_collect_to_vec(&range[..count * size_of::<T>()]);
        }
        Ok(out)
    }
}

fn gb(bytes: u64) -> f64 {
    bytes as f64 / 1e9
}
