//! A face of a mesh made freely: its border from the divided stretches, its inside grown.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::bound;
use super::build::{Task, Trouble, triangulate};
use super::ground::Even;
use super::improve::Care;
use super::outline::Outline;
use super::sheet::Sheet;
use super::size::Background;
use super::web::Web;
use crate::base::fault::{Fault, MeshFault, Result};
use crate::base::job::Job;
use crate::base::limits::MESH_ELEMENTS;
use crate::base::math::angle_between;
use crate::base::par;
use crate::base::tolerance::{NUDGE, SINGULAR, WHOLE_NUMBER};
use crate::base::triangulate_points::PointsFault;
use crate::mesh::build::Input;
use crate::mesh::chart::{Chart, Free, Shape};
use crate::mesh::edges::Limits;
use crate::mesh::faces::{Frame, Prepared, limits_of, middle};
use crate::mesh::layout::{Face, Layout, side_parameters};
use crate::mesh::nodes::Nodes;
use crate::mesh::plan::Elements;
use crate::model::Trace;
use crate::surface::{Domain, Side, Surface};

/// Spacing of the crystal as a share of the size, so that hardly an edge comes out longer than the size allows.
const SPACING: f64 = 0.8;
/// Longest edge inside over the size (language reference, mesh settings).
const LONGEST: f64 = 1.05;
/// Quality below which triangles are worked on.
const WANTED: f64 = 0.92;
/// The same where lengths vary with the bends: neighbouring triangles cannot all be equilateral there.
const WANTED_BENT: f64 = 0.85;
/// Rounds of smoothing at most.
const SMOOTH: usize = 30;

/// Feet of one point nearer than this in u and v are one place.
const ONE_PLACE: f64 = NUDGE;

/// Ends of two borders of one face that became one junction lie within this many glue distances of each other in the chart,
/// whose lengths are right on average only.
const ROOM: f64 = 8.0;

/// Everything a face is made from.
pub struct Made<'a> {
    /// The plan and the model.
    pub input: &'a Input<'a>,
    /// Its stretches.
    pub layout: &'a Layout,
    /// Their nodes.
    pub nodes: &'a Nodes,
    /// Points of all border nodes.
    pub points: &'a [DVec3],
}

/// Nodes of a border with their places, in order of first use.
#[derive(Default)]
struct Border {
    uv: Vec<(f64, f64)>,
    ids: Vec<u32>,
    edges: Vec<[u32; 2]>,
}

impl Border {
    /// Edges of the chart where a loop passes a pole: it goes on at another place of the same node.
    fn jump(&mut self, loops: &[usize], ends: &[Option<(u32, u32)>]) {
        let mut rest = ends;
        for n in loops {
            let (own, others) = rest.split_at(*n);
            rest = others;
            let own: Vec<(u32, u32)> = own.iter().copied().flatten().collect();
            for k in 0..own.len() {
                let (from, to) = (own[k].1, own[(k + 1) % own.len()].0);
                if from != to {
                    self.edges.push([from, to]);
                }
            }
        }
    }

    /// Places of one node that are no further apart than borders were glued over become one: on the face itself the ends of
    /// its borders need not meet.
    fn close(&mut self, sheet: &Sheet, near: f64) {
        let mut into: Vec<u32> = (0..self.ids.len() as u32).collect();
        for n in 0..self.ids.len() {
            let here = sheet.xy(self.uv[n]);
            let first = (0..n).find(|m| self.ids[*m] == self.ids[n] && sheet.xy(self.uv[*m]).distance(here) <= ROOM * near);
            into[n] = first.map_or(into[n], |m| into[m]);
        }
        let kept: Vec<usize> = (0..into.len()).filter(|n| into[*n] == *n as u32).collect();
        let place = |n: u32| kept.partition_point(|k| *k < into[n as usize] as usize) as u32;
        self.edges = self.edges.iter().map(|e| e.map(place)).filter(|[a, b]| a != b).collect();
        self.uv = kept.iter().map(|n| self.uv[*n]).collect();
        self.ids = kept.iter().map(|n| self.ids[*n]).collect();
    }
}

