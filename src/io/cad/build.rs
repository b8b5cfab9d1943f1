//! Faces as surface values.

use crate::base::job;
use crate::base::origin::Origin;
use crate::base::text::decimals;
use crate::base::tolerance::{MOST_REPAIR, SMALL_GAP, Tolerance};
use crate::io::cad::border::{Border, reach};
use crate::io::cad::defect::{Defect, defect};
use crate::io::cad::face::{Face, least_area};
use crate::io::cad::healing::{Repair, Rule};
use crate::io::cad::part::{Figure, Part, Unusable};
use crate::io::files::fault::{Malformed, Share};
use crate::model::measure;
use crate::network::Chain;
use crate::surface::{Doubt, Ground, Outlined, Side, Surface, outlined, trim};

/// Share of the area below which a bound on what is missing says nothing.
const WORTH_STATING: f64 = 0.005;

/// The surface values of a face.
pub struct FaceSurfaces {
    /// One for each outer loop.
    pub surfaces: Vec<Surface>,
    /// Where its loops do not agree which side is the face.
    pub doubts: Vec<Doubt>,
    /// How far its loops were moved where they close only within more than they were found to be off, model units, and by which rule.
    pub closed_within: Option<(f64, Rule)>,
}

impl Part {
    /// Makes [`Part::built`] of the faces, and [`Part::unusable`] of those that fail; says where the file states other figures of them.
    pub fn build(&mut self, origin: Origin, tolerance: &Tolerance) -> Vec<Malformed> {
        self.built = Vec::with_capacity(self.surfaces.len());
        let mut warnings = Vec::new();
        for (k, item) in self.surfaces.iter().enumerate() {
            job::poll();
            self.built.push(match item.value.surfaces(origin, tolerance) {
                Ok(FaceSurfaces { surfaces, doubts, closed_within }) => {
                    if let Some((distance, rule)) = closed_within {
                        let entity = format!("{} at {}{}", item.name, self.mark, item.id);
                        let place = item.value.off.place;
                        self.repairs.push(Repair { rule, face: k, entity, line: item.line, distance, place });
                    }
                    let words = |doubt: &Doubt| format!("{} at {}{}: {}", item.name, self.mark, item.id, in_words(doubt, self.model_unit));
                    warnings.extend(doubts.iter().map(|doubt| Malformed::line(item.line, words(doubt))));
                    surfaces
                }
                Err(Defect(why)) => {
                    let entity = format!("{} at {}{}", item.name, self.mark, item.id);
                    let loops: Vec<&Vec<Border>> = item.value.outer.iter().chain(&item.value.holes).collect();
                    let least_area = if item.value.outer.is_some() { least_area(&loops) } else { 0.0 };
                    self.unusable.push(Unusable { face: Some(k), entity, line: item.line, cause: why, least_area });
                    Vec::new()
                }
            });
        }
        warnings.extend(self.differences());
        warnings
    }

    /// Share of the area that the faces without a surface have, from 0 to 1: where the file states the area of all, else what their loops
    /// span at least.
    pub fn share_missing(&self) -> Option<Share> {
        self.share_stated().map(Share::Stated).or_else(|| {
            let missing: f64 = self.unusable.iter().map(|missing| missing.least_area).sum();
            let found: f64 = self.built.iter().flatten().map(measure::area).sum();
            let share = missing / (missing + found);
            (share > WORTH_STATING).then_some(Share::AtLeast(share))
        })
    }

    fn share_stated(&self) -> Option<f64> {
        let made: Vec<usize> = (0..self.built.len()).filter(|k| !self.built[*k].is_empty()).collect();
        let whole = self.stated.iter().find_map(|stated| match stated.figure {
            Figure::Area(area) if stated.copies == 1 && made.iter().all(|k| stated.surfaces.contains(k)) => Some(area),
            _ => None,
        })?;
        let found: f64 = self.built.iter().flatten().map(measure::area).sum();
        let share = 1.0 - found / whole;
        (0.0..1.0).contains(&share).then_some(share)
    }
}

