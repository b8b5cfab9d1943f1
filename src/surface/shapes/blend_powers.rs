//! A blend made ready for many evaluations: its curves as polynomials, piece by piece, to rounding.
//!
//! In a cell of the blending functions of u, with s from −1 to 1 in it, Σ a_i(u) (F_i(v) − Σ b_j(v) P_ij) is a polynomial in s whose
//! coefficients are sums of curves along v; in a cell of v the same holds for Σ b_j(v) G_j(u). Curves run by their arc length, which no
//! polynomial does, so pieces between their knots are halved until polynomials through Chebyshev points come near to them.
//! A point costs eight polynomials, however many curves the blend is made of; second derivatives over a box are bounded by their own
//! coefficients about its middle. Pieces are made when they are first asked for.

use std::sync::OnceLock;

use glam::{DVec2, DVec3};

use crate::base::bbox::Box3;
use crate::base::range::Interval3;
use crate::base::tolerance::{EPSILON, LENGTH_ACCURACY, NEAREST, SHORT_TANGENT, SLIVER};
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::axis_powers::AxisPowers;
use crate::surface::shapes::blend::Blend;
use crate::surface::shapes::blend_track::Track;
use crate::surface::shapes::polynomial_pieces::{BoxBends, N, Piece, Shifted, summed, through, value};

/// Pieces are within this share of the size of the blend of its curves: what the arc lengths of these are accurate to, and a little more.
const ACCURACY: f64 = 4.0 * LENGTH_ACCURACY;
/// A box wider than this share of a cell is bounded in parts.
const WIDEST: f64 = 0.25;
/// A box over more pieces than this is not bounded piece by piece.
const MOST_PIECES: usize = 256;

/// Sums of curves for each power of the other direction's parameter in one cell of it: piece by piece, powers fastest.
#[derive(Debug)]
struct Columns {
    halvings: u32,
    count: usize,
    pieces: Vec<Piece>,
}

/// What is made of a blend: shared by all that use it at the same time, and gone with the last of them.
#[derive(Debug)]
pub(crate) struct BlendPowers {
    tracks: [Track; 2],
    powers: [AxisPowers; 2],
    /// Of curves along v by cells of u and parts of v (fastest), then of curves along u by cells of v and parts of u.
    columns: [Vec<OnceLock<Option<Columns>>>; 2],
    /// How far polynomials may be from curves, model units.
    allowed: f64,
    /// Diagonal of all curves, model units.
    size: f64,
    /// Shortest first derivative that is taken from polynomials, model units.
    shortest: f64,
}

/// A place in a direction: part, cell, place in the cell from −1 to 1 and one over its half width.
#[derive(Clone, Copy)]
struct Place {
    x: f64,
    part: usize,
    cell: usize,
    s: f64,
    by: f64,
}

impl BlendPowers {
    /// `None` of polynomial blends of many curves.
    pub(crate) fn new(blend: &Blend) -> Option<Self> {
        let (u, v) = blend.axes();
        let powers = [AxisPowers::new(u)?, AxisPowers::new(v)?];
        let rails = [blend.along_u(), blend.along_v()];
        let hull = rails.iter().flat_map(|rails| rails.iter()).map(Rail::hull).reduce(Box3::union)?;
        let tracks = [0, 1].map(|k| Track::new(rails[k], [u, v][k], &powers[k], hull.diagonal()));
        let size = hull.diagonal();
        let furthest = hull.min.abs().max(hull.max.abs()).max_element();
        let columns = [(0, 1), (1, 0)].map(|(of, along)| {
            let count = powers[of].terms.len() * tracks[along].parts.len();
            std::iter::repeat_with(OnceLock::new).take(count).collect()
        });
        Some(Self { tracks, powers, columns, allowed: ACCURACY * size + 0.25 * EPSILON * furthest, size, shortest: SHORT_TANGENT * size })
    }

    /// Lines of u and of v at which first derivatives jump.
    pub(crate) fn corners(&self, in_u: bool) -> &[f64] {
        &self.tracks[usize::from(!in_u)].corners
    }