/// A face without anything in it, for as long as only its border matters.
pub fn empty(made: &Made, face: &Face) -> Prepared {
    prepared(made, face, Free::default(), Vec::new(), Vec::new())
}

/// Makes the face.
pub fn prepare(made: &Made, face: &Face, job: &Job) -> Result<Prepared> {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let mut border = border(made, face);
    let sheet = Sheet::new(surface, border.uv.iter().copied()).ok_or_else(|| no_area(made, face))?;
    if face.near > made.input.tolerance.point {
        border.close(&sheet, face.near);
    }
    let outline = Outline {
        xy: border.uv.iter().map(|uv| sheet.xy(*uv)).collect(),
        p: border.ids.iter().map(|n| made.points[*n as usize]).collect(),
        loops: border.edges.clone(),
        lines: Vec::new(),
    };
    let web = match fitting(made, face, &sheet, &outline, job)? {
        Ok(web) => web,
        Err(trouble) => return Err(fault(made, face, &border, trouble)),
    };
    let fixed = web.fixed as usize;
    // At a pole the chart has an edge that is a point in space.
    let node = |n: u32| border.ids.get(n as usize).copied();
    let flat = |t: &[u32; 3]| (0..3).any(|k| node(t[k]).is_some() && node(t[k]) == node(t[(k + 1) % 3]));
    let triangles: Vec<[u32; 3]> = web.tri.iter().copied().filter(|t| !flat(t)).collect();
    let mut uv = border.uv;
    uv.extend(web.xy[fixed..].iter().map(|xy| sheet.uv(*xy)));
    let inner = web.p[fixed..].to_vec();
    Ok(prepared(made, face, Free { uv, border: fixed, triangles }, border.ids, inner))
}

/// Triangles that keep the limits: lengths by the bends at first, smaller where a triangle's bound says so.
fn fitting(made: &Made, face: &Face, sheet: &Sheet, outline: &Outline, job: &Job) -> Result<std::result::Result<Web, Trouble>> {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let limits = limits_of(made.input);
    let size = face.size.0 * SPACING;
    let mut care = Care { smooth: SMOOTH, wanted: WANTED, longest: LONGEST / SPACING };
    let most = MESH_ELEMENTS as usize / 2;
    let longest = Longest::new(face.size.0, outline);
    if surface.is_flat() || limits.chord.is_none() && limits.angle.is_none() {
        let broken = |web: &Web| (0..web.tri.len() as u32).filter(|t| longest.broken(web, *t)).collect::<Vec<u32>>();
        let mut spacing = size;
        for _ in 0..ROUNDS {
            let field = Even(spacing);
            let task = Task { ground: sheet, field: &field, outline, care, most, broken: Some(&broken) };
            match triangulate(&task, job)? {
                Ok(web) if !broken(&web).is_empty() => spacing *= LESS,
                other => return Ok(other),
            }
        }
        let (says, at) = (made.input.plan.size.map_or(made.input.plan.origin, |s| s.1), outline.p[0]);
        return Err(MeshFault::NotReached { limit: "size", says, surface: surface.origin(), reached: longest.inside, at }.into());
    }
    let whole = outline.xy.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), xy| (l.min(*xy), h.max(*xy)));
    care.wanted = WANTED_BENT;
    let wanted = |xy: DVec2| FILLED * bound::wanted(surface, sheet.uv(xy), limits.chord, limits.angle);
    let mut field = Background::new(sheet, whole, GROWTH, |xy| wanted(xy).min(size));
    let mut worst = (0.0, DVec3::ZERO, "chord_error");
    for _ in 0..ROUNDS {
        let broken = |web: &Web| {
            let loads = loads(surface, sheet, web, &limits);
            let over = |t: &u32| loads[*t as usize].chord.max(loads[*t as usize].angle) > 1.0 || longest.broken(web, *t);
            (0..web.tri.len() as u32).filter(over).collect()
        };
        let web = match triangulate(&Task { ground: sheet, field: &field, outline, care, most, broken: Some(&broken) }, job)? {
            Ok(web) => web,
            Err(trouble) => return Ok(Err(trouble)),
        };
        let loads = loads(surface, sheet, &web, &limits);
        worst = (0.0, DVec3::ZERO, "chord_error");
        for (t, load) in loads.iter().enumerate() {
            let stretched = if longest.broken(&web, t as u32) { 1.0 / LESS } else { 0.0 };
            let over = load.chord.max(load.angle).max(stretched);
            if over <= 1.0 {
                continue;
            }
            let c = web.tri[t].map(|n| n as usize);
            let middle = (web.p[c[0]] + web.p[c[1]] + web.p[c[2]]) / 3.0;
            if over > worst.0 {
                worst = (over, middle, if load.chord >= load.angle { "chord_error" } else { "angle_error" });
            }
            let factor = if load.chord >= load.angle { load.chord.sqrt() } else { load.angle };
            let smaller = (LESS / factor).max(0.5);
            for n in c {
                field.lower(web.xy[n], web.size[n] * smaller);
            }
        }
        if worst.0 == 0.0 {
            return Ok(Ok(web));
        }
        field.level();
        job.go_on()?;
    }
    let (limit, at) = (worst.2, worst.1);
    let says = if limit == "chord_error" { made.input.plan.chord_error } else { made.input.plan.angle_error };
    let reached = worst.0 * says.map_or(0.0, |s| s.0);
    let says = says.map_or(made.input.plan.origin, |s| s.1);
    Err(MeshFault::NotReached { limit, says, surface: surface.origin(), reached, at }.into())
}

