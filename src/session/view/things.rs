//! What a script declares, as things that are drawn.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;

use super::buffer::{Buffer, Role};
use super::frame::{BufferRow, Place, Thing};
use super::lines::{self, Polyline};
use super::places::place;
use super::{faces, held, meshes};
use crate::base::bbox::Box3;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::draw::lines::chain as along;
use crate::lang::eval::context::Cx;
use crate::lang::eval::scene::Scene;
use crate::lang::run::declared::DeclaredValue;
use crate::lang::run::symbols::Symbol;
use crate::lang::syntax::ast::Keyword;
use crate::lang::values::value::{ModuleId, ShellValue, Value};
use crate::lang::words::plural::counted;
use crate::mesh::Mesh;
use crate::model::SurfaceId;
use crate::network::Chain;
use crate::surface::{Domain, Surface};

/// How far display triangles may be from their surfaces, as a share of the diagonal of everything.
const FINE: f64 = 2.5e-4;
/// How many times finer than usual a page may ask for: triangles become as many times more.
const FINEST: f64 = 16.0;
/// Places of a curve that its box is taken from.
const SAMPLES: usize = 17;
/// Members of one declaration that are things of their own; of more one thing is made, which is drawn at once.
const MEMBERS: usize = 48;

/// Everything that is drawn of a model.
#[derive(Default)]
pub(super) struct Drawn {
    pub things: Vec<Thing>,
    pub buffers: BTreeMap<String, Buffer>,
    /// How far display triangles are from their surfaces at most, model units.
    pub chord_error: f64,
}

/// Buffers of the frame before, by name.
#[derive(Default)]
pub(super) struct Kept {
    faces: BTreeMap<String, KeptFaces>,
    meshes: BTreeMap<String, (Arc<Mesh>, Option<Buffer>)>,
    /// How far display triangles were from their surfaces at most, model units; `None` before the first whole frame.
    fine: Option<f64>,
}

/// What surfaces were drawn as, and all that it depends on.
#[derive(Clone)]
struct KeptFaces {
    surfaces: Vec<Surface>,
    /// Of each whether it shows its other side, and the rectangles of its patches in (u, v).
    patches: Vec<(bool, Vec<[f64; 4]>)>,
    /// How far borders may be apart and still be one edge, model units.
    near: f64,
    fine: f64,
    buffers: Vec<Buffer>,
    /// Patches that cannot be drawn.
    lost: usize,
}

impl KeptFaces {
    /// Those of surfaces in a scene, without buffers.
    fn new(surfaces: &[Surface], ids: &[(SurfaceId, bool)], scene: &Scene, near: f64, fine: f64) -> Self {
        let rectangles = |id: SurfaceId| {
            let patches = scene.model.patches_of(id).map(|p| &scene.model.patches[p.index()]);
            patches.map(|p| [p.u.0, p.u.1, p.v.0, p.v.1]).collect()
        };
        let patches = ids.iter().map(|(id, flipped)| (*flipped, rectangles(*id))).collect();
        Self { surfaces: surfaces.to_vec(), patches, near, fine, buffers: Vec::new(), lost: 0 }
    }

    /// With the buffers of an earlier frame where nothing changed, else with those that `make` draws.
    fn drawn(mut self, before: Option<&Self>, make: impl FnOnce() -> (Vec<Buffer>, usize)) -> Self {
        let same = |before: &&Self| {
            let surfaces = before.surfaces.len() == self.surfaces.len() && before.surfaces.iter().zip(&self.surfaces).all(|(a, b)| a.is(b));
            surfaces && before.patches == self.patches && before.near == self.near && before.fine == self.fine
        };
        (self.buffers, self.lost) = before.filter(same).map_or_else(make, |before| (before.buffers.clone(), before.lost));
        self
    }
}

/// A declared value that can be drawn.
enum Shape {
    Points(Vec<(String, DVec3)>),
    Curves(Vec<(String, Chain)>),
    Surfaces(Vec<Surface>),
    Shell(Arc<ShellValue>),
    Mesh(Arc<Mesh>),
    Group(Vec<Value>),
}

struct Item {
    thing: Thing,
    shape: Shape,
    /// The declaration that it is a member of, by its place in the script.
    declaration: usize,
}

impl Shape {
    /// Takes in what another member of the same declaration is; gives it back where it is of another kind.
    fn join(&mut self, other: Self) -> Result<(), Self> {
        match (self, other) {
            (Self::Points(all), Self::Points(more)) => all.extend(more),
            (Self::Curves(all), Self::Curves(more)) => all.extend(more),
            (Self::Surfaces(all), Self::Surfaces(more)) => all.extend(more),
            (_, other) => return Err(other),
        }
        Ok(())
    }
}

