//! The edges of several faces: which borders are one, and how the faces stand to each other there.

use std::collections::VecDeque;

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::boxtree::BoxTree;
use crate::base::fault::Result;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::network::Chain;
use crate::surface::core::surface::Surface;
use crate::surface::faults::{WallEdge, WallFault};
use crate::surface::offset::boundary::{Boundary, boundaries};
use crate::surface::trims::trim::with_loops;
use crate::surface::trims::trim_loop::natural;

/// Borders that are no edge of two faces and yet everywhere within so many tolerances are not meant to be two.
const BESIDE: f64 = 100.0;
/// Tolerances within which ends of borders are one.
const SAME: f64 = 2.0;
/// Places along an edge at which the faces are compared.
const PLACES: usize = 9;

/// A border of a face: its number, and the one of the border among all loops of the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Use {
    pub face: usize,
    pub boundary: usize,
}

/// How two faces stand to each other along an edge, seen from the side of the normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bend {
    /// One face.
    Free,
    /// They go on into each other.
    Smooth,
    /// A ridge.
    Ridge,
    /// A valley.
    Valley,
}

/// An edge with the faces that have it, in the direction of the first one's loop.
pub(crate) struct Joint {
    pub uses: Vec<Use>,
    pub bend: Bend,
    pub chain: Chain,
}

/// Faces with their borders, all sides turned alike.
pub(crate) struct FaceSheet {
    pub faces: Vec<Surface>,
    /// The borders of each face.
    pub boundaries: Vec<Vec<Boundary>>,
    pub joints: Vec<Joint>,
}

impl FaceSheet {
    /// The edges of faces; of neighbours that are turned differently the later one is flipped.
    ///
    /// Fails with E671 where borders of two faces are no one edge and yet nowhere farther apart than `near`, where an edge is shared in part, by more than two faces, or where it is sharp in part.
    pub fn new(faces: &[Surface], near: f64, origin: Origin, tolerance: &Tolerance) -> Result<Self> {
        // Loops that run with the face on their left.
        let mut faces: Vec<Surface> = faces.iter().map(|face| with_loops(face, tolerance)).collect::<Result<_>>()?;
        let first = Self::of(&faces, near, origin, tolerance)?;
        let turned = first.turned();
        if turned.iter().any(|t| *t) {
            faces = faces.iter().zip(&turned).map(|(face, turned)| if *turned { face.flipped() } else { face.clone() }).collect();
            return Self::of(&faces, near, origin, tolerance)?.bent(origin, tolerance);
        }
        first.bent(origin, tolerance)
    }

    fn of(faces: &[Surface], near: f64, origin: Origin, tolerance: &Tolerance) -> Result<Self> {
        let mut all: Vec<Vec<Boundary>> = Vec::new();
        for face in faces {
            all.push(boundaries(face, &natural(face, tolerance)?, tolerance).into_iter().flatten().flatten().collect());
        }
        let all = parted(all, origin, tolerance)?;
        let mut borders: Vec<(Use, Chain)> = Vec::new();
        for (face, own) in all.iter().enumerate() {
            for (boundary, border) in own.iter().enumerate() {
                borders.push((Use { face, boundary }, border.copy(0.0, origin, tolerance)?));
            }
        }
        let boxes: Vec<Box3> = borders.iter().map(|(_, chain)| chain.bbox()).collect();
        let near_by = BoxTree::build(&boxes);
        let mut joints: Vec<Joint> = Vec::new();
        // The joints that borders are the first of.
        let mut first: Vec<Option<usize>> = vec![None; borders.len()];
        for (k, (at, chain)) in borders.into_iter().enumerate() {
            let mut others = near_by.near(&boxes[k], SAME * tolerance.point).into_iter().filter_map(|j| first[j]);
            match others.find(|j| same(&joints[*j].chain, &chain, tolerance)) {
                Some(j) if joints[j].uses.len() > 1 => {
                    let (a, b) = (faces[joints[j].uses[0].face].origin(), faces[at.face].origin());
                    return Err(WallFault::Edge { wall: origin, a, b, at: chain.point(0.5), why: WallEdge::Three }.into());
                }
                Some(j) => joints[j].uses.push(at),
                None => {
                    first[k] = Some(joints.len());
                    joints.push(Joint { uses: vec![at], bend: Bend::Free, chain });
                }
            }
        }
        let of = |joint: &Joint| faces[joint.uses[0].face].origin();
        if let Some((a, b)) = overlap(&joints, tolerance) {
            let at = a.chain.point(0.5);
            return Err(WallFault::Edge { wall: origin, a: of(a), b: of(b), at, why: WallEdge::Part }.into());
        }
        let glued = Tolerance { point: near.max(BESIDE * tolerance.point), ..*tolerance };
        if let Some((a, b)) = overlap(&joints, &glued) {
            let at = a.chain.point(0.5);
            let why = WallEdge::Gap { apart: b.chain.closest(at).2 };
            return Err(WallFault::Edge { wall: origin, a: of(a), b: of(b), at, why }.into());
        }
        Ok(Self { faces: faces.to_vec(), boundaries: all, joints })
    }

