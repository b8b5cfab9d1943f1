//! A model as a page shows it: a frame that lists what the script declares, and buffers of triangles, lines and points.
//!
//! `viewer.rs` runs the model and keeps what did not change; `things.rs` lists its declarations; `faces.rs`, `lines.rs` and `meshes.rs`
//! draw them into buffers (`buffer.rs`), and `held.rs` says what of a group or shell is drawn there; `partial.rs` shows shapes before the rest is evaluated; `places.rs` finds the lines of the script; `frame.rs` is what is sent.

pub mod buffer;
mod faces;
pub mod frame;
mod held;
mod lines;
mod meshes;
mod params;
mod partial;
mod places;
mod said;
mod things;
pub mod viewer;
pub mod write_back;
