//! What a file offers: the faces, curves and points of its products at their places, by name.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::tolerance::Tolerance;
use crate::base::{job, limits};
use crate::geometry::Motion;
use crate::io::cad::defect::Defect;
use crate::io::cad::part::{Figure, Group, Imported, Part, PartPlace, Shades, Stated, UniqueNames};
use crate::io::files::fault::Malformed;
use crate::io::step::assembly::{Assembly, Instance, Placed};
use crate::io::step::items::{Bundle, BundleKind, Item as Shape, Unread};
use crate::io::step::open::OpenedStep;
use crate::io::step::reader::Step;
use crate::io::step::records::File;
use crate::io::step::styles::{Color, StyleTable};
use crate::io::step::units::Units;
use crate::io::step::validation::{self, Given, Of};

impl OpenedStep<'_> {
    /// Makes curves and faces of the items.
    pub fn part(self, tolerance: Tolerance) -> Part {
        let Self { file, options, assembly, warnings } = self;
        let mut step = Step::new(&file, options);
        step.tolerance = tolerance;
        step.warnings = warnings;
        let unit = assembly.placed.first().map_or(Units::NONE, |p| p.units).name();
        let builder = StepPartBuilder {
            styles: StyleTable::of(&file),
            step,
            part: Part { unit, mark: "#", model_unit: options.unit, ..Part::default() },
            names: UniqueNames::default(),
            shades: Shades::default(),
            made: BTreeMap::new(),
            held: assembly.instances.iter().map(|_| Group::default()).collect(),
            single: vec![None; assembly.instances.len()],
            slack: 0.0,
        };
        builder.run(&assembly)
    }
}

struct StepPartBuilder<'f> {
    step: Step<'f>,
    styles: StyleTable,
    part: Part,
    names: UniqueNames,
    shades: Shades,
    /// Places of what was made of an entity, all copies of it.
    made: BTreeMap<u32, Vec<PartPlace>>,
    /// What each instance has by itself.
    held: Vec<Group>,
    /// The solid or shell that took the name of an instance, being all it has.
    single: Vec<Option<usize>>,
    /// Largest distance that a context of the file calls none, model units.
    slack: f64,
}

/// A text that some systems write for no name.
fn given(name: String) -> Option<String> {
    let name = name.trim();
    (!name.is_empty() && name != "NONE").then(|| name.to_owned())
}

/// The name that an entity has of its own.
fn name(file: &File, entity: u32) -> Option<String> {
    given(file.under(entity, b"REPRESENTATION_ITEM").unwrap_or(file.parameters(entity)).text(0))
}

/// Whether a body goes by the name of the copy of a product that it is.
fn is_copy(instance: &Instance, alone: bool) -> bool {
    alone && instance.parent.is_some() && given(instance.name.clone()).is_some()
}

