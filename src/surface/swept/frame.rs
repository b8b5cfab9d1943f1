//! Rotation-minimising frames along a path by double reflection [Wang, Jüttler, Zheng & Liu 2008].
//!
//! A step reflects the frame in the plane between two points, then in the plane that brings the tangent to where it
//! belongs. Both are exact isometries, and the step run backwards undoes itself, so that the error of a part of n steps
//! is a series in n⁻⁴, n⁻⁶, …: Romberg's table over halved steps takes it down to rounding.

use glam::{DMat3, DVec3};

use crate::base::math;
use crate::base::tolerance::EPSILON;
use crate::network::Chain;

/// Rows of the table, at most.
const ROWS: usize = 6;
/// A part is halved this often, at most.
const DEPTH: usize = 12;

/// A place of a path: point and unit tangent.
pub type PathPlace = (DVec3, DVec3);

/// Point and unit tangent at a fraction, from the side before it where they jump.
pub fn place(path: &Chain, f: f64, before: bool) -> PathPlace {
    let jet = if before { path.jet_before(f) } else { path.jet(f) };
    (jet.p, jet.d1.normalize_or_zero())
}

/// A vector seen in the mirror between two points, or as it is where they are one.
fn mirrored(v: DVec3, by: DVec3) -> DVec3 {
    let square = by.length_squared();
    if square == 0.0 { v } else { v - by * (2.0 * by.dot(v) / square) }
}

/// A vector normal to the first tangent, transported to the second place without turning about the way.
pub fn step(from: PathPlace, to: PathPlace, normal: DVec3) -> DVec3 {
    let by = to.0 - from.0;
    if by == DVec3::ZERO {
        return bent(from.1, to.1, normal);
    }
    let (tangent, normal) = (mirrored(from.1, by), mirrored(normal, by));
    mirrored(normal, to.1 - tangent)
}

/// The smallest rotation that takes one unit vector to another, applied to a vector.
pub fn bent(from: DVec3, to: DVec3, v: DVec3) -> DVec3 {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    if cosine <= -1.0 + EPSILON {
        return v;
    }
    v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine))
}

/// Transports a normal from one fraction of a smooth part to another, in `steps` double reflections.
pub fn transported_normal(path: &Chain, (from, to): (f64, f64), normal: DVec3, steps: usize) -> DVec3 {
    let mut here = place(path, from, false);
    let mut normal = normal;
    for k in 1..=steps {
        let f = if k == steps { to } else { from + (to - from) * k as f64 / steps as f64 };
        let next = place(path, f, k == steps);
        normal = step(here, next, normal);
        here = next;
    }
    normal
}

/// Like [`transported_normal`], as exact as rounding allows: a part on which the table does not settle is halved.
pub fn transported(path: &Chain, from_to: (f64, f64), normal: DVec3) -> DVec3 {
    halved(path, from_to, normal, DEPTH)
}

fn halved(path: &Chain, (from, to): (f64, f64), normal: DVec3, depth: usize) -> DVec3 {
    let (found, settled) = extrapolated(path, (from, to), normal);
    if settled || depth == 0 {
        return found;
    }
    let middle = 0.5 * (from + to);
    let there = halved(path, (from, middle), normal, depth - 1);
    halved(path, (middle, to), there, depth - 1)
}

/// The last value of the table, and whether it has settled.
fn extrapolated(path: &Chain, from_to: (f64, f64), normal: DVec3) -> (DVec3, bool) {
    let (_, tangent) = place(path, from_to.1, true);
    let first = transported_normal(path, from_to, normal, 1);
    let across = tangent.cross(first);
    let angle = |v: DVec3| math::atan2(v.dot(across), v.dot(first));
    let (mut row, mut settled) = (vec![0.0], false);
    for k in 1..ROWS {
        let mut next = vec![angle(transported_normal(path, from_to, normal, 1 << k))];
        let mut power = 16.0;
        for before in &row {
            let last = next[next.len() - 1];
            next.push(last + (last - before) / (power - 1.0));
            power *= 4.0;
        }
        let (best, was) = (next[next.len() - 1], row[row.len() - 1]);
        row = next;
        settled = k > 1 && (best - was).abs() <= EPSILON;
        if settled {
            break;
        }
    }
    let (sin, cos) = math::sin_cos(row[row.len() - 1]);
    (first * cos + across * sin, settled)
}

/// The frame with a tangent and a normal as columns: normal, tangent × normal, tangent.
pub fn frame(tangent: DVec3, normal: DVec3) -> DMat3 {
    DMat3::from_cols(normal, tangent.cross(normal), tangent)
}

/// A frame turned about its own tangent.
pub fn twisted(frame: DMat3, angle: f64) -> DMat3 {
    let (sin, cos) = math::sin_cos(angle);
    DMat3::from_cols(frame.x_axis * cos + frame.y_axis * sin, frame.y_axis * cos - frame.x_axis * sin, frame.z_axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::origin::Origin;
    use crate::geometry::construct::build::helix;

    /// The helix (2 cos t, 2 sin t, t/2) once round, with the angle of the end's frame to the normal of the curve there.
    fn end_angle(transport: impl Fn(&Chain, DVec3) -> DVec3) -> f64 {
        let pitch = std::f64::consts::PI;
        let curve = helix(DVec3::ZERO, DVec3::Z, DVec3::new(2.0, 0.0, 0.0), pitch, 1.0, Origin::NONE).expect("a helix");
        let path = Chain::of_curve(&curve);
        let end = transport(&path, DVec3::new(-1.0, 0.0, 0.0));
        let (tangent, frenet) = (place(&path, 1.0, true).1, DVec3::new(-1.0, 0.0, 0.0));
        math::atan2(end.dot(tangent.cross(frenet)), end.dot(frenet))
    }

    #[test]
    fn frames_on_a_helix_are_those_of_the_reference() {
        for (steps, angle) in [(25, -1.5238967438213686), (50, -1.5238963049255685), (100, -1.5238962775223193), (200, -1.5238962758100487)]
        {
            let found = end_angle(|path, normal| transported_normal(path, (0.0, 1.0), normal, steps));
            assert!((found - angle).abs() < 1e-11, "{steps}: {found}");
        }
        let quarter = |k: u8| (f64::from(k) / 8.0, f64::from(k + 1) / 8.0);
        let found = end_angle(|path, normal| (0..8).fold(normal, |n, k| transported(path, quarter(k), n)));
        assert!((found + 1.5238962756959047).abs() < 1e-13, "{found}");
    }

    #[test]
    fn a_corner_turns_the_frame_about_its_own_axis() {
        let (from, to) = ((DVec3::ZERO, DVec3::X), (DVec3::ZERO, DVec3::Y));
        assert!(step(from, to, DVec3::Y).distance(-DVec3::X) < 1e-15);
        assert!(step(from, to, DVec3::Z).distance(DVec3::Z) < 1e-15);
    }
}
