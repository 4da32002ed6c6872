//! What `lightmesh render` is to do, here or on a server.

use lightmesh::request::Order;
use serde::{Deserialize, Serialize};

use crate::args::{Progress, RenderArgs};

/// An order, and what is told of the work on it.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    pub(crate) order: Order,
    pub(crate) told: Told,
}

/// What is told of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Told {
    pub(crate) progress: Progress,
    pub(crate) quiet: bool,
    pub(crate) verbose: bool,
}

impl Job {
    /// What a command line asks for.
    pub(crate) fn of(args: &RenderArgs) -> Job {
        let told = Told { progress: args.progress, quiet: args.quiet, verbose: args.verbose };
        Job { order: args.order(), told }
    }
}
