//! Families of curved faces: tubes on tubes, slices, webs, trays, holes in nets, flat tubes.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::flat::number;
use super::outline::{area, is_sound};
use super::scene::Scene;
use crate::support::random::Random;

/// Steps of integrals round a curve.
const STEPS: usize = 4096;

/// An integral over one period.
fn round(f: impl Fn(f64) -> f64) -> f64 {
    (0..STEPS).map(|k| f(TAU * k as f64 / STEPS as f64)).sum::<f64>() * TAU / STEPS as f64
}

/// An integral by Simpson's rule.
pub fn along(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let step = (to - from) / STEPS as f64;
    let part = |k: usize| f(from + (k as f64 + 0.5) * step) * 4.0 + f(from + k as f64 * step) + f(from + (k + 1) as f64 * step);
    (0..STEPS).map(part).sum::<f64>() * step / 6.0
}

/// The rate of a function.
fn rate(f: impl Fn(f64) -> DVec3, at: f64) -> DVec3 {
    const H: f64 = 1e-3;
    (8.0 * (f(at + H) - f(at - H)) - (f(at + 2.0 * H) - f(at - 2.0 * H))) / (12.0 * H)
}

fn direction(random: &mut Random, least: f64) -> DVec3 {
    loop {
        let d = DVec3::new(number(random, -1.0, 1.0), number(random, -1.0, 1.0), number(random, -1.0, 1.0));
        if d.length() > least {
            return d;
        }
    }
}

/// A tube ends inside a larger one, across its axis or obliquely, on it or beside it.
pub fn tubes(random: &mut Random, scene: &mut Scene) {
    let (big, small, by, at, length) = loop {
        let big = number(random, 10.0, 60.0);
        let small = number(random, 0.1 * big, 0.8 * big);
        let mut way = direction(random, 0.3);
        match random.below(3) {
            0 => way = DVec3::X,
            1 => way.z = 0.0,
            _ => way.z *= 0.7,
        }
        if way.truncate().length() < 0.5 {
            continue;
        }
        let by = (way.normalize() * number(random, 1.3 * big, 3.0 * big) * 10.0).round() / 10.0;
        let aside = [0.0, number(random, -big, big)][random.below(2)];
        let at = (DVec3::new(-by.y, by.x, 0.0).normalize() * aside * 10.0).round() / 10.0;
        let (way, length) = (by.normalize(), by.length());
        let (low, high) = (small * way.z.abs(), length * way.truncate().length() - small * way.z.abs());
        if low.hypot(at.length() + small) < 0.95 * big && high > 1.05 * big {
            break (big, small, by, at, length);
        }
    };
    let (way, height) = (by.normalize(), (by.z.abs() + small + 10.0).ceil());
    let (first, second) = way.any_orthonormal_pair();
    let out = |t: f64| {
        let p = at + small * (t.cos() * first + t.sin() * second);
        let (a, b, c) = (way.truncate().length_squared(), p.truncate().dot(way.truncate()), p.truncate().length_squared() - big * big);
        let along = (-b + (b * b - a * c).sqrt()) / a;
        (along, p + along * way)
    };
    let meeting = |t: f64| out(t).1;
    let outside = round(|t| small * (length - out(t).0));
    // The area under the curve on the unrolled tube; angles from the way of the small one.
    let angle = |t: f64| by.truncate().angle_to(meeting(t).truncate());
    let hole = round(|t| big * angle(t) * rate(meeting, t).z).abs();
    let (rim, end) = (scene.circle(DVec3::Z * -height, big, DVec3::Z), scene.circle(at, small, by));
    let texts = [scene.extrude(&rim, DVec3::Z * 2.0 * height), scene.extrude(&end, by)];
    scene.surface("big", &texts[0]);
    scene.surface("small", &texts[1]);
    let whole = (TAU * big * 2.0 * height, TAU * small * length);
    let made = scene.names(&["big", "small"]);
    match random.below(4) {
        0 => {
            let keep = scene.point(at + small * first + by);
            scene.say(format!("surface branch = trim(small, by: big, keep: {keep})"));
            scene.report("branch", "branch.area", outside, 2);
        }
        1 => {
            let keep = scene.point(DVec3::new(-by.x, -by.y, 0.0).normalize() * big);
            scene.say(format!("surface holed = trim(big, by: small, keep: {keep})"));
            scene.report("holed", "holed.area", whole.0 - hole, 2);
        }
        2 => {
            scene.say(format!("let runs = meet({made})"));
            scene.report("meeting", "sum([for run in runs: length(run)])", round(|t| rate(meeting, t).length()), 1);
        }
        _ => scene.pieces(&format!("imprint({made})"), Some(4), whole.0 + whole.1),
    }
}

