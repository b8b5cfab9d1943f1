//! Faces of a mesh made ready, and filled: nodes and elements in the arrays of the mesh.

use glam::DVec3;

use crate::base::digest::Digest;
use crate::base::fault::Result;
use crate::base::job::Job;
use crate::base::{par, work};
use crate::mesh::cache::reuse::{CacheView, Inside};
use crate::mesh::chart::face_input::{FaceInput, empty};
use crate::mesh::data::face_geometry::FaceNodes;
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::data::mesh::Mesh;
use crate::mesh::divide::relations::Relations;
use crate::mesh::face::mapped::{self, refuse_triangles};
use crate::mesh::pipeline::free_face;
use crate::mesh::request::input::Input;
use crate::mesh::request::work::too_many;

/// Places and ids of the nodes of all faces; free ones are left empty, since nothing else depends on what is in them.
pub(crate) fn prepare(made: &FaceInput, relations: &Relations, counts: &[u32]) -> Result<Vec<FaceMesh>> {
    let layout = made.layout;
    let mut prepared = par::try_map(layout.faces.len(), |f| {
        if layout.faces[f].free {
            return Ok(empty(made, &layout.faces[f]));
        }
        let rows: Vec<u32> = relations.of_face[f].iter().map(|r| counts[*r]).collect();
        mapped::prepare(made.input, layout, made.nodes, &layout.faces[f], &rows)
    })?;
    refuse_triangles(made.input, layout, &prepared)?;
    number(made, &mut prepared);
    Ok(prepared)
}

/// Free faces that are made before their elements are counted against what a mesh may have.
const AT_A_TIME: usize = 64;

/// Makes the free faces; E217 for more elements than a mesh may have.
pub(crate) fn free(made: &FaceInput, prepared: &mut [FaceMesh], (known, job): (Option<&CacheView>, &Job)) -> Result<()> {
    let faces = &made.layout.faces;
    let which: Vec<usize> = (0..faces.len()).filter(|f| faces[*f].free).collect();
    job.expect(which.len() as u64);
    let mut total: u64 = (0..faces.len()).filter(|f| !faces[*f].free).map(|f| prepared[f].triangles + prepared[f].quads).sum();
    for some in which.chunks(AT_A_TIME) {
        let ready = par::try_map(some.len(), |k| {
            job.go_on()?;
            let ready = free_face::prepare(made, &faces[some[k]], (known, job));
            job.advance(1);
            ready
        })?;
        for (f, ready) in some.iter().zip(ready) {
            total += ready.triangles + ready.quads;
            prepared[*f] = ready;
        }
        if total > made.input.plan.most_elements {
            return Err(too_many(made.input.plan, made.input.plan.size_origin(), None));
        }
    }
    number(made, prepared);
    Ok(())
}

/// Ids of the inner nodes, face by face.
pub(crate) fn number(made: &FaceInput, prepared: &mut [FaceMesh]) {
    let mut first = made.nodes.total;
    for ready in prepared.iter_mut() {
        ready.number(first);
        first += ready.inner as u32;
    }
}

/// One face being filled: its parts of the arrays.
struct Fill<'a> {
    ready: &'a FaceMesh,
    key: Option<(&'a CacheView<'a>, Digest)>,
    again: bool,
    nodes: &'a mut [DVec3],
    triangles: &'a mut [[u32; 3]],
    quads: &'a mut [[u32; 4]],
    result: Result<()>,
}

impl Fill<'_> {
    fn fill(&mut self, input: &Input, border: &[DVec3]) {
        let found = |(known, key): (&CacheView, Digest)| if self.again { known.inside_again(key) } else { known.inside(key) };
        if let Some(inside) = self.key.and_then(found)
            && inside.nodes.len() == self.nodes.len()
        {
            self.nodes.copy_from_slice(&inside.nodes);
            return self.ready.fill(&inside.diagonals, self.triangles, self.quads);
        }
        let surface = &input.model.surfaces[self.ready.surface.index()].surface;
        let (diagonals, work) = work::measured(|| {
            self.ready.points(surface, self.nodes);
            let (first, own) = (self.ready.first, &*self.nodes);
            let node = |id: u32| if id < first { border[id as usize] } else { own[(id - first) as usize] };
            self.ready.diagonals(surface, &node, input.tolerance.point)
        });
        self.ready.fill(&diagonals, self.triangles, self.quads);
        if let Some((known, key)) = self.key {
            known.keep_inside(key, (Inside { nodes: self.nodes.to_vec(), diagonals }, work));
        }
    }
}

/// Keys of the faces before free ones have their insides, and whether the mapped ones were filled under them just now.
type Keyed<'a> = (Option<(&'a CacheView<'a>, &'a [Digest])>, bool);

/// All nodes and elements; faces and rows of large faces on several threads.
pub(crate) fn fill(input: &Input, border: &[DVec3], prepared: &[FaceMesh], (keyed, again): Keyed, job: &Job) -> Result<Mesh> {
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
    for (k, ready) in prepared.iter().enumerate() {
        let own;
        (own, inner) = inner.split_at_mut(ready.inner as usize);
        let (t, q);
        (t, triangles) = triangles.split_at_mut(ready.triangles as usize);
        (q, quads) = quads.split_at_mut(ready.quads as usize);
        let free = matches!(ready.geometry.nodes, FaceNodes::Free(..));
        let key = keyed.filter(|_| !free).map(|(known, keys)| (known, keys[k]));
        work.push(Fill { ready, key, again, nodes: own, triangles: t, quads: q, result: Ok(()) });
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
