//! What must hold of every mesh, whatever made it: nodes shared, no element turned or without area, the Euler number of each
//! face, borders on their curves, the chord error kept, closed where the skin is.
//!
//! Places are taken from the mesh alone and measured against the surfaces by nearest points, not by the (u, v) of the mesher.
//! Some triangles of a mesh are looked at; all of them in a long run, or with `LOFT_INVARIANTS=all`.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use lofting::geometry::Kind;
use lofting::mesh::Mesh;
use lofting::mesh::data::face_geometry::FaceGeometry;
use lofting::mesh::data::mesh::FaceRange;
use lofting::session::run::Outcome;
use lofting::surface::{Domain, Nearest, Side, Surface, SurfaceKind};

use crate::support::long::is_long;

/// Distance of nodes of the border from their curves, as a share of the size of the model.
const ON: f64 = 1e-9;
/// Triangles and nodes of a mesh that are measured.
const SOME: usize = 48;

/// Every so many of them, so that few are left.
fn some<T: Clone>(all: &[T]) -> Vec<T> {
    let step = if is_long() || std::env::var("LOFT_INVARIANTS").is_ok() { 1 } else { all.len().div_ceil(SOME).max(1) };
    all.iter().step_by(step).cloned().collect()
}

/// Edges of the triangles and quads of a mesh that states its conditions, with the way each of them runs: once, or twice in opposite
/// ways.
pub fn edges(mesh: &Mesh) -> BTreeMap<(u32, u32), Vec<bool>> {
    mesh.check().unwrap_or_else(|what| panic!("{}: {what}", mesh.name));
    let mut edges: BTreeMap<(u32, u32), Vec<bool>> = BTreeMap::new();
    for corners in mesh.triangles.iter().map(|c| c.as_slice()).chain(mesh.quads.iter().map(|c| c.as_slice())) {
        for k in 0..corners.len() {
            let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
            edges.entry((a.min(b), a.max(b))).or_default().push(a < b);
        }
    }
    for ((a, _), ways) in &edges {
        let fine = ways.len() == 1 || ways.len() == 2 && ways[0] != ways[1];
        assert!(fine, "{}: {ways:?} at {}", mesh.name, mesh.nodes[*a as usize]);
    }
    edges
}

/// A mesh with its elements as triangles, quads by their shorter diagonal, and the face of each.
struct Seen<'a> {
    mesh: &'a Mesh,
    /// Those with a geometry: no curves.
    faces: Vec<&'a FaceRange>,
    /// Settings as the script writes them.
    said: String,
    triangles: Vec<([u32; 3], usize)>,
    size: f64,
    /// Whether it is made of one shell.
    of_shell: bool,
}

impl<'a> Seen<'a> {
    fn new(mesh: &'a Mesh, text: &str) -> Self {
        let own = mesh.name.split('[').next().unwrap_or_default();
        let rest = text.split(&format!("\nmesh {own} ")).nth(1).unwrap_or_default();
        let said = rest.split("\nmesh ").next().unwrap_or_default().split("\ncheck ").next().unwrap_or_default().to_owned();
        let p = |n: u32| mesh.nodes[n as usize];
        let faces: Vec<&FaceRange> = mesh.faces.iter().filter(|f| f.lines.is_empty()).collect();
        assert_eq!(faces.len(), mesh.geometries.0.len(), "{}", mesh.name);
        let mut triangles = Vec::new();
        for (f, face) in faces.iter().enumerate() {
            triangles.extend(mesh.triangles[face.triangles.start as usize..face.triangles.end as usize].iter().map(|t| (*t, f)));
            for [a, b, c, d] in &mesh.quads[face.quads.start as usize..face.quads.end as usize] {
                let long = p(*a).distance(p(*c)) > p(*b).distance(p(*d));
                let halves = if long { [[*a, *b, *d], [*b, *c, *d]] } else { [[*a, *b, *c], [*a, *c, *d]] };
                triangles.extend(halves.map(|t| (t, f)));
            }
        }
        let low = mesh.nodes.iter().copied().fold(DVec3::MAX, DVec3::min);
        let high = mesh.nodes.iter().copied().fold(DVec3::MIN, DVec3::max);
        Self { mesh, faces, said, triangles, size: low.distance(high), of_shell: false }
    }

