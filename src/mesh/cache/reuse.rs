//! Parts of meshes that were made before: divisions of segments, and faces with what was measured of them.
//!
//! Every part has a key of all that it is made from, by content, so that one that is taken over is bit by bit the one
//! that would be made.

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
use crate::mesh::mapped::grid::Grid;
use crate::mesh::mapped::trilateral::{Blocks, Lattice};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::recall::{RecallFace, RecallSteps};
use crate::mesh::verify::turned::Turned;
use crate::model::SurfaceId;

/// Runs that make meshes for which a part is kept that none of them used.
const RUNS: u64 = 4;

/// Parts of one kind by their keys.
///
/// What is taken over is charged the work that it took to make: a mesh that is refused for its work is refused whatever was made before.
#[derive(Debug)]
pub struct Store<T>(Mutex<BTreeMap<Digest, Part<T>>>);

/// A part, the work that it took, and the run that used it last.
#[derive(Debug)]
struct Part<T> {
    made: T,
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
        let (made, work) = {
            let mut parts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let part = parts.get_mut(&key)?;
            part.run = run;
            (part.made.clone(), part.work)
        };
        work::spend(work);
        Some(made)
    }

    fn keep(&self, key: Digest, (made, work): (T, u64), run: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Part { made, work, run });
    }

    fn tidy(&self, run: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).retain(|_, part| part.run + RUNS > run);
    }
}

/// The inside of a face.
#[derive(Clone, Debug, Default)]
pub struct Inside {
    /// Points of its inner nodes.
    pub nodes: Vec<DVec3>,
    /// For each cell of a grid of triangles whether its other diagonal was taken.
    pub diagonals: Vec<bool>,
}

/// Where large parts are kept longer than a session, by their keys.
pub trait Shelf: std::fmt::Debug + Send + Sync {
    /// The bytes of a face, as they were put.
    fn face(&self, key: Digest) -> Option<Vec<u8>>;
    /// Keeps the bytes of a face.
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
    /// Looks for large parts on a shelf as well, and leaves them there.
    pub fn beside(&mut self, shelf: Option<Arc<dyn Shelf>>) {
        self.shelf = shelf;
    }

    /// The chord error of a face as it was measured before, or as it is now.
    pub fn chord(&self, key: Digest, measure: impl FnOnce() -> f64) -> f64 {
        self.chords.find(key, self.run).unwrap_or_else(|| {
            let measured = measure();
            self.chords.keep(key, (measured, 0), self.run);
            measured
        })
    }

    /// Ends a run; when it made meshes, what was not used for long is forgotten.
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

    /// Faces whose inside was taken over so far.
    pub fn faces(&self) -> usize {
        self.faces.load(Ordering::Relaxed)
    }
}

