//! Contacts inside faces: faces that cross each other, and faces that cover each other.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::boxtree::PAIR;
use crate::base::limits::WORK_OF_A_SURFACE;
use crate::base::tolerance::SINGULAR;
use crate::base::{par, work};
use crate::mesh::border::touch::Kind;
use crate::mesh::verify::contacts::ContactSearch;
use crate::surface::faults::CrossingFault;
use crate::surface::intersect::with_surfaces::with_surfaces;
use crate::surface::{Closest, Surface};

/// Bounds of the search for a common point of two faces whose elements cross.
struct CrossingSettings {
    /// Largest number of crossings of elements of two faces that are examined before the faces count as apart.
    max_samples: usize,
    /// Largest number of crossings of elements that the samples are chosen from.
    max_crossings: usize,
    /// Largest number of Newton steps to a point on both faces.
    max_newton_steps: usize,
}

const CROSSINGS: CrossingSettings = CrossingSettings { max_samples: 64, max_crossings: 4096, max_newton_steps: 60 };

impl ContactSearch<'_> {
    /// The place on the surfaces of two faces near a point: on both tangent planes at its feet, as Newton's method has it.
    fn common(&mut self, a: usize, b: usize, near: DVec3) -> Option<DVec3> {
        let scan = self.scan;
        let normal = |face: usize, at: &Closest| scan.input.model.surfaces[scan.surface_of(face).index()].surface.normal(at.uv.0, at.uv.1);
        let mut p = near;
        for _ in 0..CROSSINGS.max_newton_steps {
            let (x, y) = (self.foot(a, p), self.foot(b, p));
            if x.distance.max(y.distance) <= 0.5 * scan.input.tolerance.point {
                return Some(p);
            }
            let (m, n) = (normal(a, &x), normal(b, &y));
            let (off_a, off_b, cosine) = (m.dot(x.point - p), n.dot(y.point - p), m.dot(n));
            let sine2 = m.length_squared() * n.length_squared() - cosine * cosine;
            p = if sine2 > SINGULAR {
                p + (m * (off_a - cosine * off_b) + n * (off_b - cosine * off_a)) / sine2
            } else {
                // Where they are parallel each is the other's foot in turn.
                self.foot(b, x.point).point
            };
        }
        None
    }

    /// Adds a crossing of two faces whose elements cross near a point, if the faces themselves do; whether they do.
    pub(crate) fn crosses(&mut self, a: usize, b: usize, near: DVec3) -> bool {
        let tries = self.tries.entry((a, b)).or_default();
        *tries += 1;
        if *tries > CROSSINGS.max_samples {
            return false;
        }
        let Some(p) = self.common(a, b, near) else { return false };
        if !(self.on(a, p) && self.on(b, p)) || self.scan.is_shared(a, b, p) {
            return false;
        }
        self.add(a, b, Kind::Crossing, 0.0, p);
        true
    }

    /// Faces that lie on each other whatever their borders do, by one point inside each.
    pub(crate) fn insides(&mut self) {
        let scan = self.scan;
        for a in 0..scan.leaves.len() {
            let Some(p) = scan.leaves[a].place(scan.mesh) else { continue };
            let mut near = Vec::new();
            scan.tree.query(&Box3::of([p]), 0.0, |b| near.push(b));
            near.retain(|b| scan.surface_of(a) != scan.surface_of(*b) && scan.leaves[*b].holds(scan.mesh, p));
            near.sort_unstable();
            for b in near {
                let foot = self.foot(a, p).point;
                if self.on(b, foot) {
                    self.add(a, b, Kind::Overlap, 0.0, foot);
                }
            }
        }
    }

    /// Faces on which a border of another one lies as a line, and beside it that face itself.
    pub(crate) fn covered(&mut self) {
        let scan = self.scan;
        for (f, face) in scan.layout.faces.iter().enumerate() {
            for &k in &face.lines {
                let along = &scan.along[k];
                let middle = along[along.len() / 2];
                let others: Vec<usize> = scan.users[middle as usize].iter().map(|n| *n as usize).collect();
                for a in others {
                    let own = scan.layout.faces[a].sides.iter().any(|s| s.uses.iter().any(|u| u.segment == k));
                    if !own || scan.surface_of(a) == scan.surface_of(f) {
                        continue;
                    }
                    let beside = scan.leaves[a].beside(scan.mesh, middle).map(|p| self.foot(a, p).point);
                    if beside.is_some_and(|p| self.on(f, p)) {
                        self.add(a, f, Kind::Overlap, 0.0, scan.p(middle));
                    }
                }
            }
        }
    }

    /// Faces that bend and cross inside both; two planes cross where a border of one goes through the other.
    pub(crate) fn crossings(&mut self) {
        let scan = self.scan;
        let pairs = scan.tree.pairs(0.0, PAIR).into_iter().map(|(a, b)| (a as usize, b as usize));
        let wanted = |(a, b): &(usize, usize)| {
            let flat = scan.leaves[*a].is_flat() && scan.leaves[*b].is_flat();
            !flat && scan.surface_of(*a) != scan.surface_of(*b) && !self.touches.contains_key(&scan.key(*a, *b))
        };
        let pairs: Vec<(usize, usize)> = pairs.filter(wanted).collect();
        let found = par::map(pairs.len(), |n| {
            scan.leaves[pairs[n].0].crossings(scan.mesh, &scan.leaves[pairs[n].1], scan.mesh, CROSSINGS.max_crossings)
        });
        let mut uncrossed = Vec::new();
        for ((a, b), places) in pairs.into_iter().zip(found) {
            if places.is_empty() {
                uncrossed.push((a, b));
                continue;
            }
            // Evenly among all, so that none hides behind many in one place.
            let step = places.len().div_ceil(CROSSINGS.max_samples);
            for at in places.into_iter().step_by(step) {
                if self.touches.contains_key(&scan.key(a, b)) || self.crosses(a, b, at) {
                    break;
                }
            }
        }
        // What bends between its nodes may cross where no element does.
        uncrossed.retain(|(a, b)| !scan.are_neighbours(*a, *b) && scan.leaves[*a].near(&scan.leaves[*b]));
        let surface = |face: usize| &scan.input.model.surfaces[scan.surface_of(face).index()].surface;
        // Parts cut from one surface lie on each other or do not meet, which their elements tell.
        let of_one = |a: &Surface, b: &Surface| a.part_of().iter().any(|whole| b.part_of().iter().any(|other| whole.is(other)));
        let is_open = |(a, b): &(usize, usize)| !self.touches.contains_key(&scan.key(*a, *b)) && !of_one(surface(*a), surface(*b));
        let mut pairs: Vec<(usize, usize)> = uncrossed.into_iter().filter(is_open).collect();
        pairs.dedup_by_key(|(a, b)| (scan.surface_of(*a), scan.surface_of(*b)));
        // Walls of a thin shell: as many pairs as faces, each intersected.
        if let Some(budget) = work::budget() {
            budget.allow(pairs.len() as u64 * WORK_OF_A_SURFACE);
        }
        let found = par::map(pairs.len(), |n| {
            let (a, b) = (surface(pairs[n].0), surface(pairs[n].1));
            let common = with_surfaces(std::slice::from_ref(a), std::slice::from_ref(b), scan.input.plan.origin, scan.input.tolerance);
            match common {
                Ok(common) => common.curves.first().map(|curve| (Kind::Crossing, curve.point(0.5))),
                Err(fault) => match fault.of() {
                    Some(CrossingFault::RunAlong { at, .. }) => Some((Kind::Overlap, *at)),
                    _ => Some((Kind::Unknown, scan.between(pairs[n].0, pairs[n].1))),
                },
            }
        });
        for ((a, b), found) in pairs.into_iter().zip(found) {
            // Faces within the tolerance beside each other do not lie on each other.
            let lies = |search: &mut Self, at: DVec3| search.on(a, at) && search.on(b, at);
            match found {
                Some((Kind::Overlap, at)) if !lies(self, at) => {}
                Some((kind, at)) => self.add(a, b, kind, 0.0, at),
                None => {}
            }
        }
    }
}
