//! A face with as few triangles as its limits allow: triangulated between lines of constant u and v, and coarsened.

use glam::DVec2;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::request::fault::{MeshLimit, SizeFault};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::size_requests::floor_keeps;
use crate::mesh::request::sources::Sources;
use crate::mesh::request::work::allow;
use crate::mesh::tri::coarsen::Coarsener;
use crate::mesh::tri::isoline_mesh::{Failure, IsolineInput, mesh_isolines};
use crate::mesh::tri::limit_table;
use crate::mesh::tri::no_mesh::{NoMesh, Outcome};
use crate::mesh::tri::triangle_fit::{FaceFit, FittedFace};
use crate::mesh::tri::triangulation::Triangulation;

/// Quality below which sides are flipped: that of a right angle beside one of 15°.
const MIN_UNFLIPPED_QUALITY: f64 = 0.4;

/// Work of the coarsening of an element, in elements.
const COARSENING_WORK: u64 = 60;

impl FaceFit<'_> {
    /// The triangulation between lines of constant u and v.
    pub(crate) fn between_isolines(&self, rules: &Sources, job: &Job) -> Outcome<FittedFace> {
        let plan = self.face_input.input.plan;
        let floor = self.face_input.wanted.written;
        let flat = Limits::default();
        let limits = if self.surface.is_flat() { &flat } else { &self.limits };
        let point = self.face_input.input.tolerance.point;
        let input = IsolineInput {
            chart: self.chart,
            outline: self.outline,
            limits,
            size: self.face.size.0,
            rules,
            floor,
            most: self.most(),
            point,
        };
        match mesh_isolines(&input, job)? {
            Ok(mesh) => Ok(Ok(FittedFace { triangulation: mesh.triangulation, decided: mesh.decided, tally: Some(mesh.tally) })),
            Err(Failure::NoMesh(NoMesh::TooManyNodes)) if limits.chord.or(limits.angle).is_some() => Err(self.too_many_for_limits()),
            Err(Failure::NoMesh(reason)) => Ok(Err(reason)),
            Err(Failure::Floor(needed, at)) => Err(floor_keeps(self.face_input.input, needed, at)),
            Err(Failure::Missed(ratio, at)) => {
                let (limit, setting, over) = match (plan.settings.chord_error, plan.settings.angle_error) {
                    (Some(setting), _) if ratio.chord >= ratio.angle => (MeshLimit::ChordError, setting, ratio.chord),
                    (_, Some(setting)) => (MeshLimit::AngleError, setting, ratio.angle),
                    _ => (MeshLimit::Size, plan.settings.size.unwrap_or((self.face.size.0, plan.origin)), 1.0),
                };
                Err(SizeFault::NotReached { limit, written_at: setting.1, surface: self.surface.origin(), reached: over * setting.0, at }
                    .into())
            }
        }
    }

    /// Flips sides where triangles are sharp, within the same limits: where lines of the surface run together, and where a
    /// border runs along one of them.
    pub(crate) fn flip_sharp(&self, triangulation: &mut Triangulation) {
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let (twins, normals) = (self.outline.twins(), limit_table::Normals::default());
        triangulation.flip_sharp(MIN_UNFLIPPED_QUALITY, &|triangulation, [a, b], both| {
            let keeps = |c: &[u32; 3]| limit_table::ratio_of_upright(self.chart, triangulation, *c, limits, &normals) <= 1.0;
            !triangulation.joined_elsewhere(&twins, a, b) && both.iter().all(keeps)
        });
    }

    /// Coarsens the triangulation within the same limits.
    pub(crate) fn coarsen(&self, triangulation: &mut Triangulation, job: &Job) -> Result<()> {
        allow(COARSENING_WORK * triangulation.tri.len() as u64, &mut 0);
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let normals = limit_table::Normals::default();
        let bound =
            |triangulation: &Triangulation, c: [u32; 3]| limit_table::ratio_of_upright(self.chart, triangulation, c, limits, &normals);
        let twins = self.outline.twins();
        let allowed = |triangulation: &Triangulation, a: u32, b: u32| {
            self.longest.allows(triangulation, a, b) && !triangulation.joined_elsewhere(&twins, a, b)
        };
        let point = |xy: DVec2| self.chart.spot(xy).p;
        Coarsener { bound: &bound, allowed: &allowed, point: &point }.coarsen(triangulation, job)?;
        triangulation.compact();
        Ok(())
    }
}
