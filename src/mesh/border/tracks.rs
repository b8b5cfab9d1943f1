//! Tracks that segments are cut from: edges of patches, links of curves, and curves that are in no network.

use std::collections::BTreeMap;

use crate::mesh::border::inside;
use crate::mesh::request::input::Input;
use crate::model::glue::preference;
use crate::model::segments::{Part, SegmentUse, Segments};
use crate::model::{EdgeCurve, EdgeId, PatchId, SurfaceId, Track};
use crate::network::{Chain, LinkId};

/// How far edges of some patches are glued at most, or curves of their nets miss each other.
pub(super) fn reach(input: &Input, patches: impl Iterator<Item = PatchId>) -> f64 {
    let of = |p: PatchId| {
        let surface = input.model.patches[p.index()].surface;
        let glued = input.plan.glue.get(&surface).copied();
        let missed = input.model.surfaces[surface.index()].surface.net_gaps().first().map(|gap| gap.by);
        glued.into_iter().chain(missed)
    };
    patches.flat_map(of).fold(input.tolerance.point, f64::max)
}

/// Uses of a track as seen by something that runs along or against it and places it at `start`.
pub(super) fn oriented(uses: &[SegmentUse], against: bool, length: f64, start: f64) -> Vec<SegmentUse> {
    let turn = |u: &SegmentUse| {
        if against {
            SegmentUse { segment: u.segment, against: !u.against, s: (start + length - u.s.1, start + length - u.s.0) }
        } else {
            SegmentUse { s: (start + u.s.0, start + u.s.1), ..*u }
        }
    };
    if against { uses.iter().rev().map(turn).collect() } else { uses.iter().map(turn).collect() }
}

/// An edge as a track, cut where its links end.
pub(super) fn edge_part(input: &Input, edge: EdgeId) -> Part {
    let track = input.model.track(edge, input.network);
    let cuts = track.joints(input.tolerance);
    let users = &input.model.edges[edge.index()].users;
    let near = reach(input, users.iter().map(|(p, _)| *p));
    Part { track, cuts, rank: preference(&input.model.edges[edge.index()].curve), near }
}

/// Adds the links of the plan's curves as tracks of their own; gives link and part, ascending.
pub(super) fn link_parts(input: &Input, parts: &mut Vec<Part>) -> Vec<(LinkId, usize)> {
    let chains = input.plan.curves.iter().map(|c| &c.1);
    let mut links: Vec<LinkId> =
        chains.filter_map(|c| input.network.links_of(c, input.tolerance)).flatten().map(|(link, _)| link).collect();
    links.sort_unstable();
    links.dedup();
    links
        .into_iter()
        .map(|link| {
            let s = input.network.links[link.index()].s;
            let curve = EdgeCurve::Links { links: vec![(link, false)], span: (0.0, s.1 - s.0) };
            parts.push(Part { track: Track::of(&curve, &[], input.network), cuts: Vec::new(), rank: 0, near: input.tolerance.point });
            (link, parts.len() - 1)
        })
        .collect()
}

/// Adds the plan's curves that are not in the network as tracks of their own; gives curve and part.
pub(super) fn curve_parts(input: &Input, parts: &mut Vec<Part>) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (k, (_, chain)) in input.plan.curves.iter().enumerate() {
        if input.network.links_of(chain, input.tolerance).is_none() {
            parts.push(curve_part(input, chain));
            found.push((k, parts.len() - 1));
        }
    }
    found
}

/// A chain as a track of its own.
pub(super) fn curve_part(input: &Input, chain: &Chain) -> Part {
    let curve = EdgeCurve::Run { chain: chain.clone(), span: (0.0, chain.length()) };
    let cuts = chain.joints().iter().map(|f| f * chain.length()).filter(|s| *s > 0.0 && *s < chain.length()).collect();
    Part { track: Track::of(&curve, &[], input.network), cuts, rank: preference(&curve), near: input.tolerance.point }
}

/// Cuts an edge where it runs over borders between patches of surfaces that it is no edge of.
pub(super) fn cut_on_others(input: &Input, edge: EdgeId, patches: &[PatchId], part: &mut Part) {
    let surface = |p: PatchId| input.model.patches[p.index()].surface;
    let own: Vec<SurfaceId> = input.model.edges[edge.index()].users.iter().map(|(p, _)| surface(*p)).collect();
    let others: Vec<PatchId> = patches.iter().copied().filter(|p| !own.contains(&surface(*p))).collect();
    part.cuts.extend(inside::crossings(input, &others, &part.track));
    part.cuts.sort_by(f64::total_cmp);
}

/// Segments of each link, along the link.
pub(super) fn by_link(input: &Input, edges: &[EdgeId], links: &[(LinkId, usize)], pieces: &Segments) -> Vec<(LinkId, Vec<SegmentUse>)> {
    let mut found: BTreeMap<LinkId, Vec<SegmentUse>> = BTreeMap::new();
    for (link, part) in links {
        found.entry(*link).or_default().extend(&pieces.of_track[*part]);
    }
    for (part, edge) in edges.iter().enumerate() {
        let EdgeCurve::Links { links, span } = &input.model.edges[edge.index()].curve else {
            continue;
        };
        let mut start = -span.0;
        for (link, against) in links {
            let s = input.network.links[link.index()].s;
            let length = s.1 - s.0;
            let inside = |u: &&SegmentUse| 0.5 * (u.s.0 + u.s.1) > start && 0.5 * (u.s.0 + u.s.1) < start + length;
            let own: Vec<SegmentUse> =
                pieces.of_track[part].iter().filter(inside).map(|u| SegmentUse { s: (u.s.0 - start, u.s.1 - start), ..*u }).collect();
            found.entry(*link).or_default().extend(oriented(&own, *against, length, 0.0));
            start += length;
        }
    }
    for uses in found.values_mut() {
        uses.sort_by(|a, b| a.s.0.total_cmp(&b.s.0).then(a.segment.cmp(&b.segment)));
        uses.dedup_by_key(|u| u.segment);
    }
    found.into_iter().collect()
}
