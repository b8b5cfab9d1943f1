//! Smooth pieces of a curve with guaranteed bounds, and a tree of boxes over them.
//!
//! A piece knows how fast its direction may turn (`turn`) and how large its second derivative may get (`bend`).
//! From these follow, for it and for every part of it, a cone that holds all tangents and a distance from the chord
//! that no point exceeds. Nothing here is sampled.

use crate::geometry::shapes::bounds::Rates;
use glam::{DVec3, DVec4};

use crate::base::bbox::Box3;
use crate::base::inline_list::InlineList;
use crate::base::math;
use crate::base::tolerance::EPSILON;
use crate::geometry::curves::curve::{Curve, Shape};
use crate::geometry::data::jet::Jet;
use crate::geometry::shapes::arc::EllipticArc;
use crate::geometry::shapes::bounds;
use crate::geometry::shapes::nurbs_edit::Bezier;

/// Pieces are halved until their tangents lie within this angle of the one in the middle, radians.
const SPREAD: f64 = 0.3;
/// A piece of a spline is halved at most this often; what is left then holds a cusp.
const DEPTH: u32 = 24;
/// Pieces of one polynomial or rational part at most: more say nothing that the bounds of fewer do not.
const MOST: usize = 1 << 12;
/// A piece shorter than this many roundings of its coordinates has no direction.
const STILL: f64 = 8.0;

/// A smooth part of a curve between corners: where a Newton iteration may wander.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    /// Index of the piece of a composite curve, else 0.
    pub(crate) part: usize,
    /// Its ends in that piece's own parameter.
    pub(crate) range: (f64, f64),
    /// Its ends in the whole curve's parameter.
    pub(crate) common: (f64, f64),
    /// Its end points.
    pub(crate) ends: (DVec3, DVec3),
}

impl Section {
    /// The whole curve's parameter at the own parameter `t`.
    pub(crate) fn to_common(self, t: f64) -> f64 {
        if t <= self.range.0 {
            self.common.0
        } else if t >= self.range.1 {
            self.common.1
        } else {
            (self.common.0 + (t - self.range.0)).clamp(self.common.0, self.common.1)
        }
    }
}

/// A section together with the curve that evaluates it.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) curve: &'a Curve,
    pub(crate) section: &'a Section,
}

impl View<'_> {
    /// Point and derivatives from inside the section, also at its ends.
    #[inline]
    pub(crate) fn jet(&self, t: f64) -> Jet {
        if t >= self.section.range.1 { self.curve.jet_before(t) } else { self.curve.jet(t) }
    }

    pub(crate) fn point(&self, t: f64) -> DVec3 {
        self.jet(t).p
    }

    /// Whether `t` is an end of the section.
    pub(crate) fn at_end(&self, t: f64) -> bool {
        t <= self.section.range.0 || t >= self.section.range.1
    }
}

/// A part of a curve: ends, middle and what bounds it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// First and last own parameter.
    pub(crate) t: (f64, f64),
    /// First and last point.
    pub(crate) p: (DVec3, DVec3),
    /// The point at the middle parameter.
    pub(crate) middle: DVec3,
    /// Unit tangent there; zero when there is no cone.
    pub(crate) axis: DVec3,
    /// Sine and cosine of the angle within which all tangents are to the axis; cosine ≤ 0: anywhere.
    pub(crate) cone: (f64, f64),
    /// No point is further from the chord.
    pub(crate) bulge: f64,
}

impl Node {
    /// The part between two parameters whose end points are known.
    pub(crate) fn new(view: &View, t: (f64, f64), p: (DVec3, DVec3), rates: Rates) -> Self {
        let h = t.1 - t.0;
        let at = view.curve.jet(t.0 + 0.5 * h);
        let half_angle = 0.5 * h * rates.turn;
        let chord = p.0.distance(p.1);
        let (mut axis, mut cone) = (DVec3::ZERO, (1.0, 0.0));
        let mut bulge = Self::most_bulge(t, rates);
        if half_angle < std::f64::consts::FRAC_PI_2 {
            axis = at.d1.normalize_or_zero();
            cone = if axis == DVec3::ZERO { (1.0, 0.0) } else { math::sin_cos(half_angle) };
            // Tangents within the cone keep the curve within chord/2 · tan(half_angle) of the chord.
            if cone.1 > 0.0 {
                bulge = bulge.min(0.5 * chord * cone.0 / cone.1);
            }
        }
        Self { t, p, middle: at.p, axis, cone, bulge }
    }

    /// What the second derivative allows: no part between these parameters bulges more.
    #[inline]
    pub(crate) fn most_bulge(t: (f64, f64), rates: Rates) -> f64 {
        let h = t.1 - t.0;
        rates.bend * h * h * 0.125
    }

