//! Where a curve meets a patch of a surface: subdivision with guaranteed bounds.
//!
//! A pair of a part of the curve and a cell is dropped when they are further apart than the tolerance. Where no tangent of
//! the part can lie in a tangent plane of the cell there is at most one meeting, and Newton's method finds it. What runs
//! along the surface is collected, part by part, and worked out at the end: touches, meetings close together, overlaps.

use glam::{DVec2, DVec3};

use crate::base::tolerance::{EPSILON, NEWTON_STEP};
use crate::geometry::Curve;
use crate::geometry::curves::pieces::{Node, View, children};
use crate::geometry::shapes::bounds::Rates;
use crate::surface::closest::foot::FootSearch;
use crate::surface::intersect::curve_overlap::{Near, runs};
use crate::surface::intersect::sheet::{Cell, Sheet, solved};

/// What limits the search for meetings of a curve with a patch.
struct CurveLimits {
    /// Pairs looked at before giving up.
    max_pairs: usize,
    /// Share of the tolerance within which parts count as straight and cells as flat.
    flat_share: f64,
    /// A part that rises over the surface by no more than this many tolerances runs along it.
    divergence_tolerances: f64,
    /// Parts that run along the surface, at most, before they say nothing more.
    max_near: usize,
}

const SEARCH: CurveLimits = CurveLimits { max_pairs: 1_000_000, flat_share: 0.25, divergence_tolerances: 4.0, max_near: 1 << 14 };

/// A meeting with a patch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Contact {
    Point(CurveTouch),
    /// The curve runs within the tolerance of the surface between two parameters.
    Overlap {
        t: (f64, f64),
    },
}

/// A single place where they meet, or the curve touches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurveTouch {
    /// Parameter of the curve.
    pub t: f64,
    /// Place on the patch.
    pub uv: DVec2,
    /// The point of the curve.
    pub p: DVec3,
    /// Its distance from the surface.
    pub gap: f64,
    /// Sine of the angle to the tangent plane.
    pub sine: f64,
}

struct CurvePart<'a> {
    view: View<'a>,
    rates: Rates,
    section: usize,
}

pub(super) struct CurveSearch<'a> {
    pub curve: &'a Curve,
    pub sheet: &'a mut Sheet,
    pub point: f64,
    /// Longer ones that stay within the tolerance lie on the surface.
    pub long: f64,
    pub found: Vec<(usize, CurveTouch)>,
    near: Vec<Near>,
    looked_at: usize,
    exhausted: Option<DVec3>,
}

/// All meetings of a curve with a patch within a distance, unordered; the place where the search gave up when it did.
///
/// `long`: what stays within the distance for less is a touch.
pub(crate) fn contacts(curve: &Curve, sheet: &mut Sheet, point: f64, long: f64) -> Result<Vec<Contact>, DVec3> {
    let (found, near) = (Vec::new(), Vec::new());
    let mut search = CurveSearch { curve, sheet, point, long, found, near, looked_at: 0, exhausted: None };
    let count = curve.pieces().pieces.len();
    for root in search.sheet.roots.clone() {
        search.descend((0, 0, count), root);
    }
    if let Some(at) = search.exhausted {
        return Err(at);
    }
    Ok(search.settled())
}

