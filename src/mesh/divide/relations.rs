//! The faces as equations between counts, and their contradictions as faults.

use std::collections::BTreeMap;

use crate::base::fault::{Fault, Result};
use crate::base::origin::Origin;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::divide::equations::{Conflict, Relation, Unknown};
use crate::mesh::divide::row_demand::RowDemand;
use crate::mesh::divide::verdict::Verdict;
use crate::mesh::request::fault::{CountFault, FaceFault, MeshLimit, SizeFault};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::Elements;
use crate::mesh::request::plan::Plan;
use crate::mesh::size::sizing::{Decision, MOST, Sizing};

/// A direction of a face as an unknown: what its rows want.
#[derive(Clone, Debug)]
struct RowUnknown {
    face: usize,
    segment: Unknown,
    /// The limit behind `least`, once the finished face has raised it.
    limit: MeshLimit,
}

/// Equations of all faces; unknowns are the segments of the layout, then the rows.
#[derive(Clone, Debug, Default)]
pub struct Relations {
    /// The equations.
    pub list: Vec<Relation>,
    face_of: Vec<usize>,
    rows: Vec<RowUnknown>,
    first_row: usize,
    /// Rows of each face: along u and v; of a triangle one, or three for its sides.
    pub of_face: Vec<Vec<usize>>,
}

fn whole(x: f64) -> u32 {
    ((x - WHOLE_NUMBER).ceil().max(1.0)).min(f64::from(MOST)) as u32
}

impl Sizing {
    /// The segments as unknowns of the solver.
    pub fn segments(&self, layout: &Layout) -> Vec<Unknown> {
        let mut even = vec![false; self.decisions.len()];
        layout.faces.iter().filter(|f| f.takes_quads()).flat_map(|f| f.segments()).for_each(|s| even[s] = true);
        // A written count may be odd where another one of the face is.
        let sides = layout.faces.iter().flat_map(|f| &f.sides).flat_map(|s| &s.uses);
        sides.filter(|u| self.decisions[u.segment].count.is_some()).for_each(|u| even[u.segment] = false);
        let one = |(k, d): (usize, &Decision)| Unknown {
            least: d.least,
            demand: d.demand,
            written: d.count.map(|c| c.0),
            length: layout.length(k),
            even: even[k],
        };
        self.decisions.iter().enumerate().map(one).collect()
    }
}

impl Relations {
    /// The equations of a layout with this sizing whose rows have these demands.
    pub fn new(layout: &Layout, sizing: &Sizing, demands: &[[RowDemand; 2]]) -> Self {
        let mut relations = Self { first_row: layout.pieces.segments.len(), ..Self::default() };
        for (index, face) in layout.faces.iter().enumerate() {
            relations.of_face.push(Vec::new());
            if face.free {
                if face.takes_quads() {
                    let round = face.sides.iter().flat_map(|s| s.segments()).collect();
                    relations.push(index, Relation::EvenSum(round));
                }
                continue;
            }
            if !face.is_triangle() {
                for (direction, demand) in demands[index].iter().enumerate() {
                    // Between two poles one row of triangles would meet in both.
                    let both_ends = face.sides[1 - direction].uses.is_empty() && face.sides[3 - direction].uses.is_empty();
                    // Round a seam, fewer than three columns would fall on each other.
                    let [from, to] = if direction == 0 { [3, 1] } else { [0, 2] }.map(|k| face.sides[k].segments());
                    let is_ring = from.iter().any(|s| to.contains(s));
                    let least = if is_ring { 3 } else { 1 + u32::from(both_ends) };
                    let row = relations.row(index, demand, least);
                    relations.join(index, row, face, &[direction, direction + 2]);
                    if sizing.rows[index][direction].is_some() {
                        // Rows are straight where each segment has as many steps as the opposite one.
                        let [a, b] = [direction, direction + 2].map(|k| face.sides[k].segments());
                        a.iter().zip(&b).for_each(|(a, b)| relations.push(index, Relation::Equal(vec![*a], vec![*b])));
                    }
                }
            } else if face.elements == Elements::Triangles {
                let row = relations.row(index, &demands[index][0], 1);
                relations.join(index, row, face, &[0, 1, 2]);
            } else {
                for side in 0..3 {
                    let row = relations.row(index, &RowDemand::default(), 1);
                    relations.join(index, row, face, &[side]);
                }
                let sides = [0, 1, 2].map(|k| face.sides[k].segments());
                relations.push(index, Relation::ThreeSides(sides));
            }
        }
        relations
    }