impl StepPartBuilder<'_> {
    fn run(mut self, assembly: &Assembly) -> Part {
        let mut unread = Unread::new();
        let mut shapes: BTreeMap<u32, (Units, Shape)> = BTreeMap::new();
        let mut uses: BTreeMap<u32, usize> = BTreeMap::new();
        let mut of_instance = vec![0_usize; assembly.instances.len()];
        for placed in &assembly.placed {
            *uses.entry(placed.item).or_insert(0) += 1;
            of_instance[placed.instance] += usize::from(is_body(self.step.file, placed.item));
        }
        let all_uses = uses.clone();
        for placed in &assembly.placed {
            job::poll();
            let left = uses.entry(placed.item).or_insert(1);
            *left = left.saturating_sub(1);
            let last = *left == 0;
            let known = shapes.remove(&placed.item).filter(|(units, _)| *units == placed.units);
            let shape = match known {
                Some((_, shape)) => shape,
                None => {
                    self.step.measure_in(placed.units);
                    self.slack = self.slack.max(self.step.slack());
                    self.step.item(placed.item, &mut unread)
                }
            };
            if let Err(Defect(why)) = self.step.spend(shape.weight()) {
                self.step.warn(placed.item, format!("skipped: {why}"));
                break;
            }
            let alone = of_instance[placed.instance] == 1;
            if last {
                self.put(shape, placed, assembly, alone);
            } else {
                self.put(shape.clone(), placed, assembly, alone);
                shapes.insert(placed.item, (placed.units, shape));
            }
        }
        self.stand(assembly);
        self.inherit(assembly);
        self.stated(assembly, &all_uses);
        self.instances(assembly);
        self.layers();
        for (word, (k, n)) in unread {
            let what = if n == 1 { "entity".to_owned() } else { format!("{n} entities") };
            let line = self.step.file.line(k);
            self.step.warnings.push(Malformed::line(line, format!("{what} of type {word} are not read")));
        }
        self.gaps();
        self.part.warnings = std::mem::take(&mut self.step.warnings);
        self.part.unusable = std::mem::take(&mut self.step.unusable);
        self.part
    }

    /// Puts a placed item into the part.
    fn put(&mut self, shape: Shape, placed: &Placed, assembly: &Assembly, alone: bool) {
        let still = placed.motion == Motion::translation(DVec3::ZERO);
        let (points, curves, faces) = (self.part.points.len(), self.part.curves.len(), self.part.surfaces.len());
        let (solid, way) = (placed.item, assembly.way(placed));
        // A surface of several faces that have its name, too, is meant by it.
        let is_copy = is_copy(&assembly.instances[placed.instance], alone);
        let models: Vec<Option<u32>> = shape.bundles.iter().map(|bundle| bundle.model.filter(|_| !is_copy)).collect();
        let models = models.into_iter().map(|model| name(self.step.file, model?).map(|own| self.names.give(&own))).collect::<Vec<_>>();
        for (entity, p) in shape.points {
            let color = self.styles.curve(&[entity, solid], &way).cloned();
            let at = PartPlace::Point(self.part.points.len());
            let item = self.named(entity, "point", self.part.points.len(), color, at, vec![placed.motion.point(p)]);
            self.part.points.push(item);
        }
        for (entity, curve) in shape.curves {
            let color = self.styles.curve(&[entity, solid], &way).cloned();
            let curve = if still { curve } else { curve.moved(&placed.motion) };
            if curve.length() <= self.step.tolerance.point {
                self.step.warn(entity, "skipped: it is shorter than the tolerance");
                continue;
            }
            let at = PartPlace::Curve(self.part.curves.len());
            let item = self.named(entity, "curve", self.part.curves.len(), color, at, curve);
            self.part.curves.push(item);
        }
        for (entity, face, shell) in shape.faces {
            let color = self.styles.surface(&[entity, shell.unwrap_or(entity), solid], &way).cloned();
            let at = PartPlace::Surface(self.part.surfaces.len());
            let face = if still { face } else { face.moved(&placed.motion) };
            let item = self.named(entity, "surface", self.part.surfaces.len(), color, at, face);
            self.part.surfaces.push(item);
        }
        let first = [points, curves, faces];
        let held = self.held.get_mut(placed.instance);
        if let Some(held) = held {
            held.points.extend(points..self.part.points.len());
            held.curves.extend(curves..self.part.curves.len());
            held.surfaces.extend(faces..self.part.surfaces.len());
        }
        let mut solid_name = String::new();
        for (bundle, model) in shape.bundles.iter().zip(models) {
            let mut group = moved(bundle, first);
            if group.is_empty() {
                continue;
            }
            group.name = model.unwrap_or_default();
            self.bundle(bundle, group, &mut solid_name, placed.instance, &assembly.instances[placed.instance], alone);
        }
    }

    /// Puts a solid, shell or set into its lists.
    fn bundle(&mut self, bundle: &Bundle, mut group: Group, solid: &mut String, place: usize, instance: &Instance, alone: bool) {
        let own = name(self.step.file, bundle.entity).or_else(|| name(self.step.file, bundle.model?));
        let all = [PartPlace::Point as fn(usize) -> PartPlace, PartPlace::Curve, PartPlace::Surface];
        let members = [&group.points, &group.curves, &group.surfaces];
        let members: Vec<PartPlace> = all.iter().zip(members).flat_map(|(kind, list)| list.iter().map(|k| kind(*k))).collect();
        for entity in std::iter::once(bundle.entity).chain(bundle.model) {
            self.made.entry(entity).or_default().extend(members.iter().copied());
        }
        if bundle.sort == BundleKind::Skin {
            group.name = own.clone().unwrap_or_else(|| solid.clone());
            group.own = own;
            self.part.shells.push(group);
            return;
        }
        let named_by_part = own.is_none() && alone && given(instance.name.clone()).is_some();
        // A product with one body is that body: its name says which copy it is.
        let wanted = if named_by_part || is_copy(instance, alone) { Some(instance.name.clone()) } else { own };
        let word = match bundle.sort {
            BundleKind::Solid => "solid",
            BundleKind::Set => "set",
            _ => "shell",
        };
        let before = self.part.groups.len();
        group.own.clone_from(&wanted);
        let wanted = wanted.unwrap_or_else(|| format!("{word}{}", before + 1));
        if group.name.is_empty() {
            group.name = self.names.give(&wanted);
        }
        solid.clone_from(&group.name);
        if wanted == instance.name && alone {
            self.single[place] = Some(before);
        }
        match bundle.sort {
            BundleKind::Solid => self.part.solids.push(group.clone()),
            BundleKind::Shell => self.part.shells.push(group.clone()),
            _ => {}
        }
        self.part.groups.push(group);
    }

    fn named<T>(&mut self, entity: u32, word: &str, before: usize, color: Option<Color>, at: PartPlace, value: T) -> Imported<T> {
        self.made.entry(entity).or_default().push(at);
        let file = self.step.file;
        let own = name(file, entity);
        let wanted = own.clone().unwrap_or_else(|| format!("{word}{}", before + 1));
        if let Some((rgb, name)) = &color {
            self.shades.group(&mut self.part.colors, *rgb, name).put(at);
        }
        let name = self.names.give(&wanted);
        Imported { name, own, color: color.map(|c| c.0), id: u64::from(file.id(entity)), line: file.line(entity), value }
    }

    /// Which product each face is of.
    fn stand(&mut self, assembly: &Assembly) {
        let (tree, places) = assembly.tree(self.step.file);
        self.part.standing = vec![None; self.part.surfaces.len()];
        for (held, place) in self.held.iter().zip(places) {
            held.surfaces.iter().for_each(|k| self.part.standing[*k] = place);
        }
        self.part.tree = tree;
    }

    /// Gives each product what its parts have.
    fn inherit(&mut self, assembly: &Assembly) {
        let mut budget = limits::PART_COPIES;
        for k in (0..assembly.instances.len()).rev() {
            let Some(parent) = assembly.instances[k].parent else { continue };
            let inner = self.held[k].clone();
            let n = inner.points.len() + inner.curves.len() + inner.surfaces.len();
            if n > budget {
                self.step.warn(assembly.instances[k].entity, "its products are nested so deep that not all have a group of their own");
                break;
            }
            budget -= n;
            let held = &mut self.held[parent];
            held.points.extend(inner.points);
            held.curves.extend(inner.curves);
            held.surfaces.extend(inner.surfaces);
        }
    }

    /// A group for each named product at its place, with the parts of it.
    fn instances(&mut self, assembly: &Assembly) {
        for (k, instance) in assembly.instances.iter().enumerate() {
            let mut group = std::mem::take(&mut self.held[k]);
            let is_single = self.single[k].is_some_and(|body| {
                let body = &self.part.groups[body];
                [(&body.points, &group.points), (&body.curves, &group.curves), (&body.surfaces, &group.surfaces)]
                    .iter()
                    .all(|(a, b)| a.len() == b.len())
            });
            let Some(name) = given(instance.name.clone()).filter(|_| !is_single && !group.is_empty()) else { continue };
            for list in [&mut group.points, &mut group.curves, &mut group.surfaces] {
                list.sort_unstable();
            }
            group.name = self.names.give(&name);
            self.part.groups.push(group);
        }
    }

    /// What the file states of products and items that came in.
    fn stated(&mut self, assembly: &Assembly, uses: &BTreeMap<u32, usize>) {
        let file = self.step.file;
        for (of, given, k) in validation::given(file) {
            let (mut surfaces, copies, placed, name) = match &of {
                Of::Product(product) => {
                    let Some(at) = assembly.instances.iter().position(|i| i.product == Some(*product)) else { continue };
                    let placed = assembly.placed.iter().find(|p| p.instance == at);
                    (self.held[at].surfaces.clone(), 1, placed, assembly.instances[at].name.clone())
                }
                Of::Items(items) => {
                    let made = items.iter().flat_map(|item| self.made.get(item).into_iter().flatten());
                    let faces = made.filter_map(|at| if let PartPlace::Surface(k) = at { Some(*k) } else { None }).collect();
                    let copies = items.iter().filter_map(|item| uses.get(item)).copied().max().unwrap_or(1);
                    let placed = assembly.placed.iter().find(|p| items.contains(&p.item));
                    (faces, copies, placed, items.first().map_or(String::new(), |item| self.step.label(*item)))
                }
            };
            surfaces.sort_unstable();
            surfaces.dedup();
            let units = placed.or(assembly.placed.first()).map_or(Units::NONE, |p| p.units);
            self.step.measure_in(units);
            // Model units in a millimetre of the file, in which the import may see another unit.
            let length = self.step.scale / units.millimetres.unwrap_or(1.0);
            let figure = match given {
                Given::Area(x) => Figure::Area(x * length * length),
                Given::Volume(x) => Figure::Volume(x * length * length * length),
                // Where it stands is known of one copy only, and of one that has items of its own.
                Given::Centroid(point) => match (self.step.point(point), placed) {
                    (Ok(p), Some(placed)) if copies == 1 => Figure::Centroid(placed.motion.point(p)),
                    _ => continue,
                },
            };
            let name = format!("#{} {name}", file.id(k));
            self.part.stated.push(Stated { surfaces, copies, figure, name, line: file.line(k) });
        }
    }

    /// A group for each layer.
    fn layers(&mut self) {
        for (k, name, items) in std::mem::take(&mut self.styles.layers) {
            let mut group = Group::default();
            for item in items {
                self.made.get(&item).into_iter().flatten().for_each(|at| group.put(*at));
            }
            for list in [&mut group.points, &mut group.curves, &mut group.surfaces] {
                list.sort_unstable();
                list.dedup();
            }
            if group.is_empty() {
                continue;
            }
            group.own = given(name);
            group.name = self.names.give(&group.own.clone().unwrap_or_else(|| format!("layer{}", self.step.file.id(k))));
            self.part.layers.push(group.clone());
            self.part.groups.push(group);
        }
    }

    /// Says once by how much borders are off.
    fn gaps(&mut self) {
        if let Some((worst, n)) = self.part.list_repairs(self.slack, |item| format!("#{} {}", item.id, item.name)) {
            let others = if n == 0 { String::new() } else { format!(", as the borders of {n} more faces are by less") };
            let gap = self.step.length(worst.distance);
            let what = format!("{}: its borders are up to {gap} off its surface or each other{others}", worst.entity);
            self.step.warnings.push(Malformed::line(worst.line, what));
        }
    }
}

/// Whether an item is a solid or a shell.
pub(super) fn is_body(file: &File, k: u32) -> bool {
    const BODIES: &[&[u8]] = &[
        b"MANIFOLD_SOLID_BREP",
        b"BREP_WITH_VOIDS",
        b"FACETED_BREP",
        b"SHELL_BASED_SURFACE_MODEL",
        b"FACE_BASED_SURFACE_MODEL",
        b"GEOMETRIC_SET",
        b"GEOMETRIC_CURVE_SET",
    ];
    file.names(k).any(|n| BODIES.contains(&n))
}

/// The members of a bundle in the lists of the part.
fn moved(bundle: &Bundle, first: [usize; 3]) -> Group {
    let list = |k: usize| (first[k] + bundle.ranges[k].0..first[k] + bundle.ranges[k].1).collect();
    Group { points: list(0), curves: list(1), surfaces: list(2), ..Group::default() }
}
