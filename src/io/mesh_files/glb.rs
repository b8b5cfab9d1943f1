//! GLB, the binary form of glTF 2.0: a node with one mesh, a primitive for each surface and curve, their colours as materials.
//!
//! Lengths are in metres and y is up (glTF 2.0, section 3.4): (x, y, z) of the model is (x, z, −y). Positions are in single precision
//! (section 3.6) relative to the centre of the model, which is the translation of the node, so that a model far from the origin
//! keeps its shape. Sets of elements are `extras` of the mesh: runs of elements of its primitives.

use std::collections::BTreeMap;
use std::io::{self, Write};

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::math;
use crate::io::files::loss::Loss;
use crate::io::mesh_files::closed_bodies::bodies;
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::elements::{KINDS, Kind};
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::glb_buffers::{Buffers, Geometry, Placed, Span, joined, shaded};
use crate::io::mesh_files::losses::{left_out, names_lost};
use crate::io::mesh_files::regions::{Regions, named_sets};
use crate::io::mesh_files::sets::Set;
use crate::io::mesh_files::single_precision::rounding;
use crate::io::mesh_files::triangulated::halves;
use crate::io::tables::json::{self, Json};
use crate::mesh::Group;

/// Binary only.
pub const FORMAT: Format = Format {
    name: "glb",
    extensions: &["glb"],
    encoding: Encoding::Binary,
    encodings: &[Encoding::Binary],
    elements: &[],
    takes: Takes::Any,
    unit: Some("m"),
    colors: true,
    holds: "triangles, quads as two of them, lines and points of order 1; a name and colour per surface and curve, sets of elements",
    write,
};

/// Colour of surfaces and curves of which none is known, sRGB: those of pictures.
const FACES: [f64; 3] = [182.0 / 255.0, 206.0 / 255.0, 232.0 / 255.0];
const LINES: [f64; 3] = [20.0 / 255.0, 74.0 / 255.0, 160.0 / 255.0];

/// What glTF calls points, lines and triangles (`mesh.primitive.mode`).
const MODES: [f64; 3] = [0.0, 1.0, 4.0];
/// What it calls 32-bit floats and unsigned integers (`accessor.componentType`).
const FLOAT: f64 = 5126.0;
const UNSIGNED: f64 = 5125.0;
/// What it calls buffers of vertices and of indices (`bufferView.target`).
const VERTICES: f64 = 34962.0;
const INDICES: f64 = 34963.0;
/// Words at the head of the file and of its chunks (section 4.4).
const MAGIC: [u8; 4] = *b"glTF";
const JSON_CHUNK: [u8; 4] = *b"JSON";
const BINARY_CHUNK: [u8; 4] = *b"BIN\0";

/// Numbers of the views of the buffer, in the order in which they stand there.
const POSITIONS_VIEW: usize = 0;
const INDICES_VIEW: usize = 1;
const NORMALS_VIEW: usize = 2;

/// A part of the mesh with one material.
struct Primitive {
    /// Index into [`MODES`].
    mode: usize,
    /// Its surface or curve and its material, as indices; points have none.
    region: Option<(usize, usize)>,
    /// Its first triangle that is half of a quad, where there is one.
    first_half: Option<usize>,
    placed: Placed,
}

/// Elements of a primitive: its index, the first element and how many.
type Piece = (usize, usize, usize);

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let (sets, names, mut losses) = named_sets(mesh);
    let used = 0..mesh.corner_count() as u32;
    let origin = if used.is_empty() { DVec3::ZERO } else { Box3::of(used.map(|n| deck.place(n))).center() };
    let moved = rounding(deck, origin).map_err(|corners| {
        io::Error::other(format!(
            "GLB has single precision, in which corners of a triangle at {} coincide: write it as .obj or .ply",
            corners.place(deck)
        ))
    })?;
    let mut scene = SceneWriter { deck, origin, buffers: Buffers::default(), primitives: Vec::new(), pieces: BTreeMap::new() };
    let regions = Regions::new(mesh, &KINDS);
    scene.add_regions(&regions);
    let document = scene.document(&regions, &names, &sets);
    let Buffers { positions, normals, indices } = &scene.buffers;
    put(&document, &[positions, indices, normals], out)?;
    let digits = |moved: f64| Loss::LeftOut(format!("all digits of the nodes: they move by up to {moved:.1e} {}", deck.unit));
    losses.extend(moved.map(digits));
    losses.extend(left_out(mesh, false));
    losses.extend(names_lost(mesh, deck.options, "the node sets", |group| group.dimension() == 0));
    Ok(losses)
}

