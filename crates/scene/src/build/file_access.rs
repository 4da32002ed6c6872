//! The files that a scene may be made of: those in the folder of the file that was opened, links resolved, unless the options allow
//! others; and what fits into memory.

use std::io::Read;
use std::path::{Component, Path, PathBuf};

use lightmesh_files::{Portion, ReadError, read, read_inside, read_stream};
use lightmesh_memory::Budget;

use super::error::{LoadError, Place};
use super::load_options::LoadOptions;

/// Where the files of one scene may lie, and how much memory they may take.
#[derive(Clone, Debug)]
pub struct FileAccess {
    /// The file that was opened.
    scene: PathBuf,
    allow_outside: bool,
    pub(crate) budget: Budget,
}

impl FileAccess {
    /// The folder of a scene.
    pub fn new(scene: &Path, options: &LoadOptions) -> FileAccess {
        let budget = Budget::new(options.memory_limit);
        FileAccess { scene: scene.to_owned(), allow_outside: options.allow_outside, budget }
    }

    /// The content of the scene itself, wherever it is. Only regular files: a pipe or a device might never end.
    ///
    /// # Errors
    ///
    /// [`LoadError::Read`], [`LoadError::NoFile`] or [`LoadError::Memory`].
    pub(crate) fn read_scene(&self) -> Result<Vec<u8>, LoadError> {
        let portion = Portion { budget: self.budget, ..Portion::ALL };
        read(&self.scene, portion).map_err(|error| unreadable(&self.scene, error))
    }

    /// The content of a scene that has no file.
    ///
    /// # Errors
    ///
    /// [`LoadError::Read`] or [`LoadError::Memory`].
    pub(crate) fn read_stream(&self, source: impl Read) -> Result<Vec<u8>, LoadError> {
        read_stream(source, self.budget).map_err(|error| unreadable(&self.scene, error))
    }

    /// Fails if there is no memory for what the bytes of a model become, which is about as large, while they are read.
    ///
    /// # Errors
    ///
    /// [`LoadError::Memory`].
    pub(crate) fn check_content(&self, path: &Path, bytes: &[u8]) -> Result<(), LoadError> {
        self.budget.check(bytes.len() as u64).map_err(|short| LoadError::Memory {
            path: path.to_owned(),
            what: "the content of the file beside the file itself".to_owned(),
            short,
        })
    }

    /// The path that `source`, one of the scene's files, refers to as `name`: relative to the file's own folder, with either
    /// kind of slash.
    ///
    /// # Errors
    ///
    /// [`LoadError::Outside`] if that is a URL or, by its text, outside the scene's folder, unless that is allowed.
    pub fn path_beside(&self, source: &Path, name: &str) -> Result<PathBuf, LoadError> {
        let path = beside(source, name).ok_or_else(|| outside(source, name))?;
        let in_folder = tidy(&path)
            .strip_prefix(tidy(self.folder()))
            .is_ok_and(|rest| matches!(rest.components().next(), None | Some(Component::Normal(_))));
        if self.allow_outside || in_folder { Ok(path) } else { Err(outside(source, name)) }
    }

    /// The path and the content of the file that `source` refers to as `name`.
    ///
    /// # Errors
    ///
    /// [`LoadError::Outside`] if it is, by its text or through a link, outside the scene's folder, unless that is allowed;
    /// [`LoadError::Read`], [`LoadError::NoFile`] or [`LoadError::Memory`] if it cannot be read.
    pub(crate) fn read_beside(&self, source: &Path, name: &str) -> Result<(PathBuf, Vec<u8>), LoadError> {
        self.read_start(source, name, u64::MAX)
    }

    /// The same with the first `wanted` bytes of the content.
    pub(crate) fn read_start(&self, source: &Path, name: &str, wanted: u64) -> Result<(PathBuf, Vec<u8>), LoadError> {
        let path = self.path_beside(source, name)?;
        let portion = Portion { wanted, budget: self.budget };
        let bytes = if self.allow_outside { read(&path, portion) } else { read_inside(self.folder(), &path, portion) };
        match bytes {
            Ok(bytes) => Ok((path, bytes)),
            Err(ReadError::Outside) => Err(outside(source, name)),
            Err(error) => Err(unreadable(&path, error)),
        }
    }

    fn folder(&self) -> &Path {
        self.scene.parent().unwrap_or(Path::new(""))
    }
}

/// The path that `source` refers to as `name`; `None` if that is a URL.
pub(crate) fn beside(source: &Path, name: &str) -> Option<PathBuf> {
    let is_url = name.split_once("://").is_some_and(|(scheme, _)| scheme.chars().all(|c| c.is_ascii_alphanumeric()));
    let named = name.replace('\\', "/");
    let has_drive =
        matches!(named.as_bytes(), [letter, b':', ..] if letter.is_ascii_alphabetic()) && cfg!(not(windows));
    (!is_url && !has_drive).then(|| source.parent().unwrap_or(Path::new("")).join(named))
}

fn unreadable(path: &Path, error: ReadError) -> LoadError {
    let path = path.to_owned();
    match error {
        ReadError::System(cause) => LoadError::Read { path, cause },
        ReadError::Memory(short) => LoadError::Memory { path, what: "the file".to_owned(), short },
        _ => LoadError::NoFile { path },
    }
}

fn outside(source: &Path, name: &str) -> LoadError {
    LoadError::Outside { place: Place::file(source).into(), name: name.to_owned() }
}

/// The path without `.` and `..`, by its text alone.
fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(tidy.components().next_back(), Some(Component::Normal(_))) => {
                tidy.pop();
            }
            part => tidy.push(part),
        }
    }
    tidy
}
