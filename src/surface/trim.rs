//! Trimmed surfaces: a part of a surface inside an outer loop and outside others [Yoo & Yoon 2000].

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::closest::closest;
use super::core::{Border, Domain, Parts, Side, Surface, SurfaceKind};
use super::pcurve::{Pcurve, TrimCurve, foot};
use super::plane;
use super::quick::PowerForm;
use super::shape::Shape;
use crate::base::fault::{Fault, LoopRole, Result, SurfaceFault};
use crate::base::origin::Origin;
use crate::base::predicates::{Side as Within, point_in_polygon};
use crate::base::tolerance::Tolerance;
use crate::network::Chain;

/// What a trimmed surface knows beside its borders.
#[derive(Clone, Debug)]
pub(super) struct Trim {
    /// Where the surface below is defined.
    pub ground: Domain,
    /// Number of borders of each loop, the outer one first.
    pub loops: Vec<usize>,
    /// One a border.
    pub courses: Vec<TrimCurve>,
    /// Corners of a box in (u, v) that holds the loops; where a surface closes they may lie whole turns away.
    pub reach: (DVec2, DVec2),
}

// Where it lies in (u, v) follows from the borders and the surface below.
crate::content!(Trim { loops } but { ground, courses, reach });

/// A box in (u, v) that holds some courses: between two places a curve is nowhere farther from its chord than the chord is long.
pub(super) fn reach(courses: &[TrimCurve]) -> (DVec2, DVec2) {
    let (mut low, mut high, mut longest) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0_f64);
    for course in courses {
        let places = course.places();
        if matches!(course, TrimCurve::Pcurve(_)) {
            longest = places.windows(2).map(|w| w[0].distance(w[1])).fold(longest, f64::max);
        }
        for p in places {
            (low, high) = (low.min(p), high.max(p));
        }
    }
    (low - DVec2::splat(longest), high + DVec2::splat(longest))
}

impl Trim {
    pub fn flipped(&self) -> Self {
        let mut courses = Vec::with_capacity(self.courses.len());
        let mut first = 0;
        let turn = |(u, v): (f64, f64)| if self.ground == Domain::Triangle { (v, u) } else { (u, 1.0 - v) };
        for n in &self.loops {
            courses.extend(self.courses[first..first + n].iter().rev().map(|c| c.flipped(&turn)));
            first += n;
        }
        self.with_courses(courses)
    }

    /// The same by other courses.
    pub fn with_courses(&self, courses: Vec<TrimCurve>) -> Self {
        Self { reach: reach(&courses), courses, ..self.clone() }
    }
}

/// A closed walk over a surface.
pub(super) struct TrimLoop {
    pub borders: Vec<Border>,
    pub courses: Vec<TrimCurve>,
    pub chains: Vec<Chain>,
}

impl TrimLoop {
    /// Its corners in (u, v), all on its curves.
    pub fn polygon(&self) -> Vec<DVec2> {
        self.courses
            .iter()
            .flat_map(|c| {
                let mut places = c.places();
                places.pop();
                places
            })
            .collect()
    }

    /// Twice its signed area in (u, v).
    pub fn area2(&self) -> f64 {
        area2(&self.polygon())
    }

    fn turned(self) -> Self {
        let borders = self.borders.iter().rev().map(Border::turned).collect();
        let courses = self.courses.iter().rev().map(TrimCurve::turned).collect();
        Self { borders, courses, ..self }
    }

    /// Moved in (u, v).
    pub fn shifted(self, by: DVec2) -> Self {
        let courses = self.courses.iter().map(|c| c.shifted(by)).collect();
        Self { courses, ..self }
    }

    /// The same once more.
    pub fn copied(&self) -> Self {
        Self { borders: self.borders.clone(), courses: self.courses.clone(), chains: self.chains.clone() }
    }
}

