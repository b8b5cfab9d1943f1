//! Mesh files: OBJ and STL read; STL, OBJ, PLY, VTU, MSH, INP and BDF written, with the named sets of the mesh.

pub(crate) mod bdf;
pub(crate) mod binary;
pub mod deck;
pub(crate) mod element_groups;
pub mod element_shape;
pub(crate) mod elements;
pub mod format;
pub(crate) mod inp;
pub(crate) mod line_reader;
pub(crate) mod losses;
pub(crate) mod msh;
pub mod obj_read;
pub(crate) mod obj_write;
pub(crate) mod ply;
pub(crate) mod sets;
pub mod stl_read;
pub(crate) mod stl_write;
pub(crate) mod vtu;
pub(crate) mod weld;
