//! Settings that rules give each segment: counts, sizes and biases, by rank.

use crate::base::fault::Result;
use crate::base::text::article;
use crate::mesh::border::counts::share;
use crate::mesh::border::layout::Layout;
use crate::mesh::request::fault::CountFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::{Rule, Target};
use crate::mesh::size::rule_effects::RuleEffects;
use crate::mesh::size::rule_lines::{RuleLine, lines_of_edge};

/// How a rule divides a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RuleDivision {
    Count(u32),
    Size(f64),
}

/// A setting with the rule it comes from.
#[derive(Clone, Copy, Debug)]
struct Ruled<T> {
    rank: u8,
    rule: usize,
    value: T,
}

/// Ranks of rules by what they are on, the inner ones higher.
const LINK: u8 = 3;
const CURVE: u8 = 2;
const PATCH: u8 = 1;
const FACE: u8 = 0;

/// Puts a setting in the place of another: inner rules win, of equal ones the later.
fn settle<T>(slot: &mut Option<Ruled<T>>, new: Ruled<T>, key: &'static str, effects: &mut RuleEffects) {
    if let Some(old) = slot {
        if old.rank > new.rank {
            return;
        }
        if old.rank == new.rank && old.rule != new.rule {
            effects.note_override(old.rule, new.rule, key);
        }
    }
    *slot = Some(new);
}

/// The settings of a segment by rules.
pub struct SegmentSettings {
    /// A written count and its rule.
    pub count: Option<(u32, usize)>,
    /// Target size, model units, and the rule or clause unless it is the mesh's own.
    pub size: (f64, Option<usize>),
    /// Last step over first step, along the segment.
    pub bias: f64,
    /// The rule of the bias.
    pub bias_rule: Option<usize>,
}

/// The settings that rules give the segments of a layout.
pub struct SegmentRules {
    division: Vec<Option<Ruled<RuleDivision>>>,
    bias: Vec<Option<Ruled<f64>>>,
}

/// A rule with its place in the plan.
struct RuleAt<'a> {
    index: usize,
    rule: &'a Rule,
}

impl SegmentRules {
    /// Of the rules of a plan; fails where a written count is below the number of segments.
    pub fn new(input: &Input, layout: &Layout, effects: &mut RuleEffects) -> Result<Self> {
        let (n, near) = (layout.pieces.segments.len(), input.tolerance.point);
        let mut rules = Self { division: vec![None; n], bias: vec![None; n] };
        for (index, rule) in input.plan.rules.iter().enumerate() {
            let rule = RuleAt { index, rule };
            match &rule.rule.target {
                Target::Chain(chain) => {
                    let line = RuleLine::of_chain(input, layout, chain);
                    let rank = if line.links.len() == 1 && chain.whole_curve().is_none() { LINK } else { CURVE };
                    if rule.applies_to_lines("curve", std::slice::from_ref(&line), effects) {
                        rules.divide_line(&rule, rank, &line, near, effects)?;
                    }
                }
                Target::Edge(courses) => {
                    let lines = lines_of_edge(layout, courses);
                    if rule.applies_to_lines("edge", &lines, effects) {
                        lines.iter().try_for_each(|line| rules.divide_line(&rule, CURVE, line, near, effects))?;
                    }
                }
                Target::Surface(_) | Target::Patches(_) => rules.count_sides(&rule, layout, near, effects)?,
                Target::Point(_) => {}
            }
        }
        Ok(rules)
    }

    /// The settings of a segment, with the size that its faces give it where no rule gives one.
    pub fn of_segment(&self, k: usize, of_faces: (f64, Option<usize>)) -> SegmentSettings {
        let (count, size) = match self.division[k] {
            Some(Ruled { value: RuleDivision::Count(count), rule, .. }) => (Some((count, rule)), of_faces),
            Some(Ruled { value: RuleDivision::Size(size), rule, .. }) => (None, (size, Some(rule))),
            None => (None, of_faces),
        };
        SegmentSettings { count, size, bias: self.bias[k].map_or(1.0, |b| b.value), bias_rule: self.bias[k].map(|b| b.rule) }
    }