/// Twice the signed area of a polygon.
fn area2(polygon: &[DVec2]) -> f64 {
    (0..polygon.len()).map(|k| polygon[k].perp_dot(polygon[(k + 1) % polygon.len()])).sum()
}

/// Whether a place is inside a polygon or on it.
pub(super) fn inside(polygon: &[DVec2], p: DVec2) -> bool {
    point_in_polygon(p, polygon) != Within::Outside
}

/// A surface with these loops, the outer one first.
pub(super) fn assembled(base: &Surface, walks: Vec<TrimLoop>, origin: Origin) -> Result<Surface> {
    let mut parts = Parts { origin, kind: SurfaceKind::Trim, domain: Domain::Loop, ..base.parts().clone() };
    (parts.borders, parts.chains) = (Vec::new(), Vec::new());
    let mut trim = Trim { ground: base.ground(), loops: Vec::new(), courses: Vec::new(), reach: (DVec2::ZERO, DVec2::ONE) };
    for (k, walk) in walks.into_iter().enumerate() {
        // Outer loops run counter-clockwise in (u, v), the others clockwise.
        let ascending = area2(&walk.polygon()) > 0.0;
        let walk = if ascending == (k == 0) { walk } else { walk.turned() };
        trim.loops.push(walk.borders.len());
        trim.courses.extend(walk.courses);
        parts.borders.extend(walk.borders);
        parts.chains.extend(walk.chains);
    }
    trim.reach = reach(&trim.courses);
    parts.trim = Some(Arc::new(trim));
    Ok(Surface::new(parts))
}

/// Whole turns by which a loop may be moved in (u, v).
pub(super) fn shifts(base: &Surface) -> Vec<DVec2> {
    let of = |closed: bool| if closed { vec![0.0, 1.0, -1.0] } else { vec![0.0] };
    let (u, v) = base.closed();
    of(u).into_iter().flat_map(|x| of(v).into_iter().map(move |y| DVec2::new(x, y))).collect()
}

/// The loops that a surface has by itself.
pub(super) fn natural(base: &Surface, tolerance: &Tolerance) -> Result<Vec<TrimLoop>> {
    let parts = base.parts();
    if let Some(trim) = &parts.trim {
        let mut first = 0;
        let walk = |n: &usize| {
            let range = first..first + n;
            first += n;
            let borders = parts.borders[range.clone()].to_vec();
            let chains = borders.iter().filter_map(|b| if let Side::Chain { chain, .. } = &b.side { Some(chain.clone()) } else { None });
            TrimLoop { chains: chains.collect(), courses: trim.courses[range].to_vec(), borders }
        };
        return Ok(trim.loops.iter().map(walk).collect());
    }
    if parts.domain == Domain::Loop {
        let steps: Vec<plane::Step> = parts
            .borders
            .iter()
            .filter_map(|b| if let Side::Chain { chain, from, to } = &b.side { Some((chain.clone(), from > to)) } else { None })
            .collect();
        return Ok(vec![followed(base, &steps, tolerance)?]);
    }
    let corners: &[(f64, f64)] = match parts.domain {
        Domain::Square => &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)],
        Domain::Triangle => &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)],
        Domain::Loop | Domain::Unbounded => return Ok(Vec::new()),
    };
    let n = corners.len();
    // Sides run with ascending u or v; the far ones against the loop.
    let borders = (0..n).map(|k| if k >= 2 { parts.borders[k].turned() } else { parts.borders[k].clone() }).collect();
    let courses = (0..n).map(|k| TrimCurve::Line(corners[k], corners[(k + 1) % n])).collect();
    Ok(vec![TrimLoop { borders, courses, chains: parts.chains.clone() }])
}

/// A loop of curves on the surface.
pub(super) fn around(base: &Surface, chains: &[Chain], role: LoopRole, tolerance: &Tolerance) -> Result<TrimLoop> {
    let steps = plane::walked(chains, role, tolerance)?;
    plane::simple(&steps, tolerance)?;
    followed(base, &steps, tolerance)
}

