//! Mapped faces with four sides, of which some may be poles: the places of a grid, its nodes, and its quads or triangles.

use glam::DVec3;

use crate::base::par;
use crate::base::tolerance::Tolerance;
use crate::mesh::request::methods::Elements;
use crate::surface::Surface;

/// Rows of cells that one thread takes at a time.
const ROWS_AT_ONCE: usize = 16;

/// Global node ids of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridIds {
    /// Nodes of the sides v = min, u = max, v = max, u = min, ascending; at a pole all the same.
    pub sides: [Vec<u32>; 4],
    /// Which sides are poles.
    pub poles: [bool; 4],
    /// First inner node; the others follow row by row, u fastest.
    pub first: u32,
}

/// One cell: corners counter-clockwise from (i, j), `None` for a corner that a pole takes away.
enum GridCell {
    Quad([u32; 4]),
    /// Three corners counter-clockwise.
    Triangle([u32; 3]),
}

impl GridIds {
    /// Cells along u and along v.
    pub fn size(&self) -> (usize, usize) {
        (self.sides[0].len() - 1, self.sides[1].len() - 1)
    }

    /// Global node at (i, j).
    pub fn node(&self, i: usize, j: usize) -> u32 {
        let (nu, nv) = self.size();
        if j == 0 {
            self.sides[0][i]
        } else if j == nv {
            self.sides[2][i]
        } else if i == 0 {
            self.sides[3][j]
        } else if i == nu {
            self.sides[1][j]
        } else {
            self.first + ((j - 1) * (nu - 1) + i - 1) as u32
        }
    }

    /// Number of inner nodes.
    pub fn inner(&self) -> u64 {
        let (nu, nv) = self.size();
        (nu as u64 - 1) * (nv as u64 - 1)
    }

    /// Triangles and quads that the grid makes.
    pub fn elements(&self, kind: Elements) -> (u64, u64) {
        let (nu, nv) = (self.size().0 as u64, self.size().1 as u64);
        let at_poles =
            nu * (u64::from(self.poles[0]) + u64::from(self.poles[2])) + nv * (u64::from(self.poles[1]) + u64::from(self.poles[3]));
        let quads = nu * nv - at_poles;
        if kind == Elements::Triangles { (at_poles + 2 * quads, 0) } else { (at_poles, quads) }
    }

    fn cell(&self, i: usize, j: usize) -> GridCell {
        let (nu, nv) = self.size();
        let [a, b, c, d] = [self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)];
        if self.poles[0] && j == 0 || self.poles[1] && i + 1 == nu {
            // The side a–b or b–c is one point.
            GridCell::Triangle(if self.poles[0] && j == 0 { [a, c, d] } else { [a, b, d] })
        } else if self.poles[2] && j + 1 == nv || self.poles[3] && i == 0 {
            GridCell::Triangle([a, b, c])
        } else {
            GridCell::Quad([a, b, c, d])
        }
    }
}

/// Writes the elements of a grid; `diagonals` (triangles only) has one entry a cell: `true` joins (i + 1, j) and (i, j + 1).
pub fn fill(frame: &GridIds, kind: Elements, flipped: bool, diagonals: &[bool], triangles: &mut [[u32; 3]], quads: &mut [[u32; 4]]) {
    let (nu, nv) = frame.size();
    if kind != Elements::Triangles && frame.poles == [false; 4] {
        quad_rows(frame, flipped, quads);
        return;
    }
    let (mut triangle, mut quad) = (triangles.iter_mut(), quads.iter_mut());
    let mut put = |t: [u32; 3]| {
        if let Some(slot) = triangle.next() {
            *slot = if flipped { [t[0], t[2], t[1]] } else { t };
        }
    };
    for j in 0..nv {
        for i in 0..nu {
            match frame.cell(i, j) {
                GridCell::Triangle(t) => put(t),
                GridCell::Quad([a, b, c, d]) if kind == Elements::Triangles => {
                    if diagonals[j * nu + i] {
                        put([a, b, d]);
                        put([b, c, d]);
                    } else {
                        put([a, b, c]);
                        put([a, c, d]);
                    }
                }
                GridCell::Quad(q) => {
                    if let Some(slot) = quad.next() {
                        *slot = turned(q, flipped);
                    }
                }
            }
        }
    }
}

