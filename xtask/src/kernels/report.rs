//! What `ptxas` says of each kernel: registers, spills, stack, shared and constant memory.

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use super::Module;
use super::tools::Tools;

/// The oldest devices that are served, and those that speed is measured on.
const ARCHITECTURES: [&str; 2] = ["sm_75", "sm_90"];

/// What a kernel needs on one architecture; bytes but for the registers.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Usage {
    kernel: String,
    registers: u32,
    /// Stored and loaded.
    spills: u32,
    /// With that of the functions that it calls.
    stack: u32,
    shared: u32,
    /// Of its code and its parameter. Reported for old architectures only.
    constant: u32,
}

/// The report as Markdown.
pub(super) fn of(tools: &Tools, modules: &[Module]) -> Result<String, Box<dyn Error>> {
    let mut text = format!(
        "<!-- Made by `cargo xtask kernels`; do not edit. -->\n\
         # What the kernels need of a device\n\n\
         As `ptxas -v` {} reports it for two architectures; the compiler in a driver may do a little otherwise. All but\n\
         registers are bytes. Spills are stores and loads together. Shared memory is what a block declares, without what its\n\
         launch adds. Constant memory is reported for {} alone: the parameter and what the compiler puts there, without the\n\
         variables of the module.\n\n\
         | module | kernel | shared | constant |",
        tools.ptxas_version, ARCHITECTURES[0]
    );
    for architecture in ARCHITECTURES {
        write!(text, " {architecture} registers | spills | stack |")?;
    }
    text += &format!("\n|---|---|--:|--:|{}\n", "--:|--:|--:|".repeat(ARCHITECTURES.len()));
    for module in modules {
        let usages = ARCHITECTURES.map(|architecture| usages_on(tools, module, architecture));
        let [old, new] = usages;
        for (old, new) in old?.iter().zip(&new?) {
            let Usage { kernel, shared, constant, .. } = old;
            write!(text, "| {} | `{kernel}` | {shared} | {constant} |", module.name)?;
            for Usage { registers, spills, stack, .. } in [old, new] {
                write!(text, " {registers} | {spills} | {stack} |")?;
            }
            text.push('\n');
        }
    }
    Ok(text)
}

/// What the kernels of a module need, in order of their names.
fn usages_on(tools: &Tools, module: &Module, architecture: &str) -> Result<Vec<Usage>, Box<dyn Error>> {
    let said = assemble(tools, module, architecture)?;
    let mut usages = usages(&said);
    usages.sort();
    let kernels = module.ptx.matches(".visible .entry ").count();
    if usages.len() != kernels || usages.iter().any(|usage| usage.registers == 0) {
        return Err(format!("{}: ptxas answered something unknown: {said}", module.name).into());
    }
    Ok(usages)
}

/// What `ptxas -v` says.
fn assemble(tools: &Tools, module: &Module, architecture: &str) -> Result<String, Box<dyn Error>> {
    let mut ptxas = Command::new(&tools.ptxas)
        .args(["--verbose", "--output-file", "/dev/null", "--gpu-name", architecture, "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    // Dropped at the end of the statement: ptxas sees the end of the file.
    ptxas.stdin.take().map(|mut input| input.write_all(module.ptx.as_bytes())).transpose()?;
    let output = ptxas.wait_with_output()?;
    let said = String::from_utf8(output.stderr)? + &String::from_utf8(output.stdout)?;
    if !output.status.success() {
        return Err(format!("ptxas refuses {} for {architecture}: {said}", module.name).into());
    }
    Ok(said)
}

/// Reads ptxas' lines: what follows "Compiling entry function" is about that kernel, properties of other functions apart.
fn usages(said: &str) -> Vec<Usage> {
    let mut usages: Vec<Usage> = Vec::new();
    let mut about_kernel = false;
    for line in said.lines() {
        if let Some(rest) = line.split("Compiling entry function '").nth(1) {
            let kernel = rest.split('\'').next().unwrap_or_default().to_owned();
            usages.push(Usage { kernel, ..Usage::default() });
        }
        let Some(usage) = usages.last_mut() else { continue };
        if let Some(function) = line.split("Function properties for ").nth(1) {
            about_kernel = function.trim() == usage.kernel;
        } else if line.contains("bytes stack frame") && about_kernel {
            usage.stack = before(line, "bytes stack frame");
            usage.spills = before(line, "bytes spill stores") + before(line, "bytes spill loads");
        } else if line.contains("Used ") && line.contains("registers") {
            usage.registers = before(line, "registers");
            usage.stack = usage.stack.max(before(line, "bytes cumulative stack size"));
            usage.shared = before(line, "bytes smem");
            usage.constant = before(line, "bytes cmem");
        }
    }
    usages
}

/// The sum of the numbers that stand before each `what`.
fn before(line: &str, what: &str) -> u32 {
    let parts: Vec<&str> = line.split(what).collect();
    let numbers =
        parts[..parts.len() - 1].iter().filter_map(|part| part.split_whitespace().next_back()?.parse::<u32>().ok());
    numbers.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_ptxas_says_is_read() {
        let said = "\
ptxas info    : 0 bytes gmem, 20480 bytes cmem[3]
ptxas info    : Compiling entry function 'one' for 'sm_75'
ptxas info    : Function properties for _Z4coldv
    8 bytes stack frame, 4 bytes spill stores, 4 bytes spill loads
ptxas info    : Function properties for one
    72 bytes stack frame, 12 bytes spill stores, 24 bytes spill loads
ptxas info    : Used 64 registers, used 1 barriers, 80 bytes cumulative stack size, 4096 bytes smem, 872 bytes cmem[0], 16 bytes cmem[2]
ptxas info    : Compile time = 3.141 ms
ptxas info    : Compiling entry function 'two' for 'sm_75'
ptxas info    : Function properties for two
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 8 registers, 360 bytes cmem[0]
";
        let one = Usage { kernel: "one".to_owned(), registers: 64, spills: 36, stack: 80, shared: 4096, constant: 888 };
        let two = Usage { kernel: "two".to_owned(), registers: 8, constant: 360, ..Usage::default() };
        assert_eq!(usages(said), [one, two]);
        assert_eq!(usages(""), []);
    }
}
