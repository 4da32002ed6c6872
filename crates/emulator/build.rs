//! Compiles every kernel of the renderer as C++, together with the emulator's own.
//!
//! Kernel files are found by walking the folders. For each, a small generated file names the module and includes it. With
//! `LIGHTMESH_EMULATE=primary_rays,scan` only these modules are built, which saves time while working on one of them.
//!
//! Without a C++ compiler the emulator has no kernels, and its tests are ignored; with `LIGHTMESH_REQUIRE_CXX=1` that is an error.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rustc-check-cfg=cfg(no_cxx, needs_fma)");
    for variable in ["LIGHTMESH_EMULATE", "LIGHTMESH_REQUIRE_CXX", "CXX", "CLIPPY_ARGS"] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    // Fibres are implemented for POSIX systems; elsewhere this crate is empty.
    if env::var("CARGO_CFG_TARGET_FAMILY")? != "unix" {
        return Ok(());
    }
    // `cargo clippy` sets it, and links nothing.
    if env::var_os("CLIPPY_ARGS").is_some() {
        return Ok(());
    }
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(env::var("OUT_DIR")?);
    // As for the compiler of devices (`xtask/src/kernels/sources.rs`): includes are searched for in all of them.
    let mut folders = Vec::new();
    for name in ["kernels", "trace", "render"] {
        folders.push(here.join("..").join(name).join("src").canonicalize()?);
    }
    // Folders are watched as a whole, so that new files are noticed.
    for folder in folders.iter().chain([&here.join("shim"), &here.join("kernels")]) {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    if !has_compiler(&out)? {
        if env::var("LIGHTMESH_REQUIRE_CXX").is_ok_and(|value| value == "1") {
            return Err(
                "no C++ compiler works, and LIGHTMESH_REQUIRE_CXX=1 requires one; install one, or set CXX".into()
            );
        }
        println!("cargo::warning=no C++ compiler works: tests on the emulator are ignored; install one, or set CXX");
        println!("cargo::rustc-cfg=no_cxx");
        return Ok(());
    }
    let sources = sources(folders.iter().chain([&here]))?;
    let mut modules = modules(&sources)?;
    if let Ok(chosen) = env::var("LIGHTMESH_EMULATE") {
        modules.retain(|(module, _)| *module == "own" || chosen.split(',').any(|name| name == *module));
    }
    folders.insert(0, here.join("shim"));
    compile(&sources, &modules, &folders, &out)?;
    if has_fma() {
        println!("cargo::rustc-cfg=needs_fma");
    }
    println!("cargo::rustc-link-search=native={}", out.display());
    println!("cargo::rustc-link-lib=static=emulated_kernels");
    let library = if env::var("CARGO_CFG_TARGET_VENDOR")? == "apple" { "c++" } else { "stdc++" };
    println!("cargo::rustc-link-lib={library}");
    Ok(())
}

/// Whether there is a compiler at all. One that works and rejects the kernels is an error.
fn has_compiler(out: &Path) -> Result<bool, Box<dyn Error>> {
    let mut probe = cc::Build::new();
    probe.cargo_metadata(false).cargo_warnings(false).cpp(true).file(write(out, "probe.cpp", "int main() {}\n")?);
    Ok(probe.try_compile("probe").is_ok())
}

