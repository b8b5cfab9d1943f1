//! A face of a body made ready for any water plane: cells over which it is smooth, with boxes that hold them and their integrals.

use glam::DVec3;

use super::sums::{WHOLE, whole_densities};
use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::quadrature::gauss_legendre;
use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::{EPSILON, FLOAT_CELL, FLOAT_NET, FLOAT_ROUGH_CELL, MEASURE_ACCURACY, SLIVER, Tolerance};
use crate::base::work;
use crate::model::measure;
use crate::surface::{Domain, NetForm, Off, PreparedSurface, Surface, SurfaceKind};

/// Orders of the rules tried one after the other on a cell.
const ORDERS: [usize; 3] = [5, 8, 12];
/// Cells between breaks from which on a net stands for the surface.
const MANY: usize = 64;
/// A cell is halved at most so often in each direction.
const MAX_DEPTH: u32 = 8;
/// Cells that quartering may add, beside one for each there is.
const MOST_QUARTERS: usize = 1 << 9;
/// A rule comes nearer where it differs by less than this share of the difference before.
const NEARER: f64 = 0.25;

/// Low and high of one parameter.
pub type Span = (f64, f64);

/// A rectangle of the parameters of a face.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    /// Low and high of each parameter.
    pub sides: [Span; 2],
}

impl Rect {
    /// Its two halves along a parameter.
    pub fn halves(self, along: usize) -> [Self; 2] {
        let (a, b) = self.sides[along];
        let half = |side: Span| {
            let mut sides = self.sides;
            sides[along] = side;
            Self { sides }
        };
        [half((a, 0.5 * (a + b))), half((0.5 * (a + b), b))]
    }

    /// Its middle.
    pub fn middle(self) -> (f64, f64) {
        let [x, y] = self.sides;
        (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1))
    }

    /// Its four quarters.
    pub fn quarters(self) -> [Self; 4] {
        let [x, y] = self.sides;
        let halves = |(a, b): Span| [(a, 0.5 * (a + b)), (0.5 * (a + b), b)];
        let ([left, right], [below, above]) = (halves(x), halves(y));
        [[left, below], [right, below], [left, above], [right, above]].map(|sides| Self { sides })
    }
}

/// A part of a face with its integrals.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Where it is.
    pub rect: Rect,
    /// A box that holds it.
    pub bounds: Box3,
    /// Its integrals, as [`whole_densities`] has them, about the body's centre.
    pub sums: [f64; WHOLE],
    /// Estimated error of each as an area: divided by the powers of the body's reach in it.
    pub error: f64,
}

/// How a face is integrated where the water plane crosses it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Way {
    /// Cell by cell over its parameters.
    Cells,
    /// In its plane, from its border.
    Flat,
    /// From its border, by rows along u.
    Rows,
}

/// A face, its normals outwards.
#[derive(Clone, Debug)]
pub struct Face {
    /// The surface, with whether its normals point inwards.
    pub prepared: PreparedSurface,
    /// −1 where the normals of the surface point inwards.
    pub sign: f64,
    /// How it is integrated.
    pub way: Way,
    /// Its cells; one of the whole face where it is not integrated by cells.
    pub cells: Vec<Cell>,
}

impl Face {
    /// A face of a body of a reach (half its diagonal, model units) about a centre.
    pub fn new(surface: &Surface, inwards: bool, about: DVec3, reach: f64) -> Self {
        let sign = if inwards { -1.0 } else { 1.0 };
        let flat = surface.kind() == SurfaceKind::Plane || surface.is_flat();
        let way = match surface.domain() {
            _ if flat => Way::Flat,
            Domain::Loop => Way::Rows,
            _ => Way::Cells,
        };
        let mut face = Self { prepared: surface.prepared(), sign, way, cells: Vec::new() };
        if face.way == Way::Cells {
            let off = face.simplified(surface, reach);
            face.make_cells(about, reach);
            face.cells.iter_mut().for_each(|cell| cell.error += cell.sums[0] * off / reach);
        } else {
            let density = |jet: &crate::surface::Jet2, arm: DVec3| whole_densities(arm, jet.du.cross(jet.dv) * sign);
            let (sums, errors) = measure::over(surface, about, MEASURE_ACCURACY, &density);
            let rect = Rect { sides: [(0.0, 1.0); 2] };
            face.cells = vec![Cell { rect, bounds: surface.hull(), sums, error: as_area(&errors, reach) }];
        }
        face
    }

    /// Replaces a surface that is blended from many curves by a net, which is cheaper to evaluate. Returns a bound of the distance between
    /// the two, model units.
    fn simplified(&mut self, surface: &Surface, reach: f64) -> f64 {
        let (us, vs) = surface.breaks();
        let plain = self.prepared.evaluator().has_power_form() || surface.domain() != Domain::Square;
        if plain || (us.len() + 1) * (vs.len() + 1) < MANY {
            return 0.0;
        }
        let tolerance = Tolerance::new(FLOAT_NET * reach, reach);
        match surface.to_net(&tolerance) {
            Ok(Some(NetForm { net, off: Off::Bounded(off) })) => {
                self.prepared = net.surface(surface.kind(), surface.origin(), &tolerance).prepared();
                off
            }
            _ => 0.0,
        }
    }

    /// Point and first derivatives at a place of the unit square.
    #[inline]
    pub fn tangents(&self, x: f64, y: f64) -> [DVec3; 3] {
        let evaluator = self.prepared.evaluator();
        if self.prepared.surface().domain() == Domain::Triangle {
            let jet = evaluator.square_jet(x, y);
            return [jet.p, jet.du, jet.dv];
        }
        evaluator.tangents(x, y)
    }

