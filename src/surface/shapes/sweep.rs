//! Simple sweeps [Koh & Park 1990, §4.2]: a profile translated along a straight path or turned about an axis.
//!
//! u runs along the path, v along the profile by its arc-length fraction; both are exact.

use glam::DVec3;

use crate::base::bbox::Box3;
use crate::base::digest::{StableHash, StableHasher};
use crate::base::fault::Result;
use crate::base::origin::Origin;
use crate::base::range::{Interval, Interval3};
use crate::base::tolerance::{EPSILON, Tolerance};
use crate::base::{math, par};
use crate::geometry::construct::build::{arc_center, line};
use crate::geometry::data::fault::CurveFault;
use crate::geometry::{Curve, Jet, Motion};
use crate::network::Chain;
use crate::surface::data::breaks::{chain_breaks, tidy};
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::rails::rail::Rail;

/// A vector turned about an axis by up to ±`reach` radians.
fn turn_range(w: DVec3, axis: DVec3, reach: f64) -> Interval3 {
    let still = axis * axis.dot(w);
    let (out_of, across) = (w - still, axis.cross(w));
    let (sin, cos) = math::sin_cos(reach.min(std::f64::consts::PI));
    let sides = Interval::around_zero(if reach < std::f64::consts::FRAC_PI_2 { sin } else { 1.0 });
    Interval { low: cos, high: 1.0 } * out_of + sides * across + still
}

/// Rows of points made by one thread at a time.
const ROWS: usize = 16;

/// How a profile moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// S(u, v) = G(v) + u·by.
    Straight {
        /// The whole way, model units.
        by: DVec3,
    },
    /// S(u, v) = o + Rot(a, uΘ)(G(v) − o).
    Turn {
        /// A point of the axis.
        about: DVec3,
        /// Unit direction of the axis.
        axis: DVec3,
        /// Whole angle Θ, radians.
        angle: f64,
    },
}

/// A profile translated or turned along a path.
#[derive(Clone, Debug)]
pub struct Sweep {
    profile: Rail,
    path: Path,
}

crate::content!(Sweep { profile, path });

impl StableHash for Path {
    fn hash_into(&self, to: &mut StableHasher) {
        match self {
            Self::Straight { by } => (0u8, *by).hash_into(to),
            Self::Turn { about, axis, angle } => (1u8, (*about, *axis, *angle)).hash_into(to),
        }
    }
}

/// A rotation about an axis, made once per column.
#[derive(Clone, Copy)]
struct Turned {
    sin: f64,
    cos: f64,
    axis: DVec3,
}

impl Turned {
    fn new(axis: DVec3, angle: f64) -> Self {
        let (sin, cos) = math::sin_cos(angle);
        Self { sin, cos, axis }
    }

    fn rotated(&self, v: DVec3) -> DVec3 {
        v * self.cos + self.axis.cross(v) * self.sin + self.axis * (self.axis.dot(v) * (1.0 - self.cos))
    }
}

impl Sweep {
    /// The profile under its own parameter 0…1 along a path.
    pub fn new(profile: Rail, path: Path) -> Self {
        Self { profile, path }
    }

    /// How it moves.
    pub fn path(&self) -> Path {
        self.path
    }

    /// The angle at a parameter; a whole turn comes back to the first column to the last bit.
    fn angle_at(angle: f64, u: f64) -> f64 {
        if u == 1.0 && angle.abs() == std::f64::consts::TAU { 0.0 } else { u * angle }
    }

    fn placed(&self, g: &Jet, u: f64) -> Jet2 {
        match self.path {
            Path::Straight { by } => Jet2 { p: g.p + by * u, du: by, dv: g.d1, dvv: g.d2, ..Jet2::default() },
            Path::Turn { about, axis, angle } => {
                let turned = Turned::new(axis, Self::angle_at(angle, u));
                let arm = turned.rotated(g.p - about);
                let (dv, dvv) = (turned.rotated(g.d1), turned.rotated(g.d2));
                // An end that rounding put beside the axis, or across it, is on it: there nothing turns. Far from the origin points are
                // rounded by more than their arms say.
                let across = axis.cross(arm);
                let size = arm.length_squared() + g.d1.length_squared() + g.p.length_squared();
                let on_axis = across.length_squared() <= EPSILON * EPSILON * size;
                let du = if on_axis { DVec3::ZERO } else { across * angle };
                Jet2 { p: about + arm, du, dv, duu: axis.cross(du) * angle, duv: axis.cross(dv) * angle, dvv }
            }
        }
    }

    /// Where a point of the profile, with its derivatives, lies.
    pub fn jet_of(&self, g: &Jet, u: f64) -> Jet2 {
        self.placed(g, u)
    }

    /// Point and derivatives, from the given side in v where they jump.
    pub fn jet(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        self.placed(&self.profile.jet(v, side.1), u)
    }

