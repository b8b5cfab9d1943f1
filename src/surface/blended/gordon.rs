//! Gordon surfaces: cubic splines through both families of a complete net [Gordon 1969].
//!
//! ```text
//! U = P_u F + P_v F − P_u P_v F,   P_u F = Σ a_i(u) F(u_i, v),   P_v F = Σ b_j(v) F(u, v_j)
//! ```
//!
//! a and b are the cardinal functions of C2 cubic splines (`cardinal.rs`), the same in all three parts, so the surface
//! contains every curve to rounding. It is evaluated as this sum: nothing is fitted. Given end slopes would change
//! nothing but a and b: fields of end slopes that come from the net itself, interpolated by the same splines, cancel between
//! the parts. So the ends are "not a knot", which reproduces cubics, and closed directions are periodic. Where all curves of a direction
//! have a corner at a node the splines have one too (`corners.rs`).
//!
//! The error for a net of lines of a surface F is (I − P_u)(I − P_v) F: zero where F is a cubic in one direction, and of
//! the eighth order in the distances of the curves else.

use crate::base::fault::Fault;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::blended::coons::{Made, finish};
use crate::surface::blended::corners::spline_axis;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::jet::unit_normal;
use crate::surface::data::kind::SurfaceKind;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::weights::BlendAxis;

/// A complete net of curves in common parameters.
#[derive(Clone, Debug)]
pub struct CurveNet {
    /// Curves along u, ascending v, one per value of `nodes.1`; a pole is [`Rail::Point`].
    pub along_u: Vec<Rail>,
    /// Curves along v, ascending u, one per value of `nodes.0`; none for a surface through `along_u` alone.
    pub along_v: Vec<Rail>,
    /// u of the curves along v and v of the curves along u, each ascending from 0 to 1.
    ///
    /// Every curve along u passes the curve along v number i at its parameter `nodes.0[i]`, and the other way round. In
    /// a closed direction the last value is 1 and has no curve of its own: the first one closes the direction.
    pub nodes: (Vec<f64>, Vec<f64>),
    /// Whether u and v are periodic.
    pub closed: (bool, bool),
}

/// What a surface through a net is called.
#[derive(Clone, Debug)]
pub struct Named {
    /// The declaration.
    pub origin: Origin,
    /// The word it was made with.
    pub kind: SurfaceKind,
    /// Phrase of its flow, as [`crate::network::Flow::phrase`] has it.
    pub flow: String,
    /// The curves given, in order of writing.
    pub chains: Vec<Chain>,
}

/// The Gordon surface of a net, with warnings (W614). Without curves along v it is the spline surface through those along u.
pub fn gordon(net: CurveNet, named: Named, tolerance: &Tolerance) -> (Surface, Vec<Fault>) {
    blended(net, named, false, tolerance)
}

/// [`gordon`], or blended linearly between neighbours with a kink along each inner curve (`straight`).
pub(crate) fn blended(net: CurveNet, named: Named, straight: bool, tolerance: &Tolerance) -> (Surface, Vec<Fault>) {
    let CurveNet { mut along_u, mut along_v, nodes, closed } = net;
    for (rails, closed) in [(&mut along_u, closed.1), (&mut along_v, closed.0)] {
        if closed && let Some(first) = rails.first().cloned() {
            rails.push(first);
        }
    }
    let axis = |nodes: Vec<f64>, rails: &[Rail], closed: bool| match straight {
        true => BlendAxis::new(nodes, Rule::Linear),
        false => spline_axis(nodes, rails, closed, tolerance),
    };
    let u = if along_v.is_empty() { BlendAxis::new(nodes.0, Rule::Lagrange) } else { axis(nodes.0, &along_u, closed.0) };
    let v = axis(nodes.1, &along_v, closed.1);
    let blend = Blend::new(u, v, along_v, along_u);
    let mut notes = Vec::new();
    let made = Made { origin: named.origin, kind: named.kind, flow: named.flow, closed, chains: named.chains };
    (finish(blend, made, tolerance, &mut notes), notes)
}

/// Places along each curve at which a net is compared with its surface.
const COMPARED: usize = 32;

/// How a surface through a net keeps to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetCheck {
    /// Largest distance of a curve from the surface at the curve's own parameters, model units.
    pub residual: f64,
    /// Largest distance between two curves at their crossing, model units.
    pub gap: f64,
    /// Largest turn of the normal across inner curves and closed seams, kink lines left out, radians.
    pub turn: f64,
}

impl Surface {
    /// Compares a surface blended from a net with its curves at 33 places each; `None` for other surfaces.
    pub fn net_check(&self, tolerance: &Tolerance) -> Option<NetCheck> {
        let Shape::Blend(blend) = &self.parts().shape else { return None };
        let (u, v) = blend.axes();
        let mut check = NetCheck { residual: 0.0, gap: 0.0, turn: 0.0 };
        for (g, &y) in blend.along_u().iter().zip(&v.nodes) {
            for (f, &x) in blend.along_v().iter().zip(&u.nodes) {
                if !matches!((f, g), (Rail::Point(_), _) | (_, Rail::Point(_))) {
                    check.gap = check.gap.max(f.point(y).distance(g.point(x)));
                }
            }
        }
        let side = (OneSided::After, OneSided::After);
        for x in (0..=COMPARED).map(|k| k as f64 / COMPARED as f64) {
            for (rail, &y) in blend.along_u().iter().zip(&v.nodes) {
                check.residual = check.residual.max(blend.jet(x, y, side).p.distance(rail.point(x)));
            }
            for (rail, &y) in blend.along_v().iter().zip(&u.nodes) {
                check.residual = check.residual.max(blend.jet(y, x, side).p.distance(rail.point(x)));
            }
            // Off the nodes, where no curve decides.
            let inner = (x * (1.0 - NUDGE)).max(NUDGE);
            for across_u in [true, false] {
                let (axis, rails, kinks, closed) = match across_u {
                    true => (u, blend.along_u(), &self.parts().kinks.0, self.parts().closed.0),
                    false => (v, blend.along_v(), &self.parts().kinks.1, self.parts().closed.1),
                };
                let smooth = axis.nodes[1..axis.nodes.len() - 1].iter().filter(|x| kinks.iter().all(|k| (k - **x).abs() > NUDGE));
                let corner = |rail: &Rail| tolerance.is_kink(rail.jet(1.0, OneSided::Before).d1, rail.jet(0.0, OneSided::After).d1);
                let chained = || rails.iter().filter(|rail| rail.chain().is_some());
                let seam = (closed && !chained().any(corner)).then_some((1.0, 0.0));
                for (a, b) in smooth.map(|x| (*x, *x)).chain(seam) {
                    let normal = |at: f64, side: OneSided| {
                        unit_normal(&match across_u {
                            true => blend.jet(at, inner, (side, OneSided::After)),
                            false => blend.jet(inner, at, (OneSided::After, side)),
                        })
                    };
                    if let (Some(before), Some(after)) = (normal(a, OneSided::Before), normal(b, OneSided::After)) {
                        check.turn = check.turn.max(math::angle_between(before, after));
                    }
                }
            }
        }
        Some(check)
    }
}
