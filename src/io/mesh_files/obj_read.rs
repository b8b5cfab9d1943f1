//! Reads Wavefront OBJ: points, polylines and polygons with their groups, and a mesh made of the polygons.
//!
//! tobj reads vertices and polygons from the lines of the file. What it cannot give is read here: `l`, `p`, groups and
//! the places of mistakes. Every number and index is checked before; continued lines reach tobj joined, without
//! comments, weights, colours and texture indices. Its corners are welded, one for each different point.

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::DVec3;

use crate::base::math::unit;
use crate::base::text::parse_real;
use crate::base::triangulate::{PolygonFault, newell, polygon};
use crate::base::{job, limits};
use crate::io::files::fault::Malformed;
use crate::io::mesh_files::line_reader::LineReader;
use crate::io::mesh_files::weld::weld;
use crate::mesh::{FaceRange, Group, Mesh};

/// What an OBJ holds, in file order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Obj {
    /// The points of its `p` elements, or all vertices when it has none.
    pub points: Vec<DVec3>,
    /// Its `l` elements.
    pub polylines: Vec<Vec<DVec3>>,
    /// Corners of the polygons, each different point once.
    pub vertices: Vec<DVec3>,
    /// Its `f` elements, as indices into `vertices`.
    pub polygons: Vec<Vec<u32>>,
    /// Its `g` and `o` names that hold something; one that comes back goes on.
    pub groups: Vec<ObjGroup>,
    /// What was skipped, by line (W810).
    pub skipped: Vec<Malformed>,
    /// Line of each polygon.
    lines: Vec<u64>,
}

/// A named part of an OBJ.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjGroup {
    /// As written after `g` or `o`.
    pub name: String,
    /// Indices of its polylines.
    pub polylines: Vec<usize>,
    /// Indices of its polygons.
    pub polygons: Vec<usize>,
}

/// Reads an OBJ, or says in which line it stops making sense.
pub fn read(bytes: &[u8]) -> Result<Obj, Malformed> {
    let text = crate::io::tables::text::decode(bytes)?;
    let mut scan = Scan::default();
    let mut joined = String::new();
    let mut start = 0;
    for (k, line) in text.lines().enumerate() {
        job::poll();
        if joined.is_empty() {
            start = k as u64 + 1;
        }
        let content = line.split('#').next().unwrap_or("").trim_end();
        if let Some(head) = content.strip_suffix('\\') {
            joined.push_str(head);
            joined.push(' ');
        } else if joined.is_empty() {
            scan.line(Cow::Borrowed(content), start)?;
        } else {
            joined.push_str(content);
            scan.line(Cow::Owned(std::mem::take(&mut joined)), start)?;
        }
    }
    scan.line(Cow::Owned(joined), start)?;
    scan.finish()
}

/// Elements as index lists with line and group.
struct Element {
    indices: Vec<u32>,
    line: u64,
    group: usize,
}

/// Different words that are skipped before a file is no OBJ at all.
const STRANGE_WORDS: usize = 32;

/// At most 20 characters of a word, for a message.
fn shortened(word: &str) -> String {
    word.chars().take(20).collect()
}

/// What is known of the lines read so far.
#[derive(Default)]
struct Scan<'t> {
    /// Lines with a vertex or a polygon, as tobj reads them.
    for_tobj: Vec<Cow<'t, str>>,
    vertices: Vec<DVec3>,
    points: Vec<Element>,
    polylines: Vec<Element>,
    polygons: Vec<Element>,
    names: Vec<String>,
    /// Group of each name.
    places: BTreeMap<String, usize>,
    group: usize,
    /// Words that were skipped: first line and how often.
    skipped: BTreeMap<String, (u64, usize)>,
    /// Vertices and indices so far.
    size: usize,
}

