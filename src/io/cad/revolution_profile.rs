//! Profiles that meet the axis about which they are turned: they are cut there, and one part makes the surface.
//!
//! | what decides which part is meant | the part |
//! |---|---|
//! | the loops, or a vertex that bounds the face, lie on one part alone | that one |
//! | all parts in question make the same surface | one along which a loop runs, else one that runs up the axis |
//! | nothing, and the profile of a face closes | one that runs up the axis, which is reported |
//! | nothing else, and there are no loops | all of them: the face is several surfaces |
//! | nothing, and there are loops | none: the face is refused |
//!
//! A part that runs up the axis has normals away from it.

use glam::DVec3;

use crate::base::math;
use crate::base::tolerance::{EPSILON, NEAR_MISS, Tolerance};
use crate::geometry::closest;
use crate::geometry::construct::build;
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::Shape;
use crate::geometry::query::intersect::{Hit, intersect};
use crate::geometry::{Curve, Kind, Motion};
use crate::io::cad::base_surface::Base;
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face_loops::FaceLoops;
use crate::surface::swept::revolve::Axis;

const TURN: f64 = std::f64::consts::TAU;
/// Places along a part at which it is compared with others.
const SAMPLES: usize = 16;

/// A surface that touches its axis with the ends of its profile only, and what was guessed for it.
#[derive(Clone, Debug)]
pub struct Clear {
    /// The surface.
    pub base: Base,
    /// Others that are meant as well, where nothing bounds it.
    pub also: Vec<Base>,
    /// Why another part could be meant as well.
    pub doubt: Option<String>,
}

impl Base {
    /// The same surface, of a profile that crosses its axis the part that is meant; `slack` is what may lie between two points that are one.
    pub fn clear_of_axis(self, loops: &FaceLoops, slack: f64, tolerance: &Tolerance) -> Result<Clear, Defect> {
        let sure = |base: Self| Clear { base, also: Vec::new(), doubt: None };
        let (profile, axis, angles) = match &self {
            Self::Turned { profile, axis, angles, .. } => (profile, *axis, *angles),
            Self::Round { profile, axis } => (profile, *axis, (0.0, TURN)),
            Self::Unbounded { slope, .. } if *slope != 0.0 => return Ok(sure(self.on_one_side(loops, slack)?)),
            _ => return Ok(sure(self)),
        };
        let Some(mut parts) = parts(profile, &axis, tolerance)? else { return Ok(sure(self)) };
        let of = |profile: Curve| match &self {
            Self::Round { .. } => Self::Round { axis, profile },
            _ => Self::Turned { axis, profile, angles, first: None },
        };
        match parts.len() {
            0 => Err(defect("its profile lies in its axis")),
            1 => Ok(sure(of(parts.remove(0)))),
            _ => {
                let is_closed = profile.is_closed(tolerance);
                let turned = parts.into_iter().map(|part| Turned::of(part, axis, angles)).collect();
                let (mut chosen, doubt) = chosen(turned, &axis, is_closed, loops, slack)?;
                let base = of(chosen.remove(0));
                Ok(Clear { base, also: chosen.into_iter().map(of).collect(), doubt })
            }
        }
    }

    /// A cone on the side of its apex where the loops are.
    fn on_one_side(self, loops: &FaceLoops, slack: f64) -> Result<Self, Defect> {
        let Self::Unbounded { axis, radius, slope, reference } = self else { return Ok(self) };
        // Radii above 0 at heights where the file has them, below 0 beyond the apex.
        let radius_at = |p: DVec3| radius + slope * (p - axis.about).dot(axis.direction);
        let room = slack * slope.abs().max(1.0);
        let (mut before, mut beyond) = (false, false);
        for p in loops.points() {
            before |= radius_at(p) > room;
            beyond |= radius_at(p) < -room;
        }
        match (before, beyond) {
            (true, true) => Err(defect("its loops lie on both sides of its apex")),
            (false, true) => Ok(Self::Unbounded { axis, radius: -radius, slope: -slope, reference: -reference }),
            _ => Ok(Self::Unbounded { axis, radius, slope, reference }),
        }
    }
}

