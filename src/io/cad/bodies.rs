//! Faces that were declared as one thing, with the edges and corners that they share, as writers of solids take them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::base::origin::Origin;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::io::cad::curve_on_surface::fitted;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::degenerate_edges::FileBorders;
use crate::io::cad::edge_pieces;
use crate::io::cad::elementary_surface::{self, Ground};
use crate::model::body::BodyLoop;
use crate::model::{Body, BodyEdge, BodyFace, Model, Shell, SurfaceId, measure};
use crate::network::Network;
use crate::surface::Off;
use crate::surface::analysis::elementary::MovedArc;

/// Faces that were declared as one thing.
#[derive(Clone, Debug)]
pub struct Faces {
    /// The model that has them.
    pub model: Arc<Model>,
    /// The network of the model.
    pub network: Arc<Network>,
    /// The faces with their sides.
    pub shell: Shell,
    /// Skins that close are solids.
    pub solid: bool,
    /// Red, green and blue from 0 to 1 of surfaces that have a colour.
    pub colors: BTreeMap<SurfaceId, [f64; 3]>,
    /// Names of surfaces that have another one in the file than in the model.
    pub names: BTreeMap<SurfaceId, String>,
    /// Layers of surfaces that lie on others than all of the faces do.
    pub layers: BTreeMap<SurfaceId, Vec<String>>,
}

/// Faces with their surfaces, and the edges and corners that they share.
#[derive(Debug)]
pub struct Bodies<'f> {
    /// The faces as they were declared, cut where their exact forms meet.
    pub faces: Cow<'f, Faces>,
    /// Which edges each face has.
    pub body: Body,
    /// The surface of each face.
    pub grounds: Vec<Ground>,
    /// Of nets that are an arc moved or turned, that.
    pub arcs: Vec<Option<MovedArc>>,
    /// Corners as the file has them, model units.
    pub vertices: Vec<DVec3>,
    /// The curve of each edge that some face uses, in the direction of the edge.
    pub curves: Vec<Option<Curve>>,
    /// How far surfaces are from the model's at most, model units; whether all that is known of one are samples.
    pub off: (f64, bool),
    /// Surfaces that are too thin to have a face.
    pub thin: Vec<SurfaceId>,
    /// Area of those of which no face is left, model units.
    pub thin_area: f64,
}

/// A solid by places in the list of skins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SolidSkins {
    /// The skin round it.
    pub outer: usize,
    /// Skins round its cavities; their faces look into them.
    pub voids: Vec<usize>,
}

impl Faces {
    /// The faces as files have them; fails where there is none, where their edges do not close, and for a plane without a border.
    pub fn bodies(&self, tolerance: &Tolerance) -> Result<Bodies<'_>, Defect> {
        let (faces, parted) = match self.in_pieces(tolerance)? {
            Some((cut, parted)) => (Cow::Owned(cut), parted),
            None => (Cow::Borrowed(self), Vec::new()),
        };
        let mut body = faces.model.body(&faces.shell, &faces.network, tolerance)?;
        if body.faces.is_empty() {
            return Err(defect("it is thinner than the gluing distance, so it has no face"));
        }
        let grounds = par::try_map(body.faces.len(), |k| faces.ground(&body.faces[k], tolerance))?;
        let arcs = body.faces.iter().zip(&grounds).map(|(face, ground)| faces.arc(face, ground, tolerance)).collect();
        let placed = FileBorders::new(&body, &grounds, tolerance);
        let mut curves = faces.curves(&body, &placed, tolerance)?;
        let mut vertices = placed.vertices;
        edge_pieces::part_edges(&mut body, &mut vertices, &mut curves, tolerance);
        edge_pieces::without_seams(&mut body, &grounds, &mut curves);
        let is_open = |face: &BodyFace| face.loops.is_empty() || face.loops.iter().any(|around| !body.is_closed(around));
        if body.faces.iter().any(is_open) {
            return Err(defect("the edges round one of its faces do not close"));
        }
        let off = grounds.iter().fold((0.0_f64, false), |off, ground| match ground {
            Ground::Net(_, own, _) => (off.0.max(own.distance()), off.1 || matches!(own, Off::Sampled(_))),
            Ground::Elementary(_) => off,
        });
        let mut thin: Vec<SurfaceId> = body.slivers.iter().map(|patch| faces.model.patches[patch.index()].surface).collect();
        thin.dedup();
        let is_gone = |id: &&SurfaceId| body.faces.iter().all(|face| face.surface != **id);
        // Of a surface that was cut here a piece in its axis is nothing.
        thin.retain(|id| !parted.contains(id) || is_gone(&id));
        let area = |id: &SurfaceId| measure::area(&faces.model.surfaces[id.index()].surface);
        let thin_area = thin.iter().filter(is_gone).map(area).sum();
        Ok(Bodies { grounds, arcs, vertices, curves, off, thin, thin_area, body, faces })
    }

    fn ground(&self, face: &BodyFace, tolerance: &Tolerance) -> Result<Ground, Defect> {
        let surface = &self.model.surfaces[face.surface.index()].surface;
        let found = elementary_surface::ground(surface, &self.model.patches[face.patch.index()], tolerance)?;
        found.ok_or_else(|| defect("a plane without a border is not a face"))
    }

    fn arc(&self, face: &BodyFace, ground: &Ground, tolerance: &Tolerance) -> Option<MovedArc> {
        let patch = &self.model.patches[face.patch.index()];
        match ground {
            Ground::Net(..) if patch.u == (0.0, 1.0) => self.model.surfaces[face.surface.index()].surface.moved_arc(patch.v, tolerance),
            _ => None,
        }
    }

    /// The curves of the edges that some face uses.
    fn curves(&self, body: &Body, placed: &FileBorders, tolerance: &Tolerance) -> Result<Vec<Option<Curve>>, Defect> {
        let mut used = vec![false; body.edges.len()];
        body.faces.iter().flat_map(|face| &face.loops).flatten().for_each(|(edge, _)| used[*edge] = true);
        let curve = |k: usize| placed.curve(k, body.edges[k].ends, self.curve(body, &body.edges[k], tolerance)?, tolerance);
        par::try_map(body.edges.len(), |k| if used[k] { curve(k).map(Some) } else { Ok(None) })
    }

    /// The curve of an edge: the model's where it has one, else a spline within the tolerance of the line on the surface.
    fn curve(&self, body: &Body, edge: &BodyEdge, tolerance: &Tolerance) -> Result<Curve, Defect> {
        let Self { model, network, .. } = self;
        let ends = (body.vertices[edge.ends.0], body.vertices[edge.ends.1]);
        if let Some(patch) = edge.seam
            && let Some(curve) = model.seam_curve(patch, ends, tolerance)?
        {
            return Ok(curve);
        }
        if let Some(curve) = model.part_curve(&edge.part, network, tolerance)? {
            return Ok(curve);
        }
        let track = model.track(edge.part.edge, network);
        let found = fitted(&[edge.part.s.0, edge.part.s.1], tolerance, &|s| Ok(track.point(s)), &|p| p)?;
        let origin = model.surfaces.first().map_or(Origin::NONE, |s| s.surface.origin());
        Ok(Curve::new(Shape::Nurbs(Arc::new(found)), Kind::Spline, origin))
    }
}

