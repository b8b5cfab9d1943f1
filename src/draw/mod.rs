//! Floor 6: pictures without a window or a GPU. Knows meshes and surface models, no files and no scripts.
//!
//! ```text
//!   surfaces, meshes, curves → scene → camera → raster ─┬─ words and signs → PNG
//!                                                       └─ seen lines, words → SVG
//! ```

pub mod annotate;
pub mod camera;
pub mod color;
pub mod faces;
pub mod font;
mod label_places;
mod legend;
pub mod lines;
pub mod meshes;
mod page;
pub mod picture;
pub mod png;
pub mod raster;
pub mod scene;
mod shade;
pub mod svg;
mod trimmed;

pub use camera::{Camera, VIEWS, View};
pub use picture::{FORMATS, Format, Picture, Settings};
pub use scene::{Kind, Label, Line, Mark, Paint, Scale, Scene, Sheet};