    fn place(&self, k: usize, x: f64) -> Place {
        let track = &self.tracks[k];
        let inner = &track.stops[1..track.stops.len() - 1];
        let part = inner.partition_point(|stop| *stop <= x);
        let cell = track.cells[part];
        let (a, b) = (self.powers[k].ends[cell], self.powers[k].ends[cell + 1]);
        let by = 2.0 / (b - a);
        Place { x, part, cell, s: (x - a) * by - 1.0, by }
    }

    /// The sums of curves at a place along them, in the cell of a place across; the place from −1 to 1 and one over half the piece's width.
    fn column(&self, blend: &Blend, across: &Place, along: &Place, along_v: bool) -> Option<(&[Piece], f64, f64)> {
        let k = usize::from(along_v);
        let track = &self.tracks[k];
        let at = across.cell * track.parts.len() + along.part;
        let columns = self.columns[1 - k][at].get_or_init(|| self.make(blend, across.cell, along.part, along_v)).as_ref()?;
        let (a, b) = (track.stops[along.part], track.stops[along.part + 1]);
        let pieces = (1_u64 << columns.halvings) as f64;
        let by = pieces / (b - a);
        let whole = (along.x - a) * by;
        let piece = whole.floor().clamp(0.0, pieces - 1.0);
        let own = &columns.pieces[piece as usize * columns.count..][..columns.count];
        Some((own, 2.0 * (whole - piece) - 1.0, 2.0 * by))
    }

    fn make(&self, blend: &Blend, cell: usize, part: usize, along_v: bool) -> Option<Columns> {
        let k = usize::from(along_v);
        let rails = if along_v { blend.along_v() } else { blend.along_u() };
        let (across, own) = if along_v { blend.axes() } else { (blend.axes().1, blend.axes().0) };
        let track = &self.tracks[k];
        let sampled = track.parts[part].get_or_init(|| track.sampled(rails, part, (self.allowed, self.size))).as_ref()?;
        let terms = &self.powers[1 - k].terms[cell];
        let count = terms.iter().map(|(_, powers)| powers.len()).max().unwrap_or(0);
        let pieces = 1_usize << sampled.halvings;
        let mut sums = vec![DVec3::ZERO; count * pieces * N];
        let mut line = vec![DVec3::ZERO; pieces * N];
        let places = track.places(part, sampled.halvings);
        for (term, powers) in terms {
            line.fill(DVec3::ZERO);
            match term.checked_sub(rails.len()) {
                None => line.copy_from_slice(&sampled.points[*term]),
                Some(slope) => {
                    for (by, points) in across.slopes()[slope].iter().zip(&sampled.points).filter(|(by, _)| **by != 0.0) {
                        line.iter_mut().zip(points).for_each(|(sum, p)| *sum += *p * *by);
                    }
                }
            }
            if along_v {
                for (p, x) in line.iter_mut().zip(&places) {
                    for (j, w) in own.weights(*x, OneSided::After).iter() {
                        *p -= blend.corner(*term, j) * w[0];
                    }
                }
            }
            for (power, by) in powers.iter().enumerate() {
                let to = &mut sums[power * pieces * N..][..pieces * N];
                to.iter_mut().zip(&line).for_each(|(sum, p)| *sum += *p * *by);
            }
        }
        let all = (0..pieces).flat_map(|piece| (0..count).map(move |power| power * pieces + piece));
        let pieces = all.map(|first| through(&sums[first * N..][..N])).collect();
        Some(Columns { halvings: sampled.halvings, count, pieces })
    }

    /// The point; `None` where a curve is none to be had as polynomials.
    pub(crate) fn point(&self, blend: &Blend, u: f64, v: f64) -> Option<DVec3> {
        let (u, v) = (self.place(0, u), self.place(1, v));
        let (pieces, x, _) = self.column(blend, &v, &u, false)?;
        let first = value(pieces, v.s, x);
        if blend.along_v().is_empty() {
            return Some(first);
        }
        let (pieces, y, _) = self.column(blend, &u, &v, true)?;
        Some(first + value(pieces, u.s, y))
    }

