//! Faces of a mesh that touch, cross or cover each other where they share no nodes.
//!
//! The elements of the finished mesh give the candidates, at the cost of its borders; curves and surfaces decide, wherever the
//! nodes are. Contacts of borders with faces are found in `contact_borders.rs`, those inside faces in `contact_interiors.rs`.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use glam::DVec3;

use crate::base::fault::Result;
use crate::mesh::border::inside;
use crate::mesh::border::layout::Layout;
use crate::mesh::border::nodes::Nodes;
use crate::mesh::border::touch::{Kind, Touch};
use crate::mesh::data::mesh::Mesh;
use crate::mesh::request::input::Input;
use crate::mesh::verify::contact_leaves::Leaves;
use crate::mesh::verify::contact_scan::Scan;
use crate::model::SurfaceId;
use crate::model::fault::ContactFault;
use crate::surface::{Closest, Nearest};

/// Every two surfaces of a mesh that touch, cross or cover each other without sharing nodes there, in the order of the plan; with the
/// elements of each face in boxes, where they were computed.
pub fn find(input: &Input, layout: &Layout, nodes: &Nodes, mesh: &Mesh) -> (Vec<Touch>, Vec<Leaves>) {
    let mut surfaces: Vec<SurfaceId> = layout.faces.iter().map(|f| f.surface).collect();
    surfaces.dedup();
    if surfaces.len() < 2 {
        return (Vec::new(), Vec::new());
    }
    let scan = Scan::new(input, layout, nodes, mesh);
    let mut search = ContactSearch { scan: &scan, nearest: BTreeMap::new(), touches: BTreeMap::new(), tries: BTreeMap::new() };
    search.borders();
    search.insides();
    search.covered();
    search.crossings();
    let touches = search.touches.into_values().map(|t| t.0).collect();
    (touches, scan.leaves)
}

/// E666 where faces that are to be joined cover each other: what they share would be in the mesh twice.
pub fn refuse_overlaps(input: &Input, touches: &[Touch]) -> Result<()> {
    let Some((_, imprint)) = &input.plan.imprint else { return Ok(()) };
    let Some(Touch { surfaces: (a, b), names, at, .. }) = touches.iter().find(|t| t.kind == Kind::Overlap) else { return Ok(()) };
    let origin = |place: usize| input.model.surfaces[input.plan.surfaces[place].0.index()].surface.origin();
    let (a, b, names) = (origin(*a), origin(*b), names.clone());
    Err(ContactFault::ImprintOverlap { imprint: *imprint, a, b, names, at: *at }.into())
}

/// The contacts found so far, with what the search has computed.
pub(crate) struct ContactSearch<'a> {
    pub(crate) scan: &'a Scan<'a>,
    nearest: BTreeMap<SurfaceId, Nearest>,
    /// By the places of the surfaces, with the length of the longest segment.
    pub(crate) touches: BTreeMap<(usize, usize), (Touch, f64)>,
    /// Crossings of elements that were examined, by faces.
    pub(crate) tries: BTreeMap<(usize, usize), usize>,
}

impl ContactSearch<'_> {
    /// Whether a point lies on a face.
    pub(crate) fn on(&mut self, face: usize, p: DVec3) -> bool {
        let scan = self.scan;
        let face = &scan.layout.faces[face];
        let surface = &scan.input.model.surfaces[face.surface.index()].surface;
        let nearest = self.nearest.entry(face.surface).or_insert_with(|| Nearest::new(surface));
        inside::on(nearest, &scan.input.model.patches[face.patch.index()], p, scan.input.tolerance)
    }

    /// The point of a face's surface nearest to another one.
    pub(crate) fn foot(&mut self, face: usize, p: DVec3) -> Closest {
        let id = self.scan.surface_of(face);
        let surface = &self.scan.input.model.surfaces[id.index()].surface;
        self.nearest.entry(id).or_insert_with(|| Nearest::new(surface)).at(p)
    }

    /// Adds a contact of two faces along a segment of a length, model units, with a place; 0 for a contact at a point.
    pub(crate) fn add(&mut self, a: usize, b: usize, kind: Kind, length: f64, at: DVec3) {
        let scan = self.scan;
        let name = |face: usize| scan.input.model.surfaces[scan.surface_of(face).index()].name.clone();
        let touch = Touch { kind, surfaces: (scan.place(a), scan.place(b)), names: (name(a), name(b)), length, at };
        match self.touches.entry(scan.key(a, b)) {
            Entry::Vacant(slot) => {
                slot.insert((touch, length));
            }
            Entry::Occupied(mut slot) => {
                let (old, before) = slot.get_mut();
                let total = old.length + length;
                // What covers more is said first; of the same kind the longest segment gives the place.
                if (kind, *before) < (old.kind, length) && kind <= old.kind {
                    (*old, *before) = (touch, length);
                }
                old.length = total;
            }
        }
    }
}
