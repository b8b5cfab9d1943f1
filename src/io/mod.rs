//! Floor 6: file formats, one file each. Computes no geometry beyond conversion.

mod bdf;
mod blocks;
pub mod deck;
pub mod files;
mod inp;
mod msh;
mod obj;
mod ply;
mod sets;
mod stl;
mod vtu;

pub use deck::{Deck, Encoding, FORMATS, Format, Loss, Options, Shape, extension, format_for, no_format};
pub use files::{FileError, Files, Memory};