/// How long sides inside a face may be.
struct Longest {
    /// Between inner nodes.
    inside: f64,
    /// At each border node: where the border itself has longer steps (a written count), what leans on them is as long.
    at_border: Vec<f64>,
}

impl Longest {
    fn new(size: f64, outline: &Outline) -> Self {
        let inside = LONGEST * size * (1.0 + WHOLE_NUMBER);
        let mut at_border = vec![inside; outline.p.len()];
        for edge in outline.edges() {
            let most = LONGEST * outline.length(edge);
            edge.iter().for_each(|n| at_border[*n as usize] = at_border[*n as usize].max(most));
        }
        Self { inside, at_border }
    }

    /// Whether a triangle has a side inside the face that is too long; those between two border nodes are what they are.
    fn broken(&self, web: &Web, t: u32) -> bool {
        let c = web.tri[t as usize];
        (0..3).filter(|k| web.locked[t as usize] >> k & 1 == 0).any(|k| {
            let ends = [c[(k + 1) % 3], c[(k + 2) % 3]];
            let most = |n: u32| self.at_border.get(n as usize).copied();
            let allowed = match ends.map(most) {
                [Some(_), Some(_)] => return false,
                [a, b] => a.or(b).unwrap_or(self.inside),
            };
            web.p[ends[0] as usize].distance(web.p[ends[1] as usize]) > allowed
        })
    }
}

/// How far a triangle is from its limits: 1 is just kept.
#[derive(Clone, Copy)]
struct Load {
    chord: f64,
    angle: f64,
}

