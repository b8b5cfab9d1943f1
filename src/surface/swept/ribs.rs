//! The sections of a sweep at its stations: the given ones, and between these their neighbours deformed and blended.

use glam::{DMat3, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::geometry::data::fault::CurveFault;
use crate::network::Chain;
use crate::surface::data::bends::{inflections_above, largest_curvature};
use crate::surface::faults::{SectionFault, SweepFault};
use crate::surface::swept::blend::{self, Copy};
use crate::surface::swept::course::Course;
use crate::surface::swept::deform::{self, Deformation, Pieces};
use crate::surface::swept::displacement::Displacement;
use crate::surface::swept::laws::{Law, Main, samples};
use crate::surface::swept::marks::Marks;
use crate::surface::swept::sections::Section;
use crate::surface::swept::sweep_net::{Place, Rib, SweepNet};
use crate::surface::swept::synchronized::Divided;

/// What the sections at all stations are made from.
pub(super) struct Given<'a> {
    /// The given sections, by ascending fraction of the main guide.
    pub sections: &'a [Section],
    /// Their common breaks.
    pub marks: &'a Marks,
    pub law: Law,
    pub origin: Origin,
    pub tolerance: &'a Tolerance,
}

/// The given sections cut at the common breaks; where they are synchronized, by how much each turns up to every station, by ascending
/// and by descending fractions.
struct Cut {
    pieces: Vec<Pieces>,
    courses: Vec<Course>,
    /// How displacements go on along each; none where one guide moves all of it alike.
    along: Vec<Option<Displacement>>,
    turns: Vec<[Vec<DMat3>; 2]>,
}

impl Given<'_> {
    /// Adds the sections at places along the main guide, and their warnings.
    pub(super) fn ribs(&self, made: &mut SweepNet, places: Vec<Place>, main: &mut Main) -> Result<()> {
        let ws: Vec<f64> = places.iter().map(|place| place.w).collect();
        let given = |w: f64| self.sections.iter().any(|s| s.on_guides[0] == w);
        let cut = match self.cut(made, &ws) {
            // All stations are given sections, and those that are only compared with the surface fail no sweep.
            Err(_) if places.iter().all(|place| place.halfway || given(place.w)) => None,
            found => Some(found?),
        };
        for (number, Place { w, on_guides, halfway }) in places.into_iter().enumerate() {
            job::poll();
            if let Some(k) = self.sections.iter().position(|s| s.on_guides[0] == w) {
                made.ribs.push(Rib { w, on_guides, chain: self.sections[k].chain.clone(), breaks: self.marks.rows[k].clone() });
                continue;
            }
            let Some(cut) = &cut else { continue };
            let (found, scaled) = self.between(made, cut, number, w, &on_guides, main);
            let (chain, breaks) = deform::curve(&found, self.origin);
            let rib = Rib { w, on_guides, chain, breaks };
            if halfway {
                made.halfway.push(rib);
            } else {
                made.notes.extend(scaled);
                made.ribs.push(rib);
            }
        }
        made.notes.extend(ripples(&made.ribs, self.sections, self.origin, self.tolerance));
        if self.law == Law::Normal {
            made.notes.extend(crossing(&made.ribs, main.chain, self.origin));
        }
        Ok(())
    }

    fn cut(&self, made: &SweepNet, ws: &[f64]) -> Result<Cut> {
        let all_given = ws.iter().all(|w| self.sections.iter().any(|s| s.on_guides[0] == *w));
        let mut pieces: Vec<Pieces> = Vec::new();
        if !all_given {
            for (section, row) in self.sections.iter().zip(&self.marks.rows) {
                pieces.push(deform::cut(&section.chain, row, self.tolerance)?);
            }
            deform::level(&mut pieces);
        }
        let closed = made.closed.1;
        let courses: Vec<Course> =
            pieces.iter().zip(&self.marks.rows).map(|(section, row)| Course::new(section, row, closed, self.tolerance)).collect();
        let mut along = Vec::with_capacity(pieces.len());
        for ((section, course), given) in pieces.iter().zip(&courses).zip(self.sections) {
            let several = self.marks.places.len() > 1;
            let found = several.then(|| Displacement::new(section, course, &self.marks.places, closed));
            let lost = || CurveFault::NotConverged {
                of: given.chain.origin(),
                what: "how the section gives way to its guides".to_owned(),
                at: given.chain.start(),
            };
            along.push(found.map(|found| found.ok_or_else(|| Fault::from(lost()))).transpose()?);
        }
        let divided = Divided { guides: &made.guides, sections: self.sections };
        let returns = made.closed.0 && self.sections.len() == 1;
        let turns = match self.law {
            Law::Synchronized if !all_given => {
                let both = |s: &Section| [true, false].map(|up| divided.turns(s.on_guides[0], ws, up, made.closed.0, returns));
                self.sections.iter().map(both).collect()
            }
            _ => Vec::new(),
        };
        Ok(Cut { pieces, courses, along, turns })
    }

    /// The given sections that decide what is at a fraction of the main guide, two on either side at most, with their fractions in ascending
    /// order; and which of them is the last before it, when there is one on either side.
    fn neighbours(&self, w: f64, closed: bool) -> (Vec<(usize, f64)>, Option<usize>) {
        let n = self.sections.len();
        let after = self.sections.partition_point(|s| s.on_guides[0] < w);
        if closed && n > 1 {
            let at = |step: usize| {
                let place = after + n + step - 2;
                (place % n, self.sections[place % n].on_guides[0] + (place / n) as f64 - 1.0)
            };
            return ((0..4).map(at).collect(), Some(1));
        }
        let known = |k: usize| (k, self.sections[k].on_guides[0]);
        match after {
            0 => (vec![known(0)], None),
            k if k == n => (vec![known(n - 1)], None),
            k => {
                let first = k.saturating_sub(2);
                ((first..(k + 2).min(n)).map(known).collect(), Some(k - 1 - first))
            }
        }
    }

    /// The section at a station, number `place` at the fraction `w`, from its neighbours, with warnings of those that are scaled much.
    fn between(&self, made: &SweepNet, cut: &Cut, place: usize, w: f64, on_guides: &[f64], main: &mut Main) -> (Pieces, Vec<Fault>) {
        let mut scaled = Vec::new();
        let station = main.station(w);
        let targets: Vec<DVec3> = made.order.iter().map(|&j| made.guides[j].chain.point(on_guides[j])).collect();
        let (neighbours, before) = self.neighbours(w, made.closed.0);
        let mut copies = Vec::with_capacity(neighbours.len());
        for (nth, (k, given)) in neighbours.into_iter().enumerate() {
            let section = &self.sections[k];
            let anchors: Vec<DVec3> = made.order.iter().map(|&j| section.anchor(j)).collect();
            let turn = if self.law == Law::Synchronized {
                cut.turns[k][usize::from(given > w)][place]
            } else {
                station.turn * main.station(section.on_guides[0]).turn.transpose()
            };
            let deformation = Deformation::new(&anchors, &targets, turn, self.tolerance);
            let scale = deformation.scale;
            let nearest = before.is_none_or(|before| nth == before || nth == before + 1);
            if nearest && !(LEAST_SCALE..=1.0 / LEAST_SCALE).contains(&scale) {
                let fault = SectionFault::Scaled { section: section.chain.origin(), scale, at: station.at };
                scaled.push(fault.into());
            }
            copies.push(Copy { w: given, pieces: deformation.pieces(&cut.pieces[k], cut.along[k].as_ref()), course: &cut.courses[k] });
        }
        let pieces = match before {
            Some(before) => blend::blended(&copies, before, w, made.closed.1, self.tolerance),
            None => copies.swap_remove(0).pieces,
        };
        (pieces, scaled)
    }
}

