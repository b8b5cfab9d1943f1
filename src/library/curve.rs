//! Curves made in Rust or by a script.

use std::sync::Arc;

use glam::DVec3;

use super::error::Error;
use super::names::{Names, Speaker, fresh};
use crate::base::fault::Fault;
use crate::base::math;
use crate::base::origin::Origin;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry;
use crate::geometry::construct::build;
use crate::geometry::{Ends, Motion, Spline};
use crate::lang::values::units::radians;
use crate::network::Chain;

/// A curve in space. Cheap to clone.
///
/// Points are three coordinates in model units, given as arrays or tuples. Places along a curve are shares of its arc length, 0 to 1.
///
/// ```
/// use lofting::Curve;
///
/// let arch = Curve::arc((-2.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 0.0, 2.0))?.named("arch");
/// assert!((arch.length() - 2.0 * std::f64::consts::PI).abs() < 1e-12);
/// assert!((arch.point(0.5)[2] - 2.0).abs() < 1e-12);
/// # Ok::<(), lofting::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Curve {
    pub(super) chain: Chain,
    name: Option<Arc<str>>,
}

/// A point whose coordinates are numbers.
pub(super) fn place(argument: &'static str, p: impl Into<[f64; 3]>) -> Result<DVec3, Error> {
    let p = DVec3::from_array(p.into());
    if p.is_finite() { Ok(p) } else { Err(Error::outside(argument, format!("({}, {}, {})", p.x, p.y, p.z), "of finite numbers")) }
}

/// A direction at length one.
pub(super) fn direction(argument: &'static str, of: impl Into<[f64; 3]>) -> Result<DVec3, Error> {
    let d = place(argument, of)?;
    let largest = d.abs().max_element();
    let unit = (largest > 0.0).then(|| math::unit(d / largest, PARALLEL)).flatten();
    unit.ok_or_else(|| Error::outside(argument, format!("({}, {}, {})", d.x, d.y, d.z), "a direction of some length"))
}

/// Several points.
pub(super) fn places<P: Into<[f64; 3]>>(points: impl IntoIterator<Item = P>) -> Result<Vec<DVec3>, Error> {
    points.into_iter().map(|p| place("points", p)).collect()
}

/// A curve that was made, or why there is none.
fn made(curve: Result<geometry::Curve, Fault>) -> Result<Curve, Error> {
    let say = Speaker { names: &Names::default(), unit: None, tolerance: None };
    match curve {
        Ok(curve) => Ok(Curve { chain: Chain::of_curve(&curve), name: None }),
        Err(fault) => Err(Error::of_fault(&fault, &say)),
    }
}

/// Constructors. They fail with the codes of family 4 and E306: points that fall together, numbers that are not finite.
impl Curve {
    /// A straight segment.
    pub fn line(from: impl Into<[f64; 3]>, to: impl Into<[f64; 3]>) -> Result<Self, Error> {
        made(build::line(place("from", from)?, place("to", to)?, fresh()))
    }

    /// Straight segments through points; `closed` returns to the first one.
    pub fn polyline<P: Into<[f64; 3]>>(points: impl IntoIterator<Item = P>, closed: bool) -> Result<Self, Error> {
        made(build::polyline(&places(points)?, closed, fresh()))
    }

    /// The arc of a circle from one point to another through a third one.
    pub fn arc(from: impl Into<[f64; 3]>, to: impl Into<[f64; 3]>, through: impl Into<[f64; 3]>) -> Result<Self, Error> {
        made(build::arc_through(place("from", from)?, place("to", to)?, place("through", through)?, fresh()))
    }

    /// A whole circle; it turns counter-clockwise seen against the normal.
    pub fn circle(center: impl Into<[f64; 3]>, radius: f64, normal: impl Into<[f64; 3]>) -> Result<Self, Error> {
        if !radius.is_finite() {
            return Err(Error::outside("radius", radius, "a finite number"));
        }
        made(build::circle(place("center", center)?, radius, direction("normal", normal)?, fresh()))
    }

    /// A twice continuously differentiable cubic spline through points, with natural ends; `closed` returns smoothly to the first one.
    pub fn spline<P: Into<[f64; 3]>>(points: impl IntoIterator<Item = P>, closed: bool) -> Result<Self, Error> {
        let settings = Spline { start: Ends::Natural, end: Ends::Natural, closed };
        made(build::spline(&places(points)?, &settings, fresh()))
    }

    /// A Bézier curve; its degree is one less than the number of control points.
    pub fn bezier<P: Into<[f64; 3]>>(points: impl IntoIterator<Item = P>) -> Result<Self, Error> {
        made(build::bezier(&places(points)?, None, fresh()))
    }

