//! From CUDA C++ to PTX with NVRTC.

use std::error::Error;
use std::ffi::{CString, c_char};
use std::fs;
use std::process::Command;

use cudarc::nvrtc::result::{self, NvrtcError};
use cudarc::nvrtc::sys;

use super::parallel::in_parallel;
use super::sources::{Module, SOURCES, Source, ptx_path};
use super::tools::Tools;

/// The argument, before the name of a module, with which this program prints its PTX and does nothing else.
pub(crate) const ONE: &str = "--module";

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

/// What the PTX of all modules depends on besides their sources: compiler, options, and the form of the text that `tidy` gives.
pub(super) fn settings(nvrtc_version: &str) -> String {
    format!("NVRTC {nvrtc_version} {OPTIONS:?} tidy 1")
}

/// Compiles kernel files, each in a process of its own and as many at once as there are processors. A warning is an error. With `check`, a module
/// that differs from the committed one is tried again: some passes of the compiler depend on addresses in memory, so that two runs may place a
/// constant differently.
pub(super) fn all(sources: &[&Source], check: bool) -> Result<Vec<Module>, Box<dyn Error>> {
    let work = |source: &&Source| if check { committed(source) } else { in_a_process(source) };
    let outcomes = in_parallel(sources, work);
    let mut modules = Vec::new();
    let mut errors = String::new();
    for (Source { module: name, .. }, outcome) in sources.iter().copied().zip(outcomes) {
        match outcome {
            Ok(ptx) => modules.push(Module { name: name.clone(), ptx }),
            Err(error) => errors += &format!("{name}: {error}\n"),
        }
    }
    if errors.is_empty() { Ok(modules) } else { Err(errors.into()) }
}

/// Runs this program with [`ONE`] and the name of a module.
fn in_a_process(source: &Source) -> Result<String, String> {
    let said = |bytes: Vec<u8>| String::from_utf8(bytes).map_err(|error| error.to_string());
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output =
        Command::new(program).args(["kernels", ONE, &source.module]).output().map_err(|error| error.to_string())?;
    if output.status.success() { said(output.stdout) } else { Err(said(output.stderr)?) }
}

/// The PTX of one kernel file.
pub(super) fn one(tools: &Tools, source: &Source) -> Result<String, Box<dyn Error>> {
    let library = load(tools)?;
    let ptx = compile(source)?;
    drop(library);
    Ok(ptx)
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
fn committed(source: &Source) -> Result<String, String> {
    let committed = fs::read_to_string(ptx_path(&source.module)).ok();
    let mut ptx = in_a_process(source)?;
    for _ in 1..ATTEMPTS {
        if committed.is_none() || committed.as_ref() == Some(&ptx) {
            break;
        }
        ptx = in_a_process(source)?;
    }
    Ok(ptx)
}

fn compile(source: &Source) -> Result<String, Box<dyn Error>> {
    let text = CString::new(fs::read(source.folder.join(&source.path))?)?;
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
    let folders = SOURCES.map(|folder| format!("--include-path={folder}"));
    let options: Vec<&str> = OPTIONS.into_iter().chain(folders.iter().map(String::as_str)).collect();
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
    unsafe { text(result::get_ptx(program)) }.map(|ptx| tidy(&ptx))
}

/// The same code in fewer bytes: without blank lines, indentation and comments, except for the compiler's version in the first lines, and with short
/// names of the namespace of a file, which contain a hash of its path.
fn tidy(ptx: &str) -> String {
    let mut tidy = String::with_capacity(ptx.len());
    let mut begun = false;
    for line in ptx.lines() {
        let code = line.split("//").next().unwrap_or_default();
        begun |= !code.trim().is_empty();
        let kept = if begun { code } else { line };
        let mut words = kept.split_whitespace();
        let Some(first) = words.next() else { continue };
        let mut line = first.to_owned();
        words.for_each(|word| line.extend([" ", word]));
        tidy += &with_short_names(&line);
        tidy.push('\n');
    }
    tidy
}

/// A line with `1_` in place of mangled names such as `39_INTERNAL_00000000_9_kernel_cu_f7879292`: a number of characters, then so many.
fn with_short_names(line: &str) -> String {
    const MARK: &str = "_INTERNAL_";
    let mut short = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(at) = rest.find(MARK) {
        let (before, name) = rest.split_at(at);
        let digits = before.len() - before.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
        let (head, number) = before.split_at(before.len() - digits);
        let after = number.parse().ok().and_then(|length: usize| name.get(length..));
        let Some(after) = after else {
            short += &rest[..at + MARK.len()];
            rest = &rest[at + MARK.len()..];
            continue;
        };
        short += head;
        short += "1_";
        rest = after;
    }
    short + rest
}

/// Text from NVRTC, which is null-terminated.
fn text(characters: Result<Vec<c_char>, NvrtcError>) -> Result<String, Box<dyn Error>> {
    let bytes = characters?.into_iter().map(|character| character as u8).take_while(|&byte| byte != 0);
    Ok(String::from_utf8(bytes.collect())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ptx_keeps_its_code_and_the_compilers_version() {
        let ptx = "//\n// Generated by NVIDIA NVVM Compiler\n//\n\n.version 8.0\n\n\t// .globl\tscan\n.visible .entry scan(\n\
                   \t.param .u32 scan_param_0\n)\n{\n\t.reg .b32 \t%r<9>;\n\n\tmov.u32 \t%r1, %tid.x; \n\
                   \tcall _ZN39_INTERNAL_00000000_9_kernel_cu_f78792927far_rayE4Vec3f; // callseq 7\n}\n";
        let tidied = "//\n// Generated by NVIDIA NVVM Compiler\n//\n.version 8.0\n.visible .entry scan(\n\
                      .param .u32 scan_param_0\n)\n{\n.reg .b32 %r<9>;\nmov.u32 %r1, %tid.x;\n\
                      call _ZN1_7far_rayE4Vec3f;\n}\n";
        assert_eq!(tidy(ptx), tidied);
        assert_eq!(tidy(tidied), tidied);
    }

    #[test]
    fn names_that_are_not_mangled_stay() {
        for line in ["a_INTERNAL_b", "99_INTERNAL_b", "", "_INTERNAL_"] {
            assert_eq!(with_short_names(line), line);
        }
        assert_eq!(with_short_names("x13_INTERNAL_abcy+13_INTERNAL_defz"), "x1_y+1_z");
    }
}
