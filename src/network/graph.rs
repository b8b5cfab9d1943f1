//! The curve network: all declared curves in one graph of nodes and links [Koh & Park 1990, §3.1].
//!
//! It keeps the contacts of its curves pair by pair and assembles nodes and links from them after every change, so a
//! network that was edited and one that was built afresh are the same (`docs/notes/network.md`).

use std::sync::OnceLock;

use glam::DVec3;

use super::assemble::{Parts, assemble};
use super::chain::{Chain, Run, same_curve};
use super::hits::{self, Contact};
use super::near::near_misses;
use crate::base::fault::{Fault, Result};
use crate::base::inline_list::InlineList;
use crate::base::job::Job;
use crate::base::math::compare_points;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::Curve;
use crate::network::fault::{ChainFault, GraphFault};

crate::ids! {
    /// A node of the network.
    NodeId,
    /// A link of the network.
    LinkId,
    /// A curve of the network.
    CurveId,
}

/// A point where curves end or meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Where it is: the declared point among the hits, else their mean.
    pub point: DVec3,
}

/// A run of one curve between neighbouring nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The curve that owns it.
    pub curve: CurveId,
    /// Arc lengths on the owner, ascending; past the start of a closed curve the second exceeds its length.
    pub s: (f64, f64),
    /// First and last node, in the direction of the owner.
    pub nodes: (NodeId, NodeId),
}

/// A curve with the links it runs over.
#[derive(Clone, Debug)]
pub struct NetCurve {
    /// Unique name; ties and ownership go by it.
    pub name: String,
    /// Its geometry.
    pub curve: Curve,
    /// Arc lengths where a node was asked for.
    pub cuts: Vec<f64>,
    /// Links it runs over from start to end, with `true` where it runs against the link's direction (shared runs).
    pub links: InlineList<(LinkId, bool), 1>,
    /// Its nodes from start to end, `links.len() + 1` of them; those of a closed curve begin and end with its first
    /// node, which is at its start only when nothing meets it or something meets it there.
    pub nodes: InlineList<NodeId, 2>,
    /// Arc lengths of these nodes on this curve, ascending; the last one of a closed curve is one turn after the first.
    pub stations: InlineList<f64, 2>,
}

/// A curve to insert.
#[derive(Clone, Debug)]
pub struct Input {
    /// Unique name.
    pub name: String,
    /// Geometry.
    pub curve: Curve,
    /// Arc lengths where a node is asked for (ends of slices).
    pub cuts: Vec<f64>,
}

/// For each link before a change, the links that stand in its place, in its direction.
pub type LinkMap = Vec<Vec<LinkId>>;

/// The curves of a model, their nodes and links; numbered in the order in which curves are given, then along curves.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Curves as given.
    pub curves: Vec<NetCurve>,
    /// Nodes.
    pub nodes: Vec<Node>,
    /// Links.
    pub links: Vec<Link>,
    contacts: Vec<Contact>,
    points: Vec<DVec3>,
    by_start: OnceLock<Vec<(DVec3, u32)>>,
}

impl Network {
    /// All curves at once. `points` are the declared points, which give their place to the nodes they hit.
    ///
    /// Notes and warnings (shared runs N512, near misses W514) go to `sink`. Fails with E506 when it is not clear which
    /// hits are one node, with E401 for a curve of no length, and with what intersection fails with.
    pub fn build(inputs: Vec<Input>, points: &[DVec3], tolerance: &Tolerance, job: &Job, sink: &mut Vec<Fault>) -> Result<Self> {
        Self::build_after(None, inputs, points, tolerance, job, sink)
    }

    /// The same with the contacts of curves that a network `before`, of the same tolerance, holds already: made once and
    /// copied, under the same names.
    pub fn build_after(
        before: Option<&Self>,
        inputs: Vec<Input>,
        points: &[DVec3],
        tolerance: &Tolerance,
        job: &Job,
        sink: &mut Vec<Fault>,
    ) -> Result<Self> {
        let mut network = Self { points: points.to_vec(), ..Self::default() };
        network.curves.reserve_exact(inputs.len());
        for input in inputs {
            network.admit(input, tolerance)?;
        }
        network.contacts = match before {
            Some(before) => hits::all_after(&network.curves, (&before.curves, &before.contacts), tolerance, job)?,
            None => hits::all(&network.curves, tolerance, job)?,
        };
        sink.extend(network.assemble(tolerance)?);
        sink.extend(near_misses(&network.curves, None, tolerance));
        Ok(network)
    }

