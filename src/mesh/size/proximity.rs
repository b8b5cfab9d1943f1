//! Narrow places of free faces: where borders, divided into steps, cross, or face each other over less than a step.
//!
//! The divided border of a face is triangulated in its chart. Where steps cross, they are halved until they do not; where a
//! node stands nearer over a step than half of it is long, a triangle between them must have a small angle, and steps are
//! shortened there: the distance of the borders is the local feature size of the face [Ruppert 1995]. What a corner of the
//! border makes narrow is left: shorter steps make its triangles no better.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use crate::base::predicates::orient;
use crate::base::triangulate_points::{PointsFault, Triangles, points};
use crate::base::{job, par};
use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_input::{FaceInput, outlined};
use crate::mesh::chart::outline::{Outline, inside};
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::chart::rings::way_round;
use crate::mesh::request::methods::Elements;
use crate::mesh::request::sources::distance_to_segment;
use crate::mesh::size::border_spacing::SPACING;
use crate::mesh::size::face_settings::is_plane_lattice;
use crate::model::glue::{join, root};

/// A place of a segment where steps have to be shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Narrow {
    /// The segment.
    pub segment: usize,
    /// Fraction of its length.
    pub f: f64,
    /// Longest step there, model units.
    pub size: f64,
    /// Steps cross there: rows of mapped faces beside it have to follow.
    pub crossing: bool,
}

/// What steers the search for narrow places.
struct ProximitySettings {
    /// Longest step over the distance to the border that faces it on plane faces: the triangle with a right angle at its end has 45°, and 41°
    /// where the slack makes the step longer.
    max_step_over_gap: f64,
    /// The same on bent faces, and of narrow places whose distance is less than the least step of a gap: the triangle has 27°.
    max_step_over_gap_of_place: f64,
    /// The same where one row of triangles is too flat for the gap, and two are needed.
    max_step_over_gap_of_two_rows: f64,
    /// Gap from which on that is so, over the length that steps have where nothing faces them.
    max_gap_of_one_row: f64,
    /// The same for quads, whose cells have sides of two steps.
    max_step_over_gap_quads: f64,
    /// The same for quads of a plane lattice where the gap takes two rows: with more, cells of a web have nodes that face each other half a
    /// step apart.
    max_step_over_gap_of_two_rows_of_quads: f64,
    /// Longest step of quads of a plane lattice where the gap takes one row, over the size.
    max_step_of_one_row: f64,
    /// The least step that facing borders demand, over the size, where no `min_size` is written: a long gap is not filled with
    /// steps as short as it is wide.
    min_step_over_size: f64,
    /// Steps that face each other over less than that, up to which they are a narrow place of its own and no gap along a border:
    /// there steps get as short as it is narrow, for lengths grow from it at once.
    max_steps_of_place: usize,
    /// How much shorter such steps get at a time: what is long shows as more of them.
    shrink_of_place: f64,
    /// The shortest of them, in tolerances.
    min_step_of_place: f64,
    /// Steps that are longer than allowed by less than this factor stay.
    slack: f64,
    /// Length of half a step over the step, a little less than a half.
    half: f64,
    /// Steps that cross are halved down to so many tolerances; then the curves themselves meet.
    min_crossing: f64,
    /// Cosine of the angle from which two edges at a node are no corner: 150°.
    smooth_cosine: f64,
    /// Share of the distance between the two legs of a corner up to which a gap is that of the corner.
    corner_share: f64,
}

const SETTINGS: ProximitySettings = ProximitySettings {
    max_step_over_gap: 1.0,
    max_step_over_gap_of_place: 2.0,
    max_step_over_gap_of_two_rows: 0.75,
    max_gap_of_one_row: 1.15,
    max_step_over_gap_quads: 1.0,
    max_step_over_gap_of_two_rows_of_quads: 0.55,
    max_step_of_one_row: 0.25,
    min_step_over_size: 1.0 / 16.0,
    max_steps_of_place: 24,
    shrink_of_place: 0.3,
    min_step_of_place: 16.0,
    slack: 1.15,
    half: 0.45,
    min_crossing: 4.0,
    smooth_cosine: -0.866,
    corner_share: 0.5,
};

/// Places of all free faces where steps have to be shorter.
pub fn find(context: &FaceInput) -> Vec<Narrow> {
    let faces = &context.layout.faces;
    let found = par::map(faces.len(), |f| if faces[f].free { of_face(context, &faces[f]) } else { Vec::new() });
    found.into_iter().flatten().collect()
}