impl<'t> Scan<'t> {
    fn line(&mut self, content: Cow<'t, str>, line: u64) -> Result<(), Malformed> {
        let mut words = content.split_whitespace();
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            "v" => {
                let end = self.vertex(&content, line)?;
                self.for_tobj.push(match content {
                    Cow::Borrowed(content) => Cow::Borrowed(&content[..end]),
                    Cow::Owned(content) => Cow::Owned(content[..end].to_owned()),
                });
            }
            "f" => {
                let element = self.element(words, line, 3, "a face")?;
                self.polygons.push(element);
                let plain = !content.contains('/');
                self.for_tobj.push(if plain { content } else { Cow::Owned(without_texture(&content)) });
            }
            "l" => {
                let element = self.element(words, line, 2, "a line")?;
                self.polylines.push(element);
            }
            "p" => {
                let element = self.element(words, line, 1, "a point element")?;
                self.points.push(element);
            }
            "g" | "o" => {
                let name = words.collect::<Vec<_>>().join(" ");
                // Group 0 is what stands before any name.
                let next = self.names.len() + 1;
                self.size += 1;
                self.group = *self.places.entry(name).or_insert_with_key(|name| {
                    self.names.push(name.clone());
                    next
                });
            }
            "vt" | "vn" | "vp" | "s" | "mg" | "usemtl" | "mtllib" | "usemap" | "maplib" => {}
            _ if self.skipped.len() >= STRANGE_WORDS => {
                return Err(Malformed::at(line, 1, format!("`{}` is not a keyword of OBJ, and many before were not", shortened(keyword))));
            }
            _ => self.skipped.entry(shortened(keyword)).or_insert((line, 0)).1 += 1,
        }
        if self.size > limits::LIST_MEMBERS {
            return Err(Malformed::line(line, format!("the file has more than {} vertices and indices", limits::LIST_MEMBERS)));
        }
        Ok(())
    }

    /// Three coordinates; a weight or a colour behind them does not move a polygon. Gives where the coordinates end in the line.
    fn vertex(&mut self, content: &str, line: u64) -> Result<usize, Malformed> {
        let mut p = [0.0; 3];
        let (mut n, mut end) = (0, 0);
        for (k, word) in content.split_whitespace().skip(1).enumerate() {
            match parse_real(word) {
                Some(x) if x.is_finite() => {
                    if let Some(place) = p.get_mut(k) {
                        *place = x;
                        end = word.as_ptr() as usize - content.as_ptr() as usize + word.len();
                    }
                }
                _ => return Err(Malformed::at(line, k as u64 + 2, format!("`{}` is not a coordinate", shortened(word)))),
            }
            n = k + 1;
        }
        if n < 3 {
            return Err(Malformed::line(line, format!("a vertex has three coordinates, got {n}")));
        }
        self.vertices.push(p.into());
        self.size += 1;
        Ok(end)
    }

    /// Vertex indices from 0; those beyond the vertices are found at the end, when all are known.
    fn element<'w>(&mut self, words: impl Iterator<Item = &'w str>, line: u64, least: usize, what: &str) -> Result<Element, Malformed> {
        let mut indices = Vec::new();
        for (k, word) in words.enumerate() {
            let bad = |why: String| Malformed::at(line, k as u64 + 2, why);
            let number: i64 = match word.split('/').next().unwrap_or("").parse() {
                Ok(number) => number,
                Err(_) => return Err(bad(format!("`{}` is not a vertex index", shortened(word)))),
            };
            let so_far = self.vertices.len() as i64;
            let index = if number < 0 { so_far + number } else { number - 1 };
            if number == 0 {
                return Err(bad("vertex indices start at 1, got 0".to_owned()));
            }
            if index < 0 {
                return Err(bad(format!("index {number} counts back beyond the {so_far} vertices so far")));
            }
            indices.push(u32::try_from(index).map_err(|_| bad(format!("there is no vertex {number}")))?);
        }
        if indices.len() < least {
            let plural = if least == 1 { "index" } else { "indices" };
            return Err(Malformed::line(line, format!("{what} needs at least {least} vertex {plural}, got {}", indices.len())));
        }
        self.size += indices.len();
        Ok(Element { indices, line, group: self.group })
    }

    fn finish(self) -> Result<Obj, Malformed> {
        let n = self.vertices.len();
        let mut all: Vec<&Element> = self.polygons.iter().chain(&self.polylines).chain(&self.points).collect();
        all.sort_by_key(|element| element.line);
        for element in all {
            job::poll();
            if let Some((k, index)) = element.indices.iter().enumerate().find(|(_, index)| **index as usize >= n) {
                let what = format!("there is no vertex {}, the file has {n}", u64::from(*index) + 1);
                return Err(Malformed::at(element.line, k as u64 + 2, what));
            }
        }
        let of = |element: &Element| element.indices.iter().map(|index| self.vertices[*index as usize]).collect::<Vec<DVec3>>();
        let mut obj = Obj {
            points: if self.points.is_empty() { self.vertices.clone() } else { self.points.iter().flat_map(of).collect() },
            polylines: self.polylines.iter().map(of).collect(),
            lines: self.polygons.iter().map(|element| element.line).collect(),
            skipped: self.skipped.iter().map(|(word, (line, n))| skipped(word, *line, *n)).collect(),
            ..Obj::default()
        };
        obj.skipped.sort_by_key(|skipped| skipped.line);
        (obj.vertices, obj.polygons) = self.through_tobj()?;
        let mut groups: Vec<ObjGroup> =
            std::iter::once(String::new()).chain(self.names).map(|name| ObjGroup { name, ..ObjGroup::default() }).collect();
        self.polylines.iter().enumerate().for_each(|(k, element)| groups[element.group].polylines.push(k));
        self.polygons.iter().enumerate().for_each(|(k, element)| groups[element.group].polygons.push(k));
        groups.retain(|group| !group.polylines.is_empty() || !group.polygons.is_empty());
        obj.groups = groups;
        Ok(obj)
    }

    /// Different corner points and the polygons on them.
    fn through_tobj(&self) -> Result<(Vec<DVec3>, Vec<Vec<u32>>), Malformed> {
        let mut lines = LineReader::new(&self.for_tobj);
        let (models, _) = tobj::load_obj_buf(&mut lines, &tobj::LoadOptions::default(), |_| Err(tobj::LoadError::GenericFailure))
            .map_err(|e| Malformed::line(1, e.to_string()))?;
        let mut corners: Vec<DVec3> = Vec::new();
        let mut polygons = Vec::with_capacity(self.polygons.len());
        for mesh in models.iter().map(|model| &model.mesh) {
            job::poll();
            let first = corners.len() as u32;
            corners.extend(mesh.positions.as_chunks::<3>().0.iter().map(|p| DVec3::from_array(*p)));
            // All triangles are said by no arities at all.
            let triangles = mesh.indices.len() / 3;
            let arities: Vec<u32> = if mesh.face_arities.is_empty() { vec![3; triangles] } else { mesh.face_arities.clone() };
            let mut rest = mesh.indices.as_slice();
            for arity in arities {
                let (face, others) = rest.split_at((arity as usize).min(rest.len()));
                polygons.push(face.iter().map(|index| first + index).collect::<Vec<u32>>());
                rest = others;
            }
        }
        let (vertices, places) = weld(&corners);
        polygons.iter_mut().flatten().for_each(|index| *index = places[*index as usize]);
        Ok((vertices, polygons))
    }
}