    /// Adds a curve; the map leads from the old links to the new ones. A network that fails is left as it was.
    pub fn insert(&mut self, input: Input, tolerance: &Tolerance, job: &Job, sink: &mut Vec<Fault>) -> Result<LinkMap> {
        let mut next = self.clone();
        next.admit(input, tolerance)?;
        let one = next.curves.len() - 1;
        let own = next.curves[one].curve.origin();
        next.contacts.extend(hits::of_one(&next.curves, one, tolerance, job)?);
        let notes = next.assemble(tolerance)?;
        sink.extend(notes.into_iter().filter(|note| concerns(note, own)));
        sink.extend(near_misses(&next.curves, Some(one), tolerance));
        let map = self.map_to(&next, Some);
        *self = next;
        Ok(map)
    }

    /// Takes a curve away with what it leaves isolated; nodes that only it made disappear and their links merge.
    ///
    /// `users` are the entities that stand on the curve, upper-most first; when there are any, E510 lists them.
    pub fn remove(&mut self, curve: CurveId, users: &[Origin], tolerance: &Tolerance) -> Result<LinkMap> {
        let gone = curve.index();
        if !users.is_empty() {
            return Err(GraphFault::InUse { of: self.curves[gone].curve.origin(), users: users.to_vec() }.into());
        }
        let mut next = self.clone();
        next.curves.remove(gone);
        next.contacts.retain(|c| c.curves.iter().all(|&k| k as usize != gone));
        for k in next.contacts.iter_mut().flat_map(|c| &mut c.curves).filter(|k| **k as usize > gone) {
            *k -= 1;
        }
        next.assemble(tolerance)?;
        let map = self.map_to(&next, |k| match k.cmp(&gone) {
            std::cmp::Ordering::Less => Some(k),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(k - 1),
        });
        *self = next;
        Ok(map)
    }

    fn admit(&mut self, input: Input, tolerance: &Tolerance) -> Result<()> {
        let Input { name, curve, cuts } = input;
        let length = curve.length();
        if length.is_nan() || length <= tolerance.point {
            return Err(ChainFault::NoLength { of: curve.origin(), at: curve.start(), length, tolerance: tolerance.point }.into());
        }
        self.curves.push(NetCurve {
            name,
            curve,
            cuts,
            links: InlineList::default(),
            nodes: InlineList::default(),
            stations: InlineList::default(),
        });
        Ok(())
    }

    fn assemble(&mut self, tolerance: &Tolerance) -> Result<Vec<Fault>> {
        self.by_start = OnceLock::new();
        let parts = Parts { contacts: &self.contacts, points: &self.points, tolerance };
        let (nodes, links, notes) = assemble(&mut self.curves, &parts)?;
        self.nodes = nodes;
        self.links = links;
        Ok(notes)
    }

    /// Links of `next` in the place of each link of this network; `curve_in` finds curves there.
    fn map_to(&self, next: &Self, curve_in: impl Fn(usize) -> Option<usize>) -> LinkMap {
        let place = |link: &Link| -> Vec<LinkId> {
            // A link whose owner went may live on in another curve that runs over it.
            let Some(net) = curve_in(link.curve.index()).map(|k| &next.curves[k]) else { return Vec::new() };
            let nearest = |s: f64| {
                let near = |k: &usize| (net.stations[*k] - s).abs();
                (0..net.stations.len()).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap_or(0)
            };
            let whole = net.links.len();
            let (from, mut to) = (nearest(link.s.0), nearest(link.s.1));
            if to <= from {
                to += whole;
            }
            (from..to).map(|k| net.links[k % whole].0).collect()
        };
        self.links.iter().map(place).collect()
    }

    /// The curve of the network with the same geometry.
    pub fn find(&self, curve: &Curve) -> Option<CurveId> {
        let by_start = self.by_start.get_or_init(|| {
            let mut all: Vec<(DVec3, u32)> = self.curves.iter().zip(0..).map(|(net, k)| (net.curve.start(), k)).collect();
            all.sort_by(|a, b| compare_points(a.0, b.0).then(a.1.cmp(&b.1)));
            all
        });
        let start = curve.start();
        let from = by_start.partition_point(|(p, _)| compare_points(*p, start).is_lt());
        let same_start = by_start[from..].iter().take_while(|(p, _)| compare_points(*p, start).is_eq());
        same_start.map(|&(_, k)| k as usize).find(|&k| same_curve(&self.curves[k].curve, curve)).map(CurveId::at)
    }