/// Writes the head of the file and its chunks, each of a multiple of four bytes (section 4.4).
fn put(document: &Json, buffers: &[&Vec<u8>], out: &mut dyn Write) -> io::Result<()> {
    let mut text = Vec::new();
    json::write(document, &mut text)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let bytes: usize = buffers.iter().map(|buffer| buffer.len()).sum();
    let chunks = if bytes == 0 { 8 + text.len() } else { 16 + text.len() + bytes };
    let total = u32::try_from(12 + chunks).map_err(|_| io::Error::other("GLB counts its bytes with 32 bits, and these are more"))?;
    let word = |n: usize| (n as u32).to_le_bytes();
    out.write_all(&[MAGIC, word(2), total.to_le_bytes(), word(text.len()), JSON_CHUNK].concat())?;
    out.write_all(&text)?;
    if bytes > 0 {
        out.write_all(&[word(bytes), BINARY_CHUNK].concat())?;
        buffers.iter().try_for_each(|buffer| out.write_all(buffer))?;
    }
    Ok(())
}

/// Collects primitives and their numbers.
struct SceneWriter<'a> {
    deck: &'a Deck<'a>,
    origin: DVec3,
    buffers: Buffers,
    primitives: Vec<Primitive>,
    /// For each kind, where each element is.
    pieces: BTreeMap<Kind, Vec<Piece>>,
}