    fn p(&self, n: u32) -> DVec3 {
        self.mesh.nodes[n as usize]
    }

    /// Elements with the face of each: triangles as one half, quads as two halves by either diagonal.
    fn elements(&self) -> Vec<([Vec<[u32; 3]>; 2], usize)> {
        let of_face = |f: usize| {
            let face = self.faces[f];
            let triangles = self.mesh.triangles[face.triangles.start as usize..face.triangles.end as usize].iter();
            let quads = self.mesh.quads[face.quads.start as usize..face.quads.end as usize].iter();
            let whole = triangles.map(|t| [vec![*t], vec![*t]]);
            let cut = quads.map(|[a, b, c, d]| [vec![[*a, *b, *c], [*a, *c, *d]], vec![[*b, *c, *d], [*b, *d, *a]]]);
            whole.chain(cut).map(|halves| (halves, f)).collect::<Vec<_>>()
        };
        (0..self.faces.len()).flat_map(of_face).collect()
    }

    /// Edges of elements (not of their halves), with the faces that have them.
    fn edges(&self) -> BTreeMap<(u32, u32), Vec<(bool, usize)>> {
        let mut edges: BTreeMap<(u32, u32), Vec<(bool, usize)>> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate() {
            let triangles = self.mesh.triangles[face.triangles.start as usize..face.triangles.end as usize].iter().map(|t| t.to_vec());
            let quads = self.mesh.quads[face.quads.start as usize..face.quads.end as usize].iter().map(|q| q.to_vec());
            for element in triangles.chain(quads) {
                for k in 0..element.len() {
                    let (a, b) = (element[k], element[(k + 1) % element.len()]);
                    edges.entry((a.min(b), a.max(b))).or_default().push((a < b, f));
                }
            }
        }
        edges
    }

    /// Whether no two elements at an edge that go the same way along it are of one surface.
    fn apart(&self, uses: &[(bool, usize)]) -> bool {
        let mut seen = BTreeSet::new();
        uses.iter().all(|u| seen.insert((u.0, self.faces[u.1].name.as_str())))
    }

    /// Edges are used once or twice, then in opposite senses; no node lies on a free edge of others.
    fn conforms(&self, found: &mut Vec<String>) {
        let edges = self.edges();
        let mut free = Vec::new();
        for ((a, b), uses) in &edges {
            match uses.as_slice() {
                [_] => free.push([*a, *b]),
                [one, other] if one.0 != other.0 => {}
                // Faces of surfaces that the script lists may lie either way, and more than two may meet.
                _ if !self.of_shell && self.apart(uses) => {}
                _ => found.push(format!("{} uses of the edge at {}", uses.len(), self.p(*a))),
            }
        }
        if self.said.contains("conforming: false") {
            return;
        }
        let ends: BTreeSet<u32> = free.iter().flatten().copied().collect();
        let mut by_x: Vec<(f64, u32)> = ends.iter().map(|n| (self.p(*n).x, *n)).collect();
        by_x.sort_by(|a, b| a.0.total_cmp(&b.0));
        let room = ON * self.size;
        for [a, b] in free {
            let (p, q) = (self.p(a), self.p(b));
            let first = by_x.partition_point(|n| n.0 < p.x.min(q.x) - room);
            for (_, n) in by_x[first..].iter().take_while(|n| n.0 <= p.x.max(q.x) + room) {
                let t = ((self.p(*n) - p).dot(q - p) / p.distance_squared(q)).clamp(0.0, 1.0);
                if *n != a && *n != b && self.p(*n).distance(p.lerp(q, t)) <= room {
                    found.push(format!("a node on the free edge of others at {}", self.p(*n)));
                }
            }
        }
    }

