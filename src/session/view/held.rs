//! What of a thing other things draw: the surfaces and patches of a group, and those of a shell that have names of their own.

use crate::base::fault::Say;
use crate::lang::eval::context::Cx;
use crate::lang::values::value::Value;

/// Names of the surfaces and patches that a value is or holds, as they stand in the headers of buffers.
pub(super) fn surfaces(cx: &mut Cx, value: &Value) -> Vec<String> {
    match value {
        Value::Surface(surface) => vec![cx.surface_name(surface)],
        Value::Shell(shell) => shell.surfaces.iter().map(|surface| cx.surface_name(surface)).collect(),
        Value::List(members) => members.iter().flat_map(|member| surfaces(cx, member)).collect(),
        Value::Patch(home, patch) => {
            let Ok(model) = cx.model(home) else { return Vec::new() };
            let own = model.patches[patch.index()].surface;
            let name = cx.surface_name(&model.surfaces[own.index()].surface);
            let all: Vec<_> = model.patches_of(own).collect();
            match all.iter().position(|one| one == patch) {
                Some(rank) if all.len() > 1 => vec![patch_name(&name, rank)],
                _ => vec![name],
            }
        }
        other => other.part().map_or_else(Vec::new, |part| part.faces.iter().map(|surface| cx.surface_name(surface)).collect()),
    }
}

/// The name of a member of a group as a thing; empty where it is none.
pub(super) fn name(cx: &Cx, value: &Value) -> String {
    match value {
        Value::Surface(surface) => cx.surface_name(surface),
        Value::Curve(chain) => cx.name(chain.origin()),
        Value::Shell(shell) => shell.name.to_string(),
        _ => String::new(),
    }
}

/// The name of one of several patches of a surface.
pub(super) fn patch_name(surface: &str, place: usize) -> String {
    format!("{surface}.patches[{place}]")
}
