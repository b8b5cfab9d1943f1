//! Bodies as STEP entities: vertices, edges, loops, faces, shells and solids.
//!
//! ```text
//!   solid ─ closed shell ─┐
//!                         ├─ face ─ bound ─ loop ─ oriented edge ─ edge ─ 2 vertices
//!   surface model ─ shell ┘   └─ surface                          └─ curve
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::curves::{self, Scale};
use super::looks::Painted;
use super::poles::Placed;
use super::surfaces::{self, Ground};
use super::text::{Id, Records};
use crate::base::job;
use crate::base::par;
use crate::geometry::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::io::cad::compose::fitted;
use crate::io::cad::damage::{Damage, damage};
use crate::model::{Body, BodyEdge, BodyFace, Model, Shell, Skin, SurfaceId, measure};
use crate::network::Network;
use crate::surface::Off;

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

/// What became of faces.
#[derive(Debug, Default)]
pub struct Made {
    /// Solids.
    pub solids: Vec<Id>,
    /// Surface models.
    pub sheets: Vec<Id>,
    /// How far surfaces are from the model's at most, model units; whether all that is known of one are samples.
    pub off: (f64, bool),
    /// Surfaces that are too thin to have a face.
    pub thin: Vec<SurfaceId>,
    /// Area of those of which no face is left, model units.
    pub thin_area: f64,
    /// Faces and solids with their colours.
    pub painted: Vec<Painted>,
    /// Faces with their layers.
    pub layered: Vec<(Id, Vec<String>)>,
}

impl Faces {
    /// Writes the faces under a name.
    pub fn put(&self, records: &mut Records, name: &str, scale: &Scale) -> Result<Made, Damage> {
        let body = self.model.body(&self.shell, &self.network, &scale.tolerance)?;
        if body.faces.is_empty() {
            return Err(damage("it is thinner than the distance within which edges are one, so it has no face"));
        }
        let mut writer = Writer { faces: self, body: &body, scale, edges: Vec::new(), made: Made::default() };
        let faces = writer.faces(records)?;
        let is_solid = |skin: &Skin| self.solid && skin.closed;
        let named = |count: usize| if count == 0 { name.to_owned() } else { format!("{name}_{}", count + 1) };
        for (k, skin) in body.skins.iter().enumerate().filter(|(_, s)| is_solid(s) && s.within.is_none()) {
            let outer = shell(records, skin, &faces);
            let voids: Vec<Id> = body
                .skins
                .iter()
                .filter(|s| s.within == Some(k))
                .map(|s| {
                    let inner = shell(records, s, &faces);
                    records.put("ORIENTED_CLOSED_SHELL", |v| {
                        v.text("").word("*").id(inner).flag(true);
                    })
                })
                .collect();
            let own = named(writer.made.solids.len());
            let solid = if voids.is_empty() {
                records.put("MANIFOLD_SOLID_BREP", |v| {
                    v.text(&own).id(outer);
                })
            } else {
                records.put("BREP_WITH_VOIDS", |v| {
                    v.text(&own).id(outer).ids(&voids);
                })
            };
            let skins = body.skins.iter().enumerate().filter(|(n, s)| *n == k || s.within == Some(k));
            writer.paint(solid, &skins.flat_map(|(_, s)| s.faces.iter().map(|face| faces[*face])).collect());
            writer.made.solids.push(solid);
        }
        let sheets: Vec<Id> = body.skins.iter().filter(|s| !is_solid(s)).map(|skin| shell(records, skin, &faces)).collect();
        if !sheets.is_empty() {
            writer.made.sheets.push(records.put("SHELL_BASED_SURFACE_MODEL", |v| {
                v.text(name).ids(&sheets);
            }));
        }
        writer.made.thin = body.slivers.iter().map(|patch| self.model.patches[patch.index()].surface).collect();
        writer.made.thin.dedup();
        let is_gone = |id: &&SurfaceId| body.faces.iter().all(|face| face.surface != **id);
        let area = |id: &SurfaceId| measure::area(&self.model.surfaces[id.index()].surface);
        writer.made.thin_area = writer.made.thin.iter().filter(is_gone).map(area).sum();
        Ok(writer.made)
    }
}

/// The shell of a skin.
fn shell(records: &mut Records, skin: &Skin, faces: &[Id]) -> Id {
    let own: Vec<Id> = skin.faces.iter().map(|k| faces[*k]).collect();
    records.put(if skin.closed { "CLOSED_SHELL" } else { "OPEN_SHELL" }, |v| {
        v.text("").ids(&own);
    })
}

struct Writer<'f> {
    faces: &'f Faces,
    body: &'f Body,
    scale: &'f Scale,
    /// The record of each edge.
    edges: Vec<Option<Id>>,
    made: Made,
}

