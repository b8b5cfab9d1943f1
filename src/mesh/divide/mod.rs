//! How many steps each segment gets: the faces as equations between counts.

pub mod equations;
pub mod parity;
pub mod relations;
pub mod row_demand;
pub mod strips;
pub mod too_large;
pub mod verdict;
