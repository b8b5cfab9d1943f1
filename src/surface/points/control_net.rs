//! Nets of control points as surfaces: Bézier and B-spline.

use glam::{DVec3, DVec4};

use crate::base::fault::{Result, ValueFault};
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::data::fault::CurveFault;
use crate::geometry::shapes::nurbs::{MAX_DEGREE, weighted};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::flow_words::phrase;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::rails::side::{Border, Side};
use crate::surface::shapes::nurbs::NurbsSurface;

impl NurbsSurface {
    /// The surface value: poles where a row of the net is one point, closed where opposite rows are one.
    pub fn surface(self, kind: SurfaceKind, origin: Origin, tolerance: &Tolerance) -> Surface {
        let rows: Vec<Vec<DVec3>> = (0..4).map(|k| self.border(k)).collect();
        let one = |row: &[DVec3]| row.iter().all(|p| tolerance.same_point(row[0], *p));
        let alike = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).all(|(p, q)| tolerance.same_point(*p, *q));
        let poles: Vec<bool> = rows.iter().map(|row| one(row)).collect();
        let closed = (!poles[1] && alike(&rows[1], &rows[3]), !poles[0] && alike(&rows[0], &rows[2]));
        let side = |k: usize| match (poles[k], if k % 2 == 1 { closed.0 } else { closed.1 }) {
            (true, _) => Side::Pole(rows[k][0]),
            (_, true) => Side::Seam,
            _ => Side::Free,
        };
        Surface::new(Parts {
            origin,
            kind,
            flow: phrase(poles.iter().filter(|pole| **pole).count(), closed),
            domain: Domain::Square,
            closed,
            borders: (0..4).map(|k| Border::straight(side(k))).collect(),
            kinks: self.kinks(tolerance),
            shape: Shape::Nurbs(self),
            chains: Vec::new(),
            generated: Vec::new(),
            trim: None,
            flipped: false,
        })
    }
}

/// A net as a script gives it: rows along u, one row per v.
#[derive(Clone, Copy, Debug)]
pub struct Net<'a> {
    /// Control points; `rows[j]` are the points along u at the j-th v, all rows as long.
    pub rows: &'a [Vec<DVec3>],
    /// Weights of the same shape, all above 0; none: all 1.
    pub weights: Option<&'a [Vec<f64>]>,
}

/// Bézier surface: degree = number of points − 1 each way.
///
/// Fails with E402 below 2×2 points, E306 for rows of different length or a degree above 25, E407 for a weight.
pub fn bezier(net: &Net, origin: Origin, tolerance: &Tolerance) -> Result<Surface> {
    let (counts, poles) = checked(net, origin)?;
    let degree = (counts.0 - 1, counts.1 - 1);
    for (argument, degree) in [("net", degree.0), ("net", degree.1)] {
        check_degree(argument, degree)?;
    }
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let surface = NurbsSurface { degree, knots: (knots(degree.0), knots(degree.1)), poles, counts };
    Ok(surface.surface(SurfaceKind::Bezier, origin, tolerance))
}

/// Rational B-spline surface. Knots default to clamped uniform ones; given ones are clamped and are scaled to 0…1.
///
/// Fails like [`bezier`], and with E406 for knots that decrease, are too many or too few, or are not clamped.
pub fn nurbs(
    net: &Net,
    degree: (usize, usize),
    knots: (Option<&[f64]>, Option<&[f64]>),
    origin: Origin,
    tolerance: &Tolerance,
) -> Result<Surface> {
    let (counts, poles) = checked(net, origin)?;
    check_degree("degree_u", degree.0)?;
    check_degree("degree_v", degree.1)?;
    let knots = (checked_knots(knots.0, counts.0, degree.0, origin)?, checked_knots(knots.1, counts.1, degree.1, origin)?);
    Ok(NurbsSurface { degree, knots, poles, counts }.surface(SurfaceKind::Nurbs, origin, tolerance))
}

fn check_degree(argument: &'static str, degree: usize) -> Result<()> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    let (found, range) = (format!("degree {degree}"), format!("of degree 1 to {MAX_DEGREE}"));
    Err(ValueFault::OutsideRange { argument, found, range }.into())
}

/// Counts along u and v and homogeneous poles, u fastest.
pub(crate) fn checked(net: &Net, origin: Origin) -> Result<((usize, usize), Vec<DVec4>)> {
    let (nu, nv) = (net.rows.first().map_or(0, Vec::len), net.rows.len());
    if nu < 2 || nv < 2 {
        return Err(CurveFault::TooFewPoints {
            of: origin,
            what: "each direction of a net",
            argument: "net",
            needed: 2,
            given: nu.min(nv),
        }
        .into());
    }
    let uneven = |argument: &'static str, j: usize, found: usize| {
        let (found, range) = (format!("{found} in row {j}"), format!("a list of rows of {nu} each, like the first one"));
        Err(ValueFault::OutsideRange { argument, found, range }.into())
    };
    let mut poles = Vec::with_capacity(nu * nv);
    for (j, row) in net.rows.iter().enumerate() {
        if row.len() != nu {
            return uneven("net", j, row.len());
        }
        for (i, p) in row.iter().enumerate() {
            let w = match net.weights {
                None => 1.0,
                Some(rows) => match rows.get(j) {
                    Some(weights) if weights.len() == nu => weights[i],
                    other => return uneven("weights", j, other.map_or(0, Vec::len)),
                },
            };
            if w <= 0.0 || !w.is_finite() {
                return Err(CurveFault::Weight { of: origin, index: j * nu + i, weight: w }.into());
            }
            poles.push(weighted(*p, w));
        }
    }
    Ok(((nu, nv), poles))
}

fn checked_knots(knots: Option<&[f64]>, n: usize, degree: usize, origin: Origin) -> Result<Vec<f64>> {
    if n <= degree {
        return Err(
            CurveFault::TooFewPoints { of: origin, what: "a net of this degree", argument: "net", needed: degree + 1, given: n }.into()
        );
    }
    let Some(knots) = knots else {
        let inner = (1..n - degree).map(|k| k as f64 / (n - degree) as f64);
        return Ok(std::iter::repeat_n(0.0, degree + 1).chain(inner).chain(std::iter::repeat_n(1.0, degree + 1)).collect());
    };
    crate::geometry::construct::build::check_knots(knots, n, degree, origin)?;
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    if knots[degree] != first || knots[n] != last {
        let range = format!("clamped: the first and the last value {} times", degree + 1);
        return Err(ValueFault::OutsideRange { argument: "knots", found: "knots that are not".to_owned(), range }.into());
    }
    Ok(knots.iter().map(|k| if *k == last { 1.0 } else { (k - first) / (last - first) }).collect())
}
