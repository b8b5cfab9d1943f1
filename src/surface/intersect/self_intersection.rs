//! Where faces cross themselves and each other: halving with guaranteed bounds, Newton's method where two parts may cross.
//!
//! A part has no two places in one point where all vectors product of a ∂u and a ∂v of it are on one side of a plane: the chord of two
//! places is a mean ∂u times the step in u and a mean ∂v times that in v. The same holds of two parts side by side, over a crease and
//! over a seam too, because a way from one to the other leads through both with neither parameter turning back. Whatever cannot be told
//! so is halved; parts that are apart are left, and of the others a place in both of them is a crossing.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::range::Interval3;
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::surface::core::enclosure::Strip;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::intersect::pair::Pair;
use crate::surface::intersect::patch_pair::{apart, crosses, inside};
use crate::surface::intersect::sheet::{Cell, Patch, patches};
use crate::surface::rails::side::Side;

/// What limits the search for self-intersections.
struct SelfLimits {
    /// Pairs that are looked at, at most.
    max_pairs: usize,
    /// Pairs that a place that is solved for counts as.
    pairs_per_solution: usize,
    /// Parts that begin, at most: faces with more creases are not looked through.
    max_parts: usize,
    /// Parts smaller than so many tolerances are not halved.
    least_part_tolerances: f64,
    /// Nor those of one face smaller than this share of everything.
    least_part_share: f64,
    /// Nor those of two faces, which come near to each other all along the borders they share.
    least_part_share_of_two: f64,
    /// Sine of the angle at which parts cross; below they touch.
    least_sine: f64,
    /// Nearer to a border than so many tolerances a crossing may be what the border shares.
    border_tolerances: f64,
}

const SEARCH: SelfLimits = SelfLimits {
    max_pairs: 12_000,
    pairs_per_solution: 4,
    max_parts: 2_000,
    least_part_tolerances: 16.0,
    least_part_share: 1.0 / 256.0,
    least_part_share_of_two: 1.0 / 64.0,
    least_sine: 1.0 / 1024.0,
    border_tolerances: 64.0,
};

/// A place in which a face crosses itself or another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The place.
    pub at: DVec3,
    /// The faces, by their places in the list; the same one twice where it crosses itself.
    pub faces: (usize, usize),
    /// Places on them.
    pub uv: ((f64, f64), (f64, f64)),
}

/// A place in which some of the faces cross themselves or each other, away from their borders; the first one found. Trimmed faces are
/// left out. A touch is none, and of parts that come nearer to each other than about 1/256 of the whole the search may end without an answer.
pub fn crossing(faces: &[Surface], tolerance: &Tolerance) -> Option<Crossing> {
    let mut search = SelfSearch::new(faces, tolerance)?;
    search.crossing()
}

/// What is known of a rectangle of a face.
struct FacePart {
    face: usize,
    patch: usize,
    cell: Cell,
    halves: Option<(usize, usize)>,
}

struct SelfSearch<'a> {
    faces: &'a [Surface],
    patches: Vec<Patch>,
    breaks: Vec<(Vec<f64>, Vec<f64>)>,
    strips: Strips,
    parts: Vec<FacePart>,
    roots: Vec<usize>,
    poles: Vec<DVec3>,
    point: f64,
    size: f64,
    looked_at: usize,
    found: Option<Crossing>,
}

/// The work is at its end, or a crossing is found.
struct Ended;

impl<'a> SelfSearch<'a> {
    fn new(faces: &'a [Surface], tolerance: &Tolerance) -> Option<Self> {
        let whole = faces.iter().fold(Box3::EMPTY, |all, s| all.union(s.hull()));
        let mut search = Self {
            faces,
            patches: Vec::new(),
            breaks: faces.iter().map(Surface::breaks).collect(),
            strips: Strips::default(),
            parts: Vec::new(),
            roots: Vec::new(),
            poles: Vec::new(),
            point: tolerance.point,
            size: whole.diagonal(),
            looked_at: 0,
            found: None,
        };
        for (face, surface) in faces.iter().enumerate() {
            if !matches!(surface.domain(), Domain::Square | Domain::Triangle) {
                continue;
            }
            let (us, vs) = surface.kinks();
            if (us.len() + 1).saturating_mul(vs.len() + 1) + search.roots.len() > SEARCH.max_parts {
                return None;
            }
            search.poles.extend((0..surface.n_sides()).filter_map(|k| if let Side::Pole(p) = surface.side(k) { Some(p) } else { None }));
            for patch in patches(surface) {
                let cell = search.strips.cell(face, surface, patch.u, patch.v);
                search.patches.push(patch);
                search.roots.push(search.parts.len());
                search.parts.push(FacePart { face, patch: search.patches.len() - 1, cell, halves: None });
            }
        }
        Some(search)
    }