/// Bounds of all triangles against the limits.
fn loads(surface: &Surface, sheet: &Sheet, web: &Web, limits: &Limits) -> Vec<Load> {
    let places: Vec<DVec2> = web.xy.iter().map(|xy| sheet.uv(*xy).into()).collect();
    let normals: Vec<DVec3> = match limits.angle {
        Some(_) => par::map(places.len(), |n| surface.normal(places[n].x, places[n].y)),
        None => Vec::new(),
    };
    let batches = par::map(web.tri.len().div_ceil(BATCH), |batch| {
        let some = &web.tri[batch * BATCH..web.tri.len().min((batch + 1) * BATCH)];
        some.iter()
            .map(|t| {
                let c = t.map(|n| n as usize);
                let at = || from_pole(surface, c.map(|n| places[n]));
                let chord = limits.chord.map_or(0.0, |limit| bound::chord(surface, at(), c.map(|n| web.p[n])) / limit);
                let angle = limits.angle.map_or(0.0, |limit| {
                    let turn = |i: usize, j: usize| angle_between(normals[c[i]], normals[c[j]]);
                    turn(0, 1).max(turn(1, 2)).max(turn(2, 0)) / limit
                });
                Load { chord, angle }
            })
            .collect::<Vec<_>>()
    });
    batches.into_iter().flatten().collect()
}

/// Places of a triangle of which a corner may be at a pole: all places there are one point, and that between the other two
/// corners spans the least.
fn from_pole(surface: &Surface, at: [DVec2; 3]) -> [DVec2; 3] {
    let mut best = at;
    for k in 0..3 {
        let jet = surface.jet(at[k].x, at[k].y);
        let middle = 0.5 * (at[(k + 1) % 3] + at[(k + 2) % 3]);
        let (du, dv) = (jet.du.length(), jet.dv.length());
        if du <= SINGULAR * dv {
            best[k].x = middle.x;
        } else if dv <= SINGULAR * du {
            best[k].y = middle.y;
        }
    }
    best
}

/// First lengths over those that bends ask for: triangles are not all equilateral.
pub const FILLED: f64 = 0.86;
/// Ratio of neighbouring edges.
const GROWTH: f64 = 1.3;
/// What is made smaller is made a little more so.
const LESS: f64 = 0.96;
/// Times a face is made anew for its limits.
const ROUNDS: usize = 12;
/// Triangles that one thread bounds at a time.
const BATCH: usize = 1024;

fn prepared(made: &Made, face: &Face, free: Free, mut ids: Vec<u32>, inner: Vec<DVec3>) -> Prepared {
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let triangles = free.triangles.len() as u64;
    ids.resize(free.uv.len(), 0);
    Prepared {
        surface: face.surface,
        chart: Chart { surface: surface.clone(), shape: Shape::Free(free), frame: Frame::Free(ids), flipped: face.flipped },
        elements: Elements::Triangles,
        first: 0,
        inner: inner.len() as u64,
        triangles,
        quads: 0,
        made: inner,
    }
}

/// The nodes round a face, loop by loop, with their places on the surface.
fn border(made: &Made, face: &Face) -> Border {
    let record = &made.input.model.patches[face.patch.index()];
    let surface = &made.input.model.surfaces[face.surface.index()].surface;
    let mut border = Border::default();
    let mut known: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    // First and last node of each side, loops apart.
    let mut ends: Vec<Option<(u32, u32)>> = Vec::new();
    for (k, side) in face.sides.iter().enumerate() {
        ends.push(None);
        let line = crate::mesh::faces::line(made.layout, made.nodes, face, k, 1);
        let feet = line.ids.iter().map(|n| surface.flat_uv(made.points[*n as usize])).collect::<Option<Vec<_>>>();
        let mut uv = feet.unwrap_or_else(|| places(made.input, face, k, &line.lengths));
        if side.uses.is_empty() {
            uv = match surface.border_line(k) {
                Some((a, b)) => vec![a, b],
                // An edge that was glued together: its neighbours meet there.
                None if surface.domain() == Domain::Loop => continue,
                None => pole(record, k),
            };
        }
        // Edges have the face on their left; sides of a mapped domain run with ascending u or v.
        let back = made.input.model.runs_back(record, k);
        let mut last: Option<u32> = None;
        for (id, at) in line.ids.iter().zip(uv) {
            // A node may be in several places of the chart (a seam, a pole), but in each of them once.
            let same = |n: &&u32| {
                let there = border.uv[**n as usize];
                (there.0 - at.0).abs().max((there.1 - at.1).abs()) <= ONE_PLACE
            };
            let places = known.entry(*id).or_default();
            let node = places.iter().find(same).copied().unwrap_or_else(|| {
                border.uv.push(at);
                border.ids.push(*id);
                places.push(border.ids.len() as u32 - 1);
                border.ids.len() as u32 - 1
            });
            if let Some(before) = last.filter(|before| *before != node) {
                border.edges.push(if back { [node, before] } else { [before, node] });
            }
            last = Some(node);
            ends[k] = Some((ends[k].map_or(node, |e| e.0), node));
        }
    }
    if surface.domain() == Domain::Loop {
        border.jump(&surface.loops(), &ends);
    }
    border
}

