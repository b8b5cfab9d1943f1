//! Surfaces of CAD files: exact, with the parameters that the file gives them.

use glam::{DAffine3, DVec3};

use crate::base::bbox::Box3;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::geometry::construct::build;
use crate::geometry::shapes::nurbs::projected;
use crate::geometry::{Curve, Motion};
use crate::io::cad::control_nets::ruled_net;
use crate::io::cad::curves::{check_reach, transformed, transformed_pole};
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face_loops::FaceLoops;
use crate::network::Chain;
use crate::surface::core::plane;
use crate::surface::swept::extrude;
use crate::surface::swept::revolve::{self, Axis};
use crate::surface::{NurbsSurface, Surface, SurfaceKind, ruled_as_drawn};

/// A surface of the file in model units; (u, v) are the file's.
#[derive(Clone, Debug)]
pub enum Base {
    /// A net over the file's first and last u, first and last v.
    Net(NurbsSurface, [f64; 4]),
    /// All of a plane: a point and two unit vectors at right angles.
    Plane(DVec3, DVec3, DVec3),
    /// u is the profile's parameter, v the angle from `start` to `end`, radians.
    Turned {
        /// Axis of the turn.
        axis: Axis,
        /// The curve that is turned.
        profile: Curve,
        /// First and last angle.
        angles: (f64, f64),
        /// The file's parameter where the profile is an arc and begins: its angle there.
        first: Option<f64>,
    },
    /// A sphere or torus: a whole turn of an arc, with the side that the file gives it.
    Round {
        /// Axis of the turn.
        axis: Axis,
        /// The arc that is turned.
        profile: Curve,
    },
    /// u is the profile's parameter from 0 to 1, v runs along `by`.
    Swept {
        /// The curve that is swept.
        profile: Curve,
        /// How far.
        by: DVec3,
    },
    /// u runs along both curves from 0 to 1, by their parameters or by their lengths, v from the first to the second.
    Ruled {
        /// Where v is 0 and 1.
        rails: [Curve; 2],
        /// Equal shares of the arc lengths are joined, else of the parameters.
        by_length: bool,
    },
    /// A cylinder or cone without ends: axis with a point of it, radius there and its growth along the axis, start of the angle.
    Unbounded {
        /// Its axis.
        axis: Axis,
        /// Radius at the axis' point.
        radius: f64,
        /// Growth of the radius along the axis.
        slope: f64,
        /// Unit vector from the axis where the angle is 0.
        reference: DVec3,
    },
}

/// Whether equal steps of the parameter are equal lengths.
fn even(curve: &Curve) -> bool {
    use crate::geometry::curves::curve::Shape;
    match curve.shape() {
        Shape::Line(..) => true,
        Shape::Arc(arc) => arc.radius.is_some(),
        _ => false,
    }
}

impl Base {
    /// A sphere about a point of an axis; u is the angle from `reference`, v the latitude.
    pub fn sphere(axis: &Axis, radius: f64, reference: DVec3, origin: Origin) -> Result<Self, Defect> {
        let across = axis.direction.cross(reference);
        let start = axis.about - axis.direction * radius;
        Ok(Self::Round { axis: *axis, profile: build::arc_center(axis.about, start, std::f64::consts::PI, -across, origin)? })
    }

    /// A torus about an axis; u is the angle from `reference`, v that of the tube from its outermost circle upwards.
    pub fn torus(axis: &Axis, radii: [f64; 2], reference: DVec3, origin: Origin) -> Result<Self, Defect> {
        let center = axis.about + reference * radii[0];
        let start = center + reference * radii[1];
        Ok(Self::Round { axis: *axis, profile: build::circle_start(center, start, -axis.direction.cross(reference), origin)? })
    }

