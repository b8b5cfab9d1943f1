//! Surface entities as surfaces of the model, with the parameters that the file gives them.

use glam::{DAffine3, DVec3, DVec4};

use super::book::{Book, NESTED};
use super::curves::{Place, bernstein, carried, carried_pole, check_reach, check_weights};
use super::damage::{Damage, damage};
use super::entities::{Data, NetData, Pointer};
use super::nets::{ruled_net, trimmed_net};
use crate::base::bbox::Box3;
use crate::base::math;
use crate::base::tolerance::{EPSILON, NUDGE, PARALLEL, Tolerance};
use crate::geometry::nurbs::{projected, weighted};
use crate::geometry::{Curve, Motion, build};
use crate::network::Chain;
use crate::surface::revolve::Axis;
use crate::surface::{NurbsSurface, Surface, SurfaceKind, extrude, plane, revolve, ruled};

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
    /// u is the profile's parameter from 0 to 1, v runs along `by`.
    Swept {
        /// The curve that is carried.
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

impl Book {
    /// The surface that a pointer means, its matrix included.
    pub fn base(&mut self, d: Pointer, depth: usize) -> Result<Base, Damage> {
        if depth > NESTED {
            return Err(damage("surfaces are nested too deep"));
        }
        let k = self.place(d)?;
        let matrix = self.placement(self.entries[k].transform)?;
        let data = std::mem::replace(&mut self.decoded[k].data, Data::Busy);
        let made = self.base_of(d, &data, depth);
        self.decoded[k].data = data;
        let base = match matrix {
            Some(m) => made?.carried(&m, &self.tolerance)?,
            None => made?,
        };
        Ok(base)
    }

    fn base_of(&mut self, d: Pointer, data: &Data, depth: usize) -> Result<Base, Damage> {
        let scale = self.scale;
        match data {
            Data::Net(net) => {
                self.copy(net.points.len())?;
                self.net(net)
            }
            Data::Patches { u, v, patches, dummies } => self.patches(d, u, v, patches, *dummies),
            Data::Plane { coefficients: [a, b, c, far], .. } => {
                let normal = DVec3::new(*a, *b, *c);
                let size = normal.length();
                let unit = math::unit(normal, 0.0).ok_or_else(|| damage("its normal has no length"))?;
                let first = math::any_normal(unit);
                Ok(Base::Plane(unit * (far / size * scale), first, unit.cross(first)))
            }
            Data::Ruled { rails, crossed, by_length } => {
                let [a, b] = [self.curve(rails[0], Place::SPACE)?, self.curve(rails[1], Place::SPACE)?];
                let b = if *crossed { b.reversed() } else { b };
                Ok(Base::Ruled { rails: [a, b], by_length: *by_length })
            }
            Data::Revolution { axis, profile, start, end } => {
                let line = self.curve(*axis, Place::SPACE)?;
                let (about, to) = (line.start(), line.end());
                let direction = math::unit(to - about, 0.0).ok_or_else(|| damage("its axis has no length"))?;
                let first = match self.data(*profile)? {
                    Data::Arc { center, start, .. } => {
                        let angle = math::atan2(start[1] - center[1], start[0] - center[0]);
                        Some(if angle < 0.0 { angle + std::f64::consts::TAU } else { angle })
                    }
                    _ => None,
                };
                let profile = self.curve(*profile, Place::SPACE)?;
                Ok(Base::Turned { axis: Axis { about, direction }, profile, angles: angles(*start, *end)?, first })
            }
            Data::Tabulated { profile, end } => {
                let profile = self.curve(*profile, Place::SPACE)?;
                let by = *end * scale - profile.start();
                if by.length() <= self.tolerance.rounding {
                    return Err(damage("it is swept by nothing"));
                }
                Ok(Base::Swept { profile, by })
            }
            Data::OffsetSurface { indicator, distance, base } => match self.base(*base, depth + 1)? {
                Base::Plane(at, u, v) => {
                    let normal = u.cross(v);
                    let side = if normal.dot(*indicator) < 0.0 { -normal } else { normal };
                    Ok(Base::Plane(at + side * (distance * scale), u, v))
                }
                _ => Err(damage("offsets of curved surfaces are not read")),
            },
            Data::PlaneSurface { at, normal, reference } => {
                let (at, normal) = (self.point(*at)?, self.direction(*normal)?);
                let first = self.reference(*reference, normal)?;
                Ok(Base::Plane(at, first, normal.cross(first)))
            }
            Data::Round { kind, at, axis, sizes, reference } => {
                let about = self.point(*at)?;
                let direction = if *axis == 0 { DVec3::Z } else { self.direction(*axis)? };
                let reference = self.reference(*reference, direction)?;
                self.round(*kind, Axis { about, direction }, reference, *sizes)
            }
            Data::Damaged => Err(damage(format!("{} is damaged", self.said(d)))),
            Data::Busy => Err(damage(format!("{} is made of itself", self.said(d)))),
            _ => Err(damage(format!("{} is no surface", self.said(d)))),
        }
    }

    fn net(&self, data: &NetData) -> Result<Base, Damage> {
        check_weights(&data.weights)?;
        let poles: Vec<DVec4> = data.points.iter().zip(&data.weights).map(|(p, w)| weighted(*p * self.scale, *w)).collect();
        let net = NurbsSurface { degree: data.degree, knots: data.knots.clone(), poles, counts: data.counts };
        Ok(Base::Net(trimmed_net(net, data.range)?, data.range))
    }

    /// Bicubic patches as one net with threefold knots; on common borders the later patch counts.
    fn patches(&mut self, d: Pointer, u: &[f64], v: &[f64], patches: &[f64], dummies: bool) -> Result<Base, Damage> {
        let (m, n) = (u.len() - 1, v.len() - 1);
        let counts = (3 * m + 1, 3 * n + 1);
        self.copy(counts.0.saturating_mul(counts.1))?;
        let mut points: Vec<Option<DVec3>> = vec![None; counts.0 * counts.1];
        let mut gap = 0.0_f64;
        for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let first = 48 * (i * (n + usize::from(dummies)) + j);
            let c = |k: usize| DVec3::new(patches[first + k], patches[first + 16 + k], patches[first + 32 + k]) * self.scale;
            // Powers of u first, for each power of v.
            let rows = [0, 4, 8, 12].map(|k| bernstein([c(k), c(k + 1), c(k + 2), c(k + 3)], u[i + 1] - u[i]));
            for a in 0..4 {
                let column = bernstein([rows[0][a], rows[1][a], rows[2][a], rows[3][a]], v[j + 1] - v[j]);
                for (b, p) in column.into_iter().enumerate() {
                    let place = &mut points[(3 * j + b) * counts.0 + 3 * i + a];
                    gap = place.map_or(gap, |before| gap.max(before.distance(p)));
                    *place = Some(p);
                }
            }
        }
        if gap > self.slack() {
            let gap = self.length(gap);
            self.warn(d, format!("its patches are up to {gap} apart; they are joined"));
        }
        let knots = |x: &[f64]| {
            let ends = [x[0], x[x.len() - 1]];
            std::iter::once(ends[0]).chain(x.iter().flat_map(|t| [*t; 3])).chain(std::iter::once(ends[1])).collect::<Vec<f64>>()
        };
        let poles = points.into_iter().map(|p| p.unwrap_or_default().extend(1.0)).collect();
        let net = NurbsSurface { degree: (3, 3), knots: (knots(u), knots(v)), poles, counts };
        let range = [u[0], u[m], v[0], v[n]];
        Ok(Base::Net(trimmed_net(net, range)?, range))
    }

    fn point(&self, d: Pointer) -> Result<DVec3, Damage> {
        let Data::Point(p) = self.data(d)? else { return Err(damage(format!("{} is no point", self.said(d)))) };
        let m = self.placement(self.entry(d).map_or(0, |e| e.transform))?;
        Ok(m.map_or(*p * self.scale, |m| m.transform_point3(*p * self.scale)))
    }

    fn direction(&self, d: Pointer) -> Result<DVec3, Damage> {
        let Data::Direction(v) = self.data(d)? else { return Err(damage(format!("{} is no direction", self.said(d)))) };
        let m = self.placement(self.entry(d).map_or(0, |e| e.transform))?;
        math::unit(m.map_or(*v, |m| m.transform_vector3(*v)), 0.0).ok_or_else(|| damage("a direction has no length"))
    }

    /// The unit vector at right angles to an axis where parameters start; any, when the file gives none.
    fn reference(&self, d: Pointer, axis: DVec3) -> Result<DVec3, Damage> {
        if d == 0 {
            return Ok(math::any_normal(axis));
        }
        let v = self.direction(d)?;
        math::unit(v.reject_from_normalized(axis), PARALLEL).ok_or_else(|| damage("the reference direction runs along the axis"))
    }

    fn round(&self, kind: u32, axis: Axis, reference: DVec3, [a, b]: [f64; 2]) -> Result<Base, Damage> {
        let radius = a * self.scale;
        if radius < 0.0 || (radius == 0.0 && kind != 194) {
            return Err(damage("its radius must be above 0"));
        }
        let across = axis.direction.cross(reference);
        let turned = |profile: &Curve| {
            let net = revolve::net(&profile.to_nurbs(&self.tolerance)?, &axis, std::f64::consts::TAU);
            Ok(Base::Net(net, [f64::NAN; 4]))
        };
        match kind {
            192 => Ok(Base::Unbounded { axis, radius, slope: 0.0, reference }),
            194 => Ok(Base::Unbounded { axis, radius, slope: math::tan(b.to_radians()), reference }),
            196 => {
                let start = axis.about - axis.direction * radius;
                turned(&build::arc_center(axis.about, start, std::f64::consts::PI, -across, self.origin)?)
            }
            _ => {
                let center = axis.about + reference * radius;
                let start = center + reference * (b * self.scale);
                turned(&build::circle_start(center, start, -across, self.origin)?)
            }
        }
    }

    /// The surface value; one without ends reaches a little beyond the box.
    pub fn surface(&self, base: &Base, reach: &Box3) -> Result<Surface, Damage> {
        let tolerance = &self.tolerance;
        if let Base::Plane(at, u, v) = base {
            if reach.is_empty() {
                return Err(damage("it is a plane without a border"));
            }
            return Ok(plane::unbounded(*at, u.cross(*v), self.origin)?);
        }
        if let Base::Ruled { rails: [a, b], by_length: true } = base
            && !(even(a) && even(b))
        {
            let chains = [Chain::of_curve(a), Chain::of_curve(b)];
            return Ok(ruled(&chains[0], &chains[1], self.origin, tolerance)?.0);
        }
        let net = base.net(reach, tolerance)?;
        check_reach(net.poles.iter().map(|q| projected(*q)))?;
        let first = net.poles[0];
        let flat = net.poles.iter().all(|q| projected(*q).distance(projected(first)) <= tolerance.rounding);
        if flat {
            return Err(damage("all its control points are one point"));
        }
        Ok(net.surface(SurfaceKind::Nurbs, self.origin, tolerance))
    }
}