/// Makes one item of the members of each declaration that has many.
fn joined(items: Vec<Item>) -> Vec<Item> {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    items.iter().for_each(|item| *counts.entry(item.declaration).or_default() += 1);
    let mut out: Vec<Item> = Vec::with_capacity(items.len());
    for mut item in items {
        let many = counts.get(&item.declaration).is_some_and(|n| *n > MEMBERS);
        if !many || !matches!(item.shape, Shape::Points(_) | Shape::Curves(_) | Shape::Surfaces(_)) {
            out.push(item);
            continue;
        }
        let own = out.iter().rposition(|other| other.declaration != item.declaration).map_or(0, |k| k + 1);
        let alike = |other: &&mut Item| {
            other.thing.kind == item.thing.kind && std::mem::discriminant(&other.shape) == std::mem::discriminant(&item.shape)
        };
        if let Some(same) = out[own..].iter_mut().find(alike) {
            if let Err(shape) = same.shape.join(item.shape) {
                item.shape = shape;
                out.push(item);
            }
            continue;
        }
        item.thing.name.truncate(item.thing.name.find('[').unwrap_or(item.thing.name.len()));
        if out[own..].iter().any(|other| other.thing.name == item.thing.name) {
            item.thing.name = format!("{} ({}s)", item.thing.name, item.thing.kind);
        }
        out.push(item);
    }
    out
}

/// How much of a model is evaluated when it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Evaluated {
    /// Its shapes; meshes are not made.
    Shapes,
    /// All of it.
    Whole,
}

/// Draws what the script declares; `chord_error` as asked for, model units.
pub(super) fn draw(cx: &mut Cx, symbols: &[Symbol], chord_error: Option<f64>, evaluated: Evaluated, kept: &mut Kept) -> Drawn {
    let Some(tolerance) = cx.tolerance_used() else { return Drawn::default() };
    let items = items(cx, symbols, evaluated);
    let usual = fineness(chord_error, around(&items).diagonal()).max(tolerance.point);
    // The box of all may be larger than that of the shapes: what is drawn early is not to be drawn again.
    let fine = kept.fine.filter(|_| evaluated == Evaluated::Shapes).unwrap_or(usual);
    let mut drawn = Drawn { chord_error: fine, ..Drawn::default() };
    let scene = scene(cx, &items);
    let declared = declared_surfaces(&items);
    let surfaces = surfaces(&items, scene.as_ref(), fine, &tolerance, kept);
    let mut now = Kept::default();
    for (Item { mut thing, shape, .. }, mut made) in items.into_iter().zip(surfaces) {
        let buffers = match &shape {
            Shape::Points(named) => lines::points(named).into_iter().collect(),
            Shape::Curves(named) => curves(named, fine, &tolerance).into_iter().collect(),
            Shape::Surfaces(_) | Shape::Shell(_) => {
                if let Shape::Shell(shell) = &shape {
                    let drawn = self::shell(cx, shell, &declared, fine, &tolerance, kept);
                    (made, thing.surfaces) = drawn.map_or((None, Vec::new()), |(made, others)| (Some(made), others));
                }
                match &made {
                    None => thing.unmade = Some("it cannot be drawn".to_owned()),
                    Some(made) if made.lost > 0 => thing.facts.push(("not drawn".to_owned(), counted(made.lost, "patch", "patches"))),
                    Some(_) => {}
                }
                let buffers = made.as_ref().map_or(Vec::new(), |made| made.buffers.clone());
                now.faces.extend(made.map(|made| (thing.name.clone(), made)));
                buffers
            }
            Shape::Mesh(mesh) => {
                let known = kept.meshes.get(&thing.name).filter(|(before, _)| Arc::ptr_eq(before, mesh)).map(|(_, buffer)| buffer.clone());
                let buffer = known.unwrap_or_else(|| meshes::buffer(mesh));
                now.meshes.insert(thing.name.clone(), (mesh.clone(), buffer.clone()));
                buffer.into_iter().collect()
            }
            Shape::Group(_) => Vec::new(),
        };
        let members = match &shape {
            Shape::Points(named) => named.len(),
            Shape::Curves(named) => named.len(),
            Shape::Surfaces(own) => own.len(),
            _ => 1,
        };
        if members > 1 {
            thing.facts.push(("members".to_owned(), members.to_string()));
        }
        thing.buffers = buffers.iter().map(row).collect();
        drawn.buffers.extend(buffers.into_iter().map(|buffer| (buffer.key.clone(), buffer)));
        drawn.things.push(thing);
    }
    if evaluated == Evaluated::Whole {
        now.fine = Some(fine);
    } else {
        // What is drawn later may still be as it was.
        let Kept { faces, meshes, fine } = std::mem::take(kept);
        now.fine = fine;
        for (name, before) in faces {
            now.faces.entry(name).or_insert(before);
        }
        now.meshes = meshes;
    }
    *kept = now;
    drawn
}

