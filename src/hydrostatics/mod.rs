//! Bodies in calm water: what is below a plane, from the surfaces themselves.
//!
//! - [`water`]: the water plane and its frame
//! - [`sums`]: the integrals, of whole faces and of what is below the plane
//! - [`face`]: faces made ready, cell by cell
//! - [`cut`]: cells cut by a plane, proven by bounds
//! - [`wet_cells`], [`flat`], [`triangles`]: the integrals below the plane of cells, flat faces and meshes
//! - [`body`]: a body of faces or triangles
//! - [`traces`], [`outline`]: waterlines and cross sections
//! - [`sides`], [`half_breadths`]: which sides a hull has, half breadths at stations and heights
//! - [`particulars`], [`mod@equilibrium`]: what follows

pub mod body;
pub mod cut;
pub mod equilibrium;
pub mod face;
pub mod fault;
pub mod flat;
pub mod half_breadths;
pub mod outline;
pub mod particulars;
pub mod sides;
pub mod sums;
pub mod traces;
pub mod triangles;
pub mod water;
pub mod wet_cells;
