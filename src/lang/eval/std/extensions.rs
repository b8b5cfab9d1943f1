//! Curves and surfaces made longer.

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::geometry::construct::extend::{End, Onward, extend};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::whole;
use crate::lang::eval::std::kinds::CurveOrSurface;
use crate::lang::eval::std::surfaces::reported;
use crate::lang::values::conversions::Length;
use crate::lang::values::value::Value;
use crate::surface::{self, Rim};

crate::choices! {
    /// Where a curve or surface ends.
    pub enum RimWord {
        /// Where a curve begins; of a surface, u = 0.
        Start = "start",
        /// Where a curve ends; u = 1.
        End = "end",
        /// v = 0.
        Left = "left",
        /// v = 1.
        Right = "right",
    }
}

crate::choices! {
    /// How it goes on.
    pub enum OnwardWord {
        /// Straight.
        Linear = "linear",
        /// As it is at its end.
        Curvature = "curvature",
        /// As its mirror image.
        Reflect = "reflect",
    }
}

impl RimWord {
    fn rim(self) -> Rim {
        match self {
            Self::Start => Rim::Start,
            Self::End => Rim::End,
            Self::Left => Rim::Left,
            Self::Right => Rim::Right,
        }
    }

    /// E306 for a side that curves do not have.
    fn end(self) -> Result<End, Halt> {
        match self {
            Self::Start => Ok(End::Start),
            Self::End => Ok(End::End),
            other => {
                let (found, range) = (format!("`{}`", other.rim().word()), "`start` or `end` of a curve".to_owned());
                Err(ValueFault::OutsideRange { argument: "side", found, range }.into())
            }
        }
    }
}

fn longer(cx: &mut Cx, of: CurveOrSurface, side: RimWord, by: Length, how: OnwardWord) -> Result<Value, Halt> {
    let how = match how {
        OnwardWord::Linear => Onward::Linear,
        OnwardWord::Curvature => Onward::Curvature,
        OnwardWord::Reflect => Onward::Reflect,
    };
    let origin = cx.origin();
    Ok(match of {
        CurveOrSurface::Curve(chain) => {
            let curve = chain.to_curve()?.with_origin(chain.origin());
            Value::Curve(whole(extend(&curve, side.end()?, by.0, how, origin)?))
        }
        CurveOrSurface::Surface(of) => {
            let (made, notes) = surface::extend(&of, side.rim(), by.0, how, origin, &cx.tolerance()?)?;
            Value::Surface(reported(cx, made, &notes)?)
        }
    })
}

builtins! {
    /// A curve or surface made longer at one of its ends or sides.
    ///
    /// The rest of it stays what it is. `how: curvature` goes on as the last piece does: lines, arcs, ellipses and helices stay what they are,
    /// a spline goes on as the polynomial of its last span, with all derivatives continuous. It may bend much far beyond its end;
    /// `linear` goes on straight, along the tangent. `reflect`, of curves, goes on as the mirror image in the plane across
    /// the end: tangent and curvature are continuous, and it is at most as long as the curve.
    ///
    /// A curve becomes longer by `by:`, along itself. The sides of a surface are those of `s.start`, `s.end`, `s.left` and
    /// `s.right`; the lines across the side go on by the same step of u or v, and `by:` is what the longest of them gets. Planes,
    /// extrusions, and revolutions that turn on or whose profile is made longer, stay such; others become nets, exact where `nurbs(s)` is, and
    /// otherwise within the tolerance, which N677 states. Closed curves, sides that are points or seams, and trimmed surfaces are
    /// E417; what does not go on so far is E418.
    /// ```loft
    /// curve bow = arc((0, 0, 0), (2m, 0, 0), through: (1m, 1m, 0))
    /// curve longer = extend(bow, side: end, by: 500mm)
    /// check longer.length == bow.length + 500mm within 1e-9%
    /// surface roof = revolve(bow, axis: line((0, 0, 0), (2m, 0, 0)), angle: 60deg)
    /// surface wider = extend(roof, side: end, by: 300mm, how: linear)
    /// check wider.area > roof.area
    /// ```
    fn extend(
        /// A curve or a surface with four sides.
        of: CurveOrSurface,
        /// `start` or `end`; of a surface `left` and `right` too.
        side: RimWord,
        /// The length to be added, above 0.
        by: Length,
        /// How it goes on: `linear`, `curvature`, or of curves `reflect`.
        how: OnwardWord = "curvature",
    ) -> Value = |cx, of, side, by, how| longer(cx, of, side, by, how);
}
