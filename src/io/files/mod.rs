//! How files are reached and written: the trait that reads and writes them, records written on several threads, names that a
//! format takes, and what it cannot hold.

pub mod access;
pub(crate) mod block_writer;
pub mod fault;
pub mod loss;
pub(crate) mod names;
pub(crate) mod romanize;