fn of_face(context: &FaceInput, face: &Face) -> Vec<Narrow> {
    let Some((border, chart, outline)) = outlined(context, face) else { return Vec::new() };
    let scan = ProximityScan { context, face, chart: &chart, outline: &outline, ids: &border.ids, steps: steps(context, face) };
    let mut found = scan.narrow();
    if face.halved > 0 {
        found.extend(crate::mesh::size::girth::find(context, face));
    }
    if face.takes_quads()
        && let Some(halves) = crate::mesh::chart::halved::halved(context, face, &border, &outline)
    {
        let ids: Vec<u32> = halves.of.iter().map(|n| border.ids[*n as usize]).collect();
        found.extend(ProximityScan { outline: &halves.outline, ids: &ids, ..scan }.crossings());
    }
    found
}

/// The least step that facing borders demand on a face, model units.
pub fn floor(context: &FaceInput, face: &Face) -> f64 {
    context.input.plan.settings.min_size.map_or(SETTINGS.min_step_over_size * face.size.0, |s| s.0).max(context.input.tolerance.point)
}

/// A step: the piece of a segment between two nodes.
#[derive(Clone, Copy)]
struct BorderStep {
    segment: usize,
    /// Number in the mesh of its node at the lower fraction.
    first: u32,
    f: (f64, f64),
}

/// The steps of a face's segments by their ends, lower node first; of quads two steps as one as well.
fn steps(context: &FaceInput, face: &Face) -> BTreeMap<(u32, u32), BorderStep> {
    let mut steps = BTreeMap::new();
    for segment in face.segments() {
        let ids = context.nodes.of_segment(context.layout, segment, false);
        let at = context.nodes.fractions(segment, false);
        for span in 1..=if face.takes_quads() { 2 } else { 1 } {
            for k in 0..ids.len().saturating_sub(span) {
                job::poll();
                let (a, b) = (ids[k], ids[k + span]);
                steps.entry((a.min(b), a.max(b))).or_insert(BorderStep { segment, first: a, f: (at[k], at[k + span]) });
            }
        }
    }
    steps
}

/// The divided border of a face.
struct ProximityScan<'a> {
    context: &'a FaceInput<'a>,
    face: &'a Face,
    chart: &'a Chart,
    outline: &'a Outline,
    /// Numbers of its nodes in the mesh.
    ids: &'a [u32],
    steps: BTreeMap<(u32, u32), BorderStep>,
}

/// A corner of the border, with half the tangent of half its angle.
struct BorderCorner {
    p: DVec3,
    opens: f64,
}

