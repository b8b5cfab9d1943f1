//! Walls: faces with a thickness.

use crate::base::fault::{Fault, Say, ValueFault};
use crate::base::limits::WORK_OF_A_SURFACE;
use crate::base::work;
use crate::lang::eval::std::kinds::SurfaceOrShell;
use crate::lang::eval::std::surfaces::note_crossing;
use crate::lang::values::conversions::Length;
use crate::model::measure::points_inwards;
use crate::surface::Surface;
use crate::surface::offset::thicken::{thicken, thicken_all, without_creases};
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

/// What is wrong with the distance by which a side of a wall is moved, said of the wall's thickness.
fn of_thickness(fault: Fault, side: &WallSide, thickness: f64) -> Fault {
    let Some(ValueFault::LengthOutside { argument: "distance", range, .. } | ValueFault::OffsetTooFar { range, .. }) = fault.of() else {
        return fault;
    };
    let both = matches!(side, WallSide::Both);
    let (argument, found) = if both { ("thickness / 2", 0.5 * thickness) } else { ("thickness", thickness) };
    ValueFault::LengthOutside { argument, found, range: range.clone() }.into()
}

builtins! {
    /// Faces of the wall made by thickening a face or a shell.
    ///
    /// Its two sides, then the rims between their borders. The sides are offsets of the faces, see `offset`; the rims stand along their
    /// normals on free borders, those of holes too, so that the faces close: a shell of them has a volume and points outwards. Faces
    /// that join smoothly share the moved edge; at sharp edges the moved ones are extended straight to where they meet, or
    /// are cut back there. The front of a closed shell is its outside, of an open one that of its first face. The wall encloses the
    /// area times the thickness, but for what curvature and edges add. A surface by itself, not a shell, goes round the corners of its
    /// profile instead. Pieces that are not connected need shells of their own for a wall on one side. Where faces do not meet it is E671, which names the edge.
    /// ```loft
    /// surface tube = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 3m))
    /// shell pipe of thicken(tube, 100mm)
    /// check pipe.volume == tube.area * 100mm within 1e-9%
    /// let faces = len(thicken(tube, 100mm, side: front)) // => 4
    /// shell cup of tube, plane(circle(center: (0, 0, 0), radius: 1m))
    /// shell beaker of thicken(cup, 100mm)
    /// check beaker.volume == pi * (1.05 ^ 2 * 3.05 - 0.95 ^ 2 * 2.95) * 1m3 within 1e-4%
    /// ```
    fn thicken(
        /// A surface or a shell.
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
        let reach = match side {
            WallSide::Both => (-0.5 * t, 0.5 * t),
            WallSide::Front => (0.0, t),
            WallSide::Back => (-t, 0.0),
        };
        let (origin, tolerance) = (cx.origin(), cx.tolerance()?);
        let (made, notes) = match &of {
            SurfaceOrShell::Surface(face) => thicken(face, reach, origin, &tolerance).map_err(|fault| of_thickness(fault, &side, t))?,
            SurfaceOrShell::Shell(shell) => {
                let faces = without_creases(&shell.surfaces, origin, &tolerance)?;
                // A call that is given many faces may look at each of them.
                if let Some(budget) = work::budget() {
                    budget.allow(faces.len() as u64 * WORK_OF_A_SURFACE);
                }
                let near = shell.snap.map_or(0.0, |snap| snap.0);
                let inwards = |faces: &[Surface]| points_inwards(&faces.iter().map(|f| (f.clone(), false)).collect::<Vec<_>>()) == Some(true);
                let turned = |faces: &[Surface], closed: bool| (closed && inwards(faces)) != shell.flip;
                thicken_all(&faces, reach, near, &turned, origin, &tolerance).map_err(|fault| of_thickness(fault, &side, t))?
            }
        };
        notes.iter().for_each(|note| cx.say(note));
        note_crossing(cx, &notes, &made, &tolerance);
        Ok(made)
    };
}