/// Least and one over the largest scale of a section that is no warning.
const LEAST_SCALE: f64 = 0.05;

/// Bends of a station count where their curvature is more than this share of the largest one of the sections around it.
const SEEN: f64 = 1.0 / 64.0;

/// W645 where a station has twice as many bends as the sections around it.
fn ripples(ribs: &[Rib], sections: &[Section], origin: Origin, tolerance: &Tolerance) -> Option<Fault> {
    /// A station no longer than so many tolerances is a point.
    const POINT: f64 = 64.0;
    let given: Vec<bool> = ribs.iter().map(|rib| sections.iter().any(|s| s.on_guides[0] == rib.w)).collect();
    let sharpest: Vec<f64> = ribs.iter().map(|rib| largest_curvature(&rib.chain)).collect();
    let mut worst: Option<(usize, usize, usize, DVec3)> = None;
    for (k, rib) in ribs.iter().enumerate().filter(|(k, rib)| !given[*k] && rib.chain.length() > POINT * tolerance.point) {
        let around = [(0..k).rev().find(|j| given[*j]), (k..ribs.len()).find(|j| given[*j])];
        let around = || around.into_iter().flatten();
        let largest = around().map(|j| sharpest[j]).fold(0.0, f64::max);
        let least = SEEN * if largest > 0.0 { largest } else { sharpest[k] };
        let own = inflections_above(&rib.chain, least);
        let most = around().map(|j| inflections_above(&ribs[j].chain, least).len()).max().unwrap_or_default();
        // A curve with n inflections has n + 1 bends.
        if own.len() + 1 > 2 * (most + 1) && worst.is_none_or(|(more, ..)| own.len() - most > more) {
            worst = Some((own.len() - most, own.len(), most, rib.chain.point(own[0])));
        }
    }
    worst.map(|(_, inflections, given, at)| SectionFault::Ripples { surface: origin, inflections, given, at }.into())
}

/// W639 where a section reaches beyond the centre of the main guide's bend.
fn crossing(ribs: &[Rib], main: &Chain, origin: Origin) -> Option<Fault> {
    let mut worst: Option<(f64, DVec3, f64, f64)> = None;
    for rib in ribs {
        let jet = main.jet(rib.w);
        let bend = jet.d2 / (main.length() * main.length());
        for f in samples(&rib.chain) {
            let p = rib.chain.point(f);
            let share = (p - jet.p).dot(bend);
            if share > 1.0 && worst.is_none_or(|w| share > w.0) {
                worst = Some((share, p, p.distance(jet.p), 1.0 / bend.length()));
            }
        }
    }
    worst.map(|(_, at, reach, radius)| {
        SweepFault::SelfIntersects { surface: origin, path: main.origin(), at, reach, radius: Some(radius) }.into()
    })
}
