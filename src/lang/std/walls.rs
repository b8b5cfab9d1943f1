//! Walls: faces with a thickness.

use super::kinds::SurfaceOrShell;
use crate::base::fault::{Say, ValueFault};
use crate::lang::types::Length;
use crate::model::thicken::thicken;
use crate::surface::Surface;
use crate::{builtins, choices};

choices! {
    /// Where a wall stands.
    pub enum WallSide {
        /// Half of it on either side of the face.
        Both = "both",
        /// On the side of the normal.
        Front = "front",
        /// On the other side.
        Back = "back",
    }
}

builtins! {
    /// Faces of the wall that a face becomes by a thickness.
    ///
    /// Its two sides, then the rims between their borders. The sides are offsets of the face, see `offset`; the rims are ruled along
    /// its free borders, so that the faces close: a shell
    /// of them has a volume and points outwards. One face at a time: a plane, trimmed or
    /// not, an extrusion across the plane of its profile, or a revolution.
    /// ```loft
    /// surface tube = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 3m))
    /// shell pipe of thicken(tube, 100mm)
    /// check pipe.volume == tube.area * 100mm within 1e-9%
    /// let faces = len(thicken(tube, 100mm, side: front)) // => 4
    /// ```
    fn thicken(
        /// A surface, or a shell of one face.
        of: SurfaceOrShell,
        /// How thick the wall is, above 0.
        thickness: Length,
        /// Where it stands: half on either side, on the side of the normal (`-face` turns it), or on the other one.
        side: WallSide = "both",
    ) -> Vec<Surface> = |cx, of, thickness, side| {
        let t = thickness.0;
        if t <= 0.0 {
            return Err(ValueFault::OutsideRange { argument: "thickness", found: cx.length(t), range: "above 0".to_owned() }.into());
        }
        let faces = of.surfaces();
        let [face] = faces.as_slice() else {
            return Err(ValueFault::NotInThisVersion { what: "`thicken` of several faces".to_owned() }.into());
        };
        let reach = match side {
            WallSide::Both => (-0.5 * t, 0.5 * t),
            WallSide::Front => (0.0, t),
            WallSide::Back => (-t, 0.0),
        };
        let (origin, tolerance) = (cx.origin(), cx.tolerance()?);
        let (made, notes) = thicken(face, reach, origin, &tolerance)?;
        notes.iter().for_each(|note| cx.say(note));
        Ok(made)
    };
}