    /// Elements have an area and face the side of their surface.
    fn faces_up(&self, near: &[Nearest], found: &mut Vec<String>) {
        for (t, _) in &self.triangles {
            let [a, b, c] = t.map(|n| self.p(n));
            if (b - a).cross(c - a).length() <= f64::EPSILON * self.size * a.distance(b).max(a.distance(c)) {
                found.push(format!("a triangle without area at {a}"));
            }
        }
        for (t, f) in some(&self.triangles) {
            let geometry = &self.mesh.geometries.0[f];
            let [a, b, c] = t.map(|n| self.p(n));
            let at = near[f].at((a + b + c) / 3.0).uv;
            let normal = (b - a).cross(c - a).normalize().dot(geometry.surface.normal(at.0, at.1));
            if if geometry.flipped { -normal } else { normal } <= 0.0 {
                found.push(format!("a triangle upside down at {a}"));
            }
        }
    }

    /// Corners − edges + elements of each face, where the loops and seams of its surface tell them.
    fn euler(&self, found: &mut Vec<String>) -> usize {
        let mut counted = 0;
        let (mut edges, mut nodes) = (vec![0_i64; self.faces.len()], vec![BTreeSet::new(); self.faces.len()]);
        for ((a, b), uses) in self.edges() {
            for f in uses.iter().map(|u| u.1).collect::<BTreeSet<_>>() {
                edges[f] += 1;
                nodes[f].extend([a, b]);
            }
        }
        for (f, face) in self.faces.iter().enumerate().filter(|(_, face)| face.triangles.len() + face.quads.len() > 0) {
            let Some(wanted) = euler_of(&self.mesh.geometries.0[f], self.faces.iter().filter(|other| other.name == face.name).count())
            else {
                continue;
            };
            let made = nodes[f].len() as i64 - edges[f] + face.triangles.len() as i64 + face.quads.len() as i64;
            if made != wanted {
                found.push(format!("the face of {} has the Euler number {made}, not {wanted}", face.name));
            }
            counted += 1;
        }
        counted
    }

    /// Nodes round a surface are on its curves.
    fn borders(&self, near: &[Nearest], tolerance: f64, found: &mut Vec<String>) -> usize {
        // Two fitted curves that meet, or are one, may be a quarter of the tolerance off.
        let is_fit = |side: &Side| {
            let fitted = |kind| matches!(kind, Kind::Meet | Kind::Project | Kind::Iso);
            matches!(side, Side::Chain { chain, .. } if chain.runs().iter().any(|r| fitted(r.curve.kind())))
        };
        // Rims of walls are fitted to the borders of their faces.
        let is_rim = |s: &Surface| s.kind() == SurfaceKind::Ruled && (0..s.n_sides()).all(|k| matches!(s.side(k), Side::Free));
        let mut surfaces = self.mesh.geometries.0.iter().map(|c| &c.surface);
        let fits = surfaces.any(|s| is_rim(s) || (0..s.n_sides()).any(|k| is_fit(&s.side(k))));
        let room = if fits { 0.25 * tolerance } else { ON * self.size };
        let mut rims: BTreeMap<(&str, u32), usize> = BTreeMap::new();
        for ((a, b), uses) in self.edges() {
            for (_, f) in &uses {
                let name = self.faces[*f].name.as_str();
                if uses.iter().filter(|u| self.faces[u.1].name == name).count() == 1 {
                    rims.insert((name, a), *f);
                    rims.insert((name, b), *f);
                }
            }
        }
        let all: Vec<(u32, usize)> = rims.into_iter().map(|((_, n), f)| (n, f)).collect();
        let sides = |surface: &Surface| (0..surface.n_sides()).map(|k| surface.side(k)).collect::<Vec<_>>();
        let on = |p: DVec3, f: usize, own: bool| {
            let surface = &self.mesh.geometries.0[f].surface;
            let on_side = |side: Side| match side {
                Side::Chain { chain, .. } => chain.closest(p).2 <= room,
                Side::Pole(pole) => pole.distance(p) <= room,
                Side::Free | Side::Seam => false,
            };
            let lies = || {
                let (u, v) = near[f].at(p).uv;
                [(u.round(), v), (u, v.round())].into_iter().any(|(u, v)| surface.point(u, v).distance(p) <= room)
            };
            sides(surface).into_iter().any(on_side) || own && surface.domain() != Domain::Loop && lies()
                // A border of a trimmed surface that is a line of its ground.
                || own && (0..surface.n_sides()).any(|k| surface.border_line(k).is_some()) && lies()
        };
        for (n, f) in some(&all) {
            let p = self.p(n);
            if !on(p, f, true) && !(0..near.len()).any(|other| other != f && on(p, other, false)) {
                found.push(format!("a node of the border off its curves at {p}"));
            }
        }
        all.len()
    }

