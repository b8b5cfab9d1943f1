//! The sections of a sweep at its stations: the given ones, and between these their neighbours deformed and blended.

use glam::{DMat3, DVec3};

use crate::base::fault::{Fault, Result};
use crate::base::job;
use crate::base::origin::Origin;
use crate::base::tolerance::Tolerance;
use crate::network::Chain;
use crate::surface::faults::{SectionFault, SweepFault};
use crate::surface::swept::deform::{self, Deformation, Pieces};
use crate::surface::swept::laws::{Law, Main, samples};
use crate::surface::swept::marks::Marks;
use crate::surface::swept::sections::Section;
use crate::surface::swept::sweep_net::{Rib, SweepNet};
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
    turns: Vec<[Vec<DMat3>; 2]>,
}

impl Given<'_> {
    /// Adds the sections at the stations `ws` of the main guide, whose fractions of all guides are `fractions`, and their warnings.
    pub(super) fn ribs(&self, made: &mut SweepNet, ws: &[f64], fractions: Vec<Vec<f64>>, main: &mut Main) -> Result<()> {
        let cut = self.cut(made, ws)?;
        for (place, (&w, on_guides)) in ws.iter().zip(fractions).enumerate() {
            job::poll();
            if let Some(k) = self.sections.iter().position(|s| s.on_guides[0] == w) {
                made.ribs.push(Rib { w, on_guides, chain: self.sections[k].chain.clone(), breaks: self.marks.rows[k].clone() });
                continue;
            }
            let found = self.between(made, &cut, place, w, &on_guides, main);
            let (chain, breaks) = deform::curve(&found, self.origin);
            made.ribs.push(Rib { w, on_guides, chain, breaks });
        }
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
        let divided = Divided { guides: &made.guides, sections: self.sections };
        let returns = made.closed.0 && self.sections.len() == 1;
        let turns = match self.law {
            Law::Synchronized if !all_given => {
                let both = |s: &Section| [true, false].map(|up| divided.turns(s.on_guides[0], ws, up, made.closed.0, returns));
                self.sections.iter().map(both).collect()
            }
            _ => Vec::new(),
        };
        Ok(Cut { pieces, turns })
    }

    /// The given sections nearest to a fraction of the main guide, one or two.
    fn neighbours(&self, w: f64, closed: bool) -> Vec<usize> {
        let n = self.sections.len();
        match (self.sections.partition_point(|s| s.on_guides[0] < w), closed) {
            (after, true) if n > 1 => vec![(after + n - 1) % n, after % n],
            (0, _) => vec![0],
            (k, _) if k == n => vec![n - 1],
            (k, _) => vec![k - 1, k],
        }
    }

    /// The section at a station, number `place` at the fraction `w`, from its neighbours.
    fn between(&self, made: &mut SweepNet, cut: &Cut, place: usize, w: f64, on_guides: &[f64], main: &mut Main) -> Pieces {
        let station = main.station(w);
        let targets: Vec<DVec3> = made.order.iter().map(|&j| made.guides[j].chain.point(on_guides[j])).collect();
        let neighbours = self.neighbours(w, made.closed.0);
        let mut copies = Vec::with_capacity(2);
        for (nth, &k) in neighbours.iter().enumerate() {
            let section = &self.sections[k];
            let anchors: Vec<(f64, DVec3)> = made.order.iter().map(|&j| (section.anchors[j], section.anchor(j))).collect();
            let turn = if self.law == Law::Synchronized {
                let ascending = if neighbours.len() == 2 { nth == 0 } else { section.on_guides[0] <= w };
                cut.turns[k][usize::from(!ascending)][place]
            } else {
                station.turn * main.station(section.on_guides[0]).turn.transpose()
            };
            let deformation = Deformation::new(&anchors, &targets, turn, self.tolerance);
            let scale = deformation.scale;
            if !(LEAST_SCALE..=1.0 / LEAST_SCALE).contains(&scale) {
                let fault = SectionFault::Scaled { section: section.chain.origin(), scale, at: station.at };
                made.notes.push(fault.into());
            }
            let deformation = if made.closed.1 { deformation.closing() } else { deformation };
            copies.push(deformation.pieces(&cut.pieces[k], &self.marks.rows[k]));
        }
        match copies.as_slice() {
            [a, b] => {
                let (from, to) = (self.sections[neighbours[0]].on_guides[0], self.sections[neighbours[1]].on_guides[0]);
                let to = if to <= from { to + 1.0 } else { to };
                let w = if w < from { w + 1.0 } else { w };
                deform::blended(a, b, (w - from) / (to - from), made.closed.1, self.tolerance)
            }
            _ => copies.swap_remove(0),
        }
    }
}

/// Least and one over the largest scale of a section that is no warning.
const LEAST_SCALE: f64 = 0.05;

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
