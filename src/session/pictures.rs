//! `picture`: from the things of a script to a scene, and from that to a file.

use std::collections::BTreeSet;
use std::io::Write;
use std::sync::Arc;

use glam::DVec3;

use super::consumed;
use super::disk::Outputs;
use super::picture_names as names;
use super::picture_paths::{ASKED, is_name};
use super::report::OutputRow;
use super::run::Wanted;
use super::shades;
use crate::base::bbox::Box3;
use crate::base::limits::FILE_WORK;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::base::work::{Budget, Exceeded};
use crate::draw::picture::{FORMATS, Format, Picture, Settings};
use crate::draw::{Kind, Line, Mark, Scene as Drawing, faces, lines, meshes};
use crate::geometry::Curve;
use crate::io::files::fault::FileFault;
use crate::io::{FileError, Files, Sort, ending_for};
use crate::lang::diag::diagnostic::Diagnostic;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::Sound;
use crate::lang::eval::scene::Scene;
use crate::lang::values::plans::{PictureSpec, Show};
use crate::lang::values::value::{Home, MeshValue, ModuleId, Value};
use crate::mesh::Mesh;
use crate::model::SurfaceId;
use crate::network::chain::same_curve;
use crate::network::{Chain, Network};
use crate::surface::{Domain, Surface};

/// How far lines and triangles may be from what they show, pixels.
const FINE: f64 = 0.25;
/// Places of a curve that its box is taken from.
const MAX_SAMPLES: usize = 33;
/// Share of the model around a point that `zoom:` shows.
const AROUND: f64 = 0.05;

/// What a picture draws, sorted out.
#[derive(Default)]
pub(super) struct Things {
    /// Surfaces of shells and by themselves, each with `true` for its other side.
    pub surfaces: Vec<(SurfaceId, bool)>,
    /// Patches by themselves.
    pub patches: Vec<(Scene, crate::model::PatchId)>,
    /// Meshes, those that the script declares with `true`.
    pub meshes: Vec<(Arc<Mesh>, bool)>,
    /// Curves, links and edges with their names.
    pub curves: Vec<(String, Chain)>,
    /// Edges that no curve carries.
    pub edges: Vec<(Scene, std::sync::Arc<crate::model::SharedEdge>)>,
    /// Points with their names, empty where they have none.
    pub points: Vec<(String, DVec3)>,
    /// A whole network.
    pub network: Option<Arc<Network>>,
    /// How far apart edges of the shells may be and still be one, model units.
    pub near: f64,
}

/// Everything that making a scene asks.
pub(super) struct Stage<'a> {
    pub scene: &'a Scene,
    pub sound: &'a Sound,
    pub tolerance: Tolerance,
    /// How far triangles and lines may be from what they show, model units.
    pub fine: f64,
}

impl Stage<'_> {
    /// The network that is drawn with nodes and names, if any.
    pub(super) fn network<'t>(&'t self, spec: &PictureSpec, things: &'t Things) -> Option<&'t Network> {
        let named = things.network.as_deref();
        match spec.show.network {
            Some(false) => None,
            Some(true) => Some(named.unwrap_or(&self.sound.network)),
            None => named,
        }
    }
}

/// Writes one picture; gives its row. `model` is the name of the script without its ending.
pub fn write(cx: &mut Cx, spec: &PictureSpec, model: &str, files: &dyn Files, outputs: Outputs) -> Result<OutputRow, Halt> {
    let within = Budget::new(FILE_WORK).within(|| written(cx, spec, model, files, outputs));
    within.unwrap_or_else(|Exceeded| Err(FileFault::TooMuchWork { of: spec.origin, path: spec.path.clone() }.into()))
}

