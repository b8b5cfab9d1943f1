//! `import "part.igs" as part`, `import "part.step" as part`: points, curves, surfaces and groups of a CAD file as values.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use crate::base::bbox::Box3;
use crate::base::tolerance::Tolerance;
use crate::io::cad::healing::{Repair, Rule};
use crate::io::cad::part::{Group, Part, ReadOptions, Unusable};
use crate::io::files::fault::{ContentFault, Malformed, Share};
use crate::io::{iges, step};
use crate::lang::declare::imports::ImportedFile;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::stages::each_member;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::origins::{NO_MEMBER, OriginEntry};
use crate::lang::values::part::{Body, PartFile, PartValue, SurfaceProperties};
use crate::lang::values::units;
use crate::lang::values::units::MILLIMETRE;
use crate::lang::values::value::{ModuleId, Record, Value};
use crate::network::Chain;
use crate::surface::Surface;

/// Share of the area of a file that may be missing without an error.
const LITTLE: f64 = 0.5;

impl Cx<'_> {
    /// An IGES file.
    pub(crate) fn iges(&mut self, file: &ImportedFile, bytes: &[u8]) -> Result<Value, Halt> {
        let opened = iges::open(bytes, &self.cad_options(file)).map_err(|at| file.malformed(at))?;
        self.cad(file, opened.reach(), |tolerance| opened.part(tolerance))
    }

    /// A STEP file.
    pub(crate) fn step_file(&mut self, file: &ImportedFile, bytes: &[u8]) -> Result<Value, Halt> {
        let opened = step::open(bytes, &self.cad_options(file)).map_err(|at| file.malformed(at))?;
        self.cad(file, opened.reach(), |tolerance| opened.part(tolerance))
    }

    fn cad_options(&self, file: &ImportedFile) -> ReadOptions {
        let millimetres = |unit| units::convert(1.0, unit, MILLIMETRE, 1);
        ReadOptions {
            model: millimetres(self.program.unit),
            unit: self.program.unit.name,
            file: file.unit.map(millimetres),
            origin: file.origin,
        }
    }

    /// Lists in file order, then everything once more by its name in the file.
    fn cad(&mut self, file: &ImportedFile, reach: Box3, make: impl FnOnce(Tolerance) -> Part) -> Result<Value, Halt> {
        if !reach.is_empty() {
            self.seen([reach.min, reach.max]);
        }
        let tolerance = self.tolerance()?;
        let mut part = make(tolerance);
        self.steps(part.points.len() + part.curves.len() + part.surfaces.len())?;
        let mut warnings = std::mem::take(&mut part.warnings);
        warnings.append(&mut part.build(file.origin, &tolerance));
        if self.sink.whole {
            let told = |repair: &Repair| Malformed::line(repair.line, repair.in_words(part.model_unit));
            // What is as exact as the file says is nothing to warn of.
            warnings.extend(part.repairs.iter().filter(|repair| repair.rule != Rule::Accuracy).map(told));
        }
        if !file.incomplete {
            self.refuse_little(file, &part, &warnings)?;
        }
        let notes = warnings.clone();
        self.repaired(file, warnings);
        let value = self.part(file, &part, notes);
        if !part.unusable.is_empty() {
            let faces = part.unusable.iter().map(|face| Malformed::line(face.line, format!("{}: {}", face.entity, face.cause))).collect();
            let (path, total, share) = (file.path.to_owned(), part.n_faces(), part.share_missing());
            self.say(&ContentFault::Unusable { of: file.origin, path, total, faces, share, whole: self.sink.whole }.into());
        }
        let pairs = part.doubled(&tolerance);
        if !pairs.is_empty() {
            self.say(&ContentFault::Doubled { of: file.origin, path: file.path.to_owned(), pairs }.into());
        }
        Ok(value)
    }

    /// E815 for a file of which nothing came in, or less than half of its faces.
    fn refuse_little(&self, file: &ImportedFile, part: &Part, warnings: &[Malformed]) -> Result<(), Halt> {
        let came = part.built.iter().filter(|made| !made.is_empty()).count();
        let share = part.share_missing().map_or(0.0, |share| match share {
            Share::Stated(share) | Share::AtLeast(share) => share,
        });
        let is_nothing = came == 0 && part.points.is_empty() && part.curves.is_empty();
        let is_little = !part.unusable.is_empty() && (share > LITTLE || part.unusable.len() > came);
        if !is_nothing && !is_little {
            return Ok(());
        }
        let unusable = part.unusable.iter().map(|face| Malformed::line(face.line, format!("{}: {}", face.entity, face.cause)));
        let unread = unusable.chain(warnings.iter().cloned()).collect();
        Err(ContentFault::Little { of: file.origin, path: file.path.to_owned(), faces: (came, part.n_faces()), unread }.into())
    }

    fn part(&mut self, file: &ImportedFile, part: &Part, notes: Vec<Malformed>) -> Value {
        let faces = NumberedFaces::of(self, file, part, notes);
        let row = |points: &[glam::DVec3]| match points {
            [one] => Value::point(*one),
            row => Value::list(row.iter().map(|p| Value::point(*p)).collect()),
        };
        let all: Vec<Value> = part.points.iter().flat_map(|row| &row.value).map(|p| Value::point(*p)).collect();
        let points: Vec<Value> = part.points.iter().map(|item| row(&item.value)).collect();
        let curves: Vec<Value> = part.curves.iter().map(|item| Value::Curve(Chain::of_curve(&item.value))).collect();
        let pick = |list: &[Value], places: &[usize]| Value::list(places.iter().filter_map(|k| list.get(*k)).cloned().collect());
        let mut record_of = |kind: &str, k: usize, group: &Group, color: Option<[f64; 3]>| {
            let own = faces.group(format!("{}.{kind}[{k}]", faces.name), &group.surfaces, kind);
            let mut fields = vec![
                ("name", Value::text(&group.name)),
                ("points", pick(&points, &group.points)),
                ("curves", pick(&curves, &group.curves)),
                ("surfaces", own.list()),
            ];
            fields.extend(color.map(|rgb| ("rgb", Value::list(rgb.map(Value::number).to_vec()))));
            self.record_of_part(fields, own)
        };
        let mut records_of = |kind: &str, groups: &[Group]| -> Vec<Value> {
            groups.iter().enumerate().map(|(k, group)| record_of(kind, k, group, None)).collect()
        };
        let groups = records_of("groups", &part.groups);
        let shells = records_of("shells", &part.shells);
        let solids = records_of("solids", &part.solids);
        let colors = part.colors.iter().enumerate().map(|(k, (group, rgb))| record_of("colors", k, group, Some(*rgb))).collect();
        let names = part.points.iter().map(|i| &i.name).zip(&points);
        let names = names.chain(part.curves.iter().map(|i| &i.name).zip(&curves));
        let surfaces: Vec<Value> = faces.places.iter().map(|places| faces.value(places)).collect();
        let names = names.chain(part.surfaces.iter().map(|i| &i.name).zip(&surfaces));
        let names = names.chain(part.groups.iter().map(|g| &g.name).zip(&groups));
        let lists = [
            ("points", Value::list(all)),
            ("curves", Value::list(curves.clone())),
            ("surfaces", Value::list(faces.all.iter().cloned().map(Value::Surface).collect())),
            ("groups", Value::list(groups.clone())),
            ("shells", Value::list(shells)),
            ("solids", Value::list(solids)),
            ("colors", Value::list(colors)),
        ];
        let named = names.filter(|(_, value)| !matches!(value, Value::None)).map(|(name, value)| (name.as_str(), value.clone()));
        let fields: Vec<(&str, Value)> = lists.into_iter().chain(named).collect();
        self.record_of_part(fields, faces.whole(part))
    }

    fn record_of_part(&mut self, fields: Vec<(&str, Value)>, part: PartValue) -> Value {
        let (keys, values) = fields.into_iter().map(|(key, value)| (self.program.names.intern(key), value)).unzip::<_, _, Vec<_>, Vec<_>>();
        Value::Record(Arc::new(Record { keys: Arc::new(keys), values, row: false, part: Some(Arc::new(part)) }))
    }
}

