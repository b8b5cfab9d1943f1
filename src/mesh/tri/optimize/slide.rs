//! Border nodes that slide along their segments to where the triangles beside them are better, once nothing else helps.

use glam::{DVec2, DVec3};

use crate::mesh::chart::outline::area2;
use crate::mesh::tri::optimize::MeshOptimizer;
use crate::mesh::tri::optimize::failed_repairs::FailedRepairs;
use crate::mesh::tri::optimize_settings::SLIDE;
use crate::mesh::tri::pending::Pending;
use crate::mesh::tri::shape::quality;
use crate::mesh::tri::sliding_border::SlidingBorder;

/// A border node at a fraction of its segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlidPlace {
    pub(crate) fraction: f64,
    pub(crate) xy: DVec2,
    pub(crate) p: DVec3,
    /// The least quality of its triangles, lowered where a side inside is too long; −1 where one is turned over.
    pub(crate) worst: f64,
}

impl<'a> MeshOptimizer<'a> {
    /// Lets border nodes slide.
    pub(crate) fn slide_on(&mut self, border: &'a SlidingBorder<'a>) {
        self.triangulation.along = border.start();
        self.sliding = Some(border);
    }

    /// Whether border nodes may slide and some triangle is so bad that they would.
    pub(crate) fn wants_sliding(&self) -> bool {
        let triangulation = &self.triangulation;
        let is_bad = |t: u32| triangulation.alive(t) && triangulation.shape(triangulation.tri[t as usize]) < SLIDE.min_quality;
        self.sliding.is_some() && (0..triangulation.tri.len() as u32).any(is_bad)
    }

    /// Lets nodes slide from now on, with everything that failed without to be tried again.
    pub(crate) fn start_sliding(&mut self) {
        self.may_slide = true;
        (self.failed_repairs, self.failed_searches) = (FailedRepairs::default(), FailedRepairs::default());
        self.changed = Pending::all(self.triangulation.p.len());
    }

    /// The largest cosine of an angle.
    pub(crate) fn sharpest(&self) -> f64 {
        let triangulation = &self.triangulation;
        let of = |t: u32| {
            let [a, b, c] = triangulation.tri[t as usize].map(|n| triangulation.p[n as usize]);
            let at = |o: DVec3, p: DVec3, q: DVec3| (p - o).normalize_or_zero().dot((q - o).normalize_or_zero());
            at(a, b, c).max(at(b, c, a)).max(at(c, a, b))
        };
        (0..triangulation.tri.len() as u32).filter(|t| triangulation.alive(*t)).map(of).fold(-1.0, f64::max)
    }

    /// Whether a node may slide along the border.
    pub(crate) fn slides(&self, node: u32) -> bool {
        self.sliding.is_some_and(|border| border.slides(node))
    }

    /// Slides a border node to where its worst triangle is best; whether that is better by more than a gain.
    pub(crate) fn slide(&mut self, node: u32) -> bool {
        let Some((before, best)) = self.best_slide(node) else { return false };
        if best.worst <= before.worst + self.min_gain(before.worst) || !self.keeps_border(node, best.fraction) {
            return false;
        }
        self.place_slid(node, &best);
        true
    }

    /// The place of a border node now, and where its worst triangle is best whatever the limits, found by golden sections: along a straight border the quality of a
    /// triangle rises up to one place and falls from there on, and so does the least of several.
    pub(crate) fn best_slide(&mut self, node: u32) -> Option<(SlidPlace, SlidPlace)> {
        let border = self.sliding.filter(|border| border.slides(node))?;
        let (mut low, mut high) = border.range(node, &self.triangulation.along)?;
        self.triangulation.ring(node, &mut self.ring);
        let (first, last) = (*self.ring.node.first()?, *self.ring.node.last()?);
        let beside = border.neighbours(node)?;
        if self.ring.closed || beside != [first, last] && beside != [last, first] {
            return None;
        }
        let fraction = self.triangulation.along[node as usize];
        let at = |fraction: f64| {
            let (xy, p) = border.place(node, fraction)?;
            Some(SlidPlace { fraction, xy, p, worst: self.worst_of_fan(xy, p) })
        };
        let (xy, p) = (self.triangulation.xy[node as usize], self.triangulation.p[node as usize]);
        let before = SlidPlace { fraction, xy, p, worst: self.worst_of_fan(xy, p) };
        let inner = |low: f64, high: f64| high - (high - low) * SLIDE.section;
        let (mut left, mut right) = (at(inner(low, high))?, at(low + high - inner(low, high))?);
        for _ in 0..SLIDE.sections {
            if left.worst >= right.worst {
                high = right.fraction;
                right = left;
                left = at(inner(low, high))?;
            } else {
                low = left.fraction;
                left = right;
                right = at(low + high - inner(low, high))?;
            }
        }
        let best = if left.worst >= right.worst { left } else { right };
        Some((before, best))
    }

    /// The place on the way from one to another.
    pub(crate) fn part_of_slide(&self, node: u32, from: &SlidPlace, to: &SlidPlace, share: f64) -> Option<SlidPlace> {
        let border = self.sliding?;
        let fraction = from.fraction + (to.fraction - from.fraction) * share;
        let (xy, p) = border.place(node, fraction)?;
        let worst = self.worst_of_fan(xy, p);
        (worst > 0.0 && self.keeps_border(node, fraction)).then_some(SlidPlace { fraction, xy, p, worst })
    }

    /// Whether the steps beside a border node keep the limits with the node at a fraction.
    fn keeps_border(&self, node: u32, fraction: f64) -> bool {
        self.sliding.is_some_and(|border| border.keeps(node, &self.triangulation.along, fraction))
    }

    /// Puts a border node where it slid to.
    pub(crate) fn place_slid(&mut self, node: u32, to: &SlidPlace) {
        self.triangulation.along[node as usize] = to.fraction;
        self.place(node, to.xy, to.p);
    }

    /// The least quality of the triangles in the ring of a border node with the node at a place, lowered where a side to a free node is too long.
    fn worst_of_fan(&self, xy: DVec2, p: DVec3) -> f64 {
        let triangulation = &self.triangulation;
        let share = |n: u32| {
            let longest = triangulation.size[n as usize] * self.settings.max_length_ratio;
            if triangulation.is_free(n) { (longest / p.distance(triangulation.p[n as usize])).min(1.0) } else { 1.0 }
        };
        let mut worst = f64::INFINITY;
        for pair in self.ring.node.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if area2(xy, triangulation.xy[a as usize], triangulation.xy[b as usize]) <= 0.0 {
                return -1.0;
            }
            worst = worst.min(share(a).min(share(b)) * quality(p, triangulation.p[a as usize], triangulation.p[b as usize]));
        }
        worst
    }
}
