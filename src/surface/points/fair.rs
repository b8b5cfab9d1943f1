//! Fairing of measured points: no point moves farther than stated, and the run of their rows and columns has the least energy.
//!
//! The energy is the integral of a squared derivative, the third where nothing else is said, over chord lengths whose mean step along
//! each line is 1 [Farin 2002]; of rows the sum of both directions. Lines are parted at corners.

use glam::DVec3;

use crate::base::fault::{Fault, Result, ValueFault};
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{EPSILON, FAIR_ROW, FAIR_ROWS, Tolerance};
use crate::geometry::construct::build::finite_points;
use crate::geometry::construct::spline::Spacing;
use crate::geometry::data::fault::CurveFault;
use crate::surface::faults::PointsFault;
use crate::surface::points::fair_lines::Lines;
use crate::surface::points::fair_rest::{AtRest, Enough, at_rest};

/// Rounds of the search at most, of one row and of several.
const ROUNDS: [usize; 2] = [20_000, 1_000];
/// A point is doubtful that stands off its neighbours by this many times the middle point …
const ODD: f64 = 8.0;
/// … and by this many times what it may move.
const BEYOND: f64 = 2.0;

/// Which points stay where they were measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// The ends of a row and its corners; the four corners of rows.
    Ends,
    /// All points of the border of rows.
    Borders,
    /// None.
    None,
}

/// Settings of [`fair`].
#[derive(Clone, Debug, PartialEq)]
pub struct Fairing {
    /// How far a point may move, model units, above 0.
    pub within: f64,
    /// Which points stay.
    pub held: Held,
    /// Order of the derivative, 2 to [`MOST_ORDER`](crate::surface::points::fair_lines::MOST_ORDER); less where a line has too few points.
    pub order: usize,
    /// Spacing of the parameters.
    pub spacing: Spacing,
    /// Lines are parted where they turn by more, radians.
    pub kinks: Option<f64>,
    /// Places along the rows at which these are parted.
    pub corners: Vec<usize>,
    /// Points move along this unit vector alone.
    pub along: Option<DVec3>,
}

/// Points that were faired, row by row, and what it took.
#[derive(Clone, Debug)]
pub struct Faired {
    /// The points.
    pub points: Vec<DVec3>,
    /// How far each moved.
    pub moved: Vec<f64>,
    /// How many stand as far from where they were measured as they may.
    pub limited: usize,
    /// Of these the one, by its number, that stood farthest off the run of its neighbours, and how far about.
    pub outlier: Option<(usize, f64)>,
    /// The root of the mean square of all differences (derivatives for a mean step of 1), before and after.
    pub rough: [f64; 2],
    /// No points within reach have an energy that is lower by more than this share of the energy before.
    pub gap: f64,
}

/// Moves `rows[j][i]`, one row or several of one length, to where they are fairest. Warnings too (W679).
///
/// A border row or column that is one point is a pole and stays. Fails with E402 where no line has three points, E306 for rows of
/// different length or a corner that is not inside of them, E403 where two neighbours are one.
pub fn fair(rows: &[Vec<DVec3>], how: &Fairing, origin: Origin, tolerance: &Tolerance) -> Result<(Faired, Vec<Fault>)> {
    let counts = (rows.first().map_or(0, Vec::len), rows.len());
    check(rows, counts, how, origin)?;
    let points = rows.concat();
    finite_points(&points, origin)?;
    let mut reach = reach(&points, counts, how);
    let mut directions = vec![lines(&points, counts, true, how, &mut reach, (origin, tolerance))?];
    if counts.1 > 1 {
        directions.push(lines(&points, counts, false, how, &mut reach, (origin, tolerance))?);
    }
    directions.retain(|lines| lines.differences() > 0);
    let differences: usize = directions.iter().map(Lines::differences).sum();
    let rough = |lines: &[Lines], points: &[DVec3]| (lines.iter().map(|l| l.energy(points)).sum::<f64>() / differences as f64).sqrt();
    let measured = rough(&directions, &points);
    let sought: Vec<DVec3> = how.along.map_or_else(|| points.clone(), |a| points.iter().map(|p| a * a.dot(*p)).collect());
    let enough = if counts.1 > 1 { Enough { gap: FAIR_ROWS, rounds: ROUNDS[1] } } else { Enough { gap: FAIR_ROW, rounds: ROUNDS[0] } };
    let (rest, directions) = at_rest(&sought, &reach, directions, enough);
    let faired: Vec<DVec3> = points.iter().zip(&rest.moves).map(|(p, d)| *p + *d).collect();
    let rough = [measured, rough(&directions, &faired).min(measured)];
    let moved: Vec<f64> = rest.moves.iter().map(|d| d.length()).collect();
    let at_limit: Vec<usize> = (0..moved.len()).filter(|i| reach[*i] > 0.0 && moved[*i] >= reach[*i] * (1.0 - EPSILON.sqrt())).collect();
    let outlier = at_limit.iter().map(|i| (*i, rest.off[*i])).reduce(|best, next| if next.1 > best.1 { next } else { best });
    let note = outlier.filter(|(_, off)| is_odd(*off, &rest, how.within)).map(|(i, off)| {
        let (row, place) = (i / counts.0, i % counts.0);
        PointsFault::Outlier { row: (counts.1 > 1).then_some(row), place, at: points[i], off, within: how.within }.into()
    });
    Ok((Faired { points: faired, moved, limited: at_limit.len(), outlier, rough, gap: rest.gap }, note.into_iter().collect()))
}