/// Whether equal steps of the parameter are equal lengths.
fn even(curve: &Curve) -> bool {
    use crate::geometry::curve::Shape;
    match curve.shape() {
        Shape::Line(..) => true,
        Shape::Arc(arc) => arc.radius.is_some(),
        _ => false,
    }
}

/// First and last angle, at most one turn apart.
fn angles(start: f64, end: f64) -> Result<(f64, f64), Damage> {
    let turn = std::f64::consts::TAU;
    let end = if end <= start { end + turn } else { end };
    let sweep = end - start;
    if sweep <= 0.0 || sweep > turn * (1.0 + NUDGE) {
        return Err(damage(format!("its angles run from {start} to {end}, which is no part of a turn")));
    }
    Ok((start, if sweep > turn * (1.0 - EPSILON) { start + turn } else { end }))
}

impl Base {
    /// Carried by a matrix; a turned surface by one that distorts becomes a net.
    fn carried(self, m: &DAffine3, tolerance: &Tolerance) -> Result<Self, Damage> {
        let point = |p: DVec3| m.transform_point3(p);
        let turns = |v: DVec3| m.transform_vector3(v).normalize_or_zero();
        // A mirror turns the sense of a rotation.
        let sense = m.matrix3.determinant().signum();
        let moved = |axis: &Axis| Axis { about: point(axis.about), direction: turns(axis.direction) * sense };
        Ok(match self {
            Self::Net(net, range) => Self::Net(carried_net(net, m), range),
            Self::Plane(at, u, v) => Self::Plane(point(at), turns(u), turns(v)),
            Self::Turned { axis, profile, angles, first } if is_rigid(m) => {
                Self::Turned { axis: moved(&axis), profile: carried(&profile, m, tolerance)?, angles, first }
            }
            Self::Unbounded { axis, radius, slope, reference } if is_rigid(m) => {
                let slope = slope * sense;
                Self::Unbounded { axis: moved(&axis), radius, slope, reference: turns(reference) }
            }
            Self::Unbounded { .. } => return Err(damage("its matrix distorts it")),
            Self::Turned { .. } => {
                let net = self.net(&Box3::EMPTY, tolerance)?;
                Self::Net(carried_net(net, m), [f64::NAN; 4])
            }
            Self::Swept { profile, by } => Self::Swept { profile: carried(&profile, m, tolerance)?, by: m.transform_vector3(by) },
            Self::Ruled { rails: [a, b], by_length } => {
                Self::Ruled { rails: [carried(&a, m, tolerance)?, carried(&b, m, tolerance)?], by_length }
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
    pub fn net(&self, reach: &Box3, tolerance: &Tolerance) -> Result<NurbsSurface, Damage> {
        match self {
            Self::Net(net, _) => Ok(net.clone()),
            Self::Plane(..) => Err(damage("it is a plane without a border")),
            Self::Turned { axis, profile, angles, .. } => {
                let turn = Motion::rotation(axis.about, axis.direction, angles.0);
                let profile = profile.moved(&turn).to_nurbs(tolerance)?;
                Ok(revolve::net(&profile, axis, angles.1 - angles.0))
            }
            Self::Swept { profile, by } => Ok(extrude::net(&profile.to_nurbs(tolerance)?, *by)),
            Self::Ruled { rails: [a, b], .. } => Ok(ruled_net(&a.to_nurbs(tolerance)?, &b.to_nurbs(tolerance)?)),
            Self::Unbounded { axis, radius, slope, reference } => {
                let (low, high) = along(axis, reach)?;
                // A cone ends at its apex.
                let apex = -radius / slope;
                let (low, high) = (if *slope > 0.0 { low.max(apex) } else { low }, if *slope < 0.0 { high.min(apex) } else { high });
                let at = |h: f64| axis.about + axis.direction * h + *reference * (radius + slope * h).max(0.0);
                let profile = build::line(at(low), at(high), crate::base::origin::Origin::NONE)?.to_nurbs(tolerance)?;
                Ok(revolve::net(&profile, axis, std::f64::consts::TAU))
            }
        }
    }

    /// The point at the file's (u, v).
    pub fn point(&self, u: f64, v: f64) -> Option<DVec3> {
        use crate::surface::Lean;
        let share = |x: f64, a: f64, b: f64| ((x - a) / (b - a)).clamp(0.0, 1.0);
        match self {
            Self::Net(net, [u0, u1, v0, v1]) if u0.is_finite() => {
                Some(net.jet(share(u, *u0, *u1), share(v, *v0, *v1), (Lean::After, Lean::After)).p)
            }
            Self::Net(..) | Self::Unbounded { .. } => None,
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
    use crate::geometry::curve::Shape;
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

fn carried_net(net: NurbsSurface, m: &DAffine3) -> NurbsSurface {
    let poles = net.poles.iter().map(|q| carried_pole(*q, m)).collect();
    NurbsSurface { poles, ..net }
}

/// How far surfaces without ends reach beyond what lies on them, as a share of its size.
const BEYOND: f64 = 0.1;

/// Stretch of an axis beside a box, with room around.
fn along(axis: &Axis, reach: &Box3) -> Result<(f64, f64), Damage> {
    if reach.is_empty() {
        return Err(damage("it is a cylinder or cone without ends"));
    }
    let room = BEYOND * reach.diagonal();
    let along = corners(reach).map(|p| (p - axis.about).dot(axis.direction));
    let low = along.into_iter().fold(f64::INFINITY, f64::min);
    let high = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
    Ok((low - room, high + room))
}

fn corners(b: &Box3) -> [DVec3; 8] {
    std::array::from_fn(|k| {
        let pick = |bit: usize, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
        DVec3::new(pick(0, b.min.x, b.max.x), pick(1, b.min.y, b.max.y), pick(2, b.min.z, b.max.z))
    })
}