    /// Point and all derivatives; `None` too where a tangent is short, as beside a pole: its direction would be that of rounding.
    pub(crate) fn jet(&self, blend: &Blend, u: f64, v: f64) -> Option<Jet2> {
        let (u, v) = (self.place(0, u), self.place(1, v));
        let (pieces, x, by) = self.column(blend, &v, &u, false)?;
        let [p, dt, dx, dtt, dtx, dxx] = summed(pieces, v.s, x);
        let mut jet = Jet2 { p, du: dx * by, dv: dt * v.by, duu: dxx * (by * by), duv: dtx * (by * v.by), dvv: dtt * (v.by * v.by) };
        if !blend.along_v().is_empty() {
            let (pieces, y, by) = self.column(blend, &u, &v, true)?;
            let [p, ds, dy, dss, dsy, dyy] = summed(pieces, u.s, y);
            jet.p += p;
            jet.du += ds * u.by;
            jet.dv += dy * by;
            jet.duu += dss * (u.by * u.by);
            jet.duv += dsy * (u.by * by);
            jet.dvv += dyy * (by * by);
        }
        (jet.du.length_squared().min(jet.dv.length_squared()) > self.shortest * self.shortest).then_some(jet)
    }

    /// Second derivatives along a unit vector over a box of u and v, jumps of first ones inside not counted.
    pub(crate) fn bends(&self, blend: &Blend, (low, high): (DVec2, DVec2), along: DVec3) -> Option<BoxBends> {
        let us = self.parted(blend, 0, (low.x, high.x))?;
        let vs = self.parted(blend, 1, (low.y, high.y))?;
        if us.len() * vs.len() > MOST_PIECES {
            return None;
        }
        let (us, vs) = (self.narrowed(0, &us), self.narrowed(1, &vs));
        let mut whole: Option<BoxBends> = None;
        for v in vs.windows(2) {
            for u in us.windows(2) {
                let own = self.own_bends(blend, (DVec2::new(u[0], v[0]), DVec2::new(u[1], v[1])), along)?;
                whole = Some(whole.map_or(own, |w| w.union(&own)));
            }
        }
        whole
    }

    /// Stops with more of them where coefficients about the middle would say little: at most a quarter of a cell apart.
    fn narrowed(&self, k: usize, stops: &[f64]) -> Vec<f64> {
        let mut all = vec![stops[0]];
        for w in stops.windows(2) {
            let cell = self.place(k, 0.5 * (w[0] + w[1])).cell;
            let width = self.powers[k].ends[cell + 1] - self.powers[k].ends[cell];
            let parts = ((w[1] - w[0]) / (WIDEST * width) - NEAREST).ceil().max(1.0);
            all.extend((1..parts as usize).map(|n| w[0] + (w[1] - w[0]) * n as f64 / parts));
            all.push(w[1]);
        }
        all
    }

    /// Ranges of ∂uu, ∂uv and ∂vv over a box of u and v; `None` where first derivatives jump inside.
    pub(crate) fn ranges(&self, blend: &Blend, (low, high): (DVec2, DVec2)) -> Option<[Interval3; 3]> {
        let crossed = |k: usize, low: f64, high: f64| self.tracks[k].corners.iter().any(|x| *x > low + EPSILON && *x < high - EPSILON);
        if crossed(0, low.x, high.x) || crossed(1, low.y, high.y) {
            return None;
        }
        let [x, y, z] = [
            self.bends(blend, (low, high), DVec3::X)?,
            self.bends(blend, (low, high), DVec3::Y)?,
            self.bends(blend, (low, high), DVec3::Z)?,
        ];
        Some([0, 1, 2].map(|k| {
            let (mid, slack) = (DVec3::new(x.mid[k], y.mid[k], z.mid[k]), DVec3::new(x.slack[k], y.slack[k], z.slack[k]));
            Interval3 { low: mid - slack, high: mid + slack }
        }))
    }

