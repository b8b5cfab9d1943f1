//! What a surface may do over a rectangle.

use crate::base::range::{Interval, Interval3};
use crate::surface::data::jet::Jet2;

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
    /// ∂²/∂u²; unbounded where a curve below has a cusp or a net a corner.
    pub duu: Interval3,
    /// ∂²/∂u∂v.
    pub duv: Interval3,
    /// ∂²/∂v².
    pub dvv: Interval3,
}

impl Enclosure {
    /// First derivatives and points by Taylor's formula about the middle; `first` is what else is known of ∂u and ∂v.
    pub(crate) fn new(mid: Jet2, half: (f64, f64), second: [Interval3; 3], first: Option<[Interval3; 2]>) -> Self {
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

    pub(crate) fn union(self, other: &Self) -> Self {
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
