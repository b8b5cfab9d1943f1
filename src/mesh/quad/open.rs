//! More quads where sides stay too long: a node at the end of such a side is opened into two, with a quad between them.

use glam::DVec3;

use crate::base::job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, foot_spot};
use crate::mesh::quad::equalize::Sides;
use crate::mesh::quad::net::Net;
use crate::mesh::quad::settings::OPENING;
use crate::mesh::quad::smooth::Smoother;

/// A node to be opened: the end of its long side, and the two nodes that get the quad's other corners.
struct Opening {
    over: f64,
    node: usize,
    towards: usize,
    hinges: [usize; 2],
}

/// Opens nodes at sides that are longer than allowed, no two of them beside each other; gives the nodes of the new quads.
pub fn open(net: &mut Net, chart_surface: &dyn ParametricSurface, field: &dyn SizeField, sides: &Sides) -> Vec<u32> {
    let mut all = openings(net, chart_surface, field, sides);
    all.sort_by(|a, b| b.over.total_cmp(&a.over).then((a.node, a.towards).cmp(&(b.node, b.towards))));
    let mut faces_of: Vec<Vec<u32>> = vec![Vec::new(); if all.is_empty() { 0 } else { net.p.len() }];
    if !all.is_empty() {
        net.face.iter().enumerate().for_each(|(f, c)| c.iter().filter(|n| **n != NONE).for_each(|n| faces_of[*n as usize].push(f as u32)));
    }
    let (mut busy, mut opened) = (vec![false; net.p.len()], Vec::new());
    for Opening { node, towards, hinges, .. } in all {
        job::poll();
        let near: Vec<usize> =
            faces_of[node].iter().flat_map(|f| net.face[*f as usize]).filter(|n| *n != NONE).map(|n| n as usize).collect();
        if near.iter().any(|n| busy.get(*n).is_none_or(|busy| *busy)) {
            continue;
        }
        near.iter().for_each(|n| busy[*n] = true);
        let new = net.p.len() as u32;
        let step = (net.p[towards] - net.p[node]) * OPENING.node_distance;
        let place = |by: DVec3| foot_spot(chart_surface, net.xy[node], net.p[node] + by);
        let (here, there) = (place(step), place(-step));
        net.p.push(there.1.p);
        net.xy.push(there.0);
        net.normal.push(there.1.normal());
        net.size.push(field.size(there.0, there.1.p));
        (net.xy[node], net.p[node], net.normal[node]) = (here.0, here.1.p, here.1.normal());
        // The faces at the long side keep the node, the others get the new one.
        for f in &faces_of[node] {
            let face = &mut net.face[*f as usize];
            if !face.contains(&(towards as u32)) {
                face.iter_mut().filter(|n| **n as usize == node).for_each(|n| *n = new);
            }
        }
        let quad = [hinges[0] as u32, new, hinges[1] as u32, node as u32];
        net.face.push(quad);
        opened.extend(quad);
    }
    opened
}

/// The possible openings, at either end of each side that is too long.
fn openings(net: &mut Net, chart_surface: &dyn ParametricSurface, field: &dyn SizeField, sides: &Sides) -> Vec<Opening> {
    let smoother = Smoother::new(net, chart_surface, field);
    let net = &*smoother.net;
    let mut found = Vec::new();
    for c in &net.face {
        for k in 0..4 {
            let (a, b) = (c[k] as usize, c[(k + 1) % 4] as usize);
            if c[3] == NONE || a > b || a < net.fixed as usize && b < net.fixed as usize {
                continue;
            }
            let long = if net.p[a].distance_squared(net.p[b]) <= sides.always * sides.always { 0.0 } else { (sides.over)(net, a, b) };
            if long <= 1.0 {
                continue;
            }
            let ways = [(a, b), (b, a)].into_iter().filter_map(|(node, towards)| opening(&smoother, node, towards));
            if let Some((_, node, towards, hinges)) = ways.min_by_key(|w| (w.0, w.1)) {
                found.push(Opening { over: long, node, towards, hinges });
            }
        }
    }
    found
}

/// The cost of opening a node along a side in irregular nodes, and its hinges; `None` where it is not allowed.
fn opening(smoother: &Smoother, node: usize, towards: usize) -> Option<(i64, usize, usize, [usize; 2])> {
    let net = &*smoother.net;
    let valence = smoother.valence(node) as i64;
    if node < net.fixed as usize || valence < 4 {
        return None;
    }
    let mut hinges = [NONE; 2];
    for f in smoother.faces(node) {
        let c = net.face[*f as usize];
        if c[3] == NONE || net.quality(*f as usize) < OPENING.min_quality {
            return None;
        }
        let k = c.iter().position(|n| *n as usize == node)?;
        // On the left of the side towards the node and on its right.
        if c[(k + 1) % 4] as usize == towards {
            hinges[0] = c[(k + 3) % 4];
        } else if c[(k + 3) % 4] as usize == towards {
            hinges[1] = c[(k + 1) % 4];
        }
    }
    let hinges = hinges.map(|n| n as usize);
    if hinges.iter().any(|n| *n >= net.p.len() || *n < net.fixed as usize && !has_room(smoother, *n)) || hinges[0] == hinges[1] {
        return None;
    }
    let odd = |n: i64| (n - 4) * (n - 4);
    let inner = |n: &&usize| **n >= net.fixed as usize;
    let more: i64 = hinges.iter().filter(inner).map(|n| smoother.valence(*n) as i64).map(|n| odd(n + 1) - odd(n)).sum();
    Some((more + odd(3) + odd(valence - 1) - odd(valence), node, towards, hinges))
}

/// Whether the angle at a border node has room for one more quad.
fn has_room(smoother: &Smoother, node: usize) -> bool {
    smoother.angle_round(node) / (smoother.valence(node) + 1) as f64 > OPENING.min_border_angle
}
