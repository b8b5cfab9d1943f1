//! Faces of a mesh prepared, and filled: nodes and elements in the arrays of the mesh.

use glam::DVec3;

use crate::base::digest::Digest;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::{par, work};
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::cache::reuse::{CacheView, Inside, KeyedFaces};
use crate::mesh::chart::face_input::{FaceInput, empty};
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::{FaceMesh, SlidNode};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::divide::relations::Relations;
use crate::mesh::face::mapped::{self, refuse_triangles};
use crate::mesh::mapped::diagonals::DiagonalRule;
use crate::mesh::pipeline::free_face;
use crate::mesh::request::input::Input;
use crate::mesh::request::work::too_many;

/// Places and ids of the nodes of all faces; free ones are left empty, since nothing else depends on what is in them.
pub(crate) fn prepare(face_input: &FaceInput, relations: &Relations, counts: &[u32]) -> Result<Vec<FaceMesh>> {
    let layout = face_input.layout;
    let mut prepared = par::try_map(layout.faces.len(), |f| {
        if layout.faces[f].free {
            return Ok(empty(face_input, &layout.faces[f]));
        }
        let rows: Vec<u32> = relations.of_face[f].iter().map(|r| counts[*r]).collect();
        mapped::prepare(face_input.input, layout, face_input.nodes, &layout.faces[f], &rows)
    })?;
    refuse_triangles(face_input.input, layout, &prepared)?;
    number(face_input, &mut prepared);
    Ok(prepared)
}

/// How diagonals of mapped triangles are chosen.
pub(crate) fn diagonal_rule(input: &Input) -> DiagonalRule {
    let settings = &input.plan.settings;
    DiagonalRule { even: input.tolerance.point, limited: settings.chord_error.is_some() || settings.angle_error.is_some() }
}

/// Number of free faces that are made before their elements are compared with the largest number of a mesh.
const BATCH_SIZE: usize = 64;

/// Makes the free faces; E217 for more elements than a mesh may have.
pub(crate) fn free(face_input: &FaceInput, prepared: &mut [FaceMesh], cache: Option<&CacheView>, job: &Job) -> Result<()> {
    let faces = &face_input.layout.faces;
    let which: Vec<usize> = (0..faces.len()).filter(|f| faces[*f].free).collect();
    job.expect(which.len() as u64);
    let mut total: u64 = (0..faces.len()).filter(|f| !faces[*f].free).map(|f| prepared[f].triangles + prepared[f].quads).sum();
    for some in which.chunks(BATCH_SIZE) {
        let face_mesh = par::try_map(some.len(), |k| {
            job.go_on()?;
            let face_mesh = free_face::prepare(face_input, &faces[some[k]], cache, job);
            job.advance(1);
            face_mesh
        })?;
        for (f, face_mesh) in some.iter().zip(face_mesh) {
            total += face_mesh.triangles + face_mesh.quads;
            prepared[*f] = face_mesh;
        }
        if total > face_input.input.plan.most_elements {
            return Err(too_many(face_input.input.plan, face_input.input.plan.size_origin(), None));
        }
    }
    number(face_input, prepared);
    Ok(())
}

/// Moves the border nodes that slid while their faces were made.
pub(crate) fn slide(layout: &Layout, nodes: &mut Nodes, border: &mut [DVec3], prepared: &[FaceMesh]) {
    for face_mesh in prepared {
        let (FaceNodes::Free(_, ids), Some(inside)) = (&face_mesh.geometry.nodes, &face_mesh.inside) else { continue };
        for SlidNode { node, fraction } in &inside.slid {
            let id = ids[*node as usize];
            let Some((segment, place)) = nodes.on_segment(id) else {
                debug_assert!(false, "node {id} slid and is inside no segment");
                continue;
            };
            nodes.slide(segment, place, *fraction);
            border[id as usize] = layout.point(segment, *fraction);
        }
    }
}

/// Ids of the inner nodes, face by face.
pub(crate) fn number(face_input: &FaceInput, prepared: &mut [FaceMesh]) {
    let mut first = face_input.nodes.total;
    for face_mesh in prepared.iter_mut() {
        face_mesh.number(first);
        first += face_mesh.inner as u32;
    }
}

