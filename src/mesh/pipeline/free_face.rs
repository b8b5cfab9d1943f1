//! A free face made, or taken over from an earlier run.

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
use crate::mesh::data::face_mesh::{FaceMesh, FreeInside};
use crate::mesh::face::free::grown;
use crate::mesh::request::work::{too_much_work, work_on};
use crate::mesh::tri::fit::near;
use crate::mesh::tri::trouble::no_area;

/// Makes the face, or takes it over from an earlier run.
pub fn prepare(made: &FaceInput, face: &Face, (known, job): (Option<&CacheView>, &Job)) -> Result<FaceMesh> {
    let (border, chart, mut outline) = outlined(made, face).ok_or_else(|| no_area(made, face))?;
    if face.halved > 0 && face.is_grown() {
        rings::add_rings(made, face, &border, &chart, &mut outline);
    }
    let key = known.map(|known| {
        let odd = if face.takes_quads() { odd(made, face) } else { Vec::new() };
        (known, cached_face::key(known, made, face, (&border, &outline), (&odd, &near(made, face, &outline))))
    });
    if let Some((known, key)) = key
        && let Some((free, points, deciders, tally)) = known.free(key).and_then(|taken| taken.parts(border.uv.len()))
    {
        return Ok(prepared(made, face, free, border.ids, FreeInside { points, loops: border.edges, deciders, tally }));
    }
    let all = || grown(made, face, (border, chart, outline), job);
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    // What is tried again with shorter steps of its border, because nothing kept its limits, may take less.
    let again = if face.method.is_coarse() { face.halved.min(FEWER) } else { 0 };
    let most = work_on([surface].into_iter()) >> again;
    let ready = Budget::new(most).within(all).map_err(|Exceeded| too_much_work(made.input, surface.origin()))??;
    if let (Some((known, key)), FaceNodes::Free(free, _), Some(inside)) = (key, &ready.geometry.nodes, &ready.inside) {
        known.keep_free(key, CachedFace::of(free, inside));
    }
    Ok(ready)
}

/// Times that the work of a face which is tried again is halved.
const FEWER: u32 = 2;
