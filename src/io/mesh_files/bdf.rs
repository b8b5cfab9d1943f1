//! Nastran bulk data: `GRID*` in large fields, `CTRIA3 CQUAD4 CTRIA6 CQUAD8`, line elements as beams (`CBAR`, of order 2
//! `CBEAM3`), a property per surface and curve, `SET` cards in the case control for every set.
//!
//! A large field has 16 characters, so a number that is longer is rounded to fit. Sets have numbers in Nastran: the
//! comment above each says its name. Thickness, area and material are not ours: the properties name material 1 and
//! leave the rest to the analyst; one that may not be left open is a comment with its number.

use std::collections::BTreeMap;
use std::io::{self, Write};

use crate::base::text::{Field, push_count, push_count_padded, push_field};
use crate::io::files::block_writer::write_records;
use crate::io::files::loss::Loss;
use crate::io::files::names::{Names, Naming, ascii};
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::element_groups::runs;
use crate::io::mesh_files::element_shape::Shape;
use crate::io::mesh_files::elements::{KINDS, Kind, element_numbers};
use crate::io::mesh_files::format::{Format, Takes};
use crate::mesh::Mesh;

/// Text only.
pub const FORMAT: Format = Format {
    name: "bdf",
    extensions: &["bdf", "nas"],
    encoding: Encoding::Text,
    encodings: &[Encoding::Text],
    elements: &[
        ("CBAR", Shape::Line2),
        ("CBEAM", Shape::Line2),
        ("CROD", Shape::Line2),
        ("CBEAM3", Shape::Line3),
        ("CTRIA3", Shape::Triangle3),
        ("CTRIAR", Shape::Triangle3),
        ("CTRIA6", Shape::Triangle6),
        ("CQUAD4", Shape::Quad4),
        ("CQUADR", Shape::Quad4),
        ("CSHEAR", Shape::Quad4),
        ("CQUAD8", Shape::Quad8),
    ],
    takes: Takes::Any,
    unit: None,
    colors: false,
    holds: "nodes, elements of order 1 and 2, a property per surface and curve, sets of elements and nodes",
    write,
};

/// Largest number of a node, element or set in a field of eight.
const LARGEST: usize = 99_999_999;
/// Longest line of the case control.
const CASE_LINE: usize = 72;

/// Cards with the card of their properties, and whether that may leave out what the analyst has to say.
const PROPERTIES: &[(&str, &str, bool)] =
    &[("CBAR", "PBAR", true), ("CBEAM", "PBEAM", false), ("CROD", "PROD", false), ("CBEAM3", "PBEAM3", false), ("CSHEAR", "PSHEAR", false)];
/// The property of all other cards.
const SHELL: (&str, bool) = ("PSHELL", true);
/// A beam may not run along the direction of its first plane; closer to it than 15° counts as along it: its cosine.
const STEEP: f64 = 0.965_925_826_289_068_3;

/// Parts of a beam with a middle node between places at which its direction is asked for.
const BENT: u32 = 8;

/// Elements of one surface or curve, with their card and the number of their property.
struct Section {
    kind: Kind,
    card: &'static str,
    property: u64,
    /// Direction in the first plane of the beams, for cards that have one.
    upright: Option<Upright>,
    elements: std::ops::Range<usize>,
}

/// The axis in the first plane of beams.
#[derive(Clone, Copy)]
enum Upright {
    /// The same for all of them: 0 is x, 1 y, 2 z.
    Same(usize),
    /// No axis is off all of them: each has its own.
    Each,
}

