//! The surface model: patches on surfaces, edges and vertices shared between them, shells [Koh & Park 1990, §4.3].

use glam::DVec3;

use super::patches::Lines;
use super::trace::Track;
use super::{glue, patches};
use crate::base::fault::{Fault, Result};
use crate::base::job::Job;
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::network::{Chain, LinkId, Network, NodeId};
use crate::surface::{Domain, Surface};

crate::ids! {
    /// A surface of the model.
    SurfaceId,
    /// A patch.
    PatchId,
    /// An edge.
    EdgeId,
    /// A vertex.
    VertexId,
    /// A shell.
    ShellId,
}

/// A corner of patches.
#[derive(Clone, Debug)]
pub struct Vertex {
    /// Where it is.
    pub point: DVec3,
    /// The node of the network there.
    pub node: Option<NodeId>,
}

/// What an edge runs along.
#[derive(Clone, Debug)]
pub enum EdgeCurve {
    /// Links of the network with direction flags, of which the edge may use a part: arc lengths from the start of the first to the end of the run.
    Links {
        /// Links in order, `true` where the edge runs against one.
        links: Vec<(LinkId, bool)>,
        /// Arc length along these links where the edge begins and ends.
        span: (f64, f64),
    },
    /// A chain that is not in the network (construction geometry, a moved copy).
    Run {
        /// The chain.
        chain: Chain,
        /// Arc lengths on it where the edge begins and ends, ascending.
        span: (f64, f64),
    },
    /// An iso-line or free border of a surface between two (u, v).
    Iso {
        /// The surface.
        surface: SurfaceId,
        /// (u, v) of the first vertex.
        from: (f64, f64),
        /// (u, v) of the last vertex.
        to: (f64, f64),
    },
}

/// A border of patches between two vertices.
#[derive(Clone, Debug)]
pub struct Edge {
    /// First and last vertex.
    pub vertices: (VertexId, VertexId),
    /// Its geometry.
    pub curve: EdgeCurve,
    /// Arc length, model units.
    pub length: f64,
    /// Patches that use it, with `true` where the loop runs against the edge.
    pub users: Vec<(PatchId, bool)>,
}

/// One side of a patch: edges in the direction of ascending u or v.
#[derive(Clone, Debug, Default)]
pub struct PatchSide {
    /// Edges in order with `true` where the side runs against the edge; empty at a pole.
    pub edges: Vec<(EdgeId, bool)>,
    /// The pole's vertex.
    pub pole: Option<VertexId>,
}

/// A smooth piece of a surface.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The surface.
    pub surface: SurfaceId,
    /// Range of u and of v (of the whole triangle for a uniform trilateral).
    pub u: (f64, f64),
    /// Range of v.
    pub v: (f64, f64),
    /// Sides v = min, u = max, v = max, u = min (a triangle: three of them; a plane without a map: any number, round the loop).
    pub sides: Vec<PatchSide>,
}

/// A set of surfaces as one thing.
#[derive(Clone, Debug)]
pub struct Shell {
    /// Name.
    pub name: String,
    /// The expression that made it.
    pub origin: Origin,
    /// Surfaces with `true` where the shell uses the other side.
    pub surfaces: Vec<(SurfaceId, bool)>,
    /// How far apart borders may be and still be one edge, model units.
    pub near: f64,
    /// No edge is free.
    pub closed: bool,
    /// Free edges: surface, middle, length; the longest first.
    pub free: Vec<(SurfaceId, DVec3, f64)>,
}

/// A named surface of the model.
#[derive(Clone, Debug)]
pub struct Named {
    /// Unique name.
    pub name: String,
    /// The surface.
    pub surface: Surface,
}

/// Patches, edges and vertices of all declared surfaces.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Surfaces as given.
    pub surfaces: Vec<Named>,
    /// Patches, surface by surface, u fastest.
    pub patches: Vec<Patch>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Vertices.
    pub vertices: Vec<Vertex>,
}

impl Model {
    /// Splits surfaces into patches at their kinks and glues edges and vertices.
    pub fn build(surfaces: Vec<Named>, network: &Network, tolerance: &Tolerance, job: &Job) -> Result<Self> {
        Self::build_cut(surfaces, &[], network, tolerance, job)
    }

    /// The same, cut along further lines of some surfaces.
    pub fn build_cut(
        surfaces: Vec<Named>,
        lines: &[(SurfaceId, Lines)],
        network: &Network,
        tolerance: &Tolerance,
        job: &Job,
    ) -> Result<Self> {
        let none = Lines::default();
        let pieces = par::try_map(surfaces.len(), |n| {
            job.go_on()?;
            let own = lines.iter().find(|l| l.0.index() == n).map_or(&none, |l| &l.1);
            Ok::<_, Fault>(patches::cut(SurfaceId::at(n), &surfaces, own, network, tolerance))
        })?;
        Ok(glue::glue(surfaces, &pieces, network, tolerance))
    }

