//! Fewer quads where irregular nodes face each other: the quad between two nodes is taken out and the two become one.

use std::f64::consts::FRAC_PI_2;

use crate::base::job;
use crate::mesh::chart::halves::NONE;
use crate::mesh::chart::parametric_surface::{ParametricSurface, SizeField};
use crate::mesh::quad::net::Net;
use crate::mesh::quad::settings::COLLAPSE;
use crate::mesh::quad::smooth::Smoother;

/// A quad that goes, its corner that stays and the one that becomes that, by place.
struct Collapse {
    gain: i64,
    face: usize,
    place: usize,
}

/// Takes out quads where nodes get more regular by it, no two of them beside each other; gives the nodes that are left of each.
pub fn collapse(net: &mut Net, chart_surface: &dyn ParametricSurface, field: &dyn SizeField) -> Vec<u32> {
    let mut smoother = Smoother::new(net, chart_surface, field);
    let mut all = candidates(&smoother);
    all.sort_by(|a, b| b.gain.cmp(&a.gain).then((a.face, a.place).cmp(&(b.face, b.place))));
    let mut busy = vec![false; if all.is_empty() { 0 } else { smoother.net.p.len() }];
    let mut taken: Vec<(usize, [u32; 2])> = Vec::new();
    for Collapse { face, place, .. } in all {
        job::poll();
        let c = smoother.net.face[face];
        let (stays, goes) = (c[place], c[place + 2]);
        let near: Vec<usize> = [stays, goes]
            .iter()
            .flat_map(|n| smoother.faces(*n as usize))
            .flat_map(|f| smoother.net.corners(*f as usize))
            .map(|n| *n as usize)
            .collect();
        if near.iter().any(|n| busy[*n]) || !joins(&mut smoother, face, [stays, goes]) {
            continue;
        }
        near.iter().for_each(|n| busy[*n] = true);
        taken.push((face, [stays, goes]));
    }
    take_out(net, taken)
}

/// Quads whose nodes get more regular without them.
fn candidates(smoother: &Smoother) -> Vec<Collapse> {
    let net = &*smoother.net;
    let mut found = Vec::new();
    for (face, c) in net.face.iter().enumerate() {
        job::poll();
        if c[3] == NONE || !net.locked.is_empty() && net.locked[face] != 0 {
            continue;
        }
        for place in 0..2 {
            let [a, b, o, d] = [0, 1, 2, 3].map(|k| c[(place + k) % 4] as usize);
            let fixed = net.fixed as usize;
            let valence = [a, b, o, d].map(|n| smoother.valence(n) as i64);
            if a < fixed || o < fixed || valence[0] + valence[2] > COLLAPSE.max_valences {
                continue;
            }
            let off = |n: usize, valence: i64| {
                let wanted = if n < fixed { wanted(smoother, n) } else { 4 };
                (valence - wanted) * (valence - wanted)
            };
            let before = off(a, valence[0]) + off(o, valence[2]) + off(b, valence[1]) + off(d, valence[3]);
            let after = off(a, valence[0] + valence[2] - 2) + off(b, valence[1] - 1) + off(d, valence[3] - 1);
            let thin = |n: usize, valence: i64| valence < if n < fixed { 3 } else { 4 };
            if after < before && !thin(b, valence[1]) && !thin(d, valence[3]) {
                found.push(Collapse { gain: before - after, face, place });
            }
        }
    }
    found
}

/// How many faces there should be round a node of the border.
fn wanted(smoother: &Smoother, node: usize) -> i64 {
    (smoother.angle_round(node) / FRAC_PI_2).round().max(1.0) as i64
}

/// Moves the node that stays to where both can be one; whether the faces round them stay good enough.
fn joins(smoother: &mut Smoother, face: usize, [stays, goes]: [u32; 2]) -> bool {
    let (one, other) = (stays as usize, goes as usize);
    let round: Vec<u32> = [one, other].iter().flat_map(|n| smoother.faces(*n)).copied().filter(|f| *f as usize != face).collect();
    let least = smoother.least();
    let before = least(smoother.net, &round).min(smoother.quality(face)).min(COLLAPSE.min_quality);
    let (start, end) = (smoother.place(one), smoother.place(other));
    let both = smoother.foot(one, 0.5 * (start.p + end.p));
    smoother.put(one, both);
    smoother.put(other, both);
    let good = least(smoother.net, &round) >= before;
    if !good {
        smoother.put(one, start);
        smoother.put(other, end);
    }
    good
}

/// Takes out quads with the second of two nodes each, which becomes the first.
fn take_out(net: &mut Net, mut taken: Vec<(usize, [u32; 2])>) -> Vec<u32> {
    if taken.is_empty() {
        return Vec::new();
    }
    let mut of: Vec<u32> = (0..net.p.len() as u32).collect();
    taken.iter().for_each(|(_, [stays, goes])| of[*goes as usize] = *stays);
    // Higher faces first: the last one gets the number of the one that goes.
    taken.sort_by_key(|taken| std::cmp::Reverse(taken.0));
    for (face, _) in &taken {
        if !net.across.is_empty() {
            let (c, [stays, goes]) = (net.face[*face], taken.iter().find(|t| t.0 == *face).map_or([NONE; 2], |t| t.1));
            let k = c.iter().position(|n| *n == stays).unwrap_or(0);
            debug_assert_eq!(c[(k + 2) % 4], goes);
            for (x, y) in [(k, (k + 1) % 4), ((k + 2) % 4, (k + 3) % 4)] {
                let (x, y) = (net.across[*face][x], net.across[*face][y]);
                net.across[x as usize / 4][x as usize % 4] = y;
                net.across[y as usize / 4][y as usize % 4] = x;
            }
        }
        net.remove(*face);
    }
    net.face.iter_mut().flatten().filter(|n| **n != NONE).for_each(|n| *n = of[*n as usize]);
    let number = net.keep_nodes(|n| of[n] as usize == n);
    taken.iter().map(|t| number[t.1[0] as usize]).collect()
}
