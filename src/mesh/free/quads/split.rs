//! Every cell as quads of half its size: a quad as four, a triangle as three.

use glam::{DVec2, DVec3};

use super::net::{NONE, Net};
use crate::mesh::free::ground::{Field, Ground, foot_spot};

/// Quads in place of all faces; sides of borders and lines get the nodes that are given for their middles. Neighbours are
/// not noted in the finer net.
pub fn split(net: &Net, ground: &dyn Ground, field: &dyn Field) -> Net {
    let mut fine = Net { p: net.p.clone(), xy: net.xy.clone(), normal: net.normal.clone(), fixed: net.fixed, ..Net::default() };
    for n in 0..net.fixed as usize {
        if fine.normal[n] == DVec3::ZERO {
            fine.normal[n] = ground.spot(fine.xy[n]).normal();
        }
    }
    let mut mids = vec![[NONE; 4]; net.face.len()];
    for f in 0..net.face.len() {
        let c = net.corners(f);
        for k in 0..c.len() {
            let other = net.across[f][k];
            let made = if other == NONE { NONE } else { mids[other as usize / 4][other as usize % 4] };
            mids[f][k] = match () {
                () if net.mid[f][k] != NONE => net.mid[f][k],
                () if made != NONE => made,
                () => between(&mut fine, ground, &[c[k], c[(k + 1) % c.len()]]),
            };
        }
    }
    for (f, mids) in mids.iter().enumerate() {
        let c = net.corners(f);
        let n = c.len();
        let middle = between(&mut fine, ground, &mids[..n]);
        fine.face.extend((0..n).map(|k| [c[k], mids[k], middle, mids[(k + n - 1) % n]]));
    }
    fine.size = fine.xy.iter().zip(&fine.p).map(|(xy, p)| field.size(*xy, *p)).collect();
    fine
}

/// A new node at the foot of the mean of some nodes.
fn between(net: &mut Net, ground: &dyn Ground, nodes: &[u32]) -> u32 {
    let n = nodes.len() as f64;
    let p = nodes.iter().map(|n| net.p[*n as usize]).sum::<DVec3>() / n;
    // A pole has many places in the chart, and none of them is in the right direction.
    let sound = || nodes.iter().filter(|n| net.normal[**n as usize] != DVec3::ZERO || **n >= net.fixed);
    let places = |all: &mut dyn Iterator<Item = &u32>| all.fold((DVec2::ZERO, 0.0), |(sum, n), k| (sum + net.xy[*k as usize], n + 1.0));
    let (sum, count) = places(&mut sound());
    let (sum, count) = if count > 0.0 { (sum, count) } else { places(&mut nodes.iter()) };
    let (xy, spot) = foot_spot(ground, sum / count, p);
    net.p.push(spot.p);
    net.xy.push(xy);
    net.normal.push(spot.normal());
    net.p.len() as u32 - 1
}
