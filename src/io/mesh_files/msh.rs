//! Gmsh MSH 4.1, text or binary: one physical group per set and dimension, under its full name.
//!
//! Elements that lie in the same surface and the same groups form one entity. Nodes of a group that no element of it
//! holds become point elements in a physical group of dimension 0, so that sets of nodes survive.

use std::collections::BTreeMap;
use std::io::{self, Write};

use crate::base::bbox::Box3;
use crate::base::job;
use crate::base::text::{push_count, push_real};
use crate::io::files::block_writer::write_records;
use crate::io::files::loss::Loss;
use crate::io::files::names::Naming;
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::element_groups::{ElementGroup, parts};
use crate::io::mesh_files::elements::{KINDS, Kind};
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::sets::{Set, sets};
use crate::mesh::Mesh;

/// Text by default.
pub const FORMAT: Format = Format {
    name: "msh",
    extensions: &["msh"],
    encoding: Encoding::Text,
    encodings: &[Encoding::Binary, Encoding::Text],
    elements: &[],
    takes: Takes::Any,
    unit: None,
    colors: false,
    holds: "nodes, elements of order 1 and 2, a physical group per surface, shell and group",
    write,
};

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let (sets, losses) = sets(deck.mesh, Naming::Free);
    let entities = entities(deck.mesh);
    let mut sink = Sink { out, text: deck.is_text(FORMAT.encoding) };
    let number = u8::from(!sink.text);
    write!(sink.out, "$MeshFormat\n4.1 {number} 8\n")?;
    if !sink.text {
        sink.out.write_all(&1_i32.to_le_bytes())?;
        writeln!(sink.out)?;
    }
    writeln!(sink.out, "$EndMeshFormat")?;
    physical_names(&mut sink, &sets, &entities)?;
    write_entities(&mut sink, deck, &entities)?;
    write_nodes(&mut sink, deck, &entities)?;
    write_elements(&mut sink, deck.mesh, &entities)?;
    Ok(losses)
}

/// Nodes and elements that lie in the same surface (or curve) and the same sets.
struct GeometryEntity {
    dimension: usize,
    /// From 1 in each dimension.
    tag: i32,
    /// Sets as indices; their physical tag is one more.
    sets: Vec<usize>,
    /// Elements, by kind; `None`: the nodes below as point elements.
    parts: Vec<(Option<Kind>, Vec<u32>)>,
    /// Nodes that belong to no entity of lower dimension or before this one.
    nodes: Vec<u32>,
}

/// All entities by dimension, each node in exactly one of them.
fn entities(mesh: &Mesh) -> Vec<GeometryEntity> {
    let mut entities = points(mesh);
    for part in parts(mesh, Kind::Line) {
        let tag = entities.iter().filter(|e| e.dimension == 1).count() as i32 + 1;
        entities.push(GeometryEntity { dimension: 1, tag, sets: part.sets, parts: vec![(Some(Kind::Line), part.elements)], nodes: vec![] });
    }
    let mut surfaces: Vec<ElementGroup> = parts(mesh, Kind::Triangle);
    surfaces.extend(parts(mesh, Kind::Quad));
    let mut places: BTreeMap<(Option<usize>, Vec<usize>), usize> = BTreeMap::new();
    for part in surfaces {
        let next = entities.len();
        let place = *places.entry((part.face, part.sets.clone())).or_insert(next);
        if place == next {
            let tag = places.len() as i32;
            entities.push(GeometryEntity { dimension: 2, tag, sets: part.sets, parts: vec![], nodes: vec![] });
        }
        entities[place].parts.push((Some(part.kind), part.elements));
    }
    own_nodes(mesh, &mut entities);
    entities
}

/// Entities of dimension 0: points of the mesh, and nodes of a set that none of its elements holds.
fn points(mesh: &Mesh) -> Vec<GeometryEntity> {
    let mut sets_of: BTreeMap<u32, Vec<usize>> = mesh.points.iter().map(|node| (*node, Vec::new())).collect();
    let mut held = vec![u32::MAX; mesh.nodes.len()];
    for (s, group) in mesh.groups.iter().enumerate() {
        for kind in KINDS {
            for element in kind.of_group(group) {
                job::poll();
                kind.nodes(mesh, *element as usize, |node| held[node as usize] = s as u32);
            }
        }
        for node in group.nodes.iter().filter(|node| held[**node as usize] != s as u32) {
            sets_of.entry(*node).or_default().push(s);
        }
    }
    let mut by_sets: Vec<GeometryEntity> = Vec::new();
    let mut places: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    for (node, sets) in sets_of {
        let next = by_sets.len();
        let place = *places.entry(sets.clone()).or_insert(next);
        if place == next {
            by_sets.push(GeometryEntity { dimension: 0, tag: next as i32 + 1, sets, parts: vec![(None, vec![])], nodes: vec![] });
        }
        by_sets[place].parts[0].1.push(node);
    }
    by_sets
}

