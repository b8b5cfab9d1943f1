//! The synchronized law: guides divided in the same ratio, and how sections turn from station to station between them.

use glam::{DMat3, DVec3};

use crate::base::math;
use crate::base::tolerance::EPSILON;
use crate::surface::swept::sections::{Guide, Section};

/// Steps between two stations.
const STEPS: usize = 4;
/// Improvements of one step, at most.
const ROUNDS: usize = 24;
/// What is added to the inertia of anchors, as a share of it, so that anchors near to one line do not turn about it.
const DAMPING: f64 = 1.0 / 256.0;

/// Guides and the sections between which they are divided.
#[derive(Clone, Copy)]
pub struct Divided<'a> {
    /// Guides, in the main guide's direction.
    pub guides: &'a [Guide],
    /// Sections, by ascending fraction of the main guide.
    pub sections: &'a [Section],
}

impl Divided<'_> {
    /// Between the sections' own fractions in proportion: of guide `j` by one of the main guide.
    pub fn on_guide(&self, j: usize, w: f64) -> f64 {
        proportional(self.sections.iter().map(|s| (s.on_guides[0], s.on_guides[j])).collect(), w)
    }

    /// The other way round: of the main guide by one of guide `j`.
    pub fn on_main(&self, j: usize, f: f64) -> f64 {
        proportional(self.sections.iter().map(|s| (s.on_guides[j], s.on_guides[0])).collect(), f)
    }

    /// Points of all guides at a fraction of the main one, which goes on beyond 1 where they are closed.
    fn anchors(&self, w: f64) -> Vec<DVec3> {
        let w = if w > 1.0 { w - 1.0 } else { w };
        self.guides.iter().enumerate().map(|(j, guide)| guide.chain.point(self.on_guide(j, w))).collect()
    }

    /// The rotation from one fraction of the main guide to another, composed of small ones.
    pub fn turn(&self, (from, to): (f64, f64)) -> DMat3 {
        let mut before = self.anchors(from);
        let mut turn = DMat3::IDENTITY;
        for k in 1..=STEPS {
            let next = self.anchors(from + (to - from) * k as f64 / STEPS as f64);
            turn = nearest(&before, &next) * turn;
            before = next;
        }
        turn
    }

    /// The rotations of a section at all stations, transported from its own one to the others by ascending or descending fractions;
    /// past the end of closed guides to the last one that is left.
    ///
    /// Where `returns`, it is transported once round, and the rotation that it lacks then to be as at first is distributed along the way.
    pub fn turns(&self, from: f64, ws: &[f64], ascending: bool, closed: bool, returns: bool) -> Vec<DMat3> {
        let n = ws.len();
        let mut all = vec![DMat3::IDENTITY; n];
        let Some(start) = ws.iter().position(|w| *w == from) else { return all };
        let (mut here, mut turn) = (ws[start], DMat3::IDENTITY);
        for step in 1..n {
            let k = if ascending { start + step } else { start + n - step };
            if !closed && (ascending && k >= n || !ascending && k < n) {
                break;
            }
            let mut next = ws[k % n];
            if ascending && next < here {
                next += 1.0;
            } else if !ascending && next > here {
                here += 1.0;
            }
            turn = self.turn((here, next)) * turn;
            all[k % n] = turn;
            here = if next > 1.0 { next - 1.0 } else { next };
        }
        if returns {
            let lacks = vector(self.turn((here, from + 1.0)) * turn);
            for (turn, w) in all.iter_mut().zip(ws) {
                *turn *= rotation(lacks * -(w - from).rem_euclid(1.0));
            }
        }
        all
    }
}

/// Linear between pairs, from (0, 0) to (1, 1).
fn proportional(pairs: Vec<(f64, f64)>, x: f64) -> f64 {
    let mut nodes = vec![(0.0, 0.0)];
    nodes.extend(pairs.iter().filter(|p| p.0 > 0.0 && p.0 < 1.0));
    nodes.push((1.0, 1.0));
    for end in pairs {
        if end.0 <= 0.0 {
            nodes[0] = end;
        } else if end.0 >= 1.0 {
            let last = nodes.len() - 1;
            nodes[last] = end;
        }
    }
    let k = nodes.partition_point(|n| n.0 <= x).clamp(1, nodes.len() - 1);
    let (a, b) = (nodes[k - 1], nodes[k]);
    a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0)
}

