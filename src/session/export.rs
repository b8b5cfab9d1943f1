//! `export`: what is written, in which format, with which settings.

use std::io::Write;

use glam::DVec3;

use super::plan::surfaces_of;
use super::report::{OutputRow, RenamedRow};
use crate::base::fault::{Edit, Say};
use crate::base::limits::FILE_WORK;
use crate::base::origin::Origin;
use crate::base::work::{Budget, Exceeded};
use crate::io::curve_files::polylines::{Drawing, Polyline};
use crate::io::files::access::unfit_name;
use crate::io::files::fault::{AccessFault, FormatFault, OutputFault};
use crate::io::formats::choice::curve_format_for;
use crate::io::formats::endings::{IGES, STEP, Sort, misfit};
use crate::io::tables::json::{self, Json};
use crate::io::tables::table::{Cell, Table};
use crate::io::tables::table_write;
use crate::io::{Deck, Encoding, FileError, Files, Format, Loss, Options, extension, format_for};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::scene::side_of;
use crate::lang::values::plans::ExportSpec;
use crate::lang::values::units::{LengthUnit, convert, length_unit};
use crate::lang::values::value::{Dim, MeshValue, ModuleId, Record, Value};
use crate::network::Chain;
use crate::surface::Surface;

/// Largest turn between two points of an exported curve, radians.
const TURN: f64 = std::f64::consts::PI / 36.0;
/// Looks at a smooth piece to find how far it turns.
const MAX_SAMPLES: usize = 64;

