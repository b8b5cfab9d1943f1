//! One surface of several that follow one another: how it lies in their x and y, and the feet of points on its lines of constant x.

use glam::DVec3;

use crate::base::digest::{StableHash, StableHasher};
use crate::base::range::Interval3;
use crate::base::tolerance::SLIVER;
use crate::surface::core::joined::PLACES;
use crate::surface::core::surface::Surface;
use crate::surface::data::enclosure::Enclosure;
use crate::surface::data::jet::Jet2;
use crate::surface::data::one_sided::OneSided;

/// Newton steps.
const STEPS: usize = 16;

pub(super) type SidePair = (OneSided, OneSided);

/// How the unit square of a surface lies in that of x and y.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turn {
    /// x runs along v.
    pub swap: bool,
    /// x runs backwards.
    pub back_x: bool,
    /// y runs backwards.
    pub back_y: bool,
}

impl StableHash for Turn {
    fn hash_into(&self, to: &mut StableHasher) {
        (self.swap, self.back_x, self.back_y).hash_into(to);
    }
}

fn backwards(back: bool, x: f64) -> f64 {
    if back { 1.0 - x } else { x }
}

impl Turn {
    /// (u, v) of a place.
    pub fn place(self, x: f64, y: f64) -> (f64, f64) {
        let (x, y) = (backwards(self.back_x, x), backwards(self.back_y, y));
        if self.swap { (y, x) } else { (x, y) }
    }

    fn sides(self, (x, y): SidePair) -> SidePair {
        let turned = |side: OneSided, back: bool| if back { side.turned() } else { side };
        let (x, y) = (turned(x, self.back_x), turned(y, self.back_y));
        if self.swap { (y, x) } else { (x, y) }
    }

    /// The side (v = 0, u = 1, v = 1, u = 0) that is y = 0, x = 1, y = 1 or x = 0.
    pub fn side(self, k: usize) -> usize {
        let k = match (k % 2 == 1, self.back_x, self.back_y) {
            (true, true, _) | (false, _, true) => (k + 2) % 4,
            _ => k,
        };
        if self.swap { 3 - k } else { k }
    }

    fn jet(self, jet: Jet2) -> Jet2 {
        let (x, y) = (if self.back_x { -1.0 } else { 1.0 }, if self.back_y { -1.0 } else { 1.0 });
        let j = if self.swap { Jet2 { du: jet.dv, dv: jet.du, duu: jet.dvv, dvv: jet.duu, ..jet } } else { jet };
        Jet2 { du: j.du * x, dv: j.dv * y, duv: j.duv * (x * y), ..j }
    }

    fn enclosure(self, s: Enclosure) -> Enclosure {
        let s = if self.swap { Enclosure { du: s.dv, dv: s.du, duu: s.dvv, dvv: s.duu, half: (s.half.1, s.half.0), ..s } } else { s };
        let sign = |r: Interval3, back: bool| if back { -r } else { r };
        Enclosure { du: sign(s.du, self.back_x), dv: sign(s.dv, self.back_y), duv: sign(s.duv, self.back_x != self.back_y), ..s }
    }
}

/// One of several surfaces that follow one another.
#[derive(Clone, Debug)]
pub struct JoinedPiece {
    /// The surface, of a square.
    pub surface: Surface,
    /// How it lies.
    pub turn: Turn,
    /// Its place in the order in which they were given.
    pub given: usize,
    /// Of a piece that closes in y: its y, turned, where y is 0. Its seam lies elsewhere than that of all then.
    pub shift: f64,
    /// Its y at even steps of the y of the one before; empty where both are one.
    pub(super) follow: Vec<f64>,
}

crate::content!(JoinedPiece { surface, turn, given, shift, follow });

impl JoinedPiece {
    /// A surface that lies so, its own y not yet found.
    pub fn new(surface: Surface, turn: Turn, given: usize) -> Self {
        Self { surface, turn, given, shift: 0.0, follow: Vec::new() }
    }

    /// Begins y where the border x = `x` is nearest to a point. Of pieces that close in y.
    pub fn begin_at(&mut self, x: f64, p: DVec3) {
        let far = |w: f64| self.jet(x, w, (OneSided::After, OneSided::After)).p.distance_squared(p);
        let even = |n: usize| n as f64 / (4 * PLACES) as f64;
        let start = (0..4 * PLACES).min_by(|a, b| far(even(*a)).total_cmp(&far(even(*b)))).map_or(0.0, even);
        let w = foot_round(self, x, start, p);
        self.shift = if (SLIVER..=1.0 - SLIVER).contains(&w) { w } else { 0.0 };
    }