/// The rotation about their centres that brings points nearest to others; about a line that they lie on it does not turn.
fn nearest(from: &[DVec3], to: &[DVec3]) -> DMat3 {
    let about = |points: &[DVec3]| -> Vec<DVec3> {
        let centre = points.iter().sum::<DVec3>() / points.len() as f64;
        points.iter().map(|p| *p - centre).collect()
    };
    let (from, to) = (about(from), about(to));
    let inertia = |arms: &[DVec3]| arms.iter().map(|a| a.length_squared()).sum::<f64>();
    let (before, after) = (inertia(&from), inertia(&to));
    let mut turn = DMat3::IDENTITY;
    if before == 0.0 || after == 0.0 {
        return turn;
    }
    let scale = (before / after).sqrt();
    for _ in 0..ROUNDS {
        let (mut matrix, mut moment) = (DMat3::from_diagonal(DVec3::splat(before * DAMPING)), DVec3::ZERO);
        for (a, b) in from.iter().zip(&to) {
            let arm = turn * *a;
            matrix += DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z);
            moment += arm.cross(*b * scale);
        }
        let by = matrix.inverse() * moment;
        turn = rotation(by) * turn;
        if by.length() <= EPSILON {
            break;
        }
    }
    turn
}

/// The rotation about a vector by its length, radians.
fn rotation(by: DVec3) -> DMat3 {
    let axis = by.normalize_or_zero();
    let (sin, cos) = math::sin_cos(by.length());
    let column = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    if axis == DVec3::ZERO { DMat3::IDENTITY } else { DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z)) }
}

/// The vector about which and by whose length a rotation turns, radians from 0 to π.
fn vector(turn: DMat3) -> DVec3 {
    let [x, y, z] = [turn.x_axis, turn.y_axis, turn.z_axis];
    let axis = DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x) * 0.5;
    let cos = 0.5 * (x.x + y.y + z.z - 1.0);
    let angle = math::atan2(axis.length(), cos);
    if cos > 0.0 || axis.length() > EPSILON {
        return axis.normalize_or_zero() * angle;
    }
    // Half a turn: twice the square of its axis is what it adds to the identity.
    let squares = [x + DVec3::X, y + DVec3::Y, z + DVec3::Z];
    squares.into_iter().max_by(|a, b| a.length().total_cmp(&b.length())).unwrap_or(DVec3::Z).normalize_or_zero() * angle
}

/// The angle by which a rotation turns, radians from 0 to π.
pub fn angle(turn: DMat3) -> f64 {
    vector(turn).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_turned_as_they_were() {
        let points = [(0.0, 0.0, 0.0), (4.0, 0.5, 0.0), (7.0, 3.0, 1.0)].map(DVec3::from);
        let turn = rotation(DVec3::new(0.1, -0.2, 0.25));
        let moved = points.map(|p| turn * p * 1.7 + DVec3::new(3.0, 2.0, 1.0));
        let found = nearest(&points, &moved);
        for p in points {
            assert!((found * p).distance(turn * p) < 1e-4, "{found}");
        }
    }

    #[test]
    fn points_on_a_line_do_not_turn_about_it() {
        let row = [1.0, 2.0, 5.0].map(|x| DVec3::X * x);
        let turn = rotation(DVec3::Z * 0.3);
        let found = nearest(&row, &row.map(|p| turn * p));
        assert!((found.z_axis - DVec3::Z).length() < 1e-12 && (found.x_axis - turn.x_axis).length() < 1e-12, "{found}");
    }

    #[test]
    fn half_a_turn_has_its_axis() {
        let axis = DVec3::new(0.6, 0.0, -0.8);
        let found = vector(rotation(axis * std::f64::consts::PI));
        assert!((found.dot(axis).abs() - std::f64::consts::PI).abs() < 1e-12, "{found}");
    }
}
