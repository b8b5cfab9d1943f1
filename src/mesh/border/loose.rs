//! Curves of a mesh that lie on its faces along a part of a segment alone: over a hole, or beyond the border. Lines of a face are whole
//! segments, so such a curve shares no nodes with the face that it lies on.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::base::bytes::{Bytes, Plain, Put};
use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::mesh::border::layout::Layout;
use crate::mesh::request::fault::MeshFault;
use crate::mesh::request::input::Input;
use crate::model::SurfaceId;
use crate::model::imprint::runs_on;
use crate::model::segments::SegmentUse;
use crate::surface::Nearest;

/// A curve that lies on a face and shares no nodes with it there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loose {
    /// The curve by its place in the plan.
    pub curve: usize,
    /// The surface of the face by its place in the plan.
    pub surface: usize,
    /// Length that lies on the face, model units.
    pub length: f64,
    /// Where it leaves the face first.
    pub at: DVec3,
    /// How many other curves there are.
    pub more: usize,
}

/// A segment that is off a face over a shorter length than this lies on it as a whole; in distances within which two points are one.
const SHORT: f64 = 16.0;

/// Where the curves of a plan lie on its faces, each found when it is asked for.
pub struct Leaving<'a> {
    input: &'a Input<'a>,
    /// The curve of each segment of one, and where on it the segment is.
    of_segment: BTreeMap<usize, (usize, SegmentUse)>,
    /// Arc lengths between which a curve lies on a surface.
    runs: BTreeMap<(usize, SurfaceId), Vec<(f64, f64)>>,
    /// The surfaces, ready for nearest points.
    ready: BTreeMap<SurfaceId, Nearest>,
}

impl<'a> Leaving<'a> {
    /// Of the curves of a layout.
    pub fn new(input: &'a Input<'a>, layout: &Layout) -> Self {
        let uses = layout.curves.iter().enumerate().flat_map(|(curve, uses)| uses.iter().map(move |u| (u.segment, (curve, *u))));
        Self { input, of_segment: uses.collect(), runs: BTreeMap::new(), ready: BTreeMap::new() }
    }

    /// Of a segment that lies on a surface in part: the length that does, and where it leaves the surface. `near` is what counts as one point.
    pub fn part(&mut self, segment: usize, surface: SurfaceId, near: f64) -> Option<(f64, DVec3)> {
        let (curve, u) = *self.of_segment.get(&segment)?;
        let (input, chain) = (self.input, &self.input.plan.curves[curve].1);
        let runs = self.runs.entry((curve, surface)).or_insert_with(|| {
            let nearest = self.ready.entry(surface).or_insert_with(|| Nearest::new(&input.model.surfaces[surface.index()].surface));
            // Where the search exceeds its limit the curve is left as it is.
            let found = runs_on(chain, nearest, input.tolerance).unwrap_or_default();
            found.into_iter().map(|(from, to)| (from * chain.length(), to * chain.length())).collect()
        });
        let least = SHORT * near;
        let on = runs.iter().map(|run| (run.0.max(u.s.0), run.1.min(u.s.1))).filter(|(low, high)| high - low > 2.0 * near);
        let on: Vec<(f64, f64)> = on.collect();
        let length: f64 = on.iter().map(|(low, high)| high - low).sum();
        let (first, last) = (on.first()?, on.last()?);
        let at = if first.1 < u.s.1 - near { first.1 } else { last.0 };
        (u.s.1 - u.s.0 - length > least).then(|| (length, chain.point(at / chain.length())))
    }
}

/// The first such curve in the order of the plan, once the faces have their lines.
pub fn find(input: &Input, layout: &Layout, leaving: &mut Leaving) -> Option<Loose> {
    let mut lines: BTreeMap<SurfaceId, (BTreeSet<usize>, f64)> = BTreeMap::new();
    for face in &layout.faces {
        let own = lines.entry(face.surface).or_default();
        own.0.extend(face.segments());
        own.1 = own.1.max(face.near);
    }
    let mut first: Option<Loose> = None;
    for (curve, uses) in layout.curves.iter().enumerate() {
        for (id, (own, near)) in &lines {
            let open = uses.iter().filter(|u| !own.contains(&u.segment));
            let parts: Vec<(f64, DVec3)> = open.filter_map(|u| leaving.part(u.segment, *id, *near)).collect();
            let place = input.plan.surfaces.iter().position(|s| s.0 == *id);
            let (Some((_, at)), Some(surface)) = (parts.first().copied(), place) else { continue };
            match &mut first {
                Some(found) if found.curve == curve => {}
                Some(found) => {
                    found.more += 1;
                    break;
                }
                None => {
                    let length = parts.iter().map(|part| part.0).sum();
                    first = Some(Loose { curve, surface, length, at, more: 0 });
                }
            }
        }
    }
    first
}

impl Loose {
    /// The warning.
    pub fn fault(&self, input: &Input) -> Fault {
        let plan = input.plan;
        let curve = plan.curves.get(self.curve).map_or(Origin::NONE, |(_, chain)| chain.origin());
        let surface = plan.surfaces.get(self.surface).map(|s| &input.model.surfaces[s.0.index()].surface);
        let surface = surface.map_or(Origin::NONE, crate::surface::Surface::origin);
        let (length, at, more) = (self.length, self.at, self.more);
        MeshFault::Loose { of: plan.origin, curve, surface, length, at, more, imprint: plan.imprint.is_some() }.into()
    }
}

impl Put for Loose {
    fn put(&self, to: &mut Vec<u8>) {
        ((self.curve, self.surface), (self.length, (self.at, self.more))).put(to);
    }
}

impl Plain for Loose {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        let ((curve, surface), (length, (at, more))): ((usize, usize), (f64, (DVec3, usize))) = Plain::take(from)?;
        Some(Self { curve, surface, length, at, more })
    }
}
