//! Which setting decides each segment: rules by rank, written counts shared out, demands of size, chord and angle.

use std::f64::consts::FRAC_PI_3;

use crate::base::digest::StableHasher;
use crate::base::fault::Result;
use crate::base::limits::{MESH_ELEMENTS, MESH_STEPS};
use crate::base::origin::Origin;
use crate::base::par;
use crate::base::text::article;
use crate::base::tolerance::WHOLE_NUMBER;
use crate::mesh::border::counts::{share, steps};
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::data::face_mesh::FaceMesh;
use crate::mesh::deviation::curve::{least_steps, wanted_steps};
use crate::mesh::request::decider::Why;
use crate::mesh::request::fault::MeshFault;
use crate::mesh::request::input::Input;
use crate::mesh::request::limits::Limits;
use crate::mesh::request::methods::Elements;
use crate::mesh::request::plan::{Plan, Rule, Target};
use crate::mesh::request::recall::RecallSteps;
use crate::mesh::request::size_requests::{SizeRequests, least_on};
use crate::mesh::size::border_spacing::{self, BorderSpacing, SPACING, SpacingInput};
use crate::mesh::size::proximity::Narrow;
use crate::mesh::size::remark::Remark;
use crate::model::Course;
use crate::model::segments::SegmentUse;
use crate::network::Chain;

/// Largest count of one segment; a mesh has no more elements than that.
pub const MOST: u32 = MESH_ELEMENTS as u32;

/// What a rule says of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Division {
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

/// The settings of one segment.
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
    /// The wanted count.
    pub demand: u32,
}

/// Decisions for all segments, and which rules have decided something so far.
#[derive(Clone, Debug, Default)]
pub struct Sizing {
    /// One a segment.
    pub decisions: Vec<Decision>,
    /// One a rule, then one a `near` or `in` clause, then one a setting of free faces: whether it was taken anywhere.
    pub taken: Vec<bool>,
    /// Why a rule cannot be taken at all, in words.
    pub homeless: Vec<Option<String>>,
    /// Steps of segments that follow the bends of the faces beside them.
    pub spacings: Vec<Option<BorderSpacing>>,
    /// Steps that segments of mapped faces would have to take for the free faces beside them.
    pub required_on_mapped: Vec<Option<BorderSpacing>>,
    /// The bias rule of each segment.
    pub bias_rule: Vec<Option<usize>>,
    /// What `near`, `in` and `min_size` ask for.
    pub wanted: SizeRequests,
    /// What is to be said of sharp angles.
    pub sharp: Option<Remark>,
    overridden: Vec<(usize, usize, &'static str)>,
}

/// One step more than a segment may have: enough to refuse it.
const STEPS: u32 = MESH_STEPS + 1;

/// Steps under a bias that are looked at one by one.
const MOST_BIASED: u32 = 1 << 20;

const LINK: u8 = 3;
const CURVE: u8 = 2;
const PATCH: u8 = 1;
const FACE: u8 = 0;

/// Settles a rule against what is there: inner rules win, of equal ones the later.
fn settle<T>(slot: &mut Option<Ruled<T>>, new: Ruled<T>, key: &'static str, overridden: &mut Vec<(usize, usize, &'static str)>) {
    if let Some(old) = slot {
        if old.rank > new.rank {
            return;
        }
        if old.rank == new.rank && old.rule != new.rule {
            overridden.push((old.rule, new.rule, key));
        }
    }
    *slot = Some(new);
}

