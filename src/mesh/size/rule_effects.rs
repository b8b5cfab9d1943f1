//! Which rules, clauses and settings have an effect, and why the others have none.

use crate::base::origin::Origin;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::request::decider::Why;
use crate::mesh::request::input::Input;
use crate::mesh::request::plan::Plan;
use crate::mesh::request::sources::Sources;
use crate::mesh::size::border_spacing::BorderSpacings;
use crate::mesh::size::remark::Remark;

/// Settings of the whole mesh that act on free faces, and `growth` on uneven rows too; they follow the clauses in [`RuleEffects`].
pub(crate) const FREE_ONLY: [&str; 3] = ["smooth", "growth", "regular"];

/// Where one of them is written.
pub(crate) fn free_only_origin(plan: &Plan, key: &str) -> Option<Origin> {
    match key {
        "smooth" => plan.settings.smooth.map(|n| n.1),
        "growth" => plan.settings.growth.map(|g| g.1),
        _ => plan.settings.regular.map(|r| r.1),
    }
}

/// Settings of which one rule may override another.
pub(crate) const KEYS: [&str; 5] = ["count", "size", "bias", "elements", "method"];

/// Effects of the rules of a plan, then of its `near` and `in` clauses, then of settings that act on free faces only.
#[derive(Clone, Debug, Default)]
pub struct RuleEffects {
    /// Whether each decided something.
    used: Vec<bool>,
    /// Why one cannot decide anything, in words.
    inapplicable: Vec<Option<String>>,
    /// The rule that loses against an equal one, the one that holds, the setting.
    overridden: Vec<(usize, usize, &'static str)>,
}

impl RuleEffects {
    /// Of a plan: none yet.
    pub(super) fn new(plan: &Plan) -> Self {
        let n = plan.rules.len() + plan.refines.len() + FREE_ONLY.len();
        Self { used: vec![false; n], inapplicable: vec![None; n], overridden: Vec::new() }
    }

    /// A rule, clause or setting decides something.
    pub(super) fn mark_used(&mut self, index: usize) {
        self.used[index] = true;
    }

    /// It cannot decide anything; `why` in words.
    pub(super) fn refuse(&mut self, index: usize, why: String) {
        self.inapplicable[index] = Some(why);
    }

    /// Of two equal rules the later one holds for a setting.
    pub(super) fn note_override(&mut self, earlier: usize, later: usize, key: &'static str) {
        self.overridden.push((earlier, later, key));
    }

    /// Settings that act on free faces only are used where there are such faces, or where nobody wrote them.
    pub(super) fn check_free_only(&mut self, input: &Input, layout: &Layout) {
        let plan = input.plan;
        let free = layout.faces.iter().any(|face| face.free);
        let is_plane = |face: &Face| input.model.surfaces[face.surface.index()].surface.is_flat();
        let plane_quads = layout.faces.iter().any(|face| face.takes_quads() && is_plane(face));
        let first = plan.rules.len() + plan.refines.len();
        for (k, key) in FREE_ONLY.into_iter().enumerate() {
            let (acts, on) = match key {
                "smooth" => (free, "freely meshed faces"),
                "growth" => (free || !plan.refines.is_empty(), "freely meshed faces and uneven rows"),
                _ => (plane_quads, "freely meshed plane faces of quads"),
            };
            let idle = free_only_origin(plan, key).is_some() && !acts;
            self.used[first + k] = !idle;
            self.inapplicable[first + k] = idle.then(|| format!("`{key}` is for {on}, and there is none here"));
        }
    }

    /// `growth` acts on rows of maps that are uneven.
    pub(super) fn mark_uneven_rows(&mut self, plan: &Plan) {
        let growth = FREE_ONLY.iter().position(|key| *key == "growth").map(|k| plan.rules.len() + plan.refines.len() + k);
        growth.into_iter().for_each(|k| (self.used[k], self.inapplicable[k]) = (true, None));
    }

    /// Marks the clauses that make steps of segments shorter; `sizes` are those of the segments, model units.
    pub(super) fn mark_spacings(&mut self, input: &Input, layout: &Layout, spacings: &BorderSpacings, sources: &Sources, sizes: &[f64]) {
        let first = input.plan.rules.len();
        for (k, spacing) in spacings.iter().enumerate() {
            let places = spacing.iter().flat_map(|spacing| spacing.places()).map(|f| layout.point(k, f));
            for p in places {
                if let Some(least) = sources.who(p, sizes[k]) {
                    self.used[first + sources.items()[least.item as usize].tag as usize] = true;
                }
            }
        }
    }

    /// Marks the clauses that decide sizes inside free faces.
    pub fn mark_inside(&mut self, input: &Input, prepared: &[FaceMesh]) {
        for decider in prepared.iter().filter_map(|face| face.inside.as_ref()).flat_map(|inside| &inside.decided.deciders) {
            if let Why::Refined(clause) = decider.why {
                self.used[input.plan.rules.len() + clause] = true;
            }
        }
    }

    /// W706 for rules overridden by equal ones, W701 for rules without effect.
    pub(super) fn remarks(&self) -> Vec<Remark> {
        let mut pairs = self.overridden.clone();
        pairs.sort_unstable();
        pairs.dedup();
        let overridden = pairs.iter().map(|&(earlier, later, key)| Remark::Overridden { key: key.to_owned(), earlier, later });
        let mut remarks: Vec<Remark> = overridden.collect();
        for (rule, used) in self.used.iter().enumerate() {
            if *used || pairs.iter().any(|p| p.0 == rule) {
                continue;
            }
            let why = self.inapplicable[rule].clone().unwrap_or_else(|| "other settings or inner rules always apply instead".to_owned());
            remarks.push(Remark::Unused { rule, why });
        }
        remarks
    }

    /// Joins the effects in another layout of the same mesh (faces that share no nodes): a rule is inapplicable only where it is in both.
    pub(super) fn join(&mut self, other: &Self) {
        for (a, b) in self.used.iter_mut().zip(&other.used) {
            *a |= b;
        }
        for (a, b) in self.inapplicable.iter_mut().zip(&other.inapplicable) {
            if b.is_none() {
                *a = None;
            }
        }
        self.overridden.extend(&other.overridden);
    }
}
