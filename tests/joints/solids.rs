//! Families of bodies and of faces with closed forms: plates with holes, boxes, slices of rings, cones, walls, frusta, turned profiles,
//! roundings, bends of pipes, projections, caps of balls, saddles and nets.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::curved::{along, double};
use super::flat::number;
use super::outline::{area, is_sound};
use super::scene::Scene;
use crate::support::random::Random;

fn place(random: &mut Random) -> DVec3 {
    DVec3::new(number(random, -50.0, 50.0), number(random, -50.0, 50.0), number(random, -20.0, 20.0))
}

/// A plate with one to six holes in a row.
pub fn drilled(random: &mut Random, scene: &mut Scene) {
    let n = 1 + random.below(6);
    let (pitch, width) = (number(random, 10.0, 40.0), number(random, 20.0, 90.0));
    let at = place(random);
    let corners = [(0.0, 0.0), (pitch * n as f64, 0.0), (pitch * n as f64, width), (0.0, width)].map(|(x, y)| at + DVec3::new(x, y, 0.0));
    let rim = scene.polygon(&corners);
    scene.surface("plate", &format!("plane({rim})"));
    let mut left = pitch * n as f64 * width;
    let mut holes = Vec::new();
    for k in 0..n {
        let radius = number(random, 0.1, 0.45) * pitch.min(width);
        let y = number(random, 0.0, 1.0) * (width - 2.0 * radius - 1.0) + radius + 0.5;
        let center = at + DVec3::new(pitch * (k as f64 + 0.5), y, 0.0);
        holes.push(scene.circle(center, radius, DVec3::Z));
        left -= PI * radius * radius;
    }
    if scene.form.permuted {
        holes.reverse();
    }
    scene.surface("drilled", &format!("trim(plate, holes: [{}])", holes.join(", ")));
    scene.report("left", "drilled.area", left, 2);
}

/// A box of six planes.
pub fn boxes(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let size = DVec3::new(number(random, 1.0, 90.0), number(random, 1.0, 90.0), number(random, 1.0, 90.0));
    let corner = |x: u8, y: u8, z: u8| at + size * DVec3::new(f64::from(x), f64::from(y), f64::from(z));
    let faces = [
        [corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)],
        [corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)],
        [corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)],
        [corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1)],
        [corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1)],
        [corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)],
    ];
    let names = ["a", "b", "c", "d", "e", "f"];
    for (name, corners) in names.iter().zip(faces) {
        let rim = scene.polygon(&corners);
        scene.surface(name, &format!("plane({rim})"));
    }
    let made = scene.names(&names);
    scene.say(format!("shell body of {made}"));
    scene.report("volume", "body.volume", size.x * size.y * size.z, 3);
    scene.report("area", "body.area", 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x), 2);
}

/// A ring cut by a plane across its axis.
pub fn rings(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let minor = number(random, 1.0, 20.0);
    let major = minor * number(random, 1.2, 5.0);
    let height = number(random, -0.8, 0.8) * minor;
    let tube = scene.circle(at + DVec3::X * major, minor, DVec3::Y);
    let (axis, about) = (scene.direction(DVec3::Z), scene.point(at));
    scene.surface("ring", &format!("revolve({tube}, axis: {axis}, about: {about})"));
    let cut = scene.cut(at + DVec3::Z * height, DVec3::Z);
    let whole = TAU * major * TAU * minor;
    scene.pieces(&format!("split(ring, by: {cut})"), Some(2), whole);
    let above = TAU * minor * major * (PI - 2.0 * (height / minor).asin());
    scene.report("least", "min([for piece in pieces: area(piece)])", above.min(whole - above), 2);
}

/// A cone and a tube on one axis.
pub fn cones(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let (wide, height) = (number(random, 5.0, 60.0), number(random, 5.0, 90.0));
    let narrow = wide * number(random, 0.0, 0.6);
    let radius = narrow + (wide - narrow) * number(random, 0.2, 0.8);
    let side = scene.line(at + DVec3::X * wide, at + DVec3::new(narrow, 0.0, height));
    let (axis, about) = (scene.direction(DVec3::Z), scene.point(at));
    scene.surface("cone", &format!("revolve({side}, axis: {axis}, about: {about})"));
    let rim = scene.circle(at - DVec3::Z * 5.0, radius, DVec3::Z);
    let tube = scene.extrude(&rim, DVec3::Z * (height + 10.0));
    scene.surface("tube", &tube);
    let made = scene.names(&["cone", "tube"]);
    scene.say(format!("let runs = meet({made})"));
    scene.report("meeting", "sum([for run in runs: length(run)])", TAU * radius, 1);
    let all = PI * (wide + narrow) * (wide - narrow).hypot(height) + TAU * radius * (height + 10.0);
    scene.pieces(&format!("imprint({made})"), Some(4), all);
}

