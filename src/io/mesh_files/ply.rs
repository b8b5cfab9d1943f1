//! PLY: nodes in double precision, faces as lists, line elements as edges.

use std::io::{self, Write};

use crate::base::text::{push_count, push_real};
use crate::io::files::block_writer::{write_fixed, write_records};
use crate::io::files::loss::Loss;
use crate::io::mesh_files::binary::{coordinates, integers};
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::losses::{left_out, names_lost};

/// Binary (little endian) by default.
pub const FORMAT: Format = Format {
    name: "ply",
    extensions: &["ply"],
    encoding: Encoding::Binary,
    encodings: &[Encoding::Binary, Encoding::Text],
    elements: &[],
    takes: Takes::Any,
    unit: None,
    colors: false,
    holds: "nodes, triangles, quads and lines of order 1",
    write,
};

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let text = deck.is_text(FORMAT.encoding);
    let corners = mesh.corner_count();
    let encoding = if text { "ascii" } else { "binary_little_endian" };
    writeln!(out, "ply\nformat {encoding} 1.0\ncomment made by loft, lengths in {}", deck.unit)?;
    writeln!(out, "element vertex {corners}\nproperty double x\nproperty double y\nproperty double z")?;
    let faces = mesh.triangles.len() + mesh.quads.len();
    if faces > 0 {
        writeln!(out, "element face {faces}\nproperty list uchar int vertex_indices")?;
    }
    if !mesh.lines.is_empty() {
        writeln!(out, "element edge {}\nproperty int vertex1\nproperty int vertex2", mesh.lines.len())?;
    }
    writeln!(out, "end_header")?;
    if text {
        write_text(deck, corners, out)?;
    } else {
        write_binary(deck, corners, out)?;
    }
    Ok(left_out(mesh, false).into_iter().chain(names_lost(mesh, deck.options, "the sets", |_| true)).collect())
}

fn write_text(deck: &Deck, corners: usize, out: &mut dyn Write) -> io::Result<()> {
    let mesh = deck.mesh;
    write_records(out, corners, |i, text| {
        let [x, y, z] = deck.node(i);
        push_real(text, x);
        text.push(b' ');
        push_real(text, y);
        text.push(b' ');
        push_real(text, z);
        text.push(b'\n');
    })?;
    write_records(out, mesh.triangles.len(), |i, text| indices(text, Some(3), &mesh.triangles[i]))?;
    write_records(out, mesh.quads.len(), |i, text| indices(text, Some(4), &mesh.quads[i]))?;
    write_records(out, mesh.lines.len(), |i, text| indices(text, None, &mesh.lines[i]))
}

fn indices(text: &mut Vec<u8>, count: Option<u64>, nodes: &[u32]) {
    for (k, n) in count.into_iter().chain(nodes.iter().map(|n| u64::from(*n))).enumerate() {
        if k > 0 {
            text.push(b' ');
        }
        push_count(text, n);
    }
    text.push(b'\n');
}

fn write_binary(deck: &Deck, corners: usize, out: &mut dyn Write) -> io::Result<()> {
    let mesh = deck.mesh;
    write_fixed::<24>(out, corners, |i, record| coordinates(deck, i, record))?;
    write_fixed::<13>(out, mesh.triangles.len(), |i, record| {
        record[0] = 3;
        integers(&mesh.triangles[i], &mut record[1..]);
    })?;
    write_fixed::<17>(out, mesh.quads.len(), |i, record| {
        record[0] = 4;
        integers(&mesh.quads[i], &mut record[1..]);
    })?;
    write_fixed::<8>(out, mesh.lines.len(), |i, record| integers(&mesh.lines[i], record))
}
