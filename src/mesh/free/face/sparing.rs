//! A face with as few triangles as its limits allow: laid out between lines of constant u and v, and thinned.

use glam::DVec2;

use super::fit::{Fit, Shown};
use crate::base::fault::{MeshFault, Result};
use crate::base::job::Job;
use crate::mesh::edges::Limits;
use crate::mesh::faces::allow;
use crate::mesh::free::build::Trouble;
use crate::mesh::free::ground::ParametricSurface;
use crate::mesh::free::lay::{Failure, IsolineInput, lay};
use crate::mesh::free::loads;
use crate::mesh::free::thin::Thinner;
use crate::mesh::free::triangulation::Triangulation;
use crate::mesh::sources::Sources;
use crate::mesh::wanted::floor_keeps;

/// Quality below which sides are flipped: that of a right angle beside one of 15°.
const SHARP: f64 = 0.4;

/// Elements whose work it takes to thin one out.
const THINNED: u64 = 60;

impl Fit<'_> {
    /// Between lines of constant u and v.
    pub(super) fn laid(&self, rules: &Sources, job: &Job) -> Result<std::result::Result<Shown, Trouble>> {
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
                let (limit, says, over) = match (plan.chord_error, plan.angle_error) {
                    (Some(says), _) if load.chord >= load.angle => ("chord_error", says, load.chord),
                    (_, Some(says)) => ("angle_error", says, load.angle),
                    _ => ("size", plan.size.unwrap_or((self.face.size.0, plan.origin)), 1.0),
                };
                Err(MeshFault::NotReached { limit, says: says.1, surface: self.surface.origin(), reached: over * says.0, at }.into())
            }
        }
    }

    /// Sides flipped where triangles are sharp, within the same limits: where lines of the surface run together, and where a
    /// border runs along one of them.
    pub(super) fn raise(&self, triangulation: &mut Triangulation) {
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let (twins, normals) = (self.outline.twins(), loads::Normals::default());
        triangulation.raise(SHARP, &|triangulation, [a, b], both| {
            let keeps = |c: &[u32; 3]| loads::load_of_upright(self.chart, triangulation, *c, limits, &normals) <= 1.0;
            !triangulation.joined_elsewhere(&twins, a, b) && both.iter().all(keeps)
        });
    }

    /// Fewer triangles for the same limits.
    pub(super) fn thin(&self, triangulation: &mut Triangulation, job: &Job) -> Result<()> {
        allow(THINNED * triangulation.tri.len() as u64, &mut 0);
        let limits = if self.surface.is_flat() { &Limits::default() } else { &self.limits };
        let normals = loads::Normals::default();
        let bound = |triangulation: &Triangulation, c: [u32; 3]| loads::load_of_upright(self.chart, triangulation, c, limits, &normals);
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
