//! Twists: mixed derivatives ∂uv at the nodes of a net of curves, estimated from the curves round each node.
//!
//! Curves say nothing of them. Each cell makes an estimate at each of its corners, and a node takes the mean of the cells round it, by their areas
//! in (u, v):
//!
//! - **Adini** [Barnhill, Brown & Klucewicz 1978]: the twist of the bilinearly blended Coons patch of the cell, so that of the
//!   four cells round a node together.
//! - **Similar**: a curve along u is carried along the two sides as its chord D is, turned and scaled without a twist about it,
//!   x = ((D·D′) g′ + (D × D′) × g′) / D², with g′ the curve's derivative at the corner; the mean of it and of the same the other
//!   way round. Bilinear patches have this twist. In a cell at a pole the curve opposite to it is carried into it: its derivative at a
//!   corner turns with the side that ends there, as little as the tangent of the side does, and shrinks as the chord. Surfaces of revolution have
//!   these twists, and where the sides lie in mirror planes and the curve leaves these at right angles, so does the surface.
//!
//! At a pole both are dropped onto its tangent plane, which the tangents of the curves that end there span.

use glam::{DQuat, DVec3};

use crate::base::tolerance::PARALLEL;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::blend::Blend;

/// How twists are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Twist {
    /// They are 0.
    Zero,
    /// Those of bilinearly blended Coons patches.
    Adini,
    /// Those of curves carried by similarities.
    Similar,
}

/// Corners of a cell, derivatives of its four curves there, and its sizes in u and v. Places are `[i][j]`: at the beginning or end of u and of v.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The corners.
    pub p: [[DVec3; 2]; 2],
    /// ∂u of the curves along u.
    pub du: [[DVec3; 2]; 2],
    /// ∂v of the curves along v.
    pub dv: [[DVec3; 2]; 2],
    /// Steps of u and v.
    pub size: (f64, f64),
    /// ∂vv of the curves along v.
    pub dvv: [[DVec3; 2]; 2],
    /// Whether the sides at the beginning and end of v are points.
    pub poles: [bool; 2],
}

impl Cell {
    /// The twist of the bilinearly blended Coons patch at a corner.
    pub fn adini(&self, i: usize, j: usize) -> DVec3 {
        let (h, k) = self.size;
        let around = self.p[0][0] - self.p[1][0] - self.p[0][1] + self.p[1][1];
        (self.dv[1][j] - self.dv[0][j]) / h + (self.du[i][1] - self.du[i][0]) / k - around / (h * k)
    }

    /// The twist of curves carried by similarities; that of Adini where no chord says how.
    pub fn similar(&self, i: usize, j: usize) -> DVec3 {
        let found = if self.poles[0] || self.poles[1] {
            self.at_pole_cell(i, j)
        } else {
            let along = carried(self.p[1][j] - self.p[0][j], self.dv[1][j] - self.dv[0][j], self.du[i][j]);
            let other = carried(self.p[i][1] - self.p[i][0], self.du[i][1] - self.du[i][0], self.dv[i][j]);
            along.zip(other).map(|(a, b)| 0.5 * (a + b))
        };
        found.unwrap_or_else(|| self.adini(i, j))
    }

    /// In a cell at a pole: the slope of the opposite curve's derivative, carried along the side `i` into the pole, at either end of it.
    fn at_pole_cell(&self, i: usize, j: usize) -> Option<DVec3> {
        let far = if self.poles[0] { 1 } else { 0 };
        let (chord, across) = (self.p[1][far] - self.p[0][far], self.du[i][far]);
        let slope = self.dv[1][j] - self.dv[0][j];
        let (here, there) = (self.dv[i][j], self.dv[i][far]);
        if chord == DVec3::ZERO || here == DVec3::ZERO || there == DVec3::ZERO {
            return None;
        }
        if j == far {
            let turns = here.cross(self.dvv[i][j]) / here.length_squared();
            return Some(across * (chord.dot(slope) / chord.length_squared()) + turns.cross(across));
        }
        let (from, to) = (there.normalize(), here.normalize());
        let shrinks = slope.length() / chord.length() * if far == 1 { 1.0 } else { -1.0 };
        (from.dot(to) > PARALLEL - 1.0).then(|| DQuat::from_rotation_arc(from, to) * across * shrinks)
    }
}

