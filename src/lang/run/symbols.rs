//! What a script declares, as tools show it: names, places, states, dependencies, and a line about each value.

use std::sync::Arc;

use crate::lang::assist::KnownType;
use crate::lang::diag::diagnostic::FileId;
use crate::lang::diag::span::Span;
use crate::lang::eval::context::Cx;
use crate::lang::eval::module::State;
use crate::lang::syntax::ast::Keyword;
use crate::lang::syntax::scopes::bound;
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::units::unit_text;
use crate::lang::values::value::{Dim, MeshValue, ModuleId, Value};
use crate::lang::words::plural::counted;
use crate::mesh::Mesh;
use crate::model::{SurfaceId, measure};
use crate::network::Chain;
use crate::surface::{Domain, Surface};

/// Significant digits of measured values in a line about them.
const DIGITS: usize = 6;
/// Longest text of a plain value in a line about it.
const CHARACTERS: usize = 100;

/// How far a declaration came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// It has a value.
    Sound,
    /// It was reported.
    Failed,
    /// It depends on something that failed.
    Skipped,
}

/// One declaration.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// The name it binds; `None` for checks, reports, exports and head lines.
    pub name: Option<String>,
    /// What it starts with.
    pub keyword: Keyword,
    /// Where it stands.
    pub file: FileId,
    /// From its keyword to its last token.
    pub span: Span,
    /// Where its name stands.
    pub name_span: Option<Span>,
    /// Its doc comment.
    pub doc: Option<String>,
    /// How far it came.
    pub condition: Condition,
    /// What kind of value it has.
    pub shape: KnownType,
    /// Declarations of the same script that it names, by their places in the list of symbols.
    pub needs: Vec<usize>,
}

