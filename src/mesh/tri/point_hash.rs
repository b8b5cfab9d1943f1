//! Points by place: a hash of cubes whose side fits the wanted edge length there.

use glam::{DVec2, DVec3};

use crate::mesh::chart::parametric_surface::Spot;

const NONE: u32 = u32::MAX;
/// Levels kept apart: sizes from 2^-LEVELS/2 to 2^LEVELS/2 of the unit.
const LEVELS: i32 = 64;

/// Which way a surface faces at a point, roughly; all ways on a plane and at a pole.
///
/// Points that are near each other in space and face opposite ways lie on the two sides of a fold, and far from each other on the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Facing([i8; 3]);

impl Facing {
    /// Digits of a unit vector.
    const UNIT: f64 = 100.0;
    /// Cosine of the angle between normals from which on they are opposite: 120°. Nodes on the bend itself are near those on both sides.
    const OPPOSITE: f64 = -0.5;

    /// By the unit normal, or zero.
    pub fn of(normal: DVec3) -> Self {
        Self((normal * Self::UNIT).to_array().map(|c| c.round() as i8))
    }

    /// Whether two points lie on the two sides of a fold.
    pub fn is_opposite(self, other: Self) -> bool {
        const LEAST: i32 = (Facing::OPPOSITE * Facing::UNIT * Facing::UNIT) as i32;
        let [x, y, z] = [0, 1, 2].map(|k| i32::from(self.0[k]) * i32::from(other.0[k]));
        x + y + z < LEAST
    }
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfacePoint {
    /// Where.
    pub p: DVec3,
    /// Its place in the chart.
    pub xy: DVec2,
    /// Which way the surface faces.
    pub facing: Facing,
}

impl SurfacePoint {
    /// Longest way in the chart between points that are near each other, over their largest distance in space: half round a tube it is the
    /// quarter of the length of a circle over its radius.
    const MAX_WAY: f64 = 1.6;

    /// A point of a surface that is folded, or of one whose points face all ways.
    pub fn new(xy: DVec2, spot: &Spot, is_folded: bool) -> Self {
        Self { p: spot.p, xy, facing: if is_folded { Facing::of(spot.normal()) } else { Facing::default() } }
    }

    /// Whether a point that is nearer in space than `reach` lies on the other side of a fold.
    fn is_beyond_fold(&self, other: &Self, reach: f64) -> bool {
        self.facing.is_opposite(other.facing) && self.xy.distance_squared(other.xy) > Self::MAX_WAY * Self::MAX_WAY * reach * reach
    }
}

/// A point of the hash.
#[derive(Clone, Copy, Debug)]
pub struct HashedPoint {
    /// The point.
    pub at: SurfacePoint,
    /// A number of the caller.
    pub tag: u32,
    next: u32,
    level: i32,
}

/// Points in cubes of side 2^level × unit.
///
/// A point is stored at the level of its size and those of twice and half of it, so that a query reads one level.
#[derive(Clone, Debug)]
pub struct PointHash {
    unit: f64,
    head: Vec<u32>,
    entries: Vec<HashedPoint>,
    /// Points may be of several sizes.
    mixed: bool,
}

impl PointHash {
    /// An empty hash; `unit` is a typical size, `mixed` says that there may be others.
    pub fn new(unit: f64, mixed: bool) -> Self {
        Self { unit, head: vec![NONE; 1 << 10], entries: Vec::new(), mixed }
    }

    /// The cube's side is between once and twice the size.
    #[inline]
    fn level(&self, size: f64) -> i32 {
        let exponent = ((size / self.unit).to_bits() >> 52 & 0x7ff) as i32 - 1022;
        exponent.clamp(-LEVELS / 2, LEVELS / 2 - 1)
    }

    #[inline]
    fn side(&self, level: i32) -> f64 {
        self.unit * f64::from_bits(((level + 1023) as u64) << 52)
    }

    #[inline]
    fn slot(&self, level: i32, cell: [i64; 3]) -> usize {
        let mut h = (level as i64 as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        for c in cell {
            h = (h ^ (c >> 1) as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
            h ^= h >> 32;
        }
        // Eight neighbours lie in one place of memory.
        let own = (cell[0] & 1) | (cell[1] & 1) << 1 | (cell[2] & 1) << 2;
        (h << 3 | own as u64) as usize & (self.head.len() - 1)
    }

    /// Adds a point of a size.
    pub fn add(&mut self, at: SurfacePoint, size: f64, tag: u32) {
        let middle = self.level(size);
        let beside = i32::from(self.mixed);
        for level in middle - beside..=middle + beside {
            if self.entries.len() >= self.head.len() {
                self.grow();
            }
            let slot = self.home(at.p, level);
            self.entries.push(HashedPoint { at, tag, next: self.head[slot], level });
            self.head[slot] = self.entries.len() as u32 - 1;
        }
    }

    fn home(&self, p: DVec3, level: i32) -> usize {
        let inv = 1.0 / self.side(level);
        self.slot(level, [p.x, p.y, p.z].map(|c| (c * inv).floor() as i64))
    }

    fn grow(&mut self) {
        self.head = vec![NONE; self.head.len() * 4];
        for k in 0..self.entries.len() {
            let slot = self.home(self.entries[k].at.p, self.entries[k].level);
            self.entries[k].next = std::mem::replace(&mut self.head[slot], k as u32);
        }
    }

    /// Whether a point nearer than `reach` on the same side of a fold is in the cube of a place: a fast test that is sufficient most often.
    pub fn beside(&self, place: SurfacePoint, reach: f64, size: f64) -> bool {
        let level = self.level(size);
        let mut at = self.head[self.home(place.p, level)];
        while at != NONE {
            let e = &self.entries[at as usize];
            if e.level == level && e.at.p.distance_squared(place.p) < reach * reach && !e.at.is_beyond_fold(&place, reach) {
                return true;
            }
            at = e.next;
        }
        false
    }

    /// Calls `visit` with the points nearer than `reach` on the same side of a fold and the square of their distance, of sizes within a
    /// factor of two or so of `size`; stops when it returns `true`; whether it did.
    pub fn any(&self, place: SurfacePoint, reach: f64, size: f64, mut visit: impl FnMut(&HashedPoint, f64) -> bool) -> bool {
        let level = self.level(size);
        let square = reach * reach;
        let inv = 1.0 / self.side(level);
        let p = place.p;
        let (low, high) = (((p - reach) * inv).floor(), ((p + reach) * inv).floor());
        for z in low.z as i64..=high.z as i64 {
            for y in low.y as i64..=high.y as i64 {
                for x in low.x as i64..=high.x as i64 {
                    let mut at = self.head[self.slot(level, [x, y, z])];
                    while at != NONE {
                        let e = &self.entries[at as usize];
                        // Other levels may share the slot; each has its own entry of the point.
                        let d = e.at.p.distance_squared(p);
                        if e.level == level && d < square && !e.at.is_beyond_fold(&place, reach) && visit(e, d) {
                            return true;
                        }
                        at = e.next;
                    }
                }
            }
        }
        false
    }
}
