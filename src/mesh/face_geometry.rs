//! Where the nodes of a mapped face lie in (u, v): a grid between four divided sides, or a lattice between three.

use glam::DVec3;

use super::faces::Frame;
use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::surface::Surface;

/// Rows of nodes that one thread takes at a time.
const ROWS: usize = 16;

/// A grid of `nu × nv` cells over a rectangle of (u, v).
///
/// Node (i, j) is where the straight line between the i-th points of the sides v = min and v = max meets the one between
/// the j-th points of u = min and u = max. Lines of one family do not cross, so no cell folds.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Range of u.
    pub u: (f64, f64),
    /// Range of v.
    pub v: (f64, f64),
    /// Shares 0…1 of the range at the nodes of the sides v = min, u = max, v = max, u = min.
    pub sides: [Vec<f64>; 4],
    /// Opposite shares agree in u (first), in v (second).
    pub straight: (bool, bool),
}

impl Grid {
    /// A grid between four sides given by their values of u or v, ascending.
    pub fn new(u: (f64, f64), v: (f64, f64), sides: [Vec<f64>; 4], tolerance: &Tolerance) -> Self {
        let share = |values: &[f64], (low, high): (f64, f64)| values.iter().map(|x| (x - low) / (high - low)).collect::<Vec<f64>>();
        let [a, b, c, d] = sides;
        let mut sides = [share(&a, u), share(&b, v), share(&c, u), share(&d, v)];
        let mut even = |k: usize| {
            let same = sides[k].iter().zip(&sides[k + 2]).all(|(x, y)| (x - y).abs() <= tolerance.parameter);
            if same {
                sides[k + 2] = sides[k].clone();
            }
            same
        };
        let straight = (even(0), even(1));
        Self { u, v, sides, straight }
    }

    /// Cells along u and along v.
    pub fn size(&self) -> (usize, usize) {
        (self.sides[0].len() - 1, self.sides[1].len() - 1)
    }

    /// (u, v) of node (i, j).
    pub fn uv(&self, i: usize, j: usize) -> (f64, f64) {
        let (bottom, top) = (self.sides[0][i], self.sides[2][i]);
        let (left, right) = (self.sides[3][j], self.sides[1][j]);
        let (lean_u, lean_v) = (top - bottom, right - left);
        let y = (left + lean_v * bottom) / (1.0 - lean_v * lean_u);
        self.at(bottom + lean_u * y, y)
    }

    /// (u, v) at shares of the ranges.
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.u.0 + (self.u.1 - self.u.0) * x, self.v.0 + (self.v.1 - self.v.0) * y)
    }

    /// Points at the inner nodes, row by row, u fastest.
    pub fn inner_points(&self, surface: &Surface, out: &mut [DVec3]) {
        let (nu, nv) = self.size();
        if nu < 2 || nv < 2 {
            return;
        }
        let width = nu - 1;
        if self.straight == (true, true) {
            // One call: the surface evaluates each of its curves once and shares the rows out itself.
            self.rows(surface, 1, out);
            return;
        }
        par::chunks_mut(out, width * ROWS, |chunk, part| {
            let first = 1 + chunk * ROWS;
            self.rows(surface, first, part);
        });
    }

    /// Rows of inner nodes from row `first` on.
    fn rows(&self, surface: &Surface, first: usize, out: &mut [DVec3]) {
        let width = self.size().0 - 1;
        let rows = out.len() / width;
        if self.straight == (true, true) {
            let us: Vec<f64> = (1..=width).map(|i| self.uv(i, 0).0).collect();
            let vs: Vec<f64> = (first..first + rows).map(|j| self.uv(0, j).1).collect();
            surface.grid(&us, &vs, out);
            return;
        }
        for (row, j) in out.chunks_mut(width).zip(first..) {
            if self.straight.1 {
                let us: Vec<f64> = (1..=width).map(|i| self.uv(i, j).0).collect();
                surface.grid(&us, &[self.uv(0, j).1], row);
            } else {
                for (p, i) in row.iter_mut().zip(1..) {
                    let (u, v) = self.uv(i, j);
                    *p = surface.point(u, v);
                }
            }
        }
    }

    /// Points in the middle of the cells of row `j`.
    pub fn centers(&self, surface: &Surface, j: usize) -> Vec<DVec3> {
        let nu = self.size().0;
        let mut out = vec![DVec3::ZERO; nu];
        let middle = |i: usize| {
            let corners = [self.uv(i, j), self.uv(i + 1, j), self.uv(i + 1, j + 1), self.uv(i, j + 1)];
            let sum = corners.iter().fold((0.0, 0.0), |s, c| (s.0 + c.0, s.1 + c.1));
            (0.25 * sum.0, 0.25 * sum.1)
        };
        if self.straight.1 {
            let us: Vec<f64> = (0..nu).map(|i| middle(i).0).collect();
            surface.grid(&us, &[middle(0).1], &mut out);
        } else {
            for (i, p) in out.iter_mut().enumerate() {
                let (u, v) = middle(i);
                *p = surface.point(u, v);
            }
        }
        out
    }
}

/// A triangle of u, v ≥ 0, u + v ≤ 1 whose three sides are divided into `n` steps each.
///
/// Node (i, j), i + j ≤ n, is the transfinite blend of its three side points in the plane [Barnhill, Birkhoff & Gordon 1973].
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Values of u along v = 0, of v along the slant, of v along u = 0, ascending 0…1.
    pub sides: [Vec<f64>; 3],
}

impl Lattice {
    /// Steps along each side.
    pub fn size(&self) -> usize {
        self.sides[0].len() - 1
    }

