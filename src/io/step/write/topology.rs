//! Bodies as STEP entities: vertices, edges, loops, faces, shells and solids.
//!
//! ```text
//!   solid ─ closed shell ─┐
//!                         ├─ face ─ bound ─ loop ─ oriented edge ─ edge ─ 2 vertices
//!   surface model ─ shell ┘   └─ surface                          └─ curve
//! ```

use std::collections::BTreeSet;

use crate::base::job;
use crate::io::cad::bodies::{Bodies, Faces, numbered};
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::elementary_surface::Ground;
use crate::io::step::write::curves::Along;
use crate::io::step::write::records::{Id, SectionRecords};
use crate::io::step::write::styles::Painted;
use crate::io::step::write::things::StepScale;
use crate::io::step::write::{pcurves, surfaces};

/// What became of faces.
#[derive(Debug, Default)]
pub struct WrittenFaces {
    /// Solids.
    pub solids: Vec<Id>,
    /// Surface models.
    pub sheets: Vec<Id>,
    /// How far surfaces are from the model's at most, model units; whether all that is known of one are samples.
    pub off: (f64, bool),
    /// Surfaces that are too thin to have a face, in words.
    pub left_out: Option<String>,
    /// Area of those of which no face is left, model units.
    pub thin_area: f64,
    /// Faces and solids with their colours.
    pub painted: Vec<Painted>,
    /// Faces with their layers.
    pub layered: Vec<(Id, Vec<String>)>,
}

/// Writes faces under a name.
pub fn put(faces: &Faces, records: &mut SectionRecords, name: &str, scale: &StepScale) -> Result<WrittenFaces, Defect> {
    let bodies = faces.bodies(&scale.tolerance)?;
    let written = WrittenFaces { off: bodies.off, left_out: bodies.left_out(name), thin_area: bodies.thin_area, ..WrittenFaces::default() };
    let mut writer = Writer { bodies: &bodies, scale, surfaces: Vec::new(), edges: Vec::new(), written };
    let faces = writer.faces(records)?;
    for solid in bodies.solids() {
        let outer = shell(records, &bodies, solid.outer, &faces);
        let void = |k: &usize| {
            let inner = shell(records, &bodies, *k, &faces);
            records.put("ORIENTED_CLOSED_SHELL", |v| {
                v.text("").word("*").id(inner).flag(true);
            })
        };
        let voids: Vec<Id> = solid.voids.iter().map(void).collect();
        let own = numbered(name, writer.written.solids.len());
        let made = if voids.is_empty() {
            records.put("MANIFOLD_SOLID_BREP", |v| {
                v.text(&own).id(outer);
            })
        } else {
            records.put("BREP_WITH_VOIDS", |v| {
                v.text(&own).id(outer).ids(&voids);
            })
        };
        let skins = std::iter::once(&solid.outer).chain(&solid.voids).map(|k| &bodies.body.skins[*k]);
        writer.paint(made, &skins.flat_map(|skin| skin.faces.iter().map(|face| faces[*face])).collect());
        writer.written.solids.push(made);
    }
    let sheets: Vec<Id> = bodies.sheets().into_iter().map(|skin| shell(records, &bodies, skin, &faces)).collect();
    if !sheets.is_empty() {
        writer.written.sheets.push(records.put("SHELL_BASED_SURFACE_MODEL", |v| {
            v.text(name).ids(&sheets);
        }));
    }
    Ok(writer.written)
}

/// The shell of a skin.
fn shell(records: &mut SectionRecords, bodies: &Bodies, skin: usize, faces: &[Id]) -> Id {
    let skin = &bodies.body.skins[skin];
    let own: Vec<Id> = skin.faces.iter().map(|k| faces[*k]).collect();
    records.put(if skin.closed { "CLOSED_SHELL" } else { "OPEN_SHELL" }, |v| {
        v.text("").ids(&own);
    })
}

struct Writer<'b> {
    bodies: &'b Bodies<'b>,
    scale: &'b StepScale,
    /// The surface of each face.
    surfaces: Vec<Id>,
    /// The record of each edge.
    edges: Vec<Option<Id>>,
    written: WrittenFaces,
}