/// Writes one output; gives its row, and warnings about what the format cannot hold go to the sink of `cx`.
pub fn write(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<OutputRow, Halt> {
    let within = Budget::new(FILE_WORK).within(|| written(cx, spec, files));
    within.unwrap_or_else(|Exceeded| Err(OutputFault::TooMuchWork { of: spec.path_origin, path: spec.path.clone() }.into()))
}

fn written(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<OutputRow, Halt> {
    let Some((first, origin)) = spec.things.first() else {
        return Err(unsupported(spec.origin, "there is nothing to export".to_owned()));
    };
    let Some(sort) = sort_of(first) else {
        return Err(unsupported(*origin, format!("{} cannot be exported", first.ty().words())));
    };
    no_misplaced(spec)?;
    complete(cx, spec)?;
    let (bytes, losses) = match (extension(&spec.path).as_str(), sort) {
        ("igs" | "iges", Sort::Points | Sort::Curves | Sort::Surfaces | Sort::Shells) => super::export_iges::iges(cx, spec, files)?,
        ("step" | "stp", Sort::Points | Sort::Curves | Sort::Surfaces | Sort::Shells) => super::export_step::step(cx, spec, files)?,
        (_, Sort::Meshes) => mesh(cx, spec, files)?,
        (_, Sort::Curves) => curves(cx, spec, files)?,
        (_, Sort::Records) => records(cx, spec, files)?,
        (_, Sort::Tables) => super::export_tables::table(cx, spec, files)?,
        _ => return Err(misfit(spec.path_origin, &spec.path, sort).into()),
    };
    Loss::faults(&losses, spec.path_origin, &spec.path).into_iter().for_each(|fault| cx.say(&fault.into()));
    let mut row = OutputRow { path: spec.path.clone(), bytes, unit: unit_of(cx, spec).0, ..OutputRow::default() };
    for loss in losses {
        match loss {
            Loss::Renamed(names) => row.renamed.push(RenamedRow { path: row.path.clone(), from: names.from, to: names.to }),
            Loss::Unnamed(what) => row.unnamed.push(what),
            Loss::LeftOut(_) => {}
        }
    }
    Ok(row)
}

/// E904 where what is written lacks faces of a file, unless the export says that it may.
fn complete(cx: &Cx, spec: &ExportSpec) -> Result<(), Halt> {
    if spec.incomplete {
        return Ok(());
    }
    let mut surfaces: Vec<Surface> = Vec::new();
    for (thing, _) in &spec.things {
        match thing {
            Value::Mesh(mesh) => {
                if let MeshValue::Declared { module, index } = &**mesh
                    && let Some(mesh) = cx.meshes(*module).get(*index as usize)
                {
                    surfaces.extend(mesh.things.iter().flat_map(|(value, _)| surfaces_of(value)).cloned());
                }
            }
            other => surfaces.extend(surfaces_of(other).into_iter().cloned()),
        }
    }
    let Some(part) = cx.lacking(&surfaces) else { return Ok(()) };
    let of = spec.things.first().map_or(spec.origin, |thing| thing.1);
    Err(OutputFault::Incomplete {
        of,
        output: spec.origin,
        path: spec.path.clone(),
        part: part.name.to_string(),
        missing: part.unusable.len(),
    }
    .into())
}

/// What sort of thing a value is for a file; `None` for what goes into none.
fn sort_of(value: &Value) -> Option<Sort> {
    Some(match value {
        Value::Mesh(_) => Sort::Meshes,
        Value::Curve(_) | Value::Edge(..) => Sort::Curves,
        Value::Surface(_) => Sort::Surfaces,
        Value::Shell(_) => Sort::Shells,
        Value::Vector(_, Dim::LENGTH) | Value::Node(_) => Sort::Points,
        Value::Record(_) => Sort::Records,
        Value::Table(_) => Sort::Tables,
        _ => return None,
    })
}

/// Size of a file and what it could not hold.
pub(super) type Written = (u64, Vec<Loss>);

fn unsupported(of: Origin, what: String) -> Halt {
    let help = Some("export meshes, curves, or a list of records".to_owned());
    FormatFault::Unsupported { of, what, help, edits: Vec::new() }.into()
}

/// Colours of what imported CAD files give one, for files that hold them.
pub(super) struct Colors(Vec<([f64; 3], Vec<Value>)>);

impl Colors {
    pub fn of(cx: &Cx) -> Self {
        Self(cx.colors(ModuleId::MAIN))
    }

    fn first(&self, is: impl Fn(&Value) -> bool) -> Option<[f64; 3]> {
        self.0.iter().find(|(_, things)| things.iter().any(&is)).map(|(rgb, _)| *rgb)
    }

    /// That of a surface, on either side.
    pub fn of_surface(&self, surface: &Surface) -> Option<[f64; 3]> {
        const PROBE: (f64, f64) = (0.31, 0.23);
        let at = surface.point(PROBE.0, PROBE.1);
        // A declared surface is the imported one under another origin.
        let passes = |known: &Surface| known.point(PROBE.0, PROBE.1) == at || known.point(PROBE.0, 1.0 - PROBE.1) == at;
        let same = |known: &Surface| known.is(surface) || passes(known) && side_of(&known.with_origin(surface.origin()), surface).is_some();
        self.first(|value| matches!(value, Value::Surface(known) if same(known)))
    }

    /// That of a curve.
    pub fn of_curve(&self, chain: &Chain) -> Option<[f64; 3]> {
        let ends = |c: &Chain| (c.start(), c.end(), c.point(0.5), c.length());
        self.first(|value| matches!(value, Value::Curve(known) if known.is(chain) || ends(known) == ends(chain)))
    }
}

/// Writes through `fill`; a failure names the path.
pub(super) fn put(
    spec: &ExportSpec,
    files: &dyn Files,
    fill: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<Vec<Loss>>,
) -> Result<Written, Halt> {
    let mut losses = Vec::new();
    let bytes = write_file(spec.path_origin, &spec.path, files, &mut |out| fill(out).map(|found| losses = found))?;
    Ok((bytes, losses))
}

/// Writes a file through `fill`; gives its size. E802 outside the allowed folders, E808 where it cannot be written.
pub(super) fn write_file(
    of: Origin,
    path: &str,
    files: &dyn Files,
    fill: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>,
) -> Result<u64, Halt> {
    if let Some(why) = unfit_name(path) {
        return Err(AccessFault::CannotWrite { of, path: path.to_owned(), why }.into());
    }
    files.write(path, fill).map_err(|error| match error {
        FileError::Outside => AccessFault::Outside { of, path: path.to_owned() }.into(),
        FileError::Other(why) => AccessFault::CannotWrite { of, path: path.to_owned(), why }.into(),
        _ => AccessFault::CannotWrite { of, path: path.to_owned(), why: "the system refuses it".to_owned() }.into(),
    })
}

/// Name of the file's unit of length, and model units in one of it where it is another one. A format that has a unit of its own decides.
pub(super) fn unit_of(cx: &Cx, spec: &ExportSpec) -> (&'static str, Option<f64>) {
    let own = format_for(spec.path_origin, &spec.path).ok().and_then(|format| format.unit).and_then(length_unit);
    in_file(own.or(spec.units.map(|said| said.0)).unwrap_or(cx.unit()), cx.unit())
}

/// Name of a unit of length, and model units in one of it where it is another one.
pub(crate) fn in_file(unit: LengthUnit, model: LengthUnit) -> (&'static str, Option<f64>) {
    (unit.name, (unit != model).then(|| convert(1.0, unit, model, 1)))
}

/// E805 where `units:` asks for another unit than the one that all files of a format have.
fn unit_fits(format: &Format, spec: &ExportSpec) -> Result<(), Halt> {
    match (format.unit, spec.units) {
        (Some(own), Some((unit, of))) if unit.name != own => {
            let word = if unit.name == "in" { "inch" } else { unit.name };
            let what = format!("lengths in {} files are in {own}, got `units: {word}`", format.name.to_uppercase());
            Err(FormatFault::Unsupported { of, what, help: Some("remove `units:`".to_owned()), edits: vec![Edit::DropSetting] }.into())
        }
        _ => Ok(()),
    }
}

fn mesh(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Halt> {
    let format = format_for(spec.path_origin, &spec.path)?;
    let [(Value::Mesh(value), _)] = spec.things.as_slice() else {
        return Err(one_thing(spec));
    };
    unit_fits(format, spec)?;
    let mesh = cx.mesh(value)?;
    let (unit, units_per_file_unit) = unit_of(cx, spec);
    let colors = if format.colors { colors_of(cx, value) } else { Vec::new() };
    let encoding = spec.encoding.as_ref().map(|(word, _)| if **word == *"binary" { Encoding::Binary } else { Encoding::Text });
    let elements = spec.elements.iter().map(|(word, place)| (word.to_string(), *place)).collect();
    let groups = cx.groups(ModuleId::MAIN)?.iter().map(|group| group.name.to_string()).collect();
    let options = Options { encoding, elements, groups, colors, units_per_file_unit };
    let deck = Deck { mesh: &mesh, unit, options: &options };
    format.check(spec.path_origin, &deck)?;
    put(spec, files, &mut |out| (format.write)(&deck, out))
}

/// Colours of the surfaces that a mesh is of, by name.
fn colors_of(cx: &Cx, mesh: &MeshValue) -> Vec<(String, [f64; 3])> {
    let MeshValue::Declared { module, index } = mesh else { return Vec::new() };
    let colors = Colors::of(cx);
    let meshes = cx.meshes(*module);
    let things = meshes.get(*index as usize).map_or(&[][..], |mesh| &mesh.things);
    let surfaces = things.iter().flat_map(|(value, _)| surfaces_of(value));
    surfaces.filter_map(|surface| Some((cx.name(surface.origin()), colors.of_surface(surface)?))).collect()
}

fn one_thing(spec: &ExportSpec) -> Halt {
    let second = spec.things.get(1).map_or(spec.origin, |thing| thing.1);
    let help = Some("one `export` for each, or one mesh of both".to_owned());
    FormatFault::Unsupported { of: second, what: "a file holds one mesh".to_owned(), help, edits: Vec::new() }.into()
}

/// Settings that mean something for meshes only.
pub(super) fn no_mesh_settings(spec: &ExportSpec) -> Result<(), Halt> {
    let said = spec.encoding.as_ref().map(|s| ("encoding", s.1)).or(spec.elements.first().map(|s| ("element", s.1)));
    match said {
        Some((key, of)) => {
            let what = format!("`{key}:` is for meshes");
            Err(FormatFault::Unsupported { of, what, help: Some(format!("remove `{key}:`")), edits: vec![Edit::DropSetting] }.into())
        }
        None => Ok(()),
    }
}

/// Settings that mean something for one format only.
fn no_misplaced(spec: &ExportSpec) -> Result<(), Halt> {
    let cases = [("schema", &spec.schema, STEP, "STEP"), ("shells", &spec.shells, IGES, "IGES")];
    for (key, said, endings, format) in cases {
        if let Some((_, of)) = said
            && !endings.contains(&extension(&spec.path).as_str())
        {
            let what = format!("`{key}:` is for {format} files");
            let help = Some(format!("remove `{key}:`"));
            return Err(FormatFault::Unsupported { of: *of, what, help, edits: vec![Edit::DropSetting] }.into());
        }
    }
    Ok(())
}

fn curves(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Halt> {
    let format = curve_format_for(spec.path_origin, &spec.path)?;
    no_mesh_settings(spec)?;
    let (unit, scale) = unit_of(cx, spec);
    let tolerance = cx.tolerance()?;
    let mut lines = Vec::with_capacity(spec.things.len());
    for (value, origin) in &spec.things {
        let (chain, name) = match value {
            Value::Curve(chain) => (chain.clone(), cx.name(chain.origin())),
            Value::Edge(home, edge) => {
                let chain = super::plan::chain_of(cx, home, edge)?;
                let name = super::plan::edge_name(cx, &chain, edge);
                (chain, name)
            }
            _ => return Err(unsupported(*origin, format!("{} beside curves", value.ty().words()))),
        };
        let chain = &chain;
        let closed = chain.is_closed(&tolerance);
        let mut points = points_along(chain, &tolerance);
        if closed {
            points.pop();
        }
        if let Some(scale) = scale {
            points.iter_mut().for_each(|p| *p /= scale);
        }
        lines.push(Polyline { name, points, closed });
    }
    let drawing = Drawing { curves: &lines, unit };
    put(spec, files, &mut |out| (format.write)(&drawing, out))
}

/// Points that follow a curve: its ends and kinks, and between them as many that it turns little from one to the next.
fn points_along(chain: &Chain, tolerance: &crate::base::tolerance::Tolerance) -> Vec<DVec3> {
    let is_line = |run: &crate::network::Run| run.curve.kind() == crate::geometry::Kind::Line;
    if chain.runs().iter().all(is_line) {
        return chain.joints().iter().map(|f| chain.point(*f)).collect();
    }
    let mut corners = vec![0.0];
    corners.extend(chain.kinks(tolerance).into_iter().filter(|f| *f > 0.0 && *f < 1.0));
    corners.push(1.0);
    let mut points = vec![chain.start()];
    for piece in corners.windows(2) {
        let at = |k: usize, n: usize| piece[0] + (piece[1] - piece[0]) * k as f64 / n as f64;
        let tangents: Vec<DVec3> = (0..MAX_SAMPLES).map(|k| chain.jet(0.5 * (at(k, MAX_SAMPLES) + at(k + 1, MAX_SAMPLES))).d1).collect();
        let turn: f64 = tangents.windows(2).map(|t| crate::base::math::angle_between(t[0], t[1])).sum();
        // The looks stand in the middle of their parts: half a part at each end is not seen.
        let steps = (turn * (MAX_SAMPLES as f64 / (MAX_SAMPLES - 1) as f64) / TURN).ceil().max(1.0) as usize;
        points.extend((1..steps).map(|k| chain.point(at(k, steps))));
        points.push(chain.point(piece[1]));
    }
    points
}

fn records(cx: &mut Cx, spec: &ExportSpec, files: &dyn Files) -> Result<Written, Halt> {
    no_mesh_settings(spec)?;
    if let Some((_, of)) = spec.units {
        let what = "`units:` is for meshes and curves; records carry their units".to_owned();
        return Err(FormatFault::Unsupported { of, what, help: Some("remove `units:`".to_owned()), edits: vec![Edit::DropSetting] }.into());
    }
    let mut rows = Vec::with_capacity(spec.things.len());
    for (value, origin) in &spec.things {
        match value {
            Value::Record(record) => rows.push(record.clone()),
            other => return Err(unsupported(*origin, format!("{} beside records", other.ty().words()))),
        }
    }
    match extension(&spec.path).as_str() {
        "json" => {
            let list = Json::List(rows.iter().map(|row| json_record(cx, row)).collect());
            put(spec, files, &mut |out| json::write(&list, out).map(|()| Vec::new()))
        }
        "csv" => {
            let table = csv_table(cx, &rows);
            put(spec, files, &mut |out| table_write::write_csv(&table, out).map(|()| Vec::new()))
        }
        _ => Err(misfit(spec.path_origin, &spec.path, Sort::Records).into()),
    }
}

fn json_record(cx: &Cx, record: &Record) -> Json {
    let fields = record.keys.iter().zip(&record.values);
    Json::Record(fields.map(|(key, value)| (cx.program.names.text(*key).to_owned(), json_value(cx, value))).collect())
}

/// Numbers in model units and degrees, as in the report.
fn json_value(cx: &Cx, value: &Value) -> Json {
    match value {
        Value::None => Json::Null,
        Value::Bool(b) => Json::Bool(*b),
        Value::Number(q) => Json::Number(q.value),
        Value::Text(t) | Value::Word(t) => Json::Text(t.to_string()),
        Value::Vector(p, _) | Value::Node(p) => Json::List(p.to_array().map(Json::Number).to_vec()),
        Value::List(items) => Json::List(items.iter().map(|item| json_value(cx, item)).collect()),
        Value::Record(record) => json_record(cx, record),
        other => Json::Text(cx.show(other)),
    }
}

/// Columns are the keys of all rows in order of appearance; quantities carry their units.
fn csv_table(cx: &Cx, rows: &[std::sync::Arc<Record>]) -> Table {
    let mut keys = Vec::new();
    for key in rows.iter().flat_map(|row| row.keys.iter()) {
        if !keys.contains(key) {
            keys.push(*key);
        }
    }
    let cell = |value: Option<&Value>| match value {
        None | Some(Value::None) => Cell::None,
        Some(Value::Number(q)) if q.dim.is_none() => Cell::Number(q.value),
        Some(Value::Number(q)) => Cell::Quantity(q.value, crate::lang::values::units::unit_text(q.dim, cx.unit())),
        Some(Value::Text(t) | Value::Word(t)) => Cell::Text(t.to_string()),
        Some(other) => Cell::Text(cx.show(other)),
    };
    let cells = |row: &std::sync::Arc<Record>| keys.iter().map(|key| cell(row.get(*key))).collect();
    Table {
        title: Vec::new(),
        header: Some(keys.iter().map(|key| cx.program.names.text(*key).to_owned()).collect()),
        rows: rows.iter().map(cells).collect(),
        lines: Vec::new(),
    }
}
