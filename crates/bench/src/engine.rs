//! The devices that a suite runs on.

use lightmesh::render::Choice;
use lightmesh::{Device, RenderError, Renderer};

use crate::{Key, Plan};

/// A device with its renderer, and its keys in rows. They are the same on every machine, so that rows can be matched: `all`
/// threads, not 16.
pub struct Engine {
    /// Renders on it.
    pub renderer: Renderer,
    /// `cpu` or `cuda`: the key `device`.
    pub kind: &'static str,
    /// Name and number of the device, as in `cuda:0`.
    pub device: String,
    /// 1, the requested number, or `all`: the key `threads`; `None` on a GPU.
    pub threads: Option<Key>,
    /// The number of threads; `None` on a GPU.
    pub thread_count: Option<usize>,
}

impl Engine {
    /// The CPU with `threads` threads; `None`: all hardware threads.
    pub fn cpu(threads: Option<usize>) -> Result<Engine, RenderError> {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        let choice = Choice::of(Device::Cpu)?;
        Ok(Engine {
            kind: "cpu",
            device: choice.device.to_string(),
            renderer: Renderer::on(choice, threads)?,
            threads: Some(threads.map_or_else(|| "all".into(), |threads| Key::Number(threads as f64))),
            thread_count: Some(threads.unwrap_or(all)),
        })
    }

    fn gpu(choice: Choice) -> Result<Engine, RenderError> {
        let device = choice.device.to_string();
        Ok(Engine { kind: "cuda", device, renderer: Renderer::on(choice, None)?, threads: None, thread_count: None })
    }

    /// The keys `device` and `threads`.
    pub fn keys(&self) -> Vec<(&'static str, Key)> {
        let threads = self.threads.clone().map(|threads| ("threads", threads));
        std::iter::once(("device", self.kind.into())).chain(threads).collect()
    }
}

/// The devices of a plan, fastest first: the GPU, if requested or, with [`Device::Auto`], if one works; then the CPU with all
/// threads, unless a GPU is requested.
///
/// # Errors
/// [`RenderError::Device`] if a GPU is requested and cannot be used, [`RenderError::Setting`] for an invalid number of threads.
pub fn engines(plan: &Plan) -> Result<Vec<Engine>, RenderError> {
    let choice = Choice::of(plan.device)?;
    let mut engines = Vec::new();
    if choice.device != Device::Cpu {
        engines.push(Engine::gpu(choice)?);
    }
    if matches!(plan.device, Device::Auto | Device::Cpu) {
        engines.push(Engine::cpu(plan.threads)?);
    }
    Ok(engines)
}