impl Writer<'_> {
    /// All faces, in the order of the body.
    fn faces(&mut self, records: &mut SectionRecords) -> Result<Vec<Id>, Defect> {
        self.surfaces = (0..self.bodies.grounds.len())
            .map(|k| match &self.bodies.arcs[k] {
                Some(arc) => surfaces::moved(records, arc, self.scale),
                None => surfaces::put(records, &self.bodies.grounds[k], self.scale),
            })
            .collect();
        self.edges = self.all_edges(records)?;
        let mut made = Vec::with_capacity(self.bodies.grounds.len());
        for k in 0..self.bodies.grounds.len() {
            job::poll();
            let item = self.face(records, k)?;
            self.written.painted.extend(self.bodies.color(k).map(|rgb| Painted { item, rgb, curve: false, over: None, at: None }));
            let layers = self.bodies.layers(k);
            if !layers.is_empty() {
                self.written.layered.push((item, layers.to_vec()));
            }
            made.push(item);
        }
        Ok(made)
    }

    /// Gives a solid of which all faces have a colour that of most of them; the others override it.
    fn paint(&mut self, solid: Id, faces: &BTreeSet<Id>) {
        let (own, others): (Vec<Painted>, Vec<Painted>) = self.written.painted.drain(..).partition(|painted| faces.contains(&painted.item));
        self.written.painted = others;
        let mut counts: Vec<([f64; 3], usize)> = Vec::new();
        for painted in &own {
            match counts.iter_mut().find(|known| known.0 == painted.rgb) {
                Some(known) => known.1 += 1,
                None => counts.push((painted.rgb, 1)),
            }
        }
        let most = counts.iter().rev().max_by_key(|known| known.1).filter(|_| own.len() == faces.len());
        let Some((rgb, _)) = most.copied() else { return self.written.painted.extend(own) };
        self.written.painted.push(Painted { item: solid, rgb, curve: false, over: None, at: None });
        let over = own.into_iter().filter(|painted| painted.rgb != rgb);
        self.written.painted.extend(over.map(|painted| Painted { over: Some(solid), ..painted }));
    }

    /// The edges that some face uses, with their vertices.
    fn all_edges(&self, records: &mut SectionRecords) -> Result<Vec<Option<Id>>, Defect> {
        let mut vertices: Vec<Option<Id>> = vec![None; self.bodies.vertices.len()];
        let mut edges = Vec::with_capacity(self.bodies.curves.len());
        let mut faces_of: Vec<Vec<usize>> = vec![Vec::new(); self.bodies.curves.len()];
        for (face, found) in self.bodies.body.faces.iter().enumerate() {
            found.loops.iter().flatten().for_each(|(edge, _)| faces_of[*edge].push(face));
        }
        for (k, (edge, curve)) in self.bodies.body.edges.iter().zip(&self.bodies.curves).enumerate() {
            let Some(curve) = curve else {
                edges.push(None);
                continue;
            };
            let mut vertex = |k: usize| {
                *vertices[k].get_or_insert_with(|| {
                    let at = records.point(self.bodies.vertices[k] / self.scale.model);
                    records.put("VERTEX_POINT", |v| {
                        v.text("").id(at);
                    })
                })
            };
            let (from, to) = (vertex(edge.ends.0), vertex(edge.ends.1));
            let along = Along::of(curve, self.scale)?;
            let own = along.put(records, self.scale);
            let geometry = self.on_surfaces(records, &faces_of[k], own, &along);
            edges.push(Some(records.put("EDGE_CURVE", |v| {
                v.text("").id(from).id(to).id(geometry).flag(true);
            })));
        }
        Ok(edges)
    }

    /// The curve of an edge with what it is in the parameters of its faces' surfaces, where readers need it.
    fn on_surfaces(&self, records: &mut SectionRecords, faces: &[usize], own: Id, along: &Along) -> Id {
        let once = |face: &&usize| faces.iter().filter(|other| other == face).count() == 1;
        let mut within = Vec::new();
        for face in faces.iter().filter(once) {
            if let Ground::Elementary(found) = &self.bodies.grounds[*face] {
                within.extend(pcurves::put(records, self.surfaces[*face], found, along, self.scale));
            }
        }
        if within.is_empty() {
            return own;
        }
        records.put("SURFACE_CURVE", |v| {
            v.text("").id(own).ids(&within).word(".CURVE_3D.");
        })
    }

    fn face(&self, records: &mut SectionRecords, k: usize) -> Result<Id, Defect> {
        let surface = self.surfaces[k];
        let loops = self.bodies.loops(k);
        let mut bounds = Vec::with_capacity(loops.len());
        for (n, around) in loops.iter().enumerate() {
            let mut edges = Vec::with_capacity(around.len());
            for (edge, against) in around {
                let edge = self.edges[*edge].ok_or_else(|| defect("an edge of one of its faces has no curve"))?;
                edges.push(records.put("ORIENTED_EDGE", |v| {
                    v.text("").word("*").word("*").id(edge).flag(!against);
                }));
            }
            let around = records.put("EDGE_LOOP", |v| {
                v.text("").ids(&edges);
            });
            bounds.push(records.put(if n == 0 { "FACE_OUTER_BOUND" } else { "FACE_BOUND" }, |v| {
                v.text("").id(around).flag(true);
            }));
        }
        Ok(records.put("ADVANCED_FACE", |v| {
            v.text(self.bodies.name(k)).ids(&bounds).id(surface).flag(self.bodies.is_along(k));
        }))
    }
}