/// A ball, a cylinder or a cone cut by a plane.
pub fn slices(random: &mut Random, scene: &mut Scene) {
    let (radius, kind) = (number(random, 5.0, 90.0), random.below(4));
    let center = DVec3::new(number(random, -50.0, 50.0), number(random, -50.0, 50.0), 0.0);
    let axis = scene.direction(DVec3::Z);
    let (text, at, normal, areas) = if kind < 2 {
        let [low, high, side] = [-DVec3::Z, DVec3::Z, DVec3::X].map(|d| center + radius * d);
        let meridian = scene.arc(low, high, side);
        let normal = direction(random, 0.3);
        let off = number(random, -0.9, 0.9) * radius;
        let caps = [TAU * radius * (radius - off), TAU * radius * (radius + off)];
        let about = scene.point(center);
        (format!("revolve({meridian}, axis: {axis}, about: {about})"), center + off * normal.normalize(), normal, caps)
    } else {
        let height = number(random, 2.0 * radius, 4.0 * radius);
        let normal = DVec3::new(number(random, -0.4, 0.4), number(random, -0.4, 0.4), 1.0);
        let at = number(random, 0.4, 0.6) * height;
        if kind == 2 {
            let rim = scene.circle(center, radius, DVec3::Z);
            let text = scene.extrude(&rim, DVec3::Z * height);
            (text, center + DVec3::Z * at, normal, [TAU * radius * at, TAU * radius * (height - at)])
        } else {
            let slope = radius / height;
            let (latus, e) = (slope * (height - at), slope * normal.truncate().length());
            let share = radius / radius.hypot(height);
            let tip = PI * latus * latus / (1.0 - e * e).powf(1.5) / share;
            let side = scene.line(center + DVec3::X * radius, center + DVec3::Z * height);
            let about = scene.point(center);
            let areas = [tip, PI * radius * radius / share - tip];
            (format!("revolve({side}, axis: {axis}, about: {about})"), center + DVec3::Z * at, normal, areas)
        }
    };
    scene.surface("body", &text);
    let cut = scene.cut(at, normal);
    scene.pieces(&format!("split(body, by: {cut})"), Some(2), areas[0] + areas[1]);
    scene.report("least", "min([for piece in pieces: area(piece)])", areas[0].min(areas[1]), 2);
}

