//! What a command line asks a picture of: some names of the script, or everything it declares.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::consumed;
use super::picture_paths::{ASKED, is_name};
use super::run::Wanted;
use crate::base::origin::Origin;
use crate::geometry::Curve;
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;
use crate::lang::values::plans::{PictureSpec, Show};
use crate::lang::values::value::{ModuleId, Value};
use crate::network::Chain;
use crate::network::chain::same_curve;
use crate::surface::{Domain, Surface};

/// What a command line asks for: some names of the script, or everything it declares.
///
/// Everything is its meshes, of each surface the last one, the surfaces that none of them covers but those that a part was cut from, and
/// its curves; without faces the network.
pub fn request(cx: &mut Cx, wanted: &Wanted) -> Result<PictureSpec, Box<Diagnostic>> {
    let mut spec = wanted.spec.clone();
    let mut asked = 0;
    spec.things = values_of(cx, &wanted.names, &mut asked)?;
    spec.zoom = values_of(cx, &wanted.zoom, &mut asked)?;
    spec.named = wanted.names.join(", ");
    if wanted.names.is_empty() {
        everything(cx, &mut spec);
    }
    Ok(spec)
}

/// Things by their names and paths in the script, `asked` paths of which were met before; E201 for one that is not declared, E805 for one that cannot be drawn.
fn values_of(cx: &mut Cx, names: &[String], asked: &mut usize) -> Result<Vec<(Value, Origin)>, Box<Diagnostic>> {
    let mut out = Vec::new();
    for name in names {
        if name == "network" {
            out.push((Value::Network(ModuleId::MAIN), Origin::NONE));
            continue;
        }
        let hidden = (!is_name(name)).then(|| {
            *asked += 1;
            format!("{ASKED}{}", *asked - 1)
        });
        let Some(value) = cx.value_of(hidden.as_ref().unwrap_or(name)) else {
            let failed = hidden.is_some() || cx.program.names.find(name).is_some();
            let text = if failed { format!("`{name}` has no value to draw") } else { format!("`{name}` is not defined") };
            return Err(Diagnostic::without_place("E201", text).help("a name that the script declares, or `network`").into());
        };
        let before = out.len();
        let _ = value.for_each_flat::<()>(&mut |v| {
            if is_drawn(v) {
                out.push((v.clone(), Origin::NONE));
            }
            Ok(())
        });
        if out.len() == before {
            return Err(Diagnostic::without_place("E805", format!("`{name}` is {}, which cannot be drawn", value.ty().words())).into());
        }
    }
    Ok(out)
}

fn is_drawn(value: &Value) -> bool {
    use Value as V;
    let faces = matches!(value, V::Surface(_) | V::Shell(_) | V::Mesh(_) | V::Patch(..));
    let flat = matches!(value, V::Drawing(_));
    faces || flat || matches!(value, V::Curve(_) | V::Link(..) | V::Edge(..) | V::Vertex(..) | V::Vector(..) | V::Node(_))
}

fn everything(cx: &mut Cx, spec: &mut PictureSpec) {
    let mut covered: BTreeSet<String> = BTreeSet::new();
    for (_, value) in cx.mesh_values() {
        // A mesh that cannot be made was reported; its surfaces are drawn.
        let Ok(mesh) = cx.mesh(&value) else { continue };
        covered.extend(mesh.faces.iter().map(|face| face.name.clone()));
        spec.things.push((Value::Mesh(Arc::new(value)), Origin::NONE));
    }
    let Ok(sound) = cx.sound(ModuleId::MAIN) else { return };
    let consumed = consumed::surfaces(cx, &sound);
    let is_drawn = |s: &Surface, name: &str| s.domain() != Domain::Unbounded && !covered.contains(name) && !consumed.contains(name);
    let surfaces = sound.parts.surfaces.iter().filter(|s| is_drawn(&s.value, &s.name));
    spec.things.extend(surfaces.map(|s| (Value::Surface(s.value.clone()), Origin::NONE)));
    let faces = !spec.things.is_empty();
    if faces {
        // The borders of faces show the curves that carry them.
        let carried: Vec<&Curve> =
            sound.parts.surfaces.iter().flat_map(|s| s.value.chains()).flat_map(Chain::runs).map(|run| &run.curve).collect();
        let is_free = |chain: &Chain| chain.runs().iter().all(|run| !carried.iter().any(|c| same_curve(c, &run.curve)));
        let free = sound.parts.curves.iter().filter(|c| is_free(&c.value));
        spec.things.extend(free.map(|c| (Value::Curve(c.value.clone()), Origin::NONE)));
        spec.show = Show { labels: spec.show.labels.or(Some(false)), ..spec.show };
    } else {
        spec.things.push((Value::Network(ModuleId::MAIN), Origin::NONE));
        spec.things.extend(sound.parts.points.iter().map(|p| (Value::point(p.value), Origin::NONE)));
    }
}
