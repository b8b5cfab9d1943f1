//! What a surface may be by itself, evaluated and bounded: blended curves, nets, profiles in motion, heights over a plane. Nothing here
//! knows of the others or of [`Surface`](super::core::surface::Surface).

mod axis_powers;
pub mod blend;
pub mod blend_enclosure;
mod blend_grid;
pub mod blend_line;
pub mod blend_powers;
mod blend_terms;
mod blend_track;
pub mod cardinal;
pub mod cubic_triangle;
pub mod frame;
pub mod framed;
pub mod height_field;
pub mod matrices;
pub mod net_enclosure;
pub mod nurbs;
mod nurbs_grid;
pub mod polynomial_pieces;
pub mod powers;
pub mod rule;
pub mod speed_map;
pub mod spline_parts;
pub mod sweep;
pub mod third_derivative_bounds;
pub mod trilateral;
pub mod trilateral_enclosure;
pub mod weights;
