//! The modeling curve along an edge.

use super::topology::{EdgeCurve, EdgeId, Model, SurfaceId};
use super::trace::Trace;
use crate::base::fault::Result;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, LinkId, Network};
use crate::surface::{Domain, IsoLine};

impl Model {
    /// An edge as a chain in its own direction; `None` for one that no curve carries (a line across a trimmed surface that
    /// follows neither u nor v).
    pub fn edge_chain(&self, edge: EdgeId, network: &Network, tolerance: &Tolerance) -> Result<Option<Chain>> {
        match &self.edges[edge.index()].curve {
            EdgeCurve::Links { links, span } => along_links(links, *span, network, tolerance),
            EdgeCurve::Run { chain, span } => part(chain, *span, tolerance).map(Some),
            EdgeCurve::Iso { surface, from, to } => self.line_chain(*surface, (*from, *to), tolerance),
        }
    }

    /// A line of a surface as a curve from one (u, v) to the other; `None` where neither u nor v stays.
    fn line_chain(&self, id: SurfaceId, (from, to): ((f64, f64), (f64, f64)), tolerance: &Tolerance) -> Result<Option<Chain>> {
        let surface = &self.surfaces[id.index()].surface;
        let (line, a, b) = match (from.0 == to.0, from.1 == to.1) {
            (true, _) => (IsoLine::U(from.0), from.1, to.1),
            (_, true) => (IsoLine::V(from.1), from.0, to.0),
            _ => return Ok(None),
        };
        let trimmed = surface.domain() == Domain::Loop && !surface.is_flat();
        let surface = &if trimmed { surface.untrimmed() } else { surface.clone() };
        let Some(curve) = surface.iso(line, surface.origin(), tolerance)? else { return Ok(None) };
        let chain = Chain::of_curve(&curve);
        // Between kinks: a part with another speed would be missed.
        let (us, vs) = surface.kinks();
        let kinks = if matches!(line, IsoLine::U(_)) { vs } else { us };
        let length = |t: f64| {
            let stops = [&[0.0], &kinks[..kinks.partition_point(|k| *k < t)], &[t]].concat();
            stops.windows(2).map(|w| Trace::new(surface, line.at(w[0]), line.at(w[1])).length()).sum::<f64>()
        };
        let whole = length(1.0);
        let closed = if matches!(line, IsoLine::U(_)) { surface.closed().1 } else { surface.closed().0 };
        let between = |low: f64, high: f64| {
            // Where a surface closes, places go on beyond 0…1.
            let turns = if closed { (0.5 * (low + high)).floor() } else { 0.0 };
            let (low, high) = (low - turns, high - turns);
            if closed && high - low < 1.0 && (low < 0.0 || high > 1.0) {
                let share = |t: f64| length(t - t.floor()) / whole;
                return chain.slice(share(low), share(high), tolerance);
            }
            let (low, high) = (if low <= 0.0 { 0.0 } else { length(low) / whole }, if high >= 1.0 { 1.0 } else { length(high) / whole });
            if low == 0.0 && high == 1.0 { Ok(chain.clone()) } else { chain.slice(low, high, tolerance) }
        };
        Ok(Some(if a <= b { between(a, b)? } else { between(b, a)?.reversed() }))
    }
}

/// The part of a chain between two ascending arc lengths.
fn part(chain: &Chain, (from, to): (f64, f64), tolerance: &Tolerance) -> Result<Chain> {
    let length = chain.length();
    let whole = from <= tolerance.point && to >= length - tolerance.point;
    if whole { Ok(chain.clone()) } else { chain.slice(from / length, to / length, tolerance) }
}

/// The part of a run of links between two arc lengths.
///
/// Each link is cut before they are joined: the one link of a closed curve stands twice in an edge that begins between its
/// ends.
fn along_links(links: &[(LinkId, bool)], (from, to): (f64, f64), network: &Network, tolerance: &Tolerance) -> Result<Option<Chain>> {
    let (mut parts, mut before) = (Vec::new(), 0.0);
    for (link, against) in links {
        let chain = network.link_chain(*link);
        let chain = if *against { chain.reversed() } else { chain };
        let after = before + chain.length();
        let (low, high) = (from.max(before), to.min(after));
        if high - low > tolerance.point {
            parts.push(part(&chain, (low - before, high - before), tolerance)?);
        }
        before = after;
    }
    let Some(first) = parts.first() else { return Ok(None) };
    Ok(Some(if parts.len() == 1 { first.clone() } else { Chain::join(&parts, first.origin(), tolerance)? }))
}
