//! Faces cut by each other where they touch.

use crate::base::origin::Origin;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::kinds::SurfaceOrShell;
use crate::lang::values::conversions::Rest;
use crate::model::topology::Named;
use crate::model::{Model, SurfaceId};
use crate::network::Network;
use crate::surface::Surface;

/// Surfaces cut by each other; `origin` is given to the curves of cuts.
pub(crate) fn pieces(cx: &mut Cx, surfaces: Vec<Surface>, origin: Origin) -> Result<Vec<Surface>, Halt> {
    let tolerance = cx.tolerance()?;
    let mut named: Vec<Named> = Vec::new();
    for surface in surfaces {
        if !named.iter().any(|known| known.surface.is(&surface)) {
            named.push(Named { name: cx.surface_name(&surface), surface });
        }
    }
    let ids: Vec<SurfaceId> = (0..named.len()).map(SurfaceId::at).collect();
    // What surfaces have in common depends on them alone, not on the network that all curves make.
    let network = Network::default();
    let model = Model::build(named, &network, &tolerance, cx.job)?;
    Ok(model.imprinted(&ids, origin, &network, &tolerance, cx.job)?)
}

builtins! {
    /// Surfaces cut by each other, so that a mesh of the pieces conforms.
    ///
    /// Each is cut by edges of the others that lie on it and by the curves in which it crosses them; a line that ends inside a
    /// face cuts nothing off it. A region that several cover is a piece of the first one only. Pieces come in the order of their surfaces
    /// and belong to their sets. A group of one of the surfaces, and a rule on it, applies to all its pieces, also to those of the
    /// first one; on a piece it applies to that piece alone.
    /// ```loft
    /// surface slab = plane(polyline([(0, 0, 0), (9m, 0, 0), (9m, 9m, 0), (0, 9m, 0)], closed: true))
    /// surface column = extrude(circle(center: (5m, 5m, 0), radius: 1m), by: (0, 0, -3m))
    /// let pieces = imprint(slab, column)
    /// let n = len(pieces) // => 3
    /// mesh m of pieces { size: 500mm }
    /// ```
    fn imprint(
        /// Surfaces and shells.
        surfaces: Rest<SurfaceOrShell>,
    ) -> Vec<Surface> = |cx, surfaces| {
        let origin = cx.origin();
        pieces(cx, surfaces.0.iter().flat_map(SurfaceOrShell::surfaces).collect(), origin)
    };
}
