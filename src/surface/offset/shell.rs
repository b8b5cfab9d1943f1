//! One side of the wall of several faces: each face moved, made longer, and cut where it meets its moved neighbours.

use glam::{DMat3, DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::construct::build::line;
use crate::network::{Chain, meet};
use crate::surface::closest::foot;
use crate::surface::closest::nearest::{Nearest, closest};
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::Domain;
use crate::surface::faults::{WallEdge, WallFault};
use crate::surface::intersect::with_surfaces::with_surfaces;
use crate::surface::offset::boundary::{self, whole};
use crate::surface::offset::extended::longer;
use crate::surface::offset::joint::{self, Bend, FaceSheet, Joint, Use};
use crate::surface::rails::side::Side;
use crate::surface::trims::divide::divide;
use crate::surface::trims::project::{Way, project};

/// Faces run on beyond their borders by this many distances, or so many times as far as moved faces meet from where the faces do.
const REACH: f64 = 4.0;
const BEYOND: f64 = 1.5;
/// Places in each direction at which the middle of a face is looked for.
const PLACES: usize = 12;
/// Sine of the angle from which two curves cross clearly.
const CLEAR: f64 = 0.1;
/// Tolerances within which curves pass a corner.
const ROOM: f64 = 4.0;

/// One side of the wall.
pub(crate) struct Layer {
    /// The faces, in the order of the sheet.
    pub faces: Vec<Surface>,
    /// The edges, in the order of the sheet.
    pub edges: Vec<Chain>,
    /// Warnings.
    pub notes: Vec<Fault>,
}

/// A side in the making.
struct Making<'a> {
    sheet: &'a FaceSheet,
    distance: f64,
    origin: Origin,
    tolerance: &'a Tolerance,
    longer: Vec<Surface>,
    /// How far they run on, model units.
    reach: f64,
    /// Both ends of each edge of the sheet.
    ends: Vec<DVec3>,
    near_by: BoxTree,
}

