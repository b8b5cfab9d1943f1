//! Families of flat faces: ribs on plates, overlapping polygons and outlines, planes that cross in space.

use glam::{DMat2, DVec2, DVec3};

use super::outline::{area, circle, in_space, is_sound, rounded, union_and_common};
use super::scene::Scene;
use crate::support::random::Random;

/// A number of one decimal from a range.
pub fn number(random: &mut Random, from: f64, to: f64) -> f64 {
    ((from + (to - from) * random.share()) * 10.0).round() / 10.0
}

/// A whole number from a range.
fn whole(random: &mut Random, from: i32, to: i32) -> f64 {
    f64::from(from) + random.below((to - from + 1) as usize) as f64
}

/// A rib stands on a plate: over its whole width, inside, at a side, across it or beyond it.
pub fn ribs(random: &mut Random, scene: &mut Scene) {
    let grid = [1.0, 10.0, 50.0][random.below(3)];
    let [w, l] = [0; 2].map(|_| grid * whole(random, 4, 60));
    let h = [w, l, grid * whole(random, 2, 40)][random.below(3)];
    let (x, z) = ([-w / 2.0, 0.0, grid * whole(random, -20, 20)][random.below(3)], grid * whole(random, -30, 30));
    let plate = [DVec3::new(x, 0.0, z), DVec3::new(x + w, 0.0, z), DVec3::new(x + w, l, z), DVec3::new(x, l, z)];
    let share = whole(random, 1, 9) / 10.0;
    let ((mut a, mut b), (mut y, mut low, high)) = ((x, x + w), (share * l, z, z + h));
    let mut pieces = 3;
    match random.below(5) {
        0 => {}
        1 => ((a, b), pieces) = ((x + 0.25 * w, x + 0.7 * w), 2),
        2 => (y, pieces) = ([0.0, l][random.below(2)], 2),
        3 => (low, pieces) = (z - grid * whole(random, 1, 20), 4),
        _ => (a, b) = (x - grid * whole(random, 0, 5), x + w + grid * whole(random, 1, 9)),
    }
    let rib = [DVec3::new(a, y, low), DVec3::new(b, y, low), DVec3::new(b, y, high), DVec3::new(a, y, high)];
    for (name, corners) in [("plate", plate), ("rib", rib)] {
        let text = if random.below(2) == 0 {
            format!("plane({})", scene.polygon(&corners))
        } else {
            let foot = scene.line(corners[0], corners[1]);
            scene.extrude(&foot, corners[3] - corners[0])
        };
        scene.surface(name, &text);
    }
    scene.report("foot", "length(plate & rib)", b.min(x + w) - a.max(x), 1);
    let (all, made) = (w * l + (b - a) * (high - low), scene.names(&["plate", "rib"]));
    scene.pieces(&format!("imprint({made})"), Some(pieces), all);
    let size = scene.length(w.max(l) / 8.0);
    scene.say(format!("mesh joined of {made} {{ size: {size}  imprint: true }}"));
    scene.report("mesh", "joined.area", all, 2);
}

fn polygon(random: &mut Random, corners: usize, grid: f64, size: f64) -> Vec<DVec2> {
    loop {
        let mut place = || DVec2::new(random.share() - 0.5, random.share() - 0.5) * 2.0 * size;
        let all: Vec<DVec2> = (0..corners).map(|_| (place() / grid).round() * grid).collect();
        if is_sound(&all) && area(&all) > 0.1 * size * size {
            return all;
        }
    }
}

fn imprinted(scene: &mut Scene, union: f64) {
    let made = scene.names(&["a", "b"]);
    scene.pieces(&format!("imprint({made})"), None, union);
}

/// Two polygons of three to six corners, on grids on which corners and sides coincide and on fine ones.
pub fn polygons(random: &mut Random, scene: &mut Scene) {
    let (grid, size) = ([10.0, 10.0, 1.0, 0.125][random.below(4)], [40.0, 60.0, 100.0][random.below(3)]);
    let (pair, union) = loop {
        let pair = [0; 2].map(|_| {
            let corners = 3 + random.below(4);
            polygon(random, corners, grid, size)
        });
        let (union, common) = union_and_common(&pair[0], &pair[1]);
        if common > 1.0 {
            break (pair, union);
        }
    };
    for (name, corners) in [("a", &pair[0]), ("b", &pair[1])] {
        let text = scene.polygon(&in_space(corners));
        scene.surface(name, &format!("plane({text})"));
    }
    imprinted(scene, union);
}

