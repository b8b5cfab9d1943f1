//! Gradients at scattered points: at each point the quadratic that comes nearest to its neighbours and theirs, weighted by distance
//! (local least squares [Lawson 1977; Franke & Nielson 1980]).
//!
//! Second derivatives are damped (Tikhonov), and the damped step is repeated: what the neighbours determine well is found to
//! rounding, so that quadratics are reproduced; what they determine badly stays small, and planes are reproduced always.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::{DAMPED_BENDS, DAMPED_SLOPES};

/// Repetitions.
const TURNS: usize = 16;
/// Neighbours wanted: as many as a quadratic has coefficients, and some more.
const WANTED: usize = 8;
/// Rings of neighbours at most.
const RINGS: usize = 4;
/// Share of the mean distance below which nearer neighbours weigh no more.
const NEAR: f64 = 0.5;

type SlopeRow = [f64; 5];

/// The gradient of the height (z over x and y) at each point; `triangles` join them.
pub fn slopes(points: &[DVec3], triangles: &[[usize; 3]]) -> Vec<DVec2> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for t in triangles {
        for k in 0..3 {
            beside[t[k]].extend([t[(k + 1) % 3], t[(k + 2) % 3]]);
        }
    }
    for list in &mut beside {
        list.sort_unstable();
        list.dedup();
    }
    (0..points.len()).map(|k| slope(points, k, &around(&beside, k))).collect()
}

/// The neighbours of a point and theirs, and more while they are few.
fn around(beside: &[Vec<usize>], k: usize) -> Vec<usize> {
    let mut found = beside[k].clone();
    for ring in 1..RINGS {
        if ring > 1 && found.len() >= WANTED {
            break;
        }
        found = found.iter().flat_map(|n| beside[*n].iter().copied()).chain(found.iter().copied()).filter(|n| *n != k).collect();
        found.sort_unstable();
        found.dedup();
    }
    found
}

fn slope(points: &[DVec3], k: usize, near: &[usize]) -> DVec2 {
    job::poll();
    let arms: Vec<DVec3> = near.iter().map(|n| points[*n] - points[k]).collect();
    let unit = arms.iter().map(|d| d.truncate().length()).sum::<f64>() / arms.len().max(1) as f64;
    if unit <= 0.0 {
        return DVec2::ZERO;
    }
    let mut rows: Vec<(SlopeRow, f64)> = arms
        .iter()
        .map(|arm| {
            let d = arm.truncate() / unit;
            let weight = 1.0 / (NEAR * NEAR + d.length_squared());
            // √2 with the mixed derivative: the damping is the same in all directions.
            let row = [d.x, d.y, 0.5 * d.x * d.x, std::f64::consts::FRAC_1_SQRT_2 * d.x * d.y, 0.5 * d.y * d.y];
            (row.map(|x| x * weight), arm.z * weight)
        })
        .collect();
    // Planes first, and to rounding: what is left over is for the quadratic.
    let mut sum = DVec2::ZERO;
    for _ in 0..2 {
        let step = level(&rows);
        rows.iter_mut().for_each(|(row, rest)| *rest -= row[0] * step.x + row[1] * step.y);
        sum += step;
    }
    let total = rows.iter().flat_map(|(row, _)| row).map(|x| x * x).sum::<f64>();
    let mut normal = [[0.0; 5]; 5];
    for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
        normal[i][j] = rows.iter().map(|(row, _)| row[i] * row[j]).sum::<f64>();
        if i == j {
            normal[i][j] += total * if i < 2 { DAMPED_SLOPES } else { DAMPED_BENDS };
        }
    }
    let Some(factor) = cholesky(normal) else { return sum / unit };
    for _ in 0..TURNS {
        let right = [0, 1, 2, 3, 4].map(|i| rows.iter().map(|(row, rest)| row[i] * rest).sum::<f64>());
        let step = solved(&factor, right);
        for (row, rest) in &mut rows {
            *rest -= (0..5).map(|i| row[i] * step[i]).sum::<f64>();
        }
        sum += DVec2::new(step[0], step[1]);
    }
    sum / unit
}

/// The linear part of the nearest plane through the origin.
fn level(rows: &[(SlopeRow, f64)]) -> DVec2 {
    let of = |f: &dyn Fn(&(SlopeRow, f64)) -> f64| rows.iter().map(f).sum::<f64>();
    let x2 = of(&|(row, _)| row[0] * row[0]);
    if x2 <= 0.0 {
        let y2 = of(&|(row, _)| row[1] * row[1]);
        return if y2 > 0.0 { DVec2::Y * (of(&|(row, rest)| row[1] * rest) / y2) } else { DVec2::ZERO };
    }
    // The second column without what it has of the first.
    let share = of(&|(row, _)| row[0] * row[1]) / x2;
    let aside = |row: &SlopeRow| row[1] - share * row[0];
    let y2 = of(&|(row, _)| aside(row) * aside(row));
    let y = if y2 > 0.0 { of(&|(row, rest)| aside(row) * rest) / y2 } else { 0.0 };
    DVec2::new(of(&|(row, rest)| row[0] * rest) / x2 - share * y, y)
}

/// The lower factor of a symmetric positive matrix.
fn cholesky(a: [SlopeRow; 5]) -> Option<[SlopeRow; 5]> {
    let mut l = [[0.0; 5]; 5];
    for i in 0..5 {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                if rest <= 0.0 {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    Some(l)
}

fn solved(l: &[SlopeRow; 5], mut b: SlopeRow) -> SlopeRow {
    for i in 0..5 {
        b[i] = (b[i] - (0..i).map(|k| l[i][k] * b[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..5).rev() {
        b[i] = (b[i] - (i + 1..5).map(|k| l[k][i] * b[k]).sum::<f64>()) / l[i][i];
    }
    b
}
