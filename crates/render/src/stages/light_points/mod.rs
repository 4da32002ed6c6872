//! Step 3: each light point that some surface point uses, once. Formula (7).
//!
//! In: masks by cell. Out: [`UsedPoints`](crate::light_mesh::UsedPoints), a bitmap over bricks in ascending order, however many
//! threads marked it; on a CUDA device [`DevicePoints`](cuda::DevicePoints), a bitmap over the slots of a table whose order is
//! equally deterministic.

pub(crate) mod cpu;
pub(crate) mod cuda;