fn turned([a, b, c, d]: [u32; 4], flipped: bool) -> [u32; 4] {
    if flipped { [a, d, c, b] } else { [a, b, c, d] }
}

/// All cells as quads, from two rows of node ids at a time.
fn quad_rows(frame: &GridIds, flipped: bool, quads: &mut [[u32; 4]]) {
    let nu = frame.size().0;
    par::chunks_mut(quads, nu * ROWS_AT_ONCE, |chunk, part| {
        let first = chunk * ROWS_AT_ONCE;
        let row = |j: usize| (0..=nu).map(|i| frame.node(i, j)).collect::<Vec<u32>>();
        let mut below = row(first);
        for (line, j) in part.chunks_mut(nu).zip(first..) {
            let above = row(j + 1);
            for ((slot, low), high) in line.iter_mut().zip(below.windows(2)).zip(above.windows(2)) {
                *slot = turned([low[0], low[1], high[1], high[0]], flipped);
            }
            below = above;
        }
    });
}

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
        par::chunks_mut(out, width * ROWS_AT_ONCE, |chunk, part| {
            let first = 1 + chunk * ROWS_AT_ONCE;
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

/// First triangle of each row of cells of a grid meshed with triangles; empty for quads.
pub fn triangle_rows(frame: &GridIds, triangles: bool) -> Vec<usize> {
    let (nu, nv) = frame.size();
    if !triangles {
        return Vec::new();
    }
    let mut starts = vec![0];
    for j in 0..nv {
        let pole_row = frame.poles[0] && j == 0 || frame.poles[2] && j + 1 == nv;
        let at_flanks = usize::from(frame.poles[1]) + usize::from(frame.poles[3]);
        starts.push(starts[j] + if pole_row { nu } else { 2 * nu - at_flanks });
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(nu: u32, nv: u32, poles: [bool; 4]) -> GridIds {
        let id = |i: u32, j: u32| {
            let (i, j) = (if poles[3] && i == 0 || poles[1] && i == nu { 0 } else { i }, j);
            let i = if poles[0] && j == 0 || poles[2] && j == nv { 0 } else { i };
            let j = if poles[3] && i == 0 || poles[1] && i == nu { 0 } else { j };
            1000 * j + i
        };
        let sides = [
            (0..=nu).map(|i| id(i, 0)).collect(),
            (0..=nv).map(|j| id(nu, j)).collect(),
            (0..=nu).map(|i| id(i, nv)).collect(),
            (0..=nv).map(|j| id(0, j)).collect(),
        ];
        GridIds { sides, poles, first: 100_000 }
    }

    fn made(frame: &GridIds, kind: Elements) -> (Vec<[u32; 3]>, Vec<[u32; 4]>) {
        let (t, q) = frame.elements(kind);
        let (mut triangles, mut quads) = (vec![[u32::MAX; 3]; t as usize], vec![[u32::MAX; 4]; q as usize]);
        let n = frame.size().0 * frame.size().1;
        fill(frame, kind, false, &vec![false; n], &mut triangles, &mut quads);
        (triangles, quads)
    }

    #[test]
    fn counts_are_those_written() {
        for poles in [[false; 4], [true, false, false, false], [true, false, true, false], [false, true, false, true]] {
            for kind in [Elements::Triangles, Elements::Quads] {
                let frame = frame(5, 4, poles);
                let (triangles, quads) = made(&frame, kind);
                assert!(triangles.iter().flatten().chain(quads.iter().flatten()).all(|n| *n != u32::MAX), "{poles:?}");
                // No element uses a node twice: poles make triangles.
                assert!(triangles.iter().all(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]), "{poles:?} {triangles:?}");
            }
        }
    }

    #[test]
    fn inner_edges_are_used_once_each_way() {
        let frame = frame(6, 3, [true, false, false, false]);
        let (triangles, _) = made(&frame, Elements::Triangles);
        let mut edges: Vec<(u32, u32)> = triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]).collect();
        let all = edges.len();
        edges.sort_unstable();
        edges.dedup();
        assert_eq!(edges.len(), all, "an edge is used twice in one sense");
        let free = edges.iter().filter(|(a, b)| edges.binary_search(&(*b, *a)).is_err()).count();
        assert_eq!(free, 6 + 2 * 3, "the side without a pole and two flanks");
    }

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
}
