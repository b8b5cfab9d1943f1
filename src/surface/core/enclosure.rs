//! Bounds of points and derivatives of a surface over a rectangle of (u, v), by interval arithmetic on control nets,
//! closed forms and the blending algebra: nothing is sampled. `docs/notes/bounds.md` has the formulas.
//!
//! What depends on u alone (a [`Strip`]) is made once a column, what depends on v alone once a row.

use crate::base::range::Interval3;
use crate::base::tolerance::EPSILON;
use crate::base::work;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::shapes::blend_enclosure::BlendStrip;
use crate::surface::shapes::framed::FramedStrip;
use crate::surface::shapes::net_enclosure::NetStrip;

/// What is known of a surface between two values of u, or of v.
#[derive(Clone, Debug)]
pub struct Strip {
    /// Ends, in the surface's parameters.
    ends: (f64, f64),
    /// The same in the shape's, cut at lines where its formula changes.
    parts: Vec<EnclosurePart>,
    /// Whether first derivatives across a cut may jump.
    jumps: bool,
}

#[derive(Clone, Debug)]
struct EnclosurePart {
    ends: (f64, f64),
    known: Known,
}

#[derive(Clone, Debug)]
enum Known {
    Nothing,
    Blend(BlendStrip),
    Profile(Line),
    Net(NetStrip),
    Framed(Box<FramedStrip>),
}

impl Surface {
    /// Bounds of |∂²/∂u²|, |∂²/∂u∂v| and |∂²/∂v²| over a rectangle (low and high of u, of v), model units.
    ///
    /// They hold everywhere in it and come as near to the largest values as the rectangle is small. Infinite where a curve
    /// below ends in a cusp or a net has a corner inside.
    pub fn second_derivative_bound(&self, u: (f64, f64), v: (f64, f64)) -> [f64; 3] {
        self.enclosure(u, v).second()
    }

    /// Bounds over a rectangle, low and high of u and of v.
    pub fn enclosure(&self, u: (f64, f64), v: (f64, f64)) -> Enclosure {
        self.spread_of(&self.strip_u(u.0, u.1), &self.strip_v(v.0, v.1))
    }

    /// Whether all its lines of constant u are one curve in motion: bends are then the same at every u.
    pub fn is_swept(&self) -> bool {
        matches!(self.parts().shape, Shape::Sweep(_))
    }

    /// How many curves a point is made of that depend on u alone, and on v alone: on a grid each is evaluated once a column or a row.
    pub fn curves_of_a_point(&self) -> (usize, usize) {
        if let Shape::Blend(blend) = &self.parts().shape { (blend.along_u().len(), blend.along_v().len()) } else { (1, 1) }
    }

    /// What depends on u alone.
    pub fn strip_u(&self, u0: f64, u1: f64) -> Strip {
        let swapped = self.parts().flipped && self.domain() == Domain::Triangle;
        Strip { ends: (u0, u1), ..self.parts().shape.strip(!swapped, u0, u1) }
    }

    /// What depends on v alone.
    pub fn strip_v(&self, v0: f64, v1: f64) -> Strip {
        let flipped = self.parts().flipped;
        let strip = match (flipped, self.domain()) {
            (true, Domain::Triangle) => self.parts().shape.strip(true, v0, v1),
            (true, _) => self.parts().shape.strip(false, 1.0 - v1, 1.0 - v0),
            _ => self.parts().shape.strip(false, v0, v1),
        };
        Strip { ends: (v0, v1), ..strip }
    }

    /// Bounds over the rectangle of two strips.
    pub fn spread_of(&self, u: &Strip, v: &Strip) -> Enclosure {
        work::spend(4);
        let (flipped, triangle) = (self.parts().flipped, self.domain() == Domain::Triangle);
        let (a, b) = if flipped && triangle { (v, u) } else { (u, v) };
        let mut whole: Option<Enclosure> = None;
        for (x, y) in a.parts.iter().flat_map(|x| b.parts.iter().map(move |y| (x, y))) {
            let own = self.parts().shape.enclosure(x, y);
            whole = Some(whole.map_or(own, |w| w.union(&own)));
        }
        let mut s = whole.unwrap_or_else(|| self.unknown(u, v));
        if a.parts.len() * b.parts.len() > 1 {
            let middle = |strip: &Strip| 0.5 * (strip.ends.0 + strip.ends.1);
            let half = |strip: &Strip| 0.5 * (strip.ends.1 - strip.ends.0);
            (s.half, s.mid) =
                ((half(a), half(b)), self.parts().shape.jet(inner_middle(a), inner_middle(b), (OneSided::After, OneSided::After)));
            debug_assert!(middle(u).is_finite());
            if a.jumps && a.parts.len() > 1 {
                (s.duu, s.duv) = (Interval3::ANY, Interval3::ANY);
            }
            if b.jumps && b.parts.len() > 1 {
                (s.dvv, s.duv) = (Interval3::ANY, Interval3::ANY);
            }
        }
        match (flipped, triangle) {
            (false, _) => s,
            (true, true) => Enclosure {
                mid: Jet2 { du: s.mid.dv, dv: s.mid.du, duu: s.mid.dvv, dvv: s.mid.duu, ..s.mid },
                half: (s.half.1, s.half.0),
                du: s.dv,
                dv: s.du,
                duu: s.dvv,
                dvv: s.duu,
                ..s
            },
            (true, false) => Enclosure { mid: Jet2 { dv: -s.mid.dv, duv: -s.mid.duv, ..s.mid }, dv: -s.dv, duv: -s.duv, ..s },
        }
    }

