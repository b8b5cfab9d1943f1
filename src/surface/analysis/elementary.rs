//! What an extruded or revolved surface, or a plane, is by its simplest name: plane, cylinder, cone, sphere or torus.

use glam::DVec3;

use crate::base::tolerance::{BESIDE, NUDGE, PARALLEL, Tolerance};
use crate::geometry::Curve;
use crate::geometry::curves::curve::Shape as CurveShape;
use crate::geometry::shapes::arc::EllipticArc;
use crate::network::Chain;
use crate::surface::analysis::iso_line::IsoLine;
use crate::surface::core::plane::unmapped;
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::kind::{Domain, SurfaceKind};
use crate::surface::rails::rail::Rail;
use crate::surface::rails::side::between;
use crate::surface::shapes::sweep::Path;
use crate::surface::swept::revolve::Axis;
use crate::surface::trims::divide::split;

/// An exact form without knots.
#[derive(Clone, Debug)]
pub enum Form {
    /// A plane with its unit normal.
    Plane {
        /// A point of it.
        at: DVec3,
        /// Unit normal.
        normal: DVec3,
    },
    /// A cylinder; its normal points out.
    Cylinder {
        /// Its axis.
        axis: Axis,
        /// Radius, model units.
        radius: f64,
    },
    /// A cone whose radius grows along its axis; its normal points out.
    Cone {
        /// Its axis; the point is where the radius is known.
        axis: Axis,
        /// Radius there, model units, 0 at the apex.
        radius: f64,
        /// Angle between the axis and its lines, radians.
        angle: f64,
    },
    /// A sphere; its normal points out.
    Sphere {
        /// The centre and the direction of its poles.
        axis: Axis,
        /// Radius, model units.
        radius: f64,
    },
    /// A ring torus; its normal points out.
    Torus {
        /// Its axis through its middle.
        axis: Axis,
        /// Radius of the circle of centres, model units.
        major: f64,
        /// Radius of the tube, model units, less than the other one.
        minor: f64,
    },
}

/// A form and where it begins.
#[derive(Clone, Debug)]
pub struct Elementary {
    /// The form.
    pub form: Form,
    /// Direction from the axis, or in the plane, to where the surface has its seam or first border; a unit vector across the axis.
    pub reference: DVec3,
    /// The normal of the form is the surface's.
    pub along: bool,
}

impl Surface {
    /// The exact form between two values of v of an extruded or revolved surface, or of a plane; `None` for what has none.
    pub fn elementary(&self, v: (f64, f64), tolerance: &Tolerance) -> Option<Elementary> {
        let parts = self.parts();
        match &parts.shape {
            Shape::Plane(_) => Some(self.flat_form()),
            // A map over a plane does not change where it is.
            _ if parts.kind == SurfaceKind::Plane => {
                let flat = unmapped(self, tolerance).ok().filter(Surface::is_flat)?;
                let jet = self.jet(0.5, 0.5 * (v.0 + v.1));
                let found = flat.flat_form();
                Some(Elementary { along: found.form.normal_is(jet.p, jet.du.cross(jet.dv)), ..found })
            }
            Shape::Sweep(_) => {
                let v = self.within_joints(v, tolerance);
                let (profile, path) = self.moved_profile(v, tolerance)?;
                let (form, reference) = match path {
                    Path::Straight { by } => extruded(&profile, by),
                    Path::Turn { about, axis, angle } => turned(&profile, Axis { about, direction: axis * angle.signum() }, tolerance),
                }?;
                // In the middle of the interval, away from poles.
                let jet = self.jet(0.5, 0.5 * (v.0 + v.1));
                let along = form.normal_is(jet.p, jet.du.cross(jet.dv));
                Some(Elementary { form, reference, along })
            }
            _ => None,
        }
    }
}

/// An arc of a circle or an ellipse, moved or turned: exact where it is no [`Form`].
#[derive(Clone, Debug)]
pub struct MovedArc {
    /// The arc; the normal of the surface is its direction across that of the way for a straight way, else the other way round.
    pub profile: EllipticArc,
    /// Its way.
    pub path: Path,
}

impl Surface {
    /// The arc that makes an extruded or revolved surface between two values of v; `None` where that is no single arc.
    pub fn moved_arc(&self, v: (f64, f64), tolerance: &Tolerance) -> Option<MovedArc> {
        let v = self.within_joints(v, tolerance);
        let (profile, path) = self.moved_profile(v, tolerance)?;
        let CurveShape::Arc(arc) = profile.shape() else { return None };
        let middle = arc.jet(0.5 * arc.sweep);
        let way = match path {
            Path::Straight { by } => by,
            Path::Turn { about, axis, .. } => {
                // An end beside the axis is a pole within the tolerance, and none of the arc itself.
                let off = |p: DVec3| (p - about).reject_from_normalized(axis).length();
                if off(profile.start()).min(off(profile.end())) <= BESIDE * profile.length() {
                    return None;
                }
                (middle.p - about).cross(axis)
            }
        };
        let jet = self.jet(0.0, 0.5 * (v.0 + v.1));
        let along = middle.d1.cross(way).dot(jet.du.cross(jet.dv)) > 0.0;
        Some(MovedArc { profile: if along { **arc } else { arc.reversed() }, path })
    }