/// Offsets of an outline with round corners to both sides, which are together twice as long.
pub fn offsets(random: &mut Random, scene: &mut Scene) {
    let (corners, radius) = loop {
        let n = 3 + random.below(4);
        let corners: Vec<DVec2> = (0..n).map(|_| DVec2::new(number(random, -50.0, 50.0), number(random, -50.0, 50.0))).collect();
        let radius = number(random, 1.0, 6.0);
        let cut = |k: usize| {
            let ways = [corners[(k + n - 1) % n] - corners[k], corners[(k + 1) % n] - corners[k]];
            radius / (0.5 * ways[0].angle_to(ways[1]).abs()).tan()
        };
        let fits = |k: usize| cut(k) + cut((k + 1) % n) < 0.8 * corners[k].distance(corners[(k + 1) % n]);
        if is_sound(&corners) && area(&corners) > 300.0 && (0..n).all(fits) {
            break (corners, radius);
        }
    };
    let rim = scene.rounded(&corners.iter().map(|p| p.extend(0.0)).collect::<Vec<_>>(), radius);
    scene.say(format!("curve rim = {rim}"));
    let by = scene.length(radius * number(random, 0.1, 0.9));
    let normal = scene.direction(DVec3::Z);
    scene.say(format!("curve one = offset(rim, {by}, normal: {normal})\ncurve other = offset(rim, -{by}, normal: {normal})"));
    scene.report("both", "(one.length + other.length) / rim.length", 2.0, 0);
}

/// The wall of a part of a tube.
pub fn walls(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let (radius, height) = (number(random, 5.0, 60.0), number(random, 5.0, 60.0));
    let (angle, thick) = (number(random, 0.3, 5.5), radius * number(random, 0.1, 0.5));
    let on = |t: f64| at + radius * DVec3::new(t.cos(), t.sin(), 0.0);
    let arc = scene.arc(on(0.0), on(angle), on(0.5 * angle));
    let text = scene.extrude(&arc, DVec3::Z * height);
    scene.surface("middle", &text);
    let by = scene.length(thick);
    scene.say(format!("shell wall of thicken(middle, {by})"));
    scene.report("volume", "wall.volume", angle * radius * thick * height, 3);
    let rims = 2.0 * (thick * height + angle * radius * thick);
    scene.report("area", "wall.area", 2.0 * angle * radius * height + rims, 2);
}

/// The frustum of a cone of a ruled face and two planes.
pub fn frusta(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let (low, high, height) = (number(random, 1.0, 50.0), number(random, 1.0, 50.0), number(random, 1.0, 90.0));
    let [foot, head] = [(0.0, low), (height, high)].map(|(z, radius)| scene.circle(at + DVec3::Z * z, radius, DVec3::Z));
    scene.say(format!("curve foot = {foot}\ncurve head = {head}"));
    let word = if random.below(2) == 0 { "ruled(foot, head)" } else { "skin([foot, head])" };
    scene.surface("side", word);
    scene.say("surface floor = plane(foot)\nsurface lid = plane(head)".to_owned());
    let made = scene.names(&["side", "floor", "lid"]);
    scene.say(format!("shell body of {made}"));
    scene.report("volume", "body.volume", PI / 3.0 * height * (low * low + low * high + high * high), 3);
    let side = PI * (low + high) * (low - high).hypot(height);
    scene.report("area", "body.area", side + PI * (low * low + high * high), 2);
}

