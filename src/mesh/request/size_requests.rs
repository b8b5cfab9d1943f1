//! The sizes that `near`, `in` and `min_size` request, as one function of the place.

use glam::DVec3;

use crate::base::fault::{Fault, Result};
use crate::mesh::request::fault::{MeshLimit, SizeFault};
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::{Place, Refine};
use crate::mesh::request::sources::{Body, Least, Source, Sources, pieces};
use crate::surface::{Domain, Surface};

/// What steers sources of sizes.
struct RequestSettings {
    /// Largest distance of a curve from the straight pieces that stand for it, over the size near it.
    max_chord_error: f64,
    /// Share of the size that is the floor where none is written.
    floor: f64,
    /// How much above the least length on a patch the one found may be, over itself.
    least_error: f64,
    /// Rectangles of a patch examined before the best length found is taken.
    max_rectangles: usize,
}

const SETTINGS: RequestSettings = RequestSettings { max_chord_error: 1.0 / 64.0, floor: 0.01, least_error: 0.02, max_rectangles: 20_000 };

/// Lengths wanted at places, and their floor.
#[derive(Clone, Debug, Default)]
pub struct SizeRequests {
    /// Sources of `near` and `in`; tags are places in the plan's list.
    pub sources: Sources,
    /// Least size that short edges of the model have when sizes grow from them, model units.
    pub floor: f64,
    /// Floor of all sizes, model units: as written, else 0.
    pub written: f64,
}

impl SizeRequests {
    /// Of a plan whose size is `size` where no rule gives another.
    ///
    /// Fails with E707 where a size is below a written `min_size`.
    pub fn new(input: &Input, size: f64) -> Result<Self> {
        let plan = input.plan;
        let written =
            plan.rules.iter().filter_map(|r| r.settings.size).chain(plan.refines.iter().map(|r| r.size)).chain(plan.settings.size);
        if let Some(floor) = plan.settings.min_size
            && let Some(size) = written.clone().find(|s| s.0 < floor.0)
        {
            return Err(SizeFault::BelowFloor { size, floor }.into());
        }
        let least = written.map(|s| s.0).fold(f64::INFINITY, f64::min);
        let floor = plan.settings.min_size.map_or_else(|| (SETTINGS.floor * size).min(least), |s| s.0);
        let items = plan.refines.iter().enumerate().flat_map(|(k, refine)| sources_of(refine, k as u32));
        Ok(Self { sources: Sources::new(items.collect(), plan.slope()), floor, written: plan.settings.min_size.map_or(0.0, |s| s.0) })
    }

    /// The floor where bends ask for a length: as written, or at most a hundredth of that length.
    pub fn floor_where(&self, length: f64) -> f64 {
        if self.written > 0.0 { self.floor } else { self.floor.min(SETTINGS.floor * length) }
    }
}

fn sources_of(refine: &Refine, tag: u32) -> Vec<Source> {
    let (size, radius) = (refine.size.0, refine.radius);
    let of = |place: &Place| -> Vec<Source> {
        match place {
            Place::Point(p) => vec![Source { body: Body::Point(*p), radius, size, steep: 1.0, tag }],
            Place::Box(b) => vec![Source { body: Body::Box(*b), radius: 0.0, size, steep: 1.0, tag }],
            Place::Chain(chain) => {
                let off = SETTINGS.max_chord_error * size;
                let piece = |(a, b)| Source { body: Body::Segment(a, b), radius: radius + off, size, steep: 1.0, tag };
                pieces(chain, off).into_iter().map(piece).collect()
            }
        }
    };
    refine.at.iter().flat_map(of).collect()
}

/// E707: a limit demands elements of a size below the floor.
pub fn floor_keeps(input: &Input, needed: f64, at: DVec3) -> Fault {
    let plan = input.plan;
    let (limit, written_at) = plan.bend_limit().unwrap_or((MeshLimit::Size, plan.origin));
    SizeFault::FloorKeeps { limit, written_at, floor: plan.settings.min_size.unwrap_or((needed, plan.origin)), needed, at }.into()
}

/// The least length that sources want on a patch, within 2 % of itself, where that is below `most`: rectangles
/// are halved where their box leaves room for less.
pub fn least_on(surface: &Surface, u: (f64, f64), v: (f64, f64), sources: &Sources, most: f64) -> Option<Least> {
    if sources.is_empty() || sources.least() >= most {
        return None;
    }
    let triangle = surface.domain() == Domain::Triangle;
    let mut best: Option<Least> = None;
    let mut open = vec![(u, v)];
    for _ in 0..SETTINGS.max_rectangles {
        let Some((u, v)) = open.pop() else { break };
        if triangle && u.0 + v.0 >= 1.0 {
            continue;
        }
        let bounds = surface.enclosure(u, v).p.bounds();
        let (x, y) = (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
        let p = if triangle && x + y > 1.0 { surface.point(u.0, v.0) } else { surface.point(x, y) };
        let reach = (p - bounds.min).max(bounds.max - p).length();
        let now = best.map_or(most, |b| b.size);
        let Some(here) = sources.who(p, now + sources.steepest() * reach) else { continue };
        if here.size < now {
            best = Some(here);
            if here.size <= sources.least() {
                return best;
            }
        }
        let now = best.map_or(most, |b| b.size);
        if (here.size - sources.steepest() * reach).max(sources.least()) >= now * (1.0 - SETTINGS.least_error) {
            continue;
        }
        let jet = surface.jet(x, y);
        if jet.du.length() * (u.1 - u.0) >= jet.dv.length() * (v.1 - v.0) {
            open.extend([((x, u.1), v), ((u.0, x), v)]);
        } else {
            open.extend([(u, (y, v.1)), (u, (v.0, y))]);
        }
    }
    best
}
