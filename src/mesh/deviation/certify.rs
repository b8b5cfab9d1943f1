//! Whether a mapped face keeps a chord error everywhere, by bounds and not by samples. `docs/notes/bounds.md` has the formulas.
//!
//! A triangle's points are no farther from the surface than its corners are, plus what the surface is off the flat triangle
//! between the feet of the corners. The latter follows from ranges of second derivatives and falls by four with each
//! halving; a triangle whose bound does not do is looked at in parts, whose corners have feet of their own.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::base::range::Interval3;
use crate::base::tolerance::EPSILON;
use crate::mesh::data::face_geometry::{FaceGeometry, FaceNodes};
use crate::mesh::deviation::triangle::over_sides;
use crate::mesh::mapped::grid::Grid;
use crate::surface::core::power_form::Bends;
use crate::surface::{Domain, Enclosure, Surface, foot_within};

/// Share of the box of a triangle by which it is widened: feet of its points lie a little beside their (u, v).
const WIDER: f64 = 0.05;
/// Share of the box of a triangle by which feet may lie beside the middles of its sides; it keeps parts shrinking.
const STRAY: f64 = 0.2;
/// Share of the limit that a point far from its foot may use up.
const USED: f64 = 0.5;
/// Halvings of a triangle at most.
const DEPTH: u32 = 12;
/// Parts of a triangle that are looked at.
const PARTS: usize = 800;
/// Triangles of a row that are left open before the others are not looked at.
const OPEN: usize = 4;

/// What is known of a face and a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proof {
    /// No point is farther from the surface.
    Kept,
    /// A point is: its distance over the limit, and how the surface bends there along u and along v.
    Broken(f64, [f64; 2]),
    /// Neither: the bound over the limit, and the same.
    Open(f64, [f64; 2]),
    /// Neither, and a finer mesh would not change that: the bound does not fall with the size of what is looked at.
    Blind,
}

impl Proof {
    /// What two parts make together.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Kept, Self::Blind) => Self::Blind,
            (_, Self::Kept | Self::Blind) | (Self::Broken(..), Self::Open(..)) => self,
            (Self::Kept | Self::Blind, _) | (Self::Open(..), Self::Broken(..)) => other,
            (Self::Open(a, _), Self::Open(b, _)) | (Self::Broken(a, _), Self::Broken(b, _)) => {
                if a >= b {
                    self
                } else {
                    other
                }
            }
        }
    }
}

/// Whether all elements of a mapped face (a quad as its two triangles) keep a distance from its surface, model units;
/// `triangles` are those of the face.
pub fn of_face(surface: &Surface, limit: f64, geometry: &FaceGeometry, triangles: &[[u32; 3]], nodes: &[DVec3]) -> Proof {
    match &geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let field = Field { surface, u: grid.u, v: grid.v, slanted: false, limit };
            let columns = Columns::new(&field, grid);
            let starts = crate::mesh::mapped::grid::triangle_rows(frame, !triangles.is_empty());
            let rows = par::map(grid.size().1, |j| {
                let of_row = if starts.is_empty() { &[][..] } else { triangles.get(starts[j]..starts[j + 1]).unwrap_or(&[]) };
                Row { field: &field, grid, frame, nodes }.proof(j, of_row, columns.as_ref())
            });
            rows.into_iter().fold(Proof::Kept, Proof::and)
        }
        FaceNodes::Free(..) => Proof::Kept,
        listed => {
            let field = Field { surface, u: (0.0, 1.0), v: (0.0, 1.0), slanted: surface.domain() == Domain::Triangle, limit };
            let (uv, ids) = (listed.listed_uv(), listed.listed_ids());
            let mut halves = Vec::new();
            listed.each_listed_cell(|corners| {
                let own: &[[usize; 3]] = if corners.len() == 4 { &[[0, 1, 2], [0, 2, 3]] } else { &[[0, 1, 2]] };
                halves.extend(own.iter().map(|half| half.map(|k| corners[k])));
            });
            let proofs = par::map(halves.len(), |k| {
                let corner = |n: usize| field.corner(nodes[ids[n] as usize], uv[n], None);
                field.proof(halves[k].map(corner), None)
            });
            proofs.into_iter().fold(Proof::Kept, Proof::and)
        }
    }
}

/// What depends on u alone, for each column of a straight grid.
struct Columns(Vec<crate::surface::Strip>);

impl Columns {
    fn new(field: &Field, grid: &Grid) -> Option<Self> {
        let one = |i: usize| {
            let (low, high) = widened(grid.uv(i, 0).0, grid.uv(i + 1, 0).0, field.u);
            field.surface.strip_u(low, high)
        };
        (grid.straight == (true, true)).then(|| Self(par::map(grid.size().0, one)))
    }
}