/// Gives each node to the first entity that uses it, lower dimensions first; nodes without elements get one of their own.
fn own_nodes(mesh: &Mesh, entities: &mut Vec<GeometryEntity>) {
    let mut owner = vec![u32::MAX; mesh.nodes.len()];
    for (e, entity) in entities.iter().enumerate() {
        let mut take = |node: u32| {
            let owner = &mut owner[node as usize];
            *owner = (*owner).min(e as u32);
        };
        for (kind, elements) in &entity.parts {
            job::poll();
            match kind {
                None => elements.iter().for_each(|node| take(*node)),
                Some(kind) => elements.iter().for_each(|element| kind.nodes(mesh, *element as usize, &mut take)),
            }
        }
    }
    for (node, owner) in job::looking(owner.iter().enumerate()) {
        if let Some(entity) = entities.get_mut(*owner as usize) {
            entity.nodes.push(node as u32);
        }
    }
    let unused: Vec<u32> = (0..mesh.nodes.len() as u32).filter(|node| owner[*node as usize] == u32::MAX).collect();
    if !unused.is_empty() {
        let tag = entities.iter().filter(|e| e.dimension == 0).count();
        entities.insert(tag, GeometryEntity { dimension: 0, tag: tag as i32 + 1, sets: vec![], parts: vec![], nodes: unused });
    }
}

/// Small numbers in text or binary; long arrays go through [`write_records`].
struct Sink<'a> {
    out: &'a mut dyn Write,
    text: bool,
}

impl Sink<'_> {
    fn ints(&mut self, values: impl IntoIterator<Item = i32>) -> io::Result<()> {
        for value in values {
            if self.text { write!(self.out, "{value} ")? } else { self.out.write_all(&value.to_le_bytes())? }
        }
        Ok(())
    }

    fn sizes(&mut self, values: impl IntoIterator<Item = usize>) -> io::Result<()> {
        for value in values {
            if self.text { write!(self.out, "{value} ")? } else { self.out.write_all(&(value as u64).to_le_bytes())? }
        }
        Ok(())
    }

    fn reals(&mut self, values: impl IntoIterator<Item = f64>) -> io::Result<()> {
        for value in job::looking(values) {
            if self.text {
                let mut text = Vec::new();
                push_real(&mut text, value);
                text.push(b' ');
                self.out.write_all(&text)?;
            } else {
                self.out.write_all(&value.to_le_bytes())?;
            }
        }
        Ok(())
    }

    fn end_line(&mut self) -> io::Result<()> {
        if self.text { writeln!(self.out) } else { Ok(()) }
    }

    /// Opens or ends a section; in binary a line end follows the bytes.
    fn end(&mut self, section: &str) -> io::Result<()> {
        if !self.text {
            writeln!(self.out)?;
        }
        writeln!(self.out, "$End{section}")
    }
}

fn physical_names(sink: &mut Sink, sets: &[Set], entities: &[GeometryEntity]) -> io::Result<()> {
    let mut groups: Vec<(usize, usize)> = entities.iter().flat_map(|e| e.sets.iter().map(|s| (e.dimension, *s))).collect();
    groups.sort_unstable();
    groups.dedup();
    if groups.is_empty() {
        return Ok(());
    }
    writeln!(sink.out, "$PhysicalNames\n{}", groups.len())?;
    for (dimension, s) in groups {
        writeln!(sink.out, "{dimension} {} \"{}\"", s + 1, sets[s].name)?;
    }
    writeln!(sink.out, "$EndPhysicalNames")
}

fn write_entities(sink: &mut Sink, deck: &Deck, entities: &[GeometryEntity]) -> io::Result<()> {
    writeln!(sink.out, "$Entities")?;
    sink.sizes([0, 1, 2, 3].map(|d| entities.iter().filter(|e| e.dimension == d).count()))?;
    sink.end_line()?;
    for entity in entities {
        sink.ints([entity.tag])?;
        let mut bounds = Box3::EMPTY;
        let mut add = |node: u32| bounds = bounds.with(deck.node(node as usize).into());
        entity.nodes.iter().for_each(|node| add(*node));
        for (kind, elements) in &entity.parts {
            match kind {
                None => elements.iter().take(1).for_each(|node| add(*node)),
                Some(kind) => elements.iter().for_each(|element| kind.nodes(deck.mesh, *element as usize, &mut add)),
            }
        }
        sink.reals(bounds.min.to_array())?;
        if entity.dimension > 0 {
            sink.reals(bounds.max.to_array())?;
        }
        sink.sizes([entity.sets.len()])?;
        sink.ints(entity.sets.iter().map(|s| *s as i32 + 1))?;
        if entity.dimension > 0 {
            sink.sizes([0])?;
        }
        sink.end_line()?;
    }
    sink.end("Entities")
}