fn written(cx: &mut Cx, spec: &PictureSpec, model: &str, files: &dyn Files, outputs: Outputs) -> Result<OutputRow, Halt> {
    let format = format_of(spec)?;
    let tolerance = cx.tolerance()?;
    let sound = cx.sound(ModuleId::MAIN)?;
    let scene = scene_of(cx, spec, &sound)?;
    let things = sort(cx, &spec.things, &scene, tolerance)?;
    let focus = match spec.zoom.as_slice() {
        [] => Vec::new(),
        zoom => outline(&sort(cx, zoom, &scene, tolerance)?, &scene),
    };
    let everything = Box3::of(outline(&things, &scene));
    let shown = if focus.is_empty() { everything } else { around(&focus, &everything) };
    let pixels = f64::from(spec.size.0.min(spec.size.1));
    let fine = FINE * shown.diagonal().max(tolerance.point) / pixels;
    let stage = Stage { scene: &scene, sound: &sound, tolerance, fine };
    let mut drawing = draw(cx, spec, &things, &stage)?;
    if !focus.is_empty() {
        drawing.focus = corners(&shown);
    }
    let nothing = drawing.sheets.iter().all(|s| s.triangles.is_empty()) && drawing.lines.is_empty() && drawing.marks.is_empty();
    if nothing {
        return Err(unsupported(spec.origin, "there is nothing to draw", "name surfaces, meshes, curves or points"));
    }
    let settings = settings(cx, spec, model);
    if outputs == Outputs::Counted {
        // What could go wrong did not; pixels are for files.
        return put(spec, &mut |_| Ok(()), files);
    }
    let picture = Picture::new(&drawing, &settings, format);
    put(spec, &mut |out| picture.write(format, out), files)
}

fn unsupported(of: Origin, what: &str, help: &str) -> Halt {
    FileFault::Unsupported { of, what: what.to_owned(), help: Some(help.to_owned()), edits: Vec::new() }.into()
}

fn format_of(spec: &PictureSpec) -> Result<Format, Halt> {
    let ending = ending_for(spec.path_origin, &spec.path, Sort::Pictures)?;
    let known = FORMATS.iter().find(|(name, _)| *name == ending);
    Ok(known.ok_or(Halt::Bug("an ending of pictures without a format"))?.1)
}

fn settings(cx: &Cx, spec: &PictureSpec, model: &str) -> Settings {
    let said = |flag: Option<bool>| flag.unwrap_or(true);
    let title = match &spec.title {
        Some(title) => title.to_string(),
        None if spec.named.is_empty() || spec.named == model => model.to_owned(),
        None => format!("{model}: {}", spec.named),
    };
    Settings {
        view: spec.view,
        width: spec.size.0 as usize,
        height: spec.size.1 as usize,
        title,
        unit: cx.unit().name.to_owned(),
        edges: said(spec.show.elements),
        axes: said(spec.show.axes),
        ruler: said(spec.show.ruler),
        legend: said(spec.show.legend),
    }
}

fn put(spec: &PictureSpec, fill: &mut dyn FnMut(&mut dyn Write) -> std::io::Result<()>, files: &dyn Files) -> Result<OutputRow, Halt> {
    let (of, path) = (spec.path_origin, spec.path.clone());
    match files.write(&spec.path, fill) {
        Ok(bytes) => Ok(OutputRow { path, bytes, ..OutputRow::default() }),
        Err(FileError::Outside) => Err(FileFault::Outside { of, path }.into()),
        Err(FileError::Other(why)) => Err(FileFault::CannotWrite { of, path, why }.into()),
        Err(_) => Err(FileFault::CannotWrite { of, path, why: "the system refuses it".to_owned() }.into()),
    }
}

fn surfaces_of(value: &Value) -> Vec<&Surface> {
    match value {
        Value::Surface(surface) => vec![surface],
        Value::Shell(shell) => shell.surfaces.iter().collect(),
        _ => Vec::new(),
    }
}