    /// Where its seam lies in y; none where y begins there.
    pub fn seam(&self) -> Option<f64> {
        (self.shift > 0.0).then_some(1.0 - self.shift)
    }

    /// Its own y, turned, at a y; at its seam the one on a side of it.
    fn around(&self, y: f64, side: OneSided) -> f64 {
        let Some(seam) = self.seam() else { return y };
        if y > seam || y == seam && side == OneSided::After { y - seam } else { y + self.shift }
    }

    /// Point and derivatives with respect to its own x and y.
    pub fn jet(&self, x: f64, y: f64, sides: SidePair) -> Jet2 {
        // At its ends, which may be inside the surface, it is known from inside.
        let side = if y >= 1.0 {
            OneSided::Before
        } else if y <= 0.0 {
            OneSided::After
        } else {
            sides.1
        };
        let (y, sides) = (self.around(y, side), (sides.0, side));
        let (u, v) = self.turn.place(x, y);
        self.turn.jet(self.surface.jet_one_sided(u, v, self.turn.sides(sides)))
    }

    /// Bounds over a rectangle whose y has the seam beside it at most.
    pub(super) fn enclosure(&self, x: (f64, f64), y: (f64, f64)) -> Enclosure {
        let after = self.seam().is_some_and(|seam| 0.5 * (y.0 + y.1) > seam);
        let own = |y: f64| match self.seam() {
            None => y,
            Some(seam) if after => (y - seam).max(0.0),
            Some(_) => (y + self.shift).min(1.0),
        };
        let y = (own(y.0), own(y.1));
        let (a, b) = (self.turn.place(x.0, y.0), self.turn.place(x.1, y.1));
        let order = |a: f64, b: f64| (a.min(b), a.max(b));
        self.turn.enclosure(self.surface.enclosure(order(a.0, b.0), order(a.1, b.1)))
    }

    /// Inner values of x and of y from those of u and v.
    pub(super) fn lines(&self, (us, vs): (Vec<f64>, Vec<f64>)) -> (Vec<f64>, Vec<f64>) {
        let (xs, ys) = if self.turn.swap { (vs, us) } else { (us, vs) };
        let each = |list: Vec<f64>, back: bool| list.into_iter().map(|x| backwards(back, x)).collect();
        let from_start = |y: f64| if y < self.shift { y + 1.0 - self.shift } else { y - self.shift };
        let ys: Vec<f64> = each(ys, self.turn.back_y);
        (each(xs, self.turn.back_x), ys.into_iter().map(from_start).collect())
    }
}

/// The y near a guess where the first border of a piece is nearest to a point.
pub fn foot(piece: &JoinedPiece, guess: f64, p: DVec3) -> f64 {
    foot_on(piece, 0.0, guess, p)
}

/// The same of the line of constant x of a piece that closes in y: beside its seam the foot may be on either side of it.
pub fn foot_round(piece: &JoinedPiece, x: f64, guess: f64, p: DVec3) -> f64 {
    let starts = if guess <= 0.0 || guess >= 1.0 { vec![0.0, 1.0] } else { vec![guess] };
    let far = |w: &f64| piece.jet(x, *w, (OneSided::After, OneSided::After)).p.distance_squared(p);
    let feet = starts.into_iter().map(|start| foot_on(piece, x, start, p));
    feet.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(guess)
}

/// The y near a guess where the line of constant x is nearest to a point.
fn foot_on(piece: &JoinedPiece, x: f64, guess: f64, p: DVec3) -> f64 {
    let mut w = guess;
    for _ in 0..STEPS {
        let jet = piece.jet(x, w, (OneSided::After, OneSided::After));
        let off = jet.p - p;
        let bend = jet.dv.length_squared() + off.dot(jet.dvv);
        let square = jet.dv.length_squared();
        if square <= 0.0 {
            break;
        }
        let step = off.dot(jet.dv) / if bend > 0.0 { bend } else { square };
        let next = (w - step).clamp(0.0, 1.0);
        let still = (next - w).abs() <= f64::EPSILON;
        w = next;
        if still {
            break;
        }
    }
    w
}
