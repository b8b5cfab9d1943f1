//! The stages of the pipeline over the kernel floors: curves to network, surfaces to model, plans to meshes.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DVec3;

use crate::base::fault::{Fault, Say, ValueFault};
use crate::base::job::Job;
use crate::base::limits::{STAGE_WORK, WORK_OF_A_CURVE, WORK_OF_A_SURFACE};
use crate::base::tolerance::Tolerance;
use crate::base::work::{Budget, Exceeded};
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::pipeline::{Parts, Pipeline};
use crate::lang::eval::scene::Scene;
use crate::lang::values::plans::MeshSpec;
use crate::lang::values::value::ModuleId;
use crate::mesh;
use crate::mesh::Mesh;
use crate::mesh::cache::reuse::Shelf;
use crate::mesh::size::remark::Remark;
use crate::model::Model;
use crate::model::topology::Named;
use crate::network::{Chain, Network};
use crate::surface::Surface;

use super::kept::{KeptMesh, KeptModel, KeptNetwork, KeptStages, Place};
use super::network_inputs::inputs;
use super::report::MeshRow;
use super::{canonical, collect, plan};

/// The pipeline of a session; remembers how things were found and how long meshes took.
pub struct Stages<'c> {
    clock: &'c (dyn Fn() -> f64 + Sync),
    found: Mutex<Found>,
    /// What the run before made, and where this one leaves what it makes; `None` in a run that keeps nothing.
    kept: Option<Mutex<KeptStages>>,
}

#[derive(Debug, Default)]
struct Found {
    notes: Vec<String>,
    mesh_seconds: f64,
    reused: usize,
    reused_faces: usize,
}

impl<'c> Stages<'c> {
    /// `clock` gives seconds since some moment.
    pub fn new(clock: &'c (dyn Fn() -> f64 + Sync)) -> Self {
        Self { clock, found: Mutex::default(), kept: None }
    }

    /// The same, with what the run before made.
    pub(super) fn recalling(clock: &'c (dyn Fn() -> f64 + Sync), kept: KeptStages) -> Self {
        Self { kept: Some(Mutex::new(kept)), ..Self::new(clock) }
    }

    /// What the next run may take over.
    pub(super) fn into_kept(self) -> KeptStages {
        self.kept.map(|kept| kept.into_inner().unwrap_or_else(PoisonError::into_inner)).unwrap_or_default()
    }

    /// What is kept; `None` in a run that keeps nothing.
    pub(super) fn kept(&self) -> Option<MutexGuard<'_, KeptStages>> {
        Some(self.kept.as_ref()?.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn count_reused(&self) {
        self.found().reused += 1;
    }

    /// Stages and faces that were taken over from the run before.
    pub fn reused(&self) -> usize {
        let found = self.found();
        found.reused + found.reused_faces
    }

    /// Faces of new meshes that were taken over.
    pub fn reused_faces(&self) -> usize {
        self.found().reused_faces
    }

    fn found(&self) -> MutexGuard<'_, Found> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How things were found, a line each.
    pub fn notes(&self) -> Vec<String> {
        self.found().notes.clone()
    }

    /// Seconds spent on meshes.
    pub fn mesh_seconds(&self) -> f64 {
        self.found().mesh_seconds
    }

    fn note(&self, lines: impl IntoIterator<Item = String>) {
        self.found().notes.extend(lines);
    }
}

impl Stages<'_> {
    /// The row of a mesh in the report.
    pub(super) fn row(&self, name: &str, mesh: &Arc<Mesh>, tolerance: &Tolerance, full: bool) -> MeshRow {
        let measured = |reuse: Option<&_>| collect::mesh(name, mesh, tolerance, full, reuse);
        match self.kept() {
            Some(mut kept) => kept.row(name, mesh, full, |reuse| measured(Some(reuse))),
            None => measured(None),
        }
    }
}

