//! What a file offers: points, curves, surfaces and groups by name.
//!
//! Offered is what can be seen and is not only a part of something else. A shell offers its faces and is a group of them.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::Tolerance;
use crate::base::{job, limits};
use crate::geometry::Motion;
use crate::io::cad::base_surface::Base;
use crate::io::cad::defect::Defect;
use crate::io::cad::face::Face;
use crate::io::cad::face_loops::FaceLoops;
use crate::io::cad::part::{Group, Imported, Part, PartPlace as ItemPlace, Shades, UniqueNames, Unusable};
use crate::io::files::fault::Malformed;
use crate::io::iges::curves::CurveRequest;
use crate::io::iges::entity_data::{Data, Pointer};
use crate::io::iges::entity_table::{EntityTable, NESTED};
use crate::io::iges::levels::Levels;
use crate::io::iges::open::OpenedIges;

/// Kinds of entities that hold faces.
const FACES: &[u32] = &[184, 186, 308, 408, 430, 510, 514];
/// Kinds of entities that hold faces and are not read: solids by form, swept and combined ones, arrays, instances in networks.
const UNREAD: &[u32] = &[150, 152, 154, 156, 158, 160, 162, 164, 168, 180, 182, 412, 414, 420];
/// Kinds of entities that surfaces are.
const SURFACES: &[u32] = &[108, 114, 118, 120, 122, 128, 140, 143, 144, 190, 192, 194, 196, 198];
/// Kinds of entities that curves are.
const CURVES: &[u32] = &[100, 102, 104, 110, 112, 126, 130];
/// Purposes of what is a part of the model: geometry, other, construction.
const PURPOSES: &[u8] = &[0, 3, 6];
/// Colours by number, from 1.
const COLORS: [([f64; 3], &str); 8] = [
    ([0.0, 0.0, 0.0], "black"),
    ([1.0, 0.0, 0.0], "red"),
    ([0.0, 1.0, 0.0], "green"),
    ([0.0, 0.0, 1.0], "blue"),
    ([1.0, 1.0, 0.0], "yellow"),
    ([1.0, 0.0, 1.0], "magenta"),
    ([0.0, 1.0, 1.0], "cyan"),
    ([1.0, 1.0, 1.0], "white"),
];

impl OpenedIges {
    /// Makes curves and surfaces of the entities.
    pub fn part(mut self, tolerance: Tolerance) -> Part {
        self.table.tolerance = tolerance;
        let part = Part { unit: self.table.unit, model_unit: self.table.model_unit, mark: "D", ..Part::default() };
        IgesPartBuilder {
            table: self.table,
            part,
            made: BTreeMap::new(),
            names: UniqueNames::default(),
            shades: Shades::default(),
            levels: Levels::default(),
            at: None,
            node: None,
            faces: BTreeMap::new(),
            instances: BTreeMap::new(),
            definitions: BTreeMap::new(),
            full: false,
        }
        .run()
    }
}

/// A part while it is made.
pub(super) struct IgesPartBuilder {
    pub(super) table: EntityTable,
    pub(super) part: Part,
    pub(super) made: BTreeMap<Pointer, ItemPlace>,
    pub(super) names: UniqueNames,
    pub(super) shades: Shades,
    pub(super) levels: Levels,
    /// From the frame of what is made now to that of the model, inside an instance.
    pub(super) at: Option<Motion>,
    /// The place of the product that it is of.
    pub(super) node: Option<usize>,
    /// Faces that instances place.
    pub(super) faces: BTreeMap<Pointer, Result<Face, Defect>>,
    /// What instances hold.
    pub(super) instances: BTreeMap<Pointer, Group>,
    /// The first node of each definition.
    pub(super) definitions: BTreeMap<Pointer, usize>,
    /// Whether there are more instances than a part may have.
    pub(super) full: bool,
}

impl IgesPartBuilder {
    fn run(mut self) -> Part {
        let (parts, members) = self.relations();
        let (mut groups, mut instances) = (Vec::new(), Vec::new());
        for k in 0..self.table.entries.len() {
            job::poll();
            let entry = &self.table.entries[k];
            let (d, status) = (entry.d, entry.status);
            // Faces and shells may be marked as parts although nothing has them.
            let is_bare = matches!(self.table.decoded[k].data, Data::Face { .. } | Data::Shell(_)) && !parts.contains(&d);
            let alone = !status.physically_dependent || members.contains(&d) || is_bare;
            if status.blanked || !PURPOSES.contains(&status.purpose) || !alone || parts.contains(&d) {
                continue;
            }
            if self.table.decoded[k].data.is_instance() { instances.push(d) } else { self.show(d, &mut groups) }
        }
        for d in instances {
            self.instance(d, 0);
        }
        for d in groups {
            self.group(d);
        }
        self.unplaced();
        self.unknown();
        self.gaps();
        self.part.layers = std::mem::take(&mut self.levels).layers(&self.table);
        self.part.group_layers(&mut self.names);
        self.part.warnings = std::mem::take(&mut self.table.warnings);
        self.part
    }

