//! Size, elements and method of each face by rules and clauses, and the size that a segment has of its faces.

use crate::base::par;
use crate::mesh::border::layout::{Face, Layout};
use crate::mesh::request::input::Input;
use crate::mesh::request::methods::Method;
use crate::mesh::request::plan::Target;
use crate::mesh::request::size_requests::least_on;
use crate::mesh::request::sources::Sources;
use crate::mesh::size::border_spacing::{PLANE_SQUARE_SPACING, SPACING, SQUARE_SPACING};
use crate::mesh::size::rule_effects::RuleEffects;

/// Gives faces their size, elements and method: those of the last rule on the face, else on its surface, else of the mesh.
pub fn apply_rules(input: &Input, layout: &mut Layout, size: f64, effects: &mut RuleEffects) {
    for face in &mut layout.faces {
        face.size = (size, None);
        let mut last: [Option<usize>; 3] = [None; 3];
        let rules = input.plan.rules.iter().enumerate();
        let mut own: Vec<_> = rules.filter_map(|(n, r)| r.target.faces(face.patch, face.surface).map(|alone| (alone, n, r))).collect();
        // A rule on the face alone wins over one on its surface.
        own.sort_by_key(|(alone, index, _)| (*alone, *index));
        let alone = |index: usize| matches!(input.plan.rules[index].target, Target::Patches(_));
        for (_, index, rule) in own {
            let written = [rule.settings.size.is_some(), rule.settings.elements.is_some(), rule.settings.method.is_some()];
            for (k, key) in ["size", "elements", "method"].into_iter().enumerate() {
                if written[k]
                    && let Some(old) = last[k].replace(index)
                    && alone(old) == alone(index)
                {
                    effects.note_override(old, index, key);
                }
            }
        }
        let rule = |k: usize| last[k].map(|i: usize| (i, &input.plan.rules[i]));
        if let Some((i, (s, _))) = rule(0).and_then(|(i, r)| r.settings.size.map(|s| (i, s))) {
            face.size = (s, Some(i));
        }
        if let Some((i, (e, _))) = rule(1).and_then(|(i, r)| r.settings.elements.map(|e| (i, e))) {
            face.elements = e;
            effects.mark_used(i);
        }
        if let Some((i, (m, _))) = rule(2).and_then(|(i, r)| r.settings.method.map(|m| (i, m))) {
            face.method = m;
            effects.mark_used(i);
        }
    }
    note_inapplicable(input, layout, effects);
}

/// Notes the rules on surfaces and faces that give no face a setting.
fn note_inapplicable(input: &Input, layout: &Layout, effects: &mut RuleEffects) {
    for (index, rule) in input.plan.rules.iter().enumerate() {
        let what = match rule.target {
            Target::Surface(_) => "surface",
            Target::Patches(_) => "face",
            Target::Chain(_) | Target::Edge(_) | Target::Point(_) => "",
        };
        if !what.is_empty() {
            if !layout.faces.iter().any(|f| rule.target.faces(f.patch, f.surface).is_some()) {
                effects.refuse(index, format!("that {what} is not in this mesh"));
            } else if rule.settings.bias.is_some()
                && rule.settings.count.is_none()
                && rule.settings.size.is_none()
                && rule.settings.elements.is_none()
                && rule.settings.method.is_none()
            {
                effects.refuse(index, "`bias` grows the steps along a curve, this is a face".to_owned());
            }
        }
    }
}

/// Lowers the sizes of mapped faces to the least length that `near` and `in` want on them; gives the clause of each that was lowered.
pub(super) fn refine_mapped(input: &Input, layout: &mut Layout, sources: &Sources) -> Vec<Option<usize>> {
    let faces = &layout.faces;
    let found = par::map(faces.len(), |f| {
        let face = &faces[f];
        let patch = &input.model.patches[face.patch.index()];
        let surface = &input.model.surfaces[face.surface.index()].surface;
        if face.free { None } else { least_on(surface, patch.u, patch.v, sources, face.size.0) }
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

/// The size of each segment by its faces: the least of theirs, `size` where it has none. Steps on borders of faces that are grown alone
/// are as long as distances of nodes inside: elements between rows of one length are the best ones.
pub(super) fn sizes_of_segments(input: &Input, layout: &Layout, size: f64) -> Vec<(f64, Option<usize>)> {
    let mut grown = vec![true; layout.pieces.segments.len()];
    layout.faces.iter().filter(|f| grown_spacing(input, f).is_none()).flat_map(Face::segments).for_each(|k| grown[k] = false);
    let mut own: Vec<Option<(f64, Option<usize>)>> = vec![None; grown.len()];
    for face in &layout.faces {
        for k in face.segments() {
            let spacing = grown_spacing(input, face).filter(|_| grown[k]).unwrap_or(1.0);
            let step = (face.size.0 * spacing, face.size.1);
            if own[k].is_none_or(|least| step.0 < least.0) {
                own[k] = Some(step);
            }
        }
    }
    own.into_iter().map(|own| own.unwrap_or((size, None))).collect()
}

/// Distance of the nodes of a grown lattice over the size; `None` of faces that are made otherwise.
fn grown_spacing(input: &Input, face: &Face) -> Option<f64> {
    match () {
        () if face.is_grown() => Some(SPACING),
        () if face.takes_quads() && face.method != Method::Quadtree => Some(square_spacing(input, face)),
        () => None,
    }
}

/// Distance of the nodes of a face of quads over the size.
pub(crate) fn square_spacing(input: &Input, face: &Face) -> f64 {
    if is_plane_lattice(input, face) { PLANE_SQUARE_SPACING } else { SQUARE_SPACING }
}

/// Whether a face of quads is a plane with one lattice.
pub(crate) fn is_plane_lattice(input: &Input, face: &Face) -> bool {
    let surface = &input.model.surfaces[face.surface.index()].surface;
    face.takes_quads() && face.method != Method::Quadtree && surface.is_flat()
}
