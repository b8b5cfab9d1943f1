//! The three views of a lines plan: their grids, lines and names.

use glam::{DVec2, DVec3};

use super::color::{GREY, Rgb};
use super::drawing::{Align, Placed, dashed, stroke};
use super::lines_plan::{Family, LinesPlan, PlanLine};
use super::page::Item;

/// Lines of the grid.
const GRID: Rgb = Rgb(196, 202, 212);
/// Shares of a line where its name may stand.
const NAMED: [f64; 9] = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.95];

/// Where the views of a lines plan are on the page, pixels.
#[derive(Clone, Debug)]
pub(super) struct Views {
    /// Pixels of a model unit.
    pub pixels: f64,
    /// Size of words.
    pub size: f64,
    /// The aft end in profile and half-breadth plan.
    pub left: f64,
    /// The lowest point in the profile.
    pub base: f64,
    /// The centreline of the half-breadth plan.
    pub center: f64,
    /// The centreline of the body plan.
    pub middle: f64,
    /// How far diagonals reach below the centreline, model units.
    pub below: f64,
    /// Pixels of a model unit in the body plan, a round multiple of those of the other views.
    pub body_pixels: f64,
    /// The lowest point in the body plan.
    pub body_base: f64,
    /// Half the beam, model units.
    pub half: f64,
    pub low: DVec3,
    pub high: DVec3,
    pub bow_is_high: bool,
}

impl Views {
    fn along(&self, x: f64) -> f64 {
        self.left + self.pixels * if self.bow_is_high { x - self.low.x } else { self.high.x - x }
    }

    fn up(&self, z: f64) -> f64 {
        self.base - self.pixels * (z - self.low.z)
    }

    fn profile(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.along(p.x), self.up(p.z))
    }

    fn half_breadth(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.along(p.x), self.center - self.pixels * p.y)
    }

    fn diagonal(&self, x: f64, reach: f64) -> DVec2 {
        DVec2::new(self.along(x), self.center + self.pixels * reach)
    }

    fn body(&self, fore: bool, y: f64, z: f64) -> DVec2 {
        DVec2::new(self.middle + self.body_pixels * if fore { y } else { -y }, self.body_base - self.body_pixels * (z - self.low.z))
    }

    /// A place of the body plan of both sides: port left.
    fn across(&self, y: f64, z: f64) -> DVec2 {
        self.body(true, -y, z)
    }

    /// Both sides of the body plan that a section at x is drawn on.
    fn sides(&self, plan: &LinesPlan, x: f64) -> impl Iterator<Item = bool> {
        let ahead = if self.bow_is_high { x - plan.middle() } else { plan.middle() - x };
        let reach = f64::EPSILON * (self.high.x - self.low.x).abs() * 16.0;
        [false, true].into_iter().filter(move |fore| if *fore { ahead >= -reach } else { ahead <= reach })
    }
}

/// Width of the lines of a family in sizes of words.
pub(super) fn width(family: Family) -> f64 {
    if family == Family::Edge { 0.15 } else { 0.09 }
}

/// A dashed line of a family.
fn broken(points: &[DVec2], family: Family, size: f64) -> Vec<Item> {
    dashed(points, 0.6 * size, 0.4 * size, width(family) * size, family.color())
}

/// Straight lines where the planes of sections are seen from the side.
pub(super) fn grid(plan: &LinesPlan, views: &Views, items: &mut Vec<Item>) {
    let w = 0.05 * views.size;
    let mut line = |a: DVec2, b: DVec2| items.push(stroke(vec![a, b], w, GRID));
    let (top, right) = (views.up(views.high.z), views.left + views.pixels * (views.high.x - views.low.x));
    let (outer, inner) = (views.center - views.pixels * views.half, views.center + views.pixels * views.below);
    let (port, starboard) = (views.body(false, views.half, 0.0).x, views.body(true, views.half, 0.0).x);
    for x in plan.stations.iter().map(|x| views.along(*x)) {
        line(DVec2::new(x, top), DVec2::new(x, views.base));
        line(DVec2::new(x, outer), DVec2::new(x, inner));
    }
    for z in &plan.waterlines {
        let (y, level) = (views.up(*z), views.body(false, 0.0, *z).y);
        line(DVec2::new(views.left, y), DVec2::new(right, y));
        line(DVec2::new(port, level), DVec2::new(starboard, level));
    }
    let body_top = views.body(false, 0.0, views.high.z).y;
    for y in &plan.buttocks {
        for level in [views.center - views.pixels * y, views.center + views.pixels * y].into_iter().take(1 + usize::from(plan.both_sides)) {
            line(DVec2::new(views.left, level), DVec2::new(right, level));
        }
        for x in [false, true].map(|fore| views.body(fore, *y, 0.0).x) {
            line(DVec2::new(x, body_top), DVec2::new(x, views.body_base));
        }
    }
    line(DVec2::new(views.left, views.base), DVec2::new(right, views.base));
    line(DVec2::new(port, views.body_base), DVec2::new(starboard, views.body_base));
    let long = (1.4 * views.size, 0.5 * views.size);
    let center = [
        [DVec2::new(views.left, views.center), DVec2::new(right, views.center)],
        [DVec2::new(views.middle, body_top), DVec2::new(views.middle, views.body_base)],
    ];
    center.iter().for_each(|c| items.extend(dashed(c, long.0, long.1, 0.07 * views.size, GREY)));
}