/// A polygon turned about an axis beside it.
pub fn turned(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let corners = loop {
        let corners: Vec<DVec2> =
            (0..3 + random.below(3)).map(|_| DVec2::new(number(random, 2.0, 50.0), number(random, -30.0, 30.0))).collect();
        if is_sound(&corners) && area(&corners) > 50.0 {
            break corners;
        }
    };
    let rim = scene.polygon(&corners.iter().map(|p| at + DVec3::new(p.x, 0.0, p.y)).collect::<Vec<_>>());
    let (axis, about) = (scene.direction(DVec3::Z), scene.point(at));
    scene.surface("skin", &format!("revolve({rim}, axis: {axis}, about: {about})"));
    scene.say("shell body of skin".to_owned());
    let n = corners.len();
    let sides = || (0..n).map(|k| (corners[k], corners[(k + 1) % n]));
    let first: f64 = sides().map(|(a, b)| (a.x + b.x) * a.perp_dot(b) / 6.0).sum();
    scene.report("volume", "body.volume", TAU * first.abs(), 3);
    scene.report("area", "body.area", sides().map(|(a, b)| PI * (a.x + b.x) * a.distance(b)).sum(), 2);
}

/// The rounding between two plates at an angle.
pub fn roundings(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let (length, one, other) = (number(random, 5.0, 80.0), number(random, 10.0, 40.0), number(random, 10.0, 40.0));
    let angle = number(random, 0.8, 2.4);
    let way = DVec3::new(angle.cos(), 0.0, angle.sin());
    let along = DVec3::Y * length;
    let radius = number(random, 0.1, 0.7) * one.min(other) * (0.5 * angle).tan();
    for (name, to) in [("a", DVec3::X * one), ("b", way * other)] {
        let rim = scene.polygon(&[at, at + to, at + to + along, at + along]);
        scene.surface(name, &format!("plane({rim})"));
    }
    let made = scene.names(&["a", "b"]);
    let (by, keep) = (scene.length(radius), scene.point(at + 0.5 * along + 0.2 * (DVec3::X * one + way * other)));
    scene.say(format!("let faces = blend({made}, radius: {by}, keep: {keep})"));
    let cut = radius / (0.5 * angle).tan();
    // The contacts are fitted within the tolerance, which grows with what stands beside them.
    scene.room = 2e-5;
    let all = length * (one + other - 2.0 * cut + radius * (PI - angle));
    scene.report("area", "sum([for face in faces: area(face)])", all, 2);
}

/// A circle along an arc.
pub fn bends(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let radius = number(random, 1.0, 10.0);
    let (major, angle) = (radius * number(random, 1.5, 6.0), number(random, 0.3, 5.5));
    let on = |t: f64| at + major * DVec3::new(t.cos(), t.sin(), 0.0);
    let path = scene.arc(on(0.0), on(angle), on(0.5 * angle));
    let start = if scene.form.reversed { angle } else { 0.0 };
    let tube = scene.circle(on(start), radius, DVec3::new(-start.sin(), start.cos(), 0.0));
    scene.surface("pipe", &format!("along({tube}, {path})"));
    scene.report("area", "pipe.area", TAU * radius * angle * major, 2);
    scene.say("surface first = plane(pipe.u(0))\nsurface last = plane(pipe.u(1))".to_owned());
    let made = scene.names(&["pipe", "first", "last"]);
    scene.say(format!("shell body of {made}"));
    scene.report("volume", "body.volume", PI * radius * radius * angle * major, 3);
}

/// A circle seen on a tilted plane, and a line on a tube.
pub fn projections(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let radius = number(random, 1.0, 20.0);
    let tilt = DVec2::new(number(random, -1.0, 1.0), number(random, -1.0, 1.0));
    let sheet = |x: f64, y: f64| at + DVec3::new(x, y, 30.0 + tilt.x * x + tilt.y * y);
    let rim = scene.polygon(&[sheet(-40.0, -40.0), sheet(40.0, -40.0), sheet(40.0, 40.0), sheet(-40.0, 40.0)]);
    scene.surface("sheet", &format!("plane({rim})"));
    let (circle, way) = (scene.circle(at, radius, DVec3::Z), scene.direction(DVec3::Z));
    scene.surface("shade", &format!("plane(project({circle}, sheet, along: {way}))"));
    scene.report("shade", "shade.area", PI * radius * radius * tilt.length().hypot(1.0), 2);
    let rim = scene.circle(at, 30.0, DVec3::X);
    let tube = scene.extrude(&rim, DVec3::X * 80.0);
    scene.surface("tube", &tube);
    let [a, b] = [DVec2::new(10.0, number(random, -25.0, 25.0)), DVec2::new(number(random, 30.0, 70.0), number(random, -25.0, 25.0))];
    let line = scene.line(at + a.extend(90.0), at + b.extend(90.0));
    let down = scene.direction(-DVec3::Z);
    scene.say(format!("curve seen = project({line}, tube, along: {down})"));
    let d = b - a;
    let rise = |y: f64| -y / (900.0 - y * y).sqrt() * d.y;
    scene.report("seen", "seen.length", along(0.0, 1.0, |t| d.extend(rise(a.y + t * d.y)).length()), 1);
}