impl Section {
    /// Whether mid nodes of lines have no place on its card.
    fn drops_mids(&self, mesh: &Mesh) -> bool {
        self.kind == Kind::Line && mesh.order == 2 && self.card != "CBEAM3"
    }
}

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let elements = mesh.lines.len() + mesh.triangles.len() + mesh.quads.len();
    if mesh.nodes.len().max(elements) > LARGEST {
        return Err(io::Error::other(format!("Nastran numbers nodes and elements up to {LARGEST}")));
    }
    let mut names = Names::of_mesh(Naming::Strict, mesh);
    let groups: Vec<String> = mesh.groups.iter().map(|group| names.give(&group.name)).collect();
    let properties = properties(deck, &groups, &mut names);
    let renamed = names.comments("$");
    writeln!(out, "$ {}: made by loft, lengths in {}\n{renamed}SOL 101\nCEND", ascii(&mesh.name), deck.unit)?;
    write_sets(mesh, &groups, out)?;
    writeln!(out, "BEGIN BULK")?;
    let sections = write_properties(deck, &properties, out)?;
    write_records(out, mesh.nodes.len(), |i, text| {
        let [x, y, z] = deck.node(i);
        text.extend_from_slice(b"GRID*   ");
        push_count_padded(text, i as u64 + 1, 32);
        push_field(text, x, Field::Nastran(16));
        push_field(text, y, Field::Nastran(16));
        text.extend_from_slice(b"*\n*       ");
        push_field(text, z, Field::Nastran(16));
        text.push(b'\n');
    })?;
    for section in &sections {
        let first = section.kind.first_number(mesh);
        write_records(out, section.elements.len(), |i, text| {
            let element = section.elements.start + i;
            push_card(mesh, section, element, first + element as u64, text);
        })?;
    }
    writeln!(out, "ENDDATA")?;
    let mut losses = names.losses;
    if sections.iter().any(|section| section.drops_mids(mesh)) {
        losses.push(Loss::LeftOut("the mid nodes of line elements of order 2".to_owned()));
    }
    Ok(losses)
}

/// The card of a kind's elements.
fn card(deck: &Deck, kind: Kind) -> &'static str {
    FORMAT.element_name(deck.options, Shape::of_order(deck.mesh.order)[kind as usize])
}

/// The property card of an element card, and whether it may stay open.
fn property_of(card: &str) -> (&'static str, bool) {
    PROPERTIES.iter().find(|known| known.0 == card).map_or(SHELL, |known| (known.1, known.2))
}

/// A property: of which surface or curve, its card, and its name in the file.
struct Property {
    of: Option<String>,
    card: &'static str,
    name: String,
}

/// One property per surface and curve and kind of card, in order of their elements.
fn properties(deck: &Deck, groups: &[String], names: &mut Names) -> Vec<Property> {
    let mesh = deck.mesh;
    let of_group: BTreeMap<&str, &String> = mesh.groups.iter().rev().map(|group| group.name.as_str()).zip(groups.iter().rev()).collect();
    let mut known: BTreeMap<Option<String>, (String, Vec<&str>)> = BTreeMap::new();
    let mut properties: Vec<Property> = Vec::new();
    for kind in KINDS {
        let (card, _) = property_of(card(deck, kind));
        for run in runs(mesh, kind) {
            let (name, cards) = known.entry(run.name.clone()).or_insert_with(|| {
                let name = match &run.name {
                    None => "elements of no surface".to_owned(),
                    Some(name) => of_group.get(name.as_str()).map_or_else(|| names.give(name), |group| (*group).clone()),
                };
                (name, Vec::new())
            });
            if !cards.contains(&card) {
                cards.push(card);
                properties.push(Property { of: run.name, card, name: name.clone() });
            }
        }
    }
    properties
}

/// Writes the properties; gives what elements go by each.
fn write_properties(deck: &Deck, properties: &[Property], out: &mut dyn Write) -> io::Result<Vec<Section>> {
    for (k, Property { card, name, .. }) in properties.iter().enumerate() {
        let number = k + 1;
        match PROPERTIES.iter().any(|known| known.1 == *card && !known.2) {
            true => writeln!(out, "$ {card} {number}: {name}, to be written with its section")?,
            false => writeln!(out, "$ {card} {number}: {name}\n{card:8}{number:<8}1")?,
        }
    }
    let places: BTreeMap<(&str, Option<&str>), usize> =
        properties.iter().enumerate().map(|(k, known)| ((known.card, known.of.as_deref()), k)).collect();
    let mut sections = Vec::new();
    for kind in KINDS {
        let card = card(deck, kind);
        for run in runs(deck.mesh, kind) {
            let of = places.get(&(property_of(card).0, run.name.as_deref()));
            let upright = matches!(card, "CBAR" | "CBEAM" | "CBEAM3").then(|| upright(deck.mesh, run.elements.clone()));
            sections.push(Section { kind, card, property: of.map_or(0, |k| *k) as u64 + 1, upright, elements: run.elements });
        }
    }
    Ok(sections)
}

/// The direction of the first plane of the beams along a curve: one for all of them where some axis is off each.
fn upright(mesh: &Mesh, lines: std::ops::Range<usize>) -> Upright {
    let along = lines.map(|line| along_axes(mesh, line)).fold([0.0_f64; 3], |most, own| std::array::from_fn(|k| most[k].max(own[k])));
    let axis = off_axis(along);
    if along[axis] > STEEP { Upright::Each } else { Upright::Same(axis) }
}

