//! What must hold of a layout when curves and points have their places in it, before anything is divided.

use crate::mesh::border::layout::{Face, FaceSide, Layout};
use crate::mesh::request::input::Input;
use crate::model::segments::SegmentUse;
use crate::surface::Domain;

/// What is wrong, in a sentence.
type Checked = Result<(), String>;

/// Share of the tolerance within which two segments between the same junctions count as one.
const MAX_SAME_SHARE: f64 = 0.1;

impl Layout {
    /// Each segment is there once and runs along the track that gives its geometry; the segments of a track follow each other from its
    /// start to its end; those of a side of a face do, and sides end where the next one starts; faces use each segment as often
    /// as the edges that it lies on say; whatever is named by a number is there.
    pub fn check(&self, input: &Input) -> Checked {
        self.check_tracks()?;
        self.check_segments()?;
        self.check_once(input.tolerance.point)?;
        self.check_lists()?;
        (0..self.faces.len()).try_for_each(|f| self.check_face(input, f))?;
        self.check_users(input)
    }

    /// Junctions of a use from its start to its end.
    fn ends(&self, used: &SegmentUse) -> (usize, usize) {
        let ends = self.pieces.segments[used.segment].ends;
        if used.against { (ends.1, ends.0) } else { ends }
    }

    fn has(&self, segment: usize) -> bool {
        segment < self.pieces.segments.len()
    }

    fn check_tracks(&self) -> Checked {
        let pieces = &self.pieces;
        if [pieces.of_track.len(), pieces.starts.len()] != [self.parts.len(); 2] {
            return Err("lists of tracks differ in length".to_owned());
        }
        for (track, uses) in pieces.of_track.iter().enumerate() {
            let (Some(first), Some(last)) = (uses.first(), uses.last()) else { continue };
            if let Some(used) = uses.iter().find(|u| !self.has(u.segment)) {
                return Err(format!("track {track} runs along segment {}, which is not there", used.segment));
            }
            let whole = (first.s.0, last.s.1) == (0.0, self.parts[track].track.length());
            let follow = uses.windows(2).all(|w| w[0].s.1 == w[1].s.0 && self.ends(&w[0]).1 == self.ends(&w[1]).0);
            if !whole || !follow || uses.iter().any(|u| u.s.0 >= u.s.1) {
                return Err(format!("the segments of track {track} do not follow each other from its start to its end"));
            }
            if self.ends(first).0 != pieces.starts[track] {
                return Err(format!("track {track} does not start at its junction"));
            }
        }
        Ok(())
    }

    fn check_segments(&self) -> Checked {
        let pieces = &self.pieces;
        for (k, segment) in pieces.segments.iter().enumerate() {
            if segment.ends.0.max(segment.ends.1) >= pieces.junctions.len() {
                return Err(format!("segment {k} ends at no junction"));
            }
            let own = SegmentUse { segment: k, against: false, s: segment.s };
            if !pieces.of_track.get(segment.track).is_some_and(|uses| uses.contains(&own)) {
                return Err(format!("the track of segment {k} does not run along it"));
            }
        }
        if pieces.junctions.iter().any(|p| !p.is_finite()) {
            return Err("a junction is nowhere".to_owned());
        }
        Ok(())
    }

    /// No two segments between the same junctions lie on each other, of tracks that are one where they are within the tolerance.
    fn check_once(&self, tolerance: f64) -> Checked {
        let segments = &self.pieces.segments;
        let ends = |k: usize| (segments[k].ends.0.min(segments[k].ends.1), segments[k].ends.0.max(segments[k].ends.1));
        let mut order: Vec<usize> = (0..segments.len()).filter(|k| self.parts[segments[*k].track].near == tolerance).collect();
        order.sort_by_key(|k| (ends(*k), *k));
        for same in order.chunk_by(|a, b| ends(*a) == ends(*b)) {
            for (n, b) in same.iter().enumerate() {
                let lies =
                    |a: &&usize| [0.25, 0.5, 0.75].iter().all(|f| self.distance(**a, self.point(*b, *f)) <= MAX_SAME_SHARE * tolerance);
                if let Some(a) = same[..n].iter().find(lies) {
                    return Err(format!("segments {a} and {b} are one"));
                }
            }
        }
        Ok(())
    }