/// How far display triangles may be from surfaces of a model with this diagonal: as asked for, but not without end, and in steps, so that a
/// model that grows a little is not drawn anew.
fn fineness(asked: Option<f64>, diagonal: f64) -> f64 {
    let usual = FINE * diagonal;
    let wanted = asked.unwrap_or(usual).clamp(usual / FINEST, usual);
    // Its exponent alone is the power of two below it.
    let power = f64::from_bits(wanted.to_bits() & (0x7ff << 52));
    let between = power * std::f64::consts::SQRT_2;
    if wanted >= between { between } else { power }
}

fn row(buffer: &Buffer) -> BufferRow {
    BufferRow { key: buffer.key.clone(), bytes: buffer.bytes.len(), role: buffer.role.name() }
}

/// The declarations that can be drawn, in order of writing, `let`s last. A surface that a `let` names again is not drawn twice.
fn items(cx: &mut Cx, symbols: &[Symbol], evaluated: Evaluated) -> Vec<Item> {
    let values = cx.declared_values(symbols);
    let mut items: Vec<Item> = Vec::new();
    for value in values.iter().filter(|value| evaluated == Evaluated::Whole || value.keyword != Keyword::Mesh) {
        let chain: Vec<Place> = value.lines.iter().filter_map(|(file, span)| place(&cx.program.sources, *file, *span, None)).collect();
        add(cx, value, &value.name, &value.value, &chain, &mut items);
    }
    let known = |surface: &Surface, items: &[Item]| {
        items
            .iter()
            .any(|item| matches!(&item.shape, Shape::Surfaces(own) if item.thing.kind == "surface" && own.iter().any(|s| s.is(surface))))
    };
    let (lets, mut others): (Vec<Item>, Vec<Item>) = items.into_iter().partition(|item| item.thing.kind == "let");
    for mut item in lets {
        if let Shape::Surfaces(own) = &item.shape
            && own.iter().all(|surface| known(surface, &others))
        {
            continue;
        }
        item.thing.kind = if matches!(item.shape, Shape::Curves(_)) { "curve" } else { "surface" };
        others.push(item);
    }
    joined(others)
}

/// Adds a value, or the members of a list.
fn add(cx: &mut Cx, declared: &DeclaredValue, name: &str, value: &Value, chain: &[Place], out: &mut Vec<Item>) {
    let (is_let, is_group) = (declared.keyword == Keyword::Let, declared.keyword == Keyword::Group);
    let kind = |own: &'static str| if is_let { "let" } else { own };
    let (shape, kind, visible) = match value {
        Value::Vector(p, _) | Value::Node(p) if declared.keyword == Keyword::Point => {
            (Shape::Points(vec![(name.to_owned(), *p)]), "point", true)
        }
        Value::List(members) if is_group => (Shape::Group(members.to_vec()), "group", true),
        Value::Curve(line) => (Shape::Curves(vec![(name.to_owned(), line.clone())]), kind("curve"), !is_let),
        Value::Surface(surface) if surface.domain() != Domain::Unbounded => {
            (Shape::Surfaces(vec![surface.clone()]), kind("surface"), !is_let)
        }
        Value::Shell(shell) => (Shape::Shell(shell.clone()), "shell", true),
        Value::Mesh(mesh) => match cx.mesh(mesh) {
            Ok(mesh) => (Shape::Mesh(mesh), "mesh", false),
            Err(_) => return,
        },
        Value::List(members) => {
            for (k, member) in members.iter().enumerate() {
                add(cx, declared, &format!("{name}[{k}]"), member, chain, out);
            }
            return;
        }
        other => match other.part() {
            Some(part) => (Shape::Surfaces(part.faces.clone()), "surface", true),
            None => return,
        },
    };
    let of = match &shape {
        Shape::Group(members) => members.iter().map(|member| held::name(cx, member)).filter(|name| !name.is_empty()).collect(),
        Shape::Shell(shell) => shell.surfaces.iter().map(|surface| cx.surface_name(surface)).collect(),
        Shape::Mesh(mesh) => mesh.faces.iter().map(|face| face.name.clone()).collect::<BTreeSet<String>>().into_iter().collect(),
        _ => Vec::new(),
    };
    let surfaces = if is_group { held::surfaces(cx, value) } else { Vec::new() };
    let thing = Thing { name: name.to_owned(), kind, of, surfaces, chain: chain.to_vec(), visible, ..Thing::default() };
    out.push(Item { thing, shape, declaration: declared.declaration });
}