impl Bodies<'_> {
    /// Closed skins with the skins inside them, in the order of the skins.
    pub fn solids(&self) -> Vec<SolidSkins> {
        let skins = || self.body.skins.iter().enumerate();
        let outer = skins().filter(|(k, skin)| self.is_solid(*k) && skin.within.is_none());
        let voids = |k: usize| skins().filter(|(_, skin)| skin.within == Some(k)).map(|(n, _)| n).collect();
        outer.map(|(k, _)| SolidSkins { outer: k, voids: voids(k) }).collect()
    }

    /// Skins that bound no solid.
    pub fn sheets(&self) -> Vec<usize> {
        (0..self.body.skins.len()).filter(|k| !self.is_solid(*k)).collect()
    }

    fn is_solid(&self, skin: usize) -> bool {
        self.faces.solid && self.body.skins[skin].closed
    }

    /// Whether a face looks where the normal of its surface in the file does.
    pub fn is_along(&self, face: usize) -> bool {
        self.grounds[face].is_along() != self.body.faces[face].other
    }

    /// The name of a face in the file.
    pub fn name(&self, face: usize) -> &str {
        let id = self.body.faces[face].surface;
        self.faces.names.get(&id).unwrap_or(&self.faces.model.surfaces[id.index()].name)
    }

    /// The colour of a face.
    pub fn color(&self, face: usize) -> Option<[f64; 3]> {
        self.faces.colors.get(&self.body.faces[face].surface).copied()
    }

    /// Layers of a face that all faces together do not have.
    pub fn layers(&self, face: usize) -> &[String] {
        self.faces.layers.get(&self.body.faces[face].surface).map_or(&[], Vec::as_slice)
    }

    /// The loops of a face, run with the face on their left.
    pub fn loops(&self, face: usize) -> &[BodyLoop] {
        &self.body.faces[face].loops
    }

    /// What faces that are too thin are called where they are left out.
    pub fn left_out(&self, whole: &str) -> Option<String> {
        let name = |id: &SurfaceId| &self.faces.model.surfaces[id.index()].name;
        let [first, others @ ..] = self.thin.as_slice() else { return None };
        let (what, are) = match others.len() {
            0 => (format!("the face `{}`", name(first)), "which is"),
            n => (format!("{} faces, such as `{}`,", n + 1, name(first)), "which are"),
        };
        Some(format!("{what} of `{whole}`, {are} thinner than the gluing distance"))
    }
}

/// The name of one of several bodies of a thing.
pub fn numbered(name: &str, before: usize) -> String {
    if before == 0 || name.is_empty() { name.to_owned() } else { format!("{name}_{}", before + 1) }
}
