//! Places with a wanted edge length: it holds up to a radius, and grows from there with the distance.
//!
//! The length at a point is the least over all sources of size + slope × (distance − radius): a function that no growth
//! exceeds by construction (it is Lipschitz with the slope), whatever the order of the sources.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::base::work;
use crate::network::Chain;

/// What a source is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// A point.
    Point(DVec3),
    /// A straight piece of a curve.
    Segment(DVec3, DVec3),
    /// A box along the axes.
    Box(Box3),
}

impl Body {
    fn bounds(&self) -> Box3 {
        match self {
            Self::Point(p) => Box3::of([*p]),
            Self::Segment(a, b) => Box3::of([*a, *b]),
            Self::Box(b) => *b,
        }
    }

    fn distance(&self, p: DVec3) -> f64 {
        match self {
            Self::Point(q) => p.distance(*q),
            Self::Segment(a, b) => distance_to_segment(p, *a, *b),
            Self::Box(b) => outside(b, p),
        }
    }
}

/// Distance of a point from a box, 0 inside.
fn outside(b: &Box3, p: DVec3) -> f64 {
    (b.min - p).max(p - b.max).max(DVec3::ZERO).length()
}

/// A place with its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Where.
    pub body: Body,
    /// How far around the size holds, model units.
    pub radius: f64,
    /// The size, model units.
    pub size: f64,
    /// How many times faster than others lengths grow from it, at least 1.
    pub steep: f64,
    /// What it stands for.
    pub tag: u32,
}

/// [`Source::steep`] of what is too short to be worth filling its surroundings slowly: with the usual growth of 1.3, twice
/// as long from one step to the next, which leaves angles of 25° and takes a dozen triangles for each factor of ten.
pub const STEEP: f64 = 3.0;

impl Source {
    /// Whether it wants less than `most` anywhere in a box.
    pub fn reaches(&self, place: &Box3, slope: f64, most: f64) -> bool {
        let own = self.body.bounds();
        let gap = (own.min - place.max).max(place.min - own.max).max(DVec3::ZERO).length();
        self.size + slope * self.steep * (gap - self.radius).max(0.0) < most
    }

    fn at(&self, p: DVec3, slope: f64) -> f64 {
        self.size + slope * self.steep * (self.body.distance(p) - self.radius).max(0.0)
    }
}

/// A node of the tree: the items from the first to before the second, or two nodes: the next one and `right`.
#[derive(Clone, Copy, Debug)]
struct TreeNode {
    /// Box of all bodies, grown by their radii.
    bounds: Box3,
    /// The least size.
    least: f64,
    items: (u32, u32),
    right: u32,
}

/// Which source is the least at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Least {
    /// The length there, model units.
    pub size: f64,
    /// The source's place in the list.
    pub item: u32,
}

/// Sources in a tree of boxes.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    items: Vec<Source>,
    nodes: Vec<TreeNode>,
    slope: f64,
    steepest: f64,
    least: f64,
}

/// Items of a leaf.
const LEAF_ITEMS: usize = 4;