    /// Parameters and end points of both halves.
    #[inline]
    pub(crate) fn half_ends(&self) -> [((f64, f64), (DVec3, DVec3)); 2] {
        let t = 0.5 * (self.t.0 + self.t.1);
        [((self.t.0, t), (self.p.0, self.middle)), ((t, self.t.1), (self.middle, self.p.1))]
    }

    /// Both halves.
    pub(crate) fn halves(&self, view: &View, rates: Rates) -> [Self; 2] {
        self.half_ends().map(|(t, p)| Self::new(view, t, p, rates))
    }

    /// The box of the chord grown by the bulge.
    pub(crate) fn bounds(&self) -> Box3 {
        let chord = Box3::of([self.p.0, self.p.1]);
        Box3 { min: chord.min - DVec3::splat(self.bulge), max: chord.max + DVec3::splat(self.bulge) }
    }

    /// Whether its parameters can still be halved.
    pub(crate) fn can_split(&self) -> bool {
        let scale = self.t.0.abs().max(self.t.1.abs());
        self.t.1 - self.t.0 > 4.0 * EPSILON * scale
    }
}

/// A node of the first level with its rates and section.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) node: Node,
    pub(crate) rates: Rates,
    pub(crate) section: usize,
}

/// All pieces of one curve in order, and boxes over runs of them.
#[derive(Clone, Debug)]
pub(crate) struct Pieces {
    pub(crate) sections: InlineList<Section, 1>,
    pub(crate) pieces: InlineList<Piece, 1>,
    /// Boxes in preorder: node, left half of its pieces, right half.
    tree: InlineList<Box3, 1>,
}

/// Sections and pieces on their way.
#[derive(Default)]
struct Cut {
    sections: Vec<Section>,
    pieces: Vec<Piece>,
}

impl Pieces {
    /// Cuts a curve at its corners and where its direction has turned far enough.
    pub(crate) fn of(curve: &Curve) -> Self {
        if let Shape::Line(..) = curve.shape() {
            return Self::of_line(curve);
        }
        let mut cut = Cut::default();
        match curve.composite() {
            Some(c) => c.pieces.iter().enumerate().for_each(|(i, piece)| cut.add(piece, i, |t| c.common(i, t))),
            None => cut.add(curve, 0, |t| t),
        }
        let mut tree = vec![Box3::EMPTY; 2 * cut.pieces.len() - 1];
        grow_tree(&cut.pieces, &mut tree, 0, 0, cut.pieces.len());
        Self { sections: cut.sections.into(), pieces: cut.pieces.into(), tree: tree.into() }
    }

    /// The one piece of a straight line, without a list on the heap: in models of very many lines most are asked for once.
    fn of_line(curve: &Curve) -> Self {
        let (range, rates) = (curve.domain(), Rates { turn: 0.0, bend: 0.0 });
        let section = Section { part: 0, range, common: range, ends: (curve.point(range.0), curve.point(range.1)) };
        let node = Node::new(&View { curve, section: &section }, range, section.ends, rates);
        Self { sections: [section].into(), pieces: [Piece { node, rates, section: 0 }].into(), tree: [node.bounds()].into() }
    }

    /// The box of the tree's node `at`.
    #[inline]
    pub(crate) fn bounds(&self, at: usize) -> &Box3 {
        &self.tree[at]
    }

    /// Section `index` as something that can be evaluated.
    #[inline]
    pub(crate) fn view_of<'a>(&'a self, curve: &'a Curve, index: usize) -> View<'a> {
        let section = &self.sections[index];
        View { curve: curve.composite().map_or(curve, |c| &c.pieces[section.part]), section }
    }
}

impl Cut {
    fn add(&mut self, curve: &Curve, part: usize, common: impl Fn(f64) -> f64) {
        let (a, b) = curve.domain();
        let mut ends = vec![a];
        ends.extend(curve.inner_corners());
        ends.push(b);
        for pair in ends.windows(2) {
            let (range, outer) = ((pair[0], pair[1]), (common(pair[0]), common(pair[1])));
            let ends = (curve.point(range.0), curve.point(range.1));
            let section = Section { part, range, common: outer, ends };
            self.sections.push(section);
            let view = View { curve, section: &section };
            for (t0, t1, rates) in rated(curve, section.range) {
                let node = Node::new(&view, (t0, t1), (view.point(t0), view.point(t1)), rates);
                self.pieces.push(Piece { node, rates, section: self.sections.len() - 1 });
            }
        }
    }
}

fn grow_tree(pieces: &[Piece], tree: &mut [Box3], at: usize, low: usize, high: usize) -> Box3 {
    let bounds = if high - low == 1 {
        pieces[low].node.bounds()
    } else {
        let (left, right, middle) = children(at, low, high);
        grow_tree(pieces, tree, left, low, middle).union(grow_tree(pieces, tree, right, middle, high))
    };
    tree[at] = bounds;
    bounds
}

