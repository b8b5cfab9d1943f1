//! Balls where a surface is less than smooth: the points where they touch change their speeds there at once.

use glam::DVec2;

use crate::base::tolerance::NUDGE;
use crate::surface::rolling::ball::{Ball, Guess};
use crate::surface::rolling::station::{BallStation, Place};

/// Stations this near to each other, in tolerances, are one.
const NEAR: f64 = 64.0;
/// A station this near to a break, in tolerances, is on it.
const SAME: f64 = 1.0 / 1024.0;
/// Share of the tolerance by which the centre leaves a station to find the speeds on each side.
const BESIDE: f64 = 1.0 / 64.0;

/// A line of a surface on which a ball is looked for.
#[derive(Clone, Copy)]
struct BreakLine {
    face: usize,
    axis: usize,
    at: f64,
}

/// Stations with those between them that touch a surface on one of its breaks; those very near to one give way to it.
pub(crate) fn with_breaks(ball: &Ball, radius: f64, stations: &[BallStation]) -> Vec<BallStation> {
    let breaks = [ball.faces[0].breaks(), ball.faces[1].breaks()];
    let last = stations.len() - 2;
    let mut all = vec![stations[0]];
    for (i, pair) in stations.windows(2).enumerate() {
        let mut lines = Vec::new();
        for (face, breaks) in breaks.iter().enumerate() {
            for (axis, breaks) in breaks.iter().enumerate() {
                lines.extend(crossed(ball, pair, face, axis, breaks));
            }
        }
        let found = on_lines(ball, radius, pair, &lines);
        // The first of the two may have given way already.
        let gave_way = all.last().is_none_or(|last| last.center != pair[0].center);
        if i > 0 && !gave_way && found.first().is_some_and(|next| near(ball, &pair[0], next)) {
            all.pop();
        }
        let gives_way = i < last && found.last().is_some_and(|next| near(ball, &pair[1], next));
        all.extend(found);
        all.extend((!gives_way).then_some(pair[1]));
    }
    all
}

fn near(ball: &Ball, s: &BallStation, t: &BallStation) -> bool {
    s.center.distance(t.center).max(s.feet[0].distance(t.feet[0])).max(s.feet[1].distance(t.feet[1])) <= NEAR * ball.tolerance.point
}

/// Stations with one more between any two of them.
pub(crate) fn with_middles(ball: &Ball, radius: f64, stations: &[BallStation]) -> Vec<BallStation> {
    let mut all = vec![stations[0]];
    for pair in stations.windows(2) {
        // The surface and the direction in (u, v) in which it goes farther.
        let (face, axis, reach) = [(0, 0), (0, 1), (1, 0), (1, 1)]
            .map(|(face, axis)| {
                let scale = ball.faces[face].jet(pair[0].uv[face]);
                let d = step(ball, pair, face)[axis] * if axis == 0 { scale.du } else { scale.dv }.length();
                (face, axis, d.abs())
            })
            .into_iter()
            .fold((0, 0, 0.0), |x, y| if y.2 > x.2 { y } else { x });
        if reach > ball.tolerance.point {
            let at = pair[0].uv[face][axis] + 0.5 * step(ball, pair, face)[axis];
            all.extend(on_lines(ball, radius, pair, &[BreakLine { face, axis, at }]));
        }
        all.push(pair[1]);
    }
    all
}

/// From where the first of two stations touches a surface to where the second one does.
fn step(ball: &Ball, pair: &[BallStation], face: usize) -> DVec2 {
    ball.faces[face].turned_to(pair[1].uv[face], pair[0].uv[face]) - pair[0].uv[face]
}

/// The breaks of one direction between two stations.
fn crossed(ball: &Ball, pair: &[BallStation], face: usize, axis: usize, breaks: &[f64]) -> Vec<BreakLine> {
    let (from, d) = (pair[0].uv[face][axis], step(ball, pair, face)[axis]);
    let first = if ball.faces[face].is_closed(axis) { from.min(from + d).floor() } else { 0.0 };
    let all = [0.0, 1.0].into_iter().flat_map(|turn| breaks.iter().map(move |at| at + first + turn));
    let between = |at: &f64| (at - from) / d > 0.0 && (at - from) / d < 1.0;
    all.filter(between).map(|at| BreakLine { face, axis, at }).collect()
}