    /// The surface value; one without ends reaches a little beyond the box.
    pub fn surface(&self, reach: &Box3, origin: Origin, tolerance: &Tolerance) -> Result<Surface, Defect> {
        if let Base::Plane(at, u, v) = self {
            if reach.is_empty() {
                return Err(defect("it is a plane without a border"));
            }
            return Ok(plane::unbounded(*at, u.cross(*v), origin)?);
        }
        if let Base::Ruled { rails: [a, b], by_length: true } = self
            && !(even(a) && even(b))
        {
            let chains = [Chain::of_curve(a), Chain::of_curve(b)];
            return Ok(ruled_as_drawn(&chains[0], &chains[1], origin, tolerance)?.0);
        }
        if let Some(surface) = self.moved_curve(reach, origin, tolerance)? {
            return Ok(surface);
        }
        let net = self.net(reach, tolerance)?;
        check_reach(net.poles.iter().map(|q| projected(*q)))?;
        let first = net.poles[0];
        let flat = net.poles.iter().all(|q| projected(*q).distance(projected(first)) <= tolerance.rounding);
        if flat {
            return Err(defect("all its control points coincide"));
        }
        Ok(net.surface(SurfaceKind::Nurbs, origin, tolerance))
    }

    /// Transformed by a matrix; a turned surface by one that distorts becomes a net.
    pub fn transformed(self, m: &DAffine3, tolerance: &Tolerance) -> Result<Self, Defect> {
        let point = |p: DVec3| m.transform_point3(p);
        let turns = |v: DVec3| m.transform_vector3(v).normalize_or_zero();
        // A mirror turns the sense of a rotation.
        let sense = m.matrix3.determinant().signum();
        let moved = |axis: &Axis| Axis { about: point(axis.about), direction: turns(axis.direction) * sense };
        Ok(match self {
            Self::Net(net, range) => Self::Net(transformed_net(net, m), range),
            Self::Plane(at, u, v) => Self::Plane(point(at), turns(u), turns(v)),
            Self::Turned { axis, profile, angles, first } if is_rigid(m) => {
                Self::Turned { axis: moved(&axis), profile: transformed(&profile, m, tolerance)?, angles, first }
            }
            Self::Unbounded { axis, radius, slope, reference } if is_rigid(m) => {
                let slope = slope * sense;
                Self::Unbounded { axis: moved(&axis), radius, slope, reference: turns(reference) }
            }
            Self::Unbounded { .. } => return Err(defect("its matrix distorts it")),
            Self::Turned { .. } => {
                let net = self.net(&Box3::EMPTY, tolerance)?;
                Self::Net(transformed_net(net, m), [f64::NAN; 4])
            }
            Self::Round { axis, profile } if is_rigid(m) => {
                Self::Round { axis: moved(&axis), profile: transformed(&profile, m, tolerance)? }
            }
            Self::Round { .. } => Self::Net(transformed_net(self.net(&Box3::EMPTY, tolerance)?, m), [f64::NAN; 4]),
            Self::Swept { profile, by } => Self::Swept { profile: transformed(&profile, m, tolerance)?, by: m.transform_vector3(by) },
            Self::Ruled { rails: [a, b], by_length } => {
                Self::Ruled { rails: [transformed(&a, m, tolerance)?, transformed(&b, m, tolerance)?], by_length }
            }
        })
    }

    /// Whether the normal of its net is against the file's: that of a turned surface has the angle first.
    pub fn is_against(&self) -> bool {
        matches!(self, Self::Turned { .. })
    }

    /// Whether it lies in a plane.
    pub fn is_flat(&self, tolerance: &Tolerance) -> bool {
        let net = match self {
            Self::Plane(..) => return true,
            Self::Net(net, _) => net,
            _ => return false,
        };
        let first = projected(net.poles[0]);
        let arms = || net.poles.iter().map(|q| projected(*q) - first);
        let longest = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
        let along = arms().fold(DVec3::ZERO, longest);
        let normal = arms().map(|arm| along.cross(arm)).fold(DVec3::ZERO, longest).normalize_or_zero();
        arms().all(|arm| arm.dot(normal).abs() <= tolerance.point)
    }

