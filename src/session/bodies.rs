//! Which surfaces of a mesh are made apart: bodies of imported parts, which may touch without sharing a node.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::scene::Scene;
use crate::mesh::Plan;
use crate::model::SurfaceId;
use crate::model::glue::{join, root};
use crate::surface::Nearest;

/// Places along a curve at which it is looked for on a surface, besides its start.
const SAMPLES: usize = 16;

/// The body of each surface that shares nodes with its own body alone, by a number; `bodies` are those of the plan.
///
/// Bodies of which a face is the same one are one, and so are those that surfaces of no body join by borders that they share with
/// them. What the curves and points of the plan lie on is listed under no body, as they are: it is made with them.
pub fn apart(plan: &Plan, bodies: &[BTreeSet<SurfaceId>], scene: &Scene, tolerance: &Tolerance) -> BTreeMap<SurfaceId, usize> {
    if bodies.len() < 2 || !plan.settings.conforming() {
        return BTreeMap::new();
    }
    let members: BTreeSet<SurfaceId> = plan.surfaces.iter().map(|s| s.0).collect();
    let mut of_body: BTreeMap<SurfaceId, usize> = BTreeMap::new();
    // Bodies, then the curves and points, then the other surfaces.
    let lines = bodies.len();
    let mut parent: Vec<usize> = (0..=lines).collect();
    for (k, body) in bodies.iter().enumerate() {
        body.iter().for_each(|s| join(&mut parent, *of_body.entry(*s).or_insert(k), k));
    }
    let mut place = of_body.clone();
    for surface in members.iter().filter(|s| !of_body.contains_key(s)) {
        place.insert(*surface, parent.len());
        parent.push(parent.len());
    }
    if place.len() > of_body.len() {
        let near = plan.glue.values().fold(tolerance.point, |near, own| near.max(*own));
        for stretch in scene.model.edge_pieces(&members, near, &scene.network, tolerance) {
            // Bodies by themselves are not joined.
            if let Some(other) = stretch.surfaces.iter().find(|s| !of_body.contains_key(s)) {
                stretch.surfaces.iter().for_each(|s| join(&mut parent, place[other], place[s]));
            }
        }
    }
    let lines_at: Vec<(Box3, Vec<DVec3>)> = stations(plan).map(|points| (Box3::of(points.iter().copied()), points)).collect();
    for (surface, own) in &place {
        let near = plan.glue.get(surface).copied().unwrap_or(tolerance.point);
        let surface = &scene.model.surfaces[surface.index()].surface;
        let hull = surface.hull();
        let beside: Vec<&[DVec3]> = lines_at.iter().filter(|(around, _)| hull.touches(around, near)).map(|l| l.1.as_slice()).collect();
        if beside.is_empty() || root(&mut parent, *own) == root(&mut parent, lines) {
            continue;
        }
        let nearest = Nearest::new(surface);
        if beside.into_iter().flatten().any(|p| nearest.at(*p).distance <= near) {
            join(&mut parent, lines, *own);
        }
    }
    let with_lines = root(&mut parent, lines);
    let held: BTreeSet<usize> = (0..lines).map(|k| root(&mut parent, k)).filter(|k| *k != with_lines).collect();
    place.into_iter().map(|(surface, own)| (surface, root(&mut parent, own))).filter(|(_, own)| held.contains(own)).collect()
}

/// Points of each curve and point of a plan.
fn stations(plan: &Plan) -> impl Iterator<Item = Vec<DVec3>> + '_ {
    let along = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64);
    let curves = plan.curves.iter().map(move |(_, chain)| along.clone().map(|f| chain.point(f)).collect());
    curves.chain(plan.points.iter().map(|p| vec![*p]))
}