/// One face being filled: its parts of the arrays.
struct Fill<'a> {
    face_mesh: &'a FaceMesh,
    key: Option<(&'a CacheView<'a>, Digest)>,
    refill: Refill,
    nodes: &'a mut [DVec3],
    triangles: &'a mut [[u32; 3]],
    quads: &'a mut [[u32; 4]],
    result: Result<()>,
}

impl Fill<'_> {
    fn fill(&mut self, input: &Input, border: &[DVec3]) {
        let found = |(cache, key): (&CacheView, Digest)| match self.refill {
            Refill::First => cache.inside(key),
            Refill::Again => cache.inside_again(key),
        };
        if let Some(inside) = self.key.and_then(found)
            && inside.nodes.len() == self.nodes.len()
        {
            self.nodes.copy_from_slice(&inside.nodes);
            return self.face_mesh.fill(&inside.diagonals, self.triangles, self.quads);
        }
        let surface = &input.model.surfaces[self.face_mesh.surface.index()].surface;
        let (diagonals, work) = work::measured(|| {
            self.face_mesh.points(surface, self.nodes);
            let (first, own) = (self.face_mesh.first, &*self.nodes);
            let node = |id: u32| if id < first { border[id as usize] } else { own[(id - first) as usize] };
            self.face_mesh.diagonals(surface, &node, diagonal_rule(input))
        });
        self.face_mesh.fill(&diagonals, self.triangles, self.quads);
        if let Some((cache, key)) = self.key {
            cache.keep_inside(key, Inside { nodes: self.nodes.to_vec(), diagonals }, work);
        }
    }
}

/// Whether the mapped faces of a mesh were filled before under the same keys: then they do not count as taken from the cache.
#[derive(Clone, Copy)]
pub(crate) enum Refill {
    First,
    Again,
}

/// All nodes and elements; faces and rows of large faces on several threads. `keyed` are the keys of the faces before free ones have their
/// insides.
pub(crate) fn fill(
    input: &Input,
    border: &[DVec3],
    prepared: &[FaceMesh],
    keyed: Option<KeyedFaces>,
    refill: Refill,
    job: &Job,
) -> Result<Mesh> {
    let sum = |f: &dyn Fn(&FaceMesh) -> u64| prepared.iter().map(f).sum::<u64>() as usize;
    let on_border = border.len();
    let mut all = Vec::with_capacity(on_border + sum(&|p| p.inner));
    all.extend_from_slice(border);
    all.resize(on_border + sum(&|p| p.inner), DVec3::ZERO);
    let mut mesh = Mesh { name: input.plan.name.clone(), order: input.plan.settings.order(), nodes: all, ..Mesh::default() };
    mesh.triangles = vec![[0; 3]; sum(&|p| p.triangles)];
    mesh.quads = vec![[0; 4]; sum(&|p| p.quads)];
    let (border, mut inner) = mesh.nodes.split_at_mut(on_border);
    let (border, mut triangles, mut quads) = (&*border, mesh.triangles.as_mut_slice(), mesh.quads.as_mut_slice());
    let mut work = Vec::new();
    for (k, face_mesh) in prepared.iter().enumerate() {
        let own;
        (own, inner) = inner.split_at_mut(face_mesh.inner as usize);
        let (t, q);
        (t, triangles) = triangles.split_at_mut(face_mesh.triangles as usize);
        (q, quads) = quads.split_at_mut(face_mesh.quads as usize);
        let free = matches!(face_mesh.geometry.nodes, FaceNodes::Free(..));
        let key = keyed.filter(|_| !free).map(|keyed| (keyed.cache, keyed.keys[k]));
        work.push(Fill { face_mesh, key, refill, nodes: own, triangles: t, quads: q, result: Ok(()) });
    }
    job.expect(work.len() as u64);
    par::chunks_mut(&mut work, 1, |_, faces| {
        for face in faces {
            face.result = job.go_on();
            if face.result.is_ok() {
                face.fill(input, border);
                job.advance(1);
            }
        }
    });
    work.into_iter().try_for_each(|face| face.result)?;
    Ok(mesh)
}
