//! Nodes round the holes of a plane face that may slide along their segments.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::base::digest::{StableHash, StableHasher};
use crate::mesh::border::layout::Face;
use crate::mesh::chart::affine::Chart;
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::data::face_mesh::SlidNode;
use crate::mesh::deviation::curve::step_keeps;
use crate::mesh::request::limits::Limits;
use crate::surface::Surface;

/// How far nodes may slide.
struct SlideLimits {
    /// Least length of a step, over what it was.
    least: f64,
    /// Largest length of a step, over what it was. Steps of free faces are four fifths of the size.
    most: f64,
    /// The same of steps that turn far: the chord error of a step grows with the square of its length.
    most_turned: f64,
    /// Chord over arc of a step below which it turns far: 10° on a circle.
    turned: f64,
}

const SLIDE_LIMITS: SlideLimits = SlideLimits { least: 0.8, most: 1.2, most_turned: 1.1, turned: 0.9987 };

/// Border nodes of a plane face that may slide.
pub struct SlidingBorder<'a> {
    face_input: &'a FaceInput<'a>,
    surface: &'a Surface,
    chart: &'a Chart,
    limits: Limits,
    tracks: Vec<SlidingTrack>,
    /// The track of each border node and its place there.
    of_node: Vec<Option<(usize, usize)>>,
}

/// A segment with the nodes along it.
struct SlidingTrack {
    segment: usize,
    /// Border nodes from its start to its end.
    nodes: Vec<u32>,
    /// Their fractions of its length before any slides.
    start: Vec<f64>,
    /// The longest that each step may become, as a fraction.
    most: Vec<f64>,
    /// At each node the longer of its two steps over the shorter one before any slides; 1 at the ends of an open segment.
    growth: Vec<f64>,
}

impl<'a> SlidingBorder<'a> {
    /// The nodes of a face that may slide; `None` where none does.
    pub(crate) fn new(face_input: &'a FaceInput<'a>, face: &Face, chart: &'a Chart, border: &FaceBorder) -> Option<Self> {
        if !face.is_grown() || !face.segments().any(|k| face_input.sliding[k]) {
            return None;
        }
        let surface = &face_input.input.model.surfaces[face.surface.index()].surface;
        let number: BTreeMap<u32, u32> = border.ids.iter().copied().zip(0..).collect();
        let nodes = face_input.nodes;
        let mut tracks = Vec::new();
        let mut of_node = vec![None; border.ids.len()];
        let mut used: Vec<usize> = face.segments().filter(|k| face_input.sliding[*k] && nodes.count(*k) > 1).collect();
        used.sort_unstable();
        for segment in used {
            let ids = nodes.of_segment(face_input.layout, segment, false);
            let Some(own) = ids.iter().map(|id| number.get(id).copied()).collect::<Option<Vec<u32>>>() else { continue };
            for (k, n) in own.iter().enumerate().take(own.len() - 1).skip(1) {
                of_node[*n as usize] = Some((tracks.len(), k));
            }
            tracks.push(SlidingTrack::new(face_input, segment, own));
        }
        let limits = Limits::of(face_input.input);
        (!tracks.is_empty()).then_some(Self { face_input, surface, chart, limits, tracks, of_node })
    }

    /// Fractions of all border nodes before any slides; 0 of those that do not.
    pub(crate) fn start(&self) -> Vec<f64> {
        self.of_node.iter().map(|of| of.map_or(0.0, |(track, k)| self.tracks[track].start[k])).collect()
    }

    /// Whether a node may slide.
    pub(crate) fn slides(&self, node: u32) -> bool {
        self.of_node.get(node as usize).is_some_and(Option::is_some)
    }

    /// The nodes before and after it.
    pub(crate) fn neighbours(&self, node: u32) -> Option<[u32; 2]> {
        let (track, k) = (*self.of_node.get(node as usize)?)?;
        let nodes = &self.tracks[track].nodes;
        Some([nodes[k - 1], nodes[k + 1]])
    }

    /// The least and largest fraction that a node may have between its neighbours as they are.
    pub(crate) fn range(&self, node: u32, along: &[f64]) -> Option<(f64, f64)> {
        let (track, k) = (*self.of_node.get(node as usize)?)?;
        let track = &self.tracks[track];
        let (before, after) = track.ends(k, along);
        let least = |k: usize| SLIDE_LIMITS.least * (track.start[k + 1] - track.start[k]);
        let (mut low, mut high) = ((before + least(k - 1)).max(after - track.most[k]), (before + track.most[k - 1]).min(after - least(k)));
        // No step is more than `growth` times as long as the one beside it, or than it was before.
        let ratio = |k: usize| track.growth[k].max(1.0 + self.face_input.input.plan.slope());
        let own = ratio(k);
        low = low.max((after + own * before) / (1.0 + own));
        high = high.min((before + own * after) / (1.0 + own));
        if let Some((step, ratio)) = track.step_before(k, along).map(|step| (step, ratio(k - 1))) {
            (low, high) = (low.max(before + step / ratio), high.min(before + step * ratio));
        }
        if let Some((step, ratio)) = track.step_after(k, along).map(|step| (step, ratio(k + 1))) {
            (low, high) = (low.max(after - step * ratio), high.min(after - step / ratio));
        }
        (low < high).then_some((low, high))
    }

