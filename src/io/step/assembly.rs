//! Which products a file has, where they stand in each other, and what is shown of each.
//!
//! A product has representations, whose items are its geometry; it stands in other products by occurrences, each with a motion from the
//! frame of the one to that of the other. A mapped item places a representation without a product.

use std::collections::{BTreeMap, BTreeSet};

use crate::base::tolerance::NUDGE;
use crate::base::{job, limits};
use crate::geometry::Motion;
use crate::io::cad::assembly::Node;
use crate::io::cad::defect::{Defect, defect};
use crate::io::step::part::is_body;
use crate::io::step::product_tables::{ProductUse, Tables, mapped_by};
use crate::io::step::reader::{Frame, Step};
use crate::io::step::records::File;
use crate::io::step::units::{Units, of_context};

/// Products and representations inside each other.
const DEEP: usize = 64;

/// Something of a representation, where it is placed.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The item.
    pub item: u32,
    /// The representation that has it.
    pub representation: u32,
    /// The context of its representation, that says the units.
    pub units: Units,
    /// From the item's frame to the model's; lengths in model units.
    pub motion: Motion,
    /// Of [`Assembly::instances`].
    pub instance: usize,
}

/// A product at one place, or a representation without one.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The file's name for it; may be empty.
    pub name: String,
    /// The instance that it is a part of.
    pub parent: Option<usize>,
    /// The entity that names it.
    pub entity: u32,
    /// Its product definition.
    pub product: Option<u32>,
    /// From its frame to the model's.
    pub motion: Motion,
}

/// All that is shown, in file order.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    /// Items with their places.
    pub placed: Vec<Placed>,
    /// Products at their places; parents before their parts.
    pub instances: Vec<Instance>,
}

impl Assembly {
    /// Products at their places with the node of each instance, which may be that of what it is a part of.
    pub fn tree(&self, file: &File) -> (Vec<Node>, Vec<Option<usize>>) {
        let (mut nodes, mut places): (Vec<Node>, Vec<Option<usize>>) = (Vec::new(), Vec::with_capacity(self.instances.len()));
        let mut first: BTreeMap<u32, usize> = BTreeMap::new();
        for instance in &self.instances {
            let parent = instance.parent.and_then(|k| places[k]);
            let Some(product) = instance.product else {
                places.push(parent);
                continue;
            };
            let of = *first.entry(product).or_insert(nodes.len());
            places.push(Some(nodes.len()));
            let (name, motion) = (instance.name.clone(), instance.motion);
            nodes.push(Node { name, product: product_name(file, product), of, file: 0, parent, motion });
        }
        (nodes, places)
    }

    /// What places an item, from its representation up: that, mapped items, occurrences and products.
    pub fn way(&self, placed: &Placed) -> Vec<u32> {
        let mut way = vec![placed.representation];
        let mut at = Some(placed.instance);
        while let Some(instance) = at.and_then(|k| self.instances.get(k)) {
            way.push(instance.entity);
            way.extend(instance.product);
            at = instance.parent;
        }
        way
    }
}

struct AssemblyReader<'s, 'f> {
    step: &'s mut Step<'f>,
    tables: Tables,
    /// Representations that products have by themselves.
    owned: BTreeSet<u32>,
    units: BTreeMap<u32, Units>,
    shown: BTreeSet<u32>,
    /// Things with the instance that has them: representations that are one may each list them.
    listed: BTreeSet<(usize, u32)>,
    /// All that things of products are made of, once those stand; another representation of them shows nothing new.
    stands: Vec<bool>,
    found: Assembly,
    full: bool,
}