/// The two corners of a side that is one point.
fn pole(record: &crate::model::Patch, side: usize) -> Vec<(f64, f64)> {
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    match side {
        0 => vec![(u0, v0), (u1, v0)],
        1 => vec![(u1, v0), (u1, v1)],
        2 => vec![(u0, v1), (u1, v1)],
        _ => vec![(u0, v0), (u0, v1)],
    }
}

/// Surface parameters at ascending lengths along a side of a face that is not a flat one without a map.
pub fn places(input: &Input, face: &Face, side: usize, lengths: &[f64]) -> Vec<(f64, f64)> {
    let record = &input.model.patches[face.patch.index()];
    let surface = &input.model.surfaces[face.surface.index()].surface;
    if surface.domain() == Domain::Loop {
        return along_border(surface, side, face.sides[side].length, lengths);
    }
    let at = side_parameters(input, face, side, lengths);
    let ((u0, u1), (v0, v1)) = (record.u, record.v);
    at.into_iter()
        .map(|t| match (face.is_triangle(), side) {
            (_, 0) => (t, v0),
            (true, 1) => (1.0 - t, t),
            (true, _) => (0.0, t),
            (false, 1) => (u1, t),
            (false, 2) => (t, v1),
            (false, _) => (u0, t),
        })
        .collect()
}

/// The same on a border of a trimmed surface, `total` long.
fn along_border(surface: &Surface, side: usize, total: f64, lengths: &[f64]) -> Vec<(f64, f64)> {
    match (surface.side(side), surface.border_line(side)) {
        (Side::Chain { from, to, .. }, _) => {
            let place = |s: &f64| surface.border_place(side, from + (to - from) * (s / total)).unwrap_or_default();
            lengths.iter().map(place).collect()
        }
        (_, Some((from, to))) => {
            let trace = Trace::new(surface, from, to);
            lengths.iter().map(|s| trace.uv(trace.at_length(s / total * trace.length()))).collect()
        }
        _ => vec![(0.0, 0.0); lengths.len()],
    }
}

fn no_area(made: &Made, face: &Face) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    MeshFault::FaceEmpty { surface, at: middle(made.input, face) }.into()
}

/// What went wrong, in the user's words.
fn fault(made: &Made, face: &Face, border: &Border, trouble: Trouble) -> Fault {
    let surface = made.input.model.surfaces[face.surface.index()].surface.origin();
    let place = |n: u32| border.ids.get(n as usize).map_or(DVec3::ZERO, |id| made.points[*id as usize]);
    match trouble {
        Trouble::Border(PointsFault::Crosses(a, b)) => {
            MeshFault::BordersCross { surface, at: 0.5 * (place(a) + place(b)), size: face.size.0 }.into()
        }
        Trouble::Border(PointsFault::Same(a, _)) => MeshFault::BordersCross { surface, at: place(a), size: face.size.0 }.into(),
        Trouble::Border(PointsFault::Flat) | Trouble::Empty => no_area(made, face),
        Trouble::Full => crate::mesh::faces::too_many(&made.input.plan.name, 2 * MESH_ELEMENTS),
    }
}
