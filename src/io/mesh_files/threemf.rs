//! 3MF: an archive with a model of solid bodies, as printers of plastic and metal read it.
//!
//! The model is in millimetres (3MF core specification 1.3, section 3.4). Each body is an object with a name whose mesh is closed and
//! points outwards, which the export checks, and sets of faces are triangle sets (section 4.1). Surfaces are base materials with their
//! names and colours (section 5.1). Parts of the archive (chapter 2) are deflated and carry one fixed time, so that the same mesh gives
//! the same bytes.

use std::collections::BTreeMap;
use std::io::{self, Cursor, Seek, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::base::job;
use crate::base::text::{push_count, push_real};
use crate::base::xml::escaped;
use crate::io::files::block_writer::write_records;
use crate::io::files::loss::Loss;
use crate::io::mesh_files::closed_bodies::{Body, bodies};
use crate::io::mesh_files::deck::{Deck, Encoding};
use crate::io::mesh_files::elements::Kind;
use crate::io::mesh_files::format::{Format, Takes};
use crate::io::mesh_files::losses::{left_out, names_lost};
use crate::io::mesh_files::regions::{Regions, named_sets};
use crate::io::mesh_files::sets::Set;
use crate::io::mesh_files::triangulated::count;
use crate::mesh::{Group, Mesh};

/// Binary only.
pub const FORMAT: Format = Format {
    name: "3mf",
    extensions: &["3mf"],
    encoding: Encoding::Binary,
    encodings: &[Encoding::Binary],
    elements: &[],
    takes: Takes::Bodies,
    unit: Some("mm"),
    colors: true,
    holds: "closed bodies of triangles, quads as two of them; a name and colour per surface, sets of faces",
    write,
};

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;
const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;
const MODEL: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:t="http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07">
"#;

/// Colour of surfaces of which none is known: that of pictures.
const FACES: [f64; 3] = [182.0 / 255.0, 206.0 / 255.0, 232.0 / 255.0];
/// Number of the materials, which come first, among the resources of the model.
const MATERIALS: usize = 1;
/// Bytes of a vertex or triangle as text, at most.
const RECORD: usize = 128;

fn write(deck: &Deck, out: &mut dyn Write) -> io::Result<Vec<Loss>> {
    let mesh = deck.mesh;
    let (sets, names, mut losses) = named_sets(mesh);
    let bodies = bodies(mesh).map_err(|defect| io::Error::other(format!("`{}` has {}", mesh.name, defect.words(deck))))?;
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let text = (mesh.nodes.len() + count(mesh) * (1 + sets.len())).saturating_mul(RECORD);
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .large_file(u32::try_from(text).is_err());
    archive.start_file("[Content_Types].xml", options)?;
    archive.write_all(TYPES.as_bytes())?;
    archive.start_file("_rels/.rels", options)?;
    archive.write_all(RELATIONSHIPS.as_bytes())?;
    archive.start_file("3D/3dmodel.model", options)?;
    write_model(&Content { deck, bodies: &bodies, sets: &sets, names: &names }, &mut archive)?;
    out.write_all(archive.finish()?.get_ref())?;
    losses.extend(left_out(mesh, true));
    losses.extend(names_lost(mesh, deck.options, "the sets of lines and nodes", |group| group.dimension() < 2));
    Ok(losses)
}

/// What a model is written from.
struct Content<'a> {
    deck: &'a Deck<'a>,
    bodies: &'a [Body],
    sets: &'a [Set<'a>],
    /// Names of the file by those of the model.
    names: &'a BTreeMap<&'a str, String>,
}

impl Content<'_> {
    fn name_of(&self, name: &str) -> String {
        escaped(self.names.get(name).map_or(name, String::as_str)).into_owned()
    }
}

fn write_model(content: &Content, archive: &mut ZipWriter<impl Write + Seek>) -> io::Result<()> {
    let (deck, mesh) = (content.deck, content.deck.mesh);
    let regions = Regions::new(mesh, &[Kind::Triangle, Kind::Quad]);
    let of_quads = regions.of(Kind::Quad).iter().flat_map(|region| [*region; 2]);
    let region_of: Vec<u32> = regions.of(Kind::Triangle).iter().copied().chain(of_quads).collect();
    write!(
        archive,
        "{MODEL}<metadata name=\"Title\">{}</metadata>\n<metadata name=\"Application\">loft</metadata>\n",
        escaped(&mesh.name)
    )?;
    writeln!(archive, "<resources>")?;
    if !regions.names.is_empty() {
        writeln!(archive, "<basematerials id=\"{MATERIALS}\">")?;
        for name in &regions.names {
            let color = hex(deck.color(name).unwrap_or(FACES));
            writeln!(archive, "<base name=\"{}\" displaycolor=\"{color}\"/>", content.name_of(name))?;
        }
        writeln!(archive, "</basematerials>")?;
    }
    let mut local = vec![0_u32; mesh.nodes.len()];
    let members: Vec<Vec<bool>> = content.sets.iter().map(|set| members(mesh, &set.group)).collect();
    for (k, body) in content.bodies.iter().enumerate() {
        let nodes = nodes_of(mesh, body);
        nodes.iter().zip(0..).for_each(|(node, number)| local[*node as usize] = number);
        let first = body.triangles.first().map_or(0, |first| region_of[*first as usize]);
        let name = match content.bodies {
            [_] => escaped(&mesh.name).into_owned(),
            _ => content.name_of(&body_name(mesh, body, &regions.names, &region_of).unwrap_or_else(|| format!("{}_{}", mesh.name, k + 1))),
        };
        let id = MATERIALS + 1 + k;
        writeln!(
            archive,
            "<object id=\"{id}\" type=\"model\" name=\"{name}\" pid=\"{MATERIALS}\" pindex=\"{first}\">\n<mesh>\n<vertices>"
        )?;
        write_records(archive, nodes.len(), |i, text| vertex(deck.node(nodes[i] as usize), text))?;
        writeln!(archive, "</vertices>\n<triangles>")?;
        write_records(archive, body.triangles.len(), |i, text| {
            let number = body.triangles[i];
            let corners = body.corners(mesh, number).map(|n| local[n as usize]);
            let region = region_of[number as usize];
            triangle(corners, (region != first).then_some(region), text);
        })?;
        writeln!(archive, "</triangles>")?;
        write_sets(content, body, &members, archive)?;
        writeln!(archive, "</mesh>\n</object>")?;
    }
    writeln!(archive, "</resources>\n<build>")?;
    for k in 0..content.bodies.len() {
        writeln!(archive, "<item objectid=\"{}\"/>", MATERIALS + 1 + k)?;
    }
    writeln!(archive, "</build>\n</model>")
}

