//! Three borders without a pole: the uniform trilateral [Barnhill, Birkhoff & Gordon 1973].
//!
//! ```text
//! U = ½ (P_0 + P_1 + P_2 − L),  P_a = (l_c C_ac(l_a) + l_b C_ab(l_a)) / (l_b + l_c),  L = Σ l_a V_a
//! ```
//!
//! in barycentric `l = (1 − u − v, u, v)`; `C_ab(x)` is the point of side ab with weight x at V_a.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::POLE_REACH;
use crate::geometry::{Jet, Motion};
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;

/// A three-sided surface.
#[derive(Clone, Debug)]
pub struct Trilateral {
    /// V0→V1 (v = 0), V1→V2 (the slant), V0→V2 (u = 0), each over 0…1.
    sides: [Rail; 3],
    corners: [DVec3; 3],
}

crate::content!(Trilateral { sides, corners });

/// A function of two variables with its derivatives: value, ∂b, ∂c, ∂bb, ∂bc, ∂cc.
struct Term([DVec3; 6]);

impl Trilateral {
    /// The side along u, and those along v: u = 0 and the slant.
    pub fn families(&self) -> (Vec<Option<&crate::network::Chain>>, Vec<Option<&crate::network::Chain>>) {
        let [bottom, slant, left] = &self.sides;
        (vec![bottom.chain()], vec![left.chain(), slant.chain()])
    }

    /// From the sides V0→V1, V1→V2 and V0→V2.
    pub fn new(sides: [Rail; 3]) -> Self {
        let end = |k: usize, x: f64| sides[k].point(x);
        let corners = [0.5 * (end(0, 0.0) + end(2, 0.0)), 0.5 * (end(0, 1.0) + end(1, 0.0)), 0.5 * (end(1, 1.0) + end(2, 1.0))];
        Self { sides, corners }
    }

    /// The sides V0→V1, V1→V2, V0→V2.
    pub fn sides(&self) -> &[Rail; 3] {
        &self.sides
    }

    /// Point and derivatives.
    pub fn jet(&self, u: f64, v: f64) -> Jet2 {
        let l = [1.0 - u - v, u, v];
        // Towards the other corner, t runs from 0 at V_a: sides that end at V_a are read backwards.
        let [bottom, slant, left] = &self.sides;
        let away = |rail: &Rail, t: f64| rail.jet(t, OneSided::After);
        let back = |rail: &Rail, t: f64| {
            let jet = rail.jet(1.0 - t, OneSided::Before);
            Jet { p: jet.p, d1: -jet.d1, d2: jet.d2 }
        };
        let (t0, t1, t2) = (l[1] + l[2], l[0] + l[2], l[0] + l[1]);
        let first = self.term(0, (l[1], l[2]), &away(bottom, t0), &away(left, t0));
        let second = self.term(1, (l[0], l[2]), &back(bottom, t1), &away(slant, t1));
        let third = self.term(2, (l[0], l[1]), &back(left, t2), &back(slant, t2));
        let plane = self.corners[0] * l[0] + self.corners[1] * l[1] + self.corners[2] * l[2];
        // l0 falls with u and with v: (b, c) are (u, v), (l0, v) and (l0, u).
        let (a, b, c) = (&first.0, &second.0, &third.0);
        let [v0, v1, v2] = self.corners;
        Jet2 {
            p: 0.5 * (a[0] + b[0] + c[0] - plane),
            du: 0.5 * (a[1] - b[1] + (c[2] - c[1]) - (v1 - v0)),
            dv: 0.5 * (a[2] + (b[2] - b[1]) - c[1] - (v2 - v0)),
            duu: 0.5 * (a[3] + b[3] + (c[3] - 2.0 * c[4] + c[5])),
            duv: 0.5 * (a[4] + (b[3] - b[4]) + (c[3] - c[4])),
            dvv: 0.5 * (a[5] + (b[3] - 2.0 * b[4] + b[5]) + c[3]),
        }
    }

    /// P_a as a function of the two other weights, from the two sides at distance t = b + c from the corner.
    fn term(&self, corner: usize, (b, c): (f64, f64), side_b: &Jet, side_c: &Jet) -> Term {
        let t = b + c;
        let (sum1, sum2) = (side_c.d1, side_c.d2);
        if t < POLE_REACH {
            // At the corner the quotient is 0/0; its expansion V + b T_b + c T_c + ½ (b + c)(b K_b + c K_c) is a polynomial.
            let (kb, kc) = (side_b.d2, side_c.d2);
            let p = self.corners[corner] + side_b.d1 * b + side_c.d1 * c;
            return Term([p, side_b.d1, side_c.d1, kb, 0.5 * (kb + kc), kc]);
        }
        let (w, q) = (b / t, c / t);
        let gap = side_b.p - side_c.p;
        let (gap1, gap2) = (side_b.d1 - side_c.d1, side_b.d2 - side_c.d2);
        let (first, second) = (sum1 + gap1 * w, sum2 + gap2 * w);
        Term([
            side_c.p + gap * w,
            first + gap * (q / t),
            first - gap * (w / t),
            second + gap1 * (2.0 * q / t) - gap * (2.0 * q / (t * t)),
            second + gap1 * ((q - w) / t) + gap * ((1.0 - 2.0 * q) / (t * t)),
            second - gap1 * (2.0 * w / t) + gap * (2.0 * w / (t * t)),
        ])
    }

    /// A box that holds the surface: |U| is at most twice the reach of its borders about any centre (½·(3 + 1)).
    pub fn hull(&self) -> Box3 {
        let mut box3 = Box3::of(self.corners);
        for run in self.sides.iter().filter_map(Rail::chain).flat_map(|chain| chain.runs()) {
            box3 = box3.union(run.curve.bbox());
        }
        let (center, half) = (box3.center(), box3.max - box3.min);
        Box3 { min: center - half, max: center + half }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self { sides: self.sides.each_ref().map(|s| s.moved(motion)), corners: self.corners.map(|p| motion.point(p)) }
    }
}
