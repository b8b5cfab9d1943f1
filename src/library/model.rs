//! What a script makes, or what is put together in Rust: curves, surfaces, shells, and meshes of them.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::curve::Curve;
use super::error::{Error, row};
use super::mesh::Mesh;
use super::names::{DEFAULT_UNIT, Names, Speaker};
use super::network::Network;
use super::output::Output;
use super::surface::Surface;
use crate::base::fault::ValueFault;
use crate::base::job::Job;
use crate::base::limits::{STAGE_WORK, WORK_OF_A_SURFACE};
use crate::base::tolerance::Tolerance;
use crate::base::work::{Budget, Exceeded};
use crate::lang::eval::scene::Scene;
use crate::lang::values::units::{LengthUnit, length_unit};
use crate::lang::values::value::ShellValue;
use crate::model;
use crate::model::topology::Named;
use crate::session::canonical::sort_surfaces;
use crate::session::json::report_text;
use crate::session::report::{CheckRow, DiagnosticRow, Report};
use crate::surface as kernel;

/// Curves and surfaces of one model, by name: what [`Script::run`](crate::Script::run) gives, or [`Model::new`] from things made in Rust.
///
/// A [`MeshPlan`](crate::MeshPlan) meshes it, as often as one likes.
///
/// ```
/// let model = lofting::Script::from_str("units m\ncurve rim = circle(center: (0, 0, 0), radius: 2m)\nsurface lid = plane(rim)").run()?;
/// let rim = model.curve("rim").ok_or("no rim")?;
/// assert_eq!((model.unit(), model.surfaces().len()), ("m", 1));
/// assert!((rim.length() - 4.0 * std::f64::consts::PI).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) scene: Scene,
    pub(super) tolerance: Tolerance,
    pub(super) unit: LengthUnit,
    pub(super) names: Names,
    pub(super) curves: Vec<Curve>,
    pub(super) surfaces: Vec<Surface>,
    pub(super) shells: Vec<Arc<ShellValue>>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) report: Report,
    pub(super) outputs: Vec<Output>,
}