    /// The joints of each face, ascending.
    pub fn of_faces(&self) -> Vec<Vec<usize>> {
        let mut own = vec![Vec::new(); self.faces.len()];
        for (k, joint) in self.joints.iter().enumerate() {
            joint.uses.iter().for_each(|at| own[at.face].push(k));
        }
        own.iter_mut().for_each(Vec::dedup);
        own
    }

    /// The first face of a second piece, if the faces do not all hang together.
    pub fn second_piece(&self) -> Option<&Surface> {
        let own = self.of_faces();
        let mut reached = vec![false; self.faces.len()];
        let mut open: Vec<usize> = (0..self.faces.len().min(1)).collect();
        while let Some(face) = open.pop() {
            if !std::mem::replace(&mut reached[face], true) {
                open.extend(own[face].iter().flat_map(|k| &self.joints[*k].uses).map(|at| at.face));
            }
        }
        reached.iter().position(|reached| !reached).map(|face| &self.faces[face])
    }

    /// The faces that must be flipped so that all look to the side of the first one of each piece.
    fn turned(&self) -> Vec<bool> {
        let own = self.of_faces();
        let mut turned: Vec<Option<bool>> = vec![None; self.faces.len()];
        for start in 0..self.faces.len() {
            if turned[start].is_some() {
                continue;
            }
            turned[start] = Some(false);
            let mut open = VecDeque::from([start]);
            while let Some(face) = open.pop_front() {
                for joint in own[face].iter().map(|k| &self.joints[*k]).filter(|joint| joint.uses.len() == 2) {
                    let (a, b) = (joint.uses[0], joint.uses[1]);
                    let next = if a.face == face { b } else { a };
                    if turned[next.face].is_some() {
                        continue;
                    }
                    turned[next.face] = Some(turned[face].unwrap_or(false) != self.along(joint));
                    open.push_back(next.face);
                }
            }
        }
        turned.into_iter().map(|t| t.unwrap_or(false)).collect()
    }

    /// Whether both loops run an edge in the same direction.
    fn along(&self, joint: &Joint) -> bool {
        let way = |at: Use, p: DVec3| {
            let boundary = &self.boundaries[at.face][at.boundary];
            let f = nearest(boundary, p);
            boundary.jet(f, false).map_or(DVec3::ZERO, |jet| jet.d1)
        };
        let p = joint.chain.point(0.5);
        way(joint.uses[0], p).dot(way(joint.uses[1], p)) > 0.0
    }