impl SceneWriter<'_> {
    /// A primitive for the faces and one for the lines of each region, then one for all points.
    fn add_regions(&mut self, regions: &Regions) {
        let mesh = self.deck.mesh;
        let mut members: Vec<BTreeMap<Kind, Vec<usize>>> = regions.names.iter().map(|_| BTreeMap::new()).collect();
        for kind in KINDS {
            self.pieces.insert(kind, vec![(0, 0, 0); kind.count(mesh)]);
            for (element, region) in regions.of(kind).iter().enumerate() {
                members[*region as usize].entry(kind).or_default().push(element);
            }
        }
        for (region, members) in members.iter().enumerate() {
            let of = |kind: Kind| members.get(&kind).map_or(&[][..], |own| own);
            self.add_faces(region, of(Kind::Triangle), of(Kind::Quad));
            self.add_lines(region, of(Kind::Line));
        }
        if !mesh.points.is_empty() {
            self.add(0, None, None, &Geometry { nodes: mesh.points.clone(), ..Geometry::default() });
        }
    }

    fn add_faces(&mut self, region: usize, triangles: &[usize], quads: &[usize]) {
        let mesh = self.deck.mesh;
        let of_quads = quads.iter().flat_map(|quad| halves(mesh, *quad));
        let all: Vec<[u32; 3]> = triangles.iter().map(|k| mesh.triangles[*k]).chain(of_quads).collect();
        if all.is_empty() {
            return;
        }
        let primitive = self.primitives.len();
        let place = |kind: Kind, own: &[usize], from: usize, each: usize, pieces: &mut BTreeMap<Kind, Vec<Piece>>| {
            let pieces = pieces.entry(kind).or_default();
            own.iter().enumerate().for_each(|(k, element)| pieces[*element] = (primitive, from + each * k, each));
        };
        place(Kind::Triangle, triangles, 0, 1, &mut self.pieces);
        place(Kind::Quad, quads, triangles.len(), 2, &mut self.pieces);
        let first_half = (!quads.is_empty()).then_some(triangles.len());
        self.add(2, Some(region), first_half, &shaded(self.deck, &all));
    }

    fn add_lines(&mut self, region: usize, lines: &[usize]) {
        if lines.is_empty() {
            return;
        }
        let primitive = self.primitives.len();
        let pieces = self.pieces.entry(Kind::Line).or_default();
        lines.iter().enumerate().for_each(|(k, element)| pieces[*element] = (primitive, k, 1));
        let all: Vec<[u32; 2]> = lines.iter().map(|k| self.deck.mesh.lines[*k]).collect();
        self.add(1, Some(region), None, &joined(&all));
    }

    fn add(&mut self, mode: usize, region: Option<usize>, first_half: Option<usize>, geometry: &Geometry) {
        let placed = self.buffers.add(self.deck, self.origin, geometry);
        let materials = self.primitives.iter().filter(|known| known.region.is_some()).count();
        self.primitives.push(Primitive { mode, region: region.map(|region| (region, materials)), first_half, placed });
    }

    /// The JSON of the file: scene, node, mesh, materials, accessors, views of the buffer (sections 3.5 to 3.9).
    fn document(&self, regions: &Regions, names: &BTreeMap<&str, String>, sets: &[Set]) -> Json {
        let mesh = self.deck.mesh;
        let asset = record([("version", text("2.0")), ("generator", text("loft"))]);
        let mut node = vec![("name", text(&mesh.name))];
        let mut document = vec![("asset", asset), ("scene", number(0)), ("scenes", list([record([("nodes", list([number(0)]))])]))];
        if self.primitives.is_empty() {
            document.push(("nodes", list([record(node)])));
            return record(document);
        }
        node.push(("mesh", number(0)));
        node.push(("translation", list(Buffers::translation(self.origin).map(Json::Number))));
        document.push(("nodes", list([record(node)])));
        let name_of = |region: usize| names.get(regions.names[region]).map_or(regions.names[region], String::as_str);
        let mut accessors = Vec::new();
        let primitives: Vec<Json> = self.primitives.iter().map(|primitive| primitive.json(name_of, &mut accessors)).collect();
        let mut own = vec![("name", text(&mesh.name)), ("primitives", Json::List(primitives))];
        let groups: Vec<Json> = sets.iter().filter_map(|set| self.set(&set.name, &set.group)).collect();
        if !groups.is_empty() {
            own.push(("extras", record([("groups", Json::List(groups))])));
        }
        document.push(("meshes", list([record(own)])));
        // A closed mesh that points inwards has its far side alone seen, so it keeps both.
        let closed = mesh.is_watertight() && bodies(mesh).is_ok_and(|all| all.iter().all(|body| !body.inside_out));
        let of_primitive = |own: &Primitive| {
            let (region, _) = own.region?;
            Some(material(self.deck, regions.names[region], name_of(region), own.mode, closed))
        };
        let materials: Vec<Json> = self.primitives.iter().filter_map(of_primitive).collect();
        if !materials.is_empty() {
            document.push(("materials", Json::List(materials)));
        }
        document.push(("accessors", Json::List(accessors)));
        self.buffer_views(&mut document);
        record(document)
    }

    fn buffer_views(&self, document: &mut Vec<(&str, Json)>) {
        let Buffers { positions, normals, indices } = &self.buffers;
        let (mut views, mut start) = (Vec::new(), 0);
        // Lines have no normals and points no indices either: what is empty, which glTF has no view for, stands last.
        let all = [(positions, VERTICES, Some(12)), (indices, INDICES, None), (normals, VERTICES, Some(12))];
        for (bytes, target, stride) in all.into_iter().filter(|(bytes, ..)| !bytes.is_empty()) {
            let mut view = vec![("buffer", number(0)), ("byteOffset", number(start)), ("byteLength", number(bytes.len()))];
            view.extend(stride.map(|stride| ("byteStride", number(stride))));
            view.push(("target", Json::Number(target)));
            views.push(record(view));
            start += bytes.len();
        }
        document.push(("bufferViews", Json::List(views)));
        document.push(("buffers", list([record([("byteLength", number(start))])])));
    }

    /// A set of elements: where they are, in runs; `None` for one of nodes.
    fn set(&self, name: &str, group: &Group) -> Option<Json> {
        let mut pieces: Vec<Piece> = KINDS
            .iter()
            .flat_map(|kind| kind.of_group(group).iter().filter_map(|element| self.pieces.get(kind)?.get(*element as usize).copied()))
            .collect();
        pieces.sort_unstable();
        let mut runs: Vec<Piece> = Vec::new();
        for (primitive, first, count) in pieces {
            match runs.last_mut() {
                Some(last) if last.0 == primitive && last.1 + last.2 == first => last.2 += count,
                _ => runs.push((primitive, first, count)),
            }
        }
        let run = |(primitive, first, count): Piece| {
            record([("primitive", number(primitive)), ("first", number(first)), ("count", number(count))])
        };
        (!runs.is_empty()).then(|| record([("name", text(name)), ("elements", Json::List(runs.into_iter().map(run).collect()))]))
    }
}

