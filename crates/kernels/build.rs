//! Compresses the kernels' PTX, which is text: with the feature `cuda`, every module of `src/cuda/ptx` becomes a file of the output folder, and
//! `ptx.rs` there lists them all.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "cuda")]
    ptx::compress()?;
    Ok(())
}

#[cfg(feature = "cuda")]
mod ptx {
    use std::error::Error;
    use std::fmt::Write;
    use std::path::{Path, PathBuf};
    use std::{env, fs};

    use zlib_rs::{DeflateConfig, ReturnCode, compress_bound, compress_slice};

    const FOLDER: &str = "src/cuda/ptx";
    /// The smallest that deflate makes: it happens once, for all who unpack it.
    const LEVEL: i32 = 9;

    pub(super) fn compress() -> Result<(), Box<dyn Error>> {
        println!("cargo::rerun-if-changed={FOLDER}");
        let out = PathBuf::from(env::var("OUT_DIR")?);
        let mut paths: Vec<PathBuf> =
            fs::read_dir(FOLDER)?.map(|entry| Ok(entry?.path())).collect::<Result<_, std::io::Error>>()?;
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "ptx"));
        paths.sort();
        let mut list = "&[\n".to_owned();
        for path in paths {
            let name = path.file_stem().and_then(|name| name.to_str()).ok_or("a module without a name")?;
            let text = fs::read_to_string(&path)?;
            let packed = out.join(format!("{name}.z"));
            fs::write(&packed, compressed(text.as_bytes(), &path)?)?;
            writeln!(
                list,
                "    Module {{ name: {name:?}, head: {:?}, bytes: {}, packed: include_bytes!({packed:?}) }},",
                head(&text),
                text.len()
            )?;
        }
        fs::write(out.join("ptx.rs"), list + "]\n")?;
        Ok(())
    }

    /// The lines up to that with the target: what the module needs.
    fn head(text: &str) -> String {
        let target = text.lines().position(|line| line.trim_start().starts_with(".target"));
        let lines = text.lines().take(target.map_or(0, |at| at + 1));
        lines.filter(|line| line.starts_with('.')).map(|line| line.to_owned() + "\n").collect()
    }

    fn compressed(text: &[u8], path: &Path) -> Result<Vec<u8>, String> {
        let mut packed = vec![0; compress_bound(text.len())];
        match compress_slice(&mut packed, text, DeflateConfig::new(LEVEL)) {
            (packed, ReturnCode::Ok) => Ok(packed.to_vec()),
            (_, code) => Err(format!("{}: zlib says {code:?}", path.display())),
        }
    }
}