/// An interval made wider, inside another.
fn widened(low: f64, high: f64, (least, most): (f64, f64)) -> (f64, f64) {
    let more = (high - low) * WIDER;
    ((low - more).max(least), (high + more).min(most))
}

/// One row of cells of a grid.
struct Row<'a> {
    field: &'a Field<'a>,
    grid: &'a Grid,
    frame: &'a crate::mesh::mapped::grid::GridIds,
    nodes: &'a [DVec3],
}

impl Row<'_> {
    fn proof(&self, j: usize, triangles: &[[u32; 3]], columns: Option<&Columns>) -> Proof {
        let grid = self.grid;
        let strip = columns.map(|_| {
            let (low, high) = widened(grid.uv(0, j).1, grid.uv(0, j + 1).1, self.field.v);
            self.field.surface.strip_v(low, high)
        });
        let (mut whole, mut open, mut next) = (Proof::Kept, 0, triangles.iter());
        for i in 0..grid.size().0 {
            let at = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let ids = at.map(|(i, j)| self.frame.node(i, j));
            let pole = (0..4).find(|k| ids[*k] == ids[(k + 1) % 4]);
            // A triangle of the mesh that holds both b and d tells that the other diagonal was taken.
            let other = match (next.next(), pole) {
                (Some(t), None) => {
                    next.next();
                    t.contains(&ids[3]) && t.contains(&ids[1])
                }
                _ => false,
            };
            let halves: &[[usize; 3]] = match pole {
                Some(0) => &[[0, 2, 3]],
                Some(1) => &[[0, 1, 3]],
                Some(_) => &[[0, 1, 2]],
                None if other => &[[0, 1, 3], [1, 2, 3]],
                None => &[[0, 1, 2], [0, 2, 3]],
            };
            let known = columns.zip(strip.as_ref()).map(|(columns, strip)| self.field.surface.spread_of(&columns.0[i], strip));
            // Along a pole any u (or v) is right.
            let free = |k: usize| pole.filter(|p| k == *p || k == (*p + 1) % 4).map(|p| p % 2);
            for half in halves {
                let corner = |k: usize| {
                    let (p, uv) = (self.nodes[ids[k] as usize], grid.uv(at[k].0, at[k].1));
                    // What is made from the geometry lies on the surface; border nodes are those of glued edges.
                    if ids[k] >= self.frame.first { Corner::on(p, uv) } else { self.field.corner(p, uv, free(k)) }
                };
                let proof = self.field.proof(half.map(corner), known.as_ref());
                whole = whole.and(proof);
                open += usize::from(proof != Proof::Kept);
            }
            if open >= OPEN {
                break;
            }
        }
        whole
    }
}

/// The part of a surface that a face covers, and how far its elements may be from it.
struct Field<'a> {
    surface: &'a Surface,
    u: (f64, f64),
    v: (f64, f64),
    /// Only u + v ≤ 1 belongs to it.
    slanted: bool,
    limit: f64,
}

/// A corner of a flat triangle.
#[derive(Clone, Copy)]
struct Corner {
    p: DVec3,
    /// Place of its foot on the surface.
    uv: DVec2,
    foot: DVec3,
    /// Distance of the foot.
    off: f64,
    /// The coordinate of the place that does not matter, at a pole.
    free: Option<usize>,
}

impl Corner {
    /// One on the surface.
    fn on(p: DVec3, uv: (f64, f64)) -> Self {
        Self { p, uv: DVec2::from(uv), foot: p, off: 0.0, free: None }
    }
}

/// Places of a triangle's corners, the free ones in the middle of the others.
fn places(t: &[Corner; 3]) -> [DVec2; 3] {
    let mut uv = t.map(|c| c.uv);
    for k in 0..3 {
        if let Some(axis) = t[k].free {
            uv[k][axis] = 0.5 * (t[(k + 1) % 3].uv[axis] + t[(k + 2) % 3].uv[axis]);
        }
    }
    uv
}

/// A bound of the distance between a flat triangle and its surface, and what of it is bent along u and along v.
struct Bound {
    error: f64,
    bends: [f64; 2],
}