/// The surface model with everything that is drawn or zoomed to in it.
fn scene_of(cx: &mut Cx, spec: &PictureSpec, sound: &Sound) -> Result<Scene, Halt> {
    let base = Scene { model: sound.model.clone(), network: sound.network.clone() };
    let values = spec.things.iter().chain(&spec.zoom);
    let surfaces: Vec<&Surface> = values.flat_map(|(value, _)| surfaces_of(value)).collect();
    base.with(cx, surfaces)
}

/// Sorts values out by what they are.
fn sort(cx: &mut Cx, values: &[(Value, Origin)], scene: &Scene, tolerance: Tolerance) -> Result<Things, Halt> {
    let (mut things, mut imported) = (Things::default(), names::Imported::default());
    for (value, origin) in values {
        match value {
            Value::Surface(surface) if surface.domain() == Domain::Unbounded => {
                return Err(unsupported(*origin, "a plane without borders cannot be drawn", "draw `plane(curves)`"));
            }
            Value::Surface(surface) => things.surfaces.extend(scene.find_all([surface])?),
            // A shell that is none (in pieces, one-sided) shows its surfaces as they are.
            Value::Shell(shell) => things.surfaces.extend(match scene.shell(shell, &tolerance, &mut Vec::new()) {
                Ok(built) => {
                    things.near = things.near.max(built.near);
                    built.surfaces
                }
                Err(_) => scene.find_all(&shell.surfaces)?,
            }),
            Value::Mesh(mesh) => things.meshes.push((cx.mesh(mesh)?, matches!(**mesh, MeshValue::Declared { .. }))),
            Value::Patch(home, patch) => things.patches.push((own(cx, home)?, *patch)),
            Value::Curve(chain) => things.curves.push((imported.name(cx, chain), chain.clone())),
            Value::Link(module, link) => {
                let network = cx.network(*module)?;
                things.curves.push((names::of_link(&network, *link), network.link_chain(*link)));
            }
            Value::Edge(home, edge) => things.edges.push((own(cx, home)?, edge.clone())),
            Value::Vertex(home, vertex) => {
                let point = cx.model(home)?.vertices[vertex.index()].point;
                things.points.push((String::new(), point));
            }
            Value::Node(p) | Value::Vector(p, _) => things.points.push((String::new(), *p)),
            Value::Network(module) => things.network = Some(cx.sound(*module)?.network),
            _ => {}
        }
    }
    things.surfaces.sort_unstable_by_key(|s| s.0);
    things.surfaces.dedup_by_key(|s| s.0);
    Ok(things)
}

/// The surface model that edges and patches of a script are numbered in.
fn own(cx: &mut Cx, home: &Home) -> Result<Scene, Halt> {
    Ok(Scene { model: cx.model(home)?, network: cx.network_of(home)? })
}

/// Points that things lie between, for framing them.
fn outline(things: &Things, scene: &Scene) -> Vec<DVec3> {
    let mut out: Vec<DVec3> = Vec::new();
    let of_surface = |id: &SurfaceId| corners(&crate::surface::bbox(&scene.model.surfaces[id.index()].surface));
    things.surfaces.iter().for_each(|(id, _)| out.extend(of_surface(id)));
    for (scene, patch) in &things.patches {
        let patch = &scene.model.patches[patch.index()];
        let surface = &scene.model.surfaces[patch.surface.index()].surface;
        let at = |(low, high): (f64, f64), k: usize| low + (high - low) * k as f64 / 8.0;
        out.extend((0..81).map(|k| surface.point(at(patch.u, k % 9), at(patch.v, k / 9))));
    }
    things.meshes.iter().for_each(|(mesh, _)| out.extend(corners(&Box3::of(mesh.nodes.iter().copied()))));
    let mut along = |chain: &Chain| out.extend((0..MAX_SAMPLES).map(|k| chain.point(k as f64 / (MAX_SAMPLES - 1) as f64)));
    things.curves.iter().for_each(|(_, chain)| along(chain));
    if let Some(network) = &things.network {
        network.curves.iter().for_each(|c| along(&Chain::of_curve(&c.curve)));
    }
    for (scene, edge) in &things.edges {
        let Some(track) = scene.model.shared_track(edge, &scene.network) else { continue };
        out.extend((0..MAX_SAMPLES).map(|k| track.point(track.length() * k as f64 / (MAX_SAMPLES - 1) as f64)));
    }
    out.extend(things.points.iter().map(|p| p.1));
    out
}

