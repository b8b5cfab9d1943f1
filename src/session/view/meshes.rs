//! Meshes as buffers: corner nodes and elements as they stand in decks, with faces and groups.

use std::ops::Range;

use serde_json::{Value, json};

use super::buffer::{Buffer, Role, Writer};
use crate::mesh::Mesh;

/// A mesh; `None` where it has no elements. Elements of groups are numbered as in decks, nodes from 0.
pub(super) fn buffer(mesh: &Mesh) -> Option<Buffer> {
    let corners = mesh.corner_count();
    if mesh.triangles.is_empty() && mesh.quads.is_empty() && mesh.lines.is_empty() || mesh.nodes.iter().any(|p| !p.is_finite()) {
        return None;
    }
    let mut writer = Writer::new(Role::Mesh);
    writer.positions(&mesh.nodes[..corners]);
    writer.corners("triangles", &mesh.triangles);
    writer.corners("quads", &mesh.quads);
    writer.corners("lines", &mesh.lines);
    if mesh.sizes.of.len() == corners {
        writer.places("decided", mesh.sizes.words.len(), mesh.sizes.of.iter().copied());
        writer.reals("asked", 1, mesh.sizes.lengths.iter().copied());
        writer.say("deciders", mesh.sizes.words.clone());
    }
    let mut of = vec![0_u32; mesh.triangles.len() + mesh.quads.len()];
    let (n, mut names) = (mesh.triangles.len() as u32, Vec::new());
    for range in &mesh.faces {
        let (triangles, quads) = (&range.triangles, shifted(&range.quads, n));
        if triangles.is_empty() && quads.is_empty() {
            continue;
        }
        for part in [triangles.clone(), quads] {
            of[part.start as usize..part.end as usize].fill(names.len() as u32);
        }
        names.push(range.name.clone());
    }
    writer.places("face", names.len(), of.into_iter());
    writer.say("faces", names.iter().map(|name| json!({"name": name, "area": null, "neighbours": []})).collect::<Vec<_>>());
    let first = mesh.lines.len() as u32 + 1;
    let group = |group: &crate::mesh::Group| {
        let elements = group.triangles.iter().copied().chain(group.quads.iter().map(|q| q + n)).map(|k| k + first);
        json!({"name": group.name, "elements": ranges(elements), "nodes": ranges(group.nodes.iter().copied())})
    };
    writer.say("groups", mesh.groups.iter().map(group).collect::<Vec<_>>());
    writer.say("first_element", first);
    Some(writer.finish())
}

fn shifted(range: &Range<u32>, by: u32) -> Range<u32> {
    range.start + by..range.end + by
}

/// Ascending numbers as stretches, the first and the last of each.
fn ranges(numbers: impl Iterator<Item = u32>) -> Value {
    let mut out: Vec<[u32; 2]> = Vec::new();
    for n in numbers {
        match out.last_mut() {
            Some(last) if last[1] + 1 == n => last[1] = n,
            _ => out.push([n, n]),
        }
    }
    json!(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_hold_each_number_once() {
        assert_eq!(ranges([0, 1, 2, 5, 7, 8].into_iter()), json!([[0, 2], [5, 5], [7, 8]]));
        assert_eq!(ranges(std::iter::empty()), json!([]));
    }
}
