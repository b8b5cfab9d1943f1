//! A border of a face with the normals of the face along it, and its copies at distances along them.

use glam::{DVec2, DVec3};

use crate::base::fault::Result;
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::{NUDGE, PARALLEL, Tolerance};
use crate::geometry::Nurbs;
use crate::geometry::data::fault::CurveFault;
use crate::network::Chain;
use crate::surface::closest::foot::{foot, step};
use crate::surface::core::surface::{Parts, Surface};
use crate::surface::data::breaks::chain_breaks;
use crate::surface::data::jet::{Jet2, slopes};
use crate::surface::data::kind::Domain;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::side::{Border, Side};
use crate::surface::rails::trim_curve::TrimCurve;
use crate::surface::trims::trim_loop::{TrimLoop, natural};

/// Share of the tolerance within which copies of a border are.
const SHARE: f64 = 0.125;
/// Places inside a cubic at which it is compared.
const PROBES: [f64; 5] = [0.13, 0.3, 0.5, 0.7, 0.87];
/// Cubics at most.
const MOST_PIECES: usize = 1 << 12;
/// Step for differences of normals.
const STEP: f64 = NUDGE;

/// A border in the direction of its loop, the face on its left.
#[derive(Clone)]
pub struct Boundary {
    surface: Surface,
    side: Side,
    trim_curve: TrimCurve,
    /// The part of the trim curve that it is; of a closed one it may run on beyond 1.
    part: (f64, f64),
}

/// What is known at a place of a border; derivatives by the parameter along it.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryJet {
    /// The point.
    pub p: DVec3,
    /// Its derivative.
    pub d1: DVec3,
    /// The unit normal of the face.
    pub normal: DVec3,
    /// Its derivative.
    pub turn: DVec3,
}

impl BoundaryJet {
    /// The point at a distance along the normal, and its derivative.
    pub fn beside(&self, distance: f64) -> (DVec3, DVec3) {
        (self.p + self.normal * distance, self.d1 + self.turn * distance)
    }
}

/// The surface below a trimmed one with its poles, so that it has normals there; any other surface as it is.
pub(crate) fn whole(surface: &Surface, tolerance: &Tolerance) -> Surface {
    const PLACES: usize = 5;
    let below = surface.untrimmed();
    if surface.parts().trim.is_none() || below.domain() != Domain::Square {
        return below;
    }
    let side = |k: usize| {
        let point = |i: usize| {
            let t = i as f64 / (PLACES - 1) as f64;
            let (u, v) = [(t, 0.0), (1.0, t), (t, 1.0), (0.0, t)][k];
            below.point(u, v)
        };
        let one = (1..PLACES).all(|i| tolerance.same_point(point(i), point(0)));
        Border::straight(if one { Side::Pole(point(0)) } else { Side::Free })
    };
    Surface::new(Parts { borders: (0..4).map(side).collect(), ..below.parts().clone() })
}

/// The borders of all loops of a face, loop by loop; `None` for poles and for seams, across which the face goes on.
pub(crate) fn boundaries(surface: &Surface, trim_loops: &[TrimLoop], tolerance: &Tolerance) -> Vec<Vec<Option<Boundary>>> {
    let below = whole(surface, tolerance);
    let each = |trim_loop: &TrimLoop| {
        let twins = trim_loop.twins(surface);
        let one = |k: usize| {
            let pole = matches!(trim_loop.borders[k].side, Side::Pole(_));
            (!pole && twins[k].is_none()).then(|| Boundary::of(&below, trim_loop, k))
        };
        (0..trim_loop.borders.len()).map(one).collect()
    };
    trim_loops.iter().map(each).collect()
}