impl Model {
    /// Curves and surfaces as one model. Names are made unique by a number; things without one are called by their kind and place, as
    /// `surface_1`. Curves that surfaces stand on belong to the model also where they are not listed.
    ///
    /// Fails where the curves make no network, E5xx, or the surfaces no model, E6xx.
    pub fn new<'a>(
        curves: impl IntoIterator<Item = &'a Curve>,
        surfaces: impl IntoIterator<Item = &'a Surface>,
        tolerance: &Tolerance,
    ) -> Result<Self, Error> {
        let surfaces: Vec<Surface> = surfaces.into_iter().cloned().collect();
        let mut known = BTreeSet::new();
        let mut listed: Vec<Curve> = curves.into_iter().cloned().collect();
        listed.extend(surfaces.iter().flat_map(|surface| surface.curves.iter().cloned()));
        listed.retain(|curve| known.insert(curve.origin()));
        let mut taken = BTreeSet::new();
        let curves: Vec<Curve> = listed.iter().map(|curve| curve.called(&unique(&mut taken, curve.name(), "curve"))).collect();
        let surfaces: Vec<Surface> =
            surfaces.iter().map(|surface| surface.called(&unique(&mut taken, surface.name(), "surface"))).collect();
        let mut names = Names::default();
        curves.iter().for_each(|curve| names.add(curve.origin(), curve.name()));
        surfaces.iter().for_each(|surface| names.add(surface.surface.origin(), surface.name()));
        let say = Speaker { names: &names, unit: Some(DEFAULT_UNIT), tolerance: Some(*tolerance) };
        let bodies: Vec<kernel::Surface> = surfaces.iter().map(|surface| surface.surface.clone()).collect();
        let network = Network::under(&curves, &bodies, &say, tolerance)?;
        let mut named: Vec<Named> = surfaces.iter().map(|s| Named { name: s.name().to_owned(), surface: s.surface.clone() }).collect();
        sort_surfaces(&mut named, tolerance);
        let work = STAGE_WORK.saturating_add(WORK_OF_A_SURFACE.saturating_mul(named.len() as u64));
        let build = || model::Model::build(named, &network.network, tolerance, &Job::new());
        let too_much = |Exceeded| Err(ValueFault::StageWork { what: "the surface model" }.into());
        let model = Budget::new(work).within(build).unwrap_or_else(too_much).map_err(|fault| Error::of_fault(&fault, &say))?;
        let mut report = Report { units: DEFAULT_UNIT.name.to_owned(), ok: true, ..Report::default() };
        report.diagnostics.extend(surfaces.iter().flat_map(|surface| surface.diagnostics()).chain(network.diagnostics()).cloned());
        Ok(Self {
            scene: Scene { model: Arc::new(model), network: network.network },
            tolerance: *tolerance,
            unit: DEFAULT_UNIT,
            names,
            curves,
            surfaces,
            shells: Vec::new(),
            meshes: Vec::new(),
            report,
            outputs: Vec::new(),
        })
    }

    /// The same model with coordinates in another unit: `um`, `mm`, `cm`, `m`, `km`, `in`, `ft` and so on; nothing is scaled. It is `mm`
    /// where nothing is said.
    pub fn with_unit(mut self, unit: &str) -> Result<Self, Error> {
        self.unit = length_unit(unit).ok_or_else(|| Error::outside("unit", format!("{unit:?}"), "a unit of length"))?;
        self.report.units = self.unit.name.to_owned();
        Ok(self)
    }

    /// The unit of all lengths: `m`.
    pub fn unit(&self) -> &'static str {
        self.unit.name
    }

    /// What counts as one point in it.
    pub fn tolerance(&self) -> &Tolerance {
        &self.tolerance
    }

    /// Curves in order of declaration.
    pub fn curves(&self) -> &[Curve] {
        &self.curves
    }

    /// The curve of a name, as `south` or `ribs[2]`.
    pub fn curve(&self, name: &str) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.name() == name)
    }

    /// Surfaces in order of declaration.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The surface of a name.
    pub fn surface(&self, name: &str) -> Option<&Surface> {
        self.surfaces.iter().find(|surface| surface.name() == name)
    }

    /// All curves in one network.
    pub fn network(&self) -> Network {
        Network::of_script(&self.scene.network)
    }

    /// The meshes that the script declares, in order.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// The declared mesh of a name.
    pub fn mesh(&self, name: &str) -> Option<&Mesh> {
        self.meshes.iter().find(|mesh| mesh.name() == name)
    }

    /// The checks of the script, each with its line and whether it holds.
    pub fn checks(&self) -> &[CheckRow] {
        &self.report.checks
    }

    /// Warnings and notes; where the run failed, errors as well.
    pub fn diagnostics(&self) -> &[DiagnosticRow] {
        &self.report.diagnostics
    }

    /// The files that the script exports.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// The output of a path as the script writes it.
    pub fn output(&self, path: &str) -> Option<&Output> {
        self.outputs.iter().find(|output| output.path() == path)
    }

    /// Everything that the run found out, lengths, areas, volumes, quality of meshes, report tables, as the JSON text of `loft run --json`
    /// (`docs/report.schema.json`). Of a model made in Rust only what was said.
    pub fn to_json(&self) -> String {
        report_text(&self.report)
    }

    pub(super) fn speaker(&self) -> Speaker<'_> {
        Speaker { names: &self.names, unit: Some(self.unit), tolerance: Some(self.tolerance) }
    }

    /// Rows of faults in this model's words.
    pub(super) fn rows(&self, faults: &[crate::base::fault::Fault]) -> Vec<DiagnosticRow> {
        faults.iter().map(|fault| row(fault, &self.speaker())).collect()
    }
}

/// A name that is not taken yet: the one given, or of its kind with a number.
fn unique(taken: &mut BTreeSet<String>, name: &str, kind: &str) -> String {
    let free = |candidate: &String| !taken.contains(candidate);
    let numbered = |stem: &str, first: usize| (first..).map(|n| format!("{stem}_{n}")).find(free).unwrap_or_default();
    let chosen = match name {
        "" => numbered(kind, 1),
        name if free(&name.to_owned()) => name.to_owned(),
        name => numbered(name, 2),
    };
    taken.insert(chosen.clone());
    chosen
}