    /// Makes what an entity is; groups and solids come later.
    pub(super) fn show(&mut self, d: Pointer, groups: &mut Vec<Pointer>) {
        let Ok(k) = self.table.place(d) else { return };
        let kind = self.table.entries[k].kind;
        match &self.table.decoded[k].data {
            Data::Group(_) | Data::Shell(_) | Data::Solid { .. } => groups.push(d),
            Data::Damaged if SURFACES.contains(&kind) || FACES.contains(&kind) => {
                self.unusable(d, "its parameters cannot be read".to_owned());
            }
            Data::Unknown if UNREAD.contains(&kind) => self.unusable(d, format!("entities of type {kind} are not read")),
            Data::Damaged => {}
            Data::Point(p) => {
                let points = vec![*p];
                self.points(d, points);
            }
            Data::Points { points, is_line: false } => {
                let points = points.clone();
                self.points(d, points);
            }
            _ if CURVES.contains(&kind) || kind == 106 => self.curve(d),
            Data::Face { .. } => self.surface(d, false),
            _ if SURFACES.contains(&kind) => self.surface(d, false),
            _ => {}
        }
    }

    /// Surfaces that are only the ground of faces, faces of shells and shells of solids, and what visible groups hold.
    fn relations(&self) -> (BTreeSet<Pointer>, BTreeSet<Pointer>) {
        let (mut parts, mut members) = (self.table.placed_parts(), BTreeSet::new());
        for (entry, decoded) in self.table.entries.iter().zip(&self.table.decoded) {
            match &decoded.data {
                Data::Trimmed { surface, .. }
                | Data::Bounded { surface, .. }
                | Data::Face { surface, .. }
                | Data::OffsetSurface { base: surface, .. } => {
                    parts.insert(*surface);
                }
                Data::Shell(faces) => parts.extend(faces.iter().map(|(face, _)| *face)),
                Data::Solid { shells } => parts.extend(shells),
                Data::Group(list) if !entry.status.blanked => members.extend(list),
                _ => {}
            }
        }
        (parts, members)
    }

    fn points(&mut self, d: Pointer, points: Vec<DVec3>) {
        let matrix = match self.table.placement(self.table.entry(d).map_or(0, |e| e.transform)) {
            Ok(matrix) => matrix,
            Err(Defect(why)) => return self.skipped(d, &why),
        };
        let own = |p: DVec3| matrix.map_or(p * self.table.scale, |m| m.transform_point3(p * self.table.scale));
        let place = |p: DVec3| self.at.map_or(own(p), |at| at.point(own(p)));
        let value: Vec<DVec3> = points.into_iter().map(place).collect();
        if value.iter().any(|p| p.abs().max_element() > limits::COORDINATE) {
            return self.skipped(d, "its coordinates are too large");
        }
        self.made.insert(d, ItemPlace::Point(self.part.points.len()));
        let item = self.item(d, "point", self.part.points.len(), value);
        self.part.points.push(item);
    }

    fn curve(&mut self, d: Pointer) {
        match self.table.curve(d, CurveRequest::SPACE) {
            Ok(curve) if curve.length() <= self.table.tolerance.point => self.skipped(d, "it is shorter than the tolerance"),
            Ok(curve) => {
                let curve = self.at.map_or(curve.clone(), |at| curve.moved(&at));
                self.made.insert(d, ItemPlace::Curve(self.part.curves.len()));
                let item = self.item(d, "curve", self.part.curves.len(), curve);
                self.part.curves.push(item);
            }
            Err(Defect(why)) => self.skipped(d, &why),
        }
    }

