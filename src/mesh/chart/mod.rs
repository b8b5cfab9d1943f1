//! A face meshed freely in the plane: its parameters sheared so that lengths are those in space on average, and its border there.

pub mod affine;
pub mod embedded;
pub mod face_border;
pub mod face_input;
pub mod halved;
pub mod halves;
pub mod interpolated;
pub mod outline;
pub mod parametric_surface;
pub mod rings;
