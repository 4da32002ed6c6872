//! Tests of the emulator itself, with the kernels of `kernels/own.cu`: that it computes what a device would, and that it detects
//! the errors it promises to detect.
#![cfg(unix)]

mod collectives;
mod faults;
mod memory;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use lightmesh_emulator::Emulator;
use lightmesh_render::cuda::{Buffer, Fault, Kernel, Launch, Pool, Runtime};

/// `Own` of `kernels/own.cu`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Own {
    out: u64,
    total: u64,
    count: u32,
    choice: u32,
}

/// A device with an array of zeros that kernels write to, and a sum.
struct Bench {
    pool: Pool<Emulator>,
    out: Buffer<Emulator, u32>,
    total: Buffer<Emulator, u32>,
}

impl Bench {
    fn new(len: usize) -> Bench {
        let pool = Pool::new(Arc::new(Emulator::new()));
        let out = pool.zeros("out", len).unwrap();
        let total = pool.zeros("total", 1).unwrap();
        Bench { pool, out, total }
    }

    fn launch(&self, name: &'static str, blocks: u32, threads: u32, choice: u32) -> Result<(), Fault> {
        let launch = Launch { blocks, threads, shared: 4 * threads };
        let (out, total) = (self.out.output().address(), self.total.output().address());
        let arguments = Own { out, total, count: self.out.len() as u32, choice };
        self.pool.runtime().launch(Kernel { module: "own", name }, launch, bytemuck::bytes_of(&arguments))
    }

    /// Launches a kernel that must succeed, and reads its output.
    fn run(&self, name: &'static str, blocks: u32, threads: u32) -> Vec<u32> {
        self.launch(name, blocks, threads, 0).unwrap();
        self.out.read().unwrap()
    }

    /// Launches a kernel that must fail, and returns the message.
    fn fault(&self, name: &'static str, blocks: u32, threads: u32, choice: u32) -> String {
        match self.launch(name, blocks, threads, choice) {
            Err(Fault::Failed(message)) => message,
            other => panic!("{name} must fail, and gave {other:?}"),
        }
    }
}