    /// The profile of a sweep between two values of v, and its way.
    fn moved_profile(&self, v: (f64, f64), tolerance: &Tolerance) -> Option<(Curve, Path)> {
        let parts = self.parts();
        let Shape::Sweep(sweep) = &parts.shape else { return None };
        let Rail::Chain { chain, map, .. } = sweep.profile() else { return None };
        let (from, to) = if parts.flipped { (1.0 - v.1, 1.0 - v.0) } else { v };
        let profile = between(chain, map.value(from), map.value(to), tolerance).ok()?.to_curve().ok()?;
        Some((profile, sweep.path()))
    }

    /// The values of v between two [`Surface::form_joints`] that hold all loops of a trimmed surface, or the whole of it; of any other
    /// surface those given.
    fn within_joints(&self, v: (f64, f64), tolerance: &Tolerance) -> (f64, f64) {
        if self.domain() != Domain::Loop {
            return v;
        }
        let joints = self.form_joints(tolerance);
        if joints.is_empty() {
            return (0.0, 1.0);
        }
        let Some((low, high)) = self.reach_of_loops() else { return (0.0, 1.0) };
        let stops = [&[0.0][..], &joints, &[1.0]].concat();
        let holds = |w: &[f64]| w[0] <= low + NUDGE && high - NUDGE <= w[1];
        stops.windows(2).find(|w| holds(w)).map_or((0.0, 1.0), |w| (w[0], w[1]))
    }

    /// Least and largest v of the loops of a trimmed surface, moved by whole turns to where they begin at 0 or above.
    fn reach_of_loops(&self) -> Option<(f64, f64)> {
        let places = || self.outlines().into_iter().flatten().map(|place| place.y);
        let (low, high) = places().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        let turns = if self.closed().1 { (low + NUDGE).floor() } else { 0.0 };
        (low <= high).then_some((low - turns, high - turns))
    }

    /// The plane of a flat surface.
    fn flat_form(&self) -> Elementary {
        let jet = self.jet(0.0, 0.0);
        let normal = jet.du.cross(jet.dv).normalize_or_zero();
        Elementary { form: Form::Plane { at: jet.p, normal }, reference: jet.du.normalize_or_zero(), along: true }
    }

    /// Values of v where two pieces of the profile of an extruded or revolved surface meet, at least one of them a line or an arc of a
    /// circle, ascending: between them it may have exact forms that it does not have as a whole.
    pub fn form_joints(&self, tolerance: &Tolerance) -> Vec<f64> {
        let parts = self.parts();
        let Shape::Sweep(sweep) = &parts.shape else { return Vec::new() };
        let Rail::Chain { chain, map, .. } = sweep.profile() else { return Vec::new() };
        let Ok(profile) = chain.to_curve() else { return Vec::new() };
        let Some(row) = profile.composite() else { return Vec::new() };
        let is_simple = |piece: &Curve| matches!(piece.shape(), CurveShape::Line(..)) || round(piece).is_some();
        let joints = (1..row.pieces.len()).filter(|k| is_simple(&row.pieces[k - 1]) || is_simple(&row.pieces[*k]));
        let value = |k: usize| map.inverse(row.starts()[k] / profile.length());
        let mut values: Vec<f64> = joints.map(|k| if parts.flipped { 1.0 - value(k) } else { value(k) }).collect();
        values.retain(|v| *v > tolerance.parameter && *v < 1.0 - tolerance.parameter);
        values.sort_by(f64::total_cmp);
        values
    }
}

impl Surface {
    /// Whether it has an exact form, or parts with such between [`Surface::form_joints`].
    pub fn has_forms(&self, tolerance: &Tolerance) -> bool {
        match self.domain() {
            Domain::Unbounded => false,
            Domain::Square => {
                let stops = [&[0.0][..], &self.form_joints(tolerance), &[1.0]].concat();
                stops.windows(2).all(|w| self.elementary((w[0], w[1]), tolerance).is_some())
            }
            _ => self.elementary((0.0, 1.0), tolerance).is_some(),
        }
    }