    /// Where a node is at a fraction: in the chart and in space.
    pub(crate) fn place(&self, node: u32, fraction: f64) -> Option<(DVec2, DVec3)> {
        let (track, _) = (*self.of_node.get(node as usize)?)?;
        let p = self.face_input.layout.point(self.tracks[track].segment, fraction);
        Some((self.chart.xy(self.surface.flat_uv(p)?), p))
    }

    /// Whether the steps beside a node keep the limits with the node at a fraction.
    pub(crate) fn keeps(&self, node: u32, along: &[f64], fraction: f64) -> bool {
        if self.limits.chord.is_none() && self.limits.angle.is_none() {
            return true;
        }
        let Some((track, k)) = self.of_node.get(node as usize).copied().flatten() else { return false };
        let track = &self.tracks[track];
        let (before, after) = track.ends(k, along);
        let count = track.nodes.len() as u32 - 1;
        let keeps = |ends| step_keeps(self.face_input.layout, track.segment, ends, count, &self.limits).unwrap_or(false);
        keeps((before, fraction)) && keeps((fraction, after))
    }

    /// The nodes that are elsewhere than before.
    pub(crate) fn slid(&self, along: &[f64]) -> Vec<SlidNode> {
        let start = self.start();
        let moved = along.iter().zip(start).enumerate().filter(|(_, (now, before))| *now != before);
        moved.map(|(node, (fraction, _))| SlidNode { node: node as u32, fraction: *fraction }).collect()
    }

    /// All that sliding follows from beside the border itself.
    pub(crate) fn hash_into(&self, to: &mut StableHasher) {
        let layout = self.face_input.layout;
        for SlidingTrack { segment, nodes, start, .. } in &self.tracks {
            let piece = &layout.pieces.segments[*segment];
            (&layout.parts[piece.track].track, piece.s, (nodes, start)).hash_into(to);
        }
    }
}

impl SlidingTrack {
    fn new(face_input: &FaceInput, segment: usize, nodes: Vec<u32>) -> Self {
        let start = face_input.nodes.fractions(segment, false);
        let points = face_input.layout.points_along(segment, &start);
        let length = face_input.layout.length(segment);
        let most = start.windows(2).zip(points.windows(2)).map(|(ends, p)| {
            let step = ends[1] - ends[0];
            let is_turned = p[0].distance(p[1]) < SLIDE_LIMITS.turned * step * length;
            step * if is_turned { SLIDE_LIMITS.most_turned } else { SLIDE_LIMITS.most }
        });
        let step = |k: usize| start[k + 1] - start[k];
        let ratio = |a: f64, b: f64| (a / b).max(b / a);
        let last = start.len() - 1;
        let mut growth: Vec<f64> = (1..last).map(|k| ratio(step(k - 1), step(k))).collect();
        let end = if nodes[0] == nodes[last] { ratio(step(0), step(last - 1)) } else { 1.0 };
        growth.insert(0, end);
        growth.push(end);
        Self { segment, most: most.collect(), growth, nodes, start }
    }

    /// The fraction of a node, with those of nodes that slid.
    fn at(&self, k: usize, along: &[f64]) -> f64 {
        if k == 0 || k + 1 == self.nodes.len() { self.start[k] } else { along[self.nodes[k] as usize] }
    }

    /// The step before the one that ends in a node; the last one of a closed segment before its first.
    fn step_before(&self, k: usize, along: &[f64]) -> Option<f64> {
        let last = self.nodes.len() - 1;
        match k {
            1 if self.nodes[0] == self.nodes[last] => Some(self.at(last, along) - self.at(last - 1, along)),
            1 => None,
            _ => Some(self.at(k - 1, along) - self.at(k - 2, along)),
        }
    }

    /// The step after the one that begins in a node; the first one of a closed segment after its last.
    fn step_after(&self, k: usize, along: &[f64]) -> Option<f64> {
        let last = self.nodes.len() - 1;
        match last - k {
            1 if self.nodes[0] == self.nodes[last] => Some(self.at(1, along) - self.at(0, along)),
            1 => None,
            _ => Some(self.at(k + 2, along) - self.at(k + 1, along)),
        }
    }

    /// Fractions of the nodes beside one.
    fn ends(&self, k: usize, along: &[f64]) -> (f64, f64) {
        (self.at(k - 1, along), self.at(k + 1, along))
    }
}
