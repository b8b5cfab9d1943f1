//! The members of an entity with their values, as `report roof` shows them.

use crate::base::fault::{Fault, Say};
use crate::base::limits;
use crate::lang::eval::coerce::{Misfit, accepts, flatten_into};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::room::flat_len;
use crate::lang::eval::std;
use crate::lang::eval::std::Builtin;
use crate::lang::values::plans::ReportTable;
use crate::lang::values::types::Ty;
use crate::lang::values::units;
use crate::lang::values::value::{Dim, Value};
use crate::mesh::Group;

/// The column of a member's unit, where each member is a row.
pub const UNIT_COLUMN: &str = "unit";

/// A member and its value.
type NamedValue = (String, Value);

impl Cx<'_> {
    /// The members of an entity a row each, or of a list with entities those of each a row; `None` for other values.
    pub(crate) fn members_table(&mut self, value: &Value) -> Result<Option<ReportTable>, Halt> {
        match value {
            Value::List(_) => self.members_rows(&[(String::new(), value.clone())]),
            one if is_entity(one) || is_place(one) => {
                let mut members = self.members_of(one)?;
                members.extend(self.sets_of(one)?);
                members.extend(self.net_of(one));
                let row = |(member, value): NamedValue| {
                    let (value, unit) = self.apart(value);
                    vec![Value::text(&member), value, Value::text(&unit)]
                };
                let rows = members.into_iter().map(row).collect();
                Ok(Some(self.with_units(String::new(), vec!["member".into(), "value".into(), UNIT_COLUMN.into()], rows)))
            }
            _ => Ok(None),
        }
    }

    /// A row for each of these things, members of families and groups included; `None` where none is an entity.
    pub(crate) fn members_rows(&mut self, things: &[(String, Value)]) -> Result<Option<ReportTable>, Halt> {
        // So many are no rows to read.
        if things.iter().any(|(_, value)| flat_len(value, limits::LIST_MEMBERS) > limits::LIST_MEMBERS) {
            return Ok(None);
        }
        let mut flat: Vec<(Option<&str>, Value)> = Vec::new();
        for (source, value) in things {
            let mut items = Vec::new();
            flatten_into(value.clone(), &mut items);
            let alone = !matches!(value, Value::List(_) | Value::Range(..));
            flat.extend(items.into_iter().map(|item| (alone.then_some(source.as_str()), item)));
        }
        if !flat.iter().any(|(_, value)| is_entity(value)) {
            return Ok(None);
        }
        let mut columns: Vec<String> = vec!["name".to_owned()];
        let mut rows: Vec<Vec<Value>> = Vec::with_capacity(flat.len());
        for (source, value) in flat {
            let entity = is_entity(&value) || is_place(&value);
            let name = source.filter(|_| !is_entity(&value)).map_or_else(|| self.show(&value), str::to_owned);
            let members = if entity { self.members_of(&value)? } else { vec![("value".to_owned(), value)] };
            let mut row = vec![Value::text(&name)];
            for (member, value) in members {
                let at = columns.iter().position(|c| *c == member).unwrap_or_else(|| {
                    columns.push(member);
                    columns.len() - 1
                });
                row.resize(row.len().max(at + 1), Value::None);
                row[at] = value;
            }
            rows.push(row);
        }
        Ok(Some(self.with_units(String::new(), columns, rows)))
    }

    /// What an entity is and its members: lists by how many they hold, records by their own members, `none` for what this one does
    /// not have (the volume of an open shell).
    fn members_of(&mut self, of: &Value) -> Result<Vec<NamedValue>, Halt> {
        let mut members = what(of);
        let (mut any, mut first) = (!members.is_empty(), None);
        // The sides of a surface are curves: a table would repeat the name of the surface for each.
        let told = |f: &&Builtin| !(matches!(of, Value::Surface(_)) && f.returns == Ty::Curve);
        for field in std::fields().filter(|f| f.params.first().is_some_and(|p| accepts(p.ty, of))).filter(told) {
            match self.member_value(field, of) {
                Ok(value) => {
                    any = true;
                    self.push_member(field.name, value, &mut members);
                }
                Err(Halt::Fault(fault)) if !matches!(fault, Fault::Interrupted) => {
                    first.get_or_insert(fault);
                    members.push((field.name.to_owned(), Value::None));
                }
                Err(stop) => return Err(stop),
            }
        }
        match first {
            Some(fault) if !any => Err(Halt::Fault(fault)),
            _ => Ok(members),
        }
    }

    /// The sets of a mesh by their counts.
    fn sets_of(&mut self, of: &Value) -> Result<Vec<NamedValue>, Halt> {
        let Value::Mesh(mesh) = of else { return Ok(Vec::new()) };
        let mesh = self.mesh(mesh)?;
        let counts = |g: &Group| {
            let elements = g.lines.len() + g.triangles.len() + g.quads.len();
            [("nodes", g.nodes.len()), ("elements", elements)].map(|(what, n)| (format!("set {}.{what}", g.name), Value::number(n as f64)))
        };
        Ok(mesh.groups.iter().flat_map(counts).collect())
    }

    /// The curves that a surface was made through: how far it lies from each, and how much stations were scaled.
    fn net_of(&mut self, of: &Value) -> Vec<NamedValue> {
        let Value::Surface(surface) = of else { return Vec::new() };
        let (mut counts, mut rows) = ([0usize; 2], Vec::new());
        let word = if surface.families().1.is_empty() { "section" } else { "guide" };
        for curve in surface.net_curves() {
            let (kind, count) = if curve.along_u { (word, &mut counts[1]) } else { ("station", &mut counts[0]) };
            let name = if curve.given { self.name(curve.origin) } else { String::new() };
            let title = format!("{kind} {count}{}{name}", if name.is_empty() { "" } else { " " });
            *count += 1;
            rows.push((format!("{title}.at"), Value::number(curve.at)));
            rows.push((format!("{title}.segments"), Value::number(curve.segments as f64)));
            rows.extend(curve.scale.map(|scale| (format!("{title}.scale"), Value::number(scale))));
            rows.push((format!("{title}.residual"), Value::length(curve.residual)));
        }
        rows
    }

    fn push_member(&self, name: &str, value: Value, members: &mut Vec<NamedValue>) {
        match value {
            Value::Record(record) => {
                for (key, value) in record.keys.iter().zip(&record.values) {
                    self.push_member(&format!("{name}.{}", self.program.names.text(*key)), value.clone(), members);
                }
            }
            list if list.len().is_some() => members.push((name.to_owned(), Value::number(list.len().unwrap_or(0) as f64))),
            other => members.push((name.to_owned(), other)),
        }
    }

    /// The value of a member; of lists that are as long as a mesh their length.
    fn member_value(&mut self, field: &Builtin, of: &Value) -> Result<Value, Halt> {
        if let Value::Mesh(mesh) = of {
            let mesh = self.mesh(mesh)?;
            let count = match field.name {
                "nodes" => Some(mesh.nodes.len()),
                "triangles" => Some(mesh.triangles.len()),
                "quads" => Some(mesh.quads.len()),
                "edge_lengths" => Some(mesh.edge_lengths().len()),
                _ => None,
            };
            if let Some(count) = count {
                return Ok(Value::number(count as f64));
            }
        }
        let (Some(param), module) = (field.params.first(), self.module()) else { return Err(Halt::Bug("a field of nothing")) };
        let fitted = self.coerce(of.clone(), param.ty, module).map_err(|(_, misfit)| match misfit {
            Misfit::Halt(stop) => stop,
            _ => Halt::Bug("a field does not take what it accepts"),
        })?;
        (field.call)(self, vec![fitted])
    }

    /// A value without its unit, and the unit.
    fn apart(&self, value: Value) -> (Value, String) {
        let unit = |dim: Dim| units::unit_text(dim, self.program.unit);
        match value {
            Value::Number(q) => (Value::number(q.value), unit(q.dim)),
            Value::Vector(v, dim) => (Value::Vector(v, Dim::NONE), unit(dim)),
            Value::Node(p) => (Value::Vector(p, Dim::NONE), unit(Dim::LENGTH)),
            other => (other, String::new()),
        }
    }
}