    /// The same with the bend of each edge.
    fn bent(mut self, origin: Origin, tolerance: &Tolerance) -> Result<Self> {
        for k in 0..self.joints.len() {
            let joint = &self.joints[k];
            let [a, b] = joint.uses[..] else { continue };
            let angles: Vec<(f64, DVec3)> = (0..PLACES)
                .map(|i| {
                    let f = (i as f64 + 0.5) / PLACES as f64;
                    let jet = joint.chain.jet(f);
                    let (n, m) = (self.normal(a, jet.p), self.normal(b, jet.p));
                    (math::atan2(n.cross(m).dot(jet.d1.normalize_or_zero()), n.dot(m)), jet.p)
                })
                .collect();
            let smooth = |angle: f64| angle.abs() <= tolerance.angle;
            let bend = if angles.iter().all(|(angle, _)| smooth(*angle)) {
                Bend::Smooth
            } else if angles.iter().all(|(angle, _)| !smooth(*angle) && *angle > 0.0) {
                Bend::Ridge
            } else if angles.iter().all(|(angle, _)| !smooth(*angle) && *angle < 0.0) {
                Bend::Valley
            } else {
                let at = angles.iter().min_by(|x, y| x.0.abs().total_cmp(&y.0.abs())).map_or(DVec3::ZERO, |least| least.1);
                let (a, b) = (self.faces[a.face].origin(), self.faces[b.face].origin());
                return Err(WallFault::Edge { wall: origin, a, b, at, why: WallEdge::Mixed }.into());
            };
            self.joints[k].bend = bend;
        }
        Ok(self)
    }

    /// The normal of a face at a place of its border.
    pub fn normal(&self, at: Use, p: DVec3) -> DVec3 {
        let boundary = &self.boundaries[at.face][at.boundary];
        boundary.jet(nearest(boundary, p), false).map_or(DVec3::ZERO, |jet| jet.normal)
    }
}

/// Borders cut at their corners and where borders of other faces end on them.
fn parted(all: Vec<Vec<Boundary>>, origin: Origin, tolerance: &Tolerance) -> Result<Vec<Vec<Boundary>>> {
    let mut chains: Vec<Vec<Chain>> = Vec::new();
    let mut places: Vec<DVec3> = Vec::new();
    for own in &all {
        let mut row = Vec::new();
        for boundary in own {
            let chain = boundary.copy(0.0, origin, tolerance)?;
            let corner = || tolerance.is_kink(chain.jet_before(1.0).d1, chain.jet(0.0).d1);
            if !chain.is_closed(tolerance) || corner() {
                places.extend([chain.start(), chain.end()]);
            }
            places.extend(boundary.corners(tolerance).into_iter().filter_map(|t| boundary.point(t)));
            row.push(chain);
        }
        chains.push(row);
    }
    let near_by = BoxTree::build(&places.iter().map(|p| Box3::of([*p])).collect::<Vec<_>>());
    let mut kept = vec![false; places.len()];
    for k in 0..places.len() {
        let same = |j: &usize| kept[*j] && tolerance.same_point(places[*j], places[k]);
        kept[k] = !near_by.near(&Box3::of([places[k]]), SAME * tolerance.point).iter().any(same);
    }
    let parts = |boundary: &Boundary, chain: &Chain| -> Vec<Boundary> {
        let on = |p: &DVec3| chain.closest(*p).2 <= SAME * tolerance.point;
        let at_end = |p: DVec3, f: f64| chain.point(f).distance(p) <= SAME * tolerance.point;
        let vertices = near_by.near(&chain.bbox(), SAME * tolerance.point).into_iter().filter(|k| kept[*k]).map(|k| places[k]);
        let here: Vec<DVec3> = vertices.filter(on).collect();
        let inner = here.iter().filter(|p| !at_end(**p, 0.0) && !at_end(**p, 1.0));
        let mut cuts: Vec<f64> = inner.map(|p| nearest(boundary, *p)).collect();
        cuts.sort_by(f64::total_cmp);
        let closed = chain.is_closed(tolerance);
        let starts = here.iter().any(|p| at_end(*p, 0.0));
        if closed && !starts {
            let next = |k: usize| if k + 1 < cuts.len() { cuts[k + 1] } else { cuts[0] + 1.0 };
            return if cuts.is_empty() {
                vec![boundary.clone()]
            } else {
                (0..cuts.len()).map(|k| boundary.between(cuts[k], next(k))).collect()
            };
        }
        let stops = [vec![0.0], cuts, vec![1.0]].concat();
        stops.windows(2).map(|w| boundary.between(w[0], w[1])).collect()
    };
    Ok(all
        .iter()
        .zip(&chains)
        .map(|(own, row)| own.iter().zip(row).flat_map(|(boundary, chain)| parts(boundary, chain)).collect())
        .collect())
}

