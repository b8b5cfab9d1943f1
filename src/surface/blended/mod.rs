//! Surfaces blended from curves: Coons and Gordon surfaces, ruled ones, plane faces, skins through sections.

pub mod bridge;
pub mod coons;
mod corners;
pub(crate) mod family;
pub mod gordon;
pub mod hermite;
pub mod plane_face;
pub mod ruled;
pub mod skin;
pub mod skin_align;
pub mod skin_ends;
pub mod skin_fit;
pub mod twists;