/// The lines of the hull in the views that show them in their true shape; edges in all.
pub(super) fn lines(plan: &LinesPlan, views: &Views, items: &mut Vec<Item>) {
    for line in &plan.lines {
        let mut put = |points: Vec<DVec2>| items.push(stroke(points, width(line.family) * views.size, line.family.color()));
        let flat = |to: &dyn Fn(DVec3) -> DVec2| line.points.iter().map(|p| to(*p)).collect::<Vec<_>>();
        match line.family {
            Family::Edge => {
                put(flat(&|p| views.profile(p)));
                put(flat(&|p| views.half_breadth(p)));
                if plan.both_sides {
                    put(flat(&|p| views.across(p.y, p.z)));
                } else {
                    edge_in_body(plan, views, line).into_iter().for_each(&mut put);
                }
            }
            Family::Station if plan.both_sides => {
                let points = flat(&|p| views.across(p.y, p.z));
                if plan.is_ahead(line.at) {
                    put(points);
                } else {
                    items.extend(broken(&points, line.family, views.size));
                }
            }
            Family::Station => views.sides(plan, line.at).for_each(|fore| put(flat(&|p| views.body(fore, p.y, p.z)))),
            Family::Waterline => put(flat(&|p| views.half_breadth(p))),
            Family::Buttock if line.points.iter().any(|p| p.y < 0.0) => {
                let points = flat(&|p| views.profile(p));
                items.extend(broken(&points, line.family, views.size));
            }
            Family::Buttock => put(flat(&|p| views.profile(p))),
            Family::Diagonal(k) => put(flat(&|p| views.diagonal(p.x, plan.along_diagonal(k, p)))),
        }
    }
    for (k, d) in plan.diagonals.iter().enumerate() {
        for fore in [false, true] {
            let own = plan.lines.iter().filter(|l| l.family == Family::Diagonal(k)).flat_map(|l| &l.points);
            let ours = own.filter(|p| views.sides(plan, p.x).any(|f| f == fore));
            let Some(end) = ours.max_by(|a, b| a.y.total_cmp(&b.y)) else { continue };
            let line = [views.body(fore, 0.0, d.height), views.body(fore, end.y, end.z)];
            items.extend(dashed(&line, 0.6 * views.size, 0.4 * views.size, 0.09 * views.size, Family::Diagonal(k).color()));
        }
    }
}

/// The parts of an edge fore and aft of the middle.
fn edge_in_body(plan: &LinesPlan, views: &Views, line: &PlanLine) -> Vec<Vec<DVec2>> {
    let ahead = |p: DVec3| if plan.bow_is_high { p.x - plan.middle() } else { plan.middle() - p.x };
    let (mut out, mut run, mut side) = (Vec::new(), Vec::new(), None);
    for pair in line.points.windows(2) {
        let (a, b) = (ahead(pair[0]), ahead(pair[1]));
        let cut = (a * b < 0.0).then(|| pair[0].lerp(pair[1], a / (a - b)));
        let ways = [pair[0]].into_iter().chain(cut).chain([pair[1]]).collect::<Vec<DVec3>>();
        for part in ways.windows(2) {
            let fore = ahead(part[0]) + ahead(part[1]) >= 0.0;
            if side != Some(fore) {
                if !run.is_empty() {
                    out.push(std::mem::take(&mut run));
                }
                run.push(views.body(fore, part[0].y, part[0].z));
                side = Some(fore);
            }
            run.push(views.body(fore, part[1].y, part[1].z));
        }
    }
    if !run.is_empty() {
        out.push(run);
    }
    out
}