impl Sizing {
    /// Decides every segment of a layout; faces get their size, elements and method. `narrow` are places where the borders of
    /// free faces, divided before, were found too near to each other.
    pub fn new(input: &Input, layout: &mut Layout, size: f64, (recall, narrow): (&RecallSteps, &[Narrow])) -> Result<Self> {
        let n = layout.pieces.segments.len();
        let rules = &input.plan.rules;
        let clauses = rules.len() + input.plan.refines.len() + FREE_ONLY.len();
        let wanted = SizeRequests::new(input, size)?;
        let mut sizing = Self { taken: vec![false; clauses], homeless: vec![None; clauses], wanted, ..Self::default() };
        sizing.faces(input, layout, size);
        crate::mesh::size::choose::choose(input, layout)?;
        sizing.free_only(input, layout);
        let refined = sizing.refine_mapped(input, layout);
        let mut division: Vec<Option<Ruled<Division>>> = vec![None; n];
        let mut bias: Vec<Option<Ruled<f64>>> = vec![None; n];
        for (index, rule) in rules.iter().enumerate() {
            match &rule.target {
                Target::Chain(chain) => {
                    let (uses, links) = segments_of(input, layout, chain);
                    let rank = if links.len() == 1 && chain.whole_curve().is_none() { LINK } else { CURVE };
                    let lines = [Lines { uses, links, rank, length: chain.length() }];
                    sizing.line_rule((index, rule, "curve"), input.tolerance.point, &lines, &mut division, &mut bias)?;
                }
                Target::Edge(courses) => {
                    let lines = along_courses(layout, courses);
                    sizing.line_rule((index, rule, "edge"), input.tolerance.point, &lines, &mut division, &mut bias)?;
                }
                Target::Surface(_) | Target::Patches(_) => {
                    sizing.face_counts((layout, input.tolerance.point), (index, rule), &mut division)?
                }
                Target::Point(_) => {}
            }
        }
        let own = own_sizes(layout, size);
        let limits = Limits::of(input);
        let rows = crate::mesh::size::gaps::rows(input, layout, &limits);
        crate::mesh::size::gaps::refuse(input, layout, &limits, &rows)?;
        let near = input.tolerance.point;
        let shape = shapes(layout, near);
        let count_of = |k: usize| division[k].and_then(|d| if let Division::Count(c) = d.value { Some((c, d.rule)) } else { None });
        let size_of = |k: usize| match division[k] {
            Some(Ruled { value: Division::Size(s), rule, .. }) => (s, Some(rule)),
            _ => own[k],
        };
        for (face, clause) in layout.faces.iter().zip(refined) {
            let open = face.sides.iter().flat_map(|s| s.segments()).any(|k| count_of(k).is_none());
            if let Some(clause) = clause.filter(|_| open) {
                sizing.taken[clause] = true;
            }
        }
        let bias_of = |k: usize| bias[k].map_or(1.0, |b| b.value);
        let biased: Vec<Option<u32>> = par::map(n, |k| {
            let free = bias[k].is_some() && count_of(k).is_none();
            free.then(|| sizing.biased_steps(layout, (k, near), size_of(k).0, bias_of(k)))
        });
        let written_steps = |k: usize| Some(BorderSpacing::of_count(layout.length(k), count_of(k).map(|c| c.0).or(biased[k])?, bias_of(k)));
        let written: Vec<Option<BorderSpacing>> = (0..n).map(written_steps).collect();
        let sizes: Vec<f64> = (0..n).map(|k| size_of(k).0).collect();
        let ask = SpacingInput { wanted: &sizing.wanted, limits: &limits, size: &sizes, written: &written, narrow, rows: &rows };
        (sizing.spacings, sizing.required_on_mapped) = border_spacing::along(input, layout, &ask)?;
        drop(rows);
        sizing.mark_refined(input, layout, &sizes);
        let sparing = sparing_borders(input, layout, &limits);
        // No element has more than four steps of borders.
        let most = STEPS.min(u32::try_from(input.plan.most_elements).unwrap_or(STEPS).saturating_mul(4).saturating_add(1));
        let least = par::try_map(n, |k| {
            let bias = bias_of(k);
            let divided = |count: u32| sizing.spacings[k].as_ref().map_or_else(|| steps(count, bias), |spacing| spacing.steps(count));
            let limits = if sparing[k] { limits.turning(TURN) } else { limits };
            let segment = &layout.pieces.segments[k];
            let key = || {
                let track = &layout.parts[segment.track].track;
                StableHasher::new("steps").with(&(track, segment.s, (bias, &limits, u64::from(most)))).finish()
            };
            let make = || least_steps(layout, k, &divided, &limits, most);
            // Without a limit there is nothing to find out; a spacing is not in the key.
            let is_worth = (limits.chord.is_some() || limits.angle.is_some()) && sizing.spacings[k].is_none();
            let least = if is_worth { recall(&key, &make) } else { make() };
            least.map(|least| least.max(shape[k]))
        })?;
        for k in 0..n {
            let (count, size, bias) = (count_of(k), size_of(k), bias_of(k));
            let demand = match (&sizing.spacings[k], biased[k]) {
                (Some(spacing), _) => spacing.demand((layout.length(k) - near).max(0.0), size.0, STEPS),
                (None, Some(steps)) => steps,
                (None, None) => wanted_steps((layout.length(k), near), size.0, bias, STEPS),
            };
            if count.is_none() && least[k] <= MESH_STEPS {
                sizing.refuse_below_floor(input, layout, k, (least[k], shape[k]))?;
            }
            let demand = demand.max(least[k]);
            sizing.decisions.push(Decision { count, size, bias, least: least[k], demand });
        }
        sizing.bias_rule = bias.iter().map(|b| b.map(|b| b.rule)).collect();
        crate::mesh::size::too_large::refuse_steps(input, layout, &sizing)?;
        Ok(sizing)
    }