/// What a file shows, placed.
pub fn assembly(step: &mut Step) -> Assembly {
    let tables = Tables::of(step.file);
    let owned = tables.shapes.values().flatten().copied().collect();
    let mut reader = AssemblyReader {
        step,
        tables,
        owned,
        units: BTreeMap::new(),
        shown: BTreeSet::new(),
        listed: BTreeSet::new(),
        stands: Vec::new(),
        found: Assembly::default(),
        full: false,
    };
    let still = Motion::translation(glam::DVec3::ZERO);
    let mapped = |reader: &AssemblyReader, p: u32| {
        reader.tables.shapes.get(&p).is_some_and(|all| all.iter().any(|r| reader.tables.mapped.contains(r)))
    };
    let products = reader.tables.products.clone();
    for product in products.iter().copied() {
        if !reader.tables.parts.contains(&product) && !mapped(&reader, product) {
            reader.product(product, None, String::new(), product, &still, 0);
        }
    }
    // Representations that no product shows, and those of products that are parts of each other in a circle.
    reader.stands = parts_of(reader.step.file, reader.found.placed.iter().map(|placed| placed.item));
    for of_parts in [false, true] {
        let left: Vec<u32> = reader.tables.representations.keys().copied().collect();
        for representation in left {
            let skip = reader.shown.contains(&representation)
                || reader.tables.aspects.contains(&representation)
                || reader.tables.views.contains(&representation)
                || (!of_parts && reader.tables.mapped_by_any.contains(&representation));
            if !skip && (of_parts || !reader.owned.contains(&representation)) {
                reader.alone(representation, &still);
            }
        }
    }
    reader.found
}

impl AssemblyReader<'_, '_> {
    fn units(&mut self, context: Option<u32>) -> Units {
        let Some(context) = context else { return Units::NONE };
        if let Some(units) = self.units.get(&context) {
            return *units;
        }
        let mut warnings = Vec::new();
        let units = of_context(self.step.file, context, &mut |k, what| warnings.push((k, what)));
        warnings.into_iter().for_each(|(k, what)| self.step.warn(k, what));
        self.units.insert(context, units);
        units
    }

    /// Adds an instance; none when there are too many.
    fn instance(&mut self, instance: Instance) -> Option<usize> {
        if self.found.instances.len() >= limits::PART_INSTANCES {
            self.too_many(instance.entity);
            return None;
        }
        self.found.instances.push(instance);
        Some(self.found.instances.len() - 1)
    }

    fn too_many(&mut self, entity: u32) {
        if !self.full {
            self.full = true;
            self.step.warn(entity, format!("more than {} placed parts; those from here on are skipped", limits::PART_INSTANCES));
        }
    }

    /// A product with its parts.
    fn product(&mut self, product: u32, parent: Option<usize>, name: String, entity: u32, motion: &Motion, depth: usize) {
        if self.full {
            return;
        }
        job::poll();
        if depth > DEEP {
            return self.step.warn(entity, "skipped: products are nested too deep, or are parts of themselves");
        }
        let own = product_name(self.step.file, product);
        let name = if name.is_empty() || depth == 0 { own } else { name };
        let Some(instance) = self.instance(Instance { name, parent, entity, product: Some(product), motion: *motion }) else { return };
        let first = self.tables.shapes.get(&product).cloned().unwrap_or_default();
        for representation in self.tables.one_with(&first, &self.owned) {
            self.representation(representation, instance, motion, depth);
        }
        for occurrence in self.tables.occurrences.get(&product).cloned().unwrap_or_default() {
            let placed = match occurrence.link {
                Some(link) => self.link(link, &occurrence),
                // Mapped items place it.
                None if self.tables.shapes.get(&occurrence.child).is_some_and(|r| r.iter().any(|r| self.tables.mapped.contains(r))) => {
                    continue;
                }
                None => Ok(Motion::translation(glam::DVec3::ZERO)),
            };
            match placed {
                Ok(placed) => {
                    let ProductUse { child, name, entity, .. } = occurrence;
                    self.product(child, Some(instance), name, entity, &placed.then(motion), depth + 1);
                }
                Err(Defect(why)) => self.step.warn(occurrence.entity, format!("skipped: its place cannot be read: {why}")),
            }
        }
    }

    /// A representation that no product has.
    fn alone(&mut self, representation: u32, motion: &Motion) {
        let name = self.step.file.under(representation, b"REPRESENTATION").unwrap_or(self.step.file.parameters(representation)).text(0);
        let Some((items, _)) = self.tables.representations.get(&representation) else { return };
        let file = self.step.file;
        if items.iter().all(|k| file.name(*k).starts_with(b"AXIS")) {
            return;
        }
        if let Some(instance) = self.instance(Instance { name, parent: None, entity: representation, product: None, motion: *motion }) {
            self.representation(representation, instance, motion, 0);
        }
    }