/// The parts into which an axis cuts a curve, those in the axis left out; `None` for one that only its ends may touch.
fn parts(curve: &Curve, axis: &Axis, tolerance: &Tolerance) -> Result<Option<Vec<Curve>>, Defect> {
    let bounds = curve.bbox();
    let middle = axis.direction.dot(bounds.center() - axis.about);
    let reach = 2.0 * bounds.diagonal().max(tolerance.point);
    let at = |x: f64| axis.about + axis.direction * x;
    let line = build::line(at(middle - reach), at(middle + reach), curve.origin())?;
    let (t0, t1) = curve.domain();
    let is_closed = curve.is_closed(tolerance);
    let mut places = Vec::new();
    for hit in intersect(curve, &line, tolerance)? {
        match hit {
            Hit::Point { ta, .. } => places.push(ta),
            Hit::Overlap { a: (a, b), .. } => places.extend([a, b]),
        }
    }
    places.sort_by(f64::total_cmp);
    let apart = |a: f64, b: f64| (curve.length_at(b) - curve.length_at(a)).abs() > tolerance.point;
    let at_seam = places.iter().any(|t| !apart(t0, *t) || !apart(*t, t1));
    let mut stops = vec![t0];
    for t in places {
        if apart(stops[stops.len() - 1], t) && apart(t, t1) {
            stops.push(t);
        }
    }
    if stops.len() == 1 {
        return Ok(None);
    }
    stops.push(t1);
    let mut made: Vec<Curve> = stops.windows(2).map(|w| curve.part(w[0], w[1])).collect();
    if is_closed && !at_seam {
        // What comes back over the start of the curve is one part.
        let (first, last) = (made.remove(0), made.remove(made.len() - 1));
        made.push(match curve.shape() {
            Shape::Arc(arc) => {
                let (from, to) = (stops[stops.len() - 2], stops[1] + arc.sweep);
                let kind = if arc.radius.is_some() { Kind::Arc } else { Kind::Ellipse };
                Curve::new(Shape::Arc(Box::new(arc.part(from, to))), kind, curve.origin())
            }
            _ => {
                let pieces = crate::io::cad::border::pieces(&last).into_iter().chain(crate::io::cad::border::pieces(&first));
                Curve::new(Shape::Composite(std::sync::Arc::new(Composite::new(pieces))), Kind::Composite, curve.origin())
            }
        });
    }
    let off_axis = |p: DVec3| (p - axis.about).reject_from_normalized(axis.direction).length() > tolerance.point;
    made.retain(|part| places_of(part).any(off_axis));
    Ok(Some(made))
}

/// A part of a profile, turned.
struct Turned {
    part: Curve,
    axis: Axis,
    angles: (f64, f64),
    /// Unit vector from the axis to where the part is farthest from it.
    side: DVec3,
}

impl Turned {
    fn of(part: Curve, axis: Axis, angles: (f64, f64)) -> Self {
        let out = |p: DVec3| (p - axis.about).reject_from_normalized(axis.direction);
        let far = places_of(&part).map(out).fold(DVec3::ZERO, |most, v| if v.length() > most.length() { v } else { most });
        Self { side: far.normalize_or_zero(), part, axis, angles }
    }

    /// Largest distance of the part from the plane of the axis and its side.
    fn off_plane(&self) -> f64 {
        let normal = self.axis.direction.cross(self.side);
        places_of(&self.part).map(|p| (p - self.axis.about).dot(normal).abs()).fold(0.0, f64::max)
    }

    /// How far a point is from the turned part: turned back into the plane of the part as far as the part is turned.
    fn distance(&self, p: DVec3) -> f64 {
        let from = p - self.axis.about;
        let angle = math::atan2(from.dot(self.axis.direction.cross(self.side)), from.dot(self.side));
        let (a, b) = self.angles;
        let back = if b - a >= TURN * (1.0 - EPSILON) {
            angle
        } else {
            let beyond = (angle - a).rem_euclid(TURN);
            if beyond <= b - a {
                a + beyond
            } else if beyond - (b - a) < TURN - beyond {
                b
            } else {
                a
            }
        };
        closest(&self.part, Motion::rotation(self.axis.about, self.axis.direction, -back).point(p)).distance
    }