/// Whether a value has members.
fn is_entity(value: &Value) -> bool {
    use Value::{Curve, Edge, Link, Mesh, Network, Patch, Plane, Shell, Surface, Vertex};
    value.part().is_some()
        || matches!(
            value,
            Curve(_) | Link(..) | Edge(..) | Vertex(..) | Patch(..) | Surface(_) | Shell(_) | Mesh(_) | Plane(_) | Network(_)
        )
}

/// Whether a value is a place, whose members are its coordinates.
fn is_place(value: &Value) -> bool {
    matches!(value, Value::Node(_) | Value::Vector(_, Dim::LENGTH))
}

/// What no member says: the constructor of curves and surfaces, the flow found, and where a plane lies.
fn what(value: &Value) -> Vec<NamedValue> {
    let text = |name: &str, text: &str| (name.to_owned(), Value::text(text));
    match value {
        Value::Curve(chain) => vec![text("kind", chain.whole_curve().map_or("chain", |curve| curve.kind().name()))],
        Value::Surface(surface) => {
            let flow = surface.flow();
            let mut members = vec![text("kind", surface.kind().name())];
            if !flow.is_empty() {
                members.push(text("flow", &flow));
            }
            members
        }
        Value::Record(_) => {
            let part = value.part();
            let bodies = part.map(|part| ("bodies".to_owned(), Value::number(part.bodies.len() as f64)));
            let unusable = part.map(|part| ("unusable".to_owned(), Value::number(part.unusable.len() as f64)));
            bodies.into_iter().chain(unusable).collect()
        }
        Value::Plane(plane) => {
            vec![("at".to_owned(), Value::point(plane.at)), ("normal".to_owned(), Value::Vector(plane.normal, Dim::NONE))]
        }
        _ => Vec::new(),
    }
}
