//! Floor 6: pictures without a window or a GPU. Knows meshes and surface models, no files and no scripts.
//!
//! ```text
//!   surfaces, meshes, curves → scene → camera → raster ─┬─ words and signs → PNG
//!                                                       └─ seen lines, words → SVG
//!   tables, sections of hulls → drawing → strokes, fills and words on a page → PNG, SVG
//! ```

pub mod annotate;
mod axis;
pub mod camera;
pub mod color;
pub mod combs;
pub mod drawing;
pub mod faces;
pub mod font;
mod label_places;
mod legend;
pub mod lines;
pub mod lines_plan;
pub mod meshes;
mod page;
pub mod picture;
mod plan_views;
pub mod plot;
pub mod png;
pub mod raster;
pub mod scene;
mod shade;
pub mod svg;
mod trimmed;

pub use camera::{Camera, VIEWS, View};
pub use drawing::{Drawing, Page};
pub use picture::{FORMATS, Format, Picture, Settings};
pub use scene::{Kind, Label, Line, Mark, Paint, Scale, Scene, Sheet};