/// The slope of a vector that goes with a chord, from that of the chord.
fn carried(chord: DVec3, slope: DVec3, along: DVec3) -> Option<DVec3> {
    let square = chord.length_squared();
    (square > 0.0).then(|| (along * chord.dot(slope) + chord.cross(slope).cross(along)) / square)
}

/// Twists at the nodes of a blend, `i` fastest; `closed`: in which directions its last node is its first one.
pub fn at_nodes(blend: &Blend, how: Twist, closed: (bool, bool)) -> Vec<DVec3> {
    let (n, m) = (blend.along_v().len(), blend.along_u().len());
    let mut sums = vec![(DVec3::ZERO, 0.0); n * m];
    let first = |i: usize, j: usize| {
        let (i, j) = (if closed.0 && i + 1 == n { 0 } else { i }, if closed.1 && j + 1 == m { 0 } else { j });
        j * n + i
    };
    for (i, j) in (0..m - 1).flat_map(|j| (0..n - 1).map(move |i| (i, j))) {
        let cell = cell(blend, i, j);
        let area = cell.size.0 * cell.size.1;
        for (a, b) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let twist = match how {
                Twist::Zero => DVec3::ZERO,
                Twist::Adini => cell.adini(a, b),
                Twist::Similar => cell.similar(a, b),
            };
            let sum = &mut sums[first(i + a, j + b)];
            *sum = (sum.0 + twist * area, sum.1 + area);
        }
    }
    let mut all: Vec<DVec3> = (0..n * m).map(|k| sums[first(k % n, k / n)]).map(|(sum, area)| sum / area).collect();
    for j in [0, m - 1].into_iter().filter(|&j| matches!(blend.along_u()[j], Rail::Point(_))) {
        let normal = pole_normal(blend, j);
        all[j * n..(j + 1) * n].iter_mut().for_each(|twist| *twist -= normal * normal.dot(*twist));
    }
    all
}

/// The normal of the tangents at the pole that is curve `j` along u.
fn pole_normal(blend: &Blend, j: usize) -> DVec3 {
    let v = blend.axes().1.nodes[j];
    let side = if j == 0 { OneSided::After } else { OneSided::Before };
    let tangents: Vec<DVec3> = blend.along_v().iter().map(|rail| rail.jet(v, side).d1.normalize_or_zero()).collect();
    tangents.windows(2).map(|w| w[0].cross(w[1])).sum::<DVec3>().normalize_or_zero()
}