impl CurveSearch<'_> {
    /// Pieces of the curve below a node of its tree against a cell.
    fn descend(&mut self, x: (usize, usize, usize), cell: usize) {
        let pieces = self.curve.pieces();
        if !pieces.bounds(x.0).touches(&self.sheet.cell(cell).bounds, self.point) {
            return;
        }
        if x.2 - x.1 == 1 {
            let piece = &pieces.pieces[x.1];
            let part = CurvePart { view: pieces.view_of(self.curve, piece.section), rates: piece.rates, section: piece.section };
            self.pair(&part, &piece.node, cell);
            return;
        }
        let (left, right, middle) = children(x.0, x.1, x.2);
        self.descend((left, x.1, middle), cell);
        self.descend((right, middle, x.2), cell);
    }

    fn pair(&mut self, part: &CurvePart, node: &Node, k: usize) {
        self.looked_at += 1;
        if self.exhausted.is_some() || self.sheet.is_outside(k) || apart(node, self.sheet.cell(k), self.point) {
            return;
        }
        if self.looked_at > SEARCH.max_pairs || self.near.len() > SEARCH.max_near {
            self.exhausted = Some(node.middle);
            return;
        }
        let cell = self.sheet.cell(k);
        let fine = node.bulge <= SEARCH.flat_share * self.point && cell.thick <= SEARCH.flat_share * self.point;
        let crossing = crosses(node, cell, self.point);
        if crossing {
            let (uv, t) = (cell.middle(), 0.5 * (node.t.0 + node.t.1));
            if let Some(touch) = self.newton(&part.view, uv, t)
                && touch.gap <= self.point
                && within(node, cell, &touch)
            {
                self.found.push((part.section, touch));
                return;
            }
        }
        let length = node.p.0.distance(node.p.1);
        if !crossing && !fine && length > self.long && cell.reach() <= 4.0 * length && self.lies(&part.view, node, cell) {
            let uv = self.sheet.patch.foot(node.middle, cell.middle()).0;
            self.near.push(Near { section: part.section, t: node.t, uv });
            return;
        }
        if fine {
            let cell = self.sheet.cell(k);
            if let Some(touch) = self.lowest(&part.view, node, cell) {
                if crossing {
                    self.found.push((part.section, touch));
                } else {
                    self.near.push(Near { section: part.section, t: node.t, uv: touch.uv });
                }
            }
            // Of flat parts that cross nothing more is to be had; of those along each other only small ones say where.
            return;
        }
        let first = if length > 4.0 * cell.reach() {
            true
        } else if cell.reach() > 4.0 * length {
            false
        } else {
            node.bulge >= cell.thick
        };
        self.split(part, node, k, first);
    }

    fn split(&mut self, part: &CurvePart, node: &Node, k: usize, first: bool) {
        if first && node.can_split() {
            for half in node.halves(&part.view, part.rates) {
                self.pair(part, &half, k);
            }
        } else if let Some((a, b)) = self.sheet.halves(k) {
            self.pair(part, node, a);
            self.pair(part, node, b);
        } else if node.can_split() {
            for half in node.halves(&part.view, part.rates) {
                self.pair(part, &half, k);
            }
        } else {
            self.near.push(Near { section: part.section, t: node.t, uv: self.sheet.cell(k).middle() });
        }
    }

    /// Newton's method for S(u, v) = C(t), held in the patch and the section.
    fn newton(&self, view: &View, uv: DVec2, t: f64) -> Option<CurveTouch> {
        const STEPS: usize = 24;
        let (patch, (low, high)) = (&self.sheet.patch, view.section.range);
        let (mut uv, mut t) = (uv, t);
        for _ in 0..STEPS {
            let (s, c) = (patch.jet(uv), view.jet(t));
            let step = solved(s.du, s.dv, -c.d1, c.p - s.p)?;
            let next = patch.hold(uv + DVec2::new(step.x, step.y));
            let there = (t + step.z).clamp(low, high);
            let still = (next - uv).abs().max_element() <= EPSILON && (there - t).abs() <= EPSILON * (high - low);
            (uv, t) = (next, there);
            if still {
                break;
            }
        }
        Some(self.touch(view, t, uv))
    }

    pub(super) fn touch(&self, view: &View, t: f64, uv: DVec2) -> CurveTouch {
        let (c, s) = (view.jet(t), self.sheet.patch.jet(uv));
        let sine = s.du.cross(s.dv).normalize_or_zero().dot(c.d1.normalize_or_zero()).abs();
        CurveTouch { t, uv, p: c.p, gap: c.p.distance(s.p), sine }
    }

    /// The least distance of a straight part and a flat cell, when it is within the tolerance.
    fn lowest(&self, view: &View, node: &Node, cell: &Cell) -> Option<CurveTouch> {
        const ROUNDS: usize = 32;
        let mut uv = cell.middle();
        let chord = node.p.1 - node.p.0;
        let mut share = 0.5;
        let mut best: Option<CurveTouch> = None;
        for _ in 0..ROUNDS {
            let t = node.t.0 + (node.t.1 - node.t.0) * share;
            let p = view.point(t);
            let (foot, _) = self.sheet.patch.foot(p, uv);
            uv = cell.hold(foot);
            let s = self.sheet.patch.jet(uv).p;
            let touch = self.touch(view, t, uv);
            let better = best.as_ref().is_none_or(|b| touch.gap < b.gap * (1.0 - NEWTON_STEP));
            if better {
                best = Some(touch);
            }
            // The foot of the surface's point on the chord.
            let next = ((s - node.p.0).dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
            if !next.is_finite() || !better && (next - share).abs() <= NEWTON_STEP {
                break;
            }
            share = next;
        }
        best.filter(|b| b.gap <= self.point)
    }

    /// What was found, with the parts that run along the surface worked out.
    fn settled(mut self) -> Vec<Contact> {
        let near = std::mem::take(&mut self.near);
        let mut out: Vec<Contact> = Vec::new();
        for run in runs(near) {
            self.resolve(&run, &mut out);
        }
        let pieces = self.curve.pieces();
        for (section, touch) in &self.found {
            let t = pieces.sections[*section].to_common(touch.t);
            out.push(Contact::Point(CurveTouch { t, ..*touch }));
        }
        out
    }

    /// Whether a part that does not cross lies on the surface from end to end: every one of a row of places does.
    fn lies(&self, view: &View, node: &Node, cell: &Cell) -> bool {
        const PLACES: usize = 9;
        let allowed = 0.5 * self.point;
        let mut uv = self.sheet.patch.foot(node.middle, cell.middle());
        if uv.1 > allowed {
            return false;
        }
        (0..PLACES).all(|k| {
            let t = node.t.0 + (node.t.1 - node.t.0) * k as f64 / (PLACES - 1) as f64;
            let p = view.point(t);
            let again = self.sheet.patch.foot(p, uv.0);
            uv = if again.1 <= allowed { again } else { self.sheet.patch.foot(p, cell.middle()) };
            uv.1 <= allowed
        })
    }
}

