//! Nastran bulk data: `GRID*` in large fields, `CTRIA3 CQUAD4 CTRIA6 CQUAD8`, line elements as `CROD`, a property per
//! surface, `SET` cards in the case control for every set.
//!
//! A large field has 16 characters, so a number that is longer is rounded to fit. Sets have numbers in Nastran: the
//! comment above each says its name. Thickness, area and material are not ours: the properties name material 1 and
//! leave the rest to the analyst.

use std::io::{self, Write};

use super::blocks::write_records;
use super::deck::{Deck, Encoding, Format, Loss, Shape};
use super::inp::ascii;
use super::sets::{KINDS, Kind, Names, Naming, element_numbers, runs};
use crate::base::text::{Field, push_count, push_count_padded, push_field};
use crate::mesh::Mesh;

/// Text only.
pub const FORMAT: Format = Format {
    name: "bdf",
    extensions: &["bdf", "nas"],
    encoding: Encoding::Text,
    encodings: &[Encoding::Text],
    elements: &[
        ("CROD", Shape::Line2),
        ("CTRIA3", Shape::Triangle3),
        ("CTRIAR", Shape::Triangle3),
        ("CTRIA6", Shape::Triangle6),
        ("CQUAD4", Shape::Quad4),
        ("CQUADR", Shape::Quad4),
        ("CSHEAR", Shape::Quad4),
        ("CQUAD8", Shape::Quad8),
    ],
    write,
};

/// Largest number of a node, element or set in a field of eight.
const LARGEST: usize = 99_999_999;
/// Longest line of the case control.
const CASE_LINE: usize = 72;

/// Elements of one surface or curve, with the number of its property.
struct Section {
    kind: Kind,
    property: u64,
    elements: std::ops::Range<usize>,
}

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let elements = mesh.lines.len() + mesh.triangles.len() + mesh.quads.len();
    if mesh.nodes.len().max(elements) > LARGEST {
        return Err(io::Error::other(format!("Nastran numbers nodes and elements up to {LARGEST}")));
    }
    let mut names = Names::new(Naming::Strict);
    let groups: Vec<String> = mesh.groups.iter().map(|group| names.give(&group.name)).collect();
    writeln!(out, "$ {}: made by loft, lengths in {}\nSOL 101\nCEND", ascii(&mesh.name), deck.unit)?;
    write_sets(mesh, &groups, out)?;
    writeln!(out, "BEGIN BULK")?;
    let sections = write_properties(mesh, &groups, &mut names, out)?;
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
    let shapes = Shape::of_order(mesh.order);
    for section in &sections {
        let shape = if section.kind == Kind::Line { Shape::Line2 } else { shapes[section.kind as usize] };
        let card = FORMAT.element_name(deck.options, shape);
        let first = section.kind.first_number(mesh);
        write_records(out, section.elements.len(), |i, text| {
            let element = section.elements.start + i;
            push_card(mesh, card, section, (element, first + element as u64), text);
        })?;
    }
    writeln!(out, "ENDDATA")?;
    let mut losses = names.losses;
    if !mesh.line_mids.is_empty() {
        losses.push(Loss::LeftOut("the mid nodes of line elements of order 2".to_owned()));
    }
    Ok(losses)
}

/// One property per surface and curve, in order of their elements.
fn write_properties(mesh: &Mesh, groups: &[String], names: &mut Names, out: &mut dyn Write) -> io::Result<Vec<Section>> {
    let mut properties: Vec<(Option<String>, bool)> = Vec::new();
    let mut sections = Vec::new();
    for kind in KINDS {
        for run in runs(mesh, kind) {
            let key = (run.name, kind == Kind::Line);
            let place = properties.iter().position(|known| *known == key).unwrap_or(properties.len());
            if place == properties.len() {
                let name = match &key.0 {
                    None => "elements of no surface".to_owned(),
                    Some(name) => match mesh.groups.iter().position(|group| group.name == *name) {
                        Some(g) => groups[g].clone(),
                        None => names.give(name),
                    },
                };
                let card = if key.1 { "PROD" } else { "PSHELL" };
                writeln!(out, "$ {card} {}: {name}\n{card:8}{:<8}1", place + 1, place + 1)?;
                properties.push(key);
            }
            sections.push(Section { kind, property: place as u64 + 1, elements: run.elements });
        }
    }
    Ok(sections)
}

/// An element: eight fields on a line, the rest on a continuation.
fn push_card(mesh: &Mesh, card: &str, section: &Section, (element, number): (usize, u64), text: &mut Vec<u8>) {
    text.extend_from_slice(card.as_bytes());
    text.resize(text.len() + 8 - card.len(), b' ');
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
        Kind::Line => mesh.lines[element].iter().for_each(|node| push(*node)),
        kind => kind.nodes(mesh, element, &mut push),
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
