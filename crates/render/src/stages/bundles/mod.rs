//! Surface points in small groups that lie close together, for the search of what hides a light from any of them.
//!
//! In: rays and hits. Out: [`Bundles`](crate::data::bundles::Bundles): up to 32 surface points each. An image is taken tile by tile, 32 × 32
//! rays; a list of rays 1024 at a time. Within a tile, points are grouped by the cells of a lattice whose step is 32 to 64 pixels wide at
//! their distance, and within a cell they follow a Morton curve of 4 × 4 × 4 places. How points are grouped affects no result: full
//! groups are worth more than small ones, so cells are large.

pub(crate) mod cpu;
pub(crate) mod cuda;
