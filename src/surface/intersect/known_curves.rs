//! Runs of borders of one face that lie on another one. Where the faces cross along such a run it is part of their intersection. The search
//! leaves out the cells along it: the faces may miss each other there by less than the tolerance.

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::fault::Result;
use crate::base::math;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::closest::nearest::Nearest;
use crate::surface::core::surface::Surface;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::kind::Domain;
use crate::surface::intersect::runs::runs_on;
use crate::surface::intersect::sheet::{Cell, widely_grounded};
use crate::surface::rails::side::{Side, between};
use crate::surface::trims::trim_loop::shifts;

/// Places at which a run of a border is compared with the other face.
const PROBES: [f64; 5] = [0.03, 0.27, 0.4873, 0.74, 0.97];
/// A border is followed where one of so many steps along it begins or ends on the other face: shorter runs are left to the search.
const LOOKS: usize = 32;
/// Faces cross along a border where they do so at this angle at least, radians. Below it they go on into each other.
const CROSSING: f64 = 1.0 / 256.0;
/// Steps of a border between two breaks.
const STEPS: usize = 32;
/// Steps of a border in all where it has many breaks, and steps between two of them at the least.
const MOST_STEPS: usize = 512;
const LEAST_STEPS: usize = 4;
/// Places this share of a cell beyond its sides are in it.
const SLACK: f64 = 1.0 / 64.0;

/// A curve that lies on both of two surfaces, with places in the (u, v) of each.
#[derive(Clone, Debug)]
pub(crate) struct KnownCurve {
    pub chain: Chain,
    places: Vec<[DVec2; 2]>,
    /// Whole turns by which places may be moved on each surface.
    turns: [Vec<DVec2>; 2],
}

impl KnownCurve {
    /// Runs of borders of either face that lie on the other one, where the faces cross along them.
    ///
    /// Fails as [`runs_on`] does.
    pub fn between(a: &Surface, b: &Surface, tolerance: &Tolerance) -> Result<Vec<Self>> {
        let mut found: Vec<Self> = Vec::new();
        if [a, b].iter().any(|face| face.ground() == Domain::Unbounded) {
            return Ok(found);
        }
        let borders = [near_borders(a, b, tolerance)?, near_borders(b, a, tolerance)?];
        if borders.iter().all(Vec::is_empty) {
            return Ok(found);
        }
        let grounds = [a, b].map(|face| widely_grounded(face, face.hull()));
        let nearest = [Nearest::new(&grounds[0]), Nearest::new(&grounds[1])];
        for (own, chains) in borders.into_iter().enumerate() {
            let other = 1 - own;
            let crosses = |p: DVec3| {
                let foot = nearest[other].at(p);
                foot.distance <= tolerance.point && {
                    let here = nearest[own].at(p).uv;
                    let normals = (grounds[own].normal(here.0, here.1), grounds[other].normal(foot.uv.0, foot.uv.1));
                    let angle = math::angle_between(normals.0, normals.1);
                    angle.min(std::f64::consts::PI - angle) >= CROSSING
                }
            };
            for border in chains {
                if !(0..=LOOKS).any(|k| crosses(border.point(k as f64 / LOOKS as f64))) {
                    continue;
                }
                for chain in runs_on(&border, &grounds[other], tolerance)? {
                    let is_new = || found.iter().all(|known| !known.runs_along(&chain, tolerance));
                    if PROBES.iter().all(|f| crosses(chain.point(*f))) && is_new() {
                        let places = places(&chain, |p| [0, 1].map(|n| DVec2::from(nearest[n].at(p).uv)));
                        found.push(Self { chain, places, turns: [shifts(a), shifts(b)] });
                    }
                }
            }
        }
        Ok(found)
    }

    /// A curve on two patches with places in the (u, v) of each.
    pub fn on_patches(chain: Chain, places: Vec<[DVec2; 2]>) -> Self {
        Self { chain, places, turns: [vec![DVec2::ZERO], vec![DVec2::ZERO]] }
    }

    /// Whether faces that cross in a place at an angle of this sine cross in this curve there: it is within the tolerance `point` of both, and
    /// so within twice that over the sine of where they cross. No farther than `most`.
    pub fn is_at(&self, p: DVec3, sine: f64, point: f64, most: f64) -> bool {
        let room = most.min(2.0 * point / sine);
        self.chain.bbox().touches(&Box3::of([p]), room) && self.chain.closest(p).2 <= room
    }

    fn runs_along(&self, chain: &Chain, tolerance: &Tolerance) -> bool {
        PROBES.iter().all(|f| self.chain.closest(chain.point(*f)).2 <= 2.0 * tolerance.point)
    }

    /// Whether it passes through two cells, one of each surface.
    pub fn passes(&self, x: &Cell, y: &Cell) -> bool {
        self.turns[0].iter().any(|by| {
            self.turns[1].iter().any(|and| {
                self.places.windows(2).any(|w| {
                    let own = within([w[0][0] + *by, w[1][0] + *by], x);
                    own.is_some_and(|own| {
                        within([w[0][1] + *and, w[1][1] + *and], y).is_some_and(|other| own.0.max(other.0) <= own.1.min(other.1))
                    })
                })
            })
        })
    }
}

/// The borders of a face whose boxes touch that of another one.
fn near_borders(face: &Surface, other: &Surface, tolerance: &Tolerance) -> Result<Vec<Chain>> {
    let reach = other.hull();
    let mut found = Vec::new();
    for k in 0..face.n_sides() {
        if let Side::Chain { chain, from, to } = face.side(k)
            && reach.touches(&chain.bbox(), tolerance.point)
        {
            found.push(between(&chain, from, to, tolerance)?);
        }
    }
    Ok(found)
}

/// Places of a curve in the (u, v) of both surfaces, in order: [`STEPS`] to each span between breaks, fewer where there are many.
fn places(chain: &Chain, at: impl Fn(DVec3) -> [DVec2; 2]) -> Vec<[DVec2; 2]> {
    let stops = [vec![0.0], chain_breaks(chain), vec![1.0]].concat();
    let steps = (MOST_STEPS / stops.len()).clamp(LEAST_STEPS, STEPS);
    let inner = stops.windows(2).flat_map(|w| (0..steps).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / steps as f64));
    inner.chain([1.0]).map(|f| at(chain.point(f))).collect()
}

/// The shares of a short straight way in (u, v) that lie in a cell. A way round the surface is none.
fn within([from, to]: [DVec2; 2], cell: &Cell) -> Option<(f64, f64)> {
    let step = to - from;
    if step.abs().max_element() > 0.5 {
        return None;
    }
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for (at, rate, (first, last)) in [(from.x, step.x, cell.u), (from.y, step.y, cell.v)] {
        let room = (last - first) * SLACK;
        let (first, last) = (first - room - at, last + room - at);
        if rate == 0.0 {
            if first > 0.0 || last < 0.0 {
                return None;
            }
            continue;
        }
        let (s, t) = (first / rate, last / rate);
        (low, high) = (low.max(s.min(t)), high.min(s.max(t)));
    }
    (low <= high).then_some((low, high))
}