/// A cap of a ball with its lid.
pub fn caps(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let radius = number(random, 2.0, 60.0);
    let height = number(random, 0.2, 1.8) * radius;
    let meridian = scene.arc(at - DVec3::Z * radius, at + DVec3::Z * radius, at + DVec3::X * radius);
    let (axis, about) = (scene.direction(DVec3::Z), scene.point(at));
    scene.surface("ball", &format!("revolve({meridian}, axis: {axis}, about: {about})"));
    let normal = DVec3::new(number(random, -1.0, 1.0), number(random, -1.0, 1.0), 1.0).normalize();
    let cut = scene.cut(at + normal * (radius - height), normal);
    let keep = scene.point(at + normal * radius);
    scene.say(format!("surface cap = trim(ball, by: {cut}, keep: {keep})"));
    scene.say(format!("surface lid = plane(meet(ball, {cut})[0])"));
    let made = scene.names(&["cap", "lid"]);
    scene.say(format!("shell body of {made}"));
    scene.report("volume", "body.volume", PI * height * height * (radius - height / 3.0), 3);
    scene.report("area", "body.area", TAU * radius * height + PI * height * (2.0 * radius - height), 2);
}

/// A saddle between four lines, ruled and as a Coons patch.
pub fn saddles(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let corner = |random: &mut Random, x: f64, y: f64| at + DVec3::new(x, y, 0.0) * 50.0 + 0.3 * place(random);
    let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| corner(random, x, y));
    let du = |v: f64| (b - a).lerp(c - d, v);
    let dv = |u: f64| (d - a).lerp(c - b, u);
    let whole = double(|u, v| du(v).cross(dv(u)).length());
    if random.below(2) == 0 {
        let (south, north) = (scene.line(a, b), scene.line(d, c));
        scene.surface("saddle", &format!("ruled({south}, {north})"));
    } else {
        let sides = [(a, b), (b, c), (c, d), (d, a)].map(|(p, q)| scene.line(p, q));
        scene.surface("saddle", &format!("coons({})", sides.join(", ")));
    }
    scene.report("area", "saddle.area", whole, 2);
}

/// A net of lines and arcs that are moved along each other.
pub fn nets(random: &mut Random, scene: &mut Scene) {
    let at = place(random);
    let (wide, long) = (number(random, 10.0, 60.0), number(random, 10.0, 60.0));
    let (rise, lean) = (number(random, 0.1, 0.45) * wide, number(random, -1.0, 1.0));
    let radius = (wide * wide / 4.0 + rise * rise) / (2.0 * rise);
    let move_by = |t: f64| DVec3::new(0.0, t * long, t * lean * long);
    let across: Vec<String> = [0.0, 0.4, 1.0]
        .map(|t| {
            let foot = at + move_by(t);
            scene.arc(foot, foot + DVec3::X * wide, foot + DVec3::new(wide / 2.0, 0.0, rise))
        })
        .to_vec();
    let ends = [DVec3::ZERO, DVec3::new(wide / 2.0, 0.0, rise), DVec3::X * wide];
    let lines: Vec<String> = ends.map(|p| scene.line(at + p, at + p + move_by(1.0))).to_vec();
    let half = (wide / 2.0 / radius).asin();
    let speed = |t: f64| DVec3::new(t.cos(), 0.0, -t.sin()) * radius;
    let whole = along(-half, half, |t| speed(t).cross(move_by(1.0)).length());
    let (u, v) = if scene.form.permuted { (&lines, &across) } else { (&across, &lines) };
    let (u, v) = (u.join(", "), v.join(", "));
    let text = if random.below(2) == 0 { format!("transfinite(u: [{u}], v: [{v}])") } else { format!("gordon([{u}], [{v}])") };
    scene.surface("net", &text);
    scene.report("area", "net.area", whole, 2);
}
