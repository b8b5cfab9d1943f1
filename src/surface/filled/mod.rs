//! Surfaces that close holes of any number of sides.
//!
//! A polynomial of least bending over a plane meets borders, tangent planes and curvatures in the sense of least squares; what it misses is
//! blended in from the borders; patches round a centre, one at each corner, are nets through the sum. `docs/notes/fill.md` has the formulas.

mod beside;
mod chebyshev;
mod energy;
mod field;
pub mod fill;
mod hole;
mod householder;
mod net;
mod patch;
mod plane;
mod ribbon;
