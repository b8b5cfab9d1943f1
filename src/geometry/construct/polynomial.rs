//! Polynomial segments in powers: r(t) = Σ a_i tⁱ over a part of 0…1 [Yoo & Yoon 2000].

use glam::DVec3;

use crate::base::fault::{Result, ValueFault};
use crate::base::math::powi;
use crate::base::origin::Origin;
use crate::geometry::construct::build::bezier;
use crate::geometry::curves::curve::Curve;
use crate::geometry::shapes::bounds::binomial;

/// The segment with these coefficients of ascending powers between two values of t, as a Bézier curve, the same but for rounding.
///
/// With t = t0 + (t1 − t0) s the coefficients of sᵏ are Σ_{i≥k} C(i, k) t0^(i−k) (t1 − t0)ᵏ a_i. E306 for ends outside 0…1 or in the
/// wrong order, and where no coefficient of a power of t is given; else as [`bezier`].
pub fn segment(a: &[DVec3], (from, to): (f64, f64), origin: Origin) -> Result<Curve> {
    let fault = |argument: &'static str, found: String, range: &str| ValueFault::OutsideRange { argument, found, range: range.to_owned() };
    if !(0.0..=1.0).contains(&from) {
        return Err(fault("from", from.to_string(), "0 to 1").into());
    }
    if !(to > from && to <= 1.0) {
        return Err(fault("to", to.to_string(), &format!("above {from} and up to 1")).into());
    }
    if a.len() < 2 {
        return Err(fault("x", format!("{} coefficients", a.len()), "at least 2, of t^0 and t^1").into());
    }
    let n = a.len() - 1;
    let width = to - from;
    let moved = |k: usize| (k..=n).map(|i| a[i] * (binomial(i, k) * powi(from, (i - k) as i32) * powi(width, k as i32))).sum::<DVec3>();
    let c: Vec<DVec3> = (0..=n).map(moved).collect();
    let pole = |i: usize| (0..=i).map(|k| c[k] * (binomial(i, k) / binomial(n, k))).sum();
    bezier(&(0..=n).map(pole).collect::<Vec<DVec3>>(), None, origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_those_of_the_sums() {
        let a = [DVec3::new(1.0, -2.0, 0.5), DVec3::new(3.0, 0.1, 0.0), DVec3::new(-4.0, 2.0, 1.0), DVec3::new(0.7, -0.3, 2.0)];
        let sum = |t: f64| a.iter().enumerate().map(|(i, c)| *c * powi(t, i as i32)).sum::<DVec3>();
        for ends in [(0.0, 1.0), (0.25, 1.0), (0.0, 0.3), (0.4, 0.41)] {
            let curve = segment(&a, ends, Origin::NONE).unwrap();
            assert!(curve.point(0.0).distance(sum(ends.0)) < 1e-14 && curve.point(1.0).distance(sum(ends.1)) < 1e-13, "{ends:?}");
            // The middle of t lies on the curve.
            let middle = sum(0.5 * (ends.0 + ends.1));
            let nearest = (0..=20_000).map(|k| curve.point(f64::from(k) / 20_000.0).distance(middle)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-3, "{ends:?}: {nearest}");
        }
        for (ends, at) in [((-0.1, 1.0), "from"), ((0.0, 1.1), "to"), ((0.5, 0.5), "to"), ((0.6, 0.2), "to"), ((f64::NAN, 1.0), "from")] {
            let fault = segment(&a, ends, Origin::NONE).unwrap_err();
            assert!(format!("{fault:?}").contains(&format!("{at:?}")), "{fault:?}");
        }
        assert!(segment(&a[..1], (0.0, 1.0), Origin::NONE).is_err());
    }
}