    fn crossing(&mut self) -> Option<Crossing> {
        let roots = self.roots.clone();
        let face = |search: &Self, k: usize| search.parts[k].face;
        // What a face does with itself first: faces side by side take long to separate.
        for (k, i) in roots.iter().enumerate() {
            if self.alone(*i).is_err() {
                return self.found;
            }
            for j in &roots[k + 1..] {
                if face(self, *i) == face(self, *j) && self.pair(*i, *j).is_err() {
                    return self.found;
                }
            }
        }
        for (k, i) in roots.iter().enumerate() {
            for j in &roots[k + 1..] {
                if face(self, *i) != face(self, *j) && self.pair(*i, *j).is_err() {
                    return self.found;
                }
            }
        }
        None
    }

    /// Largest length of parts that are left as they are.
    fn smallest(&self, of_two: bool) -> f64 {
        (SEARCH.least_part_tolerances * self.point)
            .max(self.size * if of_two { SEARCH.least_part_share_of_two } else { SEARCH.least_part_share })
    }

    fn look(&mut self, cost: usize) -> Result<(), Ended> {
        job::poll();
        self.looked_at += cost;
        if self.looked_at > SEARCH.max_pairs { Err(Ended) } else { Ok(()) }
    }

    /// A part with itself.
    fn alone(&mut self, k: usize) -> Result<(), Ended> {
        self.look(1)?;
        let part = &self.parts[k];
        if one_sided(&[&part.cell]) || part.cell.reach() <= self.smallest(false) || self.is_outside(k) {
            return Ok(());
        }
        let Some((a, b)) = self.halves(k) else { return Ok(()) };
        self.alone(a)?;
        self.alone(b)?;
        self.pair(a, b)
    }

    fn pair(&mut self, i: usize, j: usize) -> Result<(), Ended> {
        self.look(1)?;
        let (x, y) = (&self.parts[i], &self.parts[j]);
        if self.is_outside(i) || self.is_outside(j) || apart(&x.cell, &y.cell, 0.0) {
            return Ok(());
        }
        let beside = x.face == y.face && self.beside(x, y);
        if beside && one_sided(&[&x.cell, &y.cell]) {
            return Ok(());
        }
        if !beside && crosses(&x.cell, &y.cell) {
            let (face, other) = (x.face, y.face);
            self.look(SEARCH.pairs_per_solution)?;
            let (x, y) = (&self.parts[i], &self.parts[j]);
            let pair = Pair { a: &self.patches[x.patch], b: &self.patches[y.patch], point: self.point };
            let spot = pair.correct(x.cell.middle(), y.cell.middle(), None);
            if let Some(spot) = spot.and_then(|spot| inside(&pair, &x.cell, &y.cell, spot))
                && spot.sine > SEARCH.least_sine
                && self.is_crossing((face, spot.a), (other, spot.b), spot.p)
            {
                self.found = Some(Crossing { at: spot.p, faces: (face, other), uv: (spot.a.into(), spot.b.into()) });
                return Err(Ended);
            }
        }
        let smallest = self.smallest(self.parts[i].face != self.parts[j].face);
        let (x, y) = (&self.parts[i].cell, &self.parts[j].cell);
        if x.reach().max(y.reach()) <= smallest {
            return Ok(());
        }
        let first = x.reach() >= y.reach();
        let (part, other) = if first { (i, j) } else { (j, i) };
        let Some((k, l)) = self.halves(part) else { return Ok(()) };
        self.pair(k, other)?;
        self.pair(l, other)
    }

    /// Whether two parts of a face share places of its border lines, over a seam too.
    fn beside(&self, x: &FacePart, y: &FacePart) -> bool {
        let closed = self.faces[x.face].closed();
        let near = |a: (f64, f64), b: (f64, f64)| a.0 <= b.1 + EPSILON && b.0 <= a.1 + EPSILON;
        let touch = |a: (f64, f64), b: (f64, f64), round: bool| {
            near(a, b) || round && (near((a.0 + 1.0, a.1 + 1.0), b) || near((a.0 - 1.0, a.1 - 1.0), b))
        };
        touch(x.cell.u, y.cell.u, closed.0) && touch(x.cell.v, y.cell.v, closed.1)
    }

    fn is_outside(&self, k: usize) -> bool {
        let part = &self.parts[k];
        self.patches[part.patch].is_triangle() && part.cell.u.0 + part.cell.v.0 >= 1.0
    }