/// The surfaces made of a part, numbered one after the other.
struct NumberedFaces {
    /// The script's name for the part.
    name: String,
    file: Arc<PartFile>,
    /// All of them, each with an origin of its own.
    all: Vec<Surface>,
    /// For each face of the file those made of it.
    places: Vec<Range<usize>>,
    /// Of each solid of the file what was made of its faces.
    solids: Vec<Vec<usize>>,
    /// Faces of which none was made, by their place.
    unusable: Vec<(Option<usize>, Unusable)>,
}

impl NumberedFaces {
    fn of(cx: &mut Cx, file: &ImportedFile, part: &Part, notes: Vec<Malformed>) -> Self {
        let (mut all, mut places, mut said) = (Vec::new(), Vec::new(), Vec::new());
        let mut colors: Vec<Option<&str>> = vec![None; part.surfaces.len()];
        for (group, _) in &part.colors {
            group.surfaces.iter().for_each(|k| colors[*k] = Some(&group.name));
        }
        let mut layers: Vec<Vec<Arc<str>>> = vec![Vec::new(); part.surfaces.len()];
        for layer in &part.layers {
            let name: Arc<str> = layer.own.as_ref().unwrap_or(&layer.name).as_str().into();
            layer.surfaces.iter().for_each(|k| layers[*k].push(name.clone()));
        }
        let place = cx.program.origins.place(file.origin);
        for (k, ((item, built), (color, layers))) in part.surfaces.iter().zip(&part.built).zip(colors.into_iter().zip(layers)).enumerate() {
            let first = all.len();
            for surface in built {
                let member = [all.len() as u32, NO_MEMBER];
                let origin = place.map_or(file.origin, |place| cx.program.origins.add(OriginEntry { member, ..place }));
                all.push(surface.with_origin(origin));
                let color = color.zip(item.color).map(|(name, rgb)| (name.into(), rgb));
                said.push(SurfaceProperties {
                    name: item.name.as_str().into(),
                    own: item.own.as_deref().map(Arc::from),
                    layers: layers.clone(),
                    color,
                    entity: format!("{}{}", part.mark, item.id).into(),
                    node: part.standing.get(k).copied().flatten(),
                });
            }
            places.push(first..all.len());
        }
        let name = place.map_or_else(String::new, |place| cx.declaration_name(place.module, place.declaration));
        let unusable: Vec<(Option<usize>, Unusable)> = part.unusable.iter().map(|face| (face.face, face.clone())).collect();
        let mut bodies = BTreeMap::new();
        for (kind, list) in [("solids", &part.solids), ("shells", &part.shells)] {
            for (k, group) in list.iter().enumerate() {
                let names = group.own.as_deref().map(|own| [own.into(), group.name.as_str().into()]);
                bodies.extend(names.map(|names| (format!("{name}.{kind}[{k}]").into(), names)));
            }
        }
        let file = PartFile {
            path: file.path.into(),
            origin: place.map_or(file.origin, |place| cx.program.origins.add(OriginEntry { member: [NO_MEMBER; 2], expr: None, ..place })),
            module: cx.module(),
            said,
            bodies,
            tree: part.tree.clone(),
            total: part.n_faces(),
            repairs: part.repairs.clone(),
            notes,
        };
        let mut faces = Self { name, file: Arc::new(file), all, places, solids: Vec::new(), unusable };
        faces.solids = part.solids.iter().map(|group| faces.flat(&group.surfaces)).collect();
        faces
    }