impl Pipeline for Stages<'_> {
    fn network(&self, cx: &mut Cx, module: ModuleId, parts: &Parts) -> Result<Arc<Network>, Halt> {
        let tolerance = cx.tolerance()?;
        let curves: Vec<(&str, &Chain)> = parts.curves.iter().map(|c| (&*c.name, &c.value)).collect();
        let modeling = parts.modeling.iter().map(|m| &m.value).collect();
        let surfaces: Vec<_> = parts.surfaces.iter().map(|s| &s.value).collect();
        let inputs = inputs(&curves, modeling, &surfaces, &|origin| cx.name(origin), &tolerance);
        drop(curves);
        let points: Vec<DVec3> = parts.points.iter().map(|p| p.value).collect();
        if let Some(kept) = self.kept()
            && let Some(before) = kept.networks.get(&module).filter(|before| before.fits(&inputs, &points, &tolerance))
        {
            self.count_reused();
            cx.say_all(&before.said);
            return Ok(before.network.clone());
        }
        let _phase = cx.job.phase("network");
        let mut said = Vec::new();
        let again = self.kept.as_ref().map(|_| inputs.clone());
        let before = self.kept().and_then(|kept| {
            let before = kept.networks.get(&module).filter(|before| before.tolerance == tolerance);
            before.map(|before| before.network.clone())
        });
        let (parts, job) = (inputs.len(), cx.job);
        let made = || Network::build_after(before.as_deref(), inputs, &points, &tolerance, job, &mut said);
        let network = Arc::new(within_work("the network", WORK_OF_A_CURVE.saturating_mul(parts as u64), made)?);
        cx.say_all(&said);
        if let (Some(mut kept), Some(inputs)) = (self.kept(), again) {
            kept.networks.insert(module, KeptNetwork { inputs, points, tolerance, network: network.clone(), said });
        }
        Ok(network)
    }

    fn model(&self, cx: &mut Cx, module: ModuleId, parts: &Parts, network: Arc<Network>) -> Result<Arc<Model>, Halt> {
        let tolerance = cx.tolerance()?;
        let named = |s: &crate::lang::eval::pipeline::Declared<crate::surface::Surface>| Named {
            name: s.name.to_string(),
            surface: s.value.clone(),
        };
        let mut surfaces: Vec<Named> = parts.surfaces.iter().map(named).collect();
        canonical::sort_surfaces(&mut surfaces, &tolerance);
        if let Some(kept) = self.kept()
            && let Some(before) = kept.models.get(&module).filter(|before| before.fits(&surfaces, &network, &tolerance))
        {
            self.count_reused();
            return Ok(before.model.clone());
        }
        let _phase = cx.job.phase("surfaces");
        let (parts, job) = (surfaces.len(), cx.job);
        let made = || Model::build(surfaces, &network, &tolerance, job);
        let model = Arc::new(within_work("the surface model", WORK_OF_A_SURFACE.saturating_mul(parts as u64), made)?);
        if let Some(mut kept) = self.kept() {
            kept.models.insert(module, KeptModel { tolerance, network, model: model.clone() });
        }
        Ok(model)
    }

    fn mesh(&self, cx: &mut Cx, module: ModuleId, spec: &MeshSpec) -> Result<Arc<Mesh>, Halt> {
        let (tolerance, start) = (cx.tolerance()?, (self.clock)());
        let mut sink = Vec::new();
        let (plan, Scene { model, network }) = plan::of(cx, module, spec, &mut sink)?;
        let (k, of) = cx.place_of_mesh(module, &spec.name);
        let _phase = cx.job.phase(format!("meshing {} ({k} of {of})", spec.name));
        let input = mesh::Input { plan: &plan, model: &model, network: &network, tolerance: &tolerance };
        let made = self.made(&input, (module, spec.name.clone()), cx.job);
        self.found().mesh_seconds += (self.clock)() - start;
        // What the plan has to say comes first, also when the mesh fails.
        let made = made.inspect_err(|_| cx.say_all(&sink))?;
        sink.extend(made.remarks.iter().map(|remark| remark.fault(&input)));
        cx.say_all(&sink);
        self.note(made.lines.iter().map(|line| format!("mesh {}: {line}", spec.name)));
        Ok(made.mesh)
    }
}

/// Makes something of parts that may take so much work together; E217 where it takes more.
fn within_work<T>(what: &'static str, of_parts: u64, make: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    Budget::new(STAGE_WORK.saturating_add(of_parts)).within(make).unwrap_or_else(|Exceeded| Err(ValueFault::StageWork { what }.into()))
}

/// A mesh with what is said about it.
struct Made {
    mesh: Arc<Mesh>,
    remarks: Vec<Remark>,
    lines: Vec<String>,
}

impl Stages<'_> {
    /// The mesh of a plan: one that was made before, or a new one.
    fn made(&self, input: &mesh::Input, place: Place, job: &Job) -> Result<Made, Fault> {
        let outline = mesh::MeshLayouts::new(input)?;
        let of = |kept: &KeptMesh| Made { mesh: kept.mesh.clone(), remarks: kept.remarks.clone(), lines: kept.lines.clone() };
        let Some(kept) = &self.kept else {
            let mesh::Built { mesh, explanation, remarks } = outline.build(input, None, job)?;
            return Ok(Made { mesh: Arc::new(mesh), remarks, lines: explanation.lines });
        };
        let kept = || kept.lock().unwrap_or_else(PoisonError::into_inner);
        let key = outline.key(input);
        let surfaces: Vec<Surface> = outline.surfaces(input).into_iter().cloned().collect();
        let surfaces: Vec<&Surface> = surfaces.iter().collect();
        if let Some(before) = kept().mesh(&place, key, &surfaces) {
            self.count_reused();
            return Ok(of(before));
        }
        let mut reuse = std::mem::take(&mut kept().reuse);
        reuse.beside(kept().cache.clone().map(|cache| cache as Arc<dyn Shelf>));
        let faces = reuse.faces();
        let built = job.watch(|| outline.build(input, Some(&reuse), job)).and_then(|built| built);
        self.found().reused_faces += reuse.faces() - faces;
        let mut kept = kept();
        kept.reuse = reuse;
        Ok(of(kept.keep_mesh(key, built?, &surfaces)))
    }
}