    /// The links a chain runs over, with `true` where it runs against the link; `None` where a run lies on a curve that
    /// is not in the network or does not end in its nodes.
    pub fn links_of(&self, chain: &Chain, tolerance: &Tolerance) -> Option<Vec<(LinkId, bool)>> {
        let mut links = Vec::new();
        for run in chain.runs() {
            let net = &self.curves[self.find(&run.curve)?.index()];
            let mut part = net.links_between(run.s0.min(run.s1), run.s0.max(run.s1), tolerance)?;
            if run.is_backward() {
                part.reverse();
                part.iter_mut().for_each(|(_, against)| *against = !*against);
            }
            links.extend(part);
        }
        Some(links)
    }

    /// The arc length of the node at which the links of a whole turn begin, on the curve itself: a link may be that of another
    /// curve, with lengths of its own. `None` for a curve that is open or not in the network.
    pub fn start_of_turn(&self, run: &Run, tolerance: &Tolerance) -> Option<f64> {
        let net = &self.curves[self.find(&run.curve)?.index()];
        net.is_closed().then(|| net.stations[net.first_of_turn(run.s0.min(run.s1), tolerance)])
    }

    /// For each node the links that end there, with `true` where the link ends and `false` where it starts; ascending.
    pub fn link_ends(&self) -> Vec<Vec<(LinkId, bool)>> {
        let mut ends = vec![Vec::new(); self.nodes.len()];
        for (k, link) in self.links.iter().enumerate() {
            ends[link.nodes.0.index()].push((LinkId::at(k), false));
            ends[link.nodes.1.index()].push((LinkId::at(k), true));
        }
        ends
    }

    /// The node within tolerance of a point; the nearest one.
    pub fn node_at(&self, point: DVec3, tolerance: &Tolerance) -> Option<NodeId> {
        let near = |k: &usize| self.nodes[*k].point.distance_squared(point);
        let nearest = (0..self.nodes.len()).min_by(|a, b| near(a).total_cmp(&near(b)))?;
        tolerance.same_point(self.nodes[nearest].point, point).then(|| NodeId::at(nearest))
    }

    /// A link's geometry as a chain along its own direction.
    pub fn link_chain(&self, link: LinkId) -> Chain {
        let Link { curve, s, .. } = self.links[link.index()];
        let curve = &self.curves[curve.index()].curve;
        Chain::of_runs([Run { curve: curve.clone(), s0: s.0, s1: s.1 }], curve.origin())
    }
}

/// Whether a note speaks of the curve.
fn concerns(note: &Fault, of: Origin) -> bool {
    match note.of() {
        Some(GraphFault::SharedRun { owner, other, .. }) => *owner == of || *other == of,
        _ => true,
    }
}

impl NetCurve {
    fn is_closed(&self) -> bool {
        self.nodes.first() == self.nodes.last() && self.stations[self.stations.len() - 1] >= self.curve.length()
    }

    /// The node nearest to an arc length, of those within `reach`, by its place among its own.
    fn station_at(&self, s: f64, reach: f64) -> Option<usize> {
        let off = |k: &usize| (self.stations[*k] - s).abs();
        (0..self.stations.len()).filter(|k| off(k) <= reach).min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// The place among its own of the first link of a whole turn from wherever it begins; begun between nodes it is the ring
    /// all the same.
    fn first_of_turn(&self, lo: f64, tolerance: &Tolerance) -> usize {
        let (reach, length) = (4.0 * tolerance.point, self.curve.length());
        let at = |s: f64| self.station_at(s, reach);
        at(lo).or_else(|| at(lo + length)).or_else(|| at(lo - length)).unwrap_or(0)
    }

    /// The links between two ascending arc lengths that are nodes within the tolerance.
    fn links_between(&self, lo: f64, hi: f64, tolerance: &Tolerance) -> Option<Vec<(LinkId, bool)>> {
        let reach = 4.0 * tolerance.point;
        let length = self.curve.length();
        let closed = self.is_closed();
        let at = |s: f64| self.station_at(s, reach);
        if !closed {
            let (from, to) = (at(lo)?, at(hi)?);
            return Some(self.links[from..to].to_vec());
        }
        if hi - lo >= length - reach {
            let from = self.first_of_turn(lo, tolerance);
            return Some((0..self.links.len()).map(|k| self.links[(from + k) % self.links.len()]).collect());
        }
        let find = |s: f64| [0.0, length, -length].into_iter().find_map(|turn| at(s + turn)).map(|k| k % self.links.len());
        let (from, mut to) = (find(lo)?, find(hi)?);
        if to <= from {
            to += self.links.len();
        }
        Some((from..to).map(|k| self.links[k % self.links.len()]).collect())
    }
}