/// Whether a part of a curve and a cell are further apart than a distance.
fn apart(node: &Node, cell: &Cell, point: f64) -> bool {
    if !node.bounds().touches(&cell.bounds, point) {
        return true;
    }
    if cell.normal == DVec3::ZERO {
        return false;
    }
    let (range, a, b) = (cell.along(cell.normal), node.p.0.dot(cell.normal), node.p.1.dot(cell.normal));
    let reach = node.bulge + point;
    a.min(b) - reach > range.high || a.max(b) + reach < range.low
}

/// Whether no tangent of the part lies in a tangent plane of the cell: they meet once at most.
fn crosses(node: &Node, cell: &Cell, point: f64) -> bool {
    let (sine, cosine) = node.cone;
    if cosine <= 0.0 {
        return false;
    }
    let rise = cell.normals.along(node.axis);
    let least = if rise.low > 0.0 { rise.low } else { -rise.high };
    // n·t ≥ cos φ · n·axis − sin φ · |n × axis| for tangents t within φ of the axis.
    let across = cell.normals.cross(&crate::base::range::Interval3::at(node.axis)).reach();
    // A part that hardly rises over its length runs along the surface.
    let rises = node.p.0.distance(node.p.1) * least > SEARCH.divergence_tolerances * point * cell.normals.reach();
    rises && least * cosine > across * sine
}

fn within(node: &Node, cell: &Cell, touch: &CurveTouch) -> bool {
    let slack = (node.t.1 - node.t.0) / 64.0;
    node.t.0 - slack <= touch.t && touch.t <= node.t.1 + slack && cell.holds(touch.uv)
}
