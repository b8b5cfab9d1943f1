//! Curve entities as curves of the model, exactly.

use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};

use crate::geometry::construct::build;
use crate::geometry::curves::composite::Composite;
use crate::geometry::curves::curve::Shape;
use crate::geometry::{Curve, Kind};
use crate::io::cad::curves::{check_reach, check_weights, ordered, transformed, weight};
use crate::io::cad::defect::{Defect, defect};
use crate::io::iges::conics::{self, Level};
use crate::io::iges::entity_data::{Data, Pointer, SplineData};
use crate::io::iges::entity_table::{EntityTable, NESTED};

/// Whether a curve is wanted in space (model units) or in the (u, v) of a surface, and how deep it is nested.
#[derive(Clone, Copy, Debug)]
pub struct CurveRequest {
    /// Numbers are taken as they are.
    pub in_uv: bool,
    /// Entities around it.
    pub depth: usize,
}

impl CurveRequest {
    /// In space, not inside another curve.
    pub const SPACE: Self = Self { in_uv: false, depth: 0 };
    /// In (u, v), not inside another curve.
    pub const UV: Self = Self { in_uv: true, depth: 0 };

    fn deeper(self) -> Self {
        Self { depth: self.depth + 1, ..self }
    }
}

impl EntityTable {
    /// The curve that a pointer means; made once.
    pub fn curve(&mut self, d: Pointer, place: CurveRequest) -> Result<Curve, Defect> {
        if let Some(made) = self.curves.get(&(d, place.in_uv)) {
            return made.clone();
        }
        if place.depth > NESTED {
            return Err(defect("curves are nested too deep"));
        }
        // Whoever points back here on the way finds this.
        self.curves.insert((d, place.in_uv), Err(defect(format!("{} is made of itself", self.label(d)))));
        let made = self.make_curve(d, place);
        self.curves.insert((d, place.in_uv), made.clone());
        made
    }

    fn make_curve(&mut self, d: Pointer, place: CurveRequest) -> Result<Curve, Defect> {
        let k = self.place(d)?;
        let matrix = self.placement(self.entries[k].transform)?;
        // Taken out while it is worked on: a copy of a large spline would be memory for nothing.
        let data = std::mem::replace(&mut self.decoded[k].data, Data::Busy);
        let made = self.curve_of(d, &data, place);
        self.decoded[k].data = data;
        let curve = match matrix {
            Some(m) if !place.in_uv => {
                let made = made?;
                self.copy(weight(&made))?;
                transformed(&made, &m, &self.tolerance)?
            }
            _ => made?,
        };
        check_reach([curve.bbox().min, curve.bbox().max])?;
        Ok(curve)
    }

    fn curve_of(&mut self, d: Pointer, data: &Data, place: CurveRequest) -> Result<Curve, Defect> {
        let scale = if place.in_uv { 1.0 } else { self.scale };
        let same = if place.in_uv { 0.0 } else { self.tolerance.point };
        let origin = self.origin;
        let flat = |p: &[f64; 2]| DVec2::from_array(*p) * scale;
        let level = |z: f64| Level { z: z * scale, same, origin };
        match data {
            Data::Line { start, end, unbounded } => {
                if *unbounded {
                    self.warn(d, "the line has no end; the segment between its two points is used");
                }
                Ok(build::line(*start * scale, *end * scale, origin)?)
            }
            Data::Arc { z, center, start, end } => {
                let (curve, missed) = conics::arc(&level(*z), [flat(center), flat(start), flat(end)])?;
                self.missed(d, missed, place);
                Ok(curve)
            }
            Data::ConicArc { conic, z, start, end } => {
                let [a, b, c, x, y, f] = *conic;
                // The equation in model units.
                let conic = [a, b, c, x * scale, y * scale, f * scale * scale];
                let (curve, missed) = conics::conic(&level(*z), &conic, [flat(start), flat(end)])?;
                self.missed(d, missed, place);
                Ok(curve)
            }
            Data::Points { points, is_line: true } => {
                let mut points: Vec<DVec3> = points.iter().map(|p| *p * scale).collect();
                points.dedup();
                if let [a, b] = *points {
                    return Ok(build::line(a, b, origin)?);
                }
                Ok(build::polyline(&points, false, origin)?)
            }
            Data::Polynomials { breaks, pieces } => self.polynomials(d, breaks, pieces, scale),
            Data::Spline(spline) => self.spline(spline, scale),
            Data::Composite(members) => self.composite(d, members, place),
            Data::OffsetCurve { base, distance, normal, range } => {
                let base = self.curve(*base, place.deeper())?;
                let (a, b) = base.domain();
                let part = if range.0 < range.1 && range.0 < b && a < range.1 { base.part(range.0, range.1) } else { base };
                Ok(build::offset(&part, distance * scale, *normal, origin)?)
            }
            Data::Damaged => Err(defect(format!("{} is damaged", self.label(d)))),
            Data::Busy => Err(defect(format!("{} is made of itself", self.label(d)))),
            _ => Err(defect(format!("{} is not a curve", self.label(d)))),
        }
    }