    /// An interval with the ends of pieces inside.
    fn parted(&self, blend: &Blend, k: usize, (low, high): (f64, f64)) -> Option<Vec<f64>> {
        let track = &self.tracks[k];
        let rails = if k == 0 { blend.along_u() } else { blend.along_v() };
        let mut stops = vec![low];
        let first = self.place(k, low + SLIVER.min(0.5 * (high - low))).part;
        for part in first..track.parts.len() {
            let (a, b) = (track.stops[part], track.stops[part + 1]);
            if a >= high || stops.len() > MOST_PIECES {
                break;
            }
            let halvings = track.parts[part].get_or_init(|| track.sampled(rails, part, (self.allowed, self.size))).as_ref()?.halvings;
            let pieces = 1_u64 << halvings;
            let ends = (1..=pieces).map(|n| a + (b - a) * n as f64 / pieces as f64);
            stops.extend(ends.filter(|x| *x > low + EPSILON && *x < high - EPSILON));
        }
        stops.push(high);
        Some(stops)
    }

    /// The same over a box inside one piece of each direction.
    fn own_bends(&self, blend: &Blend, (low, high): (DVec2, DVec2), along: DVec3) -> Option<BoxBends> {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let (u, v) = (self.place(0, middle.x), self.place(1, middle.y));
        let (pieces, x, by) = self.column(blend, &v, &u, false)?;
        let b = Shifted::new(pieces, (v.s, x), along).bends((half.y * v.by, half.x * by), (v.by, by));
        // Derivatives along u twice come last in the sums of curves along u.
        let mut bends = BoxBends { mid: [b.mid[2], b.mid[1], b.mid[0]], slack: [b.slack[2], b.slack[1], b.slack[0]] };
        if !blend.along_v().is_empty() {
            let (pieces, y, by) = self.column(blend, &u, &v, true)?;
            let a = Shifted::new(pieces, (u.s, y), along).bends((half.x * u.by, half.y * by), (u.by, by));
            for k in 0..3 {
                bends.mid[k] += a.mid[k];
                bends.slack[k] += a.slack[k];
            }
        }
        Some(bends)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math;
    use crate::base::origin::Origin;
    use crate::geometry::Kind;
    use crate::geometry::construct::build::conic;
    use crate::geometry::construct::spline::{Ends, Spline, spline};
    use crate::network::Chain;
    use crate::surface::rails::reparam::{Map, Reparam};
    use crate::surface::shapes::rule::Rule;
    use crate::surface::shapes::spline_parts::Joins;
    use crate::surface::shapes::weights::BlendAxis;

    /// A net over a wavy surface whose curves run unevenly by their arc lengths, with a corner across u at its second node.
    fn net(rule: Rule) -> Blend {
        let (us, vs) = (vec![0.0, 0.2, 0.55, 0.8, 1.0], vec![0.0, 0.4, 0.7, 1.0]);
        let f = |u: f64, v: f64| DVec3::new(3.0 * u, 2.0 * v + 0.2 * u * v, math::sin(4.0 * u) * math::cos(3.0 * v) + (u - 0.2).abs());
        let line = |points: Vec<DVec3>, nodes: &[f64]| {
            let curve = spline(&points, &Spline { start: Ends::Natural, end: Ends::Natural, closed: false }, Origin::NONE).unwrap();
            let knots: Vec<f64> = curve.knots().iter().map(|t| curve.length_at(*t) / curve.length()).collect();
            Rail::new(Chain::of_curve(&curve), Map::new(nodes.to_vec(), knots, Reparam::Smooth, false))
        };
        let along_u = vs.iter().map(|v| line(us.iter().map(|u| f(*u, *v)).collect(), &us)).collect();
        let along_v = us.iter().map(|u| line(vs.iter().map(|v| f(*u, *v)).collect(), &vs)).collect();
        let joints = vec![(1, Joins::Corner), (3, Joins::Before)];
        Blend::new(BlendAxis::with_joints(us, rule, joints), BlendAxis::new(vs, rule), along_v, along_u)
    }

    #[test]
    fn polynomials_are_the_blend_to_rounding() {
        for rule in [Rule::Spline, Rule::Cubic, Rule::Linear, Rule::Lagrange] {
            let blend = net(rule);
            let powers = BlendPowers::new(&blend).unwrap();
            for i in 0..37 {
                for j in 0..31 {
                    let (u, v) = (f64::from(i) / 36.7, f64::from(j) / 30.3);
                    let (own, made) = (blend.jet(u, v, (OneSided::After, OneSided::After)), powers.jet(&blend, u, v).unwrap());
                    assert!(
                        own.p.distance(made.p) < 1e-12 && powers.point(&blend, u, v).unwrap().distance(own.p) < 1e-12,
                        "{rule:?} {u} {v}"
                    );
                    assert!(own.du.distance(made.du) < 1e-9 && own.dv.distance(made.dv) < 1e-9, "{rule:?} {u} {v} {own:?} {made:?}");
                    let second = [own.duu - made.duu, own.duv - made.duv, own.dvv - made.dvv];
                    assert!(second.iter().all(|d| d.length() < 1e-5), "{rule:?} {u} {v} {own:?} {made:?}");
                }
            }
        }
    }

    /// Conics that turn within a ten-thousandth of their length: the bend lies beside the ends of pieces, where nothing is compared.
    #[test]
    fn a_bend_between_compared_places_is_not_lost() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        for rho in [0.9, 0.999, 0.9999, 0.999_99, 0.999_999] {
            let sharp = |y: f64| conic(at(0.0, y, 0.0), at(1.0, y, 0.1 * y), at(1.0, y, 1.0), rho, Kind::Conic, Origin::NONE).unwrap();
            let rails = [0.0, 2.0].map(|y| Rail::new(Chain::of_curve(&sharp(y)), Map::identity())).to_vec();
            let axis = || BlendAxis::new(vec![0.0, 1.0], Rule::Lagrange);
            let blend = Blend::new(axis(), axis(), Vec::new(), rails);
            let powers = BlendPowers::new(&blend).unwrap();
            for i in -400..400 {
                let share = f64::from(i) / 400.0;
                let u = 0.5 + 0.01 * share * share * share;
                let own = blend.jet(u, 0.3, (OneSided::After, OneSided::After)).p;
                let made = powers.point(&blend, u, 0.3).unwrap_or(own);
                assert!(own.distance(made) < 1e-11, "{rho} {u} {}", own.distance(made));
            }
        }
    }

