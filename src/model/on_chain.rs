//! Lines of a surface that lie on a chain, and the links between their corners.

use super::topology::EdgeCurve;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, LinkId, Network};

/// A line of the surface that lies on a chain: the chain, its links when the network has it, its fraction at each corner.
pub(super) struct OnChain {
    chain: Chain,
    links: Option<Vec<(LinkId, bool)>>,
    /// How far the links reach out before the start of the chain and beyond its end.
    over: (f64, f64),
    fractions: Vec<f64>,
}

impl OnChain {
    pub(super) fn new(chain: &Chain, fractions: Vec<f64>, network: &Network, tolerance: &Tolerance) -> Self {
        let mut links = network.links_of(chain, tolerance);
        let over = links.as_mut().map_or((0.0, 0.0), |links| turned(links, chain, network, tolerance));
        Self { chain: chain.clone(), links, over, fractions }
    }

    /// The edge between corners `n` and `n + 1`, by links where the network has them.
    pub(super) fn edge_curve(&self, n: usize, network: &Network, tolerance: &Tolerance) -> EdgeCurve {
        let length = self.chain.length();
        let (mut a, mut b) = (self.fractions[n] * length, self.fractions[n + 1] * length);
        let backwards = a > b;
        if backwards {
            (a, b) = (length - a, length - b);
        }
        self.links_between(backwards, (a, b), network, tolerance).unwrap_or_else(|| {
            let chain = if backwards { self.chain.reversed() } else { self.chain.clone() };
            EdgeCurve::Run { chain, span: (a, b) }
        })
    }

    /// The links of the chain, run backwards first if so, between two arc lengths.
    fn links_between(&self, backwards: bool, (a, b): (f64, f64), network: &Network, tolerance: &Tolerance) -> Option<EdgeCurve> {
        let mut links = self.links.clone()?;
        if backwards {
            links.reverse();
            links.iter_mut().for_each(|(_, against)| *against = !*against);
        }
        let (mut used, mut before, mut start) = (Vec::new(), if backwards { -self.over.1 } else { -self.over.0 }, 0.0);
        let near = tolerance.point;
        for (link, against) in links {
            let s = network.links[link.index()].s;
            let after = before + (s.1 - s.0);
            if after.min(b) - before.max(a) > near {
                if used.is_empty() {
                    start = before;
                }
                used.push((link, against));
            }
            before = after;
        }
        if used.is_empty() {
            return None;
        }
        let total: f64 = used.iter().map(|(l, _)| network.links[l.index()].s).map(|s| s.1 - s.0).sum();
        let from = if a - start <= near { 0.0 } else { a - start };
        let to = if total - (b - start) <= near { total } else { b - start };
        Some(EdgeCurve::Links { links: used, span: (from, to) })
    }
}

/// Turns the links of a ring that begins between two nodes so that the first one holds its start; that one is there once more
/// as the last. Gives how far they reach out at both ends.
fn turned(links: &mut Vec<(LinkId, bool)>, chain: &Chain, network: &Network, tolerance: &Tolerance) -> (f64, f64) {
    let [run] = chain.runs() else { return (0.0, 0.0) };
    let length = |link: &(LinkId, bool)| {
        let s = network.links[link.0.index()].s;
        s.1 - s.0
    };
    // Only a whole ring may begin between nodes.
    let total = run.curve.length();
    if chain.length() < total - tolerance.point {
        return (0.0, 0.0);
    }
    let Some(start) = network.start_of_turn(run, tolerance) else { return (0.0, 0.0) };
    let ahead = if run.is_backward() { run.s0 - start } else { start - run.s0 };
    let ahead = ahead - total * (ahead / total).floor();
    if ahead <= tolerance.point || ahead >= total - tolerance.point {
        return (0.0, 0.0);
    }
    // The start of the chain is so far along the ring from its first link.
    let (mut k, mut before) = (0, 0.0);
    while k + 1 < links.len() && before + length(&links[k]) <= total - ahead {
        before += length(&links[k]);
        k += 1;
    }
    links.rotate_left(k);
    links.push(links[0]);
    let lead = total - ahead - before;
    (lead, length(&links[0]) - lead)
}