    /// Places of the turned part.
    fn places(&self) -> impl Iterator<Item = DVec3> + '_ {
        let middle = Motion::rotation(self.axis.about, self.axis.direction, 0.5 * (self.angles.0 + self.angles.1));
        places_of(&self.part).map(move |p| middle.point(p))
    }

    /// Whether another one lies on it.
    fn covers(&self, other: &Self, slack: f64) -> bool {
        other.places().all(|p| self.distance(p) <= slack)
    }

    fn is_same(&self, other: &Self, slack: f64) -> bool {
        self.covers(other, slack) && other.covers(self, slack)
    }
}

/// The part that is meant, or all that are, and why another could be as well.
fn chosen(parts: Vec<Turned>, axis: &Axis, is_closed: bool, loops: &FaceLoops, slack: f64) -> Result<(Vec<Curve>, Option<String>), Defect> {
    let count = parts.len();
    if parts.iter().any(|part| part.off_plane() > slack) {
        return Err(defect(format!("its axis cuts its profile into {count} parts that do not lie in one plane with it")));
    }
    let points: Vec<DVec3> = loops.points().collect();
    let off = |part: &Turned| points.iter().map(|p| part.distance(*p)).fold(0.0, f64::max);
    let offs: Vec<f64> = parts.iter().map(off).collect();
    let least = offs.iter().copied().fold(f64::INFINITY, f64::min);
    let on_any = |p: &DVec3| parts.iter().any(|part| part.distance(*p) <= slack);
    if least > NEAR_MISS * slack && points.iter().all(on_any) {
        return Err(defect(format!("its loops lie on several of the {count} parts into which its axis cuts its profile")));
    }
    let mut meant: Vec<&Turned> = parts.iter().zip(&offs).filter(|(_, off)| **off <= least + slack).map(|(part, _)| part).collect();
    for vertex in loops.vertices {
        let on: Vec<&Turned> = meant.iter().filter(|part| part.distance(*vertex) <= slack).copied().collect();
        meant = if on.is_empty() { meant } else { on };
    }
    // What lies on another part is there with it.
    let larger = |part: &&Turned| meant.iter().any(|other| other.covers(part, slack) && !part.covers(other, slack));
    let meant: Vec<&Turned> = meant.iter().filter(|part| !larger(part)).copied().collect();
    let beside = |part: &Turned| points.iter().filter(|p| closest(&part.part, **p).distance <= slack).count();
    let runs_up = |part: &Turned| (part.part.end() - part.part.start()).dot(axis.direction) > 0.0;
    // Of equals the first.
    let Some(best) = meant.iter().rev().max_by_key(|part| (beside(part), runs_up(part))) else {
        return Err(defect("its profile has no parts"));
    };
    if meant.iter().all(|part| part.is_same(best, slack)) {
        // Of a closed surface the side of a loop that goes round the axis follows from the normal, and that of each half is the other way.
        let most = beside(best);
        let is_open = is_closed && meant.iter().filter(|part| beside(part) == most).count() > 1 && loops.wind_about(axis);
        let doubt = is_open.then(|| {
            format!(
                "its profile covers it {} times, and its orientation is ambiguous; its normals are taken to point away from its axis",
                meant.len()
            )
        });
        return Ok((vec![best.part.clone()], doubt));
    }
    if !points.is_empty() {
        return Err(defect(format!("its axis cuts its profile into {count} parts, and it is ambiguous which is meant")));
    }
    if is_closed && !loops.vertices.is_empty() {
        let doubt = format!(
            "its axis cuts its profile into {count} parts, and it is ambiguous which is meant; the one that runs up the axis is used"
        );
        return Ok((vec![best.part.clone()], Some(doubt)));
    }
    let mut distinct: Vec<&Turned> = Vec::new();
    for part in &meant {
        if !distinct.iter().any(|known| known.is_same(part, slack)) {
            distinct.push(part);
        }
    }
    Ok((distinct.into_iter().map(|part| part.part.clone()).collect(), None))
}

/// Places along a curve, its ends included.
fn places_of(curve: &Curve) -> impl Iterator<Item = DVec3> + '_ {
    let (a, b) = curve.domain();
    (0..=SAMPLES).map(move |k| curve.point(a + (b - a) * k as f64 / SAMPLES as f64))
}