/// The balls on lines between two stations, where there are some, in order, apart from each other and not the same as both.
fn on_lines(ball: &Ball, radius: f64, pair: &[BallStation], lines: &[BreakLine]) -> Vec<BallStation> {
    let mut found: Vec<BallStation> = Vec::new();
    for line in lines {
        let Some(next) = on_line(ball, radius, [pair[0], pair[1]], *line) else { continue };
        let same = |s: &BallStation| s.feet[line.face].distance(next.feet[line.face]) <= SAME * ball.tolerance.point;
        if !same(&pair[0]) && !same(&pair[1]) {
            found.push(next);
        }
    }
    let ahead = |s: &BallStation| (s.center - pair[0].center).dot(pair[0].way + pair[1].way);
    found.sort_by(|s, t| ahead(s).total_cmp(&ahead(t)));
    found.dedup_by(|next, last| near(ball, last, next));
    found
}

/// The ball on a line between two stations that touch on both sides of it. Where the contact runs nearly along the line Newton's method
/// may find another place on it: then the stations are taken nearer to each other.
fn on_line(ball: &Ball, radius: f64, mut pair: [BallStation; 2], mut line: BreakLine) -> Option<BallStation> {
    const HALVINGS: usize = 24;
    for _ in 0..HALVINGS {
        let along = pair[0].way + pair[1].way;
        let between = |s: &BallStation| (s.center - pair[0].center).dot(along) >= 0.0 && (pair[1].center - s.center).dot(along) >= 0.0;
        let guess = |f: f64| {
            let uv = [0, 1].map(|k: usize| pair[0].uv[k] + step(ball, &pair, k) * f);
            Guess { uv, points: [0, 1].map(|k: usize| pair[0].feet[k].lerp(pair[1].feet[k], f)) }
        };
        let from = pair[0].uv[line.face][line.axis];
        let mut near = guess(((line.at - from) / step(ball, &pair, line.face)[line.axis]).clamp(0.0, 1.0));
        near.uv[line.face][line.axis] = line.at;
        let place = Place::Line { face: line.face, axis: line.axis, at: line.at, along };
        if let Some(found) = ball.at(radius, &place, &near).filter(between) {
            return Some(found);
        }
        let plane = (pair[0].center.lerp(pair[1].center, 0.5), along.normalize_or_zero());
        let middle = ball.station(radius, plane, &guess(0.5)).filter(between)?;
        let at = ball.faces[line.face].turned_to(middle.uv[line.face], pair[0].uv[line.face])[line.axis];
        if (from - line.at) * (at - line.at) > 0.0 {
            line.at += middle.uv[line.face][line.axis] - at;
            pair[0] = middle;
        } else {
            pair[1] = middle;
        }
    }
    None
}

/// Stations twice where the points that touch have other speeds before than after them: each with those of its side.
pub(crate) fn with_sides(ball: &Ball, radius: f64, stations: &[BallStation]) -> Vec<BallStation> {
    let step = BESIDE * ball.tolerance.point;
    let beside = |s: &BallStation, side: f64| {
        let guess = Guess { uv: s.uv, points: s.feet };
        let found = ball.station(radius, (s.center + s.way * (side * step), s.way), &guess)?;
        // It is the same ball but for its speeds.
        Some(BallStation { way: s.way, rates: found.rates, ..*s })
    };
    let last = stations.len() - 1;
    let mut all = Vec::with_capacity(stations.len());
    for (i, s) in stations.iter().enumerate() {
        crate::base::job::poll();
        let (before, after) = (beside(s, -1.0).unwrap_or(*s), beside(s, 1.0).unwrap_or(*s));
        let jumps = (0..2).any(|k| before.rates[k].distance(after.rates[k]) > NUDGE * (before.speed() + after.speed()));
        match (jumps, i) {
            (false, _) => all.push(*s),
            (true, 0) => all.push(after),
            (true, i) if i == last => all.push(before),
            (true, _) => all.extend([before, after]),
        }
    }
    all
}