    /// Count or size, and bias, of a rule on one line.
    fn divide_line(&mut self, rule: &RuleAt, rank: u8, line: &RuleLine, near: f64, effects: &mut RuleEffects) -> Result<()> {
        let (index, rule) = (rule.index, rule.rule);
        if let Some((count, origin)) = rule.settings.count {
            let shares = line.count_shares(count, near).map_err(|links| CountFault::BelowLinks { count: (count, origin), links })?;
            for (u, n) in line.uses.iter().zip(shares) {
                settle(&mut self.division[u.segment], Ruled { rank, rule: index, value: RuleDivision::Count(n) }, "count", effects);
            }
        } else if let Some((size, _)) = rule.settings.size {
            for u in &line.uses {
                settle(&mut self.division[u.segment], Ruled { rank, rule: index, value: RuleDivision::Size(size) }, "size", effects);
            }
        }
        if let Some((b, _)) = rule.settings.bias {
            for u in &line.uses {
                // Steps that grow geometrically have a size that is linear in the length.
                let grown = |s: f64| 1.0 + (b - 1.0) * (s / line.length).clamp(0.0, 1.0);
                let local = grown(u.s.1) / grown(u.s.0);
                let value = if u.against { 1.0 / local } else { local };
                settle(&mut self.bias[u.segment], Ruled { rank, rule: index, value }, "bias", effects);
            }
        }
        Ok(())
    }

    /// A count on a surface or a face is for each of its sides.
    fn count_sides(&mut self, RuleAt { index, rule }: &RuleAt, layout: &Layout, near: f64, effects: &mut RuleEffects) -> Result<()> {
        let Some((count, origin)) = rule.settings.count else {
            return Ok(());
        };
        let faces: Vec<_> = layout.faces.iter().filter(|f| rule.target.faces(f.patch, f.surface).is_some()).collect();
        let sides = faces.first().map_or(0, |f| f.sides.len());
        for side in 0..sides {
            let on: Vec<_> = faces.iter().filter(|f| f.sides.len() == sides).collect();
            // A side of the whole surface is the run of those patch sides that no other patch of it continues.
            let inner = |segment: usize| {
                let uses = on.iter().flat_map(|f| f.sides.iter().flat_map(|s| s.segments())).filter(|s| *s == segment).count();
                uses > 1
            };
            let mut segments: Vec<usize> = on.iter().flat_map(|f| f.sides[side].segments()).filter(|s| !inner(*s)).collect();
            segments.dedup();
            if segments.is_empty() {
                continue;
            }
            let weights: Vec<f64> = segments.iter().map(|s| layout.length(*s)).collect();
            let least = vec![1; segments.len()];
            let shares = share(count, &weights, near, &least)
                .ok_or(CountFault::BelowLinks { count: (count, origin), links: segments.len() as u32 })?;
            for (s, n) in segments.iter().zip(shares) {
                let rank = if matches!(rule.target, Target::Patches(_)) { PATCH } else { FACE };
                settle(&mut self.division[*s], Ruled { rank, rule: *index, value: RuleDivision::Count(n) }, "count", effects);
            }
        }
        Ok(())
    }
}

impl RuleAt<'_> {
    /// Whether a rule on a curve or an edge, as `what` calls it, gives settings to lines in the mesh.
    fn applies_to_lines(&self, what: &str, lines: &[RuleLine], effects: &mut RuleEffects) -> bool {
        let settings = &self.rule.settings;
        if lines.iter().all(|line| line.uses.is_empty()) {
            let where_to = if what == "curve" { "on no edge of this mesh" } else { "on no face of this mesh" };
            effects.refuse(self.index, format!("that {what} is {where_to}"));
            return false;
        }
        if settings.count.is_none() && settings.size.is_none() && settings.bias.is_none() {
            effects.refuse(self.index, format!("`elements` and `method` apply to faces, this is {} {what}", article(what)));
            return false;
        }
        true
    }
}
