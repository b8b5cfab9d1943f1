//! Mapped faces with three true sides: a lattice of triangles, or three blocks of quads.

/// Node ids of a lattice: its three sides ascending, and its first inner node.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeIds {
    /// Nodes along v = 0, along the slant (ascending v), along u = 0.
    pub sides: [Vec<u32>; 3],
    /// First inner node; the others follow row by row, u fastest.
    pub first: u32,
}

impl LatticeIds {
    fn n(&self) -> usize {
        self.sides[0].len() - 1
    }

    /// Global node at (i, j), i + j ≤ n.
    pub fn node(&self, i: usize, j: usize) -> u32 {
        let n = self.n();
        if j == 0 {
            self.sides[0][i]
        } else if i == 0 {
            self.sides[2][j]
        } else if i + j == n {
            self.sides[1][j]
        } else {
            // Rows 1 … j − 1 have n − 2, n − 3, … inner nodes.
            let before = (j - 1) * (n - 1) - (j - 1) * j / 2;
            self.first + (before + i - 1) as u32
        }
    }

    /// Inner nodes as (i, j), in the order of their ids.
    pub fn inner(n: usize) -> impl Iterator<Item = (usize, usize)> {
        (1..n).flat_map(move |j| (1..n - j).map(move |i| (i, j)))
    }

    /// Corners (i, j) of the n² triangles, counter-clockwise, row by row.
    pub fn triangles(n: usize) -> impl Iterator<Item = [(usize, usize); 3]> {
        (0..n).flat_map(move |j| {
            (0..n - j).flat_map(move |i| {
                let up = [(i, j), (i + 1, j), (i, j + 1)];
                let down = (i + j + 1 < n).then_some([(i + 1, j), (i + 1, j + 1), (i, j + 1)]);
                std::iter::once(up).chain(down)
            })
        })
    }
}

/// Three grids of quads that meet in one point inside.
///
/// ```text
///        V2            sides a = x + y (v = 0), b = z + x (slant), c = z + y (u = 0):
///       /  \           the block at V0 has x by z quads, that at V1 y by z, that at V2 x by y
///      y    x
///     / \  / \
///    /   +    \
///   z    |     z
///  /     |      \
/// V0--x-----y---V1
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Blocks {
    /// (u, v) of every node: inner ones first in the order of their ids.
    pub uv: Vec<(f64, f64)>,
    /// Number of inner nodes.
    pub inner: usize,
    /// Quads, counter-clockwise in (u, v), by place in `uv`.
    pub quads: Vec<[u32; 4]>,
    /// Places in `uv` of the nodes of the sides, ascending.
    pub sides: [Vec<u32>; 3],
}