/// The parameter of a border nearest to a point: by places, then by halving steps.
pub(crate) fn nearest(boundary: &Boundary, p: DVec3) -> f64 {
    const STEPS: usize = 32;
    // Each place is looked at once: this is asked at many places of every edge.
    let off = |t: f64| (t, boundary.point(t).map_or(f64::INFINITY, |q| q.distance(p)));
    let least = |a: &(f64, f64), b: &(f64, f64)| a.1.total_cmp(&b.1);
    let start = (0..=STEPS).map(|k| off(k as f64 / STEPS as f64)).min_by(least).unwrap_or_default();
    let nearer = |(mut best, mut apart): (f64, f64)| {
        let mut step = 0.5 / STEPS as f64;
        while step > crate::base::tolerance::NEAREST {
            let next = [best - step, best + step].into_iter().filter(|t| (0.0..=1.0).contains(t)).map(off).min_by(least);
            match next {
                Some(next) if next.1 < apart => (best, apart) = next,
                _ => step *= 0.5,
            }
        }
        (best, apart)
    };
    // A closed border comes to its start from both sides.
    let ends = (start.0 == 0.0 || start.0 == 1.0).then(|| off(1.0 - start.0));
    let best = std::iter::once(start).chain(ends).map(nearer).min_by(least).unwrap_or_default().0;
    // A corner to the last bit: on its other side the border has another direction.
    boundary.stops().into_iter().find(|t| (*t - best).abs() <= NUDGE).unwrap_or(best)
}

/// The first two free borders of different faces of which one lies on the other.
fn overlap<'a>(joints: &'a [Joint], tolerance: &Tolerance) -> Option<(&'a Joint, &'a Joint)> {
    let free: Vec<&Joint> = joints.iter().filter(|joint| joint.uses.len() == 1).collect();
    let boxes: Vec<Box3> = free.iter().map(|joint| joint.chain.bbox()).collect();
    let near_by = BoxTree::build(&boxes);
    (0..free.len()).find_map(|k| {
        let (a, others) = (free[k], near_by.near(&boxes[k], tolerance.point));
        let lies = |b: &Joint| lies_on(&a.chain, &b.chain, tolerance) || lies_on(&b.chain, &a.chain, tolerance);
        let other = others.into_iter().filter(|j| *j > k).map(|j| free[j]).find(|b| a.uses[0].face != b.uses[0].face && lies(b));
        other.map(|b| (a, b))
    })
}

/// Whether all of a chain is on another one.
fn lies_on(a: &Chain, b: &Chain, tolerance: &Tolerance) -> bool {
    [0.21, 0.5, 0.83].iter().all(|f| b.closest(a.point(*f)).2 <= tolerance.point)
}

/// Whether two chains are one: the ends and places between them.
fn same(a: &Chain, b: &Chain, tolerance: &Tolerance) -> bool {
    let near = |p: DVec3, q: DVec3| p.distance(q) <= SAME * tolerance.point;
    let ends = near(a.start(), b.start()) && near(a.end(), b.end()) || near(a.start(), b.end()) && near(a.end(), b.start());
    let closed = a.is_closed(tolerance) && b.is_closed(tolerance);
    (ends || closed) && lies_on(a, b, tolerance) && lies_on(b, a, tolerance)
}
