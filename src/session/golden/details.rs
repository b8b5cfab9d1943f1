//! What golden lines hold beyond the rows of the report: where everything is, which side it shows, what is asked of meshes.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::contents::Contents;
use super::line::Line;
use super::line_builder::{LineBuilder, line};
use super::requests;
use super::values::Value;
use super::words::{Measure, unit_of};
use crate::base::bbox::Box3;
use crate::base::math::compare_points;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::Sound;
use crate::lang::values::value::{ModuleId, ShellValue};
use crate::mesh::{Group, Mesh};
use crate::model::Moments;
use crate::network::Chain;
use crate::session::collect;
use crate::session::report::Table;

/// Words and values of a line.
pub type Pairs = Vec<(&'static str, Value)>;

/// What a line holds beyond its row of the report.
#[derive(Clone, Debug, Default)]
pub struct Detail {
    /// The thing has no name.
    pub unnamed: bool,
    /// Words and values.
    pub pairs: Pairs,
}

/// What the lines of a golden hold beyond the report.
#[derive(Clone, Debug, Default)]
pub struct Details {
    /// Of each curve, in the order of the report.
    pub curves: Vec<Detail>,
    /// Of each modeling curve.
    pub modeling: Vec<Detail>,
    /// Of each surface.
    pub surfaces: Vec<Detail>,
    /// Of shells by name.
    pub shells: BTreeMap<String, Pairs>,
    /// Of meshes by name.
    pub meshes: BTreeMap<String, Pairs>,
    /// Names that the script declares.
    pub declared: BTreeSet<String>,
    /// Of each check.
    pub checks: Vec<Detail>,
    /// Whether each report has a label.
    pub labelled: Vec<bool>,
    /// Lines of points.
    pub points: Vec<Line>,
    /// Lines of groups.
    pub groups: Vec<Line>,
    /// Lines of what is asked of meshes.
    pub settings: Vec<Line>,
    /// Lines of what meshes hold, by mesh.
    pub sets: Vec<Line>,
    /// Tables that are exported, by path.
    pub exported: Vec<(String, Table)>,
    /// Lines of exports and pictures.
    pub outputs: Vec<Line>,
}

/// Of an evaluated model.
pub fn of(cx: &mut Cx) -> Details {
    let mut details = Details::default();
    let Some(tolerance) = cx.tolerance_used() else { return details };
    let unit = cx.unit().name;
    if let Ok(sound) = cx.sound(ModuleId::MAIN) {
        let Sound { parts, network, model, .. } = &sound;
        details.points = parts.points.iter().map(|p| line("point", &p.name).put("at", point(p.value, unit)).0).collect();
        let names = |names: Vec<&str>| names.into_iter().map(str::to_owned).collect::<BTreeSet<String>>();
        let curves = names(parts.curves.iter().map(|c| &*c.name).collect());
        let modeling = names(parts.modeling.iter().map(|c| &*c.name).collect());
        details.declared.extend(curves.iter().cloned());
        details.declared.extend(names(parts.surfaces.iter().map(|s| &*s.name).collect()));
        let order = collect::curves_in_order(parts, network);
        details.curves = par::map(order.len(), |k| {
            let curve = &network.curves[order[k]];
            let whole = Chain::of_curve(&curve.curve);
            let mut detail = of_chain(&whole, &Moments::of_curve(&curve.curve), !curves.contains(&curve.name), &tolerance, unit);
            detail.pairs.extend(of_box(curve.curve.bbox(), unit));
            detail
        });
        let chains = collect::chains(cx, parts, network, &tolerance);
        details.modeling = par::map(chains.len(), |k| {
            let (name, _, chain) = &chains[k];
            let declared = modeling.contains(name) || curves.contains(name);
            of_chain(chain, &Moments::of_chain(chain), !declared, &tolerance, unit)
        });
        let order = collect::surfaces_in_order(parts, model);
        details.surfaces = par::map(order.len(), |k| {
            let moments = Moments::of_surface(&model.surfaces[order[k]].surface);
            Detail { unnamed: false, pairs: of_sheet(&moments, unit) }
        });
    }
    for shell in cx.shells(ModuleId::MAIN).unwrap_or_default() {
        details.declared.insert(shell.name.to_string());
        if let Ok(moments) = of_shell(cx, &shell.value) {
            details.shells.insert(shell.name.to_string(), of_sheet(&moments, unit));
        }
    }
    for group in cx.groups(ModuleId::MAIN).unwrap_or_default() {
        details.declared.insert(group.name.to_string());
        let contents = Contents::of(cx, &group.value);
        details.groups.push(line("group", &group.name).all(contents.pairs(unit)).0);
    }
    for (name, value) in cx.mesh_values() {
        details.declared.insert(name.to_string());
        if let Ok(mesh) = cx.mesh(&value) {
            details.meshes.insert(name.to_string(), of_mesh(&mesh, unit));
            let sets = mesh.groups.iter().map(|group| of_set(&mesh, group, &name, unit, details.declared.contains(&group.name)));
            details.sets.extend(sets);
        }
    }
    requests::all(cx, &mut details);
    details
}

/// A place.
pub fn point(p: DVec3, unit: &str) -> Value {
    list(&p.to_array(), 1, unit)
}

fn list(all: &[f64], power: u8, unit: &str) -> Value {
    Value::List(all.to_vec(), unit_of(Measure::Length(power), unit))
}

/// The box of something, where it has one.
pub fn of_box(bounds: Box3, unit: &str) -> Option<(&'static str, Value)> {
    collect::corners(bounds).map(|corners| ("box", Value::Corners(corners, unit.to_owned())))
}

/// Where the mass is.
pub fn of_mass(moments: &Moments, unit: &str) -> Pairs {
    let Some(centroid) = moments.centroid() else { return Vec::new() };
    let (spread, skew) = (list(&moments.spread(), 2, unit), list(&moments.skew().to_array(), 3, unit));
    vec![("centroid", point(centroid, unit)), ("spread", spread), ("skew", skew)]
}

/// Where faces are, and which side they show.
fn of_sheet(moments: &Moments, unit: &str) -> Pairs {
    let mut pairs = of_mass(moments, unit);
    if let Some(centroid) = moments.centroid() {
        pairs.push(("side", list(&moments.side.to_array(), 2, unit)));
        let inside = moments.about(centroid).inside;
        pairs.push(("inside", Value::Real(inside, unit_of(Measure::Length(3), unit))));
    }
    pairs
}

/// Where a curve runs. One without a name has no direction of its own.
fn of_chain(chain: &Chain, moments: &Moments, unnamed: bool, tolerance: &Tolerance, unit: &str) -> Detail {
    let (mut ends, mut round) = ([chain.start(), chain.end()], moments.side);
    let mut pairs = of_mass(moments, unit);
    if chain.is_closed(tolerance) {
        let most = round.abs().max_element();
        let first = round.to_array().into_iter().find(|x| x.abs() > 0.5 * most);
        if unnamed && first.is_some_and(|x| x < 0.0) {
            round = -round;
        }
        pairs.extend([("from", point(ends[0], unit)), ("round", list(&round.to_array(), 2, unit))]);
    } else {
        if unnamed {
            ends.sort_by(|a, b| compare_points(*a, *b));
        }
        pairs.extend([("from", point(ends[0], unit)), ("to", point(ends[1], unit))]);
    }
    Detail { unnamed, pairs }
}

fn of_shell(cx: &mut Cx, shell: &ShellValue) -> Result<Moments, Halt> {
    let faces = cx.glued(ModuleId::MAIN, shell)?.faces();
    let parts = par::map(faces.len(), |k| {
        let (surface, other) = &faces[k];
        let moments = Moments::of_surface(surface);
        if *other { moments.flipped() } else { moments }
    });
    Ok(Moments::total(parts))
}

/// Area vector of some elements, and a third of the volume between them and a point.
fn sides(mesh: &Mesh, triangles: impl Iterator<Item = u32>, quads: impl Iterator<Item = u32>, about: DVec3) -> (DVec3, f64) {
    let (mut side, mut inside) = (DVec3::ZERO, 0.0);
    let mut add = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|n| mesh.nodes[n as usize] - about);
        let n = (b - a).cross(c - a) * 0.5;
        side += n;
        inside += a.dot(n) / 3.0;
    };
    triangles.for_each(|k| add(mesh.triangles[k as usize]));
    quads.for_each(|k| {
        let [a, b, c, d] = mesh.quads[k as usize];
        add([a, b, c]);
        add([a, c, d]);
    });
    (side, inside)
}

