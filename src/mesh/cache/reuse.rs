//! The cache of parts of meshes: divisions of segments, and faces with what was measured of them.
//!
//! Every part has a key of all that it follows from, by content: a cached part has the same bits as a computed one.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use crate::base::digest::{Digest, StableHash, StableHasher};
use crate::base::fault::Result;
use crate::base::work;
use crate::mesh::cache::cached_face::CachedFace;
use crate::mesh::data::face_geometry::{FaceNodes, Free};
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::divide::row_demand::RowDemand;
use crate::mesh::divide::verdict::Verdict;
use crate::mesh::mapped::diagonals::DiagonalRule;
use crate::mesh::mapped::grid::Grid;
use crate::mesh::mapped::trilateral::{Blocks, Lattice};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::recall::{RecallFace, RecallSteps};
use crate::mesh::verify::turned::Turned;
use crate::model::SurfaceId;

/// Number of runs that make meshes for which an unused part is kept.
const MAX_UNUSED_RUNS: u64 = 4;

/// Parts of one kind by their keys.
///
/// A cached part is charged the work that it took to compute: a mesh that exceeds its budget exceeds it whatever is cached.
#[derive(Debug)]
pub struct Store<T>(Mutex<BTreeMap<Digest, CachedPart<T>>>);

/// A part, the work that it took, and the run that used it last.
#[derive(Debug)]
struct CachedPart<T> {
    value: T,
    work: u64,
    run: u64,
}

impl<T> Default for Store<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T: Clone> Store<T> {
    fn find(&self, key: Digest, run: u64) -> Option<T> {
        let (value, work) = {
            let mut parts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let part = parts.get_mut(&key)?;
            part.run = run;
            (part.value.clone(), part.work)
        };
        work::spend(work);
        Some(value)
    }

    fn keep(&self, key: Digest, value: T, work: u64, run: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, CachedPart { value, work, run });
    }

    fn tidy(&self, run: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).retain(|_, part| part.run + MAX_UNUSED_RUNS > run);
    }
}

/// The inside of a face.
#[derive(Clone, Debug, Default)]
pub struct Inside {
    /// Points of its inner nodes.
    pub nodes: Vec<DVec3>,
    /// For each cell of a grid of triangles whether it has its other diagonal.
    pub diagonals: Vec<bool>,
}

/// Storage for large parts beyond a session, by their keys.
pub trait Shelf: std::fmt::Debug + Send + Sync {
    /// The stored bytes of a face.
    fn face(&self, key: Digest) -> Option<Vec<u8>>;
    /// Stores the bytes of a face.
    fn put_face(&self, key: Digest, bytes: &[u8]);
}

/// Parts of the last meshes.
#[derive(Debug, Default)]
pub struct Reuse {
    pub(crate) steps: Store<u32>,
    pub(crate) demands: Store<[RowDemand; 2]>,
    pub(crate) insides: Store<Arc<Inside>>,
    pub(crate) verdicts: Store<Verdict>,
    pub(crate) turned: Store<Option<Turned>>,
    free: Store<Arc<CachedFace>>,
    chords: Store<f64>,
    shelf: Option<Arc<dyn Shelf>>,
    run: u64,
    worked: AtomicBool,
    faces: AtomicUsize,
}

impl Reuse {
    /// Adds a shelf for large parts.
    pub fn beside(&mut self, shelf: Option<Arc<dyn Shelf>>) {
        self.shelf = shelf;
    }

    /// The chord error of a face, cached or measured now.
    pub fn chord(&self, key: Digest, measure: impl FnOnce() -> f64) -> f64 {
        self.chords.find(key, self.run).unwrap_or_else(|| {
            let measured = measure();
            self.chords.keep(key, measured, 0, self.run);
            measured
        })
    }

    /// Ends a run; after one that made meshes, parts that were unused for some runs are removed.
    pub fn end_run(&mut self) {
        let Self { steps, demands, insides, verdicts, turned, free, chords, shelf: _, run, worked, faces: _ } = self;
        if !std::mem::take(worked.get_mut()) {
            return;
        }
        *run += 1;
        steps.tidy(*run);
        demands.tidy(*run);
        insides.tidy(*run);
        verdicts.tidy(*run);
        turned.tidy(*run);
        free.tidy(*run);
        chords.tidy(*run);
    }

    /// Number of faces whose inside came from the cache so far.
    pub fn faces(&self) -> usize {
        self.faces.load(Ordering::Relaxed)
    }
}

/// The cache during the making of one mesh, with the digests of its surfaces.
#[derive(Clone, Copy, Debug)]
pub struct CacheView<'a> {
    /// Parts made before, and the place for new ones.
    pub reuse: &'a Reuse,
    /// Digests of the surfaces of the plan.
    pub surfaces: &'a BTreeMap<SurfaceId, Digest>,
}

