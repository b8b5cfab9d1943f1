//! Curves as the language makes them: constructors, splines, fits, rounded corners, offsets.

pub mod build;
pub mod extend;
pub mod fewest;
pub mod fillet;
pub mod fit_curve;
pub mod offset_build;
pub mod polynomial;
pub mod rebuilt;
pub mod spline;