    /// The parts into which lines along [`Surface::form_joints`] divide a trimmed surface; none where there is one only.
    pub fn in_forms(&self, tolerance: &Tolerance) -> Vec<Self> {
        let mut stops = if self.domain() == Domain::Loop { self.form_joints(tolerance) } else { Vec::new() };
        if stops.is_empty() {
            return Vec::new();
        }
        let Some((low, high)) = self.reach_of_loops() else { return Vec::new() };
        if self.closed().1 {
            let again: Vec<f64> = stops.iter().map(|v| v + 1.0).collect();
            stops = [&stops[..], &[1.0], &again].concat();
        }
        let is_round = self.closed().1 && high - low >= 1.0 - NUDGE;
        stops.retain(|v| if is_round { *v <= 1.0 } else { *v > low + NUDGE && *v < high - NUDGE });
        let ground = self.untrimmed();
        let line = |v: &f64| ground.iso(IsoLine::V(v.fract()), self.origin(), tolerance).ok().flatten().map(|line| Chain::of_curve(&line));
        let cutters: Option<Vec<Chain>> = stops.iter().map(line).collect();
        let parts = cutters.filter(|cutters| !cutters.is_empty()).and_then(|cutters| split(self, &cutters, self.origin(), tolerance).ok());
        parts.filter(|parts| parts.len() > 1).unwrap_or_default()
    }
}

impl Form {
    /// Whether a normal at a point of it is its own, or the one against it.
    fn normal_is(&self, p: DVec3, normal: DVec3) -> bool {
        let out = |axis: &Axis| (p - axis.about).reject_from(axis.direction);
        let own = match self {
            Self::Plane { normal, .. } => *normal,
            Self::Cylinder { axis, .. } | Self::Cone { axis, .. } => out(axis),
            Self::Sphere { axis, .. } => p - axis.about,
            Self::Torus { axis, major, .. } => p - (axis.about + out(axis).normalize_or_zero() * *major),
        };
        own.dot(normal) > 0.0
    }
}

fn round(profile: &Curve) -> Option<(EllipticArc, f64)> {
    let CurveShape::Arc(arc) = profile.shape() else { return None };
    arc.radius.map(|radius| (**arc, radius))
}

/// An extruded profile, with the direction from the axis to its start.
fn extruded(profile: &Curve, by: DVec3) -> Option<(Form, DVec3)> {
    let way = by.normalize_or_zero();
    if let CurveShape::Line(a, b) = profile.shape() {
        return Some((Form::Plane { at: *a, normal: by.cross(*b - *a).normalize_or_zero() }, way));
    }
    let (arc, radius) = round(profile)?;
    let normal = arc.u.cross(arc.v).normalize_or_zero();
    let straight = normal.cross(way).length() <= PARALLEL;
    straight.then(|| (Form::Cylinder { axis: Axis { about: arc.center, direction: normal }, radius }, arc.u.normalize_or_zero()))
}

/// A profile turned about an axis, with the direction from the axis to it.
fn turned(profile: &Curve, axis: Axis, tolerance: &Tolerance) -> Option<(Form, DVec3)> {
    let out = |p: DVec3| (p - axis.about).reject_from_normalized(axis.direction);
    let foot = |p: DVec3| axis.about + axis.direction * axis.direction.dot(p - axis.about);
    // Both ends of a sphere's profile lie on the axis.
    let (from, to) = profile.domain();
    let places = [profile.start(), profile.end(), profile.point(0.5 * (from + to))].map(out);
    let farthest = places.into_iter().fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
    let reference = farthest.normalize_or_zero();
    // Whether a direction and a point lie in the half plane of the axis through the reference.
    let across = axis.direction.cross(reference);
    let in_plane = |p: DVec3| across.dot(p - axis.about).abs() <= tolerance.rounding;
    let form = match profile.shape() {
        CurveShape::Line(a, b) if in_plane(*a) && in_plane(*b) => {
            let (along, ra, rb) = (axis.direction.dot(*b - *a), reference.dot(*a - axis.about), reference.dot(*b - axis.about));
            let size = (*b - *a).length();
            if along.abs() <= PARALLEL * size {
                Some(Form::Plane { at: foot(*a), normal: axis.direction * (ra - rb).signum() })
            } else if (rb - ra).abs() <= PARALLEL * size {
                Some(Form::Cylinder { axis: Axis { about: foot(*a), ..axis }, radius: ra })
            } else {
                // From its narrow end to its wide one.
                let (narrow, radius) = if ra < rb { (*a, ra) } else { (*b, rb) };
                let grows = along * (rb - ra) > 0.0;
                let direction = if grows { axis.direction } else { -axis.direction };
                let angle = crate::base::math::atan2((rb - ra).abs(), along.abs());
                let radius = if radius <= tolerance.rounding { 0.0 } else { radius };
                (radius >= 0.0).then(|| Form::Cone { axis: Axis { about: foot(narrow), direction }, radius, angle })
            }
        }
        _ => round(profile).and_then(|(arc, minor)| {
            let normal = arc.u.cross(arc.v).normalize_or_zero();
            let major = out(arc.center).length();
            if normal.dot(axis.direction).abs() > PARALLEL || normal.dot(arc.center - axis.about).abs() > tolerance.rounding {
                None
            } else if major <= tolerance.rounding {
                Some(Form::Sphere { axis: Axis { about: foot(arc.center), ..axis }, radius: minor })
            } else {
                (major > minor + tolerance.point).then(|| Form::Torus { axis: Axis { about: foot(arc.center), ..axis }, major, minor })
            }
        }),
    };
    form.map(|form| (form, reference))
}
