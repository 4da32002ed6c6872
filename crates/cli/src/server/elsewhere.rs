//! There are no servers on this system.

use std::path::Path;
use std::time::Duration;

use lightmesh::request::Warm;

use super::ServerError;
use crate::failure::Failure;
use crate::job::Job;

pub(crate) fn render(_: &Path, _: &Job) -> Result<u8, Failure> {
    Err(ServerError::System.into())
}

pub(crate) fn serve(_: &Path, _: Duration, _: bool, _: &dyn Fn(&Job, &mut Warm) -> u8) -> Result<(), Failure> {
    Err(ServerError::System.into())
}

pub(crate) fn start(_: &Path, _: Duration, _: Option<&Path>) -> Result<(), Failure> {
    Err(ServerError::System.into())
}

pub(crate) fn stop(_: &Path) -> Result<(), Failure> {
    Err(ServerError::System.into())
}
