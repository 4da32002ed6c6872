//! From CUDA C++ to PTX with NVRTC.

use std::error::Error;
use std::ffi::{CString, c_char};
use std::fs;
use std::path::Path;

use cudarc::nvrtc::result::{self, NvrtcError};
use cudarc::nvrtc::sys;

use super::tools::Tools;
use super::{Module, SOURCES, Source};

/// The oldest supported devices have compute capability 7.5. No operation is fused or approximated, so that decisions are the
/// same as on the host. Headers contain functions that not every kernel calls, which does not deserve a warning.
const OPTIONS: [&str; 8] = [
    "--gpu-architecture=compute_75",
    "--std=c++17",
    "--fmad=false",
    "--ftz=false",
    "--prec-div=true",
    "--prec-sqrt=true",
    "--diag-suppress=177",
    "--display-error-number",
];

/// How often a module is compiled before it counts as different from the committed one.
const ATTEMPTS: usize = 8;

/// Compiles every kernel file. A warning is an error. With `check`, a module that differs from the committed one is tried again: some passes
/// of the compiler depend on addresses in memory, so that two runs may place a constant differently.
pub(super) fn all(tools: &Tools, sources: &[Source], check: bool) -> Result<Vec<Module>, Box<dyn Error>> {
    let library = load(tools)?;
    let mut modules = Vec::new();
    let mut errors = String::new();
    for source in sources {
        let outcome = if check { committed(source) } else { compile(source) };
        match outcome {
            Ok(ptx) => modules.push(Module { name: source.module.clone(), ptx }),
            Err(error) => errors += &format!("{}: {error}\n", source.path.display()),
        }
    }
    drop(library);
    if errors.is_empty() { Ok(modules) } else { Err(errors.into()) }
}

/// Loads the pinned library. `cudarc` opens a library of the same name and gets the one already loaded, unless the system has
/// another with a name that it tries earlier: therefore the version is checked.
fn load(tools: &Tools) -> Result<libloading::Library, Box<dyn Error>> {
    // SAFETY: the initialisers of NVIDIA's library have no requirements.
    let library = unsafe { libloading::Library::new(&tools.nvrtc) }?;
    let mut found = (0, 0);
    // SAFETY: both variables outlive the call.
    unsafe { sys::nvrtcVersion(&mut found.0, &mut found.1) }.result()?;
    if found != tools.nvrtc_version {
        let ((major, minor), pinned) = (found, tools.nvrtc_version);
        return Err(format!(
            "the system's NVRTC {major}.{minor} takes precedence over the pinned {}.{}; remove it from LD_LIBRARY_PATH",
            pinned.0, pinned.1
        )
        .into());
    }
    Ok(library)
}

/// The PTX that is committed if the compiler gives it in some attempt; else that of the last one.
fn committed(source: &Source) -> Result<String, Box<dyn Error>> {
    let committed = fs::read_to_string(super::ptx_path(&source.module)).ok();
    let mut ptx = compile(source)?;
    for _ in 1..ATTEMPTS {
        if committed.is_none() || committed.as_ref() == Some(&ptx) {
            break;
        }
        ptx = compile(source)?;
    }
    Ok(ptx)
}

fn compile(source: &Source) -> Result<String, Box<dyn Error>> {
    let text = CString::new(fs::read(Path::new(SOURCES).join(&source.path))?)?;
    let name = CString::new(source.path.as_os_str().as_encoded_bytes())?;
    let program = result::create_program(&text, Some(&name))?;
    // SAFETY: just created, and destroyed below; text and name live until then.
    let outcome = unsafe { compile_program(program) };
    // SAFETY: nothing refers to it anymore.
    unsafe { result::destroy_program(program) }?;
    outcome
}

/// # Safety
/// `program` is valid.
unsafe fn compile_program(program: sys::nvrtcProgram) -> Result<String, Box<dyn Error>> {
    let include = format!("--include-path={SOURCES}");
    let options: Vec<&str> = OPTIONS.into_iter().chain([include.as_str()]).collect();
    // SAFETY: guaranteed by the caller, for all three calls.
    let (compiled, log) =
        unsafe { (result::compile_program(program, &options), text(result::get_program_log(program))?) };
    if let Err(error) = compiled {
        return Err(format!("{error}\n{log}").into());
    }
    if !log.trim().is_empty() {
        return Err(log.into());
    }
    // SAFETY: guaranteed by the caller.
    unsafe { text(result::get_ptx(program)) }.map(|ptx| without_call_numbers(&ptx))
}

/// The compiler numbers calls in comments, on through all programs of a process.
fn without_call_numbers(ptx: &str) -> String {
    let code = |line: &str| line.split_once("// callseq").map_or(line, |(code, _)| code.trim_end()).to_owned() + "\n";
    ptx.lines().map(code).collect()
}

/// Text from NVRTC, which is null-terminated.
fn text(characters: Result<Vec<c_char>, NvrtcError>) -> Result<String, Box<dyn Error>> {
    let bytes = characters?.into_iter().map(|character| character as u8).take_while(|&byte| byte != 0);
    Ok(String::from_utf8(bytes.collect())?)
}
