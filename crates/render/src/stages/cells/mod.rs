//! Between steps 1 and 2: the surface points of each light-mesh cell.
//!
//! In: rays and hits. Out: [`CellGroups`](crate::data::cells::CellGroups). All surface points of a cell share their template, its positions and
//! the triangles that can matter to them, so that whatever is looked up in the mesh is looked up once a cell. On a CUDA device surface
//! points are grouped tile by tile of the picture, and cut into items of up to 32 for a warp
//! ([`DeviceCells`](crate::gpu::cells::DeviceCells)).

pub(crate) mod cpu;
pub(crate) mod cuda;
