//! The request that workers get: the same pixels, with paths that hold in any folder, and without what only the leader decides.

use std::path::{Path, PathBuf, absolute};

use crate::request::Request;
use crate::value::Frames;

/// The request of a worker. It renders whatever frame it is told to, and replaces the file of one that was rendered before.
pub fn for_workers(request: &Request) -> Request {
    let mut own = request.clone();
    (own.resume, own.skip_existing, own.overwrite) = (false, false, false);
    if let Some(environment) = &mut own.environment {
        environment.file = anywhere(&environment.file);
    }
    own.grid_file = own.grid_file.as_deref().map(anywhere);
    let is_film = own.frames.is_some() || own.turntable.is_some() || own.sun.is_some() || own.fps.is_some();
    if is_film {
        own.overwrite = true;
        // One frame stands for all in what is checked before the scene is open: else each worker would look for all files.
        own.frames = Some(Frames::up_to(1));
    }
    own
}

fn anywhere(path: &Path) -> PathBuf {
    absolute(path).unwrap_or_else(|_| path.to_owned())
}