/// The cell that begins at node (i, j); derivatives are those inside it.
pub fn cell(blend: &Blend, i: usize, j: usize) -> Cell {
    let (u, v) = blend.axes();
    let sides = [OneSided::After, OneSided::Before];
    let pair = |of: &dyn Fn(usize, usize) -> DVec3| [[of(0, 0), of(0, 1)], [of(1, 0), of(1, 1)]];
    Cell {
        p: pair(&|a, b| blend.corner(i + a, j + b)),
        du: pair(&|a, b| blend.along_u()[j + b].jet(u.nodes[i + a], sides[a]).d1),
        dv: pair(&|a, b| blend.along_v()[i + a].jet(v.nodes[j + b], sides[b]).d1),
        dvv: pair(&|a, b| blend.along_v()[i + a].jet(v.nodes[j + b], sides[b]).d2),
        size: (u.nodes[i + 1] - u.nodes[i], v.nodes[j + 1] - v.nodes[j]),
        poles: [0, 1].map(|b| matches!(blend.along_u()[j + b], Rail::Point(_))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;
    use std::f64::consts::FRAC_PI_2;

    /// The cell between two values of u and of v, from a point with its derivatives ∂u, ∂v and ∂vv.
    fn of(f: impl Fn(f64, f64) -> [DVec3; 4], us: [f64; 2], vs: [f64; 2], poles: [bool; 2]) -> Cell {
        let part = |k: usize| [0, 1].map(|i| [0, 1].map(|j| f(us[i], vs[j])[k]));
        Cell { p: part(0), du: part(1), dv: part(2), dvv: part(3), size: (us[1] - us[0], vs[1] - vs[0]), poles }
    }

    #[test]
    fn adini_is_exact_where_the_coons_patch_is() {
        // Cubic in u, linear in v.
        let f = |u: f64, v: f64| {
            let (square, cube) = (u * u, u * u * u);
            [DVec3::new(u, v, cube * v), DVec3::new(1.0, 0.0, 3.0 * square * v), DVec3::new(0.0, 1.0, cube), DVec3::ZERO]
        };
        let us = [0.2, 0.5];
        let cell = of(f, us, [0.1, 0.9], [false; 2]);
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            assert!(cell.adini(i, j).distance(DVec3::new(0.0, 0.0, 3.0 * us[i] * us[i])) < 1e-14);
        }
    }

    /// Spheres by meridians and circles of latitude: ∂uv is known, also at the pole and where the circle is not the equator.
    #[test]
    fn similar_is_exact_on_surfaces_of_revolution_at_a_pole() {
        let f = |u: f64, v: f64| {
            let (a, b) = (u * FRAC_PI_2, v * FRAC_PI_2);
            let (ca, sa, cb, sb) = (math::cos(a), math::sin(a), math::cos(b), math::sin(b));
            [
                DVec3::new(sb * ca, sb * sa, cb),
                DVec3::new(-sb * sa, sb * ca, 0.0) * FRAC_PI_2,
                DVec3::new(cb * ca, cb * sa, -sb) * FRAC_PI_2,
                DVec3::new(-sb * ca, -sb * sa, -cb) * (FRAC_PI_2 * FRAC_PI_2),
            ]
        };
        let twist = |u: f64, v: f64| {
            let (a, b) = (u * FRAC_PI_2, v * FRAC_PI_2);
            DVec3::new(-math::sin(a), math::cos(a), 0.0) * (math::cos(b) * FRAC_PI_2 * FRAC_PI_2)
        };
        for end in [0.4, 1.0, 1.3] {
            let cell = of(f, [0.0, 0.7], [0.0, end], [true, false]);
            // The same with the pole at the end of v.
            let other = of(|u, v| [f(u, -v)[0], f(u, -v)[1], -f(u, -v)[2], f(u, -v)[3]], [0.0, 0.7], [-end, 0.0], [false, true]);
            for (i, u) in [(0, 0.0), (1, 0.7)] {
                for (j, v) in [(0, 0.0), (1, end)] {
                    assert!(cell.similar(i, j).distance(twist(u, v)) < 1e-14, "{end} {i} {j}: {}", cell.similar(i, j));
                    assert!(other.similar(i, 1 - j).distance(-twist(u, v)) < 1e-14, "{end} {i} {j}: {}", other.similar(i, 1 - j));
                }
            }
        }
    }

    #[test]
    fn both_are_exact_on_bilinear_patches() {
        let f = |u: f64, v: f64| [DVec3::new(u, v, 2.0 * u * v), DVec3::new(1.0, 0.0, 2.0 * v), DVec3::new(0.0, 1.0, 2.0 * u), DVec3::ZERO];
        let cell = of(f, [0.0, 0.3], [0.0, 0.8], [false; 2]);
        for twist in [cell.adini(1, 0), cell.similar(1, 0)] {
            assert!(twist.distance(DVec3::new(0.0, 0.0, 2.0)) < 1e-14, "{twist}");
        }
    }
}
