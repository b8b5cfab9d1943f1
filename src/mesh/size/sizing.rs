//! Which setting decides each segment: rules by rank, written counts shared out, demands of size, chord and angle.

use crate::base::fault::Result;
use crate::base::limits::{MESH_ELEMENTS, MESH_STEPS};
use crate::base::par;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::counts::steps;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::deviation::curve::wanted_steps;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::recall::RecallSteps;
use crate::mesh::request::size_requests::{SizeRequests, floor_keeps};
use crate::mesh::request::sources::Sources;
use crate::mesh::size::border_spacing::{BorderSpacing, BorderSpacings};
use crate::mesh::size::choose::choose;
use crate::mesh::size::face_settings::{apply_rules, refine_mapped, sizes_of_segments};
use crate::mesh::size::least_counts::{self, MAX_COUNT};
use crate::mesh::size::proximity::Narrow;
use crate::mesh::size::remark::Remark;
use crate::mesh::size::row_spacing::UnevenRows;
use crate::mesh::size::rule_effects::RuleEffects;
use crate::mesh::size::segment_rules::{SegmentRules, SegmentSettings};
use crate::mesh::size::sliding_segments::SlidingSegments;
use crate::mesh::size::spacing_solver::{SpacingInput, spacings};
use crate::mesh::size::{gaps, too_large};

/// Largest count of one segment; a mesh has no more elements than that.
pub const MOST: u32 = MESH_ELEMENTS as u32;

/// Counts under a bias up to which each is tried.
const MAX_BIASED: u32 = 1 << 20;

/// Steps of a ring in a plane face of quads are a multiple of this: two for each side of a cell, and as many cells along one side of a
/// hole as along the other.
pub const STEPS_OF_RING: u32 = 4;

/// What decides the steps of one segment.
#[derive(Clone, Copy, Debug)]
pub struct Decision {
    /// A written count and its rule.
    pub count: Option<(u32, usize)>,
    /// Target size, and the rule unless it is the mesh's own.
    pub size: (f64, Option<usize>),
    /// Last step over first step, along the segment.
    pub bias: f64,
    /// The least count for chord and angle on the segment itself.
    pub least: u32,
    /// The demanded count, `least` or more.
    pub demand: u32,
    /// What was demanded before that was raised to a multiple of [`STEPS_OF_RING`].
    pub unrounded: u32,
}

/// Decisions for all segments, and which rules have decided something so far.
#[derive(Clone, Debug, Default)]
pub struct Sizing {
    /// One a segment.
    pub decisions: Vec<Decision>,
    /// Which rules, clauses and settings have an effect.
    pub effects: RuleEffects,
    /// Steps of segments that follow the bends of the faces beside them.
    pub spacings: BorderSpacings,
    /// Steps that segments of mapped faces would have to have for the free faces beside them.
    pub required_on_mapped: BorderSpacings,
    /// Numbers of rows of mapped faces whose rows are uneven.
    pub rows: UnevenRows,
    /// Steps without a bias may vary: a bias of 1 keeps them even.
    pub may_vary: bool,
    /// Segments whose nodes may slide.
    pub sliding: SlidingSegments,
    /// The bias rule of each segment.
    pub bias_rule: Vec<Option<usize>>,
    /// Sizes requested by `near`, `in` and `min_size`.
    pub wanted: SizeRequests,
    /// The remark on sharp angles.
    pub sharp: Option<Remark>,
}

impl Sizing {
    /// Decides every segment of a layout; faces get their size, elements and method. `narrow` are places where the borders of
    /// free faces, divided before, were found too near to each other.
    pub fn new(input: &Input, layout: &mut Layout, size: f64, recall: &RecallSteps, narrow: &[Narrow]) -> Result<Self> {
        let wanted = SizeRequests::new(input, size)?;
        let mut effects = RuleEffects::new(input.plan);
        apply_rules(input, layout, size, &mut effects);
        choose(input, layout)?;
        effects.check_free_only(input, layout);
        let refined = refine_mapped(input, layout, &wanted.sources);
        let rules = SegmentRules::new(input, layout, &mut effects)?;
        let of_faces = sizes_of_segments(input, layout, size);
        let settings: Vec<SegmentSettings> = of_faces.into_iter().enumerate().map(|(k, size)| rules.of_segment(k, size)).collect();
        for (face, clause) in layout.faces.iter().zip(refined) {
            let open = face.sides.iter().flat_map(|s| s.segments()).any(|k| settings[k].count.is_none());
            if let Some(clause) = clause.filter(|_| open) {
                effects.mark_used(clause);
            }
        }
        let mut sizing = Self { effects, wanted, ..Self::default() };
        sizing.decide(input, layout, &settings, recall, narrow)?;
        sizing.bias_rule = settings.iter().map(|s| s.bias_rule).collect();
        sizing.sliding = SlidingSegments::new(input, layout, &sizing);
        too_large::refuse_steps(input, layout, &sizing)?;
        Ok(sizing)
    }

