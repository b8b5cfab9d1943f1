//! Faults of the surface model, family by family.

pub mod contacts;
pub mod gluing;
pub mod shells;

pub use contacts::{ContactFault, Touching};
pub use gluing::GluingFault;
pub use shells::ShellFault;
