//! A surface cut into cells with guaranteed bounds, finer where they are asked for.

use glam::{DMat3, DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::{EPSILON, SINGULAR};
use crate::surface::closest::foot::{self, FootSearch};
use crate::surface::core::plane;
use crate::surface::core::surface::Surface;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;

/// A part of a surface over a rectangle of (u, v) inside which it has no kink.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub surface: Surface,
    pub u: (f64, f64),
    pub v: (f64, f64),
}

impl Patch {
    /// Whether the domain is a triangle.
    pub fn is_triangle(&self) -> bool {
        self.surface.ground() == Domain::Triangle
    }

    /// Its border lines: a fixed u or v, or the slant of a triangle.
    pub fn lines(&self) -> Vec<BorderLine> {
        if self.is_triangle() {
            return vec![BorderLine::U(0.0), BorderLine::V(0.0), BorderLine::Slant];
        }
        vec![BorderLine::U(self.u.0), BorderLine::U(self.u.1), BorderLine::V(self.v.0), BorderLine::V(self.v.1)]
    }
}

impl FootSearch for Patch {
    /// Point and derivatives from inside the patch.
    fn jet(&self, uv: DVec2) -> Jet2 {
        let side = |x: f64, high: f64| if x >= high { OneSided::Before } else { OneSided::After };
        self.surface.jet_one_sided(uv.x, uv.y, (side(uv.x, self.u.1), side(uv.y, self.v.1)))
    }

    /// The nearest place of the patch.
    fn hold(&self, uv: DVec2) -> DVec2 {
        let held = DVec2::new(uv.x.clamp(self.u.0, self.u.1), uv.y.clamp(self.v.0, self.v.1));
        if !self.is_triangle() || held.x + held.y <= 1.0 {
            return held;
        }
        let over = 0.5 * (held.x + held.y - 1.0);
        let (u, v) = (held.x - over, held.y - over);
        // Off the slant at one end.
        DVec2::new(u.max(0.0) + v.min(0.0), v.max(0.0) + u.min(0.0)).clamp(DVec2::ZERO, DVec2::ONE)
    }

    /// The step in (u, v) whose image is a vector's tangential part, along a border where it would leave the patch there.
    fn step(&self, jet: &Jet2, uv: DVec2, d: DVec3) -> Option<DVec2> {
        let full = foot::step(jet.du, jet.dv, d)?;
        let out = |x: f64, step: f64, (low, high): (f64, f64)| x <= low && step < 0.0 || x >= high && step > 0.0;
        let (out_u, out_v) = (out(uv.x, full.x, self.u), out(uv.y, full.y, self.v));
        let one = |direction: DVec3| d.dot(direction) / direction.length_squared();
        let step = match (out_u, out_v) {
            (true, false) => DVec2::new(0.0, one(jet.dv)),
            (false, true) => DVec2::new(one(jet.du), 0.0),
            _ if self.is_triangle() && uv.x + uv.y >= 1.0 && full.x + full.y > 0.0 => {
                let along = one(jet.dv - jet.du);
                DVec2::new(-along, along)
            }
            _ => full,
        };
        step.is_finite().then_some(step)
    }
}

/// A border of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BorderLine {
    U(f64),
    V(f64),
    Slant,
}

impl BorderLine {
    /// How far a place is on the inner side, negative outside; `patch` says which side that is.
    pub fn inside(self, patch: &Patch, uv: DVec2) -> f64 {
        match self {
            Self::U(u) if u == patch.u.0 => uv.x - u,
            Self::U(u) => u - uv.x,
            Self::V(v) if v == patch.v.0 => uv.y - v,
            Self::V(v) => v - uv.y,
            Self::Slant => 1.0 - uv.x - uv.y,
        }
    }

    /// The place on the line that is meant by one near it.
    pub fn onto(self, uv: DVec2) -> DVec2 {
        match self {
            Self::U(u) => DVec2::new(u, uv.y),
            Self::V(v) => DVec2::new(uv.x, v),
            Self::Slant => {
                let over = 0.5 * (uv.x + uv.y - 1.0);
                let u = (uv.x - over).clamp(0.0, 1.0);
                DVec2::new(u, 1.0 - u)
            }
        }
    }

    /// Its direction in (u, v).
    pub fn along(self) -> DVec2 {
        match self {
            Self::U(_) => DVec2::Y,
            Self::V(_) => DVec2::X,
            Self::Slant => DVec2::new(-1.0, 1.0),
        }
    }
}