    /// The farthest of 25 places of each of some triangles from the surface of a face, and where.
    fn farthest(&self, near: &[Nearest], triangles: &[[u32; 3]], f: usize) -> (f64, DVec3) {
        let mut worst = (0.0_f64, DVec3::ZERO);
        for t in triangles {
            let [a, b, c] = t.map(|n| self.p(n));
            for (i, j) in (0..7).flat_map(|i| (0..7 - i).map(move |j| (f64::from(i) / 6.0, f64::from(j) / 6.0))) {
                let p = a + (b - a) * i + (c - a) * j;
                // Beyond the border of a face its surface goes on along its tangents.
                let foot = near[f].at(p);
                let normal = self.mesh.geometries.0[f].surface.normal(foot.uv.0, foot.uv.1);
                let off = (p - foot.point).dot(normal).abs();
                worst = if off > worst.0 { (off, p) } else { worst };
            }
        }
        worst
    }

    /// Places of elements are no farther from their surface than is reported, and than the setting allows; of a quad by one of its two
    /// diagonals, for which one the measure takes is not known.
    fn chord(&self, near: &[Nearest], reported: Option<f64>, found: &mut Vec<String>) -> bool {
        let reported = reported.unwrap_or(0.0);
        let mut worst = (0.0_f64, DVec3::ZERO);
        for ([one, other], f) in some(&self.elements()) {
            let mut off = self.farthest(near, &one, f);
            if off.0 > reported && one != other {
                let again = self.farthest(near, &other, f);
                off = if again.0 < off.0 { again } else { off };
            }
            worst = if off.0 > worst.0 { off } else { worst };
        }
        // The reported distance is climbed to in four triangles only: where others lean on a sharp bend it is some per cent too low. Rounding is
        // reported as nothing.
        if worst.0 > reported * 1.06 + ON * self.size {
            found.push(format!("{} off at {}, and {reported} is reported", worst.0, worst.1));
        }
        let Some(limit) = self.written("chord_error:") else { return false };
        if worst.0.max(reported) > limit * 1.001 {
            found.push(format!("{} off at {}, and {limit} is allowed", worst.0.max(reported), worst.1));
        }
        true
    }

    /// A length that the script writes out, in model units.
    fn written(&self, key: &str) -> Option<f64> {
        let word = self.said.split(key).nth(1)?.split_whitespace().next()?;
        let number = word.trim_end_matches(['m', '}', ',']);
        let unit = if word.contains("mm") { 1.0 } else { 1000.0 };
        Some(number.parse::<f64>().ok()? * unit)
    }
}