    /// The exact net over 0…1; a ruled surface by parameters.
    pub fn net(&self, reach: &Box3, tolerance: &Tolerance) -> Result<NurbsSurface, Defect> {
        match self {
            Self::Net(net, _) => Ok(net.clone()),
            Self::Plane(..) => Err(defect("it is a plane without a border")),
            Self::Turned { axis, profile, angles, .. } => {
                let turn = Motion::rotation(axis.about, axis.direction, angles.0);
                let profile = profile.moved(&turn).to_nurbs(tolerance)?;
                Ok(revolve::net(&profile, axis, angles.1 - angles.0))
            }
            Self::Round { axis, profile } => Ok(revolve::net(&profile.to_nurbs(tolerance)?, axis, std::f64::consts::TAU)),
            Self::Swept { profile, by } => Ok(extrude::net(&profile.to_nurbs(tolerance)?, *by)),
            Self::Ruled { rails: [a, b], .. } => Ok(ruled_net(&a.to_nurbs(tolerance)?, &b.to_nurbs(tolerance)?)),
            Self::Unbounded { axis, .. } => match self.whole_turn(reach, Origin::NONE)? {
                Some((profile, _)) => Ok(revolve::net(&profile.to_nurbs(tolerance)?, axis, std::f64::consts::TAU)),
                None => Err(defect("it is infinite")),
            },
        }
    }

    /// A curve that is turned or carried along, where that makes a surface: its bounds and its parameters are better than those of a net.
    fn moved_curve(&self, reach: &Box3, origin: Origin, tolerance: &Tolerance) -> Result<Option<Surface>, Defect> {
        let whole = self.whole_turn(reach, origin)?;
        let (profile, axis, (from, to)) = match (self, &whole) {
            (_, Some((profile, axis))) => (profile, axis, (0.0, std::f64::consts::TAU)),
            (Self::Round { profile, axis }, _) => (profile, axis, (0.0, std::f64::consts::TAU)),
            (Self::Turned { profile, axis, angles, .. }, _) => (profile, axis, *angles),
            (Self::Swept { profile, by }, _) => {
                let poles = profile.to_nurbs(tolerance)?.poles;
                check_reach(poles.iter().map(|q| projected(*q)).flat_map(|p| [p, p + *by]))?;
                let swept = extrude::extrude(&Chain::of_curve(profile), *by, origin, tolerance);
                return Ok(swept.ok().map(|surface| surface.without_curves()));
            }
            _ => return Ok(None),
        };
        check_reach(profile.to_nurbs(tolerance)?.poles.iter().map(|q| projected(*q)))?;
        let profile = profile.moved(&Motion::rotation(axis.about, axis.direction, from));
        let turned = revolve::revolve(&Chain::of_curve(&profile), axis, to - from, origin, tolerance);
        Ok(turned.ok().map(|surface| surface.without_curves()))
    }

    /// A cylinder or cone as a whole turn of a line that reaches a little beyond the box.
    fn whole_turn(&self, reach: &Box3, origin: Origin) -> Result<Option<(Curve, Axis)>, Defect> {
        let Self::Unbounded { axis, radius, slope, reference } = self else { return Ok(None) };
        let (low, high) = along(axis, reach)?;
        // A cone ends at its apex.
        let apex = -radius / slope;
        let (low, high) = (if *slope > 0.0 { low.max(apex) } else { low }, if *slope < 0.0 { high.min(apex) } else { high });
        let at = |h: f64| axis.about + axis.direction * h + *reference * (radius + slope * h).max(0.0);
        Ok(Some((build::line(at(low), at(high), origin)?, *axis)))
    }