    fn representation(&mut self, representation: u32, instance: usize, motion: &Motion, depth: usize) {
        if depth > DEEP {
            return self.step.warn(representation, "skipped: representations are nested too deep, or are parts of themselves");
        }
        self.shown.insert(representation);
        let Some((items, context)) = self.tables.representations.get(&representation).cloned() else { return };
        let units = self.units(context);
        for item in items {
            if self.full {
                return;
            }
            if mapped_by(self.step.file, item).is_some() {
                self.mapped(item, instance, units, motion, depth);
                continue;
            }
            // Representations without a product stand in one frame.
            let loose = self.found.instances[instance].product.is_none() && depth == 0;
            let within = if loose { usize::MAX } else { instance };
            if self.stands_already(item) || !self.listed.insert((within, item)) {
                continue;
            }
            if self.found.placed.len() >= limits::PART_INSTANCES {
                return self.too_many(item);
            }
            self.found.placed.push(Placed { item, representation, units, motion: *motion, instance });
        }
    }

    /// Whether products have a thing, or all that it is made of, where they have another body of the same shells.
    fn stands_already(&self, item: u32) -> bool {
        let stands = |k: u32| self.stands.get(k as usize) == Some(&true);
        let mut made_of = self.step.file.references(item).peekable();
        stands(item) || is_body(self.step.file, item) && made_of.peek().is_some() && made_of.all(stands)
    }