fn corners(around: &Box3) -> Vec<DVec3> {
    if around.is_empty() {
        return Vec::new();
    }
    around.corners().to_vec()
}

/// The box of what is zoomed to; around a point a part of the model.
fn around(focus: &[DVec3], everything: &Box3) -> Box3 {
    let own = Box3::of(focus.iter().copied());
    let least = AROUND * everything.diagonal();
    if own.diagonal() >= least {
        return own;
    }
    let half = DVec3::splat(0.5 * least);
    Box3 { min: own.center() - half, max: own.center() + half }
}

/// The scene of a picture.
fn draw(cx: &mut Cx, spec: &PictureSpec, things: &Things, stage: &Stage) -> Result<Drawing, Halt> {
    let mut drawing = Drawing::default();
    let (model, fine) = (&stage.scene.model, stage.fine);
    let covered: BTreeSet<&str> = things.meshes.iter().flat_map(|(m, _)| &m.faces).map(|f| f.name.as_str()).collect();
    let is_covered = |id: SurfaceId| covered.contains(model.surfaces[id.index()].name.as_str());
    let of_surfaces = shades::is_of_surfaces(spec);
    // What is meshed and drawn as a mesh is not drawn twice.
    let bare: Vec<(SurfaceId, bool)> = things.surfaces.iter().copied().filter(|(id, _)| of_surfaces || !is_covered(*id)).collect();
    let drawn: BTreeSet<SurfaceId> = bare.iter().map(|s| s.0).collect();
    let show = shades::of_faces(spec);
    bare.iter().for_each(|(id, flipped)| drawing.sheets.extend(faces::surface(model, *id, *flipped, fine, show)));
    for (scene, id) in &things.patches {
        let patch = &scene.model.patches[id.index()];
        let named = &scene.model.surfaces[patch.surface.index()];
        let mut sheet = faces::patch(&named.surface, patch, fine, show);
        sheet.name = named.name.clone();
        drawing.sheets.push(sheet);
        for edge in scene.model.edges_of(&[*id]) {
            add_edge(&mut drawing, scene, &scene.model.whole_edge(edge), stage);
        }
    }
    let borders = spec.show.borders.unwrap_or(true);
    if borders && !drawn.is_empty() {
        let near = things.near.max(model.reach(drawn.iter().copied(), None, &stage.tolerance));
        drawing.lines.extend(lines::borders(model, &stage.scene.network, &drawn, near, fine, &stage.tolerance));
    }
    let meshes = latest(&things.meshes);
    let meshes: Vec<&(Arc<Mesh>, BTreeSet<&str>)> =
        meshes.iter().filter(|(m, _)| !of_surfaces || !drawn_as_surface(m, stage, &drawn)).collect();
    let folds = if borders { folds(&meshes, things.near, stage) } else { lines::Folds::default() };
    for (mesh, left_out) in &meshes {
        let part = if left_out.is_empty() { mesh.clone() } else { Arc::new(meshes::without(mesh, left_out)) };
        drawing.sheets.extend(shades::mesh_sheets(spec, &part));
        drawing.lines.extend(meshes::lines(mesh, &folds, left_out).into_iter().filter(|l| borders || l.kind == Kind::Curve));
        drawing.marks.extend(mesh.points.iter().map(|n| Mark { at: mesh.nodes[*n as usize], node: false }));
    }
    for (_, chain) in &things.curves {
        drawing.lines.push(Line { kind: Kind::Curve, points: lines::chain(chain, fine, &stage.tolerance) });
    }
    things.edges.iter().for_each(|(scene, edge)| add_edge(&mut drawing, scene, edge, stage));
    drawing.marks.extend(things.points.iter().map(|(_, at)| Mark { at: *at, node: false }));
    if let Some(network) = stage.network(spec, things) {
        add_network(&mut drawing, network, stage);
    }
    drawing.lines.retain(|line| line.points.len() > 1);
    shades::paint(cx, spec, &mut drawing)?;
    names::add(spec, things, stage, &mut drawing);
    Ok(drawing)
}

