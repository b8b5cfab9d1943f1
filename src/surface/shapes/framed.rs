//! The shape of a profile that moves with a frame: S(u, v) = M(u) + K(u)·(G(v) − M(0)).

use glam::{DMat3, DVec3};

use crate::base::bbox::Box3;
use crate::base::par;
use crate::base::tolerance::EPSILON;
use crate::geometry::{Jet, Motion};
use crate::network::Chain;
use crate::surface::data::breaks::tidy;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;
use crate::surface::rails::line::Line;
use crate::surface::rails::rail::Rail;
use crate::surface::shapes::matrices::{Matrices, MatrixJet, Over, times};

/// Rows of points made by one thread at a time.
const ROWS: usize = 16;

/// A profile moved along a path by a matrix that is known as polynomials (see [`Matrices`]).
#[derive(Clone, Debug)]
pub struct Framed {
    path: Rail,
    turn: Matrices,
    profile: Rail,
    foot: DVec3,
}

crate::content!(Framed { path, turn, profile, foot });

/// What is known between two values of u.
#[derive(Clone, Debug)]
pub struct FramedStrip {
    path: Line,
    middle: MatrixJet,
    over: Over,
}

impl Framed {
    /// A profile along a path; the matrix is the identity where the profile stands as it was given, at the path's start.
    pub fn new(path: Rail, turn: Matrices, profile: Rail) -> Self {
        let foot = path.point(0.0);
        Self { path, turn, profile, foot }
    }

    /// The profile.
    pub fn profile(&self) -> &Rail {
        &self.profile
    }

    fn placed(&self, m: &Jet, [k, k1, k2]: &MatrixJet, g: &Jet) -> Jet2 {
        let arm = g.p - self.foot;
        Jet2 { p: m.p + *k * arm, du: m.d1 + *k1 * arm, dv: *k * g.d1, duu: m.d2 + *k2 * arm, duv: *k1 * g.d1, dvv: *k * g.d2 }
    }

    /// Point and derivatives, from the given sides where they jump.
    pub fn jet(&self, u: f64, v: f64, side: (OneSided, OneSided)) -> Jet2 {
        self.placed(&self.path.jet(u, side.0), &self.turn.at(u, side.0), &self.profile.jet(v, side.1))
    }

    /// Where a point of the profile, with its derivatives, lies.
    pub fn jet_of(&self, g: &Jet, u: f64, side: OneSided) -> Jet2 {
        self.placed(&self.path.jet(u, side), &self.turn.at(u, side), g)
    }

    /// What is known between two values of u, one strip for each formula.
    pub fn between(&self, u0: f64, u1: f64) -> Vec<FramedStrip> {
        let inner = self.turn.stops().iter().copied().filter(|x| *x > u0 + EPSILON && *x < u1 - EPSILON);
        let stops: Vec<f64> = std::iter::once(u0).chain(inner).chain(std::iter::once(u1)).collect();
        stops.windows(2).map(|w| self.strip((w[0], w[1]))).collect()
    }

    /// The path of a profile that does not turn, and where on it the profile was given.
    pub fn translation(&self) -> Option<(&Rail, DVec3)> {
        self.turn.is_identity().then_some((&self.path, self.foot))
    }

    /// How much longer a vector may become on its way, at most.
    pub fn largest_scale(&self) -> f64 {
        self.turn.reach()
    }

    /// Points of the tensor grid, u fastest: path and frame are evaluated once per column, the profile once per row.
    pub fn grid(&self, us: &[f64], vs: &[f64], out: &mut [DVec3]) {
        let (profile, path) = (self.profile.points(vs), self.path.points(us));
        let turns: Vec<DMat3> = us.iter().map(|&u| self.turn.at(u, OneSided::After)[0]).collect();
        let width = us.len().max(1);
        par::chunks_mut(out, width * ROWS, |chunk, part| {
            for (row, g) in part.chunks_exact_mut(width).zip(&profile[(chunk * ROWS).min(vs.len())..]) {
                let arm = *g - self.foot;
                row.iter_mut().zip(&path).zip(&turns).for_each(|((p, m), k)| *p = *m + *k * arm);
            }
        });
    }

