//! The polynomial of least bending that meets the borders of a hole in the sense of least squares.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::math;
use crate::base::tolerance::{FILL_ANGLE, FILL_BEND, FILL_GAP};
use crate::surface::filled::beside::Along;
use crate::surface::filled::chebyshev::Basis;
use crate::surface::filled::energy::{bending, quadrature};
use crate::surface::filled::householder::Rows;
use crate::surface::filled::patch::Patch;
use crate::surface::filled::ribbon::{BorderPlace, Ribbons};

/// Degrees that are tried, one after the other, until the borders are met.
const DEGREES: [usize; 4] = [8, 12, 16, 20];
/// Places of a side at which the borders are met.
const PLACES: usize = 32;
/// Weights of positions, first and second derivatives across, against bending.
const WEIGHTS: [f64; 3] = [1e6, 1e5, 1e4];
/// Weight of inner points.
const INNER: f64 = 1e7;
/// Rounds in which the places of inner points are found, where the surface is no height over the plane.
const ROUNDS: usize = 3;
/// What is near enough: of the size, radians, share of the curvature.
const NEAR: Missed = Missed { gap: FILL_GAP, angle: FILL_ANGLE, bend: FILL_BEND };
/// Curvature below which differences count as of this one, over the size of the hole.
const FLAT: f64 = 0.05;

/// How far a surface is from what its borders ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Missed {
    /// Largest distance.
    gap: f64,
    /// Largest angle between normals, radians.
    angle: f64,
    /// Largest difference of normal curvatures across a border, as a share.
    bend: f64,
}

/// A field with its derivatives at a place of the plane.
#[derive(Clone, Copy, Debug)]
pub struct FieldJet {
    pub p: DVec3,
    pub dx: DVec3,
    pub dy: DVec3,
    second: [DVec3; 3],
}

impl FieldJet {
    /// Derivative along a direction in the plane.
    pub fn along(&self, d: DVec2) -> DVec3 {
        self.dx * d.x + self.dy * d.y
    }

    /// Second derivative along it.
    pub fn second(&self, d: DVec2) -> DVec3 {
        let [xx, xy, yy] = self.second;
        xx * (d.x * d.x) + xy * (2.0 * d.x * d.y) + yy * (d.y * d.y)
    }
}

/// Points over the places of the plane: the place itself and a polynomial.
#[derive(Clone, Debug)]
pub struct Field {
    basis: Basis,
    coefficients: Vec<DVec3>,
}

impl Field {
    /// Point and derivatives over a place.
    pub fn jet(&self, place: DVec2) -> FieldJet {
        let values = self.basis.at(place);
        let of = |a: usize, b: usize| -> DVec3 { values.derivative(a, b).iter().zip(&self.coefficients).map(|(x, c)| *c * *x).sum() };
        FieldJet {
            p: place.extend(0.0) + of(0, 0),
            dx: DVec3::X + of(1, 0),
            dy: DVec3::Y + of(0, 1),
            second: [of(2, 0), of(1, 1), of(0, 2)],
        }
    }

    /// The point over a place.
    pub fn point(&self, place: DVec2) -> DVec3 {
        place.extend(0.0) + self.basis.sum(place, &self.coefficients)
    }

    /// How far it is from what the borders ask for.
    fn missed(&self, ribbons: &Ribbons, places: &[(DVec2, BorderPlace)]) -> Missed {
        let mut worst = Missed::default();
        for (at, place) in places {
            let jet = self.jet(*at);
            worst.gap = worst.gap.max(jet.p.distance(place.p));
            let (Some(face), Some((first, _))) = (place.face, place.across) else { continue };
            let normal = jet.dx.cross(jet.dy);
            let angle = math::angle_between(normal, face.normal);
            worst.angle = worst.angle.max(angle.min(std::f64::consts::PI - angle));
            if ribbons.order > 1 {
                let (own, asked) = (jet.second(place.inward).dot(face.normal), face.bend(first));
                let square = first.length_squared();
                worst.bend = worst.bend.max((own - asked).abs() / (asked.abs().max(FLAT * square)));
            }
        }
        worst
    }
}

