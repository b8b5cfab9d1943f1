//! What can go wrong with files, family by family.

pub mod access;
pub mod content;
pub mod formats;
pub mod outputs;

pub use access::AccessFault;
pub use content::{ContentFault, Malformed, Share};
pub use formats::FormatFault;
pub use outputs::OutputFault;
