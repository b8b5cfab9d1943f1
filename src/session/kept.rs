//! What a session keeps from one run to the next beside values: the stages over everything declared, and what was
//! measured of their results.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use glam::DVec3;

use super::cache::Cache;
use super::report::MeshRow;
use crate::base::bytes;
use crate::base::digest::{Digest, StableHasher};
use crate::base::fault::Fault;
use crate::base::tolerance::Tolerance;
use crate::lang::eval::memory::Memory;
use crate::lang::values::value::ModuleId;
use crate::mesh::cache::record;
use crate::mesh::cache::reuse::Reuse;
use crate::mesh::size::remark::Remark;
use crate::mesh::{Built, Mesh};
use crate::model::Model;
use crate::model::topology::Named;
use crate::network::Network;
use crate::network::graph::Input;
use crate::surface::Surface;

/// Runs for which a mesh is kept that none of them asked for.
const RUNS: u64 = 16;

/// The script and name of a mesh.
pub(super) type Place = (ModuleId, Arc<str>);

/// The keys of a mesh that was asked for, the last one first, and the run that asked last.
#[derive(Debug)]
struct Asked {
    keys: [Digest; 2],
    run: u64,
}

/// Everything kept; [`Default`] before the first run.
#[derive(Debug, Default)]
pub struct Kept {
    pub(super) memory: Memory,
    pub(super) stages: KeptStages,
}

impl Kept {
    /// Nothing yet but what a folder holds, where results of this session will be kept as well.
    pub fn on(cache: Option<Arc<Cache>>) -> Self {
        Self { stages: KeptStages { cache, ..KeptStages::default() }, ..Self::default() }
    }
}

/// Stages of the last run, each with all that it was made from.
#[derive(Debug, Default)]
pub(super) struct KeptStages {
    pub networks: BTreeMap<ModuleId, KeptNetwork>,
    pub models: BTreeMap<ModuleId, KeptModel>,
    /// Meshes by their keys.
    pub meshes: BTreeMap<Digest, KeptMesh>,
    pub rows: Vec<(Arc<Mesh>, bool, MeshRow)>,
    /// The last two meshes of each declaration: a change that is taken back costs nothing.
    asked: BTreeMap<Place, Asked>,
    /// Parts of the last meshes.
    pub reuse: Reuse,
    pub cache: Option<Arc<Cache>>,
    run: u64,
}

impl KeptStages {
    /// The row of a mesh in the report, measured once.
    pub fn row(&mut self, name: &str, mesh: &Arc<Mesh>, full: bool, measure: impl FnOnce(&Reuse) -> MeshRow) -> MeshRow {
        if let Some((.., row)) = self.rows.iter().find(|(m, f, row)| Arc::ptr_eq(m, mesh) && *f == full && row.name == name) {
            return row.clone();
        }
        let key = self.meshes.iter().find(|(_, kept)| Arc::ptr_eq(&kept.mesh, mesh)).map(|(key, _)| *key);
        let key = key.map(|key| StableHasher::new("row").digest(key).text(name).number(u64::from(full)).finish());
        let cache = self.cache.clone().zip(key);
        let row = cache.as_ref().and_then(|(cache, key)| cache.get("row", *key, bytes::read)).unwrap_or_else(|| {
            let row = measure(&self.reuse);
            if let Some((cache, key)) = &cache {
                cache.put("row", *key, &bytes::bytes_of(&row));
            }
            row
        });
        self.rows.push((mesh.clone(), full, row.clone()));
        row
    }

    /// Forgets what the last run did not use any more.
    pub fn tidy(&mut self) {
        if let Some(cache) = &self.cache {
            cache.tidy();
        }
        self.reuse.end_run();
        self.run += 1;
        let Self { meshes, rows, asked, run, .. } = self;
        asked.retain(|_, asked| asked.run + RUNS > *run);
        meshes.retain(|key, _| asked.values().any(|asked| asked.keys.contains(key)));
        rows.retain(|(mesh, ..)| meshes.values().any(|m| Arc::ptr_eq(&m.mesh, mesh)));
    }
}

#[derive(Debug)]
pub(super) struct KeptNetwork {
    pub inputs: Vec<Input>,
    pub points: Vec<DVec3>,
    pub tolerance: Tolerance,
    pub network: Arc<Network>,
    pub said: Vec<Fault>,
}

impl KeptNetwork {
    pub fn fits(&self, inputs: &[Input], points: &[DVec3], tolerance: &Tolerance) -> bool {
        let same = |(a, b): (&Input, &Input)| a.name == b.name && a.curve.is(&b.curve) && a.cuts == b.cuts;
        self.tolerance == *tolerance
            && self.points == points
            && self.inputs.len() == inputs.len()
            && self.inputs.iter().zip(inputs).all(same)
    }
}

#[derive(Debug)]
pub(super) struct KeptModel {
    pub tolerance: Tolerance,
    pub network: Arc<Network>,
    pub model: Arc<Model>,
}

impl KeptModel {
    pub fn fits(&self, surfaces: &[Named], network: &Arc<Network>, tolerance: &Tolerance) -> bool {
        let same = |(a, b): (&Named, &Named)| a.name == b.name && a.surface.is(&b.surface);
        self.tolerance == *tolerance
            && Arc::ptr_eq(&self.network, network)
            && self.model.surfaces.len() == surfaces.len()
            && self.model.surfaces.iter().zip(surfaces).all(same)
    }
}

#[derive(Debug)]
pub(super) struct KeptMesh {
    pub mesh: Arc<Mesh>,
    pub remarks: Vec<Remark>,
    pub lines: Vec<String>,
}

impl KeptMesh {
    fn of(built: Built) -> Self {
        let Built { mesh, explanation, remarks } = built;
        Self { mesh: Arc::new(mesh), remarks, lines: explanation.lines }
    }
}

impl KeptStages {
    /// The mesh of a key: of this session, or from the folder, where its faces lie on `surfaces`.
    pub fn mesh(&mut self, place: &Place, key: Digest, surfaces: &[&Surface]) -> Option<&KeptMesh> {
        let asked = self.asked.entry(place.clone()).or_insert(Asked { keys: [key; 2], run: self.run });
        asked.run = self.run;
        if asked.keys[0] != key {
            asked.keys = [key, asked.keys[0]];
        }
        if let Entry::Vacant(slot) = self.meshes.entry(key)
            && let Some(cache) = &self.cache
            && let Some(built) = cache.get("mesh", key, |bytes| record::read(bytes, surfaces))
        {
            slot.insert(KeptMesh::of(built));
        }
        self.meshes.get(&key)
    }

    /// Keeps a mesh that was made.
    pub fn keep_mesh(&mut self, key: Digest, built: Built, surfaces: &[&Surface]) -> &KeptMesh {
        if let Some(cache) = &self.cache
            && let Some(bytes) = record::write(&built, surfaces)
        {
            cache.put("mesh", key, &bytes);
        }
        let made = KeptMesh::of(built);
        match self.meshes.entry(key) {
            Entry::Vacant(slot) => slot.insert(made),
            Entry::Occupied(mut slot) => {
                slot.insert(made);
                slot.into_mut()
            }
        }
    }
}
