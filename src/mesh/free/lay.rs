//! A face between lines of constant u and v [Paper 004; math notes §15]: whole cells in two triangles or a few more, what
//! borders cross by one constrained triangulation, and cells cut until every triangle keeps the limits for sure.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::build::{Trouble, inside};
use super::fill::{self, Filling, fill};
use super::ground::Ground;
use super::isoline::Cells;
use super::loads::{self, Load};
use super::marks::{corners, marks};
use super::outline::Outline;
use super::sheet::Sheet;
use super::tree::Class;
use super::web::Web;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::base::triangulate_points::{Triangles, points};
use crate::mesh::edges::Limits;
use crate::mesh::explain::{Decider, Tally, Why};
use crate::mesh::sources::Sources;

/// What a face is laid out by.
pub struct Ask<'a> {
    /// The surface in its chart.
    pub sheet: &'a Sheet,
    /// The border.
    pub outline: &'a Outline,
    /// Chord error and angle.
    pub limits: &'a Limits,
    /// Longest side of a cell, model units.
    pub size: f64,
    /// Places where it is shorter.
    pub rules: &'a Sources,
    /// Floor of all sizes, model units; 0: none.
    pub floor: f64,
    /// Most inner nodes.
    pub most: usize,
}

/// Why there is no mesh.
#[derive(Clone, Copy, Debug)]
pub enum Failure {
    /// As with any method.
    Trouble(Trouble),
    /// A limit asks for less than the floor: the length it asks for, and where.
    Floor(f64, DVec3),
    /// A limit is not met: how often it is exceeded, and where.
    Missed(Load, DVec3),
}

/// A face laid out.
pub struct Laid {
    /// Its triangles.
    pub web: Web,
    /// Its cells.
    pub tally: Tally,
    /// What decided how small they are.
    pub deciders: Vec<Decider>,
}

type Tried<T> = std::result::Result<T, Failure>;

/// A direction across which a cell is cut, and in how many parts at last.
type Cut = (usize, u32);

/// Most parts a cell is cut into at a time.
const MOST_PARTS: f64 = 1e6;
/// Width of the strips by which errors along one direction are told, as a share of the cell.
const NARROW: f64 = 1.0 / 64.0;
/// Width of a leaf over that of a triangle below which it is thin.
const THIN: f64 = 0.6;
/// Nearest distance of a node to a border it is not on, as a share of the cells about it.
const CLEAR: f64 = 0.3;
/// Longest side of a triangle beside a border over the longest side of a cell: its diagonal, and a little.
const STRETCH: f64 = 1.5;
/// Times that what does not keep the limits is cut.
const ROUNDS: usize = 64;
/// Pieces by which the side of a cell is measured.
const PIECES: usize = 4;

/// Lays a face out; the outer result is an interruption.
pub fn lay(ask: &Ask, job: &Job) -> Result<Tried<Laid>> {
    let outline = ask.outline;
    let at: Vec<DVec2> = outline.xy.iter().map(|xy| DVec2::from(ask.sheet.uv(*xy))).collect();
    let mut segments: Vec<[DVec2; 2]> = outline.edges().map(|e| e.map(|n| at[n as usize])).collect();
    // Single nodes inside count as segments without length.
    let mut alone = vec![true; at.len()];
    outline.edges().flatten().for_each(|n| alone[n as usize] = false);
    segments.extend((0..at.len()).filter(|n| alone[*n]).map(|n| [at[n]; 2]));
    let kinks = if ask.limits.chord.is_some() { kinks(ask.sheet) } else { Default::default() };
    let cells = Cells::new(&segments, outline.loops.len(), kinks);
    let mut work = Work { ask, at, cells, known: BTreeMap::new(), fillings: BTreeMap::new(), worst: None };
    let mut again = work.settle(vec![0]);
    for _ in 0..ROUNDS {
        job.go_on()?;
        if let Err(failure) = again {
            return Ok(Err(failure));
        }
        match work.round() {
            Ok(Some(laid)) => return Ok(Ok(laid)),
            other => again = other.map(|_| ()),
        }
    }
    Ok(again.and_then(|()| Err(work.missed())))
}

/// Values of u and of v at which directions jump; over seams they come again.
fn kinks(sheet: &Sheet) -> [Vec<f64>; 2] {
    let (us, vs) = sheet.surface().kinks();
    [us, vs].map(|all| all.iter().flat_map(|x| [x - 1.0, *x, x + 1.0]).collect())
}