impl Writer<'_> {
    /// All faces, in the order of the body.
    fn faces(&mut self, records: &mut Records) -> Result<Vec<Id>, Damage> {
        let body = self.body;
        let grounds = par::try_map(body.faces.len(), |k| self.ground(&body.faces[k]))?;
        self.edges = self.all_edges(records, &Placed::new(body, &grounds, self.scale))?;
        let mut made = Vec::with_capacity(body.faces.len());
        for (face, ground) in body.faces.iter().zip(&grounds) {
            job::look();
            if let Ground::Net(_, off, _) = ground {
                self.made.off = (self.made.off.0.max(off.distance()), self.made.off.1 || matches!(off, Off::Sampled(_)));
            }
            let item = self.face(records, face, ground)?;
            let rgb = self.faces.colors.get(&face.surface).copied();
            self.made.painted.extend(rgb.map(|rgb| Painted { item, rgb, curve: false, over: None }));
            self.made.layered.extend(self.faces.layers.get(&face.surface).map(|layers| (item, layers.clone())));
            made.push(item);
        }
        Ok(made)
    }

    /// Gives a solid of which all faces have a colour that of most of them; the others override it.
    fn paint(&mut self, solid: Id, faces: &BTreeSet<Id>) {
        let (own, others): (Vec<Painted>, Vec<Painted>) = self.made.painted.drain(..).partition(|painted| faces.contains(&painted.item));
        self.made.painted = others;
        let mut counts: Vec<([f64; 3], usize)> = Vec::new();
        for painted in &own {
            match counts.iter_mut().find(|known| known.0 == painted.rgb) {
                Some(known) => known.1 += 1,
                None => counts.push((painted.rgb, 1)),
            }
        }
        let most = counts.iter().rev().max_by_key(|known| known.1).filter(|_| own.len() == faces.len());
        let Some((rgb, _)) = most.copied() else { return self.made.painted.extend(own) };
        self.made.painted.push(Painted { item: solid, rgb, curve: false, over: None });
        let over = own.into_iter().filter(|painted| painted.rgb != rgb);
        self.made.painted.extend(over.map(|painted| Painted { over: Some(solid), ..painted }));
    }

    fn ground(&self, face: &BodyFace) -> Result<Ground, Damage> {
        let model = &self.faces.model;
        let surface = &model.surfaces[face.surface.index()].surface;
        let found = surfaces::ground(surface, &model.patches[face.patch.index()], self.scale)?;
        found.ok_or_else(|| damage("STEP has no place for a plane without a border"))
    }

    /// The edges that some face uses, with their vertices.
    fn all_edges(&self, records: &mut Records, placed: &Placed) -> Result<Vec<Option<Id>>, Damage> {
        let body = self.body;
        let mut used = vec![false; body.edges.len()];
        body.faces.iter().flat_map(|face| &face.loops).flatten().for_each(|(edge, _)| used[*edge] = true);
        let curve = |k: usize| placed.curve(k, body.edges[k].ends, self.curve(&body.edges[k])?, self.scale);
        let curves = par::try_map(body.edges.len(), |k| if used[k] { curve(k).map(Some) } else { Ok(None) })?;
        let mut vertices: Vec<Option<Id>> = vec![None; body.vertices.len()];
        let mut edges = Vec::with_capacity(body.edges.len());
        for (edge, curve) in body.edges.iter().zip(curves) {
            let Some(curve) = curve else {
                edges.push(None);
                continue;
            };
            let mut vertex = |k: usize| {
                *vertices[k].get_or_insert_with(|| {
                    let at = records.point(placed.vertices[k] / self.scale.model);
                    records.put("VERTEX_POINT", |v| {
                        v.text("").id(at);
                    })
                })
            };
            let (from, to) = (vertex(edge.ends.0), vertex(edge.ends.1));
            let geometry = curves::along(records, &curve, self.scale)?;
            edges.push(Some(records.put("EDGE_CURVE", |v| {
                v.text("").id(from).id(to).id(geometry).flag(true);
            })));
        }
        Ok(edges)
    }

    /// The curve of an edge: the model's where it has one, else a spline within the tolerance of the line on the surface.
    fn curve(&self, edge: &BodyEdge) -> Result<Curve, Damage> {
        let Faces { model, network, .. } = self.faces;
        let ends = (self.body.vertices[edge.ends.0], self.body.vertices[edge.ends.1]);
        if let Some(patch) = edge.seam
            && let Some(curve) = model.seam_curve(patch, ends, &self.scale.tolerance)?
        {
            return Ok(curve);
        }
        if let Some(curve) = model.part_curve(&edge.part, network, &self.scale.tolerance)? {
            return Ok(curve);
        }
        let track = model.track(edge.part.edge, network);
        let found = fitted(&[edge.part.s.0, edge.part.s.1], &self.scale.tolerance, &|s| Ok(track.point(s)), &|p| p)?;
        let origin = model.surfaces.first().map_or(crate::base::origin::Origin::NONE, |s| s.surface.origin());
        Ok(Curve::new(Shape::Nurbs(Arc::new(found)), Kind::Spline, origin))
    }

    fn face(&self, records: &mut Records, face: &BodyFace, ground: &Ground) -> Result<Id, Damage> {
        let (surface, along) = surfaces::put(records, ground, self.scale);
        let mut bounds = Vec::with_capacity(face.loops.len());
        if face.loops.is_empty() || face.loops.iter().any(|around| !self.body.is_closed(around)) {
            return Err(damage("the edges round one of its faces do not close"));
        }
        for (k, around) in face.loops.iter().enumerate() {
            let mut edges = Vec::with_capacity(around.len());
            for (edge, against) in around {
                let edge = self.edges[*edge].ok_or_else(|| damage("an edge of one of its faces has no curve"))?;
                edges.push(records.put("ORIENTED_EDGE", |v| {
                    v.text("").word("*").word("*").id(edge).flag(!against);
                }));
            }
            let around = records.put("EDGE_LOOP", |v| {
                v.text("").ids(&edges);
            });
            bounds.push(records.put(if k == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" }, |v| {
                v.text("").id(around).flag(true);
            }));
        }
        let name = self.faces.names.get(&face.surface).unwrap_or(&self.faces.model.surfaces[face.surface.index()].name);
        Ok(records.put("ADVANCED_FACE", |v| {
            v.text(name).ids(&bounds).id(surface).flag(along != face.other);
        }))
    }
}
