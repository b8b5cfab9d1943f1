//! Bounds of points and derivatives of a surface over a rectangle of (u, v), by interval arithmetic on control nets,
//! closed forms and the blending algebra: nothing is sampled. `docs/notes/bounds.md` has the formulas.
//!
//! What depends on u alone (a [`Strip`]) is made once a column, what depends on v alone once a row.

use super::Jet2;
use super::blend_enclosure::BlendStrip;
use super::core::{Domain, Surface};
use super::line::Line;
use super::net_enclosure::NetStrip;
use super::rail::OneSided;
use super::shape::Shape;
use super::sweeps::FramedStrip;
use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::EPSILON;
use crate::base::work;

/// What a surface may do over a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure {
    /// Point and derivatives in the middle.
    pub mid: Jet2,
    /// Half the width in u and in v.
    pub half: (f64, f64),
    /// Points.
    pub p: Interval3,
    /// ∂/∂u.
    pub du: Interval3,
    /// ∂/∂v.
    pub dv: Interval3,
    /// ∂²/∂u²; vast where a curve below has a cusp or a net a corner.
    pub duu: Interval3,
    /// ∂²/∂u∂v.
    pub duv: Interval3,
    /// ∂²/∂v².
    pub dvv: Interval3,
}

impl Enclosure {
    /// First derivatives and points by Taylor's formula about the middle; `first` is what else is known of ∂u and ∂v.
    pub(super) fn new(mid: Jet2, half: (f64, f64), second: [Interval3; 3], first: Option<[Interval3; 2]>) -> Self {
        let [duu, duv, dvv] = second;
        let (a, b) = (Interval::around_zero(half.0), Interval::around_zero(half.1));
        let mut du = duu * a + duv * b + mid.du;
        let mut dv = duv * a + dvv * b + mid.dv;
        if let Some([known_u, known_v]) = first {
            (du, dv) = (du.intersection(known_u), dv.intersection(known_v));
        }
        let square = |h: f64| Interval { low: 0.0, high: 0.5 * h * h };
        let bent = duu * square(half.0) + duv * Interval::around_zero(half.0 * half.1) + dvv * square(half.1);
        let p = (a * mid.du + b * mid.dv + bent + mid.p).intersection(du * a + dv * b + mid.p);
        Self { mid, half, p, du, dv, duu, duv, dvv }
    }

    fn union(self, other: &Self) -> Self {
        Self {
            p: self.p.union(other.p),
            du: self.du.union(other.du),
            dv: self.dv.union(other.dv),
            duu: self.duu.union(other.duu),
            duv: self.duv.union(other.duv),
            dvv: self.dvv.union(other.dvv),
            ..self
        }
    }

    /// Bounds of |∂uu|, |∂uv| and |∂vv|; infinite where nothing is known.
    pub fn second(&self) -> [f64; 3] {
        [self.duu, self.duv, self.dvv].map(|r| if r.is_unbounded() { f64::INFINITY } else { r.reach() })
    }
}

/// What is known of a surface between two values of u, or of v.
#[derive(Clone, Debug)]
pub struct Strip {
    /// Ends, in the surface's parameters.
    ends: (f64, f64),
    /// The same in the shape's, cut at lines where its formula changes.
    parts: Vec<Part>,
    /// Whether first derivatives across a cut may jump.
    jumps: bool,
}

#[derive(Clone, Debug)]
struct Part {
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
            Part { ends, known }
        };
        let parts = cut(x0, x1, &lines).into_iter().map(part).collect();
        Strip { ends: (x0, x1), parts, jumps }
    }

    fn enclosure(&self, u: &Part, v: &Part) -> Enclosure {
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
