//! `import "offsets.csv" (unit: m) as offsets`: data files as values.

use std::sync::Arc;

use glam::DVec3;

use crate::base::limits;
use crate::base::origin::Origin;
use crate::io::files::fault::{ContentFault, FormatFault, Malformed};
use crate::io::tables::table::{Layout, Reading};
use crate::io::{self, Cell, Json, Obj};
use crate::lang::eval::bind::Signature;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::load::file_fault;
use crate::lang::eval::machine::{Code, Gather};
use crate::lang::syntax::ast::{Arg, ExprId};
use crate::lang::syntax::number::is_unit;
use crate::lang::values::settings::IMPORT;
use crate::lang::values::table::Table;
use crate::lang::values::units;
use crate::lang::values::units::LengthUnit;
use crate::lang::values::value::{Dim, MeshValue, Record, Value};
use crate::mesh::Mesh;

/// Notes about one file that are said one by one; more are counted.
const REPAIRS_SAID: usize = 5;
/// Endings that can be imported.
const ENDINGS: &[&str] = &["csv", "dat", "txt", "json", "obj", "stl", "igs", "iges", "stp", "step", "p21"];

/// Endings of CAD files.
const CAD: &[&str] = &["igs", "iges", "stp", "step", "p21"];

/// Endings of tables, which may have a header.
const TABLES: &[&str] = &["csv", "dat", "txt"];

/// One file being imported.
pub(crate) struct ImportedFile<'f> {
    pub path: &'f str,
    pub origin: Origin,
    pub unit: Option<LengthUnit>,
    header: Option<bool>,
    /// Little of it is enough.
    pub incomplete: bool,
}

/// Arguments of `import`.
#[derive(Default)]
struct ImportArgs {
    header: Option<bool>,
    unit: Option<LengthUnit>,
    incomplete: bool,
}

impl ImportedFile<'_> {
    pub fn malformed(&self, at: Malformed) -> Halt {
        ContentFault::Malformed { of: self.origin, path: self.path.to_owned(), at }.into()
    }

    /// Model units in one unit of the file.
    fn scale(&self, model: LengthUnit) -> f64 {
        self.unit.map_or(1.0, |unit| units::convert(1.0, unit, model, 1))
    }
}

