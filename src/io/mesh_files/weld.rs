//! Equal points made one: what formats without shared nodes need.

use glam::DVec3;

use crate::base::job;

/// The different points in order of first use, and for each given point its place among them.
///
/// Points are equal when their bits are, zero of either sign being one.
pub fn weld(points: &[DVec3]) -> (Vec<DVec3>, Vec<u32>) {
    let bits = |i: u32| (points[i as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by_key(|i| (bits(*i), *i));
    let mut first = vec![0_u32; points.len()];
    for run in order.chunk_by(|a, b| bits(*a) == bits(*b)) {
        job::poll();
        for i in run {
            first[*i as usize] = run[0];
        }
    }
    let mut different = Vec::new();
    let mut places = vec![0_u32; points.len()];
    for i in job::looking(0..points.len()) {
        places[i] = if first[i] as usize == i {
            different.push(points[i] + DVec3::ZERO);
            different.len() as u32 - 1
        } else {
            places[first[i] as usize]
        };
    }
    (different, places)
}
