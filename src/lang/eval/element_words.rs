//! Which of the many words of `element:` an export may say: those of its format for the kinds of elements that its mesh has.

use crate::base::origin::Origin;
use crate::io::{Shape, format_for};
use crate::lang::eval::context::Cx;
use crate::lang::eval::machine::Code;
use crate::lang::syntax::ast::{DeclarationKind, Keyword};
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::value::{MeshValue, Value};
use crate::mesh::{Elements, Mesh};

impl Cx<'_> {
    /// The words of the export being evaluated; `None` where its file or its mesh is not known, and where its format has no such words.
    pub(crate) fn element_words(&mut self, code: Code<'_>) -> Option<Vec<&'static str>> {
        let script = self.machine.at(code.module).script.clone();
        let declaration = script.declarations.get(code.declaration as usize)?;
        let DeclarationKind::Output { things, to, .. } = &declaration.kind else { return None };
        let (path, _) = self.path(code, *to).ok()?;
        let format = format_for(Origin::NONE, &path).ok()?;
        let shapes = match self.things(code, things, Keyword::Export).ok()?.first() {
            Some((Value::Mesh(mesh), _)) => match &**mesh {
                MeshValue::Data(mesh, _) => shapes_of(mesh),
                MeshValue::Declared { module, index } => shapes_asked(self.meshes(*module).get(*index as usize)?),
            },
            _ => return None,
        };
        let fitting: Vec<&str> = format.elements.iter().filter(|(_, shape)| shapes.contains(shape)).map(|(name, _)| *name).collect();
        let all = || format.elements.iter().map(|(name, _)| *name).collect::<Vec<_>>();
        Some(if fitting.is_empty() { all() } else { fitting }).filter(|words| !words.is_empty())
    }
}

/// The shapes that a mesh has.
fn shapes_of(mesh: &Mesh) -> Vec<Shape> {
    let has = [!mesh.lines.is_empty(), !mesh.triangles.is_empty(), !mesh.quads.is_empty()];
    Shape::of_order(mesh.order).into_iter().zip(has).filter(|(_, has)| *has).map(|(shape, _)| shape).collect()
}

/// The shapes that a declared mesh will have, by what it is of and its settings.
fn shapes_asked(spec: &MeshSpec) -> Vec<Shape> {
    let [line, triangle, quad] = Shape::of_order(spec.settings.order());
    let elements = spec.settings.elements();
    let of_rules = spec.rules.iter().filter_map(|rule| rule.settings.elements.map(|said| said.0));
    let kinds: Vec<Elements> = std::iter::once(elements).chain(of_rules).collect();
    let curves = spec.things.iter().any(|(value, _)| matches!(value, Value::Curve(_) | Value::Link(..) | Value::Edge(..)));
    let faces = spec.things.iter().any(|(value, _)| matches!(value, Value::Surface(_) | Value::Shell(_)));
    let wanted = [
        (line, curves),
        (triangle, faces && kinds.iter().any(|kind| *kind != Elements::Quads)),
        (quad, faces && kinds.iter().any(|kind| *kind != Elements::Triangles)),
    ];
    wanted.into_iter().filter(|(_, wanted)| *wanted).map(|(shape, _)| shape).collect()
}