/// A web stands on the curve in which a wall meets a vault.
pub fn webs(random: &mut Random, scene: &mut Scene) {
    let (half, length) = (number(random, 10.0, 40.0), number(random, 30.0, 120.0));
    let rise = number(random, 0.1 * half, 0.6 * half).max(0.5);
    let radius = (half * half + rise * rise) / (2.0 * rise);
    let middle = rise - radius;
    let (low, high) = (-number(random, 2.0, 20.0), rise + number(random, 2.0, 30.0));
    let ends = [-half - number(random, 1.0, 10.0), half + number(random, 1.0, 10.0)];
    let first = (length * 3.0).round() / 10.0;
    let second = if random.below(2) == 0 { first } else { (length * 5.0).round() / 10.0 };
    let (a, b) = (DVec3::new(first, ends[0], low), DVec3::new(second, ends[1], low));
    let bow = [0.0, (half * 3.0).round() / 10.0][random.below(2)].min(length / 4.0);
    let crown = ((a + b) / 2.0).with_x((a.x + b.x) / 2.0 + bow);
    let vault = scene.arc(DVec3::new(0.0, -half, 0.0), DVec3::new(0.0, half, 0.0), DVec3::Z * rise);
    let wall = if bow > 0.0 { scene.arc(a, b, crown) } else { scene.line(a, b) };
    let texts = [scene.extrude(&vault, DVec3::X * length), scene.extrude(&wall, DVec3::Z * (high - low))];
    scene.surface("vault", &texts[0]);
    scene.surface("wall", &texts[1]);
    // The circle through the ends and the crown of the wall.
    let (c, p, q) = (a.truncate(), b.truncate() - a.truncate(), crown.truncate() - a.truncate());
    let about = c + DVec2::new(q.y * p.length_squared() - p.y * q.length_squared(), p.x * q.length_squared() - q.x * p.length_squared())
        / (2.0 * p.perp_dot(q));
    let wall_radius = about.distance(c);
    let x = |y: f64| if bow > 0.0 { about.x + (wall_radius.powi(2) - (y - about.y).powi(2)).sqrt() } else { c.x + p.x * (y - c.y) / p.y };
    let wall_length = if bow > 0.0 { 2.0 * wall_radius * (p.length() / 2.0 / wall_radius).asin() } else { p.length() };
    let meeting = |y: f64| DVec3::new(x(y), y, middle + (radius * radius - y * y).sqrt());
    let by = DVec3::new(number(random, 5.0, 30.0), 0.0, number(random, 1.0, 30.0));
    scene.say("curve foot = vault & wall".to_owned());
    let web = scene.extrude("foot", by);
    scene.surface("web", &web);
    scene.report("foot", "foot.length", along(-half, half, |y| rate(meeting, y).length()), 1);
    let area = along(-half, half, |y| rate(meeting, y).cross(by).length());
    scene.report("web", "web.area", area, 2);
    let all = area + 2.0 * radius * (half / radius).asin() * length + wall_length * (high - low);
    let made = scene.names(&["vault", "wall", "web"]);
    scene.pieces(&format!("imprint({made})"), Some(4), all);
}

/// A tray with round corners, cut obliquely or holed.
pub fn trays(random: &mut Random, scene: &mut Scene) {
    let [a, b] = [0; 2].map(|_| number(random, 20.0, 200.0));
    let radius = [2.0, 5.0, number(random, 1.0, 0.4 * a.min(b))][random.below(3)];
    let (height, tilt) = (number(random, 30.0, 80.0), DVec2::new(number(random, -1.0, 1.0), number(random, -1.0, 1.0)) * 10.0 / a.max(b));
    let half = DVec2::new(a, b) / 2.0;
    let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let rim = scene.rounded(&signs.map(|(x, y)| (half * DVec2::new(x, y)).extend(0.0)), radius);
    let (around, floor) = (2.0 * (a + b) - (8.0 - TAU) * radius, a * b - (4.0 - PI) * radius * radius);
    scene.say(format!("curve rim = {rim}"));
    let wall = scene.extrude("rim", DVec3::Z * height);
    scene.surface("wall", &wall);
    let (at, keep) = ((4.0 * height).round() / 10.0, scene.point(DVec3::new(0.0, -half.y, 0.0)));
    let normal = DVec3::new(-tilt.x, -tilt.y, 1.0);
    let cut = scene.cut(DVec3::Z * at, normal);
    match random.below(4) {
        0 => {
            scene.say(format!("surface cut = trim(wall, by: {cut}, keep: {keep})"));
            scene.report("cut", "cut.area", around * at, 2);
        }
        1 => {
            scene.pieces(&format!("split(wall, by: {cut})"), Some(2), around * height);
            scene.report("least", "min([for piece in pieces: area(piece)])", around * at.min(height - at), 2);
        }
        2 => {
            let r = number(random, 0.1, 0.4) * height.min(b - 2.0 * radius);
            let end = scene.circle(DVec3::Z * height / 2.0, r, DVec3::X);
            let pipe = scene.extrude(&end, DVec3::X * a);
            scene.surface("pipe", &pipe);
            scene.say(format!("surface holed = trim(wall, by: pipe, keep: {keep})"));
            scene.report("holed", "holed.area", around * height - PI * r * r, 2);
        }
        _ => {
            scene.say(format!("curve top = meet(wall, {cut})[0]"));
            scene.say(format!("surface cut = trim(wall, by: top, keep: {keep})"));
            scene.say("surface floor = plane(rim)\nsurface lid = plane(top)".to_owned());
            let made = scene.names(&["floor", "cut", "lid"]);
            scene.say(format!("shell body of {made}"));
            scene.report("volume", "body.volume", floor * at, 3);
            scene.report("body", "body.area", floor * (1.0 + normal.length()) + around * at, 2);
        }
    }
}

