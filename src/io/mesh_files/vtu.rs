//! VTK unstructured grid (XML): appended raw bytes or text; an integer array per group.
//!
//! A group with elements is a cell array of ones and zeros, a group of nodes alone a point array.

use std::io::{self, Write};

use crate::base::text::{push_count, push_real};
use crate::base::xml::escaped;
use crate::io::files::block_writer::{write_fixed, write_records};
use crate::io::files::loss::Loss;
use crate::io::files::names::Naming;
use crate::io::mesh_files::binary::{coordinates, integers};
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::elements::{KINDS, Kind};
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::sets::{Set, sets};
use crate::mesh::Mesh;

/// Binary by default.
pub const FORMAT: Format = Format {
    name: "vtu",
    extensions: &["vtu"],
    encoding: Encoding::Binary,
    encodings: &[Encoding::Binary, Encoding::Text],
    elements: &[],
    takes: Takes::Any,
    unit: None,
    colors: false,
    holds: "nodes, elements of order 1 and 2, an array per surface, shell and group",
    write,
};

/// What an array holds; where its bytes come from.
enum Content<'a> {
    Points,
    Connectivity,
    Offsets,
    Types,
    Cells(&'a Set<'a>),
    Nodes(&'a Set<'a>),
}

struct Grid<'a> {
    deck: &'a Deck<'a>,
    mesh: &'a Mesh,
    cells: usize,
    connections: usize,
}

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let (sets, losses) = sets(mesh, Naming::Free);
    let counts = KINDS.map(|kind| kind.count(mesh));
    let connections = KINDS.iter().zip(counts).map(|(kind, n)| kind.nodes_each(mesh.order) * n).sum::<usize>() + mesh.points.len();
    i32::try_from(connections).map_err(|_| io::Error::other("more nodes than a VTU of 32-bit numbers can count"))?;
    let grid = Grid { deck, mesh, cells: counts.iter().sum::<usize>() + mesh.points.len(), connections };
    let text = deck.is_text(FORMAT.encoding);

    let arrays = arrays(&sets);
    writeln!(out, "<?xml version=\"1.0\"?>\n<!-- made by loft, lengths in {} -->", deck.unit)?;
    writeln!(out, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">")?;
    writeln!(out, "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", mesh.nodes.len(), grid.cells)?;
    let mut offset = 0;
    for (section, arrays) in &arrays {
        if arrays.is_empty() {
            continue;
        }
        writeln!(out, "<{section}>")?;
        for array in arrays {
            write!(
                out,
                "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ",
                array.kind,
                escaped(array.name),
                array.components
            )?;
            if text {
                writeln!(out, "format=\"ascii\">")?;
                grid.text(&array.content, out)?;
                writeln!(out, "</DataArray>")?;
            } else {
                writeln!(out, "format=\"appended\" offset=\"{offset}\"/>")?;
                offset += 8 + grid.bytes(&array.content);
            }
        }
        writeln!(out, "</{section}>")?;
    }
    writeln!(out, "</Piece>\n</UnstructuredGrid>")?;
    if !text {
        out.write_all(b"<AppendedData encoding=\"raw\">\n_")?;
        for array in arrays.iter().flat_map(|(_, arrays)| arrays) {
            out.write_all(&(grid.bytes(&array.content) as u64).to_le_bytes())?;
            grid.raw(&array.content, out)?;
        }
        out.write_all(b"\n</AppendedData>\n")?;
    }
    writeln!(out, "</VTKFile>")?;
    Ok(losses)
}

/// All arrays by section, in the order of the file.
fn arrays<'a>(sets: &'a [Set<'a>]) -> Vec<(&'static str, Vec<Array<'a>>)> {
    let cells = |set: &&Set| set.group.dimension() > 0;
    let array = |set: &'a Set<'a>, content| Array::new(&set.name, "UInt8", 1, content);
    vec![
        ("Points", vec![Array::new("Points", "Float64", 3, Content::Points)]),
        (
            "Cells",
            vec![
                Array::new("connectivity", "Int32", 1, Content::Connectivity),
                Array::new("offsets", "Int32", 1, Content::Offsets),
                Array::new("types", "UInt8", 1, Content::Types),
            ],
        ),
        ("CellData", sets.iter().filter(cells).map(|set| array(set, Content::Cells(set))).collect()),
        ("PointData", sets.iter().filter(|set| !cells(set)).map(|set| array(set, Content::Nodes(set))).collect()),
    ]
}

struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    content: Content<'a>,
}

impl<'a> Array<'a> {
    fn new(name: &'a str, kind: &'static str, components: usize, content: Content<'a>) -> Self {
        Self { name, kind, components, content }
    }
}

/// VTK's number of a cell type.
fn cell_type(kind: Kind, order: u8) -> u8 {
    match (kind, order) {
        (Kind::Line, 2) => 21,
        (Kind::Triangle, 2) => 22,
        (Kind::Quad, 2) => 23,
        (Kind::Line, _) => 3,
        (Kind::Triangle, _) => 5,
        (Kind::Quad, _) => 9,
    }
}

