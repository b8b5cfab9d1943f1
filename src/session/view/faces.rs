//! Surfaces as buffers: the triangles of all patches of one surface, and the edges around them.

use std::collections::BTreeSet;

use glam::DVec3;
use serde_json::json;

use super::buffer::{Buffer, Role, Writer};
use super::held::patch_name;
use super::lines::{self, Polyline};
use crate::base::tolerance::Tolerance;
use crate::draw::Sheet;
use crate::draw::faces::{self as display, Show};
use crate::draw::lines::track;
use crate::lang::eval::scene::Scene;
use crate::model::SurfaceId;

/// Surfaces of a scene, `true` for the other side of one, as triangles not farther than `fine` from them, model units; `None` where
/// there are none. Gives also how many patches have no triangles that can be drawn.
pub(super) fn triangles(scene: &Scene, ids: &[(SurfaceId, bool)], fine: f64) -> (Option<Buffer>, usize) {
    let sheets: Vec<Sheet> =
        ids.iter().flat_map(|(id, flipped)| display::surface(&scene.model, *id, *flipped, fine, Show::Bends)).collect();
    let (mut points, mut normals, mut corners, mut of) = (Vec::<DVec3>::new(), Vec::<DVec3>::new(), Vec::<[u32; 3]>::new(), Vec::new());
    let mut bends: Vec<[f32; 2]> = Vec::new();
    let (mut names, mut lost) = (Vec::new(), 0);
    let (mut place, mut last) = (0, "");
    for (k, sheet) in sheets.iter().enumerate() {
        place = if sheet.name == last { place + 1 } else { 0 };
        last = &sheet.name;
        let alone = place == 0 && sheets.get(k + 1).is_none_or(|next| next.name != sheet.name);
        names.push(if alone { sheet.name.clone() } else { patch_name(&sheet.name, place) });
        if sheet.triangles.is_empty() || sheet.points.iter().any(|p| !p.is_finite()) {
            lost += 1;
            continue;
        }
        let first = points.len() as u32;
        let flat = sheet.normals.len() != sheet.points.len();
        points.extend(&sheet.points);
        if flat {
            normals.resize(points.len(), DVec3::ZERO);
        } else {
            normals.extend(&sheet.normals);
        }
        corners.extend(sheet.triangles.iter().map(|t| t.map(|c| c + first)));
        bends.extend(&sheet.bends);
        of.extend(std::iter::repeat_n(k as u32, sheet.triangles.len()));
    }
    if corners.is_empty() {
        return (None, lost);
    }
    let mut writer = Writer::new(Role::Faces);
    writer.positions(&points);
    writer.normals(&normals);
    if bends.len() == points.len() {
        writer.reals("curvature", 2, bends.as_flattened().iter().copied());
    }
    writer.corners("triangles", &corners);
    writer.places("face", names.len(), of.into_iter());
    writer.say("faces", names.iter().map(|name| json!({"name": name, "area": null, "neighbours": []})).collect::<Vec<_>>());
    (Some(writer.finish()), lost)
}

/// The edges of some surfaces as lines; borders up to `near` apart are one edge.
pub(super) fn edges(scene: &Scene, members: &BTreeSet<SurfaceId>, near: f64, fine: f64, tolerance: &Tolerance) -> Option<Buffer> {
    let pieces = scene.model.edge_pieces(members, near, &scene.network, tolerance);
    let line = |(k, piece): (usize, &crate::model::EdgePiece)| {
        let count = u8::try_from(piece.surfaces.len()).unwrap_or(u8::MAX);
        Polyline { name: format!("edge {}", k + 1), points: track(&piece.track, piece.s, fine), length: piece.s.1 - piece.s.0, count }
    };
    lines::buffer(Role::Edges, &pieces.iter().enumerate().map(line).collect::<Vec<_>>())
}
