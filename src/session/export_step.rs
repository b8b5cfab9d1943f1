//! `export … to "x.step"`: what is written becomes faces with the edges they share.

use std::sync::Arc;

use super::export::{Colors, Written, no_mesh_settings, put, unit_of};
use super::export_faces::{layers, lone, whole};
use super::plan::surfaces_of;
use crate::base::fault::Say;
use crate::base::origin::Origin;
use crate::io::cad::assembly::Node;
use crate::io::cad::bodies::Faces;
use crate::io::files::fault::FormatFault;
use crate::io::step::write::{self, Measured, Schema, Setup, StepScale, StepShape, StepThing};
use crate::io::{Files, Loss};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::values::part::PartFile;
use crate::lang::values::plans::ExportSpec;
use crate::lang::values::value::{Dim, ModuleId, Value};
use crate::model::{SurfaceId, measure};
use crate::surface::Surface;

/// Points, curves, surfaces and shells as a STEP file.
pub(super) fn step(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Halt> {
    no_mesh_settings(spec)?;
    let (unit, scale) = unit_of(cx, spec);
    let tolerance = cx.tolerance()?;
    let schema = spec.schema.as_ref().and_then(|(word, _)| Schema::of(word)).unwrap_or_default();
    let setup = Setup { schema, unit, scale: StepScale { model: scale.unwrap_or(1.0), tolerance } };
    let surfaces: Vec<&Surface> = spec.things.iter().flat_map(|(value, _)| surfaces_of(value)).collect();
    let scene = Scene::of(cx, ModuleId::MAIN, surfaces)?;
    let colors = Colors::of(cx);
    let mut tree = Tree::default();
    let mut things = Vec::with_capacity(spec.things.len());
    for (value, origin) in &spec.things {
        let (name, shown, measured) = match value {
            Value::Vector(p, Dim::LENGTH) | Value::Node(p) => (String::new(), StepShape::Point(*p), Measured::default()),
            Value::Curve(chain) => (cx.name(chain.origin()), StepShape::Curve(chain.clone()), Measured::default()),
            Value::Edge(home, edge) => {
                let chain = super::plan::chain_of(cx, home, edge)?;
                (super::plan::edge_name(cx, &chain, edge), StepShape::Curve(chain), Measured::default())
            }
            Value::Surface(surface) => {
                let measured = Measured { area: Some(measure::area(surface)), volume: None };
                let name = super::export_faces::face_name(cx, surface);
                (name, StepShape::Faces(Box::new(lone(cx, &scene, surface, &tolerance, &colors)?)), measured)
            }
            Value::Shell(shell) => {
                let faces = whole(cx, &scene, shell, &tolerance, &colors)?;
                let measured = measured(&faces);
                (super::export_faces::body_names(cx, shell)[0].to_string(), StepShape::Faces(Box::new(faces)), measured)
            }
            other => {
                return Err(unsupported(*origin, format!("STEP holds points, curves, surfaces and shells, not {}", other.ty().words())));
            }
        };
        let color = if let Value::Curve(chain) = value { colors.of_curve(chain) } else { None };
        let node = tree.node(cx, value);
        things.push(StepThing { name, layers: layers(cx, value)?, shown, color, measured, node });
    }
    let file = spec.path.rsplit('/').next().unwrap_or(&spec.path);
    let name = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let sheet = write::sheet(&things, &tree.nodes, name, &setup).map_err(|what| unsupported(spec.path_origin, what))?;
    put(spec, files, &mut |out| {
        write::write(&sheet, file, &setup, out).map(|()| sheet.left_out.iter().cloned().map(Loss::LeftOut).collect())
    })
}

fn unsupported(of: Origin, what: String) -> Halt {
    FormatFault::Unsupported { of, what, help: None, edits: Vec::new() }.into()
}

/// Area of a shell, and its volume where it closes.
fn measured(of: &Faces) -> Measured {
    let surface = |(id, other): &(SurfaceId, bool)| (of.model.surfaces[id.index()].surface.clone(), *other);
    let faces: Vec<(Surface, bool)> = of.shell.surfaces.iter().map(surface).collect();
    let area = faces.iter().map(|(surface, _)| measure::area(surface)).sum();
    let volume = of.solid.then(|| measure::solid(&faces).volume.abs());
    Measured { area: Some(area), volume }
}

/// The products of all imported assemblies that something is of.
#[derive(Default)]
struct Tree {
    nodes: Vec<Node>,
    /// Files with the place of their first node.
    files: Vec<(Arc<PartFile>, usize)>,
}

impl Tree {
    /// The node of the product that all surfaces of a value are of.
    fn node(&mut self, cx: &Cx, value: &Value) -> Option<usize> {
        let mut found = surfaces_of(value).into_iter().map(|surface| cx.node_of(surface));
        let (file, node) = found.next()??;
        if !found.all(|other| other.is_some_and(|(own, place)| Arc::ptr_eq(own, file) && place == node)) {
            return None;
        }
        // What a script makes of a file without an assembly is a product of its own.
        if let Value::Shell(shell) = value
            && !cx.is_body(shell)
            && file.tree.iter().all(|node| node.parent.is_none())
        {
            return None;
        }
        let known = self.files.iter().find(|(known, _)| Arc::ptr_eq(known, file)).map(|(_, first)| *first);
        let first = known.unwrap_or_else(|| {
            let first = self.nodes.len();
            let placed =
                |node: &Node| Node { of: node.of + first, file: first, parent: node.parent.map(|parent| parent + first), ..node.clone() };
            self.nodes.extend(file.tree.iter().map(placed));
            self.files.push((file.clone(), first));
            first
        });
        Some(first + node)
    }
}