/// The Euler number of a face: 2 less its loops, more where seams and poles of its surface close it. `None` where its patches or
/// its loops on a closed surface leave it open.
fn euler_of(geometry: &FaceGeometry, patches: usize) -> Option<i64> {
    let surface = &geometry.surface;
    let closed = surface.closed();
    if patches > 1 {
        return None;
    }
    match (surface.domain(), closed) {
        (Domain::Loop, (false, false)) => Some(2 - surface.loops().len() as i64),
        (Domain::Triangle, _) => Some(1),
        (Domain::Square, (false, false)) => Some(1),
        (Domain::Square, (true, true)) => Some(0),
        (Domain::Square, _) => Some((0..surface.n_sides()).filter(|k| matches!(surface.side(*k), Side::Pole(_))).count() as i64),
        _ => None,
    }
}

/// What is wrong with the meshes of a run, a line each; counts meshes, faces with an Euler number, nodes of borders, chord errors
/// that are written out, and meshes of shells.
pub fn look(text: &str, outcome: &Outcome, tally: &mut [usize; 5]) -> Vec<String> {
    let millimetres = if text.contains("units m\n") { 1e-3 } else { 1.0 };
    let mut all = Vec::new();
    for ((name, mesh), row) in outcome.meshes.iter().zip(&outcome.report.meshes) {
        if mesh.geometries.0.is_empty() {
            continue;
        }
        let mut seen = Seen::new(mesh, text);
        if millimetres != 1.0 {
            // Written lengths are read in millimetres.
            seen.said = seen.said.replace("mm", "e-3m");
        }
        let near: Vec<Nearest> = mesh.geometries.0.iter().map(|c| Nearest::new(&c.surface)).collect();
        let mut found: Vec<String> = mesh.check().err().into_iter().collect();
        let of =
            seen.said.trim_start().strip_prefix("of ").and_then(|rest| rest.split([' ', '\n', ',']).next()).unwrap_or_default().to_owned();
        let shell = outcome.report.shells.iter().find(|s| s.name == of);
        seen.of_shell = shell.is_some();
        seen.conforms(&mut found);
        seen.faces_up(&near, &mut found);
        tally[0] += 1;
        tally[1] += seen.euler(&mut found);
        // Glued borders are one curve between those of their faces.
        if !text.contains("snap:") {
            tally[2] += seen.borders(&near, outcome.tolerance.unwrap_or_default(), &mut found);
        }
        tally[3] += usize::from(seen.chord(&near, row.chord_error, &mut found));
        // A skin may touch itself along an edge, which then has two uses each way; what has an element twice is no skin.
        let edges = seen.edges();
        let uneven = edges.values().any(|uses| 2 * uses.iter().filter(|u| u.0).count() != uses.len());
        let pinched = edges.values().any(|uses| uses.len() > 2);
        let triangles = mesh.triangles.iter().map(|t| t.to_vec());
        let mut elements: Vec<Vec<u32>> = triangles.chain(mesh.quads.iter().map(|q| q.to_vec())).collect();
        elements.iter_mut().for_each(|element| element.sort_unstable());
        elements.sort_unstable();
        let open = uneven || pinched && elements.windows(2).any(|w| w[0] == w[1]);
        if mesh.is_watertight() == open || row.watertight != Some(!open) {
            found.push("`watertight` is not what its edges say".to_owned());
        }
        // A closed skin that does not touch itself has an even Euler number.
        let corners: BTreeSet<u32> = seen.edges().keys().flat_map(|(a, b)| [*a, *b]).collect();
        let euler = corners.len() as i64 - seen.edges().len() as i64 + (mesh.triangles.len() + mesh.quads.len()) as i64;
        if !open && !pinched && euler % 2 != 0 {
            found.push(format!("a closed skin with the Euler number {euler}"));
        }
        if let Some(shell) = shell {
            tally[4] += 1;
            if shell.closed == open {
                found.push(format!("the shell {of} is closed: {}, its mesh: {}", shell.closed, !open));
            }
        }
        found.truncate(4);
        all.extend(found.into_iter().map(|f| format!("{name}: {f}")));
    }
    all
}