/// Names of the sections: at the ends of their grid lines, and in the body plan beside them.
pub(super) fn names(plan: &LinesPlan, views: &Views, placed: &mut Placed) {
    let size = views.size;
    let top = views.up(views.high.z);
    let right = views.left + views.pixels * (views.high.x - views.low.x);
    let low = views.center + views.pixels * views.below;
    for x in &plan.stations {
        let (text, at) = (plan.coordinate(*x, &plan.stations), views.along(*x));
        for y in [views.base + 1.3 * size, low + 1.3 * size] {
            placed.put(
                &[(DVec2::new(at, y), Align::Middle), (DVec2::new(at, y + size), Align::Middle)],
                0.9 * size,
                &text,
                Family::Station.color(),
            );
        }
    }
    for z in &plan.waterlines {
        let text = format!("WL {}", plan.coordinate(*z, &plan.waterlines));
        let body = views.body(false, views.half, *z);
        for at in [DVec2::new(views.left, views.up(*z)), body] {
            placed.put(&[(at + DVec2::new(-0.5, 0.3) * size, Align::Right)], 0.9 * size, &text, Family::Waterline.color());
        }
    }
    for y in &plan.buttocks {
        let text = plan.coordinate(*y, &plan.buttocks);
        let at = DVec2::new(right + 0.5 * size, views.center - views.pixels * y + 0.3 * size);
        placed.put(&[(at, Align::Left)], 0.9 * size, &format!("B {text}"), Family::Buttock.color());
        for fore in [false, true] {
            let at = DVec2::new(views.body(fore, *y, 0.0).x, views.body_base + 1.3 * size);
            placed.put(&[(at, Align::Middle)], 0.9 * size, &text, Family::Buttock.color());
        }
    }
    for (k, _) in plan.diagonals.iter().enumerate() {
        let lines = plan.lines.iter().filter(|l| l.family == Family::Diagonal(k));
        let Some(far) = lines.flat_map(|l| &l.points).max_by(|a, b| a.y.total_cmp(&b.y)) else { continue };
        let at = views.diagonal(far.x, plan.along_diagonal(k, *far));
        let places = [-0.4, 1.1].map(|d| (at + DVec2::new(0.0, d * size), Align::Middle));
        placed.put(&places, 0.9 * size, &format!("D{}", k + 1), Family::Diagonal(k).color());
    }
    let [profile, breadths, body] = if plan.both_sides {
        ["profile, starboard dashed", "waterlines, port above", "body plan, port left, aft dashed"]
    } else {
        ["profile", "half-breadth plan", "body plan"]
    };
    let titles = [
        (profile, DVec2::new(views.left, top - 0.8 * size)),
        (breadths, DVec2::new(views.left, views.center - views.pixels * views.half - 0.8 * size)),
        (body, DVec2::new(views.body(false, views.half, 0.0).x, views.body(false, 0.0, views.high.z).y - 3.4 * size)),
    ];
    for (text, at) in titles {
        placed.put(&[(at, Align::Left), (at - DVec2::new(0.0, 1.2 * size), Align::Left)], size, text, GREY);
    }
    sections(plan, views, placed);
}

/// Lengths of a line from its start to each of its points.
fn from_start(points: &[DVec3]) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = points.windows(2).map(|w| w[0].distance(w[1]));
    std::iter::once(0.0)
        .chain(steps.map(|step| {
            sum += step;
            sum
        }))
        .collect()
}

/// The point at a share of the length of a line.
fn at_share(points: &[DVec3], lengths: &[f64], share: f64) -> DVec3 {
    let last = points.len() - 1;
    let wanted = share * lengths[last];
    let k = lengths.partition_point(|length| *length < wanted).clamp(1, last.max(1)).min(last);
    let before = k.saturating_sub(1);
    let step = lengths[k] - lengths[before];
    points[before].lerp(points[k], if step > 0.0 { ((wanted - lengths[before]) / step).clamp(0.0, 1.0) } else { 0.0 })
}

/// Names of sections beside them in the body plan.
fn sections(plan: &LinesPlan, views: &Views, placed: &mut Placed) {
    let mut named: Vec<(f64, bool)> = Vec::new();
    for line in plan.lines.iter().filter(|l| l.family == Family::Station) {
        let sides: Vec<bool> = if plan.both_sides { vec![false, true] } else { views.sides(plan, line.at).collect() };
        for fore in sides {
            if named.contains(&(line.at, fore)) {
                continue;
            }
            let last = line.points.len() - 1;
            let lengths = from_start(&line.points);
            let upward = line.points[0].z <= line.points[last].z;
            let place = |share: &f64| {
                let p = at_share(&line.points, &lengths, if upward { *share } else { 1.0 - share });
                let p = if plan.both_sides && fore { DVec3::new(p.x, -p.y, p.z) } else { p };
                let (way, align) = if fore { (-0.3, Align::Right) } else { (0.3, Align::Left) };
                // A line over both sides is named on either.
                (p.y >= 0.0).then(|| (views.body(fore, p.y, p.z) + DVec2::new(way * views.size, 0.3 * views.size), align))
            };
            let other_end = NAMED.map(|share| 1.0 - share);
            let shares = NAMED.iter().chain(if plan.both_sides { other_end.as_slice() } else { &[] });
            let places: Vec<(DVec2, Align)> = shares.filter_map(place).collect();
            if placed.put(&places, 0.8 * views.size, &plan.coordinate(line.at, &plan.stations), Family::Station.color()) {
                named.push((line.at, fore));
            }
        }
    }
}
