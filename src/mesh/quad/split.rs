//! Every cell as quads of half its size: a quad as four, a triangle as three; fewer where sides are not halved.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField, foot_spot};
use crate::mesh::quad::net::Net;

/// Quads in place of all faces; sides of borders and lines get the nodes that are given for their middles. Neighbours are
/// not noted in the finer net. `whole` has the sides of each face that are not halved, as bits, an even number of them.
pub fn split(net: &Net, whole: &[u8], chart_surface: &dyn ParametricSurface, field: &dyn SizeField) -> Net {
    let mut fine = Net { p: net.p.clone(), xy: net.xy.clone(), normal: net.normal.clone(), fixed: net.fixed, ..Net::default() };
    for n in 0..net.fixed as usize {
        job::poll();
        if fine.normal[n] == DVec3::ZERO {
            fine.normal[n] = chart_surface.spot(fine.xy[n]).normal();
        }
    }
    let mut mids = vec![[NONE; 4]; net.face.len()];
    for f in 0..net.face.len() {
        job::poll();
        let c = net.corners(f);
        for k in 0..c.len() {
            let other = net.across[f][k];
            let shared = if other == NONE { NONE } else { mids[other as usize / 4][other as usize % 4] };
            mids[f][k] = match () {
                () if whole[f] >> k & 1 == 1 => NONE,
                () if net.mid[f][k] != NONE => net.mid[f][k],
                () if shared != NONE => shared,
                () => between(&mut fine, chart_surface, &[c[k], c[(k + 1) % c.len()]]),
            };
        }
    }
    for (f, mids) in mids.iter().enumerate() {
        job::poll();
        let c = net.corners(f);
        let n = c.len();
        // The first of the sides that are not halved, the one before it halved where there are two in a row.
        let open = |k: usize| mids[k % n] == NONE;
        let first = (0..n).find(|k| open(*k) && !open(k + n - 1));
        match first {
            _ if (0..n).all(open) => fine.face.push(net.face[f]),
            None => {
                let middle = between(&mut fine, chart_surface, &mids[..n]);
                fine.face.extend((0..n).map(|k| [c[k], mids[k], middle, mids[(k + n - 1) % n]]));
            }
            Some(k) => {
                let (c, m) = (|i: usize| c[(k + i) % n], |i: usize| mids[(k + i) % n]);
                let third = (k + 2) % n;
                if n == 3 && net.locked[f] >> third & 1 == 1 {
                    // The only middle stays where it is: a side inwards from each of four corners, and a quad inside.
                    let round = [c(0), c(1), c(2), m(2)];
                    let inside = round.map(|a| between(&mut fine, chart_surface, &[a, a, c(0), c(1), c(2)]));
                    fine.face.extend((0..4).map(|i| [round[i], round[(i + 1) % 4], inside[(i + 1) % 4], inside[i]]));
                    fine.face.push(inside);
                } else if n == 3 {
                    fine.face.push([c(0), c(1), c(2), m(2)]);
                } else if open(k + 1) {
                    let middle = between(&mut fine, chart_surface, &[c(1), m(2), m(3)]);
                    fine.face.extend([[c(0), c(1), middle, m(3)], [c(1), c(2), m(2), middle], [middle, m(2), c(3), m(3)]]);
                } else {
                    fine.face.extend([[c(0), c(1), m(1), m(3)], [m(3), m(1), c(2), c(3)]]);
                }
            }
        }
    }
    fine.size = fine.xy.iter().zip(&fine.p).map(|(xy, p)| field.size(*xy, *p)).collect();
    fine
}

/// A new node at the foot of the mean of some nodes.
fn between(net: &mut Net, chart_surface: &dyn ParametricSurface, nodes: &[u32]) -> u32 {
    let n = nodes.len() as f64;
    let p = nodes.iter().map(|n| net.p[*n as usize]).sum::<DVec3>() / n;
    // A pole has many places in the chart, and none of them is in the right direction.
    let sound = || nodes.iter().filter(|n| net.normal[**n as usize] != DVec3::ZERO || **n >= net.fixed);
    let places = |all: &mut dyn Iterator<Item = &u32>| all.fold((DVec2::ZERO, 0.0), |(sum, n), k| (sum + net.xy[*k as usize], n + 1.0));
    let (sum, count) = places(&mut sound());
    let (sum, count) = if count > 0.0 { (sum, count) } else { places(&mut nodes.iter()) };
    let (xy, spot) = foot_spot(chart_surface, sum / count, p);
    net.p.push(spot.p);
    net.xy.push(xy);
    net.normal.push(spot.normal());
    net.p.len() as u32 - 1
}
