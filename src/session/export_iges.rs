//! `export … to "x.igs"`: shells become solids, or trimmed surfaces in a group.

use super::export::{Colors, Written, no_mesh_settings, put, unit_of};
use super::export_faces::{body_names, face_name, layers, lone, whole};
use super::plan::surfaces_of;
use crate::base::fault::Say;
use crate::base::origin::Origin;
use crate::io::Files;
use crate::io::files::fault::FormatFault;
use crate::io::iges::write::{self, IgesScale, IgesShape, IgesThing};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::Scene;
use crate::lang::values::plans::ExportSpec;
use crate::lang::values::value::{Dim, ModuleId, Value};
use crate::surface::Surface;

/// Points, curves, surfaces and shells as an IGES file.
pub(super) fn iges(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Halt> {
    no_mesh_settings(spec)?;
    let (unit, scale) = unit_of(cx, spec);
    let tolerance = cx.tolerance()?;
    let as_faces = spec.shells.as_ref().is_some_and(|(word, _)| **word == *"faces");
    // What has faces that share edges; a surface by itself where other programs know its forms by name.
    let has_faces = |value: &Value| match value {
        Value::Shell(_) => !as_faces,
        Value::Surface(surface) => !as_faces && surface.has_forms(&tolerance),
        _ => false,
    };
    let solid: Vec<&Surface> = spec.things.iter().map(|(value, _)| value).filter(|value| has_faces(value)).flat_map(surfaces_of).collect();
    let scene = if solid.is_empty() { None } else { Some(Scene::of(cx, ModuleId::MAIN, solid)?) };
    let colors = Colors::of(cx);
    let one = |cx: &Cx, of: Origin, shown: IgesShape| {
        let color = match &shown {
            IgesShape::Curve(chain) => colors.of_curve(chain),
            IgesShape::Surface(surface) => colors.of_surface(surface),
            IgesShape::Point(_) | IgesShape::Faces(_) | IgesShape::Face(..) => None,
        };
        IgesThing { name: cx.name(of), group: String::new(), layers: Vec::new(), color, shown }
    };
    let face = |cx: &Cx, surface: &Surface| {
        let thing = one(cx, surface.origin(), IgesShape::Surface(surface.clone()));
        IgesThing { name: face_name(cx, surface), ..thing }
    };
    let mut things = Vec::with_capacity(spec.things.len());
    for (value, origin) in &spec.things {
        let layers = layers(cx, value)?;
        let first = things.len();
        match value {
            Value::Vector(p, Dim::LENGTH) | Value::Node(p) => {
                things.push(IgesThing { name: String::new(), ..one(cx, *origin, IgesShape::Point(*p)) })
            }
            Value::Curve(chain) => things.push(one(cx, chain.origin(), IgesShape::Curve(chain.clone()))),
            Value::Edge(home, edge) => {
                let chain = super::plan::chain_of(cx, home, edge)?;
                let name = super::plan::edge_name(cx, &chain, edge);
                things.push(IgesThing { name, ..one(cx, *origin, IgesShape::Curve(chain)) });
            }
            Value::Surface(surface) => things.push(match &scene {
                Some(scene) if has_faces(value) => {
                    let faces = lone(cx, scene, surface, &tolerance, &colors)?;
                    IgesThing { shown: IgesShape::Face(Box::new(faces), surface.clone()), color: None, ..face(cx, surface) }
                }
                _ => face(cx, surface),
            }),
            Value::Shell(shell) => match &scene {
                Some(scene) if !as_faces => {
                    let name = body_names(cx, shell)[1].to_string();
                    let faces = whole(cx, scene, shell, &tolerance, &colors)?;
                    things.push(IgesThing { name, ..one(cx, *origin, IgesShape::Faces(Box::new(faces))) });
                }
                _ => {
                    let [_, group] = body_names(cx, shell);
                    things.extend(shell.surfaces.iter().map(|s| IgesThing { group: group.to_string(), ..face(cx, s) }));
                }
            },
            other => {
                let what = format!("IGES holds points, curves, surfaces and shells, not {}", other.ty().words());
                return Err(FormatFault::Unsupported { of: *origin, what, help: None, edits: Vec::new() }.into());
            }
        }
        things[first..].iter_mut().for_each(|thing| thing.layers = layers.clone());
    }
    let scale = IgesScale { unit, model: scale.unwrap_or(1.0), tolerance };
    let sheet = write::sheet(&things, &scale).map_err(|what| {
        let help = help(spec, as_faces);
        FormatFault::Unsupported { of: spec.path_origin, what, help, edits: Vec::new() }
    })?;
    let name = spec.path.rsplit('/').next().unwrap_or(&spec.path);
    put(spec, files, &mut |out| write::write(&sheet, name, &scale, out))
}

/// What may help where a thing has no place in the file.
fn help(spec: &ExportSpec, as_faces: bool) -> Option<String> {
    let values = || spec.things.iter().map(|(value, _)| value);
    // Through scattered points there is one cubic a triangle, and no net of few strips where slopes differ much.
    if values().flat_map(surfaces_of).any(Surface::is_scattered) {
        let what = "export a mesh of it, made with a `chord_error:`, to a format of meshes: splines hold smooth points only";
        return Some(what.to_owned());
    }
    let has_shell = !as_faces && values().any(|value| matches!(value, Value::Shell(_)));
    has_shell.then(|| "`shells: faces` writes the surfaces of shells each by itself, without common edges".to_owned())
}