fn write_nodes(sink: &mut Sink, deck: &Deck, entities: &[GeometryEntity]) -> io::Result<()> {
    let total = deck.mesh.nodes.len();
    let blocks: Vec<&GeometryEntity> = entities.iter().filter(|entity| !entity.nodes.is_empty()).collect();
    writeln!(sink.out, "$Nodes")?;
    sink.sizes([blocks.len(), total, total.min(1), total])?;
    sink.end_line()?;
    let text = sink.text;
    for entity in blocks {
        sink.ints([entity.dimension as i32, entity.tag, 0])?;
        sink.sizes([entity.nodes.len()])?;
        sink.end_line()?;
        write_records(sink.out, entity.nodes.len(), |i, bytes| {
            let tag = u64::from(entity.nodes[i]) + 1;
            if text {
                push_count(bytes, tag);
                bytes.push(b'\n');
            } else {
                bytes.extend_from_slice(&tag.to_le_bytes());
            }
        })?;
        write_records(sink.out, entity.nodes.len(), |i, bytes| {
            let [x, y, z] = deck.node(entity.nodes[i] as usize);
            if text {
                push_real(bytes, x);
                bytes.push(b' ');
                push_real(bytes, y);
                bytes.push(b' ');
                push_real(bytes, z);
                bytes.push(b'\n');
            } else {
                for x in [x, y, z] {
                    bytes.extend_from_slice(&(x + 0.0).to_le_bytes());
                }
            }
        })?;
    }
    sink.end("Nodes")
}

/// Gmsh's number of an element type; `None` is a point.
fn element_type(kind: Option<Kind>, order: u8) -> i32 {
    match (kind, order) {
        (None, _) => 15,
        (Some(Kind::Line), 2) => 8,
        (Some(Kind::Triangle), 2) => 9,
        (Some(Kind::Quad), 2) => 16,
        (Some(Kind::Line), _) => 1,
        (Some(Kind::Triangle), _) => 2,
        (Some(Kind::Quad), _) => 3,
    }
}

fn write_elements(sink: &mut Sink, mesh: &Mesh, entities: &[GeometryEntity]) -> io::Result<()> {
    let meshed = mesh.lines.len() + mesh.triangles.len() + mesh.quads.len();
    let single: usize = entities.iter().flat_map(|e| &e.parts).filter(|(kind, _)| kind.is_none()).map(|(_, nodes)| nodes.len()).sum();
    let total = meshed + single;
    writeln!(sink.out, "$Elements")?;
    sink.sizes([entities.iter().map(|e| e.parts.len()).sum(), total, total.min(1), total])?;
    sink.end_line()?;
    let text = sink.text;
    // Point elements are numbered behind all others, which so keep the numbers they have in every other format.
    let mut next_point = meshed as u64 + 1;
    for entity in entities {
        for (kind, elements) in &entity.parts {
            sink.ints([entity.dimension as i32, entity.tag, element_type(*kind, mesh.order)])?;
            sink.sizes([elements.len()])?;
            sink.end_line()?;
            let first = kind.map_or(next_point, |kind| kind.first_number(mesh));
            write_records(sink.out, elements.len(), |i, bytes| {
                let number = |bytes: &mut Vec<u8>, n: u64| {
                    if text {
                        push_count(bytes, n);
                        bytes.push(b' ');
                    } else {
                        bytes.extend_from_slice(&n.to_le_bytes());
                    }
                };
                let element = elements[i];
                match kind {
                    None => {
                        number(bytes, first + i as u64);
                        number(bytes, u64::from(element) + 1);
                    }
                    Some(kind) => {
                        number(bytes, first + u64::from(element));
                        kind.nodes(mesh, element as usize, |node| number(bytes, u64::from(node) + 1));
                    }
                }
                if text {
                    bytes.push(b'\n');
                }
            })?;
            if kind.is_none() {
                next_point += elements.len() as u64;
            }
        }
    }
    sink.end("Elements")
}