/// A place where cells meet, or a border has a node on the side of one.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: DVec2,
    /// A node of the border.
    border: Option<u32>,
    /// Two nodes of the border are here, or one is too near.
    dropped: bool,
}

/// Corners by place, and how to find them.
struct Corners {
    /// By u, then v.
    all: Vec<Corner>,
    /// By v, then u.
    by_v: Vec<u32>,
    /// Their nodes.
    node: Vec<Option<u32>>,
}

fn order(a: DVec2, b: DVec2, first: usize) -> std::cmp::Ordering {
    a[first].total_cmp(&b[first]).then(a[1 - first].total_cmp(&b[1 - first]))
}

impl Corners {
    /// The corner at a place.
    fn of(&self, at: DVec2) -> Option<usize> {
        self.all.binary_search_by(|c| order(c.at, at, 0)).ok()
    }

    /// Corners strictly between two places of one value of u (axis 1 runs) or v (axis 0 runs), ascending.
    fn between(&self, from: DVec2, to: DVec2, axis: usize) -> Vec<usize> {
        let place = |k: usize| if axis == 1 { k } else { self.by_v[k] as usize };
        let first = partition(self.all.len(), |k| order(self.all[place(k)].at, from, 1 - axis).is_le());
        let last = partition(self.all.len(), |k| order(self.all[place(k)].at, to, 1 - axis).is_lt());
        (first..last).map(place).collect()
    }
}

/// The first of `n` for which a condition, true up to some place, is not.
fn partition(n: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, n);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { low = middle + 1 } else { high = middle }
    }
    low
}

/// The points of a polygon and what fills it.
type Known = (Vec<DVec3>, Option<Filling>);

struct Work<'a> {
    ask: &'a Ask<'a>,
    /// Places of the border's nodes in (u, v).
    at: Vec<DVec2>,
    cells: Cells<'a>,
    /// Points by the bits of their (u, v).
    known: BTreeMap<(u64, u64), DVec3>,
    /// By cell.
    fillings: BTreeMap<u32, Known>,
    /// The worst triangle seen in the last round.
    worst: Option<(Load, DVec3)>,
}