    /// Settings that only faces made freely know: taken where there are some, or where nobody wrote them.
    fn free_only(&mut self, input: &Input, layout: &Layout) {
        let plan = input.plan;
        let free = layout.faces.iter().any(|face| face.free);
        let first = plan.rules.len() + plan.refines.len();
        for (k, key) in FREE_ONLY.into_iter().enumerate() {
            let idle = free_only_origin(plan, key).is_some() && !free && (key == "smooth" || plan.refines.is_empty());
            self.taken[first + k] = !idle;
            self.homeless[first + k] = idle.then(|| format!("`{key}` is for freely meshed faces, and there is none here"));
        }
    }

    /// The nodes of a segment with so many steps, as fractions of its length from 0 to 1.
    pub fn fractions(&self, segment: usize, count: u32) -> Vec<f64> {
        match &self.spacings[segment] {
            Some(spacing) => spacing.steps(count),
            None => steps(count, self.decisions[segment].bias),
        }
    }

    /// Lowers the sizes of mapped faces to the least that is asked for on them; gives the clause of each that was.
    fn refine_mapped(&self, input: &Input, layout: &mut Layout) -> Vec<Option<usize>> {
        let sources = &self.wanted.sources;
        let faces = &layout.faces;
        let found = par::map(faces.len(), |f| {
            let face = &faces[f];
            let patch = &input.model.patches[face.patch.index()];
            let surface = &input.model.surfaces[face.surface.index()].surface;
            if face.free { None } else { least_on(surface, (patch.u, patch.v), sources, face.size.0) }
        });
        let clause = |item: u32| input.plan.rules.len() + sources.items()[item as usize].tag as usize;
        layout.faces.iter_mut().zip(found).for_each(|(face, least)| {
            if let Some(least) = least {
                face.size = (least.size, Some(clause(least.item)));
            }
        });
        let first = input.plan.rules.len();
        layout.faces.iter().map(|face| face.size.1.filter(|clause| *clause >= first && !face.free)).collect()
    }

    /// Steps of a segment under a bias, none of them longer than the size or what is wanted along it.
    fn biased_steps(&self, layout: &Layout, (k, near): (usize, f64), size: f64, bias: f64) -> u32 {
        let length = (layout.length(k) - near).max(0.0);
        let mut count = wanted_steps((layout.length(k), near), size, bias, STEPS);
        while count < MOST_BIASED && !self.wanted.sources.is_empty() {
            let over = steps(count, bias).windows(2).fold(1.0, |over: f64, w| {
                let there = w.iter().map(|f| self.wanted.sources.at(layout.point(k, *f), size));
                over.max((w[1] - w[0]) * length / there.fold(0.0, f64::max))
            });
            if over <= 1.0 + WHOLE_NUMBER {
                break;
            }
            count = ((f64::from(count) * over).min(f64::from(STEPS)) as u32).max(count + 1);
        }
        count
    }

    /// Marks the clauses that make steps of segments shorter.
    fn mark_refined(&mut self, input: &Input, layout: &Layout, sizes: &[f64]) {
        let first = input.plan.rules.len();
        for (k, spacing) in self.spacings.iter().enumerate() {
            let places = spacing.iter().flat_map(|spacing| spacing.places()).map(|f| layout.point(k, f));
            for p in places {
                if let Some(least) = self.wanted.sources.who(p, sizes[k]) {
                    self.taken[first + self.wanted.sources.items()[least.item as usize].tag as usize] = true;
                }
            }
        }
    }