/// The same in (u, v).
fn followed(base: &Surface, steps: &[plane::Step], tolerance: &Tolerance) -> Result<TrimLoop> {
    let first = closest(base, plane::start(&steps[0]));
    let mut place = DVec2::new(first.uv.0, first.uv.1);
    let mut walk = TrimLoop { borders: Vec::new(), courses: Vec::new(), chains: Vec::new() };
    for (chain, against) in steps {
        let (from, to) = if *against { (1.0, 0.0) } else { (0.0, 1.0) };
        let pcurve = Pcurve::follow(base, (chain, from, to), place, tolerance.point).map_err(|off| {
            let (of, at) = (chain.origin(), off.at);
            Fault::from(SurfaceFault::LoopOutsideSurface { of, surface: base.origin(), off: off.distance, at, tolerance: tolerance.point })
        })?;
        place = pcurve.ends().1;
        walk.chains.push(chain.clone());
        walk.courses.push(TrimCurve::Pcurve(Arc::new(pcurve)));
        walk.borders.push(Border::chain(chain.clone(), *against));
    }
    Ok(walk)
}

impl Surface {
    /// Where the surface is defined apart from any trimming.
    pub fn ground(&self) -> Domain {
        self.parts().trim.as_ref().map_or(self.parts().domain, |trim| trim.ground)
    }

    /// The whole surface below a trimmed one, without names for its borders; any other as it is.
    pub fn untrimmed(&self) -> Self {
        let parts = self.parts();
        let Some(trim) = &parts.trim else { return self.clone() };
        let sides = if trim.ground == Domain::Triangle { 3 } else { 4 };
        let borders = (0..sides).map(|_| Border::straight(Side::Free)).collect();
        Self::new(Parts { domain: trim.ground, borders, trim: None, ..parts.clone() })
    }

    /// Whether it is a plane, trimmed or not, whose parameters are straight and even.
    pub fn is_flat(&self) -> bool {
        matches!(self.parts().shape, Shape::Plane(_))
    }

    /// Number of sides of each loop, the outer one first; one loop of all sides for what is not trimmed.
    pub fn loops(&self) -> Vec<usize> {
        self.parts().trim.as_ref().map_or_else(|| vec![self.n_sides()], |trim| trim.loops.clone())
    }

    /// The straight line in (u, v) that a border of a trimmed surface is, in the loop's direction; `None` for one that is a
    /// curve there.
    pub fn border_line(&self, k: usize) -> Option<((f64, f64), (f64, f64))> {
        match self.parts().trim.as_ref()?.courses.get(k)? {
            TrimCurve::Line(a, b) => Some((*a, *b)),
            TrimCurve::Pcurve(_) => None,
        }
    }

    /// (u, v) of the point of a border's chain at a fraction of the chain; borders of trimmed surfaces and of planes.
    ///
    /// Beyond 0…1 where the surface closes and the border crosses its seam.
    pub fn border_place(&self, k: usize, fraction: f64) -> Option<(f64, f64)> {
        self.border_place_by(None, k, fraction)
    }

    /// The same with the surface made ready, where it is.
    pub fn border_place_by(&self, quick: Option<&PowerForm>, k: usize, fraction: f64) -> Option<(f64, f64)> {
        let Side::Chain { chain, .. } = self.side(k) else { return None };
        let p = chain.point(fraction);
        let course = self.parts().trim.as_ref().and_then(|trim| trim.courses.get(k));
        match course {
            _ if self.is_flat() => self.flat_uv(p),
            Some(TrimCurve::Line(a, b)) => {
                let t = self.side_parameter(k, fraction);
                Some((a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t))
            }
            Some(TrimCurve::Pcurve(pcurve)) => {
                let uv = foot((self, quick), p, pcurve.guess(fraction)).0;
                Some((uv.x, uv.y))
            }
            None => None,
        }
    }

