//! A free face, computed or taken from the cache.

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::work::{Budget, Exceeded};
use crate::mesh::border::layout::Face;
use crate::mesh::cache::cached_face::{self, CachedFace};
use crate::mesh::cache::reuse::CacheView;
use crate::mesh::chart::face_input::{FaceInput, outlined, prepared};
use crate::mesh::chart::halved::odd;
use crate::mesh::chart::rings;
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::face::free::filled;
use crate::mesh::request::work::{too_much_work, work_on};
use crate::mesh::tri::no_mesh::no_area;
use crate::mesh::tri::sliding_border::SlidingBorder;
use crate::mesh::tri::triangle_fit::near;

/// Computes the face, or takes it from the cache.
pub fn prepare(face_input: &FaceInput, face: &Face, cache: Option<&CacheView>, job: &Job) -> Result<FaceMesh> {
    let (border, chart, mut outline) = outlined(face_input, face).ok_or_else(|| no_area(face_input, face))?;
    if face.halved > 0 && face.is_grown() {
        rings::add_rings(face_input, face, &border, &chart, &mut outline);
    }
    let sliding = SlidingBorder::new(face_input, face, &chart, &border);
    let sliding = sliding.as_ref();
    let key = cache.map(|cache| {
        let odd = if face.takes_quads() { odd(face_input, face) } else { Vec::new() };
        let rules = near(face_input, face, &outline);
        (
            cache,
            cached_face::FaceKey { face_input, face, border: &border, outline: &outline, odd: &odd, rules: &rules, sliding }.digest(cache),
        )
    });
    if let Some((cache, key)) = key
        && let Some((free, inside)) = cache.free(key).and_then(|cached| cached.parts(border.uv.len(), &border.edges))
    {
        return Ok(prepared(face_input, face, free, border.ids, inside));
    }
    let all = || filled(face_input, face, border, &chart, &outline, sliding, job);
    let surface = &face_input.input.model.surfaces[face.surface.index()].surface;
    // A face that is tried again with shorter steps of its border, because nothing kept its limits, gets a smaller budget.
    let halvings = if face.method.is_coarse() { face.halved.min(MAX_BUDGET_HALVINGS) } else { 0 };
    let most = work_on([surface].into_iter()) >> halvings;
    let face_mesh = Budget::new(most).within(all).map_err(|Exceeded| too_much_work(face_input.input, surface.origin()))??;
    if let (Some((cache, key)), FaceNodes::Free(free, _), Some(inside)) = (key, &face_mesh.geometry.nodes, &face_mesh.inside) {
        cache.keep_free(key, CachedFace::of(free, inside));
    }
    Ok(face_mesh)
}

/// Largest number of times that the work budget of a face which is tried again is halved.
const MAX_BUDGET_HALVINGS: u32 = 2;