/// What is known while a mesh is made: parts of others, and the digests of the surfaces.
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

    /// The inside of a face, when it was made before.
    pub fn inside(&self, key: Digest) -> Option<Arc<Inside>> {
        let found = self.inside_again(key)?;
        self.reuse.faces.fetch_add(1, Ordering::Relaxed);
        self.reuse.worked.store(true, Ordering::Relaxed);
        Some(found)
    }

    /// The same within one mesh, which does not count.
    pub fn inside_again(&self, key: Digest) -> Option<Arc<Inside>> {
        self.reuse.insides.find(key, self.reuse.run)
    }

    /// Keeps the inside of a face, which took so much work.
    pub fn keep_inside(&self, key: Digest, (inside, work): (Inside, u64)) {
        self.reuse.worked.store(true, Ordering::Relaxed);
        self.reuse.insides.keep(key, (Arc::new(inside), work), self.reuse.run);
    }

    /// The inside of a free face, when it was made before.
    pub fn free(&self, key: Digest) -> Option<Arc<CachedFace>> {
        let Reuse { free, shelf, run, .. } = self.reuse;
        let found = free.find(key, *run).or_else(|| {
            let taken = Arc::new(CachedFace::read(&shelf.as_ref()?.face(key)?)?);
            // A free face has its own budget, within which it was made.
            free.keep(key, (taken.clone(), 0), *run);
            Some(taken)
        })?;
        self.reuse.faces.fetch_add(1, Ordering::Relaxed);
        self.reuse.worked.store(true, Ordering::Relaxed);
        Some(found)
    }

    /// Keeps the inside of a free face.
    pub fn keep_free(&self, key: Digest, taken: CachedFace) {
        self.reuse.worked.store(true, Ordering::Relaxed);
        if let Some(shelf) = self.reuse.shelf.as_ref().filter(|_| taken.is_large()) {
            shelf.put_face(key, &taken.bytes());
        }
        self.reuse.free.keep(key, (Arc::new(taken), 0), self.reuse.run);
    }

    /// The key of a face: its surface, where its nodes lie, and the points of its border. `border` are the points of all
    /// nodes on borders.
    pub fn face(&self, ready: &FaceMesh, border: &[DVec3], even: f64) -> Digest {
        let mut to = self.on("face", ready.surface);
        ready.geometry.nodes.hash_places(&mut to);
        (ready.elements, even).hash_into(&mut to);
        let mut points = |ids: &[u32]| ids.iter().for_each(|id| border.get(*id as usize).hash_into(&mut to));
        match &ready.geometry.nodes {
            FaceNodes::Grid(_, frame) => frame.sides.iter().for_each(|side| points(side)),
            FaceNodes::Lattice(_, frame) => frame.sides.iter().for_each(|side| points(side)),
            FaceNodes::Blocks(_, places) => points(&places[ready.inner as usize..]),
            FaceNodes::Free(_, places) => points(places),
        }
        if let FaceNodes::Grid(_, frame) = &ready.geometry.nodes {
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

/// The steps found before under the key, or what `make` finds; failures are not kept.
pub fn cached_if_valid(
    known: Option<&CacheView>,
    key: impl FnOnce(&CacheView) -> Digest,
    make: impl FnOnce() -> Result<u32>,
) -> Result<u32> {
    let Some(known) = known else { return make() };
    let (key, run) = (work::uncharged(|| key(known)), known.reuse.run);
    if let Some(found) = known.reuse.steps.find(key, run) {
        return Ok(found);
    }
    let (made, work) = work::measured(make);
    let made = made?;
    known.reuse.steps.keep(key, (made, work), run);
    Ok(made)
}

/// Takes over steps of segments, where something is known.
pub fn recall_steps<'a>(known: Option<&'a CacheView<'a>>) -> Box<RecallSteps<'a>> {
    Box::new(move |key, make| cached_if_valid(known, |_| key(), make))
}

/// Takes over what was found of faces under their keys, where something is known; `what` begins the key.
pub fn recall_face<'a, T: Clone + Send + 'a>(
    keyed: Option<(&'a CacheView<'a>, &'a [Digest])>,
    what: &'static str,
    store: impl Fn(&Reuse) -> &Store<T> + Copy + Sync + 'a,
) -> Box<RecallFace<'a, T>> {
    Box::new(move |k, hash, make| {
        let key = |_: &CacheView| {
            let mut to = StableHasher::new(what).with(&keyed.map(|keyed| keyed.1[k]));
            hash(&mut to);
            to.finish()
        };
        recalled(keyed.map(|keyed| keyed.0), store, key, make)
    })
}

/// What was found before under the key, or what `make` gives; without anything known no key is made.
pub fn recalled<T: Clone>(
    known: Option<&CacheView>,
    store: impl Fn(&Reuse) -> &Store<T>,
    key: impl FnOnce(&CacheView) -> Digest,
    make: impl FnOnce() -> T,
) -> T {
    let Some(known) = known else { return make() };
    let (key, run) = (work::uncharged(|| key(known)), known.reuse.run);
    if let Some(found) = store(known.reuse).find(key, run) {
        return found;
    }
    let (made, work) = work::measured(make);
    store(known.reuse).keep(key, (made.clone(), work), run);
    made
}