    /// Points of the tensor grid, u fastest: the profile is evaluated once per row, the turn once per column.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        let profile = self.profile.points(vs);
        let width = us.len().max(1);
        let turns: Vec<Turned> = match self.path {
            Path::Straight { .. } => Vec::new(),
            Path::Turn { axis, angle, .. } => us.iter().map(|&u| Turned::new(axis, Self::angle_at(angle, u))).collect(),
        };
        par::chunks_mut(out, width * ROWS, |chunk, part| {
            for (row, g) in part.chunks_exact_mut(width).zip(&profile[(chunk * ROWS).min(vs.len())..]) {
                match self.path {
                    Path::Straight { by } => row.iter_mut().zip(us).for_each(|(p, u)| *p = *g + by * *u),
                    Path::Turn { about, axis, .. } => {
                        let arm = *g - about;
                        // What lies along the axis stays, the rest turns in its plane.
                        let still = axis * axis.dot(arm);
                        let (out_of, across) = (arm - still, axis.cross(arm));
                        let foot = about + still;
                        row.iter_mut().zip(&turns).for_each(|(p, t)| *p = foot + out_of * t.cos + across * t.sin);
                    }
                }
            }
        });
    }

    /// Jets of the tensor grid, u fastest.
    pub fn jets(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)], out: &mut Vec<Jet2>) {
        for &(v, side) in vs {
            let g = self.profile.jet(v, side);
            out.extend(us.iter().map(|&(u, _)| self.placed(&g, u)));
        }
    }

    /// The profile.
    pub fn profile(&self) -> &Rail {
        &self.profile
    }

    /// Bounds over a rectangle about `u`, the profile known over its interval.
    pub fn enclosure(&self, u: f64, half: (f64, f64), line: &Line) -> Enclosure {
        let mid = self.placed(&line.mid, u);
        let Path::Turn { about, axis, angle } = self.path else {
            return Enclosure::new(mid, half, [Interval3::default(), Interval3::default(), line.d2], None);
        };
        let reach = (half.0 * angle).abs();
        // W turned by up to ±reach: the middle one exactly, what the others differ by stays as long as it is.
        let turned = |middle: DVec3, others: Interval3, wanted: DVec3| {
            let off = (others + -middle).reach().max(0.0);
            let off = if middle == DVec3::ZERO && others == Interval3::default() { 0.0 } else { off };
            turn_range(wanted, axis, reach) + Interval3::around_zero(DVec3::splat(off))
        };
        let arms = line.p() + -about;
        let across = |w: Interval3| Interval3::at(axis).cross(&w);
        let middle = line.mid.p - about;
        let duu = turned(axis.cross(axis.cross(middle)), across(across(arms)), mid.duu / (angle * angle)) * (angle * angle);
        let duv = turned(axis.cross(line.mid.d1), across(line.d1), mid.duv / angle) * angle;
        let dvv = turned(line.mid.d2, line.d2, mid.dvv);
        Enclosure::new(mid, half, [duu, duv, dvv], Some([Interval3::ANY, turned(line.mid.d1, line.d1, mid.dv)]))
    }

    /// Interior parameters where the profile is less than analytic.
    pub fn breaks(&self) -> (Vec<f64>, Vec<f64>) {
        (Vec::new(), tidy(self.profile.chain().map(chain_breaks).unwrap_or_default(), EPSILON))
    }

    /// Interior kinks of the profile.
    pub fn cells(&self) -> (Vec<f64>, Vec<f64>) {
        match &self.profile {
            Rail::Chain { kinks, .. } => (Vec::new(), kinks.iter().map(|k| k.0).collect()),
            _ => (Vec::new(), Vec::new()),
        }
    }

    /// A box that holds the surface: of a turn, that of the whole cylinder about the axis.
    pub fn hull(&self) -> Box3 {
        let profile = self.profile.chain().map_or(Box3::EMPTY, Chain::bbox);
        match self.path {
            Path::Straight { by } => profile.union(Box3 { min: profile.min + by, max: profile.max + by }),
            Path::Turn { about, axis, .. } => {
                let corner = |k: u8| {
                    let pick = |bit: u8, low: f64, high: f64| if k & bit == 0 { low } else { high };
                    let (a, b) = (profile.min, profile.max);
                    DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z))
                };
                // Each corner sweeps a circle; along coordinate k it reaches √(1 − a_k²) of its radius.
                (0..8).map(corner).fold(Box3::EMPTY, |hull, p| {
                    let arm = p - about;
                    let foot = about + axis * axis.dot(arm);
                    let radius = p.distance(foot);
                    let reach = (DVec3::ONE - axis * axis).max(DVec3::ZERO) * radius * radius;
                    let reach = DVec3::new(reach.x.sqrt(), reach.y.sqrt(), reach.z.sqrt());
                    hull.with(foot - reach).with(foot + reach)
                })
            }
        }
    }

    /// The profile at a place of the path; `None` where it is no chain.
    pub fn profile_at(&self, u: f64) -> Option<Chain> {
        let motion = match self.path {
            Path::Straight { by } => Motion::translation(by * u),
            Path::Turn { about, axis, angle } => Motion::rotation(about, axis, Self::angle_at(angle, u)),
        };
        self.profile.chain().map(|chain| chain.moved(&motion))
    }

    /// The path of the profile's point at `v`: a straight line or an arc; E401 on the axis.
    pub fn path_at(&self, v: f64, origin: Origin, tolerance: &Tolerance) -> Result<Curve> {
        let p = self.profile.point(v);
        match self.path {
            Path::Straight { by } => line(p, p + by, origin),
            Path::Turn { about, axis, angle } => {
                let center = about + axis * axis.dot(p - about);
                let length = angle.abs() * p.distance(center);
                if length <= tolerance.point {
                    return Err(CurveFault::ZeroLength { of: origin, length, tolerance: tolerance.point }.into());
                }
                arc_center(center, p, angle, axis, origin)
            }
        }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let path = match self.path {
            Path::Straight { by } => Path::Straight { by: motion.vector(by) },
            Path::Turn { about, axis, angle } => Path::Turn {
                about: motion.point(about),
                axis: (motion.vector(axis) / motion.scale()).normalize(),
                // Seen in a mirror it turns the other way.
                angle: if motion.mirrors() { -angle } else { angle },
            },
        };
        Self { profile: self.profile.moved(motion), path }
    }
}
