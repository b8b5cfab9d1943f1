//! Keys of meshes: everything that the mesher reads, by content.
//!
//! Entities are identified by their places in the plan (its surfaces in order, their patches from the first), so that numbers given to
//! them by a model or network that grew elsewhere do not matter.

use std::collections::BTreeMap;

use crate::base::digest::{Digest, StableHash, StableHasher};
use crate::mesh::border::layout::{Face, FaceSide, Layout};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::{Elements, Method};
use crate::mesh::request::plan::{GroupRequest, Place, Plan, Refine, Rule, Target};
use crate::mesh::size::rule_lines::links_of;
use crate::model::{PatchId, SurfaceId};
use crate::network::Chain;

/// The key of the mesh that a plan makes on its layouts; `size` is the target size where no rule sets another,
/// `surfaces` the digests of the plan's surfaces.
pub fn of(input: &Input, layouts: &[Layout], size: f64, surfaces: &BTreeMap<SurfaceId, Digest>) -> Digest {
    let mut to = StableHasher::new("mesh").text(env!("CARGO_PKG_VERSION")).number(u64::from(crate::mesh::request::VERSION));
    input.tolerance.hash_into(&mut to);
    let mut places = BTreeMap::new();
    input.plan.surfaces.iter().enumerate().for_each(|(place, (surface, _))| {
        places.entry(*surface).or_insert(place);
    });
    let hasher = PlanHasher { input, layouts, surfaces, places };
    hasher.plan(size, &mut to);
    layouts.len().hash_into(&mut to);
    layouts.iter().for_each(|layout| hasher.layout(layout, &mut to));
    to.finish()
}

crate::content_of_word!(Elements, Method);
crate::content!(FaceSide { uses, pole, length });

struct PlanHasher<'a> {
    input: &'a Input<'a>,
    layouts: &'a [Layout],
    surfaces: &'a BTreeMap<SurfaceId, Digest>,
    /// Where each surface stands first in the plan.
    places: BTreeMap<SurfaceId, usize>,
}

impl PlanHasher<'_> {
    fn plan(&self, size: f64, to: &mut StableHasher) {
        let Plan {
            name,
            origin: _,
            surfaces,
            curves,
            points,
            settings,
            imprint,
            // The tracks and faces of the layouts determine it.
            glue: _,
            bodies: _,
            rules,
            refines,
            groups,
            most_elements,
        } = self.input.plan;
        (name, size, (settings, *most_elements)).hash_into(to);
        surfaces.len().hash_into(to);
        for (id, flipped) in surfaces {
            let named = &self.input.model.surfaces[id.index()];
            (self.places.get(id), *flipped, (&named.name, self.surfaces.get(id))).hash_into(to);
        }
        (curves, points, imprint.as_ref().map(|i| &i.0)).hash_into(to);
        rules.len().hash_into(to);
        rules.iter().for_each(|rule| self.rule(rule, to));
        refines.len().hash_into(to);
        for Refine { at, size, radius, origin: _ } in refines {
            (at.len(), size.0, *radius).hash_into(to);
            at.iter().for_each(|place| match place {
                Place::Point(p) => (0u8, *p).hash_into(to),
                Place::Chain(chain) => (1u8, chain).hash_into(to),
                Place::Box(b) => (2u8, b.min, b.max).hash_into(to),
            });
        }
        groups.len().hash_into(to);
        for GroupRequest { name, members, origin: _ } in groups {
            (name, members.len()).hash_into(to);
            members.iter().for_each(|member| self.target(member, to));
        }
    }

    fn rule(&self, rule: &Rule, to: &mut StableHasher) {
        let Rule { target, settings, origin: _ } = rule;
        self.target(target, to);
        settings.hash_into(to);
    }

    /// The target of a rule or group, and the part of the mesh that it is.
    fn target(&self, target: &Target, to: &mut StableHasher) {
        match target {
            Target::Chain(chain) => self.chain(chain, to),
            Target::Edge(courses) => {
                (4u8, courses.len()).hash_into(to);
                for course in courses {
                    self.layouts.iter().for_each(|layout| layout.along_course(course).hash_into(to));
                }
            }
            Target::Surface(_) | Target::Patches(_) => {
                matches!(target, Target::Surface(_)).hash_into(to);
                for face in self.layouts.iter().flat_map(|l| &l.faces) {
                    target.faces(face.patch, face.surface).hash_into(to);
                }
            }
            Target::Point(point) => (2u8, *point).hash_into(to),
        }
    }

    fn chain(&self, chain: &Chain, to: &mut StableHasher) {
        (3u8, chain, links_of(self.input, chain)).hash_into(to);
        self.layouts.iter().for_each(|layout| layout.along(self.input, chain).hash_into(to));
    }

    fn layout(&self, layout: &Layout, to: &mut StableHasher) {
        // `loose` is derived from the faces and curves that are hashed here.
        let Layout { faces, parts, pieces, edges, of_link, curves, points, creases, meets, lost, loose: _ } = layout;
        faces.len().hash_into(to);
        faces.iter().for_each(|face| self.face(face, to));
        // The faces determine which edges its tracks are; patches that are not meshed use them too, and then nodes do not slide.
        let users: Vec<usize> = edges.iter().map(|edge| self.input.model.edges[edge.index()].users.len()).collect();
        users.hash_into(to);
        (parts, pieces, (curves, points, (creases, meets, lost))).hash_into(to);
        of_link.len().hash_into(to);
        for (link, uses) in of_link {
            let network = self.input.network;
            let curve = network.links[link.index()].curve;
            (&network.curves[curve.index()].name, uses).hash_into(to);
        }
    }

    fn face(&self, face: &Face, to: &mut StableHasher) {
        // How it is made and what lies in it follow from the rest.
        let Face {
            patch,
            surface,
            flipped,
            elements,
            method,
            size,
            sides,
            near,
            free: _,
            uneven: _,
            kept: _,
            even_rows: _,
            foreseen_free: _,
            foreseen: _,
            halved: _,
            why: _,
            lines: _,
            points: _,
        } = face;
        let record = &self.input.model.patches[patch.index()];
        (self.places.get(surface), self.patch(*surface, *patch), (record.u, record.v)).hash_into(to);
        (*flipped, *elements, (*method, size.0, size.1)).hash_into(to);
        (sides, *near).hash_into(to);
    }

    /// The number of a patch on its surface.
    fn patch(&self, surface: SurfaceId, patch: PatchId) -> usize {
        let first = self.input.model.patches_of(surface).next().map_or(0, |p| p.index());
        patch.index() - first
    }
}
