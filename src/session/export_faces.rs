//! Surfaces and shells of a script as the faces that files of solids hold, with their names, colours and layers.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::export::Colors;
use super::plan::surfaces_of;
use crate::base::tolerance::Tolerance;
use crate::io::cad::bodies::Faces;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::{Scene, side_of};
use crate::lang::values::value::{ModuleId, ShellValue, Value};
use crate::model::Shell;
use crate::surface::Surface;

/// A surface by itself: its patches share their edges with each other only.
pub(super) fn lone(cx: &Cx, scene: &Scene, surface: &Surface, tolerance: &Tolerance, colors: &Colors) -> Result<Faces, Halt> {
    let (id, other) = scene.find(surface).ok_or(Halt::Bug("a surface is not in its scene"))?;
    let near = scene.model.reach([id], None, tolerance);
    let shell = Shell { name: String::new(), origin: surface.origin(), surfaces: vec![(id, other)], near, closed: false, free: Vec::new() };
    let colors = colors.of_surface(surface).map(|rgb| (id, rgb)).into_iter().collect();
    let names = [(id, face_name(cx, surface))].into();
    let (model, network) = (scene.model.clone(), scene.network.clone());
    Ok(Faces { model, network, shell, solid: false, colors, names, layers: BTreeMap::new() })
}

/// A shell: a solid where it closes.
pub(super) fn whole(cx: &Cx, scene: &Scene, shell: &ShellValue, tolerance: &Tolerance, colors: &Colors) -> Result<Faces, Halt> {
    // What is to be said of it was said where it is declared.
    let built = scene.shell(shell, tolerance, &mut Vec::new())?;
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
        faces.names.insert(id, said.own.as_deref().unwrap_or_default().to_owned());
        let own: Vec<String> = said.layers.iter().map(|layer| layer.to_string()).filter(|layer| !common.contains(layer)).collect();
        if !own.is_empty() {
            faces.layers.insert(id, own);
        }
    }
    Ok(faces)
}

/// The name of a surface by itself: as declared; of a face of a file that there, which may be none.
pub(super) fn face_name(cx: &Cx, surface: &Surface) -> String {
    match cx.said_of(surface) {
        Some(said) => said.own.as_deref().unwrap_or_default().to_owned(),
        None => cx.surface_name(surface),
    }
}

/// Names of a shell: as declared; of a body of a file as it stands there, and that of which there is one only, which may be none.
pub(super) fn body_names(cx: &Cx, shell: &ShellValue) -> [Arc<str>; 2] {
    match cx.body_said(shell) {
        Some(names) => names.clone(),
        None if cx.is_body(shell) => ["", ""].map(Arc::from),
        None => [&shell.name, &shell.name].map(Arc::clone),
    }
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
pub(super) fn layers(cx: &mut Cx, value: &Value) -> Result<Vec<String>, Halt> {
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