/// Tree nodes of both halves of a node over the pieces `low..high`, and where they part.
#[inline]
pub(crate) fn children(at: usize, low: usize, high: usize) -> (usize, usize, usize) {
    let middle = low + (high - low) / 2;
    (at + 1, at + 2 * (middle - low), middle)
}

/// Pieces of a simple curve's section with their rates.
fn rated(curve: &Curve, range: (f64, f64)) -> Vec<(f64, f64, Rates)> {
    match curve.shape() {
        Shape::Line(..) | Shape::Composite(_) => vec![(range.0, range.1, Rates { turn: 0.0, bend: 0.0 })],
        Shape::Arc(arc) => rated_arc(arc, range),
        Shape::Helix(helix) => {
            let bend = helix.u.length();
            even(range, Rates { turn: bend / helix.speed(), bend })
        }
        // An offset runs with its base: same directions, and points by way of the cone.
        Shape::Offset(offset) => {
            rated(&offset.base, range).into_iter().map(|(a, b, r)| (a, b, Rates { bend: f64::INFINITY, ..r })).collect()
        }
        Shape::Nurbs(c) => {
            let mut out = Vec::new();
            for piece in c.beziers_from(range) {
                // A cusp parts sections inside a span.
                if piece.t1 > range.1 {
                    rated_bezier(part_of(c, (piece.t0, range.1)), c.polynomial, &mut out);
                } else {
                    rated_bezier(piece, c.polynomial, &mut out);
                }
            }
            if out.first().is_none_or(|first| first.0 > range.0) {
                let end = out.first().map_or(range.1, |first| first.0);
                let mut first = Vec::new();
                rated_bezier(part_of(c, (range.0, end)), c.polynomial, &mut first);
                first.append(&mut out);
                out = first;
            }
            out
        }
    }
}

fn part_of(c: &crate::geometry::shapes::nurbs::Nurbs, (t0, t1): (f64, f64)) -> Bezier {
    Bezier { t0, t1, poles: c.part(t0, t1).poles }
}

fn even((a, b): (f64, f64), rates: Rates) -> Vec<(f64, f64, Rates)> {
    let count = (((b - a) * rates.turn / (2.0 * SPREAD)).ceil() as usize).max(1);
    let at = |i: usize| if i == count { b } else { a + (b - a) * i as f64 / count as f64 };
    (0..count).map(|i| (at(i), at(i + 1), rates)).collect()
}

fn rated_arc(arc: &EllipticArc, range: (f64, f64)) -> Vec<(f64, f64, Rates)> {
    if let Some(radius) = arc.radius {
        return even(range, Rates { turn: 1.0, bend: radius });
    }
    let (uu, vv, uv) = (arc.u.length_squared(), arc.v.length_squared(), arc.u.dot(arc.v));
    // Squared half-axes: eigenvalues of the Gram matrix of u and v.
    let (mean, radius) = (0.5 * (uu + vv), math::hypot(0.5 * (uu - vv), uv));
    let (long, area) = ((mean + radius).sqrt(), arc.u.cross(arc.v).length());
    let short = area / long;
    let mut out = Vec::new();
    let mut open = vec![range];
    while let Some((a, b)) = open.pop() {
        let middle = 0.5 * (a + b);
        let speed = (arc.jet(middle).d1.length() - 0.5 * (b - a) * long).max(short);
        // The square of the speed near the tip of an ellipse that is all but flat may be too small for a number.
        let rates = Rates { turn: area / speed / speed, bend: long };
        // There a piece may be no longer than its numbers are exact.
        let can_split = a < middle && middle < b;
        if 0.5 * (b - a) * rates.turn <= SPREAD || !can_split {
            out.push((a, b, rates));
        } else {
            open.push((middle, b));
            open.push((a, middle));
        }
    }
    out
}

fn rated_bezier(piece: Bezier, polynomial: bool, out: &mut Vec<(f64, f64, Rates)>) {
    let most = out.len() + MOST;
    let mut open = vec![(piece, 0)];
    while let Some((piece, depth)) = open.pop() {
        let rates = bounds::rates(&piece, polynomial);
        let still = is_still(&piece.poles) || out.len() >= most;
        if still || depth == DEPTH || 0.5 * (piece.t1 - piece.t0) * rates.turn <= SPREAD {
            out.push((piece.t0, piece.t1, rates));
        } else {
            let (left, right) = piece.halves();
            open.push((right, depth + 1));
            open.push((left, depth + 1));
        }
    }
}

/// Whether a piece is no longer than its numbers are exact (poles in one place, or not numbers): it has no direction.
fn is_still(poles: &[DVec4]) -> bool {
    let place = |q: &DVec4| q.truncate() / q.w;
    let first = place(&poles[0]);
    let reach = poles.iter().map(|q| (place(q) - first).abs().max_element()).fold(0.0, f64::max);
    reach.is_nan() || first.is_nan() || reach <= STILL * EPSILON * first.abs().max_element()
}