impl Blocks {
    /// Divides a triangle with these values along v = 0 (u), the slant (v) and u = 0 (v).
    ///
    /// The numbers of steps have an even sum and each is less than the other two together; `None` otherwise.
    pub fn new(values: &[Vec<f64>; 3]) -> Option<Self> {
        let [a, b, c] = [0, 1, 2].map(|k| values[k].len() - 1);
        if (a + b + c) % 2 != 0 || a >= b + c || b >= a + c || c >= a + b {
            return None;
        }
        let (x, y, z) = ((a + b - c) / 2, (a + c - b) / 2, (b + c - a) / 2);
        let point = |side: usize, n: usize| match side {
            0 => (values[0][n], 0.0),
            1 => (1.0 - values[1][n], values[1][n]),
            _ => (0.0, values[2][n]),
        };
        let feet = [point(0, x), point(1, z), point(2, z)];
        let center = ((feet[0].0 + feet[1].0 + feet[2].0) / 3.0, (feet[0].1 + feet[1].1 + feet[2].1) / 3.0);
        let mut made = BlockMaker { uv: Vec::new() };
        let middle = made.add(center);
        // Spokes from the centre to the splits of the sides, the split left out: z, y and x steps long.
        let spokes = [z, y, x].iter().zip(feet).map(|(n, foot)| made.spoke(middle, center, foot, *n)).collect::<Vec<_>>();
        let inner_before_blocks = made.uv.len();
        let mut blocks = Vec::new();
        let side_count = [a, b, c];
        // Places of side nodes are known only after all inner nodes: marked by their side and number.
        let border = |side: usize, n: usize| BlockCorner::Side(side, n);
        let spoke = |k: usize, n: usize, foot: BlockCorner| spokes[k].get(n).map_or(foot, |p| BlockCorner::Inner(*p));
        let along = |side: usize, from: usize, count: usize, up: bool| -> Vec<BlockCorner> {
            (0..=count).map(|n| border(side, if up { from + n } else { from - n })).collect()
        };
        // Block at V0: bottom x of side 0, left z of side 2; right the spoke to side 0, top the spoke to side 2.
        let (f0, f1, f2) = (border(0, x), border(1, z), border(2, z));
        let reach = |k: usize, count: usize, foot: BlockCorner| -> Vec<BlockCorner> { (0..=count).map(|n| spoke(k, n, foot)).collect() };
        let flip = |mut line: Vec<BlockCorner>| {
            line.reverse();
            line
        };
        blocks.push([along(0, 0, x, true), flip(reach(0, z, f0)), flip(reach(2, x, f2)), along(2, 0, z, true)]);
        // Block at V1: bottom y of side 0 backwards from V1 … drawn with side 1 as its bottom.
        blocks.push([along(1, 0, z, true), flip(reach(1, y, f1)), flip(reach(0, z, f0)), along(0, a, y, false)]);
        // Block at V2: bottom y of side 2 from V2 down, left x of side 1 from V2 down.
        blocks.push([along(2, c, y, false), flip(reach(2, x, f2)), flip(reach(1, y, f1)), along(1, b, x, false)]);
        let uv_of = |made: &BlockMaker, corner: BlockCorner| match corner {
            BlockCorner::Inner(n) => made.uv[n as usize],
            BlockCorner::Side(side, n) => point(side, n),
        };
        let mut quads: Vec<[BlockCorner; 4]> = Vec::new();
        for sides in &blocks {
            made.block(sides, &uv_of, &mut quads);
        }
        debug_assert!(made.uv.len() >= inner_before_blocks);
        Some(made.finish(quads, side_count, &point))
    }
}

/// A node of a block before places are given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum BlockCorner {
    Inner(u32),
    Side(usize, usize),
}

struct BlockMaker {
    uv: Vec<(f64, f64)>,
}

impl BlockMaker {
    fn add(&mut self, uv: (f64, f64)) -> u32 {
        self.uv.push(uv);
        (self.uv.len() - 1) as u32
    }

    /// Nodes of a spoke from the centre on, the foot left out.
    fn spoke(&mut self, middle: u32, center: (f64, f64), foot: (f64, f64), n: usize) -> Vec<u32> {
        let mut nodes = vec![middle];
        for k in 1..n {
            let t = k as f64 / n as f64;
            nodes.push(self.add((center.0 + (foot.0 - center.0) * t, center.1 + (foot.1 - center.1) * t)));
        }
        nodes
    }