/// Meshes that are drawn, each with the names of its faces that a later mesh of the script shows as well: of those the last one is seen.
fn latest(meshes: &[(Arc<Mesh>, bool)]) -> Vec<(Arc<Mesh>, BTreeSet<&str>)> {
    let mut later: BTreeSet<&str> = BTreeSet::new();
    let mut out = Vec::new();
    for (mesh, declared) in meshes.iter().rev() {
        let own = || mesh.faces.iter().map(|face| face.name.as_str());
        // A mesh that was moved lies elsewhere.
        let left_out: BTreeSet<&str> = own().filter(|name| *declared && later.contains(name)).collect();
        if *declared {
            later.extend(own());
        }
        if mesh.faces.is_empty() || own().any(|name| !left_out.contains(name)) {
            out.push((mesh.clone(), left_out));
        }
    }
    out.reverse();
    out
}

/// Where the surfaces of meshes fold.
fn folds(meshes: &[&(Arc<Mesh>, BTreeSet<&str>)], near: f64, stage: &Stage) -> lines::Folds {
    let model = &stage.scene.model;
    let names: BTreeSet<&str> = meshes.iter().flat_map(|(mesh, _)| &mesh.faces).map(|face| face.name.as_str()).collect();
    let own = (0..model.surfaces.len()).map(SurfaceId::at);
    let members: BTreeSet<SurfaceId> = own.filter(|id| names.contains(model.surfaces[id.index()].name.as_str())).collect();
    let near = near.max(model.reach(members.iter().copied(), None, &stage.tolerance));
    lines::Folds::new(model, &stage.scene.network, &members, near, &stage.tolerance)
}

fn drawn_as_surface(mesh: &Mesh, stage: &Stage, drawn: &BTreeSet<SurfaceId>) -> bool {
    let name = |id: &SurfaceId| stage.scene.model.surfaces[id.index()].name.as_str();
    mesh.faces.iter().any(|face| drawn.iter().any(|id| name(id) == face.name))
}

fn add_edge(drawing: &mut Drawing, scene: &Scene, edge: &crate::model::SharedEdge, stage: &Stage) {
    let Some(track) = scene.model.shared_track(edge, &scene.network) else { return };
    let (whole, s) = track.whole();
    drawing.lines.push(Line { kind: Kind::Border, points: lines::track(whole, s, stage.fine) });
}

/// Links and nodes of the whole network.
fn add_network(drawing: &mut Drawing, network: &Network, stage: &Stage) {
    for k in 0..network.links.len() {
        let chain = network.link_chain(crate::network::LinkId::at(k));
        drawing.lines.push(Line { kind: Kind::Curve, points: lines::chain(&chain, stage.fine, &stage.tolerance) });
    }
    drawing.marks.extend(network.nodes.iter().map(|node| Mark { at: node.point, node: true }));
}

/// What a command line asks for: some names of the script, or everything it declares.
///
/// Everything is its meshes, of each surface the last one, the surfaces that none of them covers but those that a part was cut from, and
/// its curves; without faces the network.
pub fn request(cx: &mut Cx, wanted: &Wanted) -> Result<PictureSpec, Box<Diagnostic>> {
    let mut spec = wanted.spec.clone();
    let mut asked = 0;
    spec.things = values_of(cx, &wanted.names, &mut asked)?;
    spec.zoom = values_of(cx, &wanted.zoom, &mut asked)?;
    spec.named = wanted.names.join(", ");
    if wanted.names.is_empty() {
        everything(cx, &mut spec);
    }
    Ok(spec)
}

