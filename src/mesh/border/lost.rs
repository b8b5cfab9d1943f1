//! What is in a model but not in its mesh, because it is no larger than what is glued: holes, curves and whole faces that became
//! points or lines. Each is reported, for the mesh has other parts or another area than the model.

use glam::DVec3;

use crate::base::bytes::{Bytes, Plain, Put};
use crate::base::digest::{StableHash, StableHasher};
use crate::base::fault::Fault;
use crate::base::origin::Origin;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::request::fault::{LostPart, MeshFault};
use crate::mesh::request::input::Input;
use crate::model::{PatchId, SurfaceId};
use crate::surface::{Domain, Side};

/// What became a point or a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A hole of a surface of the plan, by the places of the surface and of the hole's first side.
    Hole(usize, usize),
    /// A curve of the plan, by its place.
    Curve(usize),
    /// A face of a surface of the plan, by the place of the surface.
    Face(usize),
}

/// Something that is not in the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lost {
    /// What it is.
    pub what: What,
    /// Its length, of a hole that round it, model units; 0 for a face.
    pub length: f64,
    /// Where it is.
    pub at: DVec3,
    /// How many others of its kind there are.
    pub more: usize,
}

impl Lost {
    /// The warning.
    pub fn fault(&self, input: &Input) -> Fault {
        let plan = input.plan;
        let surface = |place: usize| plan.surfaces.get(place).map(|s| &input.model.surfaces[s.0.index()].surface);
        let origin = |place: usize| surface(place).map_or(Origin::NONE, crate::surface::Surface::origin);
        let what = match self.what {
            What::Hole(place, side) => {
                let hole = match surface(place).map(|s| s.side(side)) {
                    Some(Side::Chain { chain, .. }) => chain.origin(),
                    _ => Origin::NONE,
                };
                LostPart::Hole { hole, surface: origin(place) }
            }
            What::Curve(place) => LostPart::Curve(plan.curves.get(place).map_or(Origin::NONE, |(_, chain)| chain.origin())),
            What::Face(place) => LostPart::Face(origin(place)),
        };
        let (length, at, more) = (self.length, self.at, self.more);
        MeshFault::Lost { of: plan.origin, name: plan.name.clone(), what, length, at, more }.into()
    }
}

/// What a layout has not kept, the longest of each kind. `slivers` are the patches that have no face.
pub fn find(input: &Input, layout: &Layout, slivers: &[PatchId]) -> Vec<Lost> {
    let place = |surface: SurfaceId| input.plan.surfaces.iter().position(|s| s.0 == surface).unwrap_or(0);
    let holes = layout.faces.iter().flat_map(|face| holes(input, face, place(face.surface)));
    let curves = input.plan.curves.iter().zip(&layout.curves).enumerate().filter(|(_, (_, uses))| uses.is_empty());
    let curves = curves.map(|(k, ((_, chain), _))| Lost { what: What::Curve(k), length: chain.length(), at: chain.point(0.0), more: 0 });
    let faces = slivers.iter().map(|patch| {
        let surface = input.model.patches[patch.index()].surface;
        Lost { what: What::Face(place(surface)), length: 0.0, at: input.model.loop_of(*patch).at(0.5).1, more: 0 }
    });
    [longest(holes), longest(curves), longest(faces)].into_iter().flatten().collect()
}

/// The longest of some, the first of those that are alike.
fn longest(all: impl Iterator<Item = Lost>) -> Option<Lost> {
    all.reduce(|a, b| {
        let more = a.more + b.more + 1;
        if b.length > a.length { Lost { more, ..b } } else { Lost { more, ..a } }
    })
}

/// Holes of a face of whose loops nothing is left.
fn holes(input: &Input, face: &Face, place: usize) -> Vec<Lost> {
    let surface = &input.model.surfaces[face.surface.index()].surface;
    let (mut found, mut first) = (Vec::new(), 0);
    if surface.domain() != Domain::Loop {
        return found;
    }
    for (k, sides) in surface.loops().into_iter().enumerate() {
        let around = &face.sides[first..(first + sides).min(face.sides.len())];
        if k > 0 && around.iter().all(|side| side.uses.is_empty()) {
            let length = around.iter().map(|side| side.length).sum();
            found.push(Lost { what: What::Hole(place, first), length, at: surface.border_start(first).unwrap_or_default(), more: 0 });
        }
        first += sides;
    }
    found
}

impl What {
    /// A number for the kind, and its places.
    fn numbers(self) -> (u8, (usize, usize)) {
        match self {
            Self::Hole(a, b) => (0, (a, b)),
            Self::Curve(a) => (1, (a, 0)),
            Self::Face(a) => (2, (a, 0)),
        }
    }
}

impl StableHash for Lost {
    fn hash_into(&self, to: &mut StableHasher) {
        (self.what.numbers(), (self.length, self.at, self.more)).hash_into(to);
    }
}

impl Put for Lost {
    fn put(&self, to: &mut Vec<u8>) {
        (self.what.numbers(), (self.length, (self.at, self.more))).put(to);
    }
}

impl Plain for Lost {
    const LEAST: usize = 1;
    fn take(from: &mut Bytes) -> Option<Self> {
        let (kind, (a, b)): (u8, (usize, usize)) = Plain::take(from)?;
        let (length, (at, more)): (f64, (DVec3, usize)) = Plain::take(from)?;
        let what = match kind {
            0 => What::Hole(a, b),
            1 => What::Curve(a),
            2 => What::Face(a),
            _ => return None,
        };
        Some(Self { what, length, at, more })
    }
}
