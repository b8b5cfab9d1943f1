//! Where two patches may meet: subdivision of pairs of cells with guaranteed bounds.
//!
//! A pair is dropped when the two cells are further apart than the tolerance. Where no two tangent planes of a pair are
//! parallel the common places lie one behind the other, so a place on a line that is known settles the pair; a place on
//! none begins a march. Pairs without such a place are halved: no line is missed that is longer than a few tolerances.
//! A line may leave a pair over a border of a patch, as over a seam, and come back: pairs at such a border are halved on.
//! What stays parallel down to flat cells touches.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::TOLD_APART;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind, Nurbs};
use crate::network::Chain;
use crate::surface::closest::foot::FootSearch;
use crate::surface::intersect::fit_branch::Branch;
use crate::surface::intersect::known_curves::KnownCurve;
use crate::surface::intersect::pair::{Pair, Spot};
use crate::surface::intersect::sheet::{Cell, Sheet};
use crate::surface::intersect::touch_line::Touch;

/// What limits the search for common places of two patches.
struct PairLimits {
    /// Pairs looked at before giving up; a solved place counts as many as it costs.
    max_pairs: usize,
    /// What a place that is solved for, or a touch, costs in pairs.
    pairs_per_solution: usize,
    /// Share of the tolerance within which cells count as flat.
    flat_share: f64,
    /// Flat cells that part by no more than this many tolerances run along each other.
    divergence_tolerances: f64,
    /// Share of the tolerance within which cells that cross must come.
    exact_share: f64,
    /// Pairs of flat cells that touch, at most.
    max_touches: usize,
    /// Share of the smaller patch below which cells about a line along which they touch are compared at their corners.
    touch_share: f64,
    /// How often a line along which they touch is looked for in vain.
    touch_lines_in_vain: usize,
    /// None is looked for where so few tolerances beside it they part already: about a tip all directions are within the tolerance.
    least_width_tolerances: f64,
    /// Cells smaller than this many tolerances are not halved to find a place between their corners.
    least_cell_tolerances: f64,
    /// Share of the smaller patch below which, however large the tolerance is.
    least_cell_share: f64,
    /// Share of the smaller patch down to which cells at a border are halved although a line through them is known.
    border_share: f64,
}

/// Sine of the angle between patches below which a common place may be one beside a line along which they touch.
pub(super) const TOUCHING_SINE: f64 = 1.0 / 64.0;

const SEARCH: PairLimits = PairLimits {
    max_pairs: 300_000,
    pairs_per_solution: 2,
    flat_share: 0.25,
    divergence_tolerances: 4.0,
    exact_share: 1.0 / 1024.0,
    max_touches: 2_000,
    touch_share: 1.0 / 64.0,
    touch_lines_in_vain: 16,
    least_width_tolerances: 32.0,
    least_cell_tolerances: 16.0,
    least_cell_share: 1.0 / 64.0,
    border_share: 1.0 / 256.0,
};

/// What two patches have in common.
#[derive(Debug, Default)]
pub(crate) struct CommonPlaces {
    pub branches: Vec<Branch>,
    /// Boxes of what touches without crossing.
    pub touches: Vec<Box3>,
}

/// Why a search ended early.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stopped {
    /// They run along each other here.
    Along(DVec3),
    /// Too much work, or a march that came to a halt.
    Lost(DVec3),
}

struct PairSearch<'a> {
    a: &'a mut Sheet,
    b: &'a mut Sheet,
    point: f64,
    /// Size of the smaller one.
    size: f64,
    /// What stays within the tolerance for longer is no touch.
    long: f64,
    touched: Box3,
    common: CommonPlaces,
    looked_at: usize,
    /// Curves on both that need no search.
    known: &'a [KnownCurve],
    /// Lines along which they touch, and how often one was looked for in vain.
    touch_lines: Vec<(Branch, KnownCurve)>,
    in_vain: usize,
}

/// The lines in which two patches meet, and where they touch.
pub(crate) fn common(a: &mut Sheet, b: &mut Sheet, known: &[KnownCurve], point: f64, long: f64) -> Result<CommonPlaces, Stopped> {
    let size = a.bounds().diagonal().min(b.bounds().diagonal());
    let (roots_a, roots_b) = (a.roots.clone(), b.roots.clone());
    let mut search = PairSearch {
        a,
        b,
        point,
        size,
        long,
        touched: Box3::EMPTY,
        common: CommonPlaces::default(),
        looked_at: 0,
        known,
        touch_lines: Vec::new(),
        in_vain: 0,
    };
    for i in roots_a {
        for j in &roots_b {
            job::poll();
            search.pair(i, *j, false)?;
        }
    }
    let mut common = search.common;
    common.branches.extend(search.touch_lines.into_iter().map(|(line, _)| line));
    Ok(common)
}