/// Two outlines with round corners, or circles.
pub fn outlines(random: &mut Random, scene: &mut Scene) {
    let (grid, size) = ([10.0, 1.0][random.below(2)], [40.0, 60.0, 100.0][random.below(3)]);
    let outline = |random: &mut Random| loop {
        if random.below(4) == 0 {
            let center = DVec2::new(number(random, -0.5, 0.5), number(random, -0.5, 0.5)) * size;
            let radius = number(random, 0.2, 0.8) * size;
            return (vec![center], radius, circle(center, radius));
        }
        let n = 3 + random.below(3);
        let (corners, radius) = (polygon(random, n, grid, size), number(random, 1.0, 12.0));
        if let Some(fine) = rounded(&corners, radius) {
            return (corners, radius, fine);
        }
    };
    let (pair, union) = loop {
        let pair = [0; 2].map(|_| outline(random));
        let (union, common) = union_and_common(&pair[0].2, &pair[1].2);
        if common > 1.0 {
            break (pair, union);
        }
    };
    for (name, (corners, radius, _)) in ["a", "b"].into_iter().zip(&pair) {
        let text = match &corners[..] {
            [center] => scene.circle(center.extend(0.0), *radius, DVec3::Z),
            _ => scene.rounded(&in_space(corners), *radius),
        };
        scene.surface(name, &format!("plane({text})"));
    }
    imprinted(scene, union);
}

/// The stretch of a line inside a parallelogram.
fn inside(corner: DVec3, sides: [DVec3; 2], at: DVec3, way: DVec3) -> [f64; 2] {
    let [e, h] = sides;
    let shares = |d: DVec3| DMat2::from_cols_array(&[e.dot(e), e.dot(h), e.dot(h), h.dot(h)]).inverse() * DVec2::new(d.dot(e), d.dot(h));
    let (from, step) = (shares(at - corner), shares(way));
    let mut span = [f64::NEG_INFINITY, f64::INFINITY];
    for (from, step) in [(from.x, step.x), (from.y, step.y)] {
        let ends = [-from / step, (1.0 - from) / step];
        span = [span[0].max(ends[0].min(ends[1])), span[1].min(ends[0].max(ends[1]))];
    }
    span
}

/// Two parallelograms in space: they cross, or one stands on the other or on its side.
pub fn planes(random: &mut Random, scene: &mut Scene) {
    let (size, kind) = ([10, 50, 100][random.below(3)], random.below(3));
    let least = f64::from(size) * 0.3;
    let (faces, length) = loop {
        let mut vector = || DVec3::new(whole(random, -size, size), whole(random, -size, size), whole(random, -size, size));
        let [o, e, h, mut p, mut f, g] = [0; 6].map(|_| vector());
        if kind > 0 {
            let shares = [0.0, 0.1, 0.25, 0.5, 0.6, 0.8, 1.0];
            let mut share = || shares[random.below(shares.len())];
            let [a, b, c, d] = if kind == 1 { [0; 4].map(|_| share()) } else { [0.0, 0.0, 1.0, 0.0] };
            (p, f) = (o + a * e + b * h, (c - a) * e + (d - b) * h);
        }
        let (n, m) = (e.cross(h), f.cross(g));
        let way = n.cross(m);
        let open = |e: DVec3, h: DVec3| e.length().min(h.length()) > least && e.cross(h).length() > 0.4 * e.length() * h.length();
        if !open(e, h) || !open(f, g) || way.length() < 0.3 * n.length() * m.length() {
            continue;
        }
        let way = way.normalize();
        // A point of both planes.
        let at = (n.dot(o) * m.cross(way) + m.dot(p) * way.cross(n)) / n.cross(m).dot(way);
        let [a, b] = [inside(o, [e, h], at, way), inside(p, [f, g], at, way)];
        let crossing = if kind == 0 { a[1].min(b[1]) - a[0].max(b[0]) } else { f.length() };
        if crossing > 0.05 * f64::from(size) {
            break ([(o, e, h), (p, f, g)], crossing);
        }
    };
    for (name, (o, e, h)) in ["a", "b"].into_iter().zip(faces) {
        let text = scene.polygon(&[o, o + e, o + e + h, o + h]);
        scene.surface(name, &format!("plane({text})"));
    }
    scene.report("meeting", "length(a & b)", length, 1);
    imprinted(scene, faces.iter().map(|(_, e, h)| e.cross(*h).length()).sum());
    let (made, size) = (scene.names(&["a", "b"]), scene.length(f64::from(size) / 5.0));
    scene.say(format!("mesh joined of {made} {{ size: {size}  imprint: true }}"));
    scene.report("mesh", "joined.area", faces.iter().map(|(_, e, h)| e.cross(*h).length()).sum(), 2);
}
