//! Numbers of nodes and links: in the order of curves as given, then along curves.

use super::assemble::Stations;
use super::graph::{CurveId, Link, LinkId, NetCurve, Node, NodeId};
use super::shared;
use crate::base::fault::Fault;

/// Not numbered yet.
const NONE: u32 = u32::MAX;

/// Numbers nodes and links; writes the runs and stations of curves into them and returns the notes about shared runs.
pub fn number(curves: &mut [NetCurve], stations: Stations, shared: shared::Shared) -> (Vec<Node>, Vec<Link>, Vec<Fault>) {
    let mut number_of = vec![NONE; stations.points.len()];
    let mut nodes: Vec<Node> = Vec::with_capacity(stations.points.len());
    let (mut own, mut at) = (Vec::new(), Vec::new());
    for (k, net) in curves.iter_mut().enumerate() {
        own.clear();
        at.clear();
        for station in stations.rows.row(k) {
            let number = &mut number_of[station.node as usize];
            if *number == NONE {
                *number = nodes.len() as u32;
                nodes.push(Node { point: stations.points[station.node as usize] });
            }
            own.push(NodeId(*number));
            at.push(station.s);
        }
        if stations.closed[k] {
            // Back to the first node, one turn on.
            own.push(own[0]);
            at.push(at[0] + net.curve.length());
        }
        (net.nodes, net.stations) = (own.as_slice().into(), at.as_slice().into());
    }
    drop((stations, number_of));
    let links = links(curves, &shared);
    (nodes, links, shared.notes)
}

fn links(curves: &mut [NetCurve], shared: &shared::Shared) -> Vec<Link> {
    let mut links: Vec<Link> = Vec::with_capacity(curves.iter().map(|net| net.nodes.len() - 1).sum());
    let mut run = Vec::new();
    for (k, net) in curves.iter_mut().enumerate() {
        run.clear();
        for i in 0..net.nodes.len() - 1 {
            if shared.owner(k, i) != (k, i) {
                run.push((LinkId(NONE), false));
                continue;
            }
            run.push((LinkId::at(links.len()), false));
            links.push(Link { curve: CurveId::at(k), s: (net.stations[i], net.stations[i + 1]), nodes: (net.nodes[i], net.nodes[i + 1]) });
        }
        net.links = run.as_slice().into();
    }
    if shared.is_empty() {
        return links;
    }
    // What others own has its number only now.
    for k in 0..curves.len() {
        for i in 0..curves[k].links.len() {
            let (owner, j) = shared.owner(k, i);
            if (owner, j) != (k, i) {
                curves[k].links[i] = (curves[owner].links[j].0, runs_against(curves, (k, i), (owner, j)));
            }
        }
    }
    links
}

/// Whether a segment of one curve runs against the segment of another that it shares.
fn runs_against(curves: &[NetCurve], (k, i): (usize, usize), (owner, j): (usize, usize)) -> bool {
    let (net, other) = (&curves[k], &curves[owner]);
    let (own, theirs) = ((net.nodes[i], net.nodes[i + 1]), (other.nodes[j], other.nodes[j + 1]));
    if own.0 != own.1 {
        return own != theirs;
    }
    // A shared loop: the first quarter decides.
    let at = |net: &NetCurve, i: usize, x: f64| {
        let s = net.stations[i] + (net.stations[i + 1] - net.stations[i]) * x;
        let length = net.curve.length();
        net.curve.point(net.curve.param_at_length(if s > length { s - length } else { s }))
    };
    let quarter = at(net, i, 0.25);
    quarter.distance_squared(at(other, j, 0.75)) < quarter.distance_squared(at(other, j, 0.25))
}
