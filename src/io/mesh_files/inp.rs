//! Abaqus and CalculiX input: nodes, elements with a set per surface, node and element sets per group.
//!
//! Both solvers read at most 20 characters of a number, so one that is longer is rounded to fit. Line elements are beams
//! (`B31`, `B32`) unless `element: T3D2` or another name is asked for: a frame of trusses between rigid joints is a
//! mechanism. Of a line of three nodes the middle one stands second. Materials, sections, supports and steps are not
//! ours: include the file from a deck that has them.

use std::io::{self, Write};

use crate::base::text::{Field, push_count, push_field};
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
    name: "inp",
    extensions: &["inp"],
    encoding: Encoding::Text,
    encodings: &[Encoding::Text],
    elements: &[
        ("B31", Shape::Line2),
        ("B31R", Shape::Line2),
        ("B33", Shape::Line2),
        ("T3D2", Shape::Line2),
        ("B32", Shape::Line3),
        ("B32R", Shape::Line3),
        ("T3D3", Shape::Line3),
        ("S3", Shape::Triangle3),
        ("S3R", Shape::Triangle3),
        ("S3RS", Shape::Triangle3),
        ("STRI3", Shape::Triangle3),
        ("M3D3", Shape::Triangle3),
        ("CPS3", Shape::Triangle3),
        ("CPE3", Shape::Triangle3),
        ("CAX3", Shape::Triangle3),
        ("R3D3", Shape::Triangle3),
        ("DS3", Shape::Triangle3),
        ("S6", Shape::Triangle6),
        ("STRI65", Shape::Triangle6),
        ("M3D6", Shape::Triangle6),
        ("CPS6", Shape::Triangle6),
        ("CPE6", Shape::Triangle6),
        ("CAX6", Shape::Triangle6),
        ("DS6", Shape::Triangle6),
        ("S4", Shape::Quad4),
        ("S4R", Shape::Quad4),
        ("S4RS", Shape::Quad4),
        ("S4R5", Shape::Quad4),
        ("M3D4", Shape::Quad4),
        ("M3D4R", Shape::Quad4),
        ("CPS4", Shape::Quad4),
        ("CPS4R", Shape::Quad4),
        ("CPE4", Shape::Quad4),
        ("CPE4R", Shape::Quad4),
        ("CAX4", Shape::Quad4),
        ("CAX4R", Shape::Quad4),
        ("R3D4", Shape::Quad4),
        ("DS4", Shape::Quad4),
        ("S8", Shape::Quad8),
        ("S8R", Shape::Quad8),
        ("S8R5", Shape::Quad8),
        ("M3D8", Shape::Quad8),
        ("M3D8R", Shape::Quad8),
        ("CPS8", Shape::Quad8),
        ("CPS8R", Shape::Quad8),
        ("CPE8", Shape::Quad8),
        ("CPE8R", Shape::Quad8),
        ("CAX8", Shape::Quad8),
        ("CAX8R", Shape::Quad8),
        ("DS8", Shape::Quad8),
    ],
    takes: Takes::Any,
    unit: None,
    colors: false,
    holds: "nodes, elements of order 1 and 2, a set per surface, shell and group",
    write,
};

/// Longest number that both solvers read whole.
const NUMBER: Field = Field::Free(20);
/// Numbers of a set on a line: the solvers take up to 16, but one of them no more than 132 characters.
const ON_A_LINE: usize = 10;

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let mut names = Names::of_mesh(Naming::Strict, mesh);
    let groups: Vec<String> = mesh.groups.iter().map(|group| names.give(&group.name)).collect();
    let mut own: Vec<(String, String)> = Vec::new();
    for face in &mesh.faces {
        if !own.iter().any(|(name, _)| *name == face.name) {
            let group = mesh.groups.iter().position(|group| group.name == face.name);
            own.push((face.name.clone(), group.map_or_else(|| names.give(&face.name), |g| groups[g].clone())));
        }
    }

    let renamed = names.comments("**");
    writeln!(out, "** {}: made by loft, lengths in {}\n{renamed}*NODE", ascii(&mesh.name), deck.unit)?;
    write_records(out, mesh.nodes.len(), |i, text| {
        push_count(text, i as u64 + 1);
        for x in deck.node(i) {
            text.extend_from_slice(b", ");
            push_field(text, x, NUMBER);
        }
        text.push(b'\n');
    })?;
    for (kind, shape) in KINDS.into_iter().zip(Shape::of_order(mesh.order)) {
        let element = FORMAT.element_name(deck.options, shape);
        for run in runs(mesh, kind) {
            match run.name.and_then(|name| own.iter().find(|(own, _)| *own == name)) {
                Some((_, set)) => writeln!(out, "*ELEMENT, TYPE={element}, ELSET={set}")?,
                None => writeln!(out, "*ELEMENT, TYPE={element}")?,
            }
            let first = kind.first_number(mesh) + run.elements.start as u64;
            write_records(out, run.elements.len(), |i, text| {
                push_count(text, first + i as u64);
                nodes(kind, mesh, run.elements.start + i, |node| {
                    text.extend_from_slice(b", ");
                    push_count(text, u64::from(node) + 1);
                });
                text.push(b'\n');
            })?;
        }
    }
    for (group, name) in mesh.groups.iter().zip(&groups) {
        if !own.iter().any(|(_, set)| set == name) && group.dimension() > 0 {
            write_set(out, &format!("*ELSET, ELSET={name}"), &element_numbers(mesh, group))?;
        }
        if !group.nodes.is_empty() {
            let nodes: Vec<u64> = group.nodes.iter().map(|node| u64::from(*node) + 1).collect();
            write_set(out, &format!("*NSET, NSET={name}"), &nodes)?;
        }
    }
    Ok(names.losses)
}

/// Nodes of an element in the order of the solvers: corners and then mid nodes, but of a line end, middle, end.
fn nodes(kind: Kind, mesh: &Mesh, index: usize, mut each: impl FnMut(u32)) {
    match (kind, mesh.line_mids.get(index)) {
        (Kind::Line, Some(mid)) => {
            let [start, end] = mesh.lines[index];
            [start, *mid, end].into_iter().for_each(each);
        }
        _ => kind.nodes(mesh, index, &mut each),
    }
}

fn write_set(out: &mut dyn Write, head: &str, numbers: &[u64]) -> io::Result<()> {
    writeln!(out, "{head}")?;
    write_records(out, numbers.len().div_ceil(ON_A_LINE), |line, text| {
        let start = line * ON_A_LINE;
        for (k, n) in numbers[start..numbers.len().min(start + ON_A_LINE)].iter().enumerate() {
            if k > 0 {
                text.extend_from_slice(b", ");
            }
            push_count(text, *n);
        }
        text.push(b'\n');
    })
}
