//! `import "part.igs" as part`, `import "part.step" as part`: points, curves, surfaces and groups of a CAD file as values.

use std::sync::Arc;

use super::cx::{Cx, Stop};
use super::imports::File;
use super::stages::each_member;
use super::syntax::ast::Keyword;
use super::units::{self, MILLIMETRE};
use super::value::{ModuleId, Record, Value};
use crate::base::bbox::Box3;
use crate::base::tolerance::Tolerance;
use crate::io::cad::part::{Group, Options, Part};
use crate::io::{iges, step};
use crate::network::Chain;
use crate::surface::Surface;

impl Cx<'_> {
    /// An IGES file.
    pub(super) fn iges(&mut self, file: &File, bytes: &[u8]) -> Result<Value, Stop> {
        let opened = iges::open(bytes, &self.cad_options(file)).map_err(|at| file.malformed(at))?;
        self.cad(file, opened.reach(), |tolerance| opened.part(tolerance))
    }

    /// A STEP file.
    pub(super) fn step_file(&mut self, file: &File, bytes: &[u8]) -> Result<Value, Stop> {
        let opened = step::open(bytes, &self.cad_options(file)).map_err(|at| file.malformed(at))?;
        self.cad(file, opened.reach(), |tolerance| opened.part(tolerance))
    }

    fn cad_options(&self, file: &File) -> Options {
        let millimetres = |unit| units::convert(1.0, unit, MILLIMETRE, 1);
        Options { model: millimetres(self.unit), unit: self.unit.name, file: file.unit.map(millimetres), origin: file.origin }
    }

    /// Lists in file order, then everything once more by its name in the file.
    fn cad(&mut self, file: &File, reach: Box3, make: impl FnOnce(Tolerance) -> Part) -> Result<Value, Stop> {
        if !reach.is_empty() {
            self.seen([reach.min, reach.max]);
        }
        let tolerance = self.tolerance()?;
        let mut part = make(tolerance);
        self.steps(part.points.len() + part.curves.len() + part.surfaces.len())?;
        let mut warnings = std::mem::take(&mut part.warnings);
        warnings.append(&mut part.build(file.origin, &tolerance));
        self.repaired(file, warnings);
        Ok(self.part(&part))
    }

    fn part(&mut self, part: &Part) -> Value {
        let row = |points: &[glam::DVec3]| match points {
            [one] => Value::point(*one),
            row => Value::list(row.iter().map(|p| Value::point(*p)).collect()),
        };
        let all: Vec<Value> = part.points.iter().flat_map(|row| &row.value).map(|p| Value::point(*p)).collect();
        let points: Vec<Value> = part.points.iter().map(|item| row(&item.value)).collect();
        let curves: Vec<Value> = part.curves.iter().map(|item| Value::Curve(Chain::of_curve(&item.value))).collect();
        // A face is one surface, or none, or a list of several.
        let faces = |list: &[Surface]| list.iter().cloned().map(Value::Surface).collect::<Vec<Value>>();
        let pick = |list: &[Value], places: &[usize]| Value::list(places.iter().filter_map(|k| list.get(*k)).cloned().collect());
        let pick_faces = |places: &[usize]| Value::list(places.iter().filter_map(|k| part.built.get(*k)).flat_map(|f| faces(f)).collect());
        let mut record_of = |group: &Group, color: Option<[f64; 3]>| {
            let mut fields = vec![
                ("name", Value::text(&group.name)),
                ("points", pick(&points, &group.points)),
                ("curves", pick(&curves, &group.curves)),
                ("surfaces", pick_faces(&group.surfaces)),
            ];
            if let Some(rgb) = color {
                fields.push(("rgb", Value::list(rgb.map(Value::number).to_vec())));
            }
            self.record(fields)
        };
        let groups: Vec<Value> = part.groups.iter().map(|group| record_of(group, None)).collect();
        let shells: Vec<Value> = part.shells.iter().map(|group| record_of(group, None)).collect();
        let solids: Vec<Value> = part.solids.iter().map(|group| record_of(group, None)).collect();
        let colors: Vec<Value> = part.colors.iter().map(|(group, rgb)| record_of(group, Some(*rgb))).collect();
        let names = part.points.iter().map(|i| &i.name).zip(&points);
        let names = names.chain(part.curves.iter().map(|i| &i.name).zip(&curves));
        let of_face = |list: &Vec<Surface>| match faces(list) {
            one if one.len() == 1 => one.into_iter().next(),
            several => (!several.is_empty()).then(|| Value::list(several)),
        };
        let surfaces: Vec<Value> = part.built.iter().map(|list| of_face(list).unwrap_or(Value::None)).collect();
        let names = names.chain(part.surfaces.iter().map(|i| &i.name).zip(&surfaces));
        let names = names.chain(part.groups.iter().map(|g| &g.name).zip(&groups));
        let lists = [
            ("points", Value::list(all)),
            ("curves", Value::list(curves.clone())),
            ("surfaces", Value::list(part.built.iter().flat_map(|f| faces(f)).collect())),
            ("groups", Value::list(groups.clone())),
            ("shells", Value::list(shells)),
            ("solids", Value::list(solids)),
            ("colors", Value::list(colors)),
        ];
        let named = names.filter(|(_, value)| !matches!(value, Value::None)).map(|(name, value)| (name.as_str(), value.clone()));
        let fields: Vec<(&str, Value)> = lists.into_iter().chain(named).collect();
        let (keys, values) = fields.into_iter().map(|(key, value)| (self.names.intern(key), value)).unzip();
        Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false }))
    }
}

/// Red, green and blue of each colour of the imported files of a script, with the curves and surfaces that have it.
pub(super) fn colors(cx: &Cx, module: ModuleId) -> Vec<([f64; 3], Vec<Value>)> {
    let list = |record: &Record, key: &str| match cx.names.find(key).and_then(|key| record.get(key)) {
        Some(Value::List(items)) => items.to_vec(),
        _ => Vec::new(),
    };
    let mut found = Vec::new();
    each_member(cx.machine.at(module), &cx.names, &[Keyword::Import], &mut |_, _, _, _, value| {
        let Value::Record(part) = value else { return };
        for group in list(part, "colors") {
            let Value::Record(group) = group else { continue };
            let rgb: Vec<f64> =
                list(&group, "rgb").iter().filter_map(|x| if let Value::Number(x) = x { Some(x.value) } else { None }).collect();
            if let [red, green, blue] = rgb[..] {
                found.push(([red, green, blue], [list(&group, "curves"), list(&group, "surfaces")].concat()));
            }
        }
    });
    found
}