    fn surface(&mut self, d: Pointer, flipped: bool) {
        let is_face = matches!(
            self.table.data(d),
            Ok(Data::Trimmed { .. } | Data::Bounded { .. } | Data::Face { .. } | Data::Plane { border: 1.., .. })
        );
        let mut make = || if is_face { self.table.face(d) } else { self.table.whole(d) };
        let made = match &self.at {
            Some(at) => self.faces.entry(d).or_insert_with(make).as_ref().map(|face| (face.moved(at), at.mirrors())).map_err(Clone::clone),
            None => make().map(|face| (face, false)),
        };
        match made {
            Ok((mut face, mirrored)) => {
                face.flipped = flipped != mirrored;
                self.part.standing.push(self.node);
                self.made.insert(d, ItemPlace::Surface(self.part.surfaces.len()));
                let item = self.item(d, "surface", self.part.surfaces.len(), face);
                self.part.surfaces.push(item);
            }
            Err(Defect(why)) => self.unusable(d, why),
        }
    }

    /// Leaves out a face.
    pub(super) fn unusable(&mut self, d: Pointer, cause: String) {
        self.part.unusable.push(Unusable { face: None, entity: self.table.label(d), line: self.table.line(d), cause, least_area: 0.0 });
    }

    pub(super) fn skipped(&mut self, d: Pointer, why: &str) {
        self.table.warn(d, format!("skipped: {why}"));
    }

    fn item<T>(&mut self, d: Pointer, word: &str, before: usize, value: T) -> Imported<T> {
        let (name, own) = self.name(d, word, before);
        let color = self.color(d);
        if let Some(made) = self.made.get(&d).copied() {
            self.levels.put(&self.table, d, &[made]);
        }
        if let (Some((rgb, color_name)), Some(made)) = (&color, self.made.get(&d).copied()) {
            self.shades.group(&mut self.part.colors, *rgb, color_name).put(made);
        }
        Imported { name, own, color: color.map(|c| c.0), id: u64::from(d), line: self.table.line(d), value }
    }

    /// The name property, else the label, else a word and a number; with another number where it is taken. Behind it what the file has.
    fn name(&mut self, d: Pointer, word: &str, before: usize) -> (String, Option<String>) {
        let own = self.named(d);
        let wanted = own.clone().unwrap_or_else(|| format!("{word}{}", before + 1));
        (self.names.give(&wanted), own)
    }

    /// The name property, else the label.
    pub(super) fn named(&self, d: Pointer) -> Option<String> {
        let given = self.table.place(d).ok().and_then(|k| {
            let names = self.table.decoded[k].properties.iter().filter_map(|p| match self.table.data(*p) {
                Ok(Data::Name(name)) if !name.is_empty() => Some(name.clone()),
                _ => None,
            });
            names.into_iter().next()
        });
        let label = self.table.entry(d).filter(|e| !e.label.is_empty()).map(|e| match e.subscript {
            0 => e.label.clone(),
            n => format!("{}{n}", e.label),
        });
        given.or(label)
    }

    /// Colour with the file's name for it.
    fn color(&self, d: Pointer) -> Option<([f64; 3], String)> {
        let color = self.table.entry(d)?.color;
        if color >= 0 {
            let k = usize::try_from(color).ok()?.checked_sub(1)?;
            return COLORS.get(k).map(|(rgb, name)| (*rgb, (*name).to_owned()));
        }
        match self.table.data(u32::try_from(-color).ok()?) {
            Ok(Data::Color { rgb, name }) => Some((rgb.map(|c| (c / 100.0).clamp(0.0, 1.0)), name.clone())),
            _ => None,
        }
    }

    /// A group of what its members are; faces of shells are made here.
    pub(super) fn group(&mut self, d: Pointer) {
        let mut group = Group::default();
        let mut seen = BTreeSet::new();
        let around = self.at;
        let is_body = matches!(self.table.data(d), Ok(Data::Solid { .. } | Data::Shell(_)));
        match self.table.motion(self.table.entry(d).filter(|_| is_body).map_or(0, |e| e.transform)) {
            Ok(own) if own != Motion::translation(DVec3::ZERO) => self.at = Some(around.map_or(own, |at| own.then(&at))),
            Ok(_) => {}
            Err(Defect(why)) => return self.unusable(d, why),
        }
        let gathered = self.gather(d, &mut group, &mut seen, 0);
        self.at = around;
        if let Err(Defect(why)) = gathered {
            self.skipped(d, &why);
        }
        if group.is_empty() {
            return;
        }
        let word = match self.table.data(d) {
            Ok(Data::Solid { .. }) => "solid",
            Ok(Data::Shell(_)) => "shell",
            _ => "group",
        };
        (group.name, group.own) = self.name(d, word, self.part.groups.len());
        self.levels.put(&self.table, d, &group.members());
        self.bodies(d, &group);
        self.part.groups.push(group);
    }

