//! Where edges of a mesh meet faces that do not have them: by the curves and surfaces themselves, wherever the nodes are.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::par;
use crate::mesh::verify::contact_scan::Scan;
use crate::model::SurfaceId;
use crate::network::Chain;
use crate::surface::intersect::with_curve::{CurveSearch, SurfaceMeeting};
use crate::surface::{Surface, with_loops};

/// A segment of an edge and a face near it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeFace {
    pub segment: usize,
    pub face: usize,
}

/// Where a segment of an edge meets a face.
#[derive(Clone, Debug, Default)]
pub(crate) struct Met {
    /// Runs on it: middle and length, model units.
    pub runs: Vec<(DVec3, f64)>,
    /// Points, with `true` where the segment goes on beyond.
    pub points: Vec<(DVec3, bool)>,
    /// The ends of the segment that the face has, and how far from one of them it may leave the face slowly.
    pub known: ([Option<DVec3>; 2], f64),
}

/// A segment as a part of an edge.
#[derive(Clone, Copy)]
struct SegmentPlace {
    /// The edge by its number in the layout.
    edge: usize,
    /// Arc lengths on it.
    s: (f64, f64),
}

/// The meetings of each task; `None` where no curve carries the edge or they could not be found.
pub(crate) fn meetings(scan: &Scan, tasks: &[EdgeFace]) -> Vec<Option<Met>> {
    let pieces = &scan.layout.pieces;
    let wanted: BTreeSet<usize> = tasks.iter().map(|t| t.segment).collect();
    let mut places: BTreeMap<usize, SegmentPlace> = BTreeMap::new();
    for edge in 0..scan.layout.edges.len() {
        for u in pieces.of_track[edge].iter().filter(|u| wanted.contains(&u.segment)) {
            places.entry(u.segment).or_insert(SegmentPlace { edge, s: u.s });
        }
    }
    let edges: BTreeSet<usize> = places.values().map(|p| p.edge).collect();
    let edges: Vec<usize> = edges.into_iter().collect();
    let (model, tolerance) = (&scan.input.model, scan.input.tolerance);
    let ways = par::map(edges.len(), |n| model.edge_chain(scan.layout.edges[edges[n]], scan.input.network, tolerance).ok().flatten());
    let ways: BTreeMap<usize, Chain> = edges.into_iter().zip(ways).filter_map(|(edge, way)| Some((edge, way?))).collect();
    let surfaces: BTreeSet<SurfaceId> = tasks.iter().map(|t| scan.surface_of(t.face)).collect();
    let surfaces: Vec<SurfaceId> = surfaces.into_iter().collect();
    let bordered = par::map(surfaces.len(), |n| with_loops(&model.surfaces[surfaces[n].index()].surface, tolerance).ok());
    let surfaces: BTreeMap<SurfaceId, Surface> = surfaces.into_iter().zip(bordered).filter_map(|(id, s)| Some((id, s?))).collect();
    // An edge meets a surface once, whatever the segments of the one and the faces of the other.
    let pair = |task: &EdgeFace| Some((places.get(&task.segment)?.edge, scan.surface_of(task.face)));
    let pairs: BTreeSet<(usize, SurfaceId)> = tasks.iter().filter_map(pair).collect();
    let surfaces: Vec<(SurfaceId, Surface)> = surfaces.into_iter().collect();
    let on_one = |n: usize| {
        let (id, surface) = &surfaces[n];
        let Ok(mut search) = CurveSearch::new(surface, tolerance) else { return Vec::new() };
        let edges = pairs.iter().filter(|pair| pair.1 == *id);
        edges.filter_map(|pair| Some((*pair, search.with_curve(ways.get(&pair.0)?).ok()?))).collect()
    };
    let found: BTreeMap<(usize, SurfaceId), Vec<SurfaceMeeting>> = par::map(surfaces.len(), on_one).into_iter().flatten().collect();
    let of = |task: &EdgeFace| {
        let place = places.get(&task.segment)?;
        let way = ways.get(&place.edge)?;
        Some(on_segment(scan, *task, *place, way, found.get(&(place.edge, scan.surface_of(task.face)))?))
    };
    tasks.iter().map(of).collect()
}

/// The meetings of an edge on one of its segments, off the nodes that the face has itself.
fn on_segment(scan: &Scan, task: EdgeFace, place: SegmentPlace, way: &Chain, found: &[SurfaceMeeting]) -> Met {
    /// Largest distance from their ends at which glued borders may cross, over the distance between them.
    const GLUED_REACH: f64 = 4.0;
    /// Length along which an edge that touches a face at its end is within the tolerance of it, in roots of tolerance times length.
    const TANGENT_REACH: f64 = 8.0;
    let SegmentPlace { edge, s: (first, last) } = place;
    let along = &scan.along[task.segment];
    let near = GLUED_REACH * scan.layout.faces[task.face].near.max(scan.input.tolerance.point);
    let track = &scan.layout.parts[edge].track;
    let (start, length) = (track.point(0.0), way.length());
    let against = way.start().distance(start) > way.end().distance(start);
    let s = |f: f64| if against { (1.0 - f) * length } else { f * length };
    let known = [along[0], along[along.len() - 1]].map(|n| scan.has(n, task.face).then(|| scan.p(n)));
    let is_known = |p: DVec3| known.iter().flatten().any(|k| k.distance(p) <= near);
    let slow = TANGENT_REACH * (scan.input.tolerance.point * length).sqrt();
    let mut met = Met { known: (known, slow), ..Met::default() };
    for m in found {
        let here = s(m.f);
        match m.overlap_end.map(s) {
            Some(there) => {
                let (low, high) = (here.min(there).max(first), here.max(there).min(last));
                if high - low > near {
                    met.runs.push((track.point(0.5 * (low + high)), high - low));
                }
            }
            None if here < first - near || here > last + near || is_known(m.point) => {}
            None => met.points.push((m.point, here > first + near && here < last - near)),
        }
    }
    met
}