    /// E707 where a limit asks for steps below the floor of the size.
    fn refuse_below_floor(&self, input: &Input, layout: &Layout, k: usize, (least, shape): (u32, u32)) -> Result<()> {
        let length = layout.length(k);
        if least <= shape || length / f64::from(least) >= self.wanted.written * (1.0 - WHOLE_NUMBER) {
            return Ok(());
        }
        Err(crate::mesh::request::size_requests::floor_keeps(input, length / f64::from(least), layout.point(k, 0.5)))
    }

    /// Size, elements and method of faces.
    fn faces(&mut self, input: &Input, layout: &mut Layout, size: f64) {
        for face in &mut layout.faces {
            face.size = (size, None);
            let mut last: [Option<usize>; 3] = [None; 3];
            let rules = input.plan.rules.iter().enumerate();
            let mut own: Vec<_> = rules.filter_map(|(n, r)| r.target.faces(face.patch, face.surface).map(|alone| (alone, n, r))).collect();
            // A rule on the face alone wins over one on its surface.
            own.sort_by_key(|(alone, index, _)| (*alone, *index));
            let alone = |index: usize| matches!(input.plan.rules[index].target, Target::Patches(_));
            for (_, index, rule) in own {
                let says = [rule.settings.size.is_some(), rule.settings.elements.is_some(), rule.settings.method.is_some()];
                for (k, key) in ["size", "elements", "method"].into_iter().enumerate() {
                    if says[k]
                        && let Some(old) = last[k].replace(index)
                        && alone(old) == alone(index)
                    {
                        self.overridden.push((old, index, key));
                    }
                }
            }
            let rule = |k: usize| last[k].map(|i: usize| (i, &input.plan.rules[i]));
            if let Some((i, (s, _))) = rule(0).and_then(|(i, r)| r.settings.size.map(|s| (i, s))) {
                face.size = (s, Some(i));
            }
            if let Some((i, (e, _))) = rule(1).and_then(|(i, r)| r.settings.elements.map(|e| (i, e))) {
                face.elements = e;
                self.taken[i] = true;
            }
            if let Some((i, (m, _))) = rule(2).and_then(|(i, r)| r.settings.method.map(|m| (i, m))) {
                face.method = m;
                self.taken[i] = true;
            }
        }
        for (index, rule) in input.plan.rules.iter().enumerate() {
            let what = match rule.target {
                Target::Surface(_) => "surface",
                Target::Patches(_) => "face",
                Target::Chain(_) | Target::Edge(_) | Target::Point(_) => "",
            };
            if !what.is_empty() {
                if !layout.faces.iter().any(|f| rule.target.faces(f.patch, f.surface).is_some()) {
                    self.homeless[index] = Some(format!("that {what} is not in this mesh"));
                } else if rule.settings.bias.is_some()
                    && rule.settings.count.is_none()
                    && rule.settings.size.is_none()
                    && rule.settings.elements.is_none()
                    && rule.settings.method.is_none()
                {
                    self.homeless[index] = Some("`bias` grows the steps along a curve, this is a face".to_owned());
                }
            }
        }
    }

