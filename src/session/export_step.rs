//! `export … to "x.step"`: what is written becomes faces with the edges they share.

use std::collections::BTreeMap;

use super::export::{Colors, Written, no_mesh_settings, put, unit_of};
use crate::base::fault::{FileFault, Say};
use crate::base::origin::Origin;
use crate::io::step::write::{self, Faces, Measured, Scale, Schema, Setup, Shown, Thing};
use crate::io::{Files, Loss};
use crate::lang::cx::{Cx, Stop};
use crate::lang::plans::ExportSpec;
use crate::lang::scene::{Scene, side_of};
use crate::lang::value::{Dim, ModuleId, ShellValue, Value};
use crate::model::{Shell, measure};
use crate::surface::Surface;

/// Points, curves, surfaces and shells as a STEP file.
pub(super) fn step(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Stop> {
    no_mesh_settings(spec)?;
    let (unit, scale) = unit_of(cx, spec);
    let tolerance = cx.tolerance()?;
    let schema = spec.schema.as_ref().and_then(|(word, _)| Schema::of(word)).unwrap_or_default();
    let setup = Setup { schema, unit, scale: Scale { model: scale.unwrap_or(1.0), tolerance } };
    let surfaces: Vec<&Surface> = spec.things.iter().flat_map(|(value, _)| surfaces_of(value)).collect();
    let scene = Scene::of(cx, ModuleId::MAIN, surfaces)?;
    let colors = Colors::of(cx);
    let mut things = Vec::with_capacity(spec.things.len());
    for (value, origin) in &spec.things {
        let (name, shown, measured) = match value {
            Value::Vector(p, Dim::LENGTH) | Value::Node(p) => (String::new(), Shown::Point(*p), Measured::default()),
            Value::Curve(chain) => (cx.name(chain.origin()), Shown::Curve(chain.clone()), Measured::default()),
            Value::Edge(home, edge) => {
                let chain = super::plan::chain_of(cx, home, edge)?;
                (super::plan::edge_name(cx, &chain, edge), Shown::Curve(chain), Measured::default())
            }
            Value::Surface(surface) => {
                let measured = Measured { area: Some(measure::area(surface)), volume: None };
                let name = cx.name_in_file(surface).unwrap_or_else(|| cx.surface_name(surface));
                (name, lone(cx, &scene, surface, (&setup, &colors))?, measured)
            }
            Value::Shell(shell) => {
                let (shown, measured) = whole(cx, &scene, shell, (&setup, &colors))?;
                (cx.body_said(shell).map_or(&shell.name, |[own, _]| own).to_string(), shown, measured)
            }
            other => {
                return Err(unsupported(*origin, format!("STEP holds points, curves, surfaces and shells, not {}", other.ty().words())));
            }
        };
        let color = if let Value::Curve(chain) = value { colors.of_curve(chain) } else { None };
        things.push(Thing { name, layers: layers(cx, value)?, shown, color, measured });
    }
    let file = spec.path.rsplit('/').next().unwrap_or(&spec.path);
    let name = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let sheet = write::sheet(&things, name, &setup).map_err(|what| unsupported(spec.path_origin, what))?;
    put(spec, files, &mut |out| {
        write::write(&sheet, file, &setup, out).map(|()| sheet.left_out.iter().cloned().map(Loss::LeftOut).collect())
    })
}

fn unsupported(of: Origin, what: String) -> Stop {
    FileFault::Unsupported { of, what, help: None, edits: Vec::new() }.into()
}

/// The surfaces that a value is or holds.
fn surfaces_of(value: &Value) -> Vec<&Surface> {
    match value {
        Value::Surface(surface) => vec![surface],
        Value::Shell(shell) => shell.surfaces.iter().collect(),
        _ => Vec::new(),
    }
}

/// A surface by itself: its patches share their edges with each other only.
fn lone(cx: &Cx, scene: &Scene, surface: &Surface, (setup, colors): (&Setup, &Colors)) -> Result<Shown, Stop> {
    let (id, other) = scene.find(surface).ok_or(Stop::Bug("a surface is not in its scene"))?;
    let near = scene.model.reach([id], None, &setup.scale.tolerance);
    let shell = Shell { name: String::new(), origin: surface.origin(), surfaces: vec![(id, other)], near, closed: false, free: Vec::new() };
    let colors = colors.of_surface(surface).map(|rgb| (id, rgb)).into_iter().collect();
    let names = cx.name_in_file(surface).map(|name| (id, name)).into_iter().collect();
    let (model, network) = (scene.model.clone(), scene.network.clone());
    Ok(Shown::Faces(Box::new(Faces { model, network, shell, solid: false, colors, names, layers: BTreeMap::new() })))
}

/// A shell: a solid where it closes.
fn whole(cx: &Cx, scene: &Scene, shell: &ShellValue, (setup, colors): (&Setup, &Colors)) -> Result<(Shown, Measured), Stop> {
    // What is to be said of it was said where it is declared.
    let built = scene.shell(shell, &setup.scale.tolerance, &mut Vec::new())?;
    let faces: Vec<(Surface, bool)> =
        built.surfaces.iter().map(|(id, other)| (scene.model.surfaces[id.index()].surface.clone(), *other)).collect();
    let area = faces.iter().map(|(surface, _)| measure::area(surface)).sum();
    let volume = built.closed.then(|| measure::solid(&faces).volume.abs());
    let solid = built.closed;
    let common = file_layers(cx, shell.surfaces.iter());
    let mut faces = Faces {
        model: scene.model.clone(),
        network: scene.network.clone(),
        shell: built,
        solid,
        colors: BTreeMap::new(),
        names: BTreeMap::new(),
        layers: BTreeMap::new(),
    };
    for surface in &shell.surfaces {
        let Some((id, _)) = scene.find(surface) else { continue };
        faces.colors.extend(colors.of_surface(surface).map(|rgb| (id, rgb)));
        let Some(said) = cx.said_of(surface) else { continue };
        faces.names.extend(said.own.as_ref().map(|own| (id, own.to_string())));
        let own: Vec<String> = said.layers.iter().map(|layer| layer.to_string()).filter(|layer| !common.contains(layer)).collect();
        if !own.is_empty() {
            faces.layers.insert(id, own);
        }
    }
    Ok((Shown::Faces(Box::new(faces)), Measured { area: Some(area), volume }))
}

/// The layers of an imported file that all of some surfaces lie on.
fn file_layers<'s>(cx: &Cx, surfaces: impl Iterator<Item = &'s Surface>) -> Vec<String> {
    let mut common: Option<Vec<String>> = None;
    for surface in surfaces {
        let own = cx.said_of(surface).map_or(&[][..], |said| &said.layers);
        common = Some(match common {
            None => own.iter().map(|layer| layer.to_string()).collect(),
            Some(all) => all.into_iter().filter(|layer| own.iter().any(|known| **known == **layer)).collect(),
        });
    }
    common.unwrap_or_default()
}

/// The groups of the script that a value belongs to, and the layers that it was on in the file that it comes from.
fn layers(cx: &mut Cx, value: &Value) -> Result<Vec<String>, Stop> {
    let same = |a: &Value, b: &Value| match (a, b) {
        (Value::Surface(a), Value::Surface(b)) => side_of(a, b).is_some(),
        (Value::Curve(a), Value::Curve(b)) => a.is(b),
        (Value::Shell(a), Value::Shell(b)) => a.origin == b.origin && a.name == b.name,
        (Value::Vector(a, x), Value::Vector(b, y)) => x == y && a == b,
        (Value::Node(a), Value::Node(b)) => a == b,
        _ => false,
    };
    let groups = cx.groups(ModuleId::MAIN)?;
    let holds = |members: &[Value]| members.iter().any(|member| same(member, value));
    let mut layers: Vec<String> = groups.iter().filter(|group| holds(&group.value)).map(|group| group.name.to_string()).collect();
    let of_file = file_layers(cx, surfaces_of(value).into_iter());
    layers.extend(of_file.into_iter().filter(|layer| !groups.iter().any(|group| *group.name == **layer)));
    Ok(layers)
}
