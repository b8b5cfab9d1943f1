//! How large a mesh may become and how much work it may take.

use crate::base::fault::Fault;
use crate::base::limits::{MESH_WORK, WORK_OF_AN_ELEMENT};
use crate::base::origin::Origin;
use crate::base::work;
use crate::mesh::request::fault::MeshFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::Plan;
use crate::surface::Surface;

/// Too many elements, before anything is allocated; `None` where it is not known how many.
pub fn too_many(plan: &Plan, of: Origin, elements: Option<u64>) -> Fault {
    MeshFault::TooMany { of, name: plan.name.clone(), elements, limit: plan.most_elements }.into()
}

/// More work than a mesh may take, of a face or of all.
pub fn too_much_work(input: &Input, surface: Origin) -> Fault {
    let plan = input.plan;
    let limit = plan.bend_limit().map(|limit| limit.1);
    MeshFault::TooMuchWork { of: limit.unwrap_or_else(|| plan.size_origin()), name: plan.name.clone(), surface }.into()
}

/// Work that a mesh of some surfaces may take beside that of its elements, in evaluations of curves and surfaces: more where a point of
/// one is made of many curves.
pub fn work_on<'a>(surfaces: impl Iterator<Item = &'a Surface>) -> u64 {
    /// Number of curves that cost as much again.
    const CURVES: usize = 16;
    let curves = |surface: &Surface| {
        let (across, along) = surface.curves_of_a_point();
        across + along
    };
    MESH_WORK * (1 + surfaces.map(curves).max().unwrap_or(0) / CURVES) as u64
}

/// Raises what a mesh or face may take to what so many elements are worth, with what was `worth` for it before.
pub fn allow(elements: u64, worth: &mut u64) {
    let now = elements.saturating_mul(WORK_OF_AN_ELEMENT);
    if let Some(budget) = work::budget() {
        budget.allow(now.saturating_sub(*worth));
    }
    *worth = now.max(*worth);
}