/// The chains of the borders of a face; neither poles nor seams, across which the face goes on.
pub(crate) fn border_chains(surface: &Surface, tolerance: &Tolerance) -> Result<Vec<Chain>> {
    let mut all = Vec::new();
    for trim_loop in natural(surface, tolerance)? {
        let chain = |(border, twin): (&Border, Option<usize>)| match &border.side {
            Side::Chain { chain, .. } if twin.is_none() => Some(chain.clone()),
            _ => None,
        };
        all.extend(trim_loop.borders.iter().zip(trim_loop.twins(surface)).filter_map(chain));
    }
    Ok(all)
}

impl Boundary {
    /// Border `k` of a loop of the face over a surface.
    fn of(below: &Surface, trim_loop: &TrimLoop, k: usize) -> Self {
        Self {
            surface: below.clone(),
            side: trim_loop.borders[k].side.clone(),
            trim_curve: trim_loop.trim_curves[k].clone(),
            part: (0.0, 1.0),
        }
    }

    /// Parameters along the border, ends included, between which it has no corner.
    pub fn stops(&self) -> Vec<f64> {
        let inner: Vec<f64> = match (&self.trim_curve, &self.side) {
            (TrimCurve::Pcurve(pcurve), Side::Chain { chain, .. }) => {
                let (from, to) = (pcurve.fraction(0.0), pcurve.fraction(1.0));
                chain_breaks(chain).into_iter().map(|f| (f - from) / (to - from)).collect()
            }
            (TrimCurve::Line(a, b), _) => {
                let (us, vs) = self.surface.breaks();
                let along = |x: f64, a: f64, b: f64| if a == b { f64::NAN } else { (x - a) / (b - a) };
                us.iter().map(|u| along(*u, a.0, b.0)).chain(vs.iter().map(|v| along(*v, a.1, b.1))).collect()
            }
            _ => Vec::new(),
        };
        let (from, to) = self.part;
        // Of a closed border the start is a stop, too, and all comes once more.
        let twice = inner.into_iter().chain([0.0]).flat_map(|t| [t, t + 1.0]).map(|t| (t - from) / (to - from));
        let mut stops: Vec<f64> = twice.filter(|t| *t > NUDGE && *t < 1.0 - NUDGE).chain([0.0, 1.0]).collect();
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|b, a| *b - *a <= NUDGE);
        stops
    }

    /// The place at a parameter from 0 to 1; `before`: of the piece that ends there. `None` where nothing is known of it.
    pub fn jet(&self, t: f64, before: bool) -> Option<BoundaryJet> {
        let (uv, p, d1, way) = self.place(t, before)?;
        let side = |x: f64| if x < 0.0 { OneSided::Before } else { OneSided::After };
        let way = if before { -way } else { way };
        let sides = (side(way.x), side(way.y));
        let normal = self.surface.normal_one_sided(uv.x, uv.y, sides);
        let jet = self.surface.jet_one_sided(uv.x, uv.y, sides);
        let along = if before { -way } else { way };
        let turn = match slopes(&jet) {
            Some((nu, nv)) if normal.length_squared() > 0.0 => nu * along.x + nv * along.y,
            _ => self.difference(t, before, normal)?,
        };
        Some(BoundaryJet { p, d1, normal, turn })
    }

    /// The derivative of the normal where the surface stands still.
    fn difference(&self, t: f64, before: bool, normal: DVec3) -> Option<DVec3> {
        let h = if (before || t + STEP > 1.0) && t >= STEP { -STEP } else { STEP };
        let (uv, ..) = self.place(t + h, before)?;
        Some((self.surface.normal(uv.x, uv.y) - normal) / h)
    }

    /// The part between two parameters; beyond 1 of a closed border.
    pub fn between(&self, from: f64, to: f64) -> Self {
        let (a, b) = self.part;
        Self { part: (a + (b - a) * from, a + (b - a) * to), ..self.clone() }
    }

    /// Parameters inside at which it has a corner.
    pub fn corners(&self, tolerance: &Tolerance) -> Vec<f64> {
        let way = |t: f64, before: bool| self.jet(t, before).map_or(DVec3::ZERO, |jet| jet.d1);
        let mut stops = self.stops();
        stops.retain(|t| *t > 0.0 && *t < 1.0 && tolerance.is_kink(way(*t, true), way(*t, false)));
        stops
    }

    /// The point of [`Boundary::jet`] by itself: its foot and the normal there are many times the work.
    pub fn point(&self, t: f64) -> Option<DVec3> {
        let t = self.of_whole(t, false);
        match (&self.trim_curve, &self.side) {
            (TrimCurve::Pcurve(pcurve), Side::Chain { chain, .. }) => {
                let (f, onwards) = (pcurve.fraction(t), pcurve.fraction(1.0) > pcurve.fraction(0.0));
                Some(if onwards { chain.jet(f).p } else { chain.jet_before(f).p })
            }
            _ => self.whole_place(t, false).map(|place| place.1),
        }
    }

    /// The parameter of the whole border.
    fn of_whole(&self, t: f64, before: bool) -> f64 {
        let (from, to) = self.part;
        let whole = from + (to - from) * t;
        let beyond = whole > 1.0 || whole == 1.0 && !before && to > 1.0;
        if beyond { whole - 1.0 } else { whole }
    }

    /// Place, point, derivative of the point and of the place.
    fn place(&self, t: f64, before: bool) -> Option<(DVec2, DVec3, DVec3, DVec2)> {
        let (from, to) = self.part;
        let (uv, p, d1, way) = self.whole_place(self.of_whole(t, before), before)?;
        Some((uv, p, d1 * (to - from), way * (to - from)))
    }

    /// The same by the parameter of the whole border.
    fn whole_place(&self, t: f64, before: bool) -> Option<(DVec2, DVec3, DVec3, DVec2)> {
        match (&self.trim_curve, &self.side) {
            (TrimCurve::Line(a, b), _) => {
                let (a, b) = (DVec2::from(*a), DVec2::from(*b));
                let (uv, way) = (a.lerp(b, t), b - a);
                let jet: Jet2 = self.surface.jet(uv.x, uv.y);
                Some((uv, jet.p, jet.du * way.x + jet.dv * way.y, way))
            }
            (TrimCurve::Pcurve(pcurve), Side::Chain { chain, .. }) => {
                let (f, speed) = (pcurve.fraction(t), pcurve.fraction(1.0) - pcurve.fraction(0.0));
                let own = if before == (speed > 0.0) { chain.jet_before(f) } else { chain.jet(f) };
                let uv = match self.surface.flat_uv(own.p) {
                    Some(uv) => uv.into(),
                    None => foot(self.surface.evaluator(), own.p, pcurve.guess(f)).0,
                };
                let jet: Jet2 = self.surface.jet(uv.x, uv.y);
                let d1 = own.d1 * speed;
                Some((uv, own.p, d1, step(jet.du, jet.dv, d1).unwrap_or(DVec2::ZERO)))
            }
            _ => None,
        }
    }

    /// Copies of the border at distances along the normals (model units), with common parameters and knots: cubics within an
    /// eighth of the tolerance of `point` model units.
    pub fn copies<const N: usize>(&self, distances: [f64; N], origin: Origin, tolerance: &Tolerance) -> Result<[Nurbs; N]> {
        let lost = || CurveFault::NotConverged {
            of: origin,
            what: "the border at a distance".to_owned(),
            at: self.jet(0.0, false).map_or(DVec3::ZERO, |jet| jet.p),
        };
        let jet = |t: f64, before: bool| self.jet(t, before).ok_or_else(|| crate::base::fault::Fault::from(lost()));
        let cubic = |a: f64, b: f64, from: &BoundaryJet, to: &BoundaryJet, d: f64| {
            let ((p, dp), (q, dq), h) = (from.beside(d), to.beside(d), b - a);
            [p, p + dp * (h / 3.0), q - dq * (h / 3.0), q]
        };
        let mut rows: [Vec<[DVec3; 4]>; N] = std::array::from_fn(|_| Vec::new());
        let mut ends: Vec<f64> = vec![0.0];
        for w in self.stops().windows(2) {
            let mut open = vec![(w[0], jet(w[0], false)?, w[1], jet(w[1], true)?)];
            while let Some((a, from, b, to)) = open.pop() {
                job::poll();
                let cubics: Vec<[DVec3; 4]> = distances.iter().map(|d| cubic(a, b, &from, &to, *d)).collect();
                let mut good = true;
                for probe in PROBES {
                    let here = jet(a + (b - a) * probe, false)?;
                    good &= distances.iter().zip(&cubics).all(|(d, c)| at(c, probe).distance(here.beside(*d).0) <= SHARE * tolerance.point);
                }
                if good {
                    rows.iter_mut().zip(cubics).for_each(|(row, c)| row.push(c));
                    ends.push(b);
                    continue;
                }
                if ends.len() + open.len() > MOST_PIECES || b - a < NUDGE * NUDGE {
                    return Err(lost().into());
                }
                let middle = 0.5 * (a + b);
                open.push((middle, jet(middle, false)?, b, to));
                open.push((a, from, middle, jet(middle, true)?));
            }
        }
        Ok(joined(&rows, &ends))
    }

    /// The border at a distance as a curve.
    pub fn copy(&self, distance: f64, origin: Origin, tolerance: &Tolerance) -> Result<Chain> {
        let [made] = self.copies([distance], origin, tolerance)?;
        Ok(curve(made, origin))
    }
}

