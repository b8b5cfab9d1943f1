//! Gordon surfaces: cubic splines through both families of a complete net [Gordon 1969; math notes §10.4].
//!
//! ```text
//! U = P_u F + P_v F − P_u P_v F,   P_u F = Σ a_i(u) F(u_i, v),   P_v F = Σ b_j(v) F(u, v_j)
//! ```
//!
//! a and b are the cardinal functions of C2 cubic splines (`cardinal.rs`), the same in all three parts, so the surface
//! contains every curve to rounding. It is evaluated as this sum: nothing is fitted. Given end slopes would change
//! nothing but a and b: fields of end slopes that come from the net itself, spread by the same splines, cancel between
//! the parts. So the ends are "not a knot", which reproduces cubics, and closed directions are periodic.
//!
//! The error for a net of lines of a surface F is (I − P_u)(I − P_v) F: zero where F is a cubic in one direction, and of
//! the eighth order in the distances of the curves else.

use super::blend::Blend;
use super::coons::{Made, finish};
use super::core::{Surface, SurfaceKind};
use super::rail::Rail;
use super::weights::{Axis, Rule};
use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;

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
    let CurveNet { mut along_u, mut along_v, nodes, closed } = net;
    for (rails, closed) in [(&mut along_u, closed.1), (&mut along_v, closed.0)] {
        if closed && let Some(first) = rails.first().cloned() {
            rails.push(first);
        }
    }
    let rule = |closed: bool| if closed { Rule::Periodic } else { Rule::Spline };
    let u = Axis::new(nodes.0, if along_v.is_empty() { Rule::Lagrange } else { rule(closed.0) });
    let blend = Blend::new(u, Axis::new(nodes.1, rule(closed.1)), along_v, along_u);
    let mut notes = Vec::new();
    let made = Made { origin: named.origin, kind: named.kind, flow: named.flow, closed, chains: named.chains };
    (finish(blend, made, tolerance, &mut notes), notes)
}
