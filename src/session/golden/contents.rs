//! The things that a group, a rule of a mesh or an output is of: how many of each kind, and where they are.

use glam::DVec3;

use super::details::{Pairs, of_box, of_mass};
use super::values::Value;
use crate::base::bbox::Box3;
use crate::lang::eval::context::Cx;
use crate::lang::eval::scene::Scene;
use crate::lang::values::value::Value as Thing;
use crate::model::{Moments, measure};
use crate::network::Chain;
use crate::surface::{Domain, Surface};

/// Things by kind, and where they are: each counts as much as any other.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    points: u64,
    curves: u64,
    surfaces: u64,
    meshes: u64,
    bounds: Option<Box3>,
    parts: Vec<Moments>,
}

impl Contents {
    /// Of these things; what has no place is left out.
    pub fn of<'v>(cx: &mut Cx, things: impl IntoIterator<Item = &'v Thing>) -> Self {
        let mut contents = Self::default();
        things.into_iter().for_each(|thing| contents.add(cx, thing));
        contents
    }

    /// In words.
    pub fn pairs(&self, unit: &str) -> Pairs {
        let counts = [("points", self.points), ("curves", self.curves), ("surfaces", self.surfaces), ("meshes", self.meshes)];
        let mut pairs: Pairs = counts.into_iter().filter(|c| c.1 > 0).map(|(word, n)| (word, Value::Count(n))).collect();
        pairs.extend(self.bounds.and_then(|bounds| of_box(bounds, unit)));
        pairs.extend(of_mass(&Moments::total(self.parts.iter().map(Moments::of_mass_one)), unit));
        pairs
    }

    /// Adds the corners of a box.
    pub fn add_box(&mut self, corners: Box3) {
        [corners.min, corners.max].into_iter().for_each(|p| self.point(p));
    }

    fn put(&mut self, moments: Moments, bounds: Box3) {
        self.bounds = Some(self.bounds.unwrap_or(Box3::EMPTY).union(bounds));
        self.parts.push(moments);
    }

    fn point(&mut self, p: DVec3) {
        self.points += 1;
        self.put(Moments::of_points(std::iter::once(p)), Box3::of([p]));
    }

    fn chain(&mut self, chain: &Chain) {
        self.curves += 1;
        self.put(Moments::of_chain(chain), chain.bbox());
    }

    fn surface(&mut self, surface: &Surface) {
        self.surfaces += 1;
        if surface.domain() != Domain::Unbounded {
            self.put(Moments::of_surface(surface), measure::bounds(std::slice::from_ref(surface)));
        }
    }

    fn spots(&mut self, points: Vec<DVec3>) {
        self.put(Moments::of_points(points.iter().copied()), Box3::of(points));
    }

    fn add(&mut self, cx: &mut Cx, thing: &Thing) {
        match thing {
            Thing::Vector(p, _) | Thing::Node(p) => self.point(*p),
            Thing::Curve(chain) => self.chain(chain),
            Thing::Surface(surface) => self.surface(surface),
            Thing::Shell(shell) => shell.surfaces.iter().for_each(|surface| self.surface(surface)),
            Thing::Mesh(mesh) => {
                self.meshes += 1;
                if let Ok(mesh) = cx.mesh(mesh) {
                    self.spots(mesh.nodes.clone());
                }
            }
            Thing::Link(module, link) => {
                if let Ok(network) = cx.network(*module) {
                    self.chain(&network.link_chain(*link));
                }
            }
            Thing::Vertex(home, vertex) => {
                if let Ok(model) = cx.model(home) {
                    self.point(model.vertices[vertex.index()].point);
                }
            }
            Thing::Patch(home, patch) => {
                self.surfaces += 1;
                if let Ok(model) = cx.model(home) {
                    let patch = &model.patches[patch.index()];
                    let surface = &model.surfaces[patch.surface.index()].surface;
                    let (u, v) = (patch.u, patch.v);
                    let places = [(u.0, v.0), (u.1, v.0), (u.1, v.1), (u.0, v.1), (0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1))];
                    self.spots(places.map(|(u, v)| surface.point(u, v)).to_vec());
                }
            }
            Thing::Edge(home, edge) => {
                let (Ok(model), Ok(network), Ok(tolerance)) = (cx.model(home), cx.network_of(home), cx.tolerance()) else { return };
                let scene = Scene { model, network };
                match scene.shared_chain(edge, &tolerance) {
                    Ok(Some(chain)) => self.chain(&chain),
                    _ => {
                        self.curves += 1;
                        if let Some(track) = scene.model.shared_track(edge, &scene.network) {
                            let places = [0.0, 0.5, 1.0].map(|f| track.point(f * track.length()));
                            self.spots(places.to_vec());
                        }
                    }
                }
            }
            Thing::List(items) => items.iter().for_each(|item| self.add(cx, item)),
            _ => {}
        }
    }
}
