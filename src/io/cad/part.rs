//! What a CAD file offers: points, curves, surfaces and groups by name.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::origin::Origin;
use crate::geometry::Curve;
use crate::io::cad::assembly::Node;
use crate::io::cad::face::Face;
use crate::io::cad::healing::{Off, Repair};
use crate::io::files::fault::Malformed;
use crate::surface::Surface;

/// What a reader needs to know of the model.
#[derive(Clone, Copy, Debug)]
pub struct ReadOptions {
    /// Millimetres in the model's unit.
    pub model: f64,
    /// Name of the model's unit, for messages.
    pub unit: &'static str,
    /// Millimetres in the file's unit, where the import says it; else the file does.
    pub file: Option<f64>,
    /// The import.
    pub origin: Origin,
}

/// Names that the lists of a part have themselves.
const RESERVED: &[&str] = &[
    "points",
    "curves",
    "surfaces",
    "groups",
    "shells",
    "solids",
    "colors",
    "unit",
    "name",
    "faces",
    "area",
    "volume",
    "bbox",
    "centroid",
    "planes",
    "cylinders",
    "cones",
    "spheres",
    "tori",
    "others",
];

/// Names given so far, and how often each was wanted.
#[derive(Clone, Debug)]
pub struct UniqueNames(BTreeMap<String, usize>);

impl Default for UniqueNames {
    fn default() -> Self {
        Self(RESERVED.iter().map(|n| ((*n).to_owned(), 1)).collect())
    }
}

impl UniqueNames {
    /// The wanted name, with a number where it is taken.
    pub fn give(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_owned();
        while let Some(times) = self.0.get_mut(&name) {
            *times += 1;
            name = format!("{wanted}_{times}");
        }
        self.0.insert(name.clone(), 1);
        name
    }
}

/// Something of the file under its name.
#[derive(Clone, Debug)]
pub struct Imported<T> {
    /// The file's name for it, or its kind and number (`curve3`); no two of a file are the same.
    pub name: String,
    /// The name as the file has it, where it has one.
    pub own: Option<String>,
    /// Red, green and blue from 0 to 1, where the file gives it a colour.
    pub color: Option<[f64; 3]>,
    /// Its number in the file.
    pub id: u64,
    /// Line of the file where it stands.
    pub line: u64,
    /// The thing.
    pub value: T,
}

/// Things under one name, as indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// The file's name for it, or `group` and its number.
    pub name: String,
    /// The name as the file has it, where it has one.
    pub own: Option<String>,
    /// Of [`Part::points`].
    pub points: Vec<usize>,
    /// Of [`Part::curves`].
    pub curves: Vec<usize>,
    /// Of [`Part::surfaces`].
    pub surfaces: Vec<usize>,
}

/// What a file states of some of its faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Stated {
    /// Of [`Part::surfaces`].
    pub surfaces: Vec<usize>,
    /// How many copies of the same thing they are.
    pub copies: usize,
    /// What it states of one copy, model units.
    pub figure: Figure,
    /// What it is of, for messages.
    pub name: String,
    /// Line of the file where it stands.
    pub line: u64,
}

/// A figure by which a file can be checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Figure {
    /// Area of all faces.
    Area(f64),
    /// Volume inside them.
    Volume(f64),
    /// Centre of the volume; of the faces where there is none.
    Centroid(DVec3),
}

/// A face of the file of which there is no surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Unusable {
    /// Of [`Part::surfaces`], where it came as far.
    pub face: Option<usize>,
    /// Its name and number: `roof at #36`.
    pub entity: String,
    /// Line of the file where it stands.
    pub line: u64,
    /// Why, in words.
    pub cause: String,
    /// What its loops span at least, where they could be read, square model units.
    pub least_area: f64,
}

