//! Lines of a hull on its sections: where the sheer, a chine or a profile passes a station.

use glam::DVec3;

use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::construct::fit_curve::{Fit, fit};
use crate::geometry::query::plane::plane_crossings;
use crate::geometry::shapes::nurbs::Nurbs;
use crate::lang::eval::halt::Halt;
use crate::lang::eval::std::offsets::{Line, Offsets, Section, another_unit, bad};
use crate::lang::values::units::number_text;

/// Turns of a line's points above this are corners of it, degrees.
const CORNER: f64 = 30.0;

/// A line of the hull as a curve through its points.
struct Passing {
    line: Line,
    curve: Nurbs,
    /// Whether it is a profile: all of it in the centre plane.
    profile: bool,
}

impl Passing {
    /// Where it passes a station; parts in the plane of the station count by their ends.
    fn at(&self, x: f64, near: f64) -> Vec<DVec3> {
        let places = plane_crossings(&self.curve, DVec3::X, x);
        let mut points: Vec<DVec3> = Vec::with_capacity(places.len());
        for (i, t) in places.iter().enumerate() {
            let point = self.curve.jet(*t).p;
            let middle = |other: Option<&f64>| other.is_some_and(|o| (self.curve.jet(0.5 * (o + t)).p.x - x).abs() <= near);
            let along = middle(i.checked_sub(1).and_then(|i| places.get(i))) || middle(places.get(i + 1));
            if self.profile || !along {
                points.push(DVec3::new(x, point.y.max(0.0), point.z));
            }
        }
        points
    }
}

impl Offsets {
    /// Brings lines onto the sections: a profile ends them in the centre plane, any other line passes a section at a marked point of it.
    ///
    /// A point of the section that is nearer than `near` to that of a line becomes it. E306 for a line of another unit, one that passes no
    /// station and is no profile, and a second one of a name.
    pub(super) fn with_lines(mut self, lines: Vec<Line>, near: f64, origin: Origin, tolerance: &Tolerance) -> Result<Self, Halt> {
        let widest = self.sections.iter().map(Section::widest).fold(0.0, f64::max);
        for line in lines {
            let name = &line.name;
            if self.lines.iter().any(|other| other.name == *name) {
                return Err(bad(
                    "lines",
                    format!("`{name}`, which the table of points has already"),
                    "other lines than the table of points names",
                ));
            }
            for p in &line.points {
                another_unit("lines", p.y, widest, &format!("`{name}`"))?;
            }
            let kinks = Some(CORNER.to_radians());
            let curve = fit(&line.points, &Fit { kinks, ..Fit::default() }, origin)?.to_nurbs(tolerance)?;
            let profile = line.points.iter().all(|p| p.y == 0.0);
            let passing = Passing { line, curve, profile };
            let mut passes = profile;
            for section in &mut self.sections {
                let points = passing.at(section.x, near);
                passes |= !points.is_empty();
                if passing.profile {
                    section.end_at(&points, &passing.line.name, near)?;
                } else {
                    points.into_iter().for_each(|p| section.mark(p, near));
                }
            }
            if !passes {
                return Err(bad(
                    "lines",
                    format!("`{}`, which passes no station", passing.line.name),
                    "lines that pass stations, and profiles",
                ));
            }
            self.lines.push(passing.line);
        }
        Ok(self)
    }
}

impl Section {
    /// Ends it where a profile passes: below its breadths at the lowest point, above them at the highest.
    fn end_at(&mut self, points: &[DVec3], name: &str, near: f64) -> Result<(), Halt> {
        let wide = |p: &DVec3| p.y > 0.0;
        let (Some(first), Some(last)) = (self.points.iter().position(wide), self.points.iter().rposition(wide)) else {
            // No breadth: as much of the profile as there is.
            if let (Some(low), Some(high)) =
                (points.iter().min_by(|a, b| a.z.total_cmp(&b.z)), points.iter().max_by(|a, b| a.z.total_cmp(&b.z)))
            {
                self.points = if high.z > low.z { vec![*low, *high] } else { vec![*low] };
                self.marked.clear();
            }
            return Ok(());
        };
        let (below, above) = (self.points[first].z, self.points[last].z);
        if let Some(p) = points.iter().find(|p| p.z > below + near && p.z < above - near) {
            let found = format!(
                "`{name}` at the height {} of station {}, between half breadths at {} and {}",
                number_text(p.z),
                number_text(self.x),
                number_text(below),
                number_text(above)
            );
            return Err(bad("lines", found, "profiles that pass below or above the half breadths of a station"));
        }
        let low = points.iter().filter(|p| p.z <= below + near).min_by(|a, b| a.z.total_cmp(&b.z));
        let high = points.iter().filter(|p| p.z >= above - near).max_by(|a, b| a.z.total_cmp(&b.z));
        if let Some(high) = high.filter(|high| low != Some(*high)) {
            self.points.truncate(last + 1);
            self.marked.retain(|i| *i <= last);
            self.points.push(*high);
        }
        if let Some(low) = low {
            self.points.splice(..first, [*low]);
            self.marked.retain(|i| *i >= first);
            self.marked.iter_mut().for_each(|i| *i = *i + 1 - first);
        }
        Ok(())
    }

    /// Marks a point: one of its own that is near, else a new one where the section gets the least longer.
    fn mark(&mut self, p: DVec3, near: f64) {
        let count = self.points.len();
        let at = if let Some(i) = (0..count).find(|i| self.points[*i].distance(p) <= near) {
            self.points[i] = p;
            i
        } else {
            let longer = |i: usize| match (i.checked_sub(1).map(|i| self.points[i]), self.points.get(i)) {
                (Some(a), Some(b)) => a.distance(p) + p.distance(*b) - a.distance(*b),
                (Some(a), None) => a.distance(p),
                (None, Some(b)) => b.distance(p),
                (None, None) => 0.0,
            };
            let i = (0..=count).min_by(|i, j| longer(*i).total_cmp(&longer(*j))).unwrap_or(0);
            self.points.insert(i, p);
            self.marked.iter_mut().filter(|m| **m >= i).for_each(|m| *m += 1);
            i
        };
        if let Err(place) = self.marked.binary_search(&at) {
            self.marked.insert(place, at);
        }
    }
}
