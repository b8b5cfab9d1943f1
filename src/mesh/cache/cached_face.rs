//! Cached free faces: the mesh inside a border, under a key of all that it follows from.

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
use crate::mesh::data::face_mesh::{FreeInside, SlidNode};
use crate::mesh::request::decider::{Decided, Decider, Tally, Why};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::sources::{Body, Source, Sources};
use crate::mesh::tri::sliding_border::SlidingBorder;

/// The mesh inside a border.
#[derive(Clone, Debug, PartialEq)]
pub struct CachedFace {
    free: Free,
    points: Vec<DVec3>,
    decided: Decided,
    tally: Option<Tally>,
    slid: Vec<SlidNode>,
}

crate::plain!(CachedFace { free, points, decided, tally, slid });
crate::plain!(Decided { deciders, of, lengths });
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

/// All that the inside of a free face follows from.
pub(crate) struct FaceKey<'a> {
    pub(crate) face_input: &'a FaceInput<'a>,
    pub(crate) face: &'a Face,
    pub(crate) border: &'a FaceBorder,
    pub(crate) outline: &'a Outline,
    /// Border nodes that cells of quads leave out.
    pub(crate) odd: &'a [u32],
    /// The sources of `near` and `in` that reach the face.
    pub(crate) rules: &'a Sources,
    /// Border nodes that may slide.
    pub(crate) sliding: Option<&'a SlidingBorder<'a>>,
}

impl FaceKey<'_> {
    /// Its digest, by content.
    pub(crate) fn digest(&self, cache: &CacheView) -> Digest {
        let Self { face_input, face, border, outline, odd, rules, sliding } = self;
        let plan = face_input.input.plan;
        let mut to = cache.on("free face", face.surface).text(env!("CARGO_PKG_VERSION")).number(u64::from(crate::mesh::request::VERSION));
        face_input.input.tolerance.hash_into(&mut to);
        (face.elements, face.method, face.size.0).hash_into(&mut to);
        ((Limits::of(face_input.input), plan.settings.regular()), plan.settings.smooth.map(|n| n.0), (plan.slope(), plan.most_elements))
            .hash_into(&mut to);
        (face_input.wanted.floor, face_input.wanted.written).hash_into(&mut to);
        (rules.items(), rules.slope()).hash_into(&mut to);
        // Numbers of nodes depend on the whole mesh: here by first appearance.
        let mut order: Vec<(u32, usize)> = border.ids.iter().copied().zip(0..).collect();
        order.sort_unstable();
        order.dedup_by_key(|n| n.0);
        let first = |id: &u32| order.get(order.partition_point(|n| n.0 < *id)).map(|n| n.1);
        border.ids.iter().map(first).collect::<Vec<_>>().hash_into(&mut to);
        border.ids.iter().map(|id| odd.binary_search(id).is_ok()).collect::<Vec<_>>().hash_into(&mut to);
        (&border.uv, &outline.p, (&border.edges, &border.lines)).hash_into(&mut to);
        if let Some(sliding) = sliding {
            sliding.hash_into(&mut to);
        }
        to.finish()
    }
}

impl CachedFace {
    /// Of a computed face.
    pub fn of(free: &Free, inside: &FreeInside) -> Self {
        debug_assert!(
            inside.decided.is_sound(inside.points.len()),
            "{} deciders of {} nodes",
            inside.decided.of.len(),
            inside.points.len()
        );
        Self {
            free: free.clone(),
            points: inside.points.clone(),
            decided: inside.decided.clone(),
            tally: inside.tally,
            slid: inside.slid.clone(),
        }
    }

    /// Its places and elements and its inside, for a border with these edges; `None` where it is of a border with another number of nodes.
    pub fn parts(&self, border: usize, loops: &[[u32; 2]]) -> Option<(Free, FreeInside)> {
        let inside = || FreeInside {
            points: self.points.clone(),
            loops: loops.to_vec(),
            decided: self.decided.clone(),
            tally: self.tally,
            slid: self.slid.clone(),
        };
        (self.free.border == border).then(|| (self.free.clone(), inside()))
    }

    /// As bytes.
    pub fn bytes(&self) -> Vec<u8> {
        bytes::bytes_of(self)
    }

    /// From bytes; `None` where they are something else.
    pub fn read(from: &[u8]) -> Option<Self> {
        let face: Self = bytes::read(from)?;
        let nodes = face.free.uv.len();
        let known = |n: &u32| (*n as usize) < nodes;
        let sound = face.free.border + face.points.len() == nodes
            && face.free.triangles.iter().flatten().all(known)
            && face.free.quads.iter().flatten().all(known)
            && face.slid.iter().all(|slid| (slid.node as usize) < face.free.border && slid.fraction > 0.0 && slid.fraction < 1.0)
            && face.decided.is_sound(face.points.len());
        sound.then_some(face)
    }

    /// Whether it is stored on disk by itself.
    pub fn is_large(&self) -> bool {
        self.free.triangles.len() + self.free.quads.len() >= MIN_STORED_ELEMENTS
    }
}

/// Least number of elements of a face that is stored on disk by itself: smaller ones are computed as fast as they are read.
const MIN_STORED_ELEMENTS: usize = 2_000;
