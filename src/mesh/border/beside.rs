//! Curves that run along borders without being the curves that these were made from.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::mesh::border::layout::Layout;
use crate::mesh::request::input::Input;
use crate::model::segments::SegmentUse;
use crate::network::Chain;

/// Fractions of a segment at which it is sampled.
const SAMPLE_SHARES: [f64; 7] = [0.0, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0];

/// Fractions of a chain at places of a segment; `None` where one is off it.
fn fractions(input: &Input, layout: &Layout, chain: &Chain, segment: usize) -> [Option<f64>; SAMPLE_SHARES.len()] {
    SAMPLE_SHARES.map(|share| {
        let (fraction, _, distance) = chain.closest(layout.point(segment, share));
        (distance <= input.tolerance.point).then_some(fraction)
    })
}

/// Segments whose ends lie in the box of a chain.
fn nearby<'a>(input: &'a Input, layout: &'a Layout, chain: &Chain) -> impl Iterator<Item = usize> + 'a {
    let around = chain.bbox();
    let at = |junction: usize| Box3::of([layout.pieces.junctions[junction]]);
    let near = move |segment: &usize| {
        let ends = layout.pieces.segments[*segment].ends;
        [ends.0, ends.1].iter().all(|end| at(*end).touches(&around, input.tolerance.point))
    };
    (0..layout.pieces.segments.len()).filter(near)
}

/// Segments that lie on a chain, in its direction, with arc lengths on it.
pub fn lying_on(input: &Input, layout: &Layout, chain: &Chain) -> Vec<SegmentUse> {
    let length = chain.length();
    let place = |segment: usize| {
        let at = fractions(input, layout, chain, segment);
        let [_, _, Some(before), Some(middle), Some(after), _, _] = at else { return None };
        if at.contains(&None) {
            return None;
        }
        // Over the start of a ring the fractions leap.
        let against = if (before < middle) == (middle < after) { after < before } else { after > before };
        let half = 0.5 * layout.length(segment);
        Some(SegmentUse { segment, against, s: (middle * length - half, middle * length + half) })
    };
    let mut found: Vec<SegmentUse> = nearby(input, layout, chain).filter_map(place).collect();
    found.sort_by(|a, b| a.s.0.total_cmp(&b.s.0).then(a.segment.cmp(&b.segment)));
    found
}

/// Places at which a chain is sampled.
const CHAIN_SAMPLES: u32 = 32;

/// The middle of a segment of a border that a chain runs along for a part of it only: the chain ends where no node is.
pub fn cut_short(input: &Input, layout: &Layout, chain: &Chain, known: &[usize]) -> Option<DVec3> {
    let near = input.tolerance.point;
    let around = chain.bbox();
    let touches = |segment: &usize| {
        let ends = layout.pieces.segments[*segment].ends;
        let corners = [ends.0, ends.1].map(|j| layout.pieces.junctions[j]);
        Box3::of(SAMPLE_SHARES.map(|share| layout.point(*segment, share)).into_iter().chain(corners)).touches(&around, near)
    };
    // Two neighbouring places of one on the other, and what lies between them.
    let of_segment = |segment: usize| {
        let on = |share: f64| chain.closest(layout.point(segment, share)).2 <= near;
        SAMPLE_SHARES.windows(2).any(|w| [w[0], 0.5 * (w[0] + w[1]), w[1]].into_iter().all(on))
    };
    let of_chain = |segment: usize| {
        let on = |k: u32| layout.distance(segment, chain.point(f64::from(k) / f64::from(2 * CHAIN_SAMPLES))) <= near;
        (0..CHAIN_SAMPLES).any(|k| (2 * k..2 * k + 3).all(on))
    };
    let mut open = (0..layout.pieces.segments.len()).filter(|segment| known.binary_search(segment).is_err());
    open.find(|segment| touches(segment) && (of_segment(*segment) || of_chain(*segment))).map(|segment| layout.point(segment, 0.5))
}