impl CacheView<'_> {
    /// Begins the key of something on a surface.
    pub fn on(&self, what: &str, surface: SurfaceId) -> StableHasher {
        StableHasher::new(what).with(&self.surfaces.get(&surface))
    }

    /// The cached inside of a face.
    pub fn inside(&self, key: Digest) -> Option<Arc<Inside>> {
        let found = self.inside_again(key)?;
        self.reuse.faces.fetch_add(1, Ordering::Relaxed);
        self.reuse.worked.store(true, Ordering::Relaxed);
        Some(found)
    }

    /// The same for a face that was counted before within the mesh.
    pub fn inside_again(&self, key: Digest) -> Option<Arc<Inside>> {
        self.reuse.insides.find(key, self.reuse.run)
    }

    /// Caches the inside of a face, which took so much work.
    pub fn keep_inside(&self, key: Digest, inside: Inside, work: u64) {
        self.reuse.worked.store(true, Ordering::Relaxed);
        self.reuse.insides.keep(key, Arc::new(inside), work, self.reuse.run);
    }

    /// The cached inside of a free face.
    pub fn free(&self, key: Digest) -> Option<Arc<CachedFace>> {
        let Reuse { free, shelf, run, .. } = self.reuse;
        let found = free.find(key, *run).or_else(|| {
            let cached = Arc::new(CachedFace::read(&shelf.as_ref()?.face(key)?)?);
            // A free face was computed within a budget of its own.
            free.keep(key, cached.clone(), 0, *run);
            Some(cached)
        })?;
        self.reuse.faces.fetch_add(1, Ordering::Relaxed);
        self.reuse.worked.store(true, Ordering::Relaxed);
        Some(found)
    }

    /// Caches the inside of a free face.
    pub fn keep_free(&self, key: Digest, face: CachedFace) {
        self.reuse.worked.store(true, Ordering::Relaxed);
        if let Some(shelf) = self.reuse.shelf.as_ref().filter(|_| face.is_large()) {
            shelf.put_face(key, &face.bytes());
        }
        self.reuse.free.keep(key, Arc::new(face), 0, self.reuse.run);
    }

    /// The key of a face: its surface, where its nodes lie, and the points of its border. `border` are the points of all
    /// nodes on borders.
    pub fn face(&self, face_mesh: &FaceMesh, border: &[DVec3], rule: DiagonalRule) -> Digest {
        let mut to = self.on("face", face_mesh.surface);
        face_mesh.geometry.nodes.hash_places(&mut to);
        (face_mesh.elements, (rule.even, rule.limited)).hash_into(&mut to);
        let mut points = |ids: &[u32]| ids.iter().for_each(|id| border.get(*id as usize).hash_into(&mut to));
        match &face_mesh.geometry.nodes {
            FaceNodes::Grid(_, frame) => frame.sides.iter().for_each(|side| points(side)),
            FaceNodes::Lattice(_, frame) => frame.sides.iter().for_each(|side| points(side)),
            FaceNodes::Blocks(_, places) => points(&places[face_mesh.inner as usize..]),
            FaceNodes::Free(_, places) => points(places),
        }
        if let FaceNodes::Grid(_, frame) = &face_mesh.geometry.nodes {
            frame.poles.hash_into(&mut to);
        }
        to.finish()
    }
}

crate::content!(Grid { u, v, sides, straight });
crate::content!(Lattice { sides });
crate::content!(Free { uv, border, triangles, quads });
crate::content!(Blocks { uv, inner, quads, sides });
crate::content!(Limits { chord, angle, near });
crate::content!(RowDemand { size, least, length, bend });

impl FaceNodes {
    /// Hashes where the nodes lie, whatever their ids.
    pub fn hash_places(&self, to: &mut StableHasher) {
        match self {
            Self::Grid(grid, _) => (0u8, grid).hash_into(to),
            Self::Lattice(lattice, _) => (1u8, lattice).hash_into(to),
            Self::Blocks(blocks, _) => (2u8, blocks).hash_into(to),
            Self::Free(free, _) => (3u8, free).hash_into(to),
        }
    }
}

/// The cached steps under the key, or the computed ones; failures are not cached.
pub fn cached_if_valid(
    cache: Option<&CacheView>,
    key: impl FnOnce(&CacheView) -> Digest,
    make: impl FnOnce() -> Result<u32>,
) -> Result<u32> {
    let Some(cache) = cache else { return make() };
    let (key, run) = (work::uncharged(|| key(cache)), cache.reuse.run);
    if let Some(found) = cache.reuse.steps.find(key, run) {
        return Ok(found);
    }
    let (made, work) = work::measured(make);
    let steps = made?;
    cache.reuse.steps.keep(key, steps, work, run);
    Ok(steps)
}

/// The lookup of steps of segments in the cache, where there is one.
pub fn recall_steps<'a>(cache: Option<&'a CacheView<'a>>) -> Box<RecallSteps<'a>> {
    Box::new(move |key, make| cached_if_valid(cache, |_| key(), make))
}

/// A cache with the keys of the faces of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct KeyedFaces<'a> {
    /// The cache.
    pub cache: &'a CacheView<'a>,
    /// Keys by the faces of the layout.
    pub keys: &'a [Digest],
}

/// The lookup of results of faces under their keys, where there is a cache; `what` begins the key.
pub fn recall_face<'a, T: Clone + Send + 'a>(
    keyed: Option<KeyedFaces<'a>>,
    what: &'static str,
    store: impl Fn(&Reuse) -> &Store<T> + Copy + Sync + 'a,
) -> Box<RecallFace<'a, T>> {
    Box::new(move |k, hash, make| {
        let key = |_: &CacheView| {
            let mut to = StableHasher::new(what).with(&keyed.map(|keyed| keyed.keys[k]));
            hash(&mut to);
            to.finish()
        };
        recalled(keyed.map(|keyed| keyed.cache), store, key, make)
    })
}

/// The cached value under the key, or the computed one; without a cache no key is computed.
pub fn recalled<T: Clone>(
    cache: Option<&CacheView>,
    store: impl Fn(&Reuse) -> &Store<T>,
    key: impl FnOnce(&CacheView) -> Digest,
    make: impl FnOnce() -> T,
) -> T {
    let Some(cache) = cache else { return make() };
    let (key, run) = (work::uncharged(|| key(cache)), cache.reuse.run);
    if let Some(found) = store(cache.reuse).find(key, run) {
        return found;
    }
    let (value, work) = work::measured(make);
    store(cache.reuse).keep(key, value.clone(), work, run);
    value
}