/// Where the nodes of a mesh are, and which side its faces show.
fn of_mesh(mesh: &Mesh, unit: &str) -> Pairs {
    let nodes = Moments::of_points(mesh.nodes.iter().copied());
    let mut pairs = of_mass(&nodes, unit);
    pairs.extend(of_box(Box3::of(mesh.nodes.iter().copied()), unit));
    if let Some(centroid) = nodes.centroid()
        && mesh.triangles.len() + mesh.quads.len() > 0
    {
        let (side, inside) = sides(mesh, 0..mesh.triangles.len() as u32, 0..mesh.quads.len() as u32, centroid);
        pairs.push(("side", list(&side.to_array(), 2, unit)));
        pairs.push(("inside", Value::Real(inside, unit_of(Measure::Length(3), unit))));
    }
    pairs
}

/// What a mesh holds under a name.
fn of_set(mesh: &Mesh, group: &Group, name: &str, unit: &str, declared: bool) -> Line {
    let places = group.nodes.iter().map(|n| mesh.nodes[*n as usize]);
    let elements = group.lines.len() + group.triangles.len() + group.quads.len();
    let made: LineBuilder = line("set", &format!("{name} {}", group.name)).count("nodes", group.nodes.len()).count("elements", elements);
    let mut made = made.all(of_mass(&Moments::of_points(places.clone()), unit)).all(of_box(Box3::of(places), unit).into_iter().collect());
    if group.dimension() == 2 {
        let (side, _) = sides(mesh, group.triangles.iter().copied(), group.quads.iter().copied(), DVec3::ZERO);
        made = made.put("side", list(&side.to_array(), 2, unit));
    }
    made.unnamed(!declared).0
}
