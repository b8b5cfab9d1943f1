//! Meshes as bytes and back. What comes back is either a sound mesh or nothing.

use crate::base::bytes::{Bytes, Plain, Put};
use crate::mesh::border::touch::{Kind, Touch};
use crate::mesh::data::face_geometry::{FaceGeometries, FaceGeometry, FaceNodes, Free};
use crate::mesh::data::mesh::{FaceRange, Group, Mesh};
use crate::mesh::data::node_sizes::NodeSizes;
use crate::mesh::mapped::grid::{self, Grid};
use crate::mesh::mapped::trilateral::{Blocks, Lattice, LatticeIds};
use crate::mesh::report::built::Built;
use crate::mesh::report::explain::Explanation;
use crate::mesh::request::fault::Cure;
use crate::mesh::size::remark::Remark;
use crate::surface::Surface;

crate::plain!(FaceRange { name, triangles, quads, lines });
crate::plain!(Group { name, nodes, lines, triangles, quads });
crate::plain!(Grid { u, v, sides, straight });
crate::plain!(Lattice { sides });
crate::plain!(Free { uv, border, triangles, quads });
crate::plain!(Blocks { uv, inner, quads, sides });
crate::plain!(grid::GridIds { sides, poles, first });
crate::plain!(LatticeIds { sides, first });

/// A geometry with its surface as a number in a list.
#[derive(Debug)]
struct PlacedFace {
    surface: u32,
    nodes: FaceNodes,
    flipped: bool,
}

crate::plain!(PlacedFace { surface, nodes, flipped });

impl Put for FaceNodes {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Self::Grid(grid, ids) => (0u8, (grid, ids)).put(to),
            Self::Lattice(lattice, ids) => (1u8, (lattice, ids)).put(to),
            Self::Blocks(blocks, ids) => (2u8, (blocks, ids)).put(to),
            Self::Free(free, ids) => (3u8, (free, ids)).put(to),
        }
    }
}

impl Plain for FaceNodes {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(match u8::take(from)? {
            0 => Self::Grid(Plain::take(from)?, Plain::take(from)?),
            1 => Self::Lattice(Plain::take(from)?, Plain::take(from)?),
            2 => Self::Blocks(Plain::take(from)?, Plain::take(from)?),
            3 => Self::Free(Plain::take(from)?, Plain::take(from)?),
            _ => return None,
        })
    }
}

impl Put for Cure {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Self::Auto => 0u8.put(to),
            Self::Rows => 1u8.put(to),
            Self::Size(size) => (2u8, size).put(to),
            Self::Method => 3u8.put(to),
            Self::Near => 4u8.put(to),
        }
    }
}

impl Plain for Cure {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(match u8::take(from)? {
            0 => Self::Auto,
            1 => Self::Rows,
            2 => Self::Size(Plain::take(from)?),
            3 => Self::Method,
            4 => Self::Near,
            _ => return None,
        })
    }
}

impl Put for Remark {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Self::Unused { rule, why } => (0u8, (rule, why)).put(to),
            Self::Overridden { key, earlier, later } => (1u8, (key, (earlier, later))).put(to),
            Self::Touch(Touch { kind, surfaces, names, length, at }) => (2u8, (kind.word(), (*surfaces, (names, (*length, *at))))).put(to),
            Self::Lost(lost) => (4u8, lost).put(to),
            Self::Loose(loose) => (5u8, loose).put(to),
            Self::Sharp { angle, at, surface, faces, cure } => (3u8, ((angle, at), (surface, (faces, cure)))).put(to),
        }
    }
}

impl Plain for Remark {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(match u8::take(from)? {
            0 => Self::Unused { rule: Plain::take(from)?, why: Plain::take(from)? },
            1 => Self::Overridden { key: Plain::take(from)?, earlier: Plain::take(from)?, later: Plain::take(from)? },
            2 => {
                let (kind, (surfaces, (names, (length, at)))) = Plain::take(from)?;
                Self::Touch(Touch { kind: Kind::of_word(kind)?, surfaces, names, length, at })
            }
            3 => Self::Sharp {
                angle: Plain::take(from)?,
                at: Plain::take(from)?,
                surface: Plain::take(from)?,
                faces: Plain::take(from)?,
                cure: Plain::take(from)?,
            },
            4 => Self::Lost(Plain::take(from)?),
            5 => Self::Loose(Plain::take(from)?),
            _ => return None,
        })
    }
}

/// A made mesh as bytes. Its geometries lie on `surfaces`, which [`read`] is given again; `None` when one lies on another.
///
/// Of the explanation the lines are kept.
pub fn write(built: &Built, surfaces: &[&Surface]) -> Option<Vec<u8>> {
    let mut to = Vec::new();
    let Built { mesh, explanation, remarks } = built;
    let Mesh {
        name,
        order,
        nodes,
        points,
        lines,
        triangles,
        quads,
        line_mids,
        triangle_mids,
        quad_mids,
        faces,
        groups,
        geometries,
        border_error,
        sizes,
    } = mesh;
    (name, (order, border_error)).put(&mut to);
    (&sizes.words, (&sizes.of, &sizes.lengths)).put(&mut to);
    (nodes, points).put(&mut to);
    (lines, (triangles, quads)).put(&mut to);
    (line_mids, (triangle_mids, quad_mids)).put(&mut to);
    (faces, groups).put(&mut to);
    (&explanation.lines, remarks).put(&mut to);
    geometries.0.len().put(&mut to);
    for geometry in &geometries.0 {
        let surface = surfaces.iter().position(|s| s.is(&geometry.surface))? as u32;
        let FaceGeometry { surface: _, nodes, flipped, quality: _ } = geometry;
        (surface, (nodes, flipped)).put(&mut to);
    }
    Some(to)
}

