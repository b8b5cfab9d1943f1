//! How the borders of a trimmed surface run through the triangles of (u, v) over which it is analytic.
//!
//! A border is followed from triangle to triangle over their sides. In each triangle the kept part is bounded by the parts of borders
//! in it and, from where one leaves to where the next one enters, counter-clockwise, by its own sides: all as cones from its middle,
//! whose signed areas add up to the kept part whatever rounding does to the places of crossings.

use std::collections::{BTreeMap, VecDeque};

use glam::DVec2;

use super::cut_border::Border;
use crate::base::job;
use crate::base::tolerance::{NUDGE, RELATIVE_AREA};
use crate::surface::Surface;

/// A triangle: its middle, and two places whose join is a part of its sides; or one of the surface's own triangles.
pub(super) type Straight = [DVec2; 3];

/// A part of a border in one triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// The middle of the triangle.
    pub apex: DVec2,
    /// Which border.
    pub border: usize,
    /// From where to where, shares of the border.
    pub t: (f64, f64),
}

/// A place on the sides of a triangle: which side, and which share of it.
type SidePlace = (usize, f64);

/// A way of a border through a triangle, from side to side.
#[derive(Clone, Debug)]
struct Crossing {
    from: SidePlace,
    to: SidePlace,
    parts: Vec<(usize, (f64, f64))>,
}

/// The kept part of a surface in cones.
pub(super) struct Cut<'a> {
    /// The borders.
    pub border: Border<'a>,
    /// Whole triangles, and cones over parts of sides, those that turn clockwise counting negative.
    pub straight: Vec<Straight>,
    /// Cones over parts of borders.
    pub arcs: Vec<Arc>,
}

/// Triangles, counter-clockwise, and which lie beside them.
struct Tiles {
    corners: Vec<[DVec2; 3]>,
    beside: Vec<[Option<(usize, usize)>; 3]>,
}

impl Tiles {
    fn new(triangles: Vec<[DVec2; 3]>) -> Self {
        let turned = |[a, b, c]: [DVec2; 3]| if (b - a).perp_dot(c - a) < 0.0 { [b, a, c] } else { [a, b, c] };
        let corners: Vec<[DVec2; 3]> = triangles.into_iter().map(turned).collect();
        let key = |p: DVec2| [p.x.to_bits(), p.y.to_bits()];
        let mut sides = BTreeMap::new();
        for (n, t) in corners.iter().enumerate() {
            (0..3).for_each(|k| {
                sides.insert((key(t[k]), key(t[(k + 1) % 3])), (n, k));
            });
        }
        let other = |t: &[DVec2; 3], k: usize| sides.get(&(key(t[(k + 1) % 3]), key(t[k]))).copied();
        let beside = corners.iter().map(|t| [0, 1, 2].map(|k| other(t, k))).collect();
        Self { corners, beside }
    }

    fn middle(&self, n: usize) -> DVec2 {
        let [a, b, c] = self.corners[n];
        (a + b + c) / 3.0
    }

    /// How far a place is inside of each side, as a share of the height over it.
    fn weights(&self, n: usize, p: DVec2) -> [f64; 3] {
        let t = &self.corners[n];
        let area = (t[1] - t[0]).perp_dot(t[2] - t[0]);
        [0, 1, 2].map(|k| (t[(k + 1) % 3] - t[k]).perp_dot(p - t[k]) / area)
    }

    /// The side over which a place is out of a triangle, where another one is beyond.
    fn out(&self, n: usize, p: DVec2) -> Option<usize> {
        let w = self.weights(n, p);
        let side = (0..3).filter(|k| self.beside[n][*k].is_some()).min_by(|a, b| w[*a].total_cmp(&w[*b]))?;
        (w[side] < -NUDGE * NUDGE).then_some(side)
    }

    fn holding(&self, p: DVec2) -> Option<usize> {
        let least = |n: &usize| self.weights(*n, p).into_iter().fold(f64::INFINITY, f64::min);
        (0..self.corners.len()).max_by(|a, b| least(a).total_cmp(&least(b)))
    }

    fn share(&self, n: usize, side: usize, p: DVec2) -> f64 {
        let t = &self.corners[n];
        let way = t[(side + 1) % 3] - t[side];
        ((p - t[side]).dot(way) / way.length_squared()).clamp(0.0, 1.0)
    }

    fn place(&self, n: usize, (side, share): SidePlace) -> DVec2 {
        let t = &self.corners[n];
        t[side].lerp(t[(side + 1) % 3], share)
    }
}

impl<'a> Cut<'a> {
    /// The kept part of a trimmed surface; `None` where a border could not be followed.
    pub fn new(surface: &'a Surface) -> Option<Self> {
        let tiles = Tiles::new(surface.triangles());
        let border = Border::new(surface);
        let mut ways = Ways::default();
        for steps in border.loops() {
            follow(&tiles, &border, &steps, &mut ways)?;
        }
        let mut cut = Self { border, straight: Vec::new(), arcs: Vec::new() };
        let mut reached: VecDeque<usize> = VecDeque::new();
        for (n, crossings) in &ways.crossings {
            let apex = tiles.middle(*n);
            for from in crossings.iter().flat_map(|way| &way.parts) {
                cut.arcs.push(Arc { apex, border: from.0, t: from.1 });
            }
            for (from, to) in kept_sides(crossings)? {
                cut.along_sides(&tiles, *n, (from, to), &mut reached);
            }
        }
        for (n, parts) in &ways.closed {
            let apex = tiles.middle(*n);
            cut.arcs.extend(parts.iter().map(|(border, t)| Arc { apex, border: *border, t: *t }));
        }
        let mut kept = vec![false; tiles.corners.len()];
        while let Some(n) = reached.pop_front() {
            if std::mem::replace(&mut kept[n], true) || ways.crossings.contains_key(&n) {
                continue;
            }
            cut.straight.push(tiles.corners[n]);
            reached.extend(tiles.beside[n].iter().flatten().map(|other| other.0));
        }
        cut.is_whole().then_some(cut)
    }