    #[test]
    fn bends_hold_every_second_derivative_of_a_box() {
        let blend = net(Rule::Spline);
        let powers = BlendPowers::new(&blend).unwrap();
        let along = DVec3::new(0.3, -0.5, 0.9).normalize();
        for (low, high) in [((0.22, 0.1), (0.31, 0.17)), ((0.5, 0.3), (0.7, 0.8)), ((0.81, 0.72), (0.84, 0.76))] {
            let (low, high) = (DVec2::from(low), DVec2::from(high));
            let bends = powers.bends(&blend, (low, high), along).unwrap();
            let (mut least, mut most) = ([f64::MAX; 3], [f64::MIN; 3]);
            for k in 0..400 {
                let at = low + (high - low) * DVec2::new(f64::from(k % 20) / 19.0, f64::from(k / 20) / 19.0);
                let jet = powers.jet(&blend, at.x, at.y).unwrap();
                for (d, own) in [jet.duu, jet.duv, jet.dvv].iter().enumerate() {
                    let own = own.dot(along);
                    assert!((own - bends.mid[d]).abs() <= bends.slack[d] + 1e-9, "{d} {own} {bends:?}");
                    (least[d], most[d]) = (least[d].min(own), most[d].max(own));
                }
            }
            (0..3).for_each(|d| assert!(bends.slack[d] <= 4.0 * (most[d] - least[d]) + 1e-6, "{d} {bends:?} {least:?} {most:?}"));
        }
    }
}