    /// A rule on a curve, chain, link or edge, by the lines in the mesh that are it.
    fn line_rule(
        &mut self,
        (index, rule, what): (usize, &Rule, &str),
        near: f64,
        lines: &[Lines],
        division: &mut [Option<Ruled<Division>>],
        bias: &mut [Option<Ruled<f64>>],
    ) -> Result<()> {
        if lines.iter().all(|line| line.uses.is_empty()) {
            let where_to = if what == "curve" { "on no edge of this mesh" } else { "on no face of this mesh" };
            self.homeless[index] = Some(format!("that {what} is {where_to}"));
            return Ok(());
        }
        if rule.settings.count.is_none() && rule.settings.size.is_none() && rule.settings.bias.is_none() {
            self.homeless[index] = Some(format!("`elements` and `method` apply to faces, this is {} {what}", article(what)));
            return Ok(());
        }
        for Lines { uses, links, rank, length } in lines {
            let rank = *rank;
            if let Some((count, origin)) = rule.settings.count {
                let shares = count_shares(uses, links, (count, near))
                    .map_err(|links| MeshFault::CountBelowLinks { count: (count, origin), links })?;
                for (u, n) in uses.iter().zip(shares) {
                    settle(&mut division[u.segment], Ruled { rank, rule: index, value: Division::Count(n) }, "count", &mut self.overridden);
                }
            } else if let Some((size, _)) = rule.settings.size {
                for u in uses {
                    settle(
                        &mut division[u.segment],
                        Ruled { rank, rule: index, value: Division::Size(size) },
                        "size",
                        &mut self.overridden,
                    );
                }
            }
            if let Some((b, _)) = rule.settings.bias {
                for u in uses {
                    // Steps that grow geometrically have a size that is linear in the length.
                    let grown = |s: f64| 1.0 + (b - 1.0) * (s / length).clamp(0.0, 1.0);
                    let local = grown(u.s.1) / grown(u.s.0);
                    let value = if u.against { 1.0 / local } else { local };
                    settle(&mut bias[u.segment], Ruled { rank, rule: index, value }, "bias", &mut self.overridden);
                }
            }
        }
        Ok(())
    }

    /// A count on a surface or a face is for each of its sides.
    fn face_counts(
        &mut self,
        (layout, near): (&Layout, f64),
        (index, rule): (usize, &Rule),
        division: &mut [Option<Ruled<Division>>],
    ) -> Result<()> {
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
            let shares = share(count, (&weights, near), &least)
                .ok_or(MeshFault::CountBelowLinks { count: (count, origin), links: segments.len() as u32 })?;
            for (s, n) in segments.iter().zip(shares) {
                let rank = if matches!(rule.target, Target::Patches(_)) { PATCH } else { FACE };
                settle(&mut division[*s], Ruled { rank, rule: index, value: Division::Count(n) }, "count", &mut self.overridden);
            }
        }
        Ok(())
    }

    /// Notes which rules the final counts go back to; `counts` are of the segments.
    pub fn take(&mut self, counts: &[u32]) {
        for (k, d) in self.decisions.iter().enumerate() {
            match d.count {
                Some((_, rule)) => self.taken[rule] = true,
                None => {
                    if let (_, Some(rule)) = d.size
                        && d.demand == counts[k]
                        && d.demand > d.least
                    {
                        self.taken[rule] = true;
                    }
                }
            }
            if let Some(rule) = self.bias_rule[k]
                && counts[k] > 1
                && d.bias != 1.0
            {
                self.taken[rule] = true;
            }
        }
    }

    /// Notes which clauses decide sizes inside free faces.
    pub fn take_refined(&mut self, input: &Input, prepared: &[FaceMesh]) {
        for decider in prepared.iter().filter_map(|ready| ready.inside.as_ref()).flat_map(|inside| &inside.deciders) {
            if let Why::Refined(clause) = decider.why {
                self.taken[input.plan.rules.len() + clause] = true;
            }
        }
    }

    /// W706 for rules overridden by equal ones, W701 for rules without effect.
    pub fn remarks(&self) -> Vec<Remark> {
        let mut pairs = self.overridden.clone();
        pairs.sort_unstable();
        pairs.dedup();
        let overridden = pairs.iter().map(|&(earlier, later, key)| Remark::Overridden { key: key.to_owned(), earlier, later });
        let mut remarks: Vec<Remark> = overridden.collect();
        for (rule, taken) in self.taken.iter().enumerate() {
            if *taken || pairs.iter().any(|p| p.0 == rule) {
                continue;
            }
            let why = self.homeless[rule].clone().unwrap_or_else(|| "other settings or inner rules always apply instead".to_owned());
            remarks.push(Remark::Unused { rule, why });
        }
        remarks.extend(self.sharp.clone());
        remarks
    }

    /// Joins what another layout of the same mesh has taken (faces that share no nodes).
    pub fn join(&mut self, other: &Self) {
        for (a, b) in self.taken.iter_mut().zip(&other.taken) {
            *a |= b;
        }
        for (a, b) in self.homeless.iter_mut().zip(&other.homeless) {
            // A rule is homeless only where no layout knows its entity.
            if b.is_none() {
                *a = None;
            }
        }
        self.overridden.extend(&other.overridden);
        self.sharp = match (self.sharp.take(), other.sharp.clone()) {
            (Some(a), Some(b)) => Some(a.sharper(b)),
            (a, b) => a.or(b),
        };
    }
}

