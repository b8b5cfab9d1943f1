//! The surface of one face as files of solids hold it: exact elementary forms where there are such, else B-splines.

use glam::DVec3;

use crate::base::fault::Result;
use crate::base::math::sin_cos;
use crate::base::tolerance::{PARALLEL, Tolerance};
use crate::geometry::shapes::nurbs::projected;
use crate::io::cad::control_nets::{trimmed_net, with_whole_poles};
use crate::model::Patch;
use crate::surface::analysis::elementary::{Elementary, Form};
use crate::surface::{Domain, NurbsSurface, Off, Side, Surface};

/// Share of the tolerance that a net may be off, where that can be had.
const FINE: f64 = 0.1;

/// The surface of one face.
#[derive(Clone, Debug)]
pub enum Ground {
    /// A plane, cylinder, cone, sphere or torus.
    Elementary(Elementary),
    /// A B-spline with how far it is off, and the points that its poles were made.
    Net(NurbsSurface, Off, Vec<DVec3>),
}

/// The surface below a patch, cut to its rectangle where it is a B-spline; `None` for a plane without a border.
pub fn ground(surface: &Surface, patch: &Patch, tolerance: &Tolerance) -> Result<Option<Ground>> {
    if surface.domain() == Domain::Unbounded {
        return Ok(None);
    }
    if let Some(found) = surface.elementary(patch.v, tolerance) {
        return Ok(Some(Ground::Elementary(found)));
    }
    let base = surface.untrimmed();
    let poles: Vec<DVec3> = (0..base.n_sides()).filter_map(|k| if let Side::Pole(at) = base.side(k) { Some(at) } else { None }).collect();
    // Edges lie in space: the net may run by the profile's own parameter, with which it is exact.
    let whole = patch.u == (0.0, 1.0) && patch.v == (0.0, 1.0);
    if let (0.0, 1.0) = patch.u
        && let Some(net) = surface.swept_net(patch.v, tolerance)
    {
        return Ok(Some(shaped(net, Off::Exact, &poles, tolerance)));
    }
    let form = |within: &Tolerance| match surface.domain() {
        Domain::Square if whole => surface.to_net(within),
        _ => surface.ground_net(within),
    };
    // Edges are within the tolerance: the surface is to be nearer, so that areas and volumes are found again.
    let fine = Tolerance { point: FINE * tolerance.point, ..*tolerance };
    let form = form(&fine).or_else(|_| form(tolerance))?;
    let Some(form) = form else { return Ok(None) };
    let cut = match surface.domain() {
        Domain::Square if !whole => trimmed_net(form.net.clone(), [patch.u.0, patch.u.1, patch.v.0, patch.v.1]).unwrap_or(form.net),
        _ => form.net,
    };
    Ok(Some(shaped(cut, form.off, &poles, tolerance)))
}

/// A net with its poles, or the plane that it is.
fn shaped(net: NurbsSurface, off: Off, poles: &[DVec3], tolerance: &Tolerance) -> Ground {
    if let Some(plane) = flat(&net, tolerance) {
        return Ground::Elementary(plane);
    }
    let (net, poles) = with_whole_poles(net, poles, tolerance);
    let moved = poles.iter().map(|pole| pole.moved).fold(0.0, f64::max);
    Ground::Net(net, off.and(moved), poles.iter().filter(|pole| pole.moved > tolerance.rounding).map(|pole| pole.at).collect())
}

/// The plane in which all poles of a net lie but for rounding.
fn flat(net: &NurbsSurface, tolerance: &Tolerance) -> Option<Elementary> {
    let (nu, nv) = net.counts;
    let at = |i: usize, j: usize| projected(net.pole(i, j));
    let corner = at(0, 0);
    let arms = [at(nu - 1, 0), at(nu - 1, nv - 1), at(0, nv - 1)].map(|p| p - corner);
    // Both halves of the quadrilateral of the corners: one may be nothing.
    let area = arms[0].cross(arms[1]) + arms[1].cross(arms[2]);
    let longest = arms.into_iter().fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    if area.length() <= PARALLEL * longest.length_squared() {
        return None;
    }
    let normal = area.normalize_or_zero();
    let lies = |q: &glam::DVec4| (projected(*q) - corner).dot(normal).abs() <= tolerance.rounding;
    if !net.poles.iter().all(lies) {
        return None;
    }
    let reference = longest.reject_from_normalized(normal).normalize_or_zero();
    Some(Elementary { form: Form::Plane { at: corner, normal }, reference, along: true })
}

impl Ground {
    /// Whether its normal is the one of the model's surface.
    pub fn is_along(&self) -> bool {
        match self {
            Self::Net(..) => true,
            Self::Elementary(found) => found.along,
        }
    }

    /// The points at which one of its borders is a point.
    pub fn poles(&self) -> Vec<DVec3> {
        match self {
            Self::Elementary(found) => match &found.form {
                Form::Sphere { axis, radius } => [-1.0, 1.0].map(|side| axis.about + axis.direction * (side * radius)).to_vec(),
                Form::Cone { axis, radius, angle } => {
                    let (sin, cos) = sin_cos(*angle);
                    vec![axis.about - axis.direction * (radius * cos / sin)]
                }
                _ => Vec::new(),
            },
            Self::Net(net, ..) => {
                let (nu, nv) = net.counts;
                let along_u = |j: usize| (0..nu).map(|i| projected(net.pole(i, j))).collect::<Vec<DVec3>>();
                let along_v = |i: usize| (0..nv).map(|j| projected(net.pole(i, j))).collect::<Vec<DVec3>>();
                let borders = [along_u(0), along_u(nv - 1), along_v(0), along_v(nu - 1)];
                borders.iter().filter(|row| row.iter().all(|p| *p == row[0])).map(|row| row[0]).collect()
            }
        }
    }
}
