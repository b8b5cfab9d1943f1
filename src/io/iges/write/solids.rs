//! Faces that share their edges as IGES entities: solids, and shells that bound none.
//!
//! ```text
//!   solid 186 ─ shell 514 ─ face 510 ─ loop 508 ─ list of edges 504 ─ list of vertices 502
//!                            └─ surface (190 192 194 196 198 128)  └─ curve (100 110 126)
//! ```

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::Tolerance;
use crate::geometry::closest;
use crate::geometry::{Closest, Curve};
use crate::io::cad::bodies::Bodies;
use crate::io::cad::control_nets::{NetBorder, borders};
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::elementary_surface::Ground;
use crate::io::iges::entity_writer::{EntityValues, Role};
use crate::io::iges::write::file_builder::FileBuilder;
use crate::io::iges::write::things::IgesThing;
use crate::model::body::BodyLoop;

/// Places along an edge that are compared with a border of a net.
const PLACES: usize = 8;

/// The lists of vertices and edges of one body, with the places of its vertices and edges in them, from 1.
struct Lists {
    vertices: (u32, BTreeMap<usize, u32>),
    edges: (u32, BTreeMap<usize, u32>),
}

/// One use of an edge in a loop, or of a vertex at which the surface is a point.
struct LoopStep {
    is_vertex: bool,
    /// Pointer to the list, and place in it.
    of: (u32, u32),
    forward: bool,
    /// The way in the parameters of a net, where it runs along a border of that.
    uv: Option<[DVec2; 2]>,
}

/// Where the surface of a face ends.
struct Ends {
    poles: Vec<DVec3>,
    borders: Vec<NetBorder>,
}

impl FileBuilder<'_> {
    /// The bodies of a thing; several are a group.
    pub(super) fn bodies(&mut self, thing: &IgesThing, bodies: &Bodies) -> Result<u32, Defect> {
        self.off = self.off.max(bodies.off.0);
        self.sampled |= bodies.off.1;
        self.left_out.extend(bodies.left_out(&thing.name));
        let (solids, sheets) = (bodies.solids(), bodies.sheets());
        let n = solids.len() + sheets.len();
        let mut made = Vec::with_capacity(n);
        for solid in &solids {
            let skins: Vec<usize> = std::iter::once(solid.outer).chain(solid.voids.iter().copied()).collect();
            let shells = self.shells(bodies, &skins, Role::ShellOfSolid)?;
            let values = EntityValues::new().int(shells[0]).int(1).int(shells.len() as u32 - 1);
            // Faces of cavities look into them, out of the material.
            let values = shells[1..].iter().fold(values, |values, void| values.int(*void).int(1));
            let solid = self.sheet.add(186, 0, Role::Body, values);
            self.paint_body(solid, bodies, &skins);
            made.push(solid);
        }
        for sheet in sheets {
            let shell = self.shells(bodies, &[sheet], Role::Body)?[0];
            self.paint_body(shell, bodies, &[sheet]);
            made.push(shell);
        }
        let [one] = made[..] else {
            for (k, body) in made.iter().enumerate() {
                if !thing.name.is_empty() {
                    self.sheet.name(*body, &format!("{}_{}", thing.name, k + 1));
                }
                self.sheet.put_on(*body, &thing.layers);
            }
            return Ok(self.sheet.add(402, 7, Role::Free, EntityValues::new().int(n as u32).ints(made)));
        };
        Ok(one)
    }

    /// Gives a body the colour that all its faces have.
    fn paint_body(&mut self, body: u32, bodies: &Bodies, skins: &[usize]) {
        let mut colors = skins.iter().flat_map(|k| &bodies.body.skins[*k].faces).map(|face| bodies.color(*face));
        if let Some(Some(rgb)) = colors.next()
            && colors.all(|other| other == Some(rgb))
        {
            self.sheet.paint(body, rgb);
        }
    }

    /// Shells of skins that share their lists.
    fn shells(&mut self, bodies: &Bodies, skins: &[usize], role: Role) -> Result<Vec<u32>, Defect> {
        let lists = self.lists(bodies, skins)?;
        let mut shells = Vec::with_capacity(skins.len());
        for skin in skins.iter().map(|k| &bodies.body.skins[*k]) {
            let mut values = EntityValues::new().int(skin.faces.len() as u32);
            for face in &skin.faces {
                job::poll();
                let made = self.face(bodies, *face, &lists)?;
                values = values.int(made).int(i64::from(bodies.is_along(*face)));
            }
            shells.push(self.sheet.add(514, if skin.closed { 1 } else { 2 }, role, values));
        }
        Ok(shells)
    }

    fn lists(&mut self, bodies: &Bodies, skins: &[usize]) -> Result<Lists, Defect> {
        let faces = skins.iter().flat_map(|k| &bodies.body.skins[*k].faces);
        let mut edges: Vec<usize> = faces.flat_map(|face| bodies.loops(*face)).flatten().map(|(edge, _)| *edge).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut vertices: Vec<usize> = edges.iter().flat_map(|k| [bodies.body.edges[*k].ends.0, bodies.body.edges[*k].ends.1]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let placed = |all: &[usize]| all.iter().enumerate().map(|(place, k)| (*k, place as u32 + 1)).collect::<BTreeMap<usize, u32>>();
        let place_of = placed(&vertices);
        let scale = self.scale.model;
        let values =
            vertices.iter().fold(EntityValues::new().int(vertices.len() as u32), |values, k| values.point(bodies.vertices[*k] / scale));
        let list = self.sheet.add(502, 1, Role::Part, values);
        let mut values = EntityValues::new().int(edges.len() as u32);
        for k in &edges {
            let curve = bodies.curves[*k].as_ref().ok_or_else(|| defect("an edge of one of its faces has no curve"))?;
            let curve = self.piece(curve, Role::Part, true)?;
            let (from, to) = bodies.body.edges[*k].ends;
            values = values.ints([curve, list, place_of[&from], list, place_of[&to]]);
        }
        let own = self.sheet.add(504, 1, Role::List, values);
        Ok(Lists { vertices: (list, place_of), edges: (own, placed(&edges)) })
    }

    fn face(&mut self, bodies: &Bodies, k: usize, lists: &Lists) -> Result<u32, Defect> {
        let ground = &bodies.grounds[k];
        let surface = self.ground(ground);
        let ends = Ends { poles: ground.poles(), borders: if let Ground::Net(net, ..) = ground { borders(net) } else { Vec::new() } };
        let mut loops = Vec::new();
        for around in bodies.loops(k) {
            // Loops run by the normal of the surface, whichever side the shell shows.
            let around: BodyLoop = match bodies.is_along(k) {
                true => around.clone(),
                false => around.iter().rev().map(|(edge, against)| (*edge, !against)).collect(),
            };
            let steps = steps(bodies, &ends, &around, lists, &self.scale.tolerance);
            let mut values = EntityValues::new().int(steps.len() as u32);
            for step in &steps {
                values = values.int(i64::from(step.is_vertex)).ints([step.of.0, step.of.1]).int(i64::from(step.forward));
                let Some([from, to]) = step.uv else {
                    values = values.int(0);
                    continue;
                };
                let line = EntityValues::new().reals([from.x, from.y, 0.0, to.x, to.y, 0.0]);
                // Along a border of the surface one of the parameters is constant.
                values = values.int(1).int(1).int(self.sheet.add(110, 0, Role::InUv, line));
            }
            loops.push(self.sheet.add(508, 1, Role::Part, values));
        }
        let values = EntityValues::new().int(surface).int(loops.len() as u32).int(1).ints(loops);
        let face = self.sheet.add(510, 1, Role::Part, values);
        let name = bodies.name(k);
        if !name.is_empty() {
            self.sheet.name(face, name);
        }
        if let Some(rgb) = bodies.color(k) {
            self.sheet.paint(face, rgb);
        }
        self.sheet.put_on(face, bodies.layers(k));
        Ok(face)
    }
}