    /// Halves of a part, cut at a break near its middle where there is one.
    fn halves(&mut self, k: usize) -> Option<(usize, usize)> {
        if let Some(halves) = self.parts[k].halves {
            return Some(halves);
        }
        let (face, patch) = (self.parts[k].face, self.parts[k].patch);
        let cell = &self.parts[k].cell;
        let (u, v) = (cell.u, cell.v);
        let along_u =
            if cell.size.0.is_infinite() && cell.size.1.is_infinite() { u.1 - u.0 >= v.1 - v.0 } else { cell.size.0 >= cell.size.1 };
        let breaks = &self.breaks[face];
        let (ends, breaks) = if along_u { (u, &breaks.0) } else { (v, &breaks.1) };
        let middle = middle(ends, breaks)?;
        let ends = if along_u { [((u.0, middle), v), ((middle, u.1), v)] } else { [(u, (v.0, middle)), (u, (middle, v.1))] };
        let at = self.parts.len();
        for (u, v) in ends {
            // Bounds of a net of many curves ask all of them, once for all parts between two values.
            let before = self.strips.len();
            let cell = self.strips.cell(face, &self.patches[patch].surface, u, v);
            let (across, along) = self.faces[face].curves_of_a_point();
            self.looked_at += (self.strips.len() - before) * (across + along);
            self.parts.push(FacePart { face, patch, cell, halves: None });
        }
        self.parts[k].halves = Some((at, at + 1));
        self.parts[k].halves
    }

    /// Whether a common place of two parts is away from borders and poles, and is not one place with two names.
    fn is_crossing(&self, (a, x): (usize, DVec2), (b, y): (usize, DVec2), p: DVec3) -> bool {
        let reach = SEARCH.border_tolerances * self.point;
        let within = |face: usize, uv: DVec2| {
            let surface = &self.faces[face];
            let closed = surface.closed();
            let jet = surface.jet(uv.x, uv.y);
            let room = |x: f64, d: DVec3, round: bool| round || x.min(1.0 - x) * d.length() > reach;
            let slant = surface.domain() == Domain::Square || (1.0 - uv.x - uv.y) * jet.du.length().min(jet.dv.length()) > reach;
            room(uv.x, jet.du, closed.0) && room(uv.y, jet.dv, closed.1) && slant
        };
        const BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];
        let apart = || {
            BETWEEN.into_iter().any(|f| {
                let uv = x.lerp(y, f);
                self.faces[a].point(uv.x, uv.y).distance(p) > reach
            })
        };
        self.poles.iter().all(|pole| pole.distance(p) > reach) && within(a, x) && within(b, y) && (a != b || apart())
    }
}

/// What is known of the faces between two values of u, or of v: the same for all parts between them.
#[derive(Default)]
struct Strips(BTreeMap<(usize, bool, u64, u64), Strip>);

impl Strips {
    fn len(&self) -> usize {
        self.0.len()
    }

    /// A rectangle of a face.
    fn cell(&mut self, face: usize, surface: &Surface, u: (f64, f64), v: (f64, f64)) -> Cell {
        let key = |in_u: bool, ends: (f64, f64)| (face, in_u, ends.0.to_bits(), ends.1.to_bits());
        let (a, b) = (key(true, u), key(false, v));
        self.0.entry(a).or_insert_with(|| surface.strip_u(u.0, u.1));
        self.0.entry(b).or_insert_with(|| surface.strip_v(v.0, v.1));
        Cell::of(surface.spread_of(&self.0[&a], &self.0[&b]), u, v)
    }
}

/// Where to cut: at the break nearest to the middle that leaves a quarter on either side, else in the middle.
fn middle((low, high): (f64, f64), breaks: &[f64]) -> Option<f64> {
    if high - low <= EPSILON {
        return None;
    }
    let middle = 0.5 * (low + high);
    let quarter = 0.25 * (high - low);
    let k = breaks.partition_point(|x| *x < middle);
    let near = breaks[k.saturating_sub(1)..breaks.len().min(k + 1)].iter().copied().filter(|x| (x - middle).abs() <= quarter);
    Some(near.min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs())).unwrap_or(middle))
}

/// Whether all vectors product of a ∂u and a ∂v of the cells, of different ones too, are on one side of a plane.
fn one_sided(cells: &[&Cell]) -> bool {
    let way: DVec3 = cells.iter().map(|c| c.normal).sum();
    let way = way.normalize_or_zero();
    let ahead = |du: &Interval3, dv: &Interval3| du.cross(dv).along(way).low > 0.0;
    way != DVec3::ZERO && cells.iter().all(|a| cells.iter().all(|b| ahead(&a.enclosure.du, &b.enclosure.dv)))
}
