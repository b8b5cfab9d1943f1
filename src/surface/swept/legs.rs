//! The frame of a path with corners: smooth legs, cut by the bisecting planes of the corners between them.

use glam::{DMat3, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::tolerance::{EPSILON, NUDGE, Tolerance};
use crate::base::{job, math};
use crate::geometry::Motion;
use crate::network::Chain;
use crate::surface::data::breaks::chain_breaks;
use crate::surface::faults::SweepFault;
use crate::surface::shapes::matrices::Matrices;
use crate::surface::swept::frame::{bent, frame, place, transported, twisted};

/// A frame is transported over at most this share of the path at once, and over as much as turns the tangent by so many radians.
const STEP: f64 = 1.0 / 64.0;
const TURN: f64 = 0.5;

/// A smooth run of the path.
struct Leg {
    from: f64,
    to: f64,
    /// Normals known so far, by ascending fraction; the first one at `from`.
    normals: Vec<(f64, DVec3)>,
}

/// The path with a frame at every place of it.
pub struct Legs<'a> {
    path: &'a Chain,
    /// The path moved to where its middle is the origin: coordinates far from it are rounded more than a frame is.
    near: Chain,
    legs: Vec<Leg>,
    /// Fractions of the corners, 0 for one where a closed path starts.
    corners: Vec<f64>,
    first: DMat3,
    /// Turn about the tangent from the start to the end, radians, beside that of the rotation-minimising frame.
    twist: f64,
}

/// Unit normal of the plane that bisects a corner.
fn bisector(before: DVec3, after: DVec3) -> DVec3 {
    (before + after).normalize_or_zero()
}

/// E636 for a part of a path along which no frame can be transported: at the end of it where it turns more at once.
pub fn no_frame(path: &Chain, (a, b): (f64, f64)) -> Fault {
    let step = NUDGE * (b - a);
    let turn = |f: f64, g: f64| place(path, f, false).1.dot(place(path, g, true).1);
    let (first, last) = (turn(a, a + step), turn(b - step, b));
    let (fraction, cosine) = if first <= last { (a, first) } else { (b, last) };
    SweepFault::GuideCusp { guide: path.origin(), at: path.point(fraction), fraction, still: cosine > 0.0 }.into()
}

impl<'a> Legs<'a> {
    /// Transports a frame along the whole path; what the frame of a closed path lacks is distributed along it, then `twist` is added.
    ///
    /// E636 where the path turns back on itself.
    pub fn new(path: &'a Chain, twist: f64, tolerance: &Tolerance) -> Result<Self> {
        let corners = path.kinks(tolerance);
        for &f in &corners {
            let (before, after) = sides(path, f);
            if before.dot(after) <= -1.0 + tolerance.angle * tolerance.angle {
                return Err(SweepFault::GuideCusp { guide: path.origin(), at: path.point(f), fraction: f, still: false }.into());
            }
        }
        let inner = corners.iter().copied().filter(|f| *f > 0.0);
        let stops: Vec<f64> = std::iter::once(0.0).chain(inner).chain(std::iter::once(1.0)).collect();
        let near = path.moved(&Motion::translation(-path.bbox().center()));
        let tangent = place(&near, 0.0, false).1;
        let mut normal = math::any_normal(tangent);
        let first = frame(tangent, normal);
        let mut legs = Vec::with_capacity(stops.len() - 1);
        for w in stops.windows(2) {
            if w[0] > 0.0 {
                let (before, after) = sides(&near, w[0]);
                normal = bent(before, after, normal);
            }
            let mut leg = Leg { from: w[0], to: w[1], normals: vec![(w[0], normal)] };
            // In steps from break to break, so that each is smooth.
            for stop in leg.stops(path) {
                normal = leg.normal(&near, stop);
            }
            legs.push(leg);
        }
        let mut twist = twist;
        if path.is_closed(tolerance) {
            let (before, after) = sides(&near, 0.0);
            let back = bent(before, after, normal);
            twist -= math::atan2(back.dot(first.y_axis), back.dot(first.x_axis));
        }
        Ok(Self { path, near, legs, corners, first, twist })
    }

    /// Whether the frame comes back to where it started.
    pub fn closes(&self, twist: f64, tolerance: &Tolerance) -> bool {
        let turns = twist / std::f64::consts::TAU;
        self.path.is_closed(tolerance) && (turns - turns.round()).abs() <= tolerance.angle
    }

    /// Whether there is a corner at this fraction.
    fn corner(&self, f: f64) -> bool {
        let turn = if f >= 1.0 { 0.0 } else { f };
        self.corners.iter().any(|c| (c - turn).abs() <= EPSILON)
    }

    /// Whether the profile is cut where the path starts.
    pub fn cut_at_start(&self) -> bool {
        self.corner(0.0)
    }

    /// The rotation that the profile has at the end of the path.
    pub fn last(&mut self) -> DMat3 {
        let k = self.legs.len() - 1;
        self.turned(k, 1.0)
    }

    /// Unit tangent and rotation at any place; at a corner those of its bisecting plane.
    pub fn frame_at(&mut self, f: f64) -> (DVec3, DMat3) {
        let leg = self.legs.iter().position(|leg| f <= leg.to).unwrap_or(self.legs.len() - 1);
        if !self.corner(f) || f == 0.0 {
            return (place(&self.near, f, f >= self.legs[leg].to).1, self.turned(leg, f));
        }
        let (before, after) = sides(&self.near, f);
        let middle = bisector(before, after);
        let normal = bent(before, middle, self.legs[leg].normal(&self.near, f));
        (middle, twisted(frame(middle, normal), self.twist * f) * self.first.transpose())
    }

