//! Profiles moved by matrices as nets: S(u, v) = A(u) + K(u) G(v).
//!
//! The motion gets splines that are near it at the corners of a box of the profile, so they are as near everywhere in the box: S is
//! affine in the point moved. The profile stays what it is where the net may run by its parameter, else it gets splines too.

use glam::{DVec3, DVec4};

use crate::base::bbox::Box3;
use crate::base::range::Interval3;
use crate::geometry::shapes::nurbs::{projected, weighted};
use crate::geometry::{Jet, Nurbs};
use crate::surface::analysis::as_net::family::{Family, Target};
use crate::surface::analysis::as_net::splines::Breaks;
use crate::surface::analysis::as_net::{DEGREES, NetForm, Off};
use crate::surface::core::shape::Shape;
use crate::surface::core::surface::Surface;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::rails::rail::Rail;
use crate::surface::rails::reparam::Map;
use crate::surface::shapes::nurbs::NurbsSurface;
use crate::surface::shapes::sweep::Path;
use crate::surface::swept::extrude::unit_knots;

/// A point of the profile under way.
struct Carried<'s> {
    shape: &'s Shape,
    from: DVec3,
}

impl Target for Carried<'_> {
    fn jet(&self, x: f64, side: OneSided) -> Jet {
        let g = Jet { p: self.from, ..Jet::default() };
        let jet = match self.shape {
            Shape::Framed(framed) => framed.jet_of(&g, x, side),
            Shape::Sweep(sweep) => sweep.jet_of(&g, x),
            _ => return g,
        };
        Jet { p: jet.p, d1: jet.du, d2: jet.duu }
    }

    fn line(&self, x0: f64, x1: f64) -> Line {
        let half = 0.5 * (x1 - x0);
        let middle = 0.5 * (x0 + x1);
        let still = Line::new(0.0, Jet { p: self.from, ..Jet::default() }, None, Interval3::default());
        let enclosure = match self.shape {
            Shape::Framed(framed) => framed.between(x0, x1).into_iter().map(|strip| framed.enclosure(&strip, (half, 0.0), &still)),
            Shape::Sweep(sweep) => {
                let enclosure = sweep.enclosure(middle, (half, 0.0), &still);
                return Line::new(half, self.jet(middle, OneSided::After), None, enclosure.duu);
            }
            _ => return still,
        };
        let whole = enclosure.map(|s| s.duu).reduce(Interval3::union).unwrap_or(Interval3::ANY);
        Line::new(half, self.jet(middle, OneSided::After), None, whole)
    }

    fn corners(&self) -> Vec<f64> {
        if let Shape::Framed(framed) = self.shape { framed.cells().0 } else { Vec::new() }
    }

    fn breaks(&self) -> Vec<f64> {
        if let Shape::Framed(framed) = self.shape { framed.breaks().0 } else { Vec::new() }
    }
}

/// The motion as control points of what it does to four points: to any other one by affine combination.
struct Motion {
    degree: usize,
    knots: Vec<f64>,
    frame: Vec<[DVec3; 4]>,
    origin: DVec3,
    steps: DVec3,
    off: f64,
}

impl Motion {
    /// Where control point `i` of the path of a point is.
    fn of(&self, i: usize, p: DVec3) -> DVec3 {
        let [o, x, y, z] = self.frame[i];
        let share = (p - self.origin) / self.steps;
        o + (x - o) * share.x + (y - o) * share.y + (z - o) * share.z
    }
}

/// The net of a sweep within a distance, model units; `None` where the surface is none. `same_uv`: in the surface's own v, not in the
/// profile's parameter. Fails with shares of u and v about which too many pieces would be needed.
pub fn carried(surface: &Surface, within: f64, same_uv: bool) -> Option<Result<NetForm, (f64, f64)>> {
    let shape = &surface.parts().shape;
    let (rail, scale) = match shape {
        Shape::Framed(framed) => (framed.profile(), framed.largest_scale()),
        Shape::Sweep(sweep) => (sweep.profile(), 1.0),
        _ => return None,
    };
    let own = if same_uv { None } else { exact(rail) };
    let share = if own.is_some() { 1.0 } else { 0.5 };
    let profile = match own {
        Some(profile) => Ok((profile, 0.0)),
        None => splined(rail, share * within / scale),
    };
    Some(profile.map_err(|v| (0.0, v)).and_then(|(profile, off)| {
        let motion = motion(shape, &profile, share * within).map_err(|u| (u, 0.0))?;
        Ok(NetForm { net: net(&motion, &profile), off: Off::Bounded(motion.off + off * scale) })
    }))
}

