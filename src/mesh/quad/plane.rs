//! Nets of plane faces: their chart is the plane itself, so qualities and means are taken there.

use glam::DVec2;

use crate::mesh::chart::halves::NONE;
use crate::mesh::quad::net::Net;

/// The sine of 60°.
const SIXTY: f64 = 0.866_025_403_784_438_6;

/// Corners of a face in the plane, the last one of a triangle twice, and how many there are.
fn corners(net: &Net, f: usize) -> ([DVec2; 4], usize) {
    let c = net.face[f];
    let (last, n) = if c[3] == NONE { (c[2], 3) } else { (c[3], 4) };
    ([c[0], c[1], c[2], last].map(|n| net.xy[n as usize]), n)
}

/// Quality of a face: the least sine of its corners, of a triangle over that of an equilateral one.
pub fn quality(net: &Net, f: usize) -> f64 {
    let (p, n) = corners(net, f);
    if n == 3 {
        let unit = [p[1] - p[0], p[2] - p[1], p[0] - p[2]].map(DVec2::normalize_or_zero);
        let sine = |k: usize| unit[(k + 2) % 3].perp_dot(unit[k]);
        return sine(0).min(sine(1)).min(sine(2)) / SIXTY;
    }
    least_sine(p)
}

/// The least sine of the corners of a quad in the plane.
pub fn least_sine(p: [DVec2; 4]) -> f64 {
    let unit = [p[1] - p[0], p[2] - p[1], p[3] - p[2], p[0] - p[3]].map(DVec2::normalize_or_zero);
    let sine = |k: usize| unit[(k + 3) % 4].perp_dot(unit[k]);
    sine(0).min(sine(1)).min(sine(2)).min(sine(3))
}

/// The least quality of some faces.
pub fn least_quality(net: &Net, faces: &[u32]) -> f64 {
    faces.iter().map(|f| quality(net, *f as usize)).fold(f64::INFINITY, f64::min)
}

/// Whether some faces have at least a positive quality each, without roots for quads.
pub fn reach(net: &Net, faces: &[u32], least: f64) -> bool {
    faces.iter().all(|f| {
        let (p, n) = corners(net, *f as usize);
        if n == 3 {
            return quality(net, *f as usize) >= least;
        }
        let side = [p[1] - p[0], p[2] - p[1], p[3] - p[2], p[0] - p[3]];
        let square = side.map(DVec2::length_squared);
        (0..4).all(|k| {
            let sine = side[(k + 3) % 4].perp_dot(side[k]);
            sine > 0.0 && sine * sine >= least * least * square[(k + 3) % 4] * square[k]
        })
    })
}

/// The area-weighted mean of the centroids of faces round a node, weighted by `share` of each; `None` where they have no area.
pub fn centre(net: &Net, node: usize, faces: &[u32], share: &dyn Fn(usize) -> f64, even: bool) -> Option<DVec2> {
    let here = net.xy[node];
    let (mut sum, mut weights) = (DVec2::ZERO, 0.0);
    for f in faces {
        let c = net.face[*f as usize];
        let n = if c[3] == NONE { 3 } else { 4 };
        let k = c.iter().position(|c| *c as usize == node)?;
        let at = |i: usize| net.xy[c[if k + i >= n { k + i - n } else { k + i }] as usize] - here;
        let share = if even { 1.0 } else { share(*f as usize) };
        let mut a = at(1);
        for i in 2..n {
            let b = at(i);
            let weight = a.perp_dot(b).abs() * share;
            sum += (a + b) * weight;
            weights += weight;
            a = b;
        }
    }
    (weights > 0.0).then(|| here + sum / (3.0 * weights))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::quad::net::{least_quality as in_space, least_sine as sine_in_space};
    use crate::mesh::quad::net_check::tests::{Random, net_of, random_pairs, sheet};

    #[test]
    fn the_same_as_in_space() {
        let mut random = Random(7);
        let (triangulation, normal, halves) = sheet(9, 0.0, &mut random);
        let mate = random_pairs(&triangulation, 90, &mut random);
        let net = net_of(&triangulation, &mate, &normal, &halves);
        for f in 0..net.face.len() {
            assert!((quality(&net, f) - net.quality(f)).abs() < 1e-12, "{f}");
            let here = [f as u32];
            for least in [0.3, 0.6, 0.9] {
                assert_eq!(reach(&net, &here, least), in_space(&net, &here) >= least, "{f}");
            }
        }
        let kite = [DVec2::ZERO, DVec2::new(2.0, 0.5), DVec2::new(1.5, 2.0), DVec2::new(0.0, 1.0)];
        let space = sine_in_space(kite.map(|p| p.extend(0.0)), [glam::DVec3::Z; 4]);
        assert!((least_sine(kite) - space).abs() < 1e-12);
    }
}
