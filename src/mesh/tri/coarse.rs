//! A face with as few triangles as its limits allow: laid out between lines of constant u and v, and thinned.

use glam::DVec2;

use crate::base::fault::Result;
use crate::base::job::Job;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::request::fault::{MeshFault, MeshLimit};
use crate::mesh::request::limits::Limits;
use crate::mesh::request::size_requests::floor_keeps;
use crate::mesh::request::sources::Sources;
use crate::mesh::request::work::allow;
use crate::mesh::tri::coarsen::Thinner;
use crate::mesh::tri::fit::{Fit, Shown};
use crate::mesh::tri::isoline_mesh::{Failure, IsolineInput, lay};
use crate::mesh::tri::limit_table;
use crate::mesh::tri::triangulation::Triangulation;
use crate::mesh::tri::trouble::Trouble;

/// Quality below which sides are flipped: that of a right angle beside one of 15°.
const SHARP: f64 = 0.4;

/// Elements whose work it takes to thin one out.
const THINNED: u64 = 60;

impl Fit<'_> {
    /// Between lines of constant u and v.
    pub(crate) fn laid(&self, rules: &Sources, job: &Job) -> Result<std::result::Result<Shown, Trouble>> {
        let plan = self.made.input.plan;
        let floor = self.made.wanted.written;
        let flat = Limits::default();
        let limits = if self.surface.is_flat() { &flat } else { &self.limits };
        let point = self.made.input.tolerance.point;
        let ask = IsolineInput {
            chart: self.chart,
            outline: self.outline,
            limits,
            size: self.face.size.0,
            rules,
            floor,
            most: self.most(),
            point,
        };
        match lay(&ask, job)? {
            Ok(laid) => Ok(Ok((laid.triangulation, laid.deciders, Some(laid.tally)))),
            Err(Failure::Trouble(Trouble::Full)) if limits.chord.or(limits.angle).is_some() => Err(self.too_many_for_limits()),
            Err(Failure::Trouble(trouble)) => Ok(Err(trouble)),
            Err(Failure::Floor(needed, at)) => Err(floor_keeps(self.made.input, needed, at)),
            Err(Failure::Missed(load, at)) => {
                let (limit, says, over) = match (plan.settings.chord_error, plan.settings.angle_error) {
                    (Some(says), _) if load.chord >= load.angle => (MeshLimit::ChordError, says, load.chord),
                    (_, Some(says)) => (MeshLimit::AngleError, says, load.angle),
                    _ => (MeshLimit::Size, plan.settings.size.unwrap_or((self.face.size.0, plan.origin)), 1.0),
                };
                Err(MeshFault::NotReached { limit, says: says.1, surface: self.surface.origin(), reached: over * says.0, at }.into())
            }
        }
    }

    /// Sides flipped where triangles are sharp, within the same limits: where lines of the surface run together, and where a
    /// border runs along one of them.
    pub(crate) fn raise(&self, triangulation: &mut Triangulation) {
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let (twins, normals) = (self.outline.twins(), limit_table::Normals::default());
        triangulation.raise(SHARP, &|triangulation, [a, b], both| {
            let keeps = |c: &[u32; 3]| limit_table::load_of_upright(self.chart, triangulation, *c, limits, &normals) <= 1.0;
            !triangulation.joined_elsewhere(&twins, a, b) && both.iter().all(keeps)
        });
    }

    /// Fewer triangles for the same limits.
    pub(crate) fn thin(&self, triangulation: &mut Triangulation, job: &Job) -> Result<()> {
        allow(THINNED * triangulation.tri.len() as u64, &mut 0);
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let normals = limit_table::Normals::default();
        let bound =
            |triangulation: &Triangulation, c: [u32; 3]| limit_table::load_of_upright(self.chart, triangulation, c, limits, &normals);
        let twins = self.outline.twins();
        let allowed = |triangulation: &Triangulation, a: u32, b: u32| {
            self.longest.allows(triangulation, a, b) && !triangulation.joined_elsewhere(&twins, a, b)
        };
        let point = |xy: DVec2| self.chart.spot(xy).p;
        Thinner { bound: &bound, allowed: &allowed, point: &point }.thin(triangulation, job)?;
        triangulation.compact();
        Ok(())
    }
}