/// A spline as a curve of its own.
pub(crate) fn curve(made: Nurbs, origin: Origin) -> Chain {
    use crate::geometry::curves::curve::Shape;
    use crate::geometry::{Curve, Kind};
    Chain::of_curve(&Curve::new(Shape::Nurbs(std::sync::Arc::new(made)), Kind::Offset, origin))
}

/// A cubic at a parameter from 0 to 1.
fn at(poles: &[DVec3; 4], t: f64) -> DVec3 {
    let s = 1.0 - t;
    poles[0] * (s * s * s) + poles[1] * (3.0 * s * s * t) + poles[2] * (3.0 * s * t * t) + poles[3] * (t * t * t)
}

/// Rows of cubics between common ends as splines with common knots: double ones, triple where some row has a corner.
fn joined<const N: usize>(rows: &[Vec<[DVec3; 4]>; N], ends: &[f64]) -> [Nurbs; N] {
    let n = ends.len() - 1;
    let smooth = |k: usize| {
        rows.iter().all(|row| {
            let (before, after) = (row[k - 1][3] - row[k - 1][2], row[k][1] - row[k][0]);
            let (h, g) = (ends[k] - ends[k - 1], ends[k + 1] - ends[k]);
            (before / h - after / g).length() <= PARALLEL * (before.length() / h + after.length() / g)
        })
    };
    let joints: Vec<bool> = (1..n).map(smooth).collect();
    let inner = ends[1..n].iter().zip(&joints).flat_map(|(t, smooth)| std::iter::repeat_n(*t, if *smooth { 2 } else { 3 }));
    let knots: Vec<f64> = std::iter::repeat_n(0.0, 4).chain(inner).chain(std::iter::repeat_n(1.0, 4)).collect();
    let poles = |row: &Vec<[DVec3; 4]>| {
        let mut all = vec![row[0][0]];
        for (k, cubic) in row.iter().enumerate() {
            all.extend([cubic[1], cubic[2]]);
            if k + 1 == n || !joints[k] {
                all.push(cubic[3]);
            }
        }
        all.into_iter().map(|p| p.extend(1.0)).collect::<Vec<_>>()
    };
    std::array::from_fn(|k| Nurbs::new(3, knots.clone(), poles(&rows[k])))
}
