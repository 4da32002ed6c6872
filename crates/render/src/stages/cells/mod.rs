//! Between steps 1 and 2: the surface points of each light-mesh cell.
//!
//! In: rays and hits. Out: [`CellGroups`](crate::data::cells::CellGroups). All surface points of a cell share their template, its positions
//! and the triangles that can matter to them, so that every lookup in the mesh is made once per cell. On a CUDA device surface points are
//! grouped tile by tile of the image, and split into bundles of up to 32 for a warp ([`DeviceCells`](crate::gpu::cells::DeviceCells)).

pub(crate) mod cpu;
pub(crate) mod cuda;