impl Work<'_> {
    fn missed(&self) -> Failure {
        let (load, at) = self.worst.unwrap_or_default();
        Failure::Missed(load, at)
    }

    fn place(&self, at: DVec2) -> DVec2 {
        self.ask.sheet.clamp(self.ask.sheet.xy(at.into()))
    }

    fn point(&mut self, at: DVec2) -> DVec3 {
        let key = (at.x.to_bits(), at.y.to_bits());
        if let Some(p) = self.known.get(&key) {
            return *p;
        }
        let p = self.ask.sheet.spot(self.place(at)).p;
        self.known.insert(key, p);
        p
    }

    /// The better of the two ways to halve a box by a diagonal.
    fn load(&mut self, low: DVec2, high: DVec2) -> f64 {
        let at = corners((low, high));
        let p = at.map(|at| self.point(at));
        let xy = at.map(|at| self.place(at));
        let one = |c: [usize; 3]| loads::load_of(self.ask.sheet, (c.map(|k| xy[k]), c.map(|k| p[k])), self.ask.limits).worst();
        let first = one([0, 1, 2]).max(one([0, 2, 3]));
        if first <= 1.0 { first } else { first.min(one([0, 1, 3]).max(one([1, 2, 3]))) }
    }

    /// Lengths of a box along u and v.
    fn lengths(&mut self, low: DVec2, high: DVec2) -> DVec2 {
        let share = |k: usize| k as f64 / PIECES as f64;
        let mut longest = DVec2::ZERO;
        for axis in 0..2 {
            for other in [0.0, 0.5, 1.0] {
                let mut at = low + (high - low) * other;
                let mut length = 0.0;
                let mut last = None;
                for k in 0..=PIECES {
                    at[axis] = low[axis] + (high[axis] - low[axis]) * share(k);
                    let p = self.ask.sheet.spot(self.place(at)).p;
                    length += last.map_or(0.0, |last: DVec3| last.distance(p));
                    last = Some(p);
                }
                longest[axis] = longest[axis].max(length);
            }
        }
        longest
    }

    /// How long the sides of a box may be, and by which clause.
    fn allowed(&mut self, low: DVec2, high: DVec2, lengths: DVec2) -> (f64, Why) {
        let (rules, size) = (self.ask.rules, self.ask.size);
        if rules.is_empty() {
            return (size, Why::Size);
        }
        // Lengths change by the slope, so what is asked at the middle bounds what is asked all over the box.
        let reach = rules.slope() * 0.5 * lengths.length();
        let p = self.point(0.5 * (low + high));
        match rules.who(p, size + reach) {
            Some(least) => ((least.size - reach).max(rules.least()), Why::Refined(rules.items()[least.item as usize].tag as usize)),
            None => (size, Why::Size),
        }
    }

    /// Cuts leaves, and theirs, until each is no longer than allowed and keeps the limits by itself.
    fn settle(&mut self, mut open: Vec<u32>) -> Tried<()> {
        while let Some(k) = open.pop() {
            if self.cells.all().len() > 8 * self.ask.most {
                return Err(Failure::Trouble(Trouble::Full));
            }
            if self.cells.all()[k as usize].class == Class::Exterior {
                continue;
            }
            if let Some((cut, why)) = self.wants(k)? {
                let first = self.cells.all().len() as u32;
                self.cells.split(k, cut, why);
                open.extend([first + 1, first]);
            }
        }
        Ok(())
    }

    /// Whether a leaf has to be cut, across which direction, and why.
    fn wants(&mut self, k: u32) -> Tried<Option<(Cut, Why)>> {
        if let Some(axis) = self.cells.kinked(k) {
            return Ok(Some(((axis, 2), Why::Bends)));
        }
        let cell = &self.cells.all()[k as usize];
        let (low, high) = (cell.low, cell.high);
        let lengths = self.lengths(low, high);
        let longer = usize::from(lengths.y > lengths.x);
        let (most, why) = self.allowed(low, high, lengths);
        if lengths[longer] > most * (1.0 + WHOLE_NUMBER) && self.cells.divisible(k, longer) {
            let parts = (lengths[longer] / most).ceil().clamp(2.0, MOST_PARTS) as u32;
            return Ok(Some(((longer, parts), why)));
        }
        if self.ask.limits.chord.is_none() && self.ask.limits.angle.is_none() {
            return Ok(None);
        }
        let load = self.load(low, high);
        if load <= 1.0 {
            return Ok(None);
        }
        self.floor(lengths[longer], load, low)?;
        Ok(self.best_cut(k, (low, high)).map(|cut| (cut, Why::Bends)))
    }

    fn floor(&mut self, longest: f64, load: f64, at: DVec2) -> Tried<()> {
        if longest > self.ask.floor {
            return Ok(());
        }
        Err(Failure::Floor(self.ask.floor / load.sqrt(), self.point(at)))
    }

    /// The direction across which cutting a box in a leaf brings more, and in how many parts.
    ///
    /// With errors A and B along the two directions alone, A / n² + B / m² ≤ 1 takes the fewest cells where both are alike.
    fn best_cut(&mut self, k: u32, (low, high): (DVec2, DVec2)) -> Option<Cut> {
        let own = [0, 1].map(|axis| self.load_along((low, high), axis));
        let lengths = self.lengths(low, high);
        let worse = if own[0] == own[1] { usize::from(lengths.y > lengths.x) } else { usize::from(own[1] > own[0]) };
        let axis = [worse, 1 - worse].into_iter().find(|axis| self.cells.divisible(k, *axis))?;
        let left = (1.0 - own[1 - axis]).max(0.5);
        let parts = (own[axis] / left).sqrt().ceil();
        Some((axis, if parts.is_finite() { parts.clamp(2.0, MOST_PARTS) as u32 } else { 2 }))
    }

    /// The direction across which a leaf in a box of a triangle that does not keep the limits is cut: the one with more of the
    /// error, but for leaves that are thin in it already, where nodes have to come nearer from the other side.
    fn towards(&mut self, k: u32, (low, high): (DVec2, DVec2)) -> Option<usize> {
        let cell = &self.cells.all()[k as usize];
        let share = cell.width() / (high - low);
        let own = [0, 1].map(|axis| self.load_along((low, high), axis));
        let worse = usize::from(own[1] > own[0]);
        let first = if share[worse] >= THIN || share[worse] >= share[1 - worse] { worse } else { 1 - worse };
        [first, 1 - first].into_iter().find(|axis| self.cells.divisible(k, *axis))
    }

    /// The worst load of narrow strips of a box along one direction.
    fn load_along(&mut self, (low, high): (DVec2, DVec2), axis: usize) -> f64 {
        let other = 1 - axis;
        let width = (high[other] - low[other]) * NARROW;
        let mut worst = 0.0_f64;
        for share in [0.0, 0.5, 1.0] {
            let (mut from, mut to) = (low, high);
            from[other] = low[other] + (high[other] - low[other] - width) * share;
            to[other] = from[other] + width;
            worst = worst.max(self.load(from, to));
        }
        worst
    }

    /// Corners of cells and nodes of borders on their sides.
    fn corners(&self) -> Corners {
        let mut all: Vec<Corner> = Vec::new();
        for cell in self.cells.all().iter().filter(|c| c.is_leaf() && c.class != Class::Exterior) {
            all.extend(corners((cell.low, cell.high)).map(|at| Corner { at, border: None, dropped: false }));
        }
        let near = self.cells.near;
        for (n, at) in self.at.iter().enumerate() {
            let lined = self.cells.lined(*at);
            let beside =
                [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)].map(|d| self.cells.find(lined + near * DVec2::from(d), [true; 2]));
            for (i, k) in beside.iter().enumerate() {
                let cell = &self.cells.all()[*k as usize];
                if beside[..i].contains(k) || cell.class == Class::Exterior {
                    continue;
                }
                let (mut snapped, mut on) = (lined, false);
                for axis in 0..2 {
                    for side in [cell.low[axis], cell.high[axis]] {
                        if (lined[axis] - side).abs() <= near[axis] {
                            (snapped[axis], on) = (side, true);
                        }
                    }
                }
                if on {
                    all.push(Corner { at: snapped, border: Some(n as u32), dropped: false });
                }
            }
        }
        all.sort_by(|a, b| order(a.at, b.at, 0).then(b.border.cmp(&a.border)));
        let merged = all
            .chunk_by(|a, b| a.at == b.at)
            .map(|same| Corner { dropped: same.iter().any(|c| c.border.is_some() && c.border != same[0].border), ..same[0] });
        let all: Vec<Corner> = merged.collect();
        let mut by_v: Vec<u32> = (0..all.len() as u32).collect();
        by_v.sort_by(|a, b| order(all[*a as usize].at, all[*b as usize].at, 1));
        let node = vec![None; all.len()];
        Corners { all, by_v, node }
    }

    /// Whether a place is too near to a border, or outside.
    fn unfit(&self, at: DVec2) -> bool {
        let leaves = self.cells.around(at);
        let around = || leaves.iter().map(|k| &self.cells.all()[*k as usize]).filter(|c| c.class != Class::Exterior);
        let scale = around().fold(DVec2::INFINITY, |s, c| s.min(c.width()));
        let close = |s: &u32| {
            let [a, b] = self.cells.segment(*s).map(|p| (p - at) / scale);
            let along = b - a;
            let square = along.length_squared();
            let t = if square > 0.0 { (-a.dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
            (a + along * t).length() < CLEAR
        };
        around().any(|c| c.segments.iter().any(close)) || !around().any(|c| c.class == Class::Interior) && !self.cells.holds(at)
    }

    /// One try: the triangles, or cells cut where they do not keep the limits.
    fn round(&mut self) -> Tried<Option<Laid>> {
        let outline = self.ask.outline;
        let mut corners = self.corners();
        let mut web = Web::default();
        (web.p, web.xy, web.fixed) = (outline.p.clone(), outline.xy.clone(), outline.p.len() as u32);
        for (k, corner) in corners.all.iter().enumerate() {
            if corner.dropped {
                continue;
            }
            corners.node[k] = corner.border;
            if corner.border.is_none() && !self.unfit(corner.at) {
                corners.node[k] = Some(web.p.len() as u32);
                web.p.push(self.point(corner.at));
                web.xy.push(self.place(corner.at));
            }
        }
        if web.p.len() > self.ask.most {
            return Err(Failure::Trouble(Trouble::Full));
        }
        let (sure, bad) = self.whole(&corners, &web);
        if !bad.is_empty() {
            return self.cut(bad).map(|()| None);
        }
        let (all, kept) = self.triangulated(&web, &sure)?;
        let sure: BTreeSet<[u32; 3]> = sure.into_iter().map(sorted).collect();
        let bad = self.beside(&web, (&all, &kept), &sure);
        if self.worst.is_some() {
            if bad.is_empty() {
                return Err(self.missed());
            }
            return self.cut(bad).map(|()| None);
        }
        web.size = vec![self.ask.size; web.p.len()];
        let tally = self.tally(&corners);
        let deciders = self.deciders(&corners, &web);
        let mut web = Web::new(web.p, web.xy, web.size, web.fixed, &all, &kept);
        lock(&mut web, outline);
        web.lift_flat();
        Ok(Some(Laid { web, tally, deciders }))
    }

    /// Cuts leaves across directions.
    fn cut(&mut self, bad: Vec<(u32, Cut)>) -> Tried<()> {
        let mut open = Vec::new();
        for (k, cut) in bad {
            let first = self.cells.all().len() as u32;
            self.cells.split(k, cut, Why::Bends);
            self.fillings.remove(&k);
            open.extend([first, first + 1]);
        }
        self.settle(open)
    }

    /// Triangles of the cells that no border crosses, and the cells of which some do not keep the limits.
    fn whole(&mut self, corners: &Corners, web: &Web) -> (Vec<[u32; 3]>, Vec<(u32, Cut)>) {
        let (mut sure, mut bad) = (Vec::new(), Vec::new());
        for k in 0..self.cells.all().len() as u32 {
            let cell = &self.cells.all()[k as usize];
            if !cell.is_leaf() || cell.class != Class::Interior {
                continue;
            }
            let bounds = (cell.low, cell.high);
            let Some(round) = polygon(corners, bounds) else { continue };
            let nodes: Vec<u32> = round.iter().filter_map(|c| corners.node[*c]).collect();
            let p: Vec<DVec3> = nodes.iter().map(|n| web.p[*n as usize]).collect();
            if self.fillings.get(&k).is_none_or(|(known, _)| *known != p) {
                let at: Vec<DVec2> = round.iter().map(|c| corners.all[*c].at).collect();
                let load = |c: [usize; 3]| loads::load_of_long(self.ask.sheet, web, c.map(|i| nodes[i]), self.ask.limits).worst();
                let filling = fill(&at, &p, f64::INFINITY, &load);
                self.fillings.insert(k, (p, filling));
            }
            let Some((_, Some(filling))) = self.fillings.get(&k) else { continue };
            if filling.load <= 1.0 {
                sure.extend(filling.triangles.iter().map(|t| t.map(|i| nodes[i])));
            } else if let Some((axis, _)) = self.best_cut(k, bounds) {
                bad.push((k, (axis, 2)));
            }
        }
        (sure, bad)
    }

    /// The triangulation of all nodes with the edges of borders and of the triangles that are sure, and which are inside.
    fn triangulated(&self, web: &Web, sure: &[[u32; 3]]) -> Tried<(Triangles, Vec<bool>)> {
        let outline = self.ask.outline;
        let mut edges: Vec<[u32; 2]> =
            sure.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let given: BTreeSet<[u32; 2]> = outline.edges().map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.retain(|e| !given.contains(e));
        let mut all: Vec<[u32; 2]> = outline.edges().collect();
        all.extend(edges);
        let all = points(&web.xy, &all).map_err(|fault| Failure::Trouble(Trouble::Border(fault)))?;
        let kept = inside(&all, outline);
        if kept.contains(&true) { Ok((all, kept)) } else { Err(Failure::Trouble(Trouble::Empty)) }
    }

    /// Cells to cut for triangles beside borders that do not keep the limits.
    fn beside(&mut self, web: &Web, (all, kept): (&Triangles, &[bool]), sure: &BTreeSet<[u32; 3]>) -> Vec<(u32, Cut)> {
        self.worst = None;
        let mut bad: BTreeMap<u32, Cut> = BTreeMap::new();
        for t in (0..kept.len()).filter(|t| kept[*t]) {
            let c = all.corners[t];
            if sure.contains(&sorted(c)) {
                continue;
            }
            let load = loads::load_of_long(self.ask.sheet, web, c, self.ask.limits);
            let long = self.too_long(web, (c, all.given[t]));
            if load.worst() <= 1.0 && !long {
                continue;
            }
            let uv = c.map(|n| DVec2::from(self.ask.sheet.uv(web.xy[n as usize])));
            let middle = (uv[0] + uv[1] + uv[2]) / 3.0;
            if self.worst.is_none_or(|(worst, _)| load.worst() > worst.worst()) {
                self.worst = Some((load, c.iter().map(|n| web.p[*n as usize]).sum::<DVec3>() / 3.0));
            }
            let leaf = self.cells.find(middle, [true; 2]);
            if self.cells.all()[leaf as usize].class == Class::Exterior {
                continue;
            }
            let bounds = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
            if let Some(axis) = self.towards(leaf, bounds) {
                bad.entry(leaf).or_insert((axis, 2));
            }
        }
        bad.into_iter().collect()
    }

    /// Whether a side of a triangle that is no edge of the border is longer than cells may be.
    fn too_long(&self, web: &Web, (c, given): ([u32; 3], u8)) -> bool {
        let p = c.map(|n| web.p[n as usize]);
        let most = |p: DVec3| self.ask.rules.at(p, self.ask.size);
        (0..3).filter(|k| given >> k & 1 == 0).any(|k| {
            let (a, b) = (p[(k + 1) % 3], p[(k + 2) % 3]);
            a.distance(b) > STRETCH * most(a).max(most(b))
        })
    }

    /// Counts of cells, and at how many corners beside borders the marks say what the winding does.
    fn tally(&self, known: &Corners) -> Tally {
        let mut tally = Tally::default();
        let loops = self.ask.outline.loops.len() as u32;
        for cell in self.cells.all().iter().filter(|c| c.is_leaf()) {
            match cell.class {
                Class::Exterior => continue,
                Class::Interior => tally.whole += 1,
                Class::Partial => tally.crossed += 1,
            }
            // The face is on the left of its loops.
            let turned = cell.segments.iter().filter(|s| **s < loops).map(|s| self.cells.segment(*s)).map(|[a, b]| [b, a]);
            let found = marks((cell.low, cell.high), turned);
            if cell.class != Class::Partial || found == [0; 4] {
                continue;
            }
            for (mark, at) in found.iter().zip(corners((cell.low, cell.high))) {
                let Some(k) = known.of(at).filter(|k| known.all[*k].border.is_none()) else { continue };
                let kept = known.node[k].is_some() || self.cells.holds(at);
                tally.corners += 1;
                tally.agree += usize::from((*mark == 2) == kept);
            }
        }
        tally
    }

    /// What decided, with the number of nodes inside.
    fn deciders(&self, corners: &Corners, web: &Web) -> Vec<Decider> {
        let mut found: BTreeMap<Why, Decider> = BTreeMap::new();
        for (corner, node) in corners.all.iter().zip(&corners.node) {
            let Some(n) = node.filter(|n| *n >= web.fixed) else { continue };
            let smallest = |k: &u32| self.cells.all()[*k as usize].width().element_product();
            let leaf = self.cells.around(corner.at).into_iter().min_by(|a, b| smallest(a).total_cmp(&smallest(b)));
            let why = leaf.map_or(Why::Size, |k| self.cells.all()[k as usize].why);
            found.entry(why).or_insert(Decider { why, nodes: 0, at: web.p[n as usize] }).nodes += 1;
        }
        found.into_values().collect()
    }
}

/// Corners round a cell, counter-clockwise, with those on its sides; `None` where one of its own has no node.
fn polygon(corners: &Corners, (low, high): (DVec2, DVec2)) -> Option<Vec<usize>> {
    let own = super::marks::corners((low, high)).map(|at| corners.of(at).filter(|k| corners.node[*k].is_some()));
    let [a, b, c, d] = [own[0]?, own[1]?, own[2]?, own[3]?];
    let mut round = Vec::new();
    for (first, side, back) in [(a, (a, b, 0), false), (b, (b, c, 1), false), (c, (d, c, 0), true), (d, (a, d, 1), true)] {
        let (from, to, axis) = side;
        round.push(first);
        let mut on = corners.between(corners.all[from].at, corners.all[to].at, axis);
        on.retain(|k| corners.node[*k].is_some());
        if back {
            on.reverse();
        }
        round.extend(on);
    }
    (round.len() <= fill::MOST).then_some(round)
}

fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}

/// Only edges of borders may not change.
fn lock(web: &mut Web, outline: &Outline) {
    let given: BTreeSet<[u32; 2]> = outline.edges().map(|[a, b]| [a.min(b), a.max(b)]).collect();
    for t in 0..web.tri.len() {
        let c = web.tri[t];
        let edge = |k: usize| [c[(k + 1) % 3].min(c[(k + 2) % 3]), c[(k + 1) % 3].max(c[(k + 2) % 3])];
        web.locked[t] = (0..3).filter(|k| given.contains(&edge(*k))).fold(0, |bits, k| bits | 1 << k);
    }
}