/// Whether a point stands off much farther than the others and than it may move.
fn is_odd(off: f64, rest: &AtRest, within: f64) -> bool {
    let mut all = rest.off.clone();
    let half = all.len() / 2;
    let (_, middle, _) = all.select_nth_unstable_by(half, f64::total_cmp);
    off > BEYOND * within && off > ODD * *middle
}

fn check(rows: &[Vec<DVec3>], (columns, count): (usize, usize), how: &Fairing, origin: Origin) -> Result<()> {
    let given = columns.max(if columns == 0 { 0 } else { count });
    if given < 3 {
        let what = if count > 1 { "one direction of rows to be faired" } else { "a row to be faired" };
        return Err(CurveFault::TooFewPoints { of: origin, what, argument: "points", needed: 3, given }.into());
    }
    if let Some(j) = rows.iter().position(|row| row.len() != columns) {
        let (found, range) = (format!("{} in row {j}", rows[j].len()), format!("rows of {columns} points each, like the first one"));
        return Err(ValueFault::OutsideRange { argument: "points", found, range }.into());
    }
    if let Some(corner) = how.corners.iter().find(|k| **k == 0 || **k + 1 >= columns) {
        let (found, range) = (corner.to_string(), format!("1 to {}: between the ends of a row", columns.saturating_sub(2)));
        return Err(ValueFault::OutsideRange { argument: "corners", found, range }.into());
    }
    Ok(())
}

/// How far each point may move: a little less than stated, so that rounding of the places does not take it farther.
fn reach(points: &[DVec3], (columns, rows): (usize, usize), how: &Fairing) -> Vec<f64> {
    let last = (columns - 1, rows - 1);
    let held = |i: usize, j: usize| match how.held {
        Held::None => false,
        Held::Ends => (i == 0 || i == last.0) && (j == 0 || j == last.1),
        Held::Borders => i == 0 || i == last.0 || rows > 1 && (j == 0 || j == last.1),
    };
    let far = |p: &DVec3| (how.within * (1.0 - EPSILON) - EPSILON * p.abs().max_element()).max(0.0);
    points.iter().enumerate().map(|(k, p)| if held(k % columns, k / columns) { 0.0 } else { far(p) }).collect()
}

/// The lines of one direction with their differences. Poles and the corners of a single row do not move.
fn lines(
    points: &[DVec3],
    counts: (usize, usize),
    along: bool,
    how: &Fairing,
    reach: &mut [f64],
    (origin, tolerance): (Origin, &Tolerance),
) -> Result<Lines> {
    let mut lines = Lines::new(counts, along);
    let (length, count) = if along { counts } else { (counts.1, counts.0) };
    let place = |line: usize, k: usize| if along { line * counts.0 + k } else { k * counts.0 + line };
    let mut line = Vec::with_capacity(length);
    for l in 0..count {
        line.clear();
        line.extend((0..length).map(|k| points[place(l, k)]));
        let border = count > 1 && (l == 0 || l + 1 == count);
        if border && line.iter().all(|p| tolerance.same_point(*p, line[0])) {
            (0..length).for_each(|k| reach[place(l, k)] = 0.0);
            continue;
        }
        let twin = line.windows(2).position(|p| p[0] == p[1] || tolerance.same_point(p[0], p[1]));
        if let Some(index) = twin.filter(|_| how.spacing != Spacing::Uniform) {
            let (at, distance) = (line[index], line[index].distance(line[index + 1]));
            return Err(CurveFault::DuplicatePoints { of: origin, index, count: length, at, distance, tolerance: tolerance.point }.into());
        }
        let mut steps = how.spacing.spans(&line);
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        steps.iter_mut().for_each(|step| *step /= mean);
        let turns = |k: usize| how.kinks.is_some_and(|least| math::angle_between(line[k] - line[k - 1], line[k + 1] - line[k]) > least);
        let mut from = 0;
        for k in 1..length {
            if k + 1 < length && !turns(k) && !(along && how.corners.contains(&k)) {
                continue;
            }
            lines.take(l, from, &steps[from..k], how.order);
            if count == 1 && k + 1 < length && how.held != Held::None {
                reach[place(l, k)] = 0.0;
            }
            from = k;
        }
    }
    Ok(lines)
}
