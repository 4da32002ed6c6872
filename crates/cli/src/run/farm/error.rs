//! Why a film cannot be shared out.

use std::path::PathBuf;

/// Why a film cannot be shared out.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FarmError {
    /// All frames would go to one file.
    #[error("--frames-to {}: tasks write frames, each to a file of its own, as in film.####.png; a movie can be made of them afterwards", .0.display())]
    Movie(PathBuf),
    /// All frames would replace each other.
    #[error("--frames-to {}: each frame needs a name of its own; write #### where the number goes, as in film.####.png", .0.display())]
    NoNumber(PathBuf),
    /// What is printed on a farm goes to its log.
    #[error("{flag} -: tasks of a farm write files; name one, as in film.####.png")]
    Standard { flag: &'static str },
    /// A scene that only this process can read.
    #[error("a scene on standard input cannot be read by a farm; name a file")]
    StandardInput,
    /// Text that templates give a meaning.
    #[error("`{0}` contains {{{{ or }}}}, which are of references in a job template; rename the file")]
    Reference(String),
    /// A name that templates cannot hold.
    #[error("{} is not Unicode, and a job template is; rename the file", .0.display())]
    NotUnicode(PathBuf),
    /// An unknown kind of file.
    #[error("-o {}: a job is a .yaml or a .json file", .0.display())]
    Extension(PathBuf),
}
