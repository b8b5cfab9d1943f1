//! Which cells are cut, across which direction and in how many parts: those longer than allowed, and those whose better
//! halving breaks a limit.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::chart::parametric_surface::ParametricSurface;
use crate::mesh::request::decider::Why;
use crate::mesh::request::work::allow;
use crate::mesh::tri::isoline::Cut;
use crate::mesh::tri::isoline_mesh::{Failure, IsolineMesher, IsolineResult};
use crate::mesh::tri::limit_table::{self, ChartTriangle};
use crate::mesh::tri::marks::corners;
use crate::mesh::tri::no_mesh::NoMesh;
use crate::mesh::tri::placement_settings::ISOLINES;
use crate::mesh::tri::tree::Class;
use crate::surface::{Domain, Side};

impl IsolineMesher<'_> {
    /// Cuts leaves, and theirs, until each is no longer than allowed and keeps the limits by itself.
    pub(crate) fn settle(&mut self, mut open: Vec<u32>) -> IsolineResult<()> {
        let (across, along) = self.input.chart.surface().curves_of_a_point();
        let of_curves = (1 + (across + along) / ISOLINES.curves_per_cut_work) as u64;
        while let Some(k) = open.pop() {
            job::poll();
            if self.cells.n_whole() > self.input.most || self.cells.all().len() > 8 * self.input.most {
                return Err(Failure::NoMesh(NoMesh::TooManyNodes));
            }
            if self.cells.all()[k as usize].class == Class::Exterior {
                continue;
            }
            if let Some((cut, why)) = self.demand(k)? {
                let first = self.cells.all().len() as u32;
                let (generous, usual) = ISOLINES.cut_work;
                let work = if (first as usize) < ISOLINES.first_cells { generous } else { usual };
                allow(work * of_curves, &mut 0);
                self.cells.split(k, cut, why);
                open.extend([first + 1, first]);
            }
        }
        Ok(())
    }

    /// Cuts leaves across directions.
    pub(crate) fn cut(&mut self, bad: Vec<(u32, Cut)>) -> IsolineResult<()> {
        let mut open = Vec::new();
        for (k, cut) in bad {
            job::poll();
            let first = self.cells.all().len() as u32;
            self.cells.split(k, cut, Why::Bends);
            self.fillings.remove(&k);
            open.extend([first, first + 1]);
        }
        self.settle(open)
    }

    /// Whether a leaf has to be cut, across which direction, and why.
    fn demand(&mut self, k: u32) -> IsolineResult<Option<(Cut, Why)>> {
        if let Some(axis) = self.cells.kinked(k) {
            return Ok(Some((Cut { axis, parts: 2 }, Why::Bends)));
        }
        let cell = &self.cells.all()[k as usize];
        let (low, high) = (cell.low, cell.high);
        if let Some(axis) = self.overlong(k) {
            return Ok(Some((Cut { axis, parts: 2 }, Why::Bends)));
        }
        let lengths = self.lengths(low, high);
        let longer = usize::from(lengths.y > lengths.x);
        let (most, why) = self.allowed(low, high, lengths);
        if lengths[longer] > most * (1.0 + WHOLE_NUMBER) && self.cells.divisible(k, longer) {
            let parts = (lengths[longer] / most).ceil().clamp(2.0, ISOLINES.max_parts) as u32;
            return Ok(Some((Cut { axis: longer, parts }, why)));
        }
        if self.input.limits.chord.is_none() && self.input.limits.angle.is_none() {
            return Ok(None);
        }
        let ratio = self.ratio(low, high);
        if ratio <= 1.0 {
            return Ok(None);
        }
        self.floor(lengths[longer], ratio, low)?;
        Ok(self.best_cut(k, (low, high)).map(|cut| (cut, Why::Bends)))
    }

    /// The direction in which a leaf goes so far round a surface that closes, or from pole to pole, that nodes on its two sides
    /// would have more than one edge between them.
    fn overlong(&self, k: u32) -> Option<usize> {
        let surface = self.input.chart.surface();
        let width = self.cells.all()[k as usize].width();
        let pole = |side: usize| surface.domain() == Domain::Square && matches!(surface.side(side), Side::Pole(_));
        let most = |closed: bool, poles: bool| {
            if closed {
                ISOLINES.max_closed_share
            } else if poles {
                ISOLINES.max_pole_share
            } else {
                f64::INFINITY
            }
        };
        let (u, v) = surface.closed();
        let most = [most(u, pole(1) && pole(3)), most(v, pole(0) && pole(2))];
        (0..2).find(|axis| width[*axis] > most[*axis] && self.cells.divisible(k, *axis))
    }

    /// How long the sides of a box may be, and by which clause.
    fn allowed(&mut self, low: DVec2, high: DVec2, lengths: DVec2) -> (f64, Why) {
        let (rules, size) = (self.input.rules, self.input.size);
        if rules.is_empty() {
            return (size, Why::Size);
        }
        // Lengths change by the slope: the demand at the middle bounds the demand all over the box.
        let reach = rules.steepest() * 0.5 * lengths.length();
        let p = self.point(0.5 * (low + high));
        match rules.who(p, size + reach) {
            Some(least) => ((least.size - reach).max(rules.least()), Why::Refined(rules.items()[least.item as usize].tag as usize)),
            None => (size, Why::Size),
        }
    }

    /// Lengths of a box along u and v.
    pub(crate) fn lengths(&mut self, low: DVec2, high: DVec2) -> DVec2 {
        let share = |k: usize| k as f64 / ISOLINES.side_pieces as f64;
        let mut longest = DVec2::ZERO;
        for axis in 0..2 {
            for other in [0.0, 0.5, 1.0] {
                let mut at = low + (high - low) * other;
                let mut length = 0.0;
                let mut last = None;
                for k in 0..=ISOLINES.side_pieces {
                    at[axis] = low[axis] + (high[axis] - low[axis]) * share(k);
                    let p = self.input.chart.spot(self.place(at)).p;
                    length += last.map_or(0.0, |last: DVec3| last.distance(p));
                    last = Some(p);
                }
                longest[axis] = longest[axis].max(length);
            }
        }
        longest
    }

    fn floor(&mut self, longest: f64, ratio: f64, at: DVec2) -> IsolineResult<()> {
        if longest > self.input.floor {
            return Ok(());
        }
        Err(Failure::Floor(self.input.floor / ratio.sqrt(), self.point(at)))
    }

    /// The better cut of a leaf for a box in it.
    ///
    /// With errors A and B along the two directions alone, A / n² + B / m² ≤ 1 takes the fewest cells where both are alike.
    pub(crate) fn best_cut(&mut self, k: u32, (low, high): (DVec2, DVec2)) -> Option<Cut> {
        let own = [0, 1].map(|axis| self.ratio_along((low, high), axis));
        let lengths = self.lengths(low, high);
        let worse = if own[0] == own[1] { usize::from(lengths.y > lengths.x) } else { usize::from(own[1] > own[0]) };
        let axis = [worse, 1 - worse].into_iter().find(|axis| self.cells.divisible(k, *axis))?;
        let left = (1.0 - own[1 - axis]).max(0.5);
        let parts = (own[axis] / left).sqrt().ceil();
        Some(Cut { axis, parts: if parts.is_finite() { parts.clamp(2.0, ISOLINES.max_parts) as u32 } else { 2 } })
    }

    /// The direction across which a leaf in the box of a triangle over the limits is cut: the one with the larger
    /// error, except for leaves that are thin in it already, where nodes have to come nearer from the other side.
    pub(crate) fn towards(&mut self, k: u32, (low, high): (DVec2, DVec2)) -> Option<usize> {
        let cell = &self.cells.all()[k as usize];
        let share = cell.width() / (high - low);
        let own = [0, 1].map(|axis| self.ratio_along((low, high), axis));
        let worse = usize::from(own[1] > own[0]);
        let first = if share[worse] >= ISOLINES.min_leaf_width || share[worse] >= share[1 - worse] { worse } else { 1 - worse };
        [first, 1 - first].into_iter().find(|axis| self.cells.divisible(k, *axis))
    }

    /// The worst ratio of narrow strips of a box along one direction.
    fn ratio_along(&mut self, (low, high): (DVec2, DVec2), axis: usize) -> f64 {
        let other = 1 - axis;
        let width = (high[other] - low[other]) * ISOLINES.strip_width;
        let mut worst = 0.0_f64;
        for share in [0.0, 0.5, 1.0] {
            let (mut from, mut to) = (low, high);
            from[other] = low[other] + (high[other] - low[other] - width) * share;
            to[other] = from[other] + width;
            worst = worst.max(self.ratio(from, to));
        }
        worst
    }

    /// The worst ratio of a box halved by its better diagonal.
    fn ratio(&mut self, low: DVec2, high: DVec2) -> f64 {
        let at = corners((low, high));
        let p = at.map(|at| self.point(at));
        let xy = at.map(|at| self.place(at));
        let one = |c: [usize; 3]| {
            let triangle = ChartTriangle { xy: c.map(|k| xy[k]), p: c.map(|k| p[k]) };
            limit_table::ratio_of(self.input.chart, triangle, self.input.limits).worst()
        };
        let first = one([0, 1, 2]).max(one([0, 2, 3]));
        if first <= 1.0 { first } else { first.min(one([0, 1, 3]).max(one([1, 2, 3]))) }
    }
}