    fn row(&mut self, face: usize, demand: &RowDemand, least: u32) -> usize {
        let least = whole(demand.least).max(least);
        let segment = Unknown { least, demand: whole(demand.size).max(least), written: None, length: demand.length, even: false };
        self.rows.push(RowUnknown { face, segment, limit: MeshLimit::Size });
        let row = self.first_row + self.rows.len() - 1;
        self.of_face[face].push(row);
        row
    }

    fn join(&mut self, index: usize, row: usize, face: &Face, sides: &[usize]) {
        for side in sides.iter().map(|k| &face.sides[*k]).filter(|s| !s.uses.is_empty()) {
            self.push(index, Relation::Equal(vec![row], side.segments()));
        }
    }

    fn push(&mut self, face: usize, relation: Relation) {
        self.list.push(relation);
        self.face_of.push(face);
    }

    /// The rows as unknowns.
    pub fn rows(&self) -> impl Iterator<Item = Unknown> + '_ {
        self.rows.iter().map(|r| r.segment.clone())
    }

    /// Raises the demands of rows where a finished face broke a limit. `counts` are of segments and rows.
    pub fn raise(&mut self, verdicts: &[Verdict], counts: &[u32]) {
        for (face, verdict) in verdicts.iter().enumerate() {
            for (k, &row) in self.of_face[face].clone().iter().enumerate() {
                let now = counts[row];
                let more = |factor: f64| whole(f64::from(now) * factor).max(now + 1).min(MOST);
                let slot = &mut self.rows[row - self.first_row];
                let direction = if verdict.size.len() > k { k } else { 0 };
                if verdict.size[direction] > 1.0 {
                    slot.segment.demand = slot.segment.demand.max(more(verdict.size[direction]));
                }
                if verdict.limit[direction] > 1.0 {
                    slot.segment.least = slot.segment.least.max(more(verdict.limit[direction]));
                    slot.segment.demand = slot.segment.demand.max(slot.segment.least);
                    slot.limit = verdict.broken;
                }
            }
        }
    }

    /// E704 where a freely meshed face of quads has an odd number of elements along its border in all.
    pub fn refuse_odd_borders(&self, input: &Input, layout: &Layout, sizing: &Sizing, counts: &[u32]) -> Result<()> {
        for face in layout.faces.iter().filter(|f| f.takes_quads()) {
            let round = face.sides.iter().flat_map(|s| &s.uses).map(|u| u.segment);
            let odd: Vec<usize> = round.filter(|k| counts[*k] % 2 == 1).collect();
            if odd.len() % 2 == 1 {
                let written = odd.iter().copied().find(|k| sizing.decisions[*k].count.is_some());
                let needs = written.unwrap_or(odd[0]);
                return Err(self.fault(input, layout, sizing, &Conflict::Odd { written, needs }));
            }
        }
        Ok(())
    }

    /// The fault of a contradiction.
    pub fn fault(&self, input: &Input, layout: &Layout, sizing: &Sizing, conflict: &Conflict) -> Fault {
        let plan = input.plan;
        let written = |segment: usize| -> (u32, Origin) {
            let (count, rule) = sizing.decisions.get(segment).and_then(|d| d.count).unwrap_or((0, usize::MAX));
            let rule = plan.rules.get(rule);
            (count, rule.map_or(Origin::NONE, |r| r.settings.count.map_or(r.origin, |c| c.1)))
        };
        let place = |relation: usize| {
            let face = &layout.faces[self.face_of[relation]];
            (input.model.surfaces[face.surface.index()].surface.origin(), crate::mesh::border::layout::middle(input, face))
        };
        match conflict {
            Conflict::Differ { relation, a, b } => {
                let (surface, at) = place(*relation);
                let located = |side: &(u32, Option<usize>)| (side.0, side.1.map_or(Origin::NONE, |s| written(s).1));
                CountFault::Differ { a: located(a), b: located(b), surface, at }.into()
            }
            Conflict::Endless { relation } => {
                let (surface, at) = place(*relation);
                let why = "its opposite sides are parts of one strip, so that no counts make them equal".to_owned();
                FaceFault::CannotMap { surface, why, at, help: None }.into()
            }
            Conflict::ThreeSides { relation, counts, written: by } => {
                let mut by: Vec<(u32, Origin)> = by.iter().map(|s| written(*s)).collect();
                by.sort_by_key(|b| b.1);
                by.dedup_by_key(|b| b.1);
                CountFault::SidesDoNotClose { counts: *counts, written: by, surface: place(*relation).0 }.into()
            }
            Conflict::Odd { written: by, needs } => {
                let at = layout.point(*needs, 0.5);
                let on = |f: &&Face| f.takes_quads() && f.segments().any(|s| s == *needs);
                let face = layout.faces.iter().find(on);
                let surface = face.map_or(Origin::NONE, |f| input.model.surfaces[f.surface.index()].surface.origin());
                let count = face.and_then(|face| odd_rule(plan, sizing, face)).or_else(|| by.map(written)).unwrap_or((0, Origin::NONE));
                CountFault::Odd { count, surface, at }.into()
            }
            Conflict::TooCoarse { written: by, needs, least } => self.too_coarse(input, layout, written(*by), *needs, *least),
        }
    }

    /// A written count against a limit, or against the shape of a face.
    fn too_coarse(&self, input: &Input, layout: &Layout, count: (u32, Origin), needs: usize, least: u32) -> Fault {
        let plan = input.plan;
        let row = needs.checked_sub(self.first_row).map(|r| &self.rows[r]);
        let at = row.map_or_else(|| layout.point(needs, 0.5), |r| crate::mesh::border::layout::middle(input, &layout.faces[r.face]));
        let angle = plan.settings.angle_error.filter(|_| row.is_some_and(|r| r.limit == MeshLimit::AngleError));
        let limit = angle.map(|angle| (MeshLimit::AngleError, angle.1)).or_else(|| plan.bend_limit());
        match limit {
            Some((limit, written_at)) if least > 3 || row.is_some() => {
                CountFault::TooCoarse { count, limit, written_at, needed: least, at }.into()
            }
            _ => CountFault::TooFew { count, needed: least, at }.into(),
        }
    }

    /// A limit that is still broken after all refinements.
    pub fn out_of_reach(&self, input: &Input, layout: &Layout, verdicts: &[Verdict]) -> Fault {
        let worst = (0..verdicts.len()).max_by(|a, b| verdicts[*a].worst().total_cmp(&verdicts[*b].worst())).unwrap_or(0);
        let face = &layout.faces[worst];
        let surface = input.model.surfaces[face.surface.index()].surface.origin();
        let Verdict { broken: limit, reached, .. } = verdicts.get(worst).copied().unwrap_or(Verdict::FINE);
        let written_at = input.plan.limit(limit).map(|value| value.1);
        let at = crate::mesh::border::layout::middle(input, face);
        SizeFault::NotReached { limit, written_at: written_at.unwrap_or(input.plan.origin), surface, reached, at }.into()
    }
}

/// The first rule whose written count is odd and gives the border of a face an odd number of elements.
fn odd_rule(plan: &Plan, sizing: &Sizing, face: &Face) -> Option<(u32, Origin)> {
    let mut steps: BTreeMap<usize, u32> = BTreeMap::new();
    for (count, rule) in face.segments().filter_map(|segment| sizing.decisions.get(segment)?.count) {
        *steps.entry(rule).or_default() += count;
    }
    let odd = steps.into_iter().filter(|(_, steps)| steps % 2 == 1);
    odd.filter_map(|(rule, _)| plan.rules.get(rule)?.settings.count).find(|written| written.0 % 2 == 1)
}
