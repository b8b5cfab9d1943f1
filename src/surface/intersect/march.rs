//! From one common place of two patches to the next, to their borders or round to the start.

use glam::{DVec2, DVec3};

use crate::base::job;
use crate::base::tolerance::{EPSILON, NUDGE, TOLD_APART};
use crate::surface::closest::foot::FootSearch;
use crate::surface::intersect::fit_branch::Branch;
use crate::surface::intersect::pair::{EXACT, Pair, Spot};
use crate::surface::intersect::sheet::{BorderLine, Patch};

/// What steers the steps along an intersection.
struct Marching {
    /// Largest turn from one place to the next, as a cosine, and the one below which steps grow.
    turn_cosines: (f64, f64),
    /// Places in a row at most.
    max_places: usize,
    /// First step, as a share of the size of the pair.
    first_step_share: f64,
    /// Largest step, as a share of the size of the pair.
    largest_step_share: f64,
    /// A place on a border is as far as was foreseen up to this ratio.
    unlike_ratio: f64,
}

const MARCH: Marching = Marching {
    turn_cosines: (0.97, 0.995),
    max_places: 20_000,
    first_step_share: 1.0 / 64.0,
    largest_step_share: 1.0 / 16.0,
    unlike_ratio: 4.0,
};

/// Where a march takes shorter steps than elsewhere.
#[derive(Debug, Default)]
pub(crate) struct Strides {
    pub narrow: Vec<Narrow>,
}

/// A ball in which steps are short.
#[derive(Debug)]
pub(crate) struct Narrow {
    at: DVec3,
    reach: f64,
    pub step: f64,
}

impl Narrow {
    /// About two places, with steps that are a share of their distance.
    pub fn between(from: DVec3, to: DVec3, share: f64) -> Self {
        let reach = from.distance(to);
        Self { at: from.midpoint(to), reach, step: share * reach }
    }
}

impl Strides {
    /// The longest step from a place: none leads into a ball by more than a step of that ball.
    fn longest(&self, from: DVec3) -> f64 {
        let one = |narrow: &Narrow| narrow.step.max(narrow.at.distance(from) - narrow.reach);
        self.narrow.iter().map(one).fold(f64::INFINITY, f64::min)
    }
}