impl Primitive {
    fn json<'a>(&self, name_of: impl Fn(usize) -> &'a str, accessors: &mut Vec<Json>) -> Json {
        let accessor = |view: usize, span: Span, component: f64, sort: &str| {
            vec![
                ("bufferView", number(view)),
                ("byteOffset", number(span.start)),
                ("componentType", Json::Number(component)),
                ("count", number(span.count)),
                ("type", text(sort)),
            ]
        };
        let mut put = |fields: Vec<(&str, Json)>| {
            accessors.push(record(fields));
            number(accessors.len() - 1)
        };
        let (span, min, max) = self.placed.positions;
        let mut positions = accessor(POSITIONS_VIEW, span, FLOAT, "VEC3");
        let three = |x: [f32; 3]| list(x.map(|x| Json::Number(f64::from(x))));
        positions.extend([("min", three(min)), ("max", three(max))]);
        let mut attributes = vec![("POSITION", put(positions))];
        attributes.extend(self.placed.normals.map(|span| ("NORMAL", put(accessor(NORMALS_VIEW, span, FLOAT, "VEC3")))));
        let mut fields = vec![("attributes", record(attributes)), ("mode", Json::Number(MODES[self.mode]))];
        fields.extend(self.placed.indices.map(|span| ("indices", put(accessor(INDICES_VIEW, span, UNSIGNED, "SCALAR")))));
        if let Some((region, material)) = self.region {
            fields.push(("material", number(material)));
            let mut extras = vec![("name", text(name_of(region)))];
            // From there on two triangles after each other are a quad.
            extras.extend(self.first_half.map(|first| ("quads_from", number(first))));
            fields.push(("extras", record(extras)));
        }
        record(fields)
    }
}

/// A dull material of a colour, seen from both sides unless the mesh is closed (section 3.9). Factors of colours are linear.
fn material(deck: &Deck, region: &str, name: &str, mode: usize, closed: bool) -> Json {
    let color = deck.color(region).unwrap_or(if mode == 2 { FACES } else { LINES });
    let [red, green, blue] = color.map(|x| Json::Number(linear(x)));
    let surface = record([
        ("baseColorFactor", list([red, green, blue, Json::Number(1.0)])),
        ("metallicFactor", Json::Number(0.0)),
        ("roughnessFactor", Json::Number(0.75)),
    ]);
    record([("name", text(name)), ("pbrMetallicRoughness", surface), ("doubleSided", Json::Bool(!closed))])
}

/// The intensity of a share of red, green or blue as screens take it (IEC 61966-2-1), 0 to 1.
fn linear(share: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    if share <= 0.04045 { share / 12.92 } else { math::pow((share + 0.055) / 1.055, 2.4) }
}

fn number(n: usize) -> Json {
    Json::Number(n as f64)
}

fn text(words: &str) -> Json {
    Json::Text(words.to_owned())
}

fn list(items: impl IntoIterator<Item = Json>) -> Json {
    Json::List(items.into_iter().collect())
}

fn record<'a>(fields: impl IntoIterator<Item = (&'a str, Json)>) -> Json {
    Json::Record(fields.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}
