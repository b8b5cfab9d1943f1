//! Solids that touch themselves along an edge: more than two of their faces share it, and neighbours round it bound the same wedge.

use glam::DVec3;

use super::shells::Joins;
use super::sides::Usage;
use super::topology::Model;
use crate::base::math;
use crate::surface::Nearest;

/// Where along a segment faces are looked at, as shares of its length: they may touch each other in some places.
const PLACES: [f64; 3] = [0.5, 0.27, 0.81];

/// Radians between two faces at an edge from which on they leave it in different directions.
const APART: f64 = 1.0 / 1024.0;

/// Pairs of faces that use a segment, with the segment of each.
pub(super) struct Paired {
    /// Two uses of one segment each; of a free edge one; of an edge where that cannot be told all.
    pub usages: Vec<Vec<Usage>>,
    /// The segment of each.
    pub segments: Vec<usize>,
}

impl Paired {
    /// Whether more than two faces share a segment, and which of them are neighbours cannot be told.
    pub fn has_more_than_two(&self, segment: usize) -> bool {
        let first = self.segments.partition_point(|k| *k < segment);
        self.usages.get(first).is_some_and(|users| users.len() > 2)
    }
}

impl Model {
    /// The uses of each segment where faces bound a solid that may touch itself: of an even number of faces at an edge each is a pair with the
    /// next one round it, as a wedge of material or of what is outside lies between them. Where faces leave the edge in one direction, those that
    /// run along it are paired with those that run against it.
    pub(super) fn paired(&self, joins: &Joins, usages: &[Vec<Usage>]) -> Paired {
        let mut paired = Paired { usages: Vec::with_capacity(usages.len()), segments: Vec::with_capacity(usages.len()) };
        for (segment, users) in usages.iter().enumerate() {
            let pairs = if users.len() > 2 && users.len() % 2 == 0 { self.pairs(joins, segment, users) } else { None };
            for users in pairs.unwrap_or_else(|| vec![users.clone()]) {
                paired.usages.push(users);
                paired.segments.push(segment);
            }
        }
        paired
    }

    fn pairs(&self, joins: &Joins, segment: usize, users: &[Usage]) -> Option<Vec<Vec<Usage>>> {
        if let Some(order) = PLACES.iter().find_map(|place| self.order(joins, segment, *place, users)) {
            return Some(order.windows(2).map(|w| vec![users[w[0]], users[w[1]]]).collect());
        }
        let (along, against): (Vec<Usage>, Vec<Usage>) = users.iter().partition(|(_, against)| !against);
        let round = |n: usize| [vec![along[n], against[n]], vec![against[n], along[(n + 1) % along.len()]]];
        (along.len() == against.len()).then(|| (0..along.len()).flat_map(round).collect())
    }

    /// The order of faces round a segment at a place along it; `None` where two leave it in one direction.
    fn order(&self, joins: &Joins, segment: usize, place: f64, users: &[Usage]) -> Option<Vec<usize>> {
        let piece = &joins.pieces.segments[segment];
        let (at, tangent) = joins.parts[piece.track].track.jet(piece.s.0 + place * piece.length());
        let tangent = math::unit(tangent, 0.0)?;
        let first = math::any_normal(tangent);
        let second = tangent.cross(first);
        let into = |(surface, against): &Usage| {
            let surface = &self.surfaces[surface.index()].surface;
            let uv = Nearest::new(surface).at(at).uv;
            let along = if *against { -tangent } else { tangent };
            let d: DVec3 = surface.normal(uv.0, uv.1).cross(along);
            math::atan2(d.dot(second), d.dot(first))
        };
        let mut order: Vec<(f64, usize)> = users.iter().map(into).zip(0..).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let turn = order[0].0 + std::f64::consts::TAU;
        let apart = order.windows(2).all(|w| w[1].0 - w[0].0 > APART) && turn - order[order.len() - 1].0 > APART;
        apart.then(|| order.into_iter().map(|(_, k)| k).collect())
    }
}