/// A rectangle of a patch with what is known of the surface over it.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub u: (f64, f64),
    pub v: (f64, f64),
    pub enclosure: Enclosure,
    /// Box of its points.
    pub bounds: Box3,
    /// Unit normal in the middle; zero where there is none.
    pub normal: DVec3,
    /// All vectors du × dv.
    pub normals: Interval3,
    /// How far points are from the tangent plane of the middle, at most.
    pub thick: f64,
    /// Lengths along u and v, at most.
    pub size: (f64, f64),
    halves: Option<(usize, usize)>,
}

impl Cell {
    pub fn new(patch: &Patch, u: (f64, f64), v: (f64, f64)) -> Self {
        Self::of(patch.surface.enclosure(u, v), u, v)
    }

    /// From bounds over the rectangle.
    pub fn of(enclosure: Enclosure, u: (f64, f64), v: (f64, f64)) -> Self {
        let normals = enclosure.du.cross(&enclosure.dv);
        let mid = enclosure.mid.du.cross(enclosure.mid.dv);
        let scale = enclosure.mid.du.length() * enclosure.mid.dv.length();
        let normal = if mid.length() > SINGULAR * scale { mid.normalize_or_zero() } else { DVec3::ZERO };
        let (a, b) = enclosure.half;
        let most = |r: &Interval3| if r.is_unbounded() { f64::INFINITY } else { r.reach() };
        let thick = 0.5 * a * a * most(&enclosure.duu) + a * b * most(&enclosure.duv) + 0.5 * b * b * most(&enclosure.dvv);
        let size = (2.0 * a * most(&enclosure.du), 2.0 * b * most(&enclosure.dv));
        Self { u, v, bounds: enclosure.p.bounds(), normal, normals, thick, size, enclosure, halves: None }
    }

    /// Its middle in (u, v).
    pub fn middle(&self) -> DVec2 {
        DVec2::new(0.5 * (self.u.0 + self.u.1), 0.5 * (self.v.0 + self.v.1))
    }

    /// Larger of the two lengths.
    pub fn reach(&self) -> f64 {
        self.size.0.max(self.size.1)
    }

    /// Range of the points along a vector.
    pub fn along(&self, n: DVec3) -> Interval {
        let (s, (a, b)) = (&self.enclosure, self.enclosure.half);
        let (ra, rb) = (Interval::around_zero(a), Interval::around_zero(b));
        let square = |h: f64| Interval { low: 0.0, high: 0.5 * h * h };
        let bent = s.duu.along(n) * square(a) + s.duv.along(n) * Interval::around_zero(a * b) + s.dvv.along(n) * square(b);
        let straight = Interval::at(s.mid.p.dot(n)) + ra * s.mid.du.dot(n) + rb * s.mid.dv.dot(n);
        (straight + bent).intersection(s.p.along(n))
    }

    /// Whether a place lies in it, with a slack in parameters.
    pub fn holds(&self, uv: DVec2) -> bool {
        let slack = |(low, high): (f64, f64)| (high - low) * CELL_SLACK;
        let (a, b) = (slack(self.u), slack(self.v));
        self.u.0 - a <= uv.x && uv.x <= self.u.1 + a && self.v.0 - b <= uv.y && uv.y <= self.v.1 + b
    }

    /// The nearest place in it.
    pub fn hold(&self, uv: DVec2) -> DVec2 {
        DVec2::new(uv.x.clamp(self.u.0, self.u.1), uv.y.clamp(self.v.0, self.v.1))
    }
}

/// Places this share of a cell beyond its border still count as in it.
const CELL_SLACK: f64 = 1.0 / 64.0;

/// All cells of a patch made so far.
#[derive(Debug)]
pub(crate) struct Sheet {
    pub patch: Patch,
    cells: Vec<Cell>,
    /// Cells between breaks.
    pub roots: Vec<usize>,
    /// Where it is cut when halved is left alone: narrower than this share of the patch.
    least: (f64, f64),
}

impl Sheet {
    /// The cells between the surface's breaks.
    pub fn new(patch: Patch) -> Self {
        let (us, vs) = patch.surface.breaks();
        let stops = |(low, high): (f64, f64), inner: &[f64]| {
            let inside = inner.iter().copied().filter(|x| *x > low + EPSILON && *x < high - EPSILON);
            std::iter::once(low).chain(inside).chain(std::iter::once(high)).collect::<Vec<_>>()
        };
        let (us, vs) = (stops(patch.u, &us), stops(patch.v, &vs));
        let mut cells = Vec::new();
        for v in vs.windows(2) {
            for u in us.windows(2) {
                if !patch.is_triangle() || u[0] + v[0] < 1.0 {
                    cells.push(Cell::new(&patch, (u[0], u[1]), (v[0], v[1])));
                }
            }
        }
        let roots = (0..cells.len()).collect();
        let least = (EPSILON * (patch.u.1 - patch.u.0), EPSILON * (patch.v.1 - patch.v.0));
        Self { patch, cells, roots, least }
    }

