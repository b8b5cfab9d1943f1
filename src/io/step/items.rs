//! Items of representations as points, curves and faces, in the frame of their representation.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::job;
use crate::geometry::Curve;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face::Face;
use crate::io::step::parameters::Row;
use crate::io::step::reader::{NESTED, Step};

/// What groups of faces are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BundleKind {
    /// A solid, with its shells behind it.
    Solid,
    /// A shell of a solid.
    Skin,
    /// A shell by itself.
    Shell,
    /// Points and curves.
    Set,
}

/// Things of an item that belong together, as ranges of the lists of [`Item`].
#[derive(Clone, Debug)]
pub struct Bundle {
    /// What it is.
    pub sort: BundleKind,
    /// Its entity.
    pub entity: u32,
    /// The model whose only shell it is.
    pub model: Option<u32>,
    /// First and last point, curve and face, the latter not included.
    pub ranges: [(usize, usize); 3],
}

/// What an item is made of, each with the entity it stands for.
#[derive(Clone, Debug, Default)]
pub struct Item {
    /// Points.
    pub points: Vec<(u32, DVec3)>,
    /// Curves.
    pub curves: Vec<(u32, Curve)>,
    /// Faces with the shell that has them.
    pub faces: Vec<(u32, Face, Option<u32>)>,
    /// What belongs together.
    pub bundles: Vec<Bundle>,
}

impl Item {
    fn now(&self) -> [usize; 3] {
        [self.points.len(), self.curves.len(), self.faces.len()]
    }

    fn bundle(&mut self, sort: BundleKind, entity: u32, from: [usize; 3]) {
        let to = self.now();
        self.bundles.push(Bundle { sort, entity, model: None, ranges: std::array::from_fn(|k| (from[k], to[k])) });
    }

    /// Control points and pieces of borders: what a copy costs.
    pub fn weight(&self) -> usize {
        let face = |f: &Face| 8 + f.outer.iter().chain(&f.holes).map(Vec::len).sum::<usize>();
        self.points.len() + self.curves.len() + self.faces.iter().map(|(_, f, _)| face(f)).sum::<usize>()
    }
}

/// Entities of representations that show nothing.
const SILENT: &[&[u8]] = &[
    b"AXIS1_PLACEMENT",
    b"AXIS2_PLACEMENT_2D",
    b"AXIS2_PLACEMENT_3D",
    b"CARTESIAN_POINT",
    b"DIRECTION",
    b"VECTOR",
    b"DESCRIPTIVE_REPRESENTATION_ITEM",
    b"MEASURE_REPRESENTATION_ITEM",
    b"STYLED_ITEM",
    b"OVER_RIDING_STYLED_ITEM",
];

/// Kinds of things that are not read, with how often they stand in the file and where first.
pub type Unread = BTreeMap<String, (u32, usize)>;

impl<'f> Step<'f> {
    /// What an item is made of; what cannot be read is left out with a warning.
    pub fn item(&mut self, k: u32, unread: &mut Unread) -> Item {
        let mut item = Item::default();
        if let Err(Defect(why)) = self.add(k, &mut item, unread, 0) {
            self.left_out(k, why);
        }
        item
    }

    /// Leaves out an item; faces and what holds them are counted.
    fn left_out(&mut self, k: u32, why: String) {
        const FACES: [&[u8]; 4] = [b"FACE", b"SURFACE", b"SHELL", b"BREP"];
        let holds = |name: &[u8]| FACES.iter().any(|word| name.windows(word.len()).any(|w| w == *word));
        if self.file.names(k).any(holds) {
            self.unusable(k, why);
        } else {
            self.warn(k, format!("skipped: {why}"));
        }
    }

    fn add(&mut self, k: u32, item: &mut Item, unread: &mut Unread, depth: usize) -> Result<(), Defect> {
        if depth > NESTED {
            return Err(defect("items are nested too deep, or are made of themselves"));
        }
        let file = self.file;
        let row = file.parameters(k);
        let from = item.now();
        match file.name(k) {
            b"MANIFOLD_SOLID_BREP" | b"FACETED_BREP" | b"BREP_WITH_VOIDS" => self.solid(k, item),
            _ if file.under(k, b"MANIFOLD_SOLID_BREP").is_some() => self.solid(k, item),
            b"SHELL_BASED_SURFACE_MODEL" | b"FACE_BASED_SURFACE_MODEL" => {
                let before = item.bundles.len();
                for shell in self.members(k, row.list(1)?) {
                    self.shell(shell, item, BundleKind::Shell);
                }
                match &mut item.bundles[before..] {
                    [one] => one.model = Some(k),
                    several => {
                        if several.len() > 1 && !row.text(0).trim().is_empty() {
                            item.bundle(BundleKind::Set, k, from);
                        }
                    }
                }
                Ok(())
            }
            b"OPEN_SHELL" | b"CLOSED_SHELL" | b"CONNECTED_FACE_SET" | b"ORIENTED_CLOSED_SHELL" | b"ORIENTED_OPEN_SHELL" => {
                self.shell(k, item, BundleKind::Shell);
                Ok(())
            }
            b"GEOMETRIC_SET" | b"GEOMETRIC_CURVE_SET" => {
                for member in self.members(k, row.list(1)?) {
                    if let Err(Defect(why)) = self.member(member, item, unread, depth + 1) {
                        self.left_out(member, why);
                    }
                }
                item.bundle(BundleKind::Set, k, from);
                Ok(())
            }
            b"EDGE_BASED_WIREFRAME_MODEL" | b"SHELL_BASED_WIREFRAME_MODEL" => {
                for set in row.entities(1)? {
                    for edge in self.file.parameters(set).entities(1)? {
                        self.member(edge, item, unread, depth + 1)?;
                    }
                }
                item.bundle(BundleKind::Set, k, from);
                Ok(())
            }
            name if SILENT.contains(&name) => Ok(()),
            _ => self.member(k, item, unread, depth),
        }
    }

