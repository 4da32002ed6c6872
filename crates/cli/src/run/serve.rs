//! `lightmesh serve`.

use std::panic::{self, AssertUnwindSafe};

use lightmesh::request::Warm;

use super::render;
use crate::args::ServeArgs;
use crate::failure::{Failure, UNABLE};
use crate::job::Job;
use crate::report::{failed, forget_fault};
use crate::server;

pub(super) fn run(args: &ServeArgs) -> Result<(), Failure> {
    if args.stop {
        server::stop(&args.socket)
    } else if args.background {
        server::start(&args.socket, args.idle.0, args.log.as_deref())
    } else {
        server::serve(&args.socket, args.idle.0, args.inherit, &work)
    }
}

/// Does a job; returns the exit code.
fn work(job: &Job, warm: &mut Warm) -> u8 {
    forget_fault();
    let render = || render::render(job, warm).map_or_else(|failure| failed(&failure, &[]), |()| 0);
    let code = panic::catch_unwind(AssertUnwindSafe(render)).unwrap_or(UNABLE);
    if code == UNABLE {
        // What is broken, or too large, is not kept.
        *warm = Warm::for_many();
    }
    code
}