    pub fn cell(&self, k: usize) -> &Cell {
        &self.cells[k]
    }

    /// The cells of a halved one that lie in the domain; none where it is too small.
    pub fn halves(&mut self, k: usize) -> Option<(usize, usize)> {
        if let Some(halves) = self.cells[k].halves {
            return Some(halves);
        }
        let (u, v) = (self.cells[k].u, self.cells[k].v);
        let along_u = {
            let cell = &self.cells[k];
            let (a, b) = cell.enclosure.half;
            let bend = |r: &Interval3, h: f64| if r.is_unbounded() { f64::INFINITY } else { r.reach() * h * h };
            let (bend_u, bend_v) = (bend(&cell.enclosure.duu, a), bend(&cell.enclosure.dvv, b));
            // The longer way, unless only the other one is bent and it is not much shorter.
            const SHORTER: f64 = 16.0;
            let score = |size: f64, bend: f64, other: f64| if bend > other { size * SHORTER } else { size };
            score(cell.size.0, bend_u, SHORTER * bend_v) >= score(cell.size.1, bend_v, SHORTER * bend_u)
        };
        let can = (u.1 - u.0 > self.least.0, v.1 - v.0 > self.least.1);
        let along_u = match can {
            (true, true) => along_u,
            (true, false) => true,
            (false, true) => false,
            (false, false) => return None,
        };
        let (mu, mv) = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
        let (first, second) = if along_u { (((u.0, mu), v), ((mu, u.1), v)) } else { ((u, (v.0, mv)), (u, (mv, v.1))) };
        let at = self.cells.len();
        self.cells.push(Cell::new(&self.patch, first.0, first.1));
        self.cells.push(Cell::new(&self.patch, second.0, second.1));
        self.cells[k].halves = Some((at, at + 1));
        Some((at, at + 1))
    }

    /// Whether a side of a cell is part of a border of the patch.
    pub fn is_at_border(&self, k: usize) -> bool {
        let (cell, patch) = (&self.cells[k], &self.patch);
        let slant = patch.is_triangle() && cell.u.1 + cell.v.1 >= 1.0;
        let at = |own: (f64, f64), all: (f64, f64)| own.0 <= all.0 || own.1 >= all.1;
        slant || at(cell.u, patch.u) || at(cell.v, patch.v)
    }

    /// Whether a cell lies outside a triangle.
    pub fn is_outside(&self, k: usize) -> bool {
        self.patch.is_triangle() && self.cells[k].u.0 + self.cells[k].v.0 >= 1.0
    }

    /// The box of everything.
    pub fn bounds(&self) -> Box3 {
        self.roots.iter().fold(Box3::EMPTY, |all, k| all.union(self.cells[*k].bounds))
    }
}

/// The patches between kink lines of a surface without its trimming.
pub(crate) fn patches(surface: &Surface) -> Vec<Patch> {
    let surface = surface.untrimmed();
    let (us, vs) = surface.kinks();
    let stops = |inner: &[f64]| [&[0.0], inner, &[1.0]].concat();
    let (us, vs) = (stops(us), stops(vs));
    let mut all = Vec::new();
    for v in vs.windows(2) {
        for u in us.windows(2) {
            all.push(Patch { surface: surface.clone(), u: (u[0], u[1]), v: (v[0], v[1]) });
        }
    }
    all
}

/// The part of an unbounded plane over a box, or a plane face over the box of its border, as a square.
pub(crate) fn grounded(surface: &Surface, reach: Box3) -> Surface {
    match surface.ground() {
        Domain::Unbounded => plane::over(surface, reach),
        Domain::Loop => plane::squared(surface),
        Domain::Square | Domain::Triangle => surface.untrimmed(),
    }
}

/// The same where only points are asked for: of a plane face a larger square, since where its border touches a side of the
/// smaller one a curve along that border would end.
pub(crate) fn widely_grounded(surface: &Surface, reach: Box3) -> Surface {
    if surface.ground() == Domain::Loop { plane::widened(surface) } else { grounded(surface, reach) }
}

/// Where a straight step in both tangent planes and across leads: solves `a x + b y + c z = d`.
pub(crate) fn solved(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<DVec3> {
    let m = DMat3::from_cols(a, b, c);
    let x = m.inverse() * d;
    x.is_finite().then_some(x)
}
