//! What a script asks for, as lines: settings of meshes, exports and pictures as declared, checks.

use std::sync::Arc;

use super::cells::CellValue;
use super::contents::Contents;
use super::details::{Detail, Details};
use super::line_builder::{LineBuilder, line, yes};
use super::values::Value;
use super::words::{Measure, unit_of};
use crate::base::origin::Origin;
use crate::draw::View;
use crate::lang::eval::context::Cx;
use crate::lang::values::plans::{CheckResult, ExportSpec, MeshSpec, PictureSpec, Show};
use crate::lang::values::units::{degrees, unit_text};
use crate::lang::values::value::{Dim, MeshValue, ModuleId, Value as Thing};
use crate::mesh::request::settings::{Given, Settings, Takes};
use crate::session::collect;
use crate::session::report::Table;

/// Adds the lines of all that is asked for.
pub fn all(cx: &mut Cx, details: &mut Details) {
    let meshes: Vec<Arc<MeshSpec>> = cx.meshes(ModuleId::MAIN).to_vec();
    details.settings = meshes.iter().flat_map(|spec| settings(cx, spec)).collect();
    let (exports, pictures) = (cx.exports(), cx.pictures());
    details.outputs = exports.iter().map(|spec| export(cx, details, spec)).collect();
    details.exported = exports.iter().filter_map(|spec| records(cx, spec)).collect();
    details.outputs.extend(pictures.iter().map(|spec| picture(cx, details, spec)).collect::<Vec<_>>());
    details.labelled = cx.reports().iter().map(|report| report.labelled).collect();
    details.checks = cx.checks().iter().map(|result| check(cx, result)).collect();
}

/// A line with all that is written in a block.
fn written(line: LineBuilder, settings: &impl Settings, unit: &str) -> LineBuilder {
    settings.written().fold(line, |line, (declared, given, _)| {
        let value = match (given, declared.takes) {
            (Given::Number(x), Takes::Size) => Value::Real(x, unit_of(Measure::Length(1), unit)),
            (Given::Number(x), Takes::Angle) => Value::Real(degrees(x), "deg".to_owned()),
            (Given::Number(x), Takes::Count) => Value::Count(x as u64),
            (Given::Number(x), _) => Value::Real(x, String::new()),
            (Given::Flag(said), _) => Value::Word(yes(said).to_owned()),
            (Given::Word(word), _) => Value::Word(word.to_owned()),
        };
        line.put(declared.word, value)
    })
}

/// The settings of a mesh, then its clauses in order of writing.
fn settings(cx: &mut Cx, spec: &MeshSpec) -> Vec<super::line::Line> {
    let unit = cx.unit().name;
    let length = |x: f64| Value::Real(x, unit_of(Measure::Length(1), unit));
    let mut made = vec![written(line("settings", &spec.name), &spec.settings, unit)];
    for (k, rule) in spec.rules.iter().enumerate() {
        let contents = Contents::of(cx, rule.things.iter().map(|t| &t.0));
        let rule = written(line("settings", &format!("{} on {}", spec.name, k + 1)), &rule.settings, unit);
        made.push(rule.all(contents.pairs(unit)));
    }
    for (k, refine) in spec.refines.iter().enumerate() {
        let mut contents = Contents::of(cx, refine.things.iter().map(|t| &t.0));
        refine.boxes.iter().for_each(|b| contents.add_box(*b));
        let refine = line("settings", &format!("{} near {}", spec.name, k + 1)).put("size", length(refine.size.0));
        let radius = spec.refines[k].radius;
        made.push(refine.maybe("radius", radius.is_finite().then(|| length(radius))).all(contents.pairs(unit)));
    }
    made.retain(|line| !line.0.pairs.is_empty());
    made.into_iter().map(|line| line.0).collect()
}

/// The names of things that have one; others are given by where they are.
fn names(cx: &Cx, details: &Details, things: &[(Thing, Origin)]) -> Option<Value> {
    let named = things.iter().filter(|t| matches!(t.0, Thing::Curve(_) | Thing::Surface(_) | Thing::Shell(_) | Thing::Mesh(_)));
    let names: Vec<String> = named.map(|t| cx.show(&t.0)).filter(|name| details.declared.contains(name)).collect();
    (!names.is_empty()).then(|| Value::Word(names.join(", ")))
}