    /// Point and area vector outwards.
    #[inline]
    pub fn element(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let [p, du, dv] = self.tangents(x, y);
        (p, du.cross(dv) * self.sign)
    }

    /// Ranges that hold all points and first derivatives over a rectangle.
    pub fn ranges(&self, rect: &Rect) -> [Interval3; 3] {
        let surface = self.prepared.surface();
        let [x, y] = rect.sides;
        if surface.domain() != Domain::Triangle {
            let known = surface.enclosure(x, y);
            return [known.p, known.du, known.dv];
        }
        // u = x (1 − y), v = y.
        let known = surface.enclosure((x.0 * (1.0 - y.1), x.1 * (1.0 - y.0)), y);
        let (shrunk, moved) = (Interval { low: 1.0 - y.1, high: 1.0 - y.0 }, Interval { low: x.0, high: x.1 });
        [known.p, known.du * shrunk, known.dv - known.du * moved]
    }

    /// The sum of a rule over a rectangle.
    pub fn product<const N: usize>(&self, rect: &Rect, rule: &[(f64, f64)], density: &impl Fn(DVec3, DVec3) -> [f64; N]) -> [f64; N] {
        let [x, y] = rect.sides;
        let weight = 0.25 * (x.1 - x.0) * (y.1 - y.0);
        let on = |(a, b): Span, t: f64| 0.5 * (a + b) + 0.5 * (b - a) * t;
        let mut sum = [0.0; N];
        let mut add = |weight: f64, (p, n): (DVec3, DVec3)| {
            let value = density(p, n);
            (0..N).for_each(|k| sum[k] += weight * value[k]);
        };
        if self.prepared.evaluator().has_power_form() {
            for (ty, wy) in rule {
                for (tx, wx) in rule {
                    add(weight * wx * wy, self.element(on(x, *tx), on(y, *ty)));
                }
            }
            return sum;
        }
        // Curves of the face are evaluated once a row and a column.
        let places = |side: Span| rule.iter().map(|(t, _)| on(side, *t)).collect::<Vec<f64>>();
        let jets = self.prepared.surface().square_jets(&places(x), &places(y));
        for (k, jet) in jets.iter().enumerate() {
            let own = weight * rule[k % rule.len()].1 * rule[k / rule.len()].1;
            add(own, (jet.p, jet.du.cross(jet.dv) * self.sign));
        }
        sum
    }

    fn make_cells(&mut self, about: DVec3, reach: f64) {
        let surface = self.prepared.surface();
        let (us, vs) = surface.breaks();
        // A triangle's lines do not follow the square.
        let us = if surface.domain() == Domain::Triangle { Vec::new() } else { us };
        let (us, vs) = (spans(&us), spans(&vs));
        let rules = ORDERS.map(gauss_legendre);
        let density = |p: DVec3, n: DVec3| whole_densities(p - about, n);
        let mut open: Vec<(Rect, u32)> = vs.iter().rev().flat_map(|y| us.iter().rev().map(|x| (Rect { sides: [*x, *y] }, 0))).collect();
        let mut left = open.len() + MOST_QUARTERS;
        while let Some((rect, depth)) = open.pop() {
            job::poll();
            work::spend(32);
            let (mut sums, mut apart) = (self.product(&rect, &rules[0], &density), [f64::INFINITY; WHOLE]);
            let mut settled = false;
            for rule in &rules[1..] {
                let (next, before) = (self.product(&rect, rule, &density), apart);
                apart = std::array::from_fn(|k| (next[k] - sums[k]).abs());
                sums = next;
                let nearer = apart.iter().zip(before).all(|(a, b)| *a <= NEARER * b);
                settled = is_settled(&apart, sums[0], reach, FLOAT_CELL) || !nearer && is_settled(&apart, sums[0], reach, FLOAT_ROUGH_CELL);
                if settled {
                    break;
                }
            }
            if settled || depth == MAX_DEPTH || left < 4 {
                let bounds = self.ranges(&rect)[0].bounds();
                self.cells.push(Cell { rect, bounds, sums, error: as_area(&apart, reach) });
            } else {
                left -= 4;
                open.extend(rect.quarters().into_iter().rev().map(|quarter| (quarter, depth + 1)));
            }
        }
    }
}

/// The largest of some differences, each divided by the powers of the body's reach in it.
fn as_area(apart: &[f64; WHOLE], reach: f64) -> f64 {
    let power = |k: usize| {
        if k < 4 {
            1.0
        } else if k < 13 {
            reach
        } else {
            reach * reach
        }
    };
    apart.iter().enumerate().map(|(k, a)| a / power(k)).fold(0.0, f64::max)
}

/// Whether two rules agree on a cell of an area: each power of the arm is as large as the body's reach.
fn is_settled(apart: &[f64; WHOLE], area: f64, reach: f64, accuracy: f64) -> bool {
    as_area(apart, reach) <= accuracy * (area + SLIVER * reach * reach)
}

/// The intervals between 0, inner stops and 1.
fn spans(inner: &[f64]) -> Vec<Span> {
    let inside = inner.iter().copied().filter(|x| *x > EPSILON && *x < 1.0 - EPSILON);
    let stops: Vec<f64> = std::iter::once(0.0).chain(inside).chain([1.0]).collect();
    stops.windows(2).map(|w| (w[0], w[1])).collect()
}
