//! Wavefront OBJ: 1-based indices, quads kept, line elements as `l`, one `g` per surface with the groups it lies in.

use std::io::{self, Write};

use crate::base::text::{push_count, push_real};
use crate::io::files::block_writer::write_records;
use crate::io::files::loss::Loss;
use crate::io::files::names::Naming;
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::element_groups::{ElementGroup, parts};
use crate::io::mesh_files::elements::{KINDS, Kind};
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::losses::{left_out, names_lost};
use crate::io::mesh_files::sets::sets;
use crate::mesh::Mesh;

/// Text only.
pub const FORMAT: Format = Format {
    name: "obj",
    extensions: &["obj"],
    encoding: Encoding::Text,
    encodings: &[Encoding::Text],
    elements: &[],
    takes: Takes::Any,
    unit: None,
    colors: false,
    holds: "nodes, polygons, lines and points of order 1, a group per surface, shell and group of elements",
    write,
};

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let (sets, mut losses) = sets(mesh, Naming::Free);
    writeln!(out, "# made by loft, lengths in {}\no {}", deck.unit, mesh.name)?;
    // Mid nodes come after all corner nodes, so leaving them out changes no number.
    let corners = mesh.corner_count();
    write_records(out, corners, |i, text| {
        text.push(b'v');
        for x in deck.node(i) {
            text.push(b' ');
            push_real(text, x);
        }
        text.push(b'\n');
    })?;
    let all: Vec<ElementGroup> = KINDS.iter().flat_map(|kind| parts(mesh, *kind)).collect();
    for part in &all {
        let mut names: Vec<&str> = part.sets.iter().map(|s| sets[*s].name.as_str()).collect();
        if names.is_empty() {
            names.push("default");
        }
        writeln!(out, "g {}", names.join(" "))?;
        write_records(out, part.elements.len(), |i, text| element(mesh, part.kind, part.elements[i] as usize, text))?;
    }
    if !mesh.points.is_empty() {
        writeln!(out, "g points")?;
        write_records(out, mesh.points.len(), |i, text| {
            text.extend_from_slice(b"p ");
            push_count(text, u64::from(mesh.points[i]) + 1);
            text.push(b'\n');
        })?;
    }
    losses.extend(left_out(mesh, false));
    losses.extend(names_lost(mesh, deck.options, "the node sets", |group| group.dimension() == 0));
    Ok(losses)
}

fn element(mesh: &Mesh, kind: Kind, index: usize, text: &mut Vec<u8>) {
    text.push(if kind == Kind::Line { b'l' } else { b'f' });
    let corners: &[u32] = match kind {
        Kind::Line => &mesh.lines[index],
        Kind::Triangle => &mesh.triangles[index],
        Kind::Quad => &mesh.quads[index],
    };
    for node in corners {
        text.push(b' ');
        push_count(text, u64::from(*node) + 1);
    }
    text.push(b'\n');
}