    fn unknown(&self, u: &Strip, v: &Strip) -> Enclosure {
        let mid = self.jet(u.ends.0, v.ends.0);
        Enclosure::new(mid, (u.ends.1 - u.ends.0, v.ends.1 - v.ends.0), [Interval3::ANY; 3], None)
    }
}

/// Middle of a strip in the shape's parameters.
fn inner_middle(strip: &Strip) -> f64 {
    0.5 * (strip.parts[0].ends.0 + strip.parts[strip.parts.len() - 1].ends.1)
}

/// Pieces of `x0…x1` between given lines.
fn cut(x0: f64, x1: f64, lines: &[f64]) -> Vec<(f64, f64)> {
    let inner = lines.iter().copied().filter(|x| *x > x0 + EPSILON && *x < x1 - EPSILON);
    let stops: Vec<f64> = std::iter::once(x0).chain(inner).chain(std::iter::once(x1)).collect();
    stops.windows(2).map(|w| (w[0], w[1])).collect()
}

impl Shape {
    /// What is known along u (`along_u`) or along v between two values.
    fn strip(&self, along_u: bool, x0: f64, x1: f64) -> Strip {
        let (lines, jumps) = match self {
            Self::Blend(s) => (s.rule_changes(along_u), false),
            Self::Nurbs(s) => s.knot_lines(along_u, (x0, x1)),
            Self::Joined(s) => s.changes(along_u),
            Self::Framed(s) if along_u => s.changes(x0, x1),
            _ => (Vec::new(), false),
        };
        let part = |ends: (f64, f64)| {
            let known = match self {
                Self::Blend(s) => Known::Blend(s.strip(along_u, ends)),
                Self::Sweep(s) if !along_u => Known::Profile(s.profile().line(ends.0, ends.1)),
                Self::Nurbs(s) => Known::Net(s.strip(along_u, ends)),
                Self::Framed(s) if along_u => Known::Framed(Box::new(s.strip(ends))),
                Self::Framed(s) => Known::Profile(s.profile().line(ends.0, ends.1)),
                _ => Known::Nothing,
            };
            EnclosurePart { ends, known }
        };
        let parts = cut(x0, x1, &lines).into_iter().map(part).collect();
        Strip { ends: (x0, x1), parts, jumps }
    }

    fn enclosure(&self, u: &EnclosurePart, v: &EnclosurePart) -> Enclosure {
        let half = (0.5 * (u.ends.1 - u.ends.0), 0.5 * (v.ends.1 - v.ends.0));
        let middle = (0.5 * (u.ends.0 + u.ends.1), 0.5 * (v.ends.0 + v.ends.1));
        match (self, &u.known, &v.known) {
            (Self::Blend(s), Known::Blend(a), Known::Blend(b)) => s.enclosure(a, b, half),
            (Self::Sweep(s), _, Known::Profile(line)) => s.enclosure(middle.0, half, line),
            (Self::Framed(s), Known::Framed(strip), Known::Profile(line)) => s.enclosure(strip, half, line),
            (Self::Nurbs(s), Known::Net(a), Known::Net(b)) => s.enclosure(a, b, middle, half),
            (Self::Joined(s), ..) => s.enclosure(u.ends, v.ends),
            (Self::Scatter(s), ..) => s.enclosure(u.ends, v.ends),
            (Self::Trilateral(s), ..) => s.enclosure(u.ends, v.ends),
            (Self::Plane(s), ..) => Enclosure::new(s.jet(middle.0, middle.1), half, [Interval3::default(); 3], None),
            _ => Enclosure::new(self.jet(middle.0, middle.1, (OneSided::After, OneSided::After)), half, [Interval3::ANY; 3], None),
        }
    }
}