    /// Says by how much the given end is off the curve.
    fn missed(&mut self, d: Pointer, missed: f64, place: CurveRequest) {
        if !place.in_uv && missed > self.slack() {
            let missed = self.length(missed);
            self.warn(d, format!("its given points are off the curve by {missed}"));
        }
    }

    /// Cubic pieces as Bézier pieces; powers of t − T(i).
    fn polynomials(&mut self, d: Pointer, breaks: &[f64], pieces: &[[[f64; 4]; 3]], scale: f64) -> Result<Curve, Defect> {
        let mut poles: Vec<DVec4> = Vec::with_capacity(3 * pieces.len() + 1);
        let mut knots = vec![breaks[0]; 4];
        let mut gap = 0.0_f64;
        for (piece, span) in pieces.iter().zip(breaks.windows(2)) {
            let h = span[1] - span[0];
            let c = |k: usize| DVec3::new(piece[0][k], piece[1][k], piece[2][k]) * scale;
            let b = bernstein([c(0), c(1), c(2), c(3)], h);
            match poles.last() {
                Some(last) => gap = gap.max(last.truncate().distance(b[0])),
                None => poles.push(b[0].extend(1.0)),
            }
            poles.extend(b[1..].iter().map(|p| p.extend(1.0)));
            knots.extend([span[1]; 3]);
        }
        knots.push(breaks[breaks.len() - 1]);
        if gap > self.slack() {
            let gap = self.length(gap);
            self.warn(d, format!("its pieces are {gap} apart; each starts where the one before ends"));
        }
        let points: Vec<DVec3> = poles.iter().map(|q| q.truncate()).collect();
        let curve = build::bspline(&points, 3, Some(&knots), false, self.origin)?;
        Ok(Curve::new(curve.shape().clone(), Kind::Spline, self.origin))
    }

    fn spline(&mut self, spline: &SplineData, scale: f64) -> Result<Curve, Defect> {
        let points: Vec<DVec3> = spline.points.iter().map(|p| *p * scale).collect();
        if let ([a, b], true) = (points.as_slice(), spline.weights.windows(2).all(|w| w[0] == w[1])) {
            let (first, last) = (spline.knots[1], spline.knots[2]);
            let at = |t: f64| *a + (*b - *a) * ((t - first) / (last - first));
            return Ok(build::line(at(spline.range.0), at(spline.range.1), self.origin)?);
        }
        check_weights(&spline.weights)?;
        let whole = build::nurbs(&points, &spline.weights, &spline.knots, spline.degree, self.origin)?;
        Ok(whole.part(spline.range.0, spline.range.1))
    }

    /// Curves in a row; points among them say nothing, and a piece written backwards is turned.
    fn composite(&mut self, d: Pointer, members: &[Pointer], place: CurveRequest) -> Result<Curve, Defect> {
        let mut pieces: Vec<Curve> = Vec::new();
        for member in members {
            if is_point(self.data(*member)?) {
                continue;
            }
            let curve = self.curve(*member, place.deeper()).map_err(|Defect(why)| defect(format!("its piece at D{member}: {why}")))?;
            self.copy(curve.composite().map_or(1, |c| c.pieces.len()))?;
            pieces.push(curve);
        }
        let gap = ordered(&mut pieces, if place.in_uv { 0.0 } else { self.slack() });
        if gap > self.slack() && !place.in_uv {
            let gap = self.length(gap);
            self.warn(d, format!("its pieces are {gap} apart"));
        }
        match pieces.as_slice() {
            [] => Err(defect("it has no pieces")),
            [one] => Ok(one.clone()),
            _ => Ok(Curve::new(Shape::Composite(Arc::new(Composite::new(pieces))), Kind::Composite, self.origin)),
        }
    }
}

/// Whether an entity is one point, as curves along a pole are.
fn is_point(data: &Data) -> bool {
    match data {
        Data::Point(_) => true,
        Data::Line { start, end, .. } => start == end,
        Data::Spline(s) => s.points.windows(2).all(|p| p[0] == p[1]),
        Data::Points { points, .. } => points.windows(2).all(|p| p[0] == p[1]),
        _ => false,
    }
}

/// Bernstein coefficients over 0…h of a cubic with these power coefficients.
pub fn bernstein([c0, c1, c2, c3]: [DVec3; 4], h: f64) -> [DVec3; 4] {
    let (c1, c2, c3) = (c1 * h, c2 * (h * h), c3 * (h * h * h));
    [c0, c0 + c1 / 3.0, c0 + c1 * (2.0 / 3.0) + c2 / 3.0, c0 + c1 + c2 + c3]
}