fn export(cx: &mut Cx, details: &Details, spec: &ExportSpec) -> super::line::Line {
    let unit = cx.unit().name;
    let said = |word: &Option<(Arc<str>, Origin)>| word.as_ref().map(|w| Value::Word(w.0.to_string()));
    let words: Vec<String> = spec.elements.iter().map(|e| e.0.to_string()).collect();
    let elements = (!words.is_empty()).then(|| Value::Word(words.join(", ")));
    let made: LineBuilder = line("export", &spec.path)
        .maybe("of", names(cx, details, &spec.things))
        .maybe("encoding", said(&spec.encoding))
        .maybe("element", elements)
        .maybe("schema", said(&spec.schema))
        .maybe("shells", said(&spec.shells))
        .maybe("units", spec.units.map(|u| Value::Word(u.0.name.to_owned())));
    let contents = Contents::of(cx, spec.things.iter().map(|t| &t.0).filter(|t| !is_declared_mesh(t)));
    made.all(contents.pairs(unit)).0
}

/// The table that an export of records writes.
fn records(cx: &mut Cx, spec: &ExportSpec) -> Option<(String, Table)> {
    let records: Vec<Thing> = spec.things.iter().filter(|t| matches!(t.0, Thing::Record(_))).map(|t| t.0.clone()).collect();
    let table = cx.table_of(&Thing::list(records))?;
    Some((spec.path.clone(), collect::table(&table)))
}

/// What has a line of its own already.
fn is_declared_mesh(thing: &Thing) -> bool {
    matches!(thing, Thing::Mesh(mesh) if matches!(**mesh, MeshValue::Declared { .. }))
}

fn picture(cx: &mut Cx, details: &Details, spec: &PictureSpec) -> super::line::Line {
    let unit = cx.unit().name;
    let direction = |d: glam::DVec3| Value::List(d.to_array().to_vec(), String::new());
    let contents = Contents::of(cx, spec.things.iter().map(|t| &t.0).filter(|t| !is_declared_mesh(t)));
    line("picture", &spec.path)
        .maybe("of", names(cx, details, &spec.things))
        .word("pixels", &format!("{} x {}", spec.size.0, spec.size.1))
        .put("eye", direction(spec.view.eye))
        .maybe("up", spec.view.up.map(direction))
        .maybe("view", spec.view.perspective.then(|| Value::Word("perspective".to_owned())))
        .maybe("views", views(&spec.views))
        .maybe("shade", spec.shade.as_ref().map(|s| Value::Word(s.0.to_string())))
        .maybe("zoom", names(cx, details, &spec.zoom))
        .maybe("title", spec.title.as_ref().map(|t| Value::Word(t.to_string())))
        .maybe("show", show(&spec.show))
        .all(contents.pairs(unit))
        .0
}

/// The views of a sheet by their names.
fn views(views: &[(String, View)]) -> Option<Value> {
    let names: Vec<&str> = views.iter().map(|view| view.0.as_str()).collect();
    (!names.is_empty()).then(|| Value::Word(names.join(", ")))
}

/// What is switched on and off.
fn show(show: &Show) -> Option<Value> {
    let Show { elements, borders, network, labels, axes, ruler, legend, combs } = *show;
    let all = [
        ("elements", elements),
        ("borders", borders),
        ("network", network),
        ("labels", labels),
        ("axes", axes),
        ("ruler", ruler),
        ("legend", legend),
        ("combs", combs),
    ];
    let said: Vec<String> = all.iter().filter_map(|(word, is)| is.map(|is| format!("{word} {}", yes(is)))).collect();
    (!said.is_empty()).then(|| Value::Word(said.join(", ")))
}

/// Both sides of a check, and what may lie between them.
fn check(cx: &Cx, result: &CheckResult) -> Detail {
    let side = |value: &Option<Thing>| {
        let value = value.as_ref()?;
        let dim = match value {
            Thing::Number(q) => q.dim,
            Thing::Vector(_, dim) => *dim,
            Thing::Node(_) => Dim::LENGTH,
            Thing::Bool(_) | Thing::Text(_) | Thing::Word(_) => Dim::NONE,
            // What else there is to compare is given by where it is, elsewhere.
            _ => return None,
        };
        Some((collect::cell(value), unit_text(dim, cx.unit())))
    };
    let all = [("left", &result.left_value), ("right", &result.right_value), ("within", &result.allowed)];
    let said = all.into_iter().filter_map(|(word, value)| side(value).map(|(cell, unit)| (word, cell, unit)));
    let pairs = said.map(|(word, cell, unit)| (word, Value::Cells(vec![CellValue::of(&cell, &unit)]))).collect();
    Detail { unnamed: !result.labelled, pairs }
}