/// A line of a polygon with the indices of its vertices only.
fn without_texture(content: &str) -> String {
    let mut line = String::with_capacity(content.len());
    for word in content.split_whitespace() {
        line.push_str(word.split('/').next().unwrap_or(""));
        line.push(' ');
    }
    line
}

fn skipped(word: &str, line: u64, n: usize) -> Malformed {
    let times = if n == 1 { String::new() } else { format!(" ({n} lines)") };
    Malformed::line(line, format!("`{word}` is skipped{times}"))
}

impl Obj {
    /// The polygons as a mesh: triangles and convex quads as they are, all others cut into triangles; one surface per
    /// group. Polygons without area or with crossing sides are skipped and listed by line.
    pub fn mesh(&self, name: &str) -> (Mesh, Vec<Malformed>) {
        let mut mesh = Mesh { name: name.to_owned(), order: 1, nodes: self.vertices.clone(), ..Mesh::default() };
        let mut skipped = Vec::new();
        for group in self.groups.iter().filter(|group| !group.polygons.is_empty()) {
            let starts = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
            for k in &group.polygons {
                job::poll();
                if let Err(fault) = add(&mut mesh, &self.polygons[*k]) {
                    let what = match fault {
                        PolygonFault::NoArea => "the face has no area and is skipped",
                        PolygonFault::Crosses => "the sides of the face cross each other; it is skipped",
                    };
                    skipped.push(Malformed::line(self.lines[*k], what));
                }
            }
            let ends = (mesh.triangles.len() as u32, mesh.quads.len() as u32);
            let name = if group.name.is_empty() { name } else { &group.name };
            mesh.faces.push(FaceRange { name: name.to_owned(), triangles: starts.0..ends.0, quads: starts.1..ends.1, lines: 0..0 });
        }
        mesh.groups = mesh.faces.iter().map(|face| group_of(&mesh, face)).collect();
        (mesh, skipped)
    }
}

/// The set of a surface: its elements and their nodes.
pub(crate) fn group_of(mesh: &Mesh, face: &FaceRange) -> Group {
    let triangles = face.triangles.clone().flat_map(|k| mesh.triangles[k as usize]);
    let quads = face.quads.clone().flat_map(|k| mesh.quads[k as usize]);
    let mut nodes: Vec<u32> = triangles.chain(quads).collect();
    nodes.sort_unstable();
    nodes.dedup();
    Group {
        name: face.name.clone(),
        nodes,
        lines: Vec::new(),
        triangles: face.triangles.clone().collect(),
        quads: face.quads.clone().collect(),
    }
}

fn add(mesh: &mut Mesh, corners: &[u32]) -> Result<(), PolygonFault> {
    let points: Vec<DVec3> = corners.iter().map(|node| mesh.nodes[*node as usize]).collect();
    if let [a, b, c, d] = *corners
        && is_convex(&points)
    {
        mesh.quads.push([a, b, c, d]);
        return Ok(());
    }
    for triangle in polygon(&points)? {
        mesh.triangles.push(triangle.map(|k| corners[k]));
    }
    Ok(())
}

/// Whether all corners turn the same way, seen along the mean normal.
fn is_convex(points: &[DVec3]) -> bool {
    let Some(normal) = unit(newell(points), 0.0) else { return false };
    let n = points.len();
    (0..n).all(|k| {
        let (a, b, c) = (points[k], points[(k + 1) % n], points[(k + 2) % n]);
        (b - a).cross(c - b).dot(normal) > 0.0
    })
}