    /// A rational B-spline: a weight above 0 for each control point, knots not decreasing, one more than points and degree together.
    pub fn nurbs<P: Into<[f64; 3]>>(
        points: impl IntoIterator<Item = P>,
        weights: &[f64],
        knots: &[f64],
        degree: usize,
    ) -> Result<Self, Error> {
        made(build::nurbs(&places(points)?, weights, knots, degree, fresh()))
    }

    /// One curve of several that follow each other, each from where the one before ends, within the tolerance.
    pub fn joined<'a>(curves: impl IntoIterator<Item = &'a Self>, tolerance: &Tolerance) -> Result<Self, Error> {
        let (mut names, mut chains) = (Names::default(), Vec::new());
        for curve in curves {
            names.add(curve.origin(), curve.name());
            chains.push(curve.chain.clone());
        }
        let joined = Chain::join(&chains, fresh(), tolerance).and_then(|chain| chain.to_curve());
        let say = Speaker { names: &names, unit: None, tolerance: Some(*tolerance) };
        joined.map(|curve| Self { chain: Chain::of_curve(&curve), name: None }).map_err(|fault| Error::of_fault(&fault, &say))
    }
}

/// Other curves of one.
impl Curve {
    /// The same curve with a name: messages, sets of meshes and plans call it by that.
    pub fn named(&self, name: &str) -> Self {
        Self { chain: self.chain.with_origin(fresh()), name: Some(name.into()) }
    }

    /// Run the other way.
    pub fn reversed(&self) -> Self {
        self.like(self.chain.reversed())
    }

    /// The part between two shares of the arc length; it runs backwards where the first is the larger one.
    pub fn part(&self, from: f64, to: f64, tolerance: &Tolerance) -> Result<Self, Error> {
        for (argument, share) in [("from", from), ("to", to)] {
            if !(0.0..=1.0).contains(&share) {
                return Err(Error::outside(argument, share, "between 0 and 1"));
            }
        }
        made(self.chain.slice(from, to, tolerance).and_then(|chain| chain.with_origin(fresh()).to_curve()))
    }

    /// Moved by a vector.
    pub fn moved(&self, by: impl Into<[f64; 3]>) -> Result<Self, Error> {
        Ok(self.like(self.chain.moved(&Motion::translation(place("by", by)?))))
    }

    /// Turned about an axis through a point, degrees, counter-clockwise seen against the axis.
    pub fn rotated(&self, about: impl Into<[f64; 3]>, axis: impl Into<[f64; 3]>, degrees: f64) -> Result<Self, Error> {
        Ok(self.like(self.chain.moved(&rotation(about, axis, degrees)?)))
    }

    fn like(&self, chain: Chain) -> Self {
        Self { chain: chain.with_origin(fresh()), name: None }
    }

    /// The same curve under another name, found by the same origin.
    pub(super) fn called(&self, name: &str) -> Self {
        Self { name: Some(name.into()), ..self.clone() }
    }

    pub(super) fn of_chain(chain: &Chain, name: &str) -> Self {
        Self { chain: chain.with_origin(fresh()), name: Some(name.into()) }
    }
}

/// What it is.
impl Curve {
    /// Its name; empty without one.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or_default()
    }

    /// Where it starts.
    pub fn start(&self) -> [f64; 3] {
        self.chain.start().to_array()
    }

    /// Where it ends.
    pub fn end(&self) -> [f64; 3] {
        self.chain.end().to_array()
    }

    /// The point at a share of the arc length; shares outside 0 to 1 give the ends.
    pub fn point(&self, share: f64) -> [f64; 3] {
        self.chain.point(if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }).to_array()
    }

    /// So many points, two at least, at equal arc lengths from start to end.
    pub fn points(&self, count: usize) -> Vec<[f64; 3]> {
        let steps = count.max(2) - 1;
        (0..=steps).map(|k| self.point(k as f64 / steps as f64)).collect()
    }

    /// Arc length, model units, with a relative error of 1e-13.
    pub fn length(&self) -> f64 {
        self.chain.length()
    }

    /// The point nearest to another one: its share of the arc length, and the distance.
    pub fn nearest(&self, to: impl Into<[f64; 3]>) -> Result<(f64, f64), Error> {
        let (share, _, distance) = self.chain.closest(place("to", to)?);
        Ok((share, distance))
    }

    /// Smallest and largest coordinates.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let all = self.chain.bbox();
        [all.min.to_array(), all.max.to_array()]
    }

    pub(super) fn origin(&self) -> Origin {
        self.chain.origin()
    }
}

/// A turn about an axis through a point, degrees.
pub(super) fn rotation(about: impl Into<[f64; 3]>, axis: impl Into<[f64; 3]>, degrees: f64) -> Result<Motion, Error> {
    if !degrees.is_finite() {
        return Err(Error::outside("degrees", degrees, "a finite number"));
    }
    Ok(Motion::rotation(place("about", about)?, direction("axis", axis)?, radians(degrees)))
}