/// The edges of a loop in their order, and between two of them the vertex at which the surface is a point.
fn steps(bodies: &Bodies, ends: &Ends, around: &BodyLoop, lists: &Lists, tolerance: &Tolerance) -> Vec<LoopStep> {
    let mut steps: Vec<LoopStep> = Vec::new();
    for (edge, against) in around {
        let (first, last) = bodies.body.edges[*edge].ends;
        let end = if *against { first } else { last };
        let uv = bodies.curves[*edge].as_ref().and_then(|curve| along_border(curve, *against, &ends.borders, tolerance));
        steps.push(LoopStep { is_vertex: false, of: (lists.edges.0, lists.edges.1[edge]), forward: !against, uv });
        if ends.poles.iter().any(|pole| tolerance.same_point(*pole, bodies.vertices[end])) {
            steps.push(LoopStep { is_vertex: true, of: (lists.vertices.0, lists.vertices.1[&end]), forward: true, uv: None });
        }
    }
    let n = steps.len();
    for k in (0..n).filter(|k| steps[*k].is_vertex).collect::<Vec<usize>>() {
        let (before, after) = (steps[(k + n - 1) % n].uv, steps[(k + 1) % n].uv);
        steps[k].uv = before.zip(after).map(|(before, after)| [before[1], after[0]]);
    }
    steps
}

/// The way of an edge in the parameters of a net where it runs along a border of that, the net on its left.
fn along_border(curve: &Curve, against: bool, borders: &[NetBorder], tolerance: &Tolerance) -> Option<[DVec2; 2]> {
    let (a, b) = curve.domain();
    let mut places: Vec<DVec3> = (0..=PLACES).map(|k| curve.point(a + (b - a) * k as f64 / PLACES as f64)).collect();
    if against {
        places.reverse();
    }
    let share = |k: usize| k as f64 / PLACES as f64;
    let is_at = |border: &NetBorder, turned: bool| {
        let (low, high) = border.curve.domain();
        let at = |k: usize| border.curve.point(low + (high - low) * if turned { 1.0 - share(k) } else { share(k) });
        (0..=PLACES).all(|k| tolerance.same_point(at(k), places[k]))
    };
    // Most edges are whole borders, by the same parameter.
    for border in borders {
        let (low, high) = border.curve.domain();
        if is_at(border, !border.ascends) {
            let (from, to) = if border.ascends { (low, high) } else { (high, low) };
            return Some([border.at(from), border.at(to)]);
        }
    }
    borders.iter().filter(|border| places.iter().all(|p| border.hull.distance_squared(*p) <= tolerance.point * tolerance.point)).find_map(
        |border| {
            let found: Vec<Closest> = places.iter().map(|p| closest(&border.curve, *p)).collect();
            let ascends = found[1].t < found[PLACES - 1].t;
            // Where a closed border begins it ends too: the direction decides which of them is meant.
            let (low, high) = border.curve.domain();
            let (start, end) = if ascends { (low, high) } else { (high, low) };
            let is_joint = |at: &Closest| tolerance.same_point(at.point, border.curve.start()) && border.curve.is_closed(tolerance);
            let from = if is_joint(&found[0]) { start } else { found[0].t };
            let to = if is_joint(&found[PLACES]) { end } else { found[PLACES].t };
            let is_near = found.iter().all(|at| at.distance <= tolerance.point);
            (is_near && from != to && ascends == border.ascends).then(|| [border.at(from), border.at(to)])
        },
    )
}