    /// About where a share of the length of a border lies in (u, v), and how far from there it may be; exact on planes and for straight
    /// lines in (u, v). `None` for a border of which nothing is known there.
    pub fn border_about(&self, k: usize, share: f64) -> Option<(DVec2, f64)> {
        let course = self.parts().trim.as_ref().and_then(|trim| trim.courses.get(k));
        match (self.side(k), course) {
            (Side::Chain { chain, from, to }, _) if self.is_flat() => {
                Some((self.flat_uv(chain.point(from + (to - from) * share))?.into(), 0.0))
            }
            (_, Some(TrimCurve::Line(a, b))) => Some((DVec2::from(*a).lerp(DVec2::from(*b), share), 0.0)),
            (Side::Chain { from, to, .. }, Some(TrimCurve::Pcurve(pcurve))) => Some(pcurve.about(from + (to - from) * share)),
            _ => None,
        }
    }

    /// How far the borders of a trimmed surface are from it and the end of each from the start of the next one, at most, model
    /// units; 0 for others. Along a border it is measured where it was followed.
    pub fn gap(&self) -> f64 {
        let Some(trim) = &self.parts().trim else { return 0.0 };
        let off = trim.courses.iter().map(|c| if let TrimCurve::Pcurve(pcurve) = c { pcurve.off } else { 0.0 }).fold(0.0, f64::max);
        let end = |k: usize| match self.side(k) {
            Side::Chain { chain, to, .. } => Some(chain.point(to)),
            _ => self.border_line(k).map(|(_, b)| self.point(b.0, b.1)),
        };
        let (mut widest, mut first) = (off, 0);
        for n in &trim.loops {
            for k in 0..*n {
                if let (Some(a), Some(b)) = (end(first + k), self.border_start(first + (k + 1) % n)) {
                    widest = widest.max(a.distance(b));
                }
            }
            first += n;
        }
        widest
    }

    /// The loops as polygons in (u, v) whose corners lie on the borders.
    pub fn outlines(&self) -> Vec<Vec<DVec2>> {
        let Some(trim) = &self.parts().trim else { return Vec::new() };
        let mut first = 0;
        let polygon = |n: &usize| {
            let range = first..first + n;
            first += n;
            range
                .flat_map(|k| {
                    let mut places = trim.courses[k].places();
                    places.pop();
                    places
                })
                .collect()
        };
        trim.loops.iter().map(polygon).collect()
    }

    /// Whether a place lies in the kept part, by the polygons of [`Surface::outlines`].
    pub fn keeps(&self, u: f64, v: f64) -> bool {
        let outlines = self.outlines();
        self.copies((u, v)).into_iter().any(|p| outlines.iter().fold(false, |kept, polygon| kept != inside(polygon, p)))
    }

    /// The nearest place at which the surface is defined; directions in which it closes go on without end.
    pub(super) fn hold(&self, uv: DVec2) -> DVec2 {
        let (closed_u, closed_v) = self.closed();
        let hold = |x: f64, closed: bool| if closed { x } else { x.clamp(0.0, 1.0) };
        match self.ground() {
            Domain::Square => DVec2::new(hold(uv.x, closed_u), hold(uv.y, closed_v)),
            Domain::Triangle => {
                let (u, v) = (uv.x.clamp(0.0, 1.0), uv.y.clamp(0.0, 1.0));
                let over = 0.5 * (u + v - 1.0).max(0.0);
                DVec2::new((u - over).max(0.0), (v - over).max(0.0))
            }
            Domain::Loop | Domain::Unbounded => uv,
        }
    }

    /// Points of a border: the start of each of a loop's sides.
    pub fn border_start(&self, k: usize) -> Option<DVec3> {
        match self.side(k) {
            Side::Chain { chain, from, .. } => Some(chain.point(from)),
            _ => self.border_line(k).map(|(a, _)| self.point(a.0, a.1)),
        }
    }
}