    /// The rotation at a fraction of a run.
    pub fn turned(&mut self, leg: usize, f: f64) -> DMat3 {
        let normal = self.legs[leg].normal(&self.near, f);
        let tangent = place(&self.near, f, f >= self.legs[leg].to).1;
        twisted(frame(tangent, normal), self.twist * f) * self.first.transpose()
    }

    /// The matrix of the profile all along the path, cut by the bisecting planes of its corners.
    ///
    /// Fails where a run that ends in a corner is not straight, and with E636 at a cusp.
    pub fn mitred(&mut self) -> Result<Matrices> {
        let mut all = Matrices::empty();
        for leg in 0..self.legs.len() {
            let stops = [&[self.legs[leg].from][..], &self.legs[leg].stops(self.path)].concat();
            for w in stops.windows(2) {
                let (a, b) = (w[0], w[1]);
                let cuts = (self.cut(a, (a, b), false)?, self.cut(b, (a, b), true)?);
                let mut of = |f: f64| {
                    let x = (f - a) / (b - a);
                    let turned = self.turned(leg, f);
                    if cuts == (None, None) {
                        return turned;
                    }
                    let [p, q] = [cuts.0, cuts.1].map(|cut| cut.unwrap_or(DMat3::IDENTITY));
                    (p * (1.0 - x) + q * x) * turned
                };
                if !all.fit((a, b), &mut of) {
                    return Err(no_frame(self.path, (a, b)));
                }
            }
        }
        Ok(all)
    }

    /// The projection along a straight run to the bisecting plane of the corner at one of its ends, if there is one.
    fn cut(&self, f: f64, run: (f64, f64), before: bool) -> Result<Option<DMat3>> {
        if !self.corner(f) {
            return Ok(None);
        }
        let (arriving, leaving) = sides(&self.near, if f >= 1.0 { 0.0 } else { f });
        let chord = self.near.point(run.1).distance(self.near.point(run.0));
        let length = (run.1 - run.0) * self.near.length();
        if length - chord > EPSILON * self.near.length() {
            return Err(SweepFault::BentRun { path: self.path.origin(), at: self.path.point(f), fraction: f }.into());
        }
        let (t, n) = (if before { arriving } else { leaving }, bisector(arriving, leaving));
        let along = t / n.dot(t);
        Ok(Some(DMat3::IDENTITY - DMat3::from_cols(along * n.x, along * n.y, along * n.z)))
    }

    /// The path.
    pub fn path(&self) -> &'a Chain {
        self.path
    }

    /// How many smooth runs it has.
    pub fn count(&self) -> usize {
        self.legs.len()
    }

    /// Fractions at both ends of a run.
    pub fn run(&self, leg: usize) -> (f64, f64) {
        (self.legs[leg].from, self.legs[leg].to)
    }

    /// Ends of its smooth parts, its own end the last.
    pub fn stops(&self, leg: usize) -> Vec<f64> {
        self.legs[leg].stops(self.path)
    }

    /// Whether a fraction is that of an inner corner.
    pub fn is_corner(&self, f: f64) -> bool {
        f > 0.0 && f < 1.0 && self.corner(f)
    }

    /// The corner at the end of a run: its place, and the unit tangents before and after it; none where the path ends smoothly.
    pub fn corner_after(&self, leg: usize) -> Option<(DVec3, DVec3, DVec3)> {
        let f = self.legs[leg].to;
        self.corner(f).then(|| {
            let (before, after) = sides(&self.near, if f >= 1.0 { 0.0 } else { f });
            (self.path.point(f), before, after)
        })
    }

    /// Inner corners.
    pub fn corners(&self) -> Vec<f64> {
        self.corners.iter().copied().filter(|f| *f > 0.0).collect()
    }
}

impl Leg {
    /// Ends of its smooth runs, its own end the last.
    fn stops(&self, path: &Chain) -> Vec<f64> {
        let inner = chain_breaks(path).into_iter().filter(|f| *f > self.from + EPSILON && *f < self.to - EPSILON);
        inner.chain(std::iter::once(self.to)).collect()
    }

    /// The normal at a fraction, transported from the nearest one known before it in steps that turn little.
    fn normal(&mut self, path: &Chain, f: f64) -> DVec3 {
        loop {
            let k = self.normals.partition_point(|known| known.0 <= f).max(1) - 1;
            let (from, normal) = self.normals[k];
            // A step as short as rounding may begin at the corner that ends the leg, with the tangent beyond it.
            if f - from <= EPSILON {
                return normal;
            }
            job::poll();
            let turning = path.jet(from).d2.length() / path.length();
            let most = if turning > 0.0 { (TURN / turning).min(STEP) } else { STEP };
            let to = if f - from <= most { f } else { from + most };
            let found = transported(path, (from, to), normal);
            self.normals.insert(k + 1, (to, found));
        }
    }
}

/// Unit tangents on both sides of a place; at 0 the end of the path is what lies before.
fn sides(path: &Chain, f: f64) -> (DVec3, DVec3) {
    let before = place(path, if f == 0.0 { 1.0 } else { f }, true).1;
    (before, place(path, f, false).1)
}