    /// One block between bottom, right, top and left (ascending): inner nodes by bilinear blending of the sides.
    fn block(
        &mut self,
        sides: &[Vec<BlockCorner>; 4],
        uv_of: &impl Fn(&Self, BlockCorner) -> (f64, f64),
        quads: &mut Vec<[BlockCorner; 4]>,
    ) {
        let (nu, nv) = (sides[0].len() - 1, sides[1].len() - 1);
        let mut grid = vec![BlockCorner::Inner(0); (nu + 1) * (nv + 1)];
        for j in 0..=nv {
            for i in 0..=nu {
                grid[j * (nu + 1) + i] = if j == 0 {
                    sides[0][i]
                } else if j == nv {
                    sides[2][i]
                } else if i == 0 {
                    sides[3][j]
                } else if i == nu {
                    sides[1][j]
                } else {
                    let (x, y) = (i as f64 / nu as f64, j as f64 / nv as f64);
                    let at = |c: BlockCorner| uv_of(self, c);
                    let [b, r, t, l] = [at(sides[0][i]), at(sides[1][j]), at(sides[2][i]), at(sides[3][j])];
                    let [p00, p10, p11, p01] = [at(sides[0][0]), at(sides[0][nu]), at(sides[2][nu]), at(sides[2][0])];
                    let blend = |f: &dyn Fn((f64, f64)) -> f64| {
                        (1.0 - y) * f(b) + y * f(t) + (1.0 - x) * f(l) + x * f(r)
                            - ((1.0 - x) * (1.0 - y) * f(p00) + x * (1.0 - y) * f(p10) + x * y * f(p11) + (1.0 - x) * y * f(p01))
                    };
                    let uv = (blend(&|p| p.0), blend(&|p| p.1));
                    BlockCorner::Inner(self.add(uv))
                };
            }
        }
        for j in 0..nv {
            for i in 0..nu {
                let at = |i: usize, j: usize| grid[j * (nu + 1) + i];
                quads.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }

    fn finish(mut self, quads: Vec<[BlockCorner; 4]>, counts: [usize; 3], point: &impl Fn(usize, usize) -> (f64, f64)) -> Blocks {
        let inner = self.uv.len();
        let mut sides: [Vec<u32>; 3] = [Vec::new(), Vec::new(), Vec::new()];
        for (side, n) in counts.into_iter().enumerate() {
            for k in 0..=n {
                // Corners belong to two sides and have one place.
                let known = match (side, k) {
                    (1, 0) => sides[0].last().copied(),
                    (2, 0) => sides[0].first().copied(),
                    (2, k) if k == n => sides[1].last().copied(),
                    _ => None,
                };
                let place = known.unwrap_or_else(|| self.add(point(side, k)));
                sides[side].push(place);
            }
        }
        let place = |c: &BlockCorner| match *c {
            BlockCorner::Inner(n) => n,
            BlockCorner::Side(side, n) => sides[side][n],
        };
        let mut quads: Vec<[u32; 4]> = quads.iter().map(|q| [place(&q[0]), place(&q[1]), place(&q[2]), place(&q[3])]).collect();
        for q in &mut quads {
            let p = q.map(|n| self.uv[n as usize]);
            let turn = (p[2].0 - p[0].0) * (p[3].1 - p[1].1) - (p[2].1 - p[0].1) * (p[3].0 - p[1].0);
            if turn < 0.0 {
                q.swap(1, 3);
            }
        }
        Blocks { uv: self.uv, inner, quads, sides }
    }
}

/// (u, v) of all nodes of a lattice in the order of [`Lattice::index`].
pub fn lattice_points(lattice: &Lattice) -> Vec<(f64, f64)> {
    let n = lattice.size();
    (0..=n).flat_map(|j| (0..=n - j).map(move |i| (i, j))).map(|(i, j)| lattice.uv(i, j)).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn even(n: usize) -> Vec<f64> {
        (0..=n).map(|i| i as f64 / n as f64).collect()
    }

    #[test]
    fn inner_ids_count_up() {
        for n in 1..8 {
            let side = vec![0; n + 1];
            let frame = LatticeIds { sides: [side.clone(), side.clone(), side], first: 10 };
            let ids: Vec<u32> = LatticeIds::inner(n).map(|(i, j)| frame.node(i, j)).collect();
            assert_eq!(ids, (10..10 + ids.len() as u32).collect::<Vec<_>>(), "{n}");
            assert_eq!(LatticeIds::triangles(n).count(), n * n);
        }
    }

    #[test]
    fn three_blocks_fill_the_triangle() {
        for [a, b, c] in [[2, 2, 2], [4, 4, 4], [6, 5, 3], [9, 6, 5], [3, 4, 5], [2, 3, 3]] {
            let blocks = Blocks::new(&[even(a), even(b), even(c)]).unwrap();
            let area: f64 = blocks
                .quads
                .iter()
                .map(|q| {
                    let p = q.map(|n| blocks.uv[n as usize]);
                    0.5 * ((p[2].0 - p[0].0) * (p[3].1 - p[1].1) - (p[2].1 - p[0].1) * (p[3].0 - p[1].0))
                })
                .sum();
            assert!((area - 0.5).abs() < 1e-12, "{a} {b} {c}: {area}");
            let mut edges: Vec<(u32, u32)> = blocks.quads.iter().flat_map(|q| (0..4).map(|k| (q[k], q[(k + 1) % 4]))).collect();
            edges.sort_unstable();
            let all = edges.len();
            edges.dedup();
            assert_eq!(edges.len(), all);
            let free = edges.iter().filter(|(p, q)| edges.binary_search(&(*q, *p)).is_err()).count();
            assert_eq!(free, a + b + c, "{a} {b} {c}");
        }
        assert!(Blocks::new(&[even(3), even(3), even(3)]).is_none());
        assert!(Blocks::new(&[even(6), even(3), even(3)]).is_none());
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
