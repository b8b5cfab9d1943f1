//! Floor 6: file formats, one file each. Computes no geometry beyond conversion.

pub mod deck;
pub mod files;

pub use deck::{Deck, Encoding, FORMATS, Format, Loss, Options};
pub use files::{FileError, Files};
