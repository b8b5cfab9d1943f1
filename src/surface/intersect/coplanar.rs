//! Whether faces in one plane overlap.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::range::Interval3;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::network::{Chain, meet as meet_chains};
use crate::surface::closest::nearest::Nearest;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::intersect::sheet::grounded;
use crate::surface::rails::side::Side;

/// What faces in one plane have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coplanar {
    /// They are not known to lie in one plane, or not all of their borders are curves.
    Unknown,
    /// Nothing but single points.
    Apart,
    /// A border or more: a place of it.
    Overlap(DVec3),
}

/// Whether two faces overlap.
///
/// What overlaps has a piece of a border of one face in the other, or all of one; between the crossings of the borders a piece is
/// in or out as a whole.
pub(crate) fn overlap(a: &Surface, b: &Surface, tolerance: &Tolerance) -> Result<Coplanar> {
    let (Some(own), Some(other)) = (borders(a), borders(b)) else { return Ok(Coplanar::Unknown) };
    if !(is_flat(a) && is_flat(b) && lies_in(a, b, tolerance) && lies_in(b, a, tolerance)) {
        return Ok(Coplanar::Unknown);
    }
    for (ones, face, others) in [(&own, b, &other), (&other, a, &own)] {
        let below = Nearest::new(&face.untrimmed());
        for chain in ones {
            let near = tolerance.point / chain.length();
            let mut stops = vec![0.0, 1.0];
            for border in others {
                for met in meet_chains(chain, border, tolerance)? {
                    stops.push(met.fa);
                    stops.extend(met.overlap_end.map(|(fa, _)| fa));
                }
            }
            stops.sort_by(f64::total_cmp);
            for w in stops.windows(2).filter(|w| w[1] - w[0] > near) {
                let p = chain.point(0.5 * (w[0] + w[1]));
                let foot = below.at(p);
                if foot.distance <= tolerance.point && face.keeps_point(p, DVec2::from(foot.uv), tolerance.point) {
                    return Ok(Coplanar::Overlap(p));
                }
            }
        }
    }
    Ok(Coplanar::Apart)
}

/// The curves around a face.
fn borders(face: &Surface) -> Option<Vec<Chain>> {
    let border = |k: usize| match face.side(k) {
        Side::Chain { chain, from, to } if (from, to) == (0.0, 1.0) || (from, to) == (1.0, 0.0) => Some(chain),
        _ => None,
    };
    let all: Option<Vec<Chain>> = (0..face.n_sides()).map(border).collect();
    all.filter(|all| !all.is_empty())
}

/// Whether its tangents are the same everywhere.
pub(crate) fn is_flat(face: &Surface) -> bool {
    if face.is_flat() {
        return true;
    }
    let ends = [(0.0, 0.0), (1.0, 1.0)].map(|(u, v)| face.jet(u, v));
    let alike = |a: DVec3, b: DVec3| a.distance(b) <= PARALLEL * (a.length() + b.length());
    if !alike(ends[0].du, ends[1].du) || !alike(ends[0].dv, ends[1].dv) {
        return false;
    }
    let enclosure = face.untrimmed().enclosure((0.0, 1.0), (0.0, 1.0));
    let even = |r: &Interval3| !r.is_unbounded() && r.low == r.high;
    matches!(face.ground(), Domain::Square) && even(&enclosure.du) && even(&enclosure.dv)
}

/// Whether the corners of a flat face's ground, and with them all of it, lie in the plane of another flat one.
fn lies_in(face: &Surface, plane: &Surface, tolerance: &Tolerance) -> bool {
    let jet = ground(plane).jet(0.5, 0.5);
    let normal = jet.du.cross(jet.dv).normalize_or_zero();
    let own = ground(face);
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    normal != DVec3::ZERO && corners.iter().all(|(u, v)| (own.point(*u, *v) - jet.p).dot(normal).abs() <= tolerance.point)
}

/// A flat face without its borders, over a square.
fn ground(face: &Surface) -> Surface {
    grounded(face, face.hull())
}