    /// Jets of the tensor grid, u fastest.
    pub fn jets(&self, us: &[(f64, OneSided)], vs: &[(f64, OneSided)], out: &mut Vec<Jet2>) {
        let columns: Vec<(Jet, MatrixJet)> = us.iter().map(|&(u, side)| (self.path.jet(u, side), self.turn.at(u, side))).collect();
        for &(v, side) in vs {
            let g = self.profile.jet(v, side);
            out.extend(columns.iter().map(|(m, k)| self.placed(m, k, &g)));
        }
    }

    /// Inner values of u where the formula changes, and whether one of those between two values is a corner of the path.
    pub fn changes(&self, u0: f64, u1: f64) -> (Vec<f64>, bool) {
        let corner = matches!(&self.path, Rail::Chain { kinks, .. } if kinks.iter().any(|k| u0 < k.0 && k.0 < u1));
        (self.turn.stops().to_vec(), corner)
    }

    /// What depends on u alone, between two values with one formula.
    pub fn strip(&self, (u0, u1): (f64, f64)) -> FramedStrip {
        let middle = self.turn.at(0.5 * (u0 + u1), OneSided::After);
        FramedStrip { path: self.path.line(u0, u1), middle, over: self.turn.over((u0, u1)) }
    }

    /// Bounds over the rectangle of a strip and an interval of the profile.
    pub fn enclosure(&self, strip: &FramedStrip, half: (f64, f64), line: &Line) -> Enclosure {
        let [k, k1, k2] = &strip.middle;
        let (arm, arms) = (line.mid.p - self.foot, line.p() + -self.foot);
        let m = &strip.path;
        let second = [
            m.d2 + times(&strip.over[2], k2, &arms, arm),
            times(&strip.over[1], k1, &line.d1, line.mid.d1),
            times(&strip.over[0], k, &line.d2, line.mid.d2),
        ];
        let first = [m.d1 + times(&strip.over[1], k1, &arms, arm), times(&strip.over[0], k, &line.d1, line.mid.d1)];
        Enclosure::new(self.placed(&m.mid, &strip.middle, &line.mid), half, second, Some(first))
    }

    /// Interior parameters where the shape is less than analytic.
    pub fn breaks(&self) -> (Vec<f64>, Vec<f64>) {
        let of = |rail: &Rail| {
            let mut all = Vec::new();
            rail.breaks(&mut all);
            tidy(all, EPSILON)
        };
        (of(&self.path), of(&self.profile))
    }

    /// Corners of the path and of the profile.
    pub fn cells(&self) -> (Vec<f64>, Vec<f64>) {
        let of = |rail: &Rail| match rail {
            Rail::Chain { kinks, .. } => kinks.iter().map(|k| k.0).collect(),
            _ => Vec::new(),
        };
        (of(&self.path), of(&self.profile))
    }

    /// A box that holds the surface: that of the path, as much wider as the profile reaches.
    pub fn hull(&self) -> Box3 {
        let path = self.path.chain().map_or(Box3::of([self.foot]), Chain::bbox);
        let profile = self.profile.chain().map_or(Box3::of([self.profile.point(0.0)]), Chain::bbox);
        let far = (profile.max - self.foot).abs().max((profile.min - self.foot).abs()).length();
        let reach = DVec3::splat(far * self.turn.reach());
        Box3 { min: path.min - reach, max: path.max + reach }
    }

    /// Carried by a motion.
    pub fn moved(&self, motion: &Motion) -> Self {
        let linear = DMat3::from_cols(motion.vector(DVec3::X), motion.vector(DVec3::Y), motion.vector(DVec3::Z));
        Self {
            path: self.path.moved(motion),
            turn: self.turn.conjugated(linear),
            profile: self.profile.moved(motion),
            foot: motion.point(self.foot),
        }
    }
}