/// Settings of the whole mesh that only faces made freely know; they follow the clauses in [`Sizing::taken`].
pub(crate) const FREE_ONLY: [&str; 2] = ["smooth", "growth"];

/// Where one of them is written.
pub(crate) fn free_only_origin(plan: &Plan, key: &str) -> Option<Origin> {
    if key == "smooth" { plan.settings.smooth.map(|n| n.1) } else { plan.settings.growth.map(|g| g.1) }
}

/// Settings of which one rule may override another.
pub(crate) const KEYS: [&str; 5] = ["count", "size", "bias", "elements", "method"];

/// The size of each segment by its faces: the least of theirs, `size` where it has none. Steps on borders of freely grown
/// triangles alone are as long as distances of nodes inside: triangles between rows of one length are the best ones.
fn own_sizes(layout: &Layout, size: f64) -> Vec<(f64, Option<usize>)> {
    let mut grown = vec![true; layout.pieces.segments.len()];
    layout.faces.iter().filter(|f| !f.is_grown()).flat_map(Face::segments).for_each(|k| grown[k] = false);
    let mut own: Vec<Option<(f64, Option<usize>)>> = vec![None; grown.len()];
    for face in &layout.faces {
        for k in face.segments() {
            let step = (if grown[k] { face.size.0 * SPACING } else { face.size.0 }, face.size.1);
            if own[k].is_none_or(|least| step.0 < least.0) {
                own[k] = Some(step);
            }
        }
    }
    own.into_iter().map(|own| own.unwrap_or((size, None))).collect()
}

/// Largest turn of a border across one step where triangles may be as long as the chord error lets them, radians: 60°. What
/// stands beside a step that turns more leans over the surface, however small it is.
const TURN: f64 = FRAC_PI_3;

/// Stretches whose steps a chord error alone may make so long that triangles beside them lean: those of bent faces made with
/// as few triangles as may be.
fn sparing_borders(input: &Input, layout: &Layout, limits: &Limits) -> Vec<bool> {
    let mut found = vec![false; layout.pieces.segments.len()];
    let bent = |face: &&Face| !input.model.surfaces[face.surface.index()].surface.is_flat();
    if limits.chord.is_some() {
        let faces = layout.faces.iter().filter(|face| face.method.is_coarse()).filter(bent);
        faces.flat_map(|face| face.segments()).for_each(|k| found[k] = true);
    }
    found
}

/// Least steps of the borders of a face that is made freely between two poles, before they are halved: with fewer there may be
/// nothing inside.
const CLOSED: u32 = 4;

/// Least counts that keep segments from falling on each other: 3 for a ring; of several with the same ends the shortest may
/// be one step, as a blunt trailing edge is, and the others take 2.
fn shapes(layout: &Layout, near: f64) -> Vec<u32> {
    let ends = |k: usize| {
        let (a, b) = layout.pieces.segments[k].ends;
        (a.min(b), a.max(b))
    };
    let n = layout.pieces.segments.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|k| (ends(*k), *k));
    // Free quads come from cells whose sides are two steps, or one where a count is odd; those may not fall together either.
    let mut halved = vec![false; n];
    layout.faces.iter().filter(|f| f.takes_quads()).flat_map(|f| f.segments()).for_each(|s| halved[s] = true);
    let mut least = vec![1; n];
    for group in order.chunk_by(|a, b| ends(*a) == ends(*b)) {
        let length = |k: &usize| layout.pieces.segments[*k].length();
        let shortest = group.iter().map(length).fold(f64::INFINITY, f64::min);
        let alike = group.iter().filter(|k| length(k) <= shortest * (1.0 + WHOLE_NUMBER) + near).count();
        for k in group {
            let (a, b) = ends(*k);
            let sides = match () {
                () if a == b => 3,
                () if group.len() == 1 || (alike == 1 && length(k) == shortest) => 1,
                () => 2,
            };
            least[*k] = if halved[*k] { 2 * sides - 1 } else { sides };
        }
    }
    for face in layout.faces.iter().filter(|face| face.free) {
        let poles = face.sides.iter().filter(|side| side.uses.is_empty()).count();
        if face.halved > 0 || poles == 2 && face.sides.len() == 4 {
            face.segments().for_each(|k| least[k] = least[k].max(CLOSED << face.halved));
        }
    }
    least
}

