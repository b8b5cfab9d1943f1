//! Triangles of a mesh as the outside of a body, in blocks with boxes and integrals: only the blocks that the water plane crosses are
//! looked at one by one, and clipped exactly.

use glam::DVec3;

use super::sums::{WET, WHOLE, Wet, wet_densities, wet_of_whole, whole_densities};
use super::water::Water;
use crate::base::bbox::Box3;
use crate::base::job;

/// Triangles of a block.
const BLOCK: usize = 64;

/// The triangles of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Corners, model units.
    pub nodes: Vec<DVec3>,
    /// Places of the corners, counter-clockwise seen from outside.
    pub corners: Vec<[u32; 3]>,
    blocks: Vec<Block>,
}

#[derive(Clone, Debug)]
struct Block {
    bounds: Box3,
    sums: [f64; WHOLE],
}

/// Adds a density over a triangle: the rule of the middles of the sides is exact for what is quadratic.
fn add_triangle<const N: usize>([a, b, c]: [DVec3; 3], density: &impl Fn(DVec3, DVec3) -> [f64; N], sum: &mut [f64; N]) {
    let n = 0.5 * (b - a).cross(c - a);
    for middle in [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)] {
        let value = density(middle, n);
        (0..N).for_each(|k| sum[k] += value[k] / 3.0);
    }
}

impl Triangles {
    /// Triangles of a body about a centre.
    pub fn new(nodes: Vec<DVec3>, corners: Vec<[u32; 3]>, about: DVec3) -> Self {
        let mut made = Self { nodes, corners, blocks: Vec::new() };
        let density = |p: DVec3, n: DVec3| whole_densities(p - about, n);
        for block in made.corners.chunks(BLOCK) {
            job::poll();
            let (mut sums, mut bounds) = ([0.0; WHOLE], Box3::EMPTY);
            for corners in block {
                let corners = corners.map(|k| made.nodes[k as usize]);
                bounds = bounds.union(Box3::of(corners));
                add_triangle(corners, &density, &mut sums);
            }
            made.blocks.push(Block { bounds, sums });
        }
        made
    }

    /// Sums over all triangles.
    pub fn whole(&self) -> [f64; WHOLE] {
        self.blocks.iter().fold([0.0; WHOLE], |sum, block| std::array::from_fn(|k| sum[k] + block.sums[k]))
    }

    /// Adds what is below the water; heights up to `none` count as none.
    pub fn add_wet(&self, water: &Water, about: DVec3, none: f64, to: &mut Wet) {
        let density = |p: DVec3, n: DVec3| wet_densities(water, p, n);
        for (block, corners) in self.blocks.iter().zip(self.corners.chunks(BLOCK)) {
            let (middle, half) = (block.bounds.center(), 0.5 * (block.bounds.max - block.bounds.min));
            let (height, reach) = (water.height(middle), water.up.abs().dot(half));
            if height - reach >= -none {
                continue;
            }
            if height + reach <= none {
                to.add(&wet_of_whole(&block.sums, about, water), &[0.0; WET]);
                continue;
            }
            let mut sum = [0.0; WET];
            for triangle in corners {
                let triangle = triangle.map(|k| self.nodes[k as usize]);
                let (part, count) = clipped(triangle, &|p| water.height(p), none);
                for k in 2..count {
                    add_triangle([part[0], part[k - 1], part[k]], &density, &mut sum);
                }
            }
            to.add(&sum, &[0.0; WET]);
        }
    }

    /// The segments in which a plane crosses the triangles, by the height over it.
    pub fn segments(&self, height: &impl Fn(DVec3) -> f64, mut each: impl FnMut(DVec3, DVec3, DVec3)) {
        for triangle in &self.corners {
            let corners = triangle.map(|k| self.nodes[k as usize]);
            let heights = corners.map(height);
            let mut ends = [DVec3::ZERO; 2];
            let mut count = 0;
            for k in 0..3 {
                let (a, b) = (heights[k], heights[(k + 1) % 3]);
                if (a < 0.0) != (b < 0.0) && count < 2 {
                    ends[count] = corners[k] + (corners[(k + 1) % 3] - corners[k]) * (a / (a - b));
                    count += 1;
                }
            }
            if count == 2 {
                each(ends[0], ends[1], (corners[1] - corners[0]).cross(corners[2] - corners[0]));
            }
        }
    }
}

/// Sides of one triangle alone, in the order of their nodes.
pub fn free_sides(corners: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut sides: Vec<[u32; 2]> =
        corners.iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
    job::sort(&mut sides);
    sides.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}

/// The part of a triangle with negative height as a polygon of so many corners.
fn clipped(corners: [DVec3; 3], height: &impl Fn(DVec3) -> f64, none: f64) -> ([DVec3; 4], usize) {
    let heights = corners.map(height).map(|h| if h.abs() <= none { 0.0 } else { h });
    let (mut part, mut count) = ([DVec3::ZERO; 4], 0);
    if heights.iter().all(|h| *h >= 0.0) {
        return (part, 0);
    }
    for k in 0..3 {
        let next = (k + 1) % 3;
        let (a, b) = (heights[k], heights[next]);
        if a <= 0.0 {
            part[count] = corners[k];
            count += 1;
        }
        if a * b < 0.0 {
            part[count] = corners[k] + (corners[next] - corners[k]) * (a / (a - b));
            count += 1;
        }
    }
    (part, count)
}
