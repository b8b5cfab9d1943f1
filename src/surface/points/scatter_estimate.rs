//! How much gridded points scatter about what is smooth, by third differences along their rows and columns.

use glam::DVec3;

use crate::surface::points::fair_lines::differences;
use crate::surface::points::interpolate::Spans;

/// The median of the absolute value of a normal deviate.
const MEDIAN: f64 = 0.674_489_750_196_081_7;
/// Order of the differences.
const ORDER: usize = 3;

/// The standard deviation of the distances of `rows[j][i]` from a smooth surface, about, and the point farthest off the run of its
/// neighbours; none of fewer than four points a row and a column.
///
/// Of each coordinate the median of the differences over their norm, which a tenth of wrong points hardly changes; of rows and columns
/// what is less, since what is not noise adds.
pub fn scatter(rows: &[Vec<DVec3>], (along, across): &Spans) -> Option<(f64, DVec3)> {
    let columns: Vec<Vec<DVec3>> = (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
    let both = [of_lines(rows, along), of_lines(&columns, across)];
    both.into_iter().flatten().reduce(|a, b| if b.0 < a.0 { b } else { a })
}

fn of_lines(lines: &[Vec<DVec3>], steps: &[f64]) -> Option<(f64, DVec3)> {
    let mut of = [Vec::new(), Vec::new(), Vec::new()];
    let mut farthest: Option<(f64, DVec3)> = None;
    for (from, over) in steps.windows(ORDER).enumerate() {
        let mut stencil = differences(over);
        let norm = stencil.iter().map(|c| c * c).sum::<f64>().sqrt();
        stencil.iter_mut().for_each(|c| *c /= norm);
        let heaviest = (0..=ORDER).fold(0, |best, k| if stencil[k].abs() > stencil[best].abs() { k } else { best });
        for line in lines {
            let off: DVec3 = (0..=ORDER).map(|k| line[from + k] * stencil[k]).sum();
            of.iter_mut().zip(off.abs().to_array()).for_each(|(all, x)| all.push(x));
            if farthest.is_none_or(|(least, _)| off.length() > least) {
                farthest = Some((off.length(), line[from + heaviest]));
            }
        }
    }
    let (_, at) = farthest?;
    let middle = |all: &mut Vec<f64>| {
        let half = all.len() / 2;
        *all.select_nth_unstable_by(half, f64::total_cmp).1 / MEDIAN
    };
    Some((of.iter_mut().map(|all| middle(all) * middle(all)).sum::<f64>().sqrt(), at))
}