    /// A point, curve, surface or face.
    fn member(&mut self, k: u32, item: &mut Item, unread: &mut Unread, depth: usize) -> Result<(), Defect> {
        let name = self.file.name(k);
        let ends = |word: &[u8]| self.file.names(k).any(|n| n.ends_with(word));
        match name {
            b"CARTESIAN_POINT" => {
                let p = self.point(k)?;
                item.points.push((k, p));
            }
            b"VERTEX_POINT" => {
                let p = self.vertex(k)?;
                item.points.push((k, p));
            }
            b"EDGE_CURVE" => {
                let curve = self.edge(k)?;
                item.curves.push((k, curve));
            }
            b"ORIENTED_EDGE" => return self.member(self.file.parameters(k).entity(3)?, item, unread, depth),
            b"GEOMETRIC_SET" | b"GEOMETRIC_CURVE_SET" => return self.add(k, item, unread, depth + 1),
            b"ADVANCED_FACE" | b"FACE_SURFACE" | b"ORIENTED_FACE" => {
                let face = self.face(k, false)?;
                item.faces.push((k, face, None));
            }
            b"LINE" | b"CIRCLE" | b"ELLIPSE" | b"HYPERBOLA" | b"PARABOLA" | b"POLYLINE" => {
                let curve = self.bounded(k, 0)?;
                item.curves.push((k, curve));
            }
            _ if ends(b"_CURVE") || ends(b"_CURVE_WITH_KNOTS") || name.starts_with(b"OFFSET_CURVE") => {
                let curve = self.bounded(k, 0)?;
                item.curves.push((k, curve));
            }
            _ if ends(b"_SURFACE") || ends(b"_SURFACE_WITH_KNOTS") || name.starts_with(b"SURFACE_OF_") || name == b"PLANE" => {
                let face = self.sheet(k, 0)?;
                item.faces.push((k, face, None));
            }
            _ => {
                let word = String::from_utf8_lossy(name).into_owned();
                unread.entry(word).or_insert((k, 0)).1 += 1;
            }
        }
        Ok(())
    }

    /// A solid: its outer shell, then its voids.
    fn solid(&mut self, k: u32, item: &mut Item) -> Result<(), Defect> {
        let from = item.now();
        let place = item.bundles.len();
        let file = self.file;
        let (outer, voids) = if file.is_complex(k) {
            let outer = file.under(k, b"MANIFOLD_SOLID_BREP").ok_or_else(|| defect("it has no shell"))?.entity(0)?;
            (outer, file.under(k, b"BREP_WITH_VOIDS").map_or(Ok(Vec::new()), |r| r.entities(0))?)
        } else {
            let row = file.parameters(k);
            (row.entity(1)?, if file.name(k) == b"BREP_WITH_VOIDS" { row.entities(2)? } else { Vec::new() })
        };
        for shell in std::iter::once(outer).chain(voids) {
            self.shell(shell, item, BundleKind::Skin);
        }
        item.bundle(BundleKind::Solid, k, from);
        // The solid stands before its shells.
        item.bundles[place..].rotate_right(1);
        Ok(())
    }

    /// The entities of a list; what is none is said and left out.
    fn members(&mut self, of: u32, list: Row<'_>) -> Vec<u32> {
        let mut members = Vec::new();
        for value in list.values() {
            match value.entity() {
                Ok(k) => members.push(k),
                Err(Defect(why)) => self.warn(of, format!("skipped: one of its members: {why}")),
            }
        }
        members
    }

    fn shell(&mut self, k: u32, item: &mut Item, sort: BundleKind) {
        let from = item.now();
        match self.faces_of(k) {
            Ok((shell, faces, turned)) => {
                for face in self.members(shell, faces) {
                    job::poll();
                    match self.face(face, turned) {
                        Ok(made) => item.faces.push((face, made, Some(shell))),
                        Err(Defect(why)) => self.unusable(face, why),
                    }
                }
                item.bundle(sort, shell, from);
            }
            Err(Defect(why)) => self.unusable(k, why),
        }
    }

    /// The shell that has the faces, the faces, and whether they look the other way.
    fn faces_of(&self, k: u32) -> Result<(u32, Row<'f>, bool), Defect> {
        let (mut k, mut turned) = (k, false);
        for _ in 0..NESTED {
            let row = self.file.parameters(k);
            match self.file.name(k) {
                b"ORIENTED_CLOSED_SHELL" | b"ORIENTED_OPEN_SHELL" => {
                    turned ^= !row.flag(3, true);
                    k = row.entity(2)?;
                }
                b"OPEN_SHELL" | b"CLOSED_SHELL" | b"CONNECTED_FACE_SET" => return Ok((k, row.list(1)?, turned)),
                _ => return Err(defect(format!("{} is not a shell", self.label(k)))),
            }
        }
        Err(defect("shells are made of themselves"))
    }
}
