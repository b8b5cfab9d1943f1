//! Segments along borders, chains and what rules apply to.

use crate::mesh::border::beside;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::tracks::oriented;
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::Target;
use crate::model::EdgePart;
use crate::model::segments::SegmentUse;
use crate::network::Chain;

impl Layout {
    /// Segments of a border in its direction, `s` from its start; those of edges that are in the mesh.
    pub fn along_course(&self, course: &[EdgePart]) -> Vec<SegmentUse> {
        let (mut uses, mut start) = (Vec::new(), 0.0);
        for part in course {
            let (from, to) = part.s;
            if let Ok(track) = self.edges.binary_search(&part.edge) {
                let inside = |u: &&SegmentUse| 0.5 * (u.s.0 + u.s.1) > from && 0.5 * (u.s.0 + u.s.1) < to;
                let own = self.pieces.of_track[track].iter().filter(inside);
                let own: Vec<SegmentUse> = own.map(|u| SegmentUse { s: (u.s.0 - from, u.s.1 - from), ..*u }).collect();
                uses.extend(oriented(&own, part.against, to - from, start));
            }
            start += to - from;
        }
        uses
    }

    /// Segments of a chain in its direction, `s` from its start: those of links that are in the mesh, and those of borders
    /// that run along it without being links of it.
    pub fn along(&self, input: &Input, chain: &Chain) -> Vec<SegmentUse> {
        let mut uses = self.along_links(input, chain);
        let covered: f64 = uses.iter().map(|u| u.s.1 - u.s.0).sum();
        if covered < chain.length() - input.tolerance.point {
            let known: Vec<usize> = uses.iter().map(|u| u.segment).collect();
            uses.extend(beside::lying_on(input, self, chain).into_iter().filter(|u| !known.contains(&u.segment)));
            uses.sort_by(|a, b| a.s.0.total_cmp(&b.s.0).then(a.segment.cmp(&b.segment)));
        }
        uses
    }

    /// Segments of the links of a chain.
    fn along_links(&self, input: &Input, chain: &Chain) -> Vec<SegmentUse> {
        let Some(links) = input.network.links_of(chain, input.tolerance) else {
            return Vec::new();
        };
        let (mut uses, mut start) = (Vec::new(), 0.0);
        for (link, against) in links {
            let s = input.network.links[link.index()].s;
            if let Ok(at) = self.of_link.binary_search_by_key(&link, |l| l.0) {
                uses.extend(oriented(&self.of_link[at].1, against, s.1 - s.0, start));
            }
            start += s.1 - s.0;
        }
        uses
    }

    /// What a segment lies on, by name: its curve, or the surface whose line it is.
    pub fn name_of(&self, input: &Input, segment: usize) -> String {
        let on_link = self.of_link.iter().find(|(_, uses)| uses.iter().any(|u| u.segment == segment));
        if let Some((link, _)) = on_link {
            let curve = input.network.links[link.index()].curve;
            return input.network.curves[curve.index()].name.clone();
        }
        let on_face = self.faces.iter().find(|f| f.sides.iter().any(|s| s.uses.iter().any(|u| u.segment == segment)));
        match on_face {
            Some(face) => format!("a border in {}", input.model.surfaces[face.surface.index()].name),
            None => "a curve".to_owned(),
        }
    }

    /// Segments that an edge or a curve runs along, each once, in no order that means anything.
    pub fn on(&self, input: &Input, target: &Target) -> Vec<usize> {
        let uses = match target {
            Target::Chain(chain) => self.along(input, chain),
            Target::Edge(courses) => courses.iter().flat_map(|course| self.along_course(course)).collect(),
            Target::Surface(_) | Target::Patches(_) | Target::Point(_) => Vec::new(),
        };
        let mut segments: Vec<usize> = uses.iter().map(|u| u.segment).collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    }
}