impl PairSearch<'_> {
    /// Looks at a pair of cells; `known` says that a line through a larger pair around it is known.
    fn pair(&mut self, i: usize, j: usize, known: bool) -> Result<(), Stopped> {
        self.looked_at += 1;
        let mut known = known;
        let (x, y) = (self.a.cell(i), self.b.cell(j));
        if self.a.is_outside(i) || self.b.is_outside(j) || apart(x, y, self.point) {
            return Ok(());
        }
        if self.looked_at > SEARCH.max_pairs {
            return Err(Stopped::Lost(x.enclosure.mid.p));
        }
        if x.reach().max(y.reach()) <= SEARCH.touch_share * self.size && self.touch_lines.iter().any(|(_, known)| known.passes(x, y)) {
            let touch = Touch { pair: &Pair { a: &self.a.patch, b: &self.b.patch, point: self.point }, size: self.size };
            if touch.parts_beside(x, y.middle()) {
                return Ok(());
            }
        }
        let fine = x.thick.max(y.thick) <= SEARCH.flat_share * self.point;
        // Flat cells that part by no more than a few tolerances run along each other.
        let slow = fine && x.normal.cross(y.normal).length() * x.reach().min(y.reach()) <= SEARCH.divergence_tolerances * self.point;
        if !slow && crosses(x, y) {
            let exact = SEARCH.exact_share * self.point;
            if apart(x, y, exact) || beside(x, y, exact) || self.known.iter().any(|known| known.passes(x, y)) {
                return Ok(());
            }
            // What is lost beside a known line ends at a border.
            let small = x.reach().max(y.reach()) <= SEARCH.border_share * self.size;
            let at_border = self.a.is_at_border(i) || self.b.is_at_border(j);
            if known && (small || !at_border) {
                return Ok(());
            }
            if self.settled(i, j, known)? {
                if small || !at_border {
                    return Ok(());
                }
                known = true;
            }
        } else if fine {
            return self.touch(i, j);
        }
        let (x, y) = (self.a.cell(i), self.b.cell(j));
        if x.reach().max(y.reach()) <= (SEARCH.least_cell_tolerances * self.point).min(SEARCH.least_cell_share * self.size) {
            return Ok(());
        }
        let first = x.reach() >= y.reach();
        let halves = if first { self.a.halves(i) } else { self.b.halves(j) };
        match (halves, first) {
            (Some((k, l)), true) => {
                self.pair(k, j, known)?;
                self.pair(l, j, known)
            }
            (Some((k, l)), false) => {
                self.pair(i, k, known)?;
                self.pair(i, l, known)
            }
            (None, _) => Ok(()),
        }
    }

    /// Whether a common place of two cells is known; a new one is marched from. Where a line through a larger pair is known a march that
    /// comes to a halt at an end of it is that line.
    fn settled(&mut self, i: usize, j: usize, known: bool) -> Result<bool, Stopped> {
        self.looked_at += SEARCH.pairs_per_solution;
        let (x, y) = (self.a.cell(i), self.b.cell(j));
        let pair = Pair { a: &self.a.patch, b: &self.b.patch, point: self.point };
        let Some(spot) = pair.correct(x.middle(), y.middle(), None) else { return Ok(false) };
        let Some(spot) = inside(&pair, x, y, spot) else { return Ok(false) };
        if self.known.iter().any(|known| known.is_at(spot.p, spot.sine, self.point, self.long)) {
            return Ok(true);
        }
        if spot.sine <= TOUCHING_SINE && self.is_touch_line(spot.a, spot.b, Some(spot.p)) {
            return Ok(true);
        }
        let pair = Pair { a: &self.a.patch, b: &self.b.patch, point: self.point };
        if !self.common.branches.iter().any(|branch| pair.passes(branch, &spot)) {
            match pair.line_through(spot, self.size) {
                Ok(branch) => self.common.branches.push(branch),
                Err(at) if known && self.ends_at(at) => {}
                Err(at) => return Err(Stopped::Lost(at)),
            }
        }
        Ok(true)
    }

    /// Whether a line that is known ends at a place.
    fn ends_at(&self, at: DVec3) -> bool {
        let ends = self.common.branches.iter().flat_map(|branch| [branch.spots.first(), branch.spots.last()]).flatten();
        ends.into_iter().any(|spot| spot.p.distance(at) <= TOLD_APART * self.point)
    }

    /// Flat cells along each other: a touch when they come within the tolerance.
    fn touch(&mut self, i: usize, j: usize) -> Result<(), Stopped> {
        const ROUNDS: usize = 16;
        self.looked_at += SEARCH.pairs_per_solution;
        let (x, y) = (self.a.cell(i), self.b.cell(j));
        let (mut a, mut b) = (x.middle(), y.middle());
        let mut gap = f64::INFINITY;
        let mut at = x.enclosure.mid.p;
        for _ in 0..ROUNDS {
            job::poll();
            b = y.hold(self.b.patch.foot(self.a.patch.jet(a).p, b).0);
            a = x.hold(self.a.patch.foot(self.b.patch.jet(b).p, a).0);
            at = self.a.patch.jet(a).p;
            gap = gap.min(at.distance(self.b.patch.jet(b).p));
        }
        let extent = Box3 { min: x.bounds.min.max(y.bounds.min), max: x.bounds.max.min(y.bounds.max) };
        if gap > self.point || self.is_touch_line(a, b, None) {
            return Ok(());
        }
        let extent = extent.with(at);
        self.touched = self.touched.union(extent);
        self.common.touches.push(extent);
        // A single touch may have many cells where parameters crowd, at a pole.
        let is_long = self.touched.diagonal() > self.long;
        if self.common.touches.len() > if is_long { SEARCH.max_touches } else { SEARCH.max_pairs / 4 } {
            Err(Stopped::Along(at))
        } else {
            Ok(())
        }
    }
}

