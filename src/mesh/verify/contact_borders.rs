//! Contacts of the borders of faces with other faces: edges on faces, and edges through faces.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::par;
use crate::mesh::border::touch::Kind;
use crate::mesh::verify::contact_edges::{EdgeFace, meetings};
use crate::mesh::verify::contacts::ContactSearch;

/// A segment of an edge with those of its nodes that lie on a face, by their places along it.
struct SegmentOnFace {
    segment: usize,
    face: usize,
    nodes: Vec<usize>,
}

impl ContactSearch<'_> {
    /// Edges on faces, and edges through faces.
    pub(crate) fn borders(&mut self) {
        let scan = self.scan;
        let used: Vec<bool> = {
            let mut used = vec![false; scan.along.len()];
            scan.layout.faces.iter().flat_map(|f| f.sides.iter().flat_map(|s| &s.uses)).for_each(|u| used[u.segment] = true);
            used
        };
        let segments: Vec<usize> = (0..used.len()).filter(|k| used[*k]).collect();
        let near = par::map(segments.len(), |n| scan.beside(segments[n]));
        let tasks = near.iter().zip(&segments).flat_map(|(b, k)| b.near.iter().map(|face| EdgeFace { segment: *k, face: *face }));
        let tasks: Vec<EdgeFace> = tasks.collect();
        let met = meetings(scan, &tasks);
        let exact: BTreeMap<EdgeFace, usize> = tasks.iter().enumerate().filter(|(n, _)| met[*n].is_some()).map(|(n, t)| (*t, n)).collect();
        for (n, found) in near.into_iter().enumerate() {
            let segment = segments[n];
            for face in found.near {
                if let Some(met) = exact.get(&EdgeFace { segment, face }).and_then(|n| met[*n].as_ref()) {
                    met.runs.iter().for_each(|run| self.runs_along(segment, face, run.0, run.1));
                    for (at, inside) in &met.points {
                        let (ends, slow) = met.known;
                        let leaves = ends.into_iter().flatten().any(|p| p.distance(*at) <= slow && self.on(face, p.midpoint(*at)));
                        if !leaves && self.on(face, *at) {
                            let kind = if *inside { Kind::Crossing } else { Kind::Edge };
                            self.add(scan.owner(segment), face, kind, 0.0, *at);
                        }
                    }
                }
            }
            // Edges that no curve carries are known by their nodes.
            for (face, candidates) in found.touched {
                if exact.contains_key(&EdgeFace { segment, face }) {
                    continue;
                }
                let nodes = candidates.into_iter().filter(|k| self.on(face, scan.p(scan.along[segment][*k]))).collect();
                self.lies_on(&SegmentOnFace { segment, face, nodes });
            }
            for (face, at) in found.pierced {
                if !exact.contains_key(&EdgeFace { segment, face }) {
                    self.crosses(scan.owner(segment), face, at);
                }
            }
        }
    }

    /// Adds a run of an edge on a face: its middle and its length.
    fn runs_along(&mut self, segment: usize, face: usize, at: DVec3, length: f64) {
        /// First distance of a probe beside the run, as a share of its length, and ratio of the next distance to the last one.
        const PROBE_DISTANCE: (f64, f64) = (0.05, 0.125);
        /// Distance from the run within which faces that only touch along it part, in roots of tolerance times length.
        const TANGENT_REACH: f64 = 8.0;
        let scan = self.scan;
        if !self.on(face, at) {
            return;
        }
        let nearest = TANGENT_REACH * (scan.input.tolerance.point * length).sqrt();
        for owner in scan.owners(segment) {
            let mut by = PROBE_DISTANCE.0 * length;
            loop {
                let inside = scan.leaves[owner].inwards(scan.mesh, at, by);
                if let Some(p) = inside.map(|p| self.foot(owner, p).point)
                    && p.distance(at) > scan.input.tolerance.point
                    && self.on(face, p)
                {
                    return self.add(owner, face, Kind::Overlap, length, at);
                }
                by *= PROBE_DISTANCE.1;
                if by < nearest {
                    break;
                }
            }
        }
        self.add(scan.owner(segment), face, Kind::Edge, length, at);
    }

    /// Adds an edge on a face by its nodes.
    fn lies_on(&mut self, found: &SegmentOnFace) {
        let scan = self.scan;
        let Some(&middle) = found.nodes.get(found.nodes.len() / 2) else { return };
        let along = &scan.along[found.segment];
        let on = |k: usize| {
            found.nodes.binary_search(&k).is_ok() || scan.users.get(along[k] as usize).is_some_and(|u| u.contains(&(found.face as u32)))
        };
        let steps = (1..along.len()).filter(|k| on(k - 1) && on(*k));
        let length: f64 = steps.map(|k| scan.p(along[k - 1]).distance(scan.p(along[k]))).sum();
        let owner = scan.owner(found.segment);
        let at = scan.p(along[middle]);
        // Beside an edge that only touches, its own face leaves the other one.
        let beside = scan.leaves[owner].beside(scan.mesh, along[middle]);
        let kind = match beside.map(|p| self.foot(owner, p).point) {
            Some(p) if self.on(found.face, p) => Kind::Overlap,
            _ => Kind::Edge,
        };
        self.add(owner, found.face, kind, length, at);
    }
}