    /// Cones over the sides of a triangle from one place to another, counter-clockwise; triangles beyond whole sides are kept.
    fn along_sides(&mut self, tiles: &Tiles, n: usize, (from, to): (SidePlace, SidePlace), reached: &mut VecDeque<usize>) {
        let (mut at, mut left) = (from, 4);
        while left > 0 {
            left -= 1;
            let last = at.0 == to.0 && at.1 <= to.1;
            let end = if last { to } else { (at.0, 1.0) };
            if end.1 > at.1 {
                self.straight.push([tiles.middle(n), tiles.place(n, at), tiles.place(n, end)]);
            }
            if at.1 == 0.0 && end.1 == 1.0 {
                reached.extend(tiles.beside[n][at.0].map(|other| other.0));
            }
            if last {
                break;
            }
            at = ((at.0 + 1) % 3, 0.0);
        }
    }

    /// Whether the cones have the area that the borders enclose.
    fn is_whole(&self) -> bool {
        let (mut cones, mut enclosed, mut size) = (0.0, 0.0, 0.0);
        for [a, b, c] in &self.straight {
            cones += 0.5 * (*b - *a).perp_dot(*c - *a);
        }
        for arc in &self.arcs {
            let whole = self.border.moment(arc.border, arc.t, DVec2::ZERO);
            cones += self.border.moment(arc.border, arc.t, arc.apex);
            enclosed += whole;
            size += whole.abs();
        }
        (cones - enclosed).abs() <= RELATIVE_AREA * size
    }
}

/// What was found of borders in triangles.
#[derive(Default)]
struct Ways {
    crossings: BTreeMap<usize, Vec<Crossing>>,
    /// Loops that stay in one triangle, with the triangle.
    closed: Vec<(usize, BorderParts)>,
}

/// Parts of borders, each with its ends.
type BorderParts = Vec<(usize, (f64, f64))>;

/// From where a border leaves a triangle to where the next one enters it, counter-clockwise; `None` where two go to one.
fn kept_sides(crossings: &[Crossing]) -> Option<Vec<(SidePlace, SidePlace)>> {
    let before = |a: &SidePlace, b: &SidePlace| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
    let mut entries: Vec<SidePlace> = crossings.iter().map(|way| way.from).collect();
    entries.sort_by(before);
    let mut used = vec![false; entries.len()];
    let mut found = Vec::with_capacity(entries.len());
    for way in crossings {
        let k = entries.iter().position(|entry| before(entry, &way.to).is_ge()).unwrap_or(0);
        if std::mem::replace(&mut used[k], true) {
            return None;
        }
        found.push((way.to, entries[k]));
    }
    Some(found)
}

/// Halvings until a crossing is settled.
const HALVINGS: usize = 50;
/// Places of a step at which it is looked whether it is still in a triangle.
const MAX_SAMPLES: usize = 4;

/// Follows a loop, steps of borders between places where they are less than smooth, through the triangles.
fn follow(tiles: &Tiles, border: &Border, steps: &[(usize, (f64, f64))], ways: &mut Ways) -> Option<()> {
    let start = steps.first()?;
    let mut at = tiles.holding(border.at(start.0, start.1.0))?;
    let mut parts: Vec<(usize, (f64, f64))> = Vec::new();
    // Where the first triangle was left: triangle, step, share. What is before it is met again at the end.
    let mut first: Option<(usize, usize)> = None;
    let mut entry: SidePlace = (0, 0.0);
    let mut crossings = 0;
    for (round, k) in (0..2 * steps.len()).map(|n| (n / steps.len(), n % steps.len())) {
        if round == 1 && first.is_none() {
            ways.closed.push((at, parts));
            return Some(());
        }
        let (which, (mut t, end)) = steps[k];
        while t < end {
            job::poll();
            let Some((there, side)) = leaves(tiles, border, at, which, (t, end)) else {
                parts.push((which, (t, end)));
                break;
            };
            crossings += 1;
            if crossings > MOST * tiles.corners.len() {
                return None;
            }
            if there > t {
                parts.push((which, (t, there)));
            }
            let share = tiles.share(at, side, border.at(which, there));
            let (next, back) = tiles.beside[at][side]?;
            let done = first == Some((at, k)) && round == 1;
            if first.is_some() {
                ways.crossings.entry(at).or_default().push(Crossing { from: entry, to: (side, share), parts: std::mem::take(&mut parts) });
            } else if !parts.is_empty() {
                first = Some((at, k));
                parts.clear();
            }
            if done {
                return Some(());
            }
            (at, entry, t) = (next, (back, 1.0 - share), there);
        }
    }
    None
}

/// Crossings a triangle, on the average, before following is given up.
const MOST: usize = 64;

/// Where a border leaves a triangle, and over which side; `None` where it stays.
fn leaves(tiles: &Tiles, border: &Border, n: usize, which: usize, (t, end): (f64, f64)) -> Option<(f64, usize)> {
    let mut inside = t;
    for k in 1..=MAX_SAMPLES {
        let there = if k == MAX_SAMPLES { end } else { t + (end - t) * k as f64 / MAX_SAMPLES as f64 };
        if tiles.out(n, border.at(which, there)).is_none() {
            inside = there;
            continue;
        }
        let mut outside = there;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if middle <= inside || middle >= outside {
                break;
            }
            if tiles.out(n, border.at(which, middle)).is_none() { inside = middle } else { outside = middle }
        }
        return tiles.out(n, border.at(which, outside)).map(|side| (inside, side));
    }
    None
}
