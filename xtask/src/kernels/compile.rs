//! From CUDA C++ to PTX with NVRTC.

use std::error::Error;
use std::ffi::{CString, c_char};
use std::fs;
use std::path::Path;

use cudarc::nvrtc::result::{self, NvrtcError};
use cudarc::nvrtc::sys;

use super::tools::Tools;
use super::{Module, SOURCES, Source};

/// The oldest devices that are served have compute capability 7.5. No operation is fused or made approximate: decisions are to fall
/// as on the host. Headers hold functions that not every kernel calls, which is no matter for a warning.
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

/// Compiles every kernel file. A warning is an error.
pub(super) fn all(tools: &Tools, sources: &[Source]) -> Result<Vec<Module>, Box<dyn Error>> {
    let library = load(tools)?;
    let mut modules = Vec::new();
    let mut errors = String::new();
    for source in sources {
        match compile(source) {
            Ok(ptx) => modules.push(Module { name: source.module.clone(), ptx }),
            Err(error) => errors += &format!("{}: {error}\n", source.path.display()),
        }
    }
    drop(library);
    if errors.is_empty() { Ok(modules) } else { Err(errors.into()) }
}

/// Loads the pinned library. `cudarc` asks the system for one of the same name and gets what is loaded already, unless the system
/// has another under a name that it asks for earlier: therefore the version is checked.
fn load(tools: &Tools) -> Result<libloading::Library, Box<dyn Error>> {
    // SAFETY: NVIDIA's library has no initialisers that ask anything of the program.
    let library = unsafe { libloading::Library::new(&tools.nvrtc) }?;
    let mut found = (0, 0);
    // SAFETY: both places outlive the call.
    unsafe { sys::nvrtcVersion(&mut found.0, &mut found.1) }.result()?;
    if found != tools.nvrtc_version {
        let ((major, minor), pinned) = (found, tools.nvrtc_version);
        return Err(format!(
            "the system's NVRTC {major}.{minor} comes before the pinned {}.{}; take it out of LD_LIBRARY_PATH",
            pinned.0, pinned.1
        )
        .into());
    }
    Ok(library)
}

fn compile(source: &Source) -> Result<String, Box<dyn Error>> {
    let text = CString::new(fs::read(Path::new(SOURCES).join(&source.path))?)?;
    let name = CString::new(source.path.as_os_str().as_encoded_bytes())?;
    let program = result::create_program(&text, Some(&name))?;
    // SAFETY: just created, and destroyed below; text and name live until then.
    let outcome = unsafe { compile_program(program) };
    // SAFETY: nothing refers to it any more.
    unsafe { result::destroy_program(program) }?;
    outcome
}

/// # Safety
/// `program` exists.
unsafe fn compile_program(program: sys::nvrtcProgram) -> Result<String, Box<dyn Error>> {
    let include = format!("--include-path={SOURCES}");
    let options: Vec<&str> = OPTIONS.into_iter().chain([include.as_str()]).collect();
    // SAFETY: the caller's promise, for all three calls.
    let (compiled, log) =
        unsafe { (result::compile_program(program, &options), text(result::get_program_log(program))?) };
    if let Err(error) = compiled {
        return Err(format!("{error}\n{log}").into());
    }
    if !log.trim().is_empty() {
        return Err(log.into());
    }
    // SAFETY: the caller's promise.
    unsafe { text(result::get_ptx(program)) }
}

/// NVRTC's text, which ends with a zero.
fn text(characters: Result<Vec<c_char>, NvrtcError>) -> Result<String, Box<dyn Error>> {
    let bytes = characters?.into_iter().map(|character| character as u8).take_while(|&byte| byte != 0);
    Ok(String::from_utf8(bytes.collect())?)
}