impl ProximityScan<'_> {
    /// Where steps cross, else where they are long for what faces them.
    fn narrow(&self) -> Vec<Narrow> {
        let edges: Vec<[u32; 2]> = self.outline.edges().collect();
        match points(&self.outline.xy, &edges) {
            Ok(all) if !self.face.method.is_coarse() => self.facing(&all),
            Err(PointsFault::Crosses(..)) => self.crossings(),
            _ => Vec::new(),
        }
    }

    fn step(&self, [a, b]: [u32; 2]) -> Option<BorderStep> {
        let [a, b] = [self.ids[a as usize], self.ids[b as usize]];
        self.steps.get(&(a.min(b), a.max(b))).copied()
    }

    /// Of two edges that cross or touch, those that are not much shorter than the other.
    fn crossings(&self) -> Vec<Narrow> {
        let xy = &self.outline.xy;
        let ends = |e: &[u32; 2]| (xy[e[0] as usize], xy[e[1] as usize]);
        let mut edges: Vec<[u32; 2]> = self.outline.edges().collect();
        let left = |e: &[u32; 2]| ends(e).0.x.min(ends(e).1.x);
        edges.sort_by(|a, b| left(a).total_cmp(&left(b)).then(a.cmp(b)));
        let mut found = Vec::new();
        for (k, one) in edges.iter().enumerate() {
            job::poll();
            let (a, b) = ends(one);
            for other in edges[k + 1..].iter().take_while(|o| left(o) <= a.x.max(b.x)) {
                if meet(xy, *one, *other) {
                    let lengths = [one, other].map(|e| self.outline.length(*e));
                    let longer = lengths[0].max(lengths[1]);
                    let halved = [one, other].into_iter().zip(lengths).filter(|(_, l)| *l > SETTINGS.half * longer);
                    found.extend(halved.filter_map(|(e, length)| self.half(*e, length)));
                }
            }
        }
        found
    }

    fn half(&self, edge: [u32; 2], length: f64) -> Option<Narrow> {
        let step = self.step(edge).filter(|_| length > SETTINGS.min_crossing * self.context.input.tolerance.point)?;
        Some(Narrow { segment: step.segment, f: 0.5 * (step.f.0 + step.f.1), size: SETTINGS.half * length, crossing: true })
    }

    /// The longest step of a border that another one faces at a distance, model units; `floor` is the least one that facing borders demand.
    fn longest_step(&self, gap: f64, floor: f64) -> f64 {
        let size = self.face.size.0;
        if is_plane_lattice(self.context.input, self.face) {
            let of_one_row = (SETTINGS.max_step_over_gap_quads * gap).min(SETTINGS.max_step_of_one_row * size);
            return of_one_row.max(SETTINGS.max_step_over_gap_of_two_rows_of_quads * gap);
        }
        if self.face.elements != Elements::Triangles {
            return SETTINGS.max_step_over_gap_quads * gap;
        }
        if gap < floor || !self.context.input.model.surfaces[self.face.surface.index()].surface.is_flat() {
            return SETTINGS.max_step_over_gap_of_place * gap;
        }
        let (whole, of_two_rows) = (SPACING * size, SETTINGS.max_step_over_gap_of_two_rows * gap);
        let is_wide = gap > SETTINGS.max_gap_of_one_row * whole && of_two_rows < whole;
        if is_wide { of_two_rows } else { SETTINGS.max_step_over_gap * gap }
    }

    /// Steps that are long for what stands over them.
    fn facing(&self, all: &Triangles) -> Vec<Narrow> {
        let p = &self.outline.p;
        let kept = inside(all, self.outline);
        let floor = floor(self.context, self.face);
        let point = SETTINGS.min_step_of_place * self.context.input.tolerance.point;
        let deepest = if self.context.input.plan.settings.min_size.is_some() { floor } else { point.min(floor) };
        let mut close: Vec<(u32, [u32; 2], f64)> = Vec::new();
        for t in (0..kept.len()).filter(|t| kept[*t]) {
            job::poll();
            let (c, given) = (all.corners[t], all.given[t]);
            for k in 0..3 {
                // With two sides of the border it is a corner.
                if given != 1 << k {
                    continue;
                }
                let (over, edge) = (c[k], [c[(k + 1) % 3], c[(k + 2) % 3]]);
                let [a, b] = edge.map(|n| p[n as usize]);
                let gap = distance_to_segment(p[over as usize], a, b);
                if gap > 0.0 && self.outline.length(edge) > SETTINGS.slack * self.longest_step(gap, floor).max(deepest) {
                    close.push((over, edge, gap));
                }
            }
        }
        if close.is_empty() {
            return Vec::new();
        }
        let (corners, at) = (self.corners(), self.edges_at());
        // The two sides of a seam, and of what is run twice, are one border in space: it does not face itself.
        let mut beside: BTreeSet<(u32, u32)> = BTreeSet::new();
        for edge in self.outline.edges() {
            let [a, b] = edge.map(|n| self.ids[n as usize]);
            beside.extend([(a, b), (b, a)]);
        }
        let mut joined: Vec<usize> = (0..p.len()).collect();
        for [a, b] in self.outline.edges() {
            join(&mut joined, a as usize, b as usize);
        }
        let mut narrow = Vec::new();
        for (over, [a, b], gap) in close {
            let (q, ends) = (p[over as usize], [p[a as usize], p[b as usize]]);
            let along = ends[1] - ends[0];
            let t = ((q - ends[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let foot = ends[0] + along * t;
            let own = self.ids[over as usize];
            if [a, b].map(|n| self.ids[n as usize]).into_iter().any(|end| end == own || beside.contains(&(own, end))) {
                continue;
            }
            let same = root(&mut joined, over as usize) == root(&mut joined, a as usize);
            if same && corners.iter().any(|c| c.p != q && gap >= c.opens * (q.distance(c.p) + foot.distance(c.p))) {
                continue;
            }
            let gap = gap.max(self.way_over_fold(over, [a, b], t));
            if self.outline.length([a, b]) > SETTINGS.slack * self.longest_step(gap, floor).max(deepest) {
                narrow.push((over, [a, b], t, gap));
            }
        }
        let mut found = Vec::new();
        // Each step is seen from both sides of the gap.
        let deep = narrow.iter().filter(|n| self.longest_step(n.3, floor) < floor).count() <= 2 * SETTINGS.max_steps_of_place;
        for (over, [a, b], t, gap) in narrow {
            let length = self.outline.length([a, b]);
            let least = if deep { deepest.max(floor.min(SETTINGS.shrink_of_place * length)) } else { floor };
            let size = self.longest_step(gap, floor).max(least);
            let mut shorten = |edge: [u32; 2], t: f64| {
                if self.outline.length(edge) > SETTINGS.slack * size
                    && let Some(step) = self.step(edge)
                {
                    // Steps run along their segment, edges either way.
                    let t = if step.first == self.ids[edge[0] as usize] { t } else { 1.0 - t };
                    found.push(Narrow { segment: step.segment, f: step.f.0 + (step.f.1 - step.f.0) * t, size, crossing: false });
                }
            };
            shorten([a, b], t);
            for other in &at[over as usize] {
                shorten([over, *other], 0.0);
            }
        }
        found
    }

    /// Length of the way over the surface from a node to a place of an edge, model units, where the surface faces opposite ways at the two: they
    /// lie on the two sides of a fold, and may be nearer in space. Elsewhere 0.
    fn way_over_fold(&self, over: u32, [a, b]: [u32; 2], t: f64) -> f64 {
        let [over, a, b] = [over, a, b].map(|n| self.outline.xy[n as usize]);
        let ends = [over, a.lerp(b, t)];
        let surface = self.chart.surface();
        let normal = |xy: DVec2| self.chart.spot(xy).normal();
        // Beside a pole opposite sides are near each other.
        if surface.is_flat() || self.face.has_pole() || normal(ends[0]).dot(normal(ends[1])) >= 0.0 {
            return 0.0;
        }
        let [from, to] = ends.map(|xy| self.chart.uv(xy));
        way_round(surface, from, to)
    }

    /// For each node the other ends of its edges.
    fn edges_at(&self) -> Vec<Vec<u32>> {
        let mut at = vec![Vec::new(); self.outline.p.len()];
        for [a, b] in self.outline.edges() {
            at[a as usize].push(b);
            at[b as usize].push(a);
        }
        at
    }

    /// Nodes whose edges meet at an angle. At a pole the border goes on at another place of the same node; where that is the other side
    /// of a seam there is no corner.
    fn corners(&self) -> Vec<BorderCorner> {
        let p = &self.outline.p;
        let at = self.edges_at();
        let mut found = Vec::new();
        for (n, own) in at.iter().enumerate() {
            let here = |o: &&u32| p[**o as usize] == p[n];
            let across = own.iter().filter(here).flat_map(|o| &at[*o as usize]);
            let mut others: Vec<u32> = own.iter().chain(across).filter(|o| !here(o)).map(|o| self.ids[*o as usize]).collect();
            others.sort_unstable();
            others.dedup();
            let node = |id: u32| self.context.points[id as usize];
            let ways: Vec<DVec3> = others.iter().filter_map(|o| (node(*o) - p[n]).try_normalize()).collect();
            let pairs = (0..ways.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
            let cosine = pairs.map(|(i, j)| ways[i].dot(ways[j])).fold(-1.0, f64::max);
            if cosine > SETTINGS.smooth_cosine {
                let opens = ((1.0 - cosine).max(0.0) / (1.0 + cosine)).sqrt().min(1.0);
                found.push(BorderCorner { p: p[n], opens: SETTINGS.corner_share * opens });
            }
        }
        found
    }
}

/// Whether two edges in the chart have more in common than an end.
fn meet(xy: &[glam::DVec2], one: [u32; 2], other: [u32; 2]) -> bool {
    let [a, b] = one.map(|n| xy[n as usize]);
    let [c, d] = other.map(|n| xy[n as usize]);
    if a.min(b).cmpgt(c.max(d)).any() || c.min(d).cmpgt(a.max(b)).any() {
        return false;
    }
    let shared = one.iter().find(|n| other.contains(n));
    if let Some(n) = shared {
        let far = |e: [u32; 2]| xy[if e[0] == *n { e[1] } else { e[0] } as usize];
        let (at, a, b) = (xy[*n as usize], far(one), far(other));
        return orient(at, a, b) == 0.0 && (a - at).dot(b - at) > 0.0;
    }
    let parted = |a, b, c, d| {
        let (s, t) = (orient(a, b, c), orient(a, b, d));
        s > 0.0 && t > 0.0 || s < 0.0 && t < 0.0
    };
    !parted(a, b, c, d) && !parted(c, d, a, b)
}
