//! Nodes at which all curves of a family have a corner, or end a straight part.

use crate::base::tolerance::{NUDGE, Tolerance};
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::rule::Rule;
use crate::surface::shapes::spline_parts::Joins;
use crate::surface::shapes::weights::BlendAxis;

/// Splines through the curves at `nodes`: they have corners where all curves along the direction, `rails`, have one, and run by themselves where
/// all of these are straight; else C2, across the seam of a closed direction too.
pub fn spline_axis(nodes: Vec<f64>, rails: &[Rail], closed: bool, tolerance: &Tolerance) -> BlendAxis {
    let chains: Vec<&Rail> = rails.iter().filter(|rail| rail.chain().is_some()).collect();
    let joints = if chains.is_empty() { Vec::new() } else { joints(&chains, &nodes, closed, tolerance) };
    let round = closed && joints.first().is_none_or(|joint| joint.0 > 0);
    BlendAxis::with_joints(nodes, if round { Rule::Periodic } else { Rule::Spline }, joints)
}

/// Nodes at which splines are less than C2: inner ones, and the first one for a seam; poles say nothing.
fn joints(chains: &[&Rail], nodes: &[f64], closed: bool, tolerance: &Tolerance) -> Vec<(usize, Joins)> {
    let own: Vec<Vec<(f64, f64)>> = chains.iter().map(|rail| rail.kink_lines(tolerance)).collect();
    let at_seam = |rail: &&Rail| tolerance.is_kink(rail.jet(1.0, OneSided::Before).d1, rail.jet(0.0, OneSided::After).d1);
    let corner = |k: usize| match k {
        0 => chains.iter().all(at_seam),
        _ => own.iter().all(|kinks| kinks.iter().any(|(x, _)| (x - nodes[k]).abs() <= NUDGE)),
    };
    let straight: Vec<bool> = nodes.windows(2).map(|x| chains.iter().all(|rail| rail.is_straight(x[0], x[1]))).collect();
    let at = |k: usize| match (straight[(k + straight.len() - 1) % straight.len()], straight[k]) {
        _ if corner(k) => Some((k, Joins::Corner)),
        (true, false) => Some((k, Joins::Before)),
        (false, true) => Some((k, Joins::After)),
        _ => None,
    };
    (usize::from(!closed)..nodes.len() - 1).filter_map(at).collect()
}