/// A line that a rule speaks of, as it is in the mesh.
struct Lines {
    /// Its segments along it.
    uses: Vec<SegmentUse>,
    /// Its links with their segments; what is no run of links is one.
    links: Vec<LinkRange>,
    rank: u8,
    /// Arc length, model units.
    length: f64,
}

/// The borders that an edge is in the mesh, each segment once.
fn along_courses(layout: &Layout, courses: &[Course]) -> Vec<Lines> {
    let mut known: Vec<usize> = Vec::new();
    let mut lines = Vec::new();
    for course in courses {
        let mut uses = layout.along_course(course);
        uses.retain(|u| !known.contains(&u.segment));
        known.extend(uses.iter().map(|u| u.segment));
        let length: f64 = course.iter().map(|part| part.s.1 - part.s.0).sum();
        if !uses.is_empty() {
            let links = vec![LinkRange { length, uses: 0..uses.len() }];
            lines.push(Lines { uses, links, rank: CURVE, length });
        }
    }
    lines
}

/// Stretches of a chain and of its links, which hold all of them.
fn segments_of(input: &Input, layout: &Layout, chain: &Chain) -> (Vec<SegmentUse>, Vec<LinkRange>) {
    let uses = layout.along(input, chain);
    let Some(links) = links_of(input, chain) else {
        let all = 0..uses.len();
        return (uses, vec![LinkRange { length: chain.length(), uses: all }]);
    };
    let (mut ranges, mut start, mut from) = (Vec::new(), 0.0, 0);
    for (n, s) in links.iter().enumerate() {
        let end = if n + 1 == links.len() { f64::INFINITY } else { start + (s.1 - s.0) };
        let to = from + uses[from..].iter().take_while(|u| 0.5 * (u.s.0 + u.s.1) < end).count();
        ranges.push(LinkRange { length: s.1 - s.0, uses: from..to });
        (start, from) = (end, to);
    }
    (uses, ranges)
}

/// Arc lengths of the links of a chain on their curves.
pub fn links_of(input: &Input, chain: &Chain) -> Option<Vec<(f64, f64)>> {
    let links = input.network.links_of(chain, input.tolerance)?;
    Some(links.into_iter().map(|(link, _)| input.network.links[link.index()].s).collect())
}

/// One link of a chain with its segments.
struct LinkRange {
    length: f64,
    uses: std::ops::Range<usize>,
}

/// A count shared out to links by length, then to the segments of each link; `Err`: how many segments there are.
fn count_shares(uses: &[SegmentUse], links: &[LinkRange], (count, near): (u32, f64)) -> std::result::Result<Vec<u32>, u32> {
    let least: Vec<u32> = links.iter().map(|l| (l.uses.len() as u32).max(1)).collect();
    let weights: Vec<f64> = links.iter().map(|l| l.length).collect();
    let by_link = share(count, (&weights, near), &least).ok_or(least.iter().sum::<u32>())?;
    let mut shares = Vec::new();
    for (n, link) in by_link.iter().zip(links) {
        let lengths: Vec<f64> = uses[link.uses.clone()].iter().map(|u| u.s.1 - u.s.0).collect();
        // A link of which only a part is meshed gives that part its share.
        let covered: f64 = lengths.iter().sum::<f64>() / link.length;
        let own = ((f64::from(*n) * (covered + near / link.length) + 0.5).floor() as u32).max(lengths.len() as u32);
        shares.extend(share(own, (&lengths, near), &vec![1; lengths.len()]).unwrap_or_default());
    }
    Ok(shares)
}

/// The elements of a face, as `-v` has it.
pub fn elements_name(elements: Elements) -> &'static str {
    match elements {
        Elements::Triangles => "triangles",
        Elements::Quads => "quads",
        Elements::Mixed => "mixed",
    }
}
