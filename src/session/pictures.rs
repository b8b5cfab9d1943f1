//! `picture`: from the things of a script to a scene, and from that to a file.

use std::collections::BTreeSet;
use std::io::Write;
use std::sync::Arc;

use super::disk::Outputs;
use super::export::write_file;
use super::flat_drawings;
use super::picture_combs;
use super::picture_names as names;
use super::picture_sheets;
use super::picture_things::{Things, around, corners, outline, scene_of, sort};
use super::report::OutputRow;
use super::shades;
use crate::base::bbox::Box3;
use crate::base::limits::FILE_WORK;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::base::work::{Budget, Exceeded};
use crate::draw::picture::{FORMATS, Format, Picture, Settings};
use crate::draw::{Kind, Line, Mark, Scene as Drawing, faces, lines, meshes};
use crate::io::files::fault::{FormatFault, OutputFault};
use crate::io::{Files, Sort, ending_for};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::Sound;
use crate::lang::eval::scene::Scene;
use crate::lang::values::plans::PictureSpec;
use crate::lang::values::value::ModuleId;
use crate::mesh::Mesh;
use crate::model::{SharedEdge, SurfaceId};
use crate::network::{LinkId, Network};

/// How far lines and triangles may be from what they show, pixels.
const FINE: f64 = 0.25;

/// What making the scene of a picture needs.
pub(super) struct PictureContext<'a> {
    pub scene: &'a Scene,
    pub sound: &'a Sound,
    pub tolerance: Tolerance,
    /// How far triangles and lines may be from what they show, model units.
    pub fine: f64,
}

impl PictureContext<'_> {
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
    within.unwrap_or_else(|Exceeded| Err(OutputFault::TooMuchWork { of: spec.origin, path: spec.path.clone() }.into()))
}

fn written(cx: &mut Cx, spec: &PictureSpec, model: &str, files: &dyn Files, outputs: Outputs) -> Result<OutputRow, Halt> {
    let format = format_of(spec)?;
    if let Some((drawing, page)) = flat_drawings::drawing(spec, model)? {
        if outputs == Outputs::Counted {
            return put(spec, &mut |_| Ok(()), files);
        }
        let picture = drawing.picture(&page);
        return put(spec, &mut |out| picture.write(format, out), files);
    }
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
    let context = PictureContext { scene: &scene, sound: &sound, tolerance, fine };
    let mut drawing = draw(cx, spec, &things, &context)?;
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
    let picture = match spec.views.as_slice() {
        [] => Picture::new(&drawing, &settings, format),
        views => picture_sheets::sheet(views, &drawing, &settings, format),
    };
    put(spec, &mut |out| picture.write(format, out), files)
}

pub(super) fn unsupported(of: Origin, what: &str, help: &str) -> Halt {
    FormatFault::Unsupported { of, what: what.to_owned(), help: Some(help.to_owned()), edits: Vec::new() }.into()
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
    let bytes = write_file(spec.path_origin, &spec.path, files, fill)?;
    Ok(OutputRow { path: spec.path.clone(), bytes, ..OutputRow::default() })
}

/// The scene of a picture.
fn draw(cx: &mut Cx, spec: &PictureSpec, things: &Things, context: &PictureContext) -> Result<Drawing, Halt> {
    let mut drawing = Drawing::default();
    let (model, fine) = (&context.scene.model, context.fine);
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
            add_edge(&mut drawing, scene, &scene.model.whole_edge(edge), context);
        }
    }
    let borders = spec.show.borders.unwrap_or(true);
    if borders && !drawn.is_empty() {
        let near = things.near.max(model.reach(drawn.iter().copied(), None, &context.tolerance));
        drawing.lines.extend(lines::borders(model, &context.scene.network, &drawn, near, fine, &context.tolerance));
    }
    let meshes = latest(&things.meshes);
    let meshes: Vec<&(Arc<Mesh>, BTreeSet<&str>)> =
        meshes.iter().filter(|(m, _)| !of_surfaces || !drawn_as_surface(m, context, &drawn)).collect();
    let folds = if borders { folds(&meshes, things.near, context) } else { lines::Folds::default() };
    for (mesh, left_out) in &meshes {
        let part = if left_out.is_empty() { mesh.clone() } else { Arc::new(meshes::without(mesh, left_out)) };
        drawing.sheets.extend(shades::mesh_sheets(spec, &part));
        drawing.lines.extend(meshes::lines(mesh, &folds, left_out).into_iter().filter(|l| borders || l.kind == Kind::Curve));
        drawing.marks.extend(mesh.points.iter().map(|n| Mark { at: mesh.nodes[*n as usize], node: false }));
    }
    for (_, chain) in &things.curves {
        drawing.lines.push(Line { kind: Kind::Curve, points: lines::chain(chain, fine, &context.tolerance) });
    }
    things.edges.iter().for_each(|(scene, edge)| add_edge(&mut drawing, scene, edge, context));
    drawing.marks.extend(things.points.iter().map(|(_, at)| Mark { at: *at, node: false }));
    if let Some(network) = context.network(spec, things) {
        add_network(&mut drawing, network, context);
    }
    drawing.lines.retain(|line| line.points.len() > 1);
    shades::paint(cx, spec, &mut drawing)?;
    picture_combs::add(spec, things, context, cx.unit().name, &mut drawing)?;
    names::add(spec, things, context, &mut drawing);
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
fn folds(meshes: &[&(Arc<Mesh>, BTreeSet<&str>)], near: f64, context: &PictureContext) -> lines::Folds {
    let model = &context.scene.model;
    let names: BTreeSet<&str> = meshes.iter().flat_map(|(mesh, _)| &mesh.faces).map(|face| face.name.as_str()).collect();
    let own = (0..model.surfaces.len()).map(SurfaceId::at);
    let members: BTreeSet<SurfaceId> = own.filter(|id| names.contains(model.surfaces[id.index()].name.as_str())).collect();
    let near = near.max(model.reach(members.iter().copied(), None, &context.tolerance));
    lines::Folds::new(model, &context.scene.network, &members, near, &context.tolerance)
}

fn drawn_as_surface(mesh: &Mesh, context: &PictureContext, drawn: &BTreeSet<SurfaceId>) -> bool {
    let name = |id: &SurfaceId| context.scene.model.surfaces[id.index()].name.as_str();
    mesh.faces.iter().any(|face| drawn.iter().any(|id| name(id) == face.name))
}

fn add_edge(drawing: &mut Drawing, scene: &Scene, edge: &SharedEdge, context: &PictureContext) {
    let Some(track) = scene.model.shared_track(edge, &scene.network) else { return };
    let (whole, s) = track.whole();
    drawing.lines.push(Line { kind: Kind::Border, points: lines::track(whole, s, context.fine) });
}

/// Links and nodes of the whole network.
fn add_network(drawing: &mut Drawing, network: &Network, context: &PictureContext) {
    for k in 0..network.links.len() {
        let chain = network.link_chain(LinkId::at(k));
        drawing.lines.push(Line { kind: Kind::Curve, points: lines::chain(&chain, context.fine, &context.tolerance) });
    }
    drawing.marks.extend(network.nodes.iter().map(|node| Mark { at: node.point, node: true }));
}
