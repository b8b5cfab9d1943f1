//! Values as text: what interpolation, messages and reports print.

use glam::DVec3;

use crate::lang::eval::context::Cx;
use crate::lang::values::units::{number_text, quantity_text, unit_text};
use crate::lang::values::value::{Dim, MeshValue, Quantity, Value};

/// Members of a list shown in a text.
const MEMBERS_SHOWN: usize = 1000;
/// Members shown of lists inside each other, all together.
const ALL_SHOWN: usize = 100_000;

impl Cx<'_> {
    /// A value as text: shortest numbers with units, names for geometry.
    pub fn show(&self, value: &Value) -> String {
        let mut left = ALL_SHOWN;
        self.show_some(value, &mut left)
    }

    /// Like [`Cx::show`]; `left` members are shown at most, those of inner lists included.
    fn show_some(&self, value: &Value, left: &mut usize) -> String {
        let mut inside = |v: &Value| match v {
            Value::List(_) | Value::Record(_) if *left == 0 => "…".to_owned(),
            Value::List(_) | Value::Record(_) => {
                *left -= 1;
                self.show_some(v, left)
            }
            other => {
                *left = left.saturating_sub(1);
                self.show_inside(other)
            }
        };
        match value {
            Value::None => "none".into(),
            Value::Bool(b) => b.to_string(),
            Value::Number(q) => self.quantity(*q),
            Value::Range(a, b) => format!("{a}..{b}"),
            Value::Vector(v, dim) => self.vector(*v, *dim),
            Value::Node(p) => self.vector(self.tolerance.map_or(*p, |t| t.rounded(*p)), Dim::LENGTH),
            Value::Text(t) | Value::Word(t) => t.to_string(),
            Value::List(items) => {
                let mut parts: Vec<String> = items.iter().take(MEMBERS_SHOWN).map(inside).collect();
                if items.len() > MEMBERS_SHOWN {
                    parts.push(format!("… {} in all", items.len()));
                }
                format!("[{}]", parts.join(", "))
            }
            Value::Record(r) if r.part.is_some() => r.part.as_ref().map_or_else(String::new, |part| part.name.to_string()),
            Value::Record(r) => {
                let parts: Vec<String> =
                    r.keys.iter().zip(&r.values).map(|(k, v)| format!("{}: {}", self.program.names.text(*k), inside(v))).collect();
                format!("{{{}}}", parts.join(", "))
            }
            Value::Curve(c) => self.entity(c.origin(), "curve"),
            Value::Surface(s) => self.entity(s.origin(), "surface"),
            Value::Shell(s) => s.name.to_string(),
            Value::Mesh(m) => match &**m {
                MeshValue::Declared { module, index } => {
                    self.meshes(*module).get(*index as usize).map_or_else(|| "mesh".into(), |m| m.name.to_string())
                }
                MeshValue::Data(mesh, _) if mesh.name.is_empty() => "mesh".into(),
                MeshValue::Data(mesh, _) => mesh.name.clone(),
            },
            Value::Link(_, id) => format!("link {}", id.0 + 1),
            Value::Edge(_, edge) => format!("edge {}", edge.named_by.0 + 1),
            Value::Vertex(_, id) => format!("vertex {}", id.0 + 1),
            Value::Patch(_, id) => format!("patch {}", id.0 + 1),
            Value::Plane(_) => "plane".into(),
            Value::Table(_) => "table".into(),
            Value::Module(m) => self.machine.modules.get(m.index()).map_or_else(String::new, |m| m.label.clone()),
            Value::Network(_) => "network".into(),
            Value::Drawing(drawing) => drawing.words().into(),
        }
    }

    /// Like [`Cx::show`] with quotes around texts.
    pub fn show_inside(&self, value: &Value) -> String {
        match value {
            Value::Text(t) => format!("\"{}\"", t.replace('\\', "\\\\").replace('"', "\\\"")),
            other => self.show(other),
        }
    }

    /// A quantity as shortest number and unit.
    pub fn quantity(&self, q: Quantity) -> String {
        quantity_text(q, self.program.unit)
    }

    fn vector(&self, v: DVec3, dim: Dim) -> String {
        let unit = unit_text(dim, self.program.unit);
        let part = |x: f64| format!("{}{unit}", number_text(x));
        format!("({}, {}, {})", part(v.x), part(v.y), part(v.z))
    }

    fn entity(&self, origin: crate::base::origin::Origin, kind: &str) -> String {
        let name = crate::base::fault::Say::name(self, origin);
        if name.is_empty() { kind.to_owned() } else { name }
    }

    /// What kind of value it is, in words: "a length".
    pub fn kind(&self, value: &Value) -> String {
        match value {
            Value::List(items) if items.is_empty() => "an empty list".into(),
            other => other.ty().words(),
        }
    }
}