/// The field for some borders, through inner points (in the plane's coordinates).
pub fn solved(ribbons: &Ribbons, patches: &[Patch], inner: &[DVec3]) -> Field {
    let weights = weights(ribbons);
    let (asked, between) = (border_places(ribbons, PLACES, 0.0), border_places(ribbons, PLACES, 0.5));
    let outline: Vec<DVec2> = asked.iter().map(|(at, _)| *at).collect();
    let mut best: Option<(Field, Missed)> = None;
    for degree in DEGREES {
        job::poll();
        let basis = Basis::over(&outline, degree);
        let area = quadrature(ribbons, patches, degree / 2 + 4);
        let energy = bending(&basis, &area, &weights);
        let field = through(ribbons, &basis, (&asked, &energy), inner);
        let missed = field.missed(ribbons, &between);
        let worth = |m: &Missed| (m.gap / NEAR.gap).max(m.angle / NEAR.angle).max(m.bend / NEAR.bend);
        if best.as_ref().is_none_or(|(_, before)| worth(&missed) < worth(before)) {
            best = Some((field, missed));
        }
        if best.as_ref().is_some_and(|(_, m)| worth(m) <= 1.0) && inner.is_empty() {
            break;
        }
    }
    best.map(|(field, _)| field).unwrap_or_else(|| Field { basis: Basis::over(&outline, 2), coefficients: Vec::new() })
}

/// Orders of the derivatives whose squares are least, with weights. A polynomial of degree 2k + 1 cannot be zero with k derivatives along a
/// closed curve, and one of degree 2k + 2 can: (1 − x² − y²)^(k + 1). So up to order 2k + 2 the borders determine the surface.
fn weights(ribbons: &Ribbons) -> Vec<(usize, f64)> {
    match ribbons.order {
        order if ribbons.is_held() => vec![(order + 3, 1.0)],
        order if order > 0 && ribbons.along.iter().any(Along::any) => vec![(2, 0.1), (3, 1.0)],
        _ => vec![(2, 1.0), (3, 0.01)],
    }
}

/// Places of the border with what is asked for there; `offset` 0: ends and between, 0.5: between those.
fn border_places(ribbons: &Ribbons, count: usize, offset: f64) -> Vec<(DVec2, BorderPlace)> {
    let mut out = Vec::new();
    for side in 0..ribbons.sides.len() {
        let last = if offset == 0.0 { count } else { count - 1 };
        for k in 0..=last {
            let f = 0.5 * (1.0 - math::cos(std::f64::consts::PI * (k as f64 + offset) / count as f64));
            let place = ribbons.place(side, f);
            out.push((place.p.truncate(), place));
        }
    }
    out
}

type Asked<'a> = (&'a [(DVec2, BorderPlace)], &'a [Vec<f64>]);

/// Least squares: borders and inner points by their weights, and bending.
fn through(ribbons: &Ribbons, basis: &Basis, (asked, energy): Asked, inner: &[DVec3]) -> Field {
    let mut feet: Vec<DVec2> = inner.iter().map(|p| p.truncate()).collect();
    let rounds = if inner.is_empty() || ribbons.is_lifted() { 1 } else { ROUNDS };
    let mut field = Field { basis: *basis, coefficients: Vec::new() };
    for round in 0..rounds {
        if round > 0 {
            for (foot, p) in feet.iter_mut().zip(inner) {
                let jet = field.jet(*foot);
                if let Some(step) = crate::surface::closest::foot::step(jet.dx, jet.dy, *p - jet.p) {
                    *foot += step;
                }
            }
        }
        let mut rows = Rows::new(basis.len());
        let share = 1.0 / (PLACES as f64).sqrt();
        for (foot, p) in feet.iter().zip(inner) {
            rows.push(&basis.at(*foot).derivative(0, 0), *p - foot.extend(0.0), INNER * share);
        }
        for (at, place) in asked {
            let values = basis.at(*at);
            rows.push(&values.derivative(0, 0), place.p - at.extend(0.0), WEIGHTS[0] * share);
            let Some((first, second)) = place.across else { continue };
            let d = place.inward;
            let (x, y) = (values.derivative(1, 0), values.derivative(0, 1));
            let across: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x * d.x + y * d.y).collect();
            rows.push(&across, first - d.extend(0.0), WEIGHTS[1] * share);
            if ribbons.order > 1 {
                let parts = [values.derivative(2, 0), values.derivative(1, 1), values.derivative(0, 2)];
                let twice: Vec<f64> =
                    (0..x.len()).map(|k| parts[0][k] * d.x * d.x + parts[1][k] * 2.0 * d.x * d.y + parts[2][k] * d.y * d.y).collect();
                rows.push(&twice, second, WEIGHTS[2] * share);
            }
        }
        energy.iter().for_each(|row| rows.push(row, DVec3::ZERO, 1.0));
        field.coefficients = rows.solved();
    }
    field
}
