//! From a model to the rows of its report.

use std::collections::{BTreeMap, BTreeSet};

use crate::base::bbox::Box3;
use crate::base::fault::{Fault, Say};
use crate::base::tolerance::{GAP_ROOM, Tolerance};
use crate::lang::diag::diagnostic::{Diagnostic, Sources};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::Parts;
use crate::lang::run::unmade::{Unmade, Why};
use crate::lang::values::plans::{CheckResult, ReportTable};
use crate::lang::values::value::{ModuleId, Quantity, ShellValue, Value};
use crate::lang::words::names::Names;
use crate::mesh::Mesh;
use crate::mesh::cache::reuse::Reuse;
use crate::model::topology::Named;
use crate::model::{Model, SurfaceId, measure};
use crate::network::{Chain, LinkId, Network};
use crate::surface::Domain;

use super::report::{
    Cell, CheckRow, Column, Corners, CurveRow, DiagnosticRow, GroupRow, LabelRow, MeshRow, ModelingRow, NetworkCounts, ShellRow,
    SurfaceRow, Table, TopologyCounts, UnmadeRow,
};

/// Counts of the network.
pub fn network_counts(network: &Network) -> NetworkCounts {
    NetworkCounts { curves: network.curves.len(), links: network.links.len(), nodes: network.nodes.len() }
}

/// Places of the curves of a network in order of declaration, those that no declaration names behind.
pub fn curves_in_order(parts: &Parts, network: &Network) -> Vec<usize> {
    in_order(parts.curves.iter().map(|c| &*c.name), network.curves.iter().map(|c| &*c.name))
}

/// Places of the surfaces of a model in order of declaration.
pub fn surfaces_in_order(parts: &Parts, model: &Model) -> Vec<usize> {
    in_order(parts.surfaces.iter().map(|s| &*s.name), model.surfaces.iter().map(|s| &*s.name))
}

fn in_order<'n>(declared: impl Iterator<Item = &'n str>, all: impl Iterator<Item = &'n str>) -> Vec<usize> {
    let (mut names, mut rank) = (Names::default(), Vec::new());
    for (n, name) in declared.enumerate() {
        let name = names.intern(name).index();
        rank.resize(rank.len().max(name + 1), n);
        rank[name] = n;
    }
    let rank_of = |name: &str| names.find(name).map_or(usize::MAX, |name| rank[name.index()]);
    let mut found: Vec<(usize, usize)> = all.map(rank_of).zip(0..).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, place)| place).collect()
}

/// Curves of the network.
pub fn curves(parts: &Parts, network: &Network) -> Vec<CurveRow> {
    let row = |c: &crate::network::graph::NetCurve| CurveRow {
        name: c.name.clone(),
        kind: c.curve.kind().name(),
        length: c.curve.length(),
        links: c.links.len(),
    };
    curves_in_order(parts, network).into_iter().map(|k| row(&network.curves[k])).collect()
}

/// Modeling curves.
pub fn modeling(cx: &Cx, parts: &Parts, network: &Network, tolerance: &Tolerance) -> Vec<ModelingRow> {
    let row = |(name, links, chain): (String, usize, &Chain)| ModelingRow {
        name,
        links,
        length: chain.length(),
        kinks: chain.kinks(tolerance).len(),
    };
    chains(cx, parts, network, tolerance).into_iter().map(row).collect()
}

