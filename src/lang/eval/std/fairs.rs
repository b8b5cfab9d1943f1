//! Fairing of measured points.

use crate::base::fault::ValueFault;
use crate::builtins;
use crate::lang::eval::context::Cx;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::curves::unit;
use crate::lang::eval::std::fits::Data;
use crate::lang::eval::std::splines::SpacingWord;
use crate::lang::eval::std::surfaces::rows;
use crate::lang::values::conversions::{Angle, Direction, Length};
use crate::lang::values::value::Value;
use crate::surface::points::fair::{self, Faired, Fairing, Held};
use crate::surface::points::fair_lines::{LEAST_ORDER, MOST_ORDER};

crate::choices! {
    /// Which points stay when others move.
    pub enum HeldWord {
        /// Ends of a row, corners of rows.
        Ends = "ends",
        /// The border.
        Borders = "borders",
        /// None.
        None = "none",
    }
}

/// E306 for settings outside of their range.
fn check(how: &Fairing) -> Result<(), Halt> {
    if how.within <= 0.0 {
        let (found, range) = (how.within.to_string(), "above 0".to_owned());
        return Err(ValueFault::OutsideRange { argument: "within", found, range }.into());
    }
    if !(LEAST_ORDER..=MOST_ORDER).contains(&how.order) {
        let (found, range) = (how.order.to_string(), format!("{LEAST_ORDER} to {MOST_ORDER}"));
        return Err(ValueFault::OutsideRange { argument: "order", found, range }.into());
    }
    Ok(())
}

fn faired(cx: &mut Cx, data: Data, how: &Fairing) -> Result<Value, Halt> {
    check(how)?;
    let (measured, single) = match data {
        Data::Row(points) => (vec![points.into_iter().map(|p| p.0).collect()], true),
        Data::Rows(net) => (rows(net), false),
    };
    cx.seen(measured.iter().flatten().copied());
    let tolerance = cx.tolerance()?;
    let (made, notes) = fair::fair(&measured, how, cx.origin(), &tolerance)?;
    notes.iter().for_each(|note| cx.say(note));
    Ok(record(cx, &measured, single, &made))
}

fn record(cx: &mut Cx, measured: &[Vec<glam::DVec3>], single: bool, made: &Faired) -> Value {
    let columns = measured[0].len();
    let at = |k: usize| Value::point(measured[k / columns][k % columns]);
    let lines = made.points.chunks_exact(columns).map(|row| Value::list(row.iter().map(|p| Value::point(*p)).collect()));
    let mut lines: Vec<Value> = lines.collect();
    let points = if single { lines.swap_remove(0) } else { Value::list(lines) };
    let moved = &made.moved;
    let n = moved.len() as f64;
    let farthest = (0..moved.len()).fold(0, |worst, k| if moved[k] > moved[worst] { k } else { worst });
    cx.record([
        ("points", points),
        ("max", Value::length(moved[farthest])),
        ("mean", Value::length(moved.iter().sum::<f64>() / n)),
        ("rms", Value::length((moved.iter().map(|d| d * d).sum::<f64>() / n).sqrt())),
        ("at", at(farthest)),
        ("distances", Value::list(moved.iter().map(|d| Value::length(*d)).collect())),
        ("limited", Value::number(made.limited as f64)),
        ("outlier", made.outlier.map_or(Value::None, |(k, _)| at(k))),
        ("outlier_off", made.outlier.map_or(Value::None, |(_, off)| Value::length(off))),
        ("rough_before", Value::length(made.rough[0])),
        ("rough_after", Value::length(made.rough[1])),
        ("gap", Value::number(made.gap)),
    ])
}

builtins! {
    /// Moves measured points at most a stated distance, to where their run is fairest.
    ///
    /// Of all points that are no farther than `within:` from where they were measured, those whose rows, and columns of several rows,
    /// have the least sum of squared third derivatives over chord lengths; second ones where there are three points. The ends of a row
    /// stay, and the corners of rows, or all of the border (`fixed: borders`), or nothing; a row and a column of rows that is one point
    /// stays too. At `corners:`, places along the rows, and where lines turn by more than `kinks:` they are parted: a knuckle stays one,
    /// and a corner of a single row stays where it is. With `along:` points move in that direction alone, as half breadths of an offsets
    /// table do. What is fair stays: points of a parabola in the parameter with order 3, of a cubic with order 4; of other smooth lines a
    /// wide `within:` flattens what bends: it is best about as large as the points scatter.
    ///
    /// A record: `points` in the shape they came; `max`, `mean` and `rms` of how far they moved, `at`, the one that moved farthest, as
    /// measured, and `distances` in order; `limited`, how many stand at their limit, and of these the `outlier` that stood farthest off
    /// the run of its neighbours, by about `outlier_off`, both none where nothing is limited; W679 tells of one that is far off.
    /// `rough_before` and `rough_after` are the root of the mean square of the derivatives for a mean step of 1; `gap` is a bound: by how
    /// much of the energy before other points within reach might be fairer, 1e-6 of a row and 1e-3 of rows where the search ends by
    /// itself.
    /// ```loft
    /// let measured = [for i in 0..41: (i * 250mm, sin(i * 4deg) * 1m + sin(i * i * 57deg) * 4mm, 0)]
    /// let faired = fair(measured, within: 5mm)
    /// curve waterline = spline(faired.points)
    /// check faired.max <= 5mm and faired.rough_after < 0.2 * faired.rough_before
    /// ```
    fn fair(
        /// Points in order, or rows of them, all as long.
        points: Data,
        /// How far a point may move, above 0.
        within: Length,
        /// Which points stay: `ends`, the ends of a row or the corners of rows; `borders`; `none`.
        fixed: HeldWord = "ends",
        /// Places along the rows, counted from 0, at which these have a corner.
        corners: Option<Vec<usize>>,
        /// Turns of the lines above this are corners too.
        kinks: Option<Angle>,
        /// The only direction in which points move; any when left out.
        along: Option<Direction>,
        /// Order of the derivative, 2 to 4.
        order: usize = "3",
        /// Spacing of the parameters.
        parameter: SpacingWord = "chord",
    ) -> Value = |cx, points, within, fixed, corners, kinks, along, order, parameter| {
        let held = match fixed {
            HeldWord::Ends => Held::Ends,
            HeldWord::Borders => Held::Borders,
            HeldWord::None => Held::None,
        };
        let how = Fairing {
            within: within.0,
            held,
            order,
            spacing: parameter.spacing(),
            kinks: kinks.map(|angle| angle.0),
            corners: corners.unwrap_or_default(),
            along: along.map(|along| unit(along.0, "along")).transpose()?,
        };
        faired(cx, points, &how)
    };
}