impl PairSearch<'_> {
    /// Whether the patches touch along a line at a place, so near to it as the tolerance tells of a point if that is given; a new line is
    /// followed to its ends.
    fn is_touch_line(&mut self, a: DVec2, b: DVec2, beside: Option<DVec3>) -> bool {
        let touch = Touch { pair: &Pair { a: &self.a.patch, b: &self.b.patch, point: self.point }, size: self.size };
        let Some(ridge) = touch.ridge(a, b, None).filter(|ridge| beside.is_none_or(|p| p.distance(ridge.p) <= ridge.width)) else {
            return false;
        };
        if self.touch_lines.iter().any(|(line, _)| touch.passes(line, &ridge)) {
            return true;
        }
        if self.in_vain >= SEARCH.touch_lines_in_vain || ridge.width < SEARCH.least_width_tolerances * self.point {
            return false;
        }
        match touch.line(ridge) {
            Some(line) if !line.cubics.is_empty() => {
                let curve = Curve::new(Shape::Nurbs(Arc::new(Nurbs::joined(&line.cubics))), Kind::Meet, Origin::NONE);
                let known = KnownCurve::on_patches(Chain::of_curve(&curve), touch.places(&line));
                self.touch_lines.push((line, known));
                true
            }
            _ => {
                self.in_vain += 1;
                false
            }
        }
    }
}

/// The place on the line through another one that is farthest inside two cells, when it is in both.
pub(crate) fn inside(pair: &Pair, x: &Cell, y: &Cell, spot: Spot) -> Option<Spot> {
    let (a, b) = pair.ahead(&spot, spot.way)?;
    let (da, db) = (a - spot.a, b - spot.b);
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let four = [(spot.a.x, da.x, x.u), (spot.a.y, da.y, x.v), (spot.b.x, db.x, y.u), (spot.b.y, db.y, y.v)];
    for (at, rate, (from, to)) in four {
        if rate == 0.0 {
            continue;
        }
        let (s, t) = ((from - at) / rate, (to - at) / rate);
        (low, high) = (low.max(s.min(t)), high.min(s.max(t)));
    }
    let way = 0.5 * (low + high);
    let found = if way.is_finite() && !(x.holds(spot.a) && y.holds(spot.b)) {
        let (a, b) = (x.hold(spot.a + da * way), y.hold(spot.b + db * way));
        pair.correct(a, b, Some((spot.p + spot.way * way, spot.way)))?
    } else {
        spot
    };
    (x.holds(found.a) && y.holds(found.b)).then_some(found)
}

/// Whether two cells are further apart than a distance.
pub(crate) fn apart(x: &Cell, y: &Cell, point: f64) -> bool {
    if !x.bounds.touches(&y.bounds, point) {
        return true;
    }
    [x.normal, y.normal].into_iter().any(|n| {
        let (r, s) = (x.along(n), y.along(n));
        n != DVec3::ZERO && (r.low > s.high + point || s.low > r.high + point)
    })
}

/// Whether two cells that cross as planes end before they meet: they are apart across a side of each. Of two flat parallelograms these
/// directions and both normals are all that can part them.
fn beside(x: &Cell, y: &Cell, point: f64) -> bool {
    let sides = |cell: &Cell| [cell.enclosure.mid.du, cell.enclosure.mid.dv];
    sides(x).into_iter().flat_map(|e| sides(y).map(|f| e.cross(f).normalize_or_zero())).any(|n| {
        let (r, s) = (x.along(n), y.along(n));
        r.low > s.high + point || s.low > r.high + point
    })
}

/// Whether no two tangent planes are parallel, and all common directions are on one side of a plane.
pub(crate) fn crosses(x: &Cell, y: &Cell) -> bool {
    let way = x.normal.cross(y.normal).normalize_or_zero();
    way != DVec3::ZERO && x.normals.cross(&y.normals).along(way).low > 0.0
}