    /// Whether side `k` of a patch runs against its loop: ascending u or v is clockwise there.
    pub fn runs_back(&self, patch: &Patch, k: usize) -> bool {
        k >= 2 && self.surfaces[patch.surface.index()].surface.domain() != Domain::Loop
    }

    /// Patches of a surface.
    pub fn patches_of(&self, surface: SurfaceId) -> impl Iterator<Item = PatchId> + '_ {
        let first = self.patches.partition_point(|p| p.surface < surface);
        (first..self.patches.len()).map(PatchId::at).take_while(move |p| self.patches[p.index()].surface == surface)
    }

    /// Edges of some patches, ascending, each once.
    pub fn edges_of(&self, patches: &[PatchId]) -> Vec<EdgeId> {
        let sides = patches.iter().flat_map(|p| &self.patches[p.index()].sides);
        let mut edges: Vec<EdgeId> = sides.flat_map(|s| s.edges.iter().map(|(e, _)| *e)).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Vertices of some patches, ascending, each once.
    pub fn vertices_of(&self, patches: &[PatchId]) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = self
            .edges_of(patches)
            .into_iter()
            .flat_map(|e| <[VertexId; 2]>::from(self.edges[e.index()].vertices))
            .chain(patches.iter().flat_map(|p| &self.patches[p.index()].sides).filter_map(|s| s.pole))
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// The geometry of an edge under its arc length.
    pub fn track(&self, edge: EdgeId, network: &Network) -> Track {
        Track::of(&self.edges[edge.index()].curve, &self.surfaces, network)
    }

    /// What must always hold of patches, edges and vertices; the sentence says what is broken.
    pub fn check(&self) -> std::result::Result<(), String> {
        let mut at_vertex = vec![0_usize; self.vertices.len()];
        for (n, edge) in self.edges.iter().enumerate() {
            if edge.users.is_empty() {
                return Err(format!("edge {n} is on no patch"));
            }
            if edge.length.is_nan() || edge.length <= 0.0 {
                return Err(format!("edge {n} has length {}", edge.length));
            }
            for vertex in [edge.vertices.0, edge.vertices.1] {
                *at_vertex.get_mut(vertex.index()).ok_or(format!("edge {n} ends at no vertex"))? += 1;
            }
        }
        if !self.patches.is_sorted_by_key(|p| p.surface) {
            return Err("patches do not come in the order of their surfaces".to_owned());
        }
        for (n, patch) in self.patches.iter().enumerate() {
            self.check_patch(PatchId::at(n), patch)?;
            patch.sides.iter().filter_map(|s| s.pole).for_each(|v| at_vertex[v.index()] += 1);
        }
        match at_vertex.iter().position(|n| *n == 0) {
            Some(vertex) => Err(format!("vertex {vertex} has no edge")),
            None => Ok(()),
        }
    }

    /// Each side is a run of edges that know their patch; each side ends where the next one starts.
    fn check_patch(&self, id: PatchId, patch: &Patch) -> std::result::Result<(), String> {
        let name = id.index();
        if patch.surface.index() >= self.surfaces.len() {
            return Err(format!("patch {name} is on no surface"));
        }
        let mut corners = Vec::new();
        for (k, side) in patch.sides.iter().enumerate() {
            let backwards = self.runs_back(patch, k);
            let mut run = Vec::new();
            for (edge, against) in &side.edges {
                let record = &self.edges[edge.index()];
                if !record.users.contains(&(id, *against != backwards)) {
                    return Err(format!("edge {} does not know patch {name}", edge.index()));
                }
                let (a, b) = record.vertices;
                run.push(if *against { (b, a) } else { (a, b) });
            }
            if run.windows(2).any(|w| w[0].1 != w[1].0) {
                return Err(format!("side {k} of patch {name} is broken"));
            }
            let ends = match (side.pole, run.first(), run.last()) {
                (Some(pole), None, None) => (pole, pole),
                (None, Some(first), Some(last)) => (first.0, last.1),
                _ => return Err(format!("side {k} of patch {name} is neither a run of edges nor a pole")),
            };
            corners.push(if backwards { (ends.1, ends.0) } else { ends });
        }
        let surface = &self.surfaces[patch.surface.index()].surface;
        let loops = if surface.domain() == Domain::Loop { surface.loops() } else { vec![corners.len()] };
        let mut rest = corners.as_slice();
        let joined = loops.iter().all(|n| {
            let (own, others) = rest.split_at(*n);
            rest = others;
            (0..*n).all(|k| own[k].1 == own[(k + 1) % n].0)
        });
        if joined { Ok(()) } else { Err(format!("the loop of patch {name} does not close")) }
    }
}
