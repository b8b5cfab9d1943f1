//! Second derivatives of a surface over the tiles of a rectangle of (u, v): bounds of many small triangles from few enclosures.

use glam::{DVec2, DVec3};

use crate::base::par;
use crate::base::range::Interval3;
use crate::surface::core::power_form::Bends;
use crate::surface::{Domain, Surface};

/// Tiles that the box of a triangle may reach over; larger ones have no bound.
const MAX_TILES_OF_BOX: usize = 9;

/// Bounds of ∂²/∂u², ∂²/∂u∂v and ∂²/∂v² over equal tiles, row by row; `None` where a tile has none.
pub struct BendTiles {
    low: DVec2,
    /// Tiles a unit of u, and of v.
    rate: DVec2,
    size: usize,
    tiles: Vec<Option<[Interval3; 3]>>,
}

impl BendTiles {
    /// `size × size` tiles of the rectangle between `low` and `high`, of which only what lies in the surface's parameters has bounds.
    pub fn new(surface: &Surface, (low, high): (DVec2, DVec2), size: usize) -> Self {
        let step = (high - low) / size as f64;
        // A trimmed face may run over the seam of the surface below.
        let inside = |a: f64, b: f64| surface.domain() != Domain::Loop || a >= 0.0 && b <= 1.0;
        let ends = |axis: usize, k: usize| {
            let (a, b) = (low[axis] + step[axis] * k as f64, low[axis] + step[axis] * (k + 1) as f64);
            inside(a, b).then(|| (a.clamp(0.0, 1.0), b.clamp(0.0, 1.0)))
        };
        let columns = par::map(size, |k| ends(0, k).map(|(a, b)| surface.strip_u(a, b)));
        let rows = par::map(size, |k| ends(1, k).map(|(a, b)| surface.strip_v(a, b)));
        let tiles = par::map(size * size, |k| {
            let enclosure = surface.spread_of(columns[k % size].as_ref()?, rows[k / size].as_ref()?);
            let second = [enclosure.duu, enclosure.duv, enclosure.dvv];
            (!second.iter().any(Interval3::is_unbounded)).then_some(second)
        });
        let rate = DVec2::new(1.0 / step.x, 1.0 / step.y);
        Self { low, rate, size, tiles }
    }

    /// Second derivatives along a unit vector over a box in the rectangle; `None` where they are not bounded, or the box is large.
    pub fn bends(&self, area: (DVec2, DVec2), along: DVec3) -> Option<Bends> {
        Some(along_normal(&self.over(area)?, along))
    }

    /// How long second derivatives may be over a box in the rectangle; `None` where they are not bounded, or the box is large.
    pub fn lengths(&self, area: (DVec2, DVec2)) -> Option<Bends> {
        Some(Bends { mid: [0.0; 3], slack: self.over(area)?.map(|range| range.reach()), jump: 0.0 })
    }

    fn over(&self, (low, high): (DVec2, DVec2)) -> Option<[Interval3; 3]> {
        let place = |at: DVec2| ((at - self.low) * self.rate).floor().clamp(DVec2::ZERO, DVec2::splat((self.size - 1) as f64));
        let (first, last) = (place(low), place(high));
        let count = last - first + DVec2::ONE;
        if !(first.is_finite() && last.is_finite() && count.x * count.y <= MAX_TILES_OF_BOX as f64) {
            return None;
        }
        let mut whole: Option<[Interval3; 3]> = None;
        for row in first.y as usize..=last.y as usize {
            for column in first.x as usize..=last.x as usize {
                let own = self.tiles[row * self.size + column]?;
                whole = Some(whole.map_or(own, |w| std::array::from_fn(|k| w[k].union(own[k]))));
            }
        }
        whole
    }
}

/// Second derivatives along a unit vector.
pub fn along_normal(second: &[Interval3; 3], normal: DVec3) -> Bends {
    let ranges = second.map(|r| r.along(normal));
    Bends { mid: ranges.map(|r| 0.5 * (r.low + r.high)), slack: ranges.map(|r| 0.5 * (r.high - r.low)), jump: 0.0 }
}