impl Field<'_> {
    fn corner(&self, p: DVec3, uv: (f64, f64), free: Option<usize>) -> Corner {
        let foot = self.surface.point(uv.0, uv.1);
        Corner { p, uv: DVec2::from(uv), foot, off: p.distance(foot), free }
    }

    /// `known`: bounds over the widened box of the triangle.
    fn proof(&self, triangle: [Corner; 3], known: Option<&Enclosure>) -> Proof {
        let mut open = vec![(triangle, DEPTH)];
        let mut known = known;
        let mut looks = 0;
        while let Some((t, left)) = open.pop() {
            let off = t.iter().fold(0.0, |m: f64, c| m.max(c.off));
            let uv = places(&t);
            let bound = self.bound(&t, uv, known.take());
            if off + bound.error <= self.limit {
                continue;
            }
            looks += 1;
            let bends = bound.bends;
            if left == 0 {
                return Proof::Blind;
            }
            if looks > PARTS {
                return Proof::Open((off + bound.error) / self.limit, bends);
            }
            let m = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| self.between((&t[i], uv[i]), (&t[j], uv[j]), &uv));
            let far = m.iter().fold(0.0, |m: f64, c| m.max(c.0));
            if far > self.limit {
                return Proof::Broken(far / self.limit, bends);
            }
            let m = m.map(|c| c.1);
            open.push((m, left - 1));
            for k in 0..3 {
                open.push(([t[k], m[(k + 2) % 3], m[(k + 1) % 3]], left - 1));
            }
        }
        Proof::Kept
    }

    /// The middle of a side with its distance from the surface. Its foot is the nearest point, unless that is far from the
    /// middle of the places (beyond a fold): then the point there, for any point of the surface tells a distance at most.
    fn between(&self, (a, at): (&Corner, DVec2), (b, bt): (&Corner, DVec2), uv: &[DVec2; 3]) -> (f64, Corner) {
        let (p, guess) = (0.5 * (a.p + b.p), 0.5 * (at + bt));
        let (off, at) = foot_within(self.surface.evaluator(), p, (guess.x, guess.y), self.u, self.v);
        let width = uv[0].max(uv[1]).max(uv[2]) - uv[0].min(uv[1]).min(uv[2]);
        let at = DVec2::from(at);
        let there = self.surface.point(guess.x, guess.y);
        let beside = p.distance(there);
        if (at - guess).abs().cmple(STRAY * width).all() || beside > USED * self.limit {
            return (off, Corner { p, uv: at, foot: self.surface.point(at.x, at.y), off, free: None });
        }
        (off, Corner { p, uv: guess, foot: there, off: beside, free: None })
    }

    /// How far the surface is from the flat triangle between feet.
    fn bound(&self, t: &[Corner; 3], uv: [DVec2; 3], known: Option<&Enclosure>) -> Bound {
        let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        let ((x0, x1), (y0, y1)) = (widened(low.x, high.x, self.u), widened(low.y, high.y, self.v));
        let own;
        let enclosure = match known {
            Some(enclosure) => enclosure,
            None => {
                own = self.surface.enclosure((x0, x1), (y0, y1));
                &own
            }
        };
        let width = high - low;
        let second = [enclosure.duu, enclosure.duv, enclosure.dvv];
        if second.iter().any(Interval3::is_unbounded) {
            // What is left of a function without its mean slopes has slopes of half their width, and changes by half of that
            // on the mean over the corners.
            let wide = |r: &Interval3| 0.25 * (r.high - r.low).length();
            let bends = [width.x * wide(&enclosure.du), width.y * wide(&enclosure.dv)];
            return Bound { error: bends[0] + bends[1], bends };
        }
        let (a, b) = (t[1].foot - t[0].foot, t[2].foot - t[0].foot);
        let twice = a.cross(b).length();
        let square = |r: &Interval3| r.reach();
        if twice <= EPSILON * (a.length_squared() + b.length_squared()) {
            let slack = second.each_ref().map(square);
            let error = over_sides(&Bends { mid: [0.0; 3], slack, jump: 0.0 }, uv, width);
            return Bound { error, bends: [slack[0] * width.x * width.x, slack[2] * width.y * width.y] };
        }
        let flat = Flat::new(uv, (a, b), twice, &second);
        let box_ = (DVec2::new(x0, y0), DVec2::new(x1, y1));
        let error =
            self.beside(t, &flat, box_, &second).map_or(flat.whole, |beside| flat.whole.min(DVec2::new(flat.shifted, beside).length()));
        Bound { error, bends: [flat.bent(0) * width.x * width.x, flat.bent(2) * width.y * width.y] }
    }

    /// What the border of the face may cut off of a flat triangle; `None` where feet may lie beyond the box in which the
    /// surface is known.
    fn beside(&self, t: &[Corner; 3], flat: &Flat, (least, most): (DVec2, DVec2), second: &[Interval3; 3]) -> Option<f64> {
        let (low, high) = (flat.low - flat.shift, flat.high + flat.shift);
        let mut cut = 0.0;
        for (axis, range) in [self.u, self.v].into_iter().enumerate() {
            for (out, on, end) in [(low[axis] < least[axis], range.0, least[axis]), (high[axis] > most[axis], range.1, most[axis])] {
                if out && on != end {
                    return None;
                }
                if out {
                    let along = if axis == 0 { DVec2::Y } else { DVec2::X };
                    let span = (most - least).dot(along);
                    cut += self.sagitta(t, flat.normal, (along, span), second, &|uv| (uv[axis] - on).abs());
                }
            }
        }
        if self.slanted && high.x + high.y > 1.0 {
            let span = (most - least).max_element();
            cut += self.sagitta(t, flat.normal, (DVec2::new(1.0, -1.0), span), second, &|uv| (1.0 - uv.x - uv.y).abs());
        }
        Some(cut)
    }

    /// How far the border along a direction is from its chord, in the plane of the triangle; `away` is how far a place is
    /// from the border.
    fn sagitta(
        &self,
        t: &[Corner; 3],
        normal: DVec3,
        (along, span): (DVec2, f64),
        second: &[Interval3; 3],
        away: &dyn Fn(DVec2) -> f64,
    ) -> f64 {
        let on: Vec<&Corner> = t.iter().filter(|c| away(c.uv) <= EPSILON).collect();
        let (way, share) = match on[..] {
            [a, b] => {
                let part = (a.uv - b.uv).abs().max_element() / span;
                (a.foot - b.foot, part * part / 8.0)
            }
            // One corner, or none where the border is near: at most as far as from a tangent.
            _ => {
                let near = t.iter().fold(&t[0], |best, c| if away(c.uv) < away(best.uv) { c } else { best });
                let jet = self.surface.jet(near.uv.x, near.uv.y);
                (jet.du * along.x + jet.dv * along.y, 0.5)
            }
        };
        let aside = normal.cross(way).normalize_or_zero();
        let r = second.each_ref().map(|r| r.along(aside).reach());
        let bend = r[0] * along.x * along.x + 2.0 * r[1] * (along.x * along.y).abs() + r[2] * along.y * along.y;
        share * span * span * bend
    }
}