/// Things by their names and paths in the script, `asked` paths of which were met before; E201 for one that is not declared, E805 for one that cannot be drawn.
fn values_of(cx: &mut Cx, names: &[String], asked: &mut usize) -> Result<Vec<(Value, Origin)>, Box<Diagnostic>> {
    let mut out = Vec::new();
    for name in names {
        if name == "network" {
            out.push((Value::Network(ModuleId::MAIN), Origin::NONE));
            continue;
        }
        let hidden = (!is_name(name)).then(|| {
            *asked += 1;
            format!("{ASKED}{}", *asked - 1)
        });
        let Some(value) = cx.value_of(hidden.as_ref().unwrap_or(name)) else {
            let failed = hidden.is_some() || cx.program.names.find(name).is_some();
            let text = if failed { format!("`{name}` has no value to draw") } else { format!("`{name}` is not defined") };
            return Err(Diagnostic::without_place("E201", text).help("a name that the script declares, or `network`").into());
        };
        let before = out.len();
        let _ = value.for_each_flat::<()>(&mut |v| {
            if is_drawn(v) {
                out.push((v.clone(), Origin::NONE));
            }
            Ok(())
        });
        if out.len() == before {
            return Err(Diagnostic::without_place("E805", format!("`{name}` is {}, which cannot be drawn", value.ty().words())).into());
        }
    }
    Ok(out)
}

fn is_drawn(value: &Value) -> bool {
    use Value as V;
    let faces = matches!(value, V::Surface(_) | V::Shell(_) | V::Mesh(_) | V::Patch(..));
    faces || matches!(value, V::Curve(_) | V::Link(..) | V::Edge(..) | V::Vertex(..) | V::Vector(..) | V::Node(_))
}

fn everything(cx: &mut Cx, spec: &mut PictureSpec) {
    let mut covered: BTreeSet<String> = BTreeSet::new();
    for (_, value) in cx.mesh_values() {
        // A mesh that cannot be made was reported; its surfaces are drawn.
        let Ok(mesh) = cx.mesh(&value) else { continue };
        covered.extend(mesh.faces.iter().map(|face| face.name.clone()));
        spec.things.push((Value::Mesh(Arc::new(value)), Origin::NONE));
    }
    let Ok(sound) = cx.sound(ModuleId::MAIN) else { return };
    let consumed = consumed::surfaces(cx, &sound);
    let is_drawn = |s: &Surface, name: &str| s.domain() != Domain::Unbounded && !covered.contains(name) && !consumed.contains(name);
    let surfaces = sound.parts.surfaces.iter().filter(|s| is_drawn(&s.value, &s.name));
    spec.things.extend(surfaces.map(|s| (Value::Surface(s.value.clone()), Origin::NONE)));
    let faces = !spec.things.is_empty();
    if faces {
        // The borders of faces show the curves that carry them.
        let carried: Vec<&Curve> =
            sound.parts.surfaces.iter().flat_map(|s| s.value.chains()).flat_map(Chain::runs).map(|run| &run.curve).collect();
        let is_free = |chain: &Chain| chain.runs().iter().all(|run| !carried.iter().any(|c| same_curve(c, &run.curve)));
        let free = sound.parts.curves.iter().filter(|c| is_free(&c.value));
        spec.things.extend(free.map(|c| (Value::Curve(c.value.clone()), Origin::NONE)));
        spec.show = Show { labels: spec.show.labels.or(Some(false)), ..spec.show };
    } else {
        spec.things.push((Value::Network(ModuleId::MAIN), Origin::NONE));
        spec.things.extend(sound.parts.points.iter().map(|p| (Value::point(p.value), Origin::NONE)));
    }
}