    /// Puts solids and shells into lists of their own, shells of solids too.
    fn bodies(&mut self, d: Pointer, group: &Group) {
        match self.table.data(d) {
            Ok(Data::Shell(_)) => self.part.shells.push(group.clone()),
            Ok(Data::Solid { shells }) => {
                for shell in shells.clone() {
                    let Ok(Data::Shell(faces)) = self.table.data(shell) else { continue };
                    let mut skin = Group { name: group.name.clone(), own: group.own.clone(), ..Group::default() };
                    faces.iter().filter_map(|(face, _)| self.made.get(face)).for_each(|made| skin.put(*made));
                    self.part.shells.push(skin);
                }
                self.part.solids.push(group.clone());
            }
            _ => {}
        }
    }

    fn gather(&mut self, d: Pointer, group: &mut Group, seen: &mut BTreeSet<Pointer>, depth: usize) -> Result<(), Defect> {
        if depth > NESTED {
            return Err(Defect("groups are nested too deep".to_owned()));
        }
        self.table.copy(1)?;
        if !seen.insert(d) {
            return Ok(());
        }
        match self.made.get(&d) {
            Some(made) => group.put(*made),
            None => {
                let inside: Vec<(Pointer, Option<bool>)> = match self.table.data(d) {
                    Ok(Data::Group(list)) => list.iter().map(|m| (*m, None)).collect(),
                    Ok(data) if data.is_instance() => {
                        let held = self.instances.get(&d).map_or(Vec::new(), Group::members);
                        held.into_iter().for_each(|member| group.put(member));
                        return Ok(());
                    }
                    Ok(Data::Solid { shells }) => shells.iter().map(|m| (*m, None)).collect(),
                    Ok(Data::Shell(faces)) => faces.iter().map(|(m, along)| (*m, Some(*along))).collect(),
                    _ => return Ok(()),
                };
                for (member, along) in inside {
                    if let Some(along) = along
                        && !self.made.contains_key(&member)
                        && !seen.contains(&member)
                    {
                        self.surface(member, !along);
                    }
                    self.gather(member, group, seen, depth + 1)?;
                }
            }
        }
        Ok(())
    }

    /// Says once by how much borders are off.
    fn gaps(&mut self) {
        if let Some((off, d)) = self.table.vertex_off {
            let off = self.table.length(off);
            self.table.warn(d, format!("a vertex of its edge is {off} off it, the most in the file; the curves are used"));
        }
        let slack = self.table.slack();
        let table = &self.table;
        if let Some((worst, n)) = self.part.list_repairs(slack, |item| table.label(item.id as Pointer)) {
            let others = if n == 0 { String::new() } else { format!(", as the borders of {n} more faces are by less") };
            let (d, gap) = (self.part.surfaces[worst.face].id as Pointer, self.table.length(worst.distance));
            self.table.warn(d, format!("its borders are up to {gap} off its surface or each other{others}"));
        }
    }

    /// Counts visible entities of types that are not read.
    fn unknown(&mut self) {
        let mut kinds: BTreeMap<(u32, i32), (u64, usize)> = BTreeMap::new();
        for (entry, decoded) in self.table.entries.iter().zip(&self.table.decoded) {
            if decoded.data == Data::Unknown && !entry.status.blanked && !UNREAD.contains(&entry.kind) {
                kinds.entry((entry.kind, entry.form)).or_insert((entry.line, 0)).1 += 1;
            }
        }
        for ((kind, form), (line, n)) in kinds {
            let what = if n == 1 { "entity".to_owned() } else { format!("{n} entities") };
            self.table.warnings.push(Malformed::line(line, format!("{what} of type {kind} form {form} are not read")));
        }
    }
}

impl EntityTable {
    /// A surface that nothing trims.
    fn whole(&mut self, d: Pointer) -> Result<Face, Defect> {
        let base = self.base(d, 0)?;
        let (base, also) = self.clear_of_axis(d, base, &FaceLoops::NONE)?;
        let of = |base: &Base| base.surface(&Box3::EMPTY, self.origin, &self.tolerance);
        let mut face = Face::whole(&base, of(&base)?, &self.tolerance);
        face.also = also.iter().map(of).collect::<Result<_, Defect>>()?;
        Ok(face)
    }
}