    /// What was made of one face: a surface, several, or nothing.
    fn value(&self, places: &Range<usize>) -> Value {
        let mut made: Vec<Value> = self.all[places.clone()].iter().cloned().map(Value::Surface).collect();
        match made.len() {
            0 => Value::None,
            1 => made.swap_remove(0),
            _ => Value::list(made),
        }
    }

    /// Places of surfaces made of faces of the file.
    fn flat(&self, faces: &[usize]) -> Vec<usize> {
        faces.iter().filter_map(|k| self.places.get(*k)).cloned().flatten().collect()
    }

    /// A body or group; its own faces are numbered anew.
    fn group(&self, name: String, faces: &[usize], kind: &str) -> PartValue {
        let flat = self.flat(faces);
        let name: Arc<str> = name.into();
        let is_body = matches!(kind, "solids" | "shells") && !flat.is_empty();
        let bodies = if is_body {
            vec![Body { name: name.clone(), faces: (0..flat.len()).collect(), solid: kind == "solids" }]
        } else if kind == "shells" {
            Vec::new()
        } else {
            self.solids_in(&flat)
        };
        // Of one that came to nothing when it was read nobody knows where it belongs.
        let unusable = self.unusable.iter().filter(|(face, _)| face.is_none_or(|k| faces.contains(&k)));
        PartValue {
            name,
            file: self.file.clone(),
            faces: flat.iter().map(|k| self.all[*k].clone()).collect(),
            bodies,
            unusable: unusable.map(|(_, face)| face.clone()).collect(),
        }
    }

