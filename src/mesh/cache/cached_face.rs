//! Free faces taken over from earlier runs: what is made inside a border, under a key of all that it follows from.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::bytes::{self, Bytes, Plain, Put};
use crate::base::digest::{Digest, StableHash, StableHasher};
use crate::mesh::border::layout::Face;
use crate::mesh::cache::reuse::CacheView;
use crate::mesh::chart::face_border::FaceBorder;
use crate::mesh::chart::face_input::FaceInput;
use crate::mesh::chart::outline::Outline;
use crate::mesh::data::face_geometry::Free;
use crate::mesh::data::face_mesh::FreeInside;
use crate::mesh::request::decider::{Decider, Tally, Why};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::sources::{Body, Source, Sources};

/// What is inside a border.
#[derive(Clone, Debug, PartialEq)]
pub struct CachedFace {
    free: Free,
    points: Vec<DVec3>,
    deciders: Vec<Decider>,
    tally: Option<Tally>,
}

crate::plain!(CachedFace { free, points, deciders, tally });
crate::plain!(Decider { why, nodes, at });
crate::plain!(Tally { whole, crossed, corners, agree });
crate::content!(Source { body, radius, size, steep, tag });

impl StableHash for Body {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Point(p) => (0u8, p).hash_into(to),
            Self::Segment(a, b) => (1u8, a, b).hash_into(to),
            Self::Box(Box3 { min, max }) => (2u8, min, max).hash_into(to),
        }
    }
}

impl Put for Why {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Self::Size => (0u8, 0usize).put(to),
            Self::Refined(clause) => (1u8, *clause).put(to),
            Self::Bends => (2u8, 0usize).put(to),
            Self::Border => (3u8, 0usize).put(to),
            Self::Gap => (4u8, 0usize).put(to),
            Self::Floor => (5u8, 0usize).put(to),
        }
    }
}

impl Plain for Why {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        Some(match Plain::take(from)? {
            (0u8, 0usize) => Self::Size,
            (1, clause) => Self::Refined(clause),
            (2, 0) => Self::Bends,
            (3, 0) => Self::Border,
            (4, 0) => Self::Gap,
            (5, 0) => Self::Floor,
            _ => return None,
        })
    }
}

/// Everything that the inside of a face follows from, by content: `odd` are the border nodes that cells of quads leave out,
/// `rules` what of `near` and `in` reaches it.
pub(crate) fn key(
    known: &CacheView,
    made: &FaceInput,
    face: &Face,
    (border, outline): (&FaceBorder, &Outline),
    (odd, rules): (&[u32], &Sources),
) -> Digest {
    let plan = made.input.plan;
    let mut to = known.on("free face", face.surface).text(env!("CARGO_PKG_VERSION")).number(u64::from(crate::mesh::request::VERSION));
    made.input.tolerance.hash_into(&mut to);
    (face.elements, face.method, face.size.0).hash_into(&mut to);
    (Limits::of(made.input), plan.settings.smooth.map(|n| n.0), (plan.slope(), plan.most_elements)).hash_into(&mut to);
    (made.wanted.floor, made.wanted.written).hash_into(&mut to);
    (rules.items(), rules.slope()).hash_into(&mut to);
    // Numbers of nodes depend on the whole mesh: here by first appearance.
    let mut order: Vec<(u32, usize)> = border.ids.iter().copied().zip(0..).collect();
    order.sort_unstable();
    order.dedup_by_key(|n| n.0);
    let first = |id: &u32| order.get(order.partition_point(|n| n.0 < *id)).map(|n| n.1);
    border.ids.iter().map(first).collect::<Vec<_>>().hash_into(&mut to);
    border.ids.iter().map(|id| odd.binary_search(id).is_ok()).collect::<Vec<_>>().hash_into(&mut to);
    (&border.uv, &outline.p, (&border.edges, &border.lines)).hash_into(&mut to);
    to.finish()
}

/// Places and elements, points of inner nodes, what decided the sizes, and the cells.
type Parts = (Free, Vec<DVec3>, Vec<Decider>, Option<Tally>);

impl CachedFace {
    /// Of a face that was made.
    pub fn of(free: &Free, inside: &FreeInside) -> Self {
        Self { free: free.clone(), points: inside.points.clone(), deciders: inside.deciders.clone(), tally: inside.tally }
    }

    /// Its parts for a border of so many nodes; `None` where it is of another one.
    pub fn parts(&self, border: usize) -> Option<Parts> {
        (self.free.border == border).then(|| (self.free.clone(), self.points.clone(), self.deciders.clone(), self.tally))
    }

    /// As bytes.
    pub fn bytes(&self) -> Vec<u8> {
        bytes::bytes_of(self)
    }

    /// From bytes; `None` where they are something else.
    pub fn read(from: &[u8]) -> Option<Self> {
        let taken: Self = bytes::read(from)?;
        let nodes = taken.free.uv.len();
        let known = |n: &u32| (*n as usize) < nodes;
        let sound = taken.free.border + taken.points.len() == nodes
            && taken.free.triangles.iter().flatten().all(known)
            && taken.free.quads.iter().flatten().all(known);
        sound.then_some(taken)
    }

    /// Whether it is worth a file.
    pub fn is_large(&self) -> bool {
        self.free.triangles.len() + self.free.quads.len() >= LARGE
    }
}

/// Elements from which on a face is kept on disk by itself; less is made as fast as it is read.
const LARGE: usize = 2_000;