    /// (u, v) of node (i, j).
    pub fn uv(&self, i: usize, j: usize) -> (f64, f64) {
        let n = self.size();
        let k = n - i - j;
        if j == 0 {
            return (self.sides[0][i], 0.0);
        }
        if i == 0 {
            return (0.0, self.sides[2][j]);
        }
        if k == 0 {
            return (1.0 - self.sides[1][j], self.sides[1][j]);
        }
        let weight = |x: usize| x as f64 / n as f64;
        let (l0, l1, l2) = (weight(k), weight(i), weight(j));
        let bottom = |x: usize| (self.sides[0][x], 0.0);
        let slant = |x: usize| (1.0 - self.sides[1][x], self.sides[1][x]);
        let left = |x: usize| (0.0, self.sides[2][x]);
        // Each P is the blend of two sides along lines of constant weight of one corner.
        let mix = |a: (f64, f64), wa: f64, b: (f64, f64), wb: f64| ((a.0 * wa + b.0 * wb) / (wa + wb), (a.1 * wa + b.1 * wb) / (wa + wb));
        let p0 = mix(left(i + j), l2, bottom(i + j), l1);
        let p1 = mix(slant(j + k), l2, bottom(i), l0);
        let p2 = mix(slant(j), l1, left(j), l0);
        let flat = (l1, l2);
        // Side points with the weight of the corner opposite: corner 1 keeps l1 on the slant at v = 1 − l1.
        (0.5 * (p0.0 + p1.0 + p2.0 - flat.0), 0.5 * (p0.1 + p1.1 + p2.1 - flat.1))
    }

    /// Place of node (i, j) among all nodes, row by row.
    pub fn index(&self, i: usize, j: usize) -> usize {
        let n = self.size();
        j * (n + 1) - j * j.saturating_sub(1) / 2 + i
    }
}

/// FaceGeometries of the faces of a mesh, in the order of its faces; they ride along for measuring and never decide whether two
/// meshes are equal.
#[derive(Clone, Debug, Default)]
pub struct FaceGeometries(pub Vec<FaceGeometry>);

impl PartialEq for FaceGeometries {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// One face of a mesh on its surface.
#[derive(Clone, Debug)]
pub struct FaceGeometry {
    /// The surface.
    pub surface: Surface,
    /// Where its nodes lie.
    pub shape: Shape,
    /// Which nodes of the mesh they are.
    pub frame: Frame,
    /// The other side is up.
    pub flipped: bool,
}

impl FaceGeometry {
    /// The same face in a mesh where its nodes come `by` later.
    pub fn shifted(mut self, by: u32) -> Self {
        self.frame.shift(by);
        self
    }
}

/// How a face is divided.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One grid.
    Grid(Grid),
    /// One lattice of triangles.
    Lattice(Lattice),
    /// Three grids of quads that meet inside a triangle, by the (u, v) of their nodes.
    Blocks(super::trilateral::Blocks),
    /// Elements that no map gave, by the (u, v) of their nodes.
    Free(Free),
}

/// Triangles and quads over (u, v): nodes of the border first, then inner ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Free {
    /// Places of the nodes.
    pub uv: Vec<(f64, f64)>,
    /// Number of border nodes; some may be one node of the mesh in two places (a seam).
    pub border: usize,
    /// Corners of the triangles, counter-clockwise in (u, v).
    pub triangles: Vec<[u32; 3]>,
    /// Corners of the quads, counter-clockwise in (u, v).
    pub quads: Vec<[u32; 4]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(sides: [Vec<f64>; 4]) -> Grid {
        Grid::new((2.0, 4.0), (0.0, 1.0), sides, &Tolerance::new(1e-6, 1.0))
    }

    #[test]
    fn grid_meets_its_sides_and_keeps_order() {
        let even = |a: f64, b: f64, n: u32| (0..=n).map(|i| a + (b - a) * f64::from(i) / f64::from(n)).collect::<Vec<f64>>();
        let bent = |a: f64, b: f64, n: u32| (0..=n).map(|i| a + (b - a) * f64::from(i * i) / f64::from(n * n)).collect::<Vec<f64>>();
        let g = grid([even(2.0, 4.0, 5), even(0.0, 1.0, 3), bent(2.0, 4.0, 5), bent(0.0, 1.0, 3)]);
        assert_eq!(g.straight, (false, false));
        for i in 0..=5 {
            assert!((g.uv(i, 0).0 - (2.0 + 2.0 * g.sides[0][i])).abs() < 1e-15 && g.uv(i, 0).1.abs() < 1e-15);
            assert!((g.uv(i, 3).0 - (2.0 + 2.0 * g.sides[2][i])).abs() < 1e-15 && (g.uv(i, 3).1 - 1.0).abs() < 1e-15);
        }
        let cross = |a: (f64, f64), b: (f64, f64), c: (f64, f64)| (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
        for j in 0..3 {
            for i in 0..5 {
                assert!(cross(g.uv(i, j), g.uv(i + 1, j), g.uv(i, j + 1)) > 0.0, "{i} {j}");
            }
        }
    }

    #[test]
    fn even_lattice_is_regular_and_borders_are_met() {
        let even: Vec<f64> = (0..=6).map(|i| f64::from(i) / 6.0).collect();
        let l = Lattice { sides: [even.clone(), even.clone(), even] };
        for j in 0..=6 {
            for i in 0..=6 - j {
                let (u, v) = l.uv(i, j);
                assert!((u - i as f64 / 6.0).abs() < 1e-15 && (v - j as f64 / 6.0).abs() < 1e-15, "{i} {j}: {u} {v}");
            }
        }
        let mut all: Vec<usize> = (0..=6).flat_map(|j| (0..=6 - j).map(move |i| (i, j))).map(|(i, j)| l.index(i, j)).collect();
        all.sort_unstable();
        assert!(all.iter().enumerate().all(|(n, k)| n == *k));
    }
}