/// An integral over the unit square by Simpson's rule.
pub fn double(f: impl Fn(f64, f64) -> f64) -> f64 {
    const N: usize = 64;
    let weight = |k: usize| (if k == 0 || k == N { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 }) / (3 * N) as f64;
    let at = |k: usize| k as f64 / N as f64;
    let places = (0..=N).flat_map(|i| (0..=N).map(move |j| (i, j)));
    places.map(|(i, j)| weight(i) * weight(j) * f(at(i), at(j))).sum()
}

/// A triangle in (u, v) is a hole of a net of Bézier, or all that stays.
pub fn holes(random: &mut Random, scene: &mut Scene) {
    let size = [10.0, 50.0, 100.0][random.below(3)];
    let net: Vec<DVec3> =
        (0..9).map(|k| DVec3::new(f64::from(k % 3) / 2.0, f64::from(k / 3) / 2.0, number(random, 0.0, 0.6)) * size).collect();
    let corners = loop {
        let corners = [0; 3].map(|_| (DVec2::new(random.share(), random.share()) * 90.0 + 5.0).round() / 100.0);
        if is_sound(&corners) && area(&corners) > 0.005 {
            break corners;
        }
    };
    let base = |t: f64| [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
    let slope = |t: f64| [2.0 * t - 2.0, 2.0 - 4.0 * t, 2.0 * t];
    let sum = |a: [f64; 3], b: [f64; 3]| (0..9).map(|k| net[k] * a[k % 3] * b[k / 3]).sum::<DVec3>();
    let cell = |u: f64, v: f64| sum(slope(u), base(v)).cross(sum(base(u), slope(v))).length();
    let part = |s: f64, t: f64| {
        let p = corners[0] + s * (corners[1] - corners[0] + t * (corners[2] - corners[1]));
        2.0 * area(&corners) * s * cell(p.x, p.y)
    };
    let is_hole = random.below(3) > 0;
    let left = if is_hole { double(cell) - double(part) } else { double(part) };
    // With u and v swapped both the net and the corners are.
    let swap = scene.form.permuted;
    let rows: Vec<String> = (0..3).map(|j| scene.points(&[0, 1, 2].map(|i| if swap { net[3 * i + j] } else { net[3 * j + i] }))).collect();
    scene.surface("base", &format!("bezier_surface([{}])", rows.join(", ")));
    let mut corners: Vec<DVec3> = corners.iter().map(|p| if swap { DVec3::new(p.y, p.x, 0.0) } else { p.extend(0.0) }).collect();
    corners = scene.corners(&corners, true);
    let listed: Vec<String> = corners.iter().map(|p| format!("({:?}, {:?}, 0)", p.x, p.y)).collect();
    let word = if is_hole { "holes" } else { "outer" };
    scene.surface("part", &format!("trim(base, {word}: [polyline([{}], closed: true)], uv: true)", listed.join(", ")));
    scene.report("part", "part.area", left, 2);
}

/// A tube over an ellipse, up to ten times as wide as thick, cut obliquely.
pub fn flat_tubes(random: &mut Random, scene: &mut Scene) {
    let wide = number(random, 2.0, 60.0);
    let thin = (wide / number(random, 1.0, 10.0) * 100.0).round() / 100.0;
    let (height, at) = (4.0 * wide, (number(random, 1.6, 2.4) * wide * 10.0).round() / 10.0);
    let normal = DVec3::new(number(random, -1.0, 1.0), number(random, -1.0, 1.0), 1.0);
    let rim = scene.ellipse(DVec3::ZERO, DVec3::X * wide, DVec3::Y * thin);
    let tube = scene.extrude(&rim, DVec3::Z * height);
    scene.surface("tube", &tube);
    let around = round(|t| (wide * t.sin()).hypot(thin * t.cos()));
    let cut = scene.cut(DVec3::Z * at, normal);
    let keep = scene.point(DVec3::X * wide);
    if random.below(2) == 0 {
        scene.say(format!("surface cut = trim(tube, by: {cut}, keep: {keep})"));
        scene.report("cut", "cut.area", around * at, 2);
    } else {
        scene.pieces(&format!("split(tube, by: {cut})"), Some(2), around * height);
        scene.report("least", "min([for piece in pieces: area(piece)])", around * at.min(height - at), 2);
    }
}