/// Nodes of a body, ascending.
fn nodes_of(mesh: &Mesh, body: &Body) -> Vec<u32> {
    let mut nodes: Vec<u32> = job::looking(&body.triangles).flat_map(|number| body.corners(mesh, *number)).collect();
    job::sort(&mut nodes);
    nodes.dedup();
    nodes
}

/// The name of the surface that a body is, or of the first set that has its faces and no others.
fn body_name(mesh: &Mesh, body: &Body, regions: &[&str], region_of: &[u32]) -> Option<String> {
    let first = region_of[*body.triangles.first()? as usize];
    if body.triangles.iter().all(|number| region_of[*number as usize] == first) {
        return regions.get(first as usize).map(|name| (*name).to_owned());
    }
    let is_body = |group: &&Group| {
        group.triangles.len() + 2 * group.quads.len() == body.triangles.len()
            && triangles_of(mesh, group).eq(body.triangles.iter().copied())
    };
    mesh.groups.iter().find(is_body).map(|group| group.name.clone())
}

/// The triangles of a set, ascending: those of the mesh, then halves of quads.
fn triangles_of<'a>(mesh: &Mesh, group: &'a Group) -> impl Iterator<Item = u32> + 'a {
    let before = mesh.triangles.len() as u32;
    group.triangles.iter().copied().chain(group.quads.iter().flat_map(move |quad| [before + 2 * quad, before + 2 * quad + 1]))
}

/// Whether each triangle is in a set.
fn members(mesh: &Mesh, group: &Group) -> Vec<bool> {
    let mut out = vec![false; count(mesh)];
    job::looking(triangles_of(mesh, group)).for_each(|number| out[number as usize] = true);
    out
}

/// The sets that have triangles of a body, each triangle by itself: readers of the reference library know no ranges.
fn write_sets(content: &Content, body: &Body, members: &[Vec<bool>], archive: &mut dyn Write) -> io::Result<()> {
    let mut any = false;
    for (set, members) in content.sets.iter().zip(members) {
        let own = job::looking(&body.triangles).zip(0_u32..).filter(|(number, _)| members[**number as usize]);
        let here: Vec<u32> = own.map(|(_, index)| index).collect();
        if here.is_empty() {
            continue;
        }
        if !any {
            writeln!(archive, "<t:trianglesets>")?;
            any = true;
        }
        let name = escaped(&set.name);
        writeln!(archive, "<t:triangleset name=\"{name}\" identifier=\"{name}\">")?;
        write_records(archive, here.len(), |i, text| {
            text.extend_from_slice(b"<t:ref index=\"");
            push_count(text, u64::from(here[i]));
            text.extend_from_slice(b"\"/>\n");
        })?;
        writeln!(archive, "</t:triangleset>")?;
    }
    if any { writeln!(archive, "</t:trianglesets>") } else { Ok(()) }
}

fn vertex(place: [f64; 3], text: &mut Vec<u8>) {
    text.extend_from_slice(b"<vertex");
    for (key, x) in [&b" x=\""[..], b" y=\"", b" z=\""].into_iter().zip(place) {
        text.extend_from_slice(key);
        push_real(text, x);
        text.push(b'"');
    }
    text.extend_from_slice(b"/>\n");
}

fn triangle(corners: [u32; 3], material: Option<u32>, text: &mut Vec<u8>) {
    text.extend_from_slice(b"<triangle");
    for (key, n) in [&b" v1=\""[..], b" v2=\"", b" v3=\""].into_iter().zip(corners) {
        text.extend_from_slice(key);
        push_count(text, u64::from(n));
        text.push(b'"');
    }
    if let Some(material) = material {
        text.extend_from_slice(format!(" pid=\"{MATERIALS}\" p1=\"{material}\"").as_bytes());
    }
    text.extend_from_slice(b"/>\n");
}

/// A colour as `#RRGGBB`, from shares of one.
fn hex(color: [f64; 3]) -> String {
    let [red, green, blue] = color.map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8);
    format!("#{red:02X}{green:02X}{blue:02X}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_in_six_digits() {
        assert_eq!((hex([1.0, 0.5, 0.0]), hex(FACES)), ("#FF8000".to_owned(), "#B6CEE8".to_owned()));
    }
}