/// Compiles the modules into one library, unless this was already done with the same files.
fn compile(
    sources: &[PathBuf],
    modules: &[(&str, &Path)],
    include: &[PathBuf],
    out: &Path,
) -> Result<(), Box<dyn Error>> {
    let state = state(sources, modules)?;
    let state_file = out.join("state");
    if fs::read(&state_file).is_ok_and(|built| built == state) {
        return Ok(());
    }
    let mut build = cc::Build::new();
    build.cargo_metadata(false).cpp(true).std("c++17").includes(include);
    // The same bits as on a device: no operations are fused or reordered.
    build.opt_level(2).flag("-ffp-contract=off").flag("-fno-strict-aliasing").flag("-fno-math-errno");
    // Nothing replaces functions of the library, so they may be inlined.
    build.flag("-fvisibility=hidden");
    // Else each of these operations is a call of `fmaf`.
    if has_fma() {
        build.flag("-mfma").flag("-mpopcnt");
    }
    // Makes reads of uninitialised variables visible.
    build.flag_if_supported("-ftrivial-auto-var-init=pattern");
    // Fibres use `longjmp` to switch to another stack, which a fortified one rejects.
    build.flag("-U_FORTIFY_SOURCE").warnings(true).extra_warnings(true);
    // Unknown pragmas are for the device's compiler; the other warning only guesses, while poison detects real errors.
    build.flag_if_supported("-Wno-unknown-pragmas").flag_if_supported("-Wno-maybe-uninitialized");

    for (module, file) in modules {
        let text = format!(
            "#define EMULATED_MODULE \"{module}\"\n#include \"{}\"\nnamespace emulator {{\nvoid link_{module}() {{}}\n}}\n",
            file.display()
        );
        build.file(write(out, &format!("{module}.cpp"), &text)?);
    }
    build.file(write(out, "modules.cpp", &table(modules))?);
    build.files(sources.iter().filter(|path| path.extension().is_some_and(|extension| extension == "cpp")));
    build.try_compile("emulated_kernels")?;
    fs::write(state_file, state)?;
    Ok(())
}

/// Whether this processor, on which the tests will run, multiplies and adds in one step.
fn has_fma() -> bool {
    #[cfg(target_arch = "x86_64")]
    let has = is_x86_feature_detected!("fma") && is_x86_feature_detected!("popcnt");
    #[cfg(not(target_arch = "x86_64"))]
    let has = false;
    has && env::var("HOST").is_ok_and(|host| env::var("TARGET").is_ok_and(|target| target == host))
}

/// A file that refers to every module; without it the linker would drop them.
fn table(modules: &[(&str, &Path)]) -> String {
    let mut text = "namespace emulator {\n".to_owned();
    modules.iter().for_each(|(module, _)| text += &format!("void link_{module}();\n"));
    text += "void link_modules() {\n";
    modules.iter().for_each(|(module, _)| text += &format!("    link_{module}();\n"));
    text + "}\n}\n"
}

/// Everything that the library depends on.
fn state(sources: &[PathBuf], modules: &[(&str, &Path)]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut state = format!("{modules:?}{:?}{}", env::var("CXX"), has_fma()).into_bytes();
    state.extend(fs::read(Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("build.rs"))?);
    for path in sources {
        state.extend(path.as_os_str().as_encoded_bytes());
        state.extend(fs::read(path)?);
    }
    Ok(state)
}

/// The C++ files under some folders, in order.
fn sources<'a>(folders: impl Iterator<Item = &'a PathBuf>) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found = Vec::new();
    let mut folders: Vec<PathBuf> = folders.cloned().collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let extension = path.extension().and_then(|extension| extension.to_str());
            if path.is_dir() {
                folders.push(path);
            } else if let Some("cu" | "cuh" | "cpp" | "h") = extension {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// The kernel files with the names of their modules: `kernel.cu` is named after its folder, every other after itself.
fn modules(sources: &[PathBuf]) -> Result<Vec<(&str, &Path)>, Box<dyn Error>> {
    let kernel_files = sources.iter().filter(|path| path.extension().is_some_and(|extension| extension == "cu"));
    kernel_files
        .map(|path| {
            let named_by = if path.ends_with("kernel.cu") { path.parent() } else { Some(path.as_path()) };
            let module = named_by.and_then(Path::file_stem).and_then(|name| name.to_str());
            Ok((module.ok_or("a kernel file without a name")?, path.as_path()))
        })
        .collect()
}

fn write(folder: &Path, name: &str, text: &str) -> Result<PathBuf, Box<dyn Error>> {
    let path = folder.join(name);
    fs::write(&path, text)?;
    Ok(path)
}