impl Pair<'_> {
    /// Places in a row on the whole line through a place; where the march failed when it did.
    pub fn march(&self, start: Spot, size: f64, strides: &Strides) -> Result<Vec<Spot>, DVec3> {
        let (mut spots, closed) = self.run(start, size, strides)?;
        if closed {
            return Ok(spots);
        }
        let back = Spot { way: -start.way, ..start };
        let (behind, _) = self.run(back, size, strides)?;
        let turned = behind.into_iter().skip(1).map(|s| Spot { way: -s.way, ..s });
        let mut all: Vec<Spot> = turned.collect();
        all.reverse();
        all.append(&mut spots);
        Ok(all)
    }

    /// Goes one way; whether it came back to the start.
    fn run(&self, start: Spot, size: f64, strides: &Strides) -> Result<(Vec<Spot>, bool), DVec3> {
        let mut spots = vec![start];
        let mut h = MARCH.first_step_share * size;
        while spots.len() < MARCH.max_places {
            job::poll();
            let here = spots[spots.len() - 1];
            h = h.min(strides.longest(here.p));
            if h < NUDGE * NUDGE * size {
                return if self.is_along_border(&here, size) { Ok((spots, false)) } else { Err(here.p) };
            }
            let Some((a, b)) = self.ahead(&here, here.way * h) else { return self.stopped(spots, here) };
            if let Some((share, first, line)) = self.leaves(&here, a, b).filter(|_| !self.stays(&here, h, (a, b))) {
                if share <= EPSILON {
                    return Ok((spots, false));
                }
                let (x, y) = (here.a.lerp(a, share), here.b.lerp(b, share));
                match self.on_border(first, line, x, y).map(|end| self.aligned(&here, end)) {
                    Some(end)
                        if fits(&here, &end, h.max(end.p.distance(here.p)))
                            && self.is_in(&end)
                            && as_far(&here, &end, share * h, size)
                            && self.turns_little(&here, &end) =>
                    {
                        if end.p.distance(here.p) > EPSILON * size {
                            spots.push(end);
                        }
                        return Ok((spots, false));
                    }
                    _ if self.is_at(first, line, &here) => return Ok((spots, false)),
                    _ => {
                        h *= 0.5;
                        continue;
                    }
                }
            }
            let target = here.p + here.way * h;
            let (a, b) = (self.a.hold(a), self.b.hold(b));
            let next = self.correct(a, b, Some((target, here.way))).map(|next| self.aligned(&here, next));
            match next {
                Some(next) if fits(&here, &next, h) && next.way.dot(here.way) >= MARCH.turn_cosines.0 => {
                    if spots.len() > 2 && closes(&start, &here, &next) {
                        spots.push(start);
                        return Ok((spots, true));
                    }
                    spots.push(next);
                    if next.way.dot(here.way) >= MARCH.turn_cosines.1 {
                        h = (1.5 * h).min(MARCH.largest_step_share * size);
                    }
                }
                _ => h *= 0.5,
            }
        }
        Err(spots[spots.len() - 1].p)
    }

    /// Whether a line that seems to leave a patch at the end of a step does not: it bends back before it comes to the border, or touches that.
    fn stays(&self, here: &Spot, h: f64, (a, b): (DVec2, DVec2)) -> bool {
        let target = here.p + here.way * h;
        let next = self.correct(self.a.hold(a), self.b.hold(b), Some((target, here.way))).map(|next| self.aligned(here, next));
        next.is_some_and(|next| fits(here, &next, h) && self.is_in(&next) && next.way.dot(here.way) >= MARCH.turn_cosines.0)
    }

    /// Whether the line comes to a border so nearly along it that it leaves by less than what is one place if it comes back.
    fn is_along(&self, first: bool, line: BorderLine, spot: &Spot, size: f64) -> bool {
        self.rise(first, line, spot) <= (EXACT * self.point / size).sqrt()
    }

    /// Whether a place is on a border and the line runs along that one there: it may leave by less than can be told.
    fn is_along_border(&self, here: &Spot, size: f64) -> bool {
        let ends = |(first, patch): (bool, &Patch)| {
            patch.lines().into_iter().any(|line| self.is_at(first, line, here) && self.is_along(first, line, here, size))
        };
        [(true, self.a), (false, self.b)].into_iter().any(ends)
    }

    /// Whether the line turns by no more than a step may on its way to a place, or is too short to tell.
    fn turns_little(&self, here: &Spot, next: &Spot) -> bool {
        next.way.dot(here.way) >= MARCH.turn_cosines.0 || next.p.distance(here.p) <= TOLD_APART * self.point
    }

    /// At a place where a patch is singular the line ends, when that is a pole on its border.
    fn stopped(&self, spots: Vec<Spot>, here: Spot) -> Result<(Vec<Spot>, bool), DVec3> {
        let at_border = |patch: &Patch, uv: DVec2| patch.lines().into_iter().any(|line| line.inside(patch, uv) <= EPSILON);
        if at_border(self.a, here.a) || at_border(self.b, here.b) { Ok((spots, false)) } else { Err(here.p) }
    }

    /// The direction in the sense of the way before; where the patches touch, straight on.
    fn aligned(&self, before: &Spot, spot: Spot) -> Spot {
        let chord = (spot.p - before.p).normalize_or_zero();
        let way = if spot.sine <= NUDGE { chord } else { spot.way };
        let against = if chord == DVec3::ZERO { before.way.dot(way) < 0.0 } else { chord.dot(way) < 0.0 };
        Spot { way: if against { -way } else { way }, ..spot }
    }

    /// The first border on the way to a place outside: share of the way, whether it is of the first patch, and the border.
    fn leaves(&self, here: &Spot, a: DVec2, b: DVec2) -> Option<(f64, bool, BorderLine)> {
        let mut best: Option<(f64, bool, BorderLine)> = None;
        for (first, patch, from, to) in [(true, self.a, here.a, a), (false, self.b, here.b, b)] {
            for line in patch.lines() {
                let (x, y) = (line.inside(patch, from), line.inside(patch, to));
                if y < -NUDGE * NUDGE {
                    let share = (x / (x - y)).clamp(0.0, 1.0);
                    if best.is_none_or(|(s, ..)| share < s) {
                        best = Some((share, first, line));
                    }
                }
            }
        }
        best
    }

    fn is_in(&self, spot: &Spot) -> bool {
        let within = |patch: &Patch, uv: DVec2| patch.lines().into_iter().all(|line| line.inside(patch, uv) >= -NUDGE * NUDGE);
        within(self.a, spot.a) && within(self.b, spot.b)
    }

    /// The place of a branch in the plane across its chord through a point, when the branch passes there.
    pub fn passes(&self, branch: &Branch, at: &Spot) -> bool {
        branch.spots.windows(2).any(|w| {
            let (from, to) = (w[0].p, w[1].p);
            let chord = to - from;
            let length = chord.length();
            if length == 0.0 {
                return false;
            }
            let share = (at.p - from).dot(chord) / (length * length);
            let near = (from + chord * share).distance(at.p);
            if !(-0.01..=1.01).contains(&share) || near > 0.5 * length {
                return false;
            }
            let (a, b) = (w[0].a.lerp(w[1].a, share), w[0].b.lerp(w[1].b, share));
            self.correct(a, b, Some((at.p, chord / length))).is_some_and(|s| s.p.distance(at.p) <= self.point)
        })
    }
}

/// Whether a place is about where a step was to lead.
fn fits(here: &Spot, next: &Spot, h: f64) -> bool {
    let step = next.p - here.p;
    let along = step.dot(here.way);
    along >= -EPSILON && step.length() <= 1.5 * h && step.distance(here.way * along) <= 0.25 * h.max(along)
}

/// Whether a place on a border is about as far as was foreseen: a closed surface has the same place on its other border too.
fn as_far(here: &Spot, end: &Spot, foreseen: f64, size: f64) -> bool {
    let far = end.p.distance(here.p);
    far <= MARCH.unlike_ratio * foreseen + NUDGE * NUDGE * size && foreseen <= MARCH.unlike_ratio * far + NUDGE * NUDGE * size
}

/// Whether the start lies between two places.
fn closes(start: &Spot, here: &Spot, next: &Spot) -> bool {
    let chord = next.p - here.p;
    let share = (start.p - here.p).dot(chord) / chord.length_squared();
    let aside = (start.p - here.p - chord * share).length();
    // As far along the other domain as in space, so that another sheet that passes here does not count.
    let near = |from: DVec2, to: DVec2, at: DVec2| at.distance(from.lerp(to, share)) <= from.distance(to);
    (0.0..=1.0).contains(&share)
        && aside <= 0.25 * chord.length()
        && start.way.dot(chord) > 0.0
        && near(here.a, next.a, start.a)
        && near(here.b, next.b, start.b)
}
