//! Surfaces that follow one another, as one.

use crate::builtins;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::Rest;
use crate::surface::{self, Surface};

builtins! {
    /// Surfaces that follow one another along whole borders, as one surface.
    ///
    /// They come in any order and direction; closed borders may begin at different points. The first one's u and v stay what they are: one
    /// runs along the common borders, the other across all surfaces in proportion to their mean lengths. Every surface stays exactly where
    /// it is, and points of a common border have one parameter along it, whatever the two surfaces had.
    /// Where they meet at an angle the surface has a crease and patches on both sides; a ring of surfaces closes. A join of joins is the join of all.
    /// ```loft
    /// surface wall = extrude(line((0, 0, 0), (0, 2m, 0)), by: (0, 0, 1m))
    /// surface roof = extrude(line((0, 0, 1m), (0, 2m, 1m)), by: (3m, 0, 500mm))
    /// surface shed = join(wall, roof)
    /// check shed.area == wall.area + roof.area within 1e-9%
    /// ```
    fn join(
        /// Two or more surfaces with four sides, or a list of them.
        surfaces: Rest<Surface>,
    ) -> Surface = |cx, surfaces| {
        let tolerance = cx.tolerance()?;
        let joined = surface::join(&surfaces.0, cx.origin(), &tolerance)?;
        reported(cx, joined, &[])
    };
}