impl Cx<'_> {
    pub(crate) fn import(&mut self, code: Code<'_>, path: ExprId, args: &[Arg]) -> Result<Value, Halt> {
        let (written, origin) = self.path_text(code, path)?;
        let ending = written.rsplit_once('.').map_or(String::new(), |e| e.1.to_ascii_lowercase());
        if !ENDINGS.contains(&ending.as_str()) {
            return Err(FormatFault::NoSuchFormat { of: origin, path: written, known: ENDINGS.to_vec() }.into());
        }
        let ImportArgs { header, unit, incomplete } = self.import_args(code, args, &ending)?;
        let from = self.machine.at(code.module).path.clone();
        let resolved = self.files.resolve(&from, &written).map_err(|e| file_fault(e, &written, origin))?;
        let bytes = self.files.read(&resolved, limits::DATA_BYTES).map_err(|e| file_fault(e, &written, origin))?;
        let file = ImportedFile { path: &written, origin, unit, header, incomplete };
        match ending.as_str() {
            "json" => {
                let json = io::tables::json::read(&bytes).map_err(|at| file.malformed(at))?;
                Ok(self.json(json))
            }
            "obj" => {
                let obj = io::mesh_files::obj_read::read(&bytes).map_err(|at| file.malformed(at))?;
                Ok(self.obj(&file, obj))
            }
            "stl" => {
                let (mesh, repairs) = io::mesh_files::stl_read::read(&bytes, stem(&written)).map_err(|at| file.malformed(at))?;
                self.repaired(&file, repairs);
                let mesh = self.imported_mesh(&file, mesh);
                Ok(self.record([("mesh", mesh)]))
            }
            "igs" | "iges" => self.iges(&file, &bytes),
            "stp" | "step" | "p21" => self.step_file(&file, &bytes),
            _ => {
                let layout = Layout::of_extension(&ending).unwrap_or(Layout::Blanks);
                let table = io::tables::table_read::read(&bytes, &Reading { layout, header: file.header, is_unit: &is_unit });
                self.table_value(&file, table.map_err(|at| file.malformed(at))?)
            }
        }
    }

    /// `header:`, `unit:` and `incomplete:`; E303 for one that files of this ending have no use for.
    fn import_args(&mut self, code: Code<'_>, args: &[Arg], ending: &str) -> Result<ImportArgs, Halt> {
        let shown = "import \"…\" (header: true, unit: m)".to_owned();
        let signature = Signature { name: "import", params: IMPORT.iter().map(|setting| setting.key).collect(), rest: None, shown };
        let places = self.match_args(code, &signature, 0, args)?;
        let (mut found, mut gather) = (ImportArgs::default(), Gather::default());
        for (arg, k) in args.iter().zip(places) {
            let (ty, subject) = (IMPORT[k].ty, format!("`{}`", IMPORT[k].key));
            let (idle, of) = match IMPORT[k].key {
                "header" => (!TABLES.contains(&ending), "tables: .csv .dat .txt"),
                "incomplete" => (!CAD.contains(&ending), "CAD files: .igs .iges .stp .step .p21"),
                _ => (ending == "json", "files of lengths, which are bare numbers in them"),
            };
            if idle {
                let text = format!("{subject} does not apply to a {ending} file");
                let draft = self.error(code, "E303", text, code.span(arg.value), "no such argument here");
                gather.take::<()>(Err(draft.note(format!("it is for {of}")).stop()));
                continue;
            }
            match gather.take(self.eval_as(code, arg.value, ty, &subject)) {
                Some(Value::Bool(b)) if IMPORT[k].key == "incomplete" => found.incomplete = b,
                Some(Value::Bool(b)) => found.header = Some(b),
                Some(Value::Word(w)) => found.unit = units::file_unit(&w),
                _ => {}
            }
        }
        gather.done().map(|()| found)
    }

    pub(crate) fn repaired(&mut self, file: &ImportedFile, repairs: Vec<Malformed>) {
        let said = if self.sink.whole { repairs.len() } else { REPAIRS_SAID };
        let more = repairs.len().saturating_sub(said);
        for mut at in repairs.into_iter().take(said) {
            if more > 0 && at.what.is_empty() {
                at.what = "repaired".to_owned();
            }
            self.say(&ContentFault::Repaired { of: file.origin, path: file.path.to_owned(), at }.into());
        }
        if more > 0 {
            let at = Malformed { line: 0, column: None, what: format!("{more} more places were skipped or repaired") };
            self.say(&ContentFault::Repaired { of: file.origin, path: file.path.to_owned(), at }.into());
        }
    }

    fn json(&mut self, json: Json) -> Value {
        match json {
            Json::Null => Value::None,
            Json::Bool(b) => Value::Bool(b),
            Json::Number(x) => Value::number(x),
            Json::Text(t) => Value::Text(t.into()),
            Json::List(items) => Value::list(items.into_iter().map(|i| self.json(i)).collect()),
            Json::Record(fields) => {
                let (keys, values) = fields.into_iter().map(|(k, v)| (self.program.names.intern(&k), self.json(v))).unzip();
                Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false, part: None }))
            }
        }
    }

    fn obj(&mut self, file: &ImportedFile, mut obj: Obj) -> Value {
        let scale = file.scale(self.program.unit);
        let (mesh, mut repairs) = obj.mesh(stem(file.path));
        let mut skipped = std::mem::take(&mut obj.skipped);
        skipped.append(&mut repairs);
        self.repaired(file, skipped);
        self.seen(obj.points.iter().chain(obj.polylines.iter().flatten()).map(|p| *p * scale));
        let points = |list: &[DVec3]| Value::list(list.iter().map(|p| Value::point(*p * scale)).collect());
        let polylines: Vec<Value> = obj.polylines.iter().map(|l| points(l)).collect();
        let corner = |k: &u32| Value::point(obj.vertices[*k as usize] * scale);
        let polygons: Vec<Value> = obj.polygons.iter().map(|p| Value::list(p.iter().map(corner).collect())).collect();
        let groups: Vec<Value> = obj
            .groups
            .iter()
            .map(|g| {
                let lines = g.polylines.iter().filter_map(|k| polylines.get(*k).cloned()).collect();
                let faces = g.polygons.iter().filter_map(|k| polygons.get(*k).cloned()).collect();
                self.record([("name", Value::text(&g.name)), ("polylines", Value::list(lines)), ("polygons", Value::list(faces))])
            })
            .collect();
        let mesh = self.imported_mesh(file, mesh);
        self.record([
            ("points", points(&obj.points)),
            ("polylines", Value::list(polylines)),
            ("polygons", Value::list(polygons)),
            ("groups", Value::list(groups)),
            ("mesh", mesh),
        ])
    }

    fn imported_mesh(&mut self, file: &ImportedFile, mut mesh: Mesh) -> Value {
        let scale = file.scale(self.program.unit);
        if scale != 1.0 {
            mesh.nodes.iter_mut().for_each(|p| *p *= scale);
        }
        self.seen(mesh.nodes.iter().copied());
        Value::Mesh(Arc::new(MeshValue::Data(Arc::new(mesh), file.origin)))
    }

    fn table_value(&mut self, file: &ImportedFile, table: io::Table) -> Result<Value, Halt> {
        self.steps(table.rows.iter().map(Vec::len).sum())?;
        let model = self.program.unit;
        let number = |x: f64| match file.unit {
            Some(unit) => Value::quantity(units::convert(x, unit, model, 1), Dim::LENGTH),
            None => Value::number(x),
        };
        let cell = |c: Cell| match c {
            Cell::Number(x) => number(x),
            Cell::Quantity(x, unit) => units::quantity(x, &unit, model).map_or(Value::None, Value::Number),
            Cell::Text(t) => Value::Text(t.into()),
            Cell::None => Value::None,
        };
        let keys = table.header.iter().flatten().map(|h| self.program.names.intern(h)).collect();
        let keys = Arc::new(keys);
        let has_header = table.header.is_some();
        let row = |cells: Vec<Cell>| {
            let values: Vec<Value> = cells.into_iter().map(cell).collect();
            if has_header {
                Value::Record(Arc::new(Record { keys: Arc::clone(&keys), values, row: true, part: None }))
            } else {
                Value::list(values)
            }
        };
        let rows: Vec<Value> = table.rows.into_iter().map(row).collect();
        // A header of stations is numbers as well as names.
        let head = |text: &String| match text.parse::<f64>() {
            Ok(x) if x.is_finite() => number(x),
            _ => Value::text(text),
        };
        let header = table.header.as_ref().map(|h| Arc::new(h.iter().map(head).collect::<Vec<_>>()));
        let title = table.title.join("\n").into();
        Ok(Value::Table(Arc::new(Table { title, header, keys, rows: Arc::new(rows) })))
    }
}

/// The file's name without folder and ending.
fn stem(path: &str) -> &str {
    let name = path.rsplit_once('/').map_or(path, |p| p.1);
    name.rsplit_once('.').map_or(name, |n| n.0)
}
