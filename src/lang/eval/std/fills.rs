//! Surfaces that close holes.

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::eval::std::kinds::SectionKind;
use crate::lang::eval::std::surfaces::{note_crossing, reported};
use crate::lang::values::conversions::Whole;
use crate::network::Chain;
use crate::surface::{Filling, Surface, fill};

builtins! {
    /// A surface that closes a hole of any number of sides, beside faces smoothly.
    ///
    /// A list of patches, one at each corner of the hole round its centre, that are smooth to each other: a `shell` takes them as they are.
    /// They meet every border. Beside faces named in `to:` they have their tangent planes (`order: 1`) and curvatures too (`order: 2`); along
    /// other borders, and inside, they bend as little as they can. Borders come in any order and direction. Sides are found: curves that run
    /// on smoothly are one side, and a curve with kinks is several; where that leaves fewer than three, each border is a side, and one without
    /// corners is cut in four. `inner:` has points and curves that the surface passes, within the tolerance where they lie evenly. Seen along
    /// the mean of the faces' normals the borders must not cross, else E683. Faces and borders that do not agree at a corner are W681, with the
    /// angle there, and tangent planes or curvatures that are missed W682. A face that lies along no border is E680.
    /// ```loft
    /// let rim = [for k in 0..5: (cos(k * 72deg) * 1m, sin(k * 72deg) * 1m, 0)]
    /// let ring = [for k in 0..5: line(rim[k], rim[mod(k + 1, 5)])]
    /// let walls = [for side in ring: extrude(side, by: (0, 0, -1m))]
    /// let lid = fill(ring, inner: [(0, 0, 200mm)])
    /// shell tent of walls, lid
    /// ```
    fn fill(
        /// Curves round the hole.
        borders: Vec<Chain>,
        /// Faces that it continues where they lie along the borders.
        to: Option<Vec<Surface>>,
        /// 0: borders alone; 1: tangent planes of the faces; 2: their curvatures too.
        order: Whole = "1",
        /// Points and curves that it passes.
        inner: Option<Vec<SectionKind>>,
    ) -> Vec<Surface> = |cx, borders, to, order, inner| {
        let order = match order.0 {
            0 => 0,
            1 => 1,
            2 => 2,
            other => {
                let (found, range) = (other.to_string(), "0, 1 or 2".to_owned());
                return Err(ValueFault::OutsideRange { argument: "order", found, range }.into());
            }
        };
        let (origin, tolerance) = (cx.origin(), cx.tolerance()?);
        let (mut points, mut curves) = (Vec::new(), Vec::new());
        for thing in inner.unwrap_or_default() {
            match thing {
                SectionKind::Point(p) => points.push(p),
                SectionKind::Curve(c) => curves.push(c),
            }
        }
        let filling = Filling { to: to.unwrap_or_default(), order, points, curves };
        let (patches, notes) = fill(&borders, &filling, origin, &tolerance)?;
        notes.iter().for_each(|note| cx.say(note));
        note_crossing(cx, &notes, &patches, &tolerance);
        patches.into_iter().map(|patch| reported(cx, patch, &[])).collect()
    };
}
