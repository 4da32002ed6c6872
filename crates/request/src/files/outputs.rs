//! Output files that are written completely or not at all, and replace neither inputs nor each other.

use std::path::{Path, PathBuf};

use lightmesh_files::{Identity, Ready, directory, identity};
use lightmesh_scene::Scene;
use serde::Serialize;

use super::destination::is_standard;
use crate::error::OutputError;
use crate::words::Name;

/// Indented JSON with a trailing newline.
pub fn json(value: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(value);
    text.expect("all keys are strings and serialization does no I/O") + "\n"
}

/// A complete file that appears when it is published.
pub fn ready(path: &Path, bytes: &[u8]) -> Result<Ready, OutputError> {
    Ok(Ready::with(path, bytes)?)
}

/// Lets all outputs of a run appear together.
pub fn publish(outputs: Vec<Ready>) -> Result<(), OutputError> {
    Ok(lightmesh_files::publish(outputs)?)
}

/// The outputs of a run, each with the name by which the user knows it. They overwrite neither inputs nor each other.
#[derive(Debug, Default)]
pub struct Outputs {
    files: Vec<(Name, Identity)>,
    /// All files in these may be written; the names are known later.
    folders: Vec<(Name, PathBuf)>,
}

impl Outputs {
    /// Checks that the files are different.
    pub fn new<'a>(files: impl IntoIterator<Item = (Name, Option<&'a Path>)>) -> Result<Outputs, OutputError> {
        let mut outputs = Outputs::default();
        for (flag, path) in files {
            let Some(path) = path else { continue };
            if let Some(first) = outputs.same_as(path) {
                return Err(OutputError::SameFile { first, second: flag, path: path.to_owned() });
            }
            outputs.files.extend(identity(path).map(|file| (flag, file)));
        }
        Ok(outputs)
    }

    /// The same with a folder for files of any names.
    pub fn with_folder(mut self, flag: Name, folder: PathBuf) -> Outputs {
        self.folders.push((flag, folder));
        self
    }

    /// Whether nothing is written.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty() && self.folders.is_empty()
    }

    /// Checks that none of the files, which the user knows as `what`, is overwritten.
    pub fn keep<'a>(&self, what: Name, paths: impl IntoIterator<Item = &'a Path>) -> Result<(), OutputError> {
        for path in paths {
            if let Some(flag) = self.same_as(path) {
                return Err(OutputError::SameFile { first: what, second: flag, path: path.to_owned() });
            }
            let parent = identity(directory(path));
            if let Some((flag, folder)) = self.folders.iter().find(|(_, folder)| identity(folder) == parent) {
                let (path, folder) = (path.to_owned(), folder.clone());
                return Err(OutputError::InFolder { what, path, output: flag, folder });
            }
        }
        Ok(())
    }

    /// The output that is the same file.
    fn same_as(&self, path: &Path) -> Option<Name> {
        let file = identity(path)?;
        self.files.iter().find(|(_, output)| *output == file).map(|&(flag, _)| flag)
    }

    /// Checks that no file of a scene is overwritten.
    pub fn keep_scene(&self, scene: &Scene) -> Result<(), OutputError> {
        self.keep("a file of the scene", scene.files.iter().map(PathBuf::as_path))
    }
}

/// The file of a scene on the command line; standard input may come from one, too.
pub fn input(scene: &Path) -> Option<&Path> {
    if is_standard(scene) { cfg!(unix).then_some(Path::new("/dev/stdin")) } else { Some(scene) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_has_many_names() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join(".").join("a"));
        let same = Outputs::new([("-o", Some(&*a)), ("--stats", None), ("--layers", Some(&*b))]).unwrap_err();
        assert!(same.to_string().starts_with("-o and --layers are the same file, "), "{same}");
        let outputs = Outputs::new([("-o", Some(&*a)), ("--layers", Some(&folder.path().join("b")))]).unwrap();
        assert!(outputs.keep("the scene", [&*b]).is_err());
        outputs.keep("the scene", [&*folder.path().join("c")]).unwrap();
    }

    #[test]
    fn a_folder_that_is_filled_has_no_input() {
        let folder = tempfile::tempdir().unwrap();
        let outputs = Outputs::default().with_folder("--report", folder.path().to_owned());
        let within = outputs.keep("the scene", [&*folder.path().join(".").join("a.obj")]).unwrap_err();
        assert!(within.to_string().contains("is in a folder that --report fills"), "{within}");
        outputs.keep("the scene", [Path::new("a.obj")]).unwrap();
    }
}