/// One curve along another: S(u, v) = path(u) + profile(v) − foot.
pub fn translated(path: &Nurbs, profile: &Nurbs, foot: DVec3) -> NurbsSurface {
    let row = |q: &DVec4| {
        let (g, w) = (projected(*q) - foot, q.w);
        path.poles.iter().map(move |p| weighted(projected(*p) + g, p.w * w)).collect::<Vec<DVec4>>()
    };
    let counts = (path.poles.len(), profile.poles.len());
    let poles = profile.poles.iter().flat_map(row).collect();
    NurbsSurface { degree: (path.degree, profile.degree), knots: (unit_knots(path), unit_knots(profile)), poles, counts }
}

/// The curve itself as a B-spline, if it is one and runs as the surface does.
pub fn exact(rail: &Rail) -> Option<Nurbs> {
    let Rail::Chain { chain, map, .. } = rail else { return None };
    let curve = chain.to_curve().ok()?;
    (*map == Map::identity()).then(|| curve.exact_nurbs()).flatten()
}

/// Splines near the profile in its own v, and how near.
fn splined(rail: &Rail, within: f64) -> Result<(Nurbs, f64), f64> {
    let family = Family { targets: vec![Box::new(rail)], allowed: within };
    let fitted = family.fitted(DEGREES.map(Breaks::none))?;
    let poles = fitted.breaks.control(&fitted.splines[0]).into_iter().map(|p| p.extend(1.0)).collect();
    Ok((Nurbs::new(fitted.breaks.degree, fitted.breaks.vector(), poles), fitted.off))
}

fn motion(shape: &Shape, profile: &Nurbs, within: f64) -> Result<Motion, f64> {
    let bounds = Box3::of(profile.poles.iter().map(|q| projected(*q)));
    // A flat box is given some room: four of its corners span space.
    let steps = (bounds.max - bounds.min).max(DVec3::splat(bounds.diagonal() * ROOM));
    let origin = bounds.min;
    let corner = |k: usize| origin + steps * DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64);
    if let Shape::Sweep(sweep) = shape
        && let Path::Straight { by } = sweep.path()
    {
        let at = |by: DVec3| [0, 1, 2, 4].map(|k| corner(k) + by);
        let frame = vec![at(DVec3::ZERO), at(by)];
        return Ok(Motion { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], frame, origin, steps, off: 0.0 });
    }
    let targets = (0..8).map(|k| Box::new(Carried { shape, from: corner(k) }) as Box<dyn Target>).collect();
    let fitted = Family { targets, allowed: within }.fitted(DEGREES.map(Breaks::none))?;
    let poles: Vec<Vec<DVec3>> = [0, 1, 2, 4].map(|k| fitted.breaks.control(&fitted.splines[k])).to_vec();
    let frame = (0..poles[0].len()).map(|i| [0, 1, 2, 3].map(|c| poles[c][i])).collect();
    Ok(Motion { degree: fitted.breaks.degree, knots: fitted.breaks.vector(), frame, origin, steps, off: fitted.off })
}

/// Share of a box's diagonal that each of its sides has at least.
const ROOM: f64 = 0.25;

fn net(motion: &Motion, profile: &Nurbs) -> NurbsSurface {
    let counts = (motion.frame.len(), profile.poles.len());
    let row = |q: &DVec4| {
        let (p, w) = (projected(*q), q.w);
        (0..counts.0).map(move |i| weighted(motion.of(i, p), w)).collect::<Vec<DVec4>>()
    };
    let poles = profile.poles.iter().flat_map(row).collect();
    NurbsSurface { degree: (motion.degree, profile.degree), knots: (motion.knots.clone(), unit_knots(profile)), poles, counts }
}
