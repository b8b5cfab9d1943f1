//! Bodies that stand twice in the same place.

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::tolerance::{STATED, Tolerance};
use crate::io::cad::part::{Group, Part};
use crate::model::measure;
use crate::surface::Surface;

/// The faces of a body and the box round them. Boxes are compared first, then face by face.
struct Outline<'p> {
    body: &'p Group,
    faces: Vec<&'p Surface>,
    hull: Box3,
}

fn near(a: Box3, b: Box3, room: f64) -> bool {
    a.min.distance(b.min).max(a.max.distance(b.max)) <= room
}

impl Outline<'_> {
    /// Whether each face has one of the other body in its place.
    fn equals(&self, other: &Self, room: f64) -> bool {
        if self.faces.len() != other.faces.len() || !near(self.hull, other.hull, room) {
            return false;
        }
        let mut left: Vec<(Box3, &Surface)> = other.faces.iter().map(|face| (face.hull(), *face)).collect();
        self.faces.iter().all(|face| {
            job::poll();
            let (hull, area) = (face.hull(), measure::area(face));
            let same = |(there, of): &(Box3, &Surface)| near(hull, *there, room) && (measure::area(of) - area).abs() <= STATED * area;
            left.iter().position(same).map(|k| left.swap_remove(k)).is_some()
        })
    }
}

impl Part {
    /// Names of solids, and of shells that are no part of one, where the same one stands in the same place before it: pairs of first and second.
    pub fn doubled(&self, tolerance: &Tolerance) -> Vec<(String, String)> {
        let in_solids: std::collections::BTreeSet<usize> = self.solids.iter().flat_map(|solid| solid.surfaces.iter().copied()).collect();
        let sheets = self.shells.iter().filter(|shell| shell.surfaces.iter().all(|k| !in_solids.contains(k)));
        let outline = |body| {
            let group: &Group = body;
            let faces: Vec<&Surface> = group.surfaces.iter().filter_map(|k| self.built.get(*k)).flatten().collect();
            let hull = faces.iter().fold(Box3::EMPTY, |all, face| all.union(face.hull()));
            Outline { body: group, faces, hull }
        };
        let mut bodies: Vec<Outline> = self.solids.iter().chain(sheets).map(outline).filter(|body| !body.faces.is_empty()).collect();
        bodies.sort_by(|a, b| a.hull.min.x.total_cmp(&b.hull.min.x));
        let room = tolerance.point;
        let mut found = Vec::new();
        for (k, body) in bodies.iter().enumerate() {
            let before = bodies[..k].iter().rev().take_while(|other| body.hull.min.x - other.hull.min.x <= room);
            if let Some(first) = before.into_iter().find(|other| other.equals(body, room)) {
                found.push((first.body.name.clone(), body.body.name.clone()));
            }
        }
        found
    }
}