    /// The box that the surface must reach for the loops that lie on it: of a cone about whose axis they wind up to its apex.
    pub fn reach(&self, loops: &FaceLoops) -> Box3 {
        match self {
            Self::Unbounded { axis, radius, slope, .. } if *slope != 0.0 && loops.wind_about(axis) => {
                loops.reach.with(axis.about - axis.direction * (radius / slope))
            }
            _ => loops.reach,
        }
    }

    /// The point at the file's (u, v).
    pub fn point(&self, u: f64, v: f64) -> Option<DVec3> {
        use crate::surface::OneSided;
        let share = |x: f64, a: f64, b: f64| ((x - a) / (b - a)).clamp(0.0, 1.0);
        match self {
            Self::Net(net, [u0, u1, v0, v1]) if u0.is_finite() => {
                Some(net.jet(share(u, *u0, *u1), share(v, *v0, *v1), (OneSided::After, OneSided::After)).p)
            }
            Self::Net(..) | Self::Unbounded { .. } | Self::Round { .. } => None,
            Self::Plane(at, a, b) => Some(*at + *a * u + *b * v),
            Self::Turned { axis, profile, first, .. } => {
                Some(Motion::rotation(axis.about, axis.direction, v).point(along_file(profile, *first, u)?))
            }
            Self::Swept { profile, by } => {
                let (a, b) = profile.domain();
                Some(profile.point(a + (b - a) * u.clamp(0.0, 1.0)) + *by * v)
            }
            Self::Ruled { rails: [a, b], by_length } => {
                let at = |c: &Curve| {
                    let (t0, t1) = c.domain();
                    let u = u.clamp(0.0, 1.0);
                    if *by_length { c.point(c.param_at_length(u * c.length())) } else { c.point(t0 + (t1 - t0) * u) }
                };
                Some(at(a).lerp(at(b), v))
            }
        }
    }

    /// From the file's (u, v) to the surface's, where both are in proportion.
    pub fn to_surface(&self) -> Option<DAffine3> {
        let Self::Net(_, [u0, u1, v0, v1]) = self else { return None };
        let scale = DVec3::new(1.0 / (u1 - u0), 1.0 / (v1 - v0), 1.0);
        let m = DAffine3::from_scale(scale) * DAffine3::from_translation(DVec3::new(-u0, -v0, 0.0));
        m.is_finite().then_some(m)
    }
}

/// The point of a profile at the parameter of the file, where the curve still has that one or is an arc whose first one is known.
fn along_file(profile: &Curve, first: Option<f64>, t: f64) -> Option<DVec3> {
    use crate::geometry::curves::curve::Shape;
    let (a, b) = profile.domain();
    match (profile.shape(), first) {
        (Shape::Line(..) | Shape::Nurbs(_), _) => Some(profile.point(t.clamp(a, b))),
        (Shape::Arc(arc), Some(first)) => Some(profile.point(a + (b - a) * ((t - first) / arc.sweep).clamp(0.0, 1.0))),
        _ => None,
    }
}

/// Whether a matrix keeps lengths and angles.
fn is_rigid(m: &DAffine3) -> bool {
    let t = m.matrix3.transpose() * m.matrix3;
    let off = t - glam::DMat3::IDENTITY;
    [off.x_axis, off.y_axis, off.z_axis].iter().all(|c| c.abs().max_element() <= NUDGE)
}

fn transformed_net(net: NurbsSurface, m: &DAffine3) -> NurbsSurface {
    let poles = net.poles.iter().map(|q| transformed_pole(*q, m)).collect();
    NurbsSurface { poles, ..net }
}

/// How far surfaces without ends reach beyond what lies on them, as a share of its size.
pub const BEYOND: f64 = 0.1;

/// Stretch of an axis beside a box, with room around.
fn along(axis: &Axis, reach: &Box3) -> Result<(f64, f64), Defect> {
    if reach.is_empty() {
        return Err(defect("it is a cylinder or cone without ends"));
    }
    let room = BEYOND * reach.diagonal();
    let (low, high) = reach.stretch(axis.about, axis.direction);
    Ok((low - room, high + room))
}