impl Sources {
    /// A tree over sources; lengths grow by `slope` a unit of distance.
    pub fn new(mut items: Vec<Source>, slope: f64) -> Self {
        let mut nodes = Vec::with_capacity(items.len());
        let least = items.iter().map(|s| s.size).fold(f64::INFINITY, f64::min);
        let steepest = slope * items.iter().map(|s| s.steep).fold(1.0, f64::max);
        if !items.is_empty() {
            split(&mut items, 0, &mut nodes);
        }
        Self { items, nodes, slope, steepest, least }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// The sources.
    pub fn items(&self) -> &[Source] {
        &self.items
    }

    /// Growth of lengths over distance.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// The fastest growth from any of them.
    pub fn steepest(&self) -> f64 {
        self.steepest
    }

    /// The least size of all.
    pub fn least(&self) -> f64 {
        self.least
    }

    /// The length at a point, `most` where no source wants less.
    pub fn at(&self, p: DVec3, most: f64) -> f64 {
        self.who(p, most).map_or(most, |found| found.size)
    }

    /// The source that wants the least length at a point, where that is below `most`.
    pub fn who(&self, p: DVec3, most: f64) -> Option<Least> {
        self.search(p, most, |source| source.at(p, self.slope))
    }

    /// The least size of the sources that a point is within the radius of.
    pub fn plateau(&self, p: DVec3, most: f64) -> f64 {
        let inside = |source: &Source| if source.body.distance(p) <= source.radius { source.size } else { f64::INFINITY };
        self.search(p, most, inside).map_or(most, |found| found.size)
    }

    /// Whether the size of a source holds all the way between two points along a curve of this length: what it stands for is convex, and
    /// the curve is no further from the chord than the ellipse of that length about its ends.
    pub fn holds(&self, item: u32, (a, b): (DVec3, DVec3), length: f64) -> bool {
        let source = &self.items[item as usize];
        let chord = a.distance(b);
        let is_straight = length <= chord * (1.0 + WHOLE_NUMBER);
        let aside = if is_straight { 0.0 } else { 0.5 * (length * length - chord * chord).sqrt() };
        source.size == self.least && [a, b].iter().all(|p| source.body.distance(*p) + aside <= source.radius)
    }

    fn search(&self, p: DVec3, most: f64, value: impl Fn(&Source) -> f64) -> Option<Least> {
        if self.nodes.is_empty() {
            return None;
        }
        work::spend(1);
        let bound = |node: u32| {
            let node = &self.nodes[node as usize];
            node.least + self.slope * outside(&node.bounds, p)
        };
        let (mut best, mut found) = (most, None);
        let mut stack = [(0_u32, 0.0_f64); STACK_DEPTH];
        stack[0] = (0, bound(0));
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let (k, least) = stack[open];
            if least >= best {
                continue;
            }
            let node = &self.nodes[k as usize];
            if node.right == 0 {
                for i in node.items.0..node.items.1 {
                    let size = value(&self.items[i as usize]);
                    if size < best {
                        (best, found) = (size, Some(Least { size, item: i }));
                    }
                }
                continue;
            }
            let pair = [(k + 1, bound(k + 1)), (node.right, bound(node.right))];
            let (near, far) = if pair[0].1 <= pair[1].1 { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
            stack[open] = far;
            stack[open + 1] = near;
            open += 2;
        }
        found
    }
}

/// Deeper than the halvings of any list.
const STACK_DEPTH: usize = 72;

/// Halves a list across the longest side of the box of its middles, down to leaves.
fn split(items: &mut [Source], first: u32, nodes: &mut Vec<TreeNode>) {
    let grown = |s: &Source| {
        let b = s.body.bounds();
        Box3 { min: b.min - DVec3::splat(s.radius), max: b.max + DVec3::splat(s.radius) }
    };
    let bounds = items.iter().fold(Box3::EMPTY, |all, s| all.union(grown(s)));
    let least = items.iter().map(|s| s.size).fold(f64::INFINITY, f64::min);
    let here = nodes.len();
    nodes.push(TreeNode { bounds, least, items: (first, first + items.len() as u32), right: 0 });
    if items.len() <= LEAF_ITEMS {
        return;
    }
    let middles = Box3::of(items.iter().map(|s| s.body.bounds().center()));
    let extent = (middles.max - middles.min).to_array();
    let axis = (0..3).fold(0, |best, k| if extent[k] > extent[best] { k } else { best });
    let key = |s: &Source| s.body.bounds().center()[axis];
    // What lies in one place is ordered by what it is, so that the order of writing does not matter.
    items.sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.size.total_cmp(&b.size)).then(a.tag.cmp(&b.tag)));
    let half = items.len() / 2;
    let (left, right) = items.split_at_mut(half);
    split(left, first, nodes);
    nodes[here].right = nodes.len() as u32;
    split(right, first + half as u32, nodes);
}

/// Halvings of a curve's fraction.
const MAX_HALVINGS: u32 = 40;

/// A chain as straight pieces that it is nowhere farther from than `off`, by the bound of its second derivative.
pub fn pieces(chain: &Chain, off: f64) -> Vec<(DVec3, DVec3)> {
    let mut stops = vec![0.0];
    stops.extend(chain.joints().iter().copied().filter(|f| *f > 0.0 && *f < 1.0));
    stops.push(1.0);
    let mut all = Vec::new();
    for w in stops.windows(2) {
        let mut open = vec![(w[0], w[1], MAX_HALVINGS)];
        while let Some((a, b, left)) = open.pop() {
            let width = b - a;
            let fine = || {
                let enclosure = chain.enclosure(a, b);
                // Half the length is the most that a curve without known derivatives strays.
                let bend = width * width / 8.0 * enclosure.d2.reach() + 0.25 * width * enclosure.jumps.length();
                bend.min(0.5 * width * chain.length()) <= off
            };
            if left == 0 || fine() {
                all.push((chain.point(a), chain.point(b)));
            } else {
                let middle = 0.5 * (a + b);
                open.push((middle, b, left - 1));
                open.push((a, middle, left - 1));
            }
        }
    }
    all
}

/// Distance of a point from a straight segment.
pub fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    let t = if square > 0.0 { ((p - a).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + along * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[test]
    fn the_least_is_that_of_comparing_all_in_any_order() {
        let mut state = 7;
        let place = |state: &mut u64| DVec3::new(random(state), random(state), random(state)) * 10.0;
        let mut items = Vec::new();
        for k in 0..300 {
            let (a, b) = (place(&mut state), place(&mut state));
            let body = match k % 3 {
                0 => Body::Point(a),
                1 => Body::Segment(a, a + 0.1 * (b - a)),
                _ => Body::Box(Box3::of([a, a + 0.1 * (b - a)])),
            };
            let (radius, size) = (random(&mut state), 0.1 + random(&mut state));
            items.push(Source { body, radius, size, steep: if k % 5 == 0 { STEEP } else { 1.0 }, tag: k });
        }
        let tree = Sources::new(items.clone(), 0.3);
        items.reverse();
        let turned = Sources::new(items.clone(), 0.3);
        for _ in 0..200 {
            let p = place(&mut state) * 2.0 - DVec3::splat(5.0);
            let all = items.iter().map(|s| s.at(p, 0.3)).fold(0.9, f64::min);
            assert_eq!(tree.at(p, 0.9), all);
            assert_eq!(turned.at(p, 0.9), all);
            assert_eq!(tree.who(p, 0.9), turned.who(p, 0.9));
            let flat = items.iter().filter(|s| s.body.distance(p) <= s.radius).map(|s| s.size).fold(0.9, f64::min);
            assert_eq!(tree.plateau(p, 0.9), flat);
        }
    }
}