const VERTEX: u8 = 1;

impl Grid<'_> {
    fn bytes(&self, content: &Content) -> usize {
        match content {
            Content::Points => 24 * self.mesh.nodes.len(),
            Content::Connectivity => 4 * self.connections,
            Content::Offsets => 4 * self.cells,
            Content::Types | Content::Cells(_) => self.cells,
            Content::Nodes(_) => self.mesh.nodes.len(),
        }
    }

    /// Where the connectivity of cell `i` ends.
    fn offset(&self, i: usize) -> u32 {
        let mut left = i + 1;
        let mut offset = 0;
        for kind in KINDS {
            let here = left.min(kind.count(self.mesh));
            offset += here * kind.nodes_each(self.mesh.order);
            left -= here;
        }
        (offset + left) as u32
    }

    fn types(&self) -> Vec<u8> {
        let mut types = Vec::with_capacity(self.cells);
        for kind in KINDS {
            types.resize(types.len() + kind.count(self.mesh), cell_type(kind, self.mesh.order));
        }
        types.resize(self.cells, VERTEX);
        types
    }

    fn cells_of(&self, set: &Set) -> Vec<u8> {
        let mut flags = vec![0; self.cells];
        for kind in KINDS {
            let first = kind.first_number(self.mesh) as usize - 1;
            for element in kind.of_group(&set.group) {
                flags[first + *element as usize] = 1;
            }
        }
        flags
    }

    fn nodes_of(&self, set: &Set) -> Vec<u8> {
        let mut flags = vec![0; self.mesh.nodes.len()];
        for node in &set.group.nodes {
            flags[*node as usize] = 1;
        }
        flags
    }

    fn raw(&self, content: &Content, out: &mut dyn Write) -> io::Result<()> {
        let mesh = self.mesh;
        match content {
            Content::Points => write_fixed::<24>(out, mesh.nodes.len(), |i, record| coordinates(self.deck, i, record)),
            Content::Connectivity => self.raw_connectivity(out),
            Content::Offsets => write_fixed::<4>(out, self.cells, |i, record| *record = self.offset(i).to_le_bytes()),
            Content::Types => out.write_all(&self.types()),
            Content::Cells(set) => out.write_all(&self.cells_of(set)),
            Content::Nodes(set) => out.write_all(&self.nodes_of(set)),
        }
    }

    fn raw_connectivity(&self, out: &mut dyn Write) -> io::Result<()> {
        let mesh = self.mesh;
        if mesh.order == 2 {
            write_fixed::<12>(out, mesh.lines.len(), |i, record| {
                integers(&mesh.lines[i], record);
                integers(&[mesh.line_mids[i]], &mut record[8..]);
            })?;
            write_fixed::<24>(out, mesh.triangles.len(), |i, record| {
                integers(&mesh.triangles[i], record);
                integers(&mesh.triangle_mids[i], &mut record[12..]);
            })?;
            write_fixed::<32>(out, mesh.quads.len(), |i, record| {
                integers(&mesh.quads[i], record);
                integers(&mesh.quad_mids[i], &mut record[16..]);
            })?;
        } else {
            write_fixed::<8>(out, mesh.lines.len(), |i, record| integers(&mesh.lines[i], record))?;
            write_fixed::<12>(out, mesh.triangles.len(), |i, record| integers(&mesh.triangles[i], record))?;
            write_fixed::<16>(out, mesh.quads.len(), |i, record| integers(&mesh.quads[i], record))?;
        }
        write_fixed::<4>(out, mesh.points.len(), |i, record| *record = mesh.points[i].to_le_bytes())
    }

    fn text(&self, content: &Content, out: &mut dyn Write) -> io::Result<()> {
        let mesh = self.mesh;
        match content {
            Content::Points => write_records(out, mesh.nodes.len(), |i, text| {
                for (k, x) in self.deck.node(i).into_iter().enumerate() {
                    push_real(text, x);
                    text.push(if k < 2 { b' ' } else { b'\n' });
                }
            }),
            Content::Connectivity => {
                for kind in KINDS {
                    write_records(out, kind.count(mesh), |i, text| {
                        kind.nodes(mesh, i, |node| {
                            push_count(text, u64::from(node));
                            text.push(b' ');
                        });
                        text.push(b'\n');
                    })?;
                }
                write_records(out, mesh.points.len(), |i, text| number_line(text, u64::from(mesh.points[i])))
            }
            Content::Offsets => write_records(out, self.cells, |i, text| number_line(text, u64::from(self.offset(i)))),
            Content::Types => flag_lines(out, &self.types()),
            Content::Cells(set) => flag_lines(out, &self.cells_of(set)),
            Content::Nodes(set) => flag_lines(out, &self.nodes_of(set)),
        }
    }
}

fn number_line(text: &mut Vec<u8>, n: u64) {
    push_count(text, n);
    text.push(b'\n');
}

fn flag_lines(out: &mut dyn Write, flags: &[u8]) -> io::Result<()> {
    write_records(out, flags.len(), |i, text| number_line(text, u64::from(flags[i])))
}