/// Declared chains, then the unnamed ones that surfaces stand on, each with how many links it runs over; chains with the same
/// links are one.
pub fn chains<'p>(cx: &Cx, parts: &'p Parts, network: &Network, tolerance: &Tolerance) -> Vec<(String, usize, &'p Chain)> {
    let mut places = BTreeMap::new();
    let mut rows: Vec<(String, usize, &'p Chain)> = Vec::new();
    let declared = parts.modeling.len();
    // Asked of chains that surfaces stand on.
    let curves: BTreeSet<&str> = parts.curves.iter().filter(|_| !parts.surfaces.is_empty()).map(|c| &*c.name).collect();
    let rank = |name: &str| (!curves.contains(name), name.to_owned());
    let named = parts.modeling.iter().map(|m| (m.name.to_string(), &m.value));
    let below = parts.surfaces.iter().flat_map(|s| s.value.chains()).map(|chain| (cx.name(chain.origin()), chain));
    for (n, (name, chain)) in named.chain(below).enumerate() {
        let key = identity(chain, network, tolerance);
        let links = key.1.len().max(1);
        let (place, first) = *places.entry(key).or_insert((rows.len(), n));
        match rows.get_mut(place) {
            None => rows.push((name, links, chain)),
            // Of several texts that make one chain a declared name is listed, then the first by name, whoever was declared first.
            Some(row) if first >= declared && rank(&name) < rank(&row.0) => *row = (name, links, chain),
            Some(_) => {}
        }
    }
    rows
}

/// Which chains are one: those with the same links, direction aside; without links, those with the same ends and middle.
fn identity(chain: &Chain, network: &Network, tolerance: &Tolerance) -> (Vec<[u64; 3]>, Vec<LinkId>) {
    match network.links_of(chain, tolerance) {
        Some(links) => {
            let forward: Vec<LinkId> = links.into_iter().map(|(link, _)| link).collect();
            let backward: Vec<LinkId> = forward.iter().rev().copied().collect();
            (Vec::new(), forward.min(backward))
        }
        None => {
            let mut points = [0.0, 0.5, 1.0].map(|f| chain.point(f).to_array().map(f64::to_bits));
            if points[2] < points[0] {
                points.reverse();
            }
            (points.to_vec(), Vec::new())
        }
    }
}

/// Declared surfaces; `area` measures one.
pub fn surfaces(parts: &Parts, model: &Model, area: &mut dyn FnMut(&Named) -> Option<f64>) -> Vec<SurfaceRow> {
    let row = |n: usize| {
        let named = &model.surfaces[n];
        let patches: Vec<_> = model.patches_of(SurfaceId::at(n)).collect();
        let flow = named.surface.flow();
        SurfaceRow {
            name: named.name.clone(),
            kind: named.surface.kind().name(),
            flow: (!flow.is_empty()).then_some(flow),
            patches: patches.len(),
            edges: model.edges_of(&patches).len(),
            vertices: model.vertices_of(&patches).len(),
            area: if named.surface.domain() == Domain::Unbounded { None } else { area(named) },
            corners: None,
        }
    };
    surfaces_in_order(parts, model).into_iter().map(row).collect()
}

/// A box as plain numbers; `None` when it is empty or has no end.
pub fn corners(bounds: Box3) -> Option<Corners> {
    let found = !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite();
    // Adding zero makes the two zeros one.
    found.then(|| [bounds.min, bounds.max].map(|p| p.to_array().map(|x| x + 0.0)))
}

/// The box of each surface, in order of declaration; `bounds` measures one.
pub fn boxes(parts: &Parts, model: &Model, bounds: &mut dyn FnMut(&Named) -> Option<Box3>) -> Vec<Option<Box3>> {
    surfaces_in_order(parts, model).into_iter().map(|n| bounds(&model.surfaces[n])).collect()
}

/// Counts of the surface model.
pub fn topology(model: &Model, shells: usize) -> TopologyCounts {
    TopologyCounts { patches: model.patches.len(), edges: model.edges.len(), vertices: model.vertices.len(), shells }
}

/// A shell: how it is closed, and what it measures; how its faces join only when `full`. What is said of it goes to `said`.
pub fn shell(cx: &mut Cx, shell: &ShellValue, tolerance: &Tolerance, full: bool, said: &mut Vec<Fault>) -> Result<ShellRow, Halt> {
    let glued = cx.glued(ModuleId::MAIN, shell)?;
    let (scene, built) = (&glued.scene, &glued.shell);
    said.extend(glued.said.iter().cloned());
    // Roofs are open; that a skin of faces with borders of their own is, may be news.
    let news = |fault: &&Fault| fault.code().0 != "N615" || shell.snap.is_some() || built.near > GAP_ROOM * tolerance.point;
    said.retain(|fault| news(&fault));
    let faces = built.surfaces.iter().map(|(id, _)| scene.model.patches_of(*id).count()).sum();
    let members: Vec<_> = built.surfaces.iter().map(|(id, _)| *id).collect();
    let contacts = if full { scene.model.contacts(&members, built.near, &scene.network, tolerance, |_, _| true) } else { Vec::new() };
    Ok(ShellRow {
        name: shell.name.to_string(),
        faces,
        closed: built.closed,
        area: Some(measure::areas(&shell.surfaces).iter().sum()),
        volume: built.closed.then(|| glued.solid().volume.abs()),
        gap: contacts.iter().map(|c| c.gap.max).reduce(f64::max),
        angle: contacts.iter().filter_map(|c| c.angle).map(|a| crate::lang::values::units::degrees(a.max)).reduce(f64::max),
        corners: if full { corners(measure::bounds(&shell.surfaces)) } else { None },
    })
}

/// Elements up to which a mesh is measured in all ways for the summary table.
pub const QUICK_ELEMENTS: usize = 200_000;

/// A mesh: counts, quality and groups; chord error (of its faces in `reuse` as it was) and hash only when `full` or quick.
pub fn mesh(name: &str, mesh: &Mesh, tolerance: &Tolerance, full: bool, reuse: Option<&Reuse>) -> MeshRow {
    let full = full || mesh.triangles.len() + mesh.quads.len() <= QUICK_ELEMENTS;
    let quality = mesh.quality();
    let degrees = crate::lang::values::units::degrees;
    let group = |g: &crate::mesh::Group| GroupRow {
        name: g.name.clone(),
        nodes: g.nodes.len(),
        elements: g.lines.len() + g.triangles.len() + g.quads.len(),
    };
    MeshRow {
        name: name.to_owned(),
        nodes: mesh.nodes.len(),
        triangles: mesh.triangles.len(),
        quads: mesh.quads.len(),
        order: mesh.order,
        min_angle: quality.map(|q| degrees(q.min_angle)),
        max_angle: quality.map(|q| degrees(q.max_angle)),
        mean_quality: quality.map(|q| q.mean_quality),
        min_quality: quality.map(|q| q.min_quality),
        max_aspect: quality.map(|q| q.max_aspect),
        area: quality.map(|q| q.area),
        chord_error: if full { mesh.chord_error_again(tolerance, reuse) } else { None },
        watertight: quality.map(|_| mesh.is_watertight()),
        parts: mesh.parts(),
        hash: full.then(|| format!("{:016x}", mesh.hash())),
        groups: mesh.groups.iter().map(group).collect(),
    }
}

/// A check with its line.
pub fn check(result: &CheckResult, sources: &Sources) -> CheckRow {
    let side = |value: &Option<Value>| value.as_ref().map_or(Cell::Missing, cell);
    CheckRow {
        label: result.label.clone(),
        pass: result.pass,
        line: sources.place(result.file, result.span.start).map_or(0, |place| place.line),
        left: side(&result.left_value),
        right: side(&result.right_value),
    }
}

/// A report table.
pub fn table(table: &ReportTable) -> Table {
    let column =
        |c: &crate::lang::values::plans::Column| Column { name: c.name.clone(), unit: (!c.unit.is_empty()).then(|| c.unit.clone()) };
    Table {
        title: table.title.clone(),
        columns: table.columns.iter().map(column).collect(),
        rows: table.rows.iter().map(|row| row.iter().map(cell).collect()).collect(),
    }
}

/// Something that was not made, with its line.
pub fn unmade(found: &Unmade, sources: &Sources) -> UnmadeRow {
    UnmadeRow {
        name: found.name.clone(),
        what: found.what.clone(),
        file: sources.get(found.file).map(|f| f.name.clone()).unwrap_or_default(),
        line: sources.place(found.file, found.span.start).map_or(0, |place| place.line),
        because: match &found.why {
            Why::Failed => None,
            Why::Waits(of) => Some(of.clone()),
            Why::Unread => Some(String::new()),
        },
    }
}

/// A value as plain data: numbers in model units and degrees.
pub fn cell(value: &Value) -> Cell {
    match value {
        Value::Bool(b) => Cell::Bool(*b),
        Value::Number(Quantity { value, .. }) => Cell::Number(*value),
        Value::Text(text) | Value::Word(text) => Cell::Text(text.to_string()),
        Value::Vector(p, _) | Value::Node(p) => Cell::List(p.to_array().map(Cell::Number).to_vec()),
        Value::List(items) => Cell::List(items.iter().map(cell).collect()),
        _ => Cell::Missing,
    }
}

/// A diagnostic with places as editors count, and behind it those that it stands for where they were kept.
pub fn diagnostic(found: &Diagnostic, sources: &Sources) -> Vec<DiagnosticRow> {
    let listed: usize = found.folded.iter().map(|d| 1 + d.more).sum();
    let first = diagnostic_row(found, 1 + found.more.saturating_sub(listed), sources);
    std::iter::once(first).chain(found.folded.iter().map(|d| diagnostic_row(d, 1 + d.more, sources))).collect()
}

fn diagnostic_row(found: &Diagnostic, count: usize, sources: &Sources) -> DiagnosticRow {
    let label = |label: &crate::lang::diag::diagnostic::Label| {
        let place = sources.place(label.file, label.span.start);
        LabelRow {
            file: sources.get(label.file).map(|f| f.name.clone()).unwrap_or_default(),
            line: place.map_or(0, |p| p.line),
            column: place.map_or(0, |p| p.column),
            length: sources.text(label.file, label.span).chars().count(),
            text: label.text.clone(),
        }
    };
    DiagnosticRow {
        code: found.code.0,
        severity: found.severity().word(),
        message: found.message.clone(),
        help: found.help.clone(),
        notes: found.notes.clone(),
        labels: found.labels.iter().map(label).collect(),
        count,
    }
}

/// What was found of each surface: its flow, the curves along u and v in order, poles and which way it closes.
pub fn flows(cx: &Cx, parts: &Parts, model: &Model) -> Vec<String> {
    let words = |family: &[Option<&Chain>]| {
        let word = |chain: &Option<&Chain>| {
            chain.map_or_else(
                || "a pole".to_owned(),
                |c| Some(cx.name(c.origin())).filter(|n| !n.is_empty()).unwrap_or_else(|| "a curve".to_owned()),
            )
        };
        family.iter().map(word).collect::<Vec<_>>().join(", ")
    };
    let line = |named: &crate::model::topology::Named| {
        let surface = &named.surface;
        let mut parts = vec![surface.flow()];
        let (along_u, along_v) = surface.families();
        for (way, family) in [("along u", along_u), ("along v", along_v)] {
            if !family.is_empty() {
                parts.push(format!("{way}: {}", words(&family)));
            }
        }
        parts.extend(surface.blending().map(|rule| format!("{rule} blend")));
        parts.retain(|part| !part.is_empty());
        if parts.is_empty() {
            parts.push("no flow".to_owned());
        }
        format!("surface {}: {}, {}", named.name, surface.kind().name(), parts.join("; "))
    };
    surfaces_in_order(parts, model).into_iter().map(|n| line(&model.surfaces[n])).collect()
}