    /// Finds the spacing of each segment, and its counts by the settings of rules and faces.
    fn decide(
        &mut self,
        input: &Input,
        layout: &Layout,
        settings: &[SegmentSettings],
        recall: &RecallSteps,
        narrow: &[Narrow],
    ) -> Result<()> {
        let near = input.tolerance.point;
        let sizes: Vec<f64> = settings.iter().map(|s| s.size.0).collect();
        let biased = self.find_spacings(input, layout, settings, &sizes, narrow)?;
        self.effects.mark_spacings(input, layout, &self.spacings, &self.wanted.sources, &sizes);
        let biases: Vec<f64> = settings.iter().map(|s| s.bias).collect();
        let apart = least_counts::to_keep_apart(layout, near);
        let least = least_counts::for_limits(input, layout, &biases, &self.spacings, recall)?;
        let rings = rings_of_squares(input, layout);
        for (k, &SegmentSettings { count, size, bias, .. }) in settings.iter().enumerate() {
            let least = least[k].max(apart[k]);
            let demand = match (&self.spacings[k], biased[k]) {
                (Some(spacing), _) => spacing.demand((layout.length(k) - near).max(0.0), size.0, MAX_COUNT),
                (None, Some(steps)) => steps,
                (None, None) => wanted_steps(layout.length(k), near, size.0, bias, MAX_COUNT),
            };
            if count.is_none() && least <= MESH_STEPS {
                self.refuse_below_floor(input, layout, k, least, apart[k])?;
            }
            let unrounded = demand.max(least);
            self.decisions.push(Decision { count, size, bias, least, demand: rounded(unrounded, rings[k]), unrounded });
        }
        Ok(())
    }

    /// Finds the spacings of segments whose steps vary, and those that segments of mapped faces would need; gives the counts of those
    /// that have a bias and no written count. `sizes` are those of the segments, model units.
    fn find_spacings(
        &mut self,
        input: &Input,
        layout: &Layout,
        settings: &[SegmentSettings],
        sizes: &[f64],
        narrow: &[Narrow],
    ) -> Result<Vec<Option<u32>>> {
        let limits = Limits::of(input);
        let rows = gaps::rows(input, layout, &limits);
        gaps::refuse(input, layout, &limits, &rows)?;
        let biased: Vec<Option<u32>> = par::map(settings.len(), |k| {
            let open = settings[k].bias_rule.is_some() && settings[k].count.is_none();
            open.then(|| biased_steps(layout, k, input.tolerance.point, &settings[k], &self.wanted.sources))
        });
        let written = settings.iter().zip(&biased).enumerate().map(|(k, (s, biased))| {
            let count = s.count.map(|c| c.0).or(*biased)?;
            Some(BorderSpacing::of_count(layout.length(k), count, s.bias))
        });
        let written: Vec<Option<BorderSpacing>> = written.collect();
        let given = SpacingInput { wanted: &self.wanted, limits: &limits, size: sizes, written: &written, narrow, rows: &rows };
        self.may_vary = limits.chord.is_some() || limits.angle.is_some() || !self.wanted.sources.is_empty();
        let found = spacings(input, layout, &given)?;
        (self.spacings, self.required_on_mapped, self.rows) = (found.of_segments, found.required_on_mapped, found.rows);
        if self.rows.iter().flatten().any(Option::is_some) {
            self.effects.mark_uneven_rows(input.plan);
        }
        Ok(biased)
    }

    /// Directions of a face with a side whose counts are all written out, along u and along v; of a face that has no rows both.
    pub fn written_directions(&self, face: &Face) -> [bool; 2] {
        if face.free {
            return [true; 2];
        }
        let sides = &face.sides;
        let all = |k: usize| !sides[k].uses.is_empty() && sides[k].uses.iter().all(|u| self.decisions[u.segment].count.is_some());
        if sides.len() == 3 { [(0..3).any(all); 2] } else { [all(0) || all(2), all(1) || all(3)] }
    }

    /// The nodes of a segment with so many steps, as fractions of its length from 0 to 1.
    pub fn fractions(&self, segment: usize, count: u32) -> Vec<f64> {
        match &self.spacings[segment] {
            Some(spacing) => spacing.steps(count),
            None => steps(count, self.decisions[segment].bias),
        }
    }

    /// Segments that these counts break a limit on, though fewer steps keep it, with the next count of each that does.
    pub fn broken(&self, input: &Input, layout: &Layout, counts: &[u32]) -> Result<Vec<(usize, u32)>> {
        least_counts::broken(input, layout, self, counts)
    }