/// What a CAD file holds, in file order and model units.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Points, one each, or rows of them.
    pub points: Vec<Imported<Vec<DVec3>>>,
    /// Curves.
    pub curves: Vec<Imported<Curve>>,
    /// Surfaces, trimmed or whole.
    pub surfaces: Vec<Imported<Face>>,
    /// What [`Part::build`] made of them: one each, several where a face has several outer loops; none where it could not.
    pub built: Vec<Vec<Surface>>,
    /// Groups, shells and solids.
    pub groups: Vec<Group>,
    /// Shells, those of solids too.
    pub shells: Vec<Group>,
    /// Solids.
    pub solids: Vec<Group>,
    /// Layers, by the names that the file has for them.
    pub layers: Vec<Group>,
    /// Products at their places, where the file is an assembly.
    pub tree: Vec<Node>,
    /// The node of each of [`Part::surfaces`], where there is a tree.
    pub standing: Vec<Option<usize>>,
    /// What has the same colour, with red, green and blue from 0 to 1.
    pub colors: Vec<(Group, [f64; 3])>,
    /// What the file states of its parts, to be compared.
    pub stated: Vec<Stated>,
    /// What was repaired, face by face.
    pub repairs: Vec<Repair>,
    /// Faces of which nothing could be made; complete after [`Part::build`].
    pub unusable: Vec<Unusable>,
    /// What stands before the number of an entity in messages: `D` or `#`.
    pub mark: &'static str,
    /// The file's unit.
    pub unit: &'static str,
    /// The model's unit.
    pub model_unit: &'static str,
    /// What was repaired or skipped, by line.
    pub warnings: Vec<Malformed>,
}

/// Where something of the file stands in the part.
#[derive(Clone, Copy, Debug)]
pub enum PartPlace {
    /// In [`Part::points`].
    Point(usize),
    /// In [`Part::curves`].
    Curve(usize),
    /// In [`Part::surfaces`].
    Surface(usize),
}

impl Part {
    /// How many faces the file has, those included of which nothing could be made.
    pub fn n_faces(&self) -> usize {
        self.surfaces.len() + self.unusable.iter().filter(|face| face.face.is_none()).count()
    }

    /// Makes groups of the layers that the file has names for.
    pub fn group_layers(&mut self, names: &mut UniqueNames) {
        for layer in self.layers.iter().filter(|layer| layer.own.is_some() && !layer.is_empty()) {
            self.groups.push(Group { name: names.give(&layer.name), ..layer.clone() });
        }
    }
}

impl Group {
    /// Adds a member.
    pub fn put(&mut self, member: PartPlace) {
        match member {
            PartPlace::Point(k) => self.points.push(k),
            PartPlace::Curve(k) => self.curves.push(k),
            PartPlace::Surface(k) => self.surfaces.push(k),
        }
    }

    /// All members.
    pub fn members(&self) -> Vec<PartPlace> {
        let points = self.points.iter().map(|k| PartPlace::Point(*k));
        let curves = self.curves.iter().map(|k| PartPlace::Curve(*k));
        points.chain(curves).chain(self.surfaces.iter().map(|k| PartPlace::Surface(*k))).collect()
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.curves.is_empty() && self.surfaces.is_empty()
    }
}

/// Places of colours among [`Part::colors`].
#[derive(Clone, Debug, Default)]
pub struct Shades(BTreeMap<[u64; 3], usize>);

impl Shades {
    /// The group of a colour, made when it is new.
    pub fn group<'p>(&mut self, colors: &'p mut Vec<(Group, [f64; 3])>, rgb: [f64; 3], name: &str) -> &'p mut Group {
        let n = colors.len();
        let k = *self.0.entry(rgb.map(f64::to_bits)).or_insert(n);
        if k == n {
            let name = if name.is_empty() { format!("color{}", n + 1) } else { name.to_owned() };
            colors.push((Group { name, ..Group::default() }, rgb));
        }
        &mut colors[k].0
    }
}

impl Part {
    /// Lists the faces that are off by more than the slack of the file; gives the worst and how many others there are.
    pub fn list_repairs(&mut self, slack: f64, name: impl Fn(&Imported<Face>) -> String) -> Option<(Repair, usize)> {
        for (face, item) in self.surfaces.iter().enumerate().filter(|(_, item)| item.value.off.distance > slack) {
            let Off { distance, place, rule } = item.value.off;
            self.repairs.push(Repair { rule, face, entity: name(item), line: item.line, distance, place });
        }
        let worst = self.repairs.iter().max_by(|a, b| a.distance.total_cmp(&b.distance));
        worst.map(|worst| (worst.clone(), self.repairs.len() - 1))
    }
}