/// The mesh that [`write()`] made of these surfaces; `None` when the bytes are something else.
pub fn read(bytes: &[u8], surfaces: &[&Surface]) -> Option<Built> {
    type Parts = (Vec<[u32; 2]>, (Vec<[u32; 3]>, Vec<[u32; 4]>));
    type Mids = (Vec<u32>, (Vec<[u32; 3]>, Vec<[u32; 4]>));
    let mut from = Bytes(bytes);
    let (name, (order, border_error)) = Plain::take(&mut from)?;
    let (words, (of, lengths)) = Plain::take(&mut from)?;
    let (nodes, points) = Plain::take(&mut from)?;
    let (lines, (triangles, quads)): Parts = Plain::take(&mut from)?;
    let (line_mids, (triangle_mids, quad_mids)): Mids = Plain::take(&mut from)?;
    let (faces, groups) = Plain::take(&mut from)?;
    let (explained, remarks) = Plain::take(&mut from)?;
    let placed: Vec<PlacedFace> = Plain::take(&mut from)?;
    let geometries = placed.into_iter().map(|PlacedFace { surface, nodes, flipped }| {
        Some(FaceGeometry { surface: (*surfaces.get(surface as usize)?).clone(), nodes, flipped, quality: None })
    });
    let geometries = FaceGeometries(geometries.collect::<Option<_>>()?);
    let mesh = Mesh {
        name,
        order,
        nodes,
        points,
        lines,
        triangles,
        quads,
        line_mids,
        triangle_mids,
        quad_mids,
        faces,
        groups,
        geometries,
        border_error,
        sizes: NodeSizes { words, of, lengths },
    };
    let sound = from.is_empty() && is_sound(&mesh);
    sound.then(|| Built { mesh, explanation: Explanation { lines: explained, ..Explanation::default() }, remarks })
}

/// Every number of a node or an element names one that is there, and geometries are as large as their faces.
fn is_sound(mesh: &Mesh) -> bool {
    let nodes = mesh.nodes.len() as u32;
    let node = |n: &u32| *n < nodes;
    let (l, t, q) = (mesh.lines.len() as u32, mesh.triangles.len() as u32, mesh.quads.len() as u32);
    let inside = |r: &std::ops::Range<u32>, n: u32| r.start <= r.end && r.end <= n;
    let mids = |mids: usize, elements: usize| mids == 0 || mids == elements;
    let below = |ids: &[u32], n: u32| ids.iter().all(|id| *id < n);
    (1..=2).contains(&mesh.order)
        && mesh.sizes.is_sound(mesh.corner_count())
        && [&mesh.points, &mesh.line_mids].into_iter().flatten().all(node)
        && mesh.lines.iter().flatten().all(node)
        && [&mesh.triangles, &mesh.triangle_mids].into_iter().flatten().flatten().all(node)
        && [&mesh.quads, &mesh.quad_mids].into_iter().flatten().flatten().all(node)
        && mids(mesh.line_mids.len(), mesh.lines.len())
        && mids(mesh.triangle_mids.len(), mesh.triangles.len())
        && mids(mesh.quad_mids.len(), mesh.quads.len())
        && mesh.faces.iter().all(|f| inside(&f.triangles, t) && inside(&f.quads, q) && inside(&f.lines, l))
        && mesh.groups.iter().all(|g| below(&g.nodes, nodes) && below(&g.lines, l) && below(&g.triangles, t) && below(&g.quads, q))
        && mesh.geometries.0.iter().all(|geometry| fits(geometry, nodes))
}

fn fits(geometry: &FaceGeometry, nodes: u32) -> bool {
    let node = |ids: &[u32]| ids.iter().all(|n| *n < nodes);
    let last = |first: u32, inner: u64| u64::from(first) + inner <= u64::from(nodes);
    match &geometry.nodes {
        FaceNodes::Grid(grid, frame) => {
            let same =
                (0..4).all(|k| frame.sides[k].len() == grid.sides[k].len() && frame.sides[k].len() == frame.sides[(k + 2) % 4].len());
            same && frame.sides.iter().all(|side| side.len() > 1 && node(side)) && last(frame.first, frame.inner())
        }
        FaceNodes::Lattice(lattice, frame) => {
            let n = frame.sides[0].len();
            let same = (0..3).all(|k| frame.sides[k].len() == n && lattice.sides[k].len() == n);
            let inner = || LatticeIds::inner(n - 1).count() as u64;
            same && n > 1 && frame.sides.iter().all(|side| node(side)) && last(frame.first, inner())
        }
        FaceNodes::Blocks(blocks, places) => {
            let own = |ids: &[u32]| ids.iter().all(|n| (*n as usize) < blocks.uv.len());
            places.len() == blocks.uv.len()
                && node(places)
                && blocks.inner <= places.len()
                && blocks.quads.iter().all(|quad| own(quad))
                && blocks.sides.iter().all(|side| own(side))
        }
        FaceNodes::Free(free, places) => {
            places.len() == free.uv.len()
                && node(places)
                && free.border <= places.len()
                && free.triangles.iter().flatten().chain(free.quads.iter().flatten()).all(|n| (*n as usize) < free.uv.len())
        }
    }
}
