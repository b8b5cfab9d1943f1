//! Common breaks of sections, so that all have as many pieces.

use crate::base::fault::{Result, ValueFault};
use crate::base::tolerance::{NUDGE, Tolerance};
use crate::surface::swept::deform;
use crate::surface::swept::sections::Section;

/// Breaks of two sections at places no farther from each other than so many tolerances are one.
const ONE_BREAK: f64 = 16.0;

/// The common breaks of all sections: of each the fractions.
pub struct Marks {
    /// Fractions of all breaks, one row per section.
    pub rows: Vec<Vec<f64>>,
    /// Which break each guide runs through, in the order in which sections meet them.
    pub places: Vec<usize>,
}

/// A place at which all sections are divided.
struct Mark {
    /// The run between two guides, and the share of it.
    run: usize,
    share: f64,
    /// Sections with a break of their own there, and its fraction.
    own: Vec<(usize, f64)>,
}

impl Marks {
    /// Breaks of any section are breaks of all, at the same share of the run between two guides.
    pub fn new(sections: &[Section], order: &[usize], closed: bool, tolerance: &Tolerance) -> Result<Self> {
        let near = |s: &Section| tolerance.point / s.chain.length();
        let ends = |s: &Section| {
            let head = s.anchors[order[0]] > near(s);
            // A section no longer than two tolerances begins on its only guide.
            (head, s.anchors[order[order.len() - 1]] < 1.0 - near(s) || order.len() == 1 && !head)
        };
        let (head, tail) = ends(&sections[0]);
        if sections.iter().any(|s| ends(s) != (head, tail)) {
            let found = "some that end on the outer guide and some that go on beyond it".to_owned();
            return Err(ValueFault::OutsideRange { argument: "sections", found, range: "one or the other".to_owned() }.into());
        }
        let edges = |s: &Section| -> Vec<f64> {
            let mut edges: Vec<f64> = order.iter().map(|&j| s.anchors[j]).collect();
            if head {
                edges.insert(0, 0.0);
            } else {
                edges[0] = 0.0;
            }
            if tail {
                edges.push(1.0);
            } else {
                let last = edges.len() - 1;
                edges[last] = 1.0;
            }
            edges
        };
        let edges: Vec<Vec<f64>> = sections.iter().map(edges).collect();
        // Breaks as (run between two edges, share of it).
        let mut own: Vec<Vec<(usize, f64, f64)>> = Vec::with_capacity(sections.len());
        for (section, edges) in sections.iter().zip(&edges) {
            let share = |f: f64| {
                let q = edges.partition_point(|e| *e <= f).clamp(1, edges.len() - 1) - 1;
                (q, (f - edges[q]) / (edges[q + 1] - edges[q]), f)
            };
            own.push(deform::own_breaks(&section.chain, tolerance)?.into_iter().map(share).collect());
        }
        let runs = edges[0].len() - 1;
        let room: Vec<f64> = (0..runs)
            .map(|q| {
                let run = |(section, edges): (&Section, &Vec<f64>)| section.chain.length() * (edges[q + 1] - edges[q]);
                NUDGE.max(ONE_BREAK * tolerance.point / sections.iter().zip(&edges).map(run).fold(0.0, f64::max))
            })
            .collect();
        let mut single: Vec<(usize, f64, usize, f64)> = Vec::new();
        for (k, marks) in own.iter().enumerate() {
            single.extend(marks.iter().filter(|m| m.1 > NUDGE && m.1 < 1.0 - NUDGE).map(|(q, share, f)| (*q, *share, k, *f)));
        }
        single.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        // Breaks of sections that are alike are at shares that differ by the digits of these: what is between them is no piece.
        let mut all: Vec<Mark> = (0..runs).map(|q| Mark { run: q, share: 0.0, own: Vec::new() }).collect();
        let mut last: Option<(usize, f64)> = None;
        for (q, share, k, f) in single {
            let near = last.is_some_and(|(run, before)| run == q && share - before <= room[q]);
            last = Some((q, share));
            match all.last_mut() {
                Some(mark) if near && mark.own.iter().all(|o| o.0 != k) => mark.own.push((k, f)),
                _ => all.push(Mark { run: q, share, own: vec![(k, f)] }),
            }
        }
        all.sort_by(|a, b| a.run.cmp(&b.run).then(a.share.total_cmp(&b.share)));
        let row = |k: usize| -> Vec<f64> {
            let one = |mark: &Mark| {
                let (from, to) = (edges[k][mark.run], edges[k][mark.run + 1]);
                let own = mark.own.iter().find(|o| o.0 == k).map(|o| o.1);
                own.unwrap_or(if mark.share == 0.0 { from } else { from + (to - from) * mark.share })
            };
            all.iter().map(one).chain([1.0]).collect()
        };
        let rows = (0..sections.len()).map(row).collect();
        let first = usize::from(head);
        let place = |q: usize| all.iter().position(|mark| mark.run == q && mark.share == 0.0).unwrap_or(all.len());
        let places =
            (0..order.len()).map(|n| if n + first + 1 == edges[0].len() && !closed { all.len() } else { place(n + first) }).collect();
        Ok(Self { rows, places })
    }

    /// The mean over the sections.
    pub fn mean(&self) -> Vec<f64> {
        let n = self.rows.len() as f64;
        (0..self.rows[0].len()).map(|k| self.rows.iter().map(|row| row[k]).sum::<f64>() / n).collect()
    }
}