/// The faces of a sheet at a distance; E671 where those of neighbours do not meet.
pub(crate) fn layer(sheet: &FaceSheet, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<Layer> {
    if distance == 0.0 {
        return Ok(Layer {
            faces: sheet.faces.iter().map(|face| face.with_origin(origin)).collect(),
            edges: sheet.joints.iter().map(|joint| joint.chain.clone()).collect(),
            notes: Vec::new(),
        });
    }
    let mut notes = Vec::new();
    let ends: Vec<DVec3> = sheet.joints.iter().flat_map(|joint| [joint.chain.start(), joint.chain.end()]).collect();
    let near_by = BoxTree::build(&ends.iter().map(|p| Box3::of([*p])).collect::<Vec<_>>());
    let mut making = Making { sheet, distance, origin, tolerance, longer: Vec::new(), reach: 0.0, ends, near_by };
    making.reach = making.farthest();
    for face in &sheet.faces {
        let (made, more) = longer(face, distance, making.reach, origin, tolerance)?;
        making.longer.push(made);
        notes.extend(more);
    }
    let whole: Result<Vec<Chain>> = sheet.joints.iter().map(|joint| making.edge(joint)).collect();
    let edges = making.cut(&whole?)?;
    let faces: Result<Vec<Surface>> = sheet.of_faces().into_iter().enumerate().map(|(face, own)| making.face(face, &own, &edges)).collect();
    Ok(Layer { faces: faces?, edges, notes })
}

impl Making<'_> {
    fn fault(&self, uses: &[Use], at: DVec3, why: WallEdge) -> Fault {
        let of = |k: usize| uses.get(k).or(uses.first()).map_or(Origin::NONE, |at| self.sheet.faces[at.face].origin());
        WallFault::Edge { wall: self.origin, a: of(0), b: of(1), at, why }.into()
    }

    /// The curve that an edge becomes, longer than it will be where it ends in corners.
    fn edge(&self, joint: &Joint) -> Result<Chain> {
        let first = joint.uses[0];
        match joint.bend {
            Bend::Free | Bend::Smooth => {
                let boundary = &self.sheet.boundaries[first.face][first.boundary];
                let copy = boundary.copy(self.distance, self.origin, self.tolerance)?;
                if copy.is_closed(self.tolerance) { Ok(copy) } else { self.run_on(&copy, first.face) }
            }
            Bend::Ridge | Bend::Valley => {
                let p = joint.chain.point(0.5);
                let normals: Vec<DVec3> = joint.uses.iter().map(|at| self.sheet.normal(*at, p)).collect();
                let expected = p + self.corner(&normals);
                let [a, b] = [0, 1].map(|k: usize| &self.longer[joint.uses[k.min(joint.uses.len() - 1)].face]);
                let common = with_surfaces(std::slice::from_ref(a), std::slice::from_ref(b), self.origin, self.tolerance)?;
                let near = |chain: &Chain| chain.closest(expected).2;
                let found = common.curves.into_iter().min_by(|x, y| near(x).total_cmp(&near(y)));
                found
                    .filter(|chain| near(chain) <= self.distance.abs())
                    .ok_or_else(|| self.fault(&joint.uses, p, WallEdge::Apart { distance: self.distance }))
            }
        }
    }

    /// The shortest way to a place at the distance from planes with some normals.
    fn corner(&self, normals: &[DVec3]) -> DVec3 {
        let d = self.distance;
        match normals {
            [n] => *n * d,
            [n, m] => (*n + *m) * (d / (1.0 + n.dot(*m)).max(NUDGE)),
            [a, b, c, ..] => {
                let rows = DMat3::from_cols(*a, *b, *c).transpose();
                if rows.determinant().abs() > NUDGE { rows.inverse() * DVec3::splat(d) } else { self.corner(&[*a, *b]) }
            }
            [] => DVec3::ZERO,
        }
    }

    /// A copy of a free border with more at its ends, straight in the parameters of the longer face.
    fn run_on(&self, copy: &Chain, face: usize) -> Result<Chain> {
        let ground = &self.longer[face];
        let reach = self.reach;
        let mut parts = vec![copy.clone()];
        for (last, end, way) in [(false, copy.start(), -copy.jet(0.0).d1), (true, copy.end(), copy.jet_before(1.0).d1)] {
            let to = end + way.normalize_or_zero() * reach;
            let near = closest(ground, end).uv;
            let straight = Chain::of_curve(&line(end, to, self.origin)?);
            let level = ground.flat_uv(end).is_some();
            let on = [0.5, 1.0].iter().all(|f| {
                let p = straight.point(*f);
                level || closest(ground, p).distance <= 0.5 * self.tolerance.point
            });
            let more = if on {
                straight
            } else {
                let jet = ground.jet(near.0, near.1);
                let Some(step) = foot::step(jet.du, jet.dv, way.normalize_or_zero() * reach) else { continue };
                let from = DVec2::from(near);
                let to = ground.hold(from + step);
                if to.distance(from) <= NUDGE {
                    continue;
                }
                let way = Chain::of_curve(&line(from.extend(0.0), to.extend(0.0), self.origin)?);
                Chain::of_curve(&project(ground, &way, Way::Parameters, self.origin, self.tolerance)?)
            };
            if last { parts.push(more) } else { parts.insert(0, more.reversed()) }
        }
        Chain::join(&parts, self.origin, self.tolerance)
    }

    /// The edges between their corners.
    fn cut(&self, whole: &[Chain]) -> Result<Vec<Chain>> {
        let joints = &self.sheet.joints;
        let corners =
            |joint: &Joint| if joint.chain.is_closed(self.tolerance) { Vec::new() } else { vec![joint.chain.start(), joint.chain.end()] };
        let cut = |k: usize| -> Result<Chain> {
            let ends: Vec<DVec3> = corners(&joints[k]).into_iter().map(|p| self.vertex(p, k, whole)).collect::<Result<_>>()?;
            let [a, b] = ends[..] else { return Ok(whole[k].clone()) };
            let fraction = |p: DVec3| {
                let (f, _, off) = whole[k].closest(p);
                let room = if joints[k].bend == Bend::Free { self.distance.abs() } else { ROOM * self.tolerance.point };
                if off <= room { Ok(f) } else { Err(self.fault(&joints[k].uses, p, WallEdge::Corner)) }
            };
            let (f, g) = (fraction(a)?, fraction(b)?);
            if whole[k].is_closed(self.tolerance) {
                let middle = whole[k].closest(joints[k].chain.point(0.5)).0;
                let (low, high) = (f.min(g), f.max(g));
                let inside = middle > low && middle < high;
                return if inside { whole[k].slice(low, high, self.tolerance) } else { whole[k].slice(high, low, self.tolerance) };
            }
            // The way from the first corner to the last one is that of the edge, or nothing is left of it.
            let middle = joints[k].chain.jet(0.5);
            let along = whole[k].jet(whole[k].closest(middle.p).0).d1.dot(middle.d1) > 0.0;
            if (f < g) != along || a.distance(b) <= self.tolerance.point {
                return Err(self.fault(&joints[k].uses, joints[k].chain.point(0.5), WallEdge::Gone { distance: self.distance }));
            }
            let part = whole[k].slice(f.min(g), f.max(g), self.tolerance)?;
            if joints[k].bend == Bend::Free {
                self.bent(part, if f < g { (a, b) } else { (b, a) }, joints[k].uses[0].face)
            } else {
                Ok(part)
            }
        };
        (0..joints.len()).map(cut).collect()
    }

    /// A free border that ends in some corners: where it misses them it is moved there, less and less along it, on the longer face.
    fn bent(&self, part: Chain, (from, to): (DVec3, DVec3), face: usize) -> Result<Chain> {
        let (first, last) = (from - part.start(), to - part.end());
        if first.length().max(last.length()) <= self.tolerance.point {
            return Ok(part);
        }
        let spline = part.to_curve()?.to_nurbs(self.tolerance)?;
        let (a, b) = spline.domain();
        // A linear function has the means of knots for its poles.
        let share = |i: usize| {
            let knots = &spline.knots[i + 1..=i + spline.degree];
            (knots.iter().sum::<f64>() / spline.degree as f64 - a) / (b - a)
        };
        let pole = |(i, q): (usize, &glam::DVec4)| (q.truncate() / q.w + first.lerp(last, share(i))) * q.w;
        let poles = spline.poles.iter().enumerate().map(|(i, q)| pole((i, q)).extend(q.w)).collect();
        let moved = boundary::curve(crate::geometry::Nurbs::new(spline.degree, spline.knots.clone(), poles), self.origin);
        let ground = &self.longer[face];
        let on = project(ground, &moved, Way::Nearest, self.origin, self.tolerance)?;
        Ok(Chain::of_curve(&on))
    }

    /// How far the faces have to run on: moved ones of a sharp edge or a sharp tip meet far from it, but none farther than all is wide.
    fn farthest(&self) -> f64 {
        let middle = |joint: &Joint| {
            let p = joint.chain.point(0.5);
            self.corner(&joint.uses.iter().map(|at| self.sheet.normal(*at, p)).collect::<Vec<_>>())
        };
        let ends = |joint: &Joint| [joint.chain.start(), joint.chain.end()].map(|p| self.around(p).1);
        let wide = self.sheet.faces.iter().fold(Box3::EMPTY, |all, face| all.union(face.hull())).diagonal();
        let ways = self.sheet.joints.iter().flat_map(|joint| ends(joint).into_iter().chain([middle(joint)]));
        let meet = ways.map(DVec3::length).fold(0.0, f64::max);
        (BEYOND * meet).min(wide).max(REACH * self.distance.abs())
    }

    /// The edges that end at a corner of the sheet, and the way from there to where the moved faces meet, as planes.
    fn around(&self, p: DVec3) -> (Vec<usize>, DVec3) {
        let joints = &self.sheet.joints;
        let room = ROOM * self.tolerance.point;
        let ends = self.near_by.near(&Box3::of([p]), room);
        let mut here: Vec<usize> = ends.into_iter().filter(|k| self.ends[*k].distance(p) <= room).map(|k| k / 2).collect();
        here.dedup();
        let mut faces: Vec<(usize, DVec3)> = Vec::new();
        for at in here.iter().flat_map(|k| &joints[*k].uses) {
            let normal = self.sheet.normal(*at, p);
            let known = |x: &(usize, DVec3)| x.0 == at.face || x.1.dot(normal) > 1.0 - NUDGE;
            if !faces.iter().any(known) {
                faces.push((at.face, normal));
            }
        }
        let normals: Vec<DVec3> = faces.iter().map(|f| f.1).collect();
        (here, self.corner(&normals))
    }

    /// Where the edges at a corner of the sheet meet now.
    fn vertex(&self, p: DVec3, joint: usize, whole: &[Chain]) -> Result<DVec3> {
        let joints = &self.sheet.joints;
        let (here, offset) = self.around(p);
        let expected = p + offset;
        // The two curves that cross most clearly; free borders can give way.
        let way = |k: usize| whole[k].jet(whole[k].closest(expected).0).d1.normalize_or_zero();
        let held = |k: usize| joints[k].bend != Bend::Free;
        let pairs = here.iter().flat_map(|a| here.iter().filter(move |b| a < *b).map(move |b| (*a, *b)));
        let clear = |(a, b): (usize, usize)| {
            let sine = way(a).cross(way(b)).length();
            (sine >= CLEAR && held(a) && held(b), sine)
        };
        let clearest = pairs.max_by(|x, y| {
            let (x, y) = (clear(*x), clear(*y));
            x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
        });
        let Some((a, b)) = clearest else { return Ok(expected) };
        let met = meet(&whole[a], &whole[b], self.tolerance)?;
        let hits = met.iter().map(|m| m.point).min_by(|x, y| x.distance(expected).total_cmp(&y.distance(expected)));
        // One edge that goes on past the corner, as across the seam of a face: all of it is common.
        let goes_on = met.iter().any(|m| m.overlap_end.is_some());
        let found = if goes_on { Some(whole[a].closest(expected).1) } else { hits };
        let mut at = found.filter(|x| x.distance(expected) <= self.reach);
        if at.is_none() && !(held(a) && held(b)) {
            // Borders that miss each other on the faces that they belong to: the corner is on the edge, nearest to where it would be.
            let edge = here.iter().find(|k| held(**k));
            at = edge.map(|k| whole[*k].closest(expected).1).filter(|x| x.distance(expected) <= self.distance.abs());
        }
        let at = at.ok_or_else(|| self.fault(&joints[joint].uses, p, WallEdge::Corner))?;
        let passes = |k: &usize| !held(*k) || whole[*k].closest(at).2 <= ROOM * self.tolerance.point;
        if here.iter().all(passes) { Ok(at) } else { Err(self.fault(&joints[joint].uses, p, WallEdge::Corner)) }
    }

    /// A moved face between its edges.
    fn face(&self, face: usize, own: &[usize], edges: &[Chain]) -> Result<Surface> {
        let joints = &self.sheet.joints;
        let cutters: Vec<Chain> = own.iter().map(|k| edges[*k].clone()).collect();
        let ground = &self.longer[face];
        if cutters.is_empty() {
            return Ok(ground.clone());
        }
        let gone = || {
            let k = own.first().copied().unwrap_or_default();
            self.fault(&joints[k].uses, joints[k].chain.point(0.5), WallEdge::Gone { distance: self.distance })
        };
        let keep = self.middle(face, own, edges).ok_or_else(gone)?;
        let kept = divide(ground, &cutters, keep, self.origin, self.tolerance)?;
        let length: f64 = cutters.iter().map(Chain::length).sum();
        let free = |k: usize| match kept.side(k) {
            Side::Chain { chain, from, to } => chain.length() * (to - from).abs(),
            _ => 0.0,
        };
        let around: f64 = (0..kept.n_sides()).filter(|k| on(&kept, *k, &cutters, self.tolerance)).map(free).sum();
        // Another border of the longer face among its sides: what is kept lies beyond the edges. A seam is there twice.
        let chains: Vec<Option<Chain>> = (0..kept.n_sides())
            .map(|k| match kept.side(k) {
                Side::Chain { chain, .. } => Some(chain),
                _ => None,
            })
            .collect();
        let twin =
            |k: usize| (0..chains.len()).any(|j| j != k && chains[j].iter().any(|c| on(&kept, k, std::slice::from_ref(c), self.tolerance)));
        let within = (0..chains.len()).all(|k| chains[k].is_none() || on(&kept, k, &cutters, self.tolerance) || twin(k));
        if within && (around - length).abs() <= ROOM * ROOM * self.tolerance.point * (1 + own.len()) as f64 {
            return Ok(kept);
        }
        Err(gone())
    }

    /// A place of a moved face inside its edges, as far from them as any that is tried: over places of the old face and beside the edges;
    /// none where nothing is left of the face.
    fn middle(&self, face: usize, own: &[usize], edges: &[Chain]) -> Option<DVec3> {
        let old = &self.sheet.faces[face];
        let below = whole(old, self.tolerance);
        let (low, high) = old.outlines().iter().flatten().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
        let (low, high) = if low.x <= high.x { (low, high) } else { (DVec2::ZERO, DVec2::ONE) };
        let at = |k: usize| (k as f64 + 0.5) / PLACES as f64;
        let places = (0..PLACES * PLACES).map(|k| low + (high - low) * DVec2::new(at(k % PLACES), at(k / PLACES)));
        let inside = places.filter(|uv| match old.domain() {
            Domain::Loop => old.keeps(uv.x, uv.y),
            Domain::Triangle => uv.x + uv.y < 1.0,
            _ => true,
        });
        let mut points: Vec<DVec3> = inside.map(|uv| below.point(uv.x, uv.y) + below.normal(uv.x, uv.y) * self.distance).collect();
        let sides: Vec<Inward> = own.iter().flat_map(|k| self.inward(face, *k, &edges[*k])).collect();
        for side in &sides {
            let length = side.chain.length();
            points.extend(STEPS.into_iter().map(|share| side.at + side.way * (share * length)));
        }
        let ground = Nearest::new(&self.longer[face]);
        let beside = |p: DVec3| {
            let feet = sides.iter().map(|side| (side, side.chain.closest(p)));
            feet.min_by(|x, y| x.1.2.total_cmp(&y.1.2)).map(|(side, (f, q, off))| (off, p, side, f, q))
        };
        let mut tried: Vec<_> = points.into_iter().rev().filter_map(|p| beside(ground.at(p).point)).collect();
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        // The nearest edge decides the side; a seam has the face on both.
        let seam = |side: &Inward| sides.iter().filter(|other| other.joint == side.joint).count() > 1;
        let best = tried.into_iter().find(|(_, p, side, f, q)| seam(side) || side.inside(self.sheet.normal(side.of, *q), *f, *p - *q));
        best.map(|(_, p, ..)| p)
    }

    /// Where the inside of a face is, beside one of its moved edges: for each use of the edge.
    fn inward<'c>(&self, face: usize, k: usize, chain: &'c Chain) -> Vec<Inward<'c>> {
        let joint = &self.sheet.joints[k];
        let p = joint.chain.point(0.5);
        let side = |at: &Use| {
            let boundary = &self.sheet.boundaries[at.face][at.boundary];
            let jet = boundary.jet(joint::nearest(boundary, p), false)?;
            let (f, q, _) = chain.closest(jet.p + jet.normal * self.distance);
            let along = chain.jet(f).d1.dot(jet.d1) >= 0.0;
            let tangent = chain.jet(f).d1.normalize_or_zero() * if along { 1.0 } else { -1.0 };
            Some(Inward { joint: k, of: *at, chain, along, at: q, way: jet.normal.cross(tangent) })
        };
        joint.uses.iter().filter(|at| at.face == face).filter_map(side).collect()
    }
}

/// Shares of the length of an edge by which places beside it are tried.
const STEPS: [f64; 4] = [0.3, 0.1, 0.03, 0.01];

/// A moved edge as a border of a face that lies on its left.
struct Inward<'c> {
    joint: usize,
    /// The use of the edge by the face.
    of: Use,
    chain: &'c Chain,
    /// Whether the loop of the face runs as the chain does.
    along: bool,
    /// A place of it, and the way from there into the face.
    at: DVec3,
    way: DVec3,
}

impl Inward<'_> {
    /// Whether a way from a place of the edge leads into the face; `normal` is the face's there.
    fn inside(&self, normal: DVec3, f: f64, way: DVec3) -> bool {
        let tangent = self.chain.jet(f).d1 * if self.along { 1.0 } else { -1.0 };
        normal.cross(tangent).dot(way) > 0.0
    }
}

/// Whether a border of a face is along one of some curves.
fn on(face: &Surface, k: usize, curves: &[Chain], tolerance: &Tolerance) -> bool {
    let Side::Chain { chain, from, to } = face.side(k) else { return false };
    let p = chain.point(0.5 * (from + to));
    curves.iter().any(|c| c.closest(p).2 <= ROOM * tolerance.point)
}
