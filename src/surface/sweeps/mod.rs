//! Sweeps: a profile carried along a path (`along`), sections carried along guides by a law (`sweep`).

mod along;
mod build;
mod deform;
mod frame;
mod framed;
mod laws;
mod legs;
mod marks;
mod matrices;
mod measure;
mod net;
mod rounded;
mod sections;
mod single;
mod synchronized;

pub use along::{Settings as AlongSettings, along};
pub use build::{Input, Method, sweep};
pub(super) use framed::{Framed, FramedStrip};
pub use laws::Law;