    fn check_lists(&self) -> Checked {
        if self.edges.len() > self.parts.len() || !self.edges.is_sorted_by(|a, b| a < b) {
            return Err("edges are not in their order, or more than tracks".to_owned());
        }
        if !self.of_link.is_sorted_by(|a, b| a.0 < b.0) {
            return Err("links are not in their order".to_owned());
        }
        for uses in self.of_link.iter().map(|link| &link.1).chain(&self.curves) {
            if uses.iter().any(|u| !self.has(u.segment) || u.s.0 >= u.s.1) || !uses.is_sorted_by(|a, b| a.s.0 <= b.s.0) {
                return Err("a link or curve runs along segments that are not there or not in order".to_owned());
            }
        }
        let junctions = self.points.iter().chain(&self.pieces.of_anchor).flatten();
        if junctions.chain(&self.pieces.starts).any(|j| *j >= self.pieces.junctions.len()) {
            return Err("a point or track is at no junction".to_owned());
        }
        let creases = self.creases.iter().all(|(face, own)| *face < self.faces.len() && own.iter().all(|k| self.has(*k)));
        let fits = creases && self.meets.iter().all(|k| self.has(*k));
        if fits { Ok(()) } else { Err("a line inside a face, or its face, is not there".to_owned()) }
    }

    fn check_face(&self, input: &Input, f: usize) -> Checked {
        let face = &self.faces[f];
        let record = &input.model.patches[face.patch.index()];
        if face.surface != record.surface || face.sides.len() != record.sides.len() {
            return Err(format!("face {f} is not what its patch says"));
        }
        let mut corners = Vec::new();
        for (k, side) in face.sides.iter().enumerate() {
            let (from, to) = self.check_side(side, input.tolerance.point).map_err(|what| format!("side {k} of face {f} {what}"))?;
            corners.push(if input.model.runs_back(record, k) { (to, from) } else { (from, to) });
        }
        let surface = &input.model.surfaces[face.surface.index()].surface;
        let loops = if surface.domain() == Domain::Loop { surface.loops() } else { vec![corners.len()] };
        if loops.iter().sum::<usize>() != corners.len() {
            return Err(format!("face {f} has more or fewer sides than its loops"));
        }
        let mut rest = corners.as_slice();
        for n in loops {
            let own;
            (own, rest) = rest.split_at(n);
            if (0..n).any(|k| own[k].1 != own[(k + 1) % n].0) {
                return Err(format!("a loop of face {f} does not close"));
            }
        }
        self.check_inside(face).map_err(|what| format!("face {f} {what}"))
    }

    /// The junctions where a side starts and ends.
    fn check_side(&self, side: &FaceSide, tolerance: f64) -> Result<(usize, usize), String> {
        let (Some(first), Some(last)) = (side.uses.first(), side.uses.last()) else {
            return side.pole.map(|pole| (pole, pole)).ok_or_else(|| "has neither segments nor a pole".to_owned());
        };
        if side.uses.iter().any(|u| !self.has(u.segment)) {
            return Err("runs along a segment that is not there".to_owned());
        }
        let near = |a: f64, b: f64| (a - b).abs() <= tolerance;
        let whole = near(first.s.0, 0.0) && near(last.s.1, side.length);
        let follow = side.uses.windows(2).all(|w| near(w[0].s.1, w[1].s.0) && self.ends(&w[0]).1 == self.ends(&w[1]).0);
        if !whole || !follow {
            return Err("is broken".to_owned());
        }
        Ok((self.ends(first).0, self.ends(last).1))
    }

    fn check_inside(&self, face: &Face) -> Checked {
        if face.points.iter().any(|k| self.points.get(*k).is_none()) {
            return Err("holds a point that is not there".to_owned());
        }
        let around: Vec<usize> = face.sides.iter().flat_map(FaceSide::segments).collect();
        for (k, line) in face.lines.iter().enumerate() {
            if !self.has(*line) {
                return Err("holds a line that is not there".to_owned());
            }
            if around.contains(line) || face.lines[..k].contains(line) {
                return Err(format!("has segment {line} as a line inside, and that on its border or twice"));
            }
        }
        Ok(())
    }

    /// Sides of faces run along a segment as often as the edges on it have sides among these faces.
    fn check_users(&self, input: &Input) -> Checked {
        let mut counts = vec![0_i64; self.pieces.segments.len()];
        self.faces.iter().flat_map(|f| &f.sides).flat_map(|s| &s.uses).for_each(|u| counts[u.segment] += 1);
        let mut patches: Vec<_> = self.faces.iter().map(|f| f.patch).collect();
        patches.sort_unstable();
        for (edge, uses) in self.edges.iter().zip(&self.pieces.of_track) {
            let users = input.model.edges[edge.index()].users.iter().filter(|u| patches.binary_search(&u.0).is_ok()).count();
            uses.iter().for_each(|u| counts[u.segment] -= users as i64);
        }
        match counts.iter().position(|n| *n != 0) {
            Some(k) => Err(format!("sides of faces run along segment {k} more or less often than its edges say")),
            None => Ok(()),
        }
    }
}