    /// Solids of which all faces are among some, by the places of their faces there; of solids with a face in common the first.
    fn solids_in(&self, flat: &[usize]) -> Vec<Body> {
        let mut places: BTreeMap<usize, usize> = flat.iter().enumerate().map(|(place, face)| (*face, place)).collect();
        let mut bodies = Vec::new();
        for (k, solid) in self.solids.iter().enumerate().filter(|(_, solid)| !solid.is_empty()) {
            let own: Option<Vec<usize>> = solid.iter().map(|face| places.get(face).copied()).collect();
            if let Some(faces) = own {
                for face in solid {
                    places.remove(face);
                }
                bodies.push(Body { name: format!("{}.solids[{k}]", self.name).into(), faces, solid: true });
            }
        }
        bodies
    }

    /// All of it: solids, then shells that belong to none.
    fn whole(&self, part: &Part) -> PartValue {
        let mut taken = vec![false; self.all.len()];
        let mut bodies = Vec::new();
        let solids = part.solids.iter().enumerate().map(|(k, group)| (k, group, true));
        let shells = part.shells.iter().enumerate().map(|(k, group)| (k, group, false));
        for (k, group, solid) in solids.chain(shells) {
            let faces: Vec<usize> = self.flat(&group.surfaces);
            if faces.is_empty() || faces.iter().any(|face| taken[*face]) {
                continue;
            }
            faces.iter().for_each(|face| taken[*face] = true);
            let name = format!("{}.{}[{k}]", self.name, if solid { "solids" } else { "shells" }).into();
            bodies.push(Body { name, faces, solid });
        }
        PartValue {
            name: self.name.as_str().into(),
            file: self.file.clone(),
            faces: self.all.clone(),
            bodies,
            unusable: self.unusable.iter().map(|(_, face)| face.clone()).collect(),
        }
    }
}

impl Cx<'_> {
    /// Red, green and blue of each colour of the imported files of a script, with the curves and surfaces that have it.
    pub fn colors(&self, module: ModuleId) -> Vec<([f64; 3], Vec<Value>)> {
        let list = |record: &Record, key: &str| match self.program.names.find(key).and_then(|key| record.get(key)) {
            Some(Value::List(items)) => items.to_vec(),
            _ => Vec::new(),
        };
        let mut found = Vec::new();
        each_member(self.machine.at(module), &self.program.names, &[Keyword::Import], &mut |_, _, _, _, value| {
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
}