/// How far a line element runs along each axis: the largest cosines of its directions, with a middle node at places along it.
fn along_axes(mesh: &Mesh, line: usize) -> [f64; 3] {
    let node = |n: u32| mesh.nodes[n as usize];
    let [a, b] = mesh.lines[line].map(node);
    let bent = mesh.line_mids.get(line).map(|mid| 4.0 * node(*mid)).map(|mid| (mid - 3.0 * a - b, a + 3.0 * b - mid));
    let (from, to) = bent.unwrap_or((b - a, b - a));
    let runs = (0..=BENT).map(|k| from.lerp(to, f64::from(k) / f64::from(BENT)).normalize_or_zero().abs().to_array());
    runs.fold([0.0; 3], |most, own| std::array::from_fn(|k| own[k].max(most[k])))
}

/// The axis for what runs so far along each: z, and where that is too close the one that it stands furthest from. A beam, which
/// is straight or bent in one plane, has one that it is off.
fn off_axis(along: [f64; 3]) -> usize {
    let level = if along[1] <= along[0] { 1 } else { 0 };
    if along[2] <= STEEP || along[2] < along[level] { 2 } else { level }
}

/// An element: eight fields on a line, the rest on a continuation.
fn push_card(mesh: &Mesh, section: &Section, element: usize, number: u64, text: &mut Vec<u8>) {
    text.extend_from_slice(section.card.as_bytes());
    text.resize(text.len() + 8 - section.card.len(), b' ');
    push_count_padded(text, number, 8);
    push_count_padded(text, section.property, 8);
    let mut field = 2;
    let mut push = |node: u32| {
        if field == 8 {
            text.extend_from_slice(b"+\n+       ");
        }
        push_count_padded(text, u64::from(node) + 1, 8);
        field += 1;
    };
    match section.kind {
        Kind::Line if section.drops_mids(mesh) => mesh.lines[element].iter().for_each(|node| push(*node)),
        kind => kind.nodes(mesh, element, &mut push),
    }
    let axis = section.upright.map(|upright| match upright {
        Upright::Same(axis) => axis,
        Upright::Each => off_axis(along_axes(mesh, element)),
    });
    for own in axis.into_iter().flat_map(|axis| [0, 1, 2].map(|k| k == axis)) {
        text.extend_from_slice(if own { b"1.0     " } else { b"0.0     " });
    }
    while text.last() == Some(&b' ') {
        text.pop();
    }
    text.push(b'\n');
}

/// `SET n = 1 THRU 20, 25`: elements of each set as 2k - 1, nodes as 2k.
fn write_sets(mesh: &Mesh, names: &[String], out: &mut dyn Write) -> io::Result<()> {
    for (k, (group, name)) in mesh.groups.iter().zip(names).enumerate() {
        let nodes: Vec<u64> = group.nodes.iter().map(|node| u64::from(*node) + 1).collect();
        for (number, what, members) in [(2 * k + 1, "elements", element_numbers(mesh, group)), (2 * k + 2, "nodes", nodes)] {
            if !members.is_empty() {
                writeln!(out, "$ SET {number}: {what} of {name}")?;
                out.write_all(&case_set(number, &members))?;
            }
        }
    }
    Ok(())
}

fn case_set(number: usize, members: &[u64]) -> Vec<u8> {
    let mut text = format!("SET {number} = ").into_bytes();
    let mut line = text.len();
    let mut at = 0;
    while at < members.len() {
        let mut end = at + 1;
        while end < members.len() && members[end] == members[end - 1] + 1 {
            end += 1;
        }
        // A THRU of two numbers is no shorter than the two.
        let end = if end - at < 3 { at + 1 } else { end };
        let mut item = Vec::new();
        push_count(&mut item, members[at]);
        if end - at > 1 {
            item.extend_from_slice(b" THRU ");
            push_count(&mut item, members[end - 1]);
        }
        at = end;
        if at < members.len() {
            item.extend_from_slice(b", ");
        }
        if line + item.len() > CASE_LINE {
            while text.last() == Some(&b' ') {
                text.pop();
            }
            text.extend_from_slice(b"\n        ");
            line = 8;
        }
        line += item.len();
        text.extend_from_slice(&item);
    }
    text.push(b'\n');
    text
}