/// The box of everything.
fn around(items: &[Item]) -> Box3 {
    let of = |item: &Item| match &item.shape {
        Shape::Points(named) => Box3::of(named.iter().map(|(_, p)| *p)),
        Shape::Curves(named) => {
            let along =
                |(_, chain): &(String, Chain)| (0..SAMPLES).map(|k| chain.point(k as f64 / (SAMPLES - 1) as f64)).collect::<Vec<_>>();
            Box3::of(named.iter().flat_map(along))
        }
        Shape::Surfaces(own) => own.iter().map(crate::surface::bbox).fold(Box3::EMPTY, Box3::union),
        Shape::Mesh(mesh) => Box3::of(mesh.nodes.iter().copied()),
        Shape::Shell(shell) => shell.surfaces.iter().map(crate::surface::bbox).fold(Box3::EMPTY, Box3::union),
        Shape::Group(_) => Box3::EMPTY,
    };
    let finite = |own: &Box3| own.min.is_finite() && own.max.is_finite();
    items.iter().map(of).filter(finite).fold(Box3::EMPTY, Box3::union)
}

/// The surface model that holds all surfaces; `None` where it cannot be made.
fn scene(cx: &mut Cx, items: &[Item]) -> Option<Scene> {
    let surfaces: Vec<&Surface> =
        items.iter().flat_map(|item| if let Shape::Surfaces(own) = &item.shape { own.as_slice() } else { &[] }).collect();
    if surfaces.is_empty() {
        return None;
    }
    Scene::of(cx, ModuleId::MAIN, surfaces).ok()
}

/// Surfaces that are things of their own.
fn declared_surfaces(items: &[Item]) -> Vec<Surface> {
    items.iter().flat_map(|item| if let Shape::Surfaces(own) = &item.shape { own.clone() } else { Vec::new() }).collect()
}

fn curves(named: &[(String, Chain)], fine: f64, tolerance: &Tolerance) -> Option<Buffer> {
    let lines = par::map(named.len(), |k| {
        let (name, chain) = &named[k];
        Polyline { name: name.clone(), points: along(chain, fine, tolerance), length: chain.length(), count: 0 }
    });
    lines::buffer(Role::Lines, &lines)
}

/// The edges of a shell, and those of its surfaces that are nothing of their own; gives also the names of the others.
fn shell(
    cx: &mut Cx,
    shell: &ShellValue,
    declared: &[Surface],
    fine: f64,
    tolerance: &Tolerance,
    before: &Kept,
) -> Option<(KeptFaces, Vec<String>)> {
    let glued = cx.glued(ModuleId::MAIN, shell).ok()?;
    let (own, near) = (&glued.shell.surfaces, glued.shell.near);
    let is_bare = |id: SurfaceId| {
        let surface = &glued.scene.model.surfaces[id.index()].surface;
        !declared.iter().any(|known| known.is(surface))
    };
    let (bare, others): (Vec<(SurfaceId, bool)>, Vec<_>) = own.iter().copied().partition(|(id, _)| is_bare(*id));
    let others = others.iter().map(|(id, _)| glued.scene.model.surfaces[id.index()].name.clone()).collect();
    // Which of its surfaces are bare is a part of what it is drawn as.
    let mut now = KeptFaces::new(&shell.surfaces, own, &glued.scene, near, fine);
    now.patches.extend(bare.iter().map(|(id, flipped)| (*flipped, vec![[f64::from(id.0); 4]])));
    let drawn = now.drawn(before.faces.get(&*shell.name), || {
        let members: BTreeSet<SurfaceId> = own.iter().map(|(id, _)| *id).collect();
        let edges = faces::edges(&glued.scene, &members, near, fine, tolerance);
        let (skin, lost) = faces::triangles(&glued.scene, &bare, fine);
        (skin.into_iter().chain(edges).collect(), lost)
    });
    Some((drawn, others))
}

/// The buffers of each item that is a surface; what is as it was in the frame before is taken over.
fn surfaces(items: &[Item], scene: Option<&Scene>, fine: f64, tolerance: &Tolerance, before: &Kept) -> Vec<Option<KeptFaces>> {
    let of = |k: usize| {
        let (scene, Shape::Surfaces(own)) = (scene?, &items[k].shape) else { return None };
        let ids: Vec<(SurfaceId, bool)> = own.iter().filter_map(|surface| scene.find(surface)).collect();
        let near = scene.model.reach(ids.iter().map(|(id, _)| *id), None, tolerance);
        let now = KeptFaces::new(own, &ids, scene, near, fine);
        Some(now.drawn(before.faces.get(&items[k].thing.name), || {
            let members = ids.iter().map(|(id, _)| *id).collect();
            let edges = faces::edges(scene, &members, near, fine, tolerance);
            let (skin, lost) = faces::triangles(scene, &ids, fine);
            (skin.into_iter().chain(edges).collect(), lost)
        }))
    };
    par::map(items.len(), of)
}