impl Face {
    /// The surface values, one for each outer loop, and where the loops do not agree which side is the face; borders may be as far off as
    /// the file has them: as they were found to be, else what it says that may lie between two points that are one. Distances were found at
    /// places: a closer look finds a border farther off by a hair, or by more between them. What is allowed is doubled until it is enough, up to
    /// a thousandth of the size.
    pub fn surfaces(&self, origin: Origin, tolerance: &Tolerance) -> Result<FaceSurfaces, Defect> {
        if let Some(why) = self.beyond_repair(tolerance) {
            return Err(why);
        }
        let found = Tolerance { point: tolerance.point.max(2.0 * self.off.distance), ..*tolerance };
        let stated = Tolerance { point: self.slack, ..*tolerance };
        let made = |(surfaces, doubts): (Vec<Surface>, Vec<Doubt>), closed_within| FaceSurfaces { surfaces, doubts, closed_within };
        let why = match self.within(origin, &found) {
            Ok(all) => return Ok(made(all, None)),
            Err(why) => why,
        };
        if stated.point > found.point
            && let Ok(all) = self.within(origin, &stated)
        {
            return Ok(made(all, Some((self.slack, Rule::Accuracy))));
        }
        let most = SMALL_GAP * reach(self.outer.iter().chain(&self.holes)).diagonal();
        let doubled = std::iter::successors(Some(2.0 * found.point.max(stated.point)), |wider| Some(2.0 * wider));
        for point in doubled.take_while(|wider| *wider <= most) {
            job::poll();
            if let Ok(all) = self.within(origin, &Tolerance { point, ..*tolerance }) {
                return Ok(made(all, Some((point, self.off.rule))));
            }
        }
        Err(why)
    }

    /// Why its borders are no borders of its surface: they are off by too large a share of their size.
    fn beyond_repair(&self, tolerance: &Tolerance) -> Option<Defect> {
        if self.off.distance <= tolerance.point {
            return None;
        }
        let share = self.off.distance / reach(self.outer.iter().chain(&self.holes)).diagonal();
        let percent = decimals(share * 100.0, 0);
        let why = match self.off.rule {
            Rule::Ends => format!("a gap in its border is {percent} % of its size"),
            _ => format!("its border is off its surface by {percent} % of its size"),
        };
        (share > MOST_REPAIR).then(|| defect(why))
    }

    fn within(&self, origin: Origin, tolerance: &Tolerance) -> Result<(Vec<Surface>, Vec<Doubt>), Defect> {
        if self.outer.is_none() && self.holes.is_empty() {
            let all = std::iter::once(&self.base).chain(&self.also);
            return Ok((all.map(|surface| self.turned(surface.clone())).collect(), Vec::new()));
        }
        let trimmed = || {
            let outer = self.outer.as_deref().map(chains).unwrap_or_default();
            let holes: Vec<Vec<Chain>> = self.holes.iter().map(|hole| chains(hole)).collect();
            trim(&self.base, &outer, &holes, origin, tolerance).map(|surface| (vec![surface], Vec::new()))
        };
        let bounded = || {
            let loops: Vec<Vec<Chain>> = self.outer.iter().chain(&self.holes).map(|border| chains(border)).collect();
            outlined(
                &self.base,
                &loops,
                Outlined { has_outer: self.outer.is_some(), inside: self.inside, against: self.against },
                origin,
                tolerance,
            )
        };
        // Where nothing closes each loop bounds a part alone, in whatever order its curves are.
        let made = if self.is_plain() {
            trimmed().or_else(|why| bounded().map_err(|_| why))
        } else {
            bounded().or_else(|why| trimmed().map_err(|_| why))
        };
        let (made, doubts) = made?;
        Ok((made.into_iter().map(|surface| self.turned(surface).with_borders_off(self.off.distance)).collect(), doubts))
    }

    /// Whether the surface below has neither seams nor poles.
    fn is_plain(&self) -> bool {
        self.base.closed() == (false, false) && (0..self.base.n_sides()).all(|k| !matches!(self.base.side(k), Side::Pole(_)))
    }

    fn turned(&self, surface: Surface) -> Surface {
        if self.flipped { surface.flipped() } else { surface }
    }
}

/// "its loops disagree on which side the face is, …".
fn in_words(doubt: &Doubt, unit: &str) -> String {
    let percent = decimals(doubt.share * 100.0, 1);
    let why = match doubt.by {
        Ground::Border => format!("it has {percent} % of the surface border without curves"),
        Ground::Inner => format!("it has {percent} % of the curves that are run in both directions"),
        Ground::Point => "it has a point inside the face".to_owned(),
        Ground::Directions => format!("it is on the left of {percent} % of their length"),
        Ground::Size => "it was chosen by size, since their directions cancel".to_owned(),
    };
    let at = doubt.at.to_array().map(|x| decimals(x, 3)).join(", ");
    format!("its loops disagree on which side the face is, near ({at}) {unit}; one side is kept: {why}")
}

fn chains(borders: &[Border]) -> Vec<Chain> {
    borders.iter().map(|b| Chain::of_curve(&b.space)).collect()
}