impl Cx<'_> {
    /// The declarations of the main script that parsed, in order of writing.
    pub fn symbols(&self) -> Vec<Symbol> {
        let Some(module) = self.machine.modules.first() else { return Vec::new() };
        let symbol = |(declaration, state): (Arc<crate::lang::syntax::ast::Declaration>, &State)| {
            let bound = bound(&declaration);
            Symbol {
                name: bound.map(|b| self.program.names.text(b.name).to_owned()),
                keyword: declaration.keyword,
                file: module.file,
                span: declaration.span,
                name_span: bound.map(|b| b.span),
                doc: declaration.doc.as_deref().map(str::to_owned),
                condition: match state {
                    State::Done(_) => Condition::Sound,
                    State::Failed => Condition::Failed,
                    _ => Condition::Skipped,
                },
                shape: if let State::Done(value) = state { KnownType::of_value(value, &self.program.names) } else { KnownType::Unknown },
                needs: self.needs(ModuleId::MAIN, &declaration),
            }
        };
        module.script.declarations.iter().zip(&module.states).map(symbol).collect()
    }

    /// A line about the value of a name of the main script: `curve south: arc, 12.5664 m, 3 links`.
    ///
    /// What is costly (meshes) is only told when it was made already. `None` when the name has no value.
    pub fn describe_name(&mut self, name: &str) -> Option<String> {
        let value = self.value_of(name)?;
        let module = self.machine.modules.first()?;
        let index = module.find(self.program.names.find(name)?)?;
        let word = crate::lang::eval::unbound::keyword_word(module.script.declarations.keyword(index as usize));
        let about = self.describe(&value);
        Some(if about.is_empty() { format!("{word} {name}") } else { format!("{word} {name}: {about}") })
    }

    /// What a value is and measures, in a few words.
    pub fn describe(&mut self, value: &Value) -> String {
        match value {
            Value::Curve(chain) => self.about_curve(chain),
            Value::Surface(surface) => self.about_surface(surface),
            Value::Shell(shell) => {
                let area = measure::sheet(&shell.surfaces).area;
                format!("{}, {}", counted(shell.surfaces.len(), "surface", "surfaces"), self.measured(area, Dim::AREA))
            }
            Value::Mesh(mesh) => match &**mesh {
                MeshValue::Data(mesh, _) => about_mesh(mesh),
                MeshValue::Declared { .. } => String::new(),
            },
            Value::List(items)
                if items.len() > 1 && items.iter().all(|i| !matches!(i, Value::Number(_) | Value::Vector(..) | Value::Node(_))) =>
            {
                let ty = items[0].ty();
                let alike = items.iter().all(|i| i.ty() == ty);
                if alike && is_entity(&items[0]) { format!("{} × {}", items.len(), noun(ty)) } else { self.clipped(value) }
            }
            Value::Record(record) if record.part.is_some() => match &record.part {
                Some(part) => {
                    let faces = counted(part.faces.len(), "surface", "surfaces");
                    let area = self.measured(measure::sheet(&part.faces).area, Dim::AREA);
                    format!("{faces}, {}, {area}", counted(part.bodies.len(), "body", "bodies"))
                }
                None => String::new(),
            },
            Value::Table(table) => {
                let rows = counted(table.rows.len(), "row", "rows");
                let names: Vec<&str> = table.keys.iter().map(|k| self.program.names.text(*k)).collect();
                if names.is_empty() { format!("table, {rows}") } else { format!("table, {rows} of {}", names.join(", ")) }
            }
            Value::Module(id) => {
                let module = self.machine.at(*id);
                let names: Vec<&str> = module.names().map(|n| self.program.names.text(n)).collect();
                format!("module with {}", names.join(", "))
            }
            Value::Network(id) => match self.network(*id) {
                Ok(n) => {
                    let (curves, links) = (counted(n.curves.len(), "curve", "curves"), counted(n.links.len(), "link", "links"));
                    format!("network of {curves}, {links}, {}", counted(n.nodes.len(), "node", "nodes"))
                }
                Err(_) => "network".to_owned(),
            },
            Value::None => String::new(),
            Value::Text(_) => self.clipped_text(self.show_inside(value)),
            other => self.clipped(other),
        }
    }

    fn clipped(&self, value: &Value) -> String {
        self.clipped_text(self.show(value))
    }

    fn clipped_text(&self, text: String) -> String {
        if text.chars().count() <= CHARACTERS {
            return text;
        }
        let mut short: String = text.chars().take(CHARACTERS).collect();
        short.push('…');
        short
    }

    fn about_curve(&mut self, chain: &Chain) -> String {
        let kind = match chain.whole_curve() {
            Some(curve) => curve.kind().name().to_owned(),
            None => format!("chain of {}", counted(chain.runs().len(), "run", "runs")),
        };
        let mut out = format!("{kind}, {}", self.measured(chain.length(), Dim::LENGTH));
        let module = ModuleId::MAIN;
        if let (Some(tolerance), Ok(network)) = (self.tolerance, self.network(module))
            && let Some(links) = network.links_of(chain, &tolerance)
        {
            out.push_str(&format!(", {}", counted(links.len(), "link", "links")));
        }
        out
    }

    fn about_surface(&mut self, surface: &Surface) -> String {
        let mut parts = vec![surface.kind().name().to_owned()];
        if !surface.flow().is_empty() {
            parts.push(surface.flow());
        }
        let patches = self.model(ModuleId::MAIN).ok().and_then(|model| {
            let at = model.surfaces.iter().position(|named| named.surface.is(surface))?;
            Some(model.patches_of(SurfaceId::at(at)).count())
        });
        parts.extend(patches.map(|n| counted(n, "patch", "patches")));
        if surface.domain() != Domain::Unbounded {
            parts.push(self.measured(measure::area(surface), Dim::AREA));
        }
        parts.join(", ")
    }

    /// A measured value in few digits with its unit.
    pub fn measured(&self, x: f64, dim: Dim) -> String {
        let rounded: f64 = format!("{x:.*e}", DIGITS - 1).parse().unwrap_or(x);
        let unit = unit_text(dim, self.program.unit);
        format!("{} {unit}", units::number_text(rounded))
    }
}

/// Nodes, elements and quality of a mesh in a line.
pub fn about_mesh(mesh: &Mesh) -> String {
    let mut parts = vec![counted(mesh.nodes.len(), "node", "nodes")];
    for (n, one, many) in [(mesh.triangles.len(), "triangle", "triangles"), (mesh.quads.len(), "quad", "quads")] {
        if n > 0 {
            parts.push(counted(n, one, many));
        }
    }
    if let Some(quality) = mesh.quality() {
        parts.push(format!("least angle {:.1}°", units::degrees(quality.min_angle)));
    }
    parts.join(", ")
}

fn is_entity(value: &Value) -> bool {
    !matches!(
        value,
        Value::None
            | Value::Bool(_)
            | Value::Number(_)
            | Value::Range(..)
            | Value::Vector(..)
            | Value::Text(_)
            | Value::Word(_)
            | Value::List(_)
    )
}

/// "curve" for a curve.
fn noun(ty: Ty) -> String {
    let words = ty.words();
    words.strip_prefix("a ").or(words.strip_prefix("an ")).unwrap_or(&words).to_owned()
}