/// A flat triangle over places, and what ranges of second derivatives say of the surface there.
struct Flat {
    normal: DVec3,
    /// Box of the places.
    low: DVec2,
    high: DVec2,
    /// How far the foot of a point may lie from its place.
    shift: DVec2,
    /// The surface over the triangle in the direction of the normal, found at the feet.
    shifted: f64,
    /// How far a point may be from that of its own place.
    whole: f64,
    bends: Bends,
}

impl Flat {
    fn new(uv: [DVec2; 3], (a, b): (DVec3, DVec3), twice: f64, second: &[Interval3; 3]) -> Self {
        let (low, high) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        let width = high - low;
        let normal = a.cross(b) / twice;
        let e = a.normalize_or_zero();
        let f = normal.cross(e);
        let up = second.each_ref().map(|r| r.along(normal));
        let bends = Bends { mid: up.map(|r| 0.5 * (r.low + r.high)), slack: up.map(|r| 0.5 * (r.high - r.low)), jump: 0.0 };
        let aside = second.each_ref().map(|r| DVec2::new(r.along(e).reach(), r.along(f).reach()).length());
        let height = over_sides(&bends, uv, width);
        let along = over_sides(&Bends { mid: [0.0; 3], slack: aside, jump: 0.0 }, uv, width);
        let whole = DVec2::new(height, along).length();
        let mut flat = Self { normal, low, high, shift: DVec2::INFINITY, shifted: f64::INFINITY, whole, bends };
        // Slopes along a side vanish somewhere on it, and change by second derivatives over the widened box.
        let room = width * (1.0 + 2.0 * WIDER);
        let sides = [uv[1] - uv[0], uv[2] - uv[0]].map(DVec2::abs);
        let slope = |d: DVec2, c: [f64; 3]| d.x * room.x * c[0] + (d.x * room.y + d.y * room.x) * c[1] + d.y * room.y * c[2];
        let heights = [twice / b.length(), twice / a.length()];
        let swing = slope(sides[0], aside) / heights[0] + slope(sides[1], aside) / heights[1];
        if swing < 1.0 {
            let most = along / (1.0 - swing);
            let steps = heights.map(|h| most / h);
            flat.shift = sides[0] * steps[0] + sides[1] * steps[1];
            let up = [0, 1, 2].map(|k| flat.bent(k));
            flat.shifted = height + steps[0] * slope(sides[0], up) + steps[1] * slope(sides[1], up);
        }
        flat
    }

    /// Most of a second derivative along the normal.
    fn bent(&self, k: usize) -> f64 {
        self.bends.mid[k].abs() + self.bends.slack[k]
    }
}