    /// Whether an occurrence places the product of a representation in that of an instance: a mapped item there says so once more.
    fn is_part(&mut self, representation: u32, instance: usize, placed: &Motion) -> bool {
        let product = self.found.instances.get(instance).and_then(|instance| instance.product);
        let Some(occurrences) = product.and_then(|product| self.tables.occurrences.get(&product)).cloned() else { return false };
        let has = |of: &&ProductUse| self.tables.shapes.get(&of.child).is_some_and(|all| all.contains(&representation));
        let near = |a: &Motion| {
            let corners = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z];
            corners.iter().all(|p| a.point(*p).distance(placed.point(*p)) <= NUDGE * (1.0 + placed.point(*p).length()))
        };
        let of_it: Vec<&ProductUse> = occurrences.iter().filter(has).collect();
        of_it.iter().any(|of| of.link.is_some_and(|link| self.link(link, of).is_ok_and(|motion| near(&motion))))
    }

    /// A representation placed by a mapped item, with those that are one with it.
    fn mapped(&mut self, item: u32, instance: usize, units: Units, motion: &Motion, depth: usize) {
        let row = self.step.file.parameters(item);
        let placed = (|| {
            let map = self.step.file.parameters(row.entity(1)?);
            let (origin, of) = (map.entity(0)?, map.entity(1)?);
            let inner = self.tables.representations.get(&of).and_then(|r| r.1);
            let inner = self.units(inner);
            self.step.measure_in(inner);
            let from = self.step.frame(origin)?;
            self.step.measure_in(units);
            Ok::<_, Defect>((of, self.target(row.entity(2)?, &from)?))
        })();
        match placed {
            Ok((of, placed)) if self.is_part(of, instance, &placed) => {}
            Ok((of, placed)) => {
                let name = row.text(0);
                let made = Instance { name, parent: Some(instance), entity: item, product: None, motion: *motion };
                let Some(instance) = self.instance(made) else { return };
                for representation in self.tables.one_with(&[of], &self.owned) {
                    self.representation(representation, instance, &placed.then(motion), depth + 1);
                }
            }
            Err(Defect(why)) => self.step.warn(item, format!("skipped: its place cannot be read: {why}")),
        }
    }

    /// The motion from a frame to a placement or by a transformation.
    fn target(&self, target: u32, from: &Frame) -> Result<Motion, Defect> {
        let file = self.step.file;
        let Some(row) = file.under(target, b"CARTESIAN_TRANSFORMATION_OPERATOR_3D") else {
            return Ok(from.to(&self.step.frame(target)?));
        };
        let (x, y, at, scale, z) = if file.is_complex(target) {
            let of = file.under(target, b"CARTESIAN_TRANSFORMATION_OPERATOR").ok_or_else(|| defect("it has no origin"))?;
            (of.maybe(0)?, of.maybe(1)?, of.entity(2)?, of.number(3).unwrap_or(1.0), row.maybe(0)?)
        } else {
            // Name, and name and description of the transformation, stand before its axes.
            let from = row.values().count().saturating_sub(5);
            (row.maybe(from)?, row.maybe(from + 1)?, row.entity(from + 2)?, row.number(from + 3).unwrap_or(1.0), row.maybe(from + 4)?)
        };
        if scale <= 0.0 {
            return Err(defect("its scale is not above 0"));
        }
        let at = self.step.point(at)?;
        let direction = |k: Option<u32>| k.map(|k| self.step.direction(k)).transpose();
        let z = direction(z)?.unwrap_or(glam::DVec3::Z);
        let x = direction(x)?.unwrap_or_else(|| crate::base::math::any_normal(z));
        let x = crate::base::math::unit(x.reject_from_normalized(z), 0.0).ok_or_else(|| defect("its axes coincide"))?;
        let right = z.cross(x);
        let mirrors = direction(y)?.is_some_and(|y| y.dot(right) < 0.0);
        let to = Frame { at, x, y: right, z };
        let motion = Motion::scaling(from.at, scale).then(&from.to(&to));
        Ok(if mirrors { motion.then(&Motion::mirror(at, right)) } else { motion })
    }

    /// The motion of an occurrence: the frame of one representation goes to that of the other.
    fn link(&mut self, link: u32, occurrence: &ProductUse) -> Result<Motion, Defect> {
        let file = self.step.file;
        let relation = file.under(link, b"REPRESENTATION_RELATIONSHIP").unwrap_or_else(|| file.parameters(link));
        let (first, second) = (relation.entity(2)?, relation.entity(3)?);
        let transform = match file.under(link, b"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
            Some(row) => row.entity(if file.is_complex(link) { 0 } else { 4 })?,
            None => return Ok(Motion::translation(glam::DVec3::ZERO)),
        };
        let row = file.parameters(transform);
        if file.name(transform) != b"ITEM_DEFINED_TRANSFORMATION" {
            let units = self.tables.representations.get(&second).and_then(|r| r.1);
            let units = self.units(units);
            self.step.measure_in(units);
            let still = Frame { at: glam::DVec3::ZERO, x: glam::DVec3::X, y: glam::DVec3::Y, z: glam::DVec3::Z };
            return self.target(transform, &still);
        }
        let (mut a, mut b) = (row.entity(2)?, row.entity(3)?);
        let holds = |r: u32, k: u32| self.tables.representations.get(&r).is_some_and(|(items, _)| items.contains(&k));
        // Each frame belongs to the representation on its side; some files have them crossed.
        if !holds(first, a) && !holds(second, b) && holds(first, b) && holds(second, a) {
            std::mem::swap(&mut a, &mut b);
        }
        let mut frame = |representation: u32, k: u32| {
            let context = self.tables.representations.get(&representation).and_then(|r| r.1);
            let units = self.units(context);
            self.step.measure_in(units);
            self.step.frame(k)
        };
        let (of_first, of_second) = (frame(first, a)?, frame(second, b)?);
        let shapes = self.tables.shapes.get(&occurrence.child);
        let is_child = |r: u32| shapes.is_some_and(|all| all.contains(&r));
        let swapped = is_child(second) && !is_child(first);
        Ok(if swapped { of_second.to(&of_first) } else { of_first.to(&of_second) })
    }
}

/// Which entities some items are, and are made of.
fn parts_of(file: &File, items: impl Iterator<Item = u32>) -> Vec<bool> {
    let mut found = vec![false; file.records.len()];
    let mut open: Vec<u32> = items.collect();
    while let Some(k) = open.pop() {
        job::poll();
        if !std::mem::replace(&mut found[k as usize], true) {
            open.extend(file.references(k));
        }
    }
    found
}

/// The name of the product that a definition is of.
fn product_name(file: &File, definition: u32) -> String {
    let formation = file.parameters(definition).entity(2);
    let product = formation.and_then(|f| file.parameters(f).entity(2));
    let Ok(row) = product.map(|p| file.parameters(p)) else { return String::new() };
    let name = row.text(1);
    let name = if name.trim().is_empty() { row.text(0) } else { name };
    name.trim().to_owned()
}
