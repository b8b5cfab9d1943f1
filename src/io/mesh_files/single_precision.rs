//! What rounding to single precision does to the nodes of a mesh.

use glam::DVec3;

use crate::base::job;
use crate::io::mesh_files::deck::Deck;
use crate::io::mesh_files::triangulated::triangles;

/// Share of the shortest edge by which nodes may move without a word where they are rounded.
const SHARE: f64 = 0.01;

/// Two corners of a triangle that single precision does not tell apart: the place of one, units of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coincident(pub DVec3);

impl Coincident {
    /// The place in words.
    pub(crate) fn place(self, deck: &Deck) -> String {
        format!("({}) {}", self.0.to_array().map(|x| x.to_string()).join(", "), deck.unit)
    }
}

/// The largest distance by which nodes move where their coordinates relative to `origin` are rounded, units of the file; `None` where that
/// is little beside the shortest edge.
///
/// Fails where corners of a triangle fall together.
pub(crate) fn rounding(deck: &Deck, origin: DVec3) -> Result<Option<f64>, Coincident> {
    let rounded = |p: DVec3| p.as_vec3().as_dvec3();
    let (mut moved, mut shortest) = (0.0_f64, f64::INFINITY);
    for nodes in job::looking(triangles(deck.mesh)) {
        let corners = nodes.map(|n| deck.place(n) - origin);
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
            moved = moved.max(a.distance(rounded(a)));
            shortest = shortest.min(a.distance(b));
            if a != b && rounded(a) == rounded(b) {
                return Err(Coincident(a + origin));
            }
        }
    }
    Ok((moved > SHARE * shortest).then_some(moved))
}