    /// Raises the least counts of some segments; E707 where steps are then below the floor of the size.
    pub fn raise(&mut self, input: &Input, layout: &Layout, raised: &[(usize, u32)]) -> Result<()> {
        let rings = rings_of_squares(input, layout);
        for (k, least) in raised {
            let decision = &mut self.decisions[*k];
            if let (None, Some(rule)) = (decision.count, decision.size.1)
                && decision.unrounded > decision.least
            {
                // It asked for the steps that were raised.
                self.effects.mark_used(rule);
            }
            let unrounded = decision.unrounded.max(*least);
            (decision.least, decision.unrounded, decision.demand) = (*least, unrounded, rounded(unrounded, rings[*k]));
            if decision.count.is_none() {
                self.refuse_below_floor(input, layout, *k, *least, 0)?;
            }
        }
        Ok(())
    }

    /// E707 where limits demand steps below the floor of the size: more than `apart`, which keep segments apart.
    fn refuse_below_floor(&self, input: &Input, layout: &Layout, k: usize, least: u32, apart: u32) -> Result<()> {
        let length = layout.length(k);
        if least <= apart || length / f64::from(least) >= self.wanted.written * (1.0 - WHOLE_NUMBER) {
            return Ok(());
        }
        Err(floor_keeps(input, length / f64::from(least), layout.point(k, 0.5)))
    }

    /// Marks the rules that the final counts go back to; `counts` are of the segments.
    pub fn mark_used(&mut self, counts: &[u32]) {
        for (k, d) in self.decisions.iter().enumerate() {
            match d.count {
                Some((_, rule)) => self.effects.mark_used(rule),
                None => {
                    if let (_, Some(rule)) = d.size
                        && d.demand == counts[k]
                        && d.unrounded > d.least
                    {
                        self.effects.mark_used(rule);
                    }
                }
            }
            if let Some(rule) = self.bias_rule[k]
                && counts[k] > 1
                && (d.bias != 1.0 || self.may_vary || self.sliding.is_held_by_bias(k))
            {
                self.effects.mark_used(rule);
            }
        }
    }

    /// W706 for rules overridden by equal ones, W701 for rules without effect, W724 for sharp angles.
    pub fn remarks(&self) -> Vec<Remark> {
        let mut remarks = self.effects.remarks();
        remarks.extend(self.sharp.clone());
        remarks
    }

    /// Joins the effects and remarks of another layout of the same mesh (faces that share no nodes).
    pub fn join(&mut self, other: &Self) {
        self.effects.join(&other.effects);
        self.sharp = match (self.sharp.take(), other.sharp.clone()) {
            (Some(a), Some(b)) => Some(a.sharper(b)),
            (a, b) => a.or(b),
        };
    }
}

/// A demanded count, of a ring in a plane face of quads raised to a multiple of [`STEPS_OF_RING`].
fn rounded(count: u32, is_ring: bool) -> u32 {
    if is_ring && count < MAX_COUNT { count.next_multiple_of(STEPS_OF_RING) } else { count }
}

/// Rings round and in plane faces of free quads.
fn rings_of_squares(input: &Input, layout: &Layout) -> Vec<bool> {
    let mut found = vec![false; layout.pieces.segments.len()];
    let is_flat = |face: &&Face| input.model.surfaces[face.surface.index()].surface.is_flat();
    let ring = |k: &usize| layout.pieces.segments[*k].ends.0 == layout.pieces.segments[*k].ends.1;
    layout
        .faces
        .iter()
        .filter(|face| face.takes_quads())
        .filter(is_flat)
        .flat_map(Face::segments)
        .filter(ring)
        .for_each(|k| found[k] = true);
    found
}

/// Steps of a segment under a bias, none of them longer than the size or what is wanted along it.
fn biased_steps(layout: &Layout, k: usize, near: f64, settings: &SegmentSettings, sources: &Sources) -> u32 {
    let (size, bias) = (settings.size.0, settings.bias);
    let length = (layout.length(k) - near).max(0.0);
    let mut count = wanted_steps(layout.length(k), near, size, bias, MAX_COUNT);
    while count < MAX_BIASED && !sources.is_empty() {
        let over = steps(count, bias).windows(2).fold(1.0, |over: f64, w| {
            let there = w.iter().map(|f| sources.at(layout.point(k, *f), size));
            over.max((w[1] - w[0]) * length / there.fold(0.0, f64::max))
        });
        if over <= 1.0 + WHOLE_NUMBER {
            break;
        }
        count = ((f64::from(count) * over).min(f64::from(MAX_COUNT)) as u32).max(count + 1);
    }
    count
}
