//! Checks a CUDA device below the renderer: memory is read back as it was written, kernels run, clocks agree; and measures the speed
//! of all that.
//!
//! `cargo run --release -p lightmesh-render-examples --bin driver_check [cuda:N]`
#![allow(clippy::print_stdout, reason = "an example says what it found")]

use std::error::Error;
use std::time::Instant;

use lightmesh_layout::Out;
use lightmesh_layout::stages::Scan;
use lightmesh_render::Device;
use lightmesh_render::cuda::{Driver, Fault, Kernel, Launch, Runtime, open_cuda};

/// Size of the large copies: not a multiple of anything, and longer than any intermediate buffer.
const LARGE: usize = (96 << 20) + 12_345;
/// Values of the prefix sum: one block.
const VALUES: usize = 1000;
/// Number of repetitions of fast operations.
const TIMES: u32 = 1000;

fn main() -> Result<(), Box<dyn Error>> {
    let device: Device = std::env::args().nth(1).unwrap_or_else(|| "cuda".to_owned()).parse()?;
    let Device::Cuda(number) = device else { return Err("choose cuda or cuda:N".into()) };
    let start = Instant::now();
    let driver = open_cuda(number).map_err(|error| error.to_string())?;
    let opened = milliseconds(start);
    let free = driver.free_memory().unwrap_or(0) >> 20;
    println!("cuda:{}  {}, {free} MiB free, ready after {opened:.0} ms", driver.number(), driver.name());
    memory(&driver).map_err(reason)?;
    copies(&driver).map_err(reason)?;
    kernels(&driver).map_err(reason)?;
    println!("all is well");
    Ok(())
}

/// Allocation, and the message if memory does not suffice.
fn memory(driver: &Driver) -> Result<(), Fault> {
    for round in ["the first time", "again"] {
        let start = Instant::now();
        drop(driver.allocate(LARGE as u64)?);
        println!("allocating {} MiB {round}: {:.3} ms", LARGE >> 20, milliseconds(start));
    }
    match driver.allocate(1 << 50) {
        Err(Fault::OutOfMemory { free: Some(_) }) => Ok(()),
        Err(other) => Err(other),
        Ok(_) => Err(failed("a pebibyte was given out".to_owned())),
    }
}

/// Copies in both directions, with their times after warm-up.
fn copies(driver: &Driver) -> Result<(), Fault> {
    let sent: Vec<u8> = (0..LARGE).map(|index| (index * 7 + index / 251) as u8).collect();
    let mut back = vec![0_u8; LARGE];
    let memory = driver.allocate(LARGE as u64)?;
    for round in ["cold", "warm"] {
        // The source may be changed immediately.
        let mut changing = sent.clone();
        let start = Instant::now();
        driver.write(&memory, 0, &changing)?;
        changing.fill(0);
        let from = driver.mark()?;
        driver.seconds(&from, &driver.mark()?)?;
        let up = rate(start);
        let start = Instant::now();
        driver.read(&memory, 0, &mut back)?;
        println!("copying {} MiB, {round}: {up:.1} GB/s there, {:.1} GB/s back", LARGE >> 20, rate(start));
        check(back == sent, "memory came back changed")?;
    }
    driver.clear(&memory, 1, LARGE as u64 - 2)?;
    driver.read(&memory, 0, &mut back)?;
    let cleared = back[1..LARGE - 1].iter().all(|&byte| byte == 0);
    check(cleared && back[0] == sent[0] && back[LARGE - 1] == sent[LARGE - 1], "clearing took too little or too much")?;
    check(driver.read(&memory, 1, &mut back).is_err(), "reading past the end was allowed")
}

/// A prefix sum with a known answer, and the cost of a launch.
fn kernels(driver: &Driver) -> Result<(), Fault> {
    let values = driver.allocate(4 * VALUES as u64)?;
    let sums = driver.allocate(4)?;
    let [values_at, sums_at] = [&values, &sums].map(|memory| driver.address(memory));
    let arguments = Scan { values: Out::to(values_at), sums: Out::to(sums_at), count: VALUES as u64 };
    let launch = Launch { blocks: 1, threads: 256, shared: 0 };
    let scan = || driver.launch(Kernel { module: "scan", name: "scan_blocks" }, launch, bytemuck::bytes_of(&arguments));

    let ones = [1_u32; VALUES];
    driver.write(&values, 0, bytemuck::cast_slice(&ones))?;
    scan()?;
    let mut found = [0_u32; VALUES];
    driver.read(&values, 0, bytemuck::cast_slice_mut(&mut found))?;
    check((0..VALUES as u32).eq(found), "a prefix sum is wrong")?;

    let (start, from) = (Instant::now(), driver.mark()?);
    for _ in 0..TIMES {
        scan()?;
    }
    let queued = milliseconds(start);
    let ran = driver.seconds(&from, &driver.mark()?)? * 1e3;
    let all = milliseconds(start);
    check(ran > 0.0 && ran <= all * 1.01, "the device's clock runs away from the host's")?;
    println!(
        "launching {TIMES} small kernels: queued after {queued:.2} ms, done after {all:.2} ms, {ran:.2} ms of the device"
    );
    Ok(())
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

/// Gigabytes per second.
fn rate(since: Instant) -> f64 {
    LARGE as f64 / since.elapsed().as_secs_f64() / 1e9
}

fn check(holds: bool, otherwise: &str) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err(failed(otherwise.to_owned())) }
}

fn failed(reason: String) -> Fault {
    Fault::Failed(reason)
}

fn reason(fault: Fault) -> String {
    match fault {
        Fault::OutOfMemory { .. } => "out of memory".to_owned(),
        Fault::Failed(reason) => reason,
    }
}
