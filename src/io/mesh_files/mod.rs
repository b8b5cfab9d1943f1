//! Mesh files: OBJ and STL read; STL, OBJ, PLY, VTU, MSH, INP, BDF, GLB and 3MF written, with the named sets of the mesh.

pub(crate) mod bdf;
pub(crate) mod binary;
pub(crate) mod closed_bodies;
pub mod deck;
pub(crate) mod element_groups;
pub mod element_shape;
pub(crate) mod elements;
pub mod format;
pub(crate) mod glb;
pub(crate) mod glb_buffers;
pub(crate) mod inp;
pub(crate) mod line_reader;
pub(crate) mod losses;
pub(crate) mod msh;
pub mod obj_read;
pub(crate) mod obj_write;
pub(crate) mod ply;
pub(crate) mod regions;
pub(crate) mod sets;
pub(crate) mod single_precision;
pub mod stl_read;
pub(crate) mod stl_write;
pub(crate) mod threemf;
pub(crate) mod triangulated;
pub(crate) mod vtu;
pub(crate) mod weld;
